//! The whole model Y(V, L, emission, excitation) = Y_l + Y_d + Y_s: the terms of a fit say how light depends on the directions, a
//! separated matrix how it depends on both wavelengths.
//!
//! `Y_l = cos(theta_i) * sum over ex of density(ex, em) * integral of E * tent`, `Y_d = S_r(em) cos(theta_i) E(em)`,
//! `Y_s = c_s D G F / den * E(em)`: pi times the radiance under an irradiance E across the beam.

mod attach;
mod bispectral;
mod directional;
mod lit;
mod values;

pub use attach::{NotAttached, attach};
pub use bispectral::{Bispectral, OutsideExcitation, Reflected};
pub use lit::{Lit, Radiated};
pub use values::{CompleteTable, Incident, Values};

use self::directional::Directional;
use super::light::{Extend, Light};
use super::{NoMatrix, Reradiation};
use crate::dataset::{Attached, Document, Measurement, Model, NotComplete, ReflectanceSource, TermsError};
use crate::quantity::{Basis, ConversionRefused, CorrelatedOver, Geometry, Part, Reference};
use crate::terms::TorranceSparrow;

/// A model that says what a surface radiates in any direction under any light from any direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Complete {
    surface: Reradiation,
    directional: Directional,
    reflectance: ReflectanceSource,
    /// Relative standard uncertainty that all values of the matrix share, one per emission.
    pub(super) shared_relative: Vec<f64>,
    /// Of it what the values of one emission share, and those of others do not.
    pub(super) own_relative: Vec<f64>,
    /// Reflected light reaches cells of the matrix whose emission is less than this from the excitation, nm.
    pub(super) reach_nm: f64,
    findings: Vec<String>,
}

/// Why a model of a document cannot be evaluated as a complete one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoComplete {
    /// It has no matrix, or parts that do not go together.
    #[error(transparent)]
    Parts(#[from] NotComplete),
    /// The matrix is none.
    #[error(transparent)]
    Matrix(#[from] NoMatrix),
    /// A term lacks a parameter.
    #[error(transparent)]
    Terms(#[from] TermsError),
    /// The scan is not there.
    #[error("model `{model}` was fitted to measurement `{measurement}`, which is not in the document")]
    Scan {
        /// The model.
        model: String,
        /// The scan.
        measurement: String,
    },
    /// The matrix is relative to something else.
    #[error(
        "matrix `{measurement}` is relative to `{reference}` and its rows state no common geometry; expected same-geometry, or the \
         geometry, which is needed to convert it"
    )]
    Reference {
        /// The matrix.
        measurement: String,
        /// Its reference.
        reference: Reference,
    },
    /// The matrix has a reference that received no light.
    #[error("matrix `{measurement}`: {why}")]
    Refused {
        /// The matrix.
        measurement: String,
        /// Why.
        why: ConversionRefused,
    },
    /// Photons.
    #[error("matrix `{0}` counts photons; expected energy: `bbrf convert --basis energy` makes it")]
    Photons(String),
}

impl Complete {
    /// The complete model that a model of a document is, with its matrix.
    ///
    /// # Errors
    /// [`NoComplete`].
    pub fn of(document: &Document, model: &Model) -> Result<Self, NoComplete> {
        let parts = document.attached(model)?;
        let scan = document.measurement(model.measurement.as_str()).ok_or_else(|| NoComplete::Scan {
            model: model.id.to_string(),
            measurement: model.measurement.to_string(),
        })?;
        if parts.matrix.quantity.basis == Basis::Photon {
            return Err(NoComplete::Photons(parts.matrix.id.to_string()));
        }
        let geometry = parts.elastic.acquisitions[0].geometry.filter(is_above);
        let surface = Reradiation::of_stored(&parts)?;
        let factor = to_same_geometry(parts.matrix, geometry.as_ref())?;
        let surface = if factor == 1.0 { surface } else { surface.scaled(factor) };
        let reflectance = parts.attachment.reflectance;
        let has_interface = has_interface(scan);
        let directional = Directional::of(model, reflectance, has_interface, geometry)?;
        let mut complete = Self {
            shared_relative: shared_relative(parts.matrix, |_| true),
            own_relative: shared_relative(parts.matrix, |over| over == CorrelatedOver::Acquisitions),
            reach_nm: parts.factorisation.reach_nm,
            findings: surface.findings.clone(),
            surface,
            directional,
            reflectance,
        };
        complete.findings.extend(findings(model, scan, &parts, &complete.directional, geometry.is_some()));
        Ok(complete)
    }

    /// What it does to light, without its directions: S_r and S_l.
    #[must_use]
    pub fn surface(&self) -> &Reradiation {
        &self.surface
    }

    /// Centres of the emission, nm.
    #[must_use]
    pub fn emission_nm(&self) -> &[f64] {
        &self.surface.emission_nm
    }

    /// Where the diffuse reflectance comes from.
    #[must_use]
    pub fn reflectance(&self) -> ReflectanceSource {
        self.reflectance
    }

    /// What was missing or taken for granted, in words.
    #[must_use]
    pub fn findings(&self) -> &[String] {
        &self.findings
    }

    /// The same with the diffuse reflectance that counts: that of the terms, or that of the matrix less what the interface sends into
    /// its geometry. Uncertainties stay those of [`Complete::surface`].
    #[must_use]
    pub fn lambertian(&self) -> Reradiation {
        let mut surface = self.surface.clone();
        let elastic = (0..surface.elastic.len()).map(|emission| match self.reflectance {
            ReflectanceSource::Matrix => self.matrix_reflectance(emission).0,
            ReflectanceSource::Terms => self.directional.albedo(self.surface.emission_nm[emission]),
        });
        surface.elastic = elastic.collect();
        surface
    }

    /// The terms of the interface at each wavelength of the fit, nm; without a wavelength where it was fitted to one number.
    #[must_use]
    pub fn interface(&self) -> Vec<(Option<f64>, Vec<TorranceSparrow>)> {
        self.directional.interface()
    }

    /// The diffuse reflectance by the matrix at an emission, with its standard uncertainty: its elastic part, less what the interface
    /// sends into its geometry.
    pub(super) fn matrix_reflectance(&self, emission: usize) -> (f64, f64) {
        let surface = &self.surface;
        let (elastic, sigma) = (surface.elastic[emission], surface.elastic_sigma[emission]);
        let normal = Geometry::from_degrees(0.0, 0.0, 0.0, 0.0);
        let part =
            normal.ok().and_then(|normal| Some(self.directional.at(&normal).ok()?.at(surface.emission_nm[emission])));
        match part {
            Some(part) if part.in_matrix != 0.0 => (elastic - part.in_matrix, sigma.hypot(part.in_matrix_sigma)),
            _ => (elastic, sigma),
        }
    }

    /// The model under a light: what is integrated over the excitation is integrated once, for all directions.
    #[must_use]
    pub fn under(&self, light: &Light, extend: Extend) -> Lit<'_> {
        Lit::new(self, self.surface.under(light, extend))
    }
}

/// A geometry that a factor is defined at.
fn is_above(geometry: &Geometry) -> bool {
    !geometry.is_below_horizon() && geometry.incidence.cos_theta() > 0.0
}

/// True for a scan whose specular term is that of an interface, in its own unit: a factor that holds reflected light.
pub(super) fn has_interface(scan: &Measurement) -> bool {
    scan.quantity.kind.is_factor() && scan.quantity.part != Part::Luminescent
}

/// What the values of a matrix are multiplied with to be relative to a diffuser in their own geometry.
fn to_same_geometry(matrix: &Measurement, geometry: Option<&Geometry>) -> Result<f64, NoComplete> {
    let reference = matrix.quantity.reference;
    match (reference, geometry) {
        (Reference::SameGeometry | Reference::Unstated, _) => Ok(1.0),
        (_, None) => Err(NoComplete::Reference { measurement: matrix.id.to_string(), reference }),
        (_, Some(geometry)) => {
            let lit = reference.lit_fraction(geometry);
            let lit = lit.map_err(|why| NoComplete::Refused { measurement: matrix.id.to_string(), why })?;
            Ok(lit / geometry.incidence.cos_theta())
        }
    }
}

/// The shared components of a matrix, added in squares: one that is common to the wavelengths of a row only counts as if it were
/// common to all.
fn shared_relative(matrix: &Measurement, counts: impl Fn(CorrelatedOver) -> bool) -> Vec<f64> {
    let components = || matrix.uncertainty.components.iter().filter(|one| counts(one.correlated_over));
    let at = |j: usize| components().map(|one| one.relative_at(j).powi(2)).sum::<f64>().sqrt();
    (0..matrix.emission.len()).map(at).collect()
}

fn findings(
    model: &Model,
    scan: &Measurement,
    parts: &Attached<'_>,
    directional: &Directional,
    has_geometry: bool,
) -> Vec<String> {
    let mut list = Vec::new();
    if let (Some(of_scan), Some(of_matrix)) = (&scan.sample, &parts.matrix.sample)
        && of_scan != of_matrix
    {
        list.push(format!(
            "the scan is of sample `{of_scan}`, the matrix of sample `{of_matrix}`: whether they are one, no file says"
        ));
    }
    if parts.matrix.quantity.reference == Reference::Unstated {
        list.push(format!("matrix `{}` does not state its reference; taken as same-geometry", parts.matrix.id));
    }
    if !has_interface(scan) {
        list.push(format!(
            "scan `{}` holds {} of the part {}: it says nothing of reflection at the interface, and Y_s is 0",
            scan.id, scan.quantity.kind, scan.quantity.part
        ));
        return list;
    }
    if !directional.has_specular() {
        list.push(format!("the fit of scan `{}` saw no specular term: Y_s is 0", scan.id));
        return list;
    }
    let unknown = directional.unknown();
    if !unknown.is_empty() {
        list.push(format!(
            "the fit holds no covariance of {}: Y_s and Y have no standard uncertainty where it is needed",
            unknown.join(", ")
        ));
    }
    let emission = &parts.factorisation.emission.nm;
    match (directional.range_nm(), emission.first().zip(emission.last())) {
        (None, _) => list.push(format!(
            "the specular term was fitted to one number for all wavelengths ({}): taken as without colour",
            model.reduction
        )),
        (Some((low, high)), Some((first, last))) if *first < low || *last > high => list.push(format!(
            "the specular term was fitted from {low} to {high} nm and the matrix emits from {first} to {last} nm: outside its value is \
             that of the nearest wavelength"
        )),
        _ => {}
    }
    if parts.attachment.reflectance == ReflectanceSource::Matrix {
        list.push(if has_geometry {
            "the elastic part of the matrix holds what the interface sends into its geometry: the specular term there is taken \
             off it"
                .to_owned()
        } else {
            "the geometry of the matrix is not stated: its elastic part is taken as free of reflection at the interface".to_owned()
        });
    }
    list
}
