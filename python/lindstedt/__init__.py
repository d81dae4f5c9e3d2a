"""Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true
motion: the program `lindstedt`, in process.

An equation goes in as text; out come a frequency-amplitude law with exact coefficients, the motion
as a Fourier series, and a verdict against the original equation.

>>> import lindstedt as ls
>>> pendulum = ls.Oscillator("x'' + sin(x) = 0")
>>> law = pendulum.derive(order=4)
>>> law.omega_squared.coefficients["A^2"]
Fraction(-1, 8)
>>> round(law.omega(A=1.5), 6)
0.86129
>>> law.judge(A=1.5).passed
True

Every command of the program is a function with its options as keywords; what it takes is in its
help. Values of symbols are keywords too: `law.judge(A="3/2")`, exact where they are text or a
`fractions.Fraction`. Results are frozen dataclasses with the keys of the program's JSON documents
(`lindstedt.documents`). Packages for arrays, tables and pictures are imported when they are used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .catalogue import catalog as catalog
    from .commands import absorber as absorber
    from .commands import audit as audit
    from .commands import certify as certify
    from .commands import check as check
    from .commands import compare as compare
    from .commands import derive as derive
    from .commands import friction as friction
    from .commands import impact as impact
    from .commands import lagrange as lagrange
    from .commands import materials as materials
    from .commands import optimize as optimize
    from .commands import orbits as orbits
    from .commands import paper as paper
    from .commands import response as response
    from .commands import shortest as shortest
    from .measurements import Fit as Fit
    from .measurements import fit as fit
    from .commands import simulate as simulate
    from .commands import stability as stability
    from .errors import InternalError as InternalError
    from .errors import LindstedtError as LindstedtError
    from .errors import LostPoints as LostPoints
    from .errors import MissingPackage as MissingPackage
    from .errors import Refused as Refused
    from .errors import TimeLimit as TimeLimit
    from .errors import UsageError as UsageError
    from .oscillator import Oscillator as Oscillator
    from .law import Law as Law
    from .normal_modes import Modes as Modes
    from .normal_modes import modes as modes
    from .slow import SlowEquations as SlowEquations
    from .slow import slow_equations as slow_equations
    from .studies import Study as Study
    from .studies import collect as collect
    from .studies import missing_shards as missing_shards
    from .symbolic import from_sympy as from_sympy

#: The module of each name, which is imported when the name is used.
PLACES = {
    "catalog": "catalogue",
    "Law": "law",
    **dict.fromkeys(("Modes", "modes"), "normal_modes"),
    **dict.fromkeys(("SlowEquations", "slow_equations"), "slow"),
    **dict.fromkeys(("Fit", "fit"), "measurements"),
    "Oscillator": "oscillator",
    "from_sympy": "symbolic",
    **dict.fromkeys(("Study", "collect", "missing_shards"), "studies"),
    **dict.fromkeys(
        (
            "InternalError", "LindstedtError", "LostPoints", "MissingPackage", "Refused",
            "TimeLimit", "UsageError",
        ),
        "errors",
    ),
    **dict.fromkeys(
        (
            "absorber", "audit", "certify", "check", "compare", "derive", "friction", "impact",
            "lagrange", "materials", "optimize", "orbits", "paper", "response", "shortest",
            "simulate", "stability",
        ),
        "commands",
    ),
}

__all__ = sorted(PLACES)


def __getattr__(name: str) -> Any:
    if name not in PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f".{PLACES[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *PLACES})
