//! What is paid against what is got: measured results over their cost, with the line that no result can go below.

use kuva::render::color::Color;
use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, INK, LINES, Style};
use super::curve::{BELOW, CurveText, SHEET_WIDTH};
use super::frame::{Frame, TICK_SIZE};
use super::scale::{Scale, extent};
use super::{Figure, ReportError};

/// Height of a line of the legend.
const LEGEND_LINE: f64 = 22.0;
/// Size of the words beside a dot.
const BESIDE: u32 = 11;
/// Width of one of their letters, at most.
const LETTER: f64 = 6.8;

/// One setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// What it costs; positive.
    pub cost: f64,
    /// What it gives: an error, say; positive.
    pub result: f64,
    /// What no setting of that kind can go below.
    pub bound: f64,
    /// A word beside its dot, left out where it has no room; empty for none.
    pub label: String,
}

/// One knob in several settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// What is turned, for the legend.
    pub name: String,
    /// Its settings in their order.
    pub settings: Vec<Setting>,
}

/// Dots of results over costs, one colour per knob, and a thin line at the bound of each; both scales are logarithmic.
///
/// # Errors
/// [`ReportError::Empty`] when nothing is positive and finite.
pub fn trade(knobs: &[Knob], bound: &str, text: &CurveText) -> Result<Figure, ReportError> {
    draw(knobs, Some(bound), text)
}

/// The same; without the name of a bound none is drawn.
pub(super) fn draw(knobs: &[Knob], bound: Option<&str>, text: &CurveText) -> Result<Figure, ReportError> {
    let empty = || ReportError::Empty { figure: text.name.clone() };
    let area = text.area();
    let drawn = |setting: &&Setting| [setting.cost, setting.result, setting.bound].iter().all(|x| is_drawn(*x));
    let all = || knobs.iter().flat_map(|knob| knob.settings.iter().filter(drawn));
    let over = |values: Option<(f64, f64)>| {
        let (low, high) = values?;
        Some(Scale::Logarithmic { from: low / 1.5, to: high * 1.5 })
    };
    let x = over(extent(all().map(|setting| setting.cost))).ok_or_else(empty)?;
    let y = over(extent(all().flat_map(|setting| [setting.result, setting.bound]))).ok_or_else(empty)?;
    let frame = Frame::new(area, x, y);
    let mut canvas = Canvas::new(SHEET_WIDTH, area.bottom() + BELOW + LEGEND_LINE * (knobs.len() / 2) as f64);
    frame.draw_grid(&mut canvas);
    for (k, knob) in knobs.iter().enumerate() {
        let colour = || LINES[k % LINES.len()].clone();
        let settings: Vec<&Setting> = knob.settings.iter().filter(drawn).collect();
        let line = |of: fn(&Setting) -> f64| settings.iter().map(|s| frame.point(s.cost, of(s))).collect::<Vec<_>>();
        canvas.polyline(line(|setting| setting.result), colour(), 2.6);
        for setting in &settings {
            canvas.dot(frame.point(setting.cost, setting.result), 4.0, colour());
        }
        // Above the results, which lie on it where they are as good as can be.
        if bound.is_some() {
            canvas.polyline(line(|setting| setting.bound), INK, 1.0);
        }
    }
    let mut taken = Vec::new();
    for (k, setting) in knobs.iter().enumerate().flat_map(|(k, knob)| knob.settings.iter().map(move |s| (k, s))) {
        let room = if drawn(&setting) { place(&frame, setting, &taken) } else { None };
        if let Some(word) = room {
            let style = Style { colour: LINES[k % LINES.len()].clone(), ..Style::new(BESIDE, TextAnchor::Start) };
            canvas.text((word.left, word.bottom() - 2.0), &setting.label, style);
            taken.push(word);
        }
    }
    frame.draw_axes(&mut canvas, &text.labels());
    let names = knobs.iter().enumerate().map(|(k, knob)| (LINES[k % LINES.len()].clone(), knob.name.as_str()));
    for (k, (colour, name)) in names.chain(bound.map(|bound| (INK, bound))).enumerate() {
        let at = (area.left + (k % 2) as f64 * 310.0, area.bottom() + 74.0 + LEGEND_LINE * (k / 2) as f64);
        draw_name(&mut canvas, at, colour, name);
    }
    Ok(Figure::new(&text.name, text.caption.clone(), canvas.finish()))
}

/// Where the word of a setting has room within the frame and beside the others: right or left of its dot, above or below.
fn place(frame: &Frame, setting: &Setting, taken: &[Area]) -> Option<Area> {
    let (x, y) = frame.point(setting.cost, setting.result);
    let (width, height) = (LETTER * setting.label.chars().count() as f64, f64::from(BESIDE) + 2.0);
    let (right, left) = (x + 6.0, x - 6.0 - width);
    let (above, below) = (y - 5.0 - height, y + 5.0);
    let inside = |word: &Area| {
        word.left > frame.area.left
            && word.right() < frame.area.right()
            && word.top > frame.area.top
            && word.bottom() < frame.area.bottom()
    };
    let is_free = |word: &Area| {
        let meets = |other: &Area| {
            word.left < other.right()
                && other.left < word.right()
                && word.top < other.bottom()
                && other.top < word.bottom()
        };
        !taken.iter().any(meets)
    };
    [(right, above), (left, below), (right, below), (left, above)]
        .map(|(left, top)| Area::new(left, top, width, height))
        .into_iter()
        .find(|word| width > 0.0 && inside(word) && is_free(word))
}

fn draw_name(canvas: &mut Canvas, (x, y): (f64, f64), colour: Color, name: &str) {
    canvas.line((x, y - 4.5), (x + 20.0, y - 4.5), colour, 2.4);
    canvas.text((x + 26.0, y), name, Style::new(TICK_SIZE, TextAnchor::Start));
}

fn is_drawn(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_knob_and_its_bound_are_drawn_and_nothing_is_refused() {
        let text = |name: &str| CurveText {
            name: name.to_owned(),
            title: "title".to_owned(),
            subtitle: String::new(),
            x: "time".to_owned(),
            y: "error".to_owned(),
            caption: String::new(),
        };
        let setting = |cost: f64| Setting { cost, result: 2.0 / cost, bound: 1.0 / cost, label: format!("at {cost}") };
        let knob = Knob { name: "nodes".to_owned(), settings: vec![setting(1.0), setting(10.0), setting(f64::NAN)] };
        let svg = trade(std::slice::from_ref(&knob), "least", &text("trade")).unwrap().to_svg();
        assert!(["nodes", "least", "at 1", "at 10"].iter().all(|word| svg.contains(word)) && !svg.contains("at NaN"));
        assert!(trade(&[], "least", &text("nothing")).is_err());
    }
}
