//! The camera of the shown scene, and its motion by keys.

use crate::camera::{Camera, Pose};
use crate::control::{self, Command, KeyMode, KeySpeed, Motion};
use crate::scene::Scene;
use crossterm::event::{KeyEvent, KeyEventKind};
use glam::Vec3;
use std::time::Duration;

/// Duration of the motion in the first frame after a key press, as if the key had been held for the
/// time of a frame.
// Without it the first frame would be the old picture, and a press would be visible one frame later.
pub(crate) const FIRST_FRAME_MOTION: Duration = Duration::from_micros(16_667);

/// The camera and the motion of it.
#[derive(Default)]
pub(super) struct Eye {
    /// `None` without a scene.
    view: Option<ViewState>,
    motion: Motion,
    /// Whether the turntable is on.
    turntable: bool,
    /// The time up to which the motion has been carried out; `None` at rest.
    moved_until: Option<Duration>,
    /// Whether motion is reduced: each press is one step at once, and nothing moves by itself.
    reduced_motion: bool,
}

/// The state of looking at a scene.
#[derive(Clone)]
pub(super) struct ViewState {
    home: Camera,
    camera: Camera,
    speed: f32,
    /// Whether the eye orbits its target instead of flying.
    orbits: bool,
    /// The views of the scene file.
    written: Vec<Camera>,
    /// The views saved by the user, by number.
    saved: [Option<Camera>; 9],
}

impl ViewState {
    /// Returns the initial view of a scene.
    pub(super) fn of(scene: &Scene, orbits: bool) -> Self {
        let home = *scene.camera();
        Self {
            home,
            camera: home,
            speed: control::speed(&home),
            orbits,
            written: scene.views().to_vec(),
            saved: [None; 9],
        }
    }

    /// The scene's own camera.
    pub(super) fn home(&self) -> Camera {
        self.home
    }
}

/// The size of a step with reduced motion, as the time for which a held key would move the eye.
// A tenth of the distance to the target, or nine degrees: large enough to see a change between two still pictures.
const REDUCED_MOTION_STEP: Duration = Duration::from_millis(200);

impl Eye {
    /// Returns an eye without a scene.
    ///
    /// With `reduced_motion` each press is one step at once and nothing glides, for people prone to motion sickness.
    pub(super) fn new(key_speed: KeySpeed, reduced_motion: bool) -> Self {
        Self { motion: Motion::with_speed(key_speed), reduced_motion, ..Self::default() }
    }

    /// Looks at another scene. Returns the view of the previous one.
    pub(super) fn open(&mut self, view: ViewState) -> Option<ViewState> {
        // A turntable that went on in the new scene would move it before the user has seen where it starts.
        self.turntable = false;
        self.view.replace(view)
    }

    /// Replaces the views of the scene file.
    pub(super) fn set_written(&mut self, views: Vec<Camera>) {
        if let Some(view) = &mut self.view {
            view.written = views;
        }
    }

    /// Returns the camera; `None` without a scene.
    pub(super) fn camera(&self) -> Option<Camera> {
        self.view.as_ref().map(|view| view.camera)
    }

    /// Returns the camera if it has been moved.
    pub(super) fn moved(&self) -> Option<Camera> {
        self.view.as_ref().filter(|view| view.camera != view.home).map(|view| view.camera)
    }

    /// Returns the time up to which the motion has been carried out; `None` at rest.
    pub(super) fn moved_until(&self) -> Option<Duration> {
        self.moved_until
    }

    /// Returns whether anything moves.
    pub(super) fn is_moving(&self) -> bool {
        self.moved_until.is_some()
    }

    /// Carries out the motion up to `now`.
    pub(super) fn advance(&mut self, now: Duration) {
        let Some(since) = self.moved_until else { return };
        // Asked before the step, which may end the motion: the rest of it is carried out below.
        self.moved_until = (self.turntable || self.motion.is_moving(now)).then_some(now);
        let Some(view) = &mut self.view else { return };
        view.camera = self.motion.step(&view.camera, view.speed, since, now);
        if self.turntable {
            view.camera = control::on_turntable(&view.camera, now.saturating_sub(since).as_secs_f32());
        }
    }

    /// Changes the camera by `change`, which gets the scene's size, and stops the turntable.
    pub(super) fn change(&mut self, now: Duration, change: impl FnOnce(&Camera, f32) -> Camera) {
        self.advance(now);
        self.turntable = false;
        if let Some(view) = &mut self.view {
            view.camera = change(&view.camera, view.speed);
        }
    }

    /// Starts or stops the turntable.
    pub(super) fn toggle_turntable(&mut self, now: Duration) {
        self.advance(now);
        self.turntable = !self.turntable;
        self.start_motion(now);
    }

    /// Starts the motion. The first frame already shows the motion of a frame's time.
    fn start_motion(&mut self, now: Duration) {
        let moves = self.turntable || self.motion.is_moving(now);
        self.moved_until = moves.then(|| self.moved_until.unwrap_or(now.saturating_sub(FIRST_FRAME_MOTION)));
    }

    /// Goes to the view saved as `number`, from 1, or that view of the scene file.
    ///
    /// `None` if there is none.
    pub(super) fn go_to(&mut self, number: u8, now: Duration) -> Option<()> {
        let view = self.view.as_ref()?;
        let at = usize::from(number).checked_sub(1)?;
        // A view saved by the user hides the one of the file with its number.
        let saved = view.saved.get(at).copied().flatten().or_else(|| view.written.get(at).copied())?;
        self.change(now, |_, _| saved);
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

    /// Switches between flight and orbit.
    ///
    /// Orbit starts around the point seen in the middle of the picture, which leaves the picture as it is.
    pub(super) fn change_mode(&mut self, in_the_middle: Option<Vec3>) {
        let Some(view) = &mut self.view else { return };
        view.orbits = !view.orbits;
        if let (true, Some(target)) = (view.orbits, in_the_middle) {
            // Only the target changes, along the view direction: the picture stays as it is. A target in the eye is
            // refused.
            view.camera = view.camera.with_pose(Pose { target, ..view.camera.pose() }).unwrap_or(view.camera);
        }
    }

    /// Carries out the motion so far, then passes the key to it.
    pub(super) fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        if self.reduced_motion {
            self.take_step(key, meant);
            return;
        }
        self.advance(now);
        // Any movement key stops the turntable, which would otherwise fight against it.
        self.turntable &= key.kind == KeyEventKind::Release || !meant.is_some_and(|(command, _)| command.moves());
        self.motion.take_key(key, meant, now);
        self.start_motion(now);
    }

    /// Moves by one step, for a press or a repeat.
    fn take_step(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>) {
        let Some(view) = self.view.as_mut().filter(|_| key.kind != KeyEventKind::Release) else { return };
        // With reduced motion no key is held: steps are the only motion.
        let mut motion = self.motion.clone();
        motion.take_key(&KeyEvent { kind: KeyEventKind::Press, ..*key }, meant, Duration::ZERO);
        view.camera = motion.step(&view.camera, view.speed, Duration::ZERO, REDUCED_MOTION_STEP);
    }

    /// Releases all keys.
    pub(super) fn release(&mut self, now: Duration) {
        self.advance(now);
        self.motion.stop();
        self.moved_until = self.moved_until.filter(|_| self.turntable);
    }

    /// Stops all motion.
    pub(super) fn stop(&mut self, now: Duration) {
        self.release(now);
        self.turntable = false;
        self.moved_until = None;
    }

    /// Sets whether the terminal reports releases. Held keys are released if it no longer does.
    pub(super) fn set_reports_releases(&mut self, reports_releases: bool, now: Duration) {
        // Their releases would never be reported, and they would move the eye for ever.
        if self.reports_releases() && !reports_releases {
            self.release(now);
        }
        self.motion.set_reports_releases(reports_releases);
    }

    fn reports_releases(&self) -> bool {
        self.motion.reports_releases()
    }

    /// Returns to the scene's own camera.
    pub(super) fn reset(&mut self, now: Duration) {
        let home = self.view.as_ref().map(|view| view.home);
        self.change(now, |camera, _| home.unwrap_or(*camera));
    }
}
