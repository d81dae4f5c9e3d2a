//! Averaging: amplitude and phase that change slowly, by the method of Krylov, Bogoliubov and
//! Mitropolsky.
//!
//! References: N. M. Krylov, N. N. Bogoliubov, *Introduction to Non-Linear Mechanics*, Princeton
//! University Press 1943; N. N. Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of
//! Non-Linear Oscillations*, Gordon and Breach 1961, chapter 1; A. H. Nayfeh, D. T.
//! Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 3.
//!
//! ```text
//! x'' + omega0^2 x + delta g_1(x, x') + delta^2 g_2(x, x') = 0,     x = a cos(psi) + delta u_1(a, psi)
//! a'   = delta A_1(a) + delta^2 A_2(a),     psi' = omega0 + delta B_1(a) + delta^2 B_2(a)
//!
//! along x = a cos(psi), x' = -a omega0 sin(psi), with S and C the coefficients of sin(psi) and cos(psi):
//! A_1 = S[g_1]/(2 omega0),     B_1 = C[g_1]/(2 omega0 a)
//! omega0^2 (u_1'' + u_1) = what is left of -g_1 without the first harmonic;     u_1 has no first harmonic
//! R   = 2 omega0 (A_1 du_1'/da + B_1 u_1'') + g_1x u_1 + g_1v (A_1 cos - a B_1 sin + omega0 u_1') + g_2
//! A_2 = (S[R] - 2 A_1 B_1 - a A_1 dB_1/da)/(2 omega0)
//! B_2 = (C[R] + A_1 dA_1/da - a B_1^2)/(2 omega0 a)
//! ```
//!
//! Order 1 is `a cos(psi)` with `A_1` and `B_1`, for every force whose projections have a closed
//! form; order 2 adds `u_1`, `A_2` and `B_2`, for polynomials in `x` and `x'`. The error of either
//! is one power more of `delta` over times of `1/delta`. Everything but the linear restoring force
//! is small: the parameters whose vanishing leaves that alone, or else all other terms together. If
//! the restoring force is a power of the coordinate, the average is taken along the true motion in
//! that force.
//!
//! Cost: one Fourier table of the force at the first order and a product of two at the second, once
//! for all amplitudes.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
//! let options = Options { method: Some(Method::Averaging), order: Some(2), ..Options::default() };
//! let slow = solve(&oscillator, &options)?.modulation.ok_or("none")?;
//! assert_eq!(slow.amplitude_rate.to_string(), "mu*a/2 - mu*a^3/8");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod action;
mod driven;
mod projections;
mod pure_power;
mod small_terms;

use num_traits::Zero;

use self::pure_power::PurePower;
use self::small_terms::SmallTerms;
use super::limit_cycle::{AmplitudeEquation, FrequencyUnits};
use super::multiple_scales::scaling::has_quadratic_terms;
use super::secular::bounded;
use super::{Options, Reason, Refusal, not_polynomial, transient};
use crate::derivation::DerivationLine;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::Integer;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, ExprError};
use crate::oscillator::{Oscillator, OscillatorError, PerturbedForce, Term};
use crate::series::FourierSeries;
use crate::solution::modulation::Release;
use crate::solution::note::Truncation;
use crate::solution::{
    AmplitudeConvention, ClosedForm, Definition, Law, LeadingCycle, Method, Modulation, Note,
    Solution,
};
use crate::symbol::{Symbol, fresh, fresh_stem};

/// The highest order that is derived.
const HIGHEST: u32 = 2;

type Series = FourierSeries<Polynomials>;

/// Derives the equations of amplitude and phase.
///
/// # Errors
/// A drive that is not a wave near a resonance, a term without a closed projection, no linear
/// restoring force, an order that is not 1 or 2.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let refuse = |reason: Reason| Err(reason.to(Method::Averaging));
    let parts = oscillator.parts()?;
    if !parts.forcing.is_zero() {
        return driven::solve(oscillator, &parts, options);
    }
    if options.resonance.is_some() {
        let choice = super::table::Choice::Resonance;
        return refuse(Reason::NoSuchChoice(choice));
    }
    if let Some(restoring) = PurePower::from_parts(&parts, oscillator.coordinate) {
        return pure_power::solve(oscillator, &parts, &restoring, options);
    }
    let order = match options.order.unwrap_or(1) {
        0 => return refuse(Reason::LowestOrder(1)),
        order if order > HIGHEST => return refuse(Reason::HighestOrder(HIGHEST)),
        order => order,
    };
    let conserves = parts.damping.is_zero();
    let convention = options.amplitude.unwrap_or(AmplitudeConvention::FirstHarmonic);
    if convention == AmplitudeConvention::Initial && !conserves {
        return refuse(Reason::SlowAmplitude);
    }
    let small = SmallTerms::from_oscillator(oscillator, options)?;
    let mut averaged = match small.expand(order) {
        Ok(mut force) => {
            force.write_with_frequency(&oscillator.names());
            let mut averaged = of_polynomial(oscillator, &small, &force, order)?;
            if order == 1 && has_quadratic_terms(oscillator) {
                averaged.notes.push(Note::QuadraticTermsLeftOut);
            }
            averaged
        }
        // A term may not be a polynomial in the coordinate and its velocity. Nor is a step at a
        // parameter, as H(x - xc), and its apparent force at rest is known to vanish.
        Err(
            OscillatorError::NotPolynomial(_)
            | OscillatorError::Taylor(_)
            | OscillatorError::NoEquilibrium(_),
        ) if order == 1 => by_projections(oscillator, &small)?,
        Err(
            OscillatorError::NotPolynomial(_)
            | OscillatorError::Taylor(_)
            | OscillatorError::NoEquilibrium(_),
        ) => {
            // A missing restoring force is the more important reason, and reported first.
            small.linear_part()?;
            let force = small.without_linear()?;
            return Err(not_polynomial(&force, oscillator.coordinate, Method::Averaging));
        }
        Err(error) => return Err(error.into()),
    };
    if convention == AmplitudeConvention::Initial {
        averaged.measure_at_start()?;
    }
    if !conserves {
        averaged.notes.extend(action::notes(oscillator, &parts));
        let rate = averaged.amplitude_rates[1].expand()?;
        if !rate.is_zero() && rate.terms().iter().all(|term| !term.has_leading_minus()) {
            averaged.notes.push(Note::Grows);
        }
    }
    averaged.into_solution(oscillator, &small, order, convention)
}

/// The names of what a derivation introduces, beside those of the equation.
struct DerivationLetters {
    taken: Vec<Symbol>,
    /// `psi`.
    phase: Symbol,
}

impl DerivationLetters {
    fn avoiding(taken: &[Symbol]) -> Self {
        Self { taken: taken.to_vec(), phase: fresh("psi", taken) }
    }

    /// `g1`, `u1`, `A2`, `B2`.
    fn symbol(&self, letter: &str, order: u32) -> Symbol {
        Symbol::new(&format!("{}{order}", fresh_stem(letter, &self.taken)))
    }
}

/// The slow equations and what goes with them.
struct Averaged {
    /// The symbol of the amplitude.
    amplitude: Symbol,
    definitions: Vec<Definition>,
    /// `a'` to the first order, `A_1`, and to all orders, the sum of the `A_i`.
    amplitude_rates: [Expr; 2],
    /// `psi'` to the first order, `omega0 + B_1`, and to all orders.
    phase_rates: [Expr; 2],
    /// `u_1`, of order 2.
    correction: Series,
    /// `a(0)` and `psi(0)` of a motion released at `A`.
    release: Release,
    steady: Vec<LeadingCycle>,
    notes: Vec<Note>,
    derivation: Vec<DerivationLine>,
}

impl Averaged {
    /// Replaces the amplitude of the first harmonic by `A = x(0)` for a motion without damping: `a
    /// = A - u_1(A, 0)`.
    fn measure_at_start(&mut self) -> Result<(), Refusal> {
        let (a, start) = (self.amplitude, AmplitudeConvention::Initial.symbol());
        let renamed = |value: &Expr| value.substitute(a, &Expr::from(start));
        let shift = -&Expr::from(&self.correction.at_zero().constant_term());
        let [first, all] = &self.phase_rates;
        let moved = &first.differentiate(a)? * &shift;
        self.phase_rates = [renamed(first)?, renamed(&(all + &moved).expand()?)?];
        let cosine = self.correction.at_zero().product(&Series::cos(POLYNOMIALS, 1));
        let renamed = Polynomial::symbol(start);
        self.correction = self.correction.difference(&cosine).map(POLYNOMIALS, |value, _| {
            value.substitute(a, &renamed).unwrap_or_else(|| value.clone())
        });
        self.amplitude = start;
        Ok(())
    }

    fn into_solution(
        self,
        oscillator: &Oscillator,
        small: &SmallTerms,
        order: u32,
        convention: AmplitudeConvention,
    ) -> Result<Solution, Refusal> {
        let a = self.amplitude;
        let [_, amplitude_rate] = self.amplitude_rates;
        let [_, phase_rate] = self.phase_rates;
        let law = match phase_rate.to_polynomial(&mut |_| None)? {
            Some(frequency) => Law::Frequency(frequency),
            None => Law::Closed(ClosedForm { squared: false, value: phase_rate.clone() }),
        };
        let taken: Vec<Symbol> = oscillator.names();
        let leading = Series::cos(POLYNOMIALS, 1)
            .product(&Series::constant(POLYNOMIALS, Polynomial::symbol(a)));
        let (first, small_with, cut) = small_in_words(small, order);
        let mut definitions = self.definitions;
        let mut taken = taken;
        taken.extend(definitions.iter().map(|definition| definition.symbol));
        let mut release = self.release;
        let transient = match amplitude_rate.is_zero() {
            true => None,
            false => {
                let (named, transient) = transient::from_release(
                    a,
                    [&amplitude_rate, &phase_rate],
                    &mut release,
                    &taken,
                );
                definitions.extend(named);
                transient
            }
        };
        Ok(Solution {
            equation: oscillator.equation(),
            method: Method::Averaging,
            order,
            degrees: None,
            small_parameter: first,
            amplitude: convention,
            parameters: oscillator.parameters.clone(),
            definitions,
            equilibrium: Expr::zero(),
            law,
            displacement: leading.sum(&self.correction),
            limit_cycle: None,
            modulation: Some(Modulation {
                amplitude: a,
                phase: DerivationLetters::avoiding(&taken).phase,
                amplitude_rate,
                phase_rate,
                small_with,
                resonance: None,
                release: Some(release),
                transient,
                steady: self.steady,
                motion: None,
            }),
            response: None,
            numerical: false,
            closed_motion: None,
            convergence: None,
            validity: std::iter::once(cut).chain(self.notes).collect(),
            steps: vec![],
            derivation: self.derivation,
        })
    }
}

/// The small parameter, those that are small with it, and how the expansion is cut.
fn small_in_words(small: &SmallTerms, order: u32) -> (Symbol, Vec<Symbol>, Note) {
    let mut names = small.letters().iter().copied();
    let first = names.next().unwrap_or(small.delta());
    let small_with: Vec<Symbol> = names.collect();
    let cut = Note::Cut(Truncation::Truncated {
        small: std::iter::once(first).chain(small_with.iter().copied()).collect(),
        order,
        marks: small.letters().is_empty().then(Expr::one),
    });
    (first, small_with, cut)
}

/// Any order of a polynomial force.
fn of_polynomial(
    oscillator: &Oscillator,
    small: &SmallTerms,
    force: &PerturbedForce,
    order: u32,
) -> Result<Averaged, Refusal> {
    let sizes = force.terms.iter().map(|term| (term.order, term.position + term.velocity));
    bounded(sizes, order as usize + 1)?;
    let mut taken = oscillator.names();
    let (omega0, root) = force.linear_frequency(&taken);
    let used = force.terms.iter().map(|term| &term.coefficient).chain([&omega0]);
    let used: std::collections::BTreeSet<Symbol> = used.flat_map(Polynomial::symbols).collect();
    let constants = force.definitions.iter().filter(|entry| used.contains(&entry.symbol));
    let definitions: Vec<Definition> = root.iter().chain(constants).cloned().collect();
    taken.extend(definitions.iter().map(|definition| definition.symbol));
    let a = AmplitudeConvention::FirstHarmonic.symbol();

    let letters = DerivationLetters::avoiding(&oscillator.names());
    let slow = FirstOrderAverage::new(force, &omega0, a);
    let mut derivation = vec![
        DerivationLine::equation(oscillator.coordinate, slow.position.clone()).because("along"),
        DerivationLine::equation(oscillator.velocity(), slow.velocity.clone()),
        DerivationLine::equation(letters.symbol("g", 1), slow.force[0].clone())
            .because("the small terms are"),
    ];
    let twice = Expr::from(2) * Expr::from(&omega0);
    let (rate, phase) = (Expr::from(a.derivative()), Expr::from(letters.phase.derivative()));
    derivation.push(
        DerivationLine::equation(&twice * &rate, &slow.secular_sine)
            .because("what sin(θ) asks for"),
    );
    let cosine = &twice * &Expr::from(a) * (&phase - &Expr::from(&omega0));
    derivation.push(
        DerivationLine::equation(cosine, &slow.secular_cosine).because("what cos(θ) asks for"),
    );
    let [mut amplitude_rate, mut phase_rate] =
        [slow.first[0].clone(), omega0.clone() + slow.first[1].clone()];
    let leading = [Expr::from(&amplitude_rate), Expr::from(&phase_rate)];
    let mut correction = Series::zero(POLYNOMIALS);
    let mut release = Release::at_start();
    if order == 2 {
        correction = slow.correction.clone();
        let [second_amplitude, second_phase] = slow.second(force);
        release = slow.release()?;
        derivation.push(
            DerivationLine::equation(letters.symbol("u", 1), correction.clone())
                .because(format!("what {} leaves over", letters.symbol("g", 1))),
        );
        derivation.push(
            DerivationLine::equation(letters.symbol("A", 2), &second_amplitude)
                .because("the same at second order"),
        );
        derivation.push(DerivationLine::equation(letters.symbol("B", 2), &second_phase));
        amplitude_rate = amplitude_rate + second_amplitude;
        phase_rate = phase_rate + second_phase;
    }
    let in_numbers = |rate: &Polynomial| Expr::from(rate);
    let mixes = |term: &Term| term.velocity % 2 == 1 && (term.position + term.velocity) == 2;
    // A quadratic damping acts on the amplitude from the second order on, as strongly as a cubic
    // one: the first order is not the leading one there.
    let (steady, mut notes) = match order == 2 && force.terms.iter().any(mixes) {
        true => (vec![], vec![]),
        false => steady(force, &omega0, small.delta(), &taken),
    };
    notes.extend(root.into_iter().map(Note::Positive));
    let [first_amplitude, first_phase] = leading;
    Ok(Averaged {
        amplitude: a,
        definitions,
        amplitude_rates: [first_amplitude, in_numbers(&amplitude_rate)],
        phase_rates: [first_phase, in_numbers(&phase_rate)],
        correction,
        release,
        steady,
        notes,
        derivation,
    })
}

/// The steady amplitudes to leading order, with the notes on them.
fn steady(
    force: &PerturbedForce,
    omega0: &Polynomial,
    delta: Symbol,
    taken: &[Symbol],
) -> (Vec<LeadingCycle>, Vec<Note>) {
    let units = FrequencyUnits::new(force, omega0.clone());
    let Some(equation) = AmplitudeEquation::new(force, &units) else {
        return (vec![], vec![]);
    };
    let z = fresh("z", taken);
    match equation.cycles(delta, omega0, taken) {
        // The bookkeeping parameter is one.
        Ok(cycles) => {
            let leading = cycles.iter().map(|cycle| cycle.to_leading(delta, z));
            (leading.collect(), vec![])
        }
        Err(reason) => (
            vec![],
            vec![Note::SteadyAmplitudes { square: z, polynomial: equation.in_square(z), reason }],
        ),
    }
}

/// The first order of a polynomial force, and what the second is made of.
struct FirstOrderAverage {
    a: Symbol,
    omega0: Polynomial,
    /// `a cos(psi)` and `-a omega0 sin(psi)`.
    position: Series,
    velocity: Series,
    /// `g_1` and `g_2` along the motion.
    force: [Series; 2],
    secular_sine: Polynomial,
    secular_cosine: Polynomial,
    /// `A_1` and `B_1`.
    first: [Polynomial; 2],
    /// `u_1`.
    correction: Series,
}

fn constant(value: &Polynomial) -> Series {
    Series::constant(POLYNOMIALS, value.clone())
}

/// The derivative of a polynomial, whose exponents may be negative.
fn differentiated(polynomial: &Polynomial, by: Symbol) -> Polynomial {
    let mut slope = Polynomial::zero();
    for (monomial, number) in polynomial.terms() {
        let exponent = monomial.exponent(by);
        let lower = monomial.product(&Monomial::power_of(by, -1));
        slope.add_term(lower, number * Rational::from_integer(Integer::from(exponent)));
    }
    slope
}

impl FirstOrderAverage {
    fn new(force: &PerturbedForce, omega0: &Polynomial, a: Symbol) -> Self {
        let amplitude = constant(&Polynomial::symbol(a));
        let position = amplitude.product(&Series::cos(POLYNOMIALS, 1));
        let velocity =
            amplitude.product(&constant(omega0)).product(&Series::sin(POLYNOMIALS, 1).times(-1));
        let along = |order: usize| {
            let terms = force.terms.iter().filter(|term| term.order == order);
            terms.fold(Series::zero(POLYNOMIALS), |sum, term| {
                let wave = position.power(term.position).product(&velocity.power(term.velocity));
                sum.sum(&wave.product(&constant(&term.coefficient)))
            })
        };
        let forces = [along(1), along(2)];
        let inverse = omega0.power(-1).unwrap_or_else(Polynomial::zero);
        let (driven, resonance) = forces[0].times(-1).solve_oscillator();
        let [secular_sine, secular_cosine] = [&resonance.sine, &resonance.cosine].map(|part| {
            let mut value = part.constant_term();
            value.negate();
            value
        });
        let half = Polynomial::constant(Rational::new(1.into(), 2.into())).product(&inverse);
        let over_a = Monomial::power_of(a, -1);
        let first =
            [secular_sine.product(&half), secular_cosine.product(&half).times_monomial(&over_a)];
        Self {
            a,
            correction: driven.product(&constant(&inverse.product(&inverse))),
            omega0: omega0.clone(),
            position,
            velocity,
            force: forces,
            secular_sine,
            secular_cosine,
            first,
        }
    }

    /// The initial amplitude and phase of a motion released at `A`: `a = A - u_1(A, 0)` and, so
    /// that it is at rest, `psi = (A_1/omega0 + u_1'(A, 0))/A`.
    fn release(&self) -> Result<Release, ExprError> {
        let start = AmplitudeConvention::Initial.symbol();
        let at_start = |value: &Expr| value.substitute(self.a, &Expr::from(start))?.expand();
        let constant = |series: &Series| Expr::from(&series.at_zero().constant_term());
        let drift = Expr::divide(&Expr::from(&self.first[0]), &Expr::from(&self.omega0))?;
        let swing = constant(&self.correction.derivative());
        Ok(Release {
            amplitude: at_start(&(&Expr::from(self.a) - &constant(&self.correction)))?,
            phase: at_start(&Expr::divide(&(&drift + &swing), &Expr::from(self.a))?)?,
        })
    }

    /// `A_2` and `B_2`.
    fn second(&self, force: &PerturbedForce) -> [Polynomial; 2] {
        let [a1, b1] = &self.first;
        let (u, slope, bend) = {
            let slope = self.correction.derivative();
            let bend = slope.derivative();
            (&self.correction, slope, bend)
        };
        let by_amplitude = slope.map(POLYNOMIALS, |value, _| differentiated(value, self.a));
        let omega0 = constant(&self.omega0);
        let (cos, sin) = (Series::cos(POLYNOMIALS, 1), Series::sin(POLYNOMIALS, 1));
        let drift = constant(a1).product(&by_amplitude).sum(&constant(b1).product(&bend));
        let drift = omega0.product(&drift).times(2);
        let amplitude = Polynomial::symbol(self.a);
        let speed = constant(a1)
            .product(&cos)
            .difference(&constant(&amplitude.product(b1)).product(&sin))
            .sum(&omega0.product(&slope));
        let first = || force.terms.iter().filter(|term| term.order == 1);
        let slopes = first().fold(Series::zero(POLYNOMIALS), |sum, term| {
            let (p, q) = (term.position, term.velocity);
            let mut sum = sum;
            let coefficient = constant(&term.coefficient);
            if p > 0 {
                let wave = self.position.power(p - 1).product(&self.velocity.power(q)).product(u);
                sum = sum.sum(&wave.product(&coefficient).times(i64::from(p)));
            }
            if q > 0 {
                let wave = self.position.power(p).product(&self.velocity.power(q - 1));
                sum = sum.sum(&wave.product(&speed).product(&coefficient).times(i64::from(q)));
            }
            sum
        });
        let rest = drift.sum(&slopes).sum(&self.force[1]);
        let inverse = self.omega0.power(-1).unwrap_or_else(Polynomial::zero);
        let half = Polynomial::constant(Rational::new(1.into(), 2.into())).product(&inverse);
        let number = |value: i64| Polynomial::constant(Rational::from_integer(value.into()));
        let of_b1 = number(2).product(a1).product(b1)
            + amplitude.product(a1).product(&differentiated(b1, self.a));
        let of_amplitude = rest.sine(1).constant_term() + of_b1.product(&number(-1));
        let of_phase = rest.cosine(1).constant_term()
            + a1.product(&differentiated(a1, self.a))
            + amplitude.product(b1).product(b1).product(&number(-1));
        [
            of_amplitude.product(&half),
            of_phase.product(&half).times_monomial(&Monomial::power_of(self.a, -1)),
        ]
    }
}

/// The first harmonics of the small terms along a harmonic motion.
struct Projected {
    omega0: Expr,
    root: Option<Definition>,
    definitions: Vec<Definition>,
    terms: Expr,
    sine: Expr,
    cosine: Expr,
}

impl Projected {
    /// # Errors
    /// There is no restoring force, or a term whose projection has no closed form.
    fn new(oscillator: &Oscillator, small: &SmallTerms, amplitude: &Expr) -> Result<Self, Refusal> {
        let linear = small.linear_part()?;
        let (omega0, root) = linear.linear_frequency(&oscillator.names());
        let mut definitions: Vec<Definition> = root.iter().cloned().collect();
        if root.is_none() {
            let used = omega0.symbols();
            let constants = linear.definitions.iter().cloned();
            definitions.extend(constants.filter(|entry| used.contains(&entry.symbol)));
        }
        let omega0 = Expr::from(&omega0);
        let terms = small.first_order()?;
        let restoring = linear.linear_in_full();
        let (mut sines, mut cosines) = (vec![], vec![]);
        for term in terms.terms() {
            let in_frequency = match root {
                Some(_) => with_frequency(term, &restoring, &omega0)?,
                None => None,
            };
            let written = in_frequency.as_ref().unwrap_or(term);
            let Some([sine, cosine]) =
                projections::of_term(written, oscillator.coordinate, amplitude, &omega0)
            else {
                return Err(Reason::NoProjection.to(Method::Averaging).about(term));
            };
            sines.push(sine);
            cosines.push(cosine);
        }
        Ok(Self {
            omega0,
            root,
            definitions,
            terms,
            sine: Expr::sum(sines).expand()?,
            cosine: Expr::sum(cosines).expand()?,
        })
    }

    /// The motion, its velocity and the small terms, as lines of a derivation.
    fn derivation_lines(
        &self,
        oscillator: &Oscillator,
        amplitude: &Expr,
        letters: &DerivationLetters,
    ) -> Result<Vec<DerivationLine>, ExprError> {
        let theta = Expr::from(oscillator.phase());
        Ok(vec![
            DerivationLine::equation(Expr::from(oscillator.coordinate), amplitude * &theta.cos()?)
                .because("along"),
            DerivationLine::equation(
                Expr::from(oscillator.velocity()),
                -(amplitude * &self.omega0 * theta.sin()?),
            ),
            DerivationLine::equation(letters.symbol("g", 1), self.terms.clone())
                .because("the small terms are"),
        ])
    }
}

/// A term with `omega0^2` for the coefficient of the linear force, where it is a multiple of that,
/// as `g/L sin(x)` is of `g/L`.
fn with_frequency(term: &Expr, linear: &Expr, omega0: &Expr) -> Result<Option<Expr>, ExprError> {
    let letters = linear.symbols();
    let has_any = |term: &Expr| letters.iter().any(|&letter| term.contains(letter));
    if !has_any(term) {
        return Ok(None);
    }
    let quotient = Expr::divide(term, linear)?;
    Ok((!has_any(&quotient)).then(|| omega0 * omega0 * quotient))
}

/// The first order of any force whose terms have closed projections.
fn by_projections(oscillator: &Oscillator, small: &SmallTerms) -> Result<Averaged, Refusal> {
    let a = AmplitudeConvention::FirstHarmonic.symbol();
    let amplitude = Expr::from(a);
    let found = Projected::new(oscillator, small, &amplitude)?;
    let letters = DerivationLetters::avoiding(&oscillator.names());
    let mut derivation = found.derivation_lines(oscillator, &amplitude, &letters)?;
    let Projected { omega0, root, definitions, sine, cosine, .. } = found;
    let twice = Expr::from(2) * &omega0;
    let amplitude_rate = Expr::divide(&sine, &twice)?.expand()?;
    let phase_rate = (&omega0 + &Expr::divide(&cosine, &(&twice * &amplitude))?).expand()?;
    let psi = Expr::from(letters.phase.derivative());
    derivation.extend([
        DerivationLine::equation(&twice * &Expr::from(a.derivative()), sine)
            .because("what sin(θ) asks for"),
        DerivationLine::equation(&twice * &amplitude * (&psi - &omega0), cosine)
            .because("what cos(θ) asks for"),
    ]);
    let steady = transient::steady(a, &amplitude_rate);
    Ok(Averaged {
        amplitude: a,
        definitions,
        amplitude_rates: [amplitude_rate.clone(), amplitude_rate],
        phase_rates: [phase_rate.clone(), phase_rate],
        correction: Series::zero(POLYNOMIALS),
        release: Release::at_start(),
        steady,
        notes: root.into_iter().map(Note::Positive).collect(),
        derivation,
    })
}
