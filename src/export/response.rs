//! Branches of steady states as comma-separated values and as a picture; text by [`text::document`](super::text::document).

use std::fmt::Write as _;

#[cfg(feature = "plot")]
use super::figure::{Curve, CurveStyle, FigureError, Panel, figure};
use crate::response::Response;
#[cfg(feature = "plot")]
use crate::response::{Point, bifurcation::BifurcationKind};

/// Every point of every branch, the bifurcations, the backbone and the simulations, a row each; a first line of comment says what the
/// columns are.
///
/// ```
/// use lindstedt::response::{Question, respond};
///
/// let question = Question::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// let table = lindstedt::export::response::csv(&respond(&question)?);
/// assert!(table.lines().nth(2).is_some_and(|row| row.starts_with("branch,1,0.5,")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(response: &Response) -> String {
    let mut text = format!(
        "# kind: branch, slow (by slow equations), simulated, backbone or the kind of a bifurcation; amplitude: of the first harmonic; peak: half of peak to peak\n\
         kind,branch,{},amplitude,phase,peak,stable,multiplier,error\n",
        response.question.parameter
    );
    let optional = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    for (index, branch) in response.branches.iter().enumerate() {
        for point in &branch.points {
            let stable = match point.stable {
                Some(true) => "1",
                Some(false) => "0",
                None => "",
            };
            let _ = writeln!(
                text,
                "branch,{},{},{},{},{},{stable},{},{}",
                index + 1,
                point.parameter,
                point.amplitude,
                point.phase,
                point.peak,
                optional(point.multipliers.map(|multipliers| multipliers[0].norm())),
                optional(point.error)
            );
        }
    }
    for found in &response.bifurcations {
        let _ = writeln!(
            text,
            "{},{},{},{},,{},,,",
            found.kind.name(),
            found.branch + 1,
            found.parameter,
            found.amplitude,
            found.peak
        );
    }
    for state in response.slow.iter().flat_map(|slow| &slow.states) {
        let _ = writeln!(
            text,
            "slow,,{},{},{},,{},,",
            state.parameter,
            state.amplitude,
            state.phase,
            u8::from(state.stable)
        );
    }
    for simulated in &response.simulated {
        let _ = writeln!(
            text,
            "simulated,,{},{},,{},,,{}",
            simulated.parameter, simulated.amplitude, simulated.peak, simulated.error
        );
    }
    for point in response.backbone.iter().flatten() {
        let _ = writeln!(text, "backbone,,{},{},,,,,", point.parameter, point.amplitude);
    }
    text
}

/// Places in the parameter and the height, joined.
#[cfg(feature = "plot")]
type Line = Vec<(f64, f64)>;

/// The height of a point: the amplitude of the first harmonic; of motions of several periods of the drive, the peak.
#[cfg(feature = "plot")]
fn height(response: &Response, amplitude: f64, peak: f64) -> f64 {
    match response.question.periods {
        1 => amplitude,
        _ => peak,
    }
}

/// The pieces of a branch in the parameter and the height that are stable, or that are not; neighbouring pieces share a point.
#[cfg(feature = "plot")]
fn pieces(response: &Response, points: &[Point], stable: bool) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    let place = |point: &Point| (point.parameter, height(response, point.amplitude, point.peak));
    for pair in points.windows(2) {
        let [from, to] = pair else { continue };
        if (to.stable == Some(true)) != stable {
            open = false;
            continue;
        }
        match pieces.last_mut() {
            Some(piece) if open => piece.push(place(to)),
            _ => pieces.push(vec![place(from), place(to)]),
        }
        open = true;
    }
    pieces
}

/// The branches, stable ones solid and unstable ones dashed, the backbone, simulations as dots, bifurcations marked.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::response::{Question, respond};
///
/// let question = Question::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// assert!(lindstedt::export::response::picture(&respond(&question)?)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "plot")]
pub fn picture(response: &Response) -> Result<String, FigureError> {
    let [stable, unstable] = [true, false].map(|stable| {
        let branches = response.branches.iter();
        branches
            .flat_map(|branch| pieces(response, &branch.points, stable))
            .collect::<Vec<_>>()
    });
    let backbones: Vec<Vec<(f64, f64)>> = match response.question.periods {
        1 => response
            .backbone
            .iter()
            .map(|curve| curve.iter().map(|point| (point.parameter, point.amplitude)).collect())
            .collect(),
        _ => vec![],
    };
    let simulated: Vec<(f64, f64)> = response
        .simulated
        .iter()
        .map(|found| (found.parameter, height(response, found.amplitude, found.peak)))
        .collect();
    let marks = [
        (BifurcationKind::Fold, "fold", CurveStyle::MARKED_POINTS),
        (
            BifurcationKind::BranchPoint,
            "branch point",
            CurveStyle::SECOND_MARKED_POINTS,
        ),
        (
            BifurcationKind::PeriodDoubling,
            "period doubling",
            CurveStyle::THIRD_MARKED_POINTS,
        ),
        (
            BifurcationKind::NeimarkSacker,
            "Neimark-Sacker",
            CurveStyle::FOURTH_MARKED_POINTS,
        ),
    ];
    let marked: Vec<Vec<(f64, f64)>> = marks
        .iter()
        .map(|(kind, ..)| {
            let of_kind = response.bifurcations.iter().filter(|found| found.kind == *kind);
            of_kind
                .map(|found| (found.parameter, height(response, found.amplitude, found.peak)))
                .collect()
        })
        .collect();
    let mut curves = Vec::new();
    let lines = |label: &'static str, pieces: Vec<Vec<(f64, f64)>>, style| {
        pieces.into_iter().map(move |points| (label, points, style))
    };
    let mut drawn: Vec<(&str, Line, CurveStyle)> =
        lines("free, without damping", backbones, CurveStyle::BACKBONE).collect();
    drawn.extend(lines("unstable", unstable, CurveStyle::UNSTABLE));
    drawn.extend(lines("stable", stable, CurveStyle::DIFFERENCE));
    let slow = response.slow.as_ref();
    let title = slow.map(|slow| slow.solution.title()).unwrap_or_default();
    let states = slow.into_iter().flat_map(|slow| &slow.states);
    drawn.push((
        &title,
        states.map(|state| (state.parameter, state.amplitude)).collect(),
        CurveStyle::SLOW,
    ));
    drawn.push(("simulated", simulated, CurveStyle::SIMULATED));
    drawn.extend(
        marks
            .iter()
            .zip(marked)
            .map(|((_, label, style), points)| (*label, points, *style)),
    );
    for (label, points, style) in drawn.iter().filter(|(_, points, _)| !points.is_empty()) {
        curves.push(Curve {
            label,
            points,
            style: *style,
        });
    }
    let asked = &response.question;
    let values = asked.values.numbers().into_iter();
    let values: Vec<String> = values
        .map(|(name, value)| format!("{name} = {}", super::decimal(value)))
        .collect();
    let equation = asked.oscillator.equation();
    let values = values.iter().map(|value| format!("; {value}")).collect::<String>();
    let caption = format!("{} = 0{values}; harmonics 0 to {}.", equation.left, response.harmonics);
    let panel = Panel {
        title: "Steady states",
        x_label: asked.parameter.name(),
        y_label: match asked.periods {
            1 => "amplitude of the first harmonic",
            _ => "half of peak to peak",
        },
        curves,
        ..Panel::default()
    };
    figure(&[panel], &caption)
}
