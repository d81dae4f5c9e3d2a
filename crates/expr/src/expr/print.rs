//! Expressions as text that the parser reads back to the same tree, within its limits: computed
//! numbers and exponents may be longer than it accepts.
//!
//! A product prints as a fraction, numerator over denominator: `8*eps*A/(3*pi)`. [`Expr::fraction`]
//! makes the split, also for the other notations. A long number that is a decimal prints as one,
//! `1e-300`. Powers with a negative number as exponent stand in the denominator; the power 1/2 is
//! written `sqrt(k)`.

use std::fmt::{self, Write};

use num_traits::{One, Signed, Zero};

use super::{Expr, Function, Node};
use crate::decimal::{decimal_of_long_fraction, ends, rounded_fraction};
use crate::exact::rational::{Rational, ratio};

/// A term as sign, numerator and denominator, for printing.
pub struct Fraction {
    /// A minus in front of everything.
    pub negative: bool,
    /// The factors above the line, a number first; empty means 1.
    pub numerator: Vec<Expr>,
    /// The factors below the line, with their exponents turned positive; empty means no line.
    pub denominator: Vec<Expr>,
}

impl Expr {
    /// Sign, numerator and denominator. A sum is its own numerator, with its sign inside.
    pub fn fraction(&self) -> Fraction {
        let (coefficient, factors) = self.written_factors();
        let number = |value: Rational| (!value.is_one()).then(|| Expr::number(value));
        // A decimal stands above the line.
        let (above, below) = match decimal_of_long_fraction(&coefficient) {
            Some(_) => (coefficient.abs(), Rational::one()),
            None => {
                let (above, below) = coefficient.abs().into_raw();
                (Rational::from_integer(above), Rational::from_integer(below))
            }
        };
        let mut numerator: Vec<Expr> = number(above).into_iter().collect();
        let mut denominator: Vec<Expr> = number(below).into_iter().collect();
        for factor in &factors {
            match factor.node() {
                Node::Power(base, exponent) => match exponent.as_number() {
                    Some(number) if (-number).is_one() => denominator.push(base.clone()),
                    Some(number) if number.is_negative() => {
                        let positive = Expr::number(-number);
                        denominator.push(Expr::from_node(Node::Power(base.clone(), positive)));
                    }
                    _ => numerator.push(factor.clone()),
                },
                _ => numerator.push(factor.clone()),
            }
        }
        Fraction { negative: coefficient.is_negative(), numerator, denominator }
    }

    /// The factors as they are written: a long decimal in front is multiplied into a sum whose numbers
    /// are long, `0.25*a - 0.135676274578121*b` for `1e-15*(250000000000000*a - 135676274578121*b)`.
    pub fn written_factors(&self) -> (Rational, Vec<Self>) {
        /// The length in binary digits of a whole number beyond which it is part of a decimal.
        const LONG: u64 = 24;
        let (coefficient, factors) = self.factors();
        let mut factors = factors.to_vec();
        let is_long = |term: &Self| term.factors().0.numer().bits() > LONG;
        let has_digits = |own: &&mut Self| own.terms().len() > 1 && own.terms().iter().any(is_long);
        let decimal = decimal_of_long_fraction(&coefficient);
        match factors.iter_mut().find(has_digits).filter(|_| decimal.is_some()) {
            Some(sum) => {
                let size = Self::number(coefficient.abs());
                let terms = sum.terms().iter().map(|term| &size * term).collect();
                *sum = Self::from_node(Node::Sum(terms));
                (coefficient.signum(), factors)
            }
            None => (coefficient, factors),
        }
    }
}

impl Expr {
    /// Returns the square root of a sum with the number in front of it moved under the root and
    /// long decimals rounded to fifteen digits: `sqrt(1.27901878616664 + A^2)` for the normal form
    /// `1e-14*sqrt(1.27901878616664e28 + ...)`. The result is for display only. Returns `None` for
    /// any other expression.
    pub fn with_number_under_root(&self) -> Option<Self> {
        /// A fraction with more characters than this must be a rounded number.
        const MANY: usize = 16;
        const DIGITS: usize = 15;
        let (number, factors) = self.factors();
        let [root] = factors else { return None };
        let Node::Power(sum, exponent) = root.node() else {
            return None;
        };
        let Node::Sum(terms) = sum.node() else {
            return None;
        };
        if !is_half(exponent) || !number.is_positive() || number.is_one() {
            return None;
        }
        let square = Self::number(&number * &number);
        let inside: Vec<Self> = terms.iter().map(|term| &square * term).collect();
        let is_long = |number: &Rational| !number.is_integer() && number.to_string().len() > MANY;
        let numbers = || inside.iter().map(|term| term.factors().0);
        if !numbers().all(|number| ends(&number)) || !numbers().any(|number| is_long(&number)) {
            return None;
        }
        let rounded = inside.iter().map(|term| {
            let (number, factors) = term.factors();
            let number = match is_long(&number) {
                true => rounded_fraction(&number, DIGITS),
                false => number,
            };
            Self::product(std::iter::once(Self::number(number)).chain(factors.iter().cloned()))
        });
        Some(Self::from_node(Node::Power(Self::sum(rounded), exponent.clone())))
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_expr(self, PrintContext::Free, formatter)
    }
}

/// An expression as it stands in parentheses or below a root, which the caller writes: `A^2 - x^2`
/// for `-x^2 + A^2`.
pub struct Inside<'a>(pub &'a Expr);

impl fmt::Display for Inside<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_expr(self.0, PrintContext::Inside, formatter)
    }
}

/// Writes an expression without recursion: `open` holds the pieces still to be written, the next
/// one last.
fn write_expr(expr: &Expr, place: PrintContext, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
    let mut open = vec![PrintItem::Expr(expr.clone(), place)];
    while let Some(piece) = open.pop() {
        match piece {
            PrintItem::Text(text) => formatter.write_str(text)?,
            PrintItem::Expr(expr, place) => write_node(&expr, place, formatter, &mut open)?,
        }
    }
    Ok(())
}

impl Expr {
    /// The terms in the order in which they stand in parentheses: terms with a leading minus come
    /// after the run of terms without one that follows them.
    pub fn terms_inside(&self) -> impl Iterator<Item = &Self> {
        let terms = self.terms();
        let minus = terms.iter().take_while(|term| term.has_leading_minus()).count();
        let (minus, others) = terms.split_at(minus);
        let plus = others.iter().take_while(|term| !term.has_leading_minus()).count();
        let (plus, others) = others.split_at(plus);
        plus.iter().chain(minus).chain(others)
    }

    /// Returns the negative of a difference, `a - b` for `b - a`, which absorbs a minus in front of
    /// it; `None` for anything else.
    pub fn turned_round(&self) -> Option<Self> {
        match self.terms() {
            [one, other] if !one.has_leading_minus() && other.has_leading_minus() => Some(-self),
            _ => None,
        }
    }
}

enum PrintItem {
    Text(&'static str),
    Expr(Expr, PrintContext),
}

/// The context of an expression, which decides whether it needs parentheses.
#[derive(Clone, Copy, PartialEq)]
enum PrintContext {
    /// The whole expression.
    Free,
    /// An argument, or in parentheses already.
    Inside,
    /// A term after its sign has been written: the sign is left out.
    Unsigned,
    /// A factor above the line.
    Factor,
    /// The base of a power.
    Base,
    /// The exponent of a power.
    Exponent,
}

/// Whether an expression needs parentheses in this context.
fn in_parentheses(expr: &Expr, place: PrintContext) -> bool {
    match expr.node() {
        Node::Symbol(_) | Node::Pi | Node::Function(..) => false,
        Node::Number(value) => match place {
            PrintContext::Free | PrintContext::Inside | PrintContext::Unsigned => false,
            PrintContext::Factor => {
                !value.is_integer() && decimal_of_long_fraction(value).is_none()
            }
            PrintContext::Base | PrintContext::Exponent => {
                !value.is_integer() || value.is_negative()
            }
        },
        Node::Sum(_) => !matches!(place, PrintContext::Free | PrintContext::Inside),
        Node::Product(..) => {
            !matches!(place, PrintContext::Free | PrintContext::Inside | PrintContext::Unsigned)
        }
        Node::Power(_, exponent) => match place {
            PrintContext::Free
            | PrintContext::Inside
            | PrintContext::Unsigned
            | PrintContext::Factor => false,
            PrintContext::Base | PrintContext::Exponent => !is_half(exponent),
        },
    }
}

fn write_node(
    expr: &Expr,
    place: PrintContext,
    out: &mut fmt::Formatter<'_>,
    open: &mut Vec<PrintItem>,
) -> fmt::Result {
    if in_parentheses(expr, place) {
        open.extend([PrintItem::Text(")"), PrintItem::Expr(expr.clone(), PrintContext::Inside)]);
        return out.write_char('(');
    }
    match expr.node() {
        Node::Pi => out.write_str("pi"),
        Node::Symbol(symbol) => out.write_str(symbol.written()),
        Node::Number(value) if place == PrintContext::Unsigned => write_number(&value.abs(), out),
        Node::Number(value) => write_number(value, out),
        Node::Sum(terms) => {
            let terms: Vec<&Expr> = match place {
                PrintContext::Inside => expr.terms_inside().collect(),
                _ => terms.iter().collect(),
            };
            for (index, term) in terms.into_iter().enumerate().rev() {
                open.push(PrintItem::Expr(term.clone(), PrintContext::Unsigned));
                match (index, term.has_leading_minus()) {
                    (0, false) => {}
                    (0, true) => open.push(PrintItem::Text("-")),
                    (_, false) => open.push(PrintItem::Text(" + ")),
                    (_, true) => open.push(PrintItem::Text(" - ")),
                }
            }
            Ok(())
        }
        Node::Function(function, arguments) => {
            open.push(PrintItem::Text(")"));
            for (index, argument) in arguments.iter().enumerate().rev() {
                open.push(PrintItem::Expr(argument.clone(), PrintContext::Inside));
                if index > 0 {
                    open.push(PrintItem::Text(", "));
                }
            }
            write!(out, "{}(", function.name())
        }
        Node::Power(base, exponent) if is_half(exponent) => {
            open.extend([
                PrintItem::Text(")"),
                PrintItem::Expr(base.clone(), PrintContext::Inside),
            ]);
            out.write_str("sqrt(")
        }
        Node::Power(base, exponent) if !exponent.as_number().is_some_and(Signed::is_negative) => {
            open.extend([
                PrintItem::Expr(exponent.clone(), PrintContext::Exponent),
                PrintItem::Text("^"),
                PrintItem::Expr(base.clone(), PrintContext::Base),
            ]);
            Ok(())
        }
        Node::Product(..) | Node::Power(..) => {
            let mut fraction = expr.fraction();
            let mut has_minus = false;
            if fraction.negative && place != PrintContext::Unsigned {
                let mut factors = fraction.numerator.iter_mut();
                match factors.find_map(|factor| Some((factor.turned_round()?, factor))) {
                    Some((turned, factor)) => *factor = turned,
                    None => {
                        has_minus = true;
                        out.write_char('-')?;
                    }
                }
            }
            let is_alone = fraction.denominator.is_empty() && !has_minus;
            match fraction.numerator.as_slice() {
                // A sum that has taken the number in front of it stands alone.
                [only] if is_alone && !in_parentheses(only, place) => {
                    open.push(PrintItem::Expr(only.clone(), place));
                }
                _ => push_fraction(&fraction, open),
            }
            Ok(())
        }
    }
}

/// Writes a fraction; as a decimal if it is long and terminates.
fn write_number(value: &Rational, out: &mut fmt::Formatter<'_>) -> fmt::Result {
    match decimal_of_long_fraction(value) {
        Some(decimal) => out.write_str(&decimal),
        None => write!(out, "{value}"),
    }
}

/// Pushes numerator and denominator, without the sign.
fn push_fraction(fraction: &Fraction, open: &mut Vec<PrintItem>) {
    match fraction.denominator.as_slice() {
        [] => {}
        [only] => {
            open.extend([PrintItem::Expr(only.clone(), PrintContext::Factor), PrintItem::Text("/")])
        }
        several => {
            open.push(PrintItem::Text(")"));
            push_factors(several, open);
            open.push(PrintItem::Text("/("));
        }
    }
    match fraction.numerator.as_slice() {
        [] => open.push(PrintItem::Text("1")),
        factors => push_factors(factors, open),
    }
}

fn push_factors(factors: &[Expr], open: &mut Vec<PrintItem>) {
    for (index, factor) in factors.iter().enumerate().rev() {
        open.push(PrintItem::Expr(factor.clone(), PrintContext::Factor));
        if index > 0 {
            open.push(PrintItem::Text("*"));
        }
    }
}

fn is_half(exponent: &Expr) -> bool {
    exponent.as_number().is_some_and(|number| {
        number.numer() == ratio(1, 2).numer() && number.denom() == ratio(1, 2).denom()
    })
}

/// The text of an expression, cut off to fit into a message.
pub(super) fn in_message(expr: &Expr) -> String {
    let mut text = Shortened(String::new());
    // The formatter's only error is that the rest was cut off.
    match is_long_number(expr) {
        true => "a long number".into(),
        false if write!(text, "{expr}").is_err() => text.0 + "...",
        false => text.0,
    }
}

/// `base^exponent`, without building it.
pub(super) fn power_in_message(base: &Expr, exponent: &Expr) -> String {
    let part = |expr: &Expr| match expr.node() {
        Node::Symbol(_) | Node::Pi | Node::Function(..) => in_message(expr),
        Node::Number(value) if value.is_integer() && !value.is_negative() => in_message(expr),
        _ => format!("({})", in_message(expr)),
    };
    format!("{}^{}", part(base), part(exponent))
}

/// `function(arguments)`, without building it.
pub(super) fn call_in_message(function: Function, arguments: &[Expr]) -> String {
    let arguments: Vec<String> = arguments.iter().map(in_message).collect();
    format!("{}({})", function.name(), arguments.join(", "))
}

fn is_long_number(expr: &Expr) -> bool {
    expr.as_number().is_some_and(|number| {
        !number.is_zero() && number.numer().bits() + number.denom().bits() > 4_096
    })
}

struct Shortened(String);

impl Write for Shortened {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        const LONGEST: usize = 40;
        let room = LONGEST.saturating_sub(self.0.chars().count());
        self.0.extend(text.chars().take(room));
        if text.chars().count() > room { Err(fmt::Error) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::{Expr, parse_expression};

    /// Prints as it is written here, and reads back to the same tree.
    #[test]
    fn prints_as_people_write() {
        for text in [
            "1 - A^2/8",
            "3*eps*A^2/4",
            "x'' + 2*zeta*x' + sin(x)",
            "x'' + x - eps*x'*(1 - x^2)",
            "gamma*(x - xc)^(3/2)*H(x - xc)",
            "sqrt(k)",
            "1/sqrt(k)",
            "x^(3/2)",
            "8*eps*A/(3*pi)",
            "-x/6",
            "-1/2",
            "1/(1 + x^2)",
            "-3/(x*(1 + x)^2)",
            "2/(3*x^2)",
            "(1 + x)/y",
            "-y*(1 + x)/3",
            "x^(-y)",
            "2^(-x)",
            "(-2)^x",
            "(1/2)^x",
            "-2^x",
            "x^y^z",
            "(x^y)^z",
            "(x^2)^(1/3)",
            "sqrt(x)^(1/3)",
            "sqrt(1/x)",
            "x^sin(y)",
            "x^sqrt(y)",
            "2*sqrt(3)*pi*k",
            "max(x, -y)",
            "1/(pi*x)",
            "pi/2",
            "-sin(x)/(2*cos(1 - x)^2)",
        ] {
            // `x^y^z` groups to the right and prints with parentheses.
            let expected = if text == "x^y^z" { "x^(y^z)" } else { text };
            let expr = parse_expression(text).unwrap();
            assert_eq!(expr.to_string(), expected);
            assert_eq!(parse_expression(expected).unwrap(), expr, "{text}");
        }
    }

    #[test]
    fn long_fractions_that_end_are_decimals() {
        for (text, printed) in [
            ("1e-300", "1e-300"),
            ("-1.5e-10", "-1.5e-10"),
            ("3.00853856091339", "3.00853856091339"),
            ("0.00012345678901", "0.00012345678901"),
            ("1234567890.12345", "1234567890.12345"),
            ("1e300", "1e300"),
            ("-12e200", "-1.2e201"),
            ("123456789012345678901", "123456789012345678901"),
            // Short ones, those that do not end, and those that are longer as decimals.
            ("0.323", "323/1000"),
            ("1e-6", "1/1000000"),
            ("1/30000000000000", "1/30000000000000"),
            ("549183/2097152", "549183/2097152"),
            ("7/4503599627370496", "7/4503599627370496"),
            ("A/403291461126605635584000000", "A/403291461126605635584000000"),
            ("0.1234567890123456789", "1234567890123456789/10000000000000000000"),
        ] {
            let number = parse_expression(text).unwrap();
            assert_eq!(number.to_string(), printed);
            assert_eq!(parse_expression(printed).unwrap(), number, "{text}");
        }
    }

    #[test]
    fn decimals_stand_under_their_root() {
        for (text, printed) in [
            (
                "sqrt(1.41421356237309 + 1.06066017177982*A^2)",
                Some("sqrt(1.41421356237309 + 1.06066017177982*A^2)"),
            ),
            ("sqrt(4.76220315590459 + 3*A^2/4)", Some("sqrt(4.76220315590459 + 3*A^2/4)")),
            (
                "1.6e-13*sqrt(5.52427172801989e25 + 4.14320379601491e25*A^2 + 2.58950237250933e25*A^4)",
                Some("sqrt(1.41421356237309 + 1.06066017177982*A^2 + 0.662912607362388*A^4)"),
            ),
            ("sqrt(4 + 3*A^2)/2", None),
            ("sqrt(1234567890123456 + A^2)/1234567890123457", None),
            ("7*sqrt(A)/3", None),
            ("3*sqrt(2)", None),
        ] {
            let expr = parse_expression(text).unwrap();
            let read = expr.with_number_under_root();
            assert_eq!(read.as_ref().map(ToString::to_string).as_deref(), printed, "{text}");
        }
    }

    /// A long decimal stands in the sum that it multiplies, with its sign, and is read back as the same.
    #[test]
    fn decimals_are_written_into_sums() {
        for (text, printed) in [
            ("x*(a - 0.242705098312484*b)", "x*(a - 0.242705098312484*b)"),
            ("-(a + 0.242705098312484*b)*x", "-x*(a + 0.242705098312484*b)"),
            ("0.242705098312484*x*(a + 3*b)", "0.242705098312484*x*(a + 3*b)"),
        ] {
            let expr = parse_expression(text).unwrap();
            assert_eq!(expr.to_string(), printed);
            assert_eq!(parse_expression(printed).unwrap(), expr);
        }
    }

    #[test]
    fn fractions_split() {
        let texts = |list: &[Expr]| list.iter().map(ToString::to_string).collect::<Vec<_>>();
        let fraction = parse_expression("-8*eps*A/(3*pi*sqrt(k))").unwrap().fraction();
        assert!(fraction.negative);
        assert_eq!(texts(&fraction.numerator), ["8", "eps", "A"]);
        assert_eq!(texts(&fraction.denominator), ["3", "pi", "sqrt(k)"]);
        let whole = parse_expression("1/x").unwrap().fraction();
        assert!(
            !whole.negative && whole.numerator.is_empty() && texts(&whole.denominator) == ["x"]
        );
    }
}
