//! A nonlinear tuned absorber: the two peaks of the steady motions of its equations with all
//! harmonics, and the cubic spring that makes them equally high.
//!
//! In units in which F is 1, the equations have the cubic coefficients `alpha3 F^2` and `b3 F^2`.

use super::{AbsorberCurve, AbsorberCurveKind, LowestPeak, Truth, tuned};
use crate::absorber::AbsorberLaws;
use crate::response::{ResponseRequest, respond};
use crate::symbol::Symbol;
use crate::values::Values;

const DESIGN: &str = "similar-springs";

/// The relative change of height by the springs between which there is something to resolve, and
/// the law is one of small changes.
const CHANGES: std::ops::Range<f64> = 1e-5..0.5;

/// The response curve of x, and the heights of its two peaks.
struct Peaks {
    curve: Vec<(f64, f64)>,
    heights: [f64; 2],
}

impl Peaks {
    /// By how much the lower peak is higher than the upper one.
    fn difference(&self) -> f64 {
        (self.heights[0] / self.heights[1]).ln()
    }
}

/// The response with this cubic coefficient of the absorber; `None` unless it is one branch with two
/// peaks.
fn peaks(laws: &AbsorberLaws, numbers: &str, cubic: f64, range: [f64; 2]) -> Option<Peaks> {
    let sides = laws.equations.iter().map(|(left, right)| format!("{left} = {right}"));
    let equations = sides.collect::<Vec<_>>().join("; ");
    let request =
        ResponseRequest::new(&equations, "g", range, &format!("{numbers}, b3 = {cubic}")).ok()?;
    let found = respond(&request).ok()?;
    let [branch] = found.branches.as_slice() else { return None };
    let mut curve = Vec::new();
    for point in &branch.points {
        curve.push((point.parameter, point.coordinates.first()?.amplitude));
    }
    let tops = curve.windows(3).filter(|near| near[1].1 > near[0].1 && near[1].1 >= near[2].1);
    let heights: Vec<f64> = tops.map(top).collect();
    let heights = <[f64; 2]>::try_from(heights).ok()?;
    Some(Peaks { curve, heights })
}

/// The height of the parabola through three points.
fn top(near: &[(f64, f64)]) -> f64 {
    let (left, right) = (near[0].0 - near[1].0, near[2].0 - near[1].0);
    let [slope_left, slope_right] =
        [(near[0].1 - near[1].1) / left, (near[2].1 - near[1].1) / right];
    let bend = (slope_right - slope_left) / (right - left);
    let slope = slope_left - bend * left;
    near[1].1 - slope * slope / (4.0 * bend)
}

/// The true values of the design, and response curves with and without the cubic spring.
pub(super) fn truth(laws: &AbsorberLaws, at: &Values) -> Truth {
    let letter = |name: &str| at.get(Symbol::new(name)).unwrap_or(f64::NAN);
    let formula = |name: &str| laws.named_value(DESIGN, name, at);
    let mass_ratio = letter("mu");
    let mut truth = Truth::default();
    let Some(LowestPeak { tuning, damping, height }) = tuned::lowest_peak(mass_ratio) else {
        return truth;
    };
    truth.values = vec![(DESIGN, "tuning", Some(tuning)), (DESIGN, "damping", Some(damping))];
    let square = letter("F") * letter("F");
    let known = (|| Some([formula("tuning")?, formula("damping")?, formula("cubic")?]))();
    let (Some([f, zeta, cubic]), Some(law)) = (known, formula("lower_height")) else {
        return truth;
    };
    if !CHANGES.contains(&(1.0 - law / height).abs()) {
        return truth;
    }
    let numbers = format!(
        "mu = {mass_ratio}, alpha3 = {}, F = 1, f = {f}, zeta = {zeta}",
        letter("alpha3") * square
    );
    // The fixed points of the linear absorber, between which the curve dips; a stiffer main mass
    // has its peaks at higher frequencies.
    let swing = (mass_ratio / (2.0 + mass_ratio)).sqrt();
    let [low, high] = [1.0 - swing, 1.0 + swing].map(|own| (own / (1.0 + mass_ratio)).sqrt());
    let range = [low - (high - low) / 2.0, 2.0 * high - low];
    let with = |cubic: f64| peaks(laws, &numbers, cubic * square, range);
    let (own, linear) = (with(cubic), with(0.0));
    let mut add = |name: &str, kind, peaks: &Peaks| {
        let [lower, upper] = peaks.heights;
        let label = format!("{name}, peaks {lower:.3} and {upper:.3}");
        truth.curves.push(AbsorberCurve { label, kind, points: peaks.curve.clone() });
    };
    if let Some(linear) = &linear {
        add("linear spring", AbsorberCurveKind::Background, linear);
    }
    let Some(own) = own else { return truth };
    add("with the cubic spring", AbsorberCurveKind::Truth, &own);
    truth.curves.push(AbsorberCurve {
        label: "height by the formula".to_owned(),
        kind: AbsorberCurveKind::Formula,
        points: range.map(|g| (g, law)).to_vec(),
    });
    let best = linear.and_then(|linear| {
        equal_peaks([(0.0, linear.difference()), (cubic, own.difference())], &|cubic| {
            with(cubic).map(|peaks| peaks.difference())
        })
    });
    truth.values.extend([
        (DESIGN, "cubic", best),
        (DESIGN, "lower_height", Some(own.heights[0])),
        (DESIGN, "upper_height", Some(own.heights[1])),
    ]);
    truth
}

/// The cubic coefficient at which the peaks are equally high, by secants from two of them with their
/// differences.
fn equal_peaks(
    [mut last, mut own]: [(f64, f64); 2],
    difference: &dyn Fn(f64) -> Option<f64>,
) -> Option<f64> {
    const MOST_STEPS: usize = 6;
    for _ in 0..MOST_STEPS {
        let next = own.0 - own.1 * (own.0 - last.0) / (own.1 - last.1);
        if (next - own.0).abs() <= 1e-4 * own.0.abs() {
            return Some(next);
        }
        (last, own) = (own, (next, difference(next)?));
    }
    None
}
