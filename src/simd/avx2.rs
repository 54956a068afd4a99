//! Eight numbers in a register of AVX.

#![allow(unsafe_code)]

use super::Work;
use super::sse2::each;
use crate::lanes::{Answers, Eight, LANES, Lanes, Mask, Number};
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_and_ps, _mm256_and_si256, _mm256_andnot_ps, _mm256_blendv_ps,
    _mm256_castps_si256, _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpeq_epi32, _mm256_div_ps, _mm256_floor_ps,
    _mm256_load_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_or_ps,
    _mm256_permute2f128_ps, _mm256_set1_epi32, _mm256_set1_ps, _mm256_setr_epi32, _mm256_shuffle_ps, _mm256_sqrt_ps,
    _mm256_store_ps, _mm256_sub_ps, _mm256_unpackhi_ps, _mm256_unpacklo_ps, _mm256_xor_ps,
};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Does the work with the registers of AVX, which this CPU has to have.
pub(super) fn run<W: Work>(work: W) -> W::Output {
    #[inline(never)]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn compiled_for_avx2<W: Work>(work: W) -> W::Output {
        work.run::<Register>()
    }
    // SAFETY: `super::run` has asked the CPU, and `Register::apart` is reached by what runs on it.
    unsafe { compiled_for_avx2(work) }
}

/// Only `run` has work done with it: where there is one, the CPU has AVX.
#[derive(Clone, Copy, Debug)]
struct Register(__m256);

/// All bits of a number are set for yes, none for no.
#[derive(Clone, Copy, Debug)]
struct Mask256(__m256);

/// An instruction of AVX.
macro_rules! avx {
    ($instruction:expr) => {
        // SAFETY: the CPU has AVX, as `Register` says; what is loaded and stored is a whole and aligned `Eight`.
        unsafe { $instruction }
    };
}

/// What is chosen of each eight, where the order does not count: of neighbours, then of pairs, then of halves.
macro_rules! of_each {
    ($choose:ident, $eights:expr) => {{
        let [a, b, c, d, e, f, g, h] = *$eights;
        let (ab, cd) = (neighbours(a, b), neighbours(c, d));
        let (ef, gh) = (neighbours(e, f), neighbours(g, h));
        let left = pairs(ab[0].$choose(ab[1]), cd[0].$choose(cd[1]));
        let right = pairs(ef[0].$choose(ef[1]), gh[0].$choose(gh[1]));
        let [first, last] = halves(left[0].$choose(left[1]), right[0].$choose(right[1]));
        first.$choose(last)
    }};
}

macro_rules! operators {
    ($($type:ident $operation:ident $function:ident $instruction:ident)*) => {
        $(impl $operation for $type {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(avx!($instruction(self.0, other.0)))
            }
        })*
    };
}

operators! {
    Register Add add _mm256_add_ps
    Register Sub sub _mm256_sub_ps
    Register Mul mul _mm256_mul_ps
    Register Div div _mm256_div_ps
    Mask256 BitAnd bitand _mm256_and_ps
    Mask256 BitOr bitor _mm256_or_ps
}

impl Neg for Register {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(avx!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Not for Mask256 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(avx!(_mm256_xor_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))))
    }
}

impl Number for Register {
    type Mask = Mask256;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(avx!(_mm256_set1_ps(value)))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(avx!(_mm256_sqrt_ps(self.0)))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(avx!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self(avx!(_mm256_floor_ps(self.0)))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask256 {
        Mask256(avx!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)))
    }

    #[inline(always)]
    fn le(self, other: Self) -> Mask256 {
        Mask256(avx!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)))
    }

    #[inline(always)]
    fn select(answer: Mask256, yes: Self, no: Self) -> Self {
        Self(avx!(_mm256_blendv_ps(no.0, yes.0, answer.0)))
    }

    /// Of the instruction, too: where one is NaN and where both are zero, the second.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(avx!(_mm256_max_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(avx!(_mm256_min_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn each<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT] {
        each(numbers, formula)
    }
}

impl Lanes for Register {
    #[inline(always)]
    fn apart<W: Work>(work: W) -> W::Output {
        run(work)
    }

    #[inline(always)]
    fn load(numbers: &Eight) -> Self {
        Self(avx!(_mm256_load_ps(numbers.0.as_ptr())))
    }

    #[inline(always)]
    fn store(self) -> Eight {
        let mut numbers = Eight([0.0; LANES]);
        avx!(_mm256_store_ps(numbers.0.as_mut_ptr(), self.0));
        numbers
    }

    #[inline(always)]
    fn answers(bits: u32) -> Mask256 {
        let each = avx!(_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128));
        let own = avx!(_mm256_and_si256(_mm256_set1_epi32(bits.cast_signed()), each));
        Mask256(avx!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(own, each))))
    }

    #[inline(always)]
    fn has_bits(self, bits: u32) -> Mask256 {
        let bits = avx!(_mm256_set1_epi32(bits.cast_signed()));
        Mask256(avx!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_castps_si256(self.0), bits))))
    }

    #[inline(always)]
    fn least_of_each(eights: &[Self; LANES]) -> Self {
        of_each!(min, eights)
    }

    #[inline(always)]
    fn greatest_of_each(eights: &[Self; LANES]) -> Self {
        of_each!(max, eights)
    }
}

/// The first and the last numbers of both, neighbours beside each other.
#[inline(always)]
fn neighbours(a: Register, b: Register) -> [Register; 2] {
    avx!([Register(_mm256_unpacklo_ps(a.0, b.0)), Register(_mm256_unpackhi_ps(a.0, b.0))])
}

/// The first and the last pairs of both.
#[inline(always)]
fn pairs(a: Register, b: Register) -> [Register; 2] {
    avx!([
        Register(_mm256_shuffle_ps::<0b01_00_01_00>(a.0, b.0)),
        Register(_mm256_shuffle_ps::<0b11_10_11_10>(a.0, b.0)),
    ])
}

/// The first and the last halves of both.
#[inline(always)]
fn halves(a: Register, b: Register) -> [Register; 2] {
    avx!([Register(_mm256_permute2f128_ps::<0x20>(a.0, b.0)), Register(_mm256_permute2f128_ps::<0x31>(a.0, b.0)),])
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

impl Answers for Mask256 {
    #[inline(always)]
    fn bits(self) -> u32 {
        avx!(_mm256_movemask_ps(self.0)).cast_unsigned()
    }
}
