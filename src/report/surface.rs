//! The angle map as a surface seen from above, as in the paper's Fig. 2: measured cells in full colour, what leans on an
//! interpolated point pale.

use kuva::render::color::Color;
use kuva::render::render::TextAnchor;

use super::angle_map::AngleMap;
use super::canvas::{Area, Canvas, INK, Style};
use super::colours::Colours;
use super::frame::{Labels, TICK_SIZE, draw_titles, with_unit};
use super::perspective::{Axes, HEIGHT_TICKS, Perspective, WIDTH};
use super::scale::Scale;
use super::spline::Filled;
use super::{Figure, ReportError};

/// How much white is mixed into what was not measured.
const PALE: f64 = 0.62;
/// The sides of the surface.
pub(super) const SIDE: Color = Color::Rgb(0xd9, 0xd9, 0xd9);
pub(super) const OUTLINE: Color = Color::Rgb(0x40, 0x40, 0x40);

/// The measured values as a surface over both angles. Where a gap lies between measured values a spline closes it for
/// the eye: drawn pale, labelled, and never fitted; at the ends of the scan the surface stays open.
///
/// # Errors
/// [`ReportError`] when there is nothing finite to draw.
pub fn surface(map: &AngleMap, title: &str) -> Result<Figure, ReportError> {
    map.check()?;
    let values: Vec<f64> = map.finite().collect();
    let scale = Scale::for_colours(&values)
        .ok_or_else(|| ReportError::Empty { figure: map.label.clone() })?
        .ending_on_tick(HEIGHT_TICKS);
    let subtitle = "pale: leans on interpolated points, drawn and never fitted";
    let labels = Labels { title, subtitle, x: "", y: "" };
    let view = placed(map, scale, labels.height(WIDTH - 100.0));
    let quantity = with_unit(&map.label, &map.unit);
    let axes = Axes {
        x: (view.x.ticks_among(&map.theta_i_deg, 9), "incidence θᵢ (degrees)"),
        y: (view.y.ticks_among(&map.theta_v_deg, 9), "viewing θᵥ (degrees)"),
        height: &quantity,
    };
    let mut canvas = Canvas::new(WIDTH, view.bottom() + 92.0);
    draw_titles(&mut canvas, WIDTH - 100.0, &labels);
    view.draw_floor(&mut canvas, &axes);
    draw_facets(&mut canvas, &view, map);
    draw_sides(&mut canvas, &view, map);
    view.draw_axes(&mut canvas, &axes);
    draw_legend(&mut canvas, view.bottom() + 72.0);
    let caption = format!(
        "{title}: {} as a surface over both signed in-plane angles. The retro direction was not measured; there the \
         surface is closed by natural cubic splines, drawn pale and never fitted.",
        map.label
    );
    Ok(Figure::new("surface", caption, canvas.finish()))
}

/// Where the surface of a map stands on the sheet.
fn placed(map: &AngleMap, height: Scale, top: f64) -> Perspective {
    let span = |angles: &[f64]| {
        let (from, to) = (angles[0], angles[angles.len() - 1]);
        if to > from { Scale::Linear { from, to } } else { Scale::Linear { from: from - 5.0, to: to + 5.0 } }
    };
    let measured = map.values.indexed_iter().filter(|(_, value)| value.is_finite());
    let points = measured.map(|((i, v), value)| (map.theta_i_deg[i], map.theta_v_deg[v], height.position(*value)));
    Perspective::new((span(&map.theta_i_deg), span(&map.theta_v_deg), height), top, points)
}

/// Facets between four neighbouring points, the farthest first.
fn draw_facets(canvas: &mut Canvas, view: &Perspective, map: &AngleMap) {
    let filled = Filled::of(map);
    let colours = Colours::Values(view.height);
    let mut facets: Vec<Facet> = Vec::new();
    for i in 1..map.theta_i_deg.len() {
        for v in 1..map.theta_v_deg.len() {
            facets.extend(facet(view, map, &filled, (i, v)));
        }
    }
    facets.sort_by(|a, b| b.away.total_cmp(&a.away));
    for facet in facets {
        let colour = colours.colour(facet.value);
        let fill = if facet.is_measured { colour } else { pale(colour) };
        canvas.facet(&facet.corners, fill, OUTLINE);
    }
}

/// The two sides that face the reader, down to the floor. The facets of a peak at a corner may be seen edge-on and
/// so hardly at all; the sides show it. Nothing stands before them, so they are drawn last.
fn draw_sides(canvas: &mut Canvas, view: &Perspective, map: &AngleMap) {
    let last = map.theta_i_deg.len() - 1;
    let left = (1..=last).map(|i| [(i - 1, 0), (i, 0)]);
    let right = (1..map.theta_v_deg.len()).map(|v| [(last, v - 1), (last, v)]);
    for edge in left.chain(right).filter(|edge| edge.iter().all(|cell| map.values[*cell].is_finite())) {
        let corner = |(i, v): (usize, usize), up: f64| view.point(map.theta_i_deg[i], map.theta_v_deg[v], up).0;
        let [from, to] = edge;
        let up = |cell: (usize, usize)| view.height.position(map.values[cell]);
        let corners = [corner(from, 0.0), corner(to, 0.0), corner(to, up(to)), corner(from, up(from))];
        canvas.facet(&corners, SIDE, OUTLINE);
    }
}

/// The facet whose far corner is that cell; none where a corner has neither value nor interpolation.
fn facet(view: &Perspective, map: &AngleMap, filled: &Filled, (i, v): (usize, usize)) -> Option<Facet> {
    let mut facet = Facet { corners: Vec::new(), away: 0.0, value: 0.0, is_measured: true };
    for (i, v) in [(i - 1, v - 1), (i, v - 1), (i, v), (i - 1, v)] {
        let measured = Some(map.values[(i, v)]).filter(|value| value.is_finite());
        facet.is_measured &= measured.is_some();
        let value = measured.or_else(|| filled.at(i, v))?;
        let up = view.height.position(value);
        // The logarithm of an interpolated value below zero is no place.
        let ((x, y), away) = view.point(map.theta_i_deg[i], map.theta_v_deg[v], up);
        (x.is_finite() && y.is_finite()).then(|| facet.corners.push((x, y)))?;
        facet.away += away / 4.0;
        facet.value += view.height.value(up) / 4.0;
    }
    Some(facet)
}

/// Four corners on the sheet.
#[derive(Debug)]
struct Facet {
    corners: Vec<(f64, f64)>,
    /// Mean distance from the reader.
    away: f64,
    /// Mean of the values at the corners.
    value: f64,
    is_measured: bool,
}

pub(super) fn pale(colour: Color) -> Color {
    let mix = |part: u8| (f64::from(part) * (1.0 - PALE) + 255.0 * PALE).round() as u8;
    match colour {
        Color::Rgb(r, g, b) => Color::Rgb(mix(r), mix(g), mix(b)),
        other => other,
    }
}

fn draw_legend(canvas: &mut Canvas, y: f64) {
    let measured = Color::Rgb(0x21, 0x91, 0x8c);
    for (left, colour, text) in [
        (24.0, measured.clone(), "between measured points"),
        (270.0, pale(measured), "leans on interpolated points"),
        (536.0, SIDE, "side, down to the floor"),
    ] {
        let swatch = Area::new(left, y - 13.0, 24.0, 18.0);
        canvas.rectangle(swatch, colour);
        canvas.outline(swatch, INK, 0.8);
        canvas.text((left + 32.0, y + 1.0), text, Style::new(TICK_SIZE, TextAnchor::Start));
    }
}
