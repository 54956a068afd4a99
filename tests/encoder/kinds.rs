//! Moving pictures of every kind of cells, at every quality and under limits.
//!
//! Only half blocks and flat cells in truecolor may differ from what is wanted, or wait: all cells of `half` and
//! `spaces`, and some of other kinds. All other cells are text.

use super::near::halves;
use super::screens::Clusters;
use super::watched::Watched;
use super::{WAYS, config};
use glam::Vec3;
use proptest::prelude::*;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;
use termtrace::internals::cell::Colors;
use termtrace::internals::encode::Allowance;
use termtrace::{CellMode, Glyphs, Grid, Map, Painter, Pose, Quality, Scene, Size};

const SIZE: Size = Size::new(36, 9);

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");
    Scene::load(Path::new(path)).expect("the scene is fine")
});

/// Returns frames of a view that moves by this vector from each to the next.
fn frames(mode: CellMode, by: Vec3) -> Vec<Grid> {
    let resolution = mode.resolution(SIZE, 2.0).expect("it is small");
    let mut painter = Painter::new(mode);
    let Pose { eye, target, up } = SCENE.camera().pose();
    let frame = |step: u8| {
        let pose = Pose { eye: eye + f32::from(step) * by, target: target + f32::from(step) * by, up };
        let camera = SCENE.camera().with_pose(pose).expect("a pose");
        painter.trace(Map::Shaded, &SCENE, &camera, resolution, mode.default_sampling())
    };
    (0..4).map(frame).collect()
}

/// Returns whether the colours of all cells may be sent less exactly.
fn is_lossy(CellMode { glyphs, colors }: CellMode) -> bool {
    matches!(glyphs, Glyphs::Half | Glyphs::Spaces) && colors == Colors::Truecolor
}

/// Returns whether no cell of these frames may be sent less exactly.
fn is_text(frames: &[Grid]) -> bool {
    frames.iter().flat_map(Grid::cells).all(|cell| halves(cell).is_none())
}

fn modes() -> impl Iterator<Item = CellMode> {
    let colors = [Colors::Truecolor, Colors::Indexed256, Colors::SIXTEEN, Colors::None];
    let of_kind = move |&glyphs: &Glyphs| colors.map(|colors| CellMode { glyphs, colors });
    Glyphs::ALL.iter().flat_map(of_kind)
}

/// Sends the frames, and judges each; all is exact in the end.
#[track_caller]
fn assert_played(mode: CellMode, frames: &[Grid], quality: Quality, max_bytes: Option<usize>) {
    let is_text = is_text(frames);
    assert!(is_text || mode.colors == Colors::Truecolor, "{mode:?} has more than text");
    for (order, half_blocks) in WAYS {
        let mut watched = Watched::new(order, half_blocks, SIZE, Clusters::None);
        let mut last = Allowance { quality, now: Duration::ZERO, max_bytes: None };
        for grid in frames {
            // The watched encoder asserts that text is exact, that the picture is near, and that the limit is kept.
            let sent = watched.send_within(grid, last);
            if is_lossy(mode) {
                assert!(grid.cells().all(|cell| halves(cell).is_some()), "{mode:?} has text");
                assert!(
                    quality == Quality::Exact || last.max_bytes.is_none_or(|most| sent <= most),
                    "{sent} bytes, {max_bytes:?}: {mode:?}"
                );
            } else if is_text {
                watched.assert_rests(&format!("{mode:?}"));
            }
            last = Allowance { now: last.now + Duration::from_millis(33), max_bytes, ..last };
        }
        watched.rest(&frames[frames.len() - 1], last);
    }
}

proptest! {
    #![proptest_config(config(12))]

    #[test]
    fn every_kind_of_cells_is_shown_at_any_quality_and_limit(
        (x, y) in (-0.3_f32..0.3, -0.1_f32..0.1),
        max_bytes in prop_oneof![Just(None), (250_usize..2_500).prop_map(Some)],
        quality in prop::sample::select(&[Quality::Exact, Quality::Equal, Quality::Fast][..]),
    ) {
        for mode in modes() {
            assert_played(mode, &frames(mode, Vec3::new(x, y, 0.0)), quality, max_bytes);
        }
    }
}

#[test]
fn equal_saves_bytes_of_the_kinds_that_are_not_text() {
    for mode in modes() {
        let frames = frames(mode, Vec3::new(0.1, 0.0, 0.0));
        let [exact, equal] = [Quality::Exact, Quality::Equal].map(|quality| {
            let (order, half_blocks) = WAYS[3];
            let mut watched = Watched::new(order, half_blocks, SIZE, Clusters::None);
            let allowance = |k: u64| Allowance { quality, now: Duration::from_millis(33 * k), max_bytes: None };
            (0..).zip(&frames).map(|(k, grid)| watched.send_within(grid, allowance(k))).sum::<usize>()
        });
        assert!(if is_text(&frames) { equal == exact } else { equal < exact }, "{mode:?}: {equal} bytes of {exact}");
    }
}
