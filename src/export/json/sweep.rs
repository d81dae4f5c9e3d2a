//! Kind `sweep`: many runs of equation (7), a row each.

use std::io;

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use super::DocumentKind;
use super::simulation::State;
use crate::export::simulation::{Column, SweepReport, columns};
#[cfg(feature = "schema")]
use crate::impact::sweep::Spacing;
use crate::impact::sweep::Summary;

/// Many runs of the paper's equation (7), over every combination of the values of some parameters;
/// units as in a document of kind `simulation`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SweepDocument<Rows = Vec<Row>> {
    /// The kind of document.
    pub schema: String,
    /// The parameters that are varied; the last varies fastest.
    pub axes: Vec<Axis>,
    /// What stands in a row: the parameters, in the order of the axes, then what came of the run,
    /// each with its unit and meaning.
    pub columns: Vec<Column>,
    /// A row for each run.
    pub rows: Rows,
}

/// A parameter and its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Axis {
    /// The parameter, by its name in problem files, whose unit its values have.
    pub name: String,
    /// The first value.
    pub from: f64,
    /// The last value.
    pub to: f64,
    /// The number of values.
    pub count: usize,
    /// How the values follow each other: `linear` by equal steps, `logarithmic` by equal ratios,
    /// `list` as they were given.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = Spacing::ALL.map(Spacing::name))))]
    pub spacing: String,
    /// The values, in order.
    pub values: Vec<f64>,
}

impl From<&crate::impact::sweep::Axis> for Axis {
    fn from(axis: &crate::impact::sweep::Axis) -> Self {
        let [from, to] = axis.ends();
        Self {
            name: axis.name().to_owned(),
            from,
            to,
            count: axis.values().len(),
            spacing: axis.spacing().name().to_owned(),
            values: axis.values().to_vec(),
        }
    }
}

/// What is kept of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Row {
    /// The values of the parameters, in the order of the axes.
    pub values: Vec<f64>,
    /// The number of contacts; null for a run that was stopped before it began.
    pub impacts: Option<usize>,
    /// When the envelope of the amplitude falls to a tenth of the first swing, in units of time;
    /// null where it does not.
    pub rest_time: Option<f64>,
    /// The same without a barrier; null where it does not rest, and where the baseline was not
    /// asked for.
    pub rest_no_barrier: Option<f64>,
    /// The same with a barrier that loses nothing; null likewise.
    pub rest_lossless: Option<f64>,
    /// The greatest depth in a barrier, in radians; 0 without contact, null for a run that was
    /// stopped before it began.
    pub penetration: Option<f64>,
    /// The greatest speed at a touch, in radians per unit of time; 0 without contact, null
    /// likewise.
    pub speed_in: Option<f64>,
    /// The energy lost in contacts, in units of m g L; null likewise.
    pub energy_lost: Option<f64>,
    /// The state at the end; null likewise.
    pub final_state: Option<State>,
    /// Whether the run got where it was to get.
    pub complete: bool,
    /// Why the run ended, in words.
    pub stopped: String,
}

/// The rows of a report, made one at a time while they are written, for there may be a million.
struct Streamed<'a>(&'a SweepReport<'a>);

impl Serialize for Streamed<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rows = self.0.rows.iter().enumerate();
        serializer.collect_seq(rows.map(|(index, summary)| row(self.0.values(index), summary)))
    }
}

/// Writes the document of kind `sweep`, a row at a time.
///
/// # Errors
/// The errors of the writer.
///
/// ```
/// use lindstedt::export::{json, simulation::SweepReport};
/// use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axes: [Axis; 1] = ["zeta=0.02:0.1:3".parse()?];
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axes[0].values().iter().map(|&zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, Integrator::Taylor, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// let report = SweepReport { axes: &axes, rows: &rows };
/// let mut text = Vec::new();
/// json::sweep(&report, &mut text)?;
/// let document: json::SweepDocument = serde_json::from_slice(&text)?;
/// assert_eq!(document.rows.len(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(report: &SweepReport, to: &mut dyn io::Write) -> io::Result<()> {
    let document = SweepDocument {
        schema: DocumentKind::Sweep.schema().to_owned(),
        axes: report.axes.iter().map(Axis::from).collect(),
        columns: columns(report.axes, report.has_baseline()),
        rows: Streamed(report),
    };
    super::write(&document, to)
}

fn row(values: Vec<f64>, summary: &Summary) -> Row {
    let begun = summary.is_begun();
    Row {
        values,
        impacts: begun.then_some(summary.impacts),
        rest_time: summary.rest_time.ok(),
        rest_no_barrier: summary.baseline.and_then(|[without, _]| without.ok()),
        rest_lossless: summary.baseline.and_then(|[_, lossless]| lossless.ok()),
        penetration: begun.then_some(summary.deepest),
        speed_in: begun.then_some(summary.fastest),
        energy_lost: begun.then_some(summary.energy_lost),
        final_state: begun.then_some(State {
            t: summary.end_time,
            x: summary.end_x,
            velocity: summary.end_velocity,
        }),
        complete: summary.stop.is_complete(),
        stopped: summary.stop.to_string(),
    }
}
