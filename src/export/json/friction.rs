//! Kind `friction`: equation (6) beside Coulomb's law.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::text;
use crate::audit::paper::{FrictionTable, PrintedDigits};
use crate::impact::STEEPNESS;
use crate::impact::friction::{CreepSample, FirstCycle, FrictionStudy};

/// The paper's equation (6), (2/pi) atan(100 x') in place of Coulomb's sgn(x'), beside that law:
/// Table 1 of the paper, and a swing near rest. Angles are in radians, time is in units of 1/omega
/// of small swings, sqrt(L/g).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct FrictionDocument {
    /// The kind of document.
    pub schema: String,
    /// The friction alpha, the torque in units of m g L.
    pub alpha: f64,
    /// The release, from rest at x = -amplitude, in radians.
    pub amplitude: f64,
    /// The factor of the velocity in the arctangent.
    pub steepness: f64,
    /// The two laws at the paper's speeds, then at those asked for.
    pub speeds: Vec<Speed>,
    /// The number of entries that the paper prints, values and errors.
    pub printed_entries: usize,
    /// The value of pi with which most of them come out, by its name in `readings`.
    pub pi: String,
    /// The least and the greatest pi with which all of them come out, rounded or cut; null where
    /// none does.
    pub pi_range: Option<[f64; 2]>,
    /// Every value of pi that was tried.
    pub readings: Vec<PiReading>,
    /// The first cycle of the swing by the arctangent.
    pub first_cycle: FirstCycle,
    /// Where Coulomb's law stops the swing for good.
    pub stop: Stop,
    /// What the arctangent does from rest at that place.
    pub creep: Creep,
    /// The rest times on the paper's damper, pendulum and barrier, with this friction alone.
    pub rest_time: RestTime,
}

/// The two laws at one speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Speed {
    /// The speed, in radians per unit of time.
    pub speed: f64,
    /// Coulomb's law, sgn(x').
    pub sign: f64,
    /// Equation (6), with pi itself.
    pub arctangent: f64,
    /// How far it is from Coulomb's law, in per cent.
    pub error: f64,
    /// The value that the paper prints; null at a speed that is not the paper's.
    pub printed_value: Option<Printed>,
    /// The error in per cent that the paper prints; null likewise.
    pub printed_error: Option<Printed>,
}

/// A number that the paper prints, and how its digits come out with the best value of pi.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Printed {
    /// The number as it is printed.
    pub text: String,
    /// Whether its digits are those of the rounded number.
    pub rounded: bool,
    /// Whether its digits are those of the number cut off.
    pub cut: bool,
}

/// How many of the printed entries come out with one value of pi.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PiReading {
    /// The value as it is written, such as `22/7`.
    pub pi: String,
    /// The value.
    pub value: f64,
    /// The number of entries that come out rounded.
    pub rounded: usize,
    /// The number of entries that come out cut off.
    pub cut: usize,
    /// The number of entries that come out in one of the two ways.
    pub either: usize,
    /// What the arctangent tends to at high speed.
    pub limit: f64,
    /// The speed beyond which it is larger than 1, in radians per unit of time; null where there is
    /// none.
    pub exceeds_from: Option<f64>,
}

/// Where Coulomb's law stops the swing for good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Stop {
    /// When, in units of time.
    pub t: f64,
    /// Where, in radians.
    pub x: f64,
    /// After how many half swings.
    pub half_swings: usize,
    /// Where the arctangent has taken the swing by then, in radians.
    pub arctangent_x: f64,
    /// The velocity by the arctangent, in radians per unit of time.
    pub arctangent_velocity: f64,
}

/// The motion by the arctangent near rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Creep {
    /// The linear damping c near rest, x'' + c x' + x = 0: 200 alpha/pi.
    pub damping: f64,
    /// Whether it creeps, c > 2; it swings about zero otherwise.
    pub creeps: bool,
    /// The rate without inertia, pi/(200 alpha), per unit of time; null where it swings.
    pub rate_overdamped: Option<f64>,
    /// The rate of the linear equation, per unit of time.
    pub rate_linear: f64,
    /// The rate of the simulated motion when it is small, per unit of time; null where it does not
    /// move.
    pub rate: Option<f64>,
    /// Some states.
    pub samples: Vec<CreepSample>,
}

/// Rest times by either law, in units of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct RestTime {
    /// By Coulomb's law; null where there is none.
    pub coulomb: Option<f64>,
    /// Why there is none, in words; null where there is one.
    pub coulomb_reason: Option<String>,
    /// By the arctangent; null where there is none.
    pub arctangent: Option<f64>,
    /// Why there is none, in words; null where there is one.
    pub arctangent_reason: Option<String>,
    /// How much later the arctangent comes to rest; null where one of them does not.
    pub difference: Option<f64>,
}

/// The document of kind `friction`.
///
/// ```
/// use lindstedt::impact::friction::{FrictionSetup, study};
///
/// let study = study(FrictionSetup::default())?;
/// let document = lindstedt::export::json::friction(&study);
/// assert_eq!((document.pi.as_str(), document.speeds.len()), ("3.14", 11));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn friction(study: &FrictionStudy) -> FrictionDocument {
    let (table, near_rest) = (FrictionTable::from_study(study), &study.near_rest);
    let speeds = table.rows.iter().map(|row| {
        let [value, error] =
            row.printed.map_or([None, None], |entries| entries.map(|entry| Some(printed(entry))));
        Speed {
            speed: row.laws.speed,
            sign: row.laws.sign,
            arctangent: row.laws.arctangent,
            error: row.laws.error,
            printed_value: value,
            printed_error: error,
        }
    });
    let readings = table.readings.iter().map(|reading| PiReading {
        pi: reading.name.to_owned(),
        value: reading.value,
        rounded: reading.rounded,
        cut: reading.cut,
        either: reading.either,
        limit: reading.limit(),
        exceeds_from: reading.exceeds_from(),
    });
    let creep = &near_rest.creep;
    let times = near_rest.rest_times;
    FrictionDocument {
        schema: DocumentKind::Friction.schema().to_owned(),
        alpha: study.setup.alpha,
        amplitude: study.setup.amplitude,
        steepness: STEEPNESS,
        speeds: speeds.collect(),
        printed_entries: table.entries(),
        pi: table.best().name.to_owned(),
        pi_range: table.pi_range,
        readings: readings.collect(),
        first_cycle: near_rest.first_cycle,
        stop: Stop {
            t: near_rest.stop.t,
            x: near_rest.stop.x,
            half_swings: near_rest.half_swings,
            arctangent_x: near_rest.meanwhile[0],
            arctangent_velocity: near_rest.meanwhile[1],
        },
        creep: Creep {
            damping: creep.damping,
            creeps: creep.creeps,
            rate_overdamped: creep.rate_overdamped,
            rate_linear: creep.rate_linear,
            rate: creep.rate,
            samples: creep.samples.clone(),
        },
        rest_time: RestTime {
            coulomb: times.coulomb.ok(),
            coulomb_reason: text(times.coulomb.err()),
            arctangent: times.arctangent.ok(),
            arctangent_reason: text(times.arctangent.err()),
            difference: times.difference(),
        },
    }
}

fn printed(entry: PrintedDigits) -> Printed {
    Printed { text: entry.printed.to_owned(), rounded: entry.rounded, cut: entry.cut }
}
