//! A list of geometries: the angle columns of a table CSV, whatever other columns of that table stand beside them.

use std::path::Path;

use super::angles::{Angles, Written};
use super::error::{ImportError, fault_of};
use super::keys::Settings;
use super::rows::{Row, Rows};
use super::source::Source;
use super::table_csv::COLUMNS;
use crate::quantity::Geometry;

/// One row of a list of geometries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeometryRow {
    /// The line it stands in, from 1.
    pub line: u64,
    /// The geometry. Directions below the horizon are allowed: terms are 0 there.
    pub geometry: Geometry,
    /// The signed angles (incidence, viewing) in degrees as the source writes them, where it does.
    pub signed: Option<(f64, f64)>,
}

/// Reads the geometries of a table CSV: `theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg`, or `theta_i_deg,theta_v_deg`
/// under `# angles: signed, mirror-at-equal`.
///
/// # Errors
/// [`ImportError`] with the line for what cannot be read, and for signed angles without a declared convention.
pub fn read_geometries(path: &Path) -> Result<Vec<GeometryRow>, ImportError> {
    let source = Source::read(path, &path.display().to_string())?;
    let mut settings = Settings::default();
    let rows = Rows::from_csv(&source, &mut settings, COLUMNS)?;
    rows.iter().map(|row| geometry(&row, settings.angles)).collect()
}

fn geometry(row: &Row<'_>, declared: Option<Angles>) -> Result<GeometryRow, ImportError> {
    let written = row.angles()?.ok_or_else(|| row.bad("angles", "", "the angles of a geometry"))?;
    let (geometry, signed) = match written {
        Written::Full([ti, pi, tv, pv]) if !matches!(declared, Some(Angles::Signed(_))) => {
            let geometry = Geometry::from_degrees(ti, pi, tv, pv)
                .map_err(|error| ImportError::Malformed(fault_of(row.place(), &error, "correct the angle")))?;
            (geometry, None)
        }
        Written::Full(_) => (written.geometry(declared, &row.place())?, None),
        Written::Signed(theta_i, theta_v) => (written.geometry(declared, &row.place())?, Some((theta_i, theta_v))),
    };
    Ok(GeometryRow { line: row.line, geometry, signed })
}
