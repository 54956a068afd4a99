//! Any bytes as a session of keys, replies, sizes, scenes, frames and time.
//!
//! The rules of `viewer::story` hold throughout.

#![no_main]

libfuzzer_sys::fuzz_target!(|scenario: &[u8]| termtrace::internals::app::run_viewer_scenario(scenario));
