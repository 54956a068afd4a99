//! Walks along eight rays, in pieces on which models enclose f.
//!
//! A walk goes forward in pieces of the ray. A piece without a root is passed. Otherwise the walk advances to the first
//! t that may be a root. The next piece then ends where the model shows that the sign is certainly the other one, or is
//! shorter if the model shows no such t. So thin parts are not stepped over. The error of a model grows with the cube
//! of the length, from which the length of the next piece follows.
//!
//! Frequent outcomes are handled together, the others walk by walk.

use super::bracket::{Brackets, Root};
use super::forecast::{SignForecast, SignForecasts, TARGET, cube_root};
use super::model::Continuity;
use super::packet::EightValues;
use crate::lanes::{F32x8, LANES};
use std::array::from_fn;

/// The length of the first piece, relative to the range, of a ray that starts in the bounds.
///
/// The first number is for algebraic formulas, the second one for others.
// With the whole range, such rays took an eighth more pieces; other rays took more with a part of it. With one length
// for all formulas, they took at least 5 % more.
const FIRST_PIECES: [f64; 2] = [0.35, 0.125];

/// The length of the shortest piece, relative to the range.
// With this length, the nearer of two sheets 3e-7 apart was always found. Pieces this short need t and lengths in f64.
pub(super) const MIN_PIECE: f64 = 1e-9;

/// The length, relative to the range, up to which a piece with a sign change becomes a bracket.
const BRACKET: f64 = 1.0 / 16_384.0;

/// The length, relative to the range, below which models with a large error in f32 are
/// computed in f64.
const SHORT: f64 = 1.0 / 1024.0;

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

/// The places that eight searches have reached.
#[derive(Clone, Debug)]
pub(super) struct Walks {
    /// The starts of the next pieces.
    pub(super) t: EightValues,
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
    /// The ends of the ranges.
    pub(super) ends: EightValues,
    /// The t after which no root is needed.
    until: EightValues,
    /// The lanes that still search.
    pub(super) lanes: u32,
}

/// The place that one search has reached: see [`Walks`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
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
pub(super) enum StepOutcome {
    NoRoot,
    Root(Root),
}

/// Returns the mask of the lanes that are true.
#[inline(always)]
fn bits(lanes: [bool; LANES]) -> u32 {
    (0..LANES).fold(0, |bits, lane| bits | u32::from(lanes[lane]) << lane)
}

/// Returns the length of the piece that follows one without a known change of the sign.
///
/// `width` is the length of that one, and `left` that of its part behind the first t that may be a root.
// At least a share of the whole piece: where most of the piece is passed, what is left of it is often too short.
#[inline(always)]
fn shortened(factor: f64, left: f64, width: f64) -> f64 {
    (factor.clamp(0.25, 0.5) * left).max(0.35 * factor.clamp(0.25, 1.0) * width)
}

impl Walks {
    /// Returns the walks at the starts of the ranges, without lanes whose range is empty.
    #[inline(always)]
    pub(super) fn new([starts, ends]: &[F32x8; 2], until: &F32x8, lanes: u32, is_algebraic: bool) -> Self {
        let (none, [t, ends, until]) = ([0.0; LANES], [starts, ends, until].map(|numbers| numbers.0.map(f64::from)));
        let (mut range, mut shortest, mut is_range) = (none, none, [false; LANES]);
        for lane in 0..LANES {
            let (from, to) = (t[lane], ends[lane]);
            range[lane] = to - from;
            // In a shorter piece, the end could be rounded to the start.
            shortest[lane] = (MIN_PIECE * range[lane]).max(16.0 * f64::EPSILON * from.abs().max(to.abs()));
            // Rejects a range that is NaN, too.
            is_range[lane] = (range[lane] > 0.0) && (range[lane] < f64::INFINITY);
        }
        // A ray that starts in the bounds mostly hits near its start, while others may miss.
        let share = FIRST_PIECES[usize::from(!is_algebraic)];
        let first = |lane: usize| if t[lane] > 0.0 { range[lane] } else { share * range[lane] };
        let (length, lanes) = (from_fn(first), lanes & bits(is_range));
        let [sign, undecided, skipped] = [none; 3];
        Self { t, length, sign, since: t, undecided, stride: shortest, skipped, shortest, range, ends, until, lanes }
    }

    /// Returns the start and end of each lane's next piece, and drops lanes whose search is over.
    #[inline(always)]
    pub(super) fn next_pieces(&mut self) -> [EightValues; 2] {
        let (mut ends, mut is_on_the_way) = ([0.0; LANES], [false; LANES]);
        for lane in 0..LANES {
            let (t, to) = (self.t[lane], self.ends[lane]);
            is_on_the_way[lane] = (t < to) && (t <= self.until[lane]);
            ends[lane] = (t + self.length[lane]).min(to);
        }
        self.lanes &= bits(is_on_the_way);
        [self.t, ends]
    }

    pub(super) fn walk(&self, lane: usize) -> Walk {
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

    pub(super) fn set_walk(&mut self, lane: usize, walk: &Walk) {
        (self.t[lane], self.length[lane], self.sign[lane]) = (walk.t, walk.length, walk.sign);
        (self.since[lane], self.undecided[lane], self.stride[lane]) = (walk.since, walk.undecided, walk.stride);
        (self.skipped[lane], self.shortest[lane], self.range[lane]) = (walk.skipped, walk.shortest, walk.range);
    }

    /// Advances the walks with frequent outcomes together, as [`Walk::advance`] does.
    ///
    /// Returns these lanes, and those of them whose first root is now in a bracket.
    #[inline(always)]
    pub(super) fn advance_frequent(
        &mut self,
        forecasts: &SignForecasts,
        pieces: &[EightValues; 2],
        lanes: u32,
        brackets: &mut Brackets,
    ) -> [u32; 2] {
        let (gaps, usual) = (forecasts.may_jump | forecasts.is_undefined, lanes & !forecasts.is_undefined);
        let has_large_error = !(forecasts.has_small_error | forecasts.has_no_zero);
        let [nears, fars, blurs] = &forecasts.shares;
        let (mut done, mut arrived, mut starts, mut ends) =
            ([false; LANES], [false; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let is_in = |mask: u32| mask >> lane & 1 == 1;
            let (from, to) = (pieces[0][lane], pieces[1][lane]);
            let (width, stride, shortest) = (to - from, self.stride[lane], self.shortest[lane]);
            let sign = if is_in(forecasts.is_negative) { -1.0 } else { 1.0 };
            let is_same = (self.skipped[lane] == 0.0) && (self.sign[lane] * sign >= 0.0);
            let (is_certain, has_no_zero) = (is_in(forecasts.is_certain), is_in(forecasts.has_no_zero));
            let (near, far) = (f64::from(nears.0[lane]), f64::from(fars.0[lane]));
            let (start, end) = (from + near * width, (from + far * width).min(to));
            let has_end = !has_no_zero && (far <= 1.0);
            let is_long = has_no_zero || has_end || (width > 1.5 * shortest);
            let is_short = width < SHORT * self.range[lane];
            let is_frequent = if is_certain { is_same && is_long && !is_in(gaps) } else { width > 1.5 * stride };
            let is_done = is_in(usual) && is_frequent && !(is_in(has_large_error) && is_short);
            let factor = cube_root(TARGET / blurs.0[lane]);
            let passed = (factor.clamp(1.0, 4.0) * width).max(shortest);
            let halved = shortened(factor, to - start, width).max(shortest);
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
            arrived[lane] = moves && has_end && (end - start <= BRACKET * self.range[lane]);
        }
        brackets.add_each(arrived, [&starts, &ends, &self.sign]);
        [bits(done), bits(arrived)]
    }
}

impl Walk {
    pub(super) fn is_short_for_f32(&self, [from, to]: [f64; 2]) -> bool {
        to - from < SHORT * self.range
    }

    /// Examines the piece, and returns its root or advances.
    ///
    /// Without a root, the walk moves past the piece, shortens it, or goes back to a part that was skipped.
    pub(super) fn advance(
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
            return StepOutcome::Root(Root { low: self.since, high: from, sign: self.sign });
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
                return StepOutcome::Root(Root { low: start, high: end, sign: self.sign });
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
        let length = shortened(forecast.length_factor(0.25, 1.0), to - start, width);
        (self.t, self.length) = (start, length.max(self.shortest));
        StepOutcome::NoRoot
    }
}
