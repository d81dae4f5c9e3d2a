//! Steady motions of a driven oscillator: the frequency-response equation and what follows from it.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1.1
//! to 4.1.4 and 5.7.
//!
//! In: the slow equations of a driven motion. Out, in symbols, the relation between amplitude and
//! detuning, its branches, its peak and the places where two branches meet; at numbers, every
//! steady motion with the eigenvalues that decide its stability.

use num_traits::{One as _, Zero as _};

use super::Solution;
use super::plane::PlaneField;
use super::spurious::Orders;
use crate::exact::rational::Rational;
use crate::exact::{Monomial, Polynomial};
use crate::expr::Expr;
use crate::symbol::Symbol;

/// The steady motions of a driven oscillator. Everything is in the amplitude, the parameters and
/// the definitions of the solution, the detuning among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// `x(t)` in `t`, the amplitude and the phase of the slow equations.
    pub motion: Expr,
    /// The frequency-response equation: zero at every steady motion; `None` if the phase cannot be
    /// eliminated.
    pub relation: Option<Polynomial>,
    /// The relation solved for the detuning, where it is quadratic in that.
    pub branches: Option<Branches>,
    /// The largest amplitude of all detunings, where it has a closed form.
    pub peak: Option<Expr>,
    /// The squares of the amplitudes at which two branches meet, by the detuning, where they have a
    /// closed form.
    pub folds: Vec<Expr>,
    /// The discriminant of the relation in the square of the amplitude: zero where two branches
    /// meet, which is where the amplitude jumps.
    pub jumps: Option<Polynomial>,
    /// The relation and its branches if they are not polynomials.
    pub closed: Option<ClosedRelation>,
    /// The slow equations in coordinates without a singular origin, where they are polynomials in
    /// them.
    pub plane: Option<Plane>,
}

/// A frequency-response equation of a force that is not a polynomial.
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
    /// The square of their distance from it; steady motions have amplitudes where it is not
    /// negative.
    pub width_squared: Polynomial,
}

impl Branches {
    /// The frequency-response equation as the sum of the squares of damping and detuning beside the
    /// drive, `[(detuning - centre)^2 + damping] a^k = drive`: both sides. `None` where the drive is not
    /// one term of the squared distance from the backbone, with the amplitude in its denominator.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Options, Oscillator, solve};
    ///
    /// let duffing = Oscillator::parse("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)")?;
    /// let response = solve(&duffing, &Options::default())?.response.ok_or("no response")?;
    /// let branches = response.branches.ok_or("not quadratic")?;
    /// let [left, right] = branches.by_squares("sigma".into(), "a".into()).ok_or("no drive")?;
    /// assert_eq!(format!("{left} = {right}"), "a^2*(64*zeta^2 + (8*sigma - 3*eps*a^2)^2) = 16*F^2");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_squares(&self, detuning: Symbol, amplitude: Symbol) -> Option<[Expr; 2]> {
        let (lowest, _) = self.width_squared.exponent_range(amplitude)?;
        if lowest >= 0 {
            return None;
        }
        let factor = Monomial::power_of(amplitude, -lowest);
        let (mut drive, mut damping) = (Polynomial::zero(), Polynomial::zero());
        for (monomial, number) in self.width_squared.terms() {
            match monomial.exponent(amplitude) < 0 {
                true => drive.add_term(monomial.product(&factor), number.clone()),
                false => damping.add_term(monomial.clone(), -number.clone()),
            }
        }
        drive.single_term()?;
        let distance = &Expr::from(detuning) - &Expr::from(&self.centre);
        let squares =
            Expr::sum([Expr::from(&damping), Expr::product([distance.clone(), distance])]);
        let factor = Expr::from(&Polynomial::term(factor, Rational::one()));
        let left = Expr::product([factor, squares]);
        // Without the denominator that both terms of the left side have.
        let (number, _) = left.factors();
        let divided = |side: &Expr| Expr::divide(side, &Expr::number(number.clone())).ok();
        Some([divided(&left)?, divided(&Expr::from(&drive))?])
    }
}

/// The slow equations in `u = a cos(psi/m)`, `v = -a sin(psi/m)`, with `m` of the resonance.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// `u` and `v`.
    pub coordinates: [Symbol; 2],
    /// `u'` and `v'`.
    pub rates: [Polynomial; 2],
    /// The rates by parts, each by its orders: damping, detuning, and each wave of the phase; first
    /// the leading order, then the next ones. Empty if each part has one order alone.
    pub parts: Vec<Vec<[Polynomial; 2]>>,
}

/// A steady motion at numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyState {
    /// The amplitude; zero if the motion has no resonant part.
    pub amplitude: f64,
    /// The phase of the slow equations, from -pi to pi.
    pub phase: f64,
    /// Real and imaginary part of the eigenvalues of the slow equations about it, per unit of time:
    /// the larger first, of a pair that with the positive imaginary part.
    pub eigenvalues: [(f64, f64); 2],
}

/// The steady motions of slow equations at numbers, largest amplitude first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SteadyMotions {
    /// The steady motions of the equation.
    pub states: Vec<SteadyState>,
    /// The steady motions that only the truncation of the slow equations makes.
    pub spurious: Vec<SteadyState>,
}

impl SteadyState {
    /// Whether small disturbances die out.
    pub fn is_stable(&self) -> bool {
        self.eigenvalues.iter().all(|value| value.0 < 0.0)
    }
}

impl Solution {
    /// Every steady motion of a driven oscillator at given values, by its slow equations, largest
    /// amplitude first; `None` for other motions, and where a value is missing. Those at an
    /// amplitude at which the series hardly converges are [left out](Self::steady_motions).
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
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

    /// Every place at which both rates of the slow equations vanish, and apart from the others
    /// those at an amplitude at which the last order of the slow equations is more than half of the
    /// one before it: there the series hardly converges.
    pub fn steady_motions(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> SteadyMotions {
        // Definitions are evaluated once, not with each coefficient.
        let defined = self.defined_values(value_of).unwrap_or_default();
        let value_of = &|name: Symbol| {
            let own = defined.iter().find(|(known, _)| *known == name);
            own.map(|(_, value)| *value).or_else(|| value_of(name))
        };
        let found = self.roots(value_of).unwrap_or_default();
        let orders = || {
            let plane = self.response.as_ref()?.plane.as_ref()?;
            let resonance = self.modulation.as_ref()?.resonance.as_ref()?;
            let driving = self.evaluate_expression(&resonance.driving_frequency, value_of)?;
            let frequency = driving.abs() * f64::from(resonance.times_driving)
                / f64::from(resonance.times_linear);
            Orders::new(self, plane, frequency, value_of)
        };
        let orders = orders();
        let is_spurious = |state: &SteadyState| {
            let orders = orders.as_ref();
            orders
                .is_some_and(|orders| state.amplitude > 0.0 && orders.is_spurious(state.amplitude))
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
        let field = PlaneField::new(self, plane, times, value_of)?;
        let state = |[u, v]: [f64; 2]| SteadyState {
            amplitude: u.hypot(v),
            phase: wrapped(times * (-v).atan2(u)),
            eigenvalues: field.eigenvalues([u, v]),
        };
        let mut states: Vec<SteadyState> = field.places_of_rest().into_iter().map(state).collect();
        if field.rates_at([0.0, 0.0]).iter().all(|rate| rate.abs() < 1e-300) {
            states.push(state([0.0, 0.0]));
        }
        // States whose amplitudes agree up to rounding keep the order of their phases.
        let size = |state: &SteadyState| (1e9 * state.amplitude.ln()).round();
        states.sort_by(|a, b| size(b).total_cmp(&size(a)));
        Some(states)
    }
}

/// An angle from -pi to pi.
pub(super) fn wrapped(angle: f64) -> f64 {
    /// Rounding error of an angle that is zero.
    const ROUNDING: f64 = 1e-14;
    let angle = angle.sin().atan2(angle.cos());
    if angle.abs() < ROUNDING { 0.0 } else { angle }
}
