//! The last steps to the roots of eight rays: brackets, narrowed down to two neighbouring f32.

use super::packet::{EightValues, PacketValues};
use crate::lanes::{F32x8, LANES, Lanes, SimdKernel};
use std::array::from_fn;

/// The relative distance of two t up to which the secant between them may be mere rounding error.
const CLOSE: f64 = 16.0 * f32::EPSILON as f64;

/// A range of t from `low` to `high` with the first root, and the sign of f in front of it.
pub(super) struct Root {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) sign: f64,
    /// An estimate of the root.
    pub(super) guess: f64,
    /// The slope of f's model at the root; 0 if there is no model.
    pub(super) slope: f64,
}

/// Brackets of eight rays: pairs of t between which f changes its sign, narrowed step by step.
///
/// All values of t are f32 numbers, held as f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brackets {
    before: EightValues,
    pub(super) after: EightValues,
    /// The sign of f in front of the root.
    sign: EightValues,
    /// The slope of f times the sign, below 0; 0 if it is not known yet.
    slope: EightValues,
    /// The t at which f is to be evaluated next.
    next: EightValues,
    /// The t that were evaluated last, and the values of f there times the signs.
    last: [EightValues; 2],
}

impl Brackets {
    pub(super) const NONE: Self = {
        let none = [0.0; LANES];
        Self { before: none, after: none, sign: none, slope: none, next: none, last: [none; 2] }
    };

    pub(super) fn add(&mut self, lane: usize, Root { low, high, sign, guess, slope }: Root) {
        let (before, after) = (f64::from(at_most(low)), f64::from(at_least(high)));
        let slope = (sign * slope).min(0.0);
        let next = if slope < 0.0 { guess } else { 0.5 * (before + after) };
        (self.before[lane], self.after[lane], self.sign[lane], self.slope[lane]) = (before, after, sign, slope);
        self.next[lane] = f64::from(next as f32).max(before).min(after);
    }

    /// Takes the values of f at `next`; returns the lanes whose brackets are two neighbouring f32.
    ///
    /// `count` is the number of earlier calls.
    #[inline(always)]
    fn take_values(&mut self, values: &EightValues, count: u32) -> u32 {
        let mut is_narrow = [false; LANES];
        let in_turn = count > 2 && count.is_multiple_of(2);
        for lane in 0..LANES {
            let (t, value) = (self.next[lane], values[lane] * self.sign[lane]);
            let is_before = value > 0.0;
            // The values of f at the ends of the bracket are not kept, because their signs, which are known, suffice.
            let before = if is_before { t.max(self.before[lane]) } else { self.before[lane] };
            let after = if is_before { self.after[lane] } else { t.min(self.after[lane]) };
            let (least, most) = (next_f32_above(before), next_f32_below(after));
            let distance = t - self.last[0][lane];
            let secant = (value - self.last[1][lane]) / distance;
            // A secant that is NaN is not used, and neither is one between two t so close that rounding errors would
            // decide it.
            let is_steeper = count > 0 && secant < 0.0 && distance.abs() > CLOSE * t.abs();
            let slope = if is_steeper { secant } else { self.slope[lane] };
            // The next t is one f32 beyond the root by Newton's method, so that the root is soon enclosed from both
            // sides; later, every second t is the middle of the bracket.
            let root = f64::from((t - value / slope) as f32);
            let beyond = if is_before { next_f32_above(root) } else { next_f32_below(root) };
            let is_far = in_turn || !(root.abs() < f64::INFINITY);
            let next = if is_far { f64::from((0.5 * (before + after)) as f32) } else { beyond };
            (self.before[lane], self.after[lane], self.slope[lane]) = (before, after, slope);
            (self.last[0][lane], self.last[1][lane]) = (t, value);
            self.next[lane] = next.max(least).min(most);
            is_narrow[lane] = least > most;
        }
        (0..LANES).fold(0, |lanes, lane| lanes | u32::from(is_narrow[lane]) << lane)
    }
}

/// The search for the first f32 at which f has the other sign, in the brackets of `lanes`.
pub(super) struct Narrowing<'a> {
    pub(super) values: PacketValues<'a>,
    pub(super) brackets: &'a mut Brackets,
    pub(super) lanes: u32,
}

impl SimdKernel for Narrowing<'_> {
    type Output = F32x8;

    #[inline(always)]
    fn run<N: Lanes>(self) -> F32x8 {
        let Self { mut values, brackets, mut lanes } = self;
        let mut count = 0;
        while lanes != 0 {
            lanes &= !brackets.take_values(&values.at(&brackets.next), count);
            count += 1;
        }
        F32x8(from_fn(|lane| brackets.after[lane] as f32))
    }
}

/// Returns the largest f32 that is not above `t`.
fn at_most(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) > t { rounded.next_down() } else { rounded }
}

/// Returns the least f32 that is not below `t`.
fn at_least(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) < t { rounded.next_up() } else { rounded }
}

/// Returns the next f32 above a finite f32.
// Without the branches of `next_up`, which keep a loop from becoming vector instructions.
#[inline(always)]
fn next_f32_above(t: f64) -> f64 {
    // Adding 0 turns -0 into 0: the bits of -0 are not beside those of the least positive number.
    let bits = (t as f32 + 0.0).to_bits();
    f64::from(f32::from_bits(if t < 0.0 { bits.wrapping_sub(1) } else { bits.wrapping_add(1) }))
}

/// Returns the next f32 below a finite f32.
#[inline(always)]
fn next_f32_below(t: f64) -> f64 {
    -next_f32_above(-t)
}
