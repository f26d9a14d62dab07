//! Settings of a fit as they are spelled on the command line.

use std::fmt;

use crate::dataset::Effect;
use crate::fit::{Loss, Share};

/// What `--share` asks for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sharing(pub(super) Option<Share>);

/// What `--bounds` asks for.
#[derive(Debug, Clone)]
pub(super) struct Bounds {
    parameter: String,
    low: f64,
    high: f64,
}

impl fmt::Display for Sharing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Some(Share::Shape) => "shape",
            Some(Share::ShapeAndIntensity) => "shape-and-intensity",
            None => "nothing",
        })
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}..{}", self.parameter, self.low, self.high)
    }
}

impl fmt::Display for Nuisance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.effect.map_or("wavelength-shift", Effect::name), self.value)?;
        if self.sigma > 0.0 { write!(f, ",{}", self.sigma) } else { Ok(()) }
    }
}

pub(super) fn share(text: &str) -> Result<Sharing, String> {
    match text {
        "shape" => Ok(Sharing(Some(Share::Shape))),
        "shape-and-intensity" => Ok(Sharing(Some(Share::ShapeAndIntensity))),
        "nothing" => Ok(Sharing(None)),
        _ => Err("expected `shape`, `shape-and-intensity` or `nothing`".to_owned()),
    }
}

pub(super) fn loss(text: &str) -> Result<Loss, String> {
    let known = [Loss::Squares, Loss::Huber, Loss::Tukey];
    known
        .into_iter()
        .find(|loss| loss.name() == text)
        .ok_or_else(|| "expected `squares`, `huber` or `tukey`".to_owned())
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| "expected a number above 0, as 1e-8".to_owned())
}

pub(super) fn bounds(text: &str) -> Result<Bounds, String> {
    let parts = text.split_once('=').and_then(|(name, ends)| Some((name, ends.split_once("..")?)));
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let expected = "expected roughness=LOW..HIGH or refractive_index=LOW..HIGH with LOW below HIGH";
    let Some((name, (low, high))) = parts else { return Err(expected.to_owned()) };
    let parameter = name.trim().replace('-', "_");
    let least = match parameter.as_str() {
        "roughness" => 0.0,
        "refractive_index" => 1.0,
        _ => return Err(format!("`{name}` has no bounds of its own; {expected}")),
    };
    match (number(low), number(high)) {
        (Some(low), Some(high)) if least < low && low < high => Ok(Bounds { parameter, low, high }),
        (Some(low), Some(_)) if low <= least => Err(format!("{low} is not above {least}; {expected}")),
        _ => Err(expected.to_owned()),
    }
}

/// What `--nuisance` asks for; no effect for a shift of the wavelength.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nuisance {
    effect: Option<Effect>,
    value: f64,
    sigma: f64,
}

impl Nuisance {
    pub(super) fn of_geometry(&self) -> Option<crate::fit::Nuisance> {
        self.effect.map(|effect| crate::fit::Nuisance { effect, value: self.value, sigma: self.sigma })
    }
}

pub(super) fn nuisance(text: &str) -> Result<Nuisance, String> {
    let expected = "expected NAME=VALUE or NAME=VALUE,SIGMA with SIGMA above 0";
    let (name, numbers) = text.split_once('=').ok_or(expected)?;
    let (value, sigma) = numbers.split_once(',').unwrap_or((numbers, "0"));
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let (Some(value), Some(sigma)) = (number(value), number(sigma)) else { return Err(expected.to_owned()) };
    if sigma < 0.0 || (sigma == 0.0 && numbers.contains(',')) {
        return Err(expected.to_owned());
    }
    let effect = match name.trim() {
        "wavelength-shift" if value == 0.0 && sigma > 0.0 => None,
        "wavelength-shift" => {
            return Err("a known shift belongs into the file's actual wavelengths; expected wavelength-shift=0,SIGMA"
                .to_owned());
        }
        name => Some(name.parse::<Effect>().map_err(|error| error.to_string())?),
    };
    if effect.is_some_and(Effect::is_size) && value < 0.0 {
        return Err(format!("a size of {value} degrees; expected 0 or more"));
    }
    Ok(Nuisance { effect, value, sigma })
}

/// The standard uncertainty of a shift of the wavelength, nm.
pub(super) fn wavelength_shift(nuisances: &[Nuisance]) -> f64 {
    nuisances.iter().filter(|nuisance| nuisance.effect.is_none()).map(|nuisance| nuisance.sigma).fold(0.0, f64::hypot)
}

/// The bounds of a parameter; of several the last.
pub(super) fn within(bounds: &[Bounds], parameter: &str) -> Option<(f64, f64)> {
    bounds.iter().rev().find(|bounds| bounds.parameter == parameter).map(|bounds| (bounds.low, bounds.high))
}
