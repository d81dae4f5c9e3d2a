//! Turning points of a motion released from rest ([`crate::numeric::ode::energy`]), in distances
//! from the equilibrium, so that no digits are lost near rest. The integral between the turning
//! points is left to the caller.

use super::force::CentredForce;
use super::well::Well;
use crate::decimal::rounded_to;
use crate::exact::rational::to_f64;
use crate::numeric::ode::energy::{self, PeriodError};
use crate::solution::AmplitudeConvention;

impl CentredForce {
    /// The distance from the equilibrium of the other turning point of a motion released at the
    /// distance `start`.
    ///
    /// # Errors
    /// See [`PeriodError`].
    pub fn turning_point(&self, start: f64) -> Result<f64, PeriodError> {
        self.between_turning_points(start, |_, end| Ok(end))
    }

    /// Calls `run` with the force and the other turning point. Poles between them are an error: one
    /// so weak that rounding hides its energy would be passed unseen.
    ///
    /// # Errors
    /// See [`PeriodError`]; places are positions.
    pub fn between_turning_points<T>(
        &self,
        start: f64,
        run: impl FnOnce(&energy::PiecewiseForce, f64) -> Result<T, PeriodError>,
    ) -> Result<T, PeriodError> {
        let (value, cuts) = (|y| self.value(y), |from, to| self.cuts(from, to));
        let force = energy::PiecewiseForce::with_cuts(&value, &cuts);
        let no_value = |distance: f64| match self.overflow(distance) {
            Some(term) => PeriodError::Overflow { place: distance, term },
            None => PeriodError::Pole { place: distance },
        };
        let pole =
            |end: f64| self.gap(start, end).map(|place| no_value(place - self.equilibrium()));
        if self.overflow(start).is_some() {
            return Err(no_value(start).moved(self.equilibrium()));
        }
        let found = match energy::turning_point(&force, 0.0, start) {
            Ok(end) => match pole(end) {
                Some(error) => Err(error),
                None => run(&force, end),
            },
            Err(error @ (PeriodError::Quadrature(_) | PeriodError::Root(_))) => {
                Err(pole(-start).unwrap_or(error))
            }
            // Beyond a pole that the search has passed unseen nothing is known.
            Err(error @ PeriodError::Escapes { searched, .. }) => Err(match pole(searched) {
                Some(pole @ PeriodError::Pole { .. }) => pole,
                _ => error,
            }),
            Err(error) => Err(error),
        };
        found.map_err(|error| error.moved(self.equilibrium()))
    }

    /// The reason why a motion released at the distance `start` has no period, where a search or a
    /// quadrature has failed with `error`: near the separatrix that ends the well neither can tell
    /// the cause. The search for the rims of the well is slow, so this is for messages only.
    pub fn why_no_period(&self, start: f64, error: PeriodError) -> PeriodError {
        /// Relative distance from the end of the well within which its position is known.
        const ON: f64 = 1e-13;
        /// Relative distance from the end of the well within which the period is an integral of
        /// rounding errors.
        const NEAR: f64 = 1e-6;
        let lost = matches!(error, PeriodError::Quadrature(_) | PeriodError::Root(_));
        let gone = matches!(
            error,
            PeriodError::PushedAway { .. }
                | PeriodError::OtherWell { .. }
                | PeriodError::Escapes { .. }
        );
        if !lost && !gone {
            return error;
        }
        let well = Well::new(self, start);
        if let Some(inner) = well.and_then(|well| well.inner) {
            let (place, position) = (inner.place, self.equilibrium() + start);
            return match start.abs() / inner.amplitude - 1.0 {
                short if short.abs() <= ON => PeriodError::Separatrix { start: position, place },
                short if short.abs() <= NEAR && lost => {
                    PeriodError::NearSeparatrix { start: position, place }
                }
                short if short < 0.0 => PeriodError::OneWell {
                    start: position,
                    equilibrium: self.equilibrium(),
                    least: to_f64(&rounded_to(inner.amplitude, 6)),
                },
                _ => error,
            };
        }
        let Some((well, end)) = well.and_then(|well| Some((well, well.on_side(start)?))) else {
            return error;
        };
        let beyond = start / end.amplitude - 1.0;
        let (place, position) = (end.rim.place, self.equilibrium() + start);
        match beyond.abs() {
            short if end.rim.separatrix && short <= ON => {
                PeriodError::Separatrix { start: position, place }
            }
            short if end.rim.separatrix && short <= NEAR && lost => {
                PeriodError::NearSeparatrix { start: position, place }
            }
            _ if gone && beyond >= 0.0 => error.with_range(
                well.in_words(AmplitudeConvention::Initial.symbol(), self.coordinate()),
            ),
            _ => error,
        }
    }
}
