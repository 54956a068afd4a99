use super::*;
use crate::capabilities::Colors;
use std::collections::HashSet;

/// Checks that a format is complete with one file, its `mod` line and its row of the table, as
/// `Tally` is.
#[test]
fn a_format_for_tests_is_found_and_written() {
    let format = Format::from_name("tally").expect("by its name");
    assert_eq!(Format::from_extension("tal"), Some(format));
    let grid = Grid::new(Size::new(3, 2));
    let FileEncoder::Cells { has_colors: false, write, .. } = format.file_encoder() else { panic!("{format:?}") };
    let file = write(&grid, Colors::None, USUAL_CELL_ASPECT, "ball");
    assert_eq!(String::from_utf8_lossy(&file), "  6\n");
    assert!(format.difference(b"  5\n", &file).text.ends_with("- 1 |  5|\n+ 1 |  6|\n       ^\n"));
}

#[test]
fn formats_share_no_name_extension_or_key() {
    let mut seen = HashSet::new();
    for format in Format::ALL {
        assert!(seen.insert(format.name().to_owned() + " by name"), "{format:?}");
        assert!(seen.insert(format.command().to_owned() + " by command"), "{format:?}");
        assert!(seen.insert(format.key().to_string() + " by key"), "{format:?}");
        for extension in format.row().extensions {
            assert!(seen.insert((*extension).to_owned() + " by extension"), "{format:?}");
            assert_eq!(Format::from_extension(extension), Some(*format));
        }
    }
}
