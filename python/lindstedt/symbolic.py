"""SymPy: equations, laws and coefficients as its expressions, and back."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING, Any

from ._optional import optional
from .errors import Refused

if TYPE_CHECKING:
    from .law import Law
    from .oscillator import Oscillator

#: The functions of the grammar that have another name in SymPy.
TO_SYMPY = {
    "abs": "Abs",
    "sgn": "sign",
    "ln": "log",
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "max": "Max",
    "min": "Min",
    "Gamma": "gamma",
    "K": "elliptic_k",
}
#: The names of the functions of SymPy in the grammar.
FROM_SYMPY = {"Abs": "abs", "sign": "sgn", "log": "ln", "Max": "max", "Min": "min"}


def sympy() -> Any:
    """SymPy.

    Raises:
        MissingPackage: It is not installed.
    """
    return optional("sympy", "an exact expression")


def latex_of(expression: Any) -> str:
    """The LaTeX of a SymPy expression."""
    return str(sympy().latex(expression))


class Reader:
    """Reads the grammar of the program into SymPy."""

    def __init__(self, symbols: dict[str, Any]) -> None:
        self.sympy, self.symbols = sympy(), symbols

    def read(self, text: str) -> Any:
        """The expression of a text.

        >>> Reader({}).read("3*x^2/4 - sin(x)")
        3*x**2/4 - sin(x)
        """
        # A symbol has primes and may be a word of Python: it goes through the parser by a number.
        names: list[str] = []

        def numbered(match: re.Match[str]) -> str:
            names.append(match[0])
            return f"s_{len(names) - 1}_"

        text = re.sub(r"(?<![\w.])[^\W\d]\w*'*", numbered, text.replace("^", "**"))
        return self.node(ast.parse(text.strip(), mode="eval").body, text, names)

    def node(self, node: ast.expr, text: str, names: list[str]) -> Any:
        """The expression of a part of the syntax tree."""
        match node:
            case ast.Constant(int(value)):
                return self.sympy.Integer(value)
            case ast.Constant(float()):
                return self.sympy.Rational(ast.get_source_segment(text, node))
            case ast.UnaryOp(ast.USub(), inner):
                return -self.node(inner, text, names)
            case ast.UnaryOp(ast.UAdd(), inner):
                return self.node(inner, text, names)
            case ast.BinOp(left, operation, right):
                one, other = self.node(left, text, names), self.node(right, text, names)
                match operation:
                    case ast.Add():
                        return one + other
                    case ast.Sub():
                        return one - other
                    case ast.Mult():
                        return one * other
                    case ast.Div():
                        return one / other
                    case ast.Pow():
                        return one**other
            case ast.Call(ast.Name(place), arguments):
                name = names[int(place[2:-1])]
                values = [self.node(argument, text, names) for argument in arguments]
                return self.function(name, values)
            case ast.Name(place):
                return self.symbol(names[int(place[2:-1])])
        raise Refused(f"SymPy has no form of {ast.unparse(node)}", "symbolic")

    def function(self, name: str, values: list[Any]) -> Any:
        """A function at these values."""
        if name in ("J0", "J1"):
            return self.sympy.besselj(int(name[1]), *values)
        if name in ("I0", "I1"):
            return self.sympy.besseli(int(name[1]), *values)
        found = getattr(self.sympy, TO_SYMPY.get(name, name), None)
        return (found or self.sympy.Function(name))(*values)

    def symbol(self, name: str) -> Any:
        """A symbol, or what stands for it."""
        if name == "pi":
            return self.sympy.pi
        return self.symbols[name] if name in self.symbols else self.sympy.Symbol(name, real=True)


def expression(text: str, symbols: dict[str, Any] | None = None) -> Any:
    """Returns the SymPy expression of a text in the grammar of the program.

    >>> expression("A^2/8 + pi/3")
    A**2/8 + pi/3
    """
    return Reader(symbols or {}).read(text)


def equation_to_sympy(oscillator: Oscillator) -> Any:
    """Returns the equation of motion of an oscillator as a SymPy equation in a function of `t`.

    >>> import lindstedt as ls
    >>> ls.Oscillator("x'' + sin(x) = 0").to_sympy()
    Eq(sin(x(t)) + Derivative(x(t), (t, 2)), 0)
    """
    s = sympy()
    t = s.Symbol("t", real=True)
    x = s.Function(oscillator.coordinate, real=True)(t)
    name = oscillator.coordinate
    symbols = {"t": t, name: x, name + "'": x.diff(t), name + "''": x.diff(t, 2)}
    left, _, right = oscillator.equation.partition("=")
    reader = Reader(symbols)
    return s.Eq(reader.read(left), reader.read(right or "0"), evaluate=False)


def from_sympy(equation: Any) -> Oscillator:
    """Returns the oscillator of a SymPy equation, or of an expression that is zero.

    Raises:
        Refused: It has no function of one variable, or is no oscillator.

    >>> import lindstedt as ls
    >>> ls.from_sympy(ls.Oscillator("duffing").to_sympy()).parameters
    ('eps',)
    """
    from .oscillator import Oscillator

    return Oscillator(equation_from_sympy(equation))


def equation_from_sympy(equation: Any) -> str:
    """Returns the text of a SymPy equation in the grammar of the program."""
    s = sympy()
    if isinstance(equation, s.Eq):
        left, right = equation.lhs, equation.rhs
    else:
        left, right = s.sympify(equation), s.Integer(0)
    applied = left.atoms(s.core.function.AppliedUndef) | right.atoms(s.core.function.AppliedUndef)
    if len(applied) != 1:
        raise Refused(
            "the equation needs one function of time, x(t)\n"
            "  help: x = sympy.Function('x')(t), and x.diff(t, 2) for its acceleration",
            "symbolic",
        )
    (x,) = applied
    (t,) = x.args
    name = x.func.__name__
    put = {x.diff(t, order): s.Symbol(name + "'" * order) for order in (2, 1)}
    put_x = {x: s.Symbol(name), t: s.Symbol("t")}
    sides = [side.doit().subs(put).subs(put_x) for side in (left, right)]
    return " = ".join(written(side) for side in sides)


def written(value: Any) -> str:
    """The text of a SymPy expression in the grammar of the program.

    >>> import sympy
    >>> written(sympy.sqrt(sympy.Symbol("x")) * sympy.Rational(1, 3))
    'sqrt(x)/3'
    """
    printer = optional("sympy.printing.str", "an exact expression").StrPrinter

    class Printer(printer):  # type: ignore[misc, valid-type]
        """Prints the names of the grammar."""

        def _print_Function(self, function: Any) -> str:
            name = function.func.__name__
            inside = ", ".join(self._print(argument) for argument in function.args)
            return f"{FROM_SYMPY.get(name, name)}({inside})"

        _print_Max = _print_Min = _print_Function

        def _print_Float(self, number: Any) -> str:
            return repr(float(number))

        def _print_Exp1(self, number: Any) -> str:
            return "exp(1)"

    return str(Printer({"full_prec": False}).doprint(value)).replace("**", "^")


def law_to_sympy(law: Law) -> Any:
    """Returns the law of the frequency as a SymPy equation."""
    s = sympy()
    omega = s.Symbol("omega", real=True)
    if law.frequency_squared is not None:
        return s.Eq(omega**2, law.frequency_squared.to_sympy(), evaluate=False)
    if law.relation is not None:
        return s.Eq(law.relation.to_sympy(), 0, evaluate=False)
    if law.closed_form is not None:
        left, _, right = law.closed_form.partition("=")
        return s.Eq(expression(left), expression(right), evaluate=False)
    if law.frequency is not None:
        return s.Eq(omega, law.frequency.to_sympy(), evaluate=False)
    raise Refused("only numbers solve this law: see `by_quadrature` and `system`", "law")
