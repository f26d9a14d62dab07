//! What `bbrf eval` prints of a complete model.

use schemars::JsonSchema;
use serde::Serialize;

use crate::dataset::ReflectanceSource;
use crate::donaldson::{Bispectral, Complete, Incident, Lit, OutsideExcitation, Radiated, Values};
use crate::import::GeometryRow;
use crate::quantity::{Geometry, QuantityKind};

/// What `--json` prints of a complete model. Standard uncertainties (k = 1) are from the independent errors of matrix and scan;
/// `null` where a value is not known.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct EvalCompleteResult {
    /// Where the diffuse reflectance comes from.
    reflectance: ReflectanceSource,
    /// Centres of the emission, nm, in the order of the lists.
    emission_nm: Vec<f64>,
    /// What was missing or taken for granted.
    findings: Vec<String>,
    /// With `--light`: pi times the radiance under it, for each geometry.
    #[serde(skip_serializing_if = "Option::is_none")]
    under: Option<UnderResult>,
    /// With `--excitation`: what light of one wavelength becomes, for each geometry and excitation.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    excited: Vec<ExcitedResult>,
}

/// Under a light.
#[derive(Debug, Serialize, JsonSchema)]
struct UnderResult {
    /// The light, as it was named.
    light: String,
    /// W m-2 nm-1 under a spectral irradiance across the beam, else 1: that of a relative light.
    unit: String,
    /// What falls in across the beam, seen through the bandpass of the emission.
    irradiance: Vec<f64>,
    /// Where the light has no value although it would matter, in words.
    unlit: Vec<String>,
    rows: Vec<UnderRow>,
}

/// One geometry under a light; lists have one number per emission. Without uncertainties where `--values` asks for none.
#[derive(Debug, Serialize, JsonSchema)]
struct UnderRow {
    #[serde(flatten)]
    angles: Angles,
    luminescent: Vec<Option<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    luminescent_standard_uncertainty: Vec<Option<f64>>,
    /// Reflected diffusely.
    diffuse: Vec<Option<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    diffuse_standard_uncertainty: Vec<Option<f64>>,
    /// Reflected at the interface.
    specular: Vec<Option<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    specular_standard_uncertainty: Vec<Option<f64>>,
    /// The three together.
    total: Vec<Option<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    total_standard_uncertainty: Vec<Option<f64>>,
    /// Standard uncertainty of the total that its values share (scales of matrix and scan); not contained in the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    total_shared_standard_uncertainty: Vec<Option<f64>>,
    /// Why the specular part has no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    undefined: Option<String>,
}

/// One geometry and excitation, over the irradiance across the beam.
#[derive(Debug, Serialize, JsonSchema)]
struct ExcitedResult {
    #[serde(flatten)]
    angles: Angles,
    /// The wavelength that falls in, nm.
    excitation_nm: f64,
    /// Luminescence as a density, nm-1, one per emission.
    luminescent: Vec<Option<f64>>,
    luminescent_standard_uncertainty: Vec<Option<f64>>,
    /// What is reflected at the wavelength of the excitation; `null` where the matrix does not emit.
    reflected: Option<ReflectedResult>,
    /// Why the specular part has no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    undefined: Option<String>,
}

/// A line at the excitation, dimensionless: Y/E.
#[derive(Debug, Serialize, JsonSchema)]
struct ReflectedResult {
    diffuse: Option<f64>,
    diffuse_standard_uncertainty: Option<f64>,
    specular: Option<f64>,
    specular_standard_uncertainty: Option<f64>,
    total: Option<f64>,
    total_standard_uncertainty: Option<f64>,
}

/// Incidence and viewing, degrees.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct Angles {
    theta_i_deg: f64,
    phi_i_deg: f64,
    theta_v_deg: f64,
    phi_v_deg: f64,
    #[serde(skip)]
    #[schemars(skip)]
    row: usize,
}

impl Angles {
    fn of(row: usize, geometry: &Geometry) -> Self {
        Self {
            theta_i_deg: geometry.incidence.theta_deg(),
            phi_i_deg: geometry.incidence.phi_deg(),
            theta_v_deg: geometry.viewing.theta_deg(),
            phi_v_deg: geometry.viewing.phi_deg(),
            row,
        }
    }
}

fn known(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn list(values: Vec<f64>) -> Vec<Option<f64>> {
    values.into_iter().map(known).collect()
}

impl EvalCompleteResult {
    fn empty(complete: &Complete) -> Self {
        Self {
            reflectance: complete.reflectance(),
            emission_nm: complete.emission_nm().to_vec(),
            findings: complete.findings().to_vec(),
            under: None,
            excited: Vec::new(),
        }
    }

    /// Under a light.
    pub(super) fn under(complete: &Complete, lit: &Lit<'_>, light: &str, geometries: &[GeometryRow]) -> Self {
        let prediction = lit.prediction();
        let unit = if prediction.kind == QuantityKind::SpectralIrradiance { "W m-2 nm-1" } else { "1" };
        let row = |(row, one): (usize, &GeometryRow)| under_row(Angles::of(row, &one.geometry), lit.at(&one.geometry));
        let under = UnderResult {
            light: light.to_owned(),
            unit: unit.to_owned(),
            irradiance: prediction.irradiance.clone(),
            unlit: prediction.unlit.iter().map(|unlit| unlit.sentence(light)).collect(),
            rows: geometries.iter().enumerate().map(row).collect(),
        };
        Self { under: Some(under), ..Self::empty(complete) }
    }

    /// The same without uncertainties, the light being brought in by any way.
    pub(super) fn values(
        complete: &Complete,
        lit: &Lit<'_>,
        incident: &Incident,
        light: &str,
        geometries: &[GeometryRow],
    ) -> Self {
        let mut result = Self::under(complete, lit, light, &[]);
        if let Some(under) = &mut result.under {
            under.irradiance.clone_from(&incident.irradiance);
            let row = |(row, one): (usize, &GeometryRow)| {
                value_row(Angles::of(row, &one.geometry), complete.values(incident, &one.geometry))
            };
            under.rows = geometries.iter().enumerate().map(row).collect();
        }
        result
    }

    /// At excitations.
    pub(super) fn excited(
        complete: &Complete,
        excitations: &[f64],
        geometries: &[GeometryRow],
    ) -> Result<Self, OutsideExcitation> {
        let mut result = Self::empty(complete);
        for (row, one) in geometries.iter().enumerate() {
            for &nm in excitations {
                let bispectral = complete.bispectral(nm, &one.geometry)?;
                result.excited.push(excited(Angles::of(row, &one.geometry), nm, bispectral));
            }
        }
        Ok(result)
    }

    /// Rows of the geometries in which the specular part has no value, with why.
    pub(super) fn undefined(&self) -> Vec<(usize, String)> {
        let under = self.under.iter().flat_map(|under| &under.rows).map(|row| (row.angles.row, &row.undefined));
        let excited = self.excited.iter().map(|row| (row.angles.row, &row.undefined));
        let mut all: Vec<(usize, String)> =
            under.chain(excited).filter_map(|(row, why)| Some((row, why.clone()?))).collect();
        all.dedup();
        all
    }

    /// CSV: the angle columns as they came, one row per emission; at an excitation its luminescence (nm-1) and, in a row of its own with
    /// the emission equal to the excitation, what is reflected (1).
    pub(super) fn csv(&self, geometries: &[GeometryRow]) -> String {
        let signed = geometries.first().is_some_and(|row| row.signed.is_some());
        let mut header =
            if signed { "theta_i_deg,theta_v_deg" } else { "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg" }.to_owned();
        header.push_str(if self.under.is_some() { ",emission_nm" } else { ",excitation_nm,emission_nm,unit" });
        let has_values_alone =
            self.under.iter().flat_map(|under| &under.rows).any(|row| row.total_standard_uncertainty.is_empty());
        for part in ["luminescent", "diffuse", "specular", "total"] {
            header.push_str(&format!(",{part}"));
            if !has_values_alone {
                header.push_str(&format!(",{part}_standard_uncertainty"));
            }
        }
        if self.under.is_some() && !has_values_alone {
            header.push_str(",total_shared_standard_uncertainty");
        }
        let mut lines = vec![header];
        for row in self.under.iter().flat_map(|under| &under.rows) {
            let start = angle_columns(&row.angles, geometries);
            for (j, nm) in self.emission_nm.iter().enumerate() {
                if has_values_alone {
                    let values = [row.luminescent[j], row.diffuse[j], row.specular[j], row.total[j]];
                    lines.push(format!("{start},{nm},{}", fields(&values)));
                    continue;
                }
                let values = [
                    row.luminescent[j],
                    row.luminescent_standard_uncertainty[j],
                    row.diffuse[j],
                    row.diffuse_standard_uncertainty[j],
                    row.specular[j],
                    row.specular_standard_uncertainty[j],
                    row.total[j],
                    row.total_standard_uncertainty[j],
                    row.total_shared_standard_uncertainty[j],
                ];
                lines.push(format!("{start},{nm},{}", fields(&values)));
            }
        }
        for row in &self.excited {
            let start = format!("{},{}", angle_columns(&row.angles, geometries), row.excitation_nm);
            for (j, nm) in self.emission_nm.iter().enumerate() {
                let (value, sigma) = (row.luminescent[j], row.luminescent_standard_uncertainty[j]);
                let values = [value, sigma, None, None, None, None, value, sigma];
                lines.push(format!("{start},{nm},nm-1,{}", fields(&values)));
            }
            if let Some(line) = &row.reflected {
                let values = [
                    None,
                    None,
                    line.diffuse,
                    line.diffuse_standard_uncertainty,
                    line.specular,
                    line.specular_standard_uncertainty,
                    line.total,
                    line.total_standard_uncertainty,
                ];
                lines.push(format!("{start},{},1,{}", row.excitation_nm, fields(&values)));
            }
        }
        lines.join("\n")
    }
}

fn angle_columns(angles: &Angles, geometries: &[GeometryRow]) -> String {
    match geometries[angles.row].signed {
        Some((incidence, viewing)) => format!("{incidence},{viewing}"),
        None => format!("{},{},{},{}", angles.theta_i_deg, angles.phi_i_deg, angles.theta_v_deg, angles.phi_v_deg),
    }
}

/// Numbers in their shortest form that reads back; nothing where there is none.
fn fields(values: &[Option<f64>]) -> String {
    let fields = values.iter().map(|value| value.map_or(String::new(), |value| format!("{value:?}")));
    fields.collect::<Vec<_>>().join(",")
}

fn under_row(angles: Angles, radiated: Radiated) -> UnderRow {
    UnderRow {
        angles,
        luminescent: list(radiated.luminescent),
        luminescent_standard_uncertainty: list(radiated.luminescent_sigma),
        diffuse: list(radiated.diffuse),
        diffuse_standard_uncertainty: list(radiated.diffuse_sigma),
        specular: list(radiated.specular),
        specular_standard_uncertainty: list(radiated.specular_sigma),
        total: list(radiated.total),
        total_standard_uncertainty: list(radiated.total_sigma),
        total_shared_standard_uncertainty: list(radiated.shared_sigma),
        undefined: radiated.undefined.map(|why| why.to_string()),
    }
}

fn value_row(angles: Angles, values: Values) -> UnderRow {
    UnderRow {
        angles,
        luminescent: list(values.luminescent),
        luminescent_standard_uncertainty: Vec::new(),
        diffuse: list(values.diffuse),
        diffuse_standard_uncertainty: Vec::new(),
        specular: list(values.specular),
        specular_standard_uncertainty: Vec::new(),
        total: list(values.total),
        total_standard_uncertainty: Vec::new(),
        total_shared_standard_uncertainty: Vec::new(),
        undefined: values.undefined.map(|why| why.to_string()),
    }
}

fn excited(angles: Angles, excitation_nm: f64, bispectral: Bispectral) -> ExcitedResult {
    let reflected = bispectral.reflected.map(|line| ReflectedResult {
        diffuse: known(line.diffuse),
        diffuse_standard_uncertainty: known(line.diffuse_sigma),
        specular: known(line.specular),
        specular_standard_uncertainty: known(line.specular_sigma),
        total: known(line.total()),
        total_standard_uncertainty: known(line.total_sigma),
    });
    ExcitedResult {
        angles,
        excitation_nm,
        luminescent: list(bispectral.luminescent),
        luminescent_standard_uncertainty: list(bispectral.luminescent_sigma),
        reflected,
        undefined: bispectral.undefined.map(|why| why.to_string()),
    }
}
