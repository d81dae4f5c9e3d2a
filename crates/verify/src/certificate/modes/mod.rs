//! Certificates of nonlinear normal modes: free motions of several coordinates that begin at rest.
//!
//! In: any numbers from which a motion of `q'' + f(q) = 0` may be proved. Out: a proof that there is
//! exactly one motion near them with this amplitude, its frequency, and the error of a formula for
//! it. The amplitude is the start of one coordinate, or that of the first harmonic of a sum of all,
//! each with its factor: only the first couples the condition to all harmonics. The theorem is that
//! of one coordinate.

mod candidate;

use num_traits::{Signed as _, Zero as _};

use super::formula::{self, JudgedFormula};
use super::fourier_series::{FourierSeries, WORKING};
use super::theorem::{self, Condition, ConservativeProblem};
use super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes, law};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
pub(super) use candidate::mode_branch;
pub use candidate::{certify_mode, certify_mode_motion};

/// The definition of the amplitude of a mode.
#[derive(Clone, Debug, PartialEq)]
pub enum ModeAmplitude {
    /// The start of the coordinate of this index.
    Start(usize),
    /// The amplitude of the first harmonic of the sum of the coordinates, each with its factor, an
    /// expression without symbols.
    FirstHarmonic(Vec<Expr>),
}

/// Numbers from which a free motion of several coordinates can be proved. They may be anything:
/// [`check_mode`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeCertificate {
    /// The symbols of the coordinates.
    pub coordinates: Vec<Symbol>,
    /// `f` of `q'' + f(q) = 0`, one for each coordinate, in the coordinates and numbers.
    pub forces: Vec<Expr>,
    /// The definition of the amplitude.
    pub measure: ModeAmplitude,
    /// The amplitude; every velocity is zero at `t = 0`.
    pub amplitude: Rational,
    /// Whether the motion has odd harmonics alone, as it may where all forces are odd.
    pub odd: bool,
    /// `mu` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate `1/omega^2`.
    pub mu: Integer,
    /// Approximate cosine coefficients of each coordinate, that of the constant first.
    pub coefficients: Vec<Vec<Integer>>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on `mu` and the harmonics of the block, coordinate by
    /// coordinate; the first row belongs to `mu`, the first column to the condition on the
    /// amplitude.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `mu` in the norm is `2^sigma`.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The formula that is judged, and what is claimed of it.
    pub formula: Option<JudgedFormula>,
}

/// The largest number of coordinates.
pub(super) const MOST_COORDINATES: usize = 40;

/// The largest number of unknowns of a block.
const MOST_UNKNOWNS: usize = HIGHEST_HARMONIC + 1;

/// Checks every inequality of the theorem for a motion of several coordinates, and every claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_mode, check_mode};
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions { mode: Some(1), ..ModeOptions::default() })?;
/// let mode = modes.modes[0].as_ref().expect("no resonance");
/// let (mut certificate, certified) = certify_mode(&modes.system, mode, &"a = 4/5".parse()?)?;
/// let errors = certified.formula.as_ref().ok_or("no formula")?;
/// assert!(errors.relative.lower > 0.00126 && errors.relative.upper < 0.00127);
/// assert_eq!(check_mode(&certificate)?, certified);
/// certificate.amplitude = &certificate.amplitude + lindstedt::exact::ratio(1, 1_000_000_000);
/// assert!(check_mode(&certificate).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_mode(certificate: &ModeCertificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate.problem()).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, certificate.formula.as_ref(), &certified)?;
    Ok(certified)
}

impl ModeCertificate {
    /// Returns the equations and the approximate motion of this certificate in the form that the
    /// theorem takes.
    pub(super) fn problem(&self) -> ConservativeProblem<'_> {
        let amplitude = WORKING.fraction(&self.amplitude);
        let condition = match &self.measure {
            ModeAmplitude::Start(coordinate) => {
                Condition::Start { coordinate: *coordinate, place: amplitude }
            }
            ModeAmplitude::FirstHarmonic(factors) => {
                let unknown = || Ball { middle: Integer::zero(), radius: Bound::UNKNOWN };
                let factor = |factor: &Expr| law::exact_number(factor).unwrap_or_else(unknown);
                Condition::FirstHarmonic {
                    factors: factors.iter().map(factor).collect(),
                    amplitude,
                }
            }
        };
        ConservativeProblem {
            forces: self.forces.iter().collect(),
            coordinates: self.coordinates.clone(),
            parameter: None,
            condition,
            odd: self.odd,
            motions: self.motions(),
            mu: WORKING.dyadic(&self.mu, self.bits),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: self.sigma,
        }
    }

    /// The approximate motion of each coordinate.
    fn motions(&self) -> Vec<FourierSeries> {
        let motion = |list: &Vec<Integer>| {
            let balls = list.iter().map(|units| WORKING.dyadic(units, self.bits));
            FourierSeries::exactly(balls.collect(), vec![]).of_digits(self.bits)
        };
        self.coefficients.iter().map(motion).collect()
    }

    /// Returns the frequency and the errors of the formula that follow from a proof.
    ///
    /// # Errors
    /// A frequency without a value.
    fn certified(&self, proof: super::Proof) -> Result<Certified, super::NotProved> {
        let mu = WORKING.dyadic(&self.mu, self.bits);
        let formula = self.formula.as_ref();
        formula::certified((mu, self.sigma), &self.motions(), self.bits, formula, proof)
    }

    /// Checks that sizes and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let count = self.coordinates.len();
        let apart = |(place, name)| !self.coordinates[..place].contains(name);
        let measure_fits = match &self.measure {
            ModeAmplitude::Start(coordinate) => *coordinate < count,
            ModeAmplitude::FirstHarmonic(factors) => factors.len() == count,
        };
        let demands = [
            ((1..=MOST_COORDINATES).contains(&count), "more than 40 coordinates, or none"),
            (self.coordinates.iter().enumerate().all(apart), "two coordinates of one name"),
            (
                self.forces.len() == count && self.coefficients.len() == count && measure_fits,
                "another number of forces, motions or factors than of coordinates",
            ),
        ];
        if let Some((_, reason)) = demands.into_iter().find(|(holds, _)| !holds) {
            return Err(reason);
        }
        let lists: Vec<&[Integer]> = self.coefficients.iter().map(Vec::as_slice).collect();
        let forces = self.forces.iter().map(|force| (force, self.coordinates.as_slice()));
        let factors = match &self.measure {
            ModeAmplitude::Start(_) => &[],
            ModeAmplitude::FirstHarmonic(factors) => factors.as_slice(),
        };
        let nothing: &[Symbol] = &[];
        let expressions: Vec<(&Expr, &[Symbol])> =
            forces.chain(factors.iter().map(|factor| (factor, nothing))).collect();
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.mu,
            coefficients: &lists,
            inverse: &self.inverse,
            expressions: &expressions,
        };
        fits.of_numbers()?;
        if factors.iter().any(|factor| law::exact_number(factor).is_none()) {
            return Err("a factor of the amplitude without a value");
        }
        let unknowns = self.problem().block().len() + 1;
        if unknowns > MOST_UNKNOWNS {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        self.well_formed_formula()
    }

    /// Checks the formula, and that it belongs to the motion with which it is compared.
    ///
    /// # Errors
    /// The demand that does not hold.
    fn well_formed_formula(&self) -> Result<(), &'static str> {
        let Some(formula) = &self.formula else {
            return Ok(());
        };
        formula.well_formed(false)?;
        if formula.sines.iter().any(|sine| !sine.is_zero()) {
            return Err("a formula with sines, of a motion that begins at rest");
        }
        if formula.others.len() + 1 != self.coordinates.len() {
            return Err("a formula of another number of coordinates");
        }
        // Half a period later the motion begins at its other turning point: the formula must begin
        // on the same side.
        let measured = self.problem().condition_along(&formula.motions(self.bits));
        let same_side = WORKING.distance_from_zero(&measured) > 0.0
            && measured.middle.is_negative() == self.amplitude.is_negative();
        if !same_side {
            return Err("a formula that begins elsewhere than the motion");
        }
        let letter = formula.letters.amplitude;
        let amplitude = formula.values.iter().find(|(name, _)| *name == letter);
        if amplitude.is_some_and(|(_, value)| value.as_number() != Some(&self.amplitude)) {
            return Err("a law whose amplitude is not that of the motion");
        }
        law::law_matches_frequency(formula, self.bits).map(|_| ())
    }
}

/// The last harmonic of the largest block of so many coordinates.
pub(super) const fn last_harmonic_of_largest_block(coordinates: usize, odd: bool) -> usize {
    let each = (MOST_UNKNOWNS - 1) / coordinates;
    let last = if odd { 2 * each - 1 } else { each - 1 };
    if last < HIGHEST_HARMONIC { last } else { HIGHEST_HARMONIC - 1 }
}

#[cfg(test)]
mod tests {
    use super::super::{NotCertified, NotProved};
    use super::*;
    use crate::exact::{from_f64, ratio, to_f64};
    use crate::expr::{CompiledFunction, parse_expression};
    use crate::modes::{FreeSystem, ModeOptions, NonlinearMode, derive};
    use crate::solution::AmplitudeConvention;
    use crate::values::Values;

    fn mode_of(
        equations: &str,
        number: usize,
        amplitude: AmplitudeConvention,
    ) -> (FreeSystem, NonlinearMode) {
        let system = FreeSystem::parse(equations).expect("equations");
        let options = ModeOptions { mode: Some(number), amplitude, ..ModeOptions::default() };
        let modes = derive(&system, &options).expect("modes");
        let mode = modes.modes.into_iter().next().expect("a mode");
        (modes.system, mode.expect("no resonance"))
    }

    fn certified(
        equations: &str,
        number: usize,
        amplitude: AmplitudeConvention,
        at: &str,
    ) -> (ModeCertificate, Certified) {
        let (system, mode) = mode_of(equations, number, amplitude);
        let at: Values = at.parse().expect("values");
        let (certificate, proved) = certify_mode(&system, &mode, &at)
            .unwrap_or_else(|error| panic!("{equations} at {at:?}: {error}"));
        assert_eq!(check_mode(&certificate).as_ref(), Ok(&proved), "{equations}");
        (certificate, proved)
    }

    /// omega of `x'' + k x + e x^3 = 0` from A, an arithmetic-geometric mean in balls.
    fn duffing(k: &Rational, e: &Rational, start: &Rational) -> Ball {
        let stiffening = e * start * start;
        let root = |value: &Rational| WORKING.root(&WORKING.fraction(value), 2).expect("a root");
        let half = &stiffening / Integer::from(2);
        let (mut a, mut b) = (root(&(k + &stiffening)), root(&(k + half)));
        for _ in 0..12 {
            let product = WORKING.product(&a, &b);
            (a, b) = (
                WORKING.divided(&WORKING.sum(&a, &b), 2),
                WORKING.root(&product, 2).expect("a root"),
            );
        }
        a
    }

    /// Whether an enclosure holds a number.
    fn holds(certified: &Certified, truth: &Ball) -> bool {
        let frequency = &certified.frequency;
        let apart = WORKING.difference(truth, &WORKING.fraction(&frequency.middle));
        WORKING.distance_from_zero(&apart) <= frequency.radius.value()
    }

    #[test]
    fn similar_modes_swing_as_one_coordinate() {
        // In phase x = y, out of phase y = -x: each is one Duffing equation.
        let pair = "x'' + x + x^3/3 + (x - y)/5 + (x - y)^3/7 = 0; \
                    y'' + y + y^3/3 + (y - x)/5 + (y - x)^3/7 = 0";
        let of_modes = [(ratio(1, 1), ratio(1, 3)), (ratio(7, 5), ratio(1, 3) + ratio(8, 7))];
        for (number, (k, e)) in of_modes.into_iter().enumerate() {
            for start in ["1/3", "5/4", "3"] {
                let initial = AmplitudeConvention::Initial;
                let at = format!("A = {start}");
                let (system, mode) = mode_of(pair, number + 1, initial);
                let (_, proved) = certify_mode_motion(&system, &mode, &at.parse().expect("values"))
                    .unwrap_or_else(|error| panic!("{start}: {error}"));
                let start: Rational = start.parse().expect("a fraction");
                let truth = duffing(&k, &e, &start);
                assert!(holds(&proved, &truth), "mode {}, {start}: {proved:?}", number + 1);
                assert!(proved.frequency.radius.value() < 1e-31);
            }
        }
    }

    /// The velocities half a period after the start of a motion, by Runge-Kutta of fourth order.
    fn at_the_turn(certificate: &ModeCertificate, frequency: f64) -> Vec<f64> {
        const STEPS: usize = 8000;
        let count = certificate.coordinates.len();
        let compiled = certificate.forces.iter();
        let forces: Vec<CompiledFunction> = compiled
            .map(|force| CompiledFunction::new(force, &certificate.coordinates).expect("a force"))
            .collect();
        let field = |state: &[f64]| -> Vec<f64> {
            let rates = forces.iter().map(|force| -force.call(&state[..count]));
            state[count..].iter().copied().chain(rates).collect()
        };
        let starts = certificate.motions();
        let mut state: Vec<f64> = starts.iter().map(|x| WORKING.nearest(&x.at_zero())).collect();
        state.resize(2 * count, 0.0);
        let h = std::f64::consts::PI / frequency / STEPS as f64;
        for _ in 0..STEPS {
            let moved = |rate: &[f64], part: f64| -> Vec<f64> {
                state.iter().zip(rate).map(|(x, v)| x + part * h * v).collect()
            };
            let a = field(&state);
            let b = field(&moved(&a, 0.5));
            let c = field(&moved(&b, 0.5));
            let d = field(&moved(&c, 1.0));
            for index in 0..2 * count {
                state[index] += h / 6.0 * (a[index] + 2.0 * (b[index] + c[index]) + d[index]);
            }
        }
        state.split_off(count)
    }

    #[test]
    fn a_motion_turns_after_half_the_proved_period() {
        use AmplitudeConvention::{FirstHarmonic, Initial};
        let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
        let coupled_by_mass =
            "2*x'' + y'' + 2*x - y + x^3/2 = 0; x'' + 3*y'' + 2*y - x + k*y^2 = 0";
        let pendulums = "x'' + sin(x) + (x - y)/3 = 0; y'' + 2*sin(y) + (y - x)/3 = 0";
        let three = "x'' + 2*x - y = 0; y'' + 3*y - x - z + y^3 = 0; z'' + 2*z - y + z^3/3 = 0";
        for (equations, number, amplitude, at) in [
            (pair, 1, FirstHarmonic, "a = 3/2"),
            (pair, 2, Initial, "A = 1"),
            (coupled_by_mass, 1, FirstHarmonic, "a = 1/4, k = 1/10"),
            (coupled_by_mass, 2, Initial, "A = 1/4, k = 1/10"),
            (pendulums, 1, FirstHarmonic, "a = 1"),
            (three, 2, FirstHarmonic, "a = 1/2"),
            (three, 3, Initial, "A = 1/4"),
            ("x'' + k*x - y + x^3/2 = 0; y'' + 2*y - x = 0", 2, FirstHarmonic, "a = 1, k = pi"),
        ] {
            let (certificate, proved) = certified(equations, number, amplitude, at);
            let frequency = to_f64(&proved.frequency.middle);
            assert!(proved.frequency.radius.value() < 1e-30, "{equations}");
            for velocity in at_the_turn(&certificate, frequency) {
                assert!(velocity.abs() < 1e-12, "{equations}, {number}: {velocity}");
            }
            // At another frequency it does not turn.
            let fastest = at_the_turn(&certificate, frequency * (1.0 + 1e-9));
            assert!(fastest.iter().any(|velocity| velocity.abs() > 1e-11), "{equations}");
        }
    }

    #[test]
    fn a_wrong_formula_is_given_its_true_error() {
        let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
        let (mut certificate, proved) =
            certified(pair, 1, AmplitudeConvention::FirstHarmonic, "a = 4/5");
        let bits = certificate.bits;
        let truth = to_f64(&proved.frequency.middle);
        let anything = [Rational::zero(), ratio(100, 1)];
        let formula = certificate.formula.as_mut().expect("a formula");
        // omega^2 = 1 + a^2/4 instead of 1 + 3 a^2/16, and 1/8 more of the third harmonic of y.
        formula.law = "omega^2 = 1 + a^2/4".to_owned();
        let own = 1.16_f64.sqrt();
        formula.frequency =
            WORKING.root(&WORKING.fraction(&ratio(29, 25)), 2).expect("a root").middle
                >> (WORKING.bits - bits);
        formula.others[0][3] += Integer::from(1) << (bits - 3);
        formula.deviation = anything.clone();
        formula.frequency_error = anything.clone();
        formula.drift = anything;
        let errors = check_mode(&certificate).expect("a proof").formula.expect("a formula");
        assert!((errors.frequency.lower - (own - truth)).abs() < 1e-13, "{errors:?}");
        assert!((errors.frequency.upper - (own - truth)).abs() < 1e-13, "{errors:?}");
        assert!(errors.deviation.lower > 0.124 && errors.deviation.upper < 0.127, "{errors:?}");
        // y~ is the steepest.
        let unit = Bound::power_of_two(-(bits as i32)).value();
        let own = &certificate.formula.as_ref().expect("a formula").others[0];
        let own: Vec<f64> = own.iter().map(|units| to_f64(&units.clone().into()) * unit).collect();
        let slope = |theta: f64| -> f64 {
            let parts = own.iter().enumerate();
            parts.map(|(k, c)| k as f64 * c * (k as f64 * theta).sin()).sum()
        };
        let places = (0..10_000).map(|place| slope(f64::from(place) * 1e-3).abs());
        let steepest = errors.drift.upper / errors.frequency.upper;
        assert!((steepest / places.fold(0.0, f64::max) - 1.0).abs() < 1e-3, "{steepest}");
        // Claims of less are refused, and a law that does not give the numbers.
        let formula = certificate.formula.as_mut().expect("a formula");
        formula.deviation[1] = ratio(12, 100);
        let refused = check_mode(&certificate);
        assert!(matches!(refused, Err(CheckError::ClaimedLess { what: "the deviation", .. })));
        let formula = certificate.formula.as_mut().expect("a formula");
        formula.law = "omega^2 = 1 + a^2/5".to_owned();
        assert!(matches!(check_mode(&certificate), Err(CheckError::Malformed(_))));
    }

    #[test]
    fn the_errors_of_a_series_shrink_with_its_order() {
        let error = |order: u32, amplitude: &str| {
            let system = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0");
            let options =
                ModeOptions { mode: Some(2), order: Some(order), ..ModeOptions::default() };
            let modes = derive(&system.expect("equations"), &options).expect("modes");
            let mode = modes.modes[0].as_ref().expect("a mode");
            let at = format!("a = {amplitude}").parse().expect("values");
            let (_, proved) = certify_mode(&modes.system, mode, &at).expect("a proof");
            let errors = proved.formula.expect("a formula");
            [errors.frequency.upper, errors.deviation.upper]
        };
        for order in [2, 4, 6] {
            let [large, small] = [error(order, "1/10"), error(order, "1/20")];
            let slopes = [0, 1].map(|kind: usize| (large[kind] / small[kind]).log2());
            // omega^2 to the power n leaves out n + 2, the motion to n + 1 leaves out n + 3.
            assert!((slopes[0] - f64::from(order + 2)).abs() < 0.05, "{order}: {slopes:?}");
            assert!((slopes[1] - f64::from(order + 3)).abs() < 0.05, "{order}: {slopes:?}");
        }
    }

    #[test]
    fn families_and_other_inertia_are_refused_with_the_reason() {
        // Of two springs without coupling the third harmonic of y may be anything: the derivative
        // has no inverse.
        let (system, mode) =
            mode_of("x'' + x = 0; y'' + 9*y = 0", 1, AmplitudeConvention::FirstHarmonic);
        let at: Values = "a = 1".parse().expect("values");
        let error = certify_mode(&system, &mode, &at).expect_err("a family");
        assert!(
            matches!(error, NotCertified::NotProved { reason: NotProved::NoContraction(_), .. }),
            "{error:?}"
        );
        // The second harmonic may be anything too, but the motion is the only one of odd harmonics.
        let (system, mode) =
            mode_of("x'' + x = 0; y'' + 4*y = 0", 1, AmplitudeConvention::FirstHarmonic);
        let (certificate, _) = certify_mode(&system, &mode, &at).expect("a proof");
        assert!(certificate.odd);
        let mut of_all = certificate;
        of_all.odd = false;
        of_all.highest += 1;
        let rows = 2 * of_all.highest + 3;
        of_all.inverse = vec![vec![Integer::zero(); rows]; rows];
        assert!(matches!(check_mode(&of_all), Err(CheckError::NotProved(_))));
        // So near the resonance that the inverse of the block is of no use in its digits.
        let (system, mode) = mode_of(
            "x'' + x = 0; y'' + (9 + 1/10^20)*y = 0",
            1,
            AmplitudeConvention::FirstHarmonic,
        );
        assert!(matches!(
            certify_mode(&system, &mode, &at),
            Err(NotCertified::NotProved { reason: NotProved::NoContraction(_), .. })
        ));
        let (system, mode) = mode_of(
            "(1 + x^2)*x'' + x*x'^2 + 2*x - y = 0; y'' + 4*y - x = 0",
            1,
            AmplitudeConvention::FirstHarmonic,
        );
        assert!(matches!(
            certify_mode(&system, &mode, &at),
            Err(NotCertified::NotOfPosition { coordinate, .. }) if coordinate == "x"
        ));
        let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
        let (system, mode) = mode_of(pair, 1, AmplitudeConvention::FirstHarmonic);
        assert!(matches!(
            certify_mode(&system, &mode, &"a = pi/4".parse().expect("values")),
            Err(NotCertified::Amplitude { .. })
        ));
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
        let (sound, _) = certified(pair, 1, AmplitudeConvention::FirstHarmonic, "a = 4/5");
        let refused = |change: &dyn Fn(&mut ModeCertificate)| {
            let mut changed = sound.clone();
            change(&mut changed);
            check_mode(&changed).expect_err("a refusal")
        };
        let expression = |text: &str| parse_expression(text).expect("an expression");
        let malformed: [&dyn Fn(&mut ModeCertificate); 12] = [
            &|certificate| certificate.coordinates.clear(),
            &|certificate| certificate.coordinates[1] = certificate.coordinates[0],
            &|certificate| certificate.forces.truncate(1),
            &|certificate| certificate.coefficients.truncate(1),
            &|certificate| certificate.measure = ModeAmplitude::Start(2),
            &|certificate| certificate.measure = ModeAmplitude::FirstHarmonic(vec![]),
            &|certificate| {
                let factors = vec![expression("z"), expression("1")];
                certificate.measure = ModeAmplitude::FirstHarmonic(factors);
            },
            &|certificate| certificate.forces[0] = expression("x + z"),
            &|certificate| certificate.highest = 399,
            &|certificate| certificate.inverse.truncate(3),
            &|certificate| certificate.formula.as_mut().expect("a formula").others.clear(),
            &|certificate| certificate.amplitude = -&certificate.amplitude,
        ];
        for (place, change) in malformed.into_iter().enumerate() {
            let error = refused(change);
            assert!(matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
        }
        let unproved: [&dyn Fn(&mut ModeCertificate); 6] = [
            &|certificate| certificate.mu += Integer::from(1_000_000_000_000_i64),
            &|certificate| certificate.coefficients[1][3] += Integer::from(1) << 20,
            &|certificate| certificate.coefficients[1] = vec![],
            &|certificate| {
                certificate.inverse.iter_mut().flatten().for_each(|e| *e = Integer::zero())
            },
            &|certificate| certificate.forces[1] = expression("-x + 2*y + y/1000000"),
            &|certificate| certificate.claim = ratio(1, 1) / Integer::from(10).pow(40),
        ];
        for (place, change) in unproved.into_iter().enumerate() {
            let error = refused(change);
            assert!(!matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
        }
        // Another amplitude is another question, whose answer is proved from the same numbers with a
        // larger radius.
        let mut other = sound;
        other.formula = None;
        other.amplitude = &other.amplitude + ratio(1, 1_000_000_000_000);
        other.claim = ratio(1, 1);
        let proved = check_mode(&other).expect("a proof");
        assert!(proved.proof.radius.value() > 1e-13, "{proved:?}");
        assert!(from_f64(proved.frequency.radius.value()).is_some());
    }
}
