//! A user's view of scenes, without a terminal.
//!
//! Inputs are the terminal's bytes, the window's size, scenes, finished frames and the time. Outputs are bytes, frames
//! to trace, requests to the driver and the time of the next wake-up.
//!
//! Pure: it reads no clock, file or environment, and starts no thread. A driver (`app` on a terminal, or a test)
//! reports events, carries out what [`Viewer::step`] returns until nothing is left to do, and then the requests of
//! [`Viewer::next_request`].
//!
//! Each piece of state has one owner: `display` (the terminal), `receiver` (its bytes), `scenes` (the scene and its
//! lights), `eye` (the camera), `pointer` (the mouse), `screen` (frame, layers, cells), `pacing` (frames begun and
//! sent). `schedule` decides when each thing is done.

use crate::camera::Camera;
use crate::capabilities::Capabilities;
use crate::control::Keymap;
use crate::framebuffer::Resolution;
use crate::grid::{Size, Window};
use crate::memory::OutOfMemory;
use crate::progress::Progress;
use crate::protocol::{Receiver, TerminalMode};
use crate::render::Sampling;
use crate::scene::Scene;
use crate::text::Notice;
use std::collections::VecDeque;
use std::time::Duration;

mod requests;
mod dialog;
mod display;
mod quality_control;
mod events;
mod explain;
mod explain_commands;
mod extent;
mod eye;
mod error_panel;
mod frame;
mod scene_history;
mod pointer;
mod help;
mod layers;
mod legend;
mod light_commands;
mod lights;
mod theme;
mod light_marker;
mod camera_commands;
mod note;
mod options;
mod pacing;
mod mouse_actions;
mod progress;
mod schedule;
mod screen;
mod view_layout;
mod status;
#[cfg(any(test, feature = "test-hooks"))]
mod scenario;
mod tracked;
mod wipe_commands;

use display::Display;
use error_panel::ErrorPanel;
pub use extent::MAX_PIXELS;
use eye::Eye;
pub(crate) use eye::FIRST_FRAME_MOTION;
pub(crate) use frame::{Frame, Job, Shot};
use note::Note;
pub use options::Options;
use pacing::Pacing;
use pointer::PointerState;
use progress::ProgressPanel;
#[cfg(feature = "test-hooks")]
pub use scenario::run_scenario;
use scene_history::SceneHistory;
use schedule::{Action, Facts, Picture, decide};
pub(crate) use schedule::{DriverState, Tracing};
use screen::Screen;
pub(crate) use view_layout::{INITIAL_WIPE, ViewLayout};

/// Time for which the first picture is held back to be refined.
///
/// Up to this long it is shown once, complete.
// A longer wait is felt: with 16.7 ms, three spheres at 200x60 cells were shown after 15 ms, 9 of which went into
// refinement. Without it small pictures would be sent twice.
const FIRST_REFINEMENT: Duration = Duration::from_millis(4);

/// A request to the driver.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// Leave the view.
    Leave,
    /// Stop the job, as Ctrl-Z does.
    Suspend,
    /// Switch to the scene that many further on.
    SwitchScene(isize),
    /// Copy this text to the user's clipboard.
    Copy(String),
    /// Write the picture into a file.
    Export(crate::export::Format),
    /// Ask the user whether to write this camera into the scene's file, if it has one.
    ProposeView(Camera),
    /// Write the camera that was proposed last.
    SaveView,
}

/// The driver's next action.
pub(crate) enum Step {
    /// Send the bytes that [`Viewer::draw`] appends.
    Draw,
    /// Send these bytes, if any; then trace this frame and pass it to [`Viewer::take_frame`].
    Trace(Vec<u8>, Job),
    /// Cancel the refinement in progress.
    GiveUp,
    /// Wait for an event, until this time if given.
    Wait(Option<Duration>),
}

/// A user's view of scenes.
pub(crate) struct Viewer {
    options: Options,
    display: Display,
    receiver: Receiver,
    scenes: SceneHistory,
    eye: Eye,
    /// The maps that are wanted.
    layout: ViewLayout,
    pointer: PointerState,
    screen: Screen,
    pacing: Pacing,
    requests: VecDeque<Request>,
    /// The time of the last call.
    now: Duration,
}

impl Viewer {
    /// Returns a view without a scene.
    ///
    /// # Errors
    /// If there is not enough memory for the window.
    pub(crate) fn new(mut options: Options, window: Window) -> Result<Self, OutOfMemory> {
        let display = Display::new(options.hints.clone(), window);
        let screen = Screen::new(display.capabilities(), options.order, options.quality);
        let mut viewer = Self {
            pacing: Pacing::new(&options, display.queries().is_open()),
            receiver: Receiver::default(),
            scenes: SceneHistory::default(),
            eye: Eye::new(options.key_speed, options.reduced_motion),
            layout: ViewLayout::one(options.map),
            pointer: PointerState::default(),
            requests: VecDeque::new(),
            now: Duration::ZERO,
            display,
            screen,
            options: Options { welcome: None, ..options.clone() },
        };
        if let Some(welcome) = options.welcome.take() {
            viewer.show_note(welcome);
        }
        viewer.resize(window)?;
        Ok(viewer)
    }

    fn set_time(&mut self, now: Duration) {
        self.now = now;
    }

    /// Returns the queries to send at the start, and whenever another program has had the terminal.
    pub(crate) fn queries(&mut self, now: Duration) -> Vec<u8> {
        let queries = self.display.queries();
        let bytes = if queries.is_open() { queries.bytes().to_vec() } else { Vec::new() };
        self.receiver.sent(&bytes, now);
        bytes
    }

    /// Sets the window's size. Call this too when the terminal may have moved its contents.
    ///
    /// # Errors
    /// If there is not enough memory for the window.
    pub(crate) fn resize(&mut self, window: Window) -> Result<(), OutOfMemory> {
        let before = *self.display.capabilities();
        self.display.set_window(window);
        // The cell shape may have changed with the font, and with it the half blocks that join.
        self.heed_capabilities(&before)?;
        self.display.check_memory()?;
        self.redraw();
        Ok(())
    }

    /// Adopts new findings about the terminal.
    fn heed_capabilities(&mut self, before: &Capabilities) -> Result<(), OutOfMemory> {
        if self.display.capabilities() != before {
            self.screen.set_capabilities(self.display.capabilities());
            self.display.check_memory()?;
        }
        Ok(())
    }

    /// Forgets what the terminal shows.
    ///
    /// Everything is drawn anew, and the part outside the picture is cleared.
    fn redraw(&mut self) {
        let (size, window) = (self.display.size(), self.display.window_size());
        // Erased only where the picture leaves a part free: otherwise the frame itself covers the window, and erasing
        // first would flash.
        self.screen.redraw(self.display.capabilities().half_blocks, size != window);
        if size != window {
            let [size, window] = [size, window].map(|Size { columns, rows }| format!("{columns}x{rows}"));
            self.show_note(format!("the picture covers {size} of the window's {window} cells"));
        }
    }

    /// Shows the progress of a load.
    pub(crate) fn show_progress(&mut self, progress: Progress) {
        self.screen.open(ProgressPanel(progress));
    }

    /// Shows a coarse scene until the complete one is loaded.
    ///
    /// It replaces a picture of another scene, but not a good picture of the same scene before its file changed.
    pub(crate) fn show_sketch(&mut self, sketch: Scene, of: usize, orbits: bool) {
        if self.scenes.shown() != Some(of) {
            self.screen.close::<ErrorPanel>();
            self.open(sketch, of, orbits);
        }
    }

    /// Shows scene number `of`, from its own camera.
    ///
    /// Starts from where the user left it, if its own camera is the same as then.
    pub(crate) fn show(&mut self, scene: Scene, of: usize, orbits: bool) {
        // The progress panel goes with the first frame of the scene: drawing the screen once more without it would
        // delay that frame.
        self.screen.close_quietly::<ProgressPanel>();
        self.screen.close::<ErrorPanel>();
        self.open(scene, of, orbits);
    }

    fn open(&mut self, scene: Scene, of: usize, orbits: bool) {
        let (before, written) = (self.scenes.shown(), scene.views().to_vec());
        if let Some(view) = self.scenes.show(scene, of, orbits) {
            let left = self.eye.open(view);
            if let Some((before, left)) = before.zip(left).filter(|(before, _)| *before != of) {
                self.scenes.leave(before, left);
            }
        }
        // Also for a scene whose view is kept: its file may have got other views.
        self.eye.set_written(written);
    }

    /// Shows the error of a load.
    pub(crate) fn show_error(&mut self, fault: Notice) {
        self.screen.close_quietly::<ProgressPanel>();
        self.screen.open(ErrorPanel(fault));
    }

    /// Shows a note in the lowest row until the next key.
    pub(crate) fn show_note(&mut self, text: impl Into<String>) {
        self.screen.open(Note(text.into()));
    }

    /// Takes a finished frame.
    pub(crate) fn take_frame(&mut self, frame: Frame) {
        self.pacing.record_frame(&frame);
        // Refinements at rest would make the frame rate of a motion seem higher.
        let moving = self.is_in_motion().then_some(self.now);
        self.screen.take_frame(frame, moving);
    }

    /// Returns the driver's next action.
    pub(crate) fn step(&mut self, busy: DriverState, now: Duration) -> Step {
        self.set_time(now);
        // The eye moves first, so that the decision is made about the view of now and not of the last wake-up.
        self.eye.advance(now);
        self.screen.set_moving(self.eye.mode());
        self.mark_light();
        match decide(&self.facts(busy), now) {
            Action::GiveUp => Step::GiveUp,
            Action::Draw => Step::Draw,
            Action::Trace => self.trace(),
            Action::Refine => self.refine(),
            // An incomplete escape sequence needs a wake-up of its own: no bytes may follow.
            Action::Wait(until) => Step::Wait(until.into_iter().chain(self.receiver.escape_due(now)).min()),
        }
    }

    fn facts(&self, busy: DriverState) -> Facts {
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
        } else if self.next_refinement().is_some() {
            Picture::Refinable
        } else {
            Picture::Finished
        }
    }

    /// Begins a frame of a new view.
    ///
    /// A query before it measures the link's round trip without a frame's bytes.
    fn trace(&mut self) -> Step {
        let Some((scene, shot)) = self.scene().zip(self.wanted()) else { return Step::Wait(None) };
        let probe = self.pacing.probe(self.now);
        self.receiver.sent(&probe, self.now);
        let sampling = self.pacing.begin(shot, self.is_in_motion(), self.now);
        Step::Trace(probe, Job { scene, shot, sampling: self.layout.sampling(sampling), refines: false })
    }

    /// Begins the next refinement of the last frame.
    fn refine(&self) -> Step {
        let wanted = self.scene().zip(self.wanted()).zip(self.next_refinement());
        let Some(((scene, shot), sampling)) = wanted else { return Step::Wait(None) };
        Step::Trace(Vec::new(), Job { scene, shot, sampling, refines: true })
    }

    /// Returns the shown scene, with its lights as moved by the user.
    fn scene(&self) -> Option<Scene> {
        self.scenes.lights().map(|lights| lights.scene().clone())
    }

    /// Returns the shot that the picture is to show, or `None` without a scene.
    fn wanted(&self) -> Option<Shot> {
        let (lights, camera) = (self.scenes.lights()?, self.eye.camera()?);
        let (scene, resolution) = (self.scenes.count(), self.display.resolution());
        Some(Shot { scene, lights: lights.moves(), camera, resolution, layout: self.layout })
    }

    /// Returns the sampling of the next refinement of the shown frame, or `None` if it cannot be
    /// refined.
    fn next_refinement(&self) -> Option<Sampling> {
        // Refining a sketch would take time from building the scene.
        let frame = self.screen.frame().filter(|_| !self.screen.awaits_scene())?;
        let next = self.layout.sampling(self.pacing.next_refinement(frame.sampling)?);
        (next != frame.sampling).then_some(next)
    }

    /// Returns whether the next frame will probably be of another view, too.
    fn is_in_motion(&self) -> bool {
        self.eye.is_moving() || self.pointer.holds()
    }

    /// Appends the bytes that bring the screen up to date.
    ///
    /// Call [`end_frame`](Self::end_frame) with them afterwards.
    pub(crate) fn draw(&mut self, now: Duration, bytes: &mut Vec<u8>) {
        self.set_time(now);
        let size = self.display.size();
        let limit = self.pacing.limit(Screen::usual_bytes(size), now);
        self.screen.draw(size, &self.options.keymap, limit, now, bytes);
    }

    /// Appends the query that ends a frame; does nothing if `bytes` is empty.
    ///
    /// `now` is later than at [`draw`](Self::draw): the time for cells and bytes must not count as the link's.
    pub(crate) fn end_frame(&mut self, bytes: &mut Vec<u8>, now: Duration) {
        self.screen.record_encode_time(now.saturating_sub(self.now));
        if bytes.is_empty() {
            return;
        }
        // Also at rest: a frame's round trip is longer than the link's own, from which the rate is derived. On a link
        // of 50 KB/s and 200 ms, a refinement without a query before it had a round trip of 267 ms, which was taken for
        // the link's own, and the rate then seemed 562 KB/s.
        let probe = self.pacing.probe(now);
        self.receiver.sent(&probe, now);
        self.pacing.send(bytes, now);
        self.receiver.sent(bytes, now);
        // The query goes before the frame, so that its reply does not wait for the frame's transmission.
        bytes.splice(0..0, probe);
    }

    /// Returns the next request to the driver, if any.
    pub(crate) fn next_request(&mut self) -> Option<Request> {
        self.requests.pop_front()
    }

    /// Returns the modes to switch on besides those that every terminal supports.
    pub(crate) fn modes(&self) -> impl Iterator<Item = TerminalMode> {
        self.display.modes()
    }

    /// Returns whether a frame has been shown.
    pub(crate) fn has_shown(&self) -> bool {
        self.screen.has_shown()
    }

    /// Returns the number of the shown scene.
    pub(crate) fn shown_scene(&self) -> Option<usize> {
        self.scenes.shown()
    }

    /// Returns the last frame.
    pub(crate) fn frame(&self) -> Option<&Frame> {
        self.screen.frame()
    }

    pub(crate) fn capabilities(&self) -> &Capabilities {
        self.display.capabilities()
    }

    /// Returns the camera if the user has moved it.
    pub(crate) fn moved(&self) -> Option<Camera> {
        self.eye.moved()
    }

    /// Returns the receiver, which knows the outstanding replies when the terminal is restored.
    pub(crate) fn receiver(&mut self) -> &mut Receiver {
        &mut self.receiver
    }

    fn resolution(&self) -> Resolution {
        self.display.resolution()
    }

    fn size(&self) -> Size {
        self.display.size()
    }

    fn keymap(&self) -> &Keymap {
        &self.options.keymap
    }
}
