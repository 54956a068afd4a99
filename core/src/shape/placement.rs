//! Shapes scaled, rotated and moved.

use super::Shape;
use crate::bounds::Bounds;
use crate::checks::{self, SceneFault};
use crate::formula::Line;
use crate::ray::Ray;
use crate::scene_text::{SyntaxNode, Value};
use crate::written::{Fields, NodeReader, Validator, WrittenVector};
use glam::{DMat3, DVec3, Mat3, Vec3};

/// A scale along the axes, then a rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The factors along the axes, none of which is 0.
    pub(super) scale: DVec3,
    pub(super) turn: DMat3,
    pub(super) translation: DVec3,
}

impl Placement {
    /// The placement that changes nothing.
    pub(crate) const NONE: Self = Self { scale: DVec3::ONE, turn: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// Returns the placement with these factors, angles about x, then y, then z, and translation.
    ///
    /// ```
    /// use termtrace::internals::shape::Placement;
    /// use termtrace::{Shape, Sphere, glam::{DVec3, Vec3}};
    ///
    /// let flat = Placement::new(DVec3::new(1.0, 0.25, 1.0), DVec3::ZERO, DVec3::Y)?;
    /// let lens = Shape::from(Sphere::new(Vec3::ZERO, 1.0)?).placed(&flat)?;
    /// assert_eq!(lens.described("red"), "a red ellipsoid, 2 wide, 0.5 high, 2 deep");
    ///
    /// let error = Placement::new(DVec3::ZERO, DVec3::ZERO, DVec3::Y).unwrap_err();
    /// assert_eq!(error.to_string(), "scale is 0: a factor must lie between 1e-9 and 1e9, or be as far below 0");
    /// # Ok::<(), termtrace::SceneFault>(())
    /// ```
    ///
    /// # Errors
    /// If a factor, an angle or a coordinate is one that no scene file may have.
    pub fn new(scale: DVec3, degrees: DVec3, translation: DVec3) -> Result<Self, SceneFault> {
        let fault = |name, value: f64, message| SceneFault::new(format!("{name} is {value}"), message);
        for axis in 0..3 {
            checks::nonzero_factor(scale[axis]).map_err(|message| fault("scale", scale[axis], message))?;
            checks::angle_in_degrees(degrees[axis]).map_err(|message| fault("rotation", degrees[axis], message))?;
            let coordinate = translation[axis];
            checks::coordinate(coordinate).map_err(|message| fault("translation", coordinate, message))?;
        }
        Ok(Self { scale, turn: rotation(degrees.to_array()), translation })
    }

    /// Returns the factor of all lengths, if it is the same in all directions.
    pub(super) fn uniform_scale(&self) -> Option<f64> {
        let DVec3 { x, y, z } = self.scale.abs();
        (x == y && y == z).then_some(x)
    }

    /// Returns the rotation from the scene to a ball under the placement, which may also mirror it.
    pub(crate) fn turn_of_ball(&self) -> Mat3 {
        (DMat3::from_diagonal(self.scale.signum()) * self.turn.transpose()).as_mat3()
    }

    /// Returns the affine map.
    pub(super) fn map(&self) -> AffineMap {
        let Self { scale, turn, translation } = *self;
        AffineMap {
            linear: turn * DMat3::from_diagonal(scale),
            // The inverse of a rotation is its transpose.
            inverse: DMat3::from_diagonal(scale.recip()) * turn.transpose(),
            translation,
        }
    }
}

/// A shape that can be placed.
pub(super) trait Placeable {
    /// Returns the shape scaled, rotated and moved; `None` if a number exceeds the range of f32.
    fn placed(self, placement: &Placement) -> Option<Shape>;

    /// Returns whether rays are mapped to the coordinates of the shape.
    fn has_map(&self) -> bool {
        false
    }
}

/// A map from the coordinates of a shape to those of the scene, and its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AffineMap {
    linear: DMat3,
    inverse: DMat3,
    translation: DVec3,
}

impl AffineMap {
    /// The map that maps everything to the origin, for a shape that is nowhere.
    pub(super) const NOWHERE: Self = Self { linear: DMat3::ZERO, inverse: DMat3::ZERO, translation: DVec3::ZERO };

    /// Returns the map with this linear part, whose determinant is not 0.
    pub(super) fn new(linear: DMat3, translation: DVec3) -> Self {
        Self { linear, inverse: linear.inverse(), translation }
    }

    /// Returns whether all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.linear.is_finite() && self.inverse.is_finite() && self.translation.is_finite()
    }

    /// Returns the map that applies this map, then another one.
    pub(super) fn then(&self, outer: &Self) -> Self {
        Self {
            linear: outer.linear * self.linear,
            inverse: self.inverse * outer.inverse,
            translation: outer.point(self.translation),
        }
    }

    /// Maps a point of the shape to the scene.
    pub(super) fn point(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.translation
    }

    /// Maps a normal of the shape to the scene, or a vector that is used only in dot products.
    pub(super) fn normal(&self, normal: DVec3) -> DVec3 {
        self.inverse.transpose() * normal
    }

    /// Maps a point of the scene to the shape.
    #[inline]
    pub(super) fn shape_point(&self, point: DVec3) -> DVec3 {
        self.inverse * (point - self.translation)
    }

    /// Maps a line of the scene to the shape; each t stays that of the same point.
    #[inline]
    pub(super) fn shape_line(&self, Line { origin, direction }: &Line) -> Line {
        Line { origin: self.shape_point(*origin), direction: self.inverse * *direction }
    }

    /// Maps a ray of the scene to the shape, in single precision.
    pub(super) fn shape_ray(&self, ray: &Ray) -> Ray {
        let Line { origin, direction } = shape_line(Some(self), ray);
        Ray { origin: origin.as_vec3(), direction: direction.as_vec3() }
    }

    /// Returns whether the map mirrors, so that triangles are turned inside out.
    pub(super) fn is_mirrored(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// Maps a normal of the scene to the shape, with unit length.
    pub(super) fn shape_normal(&self, normal: DVec3) -> DVec3 {
        (self.linear.transpose() * normal).normalize()
    }

    /// Returns the factors of lengths along the axes of the shape.
    pub(super) fn factors(&self) -> [f64; 3] {
        [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis].map(DVec3::length)
    }

    /// Returns the smallest box of f32 around a surface in the scene.
    ///
    /// `reach` returns the largest dot product of a vector and a point of the surface, relative to `center`.
    pub(super) fn bounds(map: Option<&Self>, center: DVec3, reach: impl Fn(DVec3) -> f64) -> Bounds {
        let middle = map.map_or(center, |map| map.point(center));
        let mut ends = [middle; 2];
        for (axis, along) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            let along = map.map_or(along, |map| map.linear.row(axis));
            ends[0][axis] -= reach(-along);
            ends[1][axis] += reach(along);
        }
        rounded_outward(ends)
    }
}

/// Returns the smallest box of f32 around a box.
fn rounded_outward([min, max]: [DVec3; 2]) -> Bounds {
    let down = |exact: f64| if f64::from(exact as f32) > exact { (exact as f32).next_down() } else { exact as f32 };
    let [x, y, z] = min.to_array().map(down);
    let [far_x, far_y, far_z] = max.to_array().map(|exact| -down(-exact));
    Bounds { min: Vec3::new(x, y, z), max: Vec3::new(far_x, far_y, far_z) }
}

/// Returns the line of a ray in the coordinates of a shape.
#[inline]
pub(super) fn shape_line(map: Option<&AffineMap>, ray: &Ray) -> Line {
    let line = Line { origin: ray.origin.as_dvec3(), direction: ray.direction.as_dvec3() };
    map.map_or(line, |map| map.shape_line(&line))
}

impl Shape {
    /// Returns the shape scaled, rotated and moved.
    ///
    /// # Errors
    /// If it then reaches beyond ±1e9, or is no mesh and too small for rays to be traced to it.
    #[doc(hidden)]
    pub fn placed(self, placement: &Placement) -> Result<Self, SceneFault> {
        let is_mesh = matches!(self, Self::Mesh(_));
        let placed = self.placed_anywhere(placement).filter(|shape| match (shape, shape.bounds()) {
            (Self::Plane(plane), _) => checks::are_within_range(&[plane.point()]),
            (_, Some(Bounds { min, max })) => {
                checks::are_within_range(&[min, max]) && (is_mesh || checks::is_long_enough(max - min))
            }
            (_, None) => true,
        });
        placed.ok_or_else(|| SceneFault::new("placement", if is_mesh { checks::MESH_TOO_FAR } else { OUT_OF_REACH }))
    }
}

/// The message for a shape that is not near, or too small, after it has been placed.
pub(super) const OUT_OF_REACH: &str =
    "scaled, rotated and moved, a shape must lie within ±1e9 and measure at least 1e-9; light cannot reach this one";

/// A placement as written: `scale: ..., rotate: ..., translate: ...`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenPlacement {
    /// The scale along each axis; 1 if none is given.
    scale: Option<WrittenVector>,
    /// The rotation about x, then y, then z, in degrees.
    rotate: Option<WrittenVector>,
    /// The translation, after scale and rotation.
    translate: Option<WrittenVector>,
    copies: Option<WrittenCopies>,
}

/// Copies in rows as written: `copies: (count: ..., step: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WrittenCopies {
    /// The number of copies along each axis.
    count: WrittenVector,
    /// The distances between neighbours along the axes.
    step: WrittenVector,
}

/// The most copies of an object.
const MAX_COPIES: f64 = 100_000.0;

impl WrittenPlacement {
    /// The names of the fields.
    pub(crate) const FIELDS: [&'static str; 4] = ["scale", "rotate", "translate", "copies"];

    /// Reads the placement from the fields of an object; `None` if it has none.
    pub(crate) fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Option<Self> {
        let placement = Self {
            scale: reader.optional(fields, "scale", read_scale),
            rotate: reader.optional(fields, "rotate", read_angles),
            translate: reader.optional(fields, "translate", NodeReader::point),
            copies: reader.optional(fields, "copies", read_copies),
        };
        let is_any = [placement.scale, placement.rotate, placement.translate].iter().any(Option::is_some);
        (is_any || placement.copies.is_some()).then_some(placement)
    }

    /// Returns the number of copies as written.
    pub(crate) fn copy_count(&self) -> usize {
        self.copies
            .map_or(1, |copies| copies.count.components.iter().map(|count| count.value).product::<f64>() as usize)
    }

    /// Returns the placement of each copy, or `None` after a fault has been reported.
    pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Vec<Placement>> {
        // All fields are checked before a fault ends the function, so that the faults of each are reported.
        let scale = self.scale.map_or(Some(DVec3::ONE), |scale| checked(validator, scale, checks::nonzero_factor));
        let degrees =
            self.rotate.map_or(Some(DVec3::ZERO), |angles| checked(validator, angles, checks::angle_in_degrees));
        let translation = self.translate.map_or(Some(DVec3::ZERO), |translation| validator.coordinates(translation));
        let offsets = self.copies.map_or(Some(vec![DVec3::ZERO]), |copies| copies.check(validator));
        let placement = Placement { scale: scale?, turn: rotation(degrees?.to_array()), translation: translation? };
        let moved = |offset| Placement { translation: placement.translation + offset, ..placement };
        Some(offsets?.into_iter().map(moved).collect())
    }
}

impl WrittenCopies {
    /// Returns the offset of each copy, in rows along x, or `None` after a fault.
    fn check(&self, validator: &mut Validator<'_>) -> Option<Vec<DVec3>> {
        let count = checked(validator, self.count, checks::copy_count);
        let (count, step) = (count?, validator.coordinates(self.step)?);
        if count.element_product() > MAX_COPIES {
            return validator.fault(self.count.span, || "an object can have up to 100,000 copies".to_owned());
        }
        let [x, y, z] = count.to_array().map(|count| count as u32);
        let offset = |at: u32| step * DVec3::new((at % x).into(), (at / x % y).into(), (at / x / y).into());
        Some((0..x * y * z).map(offset).collect())
    }
}

fn read_copies(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenCopies> {
    const FORM: &str = "copies (count: (x, y, z), step: (x, y, z))";
    let fields = reader.fields(node, "the field copies", FORM, &["count", "step"])?;
    let count = reader.required(&fields, "count", |reader, node| {
        let components = reader.numbers(node, "the number of copies along each axis (x, y, z)")?;
        Some(WrittenVector { components, span: node.span })
    });
    let step = reader.required(&fields, "step", NodeReader::direction);
    Some(WrittenCopies { count: count?, step: step? })
}

/// Checks the numbers of a vector by a rule, up to the first fault.
fn checked(
    validator: &mut Validator<'_>,
    written: WrittenVector,
    rule: fn(f64) -> Result<f32, checks::Message>,
) -> Option<DVec3> {
    for number in written.components {
        validator.accept(number.span, rule(number.value))?;
    }
    Some(DVec3::from_array(written.components.map(|number| number.value)))
}

/// Reads the scale: one factor for all axes, or three.
fn read_scale(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenVector> {
    if matches!(node.value, Value::Number(_)) {
        let number = reader.number(node)?;
        return Some(WrittenVector { components: [number; 3], span: node.span });
    }
    let components = reader.numbers(node, "a factor, or one for each axis (x, y, z)")?;
    Some(WrittenVector { components, span: node.span })
}

fn read_angles(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenVector> {
    let components = reader.numbers(node, "angles in degrees about the axes (x, y, z)")?;
    Some(WrittenVector { components, span: node.span })
}

/// Returns the rotation about x, then y, then z: counterclockwise seen from the axis's end.
fn rotation(degrees: [f64; 3]) -> DMat3 {
    let [x, y, z] = degrees.map(cosine_and_sine);
    let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, x.0, x.1), DVec3::new(0.0, -x.1, x.0));
    let about_y = DMat3::from_cols(DVec3::new(y.0, 0.0, -y.1), DVec3::Y, DVec3::new(y.1, 0.0, y.0));
    let about_z = DMat3::from_cols(DVec3::new(z.0, z.1, 0.0), DVec3::new(-z.1, z.0, 0.0), DVec3::Z);
    about_z * about_y * about_x
}

/// Returns cosine and sine of an angle in degrees; exact for quarter turns.
fn cosine_and_sine(degrees: f64) -> (f64, f64) {
    // The angle is reduced to a quarter turn before the conversion to radians, as multiples of 90 are exact in degrees.
    let quarters = libm::round(degrees / 90.0);
    let (sine, cosine) = libm::sincos((degrees - 90.0 * quarters).to_radians());
    match (quarters as i64).rem_euclid(4) {
        0 => (cosine, sine),
        1 => (-sine, cosine),
        2 => (-cosine, -sine),
        _ => (sine, -cosine),
    }
}
