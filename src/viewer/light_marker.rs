//! A marker over the picture at the position of the held light, since point lights are invisible.

use super::frame::Frame;
use super::layers::{Canvas, Layer, LayerLevel};
use super::lines::{clipped_to_front, range_in_box};
use crate::camera::Camera;
use crate::control::KeyMode;
use glam::{Vec2, Vec3};
use ratatui_core::layout::Rect;

/// The layer that marks the position of the held light.
#[derive(PartialEq)]
pub(super) struct LightMarker {
    /// The light's position in world space.
    pub(super) light: Vec3,
    /// The surface point straight below the light, if there is one.
    // The line down to this point shows how far away the light is, which the marker alone does not.
    pub(super) below: Option<Vec3>,
}

impl Layer for LightMarker {
    fn level(&self) -> LayerLevel {
        LayerLevel::Mark
    }

    fn mode(&self, _screen: Rect) -> Option<KeyMode> {
        Some(KeyMode::Light)
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame else { return };
        let (screen, camera) = (canvas.screen(), frame.camera());
        let picture = PictureOnScreen::of(frame, screen);
        let line = self.below.map_or_else(Vec::new, |below| picture.line(camera, self.light, below));
        // The marks are ASCII, so that every terminal can show them. A small screen has no room for the line.
        let dots = line.into_iter().filter(|_| canvas.has_room()).map(|dot| (".".to_owned(), dot));
        let mut marks: Vec<_> = dots.collect();
        // The lowest rows may be covered by the status line and notes.
        let free = Rect { height: screen.height.saturating_sub(canvas.status_rows.max(1)), ..screen };
        marks.push(match picture.cell_of(camera, self.light) {
            Some(cell) if picture.contains(cell) => ("(*)".to_owned(), centred_area(screen, cell, 3)),
            _ => picture.arrow(camera, self.light, free),
        });
        for (text, area) in marks.into_iter().filter(|(_, area)| !area.is_empty()) {
            canvas.lay(area, |theme, area, buffer| {
                buffer.set_stringn(area.x, area.y, text, area.width.into(), theme.mark());
            });
        }
    }
}

/// The picture that a marker is on: of two maps side by side the left one.
pub(super) struct PictureOnScreen {
    aspect_ratio: f32,
    /// The size of the picture in cells.
    cells: Vec2,
    screen: Rect,
}

impl PictureOnScreen {
    pub(super) fn of(frame: &Frame, screen: Rect) -> Self {
        let (part, _) = frame.part_at([0, 0]);
        let columns = f32::from(screen.width) * part.width() as f32 / frame.resolution().width() as f32;
        Self { aspect_ratio: part.aspect_ratio(), cells: Vec2::new(columns, screen.height.into()), screen }
    }

    pub(super) fn contains(&self, cell: Vec2) -> bool {
        cell.cmpge(Vec2::ZERO).all() && cell.cmplt(self.cells).all()
    }

    /// Returns the column and row of a point, or `None` if it is behind the eye.
    pub(super) fn cell_of(&self, camera: &Camera, point: Vec3) -> Option<Vec2> {
        Some(camera.project(point, self.aspect_ratio)? * self.cells)
    }

    /// Returns an arrow at the edge towards a light outside the picture, with its distance from the
    /// eye, and its area.
    fn arrow(&self, camera: &Camera, light: Vec3, free: Rect) -> (String, Rect) {
        let (basis, way) = (camera.rectangle_basis(), light - camera.pose().eye);
        let middle = 0.5 * self.cells;
        let (towards, behind) = match self.cell_of(camera, light) {
            Some(cell) => (cell - middle, ""),
            // Cells are about twice as high as wide.
            None => (Vec2::new(2.0 * way.dot(basis.u), -way.dot(basis.v)), " behind"),
        };
        let [across, down] = [middle.x / towards.x.abs(), middle.y / towards.y.abs()];
        let distance = way.length();
        // From 99.95 on, the distance is rounded to 100 or more, and is shown without a decimal.
        let distance = if distance < 99.95 { format!("{distance:.1}") } else { format!("{distance:.0}") };
        let text = match (across < down, towards.x < 0.0, towards.y < 0.0) {
            (true, true, _) => format!("< {distance}{behind}"),
            (true, false, _) => format!("{distance}{behind} >"),
            (false, _, true) => format!("^ {distance}{behind}"),
            (false, _, false) => format!("v {distance}{behind}"),
        };
        let cell = middle + towards * across.min(down).min(f32::MAX);
        let area = centred_area(free, cell, text.len() as u16);
        (text, area)
    }

    /// Returns the cells of a dotted line between two points, as areas on the screen.
    fn line(&self, camera: &Camera, from: Vec3, to: Vec3) -> Vec<Rect> {
        let ends = clipped_to_front(camera, [from, to]).map(|ends| ends.map(|end| self.cell_of(camera, end)));
        let Some([Some(from), Some(to)]) = ends else { return Vec::new() };
        let Some([first, last]) = range_in_box([from, to], self.cells) else { return Vec::new() };
        let [from, to] = [first, last].map(|share| from + share * (to - from));
        // Places a dot in every second cell, starting at the surface point.
        let share = 2.0 / (to - from).abs().max_element().max(1.0);
        let dot = |at: u16| {
            let cell = to.lerp(from, share * f32::from(at));
            Rect::new(cell.x as u16, cell.y as u16, 1, 1).intersection(self.screen)
        };
        (0..=(1.0 / share) as u16).map(dot).filter(|dot| !dot.is_empty()).collect()
    }
}

/// Returns the area of a mark of this width centred at a column and row, moved into `screen` if it
/// would be outside.
pub(super) fn centred_area(screen: Rect, cell: Vec2, width: u16) -> Rect {
    let within = |at: f32, size: u16, of: u16| at.clamp(0.0, f32::from(of.saturating_sub(size))) as u16;
    let x = within(cell.x.floor() - f32::from(width / 2), width, screen.width);
    Rect { x, y: within(cell.y, 1, screen.height), width, height: 1 }.intersection(screen)
}

#[cfg(all(test, unit_tests))]
mod tests;
