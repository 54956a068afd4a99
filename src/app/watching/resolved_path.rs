//! Resolution of a path as the system does it: folder by folder and link by link.
//!
//! `canonicalize` does not suffice: it returns only the final path, and fails if a step is missing, but a change of any
//! step must be noticed.

use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Greatest number of links that are followed, because links may form a cycle. Linux has the same
/// limit.
const MAX_LINKS: usize = 40;

/// The folders and links that a path leads through, and the file at its end.
///
/// Each folder and link has a path of its own, which contains no other link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ResolvedPath {
    /// The folders and links on the path, each of which may be replaced.
    steps: Vec<ResolvedLink>,
    /// The file; if the path cannot be resolved to its end, the component at which that failed.
    end: PathBuf,
    /// Whether the path was resolved to its end: no component is missing or unreadable, and links
    /// form no cycle.
    is_complete: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct ResolvedLink {
    path: PathBuf,
    is_link: bool,
}

impl ResolvedPath {
    /// Resolves `path`. `None` if it is relative and the current folder has been removed.
    pub(super) fn resolve(path: &Path) -> Option<Self> {
        // The steps to the current folder do not matter, because the process stays in that folder even if it is moved.
        let mut folder = if path.is_absolute() { PathBuf::new() } else { Path::new(".").canonicalize().ok()? };
        let mut steps = Vec::new();
        let mut left = components_reversed(path);
        let mut links = 0;
        while let Some(name) = left.pop() {
            let Name::In(name) = name else {
                name.apply_root_or_parent(&mut folder);
                continue;
            };
            let path = folder.join(name);
            let is_link = fs::symlink_metadata(&path).map(|data| data.is_symlink());
            match is_link {
                Ok(true) if links < MAX_LINKS => {
                    links += 1;
                    left.extend(fs::read_link(&path).map(|target| components_reversed(&target)).unwrap_or_default());
                    steps.push(ResolvedLink { path, is_link: true });
                }
                Ok(false) if left.is_empty() => return Some(Self { steps, end: path, is_complete: true }),
                Ok(false) => {
                    folder.clone_from(&path);
                    steps.push(ResolvedLink { path, is_link: false });
                }
                // The component is missing or unreadable, or the links form a cycle.
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

    /// Returns the folders that contain the file and the links, which must be watched to notice
    /// changes.
    pub(super) fn containing_folders(&self) -> impl Iterator<Item = &Path> {
        let links = self.steps.iter().filter(|step| step.is_link).map(|step| &*step.path);
        links.chain([&*self.end]).filter_map(Path::parent).filter(|folder| !is_virtual(folder))
    }

    /// Returns the other folders on the path, which are watched to notice that one of them is
    /// replaced.
    ///
    /// While the file is missing, the parents of the folders are watched too, because the removal of a folder is not
    /// reported while it is the current folder of a process. Folders directly below the root, which are permanent and
    /// busy, are watched only while the file is missing.
    pub(super) fn intermediate_folders(&self) -> impl Iterator<Item = &Path> {
        let folders = self.steps.iter().filter(|step| !step.is_link).map(|step| &*step.path);
        // A path with two components, such as `/home`, belongs to the system.
        let own = folders.clone().filter(|folder| folder.components().count() > 2);
        let outer = folders.filter_map(Path::parent).filter(|_| !self.is_complete);
        own.chain(outer).filter(|folder| !is_virtual(folder))
    }
}

/// Returns whether a folder is in a virtual file system, where no scenes are saved and events are
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
    fn apply_root_or_parent(&self, folder: &mut PathBuf) {
        match self {
            Self::Root => *folder = PathBuf::from("/"),
            // Links before `..` are already resolved, as the system does it: if `a` is a link, `a/..` is the parent of
            // the link's target.
            Self::Parent => drop(folder.pop()),
            Self::In(_) => {}
        }
    }
}

/// Returns the components of a path as a stack to pop from: the path's first component is on top.
fn components_reversed(path: &Path) -> Vec<Name> {
    let name = |part: Component<'_>| match part {
        Component::RootDir => Some(Name::Root),
        Component::ParentDir => Some(Name::Parent),
        Component::Normal(name) => Some(Name::In(name.to_owned())),
        Component::CurDir | Component::Prefix(_) => None,
    };
    // When a link is resolved, the components of its target are pushed onto the stack.
    path.components().rev().filter_map(name).collect()
}
