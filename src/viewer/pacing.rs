//! Record of the frames begun and bytes sent, which determines the next frame's sampling and byte
//! limit.

use super::frame::{Frame, Shot};
use super::options::Options;
use super::quality_control::QualityControl;
use crate::pace::{Limit, Link};
use crate::render::Sampling;
use std::time::Duration;

/// The congestion control of the link, the quality control of the sampling, and the last frame
/// begun.
pub(super) struct Pacing {
    link: Link,
    quality: QualityControl,
    /// The last frame that was begun for a new view, as opposed to a refinement.
    begun: Option<Begun>,
    /// The last shot that a frame was begun for whose time counts.
    timed: Option<Shot>,
}

struct Begun {
    shot: Shot,
    at: Duration,
    /// Whether the view was in motion when the frame was begun.
    in_motion: bool,
}

impl Pacing {
    pub(super) fn new(options: &Options, may_query: bool) -> Self {
        let link = Link::new(options.max_rate, options.max_frames, may_query);
        Self { link, quality: QualityControl::new(options.sampling), begun: None, timed: None }
    }

    /// Forgets the last frame that was begun, so that another one is begun even of the same shot.
    #[cfg(feature = "serve")]
    pub(super) fn forget_begun(&mut self) {
        self.begun = None;
    }

    /// Returns whether the last frame begun shows `shot`.
    pub(super) fn has_begun(&self, shot: &Shot) -> bool {
        self.begun.as_ref().is_some_and(|begun| begun.shot == *shot)
    }

    /// Returns the time at which the last frame of a new view was begun.
    pub(super) fn begun_at(&self) -> Option<Duration> {
        self.begun.as_ref().map(|begun| begun.at)
    }

    /// Records that a frame of a new view is begun, and returns its sampling.
    pub(super) fn begin_frame(&mut self, shot: Shot, in_motion: bool, now: Duration) -> Sampling {
        let before = self.begun.replace(Begun { shot, at: now, in_motion });
        // The quality control compares the times of consecutive frames, which is valid only if their shots cost alike.
        if self.timed.replace(shot).is_some_and(|before| !shot.takes_as_long_as(&before)) {
            self.quality.forget_last();
        }
        // On a slow link a frame begins when a reply arrives, and the link is idle while the frame is traced, so the
        // frame gets few samples. Of a link of 50 KB/s, frames used 81 to 84 % with as many samples as time allows, and
        // 84.5 to 85.2 % with one per pixel.
        self.quality.first_sampling(before.is_some_and(|before| before.in_motion) && !self.link.is_slow())
    }

    /// Records that the frame of a picture at rest in finer glyphs is begun, whose time does not
    /// count.
    pub(super) fn begin_resting_frame(&mut self, shot: Shot, now: Duration) {
        self.begun = Some(Begun { shot, at: now, in_motion: false });
    }

    /// Returns the sampling of the next refinement of a picture with this sampling, or `None` if it
    /// is final.
    pub(super) fn next_refinement(&self, sampling: Sampling) -> Option<Sampling> {
        self.quality.next_refinement(sampling)
    }

    /// Returns whether the refinements of the last picture are expected to take at most `time` in
    /// total.
    pub(super) fn finishes_refining_within(&self, time: Duration) -> bool {
        self.quality.finishes_refining_within(time)
    }

    /// Records a finished frame.
    pub(super) fn record_frame(&mut self, frame: &Frame) {
        // A refinement reuses the samples of the frame before, so its time says little about that of a new picture.
        if !frame.refines {
            self.quality.adapt_level(frame.sampling, frame.interval, self.link.min_frame_interval());
        }
    }

    /// Returns whether the link was slow when a frame was last sent.
    pub(super) fn is_link_slow(&self) -> bool {
        self.link.is_slow()
    }

    /// Returns the least time between two frames.
    pub(super) fn min_frame_interval(&self) -> Duration {
        self.link.min_frame_interval()
    }

    /// Returns the time from which more bytes may be sent, if no reply arrives before.
    pub(super) fn next_send_at(&self, now: Duration) -> Duration {
        self.link.next_send_at(now)
    }

    /// Returns the limits on the bytes of a frame sent now, or `None` if there are none.
    ///
    /// `usual_bytes` is the usual number of bytes of a frame that changes the whole screen.
    pub(super) fn limit(&mut self, usual_bytes: usize, now: Duration) -> Option<Limit> {
        self.link.limit(usual_bytes, now)
    }

    /// Returns the bytes of a query without a frame if such a query is due; otherwise no bytes.
    pub(super) fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.link.probe(now)
    }

    /// Records that a frame is sent now, and appends the query that it is to end with, if any.
    pub(super) fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.link.send(frame, now);
    }

    /// Records a reply to DA1, the query that every terminal answers.
    pub(super) fn take_reply(&mut self, now: Duration) {
        self.link.receive_attributes(now);
    }

    /// Records a reply to DECRQM, the query of a mode, and returns whether it answers a frame's
    /// query.
    pub(super) fn match_mode_reply(&mut self, mode: u16, now: Duration) -> bool {
        self.link.match_mode_reply(mode, now)
    }

    /// Forgets the outstanding queries, because another program has had the terminal.
    pub(super) fn forget_replies(&mut self) {
        self.link.forget_queries();
    }
}
