//! Frequent mistakes, and the text to write instead.

use std::ops::Range;

use strsim::osa_distance;

use super::Parser;
use super::error::{ParseError, shortened};
use super::lexer::{Token, TokenKind};
use crate::expr::Function;
use crate::symbol::{GREEK, Symbol};

/// Whether a name is a letter, Greek ones by name, with or without an index: `x`, `phi`, `q1`,
/// `x_rel`. Any other name with primes is most often a product without its sign.
fn is_letter(name: &str) -> bool {
    let stem = match name.split_once('_') {
        Some((stem, _)) => stem,
        None => name.trim_end_matches(|letter: char| letter.is_ascii_digit()),
    };
    stem.len() == 1 || GREEK.contains(&stem)
}

impl Parser<'_> {
    /// Returns the letter that carries primes, after a check of every name.
    pub(super) fn coordinate(&self) -> Result<Symbol, ParseError> {
        let mut primed: Option<(Token, &str)> = None;
        for token in self.tokens.iter().filter(|token| token.kind == TokenKind::Name) {
            let name = &self.text[token.span()];
            let bare = name.trim_end_matches('\'');
            if bare.len() == name.len()
                || Function::from_name(bare).is_some()
                || bare == "t"
                || bare == "pi"
            {
                continue;
            }
            if !is_letter(bare) {
                let message = format!("`{name}`: primes belong to a single letter or a Greek one");
                return Err(self.error(token.span(), &message, "try `x''` or `phi''`"));
            }
            match primed {
                Some((_, first)) if first != bare => {
                    let message = format!("derivatives of both `{first}` and `{bare}`");
                    return Err(self.error(
                        token.span(),
                        &message,
                        "an equation of motion has one coordinate",
                    ));
                }
                _ => primed = Some((*token, bare)),
            }
        }
        let Some((_, letter)) = primed else {
            return Ok(Symbol::new("x"));
        };
        let is_x =
            |token: &&Token| token.kind == TokenKind::Name && &self.text[token.span()] == "x";
        match self.tokens.iter().find(is_x) {
            Some(token) if letter != "x" => {
                let message = format!("`x` beside the coordinate `{letter}`");
                Err(self.error(
                    token.span(),
                    &message,
                    &format!("write `{letter}`, or give the parameter another name"),
                ))
            }
            _ => Ok(Symbol::new(letter)),
        }
    }

    /// Refuses other spellings of derivatives: `dx/dt`, `d2x/dt2`, `d^2x/dt^2`, `x_dot`,
    /// `diff(x, t)`.
    pub(super) fn refuse_other_derivatives(&self) -> Result<(), ParseError> {
        let text = |token: &Token| &self.text[token.span()];
        for (index, token) in
            self.tokens.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Name)
        {
            let name = text(token);
            let rest = &self.tokens[index..];
            let called = rest.get(1).is_some_and(|next| next.kind == TokenKind::Open);
            if called
                && ["diff", "D", "Diff", "Derivative", "derivative", "dot", "ddot"].contains(&name)
            {
                let end = matching_close(rest, 1).map_or(token.end, |place| rest[place].end);
                return Err(self.derivative_error(token.start..end, "x", None));
            }
            if let Some((letter, order)) = dotted(name) {
                return Err(self.derivative_error(token.span(), letter, Some(order)));
            }
            let kinds: Vec<TokenKind> = rest.iter().take(8).map(|token| token.kind).collect();
            let is_time = |place: usize| {
                rest.get(place).is_some_and(|token| ["dt", "dt2"].contains(&text(token)))
            };
            // The numerator is d, d2x or dx over dt, or else d^2 x over dt^2.
            let numerator = name.strip_prefix('d');
            let (quotient, letter, order) = match kinds.as_slice() {
                [TokenKind::Name, TokenKind::Divide, TokenKind::Name, ..] if is_time(2) => {
                    (2, numerator, 1 + usize::from(name.starts_with("d2")))
                }
                [
                    TokenKind::Name,
                    TokenKind::Power,
                    TokenKind::Number,
                    TokenKind::Name,
                    TokenKind::Divide,
                    TokenKind::Name,
                    ..,
                ] if name == "d" && is_time(5) => (5, Some(text(&rest[3])), 2),
                [
                    TokenKind::Name,
                    TokenKind::Power,
                    TokenKind::Number,
                    TokenKind::Divide,
                    TokenKind::Name,
                    ..,
                ] if name == "d" && is_time(4) => (4, Some(""), 2),
                _ => continue,
            };
            let Some(letter) =
                letter.map(|rest| rest.trim_start_matches('2')).filter(|letter| letter.len() <= 1)
            else {
                continue;
            };
            let mut end = quotient;
            if kinds.get(end + 1) == Some(&TokenKind::Power)
                && kinds.get(end + 2) == Some(&TokenKind::Number)
            {
                end += 2;
            }
            let letter = if letter.is_empty() { "x" } else { letter };
            return Err(self.derivative_error(token.start..rest[end].end, letter, Some(order)));
        }
        Ok(())
    }

    fn derivative_error(
        &self,
        span: Range<usize>,
        letter: &str,
        order: Option<usize>,
    ) -> ParseError {
        let message = format!("{}: derivatives are written with primes", self.quoted(span.clone()));
        let help = match order {
            Some(order) => format!("try `{letter}{}`", "'".repeat(order)),
            None => "try `x'` for the velocity, `x''` for the acceleration".into(),
        };
        let meaning = order.map(|order| format!("{letter}{}", "'".repeat(order)));
        self.error(span, &message, &help).meaning_here(meaning)
    }

    /// The error of two operands side by side.
    pub(super) fn missing_sign(&self) -> ParseError {
        let Some(previous) = self.previous() else {
            return self.unexpected();
        };
        let left = match previous.kind {
            TokenKind::Close => match matching_open(&self.tokens, self.next - 1) {
                Some(0) => 0,
                Some(open) => open - usize::from(self.tokens[open - 1].kind == TokenKind::Name),
                None => self.next - 1,
            },
            _ => self.next - 1,
        };
        let mut right = self.next;
        if self.peek() == TokenKind::Name
            && self.tokens.get(right + 1).is_some_and(|next| next.kind == TokenKind::Open)
        {
            right += 1;
        }
        if self.tokens[right].kind == TokenKind::Open {
            right = matching_close(&self.tokens, right).unwrap_or(right);
        }
        let (left, right) =
            (self.tokens[left].start..previous.end, self.token().start..self.tokens[right].end);
        let message = format!("{}: a product needs its sign", self.quoted(left.start..right.end));
        let factors = [left.clone(), right.clone()].map(|factor| &self.text[factor]);
        if let ([TokenKind::Number, TokenKind::Name], "deg" | "rad") =
            ([previous.kind, self.peek()], factors[1])
        {
            let number = factors[0];
            let angle = match factors[1] {
                "deg" => format!("{number}*pi/180"),
                _ => number.to_owned(),
            };
            let help = format!("angles are in radians: try `{angle}`");
            return self.error(left.start..right.end, &message, &help).meaning_here(Some(angle));
        }
        let help = format!("try `{}*{}`", shortened(factors[0]), shortened(factors[1]));
        let error = self.error(left.start..right.end, &message, &help);
        match self.is_product(previous) {
            true => error.meaning(previous.end..right.start, "*"),
            false => error,
        }
    }

    /// Whether the operand that ends with this token and the one after it can only be factors of a
    /// product.
    fn is_product(&self, left: Token) -> bool {
        let right = self.token();
        let [left_text, right_text] = [left, right].map(|token| &self.text[token.span()]);
        match (left.kind, right.kind) {
            // An exponent that is not finished, Euler's number, or a hexadecimal number.
            (TokenKind::Number, TokenKind::Name) if ["e", "E"].contains(&right_text) => false,
            (TokenKind::Number, TokenKind::Name) if left_text == "0" && left.end == right.start => {
                false
            }
            // `d x/dt` is a derivative.
            (TokenKind::Name, TokenKind::Name) => self
                .tokens
                .iter()
                .filter(|token| token.kind == TokenKind::Name)
                .all(|token| !["d", "dt", "dt2"].contains(&&self.text[token.span()])),
            (TokenKind::Number | TokenKind::Close, TokenKind::Name | TokenKind::Open) => true,
            _ => false,
        }
    }

    pub(super) fn bare_function(&self, token: Token) -> ParseError {
        let name = &self.text[token.span()];
        let next = self.token();
        let message = format!("`{name}` needs parentheses around its argument");
        match next.kind {
            TokenKind::Name | TokenKind::Number => {
                let argument = &self.text[next.span()];
                let call = format!("{name}({argument})");
                let error = self.error(token.start..next.end, &message, &format!("try `{call}`"));
                // `sin x cos x` and `sin 2 x` leave open where the argument ends.
                let after =
                    self.tokens.get(self.next + 1).map_or(TokenKind::End, |after| after.kind);
                let ends = [
                    TokenKind::End,
                    TokenKind::Plus,
                    TokenKind::Minus,
                    TokenKind::Equals,
                    TokenKind::Close,
                    TokenKind::Comma,
                ];
                let is_plain = Function::from_name(argument).is_none() && ends.contains(&after);
                error.meaning_here(is_plain.then_some(call))
            }
            TokenKind::Power => {
                let error = self.error(token.span(), &message, &format!("try `{name}(x)^2`"));
                match self.raised_call(token) {
                    Some((part, call)) => error.meaning(part, call),
                    None => error,
                }
            }
            _ => self.error(token.span(), &message, &format!("try `{name}(x)`")),
        }
    }

    /// Corrects `sin^2(x)`, the square of the sine; not `sin^-1(x)`, which may be the inverse or
    /// the reciprocal.
    fn raised_call(&self, name: Token) -> Option<(Range<usize>, String)> {
        let [_, exponent, open] = self.tokens.get(self.next..self.next + 3)? else {
            return None;
        };
        if [exponent.kind, open.kind] != [TokenKind::Number, TokenKind::Open] {
            return None;
        }
        let close = self.tokens[matching_close(&self.tokens, self.next + 2)?];
        let [name_text, argument, exponent] =
            [name.span(), open.start..close.end, exponent.span()].map(|part| &self.text[part]);
        Some((name.start..close.end, format!("{name_text}{argument}^{exponent}")))
    }

    /// The meaning of a name before a parenthesis that is not a function: the coordinate at the
    /// time t, or a factor. `None` if it may be either a factor or a function.
    fn called_name(&self, token: Token) -> Option<(Range<usize>, String)> {
        let name = &self.text[token.span()];
        let bare = name.trim_end_matches('\'');
        let close = matching_close(&self.tokens, self.next)?;
        let inner = self.tokens.get(self.next + 1..close)?;
        let text = |token: &Token| &self.text[token.span()];
        let is_primed = |token: &Token| {
            text(token)
                .strip_prefix(bare)
                .is_some_and(|rest| !rest.is_empty() && rest.chars().all(|letter| letter == '\''))
        };
        let is_coordinate = self.tokens.iter().any(is_primed);
        let names_time = |token: &Token| token.kind == TokenKind::Name && text(token) == "t";
        if let [time] = inner
            && names_time(time)
        {
            let call = self.tokens[self.next].start..self.tokens[close].end;
            return is_coordinate.then(|| (call, String::new()));
        }
        let is_sum = inner
            .iter()
            .skip(1)
            .any(|token| matches!(token.kind, TokenKind::Plus | TokenKind::Minus));
        // Usual names of functions in an equation of motion, such as excitations.
        const FUNCTIONS: [&str; 10] = ["f", "g", "h", "F", "G", "u", "U", "d", "delta", "theta"];
        let is_parameter = (is_letter(bare) || bare == "eps" || bare == "pi")
            && !FUNCTIONS.contains(&bare)
            && is_sum
            && !inner.iter().any(|token| names_time(token) || token.kind == TokenKind::Comma);
        (is_coordinate || is_parameter).then(|| (token.end..token.end, "*".to_owned()))
    }

    /// The error of a name before a parenthesis that is not a function.
    pub(super) fn unknown_function(&self, token: Token) -> ParseError {
        let error = self.without_such_function(token);
        match self.called_name(token) {
            Some((part, meaning)) if error.correction.is_none() => error.meaning(part, meaning),
            _ => error,
        }
    }

    fn without_such_function(&self, token: Token) -> ParseError {
        let name = &self.text[token.span()];
        if let Some(known) = similar_function(name) {
            let message = format!("there is no function `{name}`");
            let error = self.error(token.span(), &message, &format!("did you mean `{known}`?"));
            let folded = name.to_ascii_lowercase();
            let is_same = folded == known || other_name(&folded) == Some(known);
            return error.meaning_here(is_same.then(|| known.to_owned()));
        }
        let argument = matching_close(&self.tokens, self.next)
            .map_or(token.end, |place| self.tokens[place].end);
        let product = format!("{name}*{}", shortened(&self.text[token.end..argument]));
        if name.trim_end_matches('\'').len() == 1 || name == "pi" {
            let message =
                format!("{}: a product needs its sign", self.quoted(token.start..argument));
            return self.error(token.start..argument, &message, &format!("try `{product}`"));
        }
        let names: Vec<&str> = Function::all().map(Function::name).chain(["sqrt"]).collect();
        let help = format!("the functions are {}; a product is `{product}`", names.join(" "));
        self.error(token.span(), &format!("there is no function `{name}`"), &help)
    }

    pub(super) fn missing_operand(&self) -> ParseError {
        let token = self.token();
        let previous = self.next.checked_sub(1).and_then(|place| self.tokens.get(place));
        match (previous, token.kind) {
            (None, TokenKind::Close) => self.unexpected(),
            (Some(previous), _) => {
                let message =
                    format!("something is missing after {}", self.quoted(previous.span()));
                self.error(previous.span(), &message, "")
            }
            (None, _) => {
                let message = format!("something is missing before {}", self.quoted(token.span()));
                self.error(token.span(), &message, "")
            }
        }
    }

    /// The error of a token that cannot continue the text.
    pub(super) fn unexpected(&self) -> ParseError {
        let token = self.token();
        match token.kind {
            TokenKind::Close => self.error(token.span(), "this `)` closes nothing", ""),
            TokenKind::Comma if has_initial_value(&self.tokens, self.text) => self.error(
                token.span(),
                "an equation of motion stands alone, without its initial values",
                "they are options: `--at A=1` of a formula, `--from x=1` of a simulation",
            ),
            TokenKind::Comma => self.error(
                token.span(),
                "a `,` stands between the arguments of `max` and `min` alone",
                "a decimal point is `.`",
            ),
            TokenKind::Equals => self.error(token.span(), "an `=` where none can stand", ""),
            _ => self.error(
                token.span(),
                &format!("{} cannot stand here", self.quoted(token.span())),
                "",
            ),
        }
    }
}

/// Whether `x(0) =` stands among these tokens.
fn has_initial_value(tokens: &[Token], text: &str) -> bool {
    tokens.windows(5).any(|window| {
        let kinds: Vec<TokenKind> = window.iter().map(|token| token.kind).collect();
        kinds
            == [
                TokenKind::Name,
                TokenKind::Open,
                TokenKind::Number,
                TokenKind::Close,
                TokenKind::Equals,
            ]
            && text[window[2].span()].trim_matches(['0', '.']).is_empty()
    })
}

fn matching_close(tokens: &[Token], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (place, token) in tokens.iter().enumerate().skip(open) {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close if depth == 1 => return Some(place),
            TokenKind::Close => depth = depth.checked_sub(1)?,
            _ => {}
        }
    }
    None
}

fn matching_open(tokens: &[Token], close: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (place, token) in tokens.iter().enumerate().take(close + 1).rev() {
        match token.kind {
            TokenKind::Close => depth += 1,
            TokenKind::Open if depth == 1 => return Some(place),
            TokenKind::Open => depth = depth.checked_sub(1)?,
            _ => {}
        }
    }
    None
}

/// Reads `x_dot`, `xdot`, `x_ddot`: returns the letter and the order of the derivative.
fn dotted(name: &str) -> Option<(&str, usize)> {
    let letter = name.get(..1)?;
    match name.get(1..)?.trim_start_matches('_') {
        "dot" => Some((letter, 1)),
        "ddot" | "dotdot" => Some((letter, 2)),
        _ => None,
    }
}

/// The function that other programs call by this name, given in small letters.
fn other_name(name: &str) -> Option<&'static str> {
    Some(match name {
        "ln" => "log",
        "sign" | "signum" => "sgn",
        "heaviside" | "step" => "H",
        "arcsin" | "arsin" => "asin",
        "arccos" => "acos",
        "arctan" | "arctg" => "atan",
        "arcsinh" | "arsinh" => "asinh",
        "fabs" | "absolute" => "abs",
        "maximum" => "max",
        "minimum" => "min",
        "sh" => "sinh",
        "ch" => "cosh",
        "th" => "tanh",
        "tg" => "tan",
        _ => return None,
    })
}

/// The function that was probably meant.
fn similar_function(name: &str) -> Option<&'static str> {
    let folded = name.to_ascii_lowercase();
    if let Some(known) = other_name(&folded) {
        return Some(known);
    }
    if folded == "root" {
        return Some("sqrt");
    }
    if name.len() < 2 || name.ends_with('\'') {
        return None;
    }
    let names = Function::all().map(Function::name).chain(["sqrt"]).filter(|known| known.len() > 1);
    let closest = names
        .map(|known| (osa_distance(&folded, known), known))
        .min_by_key(|(distance, _)| *distance)?;
    (closest.0 <= 1).then_some(closest.1)
}
