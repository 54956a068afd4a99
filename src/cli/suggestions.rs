//! The file that was meant by a name that is none.

use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::is_mesh;
use termtrace::internals::text::closest;

/// So many files of a folder are looked at.
const MAX_LISTED_FILES: usize = 10_000;

/// Returns the scene or mesh in the same folder whose name is most like that one, with or without its extension; of two
/// that are as near, the one with the same extension.
pub(super) fn scene_like(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let names = files.take(MAX_LISTED_FILES).filter_map(|file| file.ok()?.file_name().into_string().ok());
    let scenes = names.filter(|name| is_mesh(name, &[]) || Path::new(name).extension().is_some_and(|end| end == "ron"));
    // What a folder lists may not be there: a link that leads nowhere, the name itself among them.
    let there: Vec<_> = scenes.filter(|other| path.with_file_name(other).exists()).collect();
    nearest(name, there).map(|other| path.with_file_name(other))
}

fn nearest(name: &str, mut others: Vec<String>) -> Option<String> {
    let extension = |name: &str| Path::new(name).extension().map(std::ffi::OsStr::to_ascii_lowercase);
    // A folder lists its files in any order.
    others.sort_by_cached_key(|other| (extension(other) != extension(name), other.clone()));
    let meant = closest(stem(name), others.iter().map(|other| stem(other)))?;
    others.iter().find(|other| stem(other) == meant).cloned()
}

fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_finger_are_few() {
        for (name, others, expected) in [
            ("three_shperes.ron", &["three_spheres.ron"][..], Some("three_spheres.ron")),
            ("three_spheres", &["three_spheres.ron"], Some("three_spheres.ron")),
            ("Three_Spheres.RON", &["three_spheres.obj", "three_spheres.ron"], Some("three_spheres.ron")),
            ("teapot.ply", &["ball.ply", "teapot.obj"], Some("teapot.obj")),
            ("spheres.ron", &["corridor.ron", "three_spheres.ron"], Some("three_spheres.ron")),
            ("missing.ron", &["ball.ron"], None),
            ("a.ron", &["b.ron"], None),
        ] {
            let others = others.iter().map(|&other| other.to_owned()).collect();
            assert_eq!(nearest(name, others).as_deref(), expected, "{name}");
        }
    }
}
