//! The quantities of a claim: the names that formulas may use, and the program that computes them.
//!
//! In: a [`ClaimComputation`] and the values of an entry. Out: the result, or the reason why there
//! is none. The numbers have the same sources as in every other command: laws from
//! [`method::solve`](crate::method::solve), true frequencies from verification, phases and contacts
//! from [`impact`](crate::impact), rest times from its simulation.

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use super::claim::{ClaimComputation, ClaimEquation, ClaimQuantity};
use super::{identity, options};
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Monomial, Polynomial, Rational};
use crate::expr::{CompiledFunction, Expr, ExprError, Node};
use crate::impact::primary::{Primary, PrimaryCase, PrimarySettings, simulate_primary};
use crate::impact::{
    ContactSpeed, Form, Impact, ImpactProblem, Integrator, Model, PhaseReading, Settings, Setup,
    Start, ThreePhases, course, hertz, three_phases,
};
use crate::interrupt::Interrupt;
use crate::mechanics::Mechanism;
use crate::method::numbers::frequency_squared_of;
use crate::method::{Options, solve};
use crate::modes::{FreeSystem, ModeOptions, NonlinearMode, derive};
use crate::oscillator::Oscillator;
use crate::series::taylor::taylor;
use crate::solution::{Method, Solution};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::{DEFAULT_TOLERANCE, JudgedMode, judge_mode, judge_motion, needed_values};

/// The quantities that the program computes by name, in addition to the values in a file: the name,
/// its arguments, its meaning.
pub const NAMES: [(&str, &str, &str); 29] = [
    ("frequency", "equation, its parameters, A", "omega by the method"),
    ("true_frequency", "equation, its parameters, A", "omega of the true motion"),
    (
        "max_deviation",
        "equation, its parameters, A",
        "largest deviation of the motion over one true period, over |A|",
    ),
    ("paper_time_to_contact", "A, xc", "time from the release to the barrier, by one cosine"),
    ("paper_speed", "A, xc", "speed at the barrier, by one cosine"),
    ("paper_penetration", "A, xc, gamma", "greatest depth, by the fitted line"),
    ("paper_duration", "A, xc, gamma", "duration of the contact, by the fitted line"),
    (
        "paper_period",
        "A, xc, gamma",
        "period of the motion with its impact, by one cosine and the fitted line",
    ),
    ("paper_phase", "A, xc", "phase of the return, equation (16)"),
    ("paper_frequency", "A, xc", "omega of the approach"),
    (
        "paper_deviation",
        "A, xc, gamma",
        "largest deviation of these phases from the true motion, over |A|",
    ),
    ("energy_speed", "A, xc", "speed at the barrier by the energy, exact for the equation"),
    ("energy_penetration", "A, xc, gamma", "greatest depth by the fitted line with that speed"),
    ("energy_duration", "A, xc, gamma", "duration by the fitted line with that speed"),
    ("line_slope", "A, xc, gamma", "slope p of the line p*x - q, per unit of gamma"),
    ("line_constant", "A, xc, gamma", "constant q of that line"),
    ("line_depth", "A, xc, gamma", "depth over which it is fitted"),
    ("true_time_to_contact", "A, xc, gamma", "time to the barrier, by Runge-Kutta"),
    ("true_speed", "A, xc, gamma", "speed at the barrier, by Runge-Kutta"),
    ("true_penetration", "A, xc, gamma", "greatest depth, by Runge-Kutta"),
    ("true_duration", "A, xc, gamma", "duration of the contact, by Runge-Kutta"),
    ("true_period", "A, xc, gamma", "period with the impact, by Runge-Kutta"),
    ("hertz_factor", "", "duration times speed over depth of every Hertz contact"),
    ("rest_time", "A, xc, gamma, mu, zeta, alpha", "when the envelope crosses 10 %, by simulation"),
    ("rest_time_without_barrier", "A, zeta, alpha", "the same without a barrier"),
    (
        "primary_rest_time",
        "mass_ratio, kappa, delta, y0, xc, gamma, mu, zeta, alpha",
        "rest time of the main mass with pendulum and barrier, by simulation",
    ),
    ("primary_rest_time_locked", "mass_ratio, kappa, delta", "the same with the pendulum locked"),
    ("primary_rest_time_without", "mass_ratio, kappa, delta", "the same without the pendulum"),
    (
        "stall_generation",
        "window",
        "the first generation at which a stall over a window of generations can be seen",
    ),
];

/// The result of a computation.
#[derive(Clone, Debug, PartialEq)]
pub enum Computed {
    /// A number.
    Number(f64),
    /// A fraction.
    Exact(Rational),
    /// Zero, the coefficient of a term that the derived law does not contain.
    Absent,
    /// A formula.
    Formula(Expr),
    /// The rules that options break.
    Conflicts(Vec<String>),
}

impl Computed {
    /// The result as a number; `None` if it is not one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Exact(fraction) => Some(to_f64(fraction)),
            Self::Absent => Some(0.0),
            Self::Formula(_) | Self::Conflicts(_) => None,
        }
    }
}

/// The reason why a quantity is not computed.
#[derive(Clone, Debug, PartialEq)]
pub enum NotComputable {
    /// These values are missing.
    Missing(BTreeSet<String>),
    /// There is no such number, for this reason.
    Refused(String),
}

/// Computes one quantity, for any entry and any value of an unknown.
pub(super) struct Evaluator<'a> {
    question: &'a ClaimComputation,
    law: OnceCell<Result<DerivedLaw, String>>,
    swing: OnceCell<Result<(Oscillator, Solution), String>>,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(question: &'a ClaimComputation) -> Self {
        Self { question, law: OnceCell::new(), swing: OnceCell::new() }
    }

    /// Computes the quantity with the values of an entry, and of an unknown if one is tried.
    pub(super) fn compute(
        &self,
        entry: &BTreeMap<Symbol, Expr>,
        unknown: Option<(Symbol, f64)>,
    ) -> Result<Computed, NotComputable> {
        let question = self.question;
        let mut values = question.values.clone();
        values.extend(entry.iter().map(|(name, value)| (*name, value.clone())));
        match &question.quantity {
            ClaimQuantity::Value(formula) | ClaimQuantity::Trend(formula) => {
                let mut scope = EvaluationScope {
                    evaluator: self,
                    known: unknown.into_iter().collect(),
                    values,
                    open: vec![],
                    impact: None,
                };
                scope.formula(formula).map(Computed::Number)
            }
            ClaimQuantity::Coefficient { squared, term } => {
                let law = self.polynomial(*squared)?;
                let monomial = monomial(term).ok_or_else(|| {
                    NotComputable::Refused(format!("`{term}` is no product of powers"))
                })?;
                coefficient(&law, &monomial)
            }
            ClaimQuantity::Law { squared } => {
                Ok(Computed::Formula(Expr::from(&self.polynomial(*squared)?)))
            }
            ClaimQuantity::Taylor { formula, degree } => {
                let about = [(Symbol::new("x"), Rational::default())];
                let parts = taylor(formula, &about, *degree)
                    .map_err(|error| NotComputable::Refused(error.to_string()))?;
                Ok(Computed::Formula(Expr::sum(parts)))
            }
            ClaimQuantity::Identity(formula) => identity::with_definitions(formula, &values)
                .map(Computed::Formula)
                .map_err(NotComputable::Refused),
            ClaimQuantity::Motion { kinetic, potential, force } => {
                motion([kinetic, potential, force], &values)
                    .map(Computed::Formula)
                    .map_err(NotComputable::Refused)
            }
            ClaimQuantity::Coordinates(formula) => {
                let symbols = formula.symbols();
                let accelerations = symbols.iter().filter(|symbol| symbol.primes() == 2);
                Ok(Computed::Number(accelerations.count() as f64))
            }
            ClaimQuantity::Settings(settings) => {
                Ok(Computed::Conflicts(options::conflicts(settings)))
            }
            ClaimQuantity::Nothing => Err(NotComputable::Missing(BTreeSet::new())),
        }
    }

    /// The derived law.
    fn law(&self) -> Result<&DerivedLaw, NotComputable> {
        let Some(equation) = &self.question.equation else {
            return Err(missing("equation"));
        };
        let found = self.law.get_or_init(|| match equation {
            ClaimEquation::One(oscillator) => {
                let solution =
                    solve(oscillator, &self.question.options).map_err(|error| error.to_string())?;
                Ok(DerivedLaw::One(oscillator.clone(), Box::new(solution)))
            }
            ClaimEquation::Mode { system, number } => mode(system, *number, &self.question.options),
        });
        found.as_ref().map_err(|reason| NotComputable::Refused(reason.clone()))
    }

    /// omega or omega^2 as a polynomial.
    fn polynomial(&self, squared: bool) -> Result<Polynomial, NotComputable> {
        let law = self.law()?;
        let found = match (law, squared) {
            (DerivedLaw::One(_, solution), true) => solution.law.frequency_squared().cloned(),
            (DerivedLaw::One(_, solution), false) => solution.law.frequency().cloned(),
            (DerivedLaw::Mode(_, mode), true) => written_out(mode),
            (DerivedLaw::Mode(..), false) => None,
        };
        found.ok_or_else(|| {
            let name = if squared { "omega^2" } else { "omega" };
            NotComputable::Refused(format!("{} gives no polynomial for {name}", law.title()))
        })
    }

    /// The swing of an impact, the pendulum if no equation is given, and its law, of order 2 if
    /// none is given.
    fn swing(&self) -> Result<&(Oscillator, Solution), NotComputable> {
        let found = self.swing.get_or_init(|| {
            let words = |error: &dyn std::error::Error| error.to_string();
            let equation = match &self.question.equation {
                Some(ClaimEquation::One(oscillator)) => oscillator.clone(),
                Some(ClaimEquation::Mode { .. }) => {
                    return Err("an impact is of one coordinate".to_owned());
                }
                None => Oscillator::parse("x'' + sin(x) = 0").map_err(|error| words(&error))?,
            };
            let mut options = self.question.options.clone();
            if options.method.is_none() {
                options.order = options.order.or(Some(2));
            }
            let solution = solve(&equation, &options).map_err(|error| words(&error))?;
            Ok((equation, solution))
        });
        found.as_ref().map_err(|reason| NotComputable::Refused(reason.clone()))
    }
}

/// A derived law.
enum DerivedLaw {
    /// The law of one coordinate.
    One(Oscillator, Box<Solution>),
    /// The law of a mode of coupled equations.
    Mode(Box<FreeSystem>, Box<NonlinearMode>),
}

impl DerivedLaw {
    /// The method and its order in words.
    fn title(&self) -> String {
        match self {
            Self::One(_, solution) => solution.title(),
            Self::Mode(_, mode) => format!("mode {} to order {}", mode.number, mode.order),
        }
    }
}

/// A mode of coupled equations by these options.
fn mode(system: &FreeSystem, number: usize, options: &Options) -> Result<DerivedLaw, String> {
    let usual = ModeOptions::default();
    let method = options.method.unwrap_or(Method::LindstedtPoincare);
    if method != Method::LindstedtPoincare || options.small.is_some() || options.taylor.is_some() {
        return Err(format!(
            "the law of a mode is an expansion in its amplitude by {}",
            Method::LindstedtPoincare.name()
        ));
    }
    let options = ModeOptions {
        mode: Some(number),
        order: options.order,
        amplitude: options.amplitude.unwrap_or(usual.amplitude),
        ..usual
    };
    let found = derive(system, &options).map_err(|error| error.to_string())?;
    let mode = found.modes.into_iter().next();
    let mode = mode.ok_or("there is no such mode")?.map_err(|error| error.to_string())?;
    Ok(DerivedLaw::Mode(Box::new(found.system), Box::new(mode)))
}

/// omega^2 of a mode in the letters of the equations; `None` if a definition is no polynomial.
fn written_out(mode: &NonlinearMode) -> Option<Polynomial> {
    let mut law = Expr::from(&mode.frequency_squared);
    for definition in mode.definitions.iter().rev() {
        law = law.substitute(definition.symbol, &definition.meaning).ok()?;
    }
    law.expand().ok()?.to_polynomial(&mut |_| None).ok()?
}

fn missing(name: &str) -> NotComputable {
    NotComputable::Missing(BTreeSet::from([name.to_owned()]))
}

fn refused(error: &impl std::fmt::Display) -> NotComputable {
    NotComputable::Refused(error.to_string())
}

/// A product of powers as a monomial.
fn monomial(term: &Expr) -> Option<Monomial> {
    let polynomial = term.to_polynomial(&mut |_| None).ok()??;
    let (monomial, number) = polynomial.single_term()?;
    num_traits::One::is_one(number).then(|| monomial.clone())
}

/// The coefficient of a product of powers in a derived law.
///
/// # Errors
/// A symbol that does not occur in the law, or a power of it beyond the last one that was derived.
fn coefficient(law: &Polynomial, wanted: &Monomial) -> Result<Computed, NotComputable> {
    if law.terms().any(|(monomial, _)| monomial == wanted) {
        return Ok(Computed::Exact(law.coefficient(wanted)));
    }
    for &(letter, power) in wanted.factors() {
        let powers = law.terms().map(|(monomial, _)| monomial.exponent(letter));
        let [least, greatest] =
            powers.fold([0, 0], |[least, greatest], one| [least.min(one), greatest.max(one)]);
        if [least, greatest] == [0, 0] {
            return Err(NotComputable::Refused(format!(
                "`{letter}` does not occur in the derived law `{}`",
                Expr::from(law)
            )));
        }
        if power > greatest {
            return Err(NotComputable::Refused(format!(
                "the derived law `{}` ends before the power {power} of `{letter}`: ask for a higher `order`",
                Expr::from(law)
            )));
        }
    }
    Ok(Computed::Absent)
}

/// The names of one evaluation and their values.
struct EvaluationScope<'a, 'b> {
    evaluator: &'b Evaluator<'a>,
    values: BTreeMap<Symbol, Expr>,
    known: BTreeMap<Symbol, f64>,
    /// The names under evaluation, to detect circular definitions.
    open: Vec<Symbol>,
    impact: Option<Box<Impact>>,
}

impl EvaluationScope<'_, '_> {
    /// The value of a formula.
    fn formula(&mut self, formula: &Expr) -> Result<f64, NotComputable> {
        let formula = match &self.evaluator.question.pi {
            Some(pi) => with_pi(formula, pi).map_err(|error| refused(&error))?,
            None => formula.clone(),
        };
        let symbols: Vec<Symbol> = formula.symbols().into_iter().collect();
        let numbers = self.all(&symbols)?;
        formula.evaluate(&numbers).map_err(|error| refused(&error))
    }

    /// The values of these names; the error lists all that are missing.
    fn all(&mut self, names: &[Symbol]) -> Result<BTreeMap<Symbol, f64>, NotComputable> {
        let (mut found, mut lacking) = (BTreeMap::new(), BTreeSet::new());
        for name in names {
            match self.value(*name) {
                Ok(value) => {
                    found.insert(*name, value);
                }
                Err(NotComputable::Missing(names)) => lacking.extend(names),
                Err(reason) => return Err(reason),
            }
        }
        match lacking.is_empty() {
            true => Ok(found),
            false => Err(NotComputable::Missing(lacking)),
        }
    }

    fn numbers<const N: usize>(&mut self, names: [&str; N]) -> Result<[f64; N], NotComputable> {
        let names = names.map(Symbol::new);
        let found = self.all(&names)?;
        Ok(names.map(|name| found.get(&name).copied().unwrap_or(f64::NAN)))
    }

    fn value(&mut self, name: Symbol) -> Result<f64, NotComputable> {
        if let Some(value) = self.known.get(&name) {
            return Ok(*value);
        }
        let value = match self.values.get(&name).cloned() {
            Some(_) if self.open.contains(&name) => {
                return Err(NotComputable::Refused(format!("`{name}` is defined by itself")));
            }
            Some(formula) => {
                self.open.push(name);
                let value = self.formula(&formula);
                self.open.pop();
                value?
            }
            None => self.computed(name.name())?,
        };
        self.known.insert(name, value);
        Ok(value)
    }

    /// Computes the quantity of this name.
    fn computed(&mut self, name: &str) -> Result<f64, NotComputable> {
        match name {
            "frequency" => self.frequency(),
            "true_frequency" => Ok(self.true_frequency_and_deviation()?.0),
            "max_deviation" => self
                .true_frequency_and_deviation()?
                .1
                .ok_or_else(|| NotComputable::Refused("the formula has no motion".to_owned())),
            "hertz_factor" => Ok(hertz::duration_factor()),
            "rest_time" => self.rest_time(true),
            "rest_time_without_barrier" => self.rest_time(false),
            "primary_rest_time" => self.primary_rest_time(),
            "primary_rest_time_locked" | "primary_rest_time_without" => {
                let others = self.primary()?.undamped_and_locked();
                let alone = match name {
                    "primary_rest_time_locked" => others.locked,
                    _ => others.without,
                };
                alone.rest_time.ok_or_else(|| {
                    NotComputable::Refused("the main mass alone never rests".to_owned())
                })
            }
            // The best value of so many generations ago is needed as well as the present one.
            "stall_generation" => {
                let [window] = self.numbers(["window"])?;
                Ok(window + 1.0)
            }
            "paper_deviation" => {
                let impact = self.impact()?;
                let column = impact.column(PhaseReading::Paper);
                let column = column.ok_or_else(|| {
                    NotComputable::Refused(impact.no_paper.clone().unwrap_or_default())
                })?;
                Ok(column.deviation.total / impact.amplitude())
            }
            "energy_speed" | "energy_penetration" | "energy_duration" => {
                let phases = self.phases(name, ContactSpeed::Energy)?;
                Ok(of_phases(name, &phases).unwrap_or(f64::NAN))
            }
            "line_slope" | "line_constant" | "line_depth" => {
                let phases = self.phases(name, ContactSpeed::Paper)?;
                let [barrier] = self.numbers(["xc"])?;
                let fitted = phases
                    .fitted
                    .ok_or_else(|| NotComputable::Refused("there is no line".to_owned()))?;
                Ok(match name {
                    "line_slope" => fitted.line.slope,
                    "line_constant" => fitted.line.q(barrier),
                    _ => fitted.depth,
                })
            }
            _ if name.starts_with("paper_") && is_a_name(name) => {
                let phases = self.phases(name, ContactSpeed::Paper)?;
                of_phases(name, &phases)
                    .ok_or_else(|| NotComputable::Refused("the approach is no cosine".to_owned()))
            }
            _ if name.starts_with("true_") && is_a_name(name) => {
                let numbers = self.impact()?.truth.quantities();
                let place = QUANTITIES_OF_AN_IMPACT.iter().position(|known| name.ends_with(known));
                Ok(place.map_or(f64::NAN, |place| numbers[place]))
            }
            _ => Err(missing(name)),
        }
    }

    fn frequency(&mut self) -> Result<f64, NotComputable> {
        let (equation, solution) = match self.evaluator.law()? {
            DerivedLaw::One(equation, solution) => (equation, solution),
            law @ DerivedLaw::Mode(..) => {
                let no_frequency =
                    || NotComputable::Refused(format!("{} gives no frequency here", law.title()));
                return self.judged_mode()?.frequency.ok_or_else(no_frequency);
            }
        };
        let numbers = self.all(&needed_values(solution))?;
        let square =
            frequency_squared_of(equation, solution, &numbers).map_err(|error| refused(&error))?;
        match square > 0.0 {
            true => Ok(square.sqrt()),
            false => Err(NotComputable::Refused(format!(
                "omega^2 = {} by {}, which is no frequency",
                crate::decimal::decimal(square),
                solution.title()
            ))),
        }
    }

    /// The frequency of the true motion, and the largest deviation of the formula from it.
    fn true_frequency_and_deviation(&mut self) -> Result<(f64, Option<f64>), NotComputable> {
        let DerivedLaw::One(equation, solution) = self.evaluator.law()? else {
            let judged = self.judged_mode()?;
            return Ok((judged.true_frequency, Some(judged.max_deviation)));
        };
        let numbers = self.all(&needed_values(solution))?;
        let judged = judge_motion(equation, solution, &exact(&numbers)?, DEFAULT_TOLERANCE);
        let judged = judged.map_err(|error| refused(&error))?;
        Ok((judged.true_frequency, judged.max_deviation))
    }

    /// The verdict on a mode at the values.
    fn judged_mode(&mut self) -> Result<JudgedMode, NotComputable> {
        let DerivedLaw::Mode(system, mode) = self.evaluator.law()? else {
            return Err(missing("mode"));
        };
        let needed: Vec<Symbol> = std::iter::once(mode.amplitude.symbol())
            .chain(system.equations.parameters.iter().copied())
            .collect();
        let at = exact(&self.all(&needed)?)?;
        judge_mode(system, mode, &at, DEFAULT_TOLERANCE, Interrupt::default())
            .map_err(|error| refused(&error))
    }

    /// The three phases of an impact with a line for the barrier.
    fn phases(&mut self, name: &str, speed: ContactSpeed) -> Result<ThreePhases, NotComputable> {
        let (equation, law) = self.evaluator.swing()?;
        // The stiffness of the barrier does not matter for the motion before the impact.
        let hits = NAMES.iter().any(|(known, needs, _)| *known == name && needs.contains("gamma"));
        let needed: Vec<Symbol> = ["A", "xc", "gamma"][..if hits { 3 } else { 2 }]
            .iter()
            .map(|name| Symbol::new(name))
            .chain(equation.parameters.iter().copied())
            .collect();
        let numbers = self.all(&needed)?;
        let number = |name: &str| numbers.get(&Symbol::new(name)).copied().unwrap_or(f64::NAN);
        let square =
            frequency_squared_of(equation, law, &numbers).map_err(|error| refused(&error))?;
        let compiled = |expr: &Expr| {
            CompiledFunction::new(expr, &arguments(equation)).map_err(|error| refused(&error))
        };
        let slope =
            equation.force.differentiate(equation.coordinate).map_err(|error| refused(&error))?;
        let (force, slope) = (compiled(&equation.force)?, compiled(&slope)?);
        // The speed of contact takes thousands of values of the force: only the position changes.
        let others = equation.parameters.iter().map(|name| number(name.name()));
        let values = RefCell::new(std::iter::once(0.0).chain(others).collect::<Vec<f64>>());
        let call = |function: &CompiledFunction, x: f64| {
            let mut values = values.borrow_mut();
            values[0] = x;
            function.call(&values)
        };
        let swing = ImpactProblem {
            amplitude: number("A"),
            barrier: number("xc"),
            stiffness: if hits { number("gamma") } else { hertz::DEFAULT_STIFFNESS },
            frequency_squared: square,
            linear_stiffness: call(&slope, 0.0),
            restoring_force: &|x| call(&force, x),
            elastic_force: &hertz::elastic_force,
            rule: self.evaluator.question.rule,
        };
        three_phases(&swing, speed).map_err(|error| refused(&error))
    }

    /// The impact with its true motion.
    fn impact(&mut self) -> Result<&Impact, NotComputable> {
        if self.impact.is_none() {
            let [amplitude, barrier, stiffness] = self.numbers(["A", "xc", "gamma"])?;
            let question = self.evaluator.question;
            let swing = match &question.equation {
                Some(ClaimEquation::One(oscillator)) => Some(oscillator.clone()),
                Some(ClaimEquation::Mode { .. }) => {
                    return Err(refused(&"an impact is of one coordinate"));
                }
                None => None,
            };
            let parameters = swing.as_ref().map_or(vec![], |swing| swing.parameters.clone());
            let values = exact(&self.all(&parameters)?)?;
            let setup = Setup {
                swing,
                values,
                release: -amplitude,
                barrier,
                stiffness,
                rule: question.rule,
                ..Setup::default()
            };
            let found = crate::impact::solve(setup).map_err(|error| refused(&error))?;
            self.impact = Some(Box::new(found));
        }
        self.impact
            .as_deref()
            .ok_or_else(|| NotComputable::Refused("there is no impact".to_owned()))
    }

    /// A main mass without a drive.
    fn primary(&mut self) -> Result<Primary, NotComputable> {
        let [mass, stiffness, damping] = self.numbers(["mass_ratio", "kappa", "delta"])?;
        Ok(Primary { mass, stiffness, damping, force: 0.0, frequency: 0.0 })
    }

    fn primary_rest_time(&mut self) -> Result<f64, NotComputable> {
        let names = ["mass_ratio", "kappa", "delta", "y0", "xc", "gamma", "mu", "zeta", "alpha"];
        let [_, _, _, displacement, barrier, gamma, mu, zeta, alpha] = self.numbers(names)?;
        let model = Model { zeta, alpha, gamma, mu, right: Some(barrier), ..Model::default() };
        let case =
            PrimaryCase { primary: self.primary()?, model, start: [0.0, 0.0, displacement, 0.0] };
        let settings =
            PrimarySettings { duration: LONGEST_OF_A_MAIN_MASS, ..PrimarySettings::default() };
        let motion = simulate_primary(case, &settings).map_err(|error| refused(&error))?;
        motion.rest_time().map_err(|reason| refused(&reason))
    }

    fn rest_time(&mut self, with_barrier: bool) -> Result<f64, NotComputable> {
        let barrier = match with_barrier {
            true => Some(self.numbers(["xc", "gamma", "mu", "A", "zeta", "alpha"])?),
            false => None,
        };
        let [amplitude, zeta, alpha] = self.numbers(["A", "zeta", "alpha"])?;
        let usual = Model::default();
        let model = Model {
            zeta,
            alpha,
            gamma: barrier.map_or(usual.gamma, |numbers| numbers[1]),
            mu: barrier.map_or(0.0, |numbers| numbers[2]),
            right: barrier.map(|numbers| numbers[0]),
            ..usual
        };
        let start = Start { x: -amplitude, velocity: 0.0 };
        let settings = Settings { duration: LONGEST, stop_at_rest: true, ..Settings::default() };
        let found = course(&model, start, Integrator::Taylor, &settings)
            .map_err(|error| refused(&error))?;
        found.rest_time.map_err(|reason| refused(&reason))
    }
}

/// The equation of motion of x that follows from these energies and this force, divided by the
/// coefficient of x''.
fn motion(parts: [&Expr; 3], definitions: &BTreeMap<Symbol, Expr>) -> Result<Expr, String> {
    let [kinetic, potential, force] =
        parts.map(|part| identity::with_definitions(part, definitions));
    let x = Symbol::new("x");
    let mechanism = Mechanism {
        coordinates: vec![x],
        kinetic: kinetic?,
        potential: potential?,
        dissipation: Expr::zero(),
        forces: BTreeMap::from([(x, force?)]),
    };
    let equations = mechanism.equations().map_err(|error| error.to_string())?;
    let words = |error: ExprError| error.to_string();
    let left = &equations.left[0];
    let inertia = left.differentiate(x.derivative().derivative()).map_err(words)?;
    Expr::divide(left, &inertia).and_then(|left| left.expand()).map_err(words)
}

/// The longest time for which a motion is followed to its rest, in units of 1/omega.
const LONGEST: f64 = 2000.0;

/// The longest time for which a main mass is followed.
const LONGEST_OF_A_MAIN_MASS: f64 = 1000.0;

/// The numbers of an impact in the order of [`ThreePhases::quantities`].
const QUANTITIES_OF_AN_IMPACT: [&str; 5] =
    ["_time_to_contact", "_speed", "_penetration", "_duration", "_period"];

/// Whether the program computes a quantity of this name.
pub(super) fn is_a_name(name: &str) -> bool {
    NAMES.iter().any(|(known, ..)| *known == name)
}

fn of_phases(name: &str, phases: &ThreePhases) -> Option<f64> {
    let cosine = |index: usize| match phases.phases[index].form {
        Form::Cosine { frequency, phase, .. } => Some((frequency, phase)),
        _ => None,
    };
    match name {
        "paper_frequency" => Some(cosine(0)?.0),
        "paper_phase" => Some(cosine(2)?.1),
        _ => {
            let place = QUANTITIES_OF_AN_IMPACT.iter().position(|known| name.ends_with(known))?;
            Some(phases.quantities()[place])
        }
    }
}

fn arguments(equation: &Oscillator) -> Vec<Symbol> {
    std::iter::once(equation.coordinate).chain(equation.parameters.iter().copied()).collect()
}

/// Converts doubles to exact values.
fn exact(numbers: &BTreeMap<Symbol, f64>) -> Result<Values, NotComputable> {
    let mut values = Values::default();
    for (name, number) in numbers {
        let number = from_f64(*number)
            .ok_or_else(|| NotComputable::Refused(format!("`{name}` is no number")))?;
        values.insert(*name, Expr::number(number)).map_err(|error| refused(&error))?;
    }
    Ok(values)
}

/// A formula with this value in place of pi.
fn with_pi(formula: &Expr, pi: &Expr) -> Result<Expr, ExprError> {
    formula.fold(|node, children: &[Expr]| match node.node() {
        Node::Pi => Ok(pi.clone()),
        _ if children.is_empty() => Ok(node.clone()),
        _ => node.with_children(children),
    })
}
