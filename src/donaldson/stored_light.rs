//! A light from a spectrum of a document.

use super::light::{Light, NoLight};
use crate::dataset::LightSpectrum;
use crate::quantity::{Bandpass, Flags, QuantityKind, WavelengthAxis};

impl Light {
    /// The light of a stored spectrum, with remarks on what was passed over.
    ///
    /// # Errors
    /// [`NoLight`].
    pub fn of_stored(name: &str, spectrum: &LightSpectrum) -> Result<(Self, Vec<String>), NoLight> {
        let values: Vec<(f64, u16)> = spectrum.values.iter().copied().zip(spectrum.flags.iter().copied()).collect();
        Self::of_values(name, spectrum.quantity.kind, &spectrum.axis, &values)
    }

    /// The light of values with their flags, one for each wavelength of an axis. Values that may not be used are passed over, and
    /// the light goes straight past them.
    ///
    /// # Errors
    /// [`NoLight`].
    pub fn of_values(
        name: &str,
        kind: QuantityKind,
        axis: &WavelengthAxis,
        values: &[(f64, u16)],
    ) -> Result<(Self, Vec<String>), NoLight> {
        let mut remarks = Vec::new();
        let all = if axis.actual_nm.len() == axis.nm.len() { &axis.actual_nm } else { &axis.nm };
        let is_usable = |(value, flags): &(f64, u16)| value.is_finite() && Flags(*flags).may_be_fitted();
        let usable: Vec<usize> = (0..values.len().min(all.len())).filter(|k| is_usable(&values[*k])).collect();
        let left_out = all.len() - usable.len();
        if left_out > 0 {
            remarks.push(format!(
                "{name}: {left_out} of {} wavelengths have no usable value; it goes straight past them",
                all.len()
            ));
        }
        let kind = if kind == QuantityKind::Unstated {
            remarks.push(format!("{name}: does not say what its numbers are; taken as a relative spectrum"));
            QuantityKind::RelativeSpectrum
        } else {
            kind
        };
        let fwhm = match &axis.bandpass {
            Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == 1 => Some(vec![fwhm_nm[0]; usable.len()]),
            Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == all.len() => {
                Some(usable.iter().map(|k| fwhm_nm[*k]).collect())
            }
            _ => None,
        };
        let nm = usable.iter().map(|k| all[*k]).collect();
        let numbers = usable.iter().map(|k| values[*k].0).collect();
        Ok((Self::new(name, kind, nm, numbers, fwhm)?, remarks))
    }
}
