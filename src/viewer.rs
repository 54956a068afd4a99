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
use crate::control::{Command, Keymap};
use crate::framebuffer::Resolution;
#[cfg(feature = "serve")]
use crate::grid::Grid;
use crate::grid::{Size, Window};
use crate::memory::OutOfMemory;
use crate::mesh_file::UpAxis;
use crate::progress::Progress;
use crate::protocol::{Receiver, TerminalMode};
use crate::scene::Scene;
use crate::text::Notice;
use std::collections::VecDeque;
use std::time::Duration;

mod activity;
mod requests;
mod rest;
mod axes;
mod caption;
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
mod jump;
mod scene_history;
mod pointer;
mod help;
mod help_commands;
mod layers;
mod legend;
mod light_commands;
mod lights;
mod lost;
mod theme;
mod light_marker;
mod lines;
mod camera_commands;
mod cell_commands;
mod note;
mod options;
mod orders;
#[cfg(feature = "serve")]
mod others;
mod outside;
mod pacing;
mod playback;
mod mesh_commands;
mod metadata;
mod mouse_actions;
mod progress;
mod schedule;
mod screen;
mod view_layout;
mod status;
mod steps;
#[cfg(all(unit_tests, any(test, feature = "test-hooks")))]
mod scenario;
mod tracer_lines;
mod tracked;
mod warnings;
mod wipe_commands;

pub(crate) use activity::Activity;
use caption::Caption;
use display::Display;
use error_panel::ErrorPanel;
pub use extent::MAX_PIXELS;
use eye::Eye;
pub(crate) use eye::FIRST_FRAME_MOTION;
pub(crate) use frame::{Frame, Job, Shot};
use metadata::Metadata;
use note::Note;
pub use options::Options;
use orders::RenderOrdersPanel;
#[cfg(feature = "serve")]
pub(crate) use others::{LooksAt, OtherViewer, OtherViewers, label};
use outside::OutsideView;
use pacing::Pacing;
use playback::Playback;
use pointer::PointerState;
use progress::ProgressPanel;
#[cfg(feature = "serve")]
pub(crate) use quality_control::TRACING_SHARE;
use rest::Rest;
#[cfg(all(unit_tests, feature = "test-hooks"))]
pub use scenario::run_scenario;
use scene_history::SceneHistory;
pub(crate) use schedule::{DriverState, Tracing};
use screen::Screen;
pub(crate) use steps::ViewerStep;
pub(crate) use view_layout::{INITIAL_WIPE, ViewLayout};
use warnings::Warnings;

/// A request to the driver.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// Leave the live view: the user quits.
    Leave,
    /// Stop the process group, as Ctrl-Z does.
    Suspend,
    /// Switch to the scene this many places further on in the list of scenes; negative numbers go
    /// back.
    SwitchScene(isize),
    /// Call [`Viewer::show_metadata`] with the name of the shown scene.
    ShowMetadata,
    /// Read the mesh file again, turned so that the axis after this one points up.
    TurnMesh(UpAxis),
    /// Copy this text to the user's clipboard.
    Copy(String),
    /// Write the shown picture into a file of this format.
    Export(crate::export::Format),
    /// Trace a large picture of the current view in the background, and write it into a file.
    ExportLarge,
    /// Cancel the large picture in progress.
    CancelLarge,
    /// Start or stop recording the session.
    Record,
    /// Ask the user whether to write this camera into the scene's file, if it has one.
    ProposeView(Camera),
    /// Enter or leave the tour.
    Tour,
    /// Start or stop leading the tour.
    Lead,
    /// Call [`Viewer::turn_viewer_list`] with the viewers of the server.
    ListViewers,
    /// Call [`Viewer::toggle_other_eyes`] with the viewers of the server.
    MarkViewers,
    /// Follow the viewer with this digit in the list.
    #[cfg(feature = "serve")]
    Follow(u8),
    /// Write the camera of the last [`Self::ProposeView`] into the scene's file.
    SaveView,
}

/// A user's view of scenes.
pub(crate) struct Viewer {
    options: Options,
    display: Display,
    receiver: Receiver,
    scenes: SceneHistory,
    eye: Eye,
    /// The playback of the scene: its own time, which the user can pause.
    playback: Playback,
    /// Which maps the picture shows, and how they are arranged.
    layout: ViewLayout,
    /// Whether a second camera shows the first one from outside, or vanishing points are shown.
    outside_view: OutsideView,
    pointer: PointerState,
    screen: Screen,
    /// Whether captions are shown.
    captions: bool,
    pacing: Pacing,
    rest: Rest,
    requests: VecDeque<Request>,
    /// The names of the scenes, by the index of the scene.
    names: Vec<String>,
    /// The time of the viewer's clock, which the last call passed.
    now: Duration,
    /// The time of the last key or movement of the mouse; 0 before the first.
    last_input_time: Duration,
    /// The time of the last press of a key or mouse button, or turn of the wheel; 0 before.
    last_press_time: Duration,
}

impl Viewer {
    /// Returns a viewer that shows no scene yet.
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
            playback: Playback::default(),
            layout: ViewLayout::single(options.map),
            outside_view: OutsideView::Off,
            pointer: PointerState::default(),
            rest: Rest::default(),
            requests: VecDeque::new(),
            names: Vec::new(),
            captions: options.tour.is_some(),
            now: Duration::ZERO,
            last_input_time: Duration::ZERO,
            last_press_time: Duration::ZERO,
            display,
            screen,
            options: Options { welcome: None, ..options.clone() },
        };
        if let Some(welcome) = options.welcome.take() {
            viewer.screen.open(Note::lasting(welcome));
        }
        viewer.resize(window)?;
        Ok(viewer)
    }

    /// Sets the names of the scenes, which the status line shows.
    pub(crate) fn set_names(&mut self, names: Vec<String>) {
        self.names = names;
    }

    /// Shows a note once if, after the replies to all queries, only 256 colours were found.
    ///
    /// While the welcome is shown, the note is in the row above it.
    fn note_few_colors(&mut self) {
        let colors = self.display.capabilities().cell_mode.colors;
        // The note waits for outstanding replies, because one of them may still report truecolor.
        if self.display.queries().is_open() {
            return;
        }
        let Some(text) = self.options.few_colors.take() else { return };
        if self.options.hints.suspects_truecolor(colors) {
            let note = match self.screen.close::<Note>() {
                Some(welcome) => welcome.with_line_above(text),
                None => Note::new(text),
            };
            self.screen.open(note);
        }
    }

    /// Sets the time of the viewer's clock.
    fn set_now(&mut self, now: Duration) {
        self.now = now;
    }

    /// Returns the bytes of the initial queries, to send at the start and after another program had
    /// the terminal.
    pub(crate) fn queries(&mut self, now: Duration) -> Vec<u8> {
        let queries = self.display.queries();
        let bytes = if queries.is_open() { queries.bytes().to_vec() } else { Vec::new() };
        self.receiver.sent(&bytes, now);
        bytes
    }

    /// Sets the window's size. Call this too when the terminal's contents may have been moved or
    /// changed.
    ///
    /// # Errors
    /// If there is not enough memory for the window.
    pub(crate) fn resize(&mut self, window: Window) -> Result<(), OutOfMemory> {
        let before = *self.display.capabilities();
        self.end_rest();
        self.display.set_window(window);
        // A new font may change the aspect and the height of the cells, and the height decides which half blocks the
        // cells may use.
        self.update_screen_capabilities(&before)?;
        self.display.check_memory()?;
        self.forget_screen();
        Ok(())
    }

    /// Passes the terminal's capabilities to the screen if they differ from `before`.
    fn update_screen_capabilities(&mut self, before: &Capabilities) -> Result<(), OutOfMemory> {
        if self.display.capabilities() != before {
            self.screen.set_capabilities(self.display.capabilities());
            self.display.check_memory()?;
        }
        Ok(())
    }

    /// Forgets what the terminal shows.
    ///
    /// Everything is drawn anew, and the part outside the picture is cleared.
    pub(crate) fn forget_screen(&mut self) {
        let (size, window) = (self.display.picture_size(), self.display.window_size());
        // The window is erased only if the picture leaves a part of it free: otherwise the next frame covers all of it,
        // and erasing first would flash.
        self.screen.forget_shown(self.display.capabilities().half_blocks, size != window);
        if size != window {
            let [size, window] = [size, window].map(|Size { columns, rows }| format!("{columns}x{rows}"));
            self.show_note(format!("the picture covers {size} of the window's {window} cells"));
        }
    }

    /// Opens or updates the panel with the progress of loading a scene.
    pub(crate) fn show_progress(&mut self, progress: Progress) {
        self.screen.open(ProgressPanel(progress));
    }

    /// Shows a sketch of scene number `index` until [`show`](Self::show) shows the complete scene.
    ///
    /// Does nothing if that scene is shown already, from before its file changed: a complete picture is better.
    pub(crate) fn show_sketch(&mut self, sketch: Scene, index: usize, orbits: bool) {
        if self.scenes.shown() != Some(index) {
            self.screen.close::<ErrorPanel>();
            self.open_scene(sketch, index, orbits);
        }
    }

    /// Shows scene number `index`, which has been loaded completely.
    ///
    /// The camera is where the user left it when the scene was shown last, unless the scene's own camera has changed
    /// since then; otherwise it is the scene's own camera.
    pub(crate) fn show(&mut self, scene: Scene, index: usize, orbits: bool) {
        // The progress panel disappears with the first frame of the scene: to draw the screen without the panel before
        // would delay that frame.
        self.screen.close_quietly::<ProgressPanel>();
        self.screen.close::<ErrorPanel>();
        self.open_scene(scene, index, orbits);
    }

    fn open_scene(&mut self, scene: Scene, index: usize, orbits: bool) {
        // The cameras of the view from outside belong to the previous scene.
        self.end_outside_view();
        let (before, shown) = (self.scenes.shown(), scene.clone());
        for warning in scene.darkness_warning().map(str::to_owned).into_iter().chain(scene.invisible_formula_warnings())
        {
            self.warn(warning);
        }
        self.warn_about_mesh(&scene);
        // An open panel of metadata still describes the scene before, or the mesh before it was turned.
        if self.screen.get::<Metadata>().is_some() {
            let name = self.names.get(index).cloned().unwrap_or_default();
            self.screen.open(Metadata::for_scene(&scene, name));
        }
        // The panel that compares image order and object order takes the place of the caption.
        let has_caption = self.captions && self.screen.get::<RenderOrdersPanel>().is_none();
        let caption = has_caption.then(|| self.caption(&scene, index)).flatten();
        self.screen.set(caption);
        if let Some(view) = self.scenes.show(scene, index, orbits) {
            self.playback = Playback::default();
            let left = self.eye.open(view);
            // A scene that is only reloaded (`before` equals `index`) has not been left.
            if let Some((before, left)) = before.zip(left).filter(|(before, _)| *before != index) {
                self.scenes.record_left(before, left);
            }
        }
        // A reloaded scene goes on from its current time.
        self.playback.resume_unless_paused(shown.depends_on_time() && !self.options.reduced_motion, self.now);
        self.screen.set_name(self.names.get(index).map_or("", String::as_str));
        // `eye` gets the scene even if its camera is kept, because a reloaded file may contain other views.
        self.eye.set_scene(&shown.at_time(self.playback.time().as_secs_f64()));
    }

    fn set_outside_view(&mut self, outside_view: OutsideView) {
        // The second eye may pass through walls: from behind one it still sees the lines of the first camera.
        self.eye.set_passes_surfaces(matches!(outside_view, OutsideView::MovesSecond { .. }));
        let has_changed = self.outside_view != outside_view;
        self.outside_view = outside_view;
        if has_changed {
            self.show_caption_again();
        }
    }

    /// Opens the panel with the error that ended the loading of a scene.
    pub(crate) fn show_error(&mut self, fault: Notice) {
        self.screen.close_quietly::<ProgressPanel>();
        self.screen.open(ErrorPanel(fault));
    }

    /// Shows a note in the lowest row for some seconds, or until the next key.
    pub(crate) fn show_note(&mut self, text: impl Into<String>) {
        self.screen.open(Note::new(text));
    }

    /// Replaces the shown warnings by those about the next scene, before that scene is shown.
    pub(crate) fn set_warnings(&mut self, warnings: Vec<String>) {
        self.screen.close::<Warnings>();
        for warning in warnings {
            self.warn(warning);
        }
    }

    /// Shows a warning above the lowest row until the next key.
    fn warn(&mut self, warning: String) {
        let mut warnings = self.screen.close::<Warnings>().unwrap_or_default();
        warnings.add(warning);
        self.screen.open(warnings);
    }

    /// Returns the first page of the caption of the view from outside, or else of `scene`, scene
    /// number `index`, if it has one.
    fn caption(&self, scene: &Scene, index: usize) -> Option<Caption> {
        let place = self.options.tour.map(|count| (index + 1, count));
        let text = self.outside_view.caption().map_or_else(|| scene.caption().cloned(), |text| Some(text.into()));
        Some(Caption::new(text?, place, self.outside_view.keys()))
    }

    /// Shows the caption of the scene, unless captions are hidden.
    fn show_caption_again(&mut self) {
        let shown = self.scene_at_current_time().zip(self.scenes.shown()).filter(|_| self.captions);
        let caption = shown.and_then(|(scene, index)| self.caption(&scene, index));
        self.screen.set(caption);
    }

    /// Shows the caption of the scene or its next page. After the last page, hides the caption.
    fn cycle_caption(&mut self) {
        let shown = self.screen.close::<Caption>();
        let was_shown = shown.is_some();
        let next = if let Some(caption) = shown {
            caption.next(theme::area(self.picture_size()))
        } else {
            let shown = self.scene_at_current_time().zip(self.scenes.shown());
            let caption = shown.and_then(|(scene, index)| self.caption(&scene, index));
            if caption.is_none() {
                self.show_note("this scene has no caption: no comment at the start of its file");
            }
            caption
        };
        // After the last page, captions stay hidden in the next scenes too.
        let is_hidden = was_shown && next.is_none();
        self.captions = next.is_some();
        self.screen.set(next);
        if is_hidden {
            self.show_note(format!("captions are hidden{}", self.hint(Command::Caption, "shows them")));
        }
    }

    /// Returns the next request to the driver, if any.
    pub(crate) fn next_request(&mut self) -> Option<Request> {
        self.requests.pop_front()
    }

    /// Returns the terminal modes to switch on in addition to those that every terminal supports.
    pub(crate) fn optional_modes(&self) -> impl Iterator<Item = TerminalMode> {
        self.display.optional_modes()
    }

    /// Returns whether a frame has been drawn since the start.
    pub(crate) fn has_shown(&self) -> bool {
        self.screen.has_shown()
    }

    /// Returns the index of the shown scene in the list of scenes.
    pub(crate) fn shown_scene(&self) -> Option<usize> {
        self.scenes.shown()
    }

    /// Returns the last frame that was accepted by [`take_frame`](Self::take_frame).
    pub(crate) fn frame(&self) -> Option<&Frame> {
        self.screen.frame()
    }

    /// Records the time of a key or of a movement of the mouse, and whether it presses something.
    fn record_input_time(&mut self, now: Duration, is_press: bool) {
        self.last_input_time = now;
        if is_press {
            self.last_press_time = now;
        }
    }

    /// Returns the time of the last key or movement of the mouse; 0 before the first.
    #[cfg(feature = "serve")]
    pub(crate) fn last_input_time(&self) -> Duration {
        self.last_input_time
    }

    /// Returns the time of the last press of a key or mouse button, or turn of the wheel.
    ///
    /// 0 before the first.
    #[cfg(feature = "serve")]
    pub(crate) fn last_press_time(&self) -> Duration {
        self.last_press_time
    }

    /// Returns the scene, the camera and the map that the picture shows; `None` without a scene.
    #[cfg(feature = "serve")]
    pub(crate) fn guide_view(&self) -> Option<(Scene, Camera, crate::maps::Map)> {
        // The last frame may still show the scene before.
        let frame = self.screen.frame().filter(|frame| frame.shot.scene == self.scenes.count());
        let scene = frame.map(|frame| frame.scene.clone()).or_else(|| self.scene_at_current_time())?;
        let camera = frame.map(|frame| frame.shot.camera).or_else(|| self.first_camera())?;
        Some((scene, camera, self.layout.maps().next().unwrap_or_default()))
    }

    /// Swaps the grid that frames are drawn in for another one.
    ///
    /// Viewers of a server whose turns are on one thread share a grid.
    #[cfg(feature = "serve")]
    pub(crate) fn swap_grid(&mut self, grid: &mut Grid) {
        self.screen.swap_grid(grid);
    }

    /// Moves the eye to a camera at once.
    #[cfg(feature = "serve")]
    pub(crate) fn set_camera(&mut self, camera: Camera, now: Duration) {
        self.set_now(now);
        self.eye.change(now, |_, _| camera);
    }

    /// Draws the view anew on a screen that has shown something else.
    #[cfg(feature = "serve")]
    pub(crate) fn take_screen_back(&mut self) {
        // The last frame shows a view of before.
        self.screen.forget_frame();
        self.pacing.forget_begun();
        self.forget_screen();
    }

    /// Returns the size of the terminal's window in cells.
    pub(crate) fn window_size(&self) -> Size {
        self.display.window_size()
    }

    /// Returns the capabilities with which the screen is drawn.
    pub(crate) fn capabilities(&self) -> &Capabilities {
        self.screen.capabilities()
    }

    /// Returns the camera if the user has moved it.
    pub(crate) fn moved_camera(&self) -> Option<Camera> {
        self.first_camera().filter(|&camera| !self.eye.is_home(camera))
    }

    /// Returns the receiver of the terminal's bytes, which knows which replies are outstanding.
    pub(crate) fn receiver(&mut self) -> &mut Receiver {
        &mut self.receiver
    }

    fn resolution(&self) -> Resolution {
        self.display.resolution()
    }

    /// Returns the size in pixels of the shown picture.
    ///
    /// It differs from that of the next one while the glyphs change.
    fn shown_resolution(&self) -> Resolution {
        self.screen.frame().map_or_else(|| self.resolution(), Frame::resolution)
    }

    pub(crate) fn picture_size(&self) -> Size {
        self.display.picture_size()
    }

    fn keymap(&self) -> &Keymap {
        &self.options.keymap
    }
}
