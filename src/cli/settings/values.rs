//! Values of settings, as flags have them.

use clap::builder::PossibleValue;
use clap::{Arg, Command};
use termtrace::internals::text::closest;

/// The setting's flag.
pub(super) fn flag(setting: &Arg) -> String {
    format!("--{}", setting.get_long().unwrap_or_default())
}

/// The setting with that value, as the command line has it.
pub(super) fn word(setting: &Arg, text: &str) -> String {
    format!("{}={text}", flag(setting))
}

/// What is wrong with this as the setting's value, if anything is.
pub(super) fn check(command: &Command, setting: &Arg, text: &str) -> Result<(), String> {
    let Err(error) = command.clone().try_get_matches_from([word(setting, text)]) else { return Ok(()) };
    if let Some(wrong) = std::error::Error::source(&error) {
        return Err(wrong.to_string());
    }
    let values = setting.get_possible_values();
    let known: Vec<_> = values.iter().map(PossibleValue::get_name).collect();
    let meant = closest(text, known.iter().copied()).map(|meant| format!("; did you mean {meant}?"));
    Err(format!("expected one of {}{}", known.join(", "), meant.unwrap_or_default()))
}
