"""What the dataclasses of the documents have in common: reading JSON and writing it."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, ClassVar, TypeVar

Reader = Callable[[Any], Any]
D = TypeVar("D", bound="Document")


class Document:
    """A part of a document: a frozen dataclass with the keys of its JSON.

    Numbers that JSON has as the text of a fraction are `fractions.Fraction`; lists are tuples. What
    is left out in the JSON is `None`.
    """

    #: The attributes, the key of each and what reads its value.
    FIELDS: ClassVar[tuple[tuple[str, str, Reader | None], ...]] = ()

    #: The keys that have the same value in every object of this kind.
    CONSTANTS: ClassVar[dict[str, Any]] = {}

    #: The keys that are left out where they have no value.
    OPTIONAL: ClassVar[frozenset[str]] = frozenset()

    @classmethod
    def from_json(cls: type[D], data: dict[str, Any]) -> D:
        """Makes the dataclass of a JSON object.

        Raises:
            TypeError: The object is none of this kind.
        """
        made = cls.__new__(cls)
        values = made.__dict__
        for name, key, read in cls.FIELDS:
            value = data.get(key)
            values[name] = value if read is None or value is None else read(value)
        return made

    # Written once here, and not for every class anew: that is what importing them takes long for.
    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name, _, _ in self.FIELDS)

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name, _, _ in self.FIELDS))

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={getattr(self, name)!r}" for name, _, _ in self.FIELDS)
        return f"{type(self).__name__}({values})"

    def to_json(self) -> dict[str, Any]:
        """Returns the JSON object again."""
        values = ((key, getattr(self, name)) for name, key, _ in self.FIELDS)
        return {
            key: plain(value)
            for key, value in values
            if value is not None or key not in self.OPTIONAL
        }


def plain(value: Any) -> Any:
    """The JSON of a value."""
    if isinstance(value, Document):
        return value.to_json()
    if isinstance(value, tuple):
        return [plain(part) for part in value]
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    return str(value) if isinstance(value, Fraction) else value


def fraction_or_text(text: str) -> Fraction | str:
    """The fraction of a text, or the text where it is an expression."""
    try:
        return Fraction(text)
    except ValueError:
        return text


def frozen(value: Any) -> Any:
    """A list as a tuple, all else as it is."""
    return tuple(map(frozen, value)) if isinstance(value, list) else value


def several(read: Reader) -> Reader:
    """What reads a list of such values."""
    return lambda values: tuple([None if value is None else read(value) for value in values])


def mapped(read: Reader) -> Reader:
    """What reads an object with such values."""
    return lambda values: {
        key: None if value is None else read(value) for key, value in values.items()
    }


def one_of(*classes: type[Document]) -> Reader:
    """What reads an object of one of these classes: the one whose keys it has."""

    def read(data: dict[str, Any]) -> Document:
        for cls in classes:
            same = all(data.get(key) == value for key, value in cls.CONSTANTS.items())
            if same and {key for _, key, _ in cls.FIELDS} >= data.keys():
                return cls.from_json(data)
        raise TypeError(f"no object of {' or '.join(cls.__name__ for cls in classes)}")

    return read
