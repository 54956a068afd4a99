//! Parallel work, on the current rayon pool.
//!
//! Without the feature `parallel` it runs on the calling thread. Results are the same and in the same order.

#[cfg(not(feature = "parallel"))]
mod alone;
#[cfg(feature = "parallel")]
mod pool;

#[cfg(not(feature = "parallel"))]
pub(crate) use alone::{count, for_each_chunk, in_pool_of, join, map_one_by_one, unzip};
#[cfg(feature = "parallel")]
pub(crate) use pool::{count, for_each_chunk, in_pool_of, join, map_one_by_one, unzip};
