//! How values around zero are distributed.

use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, FITTED, MEASURED, Style};
use super::curve::{BELOW, Curve, CurveText, SHEET_WIDTH, draw_curve};
use super::frame::{Frame, TICK_SIZE};
use super::scale::Scale;
use super::{Figure, ReportError};

/// Bars of a histogram with the curve expected, if any.
///
/// # Errors
/// [`ReportError::Empty`] when no value is finite.
pub fn histogram(values: &[f64], expected: Option<&str>, text: &CurveText) -> Result<Figure, ReportError> {
    let empty = || ReportError::Empty { figure: text.name.clone() };
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let reach = finite.iter().fold(0.0, |reach: f64, value| reach.max(value.abs()));
    let Some(Scale::Linear { from, to }) = Scale::linear_over([-reach, reach]) else { return Err(empty()) };
    if finite.is_empty() {
        return Err(empty());
    }
    let bins = ((finite.len() as f64).sqrt() * 1.8).ceil().clamp(7.0, 61.0) as usize | 1;
    let width = (to - from) / bins as f64;
    let mut counts = vec![0_usize; bins];
    for value in &finite {
        counts[(((value - from) / width) as usize).min(bins - 1)] += 1;
    }
    let curve = expected.map(|name| normal_curve(from, to, finite.len() as f64 * width, name));
    let tallest = counts.iter().copied().max().unwrap_or(0) as f64;
    let peak = curve.iter().flat_map(|curve| &curve.y).fold(tallest, |peak: f64, y| peak.max(*y));
    let y = Scale::Linear { from: 0.0, to: 1.08 * peak.max(1.0) };
    let frame = Frame::new(text.area(), Scale::Linear { from, to }, y);
    Ok(draw_histogram(&frame, &counts, curve.as_ref(), text))
}

fn draw_histogram(frame: &Frame, counts: &[usize], curve: Option<&Curve>, text: &CurveText) -> Figure {
    let area = frame.area;
    let mut canvas = Canvas::new(SHEET_WIDTH, area.bottom() + BELOW);
    frame.draw_grid(&mut canvas);
    let width = area.width / counts.len() as f64;
    for (at, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let height = area.height * frame.y.position(*count as f64);
        let left = area.left + at as f64 * width;
        canvas.rectangle(Area::new(left + 0.5, area.bottom() - height, width - 1.0, height), MEASURED);
    }
    draw_curve(&mut canvas, frame, curve);
    frame.draw_axes(&mut canvas, &text.labels());
    let y = area.bottom() + 78.0;
    canvas.rectangle(Area::new(area.left, y - 12.0, 26.0, 14.0), MEASURED);
    canvas.text((area.left + 34.0, y), "measured values", Style::new(TICK_SIZE, TextAnchor::Start));
    if let Some(curve) = curve {
        canvas.line((area.left + 190.0, y - 5.0), (area.left + 216.0, y - 5.0), FITTED, 2.2);
        canvas.text((area.left + 224.0, y), &curve.name, Style::new(TICK_SIZE, TextAnchor::Start));
    }
    Figure::new(&text.name, text.caption.clone(), canvas.finish())
}

/// The normal distribution of standard deviation 1, scaled to an area.
fn normal_curve(from: f64, to: f64, area: f64, name: &str) -> Curve {
    let x: Vec<f64> = (0..=120).map(|step| from + (to - from) * f64::from(step) / 120.0).collect();
    let y = x.iter().map(|x| area * (-x * x / 2.0).exp() / std::f64::consts::TAU.sqrt()).collect();
    Curve { x, y, name: name.to_owned() }
}
