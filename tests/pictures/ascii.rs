//! Golden frames of `--glyphs ascii`: scenes that a reader should recognise in the text alone.
//!
//! They are written anew as those of `goldens` are. A change of them should be judged by eye, and by the share of the
//! objects' contours that a reader can see.

use std::num::NonZeroU32;
use termtrace::internals::cell::resolution;
use termtrace::internals::maps::{self, TracedMap};
use termtrace::internals::render::Executor;
use termtrace::{CellMode, Colors, Glyphs, Grid, Map, Painter, Sampling, Scene, Size, export, frame_grid};

const MODE: CellMode = CellMode { glyphs: Glyphs::Ascii, colors: Colors::None };
const SCENES: [&str; 5] = ["three_spheres.ron", "teapots.ron", "corridor.ron", "many_spheres.ron", "teapot.obj"];

#[test]
fn scenes_can_be_recognised_without_colour() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/ascii");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for name in SCENES {
        let scene = Scene::load(format!("benches/scenes/{name}").as_ref()).expect("a scene of the benches");
        let grid = frame_grid(&scene, MODE, Size::new(80, 24), 2.0);
        settings.bind(|| insta::assert_snapshot!(name, export::framed(&grid)));
    }
}

/// Returns a picture with geometry of the scene of the benches with this name, and its cost.
fn traced(name: &str, map: Map, executor: Executor<'_>, size: Size, right: f32) -> TracedMap {
    traced_by(Sampling::Each(NonZeroU32::MIN), name, map, executor, size, right)
}

fn traced_by(sampling: Sampling, name: &str, map: Map, executor: Executor<'_>, size: Size, right: f32) -> TracedMap {
    let scene = Scene::load(format!("benches/scenes/{name}").as_ref()).expect("a scene of the benches");
    let resolution = resolution(MODE, size, 2.0).expect("a small screen");
    let camera = scene.camera().moved(right, 0.0, 0.0);
    maps::trace_with_geometry(map, executor, &scene, &camera, resolution, sampling).expect("it is not cancelled")
}

/// Returns the characters of a view at rest.
fn glyphs(seen: &TracedMap) -> String {
    let mut grid = Grid::new(Size::new(0, 0));
    Painter::new(MODE).paint(&seen.picture, seen.geometry.as_deref(), &mut grid);
    grid.cells().map(|cell| cell.glyph.to_string()).collect()
}

/// Checks that frames of a slow machine in motion, with one ray for four pixels, have outlines too.
#[test]
fn coarse_frames_have_outlines() {
    let size = Size::new(80, 24);
    for name in SCENES {
        let [fine, coarse] = [Sampling::Each(NonZeroU32::MIN), Sampling::Coarse].map(|sampling| {
            let seen = traced_by(sampling, name, Map::Shaded, Executor::Pool, size, 0.0);
            (glyphs(&seen), seen.cost.rays as f64 / size.cell_count() as f64)
        });
        // Level lines are left out: a horizon may be `_` in one frame and `-`, which fills planes too, in the other.
        let is_line = |glyph: char| "/\\|'`,()\"^".contains(glyph);
        let lines = fine.0.chars().filter(|&glyph| is_line(glyph)).count();
        let both = fine.0.chars().zip(coarse.0.chars());
        let of_coarse = coarse.0.chars().filter(|&glyph| is_line(glyph)).count();
        let same = both.filter(|&(fine, coarse)| is_line(fine) && (is_line(coarse) || coarse == '_')).count();
        println!(
            "{name} {}: {same} of {lines}, {of_coarse} in all, {:.1} and {:.1} rays per cell",
            size.columns, fine.1, coarse.1
        );
        // Of spheres of three by two cells some are drawn by their fill, others by their outline.
        let least = if name == "many_spheres.ron" { 0.5 } else { 0.9 };
        assert!(lines > 50 && same as f64 >= least * lines as f64, "{name}: {same} of {lines}");
        assert!(of_coarse <= 2 * lines, "{name}: {of_coarse} instead of {lines}");
        assert!(2.0 * coarse.1 < fine.1, "{name}: {} and {} rays per cell", coarse.1, fine.1);
    }
}

#[test]
fn geometry_does_not_depend_on_threads() {
    for name in SCENES {
        let on = |executor| traced(name, Map::Shaded, executor, Size::new(80, 24), 0.0);
        let alone = on(Executor::CurrentThread);
        for threads in [2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let on_pool = pool.install(|| on(Executor::Pool));
            assert!(
                on_pool.picture == alone.picture && on_pool.geometry == alone.geometry,
                "{name}, {threads} threads"
            );
        }
    }
}

/// Checks the rays of a cell, which are eight and those where surfaces meet.
#[test]
fn most_cells_have_few_rays() {
    for size in [Size::new(80, 24), Size::new(120, 40), Size::new(200, 60)] {
        for name in SCENES {
            // The map of normals traces eight more rays, and no shadow rays.
            let rays = traced(name, Map::Normal, Executor::Pool, size, 0.0).cost.rays as f64;
            let per_cell = rays / size.cell_count() as f64 - 8.0;
            println!("{name} {}x{}: {per_cell:.1} rays per cell", size.columns, size.rows);
            let most = if name == "many_spheres.ron" { 24.0 } else { 12.0 };
            assert!((8.0..most).contains(&per_cell), "{name}: {per_cell}");
        }
    }
}

/// Returns the shares of cells that change per frame, and that flicker, while the eye moves.
///
/// A cell flickers if it changes and changes back within three frames.
fn motion(name: &str, step: f32, glyphs: Glyphs) -> [f64; 2] {
    let mut painter = Painter::new(CellMode { glyphs, ..MODE });
    let frames: Vec<Grid> = (0..60)
        .map(|frame| {
            let seen = traced(name, Map::Shaded, Executor::Pool, Size::new(80, 24), step * frame as f32);
            let mut grid = Grid::new(Size::new(0, 0));
            painter.paint_view(&seen.picture, seen.geometry.as_deref(), frame > 0, &mut grid);
            grid
        })
        .collect();
    let share = |is_counted: &dyn Fn(usize, usize) -> bool| {
        let cells = |at: usize| (0..80 * 24).filter(|&cell| is_counted(at, cell)).count();
        (1..58).map(cells).sum::<usize>() as f64 / f64::from(57 * 80 * 24)
    };
    let glyph = |frame: usize, cell: usize| frames[frame].at(cell).glyph;
    let changes = |at, cell| glyph(at, cell) != glyph(at - 1, cell);
    let returns = |at, cell| [at + 1, at + 2].into_iter().any(|then| glyph(then, cell) == glyph(at - 1, cell));
    [share(&changes), share(&|at, cell| changes(at, cell) && returns(at, cell))]
}

/// Checks that a moving view changes no more cells than shapes do, and flickers far less often.
#[test]
fn a_moving_view_is_calmer_than_shapes() {
    for (name, step) in [("three_spheres.ron", 0.01), ("three_spheres.ron", 0.04), ("teapots.ron", 0.03)] {
        let shares = [Glyphs::Ascii, Glyphs::Shape].map(|glyphs| motion(name, step, glyphs));
        println!("{name}, {step} a frame: changed and flickering {shares:.5?}");
        let [ascii, shape] = shares;
        assert!(ascii[0] <= shape[0] && ascii[1] <= 0.3 * shape[1], "{name}, {step}: {shares:?}");
    }
}

/// Checks that cells with equal samples keep their glyphs in motion, and none do at rest.
#[test]
fn a_view_at_rest_depends_on_the_picture_alone() {
    let mut painter = Painter::new(MODE);
    let mut grid = Grid::new(Size::new(0, 0));
    let [before, now] =
        [0.0, 0.04].map(|right| traced(SCENES[0], Map::Shaded, Executor::Pool, Size::new(80, 24), right));
    let mut paint = |seen: &TracedMap, is_moving| {
        painter.paint_view(&seen.picture, seen.geometry.as_deref(), is_moving, &mut grid);
        grid.clone()
    };
    let mut pure = Grid::new(Size::new(0, 0));
    Painter::new(MODE).paint(&now.picture, now.geometry.as_deref(), &mut pure);
    let first = paint(&before, false);
    let moving = paint(&now, true);
    assert!(moving != pure && moving != first);
    assert!(paint(&now, true) == moving, "each cell has the same samples");
    assert!(paint(&now, false) == pure);
}
