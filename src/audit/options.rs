//! Rules for the options of a genetic algorithm: a table of options is checked rule by rule.
//!
//! The names are those of the toolbox in general use, and the rules those of its documentation:
//! which functions take genes that are numbers, which constraints a population of bits can keep,
//! what the penalties of the augmented Lagrangian act on.

/// Options whose values the rules know, as they are written in a file.
#[cfg(any(feature = "toml", test))]
pub(super) const KNOWN: [&str; 12] = [
    "population type",
    "population size",
    "crossover function",
    "crossover fraction",
    "mutation function",
    "selection function",
    "elite number",
    "initial penalty",
    "penalty factor",
    "penalty",
    "constraints",
    "stall generations",
];

/// A condition that an option sets on another one.
struct Rule {
    option: &'static str,
    /// The value to which the condition applies; `None` for any value.
    value: Option<&'static str>,
    needs: &'static str,
    /// The values of the other option that meet the condition.
    among: &'static [&'static str],
    because: &'static str,
}

const NUMBERS: &[&str] = &["double vector", "double"];
const NONLINEAR: &[&str] = &["nonlinear"];

const RULES: [Rule; 8] = [
    Rule {
        option: "crossover function",
        value: Some("heuristic"),
        needs: "population type",
        among: NUMBERS,
        because: "it puts the child on the line through its parents, which bits do not have",
    },
    Rule {
        option: "crossover function",
        value: Some("intermediate"),
        needs: "population type",
        among: NUMBERS,
        because: "it averages the parents, which bits do not allow",
    },
    Rule {
        option: "mutation function",
        value: Some("adaptive feasible"),
        needs: "population type",
        among: NUMBERS,
        because: "it steps along directions and by lengths, which bits do not have",
    },
    Rule {
        option: "mutation function",
        value: Some("gaussian"),
        needs: "population type",
        among: NUMBERS,
        because: "it adds a number to a gene, which bits do not allow",
    },
    Rule {
        option: "constraints",
        value: Some("bounds"),
        needs: "population type",
        among: NUMBERS,
        because: "bounds are those of numbers: a population of bits does not keep them",
    },
    Rule {
        option: "initial penalty",
        value: None,
        needs: "constraints",
        among: NONLINEAR,
        because: "it is where the augmented Lagrangian of nonlinear constraints starts, and does nothing without them",
    },
    Rule {
        option: "penalty factor",
        value: None,
        needs: "constraints",
        among: NONLINEAR,
        because: "the augmented Lagrangian of nonlinear constraints grows its penalty by it, and it does nothing without them",
    },
    Rule {
        option: "penalty",
        value: Some("death"),
        needs: "constraints",
        among: NONLINEAR,
        because: "who stays in the bounds anyway is never rejected",
    },
];

/// The rules that these options break, a sentence each; an option that is not given breaks no rule.
pub(super) fn conflicts(settings: &[(String, String)]) -> Vec<String> {
    let stated = |name: &str| {
        settings.iter().find(|(option, _)| option == name).map(|entry| entry.1.as_str())
    };
    let broken = RULES.iter().filter_map(|rule| {
        let value = stated(rule.option)?;
        let other = stated(rule.needs)?;
        let applies = rule.value.is_none_or(|wanted| value.eq_ignore_ascii_case(wanted));
        let met = rule.among.iter().any(|wanted| other.eq_ignore_ascii_case(wanted));
        (applies && !met).then(|| {
            format!(
                "{} = {value} needs {} = {}, not {other}: {}",
                rule.option, rule.needs, rule.among[0], rule.because
            )
        })
    });
    broken.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(settings: &[(&str, &str)]) -> usize {
        let own = settings.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
        conflicts(&own.collect::<Vec<_>>()).len()
    }

    #[test]
    fn rules_speak_of_known_options_alone() {
        for rule in RULES {
            assert!(KNOWN.contains(&rule.option) && KNOWN.contains(&rule.needs), "{}", rule.option);
        }
    }

    #[test]
    fn what_needs_numbers_breaks_on_bits() {
        let heuristic = ("crossover function", "Heuristic");
        assert_eq!(found(&[heuristic, ("population type", "Bit string")]), 1);
        assert_eq!(found(&[heuristic, ("population type", "double vector")]), 0);
        assert_eq!(found(&[heuristic]), 0);
        assert_eq!(found(&[("penalty factor", "100"), ("constraints", "bounds")]), 1);
    }
}
