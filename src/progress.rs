//! How far work has come, told to who waits for it, and who may have enough of it.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is being done, and how much of it is done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub work: Work,
    /// How much of it is done: bytes of a file, boxes of a tree.
    pub done: usize,
    /// How much there is to do; 0 where nobody knows.
    pub total: usize,
}

/// What takes time on the way from a file to a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Work {
    /// The file of that name comes from the disk.
    Reading(String),
    /// The bytes of the file of that name become triangles.
    Parsing(String),
    /// A tree is built over all that is in the scene.
    Building,
}

/// Who waits for work: he is told how far it has come, now and then and from any thread, and may go.
pub struct Watcher<'w> {
    hear: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync),
    hear_need: Option<&'w (dyn Fn(&Path) + Sync)>,
    is_gone: AtomicBool,
}

impl<'w> Watcher<'w> {
    /// One that hears of progress by this function, and has gone when it answers `Break`.
    pub fn new(hear: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync)) -> Self {
        Self { hear, hear_need: None, is_gone: AtomicBool::new(false) }
    }

    /// And that hears of each file by that function, before it is opened.
    pub fn with_needs(self, hear_need: &'w (dyn Fn(&Path) + Sync)) -> Self {
        Self { hear_need: Some(hear_need), ..self }
    }

    /// One that waits however long it takes.
    pub fn patient() -> Watcher<'static> {
        Watcher::new(&|_| ControlFlow::Continue(()))
    }

    /// Tells him. `Break`: he has gone, and the work is to be given up.
    pub fn tell(&self, progress: Progress) -> ControlFlow<()> {
        if (self.hear)(progress).is_break() {
            self.is_gone.store(true, Ordering::Relaxed);
        }
        if self.is_gone() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Tells him that the work needs that file, which may not be there.
    pub fn needs(&self, file: &Path) {
        if let Some(hear) = self.hear_need {
            hear(file);
        }
    }

    /// Whether he has gone.
    pub fn is_gone(&self) -> bool {
        self.is_gone.load(Ordering::Relaxed)
    }
}
