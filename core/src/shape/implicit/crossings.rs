//! Where rays enter and leave what a formula encloses, for solids.

use super::Implicit;
use crate::formula::{Line, Searches, Solver};
use crate::lanes::{F32x8, LANES, set_bits};
use crate::ray::{EightRays, Interval, Probe};
use std::array::from_fn;

/// The largest number of roots of a formula along a ray that are found in a solid.
// The limit bounds the time of formulas that oscillate faster than any picture can show.
const MAX_ROOTS: usize = 256;

impl Implicit {
    /// Visits the points at which rays enter and leave what the formula encloses, f < 0.
    ///
    /// `visit` is given the lane, the t and whether the ray enters; each lane's points come in ascending order. They
    /// are those in front of the ray with `from <= t`, and up to the first one after `until`. Returns the mask of the
    /// lanes whose rays begin inside. The bounds limit the search, and enclose nothing by themselves.
    ///
    /// Where the sign changes at a jump there is a point, too, although it is no root. Undefined values are outside. Of
    /// several jumps between two roots one is found, or none if they are even in number.
    pub(in crate::shape) fn enter_and_leave(
        &self,
        rays: &EightRays,
        from: &F32x8,
        until: &F32x8,
        mut visit: impl FnMut(usize, f32, bool),
    ) -> u32 {
        let mut searches = Searches { until: *until, ..Searches::NONE };
        let lines: [Line; LANES] = from_fn(|lane| self.line_of_ray(&rays.ray(lane)));
        for lane in set_bits(rays.active) {
            let Interval { min, max } =
                self.within_bounds(&lines[lane], self.0.bounds_in_scene.crossed(&Probe::new(rays.ray(lane))));
            let min = min.max(from.0[lane]).max(0.0);
            if min <= max && min <= until.0[lane] {
                searches.add(lane, &lines[lane], [min, max], until.0[lane]);
            }
        }
        let starts_inside = |lane: &usize| self.is_inside_at(&lines[*lane], searches.ranges[0].0[*lane]);
        let begins_inside = set_bits(searches.lanes).filter(starts_inside).fold(0, |lanes, lane| lanes | 1 << lane);
        let (mut inside, solver) = (begins_inside, Solver::new(&self.0.formula));
        for _ in 0..MAX_ROOTS {
            let (found, roots) = solver.first_roots(&searches);
            for lane in set_bits(searches.lanes) {
                let (line, start, is_inside) = (&lines[lane], searches.ranges[0].0[lane], inside >> lane & 1 != 0);
                let is_root = found >> lane & 1 != 0;
                // In front of a root, or of the end of the range, the ray is where it was after the last one, unless
                // the sign has changed at a jump.
                let end = if is_root { roots.0[lane].next_down() } else { searches.ranges[1].0[lane] };
                let end = end.min(until.0[lane]);
                let jumps = end > start && self.is_inside_at(line, end) != is_inside;
                if jumps {
                    visit(lane, self.change(line, [start, end], is_inside), !is_inside);
                    inside ^= 1 << lane;
                }
                if is_root {
                    visit(lane, roots.0[lane], is_inside == jumps);
                    inside ^= 1 << lane;
                    searches.ranges[0].0[lane] = roots.0[lane];
                }
            }
            searches.lanes = found;
            if found == 0 {
                break;
            }
        }
        begins_inside
    }

    /// Returns whether f is negative at a point of a line, or zero and about to be.
    fn is_inside_at(&self, line: &Line, t: f32) -> bool {
        let at = line.origin + line.direction * f64::from(t);
        let value = self.0.formula.value(at);
        value < 0.0 || value == 0.0 && self.0.formula.gradient(at).1.dot(line.direction) < 0.0
    }

    /// Returns a t at which a line changes between inside and outside, found by bisection.
    fn change(&self, line: &Line, [mut start, mut end]: [f32; 2], is_inside_at_start: bool) -> f32 {
        loop {
            let middle = start + 0.5 * (end - start);
            if middle <= start || middle >= end {
                return end;
            }
            if self.is_inside_at(line, middle) == is_inside_at_start {
                start = middle;
            } else {
                end = middle;
            }
        }
    }
}
