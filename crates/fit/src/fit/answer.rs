//! The answer: a table of laws with their parameters and errors, and what the record excludes.
//!
//! ```text
//! sigma^2 = RSS/(N - k) of the best law, or as given        chi^2 = RSS/sigma^2
//! AIC = N ln(RSS/N) + 2 k,   BIC = N' ln(RSS/N) + k ln N'    N' = N/tau, tau = 1 + 2 sum r_k of the residuals
//! ```
//!
//! Laws are ordered by BIC: a parameter more must improve the fit beyond what noise explains in 499 of 500 records, so that the
//! simplest law that fits comes first. (G. Schwarz, *Ann. Statist.* 6 (1978) 461; H. Akaike, *IEEE Trans. Autom. Control* 19 (1974) 716.)
//! Autocorrelated residuals enlarge the errors by the covariance of Newey and West.

use nalgebra::DMatrix;
use thiserror::Error;

use crate::fit::closed_forms::{MapFit, fit_maps};
use crate::fit::equation_error::{initial_state, parameters as equation_error_parameters};
use crate::fit::fitted_record::{CountedPart, FittedRecord, weigh};
use crate::fit::laws::{LOCAL_NAMES, Law, LawError, Loss, Spring};
use crate::fit::least_squares::Covariance;
use crate::fit::motion::{MotionSolver, Quantity};
use crate::fit::nested::refit_wider;
use crate::fit::polynomial::median;
use crate::fit::record::Record;
use crate::fit::sample_fit::{LOCAL, SampleFit, Samples, fit_samples, misfit, motion, values_of};
use crate::fit::turning_points::{Swings, SwingsError};
use crate::fit::whiteness::{Whiteness, robust_covariance};
use crate::parallel::par_map;

/// Options of a fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitOptions {
    /// The standard deviation of the noise, if it is known; otherwise it is found from the residuals.
    pub noise: Option<f64>,
    /// Whether all samples count, even those that lie far from any law.
    pub keep_outliers: bool,
}

/// A value with its standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The name.
    pub name: String,
    /// The value.
    pub value: f64,
    /// The standard error; infinite where the measurement leaves the value open.
    pub error: f64,
}

/// A law fitted to a record.
#[derive(Clone, Debug)]
pub struct LawFit {
    /// The law.
    pub law: Law,
    /// The parameters, then `x0`, `v0`, `offset` at the middle of the record and `drift` per unit of time; for further records `x0_2` and so on.
    pub estimates: Vec<Estimate>,
    /// The correlations of the estimates; those of parameters that the record leaves open are zero.
    pub correlations: DMatrix<f64>,
    /// The sum of the squares of the residuals.
    pub residual_square: f64,
    /// Chi-square per degree of freedom.
    pub chi_square: f64,
    /// The criterion of Akaike.
    pub aic: f64,
    /// The criterion of Schwarz, by which the laws are ordered.
    pub bic: f64,
    /// The increase of chi-square over that of the best law, in units of the noise.
    pub excess: f64,
    /// The factor by which the misfit exceeds what noise explains: the excess for each parameter that the best law has more.
    pub exclusion: f64,
    /// Whether the residuals are white.
    pub whiteness: Whiteness,
    /// Directions of the parameters that the record does not determine, in words.
    pub flat: Vec<String>,
    /// Whether the fit converged.
    pub converged: bool,
    /// The residuals at the times of the samples that were used, those of one record after those of another.
    pub residuals: Vec<f64>,
    covariance: DMatrix<f64>,
}

impl LawFit {
    /// The estimate of this name.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// The values of all estimates.
    pub fn values(&self) -> Vec<f64> {
        self.estimates.iter().map(|estimate| estimate.value).collect()
    }
}

/// The excess of chi-square from which on a law is excluded by its turning points: a factor of that of the best law, and a number beside it.
const FAR: [f64; 2] = [5.0, 100.0];

/// A law that the turning points exclude.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcludedLaw {
    /// The law.
    pub law: Law,
    /// Its parameters by their names, as fitted to the turning points.
    pub values: Vec<(String, f64)>,
    /// The ratio of its chi-square to that of the best law.
    pub ratio: f64,
}

/// The answer for one record or several.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The laws that were fitted to the samples, the best first.
    pub laws: Vec<LawFit>,
    /// The laws that the turning points exclude, the nearest first.
    pub excluded: Vec<ExcludedLaw>,
    /// The records, each with what was found in it before any law.
    pub records: Vec<FittedRecord>,
    /// The standard deviation of the noise, as given or found from the residuals of the best law.
    pub noise: f64,
    /// The number of samples over which the residuals of the best law are correlated: 1 if they are white.
    pub correlation_length: f64,
}

/// The reason why there is no answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// The record has too few swings or samples.
    #[error(transparent)]
    Swings(#[from] SwingsError),
    /// An equation cannot be fitted.
    #[error(transparent)]
    Law(#[from] LawError),
    /// The amplitude grows.
    #[error("the amplitude grows from {from:.4} to {to:.4}: this is no free decay")]
    Grows {
        /// The amplitude at the beginning.
        from: f64,
        /// The amplitude at the end.
        to: f64,
    },
    /// Many samples lie on flat tops.
    #[error("{saturated} of {total} samples lie on flat tops: the sensor was saturated")]
    Saturated {
        /// The number of saturated samples.
        saturated: usize,
        /// The number of samples.
        total: usize,
    },
    /// There is no record.
    #[error("there is no record")]
    NoRecord,
    /// No law has a motion near the record.
    #[error("no law has a motion near the record")]
    NoMotion,
    /// A start is needed for an equation of one's own.
    #[error("`{0}` needs a start: its parameters could not be found from the accelerations")]
    NoStart(String),
}

impl FitError {
    /// A way forward.
    pub fn help(&self) -> String {
        match self {
            Self::Swings(error) => error.help().to_owned(),
            Self::Law(error) => error.help().to_owned(),
            Self::Grows { .. } => "leave out what comes before the release, or write an equation with the drive, such as \
                 `x'' + c*x' + k*x = F*cos(Omega*t)`"
                .to_owned(),
            Self::Saturated { .. } => "measure with a larger range, or leave out the part with large amplitudes".to_owned(),
            Self::NoRecord => "give one record at least".to_owned(),
            Self::NoMotion => "try an equation of your own".to_owned(),
            Self::NoStart(_) => "give a first value for each parameter".to_owned(),
        }
    }
}

/// Fits the laws of the list to a free decay, or to several of the same body: parameters are shared, and each record has its own start,
/// offset and drift.
///
/// # Errors
/// [`FitError`].
///
/// ```
/// use lindstedt_fit::fit::answer::{FitOptions, fit};
/// use lindstedt_fit::fit::record::Record;
///
/// // x'' + 0.04 x' + 4 x = 0 from two amplitudes, with a ripple in place of noise.
/// let times: Vec<f64> = (0..600).map(|index| 0.05 * f64::from(index)).collect();
/// let decay = |t: &f64| (-0.02 * t).exp() * (2.0 * t).cos() + 3e-3 * (1e4 * t * t).sin();
/// let record = |size: f64| Record {
///     values: times.iter().map(|t| size * decay(t)).collect(),
///     times: times.clone(),
///     ..Record::default()
/// };
/// let answer = fit(&[record(1.0), record(0.5)], &FitOptions::default())?;
/// let best = answer.best().ok_or("a law")?;
/// let x0 = best.estimate("x0_2").ok_or("a start")?;
/// assert!((x0.value - 0.5).abs() < 4.0 * x0.error);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fit(
    records: &(impl AsRef<[Record]> + ?Sized),
    options: &FitOptions,
) -> Result<Answer, FitError> {
    let all = records.as_ref();
    let records = prepare(all, CountedPart::Decay, options)?;
    records.iter().try_for_each(FittedRecord::refuse_growth)?;
    let swings: Vec<&Swings> = records.iter().map(|own| &own.swings).collect();
    let laws = Law::list(all.iter().all(|record| record.is_angle));
    let found = fit_maps(&laws, &swings);
    let mut maps: Vec<(Law, Vec<MapFit>)> = laws.into_iter().zip(found).collect();
    maps.retain(|(_, found)| !found.is_empty());
    let number = swings.iter().map(|own| 2.0 * own.points.len() as f64).sum::<f64>();
    let score = |(law, maps): &(Law, Vec<MapFit>)| {
        maps[0].chi_square + number.ln() * law.parameters.len() as f64
    };
    maps.sort_by(|one, other| score(one).total_cmp(&score(other)));
    let (best, found) = maps.first().ok_or(FitError::NoMotion)?;
    let mut best = best.parts.ok_or(FitError::NoMotion)?;
    let least = found[0].chi_square;
    // A law that is far worse than the best one already by its turning points is not fitted to the samples.
    let is_far = |maps: &[MapFit]| maps[0].chi_square > FAR[0] * least + FAR[1];
    let excluded = maps.iter().filter(|(_, maps)| is_far(maps)).map(|(law, maps)| {
        let names = law.parameters.iter().map(|name| name.to_string());
        ExcludedLaw {
            law: law.clone(),
            values: names.zip(maps[0].parameters.iter().copied()).collect(),
            ratio: maps[0].chi_square / least,
        }
    });
    let excluded: Vec<ExcludedLaw> = excluded.collect();
    maps.retain(|(_, maps)| !is_far(maps));
    let samples: Vec<&Samples> = records.iter().map(|own| &own.samples).collect();
    let mut fits: Vec<SampleFit> = vec![];
    let mut tried: Vec<(Spring, Loss)> = vec![];
    // The best law by its turning points, and all that share the spring or the loss with it; again if another one wins.
    loop {
        let is_next = |(law, _): &&(Law, Vec<MapFit>)| {
            law.parts.is_some_and(|parts| {
                !tried.contains(&parts) && (parts.0 == best.0 || parts.1 == best.1)
            })
        };
        let next: Vec<&(Law, Vec<MapFit>)> = maps.iter().filter(is_next).collect();
        // The first law of a spring is searched from many starts, the others begin from the spring that it found.
        let is_known = |spring: Spring, fits: &[SampleFit]| {
            fits.iter().any(|fit| fit.law.parts.is_some_and(|parts| parts.0 == spring))
        };
        let spring_of = |(law, _): &&(Law, Vec<MapFit>)| law.parts.map(|parts| parts.0);
        let is_first = |place: usize| {
            let spring = spring_of(&next[place]);
            spring.is_some_and(|spring| !is_known(spring, &fits))
                && !next[..place].iter().any(|other| spring_of(other) == spring)
        };
        let (first, rest): (Vec<usize>, Vec<usize>) =
            (0..next.len()).partition(|place| is_first(*place));
        for places in [first, rest] {
            let own = par_map(&places, |place| {
                let (law, maps) = next[*place];
                fit_from_maps(law, maps, &records, &samples, &fits)
            });
            for fit in own {
                fits.extend(fit?);
            }
        }
        tried.extend(next.iter().filter_map(|(law, _)| law.parts));
        let winner = order(&mut fits, 1.0).and_then(|fit| fit.law.parts);
        match winner {
            Some(parts) if parts != best => best = parts,
            _ => break,
        }
    }
    refit_wider(&mut fits, &samples);
    Ok(Answer { excluded, ..finish(fits, records, options)? })
}

/// Fits a law of the list to the samples, from its fits to the turning points and from the best of the known fits with its spring.
fn fit_from_maps(
    law: &Law,
    maps: &[MapFit],
    records: &[FittedRecord],
    samples: &[&Samples],
    known: &[SampleFit],
) -> Result<Option<SampleFit>, FitError> {
    /// One of two starts may lead to a minimum of its own.
    const WITHOUT_KNOWN: usize = 2;
    let solver = MotionSolver::new(law)?;
    let spring = |law: &Law| law.parts.map(|parts| parts.0);
    let alike = known.iter().filter(|fit| spring(&fit.law) == spring(law));
    let best = alike.min_by(|one, other| one.square().total_cmp(&other.square()));
    let starts = match (best, maps.first()) {
        (Some(best), Some(map)) => {
            let own = start_of(&solver, records, map);
            let count = spring(law).map_or(0, Spring::count);
            let (width, known_width) = (law.parameters.len(), best.law.parameters.len());
            let loss = &map.parameters[count..width];
            let moved = [&best.values[..count], loss, &best.values[known_width..]].concat();
            let both = own.into_iter().chain([moved]).collect();
            nearest_starts(&solver, samples, both, 1)
        }
        _ => {
            let starts = maps.iter().filter_map(|map| start_of(&solver, records, map));
            nearest_starts(&solver, samples, starts.collect(), WITHOUT_KNOWN)
        }
    };
    let fits = starts.iter().filter_map(|start| fit_samples(law, &solver, samples, start));
    Ok(fits.min_by(|one, other| one.square().total_cmp(&other.square())))
}

/// Fits laws of one's own to one record or several, each from a start of its parameters; without one it is found from the accelerations.
/// The time in a law is that of each record.
///
/// # Errors
/// [`FitError`].
pub fn fit_laws(
    records: &(impl AsRef<[Record]> + ?Sized),
    laws: &[(Law, Option<Vec<f64>>)],
    options: &FitOptions,
) -> Result<Answer, FitError> {
    let is_driven = laws.iter().any(|(law, _)| law.is_driven());
    let counted = if is_driven { CountedPart::All } else { CountedPart::AfterRelease };
    let records = prepare(records.as_ref(), counted, options)?;
    let swings: Vec<&Swings> = records.iter().map(|own| &own.swings).collect();
    let samples: Vec<&Samples> = records.iter().map(|own| &own.samples).collect();
    let own = par_map(laws, |(law, start)| -> Result<Option<SampleFit>, FitError> {
        let solver = MotionSolver::new(law)?;
        let map = fit_maps(std::slice::from_ref(law), &swings).into_iter().flatten().next();
        let starts = match (start, map) {
            (None, Some(map)) => start_of(&solver, &records, &map).into_iter().collect(),
            (Some(parameters), _) => starts_about_centres(parameters, &records),
            (None, None) => {
                let both: Vec<_> = samples.iter().copied().zip(swings.iter().copied()).collect();
                let found = equation_error_parameters(law, &both);
                let found = found.ok_or_else(|| FitError::NoStart(law.equation.clone()))?;
                starts_about_centres(&found, &records)
            }
        };
        let fits = starts.iter().filter_map(|start| fit_samples(law, &solver, &samples, start));
        Ok(fits.min_by(|one, other| one.square().total_cmp(&other.square())))
    });
    let fits = own.into_iter().filter_map(Result::transpose).collect::<Result<_, FitError>>()?;
    finish(fits, records, options)
}

/// The starts whose motions are nearest to the samples, this number of them.
fn nearest_starts(
    solver: &MotionSolver,
    samples: &[&Samples],
    starts: Vec<Vec<f64>>,
    most: usize,
) -> Vec<Vec<f64>> {
    if starts.len() <= most {
        return starts;
    }
    let mut near: Vec<(f64, Vec<f64>)> = starts
        .into_iter()
        .filter_map(|start| Some((misfit(solver, samples, &start)?, start)))
        .collect();
    near.sort_by(|one, other| one.0.total_cmp(&other.0));
    near.into_iter().take(most).map(|(_, start)| start).collect()
}

fn prepare(
    records: &[Record],
    counted: CountedPart,
    options: &FitOptions,
) -> Result<Vec<FittedRecord>, FitError> {
    let own =
        records.iter().map(|record| FittedRecord::new(record, counted, options.keep_outliers));
    let mut records = own.collect::<Result<Vec<_>, _>>()?;
    if records.is_empty() {
        return Err(FitError::NoRecord);
    }
    weigh(&mut records);
    Ok(records)
}

/// Starts with these parameters: the offset is the centre of the swings, or zero, since a barrier on one side shifts the swings.
fn starts_about_centres(parameters: &[f64], records: &[FittedRecord]) -> Vec<Vec<f64>> {
    let [mut centred, mut plain] = [parameters.to_vec(), parameters.to_vec()];
    for own in records {
        let [x, v, level, drift] = initial_state(&own.samples, &own.swings);
        centred.extend([x, v, level, drift]);
        plain.extend([x + level, v, 0.0, 0.0]);
    }
    vec![centred, plain]
}

/// Parameters, then initial coordinate and velocity at the first sample, offset and drift of each record, from a fit to the turning points.
fn start_of(solver: &MotionSolver, records: &[FittedRecord], map: &MapFit) -> Option<Vec<f64>> {
    let mut start = map.parameters.clone();
    for (own, [x, time, level, drift]) in records.iter().zip(&map.starts) {
        let samples = &own.samples;
        // The motion from the first turning point backwards is that of the law without its loss, to first order in it: as
        // long forwards from the next turning point as the record begins before the first one.
        let lead = time - samples.times.first()?;
        let half_period = samples.half_period;
        let [x, v] = match lead.abs() < 1e-9 * half_period {
            true => [*x, 0.0],
            false => {
                let motion = |quantity| {
                    let times = [0.0, lead.abs()];
                    let sampled =
                        solver.sample(&map.parameters, [*x, 0.0], &times, half_period, quantity)?;
                    sampled.columns[0].get(1).copied()
                };
                let sign = if lead > 0.0 { -1.0 } else { 1.0 };
                let [x, v] = [motion(Quantity::Displacement)?, motion(Quantity::Velocity)?];
                [x, sign * v]
            }
        };
        let centre = match samples.quantity {
            Quantity::Displacement => [*level, *drift],
            Quantity::Velocity | Quantity::Acceleration => samples.centre,
        };
        start.extend([x, v]);
        start.extend(centre);
    }
    Some(start)
}

/// Orders fits by the criterion of Schwarz for residuals that are correlated over this number of samples, and returns the best one.
fn order(fits: &mut [SampleFit], correlation_length: f64) -> Option<&SampleFit> {
    fits.sort_by(|one, other| {
        bic(one, correlation_length).total_cmp(&bic(other, correlation_length))
    });
    fits.first()
}

fn bic(fit: &SampleFit, correlation_length: f64) -> f64 {
    let number = fit.residuals.len() as f64;
    let independent = number / correlation_length;
    independent * (fit.square() / number).ln() + fit.values.len() as f64 * independent.ln()
}

fn finish(
    mut fits: Vec<SampleFit>,
    mut records: Vec<FittedRecord>,
    options: &FitOptions,
) -> Result<Answer, FitError> {
    let best = order(&mut fits, 1.0).ok_or(FitError::NoMotion)?;
    let far = if options.keep_outliers { vec![] } else { far_samples(best) };
    if !far.is_empty() {
        let mut from = 0;
        for own in &mut records {
            let to = from + own.samples.times.len();
            let places = far.iter().filter(|place| (from..to).contains(place));
            own.leave_out(&places.map(|place| place - from).collect::<Vec<_>>());
            from = to;
        }
        let samples: Vec<&Samples> = records.iter().map(|own| &own.samples).collect();
        let again = par_map(&fits, |fit| {
            // The first sample may be gone: the start is that at the first one that is left.
            let solver = MotionSolver::new(&fit.law).ok()?;
            fit_samples(&fit.law, &solver, &samples, &fit.values)
        });
        fits = again.into_iter().flatten().collect();
    }
    let correlation_length =
        order(&mut fits, 1.0).map(correlation_length).ok_or(FitError::NoMotion)?;
    let best = order(&mut fits, correlation_length).ok_or(FitError::NoMotion)?;
    let freedom = |fit: &SampleFit| (fit.residuals.len() as f64 - fit.values.len() as f64).max(1.0);
    let noise = options.noise.unwrap_or((best.square() / freedom(best)).sqrt());
    let (least, most) = (best.square(), best.values.len());
    let laws = par_map(&fits, |fit| {
        let excess = (fit.square() - least) / (noise * noise * correlation_length);
        let more = most.saturating_sub(fit.values.len()).max(1);
        law_fit(fit, noise, [excess, excess / more as f64], correlation_length, &records)
    });
    Ok(Answer { laws, excluded: vec![], records, noise, correlation_length })
}

/// The samples whose residual is larger than noise ever makes it, unless they are too many to be outliers.
fn far_samples(fit: &SampleFit) -> Vec<usize> {
    const SHARE: f64 = 0.05;
    let count = fit.residuals.len() as f64;
    let deviation = median(fit.residuals.iter().map(|residual| residual.abs()).collect()) / 0.6745;
    // One of twenty records has a residual of pure noise beyond this.
    let limit = deviation * (2.0 * (20.0 * count).ln()).sqrt();
    let far = fit.residuals.iter().enumerate().filter(|(_, residual)| residual.abs() > limit);
    let far: Vec<usize> = far.map(|(index, _)| index).collect();
    if far.len() as f64 <= SHARE * count { far } else { vec![] }
}

/// The sum of the autocorrelations of residuals up to the first that is within noise; 1 for white residuals.
fn correlation_length(fit: &SampleFit) -> f64 {
    let whiteness = Whiteness::new(&fit.residuals);
    if whiteness.is_white() {
        return 1.0;
    }
    let threshold = 2.0 / (fit.residuals.len() as f64).sqrt();
    let first = whiteness.autocorrelation.iter().take_while(|own| **own > threshold);
    1.0 + 2.0 * first.sum::<f64>()
}

fn law_fit(
    fit: &SampleFit,
    noise: f64,
    [excess, exclusion]: [f64; 2],
    length: f64,
    records: &[FittedRecord],
) -> LawFit {
    let count = fit.residuals.len() as f64;
    let width = fit.values.len();
    let inverse = Covariance::new(&fit.jacobian);
    let square = fit.square();
    let freedom = (count - width as f64).max(1.0);
    let whiteness = Whiteness::new(&fit.residuals);
    // A law that does not fit has the scatter that it has.
    let variance = (square / freedom).max(noise * noise);
    let mut covariance = &inverse.matrix * variance;
    if !whiteness.is_white() {
        let reach = ((4.0 * length).ceil() as usize).max((count.powf(1.0 / 3.0)) as usize);
        let robust = robust_covariance(&fit.jacobian, &fit.residuals, &inverse.matrix, reach);
        // The estimate is used where it enlarges errors: it is itself uncertain.
        let larger =
            |index: usize| (robust[(index, index)] / covariance[(index, index)]).max(1.0).sqrt();
        let factors: Vec<f64> =
            (0..width).map(larger).map(|own| if own.is_finite() { own } else { 1.0 }).collect();
        covariance =
            DMatrix::from_fn(width, width, |i, j| covariance[(i, j)] * factors[i] * factors[j]);
    }
    let names = fit.law.parameters.iter().map(|name| name.to_string());
    let own = (1..=records.len()).flat_map(|number| {
        let suffix = if number == 1 { String::new() } else { format!("_{number}") };
        LOCAL_NAMES.map(|name| format!("{name}{suffix}"))
    });
    let names: Vec<String> = names.chain(own).collect();
    let estimates = names.iter().zip(&fit.values).enumerate().map(|(index, (name, value))| {
        // A parameter that the record leaves open has no error to speak of.
        let is_open = inverse.flat.iter().any(|direction| is_part_of(direction, index));
        let error = match is_open {
            true => f64::INFINITY,
            false => covariance[(index, index)].max(0.0).sqrt(),
        };
        Estimate { name: name.clone(), value: *value, error }
    });
    let estimates: Vec<Estimate> = estimates.collect();
    let correlations = DMatrix::from_fn(width, width, |i, j| {
        covariance[(i, j)] / (estimates[i].error * estimates[j].error).max(f64::MIN_POSITIVE)
    });
    let weights = records.iter().map(|own| &own.samples);
    let weights = weights.flat_map(|own| std::iter::repeat_n(own.weight, own.times.len()));
    let flat = inverse.flat.iter().map(|direction| in_words(direction, &names)).collect();
    LawFit {
        law: fit.law.clone(),
        correlations,
        residual_square: square,
        chi_square: square / (noise * noise) / freedom,
        aic: count * (square / count).ln() + 2.0 * width as f64,
        bic: bic(fit, length),
        excess,
        exclusion,
        whiteness,
        flat,
        converged: fit.converged,
        residuals: fit.residuals.iter().zip(weights).map(|(own, weight)| own / weight).collect(),
        covariance,
        estimates,
    }
}

/// Whether a parameter changes along a direction to speak of.
fn is_part_of(direction: &[f64], index: usize) -> bool {
    const SMALL: f64 = 1e-3;
    let largest = direction.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    direction[index].abs() > SMALL * largest
}

/// A direction of the parameters along which the fit does not change, in words.
fn in_words(direction: &[f64], names: &[String]) -> String {
    let largest = direction.iter().copied().max_by(|one, other| one.abs().total_cmp(&other.abs()));
    let largest = largest.unwrap_or(1.0);
    let parts = direction.iter().zip(names).enumerate();
    let parts = parts.filter(|(index, _)| is_part_of(direction, *index));
    let parts: Vec<String> =
        parts.map(|(_, (part, name))| format!("{name} by {:.3}", part / largest)).collect();
    format!("the fit does not change if one changes {}", parts.join(", "))
}

impl Answer {
    /// The best law.
    pub fn best(&self) -> Option<&LawFit> {
        self.laws.first()
    }

    /// The values that a law predicts for a record, counted from 0, at increasing times from its first sample on, with their
    /// standard errors: those of the fitted curve, without the noise of a sample. Returns `None` if there is no such record, or
    /// the motion cannot be followed.
    pub fn predict(&self, law: &LawFit, record: usize, times: &[f64]) -> Option<Vec<[f64; 2]>> {
        let samples = &self.records.get(record)?.samples;
        let count = self.records.len();
        let solver = MotionSolver::new(&law.law).ok()?;
        let first = *samples.times.first()?;
        // The motion begins at the first sample.
        let all: Vec<f64> = std::iter::once(first).chain(times.iter().copied()).collect();
        let values = values_of(&law.values(), count, record);
        let motion = motion(&solver, samples, &values, &all)?;
        let [offset, drift] = *values.last_chunk::<2>()?;
        let width = values.len();
        let shared = width - LOCAL;
        let place = |index: usize| if index < shared { index } else { index + LOCAL * record };
        let covariance =
            DMatrix::from_fn(width, width, |i, j| law.covariance[(place(i), place(j))]);
        let row = |index: usize| {
            let lag = all[index] - samples.middle;
            let slope = |column: usize| match width - column {
                2 => 1.0,
                1 => lag,
                _ => motion.columns[column + 1][index],
            };
            let slopes = nalgebra::DVector::from_fn(width, |column, _| slope(column));
            let variance = slopes.dot(&(&covariance * &slopes));
            [motion.columns[0][index] + offset + drift * lag, variance.max(0.0).sqrt()]
        };
        Some((1..all.len()).map(row).collect())
    }

    /// The residuals of a law at the samples of a record, counted from 0.
    pub fn residuals<'a>(&self, law: &'a LawFit, record: usize) -> &'a [f64] {
        let length = |own: &FittedRecord| own.samples.times.len();
        let from: usize = self.records.iter().take(record).map(length).sum();
        let length = self.records.get(record).map_or(0, length);
        law.residuals.get(from..from + length).unwrap_or_default()
    }

    /// The laws but the best one, each with what the record says against it, a line each.
    pub fn exclusions(&self) -> Vec<String> {
        const ALIKE: f64 = 9.0;
        let near = self.laws.iter().skip(1).map(|law| match law.excess < ALIKE {
            true => format!("{}: not excluded by this record", law.law.name),
            false => format!(
                "{}: its misfit is {:.0} times what noise explains",
                law.law.name, law.exclusion
            ),
        });
        let far = self.excluded.iter().map(|law| {
            format!("{}: {:.0} times worse at the turning points", law.law.name, law.ratio)
        });
        near.chain(far).collect()
    }
}
