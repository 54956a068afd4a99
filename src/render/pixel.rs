//! What is known of a pixel: its light so far, and whether more samples would change it.

use crate::color::LinearRgb;
use glam::Vec3;

/// A pixel's samples, with what tells whether more would change it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watched {
    /// The sum of their light.
    light: LinearRgb,
    count: u32,
    /// What the first of them saw.
    seen: Seen,
    /// The least and the greatest light of the first of them, [`MANY`] at most, band by band.
    range: [LinearRgb; 2],
}

/// What a ray saw, besides light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seen {
    /// The object, counted from 1; 0: none.
    object: u32,
    facing: Vec3,
    lit_by: u32,
}

impl Seen {
    /// An object and its normal, or nothing, and what it is lit by.
    pub(super) fn of(surface: Option<(u32, Vec3)>, lit_by: u32) -> Self {
        let (object, facing) = surface.map_or((0, Vec3::ZERO), |(object, normal)| (object + 1, normal));
        Self { object, facing, lit_by }
    }

    /// Whether there is an edge between the two: of an object, of a shadow, or where a surface bends by more than a
    /// quarter of a right angle.
    fn differs_from(&self, other: &Self) -> bool {
        const BEND: f32 = 0.92;
        self.object != other.object
            || self.lit_by != other.lit_by
            || self.object != 0 && self.facing.dot(other.facing) < BEND
    }
}

impl Watched {
    /// No sample yet, but what the first of them sees.
    pub(super) fn new(seen: Seen) -> Self {
        let range = [f32::INFINITY, f32::NEG_INFINITY].map(LinearRgb::grey);
        Self { seen, range, ..Self::default() }
    }

    /// More samples: their light band by band.
    pub(super) fn add(&mut self, light: [&[f32]; 3]) {
        let all = |so_far: LinearRgb, join: fn(f32, f32) -> f32| {
            let [r, g, b] = light.map(|light| light.iter().copied());
            LinearRgb::new(r.fold(so_far.r, join), g.fold(so_far.g, join), b.fold(so_far.b, join))
        };
        self.light = all(self.light, |sum, light| sum + light);
        // Nobody asks later on.
        if self.count < MANY {
            self.range = [all(self.range[0], f32::min), all(self.range[1], f32::max)];
        }
        self.count += light[0].len() as u32;
    }

    /// The mean of their light.
    pub(super) fn mean(&self) -> LinearRgb {
        self.light * (1.0 / self.count.max(1) as f32)
    }

    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Whether an edge may run between the two, after one sample of each; `white` is the light that is shown as white.
    pub(super) fn is_edge_to(&self, other: &Self, white: f32) -> bool {
        self.seen.differs_from(&other.seen) || is_contrast(self.mean(), other.mean(), VISIBLE, white)
    }

    /// Whether its samples differ so much that their mean cannot be sure yet.
    pub(super) fn is_rough(&self, white: f32) -> bool {
        is_contrast(self.range[0], self.range[1], UNSURE, white)
    }
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
