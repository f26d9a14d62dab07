//! The cases in which the naive way fails, each as the promise that a user would notice; how the naive way fails is said
//! beside it. `terms`, `fits` and `bispectral` hold the cases; `bounds` and `outliers` those of values that are not all alike, `edges`
//! those that the data cannot tell. `tests/descent.rs` has those of the least-squares loop alone, and
//! `tests/fit_recovery.rs` starts from nowhere two thousand times.
#![allow(unreachable_pub, clippy::unwrap_used)]

#[path = "../common/scans.rs"]
mod scans;

#[path = "../common/bispectral.rs"]
mod matrices;

mod bispectral;
mod bounds;
mod edges;
mod fits;
mod outliers;
mod terms;
