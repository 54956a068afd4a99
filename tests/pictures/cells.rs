//! Pictures made by hand, and the cells that show them.

use termtrace::internals::cell::{RAMP, grid_from_picture, resolution};
use termtrace::{
    Cell, CellMode, Colors, Encoder, Glyph, Glyphs, Grid, Ink, Painter, Picture, Resolution, Size, Srgb8, export,
};

/// Returns a picture from rows of letters: b(lack), w(hite), r(ed), g(rey).
fn picture(rows: &[&str]) -> Picture {
    let pixels = rows.iter().flat_map(|row| row.chars()).map(color).collect();
    Picture::from_pixels(rows[0].len() as u32, rows.len() as u32, pixels).expect("all its pixels")
}

fn color(letter: char) -> Srgb8 {
    match letter {
        'b' => Srgb8::new(0, 0, 0),
        'w' => Srgb8::new(255, 255, 255),
        'r' => Srgb8::new(255, 0, 0),
        'g' => Srgb8::new(119, 119, 119),
        other => panic!("no colour {other}"),
    }
}

/// Returns cells as glyph, foreground and background; a minus stands for the terminal's own colour.
fn written(grid: &Grid) -> Vec<String> {
    let letter = |ink: Ink| match ink {
        Ink::Default => '-',
        Ink::Rgb(found) => "bwrg".chars().find(|&letter| color(letter) == found).unwrap_or('?'),
        Ink::Indexed(_) => '?',
    };
    let cell = |cell: Cell| format!("{}{}{}", cell.glyph, letter(cell.fg), letter(cell.bg));
    grid.rows().map(|row| row.map(cell).collect::<Vec<_>>().join(" ")).collect()
}

#[track_caller]
fn assert_half_blocks(rows: &[&str], expected: &[&str]) {
    assert_eq!(written(&grid_from_picture(CellMode::HALF_BLOCK, &picture(rows))), expected, "{rows:?}");
}

/// The foreground of a lower half block is the lower pixel's colour, the background the upper
/// one's.
#[test]
fn a_half_block_is_the_lower_pixel_on_the_upper() {
    assert_half_blocks(&["b", "w"], &["▄wb"]);
    assert_half_blocks(&["bw", "wr", "rg", "gb"], &["▄wb ▄rw", "▄gr ▄bg"]);
}

/// A flat cell is a space: a full block would show hairlines in some fonts.
#[test]
fn a_flat_cell_is_a_space() {
    assert_half_blocks(&["r", "r"], &[" -r"]);
    assert_half_blocks(&["rrb", "rbb"], &[" -r ▄br  -b"]);
}

/// Below the edge the colour is the terminal's own.
#[test]
fn an_odd_row_fills_the_upper_half() {
    assert_half_blocks(&["r"], &["▀r-"]);
    assert_half_blocks(&["bw", "br", "rw"], &[" -b ▄rw", "▀r- ▀w-"]);
}

/// A picture has no attributes, and one column for each pixel.
#[test]
fn a_grid_is_as_wide_as_its_picture() {
    for (width, height, rows) in [(1, 1, 1), (1, 2, 1), (2, 3, 2), (7, 4, 2), (300, 1, 1), (1, 301, 151)] {
        let picture = Picture::from_pixels(width, height, vec![Srgb8::default(); (width * height) as usize])
            .expect("all its pixels");
        for mode in [CellMode::HALF_BLOCK, CellMode::RAMP] {
            let grid = grid_from_picture(mode, &picture);
            assert_eq!(grid.size(), Size::new(width as u16, rows), "{width}x{height}");
            assert!(grid.cells().all(|cell| cell.attributes.is_empty()));
        }
    }
}

#[track_caller]
fn assert_ramp(rows: &[&str], expected: &str) {
    let grid = grid_from_picture(CellMode::RAMP, &picture(rows));
    assert_eq!(export::text(&grid), expected, "{rows:?}");
    assert!(grid.cells().all(|cell| (cell.fg, cell.bg) == (Ink::Default, Ink::Default)), "no colour");
}

/// Lightness is worked out by hand.
///
/// Red's luminance is 0.2126, L* = 116 * 0.5968 - 16 = 53.2, the sixth step, which begins at 48; the grey's is 0.1845,
/// L* = 50.03, the sixth as well.
#[test]
fn the_ramp_is_by_lightness() {
    assert_ramp(&["bwrg", "bwrg"], " @++\n");
    assert_ramp(&["w"], "@\n");
    assert_ramp(&["b"], " \n");
}

/// A cell's lightness is that of the mean light of its pixels, not of their codes.
///
/// Half black and half white is a luminance of 0.5, L* = 76.07, the eighth step, which ends at 78; red and black
/// 0.1063, L* = 38.9, the fifth, which begins at 38.
#[test]
fn the_ramp_takes_the_mean_of_light() {
    assert_ramp(&["bwr", "wbb"], "%%*\n");
    assert_ramp(&["bw", "wb", "wr"], "%%\n@+\n");
}

#[test]
fn the_ramp_is_a_promise() {
    assert_eq!(RAMP, b" .-:*+=%#@");
}

#[test]
fn trailing_blanks_are_kept() {
    assert_ramp(&["wbb", "wbb", "bbb", "bbb"], "@  \n   \n");
}

/// A cell of half blocks has two pixels, one above the other, each as high as half of it.
#[test]
fn pixels_of_a_screen() {
    for mode in [CellMode::HALF_BLOCK, CellMode::RAMP] {
        for (cell_aspect, pixel_aspect) in [(2.0, 1.0), (1.0, 0.5), (3.0, 1.5)] {
            let expected = Resolution::square(80, 48).with_pixel_aspect(pixel_aspect);
            assert_eq!(resolution(mode, Size::new(80, 24), cell_aspect), expected);
        }
    }
    // 65,535 rows are more pixels than 16 bits can count.
    let high = resolution(CellMode::HALF_BLOCK, Size::new(1, 65_535), 2.0);
    assert_eq!(high, Resolution::new(1, 131_070));
}

/// A cell of characters by shape has two by four pixels.
#[test]
fn pixels_of_shapes() {
    let mode = CellMode { glyphs: Glyphs::Shape, colors: Colors::None };
    let expected = Resolution::new(160, 96);
    assert_eq!(resolution(mode, Size::new(80, 24), 2.0), expected);
    for (width, height, columns, rows) in [(1, 1, 1, 1), (2, 4, 1, 1), (3, 5, 2, 2), (160, 96, 80, 24)] {
        let picture = Picture::from_pixels(width, height, vec![Srgb8::new(255, 255, 255); (width * height) as usize])
            .expect("all its pixels");
        let grid = grid_from_picture(mode, &picture);
        assert_eq!(grid.size(), Size::new(columns, rows), "{width}x{height}");
        assert!(grid.cells().all(|cell| cell.glyph == 'Q'), "the densest that is so all over");
    }
}

/// Returns all cell modes.
fn modes() -> impl Iterator<Item = CellMode> {
    let colors = [Colors::None, Colors::SIXTEEN, Colors::Indexed256, Colors::Truecolor];
    let glyphs = [Glyphs::Half, Glyphs::Shape, Glyphs::Ramp, Glyphs::Spaces];
    glyphs.into_iter().flat_map(move |glyphs| colors.map(|colors| CellMode { glyphs, colors }))
}

/// Returns a picture of all colours in no order, without equal neighbours.
fn confetti(seed: u32) -> Picture {
    let (width, height) = (80, 96);
    let mix = |at: u32| (at + seed).wrapping_mul(0x9e37_79b1) >> 8;
    let pixels = (0..width * height).map(mix).map(|c| Srgb8::new((c >> 16) as u8, (c >> 8) as u8, c as u8));
    Picture::from_pixels(width, height, pixels.collect()).expect("all its pixels")
}

fn inks(grid: &Grid) -> impl Iterator<Item = Ink> {
    grid.cells().flat_map(|cell| [cell.fg, cell.bg])
}

#[test]
fn only_the_colours_of_the_mode_are_used() {
    for mode in modes() {
        let grid = grid_from_picture(mode, &confetti(1));
        for ink in inks(&grid) {
            let is_allowed = match (ink, mode.colors) {
                (Ink::Default, _) | (Ink::Rgb(_), Colors::Truecolor) => true,
                (Ink::Indexed(index), Colors::Indexed16(_)) => index < 16,
                // Users may change the first sixteen colours.
                (Ink::Indexed(index), Colors::Indexed256) => index >= 16,
                _ => false,
            };
            assert!(is_allowed, "{mode:?}: {ink:?}");
        }
        let has_color = inks(&grid).any(|ink| ink != Ink::Default);
        assert_eq!(has_color, mode.colors != Colors::None, "{mode:?}");
        let is_ascii = grid.cells().all(|cell| matches!(cell.glyph, Glyph::Char(c) if c.is_ascii()));
        assert_eq!(is_ascii, mode.glyphs != Glyphs::Half, "{mode:?}");
    }
}

/// A picture that stays gives the same cells.
#[test]
fn a_still_picture_sends_nothing() {
    for mode in modes() {
        let mut painter = Painter::new(mode);
        let mut encoder = Encoder::new();
        encoder.encode(&painter.grid(&confetti(1)), &mut Vec::new());
        assert_ne!(painter.grid(&confetti(2)), grid_from_picture(mode, &confetti(1)));
        let mut bytes = Vec::new();
        encoder.encode(&painter.grid(&confetti(1)), &mut bytes);
        assert!(bytes.is_empty(), "{mode:?}: {} bytes", bytes.len());
        assert_eq!(painter.grid(&confetti(2)), grid_from_picture(mode, &confetti(2)), "{mode:?}");
    }
}

/// A pixel's dither depends on its colour and position alone: part of a picture is the same there.
#[test]
fn dithering_keeps_to_its_pixel() {
    let picture = confetti(1);
    let width = picture.width() as usize;
    let pixels = picture.pixels().iter().enumerate();
    let half = pixels.map(|(at, &pixel)| if at % width < width / 2 { pixel } else { Srgb8::new(200, 10, 90) });
    let other = Picture::from_pixels(picture.width(), picture.height(), half.collect()).expect("all its pixels");
    for colors in [Colors::None, Colors::SIXTEEN, Colors::Indexed256] {
        let mode = CellMode { glyphs: Glyphs::Half, colors };
        let (whole, part) = (grid_from_picture(mode, &confetti(1)), grid_from_picture(mode, &other));
        for (whole, part) in whole.rows().zip(part.rows()) {
            assert!(whole.take(width / 2).eq(part.take(width / 2)), "{colors:?}");
        }
    }
}

/// A colour near to one of the palette is flat, whatever the palette; others are mixed from two.
#[test]
fn few_colours_of_flat_pictures() {
    let indices = |colors, grey| -> std::collections::BTreeSet<u8> {
        let picture = Picture::from_pixels(32, 32, vec![Srgb8::new(grey, grey, grey); 1024]).expect("all its pixels");
        let grid = grid_from_picture(CellMode { glyphs: Glyphs::Half, colors }, &picture);
        let indices = inks(&grid).filter_map(|ink| match ink {
            Ink::Indexed(index) => Some(index),
            _ => None,
        });
        indices.collect()
    };
    assert_eq!(indices(Colors::SIXTEEN, 0), [0].into());
    assert_eq!(indices(Colors::SIXTEEN, 127), [8].into());
    assert_eq!(indices(Colors::SIXTEEN, 255), [15].into());
    assert_eq!(indices(Colors::SIXTEEN, 70), [0, 8].into());
    assert_eq!(indices(Colors::Indexed256, 0), [16].into());
    assert_eq!(indices(Colors::Indexed256, 98), [241].into());
    assert_eq!(indices(Colors::Indexed256, 255), [231].into());
    // With other sixteen colours the nearest to white may be another one.
    let mut turned = [Srgb8::new(0, 0, 0); 16];
    turned[3] = Srgb8::new(255, 255, 255);
    assert_eq!(indices(Colors::Indexed16(turned), 255), [3].into());
}

/// A cell of spaces has the colour of its two pixels' mean light.
///
/// Half of white light is the sRGB code 188.
#[test]
fn spaces_are_as_bright_as_half_blocks() {
    let mode = CellMode { glyphs: Glyphs::Spaces, colors: Colors::Truecolor };
    let grid = grid_from_picture(mode, &picture(&["bwr", "wwr", "rbw"]));
    let space = |color| Cell::new(' ', Ink::Default, Ink::Rgb(color));
    assert_eq!(grid.cell(0, 0), space(Srgb8::new(188, 188, 188)));
    assert_eq!(grid.cell(1, 0), space(color('w')));
    assert_eq!(grid.cell(2, 0), space(color('r')));
    assert_eq!(grid.cell(0, 1), space(color('r')), "an odd row is the upper pixel alone");
    let plain = CellMode { colors: Colors::None, ..mode };
    assert_eq!(grid_from_picture(plain, &confetti(1)), grid_from_picture(CellMode::RAMP, &confetti(1)));
}

/// With only the terminal's own colours, dark on light, light pixels are blank.
#[test]
fn a_light_background_inverts_pictures_without_colour() {
    for mode in modes() {
        let size = mode.pixels_per_cell();
        let glyph = |pixel: Srgb8, light| {
            let picture =
                Picture::from_pixels(size.0, size.1, vec![pixel; (size.0 * size.1) as usize]).expect("all its pixels");
            let grid = Painter::new(mode).with_light_background(light).grid(&picture);
            grid.cell(0, 0).clone()
        };
        let (black, white) = (color('b'), color('w'));
        if mode.colors == Colors::None {
            assert_eq!(glyph(black, true), glyph(white, false), "{mode:?}");
            assert_eq!(glyph(white, true), Cell::BLANK, "{mode:?}");
            assert_ne!(glyph(black, true), Cell::BLANK, "{mode:?}");
        } else {
            assert_eq!(glyph(black, true), glyph(black, false), "{mode:?}");
            assert_eq!(glyph(white, true), glyph(white, false), "{mode:?}");
        }
    }
}

#[test]
fn without_colour_a_half_is_lit_or_not() {
    let mode = CellMode { glyphs: Glyphs::Half, colors: Colors::None };
    assert_eq!(export::text(&grid_from_picture(mode, &picture(&["bwbw", "bbww", "wwbb"]))), " ▀▄█\n▀▀  \n");
}

/// The glyph shows the brightest channel, the colour the rest; on black, whatever the terminal's
/// own is.
#[test]
fn characters_are_coloured_as_bright_as_can_be() {
    let flat = |glyphs, pixel| {
        let picture = Picture::from_pixels(2, 4, vec![pixel; 8]).expect("all its pixels");
        grid_from_picture(CellMode { glyphs, colors: Colors::Truecolor }, &picture).cell(0, 0).clone()
    };
    let black = Ink::Rgb(color('b'));
    for (glyphs, densest) in [(Glyphs::Shape, 'Q'), (Glyphs::Ramp, '@')] {
        assert_eq!(flat(glyphs, color('r')), Cell::new(densest, Ink::Rgb(color('r')), black));
        assert_eq!(flat(glyphs, color('b')), Cell::new(' ', Ink::Default, black));
        let dim = flat(glyphs, Srgb8::new(0, 60, 120));
        assert_eq!(dim.fg, Ink::Rgb(Srgb8::new(0, 127, 255)));
        assert_eq!(dim.glyph, flat(glyphs, Srgb8::new(120, 120, 120)).glyph);
    }
}

/// Readable goldens of each cell kind: characters, or the index of each half's colour in
/// hexadecimal.
#[test]
fn goldens() {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("../snapshots/cells");
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/three_spheres.ron");
    let scene = termtrace::Scene::load(&path).expect("the scene is fine");
    for (name, glyphs, colors, digits) in [
        ("shape", Glyphs::Shape, Colors::None, 0),
        ("half", Glyphs::Half, Colors::None, 0),
        ("256_colors", Glyphs::Half, Colors::Indexed256, 2),
        ("16_colors", Glyphs::Half, Colors::SIXTEEN, 1),
    ] {
        let grid = export::frame_grid(&scene, CellMode { glyphs, colors }, Size::new(38, 12), 2.0);
        let frame = if digits == 0 { export::text(&grid) } else { numbers(&grid, digits) };
        let framed = format!("|{}|", frame.trim_end_matches('\n').replace('\n', "|\n|"));
        settings.bind(|| insta::assert_snapshot!(name, framed));
    }
}

/// Returns two lines for each row of cells, the upper halves' colours and the lower ones'.
fn numbers(grid: &Grid, digits: usize) -> String {
    let number = |ink| match ink {
        Ink::Indexed(index) => format!("{index:0digits$x}"),
        _ => "?".repeat(digits),
    };
    let lower = |cell: &Cell| if cell.glyph == ' ' { cell.bg } else { cell.fg };
    let line = |row: &[Cell], half: &dyn Fn(&Cell) -> Ink| -> String {
        row.iter().map(|cell| number(half(cell))).chain(["\n".to_owned()]).collect()
    };
    grid.rows()
        .flat_map(|row| {
            let row: Vec<Cell> = row.collect();
            [line(&row, &|cell| cell.bg), line(&row, &lower)]
        })
        .collect()
}

/// The escape sequences of a file by hand: only changes are written, and a line ends without
/// colours.
#[test]
fn ansi_of_a_picture() {
    let grid = grid_from_picture(CellMode::HALF_BLOCK, &picture(&["bb", "ww", "rr"]));
    let expected = "\x1b[48;2;0;0;0m\x1b[38;2;255;255;255m▄▄\x1b[0m\n\x1b[38;2;255;0;0m▀▀\x1b[0m\n";
    assert_eq!(String::from_utf8_lossy(&export::ansi(&grid)), expected);
}

/// The second half of a wide character is no character, and a cluster is written whole.
#[test]
fn covered_cells_are_not_written_to_files() {
    let mut grid = Grid::new(Size::new(6, 1));
    grid.put(0, 0, &Cell::new('世', Ink::Default, Ink::Default), 2);
    grid.put(2, 0, &Cell { glyph: Glyph::Cluster("e\u{301}".into()), ..Cell::BLANK }, 1);
    grid.put(3, 0, &Cell { glyph: Glyph::Cluster("👨\u{200d}👩\u{200d}👧".into()), ..Cell::BLANK }, 2);
    assert_eq!(export::text(&grid), "世e\u{301}👨\u{200d}👩\u{200d}👧 \n");
    assert_eq!(String::from_utf8_lossy(&export::ansi(&grid)), "世e\u{301}👨\u{200d}👩\u{200d}👧 \x1b[0m\n");
}

/// A panel over half of a wide character leaves blanks of its colours beside it.
#[test]
fn halves_of_cut_wide_characters_are_blanks() {
    let wide = |text: &str| Cell { glyph: Glyph::Cluster(text.into()), bg: Ink::Indexed(1), ..Cell::BLANK };
    let letter = |cell: Cell| if cell.glyph == Glyph::Covered { "<".to_owned() } else { cell.glyph.to_string() };
    for (column, columns, expected) in [
        (0, 1, "x  .b<<."),
        (1, 1, " x .b<<."),
        (2, 1, "  x.b<<."),
        (3, 1, "a<<xb<<."),
        (3, 2, "a<<x<  ."),
        (2, 3, "  x<<  ."),
        (5, 2, "a<<. x<."),
        (7, 1, "a<<.b<<x"),
    ] {
        let mut grid = Grid::new(Size::new(8, 1));
        for column in [3, 7] {
            grid.cell_mut(column, 0).glyph = '.'.into();
        }
        grid.put(0, 0, &wide("a"), 3);
        grid.put(4, 0, &wide("b"), 3);
        grid.put(column, 0, &Cell::new('x', Ink::Default, Ink::Default), columns);
        let shown: String = grid.cells().map(letter).collect();
        assert_eq!(shown, expected, "{columns} columns at {column}");
        assert_eq!(
            [2, 4].map(|column| grid.cell(column, 0).bg == Ink::Indexed(1)),
            [2, 4].map(|c| !(column..column + columns).contains(&c))
        );
    }
}
