//! The time of a moving scene, which the user can pause.

use super::Viewer;
use std::time::Duration;

/// Limit on the time by which a scene advances from one frame to the next.
// Without the limit, the scene would jump ahead by the time for which the program was suspended.
const MAX_STEP: Duration = Duration::from_secs(1);

/// The playback of the shown scene: its time, and whether it moves.
#[derive(Debug, Default)]
pub(super) struct Playback {
    time: Duration,
    /// The time of the viewer's clock up to which the scene has moved; `None` while it is still.
    advanced_to: Option<Duration>,
    /// Whether the user has paused the scene.
    is_paused: bool,
}

impl Playback {
    /// Returns the scene's time.
    pub(super) fn time(&self) -> Duration {
        self.time
    }

    /// Returns the time of the viewer's clock up to which the scene has moved; `None` while it
    /// stands still.
    pub(super) fn advanced_to(&self) -> Option<Duration> {
        self.advanced_to
    }

    /// Advances the time of the scene to `now`, if the scene plays.
    pub(super) fn advance(&mut self, now: Duration) {
        if let Some(since) = self.advanced_to {
            self.time += now.saturating_sub(since).min(MAX_STEP);
            self.advanced_to = Some(now);
        }
    }

    /// Starts the scene's motion at `now`, if the scene can move and the user has not paused it.
    pub(super) fn resume_unless_paused(&mut self, can_move: bool, now: Duration) {
        self.advanced_to = (can_move && !self.is_paused).then_some(now);
    }

    fn toggle(&mut self, now: Duration) {
        self.advance(now);
        self.is_paused = !self.is_paused;
        self.resume_unless_paused(true, now);
    }
}

impl Viewer {
    /// Pauses the scene's motion, or lets it go on, unless the user has asked for reduced motion.
    pub(super) fn toggle_playback(&mut self) {
        if !self.scenes.lights().is_some_and(|lights| lights.scene().depends_on_time()) {
            return self.show_note("this scene does not move");
        }
        if self.options.reduced_motion {
            return self.show_note("nothing moves: --reduced-motion");
        }
        self.playback.toggle(self.now);
        let seconds = self.playback.time.as_secs_f64();
        let text = if self.playback.is_paused { format!("paused at {seconds:.2} s") } else { "playing".to_owned() };
        self.show_note(text);
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
