//! The first root of a formula along a ray: the first sign change across which it is continuous.
//!
//! Eight walks go side by side; their longer pieces are enclosed together, in f32.
//!
//! A walk goes forward in pieces, each enclosed by a [`Model`]. A piece without a root is passed, and the next one is
//! twice as long. Otherwise the walk advances to the first t that may be a root, and the next piece ends where the sign
//! is certainly the other one, if the model shows such a place, or is half as long. So thin parts are not stepped over.
//! A sign change may be lost if it is undone within [`MIN_PIECE`] of the range, or behind [`MAX_PIECES`] pieces.
//!
//! A sign change at a jump is no root, and neither is a zero without a sign change.

use super::Formula;
use super::model::{Continuity, Model};
use super::packet::{EightValues, Lines, PacketModels, PacketValues, StoredModels};
use crate::lanes::{F32x8, LANES, set_bits};
use crate::simd;
use glam::DVec3;
use std::cell::RefCell;

/// The length of the shortest piece, relative to the range.
// With it, the nearer of two sheets 3e-7 apart was always found. It needs t and lengths in f64.
const MIN_PIECE: f64 = 1e-9;

/// The relative length of a piece with a sign change at which the search among points begins.
const BRACKET: f64 = 1.0 / 16_384.0;

/// The relative length of a piece below which a model is computed in f64, if that in f32 is
/// blurred.
const SHORT: f64 = 1.0 / 1024.0;

/// The error of a blurred model, relative to the extent of its polynomial.
const BLUR: f64 = 1.0 / 16.0;

/// The longest stretch of undecided sign that counts as a root, relative to the range, if f changes
/// its sign across it.
// f may be zero on a whole stretch of the ray, which is no surface. Near a triple root it may be zero in f64.
const MAX_STRETCH: f64 = 1.0 / 256.0;

/// The number of pieces of undecided sign in a row from which on each is twice as long.
// With the shortest pieces alone, a stretch of the ray on which f is 0 would take up to a billion of them.
const STRIDES_FROM: u32 = 8;

/// The relative length of the longest piece that is passed while its sign is undecided.
const MAX_STRIDE: f64 = 1.0 / 64.0;

/// The largest number of pieces of one ray, which misses after that.
// It bounds the time of formulas that oscillate faster than any picture can show.
const MAX_PIECES: usize = 4096;

/// The line origin + t * direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
}

thread_local! {
    /// The scratch memory of a thread: allocating it for each search took a tenth of the time.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Memory for the values of a tape's operations.
#[derive(Debug, Default)]
struct Scratch {
    models: Vec<Model>,
    packets: Vec<StoredModels>,
    values: Vec<EightValues>,
}

/// The search for roots of a formula along up to eight lines at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solver<'f> {
    formula: &'f Formula,
}

/// Up to eight searches: each lane's line, range, and the t after which its root is not needed.
#[derive(Clone, Debug)]
pub(crate) struct Searches {
    lines: Lines,
    walks: [Walk; LANES],
    ends: [[f64; 2]; LANES],
    /// The lanes that still search.
    lanes: u32,
}

/// The place that a search has reached.
#[derive(Clone, Copy, Debug)]
struct Walk {
    /// The start of the next piece.
    t: f64,
    /// The length of the next piece.
    length: f64,
    /// The last certain sign, 1 or -1; 0 if there is none since the last jump.
    sign: f64,
    /// The largest t at which `sign` was certain.
    since: f64,
    /// The number of pieces in a row whose sign was undecided.
    undecided: u32,
    /// The length of the longest piece that may be passed if its sign is undecided.
    stride: f64,
    /// The length of the piece that was passed last, if its sign was undecided, else 0.
    skipped: f64,
    /// The length of the shortest piece.
    shortest: f64,
    /// The length of the whole range.
    range: f64,
}

/// The outcome of a step along a piece.
enum Found {
    Nothing,
    Root(Root),
}

/// A stretch in which the first root lies.
struct Root {
    low: f64,
    high: f64,
    /// The root of a model.
    guess: f64,
    /// The slope of the model there, times the sign in front of it; 0 if there is no model.
    slope: f64,
}

impl Searches {
    /// No search in any lane.
    pub(crate) const NONE: Self =
        Self { lines: [[[0.0; LANES]; 3]; 2], walks: [Walk::NOWHERE; LANES], ends: [[0.0; 2]; LANES], lanes: 0 };

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
        self.walks[lane] = Walk::new(from, to);
        self.ends[lane] = [to, f64::from(until)];
        self.lanes |= 1 << lane;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lanes == 0
    }

    /// Returns the ends of each lane's next piece, without the lanes that have arrived.
    fn next_pieces(&mut self) -> [[f64; LANES]; 2] {
        let mut ends = [[0.0; LANES]; 2];
        for lane in set_bits(self.lanes) {
            let (Walk { t, length, .. }, [to, until]) = (&self.walks[lane], self.ends[lane]);
            if *t >= to || *t > until {
                self.lanes &= !(1 << lane);
            }
            (ends[0][lane], ends[1][lane]) = (*t, (t + length).min(to));
        }
        ends
    }
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
        SCRATCH.with_borrow_mut(|scratch| {
            let (mut found, mut brackets) = (0, [Bracket::NONE; LANES]);
            for _ in 0..MAX_PIECES {
                let pieces = searches.next_pieces();
                if searches.lanes == 0 {
                    break;
                }
                let ended = self.advance(searches, &pieces, &mut brackets, scratch);
                found |= ended;
                searches.lanes &= !ended;
            }
            // To the least f32, so that the root does not depend on the pieces: without this step up to 61 of 24,000
            // depths did.
            self.narrow(&searches.lines, &mut brackets, found, scratch);
            (found, F32x8(brackets.map(|bracket| bracket.after)))
        })
    }

    /// Advances each walk by a piece, and returns the lanes whose first root is now in a bracket.
    fn advance(
        self,
        searches: &mut Searches,
        pieces: &[[f64; LANES]; 2],
        brackets: &mut [Bracket; LANES],
        scratch: &mut Scratch,
    ) -> u32 {
        let (tape, packets) = (&self.formula.tape, &mut scratch.packets);
        let lines = &searches.lines;
        let outcome = simd::dispatch(PacketModels { tape, lines, pieces, lanes: searches.lanes, scratch: packets });
        let mut found = 0;
        for lane in set_bits(searches.lanes) {
            let (walk, piece) = (&mut searches.walks[lane], [pieces[0][lane], pieces[1][lane]]);
            if outcome.is_clear(lane) && walk.passes(outcome.sign(lane), piece) {
                continue;
            }
            let (mut model, mut continuity) = (outcome.model(lane), outcome.continuity(lane));
            // In f32, the model of a short piece may be little more than its rounding errors.
            let is_short = piece[1] - piece[0] < walk.range * SHORT;
            if is_short && !(model.error < BLUR * (model.c[1].abs() + model.c[2].abs())) {
                let line = line_in_lane(&searches.lines, lane);
                let (o, d) = (line.origin.to_array(), line.direction.to_array());
                let coordinates = [0, 1, 2].map(|axis| Model::coordinate(o[axis], d[axis], piece));
                (model, continuity) = tape.model(coordinates, &mut scratch.models);
            }
            if let Found::Root(root) = walk.advance(&model, continuity, piece) {
                brackets[lane] = Bracket::new(root, walk.sign);
                found |= 1 << lane;
            }
        }
        found
    }

    /// Narrows the brackets of these lanes until `after` is the first f32 of the other sign.
    fn narrow(self, lines: &Lines, brackets: &mut [Bracket; LANES], mut lanes: u32, scratch: &mut Scratch) {
        while lanes != 0 {
            let t = brackets.map(|bracket| f64::from(bracket.next));
            let (tape, scratch) = (&self.formula.tape, &mut scratch.values);
            let values = simd::dispatch(PacketValues { tape, lines, t: &t, scratch });
            for lane in set_bits(lanes) {
                if brackets[lane].take(values[lane]) {
                    lanes &= !(1 << lane);
                }
            }
        }
    }
}

/// Two places between which f changes its sign, on the way to neighbouring numbers.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    before: f32,
    after: f32,
    /// The sign of f in front of the root.
    sign: f64,
    /// The slope of f times the sign, below 0; 0 if it is not known yet.
    slope: f64,
    /// The place whose value is needed next.
    next: f32,
    /// The t that was evaluated last, and the value of f there times the sign.
    last: [f64; 2],
    /// The number of values so far.
    count: u32,
}

impl Bracket {
    const NONE: Self = Self { before: 0.0, after: 0.0, sign: 0.0, slope: 0.0, next: 0.0, last: [0.0; 2], count: 0 };

    fn new(Root { low, high, guess, slope }: Root, sign: f64) -> Self {
        let (before, after, slope) = (at_most(low), at_least(high), slope.min(0.0));
        let next = if slope < 0.0 { (guess as f32).max(before).min(after) } else { before };
        Self { before, after, sign, slope, next, ..Self::NONE }
    }

    /// Takes the value at `next`, and returns whether the bracket is as narrow as possible.
    fn take(&mut self, value: f64) -> bool {
        let (t, value) = (f64::from(self.next), value * self.sign);
        self.count += 1;
        if self.count == 1 && self.slope == 0.0 {
            (self.last, self.next) = ([t, value], self.after);
            return false;
        }
        // The values at the ends are not needed where their signs are known.
        if value > 0.0 {
            self.before = self.before.max(self.next);
        } else {
            self.after = self.after.min(self.next);
        }
        let (least, most) = (self.before.next_up(), self.after.next_down());
        if least > most {
            return true;
        }
        let secant = (value - self.last[1]) / (t - self.last[0]);
        // A secant that is NaN is not taken. Between neighbours it is that of rounding errors.
        if self.count > 1 && secant < 0.0 && (t - self.last[0]).abs() > 16.0 * f64::from(f32::EPSILON) * t.abs() {
            self.slope = secant;
        }
        self.last = [t, value];
        self.next = self.guess(t, value).max(least).min(most);
        false
    }

    /// Returns a place a little beyond the root, seen from the last place, so that the root is soon
    /// enclosed: by Newton's method, or the middle in turn if that takes long.
    fn guess(&self, t: f64, value: f64) -> f32 {
        let root = (t - value / self.slope) as f32;
        if !root.is_finite() || self.count > 3 && self.count % 2 == 1 {
            return (0.5 * (f64::from(self.before) + f64::from(self.after))) as f32;
        }
        if value > 0.0 { root.next_up() } else { root.next_down() }
    }
}

/// Returns the line of one lane, for models that are computed in f64.
fn line_in_lane(lines: &Lines, lane: usize) -> Line {
    let of = |axes: &[[f64; LANES]; 3]| DVec3::new(axes[0][lane], axes[1][lane], axes[2][lane]);
    Line { origin: of(&lines[0]), direction: of(&lines[1]) }
}

impl Walk {
    const NOWHERE: Self = Self {
        t: 0.0,
        length: 0.0,
        sign: 0.0,
        since: 0.0,
        undecided: 0,
        stride: 0.0,
        skipped: 0.0,
        shortest: 0.0,
        range: 0.0,
    };

    fn new(from: f64, to: f64) -> Self {
        let range = to - from;
        // A shorter piece could end at its start, by the rounding of t.
        let shortest = (MIN_PIECE * range).max(16.0 * f64::EPSILON * from.abs().max(to.abs()));
        Self { t: from, length: range, since: from, stride: shortest, shortest, range, ..Self::NOWHERE }
    }

    /// Passes a piece in which f has only this sign, unless that needs a closer look.
    fn passes(&mut self, sign: f64, [from, to]: [f64; 2]) -> bool {
        let is_simple = self.skipped == 0.0 && (self.sign == sign || self.sign == 0.0);
        if is_simple {
            self.since = to;
            self.pass(to, 2.0 * (to - from), sign);
        }
        is_simple
    }

    /// Moves past the piece, or to where it has to be looked at more closely.
    fn advance(&mut self, model: &Model, continuity: Continuity, piece @ [from, to]: [f64; 2]) -> Found {
        let width = to - from;
        if continuity.is_undefined {
            return self.pass(to, 2.0 * width, 0.0);
        }
        let [c0, c1, c2] = model.c;
        // The coefficients in the Bernstein basis: the polynomial lies between the least and the greatest.
        let b = [c0 - c1 + c2, c0 - c2, c0 + c1 + c2];
        let sign = if b[0].abs() > model.error { b[0].signum() } else { 0.0 };
        if sign == 0.0 {
            return self.undecided(continuity, piece);
        }
        if self.skipped > 1.5 * self.shortest {
            return self.retreat(from);
        }
        (self.undecided, self.stride) = (0, self.shortest);
        if self.sign != 0.0 && sign != self.sign && from - self.since <= MAX_STRETCH * self.range {
            return Found::Root(Root { low: self.since, high: from, guess: from, slope: 0.0 });
        }
        (self.sign, self.since) = (sign, from);
        if b.iter().all(|b| sign * b > model.error) {
            self.since = to;
            return self.pass(to, 2.0 * width, sign);
        }
        if continuity.may_jump {
            if width <= 1.5 * self.shortest {
                return self.pass(to, 2.0 * width, 0.0);
            }
            self.length = 0.5 * width;
            return Found::Nothing;
        }
        self.approach(b.map(|b| sign * b), model.error, piece)
    }

    /// Moves to `t`, where `sign` is certain, or unknown if it is 0.
    fn pass(&mut self, t: f64, length: f64, sign: f64) -> Found {
        (self.t, self.length, self.sign) = (t, length.max(self.shortest), sign);
        (self.undecided, self.stride, self.skipped) = (0, self.shortest, 0.0);
        Found::Nothing
    }

    /// Returns to the start of the long piece that was passed last, and continues in shorter ones.
    ///
    /// Its sign was undecided, and is certain at its end: roots may lie between.
    fn retreat(&mut self, from: f64) -> Found {
        self.stride = (0.125 * self.skipped).max(self.shortest);
        (self.t, self.length, self.skipped) = (from - self.skipped, self.stride, 0.0);
        Found::Nothing
    }

    /// Shortens a piece at whose start the sign is uncertain, or passes it if it is short.
    fn undecided(&mut self, continuity: Continuity, [from, to]: [f64; 2]) -> Found {
        let width = to - from;
        // A piece from t on may be longer than asked for, by the rounding of its end.
        if width > 1.5 * self.stride {
            self.length = (0.25 * width).max(self.stride);
            return Found::Nothing;
        }
        self.undecided += 1;
        if continuity.may_jump {
            self.sign = 0.0;
        }
        if self.undecided > STRIDES_FROM {
            self.stride = (2.0 * self.stride).min(MAX_STRIDE * self.range);
        }
        (self.t, self.length, self.skipped) = (to, 2.0 * width, width);
        Found::Nothing
    }

    /// Advances to the first t of the piece that may be a root.
    ///
    /// If the sign is certainly the other one farther on, the next piece ends there, and a short one is a bracket.
    /// `b` are the Bernstein coefficients, the first of which is positive and above `error`.
    fn approach(&mut self, b: [f64; 3], error: f64, [from, to]: [f64; 2]) -> Found {
        let width = to - from;
        // The polynomial falls from b[0] at most this much, as a share of the piece: the least slope of its chords.
        let steepest = (2.0 * (b[1] - b[0])).min(b[2] - b[0]);
        // Not quite to the zero, so that the sign there is certain in spite of rounding.
        let near = (0.999 * (b[0] - error) / -steepest).clamp(0.0, 1.0);
        let far = first_below(b, -error);
        let start = from + near * width;
        self.since = start;
        if let Some(far) = far {
            let end = (from + far * width).min(to);
            if end - start <= BRACKET * self.range {
                let at_zero = first_below(b, 0.0).unwrap_or(far);
                let slope = 2.0 * ((b[1] - b[0]) + at_zero * (b[0] - 2.0 * b[1] + b[2])) / width;
                return Found::Root(Root { low: start, high: end, guess: from + at_zero * width, slope });
            }
            // Shorter than this piece in any case, so that the search comes to an end.
            (self.t, self.length) = (start, (end - start).min(0.75 * width));
            return Found::Nothing;
        }
        if width <= 1.5 * self.shortest {
            // As far as can be told, f touches zero here and keeps its sign.
            self.since = from;
            return self.pass(to, 2.0 * width, self.sign);
        }
        (self.t, self.length) = (start, (0.5 * (to - start)).max(self.shortest));
        Found::Nothing
    }
}

/// Returns a share of the piece shortly behind the first one at which the polynomial is at `level`.
///
/// The polynomial is certainly below `level` there; `None` if no such share is found.
fn first_below(b: [f64; 3], level: f64) -> Option<f64> {
    let (start, slope, curvature) = (b[0] - level, 2.0 * (b[1] - b[0]), b[0] - 2.0 * b[1] + b[2]);
    let under_root = slope * slope - 4.0 * curvature * start;
    // True also for NaN.
    if !(under_root >= 0.0) {
        return None;
    }
    let sum = -0.5 * (slope + under_root.sqrt().copysign(slope));
    let root = [sum / curvature, start / sum].into_iter().filter(|root| (0.0..=1.0).contains(root)).reduce(f64::min)?;
    let behind = (root + 1e-6 * root + 1e-9).min(1.0);
    let there = b[0] + behind * (slope + behind * curvature);
    (there < level).then_some(behind)
}

/// Returns the largest f32 that is not above `t`.
fn at_most(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) > t { rounded.next_down() } else { rounded }
}

/// Returns the least f32 that is not below `t`.
fn at_least(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) < t { rounded.next_up() } else { rounded }
}
