//! The first root of a formula along a ray: the first sign change across which it is continuous.
//!
//! Eight [`walks`](super::walks) go side by side, one per ray: their pieces are enclosed together, in f32. A sign
//! change may be lost if it is undone within [`MIN_PIECE`](super::walks::MIN_PIECE) of the range, or behind
//! [`MAX_PIECES`] pieces.
//!
//! A sign change at a jump is no root, and neither is a zero without a sign change.

use super::Formula;
use super::bracket::{Brackets, Narrowing};
use super::choices::ShorterTape;
use super::forecast::{SignForecast, SignForecasts};
use super::model::Model;
use super::models::StoredModels;
use super::packet::{EightValues, Lines, PacketModels};
use super::tape::{Steps, Tape};
use super::values::{PacketValues, PairedValues};
use super::walks::{StepOutcome, Walks};
use crate::lanes::{F32x8, LANES, Lanes, SimdKernel, set_bits};
use crate::simd;
use glam::DVec3;
use std::cell::RefCell;

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
    values: Vec<PairedValues>,
    shorter: ShorterTape,
}

/// The search for roots of a formula along up to eight lines at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solver<'f> {
    formula: &'f Formula,
}

/// Up to eight searches: each lane's line, its range of t, and the t after which no root is needed.
#[derive(Clone, Debug)]
pub(crate) struct Searches {
    pub(crate) lines: Lines,
    /// The starts of the ranges, then their ends.
    pub(crate) ranges: [F32x8; 2],
    pub(crate) until: F32x8,
    /// The mask of the lanes that search.
    pub(crate) lanes: u32,
}

impl Searches {
    /// No search in any lane.
    pub(crate) const NONE: Self =
        Self { lines: [[[0.0; LANES]; 3]; 2], ranges: [F32x8::ZERO; 2], until: F32x8::ZERO, lanes: 0 };

    /// Adds a lane: see [`Solver::first_root`].
    pub(crate) fn add(&mut self, lane: usize, line: &Line, [start, end]: [f32; 2], until: f32) {
        self.set_line(lane, line);
        (self.ranges[0].0[lane], self.ranges[1].0[lane], self.until.0[lane]) = (start, end, until);
        self.lanes |= 1 << lane;
    }

    pub(crate) fn set_line(&mut self, lane: usize, line: &Line) {
        for (lines, vector) in self.lines.iter_mut().zip([line.origin, line.direction]) {
            for (numbers, number) in lines.iter_mut().zip(vector.to_array()) {
                numbers[lane] = number;
            }
        }
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
        let (lanes, roots) = self.first_roots(&searches);
        (lanes != 0).then_some(roots.0[0])
    }

    /// Returns the lanes with a root, and their first roots, none of which depends on the other
    /// lanes.
    pub(crate) fn first_roots(self, searches: &Searches) -> (u32, F32x8) {
        SCRATCH.with_borrow_mut(|scratch| simd::dispatch(RootSearch { tape: &self.formula.tape, searches, scratch }))
    }
}

/// The search for the first roots along up to eight lines.
struct RootSearch<'a> {
    tape: &'a Tape,
    searches: &'a Searches,
    scratch: &'a mut SearchScratch,
}

impl SimdKernel for RootSearch<'_> {
    type Output = (u32, F32x8);

    #[inline(always)]
    fn run<N: Lanes>(self) -> (u32, F32x8) {
        let Self { tape, searches, scratch: SearchScratch { models, packets, values, shorter } } = self;
        let Searches { lines, ranges, until, lanes } = searches;
        let mut walks = Walks::new(ranges, until, *lanes, tape.is_algebraic());
        if walks.lanes == 0 {
            return (0, F32x8::ZERO);
        }
        let (mut found, mut brackets, mut steps) = (0, Brackets::NONE, tape.steps());
        if tape.has_many_choices() {
            let pieces = [walks.t, walks.ends];
            let packet =
                PacketModels { tape, steps, lines, pieces: &pieces, lanes: walks.lanes, scratch: &mut *packets };
            // A formula with a certain sign on the whole range has no root there.
            walks.lanes &= !shorter.shorten::<N>(packet);
            steps = shorter.steps();
        }
        for _ in 0..MAX_PIECES {
            let pieces = walks.next_pieces();
            let lanes = walks.lanes;
            if lanes == 0 {
                break;
            }
            let forecasts =
                PacketModels { tape, steps, lines, pieces: &pieces, lanes, scratch: &mut *packets }.run::<N>();
            let [done, arrived] = walks.advance_frequent(&forecasts, &pieces, lanes, &mut brackets);
            let (rest, mut ended) = (lanes & !done, arrived);
            if rest != 0 {
                let course = Course { tape, steps, lines, pieces: &pieces };
                ended |= course.advance_one_by_one(rest, &forecasts, &mut walks, &mut brackets, models);
            }
            found |= ended;
            walks.lanes &= !ended;
            if walks.lanes == 0 {
                break;
            }
        }
        // The root is narrowed down to the first f32 of the other sign, so that it does not depend on the pieces of the
        // walk: without this step up to 61 of 24,000 depths did.
        let values = PacketValues { tape, steps, lines, scratch: values };
        (found, Narrowing { values, brackets: &mut brackets, lanes: found }.run::<N>())
    }
}

/// The pieces that eight searches examine next.
struct Course<'a> {
    tape: &'a Tape,
    steps: Steps<'a>,
    lines: &'a Lines,
    pieces: &'a [EightValues; 2],
}

impl Course<'_> {
    /// Advances the walks of `lanes` one by one.
    ///
    /// Returns the lanes whose first root is now in a bracket.
    #[inline(never)]
    fn advance_one_by_one(
        &self,
        lanes: u32,
        forecasts: &SignForecasts,
        walks: &mut Walks,
        brackets: &mut Brackets,
        models: &mut Vec<Model>,
    ) -> u32 {
        let mut found = 0;
        for lane in set_bits(lanes) {
            let (mut walk, piece) = (walks.walk(lane), [self.pieces[0][lane], self.pieces[1][lane]]);
            let (mut forecast, mut continuity) = (forecasts.forecast(lane), forecasts.continuity(lane));
            // In f32, the model of a short piece may be little more than its rounding errors.
            if forecasts.has_large_error(lane) && walk.is_short_for_f32(piece) {
                let line = line_in_lane(self.lines, lane);
                let (o, d) = (line.origin.to_array(), line.direction.to_array());
                let coordinates = [0, 1, 2].map(|axis| Model::coordinate(o[axis], d[axis], piece));
                let (model, of_model) = self.tape.model_of_steps(self.steps, lane, coordinates, models);
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
}

/// Returns the line of one lane, for models that are computed in f64.
fn line_in_lane(lines: &Lines, lane: usize) -> Line {
    let of = |axes: &[[f64; LANES]; 3]| DVec3::new(axes[0][lane], axes[1][lane], axes[2][lane]);
    Line { origin: of(&lines[0]), direction: of(&lines[1]) }
}
