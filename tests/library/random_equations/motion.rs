//! The true motion of a conservative oscillator, by its energy.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::definitions::{Answer, Question};
use super::quadrature::{Integrals, bisect, integrate};

/// The work of the force along a motion is not known.
pub struct Unsettled;

impl Question<'_> {
    /// The true frequency, squared: twice the time between the turning points, by the energy
    /// integral.
    pub fn truth(&self) -> Answer {
        let start = self.amplitude;
        if self.waves() > 300.0 {
            return Answer::Unknown;
        }
        let Ok(end) = self.far_turning_point() else {
            return Answer::Unknown;
        };
        let Some(end) = end else {
            return Answer::Nothing("the motion does not come back");
        };
        let (left, right) = (start.min(end), start.max(end));
        let force = |y: f64| self.f(y);
        let Some(work) = Integrals::new(&force, &self.stops(left, right), self.precision()) else {
            return Answer::Unknown;
        };
        let (middle, radius) = (0.5 * (left + right), 0.5 * (right - left));
        // y = m + r sin(phi): dt = dphi/sqrt(2 g), U = (right - y)(y - left) g.
        let time = |phi: f64| {
            let near = 2.0 * (0.25 * PI - 0.5 * phi).sin().powi(2);
            let far = 2.0 * (0.25 * PI + 0.5 * phi).sin().powi(2);
            // From the nearer end: beside a steep wall the distance from it counts.
            let y = if phi >= 0.0 { right - radius * near } else { left + radius * far };
            let rise = if phi >= 0.0 { work.beyond(y) } else { -work.up_to(y) };
            (near * far * radius * radius / (2.0 * rise)).sqrt()
        };
        let mut angles: Vec<f64> = vec![-FRAC_PI_2, -0.8, 0.0, 0.8, FRAC_PI_2];
        let sines = self.stops(left, right).into_iter().map(|place| (place - middle) / radius);
        angles.extend(sines.filter(|sine| sine.abs() < 1.0).map(f64::asin));
        angles.sort_by(f64::total_cmp);
        match integrate(&time, &angles, 1e-12) {
            Some(half) => {
                let omega = TAU / (2.0 * half);
                let rounding = self.noise(start).max(self.noise(end))
                    + start.abs().max(end.abs()) / (start - end).abs();
                // Pushed away at first, or turned back before the equilibrium: a motion of another
                // well.
                let elsewhere = start * self.f(start) < 0.0 || start * end > 0.0;
                match self.given(omega * omega, 1e4 + 10.0 * rounding) {
                    Answer::Value(squared, noise) if elsewhere => Answer::Elsewhere(squared, noise),
                    answer => answer,
                }
            }
            None => Answer::Unknown,
        }
    }

    /// The ends of an interval and the places between them where the force turns fast.
    fn stops(&self, left: f64, right: f64) -> Vec<f64> {
        let mut stops = vec![left, right];
        let places = self.force.places().into_iter().map(|place| place - self.origin).chain([0.0]);
        stops.extend(places.filter(|place| *place > left && *place < right));
        stops.sort_by(f64::total_cmp);
        stops
    }

    /// To how many digits the work of the force can be summed: about an equilibrium that is no
    /// fraction, small distances are differences.
    fn precision(&self) -> f64 {
        match self.origin == 0.0 {
            true => 1e-16,
            false => 1e-15 * (1.0 + self.noise(self.amplitude)),
        }
    }

    /// Where the motion turns back; `None` where it leaves.
    ///
    /// # Errors
    /// The force overflows on the way, or its work cannot be summed.
    pub fn far_turning_point(&self) -> Result<Option<f64>, Unsettled> {
        let start = self.amplitude;
        let (low, high) = self.force.domain(self.origin);
        if self.origin + start <= low || self.origin + start >= high || self.f(start) == 0.0 {
            return Ok(None);
        }
        // The side it comes from.
        let side = self.f(start).signum();
        let force = |y: f64| self.f(y);
        if self.is_odd() && side == start.signum() {
            // By symmetry, if nothing is in the way: the energy stays positive in between.
            let size = self.size();
            let work = Integrals::new(&force, &self.stops(0.0, size), self.precision())
                .ok_or(Unsettled)?;
            let mut places: Vec<f64> = (0..1000).map(|k| size * f64::from(k) / 1000.0).collect();
            places.extend(self.stops(0.0, size).into_iter().filter(|place| *place < size));
            return Ok(places.iter().all(|y| work.beyond(*y) > 0.0).then_some(-start));
        }
        let work = |from: f64, to: f64| -> f64 {
            let stops = self.stops(from.min(to), from.max(to));
            integrate(&force, &stops, self.precision().max(1e-15))
                .map_or(f64::NAN, |value| value * (to - from).signum())
        };
        let places = self.force.places().into_iter().map(|place| place - self.origin).chain([0.0]);
        // In steps that grow with the distance travelled, no larger than the features.
        let end = if side > 0.0 { low } else { high } - self.origin;
        let (mut y, mut left) = (start, 0.0);
        let mut stops: Vec<f64> = places.filter(|place| side * place < side * start).collect();
        stops.sort_by(|a, b| (side * b).total_cmp(&(side * a)));
        let mut travelled = 0.0;
        for _ in 0..6000 {
            let step = (0.01 * start.abs()).max(0.01 * travelled);
            let mut next = y - side * step;
            if let Some(stop) =
                stops.iter().find(|stop| side * **stop < side * y - 1e-12 * start.abs())
                && side * next < side * stop
            {
                next = *stop;
            }
            if end.is_finite() && side * next <= side * end {
                next = 0.5 * (y + end);
            }
            let after = left + work(next, y);
            if !after.is_finite() {
                return Err(Unsettled);
            }
            if after <= 0.0 {
                return Ok(Some(bisect(&|z| left + work(z, y), next, y)));
            }
            travelled += (y - next).abs();
            (y, left) = (next, after);
            if travelled > 1e9 * start.abs() {
                return Ok(None);
            }
        }
        Ok(None)
    }
}
