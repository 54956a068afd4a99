//! One person's view, without a terminal: what the terminal sends, the window's size, scenes, finished frames and the time
//! in; bytes, frames to be traced, requests to the driver and the time of the next wake-up out.
//!
//! Pure: it reads no clock, file or environment, and starts no thread. A driver (`app` on a terminal, or a test) tells it
//! what happens, does what [`Viewer::step`] returns until there is nothing to do, and then carries out what
//! [`Viewer::ask`] asks for.
//!
//! Each piece of state has one owner: `display` (the terminal), `receiver` (its bytes), `gallery` (the scene and its
//! lights), `eye` (the camera), `hand` (the mouse), `screen` (frame, layers, cells), `pacing` (what was begun and sent).
//! `schedule` decides what is done when.

use crate::camera::Camera;
use crate::capabilities::Capabilities;
use crate::control::Bindings;
use crate::framebuffer::Resolution;
use crate::grid::{Size, Window};
use crate::memory::OutOfMemory;
use crate::progress::Progress;
use crate::protocol::{Mode, Receiver};
use crate::render::Sampling;
use crate::scene::Scene;
use crate::text::Notice;
use std::collections::VecDeque;
use std::time::Duration;

mod asking;
mod dialog;
mod display;
mod effort;
mod events;
mod explain;
mod explaining;
mod extent;
mod eye;
mod fault;
mod frame;
mod gallery;
mod hand;
mod help;
mod layers;
mod legend;
mod lighting;
mod lights;
mod look;
mod mark;
mod moving;
mod note;
mod options;
mod pacing;
mod pointing;
mod progress;
mod schedule;
mod screen;
mod shown;
mod status;
#[cfg(any(test, feature = "test-hooks"))]
mod story;
mod tracked;
mod wiping;

use display::Display;
pub use extent::MAX_PIXELS;
use eye::Eye;
pub(crate) use eye::FRAME;
use fault::Fault;
pub(crate) use frame::{Frame, Job, Shot};
use gallery::Gallery;
use hand::Hand;
use note::Note;
pub use options::Options;
use pacing::Pacing;
use progress::ProgressPanel;
use schedule::{Action, Facts, Picture, decide};
pub(crate) use schedule::{Busy, Tracing};
use screen::Screen;
pub(crate) use shown::{MIDDLE, Shown};
#[cfg(feature = "test-hooks")]
pub use story::tell;

/// For how long the first picture is held back to be refined before it is shown. Up to there it is shown once, whole; a
/// longer wait is felt. With 16.7 ms, three spheres at 200x60 cells were shown after 15 ms, of which 9 went into
/// refinement.
const FIRST_REFINEMENT: Duration = Duration::from_millis(4);

/// What the driver is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ask {
    /// End the view.
    Leave,
    /// Stop the job, as Ctrl-Z does.
    Suspend,
    /// Go that many scenes on.
    GoOn(isize),
    /// Give this to the user's clipboard.
    Copy(String),
    /// Write the picture into a file.
    Export(crate::export::Format),
    /// Ask the user whether this camera is to be written into the scene's file, where it stands in one.
    ProposeView(Camera),
    /// Write the camera that was proposed last.
    KeepView,
}

/// What the driver is to do next.
pub(crate) enum Step {
    /// Take what [`Viewer::draw`] draws, and send it.
    Draw,
    /// Send these bytes, if there are any; then trace this frame, and hand it to [`Viewer::take_frame`].
    Trace(Vec<u8>, Job),
    /// Give up the frame that is being refined.
    GiveUp,
    /// Wait for something to happen, until that time or for ever.
    Wait(Option<Duration>),
}

/// One person's view.
pub(crate) struct Viewer {
    options: Options,
    display: Display,
    receiver: Receiver,
    gallery: Gallery,
    eye: Eye,
    /// Which maps of the scene are wanted.
    shown: Shown,
    hand: Hand,
    screen: Screen,
    pacing: Pacing,
    asks: VecDeque<Ask>,
    /// The time as it was last told.
    now: Duration,
}

impl Viewer {
    /// A view of nothing yet.
    ///
    /// # Errors
    /// If there is not enough memory for that window.
    pub(crate) fn new(mut options: Options, window: Window) -> Result<Self, OutOfMemory> {
        let display = Display::new(options.hints.clone(), window);
        let screen = Screen::new(display.capabilities(), options.order, options.quality);
        let mut viewer = Self {
            pacing: Pacing::new(&options, display.questions().is_open()),
            receiver: Receiver::default(),
            gallery: Gallery::default(),
            eye: Eye::new(options.pace, options.reduced_motion),
            shown: Shown::one(options.map),
            hand: Hand::default(),
            asks: VecDeque::new(),
            now: Duration::ZERO,
            display,
            screen,
            options: Options { welcome: None, ..options.clone() },
        };
        if let Some(welcome) = options.welcome.take() {
            viewer.say(welcome);
        }
        viewer.resize(window)?;
        Ok(viewer)
    }

    fn set_time(&mut self, now: Duration) {
        self.now = now;
    }

    /// Returns the queries for the terminal: to be sent at the start, and whenever another program has had the terminal.
    pub(crate) fn questions(&mut self, now: Duration) -> Vec<u8> {
        let questions = self.display.questions();
        let bytes = if questions.is_open() { questions.bytes().to_vec() } else { Vec::new() };
        self.receiver.sent(&bytes, now);
        bytes
    }

    /// The window has this size now, or the terminal has moved what it shows to wherever it thought right.
    ///
    /// # Errors
    /// If there is not enough memory for that window.
    pub(crate) fn resize(&mut self, window: Window) -> Result<(), OutOfMemory> {
        let before = *self.display.capabilities();
        self.display.set_window(window);
        self.heed_capabilities(&before)?;
        self.display.check_memory()?;
        self.redraw();
        Ok(())
    }

    /// More may be known of the terminal than before.
    fn heed_capabilities(&mut self, before: &Capabilities) -> Result<(), OutOfMemory> {
        if self.display.capabilities() != before {
            self.screen.set_capabilities(self.display.capabilities());
            self.display.check_memory()?;
        }
        Ok(())
    }

    /// The terminal may show anything: all is drawn anew, and what the picture does not cover is emptied.
    fn redraw(&mut self) {
        let (size, window) = (self.display.size(), self.display.window_size());
        self.screen.redraw(self.display.capabilities().halves_meet, size != window);
        if size != window {
            let [size, window] = [size, window].map(|Size { columns, rows }| format!("{columns}x{rows}"));
            self.say(format!("the picture covers {size} of the window's {window} cells"));
        }
    }

    /// How far the scene is that was asked for.
    pub(crate) fn show_progress(&mut self, progress: Progress) {
        self.screen.open(ProgressPanel(progress));
    }

    /// Something of a scene to look at until it is there: better than another scene, but not than what was good until its
    /// file changed.
    pub(crate) fn show_sketch(&mut self, sketch: Scene, of: usize, orbits: bool) {
        if self.gallery.shown() != Some(of) {
            self.screen.close::<Fault>();
            self.open(sketch, of, orbits);
        }
    }

    /// The scene of that number is there. It is looked at from where it wants to be; from where it was looked at, if it has
    /// wanted the same before.
    pub(crate) fn show(&mut self, scene: Scene, of: usize, orbits: bool) {
        self.screen.close_later::<ProgressPanel>();
        self.screen.close::<Fault>();
        self.open(scene, of, orbits);
    }

    fn open(&mut self, scene: Scene, of: usize, orbits: bool) {
        let (before, written) = (self.gallery.shown(), scene.views().to_vec());
        if let Some(view) = self.gallery.show(scene, of, orbits) {
            let left = self.eye.open(view);
            if let Some((before, left)) = before.zip(left).filter(|(before, _)| *before != of) {
                self.gallery.leave(before, left);
            }
        }
        self.eye.set_written(written);
    }

    /// The scene that was asked for will not come: what is wrong with it.
    pub(crate) fn show_fault(&mut self, fault: Notice) {
        self.screen.close_later::<ProgressPanel>();
        self.screen.open(Fault(fault));
    }

    /// Says something in the lowest row until the next key.
    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.screen.open(Note(text.into()));
    }

    /// A frame that was asked for is done.
    pub(crate) fn take_frame(&mut self, frame: Frame) {
        self.pacing.took(&frame);
        let moving = self.is_in_motion().then_some(self.now);
        self.screen.take_frame(frame, moving);
    }

    /// The next thing to do.
    pub(crate) fn step(&mut self, busy: Busy, now: Duration) -> Step {
        self.set_time(now);
        self.eye.go_on(now);
        self.screen.set_moving(self.eye.mode());
        self.mark_light();
        match decide(&self.facts(busy), now) {
            Action::GiveUp => Step::GiveUp,
            Action::Draw => Step::Draw,
            Action::Trace => self.trace(),
            Action::Refine => self.refine(),
            Action::Wait(until) => Step::Wait(until.into_iter().chain(self.receiver.escape_due(now)).min()),
        }
    }

    fn facts(&self, busy: Busy) -> Facts {
        let size = self.display.size();
        Facts {
            busy,
            picture: self.picture(),
            holds_first_back: !self.screen.has_shown() && self.pacing.ends_within(FIRST_REFINEMENT),
            begun: self.pacing.begun_at(),
            moved_until: self.eye.moved_until(),
            frame_time: self.pacing.frame_time(),
            link_free_at: self.pacing.free_at(self.now),
            is_changed: self.screen.is_changed(size),
            improvable_at: self.screen.improvable_at(size),
        }
    }

    fn picture(&self) -> Picture {
        if self.wanted().is_some_and(|wanted| !self.pacing.has_begun(&wanted)) {
            Picture::Stale
        } else if self.next_step().is_some() {
            Picture::Refinable
        } else {
            Picture::Finished
        }
    }

    /// Begins a frame of the new view; before it, a query shows the link's own round trip.
    fn trace(&mut self) -> Step {
        let Some((scene, shot)) = self.scene().zip(self.wanted()) else { return Step::Wait(None) };
        let probe = self.pacing.probe(self.now);
        self.receiver.sent(&probe, self.now);
        let sampling = self.pacing.begin(shot, self.is_in_motion(), self.now);
        Step::Trace(probe, Job { scene, shot, sampling: self.shown.sampling(sampling), refines: false })
    }

    /// Begins the next step of the last frame.
    fn refine(&self) -> Step {
        let wanted = self.scene().zip(self.wanted()).zip(self.next_step());
        let Some(((scene, shot), sampling)) = wanted else { return Step::Wait(None) };
        Step::Trace(Vec::new(), Job { scene, shot, sampling, refines: true })
    }

    /// The scene that is shown, with the lights where they are.
    fn scene(&self) -> Option<Scene> {
        self.gallery.lights().map(|lights| lights.scene().clone())
    }

    /// What the picture is to show, if there is anything to see.
    fn wanted(&self) -> Option<Shot> {
        let (lights, camera) = (self.gallery.lights()?, self.eye.camera()?);
        let (scene, resolution) = (self.gallery.count(), self.display.resolution());
        Some(Shot { scene, lights: lights.moves(), camera, resolution, shown: self.shown })
    }

    /// How finely the frame that is on the screen is traced next, if it can be refined.
    fn next_step(&self) -> Option<Sampling> {
        // Refining a sketch would take the time that the scene needs.
        let frame = self.screen.frame().filter(|_| !self.screen.awaits_scene())?;
        let next = self.shown.sampling(self.pacing.next_step(frame.sampling)?);
        (next != frame.sampling).then_some(next)
    }

    /// Whether the next frame is likely to be of another view, too.
    fn is_in_motion(&self) -> bool {
        self.eye.is_moving() || self.hand.holds()
    }

    /// Appends the bytes that bring the screen up to date. [`end_frame`](Self::end_frame) is to be called with what it
    /// appended.
    pub(crate) fn draw(&mut self, now: Duration, bytes: &mut Vec<u8>) {
        self.set_time(now);
        let size = self.display.size();
        let limit = self.pacing.limit(Screen::usual_bytes(size), now);
        self.screen.draw(size, &self.options.bindings, limit, now, bytes);
    }

    /// Ends what was drawn with a query; of no bytes, nothing is to be sent. `now` is later than when it was drawn: cells
    /// and bytes took their time, which is not the link's.
    pub(crate) fn end_frame(&mut self, bytes: &mut Vec<u8>, now: Duration) {
        self.screen.took(now.saturating_sub(self.now));
        if bytes.is_empty() {
            return;
        }
        // Also at rest: a frame's own round trip is longer than the link's, which its rate is judged by.
        let probe = self.pacing.probe(now);
        self.receiver.sent(&probe, now);
        self.pacing.send(bytes, now);
        self.receiver.sent(bytes, now);
        bytes.splice(0..0, probe);
    }

    /// What the driver is asked to do next, if anything.
    pub(crate) fn ask(&mut self) -> Option<Ask> {
        self.asks.pop_front()
    }

    /// The modes that are to be on besides those that every terminal knows.
    pub(crate) fn modes(&self) -> impl Iterator<Item = Mode> {
        self.display.modes()
    }

    /// Whether anything was shown yet.
    pub(crate) fn has_shown(&self) -> bool {
        self.screen.has_shown()
    }

    /// The number of the scene that is shown.
    pub(crate) fn shown_scene(&self) -> Option<usize> {
        self.gallery.shown()
    }

    /// The last frame.
    pub(crate) fn frame(&self) -> Option<&Frame> {
        self.screen.frame()
    }

    pub(crate) fn capabilities(&self) -> &Capabilities {
        self.display.capabilities()
    }

    /// The camera, if the user has moved it.
    pub(crate) fn moved(&self) -> Option<Camera> {
        self.eye.moved()
    }

    /// What is still to come from the terminal when it is given back.
    pub(crate) fn receiver(&mut self) -> &mut Receiver {
        &mut self.receiver
    }

    fn resolution(&self) -> Resolution {
        self.display.resolution()
    }

    fn size(&self) -> Size {
        self.display.size()
    }

    fn bindings(&self) -> &Bindings {
        &self.options.bindings
    }
}
