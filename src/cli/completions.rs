//! `termtrace completions` and `termtrace man`: shell completions and man pages, generated from the
//! command line.

use super::outcome::{CommandResult, Failure, reason, write_stdout};
mod bash;
mod fish;
mod values;
mod zsh;

use super::Cli;
use super::help;
use super::manual;
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use termtrace::internals::text::closest;

const COMPLETIONS: &str = "\
Examples:
  termtrace completions fish >~/.config/fish/completions/termtrace.fish
  termtrace completions powershell >>$PROFILE
  mkdir -p ~/.local/share/bash-completion/completions
  termtrace completions bash >~/.local/share/bash-completion/completions/termtrace
  mkdir -p ~/.zfunc       with fpath+=(~/.zfunc) before compinit in .zshrc
  termtrace completions zsh >~/.zfunc/_termtrace";

const MAN: &str = "\
Examples:
  termtrace man >~/.local/share/man/man1/termtrace.1
  termtrace man frame | man -l -";

#[derive(Args)]
#[command(after_long_help = COMPLETIONS)]
pub(super) struct CompletionsArgs {
    /// The shell to complete for
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

#[derive(Args)]
#[command(after_long_help = MAN)]
pub(super) struct ManArgs {
    /// The command [default: the whole program]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

/// Prints a completion script for the shell.
pub(super) fn complete(args: &CompletionsArgs) -> CommandResult {
    let mut program = Cli::command();
    // Adds the deferred arguments of all commands, which the script would lack otherwise.
    program.build();
    let script = match args.shell {
        Shell::Bash => bash::script(&program),
        Shell::Fish => fish::script(&program),
        Shell::Zsh => zsh::script(&program),
        shell => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "termtrace", &mut script);
            return write_stdout(&script);
        }
    };
    write_stdout(script.as_bytes())
}

/// Prints a man page, as roff.
pub(super) fn man(args: &ManArgs) -> CommandResult {
    let page = command_named(Cli::command(), args.command.as_deref())?;
    // clap_mangen writes no text for an option that `-h` hides.
    let page = page.mut_args(|arg| arg.hide_short_help(false));
    let roff = manual::page(page, help::EXIT_STATUS);
    write_stdout(&roff.map_err(|error| Failure::runtime("the man page", reason(&error)))?)
}

/// Returns the command of this name with all its arguments; without a name, the whole program.
pub(super) fn command_named(mut program: clap::Command, name: Option<&str>) -> Result<clap::Command, Failure> {
    // Adds the deferred arguments of all commands.
    program.build();
    match name {
        None => Ok(program),
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| no_command(name)),
    }
}

/// Returns the error about a command `name` that clap took for a scene, because it is misspelt or
/// follows a flag.
pub(super) fn no_command(name: &str) -> Failure {
    // A known command is not misspelt; it was not recognised because of the flag before it.
    if Cli::command().find_subcommand(name).is_some() {
        return Failure::Usage(format!("flags of a command go after it: termtrace {name} ..."));
    }
    let meant = command_near(name).map(|meant| format!("; did you mean \"{meant}\"?")).unwrap_or_default();
    Failure::Usage(format!("there is no command \"{name}\"{meant}"))
}

/// Returns the command whose name is most similar to `name`, if one is similar.
pub(super) fn command_near(name: &str) -> Option<String> {
    let program = Cli::command();
    closest(name, program.get_subcommands().map(clap::Command::get_name)).map(str::to_owned)
}
