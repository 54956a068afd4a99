use super::*;
use crate::grid::{Grid, Size};

fn cluster(text: &str) -> Cell {
    Cell { glyph: Glyph::Cluster(text.into()), attributes: Attributes::all(), ..Cell::BLANK }
}

/// Every kind of glyph and colour is read from a grid as it was set, and a cell takes 16 bytes.
#[test]
fn cells_are_read_as_they_were_set() {
    assert_eq!(size_of::<PackedCell>(), 16);
    let glyphs = [' ', '▄', '\u{10ffff}'].map(Glyph::Char);
    let glyphs = glyphs.into_iter().chain([Glyph::Covered, Glyph::Foreign, Glyph::Cluster("e\u{301}".into())]);
    let mut grid = Grid::new(Size::new(1, 1));
    for glyph in glyphs {
        for ink in [Ink::Default, Ink::Indexed(255), Ink::Rgb(Srgb8::new(255, 0, 1))] {
            for attributes in [Attributes::empty(), Attributes::CROSSED_OUT, Attributes::all()] {
                let cell = Cell { glyph: glyph.clone(), fg: ink, bg: Ink::Indexed(0), underline: ink, attributes };
                *grid.cell_mut(0, 0) = cell.clone();
                assert_eq!(grid.cell(0, 0), cell);
            }
        }
    }
}

/// Clusters are compared by their text, and overwritten clusters take no memory.
#[test]
fn clusters_belong_to_their_grid() {
    let [mut one, mut two] = [(); 2].map(|()| Grid::new(Size::new(2, 1)));
    one.set_at(0, &cluster("a\u{301}"));
    two.set_at(1, &cluster("e\u{301}"));
    two.set_at(0, &cluster("a\u{301}"));
    assert_ne!(one, two);
    one.copy_cell(1, &two, two.packed()[1]);
    assert_eq!(one, two);
    assert!(one.is_same(one.packed()[1], &two, two.packed()[1]));
    for number in 0..10_000 {
        one.set_at(1, &cluster(&number.to_string()));
    }
    assert_eq!((one.at(0), one.at(1)), (cluster("a\u{301}"), cluster("9999")));
    assert!(one.clusters.0.len() <= 65, "{}", one.clusters.0.len());
}

/// A change of any one field changes the digest.
#[test]
fn digests_differ() {
    let red = PackedInk::rgb(Srgb8::new(255, 0, 0));
    let cell = PackedCell::new('▄', red, red);
    let others = [
        PackedCell::new('▀', red, red),
        PackedCell { fg: PackedInk::DEFAULT, ..cell },
        PackedCell { bg: PackedInk::DEFAULT, ..cell },
        PackedCell { underline: red, ..cell },
    ];
    assert!(others.iter().all(|other| other.digest() != cell.digest()));
}
