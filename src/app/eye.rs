//! Where the scene is looked at from, and how keys move that.

use crate::camera::{Camera, Pose};
use crate::control::{self, Command, Mode, Motion};
use crossterm::event::{KeyEvent, KeyEventKind};
use glam::Vec3;
use std::time::Duration;

/// The first frame after a key already shows so much movement.
pub(super) const FRAME: Duration = Duration::from_micros(16_667);

/// The eye, and what moves it. Methods that may move it tell whether they did.
#[derive(Default)]
pub(super) struct Eye {
    /// `None` as long as there is nothing to see.
    view: Option<View>,
    /// Whether it goes around what it looks at; else it flies.
    orbits: bool,
    motion: Motion,
    /// Up to when the motion has been carried out; `None` at rest.
    moved_until: Option<Duration>,
    /// Whether each press is one step at once, and nothing moves by itself.
    steps: bool,
}

/// How the scene is looked at.
struct View {
    home: Camera,
    camera: Camera,
    speed: f32,
}

/// A step is as far as a key moves that is held for so long: a tenth of the way to the target, or nine degrees.
const STEP: Duration = Duration::from_millis(200);

impl Eye {
    /// Whether each press of a key is to be one step at once, and nothing glides: for those whom movement makes unwell.
    pub(super) fn in_steps(steps: bool) -> Self {
        Self { steps, ..Self::default() }
    }

    /// There is something to see, and from there it is looked at first.
    pub(super) fn open(&mut self, camera: Camera) {
        self.view.get_or_insert(View { home: camera, camera, speed: control::speed(&camera) });
    }

    /// There is something else to see: from where it wants to be looked at, and from where it is.
    pub(super) fn open_anew(&mut self, home: Camera, camera: Camera) {
        self.view = Some(View { home, camera, speed: control::speed(&home) });
    }

    /// `None` as long as there is nothing to see.
    pub(super) fn camera(&self) -> Option<Camera> {
        self.view.as_ref().map(|view| view.camera)
    }

    /// Where the camera is, if it is not where it was.
    pub(super) fn moved(&self) -> Option<Camera> {
        self.view.as_ref().filter(|view| view.camera != view.home).map(|view| view.camera)
    }

    /// Up to when the motion has been carried out; `None` at rest.
    pub(super) fn moved_until(&self) -> Option<Duration> {
        self.moved_until
    }

    /// Whether anything moves, as far as the motion has been carried out.
    pub(super) fn is_moving(&self) -> bool {
        self.moved_until.is_some()
    }

    /// Carries the motion out up to now.
    #[must_use]
    pub(super) fn go_on(&mut self, now: Duration) -> bool {
        let Some(since) = self.moved_until else { return false };
        self.moved_until = self.motion.is_moving(now).then_some(now);
        let Some(view) = &mut self.view else { return false };
        let before = view.camera;
        view.camera = self.motion.step(&before, view.speed, since, now);
        view.camera != before
    }

    /// How it moves.
    pub(super) fn mode(&self) -> Mode {
        if self.orbits { Mode::Orbit } else { Mode::Fly }
    }

    /// To the other way of moving. To go around something, it looks at the point in the middle of its view: the picture
    /// stays as it is.
    pub(super) fn change_mode(&mut self, in_the_middle: Option<Vec3>) {
        self.orbits = !self.orbits;
        if let (true, Some(target), Some(view)) = (self.orbits, in_the_middle, &mut self.view) {
            view.camera = view.camera.with_pose(Pose { target, ..view.camera.pose() }).unwrap_or(view.camera);
        }
    }

    /// What was going on is carried out before the key, which means something or nothing, changes it.
    #[must_use]
    pub(super) fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) -> bool {
        if self.steps {
            return self.take_step(key, meant);
        }
        let moved = self.go_on(now);
        self.motion.take_key(key, meant, now);
        // From rest, the first frame already shows a frame's worth of movement.
        self.moved_until = self.motion.is_moving(now).then(|| self.moved_until.unwrap_or(now.saturating_sub(FRAME)));
        moved
    }

    /// A press or a repeat is one step.
    fn take_step(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>) -> bool {
        let Some(view) = self.view.as_mut().filter(|_| key.kind != KeyEventKind::Release) else { return false };
        let mut motion = Motion::default();
        motion.take_key(&KeyEvent { kind: KeyEventKind::Press, ..*key }, meant, Duration::ZERO);
        let before = view.camera;
        view.camera = motion.step(&before, view.speed, Duration::ZERO, STEP);
        view.camera != before
    }

    /// Nothing is held any more.
    #[must_use]
    pub(super) fn stand_still(&mut self, now: Duration) -> bool {
        let moved = self.go_on(now);
        self.motion.stop();
        self.moved_until = None;
        moved
    }

    /// Whether the terminal tells of releases from now on. What is held is let go of when it no longer does.
    #[must_use]
    pub(super) fn set_hears_releases(&mut self, hears_releases: bool, now: Duration) -> bool {
        let moved = self.hears_releases() && !hears_releases && self.stand_still(now);
        self.motion.set_hears_releases(hears_releases);
        moved
    }

    pub(super) fn hears_releases(&self) -> bool {
        self.motion.hears_releases()
    }

    /// Back to where it was first.
    #[must_use]
    pub(super) fn reset(&mut self) -> bool {
        let moved = self.moved().is_some();
        if let Some(view) = &mut self.view {
            view.camera = view.home;
        }
        moved
    }
}
