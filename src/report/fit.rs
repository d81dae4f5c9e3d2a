//! The laws of a measurement: which one fits, its parameters with their errors, what is excluded.

use super::{Block, Document, Heading, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::fit::answer::{Answer, Estimate, LawFit};
use crate::fit::fitted_record::FittedRecord;
use crate::fit::impacts::{ImpactAnswer, ImpactFit};
use crate::fit::record::ReadRecord;
use crate::fit::response::{FrequencyResponse, ResponseFit};
use crate::fit::tables::{TableAnswer, TableFit, TableRow};

/// A measurement, and what it says.
#[derive(Clone, Copy, Debug)]
pub enum FitReport<'a> {
    /// Records of free decays, or of motions of one's own equation.
    Decay {
        /// The records as they were read.
        records: &'a [ReadRecord],
        /// The laws.
        answer: &'a Answer,
        /// The time until which the law is followed beyond a record.
        until: Option<f64>,
    },
    /// A table of frequency, and perhaps damping, against amplitude.
    Backbone {
        /// The rows.
        rows: &'a [TableRow],
        /// The laws.
        answer: &'a TableAnswer,
    },
    /// Amplitude, and perhaps phase, against the frequency of a drive.
    Response {
        /// The rows.
        response: &'a FrequencyResponse,
        /// The law.
        fit: &'a ResponseFit,
    },
    /// Times of the impacts of a body that bounces.
    Impacts(&'a ImpactAnswer),
}

/// A law beside a measurement, in words and numbers.
#[derive(Clone, Debug)]
pub struct FittedLaw {
    /// Its name.
    pub name: String,
    /// The equation of motion; empty for a law of restitution.
    pub equation: String,
    /// The parameters with their standard errors; none of a law that was not fitted to the samples.
    pub estimates: Vec<Estimate>,
    /// Chi-square per degree of freedom; `None` where the law was not fitted to the samples.
    pub chi_squared: Option<f64>,
    /// The criterion of Akaike.
    pub aic: Option<f64>,
    /// The reason that excludes it; `None` for the best law, and for one that the measurement does not exclude.
    pub excluded: Option<String>,
}

/// An increase of chi-square from which on a law is excluded: three standard errors of one parameter.
const EXCLUDED: f64 = 9.0;

impl FitReport<'_> {
    /// The laws, the best first.
    pub fn laws(&self) -> Vec<FittedLaw> {
        match self {
            Self::Decay { answer, .. } => of_decay(answer),
            Self::Backbone { answer, .. } => {
                // With dampings the best spring has every loss, and the others have none.
                let losses = of_table(&answer.laws, |fit, excess| {
                    let own = fit.law.name.split_once(", ").map_or("", |(_, loss)| loss);
                    format!("the damping ratios exclude {own}: its BIC is {} more", times(excess))
                });
                let springs = of_table(&answer.springs, |fit, _| {
                    let worst = size_in_percent(fit.worst_frequency);
                    format!("its frequencies are off by up to {worst}")
                });
                let further = springs.into_iter().skip(usize::from(!answer.laws.is_empty()));
                losses.into_iter().chain(further).collect()
            }
            Self::Response { fit, .. } => vec![FittedLaw {
                name: fit.law.name.clone(),
                equation: fit.law.equation.clone(),
                estimates: fit.estimates.clone(),
                chi_squared: None,
                aic: None,
                excluded: None,
            }],
            Self::Impacts(answer) => answer.laws.iter().map(of_impacts).collect(),
        }
    }

    /// The times of the first and the last sample of the first record.
    pub fn times(&self) -> Option<[f64; 2]> {
        match self {
            Self::Decay { answer, .. } => {
                let times = &answer.records.first()?.samples.times;
                Some([*times.first()?, *times.last()?])
            }
            _ => None,
        }
    }

    /// The best law of a decay, with all that was found of it.
    pub fn best(&self) -> Option<&LawFit> {
        match self {
            Self::Decay { answer, .. } => answer.best(),
            _ => None,
        }
    }
}

fn of_decay(answer: &Answer) -> Vec<FittedLaw> {
    let fitted = answer.laws.iter().enumerate().map(|(place, fit)| FittedLaw {
        name: fit.law.name.clone(),
        equation: fit.law.equation.clone(),
        estimates: fit.estimates.clone(),
        chi_squared: Some(fit.chi_square),
        aic: Some(fit.aic),
        excluded: (place > 0 && fit.excess >= EXCLUDED)
            .then(|| format!("its misfit is {} times what noise explains", times(fit.exclusion))),
    });
    let far = answer.excluded.iter().map(|law| FittedLaw {
        name: law.law.name.clone(),
        equation: law.law.equation.clone(),
        estimates: vec![],
        chi_squared: None,
        aic: None,
        excluded: Some(format!("{} times worse at the turning points", times(law.ratio))),
    });
    fitted.chain(far).collect()
}

/// Laws of a table, each with what excludes it in these words.
fn of_table<'a>(
    fits: impl IntoIterator<Item = &'a TableFit>,
    excluded: impl Fn(&TableFit, f64) -> String,
) -> Vec<FittedLaw> {
    /// An increase of Schwarz' criterion from which on a law is out of the question.
    const FAR: f64 = 10.0;
    let mut least = f64::INFINITY;
    let law = |fit: &'a TableFit| {
        least = least.min(fit.bic);
        let excess = fit.bic - least;
        FittedLaw {
            name: fit.law.name.clone(),
            equation: fit.law.equation.clone(),
            estimates: fit.estimates.clone(),
            chi_squared: None,
            aic: None,
            excluded: (excess > FAR).then(|| excluded(fit, excess)),
        }
    };
    fits.into_iter().map(law).collect()
}

fn of_impacts(fit: &ImpactFit) -> FittedLaw {
    FittedLaw {
        name: fit.law.name().to_owned(),
        equation: String::new(),
        estimates: fit.estimates.clone(),
        chi_squared: Some(fit.chi_square),
        aic: None,
        excluded: (fit.excess >= EXCLUDED).then(|| {
            format!("its chi-square exceeds that of the best law by {}", times(fit.excess))
        }),
    }
}

/// A large number by its first digits: 994, 3.1e5.
fn times(ratio: f64) -> String {
    match ratio < 1e4 {
        true => format!("{ratio:.0}"),
        false => significant(ratio, 2),
    }
}

/// A value with its standard error, both to the second digit of the error: `0.0040025 +- 0.0000026`.
fn with_error(estimate: &Estimate) -> [String; 2] {
    let Estimate { value, error, .. } = *estimate;
    let is_number = error.is_finite() && error > 0.0;
    if !is_number || value == 0.0 {
        return [decimal(value), if is_number { decimal(error) } else { "-".to_owned() }];
    }
    let digits = (value.abs() / error).log10().floor() as i32 + 2;
    [significant(value, digits.clamp(1, 15) as usize), significant(error, 2)]
}

fn estimates<'a>(own: &[Estimate]) -> Block<'a> {
    let rows = own.iter().map(|own| {
        let [value, error] = with_error(own);
        vec![own.name.clone(), value, error]
    });
    Block::table(["", "value", "standard error"], rows)
}

/// The document of a measurement.
pub fn fit<'a>(report: &FitReport) -> Document<'a> {
    let laws = report.laws();
    let mut sections = vec![match report {
        FitReport::Decay { records, answer, .. } => of_records(records, answer),
        FitReport::Backbone { rows, .. } => of_rows(rows),
        FitReport::Response { response, .. } => of_response(response),
        FitReport::Impacts(answer) => vec![Block::Heading(format!(
            "{} impacts, their times good to {}",
            answer.measured.len() + 2,
            significant(answer.noise, 2)
        ))],
    }];
    if let Some(best) = laws.first() {
        let mut blocks = vec![Block::Heading(format!("The law: {}", best.name))];
        if !best.equation.is_empty() && best.equation != best.name {
            blocks.push(Block::Note(best.equation.clone()));
        }
        blocks.push(estimates(&best.estimates));
        if report.best().is_some() {
            blocks.push(Block::Note(
                "x0, v0: at the first sample; offset: in the middle of the record; drift: per unit of time".to_owned(),
            ));
        }
        if let Some(fit) = report.best() {
            blocks.extend(of_best(fit));
        }
        if let FitReport::Response { fit, .. } = report {
            let mut facts = vec![("scatter of the amplitudes", significant(fit.noise, 3))];
            if !fit.converged {
                facts.push(not_converged());
            }
            blocks.push(Block::Facts(facts));
        }
        if let FitReport::Backbone { answer, .. } = report {
            let worst = answer.laws.first().or(answer.springs.first());
            blocks.extend(worst.map(|fit| {
                let worst = size_in_percent(fit.worst_frequency);
                Block::Facts(vec![("largest deviation of the frequency", worst)])
            }));
        }
        sections.push(blocks);
    }
    sections.extend(others(report, &laws));
    match report {
        FitReport::Decay { answer, .. } => {
            let points = answer.records.iter().flat_map(|own| &own.backbone);
            let rows: Vec<Vec<String>> = points
                .map(|point| {
                    let of =
                        |value, error| with_error(&Estimate { name: String::new(), value, error });
                    let [amplitude, _] = of(point.amplitude, point.amplitude_error);
                    let [frequency, damping] = [
                        of(point.frequency, point.frequency_error),
                        of(point.damping, point.damping_error),
                    ];
                    [[amplitude].as_slice(), &frequency, &damping].concat()
                })
                .collect();
            let head = [
                ("amplitude", "amplitude"),
                ("omega", r"$\omega$"),
                ("error", "error"),
                ("zeta", r"$\zeta$"),
                ("error", "error"),
            ];
            // A driven motion has the frequency of its drive.
            let is_driven = report.best().is_some_and(|fit| fit.law.is_driven());
            if !rows.is_empty() && !is_driven {
                let heading = "Without a law: frequency and damping against amplitude";
                sections.push(vec![Block::Heading(heading.to_owned()), Block::table(head, rows)]);
            }
        }
        FitReport::Impacts(answer) => {
            let rows = answer.measured.iter().map(|own| {
                let [value, error] = with_error(&Estimate {
                    name: String::new(),
                    value: own.value,
                    error: own.error,
                });
                vec![significant(own.speed, 5), value, error]
            });
            sections.push(vec![
                Block::Heading("Each impact: the ratio of the flights beside it".to_owned()),
                Block::table(["speed", "restitution", "standard error"], rows),
            ]);
        }
        _ => {}
    }
    Document { sections }
}

/// The tables of laws: those that were fitted to the samples, and those that turning points exclude.
fn others<'a>(report: &FitReport, laws: &[FittedLaw]) -> Vec<Vec<Block<'a>>> {
    let mut sections = vec![];
    let cell = |own: Option<f64>| own.map_or(String::new(), |own| significant(own, 6));
    if let FitReport::Decay { answer, .. } = report {
        let fitted = answer.laws.iter().zip(laws).map(|(fit, law)| {
            let excluded = match &law.excluded {
                Some(_) => format!("{} times noise", times(fit.exclusion)),
                None => String::new(),
            };
            vec![law.name.clone(), cell(law.chi_squared), cell(law.aic), excluded]
        });
        if answer.laws.len() > 1 {
            sections.push(vec![
                Block::Heading("Laws fitted to the samples, the best first".to_owned()),
                Block::table(
                    [
                        Heading::from("law"),
                        Heading::from(("chi^2/n", r"$\chi^2/n$")),
                        Heading::from("AIC"),
                        Heading::from("misfit"),
                    ],
                    fitted,
                ),
            ]);
        }
        let excluded = answer
            .excluded
            .iter()
            .map(|law| vec![law.law.name.clone(), format!("{} times", times(law.ratio))]);
        if !answer.excluded.is_empty() {
            sections.push(vec![
                Block::Heading(
                    "Laws that the turning points exclude: chi^2 over that of the best".to_owned(),
                ),
                Block::table(["law", "worse by"], excluded),
            ]);
        }
    } else if laws.len() > 1 {
        let rows = laws.iter().map(|law| {
            let values = law.estimates.iter().map(|own| {
                let [value, _] = with_error(own);
                format!("{} = {value}", own.name)
            });
            let values: Vec<String> = values.collect();
            vec![law.name.clone(), values.join(", "), law.excluded.clone().unwrap_or_default()]
        });
        sections.push(vec![
            Block::Heading("Laws, the best first".to_owned()),
            Block::table(["law", "parameters", "excluded"], rows),
        ]);
    }
    sections
}

/// The records, before any law.
fn of_records<'a>(records: &[ReadRecord], answer: &Answer) -> Vec<Block<'a>> {
    records
        .iter()
        .zip(&answer.records)
        .map(|(read, own)| of_record(read, own, answer.noise))
        .collect()
}

/// A record, before any law.
fn of_record<'a>(read: &ReadRecord, found: &FittedRecord, noise: f64) -> Block<'a> {
    let times = &read.record.times;
    let duration = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let quality = &found.quality;
    let amplitudes = found.swings.amplitudes();
    let [from, to] = [amplitudes.first(), amplitudes.last()].map(|own| own.copied().unwrap_or(0.0));
    let mut facts = vec![
        (
            "record",
            format!(
                "{} samples of `{}`{} over {}, every {}",
                times.len(),
                read.name,
                if read.record.is_angle { ", in radians" } else { "" },
                significant(duration, 5),
                significant(quality.step, 4)
            ),
        ),
        (
            "swings",
            format!(
                "{} turning points, {} crossings, amplitude from {} to {}",
                found.swings.points.len(),
                found.crossings.len(),
                significant(from, 4),
                significant(to, 4)
            ),
        ),
        ("noise", significant(noise, 3)),
    ];
    if let Some(quantum) = quality.quantum {
        facts.push(("quantised", format!("in steps of {}", significant(quantum, 4))));
    }
    if let Some(line) = quality.start.checked_sub(1).and_then(|_| read.lines.get(quality.start)) {
        facts.push(("start", format!("the free decay begins at line {line}")));
    }
    let of_lines = |places: &[usize]| -> Vec<usize> {
        places.iter().filter_map(|place| read.lines.get(*place).copied()).collect()
    };
    let gaps: Vec<usize> = quality.gaps.iter().map(|(place, _)| *place).collect();
    let listed = [
        ("gaps", of_lines(&gaps), "gap"),
        ("missing", read.missing.clone(), "empty cell"),
        ("repeated times", read.repeated.clone(), "line"),
        ("saturated", of_lines(&quality.saturated), "sample"),
        ("left out", of_lines(&found.outliers), "sample"),
    ];
    for (name, lines, words) in listed {
        let Some(first) = lines.first() else { continue };
        let text = match lines.len() {
            1 => format!("1 {words}, line {first}"),
            count => format!("{count} {words}s, the first at line {first}"),
        };
        facts.push((name, text));
    }
    Block::Facts(facts)
}

/// A search that ended without a minimum.
fn not_converged() -> (&'static str, String) {
    ("search", "it did not converge: the values are the best so far".to_owned())
}

/// The smallest and the largest of some values, in words.
fn range_of(values: impl Iterator<Item = f64> + Clone) -> String {
    let from = values.clone().fold(f64::INFINITY, f64::min);
    let to = values.fold(0.0, f64::max);
    format!("from {} to {}", significant(from, 4), significant(to, 4))
}

fn of_rows<'a>(rows: &[TableRow]) -> Vec<Block<'a>> {
    let amplitudes = range_of(rows.iter().map(|row| row.amplitude));
    vec![Block::Facts(vec![("table", format!("{} rows, amplitudes {amplitudes}", rows.len()))])]
}

fn of_response<'a>(response: &FrequencyResponse) -> Vec<Block<'a>> {
    let rows = &response.rows;
    let [frequencies, amplitudes] = [
        range_of(rows.iter().map(|row| row.frequency)),
        range_of(rows.iter().map(|row| row.amplitude)),
    ];
    let phases = rows.iter().any(|row| row.phase.is_some());
    let mut facts = vec![(
        "response",
        format!(
            "{} rows{}, angular frequencies {frequencies}, amplitudes of the first harmonic {amplitudes}",
            rows.len(),
            if phases { " with phases" } else { "" }
        ),
    )];
    if !response.known.is_empty() {
        let names = response.known.iter().map(|(name, _)| name.to_string());
        facts.push(("known", names.collect::<Vec<_>>().join(", ")));
    }
    vec![Block::Facts(facts)]
}

/// The remarks on the best law of a decay.
fn of_best<'a>(fit: &LawFit) -> Vec<Block<'a>> {
    let white = match fit.whiteness.is_white() {
        true => "white, as noise is".to_owned(),
        false => {
            "not white: something is left that the law does not say; the errors are enlarged for it"
                .to_owned()
        }
    };
    let mut facts = vec![("residuals", white)];
    if let Some((one, other, value)) = most_correlated(fit) {
        facts.push(("correlation", format!("{} of {one} and {other}", significant(value, 3))));
    }
    if !fit.converged {
        facts.push(not_converged());
    }
    let flat = fit.flat.iter().map(|direction| Block::Note(direction.clone()));
    std::iter::once(Block::Facts(facts)).chain(flat).collect()
}

/// The pair of parameters with the largest correlation, if that is large.
fn most_correlated(fit: &LawFit) -> Option<(&str, &str, f64)> {
    const LARGE: f64 = 0.9;
    let count = fit.law.parameters.len();
    let pairs = (0..count).flat_map(|one| (0..one).map(move |other| (other, one)));
    let (one, other) = pairs.max_by(|one, other| {
        fit.correlations[*one].abs().total_cmp(&fit.correlations[*other].abs())
    })?;
    let value = fit.correlations[(one, other)];
    (value.abs() > LARGE)
        .then(|| (fit.estimates[one].name.as_str(), fit.estimates[other].name.as_str(), value))
}
