//! How finely pictures are traced, by the clock: while the view moves as finely as the time of a frame allows, and once
//! it stands still in a few steps to the end.
//!
//! Pure: it is told how long frames took.

use crate::render::Sampling;
use std::num::NonZeroU32;
use std::time::Duration;

/// What a picture may get, from the coarsest to the end.
const LEVELS: [Sampling; 5] = [Sampling::Coarse, up_to(1), up_to(4), up_to(16), Sampling::BEST];

const fn up_to(samples: u32) -> Sampling {
    Sampling::UpTo(NonZeroU32::new(samples).expect("no level is without samples"))
}

/// One sample of each pixel.
const ONE: usize = 1;
/// The most of a picture in motion.
const MOST: usize = 3;
/// How many times as long each level takes as the one before it, until more is known: coarse pixels are four in one;
/// then only the edges are traced again.
const GROWTH: [f64; MOST + 1] = [1.0, 4.0, 2.0, 3.0];
/// So much of a frame's time is for tracing.
const SHARE: f64 = 0.75;
/// So much of that may be expected of a finer level: between this and all of it nothing changes.
const ROOM: f64 = 0.8;
/// How many frames in a row have to have room for a finer level before it is tried.
const ROOMY: u32 = 8;
/// How many have to be late before a coarser one is: one may be so by chance, if it is not very late.
const LATE: u32 = 2;

/// How finely the next picture is traced.
pub(super) struct Effort {
    /// The same always.
    forced: Option<Sampling>,
    /// The level of pictures in motion.
    level: usize,
    /// The level of the last picture, and its time in seconds.
    last: Option<(usize, f64)>,
    /// How many times as long each level takes as the one before it.
    growth: [f64; MOST + 1],
    /// How many pictures in a row left room for a finer level.
    roomy: u32,
    /// How many in a row were late.
    late: u32,
}

impl Effort {
    /// By the clock, or always the same.
    pub(super) fn new(forced: Option<Sampling>) -> Self {
        Self { forced, level: ONE, last: None, growth: GROWTH, roomy: 0, late: 0 }
    }

    /// For a picture of a new view: in the midst of a motion, or after a rest, when the user waits for it.
    pub(super) fn of_new_view(&self, in_motion: bool) -> Sampling {
        let level = if in_motion { self.level } else { self.level.min(ONE) };
        self.forced.unwrap_or(LEVELS[level])
    }

    /// For the next step of a picture that stands still; `None`: it is as good as it gets. A picture, its steps and all
    /// take three frames at most, and two and a half times the bytes of a whole one: a coarse one takes less than half.
    pub(super) fn of_next_step(&self, shown: Sampling) -> Option<Sampling> {
        let next = if shown == Sampling::Coarse { LEVELS[ONE + 1] } else { Sampling::BEST };
        (self.forced.is_none() && shown != next).then_some(next)
    }

    /// Whether the next steps of the last picture are expected to take no longer than that, all together.
    pub(super) fn ends_within(&self, time: Duration) -> bool {
        self.last.is_some_and(|last| self.expected(last, MOST) <= time.as_secs_f64())
    }

    /// A picture of a new view took so long, of a frame's time.
    pub(super) fn took(&mut self, sampling: Sampling, time: Duration, frame: Duration) {
        let Some(level) = LEVELS.iter().position(|&level| level == sampling).filter(|&level| level <= MOST) else {
            return;
        };
        let most = SHARE * frame.as_secs_f64();
        let at_last = (level, time.as_secs_f64());
        self.learn(at_last);
        let finest = |limit: f64| (0..=MOST).rev().find(|&level| self.expected(at_last, level) <= limit).unwrap_or(0);
        let (fits, has_room) = (finest(most), finest(ROOM * most));
        let is_very_late = self.expected(at_last, self.level) > 2.0 * most;
        self.late = if fits < self.level { self.late + 1 } else { 0 };
        self.roomy = if has_room > self.level { self.roomy + 1 } else { 0 };
        if self.late >= LATE || is_very_late {
            self.level = fits;
        } else if self.roomy >= ROOMY {
            self.level += 1;
            self.roomy = 0;
        }
    }

    /// Pictures are of something else or of another size from now on: their times cannot be compared with those of before.
    pub(super) fn forget_last(&mut self) {
        self.last = None;
    }

    /// Two pictures of neighbouring levels, one after the other, tell how many times as long the finer one takes.
    fn learn(&mut self, at_last: (usize, f64)) {
        let Some(before) = self.last.replace(at_last) else { return };
        let (coarse, fine) = if before.0 < at_last.0 { (before, at_last) } else { (at_last, before) };
        if fine.0 == coarse.0 + 1 && coarse.1 > 0.0 {
            let growth = &mut self.growth[fine.0];
            // The mean with what was known: either picture may have been held up.
            *growth = (0.5 * (*growth + fine.1 / coarse.1)).clamp(1.0, 8.0);
        }
    }

    /// How long a picture of that level would have taken instead of the last one.
    fn expected(&self, (last, time): (usize, f64), level: usize) -> f64 {
        let growth = |levels: std::ops::Range<usize>| levels.map(|level| self.growth[level + 1]).product::<f64>();
        if level >= last { time * growth(last..level) } else { time / growth(level..last) }
    }
}

#[cfg(test)]
mod tests;
