//! A study of materials: the problem, the first contact of each barrier, the motion until rest, and
//! the effect of holding another form of the damping fixed. The sentences follow from the numbers.

use super::primary::{MOST_SPREAD, rests_as_nearby};
use super::{Block, Document, cell};
use crate::decimal::{decimal, significant};
use crate::impact::primary::{MainMass, NEARBY};
use crate::impact::{
    ContactDamping, Dissipation, HeldFixed, Integrator, MaterialRow, MaterialStudy, Model,
    Parameter, REST_FRACTION, YieldCheck,
};

/// Relative difference below which rest times count as equal for the choice of a material.
const SAME: f64 = 0.01;

/// Largest number of listed energies of one material; JSON and tables of comma-separated values
/// have all.
const LISTED: usize = 10;

/// The document of a study of materials.
///
/// ```
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let study = study_materials(MaterialQuestion::default())?;
/// let document = lindstedt::report::materials(&study);
/// assert!(lindstedt::export::text::document(&document, 120).contains("Polyester elastomer"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn materials(study: &MaterialStudy) -> Document<'_> {
    let mut sections = vec![problem_blocks(study)];
    if study.rows.iter().any(|row| row.first.is_some()) {
        sections.push(first_contacts(study));
        sections.push(vec![Block::Entries {
            heading: match study.question.main_mass {
                None => "Energy of the swing after each impact until rest, in units of m g L",
                Some(_) => "Energy of main mass and pendulum after each impact until rest, in units of m g L",
            },
            entries: study.rows.iter().map(energies).collect(),
        }]);
    }
    sections.push(until_rest(study));
    if !study.held_fixed.is_empty() {
        sections.push(held_fixed(study));
    }
    sections.push(material_sentences(study).into_iter().map(Block::Sentence).collect());
    Document { sections }
}

fn problem_blocks(study: &MaterialStudy) -> Vec<Block<'_>> {
    let Model { zeta, alpha, ref left, ref right, .. } = study.model;
    let is_default = |parameter| study.question.defaults.contains(&parameter);
    let count = study.rows.len();
    let plural = if count == 1 { "" } else { "s" };
    let viscous = if zeta == 0.0 { "" } else { " + 2*zeta*x'" };
    let dry = if alpha == 0.0 { "" } else { " + alpha*sgn(x')" };
    let value = |name: &str, value, source| Block::Value { name: name.into(), value, source };
    let si =
        |name, formula, value, unit, words| Block::SiValue { name, formula, value, unit, words };
    let mut blocks = vec![Block::Heading(match study.question.main_mass {
        None => format!("{count} barrier{plural} for one pendulum, equation (7):"),
        Some(_) => format!("{count} barrier{plural} for the damper of one main mass:"),
    })];
    let carried = match study.question.main_mass {
        None => "",
        Some(_) => {
            blocks.push(Block::Note(MAIN_MASS_EQUATION.to_owned()));
            " + y''*cos(x)"
        }
    };
    blocks.extend([
        Block::Note(format!(
            "x''{carried}{viscous}{dry} + sin(x) + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc) = 0, x(0) = {}, x'(0) = {}",
            decimal(study.start.x),
            decimal(study.start.velocity)
        )),
    ]);
    if let Some(main_mass) = &study.question.main_mass {
        let hangs = study.start.x == 0.0 && study.start.velocity == 0.0;
        blocks.push(main_mass_note(main_mass, hangs));
    }
    blocks.extend(left.map(|left| value("xl", left, Some("the left barrier"))));
    blocks.extend(right.map(|right| value("xc", right, None)));
    let design = &study.question.case.design;
    blocks.extend([
        si("m", None, design.mass, "kg", "the mass"),
        si("R", None, design.radius, "m", "the radius of the sphere"),
        si("L", None, design.length, "m", "the length"),
        si("g", None, design.gravity, "m/s^2", "gravity"),
        si("T", Some("sqrt(L/g)"), study.units.time(), "s", "the unit of time"),
    ]);
    let default = ", by default: the paper prints none";
    let said = |parameter| if is_default(parameter) { default } else { "" };
    let damping = study.question.case.contact_damping;
    let at = at_speed(&study.dissipation);
    blocks.push(Block::Note(format!(
        "held fixed: {}{at}{}",
        in_words(damping),
        said(damping.form())
    )));
    if zeta != 0.0 {
        let forms = [
            (Parameter::Viscous, study.dissipation.viscous, "N s/m"),
            (Parameter::Zeta, Some(zeta), ""),
        ];
        blocks.push(Block::Note(
            chosen(study.dissipation.viscous_form, forms) + said(Parameter::Zeta),
        ));
    }
    if alpha != 0.0 {
        let forms = [
            (Parameter::Torque, study.dissipation.torque, "N m"),
            (Parameter::Alpha, Some(alpha), ""),
        ];
        blocks.push(Block::Note(chosen(study.dissipation.friction_form, forms)));
    }
    let settings = &study.question.settings;
    let route = match study.question.integrator {
        Integrator::Chain => "by closed forms, swing and contact in turn, ",
        Integrator::Taylor | Integrator::RungeKutta => "",
    };
    blocks.push(Block::Note(format!(
        "followed {route}until t = {}; rest: {} % of the amplitude of the first swing{}",
        decimal(settings.duration),
        decimal(100.0 * REST_FRACTION),
        if study.question.main_mass.is_some() { " of the main mass" } else { "" }
    )));
    let amplitude = study.question.case.amplitude;
    if study.question.integrator == Integrator::Chain
        && study.question.main_mass.is_none()
        && study.model.alpha > CHAIN_FRICTION * amplitude
    {
        blocks.push(Block::Note(format!(
            "alpha = {} is more than {} of the amplitude: rest times by closed forms may be several percent off, without --chain they are not",
            decimal(study.model.alpha),
            decimal(CHAIN_FRICTION)
        )));
    }
    blocks
}

/// The equation of a main mass.
pub(super) const MAIN_MASS_EQUATION: &str =
    "(R + 1)*y'' + x''*cos(x) - x'^2*sin(x) + delta*y' + kappa*y = 0";

/// The numbers and the start of a main mass, whose pendulum may hang at rest.
pub(super) fn main_mass_note<'a>(main_mass: &MainMass, hangs: bool) -> Block<'a> {
    let MainMass { mass, stiffness, damping, displacement, speed, .. } = *main_mass;
    Block::Note(format!(
        "main mass of {} kg on {} N/m and {} N s/m, let go from {} m at {} m/s{}",
        decimal(mass),
        decimal(stiffness),
        decimal(damping),
        decimal(displacement),
        decimal(speed),
        if hangs { " with the pendulum hanging at rest" } else { "" }
    ))
}

/// Largest ratio of alpha to the amplitude for which the rest times of a chain are within one
/// percent; `docs/chain.md`.
const CHAIN_FRICTION: f64 = 0.02;

/// The form that is given, with its number: `held fixed: zeta = 0.02`.
pub(super) fn chosen(given: Parameter, forms: [(Parameter, Option<f64>, &str); 2]) -> String {
    let form = forms.into_iter().find(|(form, ..)| *form == given);
    match form {
        Some((form, Some(value), unit)) => {
            format!(
                "held fixed: {}",
                format!("{} = {} {unit}", form.name(), decimal(value)).trim_end()
            )
        }
        _ => format!("held fixed: {}", given.name()),
    }
}

/// ` at the speed 1 m/s, 1.22347 rad*omega`; empty if no speed is stated.
fn at_speed(dissipation: &Dissipation) -> String {
    let speed = dissipation.at_speed_in_words();
    speed.map_or(String::new(), |speed| format!(" at the speed {speed}"))
}

/// `lambda = 0.122347 s/m`
pub(super) fn in_words(damping: ContactDamping) -> String {
    let form = damping.form();
    let text = format!("{} = {} {}", form.name(), decimal(damping.value()), form.unit());
    text.trim_end().to_owned()
}

fn first_contacts(study: &MaterialStudy) -> Vec<Block<'_>> {
    let row = |row: &MaterialRow| {
        let first = row.first;
        vec![
            row.material.name.clone(),
            decimal(row.material.modulus.value()),
            decimal(row.gamma),
            cell(first.map(|first| first.duration)),
            cell(first.map(|first| first.penetration)),
            cell(first.map(|first| first.peak_force)),
            cell(first.map(|first| first.peak_pressure)),
            cell(first.map(|first| first.restitution)),
        ]
    };
    let mut blocks = vec![
        Block::Heading(match study.rows.iter().find_map(|row| row.first) {
            Some(first) => format!("The first contact, touched at {} m/s", decimal(first.speed)),
            None => "The first contact".to_owned(),
        }),
        Block::table([
                ("material", "material"),
                ("E, Pa", "$E$, Pa"),
                ("gamma", "$\\gamma$"),
                ("duration, s", "duration, s"),
                ("depth, m", "depth, m"),
                ("force, N", "force, N"),
                ("pressure, Pa", "pressure, Pa"),
                ("restitution", "restitution"),
            ], study.rows.iter().map(row)),
        Block::Note(
            "gamma by equation (8); greatest force with the damping in it; pressure of Hertz at the greatest depth"
                .to_owned(),
        ),
    ];
    let checks =
        study.rows.iter().flat_map(|row| row.yield_checks.iter().map(move |check| (row, check)));
    blocks.extend(checks.map(|(row, check)| Block::Sentence(yielding(&row.material.name, check))));
    blocks
}

fn yielding(name: &str, check: &YieldCheck) -> String {
    let (body, onset, pressure) = (check.body, decimal(check.onset), decimal(check.pressure));
    match check.is_exceeded() {
        true => format!(
            "warning: with {name} the {body} yields, from a peak pressure of 1.6 Y = {onset} Pa on (for nu = 0.3), and it is \
             {pressure} Pa: the law of Hertz is outside its range"
        ),
        false => format!(
            "with {name} the {body} stays elastic: {pressure} Pa, and it yields from 1.6 Y = {onset} Pa on (for nu = 0.3)"
        ),
    }
}

fn energies(row: &MaterialRow) -> (String, String) {
    let energies = &row.course.energies;
    let shown: Vec<String> =
        energies.iter().take(LISTED).map(|energy| significant(*energy, 4)).collect();
    let more = match energies.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let text = match shown.is_empty() {
        true => "no impact".to_owned(),
        false => shown.join(", ") + &more,
    };
    (row.material.name.clone(), text)
}

fn until_rest(study: &MaterialStudy) -> Vec<Block<'_>> {
    let row = |row: &MaterialRow| {
        let rest = row.course.rest_time.ok();
        vec![
            row.material.name.clone(),
            decimal(row.dissipation.mu_over_gamma),
            decimal(row.dissipation.mu),
            row.course.impacts.len().to_string(),
            cell(rest),
            cell(rest.map(|rest| study.seconds(rest))),
            cell(row.lossless.ok()),
        ]
    };
    let mut blocks = vec![
        Block::Heading("Until rest".to_owned()),
        Block::table(
            [
                ("material", "material"),
                ("mu/gamma", "$\\mu/\\gamma$"),
                ("mu", "$\\mu$"),
                ("impacts", "impacts"),
                ("rest, 1/omega", "rest, $1/\\omega$"),
                ("rest, s", "rest, s"),
                ("rest at mu = 0", "rest at $\\mu = 0$"),
            ],
            study.rows.iter().map(row),
        ),
    ];
    let touched = study.rows.iter().any(|row| !row.course.impacts.is_empty());
    if !touched {
        let body = if study.question.main_mass.is_some() { "main mass" } else { "plain pendulum" };
        blocks.push(Block::Note(format!(
            "no barrier is touched within the run: the material has no say, every row is the {body}"
        )));
    }
    let own = study.rows.iter().filter_map(|row| {
        let damping = row.material.damping?;
        let at = at_speed(&row.dissipation);
        Some(format!("{} has its own damping: {}{at}", row.material.name, in_words(damping)))
    });
    blocks.extend(own.map(Block::Note));
    blocks.extend(study.rows.iter().filter_map(|row| {
        let reason = row.course.rest_time.err()?;
        Some(Block::Sentence(format!("{} has no rest time: {reason}", row.material.name)))
    }));
    blocks.push(Block::Note(match study.no_barrier {
        Ok(rest) => format!(
            "without a barrier: {}, {} s; at mu = 0 the same barrier loses nothing",
            decimal(rest),
            decimal(study.seconds(rest))
        ),
        Err(reason) => format!("without a barrier: no rest time, {reason}"),
    }));
    blocks.extend(study.undamped_and_locked().map(|others| {
        let [without, locked] = [others.without, others.locked].map(|alone| cell(alone.rest_time));
        Block::Note(format!("main mass without the damper: {without}; with it locked: {locked}"))
    }));
    blocks
}

fn held_fixed(study: &MaterialStudy) -> Vec<Block<'_>> {
    let row = |held: &HeldFixed| {
        let times =
            held.extremes().map(|extremes| extremes.map(|number| held.rest_times[number].ok()));
        let [first, last] = times.unwrap_or([None, None]);
        let [softest, hardest] = study.softest_and_hardest();
        vec![
            in_words(held.damping),
            decimal(held.ratios[softest]),
            decimal(held.ratios[hardest]),
            cell(held.restitutions[softest]),
            cell(held.restitutions[hardest]),
            cell(first),
            cell(last),
            held.spread().map_or("-".to_owned(), percent),
        ]
    };
    let has_own = study.rows.iter().any(|row| row.material.damping.is_some());
    let aside = has_own
        .then(|| Block::Note("dampings of their own are left aside in this table".to_owned()));
    let blocks = vec![
        Block::Heading(format!(
            "What is held fixed decides: the same damping at E = {} Pa, held fixed in each of its forms",
            decimal(study.question.case.design.modulus)
        )),
        Block::table([
                ("held fixed", "held fixed"),
                ("mu/gamma from", "$\\mu/\\gamma$ from"),
                ("to", "to"),
                ("restitution from", "restitution from"),
                ("to", "to"),
                ("rest from", "rest from"),
                ("to", "to"),
                ("apart", "apart"),
            ], study.held_fixed.iter().map(row)),
        Block::Note(
            "mu/gamma and restitution (at the first touch without damping) from the softest to the hardest; rest from the first to the last"
                .to_owned(),
        ),
    ];
    blocks.into_iter().chain(aside).collect()
}

pub(super) fn percent(part: f64) -> String {
    match part < 5e-7 {
        true => "< 0.0001 %".to_owned(),
        false => format!("{} %", significant(100.0 * part, 3)),
    }
}

/// The results of a study of materials, in sentences.
pub fn material_sentences(study: &MaterialStudy) -> Vec<String> {
    let mut sentences = Vec::new();
    let groups: [(&[Parameter], bool); 2] = [
        (&[Parameter::Mu, Parameter::ContactDamping], true),
        (&[Parameter::MuOverGamma, Parameter::Lambda, Parameter::Restitution], false),
    ];
    for (forms, ratio_changes) in groups {
        let held: Vec<&HeldFixed> =
            study.held_fixed.iter().filter(|held| forms.contains(&held.damping.form())).collect();
        sentences.extend(what_it_does(study, &held, ratio_changes));
    }
    sentences.extend(what_the_modulus_changes(study));
    sentences.extend(baseline(study));
    sentences.extend(validity(study));
    sentences
}

/// Whether the rest times of a main mass by closed forms can be relied upon, by those of starts nearby;
/// `None` by integration, and if none rests.
fn validity(study: &MaterialStudy) -> Option<String> {
    if study.question.main_mass.is_none() || study.question.integrator != Integrator::Chain {
        return None;
    }
    let rests = || study.rows.iter().filter(|row| row.course.rest_time.is_ok());
    let doubtful = rests().filter(|row| !rests_as_nearby(row.nearby));
    let doubtful: Vec<&str> = doubtful.map(|row| &row.material.name[..]).collect();
    let [part, most] = [NEARBY, MOST_SPREAD].map(|part| significant(100.0 * part, 1));
    let count = rests().count();
    match (count, doubtful.len()) {
        (0, _) => None,
        (_, 0) => Some(format!(
            "Starts {part} % smaller and larger rest within {most} % of each other against every barrier at which the main mass rests."
        )),
        (_, those) => Some(format!(
            "For {those} of {count} materials, {}, starts {part} % smaller and larger rest more than {most} % apart or not at all: each impact \
             decides when the next one is, and closed forms cannot give these rest times; integrate instead, without --chain.",
            doubtful.join(", ")
        )),
    }
}

/// The effect of holding one of these forms fixed on the rest times.
fn what_it_does(study: &MaterialStudy, held: &[&HeldFixed], ratio_changes: bool) -> Option<String> {
    let names: Vec<&str> = held.iter().map(|held| held.damping.form().name()).collect();
    let names = match names.split_last()? {
        (last, []) => (*last).to_owned(),
        (last, names) => format!("{} or {last}", names.join(", ")),
    };
    let first = held.first()?;
    let Some(spread) = held.iter().map(|held| held.spread()).collect::<Option<Vec<f64>>>() else {
        return Some(format!("With {names} held fixed not every material rests within the run."));
    };
    let spread = spread.into_iter().fold(0.0, f64::max);
    let [softest, hardest] = study.softest_and_hardest();
    if softest == hardest {
        return None;
    }
    let ratios = format!(
        "mu/gamma goes from {} (softest) to {} (hardest)",
        significant(first.ratios[softest], 3),
        significant(first.ratios[hardest], 3)
    );
    let restitutions = match (first.restitutions[softest], first.restitutions[hardest]) {
        (Some(soft), Some(hard)) => {
            format!(", the restitution from {} to {}", significant(soft, 4), significant(hard, 4))
        }
        _ => String::new(),
    };
    let why = match ratio_changes {
        true => format!(": {ratios}{restitutions}"),
        false => {
            ": mu/gamma and with it the restitution at a given speed are those of every modulus"
                .to_owned()
        }
    };
    let apart = percent(spread);
    let body = if study.question.main_mass.is_some() { "main mass" } else { "pendulum" };
    Some(match (spread < SAME, study.order(first)) {
        (true, _) => format!(
            "With {names} held fixed the rest times are {apart} apart: the modulus does not decide when the {body} rests{why}."
        ),
        (false, Some(true)) => format!(
            "With {names} held fixed the rest times are {apart} apart, and the softer the barrier the sooner the rest{why}."
        ),
        (false, Some(false)) => format!(
            "With {names} held fixed the rest times are {apart} apart, and the harder the barrier the sooner the rest{why}."
        ),
        (false, None) => {
            format!(
                "With {names} held fixed the rest times are {apart} apart, in no order of the modulus{why}."
            )
        }
    })
}

/// The factors by which the first contact differs from the softest to the hardest material.
fn what_the_modulus_changes(study: &MaterialStudy) -> Option<String> {
    let [softest, hardest] = study.softest_and_hardest();
    let (soft, hard) = (study.rows[softest].first?, study.rows[hardest].first?);
    if softest == hardest {
        return None;
    }
    let ratios = [
        soft.duration / hard.duration,
        soft.penetration / hard.penetration,
        hard.peak_force / soft.peak_force,
    ];
    if !ratios.iter().all(|ratio| ratio.is_normal()) {
        return None;
    }
    let [shorter, less_deep, larger] = ratios.map(|ratio| significant(ratio, 3));
    Some(format!(
        "From {} to {} the first contact lasts {shorter} times shorter, goes {less_deep} times less deep, and its force is {larger} times \
         larger; its restitution is {} and {}.",
        study.rows[softest].material.name,
        study.rows[hardest].material.name,
        significant(soft.restitution, 4),
        significant(hard.restitution, 4)
    ))
}

/// The benefit of a barrier over none, in words; `None` if it is not known.
fn baseline(study: &MaterialStudy) -> Option<String> {
    if study.rows.iter().all(|row| row.course.impacts.is_empty()) {
        return None;
    }
    let none = study.no_barrier.ok()?;
    let range = |times: Vec<f64>| {
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        let most = times.iter().copied().fold(0.0, f64::max);
        match (most - least) / least < 5e-4 {
            true => format!("at {}", significant(least, 4)),
            false => format!("between {} and {}", significant(least, 4), significant(most, 4)),
        }
    };
    let rows = study.rows.iter();
    let with: Vec<f64> =
        rows.clone().map(|row| row.course.rest_time).collect::<Result<_, _>>().ok()?;
    let lossless: Vec<f64> = rows.map(|row| row.lossless).collect::<Result<_, _>>().ok()?;
    let body = if study.question.main_mass.is_some() { "main mass" } else { "swing" };
    Some(format!(
        "Without a barrier the {body} rests at {}, with these barriers without loss {}, with their loss {}.",
        significant(none, 4),
        range(lossless),
        range(with)
    ))
}
