//! The shorter tape of rays on which minima, maxima and absolute values are decided.
//!
//! Of `min(a, b)` only one operand is needed where the other one is certainly larger. Where only its sign is needed, as
//! that of the whole formula, `a` can also be left out where it is certainly positive: of 64 balls most rays need none.
//!
//! Each lane has its own choices. An operation that some lane needs is kept for all, but counts only in the lanes that
//! need it: so the bits of a lane do not depend on the other lanes.

use super::extremes::Extreme;
use super::models::{Models, StoredModels};
use super::operation::{Binary, COORDINATES, Index, Operation, Unary};
use super::packet::PacketModels;
use super::tape::{Steps, Tape};
use crate::lanes::{LaneMask, Lanes};

/// The lanes in which a value has a certain sign, or is certainly defined.
#[derive(Clone, Copy, Debug, Default)]
struct LaneSigns {
    positive: u8,
    negative: u8,
    defined: u8,
}

/// The operations of a tape that eight rays need, renumbered.
#[derive(Debug, Default)]
pub(super) struct ShorterTape {
    operations: Vec<Operation>,
    chosen: Vec<[u8; 2]>,
    /// For each operation the lanes that need its value.
    needed_by: Vec<u8>,
    result: Extreme,
    /// The signs of the operations that combine signs.
    signs: Vec<LaneSigns>,
    /// For each index of the tape, the lanes that need its value.
    needed: Vec<u8>,
    /// The indices in the shorter tape; 0 for a value that no lane needs.
    places: Vec<Index>,
    /// The choices for all operations of the tape.
    choices: Vec<[u8; 2]>,
}

impl ShorterTape {
    /// Returns the steps that are left.
    pub(super) fn steps(&self) -> Steps<'_> {
        let Self { operations, chosen, needed_by, result, .. } = self;
        let extremes = std::slice::from_ref(result);
        Steps { operations, chosen, needed: needed_by, result: result.index, extremes, is_least: false }
    }

    /// Shortens a tape to what is needed on the pieces of `packet`; returns the lanes in which the
    /// formula has a certain sign there.
    #[inline(always)]
    pub(super) fn shorten<N: Lanes>(&mut self, packet: PacketModels<'_>) -> u32 {
        let (tape, lanes) = (packet.tape, packet.lanes);
        let all = tape.steps();
        let steps = Steps { operations: &all.operations[..tape.combining()], ..all };
        let (models, [may_jump, is_undefined]) = PacketModels { steps, ..packet }.models::<N>();
        // In lanes with a jump nothing is left out, because the jump itself matters.
        let (lanes, whole) = (lanes as u8, (lanes & !(may_jump | is_undefined)) as u8);
        let result = self.combine_signs::<N>(tape, models);
        self.needed.clear();
        self.needed.resize(COORDINATES + all.operations.len(), 0);
        self.choices.clear();
        self.choices.resize(all.operations.len(), [0; 2]);
        let certain = (result.positive | result.negative) & whole;
        self.need(tape.result(), lanes & !certain);
        self.choose_by_signs::<N>(tape, models, whole);
        self.choose_by_values::<N>(tape, models, whole);
        self.renumber(tape);
        u32::from(certain)
    }

    /// Computes the signs of the operations that combine signs; returns those of the result.
    #[inline(always)]
    fn combine_signs<N: Lanes>(&mut self, tape: &Tape, models: &[StoredModels]) -> LaneSigns {
        self.signs.clear();
        for &operation in &tape.operations()[tape.combining()..] {
            let [a, b] = operation.operands();
            let (a, b) = (self.signs_at::<N>(tape, models, a), self.signs_at::<N>(tape, models, b));
            self.signs.push(match operation {
                Operation::Binary(Binary::Min, ..) => a.of_minimum(b),
                Operation::Binary(..) => a.negated().of_minimum(b.negated()).negated(),
                Operation::Unary(..) => a.negated(),
            });
        }
        self.signs_at::<N>(tape, models, tape.result())
    }

    #[inline(always)]
    fn signs_at<N: Lanes>(&self, tape: &Tape, models: &[StoredModels], index: Index) -> LaneSigns {
        let combining = usize::from(index).checked_sub(COORDINATES + tape.combining());
        if let Some(&signs) = combining.and_then(|at| self.signs.get(at)) {
            return signs;
        }
        let ([low, high], zero) = (Models::<N>::of_index(tape, models, index).tight_range(), N::splat(0.0));
        let (positive, negative) = (zero.lt(low).bits() as u8, high.lt(zero).bits() as u8);
        LaneSigns { positive, negative, defined: (high - low).lt(N::splat(f32::INFINITY)).bits() as u8 }
    }

    fn need(&mut self, index: Index, lanes: u8) {
        // Constants have no place here.
        if let Some(needed) = self.needed.get_mut(usize::from(index)) {
            *needed |= lanes;
        }
    }

    /// Chooses for operations of which only the sign is needed.
    #[inline(always)]
    fn choose_by_signs<N: Lanes>(&mut self, tape: &Tape, models: &[StoredModels], whole: u8) {
        for at in (tape.combining()..tape.operations().len()).rev() {
            let (operation, needed) = (tape.operations()[at], self.needed[COORDINATES + at]);
            let [a, b] = operation.operands();
            let (mut of_a, mut of_b) = (self.signs_at::<N>(tape, models, a), self.signs_at::<N>(tape, models, b));
            match operation {
                Operation::Unary(..) => {
                    self.need(a, needed);
                    continue;
                }
                Operation::Binary(Binary::Min, ..) => {}
                Operation::Binary(..) => (of_a, of_b) = (of_a.negated(), of_b.negated()),
            }
            let second = (of_a.positive | of_a.defined & of_b.negative) & whole;
            let first = (of_b.positive | of_b.defined & of_a.negative) & whole & !second;
            self.choose(at, operation, [first & needed, second & needed]);
        }
    }

    /// Chooses for operations of which the value is needed.
    #[inline(always)]
    fn choose_by_values<N: Lanes>(&mut self, tape: &Tape, models: &[StoredModels], whole: u8) {
        for at in (0..tape.combining()).rev() {
            let (operation, needed) = (tape.operations()[at], self.needed[COORDINATES + at]);
            if needed == 0 {
                continue;
            }
            let zero = N::splat(0.0);
            let choice = match operation {
                Operation::Unary(Unary::Abs, a) => {
                    let [low, _] = Models::<N>::of_index(tape, models, a).tight_range();
                    [zero.le(low).bits() as u8, 0]
                }
                Operation::Binary(function @ (Binary::Min | Binary::Max), a, b) => {
                    let b = Models::<N>::of_index(tape, models, b).negate();
                    let [low, high] = Models::<N>::of_index(tape, models, a).plus(b).tight_range();
                    let (is_less, is_greater) = (high.le(zero).bits() as u8, zero.le(low).bits() as u8);
                    let second = if function == Binary::Min { is_greater } else { is_less };
                    [(is_less | is_greater) & !second, second]
                }
                _ => [0; 2],
            };
            self.choose(at, operation, choice.map(|lanes| lanes & whole & needed));
        }
    }

    /// Notes the lanes in which an operation is its first operand, those in which it is its second,
    /// and the operands that are needed.
    fn choose(&mut self, at: usize, operation: Operation, [first, second]: [u8; 2]) {
        let (needed, [a, b]) = (self.needed[COORDINATES + at], operation.operands());
        self.choices[at] = [first, second];
        self.need(a, needed & !second);
        self.need(b, needed & !first);
    }

    /// Makes the shorter tape.
    ///
    /// Operations that are one of their operands in all lanes that need them get the index of that operand.
    // Not if the operand is a constant: models of a sum with a constant have other bounds than those of other sums, so
    // the pieces of one lane would depend on the choices of the others.
    fn renumber(&mut self, tape: &Tape) {
        self.operations.clear();
        self.chosen.clear();
        self.needed_by.clear();
        self.places.clear();
        self.places.resize(self.needed.len(), 0);
        for (index, place) in (0..).zip(&mut self.places[..COORDINATES]) {
            *place = index;
        }
        let all = tape.operations().iter().zip(&self.choices).zip(&self.needed[COORDINATES..]);
        for (at, ((&operation, &choice), &needed)) in all.enumerate() {
            if needed == 0 {
                continue;
            }
            let [a, b] = operation.operands();
            self.places[COORDINATES + at] = if choice[0] == needed && tape.constant(a).is_none() {
                place(&self.places, a)
            } else if choice[1] == needed && tape.constant(b).is_none() {
                place(&self.places, b)
            } else {
                self.chosen.push(choice);
                self.needed_by.push(needed);
                self.operations.push(operation.with_operands(|operand| place(&self.places, operand)));
                (COORDINATES + self.operations.len() - 1) as Index
            };
        }
        self.result = Extreme { index: place(&self.places, tape.result()), is_negated: false };
    }
}

/// Returns the new index of a value; constants keep theirs.
fn place(places: &[Index], index: Index) -> Index {
    places.get(usize::from(index)).copied().unwrap_or(index)
}

impl LaneSigns {
    fn negated(self) -> Self {
        Self { positive: self.negative, negative: self.positive, defined: self.defined }
    }

    fn of_minimum(self, other: Self) -> Self {
        let defined = self.defined & other.defined;
        let (positive, negative) = (self.positive & other.positive, (self.negative | other.negative) & defined);
        Self { positive, negative, defined }
    }
}
