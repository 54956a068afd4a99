//! The panel of metadata about a scene or mesh, such as its size, in the upper left corner.

use super::layers::{Canvas, Layer, LayerLevel};
use crate::scene::Scene;
use crate::shape::Shape;
use crate::text::number;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use unicode_width::UnicodeWidthStr;

/// The panel of metadata, as lines of text.
pub(super) struct Metadata(Vec<String>);

impl Metadata {
    /// Returns the panel about `scene`, whose name is `name`.
    pub(super) fn for_scene(scene: &Scene, name: String) -> Self {
        let mut lines = vec![name];
        let meshes = || {
            scene
                .objects()
                .iter()
                .filter_map(|object| if let Shape::Mesh(mesh) = &object.shape { Some(mesh) } else { None })
        };
        let triangles: usize = meshes().map(|mesh| mesh.triangle_count() as usize).sum();
        if let Some(mesh) = scene.mesh() {
            lines.push(format!("format     {}", mesh.format));
        } else {
            lines.push(format!("objects    {}", grouped(scene.objects().len())));
            lines.push(format!("lights     {}", grouped(scene.lights().len())));
        }
        if triangles > 0 {
            lines.push(format!("triangles  {}", grouped(triangles)));
            lines.push(format!("vertices   {}", grouped(meshes().map(|mesh| mesh.file().positions().len()).sum())));
        }
        if let Some(seconds) = scene.animation_length() {
            lines.push(format!("animation  {} s", number(seconds as f32)));
        }
        if let Some(bounds) = scene.bounds() {
            // The size along the axes of the mesh file, before it was turned.
            let turn = scene.mesh().map_or(glam::Mat3::IDENTITY, |mesh| mesh.up.turn());
            let size = (turn.transpose() * bounds.extent()).abs();
            lines.push(format!("size       {} x {} x {}", number(size.x), number(size.y), number(size.z)));
        }
        if let Some(mesh) = scene.mesh() {
            let guess = if mesh.is_guess { " (a guess)" } else { "" };
            lines.push(format!("up         {}{guess}", mesh.up.name()));
        }
        Self(lines)
    }
}

impl Layer for Metadata {
    fn level(&self) -> LayerLevel {
        LayerLevel::Side
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if !canvas.has_room() {
            return;
        }
        let width = self.0.iter().map(|line| line.width() as u16).max().unwrap_or(0) + 4;
        let area = Rect { width, height: self.0.len() as u16 + 2, ..screen }.intersection(screen);
        canvas.lay(area, |theme, area, buffer| {
            Clear.render(area, buffer);
            Block::bordered().border_set(theme.border()).style(theme.style()).render(area, buffer);
            let lines: Vec<_> = self.0.iter().map(|line| Line::from(line.as_str())).collect();
            Paragraph::new(lines).style(theme.style()).render(area.inner(Margin::new(2, 1)), buffer);
        });
    }
}

/// Formats a number with commas between groups of three digits, such as `69,451`.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(all(test, unit_tests))]
mod tests;
