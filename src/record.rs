//! Films of frames over time: asciicast and GIF.
//!
//! Each frame is written as it comes; a film is never held in memory. A film is a pure function of its frames: it
//! contains nothing from the clock or the environment.

#[cfg(feature = "cast")]
mod cast;
#[cfg(feature = "gif")]
mod gif;

#[cfg(feature = "cast")]
pub use cast::Cast;
#[cfg(feature = "gif")]
pub use gif::{Gif, gif_size};
