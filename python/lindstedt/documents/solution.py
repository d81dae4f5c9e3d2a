"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .common import Constant, Convergence, Displacement, LimitCycle, Modulation, Polynomial, Response, System, Verification


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Answer):
    """A formula for the frequency and the motion of an oscillator. Of the laws of the frequency take
    the first that is not null: `frequency_squared`, `relation`, `closed_form`, `frequency`,
    `by_quadrature`, `system`; that is the one that is judged.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion as it was understood, `... = 0`; time is its own, so
            frequencies are in radians per unit of it.
        method: The method that derived it, by its name on the command line.
        order: The highest power kept of the small parameter, inclusive; for a balance the number
            of harmonics, for iterations the passes.
        degrees: The degrees of an approximant, of numerator and denominator or of P, Q and R;
            null for every other method.
        small_parameter: The symbol in which the expansion runs: a parameter, or the symbol of the
            amplitude.
        amplitude: What the amplitude measures: `initial` is `A` = x(0) minus the equilibrium with
            x'(0) = 0, `first-harmonic` is `a`, the amplitude of the first harmonic. It has the
            unit of the coordinate.
        parameters: The parameters of the equation, in alphabetical order.
        definitions: Symbols that the program introduced, each with the expression that it stands
            for, which may use those before it; their values are in `verification.values`.
        equilibrium: The equilibrium about which the motion swings, in the unit of the coordinate;
            its value is null where it has symbols.
        frequency: omega, the angular frequency, as a polynomial; null where the method gives
            none. Where `frequency_squared` or `relation` stands beside it, those are judged, not
            this one.
        frequency_squared: omega^2 as a polynomial; null where the method gives none. It is judged
            before `frequency`, of which it is no exact square.
        relation: A polynomial in even powers of `omega` that is zero: omega is its root that
            continues the linear frequency from amplitude zero; null where the law is explicit.
        closed_form: The law as text where it is no polynomial, `omega^2 = ...` or `omega = ...`;
            null otherwise. K is the complete elliptic integral of the first kind of the parameter
            m = k^2, not of the modulus k; J0, J1, I0, I1 are Bessel functions.
        by_quadrature: The law as text where only numbers solve it: integrals, separated by `; `;
            null otherwise.
        system: The equations of a balance of several harmonics, which only numbers solve; null
            otherwise.
        displacement: The motion x(t), the equilibrium included: add nothing to it.
        closed_motion: The motion x(t) from rest at the amplitude as text, the equilibrium
            included, where it is known in closed form: an expression in `t`, the amplitude, the
            parameters and the definitions. sn(u, m), cn(u, m) and dn(u, m) are the elliptic
            functions of Jacobi of the parameter m = k^2, not of the modulus k. Left out for any
            other.
        limit_cycle: The limit cycle of a self-excited equation, whose amplitude the equation
            determines; null for any other.
        modulation: The slow equations of amplitude and phase of a motion that is not periodic;
            null for any other.
        response: The steady motions of a driven equation; null for any other. `frequency` is then
            the backbone, the frequency of the motion itself without damping and drive, and
            `displacement` its leading term: the whole motion is `response.motion`.
        numerical: Whether coefficients are rounded to fifteen digits, because the equilibrium is
            no fraction.
        validity: What is known of where the formula holds, in words.
        convergence: How far the series of omega^2 converges, by its own coefficients; left out
            where they are too few or show no law.
        derivation: The derivation line by line, as text; left out where it was not asked for.
        verification: The verdict at given values; null where none were given.
    """

    schema: Literal["lindstedt/solution/1"]
    equation: str
    method: Literal["lindstedt-poincare", "homotopy-perturbation", "homotopy-analysis", "iteration-perturbation", "parameter-expansion", "harmonic-balance", "energy-balance", "max-min", "amplitude-frequency", "hamiltonian", "variational-iteration", "frequency-formula", "averaging", "pade", "hermite-pade", "multiple-scales", "exact"]
    order: int
    degrees: tuple[int, ...] | None
    small_parameter: str
    amplitude: Literal["initial", "first-harmonic"]
    parameters: tuple[str, ...]
    definitions: dict[str, str]
    equilibrium: Constant
    frequency: Polynomial | None
    frequency_squared: Polynomial | None
    relation: Polynomial | None
    closed_form: str | None
    by_quadrature: str | None
    system: System | None
    displacement: Displacement
    closed_motion: str | None
    limit_cycle: LimitCycle | None
    modulation: Modulation | None
    response: Response | None
    numerical: bool
    validity: tuple[str, ...]
    convergence: Convergence | None
    derivation: tuple[str, ...] | None
    verification: Verification | None


Solution.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("method", "method", None),
    ("order", "order", None),
    ("degrees", "degrees", tuple),
    ("small_parameter", "small_parameter", None),
    ("amplitude", "amplitude", None),
    ("parameters", "parameters", tuple),
    ("definitions", "definitions", dict),
    ("equilibrium", "equilibrium", Constant.from_json),
    ("frequency", "frequency", Polynomial.from_json),
    ("frequency_squared", "frequency_squared", Polynomial.from_json),
    ("relation", "relation", Polynomial.from_json),
    ("closed_form", "closed_form", None),
    ("by_quadrature", "by_quadrature", None),
    ("system", "system", System.from_json),
    ("displacement", "displacement", Displacement.from_json),
    ("closed_motion", "closed_motion", None),
    ("limit_cycle", "limit_cycle", LimitCycle.from_json),
    ("modulation", "modulation", Modulation.from_json),
    ("response", "response", Response.from_json),
    ("numerical", "numerical", None),
    ("validity", "validity", tuple),
    ("convergence", "convergence", Convergence.from_json),
    ("derivation", "derivation", tuple),
    ("verification", "verification", Verification.from_json),
)
Solution.OPTIONAL = frozenset(['closed_motion', 'convergence', 'derivation'])
