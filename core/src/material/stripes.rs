//! A striped material for tests, which shows that a new material takes one file and one line in the
//! table `materials`.

use super::{Reflecting, channels};
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor};

/// Stripes of width 1 across the first surface coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripes {
    /// The reflectance of the stripe that starts at the pattern's origin.
    pub a: LinearRgb,
    /// The reflectance of the stripes next to one of reflectance `a`.
    pub b: LinearRgb,
}

impl Reflecting for Stripes {
    const PATTERN: Option<&'static str> = Some("its stripes");

    #[inline(always)]
    fn reflectance<N: Number>(&self, [u, _]: [N; 2], _: [N; 2]) -> [N; 3] {
        let half = N::splat(0.5) * u.floor();
        let is_even = half.floor().eq(half);
        let ([r0, g0, b0], [r1, g1, b1]) = (channels::<N>(self.a), channels::<N>(self.b));
        [N::select(is_even, r0, r1), N::select(is_even, g0, g1), N::select(is_even, b0, b1)]
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} and {} striped", name(self.a), name(self.b))
    }

    fn check(written: &[Option<WrittenColor>; 2], validator: &mut Validator<'_>) -> Option<Self> {
        let [a, b] = written.map(|color| color.and_then(|color| validator.reflectance(color)));
        Some(Self { a: a?, b: b? })
    }
}

impl InSceneFile for Stripes {
    type Written = [Option<WrittenColor>; 2];

    const NAME: &'static str = "Stripes";
    const OWNER: &'static str = "Stripes";
    const FORM: &'static str = "Stripes(a: ..., b: ...)";
    const FIELDS: &'static [&'static str] = &["a", "b"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> [Option<WrittenColor>; 2] {
        ["a", "b"].map(|name| reader.required(fields, name, NodeReader::color))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
