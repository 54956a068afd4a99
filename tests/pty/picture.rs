//! The pictures that the library makes of scenes, and a test whether a terminal shows them.

use super::screen::{Colour, Screen};
use termtrace::internals::cell;
use termtrace::{CellMode, Grid, Ink, Map, Painter, Sampling, Scene, Size};

/// Returns the final picture of a scene on a screen whose cells are `aspect` times as high as wide.
pub(crate) fn picture(scene: &Scene, mode: CellMode, size: Size, aspect: f32) -> Grid {
    picture_with(Sampling::BEST, scene, mode, size, aspect)
}

/// Returns the picture of a scene with the given sampling.
pub(crate) fn picture_with(sampling: Sampling, scene: &Scene, mode: CellMode, size: Size, aspect: f32) -> Grid {
    let resolution = cell::resolution(mode, size, aspect).expect("a size that pictures can have");
    Painter::new(mode).trace(Map::Shaded, scene, scene.camera(), resolution, sampling)
}

impl From<Ink> for Colour {
    fn from(ink: Ink) -> Self {
        match ink {
            Ink::Default => Self::Default,
            Ink::Indexed(index) => Self::Indexed(index),
            Ink::Rgb(c) => Self::Rgb(c.r, c.g, c.b),
        }
    }
}

/// Returns whether a screen shows exactly these cells.
///
/// Of a picture the colours of the halves count, with either half block.
pub(crate) fn shows(screen: &Screen, grid: &Grid) -> bool {
    let columns = usize::from(grid.size().columns);
    grid.cells().enumerate().all(|(at, wanted)| {
        let shown = screen.cell(at % columns, at / columns);
        let (fg, bg) = (Colour::from(wanted.fg), Colour::from(wanted.bg));
        let same = wanted.glyph == shown.glyph && shown.foreground == fg && shown.background == bg;
        let halves = ['▄', '▀', ' '].into_iter().find(|&glyph| wanted.glyph == glyph);
        let wanted = halves.and_then(|glyph| halves_of(glyph, fg, bg));
        same || wanted.is_some() && wanted == halves_of(shown.glyph, shown.foreground, shown.background)
    })
}

/// Returns the colours of a cell's upper and lower half, if it is a picture's.
pub(crate) fn halves_of(glyph: char, fg: Colour, bg: Colour) -> Option<[Colour; 2]> {
    match glyph {
        '▄' => Some([bg, fg]),
        '▀' => Some([fg, bg]),
        ' ' => Some([bg, bg]),
        _ => None,
    }
}
