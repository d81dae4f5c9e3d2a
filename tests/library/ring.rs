//! The same series and the same elimination of secular terms over rings that this crate does not
//! have: residues modulo a prime chosen at run time, and intervals.

use lindstedt::exact::Monomial;
use lindstedt::exact::NotInvertible;
use lindstedt::exact::{Integer, Integers, Polynomial, Polynomials, Rational, Ring, from_f64};
use lindstedt::method::secular::{
    AmplitudeKind, Detuning, ForceTerm, Scheme, SecularError, SecularExpansion, expand,
};
use lindstedt::series::FourierSeries;
use lindstedt::solution::AmplitudeConvention;
use num_integer::Integer as _;
use num_traits::{One, ToPrimitive, Zero};

/// The field of residues modulo a prime below 2^63.
///
/// The element 0 is zero itself; a multiple of the prime that came out of a computation is the
/// prime.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Residues {
    prime: u64,
}

impl Residues {
    fn element(self, value: u128) -> u64 {
        match (value % u128::from(self.prime)) as u64 {
            0 => self.prime,
            residue => residue,
        }
    }

    /// The image of an integer that is not known to be zero but where it is.
    fn image(self, value: &Integer) -> u64 {
        match value.is_zero() {
            true => 0,
            false => {
                self.element(value.mod_floor(&self.prime.into()).to_u128().expect("a residue"))
            }
        }
    }

    /// By Fermat's theorem; `None` for a multiple of the prime.
    fn reciprocal(self, value: u64) -> Option<u64> {
        let (mut power, mut square, mut exponent) = (1, value, self.prime - 2);
        while exponent > 0 {
            if exponent % 2 == 1 {
                power = self.product(&power, &square);
            }
            square = self.product(&square, &square);
            exponent /= 2;
        }
        (!value.is_multiple_of(self.prime)).then_some(power)
    }

    /// The residue of a fraction whose denominator is no multiple of the prime.
    fn fraction(self, numerator: &Integer, denominator: &Integer) -> u64 {
        let inverse =
            self.reciprocal(self.image(denominator)).expect("a denominator with an inverse");
        self.product(&self.image(numerator), &inverse)
    }
}

impl Ring for Residues {
    type Element = u64;

    const FIELD: bool = true;

    fn zero(&self) -> u64 {
        0
    }
    fn integer(&self, value: i64) -> u64 {
        match value {
            0 => 0,
            _ => self.element(i128::from(value).rem_euclid(i128::from(self.prime)) as u128),
        }
    }
    fn is_certainly_zero(&self, element: &u64) -> bool {
        *element == 0
    }
    fn may_be_zero(&self, element: &u64) -> bool {
        [0, self.prime].contains(element)
    }
    fn accumulate(&self, sum: &mut u64, term: &u64) {
        *sum = match (*sum, *term) {
            (0, only) | (only, 0) => only,
            (left, right) => self.element(u128::from(left) + u128::from(right)),
        };
    }
    fn negate(&self, element: &mut u64) {
        if *element > 0 {
            *element = self.element(u128::from(2 * self.prime - *element));
        }
    }
    fn product(&self, left: &u64, right: &u64) -> u64 {
        match (left, right) {
            (0, _) | (_, 0) => 0,
            _ => self.element(u128::from(*left) * u128::from(*right)),
        }
    }
    fn scale(&self, element: &mut u64, factor: i64) {
        *element = self.product(element, &self.integer(factor));
    }
    fn scale_by(&self, element: &mut u64, factor: &Integer) {
        *element = self.product(element, &self.image(factor));
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut u64>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        let inverse = self.reciprocal(self.image(divisor)).ok_or_else(|| NotInvertible {
            divisor: divisor.clone(),
            ring: format!("the residues modulo {}", self.prime),
        })?;
        for element in elements {
            *element = self.product(element, &inverse);
        }
        Ok(())
    }
    fn inverse(&self, element: &u64) -> Option<(u64, Integer)> {
        Some((self.reciprocal(*element)?, Integer::one()))
    }
}

fn term<R: Ring>(
    ring: &R,
    order: usize,
    powers: [u32; 2],
    numerator: i64,
    denominator: i64,
) -> ForceTerm<R> {
    ForceTerm {
        order,
        position: powers[0],
        velocity: powers[1],
        coefficient: FourierSeries::integer(ring.clone(), numerator).divided_by(denominator),
    }
}

fn scheme(
    normalisation: AmplitudeConvention,
    amplitude: AmplitudeKind,
    detuning: Detuning,
) -> Scheme {
    Scheme { normalisation, amplitude, detuning }
}

const LINDSTEDT_POINCARE: Scheme = Scheme {
    normalisation: AmplitudeConvention::Initial,
    amplitude: AmplitudeKind::Free,
    detuning: Detuning::Acceleration,
};

/// `x'' + x + eps x^3 = 0`.
fn duffing<R: Ring>(ring: &R) -> Vec<ForceTerm<R>> {
    vec![term(ring, 1, [3, 0], 1, 1)]
}

/// `x'' + x + eps (x^2 - 1) x' = 0` with `x = 2 y`.
fn van_der_pol<R: Ring>(ring: &R) -> Vec<ForceTerm<R>> {
    vec![term(ring, 1, [2, 1], 4, 1), term(ring, 1, [0, 1], -1, 1)]
}

/// Every series of an expansion, with its name and order.
fn parts<R: Ring>(expansion: &SecularExpansion<R>) -> Vec<(String, FourierSeries<R>)> {
    let driven = |motion: &FourierSeries<R>| motion.derivative().derivative().sum(motion);
    let right_sides: Vec<FourierSeries<R>> = expansion.displacement.iter().map(driven).collect();
    let lists = [
        ("omega", &expansion.frequency),
        ("omega^2", &expansion.frequency_squared),
        ("motion", &expansion.displacement),
        ("right side", &right_sides),
    ];
    let mut parts = Vec::new();
    for (name, series) in lists {
        parts.extend(
            series.iter().enumerate().map(|(n, series)| (format!("{name} {n}"), series.clone())),
        );
    }
    for (n, fixed) in expansion.amplitudes.iter().enumerate() {
        parts.push((format!("amplitude {n}"), fixed.amplitude.clone()));
        parts.push((format!("slope {n}"), fixed.slope.clone()));
    }
    parts
}

/// Every coefficient of an exact expansion beside the one in another ring, and how many of the
/// exact ones are not zero.
fn compare<R: Ring, S: Ring>(
    exact: &SecularExpansion<R>,
    other: &SecularExpansion<S>,
    agree: impl Fn(&R::Element, &Integer, &S::Element) -> bool,
) -> usize {
    let (exact, other) = (parts(exact), parts(other));
    assert_eq!(exact.len(), other.len());
    let mut count = 0;
    for ((name, left), (_, right)) in exact.iter().zip(&other) {
        for k in 0..=left.highest_harmonic().max(right.highest_harmonic()) {
            for (left, right) in [(left.cosine(k), right.cosine(k)), (left.sine(k), right.sine(k))]
            {
                let (numerator, denominator) = left.mean();
                let (found, one) = right.mean();
                assert!(one.is_one(), "{name}, harmonic {k}: a denominator is left");
                assert!(
                    agree(&numerator, denominator, &found),
                    "{name}, harmonic {k}: {numerator:?}/{denominator} {found:?}"
                );
                count += usize::from(!left.is_zero());
            }
        }
    }
    count
}

fn agrees(ring: Residues) -> impl Fn(&Integer, &Integer, &u64) -> bool {
    move |numerator, denominator, found| {
        ring.fraction(numerator, denominator) % ring.prime == found % ring.prime
    }
}

/// The largest primes below 2^31 and 2^61 and one between them, found when the test runs.
fn primes() -> Vec<u64> {
    let is_prime = |n: u64| (2..).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d));
    let below = |limit: u64| (1..limit).rev().find(|&n| is_prime(n)).expect("a prime");
    // Mersenne's, whose trial division would take long.
    vec![below(1 << 31), below(1 << 36), (1 << 61) - 1]
}

#[test]
fn duffing_to_order_20_modulo_primes() {
    let exact = expand(&Integers, &duffing(&Integers), 20, &LINDSTEDT_POINCARE).expect("periodic");
    for prime in primes() {
        let ring = Residues { prime };
        let found = expand(&ring, &duffing(&ring), 20, &LINDSTEDT_POINCARE).expect("a good prime");
        let count = compare(&exact, &found, agrees(ring));
        // Order n of the motion alone has n + 1 harmonics.
        assert!(count > 21 * 11 * 2, "{count} coefficients");
    }
}

#[test]
fn limit_cycles_and_homotopies_modulo_primes() {
    let normalisations = [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic];
    for prime in primes() {
        let ring = Residues { prime };
        for normalisation in normalisations {
            let cycle = scheme(normalisation, AmplitudeKind::Determined, Detuning::Acceleration);
            let exact =
                expand(&Integers, &van_der_pol(&Integers), 10, &cycle).expect("a limit cycle");
            let found = expand(&ring, &van_der_pol(&ring), 10, &cycle).expect("a good prime");
            assert!(compare(&exact, &found, agrees(ring)) > 100);

            let homotopy = scheme(normalisation, AmplitudeKind::Free, Detuning::Displacement);
            let both = |terms: fn(&Integers) -> ForceTerm<Integers>,
                        modulo: fn(&Residues) -> ForceTerm<Residues>| {
                (vec![terms(&Integers)], vec![modulo(&ring)])
            };
            let (whole, modulo) = both(|r| term(r, 1, [2, 2], 5, 7), |r| term(r, 1, [2, 2], 5, 7));
            let exact = expand(&Integers, &whole, 6, &homotopy).expect("periodic");
            let found = expand(&ring, &modulo, 6, &homotopy).expect("a good prime");
            assert!(compare(&exact, &found, agrees(ring)) > 50);
        }
    }
}

/// Symbols over residues: the ring of polynomials passes the prime on.
#[test]
fn symbols_modulo_a_prime() {
    fn force<R: Ring>(ring: &Polynomials<R>) -> Vec<ForceTerm<Polynomials<R>>> {
        let symbol = |name: &str| ring.term(Monomial::power_of(name.into(), 1), ring.0.integer(1));
        let terms = [(2, "a"), (3, "b")];
        let term = |(position, name)| ForceTerm {
            order: 1,
            position,
            velocity: 0,
            coefficient: FourierSeries::constant(ring.clone(), symbol(name)),
        };
        terms.map(term).into()
    }
    let ring = Residues { prime: primes()[0] };
    let (whole, modulo) = (Polynomials(Integers), Polynomials(ring));
    let exact = expand(&whole, &force(&whole), 4, &LINDSTEDT_POINCARE).expect("periodic");
    let found = expand(&modulo, &force(&modulo), 4, &LINDSTEDT_POINCARE).expect("a good prime");
    let agree = |left: &Polynomial<Integer>, denominator: &Integer, right: &Polynomial<u64>| {
        let mut difference = right.clone();
        modulo.negate(&mut difference);
        for (monomial, coefficient) in left.terms() {
            modulo.add_term(
                &mut difference,
                monomial.clone(),
                ring.fraction(coefficient, denominator),
            );
        }
        modulo.may_be_zero(&difference)
    };
    assert!(compare(&exact, &found, agree) > 30);
}

/// Order n of Duffing's motion divides by `1 - (2 n + 1)^2 = -4 n (n + 1)`: a prime p fails at
/// order p - 1 and not before.
#[test]
fn a_prime_that_divides_a_denominator_is_an_error() {
    for (prime, fails_at) in [(2, 1), (3, 2), (5, 4), (7, 6), (11, 10)] {
        let ring = Residues { prime };
        let before = expand(&ring, &duffing(&ring), fails_at - 1, &LINDSTEDT_POINCARE)
            .expect("no bad divisor yet");
        let exact = expand(&Integers, &duffing(&Integers), fails_at - 1, &LINDSTEDT_POINCARE)
            .expect("periodic");
        compare(&exact, &before, agrees(ring));
        let error =
            expand(&ring, &duffing(&ring), 20, &LINDSTEDT_POINCARE).expect_err("a bad prime");
        let SecularError::Indivisible { order, indivisible } = &error else {
            panic!("{prime}: {error}");
        };
        assert_eq!(*order, fails_at, "{prime}");
        assert!(indivisible.divisor.is_multiple_of(&prime.into()), "{prime}: {error}");
        let text = error.to_string();
        assert!(text.contains(&format!("the residues modulo {prime},")), "{text}");
        assert!(text.contains(&indivisible.divisor.to_string()), "{text}");
    }
    let error =
        expand(&Residues { prime: 3 }, &duffing(&Residues { prime: 3 }), 3, &LINDSTEDT_POINCARE);
    assert_eq!(
        error.expect_err("24 = 3*8").to_string(),
        "no division by 24 in the residues modulo 3, which order 2 needs"
    );
}

/// A coefficient whose denominator is a multiple of the prime is an error as well, not a number.
#[test]
fn a_coefficient_without_residue_is_an_error() {
    let ring = Residues { prime: 1_000_003 };
    let third = FourierSeries::cos(ring, 2).divided_by(3);
    assert_eq!(third.divided(), Ok(()));
    assert_eq!(third.times(3), FourierSeries::cos(ring, 2));
    let force = [term(&ring, 1, [3, 0], 1, 2 * 1_000_003)];
    let refused = force[0].coefficient.divided().expect_err("no inverse");
    assert_eq!(refused.divisor, Integer::from(2 * 1_000_003));
    let error = expand(&ring, &force, 2, &LINDSTEDT_POINCARE).expect_err("no inverse");
    assert!(matches!(error, SecularError::Indivisible { order: 1, .. }), "{error}");
}

/// Closed intervals with endpoints in double precision, every operation rounded outward.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Intervals;

/// `[lower, upper]`; zero and nothing else is `[0, 0]`.
type Interval = [f64; 2];

fn outward(ends: impl IntoIterator<Item = f64>) -> Interval {
    let ends: Vec<f64> = ends.into_iter().collect();
    let lowest = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [lowest.next_down(), highest.next_up()]
}

fn enclosing(value: &Integer) -> Interval {
    match value.to_i64().filter(|small| small.unsigned_abs() < 1 << 53) {
        Some(small) => [small as f64; 2],
        None => outward([value.to_f64().expect("a number of this size")]),
    }
}

fn contains([lower, upper]: Interval, value: &Rational) -> bool {
    let exact = |end: f64| from_f64(end).expect("a finite end");
    exact(lower) <= *value && *value <= exact(upper)
}

const ZERO: Interval = [0.0, 0.0];

impl Ring for Intervals {
    type Element = Interval;

    const FIELD: bool = true;

    fn zero(&self) -> Interval {
        ZERO
    }
    fn integer(&self, value: i64) -> Interval {
        enclosing(&value.into())
    }
    fn is_certainly_zero(&self, element: &Interval) -> bool {
        *element == ZERO
    }
    fn may_be_zero(&self, [lower, upper]: &Interval) -> bool {
        *lower <= 0.0 && *upper >= 0.0
    }
    fn accumulate(&self, sum: &mut Interval, term: &Interval) {
        *sum = match (*sum, *term) {
            (ZERO, only) | (only, ZERO) => only,
            (left, right) => [(left[0] + right[0]).next_down(), (left[1] + right[1]).next_up()],
        };
    }
    fn negate(&self, element: &mut Interval) {
        if *element != ZERO {
            *element = [-element[1], -element[0]];
        }
    }
    fn product(&self, left: &Interval, right: &Interval) -> Interval {
        match *left == ZERO || *right == ZERO {
            true => ZERO,
            false => outward([
                left[0] * right[0],
                left[0] * right[1],
                left[1] * right[0],
                left[1] * right[1],
            ]),
        }
    }
    fn scale(&self, element: &mut Interval, factor: i64) {
        *element = self.product(element, &self.integer(factor));
    }
    fn scale_by(&self, element: &mut Interval, factor: &Integer) {
        *element = self.product(element, &enclosing(factor));
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Interval>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        let divisor = enclosing(divisor);
        for element in elements {
            if *element != ZERO {
                let [lower, upper] = *element;
                *element =
                    outward(divisor.iter().flat_map(|divisor| [lower / divisor, upper / divisor]));
            }
        }
        Ok(())
    }
    fn inverse(&self, element: &Interval) -> Option<(Interval, Integer)> {
        (!self.may_be_zero(element))
            .then(|| (outward([1.0 / element[0], 1.0 / element[1]]), Integer::one()))
    }
}

#[test]
fn intervals_enclose_the_exact_coefficients() {
    let enclosed = |numerator: &Integer, denominator: &Integer, found: &Interval| {
        let exact = Rational::new(numerator.clone(), denominator.clone());
        let width = found[1] - found[0];
        contains(*found, &exact) && width <= 1e-11
    };
    let exact = expand(&Integers, &duffing(&Integers), 6, &LINDSTEDT_POINCARE).expect("periodic");
    let found = expand(&Intervals, &duffing(&Intervals), 6, &LINDSTEDT_POINCARE).expect("periodic");
    assert!(compare(&exact, &found, enclosed) > 50);
    let cycle = scheme(
        AmplitudeConvention::FirstHarmonic,
        AmplitudeKind::Determined,
        Detuning::Acceleration,
    );
    let exact = expand(&Integers, &van_der_pol(&Integers), 6, &cycle).expect("a limit cycle");
    let found = expand(&Intervals, &van_der_pol(&Intervals), 6, &cycle).expect("a limit cycle");
    assert!(compare(&exact, &found, enclosed) > 50);
}

/// A coefficient of which only a bound is known: every value within is covered, and no harmonic is
/// dropped for containing zero.
#[test]
fn an_interval_around_zero_is_not_zero() {
    let uncertain = |order, powers, bound| ForceTerm {
        coefficient: FourierSeries::constant(Intervals, bound),
        ..term(&Intervals, order, powers, 1, 1)
    };
    let found = expand(&Intervals, &[uncertain(1, [3, 0], [-0.5, 0.25])], 4, &LINDSTEDT_POINCARE)
        .expect("periodic");
    for (n, series) in found.displacement.iter().enumerate() {
        assert_eq!(series.highest_harmonic(), 2 * n + 1);
    }
    for (numerator, denominator) in [(-1, 2), (0, 1), (1, 8), (1, 4)] {
        let force = [term(&Integers, 1, [3, 0], numerator, denominator)];
        let exact = expand(&Integers, &force, 4, &LINDSTEDT_POINCARE).expect("periodic");
        compare(&exact, &found, |numerator, denominator, found| {
            contains(*found, &Rational::new(numerator.clone(), denominator.clone()))
        });
    }
    // Damping is refused where it is certain.
    let damped = |bound| expand(&Intervals, &[uncertain(1, [0, 1], bound)], 1, &LINDSTEDT_POINCARE);
    assert!(damped([-0.1, 0.2]).is_ok());
    assert_eq!(damped([0.1, 0.2]).err(), Some(SecularError::Growth { order: 1 }));
    // An amplitude is determined only where its slope is.
    let cycle = scheme(
        AmplitudeConvention::FirstHarmonic,
        AmplitudeKind::Determined,
        Detuning::Acceleration,
    );
    let flat = [uncertain(1, [2, 1], [-4.0, 4.0]), uncertain(1, [0, 1], [-1.0, 1.0])];
    let error = expand(&Intervals, &flat, 3, &cycle).err();
    assert!(matches!(error, Some(SecularError::Degenerate { .. })), "{error:?}");
}
