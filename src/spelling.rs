//! "Did you mean ...?": the nearest known name.

/// The name among `known` that needs the fewest changes to become `typed`, where at most a third of it changes.
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = |name: &str| typed.chars().count().max(name.chars().count()).div_ceil(3);
    known
        .into_iter()
        .map(|name| (distance(typed, name), name))
        .filter(|(changes, name)| *changes <= allowed(name))
        .min_by_key(|(changes, _)| *changes)
        .map(|(_, name)| name)
}

/// Levenshtein's distance: insertions, deletions and substitutions from one word to the other.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in to.iter().enumerate() {
            let substituted = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_was_meant_and_nothing_far_fetched() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(nearest("bariers", ["amplitude", "barrier"]), Some("barrier"));
        assert_eq!(nearest("velocity", ["amplitude", "barrier"]), None);
    }
}
