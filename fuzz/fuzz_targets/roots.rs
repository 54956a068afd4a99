//! Any formula along any rays: all kernels find the same roots, at which the sign changes.

#![no_main]
#![allow(dead_code, reason = "the other targets ask for more of this module")]

#[path = "../../tests/text_laws/mod.rs"]
mod text_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| text_laws::roots(bytes));
