//! Checks for memory whose amount depends on a window or a file, before it is used.
//!
//! The memory is then allocated piece by piece by stages that return no error: making each of them fallible would put a
//! `Result` into every signature from the readers to the encoder. So the sum is reserved once before the work starts,
//! and freed untouched. Where the address space or the committed memory is limited, this reservation fails as the
//! pieces would, while an error can still be reported; it costs two system calls. (A failed allocation elsewhere aborts
//! the process without restoring the terminal.)

use std::{error, fmt, io};

/// The error of too little memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfMemory {
    /// The purpose, such as "for a picture of 80x24 cells"; may be empty.
    what_for: String,
}

impl OutOfMemory {
    /// Adds what the memory was needed for to the message.
    #[must_use]
    pub fn when(self, what_for: impl Into<String>) -> Self {
        Self { what_for: what_for.into() }
    }
}

impl fmt::Display for OutOfMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blank = if self.what_for.is_empty() { "" } else { " " };
        write!(f, "there is not enough memory{blank}{}", self.what_for)
    }
}

impl error::Error for OutOfMemory {}

impl From<OutOfMemory> for io::Error {
    /// The kind is [`OutOfMemory`](io::ErrorKind::OutOfMemory).
    fn from(error: OutOfMemory) -> Self {
        Self::new(io::ErrorKind::OutOfMemory, error.to_string())
    }
}

/// Allowance for everything else that is allocated meanwhile, and for the allocator's overhead.
const HEADROOM: usize = 32 << 20;

/// Checks that this many bytes can be allocated.
///
/// # Errors
/// If they cannot.
pub fn check(bytes: usize) -> Result<(), OutOfMemory> {
    let reserved = Vec::<u8>::new().try_reserve_exact(bytes.saturating_add(HEADROOM));
    reserved.map_err(|_| OutOfMemory { what_for: String::new() })
}

#[cfg(all(test, unit_tests))]
mod tests;
