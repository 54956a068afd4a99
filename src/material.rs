//! Materials: how much of the light that arrives is reflected.
//!
//! All of them reflect diffusely (lecture, "Shading", assumption 3): equally in all directions, so that a point has
//! the same colour from every viewpoint.

use crate::color::LinearRgb;
use crate::shape::SurfacePoint;

/// A diffuse surface, plain or patterned. Reflectances are linear, each band in 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// The same reflectance everywhere.
    Diffuse(LinearRgb),
    /// What the surface brings itself: the colours and textures of a mesh's file; where there are none, as
    /// [`DEFAULT`](Self::DEFAULT).
    Own,
    /// Squares of two reflectances in turn, laid out on the surface's own coordinates (of a plane).
    Checker {
        /// Reflectance of the square that begins at the pattern's origin, and of every second one from there.
        a: LinearRgb,
        /// Reflectance of the others.
        b: LinearRgb,
        /// A square's side in world units, greater than 0.
        size: f32,
    },
}

const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

impl Material {
    /// What an object is made of when nothing is said: a light grey.
    pub const DEFAULT: Self = Self::Diffuse(DEFAULT_REFLECTANCE);

    /// The diffuse reflectance at a point of the surface.
    pub fn reflectance(&self, point: &SurfacePoint) -> LinearRgb {
        match *self {
            Self::Diffuse(reflectance) => reflectance,
            Self::Own => point.own_reflectance.unwrap_or(DEFAULT_REFLECTANCE),
            Self::Checker { a, b, size } => {
                let (middle, width) = (point.uv / size, point.footprint / size);
                let balance = mean_sign(middle.x, width.x) * mean_sign(middle.y, width.y);
                a * (0.5 + 0.5 * balance) + b * (0.5 - 0.5 * balance)
            }
        }
    }
}

/// The mean over an interval of what is 1 from each even whole number to the next, and -1 in between. So a pattern too
/// fine for its pixels turns grey, instead of into another one (a box filter; in a plane that is the product of the two
/// axes' means).
fn mean_sign(middle: f32, width: f32) -> f32 {
    // Beyond, the mean is as good as zero, and intervals may be infinite. (The negation turns NaN away too.)
    if !(width < 1e6) {
        return 0.0;
    }
    let (start, end) = (middle - 0.5 * width, middle + 0.5 * width);
    let (first, last) = (start.floor(), end.floor());
    let sign = if is_even(first) { 1.0 } else { -1.0 };
    if first == last {
        sign
    } else if last - first == 1.0 {
        // Over one edge: what lies before it less what lies behind it.
        sign * ((last - start) - (end - last)) / (end - start)
    } else {
        (integrated_sign(end) - integrated_sign(start)) / (end - start)
    }
}

/// The integral of that sign from 0: up and down again.
fn integrated_sign(x: f32) -> f32 {
    let in_period = x - 2.0 * (0.5 * x).floor();
    1.0 - (in_period - 1.0).abs()
}

/// For whole numbers of any size; those above 2^24 are all even in f32.
fn is_even(whole: f32) -> bool {
    let half = whole * 0.5;
    half.floor() == half
}
