use super::*;
use crate::capabilities::{Glyphs, HalfBlocks, Shifts};

#[test]
fn names_are_plain_words() {
    for (name, expected) in [
        ("scenes/three_spheres.ron", "three_spheres"),
        ("built-in scene", "built-in_scene"),
        ("a\u{1b}[2J b.ply", "a__2J_b"),
        ("-o.ron", "o"),
        ("/", "scene"),
        ("été.ron", "été"),
    ] {
        assert_eq!(file_stem(name), expected, "{name}");
    }
}

#[test]
fn the_shown_picture_is_written_in_each_format() {
    let pixels = vec![crate::color::Srgb8::new(255, 255, 255); 4];
    let picture = Picture::from_pixels(2, 2, pixels).expect("all pixels are there");
    let capabilities = Capabilities {
        cell_mode: CellMode::HALF_BLOCK,
        resting_glyphs: None,
        cell_aspect: 2.0,
        half_blocks: HalfBlocks::Lower,
        light_background: false,
        synchronized_output: false,
        shifts: Shifts::Off,
    };
    let written = |format| contents(format, "ball", &picture, None, &capabilities).expect("written");
    assert_eq!(String::from_utf8_lossy(&written(Format::Text)), "@@\n");
    assert_eq!(String::from_utf8_lossy(&written(Format::Tally)), "@ 2\n");
    let dots = CellMode { glyphs: Glyphs::Dots, ..CellMode::HALF_BLOCK };
    let in_dots = contents(Format::Text, "ball", &picture, None, &Capabilities { cell_mode: dots, ..capabilities });
    assert_eq!(String::from_utf8_lossy(&in_dots.expect("written")), "oo\noo\n");
    let on_light = Capabilities { light_background: true, ..capabilities };
    let on_light = |format| contents(format, "ball", &picture, None, &on_light).expect("written");
    assert_eq!(String::from_utf8_lossy(&on_light(Format::Text)), "  \n", "white is blank on white");
    let ascii = CellMode { glyphs: Glyphs::Ascii, ..CellMode::HALF_BLOCK };
    let in_ascii = |format, light_background| {
        let capabilities = Capabilities { cell_mode: ascii, light_background, ..capabilities };
        contents(format, "ball", &picture, None, &capabilities).expect("written")
    };
    assert_ne!(in_ascii(Format::Ansi, true), in_ascii(Format::Ansi, false), "the terminal's background");
    assert_eq!(in_ascii(Format::Svg, true), in_ascii(Format::Svg, false), "a drawing is on black");
    for &format in Format::ALL {
        assert!(!written(format).is_empty(), "{format:?}");
    }
}

#[test]
fn nothing_is_written_over() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let write = |contents: &[u8]| write_new(folder.path(), "ball", Format::Svg, contents);
    assert_eq!(write(b"1").expect("written"), "ball.svg");
    std::fs::create_dir(folder.path().join("ball-2.svg")).expect("a folder can be made");
    assert_eq!(write(b"3").expect("written"), "ball-3.svg");
    assert_eq!(std::fs::read(folder.path().join("ball.svg")).expect("it is there"), b"1");
    std::fs::remove_file(folder.path().join("ball.svg")).expect("it can be removed");
    assert_eq!(write(b"again").expect("written"), "ball.svg");
    assert!(write_new(&folder.path().join("missing"), "ball", Format::Png, b"").is_err());
}
