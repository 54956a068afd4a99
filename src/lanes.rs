//! One number, or eight side by side: a formula that is written for any [`Number`] can be asked for one ray or for eight.
//!
//! All that they can do are operations that IEEE 754 defines to the last bit, so that a ray among eight gets the bits that
//! it gets alone. The eight are plain arrays: the compiler makes vector instructions of them. One number may be an f64:
//! where f32 cannot tell, the same formula can.

use glam::Vec3;
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several of which each goes its own way.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The answer to a comparison.
    type Mask: Mask;

    /// The same number everywhere.
    fn splat(value: f32) -> Self;

    /// The square root.
    fn sqrt(self) -> Self;

    /// Without its sign.
    fn abs(self) -> Self;

    /// Whether this is less. NaN is not.
    fn lt(self, other: Self) -> Self::Mask;

    /// Whether this is less, or the same. NaN is not.
    fn le(self, other: Self) -> Self::Mask;

    /// `yes` where the answer was yes, else `no`.
    fn select(answer: Self::Mask, yes: Self, no: Self) -> Self;

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
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether there is a yes among them.
    fn any(self) -> bool;
}

macro_rules! one_number {
    ($($float:ident)*) => {
        $(impl Number for $float {
            type Mask = bool;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                value.into()
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
            fn lt(self, other: Self) -> bool {
                self < other
            }

            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }

            #[inline(always)]
            fn select(answer: bool, yes: Self, no: Self) -> Self {
                if answer { yes } else { no }
            }
        })*
    };
}

one_number! { f32 f64 }

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

/// How many numbers go side by side.
pub const LANES: usize = 8;

/// Eight numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Eight(pub [f32; LANES]);

/// Eight answers: all bits of one are set for yes, none for no.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct EightAnswers([u32; LANES]);

macro_rules! eight_by_eight {
    ($($operation:ident $function:ident $operator:tt)*) => {
        $(impl $operation for Eight {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane] $operator other.0[lane]))
            }
        })*
    };
}

eight_by_eight! { Add add + Sub sub - Mul mul * Div div / }

impl Neg for Eight {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl Eight {
    #[inline(always)]
    fn answers(self, other: Self, ask: impl Fn(f32, f32) -> bool) -> EightAnswers {
        EightAnswers(from_fn(|lane| if ask(self.0[lane], other.0[lane]) { u32::MAX } else { 0 }))
    }
}

impl Number for Eight {
    type Mask = EightAnswers;

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
    fn lt(self, other: Self) -> EightAnswers {
        self.answers(other, |a, b| a < b)
    }

    #[inline(always)]
    fn le(self, other: Self) -> EightAnswers {
        self.answers(other, |a, b| a <= b)
    }

    #[inline(always)]
    fn select(EightAnswers(answers): EightAnswers, Self(yes): Self, Self(no): Self) -> Self {
        let bits = |lane: usize| (yes[lane].to_bits() & answers[lane]) | (no[lane].to_bits() & !answers[lane]);
        Self(from_fn(|lane| f32::from_bits(bits(lane))))
    }
}

impl EightAnswers {
    /// No for all of them.
    pub const NONE: Self = Self([0; LANES]);

    /// The answer for one of them.
    #[inline(always)]
    pub fn of(self, lane: usize) -> bool {
        self.0[lane] != 0
    }

    /// Whether all are yes.
    #[inline(always)]
    pub fn all(self) -> bool {
        self.0.into_iter().fold(u32::MAX, |all, answer| all & answer) != 0
    }
}

impl BitAnd for EightAnswers {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

impl BitOr for EightAnswers {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] | other.0[lane]))
    }
}

impl Not for EightAnswers {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|answer| !answer))
    }
}

impl Mask for EightAnswers {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.into_iter().fold(0, |any, answer| any | answer) != 0
    }
}

/// Three coordinates, each a [`Number`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<N> {
    /// Along x.
    pub x: N,
    /// Along y.
    pub y: N,
    /// Along z.
    pub z: N,
}

impl<N: Number> Vector<N> {
    /// The same vector everywhere.
    #[inline(always)]
    pub fn splat(v: Vec3) -> Self {
        Self { x: N::splat(v.x), y: N::splat(v.y), z: N::splat(v.z) }
    }

    /// The dot product, summed in the order of the coordinates.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
}

impl Vector<Eight> {
    /// Eight vectors side by side.
    #[inline(always)]
    pub fn of(vectors: [Vec3; LANES]) -> Self {
        Self { x: Eight(vectors.map(|v| v.x)), y: Eight(vectors.map(|v| v.y)), z: Eight(vectors.map(|v| v.z)) }
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<N: Number> Mul for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
}
