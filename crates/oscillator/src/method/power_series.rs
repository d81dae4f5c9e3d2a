//! omega^2 as a power series in one variable, its symbols combined into that variable as far as
//! they scale with it; and the parts that the methods share that resum it.

use num_traits::{One, Zero};

use super::{Options, Reason, Refusal, lindstedt_poincare};
use crate::derivation::DerivationLine;
use crate::exact::polynomial::Monomial;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::Expr;
use crate::oscillator::{Oscillator, SmallParameter};
use crate::series::FourierSeries;
use crate::solution::{
    AmplitudeConvention, ClosedForm, Definition, Degrees, Law, Method, Note, Solution,
};
use crate::symbol::Symbol;

/// omega^2 in powers of `s`, the small parameter or its square.
pub struct PowerSeries {
    /// The polynomial in `small`.
    pub law: Polynomial,
    /// The small parameter.
    pub small: Symbol,
    /// The exponent of the small parameter in `s`: 1 or 2.
    pub step: i32,
}

impl PowerSeries {
    /// The series of a solution, in the squared amplitude if it has even powers alone.
    pub fn from_solution(solution: &Solution, in_amplitude: bool) -> Self {
        let small = solution.small_parameter;
        let law = solution.law.frequency_squared().cloned();
        let law = law.unwrap_or_else(Polynomial::zero);
        let even = law.terms().all(|(monomial, _)| monomial.exponent(small) % 2 == 0);
        Self { law, small, step: if in_amplitude && even { 2 } else { 1 } }
    }

    /// `c_k`; zero for a negative power.
    pub fn coefficient(&self, power: i64) -> Polynomial {
        match u32::try_from(power) {
            Ok(power) => part(&self.law, self.small, self.step * power as i32),
            Err(_) => Polynomial::zero(),
        }
    }

    /// `c_0 + c_1 s + ...` of other coefficients.
    pub fn with_powers(&self, coefficients: &[Polynomial]) -> Polynomial {
        let mut sum = Polynomial::zero();
        for (power, coefficient) in coefficients.iter().enumerate() {
            sum.accumulate(
                &coefficient
                    .times_monomial(&Monomial::power_of(self.small, self.step * power as i32)),
            );
        }
        sum
    }

    /// The series in one variable, where all other symbols enter in step with `s`: the variable,
    /// `s` times a product of the others, and the coefficients divided by the first, one for each
    /// power of the law. `None` if a symbol does not scale with `s`.
    pub fn in_one_variable(&self) -> Option<(Monomial, Vec<Rational>)> {
        let (_, highest) = self.law.exponent_range(self.small)?;
        let coefficients: Vec<Polynomial> =
            (0..=i64::from(highest / self.step)).map(|power| self.coefficient(power)).collect();
        let (unit, numbers) = scaled(&coefficients)?;
        Some((Monomial::power_of(self.small, self.step).product(&unit), numbers))
    }
}

/// The terms of one power of the small parameter, without it.
fn part(law: &Polynomial, small: Symbol, power: i32) -> Polynomial {
    let mut part = Polynomial::zero();
    for (monomial, number) in law.terms().filter(|(monomial, _)| monomial.exponent(small) == power)
    {
        part.add_term(monomial.without(small), number.clone());
    }
    part
}

/// The numbers `n_k` of a series `c_k = c_0 unit^k n_k` whose symbols enter in step with the order,
/// and the unit.
pub(crate) fn scaled(series: &[Polynomial]) -> Option<(Monomial, Vec<Rational>)> {
    let (base, _) = series.first()?.single_term()?;
    let ratio = |c: &Polynomial| Some(c.single_term()?.0.product(&base.power(-1)));
    let (k, first) = (1..).zip(&series[1..]).find(|(_, c)| !c.is_zero())?;
    let mut unit = Monomial::one();
    for &(symbol, exponent) in ratio(first)?.factors() {
        unit =
            unit.product(&Monomial::power_of(symbol, (exponent % k == 0).then_some(exponent / k)?));
    }
    let number = |(k, c): (i32, &Polynomial)| match c.is_zero() {
        true => Some(Rational::zero()),
        false => {
            (ratio(c)? == unit.power(k)).then(|| c.single_term().map(|term| term.1.clone()))?
        }
    };
    let numbers: Option<Vec<Rational>> = (0..).zip(series).map(number).collect();
    Some((unit, numbers?))
}

/// A series truncated at some power, and the solution that it belongs to.
pub(crate) struct Resummed {
    pub series: PowerSeries,
    solution: Solution,
    order: u32,
    /// Whether the series was derived without its motion.
    pub long: bool,
}

/// The reason why there is no approximant.
pub(crate) const CONSTANT: &str = "omega^2 does not depend on the amplitude";
pub(crate) const STOPPED: &str = "the series was stopped before it was long enough";
pub(crate) const TOO_LONG: &str = "its coefficients are too long for a value in double precision";

impl Resummed {
    /// The series through the power `order` of its variable; `None` if that was stopped.
    ///
    /// # Errors
    /// As for the method of Lindstedt and Poincare.
    pub fn new(
        oscillator: &Oscillator,
        options: &Options,
        (method, order): (Method, u32),
    ) -> Result<Option<Self>, Refusal> {
        /// Order beyond which the series is derived without its motion, of which only the first
        /// correction is used.
        const LONG: u32 = 24;
        if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
            return Err(Reason::Convention.to(method));
        }
        let in_amplitude =
            oscillator.small_parameter(options.small.as_deref())? == SmallParameter::Amplitude;
        let long = order > LONG;
        let series_to = |highest: u32, frequency_alone: bool| {
            let options = Options { order: Some(highest), frequency_alone, ..options.clone() };
            let solution = lindstedt_poincare::solve(oscillator, &options)?;
            Ok::<_, Refusal>((solution.order >= highest).then_some(solution))
        };
        let Some(mut solution) = series_to(if in_amplitude { 2 * order } else { order }, long)?
        else {
            return Ok(None);
        };
        // The frequency of a limit cycle is mostly even in the small parameter.
        let of_cycle = solution.limit_cycle.is_some() && order > 0;
        // Quadratic approximants of an even series are not unique in the parameter itself.
        let even = method == Method::HermitePade
            && !in_amplitude
            && PowerSeries::from_solution(&solution, true).step == 2;
        if of_cycle || even {
            let Some(further) = series_to(2 * order, long)? else {
                return Ok(None);
            };
            if PowerSeries::from_solution(&further, true).step == 2 {
                solution = further;
            }
        }
        let series = PowerSeries::from_solution(&solution, in_amplitude || of_cycle || even);
        if long {
            let Some(first) = series_to(u32::try_from(series.step).unwrap_or(1), false)? else {
                return Ok(None);
            };
            (solution.displacement, solution.limit_cycle) = (first.displacement, first.limit_cycle);
        }
        solution.method = method;
        solution.displacement = first_correction(&solution.displacement, series.small, series.step);
        Ok(Some(Self { series, solution, order, long }))
    }

    /// The names that are in use already.
    pub fn names(&self) -> Vec<Symbol> {
        self.solution.names()
    }

    /// Replaces a symbol whose root is `omega0` by `omega0^2`, so that one of the two is left.
    pub fn write_squares_by_their_roots(&mut self) {
        for definition in &self.solution.definitions {
            let square =
                definition.meaning.integer_power(2).ok().and_then(|square| square.as_symbol());
            let root = Polynomial::term(Monomial::power_of(definition.symbol, 2), Rational::one());
            if let Some(law) = square.and_then(|square| self.series.law.substitute(square, &root)) {
                self.series.law = law;
            }
        }
    }

    /// The note of the order through which an approximant of these degrees agrees with the series.
    pub fn agreement(&self, degrees: Degrees) -> Note {
        Note::AgreesThrough {
            degrees,
            small: self.series.small,
            step: self.series.step as u32,
            order: self.order,
        }
    }

    /// The answer with another value for omega^2, the notes on it, and its derivation.
    pub fn answer(
        self,
        degrees: Degrees,
        (value, definitions): (Expr, Vec<Definition>),
        (validity, derivation): (Vec<Note>, Vec<DerivationLine>),
    ) -> Solution {
        let mut solution = self.solution;
        let harmonics = solution.displacement.harmonics();
        let motion = harmonics.iter().flat_map(|(_, cosine, sine)| [cosine, sine]);
        let mut used = &solution.equilibrium.symbols() | &self.series.law.symbols();
        used.extend(motion.flat_map(Polynomial::symbols));
        solution.definitions = solution.definitions_behind(used).into_iter().cloned().collect();
        solution.definitions.extend(definitions);
        solution.order = self.order;
        solution.degrees = Some(degrees);
        solution.law = Law::Closed(ClosedForm { squared: true, value });
        solution.steps = vec![];
        solution.validity = validity;
        solution.derivation = derivation;
        solution
    }
}

/// The motion up to the first power of the expansion variable beyond the leading term.
fn first_correction(
    motion: &FourierSeries<Polynomials>,
    small: Symbol,
    step: i32,
) -> FourierSeries<Polynomials> {
    let leading = if small == Symbol::new("A") { 1 } else { 0 };
    motion.map(POLYNOMIALS, |coefficient, _| coefficient.truncated(small, leading + step))
}

/// Whether a quotient can be evaluated in double precision, where its whole numbers do not
/// overflow.
pub(crate) fn has_values(value: &Expr) -> bool {
    let at = |place: f64| value.symbols().into_iter().map(|symbol| (symbol, place)).collect();
    // One of the two points may be a pole.
    [1.0, 0.5].iter().any(|place| value.evaluate(&at(*place)).is_ok_and(f64::is_finite))
}
