//! Few colours: each pixel shows one of the two palette colours that its own colour is mixed from.
//!
//! A regular pattern of 2x2 pixels selects which of the two: areas of one colour are flat, a checkerboard, or a lattice
//! in which every fourth pixel differs. Unlike with error diffusion, a pixel depends on its own colour and place only,
//! so unchanged parts of a picture do not flicker and send no bytes.
// Rejected: Knoll's pattern dithering, whose mixes of up to sixteen colours have an exact mean but look like confetti;
// the nearest colour alone, which turns weak colours grey; thresholds of blue noise, which look restless beside a
// checkerboard and have to be computed before the first picture.

use super::colors::xterm_color;
use super::mixes::{Mix, Mixes};
use crate::color::Srgb8;
use std::sync::atomic::{AtomicU16, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A palette, its mixes, and the mixes chosen so far.
pub(super) struct Palette {
    colors: Vec<Srgb8>,
    /// The palette index of the first of the `colors`.
    first_index: u8,
    /// The mixes and the choices, computed at the first use.
    // Most painters of the live view are replaced before they paint, as the terminal's replies arrive.
    choices: Option<Arc<Choices>>,
}

/// The palettes in use, with their choices.
// On a server each viewer's own took 270 kB, and most of the time to the first picture in 256 colours.
static IN_USE: Mutex<Vec<(Vec<Srgb8>, Weak<Choices>)>> = Mutex::new(Vec::new());

/// The possible mixes, and those that were chosen for colours so far.
///
/// A choice depends on its colour only, so that it does not matter which painter makes it.
struct Choices {
    mixes: Mixes,
    /// For each colour of [`LEVELS`], the number of its mix, counted from 1; 0 if none is chosen.
    // Memory: 131 kB for the 65,536 colours of `LEVELS`. The rejected mixes of up to sixteen colours took 557 kB.
    chosen: Vec<AtomicU16>,
}

impl Palette {
    /// Returns the palette of the 240 colours that themes leave alone.
    pub(super) fn cube_and_greys() -> Self {
        Self { colors: (16..=255).map(xterm_color).collect(), first_index: 16, choices: None }
    }

    /// Returns a palette of these colours. A colour's palette index is its position in the list.
    pub(super) fn from_colors(colors: &[Srgb8]) -> Self {
        Self { colors: colors.to_vec(), first_index: 0, choices: None }
    }

    /// Returns the palette index of a colour at a pixel of the screen.
    pub(super) fn index(&mut self, color: Srgb8, x: usize, y: usize) -> u8 {
        // Bayer's matrix of order 2: if half of the pixels are lighter, these form a checkerboard.
        const PATTERN: [[u8; 2]; 2] = [[0, 2], [3, 1]];
        let mix = self.mix(color);
        let is_lighter = PATTERN[y % 2][x % 2] < mix.lighter_quarters;
        mix.colors[usize::from(is_lighter)] + self.first_index
    }

    /// Returns the palette index that most pixels of a colour have, for characters.
    // Characters of two alternating colours are hard to read.
    pub(super) fn flat_index(&mut self, color: Srgb8) -> u8 {
        let mix = self.mix(color);
        mix.colors[usize::from(mix.lighter_quarters >= 2)] + self.first_index
    }

    fn mix(&mut self, color: Srgb8) -> Mix {
        let Choices { mixes, chosen, .. } = &**self.choices.get_or_insert_with(|| Choices::shared(&self.colors));
        let levels = levels(color);
        let choice = &chosen[choice_index(levels)];
        let mut number = choice.load(Ordering::Relaxed);
        if number == 0 {
            number = one_based(mixes.best(color_of(levels)));
            choice.store(number, Ordering::Relaxed);
        }
        mixes.get(usize::from(number) - 1)
    }
}

impl Choices {
    /// Returns the choices of a palette, which all painters with that palette share.
    fn shared(palette: &[Srgb8]) -> Arc<Self> {
        let mut in_use = IN_USE.lock().unwrap_or_else(PoisonError::into_inner);
        in_use.retain(|(_, choices)| choices.strong_count() > 0);
        let known = in_use.iter().find(|(known, _)| known == palette).and_then(|(_, choices)| choices.upgrade());
        known.unwrap_or_else(|| {
            let new = Arc::new(Self::new(palette));
            in_use.push((palette.to_vec(), Arc::downgrade(&new)));
            new
        })
    }

    /// Returns the mixes of a palette, in which each palette colour is already chosen for itself.
    // Chosen by cost alone, a mix of a darker and a lighter grey could replace a grey of the palette, because it may be
    // nearer to the rounded level of that grey than the grey itself.
    fn new(palette: &[Srgb8]) -> Self {
        let mixes = Mixes::new(palette);
        let mut chosen: Vec<_> = (0..LEVELS.iter().product()).map(|_| AtomicU16::new(0)).collect();
        for (number, position) in mixes.single_colors() {
            *chosen[choice_index(levels(palette[position]))].get_mut() = one_based(number);
        }
        Self { mixes, chosen }
    }
}

/// The numbers of levels per channel to which colours are rounded.
// With 64 levels of green, each grey of the 240 colours has a level of its own. With 32, the greys 128 and 135 would
// share one.
const LEVELS: [usize; 3] = [32, 64, 32];

/// Returns the levels nearest to a colour.
fn levels(color: Srgb8) -> [usize; 3] {
    let level = |code: u8, count: usize| (usize::from(code) * (count - 1) + 127) / 255;
    [level(color.r, LEVELS[0]), level(color.g, LEVELS[1]), level(color.b, LEVELS[2])]
}

/// Returns the colour of these levels.
fn color_of(levels: [usize; 3]) -> Srgb8 {
    let code = |channel: usize| ((levels[channel] * 255 + LEVELS[channel] / 2) / (LEVELS[channel] - 1)) as u8; // to 255
    Srgb8::new(code(0), code(1), code(2))
}

/// Returns the index of the levels in the list of choices.
fn choice_index([r, g, b]: [usize; 3]) -> usize {
    (r * LEVELS[1] + g) * LEVELS[2] + b
}

/// Returns the number of a mix, counted from 1 instead of 0, as `chosen` stores it.
fn one_based(number: usize) -> u16 {
    1 + number as u16 // 256 colours have fewer than 5,000 mixes
}

#[cfg(all(test, unit_tests))]
mod tests;
