//! What is known of a pixel: its light so far, and whether more samples would change it.

use crate::color::LinearRgb;
use glam::Vec3;

/// What the first ray through a pixel saw.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct First {
    pub(super) light: LinearRgb,
    /// The object, counted from 1; 0: none.
    object: u32,
    facing: Vec3,
    lit_by: u32,
}

impl First {
    /// That light, from an object and its normal, or from nothing, and what that is lit by.
    pub(super) fn new(light: LinearRgb, surface: Option<(u32, Vec3)>, lit_by: u32) -> Self {
        let (object, facing) = surface.map_or((0, Vec3::ZERO), |(object, normal)| (object + 1, normal));
        Self { light, object, facing, lit_by }
    }

    /// Whether an edge may run between the two: of an object, of a shadow, of a pattern, or where a surface bends by more
    /// than a quarter of a right angle. `white` is the light that is shown as white.
    pub(super) fn is_edge_to(&self, other: &Self, white: f32) -> bool {
        const BEND: f32 = 0.92;
        self.object != other.object
            || self.lit_by != other.lit_by
            || self.object != 0 && self.facing.dot(other.facing) < BEND
            || is_contrast(self.light, other.light, VISIBLE, white)
    }
}

/// A pixel's samples, with what tells whether more would change it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watched {
    /// The sum of their light.
    light: LinearRgb,
    count: u32,
    /// The least and the greatest light of the first of them, [`MANY`] at most, band by band.
    range: [LinearRgb; 2],
}

impl Watched {
    /// One sample.
    pub(super) fn new(first: &First) -> Self {
        let mut range = [f32::INFINITY, f32::NEG_INFINITY].map(LinearRgb::grey);
        widen(&mut range, first.light);
        Self { light: first.light, count: 1, range }
    }

    /// More samples: their light band by band.
    pub(super) fn add(&mut self, [r, g, b]: [&[f32]; 3]) {
        let lights = || r.iter().zip(g).zip(b).map(|((&r, &g), &b)| LinearRgb::new(r, g, b));
        lights().for_each(|light| self.light += light);
        // Nobody asks later on.
        if self.count < MANY {
            lights().for_each(|light| widen(&mut self.range, light));
        }
        self.count += r.len() as u32;
    }

    /// The mean of their light.
    pub(super) fn mean(&self) -> LinearRgb {
        self.light * (1.0 / self.count as f32)
    }

    /// Whether there is more than one.
    pub(super) fn is_at_edge(&self) -> bool {
        self.count > 1
    }

    /// Whether its samples differ so much that their mean cannot be sure yet.
    pub(super) fn is_rough(&self, white: f32) -> bool {
        is_contrast(self.range[0], self.range[1], UNSURE, white)
    }
}

/// The range with this light in it.
fn widen([least, most]: &mut [LinearRgb; 2], light: LinearRgb) {
    let join = |a: LinearRgb, b: LinearRgb, is_wanted: fn(f32, f32) -> bool| {
        let one = |a: f32, b: f32| if is_wanted(a, b) { a } else { b };
        LinearRgb::new(one(a.r, b.r), one(a.g, b.g), one(a.b, b.b))
    };
    *least = join(light, *least, |a, b| a < b);
    *most = join(light, *most, |a, b| a > b);
}

/// Neighbours that differ by this share of their light have an edge between them that is seen.
const VISIBLE: f32 = 0.05;

/// So many samples tell whether more are needed.
const MANY: u32 = 16;

/// Where so many differ by this share of their light, the mean may be off by a visible part of it.
const UNSURE: f32 = 0.2;

/// Whether the two differ by that share of the greater one in a band, and by more than is seen in the dark.
fn is_contrast(a: LinearRgb, b: LinearRgb, share: f32, white: f32) -> bool {
    const DARK: f32 = 0.005;
    [(a.r, b.r), (a.g, b.g), (a.b, b.b)].into_iter().any(|(a, b)| (a - b).abs() > share * a.max(b) + DARK * white)
}
