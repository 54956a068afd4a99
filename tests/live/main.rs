//! The live view on a real pseudo-terminal: keys and signals in, bytes and an exit status out.

mod captions;
mod explaining;
mod files;
#[path = "../gravel/mod.rs"]
mod gravel;
mod harness;
mod hint;
mod keyboard;
mod leaving;
mod lights;
mod loading;
mod maps;
#[path = "../mesh_writers/mod.rs"]
mod mesh_writers;
mod meshes;
mod mouse;
mod moving;
mod orbit;
mod paths;
mod playing;
#[path = "../pty/mod.rs"]
mod pty;
mod queries;
mod reduced_motion;
mod refining;
mod scenes;
mod settings;
mod signals;
mod windows;
