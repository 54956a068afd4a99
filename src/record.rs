//! Frames over time -> a film: asciicast or GIF.
//!
//! Each frame is written as it comes; no film is ever held whole. A film is a pure function of its frames: nothing of
//! the clock and nothing of the environment is in it.

#[cfg(feature = "cast")]
mod cast;
#[cfg(feature = "gif")]
mod gif;

#[cfg(feature = "cast")]
pub use cast::Cast;
#[cfg(feature = "gif")]
pub use gif::{Gif, gif_size};
