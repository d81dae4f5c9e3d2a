"""Writes what the package has from the program: the dataclasses of the documents from their JSON
schemas, and the functions of the commands from their options.

`python python/generate.py` writes `python/lindstedt/documents/`, one module a kind of document, and
`python/lindstedt/commands.py`; with `--check` nothing is written, and the exit code is 1 where a
file differs. The schemas are those that `lindstedt schema KIND` prints; the options are asked of
the extension, which must be built before.
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SCHEMAS = ROOT / "src" / "export" / "json" / "schemas"
PACKAGE = ROOT / "python" / "lindstedt"
WRITTEN = PACKAGE / "documents"

#: Definitions that are the root of another kind.
ROOTS = {"SolutionDocument": "solution"}
#: Definitions that the package gives methods.
MIXINS = {
    "Constant": "ConstantMethods",
    "Polynomial": "PolynomialMethods",
    "Verification": "VerificationMethods",
}
#: The module of what several kinds define alike.
COMMON = "common"

Schema = dict[str, Any]


def class_name(kind: str) -> str:
    """The name of the class of a kind, `MotionSweep` of `motion-sweep`."""
    return "".join(part.capitalize() for part in kind.split("-"))


def field_name(key: str) -> str:
    """The attribute of a key: a word of Python gets an underscore behind it."""
    return key + "_" if keyword.iskeyword(key) else key


def referred(schema: Schema) -> str:
    """The name of the definition that a `$ref` names."""
    return str(schema["$ref"]).rsplit("/", 1)[-1]


def references(schema: Any) -> set[str]:
    """The names of all definitions that a schema refers to."""
    if isinstance(schema, list):
        return set().union(*map(references, schema))
    if not isinstance(schema, dict):
        return set()
    below = references([value for key, value in schema.items() if key != "$defs"])
    return below | ({referred(schema)} if "$ref" in schema else set())


class Kinds:
    """All schemas, and where each definition is written."""

    def __init__(self) -> None:
        self.schemas: dict[str, Schema] = {
            path.stem: json.loads(path.read_text(encoding="utf-8"))
            for path in sorted(SCHEMAS.glob("*.json"))
        }
        holders: dict[tuple[str, str], list[str]] = {}
        for kind, schema in self.schemas.items():
            for name, definition in schema.get("$defs", {}).items():
                text = json.dumps(definition, sort_keys=True)
                holders.setdefault((name, text), []).append(kind)
        self.shared: dict[str, Schema] = {}
        for (name, text), kinds in holders.items():
            if len(kinds) > 1 and name not in ROOTS:
                if name in self.shared:
                    raise ValueError(f"{name}: two definitions are shared under one name")
                self.shared[name] = json.loads(text)
        for name, definition in self.shared.items():
            if missing := references(definition) - set(self.shared):
                raise ValueError(f"{name} is shared, and what it refers to is not: {missing}")

    def definition(self, kind: str, name: str) -> Schema:
        """The definition that a kind refers to."""
        return self.shared[name] if kind == COMMON else self.schemas[kind]["$defs"].get(name, {})

    def place(self, kind: str, name: str) -> tuple[str, str]:
        """The module and the class of a definition that a kind refers to."""
        if name in ROOTS:
            return ROOTS[name], class_name(ROOTS[name])
        if kind == COMMON:
            return COMMON, name
        own = self.schemas[kind]["$defs"][name]
        return (COMMON if self.shared.get(name) == own else kind), name


class Module:
    """The text of one module."""

    def __init__(self, kinds: Kinds, kind: str) -> None:
        self.kinds, self.kind = kinds, kind
        self.imports: dict[str, set[str]] = {}
        self.mixins: set[str] = set()
        self.blocks: list[str] = []

    def reference(self, name: str) -> str:
        """The class of a definition, imported where another module has it."""
        module, name = self.kinds.place(self.kind, name)
        if module != self.kind:
            self.imports.setdefault(module, set()).add(name)
        return name

    def typed(self, key: str, schema: Schema) -> tuple[str, str | None]:
        """The annotation of a value, and the expression that reads it; `None` for as it is."""
        if "$ref" in schema:
            name = self.reference(referred(schema))
            definition = self.kinds.definition(self.kind, referred(schema))
            if "properties" in definition or referred(schema) in ROOTS:
                return name, f"{name}.from_json"
            return name, self.typed(key, definition)[1]
        if "anyOf" in schema or "oneOf" in schema:
            options = schema.get("anyOf") or schema["oneOf"]
            filled = [option for option in options if option.get("type") != "null"]
            if len(filled) < len(options) and len(filled) == 1:
                annotation, reader = self.typed(key, filled[0])
                return f"{annotation} | None", reader
            if all("const" in option for option in filled):
                return self.literal([option["const"] for option in filled]), None
            parts = [self.typed(key, option) for option in filled]
            annotation = " | ".join(part for part, _ in parts)
            if all(reader == f"{part}.from_json" for part, reader in parts):
                return annotation, f"one_of({', '.join(part for part, _ in parts)})"
            return annotation, "frozen" if any(reader for _, reader in parts) else None
        kinds = schema.get("type", "object")
        kinds = kinds if isinstance(kinds, list) else [kinds]
        filled = [kind for kind in kinds if kind != "null"]
        none = " | None" if len(filled) < len(kinds) else ""
        if "enum" in schema or "const" in schema:
            values = schema.get("enum", [schema.get("const")])
            return self.literal(values), None
        if not filled:
            return "None", None
        if filled == ["array"]:
            annotation, reader = self.typed(key, schema.get("items", {}))
            count = schema.get("minItems")
            if count is not None and count == schema.get("maxItems"):
                inner = ", ".join([annotation] * count)
            else:
                inner = f"{annotation}, ..."
            return f"tuple[{inner}]{none}", f"several({reader})" if reader else "tuple"
        if filled == ["object"] and schema["additionalProperties"] is True:
            return f"dict[str, Any]{none}", "dict"
        if filled == ["object"]:
            annotation, reader = self.typed(key, schema["additionalProperties"])
            return f"dict[str, {annotation}]{none}", f"mapped({reader})" if reader else "dict"
        if filled == ["string"]:
            return self.exact(key, schema, none)
        names = {"number": "float", "integer": "int", "boolean": "bool"}
        return names[filled[0]] + none, None

    @staticmethod
    def exact(key: str, schema: Schema, none: str) -> tuple[str, str | None]:
        """A text, or the fraction that it is."""
        description = schema.get("description", "")
        if key == "exact" and "or an expression" in description:
            return f"Fraction | str{none}", "fraction_or_text"
        if key == "exact" or "fraction, exact" in description or "exact fraction" in description:
            return f"Fraction{none}", "Fraction"
        return f"str{none}", None

    @staticmethod
    def literal(values: list[Any]) -> str:
        """The annotation of one of these values."""
        filled = [value for value in values if value is not None]
        none = " | None" if len(filled) < len(values) else ""
        return f"Literal[{', '.join(json.dumps(v) if isinstance(v, str) else repr(v) for v in filled)}]{none}"

    def define(self, name: str, schema: Schema) -> None:
        """Adds a definition: a class, or another name of a type."""
        if "properties" not in schema:
            annotation, _ = self.typed(name, schema)
            told = textwrap.fill(
                schema.get("description", name), 98, initial_indent="#: ", subsequent_indent="#: "
            )
            self.blocks.append(f"{told}\n{name}: TypeAlias = {annotation}\n")
            return
        bases = "Answer" if "schema" in schema["properties"] else "Document"
        if name in MIXINS:
            self.mixins.add(MIXINS[name])
            bases = f"{MIXINS[name]}, Document"
        fields, readers, told = [], [], []
        for key, value in schema["properties"].items():
            annotation, reader = self.typed(key, value)
            if key not in schema.get("required", []) and not annotation.endswith("None"):
                annotation += " | None"
            fields.append(f"    {field_name(key)}: {annotation}")
            readers.append(f'        ("{field_name(key)}", "{key}", {reader}),')
            told.append(
                textwrap.fill(
                    f"{field_name(key)}: {value.get('description', '')}".rstrip(": "),
                    98,
                    initial_indent="        ",
                    subsequent_indent="            ",
                )
            )
        heading = textwrap.fill(schema.get("description", ""), 95, subsequent_indent="    ")
        lines = ["@dataclass(frozen=True, eq=False, repr=False)", f"class {name}({bases}):", f'    """{heading}', "", "    Attributes:"]
        lines += [*told, '    """', "", *fields, "", "", f"{name}.FIELDS = ("]
        lines += [line[4:] for line in readers] + [")"]
        constants = {
            key: value["const"]
            for key, value in schema["properties"].items()
            if "const" in value and key != "schema"
        }
        optional = sorted(set(schema["properties"]) - set(schema.get("required", [])))
        if optional:
            lines.append(f"{name}.OPTIONAL = frozenset({optional!r})")
        if constants:
            lines.append(f"{name}.CONSTANTS = {constants!r}")
        self.blocks.append("\n".join(lines).replace("\\", "\\\\") + "\n")

    def text(self) -> str:
        """The whole module."""
        body = "\n\n".join(self.blocks)
        used = [
            name
            for name in ("Answer", "Document", "fraction_or_text", "frozen", "mapped", "one_of", "several")
            if f"{name}(" in body or f"{name})" in body or f" {name}," in body
        ]
        head = [
            '"""Made by `python/generate.py` from the JSON schemas: change those."""',
            "",
            "from __future__ import annotations",
            "",
            "from dataclasses import dataclass",
        ]
        if "Fraction" in body:
            head.append("from fractions import Fraction")
        typing = [
            name
            for name, use in (("Any", " Any]"), ("Literal", "Literal"), ("TypeAlias", "TypeAlias"))
            if use in body
        ]
        if typing:
            head.append(f"from typing import {', '.join(typing)}")
        head.append("")
        if "Answer" in used:
            head.append("from .._answer import Answer")
            used.remove("Answer")
        if used:
            head.append(f"from .._document import {', '.join(sorted(used))}")
        if self.mixins:
            head.append(f"from .._polynomial import {', '.join(sorted(self.mixins))}")
        for module in sorted(self.imports):
            names = ", ".join(sorted(self.imports[module]))
            head.append(f"from .{module.replace('-', '_')} import {names}")
        return "\n".join(head) + "\n\n\n" + body


def ordered(definitions: dict[str, Schema]) -> list[str]:
    """The names so that each stands behind those that it refers to."""
    done: list[str] = []

    def visit(name: str) -> None:
        for below in sorted(references(definitions[name]) & set(definitions)):
            if below != name and below not in done:
                visit(below)
        if name not in done:
            done.append(name)

    for name in definitions:
        visit(name)
    return done


def modules() -> dict[str, str]:
    """The text of every module, by the name of its file."""
    kinds = Kinds()
    written: dict[str, str] = {}
    table = []
    for kind in [COMMON, *kinds.schemas]:
        module = Module(kinds, kind)
        if kind == COMMON:
            own = kinds.shared
        else:
            definitions = kinds.schemas[kind].get("$defs", {})
            own = {n: d for n, d in definitions.items() if kinds.place(kind, n)[0] == kind}
        for name in ordered(own):
            module.define(name, own[name])
        if kind != COMMON:
            root = {k: v for k, v in kinds.schemas[kind].items() if k != "$defs"}
            module.define(class_name(kind), root)
            title = f"lindstedt/{kind}/1"
            options = [referred(option) for option in root.get("anyOf", [])] or [class_name(kind)]
            names = ", ".join(f'"{option}"' for option in options)
            table.append(f'    "{title}": ("{kind.replace("-", "_")}", ({names},)),')
        written[f"{kind.replace('-', '_')}.py"] = module.text()
    written["__init__.py"] = (
        '"""The documents as frozen dataclasses, one module a kind.\n\n'
        'Made by `python/generate.py` from the JSON schemas: change those.\n"""\n\n'
        "#: The module and the classes of each kind, by what stands under `schema`.\n"
        "KINDS: dict[str, tuple[str, tuple[str, ...]]] = {\n" + "\n".join(table) + "\n}\n"
    )
    return written


#: The commands that have a document, and the classes of their results.
RESULTS = {
    "derive": "Law",
    "compare": "Comparison",
    "impact": "Impact | ImpactCertificate | ImpactComparison",
    "simulate": "Simulation | Sweep | Motion | MotionSweep | Primary | PrimarySweep",
    "response": "Response",
    "absorber": "Absorber",
    "orbits": "Orbits | OrbitCertificateDocument",
    "shortest": "Shortest | LawCertificateDocument",
    "friction": "Friction",
    "lagrange": "Lagrangian",
    "materials": "Materials",
    "optimize": "Optimization",
    "stability": "Stability",
    "audit": "Audit",
    "paper": "Audit",
    "certify": "Certificate | DampedCertificateDocument | ModeCertificateDocument"
    " | CoupledCertificateDocument | CertificateRange",
    "check": "Certificate | DampedCertificateDocument | ModeCertificateDocument"
    " | CoupledCertificateDocument | LawCertificateDocument | OrbitCertificateDocument",
}
#: The commands of an equation, which are methods of `Oscillator` too.
OF_EQUATIONS = ("derive", "compare", "simulate", "response", "stability", "certify")
#: Options that Python has in another way.
LEFT_OUT = {"at", "format", "output", "plot", "quiet", "shard", "standalone"}
#: What Python says of an option in other words than the help.
TOLD = {
    "problem": "An equation, an `Oscillator`, a name of the catalogue, the path of a problem file, or"
    " the tables of one",
    "file": "The path of a file, or the tables of a problem file",
    "tolerance": "The relative error up to which a verdict is a pass; 0.01 without it",
    "strict": "Whether a claim that is not reproduced fails also where the file expects so",
    "steps": "Whether the derivation is kept, line by line",
}
#: The type of an option by what the help says that it takes.
TYPES = {
    "DEGREE": "int",
    "H": "int",
    "K": "int",
    "N[:M]": "int | str",
    "N": "int",
    "NAME=VALUE,...": "Values",
    "NAME=FROM:TO": "Values",
    "QUANTITY": "str",
    "NAME=from:to:count": "Values",
    "x=VALUE": "Values",
    "VALUE": "Value",
    "PERIOD": "Value",
    "ORDER": "int | tuple[int, ...] | str",
    "P:Q": "tuple[int, int] | str",
    "LOW:HIGH": "tuple[Value, Value] | str",
    "R": "float",
    "T": "float",
    "SECONDS": "float",
    "ALPHA": "float",
    "A": "float",
    "V": "float",
    "N|SECONDSs": "int | str",
    "FILE.jsonl": "str | os.PathLike[str]",
}


def option_type(argument: dict[str, Any]) -> str:
    """The annotation of an option."""
    if argument["takes"] is None:
        return "bool"
    if argument["choices"]:
        return f"Literal[{', '.join(json.dumps(choice) for choice in argument['choices'])}]"
    named = TYPES.get(argument["takes"], "str")
    if argument["repeatable"] and named != "Values":
        return f"Sequence[{named}]"
    return named


def place_name(argument: dict[str, Any]) -> str:
    """The name of what a command is about: its own, where it is one of a few words."""
    return str(argument["name"]) if argument["choices"] else "problem"


def command_text(command: dict[str, Any], of_equation: bool) -> str:
    """The text of the function of a command, or of the method."""
    name, result = command["name"], RESULTS[command["name"]]
    arguments = [a for a in command["arguments"] if not a["hidden"] and a["name"] not in LEFT_OUT]
    place = next((a for a in arguments if a["positional"]), None)
    options = [a for a in arguments if not a["positional"]]
    takes_values = any(a["name"] == "at" for a in command["arguments"])
    first = [a for a in options if a["name"] == "method"]
    after = [a for a in options if a["name"] != "method"]
    signature, told = ["self"] if of_equation else [], []
    if place is not None and not of_equation:
        none = "" if place["required"] else " | None = None"
        kind = option_type(place) if place["choices"] else "Problem"
        signature.append(f"{place_name(place)}: {kind}{none}")
        told.append(f"{place_name(place)}: {TOLD.get(place['name'], place['help'])}.")
    for argument in [*first, *after]:
        if argument in after and "*" not in signature:
            signature.append("*")
        python = field_name(argument["name"].replace("-", "_"))
        kind = option_type(argument)
        signature.append(f"{python}: {kind} = False" if kind == "bool" else f"{python}: {kind} | None = None")
        told.append(f"{python}: {TOLD.get(argument['name'], argument['help'])}.")
    if "*" not in signature:
        signature.append("*")
    if takes_values:
        signature.append("at: Values | None = None")
        told.append('at: Values of symbols whose names are options or no words, `{"small": 1}`.')
    signature.append("progress: Progress | None = None")
    told.append("progress: Is called with the parts done and all of them; an exception ends the work.")
    if takes_values:
        signature.append("**values: Value")
        told.append("**values: The values of symbols, exact where they are text or fractions.")
    names = [field_name(a["name"].replace("-", "_")) for a in [*first, *after]]
    given = ", ".join(f'"{n}": {n}' for n in names + (["at"] if takes_values else []))
    problem = "self" if of_equation else place_name(place) if place is not None else "None"
    values = "values" if takes_values else "{}"
    if of_equation:
        body = [f'return ask("{name}", self.problem, {{{given}}}, {values}, progress)']
    else:
        body = [f'return ask("{name}", {problem}, {{{given}}}, {values}, progress)']
    body[0] += "  # type: ignore[no-any-return]"
    lines = [f"def {name}("] + [f"    {part}," for part in signature]
    lines += [f") -> {result}:", f'    """{command["about"]}.', "", "    Args:"]
    for text in told:
        wrapped = textwrap.wrap(text.replace("..", "."), 84 if of_equation else 88)
        lines.append("        " + wrapped[0])
        lines += ["            " + line for line in wrapped[1:]]
    lines += ["", "    Raises:", "        Refused: The problem is refused, with the term and a way forward."]
    lines += ["        UsageError: An option has a value that it cannot have.", '    """']
    lines += [f"    {line}" for line in body]
    text = "\n".join(lines) + "\n"
    return textwrap.indent(text, "    ") if of_equation else text


def commands_text(commands: list[dict[str, Any]]) -> str:
    """The module of the commands."""
    from lindstedt._call import OWN

    own: dict[str, set[str]] = {}
    for module, name in OWN.values():
        own.setdefault(module, set()).add(name)
    named = {name for result in RESULTS.values() for name in result.split(" | ")}
    classes = sorted(named - {name for names in own.values() for name in names})
    kinds = {class_name(path.stem): path.stem for path in SCHEMAS.glob("*.json")}
    kinds["DampedCertificateDocument"] = "certificate"
    kinds["ModeCertificateDocument"] = "certificate"
    kinds["CoupledCertificateDocument"] = "certificate"
    kinds["LawCertificateDocument"] = "certificate"
    kinds["OrbitCertificateDocument"] = "certificate"
    imports = [
        f"    from .documents.{kinds[name].replace('-', '_')} import {name}" for name in classes
    ]
    imports += [
        f"    from .{module} import {', '.join(sorted(names))}" for module, names in own.items()
    ]
    imports.sort()
    head = [
        '"""The commands of the program as functions. Made by `python/generate.py` from its help."""',
        "",
        "from __future__ import annotations",
        "",
        "import os",
        "from collections.abc import Sequence",
        "from typing import TYPE_CHECKING, Literal",
        "",
        "from ._call import Problem, Progress, Value, Values, ask",
        "",
        "if TYPE_CHECKING:",
        *imports,
    ]
    written = [command for command in commands if command["name"] in RESULTS]
    functions = "\n\n".join(command_text(command, False) for command in written)
    of_equations = [command for command in written if command["name"] in OF_EQUATIONS]
    methods = "\n".join(command_text(command, True) for command in of_equations)
    kind = (
        "class EquationCommands:\n"
        '    """The commands of an equation as methods."""\n\n'
        "    problem: Problem\n\n"
    )
    return "\n".join(head) + "\n\n\n" + functions + "\n\n" + kind + methods


def main(arguments: list[str]) -> int:
    """Writes the modules, or compares them."""
    # The package that is installed comes before its sources, which have no extension.
    sources = str(ROOT / "python")
    sys.path[:] = [path for path in sys.path if path != sources] + [sources]
    from lindstedt._lindstedt import commands

    texts = {f"documents/{name}": text for name, text in modules().items()}
    texts["commands.py"] = commands_text(json.loads(commands()))
    WRITTEN.mkdir(exist_ok=True)
    kept = {
        str(path.relative_to(PACKAGE)): path.read_text(encoding="utf-8")
        for path in [*WRITTEN.glob("*.py"), PACKAGE / "commands.py"]
        if path.exists()
    }
    if "--check" in arguments:
        wrong = sorted(name for name in texts | kept if texts.get(name) != kept.get(name))
        for name in wrong:
            print(f"{name} is not what the schemas say: run python python/generate.py")
        return 1 if wrong else 0
    for name, text in texts.items():
        (PACKAGE / name).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
