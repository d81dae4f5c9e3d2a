//! Text to tokens.

use std::ops::Range;

use super::error::{ParseError, shortened};
use super::notation;

/// The longest text, in bytes.
const LONGEST_TEXT: usize = 64 * 1024;
/// The longest name, in bytes.
const LONGEST_NAME: usize = 64;

/// The tokens of the text, with one `End` behind the last.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, ParseError> {
    Lexer { text, position: 0 }.tokens()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    Number,
    Name,
    Plus,
    Minus,
    Times,
    Divide,
    Power,
    Open,
    Close,
    Comma,
    Equals,
    End,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) start: usize,
    pub(super) end: usize,
}

impl Token {
    pub(super) fn span(self) -> Range<usize> {
        self.start..self.end
    }
}

struct Lexer<'a> {
    text: &'a str,
    position: usize,
}

impl<'a> Lexer<'a> {
    fn tokens(mut self) -> Result<Vec<Token>, ParseError> {
        if self.text.len() > LONGEST_TEXT {
            let message = format!("the text is longer than {} KiB", LONGEST_TEXT / 1024);
            return Err(ParseError::new(self.text, 0..0, &message, ""));
        }
        self.skip_while(|letter| letter == '\u{feff}');
        let mut tokens = Vec::new();
        loop {
            self.skip_while(|letter| matches!(letter, ' ' | '\t' | '\r' | '\n'));
            let start = self.position;
            let Some(letter) = self.rest().chars().next() else {
                break;
            };
            let kind = match letter {
                'A'..='Z' | 'a'..='z' => self.name()?,
                '0'..='9' | '.' => self.number()?,
                _ => self.sign(letter)?,
            };
            tokens.push(Token { kind, start, end: self.position });
        }
        tokens.push(Token { kind: TokenKind::End, start: self.position, end: self.position });
        Ok(tokens)
    }

    fn name(&mut self) -> Result<TokenKind, ParseError> {
        let start = self.position;
        self.skip_while(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        self.skip_while(|letter| letter == '\'');
        match self.position - start > LONGEST_NAME {
            true => {
                Err(self.error(start, &format!("a name of more than {LONGEST_NAME} letters"), ""))
            }
            false => Ok(TokenKind::Name),
        }
    }

    fn number(&mut self) -> Result<TokenKind, ParseError> {
        let start = self.position;
        let digit = |letter: char| letter.is_ascii_digit();
        self.skip_while(digit);
        if self.rest().starts_with('.') {
            self.position += 1;
            self.skip_while(digit);
        }
        if self.rest().starts_with('.')
            || self.position - start == 1 && self.text[start..].starts_with('.')
        {
            self.position += usize::from(self.rest().starts_with('.'));
            return Err(self.error(
                start,
                "this is no number",
                "a decimal point stands among digits: `0.5`",
            ));
        }
        // An `e` without digits behind it is a name, and the missing product sign is found later.
        if let Some(exponent) = self.rest().strip_prefix(['e', 'E']) {
            let digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            if digits.starts_with(digit) {
                self.position = self.text.len() - digits.len();
                self.skip_while(digit);
            }
        }
        Ok(TokenKind::Number)
    }

    fn sign(&mut self, letter: char) -> Result<TokenKind, ParseError> {
        let start = self.position;
        self.position += letter.len_utf8();
        let spelling = notation::help(letter);
        let (message, help): (String, &str) = match letter {
            '+' => return Ok(TokenKind::Plus),
            '-' => return Ok(TokenKind::Minus),
            '/' => return Ok(TokenKind::Divide),
            '^' => return Ok(TokenKind::Power),
            '(' => return Ok(TokenKind::Open),
            ')' => return Ok(TokenKind::Close),
            ',' => return Ok(TokenKind::Comma),
            '=' => return Ok(TokenKind::Equals),
            '*' if self.rest().starts_with('*') => {
                self.position += 1;
                return Ok(TokenKind::Power);
            }
            '*' => return Ok(TokenKind::Times),
            '\'' => ("a prime stands directly after its letter".into(), "try `x'`"),
            '"' => ("a double quote is no pair of primes".into(), "try `x''`"),
            '[' | '{' => (format!("`{letter}` is no parenthesis here"), "try `(`"),
            ']' | '}' => (format!("`{letter}` is no parenthesis here"), "try `)`"),
            '|' => ("`|` is no sign here".into(), "the absolute value is `abs(x)`"),
            ';' => (
                "`;` ends an equation, and one is expected here".into(),
                "`lindstedt derive`, `response` and `certify` take several",
            ),
            '_' => ("a name begins with a letter".into(), ""),
            '\\' if self.rest().starts_with("ddot") => {
                return Err(self.latex_derivative(start, "''"));
            }
            '\\' if self.rest().starts_with("dot") => {
                return Err(self.latex_derivative(start, "'"));
            }
            '\\' => {
                ("LaTeX is written, not read".into(), "functions are `sin(x)`, fractions `a/b`")
            }
            '\0' => ("a NUL character".into(), ""),
            _ if letter.is_ascii_graphic() => (format!("`{letter}` is no sign here"), ""),
            _ if letter.is_control() => {
                (format!("a control character, U+{:04X}", u32::from(letter)), "")
            }
            _ => {
                let name = match printable(letter) == letter && !letter.is_whitespace() {
                    true => format!("`{letter}` (U+{:04X})", u32::from(letter)),
                    false => format!("the character U+{:04X}", u32::from(letter)),
                };
                (format!("{name} is not understood"), spelling.as_str())
            }
        };
        let error = self.error(start, &message, help);
        Err(match notation::meaning(self.text, start, letter) {
            Some((part, replacement)) => error.meaning(part, replacement),
            None => error,
        })
    }

    fn latex_derivative(&mut self, start: usize, primes: &str) -> ParseError {
        let braces = self.rest().find('{').zip(self.rest().find('}'));
        let inner = braces.and_then(|(open, close)| self.rest().get(open + 1..close));
        let letter = inner.map(str::trim).filter(|inner| {
            inner.len() == 1 && inner.starts_with(|letter: char| letter.is_ascii_alphabetic())
        });
        self.position += braces.map_or(0, |(_, close)| close + 1);
        let message = format!(
            "`{}`: derivatives are written with primes",
            shortened(&self.text[start..self.position])
        );
        let help = format!("try `{}{primes}`", letter.unwrap_or("x"));
        let error = self.error(start, &message, &help);
        error.meaning_here(letter.map(|letter| format!("{letter}{primes}")))
    }

    fn rest(&self) -> &'a str {
        &self.text[self.position..]
    }

    fn skip_while(&mut self, wanted: impl Fn(char) -> bool) {
        self.position = self.text.len() - self.rest().trim_start_matches(wanted).len();
    }

    fn error(&self, start: usize, message: &str, help: &str) -> ParseError {
        ParseError::new(self.text, start..self.position, message, help)
    }
}

/// The character itself, or `?` for a control character or one that a terminal would not show.
pub(super) fn printable(letter: char) -> char {
    match letter {
        '\t' | '\r' | '\n' => ' ',
        ' '..='~' => letter,
        _ if letter.is_alphanumeric()
            || notation::spelling(letter).is_some_and(|_| !letter.is_whitespace()) =>
        {
            letter
        }
        _ => '?',
    }
}
