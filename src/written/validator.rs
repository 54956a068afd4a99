//! What is asked of every number, wherever it is written.

use super::{Spanned, WrittenColor, WrittenNumber, WrittenVector};
use crate::color::LinearRgb;
use crate::scene_text::{Faults, Span};
use glam::{DVec3, Vec3};

/// Coordinates beyond this, squared twice on the light's way, would leave f32.
pub(crate) const FARTHEST: f64 = 1e9;
/// Lengths below this would vanish in f32 when squared twice.
pub(crate) const SHORTEST: f64 = 1e-9;
const BRIGHTEST: f64 = 1e12;

/// Checks values, and notes what is wrong with them.
pub struct Validator<'f> {
    pub(crate) faults: &'f mut Faults,
}

impl Validator<'_> {
    pub(crate) fn fault<T>(&mut self, span: Span, message: impl FnOnce() -> String) -> Option<T> {
        self.faults.add(span, message);
        None
    }

    /// All three coordinates within what f32 can carry through a picture.
    pub(crate) fn coordinates(&mut self, written: WrittenVector) -> Option<DVec3> {
        let mut fine = true;
        for component in written.components {
            if component.value.abs() > FARTHEST {
                fine = false;
                self.faults.add(component.span, || {
                    "coordinates must lie within ±1e9; light cannot be followed farther in single precision".to_owned()
                });
            }
        }
        fine.then(|| DVec3::from_array(written.components.map(|component| component.value)))
    }

    pub(crate) fn point(&mut self, written: WrittenVector) -> Option<Vec3> {
        Some(self.coordinates(written)?.as_vec3())
    }

    /// A length greater than 0 that f32 can square.
    pub(crate) fn length(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value <= 0.0 {
            return self.fault(span, || format!("the {what} must be greater than 0"));
        }
        if !(SHORTEST..=FARTHEST).contains(&value) {
            return self.fault(span, || format!("the {what} must lie between 1e-9 and 1e9"));
        }
        Some(value as f32)
    }

    /// An amount of light.
    pub(crate) fn amount(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value < 0.0 {
            return self.fault(span, || format!("{what} must not be negative"));
        }
        if value > BRIGHTEST {
            return self.fault(span, || format!("{what} must be at most 1e12"));
        }
        Some(value as f32)
    }

    /// A colour of light: any amount.
    pub(crate) fn light_color(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        if let Some(span) = written.first_band(|band| band < 0.0) {
            return self.fault(span, || "light must not be negative".to_owned());
        }
        if let Some(span) = written.first_band(|band| band > BRIGHTEST) {
            return self.fault(span, || "light must be at most 1e12".to_owned());
        }
        Some(linear(written))
    }

    /// A colour of a surface: a part of the light.
    pub(crate) fn reflectance(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        match written.first_band(|band| !(0.0..=1.0).contains(&band)) {
            Some(span) => self.fault(span, || {
                "a reflectance must lie within 0 and 1; no surface reflects more light than it gets".to_owned()
            }),
            None => Some(linear(written)),
        }
    }

    /// The direction, of unit length: of f64's, so that nothing is lost before the one rounding.
    pub(crate) fn unit_vector(&mut self, what: &str, written: WrittenVector) -> Option<DVec3> {
        let vector = self.coordinates(written)?;
        let largest = vector.abs().max_element();
        if largest == 0.0 {
            return self.fault(written.span, || format!("the {what} must have a length; (0, 0, 0) points nowhere"));
        }
        let vector = vector / largest;
        Some(vector / vector.dot(vector).sqrt())
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
