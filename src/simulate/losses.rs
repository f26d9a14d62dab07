//! Luminescence that a scene loses because a light is not known, or the scene has no wavelength, where a material is excited.

use super::material::Material;
use super::scene::Scene;
use crate::donaldson::{Extend, Light};

/// Below this share of the luminescence nothing is said.
const WORTH_SAYING: f64 = 1e-6;

/// What is lost, in words: one sentence for each pair of a material that is used and a light.
pub(super) fn of(scene: &Scene) -> Vec<String> {
    let mut sentences = Vec::new();
    for (k, material) in scene.materials.iter().enumerate() {
        let is_used = scene.bodies.iter().any(|body| body.material == k);
        if !is_used || material.surface.density.iter().all(|value| *value == 0.0) {
            continue;
        }
        for source in &scene.sources {
            let found = material.surface.under(&source.light, Extend::Zero);
            let lacks = found.unlit.iter().filter(|unlit| unlit.is_excitation && unlit.excitation_share > WORTH_SAYING);
            let place = format!("material `{}` under light `{}`", material.name, source.name);
            sentences.extend(lacks.map(|unlit| format!("{place}: {}", unlit.sentence(source.light.name()))));
            sentences.extend(outside(scene, material, &source.light).map(|text| format!("{place}: {text}")));
        }
    }
    sentences
}

/// What the wavelengths of the scene leave out of the light.
fn outside(scene: &Scene, material: &Material, light: &Light) -> Option<String> {
    let nm = scene.grid.nm();
    let (first, last) = (nm[0], nm[nm.len() - 1]);
    let sum = |light: &Light| -> f64 {
        let shares = light.shares(&material.surface.excitation_nm);
        let rows = material.surface.density.rows();
        shares.iter().zip(rows).map(|(share, row)| share * row.sum()).sum()
    };
    let (whole, inside) = (sum(light), sum(&light.within(first, last)?));
    let lost = 1.0 - inside / whole;
    (lost > WORTH_SAYING).then(|| {
        format!("{:.1} % of its luminescence is excited outside {first} to {last} nm, the wavelengths of the scene, and is not drawn", 100.0 * lost)
    })
}
