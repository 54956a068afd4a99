//! A drawing of the directions of the x, y and z axes, in the upper right corner.

use super::layers::{Canvas, Layer, LayerLevel};
use crate::capabilities::Colors;
use glam::{Mat3, Vec3};
use ratatui_core::layout::Rect;
use ratatui_core::style::{Color, Style};

/// Length in columns of an axis that is parallel to the screen. In rows it is half, as a cell is
/// twice as high as wide.
const REACH: f32 = 5.0;
/// Number of cells that an axis is drawn with: dots, and the letter at its end.
const POINTS: u16 = 4;

/// The layer that draws the axes of the scene, or of a mesh file shown without a scene file.
pub(super) struct Axes;

impl Layer for Axes {
    fn level(&self) -> LayerLevel {
        LayerLevel::Mark
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame.filter(|_| canvas.has_room()) else { return };
        let basis = frame.camera().rectangle_basis();
        let turn = frame.scene.mesh().map_or(Mat3::IDENTITY, |mesh| mesh.up.turn());
        let has_colors = canvas.cell_mode.colors != Colors::None;
        let screen = canvas.screen();
        let middle = (f32::from(screen.right()) - REACH - 3.0, 0.5 * REACH + 1.5);
        let axes =
            [("x", Vec3::X, Color::LightRed), ("y", Vec3::Y, Color::LightGreen), ("z", Vec3::Z, Color::LightBlue)];
        let mut axes = axes.map(|(name, axis, color)| (name, turn * axis, color));
        // Axes that point towards the viewer are drawn last, over the others.
        axes.sort_by(|a, b| a.1.dot(basis.w).total_cmp(&b.1.dot(basis.w)));
        for (name, axis, color) in axes {
            let (across, down) = (REACH * axis.dot(basis.u), -0.5 * REACH * axis.dot(basis.v));
            for point in 1..=POINTS {
                let share = f32::from(point) / f32::from(POINTS);
                let (x, y) = (middle.0 + share * across, middle.1 + share * down);
                let cell = Rect { x: x as u16, y: y as u16, width: 1, height: 1 }.intersection(screen);
                let text = if point == POINTS { name } else { "." };
                canvas.lay(cell, |theme, area, buffer| {
                    let style = if has_colors { theme.style().fg(color) } else { Style::new() };
                    buffer.set_stringn(area.x, area.y, text, area.width.into(), style);
                });
            }
        }
    }
}
