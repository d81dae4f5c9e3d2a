//! Lines that fit a width: long sums break before a sign, sentences at a blank.
//!
//! A formula breaks outside of its brackets where it can, and goes on below its first term; a value
//! goes on below itself, everything else two blanks further in. Rows of tables stay as they are.

/// The lines of a text; lines longer than `width` are broken.
///
/// ```
/// use lindstedt::export::text::fitted;
///
/// assert_eq!(fitted("  y = a + b*(c + d) + e\n", 20), "  y = a + b*(c + d)\n      + e\n");
/// ```
pub fn fitted(text: &str, width: usize) -> String {
    let mut fitted = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        match line.trim_end_matches('\n').chars().count() > width {
            true => broken(line, width, &mut fitted),
            false => fitted.push_str(line),
        }
    }
    fitted
}

/// A part of a line that stays together, and the depth of brackets before it.
struct Part<'a> {
    text: &'a str,
    depth: usize,
}

fn broken(line: &str, width: usize, fitted: &mut String) {
    let (body, end) = match line.strip_suffix('\n') {
        Some(body) => (body, "\n"),
        None => (line, ""),
    };
    let Some((first, hanging)) = indents(body, width) else {
        fitted.push_str(line);
        return;
    };
    let (head, rest) = body.split_at(first);
    let parts = parts(rest);
    let mut begin = 0;
    fitted.push_str(head);
    let mut indent = head.chars().count();
    while begin < parts.len() {
        let stop = next_break(&parts, begin, width.saturating_sub(indent));
        if begin > 0 {
            fitted.push('\n');
            fitted.extend(std::iter::repeat_n(' ', hanging));
        }
        let words: Vec<&str> = parts[begin..stop].iter().map(|part| part.text).collect();
        fitted.push_str(words.join(" ").trim_end());
        begin = stop;
        indent = hanging;
    }
    fitted.push_str(end);
}

/// The byte position from which a line may be broken, and the indentation of its continuation
/// lines; `None` for a row of a table.
fn indents(line: &str, width: usize) -> Option<(usize, usize)> {
    let indent = line.len() - line.trim_start().len();
    let gaps: Vec<usize> = line[indent..]
        .match_indices("  ")
        .map(|(gap, _)| indent + gap)
        .filter(|gap| !line[..*gap].ends_with(' '))
        .collect();
    let column = |place: usize| line[..place].chars().count();
    // The value of a name, or the right side of an equation.
    let value = gaps.first().map(|gap| gap + line[*gap..].len() - line[*gap..].trim_start().len());
    let right = line.find(" = ").map(|equals| equals + 3);
    let numbers = |text: &str| text.split_whitespace().all(|word| word.parse::<f64>().is_ok());
    match (gaps.len(), value, right) {
        (3.., ..) => None,
        (_, Some(value), _) if numbers(&line[value..]) => None,
        (_, Some(value), _) if column(value) <= width / 2 => Some((value, column(value))),
        (_, _, Some(right)) if column(right) <= width / 2 => Some((right, column(right))),
        _ => Some((indent, (indent + 2).min(width / 2))),
    }
}

/// The parts of a line between which it may be broken: a sign stays with its term, an equals sign
/// with both of its sides.
fn parts(text: &str) -> Vec<Part<'_>> {
    let mut parts: Vec<Part> = Vec::new();
    let (mut begin, mut depth, mut depth_at_begin) = (0, 0_usize, 0);
    for (place, letter) in text.char_indices() {
        match letter {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            ' ' => {
                let (before, after) = (&text[begin..place], &text[place + 1..]);
                let stays = matches!(before.rsplit(' ').next(), Some("+" | "-" | "+-" | "=" | ""))
                    || after.starts_with("= ")
                    || after.starts_with("+- ")
                    || after.starts_with(' ');
                if !stays {
                    parts.push(Part { text: before, depth: depth_at_begin });
                    (begin, depth_at_begin) = (place + 1, depth);
                }
            }
            _ => {}
        }
    }
    parts.push(Part { text: &text[begin..], depth: depth_at_begin });
    parts
}

/// The part with which the next line begins: the last that fits, or an earlier one outside of
/// brackets and with a sign if that fills at least two fifths of the line.
fn next_break(parts: &[Part], begin: usize, room: usize) -> usize {
    let mut length = 0;
    let mut best: Option<(usize, usize)> = None;
    for (index, part) in parts.iter().enumerate().skip(begin) {
        if index > begin && length * 5 >= room * 2 && length <= room {
            let has_sign = part.text.starts_with("+ ") || part.text.starts_with("- ");
            let rank = 2 * part.depth + usize::from(!has_sign);
            let is_better = best.is_none_or(|(_, known)| rank <= known);
            best = if is_better { Some((index, rank)) } else { best };
        }
        let longer = length + usize::from(index > begin) + part.text.chars().count();
        if longer > room {
            return best.map_or(index.max(begin + 1), |(index, _)| index);
        }
        length = longer;
    }
    parts.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sums_break_outside_of_brackets() {
        let line = "  x(t) = (A + A^3/192)*cos(theta) + (-A^3/192 - A^5/3072)*cos(3*theta)\n";
        let broken =
            "  x(t) = (A + A^3/192)*cos(theta)\n         + (-A^3/192 - A^5/3072)*cos(3*theta)\n";
        assert_eq!(fitted(line, 60), broken);
        assert_eq!(fitted(line, 100), line);
        assert_eq!(fitted(line, usize::MAX), line);
        // Nothing but the layout changes, and every line fits that can.
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        for width in 20..90 {
            let text = fitted(line, width);
            assert_eq!(words(&text), words(line));
            assert!(width < 34 || text.lines().all(|line| line.chars().count() <= width), "{text}");
        }
    }

    #[test]
    fn values_and_sentences_go_on_where_they_began() {
        let fact = "  range  periodic for small amplitudes: the separatrix passes there\n";
        assert_eq!(
            fitted(fact, 40),
            "  range  periodic for small amplitudes:\n         the separatrix passes there\n"
        );
        assert_eq!(fitted("one two three four", 9), "one two\n  three\n  four");
        let row = "  1.2345  2.3456  3.4567  4.5678  5.6789\n";
        assert_eq!(fitted(row, 20), row);
    }
}
