//! Resonances between the linear frequencies and those of the drives, and the reference frequencies
//! that obey them.
//!
//! ```text
//! omega2 = 2*omega1,  Omega = omega1 + omega2,  2*omega2 = 3*omega1, ...
//! sum_j m_j omega_j + sum_d n_d Omega_d near 0        for each resonance
//! sum_j m_j nu_j + sum_d n_d Omega_d = 0              exactly
//! ```
//!
//! As many frequencies as there are independent resonances follow from the others, the last modes
//! first; frequencies of drives are kept. The others are bases: each frequency is a sum of fractions of them, so a wave is a row of whole numbers.

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};
use thiserror::Error;

use crate::exact::Rational;
use crate::exact::rational::{Integer, ratio};
use crate::expr::{Expr, parse_equations};
use crate::symbol::Symbol;

/// A linear relation that frequencies obey, or nearly so: the coefficients of the linear frequencies,
/// then of the drives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resonance(pub Vec<i32>);

/// The reason why resonances cannot be asked for.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ResonanceError {
    /// The text is no equation between frequencies.
    #[error(
        "`{text}` is no resonance: a linear equation between {}", .names.join(", ")
    )]
    Form {
        /// The text.
        text: String,
        /// The names of the frequencies.
        names: Vec<String>,
    },
    /// The resonances leave a frequency zero, or follow from each other.
    #[error("the resonances contradict each other, or one follows from the others")]
    Contradiction,
    /// The frequencies are numbers that are far from the resonance.
    #[error("`{resonance}` is far from the frequencies, which miss it by {percent} %")]
    Far {
        /// The resonance.
        resonance: String,
        /// The distance in percent of the largest frequency in it.
        percent: String,
    },
    /// A drive or modes in letters: the resonance has to be named.
    #[error("which resonance is meant? Of the frequencies {} not all are numbers", .names.join(", "))]
    Open {
        /// The names of the frequencies.
        names: Vec<String>,
        /// Resonances that may be meant.
        candidates: Vec<String>,
    },
}

impl ResonanceError {
    /// Returns advice on what to do instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Form { .. } => Some(
                "--resonance \"omega2 = 2*omega1, Omega = omega2\", or `none`; omega1, omega2, ... are the linear frequencies"
                    .to_owned(),
            ),
            Self::Open { candidates, .. } => {
                let shown: Vec<String> =
                    candidates.iter().map(|text| format!("--resonance \"{text}\"")).collect();
                Some(format!("{}, or --resonance none", shown.join(", ")))
            }
            Self::Far { .. } => Some("without --resonance the nearest ones are taken".to_owned()),
            Self::Contradiction => None,
        }
    }
}

/// Frequencies as sums of fractions of bases.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lattice {
    /// The indices of the frequencies that are bases.
    pub(super) bases: Vec<usize>,
    /// The whole number by which each base is divided.
    pub(super) divisor: i64,
    /// Each frequency as a row of whole numbers of the divided bases.
    pub(super) rows: Vec<Vec<i32>>,
}

impl Lattice {
    /// The lattice in which the resonances hold exactly; the first frequencies are those
    /// of modes, the others of drives, whose multiples have these denominators.
    ///
    /// # Errors
    /// [`ResonanceError::Contradiction`].
    pub(super) fn new(
        [modes, count]: [usize; 2],
        resonances: &[Resonance],
        denominators: &Integer,
    ) -> Result<Self, ResonanceError> {
        // Elimination, the modes from the last one on.
        let mut rows: Vec<Vec<Rational>> = resonances
            .iter()
            .map(|resonance| resonance.0.iter().map(|m| ratio(i64::from(*m), 1)).collect())
            .collect();
        let mut pivots: Vec<usize> = Vec::new();
        for row in 0..rows.len() {
            let order = (0..modes).rev();
            let pivot = order
                .filter(|column| !pivots.contains(column))
                .find(|column| !rows[row][*column].is_zero())
                .ok_or(ResonanceError::Contradiction)?;
            let scale = rows[row][pivot].clone();
            rows[row].iter_mut().for_each(|entry| *entry = &*entry / &scale);
            let own = rows[row].clone();
            for (index, other) in rows.iter_mut().enumerate() {
                if index != row && !other[pivot].is_zero() {
                    let factor = other[pivot].clone();
                    for (entry, own) in other.iter_mut().zip(&own) {
                        *entry = &*entry - &factor * own;
                    }
                }
            }
            pivots.push(pivot);
        }
        let bases: Vec<usize> = (0..count).filter(|column| !pivots.contains(column)).collect();
        let in_bases = |column: usize| -> Vec<Rational> {
            match pivots.iter().position(|pivot| *pivot == column) {
                Some(row) => bases.iter().map(|base| -rows[row][*base].clone()).collect(),
                None => bases
                    .iter()
                    .map(|base| if *base == column { Rational::one() } else { Rational::zero() })
                    .collect(),
            }
        };
        let all: Vec<Vec<Rational>> = (0..count).map(in_bases).collect();
        let divisor =
            all.iter().flatten().fold(Integer::one(), |common, number| common.lcm(number.denom()));
        let divisor = divisor.lcm(denominators);
        let whole = |number: &Rational| {
            (number * Rational::from_integer(divisor.clone())).to_integer().to_i32()
        };
        let rows: Option<Vec<Vec<i32>>> =
            all.iter().map(|row| row.iter().map(whole).collect()).collect();
        let rows = rows.ok_or(ResonanceError::Contradiction)?;
        if rows.iter().any(|row| row.iter().all(|entry| *entry == 0)) {
            return Err(ResonanceError::Contradiction);
        }
        let divisor = divisor.to_i64().ok_or(ResonanceError::Contradiction)?;
        Ok(Self { bases, divisor, rows })
    }
}

/// The frequencies among which resonances are sought.
pub(super) struct Frequencies<'a> {
    /// The names by which each may be called, the first of which is printed.
    pub(super) names: Vec<Vec<Expr>>,
    /// The values, where they are numbers.
    pub(super) values: Vec<Option<f64>>,
    /// The number of modes, the first of them.
    pub(super) modes: usize,
    /// The greatest number of factors of a term that may drive a resonance.
    pub(super) degree: i32,
    /// Whether a drive is a force: alone, without a coordinate.
    pub(super) forced: &'a [bool],
}

impl Frequencies<'_> {
    fn called(&self) -> Vec<String> {
        self.names.iter().map(|names| names[0].to_string()).collect()
    }

    /// A resonance the way people write it: `omega2 = 2*omega1`.
    pub(super) fn written(&self, resonance: &Resonance) -> String {
        let names = self.called();
        let mut parts: Vec<(usize, i32)> =
            resonance.0.iter().copied().enumerate().filter(|(_, m)| *m != 0).collect();
        // The drive, or else the last mode, stands on the left.
        parts.reverse();
        let sign = parts.first().map_or(1, |(_, m)| m.signum());
        let side = |positive: bool| -> String {
            let own =
                parts.iter().filter(|(_, m)| (m * sign > 0) == positive).map(|(index, m)| match m
                    .abs()
                {
                    1 => names[*index].clone(),
                    times => format!("{times}*{}", names[*index]),
                });
            let mut own: Vec<String> = own.collect();
            own.sort();
            match own.is_empty() {
                true => "0".to_owned(),
                false => own.join(" + "),
            }
        };
        format!("{} = {}", side(true), side(false))
    }

    /// The resonances in a text.
    ///
    /// # Errors
    /// [`ResonanceError`].
    pub(super) fn parse(&self, text: &str) -> Result<Vec<Resonance>, ResonanceError> {
        if text.trim() == "none" {
            return Ok(vec![]);
        }
        let refused =
            || ResonanceError::Form { text: text.trim().to_owned(), names: self.called() };
        let equations = parse_equations(&text.replace(',', ";")).map_err(|_| refused())?;
        let mut found = Vec::new();
        for (left, right) in equations {
            let difference = (&left - &right).expand().map_err(|_| refused())?;
            let mut row = vec![Rational::zero(); self.names.len()];
            for term in difference.terms() {
                let place = self.names.iter().enumerate().find_map(|(index, names)| {
                    names.iter().find_map(|name| {
                        let quotient = Expr::divide(term, name).ok()?.expand().ok()?;
                        (name.as_number().is_none()).then_some(())?;
                        Some((index, quotient.as_number()?.clone()))
                    })
                });
                let (index, factor) = place.ok_or_else(refused)?;
                row[index] += factor;
            }
            let common = row.iter().fold(Integer::one(), |all, number| all.lcm(number.denom()));
            let row: Option<Vec<i32>> = row
                .iter()
                .map(|number| {
                    (number * Rational::from_integer(common.clone())).to_integer().to_i32()
                })
                .collect();
            let row = row.filter(|row| row.iter().any(|m| *m != 0)).ok_or_else(refused)?;
            found.push(Resonance(row));
        }
        for resonance in &found {
            self.check_near(resonance)?;
        }
        Ok(found)
    }

    /// The distance of the frequencies from a resonance, as a part of the largest term; `None` with
    /// letters.
    fn distance(&self, resonance: &Resonance) -> Option<f64> {
        let terms: Option<Vec<f64>> = resonance
            .0
            .iter()
            .zip(&self.values)
            .filter(|(m, _)| **m != 0)
            .map(|(m, value)| Some(f64::from(*m) * (*value)?))
            .collect();
        let terms = terms?;
        let largest = terms.iter().fold(0.0_f64, |largest, term| largest.max(term.abs()));
        Some((terms.iter().sum::<f64>() / largest).abs())
    }

    fn check_near(&self, resonance: &Resonance) -> Result<(), ResonanceError> {
        /// The largest distance of a resonance that somebody asks for.
        const FAR: f64 = 0.15;
        match self.distance(resonance) {
            Some(distance) if distance > FAR => Err(ResonanceError::Far {
                resonance: self.written(resonance),
                percent: crate::decimal::significant(100.0 * distance, 2),
            }),
            _ => Ok(()),
        }
    }

    /// The resonances that are near: those with the fewest frequencies first, as many as are
    /// independent.
    ///
    /// # Errors
    /// [`ResonanceError::Open`] for a drive in letters.
    pub(super) fn near(&self) -> Result<Vec<Resonance>, ResonanceError> {
        /// The largest distance of a resonance that counts as near.
        const NEAR: f64 = 0.06;
        /// The number of modes above which resonances of three frequencies at most are sought.
        const MANY: usize = 10;
        let open = (self.modes..self.names.len()).any(|index| {
            self.values[index].is_none() || self.values[..self.modes].iter().any(Option::is_none)
        });
        if open {
            let candidates = (self.modes..self.names.len()).flat_map(|drive| {
                let factor = if self.forced[drive - self.modes] { 1 } else { 2 };
                (0..self.modes).map(move |mode| {
                    let mut row = vec![0; self.names.len()];
                    row[mode] = -factor;
                    row[drive] = 1;
                    Resonance(row)
                })
            });
            return Err(ResonanceError::Open {
                names: self.called(),
                candidates: candidates.map(|resonance| self.written(&resonance)).collect(),
            });
        }
        let mut candidates: Vec<(i32, f64, Resonance)> = Vec::new();
        let mut row = vec![0; self.names.len()];
        let size = if self.modes > MANY { 3 } else { self.degree + 1 };
        self.rows(0, size, &mut row, &mut |row| {
            let resonance = Resonance(row.to_vec());
            let size: i32 = row.iter().map(|m| m.abs()).sum();
            if let Some(distance) = self.distance(&resonance).filter(|distance| *distance < NEAR) {
                candidates.push((size, distance, resonance));
            }
        });
        candidates.sort_by(|one, other| {
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)).then(one.2.0.cmp(&other.2.0))
        });
        let mut found: Vec<Resonance> = Vec::new();
        for (_, _, resonance) in candidates {
            found.push(resonance);
            let lattice = Lattice::new([self.modes, self.names.len()], &found, &Integer::one());
            if !lattice.is_ok_and(|lattice| self.keeps_near(&lattice, NEAR)) {
                found.pop();
            }
        }
        Ok(found)
    }

    /// Whether every reference frequency is near that of its mode.
    fn keeps_near(&self, lattice: &Lattice, near: f64) -> bool {
        (0..self.modes).all(|mode| {
            let parts = lattice.rows[mode].iter().zip(&lattice.bases).map(|(times, base)| {
                Some(f64::from(*times) * self.values[*base]? / lattice.divisor as f64)
            });
            match (parts.sum::<Option<f64>>(), self.values[mode]) {
                (Some(reference), Some(own)) => (reference / own - 1.0).abs() <= near,
                _ => true,
            }
        })
    }

    /// All rows of whole numbers with a sum of sizes of two at least, of which the last that is not zero is positive.
    fn rows(&self, place: usize, left: i32, row: &mut Vec<i32>, found: &mut dyn FnMut(&[i32])) {
        if place == row.len() {
            let size: i32 = row.iter().map(|m| m.abs()).sum();
            let last = row.iter().rev().find(|m| **m != 0);
            if size >= 2 && last.is_some_and(|m| m.is_positive()) {
                found(row);
            }
            return;
        }
        for m in -left..=left {
            row[place] = m;
            self.rows(place + 1, left - m.abs(), row, found);
        }
        row[place] = 0;
    }
}

/// The names `omega1`, `omega2`, ... by which linear frequencies may be called.
pub(super) fn alias(number: usize, parameters: &[Symbol]) -> Option<Expr> {
    let name = Symbol::new(&format!("omega{number}"));
    (!parameters.contains(&name)).then(|| Expr::from(name))
}
