//! A material from a `.bbrf` file: a complete model, a model of reflection alone, or a Donaldson matrix without an interface.

use miette::miette;
use ndarray::Array2;

use crate::cli::command::donaldson::material as matrices;
use crate::cli::opened::open;
use crate::dataset::{Document, Model};
use crate::donaldson::{Complete, Luminescence, Reradiation};
use crate::quantity::{Basis, Part};
use crate::simulate::Material;
use crate::simulate::document::{Points, Source};
use crate::terms::{Term, TermKind, TorranceSparrow};

type Found = Result<(Material, Vec<String>), miette::Report>;

/// Wavelengths that a model of one band holds between, nm: those a scene may have.
const ALL_NM: [f64; 2] = [200.0, 1100.0];

/// The terms of the interface at each wavelength, nm, or in one band.
type Bands = Vec<(Option<f64>, Vec<TorranceSparrow>)>;

/// `path` is the file of `source` as it can be opened from here.
pub(super) fn load(path: &str, source: &Source<'_>) -> Found {
    if let Some(id) = source.matrix {
        return of_matrix(&format!("{path}#{id}"));
    }
    let document = open(path.as_ref())?.document;
    let ids = || document.models.iter().map(|model| model.id.to_string()).collect::<Vec<_>>().join(", ");
    match (source.model, document.models.as_slice()) {
        (Some(id), _) => {
            let model = document.model(id);
            of_model(
                path,
                source,
                &document,
                model
                    .ok_or_else(|| miette!("{path}: no model `{id}`; the file holds: {}", matrices::or_none(ids())))?,
            )
        }
        (None, [one]) => of_model(path, source, &document, one),
        (None, []) => {
            let ids: Vec<String> = matrices::choices(&document).iter().map(|one| one.id.to_string()).collect();
            if ids.len() > 1 {
                return Err(miette!(
                    "{path}: holds several matrices ({}); name one with `matrix = \"ID\"`",
                    ids.join(", ")
                ));
            }
            of_matrix(path)
        }
        (None, _) => Err(miette!("{path}: holds several models ({}); name one with `model = \"ID\"`", ids())),
    }
}

fn of_matrix(name: &str) -> Found {
    let loaded = matrices::load(name, None)?;
    if loaded.measurement.quantity.basis == Basis::Photon {
        return Err(miette!(
            "{name}: the matrix counts photons; expected energy: `bbrf convert --basis energy` makes it"
        ));
    }
    let surface = Reradiation::of(&loaded.matrix, &loaded.separated, Luminescence::Full);
    let remarks = loaded.separation.remark.into_iter().chain(surface.findings.iter().cloned()).collect();
    Ok((Material { name: String::new(), surface, specular: None, intensity: Vec::new() }, remarks))
}

fn of_model(path: &str, source: &Source<'_>, document: &Document, model: &Model) -> Found {
    let id = &model.id;
    if model.donaldson.is_some() {
        let complete = Complete::of(document, model).map_err(|error| miette!("{path}: {error}"))?;
        let (specular, intensity) =
            one_interface(source, &complete.interface()).map_err(|why| refused(path, id.as_str(), &why))?;
        let remarks = complete.findings().to_vec();
        return Ok((Material { name: String::new(), surface: complete.lambertian(), specular, intensity }, remarks));
    }
    let scan = document.measurement(model.measurement.as_str());
    let quantity = scan
        .map(|scan| &scan.quantity)
        .filter(|quantity| quantity.kind.is_factor() && quantity.part != Part::Luminescent);
    let quantity = quantity.ok_or_else(|| {
        miette!("{path}: model `{id}` was not fitted to a factor of reflection; expected one: its numbers are no share of the light")
    })?;
    let mut remarks = vec![format!("model `{id}` has no matrix: it reflects, and does not luminesce")];
    if quantity.part != Part::Elastic {
        remarks.push(format!(
            "model `{id}` was fitted to light of the part {}: what it radiated then counts as reflected",
            quantity.part
        ));
    }
    let (mut albedo, mut bands): (Vec<f64>, Bands) = (Vec::new(), Vec::new());
    let nm = model.emission.wavelengths();
    for emission in 0..model.emission.len() {
        let terms = model.terms_at(emission).map_err(|error| miette!("{path}, model `{id}`: {error}"))?;
        if emission == 0 && terms.iter().any(|term| term.kind() == TermKind::Luminescent) {
            remarks.push(format!(
                "model `{id}`: its luminescent term holds under the light of its scan alone, and is left out"
            ));
        }
        albedo.push(terms.iter().map(|term| if let Term::Lambertian { albedo } = term { *albedo } else { 0.0 }).sum());
        let interface =
            terms.iter().filter_map(|term| if let Term::TorranceSparrow(one) = term { Some(*one) } else { None });
        bands.push((nm.map(|nm| nm[emission]), interface.filter(|one| one.intensity != 0.0).collect()));
    }
    let (specular, intensity) = one_interface(source, &bands).map_err(|why| refused(path, id.as_str(), &why))?;
    let nm = match (nm, albedo.as_slice()) {
        (Some(nm), [_, _, ..]) => nm.to_vec(),
        (_, [one]) => {
            remarks.push(format!(
                "model `{id}` was fitted to one number for all wavelengths ({}): taken as without colour",
                model.reduction
            ));
            albedo = vec![*one; 2];
            ALL_NM.to_vec()
        }
        _ => {
            return Err(miette!(
                "{path}: model `{id}` has several values and no wavelengths; expected a spectrum or one number"
            ));
        }
    };
    let shape = (nm.len(), nm.len());
    let surface = Reradiation::from_parts(nm.clone(), nm, albedo, Array2::zeros(shape))
        .map_err(|error| miette!("{path}, model `{id}`: {error}"))?;
    Ok((Material { name: String::new(), surface, specular, intensity }, remarks))
}

fn refused(path: &str, id: &str, why: &str) -> miette::Report {
    miette!(
        help = "`bbrf fit --share shape` fits roughness and index that the wavelengths share; or state `specular` for the material",
        "{path}, model `{id}`: {why}; expected one term, with one roughness and one index for all wavelengths"
    )
}

/// The one term of all wavelengths, and its intensity at each; nothing where the scene states its own.
fn one_interface(source: &Source<'_>, bands: &Bands) -> Result<(Option<TorranceSparrow>, Points), String> {
    if source.has_interface {
        return Ok((None, Vec::new()));
    }
    if let Some((_, several)) = bands.iter().find(|(_, terms)| terms.len() > 1) {
        return Err(format!("found {} specular terms", several.len()));
    }
    let Some(first) = bands.iter().find_map(|(_, terms)| terms.first().copied()) else { return Ok((None, Vec::new())) };
    let shape = |term: &TorranceSparrow| TorranceSparrow { intensity: 1.0, ..*term };
    if let Some(other) = bands.iter().flat_map(|(_, terms)| terms).find(|term| shape(term) != shape(&first)) {
        return Err(format!(
            "the specular term differs between wavelengths: roughness {} and index {}, and elsewhere {} and {}",
            first.roughness, first.refractive_index, other.roughness, other.refractive_index
        ));
    }
    let intensity: Vec<(f64, f64)> = bands
        .iter()
        .filter_map(|(nm, terms)| Some(((*nm)?, terms.first().map_or(0.0, |term| term.intensity))))
        .collect();
    let constant = intensity.iter().all(|(_, c)| *c == first.intensity);
    Ok((Some(first), if constant { Vec::new() } else { intensity }))
}
