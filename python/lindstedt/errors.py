"""Errors as exceptions, each with the words of the program, and keywords for its options.

>>> import lindstedt as ls
>>> try:
...     ls.derive("x'' + 2*zeta*x' + sin(x) = 0", method="lindstedt-poincare")
... except ls.Refused as why:
...     print(why.kind, "|", why.term)
refusal | 2*zeta*x'
"""

from __future__ import annotations

from typing import Any

from ._keywords import in_keywords


class LindstedtError(Exception):
    """Any error of the package.

    Attributes:
        message: What is wrong, without the help.
        kind: The part of the program that refused, by the name of its error: `oscillator`,
            `refusal`, `problem`, `verification`; `usage`, `timeout`, `command` where none did.
        term: The term of the equation that is to blame, as it was typed; `None` if none is.
        help: What to do about it; `None` where nothing is known.
    """

    def __init__(
        self, text: str, kind: str = "command", term: str | None = None, help: str | None = None
    ) -> None:
        super().__init__(text)
        self.kind = kind
        self.term = term
        message, _, given = text.partition("\n  help: ")
        self.message = message
        self.help = help if help is not None else given or None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.kind, self.term, self.help)


class Refused(LindstedtError, ValueError):
    """The problem is refused, or there is no result: an answer, with the reason and a way forward."""


class UsageError(LindstedtError, TypeError):
    """An argument that there is not, or with a value that it cannot have."""


class LostPoints(LindstedtError, RuntimeError):
    """The process of a shard of a study ended again and again without its lines.

    Attributes:
        shard: The shard, `3/64`.
    """

    def __init__(self, text: str, shard: str) -> None:
        super().__init__(text, "study")
        self.shard = shard

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.shard)


class TimeLimit(LindstedtError, TimeoutError):
    """The time was up before there was a result."""


class InternalError(LindstedtError, RuntimeError):
    """A mistake of the package: please report what was called."""


class MissingPackage(LindstedtError, ImportError):
    """An optional package that is not installed."""


#: The exceptions by the exit code of the program.
BY_CODE: dict[int, type[LindstedtError]] = {1: Refused, 2: UsageError, 70: InternalError}


def from_failure(code: int, kind: str, message: str, term: str | None) -> BaseException:
    """The exception of a failure of the program; the extension calls this."""
    if kind == "interrupted":
        return KeyboardInterrupt(message)
    error = TimeLimit if kind == "timeout" else BY_CODE.get(code, InternalError)
    return error(in_keywords(message), kind, term)
