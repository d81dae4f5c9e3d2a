//! Expressions as LaTeX: fractions with a line, roots under a sign, names with their indices.

use num_traits::{One, Signed};

use crate::decimal::decimal_of_long_fraction;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, Function, Node};
use crate::symbol::{GREEK, Symbol};

/// An expression. The algorithm is not recursive: `open` is a stack of the pieces still to be
/// written.
///
/// ```
/// use lindstedt::{export::latex, expr::parse_expression};
///
/// assert_eq!(latex::expression(&parse_expression("sqrt(1 + A^2)/2")?), r"\frac{\sqrt{1 + A^{2}}}{2}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn expression(expression: &Expr) -> String {
    written(expression, LatexContext::Free)
}

/// An expression for parentheses or a root that the caller writes.
pub fn inside(expression: &Expr) -> String {
    written(expression, LatexContext::Inside)
}

fn written(expression: &Expr, place: LatexContext) -> String {
    let mut text = String::new();
    let mut open = vec![LatexItem::Expr(expression.clone(), place)];
    while let Some(piece) = open.pop() {
        match piece {
            LatexItem::Text(piece) => text.push_str(&piece),
            LatexItem::Expr(expr, place) => open.extend(pieces(&expr, place).into_iter().rev()),
        }
    }
    text
}

enum LatexItem {
    Text(String),
    Expr(Expr, LatexContext),
}

/// The context of an expression, which decides whether it needs parentheses.
#[derive(Clone, Copy, PartialEq)]
enum LatexContext {
    /// The whole expression.
    Free,
    /// An argument, or between braces or parentheses already.
    Inside,
    /// A term after its sign has been written: the sign is left out.
    Unsigned,
    /// A single term whose minus sign was absorbed by reversing a difference in the numerator.
    Turned,
    /// A factor that needs no sign between itself and its neighbours.
    Factor,
}

fn text(text: impl Into<String>) -> LatexItem {
    LatexItem::Text(text.into())
}

/// One level of an expression, in reading order.
fn pieces(expr: &Expr, place: LatexContext) -> Vec<LatexItem> {
    let is_negative = |term: &Expr| term.factors().0.is_negative();
    match place {
        LatexContext::Factor => factor(expr),
        LatexContext::Unsigned => term(expr, false),
        LatexContext::Turned => term(expr, true),
        LatexContext::Free | LatexContext::Inside
            if is_negative(expr) && difference(expr).is_some() =>
        {
            vec![LatexItem::Expr(expr.clone(), LatexContext::Turned)]
        }
        LatexContext::Free | LatexContext::Inside => {
            let terms: Vec<&Expr> = match place {
                LatexContext::Inside => expr.terms_inside().collect(),
                _ => expr.terms().iter().collect(),
            };
            let signed = terms.into_iter().enumerate().flat_map(|(index, term)| {
                let sign = match (index, is_negative(term)) {
                    (0, false) => "",
                    (0, true) => "-",
                    (_, false) => " + ",
                    (_, true) => " - ",
                };
                [text(sign), LatexItem::Expr(term.clone(), LatexContext::Unsigned)]
            });
            signed.collect()
        }
    }
}

/// The first difference in the numerator of a product, and that difference reversed; none in a product
/// whose number is multiplied into a sum.
fn difference(product: &Expr) -> Option<(usize, Expr)> {
    let (coefficient, factors) = product.factors();
    if product.written_factors().0 != coefficient {
        return None;
    }
    let mut turned = factors.iter().map(Expr::turned_round).enumerate();
    turned.find_map(|(place, turned)| Some((place, turned?)))
}

/// One term without its sign, as a fraction where there is a denominator; with its first difference
/// reversed if `turn` is set.
fn term(term: &Expr, turn: bool) -> Vec<LatexItem> {
    let (coefficient, factors) = term.written_factors();
    let (mut above, mut below) = (vec![], vec![]);
    let turned = if turn { difference(term) } else { None };
    for (place, factor) in factors.iter().enumerate() {
        let (base, exponent) = match &turned {
            Some((turned, difference)) if *turned == place => (difference.clone(), Expr::one()),
            _ => factor.base_and_exponent(),
        };
        match exponent.as_number() {
            Some(number) if number.is_negative() => below.push((base, Expr::number(-number))),
            _ => above.push((base, exponent)),
        }
    }
    // A decimal is part of the numerator.
    let decimal = decimal_of_long_fraction(&coefficient.abs());
    let (numerator, denominator) = match decimal {
        Some(decimal) => (super::scientific_text(&decimal), Integer::one()),
        None => (coefficient.numer().abs().to_string(), coefficient.denom().clone()),
    };
    let is_fraction = !denominator.is_one() || !below.is_empty();
    let above = match above.as_slice() {
        // A single base in the denominator needs no parentheses.
        [(base, exponent)] if is_fraction && numerator == "1" && exponent.is_one() => {
            vec![LatexItem::Expr(base.clone(), LatexContext::Inside)]
        }
        _ => row((numerator != "1" || above.is_empty()).then_some(numerator), &above),
    };
    let below = match below.as_slice() {
        [] if denominator.is_one() => return above,
        // A single factor in the denominator is between braces already.
        [(base, exponent)] if denominator.is_one() && exponent.is_one() => {
            vec![LatexItem::Expr(base.clone(), LatexContext::Inside)]
        }
        _ => row((!denominator.is_one()).then(|| denominator.to_string()), &below),
    };
    let line = [vec![text("\\frac{")], above, vec![text("}{")], below, vec![text("}")]];
    line.into_iter().flatten().collect()
}

/// A number and powers, side by side.
fn row(number: Option<String>, factors: &[(Expr, Expr)]) -> Vec<LatexItem> {
    let number = number.map(|number| vec![text(number)]);
    let powers = factors.iter().map(|(base, exponent)| power(base, exponent));
    let mut row = Vec::new();
    for factor in number.into_iter().chain(powers) {
        if !row.is_empty() {
            row.push(text(" "));
        }
        row.extend(factor);
    }
    row
}

fn power(base: &Expr, exponent: &Expr) -> Vec<LatexItem> {
    let half = Rational::new(1.into(), 2.into());
    let exponent = match exponent.as_number() {
        Some(number) if number.is_one() => {
            return vec![LatexItem::Expr(base.clone(), LatexContext::Factor)];
        }
        Some(number) if *number == half => {
            return vec![
                text("\\sqrt{"),
                LatexItem::Expr(base.clone(), LatexContext::Inside),
                text("}"),
            ];
        }
        Some(number) if !number.is_integer() => {
            text(format!("{}/{}", number.numer(), number.denom()))
        }
        _ => LatexItem::Expr(exponent.clone(), LatexContext::Inside),
    };
    // The exponent of a function precedes its argument, `\sin^{2} x`; a power has an exponent
    // already, and a derivative needs braces around its primes.
    let mut power = match base.node() {
        Node::Symbol(symbol) if symbol.primes() > 0 => {
            vec![text(format!("{{{}}}", self::symbol(*symbol)))]
        }
        Node::Function(..) | Node::Power(..) => in_parentheses(base),
        _ => vec![LatexItem::Expr(base.clone(), LatexContext::Factor)],
    };
    power.extend([text("^{"), exponent, text("}")]);
    power
}

fn in_parentheses(expr: &Expr) -> Vec<LatexItem> {
    vec![text("\\left("), LatexItem::Expr(expr.clone(), LatexContext::Inside), text("\\right)")]
}

/// A factor that needs no sign between itself and its neighbours.
fn factor(factor: &Expr) -> Vec<LatexItem> {
    match factor.node() {
        Node::Number(number) if number.is_integer() && !number.is_negative() => {
            vec![text(number.to_string())]
        }
        Node::Pi => vec![text("\\pi")],
        Node::Symbol(symbol) => vec![text(self::symbol(*symbol))],
        Node::Function(function, arguments) => call(*function, arguments),
        Node::Power(base, exponent) => power(base, exponent),
        Node::Number(_) | Node::Sum(_) | Node::Product(..) => in_parentheses(factor),
    }
}

fn call(function: Function, arguments: &[Expr]) -> Vec<LatexItem> {
    let name = match function {
        Function::Absolute => "",
        Function::Asin => "\\arcsin",
        Function::Acos => "\\arccos",
        Function::Atan => "\\arctan",
        Function::Asinh => "\\operatorname{arsinh}",
        Function::Log => "\\ln",
        Function::Sign => "\\operatorname{sgn}",
        Function::Step => "\\mathrm{H}",
        Function::Sin => "\\sin",
        Function::Cos => "\\cos",
        Function::Tan => "\\tan",
        Function::Sinh => "\\sinh",
        Function::Cosh => "\\cosh",
        Function::Tanh => "\\tanh",
        Function::Exp => "\\exp",
        Function::Maximum => "\\max",
        Function::Minimum => "\\min",
        Function::BesselJ0 => "\\mathrm{J}_{0}",
        Function::BesselJ1 => "\\mathrm{J}_{1}",
        Function::BesselI0 => "\\mathrm{I}_{0}",
        Function::BesselI1 => "\\mathrm{I}_{1}",
        Function::Gamma => "\\Gamma",
        Function::EllipticK => "\\mathrm{K}",
        Function::JacobiSn => "\\operatorname{sn}",
        Function::JacobiCn => "\\operatorname{cn}",
        Function::JacobiDn => "\\operatorname{dn}",
    };
    let [open, close] = match function {
        Function::Absolute => ["\\left|", "\\right|"],
        _ => ["\\left(", "\\right)"],
    };
    let mut call = vec![text(name), text(open)];
    for (index, argument) in arguments.iter().enumerate() {
        if index > 0 {
            call.push(text(", "));
        }
        call.push(LatexItem::Expr(argument.clone(), LatexContext::Inside));
    }
    call.push(text(close));
    call
}

/// A name: Greek letters by name, digits and what follows an underscore as an index, primes as dots
/// over the letter, underscores at the end as tildes. No two names look alike: where two spellings
/// would meet, the index of the one with an underscore takes another shape, `k1` being `k_{1}` and
/// `k_1` being `k_{\mathit{1}}`.
pub fn symbol(symbol: Symbol) -> String {
    let bare = symbol.coordinate().written();
    // A decimal that is to stay as it is written.
    if bare.starts_with(|letter: char| letter.is_ascii_digit()) {
        return super::scientific_text(bare);
    }
    let name = bare.trim_end_matches('_');
    let (stem, index) = match name.split_once('_') {
        Some((stem, index)) if index.bytes().all(|letter| letter.is_ascii_digit()) => {
            (stem, format!("\\mathit{{{index}}}"))
        }
        // The barrier's position `xc` is written like this already.
        Some(("x", "c")) => ("x", "\\mathrm{c}".to_owned()),
        Some((stem, index)) => (stem, index.replace('_', "\\_")),
        None if name == "xc" => ("x", "c".to_owned()),
        None => {
            let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
            (stem, name[stem.len()..].to_owned())
        }
    };
    let letter = match stem {
        "eps" => "\\varepsilon".to_owned(),
        "epsilon" => "\\epsilon".to_owned(),
        "hbar" => "\\hbar".to_owned(),
        // Functions stand upright, parameters do not: Gamma(1/4) beside a parameter Gamma.
        "Gamma" => "\\mathit{\\Gamma}".to_owned(),
        _ if GREEK.contains(&stem) => format!("\\{stem}"),
        _ if stem.chars().count() == 1 => stem.to_owned(),
        _ => format!("\\mathrm{{{stem}}}"),
    };
    let letter = (name.len()..bare.len()).fold(letter, |letter, _| format!("\\tilde{{{letter}}}"));
    let letter = match symbol.primes() {
        0 => letter,
        1 => format!("\\dot{{{letter}}}"),
        _ => format!("\\ddot{{{letter}}}"),
    };
    match index.is_empty() {
        true => letter,
        false => format!("{letter}_{{{index}}}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    #[test]
    fn expressions_as_in_an_article() {
        for (text, expected) in [
            ("1 - A^2/8 + 7*A^4/1536", r"1 - \frac{A^{2}}{8} + \frac{7 A^{4}}{1536}"),
            ("x'' + 2*zeta*x' + sin(x)", r"\ddot{x} + 2 \zeta \dot{x} + \sin\left(x\right)"),
            (
                "omega0 + 3*eps*A^2/(8*omega0)",
                r"\omega_{0} + \frac{3 \varepsilon A^{2}}{8 \omega_{0}}",
            ),
            (
                "gamma*(x - xc)^(3/2)*H(x - xc)",
                r"\gamma \left(x - x_{c}\right)^{3/2} \mathrm{H}\left(x - x_{c}\right)",
            ),
            ("sqrt(k + 1)", r"\sqrt{1 + k}"),
            ("-x/2", r"-\frac{x}{2}"),
            ("x'^2*abs(x)", r"{\dot{x}}^{2} \left|x\right|"),
            ("mass1*x", r"\mathrm{mass}_{1} x"),
            ("exp(-x)/(1 + x^2)", r"\frac{\exp\left(-x\right)}{1 + x^{2}}"),
            ("-2*y*(1 + x)/3", r"-\frac{2 y \left(1 + x\right)}{3}"),
            ("(x^2)^(3/2)", r"\left(x^{2}\right)^{3/2}"),
            ("1/(1 + sin(x))", r"\frac{1}{1 + \sin\left(x\right)}"),
            (
                "2*(cos(b) - cos(a))/y",
                r"\frac{2 \left(\cos\left(b\right) - \cos\left(a\right)\right)}{y}",
            ),
            ("-(b - a)/y", r"\frac{a - b}{y}"),
            ("sqrt(b - a)*y", r"y \sqrt{b - a}"),
            ("1.23456789012345*x/y", r"\frac{1.23456789012345 x}{y}"),
            ("2.5e-20*x^2", r"2.5 \cdot 10^{-20} x^{2}"),
        ] {
            let parsed = parse_expression(text).expect(text);
            assert_eq!(expression(&parsed), expected, "{text}");
        }
    }

    #[test]
    fn the_depth_of_a_tree_meets_no_stack() {
        let (x, one) = (Expr::symbol("x"), Expr::one());
        let sines = (0..100_000).fold(x.clone(), |inner, _| inner.sin().expect("a sine"));
        assert_eq!(expression(&sines).matches("\\sin").count(), 100_000);
        let nested = (0..100_000).fold(x.clone(), |inner, _| &x * (&one + &x * inner));
        assert_eq!(expression(&nested).matches("1 + ").count(), 100_000);
    }

    /// Every name of up to four signs over an alphabet of letters, digits and underscores, and
    /// those with a meaning of their own: as many spellings as names.
    #[test]
    fn no_two_names_are_spelt_alike() {
        let stems = [
            "k",
            "x",
            "xc",
            "eps",
            "epsilon",
            "varepsilon",
            "mu",
            "omega",
            "Omega",
            "hbar",
            "c",
            "W",
            "nu",
            "v",
            "A",
            "K",
        ];
        let mut ends = vec![String::new()];
        for length in 0..4 {
            let longer = ends.iter().filter(|end| end.len() == length);
            let longer: Vec<String> = longer
                .flat_map(|end| ["0", "1", "_", "c", "k"].map(|sign| format!("{end}{sign}")))
                .collect();
            ends.extend(longer);
        }
        let mut seen = std::collections::BTreeMap::new();
        for name in stems.iter().flat_map(|stem| ends.iter().map(move |end| format!("{stem}{end}")))
        {
            if let Some(other) = seen.insert(symbol(Symbol::new(&name)), name.clone()) {
                assert_eq!(other, name);
            }
        }
        assert!(seen.len() > 10_000);
        assert_eq!(symbol("k1".into()), "k_{1}");
        assert_eq!(symbol("k_1".into()), r"k_{\mathit{1}}");
        assert_eq!(symbol("omega0_".into()), r"\tilde{\omega}_{0}");
    }
}
