//! Steady motions of a driven oscillator: the frequency-response equation and what follows from it.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1.1 to 4.1.4 and 5.7.
//!
//! In: the slow equations of a driven motion. Out, in symbols, the relation between amplitude and detuning, its branches, its
//! peak and the places where two branches meet; at numbers, every steady motion with the eigenvalues that decide its stability.

use nalgebra::Matrix2;

use super::Solution;
use super::spurious::Orders;
use crate::exact::Polynomial;
use crate::expr::Expr;
use crate::numeric::ode::root::find_root;
use crate::symbol::Symbol;

/// What is known of the steady motions of a driven oscillator. Everything is in the amplitude, the parameters and the definitions
/// of the solution, the detuning among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// `x(t)` in `t`, the amplitude and the phase of the slow equations.
    pub motion: Expr,
    /// The frequency-response equation: zero at every steady motion; `None` where the phase cannot be eliminated.
    pub relation: Option<Polynomial>,
    /// The relation solved for the detuning, where it is quadratic in that.
    pub branches: Option<Branches>,
    /// The largest amplitude of all detunings, where it has a closed form.
    pub peak: Option<Expr>,
    /// The squares of the amplitudes at which two branches meet, by the detuning, where they have a closed form.
    pub folds: Vec<Expr>,
    /// The discriminant of the relation in the square of the amplitude: zero where two branches meet, which is where the
    /// amplitude jumps.
    pub jumps: Option<Polynomial>,
    /// What stands for the relation and its branches where they are no polynomials.
    pub closed: Option<ClosedRelation>,
    /// The slow equations in coordinates without a singular origin, where they are polynomials in them.
    pub plane: Option<Plane>,
}

/// A frequency-response equation of a force that is no polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedRelation {
    /// Zero at every steady motion.
    pub relation: Expr,
    /// The backbone: the detuning in the middle of both branches.
    pub centre: Expr,
    /// The square of their distance from it.
    pub width_squared: Expr,
}

/// `detuning = centre + and - sqrt(width_squared)`; the centre is the backbone.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    /// The middle of both.
    pub centre: Polynomial,
    /// The square of their distance from it; steady motions have amplitudes where it is not negative.
    pub width_squared: Polynomial,
}

/// The slow equations in `u = a cos(psi/m)`, `v = -a sin(psi/m)`, with `m` of the resonance.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// `u` and `v`.
    pub coordinates: [Symbol; 2],
    /// `u'` and `v'`.
    pub rates: [Polynomial; 2],
    /// The same by parts, each by its orders: what drains, what turns, and each wave of the phase; first what leads, then what comes
    /// one, two, ... orders later. Nothing where each part has one order alone.
    pub parts: Vec<Vec<[Polynomial; 2]>>,
}

/// A steady motion at numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyState {
    /// The amplitude; zero for the motion without a part of its own.
    pub amplitude: f64,
    /// The phase of the slow equations, from -pi to pi.
    pub phase: f64,
    /// Real and imaginary part of the eigenvalues of the slow equations about it, per unit of time: the larger first, of a pair that
    /// with the positive imaginary part.
    pub eigenvalues: [(f64, f64); 2],
}

/// The steady motions of slow equations at numbers, largest amplitude first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SteadyMotions {
    /// Those of the equation.
    pub states: Vec<SteadyState>,
    /// Those that only the truncation of the slow equations makes.
    pub spurious: Vec<SteadyState>,
}

impl SteadyState {
    /// Whether small disturbances die out.
    pub fn is_stable(&self) -> bool {
        self.eigenvalues.iter().all(|value| value.0 < 0.0)
    }

    /// Whether amplitude and phase are those of another one, up to rounding.
    fn is_same(&self, other: &Self) -> bool {
        const ROUNDING: f64 = 1e-8;
        let apart = (self.amplitude - other.amplitude).abs();
        apart <= ROUNDING * self.amplitude && wrapped(self.phase - other.phase).abs() <= ROUNDING
    }
}

impl Solution {
    /// Every steady motion of a driven oscillator at given values, by its slow equations, largest amplitude first; nothing for
    /// other motions, where a value is missing, and where the phase cannot be eliminated. What steady motions the truncation alone
    /// makes are [left out](Self::steady_motions).
    ///
    /// ```
    /// use lindstedt::{Options, Oscillator, Values, solve};
    ///
    /// let duffing = Oscillator::parse("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)")?;
    /// let solution = solve(&duffing, &Options::default())?;
    /// let at: Values = "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25".parse()?;
    /// let states = solution.steady_states(&|name| at.get(name));
    /// let stable: Vec<bool> = states.iter().map(|state| state.is_stable()).collect();
    /// assert_eq!(stable, [true, false, true]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn steady_states(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Vec<SteadyState> {
        self.steady_motions(value_of).states
    }

    /// The same, and beside them the steady motions of the truncated slow equations that are none of the equation: those that tend to
    /// none of the leading order as all that is small goes to zero, because the series does not converge at their amplitude.
    pub fn steady_motions(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> SteadyMotions {
        let found = self.roots(value_of).unwrap_or_default();
        let plane = self.response.as_ref().and_then(|response| response.plane.as_ref());
        let times = self.modulation.as_ref().and_then(|slow| slow.resonance.as_ref());
        let times = times.map_or(1.0, |resonance| f64::from(resonance.times_linear));
        let orders = plane.and_then(|plane| Orders::new(self, plane, value_of));
        let is_spurious = |state: &SteadyState| {
            let place = on_circle(state.amplitude, state.phase / times);
            state.amplitude > 0.0 && orders.as_ref().is_some_and(|orders| orders.is_spurious(place))
        };
        let (spurious, states) = found.into_iter().partition(is_spurious);
        SteadyMotions { states, spurious }
    }

    fn roots(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<Vec<SteadyState>> {
        let response = self.response.as_ref()?;
        let modulation = self.modulation.as_ref()?;
        let times = f64::from(modulation.resonance.as_ref()?.times_linear);
        let Some(plane) = &response.plane else {
            return super::polar::steady_states(self, modulation, times, value_of);
        };
        let plane = Field::new(self, plane, value_of)?;
        let relation = coefficients(self, response.relation.as_ref()?, self.amplitude.symbol(), value_of)?;
        let mut states: Vec<SteadyState> = Vec::new();
        let state = |[u, v]: [f64; 2]| SteadyState {
            amplitude: u.hypot(v),
            phase: wrapped(times * (-v).atan2(u)),
            eigenvalues: plane.eigenvalues([u, v]),
        };
        for amplitude in amplitudes(&relation) {
            let exact = plane.at_rest_on(amplitude, times);
            let near = || plane.at_rest_near(amplitude, times);
            for place in exact.map_or_else(near, |place| vec![place]) {
                let found = state(place);
                if !states.iter().any(|known| known.is_same(&found)) {
                    states.push(found);
                }
            }
        }
        if plane.at([0.0, 0.0]).iter().all(|rate| rate.abs() < 1e-300) {
            states.push(state([0.0, 0.0]));
        }
        states.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        Some(states)
    }
}

/// An angle from -pi to pi.
pub(super) fn wrapped(angle: f64) -> f64 {
    /// What rounding leaves of an angle that is zero.
    const ROUNDING: f64 = 1e-14;
    let angle = angle.sin().atan2(angle.cos());
    if angle.abs() < ROUNDING { 0.0 } else { angle }
}

/// The coefficients of a polynomial in one symbol, lowest power first.
fn coefficients(
    solution: &Solution,
    polynomial: &Polynomial,
    symbol: Symbol,
    value_of: &dyn Fn(Symbol) -> Option<f64>,
) -> Option<Vec<f64>> {
    let mut parts: Vec<Polynomial> = Vec::new();
    for (monomial, number) in polynomial.terms() {
        let exponent = usize::try_from(monomial.exponent(symbol)).ok()?;
        if parts.len() <= exponent {
            parts.resize_with(exponent + 1, num_traits::Zero::zero);
        }
        parts[exponent].add_term(monomial.without(symbol), number.clone());
    }
    parts
        .iter()
        .map(|part| solution.evaluate(part, value_of).ok())
        .collect()
}

/// The positive roots of a polynomial in the amplitude, of one in its square where it has no odd powers.
fn amplitudes(relation: &[f64]) -> Vec<f64> {
    let odd = relation.iter().skip(1).step_by(2).any(|value| *value != 0.0);
    match odd {
        true => positive_roots(relation),
        false => {
            let in_square: Vec<f64> = relation.iter().step_by(2).copied().collect();
            positive_roots(&in_square).into_iter().map(f64::sqrt).collect()
        }
    }
}

/// The positive roots of a polynomial, lowest coefficient first: between the zeros of its slope.
fn positive_roots(coefficients: &[f64]) -> Vec<f64> {
    let length = coefficients
        .iter()
        .rposition(|value| *value != 0.0)
        .map_or(0, |last| last + 1);
    let coefficients = &coefficients[..length];
    let Some((leading, rest)) = coefficients.split_last().filter(|(_, rest)| !rest.is_empty()) else {
        return vec![];
    };
    let value = |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    // Cauchy's bound.
    let bound = 1.0 + rest.iter().map(|c| (c / leading).abs()).fold(0.0, f64::max);
    if !bound.is_finite() {
        return vec![];
    }
    let slope: Vec<f64> = coefficients
        .iter()
        .enumerate()
        .skip(1)
        .map(|(k, c)| k as f64 * c)
        .collect();
    let mut places = vec![0.0];
    places.extend(positive_roots(&slope));
    places.push(bound);
    let mut roots: Vec<f64> = Vec::new();
    for pair in places.windows(2) {
        if value(pair[0]) * value(pair[1]) < 0.0
            && let Ok(root) = find_root(value, pair[0], pair[1])
        {
            roots.push(root);
        }
    }
    roots
}

/// The slow equations in the plane, and their slopes, at numbers.
struct Field<'a> {
    solution: &'a Solution,
    plane: &'a Plane,
    value_of: &'a dyn Fn(Symbol) -> Option<f64>,
    slopes: [[Polynomial; 2]; 2],
}

impl<'a> Field<'a> {
    /// `None` where a value is missing.
    fn new(solution: &'a Solution, plane: &'a Plane, value_of: &'a dyn Fn(Symbol) -> Option<f64>) -> Option<Self> {
        let slopes = plane
            .rates
            .each_ref()
            .map(|rate| plane.coordinates.map(|coordinate| rate.slope(coordinate)));
        let field = Self {
            solution,
            plane,
            value_of,
            slopes,
        };
        let known = plane.rates.iter().all(|rate| field.value(rate, [1.0, 1.0]).is_finite());
        known.then_some(field)
    }

    fn value(&self, polynomial: &Polynomial, place: [f64; 2]) -> f64 {
        let value_of = |name: Symbol| {
            let own = self.plane.coordinates.iter().position(|own| *own == name);
            own.map(|index| place[index]).or_else(|| (self.value_of)(name))
        };
        self.solution.evaluate(polynomial, &value_of).unwrap_or(f64::NAN)
    }

    fn at(&self, place: [f64; 2]) -> [f64; 2] {
        self.plane.rates.each_ref().map(|rate| self.value(rate, place))
    }

    fn jacobian(&self, place: [f64; 2]) -> Matrix2<f64> {
        let [[a, b], [c, d]] = self
            .slopes
            .each_ref()
            .map(|row| row.each_ref().map(|slope| self.value(slope, place)));
        Matrix2::new(a, b, c, d)
    }

    /// The larger first; of a pair that with the positive imaginary part.
    fn eigenvalues(&self, place: [f64; 2]) -> [(f64, f64); 2] {
        let found = self.jacobian(place).complex_eigenvalues();
        let mut both = [(found[0].re, found[0].im), (found[1].re, found[1].im)];
        let size = |(real, imaginary): (f64, f64)| real.hypot(imaginary);
        let angle = |(real, imaginary): (f64, f64)| imaginary.atan2(real).rem_euclid(std::f64::consts::TAU);
        both.sort_by(|one, other| {
            let sizes = size(*other).total_cmp(&size(*one));
            sizes.then(angle(*one).total_cmp(&angle(*other)))
        });
        both
    }

    /// `a'` and `a psi'/m` at a phase of the slow equations.
    fn polar(&self, radius: f64, angle: f64) -> [f64; 2] {
        let [u, v] = on_circle(radius, angle);
        let [du, dv] = self.at([u, v]);
        [(u * du + v * dv) / radius, (v * du - u * dv) / radius]
    }

    /// Where on the circle of this radius both rates vanish, if they are one wave `P + P_c cos(psi) + P_s sin(psi)` of the phase: three
    /// places tell all, and Newton's steps lead on from there.
    fn at_rest_on(&self, radius: f64, times: f64) -> Option<[f64; 2]> {
        /// Neither a simple part of a turn nor near one.
        const ELSEWHERE: [f64; 2] = [0.7, 2.2];
        const ROUNDING: f64 = 1e-9;
        let [ahead, across, behind] =
            [0.0, 0.5, 1.0].map(|part| self.polar(radius, part * std::f64::consts::PI / times));
        let waves = |k: usize| {
            let mean = (ahead[k] + behind[k]) / 2.0;
            [mean, (ahead[k] - behind[k]) / 2.0, across[k] - mean]
        };
        let both = [waves(0), waves(1)];
        let one_wave = ELSEWHERE.into_iter().all(|phase: f64| {
            let found = self.polar(radius, phase / times);
            both.iter().zip(found).all(|([mean, cosine, sine], found)| {
                let told = mean + cosine * phase.cos() + sine * phase.sin();
                (told - found).abs() <= ROUNDING * (mean.abs() + cosine.abs() + sine.abs())
            })
        });
        if !one_wave {
            return None;
        }
        let [[rate, rate_cos, rate_sin], [turn, turn_cos, turn_sin]] = both;
        let determinant = rate_cos * turn_sin - rate_sin * turn_cos;
        let cosine = (rate_sin * turn - rate * turn_sin) / determinant;
        let sine = (turn_cos * rate - rate_cos * turn) / determinant;
        let found = self.at_rest_from(on_circle(radius, sine.atan2(cosine) / times))?;
        let near = (found[0].hypot(found[1]) / radius - 1.0).abs() < 1e-6;
        near.then_some(found)
    }

    /// Where both rates vanish near the circle of this radius, on which a relation that is cut at an order has them.
    fn at_rest_near(&self, radius: f64, times: f64) -> Vec<[f64; 2]> {
        /// Phases that are tried.
        const STARTS: usize = 24;
        /// By how much of itself the radius may be off.
        const OFF: f64 = 0.2;
        let phase = |k: usize| std::f64::consts::TAU * k as f64 / STARTS as f64;
        let size = |k: usize| {
            let [rate, turn] = self.polar(radius, phase(k % STARTS) / times);
            rate.hypot(turn)
        };
        let lowest = (0..STARTS).filter(|&k| size(k) <= size(k + 1) && size(k) <= size(k + STARTS - 1));
        let found = lowest.filter_map(|k| self.at_rest_from(on_circle(radius, phase(k) / times)));
        found
            .filter(|place| (place[0].hypot(place[1]) / radius - 1.0).abs() < OFF)
            .collect()
    }

    /// Newton's steps from a place to one where both rates vanish.
    fn at_rest_from(&self, start: [f64; 2]) -> Option<[f64; 2]> {
        const STEPS: usize = 40;
        /// A step that rounding leaves, also where two steady motions meet.
        const SETTLED: f64 = 1e-6;
        let radius = start[0].hypot(start[1]);
        let mut place = start;
        let mut moved = f64::INFINITY;
        for _ in 0..STEPS {
            let [u, v] = self.at(place);
            let step = self.jacobian(place).try_inverse()? * nalgebra::Vector2::new(u, v);
            place = [place[0] - step[0], place[1] - step[1]];
            moved = step.norm();
            if moved <= 1e-15 * radius {
                break;
            }
        }
        (moved <= SETTLED * radius).then_some(place)
    }
}

/// `u` and `v` of a radius and an angle.
fn on_circle(radius: f64, angle: f64) -> [f64; 2] {
    [radius * angle.cos(), -radius * angle.sin()]
}
