//! The closed forms of the chain: a stretch of the swing whose amplitude decays, and a contact.
//!
//! ```text
//! swing:    x(t) = 2 s asin(k exp(-r t) sn(n t + u, m)),   s = 1 or -1, t from the beginning of the stretch
//! contact:  x(t) = x_r + a_1 sin(pi t/T) + a_2 sin(2 pi t/T) + a_3 sin(3 pi t/T)
//! ```
//!
//! Without damping r = 0, n = 1 and m = k^2: the motion of the pendulum (DLMF 22.19.2). With it, k
//! exp(-r t) is the sine of half the amplitude that belongs to the energy at each end of the
//! stretch, m the square of its mean, and n is chosen so that the ends meet. The sines of the
//! contact have the speeds of touch and release, the greatest depth and the duration.

use std::f64::consts::PI;
use std::fmt;

use spec_math::cephes64::ellpj;

use crate::decimal::decimal;
use crate::impact::model::Side;

/// A closed form of one stretch; times count from its beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClosedForm {
    /// x(t) = 2 s asin(k exp(-r t) sn(n t + u, m)).
    Swing {
        /// s, the direction in which x begins to grow with the angle of sn.
        sign: f64,
        /// k, the sine of half the amplitude at the beginning.
        modulus: f64,
        /// r, in units of omega.
        rate: f64,
        /// n, in units of omega.
        speed: f64,
        /// u.
        phase: f64,
        /// m, the parameter of sn.
        parameter: f64,
    },
    /// x(t) = x_r + sum a_j sin(j pi t/T).
    Contact {
        /// x_r, rad.
        barrier: f64,
        /// T, in units of 1/omega.
        duration: f64,
        /// a_1, a_2, a_3, rad: negative into a barrier on the left.
        sines: [f64; 3],
    },
}

impl ClosedForm {
    /// A contact of this depth and duration, between these speeds.
    pub(in crate::impact) fn contact(
        (side, barrier): (Side, f64),
        [depth, duration]: [f64; 2],
        [speed_in, speed_out]: [f64; 2],
    ) -> Self {
        // In units of the depth a_1 + 3 a_3 + 2 a_2 and a_1 + 3 a_3 - 2 a_2 are the speeds in units
        // of pi D/T, a_1 - a_3 = 1.
        let unit = PI * depth / duration;
        let (mean, half) =
            (0.5 * (speed_in + speed_out) / unit, 0.5 * (speed_in - speed_out) / unit);
        let third = 0.25 * (mean - 1.0);
        Self::Contact {
            barrier,
            duration,
            sines: [1.0 + third, 0.5 * half, third].map(|sine| side.sign() * depth * sine),
        }
    }

    /// Displacement (rad) and velocity at this time since the beginning.
    pub fn phase_point_at(&self, t: f64) -> (f64, f64) {
        match *self {
            Self::Swing { sign, modulus, rate, speed, phase, parameter } => {
                let (sn, cn, dn, _) = ellpj(speed * t + phase, parameter);
                let modulus = modulus * (-rate * t).exp();
                let sine = (modulus * sn).clamp(-1.0, 1.0);
                let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt().max(f64::MIN_POSITIVE);
                (
                    2.0 * sign * sine.asin(),
                    2.0 * sign * modulus * (speed * cn * dn - rate * sn) / cosine,
                )
            }
            Self::Contact { barrier, duration, sines } => {
                let (mut place, mut rate) = (barrier, 0.0);
                for (j, sine) in (1..).zip(sines) {
                    let wave = f64::from(j) * PI / duration;
                    place += sine * (wave * t).sin();
                    rate += sine * wave * (wave * t).cos();
                }
                (place, rate)
            }
        }
    }
}

impl fmt::Display for ClosedForm {
    /// The right side of `x(t) = `.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let signed = |value: f64| match value < 0.0 {
            true => format!(" - {}", decimal(-value)),
            false => format!(" + {}", decimal(value)),
        };
        match *self {
            Self::Swing { sign, modulus, rate, speed, phase, parameter } => {
                let minus = if sign < 0.0 { "-" } else { "" };
                let decay = match rate == 0.0 {
                    true => String::new(),
                    false => format!(" exp({} t)", decimal(-rate)),
                };
                let speed = match decimal(speed) {
                    one if one == "1" => "t".to_owned(),
                    speed => format!("{speed} t"),
                };
                write!(
                    formatter,
                    "{minus}2 asin({}{decay} sn({speed}{}, {}))",
                    decimal(modulus),
                    signed(phase),
                    decimal(parameter)
                )
            }
            Self::Contact { barrier, duration, sines } => {
                write!(formatter, "{}", decimal(barrier))?;
                for (j, amplitude) in (1..).zip(sines) {
                    if amplitude != 0.0 {
                        write!(
                            formatter,
                            "{} sin({} t)",
                            signed(amplitude),
                            decimal(f64::from(j) * PI / duration)
                        )?;
                    }
                }
                Ok(())
            }
        }
    }
}
