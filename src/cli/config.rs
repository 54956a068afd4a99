//! `termtrace config`: prints every setting with its effective value and its source, or the keys.

use super::json;
use super::outcome::{CommandResult, write_stdout};
use super::settings::files::path_of;
use super::settings::{EffectiveSetting, NoConfig, SettingArgs, Settings, keys};
use clap::{ArgMatches, Args};
use serde_json::{Map, Value, json};
use std::fmt::Write;
use termtrace::internals::text::visible_lines;
use unicode_width::UnicodeWidthStr;

const USER_FILES: [&str; 2] = ["config.ron", "keys.ron"];

const EXAMPLES: &str = "\
Examples:
  termtrace config                     the effective settings and their sources
  termtrace config --fps 30            the settings with a flag
  termtrace config --no-config         the settings without config.ron
  termtrace config --keys              what each key does, as a keys.ron to edit";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct ConfigArgs {
    // Present only for parsing and the help: `Settings::gather` reads clap's matches, which also say which flags were
    // given.
    #[command(flatten)]
    _settings: SettingArgs,
    #[command(flatten)]
    _no_config: NoConfig,
    /// Print the keys instead, in the form of keys.ron
    #[arg(long, help_heading = None)]
    keys: bool,
    /// Print JSON
    ///
    /// "settings" has each setting's "value" and "source", "files" each file's "path" and "status".
    #[arg(long, help_heading = None, conflicts_with = "keys")]
    json: bool,
}

pub(super) fn run(args: &ConfigArgs, given: &ArgMatches) -> CommandResult {
    let no_config = given.get_flag("no_config");
    let keymap = keys::keymap(no_config)?;
    if args.keys {
        return write_stdout(keymap.to_ron().as_bytes());
    }
    let settings = Settings::gather(given)?;
    if args.json {
        return json::print(&as_json(&settings, no_config));
    }
    // The width is in terminal columns, because a value from the environment may contain wide characters.
    let width = settings.effective.iter().map(|held| held.value.width()).max().unwrap_or(0);
    let mut text = String::new();
    for EffectiveSetting { name, value, source } in &settings.effective {
        let _ = writeln!(text, "{name:<16}{value:<width$}  {source}");
    }
    text.push('\n');
    for name in USER_FILES {
        let _ = writeln!(text, "{name:<16}{}", file_status(name, no_config));
    }
    // Made printable, because paths and environment variables may contain escape sequences.
    write_stdout(visible_lines(&text).as_bytes())
}

/// Returns a line about a user's file such as `config.ron`: its path, and whether it was read.
fn file_status(name: &str, is_ignored: bool) -> String {
    let Some(path) = path_of(name) else {
        return "nowhere: neither XDG_CONFIG_HOME nor HOME is the path of a folder".to_owned();
    };
    let found = match path.exists() {
        _ if is_ignored => "ignored: --no-config",
        true => "read",
        false => "does not exist",
    };
    format!("{} ({found})", path.display())
}

fn as_json(settings: &Settings, no_config: bool) -> Value {
    let held = settings.effective.iter();
    let held = held.map(|held| (held.name.clone(), json!({ "value": held.value, "source": held.source.to_string() })));
    let files = USER_FILES.map(|name| {
        let path = path_of(name).map(|path| path.to_string_lossy().into_owned());
        (name.to_owned(), json!({ "path": path, "status": file_status(name, no_config) }))
    });
    json!({ "settings": held.collect::<Map<_, _>>(), "files": Map::from_iter(files) })
}
