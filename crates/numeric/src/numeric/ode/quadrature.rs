//! The integral of a smooth function, with an error estimate.
//!
//! In: a function, an interval, a tolerance. Out: the value and an error estimate, or an error.
//!
//! The 20-point Gauss-Legendre rule is applied to a panel and to its two halves; the difference of
//! the two is the error estimate of the panel. It is that of the coarse value: the halves, which
//! make up the result, are far better. The panel with the largest estimate is halved until the
//! estimates together are below the tolerance times the integral of |f|.
//!
//! Singular ends are to be substituted away first: `x = -A + s^2` makes the time integral of an
//! energy `dx / sqrt(2 (V(A) - V(x)))` smooth.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::ode::quadrature::integrate_smooth;
//! let (area, _) = integrate_smooth(f64::sin, 0.0, std::f64::consts::PI, 1e-13)?;
//! assert!((area - 2.0).abs() < 1e-14);
//! # Ok::<(), lindstedt::numeric::ode::quadrature::QuadratureError>(())
//! ```

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use gauss_quad::GaussLegendre;
use thiserror::Error;

/// The reason why no integral was returned.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum QuadratureError {
    /// An end of the interval is not a finite number.
    #[error("the integral from {from} to {to} is not over a finite interval: map it to one first")]
    Interval {
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// The tolerance is not a positive number.
    #[error("the quadrature tolerance must be a positive number, not {0}")]
    Tolerance(f64),
    /// The integrand has no finite value at this point.
    #[error(
        "the integrand has no finite value at {at}: split the interval there or substitute the singularity away"
    )]
    NonFinite {
        /// The argument.
        at: f64,
    },
    /// The tolerance was not reached.
    #[error(
        "the integral did not settle: {value:.6e} with an estimated error of {error_estimate:.1e}; the integrand is not smooth \
         near {worst_at}: split the interval there or substitute the singularity away"
    )]
    NotConverged {
        /// The best value found.
        value: f64,
        /// Its error estimate, absolute.
        error_estimate: f64,
        /// Middle of the panel with the largest error.
        worst_at: f64,
    },
}

/// Points of the rule used on each panel.
const POINTS: NonZeroUsize = NonZeroUsize::MIN.saturating_add(19);

/// Number of panels after which the integrand counts as not smooth.
const MAXIMUM_PANELS: usize = 1000;

static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(POINTS));

/// Places and weights of the 20-point rule of Gauss and Legendre on an interval, in increasing order.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::quadrature::gauss_points;
/// let cube: f64 = gauss_points(0.0, 2.0).iter().map(|[x, weight]| weight * x.powi(3)).sum();
/// assert!((cube - 4.0).abs() < 1e-14);
/// ```
pub fn gauss_points(from: f64, to: f64) -> Vec<[f64; 2]> {
    let half = 0.5 * (to - from);
    let middle = 0.5 * (from + to);
    let pairs = RULE.as_node_weight_pairs().iter();
    let mut points: Vec<[f64; 2]> =
        pairs.map(|(node, weight)| [middle + half * node, half * weight]).collect();
    points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    points
}

/// Integral of `function` from `from` to `to`, and its absolute error estimate.
///
/// `tolerance` is relative to the integral of |f|; below 1e-14 rounding decides and 1e-14 is used.
/// `from > to` gives the negative integral.
///
/// # Errors
/// [`QuadratureError`]: an infinite interval, a tolerance that is not a positive number, an
/// integrand without a finite value, or no convergence within 1000 panels; the last one carries the
/// best value.
pub fn integrate_smooth(
    function: impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
    tolerance: f64,
) -> Result<(f64, f64), QuadratureError> {
    integrate_piecewise(function, &[from, to], tolerance)
}

/// Integral of a `function` that is smooth between neighbouring `ends`, from the first of them to
/// the last, and its absolute error estimate.
///
/// `tolerance` is relative to the integral of |f| over all pieces, so that a piece that adds next
/// to nothing, on which the integrand may be little but rounding, is not halved in vain. Otherwise
/// as [`integrate_smooth`].
///
/// # Errors
/// As [`integrate_smooth`], with one more panel allowed for every further piece.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::quadrature::integrate_piecewise;
/// let (area, _) = integrate_piecewise(f64::abs, &[-1.0, 0.0, 2.0], 1e-13)?;
/// assert!((area - 2.5).abs() < 1e-14);
/// # Ok::<(), lindstedt::numeric::ode::quadrature::QuadratureError>(())
/// ```
pub fn integrate_piecewise(
    function: impl FnMut(f64) -> f64,
    ends: &[f64],
    tolerance: f64,
) -> Result<(f64, f64), QuadratureError> {
    integrate_within(function, ends, [tolerance, 0.0], MAXIMUM_PANELS)
}

/// Integral of a smooth `function` that is a part of a sum of size `whole`, with the error
/// `tolerance` times the larger of the two. Near the end of an interval where the integrand is a
/// difference of nearly equal numbers, a tolerance relative to the integral alone would demand
/// digits that the integrand lacks.
///
/// # Errors
/// As [`integrate_smooth`].
pub fn integrate_part(
    function: impl FnMut(f64) -> f64,
    [from, to]: [f64; 2],
    tolerance: f64,
    whole: f64,
) -> Result<f64, QuadratureError> {
    let tolerances = [tolerance, tolerance * whole.abs()];
    Ok(integrate_within(function, &[from, to], tolerances, MAXIMUM_PANELS)?.0)
}

/// Integrates as [`integrate_piecewise`], with a relative and an absolute tolerance, of which the
/// larger counts, and with at most `most_panels` panels for the first piece: few, if the caller
/// itself halves the interval.
///
/// # Errors
/// As [`integrate_piecewise`].
pub(crate) fn integrate_within(
    mut function: impl FnMut(f64) -> f64,
    ends: &[f64],
    [tolerance, absolute]: [f64; 2],
    most_panels: usize,
) -> Result<(f64, f64), QuadratureError> {
    let pieces = || ends.windows(2).map(|pair| (pair[0], pair[1]));
    if let Some((from, to)) =
        pieces().find(|(from, to)| !(from.is_finite() && to.is_finite() && (to - from).is_finite()))
    {
        return Err(QuadratureError::Interval { from, to });
    }
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(QuadratureError::Tolerance(tolerance));
    }
    let tolerance = tolerance.max(1e-14);
    let mut panels = Vec::new();
    for (from, to) in pieces().filter(|(from, to)| from != to) {
        let coarse = gauss(&mut function, from, to)?.0;
        panels.push(QuadraturePanel::split(&mut function, from, to, coarse)?);
    }
    let most = most_panels + panels.len().saturating_sub(1);
    // The running sums cost nothing, but collect rounding errors: only when they are near the
    // tolerance are all panels added up anew.
    let total = |panels: &[QuadraturePanel], of: fn(&QuadraturePanel) -> f64| {
        panels.iter().map(of).sum::<f64>()
    };
    let mut running_error = total(&panels, |panel| panel.error);
    let mut running_magnitude = total(&panels, |panel| panel.magnitude);
    loop {
        let sum = |of: fn(&QuadraturePanel) -> f64| total(&panels, of);
        let bound = |magnitude: f64| absolute.max(tolerance * magnitude);
        if running_error.is_nan() || running_error <= 2.0 * bound(running_magnitude) {
            let error_estimate = sum(|panel| panel.error);
            if error_estimate <= bound(sum(|panel| panel.magnitude)) {
                return Ok((sum(QuadraturePanel::value), error_estimate));
            }
        }
        let worst =
            panels.iter().enumerate().max_by(|one, other| one.1.error.total_cmp(&other.1.error));
        let Some((index, &panel)) = worst else {
            return Ok((0.0, 0.0));
        };
        let middle = panel.middle();
        if panels.len() >= most
            || middle <= panel.from.min(panel.to)
            || middle >= panel.from.max(panel.to)
        {
            return Err(QuadratureError::NotConverged {
                value: sum(QuadraturePanel::value),
                error_estimate: sum(|panel| panel.error),
                worst_at: middle,
            });
        }
        let left = QuadraturePanel::split(&mut function, panel.from, middle, panel.left)?;
        let right = QuadraturePanel::split(&mut function, middle, panel.to, panel.right)?;
        running_error += left.error + right.error - panel.error;
        running_magnitude += left.magnitude + right.magnitude - panel.magnitude;
        panels[index] = left;
        panels.push(right);
    }
}

/// Returns the nodes and weights of the 20-point Gauss-Legendre rule on `[from, to]`, for sums that
/// need the points themselves, such as a least-squares fit.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::quadrature::nodes_and_weights;
/// let integral: f64 = nodes_and_weights(0.0, 2.0).map(|(x, weight)| weight * x.powi(3)).sum();
/// assert!((integral - 4.0).abs() < 1e-14);
/// ```
pub fn nodes_and_weights(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    RULE.iter().map(move |&(node, weight)| (middle + half * node, half * weight))
}

/// One panel, already integrated on its two halves.
#[derive(Clone, Copy)]
struct QuadraturePanel {
    from: f64,
    to: f64,
    left: f64,
    right: f64,
    magnitude: f64,
    error: f64,
}

impl QuadraturePanel {
    fn split(
        function: &mut impl FnMut(f64) -> f64,
        from: f64,
        to: f64,
        coarse: f64,
    ) -> Result<Self, QuadratureError> {
        let middle = 0.5 * (from + to);
        let (left, left_magnitude) = gauss(function, from, middle)?;
        let (right, right_magnitude) = gauss(function, middle, to)?;
        let magnitude = left_magnitude + right_magnitude;
        Ok(Self { from, to, left, right, magnitude, error: (coarse - left - right).abs() })
    }

    fn value(&self) -> f64 {
        self.left + self.right
    }

    fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }
}

/// Returns the integrals of f and of |f| by one application of the rule.
fn gauss(
    function: &mut impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
) -> Result<(f64, f64), QuadratureError> {
    let (mut sum, mut magnitude) = (0.0, 0.0);
    for (at, weight) in nodes_and_weights(from, to) {
        let value = function(at);
        if !value.is_finite() {
            return Err(QuadratureError::NonFinite { at });
        }
        sum += weight * value;
        magnitude += (weight * value).abs();
    }
    Ok((sum, magnitude))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name, function, the two ends, the integral.
    type Case = (&'static str, fn(f64) -> f64, f64, f64, f64);

    #[test]
    fn integrals_known_in_closed_form() {
        let table: [Case; 6] = [
            ("polynomial", |x| x.powi(9), 0.0, 2.0, 102.4),
            ("negative direction", f64::cos, 1.0, 0.0, -(1.0_f64.sin())),
            ("a narrow bell", |x| 1.0 / (1.0 + 1e6 * x * x), -1.0, 1.0, 2e-3 * 1000.0_f64.atan()),
            ("zero by symmetry", f64::sin, -3.0, 3.0, 0.0),
            ("many waves", |x| (200.0 * x).sin(), 0.0, 1.0, (1.0 - 200.0_f64.cos()) / 200.0),
            ("an end that is not smooth", f64::sqrt, 0.0, 1.0, 2.0 / 3.0),
        ];
        for (name, function, from, to, exact) in table {
            let (value, error_estimate) = integrate_smooth(function, from, to, 1e-12).unwrap();
            let error = (value - exact).abs();
            assert!(error <= 1e-12 * exact.abs().max(1.0), "{name}: {value} against {exact}");
            assert!(
                error <= error_estimate + 1e-15 * exact.abs().max(1.0),
                "{name}: error {error} above its estimate {error_estimate}"
            );
        }
    }

    #[test]
    fn the_complete_elliptic_integral() {
        for m in [0.0, 0.3, 0.9, 0.999_999] {
            // 1 - m sin^2 written without cancellation.
            let integrand = |angle: f64| 1.0 / (1.0 - m + m * angle.cos().powi(2)).sqrt();
            let (value, _) =
                integrate_smooth(integrand, 0.0, std::f64::consts::FRAC_PI_2, 1e-13).unwrap();
            let exact = ellip::ellipk(m).unwrap();
            assert!((value / exact - 1.0).abs() < 1e-13, "m = {m}: {value} against {exact}");
        }
    }

    #[test]
    fn what_cannot_be_integrated_is_refused() {
        let refuse = |function: fn(f64) -> f64, from, to| {
            integrate_smooth(function, from, to, 1e-10).unwrap_err()
        };
        assert!(matches!(refuse(f64::exp, 0.0, f64::INFINITY), QuadratureError::Interval { .. }));
        assert!(matches!(refuse(f64::ln, -1.0, 1.0), QuadratureError::NonFinite { .. }));
        assert!(matches!(refuse(|x| 1.0 / x, 0.0, 1.0), QuadratureError::NotConverged { .. }));
        assert!(matches!(
            integrate_smooth(f64::exp, 0.0, 1.0, 0.0),
            Err(QuadratureError::Tolerance(_))
        ));
        assert_eq!(integrate_smooth(f64::exp, 2.0, 2.0, 1e-10), Ok((0.0, 0.0)));
        assert_eq!(integrate_piecewise(f64::exp, &[2.0], 1e-10), Ok((0.0, 0.0)));
        assert!(matches!(
            integrate_piecewise(f64::exp, &[0.0, f64::NAN, 1.0], 1e-10),
            Err(QuadratureError::Interval { .. })
        ));
    }

    /// The argument of a steep function is rounded to nine digits at its step, and the pieces there
    /// have no digits of their own to lose.
    #[test]
    fn a_piece_that_adds_nothing_is_not_halved_for_its_rounding() {
        let places = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1];
        let mirrored = places.iter().rev().map(|place| -place);
        let cuts = mirrored.chain(places).map(|place| f64::acos(-place));
        let ends: Vec<f64> = [0.0].into_iter().chain(cuts).chain([std::f64::consts::PI]).collect();
        let mut calls = 0;
        let integrand = |theta: f64| {
            calls += 1;
            (1e6 * theta.cos()).atan() * theta.cos()
        };
        let (value, error) = integrate_piecewise(integrand, &ends, 1e-14).unwrap();
        // int_0^pi atan(a cos) cos = pi (sqrt(1 + a^2) - 1)/a.
        let exact = std::f64::consts::PI * (1e12_f64.sqrt().hypot(1.0) - 1.0) / 1e6;
        assert!((value - exact).abs() < 1e-13 && error < 1e-13, "{value} {exact} {error}");
        assert!(calls < 10_000, "{calls}");
    }
}
