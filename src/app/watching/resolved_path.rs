//! Resolution of a path as the system does it: folder by folder and link by link.
//!
//! `canonicalize` gives only the end, and fails if anything is missing; a change of any step must be noticed.

use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Limit on the links followed, the same as that of Linux: links may form a cycle.
const MAX_LINKS: usize = 40;

/// The folders and links that a path leads through. None of their own paths contains a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ResolvedPath {
    /// The folders and links on the path, each of which may be replaced.
    steps: Vec<Step>,
    /// The file, or the first missing component.
    end: PathBuf,
    /// Whether the file exists.
    is_complete: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Step {
    path: PathBuf,
    is_link: bool,
}

impl ResolvedPath {
    /// Resolves `path`. `None` if it is relative and the current folder has been removed.
    pub(super) fn to(path: &Path) -> Option<Self> {
        // The path of the current folder is not part of the resolution: the process stays in it even if it is moved.
        let mut folder = if path.is_absolute() { PathBuf::new() } else { Path::new(".").canonicalize().ok()? };
        let mut steps = Vec::new();
        let mut left = names(path);
        let mut links = 0;
        while let Some(name) = left.pop() {
            let Name::In(name) = name else {
                name.go(&mut folder);
                continue;
            };
            let path = folder.join(name);
            let is_link = fs::symlink_metadata(&path).map(|data| data.is_symlink());
            match is_link {
                Ok(true) if links < MAX_LINKS => {
                    links += 1;
                    left.extend(fs::read_link(&path).map(|target| names(&target)).unwrap_or_default());
                    steps.push(Step { path, is_link: true });
                }
                Ok(false) if left.is_empty() => return Some(Self { steps, end: path, is_complete: true }),
                Ok(false) => {
                    folder.clone_from(&path);
                    steps.push(Step { path, is_link: false });
                }
                // Missing, unreadable, or in a cycle of links.
                _ => return Some(Self { steps, end: path, is_complete: false }),
            }
        }
        Some(Self { steps, end: folder, is_complete: true })
    }

    pub(super) fn end(&self) -> &Path {
        &self.end
    }

    pub(super) fn steps(&self) -> impl Iterator<Item = &Path> {
        self.steps.iter().map(|step| &*step.path)
    }

    /// Returns the folders that contain the file and the links. Watching them is indispensable.
    pub(super) fn searched_folders(&self) -> impl Iterator<Item = &Path> {
        let links = self.steps.iter().filter(|step| step.is_link).map(|step| &*step.path);
        links.chain([&*self.end]).filter_map(Path::parent).filter(|folder| !is_virtual(folder))
    }

    /// Returns further folders to watch.
    ///
    /// They are on the path, and each reports when it is replaced.
    ///
    /// A removed folder is not reported while a process has it as its current folder. So while the file is missing,
    /// their parents are watched too. Folders directly below the root are watched only then: they are permanent, and
    /// busy.
    pub(super) fn outer_folders(&self) -> impl Iterator<Item = &Path> {
        let folders = self.steps.iter().filter(|step| !step.is_link).map(|step| &*step.path);
        // Deeper than two components: `/home` and the like belong to the system.
        let own = folders.clone().filter(|folder| folder.components().count() > 2);
        let outer = folders.filter_map(Path::parent).filter(|_| !self.is_complete);
        own.chain(outer).filter(|folder| !is_virtual(folder))
    }
}

/// Returns whether a folder belongs to a virtual file system, where nothing is saved and events are
/// frequent.
fn is_virtual(folder: &Path) -> bool {
    ["/proc", "/sys", "/dev"].iter().any(|root| folder.starts_with(root)) && !folder.starts_with("/dev/shm")
}

/// A component of a path.
enum Name {
    Root,
    Parent,
    In(OsString),
}

impl Name {
    fn go(&self, folder: &mut PathBuf) {
        match self {
            Self::Root => *folder = PathBuf::from("/"),
            // After links are resolved, as the system does it: `a/..` is not the current folder if `a` is a link.
            Self::Parent => drop(folder.pop()),
            Self::In(_) => {}
        }
    }
}

/// Returns the components of a path, last first.
fn names(path: &Path) -> Vec<Name> {
    let name = |part: Component<'_>| match part {
        Component::RootDir => Some(Name::Root),
        Component::ParentDir => Some(Name::Parent),
        Component::Normal(name) => Some(Name::In(name.to_owned())),
        Component::CurDir | Component::Prefix(_) => None,
    };
    // Last first, so that the target of a link is pushed in front of the rest.
    path.components().rev().filter_map(name).collect()
}
