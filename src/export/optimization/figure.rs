//! The convergence of the runs of a search, the good designs in the box, and the front of several
//! objectives.

use crate::decimal::{decimal, significant};
use crate::export::figure::{
    Curve, CurveStyle, FigureError, GuideLine, Panel, Points, Scale, curve, figure, panel,
};
use crate::optimize::{Objective, Study, Variable, WITHIN};

/// Largest number of runs that are drawn.
const DRAWN: usize = 200;

/// The picture of a search: for one objective the convergence of all runs and of the baselines, and
/// the designs within 1 % of the best in the box, with the best of the runs and the paper's Table
/// 5; for several the front, the first objective against each other one.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::optimization::figure;
/// use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
///
/// let study = optimize(OptimizationProblem { runs: 3, ..OptimizationProblem::default() }, vec![], &StudyObserver::default())?;
/// assert!(figure::optimization(&study)?.contains("Convergence"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn optimization(study: &Study) -> Result<String, FigureError> {
    match study.question.objectives.len() {
        1 => search(study),
        _ => front(study),
    }
}

fn axis(objective: Objective) -> &'static str {
    match objective {
        Objective::RestTime => "rest time (s)",
        Objective::DimensionlessRestTime => "rest time (1/ω)",
        Objective::PeakForce => "peak force (N)",
        Objective::PeakPressure => "peak pressure (Pa)",
        Objective::Mass => "mass (kg)",
        Objective::Impacts => "impacts until rest",
        Objective::PrimaryRestTime => "rest time of the main mass (s)",
    }
}

fn search(study: &Study) -> Result<String, FigureError> {
    let objective = study.objective();
    let convergence = SearchConvergence::from_study(study);
    let designs = Designs::from_study(study);
    let curves = convergence.curves(study);
    let mut panels = Vec::new();
    if !curves.is_empty() {
        let labels = ["evaluations of a run", axis(objective)];
        panels.push(panel("Convergence", labels, curves, vec![]));
    }
    panels.extend(designs.panels(study));
    let best = study.best().map_or(String::new(), |best| {
        format!(
            "; the best design by integration: {} {}",
            significant(best.values[0], 5),
            objective.unit()
        )
    });
    let caption = format!(
        "{} runs of a genetic algorithm, seed {}: {}{best}.",
        study.runs.len(),
        study.question.seed,
        objective.meaning()
    );
    figure(&panels, &caption)
}

/// The best value of each search against the number of evaluations.
struct SearchConvergence {
    runs: Vec<Points>,
    median: Points,
    rivals: Vec<Points>,
}

impl SearchConvergence {
    fn from_study(study: &Study) -> Self {
        let population = study.question.genetic.population as f64;
        let (crossed, mutated) = study.question.genetic.children();
        let born = (crossed + mutated) as f64;
        let finite = |points: Points| -> Points {
            points.into_iter().filter(|(_, value)| value.is_finite()).collect()
        };
        let after = |curve: &[f64]| -> Points {
            let place = |(index, value): (usize, &f64)| (population + born * index as f64, *value);
            finite(curve.iter().enumerate().map(place).collect())
        };
        let drawn = study.runs.iter().take(DRAWN).map(|run| after(&run.curve));
        let rival = |curve: &[f64]| -> Points {
            let place = |(index, value): (usize, &f64)| (population * (index + 1) as f64, *value);
            finite(curve.iter().enumerate().map(place).collect())
        };
        Self {
            runs: drawn.filter(|points| points.len() > 1).collect(),
            median: after(&study.median_curve()),
            rivals: study.rivals.iter().map(|own| rival(&own.curve)).collect(),
        }
    }

    fn curves<'a>(&'a self, study: &'a Study) -> Vec<Curve<'a>> {
        let runs = self.runs.iter();
        let mut curves: Vec<Curve> =
            runs.map(|points| curve("each run", points, CurveStyle::ONE_OF_MANY)).collect();
        let beside = [CurveStyle::SERIES[1], CurveStyle::SERIES[2]];
        let rivals = study.rivals.iter().zip(&self.rivals).zip(beside);
        let drawn = rivals.filter(|((_, points), _)| points.len() > 1);
        curves.extend(drawn.map(|((rival, points), style)| curve(rival.name, points, style)));
        if self.median.len() > 1 {
            curves.push(curve("genetic algorithm, median", &self.median, CurveStyle::SERIES[0]));
        }
        curves
    }
}

/// The designs in the box, two variables at a time.
struct Designs {
    pairs: Vec<[usize; 2]>,
    labels: Vec<String>,
    within: String,
    /// The points of each pair: the designs near the best, the best of each run, those of the
    /// paper.
    points: Vec<[Points; 3]>,
}

impl Designs {
    fn from_study(study: &Study) -> Self {
        let variables = &study.question.variables;
        // Every variable is drawn once, in pairs; an odd last one is paired with the first.
        let pairs = (0..variables.len()).step_by(2);
        let pairs = pairs.filter_map(|index| match (index + 1 < variables.len(), index) {
            (true, _) => Some([index, index + 1]),
            (false, 0) => None,
            (false, _) => Some([0, index]),
        });
        let pairs: Vec<[usize; 2]> = pairs.take(2).collect();
        let points = |pair: &[usize; 2]| {
            let at = |point: &[f64]| (point[pair[0]], point[pair[1]]);
            let near = study.decision.iter().flat_map(|decision| &decision.points);
            let best = study.runs.iter().filter_map(|run| run.found.first());
            [
                near.take(1500).map(|point| at(point)).collect(),
                best.map(|found| at(&found.point)).collect(),
                study.default_design.iter().map(|papers| at(&papers.point)).collect(),
            ]
        };
        let label = |variable: &Variable| {
            format!("{} ({})", variable.parameter.name(), variable.parameter.unit())
        };
        Self {
            points: pairs.iter().map(points).collect(),
            pairs,
            labels: variables.iter().map(label).collect(),
            within: format!("within {} % of the best", decimal(100.0 * WITHIN)),
        }
    }

    fn panels<'a>(&'a self, study: &Study) -> Vec<Panel<'a>> {
        let variables = &study.question.variables;
        let scale = |index: usize| match variables[index].upper / variables[index].lower > 30.0 {
            true => Scale::Logarithmic,
            false => Scale::Linear,
        };
        let panel = |(pair, points): (&[usize; 2], &'a [Points; 3])| {
            let names = [&self.within, "best of each run", "the paper's Table 5"];
            let styles =
                [CurveStyle::POINTS, CurveStyle::MARKED_POINTS, CurveStyle::SECOND_MARKED_POINTS];
            let all = names.into_iter().zip(points).zip(styles);
            let curves: Vec<Curve> = all
                .filter(|((_, points), _)| !points.is_empty())
                .map(|((name, points), style)| curve(name, points, style))
                .collect();
            let [x, y] = pair.map(|index| [variables[index].lower, variables[index].upper]);
            (!curves.is_empty()).then(|| Panel {
                title: "Where the good designs lie",
                x_label: &self.labels[pair[0]],
                y_label: &self.labels[pair[1]],
                x_scale: scale(pair[0]),
                y_scale: scale(pair[1]),
                curves,
                guides: x
                    .map(|at| GuideLine::X(at, "limits"))
                    .into_iter()
                    .chain(y.map(|at| GuideLine::Y(at, "limits")))
                    .collect(),
            })
        };
        self.pairs.iter().zip(&self.points).filter_map(panel).collect()
    }
}

fn front(study: &Study) -> Result<String, FigureError> {
    let objectives = &study.question.objectives;
    let others: Vec<usize> = (1..objectives.len()).collect();
    let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(f64::NAN);
    let points: Vec<Points> = others
        .iter()
        .map(|index| {
            let pairs = study
                .finalists
                .iter()
                .map(|finalist| (value(&finalist.values, 0), value(&finalist.values, *index)));
            pairs.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
        })
        .collect();
    let papers: Vec<Points> = others
        .iter()
        .map(|index| {
            let papers = study.default_design.as_ref();
            let pair = papers.and_then(|papers| {
                Some((objectives[0].value(papers)?, objectives[*index].value(papers)?))
            });
            pair.into_iter().collect()
        })
        .collect();
    let mut panels = Vec::new();
    for (place, index) in others.iter().enumerate() {
        let mut curves = Vec::new();
        if !points[place].is_empty() {
            curves.push(curve("the front", &points[place], CurveStyle::POINTS));
        }
        if !papers[place].is_empty() {
            curves.push(curve(
                "the paper's Table 5",
                &papers[place],
                CurveStyle::SECOND_MARKED_POINTS,
            ));
        }
        let spread = |of: fn(&(f64, f64)) -> f64| {
            let values = points[place].iter().map(of);
            let least = values.clone().fold(f64::INFINITY, f64::min);
            let greatest = values.fold(0.0, f64::max);
            match least > 0.0 && greatest / least > 30.0 {
                true => Scale::Logarithmic,
                false => Scale::Linear,
            }
        };
        let labels = [axis(objectives[0]), axis(objectives[*index])];
        panels.push(Panel {
            x_scale: spread(|point| point.0),
            y_scale: spread(|point| point.1),
            ..panel("Front", labels, curves, vec![])
        });
    }
    let names: Vec<&str> = objectives.iter().map(|objective| objective.meaning()).collect();
    let caption = format!(
        "{} designs none of which is better than another in everything: {}. {} runs of NSGA-II, seed {}.",
        study.finalists.len(),
        names.join("; "),
        study.runs.len(),
        study.question.seed
    );
    figure(&panels, &caption)
}
