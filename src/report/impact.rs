//! An impact: the problem, each reading of the three phases with the law of its swing, and the
//! numbers compared with Runge-Kutta.

use super::solution::law_blocks;
use super::{Block, Document, percent};
use crate::audit::paper;
use crate::decimal::{decimal, significant};
use crate::impact::contact::power_law::duration_factor;
use crate::impact::contact::{ContactLaw, Dashpot, LossyContact, LossyLaw};
use crate::impact::{
    Attempt, DerivedContact, Flight, Form, Impact, ImpactQuantity, ImpactSymbols, JudgedPhases,
    LossAmount, Modulus, PhaseReading, Setup, SiImpact, Side, YieldCheck,
};
use crate::solution::law::DisplayedLaw;
use crate::solution::{AmplitudeConvention, Solution};
use crate::symbol::Symbol;

/// The document of an impact.
///
/// ```
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = lindstedt::report::impact(&impact, 0.01);
/// assert!(lindstedt::export::text::document(&document, 80).contains("penetration"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact(impact: &Impact, tolerance: f64) -> Document<'_> {
    let mut sections = vec![
        vec![Block::QuestionAsTyped(&impact.equation), Block::Heading(start(impact))],
        problem_blocks(
            &impact.setup,
            impact.letters,
            [impact.equilibrium, impact.turning_point],
            impact.damping,
        ),
    ];
    sections.extend(impact.free_swing.as_ref().map(|law| free_swing(impact, law)));
    for column in &impact.columns {
        sections.push(match (column.reading, &impact.flight) {
            (PhaseReading::Derived, Some(flight)) => derived(impact, column, flight),
            _ => papers(impact, column),
        });
    }
    sections.extend(impact.no_paper.as_ref().map(|reason| {
        vec![Block::Heading(format!("The paper's reading does not apply: {reason}"))]
    }));
    if impact.flight.is_none() {
        let tried = impact.tried.iter().map(|attempt| Block::Detail(attempted(attempt)));
        let heading = Block::Heading("No derived motion".to_owned());
        sections.push(std::iter::once(heading).chain(tried).collect());
    }
    sections.extend(contact_laws(impact));
    sections.extend(lossy_laws(impact));
    sections.push(judged(impact, tolerance));
    if impact.setup.units.is_some() {
        sections.push(match impact.si() {
            Some(si) => in_si_units(impact, &si, tolerance),
            None => vec![Block::Heading(
                "No SI units: a number would be beyond the range of floating point".to_owned(),
            )],
        });
    }
    Document { sections }
}

/// Whether the release is that of the paper, x = -A.
fn is_minus_amplitude(setup: &Setup, equilibrium: f64) -> bool {
    equilibrium == 0.0 && setup.side == Side::Right
}

/// The turning point of the flights, in words.
fn release(impact: &Impact) -> String {
    match is_minus_amplitude(&impact.setup, impact.equilibrium) {
        true => "-A".to_owned(),
        false => decimal(impact.turning_point),
    }
}

fn start(impact: &Impact) -> String {
    let (x, barrier) = (impact.letters.coordinate, impact.letters.barrier);
    let side = match impact.setup.side {
        Side::Right => "",
        Side::Left => " on the left,",
    };
    let start = release(impact);
    if impact.turning_point != impact.setup.release {
        let inside = decimal(impact.setup.release);
        return format!(
            "released from rest at {x} = {inside}, inside the barrier{side} at {barrier}: the deepest point of the cycle below, whose \
             clock starts at its turning point {x} = {start}"
        );
    }
    format!(
        "{x}(0) = {start}, {x}'(0) = 0: released from rest, towards a barrier{side} at {barrier}"
    )
}

pub(super) fn problem_blocks(
    setup: &Setup,
    letters: ImpactSymbols,
    [equilibrium, turning_point]: [f64; 2],
    damping: f64,
) -> Vec<Block<'_>> {
    let value = |name: Symbol, value, source| Block::Value { name, value, source };
    let mut blocks = Vec::new();
    if is_minus_amplitude(setup, equilibrium) {
        blocks.push(value(AmplitudeConvention::Initial.symbol(), -turning_point, None));
    }
    blocks.push(value(letters.barrier, setup.barrier, None));
    let gamma = letters.stiffness;
    if setup.force.as_ref().is_none_or(|force| force.contains(gamma)) {
        blocks.push(value(gamma, setup.stiffness, Some(setup.stiffness_source.as_str())));
    }
    blocks.extend(setup.loss.map(|loss| {
        let source = match (loss.amount, loss.law) {
            (LossAmount::Damping(_), _) => "given, in units of the equation",
            (LossAmount::Restitution(_), LossyLaw::HuntCrossley) => {
                "for the restitution asked for, at the speed of the touch"
            }
            (LossAmount::Restitution(_), LossyLaw::Dashpot(_)) => {
                "for the restitution asked for, at any speed"
            }
        };
        value(letters.damping, damping, Some(source))
    }));
    blocks
        .extend(setup.values.numbers().into_iter().map(|(name, number)| value(name, number, None)));
    blocks
}

fn free_swing<'a>(impact: &Impact, law: &'a Solution) -> Vec<Block<'a>> {
    let heading = format!(
        "The law of the free swing, {} to order {} in {}",
        law.method.title(),
        law.order,
        law.small_parameter
    );
    let mut blocks = vec![Block::Heading(heading), Block::Detail(law.equation.to_string())];
    blocks.extend(first_law(law));
    blocks.extend(impact.frequency().map(|frequency| omega(frequency, "A", impact.amplitude())));
    blocks
}

/// The law in a line, omega^2 if there are two forms; a balance or an integral is left to
/// `lindstedt derive`.
fn first_law(solution: &Solution) -> Vec<Block<'_>> {
    match solution.law.display_forms().into_iter().next() {
        None | Some(DisplayedLaw::System(_) | DisplayedLaw::Quadrature(_)) => vec![],
        Some(shown) => law_blocks(solution, shown),
    }
}

fn omega<'a>(frequency: f64, symbol: &str, amplitude: f64) -> Block<'a> {
    Block::Detail(format!("omega   = {}   ({symbol} = {})", decimal(frequency), decimal(amplitude)))
}

/// The paper's reading.
fn papers<'a>(impact: &Impact, column: &'a JudgedPhases) -> Vec<Block<'a>> {
    let setup = &impact.setup;
    let words = match column.reading {
        PhaseReading::Paper => {
            "The paper's way: every join continuous, contact speed from the one-term motion"
                .to_owned()
        }
        _ => format!("With the contact speed from the energy, v = {}", energy_speed(impact)),
    };
    let mut blocks = vec![Block::Reading { reading: column.reading, words }];
    blocks.extend(column.phases.fitted.map(|fitted| Block::Fitted {
        fitted,
        barrier: setup.barrier,
        rule: setup.rule,
        letters: impact.letters,
        per_stiffness: setup.force.is_none(),
    }));
    blocks.extend(phases(impact, column));
    if column.phases.velocity_jump != 0.0 {
        let jump = decimal(column.phases.velocity_jump);
        blocks.push(Block::Detail(format!("the velocity jumps by {jump} at either join")));
    }
    blocks
}

/// The speed from the energy, for the pendulum in closed form.
fn energy_speed(impact: &Impact) -> String {
    let barrier = impact.letters.barrier;
    match impact.setup.swing {
        None => format!("sqrt(2*(cos({barrier}) - cos(A)))"),
        Some(_) => format!("sqrt(2*(V(-A) - V({barrier})))"),
    }
}

fn phases<'a>(impact: &Impact, column: &'a JudgedPhases) -> impl Iterator<Item = Block<'a>> {
    let (letters, release, is_lossy) =
        (impact.letters, release(impact), impact.setup.loss.is_some());
    column.phases.phases.iter().map(move |phase| Block::Phase {
        phase,
        letters,
        release: match phase.name == "return" && is_lossy {
            true => decimal(phase.phase_point_at(phase.end).0),
            false => release.clone(),
        },
    })
}

/// The derived reading: its law, how it was chosen, its phases.
fn derived<'a>(impact: &Impact, column: &'a JudgedPhases, flight: &'a Flight) -> Vec<Block<'a>> {
    let solution = &flight.solution;
    let mut blocks = vec![Block::Reading {
        reading: column.reading,
        words: format!("Derived, with all harmonics: {}", solution.title()),
    }];
    let setup = &impact.setup;
    let passes =
        |attempt: &Attempt| attempt.error.as_ref().is_ok_and(|error| *error <= setup.tolerance);
    let [it, that, none] = match impact.contact_is_exact() {
        true => ["it", "that", "none"],
        false => ["its approach", "whose approach", "no approach"],
    };
    let chosen = match (setup.order.is_some() || setup.degrees.is_some(), impact.tried.last()) {
        (true, _) | (_, None) => None,
        (false, Some(last)) if passes(last) => Some(match impact.tried.len() {
            1 => format!("the first that was tried, and {it} passes"),
            count => format!("the first of {count} tried {that} passes"),
        }),
        (false, Some(_)) => {
            Some(format!("the closest of {} tried; {none} passes", impact.tried.len()))
        }
    };
    blocks.extend(chosen.map(Block::Detail));
    let x = solution.coordinate();
    if flight.is_turned {
        blocks.push(Block::Detail(format!("{}   (the equation of -{x})", solution.equation)));
    }
    blocks.extend(first_law(solution));
    blocks.push(omega(
        flight.motion.frequency(),
        solution.amplitude.symbol().name(),
        flight.amplitude,
    ));
    blocks.extend(phases(impact, column));
    blocks.push(Block::Detail(format!(
        "the contact begins with the speed {} of that motion; by the energy it is {}",
        decimal(column.phases.speed),
        decimal(impact.energy_speed)
    )));
    if let Form::Contact { depth, .. } = &column.phases.phases[1].form {
        blocks.push(Block::Detail(format!(
            "the contact is written to {:.0e} of its depth; as JSON it has {} sines, to {:.0e}",
            Form::WRITTEN_CONTACT,
            depth.sines().len(),
            depth.deviation
        )));
    }
    blocks.extend(impact.contact.iter().flat_map(|contact| law_of_contact(impact, contact)));
    blocks
}

/// Remarks on a contact that is not the exact one.
fn law_of_contact<'a>(impact: &Impact, contact: &DerivedContact) -> Vec<Block<'a>> {
    let lines = match contact {
        DerivedContact::Elastic(contact) if contact.law == ContactLaw::Exact => vec![],
        DerivedContact::Elastic(contact) => {
            let law = match contact.law {
                ContactLaw::Line(rule) => format!("a line for the force of the barrier, {rule}"),
                law => format!("the law {law}"),
            };
            let factor = contact.exponent().map(|exponent| {
                let (m, factor) = (decimal(exponent + 1.0), decimal(duration_factor(exponent)));
                format!(
                    "  T = (2/m) sqrt(pi) Gamma(1/m)/Gamma(1/m + 1/2) D/v = {factor} D/v, m = {m}"
                )
            });
            let mut lines = vec![
                format!("the contact is by {law}; with s the time since the touch"),
                format!("  {}", contact.closed_form(6, Form::WRITTEN_CONTACT)),
            ];
            match contact.law {
                ContactLaw::PowerLaw => lines.extend(factor),
                ContactLaw::CorrectedPowerLaw => lines.extend([
                    "  Y the motion of the law power-law between depths 0 and 1 and times 0 and 1,"
                        .to_owned(),
                    format!("  and T = {}", decimal(contact.duration)),
                ]),
                _ => {}
            }
            lines
        }
        DerivedContact::Lossy(contact) => lossy_contact(contact, impact.letters.damping),
    };
    lines.into_iter().map(Block::Note).collect()
}

/// The formulas of a contact that loses energy, with this letter for its damping.
fn lossy_contact(contact: &LossyContact, damping: Symbol) -> Vec<String> {
    let mut lines = match contact {
        LossyContact::Dashpot(contact) => {
            let stiffness = decimal(contact.stiffness);
            // Beyond critical damping the angle is imaginary: b = i a.
            let (is, angle, cotangent) = match contact.damping_ratio > 1.0 {
                true => ("cosh a", 'a', "coth"),
                false => ("cos b", 'b', "cot"),
            };
            let restitution = decimal(contact.restitution);
            vec![
                "the contact is a spring with a dashpot, the force of the swing left out of it:"
                    .to_owned(),
                match contact.dashpot {
                    Dashpot::Pulls => format!("  d'' = -{stiffness} (d + {damping} d')"),
                    Dashpot::DoesNotPull => {
                        format!("  d'' = -{stiffness} max(d + {damping} d', 0)")
                    }
                },
                format!(
                    "  zeta = {damping} sqrt({stiffness})/2 = {} = {is}",
                    decimal(contact.damping_ratio)
                ),
                match contact.dashpot {
                    Dashpot::Pulls => format!(
                        "  e = exp(-pi cot b) = {restitution}: it pulls on the way out, until d = 0"
                    ),
                    Dashpot::DoesNotPull => format!(
                        "  e = exp(-2 {angle} {cotangent} {angle}) = {restitution}: it does not pull, and is left at the depth {damping} e v"
                    ),
                },
            ]
        }
        LossyContact::HuntCrossley(contact) => {
            let product = contact.damping * contact.speed;
            let small = 1.0 - 2.0 / 3.0 * product;
            let off = 100.0 * (small / contact.restitution - 1.0).abs();
            let off = if off < 10.0 { significant(off, 2) } else { format!("{off:.0}") };
            let (stiffness, exponent) = (decimal(contact.stiffness), decimal(contact.exponent));
            vec![
                "the contact is by Hunt and Crossley, the force of the swing left out of it:"
                    .to_owned(),
                format!("  d'' = -{stiffness} d^{exponent} (1 + {damping} d')"),
                format!(
                    "  G(-{damping} e v) = G({damping} v), G(z) = z - ln(1 + z), {damping} v = {}",
                    decimal(product)
                ),
                format!(
                    "  e = {}; for small damping 1 - (2/3) {damping} v = {}, {off} % off",
                    decimal(contact.restitution),
                    decimal(small)
                ),
                format!("  (to 1 % up to {damping} v = {SMALL_DAMPING})"),
            ]
        }
    };
    let numbers = contact.numbers();
    lines.push(format!(
        "  greatest force {} at the depth {}, energy lost {} per unit of mass",
        decimal(numbers.peak_force),
        decimal(numbers.peak_depth),
        decimal(numbers.energy_lost)
    ));
    lines
}

/// Largest lambda v for which the first term of the restitution is accurate to 1 %.
const SMALL_DAMPING: f64 = 0.15;

/// The table of every law that loses energy.
fn lossy_laws<'a>(impact: &Impact) -> Option<Vec<Block<'a>>> {
    let wanted = impact.lossy_laws.first()?.closed_form[3];
    let damping = impact.letters.damping;
    let heading = format!(
        "Every law that loses energy, for the restitution {} at the speed {} of the touch by the energy",
        decimal(wanted),
        decimal(impact.energy_speed)
    );
    let rows = impact.lossy_laws.iter().flat_map(|row| {
        let numbers = row.closed_form.map(decimal);
        let errors = row.errors().map(percent);
        let line =
            |first: [String; 3], cells: [String; 4]| first.into_iter().chain(cells).collect();
        let first = [row.law.name().to_owned(), decimal(row.stiffness), decimal(row.damping)];
        [line(first, numbers), line(Default::default(), errors)]
    });
    let head = ["", "stiffness", "lambda", "duration", "penetration", "peak force", "restitution"];
    let note = |text: String| Block::Note(text);
    let is_spring = impact.lossy_laws.windows(2).all(|pair| pair[0].stiffness == pair[1].stiffness);
    let springs =
        "the springs have the energy of the barrier's force at its greatest depth without loss";
    let notes = [
        format!("hunt-crossley: the force of the barrier times 1 + {damping} d'; kelvin-voigt: stiffness (d + {damping} d')"),
        "below each law the errors of its closed form, without the force of the swing, against Runge-Kutta with it;".to_owned(),
        "forces are per unit of mass".to_owned(),
    ];
    let springs = (!is_spring).then(|| springs.to_owned());
    Some(
        [Block::Heading(heading), Block::table(head, rows)]
            .into_iter()
            .chain(springs.into_iter().chain(notes).map(note))
            .collect(),
    )
}

/// The table of every law, and the reasons of those that do not apply.
fn contact_laws(impact: &Impact) -> Vec<Vec<Block<'_>>> {
    if impact.contact_laws.is_empty() {
        return vec![];
    }
    let heading = format!(
        "Every law of the contact, at the speed {} of the touch by the energy",
        decimal(impact.energy_speed)
    );
    let refused = impact.contact_laws.iter().filter_map(|row| {
        let reason = row.outcome.as_ref().err()?;
        Some((row.law.to_string(), reason.to_string()))
    });
    let refused: Vec<_> = refused.collect();
    let mut sections =
        vec![vec![Block::Heading(heading), Block::ContactLaws { rows: &impact.contact_laws }]];
    if !refused.is_empty() {
        sections.push(vec![Block::Entries { heading: "Laws that do not apply", entries: refused }]);
    }
    sections
}

fn attempted(attempt: &Attempt) -> String {
    let order = attempt.order.map_or(String::new(), |order| format!(" to order {order}"));
    let outcome = match &attempt.error {
        Ok(error) => format!("largest error {} %", decimal(100.0 * error)),
        Err(reason) => reason.clone(),
    };
    format!("{}{order}: {outcome}", attempt.method.title())
}

fn judged(impact: &Impact, tolerance: f64) -> Vec<Block<'_>> {
    let columns: Vec<PhaseReading> = impact.columns.iter().map(|column| column.reading).collect();
    let amplitude = impact.amplitude();
    // The power of ten above it; below 1e-15 it is rounding.
    let drift = 10_f64.powf(impact.truth.energy_drift.max(1e-15).log10().ceil());
    let mut blocks = vec![
        Block::Heading("Beside Runge-Kutta on the original equation".to_owned()),
        Block::Quantities {
            columns: columns.clone(),
            rows: impact
                .quantities()
                .into_iter()
                .chain(impact.losses().into_iter().flat_map(|(judged, _)| judged))
                .collect(),
            deviations: impact
                .columns
                .iter()
                .map(|column| column.deviation.total / amplitude)
                .collect(),
            shapes: impact.columns.iter().map(|column| impact.deviations(column)).collect(),
        },
        Block::Detail(format!(
            "Runge-Kutta keeps the energy{} to {drift:e} of the kinetic energy at touch",
            if impact.setup.loss.is_some() { " of the flights" } else { "" }
        )),
        Block::Verdicts {
            verdicts: columns.iter().copied().zip(impact.verdicts(tolerance)).collect(),
            tolerance,
        },
    ];
    if impact.setup.loss.is_some() {
        blocks.push(Block::Detail(format!(
            "the period ends where the motion turns after the impact, at {} = {}",
            impact.letters.coordinate,
            decimal(impact.place_of_turn())
        )));
    }
    for (index, &reading) in columns.iter().enumerate() {
        let shortcomings = impact.shortcomings(index, tolerance).into_iter();
        blocks.extend(shortcomings.map(|(errors, cause)| {
            let errors = errors.iter().map(|(name, error)| format!("{name} {}", percent(*error)));
            let errors: Vec<String> = errors.collect();
            Block::Detail(format!("  {:<8}{}: {cause}", reading.name(), errors.join(", ")))
        }));
    }
    blocks
}

/// The units with their numbers, every quantity in them, and the remarks on yielding and on the
/// paper's contact time.
fn in_si_units<'a>(impact: &Impact, si: &SiImpact, tolerance: f64) -> Vec<Block<'a>> {
    let (sign, inside) = match impact.setup.side {
        Side::Right => ('+', "x - xc"),
        Side::Left => ('-', "xc - x"),
    };
    let is_lossy = impact.setup.loss.is_some();
    let damped = match is_lossy {
        true => format!(" (1 {sign} {} sqrt(L/g) x')", impact.letters.damping),
        false => String::new(),
    };
    let mut blocks = vec![Block::Heading(format!(
        "In SI units: m L^2 x'' + m g L sin(x) {sign} k L (L ({inside}))^(3/2){damped} H({inside}) = 0"
    ))];
    blocks.extend(formulas(impact, si));
    let mut rows: Vec<(ImpactQuantity, &str)> =
        si.rows().into_iter().map(|(row, unit)| (row.clone(), unit)).collect();
    let over_the_printed = paper::over_contact_time(si);
    rows.push((over_the_printed.clone(), ""));
    blocks.push(Block::SiQuantities {
        columns: impact.columns.iter().map(|column| column.reading).collect(),
        rows,
    });
    let damping = &impact.letters.damping;
    let damped = format!(
        "peak force the greatest m g gamma d^(3/2) (1 + {damping} d'), peak pressure 3 F/(2 pi R L d) of F = m g gamma d^(3/2) at the \
         greatest depth d, energy m v^2/2"
    );
    let damped_alone = format!(
        "peak force the greatest m g gamma d^(3/2) (1 + {damping} d'), energy m v^2/2; a pressure needs [sphere] radius"
    );
    let peak = match si.peak_pressure {
        Some(_) if is_lossy => damped.as_str(),
        None if is_lossy => damped_alone.as_str(),
        Some(_) => {
            "peak force F = m g gamma d^(3/2) at the greatest depth d, peak pressure 3 F/(2 pi R L d), energy m v^2/2"
        }
        None => {
            "peak force F = m g gamma d^(3/2) at the greatest depth d, energy m v^2/2; a pressure needs [sphere] radius"
        }
    };
    blocks.push(Block::Detail(peak.to_owned()));
    blocks.push(Block::Note(printed(impact, &over_the_printed, tolerance)));
    blocks.extend(si.yield_checks().iter().map(|check| Block::Note(yielding(check))));
    blocks
}

/// Mass to gamma, each with its formula.
fn formulas<'a>(impact: &Impact, si: &SiImpact) -> Vec<Block<'a>> {
    let units = &si.units;
    let value =
        |name, formula, value, unit, words| Block::SiValue { name, formula, value, unit, words };
    let mut blocks = vec![
        value("m", None, units.mass, "kg", "the mass"),
        value("L", None, units.length, "m", "the length, and the lever arm l of the contact"),
        value("g", None, units.gravity, "m/s^2", "gravity"),
    ];
    blocks.extend(
        units.radius.map(|radius| value("R", None, radius, "m", "the radius of the sphere")),
    );
    if let Some(modulus) = units.modulus {
        let (bodies, formula, words) = match modulus {
            Modulus::BarrierAlone(_) => {
                (vec![], None, "the modulus of the barrier alone, equation (3)")
            }
            Modulus::RigidSphere(barrier) => (
                vec![
                    ("E1", barrier.modulus, "Pa", "the barrier"),
                    ("nu1", barrier.poisson, "", "the barrier"),
                ],
                Some("E1/(1 - nu1^2)"),
                "the modulus of the barrier under a rigid sphere",
            ),
            Modulus::Both { barrier, sphere } => (
                vec![
                    ("E1", barrier.modulus, "Pa", "the barrier"),
                    ("nu1", barrier.poisson, "", "the barrier"),
                    ("E2", sphere.modulus, "Pa", "the sphere"),
                    ("nu2", sphere.poisson, "", "the sphere"),
                ],
                Some("1/((1 - nu1^2)/E1 + (1 - nu2^2)/E2)"),
                "the modulus of both bodies",
            ),
        };
        blocks.extend(
            bodies
                .into_iter()
                .map(|(name, number, unit, words)| value(name, None, number, unit, words)),
        );
        blocks.push(value("E", formula, modulus.value(), "Pa", words));
    }
    let (stiffness, of_gamma, source) = match units.modulus {
        Some(_) => ("4/3*E*sqrt(R)", Some("k*L^(3/2)/(m*g)"), "equation (8)"),
        None => ("gamma*m*g/L^(3/2)", None, "given"),
    };
    blocks.extend([
        value(
            "k",
            Some(stiffness),
            si.contact_stiffness,
            "N/m^(3/2)",
            "the stiffness of the contact",
        ),
        value("T", Some("sqrt(L/g)"), units.time(), "s", "the unit of time"),
        value("V", Some("sqrt(g*L)"), units.speed(), "m/s", "the unit of speed"),
        value("gamma", of_gamma, impact.setup.stiffness, "", source),
        value("beta", Some("(Ae/L)*(Omega/omega)^2"), 0.0, "", "the pivot is at rest"),
    ]);
    blocks
}

/// The contact time that the paper prints, compared with every version.
fn printed(impact: &Impact, over_the_printed: &ImpactQuantity, tolerance: f64) -> String {
    let readings = impact.columns.iter().map(|column| column.reading.name());
    let each: Vec<(&str, f64)> = std::iter::once(("Runge-Kutta", over_the_printed.runge_kutta))
        .chain(readings.zip(over_the_printed.closed_forms.iter().copied()))
        .collect();
    let ratios: Vec<String> =
        each.iter().map(|(name, ratio)| format!("{name} {}", significant(*ratio, 4))).collect();
    let reproduced: Vec<&str> = each
        .iter()
        .filter(|(_, ratio)| paper::is_reproduced(*ratio, tolerance))
        .map(|(name, _)| *name)
        .collect();
    let verdict = match reproduced.is_empty() {
        true => "not reproduced by any of them".to_owned(),
        false => format!("reproduced by {}", reproduced.join(", ")),
    };
    format!(
        "the paper prints a contact time of {} s; over that: {}: {verdict}",
        decimal(paper::CONTACT_TIME),
        ratios.join(", ")
    )
}

/// A stated yield limit compared with the peak pressure.
fn yielding(check: &YieldCheck) -> String {
    let (body, onset, pressure) = (check.body, decimal(check.onset), decimal(check.pressure));
    match check.is_exceeded() {
        true => format!(
            "warning: the {body} yields from a peak pressure of 1.6 Y = {onset} Pa on (for nu = 0.3), and it is {pressure} Pa: the \
             theory is outside its range"
        ),
        false => format!(
            "the {body} yields from a peak pressure of 1.6 Y = {onset} Pa on (for nu = 0.3), and it is {pressure} Pa: elastic"
        ),
    }
}
