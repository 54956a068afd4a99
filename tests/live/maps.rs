//! The maps of a scene in the live view, and two of them compared: keys in, screen out.

use crate::pty::{SOON, Screen, Session, Size, Start, halves_of, shows};
use std::cmp::Ordering;
use std::path::Path;
use termtrace::internals::{cell, maps};
use termtrace::{CellMode, Map, Picture, Resolution, Sampling, Scene, Srgb8};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");
const SIZE: Size = Size { columns: 60, rows: 20, cell: (10, 20) };

fn start() -> Session {
    start_with(&[])
}

fn start_with(flags: &[&str]) -> Session {
    started(SIZE, flags)
}

fn started(size: Size, flags: &[&str]) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).size(size);
    flags.iter().fold(start, Start::arg).spawn()
}

fn scene() -> Scene {
    Scene::load(Path::new(SCENE)).expect("the scene is fine")
}

/// Returns the refined picture of a map.
fn whole(map: Map) -> Picture {
    let scene = scene();
    let resolution = cell::resolution(CellMode::HALF_BLOCK, grid_size(), 2.0).expect("a size that pictures can have");
    maps::picture(map, &scene, scene.camera(), resolution, Sampling::BEST)
}

fn grid_size() -> termtrace::Size {
    termtrace::Size::new(SIZE.columns, SIZE.rows)
}

/// Returns whether the screen shows this picture in all rows but the last.
fn shows_above(screen: &Screen, picture: &Picture) -> bool {
    let wanted = cell::grid_from_picture(CellMode::HALF_BLOCK, picture);
    let columns = usize::from(SIZE.columns);
    let above = usize::from(SIZE.rows - 1) * columns;
    wanted.cells().take(above).enumerate().all(|(at, cell)| {
        let shown = screen.cell(at % columns, at / columns);
        let glyph = ['▄', '▀', ' '].into_iter().find(|&glyph| cell.glyph == glyph).expect("a picture");
        halves_of(glyph, cell.fg.into(), cell.bg.into()) == halves_of(shown.glyph, shown.foreground, shown.background)
    })
}

/// Waits for the picture in all rows but the last, and for that last row.
#[track_caller]
fn wait_for(session: &mut Session, what: &str, picture: &Picture, last: impl Fn(&str) -> bool) {
    session.wait_for(what, SOON, |seen| {
        let screen = seen.screen();
        screen.text().last().is_some_and(|row| last(row)) && shows_above(screen, picture)
    });
}

#[test]
fn v_and_b_cycle_through_the_maps_and_show_their_legends() {
    let mut session = start();
    wait_for(&mut session, "the light", &whole(Map::Shaded), |last| !last.contains("shaded"));
    let scene = scene();
    for map in Map::ALL.into_iter().skip(1) {
        session.send(b"v");
        // In colour, the legend of the cost is a bar of its colours.
        let legend = match map {
            Map::Cost => "cost: 1   4   16  64  256 1024 tests".to_owned(),
            _ => map.legend(&scene, scene.camera()),
        };
        wait_for(&mut session, map.name(), &whole(map), |last| last.contains(&legend));
    }
    session.send(b"v");
    wait_for(&mut session, "the light again", &whole(Map::Shaded), |last| !last.contains("wire"));
    session.send(b"b");
    wait_for(&mut session, "the last map", &whole(Map::Wire), |last| last.contains("wire"));
    session.send(b"q");
    session.wait_exit(SOON);
}

#[test]
fn the_map_asked_for_is_there_at_first() {
    let mut session = start_with(&["--map", "depth"]);
    wait_for(&mut session, "depths", &whole(Map::Depth), |last| last.contains("depth: white 0, grey 6.41"));
    // The status line and its keys are below.
    session.send(b"i");
    session.wait_for("all three lines", SOON, |seen| {
        let text = seen.screen().text();
        text[17].contains("depth:") && text[18].contains("? help") && text[19].contains(" eye ")
    });
}

/// Comparing shows two maps side by side, then one with a divider that keys move, then one.
#[test]
fn two_maps_are_compared() {
    let mut session = start();
    wait_for(&mut session, "the light", &whole(Map::Shaded), |_| true);
    session.send(b"|vv");
    let scene = scene();
    let half = |width, map| {
        let resolution = Resolution::square(width, u32::from(SIZE.rows) * 2);
        maps::picture(map, &scene, scene.camera(), resolution, Sampling::BEST)
    };
    // The right one ends at the right edge; where its picture is narrow, only its name is left.
    let legends = |last: &str| last.starts_with(" shaded ") && last.trim_end().ends_with(" normal");
    let all_of_normal =
        |last: &str| !last.contains("shaded") && last.trim_end().ends_with(" normal: red x, green y, blue z");
    let beside = joined(&half(29, Map::Shaded), &half(30, Map::Normal));
    wait_for(&mut session, "two pictures", &beside, legends);
    session.send(b"|");
    let wipe = |line| wiped(&whole(Map::Shaded), &whole(Map::Normal), line);
    wait_for(&mut session, "a wipe", &wipe(30), legends);
    session.send(b">>>><");
    // Three steps of a thirty-second of 60 columns.
    wait_for(&mut session, "the line further right", &wipe(35), legends);
    session.send(&b"<".repeat(40));
    wait_for(&mut session, "the line at the left edge", &wipe(0), all_of_normal);
    session.send(b"|");
    wait_for(&mut session, "the light alone", &whole(Map::Shaded), |last| !last.contains("shaded"));
}

const LINE: Srgb8 = Srgb8::new(255, 208, 64);

fn joined(left: &Picture, right: &Picture) -> Picture {
    let rows = left.pixels().chunks(left.width() as usize).zip(right.pixels().chunks(right.width() as usize));
    let pixels = rows.flat_map(|(left, right)| [left, &[LINE][..], right].concat()).collect();
    Picture::from_pixels(left.width() + 1 + right.width(), left.height(), pixels).expect("all its pixels")
}

fn wiped(left: &Picture, right: &Picture, line: u32) -> Picture {
    let at = |at: u32| match (at % left.width()).cmp(&line) {
        Ordering::Less => left.pixels()[at as usize],
        Ordering::Equal => LINE,
        Ordering::Greater => right.pixels()[at as usize],
    };
    let pixels = (0..left.width() * left.height()).map(at).collect();
    Picture::from_pixels(left.width(), left.height(), pixels).expect("all its pixels")
}

/// Legends are hidden on a small screen.
#[test]
fn small_screens_have_no_legend() {
    let size = Size { rows: 11, ..SIZE };
    let mut session = started(size, &["--map", "normal"]);
    let scene = scene();
    let grid_size = termtrace::Size::new(size.columns, size.rows);
    let resolution = cell::resolution(CellMode::HALF_BLOCK, grid_size, 2.0).expect("a size that pictures can have");
    let normals = maps::picture(Map::Normal, &scene, scene.camera(), resolution, Sampling::BEST);
    let wanted = cell::grid_from_picture(CellMode::HALF_BLOCK, &normals);
    session.wait_for("the normals and nothing else", SOON, |seen| shows(seen.screen(), &wanted));
}
