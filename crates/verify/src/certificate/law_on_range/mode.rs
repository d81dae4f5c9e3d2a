//! `1/omega` of a nonlinear normal mode on a range of amplitudes, enclosed: one branch of motions, on each of
//! some pieces a polynomial in the amplitude with a bound of its distance from the truth.
//!
//! ```text
//! q'' + f(q) = 0,  q = a v(omega t):     v'' + mu g(v; a) = 0,   g = f(a v)/a,   mu = 1/omega^2,   condition(v) = 1
//! piece a = c + h e, |e| <= 1:     one motion for each a, within s of an approximation that is a polynomial in e
//! |1/omega - w| <= (||mu~ - w^2|| + s/sigma)/min w               mu~ the approximation, w a polynomial in e
//! ```
//!
//! The motion over its amplitude has a limit at rest, where that of a polynomial f is analytic in a, so that
//! ranges begin at zero. Approximate motions are Chebyshev's series through those at some amplitudes
//! (`theorem/on_piece`). At the end that two pieces share, the motion of the one is in the ball of the other, so
//! that all are one continuous branch. It is told from others by an approximate motion at the lower end, near
//! which it has to be, and near which there is no other.
//!
//! In: equations, the definition of the amplitude, an approximate motion and a range. Out: the pieces. One
//! costs a proof, and twenty approximate motions.
//!
//! Sources: those of `theorem` and of `law_on_range`.

mod newton;

use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use super::super::HIGHEST_HARMONIC;
use super::super::candidate::{INVERSE_BITS, inverse, odd_below, units};
use super::super::elementary::Analytic as _;
use super::super::force::is_odd;
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::law;
use super::super::modes::{
    MOST_COORDINATES, ModeAmplitude, last_harmonic_of_largest_block, mode_branch,
};
use super::super::radii_polynomial::NotProved;
use super::super::sheet::Sheet;
use super::super::theorem::{
    ApproximateMotion, ApproximateMotions, Condition, ConservativeProblem, MotionsOnPiece,
    NearMotion,
};
use super::LawNotProved;
use super::inverse_frequency::{PiecePolynomial, Scale, TruthPiece};
use super::jet::widened;
use crate::decimal::decimal;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError, Node};
use crate::interrupt::Supervision;
use crate::modes::{FreeSystem, NonlinearMode};
use crate::parallel::par_map;
use crate::symbol::Symbol;
use newton::{ApproximateCondition, ModeSolver, ScaledMotion};

/// The motions of a mode, one for each amplitude of a range.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeBranch {
    /// The symbols of the coordinates.
    pub coordinates: Vec<Symbol>,
    /// `f` of `q'' + f(q) = 0`, one for each coordinate, in the coordinates and numbers.
    pub forces: Vec<Expr>,
    /// The definition of the amplitude.
    pub measure: ModeAmplitude,
    /// `1/omega^2` at the lower end of the range, to some digits: which of the branches it is.
    pub mu: Rational,
    /// The cosine coefficients of each coordinate over the amplitude there, that of the constant first.
    pub coefficients: Vec<Vec<Rational>>,
}

/// The distance up to which the motion at the lower end is that of the branch, as a power of two:
/// `|1/omega^2 - mu|` and the sum of those of the coefficients.
const SAME_MOTION: i32 = -20;

/// Binary digits of approximate motions.
const BITS: usize = 60;

/// Amplitudes of a piece at which approximate motions are found.
const NODES: usize = 20;

/// Harmonics smaller than this power of two, its sign changed, need not be known where a contraction is bounded.
const SHORT: i32 = 30;

/// The largest distance of the polynomial of a piece from `1/omega`, as a power of two.
const ACCURATE: i32 = -37;

/// The least part of the range that a piece may be, as a power of two.
const THINNEST: u32 = 14;

impl ModeBranch {
    /// The branch of a mode from an amplitude on, of a system with numbers for all parameters.
    ///
    /// # Errors
    /// No motion of the mode at that amplitude, or an inertia that depends on the position.
    pub fn new(
        system: &FreeSystem,
        mode: &NonlinearMode,
        from: &Rational,
    ) -> Result<Self, LawNotProved> {
        mode_branch(system, mode, from).map_err(|error| LawNotProved::NoBranch(Box::new(error)))
    }

    /// Checks that sizes and letters fit together; the error names what does not.
    pub(super) fn well_formed(&self, variable: Symbol) -> Result<(), &'static str> {
        let count = self.coordinates.len();
        let apart = |(place, name)| !self.coordinates[..place].contains(name);
        let is_known =
            |force: &Expr| force.symbols().iter().all(|name| self.coordinates.contains(name));
        let measure_fits = match &self.measure {
            ModeAmplitude::Start(coordinate) => *coordinate < count,
            ModeAmplitude::FirstHarmonic(factors) => {
                factors.len() == count
                    && factors.iter().all(|factor| law::exact_number(factor).is_some())
            }
        };
        let short = |list: &Vec<Rational>| list.len() <= HIGHEST_HARMONIC;
        let demands = [
            ((1..=MOST_COORDINATES).contains(&count), "more than 40 coordinates, or none"),
            (self.coordinates.iter().enumerate().all(apart), "two coordinates of one name"),
            (!self.coordinates.contains(&variable), "a variable that is a coordinate"),
            (
                self.forces.len() == count && self.coefficients.len() == count,
                "another number of forces or motions than of coordinates",
            ),
            (self.forces.iter().all(is_known), "a force with letters that have no value"),
            (measure_fits, "a definition of the amplitude that does not fit the coordinates"),
            (self.mu.is_positive(), "a frequency without a value"),
            (self.coefficients.iter().all(short), "more than 400 harmonics"),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }

    /// The pieces of a range of amplitudes.
    ///
    /// # Errors
    /// A part of the range on which no motion is proved.
    pub(super) fn pieces(
        &self,
        variable: Symbol,
        from: &Rational,
        to: &Rational,
        supervision: Supervision,
    ) -> Result<Vec<TruthPiece>, LawNotProved> {
        let equations = ScaledEquations::new(self, variable, from.is_zero())?;
        let steps = 1_u32 << THINNEST;
        let place =
            |position: u32| from + (to - from) * Rational::new(position.into(), steps.into());
        let (mut position, mut width) = (0, steps / 8);
        let mut pieces = vec![];
        // The motion at the end of the piece before.
        let mut end: Option<EndOfPiece> = None;
        let begin = equations.begin(self, from)?;
        while position < steps {
            if supervision.interrupt.is_requested() {
                return Err(LawNotProved::Stopped);
            }
            let next = (position + width).min(steps);
            let near = end.as_ref().map_or(&begin, |end| &end.approximate);
            let ends = [&place(position), &place(next)];
            let found = equations.piece(ends, near, &|motions| match &end {
                Some(end) => Ok(motions.holds(&end.found)),
                None => ScaledEquations::begins_near(motions, self),
            });
            match found {
                Ok((piece, own_end)) => {
                    pieces.push(piece);
                    width = wider(width, own_end.contraction);
                    (end, position) = (Some(own_end), next);
                }
                Err(NotEnclosed::Never(error)) => return Err(error),
                Err(NotEnclosed::Wide) if width == 1 => {
                    return Err(LawNotProved::NoMode(decimal(to_f64(ends[0]))));
                }
                Err(NotEnclosed::Wide) => width = (width * 2 / 3).min(next - position).max(1),
            }
        }
        Ok(pieces)
    }
}

/// The width of the next piece, on which the contraction is to be bounded by a little less than one.
fn wider(width: u32, contraction: f64) -> u32 {
    const LESS: f64 = 0.85;
    let next = f64::from(width) * (LESS / contraction).clamp(0.75, 1.5);
    next.to_u32().unwrap_or(width).max(1)
}

/// The reason why a piece is not enclosed.
enum NotEnclosed {
    /// A narrower one may be.
    Wide,
    /// No part of it is.
    Never(LawNotProved),
}

impl From<NotProved> for NotEnclosed {
    fn from(reason: NotProved) -> Self {
        match reason {
            NotProved::Derivative(error) => Self::Never(error.into()),
            _ => Self::Wide,
        }
    }
}

/// The upper end of a piece and its motion.
struct EndOfPiece {
    approximate: ScaledMotion,
    found: NearMotion,
    /// The bound of the contraction of the proof, which has to be below one.
    contraction: f64,
}

/// The equations of motions over their amplitude.
struct ScaledEquations {
    forces: Vec<Expr>,
    coordinates: Vec<Symbol>,
    variable: Symbol,
    condition: Condition,
    odd: bool,
    solver: ModeSolver,
}

impl ScaledEquations {
    fn new(
        branch: &ModeBranch,
        variable: Symbol,
        begins_at_rest: bool,
    ) -> Result<Self, LawNotProved> {
        let amplitude = Expr::from(variable);
        let zeros = branch.coordinates.iter().map(|name| (*name, Expr::zero())).collect();
        let mut forces = vec![];
        for force in &branch.forces {
            let at_zero = force.substitute_all(&zeros)?.expand()?;
            if !at_zero.is_zero() {
                return Err(LawNotProved::NotCentred(force.to_string()));
            }
            let mut scaled = over_amplitude(force, branch, &amplitude)?;
            let has_limit = |force: &Expr| force.substitute(variable, &Expr::zero()).is_ok();
            if begins_at_rest && !has_limit(&scaled) {
                scaled = scaled.expand()?;
                if !has_limit(&scaled) {
                    return Err(LawNotProved::FromRest(force.to_string()));
                }
            }
            forces.push(scaled);
        }
        let mut odd =
            branch.coefficients.iter().all(|list| list.iter().step_by(2).all(Rational::is_zero));
        for force in &branch.forces {
            odd = odd && is_odd(force, &branch.coordinates)?;
        }
        let one = WORKING.integer(1);
        let (condition, approximate) = match &branch.measure {
            ModeAmplitude::Start(coordinate) => (
                Condition::Start { coordinate: *coordinate, place: one },
                ApproximateCondition::Start(*coordinate),
            ),
            ModeAmplitude::FirstHarmonic(factors) => {
                let none = || LawNotProved::Malformed("a factor of the amplitude without a value");
                let factors: Option<Vec<Ball>> = factors.iter().map(law::exact_number).collect();
                let factors = factors.ok_or_else(none)?;
                let doubles = factors.iter().map(|factor| WORKING.nearest(factor)).collect();
                (
                    Condition::FirstHarmonic { factors, amplitude: one },
                    ApproximateCondition::FirstHarmonic(doubles),
                )
            }
        };
        let coordinates = branch.coordinates.clone();
        let solver = ModeSolver::new(&forces, &coordinates, variable, approximate, odd)?;
        Ok(Self { forces, coordinates, variable, condition, odd, solver })
    }

    /// The approximate motion at the lower end of the range.
    fn begin(&self, branch: &ModeBranch, from: &Rational) -> Result<ScaledMotion, LawNotProved> {
        let lists = branch.coefficients.iter().map(|list| list.iter().map(to_f64).collect());
        let seed =
            ScaledMotion { mu: to_f64(&branch.mu), cosines: lists.collect(), stiffness: 0.0 };
        let from = to_f64(from);
        let none = || LawNotProved::NoMode(decimal(from));
        self.solver.motion(from, &seed).ok_or_else(none)
    }

    /// Whether the motion of a piece at the lower end of the range is that which names the branch, and no other one
    /// is as near to its numbers.
    fn begins_near(motions: &MotionsOnPiece, branch: &ModeBranch) -> Result<bool, NotEnclosed> {
        let series = |list: &Vec<Rational>| {
            FourierSeries::exactly(list.iter().map(|c| WORKING.fraction(c)).collect(), vec![])
        };
        let named = ApproximateMotion {
            mu: WORKING.fraction(&branch.mu),
            motions: branch.coefficients.iter().map(series).collect(),
        };
        let [of_mu, of_motions] = motions.approximate().motion(Sheet::at_begin).apart(&named);
        let distance = Bound::power_of_two(SAME_MOTION);
        if of_mu + of_motions + motions.distance_of_all() > distance {
            return Err(NotEnclosed::Never(LawNotProved::AnotherMode));
        }
        let sigma = Bound::exactly(1.0);
        Ok(motions.holds(&NearMotion { motion: named, distance, sigma }))
    }

    /// Approximate motions of all amplitudes on a piece about that in its middle, and the root of their mu.
    fn approximate(
        &self,
        [middle, half]: [&Rational; 2],
        own: &ScaledMotion,
    ) -> Option<(ApproximateMotions, Vec<Integer>, ScaledMotion)> {
        let angles: Vec<f64> =
            (0..NODES).map(|j| std::f64::consts::PI * (j as f64 + 0.5) / NODES as f64).collect();
        let place = |angle: &f64| to_f64(middle) + to_f64(half) * angle.cos();
        let found = par_map(&angles, |angle| self.solver.motion(place(angle), own));
        let found = found.into_iter().collect::<Option<Vec<ScaledMotion>>>()?;
        let row = |value: &dyn Fn(&ScaledMotion) -> f64| -> Vec<Integer> {
            let coefficient = |n: usize| {
                let waves = angles.iter().zip(&found);
                let sum: f64 = waves.map(|(angle, at)| value(at) * (n as f64 * angle).cos()).sum();
                sum * if n == 0 { 1.0 } else { 2.0 } / NODES as f64
            };
            (0..NODES).map(|n| units(coefficient(n), BITS)).collect()
        };
        let last = found.iter().flat_map(|at| &at.cosines).map(Vec::len).max().unwrap_or(0);
        let motion = |i: usize| {
            let harmonic = |k: usize| match self.odd && k.is_multiple_of(2) {
                true => vec![],
                false => row(&|at| at.cosines[i].get(k).copied().unwrap_or(0.0)),
            };
            Sheet::of_units(&(0..last).map(harmonic).collect::<Vec<_>>(), BITS)
        };
        let [middle, half] = [middle, half].map(|number| WORKING.fraction(number));
        let approximate = ApproximateMotions {
            parameter: Sheet::interval(&middle, &half),
            mu: Sheet::of_units(&[row(&|at| at.mu)], BITS),
            motions: (0..self.coordinates.len()).map(motion).collect(),
        };
        Some((approximate, row(&|at| at.mu.sqrt()), found.into_iter().next()?))
    }

    /// The last harmonic of the block: beyond it `mu |Df|/k^2` is small.
    fn highest(&self, motion: &ScaledMotion) -> usize {
        const SMALL: f64 = 0.1;
        const LEAST: usize = 3;
        let last = (motion.mu * motion.stiffness / SMALL).sqrt().ceil();
        let most = last_harmonic_of_largest_block(self.coordinates.len(), self.odd);
        odd_below(last.to_usize().unwrap_or(LEAST).max(LEAST) | 1, most)
    }

    /// `1/omega` between two amplitudes and the motion at the upper one; `joins` says whether the motions are
    /// those of the branch.
    fn piece(
        &self,
        [from, to]: [&Rational; 2],
        near: &ScaledMotion,
        joins: &dyn Fn(&MotionsOnPiece) -> Result<bool, NotEnclosed>,
    ) -> Result<(TruthPiece, EndOfPiece), NotEnclosed> {
        let two = Integer::from(2);
        let (middle, half) = ((from + to) / &two, (to - from) / &two);
        let own = self.solver.motion(to_f64(&middle), near).ok_or(NotEnclosed::Wide)?;
        let found = self.approximate([&middle, &half], &own).ok_or(NotEnclosed::Wide)?;
        let (approximate, root, last) = found;
        let mean = approximate.motion(Sheet::means);
        let short = |series: FourierSeries| series.of_digits(0).shortened(SHORT);
        let interval = widened(&WORKING.fraction(&middle), Bound::of_fraction(&half));
        let mut problem = ConservativeProblem {
            forces: self.forces.iter().collect(),
            coordinates: self.coordinates.clone(),
            parameter: Some((self.variable, interval)),
            condition: self.condition.clone(),
            odd: self.odd,
            motions: mean.motions.into_iter().map(short).collect(),
            mu: mean.mu,
            highest: self.highest(&own),
            inverse: &[],
            inverse_bits: INVERSE_BITS,
            sigma: 0,
        };
        let inverse = inverse(&problem)?;
        problem.inverse = &inverse;
        // A relative error of mu counts as much as one of the motion.
        problem.sigma = -own.mu.log2().round().to_i32().unwrap_or(0).clamp(-20, 20);
        let motions = MotionsOnPiece::new(problem, approximate)?;
        let truth = inverse_frequency(&motions, &root).ok_or(NotEnclosed::Wide)?;
        if truth.remainder > Bound::power_of_two(ACCURATE) || !joins(&motions)? {
            return Err(NotEnclosed::Wide);
        }
        let piece =
            TruthPiece { turns: None, scale: Scale::OWN, middle, half, truth, restitution: None };
        let contraction = motions.contraction();
        Ok((piece, EndOfPiece { approximate: last, found: motions.at_end(), contraction }))
    }
}

/// `1/omega` as a polynomial w, whose coefficients by `cos(n phi)` are given in units: `|1/omega - w|` is
/// `|mu - w^2|/(1/omega + w)`. `None` where w may be zero.
fn inverse_frequency(motions: &MotionsOnPiece, root: &[Integer]) -> Option<PiecePolynomial> {
    let sheet = Sheet::of_units(&[root.to_vec()], BITS);
    let off = sheet.product(&sheet).difference(&motions.approximate().mu).norm();
    let mean = WORKING.distance_from_zero(&sheet.coefficient(0, 0));
    let lowest = (mean - sheet.spread().value()).next_down();
    let is_positive = root.first().is_some_and(Integer::is_positive) && lowest > 0.0;
    // Chebyshev's polynomials T_n(e) = cos(n phi), and from each two the next one.
    let mut powers = vec![Integer::zero(); root.len().max(1)];
    let (mut one, mut next) = (vec![Integer::from(1)], vec![Integer::zero(), Integer::from(1)]);
    for (n, unit) in root.iter().enumerate() {
        // What is negligible is in the sheet no more.
        if !sheet.coefficient(0, n).is_zero() {
            one.iter().zip(&mut powers).for_each(|(factor, power)| *power += unit * factor);
        }
        let mut later: Vec<Integer> = std::iter::once(Integer::zero())
            .chain(next.iter().map(|m| m * Integer::from(2)))
            .collect();
        one.iter().zip(&mut later).for_each(|(before, own)| *own -= before);
        (one, next) = (next, later);
    }
    let coefficients = powers.iter().map(|power| WORKING.dyadic(power, BITS)).collect();
    let remainder = (off + motions.distance_of_mu()).over(lowest);
    is_positive.then(|| PiecePolynomial::new(coefficients, remainder))
}

/// `f(a v)/a` with the powers of a in front of sums, so that differences stay as they are written: written out,
/// they would be bounded term by term.
fn over_amplitude(
    force: &Expr,
    branch: &ModeBranch,
    amplitude: &Expr,
) -> Result<Expr, LawNotProved> {
    // An expression times a power of the amplitude.
    let (power, rest) = force.fold(|node, parts: &[(i64, Expr)]| {
        let with_power = |(power, rest): &(i64, Expr), own: i64| {
            Ok::<Expr, ExprError>(&amplitude.integer_power(power - own)? * rest)
        };
        Ok::<(i64, Expr), ExprError>(match node.node() {
            Node::Symbol(name) if branch.coordinates.contains(name) => (1, node.clone()),
            Node::Sum(_) => {
                let least = parts.iter().map(|(power, _)| *power).min().unwrap_or(0);
                let mut sum = Expr::zero();
                for part in parts {
                    sum = sum + with_power(part, least)?;
                }
                (least, sum)
            }
            Node::Product(coefficient, _) => {
                let number = (0, Expr::number(coefficient.clone()));
                parts
                    .iter()
                    .fold(number, |(power, rest), (other, part)| (power + other, &rest * part))
            }
            Node::Power(_, exponent) => {
                let whole = exponent.as_number().filter(|number| number.is_integer());
                let whole = whole.and_then(|number| number.to_integer().to_i64());
                match (parts.first(), whole) {
                    (Some((power, base)), Some(times)) => {
                        (power * times, base.integer_power(times)?)
                    }
                    (Some(base), None) => (0, Expr::power(&with_power(base, 0)?, exponent)?),
                    (None, _) => (0, node.clone()),
                }
            }
            Node::Function(function, _) => match parts.first() {
                Some(argument) => (0, Expr::function(*function, vec![with_power(argument, 0)?])?),
                None => (0, node.clone()),
            },
            _ => (0, node.clone()),
        })
    })?;
    Ok(&amplitude.integer_power(power - 1)? * &rest)
}

#[cfg(test)]
mod tests {
    use super::super::{LawCertificate, LawQuantity, MotionsOfLaw, check_law};
    use super::*;
    use crate::certificate::{CheckError, certify_mode_motion};
    use crate::decimal::rounded_to;
    use crate::exact::ratio;
    use crate::modes::{ModeOptions, derive};
    use crate::solution::AmplitudeConvention;

    fn branch(
        equations: &str,
        number: usize,
        amplitude: AmplitudeConvention,
        from: &str,
    ) -> (FreeSystem, NonlinearMode, ModeBranch) {
        let system = FreeSystem::parse(equations).expect("equations");
        let options = ModeOptions { mode: Some(number), amplitude, ..ModeOptions::default() };
        let modes = derive(&system, &options).expect("modes");
        let mode = modes.modes.into_iter().next().expect("a mode").expect("no resonance");
        let from = from.parse().expect("a fraction");
        let branch = ModeBranch::new(&modes.system, &mode, &from).expect("a branch");
        (modes.system, mode, branch)
    }

    const PAIR: &str = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
    const CHAIN: &str = "x'' + 2*x - y + x^3 + (x - y)^3 = 0; \
                         y'' + 2*y - x - z + (y - x)^3 + (y - z)^3 = 0; \
                         z'' + 2*z - y + z^3 + (z - y)^3 = 0";

    fn certificate(branch: ModeBranch, [from, to]: [&str; 2], law: &str) -> LawCertificate {
        LawCertificate {
            motions: MotionsOfLaw::Mode(branch),
            variable: Symbol::new("a"),
            quantity: LawQuantity::FrequencySquared,
            law: law.parse().expect("a law"),
            from: from.parse().expect("a fraction"),
            to: to.parse().ok(),
            worst: to.parse().expect("a fraction"),
            claim: [Rational::zero(), ratio(1, 1)],
        }
    }

    #[test]
    fn the_enclosure_holds_the_frequency_of_every_amplitude() {
        use AmplitudeConvention::{FirstHarmonic, Initial};
        let uneven = "x'' + 2*x - y + x^2/5 + x^3/2 = 0; 2*y'' + 3*y - x + y^2/7 = 0";
        let pendulums = "x'' + sin(x) + (x - y)/3 = 0; y'' + 2*sin(y) + (y - x)/3 = 0";
        for (equations, number, amplitude, range) in [
            (PAIR, 1, FirstHarmonic, ["0", "1"]),
            (PAIR, 2, Initial, ["1/3", "1"]),
            (CHAIN, 1, FirstHarmonic, ["0", "1/4"]),
            (uneven, 2, FirstHarmonic, ["0", "1/5"]),
            (pendulums, 1, FirstHarmonic, ["1/2", "1"]),
        ] {
            let (system, mode, branch) = branch(equations, number, amplitude, range[0]);
            let [from, to] = range.map(|end| end.parse::<Rational>().expect("a fraction"));
            let pieces = branch.pieces(Symbol::new("a"), &from, &to, Supervision::default());
            let pieces = pieces.unwrap_or_else(|error| panic!("{equations}: {error}"));
            for part in [3, 10, 16, 27] {
                let place = &from + (&to - &from) * ratio(part, 27);
                let symbol = mode.amplitude.symbol();
                let at = format!("{} = {place}", symbol.written()).parse().expect("values");
                let (_, proved) = certify_mode_motion(&system, &mode, &at).expect("a proof");
                let apart = |piece: &TruthPiece| (&place - &piece.middle).abs() / &piece.half;
                let piece = pieces.iter().min_by_key(|piece| apart(piece)).expect("a piece");
                let e = WORKING.fraction(&((&place - &piece.middle) / &piece.half));
                let own = piece.truth.within(&e, &piece.half).value;
                assert!(own.radius.value() < 1e-11, "{equations}: {:?}", own.radius);
                let frequency = WORKING.fraction(&proved.frequency.middle);
                let product = WORKING.product(&own, &widened(&frequency, proved.frequency.radius));
                let off = WORKING.difference(&product, &WORKING.integer(1));
                assert!(WORKING.distance_from_zero(&off) <= 0.0, "{equations} at {place}");
            }
        }
    }

    #[test]
    fn a_law_of_a_mode_is_proved_and_a_false_claim_refused() {
        let (_, _, branch) = branch(PAIR, 1, AmplitudeConvention::FirstHarmonic, "0");
        let mut law = certificate(branch, ["0", "1"], "1 + 3*a^2/16");
        let error = check_law(&law).expect("a proof");
        assert!(error.lower > 0.0 && error.upper <= 1.0);
        // Both ends are those of the error at the worst place, and a claim between them is refused.
        let digits = |value: f64| rounded_to(value, 6);
        let unit = ratio(1, 10_000_000);
        law.claim = [digits(error.lower) - &unit, digits(error.lower) + &unit];
        let error = check_law(&law).expect("a proof");
        assert!(error.upper - error.lower < 3e-7, "{error:?}");
        let sound = law.clone();
        law.claim[1] = digits(error.lower) - &unit;
        law.claim[0] = Rational::zero();
        assert!(matches!(check_law(&law), Err(CheckError::Law(LawNotProved::Open(_)))));
        law.claim = [digits(error.lower) + &unit, ratio(1, 1)];
        assert!(matches!(check_law(&law), Err(CheckError::ClaimedMore { .. })));
        // A hidden error in the middle of the range.
        let mut hidden = sound.clone();
        hidden.law = "1 + 3*a^2/16 + exp(-(1000*(a - 1/3))^2)/10".parse().expect("a law");
        assert!(check_law(&hidden).is_err());
    }

    #[test]
    fn another_motion_than_that_of_the_branch_is_refused() {
        let (_, _, slow) = branch(PAIR, 1, AmplitudeConvention::FirstHarmonic, "0");
        let refused = |change: &dyn Fn(&mut ModeBranch)| {
            let mut changed = slow.clone();
            change(&mut changed);
            check_law(&certificate(changed, ["0", "1/4"], "1 + 3*a^2/16")).expect_err("a refusal")
        };
        let moved = refused(&|branch| branch.mu = &branch.mu + ratio(1, 100_000));
        assert_eq!(moved, CheckError::Law(LawNotProved::AnotherMode));
        let moved = refused(&|branch| branch.coefficients[1][1] = ratio(99, 100));
        assert_eq!(moved, CheckError::Law(LawNotProved::AnotherMode));
        assert!(matches!(
            refused(&|branch| branch.forces[0] = "x + a".parse().expect("a")),
            CheckError::Malformed(_)
        ));
        assert!(matches!(refused(&|branch| branch.mu = ratio(-1, 1)), CheckError::Malformed(_)));
        assert!(matches!(
            refused(&|branch| branch.coefficients.truncate(1)),
            CheckError::Malformed(_)
        ));
        assert!(matches!(
            refused(&|branch| branch.forces[0] = "sin(2*x) - y".parse().expect("a force")),
            CheckError::Law(LawNotProved::FromRest(_))
        ));
        // Two springs without coupling have one frequency: no single motion.
        let both = refused(&|branch| {
            branch.forces = ["x", "y"].map(|force| force.parse().expect("a force")).to_vec();
        });
        assert!(matches!(both, CheckError::Law(LawNotProved::NoMode(_))), "{both}");
    }
}
