//! Settings as command line flags: a flag's name, its form with a value, and the check of a value.

use clap::builder::PossibleValue;
use clap::{Arg, Command};
use termtrace::internals::text::closest;

/// Returns the setting's flag, such as `--color`.
pub(super) fn flag(setting: &Arg) -> String {
    format!("--{}", setting.get_long().unwrap_or_default())
}

/// Returns the setting and its value as one command line argument, `--flag=value`. After `=` a
/// value may begin with a hyphen.
pub(super) fn flag_with_value(setting: &Arg, value: &str) -> String {
    format!("{}={value}", flag(setting))
}

/// Checks a value with the parser of the setting's flag. The error is the parser's message, without
/// clap's usage lines.
pub(super) fn check(command: &Command, setting: &Arg, text: &str) -> Result<(), String> {
    let Err(error) = command.clone().try_get_matches_from([flag_with_value(setting, text)]) else { return Ok(()) };
    // `source` is the error of the flag's own parser; clap adds usage lines about a command line to it.
    if let Some(wrong) = std::error::Error::source(&error) {
        return Err(wrong.to_string());
    }
    let values = setting.get_possible_values();
    let known: Vec<_> = values.iter().map(PossibleValue::get_name).collect();
    let meant = closest(text, known.iter().copied()).map(|meant| format!("; did you mean {meant}?"));
    Err(format!("expected one of {}{}", known.join(", "), meant.unwrap_or_default()))
}
