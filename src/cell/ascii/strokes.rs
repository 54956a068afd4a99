//! The edges in a cell as strokes of a pen, and the character that is most like them.

use super::glyphs::GLYPHS;
use crate::render::{CREASE_COSINE, Extent, Facet, Geometry};
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
struct FacetWindow<'g>([[&'g Facet; WINDOW[0]]; WINDOW[1]]);

/// The points of the strokes in and around a cell.
struct Strokes {
    border: Points,
    crease: Points,
    /// The length of the cell's strokes downwards and across, without its left and upper sides.
    lengths: [u32; 2],
}

impl<'g> FacetWindow<'g> {
    fn of(geometry: &'g Geometry, column: usize, row: usize) -> Self {
        let end = [geometry.columns() * SAMPLES[0] - 1, geometry.rows() * SAMPLES[1] - 1];
        let at = |first: usize, offset: usize, end: usize| (first + offset).saturating_sub(MARGIN).min(end);
        Self(std::array::from_fn(|y| {
            let y = at(row * SAMPLES[1], y, end[1]);
            std::array::from_fn(|x| geometry.at(at(column * SAMPLES[0], x, end[0]), y))
        }))
    }

    /// Returns the index, plus 1, of the nearest object in the cell and just right of and below it.
    // The cell also shows the edges to its right and lower neighbours, even where the nearer object of such an edge is
    // in the neighbour.
    fn nearest_object_at_cell(&self) -> u32 {
        let rows = self.0[MARGIN..].iter().take(SAMPLES[1] + 1);
        let facets = rows.flat_map(|row| &row[MARGIN..=MARGIN + SAMPLES[0]]).copied();
        facets.min_by(|a, b| a.depth.total_cmp(&b.depth)).map_or(0, |facet| facet.object)
    }

    fn cell_has_two_objects(&self) -> bool {
        let first = self.0[MARGIN][MARGIN].object;
        self.cell().any(|facet| facet.object != first)
    }

    /// Returns the facets in the cell.
    fn cell(&self) -> impl Iterator<Item = &'g Facet> {
        self.0[MARGIN..][..SAMPLES[1]].iter().flat_map(|row| &row[MARGIN..][..SAMPLES[0]]).copied()
    }

    /// Draws the strokes between all samples that an edge separates.
    fn strokes(&self, geometry: &Geometry) -> Strokes {
        let mut strokes = Strokes { border: [0; _], crease: [0; _], lengths: [0; 2] };
        for (y, row) in self.0.iter().enumerate() {
            for (x, &facet) in row.iter().enumerate() {
                if let Some(&right) = row.get(x + 1) {
                    let line = || Some([row.get(x.wrapping_sub(1))?, facet, right, row.get(x + 2)?]);
                    strokes.draw(separation(geometry, facet, right, line), [x, y], 0);
                }
                if let Some(below) = self.0.get(y + 1) {
                    let at = |y: usize| self.0.get(y).map(|row| row[x]);
                    let line = || Some([at(y.wrapping_sub(1))?, facet, below[x], at(y + 2)?]);
                    strokes.draw(separation(geometry, facet, below[x], line), [x, y], 1);
                }
            }
        }
        strokes.drop_doubtful_creases();
        strokes
    }
}

/// The kind of an edge between two samples.
#[derive(Clone, Copy, PartialEq)]
enum Separation {
    Border,
    Crease,
}

/// Returns the kind of edge between the two middle facets of `line`.
fn separation<'g>(
    geometry: &Geometry,
    a: &Facet,
    b: &Facet,
    line: impl Fn() -> Option<[&'g Facet; 4]>,
) -> Option<Separation> {
    if a.object != b.object {
        return Some(Separation::Border);
    }
    // The depth jumps between the two middle facets, `a` and `b`, if it bends at both of them. If it bends at `a`
    // alone, the jump is between `o` and `a`; if at `b` alone, between `b` and `c`.
    let jumps = || line().is_some_and(|[o, a, b, c]| geometry.jumps([o, a, b]) && geometry.jumps([a, b, c]));
    // Planes have no creases: towards the horizon the depth jumps from each row to the next.
    (a.extent == Extent::Bounded && (a.cosine(b) < CREASE_COSINE || jumps())).then_some(Separation::Crease)
}

impl Strokes {
    /// Draws the stroke between a sample and the next one on its right (`axis` 0) or below (1).
    fn draw(&mut self, separation: Option<Separation>, [x, y]: [usize; 2], axis: usize) {
        let points = match separation {
            Some(Separation::Border) => &mut self.border,
            Some(Separation::Crease) => &mut self.crease,
            None => return,
        };
        let (right, down) = (2 * x + usize::from(axis == 0), 2 * y + usize::from(axis == 1));
        for row in &mut points[down..(down + 2).min(2 * WINDOW[1])] {
            *row |= (0b11_u32 << right) as u16;
        }
        let inside = |at: usize, axis: usize| (MARGIN..MARGIN + SAMPLES[axis]).contains(&at);
        if inside(x, 0) && inside(y, 1) {
            self.lengths[axis] += 1;
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
        let wide = self.border.map(|row| (1..=REACH).fold(row, |wide, by| wide | row << by | row >> by));
        for (y, row) in self.crease.iter_mut().enumerate() {
            let near = &wide[y.saturating_sub(REACH)..(y + REACH + 1).min(wide.len())];
            *row &= !near.iter().fold(0, |near, row| near | row);
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
    /// For each point, the weights of all characters.
    weights: [[f32; GLYPHS.len()]; POINTS],
    /// For each character, the squared norm of its blurred ink, plus its penalty times [`POINTS`].
    constants: [f32; GLYPHS.len()],
}

static MATCHER: LazyLock<Matcher> = LazyLock::new(|| {
    let inks = GLYPHS.map(|(_, _, rows)| -> [f32; POINTS] {
        std::array::from_fn(|at| (rows[at / 8] >> (28 - 4 * (at % 8)) & 15) as f32 / 15.0)
    });
    // The dot product of two blurred pictures is that of one of them, unblurred, and the other, blurred twice. So only
    // the characters are blurred, and not the strokes, which change with each cell.
    let blurred_inks = inks.map(|ink| blurred(&blurred(&ink)));
    Matcher {
        weights: std::array::from_fn(|point| blurred_inks.map(|ink| 2.0 * ink[point])),
        constants: std::array::from_fn(|glyph| {
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
