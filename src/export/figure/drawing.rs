//! The drawing by the library: which points of a panel are drawn, the range and power of ten of each
//! axis, lines, legend and caption.

use std::collections::BTreeSet;
use std::sync::Arc;

use kuva::prelude::{
    Figure, LabelConfig, Layout, LegendEntry, LegendPlot, LinePlot, LineStyle, Plot, ScatterPlot,
    SvgBackend, TickFormat, collect_legend_entries,
};
use kuva::render::render::{Primitive, Scene, TextAnchor};
use kuva::render::render_utils::wrap_text;

use super::super::escaped;
use super::{Curve, CurveStyle, FigureError, GuideLine, POINTS, Panel, Scale};

/// Width of the page in units of 1/96 inch (190 mm), and its margin.
const PAGE: f64 = 720.0;
const MARGIN: f64 = 10.0;
/// Number of points that are not joined beyond which only a selection is drawn.
const MOST_DOTS: usize = 12_000;
/// Number of points of a curve beyond which it is thinned.
const MOST_POINTS: usize = 2000;

/// Sets panels two abreast, a last one alone across the page, or each across the page.
pub(super) fn arranged(
    panels: &[Panel],
    caption: &str,
    abreast: bool,
) -> Result<String, FigureError> {
    if panels.is_empty() {
        return Err(FigureError::Empty("the figure".to_owned()));
    }
    let (mut plots, mut layouts, mut cells) = (Vec::new(), Vec::new(), Vec::new());
    let mut entries: Vec<LegendEntry> = Vec::new();
    for (index, panel) in panels.iter().enumerate() {
        let alone = !abreast || (index + 1 == panels.len() && index % 2 == 0);
        let columns = 1 + usize::from(alone);
        let (lines, layout) = drawn(panel, columns)?;
        let key = |entry: &LegendEntry| {
            (entry.label.clone(), entry.color.clone(), entry.dasharray.clone())
        };
        for entry in collect_legend_entries(&lines) {
            if entries.iter().all(|other| key(other) != key(&entry)) {
                entries.push(entry);
            }
        }
        plots.push(lines);
        layouts.push(layout);
        // Cells 0 and 1 are the row of the legend, so that panels begin with cell 2.
        let first = if abreast { index + 2 } else { 2 * index + 2 };
        cells.push((first..first + columns).collect());
    }
    entries.sort_by_key(|entry| entry.color == CurveStyle::GUIDE.0);
    let longest = entries.iter().map(|entry| entry.label.chars().count()).max();
    let rows = if abreast { panels.len().div_ceil(2) } else { panels.len() };
    let abreast = (97 / (longest.unwrap_or(0) + 7)).clamp(1, 4);
    let legend_height = 1.0 + 22.0 * entries.len().div_ceil(abreast) as f64;
    let legend = LegendPlot::from_entries(entries).with_cols(abreast).with_max_cols(abreast);
    plots.push(vec![Plot::LegendPlot(legend.without_box())]);
    // A small font at a large scale gives longer line samples in the legend with text of the usual
    // size.
    let layout = Layout::new((0.0, 1.0), (0.0, 1.0)).with_scale(1.5).with_body_size(8);
    layouts.push(layout.with_force_margins(16.0, 0.0).with_force_margins_y(6.0, 0.0));
    cells.push(vec![0, 1]);

    let letters: Vec<String> = ('A'..='Z').take(panels.len()).map(String::from).collect();
    let scene = Figure::new(1 + rows, 2)
        .with_structure(cells)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_labels_custom(letters.iter().map(String::as_str).collect(), LabelConfig::default())
        .with_padding(MARGIN)
        .with_cell_size((PAGE - 2.0 * MARGIN - 15.0) / 2.0, 290.0)
        .with_row_height(0, legend_height)
        .render();
    Ok(written(scene, caption))
}

/// The library's lines and axes for one panel that is one or two columns wide; an error for values
/// that have no place on them.
fn drawn(panel: &Panel, columns: usize) -> Result<(Vec<Plot>, Layout), FigureError> {
    let within = |thing: String| format!("{thing} in panel \"{}\"", panel.title);
    if panel.curves.is_empty() {
        return Err(FigureError::Empty(within("the list of curves".to_owned())));
    }
    let (mut xs, mut ys, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for curve in &panel.curves {
        let points = placed(curve, panel)?;
        xs.extend(points.iter().map(|point| point.0));
        ys.extend(points.iter().map(|point| point.1));
        lines.push((curve.label, points, curve.style));
    }
    for guide in &panel.guides {
        let (at, label, list) = match *guide {
            GuideLine::X(at, label) => (panel.x_scale.position(at), label, &mut xs),
            GuideLine::Y(at, label) => (panel.y_scale.position(at), label, &mut ys),
        };
        if !at.is_finite() {
            return Err(FigureError::OffAxes(within(format!("guide \"{label}\""))));
        }
        list.push(at);
    }
    let (x_power, x_range) = extent(&xs, panel.x_scale);
    let (y_power, y_range) = extent(&ys, panel.y_scale);
    let (x_unit, y_unit) = (10f64.powi(x_power), 10f64.powi(y_power));
    let across = |y: f64| vec![(x_range.0, y / y_unit), (x_range.1, y / y_unit)];
    let upright = |x: f64| vec![(x / x_unit, y_range.0), (x / x_unit, y_range.1)];
    let guides = panel.guides.iter().map(|guide| match *guide {
        GuideLine::X(at, label) => {
            plot(label, upright(panel.x_scale.position(at)), CurveStyle::GUIDE)
        }
        GuideLine::Y(at, label) => {
            plot(label, across(panel.y_scale.position(at)), CurveStyle::GUIDE)
        }
    });
    let scaled = |points: Vec<(f64, f64)>| {
        points.into_iter().map(|(x, y)| (x / x_unit, y / y_unit)).collect()
    };
    let curves = lines.into_iter();
    let curves = curves.map(|(label, points, style)| plot(label, scaled(points), style));
    let lines = guides.chain(curves).collect();
    Ok((lines, axes(panel, (x_power, x_range), (y_power, y_range), columns)))
}

impl Scale {
    /// The coordinate of a value on an axis. A logarithmic axis is drawn as a linear one of
    /// exponents, because that of the plotting library ends at 1e-10.
    fn position(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.log10(),
        }
    }
}

/// The points of a curve on the axes of its panel, thinned to those that can be distinguished.
fn placed(
    Curve { label, points, style }: &Curve,
    panel: &Panel,
) -> Result<Vec<(f64, f64)>, FigureError> {
    let within = |thing: String| format!("{thing} in panel \"{}\"", panel.title);
    let place = |&(x, y): &(f64, f64)| (panel.x_scale.position(x), panel.y_scale.position(y));
    let off = |point: &&(f64, f64)| {
        let (x, y) = place(point);
        !point.0.is_finite() || !point.1.is_finite() || x.is_nan() || y.is_nan()
    };
    if let Some(point) = points.iter().find(off) {
        return Err(FigureError::OffAxes(within(format!("point {point:?} of \"{label}\""))));
    }
    let points = points.iter().map(place);
    let points: Vec<(f64, f64)> = points.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let (points, enough) = match style.1 == POINTS {
        true => {
            let every = points.len().div_ceil(MOST_DOTS).max(1);
            (points.into_iter().step_by(every).collect(), 1)
        }
        false => (thinned(&points), 2),
    };
    if points.len() < enough {
        return Err(FigureError::TooFewPoints(within(format!("curve \"{label}\""))));
    }
    Ok(points)
}

/// A curve or dots, as an object of the library.
fn plot(
    label: &str,
    points: Vec<(f64, f64)>,
    CurveStyle(colour, dashes, width): CurveStyle,
) -> Plot {
    let words = Some(printable(label)).filter(|label| !label.is_empty());
    if dashes == POINTS {
        let points = ScatterPlot::new().with_data(points).with_color(colour).with_size(width);
        return Plot::Scatter(match words {
            None => points,
            Some(words) => points.with_legend(words),
        });
    }
    let line = LinePlot::new().with_data(points).with_color(colour);
    let mut line = line.with_stroke_width(width);
    line.legend_label = words;
    Plot::Line(line.with_line_style(LineStyle::Custom(dashes.to_owned())))
}

/// The power of ten of an axis, and its range in units of it.
type AxisExtent = (i32, (f64, f64));

/// The axes of a panel.
fn axes(
    panel: &Panel,
    (x_power, x_range): AxisExtent,
    (y_power, y_range): AxisExtent,
    columns: usize,
) -> Layout {
    let mut layout = Layout::new(x_range, y_range)
        .with_title(printable(panel.title))
        .with_x_label(axis_label(panel.x_label, x_power))
        .with_y_label(axis_label(panel.y_label, y_power))
        .with_wrap(40 * columns)
        .with_y_label_wrap(32)
        .with_title_size(13)
        .with_label_size(12)
        .with_tick_size(11)
        .with_x_label_offset(0.0, -6.0)
        .with_box_axes()
        .with_tick_format(TickFormat::Custom(Arc::new(number)));
    layout.theme.grid_color = "#e8e8e8".to_owned();
    (layout.x_axis_min, layout.x_axis_max) = (Some(x_range.0), Some(x_range.1));
    (layout.y_axis_min, layout.y_axis_max) = (Some(y_range.0), Some(y_range.1));
    let exponents =
        || TickFormat::Custom(Arc::new(|exponent: f64| power_of_ten(exponent.round() as i32)));
    let decades = |range: (f64, f64)| Some(((range.1 - range.0) / 6.0).ceil());
    if panel.x_scale == Scale::Logarithmic {
        (layout.x_tick_step, layout.x_tick_format) = (decades(x_range), exponents());
    }
    if panel.y_scale == Scale::Logarithmic {
        (layout.y_tick_step, layout.y_tick_format) = (decades(y_range), exponents());
    }
    layout
}

/// The power of ten that makes the values readable, and their range in units of it (a constant is
/// in the middle of its range).
fn extent(values: &[f64], scale: Scale) -> AxisExtent {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if scale == Scale::Logarithmic {
        return (0, (low.floor(), high.ceil().max(low.floor() + 1.0)));
    }
    let size = low.abs().max(high.abs());
    let readable = size == 0.0 || (0.01..1e4).contains(&size);
    let power = if readable { 0.0 } else { size.log10().floor() };
    let power = power.clamp(-300.0, 300.0) as i32;
    let [low, high, size] = [low, high, size].map(|value| value / 10f64.powi(power));
    let constant = high - low <= 1e-9 * size;
    let around = if constant { size.max(1e-9) } else { 0.05 * (high - low) };
    (power, (low - around, high + around))
}

fn axis_label(label: &str, power: i32) -> String {
    let factor = power_of_ten(power);
    printable(&match label.rsplit_once(" (") {
        _ if power == 0 => label.to_owned(),
        Some((quantity, unit)) => format!("{quantity} ({factor} {unit}"),
        None => format!("{label} ({factor})"),
    })
}

/// A number with at most nine decimals, as short as possible.
fn number(value: f64) -> String {
    let rounded = (value * 1e9).round() / 1e9;
    rounded.to_string().replace('-', "−")
}

pub(in crate::export) fn power_of_ten(exponent: i32) -> String {
    let digits: Vec<char> = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().collect();
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// Thins points to at most [`MOST_POINTS`] and the last one: of each run the first, the lowest and
/// the highest are kept.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let by_height = |a: &usize, b: &usize| points[*a].1.total_cmp(&points[*b].1);
    let run = points.len().div_ceil(MOST_POINTS / 3);
    let starts = (0..points.len()).step_by(run);
    let runs = starts.map(|start| start..points.len().min(start + run));
    let kept = runs
        .flat_map(|run| [Some(run.start), run.clone().min_by(by_height), run.max_by(by_height)]);
    let kept: BTreeSet<usize> = kept.flatten().chain([points.len() - 1]).collect();
    kept.into_iter().map(|index| points[index]).collect()
}

/// Words without special characters: the library reads `$...$` as mathematics, and XML has no
/// control characters.
fn printable(text: &str) -> String {
    text.replace('$', "\\$")
        .replace(|c: char| c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}'), " ")
}

/// The scene and its caption as SVG, without the library's version, and with the clip regions,
/// which the library counts through the life of the process, numbered from 0.
pub(in crate::export) fn written(mut scene: Scene, caption: &str) -> String {
    // SVG collapses consecutive spaces.
    let mut lines = wrap_text(&printable(caption.trim()).replace("  ", " \u{a0}"), 106);
    lines.retain(|line| !line.is_empty());
    for content in lines {
        scene.height += 17.0;
        let (x, y) = (2.0 * MARGIN, scene.height - MARGIN);
        let (size, anchor) = (12, TextAnchor::Start);
        scene.add(Primitive::Text {
            x,
            y,
            content,
            size,
            anchor,
            rotate: None,
            bold: false,
            color: None,
        });
    }
    let clips = scene.elements.iter_mut().filter_map(|element| match element {
        Primitive::ClipStart { id, .. } => Some(id),
        _ => None,
    });
    for (number, id) in clips.enumerate() {
        let (old, new) = (format!("\"{id}\""), format!("clip-{number}"));
        for region in &mut scene.defs {
            *region = region.replace(&old, &format!("\"{new}\""));
        }
        *id = new;
    }
    let svg = SvgBackend::new().with_pretty(true).render_scene(&scene);
    // A mitred corner of a thick line would extend beyond its point: a graze would seem to go far
    // into the barrier. The caption is also the alternative text for readers who cannot see the
    // picture.
    let alternative = format!("  <title>{}</title>\n", escaped(&printable(caption.trim())));
    svg.replacen("<svg ", "<svg role=\"img\" stroke-linejoin=\"round\" ", 1).replacen(
        &format!("  <!-- Generated by kuva {} -->\n", kuva::VERSION),
        &alternative,
        1,
    )
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::{MOST_POINTS, thinned};

    const WAVE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 2.0), (2.0, -1.0), (3.0, 0.5)];

    fn one(
        y_scale: Scale,
        label: &str,
        points: &[(f64, f64)],
        guides: Vec<GuideLine>,
    ) -> Result<String, FigureError> {
        let curves = vec![curve(label, points, CurveStyle::FORMULA)];
        let panel = panel("T", ["x (s)", "y (rad)"], curves, guides);
        figure(&[Panel { y_scale, ..panel }], "<svg>")
    }

    /// The paths of a figure that are drawn in the style of the formula.
    fn path(svg: &str) -> Vec<&str> {
        let drawn = |line: &&str| line.contains("<path") && line.contains(CurveStyle::FORMULA.0);
        svg.lines().filter(drawn).collect()
    }

    fn impact() -> String {
        let samples: Vec<_> =
            (0..50).map(|i| f64::from(i) / 8.0).map(|t| (t, t.cos(), -t.sin())).collect();
        let motions = [("Runge-Kutta", CurveStyle::RUNGE_KUTTA), ("paper", CurveStyle::FORMULA)];
        let motion =
            |(label, style)| ImpactMotion { label, style, samples: &samples, contact: &WAVE };
        let (motions, right_barrier) = (&motions.map(motion), Some(0.3));
        impact_figure(&ImpactFigure {
            left_barrier: None,
            right_barrier,
            axes: ["displacement x (rad)", "time t (units of 1/ω)"],
            motions,
            caption: "End.",
        })
        .unwrap()
    }

    #[test]
    fn three_lettered_panels_share_one_legend_and_the_truth_lies_below() {
        let svg = impact();
        for words in
            ["A", "B", "C", "Contact, enlarged", "Runge-Kutta", "paper", "barrier x_c", "End."]
        {
            assert_eq!(svg.matches(&format!(">{words}</text>")).count(), 1, "{words}");
        }
        assert_eq!((svg.matches("<clipPath").count(), svg.matches("<path").count()), (3, 9));
        assert!(
            svg.find(CurveStyle::RUNGE_KUTTA.0).unwrap() < svg.find(CurveStyle::FORMULA.0).unwrap()
        );
    }

    #[test]
    fn the_same_numbers_give_the_same_bytes_and_no_version() {
        let first = impact();
        assert_eq!(first, impact());
        assert!(first.contains("url(#clip-2)") && !first.contains("kuva"));
    }

    #[test]
    fn an_error_is_that_at_its_amplitude_wherever_the_curves_begin() {
        let truth = [(1.0, 1.0), (2.0, 2.0), (3.0, 4.0), (4.0, 8.0)];
        let late = [(3.0, 2.0), (4.0, 8.0), (5.0, 9.0)];
        assert_eq!(errors_in_percent(&late, &truth), [(3.0, 50.0)]);
        assert_eq!(errors_in_percent(&truth, &late), [(3.0, 100.0)]);
    }

    #[test]
    fn words_stand_as_they_are() {
        let svg = one(Scale::Linear, "a < b & $x^2$ \u{1}", &WAVE, vec![]).unwrap();
        assert!(
            svg.contains(">a &lt; b &amp; $x^2$ ")
                && svg.contains(">&lt;svg&gt;<")
                && !svg.contains('\u{1}')
        );
    }

    #[test]
    fn a_power_of_ten_moves_from_the_numbers_to_the_label() {
        let draw = |factor: f64| {
            one(Scale::Linear, "", &WAVE.map(|(x, y)| (x, y * factor)), vec![]).unwrap()
        };
        assert_eq!((path(&draw(1.0)).len(), path(&draw(1e-7))), (1, path(&draw(1.0))));
        assert!(draw(1e-7).contains(">y (10⁻⁷ rad)<") && draw(1.0).contains(">y (rad)<"));
        assert!(!draw(1e-310).contains("NaN") && !draw(8e307).contains("inf"));
    }

    #[test]
    fn a_logarithmic_ordinate_reaches_small_errors_and_skips_zeros() {
        let errors = [(1.0, 0.0), (1.0, 1e-18), (2.0, 1e-14), (3.0, 1e-10)];
        let draw = |points| one(Scale::Logarithmic, "e", points, vec![]);
        let svg = draw(&errors).unwrap();
        assert!(svg.contains(">10⁻¹⁸<") && svg.contains(">10⁻¹²<"));
        assert_eq!(path(&svg), path(&draw(&errors[1..]).unwrap()));
        assert!(matches!(draw(&errors[..2]), Err(FigureError::TooFewPoints(_))));
        let refused = draw(&[(0.0, 1.0), (1.0, -0.5)]).unwrap_err().to_string();
        assert!(refused.starts_with("point (1.0, -0.5) of \"e\" in panel \"T\""), "{refused}");
    }

    #[test]
    fn a_logarithmic_abscissa_has_decades() {
        let points = [(1e4, 1.0), (1e6, 2.0), (1e9, 3.0)];
        let curves = vec![curve("", &points, CurveStyle::FORMULA)];
        let panel = panel("T", ["stiffness", "y"], curves, vec![GuideLine::X(1e5, "")]);
        let draw = |x_scale| figure(&[Panel { x_scale, ..panel.clone() }], "").unwrap();
        let svg = draw(Scale::Logarithmic);
        assert!(["10⁴", "10⁹"].iter().all(|tick| svg.contains(&format!(">{tick}<"))), "{svg}");
        assert_ne!(path(&svg), path(&draw(Scale::Linear)));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(figure(&[], ""), Err(FigureError::Empty(_))));
        assert!(matches!(figure(&[Panel::default()], ""), Err(FigureError::Empty(_))));
        assert!(matches!(
            one(Scale::Linear, "", &WAVE[..1], vec![]),
            Err(FigureError::TooFewPoints(_))
        ));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for points in [[WAVE[0], (bad, 0.0)], [(0.0, bad), WAVE[1]]] {
                assert!(matches!(
                    one(Scale::Linear, "", &points, vec![]),
                    Err(FigureError::OffAxes(_))
                ));
            }
            let guides = vec![GuideLine::X(bad, "g")];
            assert!(matches!(one(Scale::Linear, "", &WAVE, guides), Err(FigureError::OffAxes(_))));
        }
        let [formula, truth] = [1.0, 1.1].map(|end| vec![(0.0, 1.0, 0.0), (end, 0.5, 0.2)]);
        let draw = |formula, truth| {
            let [coordinate, displacement_unit, time_unit, formula_label, caption] =
                ["x", "rad", "s", "f", ""];
            motion_figure(&MotionFigure {
                coordinate,
                displacement_unit,
                time_unit,
                formula_label,
                formula,
                truth,
                envelopes: &[],
                caption,
            })
        };
        assert_eq!(draw(&formula, &truth), Err(FigureError::DifferentTimes(1)));
        assert!(draw(&truth, &truth).unwrap().contains(">formula − Runge-Kutta (rad)<"));
    }

    #[test]
    fn thinning_keeps_every_peak() {
        let mut points: Vec<_> =
            (0..100_000).map(f64::from).map(|x| (x, (x / 5e3).sin())).collect();
        points[77_777].1 = 9.0;
        let kept = thinned(&points);
        assert!(kept.len() <= MOST_POINTS + 1 && kept.contains(&points[77_777]));
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
    }
}
