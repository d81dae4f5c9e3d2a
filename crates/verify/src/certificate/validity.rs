//! From an amplitude to a range: a formula that is within a tolerance for every amplitude of an
//! interval, proved.
//!
//! An interval `|A - A_m| <= h` enters the theorem as follows: the condition at `t = 0` is off by
//! at most h, so that `Y0 + h ||B e_eta||` stands for Y0, and the numbers of the motion at `A_m`
//! prove all motions of the interval at once. The square of the ratio of the frequencies is `q =
//! omega~^2 mu`, the law times `1/omega^2`, and by the mean value theorem
//!
//! ```text
//! q(A) = q(A_m) + (A - A_m) ((omega~^2)' mu + omega~^2 mu')      with the law, mu and mu' of the whole interval in the second term
//! ```
//!
//! The width of q is of the order h^2, since the two slopes are known to the order h: where the
//! error hardly changes with A they cancel.
//!
//! In: an oscillator, an answer with a law in closed form, an interval of amplitudes. Out: how far
//! the formula is proved to hold from its lower end on. Intervals are halved if the proof fails and
//! widened if it succeeds; each costs a proof.

use super::candidate::{NotCertified, certify, inverse, refine, weight};
use super::force::along;
use super::fourier_series::{FourierSeries, WORKING};
use super::radii_polynomial::NotProved;
use super::theorem::{Neighbours, prove_around};
use super::{Certificate, HIGHEST_HARMONIC, coordinate};
use crate::decimal::{not_above_typed, rounded_fraction};
use crate::exact::bound::Bound;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::oscillator::Oscillator;
use crate::solution::Solution;
use crate::values::Values;

/// The range of amplitudes in which a formula is proved to be within its tolerance.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Validity {
    /// The lower end.
    pub from: Rational,
    /// The upper end.
    pub to: Rational,
    /// `|omega~/omega - 1|` is at most this for every amplitude between them.
    pub within: f64,
    /// The intervals, each proved.
    pub intervals: usize,
    /// The reason why the range ends.
    pub beyond: RangeEnd,
}

/// The reason why a range ends where it does.
#[derive(Clone, Debug, PartialEq)]
pub enum RangeEnd {
    /// The requested end was reached.
    Asked,
    /// The error of the formula is proved to be larger at this amplitude.
    Further(Rational),
    /// At this amplitude the error is neither proved to be within the tolerance nor proved to be
    /// beyond it.
    Open(Rational),
    /// There is no proof of the motion there.
    Unproved(Rational, NotCertified),
    /// The computation was interrupted.
    Stopped,
}

/// Number of amplitudes of the range, at equal ratios, for a tolerance of a hundredth: no interval
/// is shorter than one step. For a smaller tolerance there are more, up to sixteen times as many.
const PLACES: u32 = 1 << 16;

/// Binary digits of the motions, whose error need only be small beside the tolerance.
const BITS: usize = 48;

/// The largest weight of an error of `mu`, as a power of two: with a larger one the inequalities
/// hold only for shorter intervals.
const HEAVIEST: i32 = 4;

/// Computes the range of amplitudes from `from` to `to`, both positive, in which a formula is
/// proved to be within a tolerance.
///
/// # Errors
/// No proof at the first amplitude, or a law without a closed form in the amplitude.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::validity;
/// use lindstedt::exact::ratio;
/// use lindstedt::{Options, Oscillator, Supervision, solve};
///
/// let cubic = Oscillator::parse("x'' + x - x^3/6 = 0")?;
/// let solution = solve(&cubic, &Options { order: Some(2), ..Options::default() })?;
/// let proved = validity(&cubic, &solution, &"".parse()?, [&ratio(1, 2), &ratio(1, 1)], 1e-3, Supervision::default())?;
/// assert_eq!(proved.to, ratio(1, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn validity(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    [from, to]: [&Rational; 2],
    tolerance: f64,
    supervision: Supervision,
) -> Result<Validity, NotCertified> {
    let mut family = Family::new(oscillator, solution, at, from)?;
    let tolerance = not_above_typed(tolerance);
    let finer = (1..=4).take_while(|finer| tolerance < 0.01 / f64::from(1 << (finer - 1))).count();
    let finest = PLACES << finer;
    let ends = [from, to].map(to_f64);
    let place = |position: u32| match position {
        0 => from.clone(),
        position if position == finest => to.clone(),
        _ => {
            let part = f64::from(position) / f64::from(finest);
            let place = ends[0] * (ends[1] / ends[0]).powf(part);
            from_f64(place)
                .map_or_else(|| from.clone(), |place| place.max(from.clone()).min(to.clone()))
        }
    };
    let (mut position, mut width, mut intervals, mut within) = (0, finest / 64, 0, 0.0_f64);
    supervision.progress.begin(finest as usize);
    let beyond = loop {
        if position == finest {
            break RangeEnd::Asked;
        }
        if supervision.interrupt.is_requested() {
            break RangeEnd::Stopped;
        }
        let next = (position + width).min(finest);
        match family.largest_error(&place(position), &place(next)) {
            Ok(error) if error <= tolerance => {
                within = within.max(error);
                (position..next).for_each(|_| supervision.progress.advance());
                (position, width) = (next, 2 * width);
                intervals += 1;
            }
            _ if width > 1 => width = (width / 2).min(next - position),
            _ => {
                // At the first amplitudes beyond, the error is too close to the tolerance to be
                // decided. They are rounded to six digits, as they are printed.
                let shown = |position: u32| match position.min(finest) {
                    position if position == finest => to.clone(),
                    position => rounded_fraction(&place(position), 6),
                };
                let farther = [0, 12, 60, 252, 1020].map(|steps| shown(next + (steps << finer)));
                break family.beyond(&farther, tolerance);
            }
        }
    };
    Ok(Validity { from: from.clone(), to: place(position), within, intervals, beyond })
}

/// The motions of one equation and their law, amplitude by amplitude.
struct Family<'a> {
    oscillator: &'a Oscillator,
    solution: &'a Solution,
    /// The values of the parameters.
    at: Values,
    /// The motion that was found last, from which the next one starts.
    certificate: Certificate,
    /// The equilibrium about which the motion oscillates.
    equilibrium: Rational,
    /// omega~^2 as an expression in the amplitude, which has the symbol of the coordinate here.
    squared: Expr,
    /// Its derivative.
    slope: Expr,
}

impl<'a> Family<'a> {
    fn new(
        oscillator: &'a Oscillator,
        solution: &'a Solution,
        at: &Values,
        from: &Rational,
    ) -> Result<Self, NotCertified> {
        let amplitude = solution.amplitude.symbol();
        let (_, at) = at.split(&[amplitude]);
        let (mut certificate, _) =
            certify(oscillator, solution, &with_amplitude(&at, solution, from))?;
        certificate.formula = None;
        certificate.shorten(BITS);
        let law = solution.law.closed_form().map(|form| (form.value.clone(), form.squared));
        let law = law.or_else(|| Some((Expr::from(solution.law.frequency_squared()?), true)));
        let law = law.or_else(|| Some((Expr::from(solution.law.frequency()?), false)));
        let (mut value, is_squared) = law.ok_or_else(|| NotCertified::Law(solution.formula()))?;
        for definition in solution.definitions.iter().rev() {
            value = value.substitute(definition.symbol, &definition.meaning)?;
        }
        let (values, _) = at.split(&oscillator.parameters);
        let value =
            value.substitute_all(&values)?.substitute(amplitude, &Expr::from(coordinate()))?;
        let squared = if is_squared { value } else { &value * &value };
        Ok(Self {
            equilibrium: &certificate.start - from,
            slope: squared.differentiate(coordinate())?,
            squared,
            oscillator,
            solution,
            at,
            certificate,
        })
    }

    /// An upper bound of the relative error for all amplitudes between these.
    fn largest_error(&mut self, from: &Rational, to: &Rational) -> Result<f64, NotProved> {
        let two = Integer::from(2);
        let (middle, half) = ((from + to) / &two, (to - from) / &two);
        let spread = Bound::of_fraction(&half);
        // If a later step fails, the last motion that was proved is still the nearest one.
        let mut certificate = self.certificate.clone();
        certificate.start = &self.equilibrium + &middle;
        refine(&mut certificate, spread * spread * Bound::power_of_two(-4))?;
        let near = proved(&mut certificate, spread)?;
        let law = |expression: &Expr, radius: Bound| {
            let mut amplitude = WORKING.fraction(&middle);
            amplitude.radius += radius;
            along(expression, &FourierSeries::constant(amplitude)).map(|series| series.at_zero())
        };
        let slope = WORKING.sum(
            &WORKING.product(&law(&self.slope, spread)?, &near.mu),
            &WORKING.product(&law(&self.squared, spread)?, &near.slope),
        );
        let mut ratio = WORKING.product(&law(&self.squared, Bound::ZERO)?, &near.mu_in_middle);
        ratio.radius += spread * WORKING.magnitude(&slope);
        let root = WORKING.root(&ratio, 2).ok_or(NotProved::TooLarge(spread))?;
        self.certificate = certificate;
        Ok(WORKING.magnitude(&WORKING.difference(&root, &WORKING.integer(1))).value())
    }

    /// The first of these amplitudes at which the error is proved to exceed the tolerance, or else
    /// the result at the very first.
    fn beyond(&self, amplitudes: &[Rational; 5], tolerance: f64) -> RangeEnd {
        let is_further = |amplitude: &Rational| {
            let (_, certified) = certify(
                self.oscillator,
                self.solution,
                &with_amplitude(&self.at, self.solution, amplitude),
            )?;
            Ok(certified.formula.is_some_and(|errors| errors.relative.lower > tolerance))
        };
        let further = amplitudes.iter().find(|amplitude| is_further(amplitude) == Ok(true));
        match (further, is_further(&amplitudes[0])) {
            (Some(further), _) => RangeEnd::Further(further.clone()),
            (None, Ok(_)) => RangeEnd::Open(amplitudes[0].clone()),
            (None, Err(reason)) => RangeEnd::Unproved(amplitudes[0].clone(), reason),
        }
    }
}

/// The proof of all motions whose start is within `spread`, with a larger block if the last one is
/// too small.
fn proved(certificate: &mut Certificate, spread: Bound) -> Result<Neighbours, NotProved> {
    certificate.sigma = weight(&certificate.inverse).min(HEAVIEST);
    match prove_around(certificate.problem(), spread) {
        Err(NotProved::NoContraction(_)) if certificate.highest < HIGHEST_HARMONIC / 2 => {
            certificate.highest = (certificate.highest * 3 / 2) | 1;
            certificate.inverse = inverse(&certificate.problem())?;
            certificate.sigma = weight(&certificate.inverse).min(HEAVIEST);
            prove_around(certificate.problem(), spread)
        }
        other => other,
    }
}

/// The values with this amplitude.
fn with_amplitude(at: &Values, solution: &Solution, amplitude: &Rational) -> Values {
    let mut values = at.clone();
    // A number is a value.
    let _ = values.insert(solution.amplitude.symbol(), Expr::number(amplitude.clone()));
    values
}
