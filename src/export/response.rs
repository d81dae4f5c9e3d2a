//! Branches of steady states as comma-separated values and as a picture; text by
//! [`text::document`](super::text::document).

use std::fmt::Write as _;

use super::csv::cell;
use super::figure::{CurveStyle, FigureError, Panel, Points, curve, figure, panel};
use crate::response::ResponseDiagram;
use crate::response::{SteadyMotion, bifurcation::BifurcationKind};

/// Every point of every branch, the bifurcations, the backbone and the simulations, a row each; the
/// first line is a comment that explains the columns.
///
/// ```
/// use lindstedt::response::{ResponseRequest, respond};
///
/// let question = ResponseRequest::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// let table = lindstedt::export::response::csv(&respond(&question)?);
/// assert!(table.lines().nth(2).is_some_and(|row| row.starts_with("branch,1,0.5,")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(response: &ResponseDiagram) -> String {
    // A self-excited motion has an arbitrary phase and its own frequency.
    let (own, meaning) = match response.self_excited {
        true => ("frequency", "; frequency: theta/t"),
        false => ("phase", ""),
    };
    let of_own = |frequency: f64, otherwise: String| match response.self_excited {
        true => frequency.to_string(),
        false => otherwise,
    };
    let mut text = format!(
        "# kind: branch, slow (by slow equations), simulated, backbone or the kind of a bifurcation; amplitude: of the first harmonic; peak: half of peak to peak{meaning}\n\
         kind,branch,{},amplitude,{own},peak,stable,multiplier,error\n",
        response.question.parameter
    );
    for (index, branch) in response.branches.iter().enumerate() {
        for point in &branch.points {
            let stable = cell(point.stable.map(u8::from));
            let _ = writeln!(
                text,
                "branch,{},{},{},{},{},{stable},{},{}",
                index + 1,
                point.parameter,
                point.amplitude,
                of_own(point.frequency, point.phase.to_string()),
                point.peak,
                cell(point.multipliers.map(|multipliers| multipliers[0].norm())),
                cell(point.error)
            );
        }
    }
    for found in &response.bifurcations {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},,,",
            found.kind.name(),
            found.branch + 1,
            found.parameter,
            found.amplitude,
            of_own(found.frequency, String::new()),
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
            "simulated,,{},{},{},{},,,{}",
            simulated.parameter,
            simulated.amplitude,
            of_own(simulated.frequency, String::new()),
            simulated.peak,
            simulated.error
        );
    }
    for point in response.backbone.iter().flatten() {
        let _ = writeln!(text, "backbone,,{},{},,,,,", point.parameter, point.amplitude);
    }
    text
}

/// The ordinates of the panels: the peak for motions of several drive periods, and for self-excited
/// ones the frequency as well.
#[derive(Clone, Copy)]
enum Ordinate {
    Amplitude,
    Peak,
    Frequency,
}

impl Ordinate {
    fn label(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude of the first harmonic",
            Self::Peak => "half of peak to peak",
            Self::Frequency => "frequency",
        }
    }

    fn value(self, amplitude: f64, peak: f64, frequency: f64) -> f64 {
        match self {
            Self::Amplitude => amplitude,
            Self::Peak => peak,
            Self::Frequency => frequency,
        }
    }
}

/// The pieces of a branch in the parameter and the height that are stable, or that are not;
/// neighbouring pieces share a point.
fn pieces(height: Ordinate, points: &[SteadyMotion], stable: bool) -> Vec<Points> {
    let mut pieces: Vec<Points> = Vec::new();
    let mut open = false;
    let place = |point: &SteadyMotion| {
        (point.parameter, height.value(point.amplitude, point.peak, point.frequency))
    };
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

/// The marks of bifurcations.
const MARKS: [(BifurcationKind, &str, CurveStyle); 6] = [
    (BifurcationKind::Fold, "fold", CurveStyle::MARKED_POINTS),
    (BifurcationKind::BranchPoint, "branch point", CurveStyle::SECOND_MARKED_POINTS),
    (BifurcationKind::PeriodDoubling, "period doubling", CurveStyle::THIRD_MARKED_POINTS),
    (BifurcationKind::NeimarkSacker, "Neimark-Sacker", CurveStyle::FOURTH_MARKED_POINTS),
    (BifurcationKind::Hopf, "Hopf", CurveStyle::SECOND_MARKED_POINTS),
    (BifurcationKind::Centre, "centre", CurveStyle::THIRD_MARKED_POINTS),
];

/// The curves of a panel with their labels.
fn curves<'a>(
    response: &ResponseDiagram,
    height: Ordinate,
    slow_title: &'a str,
) -> Vec<(&'a str, Points, CurveStyle)> {
    let mut drawn: Vec<(&str, Points, CurveStyle)> = Vec::new();
    let mut draw = |label: &'a str, lines: Vec<Points>, style: CurveStyle| {
        drawn.extend(lines.into_iter().map(|points| (label, points, style)));
    };
    let of_stability = |stable: bool| {
        let branches = response.branches.iter();
        branches.flat_map(|branch| pieces(height, &branch.points, stable)).collect::<Vec<_>>()
    };
    if response.question.periods == 1 {
        let curves = response.backbone.iter();
        let lines = curves
            .map(|curve| curve.iter().map(|point| (point.parameter, point.amplitude)).collect());
        draw("free, without damping", lines.collect(), CurveStyle::BACKBONE);
    }
    draw("unstable", of_stability(false), CurveStyle::UNSTABLE);
    draw("stable", of_stability(true), CurveStyle::DIFFERENCE);
    let states = response.slow.iter().flat_map(|slow| &slow.states);
    let states = states.map(|state| (state.parameter, state.amplitude)).collect();
    draw(slow_title, vec![states], CurveStyle::SLOW);
    let simulated = response.simulated.iter().map(|found| {
        let height = height.value(found.amplitude, found.peak, found.frequency);
        (found.parameter, height)
    });
    draw("simulated", vec![simulated.collect()], CurveStyle::SIMULATED);
    for (kind, label, style) in MARKS {
        let of_kind = response.bifurcations.iter().filter(|found| found.kind == kind);
        let places = of_kind.map(|found| {
            (found.parameter, height.value(found.amplitude, found.peak, found.frequency))
        });
        draw(label, vec![places.collect()], style);
    }
    drawn.retain(|(_, points, _)| !points.is_empty());
    drawn
}

/// The branches, stable ones solid and unstable ones dashed, the backbone, simulations as dots,
/// bifurcations marked.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::response::{ResponseRequest, respond};
///
/// let question = ResponseRequest::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// assert!(lindstedt::export::response::picture(&respond(&question)?)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture(response: &ResponseDiagram) -> Result<String, FigureError> {
    let asked = &response.question;
    let heights: &[Ordinate] = match (response.self_excited, asked.periods) {
        (true, _) => &[Ordinate::Amplitude, Ordinate::Frequency],
        (false, 1) => &[Ordinate::Amplitude],
        _ => &[Ordinate::Peak],
    };
    let title = response.slow.as_ref().map(|slow| slow.solution.title());
    let title = title.unwrap_or_default();
    let drawn: Vec<Vec<(&str, Points, CurveStyle)>> =
        heights.iter().map(|height| curves(response, *height, &title)).collect();
    let panels: Vec<Panel> = heights
        .iter()
        .zip(&drawn)
        .map(|(height, drawn)| {
            let curves = drawn.iter().map(|(label, points, style)| curve(label, points, *style));
            let labels = [asked.parameter.name(), height.label()];
            panel("Steady states", labels, curves.collect(), vec![])
        })
        .collect();
    let values = asked.values.numbers().into_iter();
    let values: Vec<String> =
        values.map(|(name, value)| format!("{name} = {}", super::decimal(value))).collect();
    let equation = asked.oscillator.equation();
    let values = values.iter().map(|value| format!("; {value}")).collect::<String>();
    let caption = format!("{} = 0{values}; harmonics 0 to {}.", equation.left, response.harmonics);
    figure(&panels, &caption)
}
