//! A mark over the picture where something is that cannot be seen: a light.

use super::frame::Frame;
use super::layers::{Canvas, Layer, Level};
use super::look::Look;
use crate::control::Mode;
use glam::Vec3;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;

/// The light that is held, and where it is.
#[derive(PartialEq)]
pub(super) struct LightMark(pub(super) Vec3);

impl Layer for LightMark {
    fn level(&self) -> Level {
        Level::Mark
    }

    fn mode(&self, _screen: Rect) -> Option<Mode> {
        Some(Mode::Light)
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if let Some(place) = canvas.frame.and_then(|frame| place(self.0, frame, screen)) {
            canvas.lay(place, draw);
        }
    }
}

/// Where the mark of a light is over a frame: in the left one of two pictures.
fn place(light: Vec3, frame: &Frame, screen: Rect) -> Option<Rect> {
    let (part, _) = frame.part_at([0, 0]);
    let place = frame.camera().project(light, part.aspect_ratio())?;
    let columns = f32::from(screen.width) * part.width() as f32 / frame.resolution().width() as f32;
    Some(area(screen, place.x * columns, place.y * f32::from(screen.height)))
}

const MARK: &str = "(*)";
const WIDTH: u16 = MARK.len() as u16;

/// The cells of a mark whose middle is in that column and row of the screen, or as near to them as there is room.
fn area(screen: Rect, column: f32, row: f32) -> Rect {
    let within = |at: f32, size: u16, of: u16| at.clamp(0.0, f32::from(of.saturating_sub(size))) as u16;
    let x = within(column.floor() - f32::from(WIDTH / 2), WIDTH, screen.width);
    Rect { x, y: within(row, 1, screen.height), width: WIDTH, height: 1 }.intersection(screen)
}

fn draw(look: Look, area: Rect, buffer: &mut Buffer) {
    buffer.set_stringn(area.x, area.y, MARK, area.width.into(), look.mark());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_on_the_screen_and_around_its_place() {
        let screen = Rect::new(0, 0, 40, 12);
        assert_eq!(area(screen, 20.5, 6.5), Rect::new(19, 6, 3, 1));
        assert_eq!(area(screen, -1e30, 1e30), Rect::new(0, 11, 3, 1));
        assert_eq!(area(screen, 1e30, -0.1), Rect::new(37, 0, 3, 1));
        for size in 0..4 {
            let small = Rect::new(0, 0, size, size);
            assert!(small.union(area(small, 1.0, 1.0)) == small, "{size}");
        }
    }
}
