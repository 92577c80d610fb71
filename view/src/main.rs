//! `intray-view`, which `intray view` runs.

fn main() -> std::process::ExitCode {
    view::cli::run()
}
