//! `termtrace help` and `termtrace version`, and the sections of `--help` on keys and exit codes.

use super::Cli;
use super::completions::command_named;
use super::outcome::{CommandResult, write_help, write_stdout};
use clap::Args;

/// The section of `--help` with the most important keys.
pub(super) const KEYS: &str = "\
Keys (termtrace config --keys prints all of them):
  drag, WASD, arrows   look around and move; the wheel moves towards the pointer
  Tab                  fly, or orbit around the target
  v, b, |              next map, previous map, map and picture side by side
  x                    explain the pixel under the pointer
  m, 1 to 9            save this view under a number, go to a view
  r, f                 back to the scene's view, frame everything
  o                    save the picture to a file
  ?, q                 all keys, quit";

/// The section of `--help` and of man pages with the exit codes.
pub(super) const EXIT_STATUS: &str = "Exit status:
  0  success
  1  failure, or a difference found by frame --check
  2  wrong arguments or a faulty scene";

const EXAMPLES: &str = "\
Examples:
  termtrace help frame
  termtrace ./help        open a scene file of that name";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct HelpArgs {
    /// The command [default: the whole program]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

#[derive(Args)]
pub(super) struct VersionArgs {}

/// Returns the text with its first letter in upper case, as sentences in clap's help start.
pub(super) fn capitalized(text: &str) -> String {
    let (first, rest) = text.split_at(text.chars().next().map_or(0, char::len_utf8));
    first.to_uppercase() + rest
}

/// Prints the same help of a command as its `--help`.
pub(super) fn run(args: &HelpArgs) -> CommandResult {
    let mut command = command_named(Cli::for_help(), args.command.as_deref())?;
    write_help(&command.render_long_help().to_string())
}

/// Prints the same line as `--version`.
pub(super) fn version() -> CommandResult {
    write_stdout(concat!("termtrace ", env!("CARGO_PKG_VERSION"), "\n").as_bytes())
}
