//! Lines and letters at points of the scene, drawn over the picture in dots finer than cells.

use super::frame::Frame;
use super::layers::Canvas;
use crate::camera::Camera;
use crate::color::Srgb8;
use crate::framebuffer::Resolution;
use crate::grid::{Cell, Glyph, Ink};
use crate::hit::any_hit;
use crate::ray::{Interval, Ray};
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;

/// The number of Braille dots in a cell, across and down.
const DOTS: Vec2 = Vec2::new(2.0, 4.0);

/// Limit on the dots of a line: enough for a line across a screen of 2000 columns or 1000 rows.
const MAX_DOTS: f32 = 4000.0;

/// Share of the way from the eye to a point within which a surface hides the point.
// The interval ends before 1, because a point that lies on a surface must not be hidden by that surface.
pub(super) const HIDING_INTERVAL: Interval = Interval { min: 0.0, max: 0.99 };

/// Lines and letters to be drawn over a picture on the screen, as the picture's camera sees them.
pub(super) struct Plot<'f> {
    camera: Camera,
    aspect_ratio: f32,
    /// The upper left corner of the picture on the screen, in cells.
    corner: Vec2,
    /// The size of the picture, in cells.
    cells: Vec2,
    /// The scene whose surfaces hide lines.
    scene: Option<&'f Scene>,
    /// The colour of each cell with lines, and the bits of its dots.
    dots: BTreeMap<[u16; 2], (u8, u8)>,
    letters: Vec<([u16; 2], &'static str, u8)>,
}

impl<'f> Plot<'f> {
    /// Returns an empty plot over the part of the frame that starts at column `start` of its
    /// pixels.
    pub(super) fn new(canvas: &Canvas<'_>, camera: Camera, part: Resolution, start: u32) -> Self {
        let (across, down) = canvas.cell_mode.pixels_per_cell();
        let cells = Vec2::new(part.width() as f32 / across as f32, part.height() as f32 / down as f32);
        let corner = Vec2::new(start as f32 / across as f32, 0.0);
        let (dots, letters) = (BTreeMap::new(), Vec::new());
        Self { camera, aspect_ratio: part.aspect_ratio(), corner, cells, scene: None, dots, letters }
    }

    /// Returns an empty plot over the picture from outside, if the frame has one.
    pub(super) fn from_outside(canvas: &Canvas<'_>, frame: &'f Frame) -> Option<Self> {
        let camera = frame.shot.outside?;
        let [(_, left), (_, right)] = *frame.shot.layout.map_sizes(frame.resolution()) else { return None };
        let plot = Self::new(canvas, camera, right, left.width() + 1);
        Some(Self { scene: Some(&frame.scene), ..plot })
    }

    /// Sets the scene whose surfaces hide lines.
    #[cfg(feature = "serve")]
    pub(super) fn hidden_by(self, scene: &'f Scene) -> Self {
        Self { scene: Some(scene), ..self }
    }

    /// Returns the position of a point in the picture, in cells, or `None` if it is not in front of
    /// the eye.
    pub(super) fn place(&self, point: Vec3) -> Option<Vec2> {
        Some(self.camera.project(point, self.aspect_ratio)? * self.cells)
    }

    /// Adds a line, with two dots of three left out where a surface hides it.
    pub(super) fn line(&mut self, ends: [Vec3; 2], color: u8) {
        let Some([from, to]) = clipped_to_front(&self.camera, ends) else { return };
        let (Some(start), Some(end)) = (self.place(from), self.place(to)) else { return };
        let Some([first, last]) = range_in_box([start, end], self.cells) else { return };
        let (eye, w) = (self.camera.pose().eye, self.camera.rectangle_basis().w);
        // Perspective-correct interpolation: equal steps on the screen are equal steps in 1/depth.
        let [near, far] = [from, to].map(|point| 1.0 / (eye - point).dot(w));
        let count = ((last - first) * ((end - start) * DOTS).abs().max_element()).clamp(1.0, MAX_DOTS).ceil();
        for dot in 0..=count as u32 {
            let share = first + (last - first) * dot as f32 / count;
            let (a, b) = ((1.0 - share) * near, share * far);
            let point = (from * a + to * b) / (a + b);
            if dot % 3 == 0 || !self.is_hidden(point) {
                self.dot(start.lerp(end, share), color);
            }
        }
    }

    /// Adds a line between two positions in the picture, in cells.
    pub(super) fn segment(&mut self, [from, to]: [Vec2; 2], color: u8) {
        let count = ((to - from) * DOTS).abs().max_element().clamp(1.0, MAX_DOTS).ceil();
        for dot in 0..=count as u32 {
            self.dot(from.lerp(to, dot as f32 / count), color);
        }
    }

    fn is_hidden(&self, point: Vec3) -> bool {
        let origin = self.camera.pose().eye;
        self.scene.is_some_and(|scene| any_hit(scene, &Ray { origin, direction: point - origin }, HIDING_INTERVAL))
    }

    fn dot(&mut self, place: Vec2, color: u8) {
        // The bit of each Braille dot, by row and column from the upper left. Unicode numbers the three upper rows
        // first.
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        if place.cmplt(Vec2::ZERO).any() || place.cmpge(self.cells).any() {
            return;
        }
        let place = self.corner + place;
        let [x, y] = [place.x.floor(), place.y.floor()];
        let bit = BITS[(4.0 * (place.y - y)) as usize % 4][(2.0 * (place.x - x)) as usize % 2];
        let cell = self.dots.entry([x as u16, y as u16]).or_insert((color, 0));
        // A cell has a single glyph colour, so the line drawn last decides it.
        *cell = (color, cell.1 | bit);
    }

    /// Adds a letter at a point, if it is in the picture.
    pub(super) fn letter(&mut self, point: Vec3, text: &'static str, color: u8) {
        if let Some(place) = self.place(point)
            && place.cmpge(Vec2::ZERO).all()
            && place.cmplt(self.cells).all()
        {
            let place = self.corner + place;
            self.letters.push(([place.x as u16, place.y as u16], text, color));
        }
    }

    /// Draws the plot: its lines as Braille dots over the picture, and its letters over the lines.
    ///
    /// A cell with dots keeps the picture's colour as its background. Without block glyphs the dots are full stops.
    pub(super) fn draw(self, canvas: &mut Canvas<'_>) {
        let size = canvas.grid.size();
        let has_dots = canvas.cell_mode.glyphs.has_blocks();
        for ([x, y], (color, bits)) in self.dots {
            if x < size.columns && y < size.rows {
                let glyph = char::from_u32(0x2800 + u32::from(bits)).filter(|_| has_dots).unwrap_or('.');
                let background = background(&canvas.grid.cell(x, y));
                canvas.grid.put(x, y, &Cell::new(glyph, Ink::Indexed(color), background), 1);
            }
        }
        for ([x, y], text, color) in self.letters {
            let row = canvas.screen().intersection(ratatui_core::layout::Rect::new(x, y, text.len() as u16, 1));
            if !row.is_empty() {
                canvas.lay(row, |theme, area, buffer| {
                    let style = theme.mark().fg(ratatui_core::style::Color::Indexed(color));
                    buffer.set_stringn(area.x, area.y, text, area.width.into(), style);
                });
            }
        }
    }
}

/// Returns the colour of the background behind a glyph that replaces a cell of the picture.
fn background(cell: &Cell) -> Ink {
    match (cell.fg, cell.bg) {
        // Both colours of a cell of the picture cover a part of it, so neither alone is the picture's colour there.
        (Ink::Rgb(a), Ink::Rgb(b)) if cell.glyph != Glyph::Char(' ') => {
            let mean = |a: u8, b: u8| a.midpoint(b);
            Ink::Rgb(Srgb8::new(mean(a.r, b.r), mean(a.g, b.g), mean(a.b, b.b)))
        }
        (_, bg) => bg,
    }
}

/// Returns the part of a line that is in front of the eye.
pub(super) fn clipped_to_front(camera: &Camera, ends: [Vec3; 2]) -> Option<[Vec3; 2]> {
    let (eye, w) = (camera.pose().eye, camera.rectangle_basis().w);
    let depths = ends.map(|end| (eye - end).dot(w));
    // Lines are cut off at this depth, because nearer points are projected to huge columns and rows.
    let near = 1e-3 * depths[0].abs().max(depths[1].abs());
    let at_front = |behind: usize| {
        let (other, depth) = (1 - behind, depths[behind]);
        let share = (near - depth) / (depths[other] - depth);
        if depth < near { ends[behind].lerp(ends[other], share) } else { ends[behind] }
    };
    depths.iter().any(|&depth| depth > near).then(|| [at_front(0), at_front(1)])
}

/// Returns the part of a line inside the box from (0, 0) to `size`, as two shares of its length.
pub(super) fn range_in_box([from, to]: [Vec2; 2], size: Vec2) -> Option<[f32; 2]> {
    let way = to - from;
    let (mut first, mut last) = (0.0_f32, 1.0_f32);
    for (start, way, end) in [(from.x, way.x, size.x), (from.y, way.y, size.y)] {
        // A line parallel to two sides of the box never crosses them: it is between them or outside everywhere.
        if way == 0.0 && !(0.0..=end).contains(&start) {
            return None;
        }
        if way != 0.0 {
            let [a, b] = [-start / way, (end - start) / way];
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
    }
    (first <= last).then_some([first, last])
}

#[cfg(all(test, unit_tests))]
mod tests;
