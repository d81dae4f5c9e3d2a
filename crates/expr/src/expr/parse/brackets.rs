//! The terms of one side of an equation as they were typed, those inside scaled brackets one by
//! one: of `2*(x'' + x + 0.5*x')` a message quotes `0.5*x'`.
//!
//! A bracket is opened if the rest of its term consists of numbers and parameters;
//! `-mu*(1 - x^2)*x'` stays one term.

use std::ops::Range;
use std::sync::Arc;

use super::lexer::{Token, TokenKind};
use super::parse_expression;
use crate::expr::Expr;
use crate::expr::typed::{BracketContext, TypedTerm};
use crate::symbol::Symbol;

/// The deepest nesting of brackets that are opened, and the largest number of terms of one.
/// Equations typed by hand have fewer, so that reading the text of a bracket again for each level
/// costs little.
const DEEPEST: usize = 8;
const MOST_TERMS: usize = 256;

/// Returns the typed terms of one side, from the value of each term there and the range of its
/// tokens, signs included.
pub(super) fn typed_terms(
    text: &str,
    tokens: &[Token],
    shown: Vec<(Expr, Range<usize>)>,
    right: bool,
    coordinate: Symbol,
) -> Vec<TypedTerm> {
    let terms = shown.into_iter().map(|(value, range)| {
        let tokens = &tokens[range];
        (typed_term(value, tokens, right, None), tokens)
    });
    let mut open: Vec<(TypedTerm, &[Token])> = terms.collect();
    for _ in 0..DEEPEST {
        let pieces = open.into_iter().flat_map(|(term, tokens)| {
            opened(text, &term, tokens, coordinate).unwrap_or_else(|| vec![(term, tokens)])
        });
        open = pieces.collect();
    }
    open.into_iter().map(|(term, _)| term).collect()
}

fn typed_term(
    value: Expr,
    tokens: &[Token],
    right: bool,
    around: Option<Arc<BracketContext>>,
) -> TypedTerm {
    let (negative, rest) = unsigned(tokens);
    TypedTerm { value, span: span(rest), negative, right, around }
}

/// Returns the terms inside the bracket of a term whose other factors only scale it; `None` if
/// there is no such bracket.
fn opened<'a>(
    text: &str,
    term: &TypedTerm,
    tokens: &'a [Token],
    coordinate: Symbol,
) -> Option<Vec<(TypedTerm, &'a [Token])>> {
    let (negative, rest) = unsigned(tokens);
    let moves = |token: &Token| {
        let name = text[token.span()].trim_end_matches('\'');
        token.kind == TokenKind::Name && (name == coordinate.name() || name == "t")
    };
    let factors = split(rest, |kind| matches!(kind, TokenKind::Times | TokenKind::Divide));
    let mut moving = factors.iter().filter(|factor| rest[(*factor).clone()].iter().any(moves));
    let (factor, None) = (moving.next()?, moving.next()) else {
        return None;
    };
    let divides = factor.start > 0 && rest[factor.start - 1].kind == TokenKind::Divide;
    let (_, bracket) = unsigned(&rest[factor.clone()]);
    let [first, inner @ .., last] = bracket else {
        return None;
    };
    if divides
        || first.kind != TokenKind::Open
        || last.kind != TokenKind::Close
        || closes_before_its_end(bracket)
    {
        return None;
    }
    let whole = span(rest);
    let (before, after) = (&text[whole.start..first.start], &text[last.end..whole.end]);
    let scale = parse_expression(&format!("{before}1{after}")).ok()?;
    let scale = if negative { -scale } else { scale };
    // The scale of a nested bracket is the product of its own factor and that of the bracket around
    // it.
    let (scale, outer) = match &term.around {
        Some(outer) => (&scale * &outer.scale, (&*outer.opening, &*outer.closing, outer.negative)),
        None => (scale, ("", "", false)),
    };
    let bare = before.is_empty() && after.is_empty();
    let around = Arc::new(BracketContext {
        opening: format!("{}{before}{}", outer.0, if bare { "" } else { "(" }),
        closing: format!("{}{after}{}", if bare { "" } else { ")" }, outer.1),
        negative: outer.2 ^ negative,
        scale,
    });
    let inner_terms = split(inner, |kind| matches!(kind, TokenKind::Plus | TokenKind::Minus));
    if inner_terms.len() > MOST_TERMS {
        return None;
    }
    let pieces = inner_terms.into_iter().map(|range| {
        // The sign between two terms belongs to the second.
        let tokens = &inner[range.start.saturating_sub(1)..range.end];
        let value = parse_expression(&text[span(tokens)]).ok()?;
        let term = typed_term(&around.scale * &value, tokens, term.right, Some(around.clone()));
        Some((term, tokens))
    });
    pieces.collect()
}

/// Strips the signs before a term or a factor. Returns whether they amount to a minus, and the
/// tokens after them.
fn unsigned(tokens: &[Token]) -> (bool, &[Token]) {
    let signs =
        tokens.iter().take_while(|token| matches!(token.kind, TokenKind::Plus | TokenKind::Minus));
    let minuses = signs.clone().filter(|sign| sign.kind == TokenKind::Minus).count();
    (minuses % 2 == 1, &tokens[signs.count()..])
}

fn span(tokens: &[Token]) -> Range<usize> {
    tokens.first().map_or(0, |token| token.start)..tokens.last().map_or(0, |token| token.end)
}

/// Returns the ranges between the operators outside all brackets; a sign where an operand is
/// expected is not an operator.
fn split(tokens: &[Token], operator: impl Fn(TokenKind) -> bool) -> Vec<Range<usize>> {
    let (mut depth, mut start) = (0_usize, 0);
    let mut ranges = Vec::new();
    for (number, token) in tokens.iter().enumerate() {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth = depth.saturating_sub(1),
            kind if depth == 0
                && operator(kind)
                && number > 0
                && ends_operand(tokens[number - 1].kind) =>
            {
                ranges.push(start..number);
                start = number + 1;
            }
            _ => {}
        }
    }
    ranges.push(start..tokens.len());
    ranges
}

fn ends_operand(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::Number | TokenKind::Name | TokenKind::Close)
}

/// Whether the bracket that the first token opens is closed before the last: `(1 + x)^(2)`.
fn closes_before_its_end(tokens: &[Token]) -> bool {
    let mut depth = 0_usize;
    tokens[..tokens.len() - 1].iter().any(|token| {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    })
}
