//! A measured record.

use crate::motion::Quantity;

/// A record of one quantity at increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Increasing times.
    pub times: Vec<f64>,
    /// The observed values.
    pub values: Vec<f64>,
    /// What was observed.
    pub quantity: Quantity,
    /// Whether the values are angles in radians.
    pub is_angle: bool,
}
