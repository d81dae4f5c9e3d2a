//! Functions at many places at once, as a balance of harmonics needs them: each operation is done
//! at all places before the next one, and what depends on fixed arguments alone is done once, such as
//! a drive at the phases of its period.

use super::{CompiledFunctions, Instruction, gate, integer_power, odd_root};

/// The functions of [`CompiledFunctions`] at a number of places, at which some arguments are fixed.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{CompiledFunctions, SampledFunctions, parse_expression};
/// let force = parse_expression("x^3 - cos(theta)").expect("a text");
/// let force = CompiledFunctions::new([&force], &["x".into(), "theta".into()])?;
/// let sampled = SampledFunctions::new(force, 2, &[(1, &[0.0, 0.5])]);
/// let mut values = vec![];
/// sampled.call(&[(0, &[2.0, 3.0])], &mut values);
/// assert_eq!(sampled.column(0, &values), [7.0, 27.0 - 0.5_f64.cos()]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SampledFunctions<const N: usize> {
    functions: CompiledFunctions<N>,
    places: usize,
    /// For each place of the list of operations that of its column.
    columns: Vec<ColumnPlace>,
    /// The columns that never change, one behind the other.
    fixed: Vec<f64>,
    /// The indices of the operations whose values change, in order.
    moving: Vec<usize>,
    /// The number of columns that change.
    moving_columns: usize,
}

/// The first place of the column of a value, among those that never change or among the others.
#[derive(Clone, Copy, Debug)]
enum ColumnPlace {
    Fixed(usize),
    Moving(usize),
}

impl<const N: usize> SampledFunctions<N> {
    /// Prepares functions at this many places; `fixed` has the values at all of them of arguments,
    /// by index, that never change.
    pub fn new(functions: CompiledFunctions<N>, places: usize, fixed: &[(usize, &[f64])]) -> Self {
        let list = &functions.list;
        let mut sampled = Self {
            places,
            columns: Vec::with_capacity(list.size()),
            fixed: vec![],
            moving: vec![],
            moving_columns: 0,
            functions: functions.clone(),
        };
        for argument in 0..list.argument_count {
            match fixed.iter().find(|(index, _)| *index == argument) {
                Some((_, values)) => sampled.add_fixed(values),
                None => sampled.add_moving(),
            }
        }
        for constant in &list.constants {
            sampled.add_fixed(&vec![*constant; places]);
        }
        for (index, instruction) in list.instructions.iter().enumerate() {
            let operands = instruction.operands();
            let columns = operands.map(|place| sampled.columns[place]);
            match columns.iter().all(|column| matches!(column, ColumnPlace::Fixed(_))) {
                true => {
                    let mut values = vec![0.0; places];
                    instruction.run_columns(|place| sampled.values_at(place, &[]), &mut values);
                    sampled.add_fixed(&values);
                }
                false => {
                    sampled.moving.push(index);
                    sampled.add_moving();
                }
            }
        }
        sampled
    }

    fn add_fixed(&mut self, values: &[f64]) {
        self.columns.push(ColumnPlace::Fixed(self.fixed.len()));
        self.fixed
            .extend(values.iter().copied().chain(std::iter::repeat(f64::NAN)).take(self.places));
    }

    fn add_moving(&mut self) {
        self.columns.push(ColumnPlace::Moving(self.moving_columns * self.places));
        self.moving_columns += 1;
    }

    /// The column of a place of the list, of which `moving` has those that change.
    fn values_at<'a>(&'a self, place: usize, moving: &'a [f64]) -> &'a [f64] {
        match self.columns[place] {
            ColumnPlace::Fixed(first) => &self.fixed[first..][..self.places],
            ColumnPlace::Moving(first) => &moving[first..][..self.places],
        }
    }

    /// Computes all functions at all places, from the columns of the arguments that are not fixed, by
    /// index; `values` is memory for [`SampledFunctions::column`]. An argument without a column is
    /// not a number.
    pub fn call(&self, arguments: &[(usize, &[f64])], values: &mut Vec<f64>) {
        values.clear();
        values.resize(self.moving_columns * self.places, f64::NAN);
        for (argument, given) in arguments {
            if let Some(ColumnPlace::Moving(first)) = self.columns.get(*argument) {
                let column = values[*first..][..self.places].iter_mut();
                column.zip(*given).for_each(|(value, given)| *value = *given);
            }
        }
        let list = &self.functions.list;
        let begin = list.argument_count + list.constants.len();
        for index in &self.moving {
            if let ColumnPlace::Moving(first) = self.columns[begin + index] {
                let (before, after) = values.split_at_mut(first);
                let column = |place: usize| self.values_at(place, before);
                list.instructions[*index].run_columns(column, &mut after[..self.places]);
            }
        }
    }

    /// The values of one of the functions at all places, of the memory that a call has filled.
    pub fn column<'a>(&'a self, function: usize, values: &'a [f64]) -> &'a [f64] {
        self.values_at(self.functions.results[function], values)
    }
}

impl Instruction {
    /// Computes the result at all places, from the columns of the operands.
    fn run_columns<'a>(&self, column: impl Fn(usize) -> &'a [f64], results: &mut [f64]) {
        let of_one = |results: &mut [f64], a: usize, function: &dyn Fn(f64) -> f64| {
            results.iter_mut().zip(column(a)).for_each(|(result, a)| *result = function(*a));
        };
        match *self {
            Self::Add(a, b) => of_two(results, column(a), column(b), |a, b| a + b),
            Self::Subtract(a, b) => of_two(results, column(a), column(b), |a, b| a - b),
            Self::Multiply(a, b) => of_two(results, column(a), column(b), |a, b| a * b),
            Self::Divide(a, b) => of_two(results, column(a), column(b), |a, b| a / b),
            Self::Gate(a, b) => of_two(results, column(a), column(b), gate),
            Self::OddRoot(a, b, odd) => {
                of_two(results, column(a), column(b), |a, b| odd_root(a, b, odd));
            }
            Self::Power(a, b) => of_two(results, column(a), column(b), f64::powf),
            Self::Binary(function, a, b) => of_two(results, column(a), column(b), function),
            Self::IntegerPower(a, 2) => of_two(results, column(a), column(a), |a, b| a * b),
            Self::IntegerPower(a, exponent) => {
                of_one(results, a, &|a| integer_power(a, exponent));
            }
            Self::SquareRoot(a) => of_one(results, a, &f64::sqrt),
            Self::Unary(function, a) => of_one(results, a, &function),
        }
    }
}

fn of_two(results: &mut [f64], a: &[f64], b: &[f64], function: impl Fn(f64, f64) -> f64) {
    let operands = a.iter().zip(b);
    results.iter_mut().zip(operands).for_each(|(result, (a, b))| *result = function(*a, *b));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    /// Every operation of the list, bit for bit what a call at each place gives, with any arguments
    /// fixed.
    #[test]
    fn every_column_has_the_values_of_single_calls() {
        let texts = [
            "x^3*cos(theta) + p*sqrt(abs(x))/(2 + y) - max(x, y)",
            "(x - p)^(3/2)*H(x - p) + sgn(y)*x^(1/3) + exp(theta)^y",
            "x^5 - cos(theta)*p",
            "3",
        ];
        let expressions = texts.map(|text| parse_expression(text).expect("an expression"));
        let names = ["x", "y", "theta", "p"].map(Into::into);
        let [a, b, c, d] = &expressions;
        let functions = CompiledFunctions::new([a, b, c, d], &names).expect("functions");
        let column = |from: f64, step: f64| -> Vec<f64> {
            (0..9).map(|index| from + step * f64::from(index)).collect()
        };
        let all = [column(-1.0, 0.3), column(1.2, -0.2), column(0.0, 0.7), column(0.4, 0.0)];
        for fixed in 0..16 {
            let with = |is_fixed: bool| -> Vec<(usize, &[f64])> {
                let chosen = (0..4).filter(|index| (fixed >> index & 1 == 1) == is_fixed);
                chosen.map(|index| (index, all[index].as_slice())).collect()
            };
            let sampled = SampledFunctions::new(functions.clone(), 9, &with(true));
            let mut values = vec![];
            for _ in 0..2 {
                sampled.call(&with(false), &mut values);
                for place in 0..9 {
                    let single = functions.call(&all.each_ref().map(|column| column[place]));
                    for (index, single) in single.into_iter().enumerate() {
                        let found = sampled.column(index, &values)[place];
                        assert_eq!(found.to_bits(), single.to_bits(), "{index} at {place}");
                    }
                }
            }
        }
    }
}
