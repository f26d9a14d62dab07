//! The box: which parameters are held on its faces, and steps that stay inside.

use super::Slope;

/// The box that parameters stay in, and the longest step of each; infinite where there is no limit.
#[derive(Debug, Clone, Copy)]
pub struct Bounds<'a> {
    /// Smallest values.
    pub low: &'a [f64],
    /// Largest values.
    pub high: &'a [f64],
    /// Longest steps: how far the second-order picture may be trusted at all.
    pub longest: &'a [f64],
}

/// What a step is worked out in, made once for all steps of a descent.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) step: Vec<f64>,
    pinned: Vec<Option<f64>>,
    /// Where the step leads to.
    pub(super) trial: Vec<f64>,
}

impl Room {
    pub(super) fn new(parameters: usize) -> Self {
        Self { step: vec![0.0; parameters], pinned: vec![None; parameters], trial: vec![0.0; parameters] }
    }
}

impl Bounds<'_> {
    /// The nearest value in the box.
    pub(super) fn clamp(&self, k: usize, x: f64) -> f64 {
        // Not `f64::clamp`, which panics where the bounds are the wrong way round.
        x.max(self.low[k]).min(self.high[k])
    }

    /// A parameter on its bound whose gradient points outwards is held.
    pub(super) fn held(&self, slope: &impl Slope, point: &[f64]) -> Vec<bool> {
        (0..point.len()).map(|k| self.is_held(k, point[k], slope.gradient()[k])).collect()
    }

    fn is_held(&self, k: usize, x: f64, gradient: f64) -> bool {
        (x <= self.low[k] && gradient > 0.0) || (x >= self.high[k] && gradient < 0.0)
    }

    /// The step within the box: what would leave it is pinned to its face, and the others take that into account.
    pub(super) fn step(&self, slope: &impl Slope, point: &[f64], damping: f64, room: &mut Room) {
        let Room { step, pinned, .. } = room;
        for (k, pin) in pinned.iter_mut().enumerate() {
            *pin = self.is_held(k, point[k], slope.gradient()[k]).then_some(0.0);
        }
        loop {
            slope.step(pinned, damping, step);
            let mut is_inside = true;
            for (k, pin) in pinned.iter_mut().enumerate().filter(|(_, pin)| pin.is_none()) {
                let (down, up) = (self.low[k] - point[k], self.high[k] - point[k]);
                if step[k] < down || step[k] > up {
                    *pin = Some(if step[k] < down { down } else { up });
                    is_inside = false;
                }
            }
            if is_inside {
                return;
            }
        }
    }

    /// A damped step within the box, cut to the longest allowed, and where it leads to.
    pub(super) fn damped_step(&self, slope: &impl Slope, point: &[f64], damping: f64, room: &mut Room) {
        self.step(slope, point, damping, room);
        for (k, step) in room.step.iter_mut().enumerate() {
            *step = step.max(-self.longest[k]).min(self.longest[k]);
            room.trial[k] = self.clamp(k, point[k] + *step);
        }
    }
}
