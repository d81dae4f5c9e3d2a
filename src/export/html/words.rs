//! Words, names and verdicts as HTML.

/// Text in which nothing is read as HTML.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            _ => escaped.push(letter),
        }
    }
    escaped
}

/// Names with what is said of each; `class` is that of the list.
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

/// A verdict at the beginning of words in its colour.
pub(super) fn verdict(words: &str) -> String {
    let (first, rest) = words.split_at(words.find(' ').unwrap_or(words.len()));
    match first {
        "pass" | "reproduced" => format!("<span class=\"pass\">{first}</span>{rest}"),
        "fail" | "inconsistent" => format!("<span class=\"fail\">{first}</span>{rest}"),
        _ => words.to_owned(),
    }
}
