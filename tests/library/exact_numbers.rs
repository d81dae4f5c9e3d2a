//! The integers and fractions of this crate against those of `num-bigint`, from a few digits to
//! several hundred bits.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Neg;

use lindstedt::exact::{Integer, Rational, from_f64, to_f64};
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_rational::BigRational;
use num_traits::{Num, One, Signed, ToPrimitive, Zero};
use proptest::prelude::*;

/// A sign and digits to the base 2^32, the highest first.
type Digits = (bool, Vec<u32>);

fn number<T: Num + Neg<Output = T> + From<u32>>((negative, digits): &Digits) -> T {
    let base = || T::from(1 << 16) * T::from(1 << 16);
    let size = digits.iter().fold(T::zero(), |sum, &digit| sum * base() + T::from(digit));
    if *negative { -size } else { size }
}

fn small_or_long() -> impl Strategy<Value = Digits> {
    // Digits of nothing but ones or noughts are where carries and borrows run far.
    let digit =
        prop_oneof![3 => any::<u32>(), 1 => 0..4_u32, 1 => Just(u32::MAX), 1 => Just(1 << 31)];
    let long = proptest::collection::vec(digit, 0..12);
    let small = (0..40_u32).prop_map(|digit| vec![digit]);
    (any::<bool>(), prop_oneof![small, long])
}

fn fraction() -> impl Strategy<Value = (Digits, Digits)> {
    let nonzero = small_or_long()
        .prop_filter("a denominator", |(_, digits)| digits.iter().any(|digit| *digit != 0));
    (small_or_long(), nonzero)
}

fn integers(digits: &Digits) -> (Integer, BigInt) {
    (number(digits), number(digits))
}

fn fractions((numerator, denominator): &(Digits, Digits)) -> (Rational, BigRational) {
    (
        Rational::new(number(numerator), number(denominator)),
        BigRational::new(number(numerator), number(denominator)),
    )
}

/// Whether both print alike, in every form that has to do with digits.
fn agree(ours: &Integer, theirs: &BigInt) -> Result<(), TestCaseError> {
    prop_assert_eq!(ours.to_string(), theirs.to_string());
    prop_assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
    prop_assert_eq!(
        format!("{ours:>+30}|{ours:<40}|{ours:030}"),
        format!("{theirs:>+30}|{theirs:<40}|{theirs:030}")
    );
    Ok(())
}

fn agree_as_fractions(ours: &Rational, theirs: &BigRational) -> Result<(), TestCaseError> {
    agree(ours.numer(), theirs.numer())?;
    agree(ours.denom(), theirs.denom())?;
    prop_assert_eq!(format!("{ours}|{ours:>+50}"), format!("{theirs}|{theirs:>+50}"));
    prop_assert_eq!(&ours.to_string().parse::<Rational>().expect("a fraction"), ours);
    Ok(())
}

fn hash(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// `left operation right` by value, by reference and in place, against the same of the other crate.
macro_rules! same {
    ($check:ident, $left:expr, $right:expr, $($operator:tt $in_place:tt),*) => {{
        let ((a, theirs_a), (b, theirs_b)) = (&$left, &$right);
        $(
            let theirs = theirs_a $operator theirs_b;
            $check(&(a $operator b), &theirs)?;
            $check(&(a.clone() $operator b), &theirs)?;
            $check(&(a $operator b.clone()), &theirs)?;
            $check(&(a.clone() $operator b.clone()), &theirs)?;
            let mut sum = a.clone();
            sum $in_place b;
            $check(&sum, &theirs)?;
            let mut sum = a.clone();
            sum $in_place b.clone();
            $check(&sum, &theirs)?;
        )*
    }};
}

/// That no double is nearer, and of two equally near ones it is the even one.
fn is_nearest(value: &Rational, found: f64) -> Result<(), TestCaseError> {
    let exact = |end: f64| from_f64(end).expect("a finite double");
    if found.is_infinite() {
        // Half a unit of the last place beyond the largest double is where the infinite ones begin.
        let largest = exact(f64::MAX);
        let step = &largest - exact(f64::MAX.next_down());
        prop_assert!(value.abs() >= largest + step / Integer::from(2));
        prop_assert_eq!(found.is_sign_negative(), value.is_negative());
        return Ok(());
    }
    let error = (value - exact(found)).abs();
    for neighbour in [found.next_down(), found.next_up()].into_iter().filter(|end| end.is_finite())
    {
        let other = (value - exact(neighbour)).abs();
        prop_assert!(
            error < other || (error == other && found.to_bits().is_multiple_of(2)),
            "{} {}",
            value,
            found
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn integers_compute_as_those_of_another_crate(a in small_or_long(), b in small_or_long()) {
        let (left, right) = (integers(&a), integers(&b));
        agree(&left.0, &left.1)?;
        same!(agree, left, right, + +=, - -=, * *=);
        if !right.0.is_zero() {
            same!(agree, left, right, / /=, % %=);
            agree(&left.0.div_floor(&right.0), &left.1.div_floor(&right.1))?;
            agree(&left.0.mod_floor(&right.0), &left.1.mod_floor(&right.1))?;
            let (ours, theirs) = (left.0.div_rem(&right.0), left.1.div_rem(&right.1));
            agree(&ours.0, &theirs.0)?;
            agree(&ours.1, &theirs.1)?;
        }
        agree(&left.0.gcd(&right.0), &left.1.gcd(&right.1))?;
        agree(&left.0.lcm(&right.0), &left.1.lcm(&right.1))?;
        prop_assert_eq!(left.0.is_multiple_of(&right.0), left.1.is_multiple_of(&right.1));
        prop_assert_eq!(left.0.cmp(&right.0), left.1.cmp(&right.1));
        prop_assert_eq!(left.0 == right.0, left.1 == right.1);
        agree(&-&left.0, &-&left.1)?;
        agree(&-left.0.clone(), &-&left.1)?;
        agree(&left.0.abs(), &left.1.abs())?;
        agree(&left.0.signum(), &left.1.signum())?;
        agree(&left.0.abs_sub(&right.0), &left.1.abs_sub(&right.1))?;
        prop_assert_eq!(left.0.is_negative(), left.1.is_negative());
        prop_assert_eq!(left.0.is_positive(), left.1.is_positive());
        prop_assert_eq!((left.0.is_zero(), left.0.is_one()), (left.1.is_zero(), left.1.is_one()));
        prop_assert_eq!(left.0.bits(), left.1.bits());
        prop_assert_eq!((left.0.is_odd(), left.0.is_even()), (left.1.is_odd(), left.1.is_even()));
    }

    #[test]
    fn powers_roots_and_shifts_agree(a in small_or_long(), exponent in 0..6_u32, places in 0..200_usize, more in 0..3_u32) {
        let (ours, theirs) = integers(&a);
        agree(&ours.pow(exponent), &theirs.pow(exponent))?;
        agree(&(&ours << places), &(&theirs << places))?;
        agree(&(ours.clone() << places), &(&theirs << places))?;
        agree(&(ours.clone() >> places), &(&theirs >> places))?;
        let degree = 2 * exponent + 1;
        agree(&ours.nth_root(degree), &theirs.nth_root(degree))?;
        // A power, and one that is not quite.
        let (ours, theirs) = (ours.abs(), theirs.abs());
        for degree in 1..5 {
            let (power, other) = (ours.pow(degree) + Integer::from(more), theirs.pow(degree) + BigInt::from(more));
            agree(&power.nth_root(degree), &other.nth_root(degree))?;
        }
    }

    #[test]
    fn machine_numbers_agree(a in small_or_long(), wide in any::<i64>(), unsigned in any::<u64>()) {
        let (ours, theirs) = integers(&a);
        prop_assert_eq!(ours.to_i32(), theirs.to_i32());
        prop_assert_eq!(ours.to_u32(), theirs.to_u32());
        prop_assert_eq!(ours.to_i64(), theirs.to_i64());
        prop_assert_eq!(ours.to_u64(), theirs.to_u64());
        prop_assert_eq!(ours.to_i128(), theirs.to_i128());
        prop_assert_eq!(ours.to_u128(), theirs.to_u128());
        prop_assert_eq!(ours.to_usize(), theirs.to_usize());
        prop_assert_eq!(ours.to_f64(), theirs.to_f64());
        prop_assert_eq!(Integer::from(wide).to_string(), wide.to_string());
        prop_assert_eq!(Integer::from(unsigned).to_string(), unsigned.to_string());
        prop_assert_eq!(hash(&ours), hash(&(&ours + Integer::one() - Integer::one())));
    }

    #[test]
    fn integers_are_read_as_another_crate_reads_them(text in "[-+]?[0-9a ]{0,45}") {
        let (ours, theirs) = (text.parse::<Integer>().ok(), text.parse::<BigInt>().ok());
        prop_assert_eq!(ours.map(|value| value.to_string()), theirs.map(|value| value.to_string()));
    }

    #[test]
    fn fractions_compute_as_those_of_another_crate(a in fraction(), b in fraction(), exponent in -5..6_i32) {
        let (left, right) = (fractions(&a), fractions(&b));
        agree_as_fractions(&left.0, &left.1)?;
        same!(agree_as_fractions, left, right, + +=, - -=, * *=);
        if !right.0.is_zero() {
            same!(agree_as_fractions, left, right, / /=, % %=);
            agree_as_fractions(&right.0.recip(), &right.1.recip())?;
            agree_as_fractions(&right.0.pow(exponent), &right.1.pow(exponent))?;
        }
        prop_assert_eq!(left.0.cmp(&right.0), left.1.cmp(&right.1));
        prop_assert_eq!(left.0 == right.0, left.1 == right.1);
        for (ours, theirs) in [
            (left.0.floor(), left.1.floor()),
            (left.0.ceil(), left.1.ceil()),
            (left.0.round(), left.1.round()),
            (left.0.trunc(), left.1.trunc()),
            (left.0.fract(), left.1.fract()),
            (left.0.abs(), left.1.abs()),
            (-&left.0, -&left.1),
        ] {
            agree_as_fractions(&ours, &theirs)?;
        }
        prop_assert_eq!(left.0.is_integer(), left.1.is_integer());
        let same = (&left.0 + &right.0) - &right.0;
        prop_assert_eq!(hash(&left.0), hash(&same));
    }

    #[test]
    fn fractions_between_minus_one_and_one_are_in_order(a in -9..10_i64, b in 1..10_i64, c in -9..10_i64, d in 1..10_i64) {
        let ours = [(a, b), (c, d)].map(|(p, q)| Rational::new(p.into(), q.into()));
        prop_assert_eq!(ours[0].cmp(&ours[1]), (a * d).cmp(&(c * b)));
        prop_assert_eq!(ours[0].floor().to_integer().to_i64(), Some(a.div_euclid(b)));
    }

    #[test]
    fn the_nearest_double_of_any_fraction(a in fraction(), places in -1300..1300_i32) {
        let (ours, theirs) = fractions(&a);
        prop_assert_eq!(to_f64(&ours), theirs.to_f64().expect("a number"));
        is_nearest(&ours, to_f64(&ours))?;
        let scale = Rational::from_integer(2.into()).pow(places);
        let scaled = ours * scale;
        is_nearest(&scaled, to_f64(&scaled))?;
    }

    /// Halfway between two doubles, and a little to each side of it, where the size of the double
    /// is any.
    #[test]
    fn ties_of_doubles(bits in any::<u64>()) {
        let value = f64::from_bits(bits);
        prop_assume!(value.is_finite() && value.next_up().is_finite());
        let ends = [value, value.next_up()].map(|end| from_f64(end).expect("a finite double"));
        prop_assert_eq!(to_f64(&ends[0]), value);
        let middle = (&ends[0] + &ends[1]) / Integer::from(2);
        let little = (&ends[1] - &ends[0]) / (Integer::one() << 80);
        for value in [&middle - &little, &middle + &little, middle] {
            is_nearest(&value, to_f64(&value))?;
        }
    }

    #[test]
    fn every_finite_double_is_a_fraction(bits in any::<u64>()) {
        let value = f64::from_bits(bits);
        let (ours, theirs) = (from_f64(value), BigRational::from_float(value));
        prop_assert_eq!(ours.map(|value| value.to_string()), theirs.map(|value| value.to_string()));
    }
}

#[test]
fn doubles_at_the_ends_of_their_range() {
    let two_to = |places: i32| Rational::from_integer(2.into()).pow(places);
    for (value, expected) in [
        (two_to(-1074), 5e-324),
        (two_to(-1075), 0.0),
        (two_to(-1075) * Rational::new(3.into(), 2.into()), 5e-324),
        (two_to(-1076), 0.0),
        (two_to(-40_000), 0.0),
        (-two_to(-1074), -5e-324),
        (two_to(1023), 2.0_f64.powi(1023)),
        (two_to(1024), f64::INFINITY),
        (-two_to(1024), f64::NEG_INFINITY),
        (two_to(40_000), f64::INFINITY),
        (two_to(1024) - two_to(970), f64::INFINITY),
        (two_to(1024) - two_to(970) - two_to(-5), f64::MAX),
        (Rational::zero(), 0.0),
    ] {
        assert_eq!(to_f64(&value), expected);
    }
    assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(from_f64), [None, None, None]);
}
