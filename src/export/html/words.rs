//! Words, names and verdicts as HTML.

use super::escaped;

/// Names with a text for each; `class` is that of the list.
pub(super) fn definitions(class: &str, entries: &[(impl AsRef<str>, String)]) -> String {
    let class = match class {
        "" => String::new(),
        class => format!(" class=\"{class}\""),
    };
    let entry = |(name, words): &(_, String)| {
        let name: &str = AsRef::as_ref(name);
        format!("<dt>{}</dt><dd>{}</dd>\n", escaped(name), verdict(&escaped(words)))
    };
    let entries: String = entries.iter().map(entry).collect();
    format!("<dl{class}>\n{entries}</dl>\n")
}

/// Lines one below the other.
pub(super) fn list(lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| format!("<li>{}</li>\n", escaped(line))).collect();
    format!("<ul>\n{lines}</ul>\n")
}

/// Words that begin with a verdict, which is set in its colour.
pub(super) fn verdict(words: &str) -> String {
    let (first, rest) = words.split_at(words.find(' ').unwrap_or(words.len()));
    match first {
        "pass" | "reproduced" => format!("<span class=\"pass\">{first}</span>{rest}"),
        "fail" | "inconsistent" => format!("<span class=\"fail\">{first}</span>{rest}"),
        _ => words.to_owned(),
    }
}
