"""Methods on one equation, compared."""

from __future__ import annotations

from typing import Any

from .documents.comparison import Comparison as ComparisonDocument
from .plots import axes, labelled


class Comparison(ComparisonDocument):
    """Every method on one equation, judged by the true motion.

    >>> import lindstedt as ls
    >>> table = ls.compare("pendulum", A=2.0)
    >>> table.best.method
    'exact'
    """

    @property
    def best(self) -> Any:
        """The row with the least error of those that apply.

        Raises:
            ValueError: No method applies.
        """
        judged = [row for row in self.methods if row.relative_error is not None]
        return min(judged, key=lambda row: abs(row.relative_error or 0.0))

    def to_pandas(self) -> Any:
        """Returns the table as a `pandas.DataFrame`; `error` is the size of the relative error."""
        frame = super().to_pandas()
        frame["error"] = frame["relative_error"].abs()
        return frame

    def plot(self, ax: Any = None) -> Any:
        """Draws the size of the error of every method on `ax`, and returns the axes."""
        ax = axes(ax)
        rows = [row for row in self.methods if row.relative_error is not None]
        ax.barh([row.method for row in rows], [abs(row.relative_error or 0.0) for row in rows])
        ax.set_xscale("log")
        return labelled(ax, "size of the relative error of omega", "", self.equation)
