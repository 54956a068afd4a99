//! The time of each cell's last change, from which the time to make a lossy cell exact follows.

use crate::grid::{Grid, Size};
use std::time::Duration;

/// Time from a cell's last change until it is made exact.
// Long enough that a short pause of a movement causes no exact frame, short enough that the picture is exact within a
// second.
const EXACT_AFTER: Duration = Duration::from_millis(500);

/// The last wanted grid and the time of each cell's last change.
#[derive(Clone, Debug)]
pub(super) struct ChangeTimes {
    wanted: Grid,
    since: Vec<Duration>,
}

impl Default for ChangeTimes {
    fn default() -> Self {
        Self { wanted: Grid::new(Size::new(0, 0)), since: Vec::new() }
    }
}

impl ChangeTimes {
    /// Records a wanted grid, and `now` as the time of change for cells that differ from the last
    /// one.
    ///
    /// Returns whether any cell has changed.
    pub(super) fn record(&mut self, wanted: &Grid, now: Duration) -> bool {
        if self.wanted.size() != wanted.size() {
            self.wanted = wanted.clone();
            self.since = vec![now; wanted.cells().len()];
            return true;
        }
        let mut has_changed = false;
        for ((last, cell), since) in self.wanted.cells_mut().iter_mut().zip(wanted.cells()).zip(&mut self.since) {
            // Updated in place, because cloning the whole grid for each frame would allocate.
            if last != cell {
                last.clone_from(cell);
                *since = now;
                has_changed = true;
            }
        }
        has_changed
    }

    /// Returns the time at which the cell at index `cell_index` is to be made exact.
    pub(super) fn exact_at(&self, cell_index: usize) -> Duration {
        self.since[cell_index].saturating_add(EXACT_AFTER)
    }
}
