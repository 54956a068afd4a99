//! Any bytes, in any split, with any waits given up: the same events, no key invented, none stuck.
#![no_main]

#[path = "../../tests/input_laws/mod.rs"]
mod input_laws;

libfuzzer_sys::fuzz_target!(|data: &[u8]| input_laws::hold_for(data));
