//! Animated jumps of the camera to another view, and the history of the views that jumps have left.

use crate::camera::Camera;
use std::time::Duration;

/// Duration of a jump: long enough to see where the new view lies, short enough not to delay work.
pub(super) const JUMP_TIME: Duration = Duration::from_millis(200);

/// Limit on the recorded views in each direction.
const MAX_VIEWS: usize = 64;

/// A jump in progress.
#[derive(Clone, Copy)]
pub(super) struct Jump {
    from: Camera,
    to: Camera,
    start: Duration,
}

impl Jump {
    pub(super) fn new(from: Camera, to: Camera, start: Duration) -> Self {
        Self { from, to, start }
    }

    /// Returns the camera that the jump leads to.
    pub(super) fn to(&self) -> Camera {
        self.to
    }

    /// Returns the time from which on the camera is exactly [`to`](Self::to).
    pub(super) fn end(&self) -> Duration {
        self.start + JUMP_TIME
    }

    /// Returns whether the jump has ended at a time.
    pub(super) fn has_ended(&self, now: Duration) -> bool {
        now >= self.end()
    }

    /// Returns the camera at time `now`. Its speed rises from 0 at the start and falls to 0 at the
    /// end.
    pub(super) fn camera(&self, now: Duration) -> Camera {
        if self.has_ended(now) {
            return self.to;
        }
        let x = now.saturating_sub(self.start).as_secs_f32() / JUMP_TIME.as_secs_f32();
        self.from.interpolated(&self.to, x * x * (3.0 - 2.0 * x))
    }
}

/// The views that jumps have left, to which the user can return.
#[derive(Clone, Default)]
pub(super) struct JumpHistory {
    /// Views before the current one, oldest first.
    before: Vec<Camera>,
    /// Views that were left by returning to earlier ones, oldest first.
    after: Vec<Camera>,
}

impl JumpHistory {
    /// Records a view that a jump leaves.
    pub(super) fn record_left(&mut self, camera: Camera) {
        self.after.clear();
        push_limited(&mut self.before, camera);
    }

    /// Returns the view before `camera` in the history, or with `forward` the view after it, and
    /// records `camera` in the other direction.
    pub(super) fn retrace(&mut self, camera: Camera, forward: bool) -> Option<Camera> {
        let (from, to) =
            if forward { (&mut self.after, &mut self.before) } else { (&mut self.before, &mut self.after) };
        let view = from.pop()?;
        push_limited(to, camera);
        Some(view)
    }
}

fn push_limited(views: &mut Vec<Camera>, camera: Camera) {
    if views.len() == MAX_VIEWS {
        views.remove(0);
    }
    views.push(camera);
}
