//! Checks of a whole formula: whether it can have a surface inside a box.

use super::Formula;
use super::model::Model;
use glam::DVec3;

/// The largest number of boxes that are examined.
// The limit bounds the time that loading a scene takes.
const MAX_BOXES: usize = 1024;

/// The largest number of times that the sides of a box are halved.
const MAX_DEPTH: u32 = 6;

impl Formula {
    /// Returns why the formula certainly has no surface inside a box; `None` if it may have one.
    pub(crate) fn lack_of_surface(&self, min: DVec3, max: DVec3) -> Option<&'static str> {
        // This check is only for formulas that do not depend on the time: others may have a zero at another time.
        if !self.moves() && self.has_no_zero(min, max) {
            return Some("f has no zero inside the bounds: nothing is seen");
        }
        let tape = self.moving.as_deref().unwrap_or(&self.tape);
        match tape.known_signs() {
            [true, _] => Some("f is never negative: without a change of its sign there is no surface"),
            [_, true] => Some("f is never positive: without a change of its sign there is no surface"),
            _ => None,
        }
    }

    /// Returns whether enclosures show that f has the same sign in the whole box.
    fn has_no_zero(&self, min: DVec3, max: DVec3) -> bool {
        let (mut models, mut values, mut signs) = (Vec::new(), Vec::new(), [false; 2]);
        let mut boxes = vec![(min, max, 0)];
        let mut examined = 0;
        while let Some((min, max, depth)) = boxes.pop() {
            examined += 1;
            let value = self.tape.value(0.5 * (min + max), &mut values);
            signs = [signs[0] || value < 0.0, signs[1] || value > 0.0];
            // With both signs in the box f mostly has a zero between them; that it only jumps there is not certain.
            if signs == [true; 2] || value == 0.0 {
                return false;
            }
            let between = [0, 1, 2].map(|axis| Model::anything_between(min[axis], max[axis]));
            let (model, continuity) = self.tape.model(between, &mut models);
            if continuity.is_undefined || model.c[0].abs() - model.c[1].abs() - model.c[2].abs() > model.error {
                continue;
            }
            if depth == MAX_DEPTH || examined + boxes.len() + 8 > MAX_BOXES {
                return false;
            }
            let middle = 0.5 * (min + max);
            boxes.extend((0..8).map(|corner| {
                let upper = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
                let pick = |axis: usize| {
                    if upper[axis] { [middle[axis], max[axis]] } else { [min[axis], middle[axis]] }
                };
                let [x, y, z] = [pick(0), pick(1), pick(2)];
                (DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]), depth + 1)
            }));
        }
        true
    }
}
