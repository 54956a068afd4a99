//! A scene as plain text: what a snapshot test compares.

use std::path::Path;
use termtrace::{Scene, Size, text_frame};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load(Path::new("scenes/three_spheres.ron"))?;
    print!("{}", text_frame(&scene, Size::new(80, 24)));
    Ok(())
}
