//! The pendulum on its main mass: its rest time and its peak forces.

use super::super::hertz;
use super::super::si::greatest;
use super::super::simulation::place::RestPoint;
use super::super::simulation::rest::first_swing;
use super::super::simulation::{NoRest, REST_FRACTION};
use super::bounce::peak_force;
use super::{PrimaryImpact, PrimaryMotion};
use crate::impact::Start;

impl PrimaryMotion {
    /// The time, in units of 1/omega, at which the envelope of the pendulum has fallen to a tenth
    /// of its largest swing, for good. On a fixed pivot the largest swing is the first; a main mass
    /// may swing the pendulum up from where it hangs. The envelope goes through the turning points
    /// on the side without a barrier; without a barrier, or with two, through the larger of every
    /// two successive ones. Angles count from the place of rest.
    ///
    /// # Errors
    /// The reason for which there is no such time.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::Model;
    /// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, simulate_primary};
    ///
    /// // A pivot that is hardly moved: ln(10)/zeta for small swings.
    /// let primary = Primary { mass: 1e6, stiffness: 1e6, damping: 0.0, force: 0.0, frequency: 0.0 };
    /// let model = Model { left: None, right: None, zeta: 0.1, ..Model::default() };
    /// let case = PrimaryCase { primary, model, start: [0.01, 0.0, 0.0, 0.0] };
    /// let motion = simulate_primary(case, &PrimarySettings { duration: 40.0, ..PrimarySettings::default() })?;
    /// assert!((motion.pendulum_rest_time()? / (10.0_f64.ln() / 0.1) - 1.0).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn pendulum_rest_time(&self) -> Result<f64, NoRest> {
        let [x, velocity, ..] = self.case.start;
        let model = &self.case.model;
        let place = RestPoint::near(model, self.state_at(self.end).map_or(x, |state| state.x));
        let free = place.free_side(model);
        let turns = self.swings.iter().filter(|(t, _)| *t > 0.0);
        let turns: Vec<(f64, f64)> = turns.map(|(t, x)| (*t, x - place.x)).collect();
        let first = first_swing(model, Start { x, velocity });
        let mut envelope = vec![(0.0, first)];
        match free {
            Some(side) => {
                let outside = turns.iter().filter(|(_, angle)| side.sign() * angle > 0.0);
                envelope.extend(outside.map(|(t, angle)| (*t, angle.abs())));
            }
            None => envelope.extend(turns.windows(2).map(|pair| {
                let larger = if pair[1].1.abs() > pair[0].1.abs() { pair[1] } else { pair[0] };
                (larger.0, larger.1.abs())
            })),
        }
        envelope.dedup();
        let largest = envelope.iter().map(|(_, height)| *height).fold(0.0, f64::max);
        match largest > 0.0 {
            true => self.falls_to(REST_FRACTION * largest, &envelope),
            false => Err(NoRest::NoAmplitude),
        }
    }

    /// The greatest force of the barrier in an impact of this motion, its damping included, in
    /// units of m g.
    pub fn peak_force(&self, impact: &PrimaryImpact) -> f64 {
        let model = &self.case.model;
        let contacts =
            self.path.contacts([impact.entry_time, impact.exit_time.unwrap_or(self.end)]);
        if let Some(force) = self
            .path
            .is_closed_bounce(impact.entry_time)
            .then(|| peak_force(&self.case, impact.side, impact.speed_in))
            .flatten()
        {
            return force;
        }
        let peaks = contacts.map(|(path, side)| {
            let force = |s: f64| match path.states_at(s) {
                Some(state) => hertz::force(
                    (model.gamma + side.sign() * model.mu * state[1]).max(0.0),
                    state[0] * state[0],
                ),
                None => 0.0,
            };
            greatest(force, 0.0, path.end())
        });
        peaks.fold(0.0, f64::max)
    }
}
