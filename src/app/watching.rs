//! The files of the scene that is shown: when they change, it is read again.
//!
//! The system tells of changes in folders, because a file that is replaced by another of its name is a new file. A thread
//! sleeps until it does; at rest nothing wakes it, or us.

use crate::terminal::{self, Waker};
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind, RenameMode};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// A plain file that a scene needs, and what it was like when it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Needed {
    path: PathBuf,
    /// When it was written last, and its length; `None` if it was not there.
    state: Option<(SystemTime, u64)>,
}

impl Needed {
    /// As it is now. `None` for pipes and the like, which change by being read.
    pub(super) fn now(path: &Path) -> Option<Self> {
        let data = fs::metadata(path).ok();
        if data.as_ref().is_some_and(|data| !data.is_file()) {
            return None;
        }
        let state = data.and_then(|data| Some((data.modified().ok()?, data.len())));
        Some(Self { path: path.to_owned(), state })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it has got new contents. One that is gone is on its way to them: its coming back is told.
    pub(super) fn has_changed(&self) -> bool {
        Self::now(&self.path).is_none_or(|now| now.state.is_some() && now.state != self.state)
    }

    /// The places whose change is one of this file: its own, and if it is a link, the one that it leads to.
    fn places(&self) -> impl Iterator<Item = PathBuf> {
        let folder = self.path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        let own = folder.canonicalize().ok().zip(self.path.file_name()).map(|(folder, name)| folder.join(name));
        own.into_iter().chain(self.path.canonicalize().ok())
    }
}

/// Our side of the thread.
pub(super) struct Watching {
    watcher: RecommendedWatcher,
    folders: HashSet<PathBuf>,
    /// What is watched for, shared with the thread.
    files: Arc<Mutex<HashSet<PathBuf>>>,
    changed: Arc<AtomicBool>,
}

impl Watching {
    /// Of nothing yet.
    pub(super) fn start(mut waker: Waker) -> notify::Result<Self> {
        let (files, changed) = (Arc::<Mutex<HashSet<PathBuf>>>::default(), Arc::<AtomicBool>::default());
        let (wanted, flag) = (Arc::clone(&files), Arc::clone(&changed));
        let hear = move |event: notify::Result<Event>| {
            let wanted = wanted.lock().unwrap_or_else(PoisonError::into_inner);
            // Where the system lost count of the changes, there may have been one.
            if event.map_or(true, |event| concerns(&event, &wanted)) {
                flag.store(true, Ordering::SeqCst);
                waker.wake();
            }
        };
        let watcher = terminal::without_signals(|| notify::recommended_watcher(hear))?;
        Ok(Self { watcher, folders: HashSet::new(), files, changed })
    }

    /// From now on these are watched, and no others. Whether one has changed since it was read.
    pub(super) fn watch(&mut self, needed: &[Needed]) -> bool {
        let places: HashSet<_> = needed.iter().flat_map(Needed::places).collect();
        let folders: HashSet<_> = places.iter().filter_map(|place| place.parent().map(Path::to_owned)).collect();
        for folder in self.folders.difference(&folders) {
            let _ = self.watcher.unwatch(folder);
        }
        // A folder that cannot be watched is not: nobody hears of its changes.
        let (known, watcher) = (&self.folders, &mut self.watcher);
        let is_watched =
            |folder: &PathBuf| known.contains(folder) || watcher.watch(folder, RecursiveMode::NonRecursive).is_ok();
        self.folders = folders.into_iter().filter(is_watched).collect();
        *self.files.lock().unwrap_or_else(PoisonError::into_inner) = places;
        needed.iter().any(Needed::has_changed)
    }

    /// Whether a file has changed since the last call.
    pub(super) fn take_changed(&self) -> bool {
        self.changed.swap(false, Ordering::SeqCst)
    }
}

/// Whether one of these files has got new contents: all of them, so that none is read half written. (Where the system does
/// not tell when writing ends, each part of it counts.)
fn concerns(event: &Event, files: &HashSet<PathBuf>) -> bool {
    let is_new = match event.kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => true,
        EventKind::Modify(ModifyKind::Name(mode)) => mode != RenameMode::From,
        EventKind::Create(_) | EventKind::Modify(_) => cfg!(not(target_os = "linux")),
        _ => false,
    };
    event.need_rescan() || is_new && event.paths.iter().any(|path| files.contains(path))
}
