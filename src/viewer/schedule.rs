//! When to draw, to trace, to refine and to wait: one decision, made from one snapshot of facts.
//!
//! The newest picture wins. A frame of a new view is begun when the last one can be sent; what refines a picture is given
//! up when its view changes; what is on the screen is made better only while it lasts. When nothing changes, there is
//! nothing to wait for.

use std::time::Duration;

/// What is being traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tracing {
    /// A frame of a new view.
    NewView,
    /// The next step of the last frame.
    Refinement,
}

/// What a driver knows of its two outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Busy {
    /// Whether bytes that were sent have not been taken yet.
    pub(crate) sending: bool,
    /// What is being traced.
    pub(crate) tracing: Option<Tracing>,
}

/// How the picture that was last begun stands to the one that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    /// It is of something else.
    Stale,
    /// It is of the same, and can be refined.
    Refinable,
    /// It is the one that is wanted, or there is nothing to see.
    Finished,
}

/// What the decision depends on. Times are those of the viewer's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facts {
    pub(super) busy: Busy,
    pub(super) picture: Picture,
    /// Whether nothing has been shown yet, and the refinement of the first picture would soon be at its end.
    pub(super) holds_first_back: bool,
    /// When a frame of a new view was last begun.
    pub(super) begun: Option<Duration>,
    /// Up to when the eye has moved; `None` at rest.
    pub(super) moved_until: Option<Duration>,
    /// How far apart frames are at least.
    pub(super) frame_time: Duration,
    /// When the link takes the next bytes.
    pub(super) link_free_at: Duration,
    /// Whether the screen shows something else than it should.
    pub(super) is_changed: bool,
    /// When what it shows can be made better, if it can be.
    pub(super) improvable_at: Option<Duration>,
}

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Give up what refines a view that has changed.
    GiveUp,
    /// Bring the screen up to date.
    Draw,
    /// Begin a frame of the new view.
    Trace,
    /// Begin the next step of the last frame.
    Refine,
    /// Nothing, until then or until something happens.
    Wait(Option<Duration>),
}

/// Decides what is to be done at a time, up to which the eye has been moved if it moves.
///
/// Never returns a time that has passed: whoever waits for it would turn in circles.
pub(super) fn decide(facts: &Facts, now: Duration) -> Action {
    let Facts { busy, picture, .. } = *facts;
    if picture == Picture::Stale && busy.tracing == Some(Tracing::Refinement) {
        return Action::GiveUp;
    }
    let (draw_at, frame_at) = (facts.draw_at(), facts.frame_at());
    if !busy.sending && draw_at.is_some_and(|at| at <= now) {
        return Action::Draw;
    }
    // Nothing is traced that cannot be sent.
    if !busy.sending && busy.tracing.is_none() && frame_at <= now {
        match picture {
            Picture::Stale => return Action::Trace,
            Picture::Refinable => return Action::Refine,
            Picture::Finished => {}
        }
    }
    Action::Wait(facts.wake_at(draw_at, frame_at))
}

impl Facts {
    /// Whether the first picture is not shown yet because its end is near: to show it twice would take longer.
    fn perfects_first(&self) -> bool {
        self.holds_first_back && self.picture == Picture::Refinable && self.moved_until.is_none()
    }

    /// The earliest time to draw, if nothing else happens. What would make a picture better waits while one of a newer view
    /// is on its way.
    fn draw_at(&self) -> Option<Duration> {
        if self.perfects_first() {
            return None;
        }
        let lasts = self.picture != Picture::Stale && self.busy.tracing != Some(Tracing::NewView);
        let at = if self.is_changed { Some(Duration::ZERO) } else { self.improvable_at.filter(|_| lasts) };
        at.map(|at| at.max(self.link_free_at))
    }

    /// The earliest time for the next frame, and for the next look at what moves.
    fn frame_at(&self) -> Duration {
        if self.perfects_first() {
            return Duration::ZERO;
        }
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.frame_time);
        let at = if self.picture == Picture::Stale {
            next(self.begun)
        } else {
            next(self.moved_until).max(next(self.begun))
        };
        at.max(self.link_free_at)
    }

    /// How long there is nothing to do: for ever when nothing moves and the picture is done, or while bytes are taken, of
    /// whose end the driver knows.
    fn wake_at(&self, draw_at: Option<Duration>, frame_at: Duration) -> Option<Duration> {
        let Busy { sending, tracing } = self.busy;
        let moves = self.picture == Picture::Stale || self.moved_until.is_some();
        let can_refine = self.picture == Picture::Refinable;
        let lacks_frame = moves && tracing != Some(Tracing::NewView) || tracing.is_none() && can_refine;
        [lacks_frame.then_some(frame_at), draw_at].into_iter().flatten().filter(|_| !sending).min()
    }
}
