//! JSON documents: exact fractions as strings beside decimals, lowest order first, and the way back.
//!
//! ```text
//! number       {"exact": "-1/8", "value": -0.125}
//! polynomial   {"terms": [{"monomial": {"A": 2}, "exact": "-1/8", "value": -0.125}, ...]}
//! ```

use num_complex::Complex64;
use num_traits::{One, Zero};
use serde_json::{Map, Value, json};

use crate::contact::phases::{Column, Form, Phase, ThreePhases};
use crate::contact::true_motion::Deviation;
use crate::derivation::Line;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Polynomial, Rational};
use crate::expr::{Expr, parse_expression};
use crate::impact::{Impact, Setup};
use crate::series::FourierSeries;
use crate::solution::{
    AmplitudeConvention, ClosedForm, Definition, Law, LeadingCycle, LimitCycle, Method, Root, Solution, System,
};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::comparison::{Comparison, Refused, Row};
use crate::verify::validity::Reach;
use crate::verify::{Verdict, Verification};

/// Why a document is no solution.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum JsonError {
    /// A key is missing or holds something else.
    #[error("`{key}` should hold {expected}")]
    Unexpected {
        /// The key.
        key: String,
        /// What belongs there.
        expected: &'static str,
    },
}

fn unexpected<T>(key: &str, expected: &'static str) -> Result<T, JsonError> {
    Err(JsonError::Unexpected {
        key: key.to_owned(),
        expected,
    })
}

/// A number that may be infinite or undefined only by mistake, in which case it is null.
pub fn number(value: f64) -> Value {
    json!(value)
}

/// An exact fraction beside its decimal value.
pub fn fraction(value: &Rational) -> Value {
    json!({ "exact": value.to_string(), "value": to_f64(value) })
}

/// An exact constant expression, `3/2` or `pi/3`, beside its decimal value.
pub fn constant(value: &Expr) -> Value {
    let decimal = value
        .as_number()
        .map(to_f64)
        .or_else(|| value.evaluate(&[].into()).ok());
    json!({ "exact": value.to_string(), "value": decimal })
}

/// A polynomial, lowest order in the small parameters of `solution` first.
fn polynomial(polynomial: &Polynomial, solution: &Solution) -> Value {
    let mut terms: Vec<_> = polynomial.terms().collect();
    terms.sort_by_key(|(monomial, _)| solution.order_of(monomial));
    let term = |(monomial, coefficient): (&Monomial, &Rational)| {
        let powers: Map<String, Value> = monomial
            .factors()
            .iter()
            .map(|(symbol, exponent)| (symbol.to_string(), json!(exponent)))
            .collect();
        json!({ "monomial": powers, "exact": coefficient.to_string(), "value": to_f64(coefficient) })
    };
    json!({ "terms": terms.into_iter().map(term).collect::<Vec<_>>() })
}

/// The document of kind `solution`; `verification` is null unless the formula was judged.
pub fn solution(solution: &Solution, verification: Option<&Verification>) -> Value {
    let small = solution.small_parameter;
    let optional = |law: Option<&Polynomial>| law.map(|law| polynomial(law, solution));
    let harmonic = |(k, cosine, sine): (usize, Polynomial, Polynomial)| json!({ "harmonic": k, "cos": polynomial(&cosine, solution), "sin": polynomial(&sine, solution) });
    let names: Vec<&str> = solution.parameters.iter().map(|name| name.name()).collect();
    let definitions: Map<String, Value> = solution
        .definitions
        .iter()
        .map(|definition| (definition.symbol.to_string(), json!(definition.meaning.to_string())))
        .collect();
    json!({
        "schema": "lindstedt/solution/1",
        "equation": solution.equation,
        "method": solution.method.name(),
        "order": solution.order,
        "degrees": solution.degrees.map(|(numerator, denominator)| json!([numerator, denominator])),
        "small_parameter": small.name(),
        "amplitude": solution.amplitude.name(),
        "parameters": names,
        "definitions": definitions,
        "equilibrium": constant(&solution.equilibrium),
        "frequency": optional(solution.law.frequency()),
        "frequency_squared": optional(solution.law.frequency_squared()),
        "relation": optional(solution.law.relation()),
        "closed_form": solution.law.closed_form().map(ToString::to_string),
        "by_quadrature": solution.by_numbers(),
        "system": solution.law.system().map(system),
        "displacement": {
            "variable": "theta",
            "harmonics": solution.displacement.harmonics().into_iter().map(harmonic).collect::<Vec<_>>(),
        },
        "limit_cycle": solution.limit_cycle.as_ref().map(|cycle| limit_cycle(cycle, solution)),
        "modulation": null,
        "response": null,
        "numerical": solution.numerical,
        "validity": solution.validity,
        "verification": verification.map(self::verification),
    })
}

/// The cycle of the solution and, to leading order, all of its equation.
fn limit_cycle(cycle: &LimitCycle, solution: &Solution) -> Value {
    let leading = |leading: &LeadingCycle| {
        json!({
            "amplitude": constant(&leading.amplitude),
            "attracts_where_positive": leading.attracts_where.as_ref().map(ToString::to_string),
            "stability": leading.stability(),
        })
    };
    let small_with: Vec<&str> = cycle.small_with.iter().map(|name| name.name()).collect();
    json!({
        "amplitude": polynomial(&cycle.amplitude, solution),
        "number": cycle.number,
        "cycles": cycle.cycles.iter().map(leading).collect::<Vec<_>>(),
        "small_with": small_with,
    })
}

/// The verdict on a formula.
pub fn verification(verification: &Verification) -> Value {
    json!({
        "at": values(&verification.at),
        "frequency": verification.frequency,
        "reason": verification.reason,
        "true_frequency": verification.true_frequency,
        "relative_error": verification.relative_error,
        "judged_on": verification.judged_on,
        "error_of_omega": verification.error_of_omega,
        "max_deviation": verification.max_deviation,
        "residual": verification.residual,
        "slope": verification.slope,
        "ranges": verification.ranges.iter().map(|range| json!({ "text": range.text, "outside": range.outside })).collect::<Vec<_>>(),
        "chosen": verification.chosen.iter().map(|(name, value)| (name.to_string(), json!(value))).collect::<Map<_, _>>(),
        "verdict": verdict(verification.verdict),
    })
}

/// The document of kind `comparison`.
pub fn comparison(comparison: &Comparison) -> Value {
    let applies = |row: &Row| {
        json!({
            "method": row.solution.method.name(),
            "order": row.solution.order,
            "degrees": row.solution.degrees.map(|(numerator, denominator)| json!([numerator, denominator])),
            "applies": true,
            "reason": row.reason,
            "chosen": row.chosen.iter().map(|(name, value)| (name.to_string(), json!(value))).collect::<Map<_, _>>(),
            "formula": row.solution.formula(),
            "frequency": row.frequency,
            "relative_error": row.relative_error,
            "max_deviation": row.max_deviation,
            "reach": row.reach.map(reach),
            "verdict": row.verdict.map(verdict),
        })
    };
    let refused = |refused: &Refused| {
        json!({
            "method": refused.method.name(),
            "order": null,
            "applies": false,
            "reason": refused.reason.to_string(),
            "formula": null,
            "frequency": null,
            "relative_error": null,
            "max_deviation": null,
            "reach": null,
            "verdict": null,
        })
    };
    let rows = comparison.rows.iter().map(applies);
    json!({
        "schema": "lindstedt/comparison/1",
        "equation": comparison.equation,
        "at": values(&comparison.at),
        "true_frequency": comparison.true_frequency,
        "reason": comparison.reason,
        "tolerance": comparison.tolerance,
        "methods": rows.chain(comparison.refused.iter().map(refused)).collect::<Vec<_>>(),
        "validity": comparison.validity,
    })
}

/// How far a formula is good: `up_to` is null where its error stayed small as far as was searched.
fn reach(reach: Reach) -> Value {
    let searched = match reach {
        Reach::Everywhere(searched) => Some(searched),
        Reach::UpTo(_) | Reach::Nowhere => None,
    };
    json!({ "up_to": reach.end(), "searched": searched })
}

/// `"pass"` or `"fail"`.
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
    }
}

fn values(values: &Values) -> Value {
    values
        .iter()
        .map(|(name, value)| (name.to_string(), constant(value)))
        .collect::<Map<_, _>>()
        .into()
}

/// The document of kind `impact`.
pub fn impact(impact: &Impact, tolerance: f64) -> Value {
    let Setup {
        amplitude,
        barrier,
        stiffness,
        stiffness_source,
        order,
        rule,
        integrator_tolerance,
        step_limit: _,
    } = &impact.setup;
    let [to_contact, speed, penetration, duration, period] = impact.quantities().map(|quantity| {
        json!({
            "paper": quantity.paper,
            "energy": quantity.energy,
            "runge_kutta": quantity.runge_kutta,
            "paper_error": quantity.paper_error(),
            "energy_error": quantity.energy_error(),
        })
    });
    let column = |phases: &ThreePhases, deviation: &Deviation| {
        json!({
            "velocity_jump": phases.velocity_jump,
            "line": { "slope": phases.line.slope, "constant": -phases.line.q(*barrier) },
            "max_deviation": deviation.total / amplitude,
            "max_deviation_by_phase": deviation.phases.map(|largest| largest / amplitude),
            "verdict": verdict(impact.verdict(phases.column, tolerance)),
        })
    };
    json!({
        "schema": "lindstedt/impact/1",
        "equation": impact.equation,
        "parameters": {
            "amplitude": amplitude,
            "barrier": barrier,
            "gamma": stiffness,
            "gamma_source": stiffness_source,
            "order": order,
            "linearisation": rule.name(),
            "integrator_tolerance": integrator_tolerance,
        },
        "law": solution(&impact.free_swing, None),
        "frequency": impact.frequency(),
        "phases": impact.paper.phases.iter().map(phase).collect::<Vec<_>>(),
        "energy_phases": impact.energy.phases.iter().map(phase).collect::<Vec<_>>(),
        "contact": { "speed": speed, "penetration": penetration, "duration": duration },
        "time_to_contact": to_contact,
        "period": period,
        "verification": {
            "tolerance": tolerance,
            "energy_drift": impact.truth.energy_drift,
            "paper": column(&impact.paper, &impact.paper_deviation),
            "energy": column(&impact.energy, &impact.energy_deviation),
            "verdict": verdict(impact.verdict(Column::Paper, tolerance)),
        },
    })
}

fn phase(phase: &Phase) -> Value {
    let coefficients = match phase.form {
        Form::Cosine {
            amplitude,
            frequency,
            phase,
        } => {
            json!({ "amplitude": amplitude, "frequency": frequency, "phase": phase })
        }
        Form::Oscillation {
            centre,
            amplitude,
            frequency,
        } => json!({
            "centre": centre,
            "amplitude": { "re": amplitude.re, "im": amplitude.im },
            "frequency": frequency,
        }),
    };
    let state = |elapsed: f64| {
        let (x, velocity) = phase.form.at(elapsed);
        json!({ "x": x, "velocity": velocity })
    };
    json!({
        "name": phase.name,
        "start": phase.start,
        "end": phase.end,
        "start_state": state(0.0),
        "end_state": state(phase.end - phase.start),
        "closed_form": phase.closed_form(),
        "coefficients": coefficients,
    })
}

/// Reads the three phases of a document of kind `impact` back.
///
/// # Errors
/// A key that is missing or holds something else.
pub fn read_phases(document: &Value) -> Result<Vec<Phase>, JsonError> {
    if text(document, "schema")? != "lindstedt/impact/1" {
        return unexpected("schema", "\"lindstedt/impact/1\"");
    }
    let Some(list) = document["phases"].as_array() else {
        return unexpected("phases", "a list");
    };
    let number = |value: &Value, key: &str| value[key].as_f64().map_or_else(|| unexpected(key, "a number"), Ok);
    let read = |value: &Value| {
        let name = text(value, "name")?;
        let Some(name) = ["approach", "contact", "return"]
            .into_iter()
            .find(|known| *known == name)
        else {
            return unexpected("name", "approach, contact or return");
        };
        let coefficients = &value["coefficients"];
        let frequency = number(coefficients, "frequency")?;
        let form = match coefficients.get("centre") {
            None => Form::Cosine {
                amplitude: number(coefficients, "amplitude")?,
                frequency,
                phase: number(coefficients, "phase")?,
            },
            Some(_) => {
                let amplitude = &coefficients["amplitude"];
                let amplitude = Complex64::new(number(amplitude, "re")?, number(amplitude, "im")?);
                Form::Oscillation {
                    centre: number(coefficients, "centre")?,
                    amplitude,
                    frequency,
                }
            }
        };
        Ok(Phase {
            name,
            start: number(value, "start")?,
            end: number(value, "end")?,
            form,
        })
    };
    list.iter().map(read).collect()
}

/// Reads a document of kind `solution` back; its `verification` is left out.
///
/// # Errors
/// A key that is missing or holds something else.
pub fn read_solution(document: &Value) -> Result<Solution, JsonError> {
    if text(document, "schema")? != "lindstedt/solution/1" {
        return unexpected("schema", "\"lindstedt/solution/1\"");
    }
    let method = Method::from_name(text(document, "method")?);
    let amplitude = AmplitudeConvention::from_name(text(document, "amplitude")?);
    let (Some(method), Some(amplitude)) = (method, amplitude) else {
        return unexpected("method", "the name of a method, and `amplitude` that of a convention");
    };
    let order = document["order"].as_u64().and_then(|order| u32::try_from(order).ok());
    let strings = |key: &'static str| -> Result<Vec<String>, JsonError> {
        let list = document[key]
            .as_array()
            .map(|list| list.iter().map(|item| item.as_str().map(str::to_owned)));
        list.and_then(Iterator::collect)
            .map_or_else(|| unexpected(key, "a list of strings"), Ok)
    };
    let limit_cycle = match &document["limit_cycle"] {
        Value::Null => None,
        value => Some(read_limit_cycle(value)?),
    };
    Ok(Solution {
        equation: text(document, "equation")?.to_owned(),
        method,
        order: order.map_or_else(|| unexpected("order", "a whole number"), Ok)?,
        degrees: read_degrees(&document["degrees"])?,
        small_parameter: Symbol::new(text(document, "small_parameter")?),
        amplitude,
        parameters: strings("parameters")?.iter().map(|name| Symbol::new(name)).collect(),
        definitions: read_definitions(&document["definitions"])?,
        equilibrium: expression(text(&document["equilibrium"], "exact")?, "equilibrium")?,
        law: read_law(document)?,
        displacement: read_displacement(&document["displacement"]["harmonics"])?,
        limit_cycle,
        numerical: document["numerical"].as_bool().unwrap_or(false),
        validity: strings("validity")?,
        steps: vec![],
        derivation: vec![],
    })
}

/// The law, of whose kinds a document holds one.
fn read_law(document: &Value) -> Result<Law, JsonError> {
    let optional = |key: &str| match &document[key] {
        Value::Null => Ok(None),
        value => read_polynomial(value, key).map(Some),
    };
    let (frequency, squared) = (optional("frequency")?, optional("frequency_squared")?);
    let form = read_closed_form(&document["closed_form"])?;
    let system = read_system(&document["system"])?;
    Ok(match (optional("relation")?, squared, frequency, form, system) {
        (Some(relation), squared, _, form, _) => Law::Relation {
            relation,
            root: squared.map(Root::Polynomial).or(form.map(Root::Closed)),
        },
        (None, Some(squared), frequency, ..) => Law::Series { squared, frequency },
        (None, None, Some(frequency), ..) => Law::Frequency(frequency),
        (None, None, None, Some(form), _) => Law::Closed(form),
        (None, None, None, None, Some(system)) => Law::System(system),
        (None, None, None, None, None) => {
            let lines = document["by_quadrature"].as_str().map(|text| text.split("; "));
            Law::Quadrature(lines.into_iter().flatten().map(Line::words).collect())
        }
    })
}

fn read_limit_cycle(value: &Value) -> Result<LimitCycle, JsonError> {
    let leading = |value: &Value| {
        let attracts_where = value["attracts_where_positive"].as_str();
        Ok(LeadingCycle {
            amplitude: expression(text(&value["amplitude"], "exact")?, "amplitude")?,
            attracts_where: attracts_where
                .map(|text| expression(text, "attracts_where_positive"))
                .transpose()?,
        })
    };
    let list = |key: &'static str| value[key].as_array().map_or_else(|| unexpected(key, "a list"), Ok);
    let symbol = |value: &Value| match value.as_str() {
        Some(name) => Ok(Symbol::new(name)),
        None => unexpected("small_with", "a list of strings"),
    };
    let number = value["number"].as_u64().and_then(|number| usize::try_from(number).ok());
    Ok(LimitCycle {
        amplitude: read_polynomial(&value["amplitude"], "limit_cycle")?,
        number: number.map_or_else(|| unexpected("number", "a whole number"), Ok)?,
        cycles: list("cycles")?.iter().map(leading).collect::<Result<_, JsonError>>()?,
        small_with: list("small_with")?
            .iter()
            .map(symbol)
            .collect::<Result<_, JsonError>>()?,
    })
}

fn read_degrees(value: &Value) -> Result<Option<(u32, u32)>, JsonError> {
    if value.is_null() {
        return Ok(None);
    }
    let degree = |index: usize| value[index].as_u64().and_then(|degree| u32::try_from(degree).ok());
    match (degree(0), degree(1)) {
        (Some(numerator), Some(denominator)) => Ok(Some((numerator, denominator))),
        _ => unexpected("degrees", "two whole numbers"),
    }
}

fn read_closed_form(value: &Value) -> Result<Option<ClosedForm>, JsonError> {
    let Some(text) = value.as_str() else {
        return Ok(None);
    };
    let (squared, value) = match text.split_once(" = ") {
        Some(("omega^2", value)) => (true, value),
        Some(("omega", value)) => (false, value),
        _ => return unexpected("closed_form", "`omega = ...` or `omega^2 = ...`"),
    };
    let value = expression(value, "closed_form")?;
    Ok(Some(ClosedForm { squared, value }))
}

fn read_system(value: &Value) -> Result<Option<System>, JsonError> {
    if value.is_null() {
        return Ok(None);
    }
    let list = |key: &'static str| -> Result<Vec<&str>, JsonError> {
        let list = value[key]
            .as_array()
            .map(|list| list.iter().map(Value::as_str).collect());
        list.flatten().map_or_else(|| unexpected(key, "a list of strings"), Ok)
    };
    let equations = list("equations")?.into_iter();
    Ok(Some(System {
        unknowns: list("unknowns")?.into_iter().map(Symbol::new).collect(),
        equations: equations
            .map(|text| expression(text, "equations"))
            .collect::<Result<_, _>>()?,
    }))
}

/// The equations of a balance, each equal to zero.
fn system(system: &System) -> Value {
    let unknowns: Vec<&str> = system.unknowns.iter().map(|name| name.name()).collect();
    let equations: Vec<String> = system.equations.iter().map(ToString::to_string).collect();
    json!({ "unknowns": unknowns, "equations": equations })
}

fn text<'a>(document: &'a Value, key: &str) -> Result<&'a str, JsonError> {
    document[key].as_str().map_or_else(|| unexpected(key, "a string"), Ok)
}

fn expression(text: &str, key: &str) -> Result<Expr, JsonError> {
    parse_expression(text).or_else(|_| unexpected(key, "an expression"))
}

fn read_definitions(value: &Value) -> Result<Vec<Definition>, JsonError> {
    let Some(entries) = value.as_object() else {
        return unexpected("definitions", "an object");
    };
    let definition = |(name, meaning): (&String, &Value)| {
        let Some(meaning) = meaning.as_str() else {
            return unexpected(name, "an expression");
        };
        Ok(Definition {
            symbol: Symbol::new(name),
            meaning: expression(meaning, name)?,
        })
    };
    entries.iter().map(definition).collect()
}

fn read_polynomial(value: &Value, key: &str) -> Result<Polynomial, JsonError> {
    let Some(terms) = value["terms"].as_array() else {
        return unexpected(key, "a polynomial");
    };
    let mut polynomial = Polynomial::zero();
    for term in terms {
        let coefficient = term["exact"].as_str().and_then(|exact| exact.parse::<Rational>().ok());
        let (Some(coefficient), Some(powers)) = (coefficient, term["monomial"].as_object()) else {
            return unexpected(key, "a polynomial");
        };
        let mut monomial = Monomial::one();
        for (name, exponent) in powers {
            let Some(exponent) = exponent.as_i64().and_then(|exponent| i32::try_from(exponent).ok()) else {
                return unexpected(key, "whole exponents");
            };
            monomial = monomial.product(&Monomial::power_of(Symbol::new(name), exponent));
        }
        polynomial.add_term(monomial, coefficient);
    }
    Ok(polynomial)
}

fn read_displacement(harmonics: &Value) -> Result<FourierSeries<Polynomial>, JsonError> {
    /// No document of ours comes near it; a hostile one must not fill the memory.
    const HIGHEST_HARMONIC: u64 = 100_000;
    let Some(list) = harmonics.as_array() else {
        return unexpected("displacement", "a list of harmonics");
    };
    let (mut cosine, mut sine) = (vec![], vec![]);
    for harmonic in list {
        let Some(k) = harmonic["harmonic"].as_u64().filter(|&k| k <= HIGHEST_HARMONIC) else {
            return unexpected("harmonic", "a whole number");
        };
        let k = k as usize;
        cosine.resize(cosine.len().max(k + 1), Polynomial::zero());
        sine.resize(sine.len().max(k + 1), Polynomial::zero());
        cosine[k] = read_polynomial(&harmonic["cos"], "cos")?;
        sine[k] = read_polynomial(&harmonic["sin"], "sin")?;
    }
    Ok(FourierSeries::from_parts(cosine, sine, Integer::one()))
}
