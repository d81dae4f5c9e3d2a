//! The answer: a frequency relation and a motion, with everything needed to use them rightly.
//!
//! In come the parts that a method found: a [`Law`], a displacement as a Fourier series, [`Note`]s,
//! a derivation. Out go its values at numbers, its law in one line, its polynomials in the order of
//! printing. Nothing here knows how a method works or how a format looks.
//!
//! A formula without its amplitude convention, order and validity is half a formula, so all of them
//! travel together.

mod advice;
mod branch;
mod closed_root;
pub mod convergence;
mod degrees;
pub mod law;
mod linear_drive;
mod method;
pub mod modulation;
pub mod note;
mod plane;
mod polar;
pub mod response;
mod spurious;
mod sum;

use std::collections::BTreeSet;

use num_traits::{One, Signed};

pub use advice::{Advice, Setting};
pub use branch::Branch;
pub use convergence::Convergence;
pub use degrees::Degrees;
use law::DisplayedLaw;
pub use law::{AlgebraicSystem, ClosedForm, Law, Root};
pub use method::{Counts, Method};
pub use modulation::Modulation;
pub use note::Note;
pub use response::Response;
pub use sum::Sum;

pub use crate::derivation::{
    AmplitudeCondition, Condition, DerivationFormula, DerivationLine, Step,
};

use crate::decimal::{rounded_fraction, significant_fraction};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::Rational;
use crate::exact::scaled::Scaled;
use crate::exact::{Doubles, POLYNOMIALS, Polynomial, Polynomials};
use crate::expr::{Equation, Expr};
use crate::series::FourierSeries;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY, ResultSymbols};
use crate::symbol::{Symbol, fresh, phase_beside};

/// The definition of the amplitude in a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AmplitudeConvention {
    /// `A` = x(0) minus the equilibrium, with x'(0) = 0.
    Initial,
    /// `a` = amplitude of the first harmonic.
    FirstHarmonic,
}

impl AmplitudeConvention {
    /// The name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Initial => "initial",
            Self::FirstHarmonic => "first-harmonic",
        }
    }

    /// The other convention.
    pub fn other(self) -> Self {
        match self {
            Self::Initial => Self::FirstHarmonic,
            Self::FirstHarmonic => Self::Initial,
        }
    }

    /// The convention of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Initial, Self::FirstHarmonic]
            .into_iter()
            .find(|convention| convention.name() == name)
    }

    /// The symbol: `A` or `a`.
    pub fn symbol(self) -> Symbol {
        match self {
            Self::Initial => AMPLITUDE,
            Self::FirstHarmonic => FIRST_HARMONIC,
        }
    }

    /// The definition of the symbol for a motion of this coordinate:
    /// `A = x(0) - equilibrium, x'(0) = 0`.
    pub fn in_words(self, coordinate: Symbol) -> String {
        match self {
            Self::Initial => format!(
                "{AMPLITUDE} = {coordinate}(0) - equilibrium, {}(0) = 0",
                coordinate.derivative()
            ),
            Self::FirstHarmonic => format!("{FIRST_HARMONIC} = amplitude of the first harmonic"),
        }
    }
}

/// A symbol that the program introduced, and what it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// The symbol, for example `omega0`.
    pub symbol: Symbol,
    /// Its meaning, for example `sqrt(k)`.
    pub meaning: Expr,
}

/// Those of these definitions, each of which may use those before it, that a formula in these symbols
/// needs.
pub fn definitions_behind(
    definitions: &[Definition],
    mut symbols: BTreeSet<Symbol>,
) -> Vec<&Definition> {
    for definition in definitions.iter().rev() {
        if symbols.contains(&definition.symbol) {
            symbols.extend(definition.meaning.symbols());
        }
    }
    definitions.iter().filter(|entry| symbols.contains(&entry.symbol)).collect()
}

impl Definition {
    /// The meaning as it is printed.
    pub fn meaning_in_words(&self) -> String {
        constant_in_words(&self.meaning)
    }
}

/// The values of definitions, each of which may use those before it; one that `value_of` knows
/// already is not computed again.
///
/// # Errors
/// The first symbol without a value.
pub fn defined_values(
    definitions: &[Definition],
    value_of: &dyn Fn(Symbol) -> Option<f64>,
) -> Result<Vec<(Symbol, f64)>, Symbol> {
    let mut values: Vec<(Symbol, f64)> = Vec::new();
    for definition in definitions {
        if let Some(value) = value_of(definition.symbol) {
            values.push((definition.symbol, value));
            continue;
        }
        let known: Result<_, Symbol> = definition
            .meaning
            .symbols()
            .into_iter()
            .map(|symbol| {
                let defined =
                    values.iter().find(|(name, _)| *name == symbol).map(|(_, value)| *value);
                let value = defined.or_else(|| value_of(symbol)).ok_or(symbol)?;
                Ok((symbol, value))
            })
            .collect();
        let value = definition.meaning.evaluate(&known?).map_err(|_| definition.symbol)?;
        values.push((definition.symbol, value));
    }
    Ok(values)
}

/// A constant; a fraction of many digits, which is a rounded number, as a decimal, and a root of
/// rounded numbers with decimals under it.
pub fn constant_in_words(value: &Expr) -> String {
    match long_fraction(value) {
        Some(number) => significant_fraction(number, 15),
        None => value.with_number_under_root().as_ref().unwrap_or(value).to_string(),
    }
}

/// A number with more characters than this must be a rounded one.
const MANY: usize = 16;

/// The value of a constant that is a fraction of so many digits that it must be rounded; `None` for
/// any other.
pub fn long_fraction(value: &Expr) -> Option<&Rational> {
    value.as_number().filter(|number| !number.is_integer() && number.to_string().len() > MANY)
}

/// The limit cycle that a solution describes, among those of its equation.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCycle {
    /// The amplitude, in the convention of the solution; to leading order where the motion is left
    /// out.
    pub amplitude: Polynomial,
    /// Number of this cycle, counted from one.
    pub number: usize,
    /// All limit cycles of the equation that start from a harmonic motion, smallest first.
    pub cycles: Vec<LeadingCycle>,
    /// Parameters that are small together with the small parameter of the solution.
    pub small_with: Vec<Symbol>,
}

/// A limit cycle to leading order.
#[derive(Clone, Debug, PartialEq)]
pub struct LeadingCycle {
    /// Its amplitude where the small parameter vanishes.
    pub amplitude: Expr,
    /// An expression that is positive if the cycle attracts and negative if it repels; `None` at a
    /// multiple root of the equation for the amplitude, which does not decide.
    pub attracts_where: Option<Expr>,
}

impl LeadingCycle {
    /// Whether it attracts or repels, in words: `attracts for mu > 0 and repels for mu < 0`.
    pub fn stability(&self) -> String {
        match &self.attracts_where {
            None => "is at a multiple root: attracts on one side at most".to_owned(),
            Some(condition) => match condition.as_number() {
                Some(number) if number.is_positive() => "attracts".to_owned(),
                Some(_) => "repels".to_owned(),
                None => {
                    let negative = condition.has_leading_minus();
                    let scale = if negative { -condition } else { condition.clone() };
                    let (stable, unstable) = if negative { ('<', '>') } else { ('>', '<') };
                    format!("attracts for {scale} {stable} 0 and repels for {scale} {unstable} 0")
                }
            },
        }
    }
}

/// A closed-form approximation of a periodic motion.
///
/// The motion is `x(t) = displacement(theta)`, `theta = omega t`; all polynomials are in the
/// parameters of the equation, the amplitude symbol of the convention and the symbols of
/// `definitions`.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The equation as it was understood, `x'' + f = 0`.
    pub equation: Equation,
    /// The method of the derivation.
    pub method: Method,
    /// Highest power kept, inclusive, of the small parameter.
    pub order: u32,
    /// The degrees of an approximant.
    pub degrees: Option<Degrees>,
    /// The parameter in which the expansion runs; the amplitude symbol where it runs in the
    /// amplitude.
    pub small_parameter: Symbol,
    /// The definition of the amplitude symbol.
    pub amplitude: AmplitudeConvention,
    /// The parameters of the equation, in alphabetical order.
    pub parameters: Vec<Symbol>,
    /// Symbols introduced by the program.
    pub definitions: Vec<Definition>,
    /// The equilibrium about which the motion swings; `A` is measured from it.
    pub equilibrium: Expr,
    /// The law of frequency and amplitude.
    pub law: Law,
    /// The motion, equilibrium included.
    pub displacement: FourierSeries<Polynomials>,
    /// The motion from rest at `A` as an expression in `t`, equilibrium included, where it is known
    /// without a series.
    pub closed_motion: Option<Expr>,
    /// Self-excited oscillators: the cycle whose amplitude the equation itself determines.
    pub limit_cycle: Option<LimitCycle>,
    /// Motions that are not periodic: the slow equations of amplitude and phase.
    pub modulation: Option<Modulation>,
    /// Driven motions: the frequency-response equation and what follows from it.
    pub response: Option<Response>,
    /// Whether the coefficients are rounded to fifteen digits, because the equilibrium is not a
    /// fraction.
    pub numerical: bool,
    /// Notes on the validity of the formula.
    pub validity: Vec<Note>,
    /// Nearest singularity of the series of omega^2; `None` if it was not looked for.
    pub convergence: Option<Convergence>,
    /// The derivation, order by order, of an expansion.
    pub steps: Vec<Step>,
    /// Lines in front of the orders, or the derivation of any other method.
    pub derivation: Vec<DerivationLine>,
}

impl Solution {
    /// The value of a polynomial of this solution, with definitions worked out from the values of
    /// the parameters.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn evaluate(
        &self,
        polynomial: &Polynomial,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<f64, Symbol> {
        self.evaluate_with_size(polynomial, value_of).map(|(value, _)| value)
    }

    /// The value, and the sum of the sizes of its terms.
    fn evaluate_with_size(
        &self,
        polynomial: &Polynomial,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<(f64, f64), Symbol> {
        let values = match polynomial.symbols().iter().any(|symbol| self.defines(*symbol)) {
            true => self.defined_values(value_of)?,
            false => vec![],
        };
        let pi = Symbol::new("pi");
        polynomial.evaluate_with_size(|symbol| {
            let defined = values.iter().find(|(name, _)| *name == symbol).map(|(_, value)| *value);
            defined
                .or_else(|| value_of(symbol))
                .or_else(|| (symbol == pi).then_some(std::f64::consts::PI))
        })
    }

    /// The values of all definitions; one that `value_of` knows already is not computed again.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn defined_values(
        &self,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<Vec<(Symbol, f64)>, Symbol> {
        defined_values(&self.definitions, value_of)
    }

    /// The motion from rest at `x = A` as a function of time, where it is known as that.
    pub fn in_time(&self) -> Option<&Expr> {
        let response = self.response.as_ref().filter(|_| self.modulation.is_none());
        response.map(|response| &response.motion)
    }

    /// The slow equations if the amplitude of the motion changes; `None` for a periodic motion.
    pub fn slow(&self) -> Option<&Modulation> {
        let slow = self.modulation.as_ref();
        let free =
            slow.filter(|modulation| !modulation.is_conservative() && modulation.release.is_some());
        free.filter(|_| self.limit_cycle.is_none())
    }

    /// The law that only numbers solve, in one line.
    pub fn by_numbers(&self) -> Option<String> {
        let lines: Vec<String> = self.law.quadrature()?.iter().map(ToString::to_string).collect();
        Some(lines.join("; "))
    }

    /// The letter of the coordinate: what carries the primes in the equation.
    pub fn coordinate(&self) -> Symbol {
        self.equation.coordinate
    }

    /// The small parameter, and those that are small together with it.
    pub fn small_parameters(&self) -> impl Iterator<Item = Symbol> + '_ {
        let of_cycle = self.limit_cycle.iter().flat_map(|cycle| &cycle.small_with);
        let of_modulation = self.modulation.iter().flat_map(|modulation| &modulation.small_with);
        let others = of_cycle.chain(of_modulation.filter(|_| self.limit_cycle.is_none()));
        std::iter::once(self.small_parameter).chain(others.copied())
    }

    /// The power of the small parameters in a term.
    pub fn order_of(&self, monomial: &Monomial) -> i32 {
        self.small_parameters().map(|name| monomial.exponent(name)).sum()
    }

    /// The terms of a polynomial without small parameters.
    pub fn leading(&self, polynomial: &Polynomial) -> Polynomial {
        self.small_parameters().fold(polynomial.clone(), |rest, name| rest.truncated(name, 0))
    }

    /// The names that mean something in this answer already: parameters, coordinate, definitions,
    /// `t`. What a report introduces is named by [`fresh`] beside them.
    pub fn names(&self) -> Vec<Symbol> {
        let defined = self.definitions.iter().map(|definition| definition.symbol);
        let letters = self.letters();
        let letters = letters.renamed().map(|(_, written)| written);
        self.names_of_equation().chain(defined).chain(letters).collect()
    }

    fn names_of_equation(&self) -> impl Iterator<Item = Symbol> {
        let own = ["t".into(), self.coordinate()];
        self.parameters.iter().copied().chain(own)
    }

    /// The letters of amplitude and frequency: those in force on this thread, else the ones that
    /// the equation leaves free. They are how the symbols of this answer print while they are
    /// [in force](ResultSymbols::in_force).
    pub fn letters(&self) -> ResultSymbols {
        ResultSymbols::current().unwrap_or_else(|| {
            let own: Vec<Symbol> = self.names_of_equation().collect();
            ResultSymbols::avoiding(&own, self.equation.left.contains(Symbol::new("t")))
        })
    }

    /// The name of the phase of the motion: `theta`, unless the equation has that name.
    pub fn phase(&self) -> Symbol {
        phase_beside(&self.names())
    }

    /// The name of the linear frequency: `omega0`, unless the equation uses that for something
    /// else.
    pub fn linear_frequency_name(&self) -> Symbol {
        let own = self.definitions.iter().map(|definition| definition.symbol);
        let mut own = own.filter(|symbol| symbol.name().trim_end_matches('_') == "omega0");
        let omega0 = Symbol::new("omega0");
        let square = Polynomial::term(Monomial::power_of(omega0, 2), One::one());
        let squared = self.law.frequency_squared().or(self.law.relation());
        let at_rest = squared.map(|law| self.leading(law).truncated(self.amplitude.symbol(), 0));
        match own.next() {
            Some(symbol) => symbol,
            None if at_rest.is_some_and(|law| law == square) => omega0,
            None => fresh("omega0", &self.names()),
        }
    }

    fn defines(&self, symbol: Symbol) -> bool {
        self.definitions.iter().any(|definition| definition.symbol == symbol)
    }

    /// Rounds every coefficient to fifteen digits and says so.
    pub fn round_coefficients(&mut self) {
        let round = |number: &Rational| rounded_fraction(number, 15);
        let rounded = |polynomial: &Polynomial| polynomial.map(round);
        // In expressions only the long numbers are rounded: an exponent of 1/3 is exact.
        let round_long = |number: &Rational| match number.to_string().len() > MANY {
            true => round(number),
            false => number.clone(),
        };
        self.law = self.law.map(rounded).with_numbers(&round_long);
        for definition in &mut self.definitions {
            if let Ok(meaning) = definition.meaning.with_numbers(&round_long) {
                definition.meaning = meaning;
            }
        }
        self.derivation =
            self.derivation.iter().map(|line| line.with_numbers(&round_long)).collect();
        if let Some(cycle) = &mut self.limit_cycle {
            cycle.amplitude = rounded(&cycle.amplitude);
        }
        self.displacement =
            self.displacement.map(POLYNOMIALS, |coefficient, _| rounded(coefficient));
        if let Some(slow) = &mut self.modulation {
            slow.round(&round);
            let motion = slow.motion.take();
            slow.motion =
                motion.map(|motion| motion.map(POLYNOMIALS, |coefficient, _| rounded(coefficient)));
            // Formulas in rounded numbers of many digits say less than the slow equations
            // themselves.
            if let (Some(_), Some(release)) = (slow.transient.take(), &mut slow.release) {
                for part in [&mut release.amplitude, &mut release.phase] {
                    let named = self
                        .definitions
                        .iter()
                        .position(|own| Some(own.symbol) == part.as_symbol());
                    if let Some(place) = named {
                        *part = self.definitions.remove(place).meaning;
                    }
                }
            }
        }
        for step in &mut self.steps {
            if let Some(condition) = &mut step.amplitude {
                condition.sine = rounded(&condition.sine);
            }
            step.resonance = rounded(&step.resonance);
            step.correction = rounded(&step.correction);
            step.displacement =
                step.displacement.map(POLYNOMIALS, |coefficient, _| rounded(coefficient));
        }
        self.numerical = true;
        self.validity.push(Note::RoundedCoefficients);
    }

    /// The meaning of the order in words: `to order 4 in A`, `3 harmonics`; empty for methods of
    /// one order.
    pub fn order_in_words(&self) -> String {
        let order = self.order;
        match self.method.counts() {
            Counts::Degrees(_) => self.degrees.unwrap_or(Degrees::Quotient(order, 0)).to_string(),
            Counts::Powers => {
                let names: Vec<&str> = self.small_parameters().map(Symbol::written).collect();
                format!("to order {order} in {}", names.join(" and "))
            }
            Counts::PowersOfBookkeeping => {
                format!("to order {order} in {}", fresh("p", &self.names()))
            }
            Counts::Passes if order == 1 => "after one pass".to_owned(),
            Counts::Passes => format!("after {order} passes"),
            Counts::Harmonics if order == 1 => "with one harmonic".to_owned(),
            Counts::Harmonics | Counts::Corrections => format!("of order {order}"),
            Counts::Nothing => String::new(),
        }
    }

    /// The name of the method and its order.
    pub fn title(&self) -> String {
        if self.method == Method::Exact && (self.slow().is_some() || self.in_time().is_some()) {
            return "Exact motion".to_owned();
        }
        format!("{} {}", self.method.title(), self.order_in_words()).trim_end().to_owned()
    }

    /// The law in one line, with the definitions it needs.
    pub fn formula(&self) -> String {
        let _letters = self.letters().in_force();
        if let Some(slow) = self.slow() {
            let [amplitude, phase] = [slow.amplitude, slow.phase].map(Symbol::derivative);
            let rates = [&slow.amplitude_rate, &slow.phase_rate];
            let symbols = rates.into_iter().flat_map(Expr::symbols).collect();
            let definitions = self.definitions_behind(symbols).into_iter();
            let definitions = definitions.map(|definition| {
                format!(", {} = {}", definition.symbol, definition.meaning_in_words())
            });
            let law = format!("{amplitude} = {}, {phase} = {}", rates[0], rates[1]);
            return std::iter::once(law).chain(definitions).collect();
        }
        let shown = self.law.in_one_line();
        let law = match shown {
            DisplayedLaw::Squared(law) => format!("{FREQUENCY}^2 = {}", self.ordered(law)),
            DisplayedLaw::Frequency(law) => format!("{FREQUENCY} = {}", self.ordered(law)),
            DisplayedLaw::Relation(relation) => format!("0 = {}", self.ordered(relation)),
            DisplayedLaw::Closed(form) if self.numerical => {
                format!("{} in closed form, with rounded coefficients", form.name())
            }
            DisplayedLaw::Closed(form) => form.to_string(),
            DisplayedLaw::Quadrature(_) | DisplayedLaw::System(_)
                if self.method.counts() == Counts::Harmonics =>
            {
                let harmonics = self.balanced_harmonics();
                let kept: Vec<String> = harmonics.iter().map(|entry| entry.0.to_string()).collect();
                format!("harmonics {} balanced, solved by numbers", kept.join(", "))
            }
            DisplayedLaw::Quadrature(_) | DisplayedLaw::System(_) => {
                self.by_numbers().unwrap_or_default()
            }
        };
        let definitions = self.definitions_of_formula().into_iter();
        let definitions = definitions.map(|definition| {
            format!(", {} = {}", definition.symbol, definition.meaning_in_words())
        });
        std::iter::once(law).chain(definitions).collect()
    }

    /// The definitions of the law in one line: empty if words stand for it.
    pub fn definitions_of_formula(&self) -> Vec<&Definition> {
        let shown = self.law.in_one_line();
        match shown {
            DisplayedLaw::Closed(_) if self.numerical => vec![],
            DisplayedLaw::Quadrature(_) | DisplayedLaw::System(_)
                if self.method.counts() == Counts::Harmonics =>
            {
                vec![]
            }
            _ => self.definitions_behind(shown.symbols()),
        }
    }

    /// The definitions that a formula in these symbols needs, those that they are made of included.
    pub fn definitions_behind(&self, symbols: BTreeSet<Symbol>) -> Vec<&Definition> {
        definitions_behind(&self.definitions, symbols)
    }

    /// A polynomial of this solution, the terms with the lowest power of the small parameters
    /// first.
    pub fn ordered(&self, polynomial: &Polynomial) -> Sum {
        Sum::new(polynomial, self.numerical, |monomial| self.order_of(monomial))
    }

    /// A relation of this solution, the terms with the highest power of omega first.
    pub fn by_falling_frequency(&self, relation: &Polynomial) -> Sum {
        let omega = Symbol::new("omega");
        Sum::new(relation, self.numerical, |monomial| -monomial.exponent(omega))
    }

    /// omega^2 at given values: of the law where it is explicit, else the root of the relation that
    /// continues omega0^2 from amplitude zero or, about an unstable equilibrium, that of the first
    /// order; `None` if a value is missing or the branch ends before.
    pub fn frequency_squared_at(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<f64> {
        if let Some(law) = self.law.frequency_squared() {
            return self.evaluate(law, value_of).ok();
        }
        if self.law.relation().is_some() {
            return match self.branch_at(value_of)? {
                Branch::At { squared, .. } => Some(squared),
                Branch::Ends(_) | Branch::NoneOfFirstOrder => None,
            };
        }
        if let Some(form) = self.law.closed_form() {
            let value = self.evaluate_expression(&form.value, value_of)?;
            return Some(if form.squared { value } else { value * value.abs() });
        }
        let frequency = self.evaluate(self.law.frequency()?, value_of).ok()?;
        Some(frequency * frequency.abs())
    }

    /// The value of an expression in the parameters, the amplitude and the definitions; `None` if
    /// it has none.
    fn evaluate_expression(
        &self,
        expression: &Expr,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<f64> {
        let value = |symbol: Symbol| {
            let value = self.evaluate(&Polynomial::symbol(symbol), value_of).ok()?;
            Some((symbol, value))
        };
        let values = expression.symbols().into_iter().map(value).collect::<Option<_>>()?;
        expression.evaluate(&values).ok()
    }

    /// The branch of the relation that starts at the linear frequency or, about an unstable
    /// equilibrium, at the first order, at given values; `None` if there is no relation, a value is
    /// missing, or the branch has no start.
    pub fn branch_at(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<Branch> {
        let relation = self.law.relation()?;
        let (omega, amplitude) = (Symbol::new("omega"), self.amplitude.symbol());
        let mut sizes: Vec<(Symbol, Scaled)> = Vec::new();
        for symbol in relation.symbols() {
            if symbol != omega && symbol != amplitude {
                let value = self.evaluate(&Polynomial::symbol(symbol), value_of).ok()?;
                sizes.push((symbol, Scaled::new(value)));
            }
        }
        let term = |(monomial, number): (&Monomial, &Rational)| {
            let mut coefficient = Scaled::of_fraction(number);
            for (symbol, size) in &sizes {
                coefficient = coefficient.product(size.power(monomial.exponent(*symbol)));
            }
            branch::BranchTerm {
                coefficient,
                amplitude: monomial.exponent(amplitude),
                frequency: monomial.exponent(omega) / 2,
            }
        };
        let terms: Vec<branch::BranchTerm> = relation.terms().map(term).collect();
        branch::follow(&terms, value_of(amplitude).unwrap_or(0.0), self.precision())
    }

    /// The closed root of the relation, where that is the branch from rest wherever it is real and
    /// positive.
    pub fn closed_branch(&self) -> Option<&ClosedForm> {
        let relation = self.law.relation()?;
        let form = self.law.closed_form()?;
        closed_root::is_the_branch(relation, self.amplitude.symbol()).then_some(form)
    }

    /// Relative rounding error of the coefficients: of fifteen digits, or of a double.
    fn precision(&self) -> f64 {
        if self.numerical { 5e-15 } else { f64::EPSILON }
    }

    /// Bound of the relative change of omega^2 by rounding of the coefficients, if the law is a
    /// polynomial: its terms cancel far outside of its range. `None` if a value is missing.
    pub fn rounding_at(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<f64> {
        let (law, power) = match (self.law.frequency_squared(), self.law.frequency()) {
            (Some(law), _) => (law, 1.0),
            (None, law) => (law?, 2.0),
        };
        let (value, size) = self.evaluate_with_size(law, value_of).ok()?;
        Some(power * self.precision() * size / value.abs())
    }

    /// Bound of the change of the deviation from the equilibrium by rounding of the coefficients,
    /// over the amplitude: the terms of its harmonics cancel far outside of its range. `None` if a
    /// value is missing, or the amplitude is zero.
    pub fn rounding_of_motion_at(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<f64> {
        let amplitude = value_of(self.amplitude.symbol()).filter(|amplitude| *amplitude != 0.0)?;
        let harmonics = self.displacement.harmonics();
        let swing = harmonics.iter().filter(|(harmonic, ..)| *harmonic > 0);
        let polynomials = swing.flat_map(|(_, cosine, sine)| [cosine, sine]);
        let size =
            |polynomial: &Polynomial| Some(self.evaluate_with_size(polynomial, value_of).ok()?.1);
        let sizes: Option<Vec<f64>> = polynomials.map(size).collect();
        Some(self.precision() * sizes?.iter().sum::<f64>() / amplitude.abs())
    }

    /// The harmonics that a balance solves for, each with the name of its coefficient; the mean
    /// position is not among them.
    pub fn balanced_harmonics(&self) -> Vec<(usize, Symbol)> {
        let known = |name: &Symbol| {
            self.defines(*name) || self.parameters.contains(name) || name.name() == "pi"
        };
        let named = |(k, cosine, _): (usize, Polynomial, Polynomial)| {
            let name = cosine.symbols().into_iter().find(|name| !known(name))?;
            Some((k, name))
        };
        self.displacement.harmonics().into_iter().filter_map(named).collect()
    }

    /// The motion as a numerical Fourier series in `theta`.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn motion(
        &self,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<FourierSeries<Doubles>, Symbol> {
        let harmonics = self.displacement.harmonics();
        let length = harmonics.last().map_or(0, |last| last.0 + 1);
        let (mut cosine, mut sine) = (vec![0.0; length], vec![0.0; length]);
        let uses_definitions =
            |part: &Polynomial| part.symbols().iter().any(|symbol| self.defines(*symbol));
        let defined = match harmonics
            .iter()
            .any(|entry| uses_definitions(&entry.1) || uses_definitions(&entry.2))
        {
            true => self.defined_values(value_of)?,
            false => vec![],
        };
        let value_of = |symbol| {
            let found = defined.iter().find(|(name, _)| *name == symbol).map(|(_, value)| *value);
            found.or_else(|| value_of(symbol))
        };
        for (k, cosines, sines) in harmonics {
            cosine[k] = self.evaluate(&cosines, &value_of)?;
            sine[k] = self.evaluate(&sines, &value_of)?;
        }
        Ok(FourierSeries::from_parts(Doubles, cosine, sine))
    }

    /// Whether any polynomial of the solution contains the amplitude symbol: not so for linear
    /// equations and limit cycles.
    pub fn depends_on_amplitude(&self) -> bool {
        let amplitude = self.amplitude.symbol();
        self.law.contains(amplitude)
            || self.definitions.iter().any(|definition| definition.meaning.contains(amplitude))
    }
}
