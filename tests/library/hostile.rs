//! Whatever a program gives to the library is answered or refused: numbers that are none, lists
//! that are empty or of another length, limits at the ends of their types. A panic fails.

use lindstedt::genetic::{self, *};
use lindstedt::method::{Options, solve};
use lindstedt::numeric::ode::{self, State, quadrature, root};
use lindstedt::numeric::{period, periodic, return_map};
use lindstedt::system::{Event, Integrator, System};
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::{
    Method, Oscillator, Symbol, Values, expr::parse_expression, hill, impact, judge, response,
};

const HOSTILE: [f64; 10] =
    [0.0, 1.0, -1.0, 1e-320, 1e-12, 1e308, -1e308, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn pairs() -> impl Iterator<Item = (f64, f64)> {
    HOSTILE.into_iter().flat_map(|one| HOSTILE.map(|other| (one, other)))
}

#[test]
fn numerics() {
    for (a, b) in pairs() {
        let _ = root::find_root(|x| x.sin() - 0.3, a, b);
        let _ = root::find_minimum(f64::cos, a, b);
        let _ = quadrature::integrate_smooth(|x| 1.0 / x, a, b, 1e-9);
        let _ = quadrature::integrate_piecewise(|x| 1.0 / x, &[a, b, a], 1e-9);
        let start = State { t: 0.0, x: a, v: 1.0 };
        let options = ode::IntegrationOptions::default();
        if let Ok(path) = ode::integrate(|_, x, v| -x - v, start, b.min(100.0), &[], &options) {
            let _ = HOSTILE.map(|t| (path.phase_point_at(t), path.phase_at(t)));
            let _ = [0, 1, 2].map(|count| path.samples(count).count());
        }
        let options = ode::IntegrationOptions {
            relative_tolerance: a,
            absolute_tolerance: b,
            maximum_steps: 20_000,
            ..options
        };
        let _ = ode::integrate(|_, x, _| -x, State { t: 0.0, x: 1.0, v: 1.0 }, 10.0, &[], &options);
        let _ = period::swing(&|_, x, _| -x, a, b, 100.0);
        let force = |x: f64| x + x * x * x;
        let _ = period::conservative_period(&period::PiecewiseForce::smooth(&force), a, b);
        let acceleration = |t: f64, x: f64, v: f64| t.cos() - x - v;
        if let Some(motion) = periodic::periodic_motion(&acceleration, a, [b, 0.0], 1.0, &[]) {
            let _ = [0, u32::MAX].map(|number| motion.harmonic(number));
        }
        let acceleration = |x: f64, v: f64| (1.0 - x * x) * v - x;
        for [equilibrium, amplitude, frequency] in [[a, b, 1.0], [0.0, a, b]] {
            let equation = return_map::AutonomousEquation {
                acceleration: &acceleration,
                equilibrium,
                amplitude,
                frequency,
            };
            let _ = return_map::nearest_limit_cycle(&equation, None);
        }
    }
}

#[test]
fn systems_and_courses() {
    let names = [Symbol::new("x"), Symbol::new("v")];
    let right = ["v", "-x + cos(t) + 1/x"].map(|text| parse_expression(text).expect("a rate"));
    let numbers = Default::default();
    let system = System::new(&names, "t".into(), &right, &numbers).expect("a system");
    let events = [
        Event::record(parse_expression("x - 1/2").expect("an event")),
        Event::stop(parse_expression("1/v").expect("an event")),
    ];
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let limited = |tolerance: f64, step_limit: usize| lindstedt::system::SystemOptions {
            integrator,
            tolerance,
            step_limit,
            ..Default::default()
        };
        for (a, b) in pairs() {
            let options = limited(1e-9, 2000);
            for (from, start, to) in [(a, [1.0, b], 3.0), (0.0, [a, b], b)] {
                if let Ok(path) = system.solve([from, to], &start, &events, &options) {
                    let _ = HOSTILE.map(|t| path.states_at(t));
                }
            }
            let _ = system.solve([0.0, b], &[1.0, 0.0], &[], &limited(a, 2000));
        }
        for start in [&[][..], &[1.0], &[1.0, 2.0, 3.0]] {
            assert!(system.solve([0.0, 1.0], start, &[], &limited(1e-9, 2000)).is_err());
        }
        let _ = system.solve([0.0, 1.0], &[1.0, 0.0], &[], &limited(1e-9, 0));
    }
    let _ = System::new(&[], "t".into(), &[], &numbers);
    let _ = System::new(&names, "t".into(), &right[..1], &numbers);
    let _ = System::new(&[names[0], names[0]], "t".into(), &right, &numbers);
    let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an equation");
    for (a, b) in pairs() {
        let mut course = TrajectoryRequest::of_equation(&duffing);
        (course.duration, course.step_limit) = (10.0, 2000);
        course.values.insert("eps".into(), a);
        course.start = vec![b, 0.0];
        let _ = course.clone().follow();
        course.values.insert("eps".into(), 1.0);
        (course.start, course.duration, course.after) = (vec![1.0, 0.0], a, b);
        let _ = course.clone().follow();
        (course.duration, course.after, course.tolerance) = (10.0, 0.0, a);
        let _ = course.clone().follow();
        for start in [vec![], vec![1.0], vec![1.0, 2.0, 3.0]] {
            (course.tolerance, course.start) = (1e-9, start);
            let _ = course.clone().follow();
        }
        course.equations.clear();
        let _ = course.clone().follow();
        course.coordinates.clear();
        let _ = course.follow();
    }
}

#[test]
fn choices_of_a_method() {
    for equation in [
        "x'' + x + eps*x^3 = 0",
        "x'' + sin(x) = 0",
        "x'' - mu*(1 - x^2)*x' + x = 0",
        "x'' + x + 2*zeta*x' + eps*x^3 = F*cos(W*t)",
        "x'' + x^3 = 0",
    ] {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        for method in Method::ALL {
            let choice = Options { method: Some(method), ..Options::default() };
            for order in [0, u32::MAX - 1, u32::MAX] {
                let asked = Options { order: Some(order), ..choice.clone() };
                let answer = solve(&oscillator, &asked);
                assert!(
                    answer.is_err() || order == 0,
                    "{} on {equation} to order {order}",
                    method.name()
                );
            }
            for (p, q) in
                [(0, 0), (1, 0), (0, 1), (u32::MAX, 1), (1, u32::MAX), (u32::MAX, u32::MAX)]
            {
                let resonance = Some((p, q));
                assert!(solve(&oscillator, &Options { resonance, ..choice.clone() }).is_err());
            }
            for cycle in [Some(0), Some(u32::MAX)] {
                let _ = solve(&oscillator, &Options { cycle, ..choice.clone() });
            }
        }
        let solution = solve(&oscillator, &Options::default());
        for at in [
            "A = 1e300, eps = 1e300",
            "A = 1e-300",
            "A = 0",
            "A = 1, eps = 0",
            "mu = 1e300",
            "mu = 0",
        ] {
            let values: Values = at.parse().expect("values");
            if let Ok(solution) = &solution {
                let _ = HOSTILE
                    .map(|tolerance| judge(&oscillator, solution, &values, tolerance).is_ok());
                let motion = solution.motion_at(&values);
                let _ = motion
                    .map(|motion| HOSTILE.map(|t| (motion.displacement_at(t), motion.velocity(t))));
            }
        }
    }
}

#[test]
fn curves_and_responses() {
    let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0").expect("an equation");
    for (order, tongues) in [(0, 0), (u32::MAX, 1), (1, usize::MAX), (1, 0)] {
        let options = hill::HillOptions { order, tongues, ..hill::HillOptions::default() };
        let Ok(curves) = hill::transition_curves(&mathieu, &options) else {
            continue;
        };
        for a in HOSTILE {
            let numbers = [(Symbol::new("eps"), a)].into();
            let _ =
                [0, 1].map(|steps| hill::chart(&curves, &numbers, "eps".into(), a, steps).is_ok());
            let _ = hill::chart(&curves, &Default::default(), "k".into(), a, 1);
        }
    }
    for (a, b) in pairs() {
        let question =
            response::ResponseRequest::new("x'' + x'/5 + x + x^3/10 = cos(w*t)", "w", [a, b], "");
        let mut question = question.expect("a question");
        question.harmonics = Some(3);
        let _ = response::respond(&question);
    }
}

#[test]
fn impacts() {
    let limited = |settings: impact::Settings| impact::Settings { maximum_steps: 2000, ..settings };
    for parameter in impact::Parameter::ALL {
        for a in HOSTILE {
            let mut case = impact::Case::default();
            case.set(parameter, a);
            let _ = (case.get(parameter), case.stiffness(), case.dissipation(None));
            let Ok((model, start)) = case.motion() else {
                continue;
            };
            let settings = limited(impact::Settings { duration: 5.0, ..Default::default() });
            for integrator in [
                impact::Integrator::Taylor,
                impact::Integrator::RungeKutta,
                impact::Integrator::Chain,
            ] {
                let _ = impact::simulate(&model, start, integrator, &settings);
            }
        }
    }
    let model = impact::Model::default();
    for a in HOSTILE {
        let five = impact::Settings { duration: 5.0, ..Default::default() };
        for settings in [
            impact::Settings { duration: a, ..five },
            impact::Settings { relative_tolerance: a, ..five },
            impact::Settings { absolute_tolerance: a, ..five },
            impact::Settings { rest_energy: Some(a), ..five },
        ] {
            let settings = limited(settings);
            let _ = impact::simulate(
                &model,
                impact::Start::default(),
                impact::Integrator::Taylor,
                &settings,
            );
            let _ = impact::chain(&model, impact::Start::default(), &settings);
        }
    }
    for (a, b) in pairs() {
        let _ = (impact::hertz::penetration(a, b), impact::hertz::duration(a, b));
        let setup = impact::Setup { release: a, barrier: b, ..Default::default() };
        let _ = impact::solve(setup).map(|found| {
            let _ = [0, 1].map(|points| found.paths(points));
            found.verdicts(f64::NAN)
        });
        let setup = impact::Setup { stiffness: a, release: b, ..Default::default() };
        let _ = impact::solve(setup);
    }
}

#[test]
fn searches() {
    let space = Space::new(vec![[0.0, 1.0], [1.0, 2.0]]).expect("a box");
    let worth =
        |values: &[f64]| Evaluation { objectives: values.to_vec(), ..Evaluation::default() };
    let lists: [&[f64]; 5] =
        [&[], &[0.5], &[0.5, 1.5], &[0.5, 1.5, 2.0], &[f64::NAN, f64::INFINITY]];
    let mut random = generator(0, 0);
    for one in lists {
        for other in lists {
            for _ in 0..20 {
                for a in HOSTILE {
                    heuristic(one, other, a, &space);
                    adaptive_feasible(one, a, &space, &mut random);
                    bit_flips(one, a, &mut random);
                }
                scattered(one, other, &mut random);
                one_point(one, other, &mut random);
                simulated_binary(one, other, &space, &mut random);
                polynomial_mutation(one, &space, &mut random);
            }
            let all = [worth(one), worth(other)];
            let all: Vec<&Evaluation> = all.iter().collect();
            let _ =
                HOSTILE.map(|tolerance| (ranks(&all, tolerance), non_dominated(&all, tolerance)));
            crowding(&all);
        }
        for parents in [0, 1, 5] {
            stochastic_uniform(one, parents, &mut random);
            rank_scaling(one, parents);
        }
        for window in [0, 1, usize::MAX] {
            let _ =
                HOSTILE.map(|tolerance| has_stalled(one, window, tolerance, StallTest::default()));
        }
        let _ = [0, 1, 64, u32::MAX].map(|bits| Coding::Bits(bits).point(one, &space));
    }
    for evaluations in [0, 1, 3] {
        for every in [0, 1, usize::MAX] {
            random_search(
                &space,
                one_by_one(|_| worth(&[])),
                (evaluations, every),
                0.1,
                &mut random,
            );
            differential_evolution(
                &space,
                one_by_one(|_| worth(&[f64::NAN])),
                (evaluations, every),
                f64::NAN,
                0,
            );
        }
    }
    for population in [0, 1, 2, 5] {
        for (generations, elite) in [(0, 0), (1, 2), (3, 1), (3, usize::MAX)] {
            for crossover_fraction in HOSTILE {
                let options = genetic::GeneticOptions {
                    population,
                    generations,
                    elite,
                    crossover_fraction,
                    stall_generations: elite,
                    ..genetic::GeneticOptions::default()
                };
                options.most_evaluations();
                for values in lists {
                    search(
                        &space,
                        one_by_one(|_| worth(values)),
                        &options,
                        &mut random,
                        &mut |_| true,
                    );
                    let mut count = 0;
                    let shorter = |_: &[f64]| {
                        count += 1;
                        worth(&values[..count % (values.len() + 1)])
                    };
                    search_front(&space, one_by_one(shorter), &options, &mut random, &mut |_| true);
                }
            }
        }
    }
}
