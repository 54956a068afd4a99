//! Sessions and measurements that are repeated where the machine was too busy for them.

use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind, panic_any, resume_unwind};

/// The most sessions for one that is in time.
const ATTEMPTS: usize = 10;

/// Runs a session again and again until it returns that it was in time, and fails if none is.
///
/// A session that must keep within a limit of the program can be too late on any machine: a virtual one may not
/// schedule a thread for a second. It then returns false, before it asserts what holds only in time.
#[track_caller]
pub(crate) fn until_in_time(session: impl FnMut() -> bool) {
    let in_time = std::iter::repeat_with(session).take(ATTEMPTS).any(|is_in_time| is_in_time);
    assert!(in_time, "no session in time in {ATTEMPTS} attempts");
}

/// The most measurements for one that is within its limits.
const MEASUREMENTS: usize = 3;

/// The panic of a measurement beyond a limit.
struct BeyondLimit;

/// Asserts a limit of a measurement that [`best_of_three`] may repeat.
#[track_caller]
pub(crate) fn within_limit(is_within: bool, told: impl Display) {
    if !is_within {
        eprintln!("{}: beyond a limit: {told}", std::panic::Location::caller());
        panic_any(BeyondLimit);
    }
}

/// Measures until a measurement is within its limits, and fails with the third one beyond them.
///
/// Other work on the machine makes any one of them longer: on a virtual one, threads were not scheduled for a second.
/// Other assertions than [`within_limit`] fail at once.
pub(crate) fn best_of_three(measure: impl Fn()) {
    for attempt in 1.. {
        match catch_unwind(AssertUnwindSafe(&measure)) {
            Ok(()) => return,
            Err(panic) if panic.is::<BeyondLimit>() && attempt < MEASUREMENTS => {}
            Err(panic) => resume_unwind(panic),
        }
    }
}
