//! Coulomb friction at a turning point: it lets the motion continue, or holds it until the
//! excitation releases it.

use super::Runner;
use crate::impact::simulation::Regime;
use crate::impact::simulation::{SimulationStop, TurningPoint};

impl Runner {
    /// The present acceleration at rest by all forces but friction.
    fn force_at_rest(&self) -> f64 {
        let (t, x, _) = self.now();
        let contact = match self.side() {
            Some((side, _)) if matches!(self.regime, Regime::Contact(_)) => {
                side.sign() * self.model.contact(self.place * self.place, 0.0)
            }
            _ => 0.0,
        };
        self.model.field(t, x) - contact
    }

    /// Decides at rest under Coulomb friction in which direction the motion continues, if at all.
    pub(super) fn turn(&mut self) {
        let force = self.force_at_rest();
        if force.abs() <= self.model.alpha * (1.0 + 4.0 * f64::EPSILON) {
            self.stay_held();
        } else {
            self.direction = force.signum();
        }
    }

    /// Holds the pendulum by friction until the excitation releases it, or to the end.
    fn stay_held(&mut self) {
        let (start, x, _) = self.now();
        let field = self.force_at_rest() - self.model.field(start, x) - x.sin();
        let (release, direction) =
            self.model.release(start, x, field).unwrap_or((f64::INFINITY, 0.0));
        let end = release.min(self.settings.duration);
        if self.settings.keep_path && end > start {
            self.path.push_rest([start, end], x);
        }
        if end > start {
            self.turns.push(TurningPoint { t: end, x });
        }
        self.t = end;
        self.velocity = 0.0;
        if release < self.settings.duration {
            self.direction = direction;
            self.released = true;
        } else {
            self.direction = 0.0;
            self.stop = Some(SimulationStop::Duration);
        }
    }
}
