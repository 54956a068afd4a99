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
mod folder;
mod frame;
mod help;
mod deferred_args;
mod json;
mod live;
mod manual;
mod map;
mod new;
mod suggestions;
mod scene_source;
mod outcome;
mod outputs;
mod picture;
mod record;
mod reference;
mod scene_args;
mod serve;
mod settings;
mod shipped;
mod style;
mod threads;
mod tips;
mod tour;

use clap::{ArgAction, ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use deferred_args::DeferredArgs;
use std::ffi::OsString;
use std::process::ExitCode;

const ABOUT: &str = "A real-time ray tracer that runs in your terminal";

const USAGE: &str = "\
termtrace [OPTIONS] [SCENE]...
       termtrace COMMAND [OPTIONS] [SCENE]";

/// The commands and options that `-h` prints: a selection that fits on a screen of 80x24 cells.
const SUMMARY: &str = "\
Commands:
  tour, scenes, new           see or list the built-in scenes, write a scene
  frame, record, serve        write a picture or a film, show scenes over SSH
  describe, explain, check    a picture in words, one pixel, a file's faults
  doctor, config, bench       this terminal, the settings, the speed
  reference, completions, man, help, version

Options:
  --eye X,Y,Z                 look from there; --target X,Y,Z looks at a point
  --map MAP                   lambert, depth, normal, object and other maps
  --samples N|best            rays per pixel
  --color WHICH               auto, never, truecolor, 256, 16
  --compressed-link           the link compresses, as ssh -C does
  --reduced-motion            nothing moves by itself
  --no-config                 ignore config.ron and keys.ron
  -h, --help, -V, --version   -h prints a summary, --help everything

Keys: drag or WASD to move; v maps; x explain; ? all keys; q quit";

const EXAMPLES: &str = "\
Without a scene the default one is shown. With several, n shows the next one
and p the previous one.

Examples:
  termtrace tour                           see what ray tracing is
  termtrace corridor                       open a built-in scene
  termtrace scenes/three_spheres.ron       open a scene; ? shows the keys
  termtrace scenes/three_spheres.ron --eye 0,4,9
  termtrace frame scenes/three_spheres.ron
  termtrace frame scenes/three_spheres.ron -o ball.png --samples best
  termtrace frame my.ron --check my.txt    compare with a golden frame
  termtrace record scenes/three_spheres.ron --seconds 4 -o orbit.cast
  termtrace describe my.ron                describe the picture in words
  termtrace explain my.ron --pixel 40,24   explain one pixel
  termtrace check my.ron                   report every fault of a file
  termtrace bench my.ron --pixels 200x120  measure how fast it is traced
  termtrace doctor                         what was detected about this terminal
  termtrace config                         the effective settings
  generate_scene | termtrace -             read the scene from standard input";

/// Returns the text that `--help` prints below the options.
fn after_options() -> String {
    format!("{}\n\n{}\n\n{EXAMPLES}\n\n{}", help::KEYS, settings::SETTINGS_HELP, help::EXIT_STATUS)
}

/// Returns the commands with their descriptions, as `--help` lists them.
fn commands() -> String {
    let program = Command::augment_subcommands(clap::Command::new(""));
    let line = |command: &clap::Command| {
        let about = command.get_about().map(ToString::to_string).unwrap_or_default();
        format!("\n  {:<11}  {about}", command.get_name())
    };
    program.get_subcommands().map(line).fold("Commands:".to_owned(), |list, line| list + &line)
}

#[derive(Parser)]
#[command(name = "termtrace", version, about = ABOUT, override_usage = USAGE, max_term_width = 100)]
#[command(help_template = "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}{all-args}{after-help}")]
#[command(before_help = SUMMARY, before_long_help = commands(), after_long_help = after_options())]
#[command(args_conflicts_with_subcommands = true, disable_help_subcommand = true)]
#[command(disable_help_flag = true, disable_version_flag = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    live: live::LiveArgs,
    #[command(flatten)]
    no_config: settings::NoConfig,
    /// Print help; -h prints a summary
    #[arg(short, long, global = true, help_heading = None, action = ArgAction::Help, hide_short_help = true)]
    help: Option<bool>,
    /// Print the version
    #[arg(short = 'V', long, help_heading = None, action = ArgAction::Version, hide_short_help = true)]
    version: Option<bool>,
}

#[derive(Subcommand)]
enum Command {
    /// List the built-in scenes
    Scenes(DeferredArgs<shipped::ScenesArgs>),
    /// Lead through the built-in scenes, with a caption for each
    Tour(DeferredArgs<tour::TourArgs>),
    /// Write a commented starter scene and view it
    New(DeferredArgs<new::NewArgs>),
    /// Print one frame, or compare it with a golden frame
    Frame(DeferredArgs<frame::FrameArgs>),
    /// Record a film along a camera path: asciicast, GIF, PNGs
    Record(DeferredArgs<record::RecordArgs>),
    /// Explain one pixel: its ray, what it hit, each light
    Explain(DeferredArgs<explain::ExplainArgs>),
    /// Print the reference of scene files, or of one name
    Reference(DeferredArgs<reference::ReferenceArgs>),
    /// Report every fault of a scene file
    Check(DeferredArgs<check::CheckArgs>),
    /// Describe a picture in words
    Describe(DeferredArgs<describe::DescribeArgs>),
    /// Measure how fast a scene is traced
    Bench(DeferredArgs<bench::BenchArgs>),
    /// Show scenes to everyone who connects by SSH
    Serve(DeferredArgs<serve::ServeArgs>),
    /// Show what was detected about this terminal, and a test card
    Doctor(DeferredArgs<doctor::DoctorArgs>),
    /// Show the effective settings and where each comes from
    Config(DeferredArgs<config::ConfigArgs>),
    /// Print shell completions
    Completions(DeferredArgs<completions::CompletionsArgs>),
    /// Print the man page
    Man(DeferredArgs<completions::ManArgs>),
    /// Print the help of a command
    Help(DeferredArgs<help::HelpArgs>),
    /// Print the version
    Version(DeferredArgs<help::VersionArgs>),
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
        Some(Command::Tour(DeferredArgs(args))) => tour::run(&args, given),
        Some(Command::New(DeferredArgs(args))) => new::run(&args, given),
        Some(Command::Frame(DeferredArgs(args))) => frame::run(&args),
        Some(Command::Record(DeferredArgs(args))) => record::run(&args),
        Some(Command::Explain(DeferredArgs(args))) => explain::run(&args),
        Some(Command::Reference(DeferredArgs(args))) => reference::run(&args),
        Some(Command::Check(DeferredArgs(args))) => check::run(&args),
        Some(Command::Describe(DeferredArgs(args))) => describe::run(&args),
        Some(Command::Bench(DeferredArgs(args))) => bench::run(&args),
        Some(Command::Serve(DeferredArgs(args))) => serve::run(args, given),
        Some(Command::Doctor(_)) => doctor::run(given),
        Some(Command::Config(DeferredArgs(args))) => config::run(&args, given),
        Some(Command::Completions(DeferredArgs(args))) => completions::complete(&args),
        Some(Command::Man(DeferredArgs(args))) => completions::man(&args),
        Some(Command::Help(DeferredArgs(args))) => help::run(&args),
        Some(Command::Version(_)) => help::version(),
        None => live::run(&cli.live, given),
    };
    outcome::exit_code(done)
}

impl Cli {
    /// Returns the definition of the command line from which its help is rendered.
    ///
    /// clap's list of commands is hidden, because `before_help` has one of its own. `-h` shows no options except those
    /// that [`SUMMARY`] names.
    fn for_help() -> clap::Command {
        Self::command().mut_subcommands(|command| command.hide(true)).mut_args(|arg| arg.hide_short_help(true))
    }
}

fn parse(arguments: impl Iterator<Item = OsString>) -> Result<(Cli, ArgMatches), ExitCode> {
    let given = Cli::for_help().try_get_matches_from(arguments);
    given
        .and_then(|given| Ok((Cli::from_arg_matches(&given)?, given)))
        .map_err(|error| outcome::print_clap_message(&tips::with_tip(error)))
}
