"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from .._answer import Answer
from .._document import Document, frozen, several


#: A force.
CertificateForce: TypeAlias = tuple[str, ...] | str


@dataclass(frozen=True, eq=False, repr=False)
class CertificateLetters(Document):
    """The letters of an answer in its law.

    Attributes:
        amplitude: That of the amplitude, whose value is x(0) less a place of rest.
        frequency: That of the frequency, on the left side of the law.
    """

    amplitude: str
    frequency: str


CertificateLetters.FIELDS = (
    ("amplitude", "amplitude", None),
    ("frequency", "frequency", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateFormula(Document):
    """A formula `x~(t) = X~(omega~ t)` with its numbers, and what is proved of them, each from below
    and from above.

    Attributes:
        law: The law as it was derived: `omega = ...` or `omega^2 = ...` with definitions of
            letters behind commas, which has to give `omega` at `values` to its last digits. What
            is of another form is words: nothing is checked against them.
        letters: The letters of the answer in the law, where the equation has the usual ones, `A`
            or `omega`, for something of its own.
        values: The values of the letters in the law, such as `A = 3/2, k = pi/5`; A is x(0) less
            a place of rest.
        omega: omega~, an integer times 2^-bits.
        c: The cosine coefficients of X~, likewise.
        phase_error: max |X - X~|, both at the same phase, in the unit of x.
        frequency_error: |omega - omega~|.
        drift: max |X~'| |omega - omega~|: |x(t) - x~(t)| <= phase_error + drift |t| for all t.
    """

    law: str
    letters: CertificateLetters | None
    values: str | None
    omega: str
    c: tuple[str, ...]
    phase_error: tuple[str, str]
    frequency_error: tuple[str, str]
    drift: tuple[str, str]


CertificateFormula.FIELDS = (
    ("law", "law", None),
    ("letters", "letters", CertificateLetters.from_json),
    ("values", "values", None),
    ("omega", "omega", None),
    ("c", "c", tuple),
    ("phase_error", "phase_error", tuple),
    ("frequency_error", "frequency_error", tuple),
    ("drift", "drift", tuple),
)
CertificateFormula.OPTIONAL = frozenset(['letters', 'values'])


@dataclass(frozen=True, eq=False, repr=False)
class CertificateDocument(Answer):
    """Numbers from which a motion of `x'' + f(x) = 0` can be proved, and how far a formula for it is
    off. All numbers are text: integers, fractions such as `-1/6`, decimals such as `2.5e-33`.

    Attributes:
        schema: The kind of document.
        ode: The equation that f belongs to.
        f: The force: the coefficients of a polynomial by rising power of x, or an expression in
            x.
        initial_displacement: x(0), a fraction, exact; x'(0) = 0.
        odd: Whether f is odd: then the motion has odd harmonics alone, and so has the block.
        bits: `mu`, `c` and the numbers of the formula are integers times 2^-bits; at most 224.
        mu: The approximate 1/omega^2.
        c: The approximate cosine coefficients c_0, c_1, ... of the motion.
        highest_harmonic: The last harmonic of the block; at most 400.
        inverse_bits: The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
        inverse: The approximate inverse of the derivative on mu and the c_k of the block, row by
            row; the first row is that of mu, the first column that of the condition x(0) =
            initial_displacement.
        sigma_log2: The norm is sigma |mu| + sum |c_k|, sigma = 2^sigma_log2.
        nu: The weight of a harmonic from one to the next; 1.
        claim_r: The radius that is claimed: the true mu and c are so near in the norm.
        formula: The formula that is judged; null where none is.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["x''+f(x)=0"]
    f: CertificateForce
    initial_displacement: Fraction
    odd: bool
    bits: int
    mu: str
    c: tuple[str, ...]
    highest_harmonic: int
    inverse_bits: int
    inverse: tuple[tuple[str, ...], ...]
    sigma_log2: int
    nu: Literal["1"]
    claim_r: str
    formula: CertificateFormula | None


CertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("f", "f", frozen),
    ("initial_displacement", "initial_displacement", Fraction),
    ("odd", "odd", None),
    ("bits", "bits", None),
    ("mu", "mu", None),
    ("c", "c", tuple),
    ("highest_harmonic", "highest_harmonic", None),
    ("inverse_bits", "inverse_bits", None),
    ("inverse", "inverse", several(tuple)),
    ("sigma_log2", "sigma_log2", None),
    ("nu", "nu", None),
    ("claim_r", "claim_r", None),
    ("formula", "formula", CertificateFormula.from_json),
)
CertificateDocument.CONSTANTS = {'ode': "x''+f(x)=0", 'nu': '1'}


@dataclass(frozen=True, eq=False, repr=False)
class CertificateDrive(Document):
    """What drives a motion.

    Attributes:
        driving_frequency: The driving frequency Omega, a positive fraction, exact.
        n: How many periods of the drive the motion takes: x(t) = X(Omega t/n).
        harmonic: The harmonic of the motion whose amplitude the formula is about.
    """

    driving_frequency: Fraction
    n: int
    harmonic: int


CertificateDrive.FIELDS = (
    ("driving_frequency", "driving_frequency", Fraction),
    ("n", "n", None),
    ("harmonic", "harmonic", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateFormulaOfCycle(Document):
    """A formula `x~(t) = X~(omega~ t)` with its numbers, and what is proved of them, each from below
    and from above.

    Attributes:
        law: The law as it was derived: of a cycle `omega = ...` or `omega^2 = ...`, with a drive
            `x = ...` in t, with definitions of letters behind commas; it has to give `omega`,
            with a drive `c` and `s`, at `values` to the last digits. What is of another form is
            words: nothing is checked against them.
        letters: The letters of the answer in the law, where the equation has the usual ones, `A`
            or `omega`, for something of its own.
        values: The values of the letters in the law.
        omega: omega~, an integer times 2^-bits; not there with a drive.
        c: The cosine coefficients of X~, that of the constant first, likewise.
        s: Its sine coefficients by harmonic, likewise.
        phase_error: max |X - X~|, in the unit of x, X~ of a limit cycle turned until its first
            harmonic is a positive cosine; of the nearest of the motions that follow from X by
            symmetries of the equation: with a drive any number of its periods later, of an
            equation that is its own mirror image -X too.
        frequency_error: |omega - omega~|; not there with a drive.
        drift: max |X~'| |omega - omega~|: |x(t) - x~(t)| <= phase_error + drift |t| for all t,
            both with this phase at t = 0; not there with a drive.
        amplitude_error: |a - a~|, the amplitudes of the drive's harmonic; not there for a limit
            cycle.
    """

    law: str
    letters: CertificateLetters | None
    values: str | None
    omega: str | None
    c: tuple[str, ...]
    s: tuple[str, ...]
    phase_error: tuple[str, str]
    frequency_error: tuple[str, str] | None
    drift: tuple[str, str] | None
    amplitude_error: tuple[str, str] | None


CertificateFormulaOfCycle.FIELDS = (
    ("law", "law", None),
    ("letters", "letters", CertificateLetters.from_json),
    ("values", "values", None),
    ("omega", "omega", None),
    ("c", "c", tuple),
    ("s", "s", tuple),
    ("phase_error", "phase_error", tuple),
    ("frequency_error", "frequency_error", tuple),
    ("drift", "drift", tuple),
    ("amplitude_error", "amplitude_error", tuple),
)
CertificateFormulaOfCycle.OPTIONAL = frozenset(['amplitude_error', 'drift', 'frequency_error', 'letters', 'omega', 'values'])


@dataclass(frozen=True, eq=False, repr=False)
class CertificateStability(Document):
    """The stability of a limit cycle or of a driven motion, as it is proved.

    Attributes:
        attracts: Whether neighbouring motions approach it; false where it is unstable, null where
            neither is proved.
        largest_multiplier: The largest modulus of its Floquet multipliers over the period 2 pi of
            X, from below and from above; of a limit cycle without the multiplier 1 along the
            motion. Null where nothing is known of it.
    """

    attracts: bool | None
    largest_multiplier: tuple[str, str] | None


CertificateStability.FIELDS = (
    ("attracts", "attracts", None),
    ("largest_multiplier", "largest_multiplier", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class DampedCertificateDocument(Answer):
    """Numbers from which a limit cycle of `x'' + g(x) x' + h(x) = 0` can be proved, or a steady
    motion with a drive in h, and how far a formula for it is off. All numbers are text:
    integers, fractions such as `-1/6`, decimals such as `2.5e-33`. The first harmonic of a
    cycle has no sine.

    Attributes:
        schema: The kind of document.
        ode: The equation that g and h belong to.
        g: The damping by velocity: the coefficients of a polynomial by rising power of x, or an
            expression in x.
        h: The restoring force, likewise; with a drive an expression in x, c = cos(Omega t) and s
            = sin(Omega t).
        drive: What drives the motion; not there for a limit cycle.
        odd: Whether g is even, h odd and the motion of odd harmonics alone, and so the block, and
            the only one within claim_r among those; with a drive h is odd in x and in what of c
            and s changes its sign after half a period of the motion.
        bits: `p`, `c`, `s` and the numbers of the formula are integers times 2^-bits; at most
            224.
        p: The approximate 1/omega; not there with a drive, n/Omega exactly.
        c: The approximate cosine coefficients of the motion, that of the constant first; of a
            limit cycle that of the first harmonic is positive.
        s: The approximate sine coefficients by harmonic; that of the constant is 0, and of a
            limit cycle that of the first harmonic too.
        highest_harmonic: The last harmonic of the block; at most 400, and the block has at most
            401 unknowns.
        inverse_bits: The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
        inverse: The approximate inverse of the derivative on the block, row by row. The columns
            are those of the equations: the sine of the first harmonic, then cosine and sine of
            each harmonic, the others; the rows those of the unknowns: p, then the same. With a
            drive both are cosine and sine of each harmonic.
        sigma_log2: The norm is sigma |p| + sum (|c_k| + |s_k|), sigma = 2^sigma_log2; 0 with a
            drive, where there is no p.
        nu: The weight of a harmonic from one to the next; 1.
        claim_r: The radius that is claimed: there is exactly one motion whose p, c and s are so
            near in the norm, where `odd` exactly one of odd harmonics.
        stability: The stability that is claimed; not there in certificates that claim none.
        formula: The formula that is judged, of a limit cycle turned until its first harmonic is a
            positive cosine; null where none is.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["x''+g(x)*x'+h(x)=0", "x''+g(x)*x'+h(x,c,s)=0"]
    g: CertificateForce
    h: CertificateForce
    drive: CertificateDrive | None
    odd: bool
    bits: int
    p: str | None
    c: tuple[str, ...]
    s: tuple[str, ...]
    highest_harmonic: int
    inverse_bits: int
    inverse: tuple[tuple[str, ...], ...]
    sigma_log2: int
    nu: Literal["1"]
    claim_r: str
    stability: CertificateStability | None
    formula: CertificateFormulaOfCycle | None


DampedCertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("g", "g", frozen),
    ("h", "h", frozen),
    ("drive", "drive", CertificateDrive.from_json),
    ("odd", "odd", None),
    ("bits", "bits", None),
    ("p", "p", None),
    ("c", "c", tuple),
    ("s", "s", tuple),
    ("highest_harmonic", "highest_harmonic", None),
    ("inverse_bits", "inverse_bits", None),
    ("inverse", "inverse", several(tuple)),
    ("sigma_log2", "sigma_log2", None),
    ("nu", "nu", None),
    ("claim_r", "claim_r", None),
    ("stability", "stability", CertificateStability.from_json),
    ("formula", "formula", CertificateFormulaOfCycle.from_json),
)
DampedCertificateDocument.OPTIONAL = frozenset(['drive', 'p', 'stability'])
DampedCertificateDocument.CONSTANTS = {'nu': '1'}


@dataclass(frozen=True, eq=False, repr=False)
class CertificateAmplitude(Document):
    """The amplitude of a motion of several coordinates: the start of one of them, or the amplitude of
    the first harmonic of a sum of all.

    Attributes:
        value: Its value, a fraction, exact.
        start_of: The name of the coordinate whose start it is; null where it is that of the first
            harmonic.
        first_harmonic_of: The factor of each coordinate in the sum whose first harmonic has the
            amplitude, an expression of numbers; null where it is the start of a coordinate.
    """

    value: Fraction
    start_of: str | None
    first_harmonic_of: tuple[str, ...] | None


CertificateAmplitude.FIELDS = (
    ("value", "value", Fraction),
    ("start_of", "start_of", None),
    ("first_harmonic_of", "first_harmonic_of", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateFormulaOfMode(Document):
    """The formulas of a mode with their numbers, and what is proved of them, each from below and from
    above.

    Attributes:
        law: The law as it was derived: `omega^2 = ...` with definitions of letters behind commas,
            which has to give `omega` at `values` to its last digits. What is of another form is
            words: nothing is checked against them.
        letters: The letters of the answer in the law.
        values: The values of the letters in the law, such as `a = 4/5`.
        omega: omega~, an integer times 2^-bits.
        c: The cosine coefficients of each coordinate, likewise.
        phase_error: max |X - X~|, both at the same phase, the largest of those of the
            coordinates.
        frequency_error: |omega - omega~|.
        drift: max |X~'| |omega - omega~|, the largest of those of the coordinates: |q(t) - q~(t)|
            <= phase_error + drift |t| for all t and every coordinate q.
    """

    law: str
    letters: CertificateLetters | None
    values: str | None
    omega: str
    c: tuple[tuple[str, ...], ...]
    phase_error: tuple[str, str]
    frequency_error: tuple[str, str]
    drift: tuple[str, str]


CertificateFormulaOfMode.FIELDS = (
    ("law", "law", None),
    ("letters", "letters", CertificateLetters.from_json),
    ("values", "values", None),
    ("omega", "omega", None),
    ("c", "c", several(tuple)),
    ("phase_error", "phase_error", tuple),
    ("frequency_error", "frequency_error", tuple),
    ("drift", "drift", tuple),
)
CertificateFormulaOfMode.OPTIONAL = frozenset(['letters', 'values'])


@dataclass(frozen=True, eq=False, repr=False)
class ModeCertificateDocument(Answer):
    """Numbers from which a free motion of several coordinates, `q'' + f(q) = 0`, can be proved, and
    how far the formulas of a normal mode are off. All numbers are text: integers, fractions
    such as `-1/6`, decimals such as `2.5e-33`. Every velocity is zero at t = 0.

    Attributes:
        schema: The kind of document.
        ode: The equations that f belongs to.
        coordinates: The names of the coordinates.
        f: The acceleration of each coordinate with its sign changed, an expression in the
            coordinates: the mass matrix is inverted already.
        amplitude: The amplitude of the motion.
        odd: Whether every f is odd and the motion of odd harmonics alone, and so the block, and
            the only one within claim_r among those.
        bits: `mu`, `c` and the numbers of the formula are integers times 2^-bits; at most 224.
        mu: The approximate 1/omega^2.
        c: The approximate cosine coefficients of each coordinate, that of the constant first.
        highest_harmonic: The last harmonic of the block; at most 400, and the block has at most
            401 unknowns.
        inverse_bits: The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
        inverse: The approximate inverse of the derivative on mu and the harmonics of the block,
            those of one coordinate after those of the other, row by row; the first row is that of
            mu, the first column that of the condition on the amplitude.
        sigma_log2: The norm is sigma |mu| + sum |c_ik|, sigma = 2^sigma_log2.
        nu: The weight of a harmonic from one to the next; 1.
        claim_r: The radius that is claimed: there is exactly one motion of this amplitude whose
            mu and c are so near in the norm, where `odd` exactly one of odd harmonics.
        formula: The formulas that are judged; null where none are.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["q''+f(q)=0"]
    coordinates: tuple[str, ...]
    f: tuple[str, ...]
    amplitude: CertificateAmplitude
    odd: bool
    bits: int
    mu: str
    c: tuple[tuple[str, ...], ...]
    highest_harmonic: int
    inverse_bits: int
    inverse: tuple[tuple[str, ...], ...]
    sigma_log2: int
    nu: Literal["1"]
    claim_r: str
    formula: CertificateFormulaOfMode | None


ModeCertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("coordinates", "coordinates", tuple),
    ("f", "f", tuple),
    ("amplitude", "amplitude", CertificateAmplitude.from_json),
    ("odd", "odd", None),
    ("bits", "bits", None),
    ("mu", "mu", None),
    ("c", "c", several(tuple)),
    ("highest_harmonic", "highest_harmonic", None),
    ("inverse_bits", "inverse_bits", None),
    ("inverse", "inverse", several(tuple)),
    ("sigma_log2", "sigma_log2", None),
    ("nu", "nu", None),
    ("claim_r", "claim_r", None),
    ("formula", "formula", CertificateFormulaOfMode.from_json),
)
ModeCertificateDocument.CONSTANTS = {'ode': "q''+f(q)=0", 'nu': '1'}


@dataclass(frozen=True, eq=False, repr=False)
class CoupledCertificateDocument(Answer):
    """Numbers from which a limit cycle of several coordinates, `q'' + g(q) q' + h(q) = 0`, can be
    proved, or a steady motion with a drive in h. All numbers are text: integers, fractions
    such as `-1/6`, decimals such as `2.5e-33`.

    Attributes:
        schema: The kind of document.
        ode: The equations that g and h belong to.
        coordinates: The names of the coordinates, with a drive none of them c or s.
        g: The damping by velocities, expressions in the coordinates: a row for each equation,
            which is the derivative of a function of the coordinates, dg_ij/dq_l = dg_il/dq_j.
        h: The force of each equation, an expression in the coordinates, with a drive also in c =
            cos(Omega t) and s = sin(Omega t): the mass matrix is inverted already.
        drive: What drives the motion; `harmonic` is the one whose amplitudes are proved. Not
            there for a limit cycle, of which those of the first are.
        phase_of: The name of the coordinate whose first harmonic is a positive cosine; not there
            with a drive.
        odd: Whether every g is even, every h odd and the motion of odd harmonics alone, and so
            the block, and the only one within claim_r among those; h is odd in the coordinates
            and in what of c and s changes its sign after half a period of the motion.
        bits: `p`, `c` and `s` are integers times 2^-bits; at most 224.
        p: The approximate 1/omega; not there with a drive, n/Omega exactly.
        c: The approximate cosine coefficients of each coordinate, that of the constant first.
        s: The approximate sine coefficients of each coordinate by harmonic; that of the constant
            is 0, and so is that of the first harmonic of `phase_of`.
        highest_harmonic: The last harmonic of the block; at most 400, and the block has at most
            401 unknowns.
        inverse_bits: The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
        nu: The weight of a harmonic from one to the next; 1.
        sigma_log2: The norm is sigma |p| + sum (|c_ik| + |s_ik|), sigma = 2^sigma_log2; not there
            with a drive, where there is no p.
        claim_r: The radius that is claimed: there is exactly one motion whose p, c and s are so
            near in the norm, where `odd` exactly one of odd harmonics.
        stability: The stability that is claimed; not there in certificates that claim none.
        inverse: The approximate inverse of the derivative on the block, row by row: cosine and
            sine of each harmonic, those of one coordinate after those of the other. Of a limit
            cycle the columns begin with the sine of the first harmonic of `phase_of`, and the
            rows with p, then the others follow.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["q''+g(q)*q'+h(q)=0", "q''+g(q)*q'+h(q,c,s)=0"]
    coordinates: tuple[str, ...]
    g: tuple[tuple[str, ...], ...]
    h: tuple[str, ...]
    drive: CertificateDrive | None
    phase_of: str | None
    odd: bool
    bits: int
    p: str | None
    c: tuple[tuple[str, ...], ...]
    s: tuple[tuple[str, ...], ...]
    highest_harmonic: int
    inverse_bits: int
    nu: Literal["1"]
    sigma_log2: int | None
    claim_r: str
    stability: CertificateStability | None
    inverse: tuple[tuple[str, ...], ...]


CoupledCertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("coordinates", "coordinates", tuple),
    ("g", "g", several(tuple)),
    ("h", "h", tuple),
    ("drive", "drive", CertificateDrive.from_json),
    ("phase_of", "phase_of", None),
    ("odd", "odd", None),
    ("bits", "bits", None),
    ("p", "p", None),
    ("c", "c", several(tuple)),
    ("s", "s", several(tuple)),
    ("highest_harmonic", "highest_harmonic", None),
    ("inverse_bits", "inverse_bits", None),
    ("nu", "nu", None),
    ("sigma_log2", "sigma_log2", None),
    ("claim_r", "claim_r", None),
    ("stability", "stability", CertificateStability.from_json),
    ("inverse", "inverse", several(tuple)),
)
CoupledCertificateDocument.OPTIONAL = frozenset(['drive', 'p', 'phase_of', 'sigma_log2', 'stability'])
CoupledCertificateDocument.CONSTANTS = {'nu': '1'}


@dataclass(frozen=True, eq=False, repr=False)
class ModeOfLawDocument(Document):
    """The motions of a nonlinear normal mode, `q'' + f(q) = 0` with `q = a v(omega t)`, on a range of
    its amplitude a. Every velocity is zero at t = 0.

    Attributes:
        coordinates: The names of the coordinates.
        f: The acceleration of each coordinate with its sign changed, an expression in the
            coordinates: the mass matrix is inverted already.
        start_of: The name of the coordinate whose start the amplitude is; null where it is that
            of the first harmonic.
        first_harmonic_of: The factor of each coordinate in the sum whose first harmonic has the
            amplitude, an expression of numbers; null where it is the start of a coordinate.
        mu: 1/omega^2 at the lower end of the range, to some digits: with `c` it tells which mode
            it is.
        c: The cosine coefficients of v of each coordinate there, that of the constant first: of
            the motion of the law mu and c differ from these by less than 2^-20 in all.
    """

    coordinates: tuple[str, ...]
    f: tuple[str, ...]
    start_of: str | None
    first_harmonic_of: tuple[str, ...] | None
    mu: str
    c: tuple[tuple[str, ...], ...]


ModeOfLawDocument.FIELDS = (
    ("coordinates", "coordinates", tuple),
    ("f", "f", tuple),
    ("start_of", "start_of", None),
    ("first_harmonic_of", "first_harmonic_of", tuple),
    ("mu", "mu", None),
    ("c", "c", several(tuple)),
)


@dataclass(frozen=True, eq=False, repr=False)
class LawCertificateDocument(Answer):
    """A frequency law of `x'' + f(x; p) = 0` on a range of the amplitude or of a parameter, a law of
    the duration of contacts, or one of a nonlinear normal mode on a range of its amplitude,
    and how far it is off. All numbers are text: integers, fractions such as `14/5`, decimals
    such as `0.0011`.

    Attributes:
        schema: The kind of document.
        ode: The equation that f belongs to.
        f: The force, an expression in x, zero at x = 0, and in the variable where that is a
            parameter; of a contact `x^n*(1 + c*x')` with numbers. Null for a mode.
        mass: The mass m, an expression as f is; null where it is one.
        mode: The mode; null for motions of one coordinate.
        variable: The name of the variable.
        start: x(0), with x'(0) = 0: `variable` where the variable is the amplitude, else a
            positive number; of a contact x'(0), and of a mode its amplitude, `variable`.
        quantity: The quantity of the law: `omega`, `omega^2`, `T/(2*pi)`, or `T/T_0`, the
            duration of a contact over that without damping.
        law: The law, an expression in the variable; of a contact in its restitution e as well.
        from_: The lower end of the range, not negative.
        to: The upper end; null for infinity.
        worst: A value of the variable at which the error is at least the first of `error`.
        error: The largest `|law/truth - 1|` on the range is at least and at most this.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["x''+f(x,p)=0", "m*x''+(dm/dx)*x'^2/2+f(x,p)=0", "x''+f(x,x')=0", "a*v''+mu*f(a*v)=0"]
    f: str | None
    mass: str | None
    mode: ModeOfLawDocument | None
    variable: str
    start: str
    quantity: Literal["omega", "omega^2", "T/(2*pi)", "T/T_0"]
    law: str
    from_: str
    to: str | None
    worst: str
    error: tuple[str, str]


LawCertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("f", "f", None),
    ("mass", "mass", None),
    ("mode", "mode", ModeOfLawDocument.from_json),
    ("variable", "variable", None),
    ("start", "start", None),
    ("quantity", "quantity", None),
    ("law", "law", None),
    ("from_", "from", None),
    ("to", "to", None),
    ("worst", "worst", None),
    ("error", "error", tuple),
)
LawCertificateDocument.OPTIONAL = frozenset(['mode'])


@dataclass(frozen=True, eq=False, repr=False)
class CertificateImpact(Document):
    """An impact of an orbit.

    Attributes:
        wall: The number of the wall in `walls`, from 1 on.
        phase: Omega times the time of the impact, an integer times 2^-bits.
        speed: The speed relative to the wall just before the impact, an integer times 2^-bits.
    """

    wall: int
    phase: str
    speed: str


CertificateImpact.FIELDS = (
    ("wall", "wall", None),
    ("phase", "phase", None),
    ("speed", "speed", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateOrbit(Document):
    """An orbit, and what is claimed of it.

    Attributes:
        periods: The periods of the drive in a period of the orbit.
        impacts: The approximate impacts in a period, in order of time.
        phase_radius: The phase of each impact is so near.
        speed_radius: The speed of each impact is so near.
        isolated_in_phase: No other orbit with impacts on these walls in this order has all phases
            so near, and all speeds within `isolated_in_speed`.
        isolated_in_speed: See `isolated_in_phase`.
        stability: The stability that is claimed.
    """

    periods: int
    impacts: tuple[CertificateImpact, ...]
    phase_radius: str
    speed_radius: str
    isolated_in_phase: str
    isolated_in_speed: str
    stability: CertificateStability


CertificateOrbit.FIELDS = (
    ("periods", "periods", None),
    ("impacts", "impacts", several(CertificateImpact.from_json)),
    ("phase_radius", "phase_radius", None),
    ("speed_radius", "speed_radius", None),
    ("isolated_in_phase", "isolated_in_phase", None),
    ("isolated_in_speed", "isolated_in_speed", None),
    ("stability", "stability", CertificateStability.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateWave(Document):
    """A constant and a wave of the drive, three fractions: `constant + cosine*cos(Omega*t) +
    sine*sin(Omega*t)`.

    Attributes:
        constant: The constant.
        cosine: The factor of the cosine.
        sine: The factor of the sine.
    """

    constant: str
    cosine: str
    sine: str


CertificateWave.FIELDS = (
    ("constant", "constant", None),
    ("cosine", "cosine", None),
    ("sine", "sine", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class CertificateWall(Document):
    """A rigid wall.

    Attributes:
        side: `above` where the motion is at x < place, `below` where it is at x > place.
        place: The place.
        restitution: The coefficient of restitution, a fraction from 0 to 1.
    """

    side: Literal["above", "below"]
    place: CertificateWave
    restitution: str


CertificateWall.FIELDS = (
    ("side", "side", None),
    ("place", "place", CertificateWave.from_json),
    ("restitution", "restitution", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitCertificateDocument(Answer):
    """Numbers from which periodic orbits of a linear driven oscillator between rigid walls can be
    proved. All numbers are text: integers, fractions such as `-1/6`, decimals such as
    `2.5e-33`.

    Attributes:
        schema: The kind of document.
        ode: The equation between impacts; `constant`, `cosine` and `sine` are those of `load`.
        c: The damping, a fraction.
        k: The stiffness, a fraction.
        driving_frequency: Omega, a positive fraction.
        load: The right side of the equation.
        walls: One wall, or one on each side.
        bits: `phase` and `speed` of an impact are integers times 2^-bits; at most 224.
        orbits: The orbits.
    """

    schema: Literal["lindstedt/certificate/1"]
    ode: Literal["x''+c*x'+k*x=constant+cosine*cos(Omega*t)+sine*sin(Omega*t)"]
    c: str
    k: str
    driving_frequency: str
    load: CertificateWave
    walls: tuple[CertificateWall, ...]
    bits: int
    orbits: tuple[CertificateOrbit, ...]


OrbitCertificateDocument.FIELDS = (
    ("schema", "schema", None),
    ("ode", "ode", None),
    ("c", "c", None),
    ("k", "k", None),
    ("driving_frequency", "driving_frequency", None),
    ("load", "load", CertificateWave.from_json),
    ("walls", "walls", several(CertificateWall.from_json)),
    ("bits", "bits", None),
    ("orbits", "orbits", several(CertificateOrbit.from_json)),
)
OrbitCertificateDocument.CONSTANTS = {'ode': "x''+c*x'+k*x=constant+cosine*cos(Omega*t)+sine*sin(Omega*t)"}


#: Numbers from which a motion can be proved, and how far a formula for it is off: a conservative
#: motion, a limit cycle, a driven motion, a free or a driven motion of several coordinates, or
#: impact orbits; or how far a frequency law is off on a range.
Certificate: TypeAlias = CertificateDocument | DampedCertificateDocument | ModeCertificateDocument | CoupledCertificateDocument | LawCertificateDocument | OrbitCertificateDocument
