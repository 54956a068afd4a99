use super::*;
use crate::capabilities::CellMode;
use crate::viewer::theme::row_from_bottom;

#[test]
fn each_map_has_its_legend_in_its_corner() {
    let screen = Rect::new(0, 0, 81, 24);
    let texts = ["shaded".to_owned(), "depth: white 0, grey 6.41, black far".to_owned()];
    let places =
        |line| legend_areas(&texts, line, row_from_bottom(screen, 0)).iter().map(|(_, area)| *area).collect::<Vec<_>>();
    let (left, right) = (Rect::new(0, 23, 8, 1), Rect::new(43, 23, 38, 1));
    assert_eq!(places(0.5), [left, right]);
    // A legend that is wider than its picture is reduced to the map's name, or to nothing.
    assert_eq!(places(0.6), [left, Rect::new(74, 23, 7, 1)]);
    assert_eq!(places(0.95), [left]);
    assert_eq!(places(0.05), [right]);
    assert_eq!(places(0.0), [right]);
    assert_eq!(row_from_bottom(screen, 1).y, 22, "above the status line");
    let narrow = Rect::new(0, 5, 20, 1);
    assert_eq!(legend_areas(&texts[1..], 0.5, narrow), [(&*texts[1], narrow)]);
}

#[test]
fn the_cost_map_has_a_color_bar() {
    let text = "cost: blue 1, green 16, red 256 tests";
    let area = Rect::new(0, 5, text.len() as u16 + 2, 1);
    let drawn = |colors| {
        let mode = CellMode { colors, ..CellMode::HALF_BLOCK };
        let mut buffer = Buffer::empty(area);
        draw(text, Theme::for_cell_mode(mode), area, &mut buffer);
        draw_cost_bar(colors, area, &mut buffer);
        buffer
    };
    let symbols = |buffer: &Buffer| buffer.content.iter().map(ratatui_core::buffer::Cell::symbol).collect::<String>();
    let bar = drawn(Colors::Truecolor);
    assert_eq!(symbols(&bar), " cost: 1   4   16  64  256 1024 tests  ");
    // Each number is on the colour of that number of tests.
    for (column, tests) in [(7, 1), (11, 4), (15, 16), (19, 64), (23, 256), (27, 1024)] {
        let Srgb8 { r, g, b } = cost_color(tests);
        assert_eq!(bar[(column, 5)].bg, Color::Rgb(r, g, b), "{tests}");
    }
    assert_eq!(symbols(&drawn(Colors::Indexed256)), symbols(&bar));
    assert_eq!(symbols(&drawn(Colors::None)), format!(" {text} "));
}
