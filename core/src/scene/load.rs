//! Loading of scenes and camera paths from files, bytes and text.

use super::caption::leading_comment;
use super::side_files::SceneSideFiles;
use super::{Draft, MeshOrigin, Scene, checked};
use crate::camera::Camera;
use crate::camera_path::CameraPath;
use crate::memory;
use crate::mesh_file::{self, MeshError, MeshFile, UpAxis};
use crate::named_file::{self, Accepted};
use crate::progress::{Progress, Reporter, Unfinished};
use crate::scene_file::{PathFile, SceneFile};
use crate::scene_text::{MAX_TEXT_BYTES, SceneError, read, read_or_cancel, text_from};
use crate::text::{Notice, visible};
use std::fmt;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

impl Scene {
    /// Parses a scene from text in RON.
    ///
    /// `name` is the path of the file for messages, and mesh files are looked up in its folder.
    ///
    /// ```
    /// use termtrace::Scene;
    ///
    /// let text = r#"(
    ///     camera: (eye: (0, 0, 5), target: (0, 0, 0)),
    ///     lights: [Point(position: (3, 4, 5), intensity: 40)],
    ///     objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse("tomato"))],
    /// )"#;
    /// let scene = Scene::from_ron("ball.ron", text)?;
    /// assert_eq!(scene.objects().len(), 1);
    ///
    /// let error = Scene::from_ron("ball.ron", &text.replace("radius", "radus")).unwrap_err();
    /// assert!(error.to_string().starts_with(r#"ball.ron:4:41: unknown field "radus"; did you mean "radius"?"#));
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// The first fault of the syntax; if there is none, all others: unknown and missing fields, wrong types, and values
    /// out of range.
    pub fn from_ron(name: &str, text: &str) -> Result<Self, SceneError> {
        parse_draft(name, text, &[], &Reporter::silent()).map(Draft::finish).map_err(Unfinished::failure)
    }

    /// Parses a scene from a file's bytes, which should be UTF-8 text.
    ///
    /// ```
    /// use termtrace::Scene;
    ///
    /// let error = Scene::from_bytes("photo.png", b"\x89PNG\r\n\x1a\n\0\0").unwrap_err();
    /// assert!(error.to_string().contains("not a format termtrace reads"));
    /// ```
    ///
    /// # Errors
    /// As [`Scene::from_ron`], and for bytes that are not text.
    #[doc(hidden)]
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, SceneError> {
        Self::from_ron(name, text_from(name, bytes)?)
    }

    /// Loads a scene file, or a mesh file with lights, a floor and a view of the whole mesh.
    ///
    /// The lights are those of the mesh file, or default ones if it has none.
    ///
    /// ```standalone_crate
    /// use std::path::Path;
    /// use termtrace::Scene;
    ///
    /// # std::env::set_current_dir("..").expect("the folder of the workspace");
    /// let scene = Scene::load(Path::new("scenes/three_spheres.ron"))?;
    /// assert_eq!(scene.objects().len(), 4);
    /// # Ok::<(), termtrace::LoadError>(())
    /// ```
    ///
    /// # Errors
    /// If the file cannot be read, is not a mesh or UTF-8 text, or has faults.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        load(path, None, &Reporter::silent()).map(Draft::finish).map_err(Unfinished::failure)
    }

    /// Loads as [`Scene::load`] does and reports progress to `on_progress`, from any thread.
    ///
    /// Loading is cancelled when `on_progress` returns `Break`.
    ///
    /// ```standalone_crate
    /// use std::{ops::ControlFlow, path::Path};
    /// use termtrace::{LoadError, Scene, Unfinished};
    ///
    /// # std::env::set_current_dir("..").expect("the folder of the workspace");
    /// let path = Path::new("scenes/teapot.obj");
    /// let scene = Scene::load_watched(path, |_| ControlFlow::Continue(()))?;
    /// let cancelled = Scene::load_watched(path, |_| ControlFlow::Break(()));
    /// assert!(matches!(cancelled, Err(Unfinished::Cancelled)));
    /// # Ok::<(), Unfinished<LoadError>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::load`], and [`Unfinished::Cancelled`] if the work was cancelled.
    pub fn load_watched(
        path: &Path,
        on_progress: impl Fn(Progress) -> ControlFlow<()> + Sync,
    ) -> Result<Self, Unfinished<LoadError>> {
        let reporter = Reporter::new(&on_progress);
        Ok(Draft::load(path, &reporter)?.build_or_cancel(&reporter)?)
    }
}

impl Draft {
    /// Reads as [`Scene::from_bytes`] does, without building trees, unless the reporter cancels it.
    ///
    /// # Errors
    /// As [`Scene::from_bytes`], and if the reporter cancels.
    pub fn from_bytes(name: &str, bytes: &[u8], reporter: &Reporter<'_>) -> Result<Self, Unfinished<SceneError>> {
        Self::from_embedded(name, bytes, &[], reporter)
    }

    /// Reads as [`Draft::from_bytes`] does, with the files that the scene names from memory.
    ///
    /// `files` are their names and bytes.
    ///
    /// # Errors
    /// As [`Scene::from_bytes`], and if the reporter cancels.
    pub fn from_embedded(
        name: &str,
        bytes: &[u8],
        files: &[(&str, &[u8])],
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<SceneError>> {
        parse_draft(name, text_from(name, bytes).map_err(Unfinished::Failed)?, files, reporter)
    }

    /// Reads as [`Scene::load`] does, without building trees, unless the reporter cancels it.
    ///
    /// # Errors
    /// As [`Scene::load`], and if the reporter cancels.
    pub fn load(path: &Path, reporter: &Reporter<'_>) -> Result<Self, Unfinished<LoadError>> {
        Self::load_turned(path, None, reporter)
    }

    /// Reads the bytes of a mesh as [`Draft::load_turned`] does. `name` is used in messages.
    ///
    /// The content decides the format, unless `stated`, a file extension, names another format. Side files are read
    /// from the working directory.
    ///
    /// # Errors
    /// As [`Draft::load`].
    pub fn from_mesh_bytes(
        name: &str,
        stated: Option<&str>,
        bytes: &[u8],
        up: Option<UpAxis>,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<LoadError>> {
        draft_around_mesh(Path::new(name), stated, bytes, up, reporter)
    }

    /// Loads as [`Draft::load`] does, with a mesh turned so that the axis `up` points up.
    ///
    /// If `up` is `None`, it is the axis that the format defines, or else a guess.
    ///
    /// # Errors
    /// As [`Draft::load`].
    pub fn load_turned(
        path: &Path,
        up: Option<UpAxis>,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<LoadError>> {
        // If the reporter is cancelled, a read may end with another error: waiting for a pipe, for example, fails.
        load(path, up, reporter)
            .map_err(|unfinished| if reporter.is_cancelled() { Unfinished::Cancelled } else { unfinished })
    }
}

/// Loads a scene file or a mesh file, which are told apart by the file's name and first bytes.
fn load(path: &Path, up: Option<UpAxis>, reporter: &Reporter<'_>) -> Result<Draft, Unfinished<LoadError>> {
    let name = path.to_string_lossy();
    reporter.report_dependency(path);
    let is_mesh = |bytes: &[u8]| mesh_file::is_mesh(&name, bytes);
    // The limit depends on the kind of file, which is known after the first bytes.
    let max_bytes = |bytes: &[u8]| if is_mesh(bytes) { mesh_file::MAX_MESH_BYTES } else { MAX_TEXT_BYTES };
    let bytes = read_bytes(path, max_bytes, reporter)?;
    if is_mesh(&bytes) {
        return draft_around_mesh(path, None, &bytes, up, reporter);
    }
    // Without this check, a failed allocation would abort the process and leave the terminal in raw mode.
    memory::check(bytes.len() * PEAK_PER_TEXT_BYTE)
        .map_err(|error| LoadError::CannotRead { path: path.to_owned(), error: error.into() })?;
    let text = text_from(&name, &bytes).map_err(LoadError::Scene)?;
    parse_draft(&name, text, &[], reporter).map_err(|unfinished| unfinished.map(LoadError::Scene))
}

/// The example scene, a lit ball, in the error about an empty file.
const SMALLEST_SCENE: &str = "scene that shows something is (camera: (eye: (0, 0, 5), target: (0, 0, 0)), \
                              ambient: 0.1, lights: [Point(position: (3, 4, 5), intensity: 40)], \
                              objects: [Sphere(center: (0, 0, 0), radius: 1)])";

fn parse_draft(
    name: &str,
    text: &str,
    embedded: &[(&str, &[u8])],
    reporter: &Reporter<'_>,
) -> Result<Draft, Unfinished<SceneError>> {
    let mut side_files = SceneSideFiles::in_folder_of(Path::new(name), embedded, reporter);
    read_or_cancel(name, text, SMALLEST_SCENE, reporter, |root, faults| {
        let mut file = SceneFile::read(&root, reporter, faults);
        file.caption = file.caption.or_else(|| leading_comment(text));
        // Freeing the tree before the checks lowers the peak for 400,000 spheres from 462 to 394 MB.
        drop(root);
        checked::check(&file, &mut side_files, reporter, faults)
    })
}

impl CameraPath {
    /// Parses a camera path from text in RON.
    ///
    /// A keyframe without `up` or a field of view takes it from `default_camera`. `name` is used in messages only.
    ///
    /// ```
    /// use termtrace::{CameraPath, Scene};
    ///
    /// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
    /// let text = "(keyframes: [
    ///     (time: 0, eye: (0, 0, 5), target: (0, 0, 0)),
    ///     (time: 2, eye: (4, 1, 5), target: (0, 0, 0), vertical_fov: 30),
    /// ])";
    /// let path = CameraPath::from_ron("flight.ron", text, scene.camera())?;
    /// assert_eq!(path.camera_at(1.0).unwrap().pose().eye, glam::Vec3::new(2.0, 0.5, 5.0));
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::from_ron`], and for times that do not increase.
    #[doc(hidden)]
    pub fn from_ron(name: &str, text: &str, default_camera: &Camera) -> Result<Self, SceneError> {
        let smallest = "camera path is (keyframes: [(time: 0, eye: (0, 0, 5), target: (0, 0, 0))])";
        read(name, text, smallest, |root, faults| {
            checked::path::check(&PathFile::read(root, faults), default_camera, faults)
        })
    }

    /// Parses a camera path from a file's bytes, which should be UTF-8 text.
    ///
    /// # Errors
    /// As [`CameraPath::from_ron`], and for bytes that are not text.
    #[doc(hidden)]
    pub fn from_bytes(name: &str, bytes: &[u8], default_camera: &Camera) -> Result<Self, SceneError> {
        Self::from_ron(name, text_from(name, bytes)?, default_camera)
    }

    /// Loads a camera path file.
    ///
    /// A keyframe without `up` or a field of view takes it from `default_camera`.
    ///
    /// ```standalone_crate
    /// use std::path::Path;
    /// use termtrace::{CameraPath, Scene};
    ///
    /// # std::env::set_current_dir("..").expect("the folder of the workspace");
    /// let scene = Scene::load(Path::new("scenes/many_spheres.ron"))?;
    /// let path = CameraPath::load(Path::new("scenes/paths/among_the_spheres.ron"), scene.camera())?;
    /// assert_ne!(path.camera_at(1.0)?.pose(), path.camera_at(2.0)?.pose());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the file cannot be read, is not UTF-8 text, or has faults.
    pub fn load(path: &Path, default_camera: &Camera) -> Result<Self, LoadError> {
        let bytes = read_bytes(path, |_| MAX_TEXT_BYTES, &Reporter::silent())?;
        Ok(Self::from_bytes(&path.to_string_lossy(), &bytes, default_camera)?)
    }
}

/// The error of loading a scene or a camera path. Its message names the file.
///
/// ```
/// use std::path::Path;
/// use termtrace::{LoadError, Scene};
///
/// let error = Scene::load(Path::new("missing.ron")).expect_err("there is no such file");
/// assert!(matches!(error, LoadError::CannotRead { .. }));
/// assert_eq!(error.to_string(), "missing.ron: there is no such file");
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// The file could not be read.
    CannotRead {
        /// The path of the file.
        path: PathBuf,
        /// The error of the system.
        error: io::Error,
    },
    /// The text is not a scene or camera path.
    Scene(SceneError),
    /// The file is not a mesh that can be read.
    Mesh(MeshError),
    /// The mesh is too small, or too far from the origin, to be shown.
    Unseen {
        /// The path of the file.
        path: PathBuf,
    },
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CannotRead { path, error } => {
                write!(f, "{}: {}", visible(&path.to_string_lossy()), named_file::reason(error))
            }
            Self::Scene(error) => error.fmt(f),
            Self::Mesh(error) => error.fmt(f),
            Self::Unseen { path } => {
                let path = visible(&path.to_string_lossy());
                write!(
                    f,
                    "{path}: this mesh has no size, is too small for its distance from the origin, or reaches beyond \
                     ±1e9; a scene with Mesh(path: ..., scale: ..., translate: ...) can scale and move it"
                )
            }
        }
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::CannotRead { error, .. } => Some(error),
            Self::Scene(_) | Self::Mesh(_) | Self::Unseen { .. } => None,
        }
    }
}

impl From<MeshError> for LoadError {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}

impl From<LoadError> for Notice {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Scene(error) => error.notice(),
            error => error.to_string().into(),
        }
    }
}

impl From<LoadError> for Unfinished<LoadError> {
    fn from(error: LoadError) -> Self {
        Self::Failed(error)
    }
}

impl From<SceneError> for LoadError {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

/// Returns the default scene with the mesh of a mesh file, whose contents are `bytes`, turned so
/// that its axis `up` points up.
fn draft_around_mesh(
    path: &Path,
    stated: Option<&str>,
    bytes: &[u8],
    up: Option<UpAxis>,
    reporter: &Reporter<'_>,
) -> Result<Draft, Unfinished<LoadError>> {
    let mesh =
        MeshFile::of_file(path, stated, bytes, reporter).map_err(|unfinished| unfinished.map(LoadError::Mesh))?;
    let format = mesh_file::format_name(&path.to_string_lossy(), stated, bytes);
    // STL and PLY files do not say which axis points up. Most STL files come from programs for mechanical parts, in
    // which +z points up.
    let usual = match format {
        "STL" => Some(UpAxis::Z),
        "PLY" => Some(UpAxis::Y),
        _ => None,
    };
    let guess = usual.filter(|_| up.is_none()).map(|usual| mesh_file::guessed(&mesh, usual, reporter.is_parallel()));
    let up = up.or(guess).unwrap_or_default();
    let origin = MeshOrigin { format, up, is_guess: guess.is_some(), has_lights: false };
    let camera_count = mesh.staging().cameras.len();
    let draft = Draft::around_mesh(mesh, origin).ok_or_else(|| LoadError::Unseen { path: path.to_owned() })?;
    let unshown = camera_count - draft.checked.views.len();
    if unshown > 0 {
        let plural = if unshown == 1 { "" } else { "s" };
        let notice = || format!("{}: not shown: {unshown} camera{plural} (out of range)", path.display());
        reporter.notify_if_possible(|| visible(&notice()));
    }
    Ok(draft)
}

/// The largest memory in bytes per byte of a scene file, including the trees of its objects.
// A scene of 300,000 spheres takes 26 bytes of memory for each byte of its file.
const PEAK_PER_TEXT_BYTE: usize = 32;

/// Reads the bytes of a file named by the user.
fn read_bytes(path: &Path, max_bytes: impl Fn(&[u8]) -> usize, reporter: &Reporter<'_>) -> Result<Vec<u8>, LoadError> {
    named_file::read(path, Accepted::FilesAndPipes, max_bytes, reporter)
        .map_err(|error| LoadError::CannotRead { path: path.to_owned(), error })
}
