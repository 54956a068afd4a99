//! Vectors of eight numbers in registers, chosen for the CPU at run time.
//!
//! A [`SimdKernel`] is compiled once for each instruction set, and [`dispatch`] selects one by the features of the CPU.
//! Everything that a kernel calls must be `#[inline(always)]`: a function that is not inlined loses the target
//! features, and closures do as well. All operations are exactly defined by IEEE 754; none is fused, as FMA rounds
//! differently.
//!
//! Only this module has unsafe code.

#![allow(unsafe_code)]

use crate::lanes::F32x8;

pub use crate::lanes::SimdKernel;
pub use prefetch::prefetch;

/// Runs the kernel with the widest instruction set of this CPU.
#[inline]
pub fn dispatch<K: SimdKernel>(kernel: K) -> K::Output {
    // The detection is cached by the standard library: a load and a bit test for each kernel.
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
// With BMI1, LZCNT and POPCNT, since loops over masks count and clear bits; every known CPU with
// AVX2 has them, but no specification says so.
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

#[cfg(all(target_arch = "x86_64", compiler_has_avx512))]
#[inline]
// VL for masks of registers of eight, DQ for moves of eight-bit masks.
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("bmi2")
}

#[cfg(target_arch = "x86_64")]
// `avx` holds what AVX2 and AVX-512 share; they differ in their masks only.
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx2;
// AVX-512 needs Rust 1.89; the build script checks the compiler, which clippy does not know.
#[cfg(all(target_arch = "x86_64", compiler_has_avx512))]
#[clippy::msrv = "1.89"]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod prefetch;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{LANES, LaneMask, Lanes};

    /// The results of each operation on pairs of vectors: the bits of numbers, and masks.
    struct All<'w>(&'w [[F32x8; 2]]);

    impl SimdKernel for All<'_> {
        type Output = Vec<[u32; LANES]>;

        #[inline(always)]
        fn run<N: Lanes>(self) -> Self::Output {
            let mut all = Vec::new();
            for [a, b] in self.0 {
                let (x, y) = (N::load(a), N::load(b));
                let numbers = [x + y, x - y, x * y, x / y, -x, x.sqrt(), x.abs(), x.floor(), x.max(y), x.min(y)];
                let masks = [x.lt(y), x.le(y), x.eq(y), x.lt(y) & x.le(y), x.lt(y) | y.lt(x), !x.lt(y)];
                let chosen = masks.map(|mask| N::select(mask, x, y));
                let mapped = N::map_lanes([x, y], |[x, y]| [y, x]);
                let one = |lane: usize| [x.splat_lane(lane), N::splat(x.lane(lane))];
                let spread = (0..LANES).flat_map(one).chain([N::splat(b.0[0])]);
                let all_numbers =
                    numbers.into_iter().chain(chosen).chain(mapped).chain(spread).chain([x.gather(y), y.gather(x)]);
                // The payload of NaN differs between CPUs, and no NaN reaches a picture.
                let bits = |number: f32| if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() };
                all.extend(all_numbers.map(|numbers| numbers.store().0.map(bits)));
                let from_bits = [N::mask_from_bits(0b1010_0110), x.has_bits(a.0[3].to_bits())];
                all.extend(masks.into_iter().chain(from_bits).map(|mask| [mask.bits(); LANES]));
                let whole = [x, y, x.abs(), y.abs(), -x.abs(), x, y, x].map(|x| N::select(x.lt(N::splat(9.0)), x, y));
                let whole = whole.map(|x| N::select(x.eq(x), x, N::splat(0.5)));
                let ends = [N::min_of_each(&whole), N::max_of_each(&whole), N::splat(whole[0].reduce_max())];
                all.extend(ends.map(|ends| (ends + N::splat(0.0)).store().0.map(f32::to_bits)));
            }
            all
        }
    }

    /// Every pair of numbers at the limits of f32 and of the conversions.
    #[test]
    fn all_instructions_have_the_same_bits() {
        let mut edges =
            vec![0.0, 0.3, 0.5, 1.0, 1.5, 2.5, 3.0e-39, 1e-20, 7.0e9, 3.0e38, f32::INFINITY, f32::MIN_POSITIVE];
        edges.extend([8_388_607.5, 8_388_608.0, 8_388_609.0, 2_147_483_520.0, 2_147_483_648.0, 16_777_217.0]);
        edges.extend(edges.clone().iter().map(|edge| -edge));
        edges.push(f32::NAN);
        let eights =
            |from: usize, step: usize| F32x8(std::array::from_fn(|lane| edges[(from + step * lane) % edges.len()]));
        let pairs: Vec<_> = (0..edges.len())
            .flat_map(|from| (0..edges.len()).map(move |other| [(from, 1), (other, 3)]))
            .map(|places| places.map(|(from, step)| eights(from, step)))
            .collect();
        let truth = run_scalar(All(&pairs));
        let check = |found: Vec<[u32; LANES]>, instructions| {
            let differs = truth.iter().zip(&found).position(|(truth, found)| truth != found);
            assert_eq!(differs.map(|at| (at, truth[at], found[at])), None, "{instructions}");
        };
        check(dispatch(All(&pairs)), "the best");
        #[cfg(target_arch = "x86_64")]
        {
            check(sse2::run(All(&pairs)), "SSE2");
            if has_avx2() {
                // SAFETY: the condition above has checked the CPU.
                check(unsafe { avx2::run(All(&pairs)) }, "AVX2");
            }
            #[cfg(compiler_has_avx512)]
            if has_avx512() {
                // SAFETY: the condition above has checked the CPU.
                check(unsafe { avx512::run(All(&pairs)) }, "AVX-512");
            }
        }
    }
}
