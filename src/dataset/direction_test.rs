//! Self-test vectors: some directions of a measurement a second time, as unit vectors.

use serde::{Deserialize, Serialize};

use super::Measurement;

/// How many rows of a measurement carry self-test vectors, at most.
const TESTED_ROWS: usize = 8;

/// The directions of one row as unit vectors in the frame of the sample: x from the centre to the mark, z the normal to
/// the outside, right-handed. Who turns the azimuth the other way or starts it elsewhere cannot write both alike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct DirectionTest {
    /// Row of the measurement.
    pub row: u32,
    /// From the surface to the source.
    pub incidence: [f64; 3],
    /// From the surface to the detector.
    pub viewing: [f64; 3],
}

impl Measurement {
    /// States the self-test vectors of rows spread over the measurement.
    pub fn state_directions(&mut self) {
        let known = || (0_u32..).zip(&self.acquisitions).filter_map(|(row, at)| at.geometry.map(|g| (row, g)));
        let count = known().count();
        let step = count.div_ceil(TESTED_ROWS).max(1);
        let tests = known().step_by(step).map(|(row, geometry)| DirectionTest {
            row,
            incidence: geometry.incidence.unit_vector(),
            viewing: geometry.viewing.unit_vector(),
        });
        self.direction_tests = tests.collect();
    }
}
