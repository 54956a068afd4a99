//! Image order beside object order: two pictures of one view that are built slowly, one pixel by
//! pixel, the other object by object.
//!
//! Both are built at the same rate: a step is the test of one ray or pixel against one object. The times of both orders
//! were measured when the frame was traced.

use super::Viewer;
use super::caption::Caption;
use super::frame::Frame;
use super::layers::{Canvas, Layer, LayerLevel};
use super::theme;
use crate::color::Srgb8;
use crate::control::KeyMode;
use crate::tone::Picture;
use build::ObjectOrderBuild;
pub(super) use pace::BuildPace;
use ratatui_core::layout::Rect;
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use std::time::Duration;

mod build;
mod pace;
mod words;

/// The colour of pixels that are not drawn yet.
const EMPTY: Srgb8 = Srgb8::new(40, 42, 48);

/// The colour of the pixel for which image order is looking for the visible object.
const CURRENT_PIXEL_COLOR: Srgb8 = Srgb8::new(255, 208, 64);

/// The panel that compares image order with object order, and builds their pictures step by step.
pub(super) struct RenderOrdersPanel {
    pace: BuildPace,
    /// The object-order picture of the shown frame as built so far; `None` until the frame is
    /// traced.
    build: Option<ObjectOrderBuild>,
}

impl RenderOrdersPanel {
    /// Returns the panel before the first frame.
    ///
    /// With `reduced_motion` the pictures are complete until the user builds them step by step.
    pub(super) fn new(reduced_motion: bool) -> Self {
        Self { pace: BuildPace::new(reduced_motion), build: None }
    }

    /// Builds the pictures up to `now`. Returns whether they have changed, and the time of the next
    /// step if there is one.
    pub(super) fn advance(&mut self, now: Duration) -> (bool, Option<Duration>) {
        let Some(build) = &mut self.build else { return (false, None) };
        let progress = self.pace.advance(build.comparison.max_total_tests(), now);
        build.draw(self.pace.tests());
        progress
    }

    /// Returns the pictures as built so far; `None` if the frame's own picture is to be shown.
    pub(super) fn partial_picture(&self, frame: &Frame) -> Option<Picture> {
        let build = self.build.as_ref().filter(|build| self.pace.tests() < build.comparison.max_total_tests())?;
        let [(_, left), (_, right)] = *frame.shot.layout.map_sizes(frame.resolution()) else { return None };
        // After a resize, the build is still that of the last frame until the next one is traced.
        if left.width() == 0
            || right.width() == 0
            || right != build.resolution()
            || build.comparison.image_tests.len() != left.pixel_count()
        {
            return None;
        }
        let mut picture = frame.picture.clone();
        let built = build.comparison.built_pixels(self.pace.tests());
        let width = frame.resolution().width() as usize;
        let (left, start) = (left.width() as usize, left.width() as usize + 1);
        for (y, row) in picture.pixels_mut().chunks_mut(width).take(right.height() as usize).enumerate() {
            let of_row = built.saturating_sub(y * left).min(left);
            row[of_row..left].fill(EMPTY);
            if y == built / left && of_row < left {
                row[of_row] = CURRENT_PIXEL_COLOR;
            }
            for (x, pixel) in row[start..].iter_mut().enumerate() {
                *pixel = build.pixel_color(x as u32, y as u32, EMPTY, *pixel);
            }
        }
        Some(picture)
    }

    /// Changes the pace, and draws the objects anew if the build starts again.
    pub(super) fn change_pace(&mut self, change: fn(&mut BuildPace)) {
        let Some(build) = &mut self.build else { return };
        self.pace.set_total(build.comparison.max_total_tests());
        let before = self.pace.tests();
        change(&mut self.pace);
        // A build only adds to its picture, so that it has to start again to go back.
        if self.pace.tests() < before {
            build.restart();
        }
        build.draw(self.pace.tests());
    }
}

/// Returns the rows at the bottom of the screen that the panel covers, with the row of notes.
///
/// The pictures are above them.
pub(super) fn panel_rows(screen: Rect) -> u16 {
    if theme::has_room(screen) { words::height(screen.width, screen.height) + 1 } else { 0 }
}

impl Layer for RenderOrdersPanel {
    fn level(&self) -> LayerLevel {
        LayerLevel::Side
    }

    fn mode(&self, screen: Rect) -> Option<KeyMode> {
        theme::has_room(screen).then_some(KeyMode::Orders)
    }

    /// Begins to build the pictures of a new view. A refinement leaves the build as it is.
    fn take_frame(&mut self, frame: &Frame) {
        if !frame.refines || self.build.is_none() {
            self.build = ObjectOrderBuild::new(frame);
            self.pace.start();
        }
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if !canvas.has_room() {
            return;
        }
        let mut lines = match &self.build {
            Some(build) => {
                words::lines(&build.comparison, build.object_name(), self.pace.tests(), screen.width, screen.height)
            }
            None => vec!["measuring both orders".to_owned()],
        };
        lines.push(words::keys(canvas, &self.pace));
        let height = lines.len() as u16;
        let below = canvas.status_rows.max(canvas.note_rows);
        let area = Rect { y: screen.bottom().saturating_sub(below + height), height, ..screen };
        canvas.lay(area, |theme, area, buffer| {
            Clear.render(area, buffer);
            let lines: Vec<_> = lines.into_iter().map(|line| Line::from(format!(" {line}"))).collect();
            Paragraph::new(lines).style(theme.style()).render(area, buffer);
        });
    }
}

impl Viewer {
    /// Starts or ends the comparison of image order with object order.
    pub(super) fn toggle_orders(&mut self) {
        if self.close_orders() {
            return;
        }
        if !theme::has_room(theme::area(self.picture_size())) {
            return self.show_note(theme::needs_room("the comparison of both orders"));
        }
        // The view from outside and the object order both take the right half of the picture.
        self.end_outside_view();
        // The panel takes the place of the caption, which returns after it.
        self.screen.close::<Caption>();
        self.screen.open(RenderOrdersPanel::new(self.options.reduced_motion));
    }

    /// Ends the comparison of image order with object order. Returns whether it was open.
    pub(super) fn close_orders(&mut self) -> bool {
        let is_open = self.screen.close::<RenderOrdersPanel>().is_some();
        if is_open {
            self.show_caption_again();
        }
        is_open
    }

    /// Changes the pace at which image order and object order build their pictures.
    pub(super) fn change_pace(&mut self, change: fn(&mut BuildPace)) {
        if let Some(panel) = self.screen.get_mut::<RenderOrdersPanel>() {
            panel.change_pace(change);
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
