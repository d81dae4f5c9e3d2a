//! The answer: a frequency relation and a motion, with everything needed to use them rightly.
//!
//! A formula without its amplitude convention, order and validity is half a formula, so all of them travel together.

use std::fmt;

use num_traits::Zero;

use crate::exact::Polynomial;
use crate::exact::rational::{Rational, to_f64};
use crate::expr::Expr;
use crate::series::FourierSeries;
use crate::symbol::Symbol;

/// The method that derived a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// Strained time, secular terms eliminated order by order.
    LindstedtPoincare,
    /// The whole nonlinearity at the first power of a bookkeeping parameter.
    HomotopyPerturbation,
}

impl Method {
    /// Every method, in the order in which they are listed to users.
    pub const ALL: [Self; 2] = [Self::LindstedtPoincare, Self::HomotopyPerturbation];

    /// The name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::LindstedtPoincare => "lindstedt-poincare",
            Self::HomotopyPerturbation => "homotopy-perturbation",
        }
    }

    /// The name in running text.
    pub fn title(self) -> &'static str {
        match self {
            Self::LindstedtPoincare => "Lindstedt-Poincare",
            Self::HomotopyPerturbation => "Homotopy perturbation",
        }
    }

    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}

/// What the amplitude in a formula measures.
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

    /// The convention of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Initial, Self::FirstHarmonic]
            .into_iter()
            .find(|convention| convention.name() == name)
    }

    /// The symbol: `A` or `a`.
    pub fn symbol(self) -> Symbol {
        Symbol::new(match self {
            Self::Initial => "A",
            Self::FirstHarmonic => "a",
        })
    }
}

impl fmt::Display for AmplitudeConvention {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Initial => "A = x(0) - equilibrium, x'(0) = 0",
            Self::FirstHarmonic => "a = amplitude of the first harmonic",
        })
    }
}

/// A symbol that the program introduced, and what it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// For example `omega0`.
    pub symbol: Symbol,
    /// For example `sqrt(k)`.
    pub meaning: Expr,
}

/// A closed-form approximation of a periodic motion.
///
/// The motion is `x(t) = displacement(theta)`, `theta = omega t`; all polynomials are in the parameters of the equation, the
/// amplitude symbol of the convention and the symbols of `definitions`.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The equation as it was understood, `x'' + f = 0`.
    pub equation: String,
    /// Who derived it.
    pub method: Method,
    /// Highest power kept, inclusive, of the small parameter.
    pub order: u32,
    /// The parameter in which the expansion runs; the amplitude symbol where it runs in the amplitude.
    pub small_parameter: Symbol,
    /// What the amplitude symbol measures.
    pub amplitude: AmplitudeConvention,
    /// The parameters of the equation, in alphabetical order.
    pub parameters: Vec<Symbol>,
    /// Symbols introduced by the program.
    pub definitions: Vec<Definition>,
    /// The equilibrium about which the motion swings; `A` is measured from it.
    pub equilibrium: Expr,
    /// omega, where the method gives a polynomial.
    pub frequency: Option<Polynomial>,
    /// omega^2, likewise.
    pub frequency_squared: Option<Polynomial>,
    /// For implicit methods: a polynomial in even powers of `omega`, equal to zero.
    pub relation: Option<Polynomial>,
    /// A closed form that is no polynomial.
    pub closed_form: Option<String>,
    /// The motion, equilibrium included.
    pub displacement: FourierSeries<Polynomial>,
    /// Self-excited oscillators: the amplitude (in the convention above) that the equation itself determines.
    pub limit_cycle: Option<Polynomial>,
    /// Whether the coefficients are rounded to fifteen digits, because the equilibrium is no fraction.
    pub numerical: bool,
    /// What is known of where the formula holds.
    pub validity: Vec<String>,
    /// The derivation, order by order, where it was asked for.
    pub steps: Vec<Step>,
}

/// One order of a derivation, `y_n'' + y_n = right_side + (resonance + W_n) cos(theta)`, in units of the amplitude and of the
/// linear frequency (of omega in homotopy perturbation). Every part carries its power of the small parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The order `n`, from one on.
    pub order: u32,
    /// What drives `y_n` beside the secular term.
    pub right_side: FourierSeries<Polynomial>,
    /// The coefficient of the secular `cos(theta)` that the nonlinear terms leave.
    pub resonance: Polynomial,
    /// `W_n`, which the secular condition fixes.
    pub correction: Polynomial,
    /// `y_n`.
    pub displacement: FourierSeries<Polynomial>,
}

impl Solution {
    /// The value of a polynomial of this solution, with definitions worked out from the values of the parameters.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn evaluate(&self, polynomial: &Polynomial, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Result<f64, Symbol> {
        let values: Vec<(Symbol, f64)> = self
            .definitions
            .iter()
            .filter(|definition| polynomial.symbols().contains(&definition.symbol))
            .map(|definition| {
                let parameters = definition.meaning.symbols().into_iter();
                let known: Result<_, Symbol> = parameters
                    .map(|symbol| value_of(symbol).map(|value| (symbol, value)).ok_or(symbol))
                    .collect();
                let value = definition.meaning.evaluate(&known?).map_err(|_| definition.symbol)?;
                Ok((definition.symbol, value))
            })
            .collect::<Result<_, Symbol>>()?;
        let pi = Symbol::new("pi");
        polynomial.evaluate(|symbol| {
            let defined = values.iter().find(|(name, _)| *name == symbol).map(|(_, value)| *value);
            defined
                .or_else(|| value_of(symbol))
                .or_else(|| (symbol == pi).then_some(std::f64::consts::PI))
        })
    }

    /// Rounds every coefficient to fifteen digits and says so.
    pub fn round_coefficients(&mut self) {
        let round = |number: &Rational| crate::decimal::rounded(to_f64(number));
        let rounded = |polynomial: &Polynomial| polynomial.map(round);
        for law in [
            &mut self.frequency,
            &mut self.frequency_squared,
            &mut self.relation,
            &mut self.limit_cycle,
        ] {
            *law = law.as_ref().map(rounded);
        }
        self.displacement = self.displacement.map(|coefficient, _| rounded(coefficient));
        for step in &mut self.steps {
            step.resonance = rounded(&step.resonance);
            step.correction = rounded(&step.correction);
            step.right_side = step.right_side.map(|coefficient, _| rounded(coefficient));
            step.displacement = step.displacement.map(|coefficient, _| rounded(coefficient));
        }
        self.closed_form = None;
        self.numerical = true;
        self.validity
            .push("numerical coefficients, rounded to 15 digits: the equilibrium is no fraction".to_owned());
    }

    /// What the order counts: the small parameter, or the homotopy's `p`.
    pub fn order_counts(&self) -> &'static str {
        match self.method {
            Method::HomotopyPerturbation => "p",
            Method::LindstedtPoincare => self.small_parameter.name(),
        }
    }

    /// omega^2 at given values: of the law where it is explicit, else the root of the relation that continues omega0^2
    /// from amplitude zero; `None` where a value is missing or the branch ends before.
    pub fn frequency_squared_at(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<f64> {
        if let Some(law) = &self.frequency_squared {
            return self.evaluate(law, value_of).ok();
        }
        self.continued_root(self.relation.as_ref()?, value_of)
    }

    fn continued_root(&self, relation: &Polynomial, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<f64> {
        const LONGEST_STEP: f64 = 1.0 / 32.0;
        const SHORTEST_STEP: f64 = 1e-9;
        let (omega, amplitude) = (Symbol::new("omega"), self.amplitude.symbol());
        let highest = usize::try_from(relation.exponent_range(omega)?.1 / 2).ok()?;
        // One polynomial in z = omega^2 for each step of the amplitude.
        let coefficients = |part: f64| {
            let value = |symbol| {
                if symbol == amplitude {
                    Some(part * value_of(symbol)?)
                } else {
                    value_of(symbol)
                }
            };
            let mut coefficients = vec![Polynomial::zero(); highest + 1];
            for (monomial, number) in relation.terms() {
                let power = usize::try_from(monomial.exponent(omega) / 2).ok()?;
                coefficients[power].add_term(monomial.without(omega), number.clone());
            }
            coefficients
                .iter()
                .map(|entry| self.evaluate(entry, &value).ok())
                .collect::<Option<Vec<f64>>>()
        };
        // At rest the relation is z^(n-1) (z - omega0^2).
        let at_rest = coefficients(0.0)?;
        let mut z = -at_rest[highest.checked_sub(1)?] / at_rest[highest];
        let (mut part, mut step) = (0.0, LONGEST_STEP);
        while part < 1.0 {
            let next = f64::min(part + step, 1.0);
            match newton(&coefficients(next)?, z) {
                // A root that moved little is the same branch; any other asks for a shorter step.
                Some(root) if root > 0.0 && (root / z).ln().abs() < 0.2 => {
                    (z, part) = (root, next);
                    step = f64::min(2.0 * step, LONGEST_STEP);
                }
                _ => step *= 0.5,
            }
            if step < SHORTEST_STEP {
                return None;
            }
        }
        Some(z)
    }

    /// The motion as a numerical Fourier series in `theta`.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn motion(&self, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Result<FourierSeries<f64>, Symbol> {
        let harmonics = self.displacement.harmonics();
        let length = harmonics.last().map_or(0, |last| last.0 + 1);
        let (mut cosine, mut sine) = (vec![0.0; length], vec![0.0; length]);
        for (k, cosines, sines) in harmonics {
            cosine[k] = self.evaluate(&cosines, value_of)?;
            sine[k] = self.evaluate(&sines, value_of)?;
        }
        Ok(FourierSeries::from_parts(cosine, sine, 1.into()))
    }

    /// Whether any polynomial of the solution contains the amplitude symbol: not so for linear equations and limit cycles.
    pub fn depends_on_amplitude(&self) -> bool {
        let laws = self
            .frequency
            .iter()
            .chain(&self.frequency_squared)
            .chain(&self.relation);
        laws.into_iter()
            .any(|law| law.symbols().contains(&self.amplitude.symbol()))
    }
}

/// The root of a polynomial, lowest coefficient first, that Newton's iteration reaches from `start`; `None` where it does
/// not settle, as it does not where two roots meet.
fn newton(coefficients: &[f64], start: f64) -> Option<f64> {
    const ITERATIONS: usize = 40;
    let mut root = start;
    for _ in 0..ITERATIONS {
        let horner = |(value, slope): (f64, f64), coefficient: &f64| (value * root + coefficient, slope * root + value);
        let (value, slope) = coefficients.iter().rev().fold((0.0, 0.0), horner);
        let change = value / slope;
        root -= change;
        if change.abs() <= 1e-15 * root.abs() || value == 0.0 {
            return Some(root);
        }
    }
    // The last digits may go on turning in a circle.
    let scale = coefficients
        .iter()
        .rev()
        .fold(0.0, |sum, coefficient| sum * root.abs() + coefficient.abs());
    let value = coefficients
        .iter()
        .rev()
        .fold(0.0, |sum, coefficient| sum * root + coefficient);
    (value.abs() <= 1e-14 * scale).then_some(root)
}
