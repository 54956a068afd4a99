//! Films of frames over time: asciicast and GIF.
//!
//! Frames are written as they come, so that a film is never in memory as a whole. A film is a pure function of its
//! frames: its bytes do not depend on the clock or the environment.

#[cfg(feature = "cast")]
mod cast;
#[cfg(feature = "gif")]
mod gif;

#[cfg(feature = "cast")]
pub use cast::Cast;
#[cfg(feature = "live")]
pub(crate) use cast::{write_event, write_header};
#[cfg(feature = "gif")]
pub use gif::Gif;
