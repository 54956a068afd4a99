use super::*;

#[test]
fn slips_are_found_and_strangers_are_not() {
    let known = ["center", "radius", "material", "vertical_fov"];
    for (written, meant) in [
        ("radus", Some("radius")),
        ("centre", Some("center")),
        ("Radius", Some("radius")),
        ("fov", Some("vertical_fov")),
        ("colour", None),
        ("x", None),
    ] {
        assert_eq!(closest(written, known), meant, "{written}");
    }
}

proptest::proptest! {
    #[test]
    fn slips_are_counted_as_elsewhere(written in "[abé]{0,7}", known in "[abé]{0,7}") {
        proptest::prop_assert_eq!(edit_distance(&written, &known), strsim::osa_distance(&written, &known));
    }
}

#[test]
fn lists_read_well() {
    assert_eq!(listed(&["a"]), "a");
    assert_eq!(listed(&["a", "b"]), "a and b");
    assert_eq!(listed(&["a", "b", "c"]), "a, b and c");
    assert_eq!(any_of(&["a", "b", "c"]), "a, b or c");
}
