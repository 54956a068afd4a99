//! `termtrace new FILE`: writes a commented starter scene, or one of a formula, and views it.

use super::live::{Opening, ViewArgs, live_source, open_view};
use super::outcome::{CommandResult, Failure, reason, write_stdout};
use super::scene_args::CameraArgs;
use super::scene_source::{SceneSource, warn_of_invisibility};
use clap::{ArgMatches, Args};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use termtrace::Map;
use termtrace::internals::mesh_file::is_mesh;
use termtrace::internals::output_file::OutputFile;
use termtrace::internals::text::visible;

/// The contents of the new scene file.
const STARTER: &str = include_str!("starter.ron");

/// The contents of a scene file for a formula, which replaces the word FORMULA in it.
const AROUND_FORMULA: &str = include_str!("formula.ron");

const EXAMPLES: &str = "\
The file must not exist yet. It is opened if standard output is a terminal:
edit it in another window, and each save is shown at once.

With --formula the scene is the surface on which a formula in x, y and z is 0, in
a cube of half side 2. Without FILE it is shown only, or else printed.

Examples:
  termtrace new my.ron
  termtrace new --formula 'x^4 + y^4 + z^4 - 1'
  termtrace new ball.ron --formula 'r = 1 + sin(5*time)/9'";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct NewArgs {
    /// The scene file to write
    #[arg(value_name = "FILE", required_unless_present = "formula")]
    file: Option<PathBuf>,
    /// Formula of a surface, instead of the starter scene
    #[arg(long, value_name = "F", allow_hyphen_values = true)]
    formula: Option<String>,
    #[command(flatten)]
    view: ViewArgs,
}

/// Writes the new scene file, if any, and opens the scene if standard output is a terminal.
pub(super) fn run(args: &NewArgs, given: &ArgMatches) -> CommandResult {
    let is_live = io::stdout().is_terminal();
    // Checked before the file is written, so that a faulty formula leaves none.
    let text = match &args.formula {
        Some(formula) => checked_scene(formula, is_live)?,
        None => STARTER.to_owned(),
    };
    if let Some(path) = &args.file {
        refuse_mesh(path)?;
        write_new(path, &text)?;
    }
    if is_live {
        let scene = args.file.clone().map_or(SceneSource::Formula(text), SceneSource::File);
        let source = || Ok(vec![live_source(scene.clone(), &CameraArgs::default())]);
        return open_view(&args.view, given, Opening::Scenes, None, source);
    }
    let Some(path) = &args.file else { return write_stdout(text.as_bytes()) };
    let name = visible(&path.to_string_lossy());
    write_stdout(format!("written: {name}; termtrace {name} opens it\n").as_bytes())
}

/// Returns the text of a scene with the surface of a formula.
///
/// Warns of a formula without a surface, unless the live view will.
fn checked_scene(formula: &str, is_live: bool) -> Result<String, Failure> {
    // Only a raw string can have several lines. It ends at a quote with as many # as it begins with.
    let is_plain = !formula.contains(['"', '\\', '\n']);
    let raw = || format!("r{0}\"{formula}\"{0}", "#".repeat(formula.matches('#').count() + 1));
    let quoted = if is_plain { format!("\"{formula}\"") } else { raw() };
    let text = AROUND_FORMULA.replace("\"FORMULA\"", &quoted);
    let scene = CameraArgs::default().load_scene(&SceneSource::Formula(text.clone()))?;
    if !is_live {
        warn_of_invisibility(Map::Shaded, &scene);
    }
    Ok(text)
}

fn refuse_mesh(path: &Path) -> CommandResult {
    if !is_mesh(&path.to_string_lossy(), &[]) {
        return Ok(());
    }
    let (name, path) = (path.with_extension("ron"), path.display());
    let name = name.display();
    Err(Failure::Usage(format!("{path}: this name is one of a mesh; a scene is a text file such as {name}")))
}

fn write_new(path: &Path, text: &str) -> CommandResult {
    let written = OutputFile::create_new(path).and_then(|mut file| {
        file.remove_stale();
        file.write_all(text.as_bytes())?;
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
