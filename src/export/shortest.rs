//! Frequency laws by length as a picture and as a table of comma-separated values.

use std::fmt::Write as _;

use super::figure::{Curve, CurveStyle, FigureError, Panel, Scale, figure};
use crate::report::ShortestReport;
use crate::shortest::Front;

/// The front of length against error with the published formulas, and below it the error of the law that
/// is shown first along the range.
///
/// # Errors
/// [`FigureError`], as of [`figure`].
pub fn picture(report: &ShortestReport) -> Result<String, FigureError> {
    let front = report.front;
    let laws: Vec<(f64, f64)> =
        front.laws.iter().map(|law| (law.length as f64, 100.0 * law.largest_error())).collect();
    // The front as a stair: up to the next law the error is that of the one before.
    let mut stair: Vec<(f64, f64)> = vec![];
    for (length, error) in &laws {
        stair.extend(stair.last().map(|&(_, before)| (*length, before)));
        stair.push((*length, *error));
    }
    let published: Vec<(f64, f64)> = front
        .published
        .iter()
        .filter(|own| own.error.is_finite())
        .map(|own| (own.length as f64, 100.0 * own.error))
        .collect();
    let mut curves =
        vec![Curve { label: "laws found", points: &stair, style: CurveStyle::DIFFERENCE }];
    if !published.is_empty() {
        let style = CurveStyle::MARKED_POINTS;
        curves.push(Curve { label: "published formulas", points: &published, style });
    }
    let lengths = Panel {
        title: "Length against error",
        x_label: "length in symbols",
        y_label: "largest error (%)",
        y_scale: Scale::Logarithmic,
        curves,
        ..Panel::default()
    };
    let along = report.shown().map(|law| front.errors_along(law)).unwrap_or_default();
    let along: Vec<(f64, f64)> =
        along.iter().map(|(place, error)| (*place, 100.0 * error)).collect();
    let is_infinite = front.problem.to.is_none();
    let variable = front.problem.abscissa().to_string();
    let label = report.shown().map(|law| law.formula.to_string()).unwrap_or_default();
    let positive: Vec<(f64, f64)> =
        along.into_iter().filter(|(place, _)| !is_infinite || *place > 1e-3).collect();
    let errors = Panel {
        title: "Error along the range",
        x_label: &variable,
        y_label: "error of the law (%)",
        x_scale: if is_infinite { Scale::Logarithmic } else { Scale::Linear },
        curves: vec![Curve { label: &label, points: &positive, style: CurveStyle::THIRD_FORMULA }],
        ..Panel::default()
    };
    figure(&[lengths, errors], &format!("{}; {}.", report.equation, report.range()))
}

/// The laws and the published formulas, a row each.
pub fn csv(front: &Front) -> String {
    let mut text =
        "kind,length,measured,proved_from,proved_to,worst,quantity,formula,source\n".to_owned();
    let quantity = front.quantity.name();
    for law in &front.laws {
        let proved = match &law.proof {
            Ok((_, error)) => format!("{},{}", error.lower, error.upper),
            Err(_) => ",".to_owned(),
        };
        let _ = writeln!(
            text,
            "law,{},{},{proved},{},{quantity},\"{}\",",
            law.length, law.error, law.worst, law.formula
        );
    }
    for own in &front.published {
        let error = if own.error.is_finite() { own.error.to_string() } else { String::new() };
        let _ = writeln!(
            text,
            "published,{},{error},,,{},{},\"{}\",\"{}\"",
            own.length,
            own.worst,
            own.published.quantity.name(),
            own.published.text,
            own.published.source
        );
    }
    text
}
