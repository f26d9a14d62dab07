//! Drawing on a sheet: text, lines and areas in one house style. Units are those of the SVG, y grows downwards.

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor, TextSpan};

/// The text colour.
pub(super) const INK: Color = Color::Rgb(0x22, 0x22, 0x22);
/// Secondary text.
pub(super) const MUTED: Color = Color::Rgb(0x5a, 0x5a, 0x5a);
/// Grid lines.
pub(super) const GRID: Color = Color::Rgb(0xe2, 0xe2, 0xe2);
/// Measured values (Okabe and Ito's colours, which colour-blind readers tell apart).
pub(super) const MEASURED: Color = Color::Rgb(0x00, 0x72, 0xb2);
/// Models and fitted curves.
pub(super) const FITTED: Color = Color::Rgb(0xd5, 0x5e, 0x00);
/// Hatching of what is missing.
pub(super) const HATCH: Color = Color::Rgb(0x8c, 0x8c, 0x8c);

/// Curves that are told apart by their colours, Okabe and Ito's.
pub(super) const LINES: [Color; 6] = [
    MEASURED,
    FITTED,
    Color::Rgb(0x00, 0x9e, 0x73),
    Color::Rgb(0xcc, 0x79, 0xa7),
    Color::Rgb(0xe6, 0x9f, 0x00),
    Color::Rgb(0x56, 0xb4, 0xe9),
];

/// Fonts are sans-serif; the first is the one the PNG is drawn with.
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// How a text is set.
#[derive(Debug, Clone)]
pub(super) struct Style {
    pub(super) size: u32,
    pub(super) anchor: TextAnchor,
    pub(super) bold: bool,
    pub(super) colour: Color,
}

impl Style {
    pub(super) fn new(size: u32, anchor: TextAnchor) -> Self {
        Self { size, anchor, bold: false, colour: INK }
    }

    pub(super) fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    pub(super) fn muted(mut self) -> Self {
        self.colour = MUTED;
        self
    }
}

/// A sheet to draw on.
#[derive(Debug)]
pub(super) struct Canvas {
    scene: Scene,
}

impl Canvas {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut scene = Scene::new(width, height);
        scene.font_family = Some(FONTS.to_owned());
        Self { scene }
    }

    pub(super) fn finish(self) -> Scene {
        self.scene
    }

    pub(super) fn text(&mut self, (x, y): (f64, f64), text: &str, style: Style) {
        let span = TextSpan { bold: style.bold, ..TextSpan::plain(printable(text)) };
        let (size, anchor, color) = (style.size, style.anchor, Some(style.colour));
        self.scene.add(Primitive::RichText { x, y, spans: vec![span], size, anchor, color });
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: Color, width: f64) {
        self.scene.add(Primitive::Line {
            x1: from.0,
            y1: from.1,
            x2: to.0,
            y2: to.1,
            stroke: colour,
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    pub(super) fn polyline(&mut self, points: Vec<(f64, f64)>, colour: Color, width: f64) {
        self.scene.add(Primitive::PolyLine { points, stroke: colour, stroke_width: width, stroke_dasharray: None });
    }

    pub(super) fn rectangle(&mut self, area: Area, fill: Color) {
        self.scene.add(Primitive::Rect {
            x: area.left,
            y: area.top,
            width: area.width,
            height: area.height,
            fill,
            stroke: None,
            stroke_width: None,
            opacity: None,
        });
    }

    pub(super) fn outline(&mut self, area: Area, colour: Color, width: f64) {
        self.scene.add(Primitive::Rect {
            x: area.left,
            y: area.top,
            width: area.width,
            height: area.height,
            fill: Color::None,
            stroke: Some(colour),
            stroke_width: Some(width),
            opacity: None,
        });
    }

    pub(super) fn dot(&mut self, (cx, cy): (f64, f64), radius: f64, fill: Color) {
        self.scene.add(Primitive::Circle {
            cx,
            cy,
            r: radius,
            fill,
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    /// A filled polygon; `opacity` from 0 to 1.
    pub(super) fn polygon(&mut self, points: &[(f64, f64)], fill: Color, opacity: f64) {
        self.area(points, fill, Color::None, opacity);
    }

    /// A filled polygon with an outline of the given colour.
    pub(super) fn facet(&mut self, points: &[(f64, f64)], fill: Color, outline: Color) {
        self.area(points, fill, outline, 1.0);
    }

    fn area(&mut self, points: &[(f64, f64)], fill: Color, stroke: Color, opacity: f64) {
        let mut path = String::new();
        for (index, (x, y)) in points.iter().enumerate() {
            path.push_str(&format!("{} {x:.2} {y:.2} ", if index == 0 { 'M' } else { 'L' }));
        }
        path.push('Z');
        self.scene.add(Primitive::Path(Box::new(PathData {
            d: path,
            fill: Some(fill),
            stroke,
            stroke_width: 0.5,
            opacity: Some(opacity),
            stroke_dasharray: None,
        })));
    }

    /// An area hatched from its lower left to its upper right: nothing was measured here.
    pub(super) fn hatch(&mut self, area: Area, spacing: f64) {
        self.rectangle(area, Color::Rgb(0xf7, 0xf7, 0xf7));
        // Along each line x + y is constant; it enters on the left or below and leaves above or on the right.
        let (right, bottom) = (area.left + area.width, area.top + area.height);
        let mut sum = area.left + area.top + spacing / 2.0;
        while sum < right + bottom {
            let start_x = area.left.max(sum - bottom);
            let end_x = right.min(sum - area.top);
            self.line((start_x, sum - start_x), (end_x, sum - end_x), HATCH, 0.8);
            sum += spacing;
        }
    }

    /// An area with a cross: a value that is missing though it was planned.
    pub(super) fn cross(&mut self, area: Area) {
        self.rectangle(area, Color::Rgb(0xff, 0xff, 0xff));
        let (right, bottom) = (area.left + area.width, area.top + area.height);
        self.line((area.left, area.top), (right, bottom), HATCH, 0.8);
        self.line((area.left, bottom), (right, area.top), HATCH, 0.8);
    }
}

/// A rectangle on the sheet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self { left, top, width, height }
    }

    pub(super) fn centre(&self) -> (f64, f64) {
        (self.left + self.width / 2.0, self.top + self.height / 2.0)
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// The part of a polygon between the upper and the lower edge of an area.
pub(super) fn clipped(polygon: Vec<(f64, f64)>, area: Area) -> Vec<(f64, f64)> {
    let below_top = cut(&polygon, area.top, |y| y >= area.top);
    cut(&below_top, area.bottom(), |y| y <= area.bottom())
}

/// The part of a polygon on one side of a level line (Sutherland and Hodgman's way).
fn cut(polygon: &[(f64, f64)], level: f64, is_inside: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
    let mut kept = Vec::with_capacity(polygon.len() + 4);
    let before = polygon.iter().cycle().skip(polygon.len().saturating_sub(1));
    for (from, to) in before.zip(polygon) {
        if is_inside(from.1) != is_inside(to.1) {
            let share = (level - from.1) / (to.1 - from.1);
            kept.push((from.0 + share * (to.0 - from.0), level));
        }
        if is_inside(to.1) {
            kept.push(*to);
        }
    }
    kept
}

/// Control characters are not allowed in XML; they become spaces.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_cut_where_it_leaves_the_area_and_not_bent() {
        let area = Area::new(0.0, 0.0, 10.0, 10.0);
        let triangle = vec![(0.0, 5.0), (10.0, -5.0), (10.0, 5.0)];
        assert_eq!(clipped(triangle, area), [(0.0, 5.0), (5.0, 0.0), (10.0, 0.0), (10.0, 5.0)]);
        assert_eq!(clipped(vec![(0.0, 20.0), (5.0, 30.0), (9.0, 20.0)], area), []);
        assert_eq!(clipped(Vec::new(), area), []);
    }
}
