//! A contact in closed form: what it does to pendulum and main mass.
//!
//! ```text
//! m = (R + sin^2 x_c)/(R + 1)                          the mass of the relative motion: m d'' = -(gamma + mu d') d^(3/2) - push
//! push = s (sin x + y'' cos x)                         with y'' as without contact force, s = 1 on the right, -1 on the left
//! p = (R + 1) y' + x' cos x,   p' = f sin(eta t) - delta y' - kappa y     the contact is inside: it leaves p alone
//! q = (R + 1) y + sin x,       q' = p
//! ```
//!
//! The relative motion is the contact of the [`chain`](mod@super::super::chain) with gamma, mu, push,
//! zeta and alpha over m: restitution, depth, duration. The main mass takes the momentum that the
//! pendulum loses. Over the contact, which is short, push and p' are those of its middle, which a first
//! contact with the push of the touch tells; x'^2 sin x, which y'' has there too, is its mean.

use super::path::PrimaryState;
use super::{Primary, PrimaryCase};
use crate::impact::chain::{Bounce, Contacts};
use crate::impact::contact::hunt_crossley;
use crate::impact::lanes::Lanes;
use crate::impact::model::{Model, Side};
use crate::impact::simulation::ClosedForm;

/// A contact; times count from its beginning.
#[derive(Clone, Debug)]
pub(super) struct ClosedBounce {
    begin: f64,
    pub duration: f64,
    /// The greatest depth.
    pub depth: f64,
    angle: ClosedForm,
    /// R + 1.
    whole: f64,
    /// q at the touch, p at the touch and at the release.
    centre: f64,
    momenta: [f64; 2],
    /// int x'^2 dt.
    pub square: f64,
    /// int y' dt and int y'^2 dt.
    pub travel: [f64; 2],
}

/// The mass of the relative motion at a barrier, in units of that of the pendulum.
pub(super) fn relative_mass(primary: &Primary, x: f64) -> f64 {
    (primary.mass + x.sin().powi(2)) / (primary.mass + 1.0)
}

/// The greatest force of a contact that is touched with this speed.
pub(super) fn peak_force(case: &PrimaryCase, side: Side, speed: f64) -> Option<f64> {
    let model = &case.model;
    let mass = relative_mass(&case.primary, model.barrier(side)?);
    hunt_crossley::peak_force(1.5, model.gamma / mass, model.mu / model.gamma, speed)
        .map(|force| force * mass)
}

/// The force of the barrier of a side on a pendulum that rests there, negative where the pendulum
/// is pressed into it.
pub(super) fn push(case: &PrimaryCase, side: Side, t: f64, state: PrimaryState) -> f64 {
    let whole = case.primary.mass + 1.0;
    let cosine = state.x.cos();
    let speed = state.speed + state.velocity * cosine / whole;
    let force = force_on(&case.primary, t, PrimaryState { speed, ..state });
    side.sign() * (state.x.sin() + cosine * force / whole)
}

/// The force of spring, dashpot and drive on both bodies.
fn force_on(primary: &Primary, t: f64, state: PrimaryState) -> f64 {
    let drive = primary.force * (primary.frequency * t).sin();
    drive - primary.damping * state.speed - primary.stiffness * state.y
}

/// The effect of a contact on the relative motion under a constant push.
struct Impulse {
    depth: f64,
    duration: f64,
    angle: ClosedForm,
    /// The angle at the mean depth, which is that of half a sine.
    mean_angle: f64,
    /// int x'^2 dt.
    square: f64,
}

impl Impulse {
    /// The contact that begins in this state; `None` if the pendulum does not leave.
    fn new(case: &PrimaryCase, side: Side, state: PrimaryState, push: f64) -> Option<Self> {
        let Model { gamma, mu, zeta, alpha, .. } = case.model;
        let speed = side.sign() * state.velocity;
        let relative = relative_mass(&case.primary, state.x);
        let contacts = Contacts {
            gamma: Lanes([gamma / relative]),
            damping: Lanes([mu / gamma]),
            push: Lanes([push / relative]),
            zeta: Lanes([zeta / relative]),
            alpha: Lanes([alpha / relative]),
        };
        let Bounce { depth, duration, speed_out } = contacts.bounces(Lanes([speed])).lane(0)?;
        if !(speed_out > 0.0 && duration.is_finite()) {
            return None;
        }
        let angle = ClosedForm::contact((side, state.x), [depth, duration], [speed, speed_out]);
        let square = match angle {
            ClosedForm::Contact { sines, .. } => (1..)
                .zip(sines)
                .map(|(order, sine)| {
                    let rate = sine * f64::from(order) * std::f64::consts::PI / duration;
                    0.5 * rate * rate * duration
                })
                .sum(),
            ClosedForm::Swing { .. } => 0.0,
        };
        let mean_angle = state.x + side.sign() * std::f64::consts::FRAC_2_PI * depth;
        Some(Self { depth, duration, angle, mean_angle, square })
    }
}

impl ClosedBounce {
    /// The contact that begins in this state on the surface of the barrier; `None` if the pendulum
    /// leans on it rather than leaves it, goes deep, or is stopped by friction.
    pub(super) fn new(
        case: &PrimaryCase,
        side: Side,
        begin: f64,
        state: PrimaryState,
    ) -> Option<Self> {
        let whole = case.primary.mass + 1.0;
        let (sine, cosine) = state.x.sin_cos();
        let (momentum, centre) =
            (whole * state.speed + state.velocity * cosine, whole * state.y + sine);
        let first = Impulse::new(case, side, state, push(case, side, begin, state))?;
        // The middle of the contact, as the first answer has it.
        let half = 0.5 * first.duration;
        let middle = |force: f64| {
            let (x, momentum) = (first.mean_angle, momentum + force * half);
            let y = (centre + momentum * half - x.sin()) / whole;
            PrimaryState { x, velocity: 0.0, y, speed: momentum / whole }
        };
        let force = force_on(&case.primary, begin + half, middle(0.0));
        let middle = middle(force);
        let centrifugal = first.square / first.duration * middle.x.sin();
        let push = push(case, side, begin + half, middle)
            + side.sign() * middle.x.cos() * centrifugal / whole;
        let Impulse { depth, duration, angle, square, .. } = Impulse::new(case, side, state, push)?;
        let end = momentum + force_on(&case.primary, begin + half, middle) * duration;
        let travel = 0.5 * (momentum + end) * duration / whole;
        let squares = travel * travel / duration + square * (cosine / whole).powi(2);
        Some(Self {
            begin,
            duration,
            depth,
            angle,
            whole,
            centre,
            momenta: [momentum, end],
            square,
            travel: [travel, squares],
        })
    }

    /// The state this long after the touch.
    pub(super) fn point(&self, t: f64) -> PrimaryState {
        let (x, velocity) = self.angle.phase_point_at(t);
        let [first, last] = self.momenta;
        let momentum = first + (last - first) * t / self.duration;
        let centre = self.centre + 0.5 * (first + momentum) * t;
        PrimaryState {
            x,
            velocity,
            y: (centre - x.sin()) / self.whole,
            speed: (momentum - velocity * x.cos()) / self.whole,
        }
    }

    /// The state at this time of the motion.
    pub(super) fn state_at(&self, time: f64) -> PrimaryState {
        self.point((time - self.begin).clamp(0.0, self.duration))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::primary::{PrimarySettings, simulate_primary};

    /// The states after a contact by integration, and what it took.
    #[test]
    fn a_contact_leaves_the_state_that_the_integration_leaves() {
        for (mass, gamma, damping, velocity, place) in [
            (5.0, 1e6, 0.3, 0.8, 0.3),
            (50.0, 3e7, 0.5, 0.5, 0.2),
            (20.0, 1e5, 0.0, 1.2, 0.0),
            (20.0, 1e5, 0.2, -0.6, -0.25),
        ] {
            let primary =
                Primary { mass, stiffness: 2.5 * mass, damping: 0.5, force: 0.7, frequency: 1.1 };
            let [left, right] =
                if velocity < 0.0 { [Some(place), None] } else { [None, Some(place)] };
            let model =
                Model { zeta: 0.01, gamma, mu: damping * gamma, left, right, ..Model::default() };
            let case = PrimaryCase { primary, model, start: [place, velocity, 0.2, -0.3] };
            let settings = PrimarySettings { duration: 1.0, ..PrimarySettings::default() };
            let motion = simulate_primary(case, &settings).expect("a motion");
            let impact = motion.impacts.first().expect("an impact");
            let exit = impact.exit_time.expect("a release");
            let truth = motion.state_at(exit).expect("a state");
            let side = if velocity < 0.0 { Side::Left } else { Side::Right };
            let start = PrimaryState { x: place, velocity, y: 0.2, speed: -0.3 };
            let bounce = ClosedBounce::new(&case, side, 0.0, start).expect("a bounce");
            let found = bounce.point(bounce.duration);
            assert!((bounce.duration / exit - 1.0).abs() < 0.05, "{} {exit}", bounce.duration);
            assert!((bounce.depth / impact.penetration - 1.0).abs() < 5e-3, "{}", bounce.depth);
            assert!((found.x - place).abs() < 1e-14);
            assert!((found.velocity / truth.velocity - 1.0).abs() < 2e-3, "{found:?} {truth:?}");
            assert!((found.y - truth.y).abs() < 1e-3 * exit, "{found:?} {truth:?}");
            // The momentum of both, which the contact leaves alone.
            let momentum =
                |state: PrimaryState| (mass + 1.0) * state.speed + state.velocity * state.x.cos();
            let change = momentum(truth) - momentum(start);
            assert!((momentum(found) - momentum(start) - change).abs() < 0.06 * change.abs());
            let force = peak_force(&case, side, velocity.abs()).expect("a force");
            // Without the forces of swing and main mass.
            assert!((force / motion.peak_force(impact) - 1.0).abs() < 0.02, "{mass} {force}");
        }
    }
}
