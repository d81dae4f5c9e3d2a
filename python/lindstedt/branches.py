"""Branches of steady states."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from .documents.response import Response as ResponseDocument
from .documents.response import ResponseBifurcation, ResponsePoint
from .plots import axes, labelled
from .tables import Table


class Response(ResponseDocument):
    """Branches of steady states."""

    @cached_property
    def points(self) -> Table[ResponsePoint]:
        """All points of all branches."""
        return Table(point for branch in self.branches for point in branch)

    @property
    def folds(self) -> Table[ResponseBifurcation]:
        """The folds, where a branch turns back."""
        return Table(place for place in self.bifurcations if place.kind == "fold")

    def plot(self, ax: Any = None, what: str = "amplitude") -> Any:
        """Draws the branches on `ax`, dashed where they are unstable, and returns the axes.

        Args:
            what: `amplitude` of the first harmonic, `peak`, `phase` or `frequency`.
        """
        ax = axes(ax)
        for branch in self.branches:
            begin = 0
            for end in range(1, len(branch) + 1):
                if end == len(branch) or branch[end].stable != branch[begin].stable:
                    part = branch[begin : end + 1]
                    style = "-" if branch[begin].stable else "--"
                    values = [getattr(point, what) for point in part]
                    ax.plot([point.parameter for point in part], values, style, color="C0")
                    begin = end
        if what in ("amplitude", "peak", "frequency"):
            places = [getattr(fold, what) for fold in self.folds]
            ax.plot([fold.parameter for fold in self.folds], places, "o", color="C1", label="fold")
        return labelled(ax, self.parameter, what, self.equation)
