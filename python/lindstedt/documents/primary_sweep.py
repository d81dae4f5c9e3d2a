"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Axis


@dataclass(frozen=True, eq=False, repr=False)
class PrimarySweepRow(Document):
    """One run of a main mass.

    Attributes:
        values: The values of the parameters, in the order of the axes.
        frequency: eta, the frequency of the force over omega.
        amplitude: The largest displacement in the last quarter of the run, with its damper; null
            for a run that was stopped before it began.
        locked: The amplitude in the long run with the damper locked; null at an undamped
            resonance, and where no force drives it.
        without: That amplitude without the damper.
        impacts: The number of impacts in the last quarter of the run; null for a run that was
            stopped before it began.
        all_impacts: The number of impacts in the whole run; null likewise.
        rest_time: When the envelope of the main mass has fallen to a tenth, for good; null where
            it never does, and where a force drives it.
        rest_locked: The rest time with the damper locked; null where it never rests, creeps, or a
            force drives it.
        rest_without: The rest time without the damper; null likewise.
        time_unit: One unit of time in this run, in seconds.
        length_unit: One unit of displacement of the main mass in this run, L, in metres.
        complete: Whether the run was followed as long as asked.
    """

    values: tuple[float, ...]
    frequency: float
    amplitude: float | None
    locked: float | None
    without: float | None
    impacts: int | None
    all_impacts: int | None
    rest_time: float | None
    rest_locked: float | None
    rest_without: float | None
    time_unit: float
    length_unit: float
    complete: bool


PrimarySweepRow.FIELDS = (
    ("values", "values", tuple),
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("locked", "locked", None),
    ("without", "without", None),
    ("impacts", "impacts", None),
    ("all_impacts", "all_impacts", None),
    ("rest_time", "rest_time", None),
    ("rest_locked", "rest_locked", None),
    ("rest_without", "rest_without", None),
    ("time_unit", "time_unit", None),
    ("length_unit", "length_unit", None),
    ("complete", "complete", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrimarySweep(Answer):
    """Many runs of a main mass with its pendulum, over every combination of the values of some
    parameters. Units as in kind `primary`.

    Attributes:
        schema: The kind of document.
        axes: The parameters that are varied, in SI units unless they are numbers of equation (7);
            the last varies fastest.
        time_unit: One unit of time, in seconds; null where the runs differ in it.
        length_unit: One unit of displacement of the main mass, L, in metres; null where the runs
            differ in it.
        rows: A row for every run.
    """

    schema: Literal["lindstedt/primary-sweep/1"]
    axes: tuple[Axis, ...]
    time_unit: float | None
    length_unit: float | None
    rows: tuple[PrimarySweepRow, ...]


PrimarySweep.FIELDS = (
    ("schema", "schema", None),
    ("axes", "axes", several(Axis.from_json)),
    ("time_unit", "time_unit", None),
    ("length_unit", "length_unit", None),
    ("rows", "rows", several(PrimarySweepRow.from_json)),
)
