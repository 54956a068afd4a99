//! `termtrace completions` and `termtrace man`: shell completions and man pages, generated from the
//! command line.

use super::Cli;
use super::outcome::{CommandResult, Failure, reason, write_stdout};
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use termtrace::internals::text::closest;

const COMPLETIONS: &str = "\
Examples:
  termtrace completions bash >~/.local/share/bash-completion/completions/termtrace
  termtrace completions zsh >~/.zfunc/_termtrace              with fpath+=(~/.zfunc) before compinit in .zshrc
  termtrace completions fish >~/.config/fish/completions/termtrace.fish
  termtrace completions powershell >>$PROFILE";

const MAN: &str = "\
Examples:
  termtrace man >~/.local/share/man/man1/termtrace.1
  termtrace man frame | man -l -";

#[derive(Args)]
#[command(after_help = COMPLETIONS)]
pub(super) struct CompletionsArgs {
    /// The shell to complete for
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

#[derive(Args)]
#[command(after_help = MAN)]
pub(super) struct ManArgs {
    /// The command [default: the whole program]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

/// Prints a completion script for the shell.
pub(super) fn complete(args: &CompletionsArgs) -> CommandResult {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "termtrace", &mut script);
    write_stdout(&script)
}

/// Prints a man page, as roff.
pub(super) fn man(args: &ManArgs) -> CommandResult {
    let mut program = Cli::command();
    // Adds the deferred arguments to all commands; without them the man pages would be empty.
    program.build();
    let page = match &args.command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| no_command(name))?,
    };
    let mut roff = Vec::new();
    let written = clap_mangen::Man::new(page).render(&mut roff);
    written.map_err(|error| Failure::runtime("the man page", reason(&error)))?;
    write_stdout(&roff)
}

/// Returns the error about a word that clap took for a scene though a command was meant: a misspelt
/// command, or a known one after a flag, where clap expects a scene.
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
