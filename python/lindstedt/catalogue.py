"""The classical oscillators that the program knows by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

from ._call import Call, answer
from .documents.catalog import Entry
from .oscillator import Oscillator
from .tables import Table


class CatalogOfOscillators(Mapping[str, Oscillator]):
    """The oscillators of one coordinate by their names.

    Coupled ones are in `entries`: `derive`, `modes` and `slow_equations` take their names. Those
    with rigid walls are there too: `simulate`, `response` and `orbits` take them.

    >>> import lindstedt as ls
    >>> ls.catalog["pendulum"]
    Oscillator("x'' + sin(x) = 0")
    >>> "van-der-pol" in ls.catalog
    True
    """

    @cached_property
    def entries(self) -> Table[Entry]:
        """All entries, those of coupled equations too, with title, equation and source."""
        return Table(answer(Call(("catalog",))).entries)

    @cached_property
    def _names(self) -> tuple[str, ...]:
        of_one = [entry for entry in self.entries if ";" not in entry.equation]
        return tuple(entry.name for entry in of_one if not entry.walls)

    def __getitem__(self, name: str) -> Oscillator:
        if name not in self._names:
            raise KeyError(name)
        return Oscillator(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


#: The catalogue.
catalog = CatalogOfOscillators()
