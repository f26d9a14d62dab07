//! Points with error bars and curves over one axis: the averages of the paper's Figs 3 and 4, and spectra. Where a number
//! is missing the line ends and begins anew: a gap is drawn as a gap.

use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, FITTED, MEASURED, Style, clipped};
use super::frame::{Frame, Labels, TICK_SIZE};
use super::scale::{Scale, extent};
use super::{Figure, ReportError};

/// Width of the sheet, and the left edge and size of the plotting area on it.
pub(super) const SHEET_WIDTH: f64 = 720.0;
const LEFT: f64 = 84.0;
const WIDTH: f64 = 612.0;
const HEIGHT: f64 = 320.0;
/// Room for ticks, label and legend below the plotting area.
pub(super) const BELOW: f64 = 96.0;
/// Error bars may reach this share of the range of the numbers beyond them; longer ones are cut at the frame.
const BAR_SHARE: f64 = 0.15;
/// Radius of a single value between two gaps of a spectrum.
const SINGLE: f64 = 3.2;
/// Height of a line of the legend.
const LEGEND_LINE: f64 = 22.0;

/// Measured points: one number per abscissa, with the half length of its error bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Abscissae.
    pub x: Vec<f64>,
    /// Ordinates; what is not finite is a gap.
    pub y: Vec<f64>,
    /// Half lengths of the error bars, or bands; empty for none.
    pub error: Vec<f64>,
    /// What a point is, for the legend.
    pub name: String,
    /// What the error bar is, for the legend.
    pub error_name: String,
}

/// A curve drawn over the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Abscissae, ascending.
    pub x: Vec<f64>,
    /// Ordinates.
    pub y: Vec<f64>,
    /// What it is, for the legend.
    pub name: String,
}

/// The texts of a figure of curves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CurveText {
    /// Name of the figure, fit for a file.
    pub name: String,
    /// What is drawn, and of what.
    pub title: String,
    /// What else the reader must know.
    pub subtitle: String,
    /// Quantity and unit of the abscissa.
    pub x: String,
    /// Quantity and unit of the ordinate.
    pub y: String,
    /// A sentence about the figure.
    pub caption: String,
}

impl CurveText {
    pub(super) fn labels(&self) -> Labels<'_> {
        Labels { title: &self.title, subtitle: &self.subtitle, x: &self.x, y: &self.y }
    }

    pub(super) fn area(&self) -> Area {
        Area::new(LEFT, self.labels().height(WIDTH), WIDTH, HEIGHT)
    }
}

/// How measured numbers are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// Dots with error bars.
    Dots,
    /// A line in a band, as for a spectrum.
    Band,
}

/// Dots with error bars, and a curve where there is one.
///
/// # Errors
/// [`ReportError`] when lists differ in length or nothing is finite.
pub fn dots_and_curve(points: &Points, curve: Option<&Curve>, text: &CurveText) -> Result<Figure, ReportError> {
    draw(points, curve, text, Form::Dots)
}

/// A line in a band of its errors, as for a spectrum, and a second line where there is one.
///
/// # Errors
/// [`ReportError`] when lists differ in length or nothing is finite.
pub fn line_in_band(points: &Points, curve: Option<&Curve>, text: &CurveText) -> Result<Figure, ReportError> {
    draw(points, curve, text, Form::Band)
}

fn draw(points: &Points, curve: Option<&Curve>, text: &CurveText, form: Form) -> Result<Figure, ReportError> {
    check(points, curve, &text.name)?;
    let area = text.area();
    let frame = frame_around(area, points, curve).ok_or_else(|| ReportError::Empty { figure: text.name.clone() })?;
    let is_cut = form == Form::Dots && is_any_bar_cut(&frame, points);
    let more = if is_cut { LEGEND_LINE } else { 0.0 };
    let mut canvas = Canvas::new(SHEET_WIDTH, area.bottom() + BELOW + more);
    frame.draw_grid(&mut canvas);
    match form {
        Form::Dots => draw_dots(&mut canvas, &frame, points, curve),
        Form::Band => draw_band(&mut canvas, &frame, points, curve),
    }
    frame.draw_axes(&mut canvas, &text.labels());
    draw_legend(&mut canvas, area, points, curve, form);
    if is_cut {
        draw_cut_legend(&mut canvas, area);
    }
    Ok(Figure::new(&text.name, text.caption.clone(), canvas.finish()))
}

fn check(points: &Points, curve: Option<&Curve>, figure: &str) -> Result<(), ReportError> {
    let same = |what: &'static str, found: usize, expected: usize| {
        if found == expected {
            Ok(())
        } else {
            Err(ReportError::Lengths { figure: figure.to_owned(), what, found, expected })
        }
    };
    same("y", points.y.len(), points.x.len())?;
    if !points.error.is_empty() {
        same("error", points.error.len(), points.x.len())?;
    }
    curve.map_or(Ok(()), |curve| same("curve.y", curve.y.len(), curve.x.len()))
}

/// Scales that hold every finite number, zero where it is near, and of the error bars what does not dwarf the numbers.
fn frame_around(area: Area, points: &Points, curve: Option<&Curve>) -> Option<Frame> {
    let drawn = finite_points(points);
    let curve_xy = || curve.into_iter().flat_map(|curve| curve.x.iter().copied().zip(curve.y.iter().copied()));
    let x = Scale::linear_over(drawn.iter().map(|point| point.0).chain(curve_xy().map(|point| point.0)))?;
    extent(drawn.iter().map(|point| point.1))?;
    let (low, high) = extent(drawn.iter().map(|point| point.1).chain(curve_xy().map(|point| point.1)))?;
    let (bar_low, bar_high) = extent(drawn.iter().flat_map(|(_, y, error)| [y - error, y + error]))?;
    let typical = typical_error(&drawn);
    let room = BAR_SHARE * (high - low) + 3.0 * typical;
    let (low, high) = (low.min(bar_low.max(low - room)), high.max(bar_high.min(high + room)));
    let y = Scale::linear_over([low, high])?;
    let y = if low > 0.0 && low < 0.6 * high { y.including(0.0) } else { y };
    Some(Frame::new(area, x.widened(0.03), y.widened(0.06)))
}

/// The median half length of the error bars.
fn typical_error(points: &[(f64, f64, f64)]) -> f64 {
    let mut errors: Vec<f64> = points.iter().map(|point| point.2).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().unwrap_or(0.0)
}

/// (x, y, error) of every point; an unknown error is 0.
fn all_points(points: &Points) -> Vec<(f64, f64, f64)> {
    let error = |at: usize| points.error.get(at).copied().filter(|error| error.is_finite()).unwrap_or(0.0).abs();
    points.x.iter().zip(&points.y).enumerate().map(|(at, (x, y))| (*x, *y, error(at))).collect()
}

/// Those that can be drawn.
fn finite_points(points: &Points) -> Vec<(f64, f64, f64)> {
    all_points(points).into_iter().filter(is_finite).collect()
}

fn is_finite((x, y, _): &(f64, f64, f64)) -> bool {
    x.is_finite() && y.is_finite()
}

fn draw_dots(canvas: &mut Canvas, frame: &Frame, points: &Points, curve: Option<&Curve>) {
    for (x, y, error) in finite_points(points) {
        if error > 0.0 {
            draw_error_bar(canvas, frame.point(x, y - error), frame.point(x, y + error), frame.area);
        }
        canvas.dot(frame.point(x, y), 4.5, MEASURED);
    }
    draw_curve(canvas, frame, curve);
}

fn is_any_bar_cut(frame: &Frame, points: &Points) -> bool {
    let is_outside = |y: f64| !(0.0..=1.0).contains(&frame.y.position(y));
    finite_points(points).into_iter().any(|(_, y, error)| is_outside(y - error) || is_outside(y + error))
}

/// A bar with caps; where it leaves the frame it is cut there and ends in an arrow.
fn draw_error_bar(canvas: &mut Canvas, low: (f64, f64), high: (f64, f64), frame: Area) {
    let inside = |y: f64| y.clamp(frame.top, frame.bottom());
    canvas.line((low.0, inside(low.1)), (high.0, inside(high.1)), MEASURED, 1.4);
    for (x, y) in [low, high] {
        let tip = inside(y);
        // Of an arrow the sides lead back into the frame; of a cap they lie level.
        let back = if tip == y { 0.0 } else { 6.0 * (tip - y).signum() };
        canvas.line((x - 4.0, tip + back), (x, tip), MEASURED, 1.4);
        canvas.line((x, tip), (x + 4.0, tip + back), MEASURED, 1.4);
    }
}

fn draw_band(canvas: &mut Canvas, frame: &Frame, points: &Points, curve: Option<&Curve>) {
    for piece in all_points(points).split(|point| !is_finite(point)) {
        match piece {
            [] => {}
            [only] => draw_single(canvas, frame, *only),
            piece => draw_piece(canvas, frame, piece),
        }
    }
    draw_curve(canvas, frame, curve);
}

/// A value between two gaps.
fn draw_single(canvas: &mut Canvas, frame: &Frame, (x, y, error): (f64, f64, f64)) {
    if error > 0.0 {
        draw_error_bar(canvas, frame.point(x, y - error), frame.point(x, y + error), frame.area);
    }
    canvas.dot(frame.point(x, y), SINGLE, MEASURED);
}

/// Two neighbours or more, in a band that ends at the frame.
fn draw_piece(canvas: &mut Canvas, frame: &Frame, piece: &[(f64, f64, f64)]) {
    if piece.iter().any(|(_, _, error)| *error > 0.0) {
        let upper = piece.iter().map(|(x, y, error)| frame.point(*x, y + error));
        let lower = piece.iter().rev().map(|(x, y, error)| frame.point(*x, y - error));
        let band = clipped(upper.chain(lower).collect(), frame.area);
        canvas.polygon(&band, MEASURED, 0.25);
    }
    canvas.polyline(piece.iter().map(|(x, y, _)| frame.point(*x, *y)).collect(), MEASURED, 2.2);
}

pub(super) fn draw_curve(canvas: &mut Canvas, frame: &Frame, curve: Option<&Curve>) {
    let Some(curve) = curve else { return };
    let points: Vec<(f64, f64)> = curve.x.iter().copied().zip(curve.y.iter().copied()).collect();
    for piece in points.split(|(x, y)| !(x.is_finite() && y.is_finite())).filter(|piece| !piece.is_empty()) {
        canvas.polyline(piece.iter().map(|(x, y)| frame.point(*x, *y)).collect(), FITTED, 2.2);
    }
}

/// The second line of a legend: what an arrow at an error bar means.
fn draw_cut_legend(canvas: &mut Canvas, area: Area) {
    let (x, y) = (area.left + 13.0, area.bottom() + 78.0 + LEGEND_LINE);
    let swatch = Area::new(area.left, y - 14.0, 26.0, 18.0);
    canvas.line((x, swatch.bottom()), (x, swatch.top), MEASURED, 1.4);
    draw_error_bar(canvas, (x, swatch.bottom()), (x, swatch.top - 1.0), swatch);
    let text = "arrow: the error bar goes on beyond the frame";
    canvas.text((area.left + 34.0, y), text, Style::new(TICK_SIZE, TextAnchor::Start));
}

fn draw_legend(canvas: &mut Canvas, area: Area, points: &Points, curve: Option<&Curve>, form: Form) {
    let y = area.bottom() + 78.0;
    let mut left = area.left;
    let mut entry = |canvas: &mut Canvas, text: &str, draw: &dyn Fn(&mut Canvas, f64, f64)| {
        draw(canvas, left, y - 5.0);
        canvas.text((left + 34.0, y), text, Style::new(TICK_SIZE, TextAnchor::Start));
        left += 34.0 + 24.0 + 7.6 * text.chars().count() as f64;
    };
    let has_error = points.error.iter().any(|error| error.is_finite() && *error != 0.0);
    match form {
        Form::Dots => entry(canvas, &points.name, &|canvas, x, y| canvas.dot((x + 13.0, y), 4.5, MEASURED)),
        Form::Band => {
            entry(canvas, &points.name, &|canvas, x, y| canvas.line((x, y), (x + 26.0, y), MEASURED, 2.2));
        }
    }
    if has_error {
        entry(canvas, &points.error_name, &|canvas, x, y| match form {
            Form::Dots => {
                draw_error_bar(canvas, (x + 13.0, y + 8.0), (x + 13.0, y - 8.0), Area::new(x, y - 9.0, 26.0, 18.0));
            }
            Form::Band => {
                let corners = [(x, y - 7.0), (x + 26.0, y - 7.0), (x + 26.0, y + 7.0), (x, y + 7.0)];
                canvas.polygon(&corners, MEASURED, 0.25);
            }
        });
    }
    if let Some(curve) = curve {
        entry(canvas, &curve.name, &|canvas, x, y| canvas.line((x, y), (x + 26.0, y), FITTED, 2.2));
    }
}
