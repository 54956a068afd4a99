//! Textures of meshes, and pictures on other surfaces.

#[cfg(feature = "mesh")]
mod decoded;

#[cfg(feature = "mesh")]
pub(crate) use decoded::TextureDecoder;
#[cfg(feature = "mesh")]
pub(super) use decoded::{TexelBudget, decode};

use crate::color::{LinearRgb, Srgb8};
use glam::{Vec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// A decoded image: 8-bit sRGB texels, with or without an opacity each.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    width: u32,
    height: u32,
    texels: Vec<Srgb8>,
    /// The opacities of the texels, from 0 to 255; empty if the image has none.
    opacities: Vec<u8>,
    /// Whether the file of the image has opacities, be they all 1.
    has_opacities: bool,
}

/// The colour of an image beyond one of its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image is repeated.
    #[default]
    Repeat,
    /// The image is repeated, every other time as its mirror image.
    Mirror,
    /// The colour of the edge.
    Clamp,
}

/// The way in which the colour of an image is found between and beyond its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampler {
    /// The colours beyond the edges in u and v.
    pub wrap: [Wrap; 2],
    /// Whether the colour is that of the nearest texel, without interpolation.
    pub is_nearest: bool,
}

/// A texture and its placement on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct TexturePlacement {
    /// The image that is placed on the surface.
    // Shared by the materials that show parts of it.
    pub texture: Arc<Texture>,
    /// The transform from the mesh's texture coordinates (u, v) to the image's (u', v'): the dot
    /// products of the two vectors with (u, v, 1). All numbers are finite.
    pub transform: [Vec3; 2],
    /// The way in which colours are found in the image.
    pub sampler: Sampler,
}

impl TexturePlacement {
    /// Returns the image coordinates for the mesh's texture coordinates: (0, 0) is the image's top
    /// left corner, (1, 1) the bottom right one.
    pub fn at(&self, uv: Vec2) -> Vec2 {
        let uv1 = uv.extend(1.0);
        Vec2::new(self.transform[0].dot(uv1), self.transform[1].dot(uv1))
    }

    /// Returns the colour for the mesh's texture coordinates as linear light.
    pub fn color_at(&self, uv: Vec2) -> LinearRgb {
        self.texture.sample(self.at(uv), self.sampler)
    }

    /// Returns the opacity for the mesh's texture coordinates, from 0 to 1.
    pub fn opacity_at(&self, uv: Vec2) -> f32 {
        self.texture.sample_opacity(self.at(uv), self.sampler)
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
        self.sample(at, Sampler::default())
    }

    /// Returns the colour at image coordinates as linear light, found in the way of `sampler`.
    pub(crate) fn sample(&self, at: Vec2, sampler: Sampler) -> LinearRgb {
        let Neighbours { texels, right, down } = self.neighbours(at, sampler);
        let [top, bottom] = texels.map(|row| {
            let [left, next] = row.map(|texel| LinearRgb::from_srgb8(self.texels[texel]));
            left.lerp(next, right)
        });
        top.lerp(bottom, down)
    }

    /// Returns the opacity at image coordinates, from 0 to 1, found in the way of `sampler`.
    pub(crate) fn sample_opacity(&self, at: Vec2, sampler: Sampler) -> f32 {
        if self.opacities.is_empty() {
            return 1.0;
        }
        let Neighbours { texels, right, down } = self.neighbours(at, sampler);
        let lerp = |from: f32, to: f32, share: f32| from * (1.0 - share) + to * share;
        let [top, bottom] = texels.map(|row| {
            let [left, next] = row.map(|texel| f32::from(self.opacities[texel]) / 255.0);
            lerp(left, next, right)
        });
        lerp(top, bottom, down)
    }

    /// Returns the four texels whose centres are around image coordinates.
    fn neighbours(&self, at: Vec2, Sampler { wrap, is_nearest }: Sampler) -> Neighbours {
        let place = |coordinate: f32, length: u32, wrap: Wrap| {
            let (texels, share) = wrap.texels(coordinate, length);
            (texels, if is_nearest { f32::from(u8::from(share >= 0.5)) } else { share })
        };
        let (columns, right) = place(at.x, self.width, wrap[0]);
        let (rows, down) = place(at.y, self.height, wrap[1]);
        let texels = rows.map(|y| columns.map(|x| (y * self.width + x) as usize));
        Neighbours { texels, right, down }
    }

    /// Returns whether any texel has an opacity below 1.
    pub fn is_transparent(&self) -> bool {
        !self.opacities.is_empty()
    }

    /// Returns the largest opacity of a texel, from 0 to 1.
    pub(super) fn largest_opacity(&self) -> f32 {
        self.opacities.iter().max().map_or(1.0, |&largest| f32::from(largest) / 255.0)
    }

    /// Returns the image whose opacities this image gives: its own, or else the lightnesses of its
    /// texels.
    ///
    /// # Errors
    /// If the budget has too few texels for a copy; the error is a message without its subject.
    #[cfg(feature = "mesh")]
    pub(super) fn as_mask(self: &Arc<Self>, budget: &mut TexelBudget) -> Result<Arc<Self>, String> {
        if self.has_opacities {
            return Ok(Arc::clone(self));
        }
        budget.spend(self.width as usize, self.height as usize)?;
        let lightness =
            |&Srgb8 { r, g, b }: &Srgb8| ((54 * u32::from(r) + 183 * u32::from(g) + 19 * u32::from(b)) >> 8) as u8;
        let mut opacities: Vec<_> = self.texels.iter().map(lightness).collect();
        if opacities.iter().all(|&opacity| opacity == u8::MAX) {
            opacities.clear();
        }
        Ok(Arc::new(Self { opacities, has_opacities: true, ..Self::clone(self) }))
    }

    /// Returns the texels row by row, from the top left one.
    pub fn texels(&self) -> &[Srgb8] {
        &self.texels
    }
}

/// Four texels around a point, by their indices, and the point's place between them.
struct Neighbours {
    /// The upper and the lower row, each from left to right.
    texels: [[usize; 2]; 2],
    /// The share of the right column, and of the lower row.
    right: f32,
    down: f32,
}

impl Wrap {
    /// Returns the two texels of a row or column of `length` texels whose centres are nearest to a
    /// coordinate, and the share of the second one.
    fn texels(self, coordinate: f32, length: u32) -> ([u32; 2], f32) {
        // Beyond the range of numbers there are no texels to tell apart, and infinity less infinity is no colour.
        let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
        let within = match self {
            Self::Repeat => coordinate - coordinate.floor(),
            // The distance to the nearest even number, of which the image begins.
            Self::Mirror => (coordinate - 2.0 * (0.5 * coordinate + 0.5).floor()).abs(),
            Self::Clamp => coordinate.clamp(0.0, 1.0),
        };
        // The centre of texel `i` is at (i + 0.5) / length, hence the 0.5.
        let place = within * length as f32 - 0.5;
        let first = place.floor();
        let texels = if self == Self::Repeat {
            // The texel before the first one is the last one.
            let index = (first as i64).rem_euclid(length.into()) as u32;
            [index, (index + 1) % length]
        } else {
            let last = i64::from(length) - 1;
            [first as i64, first as i64 + 1].map(|index| index.clamp(0, last) as u32)
        };
        (texels, place - first)
    }
}

/// Shows the size only: millions of texels would be unreadable.
impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Texture({} x {})", self.width, self.height)
    }
}
