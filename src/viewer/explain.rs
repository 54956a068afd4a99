//! The explanation of a pixel: a cursor on the picture and a panel beside it.
//!
//! The text is computed when a frame arrives or the cursor moves, and drawn with every frame.

mod inset;
mod placement;

use super::frame::Frame;
use super::help;
use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::{self, Theme};
use super::tracer_lines::draw_eye_ray;
use crate::capabilities::CellMode;
use crate::cell::cell_of_pixel;
use crate::control::{Command, KeyMode};
use crate::explain::{Explanation, explain};
use crate::framebuffer::Resolution;
use crate::overlay;
use crate::render::Sampling;
use inset::Inset;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;

use placement::{cursor_marks, panel_area};

/// The explained pixel and its explanation.
pub(super) struct ExplainPanel {
    /// The pixel's coordinates in the picture, from the upper left.
    pixel: [u32; 2],
    /// The size of the picture in pixels.
    resolution: Resolution,
    explanation: Explanation,
    inset: Inset,
    /// Lines on how the pixel's colour, a mean of several rays, differs from the explained ray's.
    notes: Vec<String>,
    /// The shown page of the text, from 0.
    page: usize,
}

impl Layer for ExplainPanel {
    fn level(&self) -> LayerLevel {
        LayerLevel::Side
    }

    fn mode(&self, screen: Rect) -> Option<KeyMode> {
        theme::has_room(screen).then_some(KeyMode::Explain)
    }

    /// Updates the explanation for a frame, which may be of another view or size.
    fn take_frame(&mut self, frame: &Frame) {
        let (old, new) = (self.resolution, frame.resolution());
        // A refinement leaves the explained ray as it is and changes only the pixel's colour, which becomes the mean of
        // more rays.
        if frame.refines && old == new {
            self.notes = color_difference_notes(frame, self.pixel, &self.explanation);
            return;
        }
        let [x, y] = self.pixel;
        // In u64, because the product of two sizes may exceed 32 bits.
        let scaled = |at: u32, old: u32, new: u32| (u64::from(at) * u64::from(new) / u64::from(old.max(1))) as u32;
        self.move_to(frame, [scaled(x, old.width(), new.width()), scaled(y, old.height(), new.height())]);
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if !canvas.has_room() {
            return;
        }
        let (screen, mode) = (canvas.screen(), canvas.cell_mode);
        // The panel leaves the rows of the status line free.
        let above = Rect { height: screen.height - canvas.status_rows, ..screen };
        let keys = help::key_names(canvas.keymap, canvas.modes, &[Command::ScrollUp, Command::ScrollDown]);
        let keys = keys.unwrap_or_default();
        match canvas.frame.filter(|frame| frame.shot.outside.is_some()) {
            // If there is a picture from outside, the ray is drawn into it, and the panel would cover the ray.
            Some(frame) => draw_eye_ray(canvas, frame, &self.explanation),
            None => canvas.lay(panel_area(above, self.cell(mode)), |theme, panel, buffer| {
                self.paint(&keys, theme, mode, panel, buffer);
            }),
        }
        for mark in cursor_marks(self, canvas.theme(), mode, screen) {
            overlay::lay_over(canvas.grid, &mark);
        }
    }
}

impl ExplainPanel {
    /// Returns an explanation of the pixel in the middle of the frame; `None` for an empty frame.
    pub(super) fn new(frame: &Frame) -> Option<Self> {
        let [width, height] = [frame.resolution().width(), frame.resolution().height()];
        (width > 0 && height > 0).then(|| Self::at_pixel(frame, [width / 2, height / 2], 0))
    }

    fn at_pixel(frame: &Frame, pixel: [u32; 2], page: usize) -> Self {
        // If there are two cameras, only pixels of the first one's picture are explained.
        let first = frame.shot.outside.map(|_| frame.part_at([0, 0]).0.width().saturating_sub(1));
        let pixel = first.map_or(pixel, |last| [pixel[0].min(last), pixel[1]]);
        let (resolution, part) = frame.part_at(pixel);
        let explanation = explain(&frame.scene, frame.camera(), resolution, part);
        let inset = Inset::for_explanation(&frame.scene, frame.camera(), &explanation);
        Self {
            pixel,
            resolution: frame.resolution(),
            inset,
            notes: color_difference_notes(frame, pixel, &explanation),
            explanation,
            page,
        }
    }

    /// Moves the cursor by these numbers of pixels to the right and down.
    pub(super) fn move_cursor_by(&mut self, frame: &Frame, [right, down]: [i32; 2]) {
        let [x, y] = self.pixel;
        self.move_to(frame, [x.saturating_add_signed(right), y.saturating_add_signed(down)]);
    }

    /// Moves the cursor to a pixel, clamped to the picture.
    pub(super) fn move_to(&mut self, frame: &Frame, [x, y]: [u32; 2]) {
        let [width, height] = [frame.resolution().width(), frame.resolution().height()];
        if width > 0 && height > 0 {
            // The frame may have become smaller since the pointer was there.
            *self = Self::at_pixel(frame, [x.min(width - 1), y.min(height - 1)], self.page);
        }
    }

    /// Turns this number of pages; negative numbers turn back.
    pub(super) fn turn_pages(&mut self, by: isize) {
        self.page = self.page.saturating_add_signed(by);
    }

    /// Returns the column and row of the cell that contains the pixel.
    fn cell(&self, mode: CellMode) -> [u16; 2] {
        let ((across, down), [x, y]) = (mode.pixels_per_cell(), self.pixel);
        [(x / across) as u16, (y / down) as u16]
    }

    /// Returns the pixel's row within its cell, and the number of rows in a cell.
    fn row_in_cell(&self, mode: CellMode) -> (u32, u32) {
        let (_, down) = mode.pixels_per_cell();
        (self.pixel[1] % down, down)
    }

    fn lines(&self, mode: CellMode) -> Vec<String> {
        let mut lines = self.explanation.lines();
        lines.push(cell_of_pixel(self.pixel, mode));
        lines.extend(self.notes.iter().cloned());
        lines
    }

    /// Draws the panel: a page of the text, with the `keys` that turn pages, and below it the side
    /// view.
    fn paint(&mut self, keys: &str, theme: Theme, mode: CellMode, area: Rect, buffer: &mut Buffer) {
        let lines = self.lines(mode);
        let inside = area.inner(Margin::new(2, 1));
        let [text, inset] = placement::split_panel(inside, lines.len() as u16);
        let rows = usize::from(text.height).max(1);
        let pages = lines.len().div_ceil(rows);
        // The page is clamped here and not on the key press, because the last one depends on the pixel and the panel's
        // height.
        self.page = self.page.min(pages.saturating_sub(1));
        Clear.render(area, buffer);
        // The keys are shown in the lower border, because a line of their own would take one from the text.
        let mut block = Block::bordered().border_set(theme.border()).style(theme.style()).title(" explain ");
        if pages > 1 {
            block = block.title_bottom(format!(" page {} of {pages}: {keys} ", self.page + 1));
        }
        block.render(area, buffer);
        let seen: Vec<_> = lines.into_iter().skip(self.page * rows).map(Line::from).collect();
        Paragraph::new(seen).style(theme.style()).render(text, buffer);
        self.inset.draw(theme, mode, self.resolution, inset, buffer);
    }
}

/// Returns lines on why the shaded picture's colour at pixel `[x, y]` differs from the explained
/// ray's.
///
/// Empty for a frame with any other map, and if the colours are equal, unless rays may stand for 2x2 pixels each.
fn color_difference_notes(frame: &Frame, [x, y]: [u32; 2], explanation: &Explanation) -> Vec<String> {
    // Frames of maps have legends. A map's value is that of a single ray, so no mean is to be explained.
    if !frame.legends.is_empty() {
        return Vec::new();
    }
    let samples = match frame.sampling {
        Sampling::Coarse => return vec!["shown with one ray for 2x2 pixels".to_owned()],
        Sampling::Split => {
            return vec![
                "shown with one ray for 2x2 pixels of even light, and up to 16 for a pixel at an edge".to_owned(),
            ];
        }
        Sampling::Each(samples) => format!("this is the first of {samples} rays"),
        Sampling::UpTo(samples) => format!("this is the first of up to {samples} rays"),
        _ => return Vec::new(),
    };
    let at = y as usize * frame.picture.width() as usize + x as usize;
    match frame.picture.pixels().get(at) {
        Some(&shown) if shown != explanation.bytes => {
            vec![samples, format!("their mean is {} {} {}", shown.r, shown.g, shown.b)]
        }
        _ => Vec::new(),
    }
}
