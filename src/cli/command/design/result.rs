//! What `bbrf design` says, as JSON and as text.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::fit::design::{Added, Goal, Guess, Noise, Predicted, Sensitivities};
use crate::quantity::Geometry;

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct DesignResult {
    /// The material guessed, as given.
    model: String,
    /// The wavelength of it that is designed for, nm, where the model has several: that of the largest amplitudes.
    emission_nm: Option<f64>,
    /// What values are relative to.
    reference: String,
    /// Standard deviation of one value, relative to it.
    noise: f64,
    /// Standard deviation of one value, absolute.
    floor: f64,
    /// What was made small: `d`, or a parameter.
    optimise: String,
    /// Number of geometries planned.
    planned: usize,
    /// How many of them tell nothing: a term has no value there, or the value is 0 without a floor.
    without_value: usize,
    /// Number of geometries offered.
    candidates: usize,
    /// Each parameter.
    parameters: Vec<ParameterResult>,
    /// What the planned geometries leave undetermined.
    undetermined: Vec<String>,
    /// What is still undetermined with the geometries added.
    undetermined_after: Vec<String>,
    /// The geometries added, in the order in which they help.
    added: Vec<AddedResult>,
    /// Files written.
    written: Vec<String>,
}

/// A parameter with its predicted uncertainty.
#[derive(Debug, Serialize, JsonSchema)]
struct ParameterResult {
    name: String,
    unit: String,
    /// The value guessed.
    guess: f64,
    /// What relative uncertainties are relative to: the value, of an index n - 1, and 1 where that is 0.
    relative_to: f64,
    /// Standard uncertainty from the planned geometries; `null` where they cannot tell.
    standard_uncertainty: Option<f64>,
    /// With the geometries added.
    standard_uncertainty_after: Option<f64>,
}

/// A geometry added.
#[derive(Debug, Serialize, JsonSchema)]
struct AddedResult {
    theta_i_deg: f64,
    phi_i_deg: f64,
    theta_v_deg: f64,
    phi_v_deg: f64,
    /// Standard uncertainty of each parameter, in their order, with this geometry and those before it.
    standard_uncertainty: Vec<Option<f64>>,
    #[serde(skip)]
    signed: Option<(f64, f64)>,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl DesignResult {
    pub(super) fn new(guess: &Guess, noise: &Noise, goal: &Goal, emission_nm: Option<f64>) -> Self {
        let parameter = |one: &crate::fit::design::GuessedParameter| ParameterResult {
            name: one.name.clone(),
            unit: one.unit.to_owned(),
            guess: one.value,
            relative_to: one.scale.abs(),
            standard_uncertainty: None,
            standard_uncertainty_after: None,
        };
        Self {
            model: String::new(),
            emission_nm,
            reference: guess.reference().to_string(),
            noise: noise.relative,
            floor: noise.floor,
            optimise: match goal {
                Goal::All => "d".to_owned(),
                Goal::Parameter(name) => name.replace('_', "-"),
            },
            planned: 0,
            without_value: 0,
            candidates: 0,
            parameters: guess.parameters().iter().map(parameter).collect(),
            undetermined: Vec::new(),
            undetermined_after: Vec::new(),
            added: Vec::new(),
            written: Vec::new(),
        }
    }

    pub(super) fn describe(
        &mut self,
        model: &str,
        candidates: usize,
        (planned, known, before): (&[Geometry], &Sensitivities, &Predicted),
        (extra, added, after): (&[Geometry], &[Added], &Predicted),
    ) {
        model.clone_into(&mut self.model);
        self.candidates = candidates;
        self.planned = planned.len();
        self.without_value = known.without_value().len();
        for (k, parameter) in self.parameters.iter_mut().enumerate() {
            parameter.standard_uncertainty = finite(before.standard_uncertainty[k]);
            parameter.standard_uncertainty_after = finite(after.standard_uncertainty[k]);
        }
        self.undetermined.clone_from(&before.undetermined);
        self.undetermined_after.clone_from(&after.undetermined);
        let one = |(geometry, added): (&Geometry, &Added)| AddedResult {
            theta_i_deg: geometry.incidence.theta_deg(),
            phi_i_deg: geometry.incidence.phi_deg(),
            theta_v_deg: geometry.viewing.theta_deg(),
            phi_v_deg: geometry.viewing.phi_deg(),
            standard_uncertainty: added.standard_uncertainty.iter().copied().map(finite).collect(),
            signed: geometry.signed_deg(),
        };
        self.added = extra.iter().zip(added).map(one).collect();
    }

    pub(super) fn wrote(&mut self, path: &Path) {
        self.written.push(path.display().to_string());
    }

    /// Relative uncertainties after 0, 1, 2, ... geometries added.
    pub(super) fn curves(&self) -> Vec<(String, Vec<f64>)> {
        let unknown = |value: Option<f64>| value.unwrap_or(f64::NAN);
        self.parameters
            .iter()
            .enumerate()
            .map(|(k, one)| {
                let first = unknown(one.standard_uncertainty);
                let rest = self.added.iter().map(|added| unknown(added.standard_uncertainty[k]));
                let name = one.name.rsplit_once('.').map_or(one.name.as_str(), |(_, name)| name);
                let relative = std::iter::once(first).chain(rest).map(|sigma| sigma / one.relative_to);
                (name.replace("refractive_index", "refractive index - 1"), relative.collect())
            })
            .collect()
    }

    pub(super) fn subtitle(&self) -> String {
        let parameters: Vec<String> =
            self.parameters.iter().map(|one| format!("{} {}", one.name, shown(one.guess))).collect();
        let (noise, floor) = (100.0 * self.noise, self.floor);
        format!("{}; noise {noise} %, floor {floor}; chosen for {}", parameters.join(", "), self.goal())
    }

    fn goal(&self) -> String {
        if self.optimise == "d" { "all parameters (D-optimal)".to_owned() } else { self.optimise.clone() }
    }

    pub(super) fn text(&self) -> String {
        let at = self.emission_nm.map_or(String::new(), |nm| format!(" at {nm} nm (its largest amplitudes)"));
        let mut lines = vec![format!(
            "{}{at}: noise {} % of each value, floor {}; reference {}; {} geometries planned{}",
            self.model,
            100.0 * self.noise,
            self.floor,
            self.reference,
            self.planned,
            match self.without_value {
                0 => String::new(),
                count => format!(", {count} of them without a value"),
            }
        )];
        let more = format!("with {} more", self.added.len());
        lines.push(format!("  {:<34}{:>12}{:>24}{:>24}", "parameter", "guess", "sigma predicted", more));
        for one in &self.parameters {
            let sigma = |value: Option<f64>| with_percent(value, one.relative_to);
            let after = if self.added.is_empty() { "-".to_owned() } else { sigma(one.standard_uncertainty_after) };
            let (guess, before) = (shown(one.guess), sigma(one.standard_uncertainty));
            lines.push(format!("  {:<34}{guess:>12}{before:>24}{after:>24}", one.name));
        }
        if self.parameters.iter().any(|one| one.name.ends_with("refractive_index")) {
            lines.push("  (percent of the value, of the refractive index: of n - 1)".to_owned());
        }
        if self.planned > 0 {
            lines.extend(self.undetermined.iter().map(|sentence| format!("  as planned: {sentence}")));
        }
        if !self.added.is_empty() {
            lines.extend(self.undetermined_after.iter().map(|sentence| format!("  with those added: {sentence}")));
            lines.push(self.heading());
        }
        lines.extend(self.added.iter().enumerate().map(|(k, one)| self.added_line(k, one)));
        lines.extend(self.written.iter().map(|path| format!("  wrote {path}")));
        lines.join("\n")
    }

    fn heading(&self) -> String {
        let names = self.parameters.iter().map(|one| one.name.rsplit_once('.').map_or("", |(_, name)| name));
        let columns: Vec<String> = names.map(|name| format!("{name:>18}")).collect();
        let angles = if self.is_signed() { "theta_i theta_v" } else { "theta_i phi_i theta_v phi_v" };
        format!(
            "  next geometries for {}, of {} candidates; sigma in % with each\n  {:>4}  {angles:<28}{}",
            self.goal(),
            self.candidates,
            "#",
            columns.join("")
        )
    }

    fn is_signed(&self) -> bool {
        self.added.iter().all(|one| one.signed.is_some())
    }

    fn added_line(&self, k: usize, one: &AddedResult) -> String {
        let angles = match one.signed.filter(|_| self.is_signed()) {
            Some((i, v)) => format!("{i:>7} {v:>7}"),
            None => format!("{:>7} {:>5} {:>7} {:>5}", one.theta_i_deg, one.phi_i_deg, one.theta_v_deg, one.phi_v_deg),
        };
        let percent = |(sigma, parameter): (&Option<f64>, &ParameterResult)| match sigma {
            Some(sigma) => format!("{:>18}", shown(100.0 * sigma / parameter.relative_to)),
            None => format!("{:>18}", "undetermined"),
        };
        let columns: Vec<String> = one.standard_uncertainty.iter().zip(&self.parameters).map(percent).collect();
        format!("  {:>4}  {angles:<28}{}", k + 1, columns.join(""))
    }
}

/// A number in three digits or so.
fn shown(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e4).contains(&size) {
        return format!("{value:.2e}");
    }
    let decimals = if size >= 100.0 {
        1
    } else if size >= 1.0 {
        3
    } else {
        5
    };
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn with_percent(sigma: Option<f64>, relative_to: f64) -> String {
    match sigma {
        // Beyond its own size nothing is known of it; a sentence says so with the number.
        Some(sigma) if sigma > relative_to => "not determined".to_owned(),
        Some(sigma) => format!("{} ({} %)", shown(sigma), shown(100.0 * sigma / relative_to)),
        None => "undetermined".to_owned(),
    }
}
