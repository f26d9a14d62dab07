//! The matrix as a map, emission to the right and excitation upwards, with its sums above and beside it.

use kuva::render::render::TextAnchor;

use super::cells::{Cells, swatch};
use super::margins::{next_to_diagonal, over_emission, over_excitation};
use super::panel::{Along, draw_margin, scale_of};
use super::strongest;
use crate::report::canvas::{Area, Canvas, INK, MEASURED, Style};
use crate::report::colour_bar::{BAR_HEIGHT, draw_colour_bar};
use crate::report::frame::{Frame, Labels, TICK_SIZE, draw_titles};
use crate::report::html::significant;
use crate::report::map::{draw_mark, edges, ends, overlapping};
use crate::report::scale::Scale;
use crate::report::{Figure, ReportError};

/// Width of the sheet; left edge and side of the map, and what lies around it.
const WIDTH: f64 = 780.0;
const LEFT: f64 = 84.0;
const SIDE: f64 = 500.0;
const ABOVE: f64 = 120.0;
const BESIDE: f64 = 150.0;
const GAP: f64 = 14.0;
const BELOW: f64 = 238.0;
/// Room for the label of the excitation between the upper panel and the map.
const BETWEEN: f64 = 36.0;
/// A gap between the lines of the hatching of what has no value.
const HATCHING: f64 = 7.0;

/// The map with both margins.
///
/// # Errors
/// [`ReportError::Empty`] when no cell has a value.
pub(super) fn bispectral_map(cells: &Cells, subject: &str) -> Result<Figure, ReportError> {
    let drawn = cells.thinned();
    let luminescent = drawn.luminescent_colours();
    let reflected = drawn.reflected_colours();
    if luminescent.is_none() && reflected.is_none() {
        return Err(ReportError::Empty { figure: format!("measurement `{}`: its map", cells.id) });
    }
    let title = format!("{subject}: Donaldson matrix");
    let subtitle = format!("{}{}", counts(cells), drawn.blocks_in_words());
    let labels = Labels {
        title: &title,
        subtitle: &subtitle,
        x: "emission wavelength (nm)",
        y: "radiance factor under light of equal energy (unit 1)",
    };
    let upper = Area::new(LEFT, labels.height(SIDE + BESIDE), SIDE, ABOVE);
    let area = Area::new(LEFT, upper.bottom() + BETWEEN, SIDE, SIDE);
    let right = Area::new(area.right() + GAP, area.top, BESIDE, SIDE);
    let mut canvas = Canvas::new(WIDTH, area.bottom() + BELOW);
    let (emission, excitation) = (edges(&drawn.emission_nm), edges(&drawn.excitation_nm));
    let (x, y) = (ends(&emission), ends(&excitation));
    let frame = Frame::with_ticks(area, (x, 7), (y, 7));
    draw_titles(&mut canvas, SIDE + BESIDE, &labels);
    canvas.hatch(area, HATCHING);
    for ((i, j), value) in drawn.luminescent.indexed_iter() {
        let (left, bottom) = frame.point(emission[j], excitation[i]);
        let (to, top) = frame.point(emission[j + 1], excitation[i + 1]);
        let cell = Area::new(left, top, to - left, bottom - top);
        let colour = match (luminescent, reflected) {
            (Some(colours), _) if value.is_finite() => colours.colour(*value),
            (_, Some(colours)) if drawn.reflected[(i, j)].is_finite() => colours.colour(drawn.reflected[(i, j)]),
            _ => continue,
        };
        canvas.rectangle(overlapping(cell), colour);
        if drawn.is_marked[(i, j)] {
            draw_mark(&mut canvas, cell);
        }
    }
    frame.draw_axes(&mut canvas, &Labels { title: "", subtitle: "", x: labels.x, y: "excitation wavelength (nm)" });
    draw_upper(&mut canvas, cells, upper, x, &labels);
    draw_right(&mut canvas, cells, right, y);
    let bars = area.bottom() + 74.0;
    if let Some(colours) = luminescent {
        draw_colour_bar(&mut canvas, Area::new(LEFT, bars, 400.0, BAR_HEIGHT), colours, "value (unit 1)");
    }
    if let Some(colours) = reflected {
        draw_colour_bar(&mut canvas, Area::new(LEFT + 470.0, bars, 190.0, BAR_HEIGHT), colours, "next to the diagonal");
    }
    draw_legend(&mut canvas, &drawn, area.bottom() + 154.0);
    let caption = format!(
        "{title} over excitation and emission. {} Below the excitation no light can be: what is there is noise, negative \
         values in blue. {}Above: radiance factor under light of equal energy; right: luminescent energy out over energy in. \
         Bands are standard uncertainties {}. A sum has a gap where a cell that may hold light has no value.",
        strongest(cells),
        diagonal(cells),
        bands(cells)
    );
    Ok(Figure::new("bispectral-map", caption, canvas.finish()))
}

/// What the cells next to the diagonal are, if there are any.
fn diagonal(cells: &Cells) -> &'static str {
    if cells.reflected.iter().any(|value| value.is_finite()) {
        "Next to the diagonal, in greys, lies reflected light and what luminescence there is; the sums of the luminescence leave \
         these cells out. "
    } else {
        ""
    }
}

/// Where the uncertainties of the sums come from.
fn bands(cells: &Cells) -> String {
    match &cells.sigma {
        Some(_) => "from those stated, taken for independent".to_owned(),
        None if cells.floor.rms.is_finite() => "from the noise below the excitation, taken for independent".to_owned(),
        None => "that are not known, and so not drawn".to_owned(),
    }
}

fn counts(cells: &Cells) -> String {
    let finite = |table: &ndarray::Array2<f64>| table.iter().filter(|value| value.is_finite()).count();
    let (clear, diagonal) = (finite(&cells.luminescent), finite(&cells.reflected));
    let missing = cells.luminescent.len() - clear - diagonal;
    let mut text = match diagonal {
        0 => format!("{clear} luminescent cells"),
        _ => format!("{clear} cells clear of reflected light, {diagonal} next to the diagonal"),
    };
    if missing > 0 {
        text.push_str(&format!(", {missing} without value"));
    }
    if cells.floor.rms.is_finite() {
        text.push_str(&format!("; noise below the excitation {} r.m.s.", significant(cells.floor.rms, 2)));
    }
    text
}

fn draw_upper(canvas: &mut Canvas, cells: &Cells, area: Area, x: Scale, labels: &Labels<'_>) {
    let (luminescent, diagonal) = (over_emission(cells), next_to_diagonal(cells));
    let drawn: Vec<_> = luminescent.iter().chain(std::iter::once(&diagonal)).collect();
    let y = scale_of(&drawn).unwrap_or(Scale::Linear { from: 0.0, to: 1.0 });
    let frame = Frame::with_ticks(area, (x, 0), (y, 4));
    frame.draw_grid(canvas);
    draw_margin(canvas, &frame, &cells.emission_nm, &diagonal, Along::Across, INK);
    match &luminescent {
        Some(margin) => draw_margin(canvas, &frame, &cells.emission_nm, margin, Along::Across, MEASURED),
        None => no_sum(canvas, area, "no sum over one excitation"),
    }
    frame.draw_axes(canvas, &Labels { title: "", subtitle: "", x: "", y: labels.y });
}

fn draw_right(canvas: &mut Canvas, cells: &Cells, area: Area, y: Scale) {
    let margin = over_excitation(cells);
    let x = margin.as_ref().and_then(|margin| scale_of(&[margin])).unwrap_or(Scale::Linear { from: 0.0, to: 1.0 });
    let frame = Frame::with_ticks(area, (x, 3), (y, 0));
    frame.draw_grid(canvas);
    match &margin {
        Some(margin) => draw_margin(canvas, &frame, &cells.excitation_nm, margin, Along::Up, MEASURED),
        None => no_sum(canvas, area, "no sum over"),
    }
    frame.draw_axes(canvas, &Labels { title: "", subtitle: "", x: "out / in (unit 1)", y: "" });
}

fn no_sum(canvas: &mut Canvas, area: Area, text: &str) {
    let (x, y) = area.centre();
    canvas.text((x, y), text, Style::new(TICK_SIZE, TextAnchor::Middle).muted());
}

fn draw_legend(canvas: &mut Canvas, cells: &Cells, y: f64) {
    let text = |canvas: &mut Canvas, left: f64, y: f64, text: &str| {
        canvas.text((left + 32.0, y + 14.0), text, Style::new(TICK_SIZE, TextAnchor::Start));
    };
    let line = |canvas: &mut Canvas, y: f64, colour| canvas.line((LEFT, y + 9.0), (LEFT + 24.0, y + 9.0), colour, 2.2);
    let is_mixed = cells.reflected.iter().any(|value| value.is_finite());
    let without = if is_mixed { ", without what lies next to the diagonal" } else { "" };
    line(canvas, y, MEASURED);
    text(canvas, LEFT, y, &format!("luminescent{without}; band: ± standard uncertainty"));
    if is_mixed {
        line(canvas, y + 26.0, INK);
        text(canvas, LEFT, y + 26.0, "next to the diagonal: reflected light with the luminescence of these cells");
    }
    let is_missing = cells.luminescent.indexed_iter().any(|(cell, _)| cells.is_missing(cell));
    let (y, mut left) = (y + 52.0, LEFT);
    if is_missing {
        canvas.hatch(swatch(left, y), HATCHING);
        canvas.outline(swatch(left, y), INK, 0.8);
        text(canvas, left, y, "no value");
        left += 130.0;
    }
    if cells.is_marked.iter().any(|is_marked| *is_marked) {
        draw_mark(canvas, swatch(left, y));
        text(canvas, left, y, "interpolated");
    }
}
