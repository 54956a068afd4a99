//! Since when each cell has been wanted as it is: what has been still for long is to be shown exactly.

use crate::grid::{Grid, Size};
use std::time::Duration;

/// How long a cell may show nearly its colours after they last changed. Long enough that what only pauses is not sent
/// twice, and short enough that all is exact within a second.
const EXACT_AFTER: Duration = Duration::from_millis(500);

/// The last wanted grid, and when each of its cells last changed.
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
    /// A grid is wanted.
    pub(super) fn record(&mut self, wanted: &Grid, now: Duration) {
        if self.wanted.size() != wanted.size() {
            self.wanted = wanted.clone();
            self.since = vec![now; wanted.cells().len()];
            return;
        }
        for ((last, cell), since) in self.wanted.cells_mut().iter_mut().zip(wanted.cells()).zip(&mut self.since) {
            if last != cell {
                last.clone_from(cell);
                *since = now;
            }
        }
    }

    /// When a cell is to have its exact colours.
    pub(super) fn exact_at(&self, at: usize) -> Duration {
        self.since[at].saturating_add(EXACT_AFTER)
    }
}
