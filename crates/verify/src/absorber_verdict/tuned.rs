//! The response of a main mass with a tuned mass damper, computed from the two equations at each
//! frequency and searched: where curves of different damping cross, where the highest peak is
//! lowest, where the variance is least.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::{AbsorberCurve, AbsorberCurveKind, LowestPeak, Truth};
use crate::absorber::{AbsorberLaws, Excitation};
use crate::numeric::ode::quadrature::integrate_piecewise;
use crate::numeric::ode::root::{find_minimum, find_root};
use crate::symbol::Symbol;
use crate::values::Values;

/// The least mass ratio at which doubles resolve the peaks.
const LEAST_MASS_RATIO: f64 = 1e-6;

/// The largest damping ratio that is searched.
const MOST_DAMPING: f64 = 1e3;

/// A main mass with its absorber.
#[derive(Clone, Copy)]
struct TwoMasses {
    excitation: Excitation,
    mass_ratio: f64,
    /// The damping ratio of the main mass.
    main_damping: f64,
}

/// Tuning f and damping ratio zeta of the absorber.
#[derive(Clone, Copy)]
struct Absorber {
    tuning: f64,
    damping: f64,
}

impl TwoMasses {
    /// The amplitude of x at a frequency, the right side of amplitude 1.
    fn amplitude(self, absorber: Absorber, frequency: f64) -> f64 {
        let square = frequency * frequency;
        let link = Complex64::new(
            absorber.tuning * absorber.tuning,
            2.0 * absorber.damping * absorber.tuning * frequency,
        );
        // (1 - g^2 + mu k) x - mu k y = F1,   -k x + (k - g^2) y = F2.
        let force = match self.excitation {
            Excitation::Force => [1.0, 0.0],
            Excitation::Ground => [1.0, 1.0],
        };
        let own = Complex64::new(1.0 - square, 2.0 * self.main_damping * frequency);
        let first = self.mass_ratio * link + own;
        let second = link - square;
        let determinant = first * second - self.mass_ratio * link * link;
        ((second * force[0] + self.mass_ratio * link * force[1]) / determinant).norm()
    }

    /// The amplitude over the static one.
    fn magnification(self, absorber: Absorber, frequency: f64) -> f64 {
        self.amplitude(absorber, frequency) / self.amplitude(absorber, 0.0)
    }

    /// The root of the mass ratio, with which distances of frequencies and dampings grow; at most 1.
    fn scale(self) -> f64 {
        self.mass_ratio.sqrt().min(1.0)
    }

    /// Frequencies at which peaks are looked for: all, and those near the absorber alone closely.
    fn frequencies(self) -> Vec<f64> {
        const STEPS: u32 = 200;
        let lowest = match self.excitation {
            Excitation::Force => 0.1 / (1.0 + self.mass_ratio),
            // The lower fixed point tends to 0 as the mass ratio tends to 2.
            Excitation::Ground => {
                0.1 / (1.0 + self.mass_ratio) * (1.0 - 0.5 * self.mass_ratio).max(1e-3)
            }
        };
        let between = |from: f64, to: f64| {
            let decades = (to / from).ln();
            (0..=STEPS).map(move |step| from * (decades * f64::from(step) / f64::from(STEPS)).exp())
        };
        let near = (3.0 * self.scale()).min(1.0).exp();
        let middle = 1.0 / (1.0 + self.mass_ratio).sqrt();
        let mut found: Vec<f64> =
            between(lowest, 4.0).chain(between(middle / near, middle * near)).collect();
        found.sort_by(f64::total_cmp);
        found.dedup();
        found
    }

    /// The least and the greatest tuning that are searched.
    fn tunings(self) -> [f64; 2] {
        let around = 1.0 / (1.0 + self.mass_ratio);
        let wide = 2.0 * self.scale();
        // A heavy absorber is searched up to the frequency of both masses together.
        [around * (1.0 - wide).max(0.02), around * (1.0 + wide) * (1.0 + self.mass_ratio).sqrt()]
    }

    /// The highest magnification.
    fn highest(self, absorber: Absorber) -> f64 {
        let rows: Vec<(f64, f64)> =
            self.frequencies().into_iter().map(|g| (g, self.magnification(absorber, g))).collect();
        let mut highest = 1.0_f64;
        for near in rows.windows(3) {
            if near[1].1 >= near[0].1 && near[1].1 >= near[2].1 {
                let inverse = |g| 1.0 / self.magnification(absorber, g);
                highest = highest.max(1.0 / find_minimum(inverse, near[0].0, near[2].0).1);
            }
        }
        highest
    }

    /// The variance of x where the right side is white noise of intensity 1.
    fn variance(self, absorber: Absorber) -> f64 {
        let density = |g: f64| self.amplitude(absorber, g).powi(2);
        // Peaks are narrow; frequencies above 2 by their inverses.
        let near = 0.4 * self.scale();
        let ends = [0.0, 0.5, 1.0 - near, 1.0 - near / 4.0, 1.0, 1.0 + near / 4.0, 1.0 + near, 2.0];
        // At a narrow peak the determinant is a difference of nearly equal numbers.
        let tolerance = (1e-13 / self.mass_ratio).clamp(1e-12, 1e-6);
        let below = integrate_piecewise(density, &ends, tolerance);
        let tail = |u: f64| density(1.0 / u) / (u * u);
        let above = integrate_piecewise(tail, &[1e-9, 0.5], tolerance);
        match (below, above) {
            (Ok(below), Ok(above)) => (below.0 + above.0) / PI,
            _ => f64::NAN,
        }
    }

    /// The two frequencies at which the damping does not matter.
    fn fixed_points(self, tuning: f64) -> Option<[f64; 2]> {
        let difference = |g: f64| {
            self.magnification(Absorber { tuning, damping: 0.2 * self.scale() }, g)
                - self.magnification(Absorber { tuning, damping: self.scale() }, g)
        };
        let frequencies = self.frequencies();
        let roots: Vec<f64> = frequencies
            .windows(2)
            .filter(|pair| difference(pair[0]) * difference(pair[1]) < 0.0)
            .filter_map(|pair| find_root(difference, pair[0], pair[1]).ok())
            .collect();
        <[f64; 2]>::try_from(roots).ok()
    }

    /// The tuning at which the fixed points are equally high.
    fn equal_tuning(self) -> Option<f64> {
        const STEPS: u32 = 100;
        let difference = |tuning: f64| {
            let points = self.fixed_points(tuning)?;
            let [low, high] =
                points.map(|g| self.magnification(Absorber { tuning, damping: self.scale() }, g));
            Some(low - high)
        };
        let [from, to] = self.tunings();
        let tunings =
            (0..=STEPS).map(|step| from + (to - from) * f64::from(step) / f64::from(STEPS));
        let known: Vec<(f64, f64)> =
            tunings.filter_map(|tuning| Some((tuning, difference(tuning)?))).collect();
        let bracket = known.windows(2).find(|pair| pair[0].1 * pair[1].1 <= 0.0)?;
        let found = |tuning| difference(tuning).unwrap_or(f64::NAN);
        find_root(found, bracket[0].0, bracket[1].0).ok()
    }

    /// The damping at which the curve is level at a frequency.
    fn level_damping(self, tuning: f64, frequency: f64) -> Option<f64> {
        let slope = |damping: f64| {
            let absorber = Absorber { tuning, damping };
            let step = 1e-4 * self.scale() * frequency;
            let at = |k: f64| self.magnification(absorber, frequency + k * step);
            (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step)
        };
        // On shaken ground the damping grows without bound as the mass ratio tends to 2.
        let mut most = 5.0 * self.scale();
        while most < MOST_DAMPING && slope(1e-2 * self.scale()) * slope(most) > 0.0 {
            most *= 2.0;
        }
        find_root(slope, 1e-2 * self.scale(), most).ok()
    }

    /// The absorber with the least cost, and the cost.
    fn best(self, cost: &dyn Fn(Absorber) -> f64) -> (Absorber, f64) {
        let scale = self.scale();
        let damped = |tuning: f64| {
            let cost = |damping: f64| cost(Absorber { tuning, damping });
            // On shaken ground the damping grows without bound as the mass ratio tends to 2.
            let mut most = 3.0 * scale;
            while most < MOST_DAMPING && cost(2.0 * most) < cost(most) {
                most *= 2.0;
            }
            find_minimum(cost, 0.05 * scale, 2.0 * most)
        };
        let [from, to] = self.tunings();
        let (tuning, least) = find_minimum(|tuning| damped(tuning).1, from, to);
        (Absorber { tuning, damping: damped(tuning).0 }, least)
    }

    /// The absorber whose highest peak is the lowest.
    fn lowest_peak(self) -> LowestPeak {
        let (best, height) = self.best(&|absorber| self.highest(absorber));
        LowestPeak { tuning: best.tuning, damping: best.damping, height }
    }
}

/// The lowest peak under a force on a main mass without damping; `None` where doubles do not resolve
/// the peaks.
pub(super) fn lowest_peak(mass_ratio: f64) -> Option<LowestPeak> {
    if mass_ratio < LEAST_MASS_RATIO {
        return None;
    }
    Some(TwoMasses { excitation: Excitation::Force, mass_ratio, main_damping: 0.0 }.lowest_peak())
}

/// The true values of the designs, and response curves.
pub(super) fn truth(laws: &AbsorberLaws, excitation: Excitation, at: &Values) -> Truth {
    let mass_ratio = at.get(Symbol::new("mu")).unwrap_or(f64::NAN);
    let main_damping = at.get(Symbol::new("zeta_1")).unwrap_or(0.0);
    let system = TwoMasses { excitation, mass_ratio, main_damping };
    if mass_ratio < LEAST_MASS_RATIO {
        return Truth { curves: curves(laws, system, None, at), ..Truth::default() };
    }
    let lowest = system.lowest_peak();
    let mut values = Vec::new();
    if laws.design("equal-peaks").is_none() {
        values.extend(lowest_variance(system));
        let curves = damped_curves(laws, system, lowest, at);
        return Truth { values, curves, lowest_peak: Some(lowest), ..Truth::default() };
    }
    let tuning = system.equal_tuning();
    let points = tuning.and_then(|tuning| system.fixed_points(tuning));
    let damping = tuning.zip(points).and_then(|(tuning, [low, high])| {
        let squares = system.level_damping(tuning, low)?.powi(2)
            + system.level_damping(tuning, high)?.powi(2);
        Some((squares / 2.0).sqrt())
    });
    let height = tuning.zip(points).map(|(tuning, [low, _])| {
        system.magnification(Absorber { tuning, damping: system.scale() }, low)
    });
    for (name, value) in [
        ("tuning", tuning),
        ("damping", damping),
        ("height", height),
        ("lower_frequency", points.map(|points| points[0])),
        ("upper_frequency", points.map(|points| points[1])),
    ] {
        values.push(("equal-peaks", name, value));
    }
    for (name, value) in
        [("tuning", lowest.tuning), ("damping", lowest.damping), ("height", lowest.height)]
    {
        values.push(("lowest-peak", name, Some(value)));
    }
    values.extend(lowest_variance(system));
    let lowest = laws.design("lowest-peak").is_none().then_some(lowest);
    Truth {
        values,
        curves: curves(laws, system, lowest, at),
        lowest_peak: lowest,
        ..Truth::default()
    }
}

/// The numbers of the lowest variance.
fn lowest_variance(system: TwoMasses) -> [(&'static str, &'static str, Option<f64>); 3] {
    let (best, variance) = system.best(&|absorber| system.variance(absorber));
    [("tuning", best.tuning), ("damping", best.damping), ("variance", variance)]
        .map(|(name, value)| ("lowest-variance", name, Some(value)))
}

/// The response on a damped main mass with the design, and with that of the lowest peak, which is
/// searched.
fn damped_curves(
    laws: &AbsorberLaws,
    system: TwoMasses,
    lowest: LowestPeak,
    at: &Values,
) -> Vec<AbsorberCurve> {
    let value = |name: &str| laws.named_value("lowest-variance", name, at);
    let Some((tuning, damping)) = value("tuning").zip(value("damping")) else { return vec![] };
    // Both peaks are about so far from the frequency of both masses together, or as wide as the
    // damping of the main mass makes them.
    let near = (2.5 * system.scale().max(system.main_damping)).min(1.0).exp();
    let middle = 1.0 / (1.0 + system.mass_ratio).sqrt();
    let frequencies = match system.mass_ratio > 1.0 {
        true => [0.4 * lowest.tuning.min(tuning), 1.6],
        false => [middle / near, middle * near],
    };
    let design = Absorber { tuning, damping };
    vec![
        response("lowest variance".to_owned(), system, design, frequencies),
        response(BY_SEARCH.to_owned(), system, Absorber::from(lowest), frequencies),
    ]
}

/// The label of the response of a design that no formula gives.
const BY_SEARCH: &str = "lowest peak, by a search";

impl From<LowestPeak> for Absorber {
    fn from(lowest: LowestPeak) -> Self {
        Self { tuning: lowest.tuning, damping: lowest.damping }
    }
}

/// The response between two frequencies, at equal ratios: with a heavy absorber they are decades apart.
fn response(
    label: String,
    system: TwoMasses,
    absorber: Absorber,
    [from, to]: [f64; 2],
) -> AbsorberCurve {
    const POINTS: u32 = 600;
    let points = (0..=POINTS)
        .map(|step| from * (to / from).powf(f64::from(step) / f64::from(POINTS)))
        .map(|g| (g, system.magnification(absorber, g)));
    AbsorberCurve { label, kind: AbsorberCurveKind::Truth, points: points.collect() }
}

/// The response with each design, and with other dampings through the fixed points.
fn curves(
    laws: &AbsorberLaws,
    system: TwoMasses,
    lowest: Option<LowestPeak>,
    at: &Values,
) -> Vec<AbsorberCurve> {
    let value = |design: &str, name: &str| laws.named_value(design, name, at);
    let points =
        value("equal-peaks", "lower_frequency").zip(value("equal-peaks", "upper_frequency"));
    let Some((low, high)) = points else { return vec![] };
    // With a heavy absorber the main mass alone has its frequency far above both fixed points.
    let alone = if system.mass_ratio > 1.0 { 1.5 } else { 0.0 };
    let frequencies = [(2.0 * low - high).max(0.4 * low), (2.0 * high - low).max(alone)];
    let design = |name: &str| {
        let (tuning, damping) = value(name, "tuning").zip(value(name, "damping"))?;
        Some(Absorber { tuning, damping })
    };
    let mut curves = Vec::new();
    if let Some(equal) = design("equal-peaks") {
        for factor in [0.5, 0.75, 1.5, 2.5] {
            let label = "the same tuning, other dampings".to_owned();
            let other = Absorber { damping: factor * equal.damping, ..equal };
            let curve = response(label, system, other, frequencies);
            curves.push(AbsorberCurve { kind: AbsorberCurveKind::Background, ..curve });
        }
    }
    for own in &laws.designs {
        let Some(absorber) = design(own.name) else { continue };
        curves.push(response(own.name.replace('-', " "), system, absorber, frequencies));
    }
    curves.extend(
        lowest.map(|lowest| response(BY_SEARCH.to_owned(), system, lowest.into(), frequencies)),
    );
    if let Some(height) = value("equal-peaks", "height") {
        curves.push(AbsorberCurve {
            label: "fixed points".to_owned(),
            kind: AbsorberCurveKind::Points,
            points: vec![(low, height), (high, height)],
        });
    }
    curves
}
