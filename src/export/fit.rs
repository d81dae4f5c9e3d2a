//! A measurement beside its law: as a picture, as a table of comma-separated values, and as a problem file.

use std::fmt::Write as _;

use super::csv;
use super::figure::{Curve, CurveStyle, FigureError, Points, curve, figure, panel};
use crate::decimal::significant;
use crate::fit::answer::{Answer, LawFit};
use crate::fit::backbone::BackbonePoint;
use crate::fit::fitted_record::FittedRecord;
use crate::fit::impacts::MeasuredRestitution;
use crate::fit::response::{FrequencyResponse, ResponseFit};
use crate::fit::tables::{TableAnswer, TableRow};
use crate::report::FitReport;

/// A record with the law over it, what is left over, frequency and damping against amplitude; of a table
/// the frequencies, of impacts the restitution.
///
/// # Errors
/// [`FigureError`], as of [`figure`].
pub fn picture(report: &FitReport) -> Result<String, FigureError> {
    let laws = report.laws();
    let name = laws.first().map_or(String::new(), |law| law.name.clone());
    match report {
        FitReport::Decay { answer, until, .. } => of_decay(answer, &name, *until),
        FitReport::Backbone { rows, answer } => of_backbone(rows, answer, &name),
        FitReport::Response { response, fit } => of_response(response, fit),
        FitReport::Impacts(answer) => {
            let measured: Points =
                answer.measured.iter().map(|own| (own.speed, own.value)).collect();
            let best = answer.laws.first();
            let law = |own: &MeasuredRestitution| Some((own.speed, best?.restitution(own.speed)?));
            let law: Points = answer.measured.iter().filter_map(law).collect();
            let mut curves = vec![curve("measured", &measured, CurveStyle::MARKED_POINTS)];
            if law.len() > 1 {
                curves.push(curve("law", &law, CurveStyle::SECOND_FORMULA));
            }
            let labels = ["speed of approach", "coefficient of restitution"];
            figure(&[panel("Restitution", labels, curves, vec![])], &format!("{name}."))
        }
    }
}

/// Frequencies and dampings of a table with those of the law.
fn of_backbone(rows: &[TableRow], answer: &TableAnswer, name: &str) -> Result<String, FigureError> {
    let mut rows: Vec<&TableRow> = rows.iter().collect();
    rows.sort_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    let measured: [Points; 2] = [
        rows.iter().map(|row| (row.amplitude, row.frequency)).collect(),
        rows.iter().filter_map(|row| Some((row.amplitude, row.damping?))).collect(),
    ];
    let best = answer.laws.first().or(answer.springs.first());
    let estimates = best.map(|fit| fit.estimates.iter().map(|own| own.value));
    let values: Vec<f64> = estimates.into_iter().flatten().collect();
    let law: [Points; 2] = [0, 1].map(|which| {
        let at = |row: &&TableRow| {
            let both = best?.law.frequency_and_damping(&values, row.amplitude)?;
            Some((row.amplitude, both[which]))
        };
        rows.iter().filter_map(at).collect()
    });
    let titles = [("Frequency", "angular frequency"), ("Damping", "damping ratio")];
    let mut panels = vec![];
    for (which, (title, label)) in titles.into_iter().enumerate() {
        if measured[which].is_empty() {
            continue;
        }
        let mut curves = vec![curve("measured", &measured[which], CurveStyle::MARKED_POINTS)];
        if law[which].len() > 1 {
            curves.push(curve("law", &law[which], CurveStyle::SECOND_FORMULA));
        }
        panels.push(panel(title, ["amplitude", label], curves, vec![]));
    }
    figure(&panels, &format!("{name}."))
}

/// Amplitudes, and phases, of a frequency response with those of the law.
fn of_response(response: &FrequencyResponse, fit: &ResponseFit) -> Result<String, FigureError> {
    let rows = || response.rows.iter().zip(&fit.fitted);
    let amplitudes: [Points; 2] = [
        rows().map(|(row, _)| (row.frequency, row.amplitude)).collect(),
        rows().map(|(row, [amplitude, _])| (row.frequency, *amplitude)).collect(),
    ];
    let phases: [Points; 2] = [
        rows().filter_map(|(row, _)| Some((row.frequency, row.phase?))).collect(),
        rows()
            .filter(|(row, _)| row.phase.is_some())
            .map(|(row, [_, phase])| (row.frequency, *phase))
            .collect(),
    ];
    let titles = [("Amplitude", "amplitude"), ("Phase", "phase")];
    let mut panels = vec![];
    let laws = [&amplitudes, &phases].map(|[_, law]| sweeps(law));
    let quantities = [&amplitudes, &phases].into_iter().zip(&laws);
    for ((title, label), ([measured, _], law)) in titles.into_iter().zip(quantities) {
        if measured.is_empty() {
            continue;
        }
        let mut curves = vec![curve("measured", measured, CurveStyle::MARKED_POINTS)];
        curves.extend(law.iter().map(|points| curve("law", points, CurveStyle::SECOND_FORMULA)));
        panels.push(panel(title, ["angular frequency of the drive", label], curves, vec![]));
    }
    figure(&panels, &format!("{}.", fit.law.equation))
}

/// Points in pieces of growing or of falling frequency, as a table that was swept up and down has them; a
/// step much longer than the one before begins another sweep.
fn sweeps(points: &[(f64, f64)]) -> Vec<Points> {
    const LONGER: f64 = 3.0;
    let mut pieces: Vec<Points> = vec![];
    for point in points {
        let goes_on = pieces.last().is_some_and(|piece| match piece.as_slice() {
            [.., before, last] => {
                let [step, next] = [last.0 - before.0, point.0 - last.0];
                step * next > 0.0 && next.abs() <= LONGER * step.abs()
            }
            _ => true,
        });
        match pieces.last_mut().filter(|_| goes_on) {
            Some(piece) => piece.push(*point),
            None => pieces.push(vec![*point]),
        }
    }
    pieces
}

/// The times at which the law is drawn over a record.
const DRAWN: usize = 2000;

fn of_decay(answer: &Answer, name: &str, until: Option<f64>) -> Result<String, FigureError> {
    let best = answer.best().ok_or_else(|| FigureError::Empty("the record".to_owned()))?;
    let records = &answer.records;
    let (mut measured, mut fitted, mut left) = (vec![], vec![], vec![]);
    let mut bands: Vec<Points> = vec![];
    for (place, record) in records.iter().enumerate() {
        let samples = &record.samples;
        let (Some(first), Some(last)) = (samples.times.first(), samples.times.last()) else {
            continue;
        };
        let end = until.map_or(*last, |until| until.max(*last));
        let times: Vec<f64> =
            (0..=DRAWN).map(|i| first + (end - first) * i as f64 / DRAWN as f64).collect();
        let law = answer.predict(best, place, &times).unwrap_or_default();
        let both = || times.iter().zip(&law);
        fitted.push(both().map(|(time, [value, _])| (*time, *value)).collect::<Points>());
        for sigmas in [-3.0, 3.0] {
            let beyond = both().filter(|(time, _)| **time > *last);
            bands.push(
                beyond.map(|(time, [value, error])| (*time, value + sigmas * error)).collect(),
            );
        }
        let residuals = answer.residuals(best, place).iter().copied();
        left.extend(samples.times.iter().copied().zip(residuals));
        measured.extend(samples.times.iter().copied().zip(samples.values.iter().copied()));
    }
    let mut curves = vec![curve("measured", &measured, CurveStyle::POINTS)];
    let drawn = fitted.iter().filter(|points| points.len() > 1);
    curves.extend(drawn.map(|points| curve("law", points, CurveStyle::SECOND_FORMULA)));
    let drawn = bands.iter().filter(|points| points.len() > 1);
    curves.extend(drawn.map(|points| curve("three standard errors", points, CurveStyle::BACKBONE)));
    let record = panel("Record", ["time", "displacement"], curves, vec![]);
    let residuals = vec![curve("residuals", &left, CurveStyle::DOTS)];
    let residuals = panel("Residuals", ["time", "measured less law"], residuals, vec![]);
    let mut points: Vec<&BackbonePoint> = records.iter().flat_map(|own| &own.backbone).collect();
    points.sort_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    let against = |of: &dyn Fn(&BackbonePoint) -> f64| -> Points {
        points.iter().map(|point| (point.amplitude, of(point))).collect()
    };
    let measured = [against(&|point| point.frequency), against(&|point| point.damping)];
    let bands = [-3.0, 3.0].map(|sigmas| {
        [
            against(&|point| point.frequency + sigmas * point.frequency_error),
            against(&|point| point.damping + sigmas * point.damping_error),
        ]
    });
    let values = best.values();
    let law: [Points; 2] = [0, 1].map(|which| {
        let at = |point: &&BackbonePoint| {
            let both = best.law.frequency_and_damping(&values, point.amplitude)?;
            Some((point.amplitude, both[which]))
        };
        points.iter().filter_map(at).collect()
    });
    let mut panels = vec![record, residuals];
    let titles = [("Frequency", "angular frequency"), ("Damping", "damping ratio")];
    for (which, (title, label)) in titles.into_iter().enumerate() {
        let mut curves: Vec<Curve> = bands
            .iter()
            .map(|band| curve("three standard errors", &band[which], CurveStyle::BACKBONE))
            .collect();
        curves.push(curve("without a law", &measured[which], CurveStyle::MARKED_POINTS));
        if law[which].len() > 1 {
            curves.push(curve("law", &law[which], CurveStyle::SECOND_FORMULA));
        }
        if points.len() > 1 && !best.law.is_driven() {
            panels.push(panel(title, ["amplitude", label], curves, vec![]));
        }
    }
    figure(&panels, &format!("{name}: {}.", best.law.equation))
}

/// The samples with the law, its standard error and what is left over; rows of a table or impacts with
/// their numbers.
pub fn csv(report: &FitReport) -> String {
    match report {
        FitReport::Decay { answer, until, .. } => {
            let names = ["record", "time", "measured", "law", "standard_error", "residual"];
            let mut text = csv::line(names);
            let Some(best) = answer.best() else { return text };
            for (record, found) in answer.records.iter().enumerate() {
                let samples = &found.samples;
                let times: Vec<f64> =
                    samples.times.iter().copied().chain(beyond(found, *until)).collect();
                let law = answer.predict(best, record, &times).unwrap_or_default();
                let left = answer.residuals(best, record);
                for (place, time) in times.iter().enumerate() {
                    let own = law.get(place);
                    text += &csv::line([
                        (record + 1).to_string(),
                        time.to_string(),
                        csv::cell(samples.values.get(place)),
                        csv::cell(own.map(|[value, _]| value)),
                        csv::cell(own.map(|[_, error]| error)),
                        csv::cell(left.get(place)),
                    ]);
                }
            }
            text
        }
        FitReport::Backbone { rows, .. } => {
            let mut text = csv::line(["amplitude", "frequency", "damping"]);
            for row in *rows {
                text += &csv::line([
                    row.amplitude.to_string(),
                    row.frequency.to_string(),
                    csv::cell(row.damping),
                ]);
            }
            text
        }
        FitReport::Response { response, fit } => {
            let names = ["frequency", "amplitude", "phase", "law_amplitude", "law_phase"];
            let mut text = csv::line(names);
            for (row, [amplitude, phase]) in response.rows.iter().zip(&fit.fitted) {
                text += &csv::line([
                    row.frequency.to_string(),
                    row.amplitude.to_string(),
                    csv::cell(row.phase),
                    amplitude.to_string(),
                    phase.to_string(),
                ]);
            }
            text
        }
        FitReport::Impacts(answer) => {
            let mut text = csv::line(["speed", "restitution", "standard_error"]);
            for own in &answer.measured {
                text += &csv::line([own.speed, own.value, own.error]);
            }
            text
        }
    }
}

/// Times beyond a record, as far apart as its samples, until this one.
fn beyond(record: &FittedRecord, until: Option<f64>) -> impl Iterator<Item = f64> {
    /// The largest number of times beyond a record.
    const MOST: usize = 1_000_000;
    let last = record.samples.times.last().copied().unwrap_or(0.0);
    let step = record.quality.step;
    let times = (1..=MOST).map(move |place| last + step * place as f64);
    times.take_while(move |time| until.is_some_and(|until| *time <= until + 1e-9 * step))
}

/// The best law of a record as a problem file, which `simulate` and `derive` read; `None` of tables and
/// impacts without an equation of motion.
pub fn problem(report: &FitReport) -> Option<String> {
    let law = report.laws().into_iter().next().filter(|law| !law.equation.is_empty())?;
    let mut text = format!("# {}.\n", law.name);
    if let Some(fit) = report.best() {
        let times = report.times().unwrap_or_default();
        let until = significant(times[1] - times[0], 5);
        let _ = write!(
            text,
            "# The record begins at the time {} with what --from says.\n#\n#   lindstedt simulate FILE --from {} --until {until}\n",
            times[0],
            start(fit)
        );
    }
    let _ = writeln!(text, "equation = \"{}\"\n\n[values]", law.equation);
    let of_motion = report.best().map_or(law.estimates.len(), |fit| fit.law.parameters.len());
    for own in &law.estimates[..of_motion.min(law.estimates.len())] {
        let error = match own.error.is_finite() {
            true => format!("+- {}", significant(own.error, 2)),
            false => "left open by the record".to_owned(),
        };
        let _ = writeln!(text, "{} = {} # {error}", own.name, own.value);
    }
    Some(text)
}

/// The start of a motion as `--from` takes it.
fn start(fit: &LawFit) -> String {
    let value = |name: &str| fit.estimate(name).map_or(0.0, |own| own.value);
    format!("x={},v={}", value("x0"), value("v0"))
}
