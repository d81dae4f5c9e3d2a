//! Several motions at a time, and on several threads, are each what they are alone.

use lindstedt::impact::sweep::sweep_on;
use lindstedt::impact::{Friction, Integrator, Model, Settings, Start, simulate, simulate_many};

/// Motions with every term on, different in every parameter.
fn crowd(count: usize) -> Vec<(Model, Start)> {
    (0..count)
        .map(|index| {
            let part = index as f64 / count as f64;
            let model = Model {
                zeta: 0.02 * part,
                alpha: if index.is_multiple_of(3) { 0.0 } else { 0.1 * part },
                beta: if index.is_multiple_of(4) { 0.0 } else { 0.3 * part },
                frequency_ratio: 0.5 + part,
                gamma: 10.0_f64.powf(3.0 + 6.0 * part),
                mu: if index.is_multiple_of(2) { 0.0 } else { 1e4 },
                left: Some(-1.0 - part),
                right: Some(0.1 + 0.5 * part),
                friction: Friction::Exact,
            };
            let start = Start { x: -0.9 + 0.3 * part, velocity: 0.5 * part };
            (model, start)
        })
        .collect()
}

#[test]
fn several_at_a_time_are_bit_for_bit_what_each_is_alone() {
    // The chain has no moving pivot.
    let at_rest = |(model, start): (Model, Start)| (Model { beta: 0.0, ..model }, start);
    let chains: Vec<(Model, Start)> = crowd(150).into_iter().map(at_rest).collect();
    for (integrator, motions) in [(Integrator::Taylor, crowd(150)), (Integrator::Chain, chains)] {
        let options = Settings { keep_path: false, ..Settings::default() };
        let together = simulate_many(&motions, integrator, &options).expect("they begin");
        for ((model, start), together) in motions.iter().zip(&together) {
            for keep_path in [false, true] {
                let alone = simulate(model, *start, integrator, &Settings { keep_path, ..options })
                    .expect("it begins");
                assert_eq!(alone.impacts, together.impacts, "{model:?}");
                assert_eq!(alone.turns, together.turns);
                assert_eq!(alone.end_x.to_bits(), together.end_x.to_bits());
                assert_eq!((alone.steps, alone.stop), (together.steps, together.stop));
            }
        }
    }
}

#[test]
fn a_sweep_is_the_same_on_any_number_of_threads() {
    let motions = crowd(400);
    let options = Settings::default();
    let one = sweep_on(1, &motions, Integrator::Taylor, &options, |_| ()).expect("they begin");
    let counted = std::sync::atomic::AtomicUsize::new(0);
    let count = |done: usize| {
        counted.fetch_add(done, std::sync::atomic::Ordering::Relaxed);
    };
    let many = sweep_on(5, &motions, Integrator::Taylor, &options, count).expect("they begin");
    assert_eq!(one, many);
    assert_eq!(counted.into_inner(), motions.len());
}

/// A motion that was never begun has nothing to show: no impacts, no depth, no end.
#[test]
fn a_motion_that_was_never_begun_shows_nothing() {
    use lindstedt::Interrupt;
    use lindstedt::export::json;
    use lindstedt::export::simulation::{SweepReport, sweep_csv, sweep_text};
    use lindstedt::impact::sweep::Axis;
    static STOPPED: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(true);
    let axes: [Axis; 1] = ["zeta=0.01:0.02:3".parse().expect("an axis")];
    let motions: Vec<(Model, Start)> = axes[0]
        .values()
        .iter()
        .map(|zeta| {
            let model = Model { zeta: *zeta, ..Model::default() };
            (model, Start::default())
        })
        .collect();
    let settings = Settings { interrupt: Interrupt::from_flag(&STOPPED), ..Settings::default() };
    let mut rows = sweep_on(1, &motions, Integrator::Taylor, &settings, |_| ()).expect("rows");
    assert!(rows.iter().all(|row| !row.is_begun()));
    // One of them was followed to its end.
    rows[1] = sweep_on(1, &motions[1..2], Integrator::Taylor, &Settings::default(), |_| ())
        .expect("a row")[0];
    assert!(rows[1].is_begun());
    let report = SweepReport { axes: &axes, rows: &rows };
    let written = |write: fn(&SweepReport, &mut dyn std::io::Write) -> std::io::Result<()>| {
        let mut text = Vec::new();
        write(&report, &mut text).expect("a text");
        String::from_utf8(text).expect("a text")
    };
    let text = written(sweep_text);
    let words: Vec<&str> = text.lines().nth(1).expect("a line").split_whitespace().collect();
    assert_eq!(words, ["0.01", "-", "-", "-", "-", "-", "-", "incomplete"]);
    let table = written(sweep_csv);
    let cells: Vec<&str> = table.lines().nth(2).expect("a line").split(',').collect();
    assert_eq!(cells[..9], ["0.01", "", "", "", "", "", "", "", ""]);
    assert_eq!(cells[9..], ["false", "interrupted"]);
    assert_eq!(cells.len(), table.lines().nth(3).expect("a line").split(',').count());
    let document: json::SweepDocument =
        serde_json::from_str(&written(json::sweep)).expect("a document");
    let [first, second, _] = document.rows.as_slice() else {
        panic!("{document:?}");
    };
    let none = (first.impacts, first.penetration, first.speed_in, first.energy_lost);
    assert_eq!((none, &first.final_state), ((None, None, None, None), &None));
    assert!(second.impacts.is_some() && second.final_state.is_some());
}
