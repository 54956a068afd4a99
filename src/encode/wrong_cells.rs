//! The cells that are visibly wrong after a frame under a limit of bytes.

use super::differences::Differences;
use super::halves::{Halves, NO_PICTURE, Tolerance, picture_halves};
use super::oklab_pairs::OklabPairs;
use crate::grid::Grid;

/// The largest distance in OKLab of a half that is not wrong.
pub(super) const VISIBLE: f32 = 0.02;

/// The cells that are not exact after a frame, and those of them that are wrong.
#[derive(Default)]
pub(super) struct WrongCells {
    /// The indices in the grid of the cells that are not exact.
    inexact: Vec<u32>,
    /// Their halves, `[shown, wanted]`.
    halves: Vec<[Halves; 2]>,
    pairs: OklabPairs,
    wrong: Vec<u32>,
}

impl WrongCells {
    /// Lists the indices in the grid of the picture cells that differ visibly, in ascending order.
    ///
    /// `shown` is the grid after a frame, and `differences` are those before it.
    // A large difference in sRGB does not spare the comparison in OKLab: of random colours whose squared difference is
    // 1,000, one in 77 is within the distance.
    pub(super) fn find(&mut self, shown: &Grid, differences: &Differences) -> &[u32] {
        let Self { inexact, halves, pairs, wrong } = self;
        inexact.clear();
        halves.clear();
        for (&place, &wanted) in differences.places.iter().zip(&differences.wanted) {
            let shown = picture_halves(shown.packed()[place as usize]).unwrap_or(NO_PICTURE);
            if shown != wanted {
                inexact.push(place);
                halves.push([shown, wanted]);
            }
        }
        // The error of the cube roots is not subtracted: at the very limit either answer will do.
        pairs.compare(halves.iter().copied(), Tolerance { distance: VISIBLE, square: u32::MAX });
        wrong.clear();
        wrong.extend(inexact.iter().zip(pairs.are_near()).filter(|&(_, is_near)| !is_near).map(|(&place, _)| place));
        wrong
    }

    /// Returns whether the last frame left all cells of the picture exact.
    pub(super) fn are_all_exact(&self) -> bool {
        self.inexact.is_empty()
    }
}
