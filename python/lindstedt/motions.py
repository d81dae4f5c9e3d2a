"""Motions in numbers, and sweeps of them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from ._answer import Answer
from ._call import number
from .documents.motion import Motion as MotionDocument
from .documents.motion_sweep import MotionSweep as MotionSweepDocument
from .documents.primary import Primary as PrimaryDocument
from .documents.primary_sweep import PrimarySweep as PrimarySweepDocument
from .documents.simulation import Impact
from .documents.simulation import Simulation as SimulationDocument
from .documents.sweep import Sweep as SweepDocument
from .errors import UsageError
from .plots import axes, labelled
from .tables import Table, columns_of, to_xarray


class Course(Answer):
    """A motion in numbers, whose table is columns over the time."""

    @cached_property
    def columns(self) -> dict[str, Any]:
        """The columns of the table as arrays, by their names: `t`, `x`, `x'`."""
        return columns_of(self.csv())

    def __getitem__(self, name: str) -> Any:
        return self.columns[name]

    @property
    def t(self) -> Any:
        """The times of the table."""
        return self.columns["t"]

    @property
    def x(self) -> Any:
        """The displacement, or the first coordinate, at these times."""
        return next(column for name, column in self.columns.items() if name != "t")

    def plot(self, ax: Any = None) -> Any:
        """Draws the displacement over the time on `ax`, and returns the axes."""
        ax = axes(ax)
        names = [name for name in self.columns if name != "t"]
        ax.plot(self.t, self.x, label=names[0])
        return labelled(ax, "t", names[0])


class Motion(Course, MotionDocument):
    """The motion of an equation or a mechanism.

    >>> import lindstedt as ls
    >>> motion = ls.simulate("x'' + 0.1*x' + sin(x) = 0", x=1.5, until=50)
    >>> float(motion.x[0]), float(motion.t[-1])
    (1.5, 50.0)
    """

    @property
    def section_times(self) -> tuple[float, ...]:
        """The times at which the motion was looked at; empty where no section was asked for."""
        return () if self.section is None else tuple(point.t for point in self.section.states)


class Simulation(Course, SimulationDocument):
    """The motion of the pendulum with its barrier."""

    @property
    def events(self) -> Table[Impact]:
        """The impacts, in time."""
        return Table(self.impacts)


class Primary(Course, PrimaryDocument):
    """The motion of a main mass with its pendulum.

    The table has the pendulum's angle `x`, its `velocity`, the displacement `y` of the main mass and
    its `speed`.
    """

    @property
    def y(self) -> Any:
        """The displacement of the main mass at these times, in lengths of the pendulum."""
        return self.columns["y"]


class Swept(Answer):
    """Many motions, with axes along which parameters are varied."""

    def axis_names(self) -> list[str]:
        """The names of what is varied; the last varies fastest."""
        raise NotImplementedError

    def to_xarray(self) -> Any:
        """Returns the table as an `xarray.Dataset` whose dimensions are what is varied.

        Raises:
            MissingPackage: pandas or xarray is not installed.
        """
        return to_xarray(self.to_pandas(), self.axis_names())

    def plot(self, ax: Any = None, what: str = "rest_time") -> Any:
        """Draws a column of the table over the last axis on `ax`, a line for each combination of the
        others, and returns the axes.

        Raises:
            UsageError: The table has no such column.
        """
        columns = columns_of(self.csv())
        if what not in columns:
            raise UsageError(f"there is no column {what}: choose one of {', '.join(columns)}")
        ax = axes(ax)
        *others, name = self.axis_names()
        lines: dict[tuple[float, ...], list[int]] = {}
        for row, key in enumerate(zip(*(columns[other].tolist() for other in others))):
            lines.setdefault(key, []).append(row)
        for key, rows in lines.items() if others else [((), slice(None))]:
            at = ", ".join(f"{other} = {number(value)}" for other, value in zip(others, key))
            ax.plot(columns[name][rows], columns[what][rows], ".-", label=at or None)
        return labelled(ax, name, what)


class Sweep(Swept, SweepDocument):
    """Many motions of the pendulum with its barrier."""

    def axis_names(self) -> list[str]:
        """The names of what is varied; the last varies fastest."""
        return [axis.name for axis in self.axes]


class MotionSweep(Swept, MotionSweepDocument):
    """Many motions of an equation or a mechanism."""

    def axis_names(self) -> list[str]:
        """The names of what is varied; the last varies fastest."""
        return list(self.varied)


class PrimarySweep(Swept, PrimarySweepDocument):
    """Many motions of a main mass with its pendulum."""

    def axis_names(self) -> list[str]:
        """The names of what is varied; the last varies fastest."""
        return [axis.name for axis in self.axes]
