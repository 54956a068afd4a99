//! The loop of the live view: input, render, present, rest.
//!
//! It sleeps until a key, a signal or a finished frame wakes it. A frame is rendered only when something changed, by a
//! thread of its own unless it takes next to no time, so that keys and signals are heard while it is traced; the newest
//! picture wins: what changes in the meantime is in the next frame, and nothing is queued. When nothing changes any more,
//! the picture is refined to its end, which the next change of the view cuts short.
//!
//! A scene that takes long to come is waited for here too: its progress is shown, then a sketch of it.

use crate::camera::Camera;
use crate::capabilities::{Capabilities, Findings, Hints};
use crate::cell;
use crate::control::{self, Command, Motion};
use crate::encode::{Order, Quality};
use crate::framebuffer::Resolution;
use crate::input::{Input, Parser, Reply};
use crate::progress::Watcher;
use crate::render::Sampling;
use crate::scene::{Draft, Scene};
use crate::terminal::{self, Questions, Signals, Stopped, Terminal, Window};
use crossterm::event::{Event, KeyEvent, KeyEventKind};
use std::convert::Infallible;
use std::panic::resume_unwind;
use std::time::{Duration, Instant};
use std::{fmt, io};

mod effort;
mod link;
mod loading;
mod panels;
mod renderer;
mod screen;

use effort::Effort;
use link::Link;
use loading::{Loading, News};
use renderer::{Frame, Job, Renderer};
use screen::Screen;

/// How the user wants the live view: made by [`Options::new`], then changed.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// What is wanted and known of the terminal before it is asked.
    pub hints: Hints,
    /// In which order changed cells are sent; `None`: row by row, which takes the least time, and by colour, which takes
    /// the fewest bytes, while the link is slow.
    pub order: Option<Order>,
    /// How near a moving picture is to the wanted one; `None`: exact, and equal while the link is slow.
    pub quality: Option<Quality>,
    /// The most bytes a second that are sent in the mean; `None`: as many as the link takes.
    pub max_rate: Option<u32>,
    /// The most frames a second; `None`: 60. A number above zero.
    pub max_frames: Option<f32>,
    /// How finely pictures are traced; `None`: in motion as finely as the time allows, and at rest to the end
    /// ([`Sampling::BEST`]).
    pub sampling: Option<Sampling>,
    /// How many threads trace; `None`: as many as there are cores.
    pub threads: Option<usize>,
}

impl Options {
    /// For a terminal of which that is known, on a link that does not compress; the rest as terminal and machine say.
    pub fn new(hints: Hints) -> Self {
        Self { hints, order: None, quality: None, max_rate: None, max_frames: None, sampling: None, threads: None }
    }
}

/// How the live view ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Why.
    pub ending: Ending,
    /// Where the user had moved the camera, if he had.
    pub moved: Option<Camera>,
    /// Whether the terminal still takes what is written. One that has stopped reading would stop whoever says more.
    pub heard: bool,
}

/// Why the live view ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The user left.
    Left,
    /// A signal asked for it.
    Signal(i32),
}

/// Shows the scene until the user leaves. The terminal is as it was when this returns, and also when it panics.
///
/// # Errors
/// If there is no terminal, or it goes away.
///
/// # Panics
/// With the payload of a thread that panicked while tracing.
pub fn run(scene: Scene, options: Options, signals: &mut Signals) -> io::Result<Outcome> {
    view(Loading::<Infallible>::done(scene), options, signals).map_err(|error| match error {
        Error::Terminal(error) => error,
        Error::Scene(never) => match never {},
    })
}

/// Shows the scene that `read` gives until the user leaves. What takes longer than a moment shows how far it is, then a
/// sketch to look around in, and can be left at any time. The terminal is as it was when this returns, and also when it
/// panics; a scene that is wrong at once never touches it.
///
/// `read` gives nothing only when its watcher has gone: when the user has left. It is not waited for then.
///
/// # Errors
/// If there is no terminal, or it goes away; or what is wrong with the scene.
///
/// # Panics
/// With the payload of a thread that panicked while tracing, or while reading or building the scene.
pub fn open<E: Send + 'static>(
    read: impl FnOnce(&Watcher<'_>) -> Result<Option<Draft>, E> + Send + 'static,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    let waker = signals.waker()?;
    let loading = terminal::without_signals(|| Loading::start(read, options.threads, waker))?;
    view(loading, options, signals)
}

/// Why there was nothing to see, or nothing more.
#[derive(Debug)]
pub enum Error<E> {
    /// There is no terminal, or it has gone away.
    Terminal(io::Error),
    /// What is wrong with the scene.
    Scene(E),
}

impl<E> From<io::Error> for Error<E> {
    fn from(error: io::Error) -> Self {
        Self::Terminal(error)
    }
}

impl<E: fmt::Display> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Terminal(error) => write!(f, "terminal: {error}"),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for Error<E> {}

fn view<E: Send + 'static>(
    mut loading: Loading<E>,
    options: Options,
    signals: &mut Signals,
) -> Result<Outcome, Error<E>> {
    // The terminal is declared last, and so is given back first: nothing that comes after can keep it.
    let waker = signals.waker()?;
    let mut renderer = terminal::without_signals(|| Renderer::start(options.threads, waker))?;
    loading.wait(MOMENT).map_err(Error::Scene)?;
    if let Some(signal) = signals.deadly() {
        return Ok(Outcome { ending: Ending::Signal(signal), moved: None, heard: true });
    }
    let mut terminal = Terminal::take()?;
    let mut live = Live::new(options, terminal.window()?);
    let asked = terminal.send(live.questions.bytes()).map_err(Error::from);
    let ended = asked.and_then(|()| live.run(&mut terminal, &mut renderer, &mut loading, signals));
    let ending = ended.or_else(|error| match error {
        // When the terminal vanishes, the system says so by a signal too.
        Error::Terminal(error) => signals.deadly().map(Ending::Signal).ok_or(Error::Terminal(error)),
        fault @ Error::Scene(_) => Err(fault),
    })?;
    let heard = terminal.give_back();
    Ok(Outcome { ending, moved: live.view.and_then(|view| view.moved()), heard })
}

/// A scene that is there so soon is shown without a word about it.
const MOMENT: Duration = Duration::from_millis(100);

/// The first frame after a key already shows so much movement.
const FRAME: Duration = Duration::from_micros(16_667);
/// How long the rest of a key's escape sequence may take before a lone Escape is taken for the key.
const ESCAPE_WAIT: Duration = Duration::from_millis(50);
/// The same while answers are on their way: the first byte of one may come alone.
const ANSWER_WAIT: Duration = Duration::from_secs(1);

/// The flags of the kitty keyboard protocol without which keys are taken as a plain terminal tells of them: no ambiguity
/// (1), releases (2), every key as a sequence (8).
const KEYBOARD: u16 = 1 | 2 | 8;

/// The state of the live view.
struct Live {
    options: Options,
    /// `None` as long as there is nothing to see.
    view: Option<View>,
    window: Window,
    capabilities: Capabilities,
    questions: Questions,
    parser: Parser,
    /// When the last bytes came from the terminal, or were waited for in vain.
    read: Duration,
    motion: Motion,
    screen: Screen,
    link: Link,
    effort: Effort,
    start: Instant,
    /// Up to when the motion has been carried out; `None` at rest.
    moved_until: Option<Duration>,
    /// Whether the picture on the screen is of another camera or size than the wanted one.
    stale: bool,
    /// The last time a frame of a new view was begun,
    begun: Option<Duration>,
    /// and whether more was moving then.
    begun_in_motion: bool,
}

/// How the scene is looked at.
#[derive(Clone, Copy)]
struct View {
    home: Camera,
    camera: Camera,
    speed: f32,
}

impl View {
    fn new(camera: Camera) -> Self {
        Self { home: camera, camera, speed: control::speed(&camera) }
    }

    /// Where the camera is, if it is not where it was.
    fn moved(&self) -> Option<Camera> {
        (self.camera != self.home).then_some(self.camera)
    }
}

impl Live {
    fn new(options: Options, window: Window) -> Self {
        let questions = Questions::needed(&options.hints);
        let link = Link::new(options.max_rate, options.max_frames, questions.is_open());
        let capabilities = Findings::new(&options.hints, window.cell, questions.answers()).capabilities();
        let mut live = Self {
            view: None,
            window,
            capabilities,
            questions,
            parser: Parser::new(),
            read: Duration::ZERO,
            motion: Motion::default(),
            screen: Screen::new(&capabilities, options.order, options.quality),
            link,
            effort: Effort::new(options.sampling),
            options,
            start: Instant::now(),
            moved_until: None,
            stale: true,
            begun: None,
            begun_in_motion: false,
        };
        live.resize(window);
        live
    }

    fn run<E: Send + 'static>(
        &mut self,
        terminal: &mut Terminal,
        renderer: &mut Renderer,
        loading: &mut Loading<E>,
        signals: &mut Signals,
    ) -> Result<Ending, Error<E>> {
        loop {
            while let Some(news) = loading.next() {
                self.take_news(news, renderer).map_err(Error::Scene)?;
            }
            self.move_camera();
            if self.stale {
                renderer.give_up_refining();
            }
            self.present(terminal, renderer)?;
            // Nothing is rendered that cannot be sent.
            let idle = !renderer.is_busy() && !terminal.is_sending();
            if idle && self.now() >= self.next_frame() {
                self.begin(terminal, renderer)?;
            }
            self.panic_if_asked(renderer);
            let timeout = self.timeout(terminal, renderer);
            let woken = terminal.wait(signals.wake_pipe(), timeout)?;
            if woken.wake {
                signals.drain();
            }
            let next = self.next(woken.keys, terminal, signals)?;
            if let Next::Suspend(stop) = next {
                self.suspend(terminal, signals, stop)?;
            }
            if let Some(signal) = signals.deadly() {
                return Ok(Ending::Signal(signal));
            }
            if next == Next::Leave {
                return Ok(Ending::Left);
            }
            if signals.take_resized() {
                terminal::reach("resize")?;
                self.resize(terminal.window()?);
            }
            if self.knows_keyboard() {
                terminal.push_keyboard()?;
            }
            while let Some(frame) = renderer.finished() {
                self.take_frame(frame);
            }
        }
    }

    /// The time: a frame's worth at the start, so that whatever is pressed then may have begun a frame ago.
    fn now(&self) -> Duration {
        FRAME + self.start.elapsed()
    }

    fn resolution(&self) -> Resolution {
        cell::resolution(self.capabilities.cell_mode, self.window.size, self.capabilities.cell_aspect)
    }

    fn resize(&mut self, window: Window) {
        self.window = window;
        self.learn();
        // The terminal has moved what it shows to wherever it thought right.
        self.screen.redraw(self.capabilities.halves_meet);
        self.effort.forget_last();
        self.stale = true;
    }

    /// Goes by what is known of the terminal now.
    fn learn(&mut self) {
        let before = self.resolution();
        let findings = Findings::new(&self.options.hints, self.window.cell, self.questions.answers());
        let capabilities = findings.capabilities();
        if capabilities != self.capabilities {
            self.capabilities = capabilities;
            self.screen.set_capabilities(&capabilities);
            self.stale |= self.resolution() != before;
        }
    }

    /// Whether the terminal knows the kitty keyboard protocol.
    fn knows_keyboard(&self) -> bool {
        !self.questions.is_open() && self.questions.answers().kitty_keyboard == Some(true)
    }

    /// The terminal says which flags of the kitty keyboard protocol are on.
    fn take_keyboard(&mut self, flags: u16) {
        let hears_releases = self.knows_keyboard() && flags & KEYBOARD == KEYBOARD;
        if self.motion.hears_releases() && !hears_releases {
            self.stand_still();
        }
        self.motion.set_hears_releases(hears_releases);
        self.parser.set_keys_are_sequences(hears_releases);
    }

    /// Answers to the questions change things all at once, when the last is there.
    fn take_reply(&mut self, reply: &Reply) -> Next {
        if let &Reply::KeyboardFlags(flags) = reply {
            self.take_keyboard(flags);
        }
        match reply {
            // Terminals answer in order: first the questions of the start, then what ends each frame.
            Reply::DeviceAttributes(_) if !self.questions.is_open() => self.link.answer(self.now()),
            reply if self.questions.take(reply) => self.learn(),
            _ => {}
        }
        Next::Stay
    }

    /// What is there of the scene is shown; all of it from where its sketch was looked at.
    fn take_news<E>(&mut self, news: News<E>, renderer: &mut Renderer) -> Result<(), E> {
        match news {
            News::Progress(progress) => self.screen.set_progress(progress),
            News::Sketch(scene) => self.show(scene, renderer),
            News::Scene(scene) => {
                self.screen.end_progress();
                self.show(scene, renderer);
            }
            News::Fault(fault) => return Err(fault),
            News::Panic(panic) => resume_unwind(panic),
        }
        Ok(())
    }

    fn show(&mut self, scene: Scene, renderer: &mut Renderer) {
        self.view.get_or_insert(View::new(scene.camera));
        renderer.show(scene);
        self.effort.forget_last();
        self.stale = true;
    }

    /// Carries the motion out up to now.
    fn move_camera(&mut self) {
        let Some(since) = self.moved_until else { return };
        let now = self.now();
        if let Some(view) = &mut self.view {
            let camera = self.motion.step(&view.camera, view.speed, since, now);
            self.stale |= camera != view.camera;
            view.camera = camera;
        }
        self.moved_until = self.motion.is_moving(now).then_some(now);
    }

    /// The earliest time for the next frame, and for the next look at what moves.
    fn next_frame(&self) -> Duration {
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.link.frame_time());
        let next = if self.stale { next(self.begun) } else { next(self.moved_until).max(next(self.begun)) };
        next.max(self.link.free_at(self.now()))
    }

    /// The earliest time at which the screen has bytes to send, if nothing else happens. What would make a picture better
    /// waits while one of a newer view is on its way.
    fn next_bytes(&self, renderer: &Renderer) -> Option<Duration> {
        let lasts = !self.stale && !renderer.is_busy_with_new_view();
        self.screen.due(self.window.size, lasts).map(|due| due.max(self.link.free_at(self.now())))
    }

    /// Begins a frame of the new view if there is one, else the next step of the last one, if there is one.
    fn begin(&mut self, terminal: &mut Terminal, renderer: &mut Renderer) -> io::Result<()> {
        let Some(view) = self.view else { return Ok(()) };
        let job = if self.stale {
            terminal.send(self.link.probe(self.now()))?;
            self.stale = false;
            self.begun = Some(self.now());
            let sampling = self.effort.of_new_view(self.begun_in_motion);
            self.begun_in_motion = self.moved_until.is_some();
            self.job(view, sampling)
        } else if let Some(sampling) = self.next_step() {
            terminal::reach("refinement")?;
            Job { refines: true, ..self.job(view, sampling) }
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
        self.screen.take_frame(frame, self.moved_until.is_some().then(|| self.now()));
    }

    fn job(&self, view: View, sampling: Sampling) -> Job {
        Job { camera: view.camera, resolution: self.resolution(), sampling, refines: false, test_panic: false }
    }

    /// The next step of the frame that is on the screen.
    fn next_step(&self) -> Option<Sampling> {
        // Refining a sketch would take the time that the scene needs.
        let frame = self.screen.frame().filter(|_| !self.screen.awaits_scene())?;
        self.effort.of_next_step(frame.sampling)
    }

    /// How long there is nothing to do if nobody wakes us: for ever when nothing moves and the picture is done.
    fn timeout(&self, terminal: &Terminal, renderer: &Renderer) -> Option<Duration> {
        let moves = self.stale || self.moved_until.is_some();
        let lacks = moves && !renderer.is_busy_with_new_view() || !renderer.is_busy() && self.next_step().is_some();
        let frame = lacks.then(|| self.next_frame());
        let sent = [frame, self.next_bytes(renderer)].into_iter().filter(|_| !terminal.is_sending());
        let next = sent.chain([self.escape_due(terminal)]).flatten().min()?;
        Some(next.saturating_sub(self.now()))
    }

    /// When half a sequence is taken for all that there is of it, if there is one.
    fn escape_due(&self, terminal: &Terminal) -> Option<Duration> {
        let is_no_key = terminal.awaits_answers() || self.motion.hears_releases();
        let wait = if is_no_key { ANSWER_WAIT } else { ESCAPE_WAIT };
        self.parser.is_waiting().then_some(self.read + wait)
    }

    /// What signals want, or keys if there are any. At a stop these are left to be read with the terminal's last answers.
    fn next(&mut self, keys: bool, terminal: &mut Terminal, signals: &Signals) -> io::Result<Next> {
        if signals.take_stop() {
            return Ok(Next::Suspend(Some(Stopped::Process)));
        }
        if signals.take_continued() {
            // Stopped unasked, and whoever had the terminal since then left it as he liked.
            return Ok(Next::Suspend(None));
        }
        if keys {
            return self.read_keys(terminal);
        }
        let mut inputs = Vec::new();
        if self.escape_due(terminal).is_some_and(|due| due <= self.now()) {
            self.read = self.now();
            self.parser.give_up_waiting(&mut inputs);
        }
        Ok(self.take_inputs(&inputs))
    }

    fn read_keys(&mut self, terminal: &mut Terminal) -> io::Result<Next> {
        let mut buffer = [0; 4096];
        let bytes = terminal.read(&mut buffer)?;
        if bytes.is_empty() {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
        }
        let mut inputs = Vec::new();
        self.parser.feed(bytes, &mut inputs);
        self.read = self.now();
        Ok(self.take_inputs(&inputs))
    }

    fn take_inputs(&mut self, inputs: &[Input]) -> Next {
        for input in inputs {
            let next = match input {
                Input::Event(Event::Key(key)) => self.take_key(key),
                // Nobody says when the keys held now are let go.
                Input::Event(Event::FocusLost) => self.stand_still(),
                Input::Reply(reply) => self.take_reply(reply),
                Input::Event(_) => Next::Stay,
            };
            if next != Next::Stay {
                return next;
            }
        }
        Next::Stay
    }

    fn take_key(&mut self, key: &KeyEvent) -> Next {
        self.take_motion(key);
        if key.kind != KeyEventKind::Press {
            return Next::Stay;
        }
        match control::command(key).map(|(command, _)| command) {
            Some(Command::Quit) => return Next::Leave,
            Some(Command::Suspend) => return Next::Suspend(Some(Stopped::Group)),
            Some(Command::Reset) => self.reset(),
            Some(Command::Status) => self.screen.toggle_status(),
            Some(Command::Help) => self.screen.toggle_help(),
            Some(Command::Close) => self.screen.close_help(),
            Some(Command::Redraw) => self.screen.redraw(self.capabilities.halves_meet),
            Some(Command::Move(_) | Command::Look(_)) | None => {}
        }
        Next::Stay
    }

    /// What was going on is carried out before the key changes it.
    fn take_motion(&mut self, key: &KeyEvent) {
        self.move_camera();
        let now = self.now();
        self.motion.key(key, now);
        // From rest, the first frame already shows a frame's worth of movement.
        self.moved_until = self.motion.is_moving(now).then(|| self.moved_until.unwrap_or(now.saturating_sub(FRAME)));
    }

    fn stand_still(&mut self) -> Next {
        self.move_camera();
        self.motion.stop();
        self.moved_until = None;
        Next::Stay
    }

    /// Gives the terminal back, stops if that is wanted, and takes the terminal again: at its size of then, and with all
    /// drawn anew. With a signal to end, it stays given back.
    fn suspend(&mut self, terminal: &mut Terminal, signals: &mut Signals, stop: Option<Stopped>) -> io::Result<()> {
        self.stand_still();
        self.motion.set_hears_releases(false);
        self.parser = Parser::new();
        self.link.forget();
        terminal.give_back();
        if let Some(who) = stop {
            signals.stop(who);
        }
        if signals.deadly().is_some() {
            return Ok(());
        }
        terminal.take_again()?;
        // What was on its way then is lost.
        if self.questions.is_open() {
            terminal.send(self.questions.bytes())?;
        }
        self.resize(terminal.window()?);
        Ok(())
    }

    fn panic_if_asked(&self, renderer: &mut Renderer) {
        if let Some(view) = self.view
            && terminal::take_worker_panic()
        {
            renderer.begin(Job { test_panic: true, ..self.job(view, Sampling::Coarse) });
        }
    }

    fn reset(&mut self) {
        if let Some(view) = &mut self.view {
            self.stale |= view.camera != view.home;
            view.camera = view.home;
        }
    }

    /// Brings the screen up to date: nothing is written if it is, or while the terminal is behind.
    fn present(&mut self, terminal: &mut Terminal, renderer: &Renderer) -> io::Result<()> {
        let now = self.now();
        if terminal.is_sending() || self.next_bytes(renderer).is_none_or(|due| now < due) {
            return Ok(());
        }
        let size = self.window.size;
        let slow = self.link.slow(Screen::usual_bytes(size));
        let bytes = self.screen.bytes(size, now, slow);
        if bytes.is_empty() {
            return Ok(());
        }
        // Also at rest: a frame's own round trip is longer than the link's, which its rate is judged by.
        terminal.send(self.link.probe(now))?;
        self.link.send(bytes, now);
        terminal.send(bytes)
    }
}

/// What the loop does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    Stay,
    /// With the terminal given back; by a stop, or after one that was not ours.
    Suspend(Option<Stopped>),
    Leave,
}
