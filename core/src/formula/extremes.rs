//! Formulas that are the least or the greatest of a few values.
//!
//! Their sign is that of the value that decides it, while a model of the whole formula has a large error where the
//! values are far apart.

use super::operation::{Binary, COORDINATES, Index, Operation};

/// A value of which a formula is the least or the greatest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extreme {
    pub(super) index: Index,
    pub(super) is_negated: bool,
}

/// Returns the values of which a result is the least or the greatest, and whether it is the least.
///
/// Of the operations from `first` on, only the sign matters. `None` if the result is neither.
pub(super) fn extremes_of(operations: &[Operation], first: usize, result: Index) -> Option<(Box<[Extreme]>, bool)> {
    let combining = &operations[first..];
    let (mut extremes, mut is_least) = (Vec::new(), None);
    let mut pending = vec![Extreme { index: result, is_negated: false }];
    while let Some(extreme @ Extreme { index, is_negated }) = pending.pop() {
        let at = usize::from(index).checked_sub(COORDINATES + first);
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
