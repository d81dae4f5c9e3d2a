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
//! Every error names the place and, where it can, the right spelling. Whatever the text is, reading it ends quickly: its
//! length, its nesting, the digits and exponents of its numbers and the work of bringing it into normal form are limited.

mod error;
mod lexer;
mod mistakes;

use std::fmt;
use std::ops::Range;

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::{Expr, ExprError, Function, LARGEST_EXPONENT, normal, number};
use crate::exact::rational::Rational;
use crate::symbol::Symbol;

pub use error::ParseError;
use error::shortened;
use lexer::{Kind, Token};

/// Names that an equation may not use for parameters: the answers are written with them.
pub const RESERVED_NAMES: [&str; 5] = ["A", "a", "theta", "omega", "omega0"];

/// Spellings of what is no number.
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
    /// What stands left of the equals sign.
    pub left: Expr,
    /// What stands right of it; 0 where there is none.
    pub right: Expr,
    /// The dependent variable: the letter that carries primes, `x` if none does.
    pub coordinate: Symbol,
}

impl fmt::Display for Equation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} = {}", self.left, self.right)
    }
}

/// Reads an expression. Every printed expression can be read, so the names of answers (`A`, `theta`, `omega`) are
/// allowed, and so are primes after longer names.
///
/// # Errors
/// See [`ParseError`].
pub fn parse_expression(text: &str) -> Result<Expr, ParseError> {
    let mut parser = Parser::new(text)?;
    let expr = parser.sum()?;
    match parser.peek() {
        Kind::End => Ok(expr),
        Kind::Equals => Err(parser.error(
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
/// See [`ParseError`]; also for [`RESERVED_NAMES`], and for primes on more than one letter.
pub fn parse_equation(text: &str) -> Result<Equation, ParseError> {
    let mut parser = Parser::new(text)?;
    let coordinate = parser.coordinate()?;
    let left = parser.sum()?;
    let mut right = Expr::zero();
    if parser.peek() == Kind::Equals {
        let first = parser.advance();
        if parser.peek() == Kind::Equals && parser.token().start == first.end {
            let span = first.start..parser.token().end;
            return Err(parser.error(span, "`==`: an equation has a single sign", "try `=`"));
        }
        right = parser.sum()?;
    }
    match parser.peek() {
        Kind::End => Ok(Equation {
            left,
            right,
            coordinate,
        }),
        Kind::Equals => Err(parser.error(parser.token().span(), "a second `=`", "an equation has one")),
        _ => Err(parser.unexpected()),
    }
}

struct Parser<'a> {
    text: &'a str,
    /// Ends with one `End`, beyond which nothing advances.
    tokens: Vec<Token>,
    next: usize,
    depth: usize,
    work: u64,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Result<Self, ParseError> {
        let tokens = lexer::tokens(text)?;
        let parser = Self {
            text,
            tokens,
            next: 0,
            depth: 0,
            work: 0,
        };
        if parser.peek() == Kind::End {
            return Err(parser.error(0..0, "the text is empty", "an example: `x'' + sin(x) = 0`"));
        }
        parser.refuse_other_derivatives()?;
        Ok(parser)
    }

    fn sum(&mut self) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let mut terms = vec![self.product()?];
        while let sign @ (Kind::Plus | Kind::Minus) = self.peek() {
            self.advance();
            let term = self.product()?;
            terms.push(if sign == Kind::Minus { -term } else { term });
        }
        if terms.len() > 1 {
            self.charge(&terms, start)?;
        }
        Ok(Expr::sum(terms))
    }

    fn product(&mut self) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let mut factors = vec![self.unary()?];
        loop {
            match self.peek() {
                Kind::Times => {
                    self.advance();
                    factors.push(self.unary()?);
                }
                Kind::Divide => {
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
                Kind::Number | Kind::Name | Kind::Open => return Err(self.missing_sign()),
                _ => break,
            }
        }
        if factors.len() == 1 {
            return Ok(factors.swap_remove(0));
        }
        self.charge(&factors, start)?;
        let product = Expr::product(factors);
        // Equal bases have been merged: x^9999*x^9999.
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
        while let sign @ (Kind::Plus | Kind::Minus) = self.peek() {
            self.enter(self.token())?;
            signs += 1;
            negative ^= sign == Kind::Minus;
            self.advance();
        }
        let value = self.power()?;
        self.depth -= signs;
        Ok(if negative { -value } else { value })
    }

    fn power(&mut self) -> Result<Expr, ParseError> {
        let start = self.token().start;
        let base = self.primary()?;
        if self.peek() != Kind::Power {
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
            Kind::Number => {
                self.advance();
                Ok(Expr::number(self.decimal(token)?))
            }
            Kind::Name => {
                self.advance();
                self.name(token)
            }
            Kind::Open => {
                self.advance();
                self.enter(token)?;
                if self.peek() == Kind::Close {
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
        let called = self.peek() == Kind::Open;
        if NOT_NUMBERS.contains(&name.to_ascii_lowercase().as_str()) {
            return Err(self.error(token.span(), &format!("`{name}` is no number"), ""));
        }
        let square_root = name == "sqrt";
        let function = Function::from_name(name);
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
                    return Err(self.error(token.span(), &format!("`{name}` has {primes} primes"), &help));
                }
                if primes > 0 && (bare == "pi" || bare == "t" || bare == "sqrt" || Function::from_name(bare).is_some())
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

    /// The arguments in parentheses after a function's name.
    fn arguments(&mut self, name: Token) -> Result<Vec<Expr>, ParseError> {
        let open = self.advance();
        self.enter(open)?;
        if self.peek() == Kind::Close {
            let text = self.quoted(name.span());
            return Err(self.error(name.start..self.token().end, &format!("{text} has no argument"), ""));
        }
        let mut arguments = vec![self.sum()?];
        while self.peek() == Kind::Comma {
            self.advance();
            arguments.push(self.sum()?);
        }
        self.close(open)?;
        Ok(arguments)
    }

    fn close(&mut self, open: Token) -> Result<(), ParseError> {
        match self.peek() {
            Kind::Close => {
                self.advance();
                self.depth -= 1;
                Ok(())
            }
            Kind::End => Err(self.error(open.span(), "this `(` is never closed", "")),
            Kind::Equals => Err(self.error(self.token().span(), "an `=` inside parentheses", "")),
            _ => Err(self.unexpected()),
        }
    }

    /// The exact value of a decimal number.
    fn decimal(&self, token: Token) -> Result<Rational, ParseError> {
        let text = &self.text[token.span()];
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if whole.len() + fraction.len() > MOST_DIGITS {
            return Err(self.error(token.span(), &format!("a number of more than {MOST_DIGITS} digits"), ""));
        }
        let size = exponent.trim_start_matches(['+', '-']).trim_start_matches('0');
        let size = if size.is_empty() { Some(0) } else { size.parse().ok() };
        let Some(size) = size.filter(|size: &usize| *size <= LARGEST_DECIMAL_EXPONENT) else {
            let message = format!("the exponent of this number is beyond {LARGEST_DECIMAL_EXPONENT}");
            return Err(self.error(token.span(), &message, ""));
        };
        let digits = BigInt::parse_bytes(format!("0{whole}{fraction}").as_bytes(), 10).unwrap_or_else(BigInt::zero);
        let ten_to = |power: usize| (0..power).fold(BigInt::one(), |product, _| product * 10);
        let (mut numerator, mut denominator) = (digits, ten_to(fraction.len()));
        if exponent.starts_with('-') {
            denominator *= ten_to(size);
        } else {
            numerator *= ten_to(size);
        }
        Ok(number::lowest_terms(numerator, denominator))
    }

    fn peek(&self) -> Kind {
        self.token().kind
    }

    fn token(&self) -> Token {
        self.tokens.get(self.next).copied().unwrap_or(Token {
            kind: Kind::End,
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

    /// Counts the work of joining these expressions: their terms, and the length of the numbers among them.
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

    fn located<T>(&self, result: Result<T, ExprError>, span: Range<usize>) -> Result<T, ParseError> {
        result.map_err(|error| self.error(span, &error.to_string(), ""))
    }

    fn error(&self, span: Range<usize>, message: &str, help: &str) -> ParseError {
        ParseError::new(self.text, span, message, help)
    }

    /// The text itself in quotes, shortened in the middle of long ones.
    fn quoted(&self, span: Range<usize>) -> String {
        format!("`{}`", shortened(&self.text[span]))
    }
}
