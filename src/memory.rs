//! Memory, asked for before it is used, where its amount depends on a window or a file.
//!
//! What depends on them is allocated piece by piece, by stages that have no error to return: to make each of them fail
//! would put a `Result` into every signature from the readers to the encoder. So the sum is reserved once, before the work
//! begins, and given back untouched. Where the address space or the memory that may be committed is limited, that fails as
//! the pieces would, while there still is a way to say so; it costs two system calls. (An allocation that fails is the end
//! of the process, with the terminal as it is.)

use std::{error, fmt, io};

/// There is not enough memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfMemory {
    /// For what, such as "for a picture of 80x24 cells"; may be empty.
    what_for: String,
}

impl OutOfMemory {
    /// The same error, which also tells for what there is not enough.
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
    /// Of the kind [`OutOfMemory`](io::ErrorKind::OutOfMemory).
    fn from(error: OutOfMemory) -> Self {
        Self::new(io::ErrorKind::OutOfMemory, error.to_string())
    }
}

/// What everything else takes that is allocated meanwhile, and what an allocator wastes.
const HEADROOM: usize = 32 << 20;

/// Finds out whether so many bytes can be allocated.
///
/// # Errors
/// If they cannot.
pub fn check(bytes: usize) -> Result<(), OutOfMemory> {
    let reserved = Vec::<u8>::new().try_reserve_exact(bytes.saturating_add(HEADROOM));
    reserved.map_err(|_| OutOfMemory { what_for: String::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_machine_has_is_an_error() {
        assert!(check(1 << 20).is_ok());
        for bytes in [1 << 60, usize::MAX] {
            let error = io::Error::from(check(bytes).expect_err("no machine has it").when("for a test"));
            assert_eq!(error.kind(), io::ErrorKind::OutOfMemory);
            assert_eq!(error.to_string(), "there is not enough memory for a test");
        }
    }
}
