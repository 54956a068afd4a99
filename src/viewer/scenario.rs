//! A test driver that feeds a viewer an arbitrary sequence of events and checks rules after each of
//! them.
//!
//! Used by property tests and by a fuzz target.

use super::{DriverState, Frame, INITIAL_WIPE, Job, Options, Tracing, Viewer, ViewerStep};
use crate::capabilities::{CellShape, Hints};
use crate::color::Srgb8;
use crate::encode::Quality;
use crate::framebuffer::Resolution;
use crate::grid::{Size, Window};
use crate::protocol::{FENCE, TerminalModes};
use crate::render::Cost;
use crate::scene::Scene;
use crate::text::Notice;
use crate::tone::Picture;
use std::sync::LazyLock;
use std::time::Duration;

/// Greatest number of actions that a viewer may ask for at the same time before it waits.
///
/// They are: cancel a refinement, draw, begin a frame, handle the timeout of a lone Escape, and draw its result.
const MAX_ACTIONS: usize = 5;

/// Greatest number of wake-ups between the last event and rest.
///
/// A lossy picture becomes exact in a few frames, and the motion of a tap, at 60 frames a second, ends within a second.
const MAX_WAKE_UPS: usize = 400;

/// Limits on the bytes of a frame: per cell, and in addition per frame.
///
/// A cell may need all attributes, both colours and a cursor move.
const MAX_FRAME_BYTES: [usize; 2] = [120, 4096];

/// Drives a viewer by the events that the bytes of `scenario` encode, and checks these rules:
///
/// - no frame is drawn or begun while bytes are being sent, and none is begun while another is traced;
/// - after every event the viewer soon waits, for a time that has not passed;
/// - the size of a frame is bounded;
/// - soon after the last event, the viewer waits without a wake-up time;
/// - all terminal modes that were switched on are switched off at the end.
///
/// The last byte chooses the viewer's options.
///
/// # Panics
/// If a rule is broken.
pub fn run_scenario(scenario: &[u8]) {
    // The options come last, so that a fuzzer can change them without shifting the events.
    let (&wishes, events) = scenario.split_last().unwrap_or((&0, &[]));
    let mut driver = Driver::new(wishes);
    let mut bytes = events.iter().copied();
    while let Some(event) = bytes.next() {
        driver.apply_event(event, &mut bytes);
        driver.carry_out_steps();
    }
    driver.come_to_rest();
    driver.check_modes_end();
}

static SCENES: LazyLock<[Scene; 2]> = LazyLock::new(|| {
    let read = |text| Scene::from_ron("story", text).expect("the scene is fine");
    [read(include_str!("../../scenes/three_spheres.ron")), read("(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")]
});

struct Driver {
    viewer: Viewer,
    now: Duration,
    modes: TerminalModes,
    job: Option<Job>,
    is_sending: bool,
    /// The bytes sent since the terminal last replied.
    sent: Vec<u8>,
    frames: u8,
}

impl Driver {
    fn new(wishes: u8) -> Self {
        let wants = |bit: u8| wishes & 1 << bit != 0;
        let term = if wants(0) { "linux" } else { "xterm-256color" };
        let variable = |name: &str| (name == "TERM").then(|| term.to_owned());
        let mut options = Options::new(Hints::gather(&variable, &|_| None));
        options.quality = wants(1).then_some(Quality::Equal);
        options.max_rate = wants(2).then_some(40_000);
        options.reduced_motion = wants(3);
        let viewer = Viewer::new(options, window(Size::new(20, 8))).expect("this takes little memory");
        let mut driver = Self {
            viewer,
            now: Duration::from_millis(20),
            modes: TerminalModes::default(),
            job: None,
            is_sending: false,
            sent: Vec::new(),
            frames: 0,
        };
        let queries = driver.viewer.queries(driver.now);
        driver.send(&queries);
        driver.is_sending = false;
        driver
    }

    fn apply_event(&mut self, event: u8, more: &mut impl Iterator<Item = u8>) {
        let mut next = || more.next().unwrap_or(0);
        match event % 9 {
            0 => {
                let bytes: Vec<u8> = (0..next() % 24).map(|_| next()).collect();
                self.receive(&bytes);
            }
            // The window has 1x1 to 70x30 cells, so that panels sometimes have room and sometimes not.
            1 => {
                let size = Size::new(u16::from(next() % 70) + 1, u16::from(next() % 30) + 1);
                self.viewer.resize(window(size)).expect("this takes little memory");
            }
            // Up to a quarter of a second passes, which is shorter than some timeouts and longer than others.
            2 => self.now += Duration::from_millis(u64::from(next())),
            3 => self.finish_job(next()),
            4 => self.is_sending = false,
            5 => self.reply_to_queries(),
            6 => {
                let of = usize::from(next() % 3);
                let scene = SCENES[of % 2].clone();
                if next() % 2 == 0 {
                    self.viewer.show(scene, of, of == 1);
                } else {
                    self.viewer.show_sketch(scene, of, false);
                }
            }
            7 => {
                self.viewer.lose_terminal(self.now);
                self.viewer.receiver().forget();
                let queries = self.viewer.queries(self.now);
                self.send(&queries);
                self.viewer.receive_type_ahead(Vec::new(), self.now).expect("nothing is learnt");
            }
            _ => match next() % 3 {
                0 => self.viewer.show_error(Notice {
                    message: "x.ron:1:1: a fault".to_owned(),
                    excerpt: Some(["  1 | (", "    | ^"].map(str::to_owned)),
                    has_more: true,
                }),
                1 => self.viewer.ask_to_save_view("x.ron".to_owned()),
                _ => self.viewer.show_note("a note"),
            },
        }
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.viewer.receive(bytes, self.now).expect("this takes little memory");
        // Requests are dropped: how a driver carries them out is tested with `app`.
        while self.viewer.next_request().is_some() {}
        for mode in self.viewer.optional_modes() {
            self.modes.switch_on(mode, &mut self.sent);
        }
    }

    /// Passes the viewer the terminal's replies to all outstanding queries.
    fn reply_to_queries(&mut self) {
        let mut replies = Vec::new();
        for (at, _) in self.sent.iter().enumerate().filter(|(_, byte)| **byte == 0x1b) {
            let rest = &self.sent[at..];
            if rest.starts_with(FENCE) {
                replies.extend_from_slice(b"\x1b[?62c");
            } else if let Some(number) = rest.strip_prefix(b"\x1b[?").and_then(queried_mode) {
                replies.extend([b"\x1b[?", number, b";0$y"].concat());
            } else if rest.starts_with(b"\x1b[?u") {
                replies.extend_from_slice(b"\x1b[?15u");
            }
        }
        self.sent.clear();
        self.receive(&replies);
    }

    fn finish_job(&mut self, milliseconds: u8) {
        let Some(Job { scene, shot, sampling, refines }) = self.job.take() else { return };
        self.frames = self.frames.wrapping_add(1);
        let parts: Vec<_> =
            shot.layout.map_sizes(shot.resolution).into_iter().map(|(_, part)| self.flat_picture(part)).collect();
        let picture = shot.layout.combined(&parts, INITIAL_WIPE).unwrap_or_else(|| self.flat_picture(shot.resolution));
        let legends = shot.layout.legends(&scene, &shot.camera);
        let (cost, trace) = (Cost::default(), Duration::from_millis(milliseconds.into()));
        let parts = if shot.layout.is_wipe() { parts } else { Vec::new() };
        let frame = Frame {
            scene,
            shot,
            picture,
            geometry: None,
            parts,
            sampling,
            legends,
            orders: None,
            refines,
            cost,
            trace,
            interval: trace,
        };
        self.viewer.take_frame(frame);
    }

    /// Returns a picture whose pixels differ from those of the previous frame.
    fn flat_picture(&self, resolution: Resolution) -> Picture {
        let [width, height] = [resolution.width(), resolution.height()];
        // The frame's number is part of the colour, so that drawing a new frame always sends bytes.
        let pixel = |at: u32| Srgb8::new(self.frames, at as u8, 7);
        Picture::from_pixels(width, height, (0..width * height).map(pixel).collect()).expect("all pixels are there")
    }

    /// Carries out the viewer's actions until it waits. Returns the time until which it waits, if
    /// any.
    fn carry_out_steps(&mut self) -> Option<Duration> {
        for _ in 0..=MAX_ACTIONS {
            let tracing = self.job.as_ref().map(|job| if job.refines { Tracing::Refinement } else { Tracing::NewView });
            match self.viewer.next_step(DriverState { sending: self.is_sending, tracing }, self.now) {
                ViewerStep::Wait(until) if until.is_none_or(|until| until > self.now) => return until,
                // The timeout of an incomplete escape sequence has passed.
                ViewerStep::Wait(_) => self.receive(&[]),
                ViewerStep::CancelRefinement => {
                    assert!(self.job.take().is_some_and(|job| job.refines), "only a refinement is cancelled");
                }
                ViewerStep::Draw => {
                    assert!(!self.is_sending, "a frame is drawn that cannot be sent");
                    self.draw();
                }
                ViewerStep::Trace(probe, job) => {
                    assert!(
                        !self.is_sending && self.job.is_none(),
                        "a frame is begun that cannot be sent, or a second"
                    );
                    self.send(&probe);
                    self.is_sending = false;
                    self.job = Some(job);
                }
            }
        }
        panic!("there is always more to do at {:?}", self.now)
    }

    fn draw(&mut self) {
        let mut bytes = Vec::new();
        self.viewer.draw(self.now, &mut bytes);
        self.viewer.add_frame_queries(&mut bytes, self.now);
        let cells = self.viewer.picture_size().cell_count();
        assert!(
            bytes.len() <= MAX_FRAME_BYTES[0] * cells + MAX_FRAME_BYTES[1],
            "{} bytes for {cells} cells",
            bytes.len()
        );
        self.send(&bytes);
    }

    fn send(&mut self, bytes: &[u8]) {
        self.sent.extend_from_slice(bytes);
        self.is_sending = !bytes.is_empty();
    }

    /// Finishes all frames and replies to all queries without further events, and checks that the
    /// viewer comes to rest.
    fn come_to_rest(&mut self) {
        // Releases all keys, because a held key would move the eye for ever.
        self.viewer.lose_terminal(self.now);
        for _ in 0..MAX_WAKE_UPS {
            self.finish_job(1);
            self.is_sending = false;
            self.reply_to_queries();
            match self.carry_out_steps() {
                None if self.job.is_none() && !self.is_sending => return,
                None => {}
                Some(until) => {
                    self.now = until;
                    self.receive(&[]);
                }
            }
        }
        panic!("it does not come to rest: next at {:?}, now {:?}", self.carry_out_steps(), self.now);
    }

    /// Checks that every terminal mode that was switched on is switched off at the end.
    fn check_modes_end(mut self) {
        let mut off = Vec::new();
        self.modes.switch_all_off(&mut off);
        for mode in self.viewer.optional_modes() {
            let (mut modes, mut bytes) = (TerminalModes::default(), Vec::new());
            modes.switch_on(mode, &mut Vec::new());
            modes.switch_all_off(&mut bytes);
            assert!(off.windows(bytes.len()).any(|part| part == bytes), "{mode:?} stays on");
        }
    }
}

/// Returns the digits at the start of `query` if they are those of a mode query (DECRQM), that is,
/// `$p` follows.
fn queried_mode(query: &[u8]) -> Option<&[u8]> {
    let (digits, rest) = query.split_at(query.iter().position(|byte| !byte.is_ascii_digit())?);
    rest.starts_with(b"$p").then_some(digits)
}

fn window(size: Size) -> Window {
    Window { size, cell: CellShape::default(), cell_pixels: Some((10, 20)), is_part: false }
}

#[cfg(all(test, unit_tests))]
mod tests;
