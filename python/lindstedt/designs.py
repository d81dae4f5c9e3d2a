"""Searches of the best design."""

from __future__ import annotations

from typing import Any

from .documents.optimization import Design, Finalist
from .documents.optimization import Optimization as OptimizationDocument
from .plots import axes, labelled
from .tables import Table


class Optimization(OptimizationDocument):
    """Searches of the best design."""

    @property
    def front(self) -> Front:
        """The best designs, none worse than another in every wish."""
        return Front(self.finalists)

    @property
    def best(self) -> Design | None:
        """The first of the best designs; `None` where none was found."""
        return self.finalists[0].design if self.finalists else None

    def plot(self, ax: Any = None) -> Any:
        """Draws the first two wishes of the best designs on `ax`, and returns the axes."""
        return self.front.plot(ax)


class Front(Table[Finalist]):
    """The best designs of searches."""

    __slots__ = ()

    def plot(self, ax: Any = None) -> Any:
        """Draws the first two wishes of the designs on `ax`, and returns the axes."""
        ax = axes(ax)
        values = [row.values for row in self]
        second = 1 if values and len(values[0]) > 1 else 0
        ax.plot([row[0] for row in values], [row[second] for row in values], "o")
        return labelled(ax, "first objective", "second objective")
