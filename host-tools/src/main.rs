//! The `intray` command.

fn main() -> std::process::ExitCode {
    host_tools::cli::run()
}
