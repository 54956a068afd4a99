//! Pictures as planes, one for each channel of the two halves of a cell: errors of many cells are
//! then computed at once.

use crate::encode::halves::picture_halves;
use crate::grid::Grid;
use crate::lanes::{Lanes, SimdKernel};
use crate::simd::dispatch;

/// The number of channels of a cell: red, green and blue of each half.
const CHANNELS: usize = 6;

/// The planes of a grid's picture, row by row.
#[derive(Default)]
pub(super) struct Planes {
    columns: usize,
    /// The planes, one after another; 0 for cells that are no picture.
    values: Vec<u8>,
    is_picture: Vec<bool>,
    is_picture_row: Vec<bool>,
}

impl Planes {
    pub(super) fn fill(&mut self, grid: &Grid) {
        let count = grid.packed().len();
        self.columns = grid.size().columns.into();
        self.values.clear();
        self.values.resize(CHANNELS * count, 0);
        self.is_picture.clear();
        self.is_picture_row.clear();
        for (at, &cell) in grid.packed().iter().enumerate() {
            let halves = picture_halves(cell);
            self.is_picture.push(halves.is_some());
            let Some([upper, lower]) = halves else { continue };
            let ([a, b, c], [d, e, f]) = (upper.channels(), lower.channels());
            for (channel, value) in [a, b, c, d, e, f].into_iter().enumerate() {
                self.values[channel * count + at] = value;
            }
        }
        let rows = self.is_picture.chunks_exact(self.columns.max(1));
        self.is_picture_row.extend(rows.map(|row| row.iter().all(|&is_picture| is_picture)));
    }

    /// Returns whether the cell at an index in the grid is one of the picture.
    pub(super) fn is_picture(&self, at: usize) -> bool {
        self.is_picture[at]
    }

    /// Returns whether all cells of a row are cells of the picture.
    pub(super) fn is_picture_row(&self, row: usize) -> bool {
        self.is_picture_row[row]
    }

    /// Returns the planes of `count` cells from an index in the grid on.
    fn planes_from(&self, at: usize, count: usize) -> [&[u8]; CHANNELS] {
        let plane = self.is_picture.len();
        std::array::from_fn(|channel| &self.values[channel * plane + at..][..count])
    }
}

/// Sets the errors, at most `limit`, of the cells of one picture from those of another: from an
/// index in each grid on.
pub(super) fn put_errors(pictures: [&Planes; 2], from: [usize; 2], limit: u16, errors: &mut [u16]) {
    let planes = [0, 1].map(|picture| pictures[picture].planes_from(from[picture], errors.len()));
    dispatch(PutErrors { planes, limit, errors });
}

/// Sets errors as [`put_errors`] does, for as many cells as there are errors.
struct PutErrors<'a> {
    planes: [[&'a [u8]; CHANNELS]; 2],
    limit: u16,
    errors: &'a mut [u16],
}

impl SimdKernel for PutErrors<'_> {
    type Output = ();

    // Plain loops, which the compiler turns into instructions of the widest set. The square of a difference of 8 bits
    // has 16, in which the sum saturates: many cells at once, without wider numbers.
    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { planes: [a, b], limit, errors } = self;
        errors.fill(0);
        for (a, b) in a.into_iter().zip(b) {
            for ((error, a), b) in errors.iter_mut().zip(a).zip(b) {
                let difference = u16::from(a.abs_diff(*b));
                *error = error.saturating_add(difference * difference);
            }
        }
        for error in errors {
            *error = (*error).min(limit);
        }
    }
}
