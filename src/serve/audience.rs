//! The followers of a guide whose terminals get the same bytes.
//!
//! Each picture is traced and encoded once for all of them.
//!
//! A follower sends the newest frame only. One that has missed a frame waits for the next key frame, which is made at
//! most once in a tick, and only if a follower needs it. So a slow follower delays no other one, and holds at most one
//! frame.

use super::guide::GuideView;
use super::tour::{AudienceClass, AudienceLimits, Tour};
use crate::cell::{self, Painter};
use crate::encode::Encoder;
use crate::grid::Grid;
use crate::overlay;
use crate::progress::Cancellation;
use crate::render::Sampling;
use bytes::Bytes;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::Style;
use std::num::NonZeroU32;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::sync::watch;

/// Rays per pixel of a picture in motion. At rest it has as many as any picture at rest.
const SAMPLES: NonZeroU32 = NonZeroU32::new(4).expect("4 is not 0");

/// The pixels above which a picture has one ray per pixel.
const MAX_SAMPLED_PIXELS: u64 = 30_000;

/// One frame of a guide's view, for all terminals of a class.
#[derive(Clone, Debug, Default)]
pub(super) struct TourFrame {
    /// The frame's number: 0 before the first one.
    number: u64,
    /// The bytes that change the frame before into this one.
    delta: Bytes,
    /// The bytes that draw this frame on any screen, if a follower needs them.
    key: Option<Bytes>,
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

    /// Starts again with a key frame, because the drawing of the frames so far is lost.
    pub(super) fn start_again(&self) {
        self.needs_key.store(true, Ordering::Relaxed);
        // A number is left out, so that no follower takes the next frame for a change of the one on its screen.
        self.frames.send_modify(|frame| *frame = TourFrame { number: frame.number + 2, ..TourFrame::default() });
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
    pub(super) async fn next_bytes(&mut self) -> Bytes {
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
    shown: Option<Shown>,
}

/// The last frame.
struct Shown {
    view: GuideView,
    title: String,
    /// The picture, without the line.
    picture: Grid,
    /// Whether the picture has all its samples.
    is_refined: bool,
}

impl Shown {
    fn has_picture_of(&self, view: &GuideView) -> bool {
        self.view.scene.is_copy_of(&view.scene) && self.view.camera == view.camera && self.view.map == view.map
    }
}

/// The line in the lowest row of an audience's frames.
pub(super) struct GuideLine {
    /// The words for the guide. A frame is drawn when they change.
    pub(super) title: String,
    /// The number of viewers. No frame is drawn because it changes.
    pub(super) watching: usize,
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
        Self { painter, encoder, tick: None, shown: None }
    }

    /// Draws the frame of the tick at `now`.
    ///
    /// Returns the time of the next frame, and whether a frame was drawn.
    ///
    /// A picture at rest is refined if `refine` is given, until that token is cancelled.
    ///
    /// Draws nothing if that tick's frame has been drawn, or if it shows the same as the last one and no follower needs
    /// it.
    pub(super) fn draw(
        &mut self,
        audience: &Audience,
        (view, line): (GuideView, GuideLine),
        (limits, now): (AudienceLimits, Duration),
        refine: Option<&Cancellation>,
    ) -> (Duration, bool) {
        let (tick, skipped) = (Tour::tick_at(now), (limits.next_frame_at(now, 0), false));
        if self.tick.replace(tick) == Some(tick) {
            return skipped;
        }
        let before = self.shown.take();
        let is_same_as = |shown: &Shown| shown.title == line.title && shown.has_picture_of(&view);
        let was_refined = before.as_ref().filter(|shown| is_same_as(shown)).map(|shown| shown.is_refined);
        let Some(shown) = self.picture(audience.class, before, (view, line.title), refine) else { return skipped };
        if was_refined == Some(shown.is_refined) && !audience.needs_key.load(Ordering::Relaxed) {
            self.shown = Some(shown);
            return skipped;
        }
        let mut grid = shown.picture.clone();
        write_line(&mut grid, &format!(" {}, {} watching: any key leaves it ", shown.title, line.watching));
        self.shown = Some(shown);
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
            *frame = TourFrame { number: frame.number + 1, delta: delta.into(), key: key.map(Bytes::from) };
        });
        // Key frames do not count, so that followers who join or fall behind do not slow the others.
        (limits.next_frame_at(now, length), true)
    }

    /// Returns the picture of a view, which is traced if the last frame does not have it, and
    /// refined if it rests.
    ///
    /// `None` if it is too large.
    fn picture(
        &mut self,
        AudienceClass { size, capabilities, .. }: AudienceClass,
        before: Option<Shown>,
        (view, title): (GuideView, String),
        refine: Option<&Cancellation>,
    ) -> Option<Shown> {
        let resolution = cell::resolution(capabilities.cell_mode, size, capabilities.cell_aspect).ok()?;
        let GuideView { scene, camera, map, .. } = &view;
        let Some(shown) = before.filter(|shown| shown.has_picture_of(&view)) else {
            let is_smooth = map.refines() && resolution.pixel_count() as u64 <= MAX_SAMPLED_PIXELS;
            let sampling = Sampling::Each(if is_smooth { SAMPLES } else { NonZeroU32::MIN });
            let picture = self.painter.trace(*map, scene, camera, resolution, sampling);
            return Some(Shown { view, title, picture, is_refined: !is_smooth });
        };
        // Without the refinement, the next tick tries again.
        let token = refine.filter(|_| !shown.is_refined);
        let refined = token
            .and_then(|token| self.painter.trace_until(token, (*map, scene, camera), resolution, Sampling::BEST).ok());
        Some(match refined {
            Some(picture) => Shown { title, picture, is_refined: true, ..shown },
            None => Shown { title, ..shown },
        })
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

#[cfg(all(test, unit_tests))]
mod tests;
