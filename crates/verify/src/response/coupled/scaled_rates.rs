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
use crate::expr::CompiledList;

/// The rates of a motion, with those of its variations if they are followed.
pub(super) struct ScaledRates {
    states: usize,
    alone: TermList,
    varied: Option<TermList>,
}

/// Compiled terms with the use of each.
struct TermList {
    values: CompiledList,
    terms: Vec<Term>,
    /// Memory for registers and values, which calls share.
    memory: RefCell<(Vec<f64>, Vec<f64>)>,
}

/// The use of a value.
enum Term {
    /// The rate of a state, over its size.
    Rate { state: usize, size: f64 },
    /// The factor of the variations from one index on, times a ratio of sizes, in the rates of those from
    /// another one on.
    Slope { rates: usize, variations: usize, ratio: f64 },
    /// The rate of one variation by the parameter, in the unit over the size.
    ByParameter { rate: usize, unit: f64, size: f64 },
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
        let list = |table: &Table, unit: f64| -> TermList {
            let term = |(row, column): (usize, usize)| match column {
                0 => Term::Rate { state: row, size: sizes[row] },
                column if column <= n => Term::Slope {
                    rates: n + row * (n + 1),
                    variations: n + (column - 1) * (n + 1),
                    ratio: sizes[column - 1] / sizes[row],
                },
                _ => Term::ByParameter { rate: n + row * (n + 1) + n, unit, size: sizes[row] },
            };
            let (places, values) = table.specialised(n + 2, n + 1, behind_time);
            let memory = RefCell::new((vec![], vec![0.0; places.len()]));
            TermList { values, terms: places.into_iter().map(term).collect(), memory }
        };
        Self {
            states: n,
            alone: list(rates, 1.0),
            varied: varied.map(|(table, unit)| list(table, unit)),
        }
    }

    /// Whether rates of so many values are those of the states alone.
    pub(super) fn are_alone(&self, values: usize) -> bool {
        values <= self.states
    }

    /// Writes the rates at these arguments, with those of the variations behind the states, if there are any.
    pub(super) fn write(&self, arguments: &[f64], scaled: &[f64], rates: &mut [f64]) {
        let width = self.states + 1;
        let list = match &self.varied {
            Some(varied) if !self.are_alone(scaled.len()) => varied,
            _ => &self.alone,
        };
        let (registers, values) = &mut *list.memory.borrow_mut();
        list.values.call(arguments, registers, values);
        rates.fill(0.0);
        for (term, value) in list.terms.iter().zip(values) {
            match *term {
                Term::Rate { state, size } => rates[state] = *value / size,
                Term::Slope { rates: to, variations, ratio } => {
                    let slope = *value * ratio;
                    let changes = &scaled[variations..variations + width];
                    for (rate, change) in rates[to..to + width].iter_mut().zip(changes) {
                        *rate += slope * change;
                    }
                }
                Term::ByParameter { rate, unit, size } => rates[rate] += unit * *value / size,
            }
        }
    }
}
