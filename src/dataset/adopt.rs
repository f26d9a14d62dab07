//! A measurement of one document in another, with everything that it refers to.

use serde::Serialize;

use super::{Document, Id, Light, Measurement};
use crate::quantity::ReferenceLight;

/// What came over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adopted {
    /// The measurement's id here.
    pub id: Id,
    /// Parts that have another id here, because another part has theirs, one sentence each.
    pub renamed: Vec<String>,
}

impl Document {
    /// Takes over a measurement of another document with its sample, instrument, white reference, lights, and the measurements that
    /// it was derived from. A part that is here already, equal in everything, is not taken twice; one whose id belongs to
    /// another part here gets a number after its id. `None` where the other document has no such measurement.
    pub fn adopt(&mut self, other: &Self, measurement: &str) -> Option<Adopted> {
        let mut renamed = Vec::new();
        let id = self.adopt_measurement(other, measurement, &mut renamed, &mut Vec::new())?;
        for receipt in &other.provenance.receipts {
            if !self.provenance.receipts.contains(receipt) {
                self.provenance.receipts.push(receipt.clone());
            }
        }
        Some(Adopted { id, renamed })
    }

    /// `under_way` are the measurements whose derivations lead here: a chain that comes back to where it began is not followed.
    fn adopt_measurement(
        &mut self,
        other: &Self,
        id: &str,
        renamed: &mut Vec<String>,
        under_way: &mut Vec<String>,
    ) -> Option<Id> {
        let mut one = other.measurement(id)?.clone();
        under_way.push(id.to_owned());
        adopt_reference(&mut self.samples, &other.samples, &mut one.sample, "sample", renamed);
        adopt_reference(&mut self.instruments, &other.instruments, &mut one.instrument, "instrument", renamed);
        let whites = (&mut self.white_references, &other.white_references);
        adopt_reference(whites.0, whites.1, &mut one.white_reference, "white reference", renamed);
        for state in &mut one.excitations {
            adopt_reference(&mut self.lights, &other.lights, &mut state.light, "light", renamed);
        }
        if let ReferenceLight::Light(light) = &one.quantity.reference_light {
            let mut light = Id::new(light.as_str()).ok();
            adopt_reference(&mut self.lights, &other.lights, &mut light, "light", renamed);
            if let Some(light) = light {
                one.quantity.reference_light = ReferenceLight::Light(light.to_string());
            }
        }
        if let Some(derivation) = &mut one.derivation {
            for of in [&mut derivation.numerator, &mut derivation.reference].into_iter().chain(&mut derivation.dark) {
                let named = of.to_string();
                if !under_way.contains(&named)
                    && let Some(new) = self.adopt_measurement(other, &named, renamed, under_way)
                {
                    *of = new;
                }
            }
        }
        under_way.pop();
        Some(take(&mut self.measurements, one, "measurement", renamed))
    }
}

/// Takes over what a reference names, and has it name that here.
fn adopt_reference<T: Part>(
    here: &mut Vec<T>,
    there: &[T],
    reference: &mut Option<Id>,
    what: &str,
    renamed: &mut Vec<String>,
) {
    let Some(id) = reference.as_ref() else { return };
    if let Some(part) = there.iter().find(|part| part.id() == id) {
        *reference = Some(take(here, part.clone(), what, renamed));
    }
}

fn take<T: Part>(here: &mut Vec<T>, mut part: T, what: &str, renamed: &mut Vec<String>) -> Id {
    let wanted = part.id().clone();
    for number in 1.. {
        if number > 1 {
            *part.id_mut() = numbered(&wanted, number);
        }
        match here.iter().find(|other| other.id() == part.id()) {
            Some(other) if is_same_part(other, &part) => return part.id().clone(),
            Some(_) => {}
            None => break,
        }
    }
    let id = part.id().clone();
    if id != wanted {
        let sentence = format!("the {what} `{wanted}` is `{id}` here, because another {what} has that id");
        if !renamed.contains(&sentence) {
            renamed.push(sentence);
        }
    }
    here.push(part);
    id
}

fn numbered(id: &Id, number: u32) -> Id {
    let suffix = format!("-{number}");
    // Ids are of ASCII and at most 64 long.
    let kept = id.as_str().get(..id.as_str().len().min(64 - suffix.len())).unwrap_or_default();
    Id::new(format!("{kept}{suffix}")).unwrap_or_default()
}

/// Equal in everything that a file holds; missing numbers are equal.
#[must_use]
pub fn is_same_part<T: Serialize>(a: &T, b: &T) -> bool {
    match (serde_json::to_value(a), serde_json::to_value(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// A part with an id.
trait Part: Clone + Serialize {
    fn id(&self) -> &Id;
    fn id_mut(&mut self) -> &mut Id;
}

macro_rules! part {
    ($($part:ty),+) => {
        $(impl Part for $part {
            fn id(&self) -> &Id {
                &self.id
            }

            fn id_mut(&mut self) -> &mut Id {
                &mut self.id
            }
        })+
    };
}

part!(super::Sample, super::Instrument, super::WhiteReference, Light, Measurement);
