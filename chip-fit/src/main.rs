//! `intray-fit`, which `intray fit` runs.

fn main() -> std::process::ExitCode {
    chip_fit::cli::run()
}
