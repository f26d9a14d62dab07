//! The matrix as a surface seen from where emission is long and excitation short: luminescence stands before the diagonal, noise
//! lies behind it, and the reflected light is a wall along the diagonal on a scale of its own.

use kuva::render::render::TextAnchor;

use super::cells::{Cells, swatch};
use super::margins::{Margin, next_to_diagonal};
use super::strongest;
use crate::report::canvas::{Canvas, INK, Style};
use crate::report::colours::Colours;
use crate::report::frame::{LABEL_SIZE, Labels, TICK_SIZE, draw_titles};
use crate::report::perspective::{Axes, HEIGHT_TICKS, Perspective, WIDTH, ends};
use crate::report::scale::{Scale, extent};
use crate::report::surface::{OUTLINE, SIDE, pale};
use crate::report::{Figure, ReportError};

/// The wall is seen through.
const WALL_OPACITY: f64 = 0.5;
/// The wall ends at this share of the height, so that it tops no luminescence.
const WALL_HEIGHT: f64 = 0.8;

const WALL: &str = "The grey wall along the diagonal is reflected light, with the luminescence of the cells next to it, on its \
                    own scale at the right. ";

/// The surface.
///
/// # Errors
/// [`ReportError`] when an axis has one wavelength only, or no cell a value.
pub(super) fn bispectral_surface(cells: &Cells, subject: &str) -> Result<Figure, ReportError> {
    let (excitations, emissions) = cells.luminescent.dim();
    if excitations < 2 || emissions < 2 {
        return Err(ReportError::NoSurface { measurement: cells.id.clone(), excitations, emissions });
    }
    let drawn = cells.thinned();
    let (values, reflected) = (extent(drawn.luminescent.iter().copied()), extent(drawn.reflected.iter().copied()));
    if values.is_none() && reflected.is_none() {
        return Err(ReportError::Empty { figure: format!("measurement `{}`: its surface", cells.id) });
    }
    let (low, high) = values.unwrap_or((0.0, 1.0));
    let height = match (low.min(0.0), high.max(0.0)) {
        (from, to) if to > from => Scale::Linear { from, to },
        _ => Scale::Linear { from: 0.0, to: 1.0 },
    };
    let title = format!("{subject}: Donaldson matrix");
    let wall = if reflected.is_some() { ", what lies next to the diagonal as a wall" } else { "" };
    let subtitle = format!("luminescence as a surface{wall}{}", drawn.blocks_in_words());
    let labels = Labels { title: &title, subtitle: &subtitle, x: "", y: "" };
    let span = |nm: &[f64]| Scale::Linear { from: nm[0], to: nm[nm.len() - 1] };
    let (x, y) = (span(&drawn.emission_nm), span(&drawn.excitation_nm));
    let view =
        Perspective::new((x, y, height.ending_on_tick(HEIGHT_TICKS)), labels.height(WIDTH - 100.0), std::iter::empty());
    let relief = Relief { view: &view, cells: &drawn, wall: Wall::of(cells), colours: drawn.luminescent_colours() };
    let axes = Axes {
        x: (x.ticks(7), "emission (nm)"),
        y: (y.ticks(7), "excitation (nm)"),
        height: "luminescent value (unit 1)",
    };
    let mut canvas = Canvas::new(WIDTH, view.bottom() + 96.0);
    draw_titles(&mut canvas, WIDTH - 100.0, &labels);
    view.draw_floor(&mut canvas, &axes);
    relief.draw(&mut canvas);
    view.draw_axes(&mut canvas, &axes);
    draw_legend(&mut canvas, &drawn, view.bottom() + 58.0);
    let caption = format!(
        "{title} as a surface over emission and excitation, seen from where emission is long and excitation short. {} \
         {}Behind the diagonal, below the excitation, no light can be: what is there is noise.",
        strongest(cells),
        if reflected.is_some() { WALL } else { "" }
    );
    Ok(Figure::new("bispectral-surface", caption, canvas.finish()))
}

/// The reflected light: places along the diagonal, nm, with what lies there.
struct Wall {
    nm: Vec<f64>,
    margin: Margin,
    scale: Option<Scale>,
}

impl Wall {
    fn of(cells: &Cells) -> Self {
        let margin = next_to_diagonal(cells);
        let scale = extent(margin.values.iter().copied())
            .map(|(_, high)| Scale::Linear { from: 0.0, to: if high > 0.0 { high } else { 1.0 } }.ending_on_tick(4));
        Self { nm: cells.emission_nm.clone(), margin, scale }
    }
}

struct Relief<'a> {
    view: &'a Perspective,
    cells: &'a Cells,
    wall: Wall,
    colours: Option<Colours>,
}

impl Relief<'_> {
    /// The farthest first: a plane through the diagonal parts what lies behind it from what stands before it, and on either side
    /// rows of long excitation and columns of short emission are farther away.
    fn draw(&self, canvas: &mut Canvas) {
        let is_behind = |(i, j): (usize, usize)| {
            let (excitation, emission) = (&self.cells.excitation_nm, &self.cells.emission_nm);
            emission[j - 1] + emission[j] < excitation[i - 1] + excitation[i]
        };
        let (rows, columns) = self.cells.luminescent.dim();
        let all = || (1..rows).rev().flat_map(move |i| (1..columns).map(move |j| (i, j)));
        all().filter(|at| is_behind(*at)).for_each(|at| self.draw_facet(canvas, at));
        self.draw_wall(canvas);
        all().filter(|at| !is_behind(*at)).for_each(|at| self.draw_facet(canvas, at));
        self.draw_sides(canvas);
    }

    fn corner(&self, (i, j): (usize, usize), up: f64) -> (f64, f64) {
        self.view.point(self.cells.emission_nm[j], self.cells.excitation_nm[i], up).0
    }

    /// The facet whose far corner is that cell; none where a corner has no luminescent value.
    fn draw_facet(&self, canvas: &mut Canvas, (i, j): (usize, usize)) {
        let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
        let values = corners.map(|cell| self.cells.luminescent[cell]);
        let (Some(colours), true) = (self.colours, values.iter().all(|value| value.is_finite())) else { return };
        let places: Vec<_> = corners.map(|cell| self.corner(cell, self.up(cell))).to_vec();
        let colour = colours.colour(values.iter().sum::<f64>() / 4.0);
        let is_pale = corners.iter().any(|cell| self.cells.is_marked[*cell]);
        canvas.facet(&places, if is_pale { pale(colour) } else { colour }, OUTLINE);
    }

    fn up(&self, cell: (usize, usize)) -> f64 {
        self.view.height.position(self.cells.luminescent[cell])
    }

    /// The two sides that face the reader, down to the floor; nothing stands before them.
    fn draw_sides(&self, canvas: &mut Canvas) {
        let (rows, columns) = self.cells.luminescent.dim();
        let left = (1..columns).map(|j| [(0, j - 1), (0, j)]);
        let right = (1..rows).map(|i| [(i - 1, columns - 1), (i, columns - 1)]);
        for [from, to] in left.chain(right) {
            if [from, to].iter().all(|cell| self.cells.luminescent[*cell].is_finite()) {
                let corners = [
                    self.corner(from, 0.0),
                    self.corner(to, 0.0),
                    self.corner(to, self.up(to)),
                    self.corner(from, self.up(from)),
                ];
                canvas.facet(&corners, SIDE, OUTLINE);
            }
        }
    }

    /// The wall where the diagonal crosses the floor, with its axis at the right.
    fn draw_wall(&self, canvas: &mut Canvas) {
        let Some(scale) = self.wall.scale else { return };
        let on_floor =
            |nm: f64| [self.view.x, self.view.y].iter().all(|s| (-1e-9..=1.0 + 1e-9).contains(&s.position(nm)));
        let is_drawn = |k: &usize| self.wall.margin.values[*k].is_finite() && on_floor(self.wall.nm[*k]);
        let point = |k: usize, up: f64| self.view.point(self.wall.nm[k], self.wall.nm[k], up).0;
        let up = |k: usize| WALL_HEIGHT * scale.position(self.wall.margin.values[k]);
        let all: Vec<usize> = (0..self.wall.nm.len()).collect();
        for piece in all.split(|k| !is_drawn(k)).filter(|piece| !piece.is_empty()) {
            let top: Vec<_> = piece.iter().map(|k| point(*k, up(*k))).collect();
            let foot = piece.iter().rev().map(|k| point(*k, 0.0));
            canvas.polygon(&top.iter().copied().chain(foot).collect::<Vec<_>>(), SIDE, WALL_OPACITY);
            match piece {
                [only] => canvas.line(point(*only, 0.0), point(*only, up(*only)), INK, 2.0),
                _ => canvas.polyline(top, INK, 2.0),
            }
        }
        let ([_, x], [_, y]) = (ends(&self.view.x), ends(&self.view.y));
        let place = |value: f64| self.view.point(x, y, WALL_HEIGHT * scale.position(value)).0;
        canvas.line(place(scale.value(0.0)), place(scale.value(1.0)), INK, 1.2);
        for tick in scale.ticks(4) {
            let (x, y) = place(tick.value);
            canvas.line((x, y), (x + 5.0, y), INK, 1.0);
            canvas.text((x + 9.0, y + 4.5), &tick.label, Style::new(TICK_SIZE, TextAnchor::Start));
        }
        let (_, y) = place(scale.value(1.0));
        canvas.text((WIDTH - 24.0, y - 16.0), "↑ wall (unit 1)", Style::new(LABEL_SIZE, TextAnchor::End));
    }
}

fn draw_legend(canvas: &mut Canvas, cells: &Cells, y: f64) {
    let mut entry = |left: f64, text: &str, draw: &dyn Fn(&mut Canvas)| {
        draw(canvas);
        canvas.text((left + 32.0, y + 14.0), text, Style::new(TICK_SIZE, TextAnchor::Start));
    };
    if cells.reflected.iter().any(|value| value.is_finite()) {
        entry(24.0, "wall: next to the diagonal, reflected", &|canvas| {
            let area = swatch(24.0, y);
            canvas.rectangle(area, SIDE);
            canvas.line((area.left, area.top), (area.right(), area.top), INK, 2.0);
        });
    }
    if cells.is_marked.iter().any(|is_marked| *is_marked) {
        entry(340.0, "pale: leans on interpolated values", &|canvas| {
            canvas.rectangle(swatch(340.0, y), pale(kuva::render::color::Color::Rgb(0xb2, 0x18, 0x2b)));
        });
    }
}
