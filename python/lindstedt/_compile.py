"""The functions of a law for arrays, made of the program that `--format python` writes.

That program is the one place where the formulas of a law are written as code. Here its functions
are read as a syntax tree, powers are multiplied out, and what raises an error for a number gives
NaN in an array.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from ._optional import optional
from .errors import Refused

#: The functions of a law, by the names of the program.
NAMES = ("angular_frequency", "displacement", "velocity")
#: The names of NumPy for those of `math`; those of jax.numpy are the same.
OF_ARRAYS = {
    **{name: name for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "sqrt", "abs")},
    "log": "log",
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan",
    "fabs": "abs",
    "pi": "pi",
}
#: Functions of `math` that arrays have only where their arguments are numbers of the program.
OF_NUMBERS = ("gamma",)

Function = Callable[..., Any]


def identity(function: Function) -> Function:
    """What stands in the place of `elementwise` where broadcasting is done otherwise."""
    return function


def scalar_functions(program: str, decorate: Callable[[Function], Function] = identity) -> dict[str, Any]:
    """The functions of a program for numbers, each that it declares elementwise decorated."""
    tree = ast.parse(program)
    tree.body = [
        part
        for part in tree.body
        if not (isinstance(part, ast.FunctionDef) and part.name == "elementwise")
    ]
    space: dict[str, Any] = {"elementwise": decorate}
    exec(compile(tree, "<lindstedt>", "exec"), space)
    return space


class Powers(ast.NodeTransformer):
    """Puts products in the place of whole powers of a symbol, each computed once."""

    def __init__(self) -> None:
        self.known: dict[tuple[str, int], str] = {}
        self.made: list[ast.stmt] = []

    def power(self, symbol: str, exponent: int) -> str:
        """The name of a power, which is the product of two lower ones."""
        if exponent == 1:
            return symbol
        key = (symbol, exponent)
        if key not in self.known:
            half, other = exponent // 2, exponent - exponent // 2
            left, right = self.power(symbol, half), self.power(symbol, other)
            self.known[key] = name = f"_{symbol}_{exponent}"
            self.made.append(ast.parse(f"{name} = {left}*{right}").body[0])
        return self.known[key]

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        match node:
            case ast.BinOp(ast.Name(symbol), ast.Pow(), ast.Constant(int(exponent))) if (
                exponent > 1
            ):
                return ast.Name(self.power(symbol, exponent), ast.Load())
            case ast.BinOp(_, ast.Mult() | ast.Div(), _):
                return self.product(node)
        return self.generic_visit(node)

    def product(self, node: ast.BinOp) -> ast.expr:
        """A product with its numbers as one factor, and that first: an array is gone through once for
        each other factor."""
        number, above, below = Fraction(1), list[ast.expr](), list[ast.expr]()

        def take(part: ast.expr, inverse: bool) -> None:
            nonlocal number
            match part:
                case ast.BinOp(left, ast.Mult(), right):
                    take(left, inverse)
                    take(right, inverse)
                case ast.BinOp(left, ast.Div(), right):
                    take(left, inverse)
                    take(right, not inverse)
                case ast.UnaryOp(ast.USub(), inner):
                    number = -number
                    take(inner, inverse)
                case ast.Constant(int(value)) if value:
                    number = number / value if inverse else number * value
                case _:
                    (below if inverse else above).append(self.visit(part))

        take(node, False)
        try:
            made: ast.expr | None = None if number == 1 else ast.Constant(float(number))
        except OverflowError:
            return ast.BinOp(self.visit(node.left), node.op, self.visit(node.right))
        for factor in above:
            made = factor if made is None else ast.BinOp(made, ast.Mult(), factor)
        for factor in below:
            made = ast.BinOp(made or ast.Constant(1.0), ast.Div(), factor)
        return made or ast.Constant(1.0)

    def forget(self, symbols: list[str]) -> None:
        """Forgets the powers of symbols that have another value from here on."""
        self.known = {key: name for key, name in self.known.items() if key[0] not in symbols}


class NotForArrays(Exception):
    """A function that branches or iterates, so that arrays go through it number by number."""


def of_arrays(function: ast.FunctionDef, known: set[str]) -> ast.FunctionDef:
    """A function of the program as one of arrays.

    Raises:
        NotForArrays: It branches, iterates, or calls something that does.
    """
    powers, checks, body = Powers(), 0, []
    for part in function.body[1:]:
        if isinstance(part, ast.If) and isinstance(part.body[0], ast.Raise) and not part.orelse:
            # `if not value > 0: raise`: of a negative square the root is NaN anyhow.
            check = ast.unparse(part.test).removeprefix("not ")
            if check == "omega_squared > 0":
                continue
            body.append(ast.parse(f"_valid_{checks} = {check}").body[0])
            checks += 1
            continue
        if not isinstance(part, (ast.Assign, ast.Return)):
            raise NotForArrays(function.name)
        for call in ast.walk(part):
            if isinstance(call, ast.Call):
                name = getattr(call.func, "id", "")
                numbers = not any(isinstance(node, ast.Name) for node in map_arguments(call))
                if name not in OF_ARRAYS and name not in known:
                    if not (numbers and name in OF_NUMBERS):
                        raise NotForArrays(function.name)
            elif isinstance(call, (ast.IfExp, ast.Compare, ast.ListComp)):
                raise NotForArrays(function.name)
        changed = powers.visit(part)
        body += [*powers.made, changed]
        powers.made = []
        if isinstance(changed, ast.Assign):
            powers.forget([target.id for target in changed.targets if isinstance(target, ast.Name)])
    if checks and isinstance(body[-1], ast.Return) and body[-1].value is not None:
        valid = " & ".join(f"(_valid_{number})" for number in range(checks))
        value = ast.unparse(body[-1].value)
        body[-1] = ast.parse(f"def f():\n return where({valid}, {value}, nan)").body[0].body[0]  # type: ignore[attr-defined]
    function.body, function.decorator_list = [function.body[0], *body], []
    return function


def map_arguments(call: ast.Call) -> list[ast.AST]:
    """All nodes of the arguments of a call."""
    return [node for argument in call.args for node in ast.walk(argument)]


def array_space(program: str, module: Any) -> dict[str, Any]:
    """The functions of a program for the arrays of a module, NumPy or jax.numpy.

    Raises:
        NotForArrays: A function branches or iterates.
    """
    tree = ast.parse(program)
    made: list[ast.stmt] = []
    for part in tree.body:
        if isinstance(part, ast.FunctionDef) and part.name in NAMES:
            made.append(of_arrays(part, set(NAMES)))
    space: dict[str, Any] = {
        own: getattr(module, theirs) for own, theirs in OF_ARRAYS.items() if hasattr(module, theirs)
    }
    space |= {"where": module.where, "nan": math.nan, "gamma": math.gamma}
    body = ast.fix_missing_locations(ast.Module(made, []))
    exec(compile(body, "<lindstedt>", "exec"), space)
    return space


def coerced(value: Any) -> Any:
    """A number or an array of what is given: lists become arrays, fractions and whole numbers
    doubles."""
    if hasattr(value, "__array_ufunc__") or hasattr(value, "__jax_array__"):
        # Powers of whole numbers would overflow.
        is_whole = getattr(getattr(value, "dtype", None), "kind", "f") in "iub"
        return value.astype(float) if is_whole else value
    if isinstance(value, (list, tuple)):
        return optional("numpy", "an array").asarray(value, dtype=float)
    return float(value)


#: The frame of a function: numbers go to the program as it is, arrays to the one made of it.
DISPATCH = '''
def {name}({parameters}):
    if {are_numbers}:
        return scalar({arguments})
{coercions}
    if {are_numbers}:
        return scalar({arguments})
    if {are_long}:
        return by_blocks(array, ({arguments},))
    return array({arguments})
'''

#: The number of elements that are gone through at a time, so that what is computed of them stays in
#: the cache.
BLOCK = 8192


def by_blocks(function: Function, arguments: tuple[Any, ...]) -> Any:
    """The function of long arrays, block by block; arrays of several shapes at once."""
    numpy = optional("numpy", "an array")
    arrays = [value for value in arguments if isinstance(value, numpy.ndarray)]
    others = [value for value in arguments if value.__class__ is not float]
    shape = arrays[0].shape
    if len(others) != len(arrays) or any(array.shape != shape for array in arrays):
        return function(*arguments)
    flat: list[Any] = [v if v.__class__ is float else v.reshape(-1) for v in arguments]
    result = numpy.empty(arrays[0].size)
    for begin in range(0, result.size, BLOCK):
        part = slice(begin, begin + BLOCK)
        result[part] = function(*(v if v.__class__ is float else v[part] for v in flat))
    return result.reshape(shape)


def numpy_functions(program: str) -> dict[str, Function]:
    """The functions of a program for numbers and for arrays, which broadcast."""
    scalars = scalar_functions(program)
    try:
        arrays: Callable[[str], Any] = array_space(program, optional("numpy", "an array")).__getitem__
    except NotForArrays:
        vectorize = optional("numpy", "an array").vectorize

        def arrays(name: str) -> Any:
            return vectorize(nan_for_errors(scalars[name]), otypes=[float])

    found: dict[str, Function] = {}
    for name in NAMES:
        if name not in scalars:
            continue
        scalar = scalars[name]
        parameters = scalar.__code__.co_varnames[: scalar.__code__.co_argcount]
        numbers = " and ".join(f"{p}.__class__ is float" for p in parameters) or "True"
        text = DISPATCH.format(
            name=name,
            parameters=", ".join(parameters),
            arguments=", ".join(parameters),
            are_numbers=numbers,
            are_long=" or ".join(
                f"{p}.__class__ is ndarray and {p}.size > {4 * BLOCK}" for p in parameters
            )
            or "False",
            coercions="\n".join(
                f'    if {p}.__class__ is not ndarray or {p}.dtype.kind != "f": {p} = coerced({p})'
                for p in parameters
            )
            or "    pass",
        )
        space = {
            "scalar": scalar,
            "array": arrays(name),
            "by_blocks": by_blocks,
            "coerced": coerced,
            "ndarray": optional("numpy", "an array").ndarray,
        }
        exec(text, space)
        function = space[name]
        function.__doc__ = scalar.__doc__
        found[name] = function
    return found


def nan_for_errors(function: Function) -> Function:
    """A function that gives NaN where the program has an error."""

    def or_nan(*arguments: float) -> float:
        try:
            return float(function(*arguments))
        except (ValueError, ZeroDivisionError, OverflowError):
            return math.nan

    return or_nan


def numba_functions(program: str) -> dict[str, Function]:
    """The functions of a program, compiled by numba; they broadcast as ufuncs do."""
    numba = optional("numba", 'lambdify("numba")')
    tree = ast.parse(program)
    kept: list[ast.stmt] = []
    for part in tree.body:
        if isinstance(part, ast.FunctionDef) and part.name != "elementwise":
            part.decorator_list = [ast.Name("njit", ast.Load())]
            if part.name in NAMES:
                NanForRaise().visit(part)
            kept.append(part)
        elif isinstance(part, ast.ImportFrom) and part.module == "math":
            kept.append(part)
    space: dict[str, Any] = {"njit": numba.njit, "nan": math.nan}
    body = ast.fix_missing_locations(ast.Module(kept, []))
    exec(compile(body, "<lindstedt>", "exec"), space)
    found: dict[str, Function] = {}
    for name in NAMES:
        if name in space:
            inner = space[name]
            parameters = inner.py_func.__code__
            names = ", ".join(parameters.co_varnames[: parameters.co_argcount])
            outer: dict[str, Any] = {"inner": inner}
            exec(f"def {name}({names}):\n    return inner({names})", outer)
            found[name] = numba.vectorize(outer[name])
    return found


class NanForRaise(ast.NodeTransformer):
    """Returns NaN in the place of an error."""

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        return ast.Return(ast.Name("nan", ast.Load()))


def jax_functions(program: str) -> dict[str, Function]:
    """The functions of a program for jax, compiled.

    Raises:
        Refused: A function branches or iterates.
    """
    jax = optional("jax", 'lambdify("jax")')
    try:
        space = array_space(program, optional("jax.numpy", 'lambdify("jax")'))
    except NotForArrays as why:
        text = f"{why} iterates, and jax has no such functions\n  help: choose numpy or numba"
        raise Refused(text, "program") from None
    return {name: jax.jit(space[name]) for name in NAMES if name in space}


