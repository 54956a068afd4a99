//! The operations of tapes, and the indices of their operands.

/// The number of slots for x, y, z and the time, in front of those of the operations.
pub(super) const COORDINATES: usize = 4;

/// The index of a value: first the coordinates, then the operations; constants start at
/// [`FIRST_CONSTANT`].
///
/// While a tape is built, it is the index of a term.
pub(super) type Index = u16;

/// The index of the first constant, which is above that of each operation.
pub(super) const FIRST_CONSTANT: Index = 1 << 13;

/// An operation of a tape.
// 6 bytes: with its constants, the longest formula that moves takes 58 KB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Operation {
    Unary(Unary, Index),
    Binary(Binary, Index, Index),
}

/// A function of one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Unary {
    Negate,
    Abs,
    Square,
    Sqrt,
    /// The square root of an operand that is known to be at least 0.
    SqrtOfNonNegative,
    Cbrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Atan,
    Floor,
    /// 0 for negative operands, else 1.
    Step,
}

/// A function of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    Atan2,
}

impl Operation {
    /// Returns whether the value is often that of one operand, or its negative.
    pub(super) fn is_choice(self) -> bool {
        matches!(self, Self::Unary(Unary::Abs, _) | Self::Binary(Binary::Min | Binary::Max, ..))
    }

    /// Returns whether the sign depends on the signs of the operands only.
    pub(super) fn combines_signs(self) -> bool {
        matches!(self, Self::Unary(Unary::Negate, _) | Self::Binary(Binary::Min | Binary::Max, ..))
    }

    /// Returns whether the operation has only arithmetic, roots, comparisons and rounding.
    pub(super) fn is_algebraic(self) -> bool {
        use Unary::{Asin, Atan, Cos, Exp, Ln, Sin, Tan};
        !matches!(self, Self::Unary(Asin | Atan | Cos | Exp | Ln | Sin | Tan, _) | Self::Binary(Binary::Atan2, ..))
    }

    /// Returns the cosine for the sine of an angle, and the sine for the cosine.
    pub(super) fn twin(self) -> Option<Self> {
        match self {
            Self::Unary(Unary::Sin, a) => Some(Self::Unary(Unary::Cos, a)),
            Self::Unary(Unary::Cos, a) => Some(Self::Unary(Unary::Sin, a)),
            _ => None,
        }
    }

    /// Returns the operation with its constant last, if it is a sum or product with one.
    pub(super) fn with_constant_last(self) -> Self {
        match self {
            Self::Binary(function @ (Binary::Add | Binary::Multiply), a, b) if a >= FIRST_CONSTANT => {
                Self::Binary(function, b, a)
            }
            _ => self,
        }
    }

    /// Returns the operands; a unary operation's operand twice.
    pub(super) fn operands(self) -> [Index; 2] {
        match self {
            Self::Unary(_, a) => [a, a],
            Self::Binary(_, a, b) => [a, b],
        }
    }

    /// Returns the operation with other operands.
    pub(super) fn with_operands(self, mut place: impl FnMut(Index) -> Index) -> Self {
        match self {
            Self::Unary(function, a) => Self::Unary(function, place(a)),
            Self::Binary(function, a, b) => Self::Binary(function, place(a), place(b)),
        }
    }
}
