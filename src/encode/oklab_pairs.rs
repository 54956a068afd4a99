//! Pairs of shown and wanted halves, which are compared in OKLab all together.

use super::eights::ColorList;
use super::halves::{Halves, Tolerance};
use crate::grid::PackedInk;

/// The shown and the wanted halves of some cells, and whether they are near.
#[derive(Default)]
pub(super) struct OklabPairs {
    shown: Vec<PackedInk>,
    wanted: Vec<PackedInk>,
    colors: [ColorList; 2],
    /// The masks of the halves within the tolerance, eight halves each.
    near: Vec<u8>,
}

impl OklabPairs {
    /// Takes the halves of cells, `[shown, wanted]` each, in place of the last ones, and compares
    /// them.
    pub(super) fn compare(&mut self, cells: impl Iterator<Item = [Halves; 2]>, tolerance: Tolerance) {
        self.shown.clear();
        self.wanted.clear();
        for [shown, wanted] in cells {
            self.shown.extend(shown);
            self.wanted.extend(wanted);
        }
        let [shown, wanted] = &mut self.colors;
        shown.fill(&self.shown);
        wanted.fill(&self.wanted);
        shown.compare(wanted, tolerance, &mut self.near);
    }

    /// Returns for each cell, in the order of the comparison, whether both halves are within the
    /// tolerance.
    pub(super) fn are_near(&self) -> impl Iterator<Item = bool> {
        self.near.iter().flat_map(|mask| [0, 2, 4, 6].map(|place| mask >> place & 3 == 3))
    }
}
