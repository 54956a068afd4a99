//! Any bytes as a formula: a surface that can be traced, or a fault that can be shown.

#![no_main]
#![allow(dead_code, reason = "the other targets ask for more of this module")]

#[path = "../../tests/text_laws/mod.rs"]
mod text_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| text_laws::formula(bytes));
