//! Any bytes as a texture of any format: a sound mesh, or an error that can be shown.

#![no_main]
#![allow(dead_code, reason = "the tests ask for more of this module")]

#[path = "../../tests/mesh_laws/mod.rs"]
mod mesh_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| mesh_laws::hold_for_texture(bytes));
