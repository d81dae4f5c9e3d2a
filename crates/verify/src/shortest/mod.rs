//! The shortest frequency law within an error on a range.
//!
//! In: a [`LawProblem`], the quantities of which laws are made, and the greatest length. Out: a
//! [`Front`], the law with the smallest largest error for each length, none longer than one that is
//! better, and of each the proof of its error.
//!
//! Laws come from two searches: `trees`, all short formulas without constants of their own, and
//! `families`, powers of quotients of sums whose constants are found by `minimax` and made short by
//! `constants`. Both are the same for any number of threads.

mod constants;
mod contact;
mod families;
mod formula;
mod minimax;
mod problem;
mod rest;
mod trees;

pub use formula::{Formula, length};
pub use problem::{Atom, LawMotion, LawProblem, ShortestError};

use std::collections::BTreeMap;

use num_traits::{One as _, Zero as _};

use crate::certificate::{
    LawCertificate, LawError, LawNotProved, LawQuantity, MotionsOfLaw, TrueFrequency,
};
use crate::decimal::neighbours;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, to_f64};
use crate::expr::{Expr, parse_expression};
use crate::interrupt::Supervision;
use crate::parallel::par_map;
use crate::symbol::Symbol;
use constants::{rounded_error, shortened};
use families::{RelativeFunctions, ShortFunction, Structure, is_same_growth, structures};
use minimax::{FitSteps, Tie};
use problem::TrueFrequencies;
use rest::RestSeries;
use trees::Trees;

/// The quantity, the means and the extent of a search.
#[derive(Clone, Debug)]
pub struct SearchOptions {
    /// The quantity that a law gives.
    pub quantity: LawQuantity,
    /// The quantities of which laws are made; those of the problem where there are none.
    pub atoms: Vec<Atom>,
    /// The greatest length.
    pub longest: usize,
    /// The highest power of the variable up to which the series of a law is that of the truth; `None`
    /// where it need not be.
    pub exact_at_rest: Option<u32>,
    /// The power of the variable as which a law grows towards infinity, whatever the range; `None` where it
    /// may be any.
    pub growth: Option<Rational>,
}

impl SearchOptions {
    /// A search of laws of a quantity, without conditions.
    pub fn new(quantity: LawQuantity, longest: usize) -> Self {
        Self { quantity, atoms: vec![], longest, exact_at_rest: None, growth: None }
    }
}

/// A formula as it is published, in the variable of a problem.
#[derive(Clone, Debug)]
pub struct PublishedFormula {
    /// The formula.
    pub text: String,
    /// The quantity that it gives.
    pub quantity: LawQuantity,
    /// The publication.
    pub source: String,
}

/// A published formula and its largest error on the range.
#[derive(Clone, Debug)]
pub struct MeasuredFormula {
    /// The formula.
    pub published: PublishedFormula,
    /// The number of its symbols, those of a quantity of the problem counted as one.
    pub length: usize,
    /// The largest relative error that was measured; infinite where the formula has no value.
    pub error: f64,
    /// The value of the variable at which that is.
    pub worst: f64,
}

/// A law and its largest error on the range.
#[derive(Clone, Debug)]
pub struct ShortLaw {
    /// The law in the names of the quantities.
    pub formula: Formula,
    /// The number of its symbols.
    pub length: usize,
    /// The largest relative error that was measured.
    pub error: f64,
    /// The value of the variable at which that is.
    pub worst: f64,
    /// The proof, or the reason why there is none.
    pub proof: Result<(LawCertificate, LawError), LawNotProved>,
}

/// The best laws by length.
#[derive(Clone, Debug)]
pub struct Front {
    /// The problem.
    pub problem: LawProblem,
    /// The quantity that the laws give.
    pub quantity: LawQuantity,
    /// The quantities of which they are made.
    pub atoms: Vec<Atom>,
    /// The laws, the shortest first, each with a smaller error than all before.
    pub laws: Vec<ShortLaw>,
    /// Published formulas beside them.
    pub published: Vec<MeasuredFormula>,
    /// Whether the search was stopped before its end.
    pub is_partial: bool,
    /// The truth on which errors are measured.
    data: SearchData,
}

impl Front {
    /// The front with published formulas beside it, measured on the same truth.
    #[must_use]
    pub fn beside(self, published: &[PublishedFormula]) -> Self {
        let measured = published.iter().map(|own| self.data.measured(own, &self.atoms)).collect();
        Self { published: measured, ..self }
    }

    /// The error of a law along the range, with its sign, over the variable, or over the restitution of a
    /// contact where that is what has a range.
    pub fn errors_along(&self, law: &ShortLaw) -> Vec<(f64, f64)> {
        let names: Vec<Symbol> = self.atoms.iter().map(|atom| atom.name).collect();
        let values = self.data.values_of(&law.formula, &names, 1);
        let along = match self.problem.abscissa() == self.problem.variable {
            true => &self.data.truth.places,
            false => &self.data.truth.restitutions,
        };
        let errors = values.iter().zip(&self.data.values).map(|(value, truth)| value / truth - 1.0);
        along.iter().copied().zip(errors).collect()
    }

    /// The shortest law whose largest error is at most this, proved where there is a proof.
    pub fn shortest_within(&self, error: f64) -> Option<&ShortLaw> {
        self.laws.iter().find(|law| law.largest_error() <= error)
    }
}

impl ShortLaw {
    /// The proved upper bound of the error, or else the error that was measured.
    pub fn largest_error(&self) -> f64 {
        match &self.proof {
            Ok((certificate, _)) => to_f64(&certificate.claim[1]),
            Err(_) => self.error,
        }
    }
}

/// The truth and the atoms at all places of a search.
#[derive(Clone, Debug)]
struct SearchData {
    truth: TrueFrequencies,
    /// The quantity at the places.
    values: Vec<f64>,
    /// The atoms at the places, atom by atom.
    atoms: Vec<Vec<f64>>,
}

/// Number of places at which errors are measured, and of those for fits and for telling functions
/// apart.
const PLACES: usize = 385;
const OF_FIT: usize = 49;
const OF_TREES: usize = 17;

/// The length up to which all short formulas are kept, and up to which those made of two of them are
/// tried.
const KEPT_TREES: usize = 6;
const LONGEST_TREE: usize = 9;

/// The error from which on a formula is none.
const WORST: f64 = 0.5;

/// The least error that is claimed, of a law that is exact: the enclosures are no finer.
const LEAST_CLAIM: f64 = 1e-9;

/// The length up to which short formulas are functions of families.
const LONGEST_FUNCTION: usize = 5;

impl SearchData {
    fn new(
        problem: &LawProblem,
        quantity: LawQuantity,
        atoms: &[Atom],
        enclosed: Option<&TrueFrequency>,
    ) -> Result<Self, ShortestError> {
        let truth = problem.true_frequencies(PLACES, enclosed)?;
        let values = truth.frequencies.iter().map(|omega| omega.powi(quantity.power()));
        let values = values.collect();
        let at = |atom: &Atom| {
            let Some(meaning) = &atom.meaning else { return Ok(truth.restitutions.clone()) };
            let value =
                |place: &f64| meaning.evaluate(&BTreeMap::from([(problem.variable, *place)]));
            let values = truth.places.iter().map(value).collect::<Result<Vec<f64>, _>>();
            values.map_err(|_| ShortestError::Atom(meaning.clone(), problem.variable))
        };
        let atoms = atoms.iter().map(at).collect::<Result<_, _>>()?;
        Ok(Self { truth, values, atoms })
    }

    /// Every so many-th of some values, so that `count` are left.
    fn some(values: &[f64], count: usize) -> Vec<f64> {
        values.iter().step_by((PLACES - 1) / (count - 1)).copied().collect()
    }

    /// A formula at every so many-th place.
    fn values_of(&self, formula: &Formula, names: &[Symbol], step: usize) -> Vec<f64> {
        let count = self.values.len().div_ceil(step);
        let values = |name| match names.iter().position(|own| *own == name) {
            Some(i) => self.atoms[i].iter().step_by(step).copied().collect(),
            None => vec![f64::NAN; count],
        };
        formula.values(&values, count)
    }

    /// The largest error of a published formula, whose letters are those of the atoms.
    fn measured(&self, published: &PublishedFormula, atoms: &[Atom]) -> MeasuredFormula {
        let law = parse_expression(&published.text).ok();
        let mut largest = (0.0, self.truth.places[0]);
        for (place, truth) in self.truth.frequencies.iter().enumerate() {
            let values =
                atoms.iter().zip(&self.atoms).map(|(atom, values)| (atom.name, values[place]));
            let value = law.as_ref().and_then(|law| law.evaluate(&values.collect()).ok());
            let truth = truth.powi(published.quantity.power());
            let error = value.map_or(f64::INFINITY, |value| (value / truth - 1.0).abs());
            if error > largest.0 {
                largest = (error, self.truth.places[place]);
            }
        }
        let (error, worst) = largest;
        MeasuredFormula {
            published: published.clone(),
            length: length(&published.text),
            error,
            worst,
        }
    }

    /// The largest relative error of a formula, and where it is.
    fn largest_error(&self, formula: &Formula, names: &[Symbol]) -> (f64, f64) {
        let mut largest = (0.0, self.truth.places[0]);
        let values = self.values_of(formula, names, 1);
        for (place, (value, truth)) in values.iter().zip(&self.values).enumerate() {
            let error = (value / truth - 1.0).abs();
            if error.is_nan() {
                return (f64::INFINITY, self.truth.places[place]);
            }
            if error > largest.0 {
                largest = (error, self.truth.places[place]);
            }
        }
        largest
    }
}

/// A law before its proof.
struct Candidate {
    formula: Formula,
    length: usize,
    error: f64,
    worst: f64,
}

/// Searches the best laws of a problem by length, and proves their errors.
///
/// # Errors
/// [`ShortestError`].
///
/// ```no_run
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::LawQuantity;
/// use lindstedt::shortest::{LawProblem, SearchOptions, search};
/// use lindstedt::{Oscillator, Supervision};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let range = (&"0".parse()?, Some(&"14/5".parse()?));
/// let problem = LawProblem::new(&pendulum, &"A".parse()?, range, &"".parse()?)?;
/// let options = SearchOptions::new(LawQuantity::Period, 8);
/// let front = search(problem, &options, Supervision::default())?;
/// assert!(front.laws.last().is_some_and(|law| law.error < 0.0076));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn search(
    problem: LawProblem,
    options: &SearchOptions,
    supervision: Supervision,
) -> Result<Front, ShortestError> {
    let atoms = match options.atoms.is_empty() {
        true => problem.usual_atoms(),
        false => options.atoms.clone(),
    };
    let motions = problem.of_certificate();
    let certificate = |candidate: Option<&Candidate>| {
        let motions = motions.clone()?;
        certificate((&problem, motions), options.quantity, &atoms, candidate)
    };
    let enclosed = || TrueFrequency::new(&certificate(None)?, supervision);
    // A contact is known by its enclosure alone; a frequency is enclosed once there are laws.
    let of_contact = match problem.motion {
        LawMotion::Contact { .. } => Some(enclosed().map_err(|error| match error {
            LawNotProved::Stopped => ShortestError::Stopped,
            error => ShortestError::Contact(error),
        })?),
        _ => None,
    };
    let data = SearchData::new(&problem, options.quantity, &atoms, of_contact.as_ref())?;
    let rest = options.exact_at_rest.map(|order| RestSeries::new(&problem, options, order));
    let rest = rest.transpose()?;
    let question =
        SearchQuestion { problem: &problem, atoms: &atoms, options, rest: rest.as_ref() };
    let (found, is_partial) = laws(&data, &question, supervision);
    let truth = of_contact.map_or_else(enclosed, Ok);
    let proofs = par_map(&found, |candidate| {
        truth
            .as_ref()
            .map_err(LawNotProved::clone)
            .and_then(|truth| proved(truth, certificate(Some(candidate))?, supervision))
    });
    let laws = found.into_iter().zip(proofs).map(|(candidate, proof)| {
        let Candidate { formula, length, error, worst } = candidate;
        ShortLaw { formula, length, error, worst, proof }
    });
    let laws: Vec<ShortLaw> = laws.collect();
    let is_partial = is_partial || supervision.interrupt.is_requested();
    let quantity = options.quantity;
    Ok(Front { problem, quantity, atoms, laws, published: vec![], data, is_partial })
}

/// The question of a search.
struct SearchQuestion<'a> {
    problem: &'a LawProblem,
    atoms: &'a [Atom],
    options: &'a SearchOptions,
    rest: Option<&'a RestSeries>,
}

impl SearchQuestion<'_> {
    /// The power of the variable as which a formula grows towards infinity, from its values at two large
    /// numbers; not a number where it has none.
    fn growth(&self, formula: &Formula) -> f64 {
        const FAR: [f64; 2] = [1e30, 1e31];
        let values = |name| {
            let atom = self.atoms.iter().find(|atom| atom.name == name);
            let meaning = atom.and_then(|atom| atom.meaning.as_ref());
            let value = |place: &f64| {
                let values = BTreeMap::from([(self.problem.variable, *place)]);
                meaning.and_then(|meaning| meaning.evaluate(&values).ok()).unwrap_or(f64::NAN)
            };
            FAR.iter().map(value).collect()
        };
        let values = formula.values(&values, FAR.len());
        (values[1] / values[0]).abs().log10()
    }

    /// The first coefficients of a formula in powers of the variable; empty without a condition at rest,
    /// and where they are no fractions.
    fn series(&self, formula: &Formula) -> Vec<Rational> {
        let Some(rest) = self.rest else { return vec![] };
        let law = formula.expression().ok();
        let law = law.and_then(|law| law.substitute_all(&meanings(self.atoms)).ok());
        let series = law
            .and_then(|law| rest::power_series(&law, self.problem.variable, rest.quantity.len()));
        series.unwrap_or_default()
    }
}

/// The best candidates by length, and whether the search was stopped.
fn laws(
    data: &SearchData,
    question: &SearchQuestion,
    supervision: Supervision,
) -> (Vec<Candidate>, bool) {
    let SearchQuestion { problem, atoms, options, rest } = *question;
    let longest = options.longest;
    let growth = options.growth.as_ref().map(to_f64);
    let names: Vec<Symbol> = atoms.iter().map(|atom| atom.name).collect();
    let few: Vec<Vec<f64>> =
        data.atoms.iter().map(|values| SearchData::some(values, OF_TREES)).collect();
    // Towards infinity frequencies grow as powers, and a logarithm has no bound there.
    let has_logarithms = problem.to.is_some();
    let trees = Trees::new(atoms, &few, KEPT_TREES.min(longest), has_logarithms);
    let truth = SearchData::some(&data.values, OF_TREES);
    let mut front: Vec<Candidate> = vec![];
    let mut offer = |formula: Formula| {
        let length = formula.length();
        if growth.is_some_and(|growth| !is_same_growth(question.growth(&formula), growth)) {
            return;
        }
        if rest.is_some_and(|rest| question.series(&formula) != rest.quantity) {
            return;
        }
        let (error, worst) = data.largest_error(&formula, &names);
        if length <= longest && error < WORST {
            front.push(Candidate { formula, length, error, worst });
        }
    };
    trees.nearest(&truth, LONGEST_TREE.min(longest)).into_iter().for_each(&mut offer);
    let step = (PLACES - 1) / (OF_FIT - 1);
    let functions: Vec<ShortFunction> = trees
        .functions(LONGEST_FUNCTION)
        .into_iter()
        .map(|tree| {
            let formula = trees.formula(tree);
            let values = data.values_of(&formula, &names, step);
            let (series, growth) = (question.series(&formula), question.growth(&formula));
            let term_length = formula.clone().times(&Rational::from_integer(7.into())).length();
            ShortFunction { formula, term_length, values, growth, series }
        })
        .collect();
    let truth = SearchData::some(&data.values, OF_FIT);
    let relative = RelativeFunctions::of_all_powers(&functions, &truth);
    let chosen = structures(&functions, &relative, growth, longest);
    supervision.progress.begin(chosen.len());
    let found = par_map(&chosen, |structure| {
        let formulas = match supervision.interrupt.is_requested() {
            true => vec![],
            false => of_structure(structure, (&functions, &relative), rest, longest),
        };
        supervision.progress.advance();
        formulas
    });
    found.into_iter().flatten().for_each(offer);
    (best(front), supervision.interrupt.is_requested())
}

/// The formulas of a structure with constants of few digits.
fn of_structure(
    structure: &Structure,
    (functions, relative): (&[ShortFunction], &[RelativeFunctions]),
    rest: Option<&RestSeries>,
    longest: usize,
) -> Vec<Formula> {
    /// Steps of the fit with free constants.
    const STEPS: FitSteps = FitSteps::all(40);
    let Some(mut sums) = structure.sums(functions, relative) else { return vec![] };
    let tied = rest.map(|rest| structure.tied(functions, &rest.to_power(&structure.power)?));
    let tied = match tied {
        Some(None) => return vec![],
        Some(Some(tied)) => Some(tied),
        None => None,
    };
    let tie = tied.as_ref().map(|(offset, matrix)| Tie {
        offset: offset.iter().map(to_f64).collect(),
        matrix: matrix.iter().map(|row| row.iter().map(to_f64).collect()).collect(),
    });
    sums.tie = tie.as_ref();
    let free = vec![None; sums.count()];
    let Some(fit) = sums.minimax(&free, STEPS) else { return vec![] };
    let digits = (longest + sums.count()).saturating_sub(structure.length);
    let mut found = vec![];
    for is_scaled in [false, true] {
        if is_scaled && (!structure.has_constant || tied.is_some()) {
            continue;
        }
        for (_, mut short) in shortened(&sums, &fit, is_scaled, digits) {
            if let Some((offset, matrix)) = &tied {
                let all = offset.iter().zip(matrix).map(|(offset, row)| {
                    row.iter().zip(&short.values).fold(offset.clone(), |sum, (m, c)| sum + m * c)
                });
                short.values = all.collect();
            }
            found.push(structure.formula(functions, &short.values, short.factor.as_ref()));
        }
    }
    found
}

/// The candidates of which none is longer than one with a smaller error. Errors below the least claim
/// count as that: none of them can be proved to be smaller than another.
fn best(mut found: Vec<Candidate>) -> Vec<Candidate> {
    /// A function in another form errs alike to rounding, and is no gain.
    const GAIN: f64 = 1e-6;
    found.sort_by(|one, other| {
        let order = one.length.cmp(&other.length).then(one.error.total_cmp(&other.error));
        order.then_with(|| one.formula.to_string().cmp(&other.formula.to_string()))
    });
    let mut least = f64::INFINITY;
    found.retain(|candidate| {
        let error = candidate.error.max(LEAST_CLAIM);
        let is_better = error < (1.0 - GAIN) * least;
        least = least.min(error);
        is_better
    });
    found
}

/// The certificate of a law before it is proved; of the truth alone where there is none.
fn certificate(
    (problem, motions): (&LawProblem, MotionsOfLaw),
    quantity: LawQuantity,
    atoms: &[Atom],
    candidate: Option<&Candidate>,
) -> Result<LawCertificate, LawNotProved> {
    let law = match candidate {
        None => Expr::one(),
        Some(candidate) => {
            let no_value = |_| LawNotProved::NoValue(candidate.formula.to_string());
            let law = candidate.formula.expression().map_err(no_value)?;
            law.substitute_all(&meanings(atoms))?
        }
    };
    // The nearest double of an end may lie outside of the range.
    let worst = candidate.and_then(|candidate| from_f64(candidate.worst));
    let worst = worst.unwrap_or_else(|| problem.from.clone()).max(problem.from.clone());
    let worst = match &problem.to {
        Some(to) => worst.min(to.clone()),
        None => worst,
    };
    let bound = candidate
        .map_or_else(Rational::one, |candidate| rounded_error(candidate.error.max(LEAST_CLAIM)));
    Ok(LawCertificate {
        motions,
        variable: problem.variable,
        quantity,
        law,
        from: problem.from.clone(),
        to: problem.to.clone(),
        worst,
        claim: [Rational::zero(), bound],
    })
}

/// The names of quantities with their meanings in the variable.
fn meanings(atoms: &[Atom]) -> BTreeMap<Symbol, Expr> {
    atoms.iter().filter_map(|atom| Some((atom.name, atom.meaning.clone()?))).collect()
}

/// The proof of the largest error of a law.
fn proved(
    truth: &TrueFrequency,
    mut certificate: LawCertificate,
    supervision: Supervision,
) -> Result<(LawCertificate, LawError), LawNotProved> {
    /// Significant digits of the lower claim.
    const DIGITS: usize = 6;
    let upper = truth.largest_error(&certificate, supervision)?;
    let lower = truth.least_error(&certificate)?;
    let [below, _] = neighbours(&from_f64(lower).unwrap_or_else(Rational::zero), DIGITS);
    certificate.claim[0] = below;
    Ok((certificate, LawError { lower, upper }))
}
