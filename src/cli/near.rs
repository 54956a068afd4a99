//! What was meant by a name that is none.

use std::path::{Path, PathBuf};
use strsim::damerau_levenshtein;
use termtrace::mesh_file::is_mesh;

/// So many files of a folder are looked at.
const MOST_FILES: usize = 10_000;

/// The scene or mesh in the same folder whose name is most like that one, with or without its ending, if any is.
pub(super) fn scene(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let names = files.take(MOST_FILES).filter_map(|file| file.ok()?.file_name().into_string().ok());
    let scenes = names.filter(|name| is_mesh(name, &[]) || Path::new(name).extension().is_some_and(|end| end == "ron"));
    let near = scenes.filter_map(|other| Some((distance(name, &other)?, other)));
    // What a folder lists may not be there: a link that leads nowhere, the name itself among them.
    let there = near.filter(|(_, other)| path.with_file_name(other).exists());
    there.min().map(|(_, other)| path.with_file_name(other))
}

/// The word that was meant, if one is nearly the same.
pub(super) fn word<'a>(word: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    words
        .map(|other| (damerau_levenshtein(word, other), other))
        .filter(|&(distance, _)| distance <= 2)
        .min()
        .map(|near| near.1)
}

/// How many slips of the finger make one name of the other, if they are few: one in four characters. Another ending, or
/// none, is one more.
fn distance(name: &str, other: &str) -> Option<usize> {
    let stem = |name| Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_lowercase();
    let whole = damerau_levenshtein(&name.to_lowercase(), &other.to_lowercase());
    let stems = damerau_levenshtein(&stem(name), &stem(other));
    (whole.min(stems) <= stem(other).chars().count() / 4).then_some(whole.min(1 + stems))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_finger_are_few() {
        for (name, other, expected) in [
            ("three_shperes.ron", "three_spheres.ron", Some(1)),
            ("three_spheres", "three_spheres.ron", Some(1)),
            ("Three_Spheres.RON", "three_spheres.ron", Some(0)),
            ("teapot.ply", "teapot.obj", Some(1)),
            ("missing.ron", "ball.ron", None),
            ("a.ron", "b.ron", None),
        ] {
            assert_eq!(distance(name, other), expected, "{name} for {other}");
        }
    }
}
