//! The difference between a screen and a wanted grid.
//!
//! A picture's half cells may differ in colour, all other cells may not. The formulas are worked out here in f64, from
//! their sources, without the library's own.

use super::screens::Screens;
use std::borrow::Borrow;
use std::sync::LazyLock;
use termtrace::{Cell, Glyph, Grid, Ink, Quality, Srgb8};

/// The differences that a quality allows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caps {
    /// The most that a half cell may differ, in `OKLab`.
    pub(crate) distance: f64,
    /// The least peak signal-to-noise ratio, in decibels.
    pub(crate) psnr: f64,
}

impl Caps {
    pub(crate) fn of(quality: Quality) -> Self {
        match quality {
            Quality::Exact => Self { distance: 0.0, psnr: f64::INFINITY },
            Quality::Equal => Self { distance: 0.01, psnr: 44.0 },
            Quality::Fast => Self { distance: 0.02, psnr: 41.0 },
            _ => panic!("nothing is promised of {quality:?}"),
        }
    }
}

/// Returns the upper and the lower colour of a picture's cell.
///
/// That is a half block in truecolor, or a space without another colour, and without modifiers. All other cells are
/// text.
pub(crate) fn halves(cell: impl Borrow<Cell>) -> Option<[Srgb8; 2]> {
    let cell = cell.borrow();
    let (Ink::Rgb(bg), true) = (cell.bg, cell.attributes.is_empty()) else { return None };
    match (&cell.glyph, cell.fg) {
        (Glyph::Char(' '), Ink::Default) => Some([bg; 2]),
        (Glyph::Char('▄'), Ink::Rgb(fg)) => Some([bg, fg]),
        (Glyph::Char('▀'), Ink::Rgb(fg)) => Some([fg, bg]),
        _ => None,
    }
}

/// Asserts that the three terminals show the same, with all text exact, and returns their screen.
#[track_caller]
pub(crate) fn assert_text_is_exact(screens: &Screens, wanted: &Grid) -> Grid {
    let mut seen = wanted.clone();
    for (at, shown) in screens.shown().iter().enumerate() {
        if halves(seen.at(at)).is_some() && halves(shown).is_some() {
            seen.set_at(at, shown);
        }
    }
    screens.assert_show_halves(&seen);
    seen
}

/// The picture is within the caps.
#[track_caller]
pub(crate) fn assert_within(caps: Caps, seen: &Grid, wanted: &Grid) {
    let (mut sum, mut bands) = (0.0, 0.0);
    for (at, (seen, wanted)) in seen.cells().zip(wanted.cells()).enumerate() {
        let (Some(seen), Some(wanted)) = (halves(seen), halves(wanted)) else { continue };
        for (seen, wanted) in seen.into_iter().zip(wanted) {
            let distance = distance(seen, wanted);
            // The encoder computes in f32.
            assert!(distance <= caps.distance + 1e-6, "cell {at}: {seen:?} for {wanted:?} is {distance} away");
            sum += f64::from(square(seen, wanted));
            bands += 3.0;
        }
    }
    if sum > 0.0 {
        let psnr = 10.0 * libm::log10(255.0 * 255.0 * bands / sum);
        assert!(psnr >= caps.psnr - 1e-4, "{psnr} dB, where {} are promised", caps.psnr);
    }
}

/// Returns the square of the difference of two colours, over all three channels.
pub(crate) fn square(a: Srgb8, b: Srgb8) -> u32 {
    [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b)].map(|band| u32::from(band).pow(2)).iter().sum()
}

/// Returns the distance of two colours in `OKLab`.
pub(crate) fn distance(a: Srgb8, b: Srgb8) -> f64 {
    // Most cells are exact.
    if a == b {
        return 0.0;
    }
    let squares = oklab(a).into_iter().zip(oklab(b)).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

/// Returns the linear light of an encoded channel (IEC 61966-2-1).
///
/// From a table: the powers took 35 % of the time of a sequence.
fn linear(band: u8) -> f64 {
    static LINEAR: LazyLock<[f64; 256]> = LazyLock::new(|| {
        std::array::from_fn(|band| {
            let x = band as f64 / 255.0;
            if x <= 0.040_45 { x / 12.92 } else { libm::pow((x + 0.055) / 1.055, 2.4) }
        })
    });
    LINEAR[usize::from(band)]
}

/// Returns a colour in `OKLab`, by Ottosson's matrices.
fn oklab(color: Srgb8) -> [f64; 3] {
    let [r, g, b] = [color.r, color.g, color.b].map(linear);
    let times = |m: [[f64; 3]; 3], v: [f64; 3]| m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
    let cones = [
        [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
        [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
        [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
    ];
    let axes = [
        [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
        [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
        [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
    ];
    times(axes, times(cones, [r, g, b]).map(libm::cbrt))
}
