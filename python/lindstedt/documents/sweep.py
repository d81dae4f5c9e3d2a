"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Axis, State


@dataclass(frozen=True, eq=False, repr=False)
class Column(Document):
    """What one number, text or truth value of a row means.

    Attributes:
        name: Its name: that of a parameter, whose value stands in `values`, or the key of a row;
            `t`, `x` and `velocity` stand in `final_state`.
        unit: Its unit, as it is typed, 1 for a number without dimension; null for what is no
            number.
        meaning: What it means, in words.
    """

    name: str
    unit: str | None
    meaning: str


Column.FIELDS = (
    ("name", "name", None),
    ("unit", "unit", None),
    ("meaning", "meaning", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Row(Document):
    """What is kept of one run.

    Attributes:
        values: The values of the parameters, in the order of the axes.
        impacts: The number of contacts; null for a run that was stopped before it began.
        rest_time: When the envelope of the amplitude falls to a tenth of the first swing, in
            units of time; null where it does not.
        rest_no_barrier: The same without a barrier; null where it does not rest, and where the
            baseline was not asked for.
        rest_lossless: The same with a barrier that loses nothing; null likewise.
        penetration: The greatest depth in a barrier, in radians; 0 without contact, null for a
            run that was stopped before it began.
        speed_in: The greatest speed at a touch, in radians per unit of time; 0 without contact,
            null likewise.
        energy_lost: The energy lost in contacts, in units of m g L; null likewise.
        final_state: The state at the end; null likewise.
        complete: Whether the run got where it was to get.
        stopped: Why the run ended, in words.
    """

    values: tuple[float, ...]
    impacts: int | None
    rest_time: float | None
    rest_no_barrier: float | None
    rest_lossless: float | None
    penetration: float | None
    speed_in: float | None
    energy_lost: float | None
    final_state: State | None
    complete: bool
    stopped: str


Row.FIELDS = (
    ("values", "values", tuple),
    ("impacts", "impacts", None),
    ("rest_time", "rest_time", None),
    ("rest_no_barrier", "rest_no_barrier", None),
    ("rest_lossless", "rest_lossless", None),
    ("penetration", "penetration", None),
    ("speed_in", "speed_in", None),
    ("energy_lost", "energy_lost", None),
    ("final_state", "final_state", State.from_json),
    ("complete", "complete", None),
    ("stopped", "stopped", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Answer):
    """Many runs of the paper's equation (7), over every combination of the values of some parameters;
    units as in a document of kind `simulation`.

    Attributes:
        schema: The kind of document.
        axes: The parameters that are varied; the last varies fastest.
        columns: What stands in a row: the parameters, in the order of the axes, then what came of
            the run, each with its unit and meaning.
        rows: A row for each run.
    """

    schema: Literal["lindstedt/sweep/1"]
    axes: tuple[Axis, ...]
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]


Sweep.FIELDS = (
    ("schema", "schema", None),
    ("axes", "axes", several(Axis.from_json)),
    ("columns", "columns", several(Column.from_json)),
    ("rows", "rows", several(Row.from_json)),
)
