//! One physical term each: value and exact derivatives, stable everywhere.
//!
//! *May use:* `quantity`. No files, no fitting.
//!
//! *Invariant:* below the horizon every term is exactly 0; where a one-sided limit exists it is returned, else a typed
//! [`Undefined`]; never NaN.

mod denominator;
mod distribution;

pub use denominator::Denominator;
pub use distribution::{Distribution, DistributionValue};

use crate::quantity::named;

named! {
    /// Which physical term.
    TermKind, "term" {
        /// S_r cos(theta_i): diffuse reflection.
        Lambertian = "lambertian",
        /// cos(theta_i) times the integral of S_l E over excitation: diffuse luminescence.
        Luminescent = "luminescent",
        /// c_s D G F / den: reflection at the interface.
        TorranceSparrow = "torrance-sparrow",
    }
}
