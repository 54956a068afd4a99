//! The cells that are visibly wrong after a frame under a limit of bytes.

use super::differences::Differences;
use super::halves::{Halves, Tolerance, picture_halves, squared_differences};
use super::oklab_pairs::OklabPairs;
use crate::grid::Grid;

/// The largest distance in OKLab of a half that is not wrong.
const VISIBLE: f32 = 0.02;

/// The squared difference in 8-bit sRGB from which a half is wrong without a comparison in OKLab.
// Of random colours around this difference, one in ten thousand is within the distance. Half of the cells of a frame
// under a tight limit exceed it.
const FAR: u32 = 1000;

/// The cells that are not exact after a frame, and those of them that are wrong.
#[derive(Default)]
pub(super) struct WrongCells {
    /// The cells that are not exact: their indices in the grid, and whether they are far off.
    inexact: Vec<(u32, bool)>,
    /// The halves of those that are not far off, `[shown, wanted]`, which are compared in OKLab.
    undecided: Vec<[Halves; 2]>,
    pairs: OklabPairs,
    wrong: Vec<u32>,
}

impl WrongCells {
    /// Lists the indices in the grid of the picture cells that differ visibly, in ascending order.
    ///
    /// `shown` is the grid after a frame, and `differences` are those before it.
    pub(super) fn find(&mut self, shown: &Grid, differences: &Differences) -> &[u32] {
        let Self { inexact, undecided, pairs, wrong } = self;
        inexact.clear();
        undecided.clear();
        for (&place, &wanted) in differences.places.iter().zip(&differences.wanted) {
            let halves = picture_halves(shown.packed()[place as usize]);
            if halves == Some(wanted) {
                continue;
            }
            let is_near =
                |&halves: &Halves| squared_differences(halves, wanted).into_iter().all(|square| square <= FAR);
            let near = halves.filter(is_near);
            inexact.push((place, near.is_none()));
            undecided.extend(near.map(|halves| [halves, wanted]));
        }
        // The error of the cube roots is not subtracted: at the very limit either answer will do.
        pairs.compare(undecided.iter().copied(), Tolerance { distance: VISIBLE, square: u32::MAX });
        let mut are_near = pairs.are_near();
        wrong.clear();
        let is_wrong = |&&(_, is_far): &&(u32, bool)| is_far || are_near.next() != Some(true);
        wrong.extend(inexact.iter().filter(is_wrong).map(|&(place, _)| place));
        wrong
    }

    /// Returns whether the last frame left all cells of the picture exact.
    pub(super) fn are_all_exact(&self) -> bool {
        self.inexact.is_empty()
    }
}
