//! Checks that there is enough memory for a window or a file of a given size, before the memory is
//! used.
//!
//! The memory is later allocated piece by piece in functions that return no error: fallible allocation would put a
//! `Result` into every signature from the readers to the encoder. So the sum is reserved once before the work starts,
//! and freed unused. Where the address space or the committed memory is limited, this reservation fails as the pieces
//! would, while an error can still be reported. It costs two system calls. (A failed allocation elsewhere aborts the
//! process without restoring the terminal.)

use std::{error, fmt, io};

/// The error of too little memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfMemory {
    /// The purpose, such as "for a picture of 80x24 cells"; may be empty.
    purpose: String,
}

impl OutOfMemory {
    /// Returns the error with the purpose of the memory in its message, such as "for a picture of
    /// 80x24 cells".
    #[must_use]
    pub fn with_purpose(self, purpose: impl Into<String>) -> Self {
        Self { purpose: purpose.into() }
    }
}

impl fmt::Display for OutOfMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blank = if self.purpose.is_empty() { "" } else { " " };
        write!(f, "there is not enough memory{blank}{}", self.purpose)
    }
}

impl error::Error for OutOfMemory {}

impl From<OutOfMemory> for io::Error {
    /// Converts to an error of the kind [`OutOfMemory`](io::ErrorKind::OutOfMemory).
    fn from(error: OutOfMemory) -> Self {
        Self::new(io::ErrorKind::OutOfMemory, error.to_string())
    }
}

/// An allowance in bytes for other allocations during the work, and for the allocator's overhead.
const HEADROOM: usize = 32 << 20;

/// Checks that `bytes` bytes can be allocated.
///
/// # Errors
/// If there is not enough memory.
pub fn check(bytes: usize) -> Result<(), OutOfMemory> {
    let reserved = Vec::<u8>::new().try_reserve_exact(bytes.saturating_add(HEADROOM));
    reserved.map_err(|_| OutOfMemory { purpose: String::new() })
}

#[cfg(all(test, unit_tests))]
mod tests;
