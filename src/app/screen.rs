//! The last frame with what lies over it, and the bytes that bring the terminal there.

use super::panels;
use super::renderer::Frame;
use crate::camera::Camera;
use crate::capabilities::CellMode;
use crate::cell;
use crate::encode::{Encoder, Order};
use crate::grid::{Grid, Size};
use crate::overlay;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::time::{Duration, Instant};

/// What the user sees.
pub(super) struct Screen {
    cell_mode: CellMode,
    encoder: Encoder,
    frame: Option<Frame>,
    status: bool,
    help: bool,
    /// Whether anything has changed since the last bytes.
    changed: bool,
    pace: Pace,
    /// How long cells and bytes of the last frame took.
    encode: Duration,
    bytes: Vec<u8>,
}

impl Screen {
    pub(super) fn new(cell_mode: CellMode, order: Order) -> Self {
        Self {
            cell_mode,
            encoder: Encoder::new().with_order(order),
            frame: None,
            status: false,
            help: false,
            changed: false,
            pace: Pace::default(),
            encode: Duration::ZERO,
            bytes: Vec::new(),
        }
    }

    /// A frame, and the time while something moves.
    pub(super) fn take_frame(&mut self, frame: Frame, moving: Option<Duration>) {
        self.frame = Some(frame);
        self.pace.count(moving);
        self.changed = true;
    }

    pub(super) fn toggle_status(&mut self) {
        self.status = !self.status;
        self.changed = true;
    }

    pub(super) fn toggle_help(&mut self) {
        self.help = !self.help;
        self.changed = true;
    }

    pub(super) fn close_help(&mut self) {
        self.changed |= self.help;
        self.help = false;
    }

    /// The terminal may show anything: the next bytes draw everything.
    pub(super) fn redraw(&mut self) {
        self.encoder.forget();
        self.changed = true;
    }

    /// The bytes that are to be sent now. Nothing is shown before the first frame of the wanted size is there.
    pub(super) fn bytes(&mut self, size: Size, camera: &Camera) -> &[u8] {
        self.bytes.clear();
        if self.changed
            && let Some(frame) = &self.frame
        {
            let start = Instant::now();
            let mut grid = cell::grid_from_picture(self.cell_mode, &frame.picture);
            if grid.size() == size {
                self.lay_panels_over(&mut grid, frame, camera);
                self.encoder.encode(&grid, &mut self.bytes);
                self.encode = start.elapsed();
                self.changed = false;
            }
        }
        &self.bytes
    }

    fn lay_panels_over(&self, grid: &mut Grid, frame: &Frame, camera: &Camera) {
        let Size { columns, rows } = grid.size();
        let area = Rect::new(0, 0, columns, rows);
        let look = panels::Look::of(self.cell_mode);
        let mut lay = |area: Rect, draw: &dyn Fn(Rect, &mut Buffer)| {
            let mut buffer = Buffer::empty(area);
            draw(area, &mut buffer);
            overlay::lay_over(grid, &buffer);
        };
        if self.status {
            let status = panels::Status {
                cells: Size { columns, rows },
                trace: frame.trace,
                encode: self.encode,
                shown: self.pace.frames_per_second,
                rays: frame.rays,
                eye: camera.pose().eye,
            };
            lay(panels::status_area(area), &|area, buffer| {
                status.draw(look, area, buffer);
            });
        }
        if self.help {
            lay(panels::help_area(area), &|area, buffer| {
                panels::draw_help(look, area, buffer);
            });
        }
    }
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
