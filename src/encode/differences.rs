//! The cells in which the wanted grid's picture differs from the shown grid, and the wanted text.

use super::halves::{Halves, picture_halves, squared_difference};
use crate::grid::{Grid, PackedInk};

/// The picture cells that differ, in reading order, and the cells of the wanted text.
#[derive(Default)]
pub(super) struct Differences {
    /// The index of each cell in the grid.
    pub(super) places: Vec<u32>,
    pub(super) wanted: Vec<Halves>,
    /// The halves that the terminal shows; [`UNKNOWN`] if the cell shows text or is unknown.
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

/// The shown halves of a cell that shows text or is unknown.
pub(super) const UNKNOWN: Halves = [PackedInk::DEFAULT; 2];

impl Differences {
    /// Lists the differences of two grids of equal size.
    pub(super) fn find(&mut self, shown: &Grid, wanted: &Grid) {
        let Self { places, wanted: wanted_halves, shown: shown_halves, squares, text, appearing } = self;
        for list in [&mut *places, text] {
            list.clear();
        }
        for list in [&mut *wanted_halves, shown_halves] {
            list.clear();
        }
        for (at, (&shown, &wanted)) in (0..).zip(shown.packed().iter().zip(wanted.packed())) {
            let Some(halves) = picture_halves(wanted) else {
                text.push(at);
                continue;
            };
            if shown == wanted {
                continue;
            }
            let halves_shown = picture_halves(shown).unwrap_or(UNKNOWN);
            if halves_shown != halves {
                places.push(at);
                wanted_halves.push(halves);
                shown_halves.push(halves_shown);
            }
        }
        squares.clear();
        squares.resize(places.len(), [0; 2]);
        // All halves in one flat list, so that the compiler vectorises the loop.
        let halves = shown_halves.as_flattened().iter().zip(wanted_halves.as_flattened());
        for (square, (&shown, &wanted)) in squares.as_flattened_mut().iter_mut().zip(halves) {
            *square = squared_difference(shown, wanted);
        }
        *appearing = 0;
        for (squares, _) in squares.iter_mut().zip(&*shown_halves).filter(|&(_, &shown)| shown == UNKNOWN) {
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
