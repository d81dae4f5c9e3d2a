//! Slow equations in the plane of `u` and `v` at numbers, and all places where both rates vanish.
//!
//! ```text
//! u' = U(u, v),  v' = V(u, v)          polynomials;   u = a cos(theta),  v = -a sin(theta),  theta = psi/p
//! (U + i V) e^(i theta) = a' - i a theta' = sum of c_m(a) e^(i m theta)
//! one wave, m = 0 and +-g alone:       D cos(g theta) = P_s Q - P Q_s,  D sin(g theta) = P Q_c - P_c Q,  D = P_c Q_s - P_s Q_c
//!                                      cos^2 + sin^2 = 1 is a polynomial in a, all of whose positive roots are found
//! several waves:                       squares of the plane are divided until a square has no root, or one to which Newton's method leads
//! ```
//!
//! A square with the centre `c` and half the width `h` has no root where `|U(c)|` exceeds the sum
//! of the sizes of all other terms of its Taylor polynomial there; nor where that is so of the
//! equations multiplied by the inverse of their slopes at `c`. It has at most one where the terms
//! above the linear ones change the slopes of the latter by less than one.
//!
//! Reference: R. E. Moore, R. B. Kearfott, M. J. Cloud, *Introduction to Interval Analysis*, SIAM
//! 2009, chapter 8.

use std::collections::{BTreeMap, VecDeque};

use nalgebra::{Matrix2, Vector2};
use num_integer::Integer as _;

use super::Solution;
use super::response::Plane;
use crate::exact::Polynomial;
use crate::numeric::ode::polynomial::real_zeros;
use crate::numeric::ode::root::find_root;
use crate::symbol::Symbol;

/// A polynomial in `u` and `v` with numbers as coefficients.
#[derive(Clone, Debug)]
pub(super) struct PlanePolynomial(Vec<(f64, [i32; 2])>);

impl PlanePolynomial {
    /// `None` if a value is missing.
    pub(super) fn new(
        solution: &Solution,
        polynomial: &Polynomial,
        [u, v]: [Symbol; 2],
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<Self> {
        let mut coefficients: BTreeMap<[i32; 2], Polynomial> = BTreeMap::new();
        for (monomial, number) in polynomial.terms() {
            let exponents = [u, v].map(|name| monomial.exponent(name));
            let rest = monomial.without(u).without(v);
            let coefficient = coefficients.entry(exponents).or_insert_with(num_traits::Zero::zero);
            coefficient.add_term(rest, number.clone());
        }
        let value = |(exponents, coefficient): (&[i32; 2], &Polynomial)| {
            Some((solution.evaluate(coefficient, value_of).ok()?, *exponents))
        };
        coefficients.iter().map(value).collect::<Option<_>>().map(Self)
    }

    /// The value, and the slopes by both coordinates.
    fn value_and_slopes(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (factor, [i, j]) in &self.0 {
            sum[0] += factor * u.powi(*i) * v.powi(*j);
            if *i > 0 {
                sum[1] += factor * f64::from(*i) * u.powi(i - 1) * v.powi(*j);
            }
            if *j > 0 {
                sum[2] += factor * f64::from(*j) * u.powi(*i) * v.powi(j - 1);
            }
        }
        sum
    }

    /// The sum of the sizes of its terms above a degree, on the circle of this radius.
    pub(super) fn size_above(&self, degree: i32, radius: f64) -> f64 {
        let across = radius * std::f64::consts::FRAC_1_SQRT_2;
        let terms = self.0.iter().filter(|(_, [i, j])| i + j > degree);
        terms.map(|(factor, [i, j])| factor.abs() * across.powi(i + j)).sum()
    }

    fn degree(&self) -> i32 {
        let terms = self.0.iter().filter(|(factor, _)| *factor != 0.0);
        terms.map(|(_, [i, j])| i + j).max().unwrap_or(0)
    }

    /// The coefficients of `(u - u_0)^i (v - v_0)^j`, by `i` and `j`.
    fn about(&self, [u, v]: [f64; 2]) -> Vec<Vec<f64>> {
        let degree = self.degree().unsigned_abs() as usize;
        let mut table = vec![vec![0.0; degree + 1]; degree + 1];
        for (factor, [i, j]) in self.0.iter().filter(|(factor, _)| *factor != 0.0) {
            table[i.unsigned_abs() as usize][j.unsigned_abs() as usize] += factor;
        }
        // Horner's scheme, in one coordinate after the other.
        for k in 0..degree {
            for i in (k..degree).rev() {
                let (lower, higher) = table.split_at_mut(i + 1);
                for (coefficient, next) in lower[i].iter_mut().zip(&higher[0]) {
                    *coefficient += u * next;
                }
            }
        }
        for row in &mut table {
            for k in 0..degree {
                for j in (k..degree).rev() {
                    row[j] += v * row[j + 1];
                }
            }
        }
        table
    }
}

/// A polynomial in the amplitude, the constant first, and the polynomial of the sums of absolute
/// values from which its coefficients were added up.
#[derive(Clone, Default)]
struct AmplitudePolynomial {
    coefficients: Vec<f64>,
    sizes: Vec<f64>,
}

impl AmplitudePolynomial {
    fn add(&mut self, power: usize, value: f64) {
        if self.coefficients.len() <= power {
            self.coefficients.resize(power + 1, 0.0);
            self.sizes.resize(power + 1, 0.0);
        }
        self.coefficients[power] += value;
        self.sizes[power] += value.abs();
    }

    /// Sets coefficients to zero that are only the rounding error of terms that cancel.
    fn without_rounding_noise(mut self) -> Self {
        const ROUNDING: f64 = 1e-13;
        for (value, size) in self.coefficients.iter_mut().zip(&self.sizes) {
            if value.abs() <= ROUNDING * size {
                *value = 0.0;
            }
        }
        self
    }

    fn product(&self, other: &Self) -> Self {
        let mut found = Self::default();
        for (i, one) in self.coefficients.iter().enumerate() {
            for (j, another) in other.coefficients.iter().enumerate() {
                found.add(i + j, one * another);
            }
        }
        found
    }

    /// `self - other`.
    fn minus(mut self, other: &Self) -> Self {
        for (power, (value, size)) in other.coefficients.iter().zip(&other.sizes).enumerate() {
            self.add(power, -value);
            self.sizes[power] += size - value.abs();
        }
        self.without_rounding_noise()
    }

    fn is_zero(&self) -> bool {
        self.coefficients.iter().all(|value| *value == 0.0)
    }

    fn value(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }
}

/// One wave of the phase, `P + P_c cos(g theta) + P_s sin(g theta)`, in powers of the amplitude.
type PhaseWave = [AmplitudePolynomial; 3];

/// Slow equations in the plane at numbers.
pub(super) struct PlaneField {
    rates: [PlanePolynomial; 2],
    /// `p`: the phase of the slow equations in terms of the angle in the plane.
    times: f64,
}

impl PlaneField {
    /// `None` if a value is missing.
    pub(super) fn new(
        solution: &Solution,
        plane: &Plane,
        times: f64,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<Self> {
        let numeric =
            |rate: &Polynomial| PlanePolynomial::new(solution, rate, plane.coordinates, value_of);
        let [u, v] = plane.rates.each_ref().map(numeric);
        let rates = [u?, v?];
        let finite = rates.iter().flat_map(|rate| &rate.0).all(|(factor, _)| factor.is_finite());
        finite.then_some(Self { rates, times })
    }

    /// Both rates.
    pub(super) fn rates_at(&self, place: [f64; 2]) -> [f64; 2] {
        self.rates.each_ref().map(|rate| rate.value_and_slopes(place)[0])
    }

    fn jacobian(&self, place: [f64; 2]) -> Matrix2<f64> {
        let [[_, a, b], [_, c, d]] = self.rates.each_ref().map(|rate| rate.value_and_slopes(place));
        Matrix2::new(a, b, c, d)
    }

    /// The eigenvalues about a place: the larger first; of a pair that with the positive imaginary
    /// part.
    pub(super) fn eigenvalues(&self, place: [f64; 2]) -> [(f64, f64); 2] {
        let found = self.jacobian(place).complex_eigenvalues();
        let mut both = [(found[0].re, found[0].im), (found[1].re, found[1].im)];
        let size = |(real, imaginary): (f64, f64)| real.hypot(imaginary);
        let angle =
            |(real, imaginary): (f64, f64)| imaginary.atan2(real).rem_euclid(std::f64::consts::TAU);
        both.sort_by(|one, other| {
            let sizes = size(*other).total_cmp(&size(*one));
            sizes.then(angle(*one).total_cmp(&angle(*other)))
        });
        both
    }

    /// Every place other than the origin where both rates vanish; of those that a rotational
    /// symmetry maps onto one another only one.
    pub(super) fn places_of_rest(&self) -> Vec<[f64; 2]> {
        let mut found = match self.on_one_wave() {
            Some(found) => found,
            None => self.in_squares(),
        };
        let turn =
            |[u, v]: &[f64; 2]| (self.times * (-v).atan2(*u)).rem_euclid(std::f64::consts::TAU);
        found.sort_by(|one, other| turn(one).total_cmp(&turn(other)));
        found
    }

    /// `a'` and `a theta'` by harmonics of the angle in the plane: the coefficients of cosine and
    /// sine in powers of the amplitude.
    fn harmonics(&self) -> BTreeMap<i32, [[AmplitudePolynomial; 2]; 2]> {
        let mut found: BTreeMap<i32, [[AmplitudePolynomial; 2]; 2]> = BTreeMap::new();
        for (rate, polynomial) in self.rates.iter().enumerate() {
            for (factor, [i, j]) in &polynomial.0 {
                let power = (i + j).unsigned_abs() as usize;
                for (k, number) in expanded([*i, *j]) {
                    // u^i v^j = (a/2)^(i + j) i^j (z + 1/z)^i (z - 1/z)^j, V stands with another i,
                    // and z = e^(i theta) multiplies all.
                    let value = factor * number / 2.0_f64.powi(i + j);
                    let m = k + 1;
                    // Real and imaginary part of i to its power times the number.
                    let (real, imaginary) = match (*j + i32::from(rate == 1)).rem_euclid(4) {
                        0 => (value, 0.0),
                        1 => (0.0, value),
                        2 => (-value, 0.0),
                        _ => (0.0, -value),
                    };
                    let sign = if m < 0 { -1.0 } else { 1.0 };
                    let [[rate_cos, rate_sin], [turn_cos, turn_sin]] =
                        found.entry(m.abs()).or_default();
                    rate_cos.add(power, real);
                    turn_cos.add(power, -imaginary);
                    if m != 0 {
                        rate_sin.add(power, -sign * imaginary);
                        turn_sin.add(power, -sign * real);
                    }
                }
            }
        }
        found
            .into_iter()
            .map(|(m, rates)| {
                (m, rates.map(|waves| waves.map(AmplitudePolynomial::without_rounding_noise)))
            })
            .collect()
    }

    /// The places by one polynomial in the amplitude; `None` if the rates have more than one wave
    /// of the phase, or one that does not determine the phase.
    fn on_one_wave(&self) -> Option<Vec<[f64; 2]>> {
        let mut harmonics = self.harmonics();
        harmonics.retain(|m, rates| {
            *m == 0 || !rates.iter().flatten().all(AmplitudePolynomial::is_zero)
        });
        let still = harmonics.remove(&0).unwrap_or_default();
        let common = harmonics.keys().fold(0, |common: i32, m| common.gcd(m));
        if common == 0 {
            return Some(vec![]);
        }
        if harmonics.len() > 1 {
            return None;
        }
        let [[rate_cos, rate_sin], [turn_cos, turn_sin]] = harmonics.remove(&common)?;
        let [[rate, _], [turn, _]] = still;
        let waves: [PhaseWave; 2] = [[rate, rate_cos, rate_sin], [turn, turn_cos, turn_sin]];
        let [determinant, cosine, sine] = solved(&waves);
        if determinant.is_zero() {
            return None;
        }
        let squares = [&cosine, &sine, &determinant].map(|part| part.product(part));
        let [cosine_squared, sine_squared, one] = squares;
        let sum = one.minus(&cosine_squared).minus(&sine_squared);
        let mut places: Vec<[f64; 2]> = vec![];
        for amplitude in amplitudes(&sum.coefficients) {
            let [determinant, cosine, sine] =
                [&determinant, &cosine, &sine].map(|part| part.value(amplitude));
            if determinant == 0.0 {
                continue;
            }
            let angle = (sine / determinant).atan2(cosine / determinant);
            let turns = (0..common)
                .map(|k| (angle + std::f64::consts::TAU * f64::from(k)) / f64::from(common));
            for angle in turns {
                self.keep(self.settled_from(on_circle(amplitude, angle)), amplitude, &mut places);
            }
        }
        Some(places)
    }

    /// Adds a place to `known` if it is near this radius and not known yet.
    fn keep(&self, place: Option<[f64; 2]>, radius: f64, known: &mut Vec<[f64; 2]>) {
        const NEAR: f64 = 1e-4;
        const SAME: f64 = 1e-8;
        let Some([u, v]) = place else { return };
        let size = u.hypot(v);
        let turned = |[x, y]: &[f64; 2]| {
            let times = self.times.round().abs().max(1.0) as u32;
            let near = |k: u32| {
                let (sin, cos) =
                    (std::f64::consts::TAU * f64::from(k) / f64::from(times)).sin_cos();
                (cos * x - sin * y - u).hypot(sin * x + cos * y - v) <= SAME * size
            };
            (0..times).any(near)
        };
        if size > 0.0 && (size / radius - 1.0).abs() < NEAR && !known.iter().any(turned) {
            known.push([u, v]);
        }
    }

    /// Newton's iteration from `start` to a place where both rates vanish; `None` if it does not
    /// converge.
    fn settled_from(&self, start: [f64; 2]) -> Option<[f64; 2]> {
        const STEPS: usize = 40;
        /// Largest step, relative to the place, that may be due to rounding, even where two steady
        /// motions meet.
        const SETTLED: f64 = 1e-6;
        let mut place = start;
        let (mut radius, mut moved) = (start[0].hypot(start[1]), f64::INFINITY);
        for _ in 0..STEPS {
            let [u, v] = self.rates_at(place);
            let step = self.jacobian(place).try_inverse()? * Vector2::new(u, v);
            place = [place[0] - step[0], place[1] - step[1]];
            moved = step.norm();
            radius = radius.max(place[0].hypot(place[1]));
            if moved <= 1e-15 * radius {
                break;
            }
        }
        (moved <= SETTLED * radius).then_some(place)
    }

    /// A radius beyond which the terms of the highest degree outweigh all others, as far as they
    /// vanish nowhere on it.
    fn outer_radius(&self) -> f64 {
        const ANGLES: usize = 72;
        /// Least value of the terms of the highest degree, as a fraction of the sum of their sizes,
        /// that is used where they almost vanish.
        const LEAST: f64 = 1e-2;
        let degree = self.rates.iter().map(PlanePolynomial::degree).max().unwrap_or(0);
        let size = |wanted: &dyn Fn(i32) -> bool, radius: f64| -> f64 {
            let terms = self.rates.iter().flat_map(|rate| &rate.0);
            let terms = terms.filter(|(_, [i, j])| wanted(i + j));
            terms.map(|(factor, [i, j])| factor.abs() * radius.powi(i + j)).sum()
        };
        let leading = |k: usize| {
            let place = on_circle(1.0, std::f64::consts::TAU * k as f64 / ANGLES as f64);
            let value = |rate: &PlanePolynomial| -> f64 {
                let terms = rate.0.iter().filter(|(_, [i, j])| i + j == degree);
                terms.map(|(factor, [i, j])| factor * place[0].powi(*i) * place[1].powi(*j)).sum()
            };
            self.rates.each_ref().map(value).into_iter().fold(0.0, f64::hypot)
        };
        let least = (0..ANGLES).map(leading).fold(f64::INFINITY, f64::min);
        let least = least.max(LEAST * size(&|own| own == degree, 1.0));
        let excess = |log: f64| {
            let radius = log.exp();
            let (own, others) = (least * radius.powi(degree), size(&|own| own < degree, radius));
            (own - others) / (own + others)
        };
        /// Logarithms of the smallest and the largest radius.
        const RANGE: [f64; 2] = [-40.0, 40.0];
        match excess(RANGE[0]) < 0.0 {
            true => find_root(excess, RANGE[0], RANGE[1]).map_or(1.0, f64::exp),
            false => RANGE[0].exp(),
        }
    }

    /// All places by dividing squares of the plane.
    fn in_squares(&self) -> Vec<[f64; 2]> {
        /// Largest numbers of squares examined, and of halvings of one.
        const MOST: usize = 40_000;
        const DEEPEST: u32 = 40;
        /// Distance from the origin, as a fraction of the largest square, below which a place is
        /// the origin up to rounding.
        const ORIGIN: f64 = 1e-10;
        let mut places: Vec<[f64; 2]> = vec![];
        let half = self.outer_radius();
        let is_elsewhere = |[u, v]: &[f64; 2]| u.hypot(*v) > ORIGIN * half;
        let mut squares = VecDeque::from([([0.0, 0.0], half, 0)]);
        let mut count = 0;
        while let Some((centre, half, depth)) = squares.pop_front() {
            count += 1;
            match self.look_at(centre, half) {
                Look::Nothing => {}
                Look::AtMostOne => {
                    let near = |[u, v]: &[f64; 2]| {
                        (u - centre[0]).abs().max((v - centre[1]).abs()) <= 1.5 * half
                    };
                    let found = self.settled_from(centre).filter(near).filter(is_elsewhere);
                    let radius = found.map_or(1.0, |[u, v]| u.hypot(v));
                    self.keep(found, radius, &mut places);
                }
                Look::Unknown if depth >= DEEPEST || count + squares.len() > MOST => {
                    let found = self.settled_from(centre).filter(is_elsewhere);
                    let radius = centre[0].hypot(centre[1]);
                    self.keep(found, radius, &mut places);
                }
                Look::Unknown => {
                    let quarter = half / 2.0;
                    for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                        let centre = [centre[0] + x * quarter, centre[1] + y * quarter];
                        squares.push_back((centre, quarter, depth + 1));
                    }
                }
            }
        }
        places
    }

    fn look_at(&self, centre: [f64; 2], half: f64) -> Look {
        let tables = self.rates.each_ref().map(|rate| rate.about(centre));
        let terms = |table: &[Vec<f64>]| -> Vec<(usize, usize, f64)> {
            let rows = table.iter().enumerate();
            rows.flat_map(|(i, row)| row.iter().enumerate().map(move |(j, value)| (i, j, *value)))
                .collect()
        };
        let power = |k: usize| half.powi(i32::try_from(k).unwrap_or(i32::MAX));
        let excluded = |table: &[Vec<f64>]| {
            let terms = terms(table);
            let others: f64 =
                terms.iter().skip(1).map(|(i, j, value)| value.abs() * power(i + j)).sum();
            table[0][0].abs() > others
        };
        if tables.iter().any(|table| excluded(table)) {
            return Look::Nothing;
        }
        let entry = |table: &[Vec<f64>], i: usize, j: usize| -> f64 {
            table.get(i).and_then(|row| row.get(j)).copied().unwrap_or(0.0)
        };
        let [one, other] = &tables;
        let slopes = Matrix2::new(
            entry(one, 1, 0),
            entry(one, 0, 1),
            entry(other, 1, 0),
            entry(other, 0, 1),
        );
        let Some(inverse) =
            slopes.try_inverse().filter(|inverse| inverse.iter().all(|value| value.is_finite()))
        else {
            return Look::Unknown;
        };
        let highest = one.len().max(other.len());
        let mut changes: f64 = 0.0;
        for row in 0..2 {
            let (mut rest, mut change) = (0.0, 0.0);
            for i in 0..highest {
                for j in 0..highest {
                    if i + j >= 2 {
                        let value = inverse[(row, 0)] * entry(one, i, j)
                            + inverse[(row, 1)] * entry(other, i, j);
                        rest += value.abs() * power(i + j);
                        change += (i + j) as f64 * value.abs() * power(i + j - 1);
                    }
                }
            }
            let centre = inverse[(row, 0)] * one[0][0] + inverse[(row, 1)] * other[0][0];
            if centre.abs() > half + rest {
                return Look::Nothing;
            }
            changes = changes.max(change);
        }
        match changes < 0.5 {
            true => Look::AtMostOne,
            false => Look::Unknown,
        }
    }
}

/// The roots in a square, as far as bounds tell.
enum Look {
    Nothing,
    AtMostOne,
    Unknown,
}

/// `D`, `D cos(g theta)` and `D sin(g theta)`.
fn solved(
    [[rate, rate_cos, rate_sin], [turn, turn_cos, turn_sin]]: &[PhaseWave; 2],
) -> [AmplitudePolynomial; 3] {
    [
        rate_cos.product(turn_sin).minus(&rate_sin.product(turn_cos)),
        rate_sin.product(turn).minus(&rate.product(turn_sin)),
        turn_cos.product(rate).minus(&rate_cos.product(turn)),
    ]
}

/// `(z + 1/z)^i (z - 1/z)^j` by powers of `z`.
fn expanded([i, j]: [i32; 2]) -> BTreeMap<i32, f64> {
    let mut product = BTreeMap::from([(0, 1.0)]);
    for sign in std::iter::repeat_n(1.0, i.unsigned_abs() as usize)
        .chain(std::iter::repeat_n(-1.0, j.unsigned_abs() as usize))
    {
        let mut next: BTreeMap<i32, f64> = BTreeMap::new();
        for (k, value) in product {
            *next.entry(k + 1).or_default() += value;
            *next.entry(k - 1).or_default() += sign * value;
        }
        product = next;
    }
    product
}

/// The positive roots of a polynomial in the amplitude, of one in its square where it has no odd
/// powers.
fn amplitudes(relation: &[f64]) -> Vec<f64> {
    let lowest = relation.iter().position(|value| *value != 0.0).unwrap_or(0);
    let relation = &relation[lowest..];
    let odd = relation.iter().skip(1).step_by(2).any(|value| *value != 0.0);
    match odd {
        true => positive_roots(relation),
        false => {
            let in_square: Vec<f64> = relation.iter().step_by(2).copied().collect();
            positive_roots(&in_square).into_iter().map(f64::sqrt).collect()
        }
    }
}

/// The positive roots of a polynomial where it changes its sign, lowest coefficient first.
fn positive_roots(coefficients: &[f64]) -> Vec<f64> {
    let zeros = real_zeros(coefficients, [0.0, f64::INFINITY]).into_iter();
    zeros.filter(|zero| zero.crosses).map(|zero| zero.place).collect()
}

/// `u` and `v` of a radius and an angle.
fn on_circle(radius: f64, angle: f64) -> [f64; 2] {
    [radius * angle.cos(), -radius * angle.sin()]
}
