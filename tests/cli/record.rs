//! `termtrace record`: films, frame by frame.

use super::pty::{SOON, Start};
use super::{BALL, Folder, finish, shipped_scenes};
use rustix::process::Signal;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader};
use std::num::NonZeroU32;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::Stdio;
use termtrace::internals::cell::grid_from_picture;
use termtrace::internals::color::Oklab;
use termtrace::{Camera, CameraPath, CellMode, Gif, Grid, Ink, Picture, Resolution, Scene, Srgb8, render, tone};

/// Three keyframes, the first of them twice: a film that stands still at first.
const FLIGHT: &str = "(keyframes: [
    (time: 0, eye: (1, 1.5, 6), target: (0, 0.7, 0)),
    (time: 0.25, eye: (1, 1.5, 6), target: (0, 0.7, 0)),
    (time: 0.5, eye: (3, 1, 4), target: (0, 1, 0), vertical_fov: 60),
    (time: 0.75, eye: (4, 3, 1), target: (0, 0.5, 0), up: (0.2, 1, 0)),
])";

fn ball() -> Scene {
    Scene::from_ron("ball.ron", BALL).expect("the scene is fine")
}

fn picture(scene: &Scene, camera: &Camera, resolution: Resolution) -> Picture {
    tone(&render(scene, camera, resolution, NonZeroU32::MIN), scene)
}

/// The screens of a terminal after each event of an asciicast: header, then times and screens.
struct Played {
    header: serde_json::Value,
    events: Vec<(f64, String)>,
}

fn played(cast: &[u8]) -> Played {
    let text = std::str::from_utf8(cast).expect("an asciicast is UTF-8");
    assert!(text.ends_with('\n'));
    let mut lines = text.lines();
    let header = serde_json::from_str(lines.next().expect("a header")).expect("JSON");
    let events = lines.map(|line| {
        let (time, kind, data): (f64, String, String) = serde_json::from_str(line).expect("an event");
        assert_eq!(kind, "o");
        (time, data)
    });
    Played { header, events: events.collect() }
}

/// Returns the two colours of each cell, upper half first, as the terminal shows them.
fn halves_shown(terminal: &avt::Terminal, columns: usize, rows: usize) -> Vec<[Option<avt::Color>; 2]> {
    let cell = |row: usize, column: usize| {
        let line = terminal.screen().line(row).expect("the row is on the screen");
        let cell = line.cells()[column];
        let pen = cell.pen();
        let (fg, bg) = (pen.foreground(), pen.background());
        let (fg, bg) = if pen.is_inverse() { (bg, fg) } else { (fg, bg) };
        match cell.char() {
            ' ' => [bg, bg],
            '▄' => [bg, fg],
            '▀' => [fg, bg],
            other => panic!("{other:?} is not of a picture"),
        }
    };
    (0..rows).flat_map(|row| (0..columns).map(move |column| cell(row, column))).collect()
}

fn halves_wanted(grid: &Grid) -> Vec<[Option<avt::Color>; 2]> {
    let color = |ink: Ink| match ink {
        Ink::Rgb(c) => Some(avt::Color::rgb(c.r, c.g, c.b)),
        Ink::Default => None,
        Ink::Indexed(_) => panic!("a picture has truecolor"),
    };
    let text = termtrace::export::text(grid);
    let glyphs = text.chars().filter(|&glyph| glyph != '\n');
    let halves = |(glyph, cell): (char, termtrace::Cell)| match glyph {
        ' ' => [color(cell.bg); 2],
        '▄' => [color(cell.bg), color(cell.fg)],
        _ => [color(cell.fg), color(cell.bg)],
    };
    glyphs.zip(grid.cells()).map(halves).collect()
}

/// Asserts that every event of the cast shows exactly the cells of its camera.
#[track_caller]
fn assert_shows(cast: &[u8], fps: u32, resolution: Resolution, cameras: &[Camera]) {
    let scene = ball();
    let (columns, rows) = (resolution.width() as usize, resolution.height().div_ceil(2) as usize);
    let Played { header, events } = played(cast);
    assert_eq!(header, serde_json::json!({"version": 2, "width": columns, "height": rows}));
    assert_eq!(events.len(), cameras.len(), "one event for each frame");
    let mut terminal = avt::Terminal::new(columns, rows).expect("a screen has cells");
    for (frame, ((time, data), camera)) in events.iter().zip(cameras).enumerate() {
        // The reader of JSON rounds in its own way.
        assert!((time - frame as f64 / f64::from(fps)).abs() < 1e-12, "{time}");
        terminal.feed(data);
        let wanted = grid_from_picture(CellMode::HALF_BLOCK, &picture(&scene, camera, resolution));
        assert!(halves_shown(&terminal, columns, rows) == halves_wanted(&wanted), "frame {frame}");
    }
}

#[test]
fn a_cast_shows_each_frame_of_the_orbit() {
    let folder = Folder::new();
    let scene = ball();
    for (flags, fps, resolution, seconds, frames) in [
        ("--seconds 0.5", 30, Resolution::square(80, 48), 0.5, 15),
        ("--seconds 2 --fps 8 --size 33x9 --order color", 8, Resolution::square(33, 18), 2.0, 16),
        ("--seconds 2 --fps 8 --size 33x9 --order=raster", 8, Resolution::square(33, 18), 2.0, 16),
        ("--seconds 0.3 --fps 10 --pixels 21x15", 10, Resolution::square(21, 15), 0.3, 3),
        // The nearest number of frames, and never none.
        ("--seconds 0.33 --fps 10 --size 9x4", 10, Resolution::square(9, 8), 0.33, 3),
        ("--seconds 0.28 --fps 10 --size 9x4", 10, Resolution::square(9, 8), 0.28, 3),
        (
            "--seconds 0.1 --fps 120 --size 30x8 --cell-aspect 1",
            120,
            Resolution::square(30, 16).with_pixel_aspect(0.5).expect("a shape of pixels"),
            0.1,
            12,
        ),
    ] {
        let cast = folder.run(&format!("record ball.ron --quality exact {flags}")).done();
        let cameras = CameraPath::orbit(*scene.camera(), seconds).cameras(frames, fps).expect("a path");
        assert_eq!(cameras[0], *scene.camera(), "it begins with the scene's own view");
        assert_ne!(cameras[frames - 1].pose().eye, cameras[0].pose().eye, "and does not end with it");
        assert_shows(&cast, fps, resolution, &cameras);
    }
    let cast = folder.run("record ball.ron --seconds 1e-9 --size 9x4").done();
    assert_shows(&cast, 30, Resolution::square(9, 8), &[*scene.camera()]);
}

/// Returns the largest distance of two halves of two screens in `OKLab`.
fn distance(shown: &[[Option<avt::Color>; 2]], wanted: &[[Option<avt::Color>; 2]]) -> f32 {
    let oklab = |color: Option<avt::Color>| match color {
        Some(avt::Color::RGB(c)) => Oklab::from_srgb8(Srgb8::new(c.r, c.g, c.b)),
        other => panic!("{other:?} is not of a picture"),
    };
    let halves = shown.iter().flatten().zip(wanted.iter().flatten());
    halves.map(|(&shown, &wanted)| oklab(shown).distance(oklab(wanted))).fold(0.0, f32::max)
}

/// A film of less quality is within its cap while it moves, and exact after a second of rest and at
/// the end.
#[test]
fn a_cast_of_less_quality_is_near_and_becomes_exact() {
    let folder = Folder::new();
    folder.write("flight.ron", FLIGHT);
    let scene = ball();
    let path = CameraPath::from_ron("flight.ron", FLIGHT, scene.camera()).expect("the path is fine");
    let cameras = path.cameras(36, 20).expect("a path");
    let wanted = |camera| {
        halves_wanted(&grid_from_picture(CellMode::HALF_BLOCK, &picture(&scene, camera, Resolution::square(80, 48))))
    };
    let bytes = |cast: &[u8]| played(cast).events.iter().map(|(_, data)| data.len()).sum::<usize>();
    let record = |flags: &str| folder.run(&format!("record ball.ron --path flight.ron --fps 20 {flags}")).done();
    let exact = bytes(&record("--seconds 1.8 --quality exact"));
    for (quality, cap) in [("equal", 0.01), ("fast", 0.02)] {
        let cast = record(&format!("--seconds 1.8 --quality {quality}"));
        let mut terminal = avt::Terminal::new(80, 24).expect("a screen has cells");
        let mut distances = Vec::new();
        for ((_, data), camera) in played(&cast).events.iter().zip(&cameras) {
            terminal.feed(data);
            distances.push(distance(&halves_shown(&terminal, 80, 24), &wanted(camera)));
        }
        assert!(distances.iter().all(|&distance| distance <= cap), "{quality}: {distances:?}");
        assert!(distances[6..15].iter().all(|&distance| distance > cap / 2.0), "{quality} uses its cap: {distances:?}");
        // The camera rests from frame 15 on.
        assert!(distances[15 + 20..].iter().all(|&distance| distance == 0.0), "{quality} at rest: {distances:?}");
        assert!(bytes(&cast) < exact, "{quality}: {} bytes against {exact}", bytes(&cast));

        // A film that ends in motion has an exact last frame, too.
        let cast = record(&format!("--seconds 0.6 --quality {quality}"));
        let mut terminal = avt::Terminal::new(80, 24).expect("a screen has cells");
        let events = played(&cast).events;
        assert_eq!(events.len(), 12);
        for (_, data) in &events {
            terminal.feed(data);
        }
        assert_eq!(distance(&halves_shown(&terminal, 80, 24), &wanted(&cameras[11])), 0.0, "{quality}: the last frame");
    }
}

/// Every frame keeps to the rate but the first, which draws all cells, and the last, which is
/// exact.
#[test]
fn a_cast_keeps_to_its_rate() {
    let folder = Folder::new();
    for quality in ["exact", "equal"] {
        let flags = format!("--size 40x10 --seconds 3 --fps 20 --quality {quality}");
        let cast = folder.run(&format!("record ball.ron {flags} --max-rate 20k")).done();
        let mut sent = 0;
        for (time, data) in &played(&cast).events[..59] {
            assert!(data.is_empty() || sent as f64 <= 20_000.0 * time + 1.0, "{quality}: {sent} bytes before {time} s");
            sent += data.len();
        }
        assert!(sent > 30_000, "{quality}: and uses it: {sent} bytes");
        let free = folder.run(&format!("record ball.ron {flags}")).done();
        assert!(
            played(&free).events[1..59].iter().map(|(_, data)| data.len()).sum::<usize>() > 60_000
                || quality == "equal"
        );
    }
}

#[test]
fn a_cast_shows_each_frame_of_a_path() {
    let folder = Folder::new();
    folder.write("flight.ron", FLIGHT);
    let path = CameraPath::from_ron("flight.ron", FLIGHT, ball().camera()).expect("the path is fine");
    let resolution = Resolution::square(40, 20);
    for (flags, frames) in [("", 15), (" --seconds 0.3", 6), (" --seconds 1", 20)] {
        let flags = format!("--path flight.ron --quality exact --size 40x10 --fps 20{flags}");
        let cast = folder.run(&format!("record ball.ron {flags}")).done();
        assert_shows(&cast, 20, resolution, &path.cameras(frames, 20).expect("a path"));
        let events = played(&cast).events;
        assert!(
            events[1..=5].iter().all(|(_, data)| data.is_empty() || data == "\x1b[?25h"),
            "where nothing moves, nothing is sent"
        );
        assert!(
            events.len() <= 15 || events[16..events.len() - 1].iter().all(|(_, data)| data.is_empty()),
            "it stands at the end"
        );
    }
    // Fields that a keyframe leaves out are the scene's, or the command line's.
    let flags = "--quality exact --size 40x10 --fps 20 --path flight.ron --seconds 0.05";
    let narrow = folder.run(&format!("record ball.ron {flags} --fov 20 --up 1,1,0")).done();
    let lens = ball().camera().rectangle().with_vertical_fov(20_f32.to_radians()).expect("an angle");
    let pose = termtrace::Pose { up: glam::Vec3::new(1.0, 1.0, 0.0), ..ball().camera().pose() };
    assert_shows(&narrow, 20, resolution, &[Camera::new(pose, lens).expect("a camera")]);
}

/// The defaults are those of `frame`, with an orbit of 8 seconds at 30 frames per second.
#[test]
fn the_defaults() {
    let folder = Folder::new();
    let cast = folder.run("record ball.ron").done();
    assert_eq!(played(&cast).events.len(), 240);
    let said =
        "--path orbit --seconds 8 --fps 30 --size 80x24 --samples 1 --cell-aspect 2 --order color --quality equal";
    assert!(cast == folder.run(&format!("record ball.ron {said}")).done());
    let short = folder.run("record ball.ron --seconds 0.5").done();
    assert!(short == folder.run_on("record - --seconds 0.5", BALL).done());
    assert_eq!(folder.run("record ball.ron --seconds 0.5 -o x.cast").done(), b"");
    assert!(short == folder.read("x.cast"));
    assert!(short == folder.run("record ball.ron --seconds 0.5 -o -").done());
    let raster = folder.run("record ball.ron --seconds 0.5 --order raster").done();
    assert!(raster != short);
    assert!(raster == folder.run("record ball.ron --seconds 0.5 --compressed-link").done());
    // The camera and the samples are those of the command line.
    let played = |flags: &str| folder.run(&format!("record ball.ron --seconds 0.1 --size 20x6 {flags}")).done();
    for flags in ["--eye 3,2,5", "--target 0,1,0", "--up 0.2,1,0", "--fov 60", "--samples 4"] {
        assert!(played(flags) != played(""), "{flags}");
    }
}

/// A cast hides the cursor first and shows it last.
///
/// It has no other mode changes, and no query that a viewer's terminal would answer.
#[test]
fn a_cast_has_frames_only() {
    let folder = Folder::new();
    for order in ["color", "raster"] {
        let cast = folder.run(&format!("record ball.ron --seconds 0.5 --order {order}")).done();
        let mut events = played(&cast).events;
        let last = events.len() - 1;
        for (at, change) in [(0, "\x1b[?25l"), (last, "\x1b[?25h")] {
            let without = events[at].1.replacen(change, "", 1);
            assert!(without.len() < events[at].1.len(), "{change:?} is missing");
            events[at].1 = without;
        }
        for (_, data) in events {
            for sequence in data.split('\x1b').skip(1) {
                let end = sequence.find(|c: char| c.is_ascii_alphabetic()).expect("it ends");
                assert!(sequence.starts_with('[') && sequence[end..].starts_with(['m', 'H', 'C', 'G']), "{sequence:?}");
                assert!(sequence[1..end].bytes().all(|byte| byte.is_ascii_digit() || byte == b';'), "{sequence:?}");
            }
            assert!(data.chars().all(|c| !c.is_control() || "\x1b\r\n\x08".contains(c)), "{data:?}");
        }
    }
}

/// Neither the number of threads nor the environment nor the time is seen in any byte.
#[test]
fn a_film_depends_on_its_arguments_alone() {
    let folder = Folder::new();
    for name in ["x.cast", "x.gif", "%d.png"] {
        let arguments = format!("record ball.ron --seconds 0.2 --samples 2 --size 50x20 -o {name}");
        let file = name.replace("%d", "6");
        folder.run(&arguments).done();
        let film = folder.read(&file);
        for threads in [1, 2, 7] {
            folder.run(&format!("{arguments} --threads {threads}")).done();
            assert!(film == folder.read(&file), "{name}: {threads} threads");
        }
        let mut command = folder.command(&arguments);
        command.env_clear().envs([("NO_COLOR", "1"), ("TERM", "dumb"), ("COLUMNS", "11"), ("LC_ALL", "C")]);
        finish(&mut command).done();
        assert!(film == folder.read(&file), "{name}: another environment");
    }
}

fn gif_frames(bytes: &[u8]) -> (gif::Decoder<&[u8]>, Vec<gif::Frame<'static>>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).expect("a GIF");
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        frames.push(frame.clone());
    }
    (decoder, frames)
}

/// The rounded delays add up to the film's length, and the film repeats.
#[test]
fn a_gif_takes_its_time_and_loops() {
    let folder = Folder::new();
    for (fps, seconds, delays) in [
        (30, "1", vec![3, 4, 3, 3, 4, 3]),
        (25, "0.4", vec![4, 4, 4, 4]),
        (50, "0.1", vec![2, 2, 2]),
        (7, "2", vec![14, 15, 14, 14]),
        (1, "2", vec![100, 100]),
    ] {
        folder.run(&format!("record ball.ron --size 8x4 --fps {fps} --seconds {seconds} -o x.gif")).done();
        let bytes = folder.read("x.gif");
        let (decoder, frames) = gif_frames(&bytes);
        assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
        let found: Vec<u32> = frames.iter().map(|frame| frame.delay.into()).collect();
        assert_eq!(found[..delays.len()], delays, "{fps} a second");
        let hundredths = 100.0 * seconds.parse::<f64>().expect("a number");
        assert_eq!(f64::from(found.iter().sum::<u32>()), hundredths.round(), "{fps} a second");
    }
}

/// A GIF without flags is one to look at.
#[test]
fn the_defaults_of_a_gif() {
    let folder = Folder::new();
    folder.run("record ball.ron --seconds 0.08 -o x.gif").done();
    folder.run("record ball.ron --seconds 0.08 --pixels 480x300 --samples best --fps 25 -o y.gif").done();
    assert!(folder.read("x.gif") == folder.read("y.gif"));
}

/// Each pixel of a GIF is that of the picture, but for the choice of colours.
///
/// A transparent pixel keeps its colour.
#[test]
fn a_gif_shows_each_frame() {
    let folder = Folder::new();
    let scene = ball();
    folder.run("record ball.ron --seconds 0.2 --fps 30 --scale 3 --samples 1 -o x.gif").done();
    let bytes = folder.read("x.gif");
    let (_, frames) = gif_frames(&bytes);
    let cameras = CameraPath::orbit(*scene.camera(), 0.2).cameras(6, 30).expect("a path");
    assert_eq!(frames.len(), 6);
    let mut seen = vec![0; 4 * 240 * 144];
    for (frame, camera) in frames.iter().zip(&cameras) {
        let picture = picture(&scene, camera, Resolution::square(80, 48));
        assert_eq!((frame.width, frame.height), (240, 144));
        let mut squares = 0;
        for (i, (new, shown)) in frame.buffer.chunks_exact(4).zip(seen.chunks_exact_mut(4)).enumerate() {
            if new[3] > 0 {
                shown.copy_from_slice(new);
            }
            let wanted = picture.pixels()[i / 240 / 3 * 80 + i % 240 / 3];
            let pairs = [(shown[0], wanted.r), (shown[1], wanted.g), (shown[2], wanted.b)];
            squares += pairs.iter().map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>();
        }
        let mean = squares as f64 / f64::from(3 * 240 * 144);
        assert!(mean < 12.0, "PSNR {:.1}", 10.0 * libm::log10(255.0 * 255.0 / mean));
    }
}

/// A small difference is kept for a few frames, which saves bytes, but not for ever: what has moved
/// on would stay as a ghost.
#[test]
fn a_gif_keeps_no_ghost() {
    let grey = |value| Picture::from_pixels(2, 1, vec![Srgb8::new(value, value, value); 2]).expect("two pixels");
    let mut gif = Gif::begin(Vec::new(), Resolution::square(2, 1), 1, 25).expect("a GIF");
    for value in [100].into_iter().chain([107; 10]) {
        gif.frame(&grey(value)).expect("a frame");
    }
    let bytes = gif.end().expect("the end");
    let (_, frames) = gif_frames(&bytes);
    let is_new: Vec<_> = frames.iter().map(|frame| frame.buffer[3] > 0).collect();
    assert_eq!(is_new.iter().filter(|&&is_new| is_new).count(), 2, "the first frame, and one more: {is_new:?}");
    let last = is_new.iter().rposition(|&is_new| is_new).expect("a frame");
    assert!((2..9).contains(&last), "{is_new:?}");
    assert_eq!(frames[last].buffer[..3], [107; 3]);
}

/// In a viewer's square pixels a ball is as wide as high, whatever the terminal's cells were.
#[test]
fn a_ball_is_round_in_a_gif() {
    let folder = Folder::new();
    folder.write(
        "round.ron",
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0), vertical_fov: 20), ambient: 1, objects: [
            Sphere(center: (0, 0, 0), radius: 1)])",
    );
    for (flags, size) in [
        ("--size 150x40", (150, 80)),
        ("--size 150x40 --cell-aspect 2.5", (150, 100)),
        ("--size 150x40 --cell-aspect 2.5 --scale 2", (300, 200)),
        ("--size 150x40 --cell-aspect 1.5", (200, 80)),
        ("--pixels 90x80", (90, 80)),
    ] {
        folder.run(&format!("record round.ron --seconds 0.1 --fps 10 {flags} -o x.gif")).done();
        let bytes = folder.read("x.gif");
        let (_, frames) = gif_frames(&bytes);
        assert_eq!((frames[0].width, frames[0].height), size, "{flags}");
        let width = usize::from(frames[0].width);
        let lit: Vec<usize> = (0..frames[0].buffer.len() / 4).filter(|i| frames[0].buffer[4 * i] > 9).collect();
        let extent = |of: fn(usize, usize) -> usize| {
            let places = || lit.iter().map(|&i| of(i, width));
            (places().max().expect("a ball") - places().min().expect("a ball")) as f64
        };
        let (across, down) = (extent(|i, width| i % width), extent(|i, width| i / width));
        assert!((across / down - 1.0).abs() < 0.08, "{flags}: {across} by {down}");
    }
}

/// The files are numbered from 1, each as `frame` writes it.
#[test]
fn pngs_are_numbered_frames() {
    let folder = Folder::new();
    folder.run("record ball.ron --seconds 0.1 --size 30x10 --samples 1 --scale 2 -o f-%04d.png").done();
    assert!(folder.read("f-0001.png") == folder.frame("ball.ron --size 30x10 --samples 1 --scale 2 --format png"));
    let cameras = CameraPath::orbit(*ball().camera(), 0.1).cameras(3, 30).expect("a path");
    for (number, camera) in (1..=3).zip(cameras) {
        let picture = picture(&ball(), &camera, Resolution::square(30, 20));
        let wanted = termtrace::export::png(&picture, 1.0, 2).expect("a PNG");
        assert!(folder.read(&format!("f-000{number}.png")) == wanted, "{number}");
    }
    let files = std::fs::read_dir(folder.path(".")).expect("the folder is there").count();
    assert_eq!(files, 1 + 3, "the scene and three frames");
    folder.run("record ball.ron --seconds 0.1 --fps 10 --size 30x10 --cell-aspect 3 -o %d.PNG").done();
    assert!(folder.read("1.PNG") == folder.frame("ball.ron --size 30x10 --cell-aspect 3 --format png"));
}

#[test]
fn impossible_recordings_are_rejected() {
    let folder = Folder::new();
    folder.write("flight.ron", FLIGHT);
    folder.write("still.ron", "(keyframes: [(time: 0, eye: (0, 0, 5), target: (0, 0, 0))])");
    folder.write(
        "through.ron",
        "(keyframes: [
            (time: 0, eye: (0, 0, 4), target: (0, 0, 0)),
            (time: 3, eye: (0, 0, -4), target: (0, 0, 0)),
        ])",
    );
    for (arguments, words) in [
        ("-o x.mp4", "x.mp4: the name does not end in .cast, .gif or .png"),
        ("-o x", "does not end in"),
        ("-o x.png", "as in x-%04d.png"),
        ("-o x%s.png", "one %d or %04d"),
        ("-o x%d-%d.png", "one %d or %04d"),
        ("-o x.gif --fps 51", "at most 50 frames per second"),
        ("-o x.gif --order color", "are for an asciicast"),
        ("-o x%d.png --compressed-link", "are for an asciicast"),
        ("-o x.gif --quality exact", "are for an asciicast"),
        ("-o x.gif --max-rate 1M", "are for an asciicast"),
        ("-o x.cast --scale 2", "--scale is for GIF and PNG"),
        ("-o x.gif --pixels 60000x9 --cell-aspect 1", "at most 65535 in each direction"),
        ("-o x.gif --size 1000x500 --scale 10", "too large"),
        ("-o x%d.png --size 1000x500 --scale 10", "too large"),
        ("-o x.cast --size 70000x1", "too large"),
        ("-o x.cast --seconds 1e6", "a film of 30000000 frames is too long; at most 100000"),
        ("-o x.cast --path missing.ron", "missing.ron: there is no such file"),
        ("-o x.cast --path .", "directory"),
        ("-o x.cast --path still.ron", "still.ron: the path ends at 0 seconds; set a length with --seconds"),
        ("-o x.cast --path through.ron", "through.ron: at 1.5 seconds: the eye and the target are the same point"),
        ("-o x.cast --path flight.ron --eye 1,2,3", "--eye and --target are for the orbit"),
        ("-o x.cast --path flight.ron --target 1,2,3", "--eye and --target are for the orbit"),
        ("-o x.cast --eye 0,0.7,0", "the eye and the target are the same point"),
    ] {
        folder.run(&format!("record ball.ron {arguments}")).fails_in_a_line(2, words);
        assert!(!folder.path("x.cast").exists() && !folder.path("x.gif").exists(), "{arguments}");
    }
    let run = folder.run("record ball.ron --path ball.ron");
    run.fails(2, "ball.ron:1:1: missing field \"keyframes\"; a camera path needs one\n");
    assert!(run.stderr.contains("ball.ron:2:5: unknown field \"camera\""), "{run:?}");
    folder.run("record missing.ron").fails_in_a_line(2, "missing.ron");
    for flags in ["--seconds 0", "--seconds=-1", "--seconds nan", "--seconds inf", "--seconds 1e7", "--seconds long"] {
        folder.run(&format!("record ball.ron {flags}")).is_misused("--seconds");
    }
    for flags in ["--fps 0", "--fps 121", "--fps 29.97"] {
        folder.run(&format!("record ball.ron {flags}")).is_misused("--fps");
    }
    folder.run("record ball.ron --order rows").is_misused("color, raster");
    folder.run("record ball.ron --order raster --compressed-link").is_misused("cannot be used with");
    folder.run("recrod ball.ron").fails_in_a_line(2, "did you mean \"record\"?");
}

#[test]
fn outputs_that_take_no_film_are_errors() {
    let folder = Folder::new();
    for place in ["missing/x.cast", "missing/x.gif"] {
        folder.run(&format!("record ball.ron --seconds 0.1 -o {place}")).fails_in_a_line(1, place);
    }
    folder.run("record ball.ron --seconds 0.1 -o missing/%d.png").fails_in_a_line(1, "missing/1.png");
    // Only Linux has a device that is always full.
    let full = Path::new("/dev/full");
    if full.exists() {
        for name in ["x.cast", "x.gif", "1.png"] {
            std::os::unix::fs::symlink(full, folder.path(name)).expect("a link can be made");
        }
        folder.run("record ball.ron --seconds 0.1 --size 9x4 -o x.cast").fails_in_a_line(1, "x.cast: No space left");
        folder.run("record ball.ron --seconds 0.1 --size 9x4 -o x.gif").fails_in_a_line(1, "x.gif: No space left");
        folder.run("record ball.ron --seconds 0.1 -o %d.png").fails_in_a_line(1, "1.png: No space left");
        let full = OpenOptions::new().write(true).open(full).expect("it can be opened");
        let output = folder.command("record ball.ron --seconds 1").stdout(full).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(String::from_utf8_lossy(&output.stderr), "error: standard output: No space left on device\n");
    }
}

/// `| head`: a reader that closes the pipe ends the film, without a message.
#[test]
fn a_reader_may_leave_early() {
    let folder = Folder::new();
    let mut command = folder.command("record ball.ron --fps 100 --seconds 1000 --size 20x6");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let mut line = String::new();
    let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
    reader.read_line(&mut line).expect("a line");
    assert_eq!(line, "{\"version\":2,\"width\":20,\"height\":6}\n");
    drop(reader);
    let output = child.wait_with_output().expect("a child can be waited for");
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0), "{output:?}");
}

#[test]
fn every_shipped_scene_and_path_can_be_recorded() {
    let folder = Folder::new();
    for scene in shipped_scenes() {
        folder.run(&format!("record {} --seconds 0.1 --size 20x6", scene.display())).done();
    }
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let path = format!("{scenes}/paths/among_the_spheres.ron");
    let cast = folder.run(&format!("record {scenes}/three_spheres.ron --path {path} --fps 5 --size 20x6")).done();
    assert_eq!(played(&cast).events.len(), 50);
}

#[test]
fn help_has_the_flags_and_the_forms() {
    let help = Folder::new().run("record --help").text();
    for words in [
        "--path",
        "orbit",
        "--seconds",
        "--fps",
        "--size",
        "--pixels",
        "--samples",
        "--order",
        "--compressed-link",
        "--output",
        "--scale",
        "--threads",
        "keyframes:",
        "numbered from 1",
        "cannot see whether",
        "Examples:",
    ] {
        assert!(help.contains(words), "{words}: {help}");
    }
}

// On a terminal ----------------------------------------------------------------------------------------------------

fn on_a_terminal(folder: &Folder, arguments: &str) -> Start {
    let ball = folder.path("ball.ron");
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg("record").arg(ball);
    arguments.split_whitespace().fold(start, Start::arg)
}

#[test]
fn a_bar_shows_the_progress_and_leaves_a_line() {
    let folder = Folder::new();
    for (file, size) in [("x.cast", "30x10 cells"), ("x.gif", "30x20"), ("x-%d.png", "30x20")] {
        let flags = format!("--seconds 2 --fps 30 --size 30x10 -o {file}");
        let script =
            format!("cd '{}'; {} record ball.ron {flags}", folder.path(".").display(), env!("CARGO_BIN_EXE_termtrace"));
        let mut session = Start::shell(&script).spawn();
        assert_eq!(session.wait_exit(SOON).code(), Some(0));
        session.assert_clean();
        let seen = session.seen();
        let bytes = String::from_utf8_lossy(seen.bytes());
        assert!(bytes.contains("0/60 frames"), "{bytes:?}");
        let text = seen.screen().text();
        assert!(
            text[0].starts_with(&format!("{file}: 60 frames, {size}, ")) && text[0].trim().ends_with("kB"),
            "{text:?}"
        );
        assert!(text[1..].iter().all(|line| line.trim().is_empty()), "{text:?}");
        assert_eq!(seen.screen().cursor(), Some((0, 1)));
    }
    // The error of a film is on a line of its own.
    let mut session = on_a_terminal(&folder, "--seconds 2 -o /missing/%d.png").spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(1));
    assert!(session.seen().screen().text()[0].contains("error: /missing/1.png: No such file"));
}

/// A terminal that cannot return to the start of a line gets no bar.
#[test]
fn a_dumb_terminal_gets_no_bar() {
    let folder = Folder::new();
    let mut session =
        on_a_terminal(&folder, "--seconds 1").arg("-o").arg(folder.path("x.cast")).env("TERM", "dumb").spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    assert_eq!(session.seen().bytes(), b"");
}

/// The bar goes to the terminal and the film to the pipe: neither gets the other's bytes.
#[test]
fn the_bar_stays_out_of_a_pipe() {
    let folder = Folder::new();
    let output = File::create(folder.path("x.cast")).expect("a file can be made");
    let mut session = on_a_terminal(&folder, "--seconds 2").stdout(output).spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    assert!(String::from_utf8_lossy(session.seen().bytes()).contains("/60 frames"));
    assert!(folder.read("x.cast") == folder.run("record ball.ron --seconds 2").done());
}

#[test]
fn ctrl_c_ends_by_the_signal_and_leaves_no_bar() {
    let folder = Folder::new();
    let slow = "--seconds 1000 --size 200x60 --samples 64";
    for (key, signal) in [(true, Signal::INT), (false, Signal::TERM), (false, Signal::HUP)] {
        let mut session = on_a_terminal(&folder, slow).arg("-o").arg(folder.path("x.cast")).spawn();
        session.wait_for_text("/30000 frames");
        if key {
            session.send(b"\x03");
        } else {
            session.signal(signal);
        }
        assert_eq!(session.wait_exit(SOON).signal(), Some(signal.as_raw()));
        session.assert_clean();
        let seen = session.seen();
        let text = seen.screen().text().concat();
        assert!(text.trim().is_empty(), "{signal:?}: {text:?}");
    }
}

#[test]
fn ctrl_z_stops_a_recording() {
    let folder = Folder::new();
    let record = format!("'{}' record ball.ron --seconds 1000 -o x.cast", env!("CARGO_BIN_EXE_termtrace"));
    // The shell has job control, and its end kills the stopped job.
    let script =
        format!("cd '{}'; set -m; {record}; printf '\\nstatus <%s>\\n' $?; kill -KILL %1", folder.path(".").display());
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("/30000 frames");
    session.send(b"\x1a");
    session.wait_for_text(&format!("status <{}>", 128 + Signal::TSTP.as_raw()));
    session.wait_exit(SOON);
}

#[test]
fn a_terminal_gets_no_asciicast() {
    let folder = Folder::new();
    for flags in ["--seconds 1", "--seconds 1 -o -"] {
        let mut session = on_a_terminal(&folder, flags).spawn();
        assert_eq!(session.wait_exit(SOON).code(), Some(2));
        session.wait_for_text("error: an asciicast would garble the terminal");
    }
}
