//! The columns of the table of a sweep: name, unit and meaning of each.

use crate::impact::Parameter;
use crate::impact::sweep::Axis;

/// What one number, text or truth value of a row means.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Column {
    /// Its name: that of a parameter, whose value stands in `values`, or the key of a row; `t`, `x`
    /// and `velocity` stand in `final_state`.
    pub name: String,
    /// Its unit, as it is typed, 1 for a number without dimension; null for what is no number.
    pub unit: Option<String>,
    /// What it means, in words.
    pub meaning: String,
}

/// Name, unit and meaning of each result of a motion.
const RESULTS: [(&str, Option<&str>, &str); 10] = [
    (
        "impacts",
        Some("1"),
        "the number of contacts; empty or null for a run that was stopped before it began, as is all that follows",
    ),
    (
        "rest_time",
        Some("1/omega"),
        "when the envelope of the amplitude falls to a tenth of the first swing; empty or null where it does not",
    ),
    ("penetration", Some("rad"), "the greatest depth in a barrier; 0 without contact"),
    ("speed_in", Some("rad*omega"), "the greatest speed at a touch; 0 without contact"),
    ("energy_lost", Some("m*g*L"), "the energy lost in contacts"),
    ("t", Some("1/omega"), "the time at the end of the run"),
    ("x", Some("rad"), "the displacement there"),
    ("velocity", Some("rad*omega"), "the velocity there"),
    ("complete", None, "whether the run got where it was to get"),
    ("stopped", None, "why the run ended"),
];

/// The columns after the rest time if the baseline was requested.
const BASELINE: [(&str, Option<&str>, &str); 2] = [
    (
        "rest_no_barrier",
        Some("1/omega"),
        "the rest time of the same swing without a barrier; empty or null where it does not rest",
    ),
    (
        "rest_lossless",
        Some("1/omega"),
        "the rest time with a barrier that loses nothing; empty or null where it does not rest",
    ),
];

/// The columns: the parameters in the order of the axes, then the results of each motion, with or
/// without the rest times of the baseline.
///
/// ```
/// use lindstedt::export::simulation::columns;
///
/// let columns = columns(&["length=0.05:0.3:6".parse()?], false);
/// assert_eq!((columns[0].name.as_str(), columns[0].unit.as_deref()), ("length", Some("m")));
/// assert_eq!((columns[2].name.as_str(), columns[2].unit.as_deref()), ("rest_time", Some("1/omega")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn columns(axes: &[Axis], baseline: bool) -> Vec<Column> {
    let swept = axes.iter().map(|axis| {
        let parameter = axis.name().parse::<Parameter>().ok();
        let unit = parameter.map(Parameter::unit).filter(|unit| !unit.is_empty());
        (axis.name(), unit.or(Some("1")), parameter.map_or("a parameter", Parameter::meaning))
    });
    let (to_rest, others) = RESULTS.split_at(2);
    let beside: &[_] = if baseline { &BASELINE } else { &[] };
    let results = to_rest.iter().chain(beside).chain(others).copied();
    let column = |(name, unit, meaning): (&str, Option<&str>, &str)| Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        meaning: meaning.to_owned(),
    };
    swept.chain(results).map(column).collect()
}
