"""Methods of polynomials and constants with exact coefficients."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .documents.common import Term


def power(symbol: str, exponent: int) -> str:
    """A power in the grammar of the program."""
    return symbol if exponent == 1 else f"{symbol}^{exponent}"


class ConstantMethods:
    """Methods of an exact constant."""

    exact: Fraction | str
    value: float | None

    def __float__(self) -> float:
        if self.value is None:
            raise ValueError(f"{self.exact} has no value as a double")
        return self.value

    def __str__(self) -> str:
        return str(self.exact)

    def to_sympy(self) -> Any:
        """Returns the constant as a SymPy expression."""
        from .symbolic import expression

        return expression(str(self.exact))


class PolynomialMethods:
    """Methods of a polynomial in the symbols of a law.

    >>> import lindstedt as ls
    >>> squared = ls.derive("x'' + x + eps*x^3 = 0", order=1).omega_squared
    >>> print(squared)
    1 + 3/4*A^2*eps
    >>> squared.coefficients
    {'1': Fraction(1, 1), 'A^2*eps': Fraction(3, 4)}
    >>> squared(A=2, eps=0.5)
    2.5
    """

    terms: tuple[Term, ...]

    @property
    def symbols(self) -> tuple[str, ...]:
        """The symbols of its terms, in alphabetical order."""
        return tuple(sorted({symbol for term in self.terms for symbol in term.monomial}))

    @property
    def coefficients(self) -> dict[str, Fraction]:
        """The exact coefficient of each monomial, by the monomial in words: `1`, `A^2*eps`."""
        return {self.monomial(term): term.exact for term in self.terms}

    @staticmethod
    def monomial(term: Term) -> str:
        """The monomial of a term in words."""
        return "*".join(power(*factor) for factor in term.monomial.items()) or "1"

    def __call__(self, **values: Any) -> Any:
        """Returns the value at these values of the symbols, numbers or arrays that broadcast.

        Raises:
            TypeError: A symbol has no value.
        """
        missing = [symbol for symbol in self.symbols if symbol not in values]
        if missing:
            raise TypeError(f"no value for {', '.join(missing)}")
        total: Any = 0.0
        for term in self.terms:
            product: Any = float(term.exact)
            for symbol, exponent in term.monomial.items():
                product = product * values[symbol] ** exponent
            total = total + product
        return total

    def __str__(self) -> str:
        text = ""
        for term in self.terms:
            monomial, size = self.monomial(term), abs(term.exact)
            factor = str(size) if monomial == "1" else monomial
            if size != 1 and monomial != "1":
                factor = f"{size}*{monomial}"
            sign = "-" if term.exact < 0 else "+"
            text += f" {sign} {factor}" if text else ("-" if sign == "-" else "") + factor
        return text or "0"

    def to_sympy(self) -> Any:
        """Returns the polynomial as a SymPy expression with exact coefficients."""
        from .symbolic import expression

        return expression(str(self))

    def _repr_latex_(self) -> str:
        from .symbolic import latex_of

        return f"${latex_of(self.to_sympy())}$"


class VerificationMethods:
    """Methods of a verdict."""

    verdict: str
    relative_error: float | None

    @property
    def passed(self) -> bool:
        """Whether the formula is within the tolerance."""
        return self.verdict == "pass"

    @property
    def error(self) -> float | None:
        """The relative error of the frequency, signed."""
        return self.relative_error
