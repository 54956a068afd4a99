use super::*;

#[test]
fn cells_of_even_height_may_use_either_half_block() {
    for (rows, height, expected) in
        [(24, 480, true), (24, 456, false), (24, 24 * 17, false), (24, 497, false), (24, 0, false), (0, 480, false)]
    {
        assert_eq!(half_blocks(rows, height) == HalfBlocks::Either, expected, "{rows} rows in {height} pixels");
    }
}

#[test]
fn a_cell_aspect_needs_a_plausible_window() {
    for (columns, rows, width, height, expected) in [
        (80, 24, 800, 480, Some(2.0)),
        (80, 24, 800, 456, Some(1.9)),
        (80, 24, 805, 497, Some(2.0)),
        (80, 24, 0, 0, None),
        (0, 0, 800, 480, None),
        (80, 24, 79, 480, None),
        (80, 24, 65535, 24, None),
    ] {
        assert_eq!(cell_aspect(columns, rows, width, height), expected, "{columns}x{rows} in {width}x{height}");
    }
}
