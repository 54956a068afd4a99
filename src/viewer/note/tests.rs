use super::*;

#[test]
fn a_long_note_loses_whole_parts() {
    let hint = "drag or WASD to move; v maps; x explain; ? keys; q quit";
    assert_eq!(drop_clauses_to_fit(hint, 78), hint);
    assert_eq!(drop_clauses_to_fit(hint, 38), "drag or WASD to move; ? keys; q quit");
    assert_eq!(drop_clauses_to_fit(hint, 35), "drag or WASD to move; q quit");
    assert_eq!(drop_clauses_to_fit(hint, 10), "drag or WASD to move");
    assert_eq!(drop_clauses_to_fit("", 10), "");
}

#[test]
fn no_part_of_a_legend_is_left_beside_a_note() {
    let row = |x, width| Rect::new(x, 11, width, 1);
    let legends = [row(0, 14), row(26, 14)];
    for (note, extended_to) in [(5, 14), (14, 14), (20, 20), (26, 26), (27, 40), (40, 40)] {
        assert_eq!(extended(row(0, note), legends.into_iter()), row(0, extended_to), "{note}");
    }
    assert_eq!(extended(Rect::new(0, 10, 30, 1), legends.into_iter()).width, 30, "in another row");
}
