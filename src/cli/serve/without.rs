//! `termtrace serve` in a program that is built without the feature `serve`.

use crate::cli::outcome::{CommandResult, Failure};
use clap::{ArgMatches, Args};
use std::ffi::OsString;

/// Any arguments: the command ignores them, and only tells how to get the server.
#[derive(Args)]
pub(in crate::cli) struct ServeArgs {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    _any: Vec<OsString>,
}

/// Fails with a message that tells how to install a program with the server.
pub(in crate::cli) fn run(_args: ServeArgs, _given: &ArgMatches) -> CommandResult {
    let how = "cargo install termtrace --features serve";
    Err(Failure::Runtime(format!("this program was built without its server; {how} installs it with one")))
}
