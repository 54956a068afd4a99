//! Materials: how much of the light that arrives is reflected.
//!
//! All of them reflect diffusely (lecture, "Shading", assumption 3): equally in all directions, so that a point has
//! the same colour from every viewpoint.

use crate::color::LinearRgb;
use crate::lanes::Number;

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

impl Material {
    /// What an object is made of when nothing is said: a light grey.
    pub const DEFAULT: Self = Self::Diffuse(Self::DEFAULT_REFLECTANCE);

    /// That of [`DEFAULT`](Self::DEFAULT).
    pub const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

    /// The diffuse reflectances of red, green and blue where a pattern has the coordinates `uv`, and what is seen at once
    /// reaches over so much of them: zero for a point alone. Of what is [`Own`](Self::Own) those of who has none.
    #[inline(always)]
    pub fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
        let bands = |LinearRgb { r, g, b }: LinearRgb| [N::splat(r), N::splat(g), N::splat(b)];
        match *self {
            Self::Diffuse(reflectance) => bands(reflectance),
            Self::Own => bands(Self::DEFAULT_REFLECTANCE),
            Self::Checker { a, b, size } => {
                let size = N::splat(size);
                let balance =
                    mean_sign(uv[0] / size, footprint[0] / size) * mean_sign(uv[1] / size, footprint[1] / size);
                let half = N::splat(0.5);
                let [of_a, of_b] = [half + half * balance, half - half * balance];
                let ([r0, g0, b0], [r1, g1, b1]) = (bands(a), bands(b));
                [r0 * of_a + r1 * of_b, g0 * of_a + g1 * of_b, b0 * of_a + b1 * of_b]
            }
        }
    }
}

/// The mean over an interval of what is 1 from each even whole number to the next, and -1 in between. So a pattern too
/// fine for its pixels turns grey, instead of into another one (a box filter; in a plane that is the product of the two
/// axes' means).
#[inline(always)]
fn mean_sign<N: Number>(middle: N, width: N) -> N {
    let (zero, one, half) = (N::splat(0.0), N::splat(1.0), N::splat(0.5) * width);
    let (start, end) = (middle - half, middle + half);
    let (first, last) = (start.floor(), end.floor());
    let sign = N::select(is_even(first), one, -one);
    // Over one edge: what lies before it less what lies behind it.
    let over_one = sign * ((last - start) - (end - last)) / (end - start);
    let over_more = (integrated_sign(end) - integrated_sign(start)) / (end - start);
    let over_edges = N::select((last - first).same(one), over_one, over_more);
    let mean = N::select(first.same(last), sign, over_edges);
    // Beyond, the mean is as good as zero, and intervals may be infinite, or not a number.
    N::select(width.lt(N::splat(1e6)), mean, zero)
}

/// The integral of that sign from 0: up and down again.
#[inline(always)]
fn integrated_sign<N: Number>(x: N) -> N {
    let (one, two) = (N::splat(1.0), N::splat(2.0));
    let in_period = x - two * (N::splat(0.5) * x).floor();
    one - (in_period - one).abs()
}

/// For whole numbers of any size; those above 2^24 are all even in f32.
#[inline(always)]
fn is_even<N: Number>(whole: N) -> N::Mask {
    let half = whole * N::splat(0.5);
    half.floor().same(half)
}
