"""Branches of steady states."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from ._optional import optional
from .documents.response import Response as ResponseDocument
from .documents.response import ResponseBifurcation, ResponsePoint
from .plots import axes, labelled
from .tables import Table


#: What a point has of each coordinate of coupled equations, and the attribute that holds it.
EACH = {"amplitude": "amplitudes", "phase": "phases", "peak": "peaks"}


class Points(Table[ResponsePoint]):
    """The points of branches; of coupled equations with columns of each coordinate, `amplitude_y`."""

    __slots__ = ()

    def column(self, name: str) -> Any:
        """Returns an attribute of all points as an array; what is missing in numbers is NaN."""
        what, _, coordinate = name.partition("_")
        if not coordinate or what not in EACH:
            return super().column(name)
        numpy = optional("numpy", "a column")
        return numpy.array([getattr(point, EACH[what])[coordinate] for point in self])

    def to_pandas(self) -> Any:
        """Returns the points as a `pandas.DataFrame`; of coupled equations it has a column for the
        amplitude, the phase and the peak of each coordinate.

        Raises:
            MissingPackage: pandas is not installed.
        """
        frame = super().to_pandas()
        coordinates = list(self[0].amplitudes or {}) if self else []
        for what in EACH:
            for coordinate in coordinates:
                frame[f"{what}_{coordinate}"] = self.column(f"{what}_{coordinate}")
        spread = [*EACH.values()] if coordinates else [*EACH.values(), "state"]
        return frame.drop(columns=spread, errors="ignore")


def value_of(point: ResponsePoint, what: str, coordinate: str | None) -> Any:
    """A quantity of a point, that of a coordinate or the one that is listed."""
    if coordinate is None:
        return getattr(point, what)
    return getattr(point, EACH[what])[coordinate]


class Response(ResponseDocument):
    """Branches of steady states."""

    @cached_property
    def points(self) -> Points:
        """All points of all branches."""
        return Points(point for branch in self.branches for point in branch)

    @property
    def folds(self) -> Table[ResponseBifurcation]:
        """The folds, where a branch turns back."""
        return Table(place for place in self.bifurcations if place.kind == "fold")

    def plot(self, ax: Any = None, what: str = "amplitude") -> Any:
        """Draws the branches on `ax`, dashed where they are unstable, and returns the axes. Of coupled
        equations all coordinates are drawn, each in a colour of its own, and the quantity that is
        listed if it is none of them.

        Args:
            what: `amplitude` of the first harmonic, `peak`, `phase` or `frequency`.
        """
        ax = axes(ax)
        drawn: list[tuple[str, str | None]] = [(what, None)]
        if self.coordinates and what in EACH:
            drawn = [(name, name) for name in self.coordinates]
            if self.of not in self.coordinates:
                drawn.append((self.of or what, None))
        for number, (label, coordinate) in enumerate(drawn):
            colour = "C0" if number == 0 else f"C{number + 1}"
            named = label if len(drawn) > 1 else None
            for branch in self.branches:
                begin = 0
                for end in range(1, len(branch) + 1):
                    if end == len(branch) or branch[end].stable != branch[begin].stable:
                        part = branch[begin : end + 1]
                        style = "-" if branch[begin].stable else "--"
                        values = [value_of(point, what, coordinate) for point in part]
                        places = [point.parameter for point in part]
                        ax.plot(places, values, style, color=colour, label=named)
                        begin, named = end, None
        if what in ("amplitude", "peak", "frequency"):
            places = [getattr(fold, what) for fold in self.folds]
            ax.plot([fold.parameter for fold in self.folds], places, "o", color="C1", label="fold")
        return labelled(ax, self.parameter, what, self.equation)
