//! Units as numbers: what a unit is worth in SI, and of which base units it is made.

use super::QuantityKind;

/// A unit as a factor and the exponents of the SI base units: 1 W m-2 sr-1 nm-1 is 1e9 kg m-1 s-3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiUnit {
    /// What one unit is in the coherent SI unit.
    pub factor: f64,
    /// Exponents of m, kg, s, A, K, mol, cd, in that order. The steradian is 1.
    pub exponents: [i8; 7],
}

impl QuantityKind {
    /// The unit of the quantity in SI; `None` where the quantity is unstated.
    #[must_use]
    pub const fn si_unit(self) -> Option<SiUnit> {
        let per_nm = 1e9;
        let (factor, exponents) = match self {
            Self::SpectralRadiance | Self::SpectralIrradiance => (per_nm, [-1, 1, -3, 0, 0, 0, 0]),
            Self::BandRadiance => (1.0, [0, 1, -3, 0, 0, 0, 0]),
            Self::Luminance => (1.0, [-2, 0, 0, 0, 0, 0, 1]),
            Self::RelativeSpectrum
            | Self::RadianceFactor
            | Self::LuminanceFactor
            | Self::BandRadianceFactor
            | Self::DonaldsonMatrix
            | Self::Brdf => (1.0, [0; 7]),
            Self::BispectralLuminescentRadianceFactor | Self::Brrdf => (per_nm, [-1, 0, 0, 0, 0, 0, 0]),
            Self::Unstated => return None,
        };
        Some(SiUnit { factor, exponents })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factor and exponents of a text such as `W m-2 sr-1 nm-1`, from the units it is made of.
    fn parsed(text: &str) -> SiUnit {
        let mut unit = SiUnit { factor: 1.0, exponents: [0; 7] };
        for word in text.split(' ').filter(|word| *word != "1") {
            let split = word.find(['-', '0', '1', '2', '3']).unwrap_or(word.len());
            let power: i8 = if split == word.len() { 1 } else { word[split..].parse().unwrap() };
            let (factor, exponents): (f64, [i8; 7]) = match &word[..split] {
                "W" => (1.0, [2, 1, -3, 0, 0, 0, 0]),
                "m" => (1.0, [1, 0, 0, 0, 0, 0, 0]),
                "nm" => (1e-9, [1, 0, 0, 0, 0, 0, 0]),
                "cd" => (1.0, [0, 0, 0, 0, 0, 0, 1]),
                "sr" => (1.0, [0; 7]),
                other => panic!("no unit {other}"),
            };
            unit.factor *= factor.powi(i32::from(power));
            for (sum, exponent) in unit.exponents.iter_mut().zip(exponents) {
                *sum += exponent * power;
            }
        }
        unit
    }

    #[test]
    fn the_text_and_the_numbers_are_one_unit() {
        for kind in QuantityKind::ALL.iter().filter(|kind| **kind != QuantityKind::Unstated) {
            let (stated, from_text) = (kind.si_unit().unwrap(), parsed(kind.unit()));
            assert_eq!(stated.exponents, from_text.exponents, "{kind}");
            assert!((stated.factor / from_text.factor - 1.0).abs() < 1e-12, "{kind}");
        }
    }
}
