"""Results that are tables: transition curves, materials, friction; each with its picture."""

from __future__ import annotations

from typing import Any

from .documents.friction import Friction as FrictionDocument
from .documents.materials import Materials as MaterialsDocument
from .documents.stability import Stability as StabilityDocument
from .plots import axes, labelled
from .tables import columns_of


class Stability(StabilityDocument):
    """Transition curves of a linear equation with periodic coefficients."""

    def plot(self, ax: Any = None) -> Any:
        """Draws the curves by their formulas on `ax`, the true ones dotted, and returns the axes.

        Raises:
            Refused: The small parameter has no value, up to which the curves are drawn.
        """
        columns = columns_of(self.csv())
        ax = axes(ax)
        name, small, formula, true = columns
        for curve in dict.fromkeys(columns[name]):
            chosen = columns[name] == curve
            (line,) = ax.plot(columns[formula][chosen], columns[small][chosen], label=curve)
            ax.plot(columns[true][chosen], columns[small][chosen], ":", color=line.get_color())
        return labelled(ax, self.gives, small, self.equation)


class Materials(MaterialsDocument):
    """The same swing against barriers of several materials."""

    def plot(self, ax: Any = None) -> Any:
        """Draws the rest times over the modulus, a line for each form of the damping that is held
        fixed, on `ax`, and returns the axes."""
        ax = axes(ax)
        order = sorted(range(len(self.materials)), key=lambda row: self.materials[row].modulus)
        moduli = [self.materials[row].modulus for row in order]
        drawn: list[tuple[str, tuple[float | None, ...]]]
        drawn = [(held.form, held.rest_times) for held in self.held_fixed]
        if not drawn:
            drawn = [("", tuple(row.rest.rest_time for row in self.materials))]
        for form, times in drawn:
            # A material that does not rest leaves a gap.
            values = [float("nan") if (time := times[row]) is None else time for row in order]
            ax.plot(moduli, values, "o-", label=f"{form} held fixed" if form else None)
        ax.set_xscale("log")
        return labelled(ax, "modulus, Pa", "rest time, 1/omega")


class Friction(FrictionDocument):
    """The arctangent in place of Coulomb's sgn."""

    def plot(self, ax: Any = None) -> Any:
        """Draws both over the speed on `ax`, and returns the axes."""
        ax = axes(ax)
        speeds = [row.speed for row in self.speeds]
        ax.plot(speeds, [row.sign for row in self.speeds], "_", label="sgn")
        ax.plot(speeds, [row.arctangent for row in self.speeds], ".", label="arctangent")
        return labelled(ax, "speed, rad*omega", "friction over alpha")
