//! The edges in a cell as strokes of a pen, and the character that is most like them.

use super::glyphs::GLYPHS;
use crate::render::{Extent, Geometry, are_across_crease};
use std::sync::LazyLock;

/// The samples of a cell's geometry, across and down.
// In the scene teapots, two by four samples show 89 % of the outlines, four by eight 94 %, and eight by sixteen 95 %.
const SAMPLES: [usize; 2] = [4, 8];
/// The number of samples on each side of a cell that are also examined to find its edges.
// A border removes creases up to a sample and a half away, also creases in the neighbouring cells.
const MARGIN: usize = 2;
/// The samples in and around a cell, across and down.
const WINDOW: [usize; 2] = [SAMPLES[0] + 2 * MARGIN, SAMPLES[1] + 2 * MARGIN];
/// A mask of the points in and around a cell, row by row. A point is half a sample wide, so that a
/// cell has 8x16 of them.
type Points = [u16; 2 * WINDOW[1]];

/// The ink of a stroke between two objects, and of one between two surfaces of an object.
const BORDER_INK: f32 = 0.75;
const CREASE_INK: f32 = 0.6;
/// The least length of a cell's strokes in samples. Shorter ones are left to the next cell.
const LEAST_LENGTH: u32 = 2;
/// The margin by which a character must be better to replace the one shown before, as a mean
/// difference per point.
// With .02 a moving outline leaves characters of the wrong direction behind.
const CLEAR_DIFFERENCE: f32 = 0.008;
/// The number of points of the shortest crease in and around a cell, .75 of a cell's width.
// A cell is eight points wide, and a stroke two points thick: 0.75 * 8 * 2.
const LEAST_CREASE_POINTS: u32 = 12;

/// The edge that crosses a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) glyph: char,
    /// Whether the edge separates objects, and not just two surfaces of one.
    pub(super) is_border: bool,
    /// Whether the edge runs down more than half as far as across.
    pub(super) is_steep: bool,
    /// Whether the edge is a border that crosses the cell, and not one that just lies on a side of
    /// the cell.
    pub(super) is_inside: bool,
    /// The nearest object in the cell and just right of and below the cell: its index, plus 1.
    pub(super) owner: u32,
}

/// Returns the edge that crosses a cell, if there is one that is long enough.
///
/// The edge keeps the character `kept`, unless another one is clearly better.
pub(super) fn edge(geometry: &Geometry, [column, row]: [usize; 2], kept: Option<char>) -> Option<Edge> {
    if !geometry.has_edge(column, row) {
        return None;
    }
    let window = FacetWindow::of(geometry, column, row);
    let strokes = window.strokes(geometry);
    let [upright, level] = strokes.lengths;
    if upright * upright + level * level < LEAST_LENGTH * LEAST_LENGTH {
        return None;
    }
    Some(Edge {
        glyph: MATCHER.nearest(&strokes, kept),
        is_border: in_cell(&strokes.border).any(|row| row != 0),
        is_steep: 2 * upright > level,
        is_inside: window.cell_has_two_objects(),
        owner: window.nearest_object_at_cell(),
    })
}

/// The facets in and around a cell, row by row.
// Each row of numbers is an array of its own, so that it is compared in a few instructions.
struct FacetWindow {
    /// The x, y and z coordinates of the normals, in units of 1/127.
    normals: [[[i16; WINDOW[0]]; 3]; WINDOW[1]],
    objects: [[u32; WINDOW[0]]; WINDOW[1]],
    depths: [[f32; WINDOW[0]]; WINDOW[1]],
    /// The facets of bounded objects.
    bounded: [Row; WINDOW[1]],
}

/// The points of the strokes in and around a cell.
struct Strokes {
    border: Points,
    crease: Points,
    /// The length of the cell's strokes downwards and across, without its left and upper sides.
    lengths: [u32; 2],
}

/// A mask of the facets in a row of the window, with the left one in the lowest bit.
type Row = u8;

/// Returns the mask of the facets of a row for which a condition holds.
fn row_where(is_set: impl Fn(usize) -> bool) -> Row {
    let mut bytes = [0; WINDOW[0]];
    for (x, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from(is_set(x));
    }
    // The product has bit 8 x of the number, the lowest of byte x, at bit 56 + x too.
    (u64::from_le_bytes(bytes).wrapping_mul(0x0102_0408_1020_4080) >> 56) as Row
}

impl FacetWindow {
    fn of(geometry: &Geometry, column: usize, row: usize) -> Self {
        const LAST: usize = SAMPLES[0] - 1;
        let (last_column, end) = (geometry.columns() - 1, geometry.rows() * SAMPLES[1] - 1);
        let mut window =
            Self { normals: [[[0; _]; _]; _], objects: [[0; _]; _], depths: [[0.0; _]; _], bounded: [0; _] };
        for y in 0..WINDOW[1] {
            let at = (row * SAMPLES[1] + y).saturating_sub(MARGIN).min(end);
            let cell = geometry.row_of_cell(column, at);
            let left = if column > 0 { geometry.row_of_cell(column - 1, at) } else { [cell[0]; _] };
            let right = if column < last_column { geometry.row_of_cell(column + 1, at) } else { [cell[LAST]; _] };
            let [[a, b], [c, d]] = [[left[LAST - 1], left[LAST]], [right[0], right[1]]];
            for (x, facet) in [a, b, cell[0], cell[1], cell[2], cell[3], c, d].into_iter().enumerate() {
                (window.objects[y][x], window.depths[y][x]) = (facet.object, facet.depth);
                for (coordinates, coordinate) in window.normals[y].iter_mut().zip(facet.normal()) {
                    coordinates[x] = coordinate.into();
                }
                window.bounded[y] |= Row::from(facet.extent == Extent::Bounded) << x;
            }
        }
        window
    }

    /// Returns the index, plus 1, of the nearest object in the cell and just right of and below it.
    // The cell also shows the edges to its right and lower neighbours, even where the nearer object of such an edge is
    // in the neighbour.
    fn nearest_object_at_cell(&self) -> u32 {
        let mut nearest = (self.depths[MARGIN][MARGIN], self.objects[MARGIN][MARGIN]);
        for (depths, objects) in self.depths.iter().zip(&self.objects).skip(MARGIN).take(SAMPLES[1] + 1) {
            for x in MARGIN..=MARGIN + SAMPLES[0] {
                if depths[x] < nearest.0 {
                    nearest = (depths[x], objects[x]);
                }
            }
        }
        nearest.1
    }

    fn cell_has_two_objects(&self) -> bool {
        let first = self.objects[MARGIN][MARGIN];
        let mut rows = self.objects[MARGIN..][..SAMPLES[1]].iter();
        rows.any(|row| row[MARGIN..][..SAMPLES[0]].iter().any(|&object| object != first))
    }

    /// Draws the strokes between all samples that an edge separates.
    fn strokes(&self, geometry: &Geometry) -> Strokes {
        let mut strokes = Strokes { border: [0; _], crease: [0; _], lengths: [0; 2] };
        let [mut bends_before, mut bends] = [0, self.bends_down(geometry, 1)];
        for y in 0..WINDOW[1] {
            // Planes have no creases: towards the horizon the depth jumps from each row to the next.
            let (normals, objects, bounded) = (&self.normals[y], &self.objects[y], self.bounded[y]);
            let objects_beside = beside(objects);
            let border = row_where(|x| objects[x] != objects_beside[x]);
            // The depth jumps between two facets if it bends at both of them. If it bends at the first alone, the jump
            // is before it; if at the second alone, after it.
            let across = if bounded == 0 { 0 } else { self.bends_across(geometry, y) };
            let with_right = bounded & !border & !(1 << (WINDOW[0] - 1));
            let crease = creases(normals, &normals.map(|row| beside(&row)), with_right, across & across >> 1);
            strokes.draw(y, 0, border, crease);
            if let (Some(below), Some(objects_below)) = (self.normals.get(y + 1), self.objects.get(y + 1)) {
                let border = row_where(|x| objects[x] != objects_below[x]);
                strokes.draw(y, 1, border, creases(normals, below, bounded & !border, bends_before & bends));
            }
            (bends_before, bends) = (bends, self.bends_down(geometry, y + 2));
        }
        strokes.drop_doubtful_creases();
        strokes
    }

    /// Returns the facets of a row at which the depth bends along the row.
    fn bends_across(&self, geometry: &Geometry, y: usize) -> Row {
        // The row is padded, so that all of its facets are examined together.
        let mut row = [0.0; WINDOW[0] + 2];
        row[..WINDOW[0]].copy_from_slice(&self.depths[y]);
        let middle = row_where(|x| geometry.jumps([row[x], row[x + 1], row[x + 2]])) << 1;
        middle & !(1 | 1 << (WINDOW[0] - 1))
    }

    /// Returns the facets of a row at which the depth bends downwards.
    fn bends_down(&self, geometry: &Geometry, y: usize) -> Row {
        let Some([above, row, below]) = y.checked_sub(1).and_then(|y| self.depths.get(y..y + 3)?.first_chunk()) else {
            return 0;
        };
        row_where(|x| geometry.jumps([above[x], row[x], below[x]]))
    }
}

/// Returns, for each facet of a row, the value of the facet to its right; for the last, its own.
fn beside<T: Copy>(row: &[T; WINDOW[0]]) -> [T; WINDOW[0]] {
    std::array::from_fn(|x| row[(x + 1).min(WINDOW[0] - 1)])
}

/// Returns the facets of a row that a crease separates from the next ones.
///
/// `normals` has the coordinates of the row's normals, `next` those of the next facets. `candidates` are the facets
/// whose next one is on the same bounded object, `jumps` those at which the depth jumps.
fn creases(normals: &[[i16; WINDOW[0]]; 3], next: &[[i16; WINDOW[0]]; 3], candidates: Row, jumps: Row) -> Row {
    if candidates == 0 {
        return 0;
    }
    let normal = |of: &[[i16; WINDOW[0]]; 3], x: usize| [of[0][x], of[1][x], of[2][x]];
    candidates & (jumps | row_where(|x| are_across_crease(normal(normals, x), normal(next, x))))
}

/// The points of the facets of a row, two for each.
static POINTS_OF_ROW: [u16; 1 << WINDOW[0]] = {
    let mut points = [0; 1 << WINDOW[0]];
    let mut row = 0;
    while row < points.len() {
        let mut x = 0;
        while x < WINDOW[0] {
            points[row] |= (3 * (row as u16 >> x & 1)) << (2 * x);
            x += 1;
        }
        row += 1;
    }
    points
};

impl Strokes {
    /// Draws the strokes between facets of a row and the next ones on the right (`axis` 0) or below
    /// (1).
    fn draw(&mut self, y: usize, axis: usize, border: Row, crease: Row) {
        if border | crease == 0 {
            return;
        }
        let (right, down) = (usize::from(axis == 0), 2 * y + usize::from(axis == 1));
        for (points, row) in [(&mut self.border, border), (&mut self.crease, crease)] {
            let row = POINTS_OF_ROW[usize::from(row)] << right;
            points[down..(down + 2).min(2 * WINDOW[1])].iter_mut().for_each(|points| *points |= row);
        }
        if (MARGIN..MARGIN + SAMPLES[1]).contains(&y) {
            let in_cell = (border | crease) >> MARGIN & ((1 << SAMPLES[0]) - 1);
            self.lengths[axis] += in_cell.count_ones();
        }
    }

    /// Removes creases that are too short, and those beside borders, where surfaces turn away.
    fn drop_doubtful_creases(&mut self) {
        // About 0.4 of a cell's width: there a curved surface turns away from the eye, and its normals differ from
        // sample to sample.
        const REACH: usize = 3;
        if self.crease.iter().all(|&row| row == 0) {
            return;
        }
        let mut wide = [0; 2 * (WINDOW[1] + REACH)];
        for (wide, row) in wide[REACH..].iter_mut().zip(self.border) {
            *wide = (1..=REACH).fold(row, |wide, by| wide | row << by | row >> by);
        }
        for (y, row) in self.crease.iter_mut().enumerate() {
            *row &= !wide[y..=y + 2 * REACH].iter().fold(0, |near, row| near | row);
        }
        if self.crease.iter().map(|row| row.count_ones()).sum::<u32>() < LEAST_CREASE_POINTS {
            self.crease = [0; _];
        }
    }
}

/// Returns the points in the cell, row by row, with its left column in the lowest bit.
fn in_cell(points: &Points) -> impl Iterator<Item = u16> {
    points[2 * MARGIN..][..2 * SAMPLES[1]].iter().map(|row| row >> (2 * MARGIN) & 0xff)
}

/// The number of points in a cell.
const POINTS: usize = 128;

/// The precomputed part of the differences between strokes and characters, as in `shape::Matcher`.
struct Matcher {
    /// For each point, the weights of all characters, and unused ones.
    weights: [[f32; PADDED_GLYPHS]; POINTS],
    /// For each character, the squared norm of its blurred ink, plus its penalty times [`POINTS`].
    constants: [f32; PADDED_GLYPHS],
}

/// The number of characters, rounded up to whole vectors of four.
const PADDED_GLYPHS: usize = GLYPHS.len().next_multiple_of(4);

static MATCHER: LazyLock<Matcher> = LazyLock::new(|| {
    let inks = GLYPHS.map(|(_, _, rows)| -> [f32; POINTS] {
        std::array::from_fn(|at| (rows[at / 8] >> (28 - 4 * (at % 8)) & 15) as f32 / 15.0)
    });
    // The dot product of two blurred pictures is that of one of them, unblurred, and the other, blurred twice. So only
    // the characters are blurred, and not the strokes, which change with each cell.
    let blurred_inks = inks.map(|ink| blurred(&blurred(&ink)));
    Matcher {
        weights: std::array::from_fn(|point| {
            std::array::from_fn(|glyph| blurred_inks.get(glyph).map_or(0.0, |ink| 2.0 * ink[point]))
        }),
        constants: std::array::from_fn(|glyph| {
            if glyph >= GLYPHS.len() {
                return f32::INFINITY;
            }
            let square: f32 = inks[glyph].iter().zip(&blurred_inks[glyph]).map(|(ink, blurred)| ink * blurred).sum();
            square + POINTS as f32 * GLYPHS[glyph].1
        }),
    }
});

impl Matcher {
    /// Returns the character whose blurred ink differs least from blurred strokes.
    ///
    /// The character `kept` stays, unless another one is clearly better.
    fn nearest(&self, strokes: &Strokes, kept: Option<char>) -> char {
        let mut differences = self.constants;
        for (y, (border, crease)) in in_cell(&strokes.border).zip(in_cell(&strokes.crease)).enumerate() {
            let mut left = border | crease;
            while left != 0 {
                let x = left.trailing_zeros() as usize;
                left &= left - 1;
                let ink = if border >> x & 1 == 1 { BORDER_INK } else { CREASE_INK };
                for (difference, weight) in differences.iter_mut().zip(&self.weights[8 * y + x]) {
                    *difference -= weight * ink;
                }
            }
        }
        let mut nearest = (f32::INFINITY, b' ');
        for (&(character, ..), mut difference) in GLYPHS.iter().zip(differences) {
            if kept == Some(char::from(character)) {
                difference -= CLEAR_DIFFERENCE * POINTS as f32;
            }
            if difference < nearest.0 {
                nearest = (difference, character);
            }
        }
        char::from(nearest.1)
    }
}

/// Returns points after a Gaussian blur with a deviation of .15 of a cell's width.
fn blurred(points: &[f32; POINTS]) -> [f32; POINTS] {
    // At the next distance, 6 points, the weight would be 4e-6 of that in the middle.
    const REACH: usize = 5;
    let weight = |distance: usize| libm::exp(-0.5 * (distance as f64 / 1.2) * (distance as f64 / 1.2));
    let sum = weight(0) + 2.0 * (1..=REACH).map(weight).sum::<f64>();
    let weights: [f32; REACH + 1] = std::array::from_fn(|distance| (weight(distance) / sum) as f32);
    let along = |points: &[f32; POINTS], at: usize, step: usize, place: usize, length: usize| -> f32 {
        let others = place.saturating_sub(REACH)..(place + REACH + 1).min(length);
        others.map(|other| weights[place.abs_diff(other)] * points[at + other * step - place * step]).sum()
    };
    let across: [f32; POINTS] = std::array::from_fn(|at| along(points, at, 1, at % 8, 8));
    std::array::from_fn(|at| along(&across, at, 8, at / 8, 16))
}
