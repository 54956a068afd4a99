//! The live view: how it is wanted, how it is run, how it ended. `live` is the loop.

use crate::camera::Camera;
use crate::capabilities::Hints;
use crate::control::{Bindings, Pace};
use crate::encode::{Order, Quality};
use crate::render::Sampling;
use crate::scene::Scene;
use crate::terminal::{self, Signals, Terminal};
use crate::view::View;
use std::convert::Infallible;
use std::path::PathBuf;
use std::{fmt, io};

mod effort;
mod dialog;
mod exporting;
mod explain;
mod extent;
mod eye;
mod help;
mod keeping;
mod legend;
mod live;
mod mark;
mod loading;
mod panels;
mod renderer;
mod scenes;
mod screen;
mod shown;
mod source;
mod strip;
mod watching;

pub use extent::MAX_PIXELS;
use live::Live;
use renderer::Renderer;
use scenes::Scenes;
pub use source::Source;

/// How the user wants the live view: made by [`Options::new`], then changed.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// What is wanted and known of the terminal before it is asked.
    pub hints: Hints,
    /// In which order changed cells are sent; `None`: row by row, which takes the least time, and by colour, which takes
    /// the fewest bytes, while the link is slow.
    pub order: Option<Order>,
    /// How near a moving picture is to the wanted one; `None`: exact, and equal while the link is slow.
    pub quality: Option<Quality>,
    /// The most bytes a second that are sent in the mean; `None`: as many as the link takes.
    pub max_rate: Option<u32>,
    /// The most frames a second; `None`: 60. A number above zero.
    pub max_frames: Option<f32>,
    /// How finely pictures are traced; `None`: in motion as finely as the time allows, and at rest to the end
    /// ([`Sampling::BEST`]).
    pub sampling: Option<Sampling>,
    /// How many threads trace; `None`: as many as there are cores.
    pub threads: Option<usize>,
    /// How fast keys move and turn the view.
    pub pace: Pace,
    /// Whether each press of a key moves one step at once, and nothing glides or moves by itself.
    pub reduced_motion: bool,
    /// The folder that the user may have the picture written into; `None`: he may not.
    pub exports: Option<PathBuf>,
    /// What is said in the lowest row until the first key.
    pub welcome: Option<String>,
    /// What of the scene is shown at first.
    pub view: View,
    /// What the keys do.
    pub bindings: Bindings,
}

impl Options {
    /// For a terminal of which that is known, on a link that does not compress; the rest as terminal and machine say.
    pub fn new(hints: Hints) -> Self {
        Self {
            hints,
            order: None,
            quality: None,
            max_rate: None,
            max_frames: None,
            sampling: None,
            threads: None,
            pace: Pace::default(),
            reduced_motion: false,
            exports: None,
            welcome: None,
            view: View::Shaded,
            bindings: Bindings::default(),
        }
    }
}

/// How the live view ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Why.
    pub ending: Ending,
    /// Where the user had moved the camera, if he had.
    pub moved: Option<Camera>,
    /// Whether the terminal still takes what is written. One that has stopped reading would stop whoever says more.
    pub heard: bool,
}

/// Why the live view ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
/// A scene is read again when one of its files changes. What is wrong with it then is told, and with any but the first;
/// the picture stays as it was.
///
/// # Errors
/// If there is no source or no terminal, or that goes away, or there is not enough memory for its window; or what is wrong
/// with the first scene.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, or while reading or building a scene.
pub fn open<E: fmt::Display + Send + 'static>(
    sources: Vec<Source<E>>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    let scenes = Scenes::start(sources, options.threads, signals)?;
    view(scenes, options, signals)
}

/// Why there was nothing to see, or nothing more.
#[derive(Debug)]
pub enum Error<E> {
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

impl<E: fmt::Display> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Terminal(error) => write!(f, "terminal: {error}"),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for Error<E> {}

fn view<E: fmt::Display + Send + 'static>(
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
    let mut terminal = match Terminal::take(signals) {
        Ok(terminal) => terminal,
        // Perhaps while it waited to be brought to the foreground.
        Err(error) => return signals.deadly().map(killed).ok_or(Error::Terminal(error)),
    };
    let mut live = Live::new(options, terminal.window()?, scenes.named())?;
    let ended = live.run(&mut terminal, &mut renderer, &mut scenes, signals);
    let ending = ended.or_else(|error| match error {
        // When the terminal vanishes, the system says so by a signal too.
        Error::Terminal(error) => signals.deadly().map(Ending::Signal).ok_or(Error::Terminal(error)),
        fault @ Error::Scene(_) => Err(fault),
    })?;
    let heard = terminal.give_back();
    Ok(Outcome { ending, moved: live.moved(), heard })
}
