use super::*;
use crate::capabilities::{Colors, Glyphs};

#[test]
fn a_picture_covers_windows_of_real_size() {
    for (columns, rows) in [(1, 1), (80, 24), (1920, 500), (65_535, 1), (1, 65_535), (65_535, 16), (1024, 1024)] {
        let size = Size::new(columns, rows);
        assert_eq!(covered_size(size, CellMode::HALF_BLOCK), size);
    }
}

#[test]
fn of_a_larger_window_it_covers_a_part_of_the_same_shape() {
    let shapes = CellMode { glyphs: Glyphs::Shape, colors: Colors::None };
    for (mode, most) in [(CellMode::HALF_BLOCK, 1 << 20), (CellMode::RAMP, 1 << 20), (shapes, 1 << 18)] {
        for (columns, rows) in [(65_535, 65_535), (10_000, 5000), (65_535, 33), (40, 65_535), (1024, 1025)] {
            let size = covered_size(Size::new(columns, rows), mode);
            assert!(size.cell_count() <= most && size.cell_count() > most * 9 / 10, "{size:?}");
            let skew = f64::from(size.columns) * f64::from(rows) / (f64::from(size.rows) * f64::from(columns));
            assert!((0.9..1.1).contains(&skew), "{size:?}");
        }
    }
}
