//! The profile of a parameter beside the parabola of its standard uncertainty, with the interval that follows from it.

use kuva::render::color::Color;
use kuva::render::render::TextAnchor;

use super::Shown;
use crate::fit::{ProfileCurve, Profiled};
use crate::report::canvas::{Canvas, FITTED, HATCH, INK, MEASURED, MUTED, Style};
use crate::report::curve::{BELOW, CurveText, SHEET_WIDTH};
use crate::report::frame::{Frame, TICK_SIZE, with_unit};
use crate::report::html::number;
use crate::report::scale::{Scale, extent};
use crate::report::{Figure, ReportError};

/// Points of the parabola.
const STEPS: usize = 160;
/// A parameter that may be so many times its least value is drawn over a logarithmic axis.
const WIDE: f64 = 30.0;

/// Name, unit and offset of what is drawn: of an index its profile is walked in n - 1.
fn named(shown: &Shown<'_>, parameter: Profiled) -> (String, String, f64) {
    let (position, offset) = match parameter {
        Profiled::Diffuse => (None, 0.0),
        Profiled::Intensity => (Some(0), 0.0),
        Profiled::Roughness => (Some(1), 0.0),
        Profiled::IndexMinusOne => (Some(2), 1.0),
    };
    let is_specular = |kind: crate::terms::TermKind| kind == crate::terms::TermKind::TorranceSparrow;
    let term = shown.model.terms.iter().find(|term| is_specular(term.kind) == position.is_some());
    let fitted = term.and_then(|term| term.parameters.get(position.unwrap_or(0)));
    let name = fitted.map_or("parameter".to_owned(), |fitted| fitted.name.clone());
    (name, fitted.map_or("1".to_owned(), |fitted| fitted.unit.clone()), offset)
}

/// Draws one profile.
pub(super) fn figure(shown: &Shown<'_>, curve: &ProfileCurve) -> Result<Figure, ReportError> {
    let (name, unit, offset) = named(shown, curve.parameter);
    let has_sigma = shown.of.data.sigma.is_some();
    let rise =
        if has_sigma { "rise of chi-square (unit 1)" } else { "rise of chi-square over that of one degree of freedom" };
    let text = CurveText {
        name: format!("profile-{}", name.replace('_', "-")),
        title: format!("{}: profile of {name}", shown.subject),
        subtitle: format!("95 % interval: {}", super::page::interval_text(Some(curve.interval), offset)),
        x: with_unit(&name, &unit),
        y: rise.to_owned(),
        caption: format!(
            "How chi-square rises when {name} is held at a value and all other parameters follow it, beside the parabola that the \
             standard uncertainty stands for. Where the two differ, the interval between the points at which the profile meets the \
             level line says what the data allow, and the standard uncertainty does not."
        ),
    };
    let top = 1.8 * curve.level;
    let points: Vec<(f64, f64)> = curve.points.iter().map(|(value, rise)| (value + offset, *rise)).collect();
    let empty = || ReportError::Empty { figure: text.name.clone() };
    // A point above the frame would stretch it where nothing is drawn.
    let drawn = points.iter().filter(|point| point.1 <= top).map(|point| point.0);
    let ends = [curve.interval.low, curve.interval.high].map(|end| end + offset);
    let (from, to) = extent(drawn.chain(ends)).ok_or_else(empty)?;
    let x = if from > 0.0 && to > WIDE * from {
        Scale::Logarithmic { from, to }
    } else {
        Scale::linear_over([from, to]).ok_or_else(empty)?
    };
    let x = x.widened(0.04);
    let frame = Frame::new(text.area(), x, Scale::Linear { from: 0.0, to: top });
    let mut canvas = Canvas::new(SHEET_WIDTH, frame.area.bottom() + BELOW + 22.0);
    frame.draw_grid(&mut canvas);
    draw_levels(&mut canvas, &frame, curve, offset);
    let sigma = curve.standard_uncertainty;
    if sigma.is_finite() && sigma > 0.0 {
        let at = |k: usize| frame.x.value(k as f64 / STEPS as f64);
        let parabola = (0..=STEPS).map(|k| (at(k), ((at(k) - offset - curve.best) / sigma).powi(2)));
        draw_below(&mut canvas, &frame, parabola.collect(), top, (FITTED, 6.0));
    }
    draw_below(&mut canvas, &frame, points.clone(), top, (MEASURED, 2.2));
    points.iter().filter(|point| point.1 <= top).for_each(|(x, y)| canvas.dot(frame.point(*x, *y), 2.6, MEASURED));
    frame.draw_axes(&mut canvas, &text.labels());
    draw_legend(&mut canvas, &frame, curve);
    Ok(Figure::new(&text.name, text.caption, canvas.finish()))
}

/// The level line, the best value, and the edges of the box where the interval reaches them.
fn draw_levels(canvas: &mut Canvas, frame: &Frame, curve: &ProfileCurve, offset: f64) {
    let area = frame.area;
    let (_, level) = frame.point(0.0, curve.level);
    canvas.line((area.left, level), (area.right(), level), INK, 1.4);
    let label = format!("95 %: {}", number((curve.level * 1000.0).round() / 1000.0));
    let (best, _) = frame.point(curve.best + offset, 0.0);
    let (anchor, away) = if best > area.centre().0 { (TextAnchor::End, -6.0) } else { (TextAnchor::Start, 6.0) };
    canvas.text((best + away, level - 6.0), &label, Style::new(TICK_SIZE, anchor));
    canvas.line((best, area.top), (best, area.bottom()), MUTED, 1.0);
    let ends = [(curve.interval.low, curve.interval.low_open), (curve.interval.high, curve.interval.high_open)];
    for (value, is_open) in ends {
        let (x, _) = frame.point(value + offset, 0.0);
        if !(area.left..=area.right()).contains(&x) {
            continue;
        }
        canvas.line(
            (x, if is_open { area.top } else { level }),
            (x, area.bottom()),
            if is_open { HATCH } else { INK },
            if is_open { 4.0 } else { 1.2 },
        );
    }
}

/// A curve as far as it stays in the frame.
fn draw_below(canvas: &mut Canvas, frame: &Frame, points: Vec<(f64, f64)>, top: f64, (colour, width): (Color, f64)) {
    for piece in points.split(|(_, y)| y.is_nan() || *y > top).filter(|piece| piece.len() > 1) {
        canvas.polyline(piece.iter().map(|(x, y)| frame.point(*x, *y)).collect(), colour.clone(), width);
    }
}

fn draw_legend(canvas: &mut Canvas, frame: &Frame, curve: &ProfileCurve) {
    let area = frame.area;
    let mut entry = |line: usize, left: f64, colour: Color, width: f64, text: &str| {
        let y = area.bottom() + 74.0 + 22.0 * line as f64;
        canvas.line((area.left + left, y - 5.0), (area.left + left + 26.0, y - 5.0), colour, width);
        canvas.text((area.left + left + 34.0, y), text, Style::new(TICK_SIZE, TextAnchor::Start));
    };
    entry(0, 0.0, MEASURED, 2.2, "profile: all others follow");
    let parabola = if curve.standard_uncertainty.is_finite() {
        "parabola of the standard uncertainty"
    } else {
        "no parabola: it has no standard uncertainty"
    };
    entry(0, 260.0, FITTED, 6.0, parabola);
    if !curve.interval.is_closed() {
        entry(1, 0.0, HATCH, 4.0, "end of what can be searched: the interval is open there");
    }
}
