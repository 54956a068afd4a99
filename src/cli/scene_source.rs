//! The source of a scene: a file, standard input, or a scene embedded in the program.

use super::outcome::{Failure, reason, usage, warn};
use super::shipped::ShippedScene;
use super::suggestions;
use std::fmt;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::UpAxis;
use termtrace::internals::progress::{Reporter, Unfinished};
use termtrace::internals::scene::Draft;
use termtrace::internals::text::closest;
use termtrace::{LoadError, Map, Scene, SceneError};

/// The source of a scene, which can be loaded repeatedly.
#[derive(Clone)]
pub(super) enum SceneSource {
    File(PathBuf),
    /// The contents of standard input.
    Stdin(Vec<u8>),
    /// A scene embedded in the program.
    Shipped(&'static ShippedScene),
}

impl SceneSource {
    /// Returns the source that a command line argument names. Standard input (`-`) is read here,
    /// before raw mode, because it may be the terminal.
    pub(super) fn from_path(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return read_stdin().map(Self::Stdin);
        }
        // A file takes precedence over a shipped scene of the same name, even a file that cannot be read.
        let shipped = ShippedScene::named(path).filter(|_| path.symlink_metadata().is_err());
        Ok(shipped.map_or_else(|| Self::File(path.to_owned()), Self::Shipped))
    }

    /// Returns the source that an optional command line argument names; the default scene if there
    /// is none.
    pub(super) fn from_argument(path: Option<&Path>) -> Result<Self, Failure> {
        path.map_or_else(|| Ok(Self::Shipped(ShippedScene::default_scene())), Self::from_path)
    }

    /// Loads the scene without building its trees, until the reporter cancels.
    ///
    /// A mesh file is turned so that its axis `up` points up.
    pub(super) fn draft(&self, up: Option<UpAxis>, reporter: &Reporter<'_>) -> Result<Draft, Failure> {
        match self {
            Self::File(path) => Draft::load_turned(path, up, reporter).map_err(|error| not_loaded(path, error)),
            Self::Stdin(text) => Draft::from_bytes("standard input", text, reporter).map_err(wrong),
            Self::Shipped(scene) => {
                Draft::from_embedded(scene.name, scene.text.as_bytes(), scene.meshes, reporter).map_err(wrong)
            }
        }
    }
}

impl fmt::Display for SceneSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.display().fmt(f),
            Self::Stdin(_) => f.write_str("standard input"),
            Self::Shipped(scene) => f.write_str(scene.name),
        }
    }
}

fn wrong(unfinished: Unfinished<SceneError>) -> Failure {
    match unfinished {
        Unfinished::Failed(error) => Failure::Scene(error),
        Unfinished::Cancelled => usage(unfinished),
    }
}

/// Returns the failure of loading a file, with a suggestion if the file does not exist.
fn not_loaded(path: &Path, error: Unfinished<LoadError>) -> Failure {
    if let Unfinished::Failed(LoadError::Scene(error)) = error {
        return Failure::Scene(error);
    }
    // A suggestion is made only if no such file exists: an existing file has been read, and its contents are wrong.
    let meant = if path.exists() { None } else { suggestions::scene_like(path).or_else(|| shipped_like(path)) };
    Failure::Usage(match meant {
        Some(meant) => format!("{error}; did you mean {}?", meant.display()),
        None => error.to_string(),
    })
}

/// Returns the name of the shipped scene that is most similar to `name`, if one is similar.
fn shipped_like(name: &Path) -> Option<PathBuf> {
    closest(name.to_str()?, ShippedScene::names()).map(PathBuf::from)
}

/// Warns of a picture without any light. Maps need none.
pub(super) fn warn_of_darkness(map: Map, scene: &Scene) {
    if let Some(darkness) = scene.darkness().filter(|_| map == Map::Shaded) {
        warn(darkness);
    }
}

/// Reads standard input, up to one byte more than a scene may have. With that byte the scene's
/// parser reports that the input is too large.
fn read_stdin() -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let limit = termtrace::internals::scene_text::MAX_TEXT_BYTES as u64 + 1;
    let read = io::stdin().lock().take(limit).read_to_end(&mut bytes);
    read.map(|_| bytes).map_err(|error| Failure::runtime("standard input", reason(&error)))
}
