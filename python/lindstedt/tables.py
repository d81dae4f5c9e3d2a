"""Rows of a result as columns, frames and arrays of several axes."""

from __future__ import annotations

import csv
import html
from dataclasses import asdict, fields
from typing import Any, Generic, TypeVar

from ._optional import optional

R = TypeVar("R")


#: The rows that a notebook shows of a table.
MOST_SHOWN = 60


class Table(tuple[R, ...], Generic[R]):
    """Rows of a result, dataclasses of one kind.

    >>> import lindstedt as ls
    >>> catalog = ls.catalog.entries
    >>> Table(catalog).column("name")[:2].tolist()
    ['pendulum', 'cubic-pendulum']
    """

    __slots__ = ()

    def column(self, name: str) -> Any:
        """Returns an attribute of all rows as an array; what is missing in numbers is NaN."""
        numpy = optional("numpy", "a column")
        values = [getattr(row, name) for row in self]
        if any(isinstance(value, (int, float)) for value in values):
            values = [numpy.nan if value is None else value for value in values]
        return numpy.array(values)

    def to_pandas(self) -> Any:
        """Returns the rows as a `pandas.DataFrame`.

        Raises:
            MissingPackage: pandas is not installed.
        """
        rows = [asdict(row) for row in self]  # type: ignore[call-overload]
        return optional("pandas", "a frame").DataFrame(rows)

    def _repr_html_(self) -> str | None:
        """The first rows as a table of a notebook."""
        if not self:
            return None
        left_out: frozenset[str] = getattr(self[0], "OPTIONAL", frozenset())
        names = [
            field.name
            for field in fields(self[0])  # type: ignore[arg-type]
            if field.name not in left_out or any(getattr(row, field.name) is not None for row in self)
        ]
        lines = [names, *([shown(getattr(row, name)) for name in names] for row in self[:MOST_SHOWN])]
        cells = ["".join(f"<td>{html.escape(cell)}</td>" for cell in line) for line in lines]
        more = len(self) - MOST_SHOWN
        below = f"<p>and {more} more rows</p>" if more > 0 else ""
        head = cells[0].replace("td>", "th>")
        body = "".join(f"<tr>{line}</tr>" for line in cells[1:])
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{below}"


def shown(value: Any) -> str:
    """A value in a cell of a table.

    >>> shown(None), shown(1 / 3), shown((1.0, 2)), shown("fold"), shown({"x": 0.5, "y": 2})
    ('', '0.333333', '1, 2', 'fold', 'x: 0.5, y: 2')
    """
    if isinstance(value, dict):
        return ", ".join(f"{name}: {shown(part)}" for name, part in value.items())
    if isinstance(value, (list, tuple)):
        return ", ".join(map(shown, value))
    if isinstance(value, float):
        return f"{value:.6g}"
    return "" if value is None else str(value)


def columns_of(text: str) -> dict[str, Any]:
    """The columns of a table of comma-separated values as arrays: whole numbers, numbers with NaN for
    what is missing, truth values, or texts with `None` for what is missing.

    >>> columns_of("n,x,name\\n1,0.5,a\\n2,,b\\n")["x"]
    array([0.5, nan])
    """
    numpy = optional("numpy", "a column")
    lines = (line for line in text.splitlines() if line and not line.startswith("#"))
    names, *rows = csv.reader(lines)

    def array(values: list[str]) -> Any:
        if values and all(value in ("true", "false") for value in values):
            return numpy.array([value == "true" for value in values])
        for kind in (int, float):
            try:
                return numpy.array([kind(value or "nan") for value in values], dtype=kind)
            except ValueError:
                continue
        return numpy.array([value or None for value in values], dtype=object)

    return {name: array([row[place] for row in rows]) for place, name in enumerate(names)}


def to_xarray(frame: Any, axes: list[str]) -> Any:
    """The rows of a sweep as an `xarray.Dataset` whose dimensions are the axes.

    Raises:
        MissingPackage: pandas or xarray is not installed.
    """
    xarray = optional("xarray", "a data set of several axes")
    dataset = xarray.Dataset.from_dataframe(frame.set_index(axes))
    for name, unit in frame.attrs.get("units", {}).items():
        if name in dataset.variables:
            dataset[name].attrs["units"] = unit
    return dataset
