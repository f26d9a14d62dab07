//! Which white record serves which sample record, and in which geometry the reference was measured.

use std::collections::{BTreeMap, BTreeSet};

use super::error::{ImportError, fault};
use super::factor::repeat_key;
use super::plan::{Plan, geometry_key};
use super::receipt::Notes;
use crate::dataset::{Acquisition, Measurement};
use crate::quantity::{Geometry, Reference, ReferenceLight};

/// Rows that are averaged, and who is divided by whom.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Groups {
    /// Rows of the sample measurement, one group per derived row.
    pub(super) sample: Vec<Vec<usize>>,
    /// Rows of the white measurement, one group per reference.
    pub(super) white: Vec<Vec<usize>>,
    /// The reference of each derived row.
    pub(super) row_reference: Vec<Option<usize>>,
    /// The convention.
    pub(super) reference: Reference,
    /// The light of the reference.
    pub(super) reference_light: ReferenceLight,
}

impl Groups {
    /// True where every derived row has a reference that no other row has: its noise is shared by none.
    pub(super) fn own_reference(&self) -> bool {
        let mut seen = BTreeSet::new();
        self.row_reference.len() > 1 && self.row_reference.iter().flatten().all(|group| seen.insert(*group))
    }
}

/// Groups the rows and finds the convention.
///
/// # Errors
/// [`ImportError::Contradiction`] where the stated reference is not the geometry of the white records.
pub(super) fn groups(
    plan: &Plan,
    sample: &Measurement,
    white: &Measurement,
    repeats: bool,
    notes: &mut Notes,
) -> Result<Groups, ImportError> {
    let sample_groups = sample_groups(sample, plan.scan, repeats);
    let by_geometry = is_by_geometry(white);
    let reference = reference(plan, sample, white, by_geometry)?;
    let key = |row: &Acquisition| (repeat_key(row).0.filter(|_| by_geometry), row.excitation);
    let mut index: BTreeMap<_, usize> = BTreeMap::new();
    let mut white_groups: Vec<Vec<usize>> = Vec::new();
    for (row, acquisition) in white.acquisitions.iter().enumerate() {
        let group = *index.entry(key(acquisition)).or_insert(white_groups.len());
        if group == white_groups.len() {
            white_groups.push(Vec::new());
        }
        white_groups[group].push(row);
    }
    let find = |rows: &Vec<usize>| {
        let (geometry, excitation) = key(sample.acquisitions.get(*rows.first()?)?);
        // A white that states no excitation serves all of them.
        index.get(&(geometry, excitation)).or_else(|| index.get(&(geometry, None))).copied()
    };
    let row_reference: Vec<Option<usize>> = sample_groups.iter().map(find).collect();
    let lacking = row_reference.iter().filter(|reference| reference.is_none()).count();
    if lacking > 0 {
        let text =
            format!("{lacking} geometries have no white record in their geometry and excitation: no factor there");
        notes.notice(plan.place.clone(), text);
    }
    let reference_light = light(plan, sample, white, &sample_groups, &white_groups, &row_reference);
    Ok(Groups { sample: sample_groups, white: white_groups, row_reference, reference, reference_light })
}

/// Repeats are rows of one geometry and excitation. Outside a scan only the caller knows whether records are repeats.
pub(super) fn sample_groups(sample: &Measurement, scan: bool, repeats: bool) -> Vec<Vec<usize>> {
    let mut index: BTreeMap<_, usize> = BTreeMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (row, acquisition) in sample.acquisitions.iter().enumerate() {
        let key = repeat_key(acquisition);
        let together = repeats || scan && key.0.is_some();
        let group = if together { *index.entry(key).or_insert(groups.len()) } else { groups.len() };
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(row);
    }
    groups
}

fn geometries(measurement: &Measurement) -> BTreeMap<[u64; 4], Geometry> {
    let known = measurement.acquisitions.iter().filter_map(|acquisition| acquisition.geometry);
    known.map(|geometry| (geometry_key(&geometry), geometry)).collect()
}

/// True where the white was measured in several geometries, each serving its own.
fn is_by_geometry(white: &Measurement) -> bool {
    geometries(white).len() > 1
}

fn reference(
    plan: &Plan,
    sample: &Measurement,
    white: &Measurement,
    by_geometry: bool,
) -> Result<Reference, ImportError> {
    let (whites, samples) = (geometries(white), geometries(sample));
    let all_known = sample.acquisitions.iter().all(|acquisition| acquisition.geometry.is_some());
    let found = match whites.values().next() {
        None => Reference::Unstated,
        Some(_) if by_geometry => Reference::SameGeometry,
        Some(_) if all_known && samples.len() == 1 && samples.keys().eq(whites.keys()) => Reference::SameGeometry,
        Some(geometry) => fixed(geometry),
    };
    let Some(stated) = plan.settings.reference else { return Ok(found) };
    if found == Reference::Unstated || agree(stated, found, &whites) {
        return Ok(stated);
    }
    Err(ImportError::Contradiction(fault(
        plan.settings.place_of("reference", plan.place.clone()),
        format!("the reference stated as `{stated}` where the white records are `{found}`"),
        "one convention",
        "correct the statement, or the geometry of the white records",
    )))
}

fn fixed(geometry: &Geometry) -> Reference {
    let polar = (geometry.incidence.theta_deg(), geometry.viewing.theta_deg());
    let (theta_i_deg, theta_v_deg) = geometry.signed_deg().unwrap_or(polar);
    Reference::FixedGeometry { theta_i_deg, theta_v_deg }
}

/// A sample of one geometry with its white in the same one is both.
fn agree(stated: Reference, found: Reference, whites: &BTreeMap<[u64; 4], Geometry>) -> bool {
    stated == found
        || found == Reference::SameGeometry && whites.len() == 1 && whites.values().any(|g| fixed(g) == stated)
}

/// The light of the reference is that of the sample only where both say which it was.
fn light(
    plan: &Plan,
    sample: &Measurement,
    white: &Measurement,
    sample_groups: &[Vec<usize>],
    white_groups: &[Vec<usize>],
    row_reference: &[Option<usize>],
) -> ReferenceLight {
    if let Some(stated) = &plan.settings.reference_light {
        return stated.clone();
    }
    let excitation = |measurement: &Measurement, rows: &[usize]| {
        rows.first().and_then(|row| measurement.acquisitions.get(*row)).and_then(|acquisition| acquisition.excitation)
    };
    let same = sample_groups.iter().zip(row_reference).all(|(rows, reference)| {
        let Some(group) = reference.and_then(|group| white_groups.get(group)) else { return true };
        let of_sample = excitation(sample, rows);
        of_sample.is_some() && of_sample == excitation(white, group)
    });
    if same { ReferenceLight::Same } else { ReferenceLight::Unstated }
}
