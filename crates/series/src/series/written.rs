//! A system of equations as Rust: what a [`Tape`] does by looking up each operation, written out
//! once and compiled.
//!
//! In: equations as text. Out: the source of a function that computes the Taylor series of the
//! states, those of several motions side by side, where each operation is a sum or a call of a
//! kernel of `impact::taylor::kernels`. The source is kept in the tree, and a test holds it against
//! what is written here.
//!
//! ```text
//! d(time) = unit (1 + p r + q r^2) dr:    (n+1) y_(n+1) = unit (F_n + p F_(n-1) + q F_(n-2))       y' = F
//! y' = 1:                                 y = y_0 + unit (r + p r^2/2 + q r^3/3)
//! (y + g)' = F:                           y_(n+1) = ... - g_(n+1), so g holds states alone whose rates are states
//! ```
//!
//! The slope `u'` is stored one place down, as `n u_n` in the place of `u_(n-1)`: so its product
//! with another series is one like all others.

use std::collections::{BTreeMap, BTreeSet};

use crate::expr::{Function, Node, parse_expression};
use crate::symbol::Symbol;

use super::recurrence::Recurrences;
use super::tape::{Operation, Tape};

/// Equations of motion, and what their letters are called in Rust.
pub struct Equations {
    /// The name of the function.
    pub name: &'static str,
    /// The first line of its documentation.
    pub about: &'static str,
    /// Line by line `name = expression` for a part, which the lines below it may use, and
    /// `state' = rate` or `(state + expression)' = rate`.
    pub lines: &'static [&'static str],
    /// The states, the series that holds each, and where it begins.
    pub states: &'static [[&'static str; 3]],
    /// Sines and cosines, and where they begin.
    pub starts: &'static [[&'static str; 2]],
    /// Parameters; each is one number for each motion.
    pub parameters: &'static [[&'static str; 2]],
    /// Parameters that are zero in all motions unless a flag is set.
    pub switches: &'static [[&'static str; 2]],
    /// The function of the inputs that gives `p` and `q`.
    pub stretch: &'static str,
}

impl Equations {
    /// The source of the function.
    ///
    /// # Errors
    /// What cannot be read, and what there is no kernel for.
    pub fn to_rust(&self) -> Result<String, String> {
        Writer::new(self)?.function()
    }
}

/// The rate of a state, and what stands beside the state on the left.
struct Rate {
    state: usize,
    beside: Option<usize>,
    rate: usize,
}

/// A statement and when it is needed.
struct Statement {
    conditions: Vec<String>,
    text: String,
}

/// A number times a series: its sign, the factors and the place of the series.
struct Scaled {
    is_negative: bool,
    factors: Vec<String>,
    place: usize,
}

/// What is written, and what is known of it.
struct Writer<'a> {
    equations: &'a Equations,
    tape: Tape,
    rates: Vec<Rate>,
    names: BTreeMap<usize, String>,
    /// The functions of those parts that are one.
    functions: BTreeMap<usize, Function>,
    /// The places that are computed, each with the flag without which it is not.
    flags: BTreeMap<usize, Option<&'static str>>,
    /// Those that have a name: all but multiples of another series.
    stored: BTreeSet<usize>,
    /// Those of them of which no earlier coefficient is read.
    local: BTreeSet<usize>,
    /// Those computed one order ahead.
    ahead: BTreeSet<usize>,
}

impl<'a> Writer<'a> {
    fn new(equations: &'a Equations) -> Result<Self, String> {
        // Time itself is no series of unknown length.
        let grows = |state: &str| equations.lines.contains(&format!("{state}' = 1").as_str());
        let states = equations.states.iter().map(|[name, ..]| (*name, grows(name).then_some(1)));
        let parameters = equations.parameters.iter().map(|[name, _]| (*name, Some(0)));
        let variables = states.chain(parameters);
        let variables: Vec<_> =
            variables.map(|(name, degree)| (Symbol::from(name), degree)).collect();
        let mut recurrences = Recurrences::new(&variables, &BTreeMap::new(), 0);
        let (mut rates, mut names, mut functions) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        for line in equations.lines {
            let (left, right) =
                line.split_once(" = ").ok_or_else(|| format!("no equation: {line}"))?;
            let mut add = |text: &str| {
                let expression = parse_expression(text).map_err(|error| error.to_string())?;
                let place = recurrences.add(&expression).map_err(|error| error.to_string())?;
                Ok::<_, String>((expression, place))
            };
            let (expression, place) = add(right)?;
            let Some(left) = left.strip_suffix('\'') else {
                if let Node::Function(function, _) = expression.node() {
                    functions.insert(place, *function);
                }
                names.insert(place, left.to_owned());
                recurrences.define(left.into(), place);
                continue;
            };
            let sum = left.strip_prefix('(').and_then(|left| left.strip_suffix(')'));
            let (state, beside) = match sum.and_then(|sum| sum.split_once(" + ")) {
                None => (left, None),
                Some((state, beside)) => (state, Some(add(beside)?.1)),
            };
            let known = equations.states.iter().position(|[name, ..]| *name == state);
            rates.push(Rate {
                state: known.ok_or_else(|| format!("no state: {line}"))?,
                beside,
                rate: place,
            });
        }
        for (place, [name, ..]) in equations.states.iter().enumerate() {
            names.insert(place, (*name).to_owned());
        }
        let tape = recurrences.into_tape();
        for Rate { state, rate, .. } in &rates {
            if matches!(tape.operation(*rate), Operation::Sum(terms) if terms.len() > 1) {
                let name = format!("{}_rate", equations.states[*state][0]);
                names.entry(*rate).or_insert(name);
            }
        }
        for place in 0..tape.size() {
            if let (Operation::Quotient { over, .. }, Some(name)) =
                (tape.operation(place), names.get(&place))
            {
                let over_name = format!("{name}_over");
                names.entry(*over).or_insert(over_name);
            }
        }
        let mut writer = Self {
            equations,
            tape,
            rates,
            names,
            functions,
            flags: BTreeMap::new(),
            stored: BTreeSet::new(),
            local: BTreeSet::new(),
            ahead: BTreeSet::new(),
        };
        writer.find_stored();
        writer.find_flags();
        writer.find_ahead();
        writer.find_local();
        Ok(writer)
    }

    fn is_state(&self, place: usize) -> bool {
        place < self.equations.states.len()
    }

    /// Those whose earlier coefficients are read: all but multiples of another series that stand in
    /// no product.
    fn find_stored(&mut self) {
        for place in 0..self.tape.size() {
            if self.tape.is_number(place) {
                continue;
            }
            match self.tape.operation(place) {
                Operation::Sum(terms) if terms.len() == 1 && !self.names.contains_key(&place) => {}
                Operation::Multiply(a, b, _) => self.stored.extend([*a, *b, place]),
                Operation::Quotient { over, .. } => self.stored.extend([*over, place]),
                _ => {
                    self.stored.insert(place);
                }
            }
        }
    }

    /// What a place reads, each with the flag without which it does not.
    fn reads(&self, place: usize) -> Vec<(usize, Option<&'static str>)> {
        let plain = |places: &[usize]| places.iter().map(|place| (*place, None)).collect();
        match self.tape.operation(place) {
            Operation::Sum(terms) => {
                let terms = terms.iter().filter(|(_, place)| !self.tape.is_number(*place));
                terms.map(|term| (term.1, self.switch(*term))).collect()
            }
            Operation::Multiply(a, b, _) => plain(&[*a, *b]),
            Operation::Slope(a) => plain(&[*a]),
            Operation::Quotient { of, over, .. } => plain(&[*of, *over]),
            // Those of time go by each other alone.
            Operation::Waves { degree: 1, .. } => vec![],
            Operation::Waves { slope, .. } => plain(&[*slope]),
            Operation::SecondWave => plain(&[place - 1]),
            _ => vec![],
        }
    }

    fn find_flags(&mut self) {
        let roots = self.rates.iter().flat_map(|rate| rate.beside.iter().chain([&rate.rate]));
        self.flags = roots.map(|root| (*root, None)).collect();
        // A place reads only those before it.
        for place in (0..self.tape.size()).rev() {
            let Some(own) = self.flags.get(&place).copied() else {
                continue;
            };
            if let Operation::Waves { .. } = self.tape.operation(place) {
                self.flags.insert(place + 1, own);
            }
            for (read, flag) in self.reads(place) {
                let flag = own.or(flag);
                let known = self.flags.entry(read).or_insert(flag);
                if *known != flag {
                    *known = None;
                }
            }
        }
    }

    fn find_ahead(&mut self) {
        let mut open: Vec<usize> = self.rates.iter().filter_map(|rate| rate.beside).collect();
        while let Some(place) = open.pop() {
            if !self.is_state(place) && self.ahead.insert(place) {
                open.extend(self.reads(place).iter().map(|(read, _)| *read));
            }
        }
        // A slope comes with what it is the slope of.
        for place in self.flags.keys() {
            if let Operation::Slope(of) = self.tape.operation(*place)
                && self.ahead.contains(of)
            {
                self.ahead.insert(*place);
            }
        }
    }

    /// Sums that are a rate alone, and products in one sum alone.
    fn find_local(&mut self) {
        let rates: Vec<usize> = self.rates.iter().map(|rate| rate.rate).collect();
        let mut local = BTreeSet::new();
        for place in self.flags.keys().filter(|place| !self.is_state(**place)) {
            let reads =
                |reader: &&usize| self.reads(**reader).iter().any(|(read, _)| read == place);
            let readers: Vec<usize> = self.flags.keys().filter(reads).copied().collect();
            let is_sum = |place: usize| matches!(self.tape.operation(place), Operation::Sum(_));
            let is_local = match self.tape.operation(*place) {
                Operation::Sum(_) => rates.contains(place) && readers.is_empty(),
                Operation::Multiply(..) => {
                    !rates.contains(place) && matches!(*readers, [reader] if is_sum(reader))
                }
                _ => false,
            };
            if is_local && !self.ahead.contains(place) {
                local.insert(*place);
            }
        }
        self.local = local;
    }

    /// The flag without which a term of a sum is zero.
    fn switch(&self, (weight, place): (usize, usize)) -> Option<&'static str> {
        let mut factors = vec![];
        self.number(weight, &mut factors).ok()?;
        let scaled = self.scaled(place).ok()?;
        factors.extend(scaled.factors);
        let parameter = |name: &str| self.equations.parameters.iter().find(|[own, _]| *own == name);
        let mut switches = self.equations.switches.iter();
        let found = switches.find(|[name, _]| {
            parameter(name).is_some_and(|[_, text]| factors.iter().any(|own| own == text))
        });
        found.map(|[_, flag]| *flag)
    }

    /// Adds the factors of a number; answers whether it is negative.
    fn number(&self, place: usize, factors: &mut Vec<String>) -> Result<bool, String> {
        let states = self.equations.states.len();
        match self.tape.operation(place) {
            Operation::Given => {
                if let Some([_, text]) =
                    place.checked_sub(states).and_then(|place| self.equations.parameters.get(place))
                {
                    factors.push((*text).to_owned());
                    return Ok(false);
                }
                let value = self.tape.series(place)[0];
                if value.abs() != 1.0 {
                    factors.push(format!("{:?}", value.abs()));
                }
                Ok(value < 0.0)
            }
            Operation::Sum(terms) if terms.len() == 1 => {
                Ok(self.number(terms[0].0, factors)? != self.number(terms[0].1, factors)?)
            }
            _ => Err(format!("a number that is no product: {:?}", self.tape.operation(place))),
        }
    }

    /// A place as a multiple of one that is stored.
    fn scaled(&self, mut place: usize) -> Result<Scaled, String> {
        let (mut is_negative, mut factors) = (false, vec![]);
        while !self.stored.contains(&place)
            && let Operation::Sum(terms) = self.tape.operation(place)
            && let [(weight, inner)] = **terms
        {
            is_negative ^= self.number(weight, &mut factors)?;
            place = inner;
        }
        Ok(Scaled { is_negative, factors, place })
    }

    /// What the series of a place is called.
    fn name(&self, place: usize) -> String {
        if let Some(name) = self.names.get(&place) {
            return name.clone();
        }
        match self.tape.operation(place) {
            Operation::Multiply(a, b, _) if a == b => format!("{}_squared", self.name(*a)),
            Operation::Multiply(a, b, _) => {
                let [a, b] = earlier_first([*a, *b]);
                format!("{}_{}", self.name(a), self.name(b))
            }
            Operation::Slope(of) => match self.scaled(*of) {
                Ok(scaled) => format!("{}_slope", self.name(scaled.place)),
                Err(_) => format!("slope_{place}"),
            },
            Operation::Sum(terms) if terms.len() == 1 => {
                format!("scaled_{}", self.name(terms[0].1))
            }
            _ => format!("sum_{place}"),
        }
    }

    /// A coefficient of a place times a number, with its sign in front.
    fn term(&self, weight: Option<usize>, place: usize, order: &str) -> Result<String, String> {
        let mut factors = vec![];
        let mut is_negative = match weight {
            Some(weight) => self.number(weight, &mut factors)?,
            None => false,
        };
        if self.tape.is_number(place) {
            is_negative ^= self.number(place, &mut factors)?;
            if factors.is_empty() {
                factors.push("1.0".to_owned());
            }
        } else {
            let scaled = self.scaled(place)?;
            is_negative ^= scaled.is_negative;
            factors.extend(scaled.factors);
            let name = self.name(scaled.place);
            factors.push(match self.local.contains(&scaled.place) {
                true => format!("{name}[lane]"),
                false => format!("{name}[{order}][lane]"),
            });
        }
        let sign = if is_negative { "-" } else { "+" };
        Ok(format!("{sign} {}", factors.join(" * ")))
    }

    /// The place of the slope of another place, if something reads it there: a quotient makes its
    /// own.
    fn slope_of(&self, of: usize) -> Option<usize> {
        let is_slope = |place: &&usize| matches!(self.tape.operation(**place), Operation::Slope(own) if *own == of);
        self.flags.keys().find(is_slope).copied()
    }

    /// The conditions of a place, and others.
    fn conditions(&self, place: usize, more: &[&str]) -> Vec<String> {
        let flag = self.flags.get(&place).copied().flatten();
        flag.iter().chain(more).map(|&condition| condition.to_owned()).collect()
    }

    /// What computes the coefficient of this order of a place; none of what is not stored.
    fn statements(&self, place: usize, order: &str) -> Result<Vec<Statement>, String> {
        let name = self.name(place);
        let one = |more: &[&str], text: String| {
            Ok(vec![Statement { conditions: self.conditions(place, more), text }])
        };
        if self.is_state(place) || self.tape.is_number(place) || !self.stored.contains(&place) {
            return Ok(vec![]);
        }
        match self.tape.operation(place) {
            Operation::Waves { .. } | Operation::Quotient { .. } if self.ahead.contains(&place) => {
                Err(format!("`{name}` cannot stand beside a state"))
            }
            Operation::Sum(terms) => self.sum(place, terms),
            Operation::Multiply(a, b, _) => {
                let [factor, other] = earlier_first([*a, *b]).map(|place| self.name(place));
                let product = match a == b {
                    true => format!("square({factor}, {order}, {name}_ahead)"),
                    false => format!("product({factor}, {other}, {order}, {name}_ahead)"),
                };
                match self.local.contains(&place) {
                    true => one(&[], format!("let {name} = {product};")),
                    false => one(&[], format!("{name}[{order}] = {product};")),
                }
            }
            Operation::Slope(of) if self.is_state(*of) => Ok(vec![]),
            Operation::Slope(of) => {
                let of = self.term(None, *of, order)?;
                let of = of.strip_prefix("+ ").ok_or("a slope of what is negative")?;
                match order {
                    "n + 1" => one(&[], format!("{name}[n] = each(|lane| (n + 1) as f64 * {of});")),
                    _ => one(&["n > 0"], format!("{name}[n - 1] = each(|lane| n as f64 * {of});")),
                }
            }
            Operation::Waves { of, slope, degree, sign, .. } => {
                if *sign > 0.0 {
                    return Err("hyperbolic functions have no kernel".to_owned());
                }
                let [sine, cosine] = [place, place + 1].map(|place| self.name(place));
                let waves = format!("[&mut *{sine}, &mut *{cosine}]");
                if *degree == 1 {
                    let phase = self.scaled(*of)?;
                    if phase.is_negative || !self.is_state(phase.place) || phase.factors.is_empty()
                    {
                        return Err(format!("`{sine}` is of no multiple of the time"));
                    }
                    let factor = phase.factors.join(" * ");
                    let factor = format!("each(|lane| inputs.unit[lane] * {factor} * INVERSE[n])");
                    return one(
                        &["n > 0"],
                        format!("waves_of_time({waves}, &stretch, &{factor}, n);"),
                    );
                }
                one(
                    &["n > 0"],
                    format!("sine_and_cosine({waves}, {}, n, {sine}_ahead);", self.name(*slope)),
                )
            }
            Operation::SecondWave => Ok(vec![]),
            Operation::Quotient { of, over, sign, .. } => {
                let function = match self.functions.get(&place) {
                    Some(Function::Atan) => "atan",
                    Some(Function::Log) => "ln",
                    other => return Err(format!("no kernel for {other:?}")),
                };
                let (value, slope) = (self.term(None, *of, "0")?, self.term(None, *of, "n")?);
                let (Some(value), Some(slope), true) =
                    (value.strip_prefix("+ "), slope.strip_prefix("+ "), *sign > 0.0)
                else {
                    return Err("a quotient of what is negative".to_owned());
                };
                let mut both =
                    one(&["n == 0"], format!("{name}[0] = each(|lane| ({value}).{function}());"))?;
                let slope = format!("&each(|lane| n as f64 * {slope})");
                let series = format!("[&mut *{name}, &mut *{name}_slope]");
                both.extend(one(
                    &["n > 0"],
                    format!("quotient({series}, {slope}, {}, n);", self.name(*over)),
                )?);
                Ok(both)
            }
            other => Err(format!("no kernel for {other:?}")),
        }
    }

    /// A sum: the terms that are always there, numbers, and those that need a flag.
    fn sum(&self, place: usize, terms: &[(usize, usize)]) -> Result<Vec<Statement>, String> {
        if self.ahead.contains(&place) {
            return Err(format!("a sum cannot stand beside a state: `{}`", self.name(place)));
        }
        let name = self.name(place);
        let own = self.flags.get(&place).copied().flatten();
        let flag = |term: &(usize, usize)| self.switch(*term).filter(|flag| Some(*flag) != own);
        let (numbers, changing): (Vec<_>, Vec<_>) =
            terms.iter().copied().partition(|(_, place)| self.tape.is_number(*place));
        let (always, sometimes): (Vec<_>, Vec<_>) =
            changing.into_iter().partition(|term| flag(term).is_none());
        // It grows in a variable of its own, and is stored once.
        let is_local = self.local.contains(&place);
        let sum = if is_local { name.clone() } else { format!("{name}_n") };
        let mut statements = vec![];
        let mut text = String::new();
        for (weight, term) in always {
            statements.extend(self.product_of(term)?);
            text = format!("{text} {}", self.term(Some(weight), term, "n")?);
        }
        let text = text.trim().trim_start_matches("+ ").replacen(
            "- ",
            "-",
            usize::from(text.starts_with(" -")),
        );
        let text =
            if text.is_empty() { "[0.0; L]".to_owned() } else { format!("each(|lane| {text})") };
        let conditions = self.conditions(place, &[]);
        let is_whole = numbers.is_empty() && sometimes.is_empty();
        statements.push(Statement {
            text: match (is_whole, is_local) {
                (true, false) => format!("{name}[n] = {text};"),
                (true, true) => format!("let {sum}: [f64; L] = {text};"),
                (false, _) => format!("let mut {sum}: [f64; L] = {text};"),
            },
            conditions: conditions.clone(),
        });
        for (weight, number) in numbers {
            let text = self.term(Some(weight), number, "0")?;
            statements.push(Statement {
                text: format!("{sum} = each(|lane| {sum}[lane] {text});"),
                conditions: self.conditions(place, &["n == 0"]),
            });
        }
        for term in sometimes {
            statements.extend(self.product_of(term.1)?);
            let text = self.term(Some(term.0), term.1, "n")?;
            let flag = flag(&term).into_iter().collect::<Vec<_>>();
            statements.push(Statement {
                text: format!("{sum} = each(|lane| {sum}[lane] {text});"),
                conditions: self.conditions(place, &flag),
            });
        }
        if !is_whole && !is_local {
            statements.push(Statement { text: format!("{name}[n] = {sum};"), conditions });
        }
        Ok(statements)
    }

    /// A product that is computed where it is added.
    fn product_of(&self, term: usize) -> Result<Vec<Statement>, String> {
        let place = self.scaled(term)?.place;
        match self.local.contains(&place) {
            true => self.statements(place, "n"),
            false => Ok(vec![]),
        }
    }

    /// What hands a rate back to its state.
    fn feed(&self, rate: &Rate) -> Result<Vec<Statement>, String> {
        let name = self.name(rate.state);
        let Scaled { is_negative, mut factors, place } = self.scaled(rate.rate)?;
        let sign = if is_negative { "-" } else { "" };
        let plain = |text: String| Statement { conditions: vec![], text };
        let of = self.name(place);
        let mut statements = vec![plain(match self.local.contains(&place) {
            true => {
                format!("let {of}_stretched = stretched_next(&stretch, {of}, &mut {of}_before);")
            }
            false => format!("let {of}_stretched = stretched(&stretch, {of}, n);"),
        })];
        let beside = match rate.beside {
            None => String::new(),
            Some(beside) => {
                let beside = self.term(None, beside, "n + 1")?;
                format!(
                    " - {}",
                    beside.strip_prefix("+ ").ok_or("what is negative beside a state")?
                )
            }
        };
        match self.slope_of(rate.state) {
            Some(slope) if beside.is_empty() => {
                let slope = self.name(slope);
                factors.extend(["inputs.unit[lane]".to_owned(), format!("{of}_stretched[lane]")]);
                statements.push(plain(format!(
                    "{slope}[n] = each(|lane| {sign}{});",
                    factors.join(" * ")
                )));
                statements.push(plain(format!(
                    "{name}[n + 1] = each(|lane| INVERSE[n + 1] * {slope}[n][lane]);"
                )));
            }
            Some(_) => return Err("a slope of what has something beside it".to_owned()),
            None => {
                factors.extend(["factor[lane]".to_owned(), format!("{of}_stretched[lane]")]);
                statements.push(plain(format!(
                    "{name}[n + 1] = each(|lane| {sign}{}{beside});",
                    factors.join(" * ")
                )));
            }
        }
        Ok(statements)
    }

    /// The places that are computed, in their order.
    fn places(&self) -> impl Iterator<Item = usize> {
        self.flags.keys().copied().filter(|place| !self.is_state(*place))
    }

    /// What is there before the first step of the recurrences: where states and parts begin.
    fn before(&self) -> Result<Vec<Statement>, String> {
        let plain = |text: String| Statement { conditions: vec![], text };
        let mut before = vec![];
        for (place, [state, _, start]) in self.equations.states.iter().enumerate() {
            before.push(plain(format!("{state}[0] = {start};")));
            if self.tape.degree(place) == 1 {
                before.push(plain(format!("time({state}, &inputs.unit, &stretch);")));
            }
        }
        for [part, start] in self.equations.starts {
            let place = self.names.iter().find(|(_, name)| name == part);
            let (place, _) = place.ok_or_else(|| format!("no part: {part}"))?;
            before.push(Statement {
                conditions: self.conditions(*place, &[]),
                text: format!("{part}[0] = {start};"),
            });
        }
        // A slope has no coefficient of order zero.
        let has_value = |place: &usize| !matches!(self.tape.operation(*place), Operation::Slope(_));
        for place in self.places().filter(|place| self.ahead.contains(place)).filter(has_value) {
            before.extend(self.statements(place, "0")?);
        }
        Ok(before)
    }

    /// A step of the recurrences: states whose rates are states, what is needed of them one order
    /// ahead, everything else, the other states.
    fn step(&self) -> Result<Vec<Statement>, String> {
        let (mut step, mut last) = (vec![], vec![]);
        for rate in self.rates.iter().filter(|rate| self.tape.degree(rate.state) != 1) {
            let list = match self.is_state(self.scaled(rate.rate)?.place) {
                true => &mut step,
                false => &mut last,
            };
            list.extend(self.feed(rate)?);
        }
        for place in self.places().filter(|place| self.ahead.contains(place)) {
            step.extend(self.statements(place, "n + 1")?);
        }
        let is_product =
            |place: usize| matches!(self.tape.operation(place), Operation::Multiply(..));
        for place in self.places().filter(|place| !self.ahead.contains(place)) {
            // That of a sum stands with the sum.
            if !(is_product(place) && self.local.contains(&place)) {
                step.extend(self.statements(place, "n")?);
            }
        }
        step.extend(last);
        Ok(step)
    }

    /// The names of all series and of what is known ahead of them.
    fn bindings(&self) -> String {
        let (mut scratch, mut ahead, mut ahead_of_waves, mut rates) =
            (vec![], vec![], vec![], String::new());
        let is_series = |place: &usize| self.stored.contains(place) && !self.tape.is_number(*place);
        for place in self.places().filter(is_series) {
            let name = self.name(place);
            match self.tape.operation(place) {
                Operation::Multiply(..) => ahead.push(format!("{name}_ahead")),
                Operation::Waves { degree, .. } if *degree > 1 => {
                    ahead_of_waves.push(format!("{name}_ahead"))
                }
                Operation::Quotient { .. } => scratch.push(format!("{name}_slope")),
                Operation::Sum(_) if self.local.contains(&place) => {
                    rates += &format!("let mut {name}_before = [[0.0; L]; 2];\n");
                }
                _ => {}
            }
            if !self.local.contains(&place) {
                scratch.push(name);
            }
        }
        let states = self.equations.states.iter();
        let states: String =
            states.map(|[state, field, _]| format!("{field}: {state}, ")).collect();
        let lists = [("scratch", scratch), ("ahead", ahead), ("ahead_of_waves", ahead_of_waves)];
        let lists = lists.map(|(all, names)| format!("let [{}, ..] = {all};\n", names.join(", ")));
        format!(
            "let Coefficients {{ {states}scratch, ahead, ahead_of_waves }} = series;\n{}{rates}",
            lists.concat()
        )
    }

    fn function(&self) -> Result<String, String> {
        let Equations { name, about, lines, stretch, .. } = self.equations;
        let lines: String = lines.iter().map(|line| format!("/// {line}\n")).collect();
        Ok(format!(
            "/// {about}
///
/// ```text
{lines}/// ```
#[inline(always)]
pub(super) fn {name}<const L: usize>(inputs: &Inputs<L>, order: usize, terms: Terms, series: &mut Coefficients<L>) {{
let order = order.min(HIGHEST_ORDER);
let stretch = {stretch}(inputs);
{bindings}{before}for n in 0..order {{
let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
{step}}}
}}
",
            bindings = self.bindings(),
            before = block(&self.before()?, 0),
            step = block(&self.step()?, 0),
        ))
    }
}

/// The factor that is known first comes first: its kernel reads the last coefficient of the other
/// one first.
fn earlier_first([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Statements under their conditions, each condition once as long as it holds.
fn block(statements: &[Statement], depth: usize) -> String {
    let first = |statement: &Statement| statement.conditions.get(depth).cloned();
    let mut out = String::new();
    for run in statements.chunk_by(|one, other| first(one) == first(other)) {
        let shared = |depth: &usize| {
            run.iter().all(|own| own.conditions.get(*depth) == run[0].conditions.get(*depth))
        };
        let end = (depth..run[0].conditions.len()).take_while(shared).count() + depth;
        match &run[0].conditions[depth..end] {
            [] => out += &run.iter().map(|own| own.text.clone() + "\n").collect::<String>(),
            conditions => {
                out += &format!("if {} {{\n{}}}\n", conditions.join(" && "), block(run, end))
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const PENDULUM: Equations = Equations {
        name: "pendulum",
        about: "A pendulum.",
        lines: &["x' = v", "sine = sin(x)", "cosine = cos(x)", "v' = -sine - damping*v^3"],
        states: &[["x", "place", "inputs.place"], ["v", "velocity", "inputs.velocity"]],
        starts: &[["sine", "inputs.sine"], ["cosine", "inputs.cosine"]],
        parameters: &[["damping", "inputs.damping[lane]"]],
        switches: &[["damping", "terms.damped"]],
        stretch: "in_flight",
    };

    /// Each part once, in its order, and only what a switch leaves on.
    #[test]
    fn a_pendulum_is_written_out() {
        let source = PENDULUM.to_rust().expect("a pendulum");
        let (_, written) = source.split_once("for n in 0..order {\n").expect("a loop");
        assert_eq!(
            written,
            "let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
let v_stretched = stretched(&stretch, v, n);
x_slope[n] = each(|lane| inputs.unit[lane] * v_stretched[lane]);
x[n + 1] = each(|lane| INVERSE[n + 1] * x_slope[n][lane]);
if n > 0 {
sine_and_cosine([&mut *sine, &mut *cosine], x_slope, n, sine_ahead);
}
if terms.damped {
v_squared[n] = square(v, n, v_squared_ahead);
}
let mut v_rate: [f64; L] = each(|lane| -sine[n][lane]);
if terms.damped {
let v_v_squared = product(v, v_squared, n, v_v_squared_ahead);
v_rate = each(|lane| v_rate[lane] - inputs.damping[lane] * v_v_squared[lane]);
}
let v_rate_stretched = stretched_next(&stretch, v_rate, &mut v_rate_before);
v[n + 1] = each(|lane| factor[lane] * v_rate_stretched[lane]);
}
}
"
        );
    }

    /// What there is no kernel for, no state and no equation is said to be so.
    #[test]
    fn what_cannot_be_written_is_refused() {
        for (line, reason) in [
            ("v' = exp(x)", "no kernel"),
            ("v' = sinh(x)", "hyperbolic"),
            ("v' = q*x", "`q` is neither a variable nor a number"),
            ("w' = x", "no state: w' = x"),
            ("v", "no equation: v"),
            ("(v + sine)' = x", "`sine` cannot stand beside a state"),
            ("(v + (1 + x)^2)' = x", "a sum cannot stand beside a state"),
        ] {
            let lines: &'static [&'static str] =
                Box::leak(Box::new(["x' = v", "sine = sin(x)", "cosine = cos(x)", line]));
            let refused = Equations { lines, ..PENDULUM }.to_rust();
            assert!(
                refused.as_ref().is_err_and(|error| error.contains(reason)),
                "{line}: {refused:?}"
            );
        }
        let phase = Equations {
            lines: &["x' = v", "t' = 1", "sine = sin(1 + t)", "cosine = cos(1 + t)", "v' = -sine"],
            states: &[
                ["x", "place", "inputs.place"],
                ["v", "velocity", "inputs.velocity"],
                ["t", "time", "[0.0; L]"],
            ],
            ..PENDULUM
        };
        let refused = phase.to_rust();
        assert!(
            refused.as_ref().is_err_and(|error| error.contains("no multiple of the time")),
            "{refused:?}"
        );
    }
}
