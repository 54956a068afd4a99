//! A marker over the picture at the position of the held light, since point lights are invisible.

use super::frame::Frame;
use super::layers::{Canvas, Layer, Level};
use super::theme::Theme;
use crate::control::KeyMode;
use glam::Vec3;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;

/// The marker of a light at this position in world space.
#[derive(PartialEq)]
pub(super) struct LightMarker(pub(super) Vec3);

impl Layer for LightMarker {
    fn level(&self) -> Level {
        Level::Mark
    }

    fn mode(&self, _screen: Rect) -> Option<KeyMode> {
        Some(KeyMode::Light)
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if let Some(area) = canvas.frame.and_then(|frame| marker_area(self.0, frame, screen)) {
            canvas.lay(area, draw);
        }
    }
}

/// Returns the area of a light's marker on the screen, or `None` if the light is behind the eye.
///
/// With two maps side by side, the marker is on the left one.
fn marker_area(light: Vec3, frame: &Frame, screen: Rect) -> Option<Rect> {
    let (part, _) = frame.part_at([0, 0]);
    let place = frame.camera().project(light, part.aspect_ratio())?;
    let columns = f32::from(screen.width) * part.width() as f32 / frame.resolution().width() as f32;
    Some(centred_area(screen, place.x * columns, place.y * f32::from(screen.height)))
}

// The marker is ASCII, so that every terminal can show it.
const MARKER: &str = "(*)";
const MARKER_WIDTH: u16 = MARKER.len() as u16;

/// Returns the area of a marker centred at a column and row, moved onto the screen if it would be
/// outside.
fn centred_area(screen: Rect, column: f32, row: f32) -> Rect {
    let within = |at: f32, size: u16, of: u16| at.clamp(0.0, f32::from(of.saturating_sub(size))) as u16;
    let x = within(column.floor() - f32::from(MARKER_WIDTH / 2), MARKER_WIDTH, screen.width);
    Rect { x, y: within(row, 1, screen.height), width: MARKER_WIDTH, height: 1 }.intersection(screen)
}

fn draw(theme: Theme, area: Rect, buffer: &mut Buffer) {
    buffer.set_stringn(area.x, area.y, MARKER, area.width.into(), theme.mark());
}

#[cfg(all(test, unit_tests))]
mod tests;
