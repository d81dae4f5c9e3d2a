"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several


@dataclass(frozen=True, eq=False, repr=False)
class Printed(Document):
    """A number that the paper prints, and how its digits come out with the best value of pi.

    Attributes:
        text: The number as it is printed.
        rounded: Whether its digits are those of the rounded number.
        cut: Whether its digits are those of the number cut off.
    """

    text: str
    rounded: bool
    cut: bool


Printed.FIELDS = (
    ("text", "text", None),
    ("rounded", "rounded", None),
    ("cut", "cut", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Speed(Document):
    """The two laws at one speed.

    Attributes:
        speed: The speed, in radians per unit of time.
        sign: Coulomb's law, sgn(x').
        arctangent: Equation (6), with pi itself.
        error: How far it is from Coulomb's law, in per cent.
        printed_value: The value that the paper prints; null at a speed that is not the paper's.
        printed_error: The error in per cent that the paper prints; null likewise.
    """

    speed: float
    sign: float
    arctangent: float
    error: float
    printed_value: Printed | None
    printed_error: Printed | None


Speed.FIELDS = (
    ("speed", "speed", None),
    ("sign", "sign", None),
    ("arctangent", "arctangent", None),
    ("error", "error", None),
    ("printed_value", "printed_value", Printed.from_json),
    ("printed_error", "printed_error", Printed.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class PiReading(Document):
    """How many of the printed entries come out with one value of pi.

    Attributes:
        pi: The value as it is written, such as `22/7`.
        value: The value.
        rounded: The number of entries that come out rounded.
        cut: The number of entries that come out cut off.
        either: The number of entries that come out in one of the two ways.
        limit: What the arctangent tends to at high speed.
        exceeds_from: The speed beyond which it is larger than 1, in radians per unit of time;
            null where there is none.
    """

    pi: str
    value: float
    rounded: int
    cut: int
    either: int
    limit: float
    exceeds_from: float | None


PiReading.FIELDS = (
    ("pi", "pi", None),
    ("value", "value", None),
    ("rounded", "rounded", None),
    ("cut", "cut", None),
    ("either", "either", None),
    ("limit", "limit", None),
    ("exceeds_from", "exceeds_from", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class FirstCycle(Document):
    """The first cycle by the arctangent.

    Attributes:
        until: When it ends, in units of time.
        largest_error: The largest error of the force, as a fraction of alpha: all of it, where
            the motion turns back.
        over_one_percent: The part of the time in which the force errs by more than 1 % of alpha.
        over_ten_percent: The part of the time in which it errs by more than 10 %.
        work_share: The work of the arctangent along this motion over that of Coulomb's law.
        work_share_formula: The same by the formula of a harmonic swing, (sqrt(1 + k^2) - 1)/k
            with k = 100 times the greatest speed.
    """

    until: float
    largest_error: float
    over_one_percent: float
    over_ten_percent: float
    work_share: float
    work_share_formula: float


FirstCycle.FIELDS = (
    ("until", "until", None),
    ("largest_error", "largest_error", None),
    ("over_one_percent", "over_one_percent", None),
    ("over_ten_percent", "over_ten_percent", None),
    ("work_share", "work_share", None),
    ("work_share_formula", "work_share_formula", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Stop(Document):
    """Where Coulomb's law stops the swing for good.

    Attributes:
        t: When, in units of time.
        x: Where, in radians.
        half_swings: After how many half swings.
        arctangent_x: Where the arctangent has taken the swing by then, in radians.
        arctangent_velocity: The velocity by the arctangent, in radians per unit of time.
    """

    t: float
    x: float
    half_swings: int
    arctangent_x: float
    arctangent_velocity: float


Stop.FIELDS = (
    ("t", "t", None),
    ("x", "x", None),
    ("half_swings", "half_swings", None),
    ("arctangent_x", "arctangent_x", None),
    ("arctangent_velocity", "arctangent_velocity", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class CreepSample(Document):
    """A state after the stop.

    Attributes:
        t: The time since both were at rest where Coulomb's law stops the swing, in units of time.
        x: Where the arctangent has taken it, in radians; Coulomb's law leaves it where it is.
        formula: The same by the formula without inertia, in radians; null where it swings.
    """

    t: float
    x: float
    formula: float | None


CreepSample.FIELDS = (
    ("t", "t", None),
    ("x", "x", None),
    ("formula", "formula", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Creep(Document):
    """The motion by the arctangent near rest.

    Attributes:
        damping: The linear damping c near rest, x'' + c x' + x = 0: 200 alpha/pi.
        creeps: Whether it creeps, c > 2; it swings about zero otherwise.
        rate_overdamped: The rate without inertia, pi/(200 alpha), per unit of time; null where it
            swings.
        rate_linear: The rate of the linear equation, per unit of time.
        rate: The rate of the simulated motion when it is small, per unit of time; null where it
            does not move.
        samples: Some states.
    """

    damping: float
    creeps: bool
    rate_overdamped: float | None
    rate_linear: float
    rate: float | None
    samples: tuple[CreepSample, ...]


Creep.FIELDS = (
    ("damping", "damping", None),
    ("creeps", "creeps", None),
    ("rate_overdamped", "rate_overdamped", None),
    ("rate_linear", "rate_linear", None),
    ("rate", "rate", None),
    ("samples", "samples", several(CreepSample.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class RestTime(Document):
    """Rest times by either law, in units of time.

    Attributes:
        coulomb: By Coulomb's law; null where there is none.
        coulomb_reason: Why there is none, in words; null where there is one.
        arctangent: By the arctangent; null where there is none.
        arctangent_reason: Why there is none, in words; null where there is one.
        difference: How much later the arctangent comes to rest; null where one of them does not.
    """

    coulomb: float | None
    coulomb_reason: str | None
    arctangent: float | None
    arctangent_reason: str | None
    difference: float | None


RestTime.FIELDS = (
    ("coulomb", "coulomb", None),
    ("coulomb_reason", "coulomb_reason", None),
    ("arctangent", "arctangent", None),
    ("arctangent_reason", "arctangent_reason", None),
    ("difference", "difference", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Friction(Answer):
    """The paper's equation (6), (2/pi) atan(100 x') in place of Coulomb's sgn(x'), beside that law:
    Table 1 of the paper, and a swing near rest. Angles are in radians, time is in units of
    1/omega of small swings, sqrt(L/g).

    Attributes:
        schema: The kind of document.
        alpha: The friction alpha, the torque in units of m g L.
        amplitude: The release, from rest at x = -amplitude, in radians.
        steepness: The factor of the velocity in the arctangent.
        speeds: The two laws at the paper's speeds, then at those asked for.
        printed_entries: The number of entries that the paper prints, values and errors.
        pi: The value of pi with which most of them come out, by its name in `readings`.
        pi_range: The least and the greatest pi with which all of them come out, rounded or cut;
            null where none does.
        readings: Every value of pi that was tried.
        first_cycle: The first cycle of the swing by the arctangent.
        stop: Where Coulomb's law stops the swing for good.
        creep: What the arctangent does from rest at that place.
        rest_time: The rest times on the paper's damper, pendulum and barrier, with this friction
            alone.
    """

    schema: Literal["lindstedt/friction/1"]
    alpha: float
    amplitude: float
    steepness: float
    speeds: tuple[Speed, ...]
    printed_entries: int
    pi: str
    pi_range: tuple[float, float] | None
    readings: tuple[PiReading, ...]
    first_cycle: FirstCycle
    stop: Stop
    creep: Creep
    rest_time: RestTime


Friction.FIELDS = (
    ("schema", "schema", None),
    ("alpha", "alpha", None),
    ("amplitude", "amplitude", None),
    ("steepness", "steepness", None),
    ("speeds", "speeds", several(Speed.from_json)),
    ("printed_entries", "printed_entries", None),
    ("pi", "pi", None),
    ("pi_range", "pi_range", tuple),
    ("readings", "readings", several(PiReading.from_json)),
    ("first_cycle", "first_cycle", FirstCycle.from_json),
    ("stop", "stop", Stop.from_json),
    ("creep", "creep", Creep.from_json),
    ("rest_time", "rest_time", RestTime.from_json),
)
