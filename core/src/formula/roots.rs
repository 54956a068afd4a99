//! The first root of a formula along a ray: the first sign change across which it is continuous.
//!
//! Eight walks go side by side, one per ray: their pieces are enclosed together, in f32, and frequent outcomes are
//! handled together.
//!
//! A walk goes forward in pieces of the ray, on each of which a [`Model`] encloses f. A piece without a root is passed.
//! Otherwise the walk advances to the first t that may be a root. The next piece then ends where the model shows that
//! the sign is certainly the other one, or is shorter if the model shows no such t. So thin parts are not stepped over.
//! The error of a model grows with the cube of the length, from which the length of the next piece follows. A sign
//! change may be lost if it is undone within [`MIN_PIECE`] of the range, or behind [`MAX_PIECES`] pieces.
//!
//! A sign change at a jump is no root, and neither is a zero without a sign change.

use super::Formula;
use super::bracket::{Brackets, Narrowing, Root};
use super::model::{Continuity, Model};
use super::packet::{EightValues, Lines, PacketModels, PacketValues, SignForecast, SignForecasts, StoredModels};
use super::tape::Tape;
use crate::lanes::{F32x8, LANES, Lanes, SimdKernel, set_bits};
use crate::simd;
use glam::DVec3;
use std::cell::RefCell;

/// The length of the shortest piece, relative to the range.
// With this length, the nearer of two sheets 3e-7 apart was always found. Pieces this short need t and lengths in f64.
const MIN_PIECE: f64 = 1e-9;

/// The length, relative to the range, up to which a piece with a sign change becomes a bracket.
const BRACKET: f64 = 1.0 / 16_384.0;

/// The length, relative to the range, below which models with a large error in f32 are
/// computed in f64.
const SHORT: f64 = 1.0 / 1024.0;

/// The error of a model, relative to the value of f, for which the lengths of pieces are chosen.
const TARGET: f32 = 0.3;

/// The longest stretch of undecided sign that counts as a root, relative to the range, if f changes
/// its sign across it.
// Longer stretches are left out because f may be zero on a whole stretch of the ray, which is no surface. Short ones
// occur near a triple root, where f may be zero in f64.
const MAX_STRETCH: f64 = 1.0 / 256.0;

/// The number of pieces of undecided sign in a row after which the length doubles with each piece.
// With the shortest pieces alone, a stretch of the ray on which f is 0 would take up to a billion of them.
const STRIDES_FROM: f64 = 8.0;

/// The length, relative to the range, of the longest piece of undecided sign that is passed.
const MAX_STRIDE: f64 = 1.0 / 64.0;

/// The largest number of pieces that are examined on a ray; without a root by then, it misses.
// The limit bounds the time of formulas that oscillate faster than any picture can show.
const MAX_PIECES: usize = 4096;

/// The line origin + t * direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
}

thread_local! {
    /// The scratch memory of a thread: allocating it for each search took a tenth of the time.
    static SCRATCH: RefCell<SearchScratch> = RefCell::default();
}

/// Memory for the values of a tape's operations.
#[derive(Debug, Default)]
struct SearchScratch {
    models: Vec<Model>,
    packets: Vec<StoredModels>,
    values: Vec<EightValues>,
}

/// The search for roots of a formula along up to eight lines at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solver<'f> {
    formula: &'f Formula,
}

/// Up to eight searches: each lane's line, its range of t, and the t after which no root is needed.
#[derive(Clone, Debug)]
pub(crate) struct Searches {
    lines: Lines,
    walks: Walks,
    ends: EightValues,
    until: EightValues,
    /// The lanes that still search.
    lanes: u32,
}

/// The places that eight searches have reached.
#[derive(Clone, Debug)]
struct Walks {
    /// The starts of the next pieces.
    t: EightValues,
    /// The lengths of the next pieces.
    length: EightValues,
    /// The last certain signs, 1 or -1; 0 if there is none since the last jump.
    sign: EightValues,
    /// The largest t at which `sign` was certain.
    since: EightValues,
    /// The number of pieces in a row whose sign was undecided.
    undecided: EightValues,
    /// The lengths of the longest pieces that may be passed if their sign is undecided.
    stride: EightValues,
    /// The length of the piece that was passed last, if its sign was undecided, else 0.
    skipped: EightValues,
    /// The lengths of the shortest pieces.
    shortest: EightValues,
    /// The lengths of the whole ranges.
    range: EightValues,
}

/// The place that one search has reached: see [`Walks`].
#[derive(Clone, Copy, Debug)]
struct Walk {
    t: f64,
    length: f64,
    sign: f64,
    since: f64,
    undecided: f64,
    stride: f64,
    skipped: f64,
    shortest: f64,
    range: f64,
}

/// The outcome of a step along a piece.
enum StepOutcome {
    NoRoot,
    Root(Root),
}

impl Searches {
    /// No search in any lane.
    pub(crate) const NONE: Self = {
        let none = [0.0; LANES];
        Self { lines: [[none; 3]; 2], walks: Walks::NONE, ends: none, until: none, lanes: 0 }
    };

    /// Adds a lane, unless its range is empty: see [`Solver::first_root`].
    pub(crate) fn add(&mut self, lane: usize, line: &Line, [start, end]: [f32; 2], until: f32) {
        let (from, to) = (f64::from(start), f64::from(end));
        let range = to - from;
        // Rejects a range that is NaN, too.
        if !(range > 0.0 && range < f64::INFINITY) {
            return;
        }
        for (lines, vector) in self.lines.iter_mut().zip([line.origin, line.direction]) {
            for (numbers, number) in lines.iter_mut().zip(vector.to_array()) {
                numbers[lane] = number;
            }
        }
        self.walks.set_walk(lane, &Walk::new(from, to));
        (self.ends[lane], self.until[lane]) = (to, f64::from(until));
        self.lanes |= 1 << lane;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lanes == 0
    }

    /// Returns the start and end of each lane's next piece, and drops lanes whose search is over.
    #[inline(always)]
    fn next_pieces(&mut self) -> [EightValues; 2] {
        let (mut ends, mut is_on_the_way) = ([0.0; LANES], [false; LANES]);
        for lane in 0..LANES {
            let (t, to) = (self.walks.t[lane], self.ends[lane]);
            is_on_the_way[lane] = t < to && t <= self.until[lane];
            ends[lane] = (t + self.walks.length[lane]).min(to);
        }
        self.lanes &= bits(is_on_the_way);
        [self.walks.t, ends]
    }
}

/// Returns the mask of the lanes that are true.
#[inline(always)]
fn bits(lanes: [bool; LANES]) -> u32 {
    (0..LANES).fold(0, |bits, lane| bits | u32::from(lanes[lane]) << lane)
}

impl<'f> Solver<'f> {
    pub(crate) fn new(formula: &'f Formula) -> Self {
        Self { formula }
    }

    /// Returns the first root in `start..=end`, unless it is known to lie behind `until`.
    ///
    /// It is the first f32 at which the sign of f, computed in f64, differs from the sign in front of it. `until`
    /// only ends the search early; it does not change a root in front of it. A root at `start` itself is passed, so
    /// that the search from a root finds the next one.
    pub(crate) fn first_root(self, line: &Line, range: [f32; 2], until: f32) -> Option<f32> {
        let mut searches = Searches::NONE;
        searches.add(0, line, range, until);
        let (lanes, roots) = self.first_roots(&mut searches);
        (lanes != 0).then_some(roots.0[0])
    }

    /// Returns the lanes with a root, and their first roots, none of which depends on the other
    /// lanes.
    pub(crate) fn first_roots(self, searches: &mut Searches) -> (u32, F32x8) {
        SCRATCH.with_borrow_mut(|scratch| simd::dispatch(RootSearch { tape: &self.formula.tape, searches, scratch }))
    }
}

/// The search for the first roots along up to eight lines.
struct RootSearch<'a> {
    tape: &'a Tape,
    searches: &'a mut Searches,
    scratch: &'a mut SearchScratch,
}

impl SimdKernel for RootSearch<'_> {
    type Output = (u32, F32x8);

    #[inline(always)]
    fn run<N: Lanes>(self) -> (u32, F32x8) {
        let Self { tape, searches, scratch } = self;
        let (mut found, mut brackets) = (0, Brackets::NONE);
        for _ in 0..MAX_PIECES {
            let pieces = searches.next_pieces();
            let Searches { lines, walks, lanes, .. } = &mut *searches;
            let lines = &*lines;
            if *lanes == 0 {
                break;
            }
            let packet = PacketModels { tape, lines, pieces: &pieces, lanes: *lanes, scratch: &mut scratch.packets };
            let forecasts = packet.run::<N>();
            let [done, arrived] = walks.advance_frequent(&forecasts, &pieces, *lanes, &mut brackets);
            let rest = *lanes & !done;
            let ended =
                arrived | advance_one_by_one(tape, (lines, &pieces), rest, &forecasts, walks, &mut brackets, scratch);
            found |= ended;
            *lanes &= !ended;
        }
        // The root is narrowed down to the first f32 of the other sign, so that it does not depend on the pieces of the
        // walk: without this step up to 61 of 24,000 depths did.
        let values = PacketValues { tape, lines: &searches.lines, scratch: &mut scratch.values };
        (found, Narrowing { values, brackets: &mut brackets, lanes: found }.run::<N>())
    }
}

/// Advances the walks of `lanes` one by one.
///
/// Returns the lanes whose first root is now in a bracket.
#[inline(never)]
fn advance_one_by_one(
    tape: &Tape,
    (lines, pieces): (&Lines, &[EightValues; 2]),
    lanes: u32,
    forecasts: &SignForecasts,
    walks: &mut Walks,
    brackets: &mut Brackets,
    scratch: &mut SearchScratch,
) -> u32 {
    let mut found = 0;
    for lane in set_bits(lanes) {
        let (mut walk, piece) = (walks.walk(lane), [pieces[0][lane], pieces[1][lane]]);
        let (mut forecast, mut continuity) = (forecasts.forecast(lane), forecasts.continuity(lane));
        // In f32, the model of a short piece may be little more than its rounding errors.
        if forecasts.has_large_error(lane) && walk.is_short_for_f32(piece) {
            let line = line_in_lane(lines, lane);
            let (o, d) = (line.origin.to_array(), line.direction.to_array());
            let coordinates = [0, 1, 2].map(|axis| Model::coordinate(o[axis], d[axis], piece));
            let (model, of_model) = tape.model(coordinates, &mut scratch.models);
            (forecast, continuity) = (SignForecast::of(&model), of_model);
        }
        if let StepOutcome::Root(root) = walk.advance(&forecast, continuity, piece) {
            brackets.add(lane, root);
            found |= 1 << lane;
        }
        walks.set_walk(lane, &walk);
    }
    found
}

/// Returns the line of one lane, for models that are computed in f64.
fn line_in_lane(lines: &Lines, lane: usize) -> Line {
    let of = |axes: &[[f64; LANES]; 3]| DVec3::new(axes[0][lane], axes[1][lane], axes[2][lane]);
    Line { origin: of(&lines[0]), direction: of(&lines[1]) }
}

impl Walks {
    const NONE: Self = {
        let none = [0.0; LANES];
        Self {
            t: none,
            length: none,
            sign: none,
            since: none,
            undecided: none,
            stride: none,
            skipped: none,
            shortest: none,
            range: none,
        }
    };

    fn walk(&self, lane: usize) -> Walk {
        Walk {
            t: self.t[lane],
            length: self.length[lane],
            sign: self.sign[lane],
            since: self.since[lane],
            undecided: self.undecided[lane],
            stride: self.stride[lane],
            skipped: self.skipped[lane],
            shortest: self.shortest[lane],
            range: self.range[lane],
        }
    }

    fn set_walk(&mut self, lane: usize, walk: &Walk) {
        (self.t[lane], self.length[lane], self.sign[lane]) = (walk.t, walk.length, walk.sign);
        (self.since[lane], self.undecided[lane], self.stride[lane]) = (walk.since, walk.undecided, walk.stride);
        (self.skipped[lane], self.shortest[lane], self.range[lane]) = (walk.skipped, walk.shortest, walk.range);
    }

    /// Advances the walks with frequent outcomes together, as [`Walk::advance`] does.
    ///
    /// Returns these lanes, and those of them whose first root is now in a bracket.
    #[inline(always)]
    fn advance_frequent(
        &mut self,
        forecasts: &SignForecasts,
        pieces: &[EightValues; 2],
        lanes: u32,
        brackets: &mut Brackets,
    ) -> [u32; 2] {
        let gaps = forecasts.may_jump | forecasts.is_undefined;
        let has_large_error = !(forecasts.has_small_error | forecasts.has_no_zero);
        let [nears, fars, blurs] = &forecasts.shares;
        let (mut done, mut arrived, mut starts, mut ends) =
            ([false; LANES], [false; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let is_in = |mask: u32| mask >> lane & 1 == 1;
            let (from, to) = (pieces[0][lane], pieces[1][lane]);
            let (width, stride, shortest) = (to - from, self.stride[lane], self.shortest[lane]);
            let sign = if is_in(forecasts.is_negative) { -1.0 } else { 1.0 };
            let is_same = self.skipped[lane] == 0.0 && self.sign[lane] * sign >= 0.0;
            let (is_certain, has_no_zero) = (is_in(forecasts.is_certain), is_in(forecasts.has_no_zero));
            let (near, far) = (f64::from(nears.0[lane]), f64::from(fars.0[lane]));
            let (start, end) = (from + near * width, (from + far * width).min(to));
            let has_end = !has_no_zero && far <= 1.0;
            let is_long = has_no_zero || has_end || width > 1.5 * shortest;
            let is_short = width < SHORT * self.range[lane];
            let is_frequent = if is_certain { is_same && is_long && !is_in(gaps) } else { width > 1.5 * stride };
            let is_done =
                is_in(lanes) && is_frequent && !is_in(forecasts.is_undefined) && !(is_in(has_large_error) && is_short);
            let factor = cube_root(TARGET / blurs.0[lane]);
            let passed = (factor.clamp(1.0, 4.0) * width).max(shortest);
            let halved = (factor.clamp(0.25, 0.75) * (to - start)).max(shortest);
            let closer = if has_end { (end - start).min(0.75 * width) } else { halved };
            let undecided = (factor.clamp(0.0625, 0.5) * width).max(stride);
            let (next, reached) = if has_no_zero { (passed, to) } else { (closer, start) };
            let length = if is_certain { next } else { undecided };
            let moves = is_done && is_certain;
            self.length[lane] = if is_done { length } else { self.length[lane] };
            self.t[lane] = if moves { reached } else { self.t[lane] };
            self.since[lane] = if moves { reached } else { self.since[lane] };
            self.sign[lane] = if moves { sign } else { self.sign[lane] };
            self.undecided[lane] = if moves { 0.0 } else { self.undecided[lane] };
            self.stride[lane] = if moves { shortest } else { stride };
            (starts[lane], ends[lane], done[lane]) = (start, end, is_done);
            arrived[lane] = moves && has_end && end - start <= BRACKET * self.range[lane];
        }
        let arrived = bits(arrived);
        for lane in set_bits(arrived) {
            let (forecast, width) = (forecasts.forecast(lane), pieces[1][lane] - pieces[0][lane]);
            brackets.add(lane, forecast.root([starts[lane], ends[lane]], self.sign[lane], width));
        }
        [bits(done), arrived]
    }
}

/// Returns the cube root of a positive number, off by 6 %.
///
/// Infinity and NaN give large numbers.
#[inline(always)]
fn cube_root(x: f32) -> f64 {
    f64::from(f32::from_bits((x.to_bits() & (u32::MAX >> 1)) / 3 + 0x2a51_37a0))
}

impl Walk {
    fn new(from: f64, to: f64) -> Self {
        let range = to - from;
        // In a shorter piece, the end could be rounded to the start.
        let shortest = (MIN_PIECE * range).max(16.0 * f64::EPSILON * from.abs().max(to.abs()));
        let [sign, undecided, skipped] = [0.0; 3];
        Self { t: from, length: range, sign, since: from, undecided, stride: shortest, skipped, shortest, range }
    }

    fn is_short_for_f32(&self, [from, to]: [f64; 2]) -> bool {
        to - from < SHORT * self.range
    }

    /// Examines the piece, and returns its root or advances.
    ///
    /// Without a root, the walk moves past the piece, shortens it, or goes back to a part that was skipped.
    fn advance(
        &mut self,
        forecast: &SignForecast,
        continuity: Continuity,
        piece @ [from, to]: [f64; 2],
    ) -> StepOutcome {
        let (width, sign) = (to - from, forecast.sign);
        if continuity.is_undefined {
            return self.move_to(to, 2.0 * width, 0.0);
        }
        if sign == 0.0 {
            return self.shorten_or_skip(forecast, continuity, piece);
        }
        if self.skipped > 1.5 * self.shortest {
            return self.return_to_skipped(from);
        }
        (self.undecided, self.stride) = (0.0, self.shortest);
        if self.sign != 0.0 && sign != self.sign && from - self.since <= MAX_STRETCH * self.range {
            return StepOutcome::Root(Root { low: self.since, high: from, sign: self.sign, guess: from, slope: 0.0 });
        }
        (self.sign, self.since) = (sign, from);
        if forecast.has_no_zero {
            self.since = to;
            return self.move_to(to, forecast.length_factor(1.0, 4.0) * width, sign);
        }
        if continuity.may_jump {
            if width <= 1.5 * self.shortest {
                return self.move_to(to, 2.0 * width, 0.0);
            }
            self.length = 0.5 * width;
            return StepOutcome::NoRoot;
        }
        self.approach(forecast, piece)
    }

    /// Moves to `t`, where `sign` is certain, or unknown if it is 0.
    fn move_to(&mut self, t: f64, length: f64, sign: f64) -> StepOutcome {
        (self.t, self.length, self.sign) = (t, length.max(self.shortest), sign);
        (self.undecided, self.stride, self.skipped) = (0.0, self.shortest, 0.0);
        StepOutcome::NoRoot
    }

    /// Goes back to the start of the long piece passed last, and continues in shorter pieces.
    ///
    /// The sign was undecided in that piece and is certain at its end, so that roots may lie in it.
    fn return_to_skipped(&mut self, from: f64) -> StepOutcome {
        self.stride = (0.125 * self.skipped).max(self.shortest);
        (self.t, self.length, self.skipped) = (from - self.skipped, self.stride, 0.0);
        StepOutcome::NoRoot
    }

    /// Shortens a piece at whose start the sign is uncertain, or passes it if it is short.
    fn shorten_or_skip(
        &mut self,
        forecast: &SignForecast,
        continuity: Continuity,
        [from, to]: [f64; 2],
    ) -> StepOutcome {
        let width = to - from;
        // 1.5 instead of 1, because the rounding of its end may make a piece longer than `stride`.
        if width > 1.5 * self.stride {
            self.length = (forecast.length_factor(0.0625, 0.5) * width).max(self.stride);
            return StepOutcome::NoRoot;
        }
        self.undecided += 1.0;
        if continuity.may_jump {
            self.sign = 0.0;
        }
        if self.undecided > STRIDES_FROM {
            self.stride = (2.0 * self.stride).min(MAX_STRIDE * self.range);
        }
        (self.t, self.length, self.skipped) = (to, 2.0 * width, width);
        StepOutcome::NoRoot
    }

    /// Advances to the first t of the piece that may be a root.
    ///
    /// If the sign is certainly the other one farther on, the next piece ends there; if it is short, it is returned as
    /// the bracket of a root.
    fn approach(
        &mut self,
        forecast @ &SignForecast { near, far, .. }: &SignForecast,
        [from, to]: [f64; 2],
    ) -> StepOutcome {
        let width = to - from;
        let start = from + near * width;
        self.since = start;
        if far <= 1.0 {
            let end = (from + far * width).min(to);
            if end - start <= BRACKET * self.range {
                return StepOutcome::Root(forecast.root([start, end], self.sign, width));
            }
            // The next piece is at least a quarter shorter than this one, so that the search comes to an end.
            (self.t, self.length) = (start, (end - start).min(0.75 * width));
            return StepOutcome::NoRoot;
        }
        if width <= 1.5 * self.shortest {
            // The shortest piece shows no change of the sign: f is taken to touch zero here and to keep its sign.
            self.since = from;
            return self.move_to(to, 2.0 * width, self.sign);
        }
        (self.t, self.length) = (start, (forecast.length_factor(0.25, 0.75) * (to - start)).max(self.shortest));
        StepOutcome::NoRoot
    }
}

impl SignForecast {
    /// Returns the forecast from a model in f64.
    fn of(&Model { c: [c0, c1, c2], error }: &Model) -> Self {
        // The coefficients in the Bernstein basis: the polynomial lies between the least and the greatest.
        let b = [c0 - c1 + c2, c0 - c2, c0 + c1 + c2];
        let sign = if b[0].abs() > error { b[0].signum() } else { 0.0 };
        let [first, middle, last] = b.map(|b| sign * b);
        let has_no_zero = sign != 0.0 && first.min(middle).min(last) > error;
        // The polynomial falls at most as steeply as the steeper chord from the first coefficient to one of the others.
        let steepest = (2.0 * (middle - first)).min(last - first);
        // 0.999 of the way to where f could first be 0, so that the sign of f there is certain in spite of rounding.
        let near = (0.999 * (first - error) / -steepest).clamp(0.0, 1.0);
        let far = first_below([first, middle, last], -error).unwrap_or(2.0);
        let blur = error / if has_no_zero { first.min(middle).min(last) } else { b[0].abs() };
        Self { c: [c1, c2], sign, has_no_zero, near, far, blur }
    }

    /// Returns the next piece's length relative to this piece's, limited to `least..=most`.
    ///
    /// It is a cube root, because the error grows with the cube of the length.
    fn length_factor(&self, least: f64, most: f64) -> f64 {
        cube_root(TARGET / self.blur as f32).max(least).min(most)
    }

    /// Returns the bracket from `low` to `high` of a root that lies in a piece of length `width`.
    fn root(&self, [low, high]: [f64; 2], sign: f64, width: f64) -> Root {
        let (u, [c1, c2]) = (self.near + self.far - 1.0, self.c);
        Root { low, high, sign, guess: 0.5 * (low + high), slope: 2.0 * (c1 + 2.0 * u * c2) / width }
    }
}

/// Returns the share of the piece shortly behind the first fall of the polynomial below `level`.
///
/// At this share the polynomial is certainly below `level`; `None` if no such share is found.
fn first_below(b: [f64; 3], level: f64) -> Option<f64> {
    let (start, slope, curvature) = (b[0] - level, 2.0 * (b[1] - b[0]), b[0] - 2.0 * b[1] + b[2]);
    let under_root = slope * slope - 4.0 * curvature * start;
    // The condition is also true for NaN.
    if !(under_root >= 0.0) {
        return None;
    }
    let sum = -0.5 * (slope + under_root.sqrt().copysign(slope));
    let root = [sum / curvature, start / sum].into_iter().filter(|root| (0.0..=1.0).contains(root)).reduce(f64::min)?;
    let behind = (root + 1e-6 * root + 1e-9).min(1.0);
    let there = b[0] + behind * (slope + behind * curvature);
    (there < level).then_some(behind)
}
