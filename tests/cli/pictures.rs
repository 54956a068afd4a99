//! PNG and ANSI show the same picture, to a PNG decoder and a terminal emulator that are not ours.
//!
//! The plain text is what CIE's formula makes of its pixels.

use super::{Folder, shipped_scenes};
use png::{ColorType, Decoder, PixelDimensions, SrgbRenderingIntent};
use std::io::Cursor;
use std::num::NonZeroU16;

type Rgb = [u8; 3];

struct Png {
    width: usize,
    height: usize,
    pixels: Vec<Rgb>,
    shape: Option<PixelDimensions>,
}

impl Png {
    /// Decodes a file by the `png` crate, and asserts that it is marked as sRGB.
    #[track_caller]
    fn decode(bytes: &[u8]) -> Self {
        let mut reader = Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("it fits")];
        let frame = reader.next_frame(&mut rgb).expect("a picture");
        assert_eq!((frame.color_type, frame.bit_depth), (ColorType::Rgb, png::BitDepth::Eight));
        let info = reader.info();
        assert_eq!(info.srgb, Some(SrgbRenderingIntent::Perceptual));
        let pixels = rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        Self { width: frame.width as usize, height: frame.height as usize, pixels, shape: info.pixel_dims }
    }

    fn pixel(&self, x: usize, y: usize) -> Rgb {
        self.pixels[y * self.width + x]
    }

    /// Returns the two pixels of a cell; none below the edge.
    fn cell(&self, column: usize, row: usize) -> (Rgb, Option<Rgb>) {
        (self.pixel(column, 2 * row), (2 * row + 1 < self.height).then(|| self.pixel(column, 2 * row + 1)))
    }
}

/// A character with its colours; `None` is the terminal's own.
type AnsiCell = (char, Option<Rgb>, Option<Rgb>);

/// Reads the lines of cells of ANSI output.
///
/// The reader knows characters, `CSI ... m` with 0, 38;2 and 48;2, and nothing else. Each line has to end with the
/// terminal's own colours.
#[track_caller]
fn cells_of_ansi(bytes: &[u8]) -> Vec<Vec<AnsiCell>> {
    let text = std::str::from_utf8(bytes).expect("ANSI is UTF-8");
    assert!(text.ends_with('\n'));
    text.lines()
        .map(|line| {
            let (mut cells, mut fg, mut bg) = (Vec::new(), None, None);
            let mut rest = line;
            while let Some(c) = rest.chars().next() {
                rest = &rest[c.len_utf8()..];
                if c != '\x1b' {
                    assert!(!c.is_control(), "{c:?}");
                    cells.push((c, fg, bg));
                    continue;
                }
                let (sequence, after) = rest.split_once('m').expect("every sequence is an SGR");
                let numbers: Vec<u8> = sequence
                    .strip_prefix('[')
                    .and_then(|numbers| numbers.split(';').map(|number| number.parse().ok()).collect())
                    .unwrap_or_else(|| panic!("{sequence:?}"));
                match numbers[..] {
                    [0] => (fg, bg) = (None, None),
                    [38, 2, r, g, b] => fg = Some([r, g, b]),
                    [48, 2, r, g, b] => bg = Some([r, g, b]),
                    _ => panic!("{sequence:?}"),
                }
                rest = after;
            }
            assert_eq!((fg, bg), (None, None), "the line leaves its colours on");
            cells
        })
        .collect()
}

/// Returns the screen of a terminal of that size after the bytes were printed on it.
fn shown(bytes: &[u8], columns: usize, rows: usize) -> vt100::Parser {
    let side = |length: usize| NonZeroU16::new(length as u16).expect("not zero");
    // The screen has a row more than the frame: the line feed after the last row scrolls nothing away.
    let mut terminal = vt100::Parser::new(side(rows + 1), side(columns), 0);
    // The terminal driver does this.
    terminal.process(&bytes.split(|&byte| byte == b'\n').collect::<Vec<_>>().join(&b"\r\n"[..]));
    terminal
}

fn rgb_of(color: vt100::Color) -> Option<Rgb> {
    match color {
        vt100::Color::Default => None,
        vt100::Color::Rgb(r, g, b) => Some([r, g, b]),
        vt100::Color::Idx(index) => panic!("colour {index} of the 256 is no truecolor"),
    }
}

/// Asserts that the cell shows these pixels: upper and lower, or the upper one alone at an odd
/// edge.
#[track_caller]
fn assert_shows((glyph, fg, bg): AnsiCell, (upper, lower): (Rgb, Option<Rgb>)) {
    match (glyph, lower) {
        ('▄', Some(lower)) => {
            assert_eq!((fg, bg), (Some(lower), Some(upper)));
            assert_ne!(lower, upper, "a flat cell is a space");
        }
        (' ', Some(lower)) => assert_eq!((bg, bg), (Some(lower), Some(upper))),
        ('▀', None) => assert_eq!((fg, bg), (Some(upper), None)),
        other => panic!("{other:?}"),
    }
}

/// Compares PNG, an ANSI file and ANSI on a screen of one scene at one size.
#[track_caller]
fn judge(folder: &Folder, arguments: &str) {
    folder.frame(&format!("{arguments} -o frame.png"));
    let png = Png::decode(&folder.read("frame.png"));
    let ansi = folder.frame(&format!("{arguments} --format ansi"));
    let lines = cells_of_ansi(&ansi);
    let rows = png.height.div_ceil(2);
    assert_eq!(lines.len(), rows, "{arguments}");
    let terminal = shown(&ansi, png.width, rows);
    for (row, line) in lines.iter().enumerate() {
        assert_eq!(line.len(), png.width, "{arguments}: row {row}");
        for (column, &cell) in line.iter().enumerate() {
            assert_shows(cell, png.cell(column, row));
            let on_screen = terminal.screen().cell(row as u16, column as u16).expect("on the screen");
            let glyph = on_screen.contents().chars().next().unwrap_or(' ');
            assert_shows((glyph, rgb_of(on_screen.fgcolor()), rgb_of(on_screen.bgcolor())), png.cell(column, row));
        }
    }
    let text = folder.run(&format!("frame {arguments} --format text --glyphs ramp")).text();
    assert_eq!(text.lines().count(), rows);
    for (row, line) in text.lines().enumerate() {
        for (column, glyph) in line.chars().enumerate() {
            assert_lightness(glyph, png.cell(column, row));
        }
    }
}

/// Asserts the ramp's steps of CIE 1976 lightness, worked out in f64 from the PNG.
///
/// They begin at 8, 18, ... 88.
#[track_caller]
fn assert_lightness(glyph: char, (upper, lower): (Rgb, Option<Rgb>)) {
    let linear = |band: u8| {
        let c = f64::from(band) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
    };
    let luminance = |[r, g, b]: Rgb| 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
    let y = lower.map_or(luminance(upper), |lower| f64::midpoint(luminance(upper), luminance(lower)));
    let lightness = if y > 216.0 / 24389.0 { 116.0 * libm::cbrt(y) - 16.0 } else { y * 24389.0 / 27.0 };
    let place = " .-:*+=%#@".find(glyph).unwrap_or_else(|| panic!("{glyph:?} is not of the ramp")) as f64;
    // The first step has black in it, and the last one white; where two steps meet, either will do.
    let (least, most) = (10.0 * place - 2.0 - 1e-3, if place < 9.0 { 10.0 * place + 8.0 + 1e-3 } else { 100.1 });
    assert!((least..=most).contains(&lightness), "{glyph:?} for lightness {lightness}");
}

#[test]
fn every_shipped_scene_is_one_picture_in_all_formats() {
    let folder = Folder::new();
    for scene in shipped_scenes() {
        judge(&folder, &format!("{} --size 60x20 --samples 1", scene.display()));
    }
}

#[test]
fn odd_and_small_pictures_are_one_picture_in_all_formats() {
    let folder = Folder::new();
    for (size, samples) in
        [("--pixels 1x1", 1), ("--pixels 7x5", 1), ("--pixels 2x3", 1), ("--size 1x1", 1), ("--pixels 60x41", 3)]
    {
        judge(&folder, &format!("ball.ron {size} --samples {samples}"));
    }
}

#[test]
fn a_png_has_a_pixel_for_each_half_cell() {
    let folder = Folder::new();
    for (arguments, size) in
        [("--scale 1", (80, 48)), ("--size 9x4", (9, 8)), ("--pixels 9x5", (9, 5)), ("--pixels 1x1", (1, 1))]
    {
        let png = Png::decode(&folder.frame(&format!("ball.ron --format png {arguments}")));
        assert_eq!((png.width, png.height), size, "{arguments}");
    }
}

/// A picture without flags is one to look at; a golden frame keeps its promised size.
#[test]
fn a_png_is_large_and_smooth_by_default() {
    let folder = Folder::new();
    let png = folder.frame("ball.ron --format png");
    assert!(png == folder.frame("ball.ron --format png --pixels 1280x800 --samples best"));
    folder.run("frame ball.ron --check ball.png --bless").done();
    assert!(folder.read("ball.png") == folder.frame("ball.ron --format png --size 80x24 --samples 1"));
    folder.run("frame ball.ron --check ball.png").done();
}

#[test]
fn scale_makes_each_pixel_a_square() {
    let folder = Folder::new();
    let small = Png::decode(&folder.frame("ball.ron --pixels 12x7 --format png"));
    for scale in [1, 2, 3, 8] {
        let large = Png::decode(&folder.frame(&format!("ball.ron --pixels 12x7 --format png --scale {scale}")));
        assert_eq!((large.width, large.height), (12 * scale, 7 * scale));
        for y in 0..large.height {
            for x in 0..large.width {
                assert_eq!(large.pixel(x, y), small.pixel(x / scale, y / scale), "({x}, {y}) at {scale}");
            }
        }
    }
}

/// In a viewer's square pixels a ball is as wide as high, whatever the terminal's cells were.
#[test]
fn a_ball_is_round_in_a_png() {
    let folder = Folder::new();
    folder.write(
        "round.ron",
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0), vertical_fov: 20), ambient: 1, objects: [
            Sphere(center: (0, 0, 0), radius: 1)])",
    );
    // A cell of 6 by 13 pixels has an aspect of 2.1667.
    for (flags, size) in [
        ("--size 150x40", (150, 80)),
        ("--size 150x40 --cell-aspect 1.9", (158, 80)),
        ("--size 150x40 --cell-aspect 2.1667", (150, 87)),
        ("--size 150x40 --cell-aspect 2.5 --scale 2", (300, 200)),
        ("--size 150x40 --cell-aspect 1 --scale 2", (600, 160)),
        ("--pixels 90x80 --cell-aspect 3", (90, 120)),
        ("--cell-aspect 1.9", (1280, 800)),
    ] {
        let png = Png::decode(&folder.frame(&format!("round.ron {flags} --format png")));
        assert_eq!((png.width, png.height), size, "{flags}");
        assert!(png.shape.is_none(), "{flags}: its pixels are squares");
        let lit = |&i: &usize| png.pixels[i][0] > 99;
        let extent = |of: fn(usize, usize) -> usize| {
            let places = || (0..png.pixels.len()).filter(lit).map(|i| of(i, png.width));
            (places().max().expect("a ball") - places().min().expect("a ball")) as f64
        };
        let (across, down) = (extent(|i, width| i % width), extent(|i, width| i / width));
        assert!((across / down - 1.0).abs() < 0.05, "{flags}: {across} by {down}");
    }
}

/// The expected numbers are worked out by hand.
///
/// A colour given as sRGB is kept; linear 0.5 is 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354 of 255 = 187.5, rounded up;
/// brighter than white is white.
#[test]
fn colours_are_srgb_by_the_real_transfer_function() {
    let folder = Folder::new();
    for (background, expected) in [
        ("\"#87a6cc\"", [0x87, 0xa6, 0xcc]),
        ("\"#010203\"", [1, 2, 3]),
        ("\"white\"", [255, 255, 255]),
        ("\"rebeccapurple\"", [0x66, 0x33, 0x99]),
        ("(0.5, 0.25, 0.001)", [188, 137, 3]),
        ("(0.0, 1.0, 0.2140411)", [0, 255, 127]),
    ] {
        folder.write("sky.ron", format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: {background})"));
        let png = Png::decode(&folder.frame("sky.ron --pixels 3x3 --format png"));
        assert_eq!(png.pixels, [expected; 9], "{background}");
    }
}

/// Pixel (0, 0) is top left, where a ball to the left and above is drawn.
#[test]
fn the_first_pixel_is_top_left() {
    let folder = Folder::new();
    folder.write(
        "corner.ron",
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0), vertical_fov: 30), ambient: 1,
          objects: [Sphere(center: (-1.5, 1.5, 0), radius: 0.8)])",
    );
    let png = Png::decode(&folder.frame("corner.ron --pixels 40x40 --format png"));
    let seen: Vec<_> = (0..1600).filter(|&i| png.pixels[i] != [0; 3]).map(|i| (i % 40, i / 40)).collect();
    assert!(seen.len() > 50);
    assert!(seen.iter().all(|&(x, y)| x < 20 && y < 20), "{seen:?}");
    let text = folder.run("frame corner.ron --pixels 40x40").text();
    assert!(text.lines().take(10).any(|line| !line.trim().is_empty()));
    assert!(text.lines().skip(10).all(|line| line.trim().is_empty()));
    assert!(text.lines().all(|line| line[20..].trim().is_empty()));
}
