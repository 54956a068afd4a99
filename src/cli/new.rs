//! `termtrace new FILE`: writes a commented starter scene and views it.

use super::live::{Occasion, ViewArgs, live_source, open_view};
use super::outcome::{CommandResult, Failure, reason, write_stdout};
use super::scene_args::CameraArgs;
use super::scene_source::SceneSource;
use clap::{ArgMatches, Args};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::is_mesh;
use termtrace::internals::output_file::OutputFile;
use termtrace::internals::text::visible;

/// The contents of the new scene file.
const STARTER: &str = include_str!("starter.ron");

const EXAMPLES: &str = "\
The file must not exist yet. It is opened if standard output is a terminal:
edit it in another window, and each save is shown at once.

Examples:
  termtrace new my.ron";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct NewArgs {
    /// The scene file to write
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    view: ViewArgs,
}

/// Writes the new scene file, and opens it if standard output is a terminal.
pub(super) fn run(args: &NewArgs, given: &ArgMatches) -> CommandResult {
    let path = &args.file;
    if is_mesh(&path.to_string_lossy(), &[]) {
        let name = path.with_extension("ron");
        return Err(Failure::Usage(format!(
            "{}: this name is one of a mesh; a scene is a text file such as {}",
            path.display(),
            name.display()
        )));
    }
    write(path)?;
    if !io::stdout().is_terminal() {
        let name = visible(&path.to_string_lossy());
        return write_stdout(format!("written: {name}; termtrace {name} opens it\n").as_bytes());
    }
    let source = || Ok(vec![live_source(SceneSource::File(path.clone()), &CameraArgs::default())]);
    open_view(&args.view, given, Occasion::Scenes, None, source)
}

fn write(path: &Path) -> CommandResult {
    let written = OutputFile::create_new(path).and_then(|mut file| {
        file.remove_stale();
        file.write_all(STARTER.as_bytes())?;
        file.finish()
    });
    written.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => Failure::Runtime(format!(
            "{0}: this file exists and is left as it is; choose another name, or open it: termtrace {0}",
            path.display()
        )),
        _ => Failure::runtime(path.display(), reason(&error)),
    })
}
