//! Textures of meshes.

#[cfg(feature = "mesh")]
mod decoded;

#[cfg(feature = "mesh")]
pub(super) use decoded::{TexelBudget, decode};

use crate::color::{LinearRgb, Srgb8};
use glam::{Vec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// A decoded image: 8-bit sRGB texels, without transparency.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    width: u32,
    height: u32,
    texels: Vec<Srgb8>,
}

/// A texture and its placement on a surface, over which the image repeats without end.
#[derive(Clone, Debug, PartialEq)]
pub struct TexturePlacement {
    /// The image that is placed on the surface.
    // Shared by the materials that show parts of it.
    pub texture: Arc<Texture>,
    /// The transform from the mesh's texture coordinates (u, v) to the image's (u', v'): the dot
    /// products of the two vectors with (u, v, 1). All numbers are finite.
    pub transform: [Vec3; 2],
}

impl TexturePlacement {
    /// Returns the image coordinates for the mesh's texture coordinates: (0, 0) is the image's top
    /// left corner, (1, 1) the bottom right one.
    pub fn at(&self, uv: Vec2) -> Vec2 {
        let uv1 = uv.extend(1.0);
        Vec2::new(self.transform[0].dot(uv1), self.transform[1].dot(uv1))
    }
}

impl Texture {
    /// Returns the number of columns, at least 1.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows, at least 1.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the colour at image coordinates as linear light, bilinearly interpolated between the
    /// centres of four texels. The image repeats beyond 0..1.
    pub fn color_at(&self, at: Vec2) -> LinearRgb {
        // The centre of texel `i` is at (i + 0.5) / length, hence the 0.5.
        let place = |coordinate: f32, length: u32| {
            let place = (coordinate - coordinate.floor()) * length as f32 - 0.5;
            let first = place.floor();
            // The image repeats: the texel before the first one is the last one.
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

    /// Returns the texels row by row, from the top left one.
    pub fn texels(&self) -> &[Srgb8] {
        &self.texels
    }
}

/// Shows the size only: millions of texels would be unreadable.
impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Texture({} x {})", self.width, self.height)
    }
}
