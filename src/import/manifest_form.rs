//! A scan manifest for a scan that is still to be made: the lab measures row by row, saves each record under the name in
//! its row, and imports the manifest.

use std::collections::HashMap;
use std::fmt::Write;

use super::angles::Angles;
use crate::quantity::{Geometry, Reference, SignHabit};

/// How often a white reference in one fixed geometry is measured: its spread is its uncertainty.
const WHITES: usize = 3;

/// The CSV of a manifest with a row per geometry, in their order, and the rows of the white reference that a factor of
/// this reference needs: beside each geometry, three in the fixed one, or none.
///
/// Angles are signed where all geometries lie in the plane of incidence. A geometry that comes again is a repeat.
#[must_use]
pub fn scan_manifest(geometry: &[Geometry], reference: &Reference) -> String {
    let fixed = match *reference {
        Reference::FixedGeometry { theta_i_deg, theta_v_deg } => {
            Geometry::from_degrees(theta_i_deg, 180.0, theta_v_deg, 0.0).ok()
        }
        _ => None,
    };
    let is_signed = geometry.iter().all(|geometry| geometry.signed_deg().is_some());
    let mut form = Form { is_signed, repeats: HashMap::new(), text: String::new() };
    let angles = if is_signed { Angles::Signed(SignHabit::MirrorAtEqual) } else { Angles::Full };
    let columns = if is_signed { "theta_i_deg,theta_v_deg" } else { "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg" };
    form.text = format!("# angles: {angles}\nfile,role,{columns},repeat\n");
    if let Some(white) = fixed {
        (0..WHITES).for_each(|_| form.row("white", &white));
    }
    for geometry in geometry {
        form.row("sample", geometry);
        if matches!(reference, Reference::SameGeometry) {
            form.row("white", geometry);
        }
    }
    form.text
}

struct Form {
    is_signed: bool,
    repeats: HashMap<String, usize>,
    text: String,
}

impl Form {
    fn row(&mut self, role: &str, geometry: &Geometry) {
        let (i, v) = (&geometry.incidence, &geometry.viewing);
        let signed = geometry.signed_deg().filter(|_| self.is_signed);
        let (name, angles) = match signed {
            Some((ti, tv)) => (format!("ti{}_tv{}", signed_angle(ti), signed_angle(tv)), vec![ti, tv]),
            None => {
                let all = vec![i.theta_deg(), i.phi_deg(), v.theta_deg(), v.phi_deg()];
                (format!("ti{}_pi{}_tv{}_pv{}", all[0], all[1], all[2], all[3]), all)
            }
        };
        let name = format!("{name}_{role}");
        let repeat = self.repeats.entry(name.clone()).or_insert(0);
        *repeat += 1;
        let again = if *repeat > 1 { format!("_r{repeat}") } else { String::new() };
        // Adding 0 makes -0 a 0.
        let angles: Vec<String> = angles.iter().map(|angle| (angle + 0.0).to_string()).collect();
        // Writing into a text cannot fail.
        let _ = writeln!(self.text, "raw/{name}{again}.txt,{role},{},{repeat}", angles.join(","));
    }
}

/// An angle with its sign, whole degrees with two digits: names sort, and no shell takes them for an option.
fn signed_angle(degrees: f64) -> String {
    let degrees = degrees + 0.0;
    if degrees.fract() == 0.0 { format!("{degrees:+03.0}") } else { format!("{degrees:+}") }
}
