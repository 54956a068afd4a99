//! The status line: the important keys, and below them statistics of the last frame.

use super::help;
use super::layers::{Canvas, FrameStatistics, Layer, Level};
use super::theme;
use crate::grid::Size;
use crate::render::Sampling;
use glam::Vec3;
use ratatui_core::layout::Rect;
use std::time::Duration;

/// The layer with the statistics of the last frame in the lowest row, and the important keys above
/// it.
pub(super) struct StatusLine;

impl StatusLine {
    /// Returns the number of rows: one for the statistics, and one for the keys if there is room
    /// for panels.
    pub(super) fn rows(screen: Rect) -> u16 {
        // On a small screen the keys would not fit into a row anyway.
        1 + u16::from(theme::has_room(screen))
    }
}

impl Layer for StatusLine {
    fn level(&self) -> Level {
        Level::Status
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame else { return };
        let FrameStatistics { encode, frames_per_second: shown, slow } = canvas.figures;
        let status = Status {
            cells: canvas.grid.size(),
            sampling: frame.sampling,
            trace: frame.trace,
            encode,
            shown,
            rays: frame.cost.rays,
            slow,
            eye: frame.camera().pose().eye,
        };
        if canvas.status_rows > 1 {
            let keys = help::status_line(canvas.keymap, canvas.modes, canvas.screen().width.into());
            canvas.write_line(&keys, canvas.foot(1));
        }
        canvas.write_line(&status.text(), canvas.foot(0));
    }
}

/// The statistics in the status line.
struct Status {
    cells: Size,
    sampling: Sampling,
    /// Time that tracing took.
    trace: Duration,
    /// Time that making the cells and bytes took.
    encode: Duration,
    /// Frames shown per second, while something moves.
    shown: Option<f32>,
    rays: u64,
    /// The rate of the link in bytes per second, if it is slow.
    slow: Option<f64>,
    eye: Vec3,
}

impl Status {
    fn text(&self) -> String {
        let Self { cells, eye, .. } = self;
        let shown = self.shown.map_or_else(|| "-".to_owned(), |fps| format!("{fps:.0}"));
        // Shows what limits the frame rate: the rate of a slow link, otherwise the times for tracing and encoding.
        let stages = match self.slow {
            Some(rate) => format!("slow link {}B/s", short_number(rate)),
            None => {
                format!(
                    "trace {} encode {}",
                    short_number(per_second(1.0, self.trace)),
                    short_number(per_second(1.0, self.encode))
                )
            }
        };
        format!(
            " {}x{}x{}  {} rays/s  {stages} shown {shown} fps  eye {:.2} {:.2} {:.2}",
            cells.columns,
            cells.rows,
            samples_text(self.sampling),
            short_number(per_second(self.rays as f64, self.trace)),
            eye.x,
            eye.y,
            eye.z,
        )
    }
}

/// Returns the samples per pixel as text: `1/4` if coarse, otherwise the (greatest) number.
fn samples_text(sampling: Sampling) -> String {
    match sampling {
        // A coarse picture has one ray for 2x2 pixels.
        Sampling::Coarse => "1/4".to_owned(),
        Sampling::Each(samples) | Sampling::UpTo(samples) => samples.to_string(),
    }
}

fn per_second(count: f64, time: Duration) -> f64 {
    // A frame of a few pixels may take no measurable time.
    count / time.as_secs_f64().max(1e-9)
}

/// Formats a number with two or three digits and a unit prefix, such as 812, 3.9k or 12M.
fn short_number(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    if value >= 10.0 { format!("{value:.0}{unit}") } else { format!("{value:.1}{unit}") }
}
