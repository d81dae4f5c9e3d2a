//! The straight line that replaces the elastic force during a contact, equation (15): F(depth) ~ p
//! x - q.
//!
//! In: the force per unit of gamma as a closure of the depth, the greatest depth D, a [`Rule`].
//! Out: a [`LinearContactForce`].
//!
//! With F(d) the force, the six rules are, on 0 <= d <= D,
//!
//! ```text
//! least squares            min over a, s of  int_0^D (F(d) - a - s d)^2 dd
//! least squares, origin    min over s    of  int_0^D (F(d) - s d)^2 dd
//! equal energy             s D^2 / 2 = int_0^D F dd
//! equal peak force         s D = F(D)
//! harmonic balance         s = 2/(pi D) int_0^pi F(D sin phi) sin phi dphi         depth a half sine
//! equal duration           pi / sqrt(s) = 2 int_0^D dd / sqrt(2 int_d^D F)          half period of a spring
//! ```
//!
//! The paper says "least square method" and no more; the affine line is the plain reading, so that
//! is the default. It is not zero at touch: the acceleration jumps there by gamma times
//! [`LinearContactForce::at_touch`].

use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth, nodes_and_weights};
use crate::numeric::ode::root::{RootError, find_root};

/// The rule that fits the line. The names are those of problem files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rule {
    /// `least-squares`: continuous least squares, slope and constant.
    #[default]
    LeastSquares,
    /// `least-squares-origin`: continuous least squares, no force at touch.
    LeastSquaresThroughTouch,
    /// `equal-energy`: the same work up to the greatest depth.
    EqualEnergy,
    /// `equal-peak-force`: the same force at the greatest depth.
    EqualPeak,
    /// `harmonic-balance`: the same first harmonic when the depth is a half sine.
    HarmonicBalance,
    /// `equal-duration`: the same duration of contact, gravity apart.
    EqualDuration,
}

impl Rule {
    /// Every rule, in the order of the documentation.
    pub const ALL: [Self; 6] = [
        Self::LeastSquares,
        Self::LeastSquaresThroughTouch,
        Self::EqualEnergy,
        Self::EqualPeak,
        Self::HarmonicBalance,
        Self::EqualDuration,
    ];

    /// The name in problem files.
    pub fn name(self) -> &'static str {
        match self {
            Self::LeastSquares => "least-squares",
            Self::LeastSquaresThroughTouch => "least-squares-origin",
            Self::EqualEnergy => "equal-energy",
            Self::EqualPeak => "equal-peak-force",
            Self::HarmonicBalance => "harmonic-balance",
            Self::EqualDuration => "equal-duration",
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// The error of a name that is not a rule.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "unknown linearisation `{0}`: choose least-squares, least-squares-origin, equal-energy, equal-peak-force, \
     harmonic-balance or equal-duration"
)]
pub struct UnknownRule(pub String);

impl FromStr for Rule {
    type Err = UnknownRule;

    fn from_str(name: &str) -> Result<Self, UnknownRule> {
        Self::ALL
            .into_iter()
            .find(|rule| rule.name() == name)
            .ok_or_else(|| UnknownRule(name.to_owned()))
    }
}

/// force ~ at_touch + slope * depth, per unit of gamma.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearContactForce {
    /// Force per depth: p of equation (15).
    pub slope: f64,
    /// Force at depth zero: not zero for the affine least squares.
    pub at_touch: f64,
}

impl LinearContactForce {
    /// q of equation (15), where the line is written p x - q with the barrier at x_c: q = p x_c -
    /// F(touch).
    pub fn q(&self, barrier: f64) -> f64 {
        self.slope * barrier - self.at_touch
    }
}

/// The reason why there is no line.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum LinearisationError {
    /// The greatest depth is not a positive number.
    #[error(
        "the force cannot be replaced by a line over the depth {0}: the greatest depth must be a positive number"
    )]
    Depth(f64),
    /// The force does not push back.
    #[error("the elastic force does no positive work up to the depth {0}: it must push back")]
    NotElastic(f64),
    /// The force stays below the energy of the impact at any depth.
    #[error(
        "the elastic force stops no impact of energy {0:e} (per unit of gamma): it must grow with the depth"
    )]
    NeverStops(f64),
    /// The energy is used up at a depth that underflows.
    #[error(
        "the elastic force stops an impact of energy {0:e} (per unit of gamma) in a depth below 1e-119: no line is fitted to so stiff a contact"
    )]
    TooShallow(f64),
    /// An integral over the force failed.
    #[error("the elastic force is not smooth enough to be replaced by a line: {0}")]
    Quadrature(#[from] QuadratureError),
    /// The force has no finite value somewhere.
    #[error("the elastic force has no finite value: {0}")]
    Force(#[from] RootError),
}

/// The line that replaces `elastic_force` (a function of the depth, per unit of gamma) on depths
/// from 0 to `deepest`.
///
/// # Errors
/// [`LinearisationError`]: a depth that is not positive, a force that is not finite or does not
/// push back.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Rule, fit, hertz::elastic_force};
///
/// let line = fit(Rule::EqualPeak, elastic_force, 0.25)?;
/// assert!((line.slope - 0.5).abs() < 1e-12 && line.at_touch == 0.0);
/// # Ok::<(), lindstedt::impact::LinearisationError>(())
/// ```
pub fn fit(
    rule: Rule,
    elastic_force: impl Fn(f64) -> f64,
    deepest: f64,
) -> Result<LinearContactForce, LinearisationError> {
    if !(deepest.is_finite() && deepest > 0.0) {
        return Err(LinearisationError::Depth(deepest));
    }
    let work = work(&elastic_force, deepest)?;
    if work <= 0.0 {
        return Err(LinearisationError::NotElastic(deepest));
    }
    let through_touch = |slope: f64| LinearContactForce { slope, at_touch: 0.0 };
    match rule {
        Rule::LeastSquares => least_squares(&elastic_force, deepest, true),
        Rule::LeastSquaresThroughTouch => least_squares(&elastic_force, deepest, false),
        Rule::EqualEnergy => Ok(through_touch(2.0 * work / (deepest * deepest))),
        Rule::EqualPeak => Ok(through_touch(elastic_force(deepest) / deepest)),
        Rule::HarmonicBalance => {
            // phi = u^2 makes powers of sqrt(depth) smooth at touch; the second quarter is the
            // mirror image.
            let half = |u: f64| {
                let sine = (u * u).sin();
                2.0 * u * elastic_force(deepest * sine) * sine
            };
            let (quarter, _) = integrate_smooth(half, 0.0, (0.5 * PI).sqrt(), 1e-13)?;
            Ok(through_touch(4.0 * quarter / (PI * deepest)))
        }
        Rule::EqualDuration => {
            let duration = spring_free_duration(&elastic_force, deepest)?;
            Ok(through_touch((PI / duration).powi(2)))
        }
    }
}

/// The work of the force up to this depth, int_0^depth F.
///
/// # Errors
/// A force that is not finite or not smooth.
pub fn work(elastic_force: impl Fn(f64) -> f64, depth: f64) -> Result<f64, QuadratureError> {
    // d = q^2 makes any force in powers of sqrt(d) smooth.
    match integrate_smooth(|q| 2.0 * q * elastic_force(q * q), 0.0, depth.max(0.0).sqrt(), 1e-14) {
        // A force that is a difference of nearly equal numbers near the touch has no more digits
        // than this.
        Err(QuadratureError::NotConverged { value, error_estimate, .. })
            if error_estimate <= 1e-11 * value.abs() =>
        {
            Ok(value)
        }
        result => result.map(|(work, _)| work),
    }
}

/// The depth at which the force has done this work: where an impact of that energy (per unit of
/// gamma) turns, gravity apart. For Hertz contact of stiffness gamma and energy v^2/(2 gamma) it is
/// (5 v^2/(4 gamma))^(2/5).
///
/// # Errors
/// [`LinearisationError::NeverStops`] if no depth suffices, [`LinearisationError::TooShallow`] if
/// every depth does, and those of [`work`].
pub fn greatest_depth(
    elastic_force: impl Fn(f64) -> f64,
    energy: f64,
) -> Result<f64, LinearisationError> {
    if !(energy.is_finite() && energy > 0.0) {
        return Err(LinearisationError::NeverStops(energy));
    }
    // A depth at which the force has no value, as one beyond the range of numbers, is too deep.
    let missing = |root_depth: f64| match work(&elastic_force, root_depth * root_depth) {
        Ok(work) => work / energy - 1.0,
        Err(_) => 1.0,
    };
    // The unknown is sqrt(depth): doubled or halved until it brackets.
    let (mut low, mut high) = (1.0, 1.0);
    for _ in 0..200 {
        if missing(low) > 0.0 {
            low *= 0.5;
        } else if missing(high) < 0.0 {
            high *= 2.0;
        } else {
            return Ok(find_root(missing, low, high)?.powi(2));
        }
    }
    Err(match low < 1.0 {
        true => match work(&elastic_force, low * low) {
            Err(error) => error.into(),
            Ok(_) => LinearisationError::TooShallow(energy),
        },
        false => LinearisationError::NeverStops(energy),
    })
}

/// Weighted least squares at Gauss points in sqrt(depth): the integral of the squared misfit,
/// exactly enough.
fn least_squares(
    elastic_force: impl Fn(f64) -> f64,
    deepest: f64,
    with_constant: bool,
) -> Result<LinearContactForce, LinearisationError> {
    // Depth = deepest * q^2, weight of the depth 2 q dq; the unknowns are scaled by the peak force.
    let peak = elastic_force(deepest).abs().max(f64::MIN_POSITIVE);
    let nodes: Vec<(f64, f64)> = nodes_and_weights(0.0, 1.0).collect();
    let columns = if with_constant { 2 } else { 1 };
    let mut matrix = DMatrix::zeros(nodes.len(), columns);
    let mut right = DVector::zeros(nodes.len());
    for (row, &(q, weight)) in nodes.iter().enumerate() {
        let root_weight = (2.0 * q * weight).sqrt();
        let force = elastic_force(deepest * q * q) / peak;
        if !force.is_finite() {
            return Err(QuadratureError::NonFinite { at: deepest * q * q }.into());
        }
        right[row] = root_weight * force;
        matrix[(row, 0)] = root_weight * q * q;
        if with_constant {
            matrix[(row, 1)] = root_weight;
        }
    }
    let factors = matrix.qr();
    let projected = factors.q().tr_mul(&right);
    let solution = factors
        .r()
        .solve_upper_triangular(&projected)
        .ok_or(LinearisationError::NotElastic(deepest))?;
    let at_touch = if with_constant { solution[1] * peak } else { 0.0 };
    Ok(LinearContactForce { slope: solution[0] * peak / deepest, at_touch })
}

/// Duration of a contact turned at this depth by the force alone, at unit gamma: 2 int_0^D dd /
/// sqrt(2 int_d^D F).
fn spring_free_duration(
    elastic_force: impl Fn(f64) -> f64,
    deepest: f64,
) -> Result<f64, QuadratureError> {
    // d = q^2, q = q_m (1 - w^2): then int_d^D F = q_m w^2 M(q), M the mean of 2 q F(q^2) between q
    // and q_m.
    let root = deepest.sqrt();
    let mean = |q: f64| {
        let summand = |(fraction, weight): (f64, f64)| {
            let at = q + fraction * (root - q);
            weight * 2.0 * at * elastic_force(at * at)
        };
        nodes_and_weights(0.0, 1.0).map(summand).sum::<f64>()
    };
    let integrand = |w: f64| {
        let q = root * (1.0 - w * w);
        8.0 * q / (2.0 * mean(q) / root).sqrt()
    };
    Ok(integrate_smooth(integrand, 0.0, 1.0, 1e-13)?.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::hertz;
    use proptest::prelude::*;

    /// Slope and constant in units of sqrt(D) and D^(3/2), for F = d^(3/2).
    fn hertz_line(rule: Rule, deepest: f64) -> (f64, f64) {
        let line = fit(rule, hertz::elastic_force, deepest).unwrap();
        (line.slope / deepest.sqrt(), line.at_touch / deepest.powf(1.5))
    }

    #[test]
    fn the_lines_of_a_hertz_contact() {
        use spec_math::cephes64::gamma;
        // Exact: int y^(3/2) (1, y) = 2/5, 2/7; normal equations for the affine line, Gamma
        // functions for the last two.
        let half_sine = 2.0 / PI.sqrt() * gamma(1.75) / gamma(2.25);
        let factor = 0.8 * PI.sqrt() * gamma(0.4) / gamma(0.9);
        let table = [
            (Rule::LeastSquares, 36.0 / 35.0, -4.0 / 35.0),
            (Rule::LeastSquaresThroughTouch, 6.0 / 7.0, 0.0),
            (Rule::EqualEnergy, 0.8, 0.0),
            (Rule::EqualPeak, 1.0, 0.0),
            (Rule::HarmonicBalance, half_sine, 0.0),
            (Rule::EqualDuration, 0.8 * (PI / factor).powi(2), 0.0),
        ];
        assert!((table[4].1 - 0.91531).abs() < 5e-6 && (table[5].1 - 0.91144).abs() < 5e-6);
        for deepest in [1e-6, 1.3e-3, 0.5, 40.0] {
            for (rule, slope, constant) in table {
                let (found, touch) = hertz_line(rule, deepest);
                assert!(
                    (found - slope).abs() < 1e-12,
                    "{rule} at depth {deepest}: slope {found} against {slope}"
                );
                assert!(
                    (touch - constant).abs() < 1e-12,
                    "{rule} at depth {deepest}: constant {touch}"
                );
            }
        }
    }

    #[test]
    fn a_spring_is_its_own_line() {
        for rule in Rule::ALL {
            let line = fit(rule, |depth| 7.0 * depth, 0.02).unwrap();
            assert!(
                (line.slope - 7.0).abs() < 1e-11 && line.at_touch.abs() < 1e-13,
                "{rule}: {line:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn no_other_line_is_closer(
            slope_change in -0.1..0.1_f64, constant_change in -0.1..0.1_f64, power in 1.0..3.0_f64
        ) {
            let force = |depth: f64| depth.powf(power);
            let misfit = |line: LinearContactForce| {
                let square = |d: f64| (force(d) - line.at_touch - line.slope * d).powi(2);
                integrate_smooth(square, 0.0, 1.0, 1e-10).unwrap().0
            };
            let best = fit(Rule::LeastSquares, force, 1.0).unwrap();
            let other = LinearContactForce { slope: best.slope + slope_change, at_touch: best.at_touch + constant_change };
            prop_assert!(misfit(best) <= misfit(other) + 1e-9);
        }

        #[test]
        fn the_greatest_depth_of_hertz_contact_is_its_closed_form(
            gamma_power in -3.0..12.0_f64, speed_power in -4.0..1.0_f64
        ) {
            let (gamma, speed) = (10.0_f64.powf(gamma_power), 10.0_f64.powf(speed_power));
            let depth = greatest_depth(hertz::elastic_force, 0.5 * speed * speed / gamma).unwrap();
            prop_assert!((depth / hertz::penetration(gamma, speed).unwrap() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_constant_of_a_line_is_its_value_at_the_touch() {
        // p x - q with the barrier at 0.323: the constant of the affine line shifts q.
        let line = fit(Rule::LeastSquares, hertz::elastic_force, 1.093e-3).unwrap();
        assert!((line.slope * 0.323 - line.q(0.323) - line.at_touch).abs() < 1e-15);
    }

    #[test]
    fn names_read_back() {
        for rule in Rule::ALL {
            assert_eq!(rule.to_string().parse(), Ok(rule));
        }
        let unknown = "least_squares".parse::<Rule>().unwrap_err().to_string();
        assert!(unknown.contains("`least_squares`") && unknown.contains("equal-duration"));
        assert!(Rule::ALL.into_iter().all(|rule| unknown.contains(rule.name())));
    }

    #[test]
    fn what_is_no_elastic_force_is_refused() {
        for deepest in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                fit(Rule::EqualPeak, hertz::elastic_force, deepest),
                Err(LinearisationError::Depth(_))
            ));
        }
        for rule in Rule::ALL {
            assert!(fit(rule, |_| f64::NAN, 1.0).is_err(), "{rule}");
            assert!(
                matches!(fit(rule, |depth| -depth, 1.0), Err(LinearisationError::NotElastic(_))),
                "{rule}"
            );
        }
        assert!(matches!(greatest_depth(|_| 0.0, 1.0), Err(LinearisationError::NeverStops(_))));
        assert!(greatest_depth(|_| f64::NAN, 1.0).is_err());
    }
}
