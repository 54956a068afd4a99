//! The thread pool in which commands build trees and trace.

use super::outcome::{Failure, reason};
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use std::error::Error;
use std::io;

/// Runs `work` in a pool of `threads` threads, or of one per core if `threads` is `None`.
///
/// # Errors
/// If no thread can be started.
pub(super) fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    if let Some(threads) = threads {
        let pool = ThreadPoolBuilder::new().num_threads(threads.into()).build();
        return pool.map(|pool| pool.install(work)).map_err(|error| not_started("--threads", &error));
    }
    // Rayon would start its global pool on first use, but would panic if that failed. An error without a source means
    // that the pool exists already.
    match ThreadPoolBuilder::new().build_global() {
        Err(error) if error.source().is_some() => Err(not_started("threads", &error)),
        _ => Ok(work()),
    }
}

fn not_started(what: &str, error: &ThreadPoolBuildError) -> Failure {
    let system = error.source().and_then(|error| error.downcast_ref::<io::Error>());
    let why = system.map_or_else(|| error.to_string(), reason);
    Failure::runtime(what, format_args!("no more can be started: {why}"))
}
