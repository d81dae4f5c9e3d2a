//! A contact under a line, equation (15): a spring and a constant force.
//!
//! In: the square of its frequency, the force at touch and the speed. Out: a [`LineContact`]:
//! depth, duration, motion.
//!
//! ```text
//! d'' + b + w^2 d = 0,  d(0) = 0, d'(0) = v               T = (2/w) atan2(v/w, b/w^2)
//! d = (v/w) sin w s - (b/w^2) (1 - cos w s)               D = hypot(v/w, b/w^2) - b/w^2
//! ```

use crate::impact::linearisation::LinearContactForce;

/// d'' + b + w^2 d = 0 from d = 0 with speed v until d = 0 again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::impact) struct LineContact {
    /// v, in the unit of x per time.
    pub(in crate::impact) speed: f64,
    /// w, in radians per time.
    pub(in crate::impact) frequency: f64,
    /// b/w^2, the distance of the centre of oscillation in front of the barrier, in the unit of x.
    pub(in crate::impact) centre: f64,
}

impl LineContact {
    /// The motion along this line, per unit of this stiffness, with another force that is
    /// `at_barrier` at the touch and has this `slope`; `None` if it does not oscillate.
    pub(in crate::impact) fn new(
        line: LinearContactForce,
        stiffness: f64,
        [at_barrier, slope]: [f64; 2],
        speed: f64,
    ) -> Option<Self> {
        let square = slope + stiffness * line.slope;
        (square.is_finite() && square > 0.0).then(|| Self {
            speed,
            frequency: square.sqrt(),
            // The difference of the barrier and the centre would cancel.
            centre: (at_barrier + stiffness * line.at_touch) / square,
        })
    }

    /// Duration of the contact, in the unit of time.
    pub(in crate::impact) fn duration(&self) -> f64 {
        2.0 / self.frequency * (self.speed / self.frequency).atan2(self.centre)
    }

    /// The greatest depth, in the unit of x.
    pub(in crate::impact) fn depth(&self) -> f64 {
        let swing = self.speed / self.frequency;
        let amplitude = self.centre.hypot(swing);
        // This form avoids a difference of nearly equal numbers.
        if self.centre > 0.0 {
            swing / (amplitude + self.centre) * swing
        } else {
            amplitude - self.centre
        }
    }

    /// Depth and velocity at a time since touch.
    pub(super) fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let swing = self.speed / self.frequency;
        let (sine, cosine) = (0.5 * self.frequency * time).sin_cos();
        let depth = 2.0 * sine * (swing * cosine - self.centre * sine);
        let (sine, cosine) = (self.frequency * time).sin_cos();
        (depth, self.speed * cosine - self.centre * self.frequency * sine)
    }
}
