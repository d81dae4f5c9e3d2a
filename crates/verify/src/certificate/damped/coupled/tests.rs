use super::super::super::{ClaimedStability, NotCertified, Stability};
use super::*;
use crate::coupled::CoupledEquations;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::ratio;
use crate::exact::rational::to_f64;
use crate::expr::{CompiledFunction, parse_expression};

pub(in super::super) const POTENTIAL_DAMPING: &str = "x'' + x'/5 + (x*y' + y*x')/20 + 2*x - y + x^3/5 + sin(y)/20 = cos(Omega*t)/4 + sin(2*Omega*t)/20; \
     2*y'' + y'/5 + x'/20 + y^2*y'/10 + 3*y - x + x*y/10 = x*sin(Omega*t)/20";

fn try_certify(equations: &str, at: &str) -> Result<(CoupledCertificate, Certified), NotCertified> {
    let equations = CoupledEquations::parse(equations).expect("equations");
    certify_coupled(&equations, &at.parse().expect("values"))
}

pub(in super::super) fn certified(equations: &str, at: &str) -> (CoupledCertificate, Certified) {
    let found = try_certify(equations, at).unwrap_or_else(|error| panic!("{equations}: {error}"));
    assert_eq!(check_coupled(&found.0).as_ref(), Ok(&found.1), "{equations}");
    found
}

/// Whether an enclosure holds a number.
fn holds(enclosure: &Enclosure, truth: &Ball) -> bool {
    let apart = WORKING.difference(truth, &WORKING.fraction(&enclosure.middle));
    WORKING.distance_from_zero(&apart) <= enclosure.radius.value()
}

/// The product of two complex numbers.
fn times(a: &[Rational; 2], b: &[Rational; 2]) -> [Rational; 2] {
    [&a[0] * &b[0] - &a[1] * &b[1], &a[0] * &b[1] + &a[1] * &b[0]]
}

#[test]
fn a_linear_pair_has_the_amplitudes_of_its_complex_equations() {
    // (K - w^2 M + i w C) q = f e^(i w t), by Cramer's rule in fractions.
    let linear = "2*x'' + y'' + x'/10 - y'/20 + 2*x - y = 3*cos(w*t)/10 - sin(w*t)/7; \
                  x'' + 3*y'' + y'/7 + 2*y - x = sin(w*t)/5";
    for w in [ratio(11, 10), ratio(2, 3), ratio(9, 4)] {
        let (certificate, proved) = certified(linear, &format!("w = {w}"));
        let square = &w * &w;
        let entry =
            |m: i64, c: Rational, k: i64| [ratio(k, 1) - &square * Integer::from(m), &w * &c];
        let a = entry(2, ratio(1, 10), 2);
        let b = entry(1, ratio(-1, 20), -1);
        let c = entry(1, ratio(0, 1), -1);
        let d = entry(3, ratio(1, 7), 2);
        // cos + i sin: the real part of f e^(i w t), so that sin has -i.
        let f = [ratio(3, 10), ratio(1, 7)];
        let g = [ratio(0, 1), ratio(-1, 5)];
        let minus = |p: [Rational; 2], q: [Rational; 2]| [&p[0] - &q[0], &p[1] - &q[1]];
        let determinant = minus(times(&a, &d), times(&b, &c));
        let tops = [minus(times(&f, &d), times(&b, &g)), minus(times(&a, &g), times(&c, &f))];
        let size = |z: &[Rational; 2]| &z[0] * &z[0] + &z[1] * &z[1];
        for (coordinate, top) in tops.iter().enumerate() {
            let exact = WORKING.fraction(&(size(top) / size(&determinant)));
            let exact = WORKING.root(&exact, 2).expect("a root");
            let amplitude = &proved.amplitudes[coordinate];
            assert!(holds(amplitude, &exact), "{w}, {coordinate}: {amplitude:?}");
            assert!(amplitude.radius.value() < 1e-31);
            let other = WORKING.sum(&exact, &WORKING.fraction(&ratio(1, 1 << 60)));
            assert!(!holds(amplitude, &other));
        }
        assert!(!certificate.odd, "proved among all harmonics");
    }
}

/// The states at some parts of a period of the drive, by Runge-Kutta of fourth order from the start
/// of the certificate.
fn followed(certificate: &CoupledCertificate, moved: f64) -> [Vec<f64>; 3] {
    followed_from(certificate, (0, moved), 16_000)
}

/// The states likewise, one of the start moved, in so many steps.
fn followed_from(
    certificate: &CoupledCertificate,
    (place, moved): (usize, f64),
    steps: usize,
) -> [Vec<f64>; 3] {
    let count = certificate.coordinates.len();
    let names: Vec<Symbol> =
        certificate.coordinates.iter().copied().chain([Symbol::new("t")]).collect();
    let compile =
        |expression: &Expr| CompiledFunction::new(expression, &names).expect("a function");
    let forces: Vec<_> = certificate.forces_in_time().iter().map(compile).collect();
    let damping: Vec<Vec<_>> =
        certificate.damping.iter().map(|row| row.iter().map(compile).collect()).collect();
    let field = |t: f64, state: &[f64]| -> Vec<f64> {
        let places: Vec<f64> = state[..count].iter().copied().chain([t]).collect();
        let rate = |row: usize| {
            let drag = damping[row].iter().zip(&state[count..]);
            -forces[row].call(&places) - drag.map(|(g, v)| g.call(&places) * v).sum::<f64>()
        };
        state[count..].iter().copied().chain((0..count).map(rate)).collect()
    };
    let frequency =
        WORKING.nearest(&frequency(&certificate.problem(), Bound::ZERO).expect("a frequency"));
    let motions = certificate.motions();
    let places = motions.iter().map(|motion| WORKING.nearest(&motion.at_zero()));
    let speeds =
        motions.iter().map(|motion| frequency * WORKING.nearest(&motion.derivative().at_zero()));
    let mut state: Vec<f64> = places.chain(speeds).collect();
    state[place] += moved;
    let start = state.clone();
    let mut half = vec![];
    let h = std::f64::consts::TAU / frequency / steps as f64;
    for index in 0..steps {
        if 2 * index == steps {
            half = state.clone();
        }
        let t = h * index as f64;
        let at = |rate: &[f64], part: f64| -> Vec<f64> {
            state.iter().zip(rate).map(|(x, v)| x + part * h * v).collect()
        };
        let a = field(t, &state);
        let b = field(t + 0.5 * h, &at(&a, 0.5));
        let c = field(t + 0.5 * h, &at(&b, 0.5));
        let d = field(t + h, &at(&c, 1.0));
        for index in 0..2 * count {
            state[index] += h / 6.0 * (a[index] + 2.0 * (b[index] + c[index]) + d[index]);
        }
    }
    [start, half, state]
}

#[test]
fn a_motion_comes_back_after_the_period_of_the_drive() {
    let pair = "x'' + x'/10 + 2*x - y + x^3/2 = 3*cos(Omega*t)/10; y'' + y'/10 + 2*y - x = 0";
    let pendulums =
        "x'' + x'/5 + sin(x) + (x - y)/3 = cos(Omega*t)/2; y'' + y'/5 + 2*sin(y) + (y - x)/3 = 0";
    let parametric = "x'' + x'/5 + (1 + cos(Omega*t)/5)*x - y/3 + x^2/9 = 1/5; \
                      y'' + y'/5 + 3*y - x/3 + y^3 = sin(Omega*t)^2/3; z'' + z'/4 + 2*z + z^3/5 = y/2";
    for (equations, at) in [
        (pair, "Omega = 1.1"),
        (pair, "Omega = 9/5"),
        (pendulums, "Omega = 7/10"),
        (parametric, "Omega = 5/7"),
        (POTENTIAL_DAMPING, "Omega = 4/5"),
    ] {
        let (certificate, proved) = certified(equations, at);
        assert!(proved.proof.radius.value() < 1e-25, "{equations}: {proved:?}");
        let [start, half, end] = followed(&certificate, 0.0);
        assert!(apart(&start, &end) < 1e-11, "{equations}: {start:?}, {end:?}");
        let opposite = certificate.motions().into_iter().map(|motion| {
            let signs = motion.cosines.iter().enumerate();
            signs.map(|(k, c)| WORKING.nearest(c) * if k % 2 == 0 { 1.0 } else { -1.0 }).sum()
        });
        assert!(apart(&half, &opposite.collect::<Vec<f64>>()) < 1e-11, "{equations}");
        let [start, _, end] = followed(&certificate, 1e-8);
        assert!(apart(&start, &end) > 1e-10, "{equations}");
    }
}

#[test]
fn motions_of_several_periods_of_the_drive_come_back_after_all_of_them() {
    let subharmonic =
        "x'' + x'/20 + x + x^3/5 + (x - y)/9 = 8*cos(18*t/5); y'' + y'/20 + 2*y + (y - x)/9 = 0";
    let parametric = "x'' + x'/10 + (1 + cos(2*t)/2)*x + x^3/5 + (x - y)/9 = 0; \
                      y'' + y'/20 + 2*y + (y - x)/9 = 0";
    for (equations, at, periods, harmonic) in
        [(subharmonic, "x = 1", 3, 1), (subharmonic, "x = 4", 1, 1), (parametric, "x = 1", 2, 1)]
    {
        let (certificate, proved) = certified(equations, at);
        let drive = certificate.drive.as_ref().expect("a drive");
        assert_eq!((drive.periods, drive.harmonic), (periods, harmonic), "{equations}, {at}");
        let [start, half, end] = followed(&certificate, 0.0);
        assert!(apart(&start, &end) < 1e-10, "{equations}: {start:?}, {end:?}");
        assert!(apart(&start, &half) > 0.1, "{equations}");
        let expected = to_f64(&drive.frequency) / periods as f64;
        assert!((to_f64(&proved.frequency.middle) - expected).abs() < 1e-14);
        // The harmonics that repeat themselves with the drive are not all.
        let motion = &certificate.motions()[0];
        let own = WORKING.nearest(&motion.cosine(1)).hypot(WORKING.nearest(&motion.sine(1)));
        assert!((to_f64(&proved.amplitudes[0].middle) - own).abs() < 1e-13 && own > 0.5);
        let multipliers = multipliers(&certificate);
        let largest = multipliers.iter().map(|value| value.norm()).fold(0.0, f64::max);
        holds_largest(&proved, largest, equations);
    }
    // From rest parametric excitation leads nowhere.
    let (_, at_rest) = certified(parametric, "");
    assert!(at_rest.stability.is_some_and(|stability| stability.attracts == Some(false)));
}

#[test]
fn one_coordinate_of_several_is_that_of_one() {
    use crate::certificate::certify_driven;
    use crate::{Options, Oscillator, solve};
    let one = "x'' + x'/5 + x + x^3/10 = cos(Omega*t)/2";
    let oscillator = Oscillator::parse("x'' + x'/5 + x + x^3/10 - cos(Omega*t)/2 = 0");
    let oscillator = oscillator.expect("an equation");
    let solution = solve(&oscillator, &Options::default()).expect("a solution");
    let at = "Omega = 6/5".parse().expect("values");
    let (_, alone) = certify_driven(&oscillator, &solution, &at).expect("a certificate");
    let alone = alone.amplitude.expect("an amplitude");
    let (_, both) = certified(&format!("{one}; y'' + y'/3 + 2*y + y^2/5 = x/4"), "Omega = 6/5");
    let apart = to_f64(&(&alone.middle - &both.amplitudes[0].middle)).abs();
    assert!(apart <= alone.radius.value() + both.amplitudes[0].radius.value(), "{apart}");
}

fn drive(certificate: &mut CoupledCertificate) -> &mut Drive {
    certificate.drive.as_mut().expect("a drive")
}

#[test]
fn numbers_that_do_not_fit_are_refused() {
    let (sound, _) = certified(POTENTIAL_DAMPING, "Omega = 4/5");
    let refused = |change: &dyn Fn(&mut CoupledCertificate)| {
        let mut changed = sound.clone();
        change(&mut changed);
        check_coupled(&changed).expect_err("a refusal")
    };
    let expression = |text: &str| parse_expression(text).expect("an expression");
    let malformed: [&dyn Fn(&mut CoupledCertificate); 15] = [
        &|certificate| certificate.coordinates.clear(),
        &|certificate| certificate.coordinates[1] = certificate.coordinates[0],
        &|certificate| certificate.coordinates[1] = Symbol::new("s"),
        &|certificate| certificate.forces.truncate(1),
        &|certificate| certificate.damping.truncate(1),
        &|certificate| certificate.damping[1].truncate(1),
        &|certificate| certificate.cosines.truncate(1),
        &|certificate| certificate.sines.truncate(1),
        &|certificate| certificate.forces[0] = expression("x + z"),
        &|certificate| certificate.damping[0][0] = expression("1/5 + s"),
        // x y' alone is the rate of no function.
        &|certificate| certificate.damping[0][0] = expression("1/5"),
        &|certificate| certificate.highest = 399,
        &|certificate| certificate.inverse.truncate(3),
        &|certificate| drive(certificate).frequency = ratio(-4, 5),
        &|certificate| certificate.sines[1][0] = Integer::from(1),
    ];
    for (place, change) in malformed.into_iter().enumerate() {
        let error = refused(change);
        assert!(matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
    }
    let unproved: [&dyn Fn(&mut CoupledCertificate); 9] = [
        &|certificate| certificate.cosines[1][3] += Integer::from(1) << 20,
        &|certificate| certificate.sines[0][1] += Integer::from(1) << 20,
        &|certificate| certificate.sines[1] = vec![],
        &|certificate| certificate.inverse.iter_mut().flatten().for_each(|e| *e = Integer::zero()),
        &|certificate| {
            let with = &certificate.forces[1] + &expression("y/1000000");
            certificate.forces[1] = with;
        },
        &|certificate| certificate.damping[1][0] = expression("1/40 + 1/1000000"),
        &|certificate| {
            drive(certificate).frequency = ratio(4, 5) + ratio(1, 1_000_000_000);
        },
        &|certificate| {
            certificate.odd = true;
            let rows = certificate.problem().block().len();
            certificate.inverse = vec![vec![Integer::zero(); rows]; rows];
        },
        &|certificate| certificate.claim = ratio(1, 1) / Integer::from(10).pow(40),
    ];
    for (place, change) in unproved.into_iter().enumerate() {
        let error = refused(change);
        assert!(!matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
    }
}

#[test]
fn motions_of_other_kinds_are_refused_with_the_reason() {
    let refused = |equations: &str, at: &str| try_certify(equations, at).expect_err("a refusal");
    let rest = "y'' + y'/5 + 2*y - x = 0";
    for (first, term) in [
        ("x'' + x'^3/5 + x = cos(t)", "x'^3/5"),
        ("x'' + x'*y'/5 + x = cos(t)", "x'*y'/5"),
        ("x'' + cos(t)*x'/5 + x = cos(t)", "x'*cos(t)/5"),
    ] {
        match refused(&format!("{first}; {rest}"), "") {
            NotCertified::NotCoupledDriven { coordinate, term: found } => {
                assert_eq!((coordinate.as_str(), found.as_str()), ("x", term));
            }
            error => panic!("{first}: {error:?}"),
        }
    }
    let of = |first: &str, at: &str| refused(&format!("{first}; {rest}"), at);
    let error = of("x'' + x*y'/5 + x'/5 + x = cos(t)", "");
    assert!(matches!(error, NotCertified::DampingOfNoFunction), "{error:?}");
    let error = of("x'' + x'/5 + x = cos(t) + cos(pi*t)", "");
    assert!(matches!(error, NotCertified::DrivingFrequency(_)), "{error:?}");
    let error = of("x'' + x'/5 + x = cos(pi*t)", "");
    assert!(matches!(error, NotCertified::DrivingFrequency(_)), "{error:?}");
    let error = of("x'' + x'/5 + x = t*cos(t)", "");
    assert!(matches!(error, NotCertified::NotCoupledDriven { .. }), "{error:?}");
    let error = of("x'' + x'/5 + k*x = cos(t)", "");
    assert!(matches!(error, NotCertified::NoValueOf(name) if name == "k"));
    let error = of("x'' + x'/5 + x = cos(t)", "k = 1");
    assert!(matches!(error, NotCertified::NoParameter(name) if name == "k"));
    // Without damping the free motion goes on, and where its period is a part of the drive's there is
    // a family.
    let error = of("x'' + x = cos(7*t/5)", "");
    assert!(matches!(error, NotCertified::NotSettled), "{error:?}");
    let error = of("x'' + x = cos(t/2)", "");
    assert!(matches!(error, NotCertified::NotProved { .. }), "{error:?}");
    let error = refused("s'' + s'/5 + s = cos(t); y'' + y'/5 + 2*y - s = 0", "");
    assert!(matches!(error, NotCertified::WaveAsCoordinate(_)), "{error:?}");
    let error = refused("x' + x = cos(t); y'' + y'/5 + 2*y - x = 0", "");
    assert!(matches!(error, NotCertified::FirstOrder(_)), "{error:?}");
}

pub(in super::super) const CYCLE_OF_MASSES: &str = "2*x'' + y'' - (1 - x^2)*x'/5 + (x*y' + y*x')/20 + 2*sin(x) = 0; \
     x'' + 3*y'' + y'/10 + 4*y + y^3/4 - x/2 = 0";

/// Two oscillators that excite themselves, with two frequencies.
const SELF_EXCITED: &str = "x'' - (1 - x^2)*x'/10 + x + (x - y)/2 = 0; \
                            y'' - (1 - y^2)*y'/10 + 6*y/5 + (y - x)/2 = 0";

#[test]
fn a_limit_cycle_comes_back_after_its_own_period() {
    let with_third = "x'' - (1 - x^2)*x' + x = y/5; y'' - (1 - y^2)*y'/5 + y = x/3; \
                      z'' + z'/5 + 3*z + z^3 + z^2/5 = x";
    // The first coordinate has twice the frequency, and so no first harmonic.
    let doubled = "x'' + x'/10 + x = y^2/5; y'' - (1 - y^2)*y'/5 + y = 0";
    for (equations, at, phase) in [
        (SELF_EXCITED, "", 0),
        (SELF_EXCITED, "x = 1, y = -1", 1),
        (with_third, "", 1),
        (CYCLE_OF_MASSES, "", 0),
        (doubled, "", 1),
    ] {
        let (certificate, proved) = certified(equations, at);
        assert_eq!((certificate.phase, certificate.drive.is_none()), (phase, true), "{equations}");
        assert!(proved.proof.radius.value() < 1e-25, "{equations}: {proved:?}");
        let [start, half, end] = followed(&certificate, 0.0);
        assert!(apart(&start, &end) < 1e-10, "{equations}: {start:?}, {end:?}");
        // It does not come back earlier, and a cycle from elsewhere does not come back.
        assert!(apart(&start, &half) > 0.1, "{equations}");
        let [start, _, end] = followed(&certificate, 1e-5);
        assert!(apart(&start, &end) > 1e-8, "{equations}");
        let multipliers = multipliers(&certificate);
        // One of them is one, along the motion.
        let along = place_nearest_to_one(&multipliers);
        assert!((multipliers[along] - 1.0).norm() < 1e-5, "{equations}: {multipliers:?}");
        let others = multipliers.iter().enumerate().filter(|(place, _)| *place != along);
        let largest = others.map(|(_, value)| value.norm()).fold(0.0, f64::max);
        holds_largest(&proved, largest, equations);
    }
}

/// The largest distance of two states, entry by entry.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
}

/// The proved stability is that of a largest multiplier in doubles.
fn holds_largest(proved: &Certified, largest: f64, equations: &str) {
    const ERROR: f64 = 1e-5;
    let stability = proved.stability.as_ref().expect("a stability");
    let ends = stability.largest.expect("two ends");
    assert!(
        ends.lower - ERROR < largest && largest < ends.upper + ERROR,
        "{equations}: {ends:?}, {largest}"
    );
    assert!(ends.upper - ends.lower < 1e-3, "{equations}: {ends:?}");
    assert_eq!(stability.attracts, Some(largest < 1.0), "{equations}: {ends:?}, {largest}");
}

/// The Floquet multipliers by central differences of motions in doubles.
fn multipliers(certificate: &CoupledCertificate) -> Vec<nalgebra::Complex<f64>> {
    const STEP: f64 = 1e-4;
    const STEPS: usize = 1_000;
    let states = 2 * certificate.coordinates.len();
    let ends: Vec<[Vec<f64>; 2]> = (0..states)
        .map(|state| {
            [STEP, -STEP].map(|moved| followed_from(certificate, (state, moved), STEPS)[2].clone())
        })
        .collect();
    let matrix = nalgebra::DMatrix::from_fn(states, states, |row, column| {
        (ends[column][0][row] - ends[column][1][row]) / (2.0 * STEP)
    });
    matrix.complex_eigenvalues().iter().copied().collect()
}

fn place_nearest_to_one(values: &[nalgebra::Complex<f64>]) -> usize {
    let distance = |place: &usize| (values[*place] - 1.0).norm();
    let nearest = (0..values.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)));
    nearest.expect("a multiplier")
}

#[test]
fn the_stability_of_driven_coordinates_is_that_of_neighbouring_motions() {
    let pair = "x'' + x'/10 + 2*x - y + x^3/2 = 3*cos(Omega*t)/10; y'' + y'/10 + 2*y - x = 0";
    // At y = 0 the spring of y is changed by the motion of x, and y grows.
    let parametric = "x'' + x'/10 + 2*x + x^3 = cos(t); y'' - y'/10 + y + x*y = 0";
    let slow = "x'' + x'/10 + 2*x + x^3 = cos(t); y'' + y'/50 + y/4 + x^2*y/9 = 0";
    for (equations, at) in [
        (pair, "Omega = 1.1"),
        (pair, "Omega = 9/5"),
        (POTENTIAL_DAMPING, "Omega = 4/5"),
        (parametric, ""),
        (slow, ""),
    ] {
        let (certificate, proved) = certified(equations, at);
        let multipliers = multipliers(&certificate);
        let largest = multipliers.iter().map(|value| value.norm()).fold(0.0, f64::max);
        holds_largest(&proved, largest, equations);
    }
}

#[test]
fn linear_coordinates_have_multipliers_in_closed_form() {
    let largest = |equations: &str, at: &str| {
        let (_, proved) = certified(equations, at);
        let omega = to_f64(&proved.frequency.middle);
        (proved.stability.expect("a stability"), std::f64::consts::TAU / omega)
    };
    let near = |stability: &Stability, expected: f64, attracts: Option<bool>| {
        let ends = stability.largest.expect("two ends");
        let rounding = expected * 1e-12;
        assert!(ends.lower <= expected + rounding && expected <= ends.upper + rounding, "{ends:?}");
        // Three digits of a matrix that has no basis of eigenvectors.
        assert!(ends.upper - ends.lower < 1e-3 * expected, "{ends:?}, {expected}");
        assert_eq!(stability.attracts, attracts, "{ends:?}");
    };
    let driven = "x'' + x'/5 + 2*x = cos(t)";
    // exp(-T/20), of complex multipliers; exp(-T/10) twice, of a matrix that has one eigenvector for
    // both; exp(T/4) and exp(-T/4); and one without damping.
    for (second, rate, attracts) in [
        ("y'' + y'/10 + 3*y = x/3", -0.05_f64, Some(true)),
        ("y'' + y'/5 + y/100 = 0", -0.1, Some(true)),
        ("y'' - y/16 = 0", 0.25, Some(false)),
        ("y'' + 3*y = 0", 0.0, None),
    ] {
        let (found, period) = largest(&format!("{driven}; {second}"), "");
        near(&found, (rate * period).exp(), attracts);
    }
    // Beside a limit cycle, whose own multiplier is smaller.
    let cycle = "x'' - (1 - x^2)*x'/5 + x = 0";
    for (second, rate, attracts) in [
        ("y'' + y'/20 + 2*y + x*y^2/9 = 0", -0.025, Some(true)),
        ("y'' - y'/20 + 2*y + x*y^2/9 = 0", 0.025, Some(false)),
        ("y'' + 2*y + x*y^2/9 = 0", 0.0, None),
    ] {
        let (found, period) = largest(&format!("{cycle}; {second}"), "x = 1");
        near(&found, (rate * period).exp(), attracts);
    }
}

#[test]
fn a_limit_cycle_beside_another_coordinate_is_that_of_one() {
    use crate::certificate::certify_cycle_motion;
    use crate::{Options, Oscillator, solve};
    let one = "x'' - (1 - x^2)*x'/2 + x = 0";
    let oscillator = Oscillator::parse(one).expect("an equation");
    let solution = solve(&oscillator, &Options::default()).expect("a solution");
    let (_, alone) =
        certify_cycle_motion(&oscillator, &solution, &Default::default()).expect("a certificate");
    let (_, both) = certified(&format!("{one}; y'' + y'/3 + 2*y + y^2/5 = x/4"), "");
    let apart = to_f64(&(&alone.frequency.middle - &both.frequency.middle)).abs();
    let known = alone.frequency.radius + both.frequency.radius;
    assert!(apart <= known.value() && known.value() < 1e-30, "{apart}, {known:?}");
}

#[test]
fn numbers_of_cycles_that_do_not_fit_are_refused() {
    let (sound, _) = certified(SELF_EXCITED, "");
    let refused = |change: &dyn Fn(&mut CoupledCertificate)| {
        let mut changed = sound.clone();
        change(&mut changed);
        check_coupled(&changed).expect_err("a refusal")
    };
    let expression = |text: &str| parse_expression(text).expect("an expression");
    let malformed: [&dyn Fn(&mut CoupledCertificate); 9] = [
        &|certificate| certificate.phase = 2,
        &|certificate| certificate.phase = 1,
        &|certificate| certificate.sines[0][1] = Integer::from(1),
        &|certificate| certificate.cosines[0][1] = -certificate.cosines[0][1].clone(),
        &|certificate| certificate.cosines[0].truncate(1),
        &|certificate| certificate.forces[0] = expression("x + c"),
        &|certificate| certificate.sigma = 65,
        &|certificate| certificate.damping[0][1] = expression("x"),
        &|certificate| {
            certificate.drive = Some(Drive { frequency: ratio(1, 1), periods: 1, harmonic: 1 });
        },
    ];
    for (place, change) in malformed.into_iter().enumerate() {
        let error = refused(change);
        assert!(matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
    }
    let unproved: [&dyn Fn(&mut CoupledCertificate); 8] = [
        &|certificate| certificate.reciprocal += Integer::from(1) << 20,
        &|certificate| certificate.reciprocal = -certificate.reciprocal.clone(),
        &|certificate| certificate.cosines[1][1] += Integer::from(1) << 20,
        &|certificate| certificate.sines[1][1] += Integer::from(1) << 20,
        &|certificate| certificate.inverse[0].iter_mut().for_each(|e| *e = Integer::zero()),
        &|certificate| certificate.sigma = -34,
        &|certificate| certificate.forces[1] = &certificate.forces[1] + &expression("y/1000000"),
        &|certificate| certificate.claim = ratio(1, 1) / Integer::from(10).pow(40),
    ];
    for (place, change) in unproved.into_iter().enumerate() {
        let error = refused(change);
        assert!(!matches!(error, CheckError::Malformed(_)), "{place}: {error:?}");
    }
    let claims: [&dyn Fn(&mut ClaimedStability); 4] = [
        &|stability| stability.attracts = Some(false),
        &|stability| stability.largest = Some([ratio(0, 1), ratio(1, 2)]),
        &|stability| stability.largest = Some([ratio(9, 10), ratio(1, 1)]),
        &|stability| stability.largest = Some([ratio(0, 1), ratio(0, 1)]),
    ];
    for (place, change) in claims.into_iter().enumerate() {
        let error =
            refused(&|certificate| change(certificate.stability.as_mut().expect("a claim")));
        let is_of_claim = matches!(
            error,
            CheckError::Stability | CheckError::ClaimedLess { .. } | CheckError::ClaimedMore { .. }
        );
        assert!(is_of_claim, "{place}: {error:?}");
    }
    // Nothing is claimed, and the rest is proved.
    let mut silent = sound.clone();
    silent.stability = None;
    assert!(check_coupled(&silent).is_ok());
}

#[test]
fn equations_without_a_limit_cycle_are_refused_with_the_reason() {
    let refused = |equations: &str, at: &str| try_certify(equations, at).expect_err("a refusal");
    let damped = "x'' + x'/10 + x = y; y'' + y'/10 + 2*y = x";
    let error = refused(damped, "");
    assert!(matches!(error, NotCertified::ComesToRest(_)), "{error:?}");
    let error = refused(damped, "x = 2");
    assert!(matches!(error, NotCertified::ComesToRest(ref from) if from == "x = 2"), "{error:?}");
    let error = refused("x'' - x'/10 + x = y; y'' + y'/20 + 2*y = x", "");
    assert!(matches!(error, NotCertified::RunsAway(_)), "{error:?}");
    let two = "x'' - (1 - x^2)*x'/10 + x = y/20; y'' - (1 - y^2)*y'/10 + 2*y = x/20";
    let error = refused(two, "");
    assert!(matches!(error, NotCertified::NoCycle(_)), "{error:?}");
    let error = refused("x'' - x'/10 + x'^3 + x = y; y'' + y'/10 + 2*y = x", "");
    assert!(matches!(error, NotCertified::NotCoupledDriven { .. }), "{error:?}");
    let error = refused("x'' - (1 - x^2 - y^2)*x'/10 + x = 0; y'' + y'/10 + 2*y = x", "");
    assert!(matches!(error, NotCertified::DampingOfNoFunction), "{error:?}");
    let error = refused(SELF_EXCITED, "k = 1");
    assert!(matches!(error, NotCertified::NoParameter(name) if name == "k"));
}
