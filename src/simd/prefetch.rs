//! Prefetching of values into the cache.

#![allow(unsafe_code)]

/// Size of a cache line in bytes.
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
        // SAFETY: the address lies inside of `value`; the instruction changes nothing that a program could see, and is
        // part of SSE, which every x86-64 CPU has.
        // T0, not NTA: neighbouring rays visit the same nodes soon after.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast::<i8>().add(line)) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
