//! Lists of operations with memory of their own, for integrators, which call one list millions of times.
//!
//! A short list has all its values in 256 places, so that an operation is four bytes and a place is one of
//! them: no place has to be compared with the length of the memory. A product that is used once, in a sum,
//! is computed with it; it is rounded before it is added, so that every value is bit for bit that of the
//! list.

use super::{CompiledList, Instruction, InstructionList, gate, integer_power, odd_root};

/// Number of places of a short list.
const PLACES: usize = 256;

/// A [`CompiledList`] with memory for its values.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{CompiledList, PreparedList, parse_expression};
/// let texts = ["x - x^3/7 + sin(y)*y", "x*y"].map(|text| parse_expression(text).expect("a text"));
/// let list = CompiledList::new(&texts, &["x".into(), "y".into()])?;
/// let mut prepared = PreparedList::new(&list);
/// prepared.call(&[0.3, 0.7]);
/// let mut values = [0.0; 2];
/// list.call(&[0.3, 0.7], &mut vec![], &mut values);
/// assert_eq!([prepared.value(0), prepared.value(1)], values);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PreparedList(Program);

#[derive(Clone, Debug)]
enum Program {
    Short(Box<ShortProgram>),
    Long { list: InstructionList, results: Vec<usize>, values: Vec<f64> },
}

#[derive(Clone, Debug)]
struct ShortProgram {
    argument_count: usize,
    /// The place of the first result of an operation.
    first: u8,
    operations: Vec<ShortOperation>,
    functions: Vec<fn(f64) -> f64>,
    functions_of_two: Vec<fn(f64, f64) -> f64>,
    results: Vec<u8>,
    constants: Vec<f64>,
    values: [f64; PLACES],
}

/// An operation on the values at two places, and at a third one or with a number or a function.
#[derive(Clone, Copy, Debug)]
struct ShortOperation {
    kind: Kind,
    first: u8,
    second: u8,
    third: u8,
}

/// The kinds of operations; `a`, `b` and `c` are the values at the places.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Add,
    Subtract,
    Multiply,
    /// c + a b.
    AddProduct,
    /// c - a b.
    SubtractProduct,
    Divide,
    Gate,
    Square,
    Cube,
    /// a to a whole power, the number in place of `b`.
    IntegerPower,
    SquareRoot,
    OddRoot,
    EvenRoot,
    Power,
    /// The function of this number in place of `b`.
    Unary,
    /// The function of this number in place of `c`.
    Binary,
}

impl PreparedList {
    /// Prepares a list.
    pub fn new(list: &CompiledList) -> Self {
        let CompiledList { list, results } = list;
        Self(match ShortProgram::new(list, results) {
            Some(program) => Program::Short(Box::new(program)),
            None => Program::Long {
                list: list.clone(),
                results: results.clone(),
                values: vec![0.0; list.size()],
            },
        })
    }

    /// Computes all values at these arguments; they are NaN if the number of arguments is not that of the
    /// symbols.
    pub fn call(&mut self, arguments: &[f64]) {
        match &mut self.0 {
            Program::Short(program) => program.call(arguments),
            Program::Long { list, values, .. } if arguments.len() == list.argument_count => {
                list.run(arguments, values);
            }
            Program::Long { values, .. } => values.fill(f64::NAN),
        }
    }

    /// The value of the expression of an index, as the last call has left it; NaN beyond the last one.
    #[inline]
    pub fn value(&self, index: usize) -> f64 {
        match &self.0 {
            Program::Short(program) => {
                program.results.get(index).map_or(f64::NAN, |place| program.values[*place as usize])
            }
            Program::Long { results, values, .. } => {
                results.get(index).map_or(f64::NAN, |place| values[*place])
            }
        }
    }
}

impl ShortProgram {
    /// The operations of a list in a few bytes each; `None` if the list is not short.
    fn new(list: &InstructionList, results: &[usize]) -> Option<Self> {
        let begin = list.argument_count + list.constants.len();
        let mut uses = vec![0_usize; list.size()];
        results.iter().for_each(|place| uses[*place] += 1);
        for instruction in &list.instructions {
            let [a, b] = instruction.operands();
            uses[a] += 1;
            if !instruction.has_one_operand() {
                uses[b] += 1;
            }
        }
        let product = |place: usize| match list.instructions.get(place.checked_sub(begin)?)? {
            Instruction::Multiply(a, b) if uses[place] == 1 => Some([*a, *b]),
            _ => None,
        };
        // The products that are computed with the sum in which they stand.
        let mut is_joined = vec![false; list.size()];
        for instruction in &list.instructions {
            if let Some(place) = instruction.joined(|place| product(place).is_some()) {
                is_joined[place] = true;
            }
        }
        let mut places = vec![0_u8; list.size()];
        for (own, place) in (0..list.size()).filter(|place| !is_joined[*place]).enumerate() {
            places[place] = u8::try_from(own).ok()?;
        }
        let mut program = Self {
            argument_count: list.argument_count,
            first: u8::try_from(begin).ok()?,
            operations: Vec::with_capacity(list.instructions.len()),
            functions: vec![],
            functions_of_two: vec![],
            results: results.iter().map(|place| places[*place]).collect(),
            constants: list.constants.clone(),
            values: [0.0; PLACES],
        };
        program.set_constants();
        for (place, instruction) in (begin..).zip(&list.instructions) {
            if is_joined[place] {
                continue;
            }
            let joined = instruction.joined(|place| is_joined[place]);
            let factors = joined.and_then(|joined| Some((joined, product(joined)?)));
            let operation = match factors {
                Some((joined, [a, b])) => {
                    let [first, second] = instruction.operands();
                    let other = if first == joined { second } else { first };
                    let kind = match instruction {
                        Instruction::Subtract(..) => Kind::SubtractProduct,
                        _ => Kind::AddProduct,
                    };
                    ShortOperation {
                        kind,
                        first: places[a],
                        second: places[b],
                        third: places[other],
                    }
                }
                None => program.operation(instruction, &places)?,
            };
            program.operations.push(operation);
        }
        Some(program)
    }

    /// An operation with its operands at these places; its function is added to those known.
    fn operation(&mut self, instruction: &Instruction, places: &[u8]) -> Option<ShortOperation> {
        let [a, b] = instruction.operands().map(|place| places[place]);
        let (kind, second, third) = match *instruction {
            Instruction::Add(..) => (Kind::Add, b, 0),
            Instruction::Subtract(..) => (Kind::Subtract, b, 0),
            Instruction::Multiply(..) => (Kind::Multiply, b, 0),
            Instruction::Divide(..) => (Kind::Divide, b, 0),
            Instruction::Gate(..) => (Kind::Gate, b, 0),
            Instruction::IntegerPower(_, 2) => (Kind::Square, 0, 0),
            Instruction::IntegerPower(_, 3) => (Kind::Cube, 0, 0),
            Instruction::IntegerPower(_, exponent) => {
                (Kind::IntegerPower, u8::try_from(exponent).ok()?, 0)
            }
            Instruction::SquareRoot(_) => (Kind::SquareRoot, 0, 0),
            Instruction::OddRoot(_, _, true) => (Kind::OddRoot, b, 0),
            Instruction::OddRoot(_, _, false) => (Kind::EvenRoot, b, 0),
            Instruction::Power(..) => (Kind::Power, b, 0),
            Instruction::Unary(function, _) => {
                self.functions.push(function);
                (Kind::Unary, u8::try_from(self.functions.len() - 1).ok()?, 0)
            }
            Instruction::Binary(function, ..) => {
                self.functions_of_two.push(function);
                (Kind::Binary, b, u8::try_from(self.functions_of_two.len() - 1).ok()?)
            }
        };
        Some(ShortOperation { kind, first: a, second, third })
    }

    /// Writes the constants, which calls leave as they are.
    fn set_constants(&mut self) {
        let places = self.values.iter_mut().skip(self.argument_count);
        places.zip(&self.constants).for_each(|(value, constant)| *value = *constant);
    }

    /// Computes all values at these arguments, as [`PreparedList::call`].
    #[inline]
    fn call(&mut self, arguments: &[f64]) {
        if arguments.len() != self.argument_count {
            self.values.fill(f64::NAN);
            return;
        }
        // After a call with another number of arguments nothing is known.
        if !self.constants.is_empty() && self.values[self.argument_count].is_nan() {
            self.set_constants();
        }
        for (value, argument) in self.values.iter_mut().zip(arguments) {
            *value = *argument;
        }
        self.run();
    }

    /// Computes the result of every operation.
    fn run(&mut self) {
        let values = &mut self.values;
        let mut place = self.first;
        for ShortOperation { kind, first, second, third } in &self.operations {
            let a = values[*first as usize];
            let b = values[*second as usize];
            let value = match kind {
                Kind::Add => a + b,
                Kind::Subtract => a - b,
                Kind::Multiply => a * b,
                Kind::AddProduct => values[*third as usize] + a * b,
                Kind::SubtractProduct => values[*third as usize] - a * b,
                Kind::Divide => a / b,
                Kind::Gate => gate(a, b),
                Kind::Square => a * a,
                Kind::Cube => a * (a * a),
                Kind::IntegerPower => integer_power(a, u32::from(*second)),
                Kind::SquareRoot => a.sqrt(),
                Kind::OddRoot => odd_root(a, b, true),
                Kind::EvenRoot => odd_root(a, b, false),
                Kind::Power => a.powf(b),
                Kind::Unary => self.functions[*second as usize](a),
                Kind::Binary => self.functions_of_two[*third as usize](a, b),
            };
            values[place as usize] = value;
            place = place.wrapping_add(1);
        }
    }
}

impl Instruction {
    /// Whether there is a single operand.
    fn has_one_operand(&self) -> bool {
        matches!(self, Self::IntegerPower(..) | Self::SquareRoot(_) | Self::Unary(..))
    }

    /// The operand of a sum, or of a difference what is taken away, that is a product to be computed with it.
    fn joined(&self, is_product: impl Fn(usize) -> bool) -> Option<usize> {
        let operands = match *self {
            Self::Add(a, b) => [Some(b), Some(a)],
            Self::Subtract(_, b) => [Some(b), None],
            _ => [None; 2],
        };
        operands.into_iter().flatten().find(|place| is_product(*place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Expr;

    /// Every kind of operation, of few and of very many values, beside the list itself.
    #[test]
    fn a_prepared_list_has_the_values_of_its_list_to_the_last_bit() {
        let texts = [
            "x*y + x^2*y - 3*x*y^3",
            "x - y/3",
            "sin(x)*cos(y) - exp(x)/(1 + y^2)",
            "sqrt(x) + x^(3/2) + y^(2/3) + y^(1/3) + y^(5/7) + x^y",
            "H(x)*y + sgn(y)*x^7",
            "max(x, y) - atan(y) + x^11/(2 - y)",
            "x*y - x*y^2",
            "4",
            "x",
        ];
        let mut all: Vec<Expr> = texts.iter().map(|text| text.parse().expect(text)).collect();
        let names = ["x".into(), "y".into()];
        for count in [0, 300] {
            let many = (0..count).map(|index| format!("sin({index}*x)*y + {index}/7 - x*y"));
            all.extend(many.map(|text| text.parse::<Expr>().expect("a sum")));
            let list = CompiledList::new(&all, &names).expect("a list");
            let mut prepared = PreparedList::new(&list);
            assert_eq!(matches!(prepared.0, Program::Short(_)), count == 0);
            let mut values = vec![0.0; all.len()];
            for at in [[0.3, 0.7], [1.9, -0.4], [-2.1, 1e-3], [0.0, 0.0], [1e200, -1e200]] {
                list.call(&at, &mut vec![], &mut values);
                prepared.call(&at);
                for (index, value) in values.iter().enumerate() {
                    let own = prepared.value(index);
                    let is_same =
                        own.to_bits() == value.to_bits() || own.is_nan() && value.is_nan();
                    assert!(is_same, "{} at {at:?}: {own} {value}", all[index]);
                }
            }
            prepared.call(&[0.3]);
            assert!(prepared.value(0).is_nan() && prepared.value(all.len()).is_nan());
            prepared.call(&[0.3, 0.7]);
            assert!(prepared.value(0).is_finite());
        }
    }
}
