//! The well of a conservative motion: how far it may be released on either side and still come
//! back.
//!
//! Reference: L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11. Released at rest
//! from `x_e + A` the motion has the energy `V(x_e + A)` and stays between the walls of the well
//! where that is below both of its rims:
//!
//! ```text
//! V(x_e + A) < V(rim),   rim = the unstable equilibrium on either side, where the force ends, or infinity where V levels off
//! ```
//!
//! For an inertia that depends on the position too, the same holds of `U' = M f` with the energy
//! `M x'^2/2 + U`.
//!
//! All lengths are measured by the amplitude asked for, so the units of the equation do not matter.

use super::force::CentredForce;
use super::passage::{passage_at, passages, pushes_away};
use crate::decimal::significant;
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth};
use crate::numeric::ode::root::{BisectionStop, bisect, find_root};
use crate::symbol::Symbol;

/// The boundary of a well on one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WellBoundary {
    /// The unstable equilibrium, or the place where the force ends; infinite if the force dies away
    /// so fast that its potential levels off.
    pub place: f64,
    /// Whether it is an unstable equilibrium; otherwise the force has no value beyond it.
    pub separatrix: bool,
}

/// A rim and the potential there above the bottom of the well.
#[derive(Clone, Copy)]
struct Wall {
    rim: WellBoundary,
    /// `None` if it is infinite, or not asked for yet.
    height: Option<f64>,
}

impl Wall {
    fn new(place: f64, separatrix: bool) -> Self {
        Self { rim: WellBoundary { place, separatrix }, height: None }
    }
}

/// The largest amplitude of a periodic motion on one side, with its sign, and the rim over which it
/// would leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WellEnd {
    /// The amplitude, measured from the equilibrium.
    pub amplitude: f64,
    /// The boundary of the well beyond this amplitude.
    pub rim: WellBoundary,
}

/// The well in which a conservative motion swings; an end is `None` if none was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Well {
    /// On the negative side.
    pub low: Option<WellEnd>,
    /// On the positive side.
    pub high: Option<WellEnd>,
    /// The smallest amplitude of motions over several wells; `None` if the motions begin at rest.
    pub inner: Option<SmallestCrossWellAmplitude>,
}

/// The least amplitude of motions through an unstable equilibrium, over the wells on both sides of
/// it: smaller ones stay in one well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallestCrossWellAmplitude {
    /// Its size, which all motions exceed.
    pub amplitude: f64,
    /// The unstable equilibrium that the motion of this amplitude does not pass.
    pub place: f64,
}

/// Range of the search for the boundaries of a well, in units of the amplitude.
const FARTHEST: f64 = 1e10;

/// Steps of the search over the first amplitude, and the growth of later ones.
const STEPS: f64 = 64.0;
const GROWTH: f64 = 1.02;

impl Well {
    /// The well of a force about its equilibrium, where it has an end; `amplitude` gives the scale
    /// of the search.
    pub fn new(force: &CentredForce, amplitude: f64) -> Option<Self> {
        let unit = amplitude.abs();
        if pushes_away(force, unit) {
            return Self::over_hilltops(force, unit);
        }
        Self::between(force, unit, |side| rim(force, side, unit))
    }

    /// The well where the inertia depends on the position: `weighted` is the slope `M f` of the
    /// potential, `force` the force as it stands in the equation. The product may go on where the
    /// motion does not, beside a zero of `M` at which `f` is infinite.
    pub fn with_inertia(
        weighted: &CentredForce,
        force: &CentredForce,
        amplitude: f64,
    ) -> Option<Self> {
        let unit = amplitude.abs();
        if pushes_away(weighted, unit) {
            return None;
        }
        Self::between(weighted, unit, |side| {
            let ends = rim(force, side, unit)
                .filter(|wall| !wall.rim.separatrix && wall.rim.place.is_finite());
            let distance = |wall: &Wall| (wall.rim.place - weighted.equilibrium()).abs();
            let nearest = rim(weighted, side, unit).into_iter().chain(ends);
            nearest.min_by(|one, other| distance(one).total_cmp(&distance(other)))
        })
    }

    /// The well between the rims on both sides of an equilibrium.
    fn between(force: &CentredForce, unit: f64, rim: impl Fn(f64) -> Option<Wall>) -> Option<Self> {
        /// Relative differences of two heights below this are rounding.
        const EVEN: f64 = 1e-8;
        let equilibrium = force.equilibrium();
        let wall = |side: f64| {
            let wall = rim(side)?;
            let height = match wall.rim.place.is_finite() {
                true => rise(force, wall.rim.place - equilibrium),
                false => wall.height,
            };
            Some(Wall { height, ..wall })
        };
        let (left, right) = (wall(-1.0), wall(1.0));
        let end = |side: f64, own: Option<Wall>, other: Option<Wall>| {
            let own_end = own
                .filter(|wall| wall.rim.place.is_finite())
                .map(|wall| WellEnd { amplitude: wall.rim.place - equilibrium, rim: wall.rim });
            // Released on this side, the motion may also leave over the other rim.
            let Some((rim, height)) = other.and_then(|wall| Some((wall.rim, wall.height?))) else {
                return own_end;
            };
            let lower =
                own.and_then(|wall| wall.height).is_some_and(|own| own <= height * (1.0 + EVEN));
            if own_end.is_none() && lower {
                return None;
            }
            let excess = |size: f64| {
                rise(force, side * size).map_or(f64::NAN, |energy| energy / height - 1.0)
            };
            let (mut low, mut high) =
                (0.0, own_end.map_or(unit, |end| end.amplitude.abs() * (1.0 - 1e-12)));
            while own_end.is_none() && excess(high) <= 1e-9 && high < FARTHEST * unit {
                // An amplitude whose energy is the height to the last digit brackets nothing.
                if excess(high) < -1e-9 {
                    low = high;
                }
                high *= 2.0;
            }
            if excess(high) > 1e-9
                && let Ok(size) =
                    find_root(|size| if size == 0.0 { -1.0 } else { excess(size) }, low, high)
            {
                return Some(WellEnd { amplitude: side * size, rim });
            }
            own_end
        };
        let well = Self { low: end(-1.0, left, right), high: end(1.0, right, left), inner: None };
        (well.low.is_some() || well.high.is_some()).then_some(well)
    }

    /// The motions of an odd force through an unstable equilibrium: those of the amplitude, or the
    /// next larger ones.
    fn over_hilltops(force: &CentredForce, amplitude: f64) -> Option<Self> {
        let (passages, equilibrium) = (passages(force, amplitude), force.equilibrium());
        let passage = passage_at(&passages, amplitude)?;
        let end = |side: f64| {
            passage.to.map(|rim| WellEnd {
                amplitude: side * rim.place,
                rim: WellBoundary { place: equilibrium + side * rim.place, ..rim },
            })
        };
        Some(Self {
            low: end(-1.0),
            high: end(1.0),
            inner: Some(SmallestCrossWellAmplitude {
                amplitude: passage.from,
                place: equilibrium + passage.over,
            }),
        })
    }

    /// The size of the amplitude that periodic motions exceed.
    pub fn smallest_amplitude(&self) -> f64 {
        self.inner.map_or(0.0, |inner| inner.amplitude)
    }

    /// The end on the side of an amplitude.
    pub fn on_side(&self, amplitude: f64) -> Option<WellEnd> {
        if amplitude < 0.0 { self.low } else { self.high }
    }

    /// Describes the range of periodic motions in words; `name` is the letter of the amplitude.
    pub fn in_words(&self, name: Symbol, coordinate: Symbol) -> String {
        let because = |rim: WellBoundary| {
            let place = significant(rim.place, 6);
            match rim.separatrix {
                true => {
                    format!("the separatrix passes the unstable equilibrium {coordinate} = {place}")
                }
                false if rim.place.is_infinite() => {
                    let sign = if rim.place < 0.0 { "-" } else { "" };
                    format!("beyond it the motion escapes to {coordinate} = {sign}infinity")
                }
                false => format!("the force ends at {coordinate} = {place}"),
            }
        };
        let number = |end: WellEnd| significant(end.amplitude, 6);
        if let Some(inner) = self.inner {
            let (least, hilltop) = (significant(inner.amplitude, 6), significant(inner.place, 6));
            return match self.high {
                None => format!(
                    "periodic for |{name}| > {least}: the separatrix passes the unstable equilibrium {coordinate} = {hilltop}"
                ),
                Some(high) if high.rim.separatrix => format!(
                    "periodic for {least} < |{name}| < {}: the separatrices pass the unstable equilibria {coordinate} = {hilltop} and \
                     {coordinate} = {}",
                    number(high),
                    significant(high.rim.place, 6)
                ),
                Some(high) => format!(
                    "periodic for {least} < |{name}| < {}: the separatrix passes the unstable equilibrium {coordinate} = {hilltop}, {}",
                    number(high),
                    because(high.rim)
                ),
            };
        }
        match (self.low, self.high) {
            (Some(low), Some(high)) => {
                let even = (low.amplitude / high.amplitude + 1.0).abs() < 1e-9;
                let range = match even {
                    true => format!("|{name}| < {}", number(high)),
                    false => format!("{} < {name} < {}", number(low), number(high)),
                };
                if even || low.rim == high.rim {
                    return format!("periodic for {range}: {}", because(high.rim));
                }
                format!("periodic for {range}: {}, {}", because(low.rim), because(high.rim))
            }
            (Some(low), None) => {
                format!("periodic for {name} > {}: {}", number(low), because(low.rim))
            }
            (None, Some(high)) => {
                format!("periodic for {name} < {}: {}", number(high), because(high.rim))
            }
            (None, None) => String::new(),
        }
    }
}

/// A force with more pieces on the way than this, such as a tangent over a million poles, is not
/// followed through them.
const MOST_PIECES: usize = 256;

/// The potential above the bottom of the well at a distance; `None` if it is infinite, or beyond
/// too many pieces.
pub(super) fn rise(force: &CentredForce, to: f64) -> Option<f64> {
    rise_between(force, 0.0, to)
}

/// The difference of the potential at two distances; `None` as for [`rise`].
fn rise_between(force: &CentredForce, from: f64, to: f64) -> Option<f64> {
    let mut knots = vec![to.min(from)];
    knots.extend(force.cuts(from, to));
    knots.push(to.max(from));
    if knots.len() > MOST_PIECES {
        return None;
    }
    let mut sum = 0.0;
    for pair in knots.windows(2) {
        sum += match integrate_smooth(|y| force.value(y), pair[0], pair[1], 1e-10) {
            Ok((value, _)) => value,
            Err(QuadratureError::NotConverged { value, error_estimate, .. })
                if error_estimate < 1e-6 * value.abs() =>
            {
                value
            }
            Err(_) if pair[0] == to => towards_the_end(force, pair[1], to)?,
            Err(_) if pair[1] == to => towards_the_end(force, pair[0], to)?,
            Err(_) => return None,
        };
    }
    Some(if to < from { -sum } else { sum })
}

/// The potential above the bottom of the well infinitely far away on one side, where the force dies
/// away so fast that it is finite: the work over distances that double is then soon a geometric
/// series, whose remainder is its last term times `q/(1 - q)`.
fn rise_to_infinity(force: &CentredForce, side: f64, unit: f64) -> Option<f64> {
    const DOUBLINGS: i32 = 1000;
    /// Relative parts of the height: a remainder below the first is rounding, one below the second
    /// is small enough if the force has no digits beyond.
    const NEGLIGIBLE: f64 = 1e-14;
    const SMALL: f64 = 1e-8;
    /// A quotient closer to one than this belongs to a potential that grows without end, as a
    /// logarithm, or may do so.
    const CONVERGES: f64 = 0.97;
    /// Largest change of the quotient at which the series counts as geometric.
    const SETTLED: f64 = 1e-4;
    let mut sum = rise(force, side * unit)?;
    let (mut last, mut quotient) = (f64::INFINITY, f64::INFINITY);
    let mut distance = unit;
    for _ in 0..DOUBLINGS {
        let next = 2.0 * distance;
        let Some(work) = rise_between(force, side * distance, side * next) else {
            break;
        };
        sum += work;
        if work <= NEGLIGIBLE * NEGLIGIBLE * sum {
            // The rest of the work may be rounding alone.
            return (work >= -NEGLIGIBLE * sum).then_some(sum);
        }
        let settled = (work / last - quotient).abs() < SETTLED;
        quotient = work / last;
        (last, distance) = (work, next);
        if !settled {
            continue;
        }
        if quotient > CONVERGES {
            // Near the bottom the work still grows.
            match distance > FARTHEST * unit {
                true => return None,
                false => continue,
            }
        }
        let rest = last * quotient / (1.0 - quotient);
        if rest < NEGLIGIBLE * sum {
            return Some(sum + rest);
        }
    }
    let rest = last * quotient / (1.0 - quotient);
    (quotient < CONVERGES && rest < SMALL * sum).then_some(sum + rest)
}

/// The work towards a place where the force is infinite but its potential is not, as that of
/// `1/sqrt(1 - x)` at 1, counted from the left: with the distance from there as the sixth power of
/// a variable the integrand is bounded. `None` at a pole.
fn towards_the_end(force: &CentredForce, from: f64, to: f64) -> Option<f64> {
    /// Closer than this, relatively, the distance is rounding, and what it would add below the
    /// tolerance.
    const CLOSEST: f64 = 1e-15;
    if force.is_pole(force.equilibrium() + to, to.abs()) {
        return None;
    }
    let integrand = |s: f64| match s.powi(6) {
        distance if distance < CLOSEST => 0.0,
        distance => 6.0 * s.powi(5) * force.value(to + (from - to) * distance),
    };
    let work = match integrate_smooth(integrand, 0.0, 1.0, 1e-10) {
        Ok((value, _)) => value,
        Err(QuadratureError::NotConverged { value, error_estimate, .. })
            if error_estimate < 1e-6 * value.abs() =>
        {
            value
        }
        Err(_) => return None,
    };
    Some(work * (from - to).abs())
}

/// The first place on one side where the force turns its sign or ends; infinity where its potential
/// levels off.
fn rim(force: &CentredForce, side: f64, unit: f64) -> Option<Wall> {
    let equilibrium = force.equilibrium();
    let pull = |distance: f64| side * force.value(side * distance);
    let mut strongest = 0.0_f64;
    let (mut distance, mut step) = (unit / STEPS, unit / STEPS);
    let mut window = distance;
    let mut places: Vec<f64> = Vec::new();
    while distance < FARTHEST * unit {
        if distance >= window {
            // Corners and narrow places of the next stretch, nearest last.
            let ahead = 4.0 * window.max(unit);
            let cuts = force.cuts(side * window, side * ahead);
            places = cuts.into_iter().map(|place| side * place).collect();
            places.sort_by(|one, other| other.total_cmp(one));
            window = ahead;
        }
        let mut next = (distance + step).min(window.max(distance + 1e-3 * step));
        while places.last().is_some_and(|&place| place <= distance) {
            places.pop();
        }
        let mut at_place = false;
        if let Some(&place) = places.last().filter(|&&place| place <= next) {
            (next, at_place) = (place, true);
        }
        let there = pull(next);
        // Rounding may leave a finite value at the pole itself.
        if at_place && force.is_pole(equilibrium + side * next, unit) {
            return Some(Wall::new(equilibrium + side * next, false));
        }
        if !there.is_finite() && at_place {
            // A corner at which the expression has no value, but the force goes on; a pole goes on
            // as well, but is no corner.
            let [just_before, just_behind] = [next * (1.0 - 1e-12), next * (1.0 + 1e-12)];
            if pull(just_before) <= 1e3 * pull(distance) && pull(just_behind) > 0.0 {
                distance = just_behind;
                continue;
            }
        }
        // A force that overflows f64 has a value all the same, and so has one that dies away as a
        // quotient of numbers that overflow.
        if !there.is_finite() && (strongest > 1e250 || force.overflow(side * next).is_some()) {
            return levels_off(force, side, unit, pull(distance) / strongest);
        }
        if !there.is_finite() {
            return Some(Wall::new(
                equilibrium + side * end_of_force(&pull, distance, next),
                false,
            ));
        }
        if there <= 0.0 {
            // A decaying force may change its sign by rounding, without a zero.
            let is_rounding =
                [distance, next].into_iter().all(|size| !force.has_digits(side * size));
            let Some((size, separatrix)) =
                sign_change(&pull, distance, next, strongest).filter(|_| !is_rounding)
            else {
                return levels_off(force, side, unit, there / strongest);
            };
            return Some(Wall::new(equilibrium + side * size, separatrix));
        }
        strongest = strongest.max(there);
        distance = next;
        if distance > unit {
            step = distance * (GROWTH - 1.0);
        }
    }
    levels_off(force, side, unit, pull(distance) / strongest)
}

/// Infinity as the rim of a force that pulls back on all of this side and weakens to the fraction
/// `weakened` of its largest value; `None` unless its potential is finite there.
fn levels_off(force: &CentredForce, side: f64, unit: f64, weakened: f64) -> Option<Wall> {
    /// A force that has not weakened by this over ten decades, a million units far, does not die
    /// away as fast as its inverse distance.
    const DIES_AWAY: f64 = 1e-3;
    if weakened.is_nan() || weakened.abs() > DIES_AWAY {
        return None;
    }
    let height = rise_to_infinity(force, side, unit)?;
    Some(Wall { height: Some(height), ..Wall::new(side * f64::INFINITY, false) })
}

/// The distance at which a force ends, from outside, between one at which it has a value and one at
/// which it has none.
pub(super) fn end_of_force(pull: &dyn Fn(f64) -> f64, inside: f64, outside: f64) -> f64 {
    let [_, end] =
        bisect(|size| pull(size).is_finite(), inside, outside, BisectionStop::Halvings(60));
    end
}

/// The distance at which the force changes its sign between two others, and whether it passes
/// through zero; `None` if the force has only become negligible.
pub(super) fn sign_change(
    pull: &dyn Fn(f64) -> f64,
    from: f64,
    to: f64,
    strongest: f64,
) -> Option<(f64, bool)> {
    let (before, there) = (pull(from), pull(to));
    // A force that has died away to nothing has no zero there.
    if there == 0.0 && before.abs() < 1e-100 * strongest {
        return None;
    }
    let size = if there == 0.0 { to } else { find_root(pull, from, to).ok()? };
    // A change of sign by way of infinity is an end, not an equilibrium: next to it the force is
    // far stronger than at the ends of the step.
    let near = pull(size).abs().max(pull(size * (1.0 - 4.0 * f64::EPSILON)).abs());
    let through_zero = near <= 1e3 * before.abs().max(there.abs()).max(1e-300 * strongest);
    Some((size, through_zero))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, parse_expression};
    use std::collections::BTreeMap;

    fn ends(text: &str, amplitude: f64) -> (Option<f64>, Option<f64>, String) {
        let expression = parse_expression(text).unwrap();
        let force =
            CentredForce::new(&expression, "x".into(), &Expr::zero(), &BTreeMap::new(), amplitude)
                .unwrap();
        let well = Well::new(&force, amplitude);
        let Some(well) = well else {
            return (None, None, String::new());
        };
        let amplitude = |end: Option<WellEnd>| end.map(|end| end.amplitude);
        (amplitude(well.low), amplitude(well.high), well.in_words("A".into(), "x".into()))
    }

    #[test]
    fn both_ends_have_their_sign() {
        // V = x^2/2 + x^3/3 is 1/6 at x = -1 and again at x = 1/2.
        for (text, low, high) in [("x + x^2", -1.0, 0.5), ("x - x^2", -0.5, 1.0)] {
            for amplitude in [0.1, -0.3, 0.125, -0.25, 1e-6] {
                let (found_low, found_high, words) = ends(text, amplitude);
                assert!(
                    (found_low.unwrap() - low).abs() < 1e-7
                        && (found_high.unwrap() - high).abs() < 1e-7,
                    "{words}"
                );
                assert!(
                    words.starts_with(&format!("periodic for {low} < A < {high}: the separatrix")),
                    "{words}"
                );
            }
        }
        assert_eq!(
            ends("x - x^3", 0.5).2,
            "periodic for |A| < 1: the separatrix passes the unstable equilibrium x = 1"
        );
        let (low, high, words) = ends("x/(1 - x)^2", 0.1);
        assert!(low.is_none() && (high.unwrap() - 1.0).abs() < 1e-9, "{words}");
        assert!(words.contains("periodic for A < 1: the force ends at x = 1"), "{words}");
        assert_eq!(ends("x + x^3", 1.0), (None, None, String::new()));
        assert_eq!(ends("x*exp(-x^2)", 1.0).2, "");
    }

    #[test]
    fn both_ends_are_in_the_words() {
        for (text, amplitude, words) in [
            ("x/(1 - x^2)^2", 0.5, "periodic for |A| < 1: the force ends at x = 1"),
            (
                "sin(3*x)",
                -0.1,
                "periodic for |A| < 1.0472: the separatrix passes the unstable equilibrium x = 1.0472",
            ),
            ("x/(1 + x)^2", 0.1, "periodic for A > -1: the force ends at x = -1"),
            // V = 4/3 - 2 u + 2 u^3/3 with u^2 = 1 - x: the end at 1 is reached from u^2 = 3.
            ("x/(1 - x)^(1/2)", 0.5, "periodic for -2 < A < 1: the force ends at x = 1"),
            ("x/(1 + x)^(1/2)", -0.5, "periodic for -1 < A < 2: the force ends at x = -1"),
        ] {
            assert!(
                ends(text, amplitude).2.starts_with(words),
                "{text}: {}",
                ends(text, amplitude).2
            );
        }
    }

    /// A force that has grown beyond all numbers has not ended: no rim is claimed where double
    /// precision gives out.
    #[test]
    fn an_overflow_is_no_end() {
        for (text, amplitude) in
            [("exp(x) - 1", -1e5), ("exp(x) - 1", -2.5e11), ("x + x^99", 1e30), ("sinh(x)", 1e4)]
        {
            assert_eq!(ends(text, amplitude), (None, None, String::new()), "{text}");
        }
    }

    #[test]
    fn the_unit_of_force_and_of_length_does_not_matter() {
        let pi = std::f64::consts::PI;
        for strength in ["1e-20", "1e14", "1e16", "1e20"] {
            let (low, high, words) = ends(&format!("{strength}*sin(x)"), 1.0);
            assert!(
                (low.unwrap() + pi).abs() < 1e-9 && (high.unwrap() - pi).abs() < 1e-9,
                "{words}"
            );
            assert!(words.contains("separatrix"), "{strength}: {words}");
        }
        let (_, high, words) = ends("1e12*x - 1e26*x^3", 3e-8);
        assert!(
            (high.unwrap() / 1e-7 - 1.0).abs() < 1e-9 && words.contains("separatrix"),
            "{words}"
        );
        // A barrier far narrower than the motion: V = x^2/2 + 5*exp(-1e4*(x + 1)^2).
        let (low, ..) = ends("x - 1e5*(x + 1)*exp(-1e4*(x + 1)^2)", 0.5);
        assert!((low.unwrap() + 1.0).abs() < 1e-2, "{low:?}");
    }
}
