//! What was begun and sent, and so how finely the next picture is traced and what the next bytes may be.

use super::effort::Effort;
use super::frame::{Frame, Shot};
use super::options::Options;
use crate::pace::{Limit, Link};
use crate::render::Sampling;
use std::time::Duration;

/// The link, and how the time of a frame is spent.
pub(super) struct Pacing {
    link: Link,
    effort: Effort,
    /// The last frame of a new view that was begun.
    begun: Option<Begun>,
}

struct Begun {
    shot: Shot,
    at: Duration,
    /// Whether more was moving then.
    in_motion: bool,
}

impl Pacing {
    pub(super) fn new(options: &Options, may_ask: bool) -> Self {
        let link = Link::new(options.max_rate, options.max_frames, may_ask);
        Self { link, effort: Effort::new(options.sampling), begun: None }
    }

    /// Whether this is what the last frame shows that was begun.
    pub(super) fn has_begun(&self, shot: &Shot) -> bool {
        self.begun.as_ref().is_some_and(|begun| begun.shot == *shot)
    }

    /// When the last frame of a new view was begun.
    pub(super) fn begun_at(&self) -> Option<Duration> {
        self.begun.as_ref().map(|begun| begun.at)
    }

    /// A frame of a new view is begun; returns how finely it is to be traced.
    pub(super) fn begin(&mut self, shot: Shot, in_motion: bool, now: Duration) -> Sampling {
        let before = self.begun.replace(Begun { shot, at: now, in_motion });
        if before.as_ref().is_some_and(|before| !shot.takes_as_long_as(&before.shot)) {
            self.effort.forget_last();
        }
        // On a slow link the next frame begins when a reply comes: all the time that it takes is the link's.
        self.effort.of_new_view(before.is_some_and(|before| before.in_motion) && !self.link.is_slow())
    }

    /// How finely a picture is traced next that is traced so finely; `None` at the end.
    pub(super) fn next_step(&self, sampling: Sampling) -> Option<Sampling> {
        self.effort.of_next_step(sampling)
    }

    /// Whether the next steps of the last picture are expected to take no longer than that, all together.
    pub(super) fn ends_within(&self, time: Duration) -> bool {
        self.effort.ends_within(time)
    }

    /// A frame is done.
    pub(super) fn took(&mut self, frame: &Frame) {
        if !frame.refines {
            self.effort.took(frame.sampling, frame.trace, self.link.frame_time());
        }
    }

    /// How far apart frames are at least.
    pub(super) fn frame_time(&self) -> Duration {
        self.link.frame_time()
    }

    /// When the link takes the next bytes, if nothing is heard until then.
    pub(super) fn free_at(&self, now: Duration) -> Duration {
        self.link.free_at(now)
    }

    /// What a frame that is sent now may take, if it may not take as much as it likes.
    pub(super) fn limit(&mut self, usual_bytes: usize, now: Duration) -> Option<Limit> {
        self.link.limit(usual_bytes, now)
    }

    /// A query without a frame, if it is time for one, or nothing.
    pub(super) fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.link.probe(now)
    }

    /// Puts a query behind a frame that is sent now.
    pub(super) fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.link.send(frame, now);
    }

    /// A reply has come to a query that every terminal answers.
    pub(super) fn take_reply(&mut self, now: Duration) {
        self.link.answer(now);
    }

    /// A private mode is reported; whether by the reply to a query of a frame.
    pub(super) fn take_mode(&mut self, mode: u16, now: Duration) -> bool {
        self.link.answer_mode(mode, now)
    }

    /// What was asked will not be answered: another program had the terminal in between.
    pub(super) fn forget_replies(&mut self) {
        self.link.forget();
    }
}
