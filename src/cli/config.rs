//! `termtrace config`: every setting, what holds, and who says so; and the keys.

use super::outcome::{CommandResult, write_stdout};
use super::settings::files::path_of;
use super::settings::{EffectiveSetting, SettingArgs, Settings, keys};
use clap::{ArgMatches, Args};
use std::fmt::Write;
use termtrace::internals::text::visible_lines;
use unicode_width::UnicodeWidthStr;

const EXAMPLES: &str = "\
Examples:
  termtrace config                     what holds, and who says so
  termtrace config --fps 30            the same with a flag
  termtrace config --no-config         the same without the files
  termtrace config --keys              what keys do; the start of a keys.ron of one's own";

#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ConfigArgs {
    // They are read from what clap has matched, which knows which were given.
    #[command(flatten)]
    _settings: SettingArgs,
    /// Print what keys do instead, in the form of keys.ron
    #[arg(long)]
    keys: bool,
}

pub(super) fn run(args: &ConfigArgs, given: &ArgMatches) -> CommandResult {
    let no_config = given.get_flag("no_config");
    let keymap = keys::keymap(no_config)?;
    if args.keys {
        return write_stdout(keymap.to_ron().as_bytes());
    }
    let settings = Settings::gather(given)?;
    let width = settings.effective.iter().map(|held| held.value.width()).max().unwrap_or(0);
    let mut text = String::new();
    for EffectiveSetting { name, value, source } in &settings.effective {
        let _ = writeln!(text, "{name:<16}{value:<width$}  {source}");
    }
    text.push('\n');
    for name in ["config.ron", "keys.ron"] {
        let _ = writeln!(text, "{name:<16}{}", place(name, no_config));
    }
    write_stdout(visible_lines(&text).as_bytes())
}

/// Where a file is looked for, and whether there is one.
fn place(name: &str, unread: bool) -> String {
    let Some(path) = path_of(name) else {
        return "nowhere: neither XDG_CONFIG_HOME nor HOME names a folder".to_owned();
    };
    let found = match path.exists() {
        _ if unread => "not read: --no-config",
        true => "read",
        false => "not there",
    };
    format!("{} ({found})", path.display())
}
