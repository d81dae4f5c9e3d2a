//! Names of parameters, coordinates and derivatives.
//!
//! Every name is stored once for the life of the program, so a [`Symbol`] is a pointer and a
//! length, copies freely and compares by its text: the normal form of an expression, and with it
//! every printed formula, is the same on every run.

pub mod letters;

use std::cmp::Ordering;
use std::collections::HashSet;
use std::fmt;
use std::sync::{LazyLock, Mutex, PoisonError};

/// A name such as `eps`, `A`, `x` or `x'`.
///
/// The derivative of a coordinate is the same name with primes: `x'` is the velocity, `x''` the
/// acceleration.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::Symbol;
/// let x = Symbol::new("x");
/// assert_eq!(x.derivative().name(), "x'");
/// assert_eq!(x.derivative().primes(), 1);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Symbol(&'static str);

// Polynomials compare symbols all the time. Most equal symbols are one pointer, for each name is
// stored once: the text is read only where the pointers differ.
impl Ord for Symbol {
    fn cmp(&self, other: &Self) -> Ordering {
        if std::ptr::eq(self.0, other.0) { Ordering::Equal } else { self.0.cmp(other.0) }
    }
}

impl PartialOrd for Symbol {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Names of Greek letters, which a coordinate may have besides a single letter, and which formulas
/// show as that letter.
pub const GREEK: [&str; 21] = [
    "alpha", "beta", "gamma", "delta", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi",
    "rho", "sigma", "tau", "phi", "chi", "psi", "omega", "Omega", "Lambda",
];

/// Last character of a symbol that is [apart](Symbol::apart); no typed name has it.
const APART: char = '\u{1}';

static NAMES: LazyLock<Mutex<HashSet<&'static str>>> = LazyLock::new(Mutex::default);

impl Symbol {
    /// The symbol of this name. Names are kept until the program ends.
    pub fn new(name: &str) -> Self {
        let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = names.get(name) {
            return Self(known);
        }
        let kept: &'static str = Box::leak(name.into());
        names.insert(kept);
        Self(kept)
    }

    /// The text of the name, primes included.
    pub fn name(self) -> &'static str {
        self.0.strip_suffix(APART).unwrap_or(self.0)
    }

    /// The name as it is printed: a symbol of an answer is renamed if the equation uses its name,
    /// see `ResultSymbols`.
    pub fn written(self) -> &'static str {
        letters::written(self)
    }

    /// A symbol of the same name for use in an equation, distinct from the symbol of that name in
    /// an answer.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::Symbol;
    /// let (frequency, parameter) = (Symbol::new("omega"), Symbol::new("omega").apart());
    /// assert_eq!(parameter.name(), frequency.name());
    /// assert_ne!(parameter, frequency);
    /// ```
    #[must_use]
    pub fn apart(self) -> Self {
        Self::new(&format!("{}{APART}", self.name()))
    }

    /// Whether the symbol is one that [`Symbol::apart`] returns.
    pub fn is_apart(self) -> bool {
        self.0.ends_with(APART)
    }

    /// The symbol of another name, apart if this one is.
    fn with_name(self, name: &str) -> Self {
        let symbol = Self::new(name);
        if self.is_apart() { symbol.apart() } else { symbol }
    }

    /// The time derivative of a coordinate: one more prime.
    pub fn derivative(self) -> Self {
        self.with_name(&format!("{}'", self.name()))
    }

    /// Number of primes at the end of the name: 0 for `x`, 2 for `x''`.
    pub fn primes(self) -> usize {
        self.name().len() - self.name().trim_end_matches('\'').len()
    }

    /// Whether the name is that of a Greek letter, with or without an index.
    pub fn is_greek(self) -> bool {
        let stem = self.name().trim_end_matches(|letter: char| letter.is_ascii_digit());
        GREEK.contains(&stem.trim_end_matches('_'))
    }

    /// The name without its primes: the coordinate itself.
    pub fn coordinate(self) -> Self {
        self.with_name(self.name().trim_end_matches('\''))
    }
}

/// Returns a name for a symbol that the program introduces: `wanted` if it is not in `taken`, else
/// the first of `wanted_`, `wanted__`, ... that is free.
///
/// Every name in an answer that is not the user's own comes from here or from [`fresh_stem`].
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::fresh;
/// assert_eq!(fresh("hbar", &[]).name(), "hbar");
/// assert_eq!(fresh("hbar", &["hbar".into(), "hbar_".into()]).name(), "hbar__");
/// ```
pub fn fresh(wanted: &str, taken: &[Symbol]) -> Symbol {
    let mut name = wanted.to_owned();
    while taken.iter().any(|symbol| symbol.name() == name) {
        name.push('_');
    }
    Symbol::new(&name)
}

/// Returns a stem for a whole family `stem0`, `stem1`, ..., `stem_n`, chosen as by [`fresh`]: no
/// name in `taken` is the stem followed by digits.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::fresh_stem;
/// assert_eq!(fresh_stem("W", &["k".into()]), "W");
/// assert_eq!(fresh_stem("W", &["W2".into()]), "W_");
/// ```
pub fn fresh_stem(wanted: &str, taken: &[Symbol]) -> String {
    let continues = |stem: &str, symbol: &Symbol| {
        let rest = symbol.name().strip_prefix(stem);
        rest.is_some_and(|rest| {
            rest.bytes().all(|letter| letter.is_ascii_digit()) && !rest.is_empty()
        })
    };
    let mut stem = wanted.to_owned();
    while taken.iter().any(|symbol| continues(&stem, symbol)) {
        stem.push('_');
    }
    stem
}

/// Returns the name of the phase of a motion: `theta`, or `phi` if `theta` is taken.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::phase_beside;
/// assert_eq!(phase_beside(&["x".into()]).name(), "theta");
/// assert_eq!(phase_beside(&["theta".into()]).name(), "phi");
/// ```
pub fn phase_beside(taken: &[Symbol]) -> Symbol {
    let theta = Symbol::new("theta");
    if taken.contains(&theta) { fresh("phi", taken) } else { theta }
}

impl fmt::Display for Symbol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.written())
    }
}

impl fmt::Debug for Symbol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.written())
    }
}

impl From<&str> for Symbol {
    fn from(name: &str) -> Self {
        Self::new(name)
    }
}
