//! Work on the threads of the current rayon pool.

use rayon::prelude::*;

/// Returns the number of threads. This may start rayon's global pool.
pub(crate) fn count() -> usize {
    rayon::current_num_threads()
}

/// Calls both functions, possibly at the same time.
pub(crate) fn join<A: Send, B: Send>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(first, second)
}

/// Returns the results of `make` for all numbers below `count`, in their order.
pub(crate) fn map<T: Send>(count: usize, make: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
    (0..count).into_par_iter().map(make).collect()
}

/// Appends the results of `make` for all numbers below `count` to `list`, in their order.
#[cfg(feature = "mesh")]
pub(crate) fn extend<T: Send>(list: &mut Vec<T>, count: usize, make: impl Fn(usize) -> T + Send + Sync) {
    list.par_extend((0..count).into_par_iter().map(make));
}

/// Calls `make` for each number below `count`, and returns the first and the second parts of the
/// results.
pub(crate) fn unzip<A: Send, B: Send>(count: usize, make: impl Fn(usize) -> (A, B) + Send + Sync) -> (Vec<A>, Vec<B>) {
    let (mut first, mut second) = (Vec::new(), Vec::new());
    (0..count).into_par_iter().map(make).unzip_into_vecs(&mut first, &mut second);
    (first, second)
}

/// Calls `work` in parallel with each chunk of `length` values of `written`, and the chunk of
/// `read` at the same position.
pub(crate) fn for_each_chunk<A: Send, B: Sync>(
    written: &mut [A],
    read: &[B],
    length: usize,
    work: impl Fn(&mut [A], &[B]) + Send + Sync,
) {
    written.par_chunks_mut(length).zip(read.par_chunks(length)).for_each(|(written, read)| work(written, read));
}

/// Returns the results of `work` for all items, in any order.
///
/// Threads take items one by one, which balances the load. `state` makes a state for each thread.
pub(crate) fn map_one_by_one<I, S, T>(
    items: I,
    state: impl Fn() -> S + Send + Sync,
    work: impl Fn(&mut S, I::Item) -> T + Send + Sync,
) -> Vec<T>
where
    I: Iterator<Item: Send> + Send,
    T: Send,
{
    // Without `par_bridge`, rayon split the fifteen tiles of a small picture into at most four pieces: with two threads
    // the picture took 1.46 ms instead of 1.34 ms.
    items.par_bridge().map_init(state, work).collect()
}

/// Runs `work` in a pool with the given number of threads.
///
/// If the threads cannot be started, `work` runs in the current pool.
pub(crate) fn in_pool_of<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}
