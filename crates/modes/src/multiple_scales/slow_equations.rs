//! The rates of amplitudes and phases, and the motion, from the orders of the expansion.
//!
//! ```text
//! B_j = (a_j/2) e^(i phi_j):   a_j' + i a_j phi_j' = 2 e^(-i phi_j) sum D_n B_j
//! ```
//!
//! The phases occur in few combinations alone, whose whole-number coefficients make a lattice. The
//! slow phases are a basis of it: combinations that occur, if these are one.

use std::collections::{BTreeMap, BTreeSet};

use num_traits::{ToPrimitive, Zero};

use super::expansion::{Expansion, Problem, is_first};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial, Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// A sum of cosines and sines of whole combinations of phases, by the combination; that without any
/// phase has no sine.
pub type PhaseWaves = BTreeMap<Vec<i32>, [Polynomial; 2]>;

/// The rates of the amplitude and of the phase of a mode, in the slow phases.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowRate {
    /// `a_j'`.
    pub amplitude: PhaseWaves,
    /// `a_j phi_j'`.
    pub phase: PhaseWaves,
}

/// Amplitudes and phases by name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PolarNames {
    /// `B_j` and its conjugate.
    pub(super) complex: Vec<[Symbol; 2]>,
    /// `a_j`.
    pub(super) amplitudes: Vec<Symbol>,
    /// `phi_j`.
    pub(super) phases: Vec<Symbol>,
}

impl PolarNames {
    /// A monomial in the real amplitudes with its factor, and the combination of phases with which it
    /// turns.
    fn polar(&self, monomial: &Monomial) -> (Monomial, Rational, Vec<i32>) {
        let mut rest = monomial.clone();
        let mut halves = 0;
        let mut turns = Vec::new();
        for ([own, conjugate], amplitude) in self.complex.iter().zip(&self.amplitudes) {
            let (p, q) = (monomial.exponent(*own), monomial.exponent(*conjugate));
            rest = rest
                .without(*own)
                .without(*conjugate)
                .product(&Monomial::power_of(*amplitude, p + q));
            halves += p + q;
            turns.push(p - q);
        }
        (rest, ratio(1, 2).pow(halves), turns)
    }
}

/// Adds `value e^(i turns)`: its real part to the first sum, its imaginary part to the second.
fn add_turning(sums: [&mut PhaseWaves; 2], value: &ComplexPolynomial, turns: Vec<i32>) {
    let [real, imaginary] = sums;
    let first = is_first(&turns);
    let turns = if first { turns } else { turns.iter().map(|m| -m).collect() };
    let sign = |part: &Polynomial, positive: bool| {
        let mut part = part.clone();
        if !positive {
            part.negate();
        }
        part
    };
    let zero = || [Polynomial::zero(), Polynomial::zero()];
    // (r + i m)(cos +- i sin)
    let entry = real.entry(turns.clone()).or_insert_with(zero);
    entry[0].accumulate(&value.real);
    entry[1].accumulate(&sign(&value.imaginary, !first));
    let entry = imaginary.entry(turns).or_insert_with(zero);
    entry[0].accumulate(&value.imaginary);
    entry[1].accumulate(&sign(&value.real, first));
}

/// The sum without waves that vanish.
fn cleared(mut waves: PhaseWaves) -> PhaseWaves {
    for (turns, [_, sine]) in &mut waves {
        if turns.iter().all(|m| *m == 0) {
            *sine = Polynomial::zero();
        }
    }
    waves.retain(|_, parts| !parts.iter().all(Zero::is_zero));
    waves
}

/// The rates of each mode in the phases `phi`, of the orders that are wanted.
pub(super) fn rates(
    expansion: &Expansion,
    names: &PolarNames,
    wanted: impl Fn(usize) -> bool,
) -> Vec<SlowRate> {
    (0..names.amplitudes.len())
        .map(|mode| {
            let (mut amplitude, mut phase) = (PhaseWaves::new(), PhaseWaves::new());
            let orders = expansion.rates.iter().enumerate().filter(|(order, _)| wanted(*order));
            for (_, rates) in orders {
                let rate = &rates[mode];
                for (part, imaginary) in [(&rate.real, false), (&rate.imaginary, true)] {
                    for (monomial, number) in part.terms() {
                        let (monomial, factor, mut turns) = names.polar(monomial);
                        turns[mode] -= 1;
                        let term = Polynomial::term(monomial, number * factor * ratio(2, 1));
                        let value = ComplexPolynomial::real(term);
                        let value = if imaginary { value.times_i() } else { value };
                        add_turning([&mut amplitude, &mut phase], &value, turns);
                    }
                }
            }
            SlowRate { amplitude: cleared(amplitude), phase: cleared(phase) }
        })
        .collect()
}

/// A basis of the combinations of phases that occur.
pub(super) fn slow_phases(rates: &[SlowRate]) -> Vec<Vec<i32>> {
    /// The number of choices that are tried.
    const MOST: usize = 20_000;
    let occurring: BTreeSet<Vec<i32>> = rates
        .iter()
        .flat_map(|rate| rate.amplitude.keys().chain(rate.phase.keys()))
        .filter(|turns| turns.iter().any(|m| *m != 0))
        .cloned()
        .collect();
    let reduced = reduced_rows(occurring.iter().cloned().collect());
    let mut candidates: Vec<Vec<i32>> = occurring.into_iter().collect();
    candidates.sort_by_key(|turns| {
        (turns.iter().map(|m| m.abs()).sum::<i32>(), turns.iter().map(|m| -m).collect::<Vec<_>>())
    });
    let mut tried = 0;
    let mut chosen = Vec::new();
    match chooses(&candidates, &reduced, &mut chosen, &mut tried, MOST) {
        true => chosen.into_iter().map(|index: usize| candidates[index].clone()).collect(),
        false => reduced,
    }
}

/// Chooses rows that are a basis of the lattice with these reduced rows.
fn chooses(
    candidates: &[Vec<i32>],
    reduced: &[Vec<i32>],
    chosen: &mut Vec<usize>,
    tried: &mut usize,
    most: usize,
) -> bool {
    if chosen.len() == reduced.len() {
        *tried += 1;
        let rows = chosen.iter().map(|index| candidates[*index].clone()).collect();
        return reduced_rows(rows) == reduced;
    }
    let from = chosen.last().map_or(0, |last| last + 1);
    for next in from..candidates.len() {
        if *tried > most {
            return false;
        }
        chosen.push(next);
        if chooses(candidates, reduced, chosen, tried, most) {
            return true;
        }
        chosen.pop();
    }
    false
}

/// The Hermite normal form of rows of whole numbers, without rows of zeros (H. Cohen, *A Course in
/// Computational Algebraic Number Theory*, 1993, section 2.4.2).
pub(super) fn reduced_rows(mut rows: Vec<Vec<i32>>) -> Vec<Vec<i32>> {
    let width = rows.first().map_or(0, Vec::len);
    let mut done = 0;
    for column in 0..width {
        loop {
            let smallest = (done..rows.len())
                .filter(|row| rows[*row][column] != 0)
                .min_by_key(|row| rows[*row][column].abs());
            let Some(smallest) = smallest else { break };
            rows.swap(done, smallest);
            if rows[done][column] < 0 {
                rows[done].iter_mut().for_each(|m| *m = -*m);
            }
            let pivot = rows[done].clone();
            let mut left = false;
            for (index, row) in rows.iter_mut().enumerate() {
                if index != done && (index < done || row[column] != 0) {
                    let times = row[column].div_euclid(pivot[column]);
                    row.iter_mut().zip(&pivot).for_each(|(m, own)| *m -= times * own);
                    left |= index > done && row[column] != 0;
                }
            }
            if !left {
                done += 1;
                break;
            }
        }
    }
    rows.truncate(done);
    rows
}

/// Rates with their combinations of `phi` written in the slow phases.
pub(super) fn in_slow_phases(rate: &SlowRate, basis: &[Vec<i32>]) -> SlowRate {
    let rewritten = |waves: &PhaseWaves| {
        let mut result = PhaseWaves::new();
        for (turns, [cosine, sine]) in waves {
            let mut turns = coordinates(turns, basis);
            let mut sine = sine.clone();
            if !is_first(&turns) {
                turns.iter_mut().for_each(|m| *m = -*m);
                sine.negate();
            }
            let zero = || [Polynomial::zero(), Polynomial::zero()];
            let entry = result.entry(turns).or_insert_with(zero);
            entry[0].accumulate(cosine);
            entry[1].accumulate(&sine);
        }
        result
    };
    SlowRate { amplitude: rewritten(&rate.amplitude), phase: rewritten(&rate.phase) }
}

/// The whole numbers by which a combination is a sum of those of a basis.
fn coordinates(turns: &[i32], basis: &[Vec<i32>]) -> Vec<i32> {
    let mut rows: Vec<Vec<Rational>> = (0..turns.len())
        .map(|place| {
            let own = basis.iter().map(|row| row[place]).chain([turns[place]]);
            own.map(|m| ratio(i64::from(m), 1)).collect()
        })
        .collect();
    let mut found = vec![0; basis.len()];
    let mut done = 0;
    let mut pivots = Vec::new();
    for column in 0..basis.len() {
        let Some(pivot) = (done..rows.len()).find(|row| !rows[*row][column].is_zero()) else {
            continue;
        };
        rows.swap(done, pivot);
        let scale = rows[done][column].clone();
        rows[done].iter_mut().for_each(|entry| *entry = &*entry / &scale);
        let own = rows[done].clone();
        for (index, row) in rows.iter_mut().enumerate() {
            if index != done && !row[column].is_zero() {
                let factor = row[column].clone();
                for (entry, own) in row.iter_mut().zip(&own) {
                    *entry = &*entry - &factor * own;
                }
            }
        }
        pivots.push(column);
        done += 1;
    }
    for (row, column) in pivots.into_iter().enumerate() {
        found[column] = rows[row][basis.len()].to_integer().to_i32().unwrap_or(0);
    }
    found
}

/// A sum of waves as an expression, each part times a factor.
pub(super) fn expression(
    waves: &PhaseWaves,
    phases: &[Symbol],
    part: &dyn Fn(&Polynomial) -> Expr,
) -> Result<Expr, ExprError> {
    let mut terms = Vec::new();
    for (turns, [cosine, sine]) in waves {
        let angle = combination(turns, phases);
        for (polynomial, wave) in [(cosine, angle.cos()?), (sine, angle.sin()?)] {
            for polynomial in readable(polynomial) {
                terms.push(&part(&polynomial) * &wave);
            }
        }
    }
    Ok(Expr::sum(terms))
}

/// The parts of a polynomial whose common factor is readable: the whole, or its terms where its numbers
/// are rounded.
fn readable(polynomial: &Polynomial) -> Vec<Polynomial> {
    /// The length of denominators in binary digits beyond which they stand for decimals.
    const LONGEST: u64 = 40;
    let rounded = polynomial.terms().any(|(_, number)| number.denom().bits() > LONGEST);
    match (polynomial.is_zero(), rounded) {
        (true, _) => vec![],
        (false, false) => vec![polynomial.clone()],
        (false, true) => polynomial
            .terms()
            .map(|(monomial, number)| Polynomial::term(monomial.clone(), number.clone()))
            .collect(),
    }
}

/// A whole combination of names.
pub(super) fn combination(turns: &[i32], names: &[Symbol]) -> Expr {
    let own = turns.iter().zip(names).filter(|(m, _)| **m != 0);
    own.map(|(m, name)| Expr::from(i64::from(*m)) * Expr::from(*name)).sum()
}

/// The motion of each coordinate, of the orders up to the highest, in `t`, amplitudes and phases.
pub(super) fn motion(
    problem: &Problem,
    expansion: &Expansion,
    names: &PolarNames,
    shapes: &[Vec<Polynomial>],
    rounded: &dyn Fn(&Polynomial) -> Polynomial,
) -> Result<Vec<Expr>, ExprError> {
    let time = Expr::symbol("t");
    let one = |row: &Vec<Polynomial>| -> Result<Expr, ExprError> {
        let mut waves: BTreeMap<(Vec<i32>, Vec<i32>), [Polynomial; 2]> = BTreeMap::new();
        for (factor, orders) in row.iter().zip(&expansion.displacement) {
            if factor.is_zero() {
                continue;
            }
            let all = orders.iter().flatten().filter(|(wave, _)| is_first(wave));
            for (wave, value) in all {
                let times = if wave.iter().all(|m| *m == 0) { 1 } else { 2 };
                for (part, imaginary) in [(&value.real, false), (&value.imaginary, true)] {
                    for (monomial, number) in part.terms() {
                        let (monomial, half, turns) = names.polar(monomial);
                        let number = number * half * ratio(times, 1);
                        let term = Polynomial::term(monomial, number).product(factor);
                        let zero = || [Polynomial::zero(), Polynomial::zero()];
                        let entry = waves.entry((wave.clone(), turns)).or_insert_with(zero);
                        entry[usize::from(imaginary)].accumulate(&term);
                    }
                }
            }
        }
        let mut terms = Vec::new();
        for ((wave, turns), [real, imaginary]) in &waves {
            let frequency = Expr::from(&rounded(&problem.frequency(wave)));
            let mut angle = &(&frequency * &time) + &combination(turns, &names.phases);
            let mut sign = 1_i64;
            // The wave of the mode itself is first where its row is.
            if angle.has_leading_minus() {
                (angle, sign) = (-&angle, -1);
            }
            terms.push(&Expr::from(&rounded(real)) * &angle.cos()?);
            if !imaginary.is_zero() {
                let factor = &Expr::from(-sign) * &Expr::from(&rounded(imaginary));
                terms.push(&factor * &angle.sin()?);
            }
        }
        Ok(Expr::sum(terms))
    };
    shapes.iter().map(one).collect()
}
