//! What refers to a measurement by its digest goes on to refer to it after the measurement has changed in form.

use miette::miette;

use crate::container::measurement_digest;
use crate::dataset::Document;

/// Changes a document. Models, and the matrices that complete them, keep the measurement they refer to: by its digest it is then that
/// measurement as it is after the change. What was outdated before stays so.
pub(crate) fn keeping_references<T>(
    document: &mut Document,
    change: impl FnOnce(&mut Document) -> Result<T, miette::Report>,
) -> Result<T, miette::Report> {
    let current = references(document)
        .into_iter()
        .map(|(id, stated)| Ok(digest(document, &id)?.as_deref() == Some(stated.as_str())))
        .collect::<Result<Vec<bool>, miette::Report>>()?;
    let result = change(document)?;
    let digests = references(document)
        .into_iter()
        .map(|(id, _)| digest(document, &id))
        .collect::<Result<Vec<Option<String>>, miette::Report>>()?;
    for ((slot, is_current), digest) in slots(document).into_iter().zip(current).zip(digests) {
        if let (true, Some(digest)) = (is_current, digest) {
            *slot = digest;
        }
    }
    Ok(result)
}

/// The measurements referred to, with the digests stated of them, in the order of [`slots`].
fn references(document: &Document) -> Vec<(String, String)> {
    let models = document.models.iter().map(|model| (model.measurement.to_string(), model.data_digest.clone()));
    let parts = document.factorisations.iter().map(|part| (part.measurement.to_string(), part.data_digest.clone()));
    let attached = document.models.iter().filter_map(|model| model.donaldson.as_ref()).flat_map(|attached| {
        [(&attached.elastic, &attached.elastic_digest), (&attached.luminescent, &attached.luminescent_digest)]
            .map(|(id, digest)| (id.to_string(), digest.clone()))
    });
    let attached: Vec<(String, String)> = attached.collect();
    models.chain(parts).chain(attached).collect()
}

/// Where the digests are stated.
fn slots(document: &mut Document) -> Vec<&mut String> {
    let (mut models, mut attached) = (Vec::new(), Vec::new());
    for model in &mut document.models {
        models.push(&mut model.data_digest);
        if let Some(attachment) = &mut model.donaldson {
            attached.extend([&mut attachment.elastic_digest, &mut attachment.luminescent_digest]);
        }
    }
    models.extend(document.factorisations.iter_mut().map(|part| &mut part.data_digest));
    models.extend(attached);
    models
}

fn digest(document: &Document, id: &str) -> Result<Option<String>, miette::Report> {
    document.measurement(id).map(measurement_digest).transpose().map_err(|error| miette!("{error}"))
}
