//! The program `termtrace`: it turns arguments into a picture or an error message, and an exit
//! code.
//!
//! Exit codes: 0 is success, 1 a failure or a difference found by `frame --check`, 2 wrong arguments or a faulty scene.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
