//! Formulas that are the least or the greatest of a few values.
//!
//! Their sign is that of the value that decides it, while a model of the whole formula has a large error where the
//! values are far apart.

use super::tape::{Binary, COORDINATES, Index, Operation, Tape};

/// A value of which a formula is the least or the greatest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extreme {
    pub(super) index: Index,
    pub(super) is_negated: bool,
}

/// Returns the values of which a formula is the least or the greatest, and whether it is the least.
///
/// `None` if the formula is neither, or has so many choices that its tape is shortened instead.
pub(super) fn extremes_of(tape: &Tape) -> Option<(Box<[Extreme]>, bool)> {
    if tape.has_many_choices() {
        return None;
    }
    let combining = &tape.operations()[tape.combining()..];
    let (mut extremes, mut is_least) = (Vec::new(), None);
    let mut pending = vec![Extreme { index: tape.result(), is_negated: false }];
    while let Some(extreme @ Extreme { index, is_negated }) = pending.pop() {
        let at = usize::from(index).checked_sub(COORDINATES + tape.combining());
        match at.and_then(|at| combining.get(at)) {
            None => extremes.push(extreme),
            Some(&Operation::Unary(_, index)) => pending.push(Extreme { index, is_negated: !is_negated }),
            Some(&Operation::Binary(function, a, b)) => {
                // -min(a, b) is max(-a, -b).
                let is_min = (function == Binary::Min) != is_negated;
                if *is_least.get_or_insert(is_min) != is_min {
                    return None;
                }
                pending.extend([b, a].map(|index| Extreme { index, is_negated }));
            }
        }
    }
    Some((extremes.into_boxed_slice(), is_least?))
}
