//! The difference between cells and their picture at a distance, by a blur and a colour space of
//! our own.

use std::path::Path;
use termtrace::export::text;
use termtrace::internals::cell::grid_from_picture;
use termtrace::{CellMode, Colors, Glyphs, Grid, Ink, Picture, Resolution, Scene, Srgb8, render, tone};

const SCENES: [&str; 3] = ["three_spheres", "many_spheres", "inside_sphere"];

/// Returns a picture of a shipped scene, of a screen of 60x20 cells.
fn picture(scene: &str, width: u32, height: u32) -> Picture {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{scene}.ron"));
    let scene = Scene::load(&path).expect("the scene is fine");
    let pixel_aspect = 60.0 * 10.0 / width as f32 / (20.0 * 20.0 / height as f32);
    let resolution =
        Resolution::square(width, height).with_pixel_aspect(1.0 / pixel_aspect).expect("a shape of pixels");
    tone(&render(&scene, scene.camera(), resolution, std::num::NonZeroU32::MIN), &scene)
}

/// A number for each pixel.
#[derive(Clone)]
struct Plane {
    width: usize,
    values: Vec<f64>,
}

impl Plane {
    fn of(picture: &Picture, value: impl Fn(Srgb8) -> f64) -> Self {
        Self { width: picture.width() as usize, values: picture.pixels().iter().map(|&pixel| value(pixel)).collect() }
    }

    /// Returns the picture after a Gaussian blur, mirrored at its edges.
    fn blurred(&self, deviation: f64) -> Self {
        self.blurred_rows(deviation).turned().blurred_rows(deviation).turned()
    }

    fn turned(&self) -> Self {
        let height = self.values.len() / self.width;
        let columns = (0..self.width).flat_map(|x| (0..height).map(move |y| self.values[y * self.width + x]));
        Self { width: height, values: columns.collect() }
    }

    fn blurred_rows(&self, deviation: f64) -> Self {
        let reach = (4.0 * deviation + 0.5) as usize;
        let weight = |at: usize| libm::exp(-0.5 * square((at as f64 - reach as f64) / deviation));
        let weights: Vec<f64> = (0..=2 * reach).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        let mut values = Vec::new();
        for row in self.values.chunks(self.width) {
            let (first, end) = (reach, reach + row.len());
            // Indices count from `reach` pixels before the row.
            let mirrored = |at: usize| match at {
                _ if at < first => row[first - 1 - at],
                _ if at < end => row[at - first],
                _ => row[2 * row.len() - 1 - (at - first)],
            };
            let blurred = |x: usize| {
                weights.iter().enumerate().map(|(far, weight)| weight * mirrored(x + far)).sum::<f64>() / sum
            };
            values.extend((0..row.len()).map(blurred));
        }
        Self { width: self.width, values }
    }
}

fn square(x: f64) -> f64 {
    x * x
}

fn linear(code: u8) -> f64 {
    let encoded = f64::from(code) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

fn oklab([r, g, b]: [f64; 3]) -> [f64; 3] {
    let l = libm::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
    let m = libm::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
    let s = libm::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

/// Differences of a picture in few colours from the picture itself, in OKLab.
#[derive(Debug)]
struct Figures {
    /// The mean difference after a blur of 1.5 pixels, times 100.
    error: f64,
    /// The mean chroma of details that the picture does not have, times 100: confetti.
    noise: f64,
    /// The mean lightness of such details, times 100: dots.
    grain: f64,
    /// The share of pixels of a hue more than 60 degrees off, or of a hue where the picture is
    /// grey.
    wrong_hue: f64,
    /// The share of the coloured pixels that keep less than a third of their chroma after the blur.
    lost: f64,
}

/// Returns the colours of all pixels in OKLab, as they are and after a blur of their light.
fn seen(picture: &Picture) -> [Vec<[f64; 3]>; 2] {
    let bands = [|c: Srgb8| linear(c.r), |c: Srgb8| linear(c.g), |c: Srgb8| linear(c.b)];
    let light = bands.map(|band| Plane::of(picture, band));
    let blurred = light.clone().map(|plane| plane.blurred(1.5));
    [light, blurred]
        .map(|bands| (0..bands[0].values.len()).map(|at| oklab([0, 1, 2].map(|band| bands[band].values[at]))).collect())
}

/// Returns the mean detail in chroma and in lightness: the picture less its own blur, in OKLab.
fn details(colors: &[[f64; 3]], width: usize) -> [f64; 2] {
    let high = [0, 1, 2].map(|band| {
        let plane = Plane { width, values: colors.iter().map(|color| color[band]).collect() };
        let blurred = plane.blurred(1.5).values;
        plane.values.iter().zip(blurred).map(|(value, blurred)| value - blurred).collect::<Vec<_>>()
    });
    let mean = |detail: &dyn Fn(usize) -> f64| 100.0 * (0..colors.len()).map(detail).sum::<f64>() / colors.len() as f64;
    [mean(&|at| libm::hypot(high[1][at], high[2][at])), mean(&|at| high[0][at].abs())]
}

fn chroma(color: [f64; 3]) -> f64 {
    libm::hypot(color[1], color[2])
}

fn figures(shown: &Picture, wanted: &Picture) -> Figures {
    let width = wanted.width() as usize;
    let ([near, far], [wanted_near, wanted_far]) = (seen(shown), seen(wanted));
    let distance = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).map(|(a, b)| square(a - b)).sum::<f64>().sqrt();
    let is_wrong = |(&a, &b): (&[f64; 3], &[f64; 3])| {
        let turn = libm::atan2(a[1] * b[2] - a[2] * b[1], a[1] * b[1] + a[2] * b[2]).abs().to_degrees();
        (turn > 60.0 && chroma(a) > 0.04 && chroma(b) > 0.02) || (chroma(a) > 0.06 && chroma(b) <= 0.02)
    };
    let colored: Vec<_> = far.iter().zip(&wanted_far).filter(|(_, wanted)| chroma(**wanted) > 0.05).collect();
    let lost = colored.iter().filter(|(shown, wanted)| chroma(**shown) < chroma(**wanted) / 3.0).count();
    let ([noise, grain], [own_noise, own_grain]) = (details(&near, width), details(&wanted_near, width));
    let pixels = near.len() as f64;
    Figures {
        error: 100.0 * far.iter().zip(&wanted_far).map(distance).sum::<f64>() / pixels,
        noise: noise - own_noise,
        grain: grain - own_grain,
        wrong_hue: near.iter().zip(&wanted_near).filter(|&pair| is_wrong(pair)).count() as f64 / pixels,
        lost: lost as f64 / colored.len() as f64,
    }
}

/// Returns the colour that xterm shows for an index.
fn shown(index: u8) -> Srgb8 {
    let Colors::Indexed16(sixteen) = Colors::SIXTEEN else { unreachable!() };
    let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
    match index {
        0..16 => sixteen[usize::from(index)],
        16..232 => Srgb8::new(level((index - 16) / 36), level((index - 16) / 6 % 6), level((index - 16) % 6)),
        232.. => [8 + 10 * (index - 232)].map(|grey| Srgb8::new(grey, grey, grey))[0],
    }
}

/// Returns the pixels that half blocks show.
fn pixels(grid: &Grid) -> Picture {
    let shown = |ink| match ink {
        Ink::Indexed(index) => shown(index),
        other => panic!("{other:?} is none of the few colours"),
    };
    let lower = |cell: &termtrace::Cell| shown(if cell.glyph == ' ' { cell.bg } else { cell.fg });
    let (width, height) = (u32::from(grid.size().columns), 2 * u32::from(grid.size().rows));
    let rows = grid.rows().flat_map(|row| {
        let row: Vec<termtrace::Cell> = row.collect();
        row.iter().map(|cell| shown(cell.bg)).chain(row.iter().map(lower)).collect::<Vec<_>>()
    });
    Picture::from_pixels(width, height, rows.collect()).expect("all its pixels")
}

/// Returns the nearest colour to each pixel by its channels, as simple programs choose it.
fn nearest(picture: &Picture, indices: std::ops::RangeInclusive<u8>) -> Picture {
    let apart = |a: Srgb8, b: Srgb8| {
        [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b)].map(|band| u32::from(band).pow(2)).iter().sum::<u32>()
    };
    let nearest =
        |&pixel: &Srgb8| indices.clone().map(shown).min_by_key(|&color| apart(color, pixel)).expect("a range");
    let pixels = picture.pixels().iter().map(nearest).collect();
    Picture::from_pixels(picture.width(), picture.height(), pixels).expect("all its pixels")
}

/// Checks all figures at once, because a grey picture has no noise either.
#[test]
fn few_colours_are_calm_and_near_to_the_picture() {
    let wanted = picture("three_spheres", 60, 40);
    for (colors, indices, most) in [
        (Colors::Indexed256, 16..=255, Figures { error: 2.5, noise: 0.6, grain: 0.5, wrong_hue: 0.0, lost: 0.0 }),
        (Colors::SIXTEEN, 0..=15, Figures { error: 5.2, noise: 0.8, grain: 6.0, wrong_hue: 0.0, lost: 0.03 }),
    ] {
        let ours = figures(&pixels(&grid_from_picture(CellMode { glyphs: Glyphs::Half, colors }, &wanted)), &wanted);
        println!("{} colours: {ours:?}", indices.len());
        assert!(ours.error <= most.error && ours.noise <= most.noise && ours.grain <= most.grain, "{ours:?}");
        assert!(ours.wrong_hue <= most.wrong_hue && ours.lost <= most.lost, "{ours:?}");
        let nearest = figures(&nearest(&wanted, indices), &wanted);
        assert!(nearest.wrong_hue > 0.01 || nearest.lost > 0.1, "the measure sees nothing: {nearest:?}");
    }
    let confetti = wanted.pixels().iter().enumerate().map(|(at, &pixel)| match at % 5 {
        0 => Srgb8::new(pixel.b, pixel.r, pixel.g),
        _ => pixel,
    });
    let confetti = Picture::from_pixels(60, 40, confetti.collect()).expect("all its pixels");
    let seen = figures(&confetti, &wanted);
    assert!(seen.noise > 1.0 && seen.wrong_hue > 0.02, "the measure sees nothing: {seen:?}");
}

/// Returns the coverage of each pixel of the characters, drawn by a terminal in cells of 10x20
/// pixels.
fn glyph_sheet() -> Vec<Vec<f64>> {
    let file = std::io::Cursor::new(include_bytes!("../cells/dejavu_sans_mono_16.png"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut ink = vec![0; reader.output_buffer_size().expect("it is small")];
    reader.next_frame(&mut ink).expect("a PNG");
    let row = |glyph: usize, y: usize| ink[(y * 95 + glyph) * 10..][..10].iter().map(|&ink| f64::from(ink) / 255.0);
    (0..95).map(|glyph| (0..20).flat_map(|y| row(glyph, y)).collect()).collect()
}

/// Returns lines of characters as pixels, white on black.
fn drawn(lines: &str, sheet: &[Vec<f64>]) -> Plane {
    let row = |line: &str, y: usize| -> Vec<f64> {
        line.bytes().flat_map(|byte| sheet[usize::from(byte) - 32][y * 10..][..10].to_vec()).collect()
    };
    let values = lines.lines().flat_map(|line| (0..20).flat_map(move |y| row(line, y))).collect();
    Plane { width: 600, values }
}

/// Returns the peak signal-to-noise ratio in decibels after a blur of 4 pixels.
///
/// The picture is no lighter than the densest glyph.
fn psnr(lines: &str, picture: &Picture, sheet: &[Vec<f64>]) -> f64 {
    let white = sheet.iter().map(|ink| ink.iter().sum::<f64>() / ink.len() as f64).fold(0.0, f64::max);
    let luma = |c: Srgb8| (0.2126 * f64::from(c.r) + 0.7152 * f64::from(c.g) + 0.0722 * f64::from(c.b)) / 255.0;
    let wanted = Plane::of(picture, |pixel| white * luma(pixel)).blurred(4.0).values;
    let shown = drawn(lines, sheet).blurred(4.0).values;
    let squares: f64 = wanted.iter().zip(&shown).map(|(a, b)| square(a - b)).sum();
    10.0 * libm::log10(white * white / (squares / wanted.len() as f64))
}

#[test]
fn characters_by_shape_resemble_the_picture_at_a_distance() {
    let sheet = glyph_sheet();
    let mean = |glyphs| {
        let mode = CellMode { glyphs, colors: Colors::None };
        let (across, down) = mode.pixels_per_cell();
        let psnr = |scene: &&str| {
            let lines = text(&grid_from_picture(mode, &picture(scene, 60 * across, 20 * down)));
            psnr(&lines, &picture(scene, 600, 400), &sheet)
        };
        SCENES.iter().map(psnr).sum::<f64>() / SCENES.len() as f64
    };
    let (shape, ramp) = (mean(Glyphs::Shape), mean(Glyphs::Ramp));
    println!("shape {shape:.2} dB, ramp {ramp:.2} dB");
    assert!(shape >= 19.0, "{shape}");
    assert!(ramp <= 15.0, "the measure sees nothing: {ramp}");
}
