//! The text attributes of a cell.

use std::fmt;
use std::ops::{BitAnd, BitOr, BitXor};

/// A set of text attributes: bold, underlined and so on.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Attributes(u16);

impl Attributes {
    /// More intense, or heavier.
    pub const BOLD: Self = Self(1);
    /// Less intense.
    pub const DIM: Self = Self(1 << 1);
    /// Slanted.
    pub const ITALIC: Self = Self(1 << 2);
    /// With a line below.
    pub const UNDERLINED: Self = Self(1 << 3);
    /// Blinking, less than 150 times a minute.
    pub const SLOW_BLINK: Self = Self(1 << 4);
    /// Blinking, 150 times a minute or more.
    pub const RAPID_BLINK: Self = Self(1 << 5);
    /// With its two colours exchanged.
    pub const REVERSED: Self = Self(1 << 6);
    /// Not shown.
    pub const HIDDEN: Self = Self(1 << 7);
    /// With a line through the middle.
    pub const CROSSED_OUT: Self = Self(1 << 8);

    /// Each attribute and its name, in the order of SGR's codes, which are 1 to 9.
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

    /// Returns the set without any.
    #[doc(hidden)]
    pub const fn empty() -> Self {
        Self(0)
    }

    /// Returns the set of all nine.
    #[doc(hidden)]
    pub const fn all() -> Self {
        Self((1 << Self::NAMES.len()) - 1)
    }

    /// Returns the attributes of these bits, [`BOLD`](Self::BOLD) first; the seven highest mean nothing.
    #[doc(hidden)]
    pub const fn from_bits_truncate(bits: u16) -> Self {
        Self(bits & Self::all().0)
    }

    /// Returns its bits, [`BOLD`](Self::BOLD) first.
    #[doc(hidden)]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Returns whether there are none.
    #[doc(hidden)]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns whether all of `other` are in this set.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns what is in either set.
    #[doc(hidden)]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns what is in this set and not in `other`.
    #[doc(hidden)]
    pub const fn difference(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Adds all of `other`.
    #[doc(hidden)]
    pub const fn insert(&mut self, other: Self) {
        *self = self.union(other);
    }

    /// Takes all of `other` away.
    #[doc(hidden)]
    pub const fn remove(&mut self, other: Self) {
        *self = self.difference(other);
    }

    /// Returns the attributes one by one, in the order of SGR's codes.
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

/// Its names: `BOLD | ITALIC`.
impl fmt::Debug for Attributes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Self::NAMES.into_iter().filter(|&(one, _)| self.contains(one)).map(|(_, name)| name);
        f.write_str(&names.collect::<Vec<_>>().join(" | "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_attribute_has_a_bit_of_its_own() {
        let apart: Vec<_> = Attributes::all().iter().collect();
        for (at, &one) in apart.iter().enumerate() {
            let before: Attributes = apart[..at].iter().copied().collect();
            assert!(!one.is_empty() && (before & one).is_empty(), "{one:?}");
        }
        assert_eq!(apart.into_iter().collect::<Attributes>(), Attributes::all());
        assert_eq!(Attributes::from_bits_truncate(u16::MAX), Attributes::all());
    }

    #[test]
    fn sets_are_told_apart() {
        let (bold, line) = (Attributes::BOLD, Attributes::UNDERLINED);
        let mut both = bold | line;
        assert!(both.contains(line) && !both.contains(line | Attributes::DIM));
        assert_eq!((both ^ bold, both.difference(line), both & line), (line, bold, line));
        assert_eq!(format!("{both:?}"), "BOLD | UNDERLINED");
        both.remove(bold);
        assert_eq!(both, line);
    }
}
