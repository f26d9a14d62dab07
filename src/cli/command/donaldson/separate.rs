//! `bbrf donaldson separate`: the elastic and the luminescent part of a matrix, and its factors.

use std::path::PathBuf;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use super::material;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::{open, open_to_rewrite};
use crate::cli::output::{print_json, print_text};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::{self, measurement_digest};
use crate::dataset::Measurement;
use crate::donaldson::{Balance, Matrix, Separate, Separated, Share, parts, separate};

/// Tell the reflected from the luminescent light of a matrix, and factorise the luminescence
///
/// Reflected light reaches as far from the diagonal as both bandpasses meet; where they are unstated, as far as the values below
/// the excitation rise above the noise. The rest is luminescence: a sum of products of an excitation and an emission spectrum,
/// none negative, as few as leave no more than noise. Next to the diagonal the factors say what is luminescent. Negative noise
/// is kept. With `-o` the parts are written beside the matrix: `ID-elastic`, `ID-luminescent` and the factorisation `ID-factors`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// FILE.bbrf, or FILE.bbrf#ID where it holds several matrices
    file: String,
    /// How many factors, 1 to 4 (default: by the noise)
    #[arg(long)]
    rank: Option<usize>,
    /// Where to write the file with the parts added; must not be FILE
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SeparateResult {
    /// The matrix.
    measurement: String,
    /// The file written, with `-o`.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// Reflected light reaches cells whose emission is less than this from the excitation, nm: the most of all excitations.
    reach_nm: f64,
    /// True where that follows from stated bandpasses; false where it was found in the values.
    reach_is_stated: bool,
    /// Noise where no light can be, emission well below the excitation: root mean square; `null` without such a cell.
    floor: Option<f64>,
    /// How many factors there are.
    rank: usize,
    /// What each number of factors that was tried leaves, root mean square.
    tried: Vec<Tried>,
    /// Excitation wavelengths, nm.
    excitation_nm: Vec<f64>,
    /// Emission wavelengths, nm.
    emission_nm: Vec<f64>,
    /// Elastic radiance factor, one per emission; `null` where the matrix does not tell.
    elastic: Vec<Option<f64>>,
    /// Its standard uncertainty.
    elastic_standard_uncertainty: Vec<Option<f64>>,
    /// Excitation spectra, one list per factor, 1 where the luminescence is strongest.
    excitation_factors: Vec<Vec<f64>>,
    /// Emission spectra, likewise, in the unit of the matrix.
    emission_factors: Vec<Vec<f64>>,
    /// Photons and energy out over in, for each excitation.
    balance: Vec<BalanceResult>,
    /// What the matrix cannot tell, and other findings.
    findings: Vec<String>,
}

/// What a number of factors leaves.
#[derive(Debug, Serialize, JsonSchema)]
struct Tried {
    rank: usize,
    residual_rms: f64,
}

/// Out over in at one excitation, as a diffuser would radiate it.
#[derive(Debug, Serialize, JsonSchema)]
struct BalanceResult {
    excitation_nm: f64,
    photons: ShareResult,
    luminescent_energy: ShareResult,
    /// With the reflected part where it is known.
    energy: ShareResult,
}

/// A share with its standard uncertainty.
#[derive(Debug, Serialize, JsonSchema)]
struct ShareResult {
    value: f64,
    standard_uncertainty: f64,
}

impl From<Share> for ShareResult {
    fn from(share: Share) -> Self {
        Self { value: share.value, standard_uncertainty: share.sigma }
    }
}

impl From<&Balance> for BalanceResult {
    fn from(balance: &Balance) -> Self {
        Self {
            excitation_nm: balance.excitation_nm,
            photons: balance.photons.into(),
            luminescent_energy: balance.luminescent_energy.into(),
            energy: balance.energy.into(),
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let (path, id) = material::split(&arguments.file);
    if let Some(output) = &arguments.output {
        refuse_overwriting(output, [PathBuf::from(path)])?;
    }
    let opened = if arguments.output.is_some() { open_to_rewrite(path.as_ref())? } else { open(path.as_ref())? };
    let mut document = opened.document;
    let measurement = material::pick(&document, path, id)?;
    let matrix = Matrix::of(measurement).map_err(|error| miette!("{path}: {error}"))?;
    let asked = Separate { rank: arguments.rank };
    let separated =
        separate(&matrix, asked).map_err(|error| miette!("{path}: measurement `{}`: {error}", measurement.id))?;
    let mut result = result(measurement, &matrix, &separated);
    if let Some(output) = &arguments.output {
        let digest = measurement_digest(measurement).map_err(|error| miette!("{path}: {error}"))?;
        let parts = parts(measurement, &matrix, &separated, &digest)
            .ok_or_else(|| miette!("{path}: measurement `{}` has no emission wavelengths", measurement.id))?;
        parts.store(&mut document).map_err(|error| miette!("{path}: {error}"))?;
        container::write_file_keeping(&document, &opened.foreign, output).map_err(|error| miette!("{error}"))?;
        result.file = Some(output.display().to_string());
    }
    if arguments.json {
        print_json("bbrf:donaldson-separate:1", &result)?;
    } else {
        print_text(&text(&result))?;
    }
    Ok(Outcome::Done)
}

fn known(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

fn result(measurement: &Measurement, matrix: &Matrix, separated: &Separated) -> SeparateResult {
    let lists = |table: &ndarray::Array2<f64>| table.rows().into_iter().map(|row| row.to_vec()).collect();
    SeparateResult {
        measurement: measurement.id.to_string(),
        file: None,
        reach_nm: separated.overlap.reach_nm.iter().copied().fold(0.0, f64::max),
        reach_is_stated: separated.overlap.is_stated,
        floor: known(separated.floor.rms),
        rank: separated.factors.rank(),
        tried: separated.tried.iter().map(|(rank, rms)| Tried { rank: *rank, residual_rms: *rms }).collect(),
        excitation_nm: matrix.excitation_nm.clone(),
        emission_nm: matrix.emission_nm.clone(),
        elastic: separated.elastic.iter().copied().map(known).collect(),
        elastic_standard_uncertainty: separated.elastic_sigma.iter().copied().map(known).collect(),
        excitation_factors: lists(&separated.factors.excitation),
        emission_factors: lists(&separated.factors.emission),
        balance: separated.balance.iter().map(Into::into).collect(),
        findings: separated.findings.clone(),
    }
}

fn text(result: &SeparateResult) -> String {
    let peak = |list: &[f64], nm: &[f64]| {
        let at = (0..list.len()).max_by(|a, b| list[*a].total_cmp(&list[*b]));
        at.map_or(f64::NAN, |at| nm[at])
    };
    let how = if result.reach_is_stated { "by the stated bandpasses" } else { "found in the values" };
    let mut lines = vec![
        format!("{}: separated", result.measurement),
        format!("  reflected light within {} nm of the excitation ({how})", result.reach_nm),
    ];
    if let Some(floor) = result.floor {
        lines.push(format!("  noise where no light can be: {floor:.2e}"));
    }
    for tried in &result.tried {
        let taken = if tried.rank == result.rank { ", taken" } else { "" };
        let what = if tried.rank == 1 { "factor leaves" } else { "factors leave" };
        let times = result.floor.filter(|floor| *floor > 0.0).map(|floor| tried.residual_rms / floor);
        let times =
            times.map_or_else(String::new, |times| format!(" ({times:.1} times the noise; up to 2 count as noise)"));
        lines.push(format!("  {} {what} {:.2e}{times}{taken}", tried.rank, tried.residual_rms));
    }
    for (k, (excitation, emission)) in result.excitation_factors.iter().zip(&result.emission_factors).enumerate() {
        let (from, to) = (peak(excitation, &result.excitation_nm), peak(emission, &result.emission_nm));
        lines.push(format!("  factor {k}: excited most at {from} nm, radiates most at {to} nm"));
    }
    let most = |of: fn(&BalanceResult) -> &ShareResult| {
        result.balance.iter().max_by(|a, b| of(a).value.total_cmp(&of(b).value)).map(|one| (one.excitation_nm, of(one)))
    };
    for (what, of) in [
        ("luminescent photons", (|one| &one.photons) as fn(&BalanceResult) -> &ShareResult),
        ("energy, reflected and luminescent", |one| &one.energy),
    ] {
        if let Some((nm, share)) = most(of) {
            let (value, sigma) = (share.value, share.standard_uncertainty);
            lines.push(format!("  {what}: at most {value:.3} ± {sigma:.3} of what fell in, at {nm} nm"));
        }
    }
    lines.extend(result.findings.iter().map(|finding| format!("  {finding}")));
    lines.extend(result.file.iter().map(|file| format!("wrote {file}")));
    lines.join("\n")
}
