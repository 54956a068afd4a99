//! The formats and outputs of a frame, and the flags that decide about its pixels.

use super::{Folder, finish};

#[test]
fn the_extension_chooses_the_format() {
    let folder = Folder::new();
    for (name, format) in [
        ("frame.txt", "text"),
        ("frame.text", "text"),
        ("frame.TXT", "text"),
        ("frame.ans", "ansi"),
        ("frame.ansi", "ansi"),
        ("a.b.ansi", "ansi"),
        ("frame.svg", "svg"),
        ("frame.html", "html"),
        ("frame.htm", "html"),
        ("frame.png", "png"),
        ("frame.PNG", "png"),
    ] {
        // Standard output is empty.
        assert_eq!(folder.frame(&format!("ball.ron --size 20x8 -o {name}")), b"");
        assert!(folder.read(name) == folder.frame(&format!("ball.ron --size 20x8 --format {format}")), "{name}");
    }
    assert_eq!(folder.frame("ball.ron --size 20x8 --output=long.txt"), b"");
    assert_eq!(folder.read("long.txt"), folder.read("frame.txt"));
}

#[test]
fn the_format_flag_overrides_the_extension() {
    let folder = Folder::new();
    for (name, format) in
        [("picture.png", "text"), ("picture.txt", "png"), ("picture.jpg", "ansi"), ("picture", "text")]
    {
        folder.frame(&format!("ball.ron --size 20x8 -o {name} --format {format}"));
        assert!(folder.read(name) == folder.frame(&format!("ball.ron --size 20x8 --format {format}")), "{name}");
    }
}

#[test]
fn unknown_extensions_and_formats_are_rejected() {
    let folder = Folder::new();
    for name in ["frame.jpg", "frame", ".txt", "frame.txt~", "frame.bmp"] {
        folder.run(&format!("frame ball.ron -o {name}")).fails_in_a_line(2, "--format");
        assert!(!folder.path(name).exists(), "{name} was made");
    }
    folder.run("frame ball.ron --format jpeg").is_misused("text, ansi, svg, html, png");
}

/// A frame that fails does not change the file of an earlier one.
#[test]
fn a_failure_leaves_the_file_alone() {
    let folder = Folder::new();
    folder.write("frame.txt", "kept");
    folder.run("frame missing.ron -o frame.txt").fails_in_a_line(2, "missing.ron");
    folder.run("frame ball.ron --fov 200 -o frame.txt").fails_in_a_line(2, "field of view");
    folder.run("frame ball.ron --size 70000x1 -o frame.txt").fails_in_a_line(2, "too large");
    assert_eq!(folder.read("frame.txt"), b"kept");
}

#[test]
fn a_text_frame_is_printable_ascii() {
    let folder = Folder::new();
    let frame = folder.frame("ball.ron");
    assert!(frame.iter().all(|&byte| byte == b'\n' || (b' '..=b'~').contains(&byte)));
}

#[test]
fn more_samples_smooth_the_edges() {
    let folder = Folder::new();
    let frame = |samples: &str| folder.frame(&format!("ball.ron --size 40x12 --format ansi{samples}"));
    assert!(frame("") == frame(" --samples 1"));
    assert!(frame("") != frame(" --samples 4"));
    assert!(frame(" --samples 4") != frame(" --samples 5"));
    assert!(frame(" --samples best") != frame(" --samples 4"));
    for samples in ["0", "-1", "many", "1.5", "99999999", "Best"] {
        folder.run(&format!("frame ball.ron --samples={samples}")).is_misused("--samples");
    }
}

/// In an area of one colour the number of samples has no effect.
#[test]
fn samples_of_one_colour_are_that_colour() {
    let folder = Folder::new();
    folder.write("sky.ron", r##"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: "#87a6cc")"##);
    let once = folder.frame("sky.ron --size 4x2 --format ansi");
    assert_eq!(String::from_utf8_lossy(&once), "\x1b[48;2;135;166;204m    \x1b[0m\n".repeat(2));
    for samples in [2, 3, 7, 16] {
        assert!(once == folder.frame(&format!("sky.ron --size 4x2 --format ansi --samples {samples}")), "{samples}");
    }
}

/// No byte depends on the number of threads, the environment or the time.
#[test]
fn a_frame_depends_on_its_arguments_alone() {
    let folder = Folder::new();
    for format in ["text", "ansi", "png"] {
        let arguments = format!("frame ball.ron --size 70x30 --samples 2 --format {format}");
        let frame = folder.run(&arguments).done();
        assert!(frame == folder.run(&arguments).done(), "{format}: twice");
        for threads in [1, 2, 7] {
            let again = folder.run(&format!("{arguments} --threads {threads}")).done();
            assert!(frame == again, "{format}: {threads} threads");
        }
        assert!(frame == finish(folder.command(&arguments).env_clear()).done(), "{format}: no environment");
        let mut command = folder.command(&arguments);
        command.env_clear().envs([
            ("NO_COLOR", "1"),
            ("TERM", "dumb"),
            ("COLUMNS", "11"),
            ("LINES", "5"),
            ("COLORTERM", "no"),
            ("LC_ALL", "C"),
            ("LANG", "de_DE.ISO-8859-1"),
            ("RAYON_NUM_THREADS", "3"),
            ("CLICOLOR", "0"),
            ("CLICOLOR_FORCE", "1"),
            ("TERMTRACE_SIZE", "3x3"),
        ]);
        assert!(frame == finish(&mut command).done(), "{format}: another environment");
    }
}

#[test]
fn the_number_of_threads_must_be_positive() {
    let folder = Folder::new();
    for command in ["frame ball.ron", "check ball.ron", "ball.ron"] {
        for threads in ["0", "-2", "many", "100000"] {
            folder.run(&format!("{command} --threads={threads}")).is_misused("--threads");
        }
        folder.run(&format!("{command} --threads 3")).done();
    }
}

/// A cell's aspect is its height over its width.
///
/// In flatter cells a ball of the same rows takes fewer columns.
#[test]
fn a_ball_is_round_in_cells_of_any_aspect() {
    let folder = Folder::new();
    folder.write(
        "round.ron",
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0), vertical_fov: 20), ambient: 1, objects: [
            Sphere(center: (0, 0, 0), radius: 1)])",
    );
    for aspect in ["1", "1.5", "1.9", "2", "2.5", "3"] {
        let frame = folder.frame(&format!("round.ron --size 150x40 --cell-aspect {aspect}"));
        let lines: Vec<_> = frame.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).collect();
        let height = lines.iter().filter(|line| !line.is_empty()).count() as f64;
        let width = lines.iter().map(|line| line.len()).max().unwrap_or(0) as f64;
        // The radius is tan of half the ball's angle over tan of half the field of view, of 40 rows.
        let radius = (1.0 / 99.0_f64.sqrt()) / libm::tan(10.0_f64.to_radians());
        assert!((height - 40.0 * radius).abs() <= 2.0, "{height} rows at aspect {aspect}");
        let expected = 40.0 * radius * aspect.parse::<f64>().expect("a number");
        assert!((width - expected).abs() <= 2.0, "{width} columns at aspect {aspect}, not {expected}");
        // Without a size, the program prints the same shape.
        let usual = folder.frame(&format!("round.ron --cell-aspect {aspect}"));
        assert!(usual == folder.run(&format!("round.ron --cell-aspect {aspect}")).done());
    }
    for aspect in ["0", "-1", "nan", "inf", "wide", "1000"] {
        folder.run(&format!("frame round.ron --cell-aspect={aspect}")).is_misused("--cell-aspect");
        folder.run(&format!("round.ron --cell-aspect={aspect}")).is_misused("--cell-aspect");
    }
}
