//! What bodies are made of, as a scene describes it.

use ndarray::Array2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::place::{NotAScene, Step};
use super::resolve::{Resolver, Source};
use crate::donaldson::Reradiation;
use crate::simulate::material::Material;
use crate::terms::{Term, TorranceSparrow};

/// Wavelengths that a reflectance which has none is stated between, nm: those a scene may have.
const ALL_NM: [f64; 2] = [200.0, 1100.0];

/// A material: one of `file`, `albedo` and `reflectance`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["file"]}, {"required": ["albedo"]}, {"required": ["reflectance"]}]))]
pub struct MaterialSection {
    /// What objects call it.
    pub name: String,
    /// A `.bbrf` file: its model, or its Donaldson matrix where it has no model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Which model of the file, where it has several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Which matrix of the file, without an interface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub matrix: Option<String>,
    /// A grey that sends this share of all light back into all directions alike.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub albedo: Option<f64>,
    /// The same by wavelength: a text of two columns (nm, share), or another spectrum that `bbrf import` reads.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reflectance: Option<String>,
    /// Reflection at the interface, instead of that of the file's model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular: Option<TorranceSparrow>,
}

impl MaterialSection {
    pub(super) fn resolve(self, at: Step<'_>, with: &mut Resolver<'_, '_>) -> Result<Material, NotAScene> {
        let way = [Step::Key("material"), at];
        let given = [self.file.is_some(), self.albedo.is_some(), self.reflectance.is_some()];
        with.one_of(&way, given, "`file`, `albedo` and `reflectance`")?;
        if self.file.is_none() && (self.model.is_some() || self.matrix.is_some()) {
            let key = if self.model.is_some() { "model" } else { "matrix" };
            return Err(with.error(&way, key, "found beside no `file`; expected the file that holds it"));
        }
        if self.model.is_some() && self.matrix.is_some() {
            return Err(with.error(
                &way,
                "matrix",
                "found `model`, too; expected one of them: a complete model has its matrix",
            ));
        }
        let mut material = if let Some(albedo) = self.albedo {
            if albedo < 0.0 {
                return Err(with.error(&way, "albedo", format!("found {albedo}; expected a number from 0")));
            }
            lambertian(&ALL_NM, vec![albedo; 2]).ok_or_else(|| with.error(&way, "albedo", "found no number"))?
        } else if let Some(file) = &self.reflectance {
            let points = with.library.reflectance(file).map_err(|why| with.error(&way, "reflectance", why))?;
            let points = with.said(&format!("material `{}`", self.name), points);
            let (nm, values): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            with.note_range(&format!("the reflectance of material `{}`", self.name), &nm);
            with.note_negative(&format!("the reflectance of material `{}`", self.name), &values);
            let why = "found fewer than two ascending wavelengths; expected a reflectance over a range";
            lambertian(&nm, values).ok_or_else(|| with.error(&way, "reflectance", why))?
        } else {
            let source = Source {
                file: self.file.as_deref().unwrap_or_default(),
                model: self.model.as_deref(),
                matrix: self.matrix.as_deref(),
                has_interface: self.specular.is_some(),
            };
            let found = with.library.material(&source).map_err(|why| with.error(&way, "file", why))?;
            with.said(&format!("material `{}`", self.name), found)
        };
        if let Some(term) = self.specular {
            Term::TorranceSparrow(term).check().map_err(|why| with.error(&way, "specular", why.to_string()))?;
            (material.specular, material.intensity) = (Some(term), Vec::new());
        }
        material.name = self.name;
        material.check().map_err(|why| with.error(&way, "name", why.to_string()))?;
        Ok(material)
    }
}

/// A surface that reflects diffusely, and does nothing else.
fn lambertian(nm: &[f64], values: Vec<f64>) -> Option<Material> {
    let shape = (nm.len(), nm.len());
    let surface = Reradiation::from_parts(nm.to_vec(), nm.to_vec(), values, Array2::zeros(shape)).ok()?;
    Some(Material { name: String::new(), surface, specular: None, intensity: Vec::new() })
}
