//! The `bbrf` command.

fn main() -> std::process::ExitCode {
    bbrf::cli::run()
}
