//! The size of a frame.

use super::{BALL, Folder};
use termtrace::{Scene, Size, text_frame};

/// Returns the number of lines and their common length, in characters.
#[track_caller]
fn text_size(frame: &[u8]) -> (usize, usize) {
    assert_eq!(frame.last(), Some(&b'\n'));
    let lines: Vec<_> = frame[..frame.len() - 1].split(|&byte| byte == b'\n').collect();
    for line in &lines {
        assert_eq!(line.len(), lines[0].len());
        assert!(line.iter().all(|byte| (b' '..=b'~').contains(byte)), "{:?}", String::from_utf8_lossy(line));
    }
    (lines[0].len(), lines.len())
}

/// The defaults are promised: users' tests may rely on them.
#[test]
fn a_frame_is_80_by_24_characters() {
    let folder = Folder::new();
    let frame = folder.frame("ball.ron");
    assert_eq!(text_size(&frame), (80, 24));
    assert_eq!(frame.len(), 81 * 24);
    assert_eq!(frame, folder.frame("ball.ron --size 80x24 --format text --samples 1 --cell-aspect 2"));
    // The library's text frame is the same.
    let scene = Scene::from_ron("ball.ron", BALL).expect("the scene is fine");
    assert_eq!(frame, text_frame(&scene, Size::new(80, 24)).into_bytes());
}

#[test]
fn size_is_cells_and_pixels_is_pixels() {
    let folder = Folder::new();
    for (cells, pixels) in [("80x24", "80x48"), ("1x1", "1x2"), ("7x3", "7x6"), ("30X9", "30x18")] {
        for format in ["text --glyphs ramp", "ansi", "png"] {
            let by_cells = folder.frame(&format!("ball.ron --format {format} --size {cells}"));
            let by_pixels = folder.frame(&format!("ball.ron --format {format} --pixels {pixels}"));
            assert!(by_cells == by_pixels, "{format} of {cells} and {pixels}");
        }
    }
    folder.run("frame ball.ron --size 8x4 --pixels 8x8").is_misused("cannot be used with");
}

#[test]
fn any_size_works() {
    let folder = Folder::new();
    for (columns, rows) in [(1, 1), (1, 24), (80, 1), (2, 1), (16, 8), (17, 9), (1000, 500), (65_535, 1), (1, 65_535)] {
        let frame = folder.frame(&format!("ball.ron --size {columns}x{rows}"));
        assert_eq!(text_size(&frame), (columns, rows));
    }
}

/// An odd number of pixel rows fills the upper halves of the last cells.
#[test]
fn an_odd_number_of_pixel_rows_ends_in_half_a_cell() {
    let folder = Folder::new();
    for (pixels, size) in [("1x1", (1, 1)), ("5x3", (5, 2)), ("40x23", (40, 12))] {
        assert_eq!(text_size(&folder.frame(&format!("ball.ron --glyphs ramp --pixels {pixels}"))), size, "{pixels}");
        folder.frame(&format!("ball.ron --pixels {pixels} --format ansi"));
        folder.frame(&format!("ball.ron --pixels {pixels} --format png"));
    }
}

#[test]
fn invalid_sizes_are_rejected() {
    let folder = Folder::new();
    for size in ["0x5", "5x0", "80", "80x", "x24", "80x24x3", "-5x5", "8.5x4", "axb", "99999999999x1", "80*24"] {
        folder.run(&format!("frame ball.ron --size={size}")).is_misused("such as 80x24");
        folder.run(&format!("frame ball.ron --pixels={size}")).is_misused("such as 80x24");
    }
    for size in ["70000x1", "1x70000", "65535x65535", "4294967295x4294967295"] {
        folder.run(&format!("frame ball.ron --size {size}")).fails_in_a_line(2, "too large");
    }
    for size in ["65536x1", "1x131071", "65535x1025", "4294967295x4294967295"] {
        folder.run(&format!("frame ball.ron --glyphs ramp --pixels {size}")).fails_in_a_line(2, "too large");
    }
    folder.run("frame ball.ron --pixels 1000x1000 --scale 256 --format png").fails_in_a_line(2, "too large");
}
