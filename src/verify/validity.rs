//! Where a formula holds: the well of the true motion, the amplitude at which a law loses its frequency, the radius of
//! convergence of its series, and the range in which its error stays small.
//!
//! References: C. Domb, M. F. Sykes, Proc. R. Soc. Lond. A 240 (1957) 214-228 (ratios of coefficients); G. N. Mercer,
//! A. J. Roberts, SIAM J. Appl. Math. 50 (1990) 1547-1565, appendix (a pair of complex singularities).
//!
//! ```text
//! escape:      V(A) = least of V at the neighbouring unstable equilibria
//! one singularity at s_0:     c_k/c_(k-1) -> (1/s_0)(1 + b/k + ...)
//! a pair at R e^(+-i phi):    B_k^2 = (c_(k+1) c_(k-1) - c_k^2)/(c_k c_(k-2) - c_(k-1)^2) -> 1/R^2,
//!                             (c_(k-1) B_k/c_k + c_(k+1)/(c_k B_k))/2 -> cos phi
//! ```

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};
use num_traits::Zero;

use super::{VerificationError, formula_frequency, true_frequency};
use crate::decimal::significant;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::expr::Expr;
use crate::method::one_term::{coefficient_by_quadrature, compiled};
use crate::method::{Options, solve};
use crate::ode::quadrature::integrate_smooth;
use crate::ode::root::find_root;
use crate::oscillator::{Oscillator, SmallParameter};
use crate::solution::{AmplitudeConvention, Method, Solution};
use crate::symbol::Symbol;

/// Terms of the exact series from which its radius of convergence is estimated.
const SERIES_TERMS: u32 = 24;

/// One statement on where something holds, and whether the amplitude asked for lies outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// In words and numbers.
    pub text: String,
    /// Whether the values asked for are outside.
    pub outside: bool,
}

/// The well in which a conservative motion swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Well {
    /// The largest amplitude (a size) of a periodic motion released on the side asked for; infinite where none was found.
    pub escape: f64,
    /// The unstable equilibrium, or the end of the force, that sets it.
    pub edge: f64,
    /// Whether the edge is an unstable equilibrium; otherwise the force has no value beyond it.
    pub separatrix: bool,
}

/// How far the search for the edges of a well goes, in units of the amplitude or of one, whichever is larger.
const FARTHEST: f64 = 100.0;

/// The well of `x'' + force(x) = 0` about `equilibrium`, seen from the side of `amplitude`.
pub fn well(force: &dyn Fn(f64) -> f64, equilibrium: f64, amplitude: f64) -> Option<Well> {
    let side = amplitude.signum();
    let own = edge(force, equilibrium, side, amplitude.abs());
    let other = edge(force, equilibrium, -side, amplitude.abs());
    let rise = |to: f64| work(force, equilibrium, to);
    let mut found = own.map(|(edge, separatrix)| Well {
        escape: (edge - equilibrium).abs(),
        edge,
        separatrix,
    });
    // Released on this side, the motion may also leave over the other edge.
    if let Some((edge, true)) = other
        && let Some(height) = rise(edge)
    {
        let limit = found.map_or(FARTHEST * amplitude.abs().max(1.0), |well| well.escape);
        let excess = |size: f64| rise(equilibrium + side * size).map_or(f64::NAN, |own| own - height);
        let top = limit * (1.0 - 1e-12);
        if excess(top) > 1e-9 * height
            && let Ok(escape) = find_root(excess, 1e-9 * limit, top)
        {
            found = Some(Well {
                escape,
                edge,
                separatrix: true,
            });
        }
    }
    found
}

fn work(force: &dyn Fn(f64) -> f64, from: f64, to: f64) -> Option<f64> {
    match integrate_smooth(force, from, to, 1e-10) {
        Ok((value, _)) => Some(value),
        Err(crate::ode::quadrature::QuadratureError::NotConverged { value, .. }) if value.is_finite() => Some(value),
        Err(_) => None,
    }
}

/// The first place on one side where the force turns its sign or ends, and which of the two it is.
fn edge(force: &dyn Fn(f64) -> f64, equilibrium: f64, side: f64, amplitude: f64) -> Option<(f64, bool)> {
    const STEPS_PER_UNIT: f64 = 64.0;
    let unit = amplitude.clamp(1e-3, 1.0);
    let pull = |distance: f64| side * force(equilibrium + side * distance);
    let (mut distance, mut step) = (unit / STEPS_PER_UNIT, unit / STEPS_PER_UNIT);
    while distance < FARTHEST * amplitude.max(1.0) {
        let next = distance + step;
        let there = pull(next);
        if !there.is_finite() {
            // Close in on where the force ends.
            let (mut inside, mut outside) = (distance, next);
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                if pull(middle).is_finite() {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            return Some((equilibrium + side * outside, false));
        }
        if there <= 0.0 {
            let size = find_root(pull, distance, next).ok()?;
            // A change of sign by way of infinity is an end, not an equilibrium.
            let separatrix =
                pull(size).abs() <= 1e3 * pull(distance).abs().max(there.abs()).max(1e-300) && pull(size).abs() < 1.0;
            return Some((equilibrium + side * size, separatrix));
        }
        (distance, step) = (next, step * 1.01);
    }
    None
}

/// The estimate of a series' nearest singularity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity {
    /// Its distance from zero: the radius of convergence.
    pub radius: f64,
    /// Its angle in the complex plane: 0 on the positive axis, pi on the negative one.
    pub angle: f64,
}

/// The nearest singularity of a power series, from its coefficients; `None` where they show no regular pattern.
pub fn nearest_singularity(coefficients: &[f64]) -> Option<Singularity> {
    const LAST: usize = 8;
    if coefficients.len() < 3 * LAST
        || coefficients
            .iter()
            .rev()
            .take(2 * LAST)
            .any(|c| *c == 0.0 || !c.is_finite())
    {
        return None;
    }
    let ratio = |k: usize| coefficients[k] / coefficients[k - 1];
    let last = coefficients.len() - 1;
    let window: Vec<usize> = (last + 1 - LAST..=last).collect();
    let signs: f64 = window.iter().map(|&k| ratio(k).signum()).sum();
    if signs.abs() == LAST as f64 {
        let inverse = extrapolated(&window, &ratio)?;
        // The limit must be near the ratios themselves, or they follow no such law.
        if (inverse / ratio(last)).ln().abs() < 0.5 && inverse * signs > 0.0 {
            let angle = if inverse > 0.0 { 0.0 } else { std::f64::consts::PI };
            return Some(Singularity {
                radius: 1.0 / inverse.abs(),
                angle,
            });
        }
    }
    let c = |k: usize| coefficients[k];
    let squared = |k: usize| (c(k + 1) * c(k - 1) - c(k) * c(k)) / (c(k) * c(k - 2) - c(k - 1) * c(k - 1));
    let window: Vec<usize> = (last - LAST..last).collect();
    if window.iter().any(|&k| squared(k) <= 0.0) {
        return None;
    }
    let size = |k: usize| squared(k).sqrt();
    let inverse = extrapolated(&window, &size)?;
    let cosine = |k: usize| 0.5 * (c(k - 1) * size(k) / c(k) + c(k + 1) / (c(k) * size(k)));
    let mean = window.iter().map(|&k| cosine(k)).sum::<f64>() / window.len() as f64;
    let steady = window.iter().all(|&k| (size(k) / inverse).ln().abs() < 0.5);
    (steady && inverse > 0.0 && mean.abs() <= 1.0).then(|| Singularity {
        radius: 1.0 / inverse,
        angle: mean.acos(),
    })
}

/// The limit of a sequence `limit (1 + b/k + c/k^2)` by least squares over a window.
fn extrapolated(window: &[usize], of: &dyn Fn(usize) -> f64) -> Option<f64> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for &k in window {
        let inverse = 1.0 / k as f64;
        let row = Vector3::new(1.0, inverse, inverse * inverse);
        normal += row * row.transpose();
        right += row * of(k);
    }
    let fitted = normal.lu().solve(&right)?;
    fitted[0].is_finite().then_some(fitted[0])
}

/// What is known of where `solution` holds at these numbers.
pub(super) fn ranges(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    tolerance: f64,
) -> Vec<Range> {
    let mut ranges: Vec<Range> = of_equation(oscillator, solution, numbers).into_iter().collect();
    if solution.limit_cycle.is_some() || solution.amplitude != AmplitudeConvention::Initial {
        return ranges;
    }
    let Some(&amplitude) = numbers.get(&solution.amplitude.symbol()) else {
        return ranges;
    };
    ranges.extend(integral_error(oscillator, solution, numbers));
    let truth = Truth::new(oscillator, solution, numbers);
    let limit = truth.largest_amplitude();
    ranges.extend(vanishing(oscillator, solution, numbers, limit));
    if matches!(solution.method, Method::LindstedtPoincare | Method::Pade) {
        ranges.extend(convergence(oscillator, solution, numbers));
    }
    if let Some(reach) = reach(oscillator, solution, &truth, tolerance) {
        ranges.push(Range {
            text: reach.in_words(tolerance),
            outside: reach.ends_before(amplitude.abs()),
        });
    }
    ranges
}

/// The escape from the well; nothing for motions that are not conservative.
pub(super) fn of_equation(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    let well = well_of(oscillator, solution, numbers)?;
    let amplitude = numbers.get(&solution.amplitude.symbol())?;
    let [escape, edge] = [well.escape, well.edge].map(|value| significant(value, 6));
    let text = match well.separatrix {
        true => format!("periodic for |A| < {escape}: the separatrix passes the unstable equilibrium x = {edge}"),
        false => format!("periodic for |A| < {escape}: the force ends at x = {edge}"),
    };
    Some(Range {
        text,
        outside: amplitude.abs() >= well.escape,
    })
}

/// How good the integral of a law by quadrature is.
fn integral_error(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<Range> {
    let one_term = solution.by_quadrature.is_some()
        && !matches!(
            solution.method,
            Method::Exact | Method::HarmonicBalance | Method::EnergyBalance
        );
    let amplitude = numbers.get(&solution.amplitude.symbol()).filter(|_| one_term)?.abs();
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    let force = compiled(oscillator, &oscillator.force, numbers)?;
    let (value, change) = coefficient_by_quadrature(&|y| force(equilibrium + y), amplitude, 1);
    let error = (change / value).abs().max(1e-15);
    Some(Range {
        text: format!("the integral of the law is good to {error:.0e}"),
        outside: error > 1e-6,
    })
}

fn is_conservative(oscillator: &Oscillator) -> bool {
    oscillator.parts().is_ok_and(|parts| {
        [&parts.inertia, &parts.damping, &parts.forcing]
            .iter()
            .all(|part| part.is_zero())
    })
}

fn well_of(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<Well> {
    if !is_conservative(oscillator) || solution.amplitude != AmplitudeConvention::Initial {
        return None;
    }
    let force = compiled(oscillator, &oscillator.force, numbers)?;
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    well(&force, equilibrium, amplitude)
}

/// The amplitude at which the law's omega^2 reaches zero.
fn vanishing(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    limit: f64,
) -> Option<Range> {
    const STEPS: usize = 64;
    let symbol = solution.amplitude.symbol();
    let amplitude = *numbers.get(&symbol)?;
    // A law beyond the escape of the true motion is of no use, but where it ends is still its own affair.
    let farthest = if limit.is_finite() {
        1.5 * limit
    } else {
        FARTHEST * amplitude.abs()
    };
    let squared = |size: f64| {
        let mut numbers = numbers.clone();
        numbers.insert(symbol, size.copysign(amplitude));
        crate::method::numbers::frequency_squared_of(oscillator, solution, &numbers).unwrap_or(f64::NAN)
    };
    if solution.method == Method::Exact || solution.system.is_some() || solution.by_quadrature.is_some() {
        return None;
    }
    let place = |k: usize| farthest * (k as f64 / STEPS as f64).powi(2);
    let crossing = (1..=STEPS).find(|&k| squared(place(k)) <= 0.0)?;
    let zero = find_root(squared, place(crossing - 1).max(1e-9 * farthest), place(crossing)).ok()?;
    // A sign change by way of infinity is a pole.
    if squared(zero).abs() > 1e-3 {
        return Some(Range {
            text: format!("the formula has a pole at A = {}", significant(zero, 6)),
            outside: amplitude.abs() >= zero,
        });
    }
    Some(Range {
        text: format!("omega^2 of the formula reaches zero at A = {}", significant(zero, 6)),
        outside: amplitude.abs() >= zero,
    })
}

/// The radius of convergence of the exact series behind the formula.
fn convergence(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<Range> {
    let small = solution.small_parameter;
    let in_amplitude = small == solution.amplitude.symbol();
    let order = if in_amplitude {
        2 * SERIES_TERMS + 1
    } else {
        SERIES_TERMS
    };
    let options = Options {
        method: Some(Method::LindstedtPoincare),
        order: Some(order),
        small: Some(small.name().to_owned()),
        ..Options::default()
    };
    // Several symbols make so long a series slow: numbers instead, as exactly as they are given.
    let numerical = with_numbers(oscillator, numbers, small)?;
    let series = solve(&numerical, &options).ok()?;
    let law = series.frequency_squared.as_ref()?;
    let even = in_amplitude && law.terms().all(|(monomial, _)| monomial.exponent(small) % 2 == 0);
    let step = if even { 2 } else { 1 };
    let amplitude = solution.amplitude.symbol();
    let coefficient = |power: i32| -> f64 {
        let of_power = law
            .terms()
            .filter(|(monomial, _)| monomial.exponent(small) == step * power);
        let value = |(monomial, number): (&Monomial, _)| {
            let rest = if in_amplitude {
                1.0
            } else {
                numbers[&amplitude].powi(monomial.exponent(amplitude))
            };
            to_f64(number) * rest
        };
        of_power.map(value).sum()
    };
    let highest = order as i32 / step;
    let coefficients: Vec<f64> = (0..=highest).map(coefficient).collect();
    let found = nearest_singularity(&coefficients)?;
    let variable = if even { format!("{small}^2") } else { small.to_string() };
    let radius = if even { found.radius.sqrt() } else { found.radius };
    let place = match found.angle {
        angle if angle < 1e-9 => format!("{variable} = {}", significant(found.radius, 3)),
        angle if angle > std::f64::consts::PI - 1e-9 => format!("{variable} = -{}", significant(found.radius, 3)),
        angle => format!(
            "{variable} = {} e^(+-{}i)",
            significant(found.radius, 3),
            significant(angle, 3)
        ),
    };
    let value = numbers.get(&small).copied()?;
    let exact = if series.numerical { "" } else { "exact " };
    Some(Range {
        text: format!(
            "the series converges for |{small}| < about {}: from {highest} {exact}coefficients the nearest singularity is at {place}",
            significant(radius, 3)
        ),
        outside: value.abs() >= radius,
    })
}

/// The equation with exact numbers for all parameters but one.
fn with_numbers(oscillator: &Oscillator, numbers: &BTreeMap<Symbol, f64>, but: Symbol) -> Option<Oscillator> {
    let names = oscillator.parameters.iter().filter(|&&name| name != but);
    let exact = |name: &Symbol| {
        let value = crate::decimal::rounded(*numbers.get(name)?);
        Some((*name, Expr::number(value)))
    };
    let values = names.map(exact).collect::<Option<_>>()?;
    let numerical = oscillator.with_values(&values).ok()?;
    let small = numerical.small_parameter(Some(but.name())).ok()?;
    (small == SmallParameter::Amplitude || !numerical.force.is_zero()).then_some(numerical)
}

/// The true frequency as a function of the amplitude, each value computed once.
pub(super) struct Truth<'a> {
    oscillator: &'a Oscillator,
    solution: &'a Solution,
    numbers: &'a BTreeMap<Symbol, f64>,
    known: std::cell::RefCell<BTreeMap<u64, Option<f64>>>,
    well: Option<Well>,
}

impl<'a> Truth<'a> {
    pub(super) fn new(oscillator: &'a Oscillator, solution: &'a Solution, numbers: &'a BTreeMap<Symbol, f64>) -> Self {
        Self {
            oscillator,
            solution,
            numbers,
            known: std::cell::RefCell::default(),
            well: well_of(oscillator, solution, numbers),
        }
    }

    /// The numbers with another size of the amplitude.
    pub(super) fn numbers_at(&self, size: f64) -> BTreeMap<Symbol, f64> {
        let symbol = self.solution.amplitude.symbol();
        let mut numbers = self.numbers.clone();
        let sign = numbers.get(&symbol).copied().unwrap_or(1.0);
        numbers.insert(symbol, size.copysign(sign));
        numbers
    }

    /// The amplitude beyond which no motion is periodic.
    pub(super) fn largest_amplitude(&self) -> f64 {
        self.well.map_or(f64::INFINITY, |well| well.escape)
    }

    /// The true frequency; `None` where the motion is not periodic.
    pub(super) fn frequency(&self, size: f64) -> Option<f64> {
        if let Some(known) = self.known.borrow().get(&size.to_bits()) {
            return *known;
        }
        let found: Result<f64, VerificationError> =
            true_frequency(self.oscillator, self.solution, &self.numbers_at(size));
        let found = found.ok();
        self.known.borrow_mut().insert(size.to_bits(), found);
        found
    }

    /// Amplitudes from rest to the escape, or far beyond the one asked for.
    pub(super) fn amplitudes(&self, count: usize) -> Vec<f64> {
        let symbol = self.solution.amplitude.symbol();
        let asked = self.numbers.get(&symbol).map_or(1.0, |value| value.abs());
        let part = |k: usize| k as f64 / count as f64;
        match self.well {
            Some(well) => (1..=count).map(|k| well.escape * 0.999 * part(k)).collect(),
            None => (0..=count).map(|k| asked * 0.01 * 1e4_f64.powf(part(k))).collect(),
        }
    }
}

/// How far a formula is good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// At every amplitude searched, up to this one.
    Everywhere(f64),
    /// Up to this amplitude.
    UpTo(f64),
    /// At no amplitude.
    Nowhere,
}

impl Reach {
    /// Whether it ends before an amplitude.
    pub fn ends_before(self, amplitude: f64) -> bool {
        match self {
            Self::Everywhere(_) => false,
            Self::UpTo(end) => amplitude > end,
            Self::Nowhere => true,
        }
    }

    /// The end of the range, where there is one.
    pub fn end(self) -> Option<f64> {
        match self {
            Self::UpTo(end) => Some(end),
            Self::Nowhere => Some(0.0),
            Self::Everywhere(_) => None,
        }
    }

    fn in_words(self, tolerance: f64) -> String {
        let percent = significant(100.0 * tolerance, 3);
        match self {
            Self::Everywhere(searched) => format!(
                "within {percent} % at every amplitude up to {}",
                significant(searched, 4)
            ),
            Self::UpTo(end) => format!("within {percent} % up to A = {}", significant(end, 4)),
            Self::Nowhere => format!("within {percent} % at no amplitude"),
        }
    }
}

/// The range from rest in which the frequency stays within the tolerance; `None` where it cannot be followed.
pub(super) fn reach(oscillator: &Oscillator, solution: &Solution, truth: &Truth, tolerance: f64) -> Option<Reach> {
    const POINTS: usize = 32;
    const HALVINGS: usize = 14;
    if !is_conservative(oscillator) {
        return None;
    }
    let good = |size: f64| {
        let true_frequency = truth.frequency(size)?;
        let frequency = formula_frequency(oscillator, solution, &truth.numbers_at(size));
        Some(frequency.is_some_and(|frequency| (frequency / true_frequency - 1.0).abs() <= tolerance))
    };
    let amplitudes = truth.amplitudes(POINTS);
    if solution.method == Method::Exact {
        return amplitudes.last().copied().map(Reach::Everywhere);
    }
    let (mut inside, mut searched) = (0.0, 0.0);
    for amplitude in amplitudes {
        match good(amplitude) {
            Some(true) => (inside, searched) = (amplitude, amplitude),
            Some(false) => {
                let (mut low, mut high) = (inside, amplitude);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if good(middle) == Some(true) {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                return Some(if low == 0.0 { Reach::Nowhere } else { Reach::UpTo(low) });
            }
            None => break,
        }
    }
    (!searched.is_zero()).then_some(Reach::Everywhere(searched))
}
