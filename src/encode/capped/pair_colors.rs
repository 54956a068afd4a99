//! Pairs of colours of a frame's palette: their keys, and the errors with which they show cells.

use super::colors::FramePalette;
use super::{ActiveCell, ExchangeRate, error};
use crate::grid::HalfBlocks;

/// The number of possible keys of pairs.
// A key consists of the numbers of two colours, eight bits each.
pub(super) const KEYS: usize = 1 << 16;

/// The palette, and how its colours may be combined.
pub(super) struct PairColors<'a> {
    pub(super) palette: &'a FramePalette,
    pub(super) rate: ExchangeRate,
    pub(super) half_blocks: HalfBlocks,
}

impl PairColors<'_> {
    /// Returns the key of a pair: the numbers of its upper and lower colour.
    ///
    /// They are in ascending order if cells may use either half block, because one pen then shows both orders.
    pub(super) fn key(&self, upper: u8, lower: u8) -> u16 {
        let (a, b) =
            if self.half_blocks == HalfBlocks::Either && lower < upper { (lower, upper) } else { (upper, lower) };
        u16::from(a) << 8 | u16::from(b)
    }

    /// Returns the least weighted error with which a pair shows a cell, and the halves' colours.
    #[inline]
    pub(super) fn cheapest(&self, key: u16, cell: &ActiveCell) -> (f32, [u8; 2]) {
        let [a, b] = key.to_be_bytes();
        let [upper, lower] = [a, b].map(|color| self.palette.color(color));
        let plain = cell.weight * error([upper, lower], cell.channels);
        if a == b || self.half_blocks == HalfBlocks::Lower {
            return (plain, [a, b]);
        }
        let flipped = cell.weight * error([lower, upper], cell.channels);
        if flipped < plain { (flipped, [b, a]) } else { (plain, [a, b]) }
    }
}

/// Returns whether the two colours of a pair are the same.
pub(super) fn is_flat(key: u16) -> bool {
    key >> 8 == key & 255
}

/// Returns the number of bytes of a glyph: a space or a half block.
pub(super) fn glyph_len(key: u16) -> f32 {
    // In UTF-8.
    if is_flat(key) { 1.0 } else { 3.0 }
}
