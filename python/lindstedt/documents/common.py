"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from .._document import Document, fraction_or_text, mapped, several
from .._polynomial import ConstantMethods, PolynomialMethods, VerificationMethods


@dataclass(frozen=True, eq=False, repr=False)
class Constant(ConstantMethods, Document):
    """An exact constant beside its decimal value.

    Attributes:
        exact: The exact value as text: a fraction such as `-1/8`, or an expression such as
            `pi/3`.
        value: The same as a decimal number; null where it is beyond the range of double
            precision.
    """

    exact: Fraction | str
    value: float | None


Constant.FIELDS = (
    ("exact", "exact", fraction_or_text),
    ("value", "value", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Parameters(Document):
    """The numbers of an impact.

    Attributes:
        amplitude: The distance of the turning point from the equilibrium, in radians.
        barrier: The place of the barrier, in radians.
        contact_law: The law of the contact in the derived phases.
        force: The force of the barrier as an expression in the depth; null for that of Hertz,
            gamma*d^(3/2).
        gamma: The dimensionless stiffness of the barrier.
        gamma_source: Where gamma comes from, in words.
        integrator_tolerance: The relative error of a step of Runge-Kutta.
        lambda_: The damping lambda of the contact, in units of time per radian by Hunt and
            Crossley, of time with a dashpot; null where it loses nothing.
        linearisation: How the line is fitted that replaces the force of the barrier.
        order: The order of `law` in the amplitude; null where there is none.
        release: The place of the release, from rest, in radians.
        restitution: The coefficient of restitution that lambda follows from; null where it does
            not.
        side: On which side of its place the barrier is.
        turning_point: Where the cycle starts, in radians: the release, or the turning point of a
            motion released inside the barrier.
        values: The values of the other parameters of the equation.
    """

    amplitude: float
    barrier: float
    contact_law: Literal["least-squares", "least-squares-origin", "equal-energy", "equal-peak-force", "harmonic-balance", "equal-duration", "homotopy", "iteration", "homotopy-2", "harmonic-balance-2", "harmonic-balance-3", "power-law", "power-law-corrected", "exact", "hunt-crossley", "kelvin-voigt", "kelvin-voigt-no-pull"]
    force: str | None
    gamma: float
    gamma_source: str
    integrator_tolerance: float
    lambda_: float | None
    linearisation: Literal["least-squares", "least-squares-origin", "equal-energy", "equal-peak-force", "harmonic-balance", "equal-duration"]
    order: int | None
    release: float
    restitution: float | None
    side: Literal["left", "right"]
    turning_point: float
    values: dict[str, float]


Parameters.FIELDS = (
    ("amplitude", "amplitude", None),
    ("barrier", "barrier", None),
    ("contact_law", "contact_law", None),
    ("force", "force", None),
    ("gamma", "gamma", None),
    ("gamma_source", "gamma_source", None),
    ("integrator_tolerance", "integrator_tolerance", None),
    ("lambda_", "lambda", None),
    ("linearisation", "linearisation", None),
    ("order", "order", None),
    ("release", "release", None),
    ("restitution", "restitution", None),
    ("side", "side", None),
    ("turning_point", "turning_point", None),
    ("values", "values", dict),
)


@dataclass(frozen=True, eq=False, repr=False)
class Judged(Document):
    """A number and its error.

    Attributes:
        error: value / true value - 1, as a fraction.
        value: The number.
    """

    error: float
    value: float


Judged.FIELDS = (
    ("error", "error", None),
    ("value", "value", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Term(Document):
    """A term: its coefficient times a product of powers.

    Attributes:
        exact: The exact coefficient as text: a fraction such as `-1/8`.
        monomial: The power of each symbol in it, negative ones too; `verification.values` has the
            value of every symbol.
        value: The coefficient as a decimal number; null where it is beyond the range of double
            precision.
    """

    exact: Fraction
    monomial: dict[str, int]
    value: float | None


Term.FIELDS = (
    ("exact", "exact", Fraction),
    ("monomial", "monomial", dict),
    ("value", "value", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Polynomial(PolynomialMethods, Document):
    """A polynomial: the sum of its terms, lowest order in the small parameters first; zero where
    there is none.

    Attributes:
        terms: The terms that are added up.
    """

    terms: tuple[Term, ...]


Polynomial.FIELDS = (
    ("terms", "terms", several(Term.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class System(Document):
    """Algebraic equations for omega and the coefficients of the motion.

    Attributes:
        equations: Expressions, each of which is zero.
        unknowns: What is solved for: `omega` and the coefficients; `verification.values` has
            their values.
    """

    equations: tuple[str, ...]
    unknowns: tuple[str, ...]


System.FIELDS = (
    ("equations", "equations", tuple),
    ("unknowns", "unknowns", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Harmonic(Document):
    """One harmonic of a motion with symbols in it.

    Attributes:
        cos: The coefficient of the cosine, in the unit of the coordinate.
        harmonic: The multiple of theta, 0 for the mean.
        sin: The coefficient of the sine, in the unit of the coordinate.
    """

    cos: Polynomial
    harmonic: int
    sin: Polynomial


Harmonic.FIELDS = (
    ("cos", "cos", Polynomial.from_json),
    ("harmonic", "harmonic", None),
    ("sin", "sin", Polynomial.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Displacement(Document):
    """A motion as a Fourier series with symbols in it.

    Attributes:
        harmonics: x = sum of cos * cos(harmonic theta) + sin * sin(harmonic theta), lowest
            harmonic first, the equilibrium in harmonic 0; empty where only `verification.motion`
            has the motion. Of a driven answer the part with the first harmonic: `response.motion`
            has the whole.
        variable: The name of the angle, `theta`, or `phi` where the equation has a `theta` of its
            own: theta = omega t + `verification.phase`, in radians.
    """

    harmonics: tuple[Harmonic, ...]
    variable: str


Displacement.FIELDS = (
    ("harmonics", "harmonics", several(Harmonic.from_json)),
    ("variable", "variable", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Cycle(Document):
    """A limit cycle to leading order.

    Attributes:
        amplitude: Its amplitude where the small parameters vanish, in the unit of the coordinate.
        attracts_where_positive: An expression: where it is positive the cycle attracts, where it
            is negative it repels; null at a multiple root, where nothing is said.
        stability: The same in words.
    """

    amplitude: Constant
    attracts_where_positive: str | None
    stability: str


Cycle.FIELDS = (
    ("amplitude", "amplitude", Constant.from_json),
    ("attracts_where_positive", "attracts_where_positive", None),
    ("stability", "stability", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class LimitCycle(Document):
    """The limit cycle that is expanded, among those of its equation.

    Attributes:
        amplitude: Its amplitude, as `amplitude` of the solution says, in the unit of the
            coordinate; to leading order where the motion is left out.
        cycles: All limit cycles of the equation to leading order, smallest first.
        number: Which of the `cycles` it is, counted from one.
        small_with: Parameters that are small together with the small parameter.
    """

    amplitude: Polynomial
    cycles: tuple[Cycle, ...]
    number: int
    small_with: tuple[str, ...]


LimitCycle.FIELDS = (
    ("amplitude", "amplitude", Polynomial.from_json),
    ("cycles", "cycles", several(Cycle.from_json)),
    ("number", "number", None),
    ("small_with", "small_with", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Release(Document):
    """Amplitude and phase at t = 0 of a motion with x = A from the equilibrium and x' = 0 there.

    Attributes:
        amplitude: The amplitude, an expression.
        phase: The phase, an expression.
    """

    amplitude: str
    phase: str


Release.FIELDS = (
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Resonance(Document):
    """A driving frequency near a multiple of the linear one: times_driving * driving_frequency =
    times_linear * omega0 + detuning.

    Attributes:
        detuning: The symbol of the detuning.
        detuning_means: What the detuning stands for, an expression.
        driving_frequency: The driving frequency, a symbol or a number.
        times_driving: How many times it is taken.
        times_linear: How many times the linear frequency is taken.
    """

    detuning: str
    detuning_means: str
    driving_frequency: str
    times_driving: int
    times_linear: int


Resonance.FIELDS = (
    ("detuning", "detuning", None),
    ("detuning_means", "detuning_means", None),
    ("driving_frequency", "driving_frequency", None),
    ("times_driving", "times_driving", None),
    ("times_linear", "times_linear", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Transient(Document):
    """A motion from its start in closed form.

    Attributes:
        amplitude: The amplitude, an expression in t.
        ends: The time at which the amplitude reaches zero and stays, or grows without bound, an
            expression; null where the formulas hold for all times.
        phase: The phase, an expression in t; null where it has no closed form.
        start: The symbol of the amplitude at t = 0: A, or one of `definitions`.
    """

    amplitude: str
    ends: str | None
    phase: str | None
    start: str


Transient.FIELDS = (
    ("amplitude", "amplitude", None),
    ("ends", "ends", None),
    ("phase", "phase", None),
    ("start", "start", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Modulation(Document):
    """The slow equations of amplitude and phase, in time derivatives: the motion is `displacement`
    with theta = phase, or for a driven motion theta = (times_driving * driving_frequency * t -
    phase)/times_linear.

    Attributes:
        amplitude: The symbol of the amplitude, in the unit of the coordinate.
        amplitude_rate: The rate of the amplitude, an expression.
        motion: Where `displacement` of the solution is the motion on a limit cycle: the motion
            from a start, with theta = phase; else null.
        phase: The symbol of the phase, in radians.
        phase_rate: The rate of the phase, an expression, in radians per unit of time.
        release: Where a motion released at rest from x = A begins; null for a driven motion.
        resonance: What a driving force is in resonance with; null for a free motion.
        small_with: Parameters that are small together with the small parameter.
        steady: The amplitudes other than zero that stay, smallest first.
        transient: The motion from a start in closed form; null where none is known.
    """

    amplitude: str
    amplitude_rate: str
    motion: Displacement | None
    phase: str
    phase_rate: str
    release: Release | None
    resonance: Resonance | None
    small_with: tuple[str, ...]
    steady: tuple[Cycle, ...]
    transient: Transient | None


Modulation.FIELDS = (
    ("amplitude", "amplitude", None),
    ("amplitude_rate", "amplitude_rate", None),
    ("motion", "motion", Displacement.from_json),
    ("phase", "phase", None),
    ("phase_rate", "phase_rate", None),
    ("release", "release", Release.from_json),
    ("resonance", "resonance", Resonance.from_json),
    ("small_with", "small_with", tuple),
    ("steady", "steady", several(Cycle.from_json)),
    ("transient", "transient", Transient.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Branches(Document):
    """detuning = centre + sqrt(width_squared) and centre - sqrt(width_squared).

    Attributes:
        centre: The middle of both branches, the backbone.
        width_squared: The square of their distance from it.
    """

    centre: Polynomial
    width_squared: Polynomial


Branches.FIELDS = (
    ("centre", "centre", Polynomial.from_json),
    ("width_squared", "width_squared", Polynomial.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class ClosedRelation(Document):
    """The frequency-response equation of a force that is no polynomial, expressions in the amplitude
    and the detuning.

    Attributes:
        centre: The middle of both branches of the detuning, the backbone.
        relation: Zero at every steady motion.
        width_squared: The square of their distance from it.
    """

    centre: str
    relation: str
    width_squared: str


ClosedRelation.FIELDS = (
    ("centre", "centre", None),
    ("relation", "relation", None),
    ("width_squared", "width_squared", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Response(Document):
    """What is known of the steady motions of a driven equation. All formulas are in the amplitude and
    the detuning of `modulation`, the parameters and the definitions.

    Attributes:
        branches: The relation solved for the detuning; null where it is not quadratic in that.
        closed: The same where they are no polynomials; null where they are.
        coordinates: The names of u = a cos(phase/m) and v = -a sin(phase/m), with m =
            times_linear; null where `rates` is.
        folds: The squares of the amplitudes at which two branches meet, expressions in the
            detuning; none where they have no closed form.
        jumps: The discriminant of the relation in the square of the amplitude, zero where two
            branches meet; null where it is not given.
        motion: x(t), an expression in t, the amplitude and the phase of `modulation`.
        parts: The same by parts, each by its orders: what drains, what turns, and each wave of
            the phase; of each first what leads, then what comes one, two, ... orders later. Left
            out where each part has one order alone.
        peak: The largest amplitude of all detunings, an expression; null where it has no closed
            form.
        rates: The rates of u and v, polynomials: the slow equations without a singular origin;
            null where they are no polynomials.
        relation: The frequency-response equation: a polynomial that is zero at every steady
            motion; null where the phase cannot be eliminated.
    """

    branches: Branches | None
    closed: ClosedRelation | None
    coordinates: tuple[str, str] | None
    folds: tuple[str, ...]
    jumps: Polynomial | None
    motion: str
    parts: tuple[tuple[tuple[Polynomial, Polynomial], ...], ...] | None
    peak: str | None
    rates: tuple[Polynomial, Polynomial] | None
    relation: Polynomial | None


Response.FIELDS = (
    ("branches", "branches", Branches.from_json),
    ("closed", "closed", ClosedRelation.from_json),
    ("coordinates", "coordinates", tuple),
    ("folds", "folds", tuple),
    ("jumps", "jumps", Polynomial.from_json),
    ("motion", "motion", None),
    ("parts", "parts", several(several(several(Polynomial.from_json)))),
    ("peak", "peak", None),
    ("rates", "rates", several(Polynomial.from_json)),
    ("relation", "relation", Polynomial.from_json),
)
Response.OPTIONAL = frozenset(['parts'])


@dataclass(frozen=True, eq=False, repr=False)
class Estimate(Document):
    """A number that was estimated.

    Attributes:
        error: How far it may be off.
        exact: All digits that the error leaves, as an exact fraction in text.
        value: The same as a decimal number.
    """

    error: float
    exact: Fraction
    value: float


Estimate.FIELDS = (
    ("error", "error", None),
    ("exact", "exact", Fraction),
    ("value", "value", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Convergence(Document):
    """The nearest singularity of a series, or a pair of conjugate ones, in the complex plane of its
    variable.

    Attributes:
        angle: Its angle in radians, in the upper half plane.
        exponent: The power of the distance with which the period is singular there: 1/2 for a
            square root, 0 for a logarithm; null where it could not be told.
        highest: The highest power of the variable in the series.
        imaginary: The imaginary part of its place, which stands with both signs.
        radius: The distance of the singularity from zero: the series converges where the variable
            is smaller.
        real: The real part of its place.
        variable: What the series runs in: the powers of the small parameter and of the symbols
            that enter in step with it, multiplied.
    """

    angle: Estimate
    exponent: Estimate | None
    highest: int
    imaginary: Estimate
    radius: Estimate
    real: Estimate
    variable: dict[str, int]


Convergence.FIELDS = (
    ("angle", "angle", Estimate.from_json),
    ("exponent", "exponent", Estimate.from_json),
    ("highest", "highest", None),
    ("imaginary", "imaginary", Estimate.from_json),
    ("radius", "radius", Estimate.from_json),
    ("real", "real", Estimate.from_json),
    ("variable", "variable", dict),
)


@dataclass(frozen=True, eq=False, repr=False)
class Followed(Document):
    """A motion that is not periodic, followed from its release at rest at x = A. Frequencies are
    those of its crossings of the equilibrium: pi over the mean time between successive ones;
    `max_deviation` is over the whole time.

    Attributes:
        amplitude_error: The largest error of the turning points, as a fraction of the amplitude
            at the start; null where it is not known.
        amplitude_slope: The exponent with which that error vanishes as the small parameter does,
            over times that grow as it becomes less; null where rounding hides it.
        crossings: How many crossings of the formula and of the true motion were compared.
        reason: Why no longer, in words.
        tenth: When the amplitude is a tenth of that at the start, by the formula; null where it
            was not seen.
        tenth_by_action: The same by the action, which viscous damping drains at one rate whatever
            the force; null for any other damping.
        true_tenth: The same in truth, between turning points on the logarithm; null where it was
            not seen.
        until: How long it was followed, in the time of the equation.
    """

    amplitude_error: float | None
    amplitude_slope: float | None
    crossings: int
    reason: str
    tenth: float | None
    tenth_by_action: float | None
    true_tenth: float | None
    until: float


Followed.FIELDS = (
    ("amplitude_error", "amplitude_error", None),
    ("amplitude_slope", "amplitude_slope", None),
    ("crossings", "crossings", None),
    ("reason", "reason", None),
    ("tenth", "tenth", None),
    ("tenth_by_action", "tenth_by_action", None),
    ("true_tenth", "true_tenth", None),
    ("until", "until", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class HarmonicValue(Document):
    """One harmonic of a motion in numbers.

    Attributes:
        cos: The coefficient of the cosine, in the unit of the coordinate.
        harmonic: The multiple of theta, 0 for the mean.
        sin: The coefficient of the sine, in the unit of the coordinate.
    """

    cos: float
    harmonic: int
    sin: float


HarmonicValue.FIELDS = (
    ("cos", "cos", None),
    ("harmonic", "harmonic", None),
    ("sin", "sin", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Range(Document):
    """A place where the formula stops to hold, or another remark on its range.

    Attributes:
        outside: Whether the given values lie outside of it.
        text: The range in words and numbers.
    """

    outside: bool
    text: str


Range.FIELDS = (
    ("outside", "outside", None),
    ("text", "text", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SteadyState(Document):
    """A steady motion in numbers, by the slow equations and in truth.

    Attributes:
        amplitude: The amplitude by the slow equations, in the unit of the coordinate.
        eigenvalues: Real and imaginary part of each eigenvalue of the slow equations, per unit of
            time.
        max_deviation: The largest |x - x_true| over one period, as a fraction of the largest
            |x_true|; null where no true motion was found.
        phase: The phase by the slow equations, from -pi to pi, in radians.
        relative_error: amplitude / true_amplitude - 1, as a fraction; null for a motion without a
            part of its own.
        stable: Whether both real parts are negative.
        true_amplitude: The amplitude of the true periodic motion near it; null where none was
            found.
        true_stable: Whether the true motion attracts, by its Floquet multipliers; null where none
            was found.
    """

    amplitude: float
    eigenvalues: tuple[tuple[float, float], tuple[float, float]]
    max_deviation: float | None
    phase: float
    relative_error: float | None
    stable: bool
    true_amplitude: float | None
    true_stable: bool | None


SteadyState.FIELDS = (
    ("amplitude", "amplitude", None),
    ("eigenvalues", "eigenvalues", several(tuple)),
    ("max_deviation", "max_deviation", None),
    ("phase", "phase", None),
    ("relative_error", "relative_error", None),
    ("stable", "stable", None),
    ("true_amplitude", "true_amplitude", None),
    ("true_stable", "true_stable", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Verification(VerificationMethods, Document):
    """A formula at given values, beside the true motion of the equation as it was typed.

    Attributes:
        at: The values that were given.
        chosen: Values that the method left open: hbar as it was chosen, the coefficients of a
            balance as they were solved for.
        error_of_omega: The relative error of `frequency` where `frequency_squared` is judged;
            null where they do not stand side by side.
        followed: What else is known of a motion that is not periodic; null for any other.
        frequency: omega by the formula, in radians per unit of time; null where there is none.
        judged_on: What is judged: `omega^2`, of which the frequency is the root, or `omega`; of a
            driven motion the `amplitude` of the largest stable steady state, whose relative error
            is given.
        max_deviation: The largest |x - x_true| over one true period in real time, as a fraction
            of the amplitude; null where it is not known.
        motion: The motion in numbers, whatever the method: x = sum of cos * cos(harmonic theta) +
            sin * sin(harmonic theta), the equilibrium in harmonic 0; harmonics below 1e-14 of the
            largest are left out. Where phase is pi and the force is not odd, only this starts at
            the amplitude, not `displacement`. Null where the frequency is not real or the motion
            is not known.
        no_deviation: Why the displacement is not judged, in words. Left out where it is, or where
            there is none to judge.
        phase: theta at t = 0, in radians: theta = omega t + phase. It is pi for a negative
            amplitude whose size stands in `values`, else 0.
        ranges: Where the formula holds at these values, in words and numbers.
        reason: Why there is no frequency, in words; null where there is one.
        relative_error: frequency / true_frequency - 1, signed, as a fraction; null where there is
            no frequency.
        residual: The root mean square of what the formula leaves of the equation, over that of
            the force; null where it is not known.
        slope: The exponent with which the error of the frequency vanishes as the small parameter
            does; of a motion followed from its start that of `max_deviation`, over times that
            grow as the small parameter becomes less, and of a steady driven motion that of
            `max_deviation`. Null where rounding hides it.
        spurious: How many steady motions of the truncated slow equations have no true motion near
            by, at amplitudes at which the last order is more than half of the one before it. Left
            out where there are none.
        steady_states: The steady motions of a driven equation, largest first; empty for any
            other.
        true_frequency: omega of the true motion, in radians per unit of time.
        values: The value of every symbol of the formulas: parameters, amplitude (1 where the
            equation is linear and none was given), definitions, what was chosen, `omega` and
            `pi`. Laws that are written for the size of the amplitude have its size here. A symbol
            that has no real value is left out.
        verdict: Whether |relative_error| is within the tolerance, 0.01 unless another was given.
    """

    at: dict[str, Constant]
    chosen: dict[str, float]
    error_of_omega: float | None
    followed: Followed | None
    frequency: float | None
    judged_on: Literal["omega^2", "omega", "amplitude"]
    max_deviation: float | None
    motion: tuple[HarmonicValue, ...] | None
    no_deviation: str | None
    phase: float
    ranges: tuple[Range, ...]
    reason: str | None
    relative_error: float | None
    residual: float | None
    slope: float | None
    spurious: int | None
    steady_states: tuple[SteadyState, ...]
    true_frequency: float
    values: dict[str, float]
    verdict: Literal["pass", "fail"]


Verification.FIELDS = (
    ("at", "at", mapped(Constant.from_json)),
    ("chosen", "chosen", dict),
    ("error_of_omega", "error_of_omega", None),
    ("followed", "followed", Followed.from_json),
    ("frequency", "frequency", None),
    ("judged_on", "judged_on", None),
    ("max_deviation", "max_deviation", None),
    ("motion", "motion", several(HarmonicValue.from_json)),
    ("no_deviation", "no_deviation", None),
    ("phase", "phase", None),
    ("ranges", "ranges", several(Range.from_json)),
    ("reason", "reason", None),
    ("relative_error", "relative_error", None),
    ("residual", "residual", None),
    ("slope", "slope", None),
    ("spurious", "spurious", None),
    ("steady_states", "steady_states", several(SteadyState.from_json)),
    ("true_frequency", "true_frequency", None),
    ("values", "values", dict),
    ("verdict", "verdict", None),
)
Verification.OPTIONAL = frozenset(['no_deviation', 'spurious'])


@dataclass(frozen=True, eq=False, repr=False)
class Barrier(Document):
    """The places of the barriers.

    Attributes:
        left: The left one, in radians; null where there is none.
        right: The right one, in radians; null where there is none.
    """

    left: float | None
    right: float | None


Barrier.FIELDS = (
    ("left", "left", None),
    ("right", "right", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class MainMass(Document):
    """A main mass on spring and dashpot that carries the pendulum.

    Attributes:
        damping: The coefficient of its dashpot, in N s/m.
        displacement: Where it begins, in m.
        mass: Its mass without the pendulum, in kg.
        speed: How fast it begins, in m/s.
        stiffness: The stiffness of its spring, in N/m.
    """

    damping: float
    displacement: float
    mass: float
    speed: float
    stiffness: float


MainMass.FIELDS = (
    ("damping", "damping", None),
    ("displacement", "displacement", None),
    ("mass", "mass", None),
    ("speed", "speed", None),
    ("stiffness", "stiffness", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ContactDissipation(Document):
    """The damping of a contact, in every form.

    Attributes:
        at_speed: The speed at which that is stated, in radians per unit of time; null where
            another form is given.
        at_speed_si: The speed in m/s; left out if the file states no such speed.
        damping: c of the force (k + c d') d^(3/2), in N s/m^(5/2); null where units are not
            known.
        held_fixed: The form in which it is given and held fixed, by its key in a file.
        lambda_: lambda of Hunt and Crossley, in s/m; null where units are not known.
        mu: mu of equation (7), dimensionless.
        mu_over_gamma: mu/gamma, dimensionless.
        restitution: The coefficient of restitution at `touch_speed`, dimensionless; null where no
            barrier is touched.
        stated_restitution: The restitution that is given, dimensionless; null where another form
            is.
        touch_speed: The speed of the first touch without damping, in radians per unit of time;
            null where no barrier is touched.
    """

    at_speed: float | None
    at_speed_si: float | None
    damping: float | None
    held_fixed: Literal["mu", "mu_over_gamma", "lambda", "restitution", "damping"]
    lambda_: float | None
    mu: float
    mu_over_gamma: float
    restitution: float | None
    stated_restitution: float | None
    touch_speed: float | None


ContactDissipation.FIELDS = (
    ("at_speed", "at_speed", None),
    ("at_speed_si", "at_speed_si", None),
    ("damping", "damping", None),
    ("held_fixed", "held_fixed", None),
    ("lambda_", "lambda", None),
    ("mu", "mu", None),
    ("mu_over_gamma", "mu_over_gamma", None),
    ("restitution", "restitution", None),
    ("stated_restitution", "stated_restitution", None),
    ("touch_speed", "touch_speed", None),
)
ContactDissipation.OPTIONAL = frozenset(['at_speed_si'])


@dataclass(frozen=True, eq=False, repr=False)
class FrictionDissipation(Document):
    """A dry friction, in every form.

    Attributes:
        alpha: The torque in units of m g L: the coefficient alpha of equation (7).
        held_fixed: The form in which it is given and held fixed, by its key in a file.
        torque: The torque, in N m; null where units are not known.
    """

    alpha: float
    held_fixed: Literal["alpha", "torque"]
    torque: float | None


FrictionDissipation.FIELDS = (
    ("alpha", "alpha", None),
    ("held_fixed", "held_fixed", None),
    ("torque", "torque", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ViscousDissipation(Document):
    """A viscous damping, in every form.

    Attributes:
        held_fixed: The form in which it is given and held fixed, by its key in a file.
        viscous: The coefficient c = 2 zeta m omega of a force against the velocity of the bob, in
            N s/m; null where units are not known.
        zeta: The fraction zeta of the critical damping.
    """

    held_fixed: Literal["zeta", "viscous"]
    viscous: float | None
    zeta: float


ViscousDissipation.FIELDS = (
    ("held_fixed", "held_fixed", None),
    ("viscous", "viscous", None),
    ("zeta", "zeta", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Dissipation(Document):
    """What damps, each damping in every form.

    Attributes:
        contact: The damping of the contact.
        friction: The dry friction.
        viscous: The viscous damping.
    """

    contact: ContactDissipation
    friction: FrictionDissipation
    viscous: ViscousDissipation


Dissipation.FIELDS = (
    ("contact", "contact", ContactDissipation.from_json),
    ("friction", "friction", FrictionDissipation.from_json),
    ("viscous", "viscous", ViscousDissipation.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class MotionSample(Document):
    """A state.

    Attributes:
        state: Coordinates and velocities by name: `x`, `x'`.
        t: The time.
    """

    state: dict[str, float]
    t: float


MotionSample.FIELDS = (
    ("state", "state", dict),
    ("t", "t", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Section(Document):
    """Poincare's section.

    Attributes:
        after: From when on the motion is looked at.
        every: The time between two states, a formula; null where it is the zeros of `rising` that
            count.
        rising: What grows through zero, a formula; null where it is the time that counts.
        states: The states, in order.
        touches: The times at which the motion turns back on the section: it touches and does not
            cross it, so that they are no states.
    """

    after: float
    every: str | None
    rising: str | None
    states: tuple[MotionSample, ...]
    touches: tuple[float, ...]


Section.FIELDS = (
    ("after", "after", None),
    ("every", "every", None),
    ("rising", "rising", None),
    ("states", "states", several(MotionSample.from_json)),
    ("touches", "touches", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Wall(Document):
    """A rigid wall.

    Attributes:
        gap: The gap, zero at the wall and positive in front of it.
        restitution: The coefficient of restitution.
    """

    gap: str
    restitution: str


Wall.FIELDS = (
    ("gap", "gap", None),
    ("restitution", "restitution", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Event(Document):
    """An event.

    Attributes:
        both_ways: Whether the event takes place as well where the guard falls through zero.
        guard: The expression that grows through zero there.
        set: The states that are set, each with the formula of its new value.
    """

    both_ways: bool
    guard: str
    set: dict[str, str]


Event.FIELDS = (
    ("both_ways", "both_ways", None),
    ("guard", "guard", None),
    ("set", "set", dict),
)


@dataclass(frozen=True, eq=False, repr=False)
class Axis(Document):
    """A parameter and its values.

    Attributes:
        count: The number of values.
        from_: The first value.
        name: The parameter, by its name in problem files, whose unit its values have.
        spacing: How the values follow each other: `linear` by equal steps, `logarithmic` by equal
            ratios, `list` as they were given.
        to: The last value.
        values: The values, in order.
    """

    count: int
    from_: float
    name: str
    spacing: Literal["linear", "logarithmic", "list"]
    to: float
    values: tuple[float, ...]


Axis.FIELDS = (
    ("count", "count", None),
    ("from_", "from", None),
    ("name", "name", None),
    ("spacing", "spacing", None),
    ("to", "to", None),
    ("values", "values", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class State(Document):
    """A state at the end of a run.

    Attributes:
        t: The time, in units of time.
        velocity: Its rate, in radians per unit of time.
        x: The displacement, in radians.
    """

    t: float
    velocity: float
    x: float


State.FIELDS = (
    ("t", "t", None),
    ("velocity", "velocity", None),
    ("x", "x", None),
)
