//! The source of a scene: a file, standard input, or a scene embedded in the program.

use super::outcome::{Failure, reason, usage, warn};
use super::shipped::ShippedScene;
use super::suggestions;
use std::fmt;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::{MAX_MESH_BYTES, UpAxis, format_name, is_mesh};
use termtrace::internals::progress::{Reporter, Unfinished};
use termtrace::internals::scene::Draft;
use termtrace::internals::scene_text::MAX_TEXT_BYTES;
use termtrace::internals::text::closest;
use termtrace::{LoadError, Map, Scene, SceneError};

/// The name of standard input in messages.
const STDIN: &str = "standard input";

/// The name, in messages, of a scene that is made from a formula.
const FORMULA: &str = "formula";

/// The source of a scene, which can be loaded repeatedly.
#[derive(Clone)]
pub(super) enum SceneSource {
    File(PathBuf),
    /// The contents of standard input, and the extension of the mesh format that `--as` states.
    Stdin(Vec<u8>, Option<&'static str>),
    /// A scene embedded in the program.
    Shipped(&'static ShippedScene),
    /// The text of a scene that is made from a formula on the command line.
    Formula(String),
}

impl SceneSource {
    /// Returns the source that a command line argument names. Standard input (`-`) is read here,
    /// before raw mode, because it may be the terminal; `stated` is the format that `--as` states for it.
    pub(super) fn from_path(path: &Path, stated: Option<&'static str>) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return read_stdin(stated).map(|bytes| Self::Stdin(bytes, stated));
        }
        // A file takes precedence over a shipped scene of the same name, even a file that cannot be read.
        let shipped = ShippedScene::named(path).filter(|_| path.symlink_metadata().is_err());
        Ok(shipped.map_or_else(|| Self::File(path.to_owned()), Self::Shipped))
    }

    /// Returns the source that an optional command line argument names; the default scene if there
    /// is none.
    pub(super) fn from_argument(path: Option<&Path>, stated: Option<&'static str>) -> Result<Self, Failure> {
        let default = || Ok(Self::Shipped(ShippedScene::default_scene()));
        path.map_or_else(default, |path| Self::from_path(path, stated))
    }

    /// Returns whether the source is meant to be a mesh: by its name, or on standard input by
    /// `--as` or the bytes.
    pub(super) fn is_mesh(&self) -> bool {
        match self {
            Self::File(path) => is_mesh(&path.to_string_lossy(), &[]),
            Self::Stdin(bytes, stated) => stated.is_some() || !format_name(STDIN, None, bytes).is_empty(),
            Self::Shipped(_) | Self::Formula(_) => false,
        }
    }

    /// Loads the scene without building its trees, until the reporter cancels.
    ///
    /// A mesh file is turned so that its axis `up` points up.
    pub(super) fn load_draft(&self, up: Option<UpAxis>, reporter: &Reporter<'_>) -> Result<Draft, Failure> {
        match self {
            Self::File(path) => Draft::load_turned(path, up, reporter).map_err(|error| not_loaded(path, error)),
            Self::Stdin(bytes, stated) if self.is_mesh() => {
                let draft = Draft::from_mesh_bytes(STDIN, *stated, bytes, up, reporter);
                draft.map_err(usage)
            }
            Self::Stdin(text, _) => Draft::from_bytes(STDIN, text, reporter).map_err(scene_failure),
            Self::Shipped(scene) => {
                Draft::from_embedded(scene.name, scene.text.as_bytes(), scene.files, reporter).map_err(scene_failure)
            }
            Self::Formula(text) => Draft::from_bytes(FORMULA, text.as_bytes(), reporter).map_err(scene_failure),
        }
    }
}

impl fmt::Display for SceneSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.display().fmt(f),
            Self::Stdin(..) => f.write_str(STDIN),
            Self::Shipped(scene) => f.write_str(scene.name),
            Self::Formula(_) => f.write_str(FORMULA),
        }
    }
}

/// Returns the failure of a scene that is wrong, or whose loading was cancelled.
fn scene_failure(unfinished: Unfinished<SceneError>) -> Failure {
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
    // A suggestion is made only if no such file exists: an existing file is the one meant, even if it is wrong or
    // cannot be read.
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

/// Warns of formulas without a surface, and of a shaded picture that is black for lack of light.
///
/// Other maps need no light.
pub(super) fn warn_of_invisibility(map: Map, scene: &Scene) {
    scene.invisible_formula_warnings().iter().for_each(warn);
    if let Some(darkness) = scene.darkness_warning().filter(|_| map == Map::Shaded) {
        warn(darkness);
    }
}

/// Reads standard input, up to one byte more than a scene or mesh may have. With that byte the
/// parser reports that the input is too large.
fn read_stdin(stated: Option<&str>) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let mut stdin = io::stdin().lock();
    let mut read_up_to = |bytes: &mut Vec<u8>, most: usize| {
        let left = (most + 1).saturating_sub(bytes.len()) as u64;
        stdin.by_ref().take(left).read_to_end(bytes).map_err(|error| Failure::runtime(STDIN, reason(&error)))
    };
    read_up_to(&mut bytes, MAX_TEXT_BYTES)?;
    // Only a mesh may be larger than `MAX_TEXT_BYTES`, the limit for the text of a scene.
    if bytes.len() > MAX_TEXT_BYTES && (stated.is_some() || !format_name(STDIN, None, &bytes).is_empty()) {
        read_up_to(&mut bytes, MAX_MESH_BYTES)?;
    }
    Ok(bytes)
}
