"""The law of a measured motion, with the standard errors of its parameters."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal, Union

from ._call import Call, Progress, Values, answer, option
from .documents.fit import BackbonePoint, FittedLaw
from .documents.fit import Fit as FitDocument
from .errors import Refused
from .plots import axes, labelled
from .tables import Table, columns_of

#: The path of a file, or columns of numbers: the times, and a column for each record.
Measurement = Union[str, "os.PathLike[str]", Sequence[Any]]


class Fit(FitDocument):
    """The laws of a measurement, the best first.

    >>> import lindstedt as ls, math
    >>> times = [0.05 * i for i in range(800)]
    >>> ripple = [3e-3 * math.sin(1e4 * t * t) for t in times]
    >>> swing = [math.exp(-0.02 * t) * math.cos(2 * t) + r for t, r in zip(times, ripple)]
    >>> found = ls.fit((times, swing), "x'' + c*x' + k*x = 0")
    >>> round(found.law.parameters["k"].value, 2)
    4.0
    """

    @property
    def law(self) -> FittedLaw:
        """The best law.

        Raises:
            Refused: No law was found.
        """
        if not self.laws:
            raise Refused("no law was found", "law")
        return self.laws[0]

    @property
    def table(self) -> Table[FittedLaw]:
        """The laws as a table, the best first."""
        return Table(self.laws)

    @property
    def frequencies(self) -> Backbone:
        """Frequency and damping against amplitude, without a law."""
        return Backbone(self.backbone)

    @property
    def curve(self) -> dict[str, Any]:
        """The samples with the law, its standard error and what is left over, as arrays; of a table and of impacts its rows."""
        return columns_of(self.csv())

    def plot(self, ax: Any = None) -> Any:
        """Draws the measurement and the law on `ax`, and returns the axes."""
        ax = axes(ax)
        names = list(columns := self.curve)
        if "measured" not in columns:
            ax.plot(columns[names[0]], columns[names[1]], "o", label="measured")
            if "law_amplitude" in columns:
                ax.plot(columns[names[0]], columns["law_amplitude"], ".", label="law")
            return labelled(ax, names[0], names[1], self.law.name)
        ax.plot(columns["time"], columns["measured"], ".", label="measured")
        ax.plot(columns["time"], columns["law"], label="law")
        return labelled(ax, "time", "displacement", self.law.name)


class Backbone(Table[BackbonePoint]):
    """Frequency and damping against amplitude."""

    __slots__ = ()

    def plot(self, ax: Any = None) -> Any:
        """Draws the frequency with three standard errors against the amplitude on `ax`, and returns the axes."""
        ax = axes(ax)
        errors = [3 * (point.frequency.standard_error or 0.0) for point in self]
        amplitudes = [point.amplitude.value for point in self]
        ax.errorbar(amplitudes, [point.frequency.value for point in self], errors, fmt="o")
        return labelled(ax, "amplitude", "angular frequency")


def fit(
    measurement: Measurement,
    *equations: str,
    data: Literal["decay", "backbone", "response", "impacts"] | None = None,
    also: Sequence[str] | None = None,
    time: str | int | None = None,
    column: Sequence[str | int] | str | int | None = None,
    quantity: Literal["displacement", "velocity", "acceleration"] | None = None,
    angle: bool = False,
    start: Values | None = None,
    noise: float | None = None,
    keep_outliers: bool = False,
    gravity: float | None = None,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Fit:
    """Find the law of a measured motion.

    Args:
        measurement: The path of a table of numbers, or its columns: times and values, arrays or lists.
        *equations: Equations whose letters are to be found; without one the laws of a list.
        data: The content: a motion, frequencies against amplitudes, amplitudes against the frequency of a
            drive, or times of impacts.
        also: Other files with records of the same thing.
        time: The column of time, by its name or its number from 1.
        column: The columns of values, by their names or numbers; several are records of the same thing.
        quantity: The quantity that was measured.
        angle: Whether the values are angles in radians, so that a pendulum is among the laws.
        start: The first values of the letters of an equation.
        noise: The standard deviation of the noise, of impacts that of a time.
        keep_outliers: Whether samples far from the law are kept.
        gravity: The gravity under which a ball bounces, 9.81 without it.
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The measurement is refused, with its line and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    options = {
        "data": data,
        "also": also,
        "time": time,
        "column": column,
        "quantity": quantity,
        "angle": angle,
        "start": start,
        "noise": noise,
        "keep_outliers": keep_outliers,
        "gravity": gravity,
        "timeout": timeout,
    }
    text = None
    place = "-"
    if isinstance(measurement, (str, os.PathLike)):
        place = os.fspath(measurement)
    else:
        columns = [list(map(float, own)) for own in measurement]
        rows = zip(*columns, strict=True)
        text = "".join(",".join(map(repr, row)) + "\n" for row in rows)
        if column is None and data in (None, "decay"):
            options["column"] = [str(number) for number in range(2, len(columns) + 1)]
    words = [word for name, value in options.items() for word in option(name, value)]
    found: Fit = answer(Call(("fit", *words, "--", place, *equations), text), progress)
    return found
