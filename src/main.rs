//! The program `termtrace`: arguments in; a picture or an error message, and an exit code, out.
//!
//! Exit codes: 0 success; 1 failure, or a difference found by `frame --check`; 2 wrong arguments or a faulty scene.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
