//! Any bytes: a scene, or faults that each lie inside the text and can be printed on a terminal.

#![no_main]
#![allow(dead_code, reason = "the other targets ask for more of this module")]

#[path = "../../tests/text_laws/mod.rs"]
mod text_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| text_laws::scene(bytes));
