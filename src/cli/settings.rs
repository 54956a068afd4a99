//! Settings: flags of the live view that can also be set in the environment and in `config.ron`.
//!
//! Each argument of [`SettingArgs`] is a setting, and clap is the only list and parser of them: a setting has the
//! flag's name with underscores in the file, and its value is parsed as the flag's. Precedence: flag, environment,
//! file, default.

pub(super) mod defaults;
mod entries;
pub(super) mod files;
pub(super) mod keys;
mod values;

use super::cells::CellArgs;
use super::encoding::{LossArgs, MovesArg};
use super::map::MapArgs;
use super::outcome::{CommandResult, Failure, usage};
use super::picture::{parse_cell_aspect, parse_samples};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use entries::SettingEntry;
use files::UserFile;
use std::path::PathBuf;
use termtrace::Sampling;
use termtrace::internals::capabilities::Hints;
use termtrace::internals::control::KeySpeed;

/// The section of `--help` on permanent settings, below the options.
pub(super) const SETTINGS_HELP: &str = "\
Settings:
  Permanent settings live in config.ron under the flags' names, as in
  (fps: 30, color: 256), or in the environment, as in TERMTRACE_FPS=30. A flag
  overrides the environment, which overrides the file. keys.ron beside it binds
  keys. termtrace config shows the effective settings, where each comes from,
  and where the files are.";

/// The flag `--no-config`, for commands that read the user's configuration files.
#[derive(Args)]
pub(super) struct NoConfig {
    /// Ignore config.ron and keys.ron
    #[arg(long, help_heading = None)]
    no_config: bool,
}

/// The flags that override what is detected about the terminal.
#[derive(Args)]
#[command(next_help_heading = "Cells")]
pub(super) struct TerminalArgs {
    #[command(flatten)]
    pub(super) cells: CellArgs,
    #[arg(long, value_name = "A", value_parser = parse_cell_aspect)]
    #[arg(hide_short_help = true)]
    #[arg(help = defaults::help("cell_aspect", "A cell's height over its width"))]
    pub(super) cell_aspect: Option<f32>,
}

impl TerminalArgs {
    /// Returns the hints from which the terminal's capabilities are detected: these flags, and
    /// environment variables.
    pub(super) fn detection_hints(&self) -> Hints {
        self.cells.detection_hints(self.cell_aspect)
    }
}

/// The settings, as flags.
#[derive(Args)]
pub(super) struct SettingArgs {
    #[command(flatten)]
    pub(super) terminal: TerminalArgs,
    #[command(flatten)]
    pub(super) map: MapArgs,
    #[arg(long, value_name = "N|best", value_parser = parse_samples, help_heading = "Picture", hide_short_help = true)]
    #[arg(help = defaults::help("samples", "Rays per pixel, also in motion; best: up to 64 at edges"))]
    pub(super) samples: Option<Sampling>,
    #[command(flatten)]
    pub(super) loss: LossArgs,
    #[arg(long, value_name = "MOVES", help_heading = "Link", hide_short_help = true)]
    #[arg(help = defaults::help("moves", "Whether the terminal moves cells that it shows on a slow link"))]
    moves: Option<MovesArg>,
    #[arg(long, value_name = "N", value_parser = parse_fps, hide_short_help = true)]
    #[arg(help = defaults::help("fps", "Frame-rate cap in frames per second"))]
    pub(super) fps: Option<f32>,
    #[arg(long, value_name = "N", value_parser = parse_speed, help_heading = "Motion")]
    #[arg(hide_short_help = true)]
    #[arg(help = defaults::help("move_speed", "Speed at which keys move the eye: a factor from 0.1 to 10"))]
    move_speed: Option<f32>,
    #[arg(long, value_name = "N", value_parser = parse_speed, help_heading = "Motion")]
    #[arg(hide_short_help = true)]
    #[arg(help = defaults::help("turn_speed", "Speed at which keys turn the view: a factor from 0.1 to 10"))]
    turn_speed: Option<f32>,
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    #[arg(help = defaults::help("reduced_motion", "Each key press moves one step at once; nothing moves by itself"))]
    #[arg(hide_possible_values = true, help_heading = "Motion", hide_short_help = true)]
    reduced_motion: Option<bool>,
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    #[arg(help = defaults::help("hint", "Show which keys to press, in the lowest row, until the first key press"))]
    #[arg(hide_possible_values = true, help_heading = None, hide_short_help = true)]
    hint: Option<bool>,
}

impl SettingArgs {
    /// Refuses more than one sample per pixel for a map whose values cannot be averaged.
    pub(super) fn check_samples_for_map(&self) -> CommandResult {
        self.map.check_samples(self.samples)
    }

    pub(super) fn key_speed(&self) -> KeySpeed {
        KeySpeed { moving: self.move_speed.unwrap_or(1.0), turning: self.turn_speed.unwrap_or(1.0) }
    }

    /// Returns whether the terminal must never move cells that it shows.
    pub(super) fn refuses_moves(&self) -> bool {
        self.moves == Some(MovesArg::Off)
    }

    pub(super) fn reduced_motion(&self) -> bool {
        self.reduced_motion.unwrap_or(false)
    }

    /// Returns whether the view starts with a line that shows the main keys.
    pub(super) fn shows_hint(&self) -> bool {
        self.hint.unwrap_or(true)
    }
}

/// Reads a file of settings, whose names are those of `command`'s flags.
#[cfg(feature = "serve")]
pub(super) fn read_as_flags(path: PathBuf, command: &Command) -> Result<ArgMatches, Failure> {
    use super::outcome::Failure::Scene;
    let file = UserFile::read_at(path).map_err(|error| match error {
        termtrace::LoadError::Scene(error) => Scene(error),
        error => usage(error),
    })?;
    let setting =
        |entry: &SettingEntry| command.get_arguments().find(|setting| setting.get_id() == entry.name.as_str());
    let entries = entries::read(&file, command).map_err(Scene)?;
    // The settings become command line arguments, so that clap checks them as it checks flags.
    let words = entries.iter().filter_map(|entry| Some(values::flag_with_value(setting(entry)?, &entry.text)));
    command.clone().try_get_matches_from(words).map_err(usage)
}

/// Parses a frame rate of at least 0.01 frames per second: a lower one, probably a typing error,
/// would look like a hang.
pub(super) fn parse_fps(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|fps| (0.01..=1_000.0).contains(fps));
    number.ok_or_else(|| "expected frames per second, from 0.01 to 1000".to_owned())
}

/// Parses a speed as a factor of the default speed, from 0.1 to 10.
fn parse_speed(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|speed| (0.1..=10.0).contains(speed));
    number.ok_or_else(|| "expected a factor from 0.1 to 10".to_owned())
}

/// The effective settings, after flags, environment and `config.ron` are merged.
pub(super) struct Settings {
    pub(super) args: SettingArgs,
    /// The effective value and the source of each setting, in the order of the help.
    pub(super) effective: Vec<EffectiveSetting>,
}

/// The effective value of a setting, and its source.
pub(super) struct EffectiveSetting {
    /// The setting's name in `config.ron`.
    pub(super) name: String,
    pub(super) value: String,
    pub(super) source: SettingSource,
}

/// The source of a setting's value.
pub(super) enum SettingSource {
    Flag(String),
    /// An environment variable.
    Variable(String),
    /// The path of `config.ron`, and the line of the setting, counted from 1.
    File(PathBuf, usize),
    Default,
}

impl std::fmt::Display for SettingSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Flag(flag) => f.write_str(flag),
            Self::Variable(name) => f.write_str(name),
            Self::File(path, line) => write!(f, "{}:{line}", path.display()),
            Self::Default => f.write_str("default"),
        }
    }
}

impl Settings {
    /// Gathers all settings from the flags, the environment, `config.ron` (unless `--no-config` is
    /// given) and the defaults.
    pub(super) fn gather(given: &ArgMatches) -> Result<Self, Failure> {
        let command = command();
        let file = if given.get_flag("no_config") { None } else { UserFile::read("config.ron").map_err(usage)? };
        let entries = match &file {
            Some(file) => entries::read(file, &command).map_err(usage)?,
            None => Vec::new(),
        };
        let effective: Vec<_> = command
            .get_arguments()
            .map(|setting| {
                let said = value_from_flag(setting, given)
                    .or_else(|| value_from_environment(setting))
                    .or_else(|| value_from_file(setting, &entries, file.as_ref()?))
                    .unwrap_or_else(|| {
                        (defaults::of_setting(setting.get_id().as_str()).to_owned(), SettingSource::Default)
                    });
                EffectiveSetting { name: setting.get_id().to_string(), value: said.0, source: said.1 }
            })
            .collect();
        // The effective values are written as command line arguments and parsed by clap, so that values from all
        // sources pass the parsers of the flags.
        let mut words = Vec::new();
        for (setting, held) in command.get_arguments().zip(&effective) {
            if let SettingSource::Variable(name) = &held.source {
                values::check(&command, setting, &held.value)
                    .map_err(|wrong| Failure::Usage(format!("{name}=\"{}\": {wrong}", held.value)))?;
            }
            if !matches!(held.source, SettingSource::Default) {
                words.push(values::flag_with_value(setting, &held.value));
            }
        }
        let args = command.try_get_matches_from(words).and_then(|found| SettingArgs::from_arg_matches(&found));
        Ok(Self { args: args.map_err(usage)?, effective })
    }

    /// Returns the source of the value of the setting `name`.
    pub(super) fn source(&self, name: &str) -> &SettingSource {
        self.effective.iter().find(|held| held.name == name).map_or(&SettingSource::Default, |held| &held.source)
    }
}

/// Returns a clap command whose only arguments are the settings.
fn command() -> Command {
    SettingArgs::augment_args(Command::new("termtrace").no_binary_name(true))
}

type GivenValue = (String, SettingSource);

fn value_from_flag(setting: &Arg, given: &ArgMatches) -> Option<GivenValue> {
    let id = setting.get_id().as_str();
    // The result is `None` if the command has no such flag: `doctor` has only those of the terminal.
    let text = given.try_get_raw(id).ok()??.next()?.to_string_lossy().into_owned();
    let is_given = given.value_source(id) == Some(ValueSource::CommandLine);
    is_given.then_some((text, SettingSource::Flag(values::flag(setting))))
}

/// Returns the setting's value from its variable `TERMTRACE_...` or, for colours, from a common one
/// such as `NO_COLOR`.
fn value_from_environment(setting: &Arg) -> Option<GivenValue> {
    let name = format!("TERMTRACE_{}", setting.get_id().as_str().to_uppercase());
    // An empty variable counts as unset, as for `NO_COLOR`.
    if let Some(text) = std::env::var_os(&name).filter(|text| !text.is_empty()) {
        return Some((text.to_string_lossy().into_owned(), SettingSource::Variable(name)));
    }
    let gathered = Hints::gather(&|name| std::env::var(name).ok(), &|_| None);
    let name = gathered.color_variable().filter(|_| setting.get_id() == "color")?;
    Some(("auto".to_owned(), SettingSource::Variable(name.to_owned())))
}

fn value_from_file(setting: &Arg, entries: &[SettingEntry], file: &UserFile) -> Option<GivenValue> {
    let entry = entries.iter().find(|entry| setting.get_id() == entry.name.as_str())?;
    Some((entry.text.clone(), SettingSource::File(file.path.clone(), entry.line)))
}

#[cfg(all(test, unit_tests))]
mod tests;
