//! The live view: a scene on the terminal, with keys and mouse, until the user leaves.

pub use crate::app::{Ending, Error, Options, Outcome, Source, open, run};
pub use crate::terminal::Signals;
