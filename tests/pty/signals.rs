//! Signal dispositions and masks that children inherit.

use std::sync::{Arc, Once, atomic::AtomicBool};

use nix::sys::signal::SigSet;
use signal_hook::consts::FORBIDDEN;

/// The numbers of the standard signals.
const STANDARD: std::ops::RangeInclusive<i32> = 1..=31;

/// Gives children that this thread starts from now on default dispositions and an empty signal
/// mask.
///
/// The process that runs the tests may have inherited others: a shell without job control ignores SIGINT and SIGQUIT
/// for what it starts with `&`, and `nohup` ignores SIGHUP.
///
/// Setting a disposition to the default would need `unsafe`. A handler does not: `exec` resets a caught signal to its
/// default, and keeps only ignored ones. The handlers do nothing, as the signals did when they were ignored.
pub(crate) fn reset_for_children() {
    static CAUGHT: Once = Once::new();
    CAUGHT.call_once(|| {
        for signal in ignored().filter(|signal| !FORBIDDEN.contains(signal)) {
            let caught = signal_hook::flag::register(signal, Arc::new(AtomicBool::new(false)));
            caught.unwrap_or_else(|error| panic!("signal {signal} cannot be caught: {error}"));
        }
    });
    SigSet::empty().thread_set_mask().expect("a thread may receive every signal");
}

/// Returns the ignored signals. Only Linux reports them.
fn ignored() -> impl Iterator<Item = i32> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).expect("the mask is hexadecimal"));
    STANDARD.filter(move |signal| mask >> (signal - 1) & 1 == 1)
}
