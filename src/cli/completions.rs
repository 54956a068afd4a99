//! `termtrace completions` and `termtrace man`: what a system wants to know of the command line.

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
    /// For which shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

#[derive(Args)]
#[command(after_help = MAN)]
pub(super) struct ManArgs {
    /// Of which command [default: the whole program]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

/// A script for the shell.
pub(super) fn complete(args: &CompletionsArgs) -> CommandResult {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "termtrace", &mut script);
    write_stdout(&script)
}

/// A page of the manual, as roff.
pub(super) fn man(args: &ManArgs) -> CommandResult {
    let mut program = Cli::command();
    program.build();
    let page = match &args.command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| no_command(name))?,
    };
    let mut roff = Vec::new();
    let written = clap_mangen::Man::new(page).render(&mut roff);
    written.map_err(|error| Failure::runtime("the manual", reason(&error)))?;
    write_stdout(&roff)
}

/// Says so, and which one was likely meant. What stands before a command makes it the name of a scene.
pub(super) fn no_command(name: &str) -> Failure {
    if Cli::command().find_subcommand(name).is_some() {
        return Failure::Usage(format!("what goes with a command comes after it: termtrace {name} ..."));
    }
    let meant = command_near(name).map(|meant| format!("; did you mean \"{meant}\"?")).unwrap_or_default();
    Failure::Usage(format!("there is no command \"{name}\"{meant}"))
}

/// The command that was likely meant by a name that is none.
pub(super) fn command_near(name: &str) -> Option<String> {
    let program = Cli::command();
    closest(name, program.get_subcommands().map(clap::Command::get_name)).map(str::to_owned)
}
