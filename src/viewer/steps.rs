//! The steps that a driver carries out: drawing, tracing, refining and waiting.

use super::orders::RenderOrdersPanel;
use super::schedule::{Action, Facts, PictureState, decide};
use super::screen::Screen;
use super::{DriverState, Frame, Job, Shot, Viewer};
use crate::render::Sampling;
use crate::scene::Scene;
use std::time::Duration;

/// Greatest time for which the first picture is held back, so that it is shown only once, already
/// refined.
///
/// A picture whose refinement takes longer is shown first and refined afterwards.
// Users notice a longer wait: with 16.7 ms, three spheres at 200x60 cells were shown after 15 ms, 9 of which went into
// refinement. Without any wait, small pictures would be sent twice: as traced first, and refined.
const FIRST_REFINEMENT: Duration = Duration::from_millis(4);

/// The driver's next action.
#[allow(clippy::large_enum_variant, reason = "a step is taken where it is returned, and never stored")]
pub(crate) enum ViewerStep {
    /// Send the bytes that [`Viewer::draw`] appends.
    Draw,
    /// Send these bytes, if any; then trace this frame and pass it to [`Viewer::take_frame`].
    Trace(Vec<u8>, Job),
    /// Cancel the refinement in progress.
    CancelRefinement,
    /// Wait for an event, at most until this time if given.
    Wait(Option<Duration>),
}

impl Viewer {
    /// Accepts a finished frame as the next picture to show.
    pub(crate) fn take_frame(&mut self, frame: Frame) {
        self.pacing.record_frame(&frame);
        self.use_glyphs_of(&frame);
        // Only frames in motion count for the frame rate: refinements at rest would raise it.
        let moving = self.is_picture_moving().then_some(self.now);
        self.screen.take_frame(frame, moving);
        self.update_lost_notice();
    }

    /// Returns the driver's next action.
    pub(crate) fn next_step(&mut self, busy: DriverState, now: Duration) -> ViewerStep {
        self.set_now(now);
        self.playback.advance(now);
        // Gives the eye the scene at its current time, because a moving surface stops the eye where the surface is now.
        if let Some(scene) = self.scene_at_current_time().filter(|_| self.playback.advanced_to().is_some()) {
            self.eye.set_scene(&scene);
        }
        // Moves the eye to its place at `now` first, because `decide` compares the picture with the eye's current view.
        self.eye.advance(now);
        self.screen.set_movement_mode(self.eye.mode());
        self.screen.set_picture_moving(self.is_picture_moving());
        self.mark_light();
        self.note_few_colors();
        self.begin_or_end_rest(busy);
        let fades_at = self.screen.close_faded_note(now);
        let builds_at = self.screen.advance_orders(now);
        match decide(&self.facts(busy), now) {
            Action::CancelRefinement => ViewerStep::CancelRefinement,
            Action::Draw => ViewerStep::Draw,
            Action::Trace => self.begin_new_view(),
            Action::Refine => self.begin_refinement(),
            // An incomplete escape sequence needs a wake-up of its own, because its other bytes may never arrive.
            Action::Wait(until) => ViewerStep::Wait(
                until
                    .into_iter()
                    .chain(self.receiver.sequence_times_out_at(now))
                    .chain(fades_at)
                    .chain(builds_at)
                    .min(),
            ),
        }
    }

    fn facts(&self, busy: DriverState) -> Facts {
        let size = self.display.picture_size();
        Facts {
            busy,
            picture: self.picture_state(),
            holds_first_back: !self.screen.has_shown() && self.pacing.finishes_refining_within(FIRST_REFINEMENT),
            begun: self.pacing.begun_at(),
            advanced_to: self.eye.advanced_to().or(self.playback.advanced_to()),
            min_frame_interval: self.pacing.min_frame_interval(),
            next_send_at: self.pacing.next_send_at(self.now),
            is_changed: self.screen.is_changed(size),
            improvable_at: self.screen.improvable_at(size),
        }
    }

    pub(super) fn picture_state(&self) -> PictureState {
        if self.current_shot().is_some_and(|wanted| !self.pacing.has_begun(&wanted)) {
            PictureState::Stale
        } else if self.next_refinement().is_some() {
            PictureState::Refinable
        } else {
            PictureState::Finished
        }
    }

    /// Begins a frame of a shot that no frame has been begun for; returns the step that traces it.
    ///
    /// The step sends a query first, which measures the link's round trip without a frame's bytes.
    fn begin_new_view(&mut self) -> ViewerStep {
        let Some((scene, shot)) = self.scene_at_current_time().zip(self.current_shot()) else {
            return ViewerStep::Wait(None);
        };
        if self.rest.is_on() {
            // The picture in half blocks stays on the screen until this one is traced, which is final at once, and is
            // cancelled if the view changes. It measures nothing, since a cancelled frame sends nothing.
            self.pacing.begin_resting_frame(shot, self.now);
            let sampling = self.layout.sampling(self.options.sampling.unwrap_or(Sampling::BEST));
            return ViewerStep::Trace(Vec::new(), Job { scene, shot, sampling, refines: true });
        }
        let probe = self.pacing.probe(self.now);
        self.receiver.sent(&probe, self.now);
        let sampling = self.pacing.begin_frame(shot, self.is_picture_moving(), self.now);
        ViewerStep::Trace(probe, Job { scene, shot, sampling: self.layout.sampling(sampling), refines: false })
    }

    /// Returns the step that traces the next refinement of the last frame.
    fn begin_refinement(&self) -> ViewerStep {
        let wanted = self.scene_at_current_time().zip(self.current_shot()).zip(self.next_refinement());
        let Some(((scene, shot), sampling)) = wanted else { return ViewerStep::Wait(None) };
        ViewerStep::Trace(Vec::new(), Job { scene, shot, sampling, refines: true })
    }

    /// Returns the shown scene at its current time, with its lights as moved by the user.
    pub(super) fn scene_at_current_time(&self) -> Option<Scene> {
        let seconds = self.playback.time().as_secs_f64();
        self.scenes.lights().map(|lights| lights.scene().clone().at_time(seconds))
    }

    /// Returns the shot that the picture is to show, or `None` without a scene.
    pub(super) fn current_shot(&self) -> Option<Shot> {
        let (lights, camera) = (self.scenes.lights()?, self.first_camera()?);
        let (outside, layout) = (self.second_camera(), self.shown_layout());
        let (scene, resolution) = (self.scenes.count(), self.display.resolution());
        let (lights, orders) = (lights.move_count(), self.screen.get::<RenderOrdersPanel>().is_some());
        let geometry = self.display.capabilities().cell_mode.needs_geometry();
        let time = self.playback.time();
        Some(Shot { scene, lights, time, camera, outside, resolution, layout, orders, geometry })
    }

    /// Returns the sampling of the shown frame's next refinement, or `None` if it cannot be
    /// refined.
    fn next_refinement(&self) -> Option<Sampling> {
        // Refining a sketch would take time from building the scene.
        let frame = self.screen.frame().filter(|_| !self.screen.is_loading_scene())?;
        let next = self.layout.sampling(self.pacing.next_refinement(frame.sampling)?);
        (next != frame.sampling).then_some(next)
    }

    /// Returns whether the view is being changed by keys, the turntable, a drag or the time, so
    /// that the next frame will differ.
    pub(super) fn is_picture_moving(&self) -> bool {
        self.eye.is_moving() || self.pointer.holds() || self.playback.advanced_to().is_some()
    }

    /// Appends the bytes that bring the screen up to date.
    ///
    /// Call [`add_frame_queries`](Self::add_frame_queries) with these bytes afterwards.
    pub(crate) fn draw(&mut self, now: Duration, bytes: &mut Vec<u8>) {
        self.set_now(now);
        let size = self.display.picture_size();
        let limit = self.pacing.limit(Screen::usual_bytes(size), now);
        self.screen.draw(size, &self.options.keymap, limit, now, bytes);
    }

    /// Adds the queries that measure the link before and after a frame's bytes.
    ///
    /// Adds none if `bytes` is empty.
    ///
    /// `now` is the time after [`draw`](Self::draw), so that making the cells and bytes is not counted as part of the
    /// round trip.
    pub(crate) fn add_frame_queries(&mut self, bytes: &mut Vec<u8>, now: Duration) {
        self.screen.record_encode_time(now.saturating_sub(self.now));
        if bytes.is_empty() {
            return;
        }
        // A query is sent before refinements at rest too. It measures the link's own round trip, from which the rate is
        // derived; a frame's round trip includes the transmission of its bytes. On a link of 50 KB/s and 200 ms, a
        // refinement without such a query had a round trip of 267 ms, which was taken for the link's own, and the rate
        // then seemed to be 562 KB/s.
        let probe = self.pacing.probe(now);
        self.receiver.sent(&probe, now);
        self.pacing.send(bytes, now);
        self.receiver.sent(bytes, now);
        // The query of the link's round trip goes before the frame, so that its reply does not wait for the frame's
        // transmission.
        bytes.splice(0..0, probe);
    }
}
