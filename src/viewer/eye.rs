//! Where the scene is looked at from, and how keys move that.

use crate::camera::{Camera, Pose};
use crate::control::{self, Command, Mode, Motion, Pace};
use crate::scene::Scene;
use crossterm::event::{KeyEvent, KeyEventKind};
use glam::Vec3;
use std::time::Duration;

/// The first frame after a key already shows so much movement.
pub(crate) const FRAME: Duration = Duration::from_micros(16_667);

/// The eye, and what moves it.
#[derive(Default)]
pub(super) struct Eye {
    /// `None` as long as there is nothing to see.
    view: Option<View>,
    motion: Motion,
    /// Whether it goes around the target by itself.
    turntable: bool,
    /// Up to when the motion has been carried out; `None` at rest.
    moved_until: Option<Duration>,
    /// Whether each press is one step at once, and nothing moves by itself.
    steps: bool,
}

/// How a scene is looked at.
#[derive(Clone)]
pub(super) struct View {
    home: Camera,
    camera: Camera,
    speed: f32,
    /// Whether the eye goes around what it looks at; else it flies.
    orbits: bool,
    /// What the scene's file has.
    written: Vec<Camera>,
    /// What was saved since, and by which number.
    saved: [Option<Camera>; 9],
}

impl View {
    /// As the scene wants to be looked at.
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

    /// From where the scene wanted to be looked at.
    pub(super) fn home(&self) -> Camera {
        self.home
    }
}

/// A step is as far as a key moves that is held for so long: a tenth of the way to the target, or nine degrees.
const STEP: Duration = Duration::from_millis(200);

impl Eye {
    /// What keys do at that pace, and whether each press is to be one step at once, and nothing glides: for those whom
    /// movement makes unwell.
    pub(super) fn new(pace: Pace, steps: bool) -> Self {
        Self { motion: Motion::at_pace(pace), steps, ..Self::default() }
    }

    /// There is something else to see; how what was seen before was looked at.
    pub(super) fn open(&mut self, view: View) -> Option<View> {
        self.turntable = false;
        self.view.replace(view)
    }

    /// The scene's file has other views now.
    pub(super) fn set_written(&mut self, views: Vec<Camera>) {
        if let Some(view) = &mut self.view {
            view.written = views;
        }
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
    pub(super) fn go_on(&mut self, now: Duration) {
        let Some(since) = self.moved_until else { return };
        self.moved_until = (self.turntable || self.motion.is_moving(now)).then_some(now);
        let Some(view) = &mut self.view else { return };
        view.camera = self.motion.step(&view.camera, view.speed, since, now);
        if self.turntable {
            view.camera = control::on_turntable(&view.camera, now.saturating_sub(since).as_secs_f32());
        }
    }

    /// Does something to the camera, which is told how large the scene is. It stops what moves the eye by itself.
    pub(super) fn change(&mut self, now: Duration, change: impl FnOnce(&Camera, f32) -> Camera) {
        self.go_on(now);
        self.turntable = false;
        if let Some(view) = &mut self.view {
            view.camera = change(&view.camera, view.speed);
        }
    }

    /// Goes around the target by itself from now on, or no more.
    pub(super) fn toggle_turntable(&mut self, now: Duration) {
        self.go_on(now);
        self.turntable = !self.turntable;
        self.begin(now);
    }

    /// From rest, the first frame already shows a frame's worth of movement.
    fn begin(&mut self, now: Duration) {
        let moves = self.turntable || self.motion.is_moving(now);
        self.moved_until = moves.then(|| self.moved_until.unwrap_or(now.saturating_sub(FRAME)));
    }

    /// To the view that was saved by that number, from 1, or that view of the scene's file: `None` if there is none.
    pub(super) fn go_to(&mut self, number: u8, now: Duration) -> Option<()> {
        let view = self.view.as_ref()?;
        let at = usize::from(number).checked_sub(1)?;
        let saved = view.saved.get(at).copied().flatten().or_else(|| view.written.get(at).copied())?;
        self.change(now, |_, _| saved);
        Some(())
    }

    /// Saves the view by that number.
    pub(super) fn save(&mut self, number: u8) {
        if let Some(view) = &mut self.view
            && let Some(saved) = usize::from(number).checked_sub(1).and_then(|at| view.saved.get_mut(at))
        {
            *saved = Some(view.camera);
        }
    }

    /// How it moves.
    pub(super) fn mode(&self) -> Mode {
        if self.view.as_ref().is_some_and(|view| view.orbits) { Mode::Orbit } else { Mode::Fly }
    }

    /// To the other way of moving. To go around something, it looks at the point in the middle of its view: the picture
    /// stays as it is.
    pub(super) fn change_mode(&mut self, in_the_middle: Option<Vec3>) {
        let Some(view) = &mut self.view else { return };
        view.orbits = !view.orbits;
        if let (true, Some(target)) = (view.orbits, in_the_middle) {
            view.camera = view.camera.with_pose(Pose { target, ..view.camera.pose() }).unwrap_or(view.camera);
        }
    }

    /// What was going on is carried out before the key, which means something or nothing, changes it.
    pub(super) fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        if self.steps {
            self.take_step(key, meant);
            return;
        }
        self.go_on(now);
        self.turntable &= key.kind == KeyEventKind::Release || !meant.is_some_and(|(command, _)| command.moves());
        self.motion.take_key(key, meant, now);
        self.begin(now);
    }

    /// A press or a repeat is one step.
    fn take_step(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>) {
        let Some(view) = self.view.as_mut().filter(|_| key.kind != KeyEventKind::Release) else { return };
        // It holds nothing: steps are all there is.
        let mut motion = self.motion.clone();
        motion.take_key(&KeyEvent { kind: KeyEventKind::Press, ..*key }, meant, Duration::ZERO);
        view.camera = motion.step(&view.camera, view.speed, Duration::ZERO, STEP);
    }

    /// Nothing is held any more.
    pub(super) fn let_go(&mut self, now: Duration) {
        self.go_on(now);
        self.motion.stop();
        self.moved_until = self.moved_until.filter(|_| self.turntable);
    }

    /// Nothing moves any more.
    pub(super) fn stand_still(&mut self, now: Duration) {
        self.let_go(now);
        self.turntable = false;
        self.moved_until = None;
    }

    /// Whether the terminal tells of releases from now on. What is held is let go of when it no longer does.
    pub(super) fn set_hears_releases(&mut self, hears_releases: bool, now: Duration) {
        if self.hears_releases() && !hears_releases {
            self.let_go(now);
        }
        self.motion.set_hears_releases(hears_releases);
    }

    fn hears_releases(&self) -> bool {
        self.motion.hears_releases()
    }

    /// Back to where it was first.
    pub(super) fn reset(&mut self, now: Duration) {
        let home = self.view.as_ref().map(|view| view.home);
        self.change(now, |camera, _| home.unwrap_or(*camera));
    }
}
