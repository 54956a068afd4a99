//! The followers of the tour whose terminals get the same bytes.
//!
//! Each picture is traced and encoded once for all of them.
//!
//! A follower sends the newest frame only. One that has missed a frame waits for the next key frame, which is made at
//! most once in a tick, and only if a follower needs it. So a slow follower delays no other one, and holds at most one
//! frame.

use super::tour::{AudienceClass, Tour};
use crate::cell::{self, Painter};
use crate::encode::Encoder;
use crate::grid::Grid;
use crate::maps::Map;
use crate::overlay;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::Style;
use std::num::NonZeroU32;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::sync::watch;

/// Rays per pixel of a picture.
const SAMPLES: NonZeroU32 = NonZeroU32::new(4).expect("4 is not 0");

/// The pixels above which a picture has one ray per pixel.
const MAX_SAMPLED_PIXELS: u64 = 30_000;

/// One frame of the tour, for all terminals of a class.
#[derive(Clone, Debug, Default)]
pub(super) struct TourFrame {
    /// The frame's number: 0 before the first one.
    number: u64,
    /// The bytes that change the frame before into this one.
    delta: Arc<[u8]>,
    /// The bytes that draw this frame on any screen, if a follower needs them.
    key: Option<Arc<[u8]>>,
}

/// An audience: the frames that it gets, and its need of a key frame.
pub(super) struct Audience {
    pub(super) class: AudienceClass,
    frames: watch::Sender<TourFrame>,
    /// Whether a follower needs a key frame.
    needs_key: Arc<AtomicBool>,
}

impl Audience {
    /// Returns an audience without followers.
    pub(super) fn new(class: AudienceClass) -> Self {
        Self { class, frames: watch::Sender::default(), needs_key: Arc::default() }
    }

    /// Returns the number of followers.
    pub(super) fn len(&self) -> usize {
        self.frames.receiver_count()
    }

    /// Adds a follower.
    pub(super) fn follow(&self) -> Follower {
        self.needs_key.store(true, Ordering::Relaxed);
        Follower { frames: self.frames.subscribe(), needs_key: Arc::clone(&self.needs_key), shown: None }
    }
}

/// A follower's place in an audience.
#[derive(Debug)]
pub(super) struct Follower {
    frames: watch::Receiver<TourFrame>,
    needs_key: Arc<AtomicBool>,
    /// The number of the frame on the follower's screen; `None` if the screen shows something else.
    shown: Option<u64>,
}

impl Follower {
    /// Waits for the next frame that can be sent, and returns its bytes.
    ///
    /// Does not lose a frame if the future is dropped.
    pub(super) async fn next_bytes(&mut self) -> Arc<[u8]> {
        loop {
            if self.frames.changed().await.is_err() {
                // The audience lasts as long as it has a follower.
                return std::future::pending().await;
            }
            let TourFrame { number, delta, key } = self.frames.borrow_and_update().clone();
            let bytes = if self.shown.is_some_and(|shown| shown + 1 == number) { Some(delta) } else { key };
            let Some(bytes) = bytes else {
                self.shown = None;
                self.needs_key.store(true, Ordering::Relaxed);
                continue;
            };
            self.shown = Some(number);
            if !bytes.is_empty() {
                return bytes;
            }
        }
    }
}

/// The drawing of an audience's frames.
pub(super) struct Drawing {
    painter: Painter,
    encoder: Encoder,
    /// The tick of the last frame.
    tick: Option<u64>,
}

impl Drawing {
    /// Returns the drawing for terminals of a class.
    pub(super) fn new(AudienceClass { capabilities, .. }: &AudienceClass) -> Self {
        let mode = capabilities.cell_mode;
        let encoder = Encoder::new()
            .with_half_blocks(capabilities.half_blocks)
            .with_colors(mode.colors != cell::Colors::None)
            .with_synchronized_output(capabilities.synchronized_output);
        let painter = Painter::new(mode).with_light_background(capabilities.light_background);
        Self { painter, encoder, tick: None }
    }

    /// Draws the frame of the tick at `now`, and returns the time of the next frame.
    ///
    /// Draws nothing if that tick's frame has been drawn. `line` is the text in the lowest row.
    pub(super) fn draw(&mut self, audience: &Audience, tour: &Tour, line: &str, now: Duration) -> Duration {
        let tick = Tour::tick_at(now);
        if self.tick.replace(tick) == Some(tick) {
            return tour.next_frame_at(now, 0);
        }
        let AudienceClass { size, capabilities } = audience.class;
        let Ok(resolution) = cell::resolution(capabilities.cell_mode, size, capabilities.cell_aspect) else {
            return tour.next_frame_at(now, 0);
        };
        let samples = if resolution.pixel_count() as u64 <= MAX_SAMPLED_PIXELS { SAMPLES } else { NonZeroU32::MIN };
        let (scene, camera) = (tour.scene(tick), tour.camera(tick));
        let mut grid = self.painter.trace(Map::Shaded, &scene, &camera, resolution, samples);
        write_line(&mut grid, line);
        let mut delta = Vec::new();
        self.encoder.encode(&grid, &mut delta);
        let key = audience.needs_key.swap(false, Ordering::Relaxed).then(|| {
            // After the key frame a terminal shows the same cells as after the delta, and has the same pen. So the next
            // delta is right after either of them.
            let mut key = Vec::new();
            self.encoder.reset_pen(&mut delta);
            self.encoder.forget();
            self.encoder.encode(&grid, &mut key);
            self.encoder.reset_pen(&mut key);
            key
        });
        let length = delta.len();
        audience.frames.send_modify(|frame| {
            *frame = TourFrame { number: frame.number + 1, delta: delta.into(), key: key.map(Arc::from) };
        });
        // Key frames do not count, so that followers who join or fall behind do not slow the others.
        tour.next_frame_at(now, length)
    }
}

/// Writes a line into the lowest row.
fn write_line(grid: &mut Grid, line: &str) {
    let size = grid.size();
    let area = Rect::new(0, size.rows.saturating_sub(1), size.columns, 1);
    let mut buffer = Buffer::empty(area);
    buffer.set_stringn(area.x, area.y, line, usize::from(area.width), Style::default());
    overlay::lay_over(grid, &buffer);
}
