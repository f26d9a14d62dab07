//! `bbrf donaldson predict --by product|factors|colour`: colours and spectra by tables, as a program has them that predicts millions.

use miette::miette;
use ndarray::Array2;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::material::Material;
use super::Arguments;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_message, print_text, write_output};
use crate::donaldson::{By, Light, Observer, Operator, Reradiation, STEPS_NM, Way};

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SampledResult {
    /// How it was found.
    by: By,
    /// Step of the samples, nm.
    step_nm: f64,
    /// True where all was computed in single precision.
    single: bool,
    observer: Observer,
    /// Each matrix under each light.
    predictions: Vec<Sampled>,
}

/// One matrix under one light.
#[derive(Debug, Serialize, JsonSchema)]
struct Sampled {
    /// The matrix, as it was named.
    material: String,
    /// The light, as it was named.
    light: String,
    /// Tristimulus values, Y of white being 100; `null` under a light that the observer does not see.
    xyz: Option<[f64; 3]>,
    white: Option<[f64; 3]>,
    lab: Option<[f64; 3]>,
    /// Wavelengths of the radiance, nm; empty by `colour`.
    nm: Vec<f64>,
    /// Pi times the radiance.
    radiance: Vec<f64>,
}

pub(super) fn run(arguments: &Arguments, materials: &[Material], lights: &[Light]) -> CommandResult {
    let way = Way { by: arguments.by, step_nm: arguments.step, single: arguments.single };
    if !(STEPS_NM.0..=STEPS_NM.1).contains(&way.step_nm) {
        return Err(miette!("--step: found {} nm; expected {} to {}", way.step_nm, STEPS_NM.0, STEPS_NM.1));
    }
    let mut predictions = Vec::new();
    for material in materials {
        predictions.extend(of_material(arguments, material, lights, way)?);
    }
    let result = SampledResult {
        by: way.by,
        step_nm: way.step_nm,
        single: way.single,
        observer: arguments.observer,
        predictions,
    };
    if let Some(path) = &arguments.output {
        write_output(path, result.spectra().as_bytes())?;
        print_message(&format!("bbrf: wrote {}", path.display()));
    }
    if arguments.json {
        print_json("bbrf:donaldson-predict-sampled:1", &result)?;
    } else {
        print_text(&result.colours())?;
    }
    Ok(Outcome::Done)
}

fn of_material(
    arguments: &Arguments,
    material: &Material,
    lights: &[Light],
    way: Way,
) -> Result<Vec<Sampled>, miette::Report> {
    let surface = Reradiation::of(&material.matrix, &material.separated, arguments.luminescence);
    let widths = material.matrix.emission_width_nm();
    let factors = Some((&material.separated.factors, widths.as_slice()));
    let operator = Operator::new(&surface, factors, arguments.observer, way).ok_or_else(|| {
        miette!("{}: no elastic value at two emissions or more; --by integrals does without", material.name)
    })?;
    let rows: Vec<Vec<f64>> = lights.iter().map(|light| operator.sampled(light, arguments.lights.extend)).collect();
    let samples = Array2::from_shape_fn((rows.len(), operator.nm().len()), |(row, k)| rows[row][k]);
    let (radiance, xyz) = operator.apply(&operator.samples(&samples));
    let of = |(row, light): (usize, &Light)| {
        let colour = operator.colour(&rows[row], [0, 1, 2].map(|c| xyz[(row, c)]));
        Sampled {
            material: material.name.clone(),
            light: light.name().to_owned(),
            xyz: colour.map(|colour| colour.xyz),
            white: colour.map(|colour| colour.white),
            lab: colour.and_then(|colour| colour.lab()),
            nm: radiance.as_ref().map_or(Vec::new(), |_| operator.visible_nm().to_vec()),
            radiance: radiance.as_ref().map_or(Vec::new(), |radiance| radiance.row(row).to_vec()),
        }
    };
    Ok(lights.iter().enumerate().map(of).collect())
}

impl SampledResult {
    fn colours(&self) -> String {
        let mut lines = vec!["material,light,X,Y,Z,L,a,b".to_owned()];
        for one in &self.predictions {
            let numbers = |numbers: Option<[f64; 3]>| match numbers {
                Some(numbers) => numbers.map(|number| format!("{number:?}")).join(","),
                None => ",,".to_owned(),
            };
            lines.push(format!("{},{},{},{}", one.material, one.light, numbers(one.xyz), numbers(one.lab)));
        }
        lines.join("\n")
    }

    fn spectra(&self) -> String {
        let mut text = "material,light,emission_nm,radiance\n".to_owned();
        for one in &self.predictions {
            for (nm, value) in one.nm.iter().zip(&one.radiance) {
                text.push_str(&format!("{},{},{nm:?},{value:?}\n", one.material, one.light));
            }
        }
        text
    }
}
