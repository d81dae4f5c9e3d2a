//! Kind `solution`: a derived law and motion; what the judge says of it is in `verification.rs`.

use num_traits::Zero;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{DocumentNames, meanings, named, text, texts};
use super::verification::{Verification, verification as judged};
use super::{Constant, DocumentKind, JsonError, Map, Polynomial, check_kind, unexpected};
use crate::derivation::DerivationLine;
use crate::exact::{self, Monomial, POLYNOMIALS, Polynomials};
use crate::expr::{Equation, parse_equation};
use crate::series::FourierSeries;
use crate::series::singularity::{self, Singularity};
use crate::solution::{
    self, AmplitudeConvention, ClosedForm, Definition, Degrees, Law, LeadingCycle, Method, Note,
    Root, Solution, modulation,
};
use crate::symbol::Symbol;
use crate::verify;

/// A formula for the frequency and the motion of an oscillator. Of the laws of the frequency take
/// the first that is not null: `frequency_squared`, `relation`, `closed_form`, `frequency`,
/// `by_quadrature`, `system`; that is the one that is judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SolutionDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Solution.schema())))]
    pub schema: String,
    /// The equation of motion as it was understood, `... = 0`; time is its own, so frequencies are
    /// in radians per unit of it.
    pub equation: String,
    /// The method that derived it, by its name on the command line.
    #[cfg_attr(feature = "schema", schemars(schema_with = "super::generated_schema::methods"))]
    pub method: String,
    /// The highest power kept of the small parameter, inclusive; for a balance the number of
    /// harmonics, for iterations the passes.
    pub order: u32,
    /// The degrees of an approximant, of numerator and denominator or of P, Q and R; null for every
    /// other method.
    pub degrees: Option<Vec<u32>>,
    /// The symbol in which the expansion runs: a parameter, or the symbol of the amplitude.
    pub small_parameter: String,
    /// What the amplitude measures: `initial` is `A` = x(0) minus the equilibrium with x'(0) = 0,
    /// `first-harmonic` is `a`, the amplitude of the first harmonic. It has the unit of the
    /// coordinate.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [AmplitudeConvention::Initial.name(), AmplitudeConvention::FirstHarmonic.name()])))]
    pub amplitude: String,
    /// The parameters of the equation, in alphabetical order.
    pub parameters: Vec<String>,
    /// Symbols that the program introduced, each with the expression that it stands for, which may
    /// use those before it; their values are in `verification.values`.
    pub definitions: Map<String>,
    /// The equilibrium about which the motion swings, in the unit of the coordinate; its value is
    /// null where it has symbols.
    pub equilibrium: Constant,
    /// omega, the angular frequency, as a polynomial; null where the method gives none. Where
    /// `frequency_squared` or `relation` stands beside it, those are judged, not this one.
    pub frequency: Option<Polynomial>,
    /// omega^2 as a polynomial; null where the method gives none. It is judged before `frequency`,
    /// of which it is no exact square.
    pub frequency_squared: Option<Polynomial>,
    /// A polynomial in even powers of `omega` that is zero: omega is its root that continues the
    /// linear frequency from amplitude zero; null where the law is explicit.
    pub relation: Option<Polynomial>,
    /// The law as text where it is no polynomial, `omega^2 = ...` or `omega = ...`; null otherwise.
    /// K is the complete elliptic integral of the first kind of the parameter m = k^2, not of the
    /// modulus k; J0, J1, I0, I1 are Bessel functions.
    pub closed_form: Option<String>,
    /// The law as text where only numbers solve it: integrals, separated by `; `; null otherwise.
    pub by_quadrature: Option<String>,
    /// The equations of a balance of several harmonics, which only numbers solve; null otherwise.
    pub system: Option<System>,
    /// The motion x(t), the equilibrium included: add nothing to it.
    pub displacement: Displacement,
    /// The motion x(t) from rest at the amplitude as text, the equilibrium included, where it is
    /// known in closed form: an expression in `t`, the amplitude, the parameters and the
    /// definitions. sn(u, m), cn(u, m) and dn(u, m) are the elliptic functions of Jacobi of the
    /// parameter m = k^2, not of the modulus k. Left out for any other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closed_motion: Option<String>,
    /// The limit cycle of a self-excited equation, whose amplitude the equation determines; null
    /// for any other.
    pub limit_cycle: Option<LimitCycle>,
    /// The slow equations of amplitude and phase of a motion that is not periodic; null for any
    /// other.
    pub modulation: Option<Modulation>,
    /// The steady motions of a driven equation; null for any other. `frequency` is then the
    /// backbone, the frequency of the motion itself without damping and drive, and `displacement`
    /// its leading term: the whole motion is `response.motion`.
    pub response: Option<Response>,
    /// Whether coefficients are rounded to fifteen digits, because the equilibrium is no fraction.
    pub numerical: bool,
    /// What is known of where the formula holds, in words.
    pub validity: Vec<String>,
    /// How far the series of omega^2 converges, by its own coefficients; left out where they are
    /// too few or show no law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// The derivation line by line, as text; left out where it was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivation: Option<Vec<String>>,
    /// The verdict at given values; null where none were given.
    pub verification: Option<Verification>,
}

/// The nearest singularity of a series, or a pair of conjugate ones, in the complex plane of its
/// variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Convergence {
    /// What the series runs in: the powers of the small parameter and of the symbols that enter in
    /// step with it, multiplied.
    pub variable: Map<i32>,
    /// The highest power of the variable in the series.
    pub highest: usize,
    /// The distance of the singularity from zero: the series converges where the variable is
    /// smaller.
    pub radius: Estimate,
    /// Its angle in radians, in the upper half plane.
    pub angle: Estimate,
    /// The real part of its place.
    pub real: Estimate,
    /// The imaginary part of its place, which stands with both signs.
    pub imaginary: Estimate,
    /// The power of the distance with which the period is singular there: 1/2 for a square root, 0
    /// for a logarithm; null where it could not be told.
    pub exponent: Option<Estimate>,
}

/// A number that was estimated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Estimate {
    /// All digits that the error leaves, as an exact fraction in text.
    pub exact: String,
    /// The same as a decimal number.
    pub value: f64,
    /// How far it may be off.
    pub error: f64,
}

impl Estimate {
    fn from_estimate(estimate: &singularity::Estimate) -> Self {
        Self {
            exact: estimate.value.to_string(),
            value: exact::to_f64(&estimate.value),
            error: estimate.error,
        }
    }

    fn read(&self) -> Result<singularity::Estimate, JsonError> {
        match self.exact.parse() {
            Ok(value) => Ok(singularity::Estimate { value, error: self.error }),
            Err(_) => unexpected("exact", "a fraction"),
        }
    }
}

impl Convergence {
    fn from_convergence(convergence: &solution::Convergence) -> Self {
        let nearest = &convergence.nearest;
        let [real, imaginary] = nearest.place.each_ref().map(Estimate::from_estimate);
        let powers = convergence.variable.factors().iter();
        Self {
            variable: named(powers.map(|(name, power)| (name, *power))),
            highest: convergence.highest,
            radius: Estimate::from_estimate(&nearest.radius),
            angle: Estimate::from_estimate(&nearest.angle),
            real,
            imaginary,
            exponent: nearest.exponent.as_ref().map(Estimate::from_estimate),
        }
    }

    fn read(&self, names: &DocumentNames) -> Result<solution::Convergence, JsonError> {
        let powers = self.variable.iter();
        Ok(solution::Convergence {
            variable: powers.fold(Monomial::one(), |product, (name, power)| {
                product.product(&Monomial::power_of(names.symbol(name), *power))
            }),
            highest: self.highest,
            nearest: Singularity {
                radius: self.radius.read()?,
                angle: self.angle.read()?,
                place: [self.real.read()?, self.imaginary.read()?],
                exponent: some(&self.exponent, Estimate::read)?,
            },
        })
    }
}

/// Algebraic equations for omega and the coefficients of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct System {
    /// What is solved for: `omega` and the coefficients; `verification.values` has their values.
    pub unknowns: Vec<String>,
    /// Expressions, each of which is zero.
    pub equations: Vec<String>,
}

/// A motion as a Fourier series with symbols in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Displacement {
    /// The name of the angle, `theta`, or `phi` where the equation has a `theta` of its own:
    /// theta = omega t + `verification.phase`, in radians.
    #[cfg_attr(feature = "schema", schemars(extend("pattern" = "^(theta|phi_*)$")))]
    pub variable: String,
    /// x = sum of cos * cos(harmonic theta) + sin * sin(harmonic theta), lowest harmonic first, the
    /// equilibrium in harmonic 0; empty where only `verification.motion` has the motion. Of a
    /// driven answer the part with the first harmonic: `response.motion` has the whole.
    pub harmonics: Vec<Harmonic>,
}

/// One harmonic of a motion with symbols in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Harmonic {
    /// The multiple of theta, 0 for the mean.
    pub harmonic: usize,
    /// The coefficient of the cosine, in the unit of the coordinate.
    pub cos: Polynomial,
    /// The coefficient of the sine, in the unit of the coordinate.
    pub sin: Polynomial,
}

/// The limit cycle that is expanded, among those of its equation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct LimitCycle {
    /// Its amplitude, as `amplitude` of the solution says, in the unit of the coordinate; to
    /// leading order where the motion is left out.
    pub amplitude: Polynomial,
    /// Which of the `cycles` it is, counted from one.
    pub number: usize,
    /// All limit cycles of the equation to leading order, smallest first.
    pub cycles: Vec<Cycle>,
    /// Parameters that are small together with the small parameter.
    pub small_with: Vec<String>,
}

/// A limit cycle to leading order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Cycle {
    /// Its amplitude where the small parameters vanish, in the unit of the coordinate.
    pub amplitude: Constant,
    /// An expression: where it is positive the cycle attracts, where it is negative it repels; null
    /// at a multiple root, where nothing is said.
    pub attracts_where_positive: Option<String>,
    /// The same in words.
    pub stability: String,
}

/// The slow equations of amplitude and phase, in time derivatives: the motion is `displacement`
/// with theta = phase, or for a driven motion theta = (times_driving * driving_frequency * t -
/// phase)/times_linear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Modulation {
    /// The symbol of the amplitude, in the unit of the coordinate.
    pub amplitude: String,
    /// The symbol of the phase, in radians.
    pub phase: String,
    /// The rate of the amplitude, an expression.
    pub amplitude_rate: String,
    /// The rate of the phase, an expression, in radians per unit of time.
    pub phase_rate: String,
    /// Parameters that are small together with the small parameter.
    pub small_with: Vec<String>,
    /// What a driving force is in resonance with; null for a free motion.
    pub resonance: Option<Resonance>,
    /// Where a motion released at rest from x = A begins; null for a driven motion.
    pub release: Option<Release>,
    /// The motion from a start in closed form; null where none is known.
    pub transient: Option<Transient>,
    /// The amplitudes other than zero that stay, smallest first.
    pub steady: Vec<Cycle>,
    /// Where `displacement` of the solution is the motion on a limit cycle: the motion from a
    /// start, with theta = phase; else null.
    #[serde(default)]
    pub motion: Option<Displacement>,
}

/// A driving frequency near a multiple of the linear one: times_driving * driving_frequency =
/// times_linear * omega0 + detuning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Resonance {
    /// The driving frequency, a symbol or a number.
    pub driving_frequency: String,
    /// How many times it is taken.
    pub times_driving: u32,
    /// How many times the linear frequency is taken.
    pub times_linear: u32,
    /// The symbol of the detuning.
    pub detuning: String,
    /// What the detuning stands for, an expression.
    pub detuning_means: String,
}

/// What is known of the steady motions of a driven equation. All formulas are in the amplitude and
/// the detuning of `modulation`, the parameters and the definitions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Response {
    /// x(t), an expression in t, the amplitude and the phase of `modulation`.
    pub motion: String,
    /// The frequency-response equation: a polynomial that is zero at every steady motion; null
    /// where the phase cannot be eliminated.
    pub relation: Option<Polynomial>,
    /// The relation solved for the detuning; null where it is not quadratic in that.
    pub branches: Option<Branches>,
    /// The largest amplitude of all detunings, an expression; null where it has no closed form.
    pub peak: Option<String>,
    /// The squares of the amplitudes at which two branches meet, expressions in the detuning; none
    /// where they have no closed form.
    pub folds: Vec<String>,
    /// The discriminant of the relation in the square of the amplitude, zero where two branches
    /// meet; null where it is not given.
    pub jumps: Option<Polynomial>,
    /// The same where they are no polynomials; null where they are.
    #[serde(default)]
    pub closed: Option<ClosedRelation>,
    /// The names of u = a cos(phase/m) and v = -a sin(phase/m), with m = times_linear; null where
    /// `rates` is.
    pub coordinates: Option<[String; 2]>,
    /// The rates of u and v, polynomials: the slow equations without a singular origin; null where
    /// they are no polynomials.
    pub rates: Option<[Polynomial; 2]>,
    /// The same by parts, each by its orders: what drains, what turns, and each wave of the phase;
    /// of each first what leads, then what comes one, two, ... orders later. Left out where each
    /// part has one order alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Vec<[Polynomial; 2]>>,
}

/// The frequency-response equation of a force that is no polynomial, expressions in the amplitude
/// and the detuning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ClosedRelation {
    /// Zero at every steady motion.
    pub relation: String,
    /// The middle of both branches of the detuning, the backbone.
    pub centre: String,
    /// The square of their distance from it.
    pub width_squared: String,
}

/// detuning = centre + sqrt(width_squared) and centre - sqrt(width_squared).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Branches {
    /// The middle of both branches, the backbone.
    pub centre: Polynomial,
    /// The square of their distance from it.
    pub width_squared: Polynomial,
}

/// Amplitude and phase at t = 0 of a motion with x = A from the equilibrium and x' = 0 there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Release {
    /// The amplitude, an expression.
    pub amplitude: String,
    /// The phase, an expression.
    pub phase: String,
}

/// A motion from its start in closed form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Transient {
    /// The symbol of the amplitude at t = 0: A, or one of `definitions`.
    pub start: String,
    /// The amplitude, an expression in t.
    pub amplitude: String,
    /// The phase, an expression in t; null where it has no closed form.
    pub phase: Option<String>,
    /// The time at which the amplitude reaches zero and stays, or grows without bound, an
    /// expression; null where the formulas hold for all times.
    pub ends: Option<String>,
}

/// The document of kind `solution`; `verification` is null unless the formula was judged.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = lindstedt::export::json::solution(&solution, None);
/// assert_eq!((document.schema.as_str(), document.order), ("lindstedt/solution/1", solution.order));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solution(
    solution: &Solution,
    verification: Option<&verify::Verification>,
) -> SolutionDocument {
    let _letters = solution.letters().in_force();
    let optional =
        |law: Option<&exact::Polynomial>| law.map(|law| Polynomial::from_polynomial(law, solution));
    SolutionDocument {
        schema: DocumentKind::Solution.schema().to_owned(),
        equation: solution.equation.to_string(),
        method: solution.method.name().to_owned(),
        order: solution.order,
        degrees: solution.degrees.map(Degrees::list),
        small_parameter: solution.small_parameter.to_string(),
        amplitude: solution.amplitude.name().to_owned(),
        parameters: texts(&solution.parameters),
        definitions: meanings(&solution.definitions),
        equilibrium: Constant::from_expr(&solution.equilibrium),
        frequency: optional(solution.law.frequency()),
        frequency_squared: optional(solution.law.frequency_squared()),
        relation: optional(solution.law.relation()),
        closed_form: text(solution.law.closed_form()),
        by_quadrature: solution.by_numbers(),
        system: solution.law.system().map(|system| System {
            unknowns: texts(&system.unknowns),
            equations: texts(&system.equations),
        }),
        displacement: displacement(&solution.displacement, solution),
        closed_motion: text(solution.closed_motion.as_ref()),
        limit_cycle: solution.limit_cycle.as_ref().map(|cycle| limit_cycle(cycle, solution)),
        modulation: solution.modulation.as_ref().map(|slow| modulation(slow, solution)),
        response: solution.response.as_ref().map(|response| self::response(response, solution)),
        numerical: solution.numerical,
        validity: texts(&solution.validity),
        convergence: solution.convergence.as_ref().map(Convergence::from_convergence),
        derivation: None,
        verification: verification.map(judged),
    }
}

/// A motion, harmonic by harmonic.
fn displacement(motion: &FourierSeries<Polynomials>, solution: &Solution) -> Displacement {
    let harmonic =
        |(harmonic, cosine, sine): (usize, exact::Polynomial, exact::Polynomial)| Harmonic {
            harmonic,
            cos: Polynomial::from_polynomial(&cosine, solution),
            sin: Polynomial::from_polynomial(&sine, solution),
        };
    Displacement {
        variable: solution.phase().to_string(),
        harmonics: motion.harmonics().into_iter().map(harmonic).collect(),
    }
}

/// The cycle of the solution and, to leading order, all of its equation.
fn limit_cycle(cycle: &solution::LimitCycle, solution: &Solution) -> LimitCycle {
    LimitCycle {
        amplitude: Polynomial::from_polynomial(&cycle.amplitude, solution),
        number: cycle.number,
        cycles: cycle.cycles.iter().map(self::cycle).collect(),
        small_with: texts(&cycle.small_with),
    }
}

/// An amplitude that stays, with its stability.
fn cycle(leading: &LeadingCycle) -> Cycle {
    Cycle {
        amplitude: Constant::from_expr(&leading.amplitude),
        attracts_where_positive: text(leading.attracts_where.as_ref()),
        stability: leading.stability(),
    }
}

/// The slow equations, with their solutions as far as they are known.
fn modulation(modulation: &solution::Modulation, solution: &Solution) -> Modulation {
    Modulation {
        amplitude: modulation.amplitude.to_string(),
        phase: modulation.phase.to_string(),
        amplitude_rate: modulation.amplitude_rate.to_string(),
        phase_rate: modulation.phase_rate.to_string(),
        small_with: texts(&modulation.small_with),
        resonance: modulation.resonance.as_ref().map(|resonance| Resonance {
            driving_frequency: resonance.driving_frequency.to_string(),
            times_driving: resonance.times_driving,
            times_linear: resonance.times_linear,
            detuning: resonance.detuning.symbol.to_string(),
            detuning_means: resonance.detuning.meaning.to_string(),
        }),
        release: modulation.release.as_ref().map(|release| Release {
            amplitude: release.amplitude.to_string(),
            phase: release.phase.to_string(),
        }),
        transient: modulation.transient.as_ref().map(|transient| Transient {
            start: transient.start.to_string(),
            amplitude: transient.amplitude.to_string(),
            phase: text(transient.phase.as_ref()),
            ends: text(transient.ends.as_ref()),
        }),
        steady: modulation.steady.iter().map(cycle).collect(),
        motion: modulation.motion.as_ref().map(|motion| displacement(motion, solution)),
    }
}

/// The steady motions of a driven equation in symbols.
fn response(response: &solution::Response, solution: &Solution) -> Response {
    let polynomial = |value: &exact::Polynomial| Polynomial::from_polynomial(value, solution);
    Response {
        motion: response.motion.to_string(),
        relation: response.relation.as_ref().map(polynomial),
        branches: response.branches.as_ref().map(|branches| Branches {
            centre: polynomial(&branches.centre),
            width_squared: polynomial(&branches.width_squared),
        }),
        peak: text(response.peak.as_ref()),
        folds: texts(&response.folds),
        jumps: response.jumps.as_ref().map(polynomial),
        closed: response.closed.as_ref().map(|closed| ClosedRelation {
            relation: closed.relation.to_string(),
            centre: closed.centre.to_string(),
            width_squared: closed.width_squared.to_string(),
        }),
        coordinates: response
            .plane
            .as_ref()
            .map(|plane| plane.coordinates.map(|name| name.to_string())),
        rates: response.plane.as_ref().map(|plane| plane.rates.each_ref().map(polynomial)),
        parts: response.plane.as_ref().map_or_else(Vec::new, |plane| {
            let orders = |part: &Vec<[exact::Polynomial; 2]>| {
                let orders = part.iter().map(|rates| rates.each_ref().map(polynomial));
                orders.collect()
            };
            plane.parts.iter().map(orders).collect()
        }),
    }
}

/// Reads what there is.
fn some<T, U>(
    found: &Option<T>,
    read: impl FnOnce(&T) -> Result<U, JsonError>,
) -> Result<Option<U>, JsonError> {
    found.as_ref().map(read).transpose()
}

/// Reads each of them.
fn all<T, U>(
    found: &[T],
    read: impl FnMut(&T) -> Result<U, JsonError>,
) -> Result<Vec<U>, JsonError> {
    found.iter().map(read).collect()
}

fn symbols(texts: &[String], names: &DocumentNames) -> Vec<Symbol> {
    texts.iter().map(|text| names.symbol(text)).collect()
}

impl SolutionDocument {
    /// The solution that the document describes; its `verification` and the derivation are left
    /// out.
    ///
    /// # Errors
    /// A document of another kind; a name, a fraction or an expression that is none.
    pub fn read(&self) -> Result<Solution, JsonError> {
        check_kind(&self.schema, DocumentKind::Solution)?;
        let method = Method::from_name(&self.method);
        let amplitude = AmplitudeConvention::from_name(&self.amplitude);
        let (Some(method), Some(amplitude)) = (method, amplitude) else {
            return unexpected(
                "method",
                "the name of a method, and `amplitude` that of a convention",
            );
        };
        let equation = parse_equation(&self.equation)
            .or_else(|_| unexpected("equation", "an equation of motion"))?;
        let time = Symbol::new("t");
        let own = self.parameters.iter().map(|name| Symbol::new(name));
        let driven = equation.left.contains(time) || equation.right.contains(time);
        let names = &DocumentNames::avoiding(own.chain([equation.coordinate]), driven);
        let definition = |(name, meaning): (&String, &String)| {
            Ok(Definition { symbol: names.symbol(name), meaning: names.expression(meaning, name)? })
        };
        Ok(Solution {
            equation: Equation {
                left: names.in_expression(equation.left, "equation")?,
                right: names.in_expression(equation.right, "equation")?,
                coordinate: names.symbol(equation.coordinate.name()),
                typed: equation.typed,
            },
            method,
            order: self.order,
            degrees: match self.degrees.as_deref().map(Degrees::from_list) {
                Some(None) => return unexpected("degrees", "those of an approximant"),
                degrees => degrees.flatten(),
            },
            small_parameter: names.symbol(&self.small_parameter),
            amplitude,
            parameters: symbols(&self.parameters, names),
            definitions: self
                .definitions
                .iter()
                .map(definition)
                .collect::<Result<_, JsonError>>()?,
            equilibrium: names.expression(&self.equilibrium.exact, "equilibrium")?,
            law: self.law(names)?,
            displacement: self.displacement.read(names)?,
            closed_motion: some(&self.closed_motion, |own| names.expression(own, "closed_motion"))?,
            limit_cycle: some(&self.limit_cycle, |own| own.read(names))?,
            modulation: some(&self.modulation, |own| own.read(names))?,
            response: some(&self.response, |own| own.read(names))?,
            numerical: self.numerical,
            validity: self.validity.iter().cloned().map(Note::Stated).collect(),
            convergence: some(&self.convergence, |own| own.read(names))?,
            steps: vec![],
            derivation: vec![],
        })
    }

    /// The law, of whose kinds a document holds one.
    fn law(&self, names: &DocumentNames) -> Result<Law, JsonError> {
        let optional = |law: &Option<Polynomial>, key| some(law, |law| names.polynomial(law, key));
        let frequency = optional(&self.frequency, "frequency")?;
        let squared = optional(&self.frequency_squared, "frequency_squared")?;
        let form = some(&self.closed_form, |text| closed_form(text, names))?;
        let system = some(&self.system, |own| own.read(names))?;
        Ok(match (optional(&self.relation, "relation")?, squared, frequency, form, system) {
            (Some(relation), squared, _, form, _) => Law::Relation {
                relation,
                root: squared.map(Root::Polynomial).or(form.map(Root::Closed)),
            },
            (None, Some(squared), frequency, ..) => Law::Series { squared, frequency },
            (None, None, Some(frequency), ..) => Law::Frequency(frequency),
            (None, None, None, Some(form), _) => Law::Closed(form),
            (None, None, None, None, Some(system)) => Law::System(system),
            (None, None, None, None, None) => {
                let lines = self.by_quadrature.as_deref().map(|text| text.split("; "));
                Law::Quadrature(lines.into_iter().flatten().map(DerivationLine::words).collect())
            }
        })
    }
}

/// `omega = ...` or `omega^2 = ...`.
fn closed_form(text: &str, names: &DocumentNames) -> Result<ClosedForm, JsonError> {
    let (squared, value) = match text.split_once(" = ") {
        Some((name, value)) if name == names.frequency() => (false, value),
        Some((name, value)) if name.strip_suffix("^2") == Some(names.frequency()) => (true, value),
        _ => return unexpected("closed_form", "`omega = ...` or `omega^2 = ...`"),
    };
    let value = names.expression(value, "closed_form")?;
    Ok(ClosedForm { squared, value })
}

impl System {
    fn read(&self, names: &DocumentNames) -> Result<solution::AlgebraicSystem, JsonError> {
        Ok(solution::AlgebraicSystem {
            unknowns: symbols(&self.unknowns, names),
            equations: all(&self.equations, |text| names.expression(text, "equations"))?,
        })
    }
}

impl LimitCycle {
    fn read(&self, names: &DocumentNames) -> Result<solution::LimitCycle, JsonError> {
        Ok(solution::LimitCycle {
            amplitude: names.polynomial(&self.amplitude, "limit_cycle")?,
            number: self.number,
            cycles: all(&self.cycles, |own| own.read(names))?,
            small_with: symbols(&self.small_with, names),
        })
    }
}

impl Cycle {
    fn read(&self, names: &DocumentNames) -> Result<LeadingCycle, JsonError> {
        Ok(LeadingCycle {
            amplitude: names.expression(&self.amplitude.exact, "amplitude")?,
            attracts_where: some(&self.attracts_where_positive, |text| {
                names.expression(text, "attracts_where_positive")
            })?,
        })
    }
}

impl Response {
    fn read(&self, names: &DocumentNames) -> Result<solution::Response, JsonError> {
        let polynomial = |value: &Polynomial, key| names.polynomial(value, key);
        let both = |[u, v]: &[Polynomial; 2], key| Ok([polynomial(u, key)?, polynomial(v, key)?]);
        let expression = |text: &String, key| names.expression(text, key);
        let plane = |(coordinates, rates): &(&[String; 2], &[Polynomial; 2])| {
            Ok(solution::response::Plane {
                coordinates: coordinates.each_ref().map(|name| names.symbol(name)),
                rates: both(rates, "rates")?,
                parts: all(&self.parts, |part| all(part, |rates| both(rates, "parts")))?,
            })
        };
        Ok(solution::Response {
            motion: expression(&self.motion, "motion")?,
            relation: some(&self.relation, |own| polynomial(own, "relation"))?,
            branches: some(&self.branches, |own| {
                Ok(solution::response::Branches {
                    centre: polynomial(&own.centre, "centre")?,
                    width_squared: polynomial(&own.width_squared, "width_squared")?,
                })
            })?,
            peak: some(&self.peak, |own| expression(own, "peak"))?,
            folds: all(&self.folds, |own| expression(own, "folds"))?,
            jumps: some(&self.jumps, |own| polynomial(own, "jumps"))?,
            closed: some(&self.closed, |own| {
                Ok(solution::response::ClosedRelation {
                    relation: expression(&own.relation, "relation")?,
                    centre: expression(&own.centre, "centre")?,
                    width_squared: expression(&own.width_squared, "width_squared")?,
                })
            })?,
            plane: some(&self.coordinates.as_ref().zip(self.rates.as_ref()), plane)?,
        })
    }
}

impl Modulation {
    fn read(&self, names: &DocumentNames) -> Result<solution::Modulation, JsonError> {
        let expression = |text: &String, key| names.expression(text, key);
        Ok(solution::Modulation {
            amplitude: names.symbol(&self.amplitude),
            phase: names.symbol(&self.phase),
            amplitude_rate: expression(&self.amplitude_rate, "amplitude_rate")?,
            phase_rate: expression(&self.phase_rate, "phase_rate")?,
            small_with: symbols(&self.small_with, names),
            resonance: some(&self.resonance, |own| {
                Ok(modulation::Resonance {
                    driving_frequency: expression(&own.driving_frequency, "driving_frequency")?,
                    times_driving: own.times_driving,
                    times_linear: own.times_linear,
                    detuning: Definition {
                        symbol: names.symbol(&own.detuning),
                        meaning: expression(&own.detuning_means, "detuning_means")?,
                    },
                })
            })?,
            release: some(&self.release, |own| {
                Ok(modulation::Release {
                    amplitude: expression(&own.amplitude, "amplitude")?,
                    phase: expression(&own.phase, "phase")?,
                })
            })?,
            transient: some(&self.transient, |own| {
                Ok(modulation::Transient {
                    start: names.symbol(&own.start),
                    amplitude: expression(&own.amplitude, "amplitude")?,
                    phase: some(&own.phase, |text| expression(text, "phase"))?,
                    ends: some(&own.ends, |text| expression(text, "ends"))?,
                })
            })?,
            steady: all(&self.steady, |own| own.read(names))?,
            motion: some(&self.motion, |own| own.read(names))?,
        })
    }
}

impl Displacement {
    fn read(&self, names: &DocumentNames) -> Result<FourierSeries<Polynomials>, JsonError> {
        /// Largest number of a harmonic in a document: a hostile one must not fill the memory.
        const HIGHEST_HARMONIC: usize = 100_000;
        let length = self
            .harmonics
            .iter()
            .map(|entry| entry.harmonic)
            .max()
            .map_or(0, |k| k.saturating_add(1));
        if length > HIGHEST_HARMONIC + 1 {
            return unexpected("harmonic", "a whole number up to 100000");
        }
        let mut cosine = vec![exact::Polynomial::zero(); length];
        let mut sine = cosine.clone();
        for entry in &self.harmonics {
            cosine[entry.harmonic] = names.polynomial(&entry.cos, "cos")?;
            sine[entry.harmonic] = names.polynomial(&entry.sin, "sin")?;
        }
        Ok(FourierSeries::from_parts(POLYNOMIALS, cosine, sine))
    }
}
