//! Spectra in the XML of IES TM-27 (`.spdx`): a header about the source, the quantity, the bandwidth, and one
//! `SpectralData` for each wavelength.
//!
//! `BandwidthFWHM` and `BandwidthCorrected` become the bandpass. Irradiance, radiance and relative spectra are
//! quantities of the standard; flux, intensity and exitance are spectra of a light up to a factor. Ratios
//! (reflectance, transmittance, ...) do not say what to: they stay `unstated`. What describes a light is read as one
//! (`--role` says otherwise); every other element goes into the receipt.

use super::error::{ImportError, fault, quoted};
use super::number::{DecimalMark, printed};
use super::record::Record;
use super::source::Source;
use super::xml::{Xml, child, child_text, children, text};
use crate::dataset::Role;
use crate::quantity::{BandpassCorrection, QuantityKind};

/// True for an XML whose outermost element is of the memorandum.
pub(super) fn is_one(source: &Source) -> bool {
    let content = source.text.content.trim_start();
    content.starts_with('<') && content.contains("<IESTM27")
}

/// Reads the spectrum of a file. What it says beside is among the record's doubts, which the receipt lists.
///
/// # Errors
/// [`ImportError::Malformed`] with the line for missing elements and for wavelengths and values that are none.
pub(super) fn parse(source: &Source) -> Result<Record, ImportError> {
    let xml = Xml::parse(source)?;
    let root = xml.root();
    let malformed = |node, found: String, expected: &str, advice: &str| {
        ImportError::Malformed(fault(xml.place(node), found, expected, advice))
    };
    if !root.tag_name().name().starts_with("IESTM27") {
        let found = format!("the element {}", quoted(root.tag_name().name()));
        return Err(malformed(root, found, "`IESTM2714`, or a later edition", "force another `--format`"));
    }
    let mut distributions = children(root, "SpectralDistribution");
    let Some(distribution) = distributions.next() else {
        let found = "no `SpectralDistribution`".to_owned();
        return Err(malformed(root, found, "one spectrum", "export it again"));
    };
    if let Some(second) = distributions.next() {
        let found = "a second `SpectralDistribution`".to_owned();
        return Err(malformed(second, found, "one spectrum in a file", "split the file"));
    }
    let mut record = Record::new(&source.name, 1, xml.place(distribution).line.unwrap_or(1), "spdx");
    for data in children(distribution, "SpectralData") {
        let nm = data.attribute("wavelength").and_then(|text| printed(text, DecimalMark::Point));
        let Some(nm) = nm.map(|nm| nm.value).filter(|nm| *nm > 0.0) else {
            let found = format!("the wavelength {}", quoted(data.attribute("wavelength").unwrap_or("")));
            return Err(malformed(data, found, "a positive number in nm", "correct it"));
        };
        if let Some(before) = record.nm.last().filter(|before| **before >= nm) {
            let found = format!("{nm} nm after {before} nm");
            return Err(malformed(data, found, "ascending wavelengths", "look for a doubled row, or sort them"));
        }
        let Some(value) = printed(&text(data), DecimalMark::Point) else {
            let found = format!("{} at {nm} nm", quoted(&text(data)));
            return Err(malformed(data, found, "a finite number with a decimal point", "correct it"));
        };
        record.push(nm, value);
    }
    if record.nm.len() < 2 {
        let found = format!("{} `SpectralData`", record.nm.len());
        return Err(malformed(distribution, found, "at least two wavelengths", "export it again"));
    }
    header(&mut record, root);
    quantity(&mut record, distribution);
    bandwidth(&mut record, distribution).map_err(|(node, found)| {
        let expected = "a positive number in nm, and `true` or `false`";
        malformed(node, found, expected, "correct it, or take the element out where the bandwidth is not known")
    })?;
    Ok(record)
}

/// What the memorandum's examples write for nothing.
fn is_known(text: &str) -> bool {
    !["", "n/a", "unknown", "none"].contains(&text.to_ascii_lowercase().as_str())
}

fn header(record: &mut Record, root: roxmltree::Node<'_, '_>) {
    let Some(header) = child(root, "Header") else { return };
    let known = |name| child_text(header, name).filter(|text| is_known(text));
    record.title = known("Description");
    record.details.model = known("MeasurementEquipment");
    let make = [known("Manufacturer"), known("CatalogNumber")].into_iter().flatten().collect::<Vec<_>>().join(" ");
    record.details.make = Some(make).filter(|make| !make.is_empty());
    let kept = ["Description", "MeasurementEquipment"];
    for field in header.children().filter(|field| field.is_element()) {
        let (name, text) = (field.tag_name().name(), text(field));
        if !kept.contains(&name) && is_known(&text) {
            record.doubts.push(format!("the header says {name}: {text}"));
        }
    }
}

fn quantity(record: &mut Record, distribution: roxmltree::Node<'_, '_>) {
    let stated = child_text(distribution, "SpectralQuantity").unwrap_or_default();
    let of_a_light = |unit: &str| {
        format!("`{stated}`, {unit}, is no quantity of the standard: read as relative-spectrum, the values unchanged")
    };
    let (kind, role, doubt) = match stated.to_ascii_lowercase().as_str() {
        "irradiance" => (QuantityKind::SpectralIrradiance, Some(Role::Lamp), None),
        "relative" => (QuantityKind::RelativeSpectrum, Some(Role::Lamp), None),
        "flux" => (QuantityKind::RelativeSpectrum, Some(Role::Lamp), Some(of_a_light("W nm-1"))),
        "intensity" => (QuantityKind::RelativeSpectrum, Some(Role::Lamp), Some(of_a_light("W sr-1 nm-1"))),
        "exitance" => (QuantityKind::RelativeSpectrum, Some(Role::Lamp), Some(of_a_light("W m-2 nm-1"))),
        "radiance" => (QuantityKind::SpectralRadiance, Some(Role::Lamp), None),
        _ => {
            let text =
                format!("the quantity {} does not say what the ratio is to: `--quantity` states it", quoted(&stated));
            (QuantityKind::Unstated, None, Some(text))
        }
    };
    (record.kind, record.role) = (kind, role);
    record.doubts.extend(doubt);
    if role.is_some() {
        record.doubts.push(format!("`{stated}` is read as the spectrum of a light; `--role sample` says otherwise"));
    }
    let kept = ["SpectralQuantity", "BandwidthFWHM", "BandwidthCorrected", "SpectralData"];
    for field in distribution.children().filter(|field| field.is_element()) {
        let (name, text) = (field.tag_name().name(), text(field));
        if !kept.contains(&name) && is_known(&text) {
            record.doubts.push(format!("the distribution says {name}: {text}"));
        }
    }
}

/// The bandwidth, with or without the step's influence taken out of the values.
fn bandwidth<'n, 'a>(
    record: &mut Record,
    distribution: roxmltree::Node<'n, 'a>,
) -> Result<(), (roxmltree::Node<'n, 'a>, String)> {
    if let Some(node) = child(distribution, "BandwidthFWHM").filter(|node| is_known(&text(*node))) {
        let width = printed(&text(node), DecimalMark::Point).map(|width| width.value).filter(|width| *width > 0.0);
        record.details.bandpass_nm =
            Some(width.ok_or_else(|| (node, format!("the bandwidth {}", quoted(&text(node)))))?);
    }
    if let Some(node) = child(distribution, "BandwidthCorrected").filter(|node| is_known(&text(*node))) {
        let correction = match text(node).to_ascii_lowercase().as_str() {
            "true" | "1" => BandpassCorrection::Corrected,
            "false" | "0" => BandpassCorrection::Uncorrected,
            other => return Err((node, format!("{} as `BandwidthCorrected`", quoted(other)))),
        };
        record.details.bandpass_correction = Some(correction);
        if record.details.bandpass_nm.is_none() {
            let text = format!("BandwidthCorrected is {}, and no bandwidth is stated", text(node));
            record.doubts.push(text);
        }
    }
    Ok(())
}
