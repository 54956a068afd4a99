//! The instruction set AVX2, whose masks are registers.

#![allow(unsafe_code)]

use super::avx::{MaskOps, Register, avx};
use crate::lanes::{LANES, LaneMask, Mask, SimdKernel};
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_and_ps, _mm256_and_si256, _mm256_blendv_ps, _mm256_castps_si256,
    _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpeq_epi32, _mm256_movemask_ps, _mm256_or_ps, _mm256_set1_epi32,
    _mm256_setr_epi32, _mm256_xor_ps,
};
use std::ops::{BitAnd, BitOr, Not};

/// Runs the kernel with AVX2.
///
/// # Safety
/// The CPU has AVX2, BMI1, LZCNT and POPCNT.
pub(super) unsafe fn run<K: SimdKernel>(kernel: K) -> K::Output {
    // SAFETY: the caller guarantees the instruction set.
    unsafe { Mask256::run(kernel) }
}

/// A mask whose set lanes have all bits set.
#[derive(Clone, Copy, Debug)]
struct Mask256(__m256);

impl MaskOps for Mask256 {
    unsafe fn run<K: SimdKernel>(kernel: K) -> K::Output {
        #[inline(never)]
        #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
        // Only this function, with everything inlined into it, is compiled with these target features. It must not be
        // inlined into a caller without them.
        fn compiled_for_avx2<K: SimdKernel>(kernel: K) -> K::Output {
            kernel.run::<Register<Mask256>>()
        }
        // SAFETY: the caller guarantees the instruction set.
        unsafe { compiled_for_avx2(kernel) }
    }

    #[inline(always)]
    fn lt(a: __m256, b: __m256) -> Self {
        Self(avx!(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)))
    }

    #[inline(always)]
    fn le(a: __m256, b: __m256) -> Self {
        Self(avx!(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)))
    }

    #[inline(always)]
    fn select(self, yes: __m256, no: __m256) -> __m256 {
        avx!(_mm256_blendv_ps(no, yes, self.0))
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        // Lane n extracts bit n of `bits`, and is set if that bit is 1.
        let each = avx!(_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128));
        let own = avx!(_mm256_and_si256(_mm256_set1_epi32(bits.cast_signed()), each));
        Self(avx!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(own, each))))
    }

    #[inline(always)]
    fn eq_bits(numbers: __m256, bits: u32) -> Self {
        let bits = avx!(_mm256_set1_epi32(bits.cast_signed()));
        Self(avx!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_castps_si256(numbers), bits))))
    }
}

impl BitAnd for Mask256 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(avx!(_mm256_and_ps(self.0, other.0)))
    }
}

impl BitOr for Mask256 {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(avx!(_mm256_or_ps(self.0, other.0)))
    }
}

impl Not for Mask256 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(avx!(_mm256_xor_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))))
    }
}

impl Mask for Mask256 {
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.bits() == (1 << LANES) - 1
    }
}

impl LaneMask for Mask256 {
    #[inline(always)]
    fn bits(self) -> u32 {
        avx!(_mm256_movemask_ps(self.0)).cast_unsigned()
    }
}
