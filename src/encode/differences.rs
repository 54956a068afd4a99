//! The cells in which the wanted grid's picture differs from the shown grid, and the wanted text.

use super::halves::{Halves, NO_PICTURE, PictureHalves, squared_difference};
use crate::grid::Grid;

/// The picture cells that differ, in reading order, and the cells of the wanted text.
#[derive(Default)]
pub(super) struct Differences {
    /// The index of each cell in the grid.
    pub(super) places: Vec<u32>,
    pub(super) wanted: Vec<Halves>,
    /// The halves that the terminal shows; [`NO_PICTURE`] if the cell shows text or is unknown.
    pub(super) shown: Vec<Halves>,
    /// The squared differences of both halves; `u32::MAX` for unknown ones.
    pub(super) squares: Vec<[u32; 2]>,
    /// The indices in the grid of the cells that are text in the wanted grid.
    pub(super) text: Vec<u32>,
    /// The number of cells with unknown halves, without vacated ones.
    pub(super) appearing: usize,
}

/// The squared differences of the halves of a cell that the frame itself has vacated.
pub(super) const VACATED: [u32; 2] = [u32::MAX - 1; 2];

impl Differences {
    /// Lists the differences of the shown and the wanted picture.
    pub(super) fn find(&mut self, halves: &PictureHalves) {
        let Self { places, wanted, shown, squares, text, appearing } = self;
        let count = halves.wanted.len();
        text.clear();
        // With room for one more block than the cells need, a whole block can always be written.
        places.resize(count + BLOCK, 0);
        wanted.resize(count + BLOCK, NO_PICTURE);
        shown.resize(count + BLOCK, NO_PICTURE);
        let mut found = 0;
        for (block, cells) in halves.wanted.chunks(BLOCK).zip(halves.shown.chunks(BLOCK)).enumerate() {
            let lists = (&mut places[found..][..BLOCK], &mut wanted[found..][..BLOCK], &mut shown[found..][..BLOCK]);
            found += find_in_block(BLOCK * block, cells, lists, text);
        }
        places.truncate(found);
        wanted.truncate(found);
        shown.truncate(found);
        squares.resize(found, [0; 2]);
        // All halves in one flat list, so that the compiler vectorises the loop.
        let halves = shown.as_flattened().iter().zip(wanted.as_flattened());
        for (square, (&shown, &wanted)) in squares.as_flattened_mut().iter_mut().zip(halves) {
            *square = squared_difference(shown, wanted);
        }
        *appearing = 0;
        for (squares, _) in squares.iter_mut().zip(&*shown).filter(|&(_, &shown)| shown == NO_PICTURE) {
            *squares = [u32::MAX; 2];
            *appearing += 1;
        }
    }

    /// Marks cells, given in reading order, that the frame has vacated by [shifts](super::shifts).
    ///
    /// They are unknown, but were the picture before.
    pub(super) fn mark_vacated(&mut self, vacated: &[u32]) {
        let mut from = 0;
        for place in vacated {
            if let Ok(at) = self.places[from..].binary_search(place) {
                self.squares[from + at] = VACATED;
                self.appearing -= 1;
                from += at + 1;
            }
        }
    }

    /// Returns whether any text differs, or a cell of the wanted picture shows text or is unknown.
    pub(super) fn has_text(&self, shown: &Grid, wanted: &Grid) -> bool {
        let is_other = |&at: &u32| {
            let at = at as usize;
            !shown.is_same(shown.packed()[at], wanted, wanted.packed()[at])
        };
        self.appearing > 0 || self.text.iter().any(is_other)
    }

    /// Copies the wanted text to `grid`, a copy of the shown grid.
    pub(super) fn copy_text(&self, wanted: &Grid, grid: &mut Grid) {
        for &at in &self.text {
            grid.copy_cell(at as usize, wanted, wanted.packed()[at as usize]);
        }
    }
}

/// The number of cells that are compared as a block.
const BLOCK: usize = 8;

/// Writes the differences of a block of cells, `(wanted, shown)`, to the start of the lists.
///
/// Returns their number.
// Every cell is written, and the next one replaces it unless it differs: that takes no branch that depends on the
// picture.
fn find_in_block(
    start: usize,
    (of_wanted, of_shown): (&[Halves], &[Halves]),
    (places, wanted, shown): (&mut [u32], &mut [Halves], &mut [Halves]),
    text: &mut Vec<u32>,
) -> usize {
    let mut found = 0;
    for (at, (&of_wanted, &of_shown)) in (start as u32..).zip(of_wanted.iter().zip(of_shown)) {
        if of_wanted == NO_PICTURE {
            text.push(at);
            continue;
        }
        // Always less; the remainder spares three bounds checks.
        let next = found % BLOCK;
        (places[next], wanted[next], shown[next]) = (at, of_wanted, of_shown);
        found += usize::from(of_shown != of_wanted);
    }
    found
}
