"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberRelation(Document):
    """An equation on the way to the designs.

    Attributes:
        equation: The equation.
        words: What it says, in words.
    """

    equation: str
    words: str


AbsorberRelation.FIELDS = (
    ("equation", "equation", None),
    ("words", "words", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberFormula(Document):
    """A formula of a design.

    Attributes:
        name: The name of the quantity, such as `tuning` or `damping`.
        symbol: The symbol of the quantity.
        formula: The formula.
        value: Its value; null without values, and where there is no such design (no positive
            value).
        truth: The true value, by a search over the responses or motions of the two masses; null
            without values, and where none was found.
        relative_error: `value/truth - 1`; null likewise.
    """

    name: str
    symbol: str
    formula: str
    value: float | None
    truth: float | None
    relative_error: float | None


AbsorberFormula.FIELDS = (
    ("name", "name", None),
    ("symbol", "symbol", None),
    ("formula", "formula", None),
    ("value", "value", None),
    ("truth", "truth", None),
    ("relative_error", "relative_error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberDesign(Document):
    """A way to choose the absorber, or a property of it.

    Attributes:
        name: The name: `equal-peaks`, `lowest-peak` and `lowest-variance` of a tuned mass damper,
            `similar-springs` of a nonlinear absorber, `threshold` and `period-doubling` of an
            impact or pendulum sink, `upward-jump` and `downward-jump` of a cubic sink.
        words: What is best of it, in words.
        formulas: Its formulas.
    """

    name: str
    words: str
    formulas: tuple[AbsorberFormula, ...]


AbsorberDesign.FIELDS = (
    ("name", "name", None),
    ("words", "words", None),
    ("formulas", "formulas", several(AbsorberFormula.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class LowestPeak(Document):
    """The tuned mass damper with which the highest amplitude at any frequency is the least.

    Attributes:
        tuning: The natural frequency of the absorber alone over that of the main mass alone.
        damping: The damping ratio of the absorber alone.
        height: The highest amplitude over the static one.
    """

    tuning: float
    damping: float
    height: float


LowestPeak.FIELDS = (
    ("tuning", "tuning", None),
    ("damping", "damping", None),
    ("height", "height", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberDecay(Document):
    """The time in which the amplitude of the main mass falls, on a simulated motion.

    Attributes:
        amplitudes: The amplitudes of the main mass at the start and at the end.
        formula: The time by the formula, in units of 1/(the frequency of the main mass).
        truth: The time of the simulated motion.
    """

    amplitudes: tuple[float, float]
    formula: float
    truth: float


AbsorberDecay.FIELDS = (
    ("amplitudes", "amplitudes", tuple),
    ("formula", "formula", None),
    ("truth", "truth", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberMotion(Document):
    """A simulated motion that follows the manifold of a sink.

    Attributes:
        words: What is simulated, in words.
        start: The amplitude of the main mass at the start.
        end: The amplitude of the main mass where the motion leaves the manifold.
        largest_distance: The largest distance of its two amplitudes from those on the manifold,
            over those of the start.
        decay: The time that it takes; null where there is no formula of it.
    """

    words: str
    start: float
    end: float
    largest_distance: float
    decay: AbsorberDecay | None


AbsorberMotion.FIELDS = (
    ("words", "words", None),
    ("start", "start", None),
    ("end", "end", None),
    ("largest_distance", "largest_distance", None),
    ("decay", "decay", AbsorberDecay.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class AbsorberTouch(Document):
    """The motion with two impacts a period at which the body touches a wall between them.

    Attributes:
        amplitude: The amplitude of the main mass.
        sink: The amplitude of the sink.
    """

    amplitude: float
    sink: float


AbsorberTouch.FIELDS = (
    ("amplitude", "amplitude", None),
    ("sink", "sink", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Absorber(Answer):
    """Design formulas of a vibration absorber, a small mass that takes the vibration of a large one.

    Attributes:
        schema: The kind of document.
        absorber: The kind of absorber: `tuned`, `damped`, `nonlinear`, `impact-sink`, `pendulum-
            sink` or `cubic-sink`.
        excitation: What shakes the main mass of a tuned mass damper, `force` or `ground`; null of
            other kinds.
        equations: The equations of motion.
        letters: The letters of equations and formulas, each with its meaning.
        definitions: The symbols that shorten the formulas.
        relations: The equations from which the designs follow.
        designs: The designs.
        validity: What the formulas leave out, in words.
        at: The values; null without them.
        lowest_peak: The tuned mass damper with the lowest peak, by a search where no formula
            gives it; null otherwise, and without values.
        motion: A simulated motion that follows the manifold of a sink; null without values, of a
            tuned or nonlinear absorber, and where the motion does not follow it.
        touch: The amplitudes at which the body of an impact sink touches a wall between its
            impacts, where its motion ends while it is stable; null where it does not, and without
            values.
        verdict: `pass` or `fail`; null without values.
        tolerance: The largest relative error that passes; null without values.
    """

    schema: Literal["lindstedt/absorber/1"]
    absorber: str
    excitation: str | None
    equations: tuple[str, ...]
    letters: dict[str, str]
    definitions: dict[str, str]
    relations: tuple[AbsorberRelation, ...]
    designs: tuple[AbsorberDesign, ...]
    validity: str
    at: dict[str, Constant] | None
    lowest_peak: LowestPeak | None
    motion: AbsorberMotion | None
    touch: AbsorberTouch | None
    verdict: str | None
    tolerance: float | None


Absorber.FIELDS = (
    ("schema", "schema", None),
    ("absorber", "absorber", None),
    ("excitation", "excitation", None),
    ("equations", "equations", tuple),
    ("letters", "letters", dict),
    ("definitions", "definitions", dict),
    ("relations", "relations", several(AbsorberRelation.from_json)),
    ("designs", "designs", several(AbsorberDesign.from_json)),
    ("validity", "validity", None),
    ("at", "at", mapped(Constant.from_json)),
    ("lowest_peak", "lowest_peak", LowestPeak.from_json),
    ("motion", "motion", AbsorberMotion.from_json),
    ("touch", "touch", AbsorberTouch.from_json),
    ("verdict", "verdict", None),
    ("tolerance", "tolerance", None),
)
