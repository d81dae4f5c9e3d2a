//! The input of `simulate` from a file with a main mass, `[primary]`.

use super::document::{Pendulum, PrimarySection};
use super::simulate::message_of_missing_key;
use super::{Problem, ProblemError, refused};
use crate::impact::hertz::StiffnessDesign;
use crate::impact::primary::{MainMass, Primary, PrimaryCase, PrimaryParameter, PrimarySettings};
use crate::impact::{Case, Parameter, Start, Units};

/// A main mass with its pendulum, and the settings of the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimaryProblem {
    /// Both bodies and their initial state.
    pub case: PrimaryCase,
    /// Duration and accuracy.
    pub settings: PrimarySettings,
    /// The units of the numbers.
    pub units: Units,
}

/// The default duration, in units of 1/omega: long enough for the main mass to come to rest with
/// the damper locked and without, up to a limit.
pub(super) fn long_enough(primary: &Primary) -> f64 {
    const USUAL: f64 = 300.0;
    const LONGEST: f64 = 3000.0;
    let others = primary.undamped_and_locked();
    let rests = [others.locked.rest_time, others.without.rest_time].into_iter().flatten();
    rests.fold(USUAL, |longest, rest| longest.max(1.2 * rest)).min(LONGEST)
}

impl Problem {
    /// The main mass of the file with its pendulum, in the units of equation (7), as if the file
    /// gave the values of `varied` too. The pendulum hangs at rest unless the file says otherwise.
    ///
    /// # Errors
    /// [`ProblemError`] names the key.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02".parse()?;
    /// let asked = file.primary_case(&[])?;
    /// assert!((asked.case.primary.mass - 50.0).abs() < 1e-12); // fifty times the 11.2 g of the paper's sphere
    /// let heavier = file.primary_case(&[("mass_ratio".parse()?, 60.0)])?;
    /// assert!((heavier.case.primary.mass - 60.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn primary_case(
        &self,
        varied: &[(PrimaryParameter, f64)],
    ) -> Result<PrimaryProblem, ProblemError> {
        self.refuse_tolerance_of_main_mass()?;
        if self.given.iter().any(|key| key.starts_with("[excitation]")) {
            return refused(
                "[excitation] moves the pivot, which a main mass carries: give [primary] force and frequency instead",
            );
        }
        // If the file does not give a start, the pendulum hangs at rest.
        let of_pendulum: Vec<(Parameter, f64)> = varied
            .iter()
            .filter_map(|(parameter, value)| match parameter {
                PrimaryParameter::Pendulum(parameter) => Some((*parameter, *value)),
                _ => None,
            })
            .collect();
        let swept: Vec<Parameter> = of_pendulum.iter().map(|(parameter, _)| *parameter).collect();
        let starts = [Parameter::Amplitude, Parameter::Start, Parameter::Speed];
        let hanging =
            Self { pendulum: Pendulum { start: Some(0.0), ..self.pendulum }, ..self.clone() };
        let start_is_swept = starts.iter().any(|start| swept.contains(start));
        let file = match self.hangs_at_rest() && !start_is_swept {
            true => &hanging,
            false => self,
        };
        let mut case = file.simulate(&swept)?.case;
        for (parameter, value) in of_pendulum {
            case.set(parameter, value);
        }
        let (model, Start { x, velocity }) = case.motion()?;
        let units = in_si(&case.design);
        let main_mass = self.primary.unwrap_or_default().with(varied, &units)?.main_mass()?;
        let case = main_mass.carrying(&units, model, Start { x, velocity });
        let primary = case.primary;
        if primary.force == 0.0 && case.start.iter().all(|value| *value == 0.0) {
            return at_rest();
        }
        let usual = PrimarySettings::default();
        let given = |key: &str| self.has_key(&format!("[run] {key}"));
        Ok(PrimaryProblem {
            case,
            settings: PrimarySettings {
                duration: match given("duration") {
                    true => self.run.duration,
                    false => long_enough(&primary),
                },
                phase_limit: if given("step_limit") {
                    usize::try_from(self.run.step_limit).unwrap_or(usize::MAX)
                } else {
                    usual.phase_limit
                },
                ..usual
            },
            units,
        })
    }
}

/// The error of a main mass and a pendulum that are both at rest.
fn at_rest<T>() -> Result<T, ProblemError> {
    refused(
        "nothing moves: give [primary] a displacement, a speed or a force, or [pendulum] a start",
    )
}

impl Problem {
    /// The main mass of this section, which carries the pendulum of `case`; that hangs at rest unless
    /// the file gives it a start.
    ///
    /// # Errors
    /// [`ProblemError`] names the key; nothing moves.
    pub(super) fn main_mass_carrying(
        &self,
        section: &PrimarySection,
        case: &mut Case,
    ) -> Result<MainMass, ProblemError> {
        let main_mass = section.main_mass()?;
        self.refuse_tolerance_of_main_mass()?;
        if self.hangs_at_rest() {
            case.start = Some(0.0);
            case.speed = 0.0;
        }
        let pendulum = [case.start.unwrap_or(case.amplitude), case.speed];
        let moving = [main_mass.displacement, main_mass.speed].into_iter().chain(pendulum);
        match moving.into_iter().all(|value| value == 0.0) {
            true => at_rest(),
            false => Ok(main_mass),
        }
    }

    /// Refuses a tolerance, which would have no effect.
    pub(super) fn refuse_tolerance_of_main_mass(&self) -> Result<(), ProblemError> {
        match self.has_key("[run] integrator_tolerance") {
            true => refused(
                "`[run] integrator_tolerance` changes nothing beside [primary], which is followed to rounding accuracy: leave it out",
            ),
            false => Ok(()),
        }
    }

    /// Whether the pendulum of a main mass initially hangs at rest, because the file gives no
    /// start.
    pub(super) fn hangs_at_rest(&self) -> bool {
        let starts = ["amplitude", "start", "speed"].map(|key| format!("[pendulum] {key}"));
        !starts.iter().any(|key| self.has_key(key))
    }
}

/// The units of a design.
pub(super) fn in_si(design: &StiffnessDesign) -> Units {
    Units {
        mass: design.mass,
        length: design.length,
        gravity: design.gravity,
        radius: None,
        modulus: None,
        sphere_yield: None,
        barrier_yield: None,
    }
}

fn no_such_number<T>(key: &str, wanted: &str, value: f64) -> Result<T, ProblemError> {
    refused(format!("[primary] {key} must be {wanted}, not {value}"))
}

impl PrimarySection {
    /// This section with other values of some of its keys.
    ///
    /// # Errors
    /// The mass in two forms, or a ratio of masses that is not positive.
    fn with(
        mut self,
        varied: &[(PrimaryParameter, f64)],
        units: &Units,
    ) -> Result<Self, ProblemError> {
        for (parameter, value) in varied {
            let key = match parameter {
                PrimaryParameter::Mass | PrimaryParameter::MassRatio => &mut self.mass,
                PrimaryParameter::Stiffness => &mut self.stiffness,
                PrimaryParameter::Damping => &mut self.damping,
                PrimaryParameter::Displacement => &mut self.displacement,
                PrimaryParameter::Speed => &mut self.speed,
                PrimaryParameter::Force => &mut self.force,
                PrimaryParameter::Frequency => &mut self.frequency,
                PrimaryParameter::Pendulum(_) => continue,
            };
            *key = Some(*value);
            if *parameter == PrimaryParameter::MassRatio {
                let other = |(other, _): &(PrimaryParameter, f64)| *other == PrimaryParameter::Mass;
                if varied.iter().any(other) {
                    return refused(
                        "`primary.mass` and `mass_ratio` say the same: sweep one of them",
                    );
                }
                if *value <= 0.0 {
                    return no_such_number("mass_ratio", "a positive number", *value);
                }
                *key = Some(value * units.mass);
            }
        }
        Ok(self)
    }

    /// The main mass that it describes.
    ///
    /// # Errors
    /// A key that is missing, that needs another one, or whose number is not admissible.
    pub(super) fn main_mass(&self) -> Result<MainMass, ProblemError> {
        let missing = |key: &str| {
            let units = "the mass of the main mass in kg and the stiffness of its spring in N/m";
            let example =
                "[primary] mass = 0.5, stiffness = 72, damping = 0.05, displacement = 0.02";
            ProblemError::new(format!("[primary] needs `{key}`: {units}"))
                .with_help(example.to_owned())
        };
        let mass = self.mass.ok_or_else(|| missing("mass"))?;
        let stiffness = self.stiffness.ok_or_else(|| missing("stiffness"))?;
        let pair = ["[primary] force", "[primary] frequency"];
        match (self.force, self.frequency) {
            (Some(_), None) => return refused(message_of_missing_key(pair[0], &pair[1])),
            (None, Some(_)) => return refused(message_of_missing_key(pair[1], &pair[0])),
            _ => {}
        }
        let least = [
            ("mass", Some(mass), f64::MIN_POSITIVE),
            ("stiffness", Some(stiffness), f64::MIN_POSITIVE),
            ("damping", self.damping, 0.0),
            ("frequency", self.frequency, 0.0),
            ("force", self.force, f64::MIN),
            ("displacement", self.displacement, f64::MIN),
            ("speed", self.speed, f64::MIN),
        ];
        let wrong = |value: f64, least: f64| !(value >= least && value.is_finite());
        for (key, value, least) in least {
            if let Some(value) = value.filter(|value| wrong(*value, least)) {
                let wanted = match least {
                    0.0 => "a number, 0 or more",
                    least if least > 0.0 => "a positive number",
                    _ => "a number",
                };
                return no_such_number(key, wanted, value);
            }
        }
        Ok(MainMass {
            mass,
            stiffness,
            damping: self.damping.unwrap_or(0.0),
            displacement: self.displacement.unwrap_or(0.0),
            speed: self.speed.unwrap_or(0.0),
            force: self.force.unwrap_or(0.0),
            frequency: self.frequency.unwrap_or(0.0),
        })
    }
}
