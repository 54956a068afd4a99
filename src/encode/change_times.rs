//! The time of each cell's last change, from which the time to make a lossy cell exact follows.

use crate::grid::{Grid, Size};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

/// Time from a cell's last change until it is made exact.
// Long enough that a short pause of a movement causes no exact frame, short enough that the picture is exact within a
// second.
const EXACT_AFTER: Duration = Duration::from_millis(500);

/// A digest of each cell of the last wanted grid, and the time of its last change.
// A digest of 32 bits misses one of four billion changes; the cell is then made exact earlier.
#[derive(Clone, Debug)]
pub(super) struct ChangeTimes {
    size: Size,
    /// The time of the last frame.
    now: Duration,
    cells: Vec<LastChange>,
}

#[derive(Clone, Copy, Debug)]
struct LastChange {
    digest: u32,
    /// The time of the change in milliseconds, of which the lowest 32 bits are kept.
    // The 32 bits overflow after seven weeks: a cell unchanged for that long appears to have just changed.
    since: u32,
}

impl Default for ChangeTimes {
    fn default() -> Self {
        Self { size: Size::new(0, 0), now: Duration::ZERO, cells: Vec::new() }
    }
}

impl ChangeTimes {
    /// Records a wanted grid, and `now` as the time of change for cells that differ from the last
    /// one.
    ///
    /// Returns whether any cell has changed.
    pub(super) fn record(&mut self, wanted: &Grid, now: Duration) -> bool {
        let since = now.as_millis() as u32;
        self.now = now;
        let mut has_changed = self.size != wanted.size();
        if has_changed {
            self.size = wanted.size();
            self.cells.clear();
            self.cells.resize(wanted.packed().len(), LastChange { digest: 0, since });
            self.cells.shrink_to_fit();
        }
        for (last, &cell) in self.cells.iter_mut().zip(wanted.packed()) {
            let digest = wanted.cluster(cell).map_or_else(|| cell.digest(), |text| digest_of(text, cell.digest()));
            if last.digest != digest {
                *last = LastChange { digest, since };
                has_changed = true;
            }
        }
        has_changed
    }

    /// Returns whether the cell at index `cell_index` is to be made exact now.
    pub(super) fn has_waited(&self, cell_index: usize) -> bool {
        self.age_in_millis(cell_index) >= EXACT_AFTER.as_millis() as u32
    }

    /// Returns the time at which the last of some cells is to be made exact.
    pub(super) fn all_exact_at(&self, cells: impl Iterator<Item = usize>) -> Option<Duration> {
        let age = cells.map(|cell_index| self.age_in_millis(cell_index)).min()?;
        let now = Duration::from_millis(self.now.as_millis() as u64);
        Some(now.saturating_sub(Duration::from_millis(age.into())).saturating_add(EXACT_AFTER))
    }

    /// Returns the time since the last change of the cell at index `cell_index`, in milliseconds.
    fn age_in_millis(&self, cell_index: usize) -> u32 {
        (self.now.as_millis() as u32).wrapping_sub(self.cells[cell_index].since)
    }
}

/// Returns the digest of a cell with a cluster, from its text and the digest of all else.
fn digest_of(text: &str, of_colors: u32) -> u32 {
    let mut hasher = DefaultHasher::new();
    (text, of_colors).hash(&mut hasher);
    hasher.finish() as u32
}
