"""Keywords of Python as the words of a command, and the document that comes back."""

from __future__ import annotations

import importlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Union

from ._keywords import in_keywords
from ._lindstedt import read, run
from .documents import KINDS

#: A number as the program reads it: text is read exactly, `"3/2"` or `"pi/3"`.
Value = Union[str, int, float, Fraction]
#: Values by the names of their symbols, `{"A": 1.5}`, or the words `"A=1.5"`.
Values = Union[str, Mapping[str, Any], Sequence[str]]
#: An equation, the name of the catalogue, the path of a file, or the tables of a file.
Problem = Union[str, "os.PathLike[str]", Mapping[str, Any]]
#: Takes the parts done and all of them; an exception ends the work.
Progress = Callable[[int, int], object]

#: The classes of the package in the place of those of the schemas, each with its module.
OWN = {
    "Audit": ("audits", "Audit"),
    "CertificateDocument": ("certificates", "Certificate"),
    "Comparison": ("comparison", "Comparison"),
    "Fit": ("measurements", "Fit"),
    "Friction": ("tabulated", "Friction"),
    "Materials": ("tabulated", "Materials"),
    "Impact": ("impacts", "Impact"),
    "Modes": ("normal_modes", "Modes"),
    "Motion": ("motions", "Motion"),
    "MotionSweep": ("motions", "MotionSweep"),
    "Optimization": ("designs", "Optimization"),
    "Shortest": ("laws", "Shortest"),
    "Primary": ("motions", "Primary"),
    "PrimarySweep": ("motions", "PrimarySweep"),
    "Response": ("branches", "Response"),
    "Simulation": ("motions", "Simulation"),
    "SlowEquations": ("slow", "SlowEquations"),
    "Solution": ("law", "Law"),
    "Stability": ("tabulated", "Stability"),
    "Sweep": ("motions", "Sweep"),
}


@dataclass(frozen=True)
class Call:
    """A call of a command: its words without the format, and the text of `-`."""

    words: tuple[str, ...]
    input: str | None = None
    #: The results of this call in other formats, as they were asked for.
    forms: dict[str, str] = field(default_factory=dict, compare=False, repr=False)

    def document(self, progress: Progress | None = None) -> Result:
        """Runs the command and returns its JSON document."""
        text, notes, forms, passed, partial = run(self.worded("json"), self.input, progress)
        self.forms.update(forms)
        self.forms["json"] = text
        return Result(tuple(map(in_keywords, notes)), passed, partial)

    def form(self, name: str, *more: str) -> str:
        """The result in another format; it is made once."""
        key = " ".join([name, *more])
        if key not in self.forms:
            self.forms[key] = run(self.worded(name, *more), self.input)[0]
        return self.forms[key]

    def worded(self, name: str, *more: str) -> list[str]:
        """The words with those of a format."""
        command, *rest = self.words
        # A certificate of a law is a JSON document: its other formats are those of the laws.
        rest = [word for word in rest if name == "json" or word != "--certificate"]
        return [command, "--format", name, *more, *rest]


@dataclass(frozen=True)
class Result:
    """What came of a call beside its document."""

    notes: tuple[str, ...]
    passed: bool | None
    partial: bool


def number(value: Any) -> str:
    """A number in the words of the program.

    >>> number(Fraction(3, 2)), number(0.1), number("pi/3")
    ('3/2', '0.1', 'pi/3')
    """
    if isinstance(value, (str, Fraction)):
        return str(value)
    if isinstance(value, bool):
        raise TypeError("a number is needed, not a truth value")
    if hasattr(value, "item"):
        value = value.item()
    return repr(value) if isinstance(value, (int, float)) else str(value)


def is_many(value: Any) -> bool:
    """Whether this is a list or an array."""
    return isinstance(value, (list, set, frozenset)) or getattr(value, "ndim", 0) == 1


def name_of(keyword: str) -> str:
    """The name of a symbol that is a word of Python: `lambda_` is `lambda`."""
    return keyword[:-1] if keyword.endswith("_") and len(keyword) > 1 else keyword


def part(name: str, value: Any) -> str:
    """A value of an option: `0.5:1.5` of a tuple, `1,2` of a list."""
    if isinstance(value, tuple):
        return ("," if name == "order" else ":").join(map(number, value))
    if is_many(value):
        return ",".join(map(number, value))
    return number(value)


def option(name: str, value: Any) -> list[str]:
    """The words of an option.

    >>> option("at", {"A": 1.5, "eps": Fraction(1, 10)})
    ['--at=A=1.5', '--at=eps=1/10']
    >>> option("vary", {"W": (0.5, 2.5)}), option("steps", True), option("order", (2, 1))
    (['--vary=W=0.5:2.5'], ['--steps'], ['--order=2,1'])
    """
    flag = "--" + name.strip("_").replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    if isinstance(value, Mapping):
        return [f"{flag}={name_of(str(key))}={part(name, given)}" for key, given in value.items()]
    if is_many(value):
        return [f"{flag}={part(name, given)}" for given in value]
    if isinstance(value, os.PathLike):
        return [f"{flag}={os.fspath(value)}"]
    return [f"{flag}={part(name, value)}"]


def toml(tables: Mapping[str, Any], above: str = "") -> str:
    """The text of a problem file of its tables.

    >>> print(toml({"equation": "x'' + x = 0", "values": {"A": "3/2"}}), end="")
    equation = "x'' + x = 0"
    [values]
    A = "3/2"
    """
    plain, below = "", ""
    for key, value in tables.items():
        if isinstance(value, Mapping):
            name = f"{above}.{key}" if above else key
            below += f"[{name}]\n{toml(value, name)}"
        elif isinstance(value, (list, tuple)) and value and isinstance(value[0], Mapping):
            name = f"{above}.{key}" if above else key
            below += "".join(f"[[{name}]]\n{toml(row, name)}" for row in value)
        else:
            plain += f"{key} = {toml_value(value)}\n"
    return plain + below


def toml_value(value: Any) -> str:
    """A value in a problem file."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, (int, float)):
        return repr(value)
    return json.dumps(str(value), ensure_ascii=False)


def words_of(problem: Problem | None) -> tuple[list[str], str | None]:
    """The word for a problem, and the text that stands behind it."""
    if problem is None:
        return [], None
    if isinstance(problem, Mapping):
        return ["-"], toml(problem)
    text = getattr(problem, "problem", problem)
    if isinstance(text, Mapping):
        return ["-"], toml(text)
    return [os.fspath(text)], None


def command(
    name: str,
    problem: Problem | None,
    options: Mapping[str, Any],
    values: Mapping[str, Any],
) -> Call:
    """The call of a command with these keywords."""
    words, text = words_of(problem)
    # A word that begins with a dash is no option.
    asked = [word for key, value in options.items() for word in option(key, value)]
    asked += option("at", {key: value for key, value in values.items()})
    return Call((name, *asked, *(["--", *words] if words else [])), text)


def ask(
    name: str,
    problem: Problem | None,
    options: Mapping[str, Any],
    values: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> Any:
    """The result of a command with these keywords, in the class of its kind."""
    return answer(asked(name, problem, options, values), progress)


def asked(
    name: str,
    problem: Problem | None,
    options: Mapping[str, Any],
    values: Mapping[str, Any] | None = None,
) -> Call:
    """The call of a command with these keywords; a motion begins at values of its coordinate."""
    options, values = dict(options), dict(values or {})
    if name == "simulate" and values and problem is not None:
        begins, values = starts(problem, values)
        options["from_"] = option_list("from", options.get("from_")) + begins
    return command(name, problem, options, values)


def starts(problem: Problem, values: Mapping[str, Any]) -> tuple[list[str], dict[str, Any]]:
    """Those of the values at which a motion begins, `x=1.5` and `v=0`, and the others."""
    words, text = words_of(problem)
    _, coordinate, _ = read(words[0], text)
    begins = [f"{key}={number(value)}" for key, value in values.items() if key in (coordinate, "v")]
    others = {key: value for key, value in values.items() if key not in (coordinate, "v")}
    return begins, others


def option_list(name: str, value: Any) -> list[str]:
    """The values of a repeated option as words."""
    return [word.partition("=")[2] for word in option(name, value)]


def answer(call: Call, progress: Progress | None = None) -> Any:
    """The result of a call, in the class of its kind."""
    result = call.document(progress)
    data = json.loads(call.forms["json"])
    made = class_of(data).from_json(data)
    made._came_of(call, result)
    return made


def class_of(data: dict[str, Any]) -> Any:
    """The class of a document: that of the package where there is one, else that of the schema."""
    module, names = KINDS[data["schema"]]
    for name in names:
        place, own = OWN.get(name, (f"documents.{module}", name))
        found = getattr(importlib.import_module(f"lindstedt.{place}"), own)
        if {key for _, key, _ in found.FIELDS} >= data.keys():
            return found
    raise TypeError(f"no document of the kind {data['schema']}")
