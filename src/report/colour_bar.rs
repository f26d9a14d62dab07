//! The bar that says which colour is which number.

use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, INK, Style};
use super::colours::Colours;
use super::frame::{LABEL_SIZE, TICK_SIZE};

/// Height of a bar; its ticks and its label need 44 more.
pub(super) const BAR_HEIGHT: f64 = 18.0;
/// A tick of a bar has so much room, in units of the drawing.
const TICK_ROOM: f64 = 70.0;
const STEPS: usize = 140;

/// A bar with ticks and the label below it.
pub(super) fn draw_colour_bar(canvas: &mut Canvas, bar: Area, colours: Colours, label: &str) {
    let scale = colours.scale();
    let width = bar.width / STEPS as f64;
    for step in 0..STEPS {
        let value = scale.value((step as f64 + 0.5) / STEPS as f64);
        let left = bar.left + step as f64 * width;
        canvas.rectangle(Area::new(left, bar.top, width + 0.4, bar.height), colours.colour(value));
    }
    canvas.outline(bar, INK, 1.0);
    for tick in scale.ticks_with_ends((bar.width / TICK_ROOM).round() as usize) {
        let x = bar.left + bar.width * scale.position(tick.value);
        canvas.line((x, bar.bottom()), (x, bar.bottom() + 5.0), INK, 1.0);
        canvas.text((x, bar.bottom() + 20.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::Middle));
    }
    let text = format!("colour: {label}{}", scale.kind());
    canvas.text((bar.left, bar.bottom() + 44.0), &text, Style::new(LABEL_SIZE, TextAnchor::Start));
}
