//! Any bytes as a scenario of keys, replies, window sizes, scenes, frames and time.
//!
//! The rules of `viewer::scenario` hold throughout.

#![no_main]

libfuzzer_sys::fuzz_target!(|scenario: &[u8]| termtrace::internals::app::run_viewer_scenario(scenario));
