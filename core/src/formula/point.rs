//! Values and gradients of a formula at a point, in f64.

use super::Formula;
use super::elementary;
use super::operation::{Binary, COORDINATES, Index, Operation, Unary};
use super::tape::Tape;
use glam::DVec3;

impl Unary {
    /// Returns the value of the function; NaN where it is undefined.
    pub(super) fn at(self, a: f64) -> f64 {
        match self {
            Self::Negate => -a,
            Self::Abs => a.abs(),
            Self::Square => a * a,
            Self::Sqrt | Self::SqrtOfNonNegative => a.sqrt(),
            Self::Cbrt => libm::cbrt(a),
            Self::Exp => elementary::exp(a),
            Self::Ln => libm::log(a),
            Self::Sin => elementary::sin(a),
            Self::Cos => elementary::cos(a),
            Self::Tan => libm::tan(a),
            Self::Asin => libm::asin(a),
            Self::Atan => libm::atan(a),
            Self::Floor => libm::floor(a),
            Self::Step if a.is_nan() => a,
            Self::Step => f64::from(u8::from(a >= 0.0)),
        }
    }

    /// Returns the derivative at `a`, where the function has the value `value`.
    fn slope(self, a: f64, value: f64) -> f64 {
        match self {
            Self::Negate => -1.0,
            Self::Abs => 1.0_f64.copysign(a),
            Self::Square => 2.0 * a,
            Self::Sqrt | Self::SqrtOfNonNegative => 0.5 / value,
            Self::Cbrt => 1.0 / (3.0 * value * value),
            Self::Exp => value,
            Self::Ln => 1.0 / a,
            Self::Sin => elementary::cos(a),
            Self::Cos => -elementary::sin(a),
            Self::Tan => 1.0 + value * value,
            Self::Asin => 1.0 / (1.0 - a * a).sqrt(),
            Self::Atan => 1.0 / (1.0 + a * a),
            Self::Floor | Self::Step => 0.0,
        }
    }
}

impl Binary {
    /// Returns the value of the function; NaN where it or an operand is undefined.
    #[inline(always)]
    pub(super) fn at(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            // Unlike `f64::min` and `max`, a NaN of either operand stays.
            Self::Min if a.is_nan() || a < b => a,
            Self::Max if a.is_nan() || a > b => a,
            Self::Min | Self::Max => b,
            Self::Atan2 => libm::atan2(a, b),
        }
    }

    /// Returns the derivatives by both operands.
    fn slopes(self, a: f64, b: f64) -> [f64; 2] {
        match self {
            Self::Add => [1.0, 1.0],
            Self::Subtract => [1.0, -1.0],
            Self::Multiply => [b, a],
            Self::Divide => [1.0 / b, -a / (b * b)],
            Self::Min => {
                if a < b {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
            Self::Max => {
                if a > b {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
            Self::Atan2 => {
                let squared = a * a + b * b;
                [b / squared, -a / squared]
            }
        }
    }
}

impl Tape {
    /// Returns the value at a point. `values` is scratch memory.
    pub(super) fn value(&self, point: DVec3, values: &mut Vec<f64>) -> f64 {
        let [x, y, z] = point.to_array();
        values.clear();
        values.extend([x, y, z, f64::NAN]);
        for &operation in self.operations() {
            let of = |index: Index| self.constant(index).unwrap_or_else(|| values[usize::from(index)]);
            let value = match operation {
                Operation::Unary(function, a) => function.at(of(a)),
                Operation::Binary(function, a, b) => function.at(of(a), of(b)),
            };
            values.push(value);
        }
        self.constant(self.result()).unwrap_or_else(|| values[usize::from(self.result())])
    }
}

impl Formula {
    /// Returns f at a point; NaN where it is undefined.
    pub(crate) fn value(&self, point: DVec3) -> f64 {
        self.tape.value(point, &mut Vec::new())
    }

    /// Returns f and its gradient at a point, by forward differentiation.
    pub(crate) fn gradient(&self, point: DVec3) -> (f64, DVec3) {
        let tape = &self.tape;
        let mut values: Vec<(f64, DVec3)> = Vec::with_capacity(COORDINATES + tape.operations().len());
        values.extend(point.to_array().into_iter().zip(DVec3::AXES));
        values.push((f64::NAN, DVec3::ZERO));
        let of = |values: &[(f64, DVec3)], index: Index| match tape.constant(index) {
            Some(value) => (value, DVec3::ZERO),
            None => values[usize::from(index)],
        };
        for &operation in tape.operations() {
            let value = match operation {
                Operation::Unary(function, a) => {
                    let (a, slope) = of(&values, a);
                    let value = function.at(a);
                    (value, scaled(slope, function.slope(a, value)))
                }
                Operation::Binary(function, a, b) => {
                    let ((a, slope_a), (b, slope_b)) = (of(&values, a), of(&values, b));
                    let [by_a, by_b] = function.slopes(a, b);
                    (function.at(a, b), scaled(slope_a, by_a) + scaled(slope_b, by_b))
                }
            };
            values.push(value);
        }
        of(&values, tape.result())
    }
}

/// Returns the product; a zero vector stays zero even if the factor is infinite.
// The slope of a root at 0 is infinite: times a zero vector, it would make the whole gradient NaN, as of x + sqrt(y^2)
// at y = 0.
fn scaled(vector: DVec3, factor: f64) -> DVec3 {
    if vector == DVec3::ZERO { vector } else { vector * factor }
}
