//! Any bytes as a file of keys: a table that can be written and read again, or printable faults.

#![no_main]
#![allow(dead_code, reason = "the other targets ask for more of this module")]

#[path = "../../tests/text_laws/mod.rs"]
mod text_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| text_laws::keys(bytes));
