"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from .._answer import Answer
from .._document import Document, one_of, several
from .common import Judged, Parameters
from .solution import Solution


@dataclass(frozen=True, eq=False, repr=False)
class DerivedLaw(Document):
    """The law of the derived phases.

    Attributes:
        law: The answer of the method; where `sign` is -1 it is that of the equation of -x.
        amplitude: The value of its amplitude symbol.
        sign: 1, or -1: x is sign times the displacement of `law`.
        frequency: omega, in radians per unit of time.
    """

    law: Solution
    amplitude: float
    sign: float
    frequency: float


DerivedLaw.FIELDS = (
    ("law", "law", Solution.from_json),
    ("amplitude", "amplitude", None),
    ("sign", "sign", None),
    ("frequency", "frequency", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Cosine(Document):
    """x = amplitude cos(frequency s + phase), s = t - start.

    Attributes:
        amplitude: The amplitude with its sign, in radians.
        frequency: The angular frequency, in radians per unit of time.
        phase: The phase at the start, in radians.
    """

    amplitude: float
    frequency: float
    phase: float


Cosine.FIELDS = (
    ("amplitude", "amplitude", None),
    ("frequency", "frequency", None),
    ("phase", "phase", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Amplitude(Document):
    """A complex amplitude.

    Attributes:
        re: The factor of cos(frequency s), in radians.
        im: The factor of -sin(frequency s), in radians.
    """

    re: float
    im: float


Amplitude.FIELDS = (
    ("re", "re", None),
    ("im", "im", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Oscillation(Document):
    """x = centre + re cos(frequency s) - im sin(frequency s), s = t - start.

    Attributes:
        centre: The point oscillated about, in radians.
        amplitude: The complex amplitude.
        frequency: The angular frequency, in radians per unit of time.
    """

    centre: float
    amplitude: Amplitude
    frequency: float


Oscillation.FIELDS = (
    ("centre", "centre", None),
    ("amplitude", "amplitude", Amplitude.from_json),
    ("frequency", "frequency", None),
)


#: The numbers of a closed form of one wave, with the time s = t - start of its phase.
Coefficients: TypeAlias = Oscillation | Cosine


@dataclass(frozen=True, eq=False, repr=False)
class PhaseHarmonic(Document):
    """A harmonic of a phase, in numbers.

    Attributes:
        harmonic: Its number.
        cos: The factor of the cosine, in radians.
        sin: The factor of the sine, in radians.
    """

    harmonic: int
    cos: float
    sin: float


PhaseHarmonic.FIELDS = (
    ("harmonic", "harmonic", None),
    ("cos", "cos", None),
    ("sin", "sin", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PhaseDisplacement(Document):
    """x = centre + parabola * s * (duration - s) + the sum of cos * cos(harmonic * frequency * s) +
    sin * sin(harmonic * frequency * s), with s = t - clock.

    Attributes:
        centre: What does not oscillate, in radians.
        parabola: What the force at the touch bends the motion by: zero in flight, in radians per
            unit of time squared.
        frequency: The angular frequency of the first harmonic, in radians per unit of time.
        duration: How long the phase lasts, in units of time: `end` less `start`, with all digits
            also where it is short.
        harmonics: The harmonics.
    """

    centre: float
    parabola: float
    frequency: float
    duration: float
    harmonics: tuple[PhaseHarmonic, ...]


PhaseDisplacement.FIELDS = (
    ("centre", "centre", None),
    ("parabola", "parabola", None),
    ("frequency", "frequency", None),
    ("duration", "duration", None),
    ("harmonics", "harmonics", several(PhaseHarmonic.from_json)),
)


#: The name of a phase.
PhaseName: TypeAlias = Literal["approach", "contact", "return"]


@dataclass(frozen=True, eq=False, repr=False)
class State(Document):
    """A state of the pendulum.

    Attributes:
        x: The displacement, in radians.
        velocity: Its rate, in radians per unit of time.
    """

    x: float
    velocity: float


State.FIELDS = (
    ("x", "x", None),
    ("velocity", "velocity", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Phase(Document):
    """One phase of the motion. Its closed form counts the time s = t - clock.

    Attributes:
        name: Which phase it is.
        start: The time t since the release at which it begins, in units of time.
        end: The time t since the release at which it ends, in units of time.
        clock: The time t since the release from which its closed form counts, in units of time:
            its start, or the end of a derived return.
        start_state: The state at its start.
        end_state: The state at its end.
        closed_form: The motion as text; its numbers are rounded, those of `coefficients` are not.
        coefficients: The numbers of the closed form; null in derived phases, which have more than
            one wave.
        displacement: The same motion as a sum of harmonics, whatever its form.
    """

    name: PhaseName
    start: float
    end: float
    clock: float
    start_state: State
    end_state: State
    closed_form: str
    coefficients: Coefficients | None
    displacement: PhaseDisplacement


Phase.FIELDS = (
    ("name", "name", None),
    ("start", "start", None),
    ("end", "end", None),
    ("clock", "clock", None),
    ("start_state", "start_state", State.from_json),
    ("end_state", "end_state", State.from_json),
    ("closed_form", "closed_form", None),
    ("coefficients", "coefficients", one_of(Oscillation, Cosine)),
    ("displacement", "displacement", PhaseDisplacement.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Quantity(Document):
    """One number by each closed form and by Runge-Kutta; null for a reading that does not apply.

    Attributes:
        paper: By `phases`.
        energy: By `energy_phases`.
        derived: By `derived_phases`.
        runge_kutta: By Runge-Kutta on the original equation.
        paper_error: paper / runge_kutta - 1, as a fraction.
        energy_error: energy / runge_kutta - 1, as a fraction.
        derived_error: derived / runge_kutta - 1, as a fraction.
    """

    paper: float | None
    energy: float | None
    derived: float | None
    runge_kutta: float
    paper_error: float | None
    energy_error: float | None
    derived_error: float | None


Quantity.FIELDS = (
    ("paper", "paper", None),
    ("energy", "energy", None),
    ("derived", "derived", None),
    ("runge_kutta", "runge_kutta", None),
    ("paper_error", "paper_error", None),
    ("energy_error", "energy_error", None),
    ("derived_error", "derived_error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Contact(Document):
    """The numbers of the contact.

    Attributes:
        speed: The speed at the touch, in radians per unit of time.
        penetration: The greatest depth in the barrier, in radians.
        duration: The time from touch to release, in units of time.
    """

    speed: Quantity
    penetration: Quantity
    duration: Quantity


Contact.FIELDS = (
    ("speed", "speed", Quantity.from_json),
    ("penetration", "penetration", Quantity.from_json),
    ("duration", "duration", Quantity.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class ContactDamping(Document):
    """A contact that loses energy: its force is gamma F(d) (1 + lambda d') by Hunt and Crossley,
    gamma (d + lambda d') of a spring with a dashpot.

    Attributes:
        lambda_: The damping, in units of time per radian, of a dashpot in those of time.
        restitution: The speed out over the speed in.
        exit_speed: The speed at the end of the contact, in radians per unit of time.
        energy_lost: The energy lost, per unit of mass, in radians squared per unit of time
            squared.
        peak_force: The greatest force of the derived contact, per unit of mass; null where there
            are no derived phases.
        small_damping: The restitution 1 - (2/3) lambda v of small damping, good to 1 % where
            lambda v, with v the speed at the touch, is below 0.15; null where there are no
            derived phases, and with a dashpot.
    """

    lambda_: float
    restitution: Quantity
    exit_speed: Quantity
    energy_lost: Quantity
    peak_force: float | None
    small_damping: Judged | None


ContactDamping.FIELDS = (
    ("lambda_", "lambda", None),
    ("restitution", "restitution", Quantity.from_json),
    ("exit_speed", "exit_speed", Quantity.from_json),
    ("energy_lost", "energy_lost", Quantity.from_json),
    ("peak_force", "peak_force", None),
    ("small_damping", "small_damping", Judged.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class ContactLawRow(Document):
    """One law of the contact.

    Attributes:
        law: Its name, as in a problem file.
        applies: Whether it applies.
        reason: Why it does not, in words; null where it does.
        duration: The time from touch to release, in units of time, its error from the exact law;
            this and the rest is null where the law does not apply.
        penetration: The greatest depth, in radians.
        peak_force: The whole force at that depth, per unit of mass, in radians per unit of time
            squared.
        max_deviation: The largest difference of depth at the same time since the touch, as a
            fraction of the greatest depth.
    """

    law: Literal["least-squares", "least-squares-origin", "equal-energy", "equal-peak-force", "harmonic-balance", "equal-duration", "homotopy", "iteration", "homotopy-2", "harmonic-balance-2", "harmonic-balance-3", "power-law", "power-law-corrected", "exact"]
    applies: bool
    reason: str | None
    duration: Judged | None
    penetration: Judged | None
    peak_force: Judged | None
    max_deviation: float | None


ContactLawRow.FIELDS = (
    ("law", "law", None),
    ("applies", "applies", None),
    ("reason", "reason", None),
    ("duration", "duration", Judged.from_json),
    ("penetration", "penetration", Judged.from_json),
    ("peak_force", "peak_force", Judged.from_json),
    ("max_deviation", "max_deviation", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class LossyLawRow(Document):
    """One law of a contact that loses energy, in closed form without the force of the swing, beside
    Runge-Kutta with it.

    Attributes:
        law: Its name, as in a problem file.
        stiffness: The stiffness: the force per unit of mass at depth one at rest; of a spring
            with a dashpot that of equal energy at the greatest depth of the barrier without loss.
        lambda_: The damping lambda, time per unit of depth; of a dashpot in units of time.
        duration: The time from touch to release, in units of time.
        penetration: The greatest depth.
        peak_force: The greatest force of the contact, per unit of mass.
        restitution: The speed after the contact over that before.
    """

    law: Literal["hunt-crossley", "kelvin-voigt", "kelvin-voigt-no-pull"]
    stiffness: float
    lambda_: float
    duration: Judged
    penetration: Judged
    peak_force: Judged
    restitution: Judged


LossyLawRow.FIELDS = (
    ("law", "law", None),
    ("stiffness", "stiffness", None),
    ("lambda_", "lambda", None),
    ("duration", "duration", Judged.from_json),
    ("penetration", "penetration", Judged.from_json),
    ("peak_force", "peak_force", Judged.from_json),
    ("restitution", "restitution", Judged.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Line(Document):
    """The line slope * x + constant that replaces (x - barrier)^(3/2), per unit of gamma.

    Attributes:
        slope: The slope.
        constant: The value at x = 0.
    """

    slope: float
    constant: float


Line.FIELDS = (
    ("slope", "slope", None),
    ("constant", "constant", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Column(Document):
    """The judgement of three phases.

    Attributes:
        velocity_jump: The jump of the velocity at either end of the contact, in radians per unit
            of time.
        line: The line that replaces the force of the barrier; null in the derived reading, which
            has none.
        max_deviation: The largest |x - x_true| over the period, as a fraction of the amplitude.
        max_deviation_by_phase: The same in approach, contact and return.
        max_deviation_of_shape: The same with the clock of each phase set right: of the flights as
            a fraction of the amplitude, of the contact as one of the true depth.
        verdict: Whether every quantity and every phase on its own clock is within the tolerance.
    """

    velocity_jump: float
    line: Line | None
    max_deviation: float
    max_deviation_by_phase: tuple[float, float, float]
    max_deviation_of_shape: tuple[float, float, float]
    verdict: Literal["pass", "fail"]


Column.FIELDS = (
    ("velocity_jump", "velocity_jump", None),
    ("line", "line", Line.from_json),
    ("max_deviation", "max_deviation", None),
    ("max_deviation_by_phase", "max_deviation_by_phase", tuple),
    ("max_deviation_of_shape", "max_deviation_of_shape", tuple),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactVerification(Document):
    """The closed forms beside the true motion.

    Attributes:
        tolerance: The size of the relative error up to which a verdict is `pass`.
        energy_drift: How well Runge-Kutta keeps the energy, as a fraction of the kinetic energy
            at the touch.
        paper: What is said of `phases`.
        energy: What is said of `energy_phases`.
        derived: What is said of `derived_phases`.
        verdict: The verdict on `phases`; where the paper's reading does not apply, on
            `derived_phases`.
    """

    tolerance: float
    energy_drift: float
    paper: Column | None
    energy: Column | None
    derived: Column | None
    verdict: Literal["pass", "fail"]


ImpactVerification.FIELDS = (
    ("tolerance", "tolerance", None),
    ("energy_drift", "energy_drift", None),
    ("paper", "paper", Column.from_json),
    ("energy", "energy", Column.from_json),
    ("derived", "derived", Column.from_json),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OverPrinted(Document):
    """A contact time over the printed one.

    Attributes:
        ratio: The contact time of this reading over the printed one.
        verdict: Whether that is one within the tolerance.
    """

    ratio: float
    verdict: Literal["reproduced", "not-reproduced"]


OverPrinted.FIELDS = (
    ("ratio", "ratio", None),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrintedContactTime(Document):
    """The contact time that the paper prints, compared with and never computed from.

    Attributes:
        value: As printed, in s.
        runge_kutta: By Runge-Kutta.
        paper: By `phases`; null where the paper's reading does not apply.
        energy: By `energy_phases`; null likewise.
        derived: By `derived_phases`; null where there are none.
    """

    value: float
    runge_kutta: OverPrinted
    paper: OverPrinted | None
    energy: OverPrinted | None
    derived: OverPrinted | None


PrintedContactTime.FIELDS = (
    ("value", "value", None),
    ("runge_kutta", "runge_kutta", OverPrinted.from_json),
    ("paper", "paper", OverPrinted.from_json),
    ("energy", "energy", OverPrinted.from_json),
    ("derived", "derived", OverPrinted.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class YieldLimit(Document):
    """A yield limit that is stated.

    Attributes:
        body: Whose it is.
        limit: The limit Y, in Pa.
        onset: The peak pressure at which the body begins to yield, 1.6 Y, in Pa.
        exceeded: Whether the peak pressure of Runge-Kutta is above that: then the theory is
            outside its range.
    """

    body: Literal["sphere", "barrier"]
    limit: float
    onset: float
    exceeded: bool


YieldLimit.FIELDS = (
    ("body", "body", None),
    ("limit", "limit", None),
    ("onset", "onset", None),
    ("exceeded", "exceeded", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Si(Document):
    """The numbers of an impact in SI units: m L^2 x'' + m g L sin x + k L (L (x - x_c))^(3/2) = 0.

    Attributes:
        mass: The mass m, in kg.
        length: The length L, in m.
        gravity: The acceleration of gravity g, in m/s^2.
        radius: The radius R of the sphere, in m; null where gamma is given and it is not.
        modulus: The modulus E of the contact, in Pa; null where gamma is given.
        modulus_of: Whose modulus that is: `barrier` alone as in the paper, `rigid-sphere` for
            E1/(1 - nu1^2), or `both`; null where gamma is given.
        contact_stiffness: The stiffness k of the contact, in N/m^(3/2): gamma m g / L^(3/2).
        time_unit: The unit of time sqrt(L/g), in s.
        speed_unit: The unit of speed sqrt(g L), in m/s.
        force_unit: The unit of force m g, in N.
        energy_unit: The unit of energy m g L, in J.
        time_to_contact: The time from the release to the touch, in s.
        speed: The speed at the touch, in m/s.
        energy: The kinetic energy at the touch, in J.
        penetration: The greatest depth in the barrier, in m.
        duration: The time from touch to release, in s.
        period: The time from release to release, in s.
        peak_force: The greatest force of the contact, that of the damping included, in N; without
            damping it is that at the greatest depth.
        peak_pressure: The pressure in the middle of the contact at the greatest depth, in Pa;
            null without a radius.
        printed_contact_time: The contact time that the paper prints, beside that of every
            reading.
        yield_limits: The yield limits that are stated, beside the peak pressure of Runge-Kutta.
    """

    mass: float
    length: float
    gravity: float
    radius: float | None
    modulus: float | None
    modulus_of: Literal["barrier", "rigid-sphere", "both"] | None
    contact_stiffness: float
    time_unit: float
    speed_unit: float
    force_unit: float
    energy_unit: float
    time_to_contact: Quantity
    speed: Quantity
    energy: Quantity
    penetration: Quantity
    duration: Quantity
    period: Quantity
    peak_force: Quantity
    peak_pressure: Quantity | None
    printed_contact_time: PrintedContactTime
    yield_limits: tuple[YieldLimit, ...]


Si.FIELDS = (
    ("mass", "mass", None),
    ("length", "length", None),
    ("gravity", "gravity", None),
    ("radius", "radius", None),
    ("modulus", "modulus", None),
    ("modulus_of", "modulus_of", None),
    ("contact_stiffness", "contact_stiffness", None),
    ("time_unit", "time_unit", None),
    ("speed_unit", "speed_unit", None),
    ("force_unit", "force_unit", None),
    ("energy_unit", "energy_unit", None),
    ("time_to_contact", "time_to_contact", Quantity.from_json),
    ("speed", "speed", Quantity.from_json),
    ("energy", "energy", Quantity.from_json),
    ("penetration", "penetration", Quantity.from_json),
    ("duration", "duration", Quantity.from_json),
    ("period", "period", Quantity.from_json),
    ("peak_force", "peak_force", Quantity.from_json),
    ("peak_pressure", "peak_pressure", Quantity.from_json),
    ("printed_contact_time", "printed_contact_time", PrintedContactTime.from_json),
    ("yield_limits", "yield_limits", several(YieldLimit.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class Impact(Answer):
    """A swing released from rest that hits an elastic barrier: approach, contact and return in closed
    form, beside Runge-Kutta on the original equation. For the pendulum angles are in radians
    and time is in units of 1/omega of small swings, sqrt(L/g); for an equation of the user's
    both have its units.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion that is judged, `... = 0`, its force on the barrier
            included.
        parameters: The numbers of the problem.
        law: The law of the free swing in the paper's reading, as a document of its own; null
            where that reading does not apply.
        frequency: omega of approach and return by that law, in radians per unit of time.
        derived_law: The law of the derived phases, as a document of its own; null where there are
            none.
        phases: The three phases as the paper has them: the contact begins with the speed of the
            cosine, every join is continuous.
        energy_phases: The three phases with the contact speed from the energy: the velocity jumps
            at both joins by `velocity_jump`.
        derived_phases: The three phases with every harmonic of a derived motion, all joins from
            it; empty where no method gives one.
        contact: The numbers of the contact.
        contact_damping: What the contact loses; null where it loses nothing.
        contact_laws: Every law of the contact at the speed of the touch by the energy; null where
            they are not asked for.
        lossy_laws: Every law of a contact that loses energy, for one restitution at the speed of
            the touch by the energy; absent where they are not asked for.
        time_to_contact: The time from the release to the touch, in units of time.
        period: The time from release to release, in units of time; where the contact loses
            energy, to the turning point after it.
        verification: What Runge-Kutta says of the phases.
        si: The same quantities in SI units: of the pendulum with the contact of Hertz, where
            gamma follows from the design or mass, length and gravity are given; null elsewhere,
            and where a number would be beyond the range of floating point.
    """

    schema: Literal["lindstedt/impact/1"]
    equation: str
    parameters: Parameters
    law: Solution | None
    frequency: float | None
    derived_law: DerivedLaw | None
    phases: tuple[Phase, ...]
    energy_phases: tuple[Phase, ...]
    derived_phases: tuple[Phase, ...]
    contact: Contact
    contact_damping: ContactDamping | None
    contact_laws: tuple[ContactLawRow, ...] | None
    lossy_laws: tuple[LossyLawRow, ...] | None
    time_to_contact: Quantity
    period: Quantity
    verification: ImpactVerification
    si: Si | None


Impact.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("parameters", "parameters", Parameters.from_json),
    ("law", "law", Solution.from_json),
    ("frequency", "frequency", None),
    ("derived_law", "derived_law", DerivedLaw.from_json),
    ("phases", "phases", several(Phase.from_json)),
    ("energy_phases", "energy_phases", several(Phase.from_json)),
    ("derived_phases", "derived_phases", several(Phase.from_json)),
    ("contact", "contact", Contact.from_json),
    ("contact_damping", "contact_damping", ContactDamping.from_json),
    ("contact_laws", "contact_laws", several(ContactLawRow.from_json)),
    ("lossy_laws", "lossy_laws", several(LossyLawRow.from_json)),
    ("time_to_contact", "time_to_contact", Quantity.from_json),
    ("period", "period", Quantity.from_json),
    ("verification", "verification", ImpactVerification.from_json),
    ("si", "si", Si.from_json),
)
Impact.OPTIONAL = frozenset(['lossy_laws'])
