//! The test that all instruction sets compute the same bits.

#![allow(unsafe_code)]

use super::*;
use crate::lanes::{LANES, LaneMask, Lanes};

/// A kernel that applies all operations to pairs of vectors, and returns the bits of all results.
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
            // The bits of a NaN differ between CPUs, which is harmless: no NaN reaches a picture.
            let bits = |number: f32| if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() };
            all.extend(all_numbers.map(|numbers| numbers.store().0.map(bits)));
            let from_bits = [N::mask_from_bits(0b1010_0110), x.eq_bits(a.0[3].to_bits())];
            all.extend(masks.into_iter().chain(from_bits).map(|mask| [mask.bits(); LANES]));
            let whole = [x, y, x.abs(), y.abs(), -x.abs(), x, y, x].map(|x| N::select(x.lt(N::splat(9.0)), x, y));
            let whole = whole.map(|x| N::select(x.eq(x), x, N::splat(0.5)));
            let ends = [N::min_of_each(&whole), N::max_of_each(&whole), N::splat(whole[0].reduce_max())];
            all.extend(ends.map(|ends| (ends + N::splat(0.0)).store().0.map(f32::to_bits)));
        }
        all
    }
}

/// Compares the instruction sets on all pairs of numbers at the limits of f32 and of conversions to
/// integers.
#[test]
fn all_instruction_sets_compute_the_same_bits() {
    let mut edges = vec![0.0, 0.3, 0.5, 1.0, 1.5, 2.5, 3.0e-39, 1e-20, 7.0e9, 3.0e38, f32::INFINITY, f32::MIN_POSITIVE];
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
