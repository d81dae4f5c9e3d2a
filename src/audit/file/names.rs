//! The check of the names of a claim: each has a value, and each value is used.

use super::values::{number, symbol};
use super::{ReadResult, Section, helped, mistake};
use crate::audit::claim::{Claim, ClaimEquation, ClaimQuantity, PrintedStatement, Supposition};
use crate::audit::quantity::{NAMES, is_a_name};
use crate::expr::Expr;
use crate::spelling::nearest;
use crate::symbol::Symbol;
use std::collections::BTreeSet;
use toml::Spanned;

/// The names that a computation uses, including those in the values of others.
pub(super) fn used(claim: &Claim) -> BTreeSet<Symbol> {
    let mut formulas: Vec<Expr> = match &claim.question.quantity {
        ClaimQuantity::Value(formula) | ClaimQuantity::Trend(formula) => vec![formula.clone()],
        _ => vec![],
    };
    let mut tables = vec![claim.question.values.clone()];
    for supposition in claim.suppositions.iter().flatten() {
        match supposition {
            Supposition::Formula(formula, _) => formulas.push(formula.clone()),
            Supposition::Values(values) => tables.push(values.iter().cloned().collect()),
            _ => {}
        }
    }
    tables.extend(claim.entries.iter().map(|entry| entry.values.clone()));
    let mut found = BTreeSet::new();
    while let Some(formula) = formulas.pop() {
        for name in formula.symbols() {
            if found.insert(name) {
                formulas.extend(tables.iter().filter_map(|table| table.get(&name).cloned()));
                formulas.extend(asked_by(name, claim.question.equation.as_ref()).map(Expr::from));
            }
        }
    }
    found
}

/// Refuses names that resemble those of numbers, a missing equation, and keys that no name uses.
pub(super) fn check_names(section: &Section, claim: &Claim) -> ReadResult<()> {
    if !matches!(claim.question.quantity, ClaimQuantity::Value(_) | ClaimQuantity::Trend(_)) {
        return Ok(());
    }
    let used = used(claim);
    let place =
        section.formula.as_ref().or(section.quantity.as_ref()).unwrap_or(&section.id).span();
    let given = |name: Symbol| {
        let supposed = claim.suppositions.iter().flatten().any(|one| match one {
            Supposition::Values(values) => values.iter().any(|(known, _)| *known == name),
            _ => false,
        });
        let values = std::iter::once(&claim.question.values)
            .chain(claim.entries.iter().map(|entry| &entry.values));
        supposed || values.into_iter().any(|values| values.contains_key(&name))
    };
    let names = || NAMES.iter().map(|entry| entry.0);
    for name in &used {
        let is_open = !given(*name) && !is_a_name(name.name()) && name.name().contains('_');
        if let Some(near) = nearest(name.name(), names()).filter(|_| is_open) {
            return helped(
                place,
                format!("`{name}` has no value and is no number that is computed"),
                format!("did you mean `{near}`?"),
            );
        }
    }
    let asks = |wanted: &dyn Fn(&str) -> bool| {
        used.iter().any(|name| is_a_name(name.name()) && wanted(name.name()))
    };
    let of_a_law = |name: &str| ["frequency", "true_frequency", "max_deviation"].contains(&name);
    let of_an_impact = |name: &str| {
        !of_a_law(name)
            && ["paper_", "energy_", "true_", "line_"].iter().any(|head| name.starts_with(head))
    };
    if asks(&of_a_law) && section.equation.is_none() {
        return helped(
            place,
            format!("claim `{}` has no equation that a frequency could be derived from", claim.id),
            "give equation = \"x'' + sin(x) = 0\", or a name of the catalogue",
        );
    }
    let keys = [
        section.equation.as_ref().map(|text| ("equation", text.span())),
        section.method.as_ref().map(|text| ("method", text.span())),
        section.order.as_ref().map(|order| ("order", order.span())),
        section.small.as_ref().map(|text| ("small", text.span())),
        section.amplitude.as_ref().map(|text| ("amplitude", text.span())),
        section.taylor.as_ref().map(|degree| ("taylor", degree.span())),
        section.mode.as_ref().map(|number| ("mode", number.span())),
    ];
    if let (Some((key, span)), false) =
        (keys.into_iter().flatten().next(), asks(&of_a_law) || asks(&of_an_impact))
    {
        return mistake(
            span,
            format!("`{key}` says nothing here: the formula asks for nothing that is derived"),
        );
    }
    if let (Some(text), false) = (&section.linearisation, asks(&of_an_impact)) {
        return mistake(
            text.span(),
            "`linearisation` says nothing here: the formula asks for no contact",
        );
    }
    match (&claim.unknown, &section.unknown) {
        (Some(unknown), Some(text)) if !used.contains(&unknown.name) => mistake(
            text.span(),
            format!("the unknown `{}` does not occur in the claim", unknown.name),
        ),
        _ => Ok(()),
    }
}

/// The names that a computed number needs.
pub(super) fn asked_by<'a>(
    name: Symbol,
    equation: Option<&'a ClaimEquation>,
) -> impl Iterator<Item = Symbol> + 'a {
    let needs = NAMES.iter().find(|entry| entry.0 == name.name()).map(|entry| entry.1);
    let words = needs.into_iter().flat_map(|needs| needs.split(", "));
    let own =
        words.filter(|word| !word.is_empty() && !word.contains("equation") && !word.contains(' '));
    let of_a_law = needs.is_some_and(|needs| needs.starts_with("equation"));
    // An impact has the parameters of its swing, and the amplitude of a law has either symbol.
    let parameters =
        equation.filter(|_| needs.is_some()).into_iter().flat_map(|equation| equation.parameters());
    let letter = of_a_law.then(|| Symbol::new("a"));
    own.map(Symbol::new).chain(parameters.copied()).chain(letter)
}

/// Refuses values of a claim that are not used.
pub(super) fn check_values(section: &Section, claim: &Claim) -> ReadResult<()> {
    let quantity = &claim.question.quantity;
    let mut used = used(claim);
    let formulas = match quantity {
        ClaimQuantity::Identity(formula) => vec![formula],
        ClaimQuantity::Motion { kinetic, potential, force } => vec![kinetic, potential, force],
        _ => vec![],
    };
    if !formulas.is_empty() {
        let printed = claim.entries.iter().filter_map(|entry| match &entry.stated {
            PrintedStatement::Formula(printed) => Some(printed),
            _ => None,
        });
        let all = formulas.into_iter().chain(printed).chain(claim.question.values.values());
        used.extend(all.flat_map(Expr::symbols));
        used.extend(used.clone().into_iter().map(Symbol::coordinate));
    }
    if let Some(within) = &section.within {
        for end in within.get_ref() {
            used.extend(number(end, within.span())?.symbols());
        }
    }
    let own = section.values.as_ref().map(Spanned::get_ref);
    let rows = section.entries.iter().flat_map(|rows| rows.get_ref());
    let tables = own.into_iter().chain(rows.map(|row| &row.get_ref().values));
    let supposed = section.suppose.iter().flat_map(|suppose| &suppose.get_ref().values);
    for (name, value) in tables.chain(supposed).flatten() {
        let symbol = symbol(name, value.span())?;
        if !used.contains(&symbol) && *quantity != ClaimQuantity::Nothing {
            return mistake(
                value.span(),
                format!("nothing in claim `{}` asks for `{name}`: leave it out", claim.id),
            );
        }
    }
    Ok(())
}
