//! The decision when to draw, trace, refine and wait, made in one function from one snapshot of
//! facts.
//!
//! The newest picture wins. A frame of a new view is begun when the last one can be sent; a refinement is cancelled
//! when its view changes; the shown picture is improved only while it stays. When nothing changes, there is no timer.

use std::time::Duration;

/// The frame in progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tracing {
    /// A frame of a new view.
    NewView,
    /// A refinement of the last frame.
    Refinement,
}

/// The state of the driver's two outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DriverState {
    /// Whether bytes wait for the terminal to accept them.
    pub(crate) sending: bool,
    /// The frame being traced, if any.
    pub(crate) tracing: Option<Tracing>,
}

/// The relation of the last picture begun to the wanted one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    /// The wanted picture shows something else.
    Stale,
    /// Both show the same, and the picture can be refined.
    Refinable,
    /// The picture is the wanted one and final, or there is nothing to show.
    Finished,
}

/// The facts that the decision depends on. Times are those of the viewer's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facts {
    pub(super) busy: DriverState,
    pub(super) picture: Picture,
    /// Whether nothing has been shown yet and the first picture is expected to be final soon.
    pub(super) holds_first_back: bool,
    /// Time at which the last frame of a new view was begun.
    pub(super) begun: Option<Duration>,
    /// Time up to which the eye has moved; `None` at rest.
    pub(super) moved_until: Option<Duration>,
    /// Least time between two frames.
    pub(super) frame_time: Duration,
    /// Time at which the link takes the next bytes.
    pub(super) link_free_at: Duration,
    /// Whether the screen differs from the wanted grid.
    pub(super) is_changed: bool,
    /// Time at which the shown colours can be made exact, if they are not.
    pub(super) improvable_at: Option<Duration>,
}

/// The next action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Cancel the refinement of a view that has changed.
    GiveUp,
    /// Bring the screen up to date.
    Draw,
    /// Begin a frame of the new view.
    Trace,
    /// Begin the next refinement of the last frame.
    Refine,
    /// Wait for an event, until this time if given.
    Wait(Option<Duration>),
}

/// Decides what to do at `now`, up to which a moving eye has been moved.
///
/// Never returns a time that has passed: the driver would spin.
pub(super) fn decide(facts: &Facts, now: Duration) -> Action {
    let Facts { busy, picture, .. } = *facts;
    // First of all, because the tracing thread stays busy with the old view until the job is cancelled. A frame of a
    // new view is never cancelled: while the view keeps changing, no frame would ever be finished.
    if picture == Picture::Stale && busy.tracing == Some(Tracing::Refinement) {
        return Action::GiveUp;
    }
    let (draw_at, frame_at) = (facts.draw_at(), facts.frame_at());
    // A finished frame goes before the next one, so that its bytes travel while that is traced.
    if !busy.sending && draw_at.is_some_and(|at| at <= now) {
        return Action::Draw;
    }
    // Nothing is traced that cannot be sent: by the time it could, a newer view would be wanted.
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
    /// Returns whether to hold back the first picture because it is nearly final.
    ///
    /// To draw a first version and then the final one would take longer than to draw the final one at once.
    fn perfects_first(&self) -> bool {
        self.holds_first_back && self.picture == Picture::Refinable && self.moved_until.is_none()
    }

    /// Returns the earliest time to draw if no event occurs before.
    ///
    /// An improvement of the shown picture waits while a frame of a newer view is in progress.
    fn draw_at(&self) -> Option<Duration> {
        if self.perfects_first() {
            return None;
        }
        // On a link of 50 KB/s and 200 ms, improvements that did not wait for newer frames took every other frame's
        // place: a key was visible after 330 ms instead of 291 ms in the median.
        let lasts = self.picture != Picture::Stale && self.busy.tracing != Some(Tracing::NewView);
        let at = if self.is_changed { Some(Duration::ZERO) } else { self.improvable_at.filter(|_| lasts) };
        at.map(|at| at.max(self.link_free_at))
    }

    /// Returns the earliest time for the next frame, or for the next step of the motion.
    fn frame_at(&self) -> Duration {
        if self.perfects_first() {
            return Duration::ZERO;
        }
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.frame_time);
        // A view that changed by a key or the mouse is due a frame time after the last one was begun. One that moves by
        // itself also waits until it has moved for a frame time, or the loop would spin.
        let at = if self.picture == Picture::Stale {
            next(self.begun)
        } else {
            next(self.moved_until).max(next(self.begun))
        };
        at.max(self.link_free_at)
    }

    /// Returns the time until which there is nothing to do.
    ///
    /// `None` when nothing moves and the picture is final, or while the terminal accepts bytes, whose end the driver
    /// notices.
    fn wake_at(&self, draw_at: Option<Duration>, frame_at: Duration) -> Option<Duration> {
        let DriverState { sending, tracing } = self.busy;
        let moves = self.picture == Picture::Stale || self.moved_until.is_some();
        let can_refine = self.picture == Picture::Refinable;
        // A new view in progress ends by itself and wakes the driver; nothing needs a timer until then.
        let lacks_frame = moves && tracing != Some(Tracing::NewView) || tracing.is_none() && can_refine;
        [lacks_frame.then_some(frame_at), draw_at].into_iter().flatten().filter(|_| !sending).min()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
