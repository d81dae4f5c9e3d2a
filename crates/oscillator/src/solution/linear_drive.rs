//! The effect of a drive on a linear oscillator, in words.

use std::fmt;

use crate::expr::Expr;
use crate::symbol::Symbol;

/// The effect of a drive on a linear oscillator.
#[derive(Clone, Debug, PartialEq)]
pub enum LinearDrive {
    /// The motion that is left once the free part has died out.
    Steady {
        /// The coordinate.
        coordinate: Symbol,
        /// The motion, in time.
        motion: Expr,
        /// Its amplitude, where one drive alone acts.
        amplitude: Option<Expr>,
    },
    /// There is no damping, and the drive has the linear frequency.
    Grows {
        /// The drive.
        term: Expr,
    },
    /// There is no damping, and the drive has the linear frequency for some values.
    Detuned {
        /// The square of its frequency.
        square: Expr,
        /// The square of the linear frequency.
        stiffness: Expr,
    },
}

impl fmt::Display for LinearDrive {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steady { coordinate, motion, amplitude } => {
                write!(
                    formatter,
                    "once the free part has died out the steady motion is left: {coordinate} = {motion}"
                )?;
                match amplitude {
                    Some(amplitude) => write!(formatter, ", of amplitude {amplitude}"),
                    None => Ok(()),
                }
            }
            Self::Grows { term } => write!(
                formatter,
                "resonance: the drive {term} has the linear frequency and nothing damps, so that the amplitude grows in proportion to time"
            ),
            Self::Detuned { square, stiffness } => write!(
                formatter,
                "only where {square} is not {stiffness}: nothing damps, and at that resonance the amplitude grows in proportion to time"
            ),
        }
    }
}
