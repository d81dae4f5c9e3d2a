//! A force with numbers for its parameters, as a function of the distance from its equilibrium.
//! Every law that is solved numerically evaluates it.
//!
//! Near rest a force such as `exp(x) - 1`, or any force about an equilibrium that is not zero, is a
//! small difference of large numbers. Where rounding would show, its Taylor polynomial stands in
//! for it, whose coefficients are exact:
//!
//! ```text
//! f(x_e + y) = f'(x_e) y + f''(x_e) y^2/2 + ...,   |y| <= r,   r so small that the last terms kept are below rounding
//! ```

use std::cell::{Cell, OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

use num_traits::Zero;

use super::features::Features;
use crate::exact::Rational;
use crate::expr::{CompiledFunction, Expr, Function, Node};
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth};
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::series::taylor::taylor;
use crate::symbol::Symbol;

/// The degree of the polynomial near rest of a force whose leading term is linear.
const DEGREE: u32 = 10;

/// The degree for a force that begins with a higher power, as `sin(x) - x` does: a difference that
/// keeps fewer digits near rest needs its polynomial farther out.
const DEGREE_OF_HIGHER_POWERS: u32 = 32;

/// A force as a function of the distance from its equilibrium.
pub struct CentredForce {
    of: Rc<AtNumbers>,
    near: Option<NearRest>,
    evaluations: Cell<u64>,
}

/// The part of a force that does not depend on the size of the motion.
struct AtNumbers {
    force: Expr,
    coordinate: Symbol,
    numbers: BTreeMap<Symbol, f64>,
    /// The equilibrium in symbols, and its position.
    equilibrium: (Expr, f64),
    value: CompiledFunction,
    slope: Option<CompiledFunction>,
    arguments: RefCell<Vec<f64>>,
    /// The Taylor coefficients about the equilibrium, where there are any.
    coefficients: OnceCell<Option<Vec<f64>>>,
    features: OnceCell<Features>,
    /// Whether a feature is a pole, by the bits of its position; each is decided once.
    poles: RefCell<BTreeMap<u64, bool>>,
}

/// The Taylor polynomial of a force about its equilibrium, and the distance up to which it is as
/// good as the force.
#[derive(Clone, Debug)]
pub struct NearRest {
    coefficients: Vec<f64>,
    radius: f64,
}

impl NearRest {
    /// The force at the distance `y` from the equilibrium; `None` farther out than the polynomial
    /// reaches.
    pub fn value(&self, y: f64) -> Option<f64> {
        let sum = || self.coefficients.iter().rev().fold(0.0, |sum, c| sum * y + c);
        (y.abs() <= self.radius).then(sum)
    }

    /// The derivative of the force there; `None` farther out than the polynomial reaches.
    pub(crate) fn slope(&self, y: f64) -> Option<f64> {
        let terms = || self.coefficients.iter().enumerate().skip(1).rev();
        (y.abs() <= self.radius).then(|| terms().fold(0.0, |sum, (k, c)| sum * y + k as f64 * c))
    }
}

impl CentredForce {
    /// `force` about `equilibrium` at these numbers, for motions of about this amplitude; `None` if
    /// a symbol has no number.
    pub fn new(
        force: &Expr,
        coordinate: Symbol,
        equilibrium: &Expr,
        numbers: &BTreeMap<Symbol, f64>,
        amplitude: f64,
    ) -> Option<Self> {
        let names: Vec<Symbol> =
            std::iter::once(coordinate).chain(numbers.keys().copied()).collect();
        let place = equilibrium.evaluate(numbers).ok()?;
        let slope = force.differentiate(coordinate).ok();
        let of = AtNumbers {
            value: CompiledFunction::new(force, &names).ok()?,
            slope: slope.and_then(|slope| CompiledFunction::new(&slope, &names).ok()),
            // One row of arguments for all calls: only its first entry, the position, changes.
            arguments: RefCell::new(
                std::iter::once(0.0).chain(numbers.values().copied()).collect(),
            ),
            coefficients: OnceCell::new(),
            equilibrium: (equilibrium.clone(), place),
            force: force.clone(),
            coordinate,
            numbers: numbers.clone(),
            features: OnceCell::new(),
            poles: RefCell::default(),
        };
        Some(Self::of_amplitude(Rc::new(of), amplitude))
    }

    /// The force for motions of about another amplitude; everything known about it is shared.
    #[must_use]
    pub fn with_amplitude(&self, amplitude: f64) -> Self {
        Self::of_amplitude(Rc::clone(&self.of), amplitude)
    }

    fn of_amplitude(of: Rc<AtNumbers>, amplitude: f64) -> Self {
        let mut found = Self { of, near: None, evaluations: Cell::new(0) };
        found.near = found.near_rest(amplitude);
        found
    }

    /// The position of the equilibrium.
    pub fn equilibrium(&self) -> f64 {
        self.of.equilibrium.1
    }

    /// The name of the position.
    pub fn coordinate(&self) -> Symbol {
        self.of.coordinate
    }

    /// The force at the distance `y` from the equilibrium.
    pub fn value(&self, y: f64) -> f64 {
        let near = self.near.as_ref().and_then(|near| near.value(y));
        near.unwrap_or_else(|| self.call(&self.of.value, y))
    }

    /// The polynomial that stands in for the force near rest; `None` if the force itself has all
    /// its digits there.
    pub fn polynomial_near_rest(&self) -> Option<&NearRest> {
        self.near.as_ref()
    }

    /// Its derivative there, jumps left out; NaN where it has none.
    pub fn slope(&self, y: f64) -> f64 {
        match (self.near.as_ref().and_then(|near| near.slope(y)), &self.of.slope) {
            (Some(slope), _) => slope,
            (None, Some(slope)) => self.call(slope, y),
            (None, None) => f64::NAN,
        }
    }

    /// Whether the force has a significant digit left at the distance `y`; it has none where it is
    /// the difference of numbers that agree to all of their digits.
    pub(super) fn has_digits(&self, y: f64) -> bool {
        let there = |symbol: Symbol| match symbol == self.of.coordinate {
            true => Some((self.equilibrium() + y, 0.0)),
            false => self.of.numbers.get(&symbol).map(|&value| (value, 0.0)),
        };
        let found = self.of.force.evaluate_rounded(&there);
        found.is_some_and(|(value, error)| error <= 0.1 * value.abs())
    }

    /// The work against the force from one distance to another, with a bound of its error; `None`
    /// if it has no value between.
    pub fn work(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        const TOLERANCE: f64 = 1e-14;
        let mut ends = self.cuts(from, to);
        ends.extend([from.min(to), from.max(to)]);
        ends.sort_by(f64::total_cmp);
        let (mut sum, mut error) = (0.0, 0.0);
        for pair in ends.windows(2) {
            let piece = match integrate_smooth(|y| self.value(y), pair[0], pair[1], TOLERANCE) {
                Ok(piece) => piece,
                Err(QuadratureError::NotConverged { value, error_estimate, .. })
                    if error_estimate < 1e-9 * value.abs() =>
                {
                    (value, error_estimate)
                }
                Err(_) => return None,
            };
            sum += piece.0;
            error += piece.1;
        }
        Some((if from <= to { sum } else { -sum }, error))
    }

    /// Number of evaluations of the force or its slope so far: a measure of work that is the same
    /// on every machine.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    fn call(&self, function: &CompiledFunction, y: f64) -> f64 {
        self.evaluations.set(self.evaluations.get() + 1);
        let mut arguments = self.of.arguments.borrow_mut();
        arguments[0] = self.equilibrium() + y;
        function.call(&arguments)
    }

    /// Distances that divide an interval so that the force is smooth on each piece.
    pub fn cuts(&self, from: f64, to: f64) -> Vec<f64> {
        let at = self.equilibrium();
        let cuts = self.of.features().cuts(at + from, at + to);
        cuts.into_iter().map(|place| place - at).collect()
    }

    /// Whether some part of the force oscillates, so that many waves may lie between two cuts.
    pub fn waves(&self) -> bool {
        self.of.features().waves()
    }

    /// The polynomial near rest, where rounding of the force itself would show at this amplitude.
    fn near_rest(&self, amplitude: f64) -> Option<NearRest> {
        /// Relative errors below this are no loss.
        const HARMLESS: f64 = 2e-14;
        /// Largest ratio of a distance to the amplitude at which the polynomial is used: beyond the
        /// range of the search for the edge of a well.
        const FARTHEST: f64 = 1e12;
        let (coordinate, numbers, place) =
            (self.of.coordinate, &self.of.numbers, self.equilibrium());
        let cancels = [0.31 * amplitude, -0.7 * amplitude].into_iter().any(|y| {
            let there = |symbol: Symbol| match symbol == coordinate {
                // The sum of equilibrium and distance is rounded itself.
                true if place == 0.0 => Some((y, 0.0)),
                true => Some((place + y, 0.5 * f64::EPSILON * place.abs())),
                false => numbers.get(&symbol).map(|&value| (value, 0.0)),
            };
            let value = self.of.force.evaluate_rounded(&there);
            value.is_some_and(|(value, error)| error > HARMLESS * value.abs())
        });
        // At a removable singularity the force has no value of its own, and towards it no digits.
        let at_rest = value_at(&self.of.force, coordinate, place, numbers);
        if !cancels && at_rest.is_some() {
            return None;
        }
        let coefficients = self.of.coefficients.get_or_init(|| self.of.expanded()).as_ref()?;
        let size = |k: usize, radius: f64| {
            coefficients.get(k).map_or(0.0, |c| c.abs() * radius.powi(k as i32))
        };
        let first = coefficients.iter().position(|c| *c != 0.0)?;
        let good = |radius: f64| {
            let leading = (first..first + 3).map(|k| size(k, radius)).fold(0.0, f64::max);
            let last = coefficients.len() - 1;
            leading.is_finite() && (last - 2..=last).all(|k| size(k, radius) <= 1e-17 * leading)
        };
        let radii = |from: f64, factor: f64| {
            std::iter::successors(Some(from), move |radius| Some(factor * radius))
        };
        // A narrow place close to rest is not seen on an interval far wider: every scale is looked
        // at.
        let clear = |radius: f64| {
            let mut scales = radii(radius, 1.0 / 64.0)
                .take_while(|&scale| scale >= 1e-2 * amplitude.abs().min(radius));
            scales.all(|scale| self.is_clear(scale, 1e-12 * amplitude.abs()))
        };
        let mut radii = radii(FARTHEST * amplitude.abs(), 0.5).take(240);
        let radius = radii.find(|&radius| good(radius) && clear(radius))?;
        Some(NearRest { coefficients: coefficients.clone(), radius })
    }

    /// Whether the Taylor polynomial may represent the force up to this radius: no corner lies
    /// within it (one at the equilibrium itself apart), and within four times the radius lies no
    /// feature narrower than that. The Taylor coefficients at rest need not show such a feature, as
    /// a bump whose tail has died away there.
    fn is_clear(&self, radius: f64, at_rest: f64) -> bool {
        let narrow = self
            .of
            .features()
            .between(self.equilibrium() - 4.0 * radius, self.equilibrium() + 4.0 * radius);
        narrow.into_iter().all(|feature| {
            let distance = (feature.place - self.equilibrium()).abs();
            let reach = if feature.width == 0.0 { radius } else { 4.0 * radius };
            let rounding = f64::max(at_rest, 4.0 * f64::EPSILON * self.equilibrium().abs());
            distance <= rounding || distance > reach || feature.width >= 4.0 * radius
        })
    }

    /// The position (not the distance) of a place between these distances at which the force has no
    /// value, or grows so fast towards a pole that no motion passes it; the pole of an odd force at
    /// the equilibrium itself is none.
    pub fn gap(&self, from: f64, to: f64) -> Option<f64> {
        const SAMPLES: usize = 48;
        let (from, to) = (from.min(to), from.max(to));
        let size = from.abs().max(to.abs());
        let defined = |y: f64| {
            self.value(y).is_finite()
                || [-1e-9, 1e-9].iter().all(|d| self.value(y + d * size).is_finite())
        };
        let sample = |k: usize| {
            let half = 0.5 - 0.5 * (std::f64::consts::PI * (k as f64 + 0.5) / SAMPLES as f64).cos();
            from + (to - from) * half
        };
        let samples: Vec<f64> = std::iter::once(from)
            .chain((0..SAMPLES).map(sample))
            .chain(std::iter::once(to))
            .collect();
        if let Some(outside) = samples.iter().copied().find(|&y| !defined(y)) {
            let inside = samples.iter().copied().filter(|&y| defined(y));
            let nearest = inside.min_by(|a, b| (a - outside).abs().total_cmp(&(b - outside).abs()));
            let [_, outside] =
                bisect(defined, nearest.unwrap_or(outside), outside, BisectionStop::Halvings(60));
            return Some(self.equilibrium() + outside);
        }
        if self.of.features().is_empty() {
            return None;
        }
        let places = self.of.features().between(self.equilibrium() + from, self.equilibrium() + to);
        places
            .into_iter()
            .map(|feature| feature.place)
            .filter(|place| (from..=to).contains(&(place - self.equilibrium())))
            .filter(|place| {
                (place - self.equilibrium()).abs() > 8.0 * f64::EPSILON * self.equilibrium().abs()
            })
            .find(|&place| {
                // Only at zero does the answer depend on the amplitude, so that it must not be
                // remembered.
                let known = self.of.poles.borrow().get(&place.to_bits()).copied();
                let pole = known.filter(|_| place != 0.0);
                pole.unwrap_or_else(|| {
                    let found = self.is_pole(place, size);
                    self.of.poles.borrow_mut().insert(place.to_bits(), found);
                    found
                })
            })
    }

    /// The part of the force that is beyond double precision at the distance `y`, in words; `None`
    /// if the force is finite there or has no value for another reason.
    pub fn overflow(&self, y: f64) -> Option<String> {
        let mut there = self.of.numbers.clone();
        there.insert(self.of.coordinate, self.equilibrium() + y);
        match self.value(y).is_finite() {
            true => None,
            false => self.of.force.overflow(&there),
        }
    }

    /// Whether the force grows towards a place so fast that its potential is infinite there: like
    /// the inverse of the distance or faster, or nearly so, over the two closest decades in which
    /// rounding leaves the force a digit.
    pub fn is_pole(&self, place: f64, size: f64) -> bool {
        const DECADES: i32 = 13;
        const FASTER_THAN: f64 = 0.83;
        let scale = if place == 0.0 { size } else { place.abs() };
        let strength = |distance: f64| {
            let sides = [-distance, distance].map(|side| {
                let there = |symbol: Symbol| match symbol == self.of.coordinate {
                    true => Some((place + side, 0.0)),
                    false => self.of.numbers.get(&symbol).map(|&value| (value, 0.0)),
                };
                let found = self.of.force.evaluate_rounded(&there);
                found.filter(|(value, error)| value.is_finite() && *error <= 0.1 * value.abs())
            });
            let known = sides.into_iter().flatten().map(|(value, _)| value.abs());
            known.fold(None, |most: Option<f64>, value| {
                Some(most.map_or(value, |most| most.max(value)))
            })
        };
        let near = (0..DECADES).map(|k| scale * 10.0_f64.powi(k - DECADES));
        let pair =
            near.filter_map(|distance| Some((strength(distance)?, strength(100.0 * distance)?)));
        let mut pairs = pair.take(1);
        pairs.next().is_some_and(|(close, far)| close > far * 100.0_f64.powf(FASTER_THAN))
    }
}

impl AtNumbers {
    fn features(&self) -> &Features {
        self.features.get_or_init(|| {
            // The poles of the tangent are the zeros of the cosine.
            let quotients =
                self.force.fold(|expr, children: &[Expr]| match (expr.node(), children) {
                    (Node::Function(Function::Tan, _), [argument]) => {
                        Expr::divide(&argument.sin()?, &argument.cos()?)
                    }
                    _ => expr.with_children(children),
                });
            let force = quotients.as_ref().unwrap_or(&self.force);
            Features::new(force, self.coordinate, &self.numbers)
        })
    }

    /// The Taylor coefficients about the equilibrium; `None` if there are none.
    fn expanded(&self) -> Option<Vec<f64>> {
        let moved = Expr::from(self.coordinate) + self.equilibrium.0.clone();
        let about = self.force.substitute(self.coordinate, &moved).ok()?;
        let mut at_one = self.numbers.clone();
        at_one.insert(self.coordinate, 1.0);
        let up_to = |degree: u32| -> Option<Vec<f64>> {
            let parts = taylor(&about, &[(self.coordinate, Rational::zero())], degree).ok()?;
            let mut coefficients: Vec<f64> =
                parts.iter().map(|part| part.evaluate(&at_one).ok()).collect::<Option<_>>()?;
            // At the equilibrium the force is zero, whatever rounding says.
            *coefficients.first_mut()? = 0.0;
            Some(coefficients)
        };
        let coefficients = up_to(DEGREE)?;
        match coefficients[1] == 0.0 {
            true => up_to(DEGREE_OF_HIGHER_POWERS),
            false => Some(coefficients),
        }
    }
}

/// The force at a place; `None` if it has no finite value there.
fn value_at(
    force: &Expr,
    coordinate: Symbol,
    place: f64,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    let mut there = numbers.clone();
    there.insert(coordinate, place);
    force.evaluate(&there).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(text: &str, equilibrium: &str, amplitude: f64) -> CentredForce {
        let [force, equilibrium]: [Expr; 2] = [text, equilibrium].map(|text| text.parse().unwrap());
        CentredForce::new(&force, "x".into(), &equilibrium, &BTreeMap::new(), amplitude).unwrap()
    }

    #[test]
    fn no_digits_are_lost_near_rest() {
        type Truth = fn(f64) -> f64;
        let cases: [(&str, &str, Truth); 4] = [
            ("exp(x) - 1", "0", |y| y.exp_m1()),
            ("exp(-x) - exp(-2*x)", "0", |y| (-2.0 * y).exp() * y.exp_m1()),
            ("x^2 - 2", "sqrt(2)", |y| y * (y + 8.0_f64.sqrt())),
            ("1/(1 - x)^2 - 4", "1/2", |y| 4.0 * (4.0 * y - 4.0 * y * y) / (1.0 - 2.0 * y).powi(2)),
        ];
        for (text, equilibrium, truth) in cases {
            for power in 1..20 {
                let amplitude = 10.0_f64.powi(-power);
                let found = force(text, equilibrium, amplitude);
                for y in [amplitude, -0.37 * amplitude, 0.01 * amplitude] {
                    let error = found.value(y) / truth(y) - 1.0;
                    // A hundredth of the amplitude may lose what does not count beside the whole.
                    assert!(
                        error.abs() < 3e-14 * amplitude / y.abs() * 10.0,
                        "{text} at {y}: {error:e}"
                    );
                }
            }
        }
    }

    /// `(1 - cos y)/y = 2 sin^2(y/2)/y` and `(exp y - 1)/y - 1`, which the series alone give near
    /// rest.
    #[test]
    fn a_removable_singularity_is_filled_in() {
        let cosine = |y: f64| 2.0 * (0.5 * y).sin().powi(2) / y;
        for amplitude in [2.0, 0.5, 1e-3, 1e-9] {
            let found = force("(1 - cos(x))/x", "0", amplitude);
            assert_eq!(found.value(0.0), 0.0);
            assert!((found.slope(0.0) - 0.5).abs() < 1e-15);
            for y in [amplitude, -0.37 * amplitude, 1e-3 * amplitude, 1e-7 * amplitude] {
                let error = (found.value(y) - cosine(y)).abs() / cosine(amplitude);
                assert!(error < 1e-13, "{y}: {error:e}");
            }
            let other = force("(exp(x) - 1)/x - 1", "0", amplitude);
            assert_eq!(other.value(0.0), 0.0);
            assert!((other.slope(1e-12 * amplitude) - 0.5).abs() < 1e-11);
        }
        // A pole is not filled in.
        assert!(!force("x - 1/x^3", "0", 0.5).value(0.0).is_finite());
    }

    #[test]
    fn poles_and_ends_are_found() {
        let gap = |text: &str, from, to| force(text, "0", 1.0).gap(from, to);
        let near = |found: Option<f64>, place: f64| {
            found.is_some_and(|found| (found - place).abs() < 1e-6)
        };
        assert!(near(gap("x/(1 - x)^2", -2.0, 2.0), 1.0));
        assert!(near(gap("x/(1 - 2*x + x^2)", -2.0, 2.0), 1.0));
        assert!(near(gap("x - 1/4/(1 - x)^2", -2.0, 2.0), 1.0));
        assert!(near(gap("tan(x)", -1.6, 1.6).map(f64::abs), std::f64::consts::FRAC_PI_2));
        assert!(near(gap("x + log(1 + x)", -1.5, 1.5), -1.0));
        assert!(near(gap("x/sqrt(1 - x^2)", -1.5, 1.5).map(f64::abs), 1.0));
        assert!(near(gap("asin(x)", -1.5, 1.5).map(f64::abs), 1.0));
        // Seen from another equilibrium the place is still a place, not a distance.
        assert!(near(force("(x - 2)/(5 - x)^2", "2", 1.0).gap(-4.0, 4.0), 5.0));
        assert!(near(force("log(x/2)", "2", 1.0).gap(-3.0, 3.0), 0.0));
        assert_eq!(force("(x - 2)/(5 - x)^2", "2", 1.0).gap(-2.9, 2.9), None);
        for (text, reach) in [
            ("x/(1 - x)^2", 0.999),
            ("tan(x)", 1.57),
            ("sin(x)/x + x", 1.0),
            ("1/x", 2.0),
            ("x^(-1/3)", 2.0),
            ("x + (x - 1)^(3/2)*H(x - 1)", 3.0),
            ("x + 5*abs(x - 1) + sgn(x - 1)", 3.0),
            ("x + H(x - 1)/(x + 1)", 2.0),
            ("x^3/(1 + x^2)", 1e6),
        ] {
            assert_eq!(gap(text, -reach, reach), None, "{text}");
        }
    }
}
