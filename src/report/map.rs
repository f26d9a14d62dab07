//! A heat map over both signed in-plane angles, with its gaps shown as gaps (the paper's Fig. 2).

use kuva::render::render::TextAnchor;

use super::angle_map::AngleMap;
use super::canvas::{Area, Canvas, INK, Style};
use super::colour_bar::{BAR_HEIGHT, draw_colour_bar};
use super::colours::Colours;
use super::frame::{Frame, Labels, TICK_SIZE, with_unit};
use super::scale::Scale;
use super::spline::Filled;
use super::{Figure, ReportError};

/// Width of the sheet, left edge and size of the square of cells, and what lies below it.
const WIDTH: f64 = 660.0;
const LEFT: f64 = 72.0;
const SIDE: f64 = 560.0;
const BELOW: f64 = 184.0;

/// What a map is called and how it is coloured.
#[derive(Debug, Clone)]
pub(super) struct MapText<'a> {
    pub(super) name: &'a str,
    pub(super) title: &'a str,
    pub(super) subtitle: &'a str,
    pub(super) caption: String,
}

/// Values over both angles; a gap is hatched and named, never filled. The colour scale is logarithmic where a mirror
/// peak would hide everything else.
///
/// # Errors
/// [`ReportError`] when there is nothing finite to draw.
pub fn angle_map(map: &AngleMap, title: &str) -> Result<Figure, ReportError> {
    map.check()?;
    let colours = value_colours(map)?;
    let (retro, other) = map.gaps();
    let subtitle = format!("{} measured cells; gaps are left empty", map.values.len() - retro - other);
    let caption = format!(
        "{}: {} over both signed in-plane angles, one cell per geometry. Hatched: the retro direction, where the \
         detector would stand before the source. Nothing is interpolated.",
        title, map.label
    );
    let text = MapText { name: "map", title, subtitle: &subtitle, caption };
    Ok(draw(map, None, colours, &text))
}

/// The same with the gaps filled by a spline through the measured cells, each filled cell marked: drawn, never fitted.
///
/// # Errors
/// [`ReportError`] when there is nothing finite to draw.
pub fn interpolated_map(map: &AngleMap, title: &str) -> Result<Figure, ReportError> {
    map.check()?;
    let filled = Filled::of(map);
    let subtitle = format!("interpolated, drawn and never fitted: {} cells, each marked with a dot", filled.count());
    let caption = format!(
        "{title}: the same map, its gaps filled by natural cubic splines along both angles for the eye alone. Marked \
         cells were not measured and entered no fit; cells at the ends of the scan have no neighbours on both sides and \
         stay empty."
    );
    let text = MapText { name: "map-interpolated", title, subtitle: &subtitle, caption };
    let colours = value_colours(map)?;
    Ok(draw(map, Some(&filled), colours, &text))
}

/// Values around zero over both angles, as residuals are.
///
/// # Errors
/// [`ReportError`] when there is nothing finite to draw.
pub fn residual_map(map: &AngleMap, title: &str) -> Result<Figure, ReportError> {
    map.check()?;
    let magnitude = map.finite().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let colours = Colours::AroundZero(if magnitude > 0.0 { magnitude } else { 1.0 });
    let caption =
        format!("{title}: {} over both angles. A model that describes the data leaves no pattern here.", map.label);
    let text = MapText { name: "residual-map", title, subtitle: "blue: measured below the model; red: above", caption };
    Ok(draw(map, None, colours, &text))
}

/// The leverage of each geometry on a fit.
///
/// # Errors
/// [`ReportError`] when there is nothing finite to draw.
pub(super) fn leverage_map(map: &AngleMap, title: &str) -> Result<Figure, ReportError> {
    map.check()?;
    let caption = format!(
        "{title}: what the prediction at a geometry moves by when its value moves by one. Where it is near 1, the fit meets the          value whatever it is, and its residual says nothing."
    );
    let subtitle = "the leverages of all values add up to the number of parameters";
    Ok(draw(map, None, value_colours(map)?, &MapText { name: "leverage-map", title, subtitle, caption }))
}

fn value_colours(map: &AngleMap) -> Result<Colours, ReportError> {
    let values: Vec<f64> = map.finite().collect();
    let scale = Scale::for_colours(&values).ok_or_else(|| ReportError::Empty { figure: map.label.clone() })?;
    Ok(Colours::Values(scale))
}

fn draw(map: &AngleMap, filled: Option<&Filled>, colours: Colours, text: &MapText<'_>) -> Figure {
    let labels = Labels {
        title: text.title,
        subtitle: text.subtitle,
        x: "incidence angle θᵢ (degrees, signed)",
        y: "viewing angle θᵥ (degrees, signed; mirror direction at θᵥ = θᵢ)",
    };
    let area = Area::new(LEFT, labels.height(SIDE), SIDE, SIDE);
    let mut canvas = Canvas::new(WIDTH, area.bottom() + BELOW);
    let (x_edges, y_edges) = (edges(&map.theta_i_deg), edges(&map.theta_v_deg));
    let frame = Frame::over_angles(area, (ends(&x_edges), &map.theta_i_deg), (ends(&y_edges), &map.theta_v_deg));
    let mut seen = Seen::default();
    for ((i, v), &value) in map.values.indexed_iter() {
        let (left, bottom) = frame.point(x_edges[i], y_edges[v]);
        let (right, top) = frame.point(x_edges[i + 1], y_edges[v + 1]);
        let cell = Area::new(left, top, right - left, bottom - top);
        let guess = filled.and_then(|filled| filled.at(i, v));
        match (value.is_finite(), guess) {
            (true, _) => canvas.rectangle(overlapping(cell), colours.colour(value)),
            (false, Some(guess)) => seen.interpolated |= draw_interpolated(&mut canvas, cell, guess, colours),
            (false, None) if map.is_retro(i, v) => seen.retro |= draw_retro(&mut canvas, cell),
            (false, None) => seen.missing |= draw_missing(&mut canvas, cell),
        }
    }
    frame.draw_axes(&mut canvas, &labels);
    let bar = Area::new(area.left, area.bottom() + 74.0, area.width, BAR_HEIGHT);
    draw_colour_bar(&mut canvas, bar, colours, &with_unit(&map.label, &map.unit));
    draw_legend(&mut canvas, area, seen);
    Figure::new(text.name, text.caption.clone(), canvas.finish())
}

/// Which kinds of gap were drawn and so need an entry in the legend.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    retro: bool,
    missing: bool,
    interpolated: bool,
}

fn draw_retro(canvas: &mut Canvas, cell: Area) -> bool {
    canvas.hatch(cell, 6.0);
    true
}

fn draw_missing(canvas: &mut Canvas, cell: Area) -> bool {
    canvas.cross(cell);
    true
}

fn draw_interpolated(canvas: &mut Canvas, cell: Area, value: f64, colours: Colours) -> bool {
    canvas.rectangle(overlapping(cell), colours.colour(value));
    draw_mark(canvas, cell);
    true
}

pub(super) fn draw_mark(canvas: &mut Canvas, cell: Area) {
    let radius = (cell.width.min(cell.height) / 6.0).min(5.0);
    canvas.dot(cell.centre(), radius + 1.0, kuva::render::color::Color::Rgb(255, 255, 255));
    canvas.dot(cell.centre(), radius, INK);
}

/// A little larger than the cell, so that no light line shows between neighbours.
pub(super) fn overlapping(cell: Area) -> Area {
    Area::new(cell.left, cell.top, cell.width + 0.4, cell.height + 0.4)
}

fn draw_legend(canvas: &mut Canvas, above: Area, seen: Seen) {
    let y = above.bottom() + 154.0;
    let mut left = above.left;
    let mut entry = |canvas: &mut Canvas, text: &str, width: f64, draw: &dyn Fn(&mut Canvas, Area)| {
        let swatch = Area::new(left, y, 24.0, 18.0);
        draw(canvas, swatch);
        canvas.outline(swatch, INK, 0.8);
        canvas.text((left + 32.0, y + 14.0), text, Style::new(TICK_SIZE, TextAnchor::Start));
        left += width;
    };
    if seen.retro {
        entry(canvas, "gap: retro direction, not measured by design", 355.0, &|canvas, area| canvas.hatch(area, 6.0));
    }
    if seen.missing {
        entry(canvas, "gap: no usable value", 190.0, &|canvas, area| canvas.cross(area));
    }
    if seen.interpolated {
        entry(canvas, "interpolated", 150.0, &draw_mark);
    }
}

/// The edges between cells: halfway between neighbours, and as far beyond the first and last as to their neighbours.
pub(super) fn edges(centres: &[f64]) -> Vec<f64> {
    let half = |from: usize| (centres[from + 1] - centres[from]) / 2.0;
    let count = centres.len();
    if count < 2 {
        return centres.iter().flat_map(|centre| [centre - 5.0, centre + 5.0]).collect();
    }
    let inner = (0..count - 1).map(|at| centres[at] + half(at));
    std::iter::once(centres[0] - half(0))
        .chain(inner)
        .chain(std::iter::once(centres[count - 1] + half(count - 2)))
        .collect()
}

pub(super) fn ends(edges: &[f64]) -> Scale {
    Scale::Linear { from: edges[0], to: edges[edges.len() - 1] }
}
