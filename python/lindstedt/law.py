"""A derived law: its formulas as functions of arrays, as SymPy, as code, as LaTeX."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from types import CodeType
from typing import Any, Literal

from ._call import Call, Value, Values, answer, number, option
from ._optional import optional
from .documents.common import Polynomial, Verification
from .documents.solution import Solution
from .errors import Refused

#: The languages of programs.
LANGUAGES = ("python", "c", "rust", "julia", "matlab")


class Law(Solution):
    """A law of the frequency with the motion that belongs to it.

    Its document is that of `lindstedt derive`, with the keys as attributes.

    >>> import numpy as np
    >>> import lindstedt as ls
    >>> law = ls.derive("duffing", order=2)
    >>> law.symbols
    ('A', 'eps')
    >>> law.omega(A=np.array([[0.5], [1.0]]), eps=np.linspace(0, 0.2, 3)).shape
    (2, 3)
    >>> x = law(np.linspace(0, 20, 2001), A=1.5, eps=0.1)
    >>> x.shape, float(x[0])
    ((2001,), 1.5)
    """

    @property
    def omega_squared(self) -> Polynomial:
        """The square of the angular frequency as a polynomial with exact coefficients.

        Raises:
            Refused: The law is no polynomial; `closed_form`, `relation` and the others have it.
        """
        if self.frequency_squared is None:
            raise Refused("omega^2 is no polynomial here: see `closed_form` and `frequency`", "law")
        return self.frequency_squared

    @property
    def convention(self) -> str:
        """What the amplitude measures: `initial` or `first-harmonic`."""
        return self.amplitude

    @property
    def symbols(self) -> tuple[str, ...]:
        """The arguments of `omega`, in their order; a word of Python has an underscore behind it."""
        code: CodeType = self.omega.__code__
        return code.co_varnames[: code.co_argcount]

    @cached_property
    def _functions(self) -> dict[str, Callable[..., Any]]:
        from ._compile import numpy_functions

        return numpy_functions(self.program("python"))

    @cached_property
    def omega(self) -> Any:
        """The angular frequency as a function of the symbols, in radians per unit of time.

        Numbers, lists and arrays that broadcast; NaN in an array where there is no frequency, for
        which a number is a `ValueError`.

        >>> import lindstedt as ls
        >>> ls.derive("pendulum").omega(A=[0.5, 1.0]).round(4)
        array([0.9844, 0.9378])
        """
        return self._function("angular_frequency", "frequency")

    @cached_property
    def _displacement(self) -> Any:
        return self._function("displacement", "motion")

    @cached_property
    def velocity(self) -> Any:
        """The velocity as a function of the time and the symbols."""
        return self._function("velocity", "motion")

    def _function(self, name: str, what: str) -> Callable[..., Any]:
        if name not in self._functions:
            raise Refused(f"the program of this law has no {what}", "law")
        return self._functions[name]

    def __call__(self, t: Any, *amounts: Any, **symbols: Any) -> Any:
        """Returns the displacement at the time t, the equilibrium included; everything broadcasts."""
        return self._displacement(t, *amounts, **symbols)

    def program(self, language: str = "python") -> str:
        """Returns the law as a program: `python`, `c`, `rust`, `julia` or `matlab`.

        Raises:
            Refused: The motion is not periodic, or only numbers solve the law.
        """
        if language not in LANGUAGES:
            raise ValueError(f"{language}: choose one of {', '.join(LANGUAGES)}")
        return self.call.form(language)

    def lambdify(
        self,
        target: str = "numpy",
        of: Literal["displacement", "omega", "velocity"] = "displacement",
    ) -> Any:
        """Returns a function of the law for a package, or its program for a language.

        Args:
            target: `numpy`, `numba` (a ufunc), `jax` (compiled, to be differentiated), `math`
                (numbers alone), or a language of `program`.
            of: The function: `displacement(t, symbols)`, `velocity(t, symbols)`, `omega(symbols)`.

        >>> import lindstedt as ls
        >>> law = ls.derive("pendulum")
        >>> law.lambdify("numpy", "omega")(A=[1.0]).round(4)
        array([0.9378])
        >>> "double angular_frequency(double A)" in law.lambdify("c")
        True
        """
        if target in LANGUAGES:
            return self.program(target)
        from . import _compile

        makers: dict[str, Callable[[str], dict[str, Any]]] = {
            "numpy": _compile.numpy_functions,
            "numba": _compile.numba_functions,
            "jax": _compile.jax_functions,
            "math": _compile.scalar_functions,
        }
        if target not in makers:
            known = ", ".join([*makers, *LANGUAGES])
            raise ValueError(f"{target}: choose one of {known}")
        names = {"omega": "angular_frequency"}
        found = makers[target](self.program("python"))
        if names.get(of, of) not in found:
            raise Refused(f"the program of this law has no {of}", "law")
        return found[names.get(of, of)]

    def _again(self, command: str, words: list[str]) -> Any:
        name, *rest = self.call.words
        rest = [word for word in rest if command == "derive" or word != "--steps"]
        return answer(Call((command, *words, *rest), self.call.input))

    def judge(
        self, tolerance: float = 0.01, at: Values | None = None, **values: Value
    ) -> Verification:
        """Judges the law by the true motion at these values.

        >>> import lindstedt as ls
        >>> verdict = ls.derive("pendulum").judge(A=1.5, tolerance=0.01)
        >>> verdict.passed, round(verdict.error, 6)
        (True, 0.000793)
        """
        words = [*option("tolerance", tolerance), *option("at", at), *option("at", values)]
        found: Verification | None = self._again("derive", words).verification
        if found is None:
            raise Refused("there is nothing to judge", "verification")
        return found

    def certify(self, at: Values | None = None, **options: Any) -> Any:
        """Proves the motion at these values, and how far the law is off; returns a `Certificate`.

        Options of `lindstedt.certify` are `range`, for amplitudes up to which the law is within the
        tolerance, `tolerance` and `no_formula`.
        """
        known = ("range", "no_formula", "tolerance")
        own = {key: options.pop(key) for key in known if key in options}
        words = [word for key, value in own.items() for word in option(key, value)]
        return self._again("certify", [*words, *option("at", at), *option("at", options)])

    @property
    def steps(self) -> tuple[str, ...]:
        """The derivation line by line."""
        if self.derivation is not None:
            return self.derivation
        found: tuple[str, ...] | None = self._again("derive", ["--steps"]).derivation
        return found or ()

    def to_sympy(self) -> Any:
        """Returns the law as a SymPy equation, `omega^2 = ...`, with exact coefficients.

        >>> import lindstedt as ls
        >>> print(ls.derive("pendulum", order=2).to_sympy())
        Eq(omega**2, 1 - A**2/8)
        """
        from .symbolic import law_to_sympy

        return law_to_sympy(self)

    def _repr_latex_(self) -> str:
        """The law and the motion."""
        return super()._repr_latex_() or ""

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        # A notebook prefers HTML, and typesets formulas in it.
        latex = self._repr_latex_()
        validity = "".join(f"<li>{line}</li>" for line in self.validity)
        page = f"<details><summary>page</summary>{self._repr_html_()}</details>"
        shown = f"<div>{latex}<ul>{validity}</ul>{page}</div>"
        return {"text/plain": str(self), "text/latex": latex, "text/html": shown}

    def plot(self, ax: Any = None, periods: float = 2.0, **values: float) -> Any:
        """Draws the displacement over the time on `ax`, and returns the axes.

        Raises:
            MissingPackage: matplotlib is not installed.
        """
        from .plots import axes, labelled

        numpy = optional("numpy", "a plot")
        ax = axes(ax)
        t = numpy.linspace(0.0, periods * 2 * numpy.pi / self.omega(**values), 400)
        at = ", ".join(f"{name} = {number(value)}" for name, value in values.items())
        ax.plot(t, self(t, **values), label=at or None)
        return labelled(ax, "t", "x", self.equation)
