//! Numbers and vectors of eight numbers: a formula over [`Number`] computes one ray or eight.
//!
//! All operations are exactly defined by IEEE 754, so that a ray gives the same bits alone and among eight. [`F32x8`]
//! is a plain array for any CPU; the types of [`simd`](crate::simd) are registers.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

mod vector;

pub use vector::Vector;

/// A number, or a vector of numbers with lane-wise operations.
pub trait Number: Copy + Debug + Neg<Output = Self>
where
    Self: Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>,
{
    /// The result of a comparison.
    type Mask: Mask;

    /// Returns `value` in all lanes.
    fn splat(value: f32) -> Self;

    /// Returns the square root.
    fn sqrt(self) -> Self;

    /// Returns the absolute value.
    fn abs(self) -> Self;

    /// Returns the largest integer not above the number.
    fn floor(self) -> Self;

    /// Compares with `<`; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;

    /// Compares with `<=`; false for NaN.
    fn le(self, other: Self) -> Self::Mask;

    /// Returns `yes` where the mask is set, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Applies a scalar formula lane by lane: for rare cases that have no vector form.
    fn map_lanes<const IN: usize, const OUT: usize>(
        numbers: [Self; IN],
        formula: impl Fn([f32; IN]) -> [f32; OUT],
    ) -> [Self; OUT];

    /// Compares with `==`; false for NaN.
    #[inline(always)]
    fn eq(self, other: Self) -> Self::Mask {
        // `eq` takes two comparisons instead of an instruction of its own in each register type, as only ties of hits
        // and patterns use it.
        self.le(other) & other.le(self)
    }

    /// Returns the larger number.
    ///
    /// Returns `other` if `self` is NaN or both are zero, as the instructions of SSE and AVX do.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// Returns the smaller number; `other` if `self` is NaN or both are zero.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
}

/// The result of a comparison: a boolean per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns whether any lane is set.
    fn any(self) -> bool;

    /// Returns whether all lanes are set.
    fn all(self) -> bool;
}

/// A computation that is compiled once for each vector type.
pub trait SimdKernel {
    /// The result.
    type Output;

    /// Runs the kernel with vectors of type `N`.
    fn run<N: Lanes>(self) -> Self::Output;
}

/// A vector of eight numbers, in an array or in registers.
pub trait Lanes: Number<Mask: LaneMask> {
    /// Runs the kernel in a function that is not inlined, but has the caller's target features.
    // When single-ray traversal was inlined into packet traversal, its vectors were in memory instead of in registers.
    // Not inlined, and with a new slab test and new stack entries, it took 14 % fewer instructions.
    fn call_no_inline<K: SimdKernel>(kernel: K) -> K::Output;

    /// Loads the vector from memory.
    fn load(numbers: &F32x8) -> Self;

    /// Stores the vector to memory.
    fn store(self) -> F32x8;

    /// Returns the number of `lane`, which is less than [`LANES`].
    ///
    /// # Panics
    /// May panic if `lane` is [`LANES`] or more; may also return another lane.
    #[inline(always)]
    fn lane(self, lane: usize) -> f32 {
        self.store().0[lane]
    }

    /// Returns the number of `lane` in all lanes. For the range of `lane` see [`lane`](Self::lane).
    #[inline(always)]
    fn splat_lane(self, lane: usize) -> Self {
        Self::splat(self.lane(lane))
    }

    /// Returns a vector whose lanes are those lanes of `self` that `lanes` selects.
    ///
    /// The lowest three bits of each number in `lanes` are the index of the lane of `self`.
    #[inline(always)]
    fn gather(self, lanes: Self) -> Self {
        let (mut picked, numbers, lanes) = (F32x8::ZERO, self.store(), lanes.store());
        for (picked, lane) in picked.0.iter_mut().zip(lanes.0) {
            *picked = numbers.0[lane.to_bits() as usize % LANES];
        }
        Self::load(&picked)
    }

    /// Returns the largest of the eight numbers, which must not be NaN.
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        self.store().reduce_max()
    }

    /// Returns the mask with these [bits](LaneMask::bits).
    fn mask_from_bits(bits: u32) -> Self::Mask;

    /// Compares the bits of each number with `bits`: for indices that are stored as the bits of
    /// floats.
    fn eq_bits(self, bits: u32) -> Self::Mask;

    /// Returns the smallest number of each of eight vectors, one per lane. Numbers must not be NaN.
    #[inline(always)]
    fn min_of_each(eights: &[Self; LANES]) -> Self {
        let mut min = F32x8([0.0; LANES]);
        for (min, eight) in min.0.iter_mut().zip(eights) {
            *min = eight.store().reduce_min();
        }
        Self::load(&min)
    }

    /// Returns the largest number of each of eight vectors, one per lane. Numbers must not be NaN.
    #[inline(always)]
    fn max_of_each(eights: &[Self; LANES]) -> Self {
        let mut max = F32x8([0.0; LANES]);
        for (max, eight) in max.0.iter_mut().zip(eights) {
            *max = eight.store().reduce_max();
        }
        Self::load(&max)
    }
}

/// A mask of eight lanes.
pub trait LaneMask: Mask {
    /// Returns the mask as bits, lane 0 lowest.
    fn bits(self) -> u32;
}

// All operations are `inline(always)`: a function that is not inlined is compiled without the target features of the
// kernel, and its numbers pass through memory.
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

/// The number of lanes in a vector.
// Eight f32 fill a register of AVX2.
pub const LANES: usize = 8;

/// The mask with all lanes set.
pub const ALL: u32 = (1 << LANES) - 1;

/// Returns the indices of the set bits, lowest first.
#[inline(always)]
pub fn set_bits(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        // `% LANES` shows the compiler that the index is below eight, so that callers index arrays without a check.
        let lowest = bits.trailing_zeros() as usize % LANES;
        let is_any = bits != 0;
        // Clears the lowest set bit: one instruction (BLSR) with BMI1.
        bits &= bits.wrapping_sub(1);
        is_any.then_some(lowest)
    })
}

/// A vector of eight numbers in an array, aligned for registers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
// The alignment allows loads and stores of a whole AVX register.
pub struct F32x8(pub [f32; LANES]);

/// A mask of eight lanes in an array: all bits of a set lane are 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Mask32x8([u32; LANES]);

/// Expands to an array whose element `lane` is the value of an expression.
// Written out, because a call of `array::from_fn` is several functions to compile for each operation.
macro_rules! each_lane {
    ($lane:ident => $value:expr) => {
        each_lane!(@ $lane [0 1 2 3 4 5 6 7] $value)
    };
    (@ $lane:ident [$($index:literal)*] $value:expr) => {
        [$({
            let $lane = $index;
            $value
        }),*]
    };
}

macro_rules! eight_by_eight {
    ($($operation:ident $function:ident $operator:tt)*) => {
        $(impl $operation for F32x8 {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(each_lane!(lane => self.0[lane] $operator other.0[lane]))
            }
        })*
    };
}

eight_by_eight! { Add add + Sub sub - Mul mul * Div div / }

impl Neg for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(each_lane!(lane => -self.0[lane]))
    }
}

impl F32x8 {
    /// Zero in all lanes.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// Returns the smallest of the eight numbers, which must not be NaN.
    #[inline(always)]
    pub fn reduce_min(self) -> f32 {
        let Self([a, b, c, d, e, f, g, h]) = self;
        // `Number::min` instead of `f32::min`, which leaves the order of zeros to the platform. The operands are
        // combined in the same order as in registers, because the order decides the bits for NaN and two zeros.
        let min = <f32 as Number>::min;
        min(min(min(a, b), min(c, d)), min(min(e, f), min(g, h)))
    }

    /// Returns the largest of the eight numbers, which must not be NaN.
    #[inline(always)]
    pub fn reduce_max(self) -> f32 {
        let Self([a, b, c, d, e, f, g, h]) = self;
        let max = <f32 as Number>::max;
        max(max(max(a, b), max(c, d)), max(max(e, f), max(g, h)))
    }

    #[inline(always)]
    fn compare(self, other: Self, compare: impl Fn(f32, f32) -> bool) -> Mask32x8 {
        Mask32x8(each_lane!(lane => if compare(self.0[lane], other.0[lane]) { u32::MAX } else { 0 }))
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
        Self(each_lane!(lane => self.0[lane].sqrt()))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(each_lane!(lane => self.0[lane].abs()))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self(each_lane!(lane => self.0[lane].floor()))
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
        // Selects by bits, because the compiler turned branches into scalar code.
        let bits = |lane: usize| (yes[lane].to_bits() & mask[lane]) | (no[lane].to_bits() & !mask[lane]);
        Self(each_lane!(lane => f32::from_bits(bits(lane))))
    }

    // The only operation that need not be inlined, because its formulas are rare and scalar.
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
        Mask32x8(each_lane!(lane => if bits >> lane & 1 == 1 { u32::MAX } else { 0 }))
    }

    #[inline(always)]
    fn eq_bits(self, bits: u32) -> Mask32x8 {
        Mask32x8(each_lane!(lane => if self.0[lane].to_bits() == bits { u32::MAX } else { 0 }))
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
        Self(each_lane!(lane => self.0[lane] & other.0[lane]))
    }
}

impl BitOr for Mask32x8 {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(each_lane!(lane => self.0[lane] | other.0[lane]))
    }
}

impl Not for Mask32x8 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(each_lane!(lane => !self.0[lane]))
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
