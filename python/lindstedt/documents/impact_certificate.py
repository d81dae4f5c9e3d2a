"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class PowerOfDepth(Document):
    """A force `stiffness * depth^exponent`.

    Attributes:
        stiffness: The factor.
        exponent: The exponent of the depth.
    """

    stiffness: Constant
    exponent: Constant


PowerOfDepth.FIELDS = (
    ("stiffness", "stiffness", Constant.from_json),
    ("exponent", "exponent", Constant.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class EnclosedNumber(Document):
    """A number with a bound of its distance from the digits that are printed.

    Attributes:
        middle: The digits that are known, as text.
        radius: The number is no farther than this from `middle`.
    """

    middle: str
    radius: float


EnclosedNumber.FIELDS = (
    ("middle", "middle", None),
    ("radius", "radius", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class EnclosedNumberOfPhases(Document):
    """The numbers of an impact, or their errors.

    Attributes:
        time_to_contact: The time from the release to the touch.
        speed: The speed at the touch.
        penetration: The greatest depth in the barrier.
        duration: The time from touch to release.
        period: The time from release to release; of a contact that loses energy until the motion
            turns after the impact.
        restitution: The speed after the contact over that before; left out where the contact
            loses nothing.
        speed_out: The speed after the contact; left out where the contact loses nothing.
    """

    time_to_contact: EnclosedNumber
    speed: EnclosedNumber
    penetration: EnclosedNumber
    duration: EnclosedNumber
    period: EnclosedNumber
    restitution: EnclosedNumber | None
    speed_out: EnclosedNumber | None


EnclosedNumberOfPhases.FIELDS = (
    ("time_to_contact", "time_to_contact", EnclosedNumber.from_json),
    ("speed", "speed", EnclosedNumber.from_json),
    ("penetration", "penetration", EnclosedNumber.from_json),
    ("duration", "duration", EnclosedNumber.from_json),
    ("period", "period", EnclosedNumber.from_json),
    ("restitution", "restitution", EnclosedNumber.from_json),
    ("speed_out", "speed_out", EnclosedNumber.from_json),
)
EnclosedNumberOfPhases.OPTIONAL = frozenset(['restitution', 'speed_out'])


@dataclass(frozen=True, eq=False, repr=False)
class ErrorBounds(Document):
    """The ends between which the size of a relative error lies, proved.

    Attributes:
        lower: The lower end.
        upper: The upper end; null where there is none.
    """

    lower: float
    upper: float | None


ErrorBounds.FIELDS = (
    ("lower", "lower", None),
    ("upper", "upper", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ErrorBoundsOfPhases(Document):
    """The numbers of an impact, or their errors.

    Attributes:
        time_to_contact: The time from the release to the touch.
        speed: The speed at the touch.
        penetration: The greatest depth in the barrier.
        duration: The time from touch to release.
        period: The time from release to release; of a contact that loses energy until the motion
            turns after the impact.
        restitution: The speed after the contact over that before; left out where the contact
            loses nothing.
        speed_out: The speed after the contact; left out where the contact loses nothing.
    """

    time_to_contact: ErrorBounds
    speed: ErrorBounds
    penetration: ErrorBounds
    duration: ErrorBounds
    period: ErrorBounds
    restitution: ErrorBounds | None
    speed_out: ErrorBounds | None


ErrorBoundsOfPhases.FIELDS = (
    ("time_to_contact", "time_to_contact", ErrorBounds.from_json),
    ("speed", "speed", ErrorBounds.from_json),
    ("penetration", "penetration", ErrorBounds.from_json),
    ("duration", "duration", ErrorBounds.from_json),
    ("period", "period", ErrorBounds.from_json),
    ("restitution", "restitution", ErrorBounds.from_json),
    ("speed_out", "speed_out", ErrorBounds.from_json),
)
ErrorBoundsOfPhases.OPTIONAL = frozenset(['restitution', 'speed_out'])


@dataclass(frozen=True, eq=False, repr=False)
class ProvedClosedForm(Document):
    """A closed form and its proved errors.

    Attributes:
        name: `paper`, `energy` or `derived`.
        errors: The relative errors of its numbers.
        beyond: The keys of the numbers that are not proved to be within the tolerance.
        verdict: Whether every number is proved to be within the tolerance.
    """

    name: str
    errors: ErrorBoundsOfPhases
    beyond: tuple[str, ...]
    verdict: Literal["pass", "fail"]


ProvedClosedForm.FIELDS = (
    ("name", "name", None),
    ("errors", "errors", ErrorBoundsOfPhases.from_json),
    ("beyond", "beyond", tuple),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactCertificate(Answer):
    """The numbers of an impact between a pendulum and a barrier of a power law, each enclosed by a
    proof. Times in units of 1/omega, angles in radians.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion, `... = 0`.
        amplitude: The amplitude: the motion is released from rest at x = -amplitude.
        barrier: The place of the barrier.
        stiffness: The stiffness of the barrier, whose force is `stiffness * depth^exponent`.
        exponent: The exponent of the depth, 3/2 of Hertz's law.
        further_powers: Further powers of the depth, which are added to the force.
        damping: The damping of a contact that loses energy, whose force is `stiffness *
            depth^exponent * (1 + damping * depth')` by the law `hunt-crossley`, `stiffness *
            (depth + damping * depth')` by `kelvin-voigt`.
        proved: The enclosed numbers.
        tolerance: The size of the relative error up to which a verdict is `pass`.
        runge_kutta: The relative errors of Runge-Kutta.
        closed_forms: The closed forms: the paper's readings and the derived one.
    """

    schema: Literal["lindstedt/impact-certificate/1"]
    equation: str
    amplitude: Constant
    barrier: Constant
    stiffness: Constant
    exponent: Constant
    further_powers: tuple[PowerOfDepth, ...] | None
    damping: Constant | None
    proved: EnclosedNumberOfPhases
    tolerance: float
    runge_kutta: ErrorBoundsOfPhases
    closed_forms: tuple[ProvedClosedForm, ...]


ImpactCertificate.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("amplitude", "amplitude", Constant.from_json),
    ("barrier", "barrier", Constant.from_json),
    ("stiffness", "stiffness", Constant.from_json),
    ("exponent", "exponent", Constant.from_json),
    ("further_powers", "further_powers", several(PowerOfDepth.from_json)),
    ("damping", "damping", Constant.from_json),
    ("proved", "proved", EnclosedNumberOfPhases.from_json),
    ("tolerance", "tolerance", None),
    ("runge_kutta", "runge_kutta", ErrorBoundsOfPhases.from_json),
    ("closed_forms", "closed_forms", several(ProvedClosedForm.from_json)),
)
ImpactCertificate.OPTIONAL = frozenset(['damping', 'further_powers'])
