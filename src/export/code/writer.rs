//! A program as text: expressions, names, lines.

use std::collections::{BTreeMap, BTreeSet};

use num_traits::{One, Signed, Zero};

use super::{
    Base, Break, Exponent, NoCode, Program, Routine, Statement, Syntax, Text, UsedRoutines, Value,
    commented,
};
use crate::exact::Integer;
use crate::exact::rational::{Rational, to_f64};
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// Greatest length of a line that can be broken, in characters.
const WIDTH: usize = 100;

/// The source text of a program.
pub(super) fn source(program: &Program, syntax: &'static Syntax) -> Result<String, NoCode> {
    let functions = functions(program);
    let names = names(program, syntax, &functions);
    let writer = Writer { syntax, names: &names };
    let helpers = functions.iter().filter_map(|function| (syntax.helper)(*function));
    let mut parts: Vec<String> = helpers.map(str::to_owned).collect();
    for routine in &program.routines {
        parts.push(writer.routine(routine)?);
    }
    let text = parts.join("\n");
    let routines: Vec<&str> =
        program.routines.iter().map(|routine| routine.name.as_str()).collect();
    let beginning = (syntax.beginning)(&UsedRoutines { text: &text, routines: &routines });
    let renamed = names.iter().filter(|(symbol, name)| symbol.written() != **name);
    let renamed: Vec<String> =
        renamed.map(|(symbol, name)| format!("{symbol} is {name} here")).collect();
    let mut header = program.header.clone();
    if !renamed.is_empty() {
        header.extend([String::new(), format!("{}.", renamed.join(", "))]);
    }
    let header = commented(&header.join("\n"), syntax.comment);
    let parts = [header, beginning, text].into_iter().filter(|part| !part.is_empty());
    let whole = parts.collect::<Vec<String>>().join("\n");
    Ok(whole.trim_end().to_owned() + "\n")
}

/// Every expression of a program.
fn expressions(program: &Program) -> Vec<&Expr> {
    let bodies = program.routines.iter().flat_map(|routine| {
        let values = routine.body.iter().filter_map(|statement| match statement {
            Statement::Variable(_, value) => Some(value),
            Statement::Size(_) | Statement::Positive(..) | Statement::Unused(_) => None,
        });
        values.chain([&routine.result])
    });
    let (mut open, mut found): (Vec<&Value>, Vec<&Expr>) = (bodies.collect(), vec![]);
    while let Some(value) = open.pop() {
        match value {
            Value::Expression(expression) => found.push(expression),
            Value::Sum(parts) | Value::Lines(parts) | Value::Product(parts) => open.extend(parts),
            Value::Call(..) => {}
        }
    }
    found
}

/// The functions of the table that a program calls.
fn functions(program: &Program) -> BTreeSet<Function> {
    let nodes = expressions(program).into_iter().flat_map(Expr::unique_nodes);
    let function = |expression: &Expr| match expression.node() {
        Node::Function(function, _) => Some(*function),
        _ => None,
    };
    let mut functions: BTreeSet<Function> = nodes.filter_map(function).collect();
    // The code of all three functions is in the first of them.
    if [Function::JacobiCn, Function::JacobiDn].iter().any(|function| functions.contains(function))
    {
        functions.insert(Function::JacobiSn);
    }
    functions
}

/// The name of every variable: its own, with underscores added if the language uses that name.
fn names(
    program: &Program,
    syntax: &Syntax,
    functions: &BTreeSet<Function>,
) -> BTreeMap<Symbol, String> {
    let variables = |routine: &Routine| {
        let locals = routine.body.iter().filter_map(|statement| match statement {
            Statement::Variable(name, _) => Some(*name),
            Statement::Size(_) | Statement::Positive(..) | Statement::Unused(_) => None,
        });
        locals.chain(routine.arguments.iter().copied()).collect::<Vec<Symbol>>()
    };
    let symbols: BTreeSet<Symbol> = program.routines.iter().flat_map(variables).collect();
    let called: Vec<&str> = functions
        .iter()
        .map(|function| (syntax.function)(*function))
        .chain(program.routines.iter().map(|routine| routine.name.as_str()))
        .chain(functions.contains(&Function::JacobiSn).then_some("jacobi_functions"))
        .collect();
    let mut names: BTreeMap<Symbol, String> = BTreeMap::new();
    for symbol in &symbols {
        let taken = |name: &String| {
            called.contains(&name.as_str())
                || syntax.reserved.contains(&name.as_str())
                || names.values().any(|other| other == name)
                || symbols.iter().any(|other| other != symbol && other.written() == name)
        };
        let mut name = symbol.written().to_owned();
        while taken(&name) {
            name.push('_');
        }
        names.insert(*symbol, name);
    }
    names
}

/// The precedence of an expression.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Precedence {
    Sum,
    Product,
    Power,
    Atom,
}

/// A part of an expression as text.
#[derive(Clone)]
struct CodeFragment {
    /// The text without its sign.
    text: String,
    /// Whether its sign is minus.
    negative: bool,
    level: Precedence,
    /// Whether it consists only of literal numbers.
    literal: bool,
    /// The denominator, if this is a factor of a fraction.
    below: Option<Box<CodeFragment>>,
}

impl CodeFragment {
    fn new(text: String, level: Precedence) -> Self {
        Self { text, negative: false, level, literal: false, below: None }
    }

    fn literal(text: String, level: Precedence) -> Self {
        Self { literal: true, ..Self::new(text, level) }
    }

    /// The text with its sign.
    fn with_sign(&self) -> String {
        match self.negative {
            true => format!("-{}", self.text),
            false => self.text.clone(),
        }
    }

    /// The text as an operand, in parentheses if its precedence is lower than `level`.
    fn as_operand(&self, level: Precedence) -> String {
        match self.level < level || self.negative {
            true => format!("({})", self.with_sign()),
            false => self.text.clone(),
        }
    }

    fn as_base(&self) -> Base {
        Base {
            inside: self.with_sign(),
            operand: self.as_operand(Precedence::Atom),
            literal: self.literal,
        }
    }

    fn is_one(&self) -> bool {
        self.literal && self.text.trim_end_matches(".0") == "1"
    }
}

struct Writer<'a> {
    syntax: &'static Syntax,
    names: &'a BTreeMap<Symbol, String>,
}

impl Writer<'_> {
    fn routine(&self, routine: &Routine) -> Result<String, NoCode> {
        let mut lines = Vec::new();
        for statement in &routine.body {
            match statement {
                Statement::Variable(name, value) => {
                    let literal = self.value(value)?.literal;
                    let [before, after] = (self.syntax.variable)(&self.name(*name), literal);
                    lines.extend(self.lines(&before, value, &after)?);
                }
                Statement::Size(name) => lines.push((self.syntax.size)(&self.name(*name))),
                Statement::Unused(name) => {
                    lines.extend(self.syntax.unused.map(|unused| unused(&self.name(*name))));
                }
                Statement::Positive(name, spoilt, reason) => {
                    let condition =
                        (self.syntax.positive)(&self.name(*name), &self.name(*spoilt), reason);
                    lines.extend(condition.lines().map(str::to_owned));
                }
            }
        }
        let [before, after] = self.syntax.result;
        lines.extend(self.lines(before, &routine.result, after)?);
        let arguments: Vec<String> =
            routine.arguments.iter().map(|name| self.name(*name)).collect();
        Ok((self.syntax.routine)(&Text {
            name: &routine.name,
            about: &routine.about,
            arguments: &arguments,
            lines: &lines,
        }))
    }

    fn name(&self, symbol: Symbol) -> String {
        self.names.get(&symbol).cloned().unwrap_or_else(|| symbol.written().to_owned())
    }

    /// A value between two texts, in as many lines as it needs.
    fn lines(&self, before: &str, value: &Value, after: &str) -> Result<Vec<String>, NoCode> {
        let whole = self.value(value)?.with_sign();
        if before.len() + whole.len() + after.len() <= WIDTH {
            return Ok(vec![format!("{before}{whole}{after}")]);
        }
        let parts: Vec<String> = match value {
            Value::Lines(terms) => {
                let terms = terms.iter().map(|term| self.value(term));
                let mut parts = Vec::new();
                for (index, term) in terms.enumerate() {
                    let term = term?;
                    let unsigned = CodeFragment { negative: false, ..term.clone() };
                    let sign = match (index, term.negative) {
                        (0, false) => "",
                        (0, true) => "-",
                        (_, false) => "+ ",
                        (_, true) => "- ",
                    };
                    let level = if index == 0 { Precedence::Sum } else { Precedence::Product };
                    parts.push(format!("{sign}{}", unsigned.as_operand(level)));
                }
                parts
            }
            _ => vec![whole],
        };
        let filled = parts.iter().enumerate().flat_map(|(index, part)| {
            let deeper = matches!(value, Value::Lines(_));
            let filled = filled(part, if index == 0 { before.len() } else { 4 });
            let line = move |(place, line): (usize, String)| match place > 0 && deeper {
                true => format!("    {line}"),
                false => line,
            };
            filled.into_iter().enumerate().map(line).collect::<Vec<_>>()
        });
        Ok(broken(before, filled.collect(), after, &self.syntax.breaks))
    }

    fn value(&self, value: &Value) -> Result<CodeFragment, NoCode> {
        match value {
            Value::Expression(expression) => self.expression(expression),
            Value::Sum(parts) | Value::Lines(parts) => {
                let parts: Vec<CodeFragment> =
                    parts.iter().map(|part| self.value(part)).collect::<Result<_, _>>()?;
                Ok(self.sum(&parts))
            }
            Value::Product(parts) => {
                let parts: Vec<CodeFragment> =
                    parts.iter().map(|part| self.value(part)).collect::<Result<_, _>>()?;
                let negative = parts.iter().filter(|part| part.negative).count() % 2 == 1;
                let unsigned =
                    parts.into_iter().map(|part| CodeFragment { negative: false, ..part });
                let factors: Vec<CodeFragment> = unsigned.filter(|part| !part.is_one()).collect();
                // A fraction precedes its other factors without parentheses.
                let first = factors.first().map(|first| CodeFragment {
                    level: if first.level == Precedence::Product {
                        Precedence::Power
                    } else {
                        first.level
                    },
                    ..first.clone()
                });
                let factors = first.into_iter().chain(factors.into_iter().skip(1)).collect();
                Ok(CodeFragment { negative, ..self.fraction(factors, vec![]) })
            }
            Value::Call(name, arguments) => {
                let arguments: Vec<String> =
                    arguments.iter().map(|argument| self.name(*argument)).collect();
                Ok(CodeFragment::new(format!("{name}({})", arguments.join(", ")), Precedence::Atom))
            }
        }
    }

    fn expression(&self, expression: &Expr) -> Result<CodeFragment, NoCode> {
        expression.fold(|node, children: &[CodeFragment]| self.node(node, children))
    }

    fn node(&self, expression: &Expr, children: &[CodeFragment]) -> Result<CodeFragment, NoCode> {
        Ok(match expression.node() {
            Node::Number(value) => self.number(value)?,
            Node::Pi => CodeFragment::new(self.syntax.pi.to_owned(), Precedence::Atom),
            Node::Symbol(symbol) => CodeFragment::new(self.name(*symbol), Precedence::Atom),
            Node::Sum(_) => self.sum(&positive_first(children)),
            Node::Product(coefficient, _) => {
                let (above, below) = self.number_parts(coefficient)?;
                let (mut above, mut below) = (Vec::from_iter(above), Vec::from_iter(below));
                for child in children {
                    match &child.below {
                        Some(inverse) => below.push((**inverse).clone()),
                        None => above.push(child.clone()),
                    }
                }
                CodeFragment { negative: coefficient.is_negative(), ..self.fraction(above, below) }
            }
            Node::Power(base, exponent) => match (exponent.as_number(), children) {
                (Some(number), [written, _]) if number.is_negative() => {
                    let inverse = self.power(base, written, &-number)?;
                    CodeFragment {
                        below: Some(Box::new(inverse.clone())),
                        ..self.fraction(vec![], vec![inverse])
                    }
                }
                (Some(number), [written, _]) => self.power(base, written, number)?,
                (None, [base, exponent]) => {
                    let text =
                        (self.syntax.power)(&base.as_base(), Exponent::Real(&exponent.with_sign()));
                    CodeFragment::new(text, Precedence::Power)
                }
                _ => CodeFragment::new(String::new(), Precedence::Atom),
            },
            Node::Function(function, _) => self.call((self.syntax.function)(*function), children),
        })
    }

    fn call(&self, name: &str, arguments: &[CodeFragment]) -> CodeFragment {
        let written = |arguments: &[CodeFragment]| {
            let written: Vec<String> = arguments.iter().map(CodeFragment::with_sign).collect();
            written.join(", ")
        };
        let text = match (name.strip_prefix('.'), arguments) {
            // A literal number has no definite type on which a method could be called.
            (Some(method), [first, ..]) if first.literal => {
                format!("f64::{method}({})", written(arguments))
            }
            (Some(method), [first, rest @ ..]) => {
                format!("{}.{method}({})", first.as_operand(Precedence::Atom), written(rest))
            }
            _ => format!("{name}({})", written(arguments)),
        };
        CodeFragment::new(text, Precedence::Atom)
    }

    /// `base^number` for a positive number.
    fn power(
        &self,
        base: &Expr,
        written: &CodeFragment,
        number: &Rational,
    ) -> Result<CodeFragment, NoCode> {
        if number.is_one() {
            return Ok(written.clone());
        }
        let two = Rational::from_integer(2.into());
        let [whole, exponent] = [number.to_integer().to_string(), self.number(number)?.text];
        let is_odd = |number: &Integer| !(number % Integer::from(2)).is_zero();
        let exponent = match number {
            _ if number.is_integer() => Exponent::Whole(&whole),
            _ if (number * &two).is_one() => Exponent::Half,
            _ if is_odd(number.denom()) && !base.as_number().is_some_and(Signed::is_positive) => {
                Exponent::OddRoot(&exponent, is_odd(number.numer()))
            }
            _ => Exponent::Real(&exponent),
        };
        let level = match exponent {
            Exponent::Half => Precedence::Atom,
            _ => Precedence::Power,
        };
        Ok(CodeFragment::new((self.syntax.power)(&written.as_base(), exponent), level))
    }

    /// A sum of one or more pieces.
    fn sum(&self, terms: &[CodeFragment]) -> CodeFragment {
        if let [only] = terms {
            return only.clone();
        }
        let mut text = String::new();
        for term in terms {
            let unsigned = CodeFragment { negative: false, ..term.clone() };
            let level = if text.is_empty() { Precedence::Sum } else { Precedence::Product };
            text.push_str(match (text.is_empty(), term.negative) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            });
            text.push_str(&unsigned.as_operand(level));
        }
        match text.is_empty() {
            true => CodeFragment::literal(format!("0{}", self.syntax.point), Precedence::Atom),
            false => CodeFragment {
                literal: terms.iter().all(|term| term.literal),
                ..CodeFragment::new(text, Precedence::Sum)
            },
        }
    }

    /// A quotient of two products.
    fn fraction(&self, above: Vec<CodeFragment>, below: Vec<CodeFragment>) -> CodeFragment {
        let one =
            || vec![CodeFragment::literal(format!("1{}", self.syntax.point), Precedence::Atom)];
        let above = if above.is_empty() { one() } else { above };
        let numerator = self.product(&above);
        match below.as_slice() {
            [] => numerator,
            [divisor] => {
                let text = self.joined(
                    1,
                    (&numerator.text, numerator.literal),
                    (&divisor.as_operand(Precedence::Power), divisor.literal),
                );
                CodeFragment {
                    literal: numerator.literal && divisor.literal,
                    ..CodeFragment::new(text, Precedence::Product)
                }
            }
            several => {
                let divisor = self.product(several);
                let text = self.joined(
                    1,
                    (&numerator.text, numerator.literal),
                    (&format!("({})", divisor.text), divisor.literal),
                );
                CodeFragment::new(text, Precedence::Product)
            }
        }
    }

    fn product(&self, factors: &[CodeFragment]) -> CodeFragment {
        let Some((first, rest)) = factors.split_first() else {
            return CodeFragment::literal(format!("1{}", self.syntax.point), Precedence::Atom);
        };
        if rest.is_empty() {
            return match first.level {
                Precedence::Sum => {
                    CodeFragment::new(first.as_operand(Precedence::Power), Precedence::Atom)
                }
                _ => first.clone(),
            };
        }
        let (mut text, mut literal, mut last) =
            (first.as_operand(Precedence::Power), first.literal, first.literal);
        for factor in rest {
            let next = factor.as_operand(Precedence::Power);
            text = self.joined(0, (&text, last), (&next, factor.literal));
            literal &= factor.literal;
            last = factor.literal;
        }
        CodeFragment { literal, ..CodeFragment::new(text, Precedence::Product) }
    }

    /// Two operands with the sign of a product or a quotient between them, and whether each is a
    /// literal number.
    fn joined(&self, operator: usize, left: (&str, bool), right: (&str, bool)) -> String {
        let between_values = match operator {
            0 => !left.1 && !right.1,
            // A quotient by a variable is taken element by element.
            _ => !right.1,
        };
        let operators =
            if between_values { &self.syntax.between_values } else { &self.syntax.operators };
        format!("{}{}{}", left.0, operators[operator], right.0)
    }

    fn number(&self, value: &Rational) -> Result<CodeFragment, NoCode> {
        let (above, below) = self.number_parts(value)?;
        Ok(CodeFragment {
            negative: value.is_negative(),
            ..self.fraction(Vec::from_iter(above), Vec::from_iter(below))
        })
    }

    /// Numerator and denominator of the absolute value of a number; one of many digits is a decimal
    /// in the numerator.
    fn number_parts(
        &self,
        value: &Rational,
    ) -> Result<(Option<CodeFragment>, Option<CodeFragment>), NoCode> {
        /// Number of digits that a double always distinguishes.
        const DIGITS: usize = 15;
        let size = value.abs();
        let [above, below] = [size.numer(), size.denom()].map(ToString::to_string);
        let whole = |text: &String| {
            let piece =
                CodeFragment::literal(format!("{text}{}", self.syntax.point), Precedence::Atom);
            (text != "1").then_some(piece)
        };
        if above.len().max(below.len()) <= DIGITS && above.len() + below.len() <= DIGITS + 1 {
            return Ok((whole(&above), whole(&below)));
        }
        let double = to_f64(&size);
        match double.is_normal() {
            true => Ok((Some(CodeFragment::literal(decimal(double), Precedence::Atom)), None)),
            false => Err(NoCode::Beyond),
        }
    }
}

/// The shortest text that is read back as this number.
fn decimal(value: f64) -> String {
    match (1e-4..1e15).contains(&value) {
        true => format!("{value:?}"),
        false => format!("{value:e}"),
    }
}

/// Terms in reading order: if the first ones have a minus sign, the following positive ones are put
/// before them.
fn positive_first(terms: &[CodeFragment]) -> Vec<CodeFragment> {
    let minus = terms.iter().take_while(|term| term.negative).count();
    let (minus, others) = terms.split_at(minus);
    let plus = others.iter().take_while(|term| !term.negative).count();
    let (plus, others) = others.split_at(plus);
    [plus, minus, others].concat()
}

/// A text broken before its signs; `before` characters precede the first line.
fn filled(text: &str, before: usize) -> Vec<String> {
    let mut places: Vec<usize> = [" + ", " - "]
        .iter()
        .flat_map(|sign| text.match_indices(sign).map(|(place, _)| place))
        .collect();
    places.sort_unstable();
    places.push(text.len());
    let (mut lines, mut start, mut last) = (Vec::new(), 0, 0);
    for place in places {
        let room = WIDTH.saturating_sub(if lines.is_empty() { before } else { 8 });
        if place - start > room && last > start {
            lines.push(text[start..last].to_owned());
            start = last + 1;
        }
        last = place;
    }
    lines.push(text[start..].to_owned());
    lines
}

/// The lines of a broken expression, each but the first beginning with a sign, in the syntax of the
/// language.
fn broken(before: &str, lines: Vec<String>, after: &str, breaks: &Break) -> Vec<String> {
    let mut lines = lines;
    if lines.len() == 1 {
        return vec![format!("{before}{}{after}", lines[0])];
    }
    match breaks {
        Break::InParentheses => {
            let inner = lines.into_iter().map(|line| format!("    {line}"));
            let first = std::iter::once(format!("{before}("));
            first.chain(inner).chain([format!("){after}")]).collect()
        }
        Break::BeforeSigns => {
            let last = lines.len() - 1;
            lines[last].push_str(after);
            let line = |(index, line): (usize, String)| match index {
                0 => format!("{before}{line}"),
                _ => format!("    {line}"),
            };
            lines.into_iter().enumerate().map(line).collect()
        }
        Break::AfterSigns(end) => {
            let mut moved: Vec<String> = Vec::new();
            for line in lines {
                let margin = line.len() - line.trim_start().len();
                let (indent, rest) = line.split_at(margin);
                match (moved.last_mut(), rest.split_at_checked(2)) {
                    (Some(last), Some((sign, rest))) => {
                        last.extend([" ", sign.trim_end(), end]);
                        moved.push(format!("    {indent}{rest}"));
                    }
                    _ => moved.push(format!("{before}{line}")),
                }
            }
            if let Some(last) = moved.last_mut() {
                last.push_str(after);
            }
            moved
        }
    }
}
