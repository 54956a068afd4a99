//! The camera of the shown scene, and its motion by keys and by the turntable.

use super::jump::{Jump, JumpHistory};
use crate::camera::{Camera, Pose};
use crate::control::{self, AGAIN_TIME, Command, KeyMode, KeySpeed, Motion};
use crate::hit::{any_hit, closest_hit};
use crate::ray::{Interval, Ray};
use crate::scene::Scene;
use crossterm::event::{KeyEvent, KeyEventKind};
use glam::Vec3;
use std::time::Duration;

/// Time for which a movement key counts as held in the first frame after its press: a frame at 60
/// per second.
// Without this time the first frame would show the old picture, and a press would be visible one frame later.
pub(crate) const FIRST_FRAME_MOTION: Duration = Duration::from_micros(16_667);

/// The camera on the shown scene, and its current motion.
#[derive(Default)]
pub(super) struct Eye {
    /// The view of the shown scene; `None` before the first.
    view: Option<ViewState>,
    motion: Motion,
    /// The jump in progress.
    jump: Option<Jump>,
    /// Whether the turntable is on.
    turntable: bool,
    /// The time up to which the motion has been carried out; `None` at rest.
    advanced_to: Option<Duration>,
    /// Whether motion is reduced: each press is one step at once, and nothing moves by itself.
    reduced_motion: bool,
    /// The shown scene, whose surfaces stop the eye.
    scene: Option<Scene>,
    /// Whether the eye passes through surfaces.
    passes_surfaces: bool,
    /// The time at which a surface stopped the held keys; `None` once they are released.
    stopped_at: Option<Duration>,
}

/// The user's view of one scene: its camera, saved views and way of moving.
#[derive(Clone)]
pub(super) struct ViewState {
    /// The scene's own camera.
    home: Camera,
    /// The current camera.
    camera: Camera,
    /// The speed of flight in world units per second, derived from `home`.
    speed: f32,
    /// Whether the eye orbits its target instead of flying.
    orbits: bool,
    /// The views that the scene file stores.
    written: Vec<Camera>,
    /// The views that the user has saved, by number.
    saved: [Option<Camera>; 9],
    history: JumpHistory,
}

impl ViewState {
    /// Returns the initial view of a scene.
    pub(super) fn initial(scene: &Scene, orbits: bool) -> Self {
        let home = *scene.camera();
        Self {
            home,
            camera: home,
            speed: control::speed(&home),
            orbits,
            written: scene.views().to_vec(),
            saved: [None; 9],
            history: JumpHistory::default(),
        }
    }

    /// Returns the scene's own camera.
    pub(super) fn home(&self) -> Camera {
        self.home
    }
}

/// Time for which a key counts as held at each press with reduced motion, which moves in steps.
// A step of this time is a tenth of the distance to the target, or nine degrees: large enough to see a change between
// two still pictures.
const REDUCED_MOTION_STEP: Duration = Duration::from_millis(200);

impl Eye {
    /// Returns an eye without a scene.
    ///
    /// With `reduced_motion` each press is one step at once, for people prone to motion sickness.
    pub(super) fn new(key_speed: KeySpeed, reduced_motion: bool) -> Self {
        Self { motion: Motion::with_speed(key_speed), reduced_motion, ..Self::default() }
    }

    /// Replaces the view by that of another scene, and returns the view of the previous scene.
    pub(super) fn open(&mut self, view: ViewState) -> Option<ViewState> {
        // A turntable that went on in the new scene would turn it before the user has seen its first view.
        self.turntable = false;
        self.end_jump();
        self.view.replace(view)
    }

    /// Sets the scene whose surfaces stop the eye, and the views that its file stores.
    ///
    /// The scene is not stored in the view, because the views of all scenes that were left are kept.
    pub(super) fn set_scene(&mut self, scene: &Scene) {
        self.scene = Some(scene.clone());
        if let Some(view) = &mut self.view {
            view.written = scene.views().to_vec();
        }
    }

    /// Sets whether the eye passes through surfaces, as the second eye of an outside view does.
    pub(super) fn set_passes_surfaces(&mut self, passes_surfaces: bool) {
        self.passes_surfaces = passes_surfaces;
    }

    /// Returns the camera; `None` without a scene.
    pub(super) fn camera(&self) -> Option<Camera> {
        self.view.as_ref().map(|view| view.camera)
    }

    /// Returns the camera if it is not the scene's own one.
    pub(super) fn moved_camera(&self) -> Option<Camera> {
        self.view.as_ref().filter(|view| view.camera != view.home).map(|view| view.camera)
    }

    /// Returns whether a camera is the scene's own; true without a scene.
    pub(super) fn is_home(&self, camera: Camera) -> bool {
        self.view.as_ref().is_none_or(|view| view.home == camera)
    }

    /// Returns the time up to which the motion has been carried out; `None` at rest.
    pub(super) fn advanced_to(&self) -> Option<Duration> {
        self.advanced_to
    }

    /// Returns whether anything moves the eye: keys, the turntable or a jump.
    pub(super) fn is_moving(&self) -> bool {
        self.advanced_to.is_some()
    }

    /// Carries out the motion up to `now`.
    pub(super) fn advance(&mut self, now: Duration) {
        let Some(since) = self.advanced_to else { return };
        let jump = self.jump.take();
        self.jump = jump.filter(|jump| !jump.has_ended(now));
        // Whether the eye moves is determined before `Motion::step`, because a motion that ends within this step has
        // moved the eye as well.
        let moves = self.turntable || self.motion.is_moving(now) || self.jump.is_some();
        self.advanced_to = moves.then_some(now);
        let Some(view) = &mut self.view else { return };
        if let Some(jump) = jump {
            view.camera = jump.camera(now);
        }
        // After the end of a jump, a held key moves the eye from there.
        let since = jump.map_or(since, |jump| since.max(jump.end()).min(now));
        let moved = self.motion.step(&view.camera, view.speed, since, now);
        let scene = self.scene.as_ref().filter(|_| !self.passes_surfaces);
        let stopped = scene.and_then(|scene| stopped_at_surface(scene, view, &moved));
        if stopped.is_some() {
            self.stopped_at.get_or_insert(now);
        } else if !self.motion.is_moving(now) {
            self.stopped_at = None;
        }
        let passes = self.stopped_at.is_some_and(|stopped| now >= stopped + PASSING_TIME);
        view.camera = stopped.filter(|_| !passes).unwrap_or(moved);
        if self.turntable {
            view.camera = control::on_turntable(&view.camera, now.saturating_sub(since).as_secs_f32());
        }
    }

    /// Replaces the camera by the result of `change` and stops the turntable.
    ///
    /// `change` gets the camera and the speed of flight that suits the scene's size.
    pub(super) fn change(&mut self, now: Duration, change: impl FnOnce(&Camera, f32) -> Camera) {
        self.advance(now);
        self.end_jump();
        self.turntable = false;
        if let Some(view) = &mut self.view {
            view.camera = change(&view.camera, view.speed);
        }
    }

    /// Starts the flight to the camera that `to` returns; with reduced motion, goes there at once.
    ///
    /// Records the camera that is left.
    pub(super) fn jump(&mut self, now: Duration, to: impl FnOnce(&Camera) -> Camera) {
        self.jump_with(now, |view| {
            let to = to(&view.camera);
            if to != view.camera {
                view.history.record_left(view.camera);
            }
            Some(to)
        });
    }

    /// Starts the flight back to the view before the last jump, or with `forward` to the view that
    /// the last jump back has left. Returns whether there is such a view.
    pub(super) fn retrace(&mut self, forward: bool, now: Duration) -> bool {
        self.jump_with(now, |view| view.history.retrace(view.camera, forward))
    }

    /// Starts the flight to the camera that `to` returns; with reduced motion, goes there at once.
    ///
    /// Returns whether `to` returned one.
    fn jump_with(&mut self, now: Duration, to: impl FnOnce(&mut ViewState) -> Option<Camera>) -> bool {
        self.change(now, |camera, _| *camera);
        let Some(view) = &mut self.view else { return false };
        let Some(to) = to(view) else { return false };
        if self.reduced_motion {
            view.camera = to;
        } else if to != view.camera {
            // The jump counts as begun one frame earlier, so that its first frame already differs from the view that it
            // leaves.
            let start = now.saturating_sub(FIRST_FRAME_MOTION);
            self.jump = Some(Jump::new(view.camera, to, start));
            self.advanced_to = Some(start);
        }
        true
    }

    /// Ends the jump in progress at the view that it leads to.
    fn end_jump(&mut self) {
        if let (Some(jump), Some(view)) = (self.jump.take(), &mut self.view) {
            view.camera = jump.to();
        }
    }

    /// Returns whether the turntable is on.
    pub(super) fn is_on_turntable(&self) -> bool {
        self.turntable
    }

    /// Starts or stops the turntable.
    pub(super) fn toggle_turntable(&mut self, now: Duration) {
        self.advance(now);
        self.turntable = !self.turntable;
        self.start_motion(now);
    }

    /// Starts the motion, if anything moves, as if it had begun [`FIRST_FRAME_MOTION`] before
    /// `now`.
    fn start_motion(&mut self, now: Duration) {
        let moves = self.turntable || self.motion.is_moving(now) || self.jump.is_some();
        self.advanced_to = moves.then(|| self.advanced_to.unwrap_or(now.saturating_sub(FIRST_FRAME_MOTION)));
    }

    /// Moves the camera to view `number`, from 1: the one saved by the user, or the one in the
    /// scene file.
    ///
    /// Returns `None` if there is no such view.
    pub(super) fn go_to(&mut self, number: u8, now: Duration) -> Option<()> {
        let view = self.view.as_ref()?;
        let at = usize::from(number).checked_sub(1)?;
        // A view saved by the user takes precedence over the view of the scene file with the same number.
        let saved = view.saved.get(at).copied().flatten().or_else(|| view.written.get(at).copied())?;
        self.jump(now, |_| saved);
        Some(())
    }

    /// Saves the current view as `number`.
    pub(super) fn save(&mut self, number: u8) {
        if let Some(view) = &mut self.view
            && let Some(saved) = usize::from(number).checked_sub(1).and_then(|at| view.saved.get_mut(at))
        {
            *saved = Some(view.camera);
        }
    }

    /// Returns whether the eye flies or orbits.
    pub(super) fn mode(&self) -> KeyMode {
        if self.view.as_ref().is_some_and(|view| view.orbits) { KeyMode::Orbit } else { KeyMode::Fly }
    }

    /// Switches between flight and orbit; `in_the_middle` is the point seen in the middle of the
    /// picture.
    ///
    /// The eye orbits that point, so that the switch leaves the picture as it is.
    pub(super) fn change_mode(&mut self, in_the_middle: Option<Vec3>) {
        let Some(view) = &mut self.view else { return };
        view.orbits = !view.orbits;
        if let (true, Some(target)) = (view.orbits, in_the_middle) {
            // Only the target changes, along the view direction, which does not change the picture. A target equal to
            // the eye is refused, and the camera then stays.
            view.camera = view.camera.with_pose(Pose { target, ..view.camera.pose() }).unwrap_or(view.camera);
        }
    }

    /// Carries out the motion so far, then passes the key to it.
    ///
    /// A press ends a jump in progress at once, at the jump's final view.
    ///
    /// The motion of a tap never passes a surface of the scene, so that it neither sinks through a floor nor enters an
    /// object. A key that is held stops at a surface for [`PASSING_TIME`].
    pub(super) fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        if self.reduced_motion {
            self.take_step(key, meant);
            return;
        }
        self.advance(now);
        if !self.motion.is_moving(now) {
            self.stopped_at = None;
        }
        if key.kind == KeyEventKind::Press {
            self.end_jump();
        }
        // Any movement key stops the turntable, which would otherwise turn the eye at the same time.
        self.turntable &= key.kind == KeyEventKind::Release || !meant.is_some_and(|(command, _)| command.is_motion());
        self.motion.take_key(key, meant, now);
        if let (Some(scene), Some(view), false) = (&self.scene, &self.view, self.passes_surfaces) {
            self.motion.halve_taps_until(now, |motion| remaining_motion_is_clear(motion, view, scene, now));
        }
        self.start_motion(now);
    }

    /// Moves the camera by one step if the key was pressed or repeats; used with reduced motion.
    fn take_step(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>) {
        let Some(view) = self.view.as_mut().filter(|_| key.kind != KeyEventKind::Release) else { return };
        // With reduced motion a press or a repeat moves as far as a key that is held for `REDUCED_MOTION_STEP`.
        let mut motion = self.motion.clone();
        motion.set_reports_releases(true);
        motion.take_key(&KeyEvent { kind: KeyEventKind::Press, ..*key }, meant, Duration::ZERO);
        let moved = motion.step(&view.camera, view.speed, Duration::ZERO, REDUCED_MOTION_STEP);
        let scene = self.scene.as_ref().filter(|_| !self.passes_surfaces);
        let stopped = scene.and_then(|scene| stopped_at_surface(scene, view, &moved));
        // A surface stops a step. If the eye is already close to the surface, as after such a stop, the step passes it.
        let way = |camera: &Camera| camera.pose().eye.distance(view.camera.pose().eye);
        view.camera = stopped.filter(|stopped| way(stopped) > LEAST_STEP * way(&moved)).unwrap_or(moved);
    }

    /// Ends the motion by keys, as if all keys were released.
    pub(super) fn release_keys(&mut self, now: Duration) {
        self.advance(now);
        self.motion.stop();
        self.advanced_to = self.advanced_to.filter(|_| self.turntable || self.jump.is_some());
    }

    /// Stops all motion: by keys, by the turntable, and by a jump, which ends at its final view.
    pub(super) fn stop(&mut self, now: Duration) {
        self.release_keys(now);
        self.end_jump();
        self.turntable = false;
        self.advanced_to = None;
    }

    /// Sets whether the terminal reports key releases. Held keys are released if it no longer does.
    pub(super) fn set_reports_releases(&mut self, reports_releases: bool, now: Duration) {
        // The release of a held key would never be reported, and the key would move the eye for ever.
        if self.reports_releases() && !reports_releases {
            self.release_keys(now);
        }
        self.motion.set_reports_releases(reports_releases);
    }

    fn reports_releases(&self) -> bool {
        self.motion.reports_releases()
    }

    /// Returns to the scene's own camera.
    pub(super) fn reset(&mut self, now: Duration) {
        let home = self.view.as_ref().map(|view| view.home);
        self.jump(now, |camera| home.unwrap_or(*camera));
    }
}

/// Returns whether the rest of the motion by taps neither passes a surface nor ends close to one.
fn remaining_motion_is_clear(motion: &Motion, view: &ViewState, scene: &Scene, now: Duration) -> bool {
    let end = motion.step(&view.camera, view.speed, now.saturating_sub(FIRST_FRAME_MOTION), now + AGAIN_TIME);
    let (origin, end) = (view.camera.pose().eye, end.pose().eye);
    let within = Interval { min: 0.0, max: SURFACE_MARGIN };
    origin == end || !any_hit(scene, &Ray { origin, direction: end - origin }, within)
}

/// Returns the camera stopped in front of the first surface on the way to `moved`.
///
/// Returns `None` if the way is free.
fn stopped_at_surface(scene: &Scene, view: &ViewState, moved: &Camera) -> Option<Camera> {
    let (origin, pose) = (view.camera.pose().eye, moved.pose());
    let way = pose.eye - origin;
    let t = (way != Vec3::ZERO).then(|| closest_hit(scene, &Ray { origin, direction: way }))??.t;
    // Moves the eye back to the margin in front of the surface, but not beyond the start of the way.
    let back = ((t + 1.0 - SURFACE_MARGIN).max(0.0) - 1.0) * way;
    let pose = Pose { eye: pose.eye + back, target: pose.target + back, ..pose };
    // An eye that orbits stays where it is: its target must not move.
    let stopped = if view.orbits { view.camera } else { moved.with_pose(pose).unwrap_or(view.camera) };
    (t < SURFACE_MARGIN).then_some(stopped)
}

/// Time for which a surface stops a held key, which passes it after that.
// Half a second is longer than a press that is meant as a tap, even with Shift, and short enough that the surface does
// not seem impassable.
const PASSING_TIME: Duration = Duration::from_millis(500);

/// Share of a step of reduced motion: if a surface leaves less of the step free, the step passes
/// it.
const LEAST_STEP: f32 = 0.05;

/// Length that has to be free of surfaces in front of the eye, as a multiple of the motion's
/// length.
// The path of an orbit is longer than the straight line that is tested for surfaces.
const SURFACE_MARGIN: f32 = 1.1;

#[cfg(all(test, unit_tests))]
mod tests;
