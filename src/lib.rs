//! termtrace: a live ray tracer whose screen is the terminal.

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
compile_error!("termtrace runs on Linux and macOS: it talks to the terminal through POSIX termios, poll and signals");

pub mod color;
pub mod ray;
pub mod capabilities;
pub mod scene_text;
pub mod scene_file;
pub mod shape;
pub mod material;
pub mod light;
pub mod camera;
pub mod scene;
pub mod hit;
pub mod shade;
pub mod framebuffer;
pub mod render;
pub mod tone;
pub mod grid;
pub mod cell;
pub mod overlay;
pub mod encode;
pub mod export;
pub mod input;
pub mod terminal;
pub mod control;
pub mod app;
