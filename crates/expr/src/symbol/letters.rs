//! The letters of an answer: the spelling of its amplitudes and its frequency beside the names of
//! an equation.
//!
//! In an answer the amplitude is `A`, that of the first harmonic `a`, the frequency `omega`. If an
//! equation uses one of these names, the equation keeps it, and the answer takes another. Inside
//! the crate the symbols of an answer are the same for every equation, those of such an equation
//! are [apart](Symbol::apart), and the [`ResultSymbols`] in force determine how the former are
//! printed: in formulas and in sentences, in every format.

use std::cell::Cell;
use std::marker::PhantomData;

use super::{Symbol, fresh};

/// The amplitude at the start.
pub const AMPLITUDE: Symbol = Symbol("A");
/// The amplitude of the first harmonic.
pub const FIRST_HARMONIC: Symbol = Symbol("a");
/// The frequency.
pub const FREQUENCY: Symbol = Symbol("omega");

/// Substitutes for `A`, the amplitude at the start, if it is taken: the first of these that is
/// free, else `A_`, `A__` and so on. The next two lists serve the other letters likewise.
const AMPLITUDES: [&str; 3] = ["C", "X", "A_0"];
const FIRST_HARMONICS: [&str; 3] = ["r", "rho", "a_1"];
/// The first substitute is not used with a drive, whose frequency it is.
const FREQUENCIES: [&str; 3] = ["Omega", "nu", "w"];

/// Returns whether an answer to some equation may write this name for the symbol `usual`.
pub fn may_stand_for(name: &str, usual: Symbol) -> bool {
    let others: &[&str] = match usual {
        AMPLITUDE => &AMPLITUDES,
        FIRST_HARMONIC => &FIRST_HARMONICS,
        FREQUENCY => &FREQUENCIES,
        _ => &[],
    };
    others.contains(&name) || name.trim_end_matches('_') == usual.name()
}

/// The letters of an answer, as they are printed.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{Expr, ResultSymbols};
/// use lindstedt::Symbol;
///
/// let letters = ResultSymbols::avoiding(&["omega".into()], false);
/// assert_eq!((letters.amplitude.name(), letters.frequency.name()), ("A", "Omega"));
/// let ratio = Expr::divide(&Expr::symbol("omega"), &Expr::from(Symbol::new("omega").apart()))?;
/// let in_force = letters.in_force();
/// assert_eq!(ratio.to_string(), "Omega/omega");
/// # drop(in_force);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultSymbols {
    /// The amplitude at the start, `A` where the equation has no such name.
    pub amplitude: Symbol,
    /// The amplitude of the first harmonic and of slow equations, `a` likewise.
    pub first_harmonic: Symbol,
    /// The frequency, `omega` likewise.
    pub frequency: Symbol,
}

/// The usual letters, which most answers have.
const USUAL: ResultSymbols =
    ResultSymbols { amplitude: AMPLITUDE, first_harmonic: FIRST_HARMONIC, frequency: FREQUENCY };

thread_local! {
    static IN_FORCE: Cell<ResultSymbols> = const { Cell::new(USUAL) };
}

/// A guard that keeps letters in force on this thread until it is dropped.
#[must_use]
pub struct InForce {
    before: ResultSymbols,
    of_this_thread: PhantomData<*const ()>,
}

impl Drop for InForce {
    fn drop(&mut self) {
        IN_FORCE.set(self.before);
    }
}

impl ResultSymbols {
    /// Chooses the letters of an answer to an equation with these names, which are not available. A
    /// `driven` equation keeps `Omega` for the drive.
    pub fn avoiding(names: &[Symbol], driven: bool) -> Self {
        let clash = |own: &Symbol| {
            [AMPLITUDE, FIRST_HARMONIC, FREQUENCY].iter().any(|usual| usual.name() == own.name())
        };
        if !names.iter().any(clash) {
            return USUAL;
        }
        let mut taken = names.to_vec();
        let mut free = |usual: Symbol, others: &[&str]| {
            let is_free = |name: &str| taken.iter().all(|symbol| symbol.name() != name);
            let first = std::iter::once(usual.name())
                .chain(others.iter().copied())
                .find(|name| is_free(name));
            let letter = first.map_or_else(|| fresh(usual.name(), &taken), Symbol::new);
            taken.push(letter);
            letter
        };
        let frequencies = if driven { &FREQUENCIES[1..] } else { &FREQUENCIES[..] };
        Self {
            amplitude: free(AMPLITUDE, &AMPLITUDES),
            first_harmonic: free(FIRST_HARMONIC, &FIRST_HARMONICS),
            frequency: free(FREQUENCY, frequencies),
        }
    }

    /// The symbols in force on this thread; `None` if they are the usual ones.
    pub fn current() -> Option<Self> {
        Some(IN_FORCE.get()).filter(|letters| *letters != USUAL)
    }

    /// Puts these symbols in force on this thread until the guard is dropped. Unusual ones that are
    /// in force already stay, because they belong to the equation in question.
    pub fn in_force(self) -> InForce {
        Self::current().unwrap_or(self).exactly()
    }

    /// Puts these symbols in force in any case: for work that continues on another thread.
    pub(crate) fn exactly(self) -> InForce {
        InForce { before: IN_FORCE.replace(self), of_this_thread: PhantomData }
    }

    /// The letters that are in force on this thread, the usual ones included.
    pub(crate) fn in_force_here() -> Self {
        IN_FORCE.get()
    }

    /// Returns the symbols that differ from the usual ones: each symbol of the answer, and its
    /// spelling.
    pub fn renamed(&self) -> impl Iterator<Item = (Symbol, Symbol)> {
        let pairs = [
            (AMPLITUDE, self.amplitude),
            (FIRST_HARMONIC, self.first_harmonic),
            (FREQUENCY, self.frequency),
        ];
        pairs.into_iter().filter(|(usual, written)| usual != written)
    }

    /// Returns the symbol that a user means by this name beside an equation with these names: one
    /// of the equation, or else the symbol of the answer that is written so.
    pub fn resolve(&self, name: Symbol, names: &[Symbol]) -> Symbol {
        if let Some(own) = names.iter().find(|own| own.name() == name.name()) {
            return *own;
        }
        let written = self.renamed().find(|(_, written)| *written == name);
        written.map_or(name, |(usual, _)| usual)
    }
}

/// The name of a symbol as it is printed on this thread.
pub(super) fn written(symbol: Symbol) -> &'static str {
    let Some(letters) = ResultSymbols::current() else {
        return symbol.name();
    };
    let bare = symbol.0.trim_end_matches('\'');
    let Some((_, letter)) = letters.renamed().find(|(usual, _)| usual.0 == bare) else {
        return symbol.name();
    };
    match symbol.primes() {
        0 => letter.name(),
        primes => Symbol::new(&(letter.name().to_owned() + &"'".repeat(primes))).name(),
    }
}

/// Replaces the usual letter of the frequency in a text by the one that is in force.
pub fn of_frequency(words: &str) -> String {
    words.replace(FREQUENCY.name(), FREQUENCY.written())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_an_answer_give_way_to_those_of_the_equation() {
        let names = |letters: ResultSymbols| {
            [letters.amplitude, letters.first_harmonic, letters.frequency].map(Symbol::name)
        };
        assert_eq!(names(ResultSymbols::avoiding(&["x".into()], false)), ["A", "a", "omega"]);
        let all = ["A", "C", "a", "omega"].map(Symbol::new);
        assert_eq!(names(ResultSymbols::avoiding(&all, false)), ["X", "r", "Omega"]);
        assert_eq!(names(ResultSymbols::avoiding(&all, true)), ["X", "r", "nu"]);
    }

    #[test]
    fn letters_are_in_force_until_they_are_dropped() {
        let (answer, equation) = (Symbol::new("a"), Symbol::new("a").apart());
        assert_eq!(equation.derivative().to_string(), "a'");
        assert_eq!(equation.derivative().coordinate(), equation);
        let letters = ResultSymbols::avoiding(&[equation], false);
        {
            let _letters = letters.in_force();
            assert_eq!(format!("{answer} {} {equation}", answer.derivative()), "r r' a");
            let _others = ResultSymbols::avoiding(&["omega".into()], false).in_force();
            assert_eq!(answer.to_string(), "r");
        }
        assert_eq!(answer.to_string(), "a");
        assert_eq!(letters.resolve("r".into(), &[equation]), answer);
        assert_eq!(letters.resolve("a".into(), &[equation]), equation);
    }
}
