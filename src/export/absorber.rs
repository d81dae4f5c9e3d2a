//! The curves of an absorber as a picture and as a table of comma-separated values.

use std::fmt::Write as _;

use super::figure::{Curve, CurveStyle, FigureError, Panel, Scale, figure};
use crate::absorber::{AbsorberKind, AbsorberLaws};
use crate::absorber_verdict::{AbsorberCurve, AbsorberCurveKind, JudgedAbsorber};

/// The response of a tuned mass damper with each design, that of a nonlinear absorber with and without
/// its cubic spring, or the manifold of a sink with a motion
/// that follows it.
///
/// # Errors
/// [`FigureError`], as of [`figure`].
///
/// ```
/// use lindstedt::absorber::{AbsorberKind, Excitation, derive};
/// use lindstedt::absorber_verdict::judge_absorber;
///
/// let laws = derive(AbsorberKind::Tuned(Excitation::Force))?;
/// let judged = judge_absorber(&laws, &"mu = 1/20".parse()?, 0.01)?;
/// assert!(lindstedt::export::absorber::picture(&laws, &judged)?.contains("fixed points"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture(laws: &AbsorberLaws, judged: &JudgedAbsorber) -> Result<String, FigureError> {
    let [title, x_label, y_label] = axes(laws.kind);
    let mut designs = 0;
    let curves = judged.curves.iter().map(|curve| {
        let style = match (laws.kind, curve.kind) {
            (AbsorberKind::Tuned(_) | AbsorberKind::Damped(_), AbsorberCurveKind::Truth)
            | (AbsorberKind::Nonlinear, AbsorberCurveKind::Truth | AbsorberCurveKind::Background) =>
            {
                designs += 1;
                CurveStyle::SERIES[(designs - 1) % CurveStyle::SERIES.len()]
            }
            (_, AbsorberCurveKind::Truth) => CurveStyle::SIMULATED,
            (_, AbsorberCurveKind::Background) => CurveStyle::ONE_OF_MANY,
            (_, AbsorberCurveKind::Formula) => CurveStyle::DIFFERENCE,
            (_, AbsorberCurveKind::Unstable) => CurveStyle::UNSTABLE,
            (_, AbsorberCurveKind::Points) => CurveStyle::MARKED_POINTS,
        };
        Curve { label: &curve.label, points: &curve.points, style }
    });
    let x_scale = match laws.kind {
        AbsorberKind::Tuned(_) | AbsorberKind::Damped(_) if is_wide(&judged.curves) => {
            Scale::Logarithmic
        }
        _ => Scale::Linear,
    };
    let curves = curves.collect();
    let panel = Panel { title, x_label, y_label, x_scale, curves, ..Panel::default() };
    let values = judged.at.iter().map(|(name, value)| format!("{name} = {value}"));
    figure(&[panel], &format!("{}.", values.collect::<Vec<_>>().join(", ")))
}

/// Whether frequencies are so far apart that the lowest cannot be told apart in a linear picture, as
/// both fixed points of a heavy absorber.
fn is_wide(curves: &[AbsorberCurve]) -> bool {
    const WIDE: f64 = 20.0;
    let places = || curves.iter().flat_map(|curve| &curve.points).map(|(x, _)| *x);
    let (least, greatest) = (places().fold(f64::INFINITY, f64::min), places().fold(0.0, f64::max));
    least > 0.0 && greatest > WIDE * least
}

/// Title and axes of the picture.
fn axes(kind: AbsorberKind) -> [&'static str; 3] {
    match kind {
        AbsorberKind::Tuned(_) => {
            ["Tuned mass damper", "frequency g", "amplitude over the static one"]
        }
        AbsorberKind::Damped(_) => [
            "Tuned mass damper on a damped main mass",
            "frequency g",
            "amplitude over the static one",
        ],
        AbsorberKind::Nonlinear => {
            ["Nonlinear tuned absorber", "frequency g", "amplitude of x over F"]
        }
        AbsorberKind::CubicSink => [
            "Nonlinear energy sink",
            "amplitude of the main mass C",
            "relative amplitude of the sink N",
        ],
        AbsorberKind::ImpactSink => {
            ["Vibro-impact sink", "amplitude of the main mass C", "amplitude of the ball Z"]
        }
        AbsorberKind::PendulumSink => [
            "Pendulum between barriers",
            "amplitude of the main mass C",
            "amplitude of the pendulum Z",
        ],
    }
}

/// The points of all curves, a row each.
///
/// ```
/// use lindstedt::absorber::{AbsorberKind, derive};
/// use lindstedt::absorber_verdict::judge_absorber;
///
/// let laws = derive(AbsorberKind::ImpactSink)?;
/// let judged = judge_absorber(&laws, &"r = 0.65, b = 1, mu = 0.01".parse()?, 0.01)?;
/// let table = lindstedt::export::absorber::csv(&laws, &judged);
/// assert!(table.lines().nth(1) == Some("curve,kind,label,x,y"), "{table}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(laws: &AbsorberLaws, judged: &JudgedAbsorber) -> String {
    let [_, x_label, y_label] = axes(laws.kind);
    let mut text = format!("# x: {x_label}; y: {y_label}\ncurve,kind,label,x,y\n");
    for (number, curve) in judged.curves.iter().enumerate() {
        for (x, y) in &curve.points {
            let label = &curve.label;
            let _ = writeln!(text, "{},{},\"{label}\",{x},{y}", number + 1, curve.kind.name());
        }
    }
    text
}
