//! One file per command. Each has `Arguments` and `run(&Arguments) -> CommandResult`.

pub(crate) mod eval;
pub(crate) mod fit;
pub(crate) mod import;
pub(crate) mod report;
