//! A study of materials as comma-separated values, a row for each material.

use crate::export::csv::{cell, head, line, quoted};
use crate::impact::MaterialStudy;

/// Names and units of the columns; the first line is a comment with the units.
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

/// The table. Cells without a value are empty; the energies after the impacts are in one field,
/// separated by semicolons.
///
/// ```
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let table = lindstedt::export::materials::csv(&study_materials(MaterialQuestion::default())?);
/// assert_eq!(table.lines().count(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn materials(study: &MaterialStudy) -> String {
    let mut text = head(&COLUMNS);
    for row in &study.rows {
        let (damping, course) = (&row.dissipation, &row.course);
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
        let mut cells = vec![quoted(&row.material.name)];
        cells.extend(
            [row.material.modulus.value(), row.gamma, damping.mu, damping.mu_over_gamma]
                .map(|value| value.to_string()),
        );
        cells.push(cell(damping.lambda));
        cells.extend((0..6).map(|place| cell(first.map(|first| first[place]))));
        let rest = course.rest_time.ok();
        let energies: Vec<String> = course.energies.iter().map(f64::to_string).collect();
        cells.extend([
            course.impacts.len().to_string(),
            cell(rest),
            cell(rest.map(|rest| study.seconds(rest))),
            cell(row.lossless.ok()),
            energies.join(";"),
        ]);
        text += &line(cells);
    }
    text
}
