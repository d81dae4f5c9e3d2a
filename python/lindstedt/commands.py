"""The commands of the program as functions. Made by `python/generate.py` from its help."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from ._call import Problem, Progress, Value, Values, ask

if TYPE_CHECKING:
    from .audits import Audit
    from .branches import Response
    from .certificates import Certificate
    from .comparison import Comparison
    from .designs import Optimization
    from .documents.absorber import Absorber
    from .documents.certificate import CoupledCertificateDocument
    from .documents.certificate import DampedCertificateDocument
    from .documents.certificate import LawCertificateDocument
    from .documents.certificate import ModeCertificateDocument
    from .documents.certificate import OrbitCertificateDocument
    from .documents.certificate_range import CertificateRange
    from .documents.impact_certificate import ImpactCertificate
    from .documents.impact_comparison import ImpactComparison
    from .documents.lagrangian import Lagrangian
    from .documents.orbits import Orbits
    from .impacts import Impact
    from .law import Law
    from .laws import Shortest
    from .measurements import Fit
    from .motions import Motion, MotionSweep, Primary, PrimarySweep, Simulation, Sweep
    from .normal_modes import Modes
    from .slow import SlowEquations
    from .tabulated import Friction, Materials, Stability


def derive(
    problem: Problem,
    method: str | None = None,
    *,
    contact: Sequence[str] | None = None,
    order: int | tuple[int, ...] | str | None = None,
    amplitude: Literal["initial", "first-harmonic"] | None = None,
    small: str | None = None,
    about: Values | None = None,
    taylor: int | None = None,
    hbar: Value | None = None,
    cycle: int | None = None,
    resonance: tuple[int, int] | str | None = None,
    omega_only: bool = False,
    jobs: int | None = None,
    steps: bool = False,
    mode: int | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Law:
    """Derive the frequency law and the motion of an oscillator, to an order.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        method: How to derive: lindstedt-poincare, homotopy-perturbation, homotopy-analysis,
            iteration-perturbation, parameter-expansion, harmonic-balance, energy-balance, max-min,
            amplitude-frequency, hamiltonian, variational-iteration, frequency-formula, averaging,
            pade, hermite-pade, multiple-scales or exact.
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        order: Highest power of the small parameter kept, inclusive; harmonics of harmonic-
            balance; degrees L,M of pade, P,Q,R of hermite-pade.
        amplitude: What the amplitude measures.
        small: The small parameter; A for the amplitude.
        about: The equilibrium to swing about, x=1 say: a stable one, without this the nearest
            to zero, or an unstable one between two wells for motions over both.
        taylor: Degree of the Taylor polynomial that homotopy perturbation puts for the force.
        hbar: The convergence-control parameter of homotopy-analysis, exact; without it the best
            one is chosen at the values.
        cycle: Which limit cycle of a self-excited equation, counted from 1 by amplitude;
            without it the smallest that attracts.
        resonance: Which resonance: of a driven equation Omega:omega0, 1:3 say, without it the
            one nearest to the values, or 1:1; of coupled equations relations between frequencies,
            "omega2 = 2*omega1, Omega = omega2", or none, without it those that the numbers are
            near.
        omega_only: The frequency without the motion, of lindstedt-poincare: orders up to 2000,
            in less time.
        jobs: Threads of a long expansion; all cores without it. The result is the same for any
            number.
        steps: Whether the derivation is kept, line by line.
        mode: Which normal mode of coupled equations, 1 for the slowest; without it all of them.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("derive", problem, {"method": method, "contact": contact, "order": order, "amplitude": amplitude, "small": small, "about": about, "taylor": taylor, "hbar": hbar, "cycle": cycle, "resonance": resonance, "omega_only": omega_only, "jobs": jobs, "steps": steps, "mode": mode, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def compare(
    problem: Problem,
    *,
    contact: Sequence[str] | None = None,
    small: str | None = None,
    about: Values | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Comparison:
    """Every method of the field on one equation, in one table, judged against the true motion.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        small: The small parameter; A for the amplitude.
        about: The equilibrium to swing about, x=1 say: a stable one, without this the nearest
            to zero, or an unstable one between two wells for motions over both.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("compare", problem, {"contact": contact, "small": small, "about": about, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def impact(
    problem: Problem | None = None,
    method: str | None = None,
    *,
    order: int | tuple[int, ...] | str | None = None,
    amplitude: str | None = None,
    force: str | None = None,
    contact: str | None = None,
    left: bool = False,
    compare: bool = False,
    certify: bool = False,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Impact | ImpactCertificate | ImpactComparison:
    """The three phases of a pendulum that hits an elastic barrier, in closed form, checked by Runge-Kutta.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        method: How the swing of the derived phases is derived, by a method of `lindstedt
            derive`; without it the first that passes.
        order: The order of the law; without it 2 for the paper's reading, for the derived
            phases the lowest that passes.
        amplitude: What the amplitude of the derived law measures: initial or first-harmonic.
        force: The whole force of the barrier in the depth d, such as "k*d^2"; without it
            gamma*d^(3/2).
        contact: The law of the contact in the derived phases, such as power-law; without it
            exact; all for a table of every law; or one that loses energy ("kelvin-voigt
            restitution=0.8", hunt-crossley, kelvin-voigt-no-pull), "all restitution=0.8" for a
            table of those.
        left: The barrier is on the left of xc, and the release at x = A.
        compare: Every method in one table, each at its lowest order that passes.
        certify: Prove the numbers of the impact of a pendulum and a barrier whose force is a
            power of the depth or a sum of them, with a loss by Hunt and Crossley or in a dashpot,
            and how far each closed form is off.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("impact", problem, {"method": method, "order": order, "amplitude": amplitude, "force": force, "contact": contact, "left": left, "compare": compare, "certify": certify, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def simulate(
    problem: Problem | None = None,
    *,
    from_: Values | None = None,
    until: float | None = None,
    step_limit: int | None = None,
    wall: Sequence[str] | None = None,
    restitution: Sequence[str] | None = None,
    event: Sequence[str] | None = None,
    static_friction: Value | None = None,
    contact: Sequence[str] | None = None,
    every: Value | None = None,
    section: str | None = None,
    after: float | None = None,
    sample: Sequence[float] | None = None,
    lyapunov: bool = False,
    integrator: Literal["taylor", "runge-kutta", "both"] | None = None,
    chain: bool = False,
    sweep: Values | None = None,
    baseline: bool = False,
    jobs: int | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Simulation | Sweep | Motion | MotionSweep | Primary | PrimarySweep:
    """The paper's equation (7) in full, event by event: trajectory, impacts, energy, rest time; or any equation or mechanism.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        from_: Where an equation or a mechanism of one's own begins (x=1.5,v=0; "a=1,b'=2"):
            what is left out is 0.
        until: How long it is followed; 50 without it.
        step_limit: Steps of the integrator after which it ends; 250 000 without it.
        wall: A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d", "-1
            < x < 1"); repeatable.
        restitution: The speed after an impact over that before, between 0 and 1: one for all
            walls, or one for each.
        event: An event: where a condition comes true, states are set ("x < 0: x' = -0.8*x'",
            "sin(w*t) > 0: x' = x' + p; y = 0"); = in place of < or > counts in both directions;
            repeatable.
        static_friction: Static over sliding friction, 1 or more: what dry friction, mu*sgn(x'),
            holds, it holds up to so many times the force with which it slides (1.5, mus/muk).
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        every: Look at an equation or a mechanism of one's own once in this time (Poincaré's
            section): 2*pi/Omega.
        section: Look at it where an expression of its coordinates, velocities and the time
            grows through zero: x', "x - 0.1"; or just before each impact on a wall: impacts; or
            each event: events.
        after: Look at it from this time on, when it has settled.
        sample: Report the state at this time (repeatable).
        lyapunov: Give the largest Lyapunov exponent of an equation or a mechanism of one's own,
            with its standard error; without it where six digits are lost on the way.
        integrator: The method: power series with the contact in a variable in which it is
            analytic; Runge-Kutta, one smooth phase at a time; or both, and how far they differ.
        chain: Do not integrate: swing and contact in closed form, impact after impact to rest,
            each with its formula, and its error against the integration; with [primary] main mass
            and pendulum together; a sweep is not judged.
        sweep: Follow many motions: a parameter over a range by equal steps, by equal ratios
            (from:to:count:log), or at the values of a list (NAME=a,b,c); repeated, over every
            combination.
        baseline: In a sweep: beside each rest time those without a barrier and with one that
            loses nothing.
        jobs: Threads of a sweep; all cores without it. The result is the same for any number.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("simulate", problem, {"from_": from_, "until": until, "step_limit": step_limit, "wall": wall, "restitution": restitution, "event": event, "static_friction": static_friction, "contact": contact, "every": every, "section": section, "after": after, "sample": sample, "lyapunov": lyapunov, "integrator": integrator, "chain": chain, "sweep": sweep, "baseline": baseline, "jobs": jobs, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def response(
    problem: Problem,
    method: str | None = None,
    *,
    vary: Values | None = None,
    along: Values | None = None,
    of: str | None = None,
    order: int | None = None,
    periods: int | None = None,
    wall: Sequence[str] | None = None,
    restitution: Sequence[str] | None = None,
    event: Sequence[str] | None = None,
    contact: Sequence[str] | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Response:
    """Steady states of driven, self-excited or free oscillators, of one coordinate or coupled: every branch with its stability, folds, period doublings, backbone.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        method: harmonic-balance; or multiple-scales or averaging, their steady motions beside
            the branches of harmonic balance, which judge them.
        vary: The parameter that varies, and from where to where: Omega=0.5:1.5.
        along: A second parameter, and from where to where: bifurcations are followed in both,
            and stable motions counted.
        of: The quantity that is listed and drawn: a coordinate, or an expression in them such
            as x - y; the first coordinate without it.
        order: The highest harmonic kept; without it as many as bring the error below a tenth of
            the tolerance, 64 at most; of multiple-scales its order.
        periods: Periods of the drive in a period of the motion: 2 for motions after a period
            doubling, 3 for a third of the frequency.
        wall: A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d", "-1
            < x < 1"); repeatable.
        restitution: The speed after an impact over that before, between 0 and 1: one for all
            walls, or one for each.
        event: An event: where a condition comes true, states are set ("x < 0: x' = -0.8*x'",
            "sin(w*t) > 0: x' = x' + p; y = 0"); = in place of < or > counts in both directions;
            repeatable.
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("response", problem, {"method": method, "vary": vary, "along": along, "of": of, "order": order, "periods": periods, "wall": wall, "restitution": restitution, "event": event, "contact": contact, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def absorber(
    kind: Literal["tuned", "damped", "nonlinear", "impact-sink", "pendulum-sink", "cubic-sink"],
    *,
    excitation: Literal["force", "ground"] | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Absorber:
    """Design formulas of a vibration absorber: tuning and damping of a tuned mass damper, its cubic spring where the main mass has one, thresholds of a ball in a cavity, of a pendulum between barriers and of a light mass on a cubic spring.

    Args:
        kind: The kind of absorber: a tuned mass damper; the same on a damped main mass; a
            nonlinear one, with a cubic spring beside that of the main mass; a vibro-impact sink, a
            ball in a cavity or a pendulum between barriers; a light mass on a cubic spring.
        excitation: What shakes the main mass of a tuned mass damper: a force on it, or the
            ground; force without it.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("absorber", kind, {"excitation": excitation, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def orbits(
    problem: Problem,
    *,
    wall: Sequence[str] | None = None,
    restitution: Sequence[str] | None = None,
    impacts: int | None = None,
    periods: int | str | None = None,
    vary: Values | None = None,
    along: Values | None = None,
    certify: bool = False,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Orbits | OrbitCertificateDocument:
    """Periodic motions of a linear driven oscillator that hits rigid walls: speed, phase and stability in closed form, each orbit beside a simulation; charts over two parameters.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        wall: A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d", "-1
            < x < 1"); repeatable.
        restitution: The speed after an impact over that before, between 0 and 1: one for all
            walls, or one for each.
        impacts: Impacts in a period of the orbit: 1 in closed form, with symmetric orbits
            between two walls; more by a search.
        periods: Periods of the drive in a period of the orbit, one number or from N to M; 1:3
            without it.
        vary: A parameter, and from where to where: impact speeds along it (F=0.05:1.5).
        along: A second parameter, and from where to where: a chart of where orbits exist and
            are stable.
        certify: Prove each orbit: that there is exactly one near its numbers, that it touches
            no wall between its impacts, and whether it is stable; FILE.json of --output is a
            certificate that `check` reads.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("orbits", problem, {"wall": wall, "restitution": restitution, "impacts": impacts, "periods": periods, "vary": vary, "along": along, "certify": certify, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def shortest(
    problem: Problem,
    *,
    contact: Sequence[str] | None = None,
    range: Values | None = None,
    error: float | None = None,
    quantity: Literal["omega", "omega^2", "T", "contact-time"] | None = None,
    about: Values | None = None,
    mode: int | None = None,
    amplitude: Literal["initial", "first-harmonic"] | None = None,
    atom: Sequence[str] | None = None,
    longest: int | None = None,
    exact_at_rest: int | None = None,
    growth: str | None = None,
    certificate: bool = False,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Shortest | LawCertificateDocument:
    """The shortest frequency law within an error on a whole range, with a proof of the bound, and the front of length against error.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        range: What varies, and from where to where: the amplitude (A=0:2.8), a parameter
            (mu=0:10), or a product on which the frequency alone depends (eps*A^2=0:inf).
        error: The largest relative error that is allowed, 0.001 say; without it the whole
            front.
        quantity: The law's quantity: omega, omega^2, T, the period over 2 pi, or contact-time,
            the duration of a contact x'' + k*x^n*(1 + c*x') = 0 over that without damping.
        about: The equilibrium to swing about, x=1 say, from which the amplitude is measured.
        mode: The normal mode of coupled equations, 1 for the slowest.
        amplitude: The measure of a mode's amplitude.
        atom: A quantity of which laws are made, counted as one symbol, such as cos(A/2);
            repeatable, those of the equation without it.
        longest: The greatest length of a law in symbols.
        exact_at_rest: Keep the law exact at rest: its series is that of the true frequency up
            to this power of the variable, 0 for the frequency at rest alone.
        growth: Keep laws that grow as this power of the variable towards infinity, 1/2 say,
            whatever the range.
        certificate: With JSON: the certificate of the law, which `check` reads, in place of the
            laws.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("shortest", problem, {"contact": contact, "range": range, "error": error, "quantity": quantity, "about": about, "mode": mode, "amplitude": amplitude, "atom": atom, "longest": longest, "exact_at_rest": exact_at_rest, "growth": growth, "certificate": certificate, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def friction(
    *,
    alpha: float | None = None,
    amplitude: float | None = None,
    speed: Sequence[float] | None = None,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Friction:
    """The arctangent in place of Coulomb's sgn: the paper's Table 1, and what it does to a swing near rest.

    Args:
        alpha: The friction alpha, between 0 and 1; 0.05 without it, for the paper prints none.
        amplitude: The swing is released from rest at x = -A; 1.5 without it, as in the paper.
        speed: Compare the two laws at this speed too, in units of omega (repeatable).
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("friction", None, {"alpha": alpha, "amplitude": amplitude, "speed": speed, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


def lagrange(
    problem: Problem | None = None,
    *,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Lagrangian:
    """Energies and forces to equations of motion, units checked, dimensionless groups, places of rest and modes.

    Args:
        problem: The path of a file, or the tables of a problem file.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("lagrange", problem, {"timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def materials(
    problem: Problem | None = None,
    *,
    only_own: bool = False,
    chain: bool = False,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Materials:
    """The same swing against barriers of several materials: contact, rest time, and what is held fixed.

    Args:
        problem: The path of a file, or the tables of a problem file.
        only_own: Only the materials of the file, without those of the paper's Table 2.
        chain: Do not integrate: every motion as a chain of closed forms, good to a percent
            where damping is light and dry friction alpha no more than 0.02 of the amplitude.
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("materials", problem, {"only_own": only_own, "chain": chain, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


def optimize(
    problem: Problem | None = None,
    *,
    seed: int | None = None,
    runs: int | None = None,
    jobs: int | None = None,
    budget: int | str | None = None,
    record: str | os.PathLike[str] | None = None,
    resume: str | os.PathLike[str] | None = None,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Optimization:
    """The design that rests soonest: the paper's genetic algorithm, what decides the optimum, fronts of several wishes.

    Args:
        problem: The path of a file, or the tables of a problem file.
        seed: Seed of all random numbers, in place of that of the file.
        runs: How often to run the search, in place of the number in the file.
        jobs: Threads; all cores without it. The result is the same for any number.
        budget: Stop after so many evaluations, shared evenly by the runs, or after so many
            seconds (30s) with the runs that are done.
        record: Write every run to this file as soon as it is done, a line of JSON each.
        resume: Take the runs of this record over, do the missing ones, and add them to it: the
            result is the same as in one go.
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("optimize", problem, {"seed": seed, "runs": runs, "jobs": jobs, "budget": budget, "record": record, "resume": resume, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


def stability(
    problem: Problem,
    *,
    order: int | tuple[int, ...] | str | None = None,
    tongues: int | None = None,
    for_: str | None = None,
    small: Sequence[str] | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Stability:
    """Transition curves of a linear equation with periodic coefficients, such as Mathieu's: where rest is stable.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        order: Highest power of the small parameters, all together, that is kept; 6 without it.
        tongues: The tongues 0 to N; 3 without it.
        for_: What the curves give: a letter of the mean stiffness, or the frequency.
        small: A small parameter (repeatable); without it eps, and letters that alone stand
            before a wave or the velocity.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("stability", problem, {"order": order, "tongues": tongues, "for_": for_, "small": small, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def audit(
    problem: Problem,
    *,
    strict: bool = False,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Audit:
    """Claims of a publication from a file, each computed again, with a verdict.

    Args:
        problem: The path of a file, or the tables of a problem file.
        strict: Whether a claim that is not reproduced fails also where the file expects so.
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("audit", problem, {"strict": strict, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


def paper(
    *,
    strict: bool = False,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Audit:
    """Every number, equation, table and figure of the paper, computed again, with a verdict.

    Args:
        strict: Whether a claim that is not reproduced fails also where the file expects so.
        timeout: Give up after so many seconds.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("paper", None, {"strict": strict, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


def certify(
    problem: Problem,
    method: str | None = None,
    *,
    contact: Sequence[str] | None = None,
    order: int | tuple[int, ...] | str | None = None,
    amplitude: Literal["initial", "first-harmonic"] | None = None,
    small: str | None = None,
    about: Values | None = None,
    taylor: int | None = None,
    hbar: Value | None = None,
    cycle: int | None = None,
    resonance: tuple[int, int] | str | None = None,
    omega_only: bool = False,
    jobs: int | None = None,
    range: tuple[Value, Value] | str | None = None,
    no_formula: bool = False,
    mode: int | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value,
) -> Certificate | DampedCertificateDocument | ModeCertificateDocument | CoupledCertificateDocument | CertificateRange:
    """A proof beside a formula: the motion exists, and how far the formula is off, from both sides.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem
            file, or the tables of one.
        method: How to derive: lindstedt-poincare, homotopy-perturbation, homotopy-analysis,
            iteration-perturbation, parameter-expansion, harmonic-balance, energy-balance, max-min,
            amplitude-frequency, hamiltonian, variational-iteration, frequency-formula, averaging,
            pade, hermite-pade, multiple-scales or exact.
        contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-
            voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
            repeatable.
        order: Highest power of the small parameter kept, inclusive; harmonics of harmonic-
            balance; degrees L,M of pade, P,Q,R of hermite-pade.
        amplitude: What the amplitude measures.
        small: The small parameter; A for the amplitude.
        about: The equilibrium to swing about, x=1 say: a stable one, without this the nearest
            to zero, or an unstable one between two wells for motions over both.
        taylor: Degree of the Taylor polynomial that homotopy perturbation puts for the force.
        hbar: The convergence-control parameter of homotopy-analysis, exact; without it the best
            one is chosen at the values.
        cycle: Which limit cycle of a self-excited equation, counted from 1 by amplitude;
            without it the smallest that attracts.
        resonance: Which resonance: of a driven equation Omega:omega0, 1:3 say, without it the
            one nearest to the values, or 1:1; of coupled equations relations between frequencies,
            "omega2 = 2*omega1, Omega = omega2", or none, without it those that the numbers are
            near.
        omega_only: The frequency without the motion, of lindstedt-poincare: orders up to 2000,
            in less time.
        jobs: Threads of a long expansion; all cores without it. The result is the same for any
            number.
        range: Positive amplitudes, 1/10:3 say: how far from the first of them on the formula is
            proved to be within the tolerance, for every amplitude.
        no_formula: Prove the motion alone, and judge no formula: where that has no real value,
            say.
        mode: Which normal mode of coupled equations, 1 for the slowest and without this.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words, `{"small": 1}`.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols, exact where they are text or fractions.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("certify", problem, {"method": method, "contact": contact, "order": order, "amplitude": amplitude, "small": small, "about": about, "taylor": taylor, "hbar": hbar, "cycle": cycle, "resonance": resonance, "omega_only": omega_only, "jobs": jobs, "range": range, "no_formula": no_formula, "mode": mode, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]


def check(
    problem: Problem,
    *,
    tolerance: float | None = None,
    timeout: float | None = None,
    progress: Progress | None = None,
) -> Certificate | DampedCertificateDocument | ModeCertificateDocument | CoupledCertificateDocument | LawCertificateDocument | OrbitCertificateDocument:
    """Check a certificate that `certify` wrote, in exact arithmetic.

    Args:
        problem: The path of a file, or the tables of a problem file.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds, 60 without it: a certificate may come from
            anybody.
        progress: Is called with the parts done and all of them; an exception ends the work.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: An option has a value that it cannot have.
    """
    return ask("check", problem, {"tolerance": tolerance, "timeout": timeout}, {}, progress)  # type: ignore[no-any-return]


class EquationCommands:
    """The commands of an equation as methods."""

    problem: Problem

    def derive(
        self,
        method: str | None = None,
        *,
        contact: Sequence[str] | None = None,
        order: int | tuple[int, ...] | str | None = None,
        amplitude: Literal["initial", "first-harmonic"] | None = None,
        small: str | None = None,
        about: Values | None = None,
        taylor: int | None = None,
        hbar: Value | None = None,
        cycle: int | None = None,
        resonance: tuple[int, int] | str | None = None,
        omega_only: bool = False,
        jobs: int | None = None,
        steps: bool = False,
        mode: int | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Law:
        """Derive the frequency law and the motion of an oscillator, to an order.

        Args:
            method: How to derive: lindstedt-poincare, homotopy-perturbation, homotopy-analysis,
                iteration-perturbation, parameter-expansion, harmonic-balance, energy-balance, max-
                min, amplitude-frequency, hamiltonian, variational-iteration, frequency-formula,
                averaging, pade, hermite-pade, multiple-scales or exact.
            contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt,
                kelvin-voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
                repeatable.
            order: Highest power of the small parameter kept, inclusive; harmonics of harmonic-
                balance; degrees L,M of pade, P,Q,R of hermite-pade.
            amplitude: What the amplitude measures.
            small: The small parameter; A for the amplitude.
            about: The equilibrium to swing about, x=1 say: a stable one, without this the
                nearest to zero, or an unstable one between two wells for motions over both.
            taylor: Degree of the Taylor polynomial that homotopy perturbation puts for the
                force.
            hbar: The convergence-control parameter of homotopy-analysis, exact; without it the
                best one is chosen at the values.
            cycle: Which limit cycle of a self-excited equation, counted from 1 by amplitude;
                without it the smallest that attracts.
            resonance: Which resonance: of a driven equation Omega:omega0, 1:3 say, without it
                the one nearest to the values, or 1:1; of coupled equations relations between
                frequencies, "omega2 = 2*omega1, Omega = omega2", or none, without it those that the
                numbers are near.
            omega_only: The frequency without the motion, of lindstedt-poincare: orders up to
                2000, in less time.
            jobs: Threads of a long expansion; all cores without it. The result is the same for
                any number.
            steps: Whether the derivation is kept, line by line.
            mode: Which normal mode of coupled equations, 1 for the slowest; without it all of
                them.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("derive", self.problem, {"method": method, "contact": contact, "order": order, "amplitude": amplitude, "small": small, "about": about, "taylor": taylor, "hbar": hbar, "cycle": cycle, "resonance": resonance, "omega_only": omega_only, "jobs": jobs, "steps": steps, "mode": mode, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]

    def compare(
        self,
        *,
        contact: Sequence[str] | None = None,
        small: str | None = None,
        about: Values | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Comparison:
        """Every method of the field on one equation, in one table, judged against the true motion.

        Args:
            contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt,
                kelvin-voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
                repeatable.
            small: The small parameter; A for the amplitude.
            about: The equilibrium to swing about, x=1 say: a stable one, without this the
                nearest to zero, or an unstable one between two wells for motions over both.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("compare", self.problem, {"contact": contact, "small": small, "about": about, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]

    def simulate(
        self,
        *,
        from_: Values | None = None,
        until: float | None = None,
        step_limit: int | None = None,
        wall: Sequence[str] | None = None,
        restitution: Sequence[str] | None = None,
        event: Sequence[str] | None = None,
        static_friction: Value | None = None,
        contact: Sequence[str] | None = None,
        every: Value | None = None,
        section: str | None = None,
        after: float | None = None,
        sample: Sequence[float] | None = None,
        lyapunov: bool = False,
        integrator: Literal["taylor", "runge-kutta", "both"] | None = None,
        chain: bool = False,
        sweep: Values | None = None,
        baseline: bool = False,
        jobs: int | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Simulation | Sweep | Motion | MotionSweep | Primary | PrimarySweep:
        """The paper's equation (7) in full, event by event: trajectory, impacts, energy, rest time; or any equation or mechanism.

        Args:
            from_: Where an equation or a mechanism of one's own begins (x=1.5,v=0; "a=1,b'=2"):
                what is left out is 0.
            until: How long it is followed; 50 without it.
            step_limit: Steps of the integrator after which it ends; 250 000 without it.
            wall: A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d",
                "-1 < x < 1"); repeatable.
            restitution: The speed after an impact over that before, between 0 and 1: one for
                all walls, or one for each.
            event: An event: where a condition comes true, states are set ("x < 0: x' =
                -0.8*x'", "sin(w*t) > 0: x' = x' + p; y = 0"); = in place of < or > counts in both
                directions; repeatable.
            static_friction: Static over sliding friction, 1 or more: what dry friction,
                mu*sgn(x'), holds, it holds up to so many times the force with which it slides (1.5,
                mus/muk).
            contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt,
                kelvin-voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
                repeatable.
            every: Look at an equation or a mechanism of one's own once in this time (Poincaré's
                section): 2*pi/Omega.
            section: Look at it where an expression of its coordinates, velocities and the time
                grows through zero: x', "x - 0.1"; or just before each impact on a wall: impacts; or
                each event: events.
            after: Look at it from this time on, when it has settled.
            sample: Report the state at this time (repeatable).
            lyapunov: Give the largest Lyapunov exponent of an equation or a mechanism of one's
                own, with its standard error; without it where six digits are lost on the way.
            integrator: The method: power series with the contact in a variable in which it is
                analytic; Runge-Kutta, one smooth phase at a time; or both, and how far they differ.
            chain: Do not integrate: swing and contact in closed form, impact after impact to
                rest, each with its formula, and its error against the integration; with [primary]
                main mass and pendulum together; a sweep is not judged.
            sweep: Follow many motions: a parameter over a range by equal steps, by equal ratios
                (from:to:count:log), or at the values of a list (NAME=a,b,c); repeated, over every
                combination.
            baseline: In a sweep: beside each rest time those without a barrier and with one
                that loses nothing.
            jobs: Threads of a sweep; all cores without it. The result is the same for any
                number.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("simulate", self.problem, {"from_": from_, "until": until, "step_limit": step_limit, "wall": wall, "restitution": restitution, "event": event, "static_friction": static_friction, "contact": contact, "every": every, "section": section, "after": after, "sample": sample, "lyapunov": lyapunov, "integrator": integrator, "chain": chain, "sweep": sweep, "baseline": baseline, "jobs": jobs, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]

    def response(
        self,
        method: str | None = None,
        *,
        vary: Values | None = None,
        along: Values | None = None,
        of: str | None = None,
        order: int | None = None,
        periods: int | None = None,
        wall: Sequence[str] | None = None,
        restitution: Sequence[str] | None = None,
        event: Sequence[str] | None = None,
        contact: Sequence[str] | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Response:
        """Steady states of driven, self-excited or free oscillators, of one coordinate or coupled: every branch with its stability, folds, period doublings, backbone.

        Args:
            method: harmonic-balance; or multiple-scales or averaging, their steady motions
                beside the branches of harmonic balance, which judge them.
            vary: The parameter that varies, and from where to where: Omega=0.5:1.5.
            along: A second parameter, and from where to where: bifurcations are followed in
                both, and stable motions counted.
            of: The quantity that is listed and drawn: a coordinate, or an expression in them
                such as x - y; the first coordinate without it.
            order: The highest harmonic kept; without it as many as bring the error below a
                tenth of the tolerance, 64 at most; of multiple-scales its order.
            periods: Periods of the drive in a period of the motion: 2 for motions after a
                period doubling, 3 for a third of the frequency.
            wall: A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d",
                "-1 < x < 1"); repeatable.
            restitution: The speed after an impact over that before, between 0 and 1: one for
                all walls, or one for each.
            event: An event: where a condition comes true, states are set ("x < 0: x' =
                -0.8*x'", "sin(w*t) > 0: x' = x' + p; y = 0"); = in place of < or > counts in both
                directions; repeatable.
            contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt,
                kelvin-voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
                repeatable.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("response", self.problem, {"method": method, "vary": vary, "along": along, "of": of, "order": order, "periods": periods, "wall": wall, "restitution": restitution, "event": event, "contact": contact, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]

    def stability(
        self,
        *,
        order: int | tuple[int, ...] | str | None = None,
        tongues: int | None = None,
        for_: str | None = None,
        small: Sequence[str] | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Stability:
        """Transition curves of a linear equation with periodic coefficients, such as Mathieu's: where rest is stable.

        Args:
            order: Highest power of the small parameters, all together, that is kept; 6 without
                it.
            tongues: The tongues 0 to N; 3 without it.
            for_: What the curves give: a letter of the mean stiffness, or the frequency.
            small: A small parameter (repeatable); without it eps, and letters that alone stand
                before a wave or the velocity.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("stability", self.problem, {"order": order, "tongues": tongues, "for_": for_, "small": small, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]

    def certify(
        self,
        method: str | None = None,
        *,
        contact: Sequence[str] | None = None,
        order: int | tuple[int, ...] | str | None = None,
        amplitude: Literal["initial", "first-harmonic"] | None = None,
        small: str | None = None,
        about: Values | None = None,
        taylor: int | None = None,
        hbar: Value | None = None,
        cycle: int | None = None,
        resonance: tuple[int, int] | str | None = None,
        omega_only: bool = False,
        jobs: int | None = None,
        range: tuple[Value, Value] | str | None = None,
        no_formula: bool = False,
        mode: int | None = None,
        tolerance: float | None = None,
        timeout: float | None = None,
        at: Values | None = None,
        progress: Progress | None = None,
        **values: Value,
    ) -> Certificate | DampedCertificateDocument | ModeCertificateDocument | CoupledCertificateDocument | CertificateRange:
        """A proof beside a formula: the motion exists, and how far the formula is off, from both sides.

        Args:
            method: How to derive: lindstedt-poincare, homotopy-perturbation, homotopy-analysis,
                iteration-perturbation, parameter-expansion, harmonic-balance, energy-balance, max-
                min, amplitude-frequency, hamiltonian, variational-iteration, frequency-formula,
                averaging, pade, hermite-pade, multiple-scales or exact.
            contact: A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt,
                kelvin-voigt-no-pull or step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2");
                repeatable.
            order: Highest power of the small parameter kept, inclusive; harmonics of harmonic-
                balance; degrees L,M of pade, P,Q,R of hermite-pade.
            amplitude: What the amplitude measures.
            small: The small parameter; A for the amplitude.
            about: The equilibrium to swing about, x=1 say: a stable one, without this the
                nearest to zero, or an unstable one between two wells for motions over both.
            taylor: Degree of the Taylor polynomial that homotopy perturbation puts for the
                force.
            hbar: The convergence-control parameter of homotopy-analysis, exact; without it the
                best one is chosen at the values.
            cycle: Which limit cycle of a self-excited equation, counted from 1 by amplitude;
                without it the smallest that attracts.
            resonance: Which resonance: of a driven equation Omega:omega0, 1:3 say, without it
                the one nearest to the values, or 1:1; of coupled equations relations between
                frequencies, "omega2 = 2*omega1, Omega = omega2", or none, without it those that the
                numbers are near.
            omega_only: The frequency without the motion, of lindstedt-poincare: orders up to
                2000, in less time.
            jobs: Threads of a long expansion; all cores without it. The result is the same for
                any number.
            range: Positive amplitudes, 1/10:3 say: how far from the first of them on the
                formula is proved to be within the tolerance, for every amplitude.
            no_formula: Prove the motion alone, and judge no formula: where that has no real
                value, say.
            mode: Which normal mode of coupled equations, 1 for the slowest and without this.
            tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
            timeout: Give up after so many seconds.
            at: Values of symbols whose names are options or no words, `{"small": 1}`.
            progress: Is called with the parts done and all of them; an exception ends the work.
            **values: The values of symbols, exact where they are text or fractions.

        Raises:
            Refused: The problem is refused, with the term and a way forward.
            UsageError: An option has a value that it cannot have.
        """
        return ask("certify", self.problem, {"method": method, "contact": contact, "order": order, "amplitude": amplitude, "small": small, "about": about, "taylor": taylor, "hbar": hbar, "cycle": cycle, "resonance": resonance, "omega_only": omega_only, "jobs": jobs, "range": range, "no_formula": no_formula, "mode": mode, "tolerance": tolerance, "timeout": timeout, "at": at}, values, progress)  # type: ignore[no-any-return]
