//! Text of sums and Fourier series from their terms, in any notation.

use num_traits::Zero;

use super::FourierSeries;
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Polynomials, Rational};
use crate::symbol::Symbol;

/// The notation of harmonics in a format.
pub struct Notation {
    /// Writes `cos(3*theta)` from `"cos"`, 3 and the name of the phase; it is never called for the
    /// zeroth harmonic.
    pub wave: fn(&str, usize, Symbol) -> String,
    /// The text between coefficient and harmonic.
    pub times: &'static str,
    /// The brackets around a coefficient that is a sum.
    pub brackets: [&'static str; 2],
}

/// Joins terms by their signs; returns `0` if there are none.
pub fn sum(terms: impl IntoIterator<Item = String>) -> String {
    let mut text = String::new();
    for term in terms {
        match (text.is_empty(), term.strip_prefix('-')) {
            (true, _) => text.push_str(&term),
            (false, Some(rest)) => text.extend([" - ", rest]),
            (false, None) => text.extend([" + ", &term]),
        }
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// The terms of a polynomial in the order of `key`.
pub fn in_order(
    polynomial: &Polynomial,
    key: impl Fn(&Monomial) -> i32,
) -> Vec<(&Monomial, &Rational)> {
    let mut terms: Vec<_> = polynomial.terms().collect();
    terms.sort_by_key(|(monomial, _)| key(monomial));
    terms
}

/// Returns the texts of the terms of a Fourier series, each with its minus if it has one; `law`
/// writes a coefficient.
pub fn waves(
    series: &FourierSeries<Polynomials>,
    law: impl Fn(&Polynomial) -> String,
    notation: &Notation,
    phase: Symbol,
) -> Vec<String> {
    let mut waves = Vec::new();
    for (k, cosine, sine) in series.harmonics() {
        for (function, coefficient) in [("cos", cosine), ("sin", sine)] {
            if coefficient.is_zero() {
                continue;
            }
            let text = law(&coefficient);
            if k == 0 {
                waves.push(text);
                continue;
            }
            let wave = (notation.wave)(function, k, phase);
            let [open, close] = notation.brackets;
            waves.push(match (coefficient.single_term().is_some(), text.as_str()) {
                (true, "1") => wave,
                (true, "-1") => format!("-{wave}"),
                (true, _) => format!("{text}{}{wave}", notation.times),
                (false, _) => format!("{open}{text}{close}{}{wave}", notation.times),
            });
        }
    }
    waves
}

/// The lines of a motion: `first` before the first term, `next` before the others, each with its
/// sign.
pub fn lines(waves: &[String], first: &str, next: &str) -> Vec<String> {
    let line = |(index, wave): (usize, &String)| match (index, wave.strip_prefix('-')) {
        (0, _) => format!("{first}{wave}"),
        (_, Some(rest)) => format!("{next}- {rest}"),
        (_, None) => format!("{next}+ {wave}"),
    };
    waves.iter().enumerate().map(line).collect()
}
