//! Any bytes as a story of keys, replies, sizes, scenes, frames and time: the rules of `viewer::story` hold throughout.

#![no_main]

libfuzzer_sys::fuzz_target!(|story: &[u8]| termtrace::internals::app::tell_viewer(story));
