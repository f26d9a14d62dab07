//! The model that a command is given: one of a file, or one in JSON.

use miette::miette;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::opened::open;
use crate::dataset::{Document, Model, ParameterCovariance};
use crate::donaldson::Complete;
use crate::quantity::Reference;
use crate::terms::{Term, TermKind};

/// What `value` is.
const FACTOR_MEANING: &str = "Y/E, the sum of the elastic terms: pi times the radiance over the irradiance of a surface across \
    the beam, without a reference";
const OTHER_MEANING: &str = "the sum of the elastic terms in the unit of the fitted number, which is no ratio";

/// A model as JSON.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModelJson {
    /// The terms.
    terms: Vec<Term>,
    /// Names of the parameters in the order of `covariance`: `TERM.PARAMETER` as in `lambertian.albedo`, or
    /// `TERM:POSITION.PARAMETER` where several terms are of one kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    covariance_parameters: Option<Vec<String>>,
    /// Covariance of these parameters, for `--uncertainty`; `null` where it is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    covariance: Option<Vec<Vec<Option<f64>>>>,
}

/// What the column `value` holds.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ValueMeaning {
    /// In words.
    pub(crate) meaning: String,
    /// The reference it is relative to: always `none`.
    pub(crate) reference: String,
    /// Its unit, `1` for none.
    unit: String,
    /// How a spectrum became the number that the model was fitted to, as in `band:500-620`; `null` for a model in JSON.
    reduction: Option<String>,
    /// Wavelengths of the model's measurement, nm, at which it has no value.
    pub(crate) without_model_nm: Vec<f64>,
}

/// Terms per emission value, with its wavelength where there are several.
pub(crate) type Bands = Vec<(Option<f64>, Vec<Term>)>;

/// A model and what its values mean.
pub(crate) struct Loaded {
    pub(crate) bands: Bands,
    /// What is known of their parameters' covariance, one per emission value.
    pub(crate) covariance: Vec<ParameterCovariance>,
    pub(crate) value: ValueMeaning,
    /// The reference that it was fitted under; `None` for a model in JSON.
    pub(crate) reference: Option<Reference>,
}

/// Reads `FILE.bbrf#ID`, `FILE.bbrf` where it holds one model, or a JSON file.
pub(crate) fn load(model: &str) -> Result<Loaded, miette::Report> {
    let (path, id) = match model.rsplit_once('#') {
        Some((path, id)) => (path, Some(id)),
        None => (model, None),
    };
    let bytes = std::fs::read(path).map_err(|error| miette!("{path}: cannot be read: {error}"))?;
    if bytes.first().is_some_and(|first| first.is_ascii_whitespace() || *first == b'{') {
        return from_json(path, &bytes);
    }
    let document = open(path.as_ref())?.document;
    let model = pick(&document, path, id)?;
    let nm = model.emission.wavelengths();
    let bands = (0..model.emission.len())
        .map(|emission| {
            let terms = model.terms_at(emission).map_err(|error| miette!("{path}, model `{}`: {error}", model.id))?;
            Ok((nm.map(|nm| nm[emission]), terms))
        })
        .collect::<Result<Bands, miette::Report>>()?;
    let covariance = (0..model.emission.len()).map(|emission| model.parameter_covariance(emission)).collect();
    Ok(Loaded { bands, covariance, value: meaning(&document, model), reference: Some(model.reference) })
}

/// The complete model that a name stands for: `FILE.bbrf#ID`, `FILE.bbrf` where it holds one model.
pub(crate) fn load_complete(name: &str) -> Result<Complete, miette::Report> {
    let (path, id) = match name.rsplit_once('#') {
        Some((path, id)) => (path, Some(id)),
        None => (name, None),
    };
    let document = open(path.as_ref())?.document;
    let model = pick(&document, path, id)?;
    Complete::of(&document, model).map_err(|error| {
        miette!(
            help = "`bbrf fit SCAN.bbrf --donaldson MATRIX.bbrf -o OUT.bbrf` makes a complete model; --light and --excitation need one",
            "{path}: {error}"
        )
    })
}

/// The model of that id in a document, or its only one.
fn pick<'a>(document: &'a Document, path: &str, id: Option<&str>) -> Result<&'a Model, miette::Report> {
    let ids = || document.models.iter().map(|m| m.id.to_string()).collect::<Vec<_>>().join(", ");
    match (id, document.models.as_slice()) {
        (Some(id), _) => {
            document.model(id).ok_or_else(|| miette!("{path}: no model `{id}`; the file holds: {}", ids()))
        }
        (None, [one]) => Ok(one),
        (None, []) => Err(miette!("{path}: holds no model; make one with `bbrf fit {path} -o OUT`")),
        (None, _) => Err(miette!("{path}: holds several models ({}); name one as {path}#ID", ids())),
    }
}

fn meaning(document: &Document, model: &Model) -> ValueMeaning {
    let measurement = document.measurement(model.measurement.as_str());
    let measured = measurement.and_then(|one| one.emission.wavelengths()).unwrap_or(&[]);
    let without = match model.emission.wavelengths() {
        Some(nm) => measured.iter().copied().filter(|one| !nm.contains(one)).collect(),
        None => Vec::new(),
    };
    let is_factor = measurement.is_none_or(|one| one.quantity.kind.is_factor());
    let meaning = if is_factor { FACTOR_MEANING } else { OTHER_MEANING };
    ValueMeaning {
        meaning: meaning.to_owned(),
        reference: Reference::None.to_string(),
        unit: model.unit.clone(),
        reduction: Some(model.reduction.clone()),
        without_model_nm: without,
    }
}

fn from_json(path: &str, bytes: &[u8]) -> Result<Loaded, miette::Report> {
    let model: ModelJson = serde_json::from_slice(bytes).map_err(|error| {
        miette!(
            "{path}: {error}; expected {{\"terms\": [{{\"kind\": \"lambertian\", \"albedo\": 0.8}}, ...]}} with the terms \
             of `bbrf schema eval-model`"
        )
    })?;
    for term in &model.terms {
        term.check().map_err(|error| miette!("{path}: {error}"))?;
    }
    if model.terms.is_empty() {
        return Err(miette!("{path}: `terms` is empty; a model needs at least one term"));
    }
    let covariance = vec![json_covariance(&model).map_err(|problem| miette!("{path}: {problem}"))?];
    let value = ValueMeaning {
        meaning: FACTOR_MEANING.to_owned(),
        reference: Reference::None.to_string(),
        unit: "1".to_owned(),
        reduction: None,
        without_model_nm: Vec::new(),
    };
    Ok(Loaded { bands: vec![(None, model.terms)], covariance, value, reference: None })
}

/// The covariance of a model in JSON; of nothing where it has none.
fn json_covariance(model: &ModelJson) -> Result<ParameterCovariance, String> {
    let kinds: Vec<TermKind> = model.terms.iter().map(Term::kind).collect();
    let mut all = ParameterCovariance::unknown(&kinds);
    let (names, rows) = match (&model.covariance_parameters, &model.covariance) {
        (None, None) => return Ok(all),
        (Some(names), Some(rows)) => (names, rows),
        _ => return Err("`covariance` and `covariance_parameters` belong together; give both or neither".to_owned()),
    };
    let count = names.len();
    if let Some(twice) = names.iter().enumerate().find(|(k, name)| names[..*k].contains(name)) {
        return Err(format!("`covariance_parameters` names `{}` twice; name each parameter once", twice.1));
    }
    let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
    if lengths != vec![count; count] {
        return Err(format!(
            "`covariance` has rows of {lengths:?} numbers; expected {count} rows of {count}, as `covariance_parameters` has names"
        ));
    }
    let at = |i: usize, j: usize| rows[i][j].unwrap_or(f64::NAN);
    for i in 0..count {
        if at(i, i) < 0.0 {
            return Err(format!("`covariance`: the variance of `{}` is {}; expected 0 or more", names[i], at(i, i)));
        }
        if let Some(j) = (0..i).find(|&j| (at(i, j) - at(j, i)).abs() > 1e-9 * (at(i, i) * at(j, j)).sqrt()) {
            return Err(format!(
                "`covariance`: {} for `{}` with `{}` and {} the other way round; expected a symmetric matrix",
                at(i, j),
                names[i],
                names[j],
                at(j, i)
            ));
        }
    }
    let known = all.names().join("`, `");
    all.enter(names, at).map_err(|name| format!("`covariance_parameters` names `{name}`; the terms have `{known}`"))?;
    Ok(all)
}
