//! The best window of cells or rows that is shifted by a given distance.
//!
//! It is the contiguous range with the largest sum of gains (Bentley 1984), less what its vacated places cost.

use std::ops::Range;

/// A range of places whose contents are shifted within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) start: usize,
    pub(super) end: usize,
    /// The number of places by which the contents are moved towards the start; if negative, towards
    /// the end.
    pub(super) by: isize,
    /// The error that is removed, less the prices.
    pub(super) gain: i64,
}

impl Window {
    /// Returns the window with its places counted from another start.
    pub(super) fn moved_by(self, places: usize) -> Self {
        Self { start: self.start + places, end: self.end + places, ..self }
    }
}

/// The places of a row or column, and their errors if nothing is shifted.
pub(super) struct Places<'a> {
    /// Prefix sums of the errors: the error of a place is the difference of two neighbouring sums.
    pub(super) sums: &'a [i64],
    /// The greatest error of a place, which a vacated one has.
    pub(super) most: i64,
}

impl Places<'_> {
    fn len(&self) -> usize {
        self.sums.len() - 1
    }

    fn stay(&self, place: usize) -> i64 {
        self.sums[place + 1] - self.sums[place]
    }

    /// Returns by how much the error grows where places are vacated.
    fn vacated(&self, places: Range<usize>) -> i64 {
        self.most * places.len().cast_signed() as i64 - (self.sums[places.end] - self.sums[places.start])
    }
}

/// The prices of a shift with one operation, and with two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prices {
    pub(super) one: i64,
    pub(super) two: i64,
}

/// Returns the window with the largest gain if its contents are moved by `by` places; `None` if no
/// window gains.
///
/// `shifted` returns the error of a place that gets the contents `by` places further. One operation suffices at the end
/// of the places if nothing follows them on the screen (`is_last`).
pub(super) fn best_window(
    places: &Places<'_>,
    shifted: impl Fn(usize) -> i64,
    by: isize,
    prices: Prices,
    is_last: bool,
) -> Option<Window> {
    let distance = by.unsigned_abs();
    let count = places.len();
    let mut best: Option<Window> = None;
    let mut take = |start: usize, end: usize, sum: i64| {
        let price = if is_last && end == count { prices.one } else { prices.two };
        if sum - price > best.map_or(0, |best| best.gain) {
            best = Some(Window { start, end, by, gain: sum - price });
        }
    };
    let (mut sum, mut start) = (i64::MIN, 0);
    if by > 0 {
        for place in 0..count.saturating_sub(distance) {
            if sum <= 0 {
                (sum, start) = (0, place);
            }
            sum += places.stay(place) - shifted(place);
            let end = place + 1 + distance;
            take(start, end, sum - places.vacated(place + 1..end));
        }
    } else {
        for place in distance..count {
            let begun = -places.vacated(place - distance..place);
            if sum <= begun {
                (sum, start) = (begun, place - distance);
            }
            sum += places.stay(place) - shifted(place);
            take(start, place + 1, sum);
        }
    }
    best
}
