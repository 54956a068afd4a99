//! The view from the side, as the lecture draws it.
//!
//! Shows the eye, the view rectangle, the ray and its hit.

use crate::camera::{Basis, Camera};
use crate::capabilities::{CellMode, Colors};
use crate::explain::{Explanation, LightContribution};
use crate::framebuffer::Resolution;
use crate::light::Light;
use crate::scene::Scene;
use crate::viewer::theme::Theme;
use glam::{Vec2, Vec3};
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::{Color, Style};
use ratatui_core::symbols::Marker;
use ratatui_core::text::Line as Text;
use ratatui_core::widgets::Widget;
use ratatui_widgets::canvas::{Canvas, Circle, Line};

/// The drawing's geometry, in the plane of the view direction and the vertical.
///
/// Coordinates are lengths along -w and v from the eye.
pub(super) struct Inset {
    /// The ends of the view rectangle.
    rectangle: [Vec2; 2],
    /// The point where the ray passes through it.
    q: Vec2,
    /// The end of the ray: its hit, or a point far away.
    end: Vec2,
    /// Whether the ray hits anything.
    has_hit: bool,
    /// The sphere that is hit.
    sphere: Option<(Vec2, f32)>,
    /// The ways from there to the lights, and whether each light is visible.
    lights: Vec<(Vec2, bool)>,
}

/// Length of a ray without a hit, in distances of the eye from the target.
// Beyond the target, so that it is seen to pass the scene.
const MISS_LENGTH: f32 = 1.5;

/// Distance at which the view rectangle is drawn, as a share of the ray.
///
/// Only the ratios of its distance and sides matter, so it is drawn where it is easy to see.
const VIEW_RECTANGLE_DISTANCE: f32 = 0.3;

impl Inset {
    pub(super) fn of(scene: &Scene, camera: &Camera, explanation: &Explanation) -> Self {
        let (Basis { v, w, .. }, eye) = (camera.basis(), explanation.ray.origin);
        let from_side = |point: Vec3| Vec2::new((eye - point).dot(w), (point - eye).dot(v));
        let shaded = explanation.hit.as_ref();
        let pose = camera.pose();
        let t = shaded.map_or_else(|| MISS_LENGTH * pose.eye.distance(pose.target), |shaded| shaded.hit.t);
        let rays = camera.eye_rays(explanation.resolution.aspect_ratio());
        let near = VIEW_RECTANGLE_DISTANCE * t;
        let sphere = shaded.and_then(|shaded| shaded.hit.surface(scene).circle());
        let sphere = sphere.map(|(center, radius)| (from_side(center), radius));
        let lights = shaded.map_or(Vec::new(), |shaded| {
            // For a light at infinity its direction is drawn, as long as the ray.
            let far = |lit: &LightContribution| shaded.point.position + lit.incidence.l * t;
            let end =
                |(light, lit): (&Light, &LightContribution)| from_side(light.position().unwrap_or_else(|| far(lit)));
            let ends = scene.lights().iter().zip(&shaded.lights).map(end);
            ends.zip(&shaded.lights).map(|(end, lit)| (end, lit.faces() && lit.blocker.is_none())).collect()
        });
        Self {
            rectangle: [0.0, 1.0].map(|qv| from_side(rays.through(explanation.q.x, qv).at(near))),
            q: from_side(explanation.ray.at(near)),
            end: from_side(explanation.ray.at(t)),
            has_hit: shaded.is_some(),
            sphere,
            lights,
        }
    }

    /// Draws everything at one scale.
    pub(super) fn draw(&self, theme: Theme, mode: CellMode, resolution: Resolution, area: Rect, buffer: &mut Buffer) {
        if area.is_empty() {
            return;
        }
        let (across, down) = mode.pixels_per_cell();
        let cell_aspect = resolution.pixel_aspect() * down as f32 / across as f32;
        let [x, y] = self.bounds(f32::from(area.width), f32::from(area.height) * cell_aspect);
        // Braille dots are square at the usual cell aspect of 2, half blocks are too coarse for lines.
        let marker = if mode.glyphs.has_blocks() { Marker::Braille } else { Marker::Custom('*') };
        let ink = |color: Color| if mode.colors == Colors::None { Color::Reset } else { color };
        let line = |from: Vec2, to: Vec2, color: Color| {
            let [from, to] = [from, to].map(Vec2::as_dvec2);
            Line::new(from.x, from.y, to.x, to.y, ink(color))
        };
        let style = theme.style();
        let canvas = Canvas::default().marker(marker).x_bounds(x).y_bounds(y).paint(|canvas| {
            if let Some((center, radius)) = self.sphere {
                let center = center.as_dvec2();
                canvas.draw(&Circle::new(center.x, center.y, radius.into(), ink(Color::LightRed)));
            }
            for &(light, is_seen) in &self.lights {
                canvas.draw(&line(self.end, light, if is_seen { Color::LightYellow } else { Color::DarkGray }));
            }
            // A layer each, because dots of one layer share their cell's colour.
            canvas.layer();
            canvas.draw(&line(self.rectangle[0], self.rectangle[1], Color::LightBlue));
            canvas.draw(&line(Vec2::ZERO, self.end, Color::LightGreen));
            canvas.layer();
            let letter = |text: &'static str| Text::styled(text, Style::new().patch(style));
            for (at, name) in [(Vec2::ZERO, "o"), (self.q, "q"), (self.end, if self.has_hit { "p" } else { "" })] {
                canvas.print(at.x.into(), at.y.into(), letter(name));
            }
        });
        canvas.render(area, buffer);
        buffer.set_style(area, Style { fg: None, ..style });
    }

    /// Returns the part of the plane to draw in this much room.
    ///
    /// It contains everything but spheres and lights, centred, with a margin.
    fn bounds(&self, width: f32, height: f32) -> [[f64; 2]; 2] {
        // Spheres and lights are left out: one far away would shrink the ray to a dot.
        let points = [Vec2::ZERO, self.rectangle[0], self.rectangle[1], self.end];
        let min = points.into_iter().reduce(Vec2::min).unwrap_or_default();
        let max = points.into_iter().reduce(Vec2::max).unwrap_or_default();
        let (size, middle) = (max - min, 0.5 * (min + max));
        let scale = 1.15 * (size.x / width).max(size.y / height).max(f32::MIN_POSITIVE);
        let around = |middle: f32, room: f32| {
            let half = 0.5 * scale * room;
            [f64::from(middle - half), f64::from(middle + half)]
        };
        [around(middle.x, width), around(middle.y, height)]
    }
}
