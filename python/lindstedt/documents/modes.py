"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant, Harmonic, Polynomial


@dataclass(frozen=True, eq=False, repr=False)
class ModeBalance(Document):
    """The balance of several harmonics of every coordinate.

    Attributes:
        harmonics: The harmonics that are balanced.
        unknowns: The unknowns: omega and the coefficients of the motion.
        equations: Equations, each of them equal to zero; empty where they are not written out.
    """

    harmonics: tuple[int, ...]
    unknowns: tuple[str, ...]
    equations: tuple[str, ...]


ModeBalance.FIELDS = (
    ("harmonics", "harmonics", tuple),
    ("unknowns", "unknowns", tuple),
    ("equations", "equations", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class ModeBackbonePoint(Document):
    """A motion of a mode at an amplitude.

    Attributes:
        amplitude: The amplitude.
        omega: omega by the formula; null if its square is not positive.
        true_omega: omega of the true motion.
        energy: The energy of the true motion over that of rest; null where the forces have no
            potential that is known.
    """

    amplitude: float
    omega: float | None
    true_omega: float
    energy: float | None


ModeBackbonePoint.FIELDS = (
    ("amplitude", "amplitude", None),
    ("omega", "omega", None),
    ("true_omega", "true_omega", None),
    ("energy", "energy", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ModeVerification(Document):
    """A mode beside the true motion.

    Attributes:
        at: The values.
        omega: omega by the formula; null if its square is not positive.
        law: The coefficients of omega^2 in powers of the amplitude with numbers for all letters,
            the constant first; left out where the formula is no polynomial of it.
        coefficients: The coefficients that a balance has at the values; left out for a series.
        true_omega: omega of the true motion, by shooting.
        relative_error: `omega/true_omega - 1`; null where there is no omega.
        backbone: The mode from small amplitudes up to this one, the linear motion first.
        max_deviation: Largest deviation of a coordinate at the same theta, as a part of the
            largest displacement.
        slope: The measured exponent of the error of omega; null if rounding hides it.
        verdict: `pass` or `fail`.
    """

    at: dict[str, Constant]
    omega: float | None
    law: tuple[float, ...] | None
    coefficients: dict[str, float] | None
    true_omega: float
    relative_error: float | None
    backbone: tuple[ModeBackbonePoint, ...]
    max_deviation: float
    slope: float | None
    verdict: str


ModeVerification.FIELDS = (
    ("at", "at", mapped(Constant.from_json)),
    ("omega", "omega", None),
    ("law", "law", tuple),
    ("coefficients", "coefficients", dict),
    ("true_omega", "true_omega", None),
    ("relative_error", "relative_error", None),
    ("backbone", "backbone", several(ModeBackbonePoint.from_json)),
    ("max_deviation", "max_deviation", None),
    ("slope", "slope", None),
    ("verdict", "verdict", None),
)
ModeVerification.OPTIONAL = frozenset(['coefficients', 'law'])


@dataclass(frozen=True, eq=False, repr=False)
class Mode(Document):
    """A nonlinear normal mode. Its polynomials are in the letters of the equations, the symbol of the
    amplitude and those of `definitions`.

    Attributes:
        number: Its number, 1 for the slowest.
        order: The highest power of the amplitude in omega^2 that was reached, or the number of
            harmonics.
        linear_omega_squared: omega^2 of the linear mode.
        shape: The linear mode: each coordinate over the first that moves.
        modal_coordinate: The factors of the coordinates in the sum of which the amplitude is that
            of the first harmonic.
        omega_squared: omega^2 in powers of the amplitude; in omega itself where a balance gives
            it.
        approximant: A quotient of polynomials that agrees with omega_squared and stands for it,
            as text; left out where it was not asked for.
        balance: The balance of harmonics that determines omega and the coefficients of the
            motion; left out for a series.
        formula: The law in one line.
        motion: The harmonics of each coordinate in theta = omega*t.
        along: The coordinate in which the modal lines are written.
        modal_lines: Each other coordinate as a polynomial in that one and the amplitude, up to
            third powers.
        definitions: What the formulas name, each by those before it.
        numerical: Whether coefficients are rounded to fifteen digits, because the linear
            frequency is no fraction.
        derivation: The derivation line by line, as text; left out where it was not asked for.
        verification: The mode at values beside the true motion; null without values.
        unjudged: The reason why no true motion was found; null where one was, or none was asked
            for.
    """

    number: int
    order: int
    linear_omega_squared: Polynomial
    shape: dict[str, Polynomial]
    modal_coordinate: dict[str, Polynomial]
    omega_squared: Polynomial
    approximant: str | None
    balance: ModeBalance | None
    formula: str
    motion: dict[str, tuple[Harmonic, ...]]
    along: str
    modal_lines: dict[str, Polynomial]
    definitions: dict[str, str]
    numerical: bool
    derivation: tuple[str, ...] | None
    verification: ModeVerification | None
    unjudged: str | None


Mode.FIELDS = (
    ("number", "number", None),
    ("order", "order", None),
    ("linear_omega_squared", "linear_omega_squared", Polynomial.from_json),
    ("shape", "shape", mapped(Polynomial.from_json)),
    ("modal_coordinate", "modal_coordinate", mapped(Polynomial.from_json)),
    ("omega_squared", "omega_squared", Polynomial.from_json),
    ("approximant", "approximant", None),
    ("balance", "balance", ModeBalance.from_json),
    ("formula", "formula", None),
    ("motion", "motion", mapped(several(Harmonic.from_json))),
    ("along", "along", None),
    ("modal_lines", "modal_lines", mapped(Polynomial.from_json)),
    ("definitions", "definitions", dict),
    ("numerical", "numerical", None),
    ("derivation", "derivation", tuple),
    ("verification", "verification", ModeVerification.from_json),
    ("unjudged", "unjudged", None),
)
Mode.OPTIONAL = frozenset(['approximant', 'balance', 'derivation'])


@dataclass(frozen=True, eq=False, repr=False)
class Modes(Answer):
    """The nonlinear normal modes of coupled equations that nothing drives or damps.

    Attributes:
        schema: The kind of document.
        equations: The equations as they were understood.
        coordinates: The coordinates.
        rest: The place of rest from which each coordinate is counted, a formula.
        parameters: The letters of the equations, in alphabetical order.
        method: The method: `lindstedt-poincare`; `pade`, with an approximant of omega^2 on top;
            or `harmonic-balance`.
        order: The highest power of the amplitude in omega^2 that was asked for, or the number of
            harmonics.
        amplitude: What the amplitude measures: `first-harmonic` or `initial`.
        amplitude_symbol: The symbol of the amplitude.
        count: The number of all modes.
        modes: The modes that have formulas, the slowest first.
        refused: The reasons why other modes have none.
        tolerance: The largest relative error of omega that passes; null without values.
    """

    schema: Literal["lindstedt/modes/1"]
    equations: tuple[str, ...]
    coordinates: tuple[str, ...]
    rest: dict[str, str]
    parameters: tuple[str, ...]
    method: str
    order: int
    amplitude: str
    amplitude_symbol: str
    count: int
    modes: tuple[Mode, ...]
    refused: tuple[str, ...]
    tolerance: float | None


Modes.FIELDS = (
    ("schema", "schema", None),
    ("equations", "equations", tuple),
    ("coordinates", "coordinates", tuple),
    ("rest", "rest", dict),
    ("parameters", "parameters", tuple),
    ("method", "method", None),
    ("order", "order", None),
    ("amplitude", "amplitude", None),
    ("amplitude_symbol", "amplitude_symbol", None),
    ("count", "count", None),
    ("modes", "modes", several(Mode.from_json)),
    ("refused", "refused", tuple),
    ("tolerance", "tolerance", None),
)
