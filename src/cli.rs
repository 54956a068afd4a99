//! The command line: what it says, and what is then done.

mod bench;
mod cells;
mod check;
mod completions;
mod config;
mod describe;
mod doctor;
mod encoding;
mod explain;
mod frame;
mod deferred_args;
mod live;
mod map;
mod suggestions;
mod scene_source;
mod outcome;
mod outputs;
mod picture;
mod record;
mod renamed;
mod scene_args;
mod settings;
mod threads;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use deferred_args::DeferredArgs;
use std::ffi::OsString;
use std::process::ExitCode;

const ABOUT: &str = "A live ray tracer whose screen is the terminal";

const EXAMPLES: &str = "\
Without a scene there is one to look into that is built in. Of several, n shows the next, and p the one before.

Examples:
  termtrace scenes/three_spheres.ron                     look into a scene; ? shows the keys, q quits
  termtrace scenes/three_spheres.ron --eye 0,4,9         from another eye point
  termtrace frame scenes/three_spheres.ron               one frame as text
  termtrace frame scenes/three_spheres.ron -o ball.png --pixels 800x600 --samples 16
  termtrace frame my.ron --check my.txt                  compare with a golden frame (--bless writes it)
  termtrace record scenes/three_spheres.ron --seconds 4 -o orbit.cast
  termtrace describe my.ron                              say in words what there is to see
  termtrace explain my.ron --pixel 40,24                 say what a pixel comes from, in the lecture's symbols
  termtrace check my.ron                                 say what is wrong with a scene file
  termtrace bench my.ron --pixels 200x120                say how fast its rays are traced
  termtrace doctor                                       say what this terminal can do, with a test card
  termtrace config                                       say which settings hold, and who says so
  termtrace completions bash                             what a shell completes; termtrace man is the manual
  generate_scene | termtrace -                           read the scene from standard input

Exit codes: 0 done; 1 it could not be done, or --check found a difference; 2 wrong arguments or a wrong scene";

/// Stands below the options.
fn help() -> String {
    let cells = cells::after_help();
    let explained = [&cells, map::MAP_HELP, encoding::ENCODING_HELP, settings::SETTINGS_HELP].join("\n");
    format!("{explained}\n\n{EXAMPLES}")
}

#[derive(Parser)]
#[command(name = "termtrace", version, about = ABOUT, after_help = help())]
#[command(args_conflicts_with_subcommands = true, disable_help_subcommand = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    live: live::LiveArgs,
    /// Read none of the user's own files
    #[arg(long, global = true)]
    no_config: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Print one frame, or compare it with a golden one
    Frame(DeferredArgs<frame::FrameArgs>),
    /// Record a film along a camera path: asciicast, GIF or numbered PNGs
    Record(DeferredArgs<record::RecordArgs>),
    /// Say what a pixel comes from: its ray, what that met, the lights
    Explain(DeferredArgs<explain::ExplainArgs>),
    /// Say what is wrong with a scene file, or that it is fine
    Check(DeferredArgs<check::CheckArgs>),
    /// Say in words what a picture shows
    Describe(DeferredArgs<describe::DescribeArgs>),
    /// Time the tracing of a scene
    Bench(DeferredArgs<bench::BenchArgs>),
    /// Say what this terminal can do and who says so, and draw a test card
    Doctor(DeferredArgs<doctor::DoctorArgs>),
    /// Say which settings hold, and who says so
    Config(DeferredArgs<config::ConfigArgs>),
    /// Print what a shell is to know to complete arguments
    Completions(DeferredArgs<completions::CompletionsArgs>),
    /// Print the manual, for man
    Man(DeferredArgs<completions::ManArgs>),
}

/// Reads the command line, does what it says, and says what went wrong.
pub(crate) fn main() -> ExitCode {
    termtrace::internals::terminal::hold_panic_messages();
    // Where it cannot be done, such a write ends the process as it would any other.
    let _ = termtrace::internals::terminal::fail_large_writes();
    let (cli, given) = match parse(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(exit) => return exit,
    };
    // What was given to the command, if there is one.
    let given = given.subcommand().map_or(&given, |(_, given)| given);
    let done = match cli.command {
        Some(Command::Frame(DeferredArgs(args))) => frame::run(&args),
        Some(Command::Record(DeferredArgs(args))) => record::run(&args),
        Some(Command::Explain(DeferredArgs(args))) => explain::run(&args),
        Some(Command::Check(DeferredArgs(args))) => check::run(&args),
        Some(Command::Describe(DeferredArgs(args))) => describe::run(&args),
        Some(Command::Bench(DeferredArgs(args))) => bench::run(&args),
        Some(Command::Doctor(_)) => doctor::run(given),
        Some(Command::Config(DeferredArgs(args))) => config::run(&args, given),
        Some(Command::Completions(DeferredArgs(args))) => completions::complete(&args),
        Some(Command::Man(DeferredArgs(args))) => completions::man(&args),
        None => live::run(&cli.live, given),
    };
    outcome::exit_code(done)
}

fn parse(arguments: impl Iterator<Item = OsString>) -> Result<(Cli, ArgMatches), ExitCode> {
    let given = Cli::command().try_get_matches_from(arguments);
    given
        .and_then(|given| Ok((Cli::from_arg_matches(&given)?, given)))
        .map_err(|error| outcome::print_clap_message(&renamed::with_tip(error)))
}
