//! Parallel work on the current rayon pool.
//!
//! Without the feature `parallel` the work runs on the calling thread, with the same results.

#[cfg(not(feature = "parallel"))]
mod alone;
#[cfg(feature = "parallel")]
mod pool;

#[cfg(not(feature = "parallel"))]
pub(crate) use alone::{count, for_each_chunk, in_pool_of, join, map, map_one_by_one, unzip};
#[cfg(feature = "parallel")]
pub(crate) use pool::{count, for_each_chunk, in_pool_of, join, map, map_one_by_one, unzip};

#[cfg(all(feature = "mesh", not(feature = "parallel")))]
pub(crate) use alone::extend;
#[cfg(all(feature = "mesh", feature = "parallel"))]
pub(crate) use pool::extend;
