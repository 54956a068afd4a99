use super::*;
use crate::capabilities::{CellMode, Shifts};
use crate::export;
use crate::render::{Cost, Sampling};
use crate::scene::Scene;
use crate::tone::tone;
use crate::viewer::frame::Shot;
use crate::viewer::view_layout::ViewLayout;
use std::num::NonZeroU32;

/// Cells are sent in order of colour while the link is slow, otherwise in raster order, unless the
/// user chose one.
#[test]
fn the_order_is_the_links_and_shifts_have_no_margins() {
    let text = include_str!("../../../scenes/three_spheres.ron");
    let scene = Scene::from_ron("three_spheres.ron", text).expect("the scene is fine");
    let capabilities = Capabilities {
        cell_mode: CellMode::HALF_BLOCK,
        resting_glyphs: None,
        cell_aspect: 2.0,
        half_blocks: HalfBlocks::Lower,
        light_background: false,
        synchronized_output: false,
        shifts: Shifts::Off,
    };
    let size = Size::new(40, 12);
    let resolution = cell::resolution(capabilities.cell_mode, size, 2.0).expect("a small screen");
    let light = crate::render::render(&scene, scene.camera(), resolution, NonZeroU32::MIN);
    let frame = || Frame {
        scene: scene.clone(),
        shot: Shot {
            scene: 0,
            lights: 0,
            time: Duration::ZERO,
            camera: *scene.camera(),
            outside: None,
            orders: false,
            resolution,
            layout: ViewLayout::default(),
            geometry: false,
        },
        picture: tone(&light, &scene),
        geometry: None,
        parts: Vec::new(),
        legends: Vec::new(),
        orders: None,
        cost: Cost::default(),
        sampling: Sampling::Each(NonZeroU32::MIN),
        refines: false,
        trace: Duration::ZERO,
        interval: Duration::ZERO,
    };
    let grid = export::frame_grid(&scene, capabilities.cell_mode, size, 2.0);
    let slow = Some(Limit { rate: Some(1e5), max_bytes: usize::MAX });
    let exact = Some(Quality::Exact);
    for (asked, link, order) in [
        (None, None, Order::Raster),
        (None, slow, Order::Color),
        (Some(Order::Color), None, Order::Color),
        (Some(Order::Raster), slow, Order::Raster),
    ] {
        let mut screen = Screen::new(&capabilities, asked, exact);
        screen.take_frame(frame(), None);
        let mut wanted = Vec::new();
        Encoder::new().with_order(order).encode(&grid, &mut wanted);
        let mut bytes = Vec::new();
        screen.draw(size, &Keymap::default(), link, Duration::ZERO, &mut bytes);
        assert!(bytes == wanted, "{asked:?} {link:?}");
    }
    // Margins, which limit shifts, are reset once, and again where another program may have written.
    let shifting = Capabilities { shifts: Shifts::Direct, ..capabilities };
    let mut screen = Screen::new(&shifting, None, exact);
    screen.take_frame(frame(), None);
    for (link, resets) in [(None, false), (slow, true), (slow, false)] {
        let mut bytes = Vec::new();
        screen.draw(size, &Keymap::default(), link, Duration::ZERO, &mut bytes);
        assert_eq!(bytes.starts_with(RESET_MARGINS), resets, "{link:?}");
    }
    screen.forget_shown(HalfBlocks::Lower, false);
    let mut bytes = Vec::new();
    screen.draw(size, &Keymap::default(), slow, Duration::ZERO, &mut bytes);
    assert!(bytes.starts_with(RESET_MARGINS));
}
