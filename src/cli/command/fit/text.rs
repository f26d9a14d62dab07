//! The result for people.

use super::{FittedModel, NumberOrList, ParameterResult};
use crate::quantity::rounded_with_uncertainty;
use crate::terms::TermKind;

/// The result for people: one line per parameter, then what was found.
pub(super) fn text(model: &FittedModel) -> String {
    let mut lines = vec![format!(
        "{}: measurement `{}`, {}, reference {}",
        model.file,
        model.measurement,
        reduction_in_words(model),
        model.reference
    )];
    for term in &model.terms {
        for (name, parameter) in &term.parameters {
            lines.push(parameter_line(term.kind, name, parameter));
        }
        if let (Some(distribution), Some(denominator)) = (term.distribution, term.denominator) {
            lines.push(format!("  {:<18}distribution {distribution}, denominator {denominator}", ""));
        }
    }
    let residual = &model.residual;
    lines.push(format!(
        "  {} values fitted, {} left out; residual r.m.s. {:.3e}, reduced chi-square {}",
        residual.count,
        residual.left_out,
        residual.rms.unwrap_or(f64::NAN),
        residual.reduced_chi_square.map_or("not known (no uncertainties)".to_owned(), |value| format!("{value:.3}"))
    ));
    if let Some(s) = &model.separability {
        lines.push(format!(
            "  separability, as r.m.s. departures\n\
             {0:20}average over viewing from a cosine: {1:.1} % of its amplitude\n\
             {0:20}average over incidence from a constant: {2:.1} % of its mean\n\
             {0:20}all values from the best product of both: {3:.1} % of their r.m.s.",
            "",
            100.0 * s.cosine_relative_rms,
            100.0 * s.constancy_relative_rms,
            100.0 * s.rank_one_relative_rms
        ));
    }
    lines.extend(model.identifiability.iter().map(|finding| format!("  note: {finding}")));
    lines.extend(model.donaldson.iter().flat_map(|completion| completion.lines()));
    if !model.converged {
        lines.push(format!("  NOT CONVERGED: {}", model.method));
    }
    lines.join("\n")
}

/// What was fitted, for people: a reduction to `none` keeps every emission value.
fn reduction_in_words(model: &FittedModel) -> String {
    match (model.reduction.as_str(), &model.emission_nm) {
        ("none", Some(nm)) if nm.len() == 1 => format!("its one wavelength with a model, {} nm", nm[0]),
        ("none", Some(nm)) => format!("every wavelength ({} with a model)", nm.len()),
        ("none", None) => "its one band".to_owned(),
        (reduction, _) => reduction.to_owned(),
    }
}

/// The 95 % interval of one number, with an open end said so.
fn interval_text(parameter: &ParameterResult) -> String {
    let (Some(NumberOrList::Number(low)), Some(NumberOrList::Number(high))) =
        (&parameter.interval_low, &parameter.interval_high)
    else {
        return String::new();
    };
    // As many digits as the uncertainty has, and one more.
    let sigma = match parameter.standard_uncertainty {
        NumberOrList::Number(Some(sigma)) if sigma > 0.0 => sigma,
        _ => 1e-3,
    };
    let digits = (1.0 - sigma.log10().floor()).clamp(0.0, 12.0) as usize;
    match (low, high) {
        (Some(low), Some(high)) => format!(", 95 %: {low:.digits$} to {high:.digits$}"),
        (Some(low), None) => format!(", 95 %: above {low:.digits$}"),
        (None, Some(high)) => format!(", 95 %: below {high:.digits$}"),
        (None, None) => ", 95 %: open on both sides".to_owned(),
    }
}

fn parameter_line(term: TermKind, name: &str, parameter: &ParameterResult) -> String {
    let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
    let shared = match &parameter.shared_relative_uncertainty {
        Some(NumberOrList::Number(Some(shared))) => format!(", and {:.2} % shared with all values", 100.0 * shared),
        _ => String::new(),
    };
    match (&parameter.value, &parameter.standard_uncertainty) {
        (NumberOrList::Number(value), NumberOrList::Number(sigma)) => {
            let value = value.unwrap_or(f64::NAN);
            let known = sigma.and_then(|sigma| rounded_with_uncertainty(value, sigma));
            let known = known.unwrap_or_else(|| format!("{value:.6} ± unknown"));
            let interval = interval_text(parameter);
            format!("  {term:<18}{name:<18}{known}{unit}{shared}{interval}")
        }
        (NumberOrList::List(values), _) => {
            let known = values.iter().flatten();
            let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
            format!("  {term:<18}{name:<18}{} values from {low:.4} to {high:.4}{unit} (all with --json)", values.len())
        }
        _ => format!("  {term:<18}{name:<18}"),
    }
}
