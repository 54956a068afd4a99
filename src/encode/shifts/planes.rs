//! Pictures as planes, one for each channel of the two halves of a cell: errors of many cells are
//! then computed at once.

use super::windows::{Distances, MOST_DISTANCE, load};
use crate::encode::halves::{Halves, NO_PICTURE};
use crate::grid::Size;
use crate::lanes::{F32x8, LANES, Lanes, SimdKernel};
use crate::simd::dispatch;

/// The number of channels of a cell: red, green and blue of each half.
const CHANNELS: usize = 6;

/// The number of places before, between and after the rows of a plane.
// Vectors reach that far beyond the first and the last column of a row.
const MARGIN: usize = if MOST_DISTANCE > LANES { MOST_DISTANCE } else { LANES };

/// The planes of a picture, row by row.
#[derive(Default)]
pub(super) struct Planes {
    columns: usize,
    /// The number of places of a plane.
    plane_len: usize,
    /// The planes, one after another; 0 in the margins and for cells that are no picture.
    values: Vec<f32>,
    is_picture: Vec<bool>,
}

impl Planes {
    /// Sets the planes of a picture, given by the halves of all cells.
    pub(super) fn fill(&mut self, halves: &[Halves], size: Size) {
        let (columns, rows) = (usize::from(size.columns), usize::from(size.rows));
        let plane_len = MARGIN + rows * (columns + MARGIN);
        if (self.columns, self.plane_len) != (columns, plane_len) {
            (self.columns, self.plane_len) = (columns, plane_len);
            self.values.clear();
            self.values.resize(CHANNELS * plane_len, 0.0);
        }
        self.is_picture.clear();
        self.is_picture.extend(halves.iter().map(|&halves| halves != NO_PICTURE));
        dispatch(FillPlanes { halves, planes: self });
    }

    /// Returns whether the cell at an index in the grid is one of the picture.
    pub(super) fn is_picture(&self, at: usize) -> bool {
        self.is_picture[at]
    }

    /// Returns whether all cells of a row are cells of the picture.
    pub(super) fn is_picture_row(&self, row: usize) -> bool {
        self.is_picture[row * self.columns..][..self.columns].iter().all(|&is_picture| is_picture)
    }

    /// Returns the values of a row in each plane, from the margin before it to that behind it.
    #[inline(always)]
    fn row(&self, row: usize) -> [&[f32]; CHANNELS] {
        let start = row * (self.columns + MARGIN);
        std::array::from_fn(|channel| &self.values[channel * self.plane_len + start..][..self.columns + 2 * MARGIN])
    }
}

/// Sets the values of all planes.
struct FillPlanes<'a> {
    halves: &'a [Halves],
    planes: &'a mut Planes,
}

impl SimdKernel for FillPlanes<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let &mut Planes { columns, plane_len, ref mut values, .. } = self.planes;
        for (channel, plane) in values.chunks_exact_mut(plane_len).enumerate() {
            let (half, shift) = (channel / 3, 16 - channel % 3 * 8);
            let rows = plane[MARGIN..].chunks_exact_mut(columns + MARGIN);
            for (row, halves) in rows.zip(self.halves.chunks_exact(columns)) {
                for (value, halves) in row.iter_mut().zip(halves) {
                    *value = f32::from((halves[half].bits() >> shift) as u8);
                }
            }
        }
    }
}

/// Sets the errors of the cells of a row, if they stay where they are or come from another row.
///
/// Returns the sum of the errors.
pub(super) struct PutRowErrors<'a> {
    /// The shown and the wanted planes, and the row in each of them.
    pub(super) rows: [(&'a Planes, usize); 2],
    /// The greatest error.
    pub(super) limit: f32,
    pub(super) errors: &'a mut Vec<F32x8>,
}

impl SimdKernel for PutRowErrors<'_> {
    type Output = f32;

    #[inline(always)]
    fn run<N: Lanes>(self) -> f32 {
        let Self { rows, limit, errors } = self;
        let count = rows[0].0.columns.div_ceil(LANES);
        let [a, b] = rows.map(|(planes, row)| planes.row(row));
        let mut sum = N::splat(0.0);
        errors.resize(count, F32x8::ZERO);
        for (eight, errors) in errors.iter_mut().enumerate() {
            let at = MARGIN + LANES * eight;
            let mut others = [N::splat(0.0); CHANNELS];
            for (other, plane) in others.iter_mut().zip(b) {
                *other = load(plane, at);
            }
            let error = square(&a, at, &others).min(N::splat(limit));
            sum = sum + error;
            *errors = error.store();
        }
        sum.store().0.iter().sum()
    }
}

/// Sets the errors of the cells of a row, if they come from other columns.
pub(super) struct PutShiftedErrors<'a> {
    pub(super) shown: &'a Planes,
    pub(super) wanted: &'a Planes,
    pub(super) row: usize,
    /// The greatest error.
    pub(super) limit: f32,
    pub(super) distances: Distances,
    /// The errors of each cell at all distances, cell by cell.
    pub(super) errors: &'a mut Vec<F32x8>,
}

impl SimdKernel for PutShiftedErrors<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { shown, wanted, row, limit, distances, errors } = self;
        let (shown, wanted, columns) = (shown.row(row), wanted.row(row), wanted.columns);
        let groups = distances.groups().len();
        errors.resize(columns * groups, F32x8::ZERO);
        for (place, errors) in errors.chunks_exact_mut(groups).enumerate() {
            let place = MARGIN + place;
            let mut colors = [N::splat(0.0); CHANNELS];
            for (color, plane) in colors.iter_mut().zip(wanted) {
                *color = N::splat(plane[place]);
            }
            for (group, errors) in errors.iter_mut().enumerate() {
                // Within the margins, which are as wide as the greatest distance.
                let from = place.wrapping_add_signed(distances.first_by(group));
                *errors = square(&shown, from, &colors).min(N::splat(limit)).store();
            }
        }
    }
}

/// Returns the squared differences of eight cells, summed over the channels.
// Loops instead of closures: those that are not inlined are compiled without the kernel's instructions.
#[inline(always)]
fn square<N: Lanes>(planes: &[&[f32]; CHANNELS], at: usize, others: &[N; CHANNELS]) -> N {
    let mut sum = N::splat(0.0);
    for (plane, &other) in planes.iter().zip(others) {
        let difference = load::<N>(plane, at) - other;
        sum = sum + difference * difference;
    }
    sum
}
