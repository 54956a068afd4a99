use super::*;

const BESIDE: Split = Split::Beside { panel_height: 0 };

fn shown(map: Map, other: Map, split: Split) -> ViewLayout {
    ViewLayout { map, right: Some(RightMap { map: other, split }) }
}

#[test]
fn maps_go_round_and_the_right_one_alone_of_two() {
    let mut seen = ViewLayout::default();
    for map in Map::ALL.into_iter().cycle().skip(1).take(Map::ALL.len()) {
        seen.change_map(Map::next);
        assert_eq!(seen, ViewLayout::single(map));
    }
    let mut two = shown(Map::Lambert, Map::Shaded, BESIDE);
    two.change_map(Map::next);
    assert_eq!(two, shown(Map::Lambert, Map::Depth, BESIDE), "not what is on the left");
    two.change_map(Map::previous);
    assert_eq!(two, shown(Map::Lambert, Map::Shaded, BESIDE));
}

#[test]
fn two_maps_are_beside_each_other_then_wiped_then_one() {
    let mut seen = ViewLayout::single(Map::Depth);
    seen.compare();
    assert_eq!(seen, shown(Map::Depth, Map::Normal, BESIDE));
    seen.compare();
    assert!(seen.is_wipe());
    seen.compare();
    assert_eq!(seen, ViewLayout::single(Map::Depth));
}

/// Two maps side by side share the pixels of one picture, whereas a wipe traces both maps at full
/// size.
#[test]
fn two_maps_side_by_side_cost_one_picture_and_a_wipe_two() {
    let whole = Resolution::square(80, 4).with_pixel_aspect(0.5).expect("a shape of pixels");
    let parts = shown(Map::Shaded, Map::Depth, BESIDE).map_sizes(whole);
    let widths: Vec<_> = parts.iter().map(|(_, part)| part.width()).collect();
    assert_eq!(widths, [39, 40]);
    assert!(parts.iter().all(|(_, part)| part.height() == 4 && part.pixel_aspect() == 0.5));
    let parts = shown(Map::Shaded, Map::Depth, Split::Wipe).map_sizes(whole);
    assert_eq!(parts, [(Map::Shaded, whole), (Map::Depth, whole)]);
}

/// Only the shaded picture gets several rays per pixel; other maps get one.
#[test]
fn only_the_shaded_map_is_refined() {
    let one = Sampling::UpTo(NonZeroU32::MIN);
    assert_eq!(ViewLayout::default().sampling(Sampling::BEST), Sampling::BEST);
    assert_eq!(ViewLayout::single(Map::Depth).sampling(Sampling::BEST), one);
    assert_eq!(ViewLayout::single(Map::Depth).sampling(Sampling::Coarse), Sampling::Coarse);
    assert_eq!(shown(Map::Depth, Map::Shaded, Split::Wipe).sampling(Sampling::BEST), Sampling::BEST);
    assert_eq!(shown(Map::Depth, Map::Object, BESIDE).sampling(Sampling::BEST), one);
}

fn flat(width: u32, band: u8) -> Picture {
    Picture::from_pixels(width, 2, vec![Srgb8::new(band, band, band); 2 * width as usize])
        .expect("all pixels are there")
}

/// Returns the picture's rows as text: a digit for each pixel, its red channel, and a bar for the
/// line.
fn rows(picture: &Picture) -> Vec<String> {
    let text = |pixel: &Srgb8| if *pixel == LINE { '|' } else { char::from(b'0' + pixel.r) };
    picture.pixels().chunks(picture.width() as usize).map(|row| row.iter().map(text).collect()).collect()
}

#[test]
fn a_line_separates_two_pictures() {
    let beside = shown(Map::Shaded, Map::Depth, BESIDE);
    assert_eq!(rows(&beside.combined(&[flat(3, 1), flat(4, 2)], 0.5).expect("two")), ["111|2222"; 2]);
    let above_panel = ViewLayout::single(Map::Shaded).twice(1);
    let combined = above_panel.combined(&[flat(3, 1), flat(4, 2)], 0.5).expect("two");
    assert_eq!(rows(&combined), ["111|2222", "111|2222", "00000000"]);
    let heights = above_panel.map_sizes(Resolution::square(8, 3)).into_iter().map(|(_, part)| part.height());
    assert!(heights.eq([2, 2]));
    let wipe = shown(Map::Shaded, Map::Depth, Split::Wipe);
    for (share, row) in [(0.0, "|222"), (0.5, "11|2"), (0.9, "111|"), (1.0, "111|")] {
        assert_eq!(rows(&wipe.combined(&[flat(4, 1), flat(4, 2)], share).expect("two")), [row; 2]);
    }
}

#[test]
fn no_screen_is_too_narrow() {
    for width in 1..5 {
        let whole = Resolution::square(width, 2);
        for split in [BESIDE, Split::Wipe] {
            let seen = shown(Map::Shaded, Map::Depth, split);
            let parts: Vec<_> = seen.map_sizes(whole).iter().map(|(_, part)| flat(part.width(), 1)).collect();
            let combined = seen.combined(&parts, 0.5).expect("two");
            assert_eq!((combined.width(), combined.pixels().len()), (width, 2 * width as usize));
        }
    }
}
