use super::*;

/// The panel never covers the explained cell or the marks around it, and lies within the screen.
#[test]
fn the_panel_is_never_on_the_cursor() {
    for (columns, rows) in [(40, 12), (41, 13), (79, 24), (80, 24), (81, 25), (200, 60), (65_535, 12), (40, 65_535)] {
        let screen = Rect::new(0, 0, columns, rows);
        let columns =
            (0..columns).step_by(usize::from(columns / 40)).chain([columns / 2 - 1, columns / 2, columns - 1]);
        for column in columns {
            for row in (0..rows).step_by(usize::from(rows / 12)).chain([rows / 2 - 1, rows / 2, rows - 1]) {
                let panel = panel_area(screen, [column, row]);
                let around = Rect::new(column.saturating_sub(1), row, 3, 1);
                assert!(!panel.intersects(around) && panel.union(screen) == screen, "{screen} {column} {row} {panel}");
                assert!(panel.height >= 3 && panel.width >= 39, "{screen} {panel}");
            }
        }
    }
}

#[test]
fn the_inset_is_as_high_as_the_text_lets_it() {
    let heights = |inside, lines| split_panel(Rect::new(2, 1, 35, inside), lines).map(|area| area.height);
    assert_eq!(heights(20, 40), [12, 7]);
    assert_eq!(heights(56, 30), [38, 17]);
    assert_eq!(heights(44, 30), [30, 13]);
    assert_eq!(heights(6, 40), [6, 0]);
}
