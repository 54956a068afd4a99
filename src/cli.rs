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
mod later;
mod live;
mod near;
mod origin;
mod outputs;
mod picture;
mod record;
mod settings;
mod view;

use clap::{ArgMatches, Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use glam::Vec3;
use later::Later;
use origin::Origin;
use std::ffi::OsString;
use std::fmt::{self, Display};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use termtrace::camera::{Camera, CameraError, Pose};
use termtrace::progress::Watcher;
use termtrace::scene::{Draft, Scene};
use termtrace::scene_text::SceneError;
use termtrace::text::{Notice, visible_lines};

/// Why a command ends without having done what was asked.
enum Failure {
    /// It could not be done: exit code 1.
    Runtime(String),
    /// The command line or a file is wrong: exit code 2.
    Usage(String),
    /// The scene is wrong: exit code 2.
    Scene(SceneError),
    /// All is said already, but for the exit code.
    Said(u8),
}

impl Failure {
    /// It could not be done, with the reason after what it was about.
    fn runtime(what: impl Display, why: impl Display) -> Self {
        Self::Runtime(format!("{what}: {why}"))
    }
}

/// The command line or the scene is wrong.
fn usage(error: impl Display) -> Failure {
    Failure::Usage(error.to_string())
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Runtime(message) | Self::Usage(message) => f.write_str(message),
            Self::Scene(error) => error.fmt(f),
            Self::Said(_) => Ok(()),
        }
    }
}

impl From<Failure> for Notice {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Scene(error) => error.notice(),
            failure => failure.to_string().into(),
        }
    }
}

type Done = Result<(), Failure>;

const ABOUT: &str = "A live ray tracer whose screen is the terminal";

const EXAMPLES: &str = "\
Without a scene there is one to look into that is built in. Of several, n shows the next, and p the one before.

Examples:
  termtrace scenes/three_spheres.ron                     look into a scene; ? shows the keys, q leaves
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
    let explained = [cells::EXPLAINED, view::EXPLAINED, encoding::EXPLAINED, settings::EXPLAINED].join("\n");
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
    Frame(Later<frame::FrameArgs>),
    /// Record a film along a camera path: asciicast, GIF or numbered PNGs
    Record(Later<record::RecordArgs>),
    /// Say what a pixel comes from: its ray, what that met, the lights
    Explain(Later<explain::ExplainArgs>),
    /// Say what is wrong with a scene file, or that it is fine
    Check(Later<check::CheckArgs>),
    /// Say in words what a picture shows
    Describe(Later<describe::DescribeArgs>),
    /// Time the tracing of a scene
    Bench(Later<bench::BenchArgs>),
    /// Say what this terminal can do and who says so, and draw a test card
    Doctor(Later<doctor::DoctorArgs>),
    /// Say which settings hold, and who says so
    Config(Later<config::ConfigArgs>),
    /// Print what a shell is to know to complete arguments
    Completions(Later<completions::CompletionsArgs>),
    /// Print the manual, for man
    Man(Later<completions::ManArgs>),
}

/// The scene, and who looks at it: on every command.
#[derive(Args)]
struct SceneArgs {
    /// The scene file; - reads the scene from standard input
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    #[command(flatten)]
    look: LookArgs,
}

impl SceneArgs {
    /// The scene's file name.
    fn path(&self) -> &Path {
        &self.scene
    }

    /// Refuses to write over the scene, or another file that it is shown with.
    fn keeps(&self, others: &[&Path], output: &Path) -> Done {
        let is_output = |input: &&Path| match (input.canonicalize(), output.canonicalize()) {
            (Ok(input), Ok(output)) => input == output,
            _ => false,
        };
        if [&[self.path()], others].concat().iter().any(is_output) {
            return Err(Failure::Usage(format!("{} would be written over what it is made from", output.display())));
        }
        Ok(())
    }

    /// The scene, with the camera that the command line wants.
    fn load(&self) -> Result<Scene, Failure> {
        let scene = Origin::of(&self.scene)?.load()?;
        let camera = self.look.camera(scene.camera()).map_err(usage)?;
        Ok(scene.with_camera(camera))
    }

    /// Does something on the threads that the command line wants.
    fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        on_threads(self.look.threads, work)
    }
}

/// Who looks at the scene.
#[derive(Args, Clone)]
struct LookArgs {
    /// Where to look from, instead of the scene's eye point
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    eye: Option<Vec3>,
    /// Where to look to, instead of the scene's target
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    target: Option<Vec3>,
    /// What is vertical in the picture, instead of the scene's up
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    up: Option<Vec3>,
    /// The vertical field of view in degrees, instead of the scene's
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    fov: Option<f32>,
    /// How many threads trace [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl LookArgs {
    /// The scene as it is to be looked at, not built yet, until the watcher cancels it.
    fn draft(&self, origin: &Origin, watcher: &Watcher<'_>) -> Result<Draft, Failure> {
        let draft = origin.draft(watcher)?;
        let camera = self.camera(draft.camera()).map_err(usage)?;
        Ok(draft.with_camera(camera))
    }

    fn camera(&self, camera: &Camera) -> Result<Camera, CameraError> {
        let Pose { eye, target, up } = camera.pose();
        let pose =
            Pose { eye: self.eye.unwrap_or(eye), target: self.target.unwrap_or(target), up: self.up.unwrap_or(up) };
        let camera = camera.with_pose(pose)?;
        match self.fov {
            Some(degrees) => Ok(camera.with_rectangle(camera.rectangle().with_vertical_fov(degrees.to_radians())?)),
            None => Ok(camera),
        }
    }
}

/// Does something on so many threads; by default on as many as there are cores.
fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let Some(threads) = threads else { return Ok(work()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build();
    pool.map(|pool| pool.install(work)).map_err(|error| Failure::runtime("--threads", error))
}

/// All of it, up to one byte more than a scene may have.
fn read_stdin() -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let limit = termtrace::scene_text::MAX_BYTES as u64 + 1;
    let read = io::stdin().lock().take(limit).read_to_end(&mut bytes);
    read.map(|_| bytes).map_err(|error| Failure::runtime("standard input", reason(&error)))
}

/// `x,y,z`, within what a scene file may say.
fn parse_vec3(text: &str) -> Result<Vec3, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|number| number.trim().parse::<f32>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if [x, y, z].iter().all(|number| number.abs() <= 1e9) => Ok(Vec3::new(x, y, z)),
        _ => Err("expected three numbers from -1e9 to 1e9 with commas between them, such as 0,1.5,6".to_owned()),
    }
}

/// Reads the command line, does what it says, and says what went wrong.
pub(crate) fn main() -> ExitCode {
    termtrace::terminal::hold_panic_messages();
    // Where it cannot be done, such a write ends the process as it would any other.
    let _ = termtrace::terminal::fail_large_writes();
    let (cli, given) = match parse(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(exit) => return exit,
    };
    // What was given to the command, if there is one.
    let given = given.subcommand().map_or(&given, |(_, given)| given);
    let done = match cli.command {
        Some(Command::Frame(Later(args))) => frame::run(&args),
        Some(Command::Record(Later(args))) => record::run(&args),
        Some(Command::Explain(Later(args))) => explain::run(&args),
        Some(Command::Check(Later(args))) => check::run(&args),
        Some(Command::Describe(Later(args))) => describe::run(&args),
        Some(Command::Bench(Later(args))) => bench::run(&args),
        Some(Command::Doctor(_)) => doctor::run(given),
        Some(Command::Config(Later(args))) => config::run(&args, given),
        Some(Command::Completions(Later(args))) => completions::complete(&args),
        Some(Command::Man(Later(args))) => completions::man(&args),
        None => live::run(&cli.live, given),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Said(code)) => ExitCode::from(code),
        Err(Failure::Runtime(message)) => complain(&message, 1),
        Err(Failure::Usage(message)) => complain(&message, 2),
        Err(Failure::Scene(error)) => complain(&error.to_string(), 2),
    }
}

fn parse(arguments: impl Iterator<Item = OsString>) -> Result<(Cli, ArgMatches), ExitCode> {
    let given = Cli::command().try_get_matches_from(arguments);
    given.and_then(|given| Ok((Cli::from_arg_matches(&given)?, given))).map_err(|error| say(&error))
}

/// Prints what clap says of the command line, which it may quote. Help and version are no errors; a closed pipe hides
/// either.
fn say(said: &clap::Error) -> ExitCode {
    let text = visible_lines(&said.render().to_string());
    if said.use_stderr() {
        print_error(&text);
        return ExitCode::from(2);
    }
    let _ = write_stdout(text.as_bytes());
    ExitCode::SUCCESS
}

fn complain(message: &str, code: u8) -> ExitCode {
    print_error(&format!("termtrace: {}\n", visible_lines(message)));
    ExitCode::from(code)
}

/// Prints it if that stops nobody. Where no one listens any more, the exit code says it too.
fn print_error(text: &str) {
    if termtrace::terminal::stderr_is_read() {
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// What the system says went wrong, without its number.
fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let number = error.raw_os_error().map(|number| format!(" (os error {number})"));
    number.and_then(|number| text.strip_suffix(&number)).unwrap_or(&text).to_owned()
}

/// Says what the threads said when they panicked, and ends as a panic does.
fn complain_of_panic() -> ! {
    let messages = termtrace::terminal::take_panic_messages();
    for message in messages {
        print_error(&(visible_lines(&message) + "\n"));
    }
    std::process::exit(101)
}

/// To standard output. A reader that has seen enough (`| head`) is no error.
fn write_stdout(bytes: &[u8]) -> Done {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::runtime("standard output", reason(&error)))
        }
        _ => Ok(()),
    }
}
