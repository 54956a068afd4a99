//! What the CPU at hand can do: eight numbers in one register where it has such.
//!
//! Work over [`Lanes`](crate::lanes::Lanes) is compiled once for each set of instructions, and [`run`] asks the CPU which
//! of them it has. What is on the way has to be inlined (`#[inline(always)]`) down to here: only then is it made of those
//! instructions. None of them is but what IEEE 754 defines to the last bit; none multiplies and adds at once.
//!
//! This module alone has unsafe code.

use crate::lanes::Eight;

pub use crate::lanes::Work;

/// Which numbers work is done with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// Plain arrays: all that the target is sure to have.
    Baseline,
    /// x86-64's registers of 256 bits.
    Avx2,
}

impl Instructions {
    /// The best that this CPU has.
    #[inline]
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi1") && is_x86_feature_detected!("lzcnt") {
            return Self::Avx2;
        }
        Self::Baseline
    }
}

/// Does the work with the best that this CPU has.
#[inline]
pub fn run<W: Work>(work: W) -> W::Output {
    run_with(Instructions::best(), work)
}

/// Does the work with these, or with the baseline where the CPU does not have them.
#[inline]
pub fn run_with<W: Work>(instructions: Instructions, work: W) -> W::Output {
    match instructions {
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx2 if Instructions::best() == Instructions::Avx2 => avx2::run(work),
        _ => work.run::<Eight>(),
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2;
