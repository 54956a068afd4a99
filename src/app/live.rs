//! The loop that drives one viewer on the terminal.
//!
//! It sleeps until a key, a signal, a finished frame or a timeout wakes it, reports the event to the viewer, and
//! carries out the viewer's decisions. Frames are traced and scenes are read on other threads, so that keys and signals
//! are handled meanwhile; only frames that take less time than waking a thread are traced here.

use super::loading::LoadEvent;
use super::picture_export;
use super::renderer::Renderer;
use super::save_view::ProposedView;
use super::scenes::{SceneEvent, Scenes};
use super::source::SceneName;
use super::{Ending, Error, Options};
use crate::camera::Camera;
use crate::export::Format;
use crate::terminal::{self, Signals, StopTarget, Terminal};
use crate::text::Notice;
use crate::viewer::{DriverState, FIRST_FRAME_MOTION, Request, Step, Viewer};
use std::io;
use std::panic::resume_unwind;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// The loop's clock.
///
/// It starts at the time of one frame, so that a key pressed at once may have been held for a frame.
struct Clock {
    start: Instant,
}

impl Clock {
    fn now(&self) -> Duration {
        FIRST_FRAME_MOTION + self.start.elapsed()
    }
}

/// A viewer on a terminal, which is restored when this is dropped.
pub(super) struct Live {
    viewer: Viewer,
    terminal: Terminal,
    clock: Clock,
    /// The bytes of the last frame.
    // Reused, because a new buffer has to grow: with it and the grid kept, the time from a key to its frame at 200x60
    // fell from 1.08 to 0.98 of the time that it took before the viewer was a module of its own.
    bytes: Vec<u8>,
    /// The names of the scenes.
    names: Vec<SceneName>,
    exports: Option<PathBuf>,
    /// The view that the user was last asked to confirm.
    proposed: Option<ProposedView>,
}

impl Drop for Live {
    fn drop(&mut self) {
        self.restore();
    }
}

impl Live {
    /// Returns a loop that has shown nothing yet.
    ///
    /// # Errors
    /// If the terminal is gone, or there is not enough memory for its window.
    pub(super) fn new(terminal: Terminal, options: Options, names: Vec<SceneName>) -> io::Result<Self> {
        let exports = options.exports.clone();
        let viewer = Viewer::new(options, terminal.window()?)?;
        let clock = Clock { start: Instant::now() };
        Ok(Self { viewer, terminal, clock, bytes: Vec::new(), names, exports, proposed: None })
    }

    /// Returns the camera if the user has moved it.
    pub(super) fn moved(&self) -> Option<Camera> {
        self.viewer.moved()
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
            while let Some(heard) = scenes.next()? {
                self.handle_event(heard).map_err(Error::Scene)?;
            }
            let until = self.act(renderer)?;
            // After the first picture, because starting to watch takes a quarter of a millisecond and more. A change in
            // between is noticed: each file is compared with its state when it was read.
            if self.viewer.has_shown()
                && !self.terminal.is_sending()
                && let Some(problem) = scenes.watch()?
            {
                self.viewer.show_note(format!("changes to the scene's files will not be noticed: {problem}"));
                continue;
            }
            renderer.panic_if_asked();
            self.wait(until, renderer, signals)?;
            let leaves = self.carry_out_requests(scenes, signals)?;
            if let Some(signal) = signals.deadly() {
                return Ok(Ending::Signal(signal));
            }
            if leaves {
                return Ok(Ending::Left);
            }
            if signals.take_resized() {
                terminal::reach("resize")?;
                self.viewer.resize(self.terminal.window()?)?;
            }
            // Repeated in each turn: the modes depend on replies, and one that is on costs nothing.
            for mode in self.viewer.modes() {
                self.terminal.switch_on(mode)?;
            }
            while let Some(frame) = renderer.take_finished() {
                self.viewer.take_frame(frame);
            }
        }
    }

    /// Carries out what the viewer decides to do now. Returns the time of its next wake-up.
    fn act(&mut self, renderer: &mut Renderer) -> io::Result<Option<Duration>> {
        loop {
            let busy = DriverState { sending: self.terminal.is_sending(), tracing: renderer.tracing() };
            match self.viewer.step(busy, self.clock.now()) {
                Step::Wait(until) => return Ok(until),
                Step::GiveUp => renderer.cancel_refinements(),
                Step::Draw => {
                    self.bytes.clear();
                    self.viewer.draw(self.clock.now(), &mut self.bytes);
                    self.viewer.end_frame(&mut self.bytes, self.clock.now());
                    self.terminal.send(&self.bytes)?;
                }
                Step::Trace(probe, job) => {
                    self.terminal.send(&probe)?;
                    if job.refines {
                        terminal::reach("refinement")?;
                    }
                    if let Some(frame) = renderer.begin(job) {
                        self.viewer.take_frame(frame);
                    }
                }
            }
        }
    }

    /// Sleeps until an event or the time `until`, then passes the terminal's bytes to the viewer.
    ///
    /// If the process is to be stopped, the bytes are left to be read with the last replies when the terminal is
    /// restored.
    fn wait(&mut self, until: Option<Duration>, renderer: &Renderer, signals: &mut Signals) -> io::Result<()> {
        let mut timeout = until.map(|until| until.saturating_sub(self.clock.now()));
        if timeout.is_none() && renderer.tracing().is_none() && !self.terminal.is_sending() {
            timeout = terminal::rest()?;
        }
        let woken = self.terminal.wait(signals.wake_pipe(), timeout)?;
        if woken.wake {
            signals.drain();
        }
        if signals.take_stop() {
            return self.suspend(Some(StopTarget::Process), signals);
        }
        if signals.take_continued() {
            // Continued after SIGSTOP, which cannot be caught: another program may have left the terminal in any state.
            return self.suspend(None, signals);
        }
        let mut buffer = [0; 4096];
        let bytes = if woken.keys { self.terminal.read(&mut buffer)? } else { &[] };
        // Readable without bytes is the end of the file: the loop would spin on it.
        if woken.keys && bytes.is_empty() {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
        }
        Ok(self.viewer.receive(bytes, self.clock.now())?)
    }

    /// Carries out the viewer's requests. Returns whether the user leaves.
    fn carry_out_requests<E: Send + 'static>(
        &mut self,
        scenes: &mut Scenes<E>,
        signals: &mut Signals,
    ) -> io::Result<bool> {
        while let Some(request) = self.viewer.next_request() {
            match request {
                Request::Leave => return Ok(true),
                Request::Suspend => self.suspend(Some(StopTarget::Group), signals)?,
                Request::SwitchScene(steps) => scenes.switch(steps)?,
                Request::Copy(text) => self.terminal.copy(&text)?,
                Request::Export(format) => {
                    let note = self.export(format).map_or_else(
                        |error| format!("could not write the picture: {error}"),
                        |name| format!("written: {name}"),
                    );
                    self.viewer.show_note(note);
                }
                Request::ProposeView(camera) => self.propose(camera),
                Request::SaveView => {
                    let note = match self.proposed.take().map_or(Ok(()), |view| view.write()) {
                        Ok(()) => "view saved to the scene file".to_owned(),
                        Err(error) => format!("scene file left unchanged: {error}"),
                    };
                    self.viewer.show_note(note);
                }
            }
        }
        Ok(false)
    }

    /// Returns the name of the shown scene.
    fn shown(&self) -> Option<&SceneName> {
        self.names.get(self.viewer.shown_scene()?)
    }

    /// Writes the shown picture into a new file and returns its name.
    fn export(&self, format: Format) -> io::Result<String> {
        let nothing = || io::Error::other("there is no picture, or no folder for it");
        let (frame, folder) = self.viewer.frame().zip(self.exports.as_deref()).ok_or_else(nothing)?;
        let stem = picture_export::stem(self.shown().map_or("scene", |scene| &scene.name));
        let contents = picture_export::contents(format, &frame.picture, self.viewer.capabilities())?;
        picture_export::write_new(folder, &stem, format, &contents)
    }

    /// Asks the user whether to write `camera` into the scene's file, if it has one.
    fn propose(&mut self, camera: Camera) {
        let file = self.shown().and_then(|scene| scene.file.as_deref());
        self.proposed = file.and_then(|file| ProposedView::new(file, camera));
        match &self.proposed {
            Some(view) => self.viewer.ask_to_save_view(view.file_name()),
            None => self.viewer.show_note("this scene has no scene file to save views to"),
        }
    }

    /// Shows an event of a load.
    ///
    /// An error of loading is returned if there is no scene to show it over.
    fn handle_event<E: Into<Notice>>(&mut self, SceneEvent { of, event, is_slow }: SceneEvent<E>) -> Result<(), E> {
        let orbits = self.names.get(of).is_some_and(|scene| scene.orbited);
        match event {
            LoadEvent::Progress(progress) if is_slow => self.viewer.show_progress(progress),
            LoadEvent::Progress(_) | LoadEvent::Dependencies(_) => {}
            LoadEvent::Sketch(sketch) => self.viewer.show_sketch(sketch, of, orbits),
            LoadEvent::Scene(scene) => self.viewer.show(scene, of, orbits),
            LoadEvent::Error(fault) if self.viewer.shown_scene().is_none() => return Err(fault),
            LoadEvent::Error(fault) => self.viewer.show_error(fault.into()),
            LoadEvent::Panic(panic) => resume_unwind(panic),
        }
        Ok(())
    }

    /// Restores the terminal, stops if `stop` is given, takes the terminal again, and draws
    /// everything anew at its current size.
    ///
    /// After a signal that ends the program the terminal stays restored. Without `stop` no shell has had the terminal,
    /// and the input read meanwhile is kept.
    fn suspend(&mut self, stop: Option<StopTarget>, signals: &mut Signals) -> io::Result<()> {
        let now = self.clock.now();
        self.viewer.lose_terminal(now);
        let mut typed = Vec::new();
        if let Some(who) = stop {
            self.terminal.restore(self.viewer.receiver(), now);
            signals.stop(who);
        } else {
            typed = self.terminal.restore_keeping_input(self.viewer.receiver(), now);
        }
        if signals.deadly().is_some() {
            return Ok(());
        }
        // It waits for the foreground, and so continues only when the shell has handed the terminal over.
        self.terminal.take_again(signals)?;
        // Replies to earlier queries are lost.
        self.terminal.send(&self.viewer.queries(self.clock.now()))?;
        self.viewer.resize(self.terminal.window()?)?;
        Ok(self.viewer.receive_typed(typed, self.clock.now())?)
    }
}
