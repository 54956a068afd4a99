//! Memory, asked for before it is used, where its amount depends on a window or a file.
//!
//! What depends on them is allocated piece by piece, by stages that have no error to return: to make each of them fail
//! would put a `Result` into every signature from the readers to the encoder. So the sum is reserved once, before the work
//! begins, and given back untouched. Where the address space or the memory that may be committed is limited, that fails as
//! the pieces would, while there still is a way to say so; it costs two system calls. (An allocation that fails is the end
//! of the process, with the terminal as it is.)

use std::io;

/// What everything else takes that is allocated meanwhile, and what an allocator wastes.
const HEADROOM: usize = 32 << 20;

/// Finds out whether so many bytes can be allocated.
///
/// # Errors
/// [`OutOfMemory`](io::ErrorKind::OutOfMemory) if they cannot.
pub fn check(bytes: usize) -> io::Result<()> {
    let reserved = Vec::<u8>::new().try_reserve_exact(bytes.saturating_add(HEADROOM));
    reserved.map_err(|_| io::Error::new(io::ErrorKind::OutOfMemory, "there is not enough memory"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_machine_has_is_an_error() {
        assert!(check(1 << 20).is_ok());
        for bytes in [1 << 60, usize::MAX] {
            assert_eq!(check(bytes).map_err(|error| error.kind()), Err(io::ErrorKind::OutOfMemory));
        }
    }
}
