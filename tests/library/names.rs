//! Names of the user and names of the program: an equation means the same whatever its parameters
//! are called.

use std::collections::BTreeMap;

use lindstedt::certificate;
use lindstedt::export::{json, latex, text};
use lindstedt::expr::Expr;
use lindstedt::method::numbers::evaluate;
use lindstedt::method::{Options, solve};
use lindstedt::solution::Method;
use lindstedt::{Oscillator, Solution, Symbol};

/// Every name that some answer introduces, and some that look like them.
const NAMES: [&str; 33] = [
    "hbar", "hbar_", "W1", "W2", "y0", "y1", "y2", "w0", "w1", "w_0", "c1", "c2", "c3", "c_1",
    "a0", "a1", "a3", "b1", "z", "p", "q", "x0", "x1", "omega0", "chi", "u_1", "u1", "s", "k", "V",
    "T", "theta", "phi",
];

const EQUATIONS: [&str; 4] = [
    "x'' + x + NAME*x^3 = 0",
    "x'' + sqrt(2)*x + NAME*x^3/2 = 0",
    "x'' + sin(x) + NAME*x^3/3 = 0",
    "x'' + NAME*x + x^3 + sqrt(3)*x^5/100 = 0",
];

fn answer(equation: &str, name: &str, method: Method) -> Option<Solution> {
    let oscillator = Oscillator::parse(&equation.replace("NAME", name)).expect("an equation");
    let options =
        Options { method: Some(method), small: Some("A".to_owned()), ..Options::default() };
    solve(&oscillator, &options).ok()
}

fn omega(equation: &str, name: &str, solution: &Solution) -> Option<f64> {
    let oscillator = Oscillator::parse(&equation.replace("NAME", name)).expect("an equation");
    let at = BTreeMap::from([(Symbol::new("A"), 0.5), (Symbol::new(name), 0.75)]);
    Some(evaluate(&oscillator, solution, &at).ok()?.frequency_squared.sqrt())
}

#[test]
fn no_name_of_a_parameter_changes_a_number() {
    for equation in EQUATIONS {
        for method in Method::ALL {
            let plain = answer(equation, "kappa", method)
                .map(|solution| omega(equation, "kappa", &solution));
            for name in NAMES {
                let solution = answer(equation, name, method);
                let value = solution.map(|solution| omega(equation, name, &solution));
                // A name moves terms, and with them the last digits of a sum.
                let same = match (plain, value) {
                    (Some(Some(plain)), Some(Some(value))) => (value / plain - 1.0).abs() < 1e-12,
                    (plain, value) => plain == value,
                };
                assert!(same, "{equation} with {name} by {}: {plain:?}, {value:?}", method.name());
            }
        }
    }
}

/// The names in a text, with how often each occurs.
fn words(text: &str) -> BTreeMap<&str, usize> {
    let mut words = BTreeMap::new();
    for word in text.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '_')) {
        *words.entry(word).or_default() += 1;
    }
    words
}

#[test]
fn a_name_of_the_program_is_never_one_of_the_user() {
    for equation in EQUATIONS {
        for method in Method::ALL {
            let Some(plain) = answer(equation, "kappa", method) else {
                continue;
            };
            let report = |solution: &Solution| text::solution(solution, None);
            let expected = words(&report(&plain))["kappa"];
            for name in NAMES {
                let solution = answer(equation, name, method).expect("as with kappa");
                assert!(
                    solution.definitions.iter().all(|entry| entry.symbol.name() != name),
                    "{name}"
                );
                let report = report(&solution);
                let found = words(&report)[name];
                assert_eq!(found, expected, "{name} by {}:\n{report}", method.name());
            }
        }
    }
}

#[test]
fn latex_tells_all_names_of_an_answer_apart() {
    for (equation, pairs) in [
        ("x'' + k1*x + k_1*x^3 + k_*x^5 = 0", ["k1", "k_1", "k_"]),
        ("x'' + omega0^2*x + omega_0*x^3 + omega0_*x^5 = 0", ["omega0", "omega_0", "omega0_"]),
        ("x'' + epsilon*x + eps*x^3 + eps_*x^5 = 0", ["epsilon", "eps", "eps_"]),
    ] {
        let solution = solve(
            &Oscillator::parse(equation).unwrap(),
            &Options { small: Some("A".to_owned()), ..Options::default() },
        )
        .unwrap();
        let document = latex::solution(&solution, None);
        let spellings = pairs.map(|name| latex::symbol(Symbol::new(name)));
        assert!(
            spellings.iter().all(|spelling| document.contains(spelling.as_str())),
            "{document}"
        );
        assert!(
            spellings[0] != spellings[1]
                && spellings[1] != spellings[2]
                && spellings[0] != spellings[2]
        );
    }
}

/// omega^2 = omega0^2 + 3/4 x3 A^2 + ... and the judge's true frequency bound the value from two
/// sides.
#[test]
fn linear_coefficients_that_are_no_fractions() {
    for (linear, value) in [
        ("sqrt(2)", 2_f64.sqrt()),
        ("exp(1)", 1_f64.exp()),
        ("sin(1)", 1_f64.sin()),
        ("sqrt(NAME)", 0.75_f64.sqrt()),
        ("sqrt(2)*NAME", 0.75 * 2_f64.sqrt()),
        ("(sqrt(2) + NAME)", 0.75 + 2_f64.sqrt()),
        ("pi*sqrt(3)/NAME", 3_f64.sqrt() * std::f64::consts::PI / 0.75),
    ] {
        let equation = format!("x'' + {linear}*x + x^3 = 0");
        for method in [Method::LindstedtPoincare, Method::Pade] {
            let solution = answer(&equation, "kappa", method).expect(linear);
            let found = omega(&equation, "kappa", &solution).expect("real");
            let rough = (value + 0.75 * 0.25).sqrt();
            assert!((found / rough - 1.0).abs() < 2e-3, "{linear}: {found} {rough}");
            let line = solution.formula();
            for symbol in solution.law.frequency_squared().into_iter().flat_map(|law| law.symbols())
            {
                let known =
                    symbol.name() == "A" || symbol.name() == "kappa" || symbol.name() == "pi";
                assert!(known || line.contains(&format!("{symbol} = ")), "{line}");
            }
        }
    }
}

/// A linear force whose coefficient is negative under another name is still none.
#[test]
fn negative_constants_are_no_stiffness() {
    for equation in [
        "x'' + (1 - sqrt(2))*x + eps*x^3 = 0",
        "x'' + cos(2)*x + eps*x^3 = 0",
        "x'' + cos(2)*k*x + eps*x^3 = 0",
        "x'' + (sin(1)^2 + cos(1)^2 - 1)*x + eps*x^3 = 0",
    ] {
        let refusal =
            solve(&Oscillator::parse(equation).unwrap(), &Options::default()).unwrap_err();
        let refused = ["linear restoring force", "unstable"];
        assert!(
            refused.iter().any(|words| refusal.to_string().contains(words)),
            "{equation}: {refusal}"
        );
    }
}

/// What a report spells names in: as many uses of a name as there are.
struct Report {
    words: Vec<String>,
    formulas: String,
}

impl Report {
    fn of(solution: &Solution) -> Self {
        let steps = text::steps(solution) + &text::solution(solution, None);
        let formulas = latex::steps(solution) + &latex::solution(solution, None);
        // Comments and running text spell names as they are typed.
        let formulas: Vec<&str> = formulas.lines().filter(|line| !line.starts_with('%')).collect();
        let mut formulas = formulas.join("\n");
        while let Some(start) = formulas.find("\\text{") {
            let mut depth = 0;
            let end = formulas[start..].find(|letter: char| {
                depth += i32::from(letter == '{') - i32::from(letter == '}');
                letter == '}' && depth == 0
            });
            formulas.replace_range(start..=start + end.expect("a brace"), "");
        }
        Self {
            words: vec![
                steps,
                serde_json::to_string(&json::solution(solution, None)).expect("JSON"),
            ],
            formulas,
        }
    }

    /// How often a name stands in text, JSON and LaTeX.
    fn uses(&self, name: &str) -> Vec<usize> {
        let mut uses: Vec<usize> = self
            .words
            .iter()
            .map(|text| {
                let call = format!("{name}(");
                let calls = text.match_indices(call.as_str()).filter(|(start, _)| {
                    let before = text[..*start].chars().next_back();
                    !before.is_some_and(|letter| letter.is_ascii_alphanumeric() || letter == '_')
                });
                words(text).get(name).copied().unwrap_or(0) - calls.count()
            })
            .collect();
        let spelt = latex::symbol(Symbol::new(name));
        let alone = self.formulas.match_indices(spelt.as_str()).filter(|(start, _)| {
            let before = self.formulas[..*start].chars().next_back();
            let after = self.formulas[start + spelt.len()..].chars().next();
            let in_name = |letter: char| letter.is_ascii_alphabetic() || letter == '\\';
            let goes_on = |letter: char| letter.is_ascii_alphabetic() || letter == '_';
            // A command ends where a letter follows no letter; `\mathrm{K}` is no `K`.
            let inside = self.formulas[..*start].ends_with("\\mathrm{")
                || self.formulas[..*start].ends_with("\\tilde{");
            let longer = before.is_some_and(in_name) && !spelt.starts_with('\\')
                || after.is_some_and(goes_on);
            !inside && !longer
        });
        uses.push(alone.count());
        uses
    }

    /// Every name in its formulas that a parameter could have.
    fn names(&self) -> Vec<String> {
        /// Words that stand in formulas' lines, names that an equation may not use, and a
        /// differential.
        const OTHERS: [&str; 29] = [
            "A", "a", "be", "x", "t", "pi", "omega", "theta", "kappa", "in", "to", "at", "of",
            "is", "it", "by", "or", "as", "no", "up", "an", "on", "H", "df", "The", "the", "and",
            "du", "dx",
        ];
        let mut names: Vec<String> = words(&self.words[0]).into_keys().map(str::to_owned).collect();
        let all = names.clone();
        names.retain(|name| {
            let letter = name.starts_with(|letter: char| letter.is_ascii_alphabetic());
            let short = name.len() <= 2
                || name.contains('_')
                || name.contains(|digit: char| digit.is_ascii_digit());
            // Of a family the first few stand for all.
            let few = !name.ends_with(['3', '4', '5', '6', '7', '8', '9']);
            let short = short || ["lo", "hi", "hbar", "delta"].contains(&name.as_str());
            letter
                && short
                && few
                && !OTHERS.contains(&name.as_str())
                && !name.starts_with("int_")
                // Differentials, du of an integral over u.
                && !name.strip_prefix('d').is_some_and(|of| all.iter().any(|known| known == of))
        });
        names
    }
}

/// Whatever name a method uses for something of its own, a parameter may have it as well: then the
/// parameter stands wherever it stands under another name, and nothing else is called so, in text,
/// JSON and LaTeX.
#[test]
fn every_name_of_every_method_may_be_taken() {
    let equations = [
        ("x'' + x + NAME*x^3 = 0", None),
        ("x'' + 2*x + NAME*x^2 + x^3 = 0", None),
        ("x'' + x - 2*NAME*x^3 + NAME*x^5/3 = 0", None),
        ("x'' + sin(x) + NAME*x^3/3 = 0", None),
        ("x'' + x + NAME*exp(x) - NAME = 0", None),
        ("x'' + sqrt(3)*x + NAME*abs(x)*x = 0", None),
        ("x'' + x + NAME*x^(1/3) = 0", None),
        ("x'' + x + NAME*(x - 1/2)*H(x - 1/2) = 0", None),
        ("(1 + NAME*x^2)*x'' + NAME*x*x'^2 + x = 0", None),
        ("x'' + NAME*cos(x)*x'^2 + x = 0", None),
        ("x'' + NAME*x'^2/(1 + x^4) + x = 0", None),
        ("x'' - NAME*(1 - x^2)*x' + x = 0", Some("NAME")),
        ("x'' - NAME*(1 - x^4)*x' + x = 0", Some("NAME")),
        ("x'' - NAME*(1 - 3*x^2 + x^4)*x' + x = 0", Some("NAME")),
        ("x'' + x - NAME*sin(x) = 0", Some("NAME")),
    ];
    let (mut tried, mut wrong) = (0, Vec::new());
    for (equation, small) in equations {
        for method in Method::ALL {
            let answered = |name: &str, order: Option<u32>| {
                let oscillator = Oscillator::parse(&equation.replace("NAME", name)).ok()?;
                let small = small.map_or("A".to_owned(), |small| small.replace("NAME", name));
                let options = Options {
                    method: Some(method),
                    small: Some(small),
                    order,
                    ..Options::default()
                };
                solve(&oscillator, &options).ok()
            };
            for order in [None, Some(2)] {
                let Some(plain) = answered("kappa", order) else {
                    continue;
                };
                let plain = Report::of(&plain);
                let expected = plain.uses("kappa");
                for name in plain.names() {
                    let Some(solution) = answered(&name, order) else {
                        wrong.push(format!(
                            "{equation} with {name} by {} has no answer",
                            method.name()
                        ));
                        continue;
                    };
                    let report = Report::of(&solution);
                    if report.uses(&name) != expected {
                        wrong.push(format!(
                            "{equation} with {name} by {}: {:?} for {expected:?}\n{}\n{}",
                            method.name(),
                            report.uses(&name),
                            report.words[0],
                            report.formulas
                        ));
                    }
                    tried += 1;
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {tried}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(tried > 400, "{tried}");
}

/// Macros of `math.h` are no names of variables in C, and keywords are none in their language.
#[test]
fn exported_programs_have_names_of_their_language() {
    use lindstedt::export::code::{self, Language};
    let program = |name: &str, language: Language| {
        let oscillator =
            Oscillator::parse(&format!("x'' + x + {name}*x^3 = 0")).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a law");
        code::solution(&oscillator, &solution, None, language).expect("a program")
    };
    for (language, name) in [
        (Language::C, "M_PI"),
        (Language::C, "M_SQRT1_2"),
        (Language::C, "HUGE_VAL"),
        (Language::C, "double"),
        (Language::Python, "lambda"),
        (Language::Julia, "end"),
        (Language::Julia, "function"),
        (Language::Matlab, "end"),
        (Language::Matlab, "function"),
        (Language::Rust, "fn"),
    ] {
        let renamed = program(name, language);
        assert!(renamed.contains(&format!("{name}_")), "{name}: {renamed}");
        // A macro is nowhere but in comments, where the equation is as it was given.
        let code = renamed.lines().map(|line| line.split("//").next().unwrap_or_default());
        let is_macro =
            language == Language::C && name.starts_with(|first: char| first.is_uppercase());
        let mut words = code.flat_map(|line| {
            line.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '_'))
        });
        assert!(!is_macro || words.all(|word| word != name), "{name}: {renamed}");
    }
}

/// In LaTeX functions stand upright, so a parameter of the same letter is told apart.
#[test]
fn functions_of_answers_are_no_parameters() {
    for (expression, function, parameter) in [
        ("K*K(1/2)", "\\mathrm{K}\\left", "K "),
        ("J0*J0(A)", "\\mathrm{J}_{0}\\left", "J_{0} "),
        ("J1*J1(A)", "\\mathrm{J}_{1}\\left", "J_{1} "),
        ("I0*I0(A)", "\\mathrm{I}_{0}\\left", "I_{0} "),
        ("I1*I1(A)", "\\mathrm{I}_{1}\\left", "I_{1} "),
        ("Gamma*Gamma(1/4)", "\\Gamma\\left", "\\mathit{\\Gamma} "),
    ] {
        let printed = latex::expression(&expression.parse().expect("an expression"));
        assert!(printed.contains(function) && printed.starts_with(parameter), "{printed}");
    }
}

/// A coordinate that is called by its Greek letter is set as that letter wherever it stands.
#[test]
fn a_greek_coordinate_is_set_as_its_letter() {
    let oscillator = Oscillator::parse("phi'' + (g/L)*sin(phi) = 0").unwrap();
    let document = latex::solution(&solve(&oscillator, &Options::default()).unwrap(), None);
    assert!(document.contains("\\ddot{\\phi}") && document.contains("\n\\phi(t) &="), "{document}");
    // A comment is plain text.
    let set: String = document.lines().filter(|line| !line.starts_with('%')).collect();
    assert_eq!(set.replace("\\phi", "").matches("phi").count(), 0, "{document}");
}

/// The phase of the answer gives way to a coordinate of the same name; nothing else changes.
#[test]
fn a_coordinate_may_be_called_theta() {
    for method in Method::ALL {
        let derived = |equation: &str| {
            let oscillator = Oscillator::parse(equation).expect("an equation");
            let options = Options { method: Some(method), ..Options::default() };
            solve(&oscillator, &options).ok()
        };
        let (Some(plain), Some(named)) =
            (derived("x'' + k*sin(x) = 0"), derived("theta'' + k*sin(theta) = 0"))
        else {
            assert!(
                derived("x'' + k*sin(x) = 0").is_none()
                    && derived("theta'' + k*sin(theta) = 0").is_none()
            );
            continue;
        };
        let text = |solution: &Solution| text::steps(solution) + &text::solution(solution, None);
        // First the phase, then the coordinate: the other order would make them one.
        let expected = words_replaced(&text(&plain), "theta", "phi");
        let expected = words_replaced(&expected, "dx", "dtheta_");
        let expected = words_replaced(&expected, "x", "theta");
        let iterates = (0..8).fold(expected, |text, k| {
            words_replaced(&text, &format!("x{k}"), &format!("theta{k}"))
        });
        let expected = words_replaced(&iterates, "dtheta", "dphi");
        let expected = words_replaced(&expected, "dtheta_", "dtheta");
        assert_eq!(text(&named), expected, "{}", method.name());
    }
}

/// A text with another word in the place of one.
fn words_replaced(text: &str, word: &str, by: &str) -> String {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut replaced = String::new();
    for part in text.split_inclusive(|letter| !is_letter(letter)) {
        let name = part.trim_end_matches(|letter| !is_letter(letter));
        replaced += &match name == word {
            true => part.replacen(word, by, 1),
            false => part.to_owned(),
        };
    }
    replaced
}

/// The names of an equation stand in its answer as they were typed, and the letters of the answer
/// give way: in numbers it is the answer to the same equation with other names.
#[test]
fn letters_of_an_answer_give_way_to_names_of_the_equation() {
    for (own, plain) in [
        ("x'' + omega^2*x + A*x^3 = 0", "x'' + k^2*x + c*x^3 = 0"),
        ("A'' + omega^2*A + a*A^3 = 0", "x'' + k^2*x + c*x^3 = 0"),
        ("omega'' + A^2*omega + a*omega^3 = 0", "x'' + k^2*x + c*x^3 = 0"),
    ] {
        let typed = Oscillator::parse(own).expect("an equation");
        assert!(solve(&typed, &Options::default()).is_err());
        let apart = typed.with_own_names_apart().expect("names of its own");
        let others = Oscillator::parse(plain).expect("an equation");
        let by = |name: &str| apart.parameters.iter().copied().find(|own| own.name() == name);
        let stiffness = by("omega").or(by("A")).expect("a parameter");
        let nonlinear = apart.parameters.iter().copied().find(|own| *own != stiffness);
        let nonlinear = nonlinear.expect("another one");
        for method in Method::ALL {
            let options = Options { method: Some(method), ..Options::default() };
            let (Ok(found), Ok(expected)) = (solve(&apart, &options), solve(&others, &options))
            else {
                panic!("{own} by {}", method.name());
            };
            let amplitude = found.amplitude.symbol();
            let at = BTreeMap::from([(amplitude, 0.5), (stiffness, 1.5), (nonlinear, 0.75)]);
            let found_value = evaluate(&apart, &found, &at).expect("a value").frequency_squared;
            let at = BTreeMap::from([(amplitude, 0.5), ("k".into(), 1.5), ("c".into(), 0.75)]);
            let expected_value =
                evaluate(&others, &expected, &at).expect("a value").frequency_squared;
            assert!(
                (found_value / expected_value - 1.0).abs() < 1e-12,
                "{own} by {}",
                method.name()
            );
            // Every name of the equation stands where it stands in the answer to the other, every
            // letter of the answer likewise.
            let letters = found.letters();
            let report = text::solution(&found, None) + &text::steps(&found);
            let words_found = words(&report);
            let report = text::solution(&expected, None) + &text::steps(&expected);
            let words_expected = words(&report);
            let count =
                |words: &BTreeMap<&str, usize>, name: &str| words.get(name).copied().unwrap_or(0);
            let primed = |name: &str| count(&words_found, name);
            assert_eq!(
                primed(stiffness.name()),
                count(&words_expected, "k"),
                "{own} by {}",
                method.name()
            );
            for (letter, usual) in [(letters.amplitude, "A"), (letters.frequency, "omega")] {
                let of_answer = primed(letter.name());
                assert_eq!(
                    of_answer,
                    count(&words_expected, usual),
                    "{letter} in {own} by {}",
                    method.name()
                );
            }
        }
    }
}

/// Letters in force are those of the equation that was asked about, in sentences too.
#[test]
fn letters_stand_in_every_format() {
    let oscillator = Oscillator::parse("x'' + omega^2*x + A*x^3 = 0").expect("an equation");
    let apart = oscillator.with_own_names_apart().expect("names of its own");
    let solution = solve(&apart, &Options::default()).expect("a law");
    assert_eq!(solution.formula(), "Omega^2 = omega^2 + 3*A*C^2/4 - 3*A^2*C^4/(128*omega^2)");
    let article = latex::solution(&solution, None);
    assert!(article.contains(r"\Omega^{2} &= \omega^{2} + \frac{3 A C^{2}}{4}"), "{article}");
    let document = json::solution(&solution, None);
    assert_eq!(document.parameters, ["A", "omega"]);
    let at = [("C", "1"), ("A", "1/10"), ("omega", "2")]
        .map(|(name, value)| (name.into(), value.parse().unwrap()));
    let mut values = lindstedt::Values::default();
    for (name, value) in at {
        values.insert(apart.resolve_symbol(name), value).expect("a value");
    }
    let judged = lindstedt::judge(&apart, &solution, &values, 0.01).expect("a verdict");
    let report = text::solution(&solution, Some(&judged));
    assert!(report.contains("at C = 1, A = 1/10, omega = 2\n  Omega  "), "{report}");
    assert!(report.contains("within 1 % up to C = "), "{report}");
    let read = json::read_solution(&serde_json::to_value(&document).expect("a document"))
        .expect("a solution");
    assert_eq!((read.law, read.displacement), (solution.law, solution.displacement));
}

/// The values under the names that they are meant for.
fn meant(oscillator: &Oscillator, at: &str) -> lindstedt::Values {
    let typed: lindstedt::Values = at.parse().expect("values");
    let mut values = lindstedt::Values::default();
    for (name, value) in typed.iter() {
        values.insert(oscillator.resolve_symbol(name), value.clone()).expect("a value");
    }
    values
}

/// A certificate of an equation with parameters or a coordinate called as something in its answer
/// proves what that of the same equation with other names proves, of a law in the letters of the
/// former, which its document says.
#[test]
fn certificates_keep_the_letters_of_the_equation() {
    let pairs = [
        (
            ("x'' + omega^2*x + A*x^3 = 0", "omega = 2, A = 1/10, C = 1"),
            ("x'' + k^2*x + b*x^3 = 0", "k = 2, b = 1/10, A = 1"),
            "Omega^2 = omega^2",
        ),
        (("A'' + sin(A) = 0", "C = 1"), ("x'' + sin(x) = 0", "A = 1"), "omega^2 = 1 - C^2/8"),
        (
            ("omega'' + omega + A*omega^2 = 0", "A = 1/10, C = 1/2"),
            ("x'' + x + b*x^2 = 0", "b = 1/10, A = 1/2"),
            "Omega^2 = 1 - 5*A^2*C^2/6",
        ),
    ];
    for ((own, at), (plain, plain_at), law) in pairs {
        let oscillator = Oscillator::parse(own).and_then(|typed| typed.with_own_names_apart());
        let oscillator = oscillator.expect(own);
        let solution = solve(&oscillator, &Options::default()).expect(own);
        let (certificate, certified) =
            certificate::certify(&oscillator, &solution, &meant(&oscillator, at)).expect(own);
        let other = Oscillator::parse(plain).expect(plain);
        let solution = solve(&other, &Options::default()).expect(plain);
        let (expected, proved) =
            certificate::certify(&other, &solution, &plain_at.parse().expect("values"))
                .expect(plain);
        assert_eq!(certified, proved, "{own}");
        let mut formula = certificate.formula.clone().expect("a formula");
        assert!(formula.law.starts_with(law), "{}", formula.law);
        let expected_formula = expected.formula.clone().expect("a formula");
        (formula.law, formula.letters, formula.values) = (
            expected_formula.law.clone(),
            expected_formula.letters,
            expected_formula.values.clone(),
        );
        assert_eq!(formula, expected_formula, "{own}");
        // As a document, written where the letters of the answer are in force, and read from it.
        let document = {
            let _letters = oscillator.letters().in_force();
            json::certificate(&certificate)
        };
        assert!(document.formula.as_ref().is_some_and(|formula| formula.letters.is_some()));
        assert_eq!(document.read().as_ref(), Ok(&certificate), "{own}");
        assert!(certificate::check(&certificate).expect("a proof").law_is_held, "{own}");
        // An amplitude of the law that is not that of the motion is found under its own letter.
        let mut forged = certificate;
        let formula = forged.formula.as_mut().expect("a formula");
        formula.law = formula.law.replace('C', "(C/2)");
        let twice = |(name, value): (Symbol, &Expr)| match name.name() {
            "C" => (name, value + value),
            _ => (name, value.clone()),
        };
        let (names, doubled): (Vec<Symbol>, Vec<Expr>) = formula.values.iter().map(twice).unzip();
        formula.values = lindstedt::Values::default();
        for (name, value) in names.into_iter().zip(doubled) {
            formula.values.insert(name, value).expect("a value");
        }
        let refused = certificate::check(&forged).expect_err("another amplitude");
        assert!(refused.to_string().contains("amplitude"), "{refused}");
    }
}

/// The letters of limit cycles and driven motions likewise.
#[test]
fn certificates_of_cycles_and_driven_motions_keep_the_letters() {
    let cycle = "x'' - a*(1 - x^2)*x' + omega^2*x = 0";
    let oscillator = Oscillator::parse(cycle).and_then(|typed| typed.with_own_names_apart());
    let oscillator = oscillator.expect(cycle);
    let solution = solve(&oscillator, &Options::default()).expect(cycle);
    let at = meant(&oscillator, "a = 1/10, omega = 1");
    let (certificate, _) = certificate::certify_cycle(&oscillator, &solution, &at).expect(cycle);
    let document = json::damped_certificate(&certificate);
    assert_eq!(document.read().as_ref(), Ok(&certificate));
    let formula = document.formula.expect("a formula");
    assert!(formula.law.starts_with("Omega"), "{}", formula.law);
    assert!(certificate::check_damped(&certificate).expect("a proof").law_is_held);

    let driven = "A'' + A'/10 + A + A^3/10 - 3*cos(omega*t)/10 = 0";
    let oscillator = Oscillator::parse(driven).and_then(|typed| typed.with_own_names_apart());
    let oscillator = oscillator.expect(driven);
    let at = meant(&oscillator, "omega = 6/5");
    let options = lindstedt::method::with_resonance_at(&oscillator, &Options::default(), &at);
    let solution = solve(&oscillator, &options.expect(driven)).expect(driven);
    let (certificate, certified) =
        certificate::certify_driven(&oscillator, &solution, &at).expect(driven);
    let formula = certificate.formula.as_ref().expect("a formula");
    assert!(formula.law.starts_with("A = ") && formula.law.contains("omega*t"), "{}", formula.law);
    assert!(certified.law_is_held);
    assert_eq!(json::damped_certificate(&certificate).read().as_ref(), Ok(&certificate));
}
