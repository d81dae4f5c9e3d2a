//! The keys of a claim of each kind: a key without effect is refused by name.

use super::{ReadResult, Section, Text, helped, mistake};
use crate::audit::quantity::{NAMES, is_a_name};
use crate::spelling::nearest;
use std::ops::Range;
use toml::Spanned;

/// The quantities that are not names of numbers.
pub(super) const KINDS: [&str; 9] = [
    "value",
    "coefficient",
    "law",
    "taylor",
    "identity",
    "motion",
    "trend",
    "coordinates",
    "options",
];

/// Keys that only some quantities read.
pub(super) const OF_A_LAW: [&str; 7] =
    ["equation", "mode", "method", "order", "small", "amplitude", "taylor"];

/// The keys of the computation that a quantity reads.
pub(super) fn keys_of(kind: &str) -> Vec<&'static str> {
    let own: &[&str] = match kind {
        "coefficient" => &["of", "term"],
        "law" => &["of"],
        "taylor" => &["formula", "order"],
        "identity" => &["formula", "values"],
        "motion" => &["kinetic", "potential", "force", "values"],
        "coordinates" => &["formula"],
        "options" => &["settings"],
        "" => &[],
        "value" | "trend" => {
            &["formula", "linearisation", "values", "entries", "unknown", "tolerance", "rounding"]
        }
        _ => &["linearisation", "values", "entries", "unknown", "tolerance", "rounding"],
    };
    let of_a_law: &[&str] = match kind {
        "taylor" | "identity" | "motion" | "coordinates" | "options" | "" => &[],
        _ => &OF_A_LAW,
    };
    let of_a_number: &[&str] = match kind {
        "coefficient" | "coordinates" => &["tolerance", "rounding"],
        _ => &[],
    };
    [own, of_a_law, of_a_number].concat()
}

/// The quantity: one of [`KINDS`], a name of a number, or empty if the claim only states what is
/// missing.
pub(super) fn kind(section: &Section) -> ReadResult<&str> {
    let Some(quantity) = &section.quantity else {
        return match section.needs.is_empty() {
            false => Ok(""),
            true => helped(
                section.id.span(),
                format!("claim `{}` has no quantity", section.id.get_ref()),
                format!("give `quantity`: {}, or a number such as paper_speed", KINDS.join(", ")),
            ),
        };
    };
    let name = quantity.get_ref().as_str();
    if KINDS.contains(&name) || is_a_name(name) {
        return Ok(name);
    }
    let known = KINDS.into_iter().chain(NAMES.iter().map(|entry| entry.0));
    let help = match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("give {}, or a number such as paper_speed", KINDS.join(", ")),
    };
    helped(quantity.span(), format!("unknown quantity `{name}`"), help)
}

/// Refuses keys that this quantity does not read.
pub(super) fn check_keys(section: &Section, kind: &str) -> ReadResult<()> {
    let span = |text: &Option<Text>| text.as_ref().map(Spanned::span);
    let given: [(&str, Option<Range<usize>>); 20] = [
        ("formula", span(&section.formula)),
        ("kinetic", span(&section.kinetic)),
        ("potential", span(&section.potential)),
        ("force", span(&section.force)),
        ("of", span(&section.of)),
        ("term", span(&section.term)),
        ("equation", span(&section.equation)),
        ("mode", section.mode.as_ref().map(Spanned::span)),
        ("method", span(&section.method)),
        ("order", section.order.as_ref().map(Spanned::span)),
        ("small", span(&section.small)),
        ("amplitude", span(&section.amplitude)),
        ("taylor", section.taylor.as_ref().map(Spanned::span)),
        ("linearisation", span(&section.linearisation)),
        ("values", section.values.as_ref().map(Spanned::span)),
        ("settings", section.settings.as_ref().map(Spanned::span)),
        ("entries", section.entries.as_ref().map(Spanned::span)),
        ("tolerance", section.tolerance.as_ref().map(Spanned::span)),
        ("rounding", span(&section.rounding)),
        ("unknown", span(&section.unknown)),
    ];
    let known = keys_of(kind);
    for (key, span) in given {
        if let Some(span) = span.filter(|_| !known.contains(&key)) {
            let words = match kind {
                "" => "a claim without a quantity".to_owned(),
                kind => format!("the quantity `{kind}`"),
            };
            return mistake(span, format!("`{key}` says nothing to {words}: leave it out"));
        }
    }
    if let Some(suppose) = &section.suppose {
        let subjects = suppose.get_ref();
        let tried = [
            ("rounding", subjects.rounding.is_empty()),
            ("method", subjects.method.is_empty()),
            ("order", subjects.order.is_empty()),
            ("taylor", subjects.taylor.is_empty()),
            ("amplitude", subjects.amplitude.is_empty()),
            ("linearisation", subjects.linearisation.is_empty()),
            ("values", subjects.values.is_empty()),
        ];
        let odd = tried.iter().find(|(key, none)| !none && !known.contains(key));
        let is_number = known.contains(&"values") && !matches!(kind, "" | "identity" | "motion");
        let odd_number = [("pi", subjects.pi.is_empty()), ("formula", subjects.formula.is_empty())];
        let odd_number = odd_number.iter().find(|(_, none)| !none && !is_number);
        if let Some((key, _)) = odd.or(odd_number) {
            return mistake(
                suppose.span(),
                format!(
                    "to suppose another `{key}` says nothing to the quantity `{kind}`: leave it out"
                ),
            );
        }
    }
    match (&section.within, &section.unknown) {
        (Some(within), None) => mistake(within.span(), "`within` needs the name of an `unknown`"),
        _ => Ok(()),
    }
}
