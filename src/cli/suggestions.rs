//! Suggestions for misspelt file names.

use super::folder::is_scene;
use std::path::{Path, PathBuf};
use termtrace::internals::text::closest;

/// Limit on the number of files in a folder that are compared, so that a huge folder does not delay
/// the error message.
const MAX_LISTED_FILES: usize = 10_000;

/// Returns the scene or mesh in `path`'s folder whose name is most similar, compared without
/// extensions. Among equally similar names, one with `path`'s extension wins.
pub(super) fn scene_like(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let names = files.take(MAX_LISTED_FILES).filter_map(|file| file.ok()?.file_name().into_string().ok());
    let scenes = names.filter(|name| is_scene(name));
    // Excludes dangling symbolic links, which a folder lists too; `path` itself may be one.
    let there: Vec<_> = scenes.filter(|other| path.with_file_name(other).exists()).collect();
    nearest(name, there).map(|other| path.with_file_name(other))
}

fn nearest(name: &str, mut others: Vec<String>) -> Option<String> {
    let extension = |name: &str| Path::new(name).extension().map(std::ffi::OsStr::to_ascii_lowercase);
    // The order of a folder's files is unspecified, and the suggestion must not depend on it.
    others.sort_by_cached_key(|other| (extension(other) != extension(name), other.clone()));
    let meant = closest(stem(name), others.iter().map(|other| stem(other)))?;
    others.iter().find(|other| stem(other) == meant).cloned()
}

fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default()
}

#[cfg(all(test, unit_tests))]
mod tests;
