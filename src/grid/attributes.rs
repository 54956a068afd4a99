//! The text attributes of a cell.

use std::fmt;
use std::ops::{BitAnd, BitOr, BitXor};

/// A set of text attributes: bold, underlined and so on.
// A type of its own instead of ratatui's `Modifier`, so that grids and the encoder do not depend on ratatui.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Attributes(u16);

impl Attributes {
    /// Bold: more intense, or heavier (SGR 1).
    pub const BOLD: Self = Self(1);
    /// Dim: less intense (SGR 2).
    pub const DIM: Self = Self(1 << 1);
    /// Italic (SGR 3).
    pub const ITALIC: Self = Self(1 << 2);
    /// Underlined (SGR 4).
    pub const UNDERLINED: Self = Self(1 << 3);
    /// Blinking less than 150 times a minute (SGR 5).
    pub const SLOW_BLINK: Self = Self(1 << 4);
    /// Blinking 150 times a minute or more (SGR 6).
    pub const RAPID_BLINK: Self = Self(1 << 5);
    /// Reverse video: the colours of glyph and background are exchanged (SGR 7).
    pub const REVERSED: Self = Self(1 << 6);
    /// Hidden (SGR 8).
    pub const HIDDEN: Self = Self(1 << 7);
    /// Crossed out (SGR 9).
    pub const CROSSED_OUT: Self = Self(1 << 8);

    /// The attributes and their names, in the order of their SGR codes 1 to 9.
    const NAMES: [(Self, &'static str); 9] = [
        (Self::BOLD, "BOLD"),
        (Self::DIM, "DIM"),
        (Self::ITALIC, "ITALIC"),
        (Self::UNDERLINED, "UNDERLINED"),
        (Self::SLOW_BLINK, "SLOW_BLINK"),
        (Self::RAPID_BLINK, "RAPID_BLINK"),
        (Self::REVERSED, "REVERSED"),
        (Self::HIDDEN, "HIDDEN"),
        (Self::CROSSED_OUT, "CROSSED_OUT"),
    ];

    /// Returns the empty set.
    #[doc(hidden)]
    pub const fn empty() -> Self {
        Self(0)
    }

    /// Returns the set of all nine attributes.
    #[doc(hidden)]
    pub const fn all() -> Self {
        Self((1 << Self::NAMES.len()) - 1)
    }

    /// Returns the set with these bits; the lowest bit is [`BOLD`](Self::BOLD).
    ///
    /// The highest seven bits are ignored.
    #[doc(hidden)]
    pub const fn from_bits_truncate(bits: u16) -> Self {
        Self(bits & Self::all().0)
    }

    /// Returns the bits of the set; the lowest bit is [`BOLD`](Self::BOLD).
    #[doc(hidden)]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Returns whether the set is empty.
    #[doc(hidden)]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns whether all attributes of `other` are in this set.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the union of both sets.
    #[doc(hidden)]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the attributes of this set that are not in `other`.
    #[doc(hidden)]
    pub const fn difference(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Adds all attributes of `other`.
    #[doc(hidden)]
    pub const fn insert(&mut self, other: Self) {
        *self = self.union(other);
    }

    /// Removes all attributes of `other`.
    #[doc(hidden)]
    pub const fn remove(&mut self, other: Self) {
        *self = self.difference(other);
    }

    /// Returns an iterator over the attributes, each as a set of its own, in the order of their SGR
    /// codes.
    #[doc(hidden)]
    pub fn iter(self) -> impl Iterator<Item = Self> {
        Self::NAMES.into_iter().map(|(one, _)| one).filter(move |&one| self.contains(one))
    }
}

impl BitOr for Attributes {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.union(other)
    }
}

impl BitAnd for Attributes {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitXor for Attributes {
    type Output = Self;

    fn bitxor(self, other: Self) -> Self {
        Self(self.0 ^ other.0)
    }
}

impl FromIterator<Self> for Attributes {
    fn from_iter<I: IntoIterator<Item = Self>>(sets: I) -> Self {
        sets.into_iter().fold(Self::empty(), Self::union)
    }
}

/// Writes the names of the attributes, such as `BOLD | ITALIC`.
impl fmt::Debug for Attributes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Self::NAMES.into_iter().filter(|&(one, _)| self.contains(one)).map(|(_, name)| name);
        f.write_str(&names.collect::<Vec<_>>().join(" | "))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
