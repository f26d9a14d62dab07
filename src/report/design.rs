//! A designed scan: how the uncertainties fall with each geometry added, and where the geometries lie.

use kuva::render::color::Color;
use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, FITTED, HATCH, INK, LINES, Style};
use super::curve::SHEET_WIDTH;
use super::frame::{Frame, Labels, TICK_SIZE};
use super::scale::{Scale, extent};
use super::{Figure, ReportError};
use crate::quantity::Geometry;

const LEFT: f64 = 84.0;
const WIDTH: f64 = 612.0;
const CURVES: f64 = 240.0;
const PLANE: f64 = 440.0;
/// Numbers in their dots.
const PAPER: Color = Color::Rgb(0xff, 0xff, 0xff);
/// More numbers than this say nothing.
const NUMBERED: usize = 30;

/// What the figure of a design shows.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignPicture {
    /// What was designed, and for which material.
    pub title: String,
    /// Noise, reference and criterion.
    pub subtitle: String,
    /// Each parameter's name with its relative standard uncertainty after 0, 1, 2, ... geometries were added; NaN where it
    /// is not determined.
    pub uncertainties: Vec<(String, Vec<f64>)>,
    /// Geometries that are planned.
    pub planned: Vec<Geometry>,
    /// Geometries that were added, in their order.
    pub added: Vec<Geometry>,
}

/// Draws both.
///
/// # Errors
/// [`ReportError::Empty`] without any geometry.
pub fn design_figure(picture: &DesignPicture) -> Result<Figure, ReportError> {
    let empty = || ReportError::Empty { figure: "design".to_owned() };
    let percent = "relative standard uncertainty predicted (%)";
    let labels = Labels { title: &picture.title, subtitle: &picture.subtitle, x: "geometries added", y: percent };
    let curves = Area::new(LEFT, labels.height(WIDTH), WIDTH, CURVES);
    let plane = Area::new(LEFT, curves.bottom() + 150.0, PLANE, PLANE);
    let mut canvas = Canvas::new(SHEET_WIDTH, plane.bottom() + 70.0);
    draw_curves(&mut canvas, curves, picture, &labels);
    draw_plane(&mut canvas, plane, picture).ok_or_else(empty)?;
    let caption = "Above: standard uncertainty of each parameter over its value (of the index: over n - 1), as the Cramer-Rao \
                   bound predicts it. Below: planned geometries and those added, numbered as they help; a viewing angle beyond \
                   90 degrees of azimuth from the mirror side is negative."
        .to_owned();
    Ok(Figure::new("design", caption, canvas.finish()))
}

/// The curves; where nothing is determined there is a frame without one.
fn draw_curves(canvas: &mut Canvas, area: Area, picture: &DesignPicture, labels: &Labels<'_>) {
    let in_percent = |value: f64| if value > 0.0 { 100.0 * value } else { f64::NAN };
    let all = picture.uncertainties.iter().flat_map(|(_, values)| values.iter().map(|value| in_percent(*value)));
    // Beyond 100 % nothing is known, and a curve from there would hide the others.
    let (low, high) = extent(all.filter(|value| *value <= 100.0)).unwrap_or((1.0, 100.0));
    let y = Scale::Logarithmic { from: low / 1.3, to: high.max(low * 2.0) * 1.3 };
    let frame = Frame::new(area, Scale::Linear { from: 0.0, to: picture.added.len().max(1) as f64 }, y);
    frame.draw_grid(canvas);
    for (k, (name, values)) in picture.uncertainties.iter().enumerate() {
        let colour = || LINES[k % LINES.len()].clone();
        let is_drawn = |value: f64| (low / 1.3..=high * 1.3).contains(&value);
        let points = values.iter().enumerate().map(|(count, value)| (count, in_percent(*value)));
        let points: Vec<(f64, f64)> = points
            .filter(|(_, value)| is_drawn(*value))
            .map(|(count, value)| frame.point(count as f64, value))
            .collect();
        points.iter().for_each(|point| canvas.dot(*point, 2.6, colour()));
        canvas.polyline(points, colour(), 1.8);
        let place = (area.left + (k % 3) as f64 * 215.0, area.bottom() + 74.0 + 20.0 * (k / 3) as f64);
        canvas.line((place.0, place.1 - 4.5), (place.0 + 20.0, place.1 - 4.5), colour(), 2.4);
        canvas.text((place.0 + 26.0, place.1), name, Style::new(TICK_SIZE, TextAnchor::Start));
    }
    frame.draw_axes(canvas, labels);
}

fn draw_plane(canvas: &mut Canvas, area: Area, picture: &DesignPicture) -> Option<()> {
    let place = |geometry: &Geometry| geometry.signed_deg().unwrap_or_else(|| off_plane(geometry));
    let all: Vec<(f64, f64)> = picture.planned.iter().chain(&picture.added).map(place).collect();
    let (x_from, x_to) = extent(all.iter().map(|place| place.0))?;
    let (y_from, y_to) = extent(all.iter().map(|place| place.1))?;
    let scale = |from: f64, to: f64| Scale::Linear { from: from - 7.0, to: to + 7.0 };
    let frame = Frame::new(area, scale(x_from, x_to), scale(y_from, y_to));
    frame.draw_grid(canvas);
    for geometry in &picture.planned {
        let (i, v) = place(geometry);
        canvas.dot(frame.point(i, v), 2.6, HATCH);
    }
    for (k, geometry) in picture.added.iter().enumerate() {
        let (i, v) = place(geometry);
        let (x, y) = frame.point(i, v);
        canvas.dot((x, y), 6.0, FITTED);
        if k < NUMBERED {
            let inside = Style { colour: PAPER, ..Style::new(8, TextAnchor::Middle).bold() };
            canvas.text((x, y + 2.9), &(k + 1).to_string(), inside);
        }
    }
    let labels = Labels { title: "", subtitle: "", x: "theta_i (degrees)", y: "theta_v (degrees), mirror at theta_i" };
    frame.draw_axes(canvas, &labels);
    for (line, (colour, text)) in [(HATCH, "planned"), (FITTED, "added")].into_iter().enumerate() {
        let at = (area.right() + 24.0, area.top + 14.0 + 24.0 * line as f64);
        canvas.dot((at.0, at.1 - 4.5), 5.0, colour);
        canvas.text((at.0 + 12.0, at.1), text, Style { colour: INK, ..Style::new(TICK_SIZE, TextAnchor::Start) });
    }
    Some(())
}

/// Polar angles of a geometry out of the plane, the viewing negative on the side of the source.
fn off_plane(geometry: &Geometry) -> (f64, f64) {
    let difference = (geometry.viewing.phi_deg() - geometry.incidence.phi_deg()).to_radians();
    let side = if difference.cos() > 0.0 { -1.0 } else { 1.0 };
    (geometry.incidence.theta_deg(), side * geometry.viewing.theta_deg())
}
