//! The scenes that are embedded in the program.
//!
//! They can be opened by name from any folder, and `termtrace scenes` lists them.

use super::outcome::{CommandResult, write_stdout};
use clap::Args;
use std::fmt::Write;
use std::path::Path;

/// A scene of the folder `scenes/` that is embedded in the program.
#[derive(Debug)]
pub(super) struct ShippedScene {
    /// The scene's file name without the extension.
    pub(super) name: &'static str,
    /// The text of the scene file.
    pub(super) text: &'static str,
    /// Names and bytes of the meshes and pictures that the scene refers to.
    pub(super) files: &'static [(&'static str, &'static [u8])],
}

/// Defines the table `SHIPPED`. Each row is a scene's name and the files that it refers to.
macro_rules! shipped {
    ($($name:literal $([$($file:literal),+])?),+ $(,)?) => {
        /// All shipped scenes, in the order of the tour; the first is the default scene.
        static SHIPPED: &[ShippedScene] = &[$(ShippedScene {
            name: $name,
            text: include_str!(concat!("../../scenes/", $name, ".ron")),
            files: &[$($(($file, include_bytes!(concat!("../../scenes/", $file))),)+)?],
        }),+];
    };
}

// In the order of the lecture, which is that of the tour: image order and object order, perspective, eye rays, ray
// intersection, shading; then meshes.
shipped! {
    "three_spheres",
    "many_spheres",
    "corridor",
    "near_fov",
    "far_fov",
    "tilted_up",
    "off_centre",
    "tilted_rectangle",
    "inside_sphere",
    "train",
    "temple",
    "chess",
    "dice",
    "breakfast" ["planks.png"],
    "heart",
    "tanglecube",
    "barth",
    "gyroid",
    "lava",
    "lighthouse",
    "bare",
    "two_lights",
    "three_lights",
    "glass",
    "lantern",
    "saturn",
    "studio",
    "misty_columns",
    "winter",
    "globe" ["world.png", "planks.png", "leaves.png"],
    "teapots" ["teapot.obj"],
    "crowd" ["teapot.obj"],
}

impl ShippedScene {
    /// Returns the scene that is shown when none is named.
    pub(super) fn default_scene() -> &'static Self {
        &SHIPPED[0]
    }

    /// Returns the shipped scene whose name is `name`, a command line argument that could also be a
    /// path.
    pub(super) fn named(name: &Path) -> Option<&'static Self> {
        SHIPPED.iter().find(|scene| Path::new(scene.name) == name)
    }

    /// Returns all shipped scenes, in the order of the tour.
    pub(super) fn all() -> impl Iterator<Item = &'static Self> {
        SHIPPED.iter()
    }

    /// Returns the names of all shipped scenes.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        Self::all().map(|scene| scene.name)
    }

    /// Returns the names of all shipped scenes with what they show.
    pub(super) fn titles() -> impl Iterator<Item = (&'static str, &'static str)> {
        SHIPPED.iter().map(|scene| (scene.name, scene.title()))
    }

    /// Returns the scene's title: the first line of the comment at the start of the file.
    fn title(&self) -> &'static str {
        self.text.lines().next().and_then(|line| line.strip_prefix("// ")).unwrap_or_default()
    }
}

const EXAMPLES: &str = "\
Examples:
  termtrace corridor        look into a built-in scene, from any folder
  termtrace frame teapots   every command takes these names; a file of the
                            same name wins";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct ScenesArgs {}

/// `termtrace scenes`: prints the name of each shipped scene and what it shows.
pub(super) fn list() -> CommandResult {
    let width = ShippedScene::names().map(str::len).max().unwrap_or(0);
    let lines = ShippedScene::titles().fold(String::new(), |mut lines, (name, title)| {
        let _ = writeln!(lines, "{name:width$}  {title}");
        lines
    });
    write_stdout(lines.as_bytes())
}

#[cfg(all(test, unit_tests))]
mod tests;
