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
        self.accept(written.span, checks::light_amount(what, written.value))
    }

    /// Checks a colour of light, whose channels may exceed 1.
    pub(crate) fn light_color(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        self.color(written, checks::light)
    }

    /// Checks the colour and the intensity of a light, by default white and 1, and returns their
    /// product.
    pub(crate) fn intensity(
        &mut self,
        color: Option<WrittenColor>,
        factor: Option<WrittenNumber>,
    ) -> Option<LinearRgb> {
        let color = color.map_or(Some(LinearRgb::grey(1.0)), |color| self.light_color(color));
        let factor = factor.map_or(Some(1.0), |factor| self.amount("the intensity", factor));
        Some(color? * factor?)
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

    /// Checks that two points are apart, and returns the axis from the first to the second.
    pub(crate) fn axis(&mut self, ends: [Option<WrittenVector>; 2]) -> Option<Axis> {
        let [from, to] = ends.map(|end| self.coordinates(end?));
        let (from, to, span) = (from?, to?, ends[1]?.span);
        let length = (to - from).length();
        let length = self.accept(span, checks::distance("from", "to", length))?;
        Some(Axis { middle: (from + to) * 0.5, direction: (to - from) / length, half_length: 0.5 * length })
    }

    /// Returns a vector scaled to unit length, in f64, so that the caller rounds only once; `what`
    /// is its name for messages.
    pub(crate) fn unit_vector(&mut self, what: &str, written: WrittenVector) -> Option<DVec3> {
        let vector = self.coordinates(written)?;
        self.accept(written.span, checks::unit_vector(what, vector))
    }
}

/// The axis of a shape that is given by two end points: its middle, direction and half length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The point in the middle.
    pub middle: DVec3,
    /// The direction from the first point to the second. Unit length.
    pub direction: DVec3,
    /// Half the distance between both points.
    pub half_length: f64,
}

impl Axis {
    /// Returns both ends, relative to the middle.
    pub(crate) fn end_offsets(&self) -> [DVec3; 2] {
        [self.direction * -self.half_length, self.direction * self.half_length]
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
