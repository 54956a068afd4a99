//! Arguments in; a picture or one line of error out; the exit code.
//!
//! 0: done. 1: it could not be done, or `frame --check` found a difference. 2: the command line or the scene is wrong.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
