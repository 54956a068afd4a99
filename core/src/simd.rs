//! Vectors of eight numbers in registers, chosen for the CPU at run time.
//!
//! A [`SimdKernel`] is compiled once for each instruction set, and [`dispatch`] selects one by the features of the CPU.
//! Everything that a kernel calls must be `#[inline(always)]`: functions that are not inlined, and closures, are
//! compiled without the kernel's target features. All operations are exactly defined by IEEE 754; none is fused, as FMA
//! rounds differently.
//!
//! Only this module has unsafe code.

#![allow(unsafe_code)]

use crate::lanes::F32x8;

pub use crate::lanes::SimdKernel;
pub use prefetch::prefetch;

/// Runs the kernel with the widest instruction set of this CPU.
#[inline]
pub fn dispatch<K: SimdKernel>(kernel: K) -> K::Output {
    // The standard library caches the detection: it costs a load and a bit test for each kernel.
    #[cfg(all(target_arch = "x86_64", compiler_has_avx512))]
    if has_avx512() {
        // SAFETY: `has_avx512` has checked the CPU.
        return unsafe { avx512::run(kernel) };
    }
    #[cfg(target_arch = "x86_64")]
    return if has_avx2() {
        // SAFETY: `has_avx2` has checked the CPU.
        unsafe { avx2::run(kernel) }
    } else {
        sse2::run(kernel)
    };
    #[cfg(not(target_arch = "x86_64"))]
    run_scalar(kernel)
}

/// Runs the kernel with plain arrays: the reference for the tests of all instruction sets.
#[inline]
pub fn run_scalar<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<F32x8>()
}

#[cfg(target_arch = "x86_64")]
#[inline]
// The kernels also need BMI1, LZCNT and POPCNT, since loops over masks count and clear bits. Every known CPU with AVX2
// has them, but no specification guarantees it.
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

#[cfg(all(target_arch = "x86_64", compiler_has_avx512))]
#[inline]
// The kernels require VL for masks over registers of eight floats, and DQ for moves of eight-bit masks.
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("bmi2")
}

#[cfg(target_arch = "x86_64")]
// `avx` is the part that AVX2 and AVX-512 share; they differ in their masks only.
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx2;
// AVX-512 needs Rust 1.89. The build script checks the compiler's version, and this attribute tells it to clippy.
#[cfg(all(target_arch = "x86_64", compiler_has_avx512))]
#[clippy::msrv = "1.89"]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod prefetch;

#[cfg(all(test, unit_tests))]
mod tests;
