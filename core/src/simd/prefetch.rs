//! Prefetching of values into the cache.

#![allow(unsafe_code)]

/// The size of a cache line in bytes.
#[cfg(target_arch = "x86_64")]
const CACHE_LINE: usize = 64;

/// Starts to load all cache lines of a value into the L1 cache.
///
/// Does nothing on CPUs other than x86-64.
#[inline(always)]
pub fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..size_of::<T>()).step_by(CACHE_LINE) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: the address lies inside `value`. The instruction has no visible effect, and is part of SSE, which
        // every x86-64 CPU has.
        // The hint is T0, not NTA, because neighbouring rays will soon visit the same nodes.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast::<i8>().add(line)) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
