//! Watching the files of the shown scene, which is read again when one changes.
//!
//! Folders are watched instead of files, because a file that is replaced under its name is a new file. A path may lead
//! through several folders and links: each is watched, and while the file is missing, the folders around them too. A
//! thread sleeps until the system reports an event; at rest neither that thread nor the event loop is woken.

mod dependency;
mod resolved_path;

pub(super) use dependency::Dependency;

use crate::terminal::{self, Waker};
use dependency::{Identity, identity};
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind, RenameMode};
use notify::{Config, Event, RecommendedWatcher, RecursiveMode, Watcher};
use resolved_path::ResolvedPath;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The event loop's handle of the watching thread.
pub(super) struct Watching {
    watcher: RecommendedWatcher,
    /// The files that the scene was read from.
    dependencies: Vec<Dependency>,
    /// The watched folders: each path, and the folder that it led to when its watch began.
    folders: HashMap<PathBuf, Identity>,
    /// The reason why a folder could not be watched, if there is one.
    problem: Option<String>,
    shared: Arc<Mutex<SharedChanges>>,
}

/// The state that the event loop shares with the watching thread, which sets `change`.
#[derive(Default)]
struct SharedChanges {
    /// The folders and symbolic links on the paths to the scene's files.
    ///
    /// If one of them changes, a path may lead to another file.
    steps: HashSet<PathBuf>,
    /// The paths of the scene's files, with all symbolic links resolved.
    ends: HashSet<PathBuf>,
    /// The most significant change since the last [`Watching::take_changed`].
    change: FileChange,
}

/// A change of the scene's files or of the paths to them.
///
/// The variants are ordered from the least to the most significant change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
enum FileChange {
    #[default]
    Nothing,
    /// A file was removed, perhaps for a moment; it may come back through another folder or link.
    Gone,
    /// A folder or link on the path to a file has changed, so the path may lead to another file.
    Moved,
    /// A file has new contents.
    Written,
}

/// Greatest number of attempts to resolve the paths while links on them keep changing.
// Without a limit, a program that keeps replacing a link would keep the event loop busy. The next event starts new
// attempts.
const MAX_RESOLUTIONS: usize = 8;

impl Watching {
    /// Starts the watching thread, without any folder to watch.
    pub(super) fn start(mut waker: Waker) -> Result<Self, String> {
        terminal::report_phase("watching").map_err(|error| error.to_string())?;
        let shared = Arc::<Mutex<SharedChanges>>::default();
        let theirs = Arc::clone(&shared);
        let hear = move |event: notify::Result<Event>| {
            let mut shared = lock(&theirs);
            // After an error, events may be missing, so any file may have changed.
            let change = event.map_or(FileChange::Written, |event| shared.change_of(&event));
            if change > shared.change {
                shared.change = change;
                waker.wake();
            }
        };
        let watcher = terminal::without_signals(|| notify::recommended_watcher(hear)).map_err(|e| reason(&e))?;
        let mut watching = Self { watcher, dependencies: Vec::new(), folders: HashMap::new(), problem: None, shared };
        // If its thread cannot be started, notify does not report that and then panics at every call, even when
        // dropped. Only `configure` returns an error.
        if watching.watcher.configure(Config::default()).is_err() {
            std::mem::forget(watching);
            return Err("no thread can be started".to_owned());
        }
        Ok(watching)
    }

    /// Watches these files instead of the previous ones.
    ///
    /// Returns whether one has changed since it was read.
    pub(super) fn watch(&mut self, dependencies: Vec<Dependency>) -> bool {
        self.dependencies = dependencies;
        self.watch_and_find_change(true)
    }

    /// Returns whether a file has changed since the last call.
    pub(super) fn take_changed(&mut self) -> bool {
        let change = std::mem::take(&mut lock(&self.shared).change);
        let has_changed = match change {
            FileChange::Nothing => false,
            FileChange::Gone => self.watch_and_find_change(false),
            FileChange::Moved => self.watch_and_find_change(true),
            FileChange::Written => true,
        };
        if has_changed {
            // The new states are recorded, because one change may cause several events but is reported once.
            self.dependencies
                .iter_mut()
                .for_each(|dependency| *dependency = Dependency::in_current_state(dependency.path()));
        }
        has_changed
    }

    /// Returns the reason why changes will not be noticed, if there is one.
    pub(super) fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Follows the links to the scene's files, watches their folders, and returns whether a file
    /// has changed.
    ///
    /// With `compares_all` all files are compared, otherwise those in folders that were not watched before. In the
    /// other folders a file may be incomplete: an event follows when its writer closes it.
    fn watch_and_find_change(&mut self, compares_all: bool) -> bool {
        let mut fresh = HashSet::new();
        for _ in 0..MAX_RESOLUTIONS {
            let paths = self.resolve_paths();
            self.share_paths(&paths);
            fresh.extend(self.update_watched_folders(&paths));
            // If a link was replaced before its folder was watched, the paths have changed, and their folders are
            // watched in another round.
            if self.resolve_paths() == paths {
                break;
            }
        }
        let is_fresh = |dependency: &Dependency| {
            ResolvedPath::resolve(dependency.path())
                .is_some_and(|path| path.end().parent().is_some_and(|folder| fresh.contains(folder)))
        };
        self.dependencies.iter().any(|dependency| (compares_all || is_fresh(dependency)) && dependency.has_changed())
    }

    fn resolve_paths(&self) -> Vec<ResolvedPath> {
        self.dependencies.iter().filter_map(|dependency| ResolvedPath::resolve(dependency.path())).collect()
    }

    fn share_paths(&self, paths: &[ResolvedPath]) {
        let mut shared = lock(&self.shared);
        shared.steps = paths.iter().flat_map(ResolvedPath::steps).map(Path::to_owned).collect();
        shared.ends = paths.iter().map(|path| path.end().to_owned()).collect();
    }

    /// Watches the folders of these paths and no others. Returns those that were not watched
    /// before.
    fn update_watched_folders(&mut self, paths: &[ResolvedPath]) -> Vec<PathBuf> {
        let mut containing_folders: HashSet<_> =
            paths.iter().flat_map(ResolvedPath::containing_folders).map(Path::to_owned).collect();
        if cfg!(not(target_os = "linux")) {
            // kqueue reports only changes of names for a folder; for contents the file itself must be watched.
            containing_folders.extend(paths.iter().map(ResolvedPath::end).map(Path::to_owned));
        }
        let intermediate_folders = paths.iter().flat_map(ResolvedPath::intermediate_folders).map(Path::to_owned);
        let folders: HashSet<_> = containing_folders.iter().cloned().chain(intermediate_folders).collect();
        let watcher = &mut self.watcher;
        self.folders.retain(|folder, _| {
            let is_wanted = folders.contains(folder);
            if !is_wanted {
                // An error means that the folder is gone, and its watch with it.
                let _ = watcher.unwatch(folder);
            }
            is_wanted
        });
        self.problem = None;
        let mut fresh = Vec::new();
        for folder in folders {
            match self.watch_folder(&folder) {
                Ok(true) => fresh.push(folder),
                Err(error) if containing_folders.contains(&folder) => self.problem = Some(reason(&error)),
                // An error of an intermediate folder, such as a missing read permission, is not reported, because
                // such a folder hardly ever changes.
                _ => {}
            }
        }
        fresh
    }

    /// Watches a folder and returns whether it was not watched before.
    fn watch_folder(&mut self, folder: &Path) -> notify::Result<bool> {
        let found = identity(&fs::metadata(folder)?);
        let known = self.folders.get(folder).copied();
        if known.is_some_and(|known| known != found) {
            // The existing watch is on another folder, which had this path before.
            let _ = self.watcher.unwatch(folder);
        }
        self.folders.remove(folder);
        // Called even for a watched folder, which costs nothing: notify drops a watch when the folder's name is
        // removed, even if a new folder has that name by then.
        self.watcher.watch(folder, RecursiveMode::NonRecursive)?;
        self.folders.insert(folder.to_owned(), found);
        Ok(known != Some(found))
    }
}

fn lock(shared: &Mutex<SharedChanges>) -> MutexGuard<'_, SharedChanges> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SharedChanges {
    fn change_of(&self, event: &Event) -> FileChange {
        if event.need_rescan() {
            return FileChange::Written;
        }
        // On systems with kqueue an event does not say what has changed in a folder, so every event counts as `Moved`
        // and all files are compared.
        if cfg!(not(target_os = "linux")) {
            return FileChange::Moved;
        }
        let meaning = |path: &PathBuf| match (self.ends.contains(path), self.steps.contains(path)) {
            (true, _) => file_change(event.kind, path),
            (false, true) => folder_or_link_change(event.kind),
            (false, false) => FileChange::Nothing,
        };
        event.paths.iter().map(meaning).max().unwrap_or_default()
    }
}

/// Returns the change that an event at `path`, a file of the scene, indicates.
///
/// New contents count when their writer closes the file, so that no file is read half written.
fn file_change(kind: EventKind, path: &Path) -> FileChange {
    match kind {
        EventKind::Remove(_) | EventKind::Modify(ModifyKind::Name(RenameMode::From)) => FileChange::Gone,
        // Only for plain files: a scene that was read from a named pipe does not change when the pipe is written to.
        EventKind::Access(AccessKind::Close(AccessMode::Write)) | EventKind::Modify(ModifyKind::Name(_))
            if path.is_file() =>
        {
            FileChange::Written
        }
        // A new file counts only when its writer closes it, which is an event of its own.
        EventKind::Create(_) if is_new_plain_file(path) => FileChange::Nothing,
        // The path now leads to a folder, link or other thing, or permissions have changed and the file may be
        // readable.
        EventKind::Create(_) | EventKind::Modify(ModifyKind::Name(_) | ModifyKind::Metadata(_)) => FileChange::Moved,
        _ => FileChange::Nothing,
    }
}

/// Returns whether a path that was just created is a new file, and no folder, symbolic link or hard
/// link.
fn is_new_plain_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|data| data.is_file() && data.nlink() == 1)
}

/// Returns the change that an event at a folder or link on the path to a file indicates.
fn folder_or_link_change(kind: EventKind) -> FileChange {
    match kind {
        EventKind::Access(_) | EventKind::Modify(ModifyKind::Data(_)) => FileChange::Nothing,
        _ => FileChange::Moved,
    }
}

/// The error code for too many open files, on Linux and macOS.
const EMFILE: i32 = 24;

/// Returns the reason why a folder is not watched, in words.
fn reason(error: &notify::Error) -> String {
    match &error.kind {
        notify::ErrorKind::MaxFilesWatch => {
            "the system's limit of watched folders is reached (fs.inotify.max_user_watches)".to_owned()
        }
        notify::ErrorKind::Io(error) if error.raw_os_error() == Some(EMFILE) => {
            "too many files are open or watched (ulimit -n, fs.inotify.max_user_instances)".to_owned()
        }
        notify::ErrorKind::Io(error) => error.to_string(),
        _ => error.to_string(),
    }
}
