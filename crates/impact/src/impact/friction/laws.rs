//! Coulomb's law and the arctangent in its place, at single speeds.
//!
//! ```text
//! sgn(x') ~ (2/pi) atan(100 x')
//! error   = 100 (1 - (2/pi) atan(100 |x'|)) %
//! ```

use std::f64::consts::PI;

use crate::impact::model::STEEPNESS;

/// The approximation (2/pi) atan(100 x') of sgn(x'), with this value of pi.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::friction::arctangent;
///
/// assert!((arctangent(1.0, std::f64::consts::PI) - 0.993634).abs() < 1e-6);
/// assert!((arctangent(1.0, 314.0 / 100.0) - 0.994138).abs() < 1e-6);
/// ```
pub fn arctangent(speed: f64, pi: f64) -> f64 {
    2.0 / pi * (STEEPNESS * speed).atan()
}

/// The error of the [`arctangent`] in per cent; at rest both laws are zero.
pub fn arctangent_error(speed: f64, pi: f64) -> f64 {
    match speed == 0.0 {
        true => 0.0,
        false => 100.0 * (1.0 - arctangent(speed.abs(), pi)),
    }
}

/// The two laws at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedRow {
    /// The speed x', units of omega.
    pub speed: f64,
    /// Coulomb's sgn(x').
    pub sign: f64,
    /// (2/pi) atan(100 x').
    pub arctangent: f64,
    /// The distance of the arctangent from sgn, per cent.
    pub error: f64,
}

impl SpeedRow {
    /// The two laws at a speed.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::friction::SpeedRow;
    ///
    /// let row = SpeedRow::new(0.01);
    /// assert!(row.sign == 1.0 && (row.error - 50.0).abs() < 1e-9);
    /// ```
    pub fn new(speed: f64) -> Self {
        Self {
            speed,
            sign: if speed == 0.0 { 0.0 } else { speed.signum() },
            arctangent: arctangent(speed, PI),
            error: arctangent_error(speed, PI),
        }
    }
}
