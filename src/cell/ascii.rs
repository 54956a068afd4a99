//! ASCII with outlines: characters draw where surfaces meet, and fill objects by their shading.
//!
//! A reader who sees only text needs to know what is in front of what, so ink is spent on objects: their outlines, and
//! their own shading spread over the densest characters. Planes get a light texture, and the background stays blank.

use super::colors::{Colors, TextInks};
use super::glyph_kind::{Background, Fill, GlyphKind};
use super::last_frame::{KeptCell, LEAST_RANGE, LastFrame, LightRanges, Remembered};
use super::tint;
use crate::color::{LinearRgb, Srgb8};
use crate::grid::{Cell, Grid, Ink};
use crate::render::{Extent, Geometry};
use crate::tone::Picture;
use strokes::Edge;

mod glyphs;
mod strokes;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "ascii",
    help: "outlines, and each object filled by its own shading",
    title: "characters with outlines",
    pixels_per_cell: (ACROSS as u32, DOWN as u32),
    has_blocks: false,
    colorless_glyphs: None,
    fill: Fill::Geometry(fill),
};

// The rays per cell. More rays find hardly more of the outlines: of those of three spheres, two by four rays find 99 %,
// eight by sixteen 100 %. Where surfaces meet, four times as many are traced.
const ACROSS: usize = 2;
const DOWN: usize = 4;

/// A character that fills cells, and its ink as a fraction of the ink of `@`.
type Tone = (u8, f32);

/// The fill characters of objects, from dark to light.
///
/// None is blank, so that the dark side of an object is visible.
// With a dark side that starts at `.`, objects stand out less: the inks beside an outline of three spheres differ by
// 0.34 instead of 0.38.
const OBJECT: [Tone; 8] =
    [(b':', 0.19), (b';', 0.255), (b'+', 0.41), (b'x', 0.53), (b'o', 0.645), (b'X', 0.725), (b'#', 0.885), (b'@', 1.0)];
/// The fill characters of floors and ceilings, and those of walls, from dark to light.
///
/// They have less ink than most of those of objects.
// If neighbouring characters differed by 0.25 in ink, a plane's pattern would look like an edge.
const LEVEL: [Tone; 4] = [(b' ', 0.0), (b'.', 0.095), (b'-', 0.105), (b'~', 0.22)];
const UPRIGHT: [Tone; 4] = [(b' ', 0.0), (b'.', 0.095), (b':', 0.19), (b'!', 0.305)];

/// The limits between the characters of `OBJECT`, as fractions of the range of an object's light.
// Each limit is half-way between the inks of two characters.
const OBJECT_LIMITS: [f32; OBJECT.len() - 1] = {
    let mut limits = [0.0; OBJECT.len() - 1];
    let mut at = 0;
    while at < limits.len() {
        limits[at] = (0.5 * (OBJECT[at].1 + OBJECT[at + 1].1) - OBJECT[0].1) / (1.0 - OBJECT[0].1);
        at += 1;
    }
    limits
};

/// The distance from a tone's range up to which it is kept in motion, in widths of the range.
// With a tenth, the outlined characters of three_spheres changed 1.07 to 1.11 times as often as those of `shape`; with
// two fifths it is 0.95 to 1.00 times, those of teapots 0.73. With three fifths highlights never reach `@`.
const KEPT_MARGIN: f32 = 0.4;

/// The object that most rays of a cell meet, and how the cell shows it.
struct CellContent {
    /// The object's index, plus 1; 0 for the background.
    object: u32,
    extent: Extent,
    /// The mean luma of the object's pixels in the cell.
    light: f32,
    /// The first and the last row of pixels in which the cell shows the object.
    rows: [usize; 2],
    /// The fill of the same object in the frame before, while the view moves.
    kept_fill: Option<u8>,
    /// The fill character and its ink.
    tone: Tone,
    edge: Option<Edge>,
}

/// Sets each cell's glyph and colour.
fn fill(
    grid: &mut Grid,
    picture: &Picture,
    geometry: &Geometry,
    (background, colors): (Background, Colors),
    last_frame: Option<&mut LastFrame>,
) {
    let (columns, rows) = (usize::from(grid.size().columns), usize::from(grid.size().rows));
    let before = last_frame.as_ref().and_then(|last_frame| last_frame.previous_in_motion(picture));
    let content = |cell: usize| {
        cell_content(picture, geometry, [cell % columns, cell / columns], before.map(|it| &it.cells[cell]))
    };
    let mut contents: Vec<CellContent> = (0..columns * rows).map(content).collect();
    let (heights, ranges) = set_tones(&mut contents, background, before);
    let (borders, inks) = (BorderCounts::of(&contents, columns, rows), TextInks::of(colors));
    for cell in 0..columns * rows {
        let pixels = pixels_of(picture, cell % columns, cell / columns);
        if let Some(shown) = before.and_then(|before| before.unchanged(picture, geometry, cell, &pixels)) {
            grid.set_at(cell, shown);
            continue;
        }
        let glyph = glyph(&contents, columns, cell, &heights, &borders);
        // The colour of a blank is invisible, and would take bytes.
        let is_plain = glyph == ' ' || inks.are_default();
        let ink =
            if is_plain { Ink::Default } else { ink(picture, geometry, &contents[cell], cell, background, &inks) };
        grid.set_at(cell, &Cell::new(glyph, ink, Ink::Default));
    }
    if let Some(last_frame) = last_frame {
        let kept = |(content, shown): (&CellContent, Cell)| KeptCell {
            object: content.object,
            fill: content.tone.0,
            edge: content.edge.map(|edge| edge.glyph),
            shown,
        };
        last_frame.remember(picture, geometry, ranges, contents.iter().zip(grid.cells()).map(kept).collect());
    }
}

/// Returns the indices of a cell's pixels; beyond the picture's edge its last ones are repeated.
fn pixels_of(picture: &Picture, column: usize, row: usize) -> [usize; ACROSS * DOWN] {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    std::array::from_fn(|at| {
        let (x, y) = (ACROSS * column + at % ACROSS, DOWN * row + at / ACROSS);
        y.min(height - 1) * width + x.min(width - 1)
    })
}

/// Returns the content of a cell: the object that most of its rays meet, and the cell's edge.
fn cell_content(
    picture: &Picture,
    geometry: &Geometry,
    [column, row]: [usize; 2],
    before: Option<&KeptCell>,
) -> CellContent {
    let pixels = pixels_of(picture, column, row);
    let facets = pixels.map(|pixel| geometry.pixel(pixel));
    let count = |object: u32| facets.iter().filter(|facet| facet.object == object).count();
    let (mut most, mut owner) = (0, facets[0]);
    for &facet in &facets {
        if facet.object != owner.object || most == 0 {
            let count = count(facet.object);
            if count > most {
                (most, owner) = (count, facet);
            }
        }
    }
    let mut own = (0..pixels.len()).filter(|&at| facets[at].object == owner.object);
    let light = own.clone().map(|at| luma(picture.pixels()[pixels[at]])).sum::<f32>() / most as f32;
    let first = own.next().unwrap_or(0);
    let rows = [first, own.next_back().unwrap_or(first)].map(|at| DOWN * row + at / ACROSS);
    let edge = strokes::edge(geometry, [column, row], before.and_then(|before| before.edge));
    let kept_fill = before.filter(|before| before.object == owner.object).map(|before| before.fill);
    CellContent { object: owner.object, extent: owner.extent, light, rows, kept_fill, tone: LEVEL[0], edge }
}

/// Returns the luma of a pixel, in 0..=1.
fn luma(pixel: Srgb8) -> f32 {
    (0.2126 * f32::from(pixel.r) + 0.7152 * f32::from(pixel.g) + 0.0722 * f32::from(pixel.b)) / 255.0
}

/// Sets the tone of each cell by its object's range of light; returns heights and ranges.
fn set_tones(
    contents: &mut [CellContent],
    background: Background,
    before: Option<&Remembered>,
) -> (ObjectHeights, LightRanges) {
    let mut order: Vec<u32> = (0..contents.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        let [a, b] = [a, b].map(|at| &contents[at as usize]);
        a.object.cmp(&b.object).then(a.light.total_cmp(&b.light))
    });
    let objects: Vec<u32> = contents.iter().map(|content| content.object).collect();
    let (mut heights, mut ranges) = (Vec::new(), LightRanges::default());
    for run in order.chunk_by(|&a, &b| objects[a as usize] == objects[b as usize]) {
        let light = |at: usize| contents[run[at] as usize].light;
        let quantile = |share: f32| {
            let at = share * (run.len() - 1) as f32;
            let below = at as usize;
            let above = (below + 1).min(run.len() - 1);
            light(below) + (at - below as f32) * (light(above) - light(below))
        };
        let object = objects[run[0] as usize];
        // The darkest and the lightest 3 % of the object's cells are left out, so that a few cells do not take most of
        // the characters.
        let [low, high] = ranges.add_limited(object, [quantile(0.03), quantile(0.97)], before);
        let range = (high - low).max(LEAST_RANGE);
        let least = 0.5 * (low + high - range);
        let [mut top, mut bottom] = [usize::MAX, 0];
        for &at in run {
            let content = &mut contents[at as usize];
            let share = ((content.light - least) / range).clamp(0.0, 1.0);
            content.tone = tone(content.extent, share, background, content.kept_fill);
            (top, bottom) = (top.min(content.rows[0]), bottom.max(content.rows[1]));
        }
        heights.push((object, bottom + 1 - top));
    }
    (ObjectHeights(heights), ranges)
}

/// Returns the tone for a share of the range of an object's light.
///
/// The character `kept` stays if the share is at most [`KEPT_MARGIN`] of a step away from its tone. On a light
/// background the darkest parts get the densest characters.
// On a light background the tones of a plane are reversed while the limits stay, so that the lightest quarter is blank.
// When the share was reversed instead, as for objects, patterns of a lit floor were single dots and rows that look like
// edges.
fn tone(extent: Extent, share: f32, background: Background, kept: Option<u8>) -> Tone {
    let is_light = background == Background::Light;
    let plane = |tones: [Tone; 4]| if is_light { [tones[3], tones[2], tones[1], tones[0]] } else { tones };
    let [level, upright] = [plane(LEVEL), plane(UPRIGHT)];
    let share = if is_light && extent == Extent::Bounded { 1.0 - share } else { share };
    let (tones, limits): (&[Tone], &[f32]) = match extent {
        Extent::Nothing => return LEVEL[0],
        Extent::Level => (&level, &[0.1, 0.4, 0.72]),
        Extent::Upright => (&upright, &[0.1, 0.4, 0.75]),
        Extent::Bounded => (&OBJECT, &OBJECT_LIMITS),
    };
    let is_near = |&at: &usize| {
        let [low, high] = [if at == 0 { 0.0 } else { limits[at - 1] }, limits.get(at).copied().unwrap_or(1.0)];
        let margin = KEPT_MARGIN * (high - low);
        (low - margin..=high + margin).contains(&share)
    };
    let kept = kept.and_then(|kept| tones.iter().position(|&(character, _)| character == kept)).filter(is_near);
    tones[kept.unwrap_or_else(|| limits.iter().take_while(|&&limit| share >= limit).count())]
}

/// The height of each object in rows of pixels, sorted by the object.
struct ObjectHeights(Vec<(u32, usize)>);

impl ObjectHeights {
    /// Returns whether an object is less than four and a half cells high.
    fn is_small(&self, object: u32) -> bool {
        let found = self.0.binary_search_by_key(&object, |&(object, _)| object);
        // In many_spheres at 80x24 a sphere has three by two cells, which its outline alone would fill.
        !found.is_ok_and(|at| 2 * self.0[at].1 >= 9 * DOWN)
    }
}

/// A summed-area table that counts the cells with a border (Crow 1984).
struct BorderCounts {
    sums: Vec<u32>,
    columns: usize,
    rows: usize,
}

impl BorderCounts {
    fn of(contents: &[CellContent], columns: usize, rows: usize) -> Self {
        // A summed-area table (Crow 1984): the count of any rectangle takes four of its numbers.
        let width = columns + 1;
        let mut sums = vec![0; width * (rows + 1)];
        for row in 0..rows {
            let mut of_row = 0;
            for column in 0..columns {
                of_row += u32::from(contents[row * columns + column].edge.is_some_and(|edge| edge.is_border));
                sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + of_row;
            }
        }
        Self { sums, columns, rows }
    }

    /// Returns whether more than half of the nine by five cells around one have a border.
    fn is_crowded(&self, column: usize, row: usize) -> bool {
        let [left, top] = [column.saturating_sub(4), row.saturating_sub(2)];
        let [right, bottom] = [(column + 5).min(self.columns), (row + 3).min(self.rows)];
        let sum = |x: usize, y: usize| self.sums[y * (self.columns + 1) + x];
        let borders = sum(right, bottom) + sum(left, top) - sum(left, bottom) - sum(right, top);
        2 * borders as usize > (right - left) * (bottom - top)
    }
}

/// Returns the colour of a cell's character: the hue of the object shown, at full brightness.
///
/// The character supplies the brightness, so that the darkest side of an object has its hue too. Planes are dimmer, so
/// that objects stand out; on a light background all colours are darker.
fn ink(
    picture: &Picture,
    geometry: &Geometry,
    content: &CellContent,
    cell: usize,
    background: Background,
    inks: &TextInks,
) -> Ink {
    let pixels = pixels_of(picture, cell % geometry.columns(), cell / geometry.columns());
    let is_of = |object: u32| pixels.iter().any(|&pixel| geometry.pixel(pixel).object == object);
    let object = content.edge.map(|edge| edge.owner).filter(|&owner| is_of(owner)).unwrap_or(content.object);
    let (mut light, mut extent) = (LinearRgb::BLACK, content.extent);
    for &pixel in pixels.iter().filter(|&&pixel| geometry.pixel(pixel).object == object) {
        light += LinearRgb::from_srgb8(picture.pixels()[pixel]);
        extent = geometry.pixel(pixel).extent;
    }
    let brightness = match (background, extent) {
        (Background::Dark, Extent::Bounded) => 255,
        (Background::Dark, _) | (Background::Light, Extent::Bounded) => 153,
        (Background::Light, _) => 102,
    };
    let mean = Srgb8::from_linear(light * (1.0 / pixels.len() as f32));
    // The nearest colour, and not a mix of two palette colours: a character has a single colour.
    inks.nearest(tint::scaled_to_brightness(mean, brightness))
}

/// Returns the character of a cell: its edge, or its fill.
fn glyph(
    contents: &[CellContent],
    columns: usize,
    cell: usize,
    heights: &ObjectHeights,
    borders: &BorderCounts,
) -> char {
    let (column, row) = (cell % columns, cell / columns);
    let content = &contents[cell];
    let fill = char::from(content.tone.0);
    let is_plane = matches!(content.extent, Extent::Level | Extent::Upright);
    let left = (column > 0).then(|| cell - 1);
    let right = (column + 1 < columns).then_some(cell + 1);
    let (above, below) = (cell.checked_sub(columns), Some(cell + columns).filter(|&below| below < contents.len()));
    let Some(edge) = content.edge else {
        // Planes stay blank beside a border, so that its line stands out: in the scene corridor, 98 % of the outlines
        // are seen instead of 83 %.
        let is_beside_line = || {
            let has_border = |at: usize| contents[at].edge.is_some_and(|edge| edge.is_border);
            [left, right, above, below].into_iter().flatten().any(has_border)
        };
        return if is_plane && is_beside_line() { ' ' } else { fill };
    };
    if !(edge.is_border && heights.is_small(edge.owner) && borders.is_crowded(column, row)) {
        return edge.glyph;
    }
    // Small objects in a crowd are drawn by their fill, because outlines around them would be a tangle.
    let ink = |at: Option<usize>| at.map_or(0.0, |at| contents[at].tone.1);
    let [before, after] = if edge.is_steep { [left, right] } else { [above, below] };
    if !edge.is_inside || (ink(before) - ink(after)).abs() > 0.35 {
        if is_plane { ' ' } else { fill }
    } else if edge.is_steep {
        ' '
    } else {
        edge.glyph
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
