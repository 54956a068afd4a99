//! The decision whether to draw, trace, refine or wait, made by one function from one snapshot of
//! facts.
//!
//! The newest picture wins. A frame of a new view is begun only when the frame before can be sent; a refinement is
//! cancelled when its view changes; the shown picture is improved only while no newer view is traced. When nothing
//! changes, there is no timer.

use std::time::Duration;

/// Whether the frame that is being traced shows a new view or refines the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tracing {
    /// A frame of a new view.
    NewView,
    /// A refinement of the last frame.
    Refinement,
}

/// Whether the driver is busy sending bytes or tracing a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DriverState {
    /// Whether bytes wait for the terminal to accept them.
    pub(crate) sending: bool,
    /// The kind of frame that is being traced, if any.
    pub(crate) tracing: Option<Tracing>,
}

/// Whether the last frame begun shows the wanted shot, and whether it can be refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PictureState {
    /// The wanted shot differs from the shot of the last frame begun.
    Stale,
    /// The last frame has the wanted shot and can be refined.
    Refinable,
    /// The last frame has the wanted shot and is final, or there is nothing to show.
    Finished,
}

/// The facts by which [`decide`] chooses an action. Times are those of the viewer's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facts {
    pub(super) busy: DriverState,
    pub(super) picture: PictureState,
    /// Whether nothing has been shown yet and the first picture will probably be refined completely
    /// soon.
    pub(super) holds_first_back: bool,
    /// Time at which the last frame of a new view was begun.
    pub(super) begun: Option<Duration>,
    /// Time up to which the eye has moved; `None` at rest.
    pub(super) advanced_to: Option<Duration>,
    /// Least time between two frames.
    pub(super) min_frame_interval: Duration,
    /// Time from which more bytes may be sent on the link.
    pub(super) next_send_at: Duration,
    /// Whether the content of the screen has changed since it was drawn last.
    pub(super) is_changed: bool,
    /// Time from which a frame may replace approximate colours on the screen by exact ones; `None`
    /// if all are exact.
    pub(super) improvable_at: Option<Duration>,
}

/// The action to take next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Cancel the refinement of a view that has changed.
    CancelRefinement,
    /// Draw the content of the screen.
    Draw,
    /// Begin a frame of the new view.
    Trace,
    /// Begin the next refinement of the last frame.
    Refine,
    /// Wait for an event, until this time if given.
    Wait(Option<Duration>),
}

/// Returns the action to take at `now`, up to which the motion of the eye has been carried out.
///
/// Never waits until a time that has passed, because the driver would spin.
pub(super) fn decide(facts: &Facts, now: Duration) -> Action {
    let Facts { busy, picture, .. } = *facts;
    // Cancelling comes first, because the tracing thread stays busy with the old view until its job is cancelled. A
    // frame of a new view is never cancelled: while the view keeps changing, no frame would ever be finished.
    if picture == PictureState::Stale && busy.tracing == Some(Tracing::Refinement) {
        return Action::CancelRefinement;
    }
    let (draw_at, frame_at) = (facts.draw_at(), facts.frame_at());
    // A finished frame is drawn before the next one is begun, so that its bytes are sent while the next one is traced.
    if !busy.sending && draw_at.is_some_and(|at| at <= now) {
        return Action::Draw;
    }
    // No frame is begun while the last one is being sent: by the time it could be sent, a newer view would be wanted.
    if !busy.sending && busy.tracing.is_none() && frame_at <= now {
        match picture {
            PictureState::Stale => return Action::Trace,
            PictureState::Refinable => return Action::Refine,
            PictureState::Finished => {}
        }
    }
    Action::Wait(facts.wake_at(draw_at, frame_at))
}

impl Facts {
    /// Returns whether to hold back the first picture until it is refined.
    ///
    /// Drawing the picture twice would take longer than drawing the final one at once.
    fn holds_back_first_picture(&self) -> bool {
        self.holds_first_back && self.picture == PictureState::Refinable && self.advanced_to.is_none()
    }

    /// Returns the earliest time to draw if no event occurs before.
    ///
    /// An improvement of the shown picture waits while a frame of a newer view is in progress.
    fn draw_at(&self) -> Option<Duration> {
        if self.holds_back_first_picture() {
            return None;
        }
        // The shown picture lasts if no newer view is wanted or being traced. On a link of 50 KB/s and 200 ms,
        // improvements that did not wait for that took the place of every other frame: the effect of a key was visible
        // after 330 ms instead of 291 ms in the median.
        let lasts = self.picture != PictureState::Stale && self.busy.tracing != Some(Tracing::NewView);
        let at = if self.is_changed { Some(Duration::ZERO) } else { self.improvable_at.filter(|_| lasts) };
        at.map(|at| at.max(self.next_send_at))
    }

    /// Returns the earliest time for the next frame, or for the next step of the motion.
    fn frame_at(&self) -> Duration {
        if self.holds_back_first_picture() {
            return Duration::ZERO;
        }
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.min_frame_interval);
        // If the view has changed, its frame is due a frame time after the last one was begun. If the eye is moving and
        // its view has not changed yet, the next step also waits until a frame time after `advanced_to`; at once, the
        // driver would loop without a pause.
        let at = if self.picture == PictureState::Stale {
            next(self.begun)
        } else {
            next(self.advanced_to).max(next(self.begun))
        };
        at.max(self.next_send_at)
    }

    /// Returns the time until which there is nothing to do, for the driver's timer.
    ///
    /// `None` if nothing moves and the picture is final, or while bytes are being sent, because the driver notices when
    /// all are sent.
    fn wake_at(&self, draw_at: Option<Duration>, frame_at: Duration) -> Option<Duration> {
        let DriverState { sending, tracing } = self.busy;
        let moves = self.picture == PictureState::Stale || self.advanced_to.is_some();
        let can_refine = self.picture == PictureState::Refinable;
        // While a frame of a new view is traced no timer is needed, because its end wakes the driver.
        let lacks_frame = moves && tracing != Some(Tracing::NewView) || tracing.is_none() && can_refine;
        [lacks_frame.then_some(frame_at), draw_at].into_iter().flatten().filter(|_| !sending).min()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
