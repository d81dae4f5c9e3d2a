"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Barrier, MainMass


@dataclass(frozen=True, eq=False, repr=False)
class Genetic(Document):
    """The genetic algorithm; with several objectives NSGA-II, which has only population, generations
    and budget of it.

    Attributes:
        population: Individuals.
        elite: The best ones, which go on as they are.
        crossover_fraction: The part of the others that crossover makes.
        coding: How genes are written.
        bits: Bits of a number; null where genes are numbers.
        crossover: How two parents make a child.
        crossover_ratio: How far beyond the better parent, in parts of the way to it; null for
            other crossovers.
        mutation: How one parent makes a child.
        mutation_rate: The probability of a bit to be turned over; null for the other mutation.
        penalty: What a broken constraint costs.
        initial_penalty: The weight that an augmented Lagrangian begins with; null for other
            penalties.
        penalty_factor: What it is multiplied by; null for other penalties.
        constraint_tolerance: How far the mass may be from that of the density, in parts.
        generations: The most generations after the random population.
        stall_generations: Over so many generations the best value is watched.
        function_tolerance: Below this change of it a run ends.
        stall_test: How that is measured.
        budget: The most evaluations of one run; null where there is no such limit.
    """

    population: int
    elite: int
    crossover_fraction: float
    coding: Literal["real", "bits"]
    bits: int | None
    crossover: Literal["heuristic", "scattered", "one-point"]
    crossover_ratio: float | None
    mutation: Literal["adaptive-feasible", "bit-flip"]
    mutation_rate: float | None
    penalty: Literal["death", "feasible-first", "augmented-lagrangian"]
    initial_penalty: float | None
    penalty_factor: float | None
    constraint_tolerance: float
    generations: int
    stall_generations: int
    function_tolerance: float
    stall_test: Literal["average", "weighted"]
    budget: int | None


Genetic.FIELDS = (
    ("population", "population", None),
    ("elite", "elite", None),
    ("crossover_fraction", "crossover_fraction", None),
    ("coding", "coding", None),
    ("bits", "bits", None),
    ("crossover", "crossover", None),
    ("crossover_ratio", "crossover_ratio", None),
    ("mutation", "mutation", None),
    ("mutation_rate", "mutation_rate", None),
    ("penalty", "penalty", None),
    ("initial_penalty", "initial_penalty", None),
    ("penalty_factor", "penalty_factor", None),
    ("constraint_tolerance", "constraint_tolerance", None),
    ("generations", "generations", None),
    ("stall_generations", "stall_generations", None),
    ("function_tolerance", "function_tolerance", None),
    ("stall_test", "stall_test", None),
    ("budget", "budget", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ContactForm(Document):
    """A damping of the contact in the form in which it is given.

    Attributes:
        form: The form, by its key in a file.
        value: Its number, in the unit of that key.
        at_speed: The speed at which a restitution is stated, in `speed_unit`; null where none is.
        speed_unit: The unit of that speed: `m/s`, or `rad*omega`, radians per unit of time. Left
            out where none is stated.
    """

    form: Literal["mu", "mu_over_gamma", "lambda", "restitution", "damping"]
    value: float
    at_speed: float | None
    speed_unit: str | None


ContactForm.FIELDS = (
    ("form", "form", None),
    ("value", "value", None),
    ("at_speed", "at_speed", None),
    ("speed_unit", "speed_unit", None),
)
ContactForm.OPTIONAL = frozenset(['speed_unit'])


@dataclass(frozen=True, eq=False, repr=False)
class SearchHeldFixed(Document):
    """What is held fixed; null where it varies or is not given.

    Attributes:
        amplitude: The release from rest, in radians.
        start: The displacement at t = 0, in radians, where it is not that.
        speed: The velocity at t = 0, in radians per unit of time.
        barrier: Where the barriers stand.
        contact: The damping of the contact; null where every material has its own.
        zeta: The viscous damping ratio, dimensionless; null where `viscous` is given.
        viscous: The coefficient of the viscous force on the bob, in N s/m; null where zeta is
            given.
        alpha: The Coulomb friction, dimensionless; null where `torque` is given.
        torque: Its torque, in N m; null where alpha is given.
        friction: The law of that friction.
        mass: The mass, in kg.
        radius: The radius of the sphere, in m.
        length: The length, in m.
        modulus: The modulus of the barrier, in Pa.
        gravity: The acceleration of gravity, in m/s^2.
    """

    amplitude: float
    start: float | None
    speed: float
    barrier: Barrier
    contact: ContactForm | None
    zeta: float | None
    viscous: float | None
    alpha: float | None
    torque: float | None
    friction: Literal["exact", "arctangent"]
    mass: float | None
    radius: float | None
    length: float | None
    modulus: float | None
    gravity: float


SearchHeldFixed.FIELDS = (
    ("amplitude", "amplitude", None),
    ("start", "start", None),
    ("speed", "speed", None),
    ("barrier", "barrier", Barrier.from_json),
    ("contact", "contact", ContactForm.from_json),
    ("zeta", "zeta", None),
    ("viscous", "viscous", None),
    ("alpha", "alpha", None),
    ("torque", "torque", None),
    ("friction", "friction", None),
    ("mass", "mass", None),
    ("radius", "radius", None),
    ("length", "length", None),
    ("modulus", "modulus", None),
    ("gravity", "gravity", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SearchLimit(Document):
    """What must not be larger.

    Attributes:
        objective: What, by its name as an objective.
        at_most: The largest value, in `unit`.
        unit: The unit; empty where it has none.
    """

    objective: str
    at_most: float
    unit: str


SearchLimit.FIELDS = (
    ("objective", "objective", None),
    ("at_most", "at_most", None),
    ("unit", "unit", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SearchMaterial(Document):
    """A material that is tried.

    Attributes:
        name: Its name.
        modulus: The modulus of its contact, in Pa.
        yield_limit: Its yield limit, in Pa; null where none is stated.
        damping: Its own damping; null where it has none.
    """

    name: str
    modulus: float
    yield_limit: float | None
    damping: ContactForm | None


SearchMaterial.FIELDS = (
    ("name", "name", None),
    ("modulus", "modulus", None),
    ("yield_limit", "yield_limit", None),
    ("damping", "damping", ContactForm.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class SearchVariable(Document):
    """A number of the design that varies.

    Attributes:
        name: Its key in a file.
        unit: Its unit.
        lower: Its lower limit, in that unit.
        upper: Its upper limit, in that unit.
    """

    name: str
    unit: str
    lower: float
    upper: float


SearchVariable.FIELDS = (
    ("name", "name", None),
    ("unit", "unit", None),
    ("lower", "lower", None),
    ("upper", "upper", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Asked(Document):
    """What was asked.

    Attributes:
        objectives: What is to be small, by its key in a file.
        variables: What varies, in the order in which points have it.
        materials: The materials that are tried; a point has their number from 0 up, its fraction
            is left out, behind the variables where there are two or more.
        limits: What must not be larger.
        density: The density of the sphere, in kg/m^3, where its mass is that of its radius; null
            where it is not.
        elastic: Whether the bodies must not yield.
        sphere_yield: The yield limit of the sphere, in Pa; null where none is stated.
        barrier_yield: That of the barrier, in Pa; null likewise.
        main_mass: The main mass that carries the pendulum; null where its rest does not count.
        held_fixed: What is held fixed.
        defaults: The dampings that nobody gave, by their keys in a file: their numbers are not
            the paper's, which prints none.
        duration: How long motions are followed, in units of time.
        rest_fraction: The part of the first amplitude at which the pendulum rests.
        step_tolerance: The relative tolerance of one step of the integrator.
        step_limit: The most steps of an integration.
        genetic: How it is searched.
        runs: Runs.
        seed: The seed; run i has its i-th stream of random numbers.
    """

    objectives: tuple[Literal["rest_time", "dimensionless_rest_time", "peak_force", "peak_pressure", "mass", "impacts", "primary_rest_time"], ...]
    variables: tuple[SearchVariable, ...]
    materials: tuple[SearchMaterial, ...]
    limits: tuple[SearchLimit, ...]
    density: float | None
    elastic: bool
    sphere_yield: float | None
    barrier_yield: float | None
    main_mass: MainMass | None
    held_fixed: SearchHeldFixed
    defaults: tuple[str, ...]
    duration: float
    rest_fraction: float
    step_tolerance: float
    step_limit: int
    genetic: Genetic
    runs: int
    seed: int


Asked.FIELDS = (
    ("objectives", "objectives", tuple),
    ("variables", "variables", several(SearchVariable.from_json)),
    ("materials", "materials", several(SearchMaterial.from_json)),
    ("limits", "limits", several(SearchLimit.from_json)),
    ("density", "density", None),
    ("elastic", "elastic", None),
    ("sphere_yield", "sphere_yield", None),
    ("barrier_yield", "barrier_yield", None),
    ("main_mass", "main_mass", MainMass.from_json),
    ("held_fixed", "held_fixed", SearchHeldFixed.from_json),
    ("defaults", "defaults", tuple),
    ("duration", "duration", None),
    ("rest_fraction", "rest_fraction", None),
    ("step_tolerance", "step_tolerance", None),
    ("step_limit", "step_limit", None),
    ("genetic", "genetic", Genetic.from_json),
    ("runs", "runs", None),
    ("seed", "seed", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Found(Document):
    """A design that a run found, as the search has it: by closed forms, by integration where there
    are none.

    Attributes:
        point: The values of the variables in their order, then the number of the material.
        values: The objectives in their order.
    """

    point: tuple[float, ...]
    values: tuple[float, ...]


Found.FIELDS = (
    ("point", "point", tuple),
    ("values", "values", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class SearchRun(Document):
    """A run.

    Attributes:
        number: Its number, from 0.
        found: The best design, or the front; empty where no design rests and keeps the
            constraints.
        curve: The best value after the random population and after every generation, null while
            there is none; with several objectives the size of the front.
        generations: Generations after the random population.
        evaluations: Designs that were followed.
        integrated: Those that were integrated: they have no closed form, or would be the best if
            they keep the constraints.
        stop: Why it ended.
    """

    number: int
    found: tuple[Found, ...]
    curve: tuple[float | None, ...]
    generations: int
    evaluations: int
    integrated: int
    stop: Literal["stalled", "generations", "budget", "interrupted"]


SearchRun.FIELDS = (
    ("number", "number", None),
    ("found", "found", several(Found.from_json)),
    ("curve", "curve", tuple),
    ("generations", "generations", None),
    ("evaluations", "evaluations", None),
    ("integrated", "integrated", None),
    ("stop", "stop", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Search(Document):
    """The best values of the runs of one search.

    Attributes:
        name: Which: the genetic algorithm first.
        evaluations: Evaluations of one run, on the average.
        found: How many runs found a design that rests and keeps the constraints.
        best: The least value, in the unit of the objective; null where no run found one.
        lower_quartile: A quarter of the runs is no worse; null likewise.
        median: Half of them; null likewise.
        upper_quartile: Three quarters; null likewise.
        worst: The greatest value; null likewise.
    """

    name: str
    evaluations: float
    found: int
    best: float | None
    lower_quartile: float | None
    median: float | None
    upper_quartile: float | None
    worst: float | None


Search.FIELDS = (
    ("name", "name", None),
    ("evaluations", "evaluations", None),
    ("found", "found", None),
    ("best", "best", None),
    ("lower_quartile", "lower_quartile", None),
    ("median", "median", None),
    ("upper_quartile", "upper_quartile", None),
    ("worst", "worst", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Design(Document):
    """A design that was followed until it rests.

    Attributes:
        variables: The values of the variables by their names.
        material: Its material; null where none are tried.
        rest_time: The rest time, in units of time; null where it does not rest.
        rest_time_in_seconds: The same in seconds; null likewise.
        rest_reason: Why it does not rest, in words; null where it does.
        impacts: The contacts until rest.
        peak_force: The greatest force of a contact, in N; null where there is none.
        peak_pressure: The greatest pressure of Hertz, in Pa; null where there is none.
        restitution: The coefficient of restitution of the contact with the greatest force,
            dimensionless; null where there is none.
        primary_rest_time: The rest time of the main mass, in seconds; null where it never rests,
            or none counts.
        gamma: The stiffness of the contact by equation (8), dimensionless.
        mu_over_gamma: mu/gamma, dimensionless.
    """

    variables: dict[str, float]
    material: str | None
    rest_time: float | None
    rest_time_in_seconds: float | None
    rest_reason: str | None
    impacts: int
    peak_force: float | None
    peak_pressure: float | None
    restitution: float | None
    primary_rest_time: float | None
    gamma: float
    mu_over_gamma: float


Design.FIELDS = (
    ("variables", "variables", dict),
    ("material", "material", None),
    ("rest_time", "rest_time", None),
    ("rest_time_in_seconds", "rest_time_in_seconds", None),
    ("rest_reason", "rest_reason", None),
    ("impacts", "impacts", None),
    ("peak_force", "peak_force", None),
    ("peak_pressure", "peak_pressure", None),
    ("restitution", "restitution", None),
    ("primary_rest_time", "primary_rest_time", None),
    ("gamma", "gamma", None),
    ("mu_over_gamma", "mu_over_gamma", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Finalist(Document):
    """A design that was judged again.

    Attributes:
        run: The number of the run that found it.
        by_closed_forms: Its objectives by closed forms, where it has them; else by integration.
        values: The same by integration; null where it does not rest.
        feasible: Whether by integration it rests and keeps the constraints.
        design: The design by integration.
    """

    run: int
    by_closed_forms: tuple[float, ...]
    values: tuple[float | None, ...]
    feasible: bool
    design: Design


Finalist.FIELDS = (
    ("run", "run", None),
    ("by_closed_forms", "by_closed_forms", tuple),
    ("values", "values", tuple),
    ("feasible", "feasible", None),
    ("design", "design", Design.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(Document):
    """A variable moved alone.

    Attributes:
        name: Its key in a file.
        value: Its value in the best design.
        elasticity: The change of the objective in parts for one part of the variable, by
            integration; null where it has no value on one side.
        alone: Between these values the objective is no more than 1 % worse.
        range: Least and greatest objective over the whole range, constraints aside; null where it
            does not rest somewhere.
        role: What follows: every value is as good, a limit decides, a constraint does, or
            something is lost on either side.
    """

    name: str
    value: float
    elasticity: float | None
    alone: tuple[float, float]
    range: tuple[float, float] | None
    role: Literal["flat", "lower end", "upper end", "constraint", "trade"]


Sensitivity.FIELDS = (
    ("name", "name", None),
    ("value", "value", None),
    ("elasticity", "elasticity", None),
    ("alone", "alone", tuple),
    ("range", "range", tuple),
    ("role", "role", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Unit(Document):
    """What the unit of the rest time does.

    Attributes:
        lengths: The limits of the length, in m.
        seconds: The rest times there, in seconds.
        dimensionless: The same in units of time of each length.
        best_lengths: The best lengths of those that were tried between the limits, the rest as it
            is best, in m: by the rest time in seconds, and by that in units of time.
    """

    lengths: tuple[float, float]
    seconds: tuple[float, float]
    dimensionless: tuple[float, float]
    best_lengths: tuple[float, float]


Unit.FIELDS = (
    ("lengths", "lengths", tuple),
    ("seconds", "seconds", tuple),
    ("dimensionless", "dimensionless", tuple),
    ("best_lengths", "best_lengths", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Decision(Document):
    """What decides the best design.

    Attributes:
        sensitivities: The variables, each moved alone.
        within: A design this much worse, in parts, counts as good.
        share: The part of the box that is as good.
        extents: Least and greatest value of every variable, and of the number of the material,
            among the designs that are as good.
        active: Constraints with no more than 1 % to spare, in words.
        unit: The rest times with the length at its limits, in both units; null where the length
            does not vary or no rest time is the objective.
        materials: The objective with each material, the rest as it is best; null where it does
            not rest.
    """

    sensitivities: tuple[Sensitivity, ...]
    within: float
    share: float
    extents: tuple[tuple[float, float], ...]
    active: tuple[str, ...]
    unit: Unit | None
    materials: tuple[float | None, ...]


Decision.FIELDS = (
    ("sensitivities", "sensitivities", several(Sensitivity.from_json)),
    ("within", "within", None),
    ("share", "share", None),
    ("extents", "extents", several(tuple)),
    ("active", "active", tuple),
    ("unit", "unit", Unit.from_json),
    ("materials", "materials", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Optimization(Answer):
    """A search for the best damper. Angles are in radians, everything else in SI units, unless
    another unit is given; units of time are 1/omega of small swings, sqrt(L/g).

    Attributes:
        schema: The kind of document.
        asked: What was asked.
        complete: Whether all of it was done; false where it was stopped before the end.
        runs: The runs, by their numbers.
        searches: The best values of the runs as the searches have them, and of other searches
            with as many evaluations; empty with several objectives.
        median_curve: The median over the runs of the best value after the random population and
            after every generation; null while half of them have none.
        finalists: The best designs of the runs judged again by integration, the best first; with
            several objectives the front, by the first one.
        papers_design: The paper's Table 5 under the same assumptions, by integration; null where
            materials are tried.
        decision: What decides the best design; null with several objectives.
        conclusions: What the numbers say, in words.
    """

    schema: Literal["lindstedt/optimization/1"]
    asked: Asked
    complete: bool
    runs: tuple[SearchRun, ...]
    searches: tuple[Search, ...]
    median_curve: tuple[float | None, ...]
    finalists: tuple[Finalist, ...]
    papers_design: Design | None
    decision: Decision | None
    conclusions: tuple[str, ...]


Optimization.FIELDS = (
    ("schema", "schema", None),
    ("asked", "asked", Asked.from_json),
    ("complete", "complete", None),
    ("runs", "runs", several(SearchRun.from_json)),
    ("searches", "searches", several(Search.from_json)),
    ("median_curve", "median_curve", tuple),
    ("finalists", "finalists", several(Finalist.from_json)),
    ("papers_design", "papers_design", Design.from_json),
    ("decision", "decision", Decision.from_json),
    ("conclusions", "conclusions", tuple),
)
