//! Golden frames of `--glyphs ascii`: scenes that a reader should recognise in the text alone.
//!
//! They are written anew as those of `goldens` are. A change of them should be judged by eye, and by the share of the
//! objects' contours that a reader can see.

use termtrace::{CellMode, Colors, Glyphs, Scene, Size, export, frame_grid};

#[test]
fn scenes_can_be_recognised_without_colour() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/ascii");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let mode = CellMode { glyphs: Glyphs::Ascii, colors: Colors::None };
    for name in ["three_spheres.ron", "teapots.ron", "corridor.ron", "many_spheres.ron", "teapot.obj"] {
        let scene = Scene::load(format!("benches/scenes/{name}").as_ref()).expect("a scene of the benches");
        let grid = frame_grid(&scene, mode, Size::new(80, 24), 2.0);
        settings.bind(|| insta::assert_snapshot!(name, export::framed(&grid)));
    }
}
