//! Files of claims, in TOML: `docs/audit.md` explains each key.
//!
//! In: the text of a file. Out: [`Claims`], or the first mistake with its line and a caret below
//! its place. A key without effect on its claim is refused by name.

mod keys;
mod names;
mod values;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::str::FromStr;

use serde::Deserialize;
use toml::Spanned;

use super::claim::{
    Claim, ClaimComputation, ClaimQuantity, PrintedEntry, PrintedStatement, Supposition, Trend,
    Unknown,
};
use super::printed::Printed;
use super::{Claims, MOST_COMBINATIONS, identity, options};
use crate::decimal::decimal;
use crate::exact::Rational;
use crate::expr::Expr;
use crate::method::Options;
use crate::problem::{LARGEST_FILE, Order, ProblemError, at_place, in_words, too_large};
use crate::spelling::nearest;
use crate::symbol::Symbol;

use keys::{check_keys, kind};
use names::{check_names, check_values};
use values::{
    convention, equal_to_zero, equation, expression, method, number, parsed, rounding, rule,
    symbol, table, tolerance, verdict,
};

/// An error in the file and its position.
struct Mistake {
    span: Range<usize>,
    what: String,
    help: Option<String>,
}

type ReadResult<T> = Result<T, Mistake>;

fn mistake<T>(span: Range<usize>, what: impl Into<String>) -> ReadResult<T> {
    Err(Mistake { span, what: what.into(), help: None })
}

fn helped<T>(
    span: Range<usize>,
    what: impl Into<String>,
    help: impl Into<String>,
) -> ReadResult<T> {
    Err(Mistake { span, what: what.into(), help: Some(help.into()) })
}

impl FromStr for Claims {
    type Err = ProblemError;

    fn from_str(text: &str) -> Result<Self, ProblemError> {
        if text.len() > LARGEST_FILE {
            return Err(too_large());
        }
        let text = text.trim_start_matches('\u{feff}');
        let document: Document = toml::from_str(text).map_err(|error| in_words(text, &error))?;
        let claims = read(document)
            .map_err(|Mistake { span, what, help }| at_place(text, &span, &what).with_help(help))?;
        claims.ok_or_else(|| {
            ProblemError::new(
                "there is no claim: give each as [[claim]] with an id, a quantity and what is printed",
            )
        })
    }
}

/// Names with their values.
type NamedValues = BTreeMap<String, Spanned<toml::Value>>;
type Text = Spanned<String>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    title: String,
    #[serde(default)]
    values: NamedValues,
    #[serde(default)]
    claim: Vec<Section>,
}

/// A `[[claim]]` as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    id: Text,
    #[serde(rename = "where", default)]
    place: String,
    #[serde(default)]
    says: String,
    quantity: Option<Text>,
    formula: Option<Text>,
    kinetic: Option<Text>,
    potential: Option<Text>,
    force: Option<Text>,
    of: Option<Text>,
    term: Option<Text>,
    equation: Option<Text>,
    mode: Option<Spanned<usize>>,
    method: Option<Text>,
    order: Option<Spanned<Order>>,
    small: Option<Text>,
    amplitude: Option<Text>,
    taylor: Option<Spanned<u32>>,
    linearisation: Option<Text>,
    values: Option<Spanned<NamedValues>>,
    settings: Option<Spanned<BTreeMap<String, Text>>>,
    printed: Option<Text>,
    read_as: Option<Text>,
    entries: Option<Spanned<Vec<Spanned<Row>>>>,
    tolerance: Option<Spanned<f64>>,
    rounding: Option<Text>,
    unknown: Option<Text>,
    within: Option<Spanned<[toml::Value; 2]>>,
    suppose: Option<Spanned<Suppose>>,
    #[serde(default)]
    needs: Vec<String>,
    expect: Option<Text>,
    note: Option<String>,
}

/// A row of a printed table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    #[serde(default)]
    values: NamedValues,
    printed: Option<Text>,
    read_as: Option<Text>,
}

/// The suppositions that may be made, in lists of alternatives.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Suppose {
    pi: Vec<Spanned<toml::Value>>,
    rounding: Vec<Text>,
    method: Vec<Text>,
    order: Vec<Order>,
    taylor: Vec<u32>,
    amplitude: Vec<Text>,
    linearisation: Vec<Text>,
    formula: Vec<Text>,
    values: Vec<NamedValues>,
}

fn read(document: Document) -> ReadResult<Option<Claims>> {
    let values = table(&document.values)?;
    let mut ids: BTreeSet<String> = BTreeSet::new();
    let mut claims = Vec::new();
    for section in &document.claim {
        if !ids.insert(section.id.get_ref().clone()) {
            return mistake(
                section.id.span(),
                format!("there are two claims `{}`", section.id.get_ref()),
            );
        }
        claims.push(claim(section, &values)?);
    }
    Ok((!claims.is_empty()).then_some(Claims { title: document.title, claims }))
}

fn claim(section: &Section, shared: &BTreeMap<Symbol, Expr>) -> ReadResult<Claim> {
    let kind = kind(section)?;
    check_keys(section, kind)?;
    // In a formula the names of the file stay symbols.
    let mut values = match kind {
        "identity" | "motion" | "law" | "taylor" | "coefficient" | "coordinates" => BTreeMap::new(),
        _ => shared.clone(),
    };
    if let Some(own) = &section.values {
        values.extend(table(own.get_ref())?);
    }
    let entries = entries(section, kind)?;
    let unknown = unknown(section, &values)?;
    let question = ClaimComputation {
        quantity: quantity(section, kind)?,
        equation: section
            .equation
            .as_ref()
            .map(|text| equation(text, section.mode.as_ref()))
            .transpose()?,
        options: options_of(section)?,
        rule: section.linearisation.as_ref().map(rule).transpose()?.unwrap_or_default(),
        values,
        pi: None,
        rounding: section.rounding.as_ref().map(rounding).transpose()?.unwrap_or_default(),
        tolerance: section.tolerance.as_ref().map(tolerance).transpose()?,
    };
    let suppositions = match &section.suppose {
        Some(suppose) => suppositions(suppose.get_ref())?,
        None => vec![],
    };
    let combinations =
        suppositions.iter().map(|subject| subject.len() + 1).try_fold(1_usize, usize::checked_mul);
    if combinations.is_none_or(|count| count > MOST_COMBINATIONS) {
        let span = section.suppose.as_ref().map_or(section.id.span(), Spanned::span);
        return mistake(
            span,
            format!("these are more than {MOST_COMBINATIONS} combinations of suppositions"),
        );
    }
    let claim = Claim {
        id: section.id.get_ref().clone(),
        place: section.place.clone(),
        says: section.says.clone(),
        question,
        entries,
        suppositions,
        unknown,
        needs: section.needs.clone(),
        expected: section.expect.as_ref().map(verdict).transpose()?,
        note: section.note.clone(),
    };
    check_names(section, &claim)?;
    check_values(section, &claim)?;
    Ok(claim)
}

/// Reads the quantity of a claim.
fn quantity(section: &Section, kind: &str) -> ReadResult<ClaimQuantity> {
    let needed = |key: &str, text: &Option<Text>| -> ReadResult<Text> {
        match text {
            Some(text) => Ok(text.clone()),
            None => mistake(
                section.id.span(),
                format!(
                    "claim `{}` has no `{key}`, which the quantity `{kind}` needs",
                    section.id.get_ref()
                ),
            ),
        }
    };
    let formula = || -> ReadResult<Expr> { equal_to_zero(&needed("formula", &section.formula)?) };
    let squared = || match section.of.as_ref().map(|of| (of.get_ref().as_str(), of.span())) {
        None | Some(("frequency_squared", _)) => Ok(true),
        Some(("frequency", _)) => Ok(false),
        Some((other, span)) => {
            helped(span, format!("`{other}` is no law"), "give frequency_squared or frequency")
        }
    };
    if matches!(kind, "coefficient" | "law") {
        needed("equation", &section.equation)?;
    }
    Ok(match kind {
        "" => ClaimQuantity::Nothing,
        "value" => ClaimQuantity::Value(expression(&needed("formula", &section.formula)?)?),
        "trend" => ClaimQuantity::Trend(expression(&needed("formula", &section.formula)?)?),
        "coefficient" => {
            let text = needed("term", &section.term)?;
            let term = expression(&text)?;
            let polynomial = term.to_polynomial(&mut |_| None).ok().flatten();
            let is_product = polynomial.is_some_and(|terms| {
                terms.single_term().is_some_and(|(_, number)| num_traits::One::is_one(number))
            });
            if !is_product {
                return mistake(
                    text.span(),
                    format!("`{term}` is no product of powers, such as A^2*eps"),
                );
            }
            ClaimQuantity::Coefficient { squared: squared()?, term }
        }
        "law" => ClaimQuantity::Law { squared: squared()? },
        "taylor" => ClaimQuantity::Taylor {
            formula: formula()?,
            degree: match section.order.as_ref().map(Spanned::get_ref) {
                Some(Order::Power(degree)) if *degree <= MOST_TAYLOR => *degree,
                _ => {
                    let span = section.order.as_ref().map_or(section.id.span(), Spanned::span);
                    return mistake(
                        span,
                        format!(
                            "a Taylor polynomial needs an `order`, its degree, up to {MOST_TAYLOR}"
                        ),
                    );
                }
            },
        },
        "identity" => ClaimQuantity::Identity(formula()?),
        "motion" => ClaimQuantity::Motion {
            kinetic: expression(&needed("kinetic", &section.kinetic)?)?,
            potential: section.potential.as_ref().map_or(Ok(Expr::zero()), expression)?,
            force: section.force.as_ref().map_or(Ok(Expr::zero()), expression)?,
        },
        "coordinates" => ClaimQuantity::Coordinates(formula()?),
        "options" => ClaimQuantity::Settings(settings(section)?),
        name => ClaimQuantity::Value(Expr::symbol(name)),
    })
}

/// The highest degree of a Taylor polynomial.
const MOST_TAYLOR: u32 = 100;

fn settings(section: &Section) -> ReadResult<Vec<(String, String)>> {
    let Some(settings) = &section.settings else {
        return mistake(
            section.id.span(),
            format!(
                "claim `{}` has no `settings`, the options that go together",
                section.id.get_ref()
            ),
        );
    };
    let one = |(name, value): (&String, &Text)| {
        let spoken = name.replace('_', " ");
        match options::KNOWN.contains(&spoken.as_str()) {
            true => Ok((spoken, value.get_ref().clone())),
            false => {
                let near = nearest(&spoken, options::KNOWN);
                let help = near.map_or_else(
                    || format!("the rules know {}", options::KNOWN.join(", ")),
                    |near| format!("did you mean `{}`?", near.replace(' ', "_")),
                );
                helped(value.span(), format!("unknown option `{name}`"), help)
            }
        }
    };
    settings.get_ref().iter().map(one).collect()
}

/// Reads the printed entries of a claim.
fn entries(section: &Section, kind: &str) -> ReadResult<Vec<PrintedEntry>> {
    let id = section.id.get_ref();
    let several = section.entries.as_ref();
    let own = |row: &Row| table(&row.values);
    if kind == "trend" {
        let Some(rows) = several.filter(|rows| rows.get_ref().len() > 1) else {
            let span = several.map_or(section.id.span(), Spanned::span);
            return mistake(
                span,
                format!("claim `{id}` has no trend: give `entries`, two or more, with `values`"),
            );
        };
        let Some(text) = section.read_as.as_ref().or(section.printed.as_ref()) else {
            return no_number(section);
        };
        let Some(trend) = Trend::from_name(text.get_ref()) else {
            let known = Trend::ALL.map(Trend::name).join(", ");
            return helped(
                text.span(),
                format!("`{}` is no trend", text.get_ref()),
                format!("what is printed may be read as one: read_as = {known}"),
            );
        };
        let printed = section.printed.as_ref().unwrap_or(text).get_ref();
        let row = |row: &Spanned<Row>| match row
            .get_ref()
            .printed
            .as_ref()
            .or(row.get_ref().read_as.as_ref())
        {
            Some(text) => mistake(
                text.span(),
                "the entries of a trend have `values` alone: what is printed is the trend",
            ),
            None => Ok(PrintedEntry {
                values: own(row.get_ref())?,
                printed: printed.clone(),
                read_as: section.read_as.as_ref().map(|text| text.get_ref().clone()),
                stated: PrintedStatement::Trend(trend),
            }),
        };
        return rows.get_ref().iter().map(row).collect();
    }
    if let Some(rows) = several {
        if let Some(text) = section.printed.as_ref().or(section.read_as.as_ref()) {
            return mistake(
                text.span(),
                "what is printed stands in each of the `entries` already: give one of them",
            );
        }
        if rows.get_ref().is_empty() {
            return mistake(rows.span(), "there is no entry");
        }
        let row = |row: &Spanned<Row>| {
            let Some(printed) = &row.get_ref().printed else {
                return mistake(
                    row.span(),
                    format!("an entry of claim `{id}` has no number: give `printed`"),
                );
            };
            Ok(PrintedEntry {
                values: own(row.get_ref())?,
                printed: printed.get_ref().clone(),
                read_as: row.get_ref().read_as.as_ref().map(|text| text.get_ref().clone()),
                stated: stated(kind, row.get_ref().read_as.as_ref().unwrap_or(printed))?,
            })
        };
        return rows.get_ref().iter().map(row).collect();
    }
    let stated = match (&section.printed, kind) {
        (None, "" | "options") => PrintedStatement::Words,
        (None, _) => return no_number(section),
        (Some(printed), kind) => stated(kind, section.read_as.as_ref().unwrap_or(printed))?,
    };
    if let (Some(text), "" | "options") = (&section.read_as, kind) {
        return mistake(text.span(), "`read_as` says nothing here: there is no number to be read");
    }
    Ok(vec![PrintedEntry {
        values: BTreeMap::new(),
        printed: section.printed.as_ref().map_or(String::new(), |text| text.get_ref().clone()),
        read_as: section.read_as.as_ref().map(|text| text.get_ref().clone()),
        stated,
    }])
}

fn no_number<T>(section: &Section) -> ReadResult<T> {
    helped(
        section.id.span(),
        format!("claim `{}` has nothing that is printed", section.id.get_ref()),
        "give `printed`, the text with all its digits: printed = \"0.8478\"",
    )
}

/// Reads the statement of a printed text about this quantity.
fn stated(kind: &str, text: &Text) -> ReadResult<PrintedStatement> {
    match kind {
        "" | "options" => Ok(PrintedStatement::Words),
        "law" => {
            let right = text.get_ref().rsplit('=').next().unwrap_or_default();
            Ok(PrintedStatement::Formula(parsed(right, text.span())?))
        }
        "taylor" | "identity" | "motion" => Ok(PrintedStatement::Formula(equal_to_zero(text)?)),
        _ => match Printed::read(text.get_ref()) {
            Some(printed) => Ok(PrintedStatement::Number(printed)),
            None => helped(
                text.span(),
                format!("`{}` is no number", text.get_ref()),
                "write 0.8478, 9.258e-8, 7/1536, 0.586 % or a bound < 2 %; what words mean goes to `read_as`",
            ),
        },
    }
}

fn unknown(section: &Section, values: &BTreeMap<Symbol, Expr>) -> ReadResult<Option<Unknown>> {
    let Some(name) = &section.unknown else {
        return Ok(None);
    };
    let Some(within) = &section.within else {
        return helped(
            name.span(),
            format!("the unknown `{}` has no range", name.get_ref()),
            "give within = [least, greatest]",
        );
    };
    let symbol = symbol(name.get_ref(), name.span())?;
    if values.contains_key(&symbol) {
        return mistake(
            name.span(),
            format!("`{symbol}` has a value and is no unknown: give one of them"),
        );
    }
    let end = |value: &toml::Value| -> ReadResult<f64> {
        let expr = number(value, within.span())?;
        let found = identity::with_definitions(&expr, values).and_then(|expr| {
            let number = expr.evaluate(&BTreeMap::new());
            number.map_err(|error| error.to_string())
        });
        found.or_else(|reason| mistake(within.span(), reason))
    };
    let ends = [end(&within.get_ref()[0])?, end(&within.get_ref()[1])?];
    if ends[0] >= ends[1] {
        return mistake(
            within.span(),
            format!(
                "the range of `{symbol}` is turned round: {} is not below {}",
                decimal(ends[0]),
                decimal(ends[1])
            ),
        );
    }
    Ok(Some(Unknown { name: symbol, within: ends }))
}

fn options_of(section: &Section) -> ReadResult<Options> {
    let order = section.order.as_ref().map(|order| *order.get_ref());
    Ok(Options {
        method: section.method.as_ref().map(method).transpose()?,
        order: order.and_then(Order::power),
        degrees: order.and_then(Order::degrees),
        amplitude: section.amplitude.as_ref().map(convention).transpose()?,
        small: section.small.as_ref().map(|text| text.get_ref().clone()),
        taylor: section.taylor.as_ref().map(|degree| *degree.get_ref()),
        ..Options::default()
    })
}

fn suppositions(suppose: &Suppose) -> ReadResult<Vec<Vec<Supposition>>> {
    let each = |texts: &[Text],
                read: &dyn Fn(&Text) -> ReadResult<Supposition>|
     -> ReadResult<Vec<Supposition>> { texts.iter().map(read).collect() };
    let order = |order: &Order| match *order {
        Order::Power(order) => Supposition::Order(order),
        Order::Degrees(degrees) => Supposition::Degrees(degrees),
    };
    let pi = |value: &Spanned<toml::Value>| -> ReadResult<Supposition> {
        let found = number(value.get_ref(), value.span())?;
        match found.as_number().is_some_and(|number| *number > Rational::default()) {
            true => Ok(Supposition::Pi(found)),
            false => mistake(
                value.span(),
                "a value of pi is a positive number, such as 3.14 or \"22/7\"",
            ),
        }
    };
    let subjects = [
        suppose
            .values
            .iter()
            .map(|values| Ok(Supposition::Values(table(values)?.into_iter().collect())))
            .collect::<ReadResult<_>>()?,
        suppose.pi.iter().map(pi).collect::<ReadResult<_>>()?,
        each(&suppose.rounding, &|text| Ok(Supposition::Rounding(rounding(text)?)))?,
        each(&suppose.formula, &|text| {
            Ok(Supposition::Formula(expression(text)?, text.get_ref().clone()))
        })?,
        each(&suppose.method, &|text| Ok(Supposition::Method(method(text)?)))?,
        suppose.order.iter().map(order).collect(),
        suppose.taylor.iter().map(|degree| Supposition::Taylor(*degree)).collect(),
        each(&suppose.amplitude, &|text| Ok(Supposition::Amplitude(convention(text)?)))?,
        each(&suppose.linearisation, &|text| Ok(Supposition::Rule(rule(text)?)))?,
    ];
    Ok(subjects.into_iter().filter(|subject: &Vec<Supposition>| !subject.is_empty()).collect())
}
