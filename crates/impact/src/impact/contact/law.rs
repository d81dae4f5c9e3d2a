//! The table of the laws of a contact, by name: lines, perturbation, balances, power law, exact.
//!
//! In: a [`Touch`], the forces as closures and the speed. Out: by a [`ContactLaw`] a
//! [`ContactMotion`], by all of them a [`comparison`] with the exact one. Each is computed in a
//! file of its own: the fitted lines in `line`, homotopy, iteration and the balances in
//! `half_oscillation`, the power law and the exact contact in theirs.
//!
//! `homotopy` of the first order, the first order of parameter expansion and of homotopy analysis,
//! the variational and the Hamiltonian approach and the balance of one harmonic give the same
//! numbers here; `iteration` has the same Omega by A, but takes A from the speed of its own motion.
//! `harmonic-balance` is the line of that name, over Hertz's depth. For the power law all errors
//! are numbers that depend on n alone: those of the least-squares line of equation (15) are +1.6 %
//! in T and 0 in D.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::super::hertz::{self, DEFAULT_STIFFNESS, positive};
use super::super::linearisation::{self, Rule};
use super::half_oscillation::{HalfOscillation, PerturbationOrder};
use super::line::LineContact;
use super::{
    ContactError, CorrectedPowerLaw, ExactContact, PowerLaw, SineSeries, finite, in_range, within,
};
use crate::decimal::significant;

/// The method that computes the motion in contact. The names are those of tables and problem files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactLaw {
    /// The name of the rule: a line stands for the elastic force.
    Line(Rule),
    /// `homotopy`: one sine, first order of homotopy perturbation.
    Homotopy,
    /// `homotopy-2`: its second order.
    SecondHomotopy,
    /// `iteration`: iteration perturbation, one pass.
    Iteration,
    /// `harmonic-balance-2`: two odd sines.
    TwoHarmonics,
    /// `harmonic-balance-3`: three odd sines.
    ThreeHarmonics,
    /// `power-law`: exact for d^n without other forces.
    PowerLaw,
    /// `power-law-corrected`: the power law with the force at touch and its slope to the second
    /// order.
    CorrectedPowerLaw,
    /// `exact`: by energy and quadrature, for any force.
    Exact,
}

impl ContactLaw {
    /// Every law, in the order of the table.
    pub const ALL: [Self; 14] = [
        Self::Line(Rule::LeastSquares),
        Self::Line(Rule::LeastSquaresThroughTouch),
        Self::Line(Rule::EqualEnergy),
        Self::Line(Rule::EqualPeak),
        Self::Line(Rule::HarmonicBalance),
        Self::Line(Rule::EqualDuration),
        Self::Homotopy,
        Self::Iteration,
        Self::SecondHomotopy,
        Self::TwoHarmonics,
        Self::ThreeHarmonics,
        Self::PowerLaw,
        Self::CorrectedPowerLaw,
        Self::Exact,
    ];

    /// The name in tables and problem files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line(rule) => rule.name(),
            Self::Homotopy => "homotopy",
            Self::SecondHomotopy => "homotopy-2",
            Self::Iteration => "iteration",
            Self::TwoHarmonics => "harmonic-balance-2",
            Self::ThreeHarmonics => "harmonic-balance-3",
            Self::PowerLaw => "power-law",
            Self::CorrectedPowerLaw => "power-law-corrected",
            Self::Exact => "exact",
        }
    }
}

/// The default: the exact motion.
impl Default for ContactLaw {
    fn default() -> Self {
        Self::Exact
    }
}

impl fmt::Display for ContactLaw {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// The error of a name that is not a law of a contact.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "unknown contact law `{0}`: choose exact, power-law-corrected, power-law, harmonic-balance-3, harmonic-balance-2, homotopy-2, \
     iteration, homotopy, or one of the lines least-squares, least-squares-origin, equal-energy, equal-peak-force, harmonic-balance \
     and equal-duration"
)]
pub struct UnknownContactLaw(pub String);

impl FromStr for ContactLaw {
    type Err = UnknownContactLaw;

    fn from_str(name: &str) -> Result<Self, UnknownContactLaw> {
        Self::ALL
            .into_iter()
            .find(|law| law.name() == name)
            .ok_or_else(|| UnknownContactLaw(name.to_owned()))
    }
}

/// The contact problem: d'' + f(x_c + d) + gamma F(d) = 0, d(0) = 0, d'(0) = v.
#[derive(Clone, Copy)]
pub struct Touch<'a> {
    /// The speed v of touch, in the unit of x per time.
    pub speed: f64,
    /// The position x_c of the barrier, in the unit of x.
    pub barrier: f64,
    /// The stiffness gamma of the contact.
    pub stiffness: f64,
    /// f(x), the force other than that of the contact, per unit of mass, positive out of the
    /// barrier.
    pub restoring_force: &'a dyn Fn(f64) -> f64,
    /// f'(x_c), its slope at the barrier, per time squared.
    pub slope: f64,
    /// F(d), the force of the contact per unit of gamma.
    pub elastic_force: &'a dyn Fn(f64) -> f64,
    /// n, if F(d) is proportional to d^n; without it the power laws do not apply.
    pub exponent: Option<f64>,
}

/// The default pendulum at its barrier, at the speed that the energy of its swing gives it.
impl Default for Touch<'_> {
    fn default() -> Self {
        use super::super::model::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER};
        Self {
            speed: (2.0 * (DEFAULT_BARRIER.cos() - DEFAULT_AMPLITUDE.cos())).sqrt(),
            barrier: DEFAULT_BARRIER,
            stiffness: DEFAULT_STIFFNESS,
            restoring_force: &f64::sin,
            slope: DEFAULT_BARRIER.cos(),
            elastic_force: &hertz::elastic_force,
            exponent: Some(1.5),
        }
    }
}

impl Touch<'_> {
    /// The whole force in contact at a depth, per unit of mass.
    pub fn force(&self, depth: f64) -> f64 {
        (self.restoring_force)(self.barrier + depth)
            + self.stiffness * (self.elastic_force)(depth.max(0.0))
    }

    /// The contact by this law.
    ///
    /// # Errors
    /// [`ContactError`]: a quantity outside its domain, a force that does not turn the motion back,
    /// a law that does not apply.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{ContactLaw, Touch};
    ///
    /// let touch = Touch { stiffness: 1e6, speed: 1.0, ..Touch::default() };
    /// let (exact, sines) = (touch.contact_by(ContactLaw::Exact)?, touch.contact_by(ContactLaw::TwoHarmonics)?);
    /// assert!((sines.duration / exact.duration - 1.0).abs() < 2e-3);
    /// assert!((sines.phase_point_at(0.0).1 - 1.0).abs() < 1e-10);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn contact_by(&self, law: ContactLaw) -> Result<ContactMotion, ContactError> {
        positive("speed of contact", self.speed)?;
        positive("stiffness gamma", self.stiffness)?;
        finite("position of the barrier", self.barrier)?;
        finite("force at touch", (self.restoring_force)(self.barrier))?;
        let force = |depth: f64| self.force(depth);
        let half = HalfOscillation { force: &force, speed: self.speed };
        let form = match law {
            ContactLaw::Line(rule) => Form::Line(self.line(rule)?),
            ContactLaw::Homotopy => Form::Sines(half.perturbed(PerturbationOrder::First)?),
            ContactLaw::Iteration => Form::Sines(half.perturbed(PerturbationOrder::Iterated)?),
            ContactLaw::SecondHomotopy => Form::Sines(half.perturbed(PerturbationOrder::Second)?),
            ContactLaw::TwoHarmonics => Form::Sines(half.balanced(2)?),
            ContactLaw::ThreeHarmonics => Form::Sines(half.balanced(3)?),
            ContactLaw::PowerLaw => Form::PowerLaw(self.power_law()?),
            ContactLaw::CorrectedPowerLaw => {
                let preload = (self.restoring_force)(self.barrier);
                Form::Corrected(self.power_law()?.corrected(preload, self.slope, 2)?)
            }
            ContactLaw::Exact => Form::Exact(ExactContact::new(|d| self.force(d), self.speed)?),
        };
        let (depth, duration) = match &form {
            Form::Line(line) => (line.depth(), line.duration()),
            Form::Sines(sines) => (sines.phase_point_at(0.5 * sines.duration).0, sines.duration),
            Form::PowerLaw(contact) => (contact.depth, contact.duration),
            Form::Corrected(contact) => (contact.depth, contact.duration),
            Form::Exact(contact) => (contact.depth, contact.duration),
        };
        Ok(ContactMotion {
            law,
            depth: in_range("depth", depth)?,
            duration: in_range("duration", duration)?,
            peak_force: finite("greatest force", self.force(depth))?,
            form,
        })
    }

    fn power_law(&self) -> Result<PowerLaw, ContactError> {
        let exponent = self.exponent.ok_or(ContactError::NoPowerLaw)?;
        PowerLaw::new(exponent, self.stiffness * (self.elastic_force)(1.0), self.speed)
    }

    /// The contact under the line of the rule, which is fitted over the depth that the elastic
    /// force alone allows.
    fn line(&self, rule: Rule) -> Result<LineContact, ContactError> {
        let energy = 0.5 * self.speed * self.speed / self.stiffness;
        let deepest = linearisation::greatest_depth(self.elastic_force, energy)?;
        let line = linearisation::fit(rule, self.elastic_force, deepest)?;
        let slope = finite("slope of the force", self.slope)?;
        let at_barrier = (self.restoring_force)(self.barrier);
        let contact = LineContact::new(line, self.stiffness, [at_barrier, slope], self.speed);
        contact.ok_or(ContactError::NotOscillating)
    }
}

/// A contact by one of the laws.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ContactMotion {
    /// The law.
    pub law: ContactLaw,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The whole force f(x_c + D) + gamma F(D) at that depth, per unit of mass, by the true forces.
    pub peak_force: f64,
    form: Form,
}

/// The closed form of the motion.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    Line(LineContact),
    Sines(SineSeries),
    PowerLaw(PowerLaw),
    Corrected(CorrectedPowerLaw),
    Exact(ExactContact),
}

impl ContactMotion {
    /// n of a law of the power d^n; `None` for the others.
    pub fn exponent(&self) -> Option<f64> {
        match &self.form {
            Form::PowerLaw(contact) => Some(contact.exponent),
            Form::Corrected(contact) => Some(contact.contact.exponent),
            Form::Line(_) | Form::Sines(_) | Form::Exact(_) => None,
        }
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let time = within(time, self.duration);
        match &self.form {
            Form::Line(line) => line.phase_point_at(time),
            Form::Sines(sines) => sines.phase_point_at(time),
            Form::PowerLaw(contact) => contact.phase_point_at(time),
            Form::Corrected(contact) => contact.phase_point_at(time),
            Form::Exact(contact) => contact.phase_point_at(time),
        }
    }

    /// The depth at a time since touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// The velocity at a time since touch, positive into the barrier.
    pub fn velocity(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    /// The motion, by any law, in elementary functions: a parabola and sines within `tolerance` of
    /// D, if 64 of them suffice.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{ContactLaw, Touch};
    ///
    /// let contact = Touch::default().contact_by(ContactLaw::PowerLaw)?;
    /// let series = contact.sine_series(1e-6);
    /// let time = 0.3 * contact.duration;
    /// assert!((series.phase_point_at(time).0 - contact.position(time)).abs() <= 1e-6 * contact.depth);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn sine_series(&self, tolerance: f64) -> SineSeries {
        let parabola = match &self.form {
            Form::Sines(sines) => return sines.clone(),
            Form::Exact(contact) => return contact.sine_series(tolerance),
            Form::Line(line) => 0.5 * line.centre * line.frequency * line.frequency,
            Form::Corrected(contact) => 0.5 * contact.preload,
            Form::PowerLaw(_) => 0.0,
        };
        SineSeries::from_motion(
            |time| self.position(time),
            self.duration,
            parabola,
            self.depth,
            tolerance,
        )
    }

    /// The formula in the usual form, this many significant digits: s is the time since touch. The
    /// exact motion is written as sines that stay within `tolerance` of D, as far as 64 of them do;
    /// for the power law the time is given as a function of the depth, with I the regularised
    /// incomplete beta function, for the way in.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{ContactLaw, Touch};
    ///
    /// let touch = Touch { stiffness: 1e6, speed: 1.0, ..Touch::default() };
    /// let formula = |law| touch.contact_by(law).map(|motion| motion.closed_form(4, 1e-3));
    /// assert_eq!(formula(ContactLaw::Homotopy)?, "d(s) = 0.004122 sin(242.6 s)");
    /// assert_eq!(formula(ContactLaw::PowerLaw)?, "s = 0.006406 I(x; 0.4, 0.5), x = (d/0.004353)^2.5");
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn closed_form(&self, digits: usize, tolerance: f64) -> String {
        let text = |value: f64| significant(value, digits);
        match &self.form {
            Form::Line(line) => {
                let frequency = text(line.frequency);
                let swing =
                    format!("d(s) = {} sin({frequency} s)", text(line.speed / line.frequency));
                match line.centre {
                    0.0 => swing,
                    centre => {
                        let sign = if centre > 0.0 { '-' } else { '+' };
                        format!("{swing} {sign} {} (1 - cos({frequency} s))", text(centre.abs()))
                    }
                }
            }
            Form::Sines(sines) => sines.closed_form(digits),
            Form::PowerLaw(contact) => {
                let m = contact.exponent + 1.0;
                let (half, depth) = (text(0.5 * contact.duration), text(contact.depth));
                format!("s = {half} I(x; {}, 0.5), x = (d/{depth})^{}", text(1.0 / m), text(m))
            }
            Form::Corrected(contact) => contact.closed_form(digits),
            Form::Exact(contact) => contact.sine_series(tolerance).closed_form(digits),
        }
    }

    /// Errors relative to another contact, the exact one: value over exact value less one.
    pub fn errors(&self, exact: &Self) -> ContactErrors {
        let deviation = (0..=200).map(|part| {
            let time = exact.duration * f64::from(part) / 200.0;
            (self.position(time) - exact.position(time)).abs() / exact.depth
        });
        ContactErrors {
            duration: self.duration / exact.duration - 1.0,
            depth: self.depth / exact.depth - 1.0,
            peak_force: self.peak_force / exact.peak_force - 1.0,
            motion: deviation.fold(0.0, f64::max),
        }
    }
}

/// The errors of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactErrors {
    /// Relative error of the duration, with its sign.
    pub duration: f64,
    /// Relative error of the greatest depth, with its sign.
    pub depth: f64,
    /// Relative error of the greatest force, with its sign.
    pub peak_force: f64,
    /// The largest difference of depth at the same time since touch, relative to the greatest
    /// depth.
    pub motion: f64,
}

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ContactRow {
    /// The law.
    pub law: ContactLaw,
    /// The contact by this law and its errors, or the reason why there is none.
    pub outcome: Result<(ContactMotion, ContactErrors), ContactError>,
}

/// Compares every law with the exact one, in the order of [`ContactLaw::ALL`].
///
/// # Errors
/// [`ContactError`] where there is no exact contact to compare with.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::contact::{ContactLaw, Touch, comparison};
///
/// for row in comparison(&Touch::default())? {
///     let (motion, errors) = row.outcome?;
///     println!("{:20} {:.3e} {:+.2} %", row.law, motion.duration, 100.0 * errors.duration);
/// }
/// # Ok::<(), lindstedt::impact::contact::ContactError>(())
/// ```
pub fn comparison(touch: &Touch) -> Result<Vec<ContactRow>, ContactError> {
    let exact = touch.contact_by(ContactLaw::Exact)?;
    let row = |law| {
        let motion =
            if law == ContactLaw::Exact { Ok(exact.clone()) } else { touch.contact_by(law) };
        ContactRow {
            law,
            outcome: motion.map(|motion| {
                let errors = motion.errors(&exact);
                (motion, errors)
            }),
        }
    };
    Ok(ContactLaw::ALL.into_iter().map(row).collect())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::half_oscillation::HARMONICS;
    use super::*;
    use proptest::prelude::*;
    use spec_math::cephes64::gamma;

    /// A barrier of power n at which nothing else acts.
    fn alone(exponent: f64, force: &dyn Fn(f64) -> f64, stiffness: f64, speed: f64) -> Touch<'_> {
        Touch {
            speed,
            barrier: 0.0,
            stiffness,
            restoring_force: &|_| 0.0,
            slope: 0.0,
            elastic_force: force,
            exponent: Some(exponent),
        }
    }

    /// Errors of duration and depth in percent, by law, for d^n.
    fn percent(exponent: f64, stiffness: f64, speed: f64, law: ContactLaw) -> (f64, f64) {
        let force = move |d: f64| d.powf(exponent);
        let touch = alone(exponent, &force, stiffness, speed);
        let errors =
            touch.contact_by(law).unwrap().errors(&touch.contact_by(ContactLaw::Exact).unwrap());
        (100.0 * errors.duration, 100.0 * errors.depth)
    }

    #[test]
    fn the_lines_of_a_hertz_contact_have_the_errors_of_the_literature() {
        let table = [
            ("least-squares", 1.6, 0.0),
            ("least-squares-origin", 3.1, -3.4),
            ("equal-energy", 6.7, 0.0),
            ("equal-peak-force", -4.5, -10.6),
            ("harmonic-balance", -0.21, -6.5),
            ("equal-duration", 0.0, -6.3),
            ("homotopy", 1.14, -5.2),
            ("power-law", 0.0, 0.0),
        ];
        for (stiffness, speed) in [(1.0, 1e-6), (1e6, 1.0), (1e9, 10.0)] {
            for (law, duration, depth) in table {
                let found = percent(1.5, stiffness, speed, law.parse().unwrap());
                let digit = |expected: f64| {
                    if (expected * 10.0).fract() == 0.0 { 0.051 } else { 0.0051 }
                };
                assert!(
                    (found.0 - duration).abs() < digit(duration),
                    "{law}: duration {}",
                    found.0
                );
                assert!((found.1 - depth).abs() < digit(depth), "{law}: depth {}", found.1);
            }
        }
    }

    #[test]
    fn homotopy_and_iteration_of_a_power_by_gamma_functions() {
        // Omega^2 = gamma (2/sqrt(pi)) Gamma(n/2 + 1)/Gamma((n + 3)/2) A^(n - 1).
        for exponent in [1.0, 1.5, 2.0, 3.0_f64] {
            let factor =
                2.0 / PI.sqrt() * gamma(0.5 * exponent + 1.0) / gamma(0.5 * (exponent + 3.0));
            for (stiffness, speed) in [(1.0, 1e-6), (1e6, 1.0), (1e9, 10.0)] {
                let force = move |d: f64| d.powf(exponent);
                let touch = alone(exponent, &force, stiffness, speed);
                let motion = touch.contact_by(ContactLaw::Homotopy).unwrap();
                let amplitude = (speed * speed / (stiffness * factor)).powf(1.0 / (exponent + 1.0));
                assert!(
                    (motion.depth / amplitude - 1.0).abs() < 1e-12,
                    "{exponent}: {}",
                    motion.depth
                );
                assert!((motion.duration / (PI * amplitude / speed) - 1.0).abs() < 1e-12);
                let iterated = touch.contact_by(ContactLaw::Iteration).unwrap();
                let square = (PI / iterated.duration).powi(2);
                let law = stiffness * factor * iterated.depth.powf(exponent - 1.0);
                assert!((square / law - 1.0).abs() < 1e-12, "{exponent}: {square} against {law}");
            }
        }
        // The cubic, to the last digit: s_3 = -A^3/4, x_1 = (A^3/32 Omega^2)(..), Omega^4 - (3/4)
        // A^2 Omega^2 + (3/128) A^4 = 0.
        let cube = |d: f64| d.powi(3);
        let motion = alone(3.0, &cube, 1.0, 1.0).contact_by(ContactLaw::SecondHomotopy).unwrap();
        let square = (PI / motion.duration).powi(2) / (motion.depth * motion.depth);
        let expected = 0.5 * (0.75 + f64::sqrt(0.75 * 0.75 - 4.0 * 3.0 / 128.0));
        assert!((square / expected - 1.0).abs() < 1e-7, "{square} against {expected}");
    }

    #[test]
    fn the_balance_of_two_harmonics_of_a_cube_is_that_of_its_equations() {
        let cube = |d: f64| d.powi(3);
        let motion = alone(3.0, &cube, 1.0, 1.0).contact_by(ContactLaw::TwoHarmonics).unwrap();
        let Form::Sines(sines) = &motion.form else { panic!("sines") };
        // The cosines of the literature, cos 3 theta = -sin 3 phi.
        let (a1, a3, square) =
            (sines.harmonics[0], -sines.harmonics[1], (PI / sines.duration).powi(2));
        let first = -square * a1 + 0.75 * a1.powi(3) + 0.75 * a1 * a1 * a3 + 1.5 * a1 * a3 * a3;
        let third = -9.0 * square * a3 + 0.25 * a1.powi(3) + 1.5 * a1 * a1 * a3 + 0.75 * a3.powi(3);
        assert!(first.abs() < 1e-9 && third.abs() < 1e-9, "{first} {third}");
        assert!((motion.velocity(0.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn more_work_is_less_error() {
        for exponent in [1.5, 2.0, 3.0] {
            let error = |law| {
                let (duration, depth) = percent(exponent, 1e6, 1.0, law);
                duration.abs().max(depth.abs())
            };
            let (one, two, three) = (
                error(ContactLaw::Homotopy),
                error(ContactLaw::TwoHarmonics),
                error(ContactLaw::ThreeHarmonics),
            );
            assert!(two < 0.3 * one && three < 0.5 * two, "{exponent}: {one} {two} {three}");
            assert!(
                error(ContactLaw::Iteration) < one && error(ContactLaw::SecondHomotopy) < one,
                "{exponent}"
            );
        }
    }

    #[test]
    fn every_law_of_a_spring_is_exact() {
        for (stiffness, speed) in [(1.0, 1e-3), (1e6, 1.0), (1e9, 10.0)] {
            for row in comparison(&alone(1.0, &|d| d, stiffness, speed)).unwrap() {
                let (motion, errors) = row.outcome.unwrap();
                let worst = errors
                    .duration
                    .abs()
                    .max(errors.depth.abs())
                    .max(errors.motion)
                    .max(errors.peak_force.abs());
                assert!(worst < 1e-9, "{}: {errors:?}", row.law);
                assert!((motion.velocity(0.0) / speed - 1.0).abs() < 1e-9 && motion.law == row.law);
            }
        }
    }

    #[test]
    fn every_law_ends_where_it_began_and_meets_its_depth_in_the_middle() {
        let touch = Touch { stiffness: 1e5, ..Touch::default() };
        let rows = comparison(&touch).unwrap();
        assert_eq!(rows.len(), ContactLaw::ALL.len());
        for row in rows {
            let (motion, errors) = row.outcome.unwrap();
            let law = row.law;
            let [start, middle, end] =
                [0.0, 0.5, 1.0].map(|part| motion.phase_point_at(part * motion.duration));
            assert!(
                start.0.abs() < 1e-12 && end.0.abs() < 1e-12 * motion.depth.max(1.0),
                "{law}: {start:?} {end:?}"
            );
            assert!(
                (start.1 + end.1).abs() < 1e-9 && middle.1.abs() < 1e-9,
                "{law}: {start:?} {middle:?} {end:?}"
            );
            assert!((middle.0 / motion.depth - 1.0).abs() < 1e-9, "{law}: {middle:?}");
            assert!((motion.position(0.1), motion.velocity(0.1)) == motion.phase_point_at(0.1));
            let known = matches!(law, ContactLaw::CorrectedPowerLaw);
            assert!(
                (start.1 / touch.speed - 1.0).abs() < if known { 1e-2 } else { 1e-9 },
                "{law}: {start:?}"
            );
            assert!(errors.motion < 0.25 && errors.duration.abs() < 0.1, "{law}: {errors:?}");
        }
        let corrected = touch.contact_by(ContactLaw::CorrectedPowerLaw).unwrap();
        let (exact, plain) = (
            touch.contact_by(ContactLaw::Exact).unwrap(),
            touch.contact_by(ContactLaw::PowerLaw).unwrap(),
        );
        let (with, without) = (corrected.errors(&exact), plain.errors(&exact));
        assert!(
            with.duration.abs() < 1e-2 * without.duration.abs()
                && with.depth.abs() < 1e-2 * without.depth.abs()
        );
    }

    #[test]
    fn a_soft_barrier_and_a_slow_touch_have_their_rows_or_a_reason() {
        for (barrier, stiffness, speed) in [
            (0.323, 1.0, 1.0),
            (0.323, 1e6, 1e-6),
            (-0.4, 1.0, 0.5),
            (-0.4, 1e6, 1e-3),
            (-1.2, 1.0, 1e-3),
        ] {
            let touch =
                Touch { barrier, stiffness, speed, slope: f64::cos(barrier), ..Touch::default() };
            for row in comparison(&touch).unwrap() {
                match row.outcome {
                    Ok((motion, errors)) => {
                        assert!(
                            errors.motion.is_finite() && motion.duration > 0.0,
                            "{}: {errors:?}",
                            row.law
                        );
                    }
                    Err(error) => {
                        assert!(
                            error.to_string().contains("exact contact"),
                            "{}: {error}",
                            row.law
                        );
                        assert!(row.law != ContactLaw::Exact);
                    }
                }
            }
        }
    }

    #[test]
    fn formulas_are_those_of_the_motion() {
        let touch = Touch { stiffness: 1e4, speed: 1.0, ..Touch::default() };
        for row in comparison(&touch).unwrap() {
            let (motion, _) = row.outcome.unwrap();
            let formula = motion.closed_form(5, 1e-3);
            let waves = formula.matches("sin(").count();
            let expected = match row.law {
                ContactLaw::Line(_) | ContactLaw::Homotopy => 1,
                ContactLaw::TwoHarmonics => 2,
                ContactLaw::ThreeHarmonics | ContactLaw::Exact => 3,
                ContactLaw::Iteration | ContactLaw::SecondHomotopy => HARMONICS,
                ContactLaw::PowerLaw | ContactLaw::CorrectedPowerLaw => 0,
            };
            assert_eq!(waves, expected, "{}: {formula}", row.law);
            assert!(!formula.contains("NaN") && formula.contains("s"), "{formula}");
        }
        let line = touch.contact_by(ContactLaw::Line(Rule::LeastSquares)).unwrap();
        let Form::Line(turn) = &line.form else { panic!("a line") };
        assert!(turn.centre < 0.0 && line.closed_form(5, 1e-3).contains(" + "));
        let corrected =
            touch.contact_by(ContactLaw::CorrectedPowerLaw).unwrap().closed_form(4, 1e-3);
        assert!(
            corrected.starts_with("d(s) = 0.1587 s (0.0") && corrected.contains(" Y(s/0.0"),
            "{corrected}"
        );
    }

    #[test]
    fn names_read_back() {
        for law in ContactLaw::ALL {
            assert_eq!(law.to_string().parse(), Ok(law));
        }
        let unknown = "hertz".parse::<ContactLaw>().unwrap_err().to_string();
        assert!(ContactLaw::ALL.into_iter().all(|law| unknown.contains(law.name())), "{unknown}");
        assert_eq!(ContactLaw::default(), ContactLaw::Exact);
    }

    #[test]
    fn what_is_no_contact_is_refused() {
        for law in ContactLaw::ALL {
            for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                assert!(
                    Touch { speed: bad, ..Touch::default() }.contact_by(law).is_err(),
                    "{law} at {bad}"
                );
                assert!(
                    Touch { stiffness: bad, ..Touch::default() }.contact_by(law).is_err(),
                    "{law} at {bad}"
                );
            }
            for bad in [f64::NAN, f64::INFINITY] {
                assert!(
                    Touch { barrier: bad, ..Touch::default() }.contact_by(law).is_err(),
                    "{law} at {bad}"
                );
                // Only a line and the correction ask for the slope.
                let asks = matches!(law, ContactLaw::Line(_) | ContactLaw::CorrectedPowerLaw);
                let found = Touch { slope: bad, ..Touch::default() }.contact_by(law);
                assert_eq!(found.is_err(), asks, "{law} at {bad}");
            }
            let nowhere: &dyn Fn(f64) -> f64 = &|_| f64::NAN;
            let refused = Touch { elastic_force: nowhere, ..Touch::default() }.contact_by(law);
            assert!(refused.is_err(), "{law}");
        }
        let unnamed = Touch { exponent: None, ..Touch::default() };
        assert_eq!(unnamed.contact_by(ContactLaw::PowerLaw), Err(ContactError::NoPowerLaw));
        assert!(unnamed.contact_by(ContactLaw::Exact).is_ok());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn no_number_makes_it_panic_or_lie(
            barrier in -3.0..3.0_f64, stiffness in -12.0..12.0_f64, speed in -30.0..4.0_f64, exponent in 0.1..6.0_f64,
            time in any::<f64>()
        ) {
            let force = move |d: f64| d.powf(exponent);
            let touch = Touch {
                barrier,
                stiffness: 10.0_f64.powf(stiffness),
                speed: 10.0_f64.powf(speed),
                slope: barrier.cos(),
                elastic_force: &force,
                exponent: Some(exponent),
                ..Touch::default()
            };
            for law in ContactLaw::ALL {
                if let Ok(motion) = touch.contact_by(law) {
                    let (depth, velocity) = motion.phase_point_at(time);
                    prop_assert!(depth.is_finite() && velocity.is_finite(), "{law}: {depth} {velocity}");
                    prop_assert!(motion.peak_force.is_finite() && motion.depth > 0.0 && motion.duration > 0.0);
                }
            }
        }
    }
}
