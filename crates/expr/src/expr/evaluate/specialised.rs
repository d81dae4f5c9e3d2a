//! A list of operations where some of its arguments have values: what depends on these alone is computed
//! once, a division by such a number is a product with its reciprocal, and several such factors are one.

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
        let (rewritten, factors) = self.with_joined_factors(&known);
        let operations = || (begin..size).zip(&rewritten);
        known.extend(factors.into_iter().map(Some));
        let size = known.len();
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

    /// The operations where the values at some places are known: a division by a known number, and a product
    /// of several with one other value, is a product with one number. These numbers are at the places behind
    /// all others.
    fn with_joined_factors(&self, known: &[Option<f64>]) -> (Vec<Instruction>, Vec<f64>) {
        let (size, begin) = (self.size(), self.argument_count + self.constants.len());
        let mut factors: Vec<f64> = Vec::new();
        // The value and the number of which a place is the product.
        let mut scaled: Vec<Option<(usize, f64)>> = vec![None; size];
        let rewritten = (begin..size).zip(&self.instructions).map(|(place, instruction)| {
            let (value, factor) = match *instruction {
                _ if known[place].is_some() => return *instruction,
                Instruction::Divide(a, b) => (a, known[b].map(f64::recip)),
                Instruction::Multiply(a, b) if known[a].is_some() => (b, known[a]),
                Instruction::Multiply(a, b) => (a, known[b]),
                _ => return *instruction,
            };
            let own = factor.map(|factor| (value, factor));
            let inner = own.and_then(|(value, factor)| {
                let (inner, other) = scaled[value]?;
                Some((inner, other * factor))
            });
            let mut all = [inner, own].into_iter().flatten();
            let Some((value, factor)) = all.find(|(_, factor)| factor.is_normal()) else {
                return *instruction;
            };
            scaled[place] = Some((value, factor));
            let index = factors.iter().position(|other| *other == factor).unwrap_or_else(|| {
                factors.push(factor);
                factors.len() - 1
            });
            Instruction::Multiply(value, size + index)
        });
        let rewritten = rewritten.collect();
        (rewritten, factors)
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

#[cfg(test)]
mod tests {
    use crate::expr::{CompiledList, Expr};

    /// x/k, and 3 (x/k)/(7 k), are products of x with one number each.
    #[test]
    fn factors_that_are_known_are_one_product() {
        let texts = ["x/k", "(x/k + 0*k)*3/(7*k)", "sin(x)/k^2"];
        let all = texts.map(|text| text.parse::<Expr>().expect(text));
        let list = CompiledList::new(&all, &["x".into(), "k".into()]).expect("a list");
        let known = list.specialised(|_| true, 1, &[0.3]);
        assert_eq!(known.list.instructions.len(), 4, "{known:?}");
        let (mut values, mut own) = ([0.0; 3], [0.0; 3]);
        for x in [0.7, -1e-3, 1e200] {
            list.call(&[x, 0.3], &mut vec![], &mut values);
            known.call(&[x, f64::NAN], &mut vec![], &mut own);
            for (value, own) in values.iter().zip(own) {
                assert!((value - own).abs() <= 4.0 * f64::EPSILON * value.abs(), "{value} {own}");
            }
        }
    }
}
