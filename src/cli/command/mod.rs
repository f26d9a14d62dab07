//! One file per command. Each has `Arguments` and `run(&Arguments) -> CommandResult`.

pub(crate) mod convert;
pub(crate) mod cost;
pub(crate) mod design;
pub(crate) mod donaldson;
pub(crate) mod eval;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod import;
pub(crate) mod info;
pub(crate) mod migrate;
pub(crate) mod plan;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod rules;
pub(crate) mod schema;
pub(crate) mod validate;
