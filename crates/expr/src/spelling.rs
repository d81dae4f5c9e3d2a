//! "Did you mean ...?": the nearest known name.

use strsim::levenshtein;

/// Returns the name among `known` that needs the fewest changes to become `typed`; `None` if more
/// than a third of it would change.
///
/// ```
/// use lindstedt_expr::spelling::nearest;
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

/// Makes a text from a file safe to show: characters that would control a terminal, or reverse the
/// order of the letters, are written as codes such as `\u{1b}`. Line ends and tabs stay.
pub fn printable(text: &str) -> String {
    escaped(text, |letter| !matches!(letter, '\n' | '\t') && is_invisible(letter))
}

/// Makes a text from a file safe to show in one line: line ends and tabs are written as codes too.
pub fn printable_in_line(text: &str) -> String {
    escaped(text, is_invisible)
}

/// Whether a character is invisible: a control character, or a mark of the direction of writing.
pub fn is_invisible(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

fn escaped(text: &str, is_code: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match is_code(letter) {
            true => shown.extend(letter.escape_unicode()),
            false => shown.push(letter),
        }
    }
    shown
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
