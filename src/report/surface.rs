//! The angle map as a surface seen from above, as in the paper's Fig. 2: measured cells in full colour, what leans on an
//! interpolated point pale.

use kuva::render::color::Color;
use kuva::render::render::TextAnchor;

use super::angle_map::AngleMap;
use super::canvas::{Area, Canvas, GRID, INK, Style};
use super::colours::Colours;
use super::frame::{LABEL_SIZE, Labels, TICK_SIZE, draw_titles, with_unit};
use super::scale::Scale;
use super::spline::Filled;
use super::{Figure, ReportError};

const WIDTH: f64 = 760.0;
/// Half the side of the floor, and the height of the tallest value, on the sheet.
const HALF_SIDE: f64 = 230.0;
const HEIGHT: f64 = 250.0;
/// About so many numbers stand at the upright axis.
const HEIGHT_TICKS: usize = 6;
/// The floor is turned by this azimuth, so that the retro diagonal runs away from the reader and the mirror peaks stand
/// left and right, hiding nothing; and seen from this elevation. Degrees.
const AZIMUTH: f64 = 42.0;
const ELEVATION: f64 = 32.0;
/// How much white is mixed into what was not measured.
const PALE: f64 = 0.62;
/// The sides of the surface.
const SIDE: Color = Color::Rgb(0xd9, 0xd9, 0xd9);
const OUTLINE: Color = Color::Rgb(0x40, 0x40, 0x40);

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
    let view = View::new(map, scale, labels.height(WIDTH - 100.0));
    let mut canvas = Canvas::new(WIDTH, view.bottom() + 92.0);
    draw_titles(&mut canvas, WIDTH - 100.0, &labels);
    view.draw_floor(&mut canvas, map);
    view.draw_facets(&mut canvas, map);
    view.draw_sides(&mut canvas, map);
    view.draw_axes(&mut canvas, map);
    draw_legend(&mut canvas, view.bottom() + 72.0);
    let caption = format!(
        "{title}: {} as a surface over both signed in-plane angles. The retro direction was not measured; there the \
         surface is closed by natural cubic splines, drawn pale and never fitted.",
        map.label
    );
    Ok(Figure::new("surface", caption, canvas.finish()))
}

/// How angles and values become points on the sheet.
#[derive(Debug)]
struct View {
    theta_i: Scale,
    theta_v: Scale,
    height: Scale,
    centre: (f64, f64),
}

impl View {
    fn new(map: &AngleMap, height: Scale, top: f64) -> Self {
        let span = |angles: &[f64]| {
            let (from, to) = (angles[0], angles[angles.len() - 1]);
            if to > from { Scale::Linear { from, to } } else { Scale::Linear { from: from - 5.0, to: to + 5.0 } }
        };
        let (theta_i, theta_v) = (span(&map.theta_i_deg), span(&map.theta_v_deg));
        let mut view = Self { theta_i, theta_v, height, centre: (WIDTH / 2.0 + 18.0, 0.0) };
        view.centre.1 = top - view.highest(map);
        view
    }

    /// The highest line of the drawing: that of a measured value or of the upright axis.
    fn highest(&self, map: &AngleMap) -> f64 {
        let axis = self.point(ends(&self.theta_i)[0], ends(&self.theta_v)[0], 1.0).0.1;
        let measured = map.values.indexed_iter().filter(|(_, value)| value.is_finite());
        let line = |((i, v), value): ((usize, usize), &f64)| {
            self.point(map.theta_i_deg[i], map.theta_v_deg[v], self.height.position(*value)).0.1
        };
        measured.map(line).fold(axis, f64::min)
    }

    /// The lowest line of the drawing with its tick labels.
    fn bottom(&self) -> f64 {
        self.centre.1 + HALF_SIDE * reach() * ELEVATION.to_radians().sin() + 30.0
    }

    /// The point on the sheet, and its distance from the reader.
    fn point(&self, theta_i: f64, theta_v: f64, up: f64) -> ((f64, f64), f64) {
        let (x, y) = (2.0 * self.theta_i.position(theta_i) - 1.0, 2.0 * self.theta_v.position(theta_v) - 1.0);
        let (sin, cos) = AZIMUTH.to_radians().sin_cos();
        let (across, away) = (x * cos + y * sin, y * cos - x * sin);
        let rise = HALF_SIDE * away * ELEVATION.to_radians().sin() + HEIGHT * up;
        ((self.centre.0 + HALF_SIDE * across, self.centre.1 - rise), away)
    }

    fn draw_floor(&self, canvas: &mut Canvas, map: &AngleMap) {
        let (ends_i, ends_v) = (ends(&self.theta_i), ends(&self.theta_v));
        for tick in self.theta_i.ticks_among(&map.theta_i_deg, 9) {
            let line = ends_v.map(|v| self.point(tick.value, v, 0.0).0);
            canvas.line(line[0], line[1], GRID, 1.0);
        }
        for tick in self.theta_v.ticks_among(&map.theta_v_deg, 9) {
            let line = ends_i.map(|i| self.point(i, tick.value, 0.0).0);
            canvas.line(line[0], line[1], GRID, 1.0);
        }
    }

    /// Facets between four neighbouring points, the farthest first.
    fn draw_facets(&self, canvas: &mut Canvas, map: &AngleMap) {
        let filled = Filled::of(map);
        let colours = Colours::Values(self.height);
        let mut facets: Vec<Facet> = Vec::new();
        for i in 1..map.theta_i_deg.len() {
            for v in 1..map.theta_v_deg.len() {
                facets.extend(self.facet(map, &filled, (i, v)));
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
    fn draw_sides(&self, canvas: &mut Canvas, map: &AngleMap) {
        let last = map.theta_i_deg.len() - 1;
        let left = (1..=last).map(|i| [(i - 1, 0), (i, 0)]);
        let right = (1..map.theta_v_deg.len()).map(|v| [(last, v - 1), (last, v)]);
        for edge in left.chain(right).filter(|edge| edge.iter().all(|cell| map.values[*cell].is_finite())) {
            let corner = |(i, v): (usize, usize), up: f64| self.point(map.theta_i_deg[i], map.theta_v_deg[v], up).0;
            let [from, to] = edge;
            let up = |cell: (usize, usize)| self.height.position(map.values[cell]);
            let corners = [corner(from, 0.0), corner(to, 0.0), corner(to, up(to)), corner(from, up(from))];
            canvas.facet(&corners, SIDE, OUTLINE);
        }
    }

    /// The facet whose far corner is that cell; none where a corner has neither value nor interpolation.
    fn facet(&self, map: &AngleMap, filled: &Filled, (i, v): (usize, usize)) -> Option<Facet> {
        let mut facet = Facet { corners: Vec::new(), away: 0.0, value: 0.0, is_measured: true };
        for (i, v) in [(i - 1, v - 1), (i, v - 1), (i, v), (i - 1, v)] {
            let measured = Some(map.values[(i, v)]).filter(|value| value.is_finite());
            facet.is_measured &= measured.is_some();
            let value = measured.or_else(|| filled.at(i, v))?;
            let up = self.height.position(value);
            // The logarithm of an interpolated value below zero is no place.
            let ((x, y), away) = self.point(map.theta_i_deg[i], map.theta_v_deg[v], up);
            (x.is_finite() && y.is_finite()).then(|| facet.corners.push((x, y)))?;
            facet.away += away / 4.0;
            facet.value += self.height.value(up) / 4.0;
        }
        Some(facet)
    }

    fn draw_axes(&self, canvas: &mut Canvas, map: &AngleMap) {
        let ([i_from, i_to], [v_from, v_to]) = (ends(&self.theta_i), ends(&self.theta_v));
        let corner = |i: f64, v: f64, up: f64| self.point(i, v, up).0;
        let (left, front, right) = (corner(i_from, v_from, 0.0), corner(i_to, v_from, 0.0), corner(i_to, v_to, 0.0));
        canvas.line(left, front, INK, 1.2);
        canvas.line(front, right, INK, 1.2);
        canvas.line(left, corner(i_from, v_from, 1.0), INK, 1.2);
        for tick in self.theta_i.ticks_among(&map.theta_i_deg, 9) {
            let (x, y) = corner(tick.value, v_from, 0.0);
            canvas.text((x - 6.0, y + 18.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::End));
        }
        for tick in self.theta_v.ticks_among(&map.theta_v_deg, 9) {
            let (x, y) = corner(i_to, tick.value, 0.0);
            canvas.text((x + 6.0, y + 18.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::Start));
        }
        for tick in self.height.ticks(HEIGHT_TICKS) {
            let (x, y) = corner(i_from, v_from, self.height.position(tick.value));
            canvas.line((x - 5.0, y), (x, y), INK, 1.0);
            canvas.text((x - 9.0, y + 4.5), &tick.label, Style::new(TICK_SIZE, TextAnchor::End));
        }
        let bottom = self.bottom();
        canvas.text((24.0, bottom - 2.0), "incidence θᵢ (degrees) ↘", Style::new(LABEL_SIZE, TextAnchor::Start));
        canvas.text((WIDTH - 24.0, bottom - 2.0), "↗ viewing θᵥ (degrees)", Style::new(LABEL_SIZE, TextAnchor::End));
        let kind = if self.height.is_logarithmic() { ", logarithmic" } else { "" };
        let text = format!("↑ height and colour: {}{kind}", with_unit(&map.label, &map.unit));
        canvas.text((24.0, bottom + 34.0), &text, Style::new(LABEL_SIZE, TextAnchor::Start));
    }
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

/// How far the corners of the floor reach from its centre, in half sides.
fn reach() -> f64 {
    let (sin, cos) = AZIMUTH.to_radians().sin_cos();
    sin + cos
}

fn ends(scale: &Scale) -> [f64; 2] {
    [scale.value(0.0), scale.value(1.0)]
}

fn pale(colour: Color) -> Color {
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
