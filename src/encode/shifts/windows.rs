//! The best window of cells or rows that is shifted.
//!
//! It is the contiguous range with the largest sum of gains (Bentley 1984), less what its vacated places cost. Eight
//! distances are searched at once.

use crate::lanes::{F32x8, LANES, Lanes, SimdKernel};
use crate::simd::dispatch;
use std::array;
use std::ops::Range;

/// The greatest number of places by which contents are shifted.
pub(super) const MOST_DISTANCE: usize = 16;

/// A range of places whose contents are shifted within it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub(super) start: usize,
    pub(super) end: usize,
    /// The number of places by which the contents are moved towards the start; if negative, towards
    /// the end.
    pub(super) by: isize,
    /// The error that is removed, less the prices.
    pub(super) gain: f32,
}

/// The prices of a shift with one operation, and with two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prices {
    pub(super) one: f32,
    pub(super) two: f32,
}

/// The distances that are searched, in both directions, in groups of eight.
///
/// The groups towards the start come first: their lanes have ascending distances, those of the others descending ones.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Distances {
    /// The greatest distance, at most [`MOST_DISTANCE`].
    pub(super) farthest: usize,
}

/// The largest number of groups of distances.
const MOST_GROUPS: usize = 2 * MOST_DISTANCE.div_ceil(LANES);

impl Distances {
    /// Returns the number of groups in each direction.
    fn groups_per_direction(self) -> usize {
        self.farthest.div_ceil(LANES)
    }

    /// Returns the indices of the groups.
    pub(super) fn groups(self) -> Range<usize> {
        0..2 * self.groups_per_direction()
    }

    /// Returns the distance of a group's first lane: positive towards the start. Each lane has one
    /// more than the lane before.
    pub(super) fn first_by(self, group: usize) -> isize {
        let per_direction = self.groups_per_direction();
        if group < per_direction {
            (LANES * group + 1).cast_signed()
        } else {
            -(LANES * (group - per_direction + 1)).cast_signed()
        }
    }

    /// Returns the group and the lane of a distance.
    pub(super) fn slot(self, by: isize) -> (usize, usize) {
        let place = by.unsigned_abs() - 1;
        let (group, lane) = (place / LANES, place % LANES);
        if by > 0 { (group, lane) } else { (self.groups_per_direction() + group, LANES - 1 - lane) }
    }
}

/// The errors of consecutive places: the cells of a row, or the rows of the screen.
// In f32, which has eight lanes. All numbers are whole, and exact up to 2^24. Larger sums, of long rows or a whole
// screen at a high exchange rate, are rounded, so that another window may be chosen.
#[derive(Default)]
pub(super) struct PlaceErrors {
    pub(super) distances: Distances,
    /// The errors if nothing is shifted.
    pub(super) stay: Vec<F32x8>,
    /// Prefix sums of `stay`: that of the first `n` errors has the index `MOST_DISTANCE + n`, and
    /// the numbers before and behind are not used.
    sums: Vec<f32>,
    /// The errors with contents from other places: for each place all groups of distances.
    pub(super) shifted: Vec<F32x8>,
}

impl PlaceErrors {
    /// Sums up the errors of `count` places if nothing is shifted.
    pub(super) fn sum_up(&mut self, count: usize) {
        let mut sum = 0.0;
        self.sums.clear();
        self.sums.resize(MOST_DISTANCE + 1, 0.0);
        self.sums.extend(self.stay.iter().flat_map(|eight| eight.0).take(count).map(|error| {
            sum += error;
            sum
        }));
        self.sums.resize(2 * MOST_DISTANCE + LANES + 1 + count, 0.0);
    }

    /// Returns the sum of the errors of some places if nothing is shifted.
    pub(super) fn staying(&self, places: Range<usize>) -> f32 {
        self.sums[MOST_DISTANCE + places.end] - self.sums[MOST_DISTANCE + places.start]
    }

    /// Returns the sum of the errors of some places with the contents of `by` places further.
    pub(super) fn shifted_by(&self, by: isize, places: Range<usize>) -> f32 {
        let (group, lane) = self.distances.slot(by);
        let groups = self.distances.groups().len();
        places.map(|place| self.shifted[place * groups + group].0[lane]).sum()
    }

    /// Returns the window with the largest gain within some places; `None` if no window gains.
    ///
    /// `most` is the error of a vacated place. One operation suffices at the end of the places if nothing follows them
    /// on the screen (`is_last`). Of distances with equal gains, the `likely` one is taken, then the shortest.
    pub(super) fn best_window(
        &self,
        part: Range<usize>,
        most: f32,
        prices: Prices,
        is_last: bool,
        likely: Option<isize>,
    ) -> Option<Window> {
        if self.staying(part.clone()) <= prices.one {
            return None;
        }
        let found = dispatch(FindWindows { errors: self, part: part.clone(), most, prices, is_last });
        let farthest = self.distances.farthest.min(part.len() - 1).cast_signed();
        let all = (1..=farthest).flat_map(|by| [by, -by]);
        let mut best: Option<Window> = None;
        for by in likely.filter(|by| by.abs() <= farthest).into_iter().chain(all) {
            let (group, lane) = self.distances.slot(by);
            let [gain, start, end] = found[group].map(|numbers| numbers.0[lane]);
            if gain > best.map_or(0.0, |best| best.gain) {
                best = Some(Window { start: start as usize, end: end as usize, by, gain });
            }
        }
        best
    }
}

/// Finds the best window of each distance: its gain, 0 if no window gains, its start and its end.
struct FindWindows<'a> {
    errors: &'a PlaceErrors,
    part: Range<usize>,
    most: f32,
    prices: Prices,
    is_last: bool,
}

impl SimdKernel for FindWindows<'_> {
    type Output = [[F32x8; 3]; MOST_GROUPS];

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let distances = self.errors.distances;
        let mut found = [[F32x8::ZERO; 3]; MOST_GROUPS];
        for group in distances.groups() {
            let first = distances.first_by(group);
            let [a, b, c] = if first > 0 { self.towards_start::<N>(group) } else { self.towards_end::<N>(group) };
            found[group] = [a.store(), b.store(), c.store()];
        }
        found
    }
}

impl FindWindows<'_> {
    /// Finds the best windows of a group whose contents move towards the start.
    #[inline(always)]
    fn towards_start<N: Lanes>(&self, group: usize) -> [N; 3] {
        let Range { start, end } = self.part;
        let nearest = self.errors.distances.first_by(group).unsigned_abs();
        let distance = lane_numbers::<N>() + N::splat(nearest as f32);
        let mut sweep = Sweep::new(group, distance, start);
        for place in start..end.saturating_sub(nearest) {
            self.extend_towards_start(&mut sweep, place, nearest);
        }
        [sweep.best, sweep.best_start, sweep.best_place + distance + N::splat(1.0)]
    }

    /// Extends the windows by a place, and takes each with the vacated places behind it if it is
    /// the best so far.
    #[inline(always)]
    fn extend_towards_start<N: Lanes>(&self, sweep: &mut Sweep<N>, place: usize, nearest: usize) {
        let zero = N::splat(0.0);
        sweep.begin_if_better(zero);
        self.extend(sweep, place);
        let next = MOST_DISTANCE + place + 1;
        let vacated = load::<N>(&self.errors.sums, next + nearest) - N::splat(self.errors.sums[next]);
        // The number of places between the window and the end of the part; negative if the window does not fit.
        let left = N::splat((self.part.end - 1) as f32) - sweep.place - sweep.distance;
        let price_at_end = N::splat(if self.is_last { self.prices.one } else { self.prices.two });
        let price = N::select(left.le(zero), price_at_end, N::splat(self.prices.two));
        let gain = sweep.sum + vacated - N::splat(self.most) * sweep.distance - price;
        sweep.take(N::select(zero.le(left), gain, zero));
        sweep.place = sweep.place + N::splat(1.0);
    }

    /// Finds the best windows of a group whose contents move towards the end.
    #[inline(always)]
    fn towards_end<N: Lanes>(&self, group: usize) -> [N; 3] {
        let Range { start, end } = self.part;
        let farthest = self.errors.distances.first_by(group).unsigned_abs();
        let distance = N::splat(farthest as f32) - lane_numbers::<N>();
        let first = start + farthest + 1 - LANES;
        let mut sweep = Sweep::new(group, distance, first);
        for place in first..end {
            let price = if self.is_last && place + 1 == end { self.prices.one } else { self.prices.two };
            self.extend_towards_end(&mut sweep, place, farthest, price);
        }
        [sweep.best, sweep.best_start - distance, sweep.best_place + N::splat(1.0)]
    }

    /// Extends the windows by a place, or begins them with the vacated places before it, and takes
    /// each if it is the best so far.
    #[inline(always)]
    fn extend_towards_end<N: Lanes>(&self, sweep: &mut Sweep<N>, place: usize, farthest: usize, price: f32) {
        let (sums, at) = (&self.errors.sums, MOST_DISTANCE + place);
        let vacated = N::splat(sums[at]) - load(sums, at - farthest);
        let begun = vacated - N::splat(self.most) * sweep.distance;
        let can_begin = (N::splat(self.part.start as f32) + sweep.distance).le(sweep.place);
        sweep.begin_if_better(N::select(can_begin, begun, N::splat(f32::NEG_INFINITY)));
        self.extend(sweep, place);
        sweep.take(sweep.sum - N::splat(price));
        sweep.place = sweep.place + N::splat(1.0);
    }

    /// Adds the gain of a place to the sums.
    #[inline(always)]
    fn extend<N: Lanes>(&self, sweep: &mut Sweep<N>, place: usize) {
        let PlaceErrors { distances, stay, shifted, .. } = self.errors;
        let shifted = N::load(&shifted[place * distances.groups().len() + sweep.group]);
        sweep.sum = sweep.sum + (N::splat(stay[place / LANES].0[place % LANES]) - shifted);
    }
}

/// The search of the best windows of eight distances, place by place.
struct Sweep<N> {
    /// The index of the group of distances.
    group: usize,
    distance: N,
    /// The current place, in all lanes.
    place: N,
    /// The gain of the best window that ends with the current place.
    sum: N,
    /// The place where this window began.
    start: N,
    /// The gain of the best window so far.
    best: N,
    /// The place where it began.
    best_start: N,
    /// The place with which the best window has ended.
    best_place: N,
}

impl<N: Lanes> Sweep<N> {
    #[inline(always)]
    fn new(group: usize, distance: N, place: usize) -> Self {
        let (zero, sum) = (N::splat(0.0), N::splat(f32::NEG_INFINITY));
        let place = N::splat(place as f32);
        Self { group, distance, place, sum, start: zero, best: zero, best_start: zero, best_place: zero }
    }

    /// Begins a window at the current place unless the one so far gains more than `begun`.
    #[inline(always)]
    fn begin_if_better(&mut self, begun: N) {
        self.start = N::select(self.sum.le(begun), self.place, self.start);
        self.sum = self.sum.max(begun);
    }

    /// Takes the window that ends with the current place if it gains more than the best one.
    #[inline(always)]
    fn take(&mut self, gain: N) {
        let is_better = self.best.lt(gain);
        self.best = self.best.max(gain);
        self.best_start = N::select(is_better, self.start, self.best_start);
        self.best_place = N::select(is_better, self.place, self.best_place);
    }
}

/// Returns the numbers of the lanes.
#[inline(always)]
fn lane_numbers<N: Lanes>() -> N {
    N::load(&F32x8(array::from_fn(|lane| lane as f32)))
}

/// Loads eight numbers from an index on; 0 if there are fewer.
// Never fewer: a margin follows all places.
#[inline(always)]
pub(super) fn load<N: Lanes>(numbers: &[f32], at: usize) -> N {
    if let Some(&eight) = numbers[at..].first_chunk() { N::load(&F32x8(eight)) } else { N::splat(0.0) }
}
