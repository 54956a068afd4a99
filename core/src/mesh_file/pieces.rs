//! Pieces of a file, which are parsed independently and joined in the order of the file.
//!
//! The pieces do not depend on the number of threads, so that neither do the mesh and the messages.

use super::fault::MeshFault;
use super::left_out::LeftOut;
use crate::progress::Meter;
use crate::threads;
use std::ops::{ControlFlow, Range};

/// The number of pieces for each thread that are parsed before any of them is joined.
// With more, the last thread of a batch is waited for less often; with fewer, less memory is in use.
const BATCH: usize = 4;

/// The number of pieces from which on a file is parsed on several threads.
// Fewer are parsed in a few milliseconds, for which no threads need to be started.
const MIN_PARALLEL_PIECES: usize = 4;

/// A parsed piece: its value, what was left out of it, and the fault that ended its reading.
struct Parsed<'a, T> {
    value: T,
    left_out: LeftOut<'a>,
    read: Result<(), MeshFault>,
}

/// Parses pieces, and passes them to `join` in the order of the file, until it returns `Break`.
///
/// `offsets_of` returns the byte offsets of a piece, for reports of progress.
///
/// # Errors
/// The first fault in the order of the file, or [`Cancelled`](crate::progress::Cancelled).
pub(super) fn parse_in_order<'a, P: Sync, T: Send>(
    pieces: &[P],
    offsets_of: impl Fn(&P) -> Range<usize>,
    (left_out, meter): (&mut LeftOut<'a>, &mut Meter<'_>),
    parse: impl Fn(&P, &mut LeftOut<'a>) -> (T, Result<(), MeshFault>) + Send + Sync,
    mut join: impl FnMut(&P, T) -> Result<ControlFlow<()>, MeshFault>,
) -> Result<(), MeshFault> {
    let is_parallel = meter.is_parallel() && pieces.len() >= MIN_PARALLEL_PIECES;
    let batch = if is_parallel { BATCH * threads::count() } else { 1 };
    let empty = left_out.of_piece();
    let parse = |piece: &P| {
        let mut left_out = empty.of_piece();
        let (value, read) = parse(piece, &mut left_out);
        Parsed { value, left_out, read }
    };
    if let Some(first) = pieces.first() {
        meter.report_at(offsets_of(first).start)?;
    }
    for pieces in pieces.chunks(batch) {
        let parsed: Vec<_> = if is_parallel {
            threads::map(pieces.len(), |at| parse(&pieces[at]))
        } else {
            pieces.iter().map(&parse).collect()
        };
        for (piece, Parsed { value, left_out: of_piece, read }) in pieces.iter().zip(parsed) {
            // What the piece left out comes before the fault that ended it.
            left_out.absorb(of_piece)?;
            read?;
            if join(piece, value)?.is_break() {
                return Ok(());
            }
            meter.report_at(offsets_of(piece).end)?;
        }
    }
    Ok(())
}
