//! The live view: how it is wanted, how it is run, how it ended. `live` is the loop.

use crate::camera::Camera;
use crate::memory::OutOfMemory;
use crate::scene::{LoadError, Scene};
use crate::terminal::{self, Signals, Terminal};
use crate::text::Notice;
/// For the fuzz target: no build that is not a test has it.
#[cfg(feature = "test-hooks")]
pub use crate::viewer::tell as tell_viewer;
pub use crate::viewer::{MAX_PIXELS, Options};
use std::convert::Infallible;
use std::{fmt, io};

mod exporting;
mod keeping;
mod live;
mod loading;
mod renderer;
mod scenes;
mod source;
mod watching;

use live::Live;
use renderer::Renderer;
use scenes::Scenes;
pub use source::Source;

/// How the live view ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// Why.
    pub ending: Ending,
    /// Where the user had moved the camera, if he had.
    pub moved: Option<Camera>,
    /// Whether the terminal still takes what is written. One that has stopped reading would stop whoever says more.
    pub heard: bool,
}

/// Why the live view ended.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The user left.
    Left,
    /// A signal asked for it.
    Signal(i32),
}

/// Shows the scene until the user leaves. The terminal is as it was when this returns, and also when it panics.
///
/// # Errors
/// If there is no terminal, or it goes away, or there is not enough memory for its window.
///
/// # Panics
/// With the payload of a thread that panicked while tracing.
pub fn run(scene: Scene, options: Options, signals: &mut Signals) -> io::Result<Outcome> {
    let scenes = Scenes::<Infallible>::done(scene, signals)?;
    view(scenes, options, signals).map_err(|error| match error {
        Error::Terminal(error) => error,
        Error::Scene(never) => match never {},
    })
}

/// Shows the scene of the first source until the user leaves, or goes to the next one. What takes longer than a moment
/// shows how far it is, then a sketch to look around in, and can be left at any time. The terminal is as it was when this
/// returns, and also when it panics; a first scene that is wrong at once never touches it.
///
/// A scene is read again when one of its files changes. What is wrong with it then is told as a [`Notice`], and with any
/// but the first; the picture stays as it was.
///
/// # Errors
/// If there is no source or no terminal, or that goes away, or there is not enough memory for its window; or what is wrong
/// with the first scene.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, or while reading or building a scene.
pub fn open<E: Into<Notice> + Send + 'static>(
    sources: Vec<Source<E>>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    let scenes = Scenes::start(sources, options.threads, signals)?;
    view(scenes, options, signals)
}

/// Why there was nothing to see, or nothing more.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error<E = LoadError> {
    /// There is no terminal, or it has gone away, or there is not enough memory for its window.
    Terminal(io::Error),
    /// What is wrong with the scene.
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

fn view<E: Into<Notice> + Send + 'static>(
    mut scenes: Scenes<E>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    // The terminal is declared last, and so is given back first: nothing that comes after can keep it.
    let waker = signals.waker()?;
    let mut renderer = terminal::without_signals(|| Renderer::start(options.threads, waker))?;
    scenes.wait().map_err(Error::Scene)?;
    let killed = |signal| Outcome { ending: Ending::Signal(signal), moved: None, heard: true };
    if let Some(signal) = signals.deadly() {
        return Ok(killed(signal));
    }
    let terminal = match Terminal::take(signals) {
        Ok(terminal) => terminal,
        // Perhaps while it waited to be brought to the foreground.
        Err(error) => return signals.deadly().map(killed).ok_or(Error::Terminal(error)),
    };
    let mut live = Live::new(terminal, options, scenes.named())?;
    let ended = live.run(&mut renderer, &mut scenes, signals);
    let ending = ended.or_else(|error| match error {
        // When the terminal vanishes, the system says so by a signal too.
        Error::Terminal(error) => signals.deadly().map(Ending::Signal).ok_or(Error::Terminal(error)),
        fault @ Error::Scene(_) => Err(fault),
    })?;
    let heard = live.restore();
    Ok(Outcome { ending, moved: live.moved(), heard })
}
