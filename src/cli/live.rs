//! `termtrace SCENE`: the live view on a terminal, one frame anywhere else.

use super::cells::CellArgs;
use super::encoding::EncodingArgs;
use super::picture::{parse_cell_aspect, parse_samples};
use super::{Done, Failure, SceneArgs, complain_of_panic, reason, write_stdout};
use clap::Args;
use std::io::{self, IsTerminal};
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use termtrace::app::{self, Ending, Options, Outcome};
use termtrace::capabilities::{Colors, USUAL_CELL_ASPECT};
use termtrace::cell;
use termtrace::export;
use termtrace::grid::Size;
use termtrace::render::{Sampling, render};
use termtrace::terminal::{Signals, die_of};
use termtrace::tone::tone;

/// The names of the commands, for who misspells one.
const COMMANDS: [&str; 4] = ["frame", "record", "check", "doctor"];

#[derive(Args)]
pub(super) struct LiveArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// What is too much, kept to say so
    #[arg(hide = true)]
    more: Vec<String>,
    #[command(flatten)]
    cells: CellArgs,
    /// A cell's height over its width [default: as the terminal says, or 2]
    #[arg(long, value_name = "A", value_parser = parse_cell_aspect)]
    cell_aspect: Option<f32>,
    #[command(flatten)]
    encoding: EncodingArgs,
    /// Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: in motion as many as the
    /// time allows, at rest best]
    #[arg(long, value_name = "N|best", value_parser = parse_samples)]
    samples: Option<Sampling>,
    /// The most frames per second [default: 60]
    #[arg(long, value_name = "N", value_parser = parse_fps)]
    fps: Option<f32>,
    /// Do not print the camera on leaving
    #[arg(long)]
    quiet: bool,
}

impl LiveArgs {
    fn options(&self) -> Options {
        let mut options = Options::new(self.cells.hints(self.cell_aspect));
        options.order = self.encoding.order();
        options.quality = self.encoding.quality();
        options.max_rate = self.encoding.max_rate();
        options.max_frames = self.fps;
        options.sampling = self.samples;
        options.threads = self.scene.threads.map(usize::from);
        options
    }
}

/// Frames per second: more than one in a hundred seconds, so that a typing error does not look like a crash.
fn parse_fps(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|fps| (0.01..=1_000.0).contains(fps));
    number.ok_or_else(|| "expected frames per second, from 0.01 to 1000".to_owned())
}

pub(super) fn run(args: &LiveArgs) -> Done {
    if !args.more.is_empty() {
        return Err(too_much(&args.scene.path().display().to_string(), &args.more));
    }
    if io::stdout().is_terminal() { look(args) } else { print(args) }
}

/// More than a scene: its name was likely meant for a command.
fn too_much(first: &str, more: &[String]) -> Failure {
    let close = COMMANDS.into_iter().find(|command| strsim::damerau_levenshtein(first, command) <= 2);
    Failure::Usage(match close {
        Some(command) => format!("there is no command \"{first}\"; did you mean \"{command}\"?"),
        None => format!("one scene at a time: what is \"{}\" after \"{first}\"?", more.join(" ")),
    })
}

/// One frame, as `termtrace frame` prints it.
fn print(args: &LiveArgs) -> Done {
    let scene = args.scene.load()?;
    let cell_aspect = args.cell_aspect.unwrap_or(USUAL_CELL_ASPECT);
    let cell_mode = args.cells.in_file(Colors::None);
    let resolution = cell::resolution(cell_mode, Size::new(80, 24), cell_aspect);
    let sampling = args.samples.unwrap_or(Sampling::Each(NonZeroU32::MIN));
    let picture = args.scene.on_threads(|| tone(&render(&scene, &scene.camera, resolution, sampling), &scene))?;
    let grid = cell::grid_from_picture(cell_mode, &picture);
    write_stdout(&match cell_mode.colors {
        Colors::None => export::text(&grid).into_bytes(),
        _ => export::ansi(&grid),
    })
}

/// The live view. Whatever happens in it, the terminal is given back before a word is said.
fn look(args: &LiveArgs) -> Done {
    #[cfg(feature = "test-hooks")]
    rehearse();
    let (scene, stdin, options) = (args.scene.clone(), args.scene.stdin()?, args.options());
    let mut signals = Signals::catch().map_err(|error| Failure::runtime("signals", reason(&error)))?;
    let ended = catch_unwind(AssertUnwindSafe(|| {
        app::open(move |watcher| scene.draft(stdin.as_deref(), watcher), options, &mut signals)
    }));
    let Outcome { ending, moved, heard } = match ended {
        Ok(outcome) => outcome.map_err(|error| match error {
            app::Error::Terminal(error) => Failure::runtime("terminal", reason(&error)),
            app::Error::Scene(failure) => failure,
        })?,
        Err(_) => complain_of_panic(),
    };
    if let Ending::Signal(signal) = ending {
        die_of(signal);
    }
    match moved {
        // With a comma: a line for the scene file.
        Some(camera) if heard && !args.quiet => write_stdout(format!("{},\n", camera.to_ron()).as_bytes()),
        _ => Ok(()),
    }
}

/// Lets the test that started us say where things are to go wrong.
#[cfg(feature = "test-hooks")]
fn rehearse() {
    let path = std::env::var_os("TERMTRACE_TEST_SOCKET");
    if let Some(Ok(test)) = path.map(std::os::unix::net::UnixStream::connect) {
        termtrace::terminal::rehearse(test);
    }
}
