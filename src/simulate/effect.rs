//! What a scene may call for.

use crate::quantity::named;

named! {
    /// Something that light does.
    Effect, "effect" {
        /// Light absorbed at one wavelength is emitted at another.
        Luminescence = "luminescence",
        /// Light is reflected into all directions at its own wavelength.
        Diffuse = "diffuse",
        /// Light is reflected at the interface.
        Specular = "specular",
        /// One body stands in the light of another.
        Shadow = "shadow",
        /// One body is lit by another.
        Interreflection = "interreflection",
        /// Light comes from everywhere.
        Surround = "surround",
    }
}
