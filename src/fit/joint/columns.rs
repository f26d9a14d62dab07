//! The columns of a scan as the instrument sees it, with their derivatives by its effects.

use super::Joint;
use crate::dataset::Effects;
use crate::quantity::Geometry;
use crate::terms::{Undefined, diffuse_factor, fresnel, specular_factor};

/// Step of the central differences by an effect, degrees: the columns are smooth on the scale of a lobe.
const STEP: f64 = 2e-3;

/// One geometry: the diffuse column, the specular one, and its derivatives by ln r and ln(n - 1).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell {
    pub(super) diffuse: f64,
    pub(super) specular: f64,
    pub(super) by_r: f64,
    pub(super) by_m: f64,
}

/// The columns at one point of the parameters.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    /// One per geometry; `None` where a term is undefined.
    pub(super) cells: Vec<Option<Cell>>,
    /// Derivatives of the two columns by each effect \[effect\]\[geometry\].
    pub(super) by_effect: Vec<Vec<(f64, f64)>>,
}

impl Columns {
    pub(super) fn new(joint: &Joint<'_>, shape: [f64; 2], values: &[f64]) -> Self {
        let (roughness, m) = (shape[0].exp(), shape[1].exp());
        let column = |effects: &Effects| -> Vec<Option<Cell>> {
            joint.geometry.iter().map(|geometry| averaged(joint, geometry, effects, roughness, m).ok()).collect()
        };
        let with = |values: &[f64]| {
            let each = joint.nuisances.iter().zip(values);
            each.fold(Effects::default(), |effects, (nuisance, value)| effects.with(nuisance.effect, *value))
        };
        let cells = column(&with(values));
        let fitted = (0..values.len()).filter(|&k| joint.nuisances[k].sigma > 0.0);
        let by_effect = fitted.map(|k| {
            let moved = |step: f64| {
                let mut values = values.to_vec();
                values[k] += step;
                column(&with(&values))
            };
            let (up, down) = (moved(STEP), moved(-STEP));
            let slope = |(up, down): (&Option<Cell>, &Option<Cell>)| match (up, down) {
                (Some(up), Some(down)) => {
                    ((up.diffuse - down.diffuse) / (2.0 * STEP), (up.specular - down.specular) / (2.0 * STEP))
                }
                _ => (0.0, 0.0),
            };
            up.iter().zip(&down).map(slope).collect()
        });
        Self { by_effect: by_effect.collect(), cells }
    }
}

/// The mean over what the instrument sees.
fn averaged(
    joint: &Joint<'_>,
    nominal: &Geometry,
    effects: &Effects,
    roughness: f64,
    m: f64,
) -> Result<Cell, Undefined> {
    let lobe = joint.distribution.lobe(roughness);
    let mut mean = Cell::default();
    for (geometry, share) in effects.seen(nominal) {
        let half = geometry.half_angles();
        let (d, f) = (lobe.evaluate(&half), fresnel(&half, m));
        let masked = share * specular_factor(joint.denominator, &geometry, &half, joint.reference)?;
        mean.diffuse += share * diffuse_factor(&geometry, joint.reference)?;
        mean.specular += masked * d.value * f.value;
        mean.by_r += masked * d.by_log_roughness * f.value;
        mean.by_m += masked * d.value * f.by_index * m;
    }
    Ok(mean)
}
