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

/// Shows the scenes of these sources, beginning with the first, until the user leaves.
///
/// If loading a scene takes longer than a moment, the view shows its progress, then a sketch to look around in; the
/// user can leave meanwhile. The terminal is restored when this returns or panics. An error in the first scene that is
/// found within that moment is returned without touching the terminal.
///
/// A scene is read again when one of its files changes. Errors of a later load are shown over the last good picture.
///
/// # Errors
/// If there is no source or no terminal, the terminal goes away, there is not enough memory for its window, or the
/// first scene cannot be loaded.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, reading or building.
pub fn open(
    sources: Vec<Source<LoadError>>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<LoadError>> {
    app::open(sources, options, signals)
}
