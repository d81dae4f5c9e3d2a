//! The rows of the points of a study, as they stand in a line of kind `point`: everything that the
//! result of the whole study needs of a point, to the last bit.
//!
//! One type for each command: [`SweepPoint`], [`MotionPoint`], [`PrimaryPoint`], [`MaterialPoint`],
//! [`ClaimPoint`]; a run of a search is a [`Run`](super::optimization::Run).

use serde::{Deserialize, Serialize};

use crate::audit::{
    Claim, ClaimAttempt, ClaimFinding, Computed, NotComputable, RequiredValue, Supposition, Verdict,
};
use crate::expr::parse_expression;
use crate::impact::primary::{PrimaryCase, PrimaryRow, PrimaryStop};
use crate::impact::sweep::Summary;
use crate::impact::{
    ContactRecord, FirstContact, MaterialMotions, MotionToRest, NoRest, SimulationStop,
};
use crate::system::PathEnd;
use crate::trajectory::{Crossing, SweptMotion, in_words};

/// A number, which JSON has only where it is finite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AnyNumber {
    /// A finite number.
    Finite(f64),
    /// `inf`, `-inf` or `NaN`.
    Word(String),
}

impl From<f64> for AnyNumber {
    fn from(value: f64) -> Self {
        match value.is_finite() {
            true => Self::Finite(value),
            false => Self::Word(value.to_string()),
        }
    }
}

impl AnyNumber {
    fn read(&self) -> Option<f64> {
        match self {
            Self::Finite(value) => Some(*value),
            Self::Word(word) => word.parse().ok(),
        }
    }
}

fn numbers(values: &[f64]) -> Vec<AnyNumber> {
    values.iter().copied().map(AnyNumber::from).collect()
}

fn read_numbers(values: &[AnyNumber]) -> Option<Vec<f64>> {
    values.iter().map(AnyNumber::read).collect()
}

/// A rest time in units of time, or the name of the reason why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum RestOrReason {
    /// The time.
    Time(f64),
    /// The reason.
    Reason(NoRest),
}

impl From<Result<f64, NoRest>> for RestOrReason {
    fn from(found: Result<f64, NoRest>) -> Self {
        found.map_or_else(Self::Reason, Self::Time)
    }
}

impl From<RestOrReason> for Result<f64, NoRest> {
    fn from(found: RestOrReason) -> Self {
        match found {
            RestOrReason::Time(time) => Ok(time),
            RestOrReason::Reason(reason) => Err(reason),
        }
    }
}

/// A motion of a sweep of equation (7); units as in a document of kind `sweep`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// The number of contacts.
    pub impacts: usize,
    /// The rest time.
    pub rest_time: RestOrReason,
    /// The rest time without a barrier; null where it was not asked for.
    pub rest_no_barrier: Option<RestOrReason>,
    /// The rest time with a barrier that loses nothing; null where it was not asked for.
    pub rest_lossless: Option<RestOrReason>,
    /// The greatest depth in a barrier.
    pub penetration: AnyNumber,
    /// The greatest speed at a touch.
    pub speed_in: AnyNumber,
    /// The energy lost in contacts.
    pub energy_lost: AnyNumber,
    /// Time, displacement and velocity at the end.
    pub end: [AnyNumber; 3],
    /// The reason why it ended.
    pub stop: SimulationStop,
}

impl SweepPoint {
    /// The row of a motion.
    pub fn from_summary(summary: &Summary) -> Self {
        let [without, lossless] = match summary.baseline {
            Some(baseline) => baseline.map(|time| Some(RestOrReason::from(time))),
            None => [None, None],
        };
        Self {
            impacts: summary.impacts,
            rest_time: summary.rest_time.into(),
            rest_no_barrier: without,
            rest_lossless: lossless,
            penetration: summary.deepest.into(),
            speed_in: summary.fastest.into(),
            energy_lost: summary.energy_lost.into(),
            end: [summary.end_time, summary.end_x, summary.end_velocity].map(AnyNumber::from),
            stop: summary.stop,
        }
    }

    /// The summary again; `None` if a number is none.
    pub fn read(&self) -> Option<Summary> {
        let [end_time, end_x, end_velocity] = &self.end;
        let baseline = self.rest_no_barrier.zip(self.rest_lossless);
        Some(Summary {
            impacts: self.impacts,
            rest_time: self.rest_time.into(),
            baseline: baseline.map(|(without, lossless)| [without.into(), lossless.into()]),
            deepest: self.penetration.read()?,
            fastest: self.speed_in.read()?,
            energy_lost: self.energy_lost.read()?,
            end_time: end_time.read()?,
            end_x: end_x.read()?,
            end_velocity: end_velocity.read()?,
            stop: self.stop,
        })
    }
}

/// A motion of a sweep of an equation or a mechanism.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionPoint {
    /// The time at which it ended.
    pub end: AnyNumber,
    /// Coordinates, then velocities there.
    pub state: Vec<AnyNumber>,
    /// The least and the greatest value of each coordinate.
    pub extremes: Vec<[AnyNumber; 2]>,
    /// The states on the section, each after its time.
    pub crossings: Vec<(AnyNumber, Vec<AnyNumber>)>,
    /// The times at which it touches the section without crossing it.
    pub touches: Vec<AnyNumber>,
    /// The number of impacts on walls.
    #[serde(default)]
    pub impacts: usize,
    /// The number of events.
    #[serde(default)]
    pub events: usize,
    /// The reason why it ended, in words.
    pub stopped: String,
}

impl MotionPoint {
    /// The row of a motion.
    pub fn from_motion(motion: &SweptMotion) -> Self {
        let crossing = |crossing: &Crossing| (crossing.time.into(), numbers(&crossing.state));
        Self {
            end: motion.end.into(),
            state: numbers(&motion.state),
            extremes: motion.extremes.iter().map(|ends| ends.map(AnyNumber::from)).collect(),
            crossings: motion.crossings.iter().map(crossing).collect(),
            touches: numbers(&motion.touches),
            impacts: motion.impacts,
            events: motion.events,
            stopped: in_words(motion.reason).to_owned(),
        }
    }

    /// The motion at these values of what varies; `None` if a number is none.
    pub fn read(&self, values: Vec<f64>) -> Option<SweptMotion> {
        const ENDS: [PathEnd; 10] = [
            PathEnd::Reached,
            PathEnd::Event(0),
            PathEnd::StepLimit,
            PathEnd::Singular,
            PathEnd::Overflow,
            PathEnd::Sticks,
            PathEnd::PassesWall,
            PathEnd::EventsAccumulate,
            PathEnd::NoReset,
            PathEnd::Interrupted,
        ];
        let crossing = |(time, state): &(AnyNumber, Vec<AnyNumber>)| {
            Some(Crossing { time: time.read()?, state: read_numbers(state)? })
        };
        Some(SweptMotion {
            values,
            end: self.end.read()?,
            state: read_numbers(&self.state)?,
            extremes: self
                .extremes
                .iter()
                .map(|[least, greatest]| Some([least.read()?, greatest.read()?]))
                .collect::<Option<_>>()?,
            crossings: self.crossings.iter().map(crossing).collect::<Option<_>>()?,
            touches: read_numbers(&self.touches)?,
            impacts: self.impacts,
            events: self.events,
            reason: ENDS.into_iter().find(|end| in_words(*end) == self.stopped)?,
        })
    }
}

/// A motion of a sweep of a main mass; units as in a document of kind `primary-sweep`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrimaryPoint {
    /// The time at which it ended.
    pub end: AnyNumber,
    /// The largest displacement of the main mass in the long run.
    pub amplitude: AnyNumber,
    /// The number of impacts then.
    pub impacts: usize,
    /// The number of impacts in the whole run.
    pub all_impacts: usize,
    /// The rest time.
    pub rest_time: RestOrReason,
    /// The reason why it ended.
    pub stop: PrimaryStop,
}

impl PrimaryPoint {
    /// The row of a motion.
    pub fn from_row(row: &PrimaryRow) -> Self {
        Self {
            end: row.end.into(),
            amplitude: row.amplitude.into(),
            impacts: row.impacts,
            all_impacts: row.all_impacts,
            rest_time: row.rest_time.into(),
            stop: row.stop,
        }
    }

    /// The result of this case again; `None` if a number is none.
    pub fn read(&self, case: &PrimaryCase) -> Option<PrimaryRow> {
        Some(PrimaryRow {
            primary: case.primary,
            end: self.end.read()?,
            amplitude: self.amplitude.read()?,
            impacts: self.impacts,
            all_impacts: self.all_impacts,
            rest_time: self.rest_time.into(),
            others: case.primary.undamped_and_locked(),
            stop: self.stop,
        })
    }
}

/// A material; units as in a document of kind `materials`, angles in radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialPoint {
    /// The first contact; null where the barrier is not touched, or not left again.
    pub first_contact: Option<FirstContact>,
    /// The rest time.
    pub rest_time: RestOrReason,
    /// The contacts until then.
    pub impacts: Vec<ContactRecord>,
    /// The energy of the swing after each of them that ended.
    pub energies: Vec<AnyNumber>,
    /// The reason why it was followed no further.
    pub stop: SimulationStop,
    /// The least and the greatest rest time of starts nearby; null where it is not known.
    pub nearby_rest_times: Option<[f64; 2]>,
    /// The rest time where the contact loses nothing.
    pub lossless: RestOrReason,
    /// The rest time under every form of the damping of the contact.
    pub held_fixed: Vec<RestOrReason>,
}

impl MaterialPoint {
    /// The row of a material.
    pub fn from_motions(motions: &MaterialMotions) -> Self {
        Self {
            first_contact: motions.first,
            rest_time: motions.course.rest_time.into(),
            impacts: motions.course.impacts.clone(),
            energies: numbers(&motions.course.energies),
            stop: motions.course.stop,
            nearby_rest_times: motions.nearby,
            lossless: motions.lossless.into(),
            held_fixed: motions.held.iter().copied().map(RestOrReason::from).collect(),
        }
    }

    /// The motions again; `None` if a number is none.
    pub fn read(&self) -> Option<MaterialMotions> {
        Some(MaterialMotions {
            first: self.first_contact,
            course: MotionToRest {
                rest_time: self.rest_time.into(),
                impacts: self.impacts.clone(),
                energies: read_numbers(&self.energies)?,
                stop: self.stop,
            },
            nearby: self.nearby_rest_times,
            lossless: self.lossless.into(),
            held: self.held_fixed.iter().copied().map(Into::into).collect(),
        })
    }
}

/// A claim of a publication, computed without a look at the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimPoint {
    /// The verdict.
    pub verdict: String,
    /// The attempts.
    pub tried: Vec<AttemptPoint>,
    /// The value that an unknown must have, the ends of the range around it, and whether it may have
    /// it; null where none was solved for.
    pub demand: Option<(AnyNumber, [AnyNumber; 2], bool)>,
    /// Quantities that are needed and not printed.
    pub missing: Vec<String>,
    /// The reasons for the verdict.
    pub evidence: Vec<String>,
}

/// A claim under some suppositions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttemptPoint {
    /// The suppositions: the number of the subject in the claim, and of the alternative.
    pub supposing: Vec<[usize; 2]>,
    /// These suppositions, in words.
    pub words: Vec<String>,
    /// The value of each entry.
    pub computed: Vec<EntryPoint>,
    /// Whether each entry is reproduced.
    pub reproduced: Vec<bool>,
}

/// The value of an entry, or the reason why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EntryPoint {
    /// A number.
    Number(AnyNumber),
    /// A fraction.
    Exact(String),
    /// The coefficient of a term that does not occur.
    Absent,
    /// A formula.
    Formula(String),
    /// The rules that options break.
    Conflicts(Vec<String>),
    /// Values that are missing.
    Missing(Vec<String>),
    /// The reason why there is no such number.
    Refused(String),
}

impl EntryPoint {
    fn new(computed: &Result<Computed, NotComputable>) -> Self {
        match computed {
            Ok(Computed::Number(number)) => Self::Number((*number).into()),
            Ok(Computed::Exact(fraction)) => Self::Exact(fraction.to_string()),
            Ok(Computed::Absent) => Self::Absent,
            Ok(Computed::Formula(formula)) => Self::Formula(formula.to_string()),
            Ok(Computed::Conflicts(conflicts)) => Self::Conflicts(conflicts.clone()),
            Err(NotComputable::Missing(names)) => Self::Missing(names.iter().cloned().collect()),
            Err(NotComputable::Refused(reason)) => Self::Refused(reason.clone()),
        }
    }

    fn read(&self) -> Option<Result<Computed, NotComputable>> {
        Some(match self {
            Self::Number(number) => Ok(Computed::Number(number.read()?)),
            Self::Exact(text) => {
                Ok(Computed::Exact(parse_expression(text).ok()?.as_number()?.clone()))
            }
            Self::Absent => Ok(Computed::Absent),
            Self::Formula(text) => Ok(Computed::Formula(parse_expression(text).ok()?)),
            Self::Conflicts(conflicts) => Ok(Computed::Conflicts(conflicts.clone())),
            Self::Missing(names) => Err(NotComputable::Missing(names.iter().cloned().collect())),
            Self::Refused(reason) => Err(NotComputable::Refused(reason.clone())),
        })
    }
}

impl ClaimPoint {
    /// The row of a claim.
    pub fn from_finding(finding: &ClaimFinding) -> Self {
        let claim = &finding.claim;
        let place = |supposition: &Supposition| {
            let subjects = claim.suppositions.iter().enumerate();
            let mut found = subjects.filter_map(|(subject, alternatives)| {
                let alternative = alternatives.iter().position(|other| other == supposition)?;
                Some([subject, alternative])
            });
            found.next()
        };
        let attempt = |tried: &ClaimAttempt| AttemptPoint {
            supposing: tried.supposing.iter().filter_map(place).collect(),
            words: tried.words.clone(),
            computed: tried.computed.iter().map(EntryPoint::new).collect(),
            reproduced: tried.reproduced.clone(),
        };
        Self {
            verdict: finding.verdict.name().to_owned(),
            tried: finding.tried.iter().map(attempt).collect(),
            demand: finding.demand.map(|demand| {
                (demand.value.into(), demand.range.map(AnyNumber::from), demand.is_within)
            }),
            missing: finding.missing.clone(),
            evidence: finding.evidence.clone(),
        }
    }

    /// The finding of this claim again; `None` if the row is that of another one.
    pub fn read(&self, claim: Claim) -> Option<ClaimFinding> {
        let attempt = |tried: &AttemptPoint| {
            let supposition = |[subject, alternative]: &[usize; 2]| {
                claim.suppositions.get(*subject)?.get(*alternative).cloned()
            };
            Some(ClaimAttempt {
                supposing: tried.supposing.iter().map(supposition).collect::<Option<_>>()?,
                words: tried.words.clone(),
                computed: tried.computed.iter().map(EntryPoint::read).collect::<Option<_>>()?,
                reproduced: tried.reproduced.clone(),
            })
        };
        let demand = match &self.demand {
            None => None,
            Some((value, [low, high], is_within)) => Some(RequiredValue {
                unknown: claim.unknown?,
                value: value.read()?,
                range: [low.read()?, high.read()?],
                is_within: *is_within,
            }),
        };
        Some(ClaimFinding {
            verdict: Verdict::from_name(&self.verdict)?,
            tried: self.tried.iter().map(attempt).collect::<Option<_>>()?,
            demand,
            missing: self.missing.clone(),
            evidence: self.evidence.clone(),
            claim,
        })
    }
}
