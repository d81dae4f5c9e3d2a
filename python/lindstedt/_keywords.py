"""What the program says of its options, with the keywords that they are here."""

from __future__ import annotations

import json
import re
from functools import cache
from keyword import iskeyword

from ._lindstedt import commands

#: A command line in backticks, or in a line of its own, is one of the program, and stays so.
COMMAND_LINE = re.compile(r"(`[a-z]+(?: [a-z]+)? --[^`]*`|^ +lindstedt .*$)", re.MULTILINE)
#: What the parser of the command line adds to its messages.
OF_PARSER = re.compile(r"\n\n(?:Usage: |For more information, try '--help').*", re.DOTALL)
#: An option as that parser quotes it, `'--order <ORDER>'`.
QUOTED = re.compile(r"'--([a-z][a-z-]*)(?: <[^>]*>)?'")
#: An option with its value where one stands there: a quoted text, `x=1.5`, a number, a word in
#: capitals for any; a method is a word.
GIVEN = re.compile(
    r"(?P<open>`?)--(?:(?P<method>method) (?=[a-z]+-|averaging|pade|exact)|(?P<name>[a-z][a-z-]*[a-z])"
    r"(?: (?=\"|-?[0-9]|[A-Z]{2}|[^\s`'\",;]*=))?)"
    r"(?P<value>(?<= )(?:\"[^\"]*\"|[^\s`'\";]*[^\s`'\";.,:)]))?"
)


@cache
def options() -> frozenset[str]:
    """The options of all commands: what else begins with dashes is of an equation."""
    return frozenset(
        argument["name"] for command in json.loads(commands()) for argument in command["arguments"]
    )


def name_of(option: str) -> str:
    """The keyword of an option: `no_formula` of `no-formula`, `from_` of `from`."""
    return option.replace("-", "_") + ("_" if iskeyword(option) else "")


def spelt(match: re.Match[str]) -> str:
    """A keyword with its value, as Python has it."""
    name: str = match["method"] or match["name"]
    value: str | None = match["value"]
    opening: str = match["open"]
    if name not in options():
        return match[0]
    if value is None and name == "at":
        return f"{opening}values"
    if value is None:
        return f"`{name_of(name)}" + ("" if opening else "`")
    value = value.strip('"')
    if name == "at":
        return opening + value
    try:
        float(value)
    except ValueError:
        value = value if value.isupper() and value.isalpha() else f'"{value}"'
    return f"{opening}{name_of(name)}={value}"


def in_keywords(text: str) -> str:
    """A message of the program with its options as keywords.

    >>> in_keywords("no value for `F`\\n  help: add --at F=VALUE")
    'no value for `F`\\n  help: add F=VALUE'
    >>> in_keywords("leave --no-formula out, or give --from x=1.5, or --method averaging")
    'leave `no_formula` out, or give from_="x=1.5", or method="averaging"'
    >>> in_keywords("invalid value '-1' for '--order <ORDER>': it is negative\\n\\nUsage: derive")
    "invalid value '-1' for `order`: it is negative"
    >>> in_keywords("something is missing:\\n  x'' --sin(x)\\n  help:\\n    lindstedt simulate --jobs=2")
    "something is missing:\\n  x'' --sin(x)\\n  help:\\n    lindstedt simulate --jobs=2"
    """
    if "--" not in text:
        return text
    text = OF_PARSER.sub("", text)
    text = re.sub(r"(=\S*) --at (?=\S*=)", r"\1, ", text).replace("--at: ", "")
    parts = COMMAND_LINE.split(text)
    for place in range(0, len(parts), 2):
        part = QUOTED.sub(lambda match: f"`{name_of(match[1])}`", parts[place])
        parts[place] = GIVEN.sub(spelt, part)
    return "".join(parts)
