"""Pictures by matplotlib, which is imported when one is drawn."""

from __future__ import annotations

from typing import Any

from ._optional import optional


def axes(ax: Any = None) -> Any:
    """The axes that are given, or new ones.

    Raises:
        MissingPackage: matplotlib is not installed.
    """
    pyplot = optional("matplotlib.pyplot", "a plot")
    return pyplot.subplots()[1] if ax is None else ax


def labelled(ax: Any, x: str, y: str, title: str = "") -> Any:
    """The axes with their labels, and a legend where something has a name."""
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    if title:
        ax.set_title(title)
    if ax.get_legend_handles_labels()[0]:
        ax.legend()
    return ax
