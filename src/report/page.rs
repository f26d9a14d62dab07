//! One HTML page about a document: self-contained, without scripts, for light and dark screens.

use super::fitted::quantity_words;
use super::html::{Html, escaped, number, value_and_uncertainty};
use super::{
    AnglePoints, Drawn, Figure, factor_figures, fitted_figures, matrix_figures, measurement_figures, scan_figures,
    subject,
};
use crate::dataset::{
    Document, FittedParameter, FittedTerm, Measurement, Model, Provenance, Receipt, Sample, Separability,
};
use crate::quantity::{EmissionAxis, Flag, QuantityKind};

/// The style sheet of the page.
const STYLE: &str = include_str!("page.css");
/// Lists longer than this are folded.
const FOLDED: usize = 12;

/// The figures of a document, in its own order; a list may be shorter than the document's, or empty.
#[derive(Debug, Default)]
pub struct Pictures {
    /// One entry per model.
    pub models: Vec<Drawn>,
    /// One entry per measurement.
    pub measurements: Vec<Drawn>,
    /// One entry per factorisation.
    pub factorisations: Vec<Drawn>,
}

impl Pictures {
    /// Draws everything that can be drawn of a document; what cannot is listed with the reason.
    #[must_use]
    pub fn of(document: &Document) -> Self {
        let drawn = |model: &Model| match AnglePoints::of(document, model) {
            Ok(points) => fitted_figures(document, model, &points),
            Err(error) => Drawn { figures: Vec::new(), not_drawn: vec![error.in_full()] },
        };
        Self {
            models: document.models.iter().map(drawn).collect(),
            measurements: document.measurements.iter().map(|one| measured(document, one)).collect(),
            factorisations: document.factorisations.iter().map(|one| factor_figures(document, one)).collect(),
        }
    }

    /// What was drawn and what was not, models first.
    pub fn all(&self) -> impl Iterator<Item = &Drawn> {
        self.models.iter().chain(&self.measurements).chain(&self.factorisations)
    }

    /// Every figure, models first.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.all().flat_map(|drawn| &drawn.figures)
    }
}

/// A matrix over excitation and emission; any other measurement over the angles, where no model shows it so, and over the
/// wavelengths.
fn measured(document: &Document, measurement: &Measurement) -> Drawn {
    if measurement.quantity.kind == QuantityKind::DonaldsonMatrix {
        return matrix_figures(document, measurement);
    }
    let mut drawn = scan_figures(document, measurement);
    let Drawn { figures, not_drawn } = measurement_figures(document, measurement);
    drawn.figures.extend(figures);
    drawn.not_drawn.extend(not_drawn);
    drawn
}

/// The page about a document: what it holds, the fitted parameters, what the data cannot tell, the figures, and what
/// the importer assumed. Every text of the document is escaped.
#[must_use]
pub fn page(document: &Document, pictures: &Pictures) -> String {
    let title = document.title.as_deref().unwrap_or("A bbrf document");
    let mut html = Html::default();
    head(&mut html, title);
    html.facts(&[("licence", document.license.clone()), ("cite as", document.citation.clone())]);
    html.markup("</header>\n<main>\n");
    write_simulated(&mut html, &document.samples);
    write_models(&mut html, document, pictures);
    write_measurements(&mut html, document, pictures);
    write_factorisations(&mut html, document, pictures);
    write_provenance(&mut html, &document.provenance);
    html.markup("</main>\n</body>\n</html>\n");
    html.finish()
}

/// The start of a page, up to its heading.
pub(super) fn head(html: &mut Html, title: &str) {
    html.markup("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    html.markup("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    html.text("title", title);
    html.markup(&format!("<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n"));
    html.text("h1", title);
}

fn write_simulated(html: &mut Html, samples: &[Sample]) {
    let simulated: Vec<&str> = samples
        .iter()
        .filter(|sample| sample.simulated)
        .map(|sample| sample.title.as_deref().unwrap_or(sample.id.as_str()))
        .collect();
    if !simulated.is_empty() {
        let text = format!("Simulated, not measured: {}.", simulated.join("; "));
        html.markup("<div class=\"notice\">");
        html.text("strong", &text);
        html.markup("</div>\n");
    }
}

fn write_models(html: &mut Html, document: &Document, pictures: &Pictures) {
    if document.models.is_empty() {
        return;
    }
    html.text("h2", "Fitted models");
    for (index, model) in document.models.iter().enumerate() {
        html.text("h3", model.title.as_deref().unwrap_or(model.id.as_str()));
        if !model.converged {
            html.markup("<div class=\"notice\">");
            html.text(
                "strong",
                "This fit did not converge. Its parameters describe where it stopped, not the surface.",
            );
            html.markup("</div>\n");
        }
        write_parameters(html, model);
        write_fit(html, model);
        if !model.identifiability.is_empty() {
            html.text("p", "What the data cannot tell, and other findings:");
            html.list(&model.identifiability);
        }
        write_drawn(html, pictures.models.get(index));
    }
}

fn write_parameters(html: &mut Html, model: &Model) {
    let rows: Vec<Vec<String>> = model
        .terms
        .iter()
        .flat_map(|term| term.parameters.iter().map(move |parameter| parameter_row(term, parameter)))
        .collect();
    html.table(&["term", "parameter", "value", "standard uncertainty (k = 1)", "shared, relative", "unit"], &rows);
}

fn parameter_row(term: &FittedTerm, parameter: &FittedParameter) -> Vec<String> {
    let (value, sigma) = match (&parameter.value[..], &parameter.standard_uncertainty[..]) {
        ([value], [sigma]) => value_and_uncertainty(*value, *sigma),
        ([value], _) => (number(*value), "unknown".to_owned()),
        (values, sigmas) => (range(values), range(sigmas)),
    };
    let shared = match &parameter.shared_relative_uncertainty[..] {
        [] => "none".to_owned(),
        [only] => percent(*only),
        many => format!("up to {}", percent(many.iter().copied().fold(0.0, f64::max))),
    };
    vec![term_name(term), parameter.name.clone(), value, sigma, shared, parameter.unit.clone()]
}

fn term_name(term: &FittedTerm) -> String {
    let details: Vec<&str> = [term.distribution.map(|form| form.name()), term.denominator.map(|form| form.name())]
        .into_iter()
        .flatten()
        .collect();
    if details.is_empty() { term.kind.to_string() } else { format!("{} ({})", term.kind, details.join(", ")) }
}

/// Of many values how many there are and between what they lie.
fn range(values: &[f64]) -> String {
    match super::scale::extent(values.iter().copied()) {
        Some((low, high)) => format!("{} values, {} to {}", values.len(), number(low), number(high)),
        None => "unknown".to_owned(),
    }
}

fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.2} %", 100.0 * share) } else { "unknown".to_owned() }
}

fn write_fit(html: &mut Html, model: &Model) {
    let residuals = &model.residuals;
    html.facts(&[
        ("fitted to", Some(format!("measurement {}", model.measurement))),
        ("fitted number", Some(format!("{} ({})", model.reduction, emission(&model.emission)))),
        ("reference in the model", Some(model.reference.to_string())),
        ("values", Some(format!("{} fitted, {} left out", residuals.count, residuals.left_out))),
        ("r.m.s. residual", Some(format!("{} (unit {})", number(residuals.rms), model.unit))),
        ("reduced chi-square", Some(number(residuals.reduced_chi_square))),
        ("separability", model.separability.as_ref().map(separability)),
        ("method", Some(model.method.clone())),
        ("digest of the data", Some(model.data_digest.clone())),
    ]);
}

/// The three departures, each with what it is relative to.
fn separability(check: &Separability) -> String {
    format!(
        "r.m.s. departure of the average over viewing from a cosine {} of its amplitude; of the average over incidence from a \
         constant {} of its mean; of all values from the best product f(theta_i) g(theta_v) {} of their r.m.s.",
        percent(check.cosine_relative_rms),
        percent(check.constancy_relative_rms),
        percent(check.rank_one_relative_rms)
    )
}

fn write_measurements(html: &mut Html, document: &Document, pictures: &Pictures) {
    if document.measurements.is_empty() {
        return;
    }
    html.text("h2", "Measurements");
    for (index, measurement) in document.measurements.iter().enumerate() {
        let which = subject::which(measurement, quantity_words(measurement.quantity.kind));
        let title = measurement.title.as_ref().map(|title| format!("{title}: ")).unwrap_or_default();
        html.text("h3", &format!("{title}{which}"));
        write_measurement(html, document, measurement);
        write_drawn(html, pictures.measurements.get(index));
    }
}

fn write_measurement(html: &mut Html, document: &Document, measurement: &Measurement) {
    let quantity = &measurement.quantity;
    let unstated = quantity.unstated_fields();
    let sample = measurement.sample.as_ref().map(|id| sample_title(document, id.as_str()));
    let is_ratio = quantity.kind.is_factor();
    html.facts(&[
        ("id", Some(measurement.id.to_string())),
        ("looked at", Some(measurement.role.to_string())),
        ("sample", sample),
        ("quantity", Some(format!("{} ({}), part: {}", quantity.kind, quantity.kind.unit(), quantity.part))),
        ("reference", is_ratio.then(|| format!("{}, light: {}", quantity.reference, quantity.reference_light))),
        ("acquisitions", Some(measurement.acquisitions.len().to_string())),
        ("emission", Some(emission(&measurement.emission))),
        ("flags", Some(flag_counts(measurement))),
        ("not stated by the source", (!unstated.is_empty()).then(|| unstated.join(", "))),
    ]);
}

fn write_factorisations(html: &mut Html, document: &Document, pictures: &Pictures) {
    if document.factorisations.is_empty() {
        return;
    }
    html.text("h2", "Factors of matrices");
    for (index, part) in document.factorisations.iter().enumerate() {
        html.text("h3", part.title.as_deref().unwrap_or(part.id.as_str()));
        html.facts(&[
            ("of", Some(format!("measurement {}", part.measurement))),
            ("factors", Some(part.excitation.nrows().to_string())),
            ("reflected light", Some(format!("within {} nm of the excitation", number(part.reach_nm)))),
            ("noise where no light can be", Some(number(part.floor))),
            ("r.m.s. residual", Some(format!("{} of {} cells", number(part.residual_rms), part.residual_count))),
            ("method", Some(part.method.clone())),
            ("digest of the matrix", Some(part.data_digest.clone())),
        ]);
        html.list(&part.findings);
        write_drawn(html, pictures.factorisations.get(index));
    }
}

fn sample_title(document: &Document, id: &str) -> String {
    let sample = document.samples.iter().find(|sample| sample.id.as_str() == id);
    sample.and_then(|sample| sample.title.clone()).unwrap_or_else(|| id.to_owned())
}

fn emission(axis: &EmissionAxis) -> String {
    match axis {
        EmissionAxis::Wavelengths(axis) => match (axis.nm.first(), axis.nm.last()) {
            (Some(first), Some(last)) => format!("{} wavelengths, {first} to {last} nm", axis.nm.len()),
            _ => "no wavelength".to_owned(),
        },
        EmissionAxis::Band { band: Some(band) } => format!("band {band} nm"),
        EmissionAxis::Band { band: None } => "one band, unstated".to_owned(),
    }
}

/// How many values carry each flag.
fn flag_counts(measurement: &Measurement) -> String {
    let total = measurement.flags.len();
    let counts: Vec<String> = Flag::ALL
        .into_iter()
        .map(|flag| (flag, measurement.flags.iter().filter(|mask| **mask & flag.bit() != 0).count()))
        .filter(|(_, count)| *count > 0)
        .map(|(flag, count)| format!("{}: {count}", flag.name()))
        .collect();
    if counts.is_empty() {
        format!("none of {total} values")
    } else {
        format!("of {total} values: {}", counts.join(", "))
    }
}

pub(super) fn write_drawn(html: &mut Html, drawn: Option<&Drawn>) {
    let Some(drawn) = drawn else { return };
    if !drawn.figures.is_empty() {
        html.markup("<div class=\"figures\">\n");
        for figure in &drawn.figures {
            // The caption is the picture's name for a reader who does not see it.
            let name = escaped(figure.name());
            let image = format!("role=\"img\" aria-labelledby=\"caption-{name}\"");
            let svg = figure.to_svg().replacen("role=\"img\"", &image, 1);
            html.markup(&format!("<figure id=\"figure-{name}\">\n{svg}\n<figcaption id=\"caption-{name}\">"));
            html.markup(&escaped(figure.caption()));
            html.markup("</figcaption>\n</figure>\n");
        }
        html.markup("</div>\n");
    }
    if !drawn.not_drawn.is_empty() {
        html.text("p", "Not drawn:");
        html.list(&drawn.not_drawn);
    }
}

fn write_provenance(html: &mut Html, provenance: &Provenance) {
    if provenance.receipts.is_empty() && provenance.steps.is_empty() {
        return;
    }
    html.text("h2", "Where the numbers come from");
    for receipt in &provenance.receipts {
        write_receipt(html, receipt);
    }
    let steps = provenance.steps.iter().map(|step| {
        let time = step.time.as_ref().map(|time| format!(" ({time})")).unwrap_or_default();
        format!("{}: {}{time}", step.tool, step.action)
    });
    let steps: Vec<String> = steps.collect();
    if !steps.is_empty() {
        html.text("h3", "Steps since");
        html.list(&steps);
    }
}

fn write_receipt(html: &mut Html, receipt: &Receipt) {
    html.text("h3", &format!("Receipt of {}", receipt.tool));
    let assumptions = receipt.assumptions.iter().map(|one| format!("{} [{}]", one.text, one.place));
    write_folding(html, "Assumptions", assumptions.collect());
    let notices = receipt.notices.iter().map(|one| format!("{} [{}]", one.text, one.place));
    write_folding(html, "Notices", notices.collect());
    write_folding(html, "Not filled by the source", receipt.unfilled.clone());
    let rows: Vec<Vec<String>> = receipt
        .inputs
        .iter()
        .map(|input| {
            vec![
                input.name.clone(),
                input.dialect.clone(),
                input.records.to_string(),
                input.bytes.to_string(),
                input.sha256.clone(),
            ]
        })
        .collect();
    html.markup("<details><summary>");
    html.markup(&escaped(&format!("Inputs ({})", rows.len())));
    html.markup("</summary>\n");
    html.table(&["file", "dialect", "records", "bytes", "SHA-256"], &rows);
    html.markup("</details>\n");
}

/// A list under a heading, folded where it is long.
fn write_folding(html: &mut Html, heading: &str, items: Vec<String>) {
    if items.is_empty() {
        return;
    }
    let open = if items.len() > FOLDED { "" } else { " open" };
    html.markup(&format!("<details{open}><summary>{} ({})</summary>\n", escaped(heading), items.len()));
    html.list(&items);
    html.markup("</details>\n");
}
