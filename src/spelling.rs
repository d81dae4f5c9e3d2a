//! "Did you mean ...?": the nearest known name.

use strsim::levenshtein;

/// The name among `known` that needs the fewest changes to become `typed`, where at most a third of it changes.
///
/// ```
/// use lindstedt::catalog::nearest;
///
/// assert_eq!(nearest("pendulm", ["duffing", "pendulum"]), Some("pendulum"));
/// ```
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = |name: &str| typed.chars().count().max(name.chars().count()).div_ceil(3);
    known
        .into_iter()
        .map(|name| (levenshtein(typed, name), name))
        .filter(|(changes, name)| *changes <= allowed(name))
        .min_by_key(|(changes, _)| *changes)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_was_meant_and_nothing_far_fetched() {
        assert_eq!(nearest("bariers", ["amplitude", "barrier"]), Some("barrier"));
        assert_eq!(nearest("velocity", ["amplitude", "barrier"]), None);
    }
}
