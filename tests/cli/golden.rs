//! `frame --check`: snapshot tests without a line of Rust.

use super::Folder;

const ENDINGS: [&str; 3] = ["txt", "ansi", "png"];

/// A user's whole loop: no golden, bless, equal, a change, different, bless.
#[test]
fn bless_check_change_check() {
    for ending in ENDINGS {
        let folder = Folder::new();
        let golden = format!("ball.{ending}");
        let check = format!("frame ball.ron --size 30x10 --check {golden}");
        folder.run(&check).fails_in_a_line(1, "--bless writes it");
        assert!(!folder.path(&golden).exists(), "only --bless writes");
        assert_eq!(folder.run(&format!("{check} --bless")).done(), b"");
        let blessed = folder.read(&golden);
        folder.frame(&format!("ball.ron --size 30x10 --samples 1 -o frame.{ending}"));
        assert!(blessed == folder.read(&format!("frame.{ending}")), "{ending}: the golden is the frame");
        assert_eq!(folder.run(&check).done(), b"", "equal frames are passed over in silence");
        let moved = format!("{check} --eye 1,1.5,6.5");
        let differing = folder.run(&moved);
        assert_eq!((differing.code, differing.stderr.as_str()), (Some(1), ""), "{ending}");
        assert!(!differing.stdout.is_empty());
        assert!(blessed == folder.read(&golden), "a check writes nothing");
        folder.run(&format!("{moved} --bless")).done();
        folder.run(&moved).done();
        assert_eq!(folder.run(&check).code, Some(1));
    }
}

/// Returns the readable difference of a frame from a golden.
#[track_caller]
fn difference(folder: &Folder, arguments: &str) -> String {
    let run = folder.run(&format!("frame {arguments}"));
    assert_eq!((run.code, run.stderr.as_str()), (Some(1), ""));
    let text = String::from_utf8(run.stdout).expect("a diff is text");
    let strange = text.chars().find(|&c| c != '\n' && c.is_control());
    assert_eq!(strange, None, "a diff changes no terminal: {text:?}");
    assert!(text.ends_with('\n'));
    text
}

#[test]
fn a_difference_of_text_shows_rows_and_marks() {
    let folder = Folder::new();
    folder.run("frame ball.ron --size 30x10 --check ball.txt --bless").done();
    let text = String::from_utf8(folder.read("ball.txt")).expect("text");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let right = lines[6].clone();
    lines[6].replace_range(11..12, "?");
    folder.write("ball.txt", lines.join("\n") + "\n");
    let diff = difference(&folder, "ball.ron --size 30x10 --check ball.txt");
    // The message has the file, the position, one line before and after with a mark below, and a line each side of it.
    let mark = " ".repeat(11) + "^";
    let rows = format!("   6 |{}|\n-  7 |{}|\n+  7 |{right}|\n      {mark}\n   8 |{}|\n", lines[5], lines[6], lines[7]);
    let place = "1 of 10 rows differs: line 7, column 12";
    assert_eq!(diff, format!("ball.txt: the frame differs\n{place}\n{rows}"));
}

/// A golden whose trailing blanks an editor has removed differs.
#[test]
fn blanks_at_the_end_of_a_line_count() {
    let folder = Folder::new();
    folder.write("black.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1)");
    assert_eq!(folder.frame("black.ron --size 3x2"), b"   \n   \n");
    folder.write("black.txt", "   \n\n");
    let diff = difference(&folder, "black.ron --size 3x2 --check black.txt");
    assert!(diff.contains("\n- 2 ||\n+ 2 |   |\n"), "{diff}");
    folder.write("black.txt", "   \n   ");
    let diff = difference(&folder, "black.ron --size 3x2 --check black.txt");
    assert!(diff.contains("line feed"), "{diff}");
}

#[test]
fn a_difference_of_ansi_names_row_and_column() {
    let folder = Folder::new();
    folder.run("frame ball.ron --size 30x10 --check ball.ansi --bless").done();
    let right = String::from_utf8(folder.read("ball.ansi")).expect("UTF-8");
    let mut lines: Vec<String> = right.lines().map(str::to_owned).collect();
    let row = lines.iter().position(|line| line.contains('▄')).expect("not all cells are flat");
    let place = lines[row].rfind('▄').expect("it was found");
    // The characters before the position follow each sequence's m.
    let before = lines[row][..place].split('\x1b').map(|part| part.split_once('m').map_or(part, |(_, after)| after));
    let column: usize = before.map(|characters| characters.chars().count()).sum();
    // The upper half block differs from the lower one in the last of its three bytes only.
    for other in ["?", "▀"] {
        let line = lines[row].clone();
        lines[row].replace_range(place..place + '▄'.len_utf8(), other);
        folder.write("ball.ansi", lines.join("\n") + "\n");
        lines[row] = line;
        let diff = difference(&folder, "ball.ron --size 30x10 --check ball.ansi");
        assert!(diff.contains(&format!("1 of 10 rows differs: line {}, column {}\n", row + 1, column + 1)), "{diff}");
        assert!(diff.contains(other) && diff.contains("▄"), "{diff}");
    }
}

#[test]
fn a_difference_of_png_names_the_pixel() {
    let folder = Folder::new();
    // The scene differs by a small ball that covers a few pixels.
    folder.run("frame ball.ron --pixels 60x40 --check ball.png --bless").done();
    let with_more = super::BALL.replace("objects: [", "objects: [Sphere(center: (1.6, 1, 0), radius: 0.04),");
    folder.write("ball.ron", &with_more);
    let before = decoded(&folder.read("ball.png"));
    folder.frame("ball.ron --pixels 60x40 --samples 1 -o after.png");
    let after = decoded(&folder.read("after.png"));
    let differing: Vec<_> = (0..60 * 40).filter(|&i| before[3 * i..3 * i + 3] != after[3 * i..3 * i + 3]).collect();
    assert!(!differing.is_empty(), "the small ball is seen");
    let diff = difference(&folder, "ball.ron --pixels 60x40 --check ball.png");
    let (x, y) = (differing[0] % 60, differing[0] / 60);
    assert!(diff.contains(&format!("{} of 2400 pixels differ", differing.len())), "{diff}");
    assert!(diff.contains(&format!("pixel ({x}, {y})")), "{diff}");
    // The picture beside it is red where the frames differ, and grey elsewhere.
    assert!(diff.ends_with("a picture of the difference: ball.diff.png\n"), "{diff}");
    let marks = decoded(&folder.read("ball.diff.png"));
    let red: Vec<_> = (0..60 * 40).filter(|&i| marks[3 * i] > marks[3 * i + 1]).collect();
    assert_eq!(red, differing);
}

fn decoded(bytes: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("it fits")];
    reader.next_frame(&mut rgb).expect("a picture");
    rgb
}

#[test]
fn a_golden_of_another_size_or_kind_is_reported() {
    let folder = Folder::new();
    folder.run("frame ball.ron --size 30x10 --check ball.png --bless").done();
    let diff = difference(&folder, "ball.ron --size 31x10 --check ball.png");
    assert!(diff.contains("30x20") && diff.contains("31x20"), "{diff}");
    // The pixels are equal, but the file does not say that they are sRGB.
    folder.run("frame ball.ron --size 3x2 --check ball.png --bless").done();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 3, 4);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = decoded(&folder.read("ball.png"));
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).expect("a PNG can be written");
    folder.write("ball.png", file);
    let diff = difference(&folder, "ball.ron --size 3x2 --check ball.png");
    assert!(diff.contains("pixels are equal"), "{diff}");
    // A golden may be any file.
    for ending in ENDINGS {
        let golden = format!("other.{ending}");
        for contents in [&b""[..], b"\0\xff\xfe\x1b[2J\x07\r\n", b"\n\n\n", b"\x89PNG\r\n\x1a\n"] {
            folder.write(&golden, contents);
            difference(&folder, &format!("ball.ron --size 3x2 --check {golden}"));
        }
    }
}

#[test]
fn goldens_that_cannot_be_read_or_written() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder.txt")).expect("a folder can be made");
    folder.run("frame ball.ron --check folder.txt").fails_in_a_line(1, "folder.txt");
    folder.run("frame ball.ron --check folder.txt --bless").fails_in_a_line(1, "folder.txt");
    folder.run("frame ball.ron --check missing/ball.txt --bless").fails_in_a_line(1, "missing/ball.txt");
    folder.run("frame ball.ron --check ball.jpg").fails_in_a_line(2, "--format");
    folder.run("frame ball.ron --bless").is_misused("--check");
    folder.run("frame ball.ron --check a.txt -o b.txt").is_misused("cannot be used with");
    // A scene with an error never becomes a golden.
    folder.run("frame missing.ron --check a.txt --bless").fails_in_a_line(2, "missing.ron");
    assert!(!folder.path("a.txt").exists());
}

#[test]
fn the_format_of_a_golden_may_be_given() {
    let folder = Folder::new();
    folder.run("frame ball.ron --format text --check ball.golden --bless").done();
    assert!(folder.read("ball.golden") == folder.frame("ball.ron"));
    folder.run("frame ball.ron --format text --check ball.golden").done();
    assert_eq!(folder.run("frame ball.ron --format ansi --check ball.golden").code, Some(1));
}
