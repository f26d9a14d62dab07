//! One file per command. Each has `Arguments` and `run(&Arguments) -> CommandResult`.

pub(crate) mod import;
