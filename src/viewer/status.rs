//! The status line: the scene and statistics of the last frame, and a row of keys above them.

use super::help;
use super::layers::{Canvas, FrameStatistics, Layer, LayerLevel};
use super::theme;
use crate::camera::ViewRectangle;
use crate::grid::Size;
use crate::render::Sampling;
use glam::Vec3;
use ratatui_core::layout::Rect;
use std::time::Duration;
use unicode_width::UnicodeWidthStr;

/// The layer with the statistics of the last frame in the lowest row, and the important keys above
/// it.
pub(super) struct StatusLine;

impl StatusLine {
    /// Returns the height of the status line: a row of statistics, and one of keys if there is room
    /// for panels.
    pub(super) fn rows(screen: Rect) -> u16 {
        // On a small screen the keys would not fit into a row anyway.
        1 + u16::from(theme::has_room(screen))
    }
}

impl Layer for StatusLine {
    fn level(&self) -> LayerLevel {
        LayerLevel::Status
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame else { return };
        let status = Status {
            name: canvas.name,
            cells: canvas.grid.size(),
            sampling: frame.sampling,
            trace: frame.trace,
            figures: canvas.figures,
            eye: frame.camera().pose().eye,
            rectangle: frame.camera().rectangle(),
        };
        let width = canvas.screen().width.into();
        if canvas.status_rows > 1 {
            let keys = help::status_line(canvas.keymap, canvas.modes, width);
            canvas.write_line(&keys, canvas.row_from_bottom(1));
        }
        let separator = if canvas.cell_mode.glyphs.has_blocks() { " · " } else { "; " };
        canvas.write_line(&status.text(separator, width), canvas.row_from_bottom(0));
    }
}

/// The content of the status line.
struct Status<'a> {
    name: &'a str,
    cells: Size,
    sampling: Sampling,
    /// Time that tracing the last frame took.
    trace: Duration,
    figures: FrameStatistics,
    eye: Vec3,
    rectangle: ViewRectangle,
}

impl Status<'_> {
    /// Returns the items, separated by `separator`. If they do not fit into `width` columns, the
    /// first ones are left out.
    fn text(&self, separator: &str, width: usize) -> String {
        let Self { name, cells, sampling, trace, figures, eye, rectangle } = self;
        let FrameStatistics { encode, frames_per_second, slow } = *figures;
        let mut items =
            vec![(*name).to_owned(), format!("{}x{}", cells.columns, cells.rows), sampling.samples_per_pixel()];
        // The cause that limits the frame rate: a slow link, or else the time for tracing and encoding.
        items.push(match slow {
            Some(rate) => format!("slow link {}B/s", short(rate)),
            None => milliseconds(*trace + encode),
        });
        items.extend(frames_per_second.map(|frames| format!("{frames:.0} fps")));
        items.extend(rectangle.offset_texts());
        items.push(format!("eye {:.2} {:.2} {:.2}", eye.x, eye.y, eye.z));
        items.retain(|item| !item.is_empty());
        while items.len() > 1 && items.join(separator).width() + 2 > width {
            items.remove(0);
        }
        format!(" {}", items.join(separator))
    }
}

/// Formats the time of a frame: `0.8 ms`, `5 ms`.
fn milliseconds(time: Duration) -> String {
    let time = 1e3 * time.as_secs_f64();
    if time < 1.0 { format!("{time:.1} ms") } else { format!("{time:.0} ms") }
}

/// Formats a number in two or three digits and a letter: 812, 3.9k, 12M.
fn short(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    if value >= 10.0 { format!("{value:.0}{unit}") } else { format!("{value:.1}{unit}") }
}
