//! The page of a diagnosis.

use super::Shown;
use crate::dataset::{Document, FittedTerm, Model};
use crate::fit::{Interval, MeasurementDiagnosis, Verdict};
use crate::report::html::{Html, number, value_and_uncertainty};
use crate::report::page::{head, write_drawn};
use crate::terms::TermKind;

/// Values listed as the most influential.
const INFLUENTIAL: usize = 10;
/// Repeated geometries listed, those that scatter most.
const REPEATED: usize = 12;

/// One page about what a fit rests on, self-contained: parameters with their intervals, residuals, leverage, influence,
/// profiles. `model` is the model that the diagnosis is of. Every text of the document is escaped.
#[must_use]
pub fn diagnosis_page(document: &Document, model: &Model, diagnosis: &MeasurementDiagnosis) -> String {
    let shown = Shown::new(document, model, diagnosis);
    let mut html = Html::default();
    head(&mut html, &format!("Diagnosis of the fit of {}", shown.subject));
    html.markup("</header>\n<main>\n");
    if !model.converged {
        html.markup("<div class=\"notice\">");
        html.text("strong", "This fit did not converge. Its parameters describe where it stopped, not the surface.");
        html.markup("</div>\n");
    }
    write_summary(&mut html, &shown);
    write_parameters(&mut html, &shown);
    if !model.identifiability.is_empty() {
        html.text("h2", "What the data cannot tell, and other findings");
        html.list(&model.identifiability);
    }
    html.text("h2", "Residuals and leverage");
    write_drawn(&mut html, Some(&shown.residual_figures()));
    write_repeats(&mut html, &shown);
    write_influence(&mut html, &shown);
    if !diagnosis.diagnosis.profiles.is_empty() {
        html.text("h2", "Profiles: what the data allow each parameter");
        write_drawn(&mut html, Some(&shown.profile_figures()));
    }
    let spectral = shown.spectral_figures();
    if !spectral.figures.is_empty() {
        html.text("h2", "Over the wavelengths");
        write_drawn(&mut html, Some(&spectral));
    }
    html.markup("</main>\n</body>\n</html>\n");
    html.finish()
}

fn write_summary(html: &mut Html, shown: &Shown<'_>) {
    let (model, fit) = (shown.model, &shown.of.diagnosis.fit);
    let used = shown.of.diagnosis.residual.iter().filter(|residual| residual.is_finite()).count();
    let chi_square = shown.of.data.sigma.is_some().then(|| {
        format!(
            "{} over {} degrees of freedom, {} each",
            number(fit.chi_square),
            number(fit.degrees_of_freedom),
            number(fit.chi_square / fit.degrees_of_freedom)
        )
    });
    html.facts(&[
        ("fitted to", Some(format!("measurement {}, {}", model.measurement, model.reduction))),
        ("reference in the model", Some(model.reference.to_string())),
        ("values", Some(format!("{used} fitted, {} left out", model.residuals.left_out))),
        ("chi-square", chi_square),
        ("r.m.s. residual", Some(format!("{} (unit {})", number(model.residuals.rms), model.unit))),
        ("method", Some(model.method.clone())),
    ]);
}

fn write_parameters(html: &mut Html, shown: &Shown<'_>) {
    let rows: Vec<Vec<String>> = shown
        .model
        .terms
        .iter()
        .flat_map(|term| (0..term.parameters.len()).map(move |k| row(shown, term, k)))
        .collect();
    html.text("h2", "Parameters");
    html.table(
        &["term", "parameter", "value", "standard uncertainty (k = 1)", "95 % interval (profile)", "unit"],
        &rows,
    );
}

fn row(shown: &Shown<'_>, term: &FittedTerm, k: usize) -> Vec<String> {
    let parameter = &term.parameters[k];
    let (value, sigma) = match (&parameter.value[..], &parameter.standard_uncertainty[..]) {
        ([value], [sigma]) => value_and_uncertainty(*value, *sigma),
        (values, _) => (format!("{} values, drawn below", values.len()), "drawn below".to_owned()),
    };
    let intervals = &shown.of.diagnosis.intervals;
    let (interval, offset) = match (term.kind, k) {
        (TermKind::Lambertian | TermKind::Luminescent, _) => (intervals.diffuse, 0.0),
        (TermKind::TorranceSparrow, 0) => (intervals.intensity, 0.0),
        (TermKind::TorranceSparrow, 1) => (intervals.roughness, 0.0),
        (TermKind::TorranceSparrow, _) => (intervals.index_minus_one, 1.0),
    };
    let interval = interval_text(interval, offset);
    vec![term.kind.to_string(), parameter.name.clone(), value, sigma, interval, parameter.unit.clone()]
}

/// An interval in words; an open end is no end.
pub(super) fn interval_text(interval: Option<Interval>, offset: f64) -> String {
    let Some(Interval { low, high, low_open, high_open }) = interval else { return "none formed".to_owned() };
    let (low, high) = (number(low + offset), number(high + offset));
    match (low_open, high_open) {
        (false, false) => format!("{low} to {high}"),
        (false, true) => format!("{low} upwards: open, searched up to {high}"),
        (true, false) => format!("up to {high}: open below, searched down to {low}"),
        (true, true) => format!("not told by these data: open on both sides, searched from {low} to {high}"),
    }
}

/// The scatter of repeated geometries beside the stated uncertainties: no model is between them.
fn write_repeats(html: &mut Html, shown: &Shown<'_>) {
    html.text("h3", "Geometries measured more than once");
    let Some(repeats) = &shown.of.repeats else {
        let why = if shown.of.data.sigma.is_some() {
            "No geometry was measured twice: nothing but the model can be compared with the stated uncertainties."
        } else {
            "No uncertainties are stated, so that the scatter of repeated geometries has nothing to be compared with."
        };
        html.text("p", why);
        return;
    };
    let verdict = match repeats.verdict() {
        Verdict::TooSmall => "the stated uncertainties are too small for what repeats",
        Verdict::Larger => "the stated uncertainties are larger than what repeats shows",
        Verdict::Agrees => "in agreement",
    };
    html.text(
        "p",
        &format!(
            "{} geometries have several values; these scatter about their means by {:.2} of the stated uncertainties (known to \
             {:.2}, from {} degrees of freedom): {verdict}.",
            repeats.geometries.len(),
            repeats.scatter,
            repeats.scatter_uncertainty(),
            repeats.degrees_of_freedom
        ),
    );
    let mut listed: Vec<_> = repeats.geometries.iter().collect();
    listed.sort_by(|a, b| b.scatter.total_cmp(&a.scatter));
    let rows: Vec<Vec<String>> = listed
        .into_iter()
        .take(REPEATED)
        .map(|one| {
            let which: Vec<String> = one.rows.iter().map(|row| shown.of.data.rows[*row].to_string()).collect();
            vec![angles(&one.geometry), which.join(", "), format!("{:.2}", one.scatter)]
        })
        .collect();
    html.table(&["theta_i, phi_i, theta_v, phi_v (degrees)", "rows (from 0)", "scatter / stated uncertainty"], &rows);
}

fn angles(geometry: &crate::quantity::Geometry) -> String {
    let crate::quantity::Geometry { incidence, viewing } = geometry;
    [incidence.theta_deg(), incidence.phi_deg(), viewing.theta_deg(), viewing.phi_deg()].map(number).join(", ")
}

fn write_influence(html: &mut Html, shown: &Shown<'_>) {
    let diagnosis = &shown.of.diagnosis;
    html.text("h2", "Influence");
    html.text(
        "p",
        &format!(
            "The leverages add up to the number of free parameters that the data can tell, {}. The most influential values, by \
             Cook's distance: how far all predictions move when the value is left out.",
            diagnosis.parameters
        ),
    );
    let nm = shown.wavelengths();
    let mut header = vec!["row (from 0)", "theta_i, phi_i, theta_v, phi_v (degrees)"];
    header.extend(nm.map(|_| "wavelength (nm)"));
    header.extend(["value", "predicted", "residual / uncertainty", "leverage", "Cook's distance"]);
    let rows: Vec<Vec<String>> = diagnosis
        .most_influential(INFLUENTIAL)
        .into_iter()
        .map(|at| {
            let (emission, geometry) = at;
            let mut row = vec![shown.of.data.rows[geometry].to_string(), angles(&shown.of.data.geometry[geometry])];
            row.extend(nm.map(|nm| number(nm[emission])));
            let distance = diagnosis.influence[at];
            row.extend([
                number(shown.of.data.values[at]),
                number(diagnosis.predicted[at]),
                format!("{:.2}", diagnosis.residual[at]).replacen('-', "\u{2212}", 1),
                format!("{:.4}", diagnosis.leverage[at]),
                if distance.is_finite() { number(distance) } else { "alone determines a parameter".to_owned() },
            ]);
            row
        })
        .collect();
    html.table(&header, &rows);
}
