//! Pictures on meshes: PNG and JPEG.

#[cfg(feature = "mesh")]
mod decoded;

#[cfg(feature = "mesh")]
pub(super) use decoded::{Budget, decode};

use crate::color::{LinearRgb, Srgb8};
use glam::{Vec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// A picture as its file has it: sRGB, 8 bits, without its transparency.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    width: u32,
    height: u32,
    texels: Vec<Srgb8>,
}

/// A texture and where it lies on a surface. It repeats without end.
#[derive(Clone, Debug, PartialEq)]
pub struct TexturePlacement {
    /// The picture.
    pub texture: Arc<Texture>,
    /// The way from the mesh's texture coordinates to the picture's: u' and v' are the dot products of these with
    /// (u, v, 1). Finite.
    pub transform: [Vec3; 2],
}

impl TexturePlacement {
    /// The picture's coordinates: (0, 0) is its top left corner, (1, 1) its bottom right one.
    pub fn at(&self, uv: Vec2) -> Vec2 {
        let uv1 = uv.extend(1.0);
        Vec2::new(self.transform[0].dot(uv1), self.transform[1].dot(uv1))
    }
}

impl Texture {
    /// Columns of texels; at least 1.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows of texels; at least 1.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The colour at these coordinates, as linear light: between the middles of four texels, each has its share
    /// (bilinear). Any coordinates; the picture repeats.
    pub fn color_at(&self, at: Vec2) -> LinearRgb {
        let place = |coordinate: f32, length: u32| {
            let place = (coordinate - coordinate.floor()) * length as f32 - 0.5;
            let first = place.floor();
            // The one before the first is the last.
            let index = (first as i64).rem_euclid(length.into()) as u32;
            ([index, (index + 1) % length], place - first)
        };
        let ((columns, right), (rows, down)) = (place(at.x, self.width), place(at.y, self.height));
        let row = |y: u32| {
            let [left, next] = columns.map(|x| LinearRgb::from_srgb8(self.texels[(y * self.width + x) as usize]));
            left.lerp(next, right)
        };
        row(rows[0]).lerp(row(rows[1]), down)
    }

    /// The texels row by row, from the top left one.
    pub fn texels(&self) -> &[Srgb8] {
        &self.texels
    }
}

/// Millions of texels say nothing to a person.
impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Texture({} x {})", self.width, self.height)
    }
}
