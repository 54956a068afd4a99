//! A survey of a picture: the part of it that each object covers, and the objects that each object
//! hides there.

use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::Resolution;
use crate::hit::closest_hit;
use crate::material::Material;
use crate::ray::Ray;
use crate::render::{Executor, GBufferSample, Sampling, TraceDepth, trace_g_buffer_partial};
use crate::scene::{OwnPoint, Scene};
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// The object that a pixel shows, and the objects behind it.
#[derive(Clone, Copy)]
struct PixelContent {
    object: u32,
    /// The distance from the eye to the hit, in world units.
    distance: f32,
    reflectance: LinearRgb,
    /// The objects that the pixel's ray hits behind `object`, nearest first.
    behind: [Option<u32>; MAX_OCCLUDED],
}

/// The part of the picture that an object covers: its number of pixels, its extent and its
/// distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Coverage {
    /// The number of pixels that show the object.
    pub(super) pixels: usize,
    /// The distance from the eye to the nearest visible point, in world units.
    pub(super) nearest: f32,
    /// The distance from the eye to the farthest visible point, in world units.
    pub(super) farthest: f32,
    /// The sum of the covered pixels' columns, and of their rows.
    sum: [u64; 2],
    /// The first covered column, and the one after the last.
    columns: [u32; 2],
    /// The first covered row, and the one after the last.
    rows: [u32; 2],
    /// The sum of the covered pixels' reflectances.
    reflectance: LinearRgb,
}

/// A rectangle in the picture, in shares of the picture's width and height, from the upper left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PictureRect {
    /// The mean position of the covered pixels, in shares of the picture's width and height.
    // The mean position is not the rectangle's centre, which a thin part that sticks out would move away from most
    // pixels.
    pub(super) middle: [f32; 2],
    /// The rectangle's width and height, in shares of the picture's width and height.
    pub(super) extent: [f32; 2],
}

impl Coverage {
    fn add(&mut self, content: &PixelContent, x: u32, y: u32) {
        if self.pixels == 0 {
            *self = Self { nearest: f32::MAX, columns: [x, x], rows: [y, y], ..Self::default() };
        }
        self.pixels += 1;
        self.nearest = self.nearest.min(content.distance);
        self.farthest = self.farthest.max(content.distance);
        self.sum[0] += u64::from(x);
        self.sum[1] += u64::from(y);
        self.columns = [self.columns[0].min(x), self.columns[1].max(x + 1)];
        self.rows = [self.rows[0].min(y), self.rows[1].max(y + 1)];
        self.reflectance += content.reflectance;
    }

    /// Returns the mean reflectance of the covered pixels; the default reflectance if there are
    /// none.
    pub(super) fn mean_reflectance(&self) -> LinearRgb {
        match self.pixels {
            0 => Material::DEFAULT_REFLECTANCE,
            pixels => self.reflectance * (1.0 / pixels as f32),
        }
    }

    /// Returns the rectangle around the covered pixels, in shares of the picture's sides.
    pub(super) fn covered_rect(&self, resolution: Resolution) -> PictureRect {
        let sides = [resolution.width(), resolution.height()].map(|side| side as f32);
        let middle = [0, 1].map(|axis| (self.sum[axis] as f32 / self.pixels as f32 + 0.5) / sides[axis]);
        let extent = [self.columns, self.rows].map(|[first, end]| (end - first) as f32);
        PictureRect { middle, extent: [extent[0] / sides[0], extent[1] / sides[1]] }
    }
}

/// Counts of a picture's pixels, from which its description is made.
pub(super) struct Survey {
    /// The coverage of each visible object, by the object's index.
    // In the order of the objects, so that texts do not depend on hashes.
    pub(super) covered: BTreeMap<u32, Coverage>,
    /// The number of pixels in which the first object is in front of the second.
    hides: BTreeMap<(u32, u32), usize>,
    /// The number of pixels without a hit.
    pub(super) background_pixels: usize,
    /// The number of all pixels of the picture.
    pub(super) pixels: usize,
}

impl Survey {
    pub(super) fn of_picture(scene: &Scene, camera: &Camera, resolution: Resolution) -> Self {
        let one = Sampling::Each(NonZeroU32::MIN);
        let see = |sample: &GBufferSample| pixel_content(scene, sample);
        let contents =
            trace_g_buffer_partial(Executor::Pool, scene, camera, resolution, one, TraceDepth::Surfaces, see).pixels;
        let mut survey =
            Self { covered: BTreeMap::new(), hides: BTreeMap::new(), background_pixels: 0, pixels: contents.len() };
        for (at, content) in (0..).zip(&contents) {
            let Some(content) = content else {
                survey.background_pixels += 1;
                continue;
            };
            let covered = survey.covered.entry(content.object).or_default();
            covered.add(content, at % resolution.width(), at / resolution.width());
            for behind in content.behind.into_iter().flatten() {
                *survey.hides.entry((content.object, behind)).or_default() += 1;
            }
        }
        survey
    }

    /// Returns the objects that `object` hides at least partly.
    pub(super) fn hidden_by(&self, object: u32) -> Vec<u32> {
        let of_object = self.hides.range((object, 0)..=(object, u32::MAX));
        of_object
            .filter(|&(&(_, behind), &pixels)| self.is_significant(behind, pixels))
            .map(|(&(_, behind), _)| behind)
            .collect()
    }

    /// Returns the objects that hide `object` at least partly.
    pub(super) fn hiding(&self, object: u32) -> Vec<u32> {
        let of_object = self
            .hides
            .iter()
            .filter(|&(&(_, behind), &pixels)| behind == object && self.is_significant(object, pixels));
        of_object.map(|(&(before, _), _)| before).collect()
    }

    /// Returns whether an object has enough hidden pixels to be mentioned.
    // A twentieth of the object's visible pixels suffices; fewer hidden pixels are usually single ones at edges.
    fn is_significant(&self, object: u32, hidden_pixels: usize) -> bool {
        20 * hidden_pixels >= self.covered.get(&object).map_or(0, |covered| covered.pixels)
    }
}

fn pixel_content(scene: &Scene, sample: &GBufferSample) -> Option<PixelContent> {
    let (hit, surface) = (sample.hit?, sample.surface(scene)?);
    let own = scene.objects()[hit.object as usize].own_reflectance(hit.primitive, &OwnPoint::from(&surface));
    Some(PixelContent {
        object: hit.object,
        // The unit of t is the length of the direction, which is not normalised.
        distance: hit.t * sample.ray.direction.length(),
        reflectance: own.unwrap_or(Material::DEFAULT_REFLECTANCE),
        behind: objects_behind(scene, *sample),
    })
}

/// The largest number of objects that are recorded behind the visible one, per pixel.
const MAX_OCCLUDED: usize = 3;
/// The largest number of surfaces that are passed in search of objects behind the visible one, per
/// pixel.
// For each surface another ray is traced, and a sphere has two surfaces. The limit bounds the time for meshes with many
// layers.
const MAX_LAYERS: usize = 12;

/// Returns the objects behind the visible one along a sample's ray, the nearest first.
fn objects_behind(scene: &Scene, mut sample: GBufferSample) -> [Option<u32>; MAX_OCCLUDED] {
    let seen = sample.hit.map(|hit| hit.object);
    let (mut found, mut count) = ([None; MAX_OCCLUDED], 0);
    for _ in 0..MAX_LAYERS {
        let Some(surface) = sample.surface(scene) else { break };
        // The next ray starts behind the surface, at the distance by which shadow rays start in front of it, so that it
        // does not hit the surface again.
        let origin = surface.position - surface.geometric_normal * surface.clearance;
        sample.ray = Ray { origin, ..sample.ray };
        sample.hit = closest_hit(scene, &sample.ray);
        let object = sample.hit.map(|hit| hit.object);
        if object.is_some() && object != seen && !found.contains(&object) {
            found[count] = object;
            count += 1;
        }
        if count == MAX_OCCLUDED {
            break;
        }
    }
    found
}
