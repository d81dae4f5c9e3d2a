//! Time along a motion whose speed is known as a function of the place: t(z) = int_0^z rate(z)
//! weight(z) dz, and back.
//!
//! In: the rate, a smooth function, and the weight, as closures. Out: panels on each of which both
//! are Legendre series, halved until the last of 20 coefficients vanish; the time is the integral
//! term by term, `int P_k = (P_(k+1) - P_(k-1))/(2 k + 1)`.

use super::ContactError;
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::numeric::ode::root::find_root;

/// Points of a Gauss rule, and coefficients of a series on a panel.
const POINTS: usize = 20;

/// The last coefficients of a series that is resolved, relative to its largest.
const RESOLVED: f64 = 1e-13;

/// Largest number of panels; a motion that needs more is not that of a smooth force.
const MOST_PANELS: usize = 400;

/// A smooth function on an interval as a Legendre series, and the time as the integral of it with a
/// weight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LegendrePanel {
    pub(super) from: f64,
    pub(super) to: f64,
    /// Time at both ends.
    pub(super) start: f64,
    pub(super) end: f64,
    function: [f64; POINTS],
    /// The time since the start.
    time: [f64; POINTS + 1],
}

impl LegendrePanel {
    fn coordinate(&self, at: f64) -> f64 {
        ((at - self.from) - (self.to - at)) / (self.to - self.from)
    }

    pub(super) fn time_at(&self, at: f64) -> f64 {
        self.start + legendre_sum(&self.time, self.coordinate(at))
    }

    pub(super) fn function_at(&self, at: f64) -> f64 {
        legendre_sum(&self.function, self.coordinate(at))
    }
}

/// The function from `from` to `to` on as many panels as it needs, and the time, the integral of
/// function times weight.
pub(super) fn expand(
    function: impl Fn(f64) -> Result<f64, ContactError>,
    weight: impl Fn(f64) -> f64,
    from: f64,
    to: f64,
) -> Result<Vec<LegendrePanel>, ContactError> {
    let mut panels: Vec<LegendrePanel> = Vec::new();
    let mut waiting = vec![(from, to)];
    while let Some((from, to)) = waiting.pop() {
        let (mut values, mut rates) = ([0.0; POINTS], [0.0; POINTS + 1]);
        for (point, (at, _)) in nodes_and_weights(from, to).enumerate() {
            values[point] = function(at)?;
            rates[point] = values[point] * weight(at);
        }
        let half = 0.5 * (to - from);
        let (function, rate) = (coefficients(&values), coefficients(&rates[..POINTS]));
        let resolved = |series: &[f64; POINTS]| {
            let largest = series.iter().fold(0.0_f64, |largest, term| largest.max(term.abs()));
            series[POINTS - 2].abs() + series[POINTS - 1].abs() <= RESOLVED * largest
        };
        if !(resolved(&function) && resolved(&rate)) && to - from > 1e-15 * to {
            if panels.len() + waiting.len() > MOST_PANELS {
                return Err(ContactError::NotSmooth);
            }
            let middle = 0.5 * (from + to);
            waiting.extend([(middle, to), (from, middle)]);
            continue;
        }
        // int P_0 = P_0 + P_1 from the left end, int P_k = (P_(k+1) - P_(k-1))/(2 k + 1).
        let mut time = [0.0; POINTS + 1];
        for (k, coefficient) in rate.iter().enumerate() {
            let part = half * coefficient / (2 * k + 1) as f64;
            time[k + 1] += part;
            time[k.saturating_sub(1)] += if k == 0 { part } else { -part };
        }
        let start = panels.last().map_or(0.0, |panel| panel.end);
        let end = start + legendre_sum(&time, 1.0);
        panels.push(LegendrePanel { from, to, start, end, function, time });
    }
    Ok(panels)
}

/// The Legendre coefficients of a function by its values at the Gauss points.
fn coefficients(values: &[f64]) -> [f64; POINTS] {
    let mut coefficients = [0.0; POINTS];
    for ((x, weight), value) in nodes_and_weights(-1.0, 1.0).zip(values) {
        let (mut before, mut polynomial) = (0.0, 1.0);
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            let degree = k as f64;
            *coefficient += (degree + 0.5) * weight * value * polynomial;
            let next = ((2.0 * degree + 1.0) * x * polynomial - degree * before) / (degree + 1.0);
            (before, polynomial) = (polynomial, next);
        }
    }
    coefficients
}

fn legendre_sum(coefficients: &[f64], x: f64) -> f64 {
    let (mut before, mut polynomial, mut sum) = (0.0, 1.0, 0.0);
    for (k, coefficient) in coefficients.iter().enumerate() {
        let degree = k as f64;
        sum += coefficient * polynomial;
        let next = ((2.0 * degree + 1.0) * x * polynomial - degree * before) / (degree + 1.0);
        (before, polynomial) = (polynomial, next);
    }
    sum
}

/// The time at the end of the last panel.
pub(super) fn length(panels: &[LegendrePanel]) -> f64 {
    panels.last().map_or(0.0, |panel| panel.end)
}

/// The place at which the time has this value, and the function there.
pub(super) fn invert(panels: &[LegendrePanel], time: f64) -> (f64, f64) {
    let number =
        panels.partition_point(|panel| panel.end < time).min(panels.len().saturating_sub(1));
    let Some(panel) = panels.get(number) else {
        return (0.0, f64::INFINITY);
    };
    let late = |at: f64| panel.time_at(at) - time;
    let nearer = if time - panel.start < panel.end - time { panel.from } else { panel.to };
    let at = find_root(late, panel.from, panel.to).unwrap_or(nearer);
    (at, panel.function_at(at))
}
