//! A list of operations where some of its arguments have values: what depends on these alone is computed
//! once.

use super::{Instruction, InstructionList};

impl InstructionList {
    /// The operations that these results still need where the arguments from one on have these values, and
    /// the new places of the results.
    pub(super) fn specialised(
        &self,
        results: &[usize],
        first: usize,
        given: &[f64],
    ) -> (Self, Vec<usize>) {
        let size = self.size();
        let begin = self.argument_count + self.constants.len();
        let operations = || (begin..size).zip(&self.instructions);
        let mut known: Vec<Option<f64>> = vec![None; size];
        let mut values = vec![0.0; size];
        let own = (self.argument_count..).zip(&self.constants);
        for (place, value) in (first..self.argument_count).zip(given).chain(own) {
            (values[place], known[place]) = (*value, Some(*value));
        }
        for (place, instruction) in operations() {
            let [a, b] = instruction.operands().map(|operand| known[operand]);
            let is_closed = matches!(instruction, Instruction::Gate(..)) && a == Some(0.0);
            if a.is_some() && (b.is_some() || is_closed) {
                values[place] = instruction.value(&values);
                known[place] = Some(values[place]);
            }
        }
        let mut is_read = vec![false; size];
        results.iter().for_each(|place| is_read[*place] = true);
        for (place, instruction) in operations().rev() {
            if is_read[place] && known[place].is_none() {
                instruction.operands().into_iter().for_each(|operand| is_read[operand] = true);
            }
        }
        let mut places: Vec<usize> = (0..size).collect();
        let mut constants = Vec::new();
        for place in (0..size).filter(|place| is_read[*place]) {
            if let Some(value) = known[place] {
                places[place] = self.argument_count + constants.len();
                constants.push(value);
            }
        }
        let mut instructions = Vec::new();
        for (place, instruction) in operations() {
            if is_read[place] && known[place].is_none() {
                places[place] = self.argument_count + constants.len() + instructions.len();
                instructions.push(instruction.at(|operand| places[operand]));
            }
        }
        let results = results.iter().map(|place| places[*place]).collect();
        (Self { argument_count: self.argument_count, constants, instructions }, results)
    }
}

impl Instruction {
    /// This operation with its operands at other places.
    fn at(&self, place: impl Fn(usize) -> usize) -> Self {
        match *self {
            Self::Add(a, b) => Self::Add(place(a), place(b)),
            Self::Subtract(a, b) => Self::Subtract(place(a), place(b)),
            Self::Multiply(a, b) => Self::Multiply(place(a), place(b)),
            Self::Divide(a, b) => Self::Divide(place(a), place(b)),
            Self::Gate(a, b) => Self::Gate(place(a), place(b)),
            Self::IntegerPower(a, exponent) => Self::IntegerPower(place(a), exponent),
            Self::SquareRoot(a) => Self::SquareRoot(place(a)),
            Self::OddRoot(a, b, odd) => Self::OddRoot(place(a), place(b), odd),
            Self::Power(a, b) => Self::Power(place(a), place(b)),
            Self::Unary(function, a) => Self::Unary(function, place(a)),
            Self::Binary(function, a, b) => Self::Binary(function, place(a), place(b)),
        }
    }
}
