//! Cells as grids keep them, in 16 bytes.

use super::{Attributes, Cell, Glyph, Ink};
use crate::color::Srgb8;
use std::sync::Arc;

/// A colour in 32 bits: its kind in the highest eight, and its value below.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct PackedInk(u32);

impl PackedInk {
    pub(crate) const DEFAULT: Self = Self(0);
    const INDEXED: u32 = 1 << 24;
    const RGB: u32 = 2 << 24;

    pub(crate) const fn rgb(Srgb8 { r, g, b }: Srgb8) -> Self {
        Self(Self::RGB | u32::from_be_bytes([0, r, g, b]))
    }

    const fn new(ink: Ink) -> Self {
        match ink {
            Ink::Default => Self::DEFAULT,
            Ink::Indexed(index) => Self(Self::INDEXED | index as u32),
            Ink::Rgb(color) => Self::rgb(color),
        }
    }

    /// Returns red, green and blue of a colour in truecolor.
    #[inline]
    pub(crate) const fn channels(self) -> [u8; 3] {
        let [_, r, g, b] = self.0.to_be_bytes();
        [r, g, b]
    }

    /// Returns the colour as a number.
    #[inline]
    pub(crate) const fn bits(self) -> u32 {
        self.0
    }

    #[inline]
    pub(crate) const fn is_rgb(self) -> bool {
        self.0 >= Self::RGB
    }

    #[inline]
    pub(crate) fn ink(self) -> Ink {
        match self.0.to_be_bytes() {
            [0, ..] => Ink::Default,
            [1, .., index] => Ink::Indexed(index),
            [_, r, g, b] => Ink::Rgb(Srgb8 { r, g, b }),
        }
    }
}

impl From<Ink> for PackedInk {
    fn from(ink: Ink) -> Self {
        Self::new(ink)
    }
}

/// A cell in 16 bytes.
///
/// A cluster is stored as its index in the list of the cell's grid, so the cell is valid in that grid only.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackedCell {
    /// The glyph and the attributes.
    // From the highest bit: a flag for clusters, nine attributes, and in 22 bits the character, the index of the
    // cluster, or a number beyond all characters.
    glyph_and_attributes: u32,
    pub(crate) fg: PackedInk,
    pub(crate) bg: PackedInk,
    pub(crate) underline: PackedInk,
}

/// Compares all bits at once.
// The derived comparison tests field by field, and frames are compared cell by cell.
impl PartialEq for PackedCell {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        let halves = |cell: &Self| {
            let pair = |a: u32, b: u32| u64::from(a) << 32 | u64::from(b);
            [pair(cell.glyph_and_attributes, cell.fg.0), pair(cell.bg.0, cell.underline.0)]
        };
        let ([a, b], [other_a, other_b]) = (halves(self), halves(other));
        (a ^ other_a) | (b ^ other_b) == 0
    }
}

impl Eq for PackedCell {}

/// The number of bits of a glyph.
// The nine attributes and the flag for clusters take the other ten of the 32 bits. A character needs 21 of these 22.
const GLYPH_BITS: u32 = 22;
const GLYPH_MASK: u32 = (1 << GLYPH_BITS) - 1;
const CLUSTER: u32 = 1 << 31;
/// The glyph of a cell covered by the wide character before it; above the last character, U+10FFFF.
const COVERED: u32 = 0x11_0000;
const FOREIGN: u32 = COVERED + 1;

impl PackedCell {
    pub(crate) const BLANK: Self = Self::new(' ', PackedInk::DEFAULT, PackedInk::DEFAULT);
    pub(crate) const FOREIGN: Self = Self { glyph_and_attributes: FOREIGN, ..Self::BLANK };

    /// Returns a cell with a character in these colours, without attributes.
    pub(crate) const fn new(character: char, fg: PackedInk, bg: PackedInk) -> Self {
        Self { glyph_and_attributes: character as u32, fg, bg, underline: PackedInk::DEFAULT }
    }

    /// Returns the glyph and the attributes in one number.
    ///
    /// Without attributes it is the code point of the character.
    #[inline]
    pub(crate) const fn glyph_and_attributes(self) -> u32 {
        self.glyph_and_attributes
    }

    /// Returns whether the glyph is this character.
    #[inline]
    pub(crate) const fn has_char(self, character: char) -> bool {
        self.glyph_and_attributes & (GLYPH_MASK | CLUSTER) == character as u32
    }

    /// Returns the character; `None` for other glyphs.
    #[inline]
    pub(crate) fn character(self) -> Option<char> {
        if self.is_cluster() { None } else { char::from_u32(self.glyph_and_attributes & GLYPH_MASK) }
    }

    #[inline]
    pub(crate) const fn is_cluster(self) -> bool {
        self.glyph_and_attributes & CLUSTER != 0
    }

    #[inline]
    pub(crate) const fn is_covered(self) -> bool {
        self.glyph_and_attributes & (GLYPH_MASK | CLUSTER) == COVERED
    }

    #[inline]
    pub(crate) const fn is_foreign(self) -> bool {
        self.glyph_and_attributes & (GLYPH_MASK | CLUSTER) == FOREIGN
    }

    #[inline]
    pub(crate) const fn attributes(self) -> Attributes {
        Attributes::from_bits_truncate((self.glyph_and_attributes >> GLYPH_BITS) as u16)
    }

    /// Returns a 32-bit hash of the cell, which does not depend on the text of a cluster.
    #[inline]
    pub(crate) const fn digest(self) -> u32 {
        let code = if self.is_cluster() { self.glyph_and_attributes & !GLYPH_MASK } else { self.glyph_and_attributes };
        // Multiplicative hashing (Knuth 1973). Each step is a bijection, so two cells that differ in one field have
        // different hashes.
        let mixed = code.wrapping_mul(0x9e37_79b1);
        let mixed = (mixed ^ mixed >> 15 ^ self.fg.0).wrapping_mul(0x85eb_ca77);
        let mixed = (mixed ^ mixed >> 13 ^ self.bg.0).wrapping_mul(0xc2b2_ae3d);
        (mixed ^ mixed >> 16 ^ self.underline.0).wrapping_mul(0x9e37_79b1)
    }

    /// Returns the cell with the glyph of `other`.
    pub(crate) const fn with_glyph_of(self, other: Self) -> Self {
        let glyph = GLYPH_MASK | CLUSTER;
        Self { glyph_and_attributes: self.glyph_and_attributes & !glyph | other.glyph_and_attributes & glyph, ..self }
    }

    /// Returns the cell with a blank instead of its glyph.
    pub(super) const fn blanked(self) -> Self {
        Self { glyph_and_attributes: self.glyph_and_attributes & !(GLYPH_MASK | CLUSTER) | ' ' as u32, ..self }
    }
}

/// The grapheme clusters of a grid.
#[derive(Debug, Default)]
pub(super) struct Clusters(Vec<Arc<str>>);

impl Clone for Clusters {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    fn clone_from(&mut self, other: &Self) {
        self.0.clone_from(&other.0);
    }
}

impl Clusters {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns whether the list is long enough that unused clusters have to be dropped.
    pub(super) fn is_crowded(&self, cell_count: usize) -> bool {
        // At least half of the clusters are then unused, because a cell has at most one. Dropping them takes a pass
        // over all cells; the minimum of 64 clusters keeps small grids from doing that too often.
        self.0.len() > 2 * cell_count.max(32)
    }

    /// Drops the clusters that no cell has.
    pub(super) fn drop_unused(&mut self, cells: &mut [PackedCell]) {
        let all = std::mem::take(&mut self.0);
        for cell in cells.iter_mut().filter(|cell| cell.is_cluster()) {
            cell.glyph_and_attributes = self.add(all[(cell.glyph_and_attributes & GLYPH_MASK) as usize].clone())
                | cell.glyph_and_attributes & !(GLYPH_MASK | CLUSTER);
        }
    }

    /// Returns the text of a cell's cluster; `None` for other glyphs.
    #[inline]
    pub(super) fn text(&self, cell: PackedCell) -> Option<&Arc<str>> {
        if cell.is_cluster() { self.0.get((cell.glyph_and_attributes & GLYPH_MASK) as usize) } else { None }
    }

    /// Packs a cell.
    #[inline]
    pub(super) fn pack(&mut self, cell: &Cell) -> PackedCell {
        let glyph = match &cell.glyph {
            Glyph::Char(character) => u32::from(*character),
            Glyph::Cluster(text) => self.add(text.clone()),
            Glyph::Covered => COVERED,
            Glyph::Foreign => FOREIGN,
        };
        let attributes = u32::from(cell.attributes.bits()) << GLYPH_BITS;
        let [fg, bg, underline] = [cell.fg, cell.bg, cell.underline].map(PackedInk::new);
        PackedCell { glyph_and_attributes: glyph | attributes, fg, bg, underline }
    }

    /// Adds a cluster, and returns its code.
    // A grid of more than four million clusters shows some of them as U+FFFD.
    fn add(&mut self, text: Arc<str>) -> u32 {
        let index = self.0.len() as u32;
        if index > GLYPH_MASK {
            return u32::from(char::REPLACEMENT_CHARACTER);
        }
        self.0.push(text);
        CLUSTER | index
    }

    /// Unpacks a cell, including the text of its cluster.
    #[inline]
    pub(super) fn unpack(&self, cell: PackedCell) -> Cell {
        let glyph = match (cell.character(), self.text(cell)) {
            (Some(character), _) => Glyph::Char(character),
            (None, Some(text)) => Glyph::Cluster(text.clone()),
            (None, None) if cell.is_covered() => Glyph::Covered,
            (None, None) => Glyph::Foreign,
        };
        let [fg, bg, underline] = [cell.fg, cell.bg, cell.underline].map(PackedInk::ink);
        Cell { glyph, fg, bg, underline, attributes: cell.attributes() }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
