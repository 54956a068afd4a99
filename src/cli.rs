//! The command line: its arguments, its help, and the dispatch to commands.

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
mod shipped;
mod threads;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use deferred_args::DeferredArgs;
use std::ffi::OsString;
use std::process::ExitCode;

const ABOUT: &str = "A live ray tracer whose screen is the terminal";

const EXAMPLES: &str = "\
Without a scene the built-in one is shown. With several, n shows the next one and p the previous one.

Examples:
  termtrace corridor                                     open a built-in scene; termtrace scenes lists them
  termtrace scenes/three_spheres.ron                     open a scene; ? shows the keys, q quits
  termtrace scenes/three_spheres.ron --eye 0,4,9         from another eye point
  termtrace frame scenes/three_spheres.ron               one frame as text
  termtrace frame scenes/three_spheres.ron -o ball.png --pixels 800x600 --samples 16
  termtrace frame my.ron --check my.txt                  compare with a golden frame (--bless writes it)
  termtrace record scenes/three_spheres.ron --seconds 4 -o orbit.cast
  termtrace describe my.ron                              describe the picture in words
  termtrace explain my.ron --pixel 40,24                 explain one pixel in the lecture's symbols
  termtrace check my.ron                                 report every fault of a scene file
  termtrace bench my.ron --pixels 200x120                measure how fast its rays are traced
  termtrace doctor                                       show what was detected about this terminal
  termtrace config                                       show the effective settings and their sources
  termtrace completions bash                             print shell completions; termtrace man prints the man page
  generate_scene | termtrace -                           read the scene from standard input

Exit codes: 0 success; 1 failure or a difference found by --check; 2 wrong arguments or a faulty scene";

/// Returns the help text below the options.
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
    /// Ignore config.ron and keys.ron
    #[arg(long, global = true)]
    no_config: bool,
}

#[derive(Subcommand)]
enum Command {
    /// List the built-in scenes
    Scenes(DeferredArgs<shipped::ScenesArgs>),
    /// Print one frame, or compare it with a golden frame
    Frame(DeferredArgs<frame::FrameArgs>),
    /// Record a film along a camera path: asciicast, GIF or numbered PNGs
    Record(DeferredArgs<record::RecordArgs>),
    /// Explain one pixel: its ray, what it hit, each light
    Explain(DeferredArgs<explain::ExplainArgs>),
    /// Report every fault of a scene file
    Check(DeferredArgs<check::CheckArgs>),
    /// Describe a picture in words
    Describe(DeferredArgs<describe::DescribeArgs>),
    /// Measure how fast a scene is traced
    Bench(DeferredArgs<bench::BenchArgs>),
    /// Show what was detected about this terminal, and a test card
    Doctor(DeferredArgs<doctor::DoctorArgs>),
    /// Show the effective settings and where each comes from
    Config(DeferredArgs<config::ConfigArgs>),
    /// Print shell completions
    Completions(DeferredArgs<completions::CompletionsArgs>),
    /// Print the man page
    Man(DeferredArgs<completions::ManArgs>),
}

/// Runs the command of the command line and returns its exit code. Errors are printed to standard
/// error.
pub(crate) fn main() -> ExitCode {
    // A panic message printed at once would end up in the alternate screen and vanish with it.
    termtrace::internals::terminal::hold_panic_messages();
    // A write beyond the file size limit raises SIGXFSZ, which would kill the process before it restores the terminal;
    // this turns it into an error. Where that is not possible the process dies of the signal, as any other would.
    let _ = termtrace::internals::terminal::fail_large_writes();
    let (cli, given) = match parse(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(exit) => return exit,
    };
    // The matches of the subcommand if there is one: only these know which flags the user gave.
    let given = given.subcommand().map_or(&given, |(_, given)| given);
    let done = match cli.command {
        Some(Command::Scenes(_)) => shipped::list(),
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
