//! Impact orbits in proved numbers, held against closed forms, exact identities and published numbers; and
//! orbits and claims that are not proved.

use lindstedt::Oscillator;
use lindstedt::certificate::{
    CertifiedOrbit, CheckError, Enclosure, ExactHarmonic, ExactWall, OrbitCertificate,
    OrbitNotProved, WalledOscillator, certify_orbit, check_orbits,
};
use lindstedt::exact::{Integer, Rational, to_f64};
use lindstedt::orbits::{
    FoundOrbits, ImpactEquation, OrbitError, OrbitProofs, OrbitRequest, certify_orbits, find_orbits,
};
use lindstedt::wall::Wall;
use num_traits::{Signed as _, Zero as _};

use crate::random::Random;

const BEAM: &str = "x'' + c*x' + k*x = F*cos(w*t)";

fn ratio(above: i64, below: i64) -> Rational {
    Rational::new(above.into(), below.into())
}

fn question(equation: &str, bounds: &[&str]) -> ImpactEquation {
    let restitution = "e".parse().expect("a letter");
    let walls: Vec<Wall> =
        bounds.iter().flat_map(|bound| Wall::parse(bound, &restitution).expect(bound)).collect();
    ImpactEquation::new(&Oscillator::parse(equation).expect(equation), &walls).expect(equation)
}

fn proofs(
    question: &ImpactEquation,
    at: &str,
    impacts: u32,
    periods: u32,
) -> (FoundOrbits, OrbitProofs) {
    let request = OrbitRequest { impacts, periods: [periods; 2], ..OrbitRequest::default() };
    let found = find_orbits(question, &at.parse().expect(at), &request).expect(at);
    let proofs = certify_orbits(question, &found, request.interrupt).expect(at);
    (found, proofs)
}

/// The proof of an orbit that was found.
fn proved(proofs: &OrbitProofs, index: usize) -> &CertifiedOrbit {
    proofs.proofs[index].as_ref().expect("a motion").as_ref().expect("a proof")
}

/// Whether a double is what is enclosed, but for its own error.
fn agrees(enclosure: &Enclosure, value: f64, error: f64) -> bool {
    (to_f64(&enclosure.middle) - value).abs() <= error + enclosure.radius.value()
}

/// The proved numbers are those of the quadratic for the speed, of the phase and of the multipliers in
/// doubles, to their rounding, and are known to 34 digits; `check` proves them again.
fn agree_with_closed_form((found, proofs): &(FoundOrbits, OrbitProofs)) {
    for (own, proof) in found.orbits.iter().zip(&proofs.proofs) {
        let Some(proof) = proof else { continue };
        let proof = proof.as_ref().expect("a proof");
        assert_eq!(
            (proof.periods, proof.impacts.len()),
            (own.orbit.periods, own.orbit.impacts.len())
        );
        for (enclosed, impact) in proof.impacts.iter().zip(&own.orbit.impacts) {
            assert!(agrees(&enclosed.speed, impact.speed, 1e-9 * impact.speed), "{impact:?}");
            assert!(agrees(&enclosed.phase, found.frequency * impact.time, 1e-8), "{impact:?}");
            for number in [&enclosed.speed, &enclosed.phase] {
                assert!(number.radius.value() < 1e-34, "{number:?}");
            }
        }
        let [one, other] = own.orbit.multipliers;
        assert!(agrees(&proof.multipliers.trace, (one + other).re, 1e-6), "{proof:?}");
        assert!(agrees(&proof.multipliers.determinant, (one * other).re, 1e-6), "{proof:?}");
        let largest = one.norm().max(other.norm());
        assert_eq!(proof.multipliers.attracts, Some(largest < 1.0));
        let enclosed = proof.multipliers.largest.as_ref().expect("a modulus");
        assert!(agrees(enclosed, largest, 1e-6), "{enclosed:?} {largest}");
    }
    assert!(proofs.all_proved());
    let again = check_orbits(&proofs.certificate).expect("a proof");
    assert!(again.iter().eq(proofs.proofs.iter().flatten().flatten()));
}

/// H. Dankowicz and F. Schilder, Recipes for Continuation (2013), example 15.2, and S. W. Shaw and P. J. Holmes,
/// J. Sound Vib. 90 (1983), whose orbit is unstable.
#[test]
fn published_orbits_are_proved() {
    let beam = question(BEAM, &["x < d"]);
    for (at, speed, attracts) in [
        ("c = 0.1, k = 1, F = 1, w = 1, d = 1, e = 0.8", 1.695_732_937_6, true),
        ("c = 0.1, k = 1, F = 0.5, w = 1, d = 1, e = 0.8", 0.837_016_023_2, true),
        ("c = 0, k = 1, F = 1, w = 2.8, d = 0.05, e = 0.8", 0.221_460_380_9, false),
    ] {
        let both = proofs(&beam, at, 1, 1);
        agree_with_closed_form(&both);
        let own = proved(&both.1, 0);
        assert!(agrees(&own.impacts[0].speed, speed, 1e-10), "{own:?}");
        assert_eq!(own.multipliers.attracts, Some(attracts));
    }
    // Two complex multipliers have the modulus of the root of their product.
    let (_, proofs) = proofs(&beam, "c = 0.1, k = 1, F = 1, w = 1, d = 1, e = 0.8", 1, 1);
    let largest = proved(&proofs, 0).multipliers.largest.as_ref().expect("a modulus");
    assert!(agrees(largest, 0.8 * (-0.1 * std::f64::consts::PI).exp(), 1e-15));
}

/// Two walls, two impacts, and a moving table: the speed of a ball in step with it is `2 pi g/(omega (1 + e))`
/// exactly, of the stable orbit and of the unstable one.
#[test]
fn walls_that_move_and_walls_on_both_sides_are_proved() {
    let stops = question("x'' + c*x' + k*x = F*sin(w*t)", &["-d < x < d"]);
    let two = proofs(&stops, "c = 0.1, k = 1, F = 2, w = 1.5, d = 1, e = 0.7", 1, 1);
    agree_with_closed_form(&two);
    let own = proved(&two.1, 0);
    assert_eq!(own.impacts.iter().map(|impact| impact.wall).collect::<Vec<_>>(), [0, 1]);
    // Half of it is the mirror image of the other half, to all digits.
    let apart = (&own.impacts[0].speed.middle - &own.impacts[1].speed.middle).abs();
    assert!(to_f64(&apart) <= 2.0 * own.impacts[0].speed.radius.value());

    let ball = question("x'' + g = 0", &["x > Z*sin(w*t)"]);
    let at = "g = 9.81, Z = 0.003, w = 60, e = 0.5";
    let both = proofs(&ball, at, 1, 1);
    agree_with_closed_form(&both);
    let pi: Rational = "3141592653589793238462643383279502884197169399375/1000000000000000000000000000000000000000000000000"
        .parse()
        .expect("digits");
    let speed = ratio(2, 1) * pi * ratio(981, 100) / (ratio(60, 1) * ratio(3, 2));
    for (index, attracts) in [(0, true), (1, false)] {
        let own = proved(&both.1, index);
        let apart = to_f64(&(&own.impacts[0].speed.middle - &speed).abs());
        assert!(apart <= own.impacts[0].speed.radius.value() + 1e-45, "{apart}");
        assert_eq!(own.multipliers.attracts, Some(attracts));
    }
    let at = "g = 9.81, Z = 0.0045, w = 60, e = 0.5";
    agree_with_closed_form(&proofs(&ball, at, 2, 2));
}

/// Whatever the damping, the stiffness, the load and the side of the wall are, every orbit of the closed form that
/// a motion follows is proved.
#[test]
fn orbits_of_random_oscillators_are_proved() {
    const COUNT: usize = 60;
    let mut random = Random::new(27);
    let mut count = 0;
    for number in 0..COUNT {
        let bound = random.choose(&["x < d", "x > d"]);
        let own = question("x'' + c*x' + k*x = F*cos(w*t) + P", &[bound]);
        let ranges = [
            ("c", 0, 30),
            ("k", -3, 30),
            ("F", 3, 30),
            ("w", 6, 35),
            ("P", -5, 5),
            ("d", -6, 12),
            ("e", 3, 9),
        ];
        let tenths =
            ranges.map(|(name, low, high)| format!("{name} = {}/10", random.whole(low, high)));
        let at = tenths.join(", ");
        let both = proofs(&own, &at, 1, 1 + number as u32 % 2);
        let followed = both.1.proofs.iter().flatten().count();
        if followed > 0 {
            agree_with_closed_form(&both);
        }
        count += followed;
    }
    assert!(count >= 10, "{count} orbits");
}

fn still(value: Rational) -> ExactHarmonic {
    ExactHarmonic { constant: value, cosine: Rational::zero(), sine: Rational::zero() }
}

/// `x'' + c x' + x = F cos(t)` below the wall x = 1.
fn beam(damping: Rational, force: Rational, restitution: Rational) -> WalledOscillator {
    WalledOscillator {
        damping,
        stiffness: ratio(1, 1),
        frequency: ratio(1, 1),
        load: ExactHarmonic { cosine: force, ..still(Rational::zero()) },
        walls: vec![ExactWall { is_above: true, place: still(ratio(1, 1)), restitution }],
    }
}

/// `x = 10 F sin(t)` grazes the wall x = 1 at F = 1/10: it solves the equations of an impact without speed.
#[test]
fn a_grazing_orbit_is_refused() {
    let grazing = beam(ratio(1, 10), ratio(1, 10), ratio(4, 5));
    let refused = certify_orbit(&grazing, 1, &[(0, 1.57, 0.001)]).expect_err("a grazing orbit");
    assert_eq!(refused, OrbitNotProved::Grazing { impact: 1 });
    assert!(refused.to_string().contains("grazes the wall"), "{refused}");
}

/// The closed forms of Shaw and Holmes in two and three periods pass through the wall.
#[test]
fn an_orbit_that_passes_a_wall_is_refused() {
    let stop = question(BEAM, &["x < d"]);
    let at = "c = 0, k = 1, F = 1, w = 2.8, d = 0.05, e = 0.8";
    for periods in [2, 3] {
        let (found, proofs) = proofs(&stop, at, 1, periods);
        assert_eq!(proofs.proofs, [None]);
        assert!(!proofs.all_proved());
        let own = &found.orbits[0].orbit;
        let impact = own.impacts[0];
        let impacts = [(0, found.frequency * impact.time, impact.speed)];
        let refused = certify_orbit(&proofs.certificate.oscillator, periods, &impacts);
        let place = impact.time + own.obstacle.expect("a place").after;
        match refused.expect_err("beyond the wall") {
            OrbitNotProved::Touches { wall: 0, phase } => {
                assert!((phase - found.frequency * place).abs() < 0.5, "{phase} {place}");
            }
            other => panic!("{other}"),
        }
    }
}

/// Without any loss the product of the multipliers is one, and a pair on the circle decides nothing; a wall
/// that takes all speed leaves one multiplier zero.
#[test]
fn what_loses_nothing_or_everything_is_proved() {
    let stop = question(BEAM, &["x < d"]);
    let at = "c = 0, k = 1, F = 1, w = 2.8, d = 0.05, e = 1";
    let (found, lossless) = proofs(&stop, at, 1, 1);
    let mut seen = 0;
    for (own, proof) in found.orbits.iter().zip(&lossless.proofs) {
        let Some(Ok(proof)) = proof else { continue };
        seen += 1;
        assert!(agrees(&proof.multipliers.determinant, 1.0, 0.0));
        let on_circle = own.orbit.multipliers[0].im != 0.0;
        assert_eq!(proof.multipliers.attracts, if on_circle { None } else { Some(false) });
    }
    assert!(seen > 0, "{found:?}");
    let dead = beam(ratio(1, 10), ratio(1, 1), Rational::zero());
    if let Ok((_, proof)) = certify_orbit(&dead, 1, &[(0, 0.1, 1.0)]) {
        assert!(proof.multipliers.determinant.middle.is_zero());
        assert!(agrees(&proof.multipliers.determinant, 0.0, 0.0));
    } else {
        panic!("{:?}", certify_orbit(&dead, 1, &[(0, 0.1, 1.0)]));
    }
}

#[test]
fn numbers_that_are_no_fractions_are_named() {
    let stop = question(BEAM, &["x < d"]);
    let request = OrbitRequest { periods: [1, 1], ..OrbitRequest::default() };
    let at = "c = 0.1, k = 1, F = 1, w = pi/3, d = 1, e = 0.8".parse().expect("values");
    let found = find_orbits(&stop, &at, &request).expect("orbits");
    let refused = certify_orbits(&stop, &found, request.interrupt).expect_err("pi is no fraction");
    assert!(matches!(&refused, OrbitError::NotCertified(OrbitNotProved::NoFraction { what, .. })
        if *what == "the frequency of the drive"));
    assert!(refused.help().is_some_and(|help| help.contains("fraction")), "{refused}");
}

/// A change of a certificate by which it is none.
type Change = fn(&mut OrbitCertificate);

fn tiny() -> Rational {
    Rational::new(1.into(), Integer::from(10).pow(30))
}

fn huge() -> Rational {
    Rational::from_integer(Integer::from(10).pow(190))
}

/// A certificate with any other number is refused: one of the equation, of the orbit or of a claim.
#[test]
fn changed_certificates_are_refused() {
    let stops = question("x'' + c*x' + k*x = F*sin(w*t)", &["-d < x < d"]);
    let at = "c = 0.1, k = 1, F = 2, w = 1.5, d = 1, e = 0.7";
    let certificate = proofs(&stops, at, 1, 1).1.certificate;
    assert!(check_orbits(&certificate).is_ok());
    let changes: [(&str, Change); 18] = [
        ("damping", |own| own.oscillator.damping += tiny()),
        ("stiffness", |own| own.oscillator.stiffness += tiny()),
        ("frequency", |own| own.oscillator.frequency += tiny()),
        ("constant", |own| own.oscillator.load.constant += tiny()),
        ("cosine", |own| own.oscillator.load.cosine += tiny()),
        ("sine", |own| own.oscillator.load.sine -= tiny()),
        ("place", |own| own.oscillator.walls[1].place.constant += tiny()),
        ("wave of a place", |own| own.oscillator.walls[0].place.cosine += tiny()),
        ("restitution", |own| own.oscillator.walls[1].restitution += tiny()),
        ("periods", |own| own.orbits[0].periods = 3),
        ("phase", |own| own.orbits[0].impacts[0].phase += Integer::from(1) << 20),
        ("speed", |own| own.orbits[0].impacts[1].speed -= Integer::from(1) << 20),
        ("wall", |own| own.orbits[0].impacts[1].wall = 0),
        ("order", |own| own.orbits[0].impacts.reverse()),
        ("radius of the phases", |own| own.orbits[0].radii[0] /= ratio(1000, 1)),
        ("radius of the speeds", |own| own.orbits[0].radii[1] = Rational::zero()),
        ("isolation", |own| own.orbits[0].isolation[0] *= ratio(64, 1)),
        ("attracts", |own| own.orbits[0].stability.attracts = Some(false)),
    ];
    for (what, change) in changes {
        let mut changed = certificate.clone();
        change(&mut changed);
        assert!(check_orbits(&changed).is_err(), "{what}");
    }
    let mut narrower = certificate.clone();
    let largest = narrower.orbits[0].stability.largest.as_mut().expect("claims");
    largest[1] = largest[0].clone();
    assert!(matches!(check_orbits(&narrower), Err(CheckError::ClaimedLess { .. })));
    // Wider claims are weaker, and true.
    let mut wider = certificate;
    wider.orbits[0].radii[0] *= ratio(1_000_000, 1);
    wider.orbits[0].isolation[1] /= ratio(2, 1);
    assert!(check_orbits(&wider).is_ok());
}

/// Hostile numbers end in a refusal, and in time.
#[test]
fn numbers_out_of_all_bounds_are_refused() {
    let stop = question(BEAM, &["x < d"]);
    let at = "c = 0.1, k = 1, F = 1, w = 1, d = 1, e = 0.8";
    let certificate = proofs(&stop, at, 1, 1).1.certificate;
    let changes: [Change; 9] = [
        |own| own.oscillator.damping = huge(),
        |own| own.oscillator.stiffness = -huge(),
        |own| own.oscillator.frequency = Rational::zero(),
        |own| own.oscillator.frequency = ratio(1, 1) / huge(),
        |own| own.oscillator.walls[0].restitution = ratio(2, 1),
        |own| own.oscillator.walls.clear(),
        |own| own.orbits[0].impacts.clear(),
        |own| own.orbits[0].radii = [huge(), huge()],
        |own| own.orbits[0].impacts[0].phase = Integer::from(10).pow(190),
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut changed = certificate.clone();
        change(&mut changed);
        assert!(check_orbits(&changed).is_err(), "{index}");
    }
    let mut resonant = certificate;
    resonant.oscillator.damping = Rational::zero();
    let refused = check_orbits(&resonant).expect_err("a resonance");
    let resonance = CheckError::Orbit { orbit: 1, reason: OrbitNotProved::Resonance };
    assert_eq!(refused, resonance);
}
