//! The parts of a cell that a block character fills, for exports that draw them.

use super::blocks::quadrant;
use super::octants::octant;
use super::sextants::sextant;

/// The parts of a cell that a block character fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BlockParts {
    /// The number of parts, across and down.
    pub(crate) parts: [usize; 2],
    /// The mask of filled parts. Bit 0 is the upper left part; the others follow row by row.
    pub(crate) mask: u8,
}

/// Returns the parts that a block character fills; `None` for other characters.
pub(crate) fn block_parts(glyph: char) -> Option<BlockParts> {
    let of = |parts, mask| Some(BlockParts { parts, mask });
    let found = |glyph_of: fn(u8) -> char| (0..=u8::MAX).find(|&mask| glyph_of(mask) == glyph);
    // U+2581 to U+2587 fill one to seven eighths from below, and U+2589 to U+258F seven eighths to one from the left.
    match glyph {
        '▁'..='▇' => of([1, 8], !(0xff >> (glyph as u32 - '▀' as u32))),
        '▉'..='▏' => of([8, 1], 0xff >> (glyph as u32 - '█' as u32)),
        '▀' | '█' | '▐' | '▖'..='▟' => of([2, 2], found(quadrant)?),
        '\u{1FB00}'..='\u{1FB3B}' => of([2, 3], found(sextant)?),
        '\u{1CD00}'..='\u{1CEAB}' | '\u{1FB82}'..='\u{1FBE7}' => of([2, 4], found(octant)?),
        _ => None,
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
