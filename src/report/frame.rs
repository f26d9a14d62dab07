//! A pair of axes with title, ticks, labels and grid.

use kuva::render::render::TextAnchor;

use super::canvas::{Area, Canvas, GRID, INK, Style};
use super::scale::Scale;
use super::ticks::Tick;

/// Sizes of text, in units of the drawing.
pub(super) const TITLE_SIZE: u32 = 17;
pub(super) const LABEL_SIZE: u32 = 15;
pub(super) const TICK_SIZE: u32 = 13;

/// Height of a line of the title and of the subtitle.
const TITLE_LINE: f64 = 22.0;
const SUBTITLE_LINE: f64 = 19.0;
/// Where titles start on the sheet.
const LEFT_MARGIN: f64 = 24.0;

/// How many letters of the title size fit into one unit of width, at least.
const LETTERS_PER_UNIT: f64 = 1.0 / (0.62 * TITLE_SIZE as f64);

/// The texts around a pair of axes.
#[derive(Debug, Clone)]
pub(super) struct Labels<'a> {
    /// What is drawn, and of what.
    pub(super) title: &'a str,
    /// What else the reader must know, smaller.
    pub(super) subtitle: &'a str,
    /// The quantity on the horizontal axis, with its unit.
    pub(super) x: &'a str,
    /// The quantity on the vertical axis, with its unit.
    pub(super) y: &'a str,
}

/// A plotting area with its two scales and their ticks.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub(super) area: Area,
    pub(super) x: Scale,
    pub(super) y: Scale,
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
}

impl Frame {
    /// Ticks at round numbers, or each 20 degrees.
    pub(super) fn new(area: Area, x: Scale, y: Scale) -> Self {
        let x_ticks = degree_ticks(&x).unwrap_or_else(|| x.ticks(7));
        let y_ticks = degree_ticks(&y).unwrap_or_else(|| y.ticks(6));
        Self { area, x, y, x_ticks, y_ticks }
    }

    /// About so many ticks on each axis; none where 0.
    pub(super) fn with_ticks(area: Area, (x, across): (Scale, usize), (y, up): (Scale, usize)) -> Self {
        let ticks = |scale: Scale, count: usize| if count > 0 { scale.ticks(count) } else { Vec::new() };
        Self { area, x, y, x_ticks: ticks(x, across), y_ticks: ticks(y, up) }
    }

    /// Ticks at measured angles, as many as can be read.
    pub(super) fn over_angles(area: Area, (x, x_deg): (Scale, &[f64]), (y, y_deg): (Scale, &[f64])) -> Self {
        let (x_ticks, y_ticks) = (x.ticks_among(x_deg, 12), y.ticks_among(y_deg, 12));
        Self { area, x, y, x_ticks, y_ticks }
    }

    /// The place of a pair of numbers on the sheet.
    pub(super) fn point(&self, x: f64, y: f64) -> (f64, f64) {
        let area = &self.area;
        (area.left + area.width * self.x.position(x), area.bottom() - area.height * self.y.position(y))
    }

    /// Light lines at the ticks.
    pub(super) fn draw_grid(&self, canvas: &mut Canvas) {
        for tick in &self.x_ticks {
            let (x, _) = self.point(tick.value, 0.0);
            canvas.line((x, self.area.top), (x, self.area.bottom()), GRID, 1.0);
        }
        for tick in &self.y_ticks {
            let y = self.area.bottom() - self.area.height * self.y.position(tick.value);
            canvas.line((self.area.left, y), (self.area.right(), y), GRID, 1.0);
        }
    }

    /// The box, the ticks and all texts; an empty label is left out.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas, labels: &Labels<'_>) {
        canvas.outline(self.area, INK, 1.2);
        self.draw_x_ticks(canvas);
        self.draw_y_ticks(canvas);
        let (right, bottom) = (self.area.right(), self.area.bottom());
        if !labels.x.is_empty() {
            canvas.text((right, bottom + 46.0), &format!("{} →", labels.x), Style::new(LABEL_SIZE, TextAnchor::End));
        }
        // Level, above the axis: upright labels are read without turning the head.
        if !labels.y.is_empty() {
            let label = format!("↑ {}", labels.y);
            canvas.text((LEFT_MARGIN, self.area.top - 12.0), &label, Style::new(LABEL_SIZE, TextAnchor::Start));
        }
        draw_titles(canvas, self.area.width, labels);
    }

    fn draw_x_ticks(&self, canvas: &mut Canvas) {
        let bottom = self.area.bottom();
        for tick in &self.x_ticks {
            let x = self.area.left + self.area.width * self.x.position(tick.value);
            canvas.line((x, bottom), (x, bottom + 5.0), INK, 1.0);
            canvas.text((x, bottom + 21.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::Middle));
        }
    }

    fn draw_y_ticks(&self, canvas: &mut Canvas) {
        for tick in &self.y_ticks {
            let y = self.area.bottom() - self.area.height * self.y.position(tick.value);
            canvas.line((self.area.left - 5.0, y), (self.area.left, y), INK, 1.0);
            canvas.text((self.area.left - 9.0, y + 4.5), &tick.label, Style::new(TICK_SIZE, TextAnchor::End));
        }
    }
}

/// Ticks each 20 degrees where a scale spans more than a quadrant and at most the half circle, as in-plane angles do.
fn degree_ticks(scale: &Scale) -> Option<Vec<Tick>> {
    let Scale::Linear { from, to } = *scale else { return None };
    let is_angular = from >= -100.0 && to <= 100.0 && to - from > 95.0;
    is_angular.then(|| Scale::Linear { from, to }.ticks(((to - from) / 20.0).ceil() as usize))
}

/// Title and subtitle from the top of the sheet, each on at most two lines.
pub(super) fn draw_titles(canvas: &mut Canvas, width: f64, labels: &Labels<'_>) {
    let (titles, subtitles) = labels.lines(width);
    let mut y = 10.0;
    for line in titles {
        y += TITLE_LINE;
        canvas.text((LEFT_MARGIN, y), &line, Style::new(TITLE_SIZE, TextAnchor::Start).bold());
    }
    for line in subtitles {
        y += SUBTITLE_LINE;
        canvas.text((LEFT_MARGIN, y), &line, Style::new(TICK_SIZE, TextAnchor::Start).muted());
    }
}

impl Labels<'_> {
    /// How far below the top of the sheet a plotting area of that width starts, so that the texts fit above it.
    pub(super) fn height(&self, width: f64) -> f64 {
        let (titles, subtitles) = self.lines(width);
        10.0 + TITLE_LINE * titles.len() as f64 + SUBTITLE_LINE * subtitles.len() as f64 + 44.0
    }

    fn lines(&self, width: f64) -> (Vec<String>, Vec<String>) {
        let letters = ((width + 60.0) * LETTERS_PER_UNIT) as usize;
        (wrapped(self.title, letters), wrapped(self.subtitle, letters * TITLE_SIZE as usize / TICK_SIZE as usize))
    }
}

/// At most two lines of about that many letters; what is left over ends in an ellipsis.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let is_cut = lines.len() > 2;
    lines.truncate(2);
    for line in &mut lines {
        shorten(line, letters, false);
    }
    if is_cut && let Some(last) = lines.last_mut() {
        shorten(last, letters, true);
    }
    lines
}

fn shorten(line: &mut String, letters: usize, always: bool) {
    if always || line.chars().count() > letters {
        let kept: String = line.chars().take(letters.saturating_sub(2)).collect();
        *line = format!("{} …", kept.trim_end());
    }
}

/// A quantity with its unit, as on an axis: `radiance (W m⁻² sr⁻¹ nm⁻¹)`.
pub(super) fn with_unit(quantity: &str, unit: &str) -> String {
    if unit == "1" {
        return format!("{quantity} (unit 1)");
    }
    let words: Vec<String> = unit.split(' ').map(raised_exponent).collect();
    format!("{quantity} ({})", words.join(" "))
}

/// `sr-1` as sr⁻¹.
fn raised_exponent(word: &str) -> String {
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-');
    let exponent = &word[letters.len()..];
    if letters.is_empty() { word.to_owned() } else { format!("{letters}{}", super::ticks::superscript(exponent)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_get_their_exponents() {
        assert_eq!(with_unit("radiance", "W m-2 sr-1 nm-1"), "radiance (W m⁻² sr⁻¹ nm⁻¹)");
        assert_eq!(with_unit("factor", "1"), "factor (unit 1)");
    }

    #[test]
    fn long_titles_are_cut_into_two_lines() {
        assert_eq!(wrapped("", 10), Vec::<String>::new());
        assert_eq!(wrapped("one two three", 8), ["one two", "three"]);
        let lines = wrapped(&"word ".repeat(50), 20);
        assert!(lines.len() == 2 && lines[1].ends_with('…') && lines[1].chars().count() <= 20, "{lines:?}");
    }
}
