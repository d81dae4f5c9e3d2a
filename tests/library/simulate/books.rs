//! Whatever the parameters: energy, impacts and pieces add up.

use lindstedt::impact::{Friction, Model, SimulationStop, Start};
use proptest::prelude::*;

use super::taylor;

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    /// Whatever the parameters: the energy is accounted for, impacts follow each other, no contact
    /// gains energy, and away from the barriers the motion is never beyond them.
    #[test]
    fn every_motion_keeps_its_books(
        zeta in 0.0..0.2_f64,
        alpha in prop_oneof![Just(0.0), 0.0..0.4_f64],
        beta in prop_oneof![Just(0.0), -0.8..0.8_f64],
        frequency_ratio in 0.1..4.0_f64,
        exponent in 2.0..9.0_f64,
        ratio in prop_oneof![Just(0.0), 0.0..2.0_f64],
        right in -0.5..1.4_f64,
        left in prop_oneof![Just(None), (-3.0..-1.5_f64).prop_map(Some)],
        arctangent in any::<bool>(),
        x in -1.4..-0.6_f64,
        velocity in -1.0..1.0_f64,
    ) {
        let gamma = 10.0_f64.powf(exponent);
        let model = Model {
            zeta, alpha, beta, frequency_ratio, gamma, left,
            friction: if arctangent { Friction::Arctangent } else { Friction::Exact },
            mu: ratio * gamma,
            right: Some(right),
        };
        let motion = taylor(&model, Start { x, velocity }, 1e-10, 20.0);
        prop_assert_eq!(motion.stop, SimulationStop::Duration);
        let book = motion.energy();
        prop_assert!(book.residual < 1e-9, "{:?}", book);
        prop_assert!(book.viscous <= 0.0 && book.friction <= 0.0 && book.contact <= 1e-12);
        for pair in motion.impacts.windows(2) {
            let exit = pair[0].exit_time.expect("only the last may last");
            prop_assert!(pair[0].entry_time <= exit && exit <= pair[1].entry_time);
        }
        for (t, x, _) in motion.path.points(4) {
            let free = motion.path.regime_at(t) == Some(lindstedt::impact::Regime::Free);
            prop_assert!(!free || x <= right + 1e-12, "t = {}, x = {}", t, x);
        }
        let pieces = motion.path.pieces();
        for pair in pieces.windows(2) {
            prop_assert_eq!(pair[0].end, pair[1].start);
        }
    }
}
