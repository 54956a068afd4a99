//! `termtrace SCENE`: opens the live view on a terminal, or prints one frame if the output is not a
//! terminal.

use super::completions::{command_near, no_command};
use super::encoding::OrderArgs;
use super::folder;
use super::outcome::{CommandResult, Failure, reason, report_panic_and_exit, usage, write_stdout};
use super::scene_args::CameraArgs;
use super::scene_source::{SceneSource, warn_of_invisibility};
use super::settings::{SettingArgs, Settings, keys};
use super::shipped::ShippedScene;
use super::threads::on_threads;
use clap::{ArgMatches, Args};
use std::io::{self, IsTerminal};
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use termtrace::internals::capabilities::USUAL_CELL_ASPECT;
use termtrace::internals::control::{Command, Direction, KeyMode, Keymap};
use termtrace::internals::terminal::die_of;
use termtrace::internals::{app, cell};
use termtrace::live::{Ending, Options, Outcome, Signals, Source};
use termtrace::{Camera, Colors, Sampling, Size, export};

/// The content with which the live view opens; it decides the first hint and the captions.
#[derive(Clone, Copy)]
pub(super) enum Opening {
    /// The default scene, because none was named.
    Demo,
    /// Scenes that the user named.
    Scenes,
    /// A tour of this many scenes.
    Tour(usize),
}

/// Returns the hint shown until the first key press: the main commands and the keys bound to them.
fn hint(keymap: &Keymap, opening: Opening) -> String {
    let key = |command| keymap.key_of(&[KeyMode::Fly, KeyMode::Always], command).map(|key| key.to_string());
    let moves = [Direction::Forward, Direction::Left, Direction::Back, Direction::Right];
    let moves: Option<Vec<_>> = moves.into_iter().map(|direction| key(Command::Move(direction))).collect();
    let moves = moves.filter(|keys| keys.iter().all(|key| key.len() == 1)).map(|keys| keys.concat().to_uppercase());
    let does = |command, does: &str| key(command).map(|key| format!("{key} {does}"));
    let moves = Some(moves.map_or_else(|| "drag to look".to_owned(), |keys| format!("drag or {keys} to move")));
    let (help, quit) = (does(Command::Help, "keys"), does(Command::Quit, "quit"));
    // Each line fits into 80 columns. On narrower screens the second part is left out first, then the third and so on;
    // the first part stays.
    let parts = match opening {
        Opening::Demo => vec![moves, Some("termtrace FILE opens yours".to_owned()), help, quit],
        Opening::Scenes => {
            vec![moves, does(Command::NextMap, "maps"), does(Command::Explain, "explain"), help, quit]
        }
        Opening::Tour(_) => {
            vec![does(Command::NextScene, "next scene"), does(Command::LastScene, "previous scene"), moves, help, quit]
        }
    };
    parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

const SCENES_HELP: &str = "Scenes or meshes; - is standard input [default: three_spheres]";

#[derive(Args)]
pub(super) struct LiveArgs {
    #[arg(value_name = "SCENE", help = SCENES_HELP)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    camera_args: CameraArgs,
    #[command(flatten)]
    view: ViewArgs,
}

/// The flags of the live view besides its scenes and their camera.
#[derive(Args)]
pub(super) struct ViewArgs {
    #[command(flatten)]
    settings: SettingArgs,
    #[command(flatten)]
    order: OrderArgs,
    /// Do not print the camera on exit
    #[arg(long, help_heading = None)]
    quiet: bool,
}

impl ViewArgs {
    /// Returns the options of the live view from the effective `settings`, which already include
    /// this command line's flags.
    fn options(&self, settings: &SettingArgs, keymap: Keymap, opening: Opening) -> Options {
        let mut options = Options::new(settings.terminal.detection_hints());
        options.hints.refuses_shifts = settings.refuses_moves();
        options.order = self.order.cell_order();
        options.quality = settings.loss.given_quality();
        options.max_rate = settings.loss.given_max_rate();
        options.max_frames = settings.fps;
        options.sampling = settings.samples;
        options.key_speed = settings.key_speed();
        options.reduced_motion = settings.reduced_motion();
        options.map = settings.map.map();
        options.exports = Some(PathBuf::from("."));
        options.welcome = settings.shows_hint().then(|| hint(&keymap, opening));
        options.tour = if let Opening::Tour(scenes) = opening { Some(scenes) } else { None };
        options.few_colors = settings.shows_hint().then(|| "256 colours; try --color truecolor".to_owned());
        options.keymap = keymap;
        options
    }
}

/// Opens the live view if standard output is a terminal, and prints one frame otherwise. `given`
/// are clap's matches of `args`, which also say which flags were given.
pub(super) fn run(args: &LiveArgs, given: &ArgMatches) -> CommandResult {
    // A misspelt command is parsed by clap as the name of a scene. If a file of that name exists, it is a scene.
    if let Some(first) = args.scenes.first().and_then(|first| first.to_str())
        && !Path::new(first).exists()
        && ShippedScene::named(Path::new(first)).is_none()
        && command_near(first).is_some()
    {
        return Err(no_command(first));
    }
    if !io::stdout().is_terminal() {
        return print_frame(args);
    }
    let opening = if args.scenes.is_empty() { Opening::Demo } else { Opening::Scenes };
    open_view(&args.view, given, opening, args.camera_args.threads, || sources(args))
}

/// Prints one frame as `termtrace frame` does. Only flags are used, because output to a file or
/// pipe must not depend on config.ron.
fn print_frame(args: &LiveArgs) -> CommandResult {
    let settings = &args.view.settings;
    settings.check_samples_for_map()?;
    let scenes = folder::expanded(&args.scenes)?;
    if let [first, more @ ..] = &scenes[..]
        && !more.is_empty()
    {
        let more: Vec<_> = more.iter().map(|path| path.to_string_lossy()).collect();
        let message = format!(
            "standard output is not a terminal: only one scene can be printed, but \"{}\" follows \"{}\"",
            more.join(" "),
            first.display()
        );
        return Err(Failure::Usage(message));
    }
    let source = SceneSource::from_argument(scenes.first().map(PathBuf::as_path), args.camera_args.mesh_format)?;
    let scene = args.camera_args.load_scene(&source)?;
    let cell_aspect = settings.terminal.cell_aspect.unwrap_or(USUAL_CELL_ASPECT);
    let cell_mode = settings.terminal.cells.mode_for_file(Colors::None);
    let resolution = cell::resolution(cell_mode, Size::new(80, 24), cell_aspect).map_err(usage)?;
    let sampling = settings.samples.unwrap_or(Sampling::Each(NonZeroU32::MIN));
    let map = settings.map.map();
    warn_of_invisibility(map, &scene);
    let trace = || settings.terminal.cells.painter(cell_mode).trace(map, &scene, scene.camera(), resolution, sampling);
    let grid = on_threads(args.camera_args.threads, trace)?;
    write_stdout(&export::ansi_or_text(&grid, cell_mode.colors))
}

/// Runs the live view of the scenes that `sources` returns. The terminal is restored before any
/// message is printed, even after a panic.
pub(super) fn open_view(
    args: &ViewArgs,
    given: &ArgMatches,
    opening: Opening,
    threads: Option<u16>,
    sources: impl FnOnce() -> Result<Vec<Source<Failure>>, Failure>,
) -> CommandResult {
    #[cfg(feature = "test-hooks")]
    connect_fault_injector();
    let settings = Settings::gather(given)?.args;
    settings.check_samples_for_map()?;
    let keymap = keys::keymap(given.get_flag("no_config"))?;
    let (sources, mut options) = (sources()?, args.options(&settings, keymap, opening));
    options.threads = threads.map(usize::from);
    // Signal handlers are installed before the terminal is put into raw mode, so that no signal can leave it so.
    let mut signals = Signals::catch().map_err(|error| Failure::runtime("signals", reason(&error)))?;
    // Unwind-safe, because after a panic nothing that the view has changed is used again.
    let ended = catch_unwind(AssertUnwindSafe(|| app::open(sources, options, &mut signals)));
    let Outcome { ending, moved, heard, .. } = match ended {
        Ok(outcome) => outcome.map_err(|error| match error {
            // The message already names the picture's size; a prefix "terminal: " would mislead.
            app::Error::Terminal(error) if error.kind() == io::ErrorKind::OutOfMemory => {
                Failure::Runtime(error.to_string())
            }
            app::Error::Terminal(error) => Failure::runtime("terminal", reason(&error)),
            app::Error::Scene(failure) => failure,
            error => Failure::Runtime(error.to_string()),
        })?,
        Err(_) => report_panic_and_exit(),
    };
    if let Ending::Signal(signal) = ending {
        // The program ends by the signal itself, because the shell must see the signal and not an exit code.
        die_of(signal);
    }
    match moved {
        Some(camera) if heard && !args.quiet => write_stdout(last_view(&camera.rounded()).as_bytes()),
        _ => Ok(()),
    }
}

/// Returns the text about the camera on exit: a line of a scene file, and the same as flags.
// The other lines are comments of a scene file, so that all three can be pasted into one.
fn last_view(camera: &Camera) -> String {
    format!("// your last view, for a scene file or as flags:\n{},\n// {}\n", camera.to_ron(), camera.to_flags())
}

/// Returns the scenes to show. Standard input is read here, before raw mode, because the user may
/// type it.
fn sources(args: &LiveArgs) -> Result<Vec<Source<Failure>>, Failure> {
    if args.scenes.is_empty() {
        return Ok(vec![live_source(SceneSource::from_argument(None, None)?, &args.camera_args)]);
    }
    let scenes = folder::expanded(&args.scenes)?;
    let source = |path: &PathBuf| SceneSource::from_path(path, args.camera_args.mesh_format);
    scenes.iter().map(|path| source(path).map(|scene| live_source(scene, &args.camera_args))).collect()
}

/// Returns the source of a scene for the live view.
pub(super) fn live_source(scene: SceneSource, camera_args: &CameraArgs) -> Source<Failure> {
    let file = if let SceneSource::File(path) = &scene { Some(path.clone()) } else { None };
    let (name, camera_args) = (scene.to_string(), camera_args.clone());
    // A file is read later, on another thread, so its name alone decides whether it is a mesh.
    let is_mesh = scene.is_mesh();
    let source = Source::turnable(name, move |watcher, up| camera_args.load_draft(&scene, up, watcher));
    let source = if is_mesh { source.orbited() } else { source };
    file.into_iter().fold(source, Source::with_file)
}

/// Connects to the test that started the program, so that the test can inject faults.
#[cfg(feature = "test-hooks")]
fn connect_fault_injector() {
    let path = std::env::var_os("TERMTRACE_TEST_SOCKET");
    if let Some(Ok(test)) = path.map(std::os::unix::net::UnixStream::connect) {
        termtrace::internals::terminal::inject_faults(test);
    }
}
