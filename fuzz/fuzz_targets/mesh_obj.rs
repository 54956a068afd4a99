//! Any bytes as OBJ, with MTL and a texture behind a NUL each: a valid mesh, or a printable error.

#![no_main]
#![allow(dead_code, reason = "the tests ask for more of this module")]

#[path = "../../tests/mesh_laws/mod.rs"]
mod mesh_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| mesh_laws::hold_for("x.obj", bytes));
