//! A row for each material, to go on with.

use std::fmt::Write as _;

use crate::impact::MaterialStudy;

/// Names and units of the columns: a first line of comment has the units.
const COLUMNS: [(&str, &str); 17] = [
    ("material", "-"),
    ("modulus", "Pa"),
    ("gamma", "1"),
    ("mu", "1"),
    ("mu_over_gamma", "1"),
    ("lambda", "s/m"),
    ("speed", "m/s"),
    ("duration", "s"),
    ("penetration", "m"),
    ("peak_force", "N"),
    ("peak_pressure", "Pa"),
    ("restitution", "1"),
    ("impacts", "1"),
    ("rest_time", "1/omega"),
    ("rest_time_in_seconds", "s"),
    ("lossless_rest_time", "1/omega"),
    ("energies", "m*g*L"),
];

/// The table: what has no value is empty, the energies after the impacts stand in one field,
/// between semicolons.
///
/// ```
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let table = lindstedt::export::materials::csv(&study_materials(MaterialQuestion::default())?);
/// assert_eq!(table.lines().count(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn materials(study: &MaterialStudy) -> String {
    let units = COLUMNS.map(|(_, unit)| unit).join(",");
    let names = COLUMNS.map(|(name, _)| name).join(",");
    let mut text = format!("# {units}\n{names}\n");
    for row in &study.rows {
        let optional = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let first = row.first.map(|first| {
            [
                first.speed,
                first.duration,
                first.penetration,
                first.peak_force,
                first.peak_pressure,
                first.restitution,
            ]
        });
        let first: Vec<String> =
            (0..6).map(|place| optional(first.map(|first| first[place]))).collect();
        let rest = row.course.rest_time.ok();
        let energies: Vec<String> = row.course.energies.iter().map(f64::to_string).collect();
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{},{}",
            quoted(&row.material.name),
            row.material.modulus.value(),
            row.gamma,
            row.dissipation.mu,
            row.dissipation.mu_over_gamma,
            optional(row.dissipation.lambda),
            first.join(","),
            row.course.impacts.len(),
            optional(rest),
            optional(rest.map(|rest| study.seconds(rest))),
            optional(row.lossless.ok()),
            energies.join(";")
        );
    }
    text
}

/// A field as it may stand between commas (RFC 4180).
pub(in crate::export) fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}
