//! Closed lists of names with their meanings, from the types.

use bbrf::dataset::{Provenance, Role, Symmetry};
use bbrf::quantity::{
    BandpassCorrection, BandpassShape, Basis, CorrelatedOver, ErrorDistribution, EvaluationType, Flag, NormalisedAt,
    Part, QuantityKind,
};
use bbrf::terms::{Denominator, Distribution, TermKind};
use schemars::{JsonSchema, schema_for};
use serde_json::Value;

use super::full;
use super::{code, markdown, titled};

/// Name and meaning of every member of a closed list.
fn members<T: JsonSchema>() -> Vec<(String, String)> {
    let schema = schema_for!(T).to_value();
    let options = schema["oneOf"].as_array().unwrap_or_else(|| panic!("{schema} is no closed list")).clone();
    options
        .iter()
        .map(|option| {
            let name = option["const"].as_str().unwrap_or_else(|| panic!("{option}"));
            (name.to_owned(), option["description"].as_str().unwrap_or_default().replace('\n', " "))
        })
        .collect()
}

fn meaning<T: JsonSchema>(name: &str) -> String {
    members::<T>().into_iter().find(|(found, _)| found == name).map_or_else(String::new, |(_, meaning)| meaning)
}

fn list<T: JsonSchema>(title: &str, place: &str) -> String {
    let rows = members::<T>().into_iter().map(|(name, meaning)| [code(&name), meaning]);
    format!("## {title}\n\n{place}\n\n{}\n", markdown(["name", "meaning"], rows))
}

pub fn quantities() -> String {
    let rows = QuantityKind::ALL.iter().map(|kind| {
        let (factor, exponents) = kind.si_unit().map_or((String::new(), String::new()), |unit| {
            let exponents: Vec<String> = unit.exponents.iter().map(i8::to_string).collect();
            (format!("{:e}", unit.factor), exponents.join(" "))
        });
        [code(kind.name()), code(kind.unit()), factor, exponents, meaning::<QuantityKind>(kind.name())]
    });
    let head = ["`quantity`", "`units`", "`unit_si_factor`", "`unit_si_exponents` (m kg s A K mol cd)", "meaning"];
    let about = "One unit is `unit_si_factor` times the coherent SI unit with the exponents given; the steradian counts as \
                 1. An unstated quantity has neither factor nor exponents.";
    titled("Quantities", about, &markdown(head, rows))
}

fn flags() -> String {
    let rows = Flag::ALL.into_iter().map(|flag| {
        let yes = |is: bool| if is { "yes" } else { "" }.to_owned();
        [
            flag.bit().to_string(),
            code(flag.name()),
            yes(flag.explains_absence()),
            yes(flag.excludes_from_fit()),
            meaning::<Flag>(flag.name()),
        ]
    });
    let head = ["bit", "name", "explains NaN", "never fitted", "meaning"];
    format!(
        "## Flags\n\nOf `value_flag`, in the order of `flag_masks` and `flag_meanings`.\n\n{}\n",
        markdown(head, rows)
    )
}

pub fn names() -> String {
    let body = [
        list::<Role>("Role", "`role` of a measurement."),
        list::<Part>("Part", "`part` of `value`."),
        list::<NormalisedAt>("Normalised at", "`normalised_at` of `value`."),
        list::<Basis>("Basis", "`basis` of `value`."),
        flags(),
        list::<CorrelatedOver>("Correlated over", "`correlated_over` of a shared component."),
        list::<ErrorDistribution>("Error distribution", "`distribution` of an uncertainty or of a calibration."),
        list::<EvaluationType>("Evaluation", "`evaluation` of an uncertainty or of a calibration."),
        list::<BandpassShape>("Bandpass shape", "`bandpass_shape` of `wavelength_emission_fwhm`, `excitation_shape`."),
        list::<BandpassCorrection>(
            "Bandpass correction",
            "`bandpass_correction` of `wavelength_emission_fwhm`, `excitation_correction`.",
        ),
        list::<Symmetry>("Symmetry", "`symmetry` of a sample."),
    ]
    .concat();
    titled("Closed lists of names", "A name that is not in its list is an error [BB0007].", body.trim_end()) + "\n"
}

pub fn terms() -> String {
    let mut body = list::<TermKind>("Terms", "`kind` of a term.");
    let parameters = TermKind::ALL.iter().flat_map(|term| {
        term.parameters().iter().map(|parameter| {
            let unit = if parameter.name == "roughness" {
                "of the distribution".to_owned()
            } else {
                parameter.unit(None).to_owned()
            };
            let relation = if parameter.lower_excluded { ">" } else { ">=" };
            [
                code(term.name()),
                code(parameter.name),
                parameter.symbol.to_owned(),
                unit,
                format!("{relation} {}", parameter.lower),
                parameter.meaning.to_owned(),
            ]
        })
    });
    let head = ["term", "parameter", "symbol", "unit", "range", "meaning"];
    body.push_str(&format!("## Parameters\n\nIn their order in the file.\n\n{}\n", markdown(head, parameters)));
    let distributions = Distribution::ALL
        .iter()
        .map(|form| [code(form.name()), form.roughness_unit().to_owned(), meaning::<Distribution>(form.name())]);
    let head = ["`distribution`", "unit of roughness", "D, with the roughness r"];
    body.push_str(&format!("## Distributions\n\n{}\n", markdown(head, distributions)));
    body.push_str(&list::<Denominator>("Denominators", "`denominator` of a specular term."));
    titled("Terms", "What each means is in clause 9.", body.trim_end()) + "\n"
}

/// Members of the JSON texts, by the type they belong to.
pub fn provenance() -> String {
    let schema = schema_for!(Provenance).to_value();
    let definitions = schema["$defs"].as_object().unwrap();
    let mut rows = Vec::new();
    for name in ["Receipt", "InputFile", "Assumption", "Notice", "Place", "Step"] {
        let object = &definitions[name];
        let required: Vec<&str> =
            object["required"].as_array().map_or(Vec::new(), |all| all.iter().filter_map(Value::as_str).collect());
        for (member, field) in object["properties"].as_object().unwrap() {
            let there = if required.contains(&member.as_str()) { "always" } else { "optional" };
            let meaning = field["description"].as_str().unwrap_or_default().replace('\n', " ");
            rows.push([name.to_owned(), code(member), there.to_owned(), meaning]);
        }
    }
    let example = full::provenance();
    let canonical = format!(
        "Canonical form of a receipt and of a step with every member, as the datasets hold them (clause 14):\n\n```json\n{}\n{}\n```",
        serde_json::to_string(&example.receipts).unwrap(),
        serde_json::to_string(&example.steps).unwrap()
    );
    titled("Members of receipts and steps", &canonical, &markdown(["object", "member", "there", "meaning"], rows))
}
