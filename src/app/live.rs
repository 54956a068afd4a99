//! The event loop that drives one viewer on the terminal.
//!
//! It sleeps until a key, a signal, a finished frame or a timeout wakes it, reports the event to the viewer, and
//! carries out the viewer's decisions. Frames are traced and scenes are read on other threads, so that keys and signals
//! are handled meanwhile; only frames that take less time than waking a thread are traced by the loop itself.

use super::large_picture::{LargePicture, LargePictureJob};
use super::loading::LoadEvent;
use super::picture_export;
use super::renderer::Renderer;
use super::save_view::Proposal;
use super::scenes::{SceneEvent, Scenes};
use super::session_recording::SessionRecording;
use super::source::SceneName;
use super::{Ending, Error, Options};
use crate::camera::Camera;
use crate::export::Format;
use crate::terminal::{self, Signals, StopTarget, Terminal};
use crate::text::Notice;
use crate::viewer::{Activity, DriverState, FIRST_FRAME_MOTION, Request, Tracing, Viewer, ViewerStep};
use std::io;
use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// The loop's clock.
///
/// It starts at [`FIRST_FRAME_MOTION`] and not at 0, because the viewer subtracts that time from the time of a key
/// press: the motion counts as begun one frame earlier.
struct Clock {
    start: Instant,
}

impl Clock {
    /// Returns the time since the start of the loop, plus [`FIRST_FRAME_MOTION`].
    fn now(&self) -> Duration {
        FIRST_FRAME_MOTION + self.start.elapsed()
    }
}

/// A viewer on a terminal, which is restored when this is dropped.
pub(super) struct Live {
    viewer: Viewer,
    terminal: Terminal,
    clock: Clock,
    /// The buffer for the encoded bytes of a frame.
    // Reused for all frames, because a new buffer would have to grow. With the buffer and the grid reused, the time
    // from a key to its frame at 200x60 fell by 9 %.
    bytes: Vec<u8>,
    /// The names of the scenes.
    names: Vec<SceneName>,
    /// The folder for exported pictures, if the user may export.
    exports: Option<PathBuf>,
    /// The number of tracing threads; `None` for one per core.
    threads: Option<usize>,
    large_picture: Option<LargePicture>,
    recording: Option<SessionRecording>,
    /// The view or scene that is written to a file if the user confirms the last question.
    proposed: Option<Proposal>,
}

impl Drop for Live {
    fn drop(&mut self) {
        self.restore();
    }
}

impl Live {
    /// Returns a loop around a new viewer, which has shown nothing yet.
    ///
    /// # Errors
    /// If the terminal is gone, or there is not enough memory for its window.
    pub(super) fn new(terminal: Terminal, options: Options, names: Vec<SceneName>) -> io::Result<Self> {
        let (exports, threads) = (options.exports.clone(), options.threads);
        let mut viewer = Viewer::new(options, terminal.window()?)?;
        viewer.set_names(names.iter().map(SceneName::short).collect());
        let clock = Clock { start: Instant::now() };
        Ok(Self {
            viewer,
            terminal,
            clock,
            bytes: Vec::new(),
            names,
            exports,
            threads,
            large_picture: None,
            recording: None,
            proposed: None,
        })
    }

    /// Returns the camera if the user has moved it.
    pub(super) fn moved_camera(&self) -> Option<Camera> {
        self.viewer.moved_camera()
    }

    /// Restores the terminal and returns whether it accepted all bytes.
    pub(super) fn restore(&mut self) -> bool {
        self.terminal.restore(self.viewer.receiver(), self.clock.now())
    }

    /// Queries the terminal and runs until the user leaves.
    pub(super) fn drive<E: Into<Notice> + Send + 'static>(
        &mut self,
        renderer: &mut Renderer,
        scenes: &mut Scenes<E>,
        signals: &mut Signals,
    ) -> Result<Ending, Error<E>> {
        self.terminal.send(&self.viewer.queries(self.clock.now()))?;
        loop {
            while let Some(event) = scenes.next_event()? {
                self.handle_event(event).map_err(Error::Scene)?;
            }
            let until = self.carry_out_steps(renderer)?;
            // Watching starts after the first picture, because its start takes a quarter of a millisecond or more. An
            // earlier change is noticed nevertheless, because each file is compared with its state when it was read.
            if self.viewer.has_shown()
                && !self.terminal.is_sending()
                && let Some(problem) = scenes.watch_current_scene()?
            {
                self.viewer.show_note(format!("changes to the scene's files will not be noticed: {problem}"));
                continue;
            }
            renderer.inject_worker_panic();
            if let Some(large_picture) = &self.large_picture {
                // Only frames of a new view pause the large picture. At rest, one refinement follows another, and a
                // large picture that paused for them would wait until the last one.
                large_picture.set_paused(renderer.tracing() == Some(Tracing::NewView));
            }
            self.wait(until, renderer, signals)?;
            let leaves = self.carry_out_requests(scenes, signals)?.is_break();
            self.follow_large_picture();
            if let Some(signal) = signals.deadly() {
                return Ok(Ending::Signal(signal));
            }
            if leaves {
                return Ok(Ending::Left);
            }
            if signals.take_resized() {
                terminal::report_phase("resize")?;
                self.viewer.resize(self.terminal.window()?)?;
            }
            // Repeated in each turn of the loop, because the wanted modes depend on the terminal's replies; a mode that
            // is on already costs nothing.
            for mode in self.viewer.optional_modes() {
                self.terminal.switch_on(mode)?;
            }
            while let Some(frame) = renderer.take_finished() {
                self.viewer.take_frame(frame);
            }
        }
    }

    /// Carries out what the viewer decides to do now. Returns the time of its next wake-up.
    fn carry_out_steps(&mut self, renderer: &mut Renderer) -> io::Result<Option<Duration>> {
        loop {
            let busy = DriverState { sending: self.terminal.is_sending(), tracing: renderer.tracing() };
            match self.viewer.next_step(busy, self.clock.now()) {
                ViewerStep::Wait(until) => return Ok(until),
                ViewerStep::CancelRefinement => renderer.cancel_refinements(),
                ViewerStep::Draw => {
                    self.bytes.clear();
                    let now = self.clock.now();
                    self.viewer.draw(now, &mut self.bytes);
                    // The recording does not get the queries that `add_frame_queries` adds, because a player's terminal
                    // would answer them.
                    self.record_frame(now);
                    self.viewer.add_frame_queries(&mut self.bytes, self.clock.now());
                    self.terminal.send(&self.bytes)?;
                }
                ViewerStep::Trace(probe, job) => {
                    self.terminal.send(&probe)?;
                    if job.refines {
                        terminal::report_phase("refinement")?;
                    }
                    if let Some(frame) = renderer.start_frame(job) {
                        self.viewer.take_frame(frame);
                    }
                }
            }
        }
    }

    /// Sleeps until an event or the time `until`, then passes the terminal's bytes to the viewer.
    ///
    /// If the process is to be stopped, the bytes are read later, when the terminal is restored.
    fn wait(&mut self, until: Option<Duration>, renderer: &Renderer, signals: &mut Signals) -> io::Result<()> {
        let mut timeout = until.map(|until| until.saturating_sub(self.clock.now()));
        if timeout.is_none() && renderer.tracing().is_none() && !self.terminal.is_sending() {
            timeout = terminal::try_report_idle()?;
        }
        let woken = self.terminal.wait(signals.wake_pipe(), timeout)?;
        if woken.wake {
            signals.drain();
        }
        if signals.take_stop() {
            return self.suspend(Some(StopTarget::Process), signals);
        }
        if signals.take_continued() {
            // The process was stopped by SIGSTOP, which cannot be caught, and another program may have left the
            // terminal in any state.
            return self.suspend(None, signals);
        }
        // On Linux a terminal buffers at most 4096 bytes of input, so that one read returns all of it.
        let mut buffer = [0; 4096];
        let bytes = if woken.keys { self.terminal.read(&mut buffer)? } else { &[] };
        // A readable terminal without bytes has hung up, and would stay readable: the loop would spin.
        if woken.keys && bytes.is_empty() {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
        }
        Ok(self.viewer.receive(bytes, self.clock.now())?)
    }

    /// Carries out the viewer's requests; breaks if the user leaves.
    fn carry_out_requests<E: Send + 'static>(
        &mut self,
        scenes: &mut Scenes<E>,
        signals: &mut Signals,
    ) -> io::Result<ControlFlow<()>> {
        while let Some(request) = self.viewer.next_request() {
            match request {
                Request::Leave => return Ok(ControlFlow::Break(())),
                Request::Suspend => self.suspend(Some(StopTarget::Group), signals)?,
                Request::SwitchScene(steps) => {
                    let (of, count) = (scenes.switch(steps)?, self.names.len());
                    let name = self.names.get(of).filter(|_| count > 1);
                    let note = name.map(|name| format!("{} ({} of {count})", name.short(), of + 1));
                    self.viewer.show_note(note.unwrap_or_else(|| "only one scene".to_owned()));
                }
                Request::ShowMetadata => {
                    let name = self.shown_name().map_or_else(String::new, SceneName::short);
                    self.viewer.show_metadata(name);
                }
                Request::TurnMesh(shown) => scenes.turn_next_axis_up(shown)?,
                Request::Copy(text) => self.terminal.copy(&text)?,
                Request::Export(format) => {
                    let note = self.export(format).map_or_else(
                        |error| format!("could not write the picture: {error}"),
                        |name| format!("written: {name}"),
                    );
                    self.viewer.show_note(note);
                }
                Request::ExportLarge => {
                    if let Err(error) = self.start_large_picture(signals) {
                        self.viewer.show_note(format!("could not write the picture: {error}"));
                    }
                }
                Request::CancelLarge => self.large_picture.iter().for_each(LargePicture::cancel),
                Request::Record => self.toggle_recording(),
                // Only a keymap of the user's binds keys to these.
                Request::Tour | Request::Lead => self.viewer.show_note("only a server gives a tour"),
                Request::ListViewers | Request::MarkViewers => self.viewer.show_note("only a server has other viewers"),
                #[cfg(feature = "serve")]
                Request::Follow(_) => {}
                Request::ProposeView(camera) => self.propose(camera),
                Request::SaveView => {
                    if let Some(proposal) = self.proposed.take() {
                        self.viewer.show_note(proposal.carry_out());
                    }
                }
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Returns the name of the shown scene.
    fn shown_name(&self) -> Option<&SceneName> {
        self.names.get(self.viewer.shown_scene()?)
    }

    /// Writes the shown picture into a new file and returns its name.
    fn export(&self, format: Format) -> io::Result<String> {
        let nothing = || io::Error::other("there is no picture, or no folder for it");
        let (frame, folder) = self.viewer.frame().zip(self.exports.as_deref()).ok_or_else(nothing)?;
        let stem = picture_export::file_stem(self.shown_name().map_or("scene", |scene| &scene.name));
        let contents = picture_export::contents(
            format,
            &stem,
            &frame.picture,
            frame.geometry.as_deref(),
            self.viewer.capabilities(),
        )?;
        picture_export::write_new(folder, &stem, format, &contents)
    }

    /// Returns the folder for exported pictures and recordings, and the stem of their file names.
    fn export_place(&self) -> io::Result<(PathBuf, String)> {
        let folder = self.exports.clone().ok_or_else(|| io::Error::other("there is no folder for it"))?;
        Ok((folder, picture_export::file_stem(self.shown_name().map_or("scene", |scene| &scene.name))))
    }

    /// Starts to trace a large picture of the current view in the background, for a PNG file.
    fn start_large_picture(&mut self, signals: &Signals) -> io::Result<()> {
        let Some((job, wipe)) = self.viewer.large_picture_job() else { return Ok(()) };
        let ((folder, stem), waker) = (self.export_place()?, signals.waker()?);
        let picture_job = LargePictureJob { job, wipe, folder, stem, threads: self.threads };
        self.large_picture = Some(terminal::without_signals(|| LargePicture::start(picture_job, waker))?);
        self.show_activity();
        Ok(())
    }

    /// Shows the progress of the large picture, if there is one, and its outcome at the end.
    fn follow_large_picture(&mut self) {
        let Some(large_picture) = &self.large_picture else { return };
        if let Some(ended) = large_picture.ended() {
            self.large_picture = None;
            self.viewer.show_note(match ended {
                Ok(Some(name)) => format!("written: {name}"),
                Ok(None) => "large picture cancelled".to_owned(),
                Err(error) => format!("could not write the picture: {error}"),
            });
        }
        self.show_activity();
    }

    /// Starts a recording of the session, or ends it.
    fn toggle_recording(&mut self) {
        let now = self.clock.now();
        let note = if let Some(mut recording) = self.recording.take() {
            match recording.finish(now) {
                Ok(name) => format!("written: {name}"),
                Err(error) => format!("could not write the recording: {error}"),
            }
        } else {
            let size = self.viewer.window_size();
            let started = self.export_place().and_then(|(folder, stem)| {
                SessionRecording::start(&folder, &stem, size, now).map(|recording| self.recording = Some(recording))
            });
            match started {
                Ok(()) => "recording the session; same key ends".to_owned(),
                Err(error) => format!("could not start a recording: {error}"),
            }
        };
        // The recording starts with a complete frame, because a player has no earlier one to which changes could apply.
        if self.recording.is_some() {
            self.viewer.forget_screen();
        }
        self.viewer.show_note(note);
        self.show_activity();
    }

    /// Adds the bytes of a frame to the recording, if there is one.
    fn record_frame(&mut self, now: Duration) {
        let Some(recording) = &mut self.recording else { return };
        if let Err(error) = recording.add(&self.bytes, self.viewer.window_size(), now) {
            self.recording = None;
            self.viewer.show_note(format!("the recording ended and was not kept: {error}"));
            self.show_activity();
        }
    }

    /// Shows whether the session is recorded, and the progress of the large picture.
    fn show_activity(&mut self) {
        let picture = self.large_picture.as_ref().map(LargePicture::percent);
        self.viewer.show_activity(Activity { records: self.recording.is_some(), picture });
    }

    /// Asks the user whether to write `camera` into the scene's file or, for a mesh, into a new
    /// scene file beside it.
    ///
    /// If the scene has no file, a note says so.
    fn propose(&mut self, camera: Camera) {
        let file = self.shown_name().and_then(|scene| scene.file.as_deref());
        self.proposed = file.and_then(|file| {
            let name = file.file_name()?.to_string_lossy();
            match self.viewer.scene_around_mesh(&name, &camera) {
                Some(text) => Some(Proposal::scene_beside(file, text)),
                None => Proposal::view(file, camera),
            }
        });
        match &self.proposed {
            Some(proposal) if proposal.is_new() => self.viewer.ask_to_write_scene(proposal.file_name()),
            Some(proposal) => self.viewer.ask_to_save_view(proposal.file_name()),
            None => self.viewer.show_note("this scene has no scene file to save views to"),
        }
    }

    /// Passes an event of loading a scene to the viewer.
    ///
    /// An error of loading is returned if no scene is shown yet.
    fn handle_event<E: Into<Notice>>(&mut self, SceneEvent { index, event, is_slow }: SceneEvent<E>) -> Result<(), E> {
        let orbits = self.names.get(index).is_some_and(|scene| scene.orbited);
        match event {
            LoadEvent::Progress(progress) if is_slow => self.viewer.show_progress(progress),
            LoadEvent::Progress(_) | LoadEvent::Dependencies(_) => {}
            LoadEvent::Warnings(warnings) => self.viewer.set_warnings(warnings),
            LoadEvent::Sketch(sketch) => self.viewer.show_sketch(sketch, index, orbits),
            LoadEvent::Scene(scene) => self.viewer.show(scene, index, orbits),
            LoadEvent::Error(fault) if self.viewer.shown_scene().is_none() => return Err(fault),
            LoadEvent::Error(fault) => self.viewer.show_error(fault.into()),
            LoadEvent::Panic(panic) => resume_unwind(panic),
        }
        Ok(())
    }

    /// Restores the terminal, stops the process or its group, takes the terminal again and redraws
    /// everything.
    ///
    /// With `None` the process is not stopped, because it has been stopped and continued already; input that was read
    /// meanwhile is kept. After a signal that ends the program the terminal stays restored.
    fn suspend(&mut self, stop: Option<StopTarget>, signals: &mut Signals) -> io::Result<()> {
        let now = self.clock.now();
        self.viewer.lose_terminal(now);
        let mut typed = Vec::new();
        if let Some(target) = stop {
            self.terminal.restore(self.viewer.receiver(), now);
            signals.stop(target);
        } else {
            typed = self.terminal.restore_keeping_input(self.viewer.receiver(), now);
        }
        if signals.deadly().is_some() {
            return Ok(());
        }
        // `take_again` waits for the foreground, that is, until the shell has handed over the terminal.
        self.terminal.take_again(signals)?;
        if let Some(recording) = &mut self.recording {
            // The recording leaves out the time during which the process was stopped.
            recording.skip(now, self.clock.now());
        }
        // The queries are sent again, because replies to the earlier ones may be lost.
        self.terminal.send(&self.viewer.queries(self.clock.now()))?;
        self.viewer.resize(self.terminal.window()?)?;
        Ok(self.viewer.receive_type_ahead(typed, self.clock.now())?)
    }
}
