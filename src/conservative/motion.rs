//! Where a motion of a force about its equilibrium, released at rest, turns back ([`crate::numeric::ode::energy`]), in distances from the
//! equilibrium, so that nothing is lost near rest. What lies between the turning points is integrated by who asks for it.

use super::force::Force;
use crate::numeric::ode::energy::{self, PeriodError};

impl Force {
    /// The distance from the equilibrium of the other turning point of a motion released at the distance `start`.
    ///
    /// # Errors
    /// See [`PeriodError`].
    pub fn turning_point(&self, start: f64) -> Result<f64, PeriodError> {
        self.between_turning_points(start, |_, end| Ok(end))
    }

    /// What `run` makes of the force and the other turning point, where no pole stands in the way: one so weak that rounding
    /// hides its energy would be passed unseen.
    ///
    /// # Errors
    /// See [`PeriodError`]; places are positions.
    pub(crate) fn between_turning_points<T>(
        &self,
        start: f64,
        run: impl FnOnce(&energy::Force, f64) -> Result<T, PeriodError>,
    ) -> Result<T, PeriodError> {
        let (value, cuts) = (|y| self.at(y), |from, to| self.cuts(from, to));
        let force = energy::Force::with_cuts(&value, &cuts);
        let no_value = |distance: f64| match self.overflow(distance) {
            Some(term) => PeriodError::Overflow { place: distance, term },
            None => PeriodError::Pole { place: distance },
        };
        let pole = |end: f64| self.gap(start, end).map(|place| no_value(place - self.equilibrium()));
        if self.overflow(start).is_some() {
            return Err(no_value(start).moved(self.equilibrium()));
        }
        let found = match energy::turning_point(&force, 0.0, start) {
            Ok(end) => match pole(end) {
                Some(error) => Err(error),
                None => run(&force, end),
            },
            Err(error @ (PeriodError::Quadrature(_) | PeriodError::Root(_))) => Err(pole(-start).unwrap_or(error)),
            // Beyond a pole that the search has passed unseen nothing is known.
            Err(error @ PeriodError::Escapes { searched, .. }) => Err(match pole(searched) {
                Some(pole @ PeriodError::Pole { .. }) => pole,
                _ => error,
            }),
            Err(error) => Err(error),
        };
        found.map_err(|error| error.moved(self.equilibrium()))
    }
}
