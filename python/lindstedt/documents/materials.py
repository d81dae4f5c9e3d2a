"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Barrier, Dissipation, MainMass


@dataclass(frozen=True, eq=False, repr=False)
class MaterialsParameters(Document):
    """The pendulum and the run.

    Attributes:
        barrier: Where the barriers stand.
        start: The displacement at t = 0, in radians.
        speed: The velocity at t = 0, in radians per unit of time.
        mass: The mass of the pendulum, in kg.
        radius: The radius of its sphere, in m.
        length: Its length, in m.
        gravity: The acceleration of gravity, in m/s^2.
        modulus: The modulus at which the damping of the contact is what is given, in Pa.
        time_unit: The unit of time sqrt(L/g), in seconds.
        main_mass: The main mass that carries the pendulum and is to come to rest; null on a fixed
            pivot, where the pendulum is.
        undamped_and_locked_rest_times: The rest times of the main mass without its damper and
            with the damper locked, in units of time; null where there is none, and on a fixed
            pivot.
        duration: How long the motions are followed, in units of time.
        route: How the motions were found: by `integration`, or as a `chain` of closed forms.
        step_tolerance: The relative tolerance of one step of the integrator.
        rest_fraction: The part of the first amplitude at which the pendulum, or the main mass,
            rests.
    """

    barrier: Barrier
    start: float
    speed: float
    mass: float
    radius: float
    length: float
    gravity: float
    modulus: float
    time_unit: float
    main_mass: MainMass | None
    undamped_and_locked_rest_times: tuple[float | None, float | None] | None
    duration: float
    route: Literal["integration", "chain"]
    step_tolerance: float
    rest_fraction: float


MaterialsParameters.FIELDS = (
    ("barrier", "barrier", Barrier.from_json),
    ("start", "start", None),
    ("speed", "speed", None),
    ("mass", "mass", None),
    ("radius", "radius", None),
    ("length", "length", None),
    ("gravity", "gravity", None),
    ("modulus", "modulus", None),
    ("time_unit", "time_unit", None),
    ("main_mass", "main_mass", MainMass.from_json),
    ("undamped_and_locked_rest_times", "undamped_and_locked_rest_times", tuple),
    ("duration", "duration", None),
    ("route", "route", None),
    ("step_tolerance", "step_tolerance", None),
    ("rest_fraction", "rest_fraction", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class FirstContact(Document):
    """The first contact of a barrier.

    Attributes:
        speed: The speed at the touch, in m/s.
        duration: How long it lasts, in seconds.
        penetration: How deep it goes, in m.
        peak_force: The greatest force, that of the damping included, in N.
        peak_pressure: The pressure of Hertz in the middle of the contact at the greatest depth,
            in Pa.
        restitution: The coefficient of restitution, dimensionless.
    """

    speed: float
    duration: float
    penetration: float
    peak_force: float
    peak_pressure: float
    restitution: float


FirstContact.FIELDS = (
    ("speed", "speed", None),
    ("duration", "duration", None),
    ("penetration", "penetration", None),
    ("peak_force", "peak_force", None),
    ("peak_pressure", "peak_pressure", None),
    ("restitution", "restitution", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class MaterialYieldCheck(Document):
    """A stated yield limit.

    Attributes:
        body: The body: `sphere` or `barrier`.
        limit: Its yield limit Y, in Pa.
        onset: The peak pressure at which it begins to yield, 1.6 Y, in Pa.
        exceeded: Whether the peak pressure exceeds that, so that the law of Hertz is outside its
            range.
    """

    body: str
    limit: float
    onset: float
    exceeded: bool


MaterialYieldCheck.FIELDS = (
    ("body", "body", None),
    ("limit", "limit", None),
    ("onset", "onset", None),
    ("exceeded", "exceeded", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class RestTime(Document):
    """A rest time, or why there is none.

    Attributes:
        rest_time: The rest time, in units of time; null where there is none.
        rest_time_in_seconds: The same in seconds; null likewise.
        rest_reason: Why there is none, in words; null where there is one.
    """

    rest_time: float | None
    rest_time_in_seconds: float | None
    rest_reason: str | None


RestTime.FIELDS = (
    ("rest_time", "rest_time", None),
    ("rest_time_in_seconds", "rest_time_in_seconds", None),
    ("rest_reason", "rest_reason", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class MaterialRow(Document):
    """A material.

    Attributes:
        name: Its name.
        modulus: The modulus of its contact with the sphere, in Pa.
        gamma: The stiffness of its contact by equation (8), dimensionless.
        own_damping: Whether it has a damping of its own.
        dissipation: What damps its motion, in every form.
        first_contact: The first contact; null where the barrier is not touched, or not left
            again.
        impacts: The contacts that begin before it rests, or in the whole run where it does not.
        energies: The energy of the swing, or of main mass and pendulum, after each of them, in
            units of m g L.
        rest: When it rests.
        nearby_rest_times: The least and the greatest rest time of starts 0.03 % smaller and
            larger, in units of time, where a main mass is followed by closed forms and rests;
            null otherwise, and where one of them does not rest.
        lossless: When it rests where the contact loses nothing, mu = 0.
        yield_checks: Stated yield limits beside the pressure of the first contact.
    """

    name: str
    modulus: float
    gamma: float
    own_damping: bool
    dissipation: Dissipation
    first_contact: FirstContact | None
    impacts: int
    energies: tuple[float, ...]
    rest: RestTime
    nearby_rest_times: tuple[float, float] | None
    lossless: RestTime
    yield_checks: tuple[MaterialYieldCheck, ...]


MaterialRow.FIELDS = (
    ("name", "name", None),
    ("modulus", "modulus", None),
    ("gamma", "gamma", None),
    ("own_damping", "own_damping", None),
    ("dissipation", "dissipation", Dissipation.from_json),
    ("first_contact", "first_contact", FirstContact.from_json),
    ("impacts", "impacts", None),
    ("energies", "energies", tuple),
    ("rest", "rest", RestTime.from_json),
    ("nearby_rest_times", "nearby_rest_times", tuple),
    ("lossless", "lossless", RestTime.from_json),
    ("yield_checks", "yield_checks", several(MaterialYieldCheck.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class HeldFixed(Document):
    """The materials under one form of the damping of the contact.

    Attributes:
        form: The form, by its key in a file.
        value: Its number, the same for every material, in `unit`.
        unit: The unit of that number; empty where it has none.
        at_speed: The speed at which a restitution is stated, in radians per unit of time; null
            for other forms.
        mu_over_gamma: mu/gamma of each material, dimensionless.
        restitutions: The restitution of each material at the speed of the first touch without
            damping; null where no barrier is touched.
        rest_times: The rest time of each material, in units of time; null where it does not rest.
        spread: How far the rest times are apart, latest/soonest - 1; null where a material does
            not rest.
    """

    form: Literal["mu", "mu_over_gamma", "lambda", "restitution", "damping"]
    value: float
    unit: str
    at_speed: float | None
    mu_over_gamma: tuple[float, ...]
    restitutions: tuple[float | None, ...]
    rest_times: tuple[float | None, ...]
    spread: float | None


HeldFixed.FIELDS = (
    ("form", "form", None),
    ("value", "value", None),
    ("unit", "unit", None),
    ("at_speed", "at_speed", None),
    ("mu_over_gamma", "mu_over_gamma", tuple),
    ("restitutions", "restitutions", tuple),
    ("rest_times", "rest_times", tuple),
    ("spread", "spread", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Materials(Answer):
    """The same swing against barriers of several materials. Angles are in radians, time is in units
    of 1/omega of small swings, sqrt(L/g), energies in units of m g L, unless another unit is
    given.

    Attributes:
        schema: The kind of document.
        parameters: The pendulum and the run.
        dissipation: What damps the design at its own modulus, in every form.
        defaults: The dampings that nobody gave, by their keys in a file: their numbers are not
            the paper's, which prints none.
        materials: The materials, in the order in which they were given.
        held_fixed: The materials under each form of the damping of the contact, the given one
            first; empty where the contact loses nothing or no barrier is touched.
        no_barrier: Without a barrier.
        conclusions: What the numbers say, in words.
    """

    schema: Literal["lindstedt/materials/1"]
    parameters: MaterialsParameters
    dissipation: Dissipation
    defaults: tuple[str, ...]
    materials: tuple[MaterialRow, ...]
    held_fixed: tuple[HeldFixed, ...]
    no_barrier: RestTime
    conclusions: tuple[str, ...]


Materials.FIELDS = (
    ("schema", "schema", None),
    ("parameters", "parameters", MaterialsParameters.from_json),
    ("dissipation", "dissipation", Dissipation.from_json),
    ("defaults", "defaults", tuple),
    ("materials", "materials", several(MaterialRow.from_json)),
    ("held_fixed", "held_fixed", several(HeldFixed.from_json)),
    ("no_barrier", "no_barrier", RestTime.from_json),
    ("conclusions", "conclusions", tuple),
)
