"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several


@dataclass(frozen=True, eq=False, repr=False)
class Estimate(Document):
    """A value with its standard error.

    Attributes:
        value: The value.
        standard_error: The standard error; null where it is not known, or the measurement leaves
            the value open.
    """

    value: float | None
    standard_error: float | None


Estimate.FIELDS = (
    ("value", "value", None),
    ("standard_error", "standard_error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class TurningPoint(Document):
    """A turning point, with the offset of the record in it.

    Attributes:
        time: The time.
        value: The value.
    """

    time: Estimate
    value: Estimate


TurningPoint.FIELDS = (
    ("time", "time", Estimate.from_json),
    ("value", "value", Estimate.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Record(Document):
    """A record before any law.

    Attributes:
        name: The name of its column.
        samples: The number of samples.
        is_angle: Whether the values are angles, in radians.
        step: The usual time between samples.
        noise: The standard deviation of the noise.
        quantum: The step between values where they are quantised; null otherwise.
        start: The line at which the free decay begins.
        gaps: The lines before gaps in time.
        missing: The lines without a value.
        repeated: The lines with a time that repeats the one before.
        turning_points: The turning points.
        crossings: The times at which the record crosses its centre.
        saturated: The lines on flat tops.
        outliers: The lines of the samples that were left out since they lie far from their
            neighbours or from the best law.
    """

    name: str
    samples: int
    is_angle: bool
    step: float
    noise: float
    quantum: float | None
    start: int | None
    gaps: tuple[int, ...]
    missing: tuple[int, ...]
    repeated: tuple[int, ...]
    turning_points: tuple[TurningPoint, ...]
    crossings: tuple[Estimate, ...]
    saturated: tuple[int, ...]
    outliers: tuple[int, ...]


Record.FIELDS = (
    ("name", "name", None),
    ("samples", "samples", None),
    ("is_angle", "is_angle", None),
    ("step", "step", None),
    ("noise", "noise", None),
    ("quantum", "quantum", None),
    ("start", "start", None),
    ("gaps", "gaps", tuple),
    ("missing", "missing", tuple),
    ("repeated", "repeated", tuple),
    ("turning_points", "turning_points", several(TurningPoint.from_json)),
    ("crossings", "crossings", several(Estimate.from_json)),
    ("saturated", "saturated", tuple),
    ("outliers", "outliers", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class FittedLaw(Document):
    """A law beside a measurement.

    Attributes:
        name: The name.
        equation: The equation of motion; null for a law of restitution.
        parameters: The parameters; of a record also the start `x0` and `v0`, the offset and its
            drift per unit of time, of further records `x0_2` and so on.
        chi_squared: Chi-square per degree of freedom; null where the law was not fitted to the
            samples.
        aic: The criterion of Akaike; null where there is none.
        excluded: The reason that excludes the law; null for the best one, and for one that the
            measurement does not exclude.
    """

    name: str
    equation: str | None
    parameters: dict[str, Estimate]
    chi_squared: float | None
    aic: float | None
    excluded: str | None


FittedLaw.FIELDS = (
    ("name", "name", None),
    ("equation", "equation", None),
    ("parameters", "parameters", mapped(Estimate.from_json)),
    ("chi_squared", "chi_squared", None),
    ("aic", "aic", None),
    ("excluded", "excluded", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class BestLaw(Document):
    """The best law of a record in detail.

    Attributes:
        is_white: Whether the residuals are white.
        probability: The probability that white noise has correlations as large as those of the
            residuals.
        correlations: The correlations of the parameters, in their order, row by row.
        flat: The directions of the parameters that the record does not determine, in words.
        converged: Whether the search of the values converged.
    """

    is_white: bool
    probability: float
    correlations: tuple[tuple[float | None, ...], ...]
    flat: tuple[str, ...]
    converged: bool


BestLaw.FIELDS = (
    ("is_white", "is_white", None),
    ("probability", "probability", None),
    ("correlations", "correlations", several(tuple)),
    ("flat", "flat", tuple),
    ("converged", "converged", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class BackbonePoint(Document):
    """Frequency and damping at an amplitude.

    Attributes:
        time: The time in the middle of the window.
        amplitude: The amplitude.
        frequency: The angular frequency.
        damping: The damping ratio.
    """

    time: float
    amplitude: Estimate
    frequency: Estimate
    damping: Estimate


BackbonePoint.FIELDS = (
    ("time", "time", None),
    ("amplitude", "amplitude", Estimate.from_json),
    ("frequency", "frequency", Estimate.from_json),
    ("damping", "damping", Estimate.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class FittedResponseRow(Document):
    """A row of a frequency response: the first harmonic, `amplitude cos(frequency t - phase)`.

    Attributes:
        frequency: The angular frequency of the drive.
        amplitude: The measured amplitude.
        phase: The measured phase, in radians; null where it is not given.
        law_amplitude: The amplitude of the law.
        law_phase: The phase of the law, in radians.
    """

    frequency: float
    amplitude: float
    phase: float | None
    law_amplitude: float | None
    law_phase: float | None


FittedResponseRow.FIELDS = (
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
    ("law_amplitude", "law_amplitude", None),
    ("law_phase", "law_phase", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Restitution(Document):
    """The coefficient of restitution of one impact.

    Attributes:
        speed: The speed of approach.
        restitution: The coefficient of restitution.
    """

    speed: float
    restitution: Estimate


Restitution.FIELDS = (
    ("speed", "speed", None),
    ("restitution", "restitution", Estimate.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Answer):
    """The laws of a measurement, and what it says without a law.

    Attributes:
        schema: The kind of document.
        data: The kind of measurement: `decay`, a record of a motion, `backbone`, a table of
            frequencies against amplitudes, `response`, amplitudes against the frequency of a
            drive, or `impacts`, times of impacts.
        records: The records before any law; empty of tables and impacts.
        laws: The laws, the best first.
        best: The best law of a record; null of tables and impacts.
        backbone: Frequency and damping against amplitude, without a law, record by record; empty
            of tables and impacts.
        response: The rows of a frequency response with its law; empty of everything else.
        impacts: The coefficient of restitution of each impact; empty of records and tables.
    """

    schema: Literal["lindstedt/fit/1"]
    data: str
    records: tuple[Record, ...]
    laws: tuple[FittedLaw, ...]
    best: BestLaw | None
    backbone: tuple[BackbonePoint, ...]
    response: tuple[FittedResponseRow, ...]
    impacts: tuple[Restitution, ...]


Fit.FIELDS = (
    ("schema", "schema", None),
    ("data", "data", None),
    ("records", "records", several(Record.from_json)),
    ("laws", "laws", several(FittedLaw.from_json)),
    ("best", "best", BestLaw.from_json),
    ("backbone", "backbone", several(BackbonePoint.from_json)),
    ("response", "response", several(FittedResponseRow.from_json)),
    ("impacts", "impacts", several(Restitution.from_json)),
)
