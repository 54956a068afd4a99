use super::*;
use crate::viewer::theme::foot;

#[test]
fn each_map_has_its_legend_below_it() {
    let screen = Rect::new(0, 0, 81, 24);
    let texts = ["shaded".to_owned(), "depth: white 0, grey 6.41, black far".to_owned()];
    let places: Vec<_> = legend_areas(&texts, foot(screen, 0)).map(|(_, area)| area).collect();
    assert_eq!(places, [Rect::new(0, 23, 8, 1), Rect::new(41, 23, 38, 1)]);
    assert_eq!(foot(screen, 1).y, 22, "above the status line");
    assert_eq!(legend_areas(&texts[1..], Rect::new(0, 5, 20, 1)).next(), Some((&*texts[1], Rect::new(0, 5, 20, 1))));
}
