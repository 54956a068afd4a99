//! The checks of values in scene files by the rules of [`checks`], which report spans.

use super::{WrittenColor, WrittenNumber, WrittenVector};
use crate::checks::{self, Message};
use crate::color::LinearRgb;
use crate::scene_text::{Faults, Span};
use glam::{DVec3, Vec3};

/// A checker of written values that reports faults.
pub struct Validator<'f> {
    pub(crate) faults: &'f mut Faults,
}

impl Validator<'_> {
    pub(crate) fn fault<T>(&mut self, span: Span, message: impl FnOnce() -> String) -> Option<T> {
        self.faults.add(span, message);
        None
    }

    /// Returns the value of `checked`, the result of a rule of [`checks`], or reports its message
    /// at `span`.
    pub(crate) fn accept<T>(&mut self, span: Span, checked: Result<T, Message>) -> Option<T> {
        match checked {
            Ok(value) => Some(value),
            Err(message) => self.fault(span, || message.into_owned()),
        }
    }

    /// Checks that all three coordinates are within the range that rays can be traced in.
    pub(crate) fn coordinates(&mut self, written: WrittenVector) -> Option<DVec3> {
        // Checks all three coordinates before a fault ends the function, so that each fault is reported.
        let near =
            written.components.map(|number| self.accept(number.span, checks::coordinate(number.value)).is_some());
        (near == [true; 3]).then(|| DVec3::from_array(written.components.map(|component| component.value)))
    }

    pub(crate) fn point(&mut self, written: WrittenVector) -> Option<Vec3> {
        Some(self.coordinates(written)?.as_vec3())
    }

    /// Checks that a length is positive and can be squared twice in f32; `what` is its name for
    /// messages.
    pub(crate) fn length(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        self.accept(written.span, checks::length(what, written.value))
    }

    /// Checks an amount of light; `what` is its name for messages.
    pub(crate) fn amount(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        self.accept(written.span, checks::amount(what, written.value))
    }

    /// Checks a colour of light, whose channels may exceed 1.
    pub(crate) fn light_color(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        self.color(written, checks::light)
    }

    /// Checks a reflectance, whose channels are from 0 to 1.
    pub(crate) fn reflectance(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        self.color(written, checks::reflectance)
    }

    fn color(&mut self, written: WrittenColor, rule: fn(f64) -> Result<f32, Message>) -> Option<LinearRgb> {
        for channel in written.numbers() {
            self.accept(channel.span, rule(channel.value))?;
        }
        Some(to_linear(written))
    }

    /// Returns a vector scaled to unit length, in f64, so that the caller rounds only once; `what`
    /// is its name for messages.
    pub(crate) fn unit_vector(&mut self, what: &str, written: WrittenVector) -> Option<DVec3> {
        let vector = self.coordinates(written)?;
        self.accept(written.span, checks::unit_vector(what, vector))
    }
}

/// Converts a colour as written to linear light.
fn to_linear(written: WrittenColor) -> LinearRgb {
    match written {
        WrittenColor::Srgb(color) => LinearRgb::from_srgb8(color),
        WrittenColor::Linear([r, g, b]) => LinearRgb::new(r.value as f32, g.value as f32, b.value as f32),
        WrittenColor::Grey(amount) => LinearRgb::grey(amount.value as f32),
    }
}
