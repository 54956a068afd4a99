//! The scheduling of a picture's tiles on threads, and of the batches of each tile.

use super::Cost;
use super::report::TileReport;
use super::sampling::{SampleBatch, SampleBatches};
use super::steps::{Buffers, ProgressUnit, RenderJob};
use crate::progress::{Cancellation, Cancelled};
use crate::threads;
use std::ops::Range;
use std::time::{Duration, Instant};

/// The threads that trace a picture, and what may cancel them.
#[derive(Clone, Copy, Debug)]
pub enum Executor<'a> {
    /// The calling thread alone.
    CurrentThread,
    /// The threads of the current rayon pool.
    Pool,
    /// The threads of the current rayon pool, until the token is cancelled.
    Cancellable(&'a Cancellation),
    /// The threads of the current rayon pool, with progress reports that may cancel.
    Reporting(&'a TileReport<'a>),
}

/// The largest predicted time of a picture that the calling thread traces alone.
// Waking another thread takes 16 us, and 80 us after a pause. For three_spheres at 40x24 two threads took 19 to 25 us
// and one thread 15; at 80x48 two took 44 to 46 us and one 41.
const SINGLE_THREAD_TIME: Duration = Duration::from_micros(300);

impl Executor<'_> {
    pub(super) fn is_cancelled(self) -> bool {
        match self {
            Self::CurrentThread | Self::Pool => false,
            Self::Cancellable(token) => token.is_cancelled(),
            Self::Reporting(report) => report.is_cancelled(),
        }
    }

    /// Returns the result, unless the executor's token is cancelled.
    // One check at the end is enough: tokens stay cancelled, so if the token is not cancelled now, no tile was skipped.
    pub(crate) fn unless_cancelled<T>(self, traced: T) -> Result<T, Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(traced) }
    }

    /// Calls `trace` with each tile of a job and the tile's part of the result, and returns the
    /// cost.
    ///
    /// Each thread reuses one set of buffers for all of its tiles.
    pub(super) fn trace<T: Send>(
        self,
        job: &RenderJob<'_>,
        parts: Vec<T>,
        trace: impl Fn(&mut Tile<'_>, T) + Send + Sync,
    ) -> Cost {
        let work = |buffers: &mut Buffers, (number, part)| {
            if self.is_cancelled() {
                return Cost::default();
            }
            job.tiles.pixels_in_picture(number, &mut buffers.active);
            let mut tile = Tile { executor: self, job, number, buffers, cost: Cost::default() };
            trace(&mut tile, part);
            if let (Self::Reporting(report), ProgressUnit::Tile(units)) = (self, job.unit) {
                report.add_finished(units);
            }
            tile.cost
        };
        // The calling thread begins alone, and after each tile predicts the time of the whole picture from the finished
        // tiles. The clock only decides which thread traces a tile, and has no effect on the light.
        let (start, count) = (Instant::now(), parts.len() as u32);
        let is_short = |done: u32| start.elapsed() * count < SINGLE_THREAD_TIME * done;
        let mut is_single_threaded = matches!(self, Self::CurrentThread);
        let mut tiles = parts.into_iter().enumerate();
        let (mut buffers, mut costs) = (Buffers::default(), Vec::with_capacity(tiles.len()));
        for (done, tile) in (1..).zip(tiles.by_ref()) {
            costs.push(work(&mut buffers, tile));
            if !is_single_threaded && !is_short(done) {
                // The number of threads is queried only now, because the query starts rayon's global pool.
                is_single_threaded = threads::count() == 1;
                if !is_single_threaded {
                    break;
                }
            }
        }
        if tiles.len() > 0 {
            costs.extend(threads::map_one_by_one(tiles, Buffers::default, work));
        }
        let mut sum = Cost::default();
        for cost in costs {
            sum += cost;
        }
        sum
    }
}

/// A tile of a job, with the buffers of the thread that traces it.
pub(super) struct Tile<'t> {
    executor: Executor<'t>,
    job: &'t RenderJob<'t>,
    /// The index of the tile.
    pub(super) number: usize,
    pub(super) buffers: &'t mut Buffers,
    cost: Cost,
}

impl Tile<'_> {
    /// Traces samples of the active pixels, until the executor is cancelled.
    ///
    /// Calls `sink` after each batch of rays with the buffers, the sample batch, and the range of its active pixels.
    pub(super) fn trace(
        &mut self,
        batches: &SampleBatches,
        mut sink: impl FnMut(&mut Buffers, &SampleBatch, Range<usize>),
    ) {
        let Self { executor, job, number, ref mut buffers, ref mut cost } = *self;
        let start = Instant::now();
        'batches: for batch in batches.iter() {
            for range in batch.pixel_ranges(buffers.active.len()) {
                // The flag is checked once per 256 rays, which take 50 us at 5 Mrays/s. This is often enough for a
                // cancel, and its cost is not measurable.
                if executor.is_cancelled() {
                    break 'batches;
                }
                cost.rays += buffers.trace(job, number, &batch, range.clone());
                let pixels = range.len();
                sink(buffers, &batch, range);
                if let (Executor::Reporting(report), ProgressUnit::Ray) = (executor, job.unit) {
                    report.add_finished((pixels * batch.per_pixel()) as u64);
                }
            }
        }
        cost.work += start.elapsed();
    }
}
