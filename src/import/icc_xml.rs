//! iccMAX profiles as XML (the form of iccDEV's tools) whose colours are bispectral matrices.
//!
//! `SpectralRange` in the header gives the emission wavelengths, `BiSpectralRange` those of the excitation. Each structure
//! under `ArrayTags` whose members include `spec` is a colour; its numbers are the rows of emission, one after the other,
//! each over the excitation: iccDEV multiplies the rows with the spectrum of the light and adds up, without a step
//! (`CIccPcsStepSrcMatrix`). So what is off the diagonal is a density times the *excitation* step, where a Donaldson
//! matrix has the width of the emission bandpass: the receipt says so.

use super::Options;
use super::bispectral::{self, Grid, Said};
use super::error::{ImportError, fault, quoted};
use super::number::value;
use super::receipt::{Notes, listed};
use super::record::Details;
use super::source::Source;
use super::unique::UniqueIds;
use super::xml::{Xml, child, child_text, children, text};
use crate::dataset::{Document, Place};
use crate::quantity::{NormalisedAt, Part, Quantity, QuantityKind};

/// True for an XML whose outermost element is a profile.
pub(super) fn is_one(source: &Source) -> bool {
    let content = source.text.content.trim_start();
    content.starts_with('<') && content.contains("<IccProfile")
}

/// Reads a profile as a document with one measurement for each colour.
///
/// # Errors
/// [`ImportError`] with the line for a profile without bispectral colours, for ranges and numbers that do not fit, and
/// for numbers that stand in another file or are scaled.
pub(super) fn document(source: &Source, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    let base = Quantity {
        part: Part::Total,
        normalised_at: NormalisedAt::Excitation,
        ..Quantity::unstated(QuantityKind::DonaldsonMatrix)
    };
    bispectral::refuse_settings(source, &options.settings, "a profile of bispectral colours")?;
    bispectral::refuse_quantity(source, &options.settings, &base)?;
    let xml = Xml::parse(source)?;
    let profile = Profile::of(source, &xml)?;
    let mut ids = UniqueIds::default();
    let mut measurements = Vec::new();
    for colour in &profile.colours {
        let grid = profile.grid(colour)?;
        let one = profile.colours.len() == 1;
        let id = options.settings.id.as_deref().filter(|_| one).unwrap_or(&colour.name);
        let said = Said {
            id: ids.of(id),
            title: options.settings.title.clone().filter(|_| one).or_else(|| Some(colour.name.clone())),
            quantity: bispectral::stated(&options.settings, base.clone()),
            time: None,
            operator: None,
            place: colour.place.clone(),
        };
        let sample = colour.is_named.then(|| colour.name.clone());
        measurements.push((bispectral::measurement(grid, said, options)?, sample));
    }
    let mut input = source.input.clone();
    input.dialect = format!("icc-xml, {}", source.text.encoding.name());
    input.records = measurements.len() as u64;
    notes.input(input);
    profile.note(source, notes);
    let mut document = bispectral::document(measurements, &Details::default(), &options.settings, notes)?;
    document.title = document.title.or(profile.title);
    Ok(document)
}

/// A colour of the profile.
struct Colour<'n, 'a> {
    name: String,
    is_named: bool,
    /// The element with the tag `spec`.
    node: roxmltree::Node<'n, 'a>,
    place: Place,
}

struct Profile<'n, 'a> {
    xml: &'n Xml<'a>,
    title: Option<String>,
    emission_nm: Vec<f64>,
    excitation_nm: Vec<f64>,
    colours: Vec<Colour<'n, 'a>>,
    /// Names of header fields and tags that have no place.
    left: Vec<String>,
}

impl<'n, 'a> Profile<'n, 'a> {
    fn of(source: &Source, xml: &'n Xml<'a>) -> Result<Self, ImportError> {
        let root = xml.root();
        let no_matrix = |found: &str| {
            let expected = "an iccMAX profile with SpectralRange, BiSpectralRange and colours with a `spec` matrix";
            let advice = "only bispectral colours are read from ICC profiles";
            ImportError::Malformed(fault(source.at_line(1), found, expected, advice))
        };
        if root.tag_name().name() != "IccProfile" {
            return Err(no_matrix(&format!("the element {}", quoted(root.tag_name().name()))));
        }
        let header = child(root, "Header").ok_or_else(|| no_matrix("an ICC profile without `Header`"))?;
        let bispectral = child(header, "BiSpectralRange");
        let excitation = bispectral.ok_or_else(|| no_matrix("an ICC profile without `BiSpectralRange`"))?;
        let emission =
            child(header, "SpectralRange").ok_or_else(|| no_matrix("an ICC profile without `SpectralRange`"))?;
        let limit = source.input.bytes;
        let (emission_nm, excitation_nm) = (range(xml, emission, limit)?, range(xml, excitation, limit)?);
        let colours: Vec<Colour<'n, 'a>> = root
            .descendants()
            .filter(|node| node.has_tag_name("MemberTags"))
            .filter_map(|node| colour(xml, node))
            .collect();
        if colours.is_empty() {
            return Err(no_matrix("a profile without a colour that has a `spec` matrix"));
        }
        let fields = header.children().filter(|field| field.is_element());
        let known = ["SpectralRange", "BiSpectralRange", "SpectralPCS"];
        let mut left: Vec<String> = fields
            .map(|field| field.tag_name().name())
            .filter(|name| !known.contains(name))
            .map(str::to_owned)
            .collect();
        let tags = child(root, "Tags").into_iter().flat_map(|tags| tags.children().filter(|tag| tag.is_element()));
        let signature = |tag| child_text(tag, "TagSignature");
        left.extend(tags.clone().filter_map(signature).filter(|tag| !["desc", "ncl2"].contains(&tag.as_str())));
        let title = tags
            .filter(|tag| signature(*tag).as_deref() == Some("desc"))
            .find_map(|tag| child_text(tag, "LocalizedText"));
        let profile = Self { xml, title, emission_nm, excitation_nm, colours, left };
        profile.check_channels(header)?;
        Ok(profile)
    }

    /// `bs04F7`: as many channels as the matrix has cells.
    fn check_channels(&self, header: roxmltree::Node<'_, '_>) -> Result<(), ImportError> {
        let Some(node) = child(header, "SpectralPCS") else { return Ok(()) };
        let stated = text(node);
        let Some(channels) = stated.strip_prefix("bs").and_then(|hex| usize::from_str_radix(hex, 16).ok()) else {
            let advice = "only matrices that are stored in full (`bs`) are read";
            return Err(self.malformed(
                node,
                format!("the spectral space {}", quoted(&stated)),
                "`bs` and a number",
                advice,
            ));
        };
        let cells = self.emission_nm.len().saturating_mul(self.excitation_nm.len());
        if channels == cells {
            return Ok(());
        }
        let expected = format!("{cells} channels, as the ranges give");
        Err(self.malformed(node, format!("{channels} channels in {}", quoted(&stated)), expected, "correct the ranges"))
    }

    fn grid(&self, colour: &Colour<'_, '_>) -> Result<Grid, ImportError> {
        let kind = colour.node.tag_name().name();
        if !matches!(kind, "float16NumberType" | "float32NumberType" | "float64NumberType") {
            let advice = "integers are scaled and sparse matrices packed: write the profile with floating numbers";
            return Err(self.malformed(
                colour.node,
                format!("a `spec` of the type {}", quoted(kind)),
                "a float type",
                advice,
            ));
        }
        let data = child(colour.node, "Data").unwrap_or(colour.node);
        if data.attributes().any(|attribute| attribute.name().to_ascii_lowercase().starts_with("file")) {
            let advice = "put the numbers into the element";
            return Err(self.malformed(data, "numbers in another file", "numbers in the element `Data`", advice));
        }
        let words = text(data);
        let mut values = Vec::new();
        for word in words.split([' ', '\t', '\n', ',']).filter(|word| !word.is_empty()) {
            values.push(value(word).ok_or_else(|| {
                let found = format!("{} as value {} of {}", quoted(word), values.len() + 1, quoted(&colour.name));
                self.malformed(data, found, "a finite number", "correct it")
            })?);
        }
        let (found, rows, columns) = (values.len(), self.emission_nm.len(), self.excitation_nm.len());
        // Axes are copied only for as many values.
        let axes =
            (found == rows.saturating_mul(columns)).then(|| (self.emission_nm.clone(), self.excitation_nm.clone()));
        let grid = axes.and_then(|(emission, excitation)| Grid::from_rows(true, emission, excitation, values));
        grid.ok_or_else(|| {
            let expected = format!("{rows} rows of emission x {columns} of excitation");
            let found = format!("{found} values of {}", quoted(&colour.name));
            self.malformed(
                data,
                found,
                expected,
                "correct the ranges or the values; colours of several tints are not read",
            )
        })
    }

    fn note(&self, source: &Source, notes: &mut Notes) {
        let step = |nm: &[f64]| (nm[nm.len() - 1] - nm[0]) / (nm.len() - 1).max(1) as f64;
        let (place, by) = (source.at_line(1), step(&self.excitation_nm));
        let text = "rows of the matrices are emission (SpectralRange), columns excitation (BiSpectralRange), as iccDEV \
                    multiplies them with the spectrum of the light";
        notes.assume(place.clone(), text);
        let text = format!(
            "the values are weights in a sum over the excitation wavelengths: off the diagonal a density times their step of \
             {by} nm, in the place of the emission width of a Donaldson matrix; `--set bandpass-nm={by}` makes the density \
             right where no bandpass is known"
        );
        notes.assume(place.clone(), text);
        if !self.left.is_empty() {
            notes.notice(place, format!("without a place in the document: {}", listed(&self.left)));
        }
    }

    fn malformed(
        &self,
        node: roxmltree::Node<'_, '_>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: &str,
    ) -> ImportError {
        ImportError::Malformed(fault(self.xml.place(node), found, expected, advice))
    }
}

/// The colour of a structure, if it has a matrix. The first of an array is the bare substrate (`tnt0`), without a name.
fn colour<'n, 'a>(xml: &Xml<'a>, members: roxmltree::Node<'n, 'a>) -> Option<Colour<'n, 'a>> {
    let tagged = |name: &str| {
        let is = |node: &roxmltree::Node<'_, '_>| child_text(*node, "TagSignature").as_deref() == Some(name);
        members.children().filter(|node| node.is_element()).find(is)
    };
    let node = tagged("spec")?;
    let name = tagged("name").and_then(|name| child_text(name, "TextData"));
    let signature = || members.parent_element().and_then(|parent| child_text(parent, "StructureSignature"));
    let is_named = name.is_some();
    let name = name.or_else(signature).unwrap_or_else(|| "colour".to_owned());
    Some(Colour { name, is_named, node, place: xml.place(node) })
}

/// Start, end and number of the wavelengths.
fn range(xml: &Xml<'_>, node: roxmltree::Node<'_, '_>, limit: u64) -> Result<Vec<f64>, ImportError> {
    let bad = |found: String| {
        let expected = "`Wavelengths` with start, end and steps: two or more ascending wavelengths in nm";
        ImportError::Malformed(fault(xml.place(node), found, expected, "correct the range"))
    };
    let Some(wavelengths) = children(node, "Wavelengths").next() else {
        return Err(bad(format!("{} without `Wavelengths`", quoted(node.tag_name().name()))));
    };
    let number = |name: &str| wavelengths.attribute(name).and_then(value);
    let (start, end) = (number("start"), number("end"));
    let steps: Option<u32> = wavelengths.attribute("steps").and_then(|text| text.trim().parse().ok());
    match (start, end, steps) {
        (Some(start), Some(end), Some(steps))
            if start > 0.0 && end > start && steps >= 2 && 2 * u64::from(steps) <= limit =>
        {
            let by = (end - start) / f64::from(steps - 1);
            Ok((0..steps).map(|k| if k + 1 == steps { end } else { start + by * f64::from(k) }).collect())
        }
        _ => {
            let shown = ["start", "end", "steps"].map(|name| wavelengths.attribute(name).unwrap_or(""));
            Err(bad(format!("start {}, end {}, steps {}", quoted(shown[0]), quoted(shown[1]), quoted(shown[2]))))
        }
    }
}
