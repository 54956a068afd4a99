//! Materials of mesh files.

use super::TexturePlacement;
use crate::color::LinearRgb;
use glam::Vec2;

/// The material of a triangle as in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMaterial {
    /// The diffuse reflectance, linear, each channel in 0..=1.
    pub reflectance: LinearRgb,
    /// The texture that the reflectance is multiplied by.
    pub texture: Option<TexturePlacement>,
    /// The holes of the surface: the opacity, and the cutoff below which there is a hole.
    pub holes: Option<(Opacity, f32)>,
    /// The opacity by which the surface is blended with what is behind it.
    pub blended: Option<Opacity>,
    /// The light that the surface sends out.
    pub emission: Option<Emission>,
}

/// The opacity of a surface, in 0..=1.
#[derive(Clone, Debug, PartialEq)]
pub struct Opacity {
    /// The factor of the texture's opacities.
    pub factor: f32,
    /// The texture.
    pub texture: Option<TexturePlacement>,
}

/// The light that a surface sends out, per channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// The factor of the texture's colours, finite and not negative.
    pub light: LinearRgb,
    /// The texture.
    pub texture: Option<TexturePlacement>,
}

/// The materials of a mesh, and what is found in any of them.
// The answers are kept, as they are asked for at each hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MeshMaterials {
    all: Vec<MeshMaterial>,
    /// Whether a material has holes.
    pub(super) has_holes: bool,
    /// Whether a material is blended with what is behind it.
    pub(super) is_blended: bool,
    /// Whether a material sends out light.
    pub(super) has_emission: bool,
}

impl From<Vec<MeshMaterial>> for MeshMaterials {
    fn from(all: Vec<MeshMaterial>) -> Self {
        Self {
            has_holes: all.iter().any(|material| material.holes.is_some()),
            is_blended: all.iter().any(|material| material.blended.is_some()),
            has_emission: all.iter().any(|material| material.emission.is_some()),
            all,
        }
    }
}

impl MeshMaterials {
    /// Returns the materials in the order of the file.
    pub(super) fn all(&self) -> &[MeshMaterial] {
        &self.all
    }
}

impl MeshMaterial {
    /// Returns an opaque material that sends out no light.
    #[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers make materials"))]
    pub(super) fn opaque(reflectance: LinearRgb, texture: Option<TexturePlacement>) -> Self {
        Self { reflectance, texture, holes: None, blended: None, emission: None }
    }

    /// Returns whether the surface has a hole at texture coordinates.
    pub(crate) fn has_hole(&self, uv: Option<Vec2>) -> bool {
        self.holes.as_ref().is_some_and(|(opacity, cutoff)| opacity.at(uv) < *cutoff)
    }

    /// Returns the opacity at texture coordinates by which the surface is blended.
    pub(crate) fn opacity(&self, uv: Option<Vec2>) -> f32 {
        self.blended.as_ref().map_or(1.0, |opacity| opacity.at(uv))
    }

    /// Returns the light that the surface sends out at texture coordinates.
    pub(crate) fn emitted(&self, uv: Option<Vec2>) -> LinearRgb {
        let Some(Emission { light, texture }) = &self.emission else { return LinearRgb::BLACK };
        match (texture, uv) {
            (Some(texture), Some(uv)) => *light * texture.color_at(uv),
            _ => *light,
        }
    }

    /// Returns whether the surface is seen nowhere: a hole everywhere, or blended with opacity 0.
    ///
    /// `is_charted` tells whether the mesh has texture coordinates.
    #[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers tell of materials"))]
    pub(super) fn is_invisible(&self, is_charted: bool) -> bool {
        let is_hole = |(opacity, cutoff): &(Opacity, f32)| opacity.largest(is_charted) < *cutoff;
        self.holes.as_ref().is_some_and(is_hole)
            || self.blended.as_ref().is_some_and(|opacity| opacity.largest(is_charted) <= 0.0)
    }

    /// Checks the invariants of the type.
    pub(super) fn is_valid(&self) -> bool {
        let is_share = |share: f32| (0.0..=1.0).contains(&share);
        let is_amount = |amount: f32| (0.0..=MAX_EMISSION).contains(&amount);
        let LinearRgb { r, g, b } = self.reflectance;
        [r, g, b].into_iter().all(is_share)
            && self.holes.as_ref().is_none_or(|(opacity, cutoff)| is_share(opacity.factor) && cutoff.is_finite())
            && self.blended.as_ref().is_none_or(|opacity| is_share(opacity.factor))
            && self
                .emission
                .as_ref()
                .is_none_or(|&Emission { light: LinearRgb { r, g, b }, .. }| [r, g, b].into_iter().all(is_amount))
    }
}

/// The most light that a surface sends out, per channel.
// As the light of scenes, so that sums with the exposure stay finite.
pub(super) const MAX_EMISSION: f32 = 1e12;

impl Opacity {
    /// Returns whether the opacity is below a limit of at most 1 anywhere.
    // Programs write opaque surfaces as transparent ones, too, which would take longer to draw.
    #[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers make materials"))]
    pub(super) fn may_be_below(&self, limit: f32) -> bool {
        self.factor < limit || self.texture.as_ref().is_some_and(|texture| texture.texture.is_transparent())
    }

    /// Returns the largest opacity anywhere, with or without texture coordinates.
    fn largest(&self, is_charted: bool) -> f32 {
        let texture = self.texture.as_ref().filter(|_| is_charted);
        self.factor * texture.map_or(1.0, |placement| placement.texture.largest_opacity())
    }

    /// Returns the opacity at texture coordinates; the factor where there are none.
    fn at(&self, uv: Option<Vec2>) -> f32 {
        match (&self.texture, uv) {
            (Some(texture), Some(uv)) => self.factor * texture.opacity_at(uv),
            _ => self.factor,
        }
    }
}
