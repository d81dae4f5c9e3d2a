//! A problem whose equations are made ready once, to be followed from many starts.

use super::event_run::{EventRun, PieceKeeping, RunEnd};
use super::walls::WallRecord;
use super::{Ready, TrajectoryError, TrajectoryRequest};
use crate::system::{Integrator, PathEnd};

/// A problem with its equations and walls made ready; neither energy nor section.
#[derive(Clone, Debug)]
pub struct PreparedTrajectory {
    course: TrajectoryRequest,
    ready: Ready,
    integrator: Integrator,
}

/// The end of a motion that was followed, and the impacts on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryEnd {
    /// Coordinates, then velocities there.
    pub state: Vec<f64>,
    /// The impacts on walls and the rests on them.
    pub walls: WallRecord,
    /// The reason why it ended.
    pub reason: PathEnd,
}

impl TrajectoryRequest {
    /// Makes the equations ready for an integrator.
    ///
    /// # Errors
    /// [`TrajectoryError`] for a name without a number, or equations that cannot be followed.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::system::Integrator;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// let wave = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
    /// let wave = wave.prepared(Integrator::Taylor)?;
    /// let end = wave.follow([1.0, 3.0], &[1.0, 0.0])?;
    /// assert!((end.state[0] - 2.0_f64.cos()).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn prepared(self, integrator: Integrator) -> Result<PreparedTrajectory, TrajectoryError> {
        let course = Self { energy: None, section: None, ..self };
        Ok(PreparedTrajectory { ready: course.ready(integrator)?, course, integrator })
    }
}

impl PreparedTrajectory {
    /// Follows the motion from the first of the times, with coordinates and velocities there, to the
    /// second.
    ///
    /// # Errors
    /// [`TrajectoryError`]; a run that ends early says so by [`TrajectoryEnd::reason`].
    pub fn follow(
        &self,
        [from, to]: [f64; 2],
        start: &[f64],
    ) -> Result<TrajectoryEnd, TrajectoryError> {
        let course = TrajectoryRequest { duration: to, ..self.course.clone() };
        let mut run = EventRun::new(&course, &self.ready, (from, start.to_vec()), self.integrator)?;
        run.keep(PieceKeeping::Last);
        run.complete()?;
        let RunEnd { pieces, reason, walls, .. } = run.finish();
        let last = pieces.last().and_then(|piece| piece.states_at(piece.end()));
        let mut state = last.unwrap_or_else(|| start.to_vec());
        state.truncate(course.rates.states.len());
        Ok(TrajectoryEnd { state, walls, reason })
    }
}
