//! The layout of maps on the screen: one map, or two to compare. The shaded picture counts as a
//! map.

use crate::camera::Camera;
use crate::color::Srgb8;
use crate::framebuffer::Resolution;
use crate::maps::Map;
use crate::render::Sampling;
use crate::scene::Scene;
use crate::tone::Picture;
use std::num::NonZeroU32;

/// Initial position of the line between the two maps of a wipe, as a share of the picture's width.
pub(crate) const INITIAL_WIPE: f32 = 0.5;

/// The layout of the screen: one map (shaded picture, depth, normals, ...), two side by side, or
/// two in a wipe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewLayout {
    /// The map shown, or the left one of two.
    map: Map,
    /// The map on the right, if there are two.
    right: Option<RightMap>,
}

/// The right map and how it shares the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RightMap {
    map: Map,
    split: Split,
}

/// The way in which two maps share the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Split {
    /// Side by side: each map shows the whole view, in half of the columns, above a number of black
    /// pixel rows for a panel.
    Beside { panel_height: u32 },
    /// One view with a movable line: the left map on one side of the line, the right map on the
    /// other.
    Wipe,
}

impl ViewLayout {
    /// Creates a layout of one view, which shows `map`.
    pub(super) fn single(map: Map) -> Self {
        Self { map, right: None }
    }

    /// Returns the layout with its left map twice, side by side, above this number of black pixel
    /// rows for a panel.
    pub(super) fn twice(self, panel_height: u32) -> Self {
        Self { right: Some(RightMap { map: self.map, split: Split::Beside { panel_height } }), ..self }
    }

    /// Replaces the single map, or the right one of two, by the map that `step` returns for it.
    ///
    /// With two maps, the left one is skipped.
    pub(super) fn change_map(&mut self, step: fn(Map) -> Map) {
        match &mut self.right {
            None => self.map = step(self.map),
            Some(right) => {
                // A map compared with itself would show no difference.
                let next = step(right.map);
                right.map = if next == self.map { step(next) } else { next };
            }
        }
    }

    /// Shows the edges of triangles alone, or the shaded picture again.
    pub(super) fn toggle_wire(&mut self) {
        *self = Self::single(if *self == Self::single(Map::Wire) { Map::Shaded } else { Map::Wire });
    }

    /// Switches from one map to two side by side, to a wipe, and back.
    pub(super) fn compare(&mut self) {
        self.right = match self.right {
            None => Some(RightMap { map: self.map.next(), split: Split::Beside { panel_height: 0 } }),
            Some(RightMap { map, split: Split::Beside { .. } }) => Some(RightMap { map, split: Split::Wipe }),
            Some(RightMap { split: Split::Wipe, .. }) => None,
        };
    }

    /// Returns whether the layout is a wipe, whose line can be moved.
    pub(crate) fn is_wipe(self) -> bool {
        matches!(self.right, Some(RightMap { split: Split::Wipe, .. }))
    }

    /// Returns the maps, from left to right.
    pub(super) fn maps(self) -> impl Iterator<Item = Map> {
        [Some(self.map), self.right.map(|right| right.map)].into_iter().flatten()
    }

    /// Returns the maps to trace for a picture of size `whole`, each with its own size in pixels.
    pub(crate) fn map_sizes(self, whole: Resolution) -> Vec<(Map, Resolution)> {
        match self.right {
            Some(RightMap { split: Split::Beside { panel_height }, .. }) => {
                self.maps().zip(side_by_side_sizes(whole, panel_height)).collect()
            }
            // Both maps of a wipe have the full size, so that moving the line traces nothing.
            _ => self.maps().map(|map| (map, whole)).collect(),
        }
    }

    /// Returns the legends of the maps, from left to right; empty for the shaded picture alone.
    pub(crate) fn legends(self, scene: &Scene, camera: &Camera) -> Vec<String> {
        // The shaded picture needs no legend, which would hide a part of a row.
        if self == Self::default() {
            return Vec::new();
        }
        self.maps().map(|map| map.legend(scene, camera)).collect()
    }

    /// Returns the sampling to use for these maps: `wanted` if one of them can be refined, else at
    /// most one ray per pixel.
    pub(super) fn sampling(self, wanted: Sampling) -> Sampling {
        // Maps such as depths and normals are not refined: the mean of several samples at an edge is meaningless.
        if wanted == Sampling::Coarse || self.maps().any(Map::refines) {
            return wanted;
        }
        Sampling::UpTo(NonZeroU32::MIN)
    }

    /// Combines the pictures of two maps into one, with the line of a wipe at this share of the
    /// width.
    ///
    /// `None` for a single map.
    pub(crate) fn combined(self, parts: &[Picture], wipe: f32) -> Option<Picture> {
        match (self.right?.split, parts) {
            (Split::Beside { panel_height }, [left, right]) => Some(side_by_side(left, right, panel_height)),
            (Split::Wipe, [left, right]) => Some(wiped(left, right, wipe)),
            _ => None,
        }
    }
}

/// The colour of the line between the two maps of a picture, side by side or in a wipe.
const LINE: Srgb8 = Srgb8::new(255, 208, 64);

/// The colour of the rows below two maps that a panel covers.
const BLACK: Srgb8 = Srgb8::new(0, 0, 0);

/// Returns the sizes of two maps side by side, with a line of one column between them.
///
/// In a picture too narrow for two maps, the left one has all columns and the right one none.
fn side_by_side_sizes(whole: Resolution, panel_height: u32) -> [Resolution; 2] {
    // Both maps and the line between them need at least one column each.
    let left = if whole.width() < 3 { whole.width() } else { (whole.width() - 1) / 2 };
    let height = whole.height().saturating_sub(panel_height);
    [left, whole.width().saturating_sub(left + 1)].map(|width| whole.part(width, height))
}

fn side_by_side(left: &Picture, right: &Picture, panel_height: u32) -> Picture {
    let (width, mut pixels) = if right.width() == 0 {
        (left.width(), left.pixels().to_vec())
    } else {
        let rows = left.pixels().chunks(left.width() as usize).zip(right.pixels().chunks(right.width() as usize));
        let pixels = rows.flat_map(|(left, right)| [left, &[LINE], right].concat()).collect();
        (left.width() + 1 + right.width(), pixels)
    };
    let height = left.height() + panel_height;
    pixels.resize((width * height) as usize, BLACK);
    Picture::from_pixels(width, height, pixels).expect("the pixels fill both sizes")
}

fn wiped(left: &Picture, right: &Picture, wipe: f32) -> Picture {
    let width = left.width() as usize;
    let line = ((wipe * width as f32) as usize).min(width.saturating_sub(1));
    let mut picture = right.clone();
    // `chunks` panics for 0, the width of an empty picture.
    for (row, of_left) in picture.pixels_mut().chunks_mut(width.max(1)).zip(left.pixels().chunks(width.max(1))) {
        row[..line].copy_from_slice(&of_left[..line]);
        row[line] = LINE;
    }
    picture
}

#[cfg(all(test, unit_tests))]
mod tests;
