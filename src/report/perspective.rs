//! A floor seen from above at an angle, with heights on it: what surfaces are drawn on.

use kuva::render::render::TextAnchor;

use super::canvas::{Canvas, GRID, INK, Style};
use super::frame::{LABEL_SIZE, TICK_SIZE};
use super::scale::Scale;
use super::ticks::Tick;

/// Width of the sheet.
pub(super) const WIDTH: f64 = 760.0;
/// Half the side of the floor, and the height of the tallest value, on the sheet.
const HALF_SIDE: f64 = 230.0;
const HEIGHT: f64 = 250.0;
/// About so many numbers stand at the upright axis.
pub(super) const HEIGHT_TICKS: usize = 6;
/// The floor is turned by this azimuth and seen from this elevation, degrees. The diagonal of equal numbers runs from left
/// to right, and what lies on either side of it stands before or behind it.
const AZIMUTH: f64 = 42.0;
const ELEVATION: f64 = 32.0;

/// How numbers on the floor and heights become points on the sheet.
#[derive(Debug)]
pub(super) struct Perspective {
    /// Along the edge at the front left.
    pub(super) x: Scale,
    /// Along the edge at the front right.
    pub(super) y: Scale,
    /// Upwards.
    pub(super) height: Scale,
    centre: (f64, f64),
}

/// What stands along the three axes.
pub(super) struct Axes<'a> {
    pub(super) x: (Vec<Tick>, &'a str),
    pub(super) y: (Vec<Tick>, &'a str),
    pub(super) height: &'a str,
}

impl Perspective {
    /// A floor so far down the sheet that neither the upright axis nor one of these points (x, y, share of the height) lies above
    /// `top`.
    pub(super) fn new(
        (x, y, height): (Scale, Scale, Scale),
        top: f64,
        points: impl Iterator<Item = (f64, f64, f64)>,
    ) -> Self {
        let mut view = Self { x, y, height, centre: (WIDTH / 2.0 + 18.0, 0.0) };
        let axis = view.point(ends(&x)[0], ends(&y)[0], 1.0).0.1;
        view.centre.1 = top - points.map(|(x, y, up)| view.point(x, y, up).0.1).fold(axis, f64::min);
        view
    }

    /// The lowest line of the drawing with its tick labels.
    pub(super) fn bottom(&self) -> f64 {
        self.centre.1 + HALF_SIDE * reach() * ELEVATION.to_radians().sin() + 30.0
    }

    /// The point on the sheet, and its distance from the reader.
    pub(super) fn point(&self, x: f64, y: f64, up: f64) -> ((f64, f64), f64) {
        let (x, y) = (2.0 * self.x.position(x) - 1.0, 2.0 * self.y.position(y) - 1.0);
        let (sin, cos) = AZIMUTH.to_radians().sin_cos();
        let (across, away) = (x * cos + y * sin, y * cos - x * sin);
        let rise = HALF_SIDE * away * ELEVATION.to_radians().sin() + HEIGHT * up;
        ((self.centre.0 + HALF_SIDE * across, self.centre.1 - rise), away)
    }

    /// Lines on the floor at the ticks.
    pub(super) fn draw_floor(&self, canvas: &mut Canvas, axes: &Axes<'_>) {
        let (ends_x, ends_y) = (ends(&self.x), ends(&self.y));
        for tick in &axes.x.0 {
            let line = ends_y.map(|y| self.point(tick.value, y, 0.0).0);
            canvas.line(line[0], line[1], GRID, 1.0);
        }
        for tick in &axes.y.0 {
            let line = ends_x.map(|x| self.point(x, tick.value, 0.0).0);
            canvas.line(line[0], line[1], GRID, 1.0);
        }
    }

    /// Both edges of the floor, the upright axis at the left, all with ticks and labels.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas, axes: &Axes<'_>) {
        let ([x_from, x_to], [y_from, y_to]) = (ends(&self.x), ends(&self.y));
        let corner = |x: f64, y: f64, up: f64| self.point(x, y, up).0;
        let (left, front, right) = (corner(x_from, y_from, 0.0), corner(x_to, y_from, 0.0), corner(x_to, y_to, 0.0));
        canvas.line(left, front, INK, 1.2);
        canvas.line(front, right, INK, 1.2);
        canvas.line(left, corner(x_from, y_from, 1.0), INK, 1.2);
        for tick in &axes.x.0 {
            let (x, y) = corner(tick.value, y_from, 0.0);
            canvas.text((x - 6.0, y + 18.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::End));
        }
        for tick in &axes.y.0 {
            let (x, y) = corner(x_to, tick.value, 0.0);
            canvas.text((x + 6.0, y + 18.0), &tick.label, Style::new(TICK_SIZE, TextAnchor::Start));
        }
        for tick in self.height.ticks(HEIGHT_TICKS) {
            let (x, y) = corner(x_from, y_from, self.height.position(tick.value));
            canvas.line((x - 5.0, y), (x, y), INK, 1.0);
            canvas.text((x - 9.0, y + 4.5), &tick.label, Style::new(TICK_SIZE, TextAnchor::End));
        }
        let bottom = self.bottom();
        let label = |anchor: TextAnchor| Style::new(LABEL_SIZE, anchor);
        canvas.text((24.0, bottom - 2.0), &format!("{} ↘", axes.x.1), label(TextAnchor::Start));
        canvas.text((WIDTH - 24.0, bottom - 2.0), &format!("↗ {}", axes.y.1), label(TextAnchor::End));
        let text = format!("↑ height and colour: {}{}", axes.height, self.height.kind());
        canvas.text((24.0, bottom + 34.0), &text, label(TextAnchor::Start));
    }
}

/// How far the corners of the floor reach from its centre, in half sides.
fn reach() -> f64 {
    let (sin, cos) = AZIMUTH.to_radians().sin_cos();
    sin + cos
}

pub(super) fn ends(scale: &Scale) -> [f64; 2] {
    [scale.value(0.0), scale.value(1.0)]
}
