use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(isolux_cli::run(std::env::args_os()))
}
