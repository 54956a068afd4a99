//! The ages of cells: the times since the wanted contents changed, and since the shown were right.
//!
//! From the first follows the time to make a lossy cell exact, from the second how urgent it is to mend a cell under a
//! limit of bytes.

use crate::grid::{Grid, Size};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

/// Time from a cell's last change until it is made exact.
// Long enough that a short pause of a movement causes no exact frame, short enough that the picture is exact within a
// second.
const EXACT_AFTER: Duration = Duration::from_millis(500);

/// The steps that a wrong cell takes to its deadline.
const STEPS_TO_DEADLINE: f32 = 4096.0;

/// The greatest number of steps of a cell that was right in the frame before.
// About those of a frame at 15 a second.
const MOST_FIRST_STEPS: u16 = 256;

/// The ages of all cells.
#[derive(Clone, Debug)]
pub(super) struct CellAges {
    size: Size,
    /// The time of the last frame.
    now: Duration,
    /// The seconds from the frame before to the last one.
    elapsed: f32,
    cells: Vec<CellAge>,
    /// Whether any cell was wrong after the last frame under a limit.
    has_wrong: bool,
}

/// A digest of a cell of the last wanted grid, and its ages.
// A digest of 32 bits misses one of four billion changes; the cell is then made exact earlier.
#[derive(Clone, Copy, Debug)]
struct CellAge {
    digest: u32,
    /// The time since the wanted cell's last change in milliseconds, at most `u16::MAX`.
    unchanged_millis: u16,
    /// The steps to the deadline for which the shown cell has been wrong in every frame.
    wrong_steps: u16,
}

impl Default for CellAges {
    fn default() -> Self {
        Self { size: Size::new(0, 0), now: Duration::ZERO, elapsed: 0.0, cells: Vec::new(), has_wrong: false }
    }
}

impl CellAges {
    /// Records a grid that is wanted `now`. Cells that differ from the last one begin a new age.
    ///
    /// Returns whether any cell has changed.
    pub(super) fn record(&mut self, wanted: &Grid, now: Duration) -> bool {
        // Both times are rounded down before subtracting, so that rounding errors do not add up.
        let millis = now.as_millis().saturating_sub(self.now.as_millis()).min(u16::MAX.into()) as u16;
        self.elapsed = now.saturating_sub(self.now).as_secs_f32();
        self.now = now;
        let mut has_changed = self.size != wanted.size();
        if has_changed {
            self.size = wanted.size();
            self.cells.clear();
            let new = CellAge { digest: 0, unchanged_millis: 0, wrong_steps: 0 };
            self.cells.resize(wanted.packed().len(), new);
            self.cells.shrink_to_fit();
        }
        for (age, &cell) in self.cells.iter_mut().zip(wanted.packed()) {
            let digest = wanted.cluster(cell).map_or_else(|| cell.digest(), |text| digest_of(text, cell.digest()));
            age.unchanged_millis = age.unchanged_millis.saturating_add(millis);
            if age.digest != digest {
                (age.digest, age.unchanged_millis) = (digest, 0);
                has_changed = true;
            }
        }
        has_changed
    }

    /// Returns the size of the last recorded grid.
    pub(super) fn size(&self) -> Size {
        self.size
    }

    /// Returns the seconds from the frame before the last recorded one to that one.
    pub(super) fn elapsed(&self) -> f32 {
        self.elapsed
    }

    /// Returns whether the cell at index `cell_index` is to be made exact now.
    pub(super) fn has_waited(&self, cell_index: usize) -> bool {
        u128::from(self.cells[cell_index].unchanged_millis) >= EXACT_AFTER.as_millis()
    }

    /// Returns the time at which the last of some cells is to be made exact.
    pub(super) fn all_exact_at(&self, cells: impl Iterator<Item = usize>) -> Option<Duration> {
        let age = cells.map(|cell_index| self.cells[cell_index].unchanged_millis).min()?;
        let now = Duration::from_millis(self.now.as_millis() as u64);
        Some(now.saturating_sub(Duration::from_millis(age.into())).saturating_add(EXACT_AFTER))
    }

    /// Records which cells are wrong after a frame: those at the given indices, in ascending order.
    ///
    /// Each of them comes nearer to its deadline by `share` of the time that it may be wrong.
    // A cell that was right before has become wrong at some time of `share`, which may be a long rest.
    pub(super) fn record_wrong(&mut self, wrong: &[u32], share: f32) {
        let steps = (STEPS_TO_DEADLINE * share).round() as u16;
        let first_steps = steps.min(MOST_FIRST_STEPS);
        self.has_wrong = !wrong.is_empty();
        let mut others = 0;
        for &cell_index in wrong {
            let cell_index = cell_index as usize;
            self.cells[others..cell_index].iter_mut().for_each(|age| age.wrong_steps = 0);
            let age = &mut self.cells[cell_index];
            age.wrong_steps = match age.wrong_steps {
                0 => first_steps,
                before => before.saturating_add(steps),
            };
            others = cell_index + 1;
        }
        self.cells[others..].iter_mut().for_each(|age| age.wrong_steps = 0);
    }

    /// Records that no cell is wrong.
    pub(super) fn clear_wrong(&mut self) {
        if self.has_wrong {
            self.record_wrong(&[], 0.0);
        }
    }

    /// Returns for how long the cell at index `cell_index` has been wrong, as a share of the time
    /// that it may be.
    pub(super) fn wrong_share(&self, cell_index: usize) -> f32 {
        f32::from(self.cells[cell_index].wrong_steps) / STEPS_TO_DEADLINE
    }
}

/// Returns the digest of a cell with a cluster, from its text and the digest of all else.
fn digest_of(text: &str, of_colors: u32) -> u32 {
    let mut hasher = DefaultHasher::new();
    (text, of_colors).hash(&mut hasher);
    hasher.finish() as u32
}

#[cfg(all(test, unit_tests))]
mod tests;
