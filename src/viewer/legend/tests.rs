use super::*;
use crate::viewer::theme::foot;

#[test]
fn each_map_has_its_legend_in_its_corner() {
    let screen = Rect::new(0, 0, 81, 24);
    let texts = ["shaded".to_owned(), "depth: white 0, grey 6.41, black far".to_owned()];
    let places = |line| legend_areas(&texts, line, foot(screen, 0)).iter().map(|(_, area)| *area).collect::<Vec<_>>();
    let (left, right) = (Rect::new(0, 23, 8, 1), Rect::new(43, 23, 38, 1));
    assert_eq!(places(0.5), [left, right]);
    // Of one that is wider than its picture the name is left, or nothing.
    assert_eq!(places(0.6), [left, Rect::new(74, 23, 7, 1)]);
    assert_eq!(places(0.95), [left]);
    assert_eq!(places(0.05), [right]);
    assert_eq!(places(0.0), [right]);
    assert_eq!(foot(screen, 1).y, 22, "above the status line");
    let narrow = Rect::new(0, 5, 20, 1);
    assert_eq!(legend_areas(&texts[1..], 0.5, narrow), [(&*texts[1], narrow)]);
}
