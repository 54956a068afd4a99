//! Colours in groups of eight, which are converted and compared eight at a time.

use super::halves::Tolerance;
use crate::color::{LinearRgb, Oklab};
use crate::grid::PackedInk;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, SimdKernel, Vector};
use crate::simd::dispatch;
use glam::Vec3;

/// Eight colours: their 8-bit values, and their OKLab values.
#[derive(Clone, Copy)]
struct EightColors {
    srgb: Vector<F32x8>,
    oklab: Vector<F32x8>,
}

/// A value far from all values of colours.
const FAR: f32 = 1e4;

/// A group without colours: its values are far from those of all colours.
const EMPTY: EightColors = {
    let far = F32x8([FAR; LANES]);
    let far = Vector { x: far, y: far, z: far };
    EightColors { srgb: far, oklab: far }
};

/// A list of colours.
#[derive(Default)]
pub(super) struct ColorList {
    eights: Vec<EightColors>,
    len: usize,
}

impl ColorList {
    /// Lists colours in truecolor. Their OKLab values have an error of at most 2e-6.
    pub(super) fn fill(&mut self, inks: &[PackedInk]) {
        self.resize(inks.len());
        dispatch(Convert { inks, eights: &mut self.eights });
    }

    /// Makes a list of `len` colours, which have to be [copied](Self::copy) then.
    pub(super) fn resize(&mut self, len: usize) {
        self.eights.clear();
        self.eights.resize(len.div_ceil(LANES), EMPTY);
        self.len = len;
    }

    /// Returns the lightness of each colour.
    pub(super) fn lightness(&self) -> impl Iterator<Item = f32> {
        self.eights.iter().flat_map(|eight| eight.oklab.x.0).take(self.len)
    }

    /// Copies a colour of another list.
    pub(super) fn copy(&mut self, to: usize, other: &Self, from: usize) {
        let (from, from_lane) = (&other.eights[from / LANES], from % LANES);
        let (to, lane) = (&mut self.eights[to / LANES], to % LANES);
        to.srgb.put(lane, from.srgb.of_lane(from_lane));
        to.oklab.put(lane, from.oklab.of_lane(from_lane));
    }

    /// Compares each colour with the one at the same index of another list: lists the masks of
    /// those within the tolerance, eight colours each.
    pub(super) fn compare(&self, other: &Self, tolerance: Tolerance, masks: &mut Vec<u8>) {
        masks.clear();
        dispatch(Compare { lists: [&self.eights, &other.eights], tolerance, masks });
    }

    /// Compares each colour with the next ones: lists a mask for each colour, bit 0 for the next
    /// colour.
    pub(super) fn compare_with_following(&self, tolerance: Tolerance, masks: &mut Vec<u32>) {
        masks.clear();
        dispatch(CompareWithFollowing { list: self, tolerance, masks });
    }
}

/// Computes the values of colours.
struct Convert<'a> {
    inks: &'a [PackedInk],
    eights: &'a mut [EightColors],
}

impl SimdKernel for Convert<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        for (inks, eight) in self.inks.chunks(LANES).zip(self.eights) {
            let mut bits = [0; LANES];
            for (bits, ink) in bits.iter_mut().zip(inks) {
                *bits = ink.bits();
            }
            let (mut srgb, mut light) = ([F32x8::ZERO; 3], [F32x8::ZERO; 3]);
            for (channel, (srgb, light)) in srgb.iter_mut().zip(&mut light).enumerate() {
                for (lane, bits) in bits.into_iter().enumerate() {
                    let code = (bits >> (16 - 8 * channel)) as u8;
                    srgb.0[lane] = f32::from(code);
                    light.0[lane] = LinearRgb::of_code(code);
                }
            }
            let [x, y, z] = light;
            let light = Vector { x, y, z };
            let Vector { x, y, z } = times(Oklab::CONES, light.load::<N>());
            let roots = Vector { x: near_cbrt(x), y: near_cbrt(y), z: near_cbrt(z) };
            let [x, y, z] = srgb;
            *eight = EightColors { srgb: Vector { x, y, z }, oklab: times(Oklab::FROM_ROOTS, roots).store() };
            for lane in inks.len()..LANES {
                eight.oklab.put(lane, Vec3::splat(FAR));
            }
        }
    }
}

#[inline(always)]
fn times<N: Lanes>([x, y, z]: [[f32; 3]; 3], vector: Vector<N>) -> Vector<N> {
    Vector { x: row_times(x, vector), y: row_times(y, vector), z: row_times(z, vector) }
}

#[inline(always)]
fn row_times<N: Lanes>([x, y, z]: [f32; 3], vector: Vector<N>) -> N {
    Vector { x: N::splat(x), y: N::splat(y), z: N::splat(z) }.dot(vector)
}

/// Returns nearly the cube root of numbers from 0 to 1.
// A first guess from the bits, within 4 %, and two steps of Halley's method, each of which cubes the relative error.
#[inline(always)]
fn near_cbrt<N: Lanes>(x: N) -> N {
    let mut guess = x.store();
    for number in &mut guess.0 {
        *number = f32::from_bits(number.to_bits() / 3 + 0x2a51_19f2);
    }
    let mut root = N::load(&guess);
    for _ in 0..2 {
        let cube = root * root * root;
        root = root * ((cube + N::splat(2.0) * x) / (N::splat(2.0) * cube + x));
    }
    N::select(x.lt(N::splat(f32::MIN_POSITIVE)), N::splat(0.0), root)
}

/// Compares the colours of two lists, pair by pair.
struct Compare<'a> {
    lists: [&'a [EightColors]; 2],
    tolerance: Tolerance,
    masks: &'a mut Vec<u8>,
}

impl SimdKernel for Compare<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let limits = Limits::<N>::of(self.tolerance);
        for (a, b) in self.lists[0].iter().zip(self.lists[1]) {
            self.masks.push(limits.allow(a.oklab.load(), a.srgb.load(), b) as u8);
        }
    }
}

/// Number of colours on either side, in order of lightness, with which each colour is compared.
// In pictures, nearly all colours within the tolerance are among these. In noise many more are within it: without this
// limit and two others, a frame of noise took 192 times ratatui's time; with them it takes 21 times.
pub(super) const NEIGHBOURS: u32 = 24;

/// Compares each colour of a list with the next [`NEIGHBOURS`].
struct CompareWithFollowing<'a> {
    list: &'a ColorList,
    tolerance: Tolerance,
    masks: &'a mut Vec<u32>,
}

impl SimdKernel for CompareWithFollowing<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let limits = Limits::<N>::of(self.tolerance);
        for at in 0..self.list.len {
            let eight = &self.list.eights[at / LANES];
            let oklab = Vector::splat(eight.oklab.of_lane(at % LANES));
            let srgb = Vector::splat(eight.srgb.of_lane(at % LANES));
            let next = at + 1;
            let mut mask = 0;
            // The next `NEIGHBOURS` colours are in at most four groups. Earlier colours of the first are shifted out.
            for (place, eight) in self.list.eights[next / LANES..].iter().take(4).enumerate() {
                mask |= limits.allow(oklab, srgb, eight) << (place * LANES);
            }
            self.masks.push(mask >> (next % LANES) & ((1 << NEIGHBOURS) - 1));
        }
    }
}

/// A tolerance in all lanes.
#[derive(Clone, Copy)]
struct Limits<N> {
    squared_distance: N,
    square: N,
}

impl<N: Lanes> Limits<N> {
    #[inline(always)]
    fn of(Tolerance { distance, square }: Tolerance) -> Self {
        Self { squared_distance: N::splat(distance * distance), square: N::splat(square as f32) }
    }

    /// Compares eight colours with `others`, lane by lane; returns the mask of those within the
    /// tolerance.
    #[inline(always)]
    fn allow(self, oklab: Vector<N>, srgb: Vector<N>, others: &EightColors) -> u32 {
        let (oklab, srgb) = (oklab - others.oklab.load(), srgb - others.srgb.load());
        (oklab.dot(oklab).le(self.squared_distance) & srgb.dot(srgb).le(self.square)).bits()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
