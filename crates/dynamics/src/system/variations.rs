//! The equations of small changes of a motion, beside those of the motion itself.
//!
//! ```text
//! y' = F(t, y; p):    z' = F_y z         z = dy/dy_i(0) begins as the unit vector e_i
//!                     z' = F_y z + F_p   z = dy/dp begins as zero
//! ```
//!
//! In: the right sides of n states. Out: those of n + n^2 states, or of n + n^2 + n with the changes
//! by a parameter, whose series share the parts that they have in common.

use crate::expr::{Expr, ExprError};
use crate::symbol::{Symbol, fresh_stem};

/// A system with its variations.
#[derive(Clone, Debug, PartialEq)]
pub struct Variations {
    /// The states, then column by column the derivative of each state by every initial state, then
    /// by the parameter, if one is given.
    pub states: Vec<Symbol>,
    /// The right side of each of them.
    pub right: Vec<Expr>,
}

impl Variations {
    /// Writes the variations of a system by its initial states, and by a parameter if one is given.
    /// The names of the new states differ from those that are `taken` and from all in the system.
    ///
    /// # Errors
    /// [`ExprError`] if a right side has no derivative.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::system::{System, SystemOptions, Variations};
    ///
    /// // x' = k x: dx/dx(0) = exp(k t), dx/dk = x(0) t exp(k t).
    /// let rate = parse_expression("k*x")?;
    /// let varied = Variations::new(&["x".into()], &[rate], Some("k".into()), &[])?;
    /// let system = System::new(&varied.states, "t".into(), &varied.right, &[("k".into(), 0.5)].into())?;
    /// let path = system.solve([0.0, 1.0], &Variations::start(&[2.0], true), &[], &SystemOptions::default())?;
    /// let grown = 0.5_f64.exp();
    /// for (found, exact) in path.states_at(1.0).expect("a state").into_iter().zip([2.0 * grown, grown, 2.0 * grown]) {
    ///     assert!((found - exact).abs() < 1e-14);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        states: &[Symbol],
        right: &[Expr],
        parameter: Option<Symbol>,
        taken: &[Symbol],
    ) -> Result<Self, ExprError> {
        let mut taken: Vec<Symbol> = taken.iter().chain(states).copied().collect();
        taken.extend(right.iter().flat_map(Expr::symbols));
        taken.extend(parameter);
        let slopes: Vec<Vec<Expr>> = right
            .iter()
            .map(|right| states.iter().map(|state| right.differentiate(*state)).collect())
            .collect::<Result<_, _>>()?;
        let by_parameter: Option<Vec<Expr>> = parameter
            .map(|parameter| right.iter().map(|right| right.differentiate(parameter)).collect())
            .transpose()?;
        let mut all = Self { states: states.to_vec(), right: right.to_vec() };
        let stem = fresh_stem("z", &taken);
        let columns = states.iter().map(|_| None).chain(by_parameter.iter().map(Some));
        for (index, own) in columns.enumerate() {
            let name = |row: usize| Symbol::new(&format!("{stem}{}", index * states.len() + row));
            let column: Vec<Symbol> = (0..states.len()).map(name).collect();
            for (row, slopes) in slopes.iter().enumerate() {
                let products = slopes.iter().zip(&column);
                let products = products.map(|(slope, change)| slope * &Expr::from(*change));
                let parts = products.chain(own.map(|own| own[row].clone()));
                all.right.push(Expr::sum(parts.collect::<Vec<_>>()));
            }
            all.states.extend(column);
        }
        Ok(all)
    }

    /// The initial values of a system with its variations, by a parameter too where
    /// `by_parameter` says so.
    pub fn start(values: &[f64], by_parameter: bool) -> Vec<f64> {
        let count = values.len();
        let unit = |index: usize| if index / count == index % count { 1.0 } else { 0.0 };
        let zeros = if by_parameter { count } else { 0 };
        let columns = (0..count * count).map(unit);
        values.iter().copied().chain(columns).chain(vec![0.0; zeros]).collect()
    }
}
