//! The roots of the formulas in a solid, along up to eight rays.

use super::Solid;
use crate::lanes::F32x8;
use crate::ray::EightRays;
use crate::shape::Implicit;

/// Where up to eight rays enter and leave what formulas enclose.
///
/// The rays are searched together: the solver takes eight lines at once for about the price of one.
#[derive(Debug, Default)]
pub(super) struct FormulaRoots {
    formulas: Vec<FormulaInside>,
    roots: Vec<FormulaRoot>,
}

/// The lanes whose rays begin inside what a formula encloses.
#[derive(Clone, Copy, Debug)]
struct FormulaInside {
    shape: u8,
    lanes: u32,
}

/// A point at which a ray enters or leaves what a formula encloses.
#[derive(Clone, Copy, Debug)]
struct FormulaRoot {
    /// The number of the formula among the shapes of the solid.
    shape: u8,
    lane: u8,
    enters: bool,
    t: f32,
}

impl FormulaRoots {
    /// Finds the roots of all formulas in a solid, with `from <= t` and up to the first one after
    /// `until`.
    pub(super) fn of(solid: &Solid, rays: &EightRays, from: &F32x8, until: &F32x8) -> Self {
        let mut found = Self::default();
        if solid.has_formulas {
            solid.visit_formulas(0, &mut |shape, formula: &Implicit| {
                let lanes = formula.enter_and_leave(rays, from, until, |lane, t, enters| {
                    found.roots.push(FormulaRoot { shape, lane: lane as u8, enters, t });
                });
                found.formulas.push(FormulaInside { shape, lanes });
            });
        }
        found
    }

    /// Returns whether the ray of a lane begins inside what a formula encloses.
    pub(super) fn begins_inside(&self, shape: u8, lane: usize) -> bool {
        self.formulas.iter().any(|formula| formula.shape == shape && formula.lanes >> lane & 1 != 0)
    }

    /// Returns the roots of a formula along the ray of a lane, in ascending order, and whether the
    /// ray enters there.
    pub(super) fn of_lane(&self, shape: u8, lane: usize) -> impl Iterator<Item = (f32, bool)> {
        let is_of_lane = move |root: &&FormulaRoot| root.shape == shape && usize::from(root.lane) == lane;
        self.roots.iter().filter(is_of_lane).map(|root| (root.t, root.enters))
    }
}
