//! Single values of a claims file: expressions, equations, methods, verdicts, each with its
//! position for messages.

use super::{Mistake, NamedValues, ReadResult, Text, helped, mistake};
use crate::audit::claim::{ClaimEquation, Verdict};
use crate::audit::printed::Rounding;
use crate::catalog;
use crate::expr::{Expr, ParseError, parse_expression};
use crate::impact::Rule;
use crate::modes::FreeSystem;
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Method};
use crate::spelling::nearest;
use crate::symbol::Symbol;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

pub(super) fn table(table: &NamedValues) -> ReadResult<BTreeMap<Symbol, Expr>> {
    let row = |(name, value): (&String, &Spanned<toml::Value>)| {
        Ok((symbol(name, value.span())?, number(value.get_ref(), value.span())?))
    };
    table.iter().map(row).collect()
}

pub(super) fn symbol(name: &str, span: Range<usize>) -> ReadResult<Symbol> {
    let found = parse_expression(name).ok().and_then(|name| name.as_symbol());
    match found.filter(|symbol| symbol.name() == name) {
        Some(symbol) => Ok(symbol),
        None => {
            mistake(span, format!("`{name}` is no name: letters, digits and `_`, a letter first"))
        }
    }
}

/// A number or a formula, exactly as it is typed.
pub(super) fn number(value: &toml::Value, span: Range<usize>) -> ReadResult<Expr> {
    match value {
        toml::Value::String(text) => parsed(text, span),
        toml::Value::Integer(number) => parsed(&number.to_string(), span),
        toml::Value::Float(number) if number.is_finite() => parsed(&number.to_string(), span),
        _ => mistake(span, "expected a number, or a formula in quotes"),
    }
}

pub(super) fn expression(text: &Text) -> ReadResult<Expr> {
    parsed(text.get_ref(), text.span())
}

pub(super) fn parsed(text: &str, span: Range<usize>) -> ReadResult<Expr> {
    parse_expression(text).map_err(|ParseError { message, help, .. }| Mistake {
        span,
        what: message,
        help,
    })
}

/// A formula, or the difference of the sides of an equation.
pub(super) fn equal_to_zero(text: &Text) -> ReadResult<Expr> {
    match text.get_ref().split_once('=') {
        None => expression(text),
        Some((left, right)) => Ok(&parsed(left, text.span())? - &parsed(right, text.span())?),
    }
}

/// The equation of a claim, or the mode of this number of coupled ones.
pub(super) fn equation(text: &Text, mode: Option<&Spanned<usize>>) -> ReadResult<ClaimEquation> {
    let entry = catalog::find(text.get_ref());
    if entry.is_some_and(|entry| !entry.walls.is_empty()) {
        let name = text.get_ref();
        return helped(
            text.span(),
            format!("`{name}` meets rigid walls, across which no claim is judged"),
            "write the equation alone to judge a claim about the motion between impacts".to_owned(),
        );
    }
    let equation = entry.map_or(text.get_ref().as_str(), |entry| entry.equation);
    // The picture of the position in an error refers to the text alone, so that it is left out.
    let refused = |error: &dyn std::fmt::Display| {
        mistake(text.span(), error.to_string().lines().next().unwrap_or_default())
    };
    if !equation.contains(['=', '\'']) {
        let near = nearest(equation, catalog::CATALOG.iter().map(|entry| entry.name));
        return helped(
            text.span(),
            format!("`{equation}` is no equation, and no name of the catalogue"),
            near.map_or_else(
                || "`lindstedt catalog` lists the names".to_owned(),
                |near| format!("did you mean `{near}`?"),
            ),
        );
    }
    match (equation.contains(';'), mode) {
        (false, None) => match Oscillator::parse(equation) {
            Ok(oscillator) => Ok(ClaimEquation::One(oscillator)),
            Err(error) => refused(&error),
        },
        (true, Some(number)) => match FreeSystem::parse(equation) {
            Ok(system) => {
                Ok(ClaimEquation::Mode { system: Box::new(system), number: *number.get_ref() })
            }
            Err(error) => refused(&error),
        },
        (false, Some(number)) => {
            mistake(number.span(), "`mode` says nothing here: one coordinate has one mode")
        }
        (true, None) => {
            helped(text.span(), "coupled equations have several modes", "mode = 1 is the slowest")
        }
    }
}

pub(super) fn method(text: &Text) -> ReadResult<Method> {
    let name = text.get_ref();
    Method::from_name(name).ok_or_else(|| {
        let near = nearest(name, Method::ALL.map(Method::name));
        Mistake {
            span: text.span(),
            what: format!("unknown method `{name}`"),
            help: Some(match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("choose {}", Method::ALL.map(Method::name).join(", ")),
            }),
        }
    })
}

pub(super) fn convention(text: &Text) -> ReadResult<AmplitudeConvention> {
    match AmplitudeConvention::from_name(text.get_ref()) {
        Some(convention) => Ok(convention),
        None => mistake(
            text.span(),
            format!("unknown amplitude `{}`: choose initial or first-harmonic", text.get_ref()),
        ),
    }
}

pub(super) fn rule(text: &Text) -> ReadResult<Rule> {
    text.get_ref().parse().or_else(|error| mistake(text.span(), format!("{error}")))
}

pub(super) fn rounding(text: &Text) -> ReadResult<Rounding> {
    match Rounding::from_name(text.get_ref()) {
        Some(rounding) => Ok(rounding),
        None => {
            let known = Rounding::ALL.map(Rounding::name).join(", ");
            mistake(text.span(), format!("unknown rounding `{}`: choose {known}", text.get_ref()))
        }
    }
}

pub(super) fn verdict(text: &Text) -> ReadResult<Verdict> {
    match Verdict::from_name(text.get_ref()) {
        Some(verdict) => Ok(verdict),
        None => {
            let known = Verdict::ALL.map(Verdict::name).join(", ");
            mistake(text.span(), format!("unknown verdict `{}`: choose {known}", text.get_ref()))
        }
    }
}

pub(super) fn tolerance(number: &Spanned<f64>) -> ReadResult<f64> {
    let value = *number.get_ref();
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => mistake(number.span(), format!("a tolerance is a positive number, not {value}")),
    }
}
