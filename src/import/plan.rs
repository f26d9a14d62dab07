//! What is to be assembled: which record has which role in which geometry. Manifests, name patterns, scan orders and
//! plain lists of files all end here.

use super::error::{ImportError, fault};
use super::keys::Settings;
use super::parts::Excitations;
use super::record::Record;
use crate::dataset::{Place, Role};
use crate::quantity::Geometry;

/// A record with its role.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// The spectrum.
    pub(super) record: Record,
    /// What the instrument looked at.
    pub(super) role: Role,
    /// Directions, where known.
    pub(super) geometry: Option<Geometry>,
    /// Index of the excitation state.
    pub(super) excitation: Option<u32>,
    /// The name of the light, where the row has one.
    pub(super) light: Option<String>,
    /// Number of the repeat, where stated.
    pub(super) repeat: Option<u32>,
    /// RFC 3339, where stated.
    pub(super) time: Option<String>,
    /// Integration time, ms, where stated.
    pub(super) exposure_ms: Option<f64>,
    /// Where the entry is stated.
    pub(super) place: Place,
    /// The instrument's floor at each wavelength: the noise of the dark; `None` where the set does not show it.
    pub(super) floor: Option<Vec<f64>>,
}

impl Entry {
    /// A record of which only the role is known.
    pub(super) fn new(record: Record, role: Role) -> Self {
        let place = record.place();
        Self {
            record,
            role,
            geometry: None,
            excitation: None,
            light: None,
            repeat: None,
            time: None,
            exposure_ms: None,
            place,
            floor: None,
        }
    }
}

/// All entries in the order of acquisition.
#[derive(Debug)]
pub(super) struct Plan {
    /// The entries.
    pub(super) entries: Vec<Entry>,
    /// Their excitation states.
    pub(super) excitations: Excitations,
    /// What holds for all of them.
    pub(super) settings: Settings,
    /// True where the inputs are declared as one scan, so that one geometry twice must be a stated repeat.
    pub(super) scan: bool,
    /// Where the plan is stated.
    pub(super) place: Place,
}

impl Plan {
    /// A plan without entries.
    pub(super) fn new(settings: Settings, scan: bool, place: Place) -> Self {
        Self { entries: Vec::new(), excitations: Excitations::new(&settings), settings, scan, place }
    }

    /// The entries of a role.
    pub(super) fn of(&self, role: Role) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.role == role)
    }

    /// Refuses one sample geometry twice in a scan unless the repeats are numbered, and one record listed twice.
    pub(super) fn check_repeats(&self) -> Result<(), ImportError> {
        let mut records = std::collections::BTreeMap::new();
        let mut looks = std::collections::BTreeMap::new();
        for entry in &self.entries {
            let record = (entry.record.file.as_str(), entry.record.number);
            if let Some(before) = records.insert(record, &entry.place) {
                return Err(ImportError::Contradiction(fault(
                    entry.place.clone(),
                    format!("{} a second time (first at {before})", entry.record.label()),
                    "every record once",
                    "correct the file name or the record number",
                )));
            }
            let (Some(geometry), true) = (entry.geometry, self.scan && entry.role == Role::Sample) else { continue };
            let look = (geometry_key(&geometry), entry.excitation, entry.repeat);
            if let Some(before) = looks.insert(look, &entry.place) {
                return Err(ImportError::Contradiction(fault(
                    entry.place.clone(),
                    format!("the geometry and excitation of {before} a second time"),
                    "one record per geometry, or repeats that are numbered",
                    "number them in a column `repeat`, or correct the angles",
                )));
            }
        }
        Ok(())
    }
}

/// The first record with data among entries.
pub(super) fn first_record<'a>(mut entries: impl Iterator<Item = &'a Entry>) -> Option<&'a Record> {
    entries.find(|entry| entry.record.rejection.is_none()).map(|entry| &entry.record)
}

/// A geometry as a key; the azimuth of a direction along the normal says nothing.
pub(super) fn geometry_key(geometry: &Geometry) -> [u64; 4] {
    let azimuth = |theta: f64, phi: f64| if theta == 0.0 { 0.0 } else { phi };
    let (i, v) = (&geometry.incidence, &geometry.viewing);
    [i.theta_deg(), azimuth(i.theta_deg(), i.phi_deg()), v.theta_deg(), azimuth(v.theta_deg(), v.phi_deg())]
        .map(|angle| (angle + 0.0).to_bits())
}
