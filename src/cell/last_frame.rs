//! The last frame, from which the cells of a moving view keep their glyphs.
//!
//! Without it, a cell near the limit between two characters would change to and fro between them while the view moves.

use crate::grid::Cell;
use crate::render::Geometry;
use crate::tone::Picture;

/// The least range of light that is spread over all characters; evenly lit objects use fewer.
pub(super) const LEAST_RANGE: f32 = 0.12;

/// The greatest change of an end of an object's range of light per frame, as a share of the range.
// An object that moves into the picture has another range in each frame. Without the limit all of its characters would
// change each time.
const MAX_RANGE_CHANGE: f32 = 0.05;

/// The frame before, and whether the view moves.
// A frame at rest is remembered too, so that a motion begins with the glyphs that were shown at rest.
#[derive(Default)]
pub(super) struct LastFrame {
    pub(super) is_moving: bool,
    frame: Option<Remembered>,
}

/// A remembered frame.
pub(super) struct Remembered {
    picture: Picture,
    geometry: Geometry,
    ranges: LightRanges,
    pub(super) cells: Vec<KeptCell>,
}

/// A cell of the frame before.
pub(super) struct KeptCell {
    pub(super) object: u32,
    /// The fill character, even if the cell shows the character of an edge.
    pub(super) fill: u8,
    pub(super) edge: Option<char>,
    pub(super) shown: Cell,
}

impl LastFrame {
    /// Returns the remembered frame, if the view moves and the frame has the size of this picture.
    pub(super) fn previous_in_motion(&self, picture: &Picture) -> Option<&Remembered> {
        let size = |picture: &Picture| (picture.width(), picture.height());
        self.frame.as_ref().filter(|frame| self.is_moving && size(&frame.picture) == size(picture))
    }

    pub(super) fn remember(
        &mut self,
        picture: &Picture,
        geometry: &Geometry,
        ranges: LightRanges,
        cells: Vec<KeptCell>,
    ) {
        if let Some(frame) = &mut self.frame {
            frame.geometry.clone_from(geometry);
            frame.picture.clone_from(picture);
            (frame.ranges, frame.cells) = (ranges, cells);
        } else {
            self.frame = Some(Remembered { picture: picture.clone(), geometry: geometry.clone(), ranges, cells });
        }
    }
}

impl Remembered {
    /// Returns the cell that is shown at these pixels if neither they nor their surfaces have
    /// changed.
    pub(super) fn unchanged(
        &self,
        picture: &Picture,
        geometry: &Geometry,
        cell: usize,
        pixels: &[usize],
    ) -> Option<&Cell> {
        let is_same = pixels.iter().all(|&pixel| picture.pixels()[pixel] == self.picture.pixels()[pixel])
            && geometry.has_same_facets(&self.geometry, cell, pixels);
        is_same.then(|| &self.cells[cell].shown)
    }
}

/// The range of each object's light, sorted by the object.
#[derive(Default)]
pub(super) struct LightRanges(Vec<(u32, [f32; 2])>);

impl LightRanges {
    /// Adds the range of an object's light, and returns it.
    ///
    /// Each end is limited to a change of `MAX_RANGE_CHANGE` since the frame before.
    pub(super) fn add_limited(&mut self, object: u32, mut range: [f32; 2], before: Option<&Remembered>) -> [f32; 2] {
        if let Some(before) = before.and_then(|before| before.ranges.of(object)) {
            let most = MAX_RANGE_CHANGE * (before[1] - before[0]).max(LEAST_RANGE);
            for (end, before) in range.iter_mut().zip(before) {
                *end = end.clamp(before - most, before + most);
            }
        }
        self.0.push((object, range));
        range
    }

    fn of(&self, object: u32) -> Option<[f32; 2]> {
        let at = self.0.binary_search_by_key(&object, |&(object, _)| object).ok()?;
        Some(self.0[at].1)
    }
}
