//! Rates of states and of their variations, counted in the sizes of the states, as integrators ask for
//! them: at one value of the parameter, and on one side of all surfaces.
//!
//! ```text
//! x_i = y_i/d_i:    x_i' = f_i/d_i,    Z_i' = sum_j f_ij d_j/d_i Z_j,    z_i' = ... + u f_ip/d_i      u: the unit of the variations
//! ```
//!
//! What depends on the parameter and the sides alone is computed once.

use std::cell::RefCell;

use super::surfaces::Table;
use crate::expr::PreparedList;

/// The rates of a motion, with those of its variations if they are followed.
#[derive(Clone, Debug)]
pub(super) struct ScaledRates {
    states: usize,
    alone: RowList,
    varied: Option<RowList>,
}

/// Compiled entries of a matrix, row by row.
#[derive(Clone, Debug)]
struct RowList {
    values: RefCell<PreparedList>,
    rows: Vec<Row>,
    slopes: Vec<Slope>,
}

/// The rate of a state and of its variations.
#[derive(Clone, Debug)]
struct Row {
    state: usize,
    /// The reciprocal of the size of the state.
    factor: f64,
    /// The index of the value of the rate.
    rate: Option<usize>,
    /// The derivatives by the states: the first and the one behind the last.
    slopes: [usize; 2],
    /// The index of the derivative by the parameter, and the unit of the variations over the size of the state.
    by_parameter: Option<(usize, f64)>,
}

/// The factor of the variations of a state in the rates of those of another one.
#[derive(Clone, Debug)]
struct Slope {
    /// The index of the value.
    value: usize,
    /// The place of these variations.
    variations: usize,
    /// The ratio of the sizes of both states.
    ratio: f64,
}

impl ScaledRates {
    /// The rates where the arguments behind the time have these values: of a table of f and, for
    /// variations in a unit, of one of f, f_y and f_p, in columns.
    pub(super) fn new(
        rates: &Table,
        varied: Option<(&Table, f64)>,
        behind_time: &[f64],
        sizes: &[f64],
    ) -> Self {
        let n = rates.rows();
        let list = |table: &Table, unit: f64| -> RowList {
            let (places, values) = table.specialised(n + 2, n + 1, behind_time);
            let (mut rows, mut slopes) = (Vec::with_capacity(n), Vec::with_capacity(places.len()));
            for state in 0..n {
                let own = |(value, (row, column)): (usize, &(usize, usize))| {
                    (*row == state).then_some((value, *column))
                };
                let entries = || places.iter().enumerate().filter_map(own);
                let of_column = |wanted: usize| {
                    entries().find(|(_, column)| *column == wanted).map(|(value, _)| value)
                };
                let first = slopes.len();
                slopes.extend(entries().filter(|(_, column)| (1..=n).contains(column)).map(
                    |(value, column)| Slope {
                        value,
                        variations: n + (column - 1) * (n + 1),
                        ratio: sizes[column - 1] / sizes[state],
                    },
                ));
                rows.push(Row {
                    state,
                    factor: sizes[state].recip(),
                    rate: of_column(0),
                    slopes: [first, slopes.len()],
                    by_parameter: of_column(n + 1).map(|value| (value, unit / sizes[state])),
                });
            }
            RowList { values: RefCell::new(PreparedList::new(&values)), rows, slopes }
        };
        Self {
            states: n,
            alone: list(rates, 1.0),
            varied: varied.map(|(table, unit)| list(table, unit)),
        }
    }

    /// These rates, without variations, in other sizes of the states.
    pub(super) fn in_sizes(mut self, sizes: &[f64]) -> Self {
        for row in &mut self.alone.rows {
            row.factor = sizes[row.state].recip();
        }
        self
    }

    /// Whether rates of so many values are those of the states alone.
    pub(super) fn are_alone(&self, values: usize) -> bool {
        values <= self.states
    }

    /// Writes the rates at these arguments, with those of the variations behind the states, if there are any.
    pub(super) fn write(&self, arguments: &[f64], scaled: &[f64], rates: &mut [f64]) {
        let list = match &self.varied {
            Some(varied) if !self.are_alone(scaled.len()) => varied,
            _ => &self.alone,
        };
        let values = &mut *list.values.borrow_mut();
        values.call(arguments);
        for row in &list.rows {
            rates[row.state] = row.rate.map_or(0.0, |rate| values.value(rate) * row.factor);
        }
        if self.are_alone(scaled.len()) {
            return;
        }
        // A few sums of a number that is known stay in registers.
        match self.states {
            1 => list.write_variations::<2>(values, scaled, rates),
            2 => list.write_variations::<3>(values, scaled, rates),
            3 => list.write_variations::<4>(values, scaled, rates),
            4 => list.write_variations::<5>(values, scaled, rates),
            5 => list.write_variations::<6>(values, scaled, rates),
            6 => list.write_variations::<7>(values, scaled, rates),
            7 => list.write_variations::<8>(values, scaled, rates),
            8 => list.write_variations::<9>(values, scaled, rates),
            states => {
                for row in &list.rows {
                    let first = states + row.state * (states + 1);
                    let sums = &mut rates[first..=first + states];
                    sums.fill(0.0);
                    for slope in &list.slopes[row.slopes[0]..row.slopes[1]] {
                        let factor = values.value(slope.value) * slope.ratio;
                        let changes = &scaled[slope.variations..];
                        for (sum, change) in sums.iter_mut().zip(changes) {
                            *sum += factor * change;
                        }
                    }
                    sums[states] += row.by_parameter(values);
                }
            }
        }
    }
}

impl Row {
    /// The part of the parameter in the rate of the variation by it.
    fn by_parameter(&self, values: &PreparedList) -> f64 {
        self.by_parameter.map_or(0.0, |(value, unit)| unit * values.value(value))
    }
}

impl RowList {
    /// Writes the rates of the variations of one state less than the width.
    fn write_variations<const WIDTH: usize>(
        &self,
        values: &PreparedList,
        scaled: &[f64],
        rates: &mut [f64],
    ) {
        let states = WIDTH - 1;
        for row in &self.rows {
            let mut sums = [0.0; WIDTH];
            for slope in &self.slopes[row.slopes[0]..row.slopes[1]] {
                let factor = values.value(slope.value) * slope.ratio;
                let changes = &scaled[slope.variations..][..WIDTH];
                for (sum, change) in sums.iter_mut().zip(changes) {
                    *sum += factor * change;
                }
            }
            sums[states] += row.by_parameter(values);
            rates[states + row.state * WIDTH..][..WIDTH].copy_from_slice(&sums);
        }
    }
}
