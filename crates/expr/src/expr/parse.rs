//! Text to expressions and equations.
//!
//! ```text
//! equation = sum [ "=" sum ]                     a missing `= 0` is assumed
//! sum      = product { ("+" | "-") product }
//! product  = unary { ("*" | "/") unary }
//! unary    = { "+" | "-" } power                 -x^2 is -(x^2)
//! power    = primary [ ("^" | "**") unary ]      x^y^z is x^(y^z)
//! primary  = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! name     = letter { letter | digit | "_" } { "'" }
//! number   = digits [ "." digits ] [ "e" [sign] digits ]       exact: 0.323 is 323/1000
//! ```
//!
//! Every error names the place and, if possible, the right spelling. Reading ends quickly for every
//! text: its length, its nesting, the digits and exponents of its numbers and the work of bringing
//! it into normal form are limited.

mod brackets;
mod error;
mod lexer;
mod mistakes;
mod notation;
mod relations;

use std::fmt;
use std::ops::Range;

use num_traits::Zero;

use super::typed::{Typed, TypedTerm};
use super::{Expr, ExprError, Function, LARGEST_EXPONENT, normal, number};
use crate::exact::rational::{Integer, Rational};
use crate::symbol::Symbol;

pub use error::ParseError;
pub use error::excerpt;
use error::shortened;
use lexer::{Token, TokenKind};
pub use notation::{equation_in_grammar, expression_in_grammar};
pub use relations::{Assignments, parse_equations, parse_event, parse_inequality};

/// Names of the amplitudes and the frequency in an answer. If an equation uses one of them as a
/// parameter, `Oscillator::with_own_names_apart` keeps it apart before a formula is derived, and
/// the answer writes another letter. `omega0` and `theta` are not among them: if an equation has
/// these names, the answer writes `omega0_` and `phi`.
pub const NAMES_OF_ANSWERS: [&str; 3] = ["A", "a", "omega"];

/// Spellings of NaN and infinity, which are not numbers of the grammar.
const NOT_NUMBERS: [&str; 3] = ["nan", "inf", "infinity"];

/// The deepest nesting of parentheses, calls, powers and signs together.
const DEEPEST: usize = 256;
/// The most digits of one number.
const MOST_DIGITS: usize = 1_000;
/// The largest exponent after the `e` of a number.
const LARGEST_DECIMAL_EXPONENT: usize = 400;
/// The effort of building the normal form, in steps of about a microsecond.
const MOST_WORK: u64 = 500_000;

/// An equation of motion as it was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Equation {
    /// The left side.
    pub left: Expr,
    /// The right side; 0 if there is no equals sign.
    pub right: Expr,
    /// The dependent variable: the letter that carries primes, `x` if none does.
    pub coordinate: Symbol,
    /// The terms as they were typed.
    pub typed: Typed,
}

impl fmt::Display for Equation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} = {}", self.left, self.right)
    }
}

/// Reads an expression. Every printed expression can be read, so the names of answers (`A`,
/// `theta`, `omega`) and special functions (`J1(A)`) are allowed, and so are primes after longer
/// names.
///
/// # Errors
/// See [`ParseError`].
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::parse_expression;
///
/// assert_eq!(parse_expression("x + x + 1/2*2")?.to_string(), "1 + 2*x");
/// # Ok::<(), lindstedt::expr::ParseError>(())
/// ```
pub fn parse_expression(text: &str) -> Result<Expr, ParseError> {
    let mut parser = Parser::new(text, true)?;
    let expr = parser.sum()?;
    match parser.peek() {
        TokenKind::End => Ok(expr),
        TokenKind::Equals => Err(parser.error(
            parser.token().span(),
            "an `=` in an expression",
            "an equation is expected elsewhere",
        )),
        _ => Err(parser.unexpected()),
    }
}

/// Reads an equation of motion such as `x'' + x + eps*x^3 = 0`.
///
/// # Errors
/// See [`ParseError`]; also for a coordinate with one of the [`NAMES_OF_ANSWERS`], and for primes
/// on more than a letter, a Greek one by name, with or without an index.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::parse_equation;
///
/// assert_eq!(parse_equation("y'' + sin(y) = 0")?.coordinate, "y".into());
/// assert!(parse_equation("x'' + 2 x = 0)").is_err());
/// # Ok::<(), lindstedt::expr::ParseError>(())
/// ```
pub fn parse_equation(text: &str) -> Result<Equation, ParseError> {
    let mut parser = Parser::new(text, false)?;
    let coordinate = parser.coordinate()?;
    let (left, mut terms) = parser.side(false, coordinate)?;
    let mut right = Expr::zero();
    if parser.peek() == TokenKind::Equals {
        let first = parser.advance();
        if parser.peek() == TokenKind::Equals && parser.token().start == first.end {
            let span = first.start..parser.token().end;
            return Err(parser.error(span, "`==`: an equation has a single sign", "try `=`"));
        }
        let (sum, typed) = parser.side(true, coordinate)?;
        right = sum;
        terms.extend(typed);
    }
    match parser.peek() {
        TokenKind::End => Ok(Equation { left, right, coordinate, typed: Typed::new(text, terms) }),
        TokenKind::Equals => {
            Err(parser.error(parser.token().span(), "a second `=`", "an equation has one"))
        }
        _ => Err(parser.unexpected()),
    }
}

struct Parser<'a> {
    text: &'a str,
    /// The tokens, the last of which is `End`; the parser never advances beyond it.
    tokens: Vec<Token>,
    next: usize,
    depth: usize,
    work: u64,
    /// Whether special functions may occur, as they do in answers.
    special: bool,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, special: bool) -> Result<Self, ParseError> {
        let tokens = lexer::tokens(text)?;
        let parser = Self { text, tokens, next: 0, depth: 0, work: 0, special };
        if parser.peek() == TokenKind::End {
            return Err(parser.error(0..0, "the text is empty", "an example: `x'' + sin(x) = 0`"));
        }
        parser.refuse_other_derivatives()?;
        Ok(parser)
    }

    fn sum(&mut self) -> Result<Expr, ParseError> {
        self.sum_of(&mut |_, _| ())
    }

    /// Parses a sum; `show` is called with each term and the range of its tokens, signs included.
    fn sum_of(&mut self, show: &mut dyn FnMut(&Expr, Range<usize>)) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let mut terms = Vec::new();
        loop {
            let first = self.next;
            // The sign before the first term belongs to its first factor.
            let minus = !terms.is_empty() && self.advance().kind == TokenKind::Minus;
            let term = self.product()?;
            let term = if minus { -term } else { term };
            show(&term, first..self.next);
            terms.push(term);
            if !matches!(self.peek(), TokenKind::Plus | TokenKind::Minus) {
                break;
            }
        }
        if terms.len() > 1 {
            self.charge(&terms, start)?;
        }
        Ok(Expr::sum(terms))
    }

    /// Parses one side of an equation, and returns it with its terms as they were typed.
    fn side(
        &mut self,
        right: bool,
        coordinate: Symbol,
    ) -> Result<(Expr, Vec<TypedTerm>), ParseError> {
        let mut shown: Vec<(Expr, Range<usize>)> = Vec::new();
        let sum = self.sum_of(&mut |term, tokens| shown.push((term.clone(), tokens)))?;
        let typed = brackets::typed_terms(self.text, &self.tokens, shown, right, coordinate);
        Ok((sum, typed))
    }

    fn product(&mut self) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let mut factors = vec![self.unary()?];
        loop {
            match self.peek() {
                TokenKind::Times => {
                    self.advance();
                    factors.push(self.unary()?);
                }
                TokenKind::Divide => {
                    self.advance();
                    let start = self.token().start;
                    let divisor = self.unary()?;
                    let span = start..self.previous_end();
                    if divisor.is_zero() {
                        let text = self.quoted(span.clone());
                        let message = match text.as_str() {
                            "`0`" => "division by zero".into(),
                            _ => format!("division by zero: {text} is 0"),
                        };
                        return Err(self.error(span, &message, ""));
                    }
                    self.charge(std::slice::from_ref(&divisor), start)?;
                    factors.push(self.located(Expr::divide(&Expr::one(), &divisor), span)?);
                }
                TokenKind::Number | TokenKind::Name | TokenKind::Open => {
                    return Err(self.missing_sign());
                }
                _ => break,
            }
        }
        if factors.len() == 1 {
            return Ok(factors.swap_remove(0));
        }
        self.charge(&factors, start)?;
        let product = Expr::product(factors);
        // Merging equal bases may exceed the limit, as in x^9999*x^9999.
        match normal::has_large_exponent(&product) {
            true => {
                let message = format!("this product has an exponent beyond {LARGEST_EXPONENT}");
                Err(self.error(start..self.previous_end(), &message, ""))
            }
            false => Ok(product),
        }
    }

    fn unary(&mut self) -> Result<Expr, ParseError> {
        let mut negative = false;
        let mut signs = 0;
        while let sign @ (TokenKind::Plus | TokenKind::Minus) = self.peek() {
            self.enter(self.token())?;
            signs += 1;
            negative ^= sign == TokenKind::Minus;
            self.advance();
        }
        let value = self.power()?;
        self.depth -= signs;
        Ok(if negative { -value } else { value })
    }

    fn power(&mut self) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let base = self.primary()?;
        if self.peek() != TokenKind::Power {
            return Ok(base);
        }
        let sign = self.advance();
        self.enter(sign)?;
        let exponent = self.unary()?;
        self.depth -= 1;
        let span = start..self.previous_end();
        self.charge(&[base.clone(), exponent.clone()], start)?;
        let power = self.located(Expr::power(&base, &exponent), span)?;
        self.charge(std::slice::from_ref(&power), start)?;
        Ok(power)
    }

    fn primary(&mut self) -> Result<Expr, ParseError> {
        let token = self.token();
        match token.kind {
            TokenKind::Number => {
                self.advance();
                Ok(Expr::number(self.decimal(token)?))
            }
            TokenKind::Name => {
                self.advance();
                self.name(token)
            }
            TokenKind::Open => {
                self.advance();
                self.enter(token)?;
                if self.peek() == TokenKind::Close {
                    return Err(self.error(
                        token.start..self.token().end,
                        "nothing stands between these parentheses",
                        "",
                    ));
                }
                let inner = self.sum()?;
                self.close(token)?;
                Ok(inner)
            }
            _ => Err(self.missing_operand()),
        }
    }

    fn name(&mut self, token: Token) -> Result<Expr, ParseError> {
        let name = &self.text[token.span()];
        let called = self.peek() == TokenKind::Open;
        if NOT_NUMBERS.contains(&name.to_ascii_lowercase().as_str()) {
            return Err(self.error(token.span(), &format!("`{name}` is no number"), ""));
        }
        let square_root = name == "sqrt";
        let function = match self.special && called {
            true => Function::from_name_in_answers(name),
            false => Function::from_name(name),
        };
        match (called, square_root || function.is_some()) {
            (true, true) => {
                let arguments = self.arguments(token)?;
                let span = token.start..self.previous_end();
                self.charge(&arguments, token.start)?;
                let result = match function {
                    Some(function) => Expr::function(function, arguments),
                    None => match arguments.as_slice() {
                        [only] => only.sqrt(),
                        _ => Err(ExprError::WrongArguments {
                            function: "sqrt",
                            expected: 1,
                            given: arguments.len(),
                        }),
                    },
                };
                self.located(result, span)
            }
            (false, true) => Err(self.bare_function(token)),
            (true, false) => Err(self.unknown_function(token)),
            (false, false) => {
                let bare = name.trim_end_matches('\'');
                let primes = name.len() - bare.len();
                if primes > 2 {
                    let help = format!("the highest derivative is `{bare}''`");
                    return Err(self.error(
                        token.span(),
                        &format!("`{name}` has {primes} primes"),
                        &help,
                    ));
                }
                if primes > 0
                    && (bare == "pi"
                        || bare == "t"
                        || bare == "sqrt"
                        || Function::from_name(bare).is_some())
                {
                    return Err(self.error(
                        token.span(),
                        &format!("`{bare}` is no coordinate and carries no prime"),
                        "",
                    ));
                }
                Ok(Expr::symbol(name))
            }
        }
    }

    /// Parses the arguments in parentheses after a function's name.
    fn arguments(&mut self, name: Token) -> Result<Vec<Expr>, ParseError> {
        let open = self.advance();
        self.enter(open)?;
        if self.peek() == TokenKind::Close {
            let text = self.quoted(name.span());
            return Err(self.error(
                name.start..self.token().end,
                &format!("{text} has no argument"),
                "",
            ));
        }
        let mut arguments = vec![self.sum()?];
        while self.peek() == TokenKind::Comma {
            self.advance();
            arguments.push(self.sum()?);
        }
        self.close(open)?;
        Ok(arguments)
    }

    fn close(&mut self, open: Token) -> Result<(), ParseError> {
        match self.peek() {
            TokenKind::Close => {
                self.advance();
                self.depth -= 1;
                Ok(())
            }
            TokenKind::End => Err(self.error(open.span(), "this `(` is never closed", "")),
            TokenKind::Equals => {
                Err(self.error(self.token().span(), "an `=` inside parentheses", ""))
            }
            _ => Err(self.unexpected()),
        }
    }

    /// The exact value of a decimal number.
    fn decimal(&self, token: Token) -> Result<Rational, ParseError> {
        let text = &self.text[token.span()];
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if whole.len() + fraction.len() > MOST_DIGITS {
            return Err(self.error(
                token.span(),
                &format!("a number of more than {MOST_DIGITS} digits"),
                "",
            ));
        }
        let size = exponent.trim_start_matches(['+', '-']).trim_start_matches('0');
        let size = if size.is_empty() { Some(0) } else { size.parse().ok() };
        let Some(size) = size.filter(|size: &usize| *size <= LARGEST_DECIMAL_EXPONENT) else {
            let message =
                format!("the exponent of this number is beyond {LARGEST_DECIMAL_EXPONENT}");
            return Err(self.error(token.span(), &message, ""));
        };
        let digits = format!("0{whole}{fraction}").parse().unwrap_or_else(|_| Integer::zero());
        let ten_to = |power: usize| num_traits::pow(Integer::from(10), power);
        let (mut numerator, mut denominator) = (digits, ten_to(fraction.len()));
        if exponent.starts_with('-') {
            denominator *= ten_to(size);
        } else {
            numerator *= ten_to(size);
        }
        Ok(number::lowest_terms(numerator, denominator))
    }

    fn peek(&self) -> TokenKind {
        self.token().kind
    }

    fn token(&self) -> Token {
        self.tokens.get(self.next).copied().unwrap_or(Token {
            kind: TokenKind::End,
            start: self.text.len(),
            end: self.text.len(),
        })
    }

    fn advance(&mut self) -> Token {
        let token = self.token();
        self.next += 1;
        token
    }

    fn previous(&self) -> Option<Token> {
        self.tokens.get(self.next.checked_sub(1)?).copied()
    }

    fn previous_end(&self) -> usize {
        self.previous().map_or(0, |token| token.end)
    }

    fn enter(&mut self, token: Token) -> Result<(), ParseError> {
        self.depth += 1;
        match self.depth > DEEPEST {
            true => Err(self.error(token.span(), &format!("nested more than {DEEPEST} deep"), "")),
            false => Ok(()),
        }
    }

    /// Counts the work of joining these expressions: their terms, and the length of the numbers
    /// among them.
    fn charge(&mut self, parts: &[Expr], start: usize) -> Result<(), ParseError> {
        /// Word operations on numbers that take about as long as one term.
        const BITS: u64 = 32_000;
        let (mut count, mut total, mut squares) = (0_u64, 0_u64, 0_u64);
        for part in parts {
            for term in part.terms() {
                let (coefficient, factors) = term.factors();
                // The signs and single digits of everyday equations are free.
                let bits = number::bits(&coefficient).saturating_sub(8);
                count += 1 + factors.len() as u64;
                total = total.saturating_add(bits);
                squares = squares.saturating_add(bits.saturating_mul(bits));
            }
        }
        let numbers = squares.saturating_add(count.saturating_mul(total)) / BITS;
        self.work = self.work.saturating_add(count).saturating_add(numbers);
        match self.work > MOST_WORK {
            true => {
                let message = match numbers > count {
                    true => "the numbers here are too long to be written out",
                    false => "the expression is too large to be brought into normal form",
                };
                Err(self.error(start..self.previous_end(), message, ""))
            }
            false => Ok(()),
        }
    }

    fn located<T>(
        &self,
        result: Result<T, ExprError>,
        span: Range<usize>,
    ) -> Result<T, ParseError> {
        result.map_err(|error| self.error(span, &error.to_string(), ""))
    }

    fn error(&self, span: Range<usize>, message: &str, help: &str) -> ParseError {
        ParseError::new(self.text, span, message, help)
    }

    /// The text in quotes; the end of a long one is cut off.
    fn quoted(&self, span: Range<usize>) -> String {
        format!("`{}`", shortened(&self.text[span]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_numbers_are_exact() {
        for (text, numerator, denominator) in [
            ("0.323", 323, 1000),
            ("1.5e-3", 15, 10_000),
            ("2E+3", 2000, 1),
            (".5", 1, 2),
            ("5.", 5, 1),
            ("007", 7, 1),
            ("0e-400", 0, 1),
            ("1e00000000000000000000002", 100, 1),
            ("2^3^2/2^8", 2, 1),
            ("-2^2", -4, 1),
            ("(-2)^2", 4, 1),
            ("2**-1", 1, 2),
            ("2*-3 - -4 - +5", -7, 1),
            ("12/2/3", 2, 1),
            ("1 - 2 - 3", -4, 1),
        ] {
            let expected = Rational::new(numerator.into(), denominator.into());
            assert_eq!(parse_expression(text).unwrap(), Expr::number(expected), "{text}");
        }
    }

    #[test]
    fn blanks_and_marks_at_the_start_do_not_count() {
        let expected = parse_expression("x''+2*x").unwrap();
        for text in ["\u{feff}x''+2*x", " x'' \r\n +\t2 * x\r\n", "((x''))+(2)*x"] {
            assert_eq!(parse_expression(text).unwrap(), expected);
        }
    }

    #[test]
    fn equations_and_their_coordinate() {
        for (text, expected, coordinate) in [
            ("x'' + x + eps*x^3 = 0", "x'' + x + eps*x^3 = 0", "x"),
            ("x'' + sin(x)", "x'' + sin(x) = 0", "x"),
            ("x'' = -k*x", "x'' = -k*x", "x"),
            ("u'' + u + eps*u^3", "u'' + u + eps*u^3 = 0", "u"),
            ("0 = q' + t", "0 = q' + t", "q"),
            ("x + 1 = 2", "1 + x = 2", "x"),
            ("x'' + e*x", "x'' + e*x = 0", "x"),
            ("phi'' + (g/L)*sin(phi)", "phi'' + g*sin(phi)/L = 0", "phi"),
            ("q_1'' + k*q_1", "q_1'' + k*q_1 = 0", "q_1"),
            ("theta2'' + theta2^3", "theta2'' + theta2^3 = 0", "theta2"),
        ] {
            let equation = parse_equation(text).unwrap();
            assert_eq!(
                (equation.to_string().as_str(), equation.coordinate.name()),
                (expected, coordinate),
                "{text}"
            );
        }
    }

    #[test]
    fn the_names_of_answers_are_names_of_equations() {
        for name in NAMES_OF_ANSWERS {
            assert_eq!(parse_expression(name).unwrap(), Expr::symbol(name));
            assert!(parse_equation(&format!("x'' + {name}*x = 0")).is_ok());
            let equation = parse_equation(&format!("{name}'' + {name} = 0")).unwrap();
            assert_eq!(equation.coordinate.name(), name);
        }
        assert_eq!(parse_equation("theta'' + sin(theta)").unwrap().coordinate.name(), "theta");
    }

    /// Text, the part that is meant, the message and the help.
    #[test]
    fn mistakes_are_located_and_named() {
        for (text, place, message, help) in [
            ("x'' + 2x = 0", "2x", "`2x`: a product needs its sign", "try `2*x`"),
            ("2(x) + x''", "2(x)", "`2(x)`: a product needs its sign", "try `2*(x)`"),
            ("x sin(x)", "x sin(x)", "`x sin(x)`: a product needs its sign", "try `x*sin(x)`"),
            (
                "(x+1)(x-1)",
                "(x+1)(x-1)",
                "`(x+1)(x-1)`: a product needs its sign",
                "try `(x+1)*(x-1)`",
            ),
            (
                "sin(x)(x-1)",
                "sin(x)(x-1)",
                "`sin(x)(x-1)`: a product needs its sign",
                "try `sin(x)*(x-1)`",
            ),
            ("k(x)", "k(x)", "`k(x)`: a product needs its sign", "try `k*(x)`"),
            ("2e", "2e", "`2e`: a product needs its sign", "try `2*e`"),
            ("0x10", "0x10", "`0x10`: a product needs its sign", "try `0*x10`"),
            ("x 1", "x 1", "`x 1`: a product needs its sign", "try `x*1`"),
            (
                "d2x/dt2 + x",
                "d2x/dt2",
                "`d2x/dt2`: derivatives are written with primes",
                "try `x''`",
            ),
            ("x + du/dt", "du/dt", "`du/dt`: derivatives are written with primes", "try `u'`"),
            (
                "d^2x/dt^2 + x",
                "d^2x/dt^2",
                "`d^2x/dt^2`: derivatives are written with primes",
                "try `x''`",
            ),
            ("x + x_dot", "x_dot", "`x_dot`: derivatives are written with primes", "try `x'`"),
            ("uddot + u", "uddot", "`uddot`: derivatives are written with primes", "try `u''`"),
            (
                "\\ddot{x} + x",
                "\\ddot{x}",
                "`\\ddot{x}`: derivatives are written with primes",
                "try `x''`",
            ),
            (
                "diff(x, t) + x",
                "diff(x, t)",
                "`diff(x, t)`: derivatives are written with primes",
                "try `x'` for the velocity, `x''` for the acceleration",
            ),
            ("1 + sn(x)", "sn", "there is no function `sn`", "did you mean `sin`?"),
            ("Sin(x)", "Sin", "there is no function `Sin`", "did you mean `sin`?"),
            ("sqr(x)", "sqr", "there is no function `sqr`", "did you mean `sqrt`?"),
            ("ln(x)", "ln", "there is no function `ln`", "did you mean `log`?"),
            ("x + sin x", "sin x", "`sin` needs parentheses around its argument", "try `sin(x)`"),
            ("cos", "cos", "`cos` needs parentheses around its argument", "try `cos(x)`"),
            ("sin^2(x)", "sin", "`sin` needs parentheses around its argument", "try `sin(x)^2`"),
            ("x''' + x", "x'''", "`x'''` has 3 primes", "the highest derivative is `x''`"),
            ("t' + x", "t'", "`t` is no coordinate and carries no prime", ""),
            ("(x)'", "'", "a prime stands directly after its letter", "try `x'`"),
            ("x\" + x", "\"", "a double quote is no pair of primes", "try `x''`"),
            ("x +", "+", "something is missing after `+`", ""),
            ("x + * 2", "+", "something is missing after `+`", ""),
            ("* x", "*", "something is missing before `*`", ""),
            ("x^", "^", "something is missing after `^`", ""),
            ("2*(x + 1", "(", "this `(` is never closed", ""),
            ("x)", ")", "this `)` closes nothing", ""),
            (")(", ")", "this `)` closes nothing", ""),
            ("()", "()", "nothing stands between these parentheses", ""),
            ("sin()", "sin()", "`sin` has no argument", ""),
            ("sin(x, 1)", "sin(x, 1)", "`sin` takes 1 argument, not 2", ""),
            ("max(x)", "max(x)", "`max` takes 2 arguments, not 1", ""),
            ("x == 1", "==", "`==`: an equation has a single sign", "try `=`"),
            ("x = 1 = 2", "=", "a second `=`", "an equation has one"),
            ("(x = 1)", "=", "an `=` inside parentheses", ""),
            ("x =", "=", "something is missing after `=`", ""),
            ("1/0", "0", "division by zero", ""),
            ("0/0", "0", "division by zero", ""),
            ("x/(1 - 1)", "(1 - 1)", "division by zero: `(1 - 1)` is 0", ""),
            ("x + log(0)", "log(0)", "`log(0)` has no real value", ""),
            ("sqrt(-1)", "sqrt(-1)", "`(-1)^(1/2)` has no real value", ""),
            ("asin(2)", "asin(2)", "`asin(2)` has no real value", ""),
            ("x*0^0", "0^0", "`0^0` has no real value", ""),
            ("0^-1", "0^-1", "division by zero: `0^(-1)`", ""),
            ("x + nan", "nan", "`nan` is no number", ""),
            (
                "1,5*x",
                ",",
                "a `,` stands between the arguments of `max` and `min` alone",
                "a decimal point is `.`",
            ),
            ("1..2", "1..", "this is no number", "a decimal point stands among digits: `0.5`"),
            ("x\u{b2}", "\u{b2}", "`\u{b2}` (U+00B2) is not understood", "try `^2`"),
            ("x \u{2212} 1", "\u{2212}", "`\u{2212}` (U+2212) is not understood", "try `-`"),
            ("2\u{b7}x", "\u{b7}", "`\u{b7}` (U+00B7) is not understood", "try `*`"),
            ("x \u{202e}1", "\u{202e}", "the character U+202E is not understood", ""),
            ("x\0", "\0", "a NUL character", ""),
            ("x\u{1b}[31m", "\u{1b}", "a control character, U+001B", ""),
            ("__import__(\"os\").getcwd()", "_", "a name begins with a letter", ""),
            ("|x|", "|", "`|` is no sign here", "the absolute value is `abs(x)`"),
            (
                "u'' + x",
                "x",
                "`x` beside the coordinate `u`",
                "write `u`, or give the parameter another name",
            ),
            (
                "u'' + y'",
                "y'",
                "derivatives of both `u` and `y`",
                "an equation of motion has one coordinate",
            ),
            (
                "kx'' + x",
                "kx''",
                "`kx''`: primes belong to a single letter or a Greek one",
                "try `x''` or `phi''`",
            ),
            ("", "", "the text is empty", "an example: `x'' + sin(x) = 0`"),
            (" \n", "", "the text is empty", "an example: `x'' + sin(x) = 0`"),
        ] {
            let error = parse_equation(text).expect_err(text);
            assert_eq!(error.message, message, "{text:?}");
            assert_eq!(&text[error.span.clone()], place, "{text:?}: {error}");
            assert_eq!(error.help.as_deref().unwrap_or(""), help, "{text:?}");
        }
        assert_eq!(parse_expression("x = 1").unwrap_err().message, "an `=` in an expression");
    }

    #[test]
    fn errors_show_the_place() {
        let shown = |text: &str| parse_equation(text).unwrap_err().to_string();
        assert_eq!(
            shown("x'' + 2x = 0"),
            "`2x`: a product needs its sign\n  x'' + 2x = 0\n        ^^ try `2*x`"
        );
        assert_eq!(
            shown("x'' +\n  x + 2x\n= 0"),
            "`2x`: a product needs its sign\n    x + 2x\n        ^^ try `2*x`"
        );
        assert_eq!(shown(""), "the text is empty\n  an example: `x'' + sin(x) = 0`");
        assert_eq!(shown("x +"), "something is missing after `+`\n  x +\n    ^");
        // Characters that a terminal would obey or reorder are not shown.
        assert_eq!(shown("x\u{1b}[31m"), "a control character, U+001B\n  x?[31m\n   ^");
        assert_eq!(shown("\u{202e}x"), "the character U+202E is not understood\n  ?x\n  ^");
        let long = shown(&format!("{}2x{}", "x + ".repeat(1_000), " + x".repeat(1_000)));
        let lines: Vec<&str> = long.lines().collect();
        assert_eq!(lines[2].find('^').map(|place| &lines[1][place..place + 2]), Some("2x"));
        assert!(lines[1].len() < 110 && lines[1].ends_with("..."), "{long}");
    }

    /// Each ends in an error or a value, soon, and never in the stack.
    #[test]
    fn hostile_texts_end_in_an_error() {
        let nested = |open: &str, close: &str, depth: usize| {
            format!("{}x{}", open.repeat(depth), close.repeat(depth))
        };
        let deep = "nested more than 256 deep";
        let long = "the numbers here are too long to be written out";
        let wide = "the expression is too large to be brought into normal form";
        let different = (0..8_000).map(|k| format!("x{k}")).collect::<Vec<_>>().join("+");
        for (text, message) in [
            (nested("(", ")", 2_000), deep),
            (nested("sin(", ")", 2_000), deep),
            (nested("max(1, ", ")", 2_000), deep),
            (nested("-", "", 5_000), deep),
            (nested("+", "", 5_000), deep),
            (nested("x^", "", 5_000), deep),
            (nested("-(", ")", 129), deep),
            (nested("2^-", "", 129), deep),
            ("(".repeat(60_000), deep),
            ("x".repeat(60_000), "a name of more than 64 letters"),
            ("9".repeat(60_000), "a number of more than 1000 digits"),
            ("x + ".repeat(20_000), "the text is longer than 64 KiB"),
            ("9^9^9^9^9".into(), "`9^387420489` is too large a number to be written out"),
            ("x^1000000000".into(), "the exponent in `x^1000000000` is beyond 10000"),
            ("((x^9999)^9999)".into(), "the exponent in `(x^9999)^9999` is beyond 10000"),
            ("x^9999*x^9999".into(), "this product has an exponent beyond 10000"),
            ("x^(1/10001)".into(), "the exponent in `x^(1/10001)` is beyond 10000"),
            ("1e999999999999".into(), "the exponent of this number is beyond 400"),
            ("1e-99999999999999999999999".into(), "the exponent of this number is beyond 400"),
            ((3..2_000).map(|n| format!("{n}^9999*")).collect::<String>() + "1", long),
            ((3..2_000).map(|n| format!("1/{n}^900+")).collect::<String>() + "1", long),
            (format!("{}{}{}", "(".repeat(250), different, "+y)".repeat(250)), wide),
        ] {
            assert_eq!(
                parse_expression(&text).unwrap_err().message,
                message,
                "{}",
                &text[..20.min(text.len())]
            );
        }
    }

    #[test]
    fn the_limits_themselves_are_allowed() {
        let nested = |open: &str, close: &str, depth: usize| {
            format!("{}x{}", open.repeat(depth), close.repeat(depth))
        };
        let x = Expr::symbol("x");
        assert_eq!(parse_expression(&nested("(", ")", 256)).unwrap(), x);
        assert_eq!(parse_expression(&nested("-", "", 256)).unwrap(), x);
        assert!(parse_expression(&nested("sin(", ")", 256)).is_ok());
        assert!(parse_expression(&nested("x^", "", 256)).is_ok());
        assert!(parse_expression(&"9".repeat(1_000)).is_ok());
        assert!(parse_expression("x^10000 + x^(1/10000) + 1e400").is_ok());
    }

    /// The deepest text allowed needs less than half the stack of a test thread, which has 2 MiB.
    #[test]
    fn the_deepest_text_fits_a_small_stack() {
        let text = format!("{}x{}", "sin(".repeat(256), ")".repeat(256));
        let parse = move || parse_expression(&text).is_ok();
        let thread = std::thread::Builder::new().stack_size(1024 * 1024).spawn(parse).unwrap();
        assert!(thread.join().unwrap());
    }

    #[test]
    fn wide_texts_are_read_in_one_go() {
        let sum =
            |term: &str, count: usize| parse_expression(&vec![term; count].join("+")).unwrap();
        assert_eq!(sum("x", 20_000).to_string(), "20000*x");
        assert_eq!(sum("sin(x)", 9_000).to_string(), "9000*sin(x)");
        let different: Vec<String> = (0..9_000).map(|k| format!("x{k}")).collect();
        assert_eq!(parse_expression(&different.join("+")).unwrap().terms().len(), 9_000);
        assert_eq!(parse_expression(&different.join("*")).unwrap().factors().1.len(), 9_000);
        assert_eq!(
            parse_expression(&vec!["(x+1)"; 9_000].join("*")).unwrap().to_string(),
            "(1 + x)^9000"
        );
        let quotients: Vec<String> = (10_001..17_000).map(|n| format!("1/{n}")).collect();
        let sum = parse_expression(&quotients.join("+"))
            .unwrap()
            .evaluate(&std::collections::BTreeMap::new())
            .unwrap();
        let direct: f64 = (10_001..17_000).map(|n| 1.0 / f64::from(n)).sum();
        assert!((sum - direct).abs() < 1e-12);
    }
}
