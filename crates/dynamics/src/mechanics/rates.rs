//! The equations of motion as first-order equations, for integration.

use super::{EquationsOfMotion, MechanicsError};
use crate::expr::Expr;
use crate::symbol::Symbol;

/// Coordinates and velocities with their rates.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// The coordinates, then a name for the velocity of each: `x`, `x'`.
    pub states: Vec<Symbol>,
    /// The rate of each: the velocities, then the accelerations.
    pub right: Vec<Expr>,
}

impl EquationsOfMotion {
    /// Returns the equations as first-order equations, for [`System`](crate::system::System).
    ///
    /// # Errors
    /// [`MechanicsError`] if the mass matrix is singular.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::mechanics::Mechanism;
    /// use lindstedt::system::{SystemOptions, System};
    ///
    /// let pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "-m*g*L*cos(x)")?;
    /// let rates = pendulum.equations()?.rates()?;
    /// let numbers = [("g".into(), 9.81), ("L".into(), 0.5), ("m".into(), 2.0)].into();
    /// let system = System::new(&rates.states, "t".into(), &rates.right, &numbers)?;
    /// let path = system.solve([0.0, 1.0], &[0.1, 0.0], &[], &SystemOptions::default())?;
    /// assert!(path.states_at(1.0).is_some_and(|state| (state[0] + 0.0282).abs() < 1e-3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn rates(&self) -> Result<Rates, MechanicsError> {
        let velocities: Vec<Symbol> =
            self.coordinates.iter().map(|name| name.derivative()).collect();
        let right = velocities.iter().copied().map(Expr::from);
        Ok(Rates {
            right: right.chain(self.accelerations()?).collect(),
            states: self.coordinates.iter().chain(&velocities).copied().collect(),
        })
    }
}
