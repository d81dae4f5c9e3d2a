//! What a sweep varies.

use lindstedt::impact::sweep::sweep;
use lindstedt::impact::{Model, Parameter, Start};
use lindstedt::problem::{Problem, ProblemError};

/// The motions of a grid of two values for each parameter, as the command makes them.
fn grid(file: &str, swept: &[Parameter]) -> Result<Vec<(Model, Start)>, ProblemError> {
    let asked = file.parse::<Problem>().expect("a file").simulate(swept)?;
    (0..1_usize << swept.len())
        .map(|number| {
            let mut case = asked.case;
            for (bit, &parameter) in swept.iter().enumerate() {
                // A swing that reaches its barrier.
                let value = match parameter {
                    Parameter::Amplitude => 0.6,
                    Parameter::Start => -0.55,
                    Parameter::Barrier => 0.1,
                    Parameter::Zeta | Parameter::Alpha | Parameter::Beta => 0.02,
                    Parameter::Viscous => 5e-3,
                    Parameter::Torque => 1e-4,
                    other => 0.2 + 0.01 * f64::from(other as u8),
                };
                // By another ratio each: gamma is that of modulus over mass.
                let ratio = 1.2 + 0.01 * f64::from(parameter as u8);
                case.set(parameter, if number >> bit & 1 == 0 { value } else { value * ratio });
            }
            Ok(case.motion()?)
        })
        .collect()
}

/// Every parameter alone and every pair, beside files that give what might override them: no two
/// rows of a sweep are the same, or the refusal names what is swept and what it would be overridden
/// by.
#[test]
fn what_is_swept_changes_every_row_or_is_refused_with_both_names() {
    const FILES: [&str; 19] = [
        "",
        "[pendulum]\nbarrier = false",
        "[pendulum]\nbarrier = [-1.6, 0.1]",
        "[pendulum]\namplitude = 0.9\nspeed = 0.3",
        "[pendulum]\nstart = -0.8",
        "[pendulum]\nmass = 0.1\nlength = 0.2\ngravity = 2.0\n[sphere]\nradius = 0.1\n[barrier]\nmodulus = 1e5",
        "[contact]\ngamma = 1e3",
        "[contact]\ngamma = 0",
        "[contact]\nmu = 10",
        "[contact]\nlambda = 0.2",
        "[contact]\ngamma = 1e3\nlambda = 0.2",
        "[contact]\ngamma = 1e3\nlambda = 0",
        "[contact]\nrestitution = 0.8",
        "[contact]\nrestitution = 1",
        "[contact]\ngamma = 1e3\ndamping = 1",
        "[contact]\ngamma = 1e3\n[damping]\nviscous = 5e-3\ntorque = 1e-4",
        "[damping]\nzeta = 0.02\nalpha = 0.01\nfriction = \"arctangent\"",
        "[excitation]\nbeta = 0.1\nfrequency_ratio = 0.7",
        "[excitation]\nbeta = 0\nfrequency_ratio = 0.7",
    ];
    let (mut told_apart, mut refused) = (0, 0);
    for file in FILES {
        let settings =
            "".parse::<Problem>().expect("a file").simulate(&[]).expect("a motion").settings;
        let singles = Parameter::ALL.into_iter().map(|parameter| vec![parameter]);
        let pairs = Parameter::ALL.into_iter().flat_map(|first| {
            let later =
                Parameter::ALL.into_iter().filter(move |second| (first as u8) < *second as u8);
            later.map(move |second| vec![first, second])
        });
        for swept in singles.chain(pairs) {
            match grid(file, &swept) {
                Ok(motions) => {
                    let rows =
                        sweep(&motions, lindstedt::impact::Integrator::Taylor, &settings, |_| ())
                            .expect("motions");
                    for (index, row) in rows.iter().enumerate() {
                        assert!(
                            !rows[..index].contains(row),
                            "{file:?}, {swept:?}: two rows are {row:?}"
                        );
                    }
                    told_apart += 1;
                }
                Err(error) => {
                    let text = error.to_string();
                    let says = |parameter: &Parameter| {
                        let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
                        words.any(|word| word == parameter.name())
                    };
                    let named = Parameter::ALL.iter().filter(|parameter| says(parameter)).count();
                    assert!(swept.iter().any(says) && named >= 2, "{file:?}, {swept:?}: {text}");
                    refused += 1;
                }
            }
        }
    }
    assert!(told_apart > 500 && refused > 300, "{told_apart} told apart, {refused} refused");
}
