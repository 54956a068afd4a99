//! Work on the calling thread only.
//!
//! The bounds on types are those in `pool`, so that all code compiles with either module.

/// Returns the number of threads: 1.
pub(crate) fn count() -> usize {
    1
}

/// Calls both functions one after the other.
pub(crate) fn join<A: Send, B: Send>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B + Send) -> (A, B) {
    (first(), second())
}

/// Returns the results of `make` for all numbers below `count`, in their order.
pub(crate) fn map<T: Send>(count: usize, make: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
    (0..count).map(make).collect()
}

/// Appends the results of `make` for all numbers below `count` to `list`, in their order.
#[cfg(feature = "mesh")]
pub(crate) fn extend<T: Send>(list: &mut Vec<T>, count: usize, make: impl Fn(usize) -> T + Send + Sync) {
    list.extend((0..count).map(make));
}

/// Calls `make` for each number below `count`, and returns the first and the second parts of the
/// results.
pub(crate) fn unzip<A: Send, B: Send>(count: usize, make: impl Fn(usize) -> (A, B) + Send + Sync) -> (Vec<A>, Vec<B>) {
    (0..count).map(make).unzip()
}

/// Calls `work` for one chunk of `length` values of `written` after the other, each with the chunk
/// of `read` at the same position.
pub(crate) fn for_each_chunk<A: Send, B: Sync>(
    written: &mut [A],
    read: &[B],
    length: usize,
    work: impl Fn(&mut [A], &[B]) + Send + Sync,
) {
    written.chunks_mut(length).zip(read.chunks(length)).for_each(|(written, read)| work(written, read));
}

/// Returns the results of `work` for all items. `state` makes the state that is passed to `work`.
pub(crate) fn map_one_by_one<I, S, T>(
    items: I,
    state: impl Fn() -> S + Send + Sync,
    work: impl Fn(&mut S, I::Item) -> T + Send + Sync,
) -> Vec<T>
where
    I: Iterator<Item: Send> + Send,
    T: Send,
{
    let mut state = state();
    items.map(|item| work(&mut state, item)).collect()
}

/// Runs `work` on the calling thread.
pub(crate) fn in_pool_of<T>(_threads: usize, work: impl FnOnce() -> T) -> T {
    work()
}
