//! What the terms of a fit say at any emission wavelength: straight between theirs, and at the nearest outside.

use super::super::piecewise::place;
use crate::dataset::{Look, Model, ParameterCovariance, ReflectanceSource, TermsError, predict};
use crate::quantity::{Geometry, Reference};
use crate::terms::{Term, TermKind, TorranceSparrow, Undefined};

/// The elastic terms of a fit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Directional {
    /// Their wavelengths, nm; empty for one band.
    nm: Vec<f64>,
    /// Terms of each, with the covariance of their parameters.
    bands: Vec<(Vec<Term>, ParameterCovariance)>,
    has_specular: bool,
    /// What the diffuse reflectance is taken from.
    reflectance: ReflectanceSource,
    /// Where the matrix was measured: what the interface sends there is in its elastic part.
    matrix_geometry: Option<Geometry>,
}

/// What is reflected at one geometry and wavelength, over the irradiance across the beam.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Part {
    /// The Lambertian terms; 0 where the reflectance is the matrix's.
    pub(super) diffuse: f64,
    /// Standard uncertainty of it; NaN where the covariance of the fit does not say.
    pub(super) diffuse_sigma: f64,
    /// The specular terms.
    pub(super) specular: f64,
    /// Standard uncertainty of it.
    pub(super) specular_sigma: f64,
    /// What the specular terms add to the matrix's elastic radiance factor.
    pub(super) in_matrix: f64,
    /// Standard uncertainty of it.
    pub(super) in_matrix_sigma: f64,
    /// Standard uncertainty of diffuse plus specular, less what the cosine of the incidence takes of the interface in the matrix.
    pub(super) sum_sigma: f64,
    /// Standard uncertainty of the same that all values of the fit share.
    pub(super) shared_sigma: f64,
}

impl Part {
    /// Nothing is known, as where a term is undefined.
    pub(super) const UNKNOWN: Self = Self {
        diffuse: f64::NAN,
        diffuse_sigma: f64::NAN,
        specular: f64::NAN,
        specular_sigma: f64::NAN,
        in_matrix: f64::NAN,
        in_matrix_sigma: f64::NAN,
        sum_sigma: f64::NAN,
        shared_sigma: f64::NAN,
    };

    /// A point on the straight line to another. Errors of neighbouring wavelengths go together: they add up.
    fn towards(self, other: Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| if part == 0.0 { a } else { a + part * (b - a) };
        Self {
            diffuse: mix(self.diffuse, other.diffuse),
            diffuse_sigma: mix(self.diffuse_sigma, other.diffuse_sigma),
            specular: mix(self.specular, other.specular),
            specular_sigma: mix(self.specular_sigma, other.specular_sigma),
            in_matrix: mix(self.in_matrix, other.in_matrix),
            in_matrix_sigma: mix(self.in_matrix_sigma, other.in_matrix_sigma),
            sum_sigma: mix(self.sum_sigma, other.sum_sigma),
            shared_sigma: mix(self.shared_sigma, other.shared_sigma),
        }
    }
}

impl Directional {
    /// The terms of a model; with `has_interface` false its specular terms are none of an interface and are left out.
    pub(super) fn of(
        model: &Model,
        reflectance: ReflectanceSource,
        has_interface: bool,
        matrix_geometry: Option<Geometry>,
    ) -> Result<Self, TermsError> {
        let band = |emission: usize| {
            let mut terms = model.terms_at(emission)?;
            if !has_interface {
                // Without light they add nothing, and keep their place in the covariance.
                terms.iter_mut().for_each(darken);
            }
            Ok((terms, model.parameter_covariance(emission)))
        };
        let bands = (0..model.emission.len()).map(band).collect::<Result<Vec<_>, TermsError>>()?;
        let is_specular = |term: &Term| is_lit(term) && term.kind() == TermKind::TorranceSparrow;
        let has_specular = bands.iter().any(|(terms, _)| terms.iter().any(is_specular));
        let nm = model.emission.wavelengths().map(<[f64]>::to_vec).unwrap_or_default();
        Ok(Self { nm, bands, has_specular, reflectance, matrix_geometry })
    }

    /// True where a specular term is among them.
    pub(super) fn has_specular(&self) -> bool {
        self.has_specular
    }

    /// What its Lambertian terms reflect at a wavelength, nm, of light along the normal.
    pub(super) fn albedo(&self, nm: f64) -> f64 {
        let diffuse = |(terms, _): &(Vec<Term>, ParameterCovariance)| {
            let albedo = |term: &Term| if let Term::Lambertian { albedo } = term { *albedo } else { 0.0 };
            Part { diffuse: terms.iter().map(albedo).sum(), ..Part::default() }
        };
        Angular { nm: &self.nm, parts: self.bands.iter().map(diffuse).collect() }.at(nm).diffuse
    }

    /// The specular terms of each wavelength, nm; those without intensity are left out.
    pub(super) fn interface(&self) -> Vec<(Option<f64>, Vec<TorranceSparrow>)> {
        let lit = |term: &Term| match term {
            Term::TorranceSparrow(specular) if specular.intensity != 0.0 => Some(*specular),
            _ => None,
        };
        let of = |(k, (terms, _)): (usize, &(Vec<Term>, ParameterCovariance))| {
            (self.nm.get(k).copied(), terms.iter().filter_map(lit).collect())
        };
        self.bands.iter().enumerate().map(of).collect()
    }

    /// Parameters without a covariance that the uncertainty of the specular terms needs.
    pub(super) fn unknown(&self) -> Vec<String> {
        let Ok(geometry) = Geometry::from_degrees(45.0, 180.0, 40.0, 0.0) else { return Vec::new() };
        let look = Look { weight: 1.0, geometry, reference: Reference::None };
        let of = |(terms, covariance): &(Vec<Term>, ParameterCovariance)| {
            covariance.of_sum(terms, &[look], |kind| kind == TermKind::TorranceSparrow).ok()
        };
        let mut all: Vec<String> = self.bands.iter().filter_map(of).flat_map(|one| one.unknown).collect();
        all.sort();
        all.dedup();
        all
    }

    /// First and last wavelength, nm; `None` for one band.
    pub(super) fn range_nm(&self) -> Option<(f64, f64)> {
        Some((*self.nm.first()?, *self.nm.last()?))
    }

    /// At one geometry, for all wavelengths.
    ///
    /// # Errors
    /// [`Undefined`] where a term has no value.
    pub(super) fn at(&self, geometry: &Geometry) -> Result<Angular<'_>, Undefined> {
        let parts = self.bands.iter().map(|(terms, covariance)| self.part(terms, covariance, geometry));
        Ok(Angular { nm: &self.nm, parts: parts.collect::<Result<_, _>>()? })
    }

    /// At one geometry, for all wavelengths, without uncertainties: each of them is [`Part::UNKNOWN`]'s.
    ///
    /// # Errors
    /// [`Undefined`] where a term has no value.
    pub(super) fn values_at(&self, geometry: &Geometry) -> Result<Angular<'_>, Undefined> {
        let parts = self.bands.iter().map(|(terms, _)| self.values(terms, geometry));
        Ok(Angular { nm: &self.nm, parts: parts.collect::<Result<_, _>>()? })
    }

    fn is_diffuse(&self, kind: TermKind) -> bool {
        self.reflectance == ReflectanceSource::Terms && kind == TermKind::Lambertian
    }

    /// Where the matrix was measured, as a look of the terms.
    fn there(&self) -> Option<Look> {
        let geometry = self.matrix_geometry?;
        Some(Look { weight: 1.0, geometry, reference: Reference::SameGeometry })
    }

    fn values(&self, terms: &[Term], geometry: &Geometry) -> Result<Part, Undefined> {
        let value = |look: &Look, counts: &dyn Fn(TermKind) -> bool| -> Result<f64, Undefined> {
            let counted: Vec<Term> = terms.iter().copied().filter(|term| is_lit(term) && counts(term.kind())).collect();
            Ok(look.weight * predict(&counted, &look.geometry, &look.reference)?.total())
        };
        let here = Look { weight: 1.0, geometry: *geometry, reference: Reference::None };
        Ok(Part {
            specular: value(&here, &is_specular)?,
            diffuse: value(&here, &|kind| self.is_diffuse(kind))?,
            in_matrix: self.there().map_or(Ok(0.0), |there| value(&there, &is_specular))?,
            ..Part::UNKNOWN
        })
    }

    fn part(&self, terms: &[Term], covariance: &ParameterCovariance, geometry: &Geometry) -> Result<Part, Undefined> {
        let is_diffuse = |kind: TermKind| self.is_diffuse(kind);
        let here = Look { weight: 1.0, geometry: *geometry, reference: Reference::None };
        let sigma = |looks: &[Look], counts: &dyn Fn(TermKind) -> bool| -> Result<(f64, f64), Undefined> {
            let counts = |kind: TermKind| counts(kind) && (kind != TermKind::TorranceSparrow || self.has_specular);
            let known = covariance.of_sum(terms, looks, counts)?;
            Ok((known.standard.unwrap_or(f64::NAN), known.shared_relative.unwrap_or(0.0)))
        };
        let values = self.values(terms, geometry)?;
        let (specular_sigma, _) = sigma(&[here], &is_specular)?;
        let (diffuse_sigma, _) = sigma(&[here], &is_diffuse)?;
        let (mut in_matrix_sigma, mut looks) = (0.0, vec![here]);
        if let Some(there) = self.there() {
            (in_matrix_sigma, _) = sigma(&[there], &is_specular)?;
            // Where the terms say the reflectance, that of the matrix is not used, whatever is in it.
            if self.reflectance == ReflectanceSource::Matrix {
                looks.push(Look { weight: -geometry.incidence.cos_theta(), ..there });
            }
        }
        let (sum_sigma, shared) = sigma(&looks, &|kind| is_specular(kind) || is_diffuse(kind))?;
        let sum = values.diffuse + values.specular + looks.get(1).map_or(0.0, |less| less.weight * values.in_matrix);
        let shared_sigma = (shared * sum).abs();
        Ok(Part { diffuse_sigma, specular_sigma, in_matrix_sigma, sum_sigma, shared_sigma, ..values })
    }
}

fn is_specular(kind: TermKind) -> bool {
    kind == TermKind::TorranceSparrow
}

/// A specular term without intensity.
fn darken(term: &mut Term) {
    if let Term::TorranceSparrow(specular) = term {
        specular.intensity = 0.0;
    }
}

fn is_lit(term: &Term) -> bool {
    !matches!(term, Term::TorranceSparrow(specular) if specular.intensity == 0.0)
}

/// The terms at one geometry.
#[derive(Debug, Clone)]
pub(super) struct Angular<'a> {
    nm: &'a [f64],
    parts: Vec<Part>,
}

impl Angular<'_> {
    /// At an emission wavelength, nm.
    pub(super) fn at(&self, nm: f64) -> Part {
        let last = self.parts.len().saturating_sub(1);
        let of = |k: usize| self.parts.get(k).copied().unwrap_or_default();
        // One band holds at every wavelength.
        if self.nm.len() != self.parts.len() || last == 0 {
            return of(0);
        }
        match place(self.nm, nm) {
            Some((low, high, part)) => of(low).towards(of(high), part),
            None if nm > self.nm[0] => of(last),
            None => of(0),
        }
    }
}
