//! The result as text and as CSV.

use super::PredictResult;

impl PredictResult {
    pub(in super::super) fn csv(&self) -> String {
        let mut lines = vec![
            "material,light,luminescence,emission_nm,irradiance,elastic,luminescent,total,sigma,radiance_factor,\
             radiance_factor_sigma"
                .to_owned(),
        ];
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
        for one in &self.predictions {
            for (j, nm) in one.emission_nm.iter().enumerate() {
                let numbers = [
                    Some(*nm),
                    Some(one.irradiance[j]),
                    one.elastic[j],
                    Some(one.luminescent[j]),
                    one.total[j],
                    one.total_standard_uncertainty[j],
                    one.radiance_factor[j],
                    one.radiance_factor_standard_uncertainty[j],
                ];
                let names = [&one.material, &one.light, &one.luminescence].map(|name| quoted(name));
                lines.push(format!("{},{}", names.join(","), numbers.map(number).join(",")));
            }
        }
        lines.push(String::new());
        lines.join("\n")
    }

    pub(in super::super) fn text(&self) -> String {
        // Names are whole, and never touch.
        let width = |of: fn(&super::PredictionResult) -> &String, least: usize| {
            self.predictions.iter().map(|one| of(one).chars().count() + 2).max().unwrap_or(0).max(least)
        };
        let (first, second) = (width(|one| &one.material, 34), width(|one| &one.light, 14));
        let names = first + second + 10;
        let mut lines = vec![format!(
            "{:<first$}{:<second$}{:<10}{:>10}{:>10}{:>10}{:>9}{:>9}{:>9}{:>10}",
            "matrix", "light", "lumin.", "X", "Y", "Z", "L*", "a*", "b*", "whiteness"
        )];
        for one in &self.predictions {
            let name = format!("{:<first$}{:<second$}{:<10}", one.material, one.light, one.luminescence);
            let Some(colour) = &one.colour else {
                lines.push(format!("{name}no colour"));
                continue;
            };
            let [x, y, z] = colour.xyz;
            let [l, a, b] = colour.lab.unwrap_or([f64::NAN; 3]);
            let whiteness = match colour.whiteness {
                Some(whiteness) if colour.whiteness_is_defined => format!(" {whiteness:>9.2}"),
                _ => format!("{:>10}", "-"),
            };
            lines.push(format!("{name} {x:>9.4} {y:>9.4} {z:>9.4} {l:>8.3} {a:>8.3} {b:>8.3}{whiteness}"));
            if let Some([l, a, b]) = colour.lab_standard_uncertainty.filter(|sigma| sigma.iter().any(|s| *s > 0.0)) {
                lines.push(format!("{:<names$}{:>30}{l:>9.3}{a:>9.3}{b:>9.3}", "", "standard uncertainty"));
            }
        }
        for one in &self.differences {
            let name = |index: usize| {
                let prediction = &self.predictions[index];
                match one.between.as_str() {
                    "light" => prediction.light.clone(),
                    "material" => prediction.material.clone(),
                    _ => prediction.luminescence.clone(),
                }
            };
            let at = &self.predictions[one.of];
            let of = match one.between.as_str() {
                "light" => at.material.clone(),
                "material" => format!("under {}", at.light),
                _ => format!("{} under {}", at.material, at.light),
            };
            let (from, to) = (name(one.of), name(one.to));
            lines.push(format!("  {of}: {from} to {to}: CIE76 {:.3}, CIEDE2000 {:.3}", one.de76, one.de2000));
        }
        let mut said: Vec<String> = Vec::new();
        for one in &self.predictions {
            for finding in &one.findings {
                let line = format!("  {}: {finding}", one.material);
                if !said.contains(&line) {
                    said.push(line);
                }
            }
        }
        lines.extend(said);
        lines.join("\n")
    }
}

/// A field of a CSV, in quotes where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
