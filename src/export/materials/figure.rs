//! The paper's Figure 4 and its explanation: the swing against every barrier, and its decay with
//! two forms of the damping held fixed.

use std::f64::consts::TAU;

use crate::decimal::{decimal, significant};
use crate::export::figure::{
    Curve, CurveStyle, FigureError, GuideLine, Panel, Points, Scale, curve, figure, panel,
};
use crate::impact::{
    ContactDamping, HeldFixed, MaterialStudy, Parameter, REST_FRACTION, StudiedMotion,
};

/// Points of a motion, equally spaced in time.
const POINTS: usize = 1200;

/// The curves of the materials, as many as can be told apart: the first are drawn. Black is left
/// for the comparisons.
const STYLES: [CurveStyle; 8] = [
    CurveStyle::SERIES[0],
    CurveStyle::SERIES[1],
    CurveStyle::SERIES[2],
    CurveStyle::SERIES[3],
    CurveStyle::SERIES[5],
    CurveStyle::SERIES[7],
    CurveStyle::SERIES[8],
    CurveStyle::SERIES[9],
];

/// The times of the paper's Figure 4, s.
const FIGURE_4: [f64; 2] = [1.0, 2.5];

/// The periods of a main mass with its damper locked between which its motion is drawn.
const PERIODS: [f64; 2] = [3.0, 7.0];

/// The swing against every barrier from 1 to 2.5 s, as in the paper's Figure 4, or some periods of the
/// main mass, and the decay of
/// its amplitude: as requested, and with the contact damping held fixed in the form under which the
/// modulus has the opposite effect. The decays without a barrier and with a lossless one are drawn
/// for comparison.
///
/// # Errors
/// As [`figure`]; a motion that cannot be followed.
///
/// ```
/// use lindstedt::export::materials::figure;
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let study = study_materials(MaterialQuestion::default())?;
/// assert!(figure::materials(&study)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn materials(study: &MaterialStudy) -> Result<String, FigureError> {
    let drawn = study.rows.len().min(STYLES.len());
    let second = study.units.time();
    let seconds = match &study.question.main_mass {
        None => FIGURE_4,
        Some(main_mass) => {
            let heavy = main_mass.mass + study.units.mass;
            PERIODS.map(|periods| periods * TAU * (heavy / main_mass.stiffness).sqrt())
        }
    };
    let window = seconds.map(|time| time / second);
    let window = match window[1] <= study.question.settings.duration {
        true => window,
        // A slow motion or a short run is drawn from its start.
        false => [0.0, study.question.settings.duration],
    };
    let end = 1.05 * last_rest(study);
    let is_carried = study.question.main_mass.is_some();
    // The displacement of a main mass is counted in lengths of the pendulum.
    let unit = if is_carried { study.units.length } else { 1.0 };
    let contrast = contrast(study);
    let sides: Vec<Option<&HeldFixed>> = std::iter::once(None).chain(contrast.map(Some)).collect();
    let mut motions: Vec<[Vec<Points>; 2]> = Vec::new();
    for held in &sides {
        let (mut swings, mut decays) = (Vec::new(), Vec::new());
        for row in 0..drawn {
            swings.push(swing(&study.motion(row, *held, window[1])?, window, [second, unit]));
            decays.push(decay(&study.motion(row, *held, end)?, second));
        }
        motions.push([swings, decays]);
    }
    let [softest, _] = study.softest_and_hardest();
    let beside = [
        ("no barrier", study.motion_without(None, end)?, CurveStyle::SERIES[4]),
        (
            "barrier without loss",
            study.motion_without(Some(softest), end)?,
            CurveStyle::SECOND_FORMULA,
        ),
    ];
    let beside = beside.map(|(label, motion, style)| (label, decay(&motion, second), style));
    let form = |held: &Option<&HeldFixed>| {
        held.map_or(study.dissipation.contact, |held| held.damping).form().name()
    };
    let has_own = study.rows.iter().any(|row| row.material.damping.is_some());
    let motion = if is_carried { "Main mass" } else { "Swing" };
    let title = |what: &str, held: &Option<&HeldFixed>| match has_own && held.is_none() {
        true => format!("{what}, each as given"),
        false => format!("{what}, {} held fixed", form(held)),
    };
    let titles: Vec<[String; 2]> =
        sides.iter().map(|held| [motion, "Decay"].map(|what| title(what, held))).collect();
    let barriers: Vec<f64> = match is_carried {
        true => vec![],
        false => [study.model.left, study.model.right].into_iter().flatten().collect(),
    };
    let swings = motions.iter().zip(&titles).map(|([swings, _], [title, _])| {
        let guides = barriers.iter().map(|barrier| GuideLine::Y(*barrier, "barrier x_c")).collect();
        let displacement = if is_carried { "displacement (m)" } else { "displacement x (rad)" };
        let labels = ["time t (s)", displacement];
        panel(title, labels, of_materials(study, swings), guides)
    });
    let decays = motions.iter().zip(&titles).map(|([_, decays], [_, title])| {
        let beside = beside.iter().filter(|(_, points, _)| points.len() > 1);
        let beside = beside.map(|(label, points, style)| curve(label, points, *style));
        let labels = ["time t (s)", "amplitude (% of the first swing)"];
        let curves = beside.chain(of_materials(study, decays)).collect();
        let guides = vec![GuideLine::Y(100.0 * REST_FRACTION, "rest, 10 %")];
        Panel { y_scale: Scale::Logarithmic, ..panel(title, labels, curves, guides) }
    });
    let panels: Vec<Panel> = swings.chain(decays).collect();
    figure(&panels, &caption(study, contrast, drawn))
}

/// The time at which the last of them rests; the end of the run if one does not rest.
fn last_rest(study: &MaterialStudy) -> f64 {
    let of_rows = study.rows.iter().map(|row| row.course.rest_time);
    let of_held = study.held_fixed.iter().flat_map(|held| held.rest_times.iter().copied());
    let all: Result<Vec<f64>, _> = of_rows.chain(of_held).chain([study.no_barrier]).collect();
    let longest = all.map(|times| times.into_iter().fold(0.0, f64::max));
    longest.unwrap_or(study.question.settings.duration)
}

/// The form of the damping to contrast with the given one: mu for lambda, lambda for mu.
fn contrast(study: &MaterialStudy) -> Option<&HeldFixed> {
    let by_mu = |damping: ContactDamping| {
        matches!(damping.form(), Parameter::Mu | Parameter::ContactDamping)
    };
    let given = by_mu(study.dissipation.contact);
    study.held_fixed.iter().find(|held| by_mu(held.damping) != given)
}

/// A curve for each material with at least two points.
fn of_materials<'a>(study: &'a MaterialStudy, points: &'a [Points]) -> Vec<Curve<'a>> {
    let rows = study.rows.iter().zip(points).zip(STYLES);
    rows.filter(|((_, points), _)| points.len() > 1)
        .map(|((row, points), style)| curve(&row.material.name, points, style))
        .collect()
}

/// The displacement in this window of time; time and displacement in these units.
fn swing(motion: &StudiedMotion, [from, to]: [f64; 2], [second, unit]: [f64; 2]) -> Points {
    let times = (0..=POINTS).map(|index| from + (to - from) * (index as f64 / POINTS as f64));
    times.filter_map(|t| Some((t * second, unit * motion.displacement_at(t)?))).collect()
}

/// The amplitude at the turning points of the envelope, in percent of the first, the time in
/// seconds.
fn decay(motion: &StudiedMotion, second: f64) -> Points {
    let envelope = motion.envelope();
    let first = envelope.first().map_or(1.0, |(_, height)| *height);
    let points = envelope.iter().map(|(t, height)| (t * second, 100.0 * height / first));
    points.filter(|(_, amplitude)| *amplitude > 0.0).collect()
}

fn caption(study: &MaterialStudy, contrast: Option<&HeldFixed>, drawn: usize) -> String {
    let damping = study.dissipation.contact;
    let words = |damping: ContactDamping| {
        format!(
            "{} = {} {}",
            damping.form().name(),
            decimal(damping.value()),
            damping.form().unit()
        )
        .trim_end()
        .to_owned()
    };
    let mut text = match study.question.main_mass {
        None => String::new(),
        Some(main_mass) => format!("Main mass of {} kg with a p", decimal(main_mass.mass)),
    };
    text += if text.is_empty() { "P" } else { "" };
    text +=
        &format!("endulum of {} m, ζ = {}", decimal(study.units.length), decimal(study.model.zeta));
    if study.model.alpha != 0.0 {
        text += &format!(", α = {}", decimal(study.model.alpha));
    }
    text += &format!("; {}", words(damping));
    if let Some(held) = contrast {
        text += &format!(", or {}", words(held.damping));
    }
    let spread = |held: &HeldFixed| {
        held.spread().map(|spread| format!("{} %", significant(100.0 * spread, 3)))
    };
    if let (Some(first), Some(second)) =
        (study.held_fixed.first().and_then(spread), contrast.and_then(spread))
    {
        text += &format!(": rest times {first} apart, or {second}");
    }
    text += ".";
    if drawn < study.rows.len() {
        text += &format!(" The first {drawn} of {} materials are drawn.", study.rows.len());
    }
    text
}
