"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer


@dataclass(frozen=True, eq=False, repr=False)
class Study(Answer):
    """The first line of a shard: the study that its points belong to.

    Attributes:
        schema: The kind of document.
        study: The identity of the study: a hash of program version, command and file.
        version: The version of the program.
        command: The words of the command, without those that say how its result is handed on.
        file: The text of the file that the command reads; null where it reads none.
        shard: The shard whose points follow, I/N.
        total: The number of points of the whole study.
    """

    schema: Literal["lindstedt/study/1"]
    study: str
    version: str
    command: tuple[str, ...]
    file: str | None
    shard: str
    total: int


Study.FIELDS = (
    ("schema", "schema", None),
    ("study", "study", None),
    ("version", "version", None),
    ("command", "command", tuple),
    ("file", "file", None),
    ("shard", "shard", None),
    ("total", "total", None),
)
