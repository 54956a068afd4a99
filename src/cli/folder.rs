//! A folder as an argument: it is replaced by the scenes and meshes in it, sorted by name.

use super::outcome::{Failure, reason};
use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::is_mesh;

/// Returns the paths with each folder replaced by the scenes and meshes in it, sorted by name.
pub(super) fn expanded(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut scenes = Vec::new();
    for path in paths {
        if path.is_dir() { scenes.extend(scenes_in(path)?) } else { scenes.push(path.clone()) }
    }
    Ok(scenes)
}

/// Returns whether a file name has the extension of a scene or a mesh.
pub(super) fn is_scene(name: &str) -> bool {
    is_mesh(name, &[]) || Path::new(name).extension().is_some_and(|ending| ending == "ron")
}

fn scenes_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let cannot_read = |error: std::io::Error| Failure::runtime(folder.display(), reason(&error));
    let files = std::fs::read_dir(folder).map_err(cannot_read)?;
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    let mut scenes: Vec<_> = paths.filter(|path| is_unhidden_scene(path) && path.is_file()).collect();
    if scenes.is_empty() {
        let folder = folder.display();
        return Err(Failure::Usage(format!(
            "{folder}: this is a directory without a scene (.ron) or mesh (.obj, .stl, .ply, .gltf, .glb)"
        )));
    }
    // The system returns the names in any order.
    scenes.sort();
    Ok(scenes)
}

/// Returns whether a path has the extension of a scene or mesh and is not hidden (`.name`).
fn is_unhidden_scene(path: &Path) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(|name| !name.starts_with('.') && is_scene(name))
}
