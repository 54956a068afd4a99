//! Vectors of eight numbers in a register of AVX2, also used with AVX-512.
//!
//! The two instruction sets differ in the type of masks, [`MaskOps`].

#![allow(unsafe_code)]

use super::sse2::map_lanes;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Number, SimdKernel};
use std::arch::x86_64::{
    __m256, _mm256_add_ps, _mm256_andnot_ps, _mm256_castps_si256, _mm256_cvtss_f32, _mm256_div_ps, _mm256_floor_ps,
    _mm256_load_ps, _mm256_max_ps, _mm256_min_ps, _mm256_mul_ps, _mm256_permute2f128_ps, _mm256_permutevar8x32_ps,
    _mm256_set1_epi32, _mm256_set1_ps, _mm256_shuffle_ps, _mm256_sqrt_ps, _mm256_store_ps, _mm256_sub_ps,
    _mm256_unpackhi_ps, _mm256_unpacklo_ps, _mm256_xor_ps,
};
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The mask type of an instruction set, and its comparisons.
pub(super) trait MaskOps: LaneMask {
    /// Runs the kernel with registers that have this mask type.
    ///
    /// # Safety
    /// The CPU has the instruction set.
    // Unsafe, since the kernel's registers may exist only on a CPU that has the instructions.
    unsafe fn run<K: SimdKernel>(kernel: K) -> K::Output;

    /// Compares lane by lane with `<`, as [`Number::lt`] does.
    fn lt(a: __m256, b: __m256) -> Self;

    /// Compares lane by lane with `<=`, as [`Number::le`] does.
    fn le(a: __m256, b: __m256) -> Self;

    /// Returns `yes` where the mask is set, else `no`.
    fn select(self, yes: __m256, no: __m256) -> __m256;

    /// Returns the mask whose lane n is bit n of `bits`.
    fn from_bits(bits: u32) -> Self;

    /// Compares the bits of each number with `bits`, as [`Lanes::eq_bits`] does.
    fn eq_bits(numbers: __m256, bits: u32) -> Self;
}

/// Eight numbers in a register.
///
/// Only kernels started by [`MaskOps::run`] use this type, so the CPU has AVX2 wherever a value of it exists.
#[derive(Clone, Copy, Debug)]
pub(super) struct Register<M>(__m256, PhantomData<M>);

// `#[inline(always)]`, because a function that is compiled without AVX takes its vectors through memory.
impl<M> Register<M> {
    #[inline(always)]
    fn of(numbers: __m256) -> Self {
        Self(numbers, PhantomData)
    }
}

/// Calls an intrinsic of AVX2, or, in the methods of AVX-512's mask type, one of AVX-512.
macro_rules! avx {
    ($instruction:expr) => {
        // SAFETY: a `Register` or a mask exists only within `MaskOps::run`, whose caller guarantees the instruction
        // set. Loads and stores access a whole and aligned `F32x8`.
        unsafe { $instruction }
    };
}

pub(super) use avx;

/// Reduces eight registers to one, whose lanes are the minimum or maximum of each register.
///
/// The reduction transposes: first neighbours are combined, then pairs, then halves.
// The transposition takes three rounds of shuffles. Loading the numbers one by one would take eight loads per register.
macro_rules! reduce_each {
    ($choose:ident, $eights:expr) => {{
        let [a, b, c, d, e, f, g, h] = *$eights;
        let (ab, cd) = (interleave_lanes(a, b), interleave_lanes(c, d));
        let (ef, gh) = (interleave_lanes(e, f), interleave_lanes(g, h));
        let left = interleave_pairs(ab[0].$choose(ab[1]), cd[0].$choose(cd[1]));
        let right = interleave_pairs(ef[0].$choose(ef[1]), gh[0].$choose(gh[1]));
        let [first, last] = interleave_halves(left[0].$choose(left[1]), right[0].$choose(right[1]));
        first.$choose(last)
    }};
}

macro_rules! operators {
    ($($operation:ident $function:ident $instruction:ident)*) => {
        $(impl<M> $operation for Register<M> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self::of(avx!($instruction(self.0, other.0)))
            }
        })*
    };
}

operators! { Add add _mm256_add_ps Sub sub _mm256_sub_ps Mul mul _mm256_mul_ps Div div _mm256_div_ps }

impl<M> Neg for Register<M> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(avx!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl<M: MaskOps> Number for Register<M> {
    type Mask = M;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self::of(avx!(_mm256_set1_ps(value)))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::of(avx!(_mm256_sqrt_ps(self.0)))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::of(avx!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self::of(avx!(_mm256_floor_ps(self.0)))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> M {
        M::lt(self.0, other.0)
    }

    #[inline(always)]
    fn le(self, other: Self) -> M {
        M::le(self.0, other.0)
    }

    #[inline(always)]
    fn select(mask: M, yes: Self, no: Self) -> Self {
        Self::of(mask.select(yes.0, no.0))
    }

    // The instruction returns its second operand if one is NaN or both are zero, as `Number::max` requires.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::of(avx!(_mm256_max_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::of(avx!(_mm256_min_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT] {
        map_lanes(numbers, formula)
    }
}

impl<M: MaskOps> Lanes for Register<M> {
    #[inline(always)]
    fn call_no_inline<K: SimdKernel>(kernel: K) -> K::Output {
        // SAFETY: values of this type exist only within `MaskOps::run`, whose caller guarantees the same instruction
        // set.
        unsafe { M::run(kernel) }
    }

    #[inline(always)]
    fn load(numbers: &F32x8) -> Self {
        Self::of(avx!(_mm256_load_ps(numbers.0.as_ptr())))
    }

    #[inline(always)]
    fn store(self) -> F32x8 {
        let mut numbers = F32x8([0.0; LANES]);
        avx!(_mm256_store_ps(numbers.0.as_mut_ptr(), self.0));
        numbers
    }

    #[inline(always)]
    // Takes one permutation, where the default method takes a store, a load and a broadcast.
    fn splat_lane(self, lane: usize) -> Self {
        let lane = avx!(_mm256_set1_epi32((lane as u32).cast_signed()));
        Self::of(avx!(_mm256_permutevar8x32_ps(self.0, lane)))
    }

    #[inline(always)]
    // Takes one permutation for all eight lanes. Gathered lane by lane through memory, each load waited for a store,
    // and computing surface points took a third longer.
    fn gather(self, lanes: Self) -> Self {
        Self::of(avx!(_mm256_permutevar8x32_ps(self.0, _mm256_castps_si256(lanes.0))))
    }

    #[inline(always)]
    fn reduce_max(self) -> f32 {
        // Three shuffles instead of eight loads make packets, which take a maximum at every node, leaf and hit, 1.02
        // times as fast.
        let fours = self.max(Self::of(avx!(_mm256_permute2f128_ps::<0x01>(self.0, self.0))));
        let twos = fours.max(Self::of(avx!(_mm256_shuffle_ps::<0b01_00_11_10>(fours.0, fours.0))));
        avx!(_mm256_cvtss_f32(twos.max(Self::of(_mm256_shuffle_ps::<0b10_11_00_01>(twos.0, twos.0))).0))
    }

    #[inline(always)]
    fn mask_from_bits(bits: u32) -> M {
        M::from_bits(bits)
    }

    #[inline(always)]
    fn eq_bits(self, bits: u32) -> M {
        M::eq_bits(self.0, bits)
    }

    #[inline(always)]
    fn min_of_each(eights: &[Self; LANES]) -> Self {
        reduce_each!(min, eights)
    }

    #[inline(always)]
    fn max_of_each(eights: &[Self; LANES]) -> Self {
        reduce_each!(max, eights)
    }
}

/// Interleaves the numbers of two registers: the first two and then the last two of each 128-bit
/// half.
#[inline(always)]
fn interleave_lanes<M: MaskOps>(a: Register<M>, b: Register<M>) -> [Register<M>; 2] {
    avx!([Register::of(_mm256_unpacklo_ps(a.0, b.0)), Register::of(_mm256_unpackhi_ps(a.0, b.0))])
}

/// Returns the first and the last pairs of numbers in each 128-bit half of two registers.
#[inline(always)]
fn interleave_pairs<M: MaskOps>(a: Register<M>, b: Register<M>) -> [Register<M>; 2] {
    avx!([
        Register::of(_mm256_shuffle_ps::<0b01_00_01_00>(a.0, b.0)),
        Register::of(_mm256_shuffle_ps::<0b11_10_11_10>(a.0, b.0)),
    ])
}

/// Returns the first halves and the last halves of two registers.
#[inline(always)]
fn interleave_halves<M: MaskOps>(a: Register<M>, b: Register<M>) -> [Register<M>; 2] {
    avx!([
        Register::of(_mm256_permute2f128_ps::<0x20>(a.0, b.0)),
        Register::of(_mm256_permute2f128_ps::<0x31>(a.0, b.0)),
    ])
}
