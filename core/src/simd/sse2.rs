//! Vectors of eight numbers in two registers of SSE2, which every x86-64 CPU has.

#![allow(unsafe_code)]

use super::SimdKernel;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, Number};
use std::arch::x86_64::{
    __m128, _mm_add_ps, _mm_and_ps, _mm_and_si128, _mm_andnot_ps, _mm_castps_si128, _mm_castsi128_ps, _mm_cmpeq_epi32,
    _mm_cmple_ps, _mm_cmplt_ps, _mm_cvtepi32_ps, _mm_cvttps_epi32, _mm_div_ps, _mm_load_ps, _mm_max_ps, _mm_min_ps,
    _mm_movemask_ps, _mm_mul_ps, _mm_or_ps, _mm_set1_epi32, _mm_set1_ps, _mm_setr_epi32, _mm_sqrt_ps, _mm_store_ps,
    _mm_sub_ps, _mm_xor_ps,
};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Runs the kernel with SSE2.
#[inline(never)]
pub(super) fn run<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<Registers>()
}

/// Implements [`Number::map_lanes`] for vectors in registers, by storing them to memory.
#[inline(always)]
pub(super) fn map_lanes<N: Lanes, const IN: usize, const OUT: usize>(
    numbers: [N; IN],
    formula: impl Fn([f32; IN]) -> [f32; OUT],
) -> [N; OUT] {
    // `formula` computes one lane at a time, so numbers in registers would have no advantage.
    let mut stored = [F32x8::ZERO; IN];
    for (stored, numbers) in stored.iter_mut().zip(numbers) {
        *stored = numbers.store();
    }
    let mut results = [N::splat(0.0); OUT];
    for (results, stored) in results.iter_mut().zip(F32x8::map_lanes(stored, formula)) {
        *results = N::load(&stored);
    }
    results
}

/// A vector of eight numbers: the first four and the last four, in a register each.
#[derive(Clone, Copy, Debug)]
struct Registers([__m128; 2]);

/// A mask whose set lanes have all bits set.
#[derive(Clone, Copy, Debug)]
struct Masks([__m128; 2]);

/// The magnitude from which on all f32 are integers: 2^23.
const INTEGERS_FROM: f32 = 8_388_608.0;

/// Calls an intrinsic of SSE2, which every x86-64 CPU supports.
macro_rules! sse {
    ($instruction:expr) => {
        // SAFETY: every x86-64 CPU has SSE2. Loads and stores access four numbers of an `F32x8`, which is aligned.
        unsafe { $instruction }
    };
}

#[inline(always)]
fn apply_to_halves(a: [__m128; 2], b: [__m128; 2], instruction: impl Fn(__m128, __m128) -> __m128) -> [__m128; 2] {
    [instruction(a[0], b[0]), instruction(a[1], b[1])]
}

#[inline(always)]
fn select(mask: __m128, yes: __m128, no: __m128) -> __m128 {
    // SSE2 has no blend instruction; it came with SSE4.1.
    sse!(_mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no)))
}

/// Rounds down: truncates each number, and subtracts 1 where the result is above the number.
// SSE2 has no instruction for rounding; it came with SSE4.1. Numbers from 2^23 on, and NaN, are returned unchanged, as
// SSE2's conversion to integers overflows at 2^31.
#[inline(always)]
fn floor(number: __m128) -> __m128 {
    sse!({
        let sign = _mm_and_ps(number, _mm_set1_ps(-0.0));
        let is_less = _mm_cmplt_ps(_mm_andnot_ps(_mm_set1_ps(-0.0), number), _mm_set1_ps(INTEGERS_FROM));
        let truncated = _mm_cvtepi32_ps(_mm_cvttps_epi32(number));
        let one = _mm_and_ps(_mm_cmplt_ps(number, truncated), _mm_set1_ps(1.0));
        // Restores the sign of -0 and of negative numbers that truncate to 0.
        select(is_less, _mm_or_ps(_mm_sub_ps(truncated, one), sign), number)
    })
}

macro_rules! operators {
    ($($type:ident $operation:ident $function:ident $instruction:ident)*) => {
        $(impl $operation for $type {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(apply_to_halves(self.0, other.0, |a, b| sse!($instruction(a, b))))
            }
        })*
    };
}

operators! {
    Registers Add add _mm_add_ps
    Registers Sub sub _mm_sub_ps
    Registers Mul mul _mm_mul_ps
    Registers Div div _mm_div_ps
    Masks BitAnd bitand _mm_and_ps
    Masks BitOr bitor _mm_or_ps
}

impl Neg for Registers {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(apply_to_halves(self.0, Self::splat(-0.0).0, |a, b| sse!(_mm_xor_ps(a, b))))
    }
}

impl Not for Masks {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        let all = sse!(_mm_castsi128_ps(_mm_set1_epi32(-1)));
        Self(apply_to_halves(self.0, [all; 2], |a, b| sse!(_mm_xor_ps(a, b))))
    }
}

impl Number for Registers {
    type Mask = Masks;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([sse!(_mm_set1_ps(value)); 2])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let [first, last] = self.0;
        Self(sse!([_mm_sqrt_ps(first), _mm_sqrt_ps(last)]))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(apply_to_halves(Self::splat(-0.0).0, self.0, |a, b| sse!(_mm_andnot_ps(a, b))))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        let [first, last] = self.0;
        Self([floor(first), floor(last)])
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        Masks(apply_to_halves(self.0, other.0, |a, b| sse!(_mm_cmplt_ps(a, b))))
    }

    #[inline(always)]
    fn le(self, other: Self) -> Masks {
        Masks(apply_to_halves(self.0, other.0, |a, b| sse!(_mm_cmple_ps(a, b))))
    }

    #[inline(always)]
    fn select(Masks(mask): Masks, yes: Self, no: Self) -> Self {
        Self([select(mask[0], yes.0[0], no.0[0]), select(mask[1], yes.0[1], no.0[1])])
    }

    // The instruction returns its second operand if one is NaN or both are zero, as `Number::max` requires.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(apply_to_halves(self.0, other.0, |a, b| sse!(_mm_max_ps(a, b))))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(apply_to_halves(self.0, other.0, |a, b| sse!(_mm_min_ps(a, b))))
    }

    #[inline(always)]
    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT] {
        map_lanes(numbers, formula)
    }
}

impl Lanes for Registers {
    #[inline(always)]
    fn call_no_inline<K: SimdKernel>(kernel: K) -> K::Output {
        run(kernel)
    }

    #[inline(always)]
    fn load(numbers: &F32x8) -> Self {
        let (first, last) = numbers.0.split_at(LANES / 2);
        Self(sse!([_mm_load_ps(first.as_ptr()), _mm_load_ps(last.as_ptr())]))
    }

    #[inline(always)]
    fn store(self) -> F32x8 {
        let mut numbers = F32x8::ZERO;
        let (first, last) = numbers.0.split_at_mut(LANES / 2);
        sse!(_mm_store_ps(first.as_mut_ptr(), self.0[0]));
        sse!(_mm_store_ps(last.as_mut_ptr(), self.0[1]));
        numbers
    }

    #[inline(always)]
    fn mask_from_bits(bits: u32) -> Masks {
        // Lane n extracts bit n of `bits`, and is set if that bit is 1.
        let has = |each| {
            sse!(_mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(bits.cast_signed()), each), each)))
        };
        Masks([has(sse!(_mm_setr_epi32(1, 2, 4, 8))), has(sse!(_mm_setr_epi32(16, 32, 64, 128)))])
    }

    #[inline(always)]
    fn eq_bits(self, bits: u32) -> Masks {
        let bits = sse!(_mm_set1_epi32(bits.cast_signed()));
        let [first, last] = self.0;
        let has = |number| sse!(_mm_castsi128_ps(_mm_cmpeq_epi32(_mm_castps_si128(number), bits)));
        Masks([has(first), has(last)])
    }
}

impl Mask for Masks {
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.bits() == (1 << LANES) - 1
    }
}

impl LaneMask for Masks {
    #[inline(always)]
    fn bits(self) -> u32 {
        let [first, last] = self.0;
        sse!(_mm_movemask_ps(first) | _mm_movemask_ps(last) << 4).cast_unsigned()
    }
}
