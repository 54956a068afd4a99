//! Arguments of a command that are listed when the command is asked for.

use clap::{ArgMatches, Args, Command, Error, FromArgMatches};

/// To list the arguments of all commands takes several times as long as to read those of one, and the first picture waits
/// for it.
pub(super) struct DeferredArgs<T>(pub(super) T);

impl<T: Args> Args for DeferredArgs<T> {
    fn augment_args(command: Command) -> Command {
        command.defer(|command| keep_about(command, T::augment_args))
    }

    fn augment_args_for_update(command: Command) -> Command {
        command.defer(|command| keep_about(command, T::augment_args_for_update))
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

/// What the command is about was said with its name: what its arguments are about is not to replace it.
fn keep_about(command: Command, list: fn(Command) -> Command) -> Command {
    let about = command.get_about().cloned().unwrap_or_default();
    list(command).about(about)
}
