//! Resonances of a driven motion: the list of the known ones, and the one nearest to numerical
//! frequencies.

use std::collections::BTreeMap;

use super::drive::Drive;
use super::{Options, Reason, Refusal};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::Method;
use crate::values::Values;

/// The resonances that are tried, Omega : omega0.
pub(super) const RESONANCES: [(u32, u32); 5] = [(1, 1), (2, 1), (1, 2), (3, 1), (1, 3)];

/// The largest value of either number that may be asked for: the motion needs as many harmonics.
pub(super) const LARGEST: u32 = 9;

/// Whether it is a ratio of frequencies that may be asked for.
pub(super) fn is_ratio((p, q): (u32, u32)) -> bool {
    (1..=LARGEST).contains(&p) && (1..=LARGEST).contains(&q)
}

/// The ratio of the driving frequency to the linear one, where both are numbers.
pub(super) fn ratio_of(frequency: &Expr, stiffness: &Expr) -> Option<f64> {
    let driving = frequency.evaluate(&BTreeMap::new()).ok()?;
    let squared = stiffness.evaluate(&BTreeMap::new()).ok()?;
    Some(driving / squared.sqrt()).filter(|ratio| ratio.is_normal())
}

/// Resonances, the nearest to a ratio of the driving frequency to the linear one first.
pub(super) fn by_distance(mut resonances: Vec<(u32, u32)>, ratio: f64) -> Vec<(u32, u32)> {
    let distance = |(p, q): &(u32, u32)| (ratio * f64::from(*q) / f64::from(*p)).ln().abs();
    resonances.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    resonances
}

/// An error if a ratio of frequencies is far from the resonance that is nearest to it: the
/// detuning, which is to be small, is more than half of the linear frequency.
pub(super) fn is_near((p, q): (u32, u32), ratio: f64, method: Method) -> Result<(), Refusal> {
    const FAR: f64 = 0.5;
    let nearest = (p, q);
    match (ratio * f64::from(q) / f64::from(p) - 1.0).abs() > FAR {
        true => Err(Reason::FarFromResonance { ratio, nearest }.to(method)),
        false => Ok(()),
    }
}

/// The options with the resonance that is nearest to the frequencies at these values, of those that
/// the equation has; as they are where one is asked for, nothing drives the motion, or a value is
/// missing.
///
/// # Errors
/// The drive is far from all of them.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Method, Options, Oscillator, method::with_resonance_at};
///
/// let duffing = Oscillator::parse("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)")?;
/// let at = "zeta = 1/100, eps = 1/10, F = 1, Omega = 1/3".parse()?;
/// assert_eq!(with_resonance_at(&duffing, &Options::default(), &at)?.resonance, Some((1, 3)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_resonance_at(
    oscillator: &Oscillator,
    options: &Options,
    at: &Values,
) -> Result<Options, Refusal> {
    let method = options.method.unwrap_or(Method::MultipleScales);
    let mut chosen = options.clone();
    if options.resonance.is_some() || !matches!(method, Method::MultipleScales | Method::Averaging)
    {
        return Ok(chosen);
    }
    // A linear equation is answered as it is, near a resonance or not.
    if super::default_method::linear(oscillator, options).is_some() {
        return Ok(chosen);
    }
    let Some((resonances, ratio)) = ratio_at(oscillator, at, method) else {
        return Ok(chosen);
    };
    let found = by_distance(resonances, ratio).into_iter().find(|candidate| {
        let asked = Options { resonance: Some(*candidate), ..options.clone() };
        super::solve(oscillator, &asked).is_ok()
    });
    if let Some(nearest) = found {
        is_near(nearest, ratio, method)?;
        chosen.resonance = found;
    }
    Ok(chosen)
}

/// The resonances of the drive, and the ratio of the frequencies at these values; `None` if nothing
/// drives, or one is missing.
fn ratio_at(
    oscillator: &Oscillator,
    at: &Values,
    method: Method,
) -> Option<(Vec<(u32, u32)>, f64)> {
    let centred = crate::equilibrium::centred(oscillator, None).ok()?;
    let oscillator = &centred.oscillator;
    let parts = oscillator.parts().ok().filter(|parts| !parts.forcing.is_zero())?;
    let drive = Drive::from_parts(&parts, oscillator, method).ok()?;
    let mut numbers = at.numbers();
    if let Some(definition) = &centred.definition {
        numbers.insert(definition.symbol, definition.meaning.evaluate(&numbers).ok()?);
    }
    let x = oscillator.coordinate;
    let stiffness = parts.restoring.differentiate(x).ok()?.substitute(x, &Expr::zero()).ok()?;
    let ratio =
        drive.frequency.evaluate(&numbers).ok()? / stiffness.evaluate(&numbers).ok()?.sqrt();
    Some((drive.resonances(), ratio)).filter(|(_, ratio)| ratio.is_normal())
}
