//! What a picture may change by when something is left out of it.

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::grid::NoGrid;
use super::super::interface::Interface;
use super::super::picture::{Kept, Prepared};
use super::super::scene::{Bounces, Scene};
use super::super::transport::{Act, Spectra};
use super::indirect::{Between, of};
use super::lab::{Factor, Largest, largest};
use super::reach::{Ring, may_shade, most_lit, most_seen, rings};

/// The light from all around at an interface is tabulated; its largest value may lie between two of the table, and beside its sum.
const TABLE: f64 = 1.05;
/// Lights that a body may be in the shade of or not, all combinations of which are looked at.
const MOST_SHADES: usize = 6;

/// What no pixel changes by more than; infinite where nothing bounds it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Bound {
    /// Radiance at any wavelength over the largest that a perfect diffuser facing all lights has.
    #[schemars(with = "Option<f64>")]
    pub radiance: f64,
    /// Luminance over that of white.
    #[schemars(with = "Option<f64>")]
    pub luminance: f64,
    /// CIELAB distance of 1976.
    #[schemars(with = "Option<f64>")]
    pub delta_e: f64,
    /// CIEDE2000 where the largest distance occurs that was met in the proof: reported, and no bound, for its formula has jumps.
    pub ciede2000_there: Option<f64>,
}

impl Bound {
    /// Nothing at all.
    pub const ZERO: Self = Self { radiance: 0.0, luminance: 0.0, delta_e: 0.0, ciede2000_there: None };

    fn larger(self, other: Self) -> Self {
        let which = if other.delta_e > self.delta_e { other.ciede2000_there } else { self.ciede2000_there };
        Self {
            radiance: self.radiance.max(other.radiance),
            luminance: self.luminance.max(other.luminance),
            delta_e: self.delta_e.max(other.delta_e),
            ciede2000_there: which,
        }
    }

    /// True where no pixel changes.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.radiance == 0.0 && self.delta_e == 0.0
    }
}

/// How much of each light there may be on each body.
pub(super) struct Reach {
    /// \[body\]\[light\]: largest cos(theta_i) times the strength.
    pub(super) lit: Vec<Vec<f64>>,
    /// \[body\]\[light\]: largest D F G / den times the strength.
    pub(super) shining: Vec<Vec<f64>>,
    /// \[body\]\[light\]: the same in rings about the brightest place.
    rings: Vec<Vec<Vec<Ring>>>,
    /// \[body\]\[light\]: whether a body may stand in between.
    pub(super) shaded: Vec<Vec<bool>>,
    /// \[body\]\[other\]: share of the hemisphere.
    pub(super) seen: Vec<Vec<f64>>,
    /// Largest share of light from all around that each body's interface sends on.
    pub(super) mirrored: Vec<f64>,
    /// Whether each body's material has an interface that reflects.
    pub(super) has_interface: Vec<bool>,
}

impl Reach {
    pub(super) fn new(scene: &Scene) -> Self {
        let bodies = 0..scene.bodies.len();
        let interfaces: Vec<Option<Interface>> = scene
            .materials
            .iter()
            .map(|one| {
                one.specular
                    .filter(|term| term.intensity > 0.0 || one.intensity.iter().any(|(_, c)| *c > 0.0))
                    .as_ref()
                    .map(Interface::new)
            })
            .collect();
        let interface = |body: usize| interfaces[scene.bodies[body].material].as_ref();
        let has_surround = scene.sources.iter().any(super::super::source::Source::is_surround);
        let tables: Vec<f64> = interfaces
            .iter()
            .map(|one| {
                one.as_ref()
                    .filter(|_| has_surround)
                    .map_or(0.0, |one| TABLE * one.surrounded().into_iter().fold(0.0, f64::max))
            })
            .collect();
        let rings_of = |body: usize, source: &super::super::source::Source| match interface(body) {
            Some(one) if !source.is_surround() => rings(scene, &scene.bodies[body], source, one),
            _ => Vec::new(),
        };
        let lights = |body: usize, of: &dyn Fn(usize, &super::super::source::Source) -> f64| {
            scene.sources.iter().map(|source| of(body, source)).collect::<Vec<f64>>()
        };
        let lit = |body: usize, source: &super::super::source::Source| most_lit(&scene.bodies[body].shape, source);
        let shining = |body: usize, source: &super::super::source::Source| match interface(body) {
            Some(_) if source.is_surround() => tables[scene.bodies[body].material],
            _ => rings_of(body, source).iter().map(|ring| ring.shining).fold(0.0, f64::max),
        };
        let shades = |body: usize| {
            scene
                .sources
                .iter()
                .map(|source| bodies.clone().any(|caster| may_shade(scene, caster, body, source)))
                .collect()
        };
        let seen: Vec<Vec<f64>> =
            bodies.clone().map(|from| bodies.clone().map(|other| most_seen(scene, from, other)).collect()).collect();
        Self {
            lit: bodies.clone().map(|body| lights(body, &lit)).collect(),
            shining: bodies.clone().map(|body| lights(body, &shining)).collect(),
            rings: bodies
                .clone()
                .map(|body| scene.sources.iter().map(|source| rings_of(body, source)).collect())
                .collect(),
            shaded: bodies.clone().map(shades).collect(),
            mirrored: bodies.clone().map(|body| tables[scene.bodies[body].material]).collect(),
            has_interface: bodies.clone().map(|body| interface(body).is_some()).collect(),
            seen,
        }
    }

    /// True where light may go from one body to another, or from one part of a body to another.
    pub(super) fn is_open(&self) -> bool {
        self.seen.iter().flatten().all(|share| *share == 0.0)
    }

    /// True where every body that can be seen from another has no interface.
    fn is_matte(&self) -> bool {
        (0..self.seen.len()).all(|of| !self.has_interface[of] || self.seen.iter().all(|list| list[of] == 0.0))
    }
}

/// The full picture, against which plans are held.
pub(super) struct Full<'a> {
    pub(super) scene: &'a Scene,
    pub(super) choice: Choice,
    pub(super) reach: Reach,
    prepared: Prepared,
    /// The brightest of the perfect diffuser.
    brightest: f64,
}

/// Colours of an act of a material under each light, with the spectrum of each.
struct Acts {
    xyz: Vec<[f64; 3]>,
    spectra: Vec<Vec<f64>>,
}

/// Largest irradiance of each body by light from others, and whether light by one other body comes to it.
type Indirect = (Vec<Vec<f64>>, bool);

/// A factor with the spectrum that is left out.
struct Part {
    factor: Factor,
    peak: Vec<f64>,
}

impl<'a> Full<'a> {
    pub(super) fn new(scene: &'a Scene, choice: Choice) -> Result<Self, NoGrid> {
        let prepared = Prepared::new(scene, choice.step_nm)?;
        let lights = prepared.lights(scene);
        let sum = |j: usize| lights.iter().map(|light| light[j]).sum::<f64>();
        let brightest = (0..prepared.grid.nm().len()).map(sum).fold(0.0, f64::max);
        Ok(Self { reach: Reach::new(scene), scene, choice, prepared, brightest })
    }

    /// Largest irradiance of each body by the lights themselves, at every wavelength.
    fn lit(&self) -> Vec<Vec<f64>> {
        let lights = self.prepared.lights(self.scene);
        let count = self.prepared.grid.nm().len();
        let one = |body: usize| {
            (0..count)
                .map(|j| {
                    let part = |light: usize| match self.reach.lit[body][light] * lights[light][j].abs() {
                        // A light on the very surface has no power at this wavelength.
                        value if value.is_nan() => 0.0,
                        value => value,
                    };
                    (0..lights.len()).map(part).sum()
                })
                .collect()
        };
        (0..self.scene.bodies.len()).map(one).collect()
    }

    fn between(&self) -> Between<'_> {
        Between {
            materials: self.scene.bodies.iter().map(|body| &self.prepared.materials[body.material]).collect(),
            shares: self.reach.seen.clone(),
            lit: self.lit(),
        }
    }

    /// All light that may fall on each body; `None` where nothing bounds it.
    pub(super) fn incident(&self) -> Option<Vec<Vec<f64>>> {
        let mut all = self.lit();
        if all.iter().flatten().any(|value| !value.is_finite()) {
            return None;
        }
        if !self.reach.is_open() && self.choice.bounces != Bounces::Most(0) {
            let more = self.indirect(0)?;
            for (all, more) in all.iter_mut().flatten().zip(more.into_iter().flatten()) {
                *all += more;
            }
        }
        Some(all)
    }

    /// The largest irradiance by light that goes from body to body more often than `kept`.
    fn indirect(&self, kept: u32) -> Option<Vec<Vec<f64>>> {
        let between = self.between();
        if !self.reach.is_matte() || between.lit.iter().flatten().any(|value| !value.is_finite()) {
            return None;
        }
        let most = match self.choice.bounces {
            Bounces::All => None,
            Bounces::Most(most) => Some(most),
        };
        between.beyond(kept, most)
    }

    /// True where an effect adds exactly nothing anywhere.
    pub(super) fn is_nothing(&self, effect: Effect) -> bool {
        let bodies = || self.scene.bodies.iter().enumerate();
        let on = |body: &super::super::scene::Body| &self.prepared.materials[body.material];
        match effect {
            Effect::Surround => !self.scene.sources.iter().any(super::super::source::Source::is_surround),
            Effect::Shadow => !self.reach.shaded.iter().flatten().any(|may| *may),
            Effect::Interreflection => self.reach.is_open() || self.choice.bounces == Bounces::Most(0),
            Effect::Specular => {
                !self.reach.has_interface.iter().any(|has| *has)
                    || (self.reach.is_open() && self.reach.shining.iter().flatten().all(|most| *most == 0.0))
            }
            Effect::Luminescence if bodies().all(|(_, body)| on(body).luminescence.is_none()) => true,
            Effect::Diffuse if bodies().all(|(_, body)| on(body).elastic.iter().all(|rho| *rho == 0.0)) => true,
            Effect::Luminescence | Effect::Diffuse => self.incident().is_some_and(|incident| {
                bodies().all(|(number, body)| {
                    let material = on(body);
                    match (effect, &material.luminescence) {
                        (Effect::Luminescence, None) => true,
                        (Effect::Luminescence, Some(matrix)) => {
                            let is_dark = |row: ndarray::ArrayView1<'_, f64>| {
                                row.iter().zip(&incident[number]).all(|(a, b)| a * b == 0.0)
                            };
                            matrix.outer_iter().all(is_dark)
                        }
                        _ => material.elastic.iter().zip(&incident[number]).all(|(a, b)| a * b == 0.0),
                    }
                })
            }),
        }
    }

    /// What no pixel changes by more than when `plan` is drawn and not this.
    pub(super) fn bound(&self, plan: &Choice) -> Bound {
        let is_same = Effect::ALL.iter().all(|effect| plan.has(*effect) || self.is_nothing(*effect));
        if is_same && plan.bounces == self.choice.bounces && plan.step_nm == self.choice.step_nm {
            return Bound::ZERO;
        }
        let Ok(prepared) = Prepared::new(self.scene, plan.step_nm) else { return Self::unknown() };
        let kept = if plan.has(Effect::Interreflection) {
            match plan.bounces {
                Bounces::All => None,
                Bounces::Most(most) => Some(most),
            }
        } else {
            Some(0)
        };
        let goes_round = !self.is_nothing(Effect::Interreflection);
        let indirect = match kept {
            _ if !goes_round => Some(None),
            // The first order is known by its colours, the rest by its size.
            Some(0) => self.indirect(1).map(|rest| Some((rest, true))),
            Some(kept) if Bounces::Most(kept) != self.choice.bounces => {
                self.indirect(kept).map(|rest| Some((rest, false)))
            }
            _ => Some(None),
        };
        let drops = |effect: Effect| !plan.has(effect) && !self.is_nothing(effect);
        let still_round = goes_round && kept != Some(0);
        // What is left out of a body is left out of the light that it sends to others, too: that is not bounded here.
        let is_chained = still_round
            && (plan.step_nm != self.choice.step_nm
                || drops(Effect::Luminescence)
                || drops(Effect::Diffuse)
                || drops(Effect::Specular)
                || drops(Effect::Surround));
        let Some(indirect) = indirect.filter(|_| !is_chained) else { return Self::unknown() };
        let bodies = 0..self.scene.bodies.len();
        bodies.map(|body| self.of_body(body, plan, &prepared, indirect.as_ref())).fold(Bound::ZERO, Bound::larger)
    }

    fn unknown() -> Bound {
        Bound { radiance: f64::INFINITY, luminance: f64::INFINITY, delta_e: f64::INFINITY, ciede2000_there: None }
    }

    fn acts(&self, prepared: &Prepared, act: Act, material: usize) -> Acts {
        let choice = self.choice;
        let of = |kept: Kept| -> (Vec<f64>, usize) {
            let spectra: Spectra<'_> = prepared.spectra(self.scene, &choice, kept);
            let rows = spectra.before(&spectra.channels.concat(), act, material);
            (spectra.through(&rows), spectra.channels.len())
        };
        let (colours, _) = of(Kept::Colour);
        let (spectra, count) = of(Kept::Spectra);
        Acts {
            xyz: colours.chunks_exact(3).map(|xyz| self.over_white([xyz[0], xyz[1], xyz[2]])).collect(),
            spectra: spectra.chunks_exact(count).map(<[f64]>::to_vec).collect(),
        }
    }

    fn of_body(&self, body: usize, plan: &Choice, planned: &Prepared, indirect: Option<&Indirect>) -> Bound {
        let material = self.scene.bodies[body].material;
        let all = |prepared: &Prepared| {
            [Act::Luminescent, Act::Diffuse, Act::Specular].map(|act| self.acts(prepared, act, material))
        };
        let (full, less) = (all(&self.prepared), all(planned));
        let has = |act: usize, surround: bool| {
            plan.has([Effect::Luminescence, Effect::Diffuse, Effect::Specular][act])
                && (!surround || plan.has(Effect::Surround))
        };
        let mut parts: Vec<Part> = Vec::new();
        let mut shades: Vec<(usize, Factor, Vec<f64>)> = Vec::new();
        // Where the factors of a light stand: cos(theta_i), and the lobe.
        let mut pairs: Vec<(usize, [Option<usize>; 2])> = Vec::new();
        for (light, source) in self.scene.sources.iter().enumerate() {
            pairs.push((light, [None; 2]));
            for acts in [vec![0, 1], vec![2]] {
                let most = if acts[0] == 2 { self.reach.shining[body][light] } else { self.reach.lit[body][light] };
                let sum = |from: &[Acts; 3], counts: &dyn Fn(usize) -> bool| {
                    let mut xyz = [0.0; 3];
                    for act in acts.iter().filter(|act| counts(**act)) {
                        (0..3).for_each(|c| xyz[c] += from[*act].xyz[light][c]);
                    }
                    xyz
                };
                let kept = sum(&less, &|act| has(act, source.is_surround()));
                let whole = sum(&full, &|_| true);
                let exact = |act: usize| has(act, source.is_surround()) && plan.step_nm == self.choice.step_nm;
                // What is kept as it is cancels exactly.
                let left_out = if acts.iter().all(|act| exact(*act)) {
                    [0.0; 3]
                } else if plan.step_nm == self.choice.step_nm {
                    sum(&full, &|act| !has(act, source.is_surround()))
                } else {
                    [0, 1, 2].map(|c| whole[c] - kept[c])
                };
                let spectrum = |j: usize| -> f64 {
                    acts.iter().filter(|act| !exact(**act)).map(|act| full[*act].spectra[light][j].abs()).sum()
                };
                let lost: Vec<f64> = (0..full[0].spectra[light].len()).map(spectrum).collect();
                if whole == [0.0; 3] && kept == [0.0; 3] && lost.iter().all(|value| *value == 0.0) {
                    continue;
                }
                if !plan.has(Effect::Shadow) && self.reach.shaded[body][light] {
                    let shadow: Vec<f64> = (0..lost.len())
                        .map(|j| acts.iter().map(|act| full[*act].spectra[light][j].abs()).sum())
                        .collect();
                    shades.push((
                        parts.len(),
                        Factor { least: 0.0, most, kept, left_out: kept.map(|value| -value) },
                        shadow,
                    ));
                }
                if let Some((_, at)) = pairs.last_mut() {
                    at[usize::from(acts[0] == 2)] = Some(parts.len());
                }
                parts.push(Part { factor: Factor { least: 0.0, most, kept, left_out }, peak: lost });
            }
        }
        if let Some((indirect, is_all)) = indirect {
            if *is_all {
                parts.extend(self.by_one(body, material));
            }
            parts.extend(self.by_others(body, material, indirect));
        }
        self.over_shades(body, plan, &parts, &shades, &pairs)
    }

    fn over_white(&self, xyz: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| xyz[c] / self.prepared.white[c])
    }

    /// Light that has come from the lights by one other body: for each light and material its own colour.
    fn by_one(&self, body: usize, material: usize) -> Vec<Part> {
        let spectra = [Kept::Colour, Kept::Spectra].map(|kept| self.prepared.spectra(self.scene, &self.choice, kept));
        let here = [0, 1].map(|k| {
            let spectra: &Spectra<'_> = &spectra[k];
            spectra.before(&spectra.channels.concat(), Act::Body, material)
        });
        let mut parts: Vec<Part> = Vec::new();
        for (other, one) in self.scene.bodies.iter().enumerate() {
            let share = self.reach.seen[body][other];
            if share == 0.0 {
                continue;
            }
            let [colours, lists] =
                [0, 1].map(|k| spectra[k].through(&spectra[k].before(&here[k], Act::Body, one.material)));
            let count = spectra[1].channels.len();
            for light in 0..self.scene.sources.len() {
                let xyz = &colours[3 * light..3 * light + 3];
                let factor = Factor {
                    least: 0.0,
                    most: share * self.reach.lit[other][light],
                    kept: [0.0; 3],
                    left_out: self.over_white([xyz[0], xyz[1], xyz[2]]),
                };
                if factor.most > 0.0 && factor.left_out != [0.0; 3] {
                    merge(
                        &mut parts,
                        Part {
                            factor,
                            peak: lists[light * count..(light + 1) * count].iter().map(|value| value.abs()).collect(),
                        },
                    );
                }
            }
        }
        parts
    }

    /// Light from other bodies beyond that: three factors, each of X, Y and Z for itself.
    fn by_others(&self, body: usize, material: usize, indirect: &[Vec<f64>]) -> Vec<Part> {
        let on_grid = &self.prepared.materials[material];
        let mut radiated = of(on_grid, &indirect[body]);
        if self.reach.has_interface[body] {
            // The brightest that this interface may mirror.
            let bodies = self.scene.bodies.iter().enumerate();
            let incident = self.lit();
            for (other, one) in bodies.filter(|(other, _)| self.reach.seen[body][*other] > 0.0) {
                let all: Vec<f64> = incident[other].iter().zip(&indirect[other]).map(|(a, b)| a + b).collect();
                let sent = of(&self.prepared.materials[one.material], &all);
                for ((sum, value), c) in radiated.iter_mut().zip(sent).zip(&on_grid.intensity) {
                    *sum += c * value * self.mirror(body);
                }
            }
        }
        let sum = |c: usize| {
            self.prepared.weights[c].iter().zip(&radiated).map(|(weight, value)| weight * value).sum::<f64>()
        };
        let most = self.over_white([sum(0), sum(1), sum(2)]);
        let unit = |c: usize| [0, 1, 2].map(|k| if k == c { most[c] } else { 0.0 });
        let nothing = vec![0.0; radiated.len()];
        let peak: Vec<f64> = radiated.iter().map(|value| value * std::f64::consts::FRAC_1_PI).collect();
        (0..3)
            .map(|c| Part {
                factor: Factor { least: 0.0, most: 1.0, kept: [0.0; 3], left_out: unit(c) },
                peak: if c == 0 { peak.clone() } else { nothing.clone() },
            })
            .collect()
    }

    /// The share of light from all around that an interface sends on at most.
    fn mirror(&self, body: usize) -> f64 {
        if self.reach.mirrored[body] > 0.0 {
            return self.reach.mirrored[body];
        }
        let term = self.scene.materials[self.scene.bodies[body].material].specular;
        term.map_or(0.0, |term| TABLE * Interface::new(&term).surrounded().into_iter().fold(0.0, f64::max))
    }

    fn over_shades(
        &self,
        body: usize,
        plan: &Choice,
        parts: &[Part],
        shades: &[(usize, Factor, Vec<f64>)],
        pairs: &[(usize, [Option<usize>; 2])],
    ) -> Bound {
        let lights = shades.len();
        if lights > MOST_SHADES {
            return Self::unknown();
        }
        // A lobe shines where its light falls in steeply: its brightest rings are never without diffuse light.
        let brightest = |(light, at): &&(usize, [Option<usize>; 2])| {
            at[1].map_or(0.0, |at| parts[at].factor.left_out[1].abs() * self.reach.shining[body][*light])
        };
        let has_rings = |light: usize| !self.reach.rings[body][light].is_empty();
        let lobe = pairs
            .iter()
            .filter(|pair| has_rings(pair.0) && brightest(pair) > 0.0)
            .max_by(|a, b| brightest(a).total_cmp(&brightest(b)));
        let lobe = lobe.filter(|_| !plan.has(Effect::Specular));
        let mut all = Bound::ZERO;
        for which in 0..1_usize << lights {
            let mut factors: Vec<Factor> = parts.iter().map(|part| part.factor).collect();
            let mut spectra: Vec<&Vec<f64>> = parts.iter().map(|part| &part.peak).collect();
            for (_, (at, factor, shadow)) in shades.iter().enumerate().filter(|(k, _)| which >> k & 1 == 1) {
                factors[*at] = *factor;
                spectra[*at] = shadow;
            }
            let Some((light, [base, Some(lobe)])) = lobe else {
                all = all.larger(self.found(&factors, &spectra));
                continue;
            };
            // In the shade of this light there is neither; the rings are of places that it reaches.
            let hidden = Factor { least: 0.0, most: 0.0, ..factors[*lobe] };
            let rings = self.reach.rings[body][*light].iter().map(|ring| (ring.shining, ring.least_lit));
            for (shining, least) in rings.chain([(hidden.most, 0.0)]) {
                let mut factors = factors.clone();
                factors[*lobe].most = shining;
                if let Some(base) = base {
                    factors[*base].least = least.min(factors[*base].most);
                }
                all = all.larger(self.found(&factors, &spectra));
            }
        }
        all
    }

    fn found(&self, factors: &[Factor], spectra: &[&Vec<f64>]) -> Bound {
        let count = spectra.first().map_or(0, |list| list.len());
        let at = |j: usize| {
            let part = |(factor, list): (&Factor, &&Vec<f64>)| if list[j] == 0.0 { 0.0 } else { factor.most * list[j] };
            factors.iter().zip(spectra).map(part).sum::<f64>()
        };
        let radiance = (0..count).map(at).fold(0.0, f64::max) * std::f64::consts::PI / self.brightest;
        let luminance = {
            let sides = factors.iter().map(|one| if one.left_out[1] == 0.0 { 0.0 } else { one.most * one.left_out[1] });
            let (low, high) =
                sides.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low + value.min(0.0), high + value.max(0.0)));
            high.max(-low)
        };
        let Largest { bound, at } = largest(factors);
        Bound { radiance, luminance, delta_e: bound, ciede2000_there: self.ciede2000(at) }
    }

    fn ciede2000(&self, at: [[f64; 3]; 2]) -> Option<f64> {
        if at[0] == at[1] {
            return None;
        }
        let white = self.prepared.white.map(|value| 100.0 * value);
        let colour = |xyz: [f64; 3]| crate::donaldson::Colour {
            observer: self.scene.observer,
            xyz: [0, 1, 2].map(|c| xyz[c] * white[c]),
            white,
        };
        colour(at[0]).difference(&colour(at[1])).map(|difference| difference.de2000)
    }
}

/// Adds a part; one of the same colour makes one with another.
fn merge(parts: &mut Vec<Part>, part: Part) {
    let sum = |one: &Factor| one.left_out.map(|value| one.most * value);
    let new = sum(&part.factor);
    let is_same = |old: &&mut Part| {
        let old = sum(&old.factor);
        let ratio = new[1] / old[1];
        ratio > 0.0 && ratio.is_finite() && (0..3).all(|c| (old[c] * ratio - new[c]).abs() <= 1e-12 * new[c].abs())
    };
    match parts.iter_mut().find(is_same) {
        Some(old) => {
            let xyz = sum(&old.factor);
            old.peak =
                old.peak.iter().zip(&part.peak).map(|(a, b)| old.factor.most * a + part.factor.most * b).collect();
            old.factor = Factor {
                least: 0.0,
                most: 1.0,
                kept: [0.0; 3],
                left_out: [0, 1, 2].map(|c| (xyz[c] + new[c]) * (1.0 + 1e-12)),
            };
        }
        None => parts.push(part),
    }
}
