//! Frames over time -> a film: asciicast or GIF.
//!
//! Each frame is written as it comes; no film is ever held whole. A film is a pure function of its frames: nothing of
//! the clock and nothing of the environment is in it.

mod cast;
mod gif;

pub use cast::Cast;
pub use gif::{Gif, gif_size};
