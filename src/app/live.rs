//! The loop: input, render, present, rest.
//!
//! It sleeps until a key, a signal or a finished frame wakes it. A frame is rendered only when something changed, by a
//! thread of its own unless it takes next to no time, so that keys and signals are heard while it is traced; the newest
//! picture wins: what changes in the meantime is in the next frame, and nothing is queued. When nothing changes any more,
//! the picture is refined to its end, which the next change of the view cuts short.
//!
//! A scene that takes long to come is waited for here too: its progress is shown, then a sketch of it.

use super::effort::Effort;
use super::extent;
use super::eye::{Eye, FRAME};
use super::renderer::{Frame, Job, Renderer};
use super::scenes::Scenes;
use super::screen::Screen;
use super::shown::Shown;
use super::source::Named;
use super::{Ending, Error, Options};
use crate::camera::Camera;
use crate::capabilities::{Capabilities, Findings};
use crate::cell;
use crate::control::Pointer;
use crate::framebuffer::Resolution;
use crate::grid::Size;
use crate::input::{Input, Parser};
use crate::pace::Link;
use crate::protocol::Questions;
use crate::render::Sampling;
use crate::terminal::{self, Signals, Stopped, Terminal, Window};
use std::time::{Duration, Instant};
use std::{fmt, io};

mod events;
mod files;
mod lighting;
mod explaining;
mod moving;
mod pointing;
mod views;
mod looked_at;

use events::Next;
use lighting::Lights;
use looked_at::LookedAt;
use pointing::Grasped;

/// For how long the first picture is held back to be refined before it is shown. Up to there it is shown once, whole; a
/// longer wait is felt. With 16.7 ms, three spheres at 200x60 cells were shown after 15 ms, of which 9 went into
/// refinement.
const FIRST_REFINEMENT: Duration = Duration::from_millis(4);

/// The loop's time: a frame's worth at the start, so that whatever is pressed then may have begun a frame ago.
struct Clock {
    start: Instant,
}

impl Clock {
    fn now(&self) -> Duration {
        FRAME + self.start.elapsed()
    }
}

/// The state of the live view.
pub(super) struct Live {
    options: Options,
    eye: Eye,
    shown: Shown,
    window: Window,
    capabilities: Capabilities,
    questions: Questions,
    parser: Parser,
    pointer: Pointer,
    /// What the mouse has taken hold of.
    grasped: Grasped,
    /// When the last bytes came from the terminal, or were waited for in vain.
    read: Duration,
    screen: Screen,
    link: Link,
    effort: Effort,
    clock: Clock,
    /// What the picture is of.
    looked_at: LookedAt,
    lights: Lights,
    /// What is to be given to the user's clipboard.
    to_copy: Option<String>,
    /// How many scenes further on the user wants to be.
    scenes_on: isize,
    /// Whether the picture on the screen is of another camera or size than the wanted one.
    stale: bool,
    /// The last time a frame of a new view was begun,
    begun: Option<Duration>,
    /// and whether more was moving then.
    begun_in_motion: bool,
}

impl Live {
    /// Shows nothing yet.
    ///
    /// # Errors
    /// If there is not enough memory for that window.
    pub(super) fn new(options: Options, window: Window, scenes: Vec<Named>) -> io::Result<Self> {
        let questions = Questions::needed(&options.hints);
        let link = Link::new(options.max_rate, options.max_frames, questions.is_open());
        let capabilities = Findings::new(&options.hints, window.cell, questions.answers()).capabilities();
        let mut live = Self {
            eye: Eye::new(options.pace, options.reduced_motion),
            shown: Shown::one(options.view),
            window,
            capabilities,
            questions,
            parser: Parser::new(),
            pointer: Pointer::default(),
            grasped: Grasped::View,
            read: Duration::ZERO,
            screen: Screen::new(&capabilities, options.order, options.quality, options.bindings.clone()),
            link,
            effort: Effort::new(options.sampling),
            options,
            clock: Clock { start: Instant::now() },
            looked_at: LookedAt::new(scenes),
            lights: Lights::default(),
            to_copy: None,
            scenes_on: 0,
            stale: true,
            begun: None,
            begun_in_motion: false,
        };
        if let Some(welcome) = live.options.welcome.take() {
            live.screen.say(welcome);
        }
        live.resize(window)?;
        Ok(live)
    }

    /// Where the user has moved the camera, if he has.
    pub(super) fn moved(&self) -> Option<Camera> {
        self.eye.moved()
    }

    /// Asks the terminal what it is, and goes on until the user leaves.
    pub(super) fn run<E: fmt::Display + Send + 'static>(
        &mut self,
        terminal: &mut Terminal,
        renderer: &mut Renderer,
        scenes: &mut Scenes<E>,
        signals: &mut Signals,
    ) -> Result<Ending, Error<E>> {
        terminal.send(self.questions.bytes())?;
        loop {
            while let Some(heard) = scenes.next()? {
                self.take_news(heard, renderer).map_err(Error::Scene)?;
            }
            self.stale |= self.eye.go_on(self.now());
            if self.stale {
                renderer.give_up_refining();
            }
            self.present(terminal, renderer)?;
            // Nothing is rendered that cannot be sent.
            let idle = !renderer.is_busy() && !terminal.is_sending();
            if idle && self.now() >= self.next_frame() {
                self.begin(terminal, renderer)?;
            }
            // That takes a while: the first picture does not wait for it.
            if self.screen.has_shown()
                && !terminal.is_sending()
                && let Some(problem) = scenes.watch()?
            {
                self.screen.say(format!("changes of the scene's files will not be seen: {problem}"));
            }
            self.panic_if_asked(renderer);
            let mut timeout = self.timeout(terminal, renderer);
            if timeout.is_none() && !renderer.is_working() && !terminal.is_sending() {
                timeout = terminal::rest()?;
            }
            let woken = terminal.wait(signals.wake_pipe(), timeout)?;
            if woken.wake {
                signals.drain();
            }
            let mut next = self.next(woken.keys, terminal, signals)?;
            while let Next::Suspend(stop) = next {
                next = self.suspend(terminal, signals, stop)?;
            }
            if let Some(signal) = signals.deadly() {
                return Ok(Ending::Signal(signal));
            }
            if next == Next::Leave {
                return Ok(Ending::Left);
            }
            if let Some(text) = self.to_copy.take() {
                terminal.copy(&text)?;
            }
            match std::mem::take(&mut self.scenes_on) {
                0 => {}
                steps => scenes.go(steps)?,
            }
            if signals.take_resized() {
                terminal::reach("resize")?;
                self.resize(terminal.window()?)?;
            }
            if self.knows_keyboard() {
                terminal.push_keyboard()?;
            }
            if self.mouse_pixels().is_some() {
                terminal.count_pixels()?;
            }
            while let Some(frame) = renderer.finished() {
                self.take_frame(frame);
            }
        }
    }

    fn now(&self) -> Duration {
        self.clock.now()
    }

    fn resolution(&self) -> Resolution {
        cell::resolution(self.capabilities.cell_mode, self.size(), self.capabilities.cell_aspect)
    }

    /// How much of the window is the picture's, from its upper left corner on.
    fn size(&self) -> Size {
        extent::covered(self.window.size, self.capabilities.cell_mode)
    }

    fn resize(&mut self, window: Window) -> io::Result<()> {
        self.window = window;
        self.learn()?;
        extent::check(self.size(), self.capabilities.cell_mode)?;
        // The terminal has moved what it shows to wherever it thought right.
        self.redraw();
        self.effort.forget_last();
        self.stale = true;
        Ok(())
    }

    /// The terminal may show anything: all is drawn anew, and what the picture does not cover is emptied.
    fn redraw(&mut self) {
        let (size, window) = (self.size(), self.window.size);
        self.screen.redraw(self.capabilities.halves_meet, size != window);
        if size != window {
            let [size, window] = [size, window].map(|Size { columns, rows }| format!("{columns}x{rows}"));
            self.screen.say(format!("the picture covers {size} of the window's {window} cells"));
        }
    }

    /// Goes by what is known of the terminal now.
    fn learn(&mut self) -> io::Result<()> {
        let (before, size) = (self.resolution(), self.size());
        let findings = Findings::new(&self.options.hints, self.window.cell, self.questions.answers());
        let capabilities = findings.capabilities();
        if capabilities != self.capabilities {
            self.capabilities = capabilities;
            self.screen.set_capabilities(&capabilities);
            self.stale |= self.resolution() != before;
            extent::check(self.size(), self.capabilities.cell_mode)?;
        }
        if self.size() != size {
            self.redraw();
        }
        Ok(())
    }

    /// The earliest time for the next frame, and for the next look at what moves.
    fn next_frame(&self) -> Duration {
        if self.perfects_first() {
            return Duration::ZERO;
        }
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.link.frame_time());
        let next = if self.stale { next(self.begun) } else { next(self.eye.moved_until()).max(next(self.begun)) };
        next.max(self.link.free_at(self.now()))
    }

    /// The earliest time at which the screen has bytes to send, if nothing else happens. What would make a picture better
    /// waits while one of a newer view is on its way.
    fn next_bytes(&self, renderer: &Renderer) -> Option<Duration> {
        if self.perfects_first() {
            return None;
        }
        let lasts = !self.stale && !renderer.is_busy_with_new_view();
        self.screen.due(self.size(), lasts).map(|due| due.max(self.link.free_at(self.now())))
    }

    /// Whether the first picture is not shown yet because its end is near: to show it twice would take longer.
    fn perfects_first(&self) -> bool {
        let is_near = !self.screen.has_shown() && !self.stale && self.effort.ends_within(FIRST_REFINEMENT);
        is_near && self.next_step().is_some()
    }

    /// Begins a frame of the new view if there is one, else the next step of the last one, if there is one.
    fn begin(&mut self, terminal: &mut Terminal, renderer: &mut Renderer) -> io::Result<()> {
        let Some(camera) = self.eye.camera() else { return Ok(()) };
        if let Some(scene) = self.lights.take_changed() {
            renderer.light(scene);
        }
        let job = if self.stale {
            terminal.send(&self.link.probe(self.now()))?;
            self.stale = false;
            self.begun = Some(self.now());
            // On a slow link the next frame begins when an answer comes: all the time that it takes is the link's.
            let sampling = self.effort.of_new_view(self.begun_in_motion && !self.link.is_slow());
            self.begun_in_motion = self.is_in_motion();
            self.job(camera, sampling)
        } else if let Some(sampling) = self.next_step() {
            terminal::reach("refinement")?;
            Job { refines: true, ..self.job(camera, sampling) }
        } else {
            return Ok(());
        };
        if let Some(frame) = renderer.begin(job) {
            self.take_frame(frame);
        }
        Ok(())
    }

    fn take_frame(&mut self, frame: Frame) {
        if !frame.refines {
            self.effort.took(frame.sampling, frame.trace, self.link.frame_time());
        }
        self.screen.take_frame(frame, self.is_in_motion().then(|| self.now()));
    }

    /// Whether the next frame is likely to be of another view, too.
    fn is_in_motion(&self) -> bool {
        self.eye.is_moving() || self.pointer.holds()
    }

    fn job(&self, camera: Camera, sampling: Sampling) -> Job {
        let (shown, sampling) = (self.shown, self.shown.sampling(sampling));
        Job { camera, resolution: self.resolution(), sampling, shown, refines: false, test_panic: false }
    }

    /// The next step of the frame that is on the screen.
    fn next_step(&self) -> Option<Sampling> {
        // Refining a sketch would take the time that the scene needs.
        let frame = self.screen.frame().filter(|_| !self.screen.awaits_scene())?;
        let next = self.shown.sampling(self.effort.of_next_step(frame.sampling)?);
        (next != frame.sampling).then_some(next)
    }

    /// How long there is nothing to do if nobody wakes us: for ever when nothing moves and the picture is done.
    fn timeout(&self, terminal: &Terminal, renderer: &Renderer) -> Option<Duration> {
        let moves = self.stale || self.eye.is_moving();
        let lacks = moves && !renderer.is_busy_with_new_view() || !renderer.is_busy() && self.next_step().is_some();
        let frame = lacks.then(|| self.next_frame());
        let sent = [frame, self.next_bytes(renderer)].into_iter().filter(|_| !terminal.is_sending());
        let next = sent.chain([self.escape_due(terminal)]).flatten().min()?;
        Some(next.saturating_sub(self.now()))
    }

    /// Gives the terminal back, stops if that is wanted, and takes the terminal again: at its size of then, and with all
    /// drawn anew. With a signal to end, it stays given back. What was typed is not thrown away where no shell was asked
    /// for: returns what it asks for.
    fn suspend(&mut self, terminal: &mut Terminal, signals: &mut Signals, stop: Option<Stopped>) -> io::Result<Next> {
        let now = self.now();
        self.stale |= self.eye.stand_still(now) | self.eye.set_hears_releases(false, now);
        self.pointer.let_go();
        self.link.forget();
        let mut typed = Vec::new();
        if let Some(who) = stop {
            terminal.give_back();
            self.parser = Parser::new();
            signals.stop(who);
        } else {
            self.parser.feed(&terminal.hand_over(), &mut typed);
            self.parser.set_keys_are_sequences(false);
            // Of replies it is the last that was waited for: what was asked is asked again.
            typed.retain(|input| !matches!(input, Input::Reply(_)));
        }
        if signals.deadly().is_some() {
            return Ok(Next::Stay);
        }
        terminal.take_again(signals)?;
        // What was on its way then is lost.
        if self.questions.is_open() {
            terminal.send(self.questions.bytes())?;
        }
        self.resize(terminal.window()?)?;
        self.take_inputs(&typed)
    }

    fn panic_if_asked(&self, renderer: &mut Renderer) {
        if let Some(camera) = self.eye.camera()
            && terminal::take_worker_panic()
        {
            renderer.begin(Job { test_panic: true, ..self.job(camera, Sampling::Coarse) });
        }
    }

    /// Brings the screen up to date: nothing is written if it is, or while the terminal is behind.
    fn present(&mut self, terminal: &mut Terminal, renderer: &Renderer) -> io::Result<()> {
        let now = self.now();
        if terminal.is_sending() || self.next_bytes(renderer).is_none_or(|due| now < due) {
            return Ok(());
        }
        let size = self.size();
        let limit = self.link.limit(Screen::usual_bytes(size), now);
        let bytes = self.screen.bytes(size, now, limit);
        if bytes.is_empty() {
            return Ok(());
        }
        // Cells and bytes took their time: it is not the link's.
        let now = self.clock.now();
        // Also at rest: a frame's own round trip is longer than the link's, which its rate is judged by.
        terminal.send(&self.link.probe(now))?;
        self.link.send(bytes, now);
        terminal.send(bytes)
    }
}
