//! Any grids, any pen, any damage: terminals show what is wanted.

#![no_main]
#![allow(dead_code, reason = "the tests ask for more of these modules")]

#[path = "../../tests/encoder/fuzzed.rs"]
mod fuzzed;
#[path = "../../tests/encoder/grids.rs"]
mod grids;
#[path = "../../tests/encoder/near.rs"]
mod near;
#[path = "../../tests/encoder/screens.rs"]
mod screens;
#[path = "../../tests/encoder/watched.rs"]
mod watched;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzzed::hold_for(data));
