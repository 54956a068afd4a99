//! The files of the scene that is shown: when they change, it is read again.
//!
//! The system tells of changes in folders, because a file that is replaced by another of its name is a new file. A path may
//! lead through several folders and links: each is watched, and while one of them is missing, what is around it. A thread
//! sleeps until the system tells something; at rest nothing wakes it, or us.

mod needed;
mod way;

pub(super) use needed::Needed;

use crate::terminal::{self, Waker};
use needed::{Identity, identity};
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind, RenameMode};
use notify::{Config, Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::{HashMap, HashSet};
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use way::Way;

/// Our side of the thread.
pub(super) struct Watching {
    watcher: RecommendedWatcher,
    /// What the scene was read from.
    needed: Vec<Needed>,
    /// The folders that are watched.
    folders: HashMap<PathBuf, Identity>,
    /// Why some folder is not watched.
    problem: Option<String>,
    shared: Arc<Mutex<Shared>>,
}

/// What the thread goes by, and what it says.
#[derive(Default)]
struct Shared {
    /// Folders and links on the way to the files.
    steps: HashSet<PathBuf>,
    /// The files themselves.
    ends: HashSet<PathBuf>,
    told: Told,
}

/// What has happened, and so what there is to do; the later ones include the earlier ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
enum Told {
    #[default]
    Nothing,
    /// A file is gone, perhaps for a moment: it may come back by another way.
    Gone,
    /// The way to a file has changed: it may be another file now.
    Moved,
    /// A file has got new contents.
    Written,
}

/// The way to a file is looked for again this often, where it changes while it is looked for.
const MOST_LOOKS: usize = 8;

impl Watching {
    /// Starts the thread, which watches nothing yet.
    pub(super) fn start(mut waker: Waker) -> Result<Self, String> {
        terminal::reach("watching").map_err(|error| error.to_string())?;
        let shared = Arc::<Mutex<Shared>>::default();
        let theirs = Arc::clone(&shared);
        let hear = move |event: notify::Result<Event>| {
            let mut shared = lock(&theirs);
            // Where the system lost count of the changes, there may have been one.
            let told = event.map_or(Told::Written, |event| shared.meaning(&event));
            if told > shared.told {
                shared.told = told;
                waker.wake();
            }
        };
        let watcher = terminal::without_signals(|| notify::recommended_watcher(hear)).map_err(|e| reason(&e))?;
        let mut watching = Self { watcher, needed: Vec::new(), folders: HashMap::new(), problem: None, shared };
        // notify does not say whether its thread could be started, and without it panics at every call, also when it is
        // dropped. This call alone returns an error.
        if watching.watcher.configure(Config::default()).is_err() {
            std::mem::forget(watching);
            return Err("no thread can be started".to_owned());
        }
        Ok(watching)
    }

    /// From now on these are watched, and no others. Returns whether one has changed since it was read.
    pub(super) fn watch(&mut self, needed: Vec<Needed>) -> bool {
        self.needed = needed;
        self.look(true)
    }

    /// Returns whether a file has changed since the last call.
    pub(super) fn take_changed(&mut self) -> bool {
        let told = std::mem::take(&mut lock(&self.shared).told);
        let has_changed = match told {
            Told::Nothing => false,
            Told::Gone => self.look(false),
            Told::Moved => self.look(true),
            Told::Written => true,
        };
        if has_changed {
            // Read again once for this change, and not for each event that tells of it.
            self.needed.iter_mut().for_each(|needed| *needed = Needed::now(needed.path()));
        }
        has_changed
    }

    /// Returns why changes are not seen, if they are not.
    pub(super) fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Watches the ways to the files as they are now. Returns whether one of the files has changed: of all, or of those whose
    /// folder has not been watched before. (Of the others the end of writing is told; to read them now might be to read
    /// half.)
    fn look(&mut self, all: bool) -> bool {
        let mut fresh = HashSet::new();
        for _ in 0..MOST_LOOKS {
            let ways = self.ways();
            self.share(&ways);
            fresh.extend(self.watch_folders(&ways));
            // A link that was exchanged before its folder was watched leads elsewhere now.
            if self.ways() == ways {
                break;
            }
        }
        let is_fresh = |needed: &Needed| {
            Way::to(needed.path()).is_some_and(|way| way.end().parent().is_some_and(|folder| fresh.contains(folder)))
        };
        self.needed.iter().any(|needed| (all || is_fresh(needed)) && needed.has_changed())
    }

    fn ways(&self) -> Vec<Way> {
        self.needed.iter().filter_map(|needed| Way::to(needed.path())).collect()
    }

    fn share(&self, ways: &[Way]) {
        let mut shared = lock(&self.shared);
        shared.steps = ways.iter().flat_map(Way::steps).map(Path::to_owned).collect();
        shared.ends = ways.iter().map(|way| way.end().to_owned()).collect();
    }

    /// Watches the folders of these ways, and no others; returns those that were not watched before.
    fn watch_folders(&mut self, ways: &[Way]) -> Vec<PathBuf> {
        let mut looked_in: HashSet<_> = ways.iter().flat_map(Way::looked_in).map(Path::to_owned).collect();
        if cfg!(not(target_os = "linux")) {
            // kqueue tells of a folder's names alone, and of contents where the file itself is watched.
            looked_in.extend(ways.iter().map(Way::end).map(Path::to_owned));
        }
        let around = ways.iter().flat_map(Way::around).map(Path::to_owned);
        let folders: HashSet<_> = looked_in.iter().cloned().chain(around).collect();
        let watcher = &mut self.watcher;
        self.folders.retain(|folder, _| {
            let is_wanted = folders.contains(folder);
            if !is_wanted {
                let _ = watcher.unwatch(folder);
            }
            is_wanted
        });
        self.problem = None;
        let mut fresh = Vec::new();
        for folder in folders {
            match self.watch_folder(&folder) {
                Ok(true) => fresh.push(folder),
                Err(error) if looked_in.contains(&folder) => self.problem = Some(reason(&error)),
                // A folder around that may not be looked into is not told of: it hardly ever changes.
                _ => {}
            }
        }
        fresh
    }

    /// Returns whether the folder was not watched before.
    fn watch_folder(&mut self, folder: &Path) -> notify::Result<bool> {
        let found = identity(&fs::metadata(folder)?);
        let known = self.folders.get(folder).copied();
        if known.is_some_and(|known| known != found) {
            // The watch is on the one that was there before.
            let _ = self.watcher.unwatch(folder);
        }
        self.folders.remove(folder);
        // Also where it is watched already, which costs nothing and loses nothing: notify gives up a folder when it is
        // told that its name is gone, even if there is another of that name by then.
        self.watcher.watch(folder, RecursiveMode::NonRecursive)?;
        self.folders.insert(folder.to_owned(), found);
        Ok(known != Some(found))
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    fn meaning(&self, event: &Event) -> Told {
        if event.need_rescan() {
            return Told::Written;
        }
        // kqueue does not say what has changed in a folder.
        if cfg!(not(target_os = "linux")) {
            return Told::Moved;
        }
        let meaning = |path: &PathBuf| match (self.ends.contains(path), self.steps.contains(path)) {
            (true, _) => of_file(event.kind, path),
            (false, true) => of_step(event.kind),
            (false, false) => Told::Nothing,
        };
        event.paths.iter().map(meaning).max().unwrap_or_default()
    }
}

/// What an event means for a file. Its new contents count when they are all there, so that none is read half written.
fn of_file(kind: EventKind, path: &Path) -> Told {
    match kind {
        EventKind::Remove(_) | EventKind::Modify(ModifyKind::Name(RenameMode::From)) => Told::Gone,
        // (A pipe is written to by whoever feeds it.)
        EventKind::Access(AccessKind::Close(AccessMode::Write)) | EventKind::Modify(ModifyKind::Name(_))
            if path.is_file() =>
        {
            Told::Written
        }
        EventKind::Create(_) if is_about_to_be_written(path) => Told::Nothing,
        // What else comes into its place. With other permissions, it may be read at last.
        EventKind::Create(_) | EventKind::Modify(ModifyKind::Name(_) | ModifyKind::Metadata(_)) => Told::Moved,
        _ => Told::Nothing,
    }
}

/// Returns whether what was just created is a new file, and neither a folder nor a link of either kind.
fn is_about_to_be_written(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|data| data.is_file() && data.nlink() == 1)
}

/// What an event means for a folder or link on the way to a file.
fn of_step(kind: EventKind) -> Told {
    match kind {
        EventKind::Access(_) | EventKind::Modify(ModifyKind::Data(_)) => Told::Nothing,
        _ => Told::Moved,
    }
}

/// Too many open files, on all systems that this runs on.
const EMFILE: i32 = 24;

/// Why something is not watched, in words.
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
