//! Objectives and limits: one row each.

use super::design::EvaluatedDesign;

/// A quantity of a design that may be minimised or limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objective {
    /// The rest time of the pendulum in seconds.
    RestTime,
    /// The rest time in units of 1/omega of the small swings.
    DimensionlessRestTime,
    /// The greatest force of a contact.
    PeakForce,
    /// The greatest pressure of a contact.
    PeakPressure,
    /// The mass of the pendulum.
    Mass,
    /// The contacts until it rests.
    Impacts,
    /// The rest time of the main mass that carries the pendulum, in seconds.
    PrimaryRestTime,
}

/// Name, unit, meaning and value of an objective.
type ObjectiveRow = (&'static str, &'static str, &'static str, fn(&EvaluatedDesign) -> Option<f64>);

impl Objective {
    /// Every objective, in the order of the documentation.
    pub const ALL: [Self; 7] = [
        Self::RestTime,
        Self::DimensionlessRestTime,
        Self::PeakForce,
        Self::PeakPressure,
        Self::Mass,
        Self::Impacts,
        Self::PrimaryRestTime,
    ];

    fn row(self) -> ObjectiveRow {
        match self {
            Self::RestTime => ("rest_time", "s", "the rest time", |design| {
                Some(design.rest_time.ok()? * design.units.time())
            }),
            Self::DimensionlessRestTime => (
                "dimensionless_rest_time",
                "1/omega",
                "the rest time in units of 1/omega",
                |design| design.rest_time.ok(),
            ),
            Self::PeakForce => ("peak_force", "N", "the greatest force of a contact", |design| {
                Some(design.hardest.map_or(0.0, |contact| contact.force))
            }),
            Self::PeakPressure => {
                ("peak_pressure", "Pa", "the greatest pressure of Hertz in a contact", |design| {
                    Some(design.hardest.map_or(0.0, |contact| contact.pressure))
                })
            }
            Self::Mass => {
                ("mass", "kg", "the mass of the pendulum", |design| Some(design.case.design.mass))
            }
            Self::Impacts => {
                ("impacts", "", "the contacts until it rests", |design| Some(design.impacts as f64))
            }
            Self::PrimaryRestTime => {
                ("primary_rest_time", "s", "the rest time of the main mass", |design| {
                    design.primary_rest_time?.ok()
                })
            }
        }
    }

    /// `rest_time`
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Its unit, as it is typed; empty if it has none.
    pub fn unit(self) -> &'static str {
        self.row().1
    }

    /// The meaning in words: `the rest time`.
    pub fn meaning(self) -> &'static str {
        self.row().2
    }

    /// Its value for a design; `None` if it has none.
    pub fn value(self, design: &EvaluatedDesign) -> Option<f64> {
        (self.row().3)(design).filter(|value| value.is_finite())
    }

    /// Whether it needs the hardest contact.
    pub(super) fn is_of_contact(self) -> bool {
        matches!(self, Self::PeakForce | Self::PeakPressure)
    }

    /// Whether it is a quantity of the main mass.
    pub fn is_of_main_mass(self) -> bool {
        self == Self::PrimaryRestTime
    }

    /// Whether it is the rest time of the pendulum, in either unit.
    pub fn is_rest_time(self) -> bool {
        matches!(self, Self::RestTime | Self::DimensionlessRestTime)
    }

    /// The objective of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|objective| objective.name() == name)
    }
}
