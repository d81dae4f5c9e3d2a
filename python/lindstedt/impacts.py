"""Impacts on a barrier in closed form."""

from __future__ import annotations

from typing import Any

from ._optional import optional
from .documents.impact import Impact as ImpactDocument
from .documents.impact import Phase
from .plots import axes, labelled


class Impact(ImpactDocument):
    """A swing that hits an elastic barrier, in closed form beside Runge-Kutta.

    >>> import lindstedt as ls
    >>> impact = ls.impact()
    >>> [phase.name for phase in impact.motion]
    ['approach', 'contact', 'return']
    >>> bool(abs(impact.x(impact.motion[0].end) - impact.motion[0].end_state.x) < 1e-12)
    True
    """

    @property
    def motion(self) -> tuple[Phase, ...]:
        """The phases with every harmonic, or, where no method gives them, those of the paper."""
        return self.derived_phases or self.phases

    def x(self, t: Any) -> Any:
        """The displacement at times since the release, an array or a number.

        Before the release and behind the last phase it is NaN.
        """
        np = optional("numpy", "the displacement")
        times = np.asarray(t, dtype=float)
        conditions = [(phase.start <= times) & (times <= phase.end) for phase in self.motion]
        values = [_displacement(np, phase, times) for phase in self.motion]
        found = np.select(conditions, values, default=np.nan)
        return float(found) if times.ndim == 0 else found

    def plot(self, ax: Any = None) -> Any:
        """Draws the displacement over the time on `ax`, phase by phase, and returns the axes."""
        np = optional("numpy", "a plot")
        ax = axes(ax)
        for phase in self.motion:
            times = np.linspace(phase.start, phase.end, 200)
            ax.plot(times, _displacement(np, phase, times), label=phase.name)
        return labelled(ax, "t", "x")


def _displacement(np: Any, phase: Phase, times: Any) -> Any:
    """The sum of harmonics of a phase at times since the release."""
    law, s = phase.displacement, times - phase.clock
    angle = law.frequency * s
    waves = sum(
        wave.cos * np.cos(wave.harmonic * angle) + wave.sin * np.sin(wave.harmonic * angle)
        for wave in law.harmonics
    )
    return law.centre + law.parabola * s * (law.duration - s) + waves
