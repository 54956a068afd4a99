//! The last frame with what lies over it, and the bytes that bring the terminal there.

use super::dialog::Dialog;
use super::explain::Explaining;
use super::help::Help;
use super::panels;
use super::renderer::{Frame, MIDDLE};
use super::strip::Fault;
use crate::capabilities::{Capabilities, Colors};
use crate::cell::{self, Painter};
use crate::control::{Bindings, Mode};
use crate::encode::{Allowance, Encoder, Order, Quality};
use crate::grid::{Grid, Size};
use crate::pace::Limit;
use crate::progress::Progress;
use glam::Vec3;
use ratatui::layout::Rect;
use std::time::{Duration, Instant};

mod over;

/// How long the terminal is left alone before more is sent that nobody waits for: colours become exact in a few steps, of
/// which tmux throws none away.
const BREATH: Duration = Duration::from_millis(33);

/// What a frame in which all moves takes for each cell, about.
const BYTES_PER_CELL: usize = 8;

/// Erases the whole window (ED 2), which leaves many terminals with the colour that the pen has;
const ERASE: &[u8] = b"\x1b[2J";
/// the same with the pen laid down before, in the terminal's own colours.
const RESET_ERASE: &[u8] = b"\x1b[m\x1b[2J";

/// What the user sees.
pub(super) struct Screen {
    /// What is told of keys.
    bindings: Bindings,
    /// How the eye moves.
    moving: Mode,
    painter: Painter,
    encoder: Encoder,
    order: Option<Order>,
    quality: Option<Quality>,
    frame: Option<Frame>,
    /// Where the line between two views is, as a share of the width.
    wipe: f32,
    /// How far the scene is, until it is there.
    progress: Option<Progress>,
    /// What is wrong with the scene that was to be shown.
    fault: Option<Fault>,
    /// What the user is asked.
    question: Option<Dialog>,
    /// What there is to say until the next key.
    note: Option<String>,
    status: bool,
    /// The page of the help that is open, if one is.
    help: Option<usize>,
    /// The pixel that is explained, if one is.
    explaining: Option<Explaining>,
    /// Where the light is that is held, if one is.
    light: Option<Vec3>,
    /// Whether the next bytes erase the whole window first.
    erases: bool,
    /// Whether anything has changed since the last bytes.
    changed: bool,
    /// When the last bytes were written.
    written: Duration,
    pace: Pace,
    /// How long cells and bytes of the last frame took.
    encode: Duration,
    bytes: Vec<u8>,
}

impl Screen {
    pub(super) fn new(
        capabilities: &Capabilities,
        order: Option<Order>,
        quality: Option<Quality>,
        bindings: Bindings,
    ) -> Self {
        Self {
            bindings,
            moving: Mode::Fly,
            painter: painter(capabilities),
            encoder: encoder(Encoder::new(), capabilities),
            order,
            quality,
            frame: None,
            wipe: MIDDLE,
            progress: None,
            fault: None,
            question: None,
            note: None,
            status: false,
            help: None,
            explaining: None,
            light: None,
            erases: false,
            changed: false,
            written: Duration::ZERO,
            pace: Pace::default(),
            encode: Duration::ZERO,
            bytes: Vec::new(),
        }
    }

    /// What a frame in which all moves takes, about.
    pub(super) fn usual_bytes(size: Size) -> usize {
        BYTES_PER_CELL * size.cell_count()
    }

    /// More is known of the terminal than before.
    pub(super) fn set_capabilities(&mut self, capabilities: &Capabilities) {
        let mode = self.painter.mode();
        self.painter = painter(capabilities);
        self.encoder = encoder(std::mem::take(&mut self.encoder), capabilities);
        self.changed = true;
        if mode != self.painter.mode() {
            self.encoder.forget();
        }
        self.encoder.set_upper_half(capabilities.halves_meet);
    }

    /// A frame, and the time while something moves.
    pub(super) fn take_frame(&mut self, mut frame: Frame, moving: Option<Duration>) {
        frame.wipe(self.wipe);
        if let Some(explaining) = &mut self.explaining {
            explaining.take_frame(&frame);
        }
        self.frame = Some(frame);
        self.pace.count(moving);
        self.changed = true;
    }

    /// Moves the line between two views to that share of the width.
    pub(super) fn wipe_to(&mut self, share: f32) {
        self.wipe = share.clamp(0.0, 1.0);
        if let Some(frame) = self.frame.as_mut() {
            frame.wipe(self.wipe);
        }
        self.changed = true;
    }

    /// Where that line is.
    pub(super) fn wipe(&self) -> f32 {
        self.wipe
    }

    /// The scene is on its way.
    pub(super) fn set_progress(&mut self, progress: Progress) {
        self.progress = Some(progress);
        self.changed = true;
    }

    /// Whether the scene is still on its way: what is seen is a sketch of it at best.
    pub(super) fn awaits_scene(&self) -> bool {
        self.progress.is_some()
    }

    /// The scene is there: what was said of its way goes when it is seen.
    pub(super) fn end_progress(&mut self) {
        self.progress = None;
    }

    /// Something is wrong with the scene that was to be shown.
    pub(super) fn set_fault(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.changed = true;
    }

    /// Nothing is wrong any more.
    pub(super) fn end_fault(&mut self) {
        self.changed |= self.fault.take().is_some();
    }

    /// Asks the user something.
    pub(super) fn ask(&mut self, question: Dialog) {
        self.question = Some(question);
        self.changed = true;
    }

    /// What he was asked, no more to be seen.
    pub(super) fn end_question(&mut self) -> Option<Dialog> {
        self.changed |= self.question.is_some();
        self.question.take()
    }

    /// Says something in the lowest row, until it is unsaid.
    pub(super) fn say(&mut self, note: impl Into<String>) {
        self.note = Some(note.into());
        self.changed = true;
    }

    /// Nothing more is said in the lowest row.
    pub(super) fn unsay(&mut self) {
        self.changed |= self.note.take().is_some();
    }

    /// The last frame.
    pub(super) fn frame(&self) -> Option<&Frame> {
        self.frame.as_ref()
    }

    /// Whether anything was shown yet.
    pub(super) fn has_shown(&self) -> bool {
        self.written > Duration::ZERO
    }

    pub(super) fn toggle_status(&mut self) {
        self.status = !self.status;
        self.changed = true;
    }

    /// Opens the help, turns to its next page, or closes it after the last.
    pub(super) fn turn_help(&mut self, size: Size) {
        let pages = Help::new(&self.bindings, &self.modes(size), area(size)).pages();
        self.help = match self.help {
            None => Some(0),
            Some(page) => Some(page + 1).filter(|&page| page < pages && panels::has_room(area(size))),
        };
        self.changed = true;
    }

    /// What keys are for on a screen of that size, the topmost first.
    pub(super) fn modes(&self, size: Size) -> Vec<Mode> {
        if let Some(question) = &self.question {
            return vec![question.mode(), Mode::Always];
        }
        let explains = self.explaining.is_some() && panels::has_room(area(size));
        let above = [self.light.map(|_| Mode::Light), explains.then_some(Mode::Explain)];
        above.into_iter().flatten().chain([self.moving, Mode::Always]).collect()
    }

    /// The eye flies, or goes around something.
    pub(super) fn set_moving(&mut self, moving: Mode) {
        self.changed |= self.tells_of_keys() && self.moving != moving;
        self.moving = moving;
    }

    fn tells_of_keys(&self) -> bool {
        self.help.is_some() || self.status
    }

    /// The help goes; whether it was there.
    pub(super) fn close_help(&mut self) -> bool {
        let was_open = self.help.take().is_some();
        self.changed |= was_open;
        was_open
    }

    /// The explanation goes.
    pub(super) fn close_explaining(&mut self) {
        self.changed |= self.explaining.take().is_some();
    }

    /// A light is held, and is there; or none is.
    pub(super) fn mark_light(&mut self, light: Option<Vec3>) {
        self.changed |= self.light != light;
        self.light = light;
    }

    /// A pixel is explained, or none any more.
    pub(super) fn toggle_explaining(&mut self) {
        self.explaining = match self.explaining.take() {
            Some(_) => None,
            None => self.frame.as_ref().and_then(Explaining::new),
        };
        self.changed = true;
    }

    /// Another pixel is explained, or more is said of it.
    pub(super) fn explain(&mut self, change: impl FnOnce(&mut Explaining, &Frame)) {
        if let (Some(explaining), Some(frame)) = (&mut self.explaining, &self.frame) {
            change(explaining, frame);
            self.changed = true;
        }
    }

    /// The terminal may show anything: the next bytes draw everything, with either half block if both meet in one line.
    /// They erase the whole window before, if the picture covers only a part of it.
    pub(super) fn redraw(&mut self, halves_meet: bool, covers_a_part: bool) {
        self.encoder.forget();
        self.erases = covers_a_part;
        self.encoder.set_upper_half(halves_meet);
        self.changed = true;
    }

    /// When there are bytes to send: never, if all is shown as it should be, or before the first frame of the wanted size
    /// is there. What is shown already is made better only if it is to last.
    pub(super) fn due(&self, size: Size, lasts: bool) -> Option<Duration> {
        if !self.can_show(size) {
            return None;
        }
        if self.changed {
            return Some(Duration::ZERO);
        }
        self.encoder.due().filter(|_| lasts).map(|due| due.max(self.written + BREATH))
    }

    /// Whether there is a frame of that size, or none at all yet: there is black then, for panels to lie on.
    fn can_show(&self, size: Size) -> bool {
        self.is_frame_of(size) || self.frame.is_none() && self.progress.is_some()
    }

    fn is_frame_of(&self, size: Size) -> bool {
        let wanted = cell::resolution(self.painter.mode(), size, 1.0);
        let is_wanted = |frame: &Frame| (frame.picture.width, frame.picture.height) == (wanted.width, wanted.height);
        self.frame.as_ref().is_some_and(is_wanted)
    }

    /// The bytes that are to be sent now.
    pub(super) fn bytes(&mut self, size: Size, now: Duration, limit: Option<Limit>) -> &mut Vec<u8> {
        self.bytes.clear();
        if self.can_show(size) {
            let start = Instant::now();
            let mut grid = match &self.frame {
                Some(frame) => self.painter.grid(&frame.picture),
                None => Grid::new(size),
            };
            self.lay_panels_over(&mut grid, limit);
            let (usual, order) =
                if limit.is_some() { (Quality::Equal, Order::Color) } else { (Quality::Exact, Order::Raster) };
            self.encoder.set_order(self.order.unwrap_or(order));
            let most_bytes = limit.map(|limit| limit.most_bytes);
            if std::mem::take(&mut self.erases) {
                self.bytes.extend_from_slice(if self.painter.mode().colors == Colors::None {
                    ERASE
                } else {
                    RESET_ERASE
                });
            }
            let allowance = Allowance { quality: self.quality.unwrap_or(usual), now, most_bytes };
            self.encoder.encode_within(&grid, allowance, &mut self.bytes);
            self.encode = start.elapsed();
            self.changed = false;
            self.written = now;
        }
        &mut self.bytes
    }
}

/// All of it.
fn area(size: Size) -> Rect {
    Rect::new(0, 0, size.columns, size.rows)
}

fn painter(capabilities: &Capabilities) -> Painter {
    Painter::new(capabilities.cell_mode).with_light_background(capabilities.light_background)
}

fn encoder(encoder: Encoder, capabilities: &Capabilities) -> Encoder {
    let has_colors = capabilities.cell_mode.colors != Colors::None;
    encoder.with_colors(has_colors).with_synchronized_output(capabilities.synchronized_output)
}

/// How many frames are shown per second while something moves.
#[derive(Default)]
struct Pace {
    last: Option<Duration>,
    frames_per_second: Option<f32>,
}

impl Pace {
    /// A frame is shown while something moves, or, without a time, at rest. A pause ends the count: frames of before it
    /// say nothing of those after.
    fn count(&mut self, moving: Option<Duration>) {
        let between = self.last.zip(moving).map(|(last, now)| now.saturating_sub(last));
        self.last = moving;
        self.frames_per_second =
            between.filter(|&between| between < PAUSE && between > Duration::ZERO).map(|between| {
                let now = 1.0 / between.as_secs_f32();
                // A mean over about eight frames, so that the figure can be read.
                self.frames_per_second.map_or(now, |mean| mean + (now - mean) / 8.0)
            });
    }
}

/// Frames further apart than this are not one movement.
const PAUSE: Duration = Duration::from_millis(500);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shown::Shown;
    use crate::capabilities::CellMode;
    use crate::export;
    use crate::render::{Cost, Sampling};
    use crate::scene::Scene;
    use crate::tone::tone;
    use std::num::NonZeroU32;

    /// By colour while the link is slow, row by row otherwise, unless one of them is asked for.
    #[test]
    fn the_order_is_the_links() {
        let text = include_str!("../../scenes/three_spheres.ron");
        let scene = Scene::from_ron("three_spheres.ron", text).expect("the scene is fine");
        let capabilities = Capabilities {
            cell_mode: CellMode::HALF_BLOCK,
            cell_aspect: 2.0,
            halves_meet: false,
            light_background: false,
            synchronized_output: false,
        };
        let size = Size::new(40, 12);
        let resolution = cell::resolution(capabilities.cell_mode, size, 2.0);
        let light = crate::render::render(&scene, &scene.camera, resolution, NonZeroU32::MIN);
        let frame = || Frame {
            scene: scene.clone().into(),
            camera: scene.camera,
            resolution,
            picture: tone(&light, &scene),
            parts: Vec::new(),
            shown: Shown::default(),
            legends: Vec::new(),
            cost: Cost::default(),
            sampling: Sampling::Each(NonZeroU32::MIN),
            refines: false,
            trace: Duration::ZERO,
        };
        let grid = export::frame_grid(&scene, capabilities.cell_mode, size, 2.0);
        let slow = Some(Limit { rate: Some(1e5), most_bytes: usize::MAX });
        let exact = Some(Quality::Exact);
        for (asked, link, order) in [
            (None, None, Order::Raster),
            (None, slow, Order::Color),
            (Some(Order::Color), None, Order::Color),
            (Some(Order::Raster), slow, Order::Raster),
        ] {
            let mut screen = Screen::new(&capabilities, asked, exact, Bindings::default());
            screen.take_frame(frame(), None);
            let mut wanted = Vec::new();
            Encoder::new().with_order(order).encode(&grid, &mut wanted);
            assert!(screen.bytes(size, Duration::ZERO, link) == &wanted, "{asked:?} {link:?}");
        }
    }
}
