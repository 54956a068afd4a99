//! Parallel work: on the threads of the current rayon pool with the feature `parallel`, on the calling thread without
//! it. Results are the same and in the same order.

#[cfg(not(feature = "parallel"))]
mod alone;
#[cfg(feature = "parallel")]
mod pool;

#[cfg(not(feature = "parallel"))]
pub(crate) use alone::{count, for_each_chunk, in_pool_of, join, map_one_by_one, unzip};
#[cfg(feature = "parallel")]
pub(crate) use pool::{count, for_each_chunk, in_pool_of, join, map_one_by_one, unzip};
