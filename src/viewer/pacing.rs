//! Bookkeeping of the frames begun and bytes sent, from which sampling and byte limits follow.

use super::frame::{Frame, Shot};
use super::options::Options;
use super::quality_control::QualityControl;
use crate::pace::{Limit, Link};
use crate::render::Sampling;
use std::time::Duration;

/// The link, and the use of a frame's time.
pub(super) struct Pacing {
    link: Link,
    quality: QualityControl,
    /// The last frame of a new view.
    begun: Option<Begun>,
}

struct Begun {
    shot: Shot,
    at: Duration,
    /// Whether the view was in motion at that time, so that the next frame was expected to be of
    /// another view.
    in_motion: bool,
}

impl Pacing {
    pub(super) fn new(options: &Options, may_ask: bool) -> Self {
        let link = Link::new(options.max_rate, options.max_frames, may_ask);
        Self { link, quality: QualityControl::new(options.sampling), begun: None }
    }

    /// Returns whether `shot` is that of the last frame begun.
    pub(super) fn has_begun(&self, shot: &Shot) -> bool {
        self.begun.as_ref().is_some_and(|begun| begun.shot == *shot)
    }

    /// Returns the time at which the last frame of a new view was begun.
    pub(super) fn begun_at(&self) -> Option<Duration> {
        self.begun.as_ref().map(|begun| begun.at)
    }

    /// Records that a frame of a new view is begun, and returns its sampling.
    pub(super) fn begin(&mut self, shot: Shot, in_motion: bool, now: Duration) -> Sampling {
        let before = self.begun.replace(Begun { shot, at: now, in_motion });
        // A ratio of times is learnt from two consecutive pictures, which must differ in their level alone.
        if before.as_ref().is_some_and(|before| !shot.takes_as_long_as(&before.shot)) {
            self.quality.forget_last();
        }
        // On a slow link the next frame begins when a reply arrives, so that tracing takes time from the link: of 50
        // KB/s, 81 to 84 % were used with as many samples as time allows, and 84.5 to 85.2 % with one.
        self.quality.for_new_view(before.is_some_and(|before| before.in_motion) && !self.link.is_slow())
    }

    /// Returns the sampling of the next refinement of a picture with this sampling.
    ///
    /// `None` at the end.
    pub(super) fn next_refinement(&self, sampling: Sampling) -> Option<Sampling> {
        self.quality.next_refinement(sampling)
    }

    /// Returns whether all further refinements of the last picture are expected to take at most
    /// this long together.
    pub(super) fn ends_within(&self, time: Duration) -> bool {
        self.quality.ends_within(time)
    }

    /// Records a finished frame.
    pub(super) fn record_frame(&mut self, frame: &Frame) {
        // A refinement continues from the samples that are there; its time says little about a new picture.
        if !frame.refines {
            self.quality.record_time(frame.sampling, frame.trace, self.link.frame_time());
        }
    }

    /// Returns the least time between two frames.
    pub(super) fn frame_time(&self) -> Duration {
        self.link.frame_time()
    }

    /// Returns the time at which the link takes the next bytes, if no reply arrives before.
    pub(super) fn free_at(&self, now: Duration) -> Duration {
        self.link.free_at(now)
    }

    /// Returns the limits for a frame sent now; `None` without limits.
    pub(super) fn limit(&mut self, usual_bytes: usize, now: Duration) -> Option<Limit> {
        self.link.limit(usual_bytes, now)
    }

    /// Returns a query without a frame if one is due; otherwise no bytes.
    pub(super) fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.link.probe(now)
    }

    /// Appends a query to a frame that is sent now.
    pub(super) fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.link.send(frame, now);
    }

    /// Records a reply to the query that every terminal answers.
    pub(super) fn take_reply(&mut self, now: Duration) {
        self.link.receive_attributes(now);
    }

    /// Records a report of a private mode, and returns whether it answers a frame's query.
    pub(super) fn take_mode(&mut self, mode: u16, now: Duration) -> bool {
        self.link.receive_mode(mode, now)
    }

    /// Forgets the outstanding queries, because another program has had the terminal.
    pub(super) fn forget_replies(&mut self) {
        self.link.forget_queries();
    }
}
