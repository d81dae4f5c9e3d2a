//! Kind `catalog`: the classical oscillators.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use crate::catalog;

/// The classical oscillators that the program knows by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct CatalogDocument {
    /// The kind of document.
    pub schema: String,
    /// The oscillators, in the order of the listing.
    pub entries: Vec<Entry>,
}

/// A classical oscillator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Entry {
    /// The name on the command line.
    pub name: String,
    /// The name in running text.
    pub title: String,
    /// The equation of motion, or several separated by `;`.
    pub equation: String,
    /// Where it is studied.
    pub source: String,
    /// The law as its source prints it, `omega = ... + ...` or `omega^2 = ... + ...`; null where
    /// none is printed.
    pub published: Option<String>,
    /// The sides of rigid walls on which motions are allowed, such as `x < d`, each with the coefficient
    /// of restitution `e`.
    #[serde(default)]
    pub walls: Vec<String>,
    /// Every method, and whether it applies.
    pub methods: Vec<Applicability>,
}

/// Whether a method applies to an oscillator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Applicability {
    /// The method, by its name on the command line.
    #[cfg_attr(feature = "schema", schemars(schema_with = "super::generated_schema::methods"))]
    pub method: String,
    /// Whether it applies.
    pub applies: bool,
    /// Why it does not, in words; null where it does.
    pub reason: Option<String>,
}

/// The document of kind `catalog` with these entries.
///
/// ```
/// let document = lindstedt::export::json::catalog(lindstedt::catalog::CATALOG);
/// assert!(document.entries.iter().any(|entry| entry.name == "pendulum"));
/// ```
pub fn catalog(entries: &[catalog::CatalogEntry]) -> CatalogDocument {
    CatalogDocument {
        schema: DocumentKind::Catalog.schema().to_owned(),
        entries: entries.iter().map(entry).collect(),
    }
}

fn entry(entry: &catalog::CatalogEntry) -> Entry {
    let applicability =
        |(method, result): (crate::solution::Method, Result<(), String>)| Applicability {
            method: method.name().to_owned(),
            applies: result.is_ok(),
            reason: result.err(),
        };
    Entry {
        name: entry.name.to_owned(),
        title: entry.title.to_owned(),
        equation: entry.equation.to_owned(),
        source: entry.source.to_owned(),
        published: entry.published.map(|published| published.to_string()),
        walls: entry.walls.iter().map(|bound| (*bound).to_owned()).collect(),
        methods: catalog::methods(entry).into_iter().map(applicability).collect(),
    }
}
