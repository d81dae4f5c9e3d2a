"""Results with methods of their own: branches, motions, sweeps, certificates, fronts."""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext
from functools import cached_property
from typing import Any

from ._answer import Answer
from .documents.certificate import CertificateDocument
from .documents.comparison import Comparison as ComparisonDocument
from .documents.motion import Motion as MotionDocument
from .documents.motion_sweep import MotionSweep as MotionSweepDocument
from .documents.optimization import Design, Finalist
from .documents.optimization import Optimization as OptimizationDocument
from .documents.response import Response as ResponseDocument
from .documents.response import ResponseBifurcation, ResponsePoint
from .documents.simulation import Impact
from .documents.simulation import Simulation as SimulationDocument
from .documents.sweep import Sweep as SweepDocument
from .law import Law as Law
from .plots import axes, labelled
from .tables import Table, columns_of, to_xarray


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
    def events(self) -> tuple[float, ...]:
        """The times at which a section is touched; empty where none was asked for."""
        return () if self.section is None else tuple(point.t for point in self.section.states)


class Simulation(Course, SimulationDocument):
    """The motion of the pendulum with its barrier."""

    @property
    def events(self) -> Table[Impact]:
        """The impacts, in time."""
        return Table(self.impacts)


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
        """Draws a column of the table over the only axis on `ax`, and returns the axes."""
        ax = axes(ax)
        columns = columns_of(self.csv())
        (name,) = self.axis_names()
        ax.plot(columns[name], columns[what], ".-")
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


class Certificate(CertificateDocument):
    """Numbers from which a motion is proved; `lindstedt.check` proves it again from its file.

    >>> import lindstedt as ls
    >>> certificate = ls.certify("pendulum", A="3/2")
    >>> certificate.passed, round(certificate.omega, 12)
    (True, 0.86060834668)
    >>> low, high = certificate.omega_bounds
    >>> high - low < 1e-30
    True
    """

    @property
    def omega(self) -> float:
        """The angular frequency of the motion that is proved, in radians per unit of time."""
        low, _ = self.omega_bounds
        return float(low)

    @property
    def omega_bounds(self) -> tuple[Decimal, Decimal]:
        """Bounds of the angular frequency: 1/omega^2 is within claim_r / 2^sigma_log2 of mu."""
        with localcontext() as context:
            context.prec = 80
            radius = Decimal(self.claim_r) / Decimal(2) ** int(self.sigma_log2)
            middle = Decimal(self.mu) / Decimal(2) ** self.bits
            context.rounding = ROUND_FLOOR
            low = (1 / (middle + radius)).sqrt()
            context.rounding = ROUND_CEILING
            high = (1 / (middle - radius)).sqrt()
            # The root rounds to nearest: one more digit at each end.
            step = Decimal(10) ** -75
            return low - step, high + step


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
