use super::*;
use crate::capabilities::{CellMode, Glyphs};

/// Returns the panel's rows on a screen of this size.
fn panel(progress: &Progress, cell_mode: CellMode, columns: u16, rows: u16) -> Vec<String> {
    let place = area(Rect::new(0, 0, columns, rows));
    assert!(place.right() <= columns && place.bottom() <= rows);
    let mut buffer = Buffer::empty(place);
    draw(progress, Theme::for_cell_mode(cell_mode), place, &mut buffer);
    let row = |y| (place.left()..place.right()).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (place.top()..place.bottom()).map(row).collect()
}

fn parsing(name: &str, done: usize, total: usize) -> Progress {
    Progress::new(Work::Parsing(name.to_owned()), done, total)
}

#[test]
fn the_panel_says_what_is_done_and_how_far() {
    let half = CellMode::HALF_BLOCK;
    let rows = panel(&parsing("meshes/dragon.ply", 25, 100), half, 20, 5);
    assert_eq!(rows, ["╭──────────────────╮", "│ parsing agon.ply │", "│ ██░░░░░░░░  25 % │", "╰──────────────────╯"]);
    let rows = panel(&parsing("a\u{1b}b.ply", 100, 100), half, 80, 24);
    assert_eq!(rows[1], format!("│ {:42} │", "parsing a\u{fffd}b.ply"));
    assert_eq!(rows[2], format!("│ {} 100 % │", "█".repeat(36)));
    let building = Progress::new(Work::Building, 999, 1000);
    let ascii = CellMode { glyphs: Glyphs::Ramp, ..half };
    assert_eq!(panel(&parsing("é.ply", 0, 1), ascii, 80, 24)[1], format!("| {:42} |", "parsing ?.ply"));
    let rows = panel(&building, ascii, 80, 24);
    assert_eq!([&*rows[0], &*rows[2]], [format!("+{}+", "-".repeat(44)), format!("| {}.  99 % |", "#".repeat(35))]);
}

/// The panel has no progress bar if the total is unknown, and fits every screen.
#[test]
fn the_panel_goes_with_any_file_and_screen() {
    let unknown = parsing("x.glb", 0, 0);
    assert_eq!(panel(&unknown, CellMode::HALF_BLOCK, 20, 5)[2], format!("│ {:16} │", ""));
    for (columns, rows) in [(1, 1), (3, 2), (5, 3), (9, 9), (1, 24)] {
        for progress in [&unknown, &parsing(&"x".repeat(300), 1, 3), &parsing("", 7, 3)] {
            panel(progress, CellMode::HALF_BLOCK, columns, rows);
        }
    }
}
