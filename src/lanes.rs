//! One number, or eight side by side: a formula that is written for any [`Number`] can be asked for one ray or for eight.
//!
//! All that they can do are operations that IEEE 754 defines to the last bit, so that a ray among eight gets the bits that
//! it gets alone. [`F32x8`] are a plain array, which any CPU can work with; [`simd`](crate::simd) has those that fit one
//! register.

use std::array::from_fn;
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

mod vector;

pub use vector::Vector;

/// A number, or several of which each goes its own way.
pub trait Number:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The answer to a comparison.
    type Mask: Mask;

    /// The same number everywhere.
    fn splat(value: f32) -> Self;

    /// The square root.
    fn sqrt(self) -> Self;

    /// Without its sign.
    fn abs(self) -> Self;

    /// The greatest whole number that is not greater.
    fn floor(self) -> Self;

    /// Whether this is less. NaN is not.
    fn lt(self, other: Self) -> Self::Mask;

    /// Whether this is less, or the same. NaN is not.
    fn le(self, other: Self) -> Self::Mask;

    /// `yes` where the answer was yes, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// What the formula gives for the numbers in each place: for what is rare and only known of one at a time.
    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT];

    /// Whether they are the same. NaN is not.
    #[inline(always)]
    fn eq(self, other: Self) -> Self::Mask {
        self.le(other) & other.le(self)
    }

    /// The greater one; where this is NaN, the other. (Of two zeros, the other.)
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// The lesser one; where this is NaN, the other. (Of two zeros, the other.)
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
}

/// Yes or no, for each of the numbers that were compared.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether there is a yes among them.
    fn any(self) -> bool;

    /// Whether there is no other answer.
    fn all(self) -> bool;
}

/// What can be done with any eight numbers.
pub trait SimdKernel {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<N: Lanes>(self) -> Self::Output;
}

/// Eight numbers, in whatever the CPU has for them.
pub trait Lanes: Number<Mask: LaneMask> {
    /// Does the work in a function of its own, which has all registers to itself.
    fn call_no_inline<K: SimdKernel>(kernel: K) -> K::Output;

    /// From memory.
    fn load(numbers: &F32x8) -> Self;

    /// To memory.
    fn store(self) -> F32x8;

    /// One of them: `lane` is less than [`LANES`].
    ///
    /// # Panics
    /// If it is not; but it may also be answered with another one.
    #[inline(always)]
    fn lane(self, lane: usize) -> f32 {
        self.store().0[lane]
    }

    /// One of them, everywhere. As [`lane`](Self::lane).
    #[inline(always)]
    fn splat_lane(self, lane: usize) -> Self {
        Self::splat(self.lane(lane))
    }

    /// One of them in each place: the one whose number is the lowest three bits of what `lanes` has there.
    #[inline(always)]
    fn gather(self, lanes: Self) -> Self {
        let (mut picked, numbers, lanes) = (F32x8::ZERO, self.store(), lanes.store());
        for (picked, lane) in picked.0.iter_mut().zip(lanes.0) {
            *picked = numbers.0[lane.to_bits() as usize % LANES];
        }
        Self::load(&picked)
    }

    /// The greatest of them; none is NaN.
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        self.store().reduce_max()
    }

    /// The answers that these [bits](LaneMask::bits) stand for.
    fn mask_from_bits(bits: u32) -> Self::Mask;

    /// Whether the number has these bits.
    fn has_bits(self, bits: u32) -> Self::Mask;

    /// The least of each eight; none is NaN.
    #[inline(always)]
    fn min_of_each(eights: &[Self; LANES]) -> Self {
        let mut min = F32x8([0.0; LANES]);
        for (min, eight) in min.0.iter_mut().zip(eights) {
            *min = eight.store().reduce_min();
        }
        Self::load(&min)
    }

    /// The greatest of each eight; none is NaN.
    #[inline(always)]
    fn max_of_each(eights: &[Self; LANES]) -> Self {
        let mut max = F32x8([0.0; LANES]);
        for (max, eight) in max.0.iter_mut().zip(eights) {
            *max = eight.store().reduce_max();
        }
        Self::load(&max)
    }
}

/// Eight answers.
pub trait LaneMask: Mask {
    /// A bit for each, 1 for yes; the first is the lowest.
    fn bits(self) -> u32;
}

impl Number for f32 {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.floor()
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT] {
        formula(numbers)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn all(self) -> bool {
        self
    }
}

/// How many numbers go side by side.
pub const LANES: usize = 8;

/// A bit for each of them.
pub const ALL: u32 = (1 << LANES) - 1;

/// Which bits are set, the lowest first.
#[inline(always)]
pub fn set_bits(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = bits.trailing_zeros() as usize % LANES;
        let is_any = bits != 0;
        bits &= bits.wrapping_sub(1);
        is_any.then_some(lowest)
    })
}

/// Eight numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct F32x8(pub [f32; LANES]);

/// Eight answers: all bits of one are set for yes, none for no.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Mask32x8([u32; LANES]);

macro_rules! eight_by_eight {
    ($($operation:ident $function:ident $operator:tt)*) => {
        $(impl $operation for F32x8 {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane] $operator other.0[lane]))
            }
        })*
    };
}

eight_by_eight! { Add add + Sub sub - Mul mul * Div div / }

impl Neg for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl F32x8 {
    /// Eight times nothing.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// The least of them; none is NaN.
    #[inline(always)]
    pub fn reduce_min(self) -> f32 {
        let Self([a, b, c, d, e, f, g, h]) = self;
        let min = <f32 as Number>::min;
        min(min(min(a, b), min(c, d)), min(min(e, f), min(g, h)))
    }

    /// The greatest of them; none is NaN.
    #[inline(always)]
    pub fn reduce_max(self) -> f32 {
        let Self([a, b, c, d, e, f, g, h]) = self;
        let max = <f32 as Number>::max;
        max(max(max(a, b), max(c, d)), max(max(e, f), max(g, h)))
    }

    #[inline(always)]
    fn compare(self, other: Self, compare: impl Fn(f32, f32) -> bool) -> Mask32x8 {
        Mask32x8(from_fn(|lane| if compare(self.0[lane], other.0[lane]) { u32::MAX } else { 0 }))
    }
}

impl Number for F32x8 {
    type Mask = Mask32x8;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self(self.0.map(f32::floor))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask32x8 {
        self.compare(other, |a, b| a < b)
    }

    #[inline(always)]
    fn le(self, other: Self) -> Mask32x8 {
        self.compare(other, |a, b| a <= b)
    }

    #[inline(always)]
    fn select(Mask32x8(mask): Mask32x8, Self(yes): Self, Self(no): Self) -> Self {
        let bits = |lane: usize| (yes[lane].to_bits() & mask[lane]) | (no[lane].to_bits() & !mask[lane]);
        Self(from_fn(|lane| f32::from_bits(bits(lane))))
    }

    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT] {
        let mut results = [Self([0.0; LANES]); OUT];
        for lane in 0..LANES {
            let formula = formula(numbers.map(|numbers| numbers.0[lane]));
            for (results, result) in results.iter_mut().zip(formula) {
                results.0[lane] = result;
            }
        }
        results
    }
}

impl Lanes for F32x8 {
    #[inline(never)]
    fn call_no_inline<K: SimdKernel>(kernel: K) -> K::Output {
        kernel.run::<Self>()
    }

    #[inline(always)]
    fn load(numbers: &F32x8) -> Self {
        *numbers
    }

    #[inline(always)]
    fn store(self) -> F32x8 {
        self
    }

    #[inline(always)]
    fn mask_from_bits(bits: u32) -> Mask32x8 {
        Mask32x8(from_fn(|lane| if bits >> lane & 1 == 1 { u32::MAX } else { 0 }))
    }

    #[inline(always)]
    fn has_bits(self, bits: u32) -> Mask32x8 {
        Mask32x8(self.0.map(|number| if number.to_bits() == bits { u32::MAX } else { 0 }))
    }
}

impl LaneMask for Mask32x8 {
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.into_iter().rev().fold(0, |bits, lane| bits << 1 | lane & 1)
    }
}

impl BitAnd for Mask32x8 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

impl BitOr for Mask32x8 {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] | other.0[lane]))
    }
}

impl Not for Mask32x8 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}

impl Mask for Mask32x8 {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.into_iter().fold(0, |any, lane| any | lane) != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.0.into_iter().fold(u32::MAX, |all, lane| all & lane) != 0
    }
}
