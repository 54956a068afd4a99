//! The explanation of a pixel in the live view: keys in, a panel and a cursor on the screen.

use crate::pty::{SOON, Screen, Session, Size, Start, halves_of, picture, shows};
use std::path::Path;
use termtrace::{CellMode, Grid, Scene, explain};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron");

fn scene() -> Scene {
    Scene::load(Path::new(SCENE)).expect("the scene is fine")
}

fn grid(size: Size) -> Grid {
    picture(&scene(), CellMode::HALF_BLOCK, termtrace::Size::new(size.columns, size.rows), 2.0)
}

/// Starts the view and waits for its refined picture.
#[track_caller]
fn looking(size: Size) -> Session {
    let mut session = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).size(size).spawn();
    let wanted = grid(size);
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
    session
}

#[track_caller]
fn leave(session: &mut Session) {
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

/// Returns whether the lines of the panel are the library's for that pixel, as many as have room.
fn explains(screen: &Screen, size: Size, pixel: [u32; 2]) -> bool {
    let resolution = termtrace::internals::cell::resolution(
        CellMode::HALF_BLOCK,
        termtrace::Size::new(size.columns, size.rows),
        f32::from(size.cell.1) / f32::from(size.cell.0),
    )
    .expect("a size that pictures can have");
    let scene = scene();
    let lines = explain(&scene, scene.camera(), resolution, pixel).lines();
    lines[..12].iter().zip(&screen.text()[1..]).all(|(line, row)| row.contains(line.as_str()))
}

const BOTH: [(u16, u16); 2] = [(80, 24), (200, 60)];

#[test]
fn x_explains_the_middle_and_arrows_go_on_by_a_pixel() {
    for (columns, rows) in BOTH {
        let size = Size::cells(columns, rows);
        let mut session = looking(size);
        let [x, y] = [u32::from(columns) / 2, u32::from(rows)];
        session.send(b"x");
        session.wait_for("the panel", SOON, |seen| explains(seen.screen(), size, [x, y]));
        for (key, pixel) in
            [(b"\x1b[C", [x + 1, y]), (b"\x1b[B", [x + 1, y + 1]), (b"\x1b[D", [x, y + 1]), (b"\x1b[A", [x, y])]
        {
            session.send(key);
            session.wait_for("the next pixel", SOON, |seen| explains(seen.screen(), size, pixel));
        }
        session.send(b"\x1b[1;2C");
        session.wait_for("eight pixels on", SOON, |seen| explains(seen.screen(), size, [x + 8, y]));
        // Esc removes the panel, and the camera has not moved.
        session.send(b"\x1b");
        let wanted = grid(size);
        session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
        leave(&mut session);
    }
}

/// The cell under the cursor shows the picture; the panel moves to the other side of the screen.
#[test]
fn the_explained_pixel_is_not_covered() {
    let size = Size::cells(80, 24);
    let mut session = looking(size);
    let wanted = grid(size);
    session.send(b"x");
    let [mut x, y] = [40_u32, 24];
    for step in [-8_i32, -8, 8, 8, 8, 8] {
        session.send(if step < 0 { b"\x1b[1;2D" } else { b"\x1b[1;2C" });
        x = x.saturating_add_signed(step);
        session.wait_for("the pixel", SOON, |seen| explains(seen.screen(), size, [x, y]));
        let column = x as usize;
        let row = (y / 2) as usize;
        let pixel = wanted.cell(x as u16, row as u16);
        let glyph = ['▄', '▀', ' '].into_iter().find(|&glyph| pixel.glyph == glyph).expect("half blocks");
        let halves = halves_of(glyph, pixel.fg.into(), pixel.bg.into());
        // The picture may still be refined.
        session.wait_for("the picture's own cell", SOON, |seen| {
            let cell = seen.screen().cell(column, row);
            halves_of(cell.glyph, cell.foreground, cell.background) == halves
        });
        let border = if x < 40 { 41 } else { 0 };
        assert_eq!(session.seen().screen().text()[0].chars().nth(border), Some('╭'), "{x}");
    }
    leave(&mut session);
}

#[test]
fn pages_of_the_text_are_turned_to_its_end() {
    let size = Size::cells(80, 24);
    let mut session = looking(size);
    session.send(b"x");
    session.wait_for_text("(i, j) = (40, 24) of 80x48");
    session.wait_for_text("page 1 of");
    session.send(b"\x1b[6~");
    session.wait_for_text("page 2 of");
    session.wait_for_text("o eye q rectangle p hit lit");
    session.send("\x1b[6~".repeat(10).as_bytes());
    session.wait_for_text("cell (40, 12), upper half");
    session.send("\x1b[5~".repeat(10).as_bytes());
    session.wait_for_text("(i, j) = (40, 24) of 80x48");
    leave(&mut session);
}

/// The explanation follows the eye that moves and the size that changes.
#[test]
fn the_explanation_follows_the_view_and_the_window() {
    let size = Size::cells(80, 24);
    let mut session = looking(size);
    session.send(b"x");
    session.wait_for_text("o       0.0000    1.0000    5.0000");
    session.send(b"s ");
    session.wait_for("another eye", SOON, |seen| !seen.screen().text().join("\n").contains("1.0000    5.0000"));
    session.send(b"r");
    session.wait_for_text("o       0.0000    1.0000    5.0000");
    session.resize(Size::cells(100, 40));
    session.wait_for_text("(i, j) = (50, 40) of 100x80");
    // Below this size panels are hidden, and come back above it.
    let small = Size::cells(39, 24);
    session.resize(small);
    let wanted = grid(small);
    session.wait_for("the picture alone", SOON, |seen| shows(seen.screen(), &wanted));
    session.resize(Size::cells(80, 24));
    session.wait_for_text(" of 80x48");
    leave(&mut session);
}
