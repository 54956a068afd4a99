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
use super::packet::{PacketModels, StoredModels, coordinates, of_lane};
use crate::lanes::{F32x8, LANES, set_bits};
use crate::simd;
use glam::DVec3;

/// The length of the shortest piece, relative to the range.
const MIN_PIECE: f64 = 1e-9;

/// The relative length of a piece with a sign change at which the search among points begins.
const BRACKET: f64 = 1.0 / 16_384.0;

/// The relative length of a piece below which models are computed in f64.
const FINE: f64 = 1.0 / 8192.0;

/// The length of the longest stretch of undecided sign that may hide a root, relative to the range.
// f may be zero on a whole stretch of the ray, which is no surface. Near a triple root it may be zero in f64.
const MAX_STRETCH: f64 = 1.0 / 256.0;

/// The number of pieces of undecided sign in a row from which on each is twice as long.
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

/// The search for roots along up to eight lines at once, with its scratch memory.
#[derive(Debug)]
pub(crate) struct Solver<'f> {
    formula: &'f Formula,
    models: Vec<Model>,
    packets: Vec<StoredModels>,
    values: Vec<f64>,
}

/// Up to eight searches: each lane's line, range, and the t after which its root is not needed.
#[derive(Clone, Debug)]
pub(crate) struct Searches {
    /// The origins, then the directions, axis by axis.
    lines: [[[f64; LANES]; 3]; 2],
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

/// The outcome of a piece.
enum Found {
    Nothing,
    /// The first root lies between these two.
    Root([f64; 2]),
}

impl Searches {
    /// No search in any lane.
    pub(crate) const NONE: Self =
        Self { lines: [[[0.0; LANES]; 3]; 2], walks: [Walk::NOWHERE; LANES], ends: [[0.0; 2]; LANES], lanes: 0 };

    /// Adds a lane, unless its range is empty: see [`Solver::first_root`].
    pub(crate) fn add(&mut self, lane: usize, line: &Line, [start, end]: [f32; 2], until: f32) {
        let (from, to) = (f64::from(start), f64::from(end));
        let range = to - from;
        // Also rejects NaN.
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

    fn line(&self, lane: usize) -> Line {
        let [origin, direction] = self.lines.map(|axes| DVec3::from_array(axes.map(|numbers| numbers[lane])));
        Line { origin, direction }
    }

    /// Returns the next piece of each lane, after the end of those that have arrived.
    fn pieces(&mut self) -> [[f64; 2]; LANES] {
        let mut pieces = [[0.0; 2]; LANES];
        for lane in set_bits(self.lanes) {
            let (Walk { t, length, .. }, [to, until]) = (self.walks[lane], self.ends[lane]);
            if t >= to || t > until {
                self.lanes &= !(1 << lane);
            }
            pieces[lane] = [t, (t + length).min(to)];
        }
        pieces
    }
}

impl<'f> Solver<'f> {
    pub(crate) fn new(formula: &'f Formula) -> Self {
        Self { formula, models: Vec::new(), packets: Vec::new(), values: Vec::new() }
    }

    /// Returns the first root in `start..=end`, unless it is known to lie behind `until`.
    ///
    /// It is the first f32 at which the sign of f, computed in f64, differs from the sign in front of it. `until`
    /// only ends the search early; it does not change a root in front of it. A root at `start` itself is passed, so
    /// that the search from a root finds the next one.
    pub(crate) fn first_root(&mut self, line: &Line, range: [f32; 2], until: f32) -> Option<f32> {
        let mut searches = Searches::NONE;
        searches.add(0, line, range, until);
        let (lanes, roots) = self.first_roots(searches);
        (lanes != 0).then_some(roots.0[0])
    }

    /// Returns the lanes with a root, and their first roots: each as if it were alone.
    pub(crate) fn first_roots(&mut self, mut searches: Searches) -> (u32, F32x8) {
        let (mut found, mut roots) = (0, F32x8::ZERO);
        for _ in 0..MAX_PIECES {
            let pieces = searches.pieces();
            if searches.lanes == 0 {
                break;
            }
            // Short pieces are left to f64: in f32, their models are rounding errors.
            let is_short = |lane: &usize| pieces[*lane][1] - pieces[*lane][0] < searches.walks[*lane].range * FINE;
            let fine = set_bits(searches.lanes).filter(is_short).fold(0, |lanes, lane| lanes | 1 << lane);
            let coarse = searches.lanes & !fine;
            let packet = (coarse != 0).then(|| self.packet(&searches, &pieces, coarse));
            for lane in set_bits(searches.lanes) {
                let line = searches.line(lane);
                let (model, continuity) = match &packet {
                    Some((models, continuity)) if coarse >> lane & 1 == 1 => (of_lane(models, lane), continuity[lane]),
                    _ => self.model(&line, pieces[lane]),
                };
                if let Found::Root(bracket) = searches.walks[lane].advance(&model, continuity, pieces[lane]) {
                    roots.0[lane] = self.first_change(&line, bracket, searches.walks[lane].sign);
                    found |= 1 << lane;
                    searches.lanes &= !(1 << lane);
                }
            }
        }
        (found, roots)
    }

    fn packet(
        &mut self,
        searches: &Searches,
        pieces: &[[f64; 2]; LANES],
        lanes: u32,
    ) -> (StoredModels, [Continuity; LANES]) {
        let [o, d] = &searches.lines;
        let coordinates = [0, 1, 2].map(|axis| coordinates(&o[axis], &d[axis], pieces));
        let scratch = &mut self.packets;
        simd::dispatch(PacketModels { tape: &self.formula.tape, coordinates, lanes, scratch })
    }

    fn model(&mut self, line: &Line, piece: [f64; 2]) -> (Model, Continuity) {
        let (o, d) = (line.origin.to_array(), line.direction.to_array());
        let coordinates = [0, 1, 2].map(|axis| Model::coordinate(o[axis], d[axis], piece));
        self.formula.tape.model(coordinates, &mut self.models)
    }

    fn value(&mut self, line: &Line, t: f32) -> f64 {
        self.formula.tape.value(line.origin + line.direction * f64::from(t), &mut self.values)
    }

    /// Returns the first f32 in the bracket at which the sign is no longer `sign`.
    fn first_change(&mut self, line: &Line, [low, high]: [f64; 2], sign: f64) -> f32 {
        let (mut before, mut after) = (at_most(low), at_least(high));
        let (mut value_before, mut value_after) = (self.value(line, before) * sign, self.value(line, after) * sign);
        if value_after > 0.0 {
            // The formula changes its sign and changes it back between two neighbouring numbers.
            return after;
        }
        let mut is_behind = None;
        for step in 1_u32.. {
            let (least, most) = (before.next_up(), after.next_down());
            if least > most {
                break;
            }
            // The secant's root (after the Illinois method); every fourth time the middle, if the secant is poor.
            let share = if step % 4 == 0 { 0.5 } else { value_before / (value_before - value_after) };
            let (from, to) = (f64::from(before), f64::from(after));
            let guess = (from + (to - from) * if (0.0..=1.0).contains(&share) { share } else { 0.5 }) as f32;
            // A little beyond the secant's root, seen from the last guess, so that the root is soon enclosed.
            let guess = match is_behind {
                Some(true) => guess.next_up().next_up(),
                Some(false) => guess.next_down().next_down(),
                None => guess,
            };
            let guess = guess.max(least).min(most);
            let value = self.value(line, guess) * sign;
            is_behind = Some(value > 0.0);
            if value > 0.0 {
                (before, value_before, value_after) = (guess, value, 0.5 * value_after);
            } else {
                (after, value_after, value_before) = (guess, value, 0.5 * value_before);
            }
        }
        after
    }
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
        let shortest = (MIN_PIECE * range).max(16.0 * f64::EPSILON * from.abs().max(to.abs()));
        Self { t: from, length: range, since: from, stride: shortest, shortest, range, ..Self::NOWHERE }
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
            return Found::Root([self.since, from]);
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
                return Found::Root([start, end]);
            }
            (self.t, self.length) = (start, (end - start).min(0.75 * width));
            return Found::Nothing;
        }
        if width <= 1.5 * self.shortest {
            // It touches zero as far as can be told.
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
    // Also rejects NaN.
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
