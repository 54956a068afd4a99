//! What is asked of every number that a scene file has, with its place there. The rules are those of [`checks`].

use super::{WrittenColor, WrittenNumber, WrittenVector};
use crate::checks::{self, Message};
use crate::color::LinearRgb;
use crate::scene_text::{Faults, Span};
use glam::{DVec3, Vec3};

/// Checks values, and notes what is wrong with them.
pub struct Validator<'f> {
    pub(crate) faults: &'f mut Faults,
}

impl Validator<'_> {
    pub(crate) fn fault<T>(&mut self, span: Span, message: impl FnOnce() -> String) -> Option<T> {
        self.faults.add(span, message);
        None
    }

    /// Returns what a rule of [`checks`] let pass; else notes its message.
    pub(crate) fn take<T>(&mut self, span: Span, checked: Result<T, Message>) -> Option<T> {
        match checked {
            Ok(value) => Some(value),
            Err(message) => self.fault(span, || message.into_owned()),
        }
    }

    /// All three coordinates within what f32 can carry through a picture.
    pub(crate) fn coordinates(&mut self, written: WrittenVector) -> Option<DVec3> {
        let near = written.components.map(|number| self.take(number.span, checks::coordinate(number.value)).is_some());
        (near == [true; 3]).then(|| DVec3::from_array(written.components.map(|component| component.value)))
    }

    pub(crate) fn point(&mut self, written: WrittenVector) -> Option<Vec3> {
        Some(self.coordinates(written)?.as_vec3())
    }

    /// A length greater than 0 that f32 can square.
    pub(crate) fn length(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        self.take(written.span, checks::length(what, written.value))
    }

    /// An amount of light.
    pub(crate) fn amount(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        self.take(written.span, checks::amount(what, written.value))
    }

    /// A colour of light: any amount.
    pub(crate) fn light_color(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        self.color(written, checks::light)
    }

    /// A colour of a surface: a part of the light.
    pub(crate) fn reflectance(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        self.color(written, checks::reflectance)
    }

    fn color(&mut self, written: WrittenColor, rule: fn(f64) -> Result<f32, Message>) -> Option<LinearRgb> {
        for band in written.numbers() {
            self.take(band.span, rule(band.value))?;
        }
        Some(linear(written))
    }

    /// The direction, of unit length: of f64's, so that nothing is lost before the one rounding.
    pub(crate) fn unit_vector(&mut self, what: &str, written: WrittenVector) -> Option<DVec3> {
        let vector = self.coordinates(written)?;
        self.take(written.span, checks::unit_vector(what, vector))
    }
}

/// A colour as light.
fn linear(written: WrittenColor) -> LinearRgb {
    match written {
        WrittenColor::Srgb(color) => LinearRgb::from_srgb8(color),
        WrittenColor::Linear([r, g, b]) => LinearRgb::new(r.value as f32, g.value as f32, b.value as f32),
        WrittenColor::Grey(amount) => LinearRgb::grey(amount.value as f32),
    }
}
