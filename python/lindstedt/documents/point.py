"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from .._answer import Answer


@dataclass(frozen=True, eq=False, repr=False)
class Point(Answer):
    """A point of a study, in a line of its own.

    Attributes:
        schema: The kind of document.
        study: The identity of the study that it belongs to.
        version: The version of the program.
        index: The place of the point in the study, counted from 0.
        total: The number of points of the whole study.
        inputs: The point, by the names of what varies: the parameters of a sweep, the name of a
            material, the number of a run, the name of a claim.
        row: The result, with keys that depend on the command.
    """

    schema: Literal["lindstedt/point/1"]
    study: str
    version: str
    index: int
    total: int
    inputs: dict[str, Any]
    row: dict[str, Any]


Point.FIELDS = (
    ("schema", "schema", None),
    ("study", "study", None),
    ("version", "version", None),
    ("index", "index", None),
    ("total", "total", None),
    ("inputs", "inputs", dict),
    ("row", "row", dict),
)
