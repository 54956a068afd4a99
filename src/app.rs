//! The live view on a terminal: a viewer, driven by an event loop (`live`), with threads that trace
//! and load.

use crate::camera::Camera;
use crate::memory::OutOfMemory;
use crate::scene::{LoadError, Scene};
use crate::terminal::{self, Signals, Terminal};
use crate::text::Notice;
/// The viewer's scenario runner, re-exported for the fuzz target in test builds only.
#[cfg(all(unit_tests, feature = "test-hooks"))]
pub use crate::viewer::run_scenario as run_viewer_scenario;
pub use crate::viewer::{MAX_PIXELS, Options};
use std::convert::Infallible;
use std::{fmt, io};

mod picture_export;
mod session_recording;
mod save_view;
mod live;
mod loading;
mod refinements;
mod renderer;
mod large_picture;
mod scenes;
mod source;
mod watching;

use live::Live;
use renderer::Renderer;
#[cfg(feature = "serve")]
pub(crate) use renderer::Tracer;
use scenes::Scenes;
pub use source::Source;

/// The outcome of the live view.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// The reason why the live view ended.
    pub ending: Ending,
    /// The last camera, if the user has moved it.
    pub moved: Option<Camera>,
    /// Whether the terminal accepted all bytes. If not, it has stopped reading, and printing to it
    /// would block.
    pub heard: bool,
}

/// The reason why the live view ended.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The user quit.
    Left,
    /// The signal of this number asked the program to end.
    Signal(i32),
}

/// Shows a scene until the user leaves. The terminal is restored when this returns or panics.
///
/// # Errors
/// If there is no terminal, or it goes away, or there is not enough memory for its window.
///
/// # Panics
/// With the payload of a thread that panicked while tracing.
pub fn run(scene: Scene, options: Options, signals: &mut Signals) -> io::Result<Outcome> {
    let scenes = Scenes::<Infallible>::of_scene(scene, signals)?;
    drive_scenes(scenes, options, signals).map_err(|error| match error {
        Error::Terminal(error) => error,
        Error::Scene(never) => match never {},
    })
}

/// Shows the scenes of these sources, beginning with the first, until the user leaves.
///
/// If loading a scene takes longer than a moment, the view shows its progress, then a sketch to look around in; the
/// user can leave meanwhile. The terminal is restored when this returns or panics. An error in the first scene that is
/// found within that moment is returned without touching the terminal.
///
/// A scene is read again when one of its files changes. Errors of a later load are shown as a [`Notice`] over the last
/// good picture.
///
/// # Errors
/// If there is no source or no terminal, the terminal goes away, there is not enough memory for its window, or the
/// first scene cannot be loaded.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, or while reading or building a scene.
pub fn open<E: Into<Notice> + Send + 'static>(
    sources: Vec<Source<E>>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    let scenes = Scenes::start(sources, options.threads, signals)?;
    drive_scenes(scenes, options, signals)
}

/// The error that kept the live view from starting, or ended it.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error<E = LoadError> {
    /// There is no terminal, it has gone away, or there is not enough memory for its window.
    Terminal(io::Error),
    /// The first scene could not be loaded.
    Scene(E),
}

impl<E> From<io::Error> for Error<E> {
    fn from(error: io::Error) -> Self {
        Self::Terminal(error)
    }
}

impl<E> From<OutOfMemory> for Error<E> {
    fn from(error: OutOfMemory) -> Self {
        Self::Terminal(error.into())
    }
}

impl<E: fmt::Display> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Terminal(error) => write!(f, "terminal: {error}"),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for Error<E> {}

fn drive_scenes<E: Into<Notice> + Send + 'static>(
    mut scenes: Scenes<E>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    // `live`, below, is declared last and therefore dropped first: the terminal is restored even if dropping the
    // renderer or the scenes blocks or panics.
    let waker = signals.waker()?;
    let mut renderer = terminal::without_signals(|| Renderer::start(options.threads, waker))?;
    // A load error that is found before the viewer takes over the terminal is printed in the shell, where it stays
    // readable.
    scenes.wait().map_err(Error::Scene)?;
    let killed = |signal| Outcome { ending: Ending::Signal(signal), moved: None, heard: true };
    if let Some(signal) = signals.deadly() {
        return Ok(killed(signal));
    }
    let terminal = match Terminal::take(signals) {
        Ok(terminal) => terminal,
        // A signal may have arrived while `take` waited for the foreground.
        Err(error) => return signals.deadly().map(killed).ok_or(Error::Terminal(error)),
    };
    let mut live = Live::new(terminal, options, scenes.names())?;
    let ended = live.drive(&mut renderer, &mut scenes, signals);
    let ending = ended.or_else(|error| match error {
        // If the terminal has vanished, there is also a signal (SIGHUP), which is the more precise reason.
        Error::Terminal(error) => signals.deadly().map(Ending::Signal).ok_or(Error::Terminal(error)),
        fault @ Error::Scene(_) => Err(fault),
    })?;
    let heard = live.restore();
    Ok(Outcome { ending, moved: live.moved_camera(), heard })
}
