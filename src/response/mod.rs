//! Steady states of a driven oscillator: all branches of periodic motions with their stability, and what happens between them.
//!
//! ```text
//! x'' + f(x, x', t; p) = 0,  f periodic in t:    X(theta) = a_0 + sum a_k cos(k theta) + b_k sin(k theta),  theta = omega t
//! ```
//!
//! In: a [`Question`]: an oscillator with numbers for all parameters but one, and the range in which that one varies. Out: a
//! [`Response`]: branches found by harmonic balance and followed by pseudo-arclength; the multipliers of the true motion beside each of
//! their points; folds, crossings, period doublings, second frequencies; backbones; and how far all of that is from motions that
//! Runge-Kutta finds. Units are those of the equation.
//!
//! - [`driven`]: the equation in the phase of the motion.
//! - [`balance`]: its equations for Fourier coefficients.
//! - [`continuation`]: the branches.
//! - [`stability`]: the true motion by shooting, its multipliers; simulations that settle.
//! - [`bifurcation`]: where a branch changes.
//! - [`backbone`]: the free motion without damping.
//!
//! Branches start where a simulation settles, from rest and from a ring of starts at several values of the parameter, and where others
//! cross: that finds closed and disconnected ones wherever a simulation finds its way to them.

pub mod backbone;
pub mod balance;
pub mod bifurcation;
pub mod continuation;
pub mod driven;
pub mod stability;

use std::collections::BTreeMap;

use nalgebra::DVector;
use num_complex::Complex;
use thiserror::Error;

use crate::decimal::decimal;
use crate::expr::{EvaluationError, Expr, ExprError};
use crate::interrupt::Interrupt;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::Verdict;

use backbone::{BackbonePoint, backbones, places_of_rest};
use balance::Balance;
use bifurcation::BifurcationKind;
use continuation::{BranchEnd, Node, Path, Walk, extent};
use driven::Driven;
use stability::{
    Floquet, Settled, TrueMotion, first_harmonic, half_of_peak_to_peak, multipliers_along, periodic_motion, settle,
};

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The equation.
    pub oscillator: Oscillator,
    /// Exact values of all parameters but the one that varies.
    pub values: Values,
    /// The one that varies.
    pub parameter: Symbol,
    /// Its lowest and its highest value.
    pub range: [f64; 2],
    /// How many harmonics are kept; without it as many as bring the error below a tenth of the tolerance, 64 at most.
    pub harmonics: Option<usize>,
    /// How many periods of the drive a period of the motion takes.
    pub periods: usize,
    /// The relative error up to which it passes.
    pub tolerance: f64,
    /// Who may ask it to end.
    pub interrupt: Interrupt,
}

/// Why there is no response.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ResponseError {
    /// Time does not occur.
    #[error("there is no drive: time `t` does not occur in the equation")]
    NoDrive,
    /// Time enters in a way that does not repeat.
    #[error("the term `{0}` is not periodic in time")]
    NotPeriodic(String),
    /// Two frequencies without a common period for every value of the parameter.
    #[error("the frequencies `{}` and `{}` are no whole multiples of one frequency", .0[0], .0[1])]
    TwoFrequencies([String; 2]),
    /// The frequency of the drive is not positive in all of the range.
    #[error("the frequency `{frequency}` of the drive is {} at {parameter} = {}: it must be positive", decimal(*.value), decimal(*.at))]
    Frequency {
        /// The frequency.
        frequency: String,
        /// Its value.
        value: f64,
        /// The parameter.
        parameter: Symbol,
        /// Where.
        at: f64,
    },
    /// The parameter to vary is none of the equation.
    #[error("there is no parameter `{name}` in the equation: its parameters are {}", list(.known))]
    NoParameter {
        /// The name.
        name: Symbol,
        /// Those that there are.
        known: Vec<Symbol>,
    },
    /// The parameter that varies has a value.
    #[error("`{0}` varies and is given a value as well")]
    Given(Symbol),
    /// A value for a name that does not occur.
    #[error("there is a value for `{0}`, which does not occur in the equation")]
    Unknown(Symbol),
    /// Parameters without a value.
    #[error("no value for {}", list(.0))]
    Missing(Vec<Symbol>),
    /// A range that is none.
    #[error("the range of `{0}` must go from a finite number to a larger one")]
    Range(Symbol),
    /// A count beyond what can be kept.
    #[error("{what} must lie between 1 and {most}, not {given}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// What was given.
        given: usize,
        /// The most.
        most: usize,
    },
    /// No periodic motion was found to begin with.
    #[error("no periodic motion was found at {parameter} = {}{}", decimal(*.at), if *undamped { ": without damping the amplitude is unbounded at resonance" } else { "" })]
    NoMotion {
        /// The parameter.
        parameter: Symbol,
        /// Its value.
        at: f64,
        /// Whether nothing damps the motion.
        undamped: bool,
    },
    /// Somebody asked it to end before there was anything.
    #[error("interrupted without a result")]
    Interrupted,
    /// The equation has no such values.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A name that stands for nothing.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

fn list(symbols: &[Symbol]) -> String {
    let names: Vec<String> = symbols.iter().map(|symbol| format!("`{symbol}`")).collect();
    names.join(", ")
}

/// A steady state.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The parameter that varies.
    pub parameter: f64,
    /// Coefficients of cos(k theta) and sin(k theta), from k = 0, the mean.
    pub harmonics: Vec<[f64; 2]>,
    /// The amplitude of the first harmonic of the motion.
    pub amplitude: f64,
    /// Its phase: amplitude * cos(theta - phase).
    pub phase: f64,
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// Position and velocity at t = 0: those of the true motion where it was found.
    pub start: [f64; 2],
    /// Whether small disturbances die out, by the multipliers; without damping, whether they do not grow. Nothing where they could not
    /// be found.
    pub stable: Option<bool>,
    /// The multipliers, the larger first.
    pub multipliers: Option<[Complex<f64>; 2]>,
    /// The error of amplitude or peak against the true motion that shooting found, the larger, over the true peak; nothing where it
    /// found none near.
    pub error: Option<f64>,
}

/// A branch of steady states.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Its points in order.
    pub points: Vec<Point>,
    /// Why it ends before the first one and behind the last.
    pub ends: [BranchEnd; 2],
    /// Whether its mirror image, -x half a period of the drive later, is a branch as well, which is not listed.
    pub mirrored: bool,
}

/// A place where a branch changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bifurcation {
    /// What happens there.
    pub kind: BifurcationKind,
    /// The branch, counted from 0.
    pub branch: usize,
    /// The parameter.
    pub parameter: f64,
    /// The amplitude of the first harmonic.
    pub amplitude: f64,
    /// Half of peak to peak.
    pub peak: f64,
}

impl Bifurcation {
    /// Whether this is the same place, met from another branch or by the other half of one.
    fn is_near(&self, other: &Self, [low, high]: [f64; 2], size: f64) -> bool {
        // Where branches cross, each finds the place as well as it can.
        let near = if self.kind == BifurcationKind::BranchPoint {
            2e-4
        } else {
            1e-5
        };
        self.kind == other.kind
            && (self.parameter - other.parameter).abs() <= near * (high - low)
            && (self.peak - other.peak).abs() <= 1e-2 * size
    }
}

/// A simulation that was let go beside a stable point and has settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// The parameter.
    pub parameter: f64,
    /// The amplitude of its first harmonic.
    pub amplitude: f64,
    /// Half of peak to peak.
    pub peak: f64,
    /// The error of the point against it: of amplitude or peak, the larger, over its peak.
    pub error: f64,
}

/// A simulation that does not repeat itself after a period of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elsewhere {
    /// The parameter.
    pub parameter: f64,
    /// The periods after which it does; nothing where it does not within eight.
    pub periods: Option<usize>,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// What was asked.
    pub question: Question,
    /// The frequency of the drive.
    pub frequency: Expr,
    /// Whether nothing damps the motion.
    pub undamped: bool,
    /// How many harmonics were kept.
    pub harmonics: usize,
    /// The branches, in the order in which they were found.
    pub branches: Vec<Branch>,
    /// Folds and the like, branch by branch.
    pub bifurcations: Vec<Bifurcation>,
    /// The free motion without damping, about each place of rest; empty where the frequency does not vary.
    pub backbone: Vec<Vec<BackbonePoint>>,
    /// Simulations that have settled on stable points.
    pub simulated: Vec<Simulated>,
    /// Simulations that have settled on something else.
    pub elsewhere: Vec<Elsewhere>,
    /// The largest error of all points and simulations.
    pub error: Option<f64>,
    /// Points beside which shooting found no true motion.
    pub unjudged: usize,
    /// Whether the error is within the tolerance, on the whole of what was found.
    pub verdict: Verdict,
    /// Whether it was followed to its end.
    pub complete: bool,
}

/// The most harmonics that are kept.
pub const MOST_HARMONICS: usize = 64;

/// The most periods of the drive in one of the motion.
pub const MOST_PERIODS: usize = 12;

/// The longest step along a branch, in parts of the range and of the size of the motion.
const LONGEST_STEP: f64 = 0.03;

/// Points of a branch.
const MOST_POINTS: usize = 1500;

/// Evaluations of the force that simulations may take: some seconds of work.
const MOST_EVALUATIONS: usize = 10_000_000;

/// Branches that are followed.
const MOST_BRANCHES: usize = 12;

/// All steady states that are found, judged.
///
/// # Errors
/// [`ResponseError`].
///
/// ```
/// use lindstedt::response::{Question, respond};
///
/// // Duffing's equation, hardening: a jump down on the way up.
/// let question = Question::new("x'' + x'/10 + x + x^3 - F*cos(Omega*t) = 0", "Omega", [0.5, 2.5], "F = 3/10")?;
/// let response = respond(&question)?;
/// let fold = &response.bifurcations[0];
/// assert_eq!((fold.kind.name(), response.branches.len()), ("fold", 1));
/// assert!((fold.parameter - 1.7797).abs() < 1e-3, "{}", fold.parameter);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn respond(question: &Question) -> Result<Response, ResponseError> {
    const FIRST: usize = 8;
    let asked = Asked::new(question)?;
    let first = question.harmonics.unwrap_or(FIRST);
    let (seeds, elsewhere) = asked.seeds(first)?;
    let mut harmonics = first;
    let mut before = (f64::INFINITY, usize::MAX);
    loop {
        let mut response = asked.attempt(harmonics, &seeds)?;
        let points: usize = response.branches.iter().map(|branch| branch.points.len()).sum();
        let judged = 100 * response.unjudged <= points;
        let good = judged && response.error.is_some_and(|error| error <= 0.1 * question.tolerance);
        // What more harmonics do not better is not theirs, such as a jump of the force.
        let now = (response.error.unwrap_or(f64::INFINITY), response.unjudged);
        let stalled = now.0 >= 0.7 * before.0 && now.1 >= before.1;
        before = now;
        let fixed = question.harmonics.is_some() || !response.complete;
        let last = fixed || good || stalled || 2 * harmonics > MOST_HARMONICS;
        if last {
            response.elsewhere = elsewhere;
            return Ok(response);
        }
        harmonics *= 2;
    }
}

impl Question {
    /// A question with automatic harmonics, a tolerance of 1 %, and motions of the period of the drive.
    ///
    /// # Errors
    /// A text that is no equation, or values that are none.
    pub fn new(
        equation: &str,
        parameter: &str,
        range: [f64; 2],
        values: &str,
    ) -> Result<Self, Box<dyn std::error::Error + Send + Sync>> {
        Ok(Self {
            oscillator: Oscillator::parse(equation)?,
            values: values.parse()?,
            parameter: Symbol::new(parameter),
            range,
            harmonics: None,
            periods: 1,
            tolerance: 0.01,
            interrupt: Interrupt::default(),
        })
    }
}

/// A motion to begin with.
#[derive(Clone, Debug)]
struct Seed {
    parameter: f64,
    positions: Vec<f64>,
}

/// The multipliers at a point of a branch, and the true motion beside it.
type Judged = (Option<Floquet>, Option<TrueMotion>);

/// How a motion is known.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    /// It lies on a branch.
    Itself,
    /// Its mirror image lies on this one.
    Mirrored(usize),
}

/// A question with its equation ready for numbers.
struct Asked<'a> {
    question: &'a Question,
    /// The equation with all values but one.
    oscillator: Oscillator,
    driven: Driven,
}

impl<'a> Asked<'a> {
    fn new(question: &'a Question) -> Result<Self, ResponseError> {
        let Question {
            oscillator, parameter, ..
        } = question;
        let known = &oscillator.parameters;
        if !known.contains(parameter) {
            return Err(ResponseError::NoParameter {
                name: *parameter,
                known: known.clone(),
            });
        }
        if question.values.get(*parameter).is_some() {
            return Err(ResponseError::Given(*parameter));
        }
        if let Some((unknown, _)) = question.values.iter().find(|(name, _)| !known.contains(name)) {
            return Err(ResponseError::Unknown(unknown));
        }
        let missing = |name: &&Symbol| *name != parameter && question.values.get(**name).is_none();
        let missing: Vec<Symbol> = known.iter().filter(missing).copied().collect();
        if !missing.is_empty() {
            return Err(ResponseError::Missing(missing));
        }
        let [low, high] = question.range;
        if !(low < high && (high - low).is_finite()) {
            return Err(ResponseError::Range(*parameter));
        }
        for (what, given, most) in [
            (
                "the number of harmonics",
                question.harmonics.unwrap_or(1),
                MOST_HARMONICS,
            ),
            ("the number of periods", question.periods, MOST_PERIODS),
        ] {
            if !(1..=most).contains(&given) {
                return Err(ResponseError::Count { what, given, most });
            }
        }
        let values: BTreeMap<Symbol, Expr> = question.values.split(known).0;
        let oscillator = oscillator.with_values(&values)?;
        let driven = Driven::new(&oscillator, *parameter, question.periods)?;
        for part in 0..=20 {
            let at = low + (high - low) * f64::from(part) / 20.0;
            let value = driven.frequency_at(at);
            if !(value > 0.0 && value.is_finite()) {
                return Err(ResponseError::Frequency {
                    frequency: driven.frequency.to_string(),
                    value: value * question.periods as f64,
                    parameter: *parameter,
                    at,
                });
            }
        }
        Ok(Self {
            question,
            oscillator,
            driven,
        })
    }

    fn walk(&self, seeds: &[Seed], size: f64) -> Walk {
        Walk {
            ordinary: size_of(seeds),
            range: self.question.range,
            longest: LONGEST_STEP,
            most: MOST_POINTS,
            size,
            interrupt: self.question.interrupt,
        }
    }

    /// Motions to begin with: where simulations settle, from rest and from a ring of starts as large as the motions of the first
    /// branches; and what did not repeat itself.
    fn seeds(&self, harmonics: usize) -> Result<(Vec<Seed>, Vec<Elsewhere>), ResponseError> {
        /// Values of the parameter at which simulations begin.
        const VALUES: u32 = 5;
        const RINGS: [f64; 2] = [0.5, 1.3];
        const SAMPLES: usize = 256;
        let [low, high] = self.question.range;
        let balance = Balance::new(&self.driven, harmonics);
        let values: Vec<f64> = (0..VALUES)
            .map(|index| low + (high - low) * f64::from(index) / f64::from(VALUES - 1))
            .collect();
        let mut seeds = Vec::new();
        let mut elsewhere = Vec::new();
        let mut budget = MOST_EVALUATIONS;
        let mut size = 0.0_f64;
        for parameter in &values {
            let mut places = places_of_rest(&self.driven, *parameter, size.max(1.0));
            // Between two wells there is a motion as well, though it does not last.
            if !places.contains(&0.0) {
                places.push(0.0);
            }
            for place in places {
                // Beside the motion that a balance finds from rest, if it does.
                let mut still = DVector::zeros(balance.size());
                still[0] = place;
                if let Some(found) = balance.solve(&still, *parameter) {
                    size = size.max(extent(&found));
                    let positions = (0..SAMPLES).map(|sample| {
                        let phase = std::f64::consts::TAU * sample as f64 / SAMPLES as f64;
                        balance.at(&found, *parameter, phase)[0]
                    });
                    seeds.push(Seed {
                        parameter: *parameter,
                        positions: positions.collect(),
                    });
                }
                elsewhere.extend(self.settled([place, 0.0], *parameter, &mut seeds, &mut budget));
            }
        }
        size = size.max(size_of(&seeds));
        // The ring is as wide as the branches that are known by now.
        let first: Vec<Path> = self.branches(&balance, &seeds, size);
        let widest = first
            .iter()
            .flat_map(|path| &path.nodes)
            .map(|node| extent(&node.coefficients));
        size = widest.fold(size, f64::max);
        if !self.driven.undamped {
            for parameter in &values {
                let omega = self.driven.frequency_at(*parameter);
                for (radius, turn) in RINGS
                    .iter()
                    .flat_map(|radius| (0..4_u32).map(move |turn| (radius, turn)))
                {
                    if self.question.interrupt.is_requested() {
                        return Ok((seeds, elsewhere));
                    }
                    let (sine, cosine) = (std::f64::consts::FRAC_PI_2 * (f64::from(turn) + 0.3)).sin_cos();
                    let start = [radius * size * cosine, -radius * size * omega * sine];
                    elsewhere.extend(self.settled(start, *parameter, &mut seeds, &mut budget));
                }
            }
        }
        elsewhere.sort_by(|one: &Elsewhere, other| {
            let parameters = one.parameter.total_cmp(&other.parameter);
            parameters.then(one.periods.cmp(&other.periods))
        });
        elsewhere.dedup();
        if seeds.is_empty() {
            return Err(match self.question.interrupt.is_requested() {
                true => ResponseError::Interrupted,
                false => ResponseError::NoMotion {
                    parameter: self.question.parameter,
                    at: low,
                    undamped: self.driven.undamped,
                },
            });
        }
        Ok((seeds, elsewhere))
    }

    /// Adds where a simulation settles, or says that it does not repeat itself.
    fn settled(&self, start: [f64; 2], parameter: f64, seeds: &mut Vec<Seed>, budget: &mut usize) -> Option<Elsewhere> {
        const PERIODS: usize = 250;
        const CLOSELY: f64 = 1e-4;
        if self.driven.undamped {
            return None;
        }
        let settled = settle(&self.driven, start, parameter, (PERIODS, CLOSELY), budget)?;
        if settled.returns_after != Some(1) {
            return Some(Elsewhere {
                parameter,
                periods: settled.returns_after,
            });
        }
        seeds.push(Seed {
            parameter,
            positions: settled.positions,
        });
        None
    }

    /// The branches through these motions, each once.
    fn branches(&self, balance: &Balance, seeds: &[Seed], size: f64) -> Vec<Path> {
        let mut paths: Vec<Path> = Vec::new();
        for seed in seeds {
            if paths.len() >= MOST_BRANCHES || self.question.interrupt.is_requested() {
                break;
            }
            let guess = balance.coefficients_of(&seed.positions);
            let Some(found) = balance.solve(&guess, seed.parameter) else {
                continue;
            };
            let walk = self.walk(
                seeds,
                paths.iter().map(largest).fold(size.max(extent(&found)), f64::max),
            );
            if self.was_known(balance, &mut paths, &found, seed.parameter) {
                continue;
            }
            if let Some(path) = walk.through(balance, &found, seed.parameter) {
                self.keep(balance, path, &mut paths);
            }
        }
        paths
    }

    /// Whether a motion is known; where it is a mirror image, its branch is marked.
    fn was_known(&self, balance: &Balance, paths: &mut [Path], coefficients: &DVector<f64>, parameter: f64) -> bool {
        let known = self.known(balance, paths, coefficients, parameter);
        if let Some(Known::Mirrored(index)) = known {
            paths[index].mirrored = true;
        }
        known.is_some()
    }

    /// Keeps a branch that is none of those that are known, nor the mirror image of one.
    fn keep(&self, balance: &Balance, mut path: Path, paths: &mut Vec<Path>) {
        if path.nodes.len() < 2 {
            return;
        }
        self.cut_at_crossing(balance, &mut path);
        let [first, middle, last] = [0, path.nodes.len() / 2, path.nodes.len() - 1].map(|index| &path.nodes[index]);
        let ends = match path.ends[0] {
            BranchEnd::Closed => vec![middle],
            _ if path.ends[1] == BranchEnd::Crossing => vec![first],
            _ => vec![first, last],
        };
        let known = |node: &Node| self.known(balance, paths, &node.coefficients, node.parameter);
        match ends.into_iter().find_map(known).filter(|_| known(middle).is_some()) {
            Some(Known::Itself) => {}
            Some(Known::Mirrored(index)) => paths[index].mirrored = true,
            None => paths.push(path),
        }
    }

    /// A branch that is born where another one is crossed comes back from there as its own image: that half is left out.
    fn cut_at_crossing(&self, balance: &Balance, path: &mut Path) {
        let turns = |pair: &[Node]| pair[0].orientation != pair[1].orientation;
        let Some(index) = path.nodes.windows(2).position(turns) else {
            return;
        };
        let (before, behind) = (&path.nodes[..=index], &path.nodes[index + 1..]);
        let half = Path {
            nodes: before.to_vec(),
            ends: path.ends,
            mirrored: false,
        };
        let image = |node: &Node| self.known(balance, std::slice::from_ref(&half), &node.coefficients, node.parameter);
        // The middle of that half, which is surely no longer than the first.
        if let Some(known) = behind.get(behind.len() / 2).and_then(image) {
            path.mirrored = matches!(known, Known::Mirrored(_));
            // The first point beyond stays, so that the crossing lies between two points.
            path.nodes.truncate(index + 2);
            path.ends[1] = BranchEnd::Crossing;
        }
    }

    /// Whether a motion lies on one of these branches, or is one of theirs begun a period of the drive later, or a mirror image.
    fn known(&self, balance: &Balance, paths: &[Path], coefficients: &DVector<f64>, parameter: f64) -> Option<Known> {
        /// The part of a motion by which a guess between two points may be off.
        const NEAR: f64 = 0.2;
        const SAME: f64 = 1e-5;
        let size = extent(coefficients).max(1e-3 * coefficients.norm());
        let period = std::f64::consts::TAU / self.question.periods as f64;
        let shifts = (0..self.question.periods).map(|periods| period * periods as f64);
        let shifted: Vec<DVector<f64>> = shifts.clone().map(|shift| later(coefficients, shift)).collect();
        let mirrored: Vec<DVector<f64>> = shifts.map(|shift| -later(coefficients, shift + 0.5 * period)).collect();
        // Places between which the force does not change, such as those a turn of a pendulum apart, are one.
        let is_one = |motion: &DVector<f64>, of: &[DVector<f64>], within: f64, anywhere: bool| {
            let near = |shifted: &DVector<f64>| {
                let mut apart = motion - shifted;
                let mean = apart[0];
                apart[0] = 0.0;
                let allowed = within * size.max(extent(motion));
                apart.norm() <= allowed && (anywhere || mean.abs() <= allowed || self.repeats_after(mean, parameter))
            };
            of.iter().any(near)
        };
        let between = |pair: &[Node], of: &[DVector<f64>]| {
            let [one, other] = pair else { return false };
            let way = other.parameter - one.parameter;
            let part = if way == 0.0 {
                0.0
            } else {
                (parameter - one.parameter) / way
            };
            if !(-1e-9..=1.0 + 1e-9).contains(&part) {
                return false;
            }
            let guess = &one.coefficients + (&other.coefficients - &one.coefficients) * part;
            let solved = || balance.solve(&guess, parameter);
            is_one(&guess, of, NEAR, true) && solved().is_some_and(|found| is_one(&found, of, SAME, false))
        };
        let on = |of: &[DVector<f64>]| {
            let holds = |path: &Path| path.nodes.windows(2).any(|pair| between(pair, of));
            paths.iter().position(holds)
        };
        match on(&shifted) {
            Some(_) => Some(Known::Itself),
            None => on(&mirrored).map(Known::Mirrored),
        }
    }

    /// Whether the force is the same this far away.
    fn repeats_after(&self, distance: f64, parameter: f64) -> bool {
        (0..8).all(|index| {
            let (x, v) = (0.37 * f64::from(index) - 1.1, 0.9 - 0.23 * f64::from(index));
            let force = |x: f64| self.driven.force(&[x, v, f64::from(index), parameter]);
            (force(x + distance) - force(x)).abs() <= 1e-4 * (force(x).abs() + force(x + 1.0).abs())
        })
    }

    /// Everything with so many harmonics.
    fn attempt(&self, harmonics: usize, seeds: &[Seed]) -> Result<Response, ResponseError> {
        let question = self.question;
        let balance = Balance::new(&self.driven, harmonics);
        let mut paths = self.branches(&balance, seeds, size_of(seeds));
        let walk = self.walk(seeds, paths.iter().map(largest).fold(size_of(seeds), f64::max));
        let floquet = |node: &Node| self.judged(&balance, node).0;
        let mut all_judged: Vec<Vec<Judged>> = Vec::new();
        let mut changes = Vec::new();
        while let Some(path) = paths.get(all_judged.len()).cloned() {
            let judged: Vec<Judged> = path.nodes.iter().map(|node| self.judged(&balance, node)).collect();
            for (pair, known) in path.nodes.windows(2).zip(judged.windows(2)) {
                let ([from, to], [before, after]) = (pair, known) else {
                    continue;
                };
                let found = bifurcation::between(&balance, &walk, [(from, before.0), (to, after.0)], &floquet);
                for (kind, node) in found {
                    if kind == BifurcationKind::BranchPoint && paths.len() < MOST_BRANCHES {
                        self.follow_crossing(&balance, &walk, &node, &mut paths);
                    }
                    changes.push((kind, all_judged.len(), node));
                }
            }
            all_judged.push(judged);
        }
        // What is small is small beside the largest motion of all.
        let size = paths.iter().map(largest).fold(0.0, f64::max);
        let mut bifurcations: Vec<Bifurcation> = Vec::new();
        for (kind, branch, node) in changes {
            let point = self.point(&balance, &node, (None, None), size);
            let new = Bifurcation {
                kind,
                branch,
                parameter: point.parameter,
                amplitude: point.amplitude,
                peak: point.peak,
            };
            if !bifurcations
                .iter()
                .any(|known| new.is_near(known, question.range, size))
            {
                bifurcations.push(new);
            }
        }
        let branches: Vec<Branch> = paths
            .iter()
            .zip(all_judged)
            .map(|(path, judged)| {
                let points = path.nodes.iter().zip(judged);
                Branch {
                    points: points
                        .map(|(node, judged)| self.point(&balance, node, judged, size))
                        .collect(),
                    ends: path.ends,
                    mirrored: path.mirrored,
                }
            })
            .collect();
        if branches.is_empty() {
            return Err(match question.interrupt.is_requested() {
                true => ResponseError::Interrupted,
                false => ResponseError::NoMotion {
                    parameter: question.parameter,
                    at: question.range[0],
                    undamped: self.driven.undamped,
                },
            });
        }
        let simulated = self.simulated(&branches);
        let errors = branches
            .iter()
            .flat_map(|branch| &branch.points)
            .filter_map(|point| point.error);
        let errors = errors.chain(simulated.iter().map(|simulated| simulated.error));
        let error = errors.fold(None, |largest: Option<f64>, error| {
            Some(largest.map_or(error, |largest| largest.max(error)))
        });
        let points = branches.iter().flat_map(|branch| &branch.points);
        let (all, unjudged) = points.fold((0, 0), |(all, none), point| {
            (all + 1, none + usize::from(point.error.is_none()))
        });
        let complete = !question.interrupt.is_requested();
        let peak = branches
            .iter()
            .flat_map(|branch| &branch.points)
            .map(|point| point.amplitude)
            .fold(0.0, f64::max);
        Ok(Response {
            question: question.clone(),
            frequency: self.driven.frequency.clone(),
            undamped: self.driven.undamped,
            harmonics: balance.harmonics,
            backbone: backbones(&self.oscillator, &self.driven, harmonics, question.range, 1.15 * peak)?,
            branches,
            bifurcations,
            simulated,
            elsewhere: vec![],
            verdict: Verdict::of(error.is_some_and(|error| error <= question.tolerance) && 20 * unjudged <= all),
            error,
            unjudged,
            complete,
        })
    }

    /// Follows the branch that crosses another one here.
    fn follow_crossing(&self, balance: &Balance, walk: &Walk, at: &Node, paths: &mut Vec<Path>) {
        for node in walk.crossing(balance, at) {
            if self.was_known(balance, paths, &node.coefficients, node.parameter) {
                continue;
            }
            if let Some(path) = walk.along(balance, &node.coefficients, node.parameter, &node.tangent) {
                self.keep(balance, path, paths);
            }
        }
    }

    /// The multipliers at a point of a branch, and the true motion beside it.
    fn judged(&self, balance: &Balance, node: &Node) -> Judged {
        /// Parts of its size by which the true motion may differ: beyond it is another one.
        const OTHER: f64 = 0.3;
        let start = balance.start(&node.coefficients, node.parameter);
        let size = extent(&node.coefficients);
        let truth = periodic_motion(&self.driven, start, node.parameter, size.max(1e-12)).filter(|truth| {
            let [cosine, sine] = [1, 2].map(|index| node.coefficients[index]);
            (truth.first_harmonic[0] - cosine).hypot(truth.first_harmonic[1] - sine) <= OTHER * size.max(1e-12)
        });
        let floquet = truth.map(|truth| truth.floquet);
        let along = || {
            multipliers_along(&self.driven, node.parameter, |phase| {
                balance.at(&node.coefficients, node.parameter, phase)
            })
        };
        (floquet.or_else(along), truth)
    }

    fn point(&self, balance: &Balance, node: &Node, (floquet, truth): Judged, size: f64) -> Point {
        let u = &node.coefficients;
        let positions: Vec<f64> = balance.motion(u).iter().map(|point| point[0]).collect();
        /// Of the largest motion: less is rounding.
        const NOTHING: f64 = 1e-12;
        let (amplitude, peak) = (u[1].hypot(u[2]), half_of_peak_to_peak(&positions));
        let (amplitude, phase) = match amplitude > NOTHING * size {
            // Half a turn is pi, whatever rounding has left of the sine.
            true if u[2].abs() <= NOTHING * amplitude => {
                (amplitude, if u[1] < 0.0 { std::f64::consts::PI } else { 0.0 })
            }
            true => (amplitude, u[2].atan2(u[1])),
            false => (0.0, 0.0),
        };
        let error = truth.map(|truth| {
            let [cosine, sine] = truth.first_harmonic;
            relative_error([amplitude, peak], [cosine.hypot(sine), truth.peak], size)
        });
        // On the circle itself only rounding tells.
        let allowed = if self.driven.undamped { 1.0 + 1e-5 } else { 1.0 };
        Point {
            parameter: node.parameter,
            harmonics: (0..=balance.harmonics)
                .map(|harmonic| match harmonic {
                    0 => [u[0], 0.0],
                    _ => [u[2 * harmonic - 1], u[2 * harmonic]],
                })
                .collect(),
            amplitude,
            phase,
            peak,
            start: truth.map_or_else(|| balance.start(u, node.parameter), |truth| truth.start),
            stable: floquet.map(|floquet| floquet.largest() < allowed),
            multipliers: floquet.map(|floquet| floquet.multipliers()),
            error,
        }
    }

    /// Simulations beside some stable points, disturbed a little and followed until they have settled.
    fn simulated(&self, branches: &[Branch]) -> Vec<Simulated> {
        /// Points of a stable part of a branch, and of all of them.
        const EACH: usize = 6;
        const MOST: usize = 30;
        /// Of the size of the motion: the second where the first leads to another motion.
        const DISTURBANCES: [f64; 2] = [1e-2, 1e-5];
        const OTHER: f64 = 0.05;
        const PERIODS: f64 = 1500.0;
        const CLOSELY: f64 = 1e-8;
        if self.driven.undamped {
            return vec![];
        }
        let size = branches
            .iter()
            .flat_map(|branch| &branch.points)
            .map(|point| point.peak)
            .fold(0.0, f64::max);
        let mut found = Vec::new();
        let mut budget = MOST_EVALUATIONS;
        for branch in branches {
            for part in branch.points.chunk_by(|one, other| one.stable == other.stable) {
                if part.first().is_none_or(|point| point.stable != Some(true)) {
                    continue;
                }
                let steps = EACH.min(part.len());
                for index in 0..steps {
                    let point = &part[(2 * index + 1) * part.len() / (2 * steps)];
                    let largest = point.multipliers.map_or(1.0, |multipliers| multipliers[0].norm());
                    let needed = (1e-7_f64 / DISTURBANCES[0]).ln() / largest.ln();
                    let stopped = self.question.interrupt.is_requested();
                    if !(needed > 0.0 && needed < PERIODS) || found.len() >= MOST || stopped {
                        continue;
                    }
                    let most = needed.ceil() as usize + 8;
                    let mut run = |disturbance: f64| {
                        let start = [point.start[0] + disturbance * point.peak, point.start[1]];
                        let settled = settle(&self.driven, start, point.parameter, (most, CLOSELY), &mut budget)?;
                        Some(simulated(point, &settled, size))
                    };
                    // Where the first leads to another motion the second, much smaller, decides.
                    let first = run(DISTURBANCES[0]);
                    let near = match first {
                        Some(first) if first.error <= OTHER => Some(first),
                        _ => run(DISTURBANCES[1]).or(first),
                    };
                    found.extend(near);
                }
            }
        }
        found
    }
}

fn simulated(point: &Point, settled: &Settled, size: f64) -> Simulated {
    let [cosine, sine] = first_harmonic(&settled.positions);
    let (amplitude, peak) = (cosine.hypot(sine), half_of_peak_to_peak(&settled.positions));
    Simulated {
        parameter: point.parameter,
        amplitude,
        peak,
        error: relative_error([point.amplitude, point.peak], [amplitude, peak], size),
    }
}

/// The larger error of amplitude and peak, over the true peak; of motions that are little beside the largest, over a thousandth of it.
fn relative_error([amplitude, peak]: [f64; 2], [true_amplitude, true_peak]: [f64; 2], size: f64) -> f64 {
    let apart = (amplitude - true_amplitude).abs().max((peak - true_peak).abs());
    let over = true_peak.max(1e-3 * size);
    if over > 0.0 { apart / over } else { 0.0 }
}

/// The size of the largest of the motions to begin with.
fn size_of(seeds: &[Seed]) -> f64 {
    seeds
        .iter()
        .map(|seed| half_of_peak_to_peak(&seed.positions))
        .fold(0.0, f64::max)
}

/// The size of the largest motion of a branch.
fn largest(path: &Path) -> f64 {
    path.nodes
        .iter()
        .map(|node| extent(&node.coefficients))
        .fold(0.0, f64::max)
}

/// The motion begun later by a phase.
fn later(coefficients: &DVector<f64>, phase: f64) -> DVector<f64> {
    let mut turned = coefficients.clone();
    for harmonic in 1..=(coefficients.len() - 1) / 2 {
        let (sine, cosine) = (phase * harmonic as f64).sin_cos();
        let (a, b) = (coefficients[2 * harmonic - 1], coefficients[2 * harmonic]);
        turned[2 * harmonic - 1] = a * cosine + b * sine;
        turned[2 * harmonic] = b * cosine - a * sine;
    }
    turned
}
