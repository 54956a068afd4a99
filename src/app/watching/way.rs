//! The way that the system goes to find a file: folder by folder, and link by link.

use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Links in each other are followed this far, as Linux does.
const MOST_LINKS: usize = 40;

/// The places that a path leads through. No place has a link in its own path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Way {
    /// The folders and links that the path names, each of which may be exchanged for another.
    steps: Vec<Step>,
    /// The file, or the first thing on the way that is not there.
    end: PathBuf,
    /// Whether the file is there.
    is_whole: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Step {
    place: PathBuf,
    is_link: bool,
}

impl Way {
    /// The way to that file as it is now; `None` where the current folder is gone.
    pub(super) fn to(path: &Path) -> Option<Self> {
        // The current folder's own path is no part of the way: it stays what it is wherever it is moved.
        let mut folder = if path.is_absolute() { PathBuf::new() } else { Path::new(".").canonicalize().ok()? };
        let mut steps = Vec::new();
        let mut left = names(path);
        let mut links = 0;
        while let Some(name) = left.pop() {
            let Name::In(name) = name else {
                name.go(&mut folder);
                continue;
            };
            let place = folder.join(name);
            let is_link = fs::symlink_metadata(&place).map(|data| data.is_symlink());
            match is_link {
                Ok(true) if links < MOST_LINKS => {
                    links += 1;
                    left.extend(fs::read_link(&place).map(|target| names(&target)).unwrap_or_default());
                    steps.push(Step { place, is_link: true });
                }
                Ok(false) if left.is_empty() => return Some(Self { steps, end: place, is_whole: true }),
                Ok(false) => {
                    folder.clone_from(&place);
                    steps.push(Step { place, is_link: false });
                }
                _ => return Some(Self { steps, end: place, is_whole: false }),
            }
        }
        Some(Self { steps, end: folder, is_whole: true })
    }

    pub(super) fn end(&self) -> &Path {
        &self.end
    }

    pub(super) fn steps(&self) -> impl Iterator<Item = &Path> {
        self.steps.iter().map(|step| &*step.place)
    }

    /// The folders in which the file and the links stand: without them, nothing is seen.
    pub(super) fn looked_in(&self) -> impl Iterator<Item = &Path> {
        let links = self.steps.iter().filter(|step| step.is_link).map(|step| &*step.place);
        links.chain([&*self.end]).filter_map(Path::parent).filter(|folder| !is_made_up(folder))
    }

    /// The other folders of the way. One that is exchanged says so itself; but it may not say that it is removed, as long
    /// as a process stands in it, so that while the file is missing the folders around are asked too. Those at the root are
    /// asked only then: they stay, and many programs are busy in them.
    pub(super) fn around(&self) -> impl Iterator<Item = &Path> {
        let folders = self.steps.iter().filter(|step| !step.is_link).map(|step| &*step.place);
        let own = folders.clone().filter(|folder| folder.components().count() > 2);
        let outer = folders.filter_map(Path::parent).filter(|_| !self.is_whole);
        own.chain(outer).filter(|folder| !is_made_up(folder))
    }
}

/// Whether the system makes that folder up: nothing is saved there, and all programs open files in it all the time.
fn is_made_up(folder: &Path) -> bool {
    ["/proc", "/sys", "/dev"].iter().any(|root| folder.starts_with(root)) && !folder.starts_with("/dev/shm")
}

/// A part of a path.
enum Name {
    Root,
    Parent,
    In(OsString),
}

impl Name {
    fn go(&self, folder: &mut PathBuf) {
        match self {
            Self::Root => *folder = PathBuf::from("/"),
            Self::Parent => drop(folder.pop()),
            Self::In(_) => {}
        }
    }
}

/// The parts of a path, the last one first.
fn names(path: &Path) -> Vec<Name> {
    let name = |part: Component<'_>| match part {
        Component::RootDir => Some(Name::Root),
        Component::ParentDir => Some(Name::Parent),
        Component::Normal(name) => Some(Name::In(name.to_owned())),
        Component::CurDir | Component::Prefix(_) => None,
    };
    path.components().rev().filter_map(name).collect()
}
