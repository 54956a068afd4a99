//! The inset of the explanation: a drawing of the eye, view rectangle, ray and hit from the side,
//! as in the lecture.

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
use ratatui_core::text::{Line as Text, Span};
use ratatui_core::widgets::Widget;
use ratatui_widgets::canvas::{Canvas, Circle, Line};
use ratatui_widgets::paragraph::Paragraph;

/// The geometry of the drawing, projected onto the plane through the eye along -w and v.
///
/// Coordinates are distances from the eye along -w (the view direction) and v (up), in world units.
pub(super) struct Inset {
    /// The lower and upper end of the view rectangle, which is seen edge-on.
    rectangle: [Vec2; 2],
    /// The point where the ray passes through the view rectangle.
    q: Vec2,
    /// The end of the ray: its hit, or a point far away.
    end: Vec2,
    /// Whether the ray hits anything.
    has_hit: bool,
    /// The center and radius of the sphere that the ray hits, if it hits one.
    sphere: Option<(Vec2, f32)>,
    /// The end of the line from the hit to each light, and whether the light reaches the hit.
    lights: Vec<(Vec2, bool)>,
}

/// Length at which a ray without a hit is drawn, as a multiple of the distance from the eye to the
/// target.
// A length above 1 makes the ray visibly pass the scene.
const MISS_LENGTH: f32 = 1.5;

/// Distance from the eye at which the view rectangle is drawn, as a share of the ray's length.
///
/// The distance is free, because only the ratio of the rectangle's sides to its distance matters for the rays.
const VIEW_RECTANGLE_DISTANCE: f32 = 0.3;

impl Inset {
    pub(super) fn for_explanation(scene: &Scene, camera: &Camera, explanation: &Explanation) -> Self {
        let (Basis { v, w, .. }, eye) = (camera.basis(), explanation.ray.origin);
        let from_side = |point: Vec3| Vec2::new((eye - point).dot(w), (point - eye).dot(v));
        let shaded = explanation.hit.as_ref();
        let pose = camera.pose();
        let t = shaded.map_or_else(|| MISS_LENGTH * pose.eye.distance(pose.target), |shaded| shaded.hit.t);
        let rays = camera.eye_rays(explanation.resolution.aspect_ratio());
        let near = VIEW_RECTANGLE_DISTANCE * t;
        // Only spheres are drawn, because their outline is the same circle from every side.
        let sphere = shaded.and_then(|shaded| shaded.hit.surface(scene).silhouette_sphere());
        let sphere = sphere.map(|(center, radius)| (from_side(center), radius));
        let lights = shaded.map_or(Vec::new(), |shaded| {
            // For a light at infinity, the line to it is drawn as long as the ray, in the light's direction.
            let far = |lit: &LightContribution| shaded.point.position + lit.incidence.l * t;
            let end =
                |(light, lit): (&Light, &LightContribution)| from_side(light.position().unwrap_or_else(|| far(lit)));
            let ends = scene.lights().iter().zip(&shaded.lights).map(end);
            ends.zip(&shaded.lights).map(|(end, lit)| (end, lit.is_lit())).collect()
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

    /// Draws the inset into `area`, with the same scale in both directions.
    pub(super) fn draw(&self, theme: Theme, mode: CellMode, resolution: Resolution, area: Rect, buffer: &mut Buffer) {
        if area.is_empty() {
            return;
        }
        let foot = Rect { y: area.bottom() - 1, height: 1, ..area };
        Paragraph::new(self.legend(mode.colors)).style(theme.style()).render(foot, buffer);
        let area = Rect { height: area.height - 1, ..area };
        let (across, down) = mode.pixels_per_cell();
        let cell_aspect = resolution.pixel_aspect() * down as f32 / across as f32;
        let [x, y] = self.drawn_ranges(f32::from(area.width), f32::from(area.height) * cell_aspect);
        // Braille, because its dots are square at the usual cell aspect of 2, and half blocks are too coarse for lines.
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
            // Each colour has its own canvas layer, because all dots of a layer in one cell share the cell's colour.
            canvas.layer();
            canvas.draw(&line(self.rectangle[0], self.rectangle[1], Color::LightCyan));
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

    /// Returns the legend: the meaning of the letters and, if there are colours, of the lines.
    fn legend(&self, colors: Colors) -> Text<'static> {
        let lit = self.lights.iter().any(|&(_, is_seen)| is_seen);
        let hidden = self.lights.iter().any(|&(_, is_seen)| !is_seen);
        let has_colors = colors != Colors::None;
        let words = [
            (true, "o eye", Color::Reset),
            (true, "q rectangle", Color::LightCyan),
            (self.has_hit, "p hit", Color::Reset),
            (has_colors && lit, "lit", Color::LightYellow),
            (has_colors && hidden, "shadow", Color::DarkGray),
        ];
        let words = words.into_iter().filter(|&(is_shown, ..)| is_shown);
        let spans = words.flat_map(|(_, word, color)| {
            let style = if has_colors && color != Color::Reset { Style::new().fg(color) } else { Style::new() };
            [Span::styled(word, style), Span::raw(" ")]
        });
        spans.collect()
    }

    /// Returns the ranges of x and y to draw, in world units.
    ///
    /// `width` and `height` are those of the area, in units of a cell's width. The eye, the view rectangle and the ray
    /// are in the middle of the ranges, with a margin.
    fn drawn_ranges(&self, width: f32, height: f32) -> [[f64; 2]; 2] {
        // Spheres and lights may lie outside: including a distant one would shrink the ray to a dot.
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
