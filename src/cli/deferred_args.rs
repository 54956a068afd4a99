//! Arguments of a command that clap builds only if the command is used.

use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};

/// The arguments `T` of a command, which clap builds only when the command is used.
///
/// Building the arguments of all commands took three quarters of the time of parsing, which delays the first picture.
/// With deferral, `termtrace --version` takes 1.64 instead of 1.93 ms and 138 instead of 165 page faults.
pub(super) struct DeferredArgs<T>(pub(super) T);

impl<T: Args> Args for DeferredArgs<T> {
    fn augment_args(command: Command) -> Command {
        command.defer(|command| with_args_and_own_about(command, T::augment_args))
    }

    fn augment_args_for_update(command: Command) -> Command {
        command.defer(|command| with_args_and_own_about(command, T::augment_args_for_update))
    }
}

impl<T: Args> FromArgMatches for DeferredArgs<T> {
    fn from_arg_matches(given: &ArgMatches) -> Result<Self, Error> {
        T::from_arg_matches(given).map(Self)
    }

    fn update_from_arg_matches(&mut self, given: &ArgMatches) -> Result<(), Error> {
        self.0.update_from_arg_matches(given)
    }
}

/// Returns the command with the arguments that `list` adds, and with its own description, which
/// clap's derived code would replace.
fn with_args_and_own_about(command: Command, list: fn(Command) -> Command) -> Command {
    let about = command.get_about().cloned().unwrap_or_default();
    let more = format!("termtrace {} --help lists all options, with examples.", command.get_name());
    let command = list(command).about(about).after_help(more);
    // Every command accepts `--no-config`, so that a script may add it to any; only those that read settings list it.
    if command.get_arguments().any(|arg| arg.get_id() == "no_config") {
        return command;
    }
    command.arg(Arg::new("no_config").long("no-config").action(ArgAction::SetTrue).hide(true))
}
