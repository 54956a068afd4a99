//! Any bytes: a scene, or faults that each lie inside the text and can be printed on a terminal.

#![no_main]

use libfuzzer_sys::fuzz_target;
use termtrace::scene::Scene;

fuzz_target!(|bytes: &[u8]| {
    let Err(error) = Scene::from_bytes("scene.ron", bytes) else {
        return;
    };
    assert!(!error.reports().is_empty());
    let lines = bytes.split(|&byte| byte == b'\n').count();
    for report in error.reports() {
        assert!(report.span.start <= report.span.end && report.span.end as usize <= bytes.len());
        assert!((1..=lines).contains(&report.line) && report.column >= 1 && report.caret_width >= 1);
    }
    assert!(!error.to_string().contains(|c: char| c.is_control() && c != '\n'));
});
