//! The live view: scenes on the terminal, with keys and mouse, until the user leaves.
//!
//! ```no_run
//! use std::path::Path;
//! use termtrace::Scene;
//! use termtrace::live::{Ending, Options, Signals, run};
//!
//! let scene = Scene::load(Path::new("scenes/three_spheres.ron"))?;
//! let mut signals = Signals::catch()?;
//! let outcome = run(scene, Options::default(), &mut signals)?;
//! if let Ending::Signal(signal) = outcome.ending {
//!     eprintln!("signal {signal} ended it");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::app;
pub use crate::app::{Ending, Error, Options, Outcome, Source, run};
use crate::scene::LoadError;
pub use crate::terminal::Signals;

/// Shows the scene of the first source until the user leaves, or goes to the next one. What takes longer than a moment
/// shows its progress, then a sketch to look around in, and can be left at any time. The terminal is as it was when this
/// returns, and also when it panics; a first scene that is wrong at once never touches it.
///
/// A scene is read again when one of its files changes. The view shows what is wrong with it then, and with any scene but
/// the first, over the picture, which stays as it was.
///
/// # Errors
/// If there is no source or no terminal, or the terminal goes away, or there is not enough memory for its window; or what is
/// wrong with the first scene.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, or while reading or building a scene.
pub fn open(
    sources: Vec<Source<LoadError>>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<LoadError>> {
    app::open(sources, options, signals)
}
