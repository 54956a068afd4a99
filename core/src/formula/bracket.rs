//! The last steps to the roots of eight rays: brackets, narrowed down to two neighbouring f32.

use super::packet::EightValues;
use super::values::PacketValues;
use crate::lanes::{F32x8, LANES, Lanes, SimdKernel};
use std::array::from_fn;

/// The distance of the first two t from the middle of the bracket, relative to its length.
const APART: f64 = 0.125;

/// A range of t from `low` to `high` with the first root, and the sign of f in front of it.
pub(super) struct Root {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) sign: f64,
}

/// Brackets of eight rays: pairs of t between which f changes its sign, narrowed step by step.
///
/// After [`start`](Self::start), all values of t are f32 numbers, held as f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brackets {
    before: EightValues,
    pub(super) after: EightValues,
    /// The sign of f in front of the root.
    sign: EightValues,
    /// The slope of f times the sign, below 0; NaN if it is not known yet.
    slope: EightValues,
    /// The two t at which f is to be evaluated next.
    next: [EightValues; 2],
}

impl Brackets {
    pub(super) const NONE: Self = {
        let none = [0.0; LANES];
        Self { before: none, after: none, sign: none, slope: [f64::NAN; LANES], next: [none; 2] }
    };

    pub(super) fn add(&mut self, lane: usize, Root { low, high, sign }: Root) {
        (self.before[lane], self.after[lane], self.sign[lane]) = (low, high, sign);
    }

    /// Adds the roots of the lanes that are true: their `low`, `high` and `sign`.
    // Without branches, so that the loop becomes vector instructions.
    #[inline(always)]
    pub(super) fn add_each(&mut self, lanes: [bool; LANES], [lows, highs, signs]: [&EightValues; 3]) {
        for lane in 0..LANES {
            self.before[lane] = if lanes[lane] { lows[lane] } else { self.before[lane] };
            self.after[lane] = if lanes[lane] { highs[lane] } else { self.after[lane] };
            self.sign[lane] = if lanes[lane] { signs[lane] } else { self.sign[lane] };
        }
    }

    /// Rounds the ends of all brackets to f32, away from the root, and sets the first two t.
    #[inline(always)]
    fn start(&mut self) {
        for lane in 0..LANES {
            let (before, after) = (at_most(self.before[lane]), at_least(self.after[lane]));
            (self.before[lane], self.after[lane]) = (before, after);
            // The root is mostly near the middle, as the error of one model extends the bracket on both sides.
            let (middle, apart) = (0.5 * (before + after), APART * (after - before));
            self.set_next(lane, [middle - apart, middle + apart].map(|t| f64::from(t as f32)));
        }
    }

    /// Sets the two t of a lane, moved into the bracket.
    #[inline(always)]
    fn set_next(&mut self, lane: usize, [one, other]: [f64; 2]) {
        let (least, most) = (next_f32_above(self.before[lane]), next_f32_below(self.after[lane]));
        let one = one.max(least).min(most);
        self.next[0][lane] = one;
        self.next[1][lane] = other.max(next_f32_above(one)).min(most);
    }

    /// Returns the values of a lane times the sign in front of its root.
    #[inline(always)]
    fn signed(&self, values: &[EightValues; 2], lane: usize) -> [f64; 2] {
        [values[0][lane] * self.sign[lane], values[1][lane] * self.sign[lane]]
    }

    /// Takes the values of f at `next`; returns the lanes whose brackets are two neighbouring f32.
    #[inline(always)]
    fn take_values(&mut self, values: &[EightValues; 2]) -> u32 {
        let mut is_narrow = [false; LANES];
        for (lane, is_narrow) in is_narrow.iter_mut().enumerate() {
            let [one, other] = [self.next[0][lane], self.next[1][lane]];
            let [at_one, at_other] = self.signed(values, lane);
            // The values of f at the ends of the bracket are not kept, because their signs, which are known, suffice.
            let is_before = (at_one > 0.0) || (one <= self.before[lane]);
            let is_other_before = (at_other > 0.0) || (other <= self.before[lane]);
            let before = if is_before { one.max(self.before[lane]) } else { self.before[lane] };
            let before = if is_before && is_other_before { other.max(before) } else { before };
            let after = if is_other_before { self.after[lane] } else { other.min(self.after[lane]) };
            let after = if is_before { after } else { one.min(after) };
            (self.before[lane], self.after[lane]) = (before, after);
            *is_narrow = next_f32_above(before) >= after;
        }
        (0..LANES).fold(0, |lanes, lane| lanes | u32::from(is_narrow[lane]) << lane)
    }

    /// Sets the two t at which f is to be evaluated next, from its values at the last two.
    ///
    /// `count` is the number of earlier calls.
    #[inline(always)]
    fn advance(&mut self, values: &[EightValues; 2], count: u32) {
        let in_turn = count % 3 == 2;
        for lane in 0..LANES {
            let [one, other] = [self.next[0][lane], self.next[1][lane]];
            let [at_one, at_other] = self.signed(values, lane);
            let secant = (at_other - at_one) / (other - one);
            let slope = if secant < 0.0 { secant } else { self.slope[lane] };
            let root = one - at_one / slope;
            // The root is enclosed by the two f32 beside it; in every third turn, the bracket is cut in three. Negated,
            // so that NaN is far, too.
            let is_far = in_turn || !(root.abs() < f64::INFINITY);
            let (before, after) = (self.before[lane], self.after[lane]);
            let third = (after - before) * (1.0 / 3.0);
            let below = at_most(root);
            let near = [below, next_f32_above(below)];
            let far = [f64::from((before + third) as f32), f64::from((after - third) as f32)];
            self.slope[lane] = slope;
            self.set_next(lane, if is_far { far } else { near });
        }
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
        if lanes == 0 {
            return F32x8::ZERO;
        }
        brackets.start();
        for count in 0.. {
            let values = values.at(&brackets.next);
            lanes &= !brackets.take_values(&values);
            if lanes == 0 {
                break;
            }
            brackets.advance(&values, count);
        }
        F32x8(from_fn(|lane| brackets.after[lane] as f32))
    }
}

/// Returns the largest f32 that is not above `t`.
#[inline(always)]
fn at_most(t: f64) -> f64 {
    let rounded = f64::from(t as f32);
    if rounded > t { next_f32_below(rounded) } else { rounded }
}

/// Returns the least f32 that is not below `t`.
#[inline(always)]
fn at_least(t: f64) -> f64 {
    -at_most(-t)
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
