//! Pictures: figures as PNG and SVG, drawn with a font of their own, and one HTML page.
//!
//! *May use:* `validate`, `donaldson`, `cost`, `simulate`, `fit`, `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* a gap is drawn as a gap. What is interpolated is marked and labelled as interpolated, and no number on a
//! figure comes from anywhere but the document and its model.

mod angle_map;
mod angle_points;
mod bispectral;
mod canvas;
mod colour_bar;
mod colours;
mod curve;
mod design;
mod diagnosis;
mod error;
mod figure;
mod fitted;
mod frame;
mod histogram;
mod html;
mod ladder;
mod map;
mod page;
mod perspective;
mod scale;
mod scan;
mod separability;
mod spectrum;
mod spline;
mod subject;
mod surface;
mod ticks;
mod trade;

pub use angle_map::AngleMap;
pub use angle_points::AnglePoints;
pub use bispectral::{factor_figures, matrix_figures};
pub use curve::{Curve, CurveText, Points, dots_and_curve, line_in_band};
pub use design::{DesignPicture, design_figure};
pub use diagnosis::diagnosis_page;
pub use error::ReportError;
pub use figure::Figure;
pub use fitted::{Drawn, fitted_figures};
pub use histogram::histogram;
pub use ladder::ladder_figure;
pub use map::{angle_map, interpolated_map, residual_map};
pub use page::{Pictures, page};
pub use scan::scan_figures;
pub use spectrum::measurement_figures;
pub use surface::surface;
pub use trade::{Knob, Setting, trade};
