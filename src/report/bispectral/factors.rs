//! The stored factors of a matrix: excitation spectra above, emission spectra below.

use ndarray::{ArrayView1, Axis};

use super::margins::Margin;
use super::panel::{Along, draw_margin, scale_of};
use crate::dataset::{Document, Factorisation};
use crate::report::canvas::{Area, Canvas, LINES, Style};
use crate::report::fitted::Drawn;
use crate::report::frame::{Frame, Labels, TICK_SIZE};
use crate::report::html::significant;
use crate::report::scale::Scale;
use crate::report::{Figure, ReportError, subject};
use kuva::render::render::TextAnchor;

const WIDTH: f64 = 720.0;
const LEFT: f64 = 84.0;
const ACROSS: f64 = 612.0;
const HEIGHT: f64 = 210.0;
/// From the bottom of one panel to the top of the next.
const BETWEEN: f64 = 92.0;

/// The factors of a matrix, as they are stored.
#[must_use]
pub fn factor_figures(document: &Document, part: &Factorisation) -> Drawn {
    let mut drawn = Drawn::default();
    drawn.take(figure(document, part));
    drawn.prefixed(part.id.as_str())
}

fn figure(document: &Document, part: &Factorisation) -> Result<Figure, ReportError> {
    let name = format!("factorisation `{}`: its spectra", part.id);
    let rank = part.excitation.nrows();
    let same = |what: &'static str, found: (usize, usize), expected: (usize, usize)| {
        let (found, expected) = (found.0 * found.1, expected.0 * expected.1);
        if found == expected {
            Ok(())
        } else {
            Err(ReportError::Lengths { figure: name.clone(), what, found, expected })
        }
    };
    let (excitation_nm, emission_nm) = (&part.excitation_nm, &part.emission.nm);
    for (what, found) in [("excitation", part.excitation.dim()), ("excitation_u", part.excitation_u.dim())] {
        same(what, found, (rank, excitation_nm.len()))?;
    }
    for (what, found) in [("emission", part.emission_factor.dim()), ("emission_u", part.emission_factor_u.dim())] {
        same(what, found, (rank, emission_nm.len()))?;
    }
    let margins = |values: &ndarray::ArcArray2<f64>, sigma: &ndarray::ArcArray2<f64>| {
        let list = |row: ArrayView1<'_, f64>| row.to_vec();
        let rows = values.axis_iter(Axis(0)).zip(sigma.axis_iter(Axis(0)));
        rows.map(|(values, sigma)| Margin { values: list(values), sigma: list(sigma) }).collect::<Vec<_>>()
    };
    let excitation = margins(&part.excitation, &part.excitation_u);
    let emission = margins(&part.emission_factor, &part.emission_factor_u);
    let empty = || ReportError::Empty { figure: name.clone() };
    let measurement = document.measurement(part.measurement.as_str());
    let subject = measurement.map_or(part.measurement.to_string(), |one| subject::of_measurement(document, one));
    let title = format!("{subject}: factors of the luminescence");
    let subtitle = format!(
        "{} as stored; r.m.s. of what is left {}, noise {}",
        if rank == 1 { "one factor".to_owned() } else { format!("{rank} factors") },
        significant(part.residual_rms, 2),
        significant(part.floor, 2)
    );
    let upper =
        Labels { title: &title, subtitle: &subtitle, x: "excitation wavelength (nm)", y: "excitation factor (unit 1)" };
    let lower = Labels { title: "", subtitle: "", x: "emission wavelength (nm)", y: "emission factor (unit 1)" };
    let first = Area::new(LEFT, upper.height(ACROSS), ACROSS, HEIGHT);
    let second = Area::new(LEFT, first.bottom() + BETWEEN, ACROSS, HEIGHT);
    let mut canvas = Canvas::new(WIDTH, second.bottom() + 96.0);
    for (area, labels, nm, spectra) in
        [(first, upper, excitation_nm, excitation), (second, lower, emission_nm, emission)]
    {
        let y = scale_of(&spectra.iter().collect::<Vec<_>>()).ok_or_else(empty)?;
        let x = Scale::linear_over(nm.iter().copied()).ok_or_else(empty)?;
        let frame = Frame::with_ticks(area, (x, 7), (y, 5));
        frame.draw_grid(&mut canvas);
        for (k, margin) in spectra.iter().enumerate() {
            draw_margin(&mut canvas, &frame, nm, margin, Along::Across, LINES[k % LINES.len()].clone());
        }
        frame.draw_axes(&mut canvas, &labels);
    }
    draw_legend(&mut canvas, rank, second.bottom() + 78.0);
    let caption = format!(
        "{title}, as stored in `{}`. The luminescence of a cell is the sum over the factors of excitation times emission. Each excitation \
         spectrum is 1 where its luminescence is strongest. Bands are standard uncertainties.",
        part.id
    );
    Ok(Figure::new("spectra", caption, canvas.finish()))
}

fn draw_legend(canvas: &mut Canvas, rank: usize, y: f64) {
    for (k, colour) in LINES.iter().enumerate().take(rank) {
        let left = LEFT + 110.0 * k as f64;
        canvas.line((left, y - 5.0), (left + 26.0, y - 5.0), colour.clone(), 2.2);
        canvas.text((left + 34.0, y), &format!("factor {k}"), Style::new(TICK_SIZE, TextAnchor::Start));
    }
}
