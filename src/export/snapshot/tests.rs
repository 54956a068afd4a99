use super::*;
use crate::color::Srgb8;
use crate::grid::Size;

/// Checks that trimming a framed grid, as snapshot tools do, loses neither the size nor blank rows.
#[test]
fn blanks_are_within_the_frame() {
    for (size, expected) in [
        (Size::new(3, 2), "3x2\n+---+\n|   |\n|   |\n+---+\n"),
        (Size::new(0, 0), "0x0\n++\n++\n"),
        (Size::new(2, 0), "2x0\n+--+\n+--+\n"),
    ] {
        let framed = framed(&Grid::new(size));
        assert_eq!(framed, expected);
        assert_eq!(framed.trim_end().lines().count(), expected.lines().count());
    }
}

/// Checks that each style has a code of its own, for small and large numbers of styles.
#[test]
fn any_number_of_styles_has_distinct_codes() {
    for columns in [1, 62, 63, 300, 4000] {
        let mut grid = Grid::new(Size::new(columns, 1));
        for at in 0..u32::from(columns) {
            let [_, r, g, b] = at.to_be_bytes();
            grid.set_at(at as usize, &Cell::new('x', Ink::Rgb(Srgb8::new(r, g, b)), Ink::Default));
        }
        let styled = styled(&grid);
        let legend: std::collections::BTreeSet<&str> =
            styled.lines().skip(6).filter_map(|line| Some(line.split_once(": ")?.0)).collect();
        assert_eq!(legend.len(), usize::from(columns));
        let letters = usize::from(columns > 62) + usize::from(columns > 62 * 62) + 1;
        assert!(legend.iter().all(|code| code.len() == letters), "{legend:?}");
    }
}

#[test]
fn all_properties_of_a_cell_are_described() {
    let mut grid = Grid::new(Size::new(2, 1));
    let cell = Cell { underline: Ink::Indexed(3), attributes: Attributes::all(), ..Cell::BLANK };
    *grid.cell_mut(0, 0) = Cell { bg: Ink::Rgb(Srgb8::new(1, 2, 255)), ..cell };
    *grid.cell_mut(1, 0) = Cell::FOREIGN;
    let attributes = "bold, dim, italic, underlined, slow blink, rapid blink, reversed, hidden, crossed out";
    let expected = format!("\na: default on #0102ff, {attributes}, line in color 3\nb: default, left as it is\n");
    assert!(styled(&grid).ends_with(&expected), "{}", styled(&grid));
}
