//! Branches of steady states as comma-separated values and as a picture; text by
//! [`text::document`](super::text::document).

use std::fmt::Write as _;

use super::csv::{cell, quoted};
use super::figure::{CurveStyle, FigureError, Panel, Points, curve, figure, panel};
use crate::report::{are_modes, event_in_words, has_energy, listed_quantity, wall_in_words};
use crate::response::bifurcation::BifurcationKind;
use crate::response::{Equilibrium, ResponseDiagram, SteadyMotion};

/// Every point of every branch, the bifurcations, the backbone and the simulations, a row each; the
/// first line is a comment that explains the columns. Of coupled equations the amplitude of each
/// coordinate stands at the end of a row; equilibria and curves of bifurcations have rows of their own.
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
    let coupled = Coupled::of(response);
    let mut text = format!(
        "# kind: branch, slow (by slow equations), simulated, backbone or the kind of a bifurcation; amplitude: of the first harmonic; peak: half of peak to peak{meaning}{}\n\
         kind,branch,{},amplitude,{own},peak,stable,multiplier,error{}\n",
        coupled.meaning, response.question.parameter, coupled.columns
    );
    for (index, branch) in response.branches.iter().enumerate() {
        for point in &branch.points {
            let stable = cell(point.stable.map(u8::from));
            let _ = writeln!(
                text,
                "branch,{},{},{},{},{},{stable},{},{}{}",
                index + 1,
                point.parameter,
                point.amplitude,
                of_own(point.frequency, point.phase.to_string()),
                point.peak,
                cell(point.multipliers.map(|multipliers| multipliers[0].norm())),
                cell(point.error),
                coupled.amplitudes(point)
            );
        }
    }
    for found in &response.bifurcations {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},,,{}",
            found.kind.name(),
            found.branch + 1,
            found.parameter,
            found.amplitude,
            of_own(found.frequency, String::new()),
            found.peak,
            coupled.empty
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
            "simulated,,{},{},{},{},,,{}{}",
            simulated.parameter,
            simulated.amplitude,
            of_own(simulated.frequency, String::new()),
            simulated.peak,
            simulated.error,
            coupled.empty
        );
    }
    for point in response.backbone.iter().flatten() {
        let _ = writeln!(text, "backbone,,{},{},,,,,", point.parameter, point.amplitude);
    }
    coupled.write_rows_of_their_own(response, &mut text);
    text
}

/// The columns and the rows that coupled equations have beside those of one coordinate.
struct Coupled {
    /// The words of the comment on them.
    meaning: String,
    /// The names of the columns, each after a comma.
    columns: String,
    /// The empty cells of a row without amplitudes.
    empty: String,
    /// Whether each coordinate has a column; that of a single one stands in those of all.
    are_several: bool,
    /// Whether a second parameter has a column.
    has_second: bool,
}

impl Coupled {
    fn of(response: &ResponseDiagram) -> Self {
        let asked = &response.question;
        let coordinates = match asked.equations.oscillator() {
            Some(_) => vec![],
            None => response.coordinates(),
        };
        let mut meaning = match coordinates.is_empty() {
            true => String::new(),
            false => format!(
                "; amplitude and peak: of {}; equilibrium: its value below amplitude, its growth below multiplier",
                listed_quantity(response)
            ),
        };
        let mut columns: String = coordinates
            .iter()
            .map(|name| format!(",{}", quoted(&format!("amplitude_{name}"))))
            .collect();
        let mut empty = ",".repeat(coordinates.len());
        if has_energy(response) {
            meaning.push_str("; energy: over that of rest");
            columns.push_str(",energy");
            empty.push(',');
        }
        if let Some((along, _)) = asked.along {
            let _ = write!(meaning, "; curve: bifurcations in {} and {along}", asked.parameter);
            let _ = write!(columns, ",{along}");
            empty.push(',');
        }
        let are_several = !coordinates.is_empty();
        Self { meaning, columns, empty, are_several, has_second: asked.along.is_some() }
    }

    /// The amplitudes of a motion, each after a comma.
    fn amplitudes(&self, point: &SteadyMotion) -> String {
        let amplitudes = point.coordinates.iter().filter(|_| self.are_several);
        let mut cells: String = amplitudes.map(|motion| format!(",{}", motion.amplitude)).collect();
        if let Some(energy) = point.energy {
            let _ = write!(cells, ",{energy}");
        }
        if self.has_second {
            cells.push(',');
        }
        cells
    }

    /// Equilibria, their changes, and curves of bifurcations.
    fn write_rows_of_their_own(&self, response: &ResponseDiagram, text: &mut String) {
        for (index, branch) in response.equilibria.iter().enumerate() {
            for point in &branch.points {
                let _ = writeln!(
                    text,
                    "equilibrium,{},{},{},,,{},{},{}",
                    index + 1,
                    point.parameter,
                    point.value,
                    cell(point.stable.map(u8::from)),
                    cell(point.growth),
                    self.empty
                );
            }
            for change in &branch.changes {
                let _ = writeln!(
                    text,
                    "equilibrium-{},{},{},{},,,,,{}",
                    change.kind.name(),
                    index + 1,
                    change.parameter,
                    change.value,
                    self.empty
                );
            }
        }
        // The second parameter is the last of the columns.
        let before = self.empty.strip_suffix(',').unwrap_or_default();
        for (index, curve) in response.curves.iter().enumerate() {
            for point in &curve.points {
                let _ = writeln!(
                    text,
                    "curve-{},{},{},,,{},,,{before},{}",
                    curve.kind.name(),
                    index + 1,
                    point.parameter,
                    point.peak,
                    point.along
                );
            }
        }
    }
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
    /// The words at the axis; those of coupled equations name the quantity.
    fn label(self, response: &ResponseDiagram) -> String {
        let words = match self {
            Self::Amplitude => "amplitude of the first harmonic",
            Self::Peak => "half of peak to peak",
            Self::Frequency => "frequency",
        };
        match (self, response.question.equations.oscillator()) {
            (Self::Frequency, _) | (_, Some(_)) => words.to_owned(),
            (_, None) => format!("{words} of {}", listed_quantity(response)),
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
    let place = |point: &SteadyMotion| {
        (point.parameter, height.value(point.amplitude, point.peak, point.frequency))
    };
    pieces_by(points, place, |point| point.stable, stable)
}

/// The pieces of a curve, given by the place of each point, that are stable, or that are not.
fn pieces_by<T>(
    points: &[T],
    place: impl Fn(&T) -> (f64, f64),
    stability: impl Fn(&T) -> Option<bool>,
    stable: bool,
) -> Vec<Points> {
    let mut pieces: Vec<Points> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let [from, to] = pair else { continue };
        // A motion that could not be followed over its period has no size.
        let is_finite = [from, to].map(&place).iter().all(|(x, y)| x.is_finite() && y.is_finite());
        if (stability(to) == Some(true)) != stable || !is_finite {
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

/// The equilibria with their labels: their values, stable ones solid and unstable ones dashed.
fn equilibria(response: &ResponseDiagram) -> Vec<(&'static str, Points, CurveStyle)> {
    let place = |point: &Equilibrium| (point.parameter, point.value);
    let of_stability = |stable: bool| {
        let branches = response.equilibria.iter();
        branches
            .flat_map(|branch| pieces_by(&branch.points, place, |point| point.stable, stable))
            .collect::<Vec<_>>()
    };
    let mut drawn = Vec::new();
    for (stable, label, style) in [
        (false, "unstable equilibrium", CurveStyle::UNSTABLE_EQUILIBRIUM),
        (true, "stable equilibrium", CurveStyle::EQUILIBRIUM),
    ] {
        drawn.extend(of_stability(stable).into_iter().map(|points| (label, points, style)));
    }
    for (kind, label, style) in MARKS {
        let changes = response.equilibria.iter().flat_map(|branch| &branch.changes);
        let places = changes.filter(|change| change.kind == kind);
        let places: Points = places.map(|change| (change.parameter, change.value)).collect();
        if !places.is_empty() {
            drawn.push((label, places, style));
        }
    }
    drawn
}

/// The frequencies of nonlinear normal modes over their energy, stable ones solid and unstable ones
/// dashed.
fn over_energy(response: &ResponseDiagram) -> Vec<(&'static str, Points, CurveStyle)> {
    let place = |point: &SteadyMotion| (point.energy.unwrap_or(f64::NAN), point.parameter);
    let mut drawn = Vec::new();
    if !has_energy(response) {
        return drawn;
    }
    for (stable, label, style) in
        [(false, "unstable", CurveStyle::UNSTABLE), (true, "stable", CurveStyle::DIFFERENCE)]
    {
        for branch in &response.branches {
            let lines = pieces_by(&branch.points, place, |point| point.stable, stable);
            drawn.extend(lines.into_iter().map(|points| (label, points, style)));
        }
    }
    drawn
}

/// The numbers of stable motions that have a mark of their own, with its label and its style; more are
/// marked as the last.
const COUNTS: [(&str, CurveStyle); 4] = [
    ("no stable motion", CurveStyle::NO_MOTION),
    ("1 stable motion", CurveStyle::ONE_MOTION),
    ("2 stable motions", CurveStyle::TWO_MOTIONS),
    ("3 stable motions or more", CurveStyle::MANY_MOTIONS),
];

/// The curves of bifurcations in two parameters over a pattern of the numbers of stable motions.
fn two_parameters(response: &ResponseDiagram) -> Vec<(&'static str, Points, CurveStyle)> {
    let mut drawn = Vec::new();
    for (number, (label, style)) in COUNTS.into_iter().enumerate() {
        let counts = response.stable_motions.iter();
        let places: Points = counts
            .flat_map(|grid| {
                grid.along.iter().zip(&grid.counts).flat_map(move |(along, row)| {
                    let cells = grid.parameters.iter().zip(row);
                    cells
                        .filter(move |(_, count)| (**count).min(COUNTS.len() - 1) == number)
                        .map(move |(parameter, _)| (*parameter, *along))
                })
            })
            .collect();
        if !places.is_empty() {
            drawn.push((label, places, style));
        }
    }
    let styles = CurveStyle::SERIES.into_iter().cycle();
    for ((kind, label, _), style) in MARKS.into_iter().zip(styles) {
        let of_kind = response.curves.iter().filter(|curve| curve.kind == kind);
        drawn.extend(
            of_kind
                .map(|curve| {
                    curve.points.iter().map(|point| (point.parameter, point.along)).collect()
                })
                .filter(|points: &Points| points.len() > 1)
                .map(|points| (label, points, style)),
        );
    }
    drawn
}

/// The marks of bifurcations.
const MARKS: [(BifurcationKind, &str, CurveStyle); 7] = [
    (BifurcationKind::Fold, "fold", CurveStyle::MARKED_POINTS),
    (BifurcationKind::BranchPoint, "branch point", CurveStyle::SECOND_MARKED_POINTS),
    (BifurcationKind::PeriodDoubling, "period doubling", CurveStyle::THIRD_MARKED_POINTS),
    (BifurcationKind::NeimarkSacker, "Neimark-Sacker", CurveStyle::FOURTH_MARKED_POINTS),
    (BifurcationKind::Hopf, "Hopf", CurveStyle::SECOND_MARKED_POINTS),
    (BifurcationKind::Centre, "centre", CurveStyle::THIRD_MARKED_POINTS),
    (BifurcationKind::Grazing, "grazing", CurveStyle::FOURTH_MARKED_POINTS),
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
    let states = states
        .map(|state| {
            let peak = state.peak.unwrap_or(state.amplitude);
            (state.parameter, height.value(state.amplitude, peak, f64::NAN))
        })
        .collect();
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
        // The parameter is the frequency.
        _ if are_modes(response) => &[Ordinate::Amplitude],
        (true, _) => &[Ordinate::Amplitude, Ordinate::Frequency],
        (false, 1) => &[Ordinate::Amplitude],
        _ => &[Ordinate::Peak],
    };
    let title = response.slow.as_ref().map(|slow| slow.equations.title());
    let title = title.unwrap_or_default();
    // Each panel has a title, the words at its axes and its curves.
    let mut drawn: Vec<Drawing> = heights
        .iter()
        .map(|height| Drawing {
            title: "Steady states",
            labels: [asked.parameter.name().to_owned(), height.label(response)],
            curves: curves(response, *height, &title),
        })
        .collect();
    drawn.push(Drawing {
        title: "Frequency and energy",
        labels: ["energy over that of rest".to_owned(), asked.parameter.name().to_owned()],
        curves: over_energy(response),
    });
    drawn.push(Drawing {
        title: "Equilibria",
        labels: [asked.parameter.name().to_owned(), listed_quantity(response)],
        curves: equilibria(response),
    });
    let along = asked.along.map(|(name, _)| name.to_string());
    drawn.push(Drawing {
        title: "Bifurcations in two parameters",
        labels: [asked.parameter.name().to_owned(), along.unwrap_or_default()],
        curves: two_parameters(response),
    });
    let panels: Vec<Panel> = drawn
        .iter()
        .filter(|drawing| !drawing.curves.is_empty())
        .map(|drawing| {
            let curves =
                drawing.curves.iter().map(|(label, points, style)| curve(label, points, *style));
            let labels = drawing.labels.each_ref().map(String::as_str);
            panel(drawing.title, labels, curves.collect(), vec![])
        })
        .collect();
    let values = asked.values.numbers().into_iter();
    let values: Vec<String> =
        values.map(|(name, value)| format!("{name} = {}", super::decimal(value))).collect();
    let equations = match asked.equations.oscillator() {
        Some(oscillator) => format!("{} = 0", oscillator.equation().left),
        None => asked.equations.to_string(),
    };
    let several = asked.walls.len() > 1;
    let walls = asked.walls.iter().enumerate();
    let walls = walls.map(|(index, wall)| wall_in_words(index, wall, several));
    let several = asked.events.len() > 1;
    let events = asked.events.iter().enumerate();
    let events = events.map(|(index, event)| event_in_words(index, event, several));
    let parts: String = walls.chain(events).chain(values).map(|part| format!("; {part}")).collect();
    let caption = format!("{equations}{parts}; harmonics 0 to {}.", response.harmonics);
    figure(&panels, &caption)
}

/// The content of a panel.
struct Drawing<'a> {
    title: &'static str,
    labels: [String; 2],
    curves: Vec<(&'a str, Points, CurveStyle)>,
}
