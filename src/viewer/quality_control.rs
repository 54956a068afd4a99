//! The choice of the sampling by the time that frames take.
//!
//! In motion a frame gets as many samples as fit its time; at rest a few refinements lead to the final picture.
//!
//! Pure: it reads no clock, and the times that frames took are passed in.

use crate::render::Sampling;
use std::num::NonZeroU32;
use std::time::Duration;

/// The levels of sampling, from the coarsest to the final one.
// Each level has four times the samples of the one before, which halves the error of their mean.
const LEVELS: [Sampling; 5] = [Sampling::Coarse, up_to(1), up_to(4), up_to(16), Sampling::BEST];

const fn up_to(samples: u32) -> Sampling {
    Sampling::UpTo(NonZeroU32::new(samples).expect("no level is without samples"))
}

/// Index of the level of one sample per pixel.
const ONE_SAMPLE_LEVEL: usize = 1;
/// Index of the finest level that pictures in motion may have.
// The final level, of up to 64 samples, takes several times as long, and a picture at rest is refined to it in one step
// anyway.
const MAX_MOTION_LEVEL: usize = 3;
/// Initial ratios of each level's time to that of the level before it, until they are measured.
// A coarse frame has one ray for four pixels. The levels above one sample trace only pixels with edges again, about a
// third of all.
const INITIAL_COST_RATIOS: [f64; MAX_MOTION_LEVEL + 1] = [1.0, 4.0, 2.0, 3.0];
/// Share of a frame's time that tracing may take.
// The rest of the time is for making cells and bytes, and for the terminal, which draws on the same cores.
pub(crate) const TRACING_SHARE: f64 = 0.75;
/// A finer level is tried only if it is predicted to take at most this share of the time for
/// tracing.
// A share below 1 keeps the level from oscillating: a level that takes more than this share is kept if it is in use,
// but is not tried anew. The test `no_level_flickers` covers all frame times up to 40 ms with a noise of a tenth.
const FINER_LEVEL_SHARE: f64 = 0.8;
/// Number of frames in a row that must be fast enough for a finer level before it is tried.
// An eighth of a second at 60 frames per second: a finer level this much later goes unnoticed, but an attempt that
// fails costs a late frame.
const FRAMES_BEFORE_FINER: u32 = 8;
/// Greatest number of such frames, after attempts that failed.
// Each failed attempt doubles the number. With 8 frames always, a fifth of 200 viewers of a busy server alternated
// between two levels, twice a second, because all attempts together made the frames of all of them late.
const MAX_FRAMES_BEFORE_FINER: u32 = 128;
/// Number of frames without a fall after which an attempt at a finer level counts as successful.
const FRAMES_OF_SUCCESS: u32 = 64;
/// Number of late frames in a row before a coarser level is chosen.
// A single frame may be late because another process had the core. A frame that is very late counts at once.
const LATE_FRAMES_BEFORE_COARSER: u32 = 2;

/// The choice of the next picture's level of sampling, from the times of the pictures before.
pub(super) struct QualityControl {
    /// The sampling that the user has fixed, if any.
    forced: Option<Sampling>,
    /// Index in [`LEVELS`] of the level that is chosen for pictures in motion.
    level: usize,
    /// The level of the last picture, and the seconds that it took.
    last: Option<(usize, f64)>,
    /// Ratio of each level's time to that of the level before it: initial values, updated by
    /// measurements.
    cost_ratios: [f64; MAX_MOTION_LEVEL + 1],
    /// Number of pictures in a row that were fast enough for a finer level.
    frames_with_room: u32,
    /// Number of such pictures before a finer level is tried.
    frames_before_finer: u32,
    /// Number of pictures since the level last rose.
    frames_since_rise: u32,
    /// Number of late pictures in a row.
    late_frames: u32,
}

impl QualityControl {
    /// Returns a control that chooses the sampling by time, or always `forced` if given.
    pub(super) fn new(forced: Option<Sampling>) -> Self {
        Self {
            forced,
            level: ONE_SAMPLE_LEVEL,
            last: None,
            cost_ratios: INITIAL_COST_RATIOS,
            frames_with_room: 0,
            frames_before_finer: FRAMES_BEFORE_FINER,
            frames_since_rise: FRAMES_OF_SUCCESS,
            late_frames: 0,
        }
    }

    /// Returns the sampling of the first picture of a new view.
    ///
    /// After a rest, not `after_motion`, it has at most one sample per pixel.
    pub(super) fn first_sampling(&self, after_motion: bool) -> Sampling {
        // The user waits for the first frame after a rest, which is refined anyway if the view then stays.
        let level = if after_motion { self.level } else { self.level.min(ONE_SAMPLE_LEVEL) };
        self.forced.unwrap_or(LEVELS[level])
    }

    /// Returns the sampling of the refinement after `shown`, or `None` if the picture is final.
    ///
    /// A picture has at most two refinements. The three frames have at most two and a half times the bytes of one,
    /// because the first one is then coarse and takes less than half.
    pub(super) fn next_refinement(&self, shown: Sampling) -> Option<Sampling> {
        // A coarse picture gets a refinement in between, because it would stay on the screen for a noticeable time if
        // the final level, which takes long, came next.
        let next = if shown == Sampling::Coarse { LEVELS[ONE_SAMPLE_LEVEL + 1] } else { Sampling::BEST };
        (self.forced.is_none() && shown != next).then_some(next)
    }

    /// Returns whether the refinements of the last picture are expected to take at most `time` in
    /// total.
    pub(super) fn finishes_refining_within(&self, time: Duration) -> bool {
        self.last.is_some_and(|last| self.predicted_time(last, MAX_MOTION_LEVEL) <= time.as_secs_f64())
    }

    /// Adapts the sampling level of the next pictures to the time of a picture of a new view.
    ///
    /// Of `frame_interval`, the time between two frames, tracing may take [`TRACING_SHARE`].
    pub(super) fn adapt_level(&mut self, sampling: Sampling, time: Duration, frame_interval: Duration) {
        let Some(level) = LEVELS.iter().position(|&level| level == sampling).filter(|&level| level <= MAX_MOTION_LEVEL)
        else {
            return;
        };
        let most = TRACING_SHARE * frame_interval.as_secs_f64();
        let at_last = (level, time.as_secs_f64());
        self.update_cost_ratio(at_last);
        let finest = |limit: f64| {
            (0..=MAX_MOTION_LEVEL).rev().find(|&level| self.predicted_time(at_last, level) <= limit).unwrap_or(0)
        };
        let (fits, has_room) = (finest(most), finest(FINER_LEVEL_SHARE * most));
        let is_very_late = self.predicted_time(at_last, self.level) > 2.0 * most;
        self.late_frames = if fits < self.level { self.late_frames + 1 } else { 0 };
        self.frames_with_room = if has_room > self.level { self.frames_with_room + 1 } else { 0 };
        if self.late_frames >= LATE_FRAMES_BEFORE_COARSER || is_very_late {
            // The level may fall by several at once, because each late frame is visible.
            self.level = fits;
            if self.frames_since_rise < FRAMES_OF_SUCCESS {
                self.frames_before_finer = (2 * self.frames_before_finer).min(MAX_FRAMES_BEFORE_FINER);
                self.frames_since_rise = FRAMES_OF_SUCCESS;
            }
        } else if self.frames_with_room >= self.frames_before_finer {
            // The level rises by one at a time, because the predicted time of a level that was not tried is a guess.
            self.level += 1;
            (self.frames_with_room, self.frames_since_rise) = (0, 0);
        } else if self.frames_since_rise < FRAMES_OF_SUCCESS {
            self.frames_since_rise += 1;
            if self.frames_since_rise == FRAMES_OF_SUCCESS {
                self.frames_before_finer = FRAMES_BEFORE_FINER;
            }
        }
    }

    /// Forgets the last picture's time, because that of another scene or size is not comparable.
    pub(super) fn forget_last(&mut self) {
        self.last = None;
        (self.frames_with_room, self.late_frames) = (0, 0);
        (self.frames_before_finer, self.frames_since_rise) = (FRAMES_BEFORE_FINER, FRAMES_OF_SUCCESS);
    }

    /// Updates the cost ratio of two neighbouring levels if the last two pictures had these levels.
    fn update_cost_ratio(&mut self, at_last: (usize, f64)) {
        let Some(before) = self.last.replace(at_last) else { return };
        let (coarse, fine) = if before.0 < at_last.0 { (before, at_last) } else { (at_last, before) };
        if fine.0 == coarse.0 + 1 && coarse.1 > 0.0 {
            let growth = &mut self.cost_ratios[fine.0];
            // The new ratio is averaged with the previous one, because either picture may have been delayed by another
            // process.
            *growth = (0.5 * (*growth + fine.1 / coarse.1)).clamp(1.0, 8.0);
        }
    }

    /// Returns the predicted seconds that a picture takes at `level`, if one at level `last` took
    /// `time` seconds.
    fn predicted_time(&self, (last, time): (usize, f64), level: usize) -> f64 {
        let growth = |levels: std::ops::Range<usize>| levels.map(|level| self.cost_ratios[level + 1]).product::<f64>();
        if level >= last { time * growth(last..level) } else { time / growth(level..last) }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
