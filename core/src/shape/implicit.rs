//! Implicit surfaces: the points within bounds where a formula is 0 and changes its sign.

use super::cuboid::WrittenBox;
use super::described::size_in_words;
use super::placement::{AffineMap, Placeable, Placement, shape_line};
use super::{
    CheckedShape, Cuboid, Described, Equation, EquationStep, Meshes, Points, Shape, Sphere, Surface, SurfacePoint,
};
use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::formula::{Formula, Line, Searches, Solver, is_free_name};
use crate::lanes::{F32x8, LANES, Vector, set_bits};
use crate::ray::{EightRays, Interval, Probe, Ray};
use crate::scene_text::{Span, SyntaxNode, Value};
use crate::text::visible;
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator, WrittenNumber, WrittenVector, values};
use glam::{DVec3, Vec3};
use std::sync::Arc;

mod crossings;

/// The largest number of roots that an explanation shows, all in front of the eye.
const MAX_ROOTS: usize = 2;

/// The longest formula in a description, in characters.
const MAX_SHOWN: usize = 48;

/// A surface f(x, y, z) = 0, cut off at its bounds, where it may be open.
// The definition is shared, because each leaf of the tree has copies of its surfaces.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Implicit(Arc<Definition>);

#[derive(Clone, Debug, PartialEq)]
struct Definition {
    formula: Formula,
    /// The reflectances of red, green and blue, if the surface has its own colours.
    colors: Option<[Formula; 3]>,
    /// The formula as written, on one line.
    text: String,
    /// The bounds, in the coordinates of the formula.
    bounds: Bounds,
    /// The map to the scene, if the surface is scaled, rotated or moved.
    map: Option<AffineMap>,
    /// The bounds in the scene.
    bounds_in_scene: Bounds,
    /// The ball that cuts the surface, if the bounds are not a box.
    ball: Option<Ball>,
    /// The reason why nothing of the surface is visible, if that is certain.
    invisibility_warning: Option<&'static str>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball {
    center: DVec3,
    radius: f64,
}

impl Implicit {
    fn new(text: &str, formula: Formula, colors: Option<[Formula; 3]>, bounds: Bounds, ball: Option<Ball>) -> Self {
        let invisibility_warning = formula.lack_of_surface(bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let text = visible(&text.split_whitespace().collect::<Vec<_>>().join(" "));
        let (map, bounds_in_scene) = (None, bounds);
        Self(Arc::new(Definition { formula, colors, text, bounds, map, bounds_in_scene, ball, invisibility_warning }))
    }

    /// Returns whether the surface or its colours depend on the time.
    pub(crate) fn moves(&self) -> bool {
        self.0.formula.moves() || self.0.colors.iter().flatten().any(Formula::moves)
    }

    /// Returns the surface at a time in seconds.
    pub(crate) fn at_time(&self, seconds: f64) -> Self {
        if !self.moves() {
            return self.clone();
        }
        let mut definition = Definition::clone(&self.0);
        definition.formula = definition.formula.at_time(seconds);
        definition.colors = definition.colors.map(|colors| colors.map(|color| color.at_time(seconds)));
        Self(Arc::new(definition))
    }

    /// Returns the reflectance at a point of the surface, if it has its own colours.
    ///
    /// Values are clamped to 0 to 1; undefined values (NaN) count as 0.
    pub(super) fn own_reflectance(&self, position: Vec3) -> Option<LinearRgb> {
        let [r, g, b] = self.0.colors.as_ref()?.each_ref().map(|color| {
            let value = color.value(self.in_formula_space(position));
            if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) as f32 }
        });
        Some(LinearRgb::new(r, g, b))
    }

    /// Returns the reason why nothing of the surface is visible, if that is certain.
    pub(crate) fn invisibility_warning(&self) -> Option<&'static str> {
        self.0.invisibility_warning
    }

    /// Returns the part of `of_box` in which a line is within the bounds; empty if `min > max`.
    ///
    /// `of_box` is the interval in which the line is in the axis-aligned box around the bounds in the scene.
    fn within_bounds(&self, line: &Line, of_box: Interval) -> Interval {
        let of_box = if self.0.map.is_some() {
            let inside = line_in_box(line, &self.0.bounds);
            Interval { min: of_box.min.max(inside.min), max: of_box.max.min(inside.max) }
        } else {
            of_box
        };
        let Some(Ball { center, radius }) = self.0.ball else { return of_box };
        let (d, from_center) = (line.direction, line.origin - center);
        let (squared, half_b) = (d.dot(d), from_center.dot(d));
        let nearest = from_center - d * (half_b / squared);
        // The root is NaN for a line that misses the ball.
        let root = ((radius * radius - nearest.dot(nearest)) / squared).sqrt();
        let middle = -half_b / squared;
        let (enters, leaves) = ((middle - root) as f32, (middle + root) as f32);
        // `max` and `min` would skip NaN and return the interval of the box.
        if root.is_nan() {
            return Interval { min: f32::INFINITY, max: f32::NEG_INFINITY };
        }
        Interval { min: of_box.min.max(enters), max: of_box.max.min(leaves) }
    }

    /// Returns the line of a ray in the coordinates of the formula.
    fn line_of_ray(&self, ray: &Ray) -> Line {
        shape_line(self.0.map.as_ref(), ray)
    }

    /// Returns a point of the scene in the coordinates of the formula.
    fn in_formula_space(&self, point: Vec3) -> DVec3 {
        self.0.map.as_ref().map_or(point.as_dvec3(), |map| map.shape_point(point.as_dvec3()))
    }

    /// Returns the box or ball of the bounds, of a surface that is not placed.
    pub(super) fn shape_of_bounds(&self) -> Shape {
        match self.0.ball {
            Some(Ball { center, radius }) => Sphere::unchecked(center.as_vec3(), radius as f32).into(),
            None => Cuboid::new(self.0.bounds.min.as_dvec3(), self.0.bounds.max.as_dvec3()).into(),
        }
    }

    /// Returns the formula as an equation on one line, shortened if it is long.
    fn equation_text(&self) -> String {
        let text = &self.0.text;
        if text.chars().count() <= MAX_SHOWN {
            return text.clone();
        }
        text.chars().take(MAX_SHOWN - 3).chain("...".chars()).collect()
    }

    /// Returns the gradient scaled to unit length; `None` if it is zero or undefined.
    fn normal(gradient: DVec3) -> Option<DVec3> {
        let largest = gradient.abs().max_element();
        // Divides by the largest coordinate first, so that no square overflows or vanishes.
        let scaled = gradient / largest;
        (largest > 0.0 && largest.is_finite()).then(|| scaled / scaled.dot(scaled).sqrt())
    }
}

/// Returns the interval of t in which a line is in a box; empty if `min > max`.
fn line_in_box(line: &Line, bounds: &Bounds) -> Interval {
    let ray = Ray { origin: line.origin.as_vec3(), direction: line.direction.as_vec3() };
    bounds.crossed(&Probe::new(ray))
}

impl Surface for Implicit {
    fn bounds(&self) -> Option<Bounds> {
        Some(self.0.bounds_in_scene)
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let (inside, splat) = (self.0.bounds_in_scene.crossed(probe), |number| F32x8([number; LANES]));
        let (inside, within) = ([inside.min, inside.max].map(splat), [within.min, within.max].map(splat));
        let (crosses, t) = self.closest_crossings(&EightRays::of(&[probe.ray]), &inside, &within);
        (crosses != 0).then_some(t.0[0])
    }

    /// Returns the mask of the rays that cross the surface, and the t of their first roots.
    ///
    /// The rays are searched together. `inside` has the intervals of t in which they are in the box around the surface,
    /// `within` those in which a root counts.
    fn closest_crossings(&self, rays: &EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8) {
        let [[enters, leaves], [min, max]] = [inside, within];
        let mut searches = Searches { ranges: [*enters, *leaves], until: *max, ..Searches::NONE };
        searches.lines =
            [&rays.origin, &rays.direction].map(|Vector { x, y, z }| [x, y, z].map(|numbers| numbers.0.map(f64::from)));
        if self.0.map.is_some() || self.0.ball.is_some() {
            for lane in set_bits(rays.active) {
                let line = self.line_of_ray(&rays.ray(lane));
                let of_box = Interval { min: enters.0[lane], max: leaves.0[lane] };
                let Interval { min, max } = self.within_bounds(&line, of_box);
                searches.set_line(lane, &line);
                (searches.ranges[0].0[lane], searches.ranges[1].0[lane]) = (min, max);
            }
        }
        for (start, min) in searches.ranges[0].0.iter_mut().zip(min.0) {
            *start = start.max(min);
        }
        let starts_within = |lane: &usize| searches.ranges[0].0[*lane] <= max.0[*lane];
        searches.lanes = set_bits(rays.active).filter(starts_within).fold(0, |lanes, lane| lanes | 1 << lane);
        if searches.lanes == 0 {
            return (0, F32x8::ZERO);
        }
        let (found, t) = Solver::new(&self.0.formula).first_roots(&searches);
        let is_within = |lane: &usize| within[0].0[*lane] <= t.0[*lane] && t.0[*lane] <= within[1].0[*lane];
        (set_bits(found).filter(is_within).fold(0, |lanes, lane| lanes | 1 << lane), t)
    }

    /// Returns the point of the ray at `t`, moved onto the surface along the gradient.
    ///
    /// The move corrects the rounding of t.
    ///
    /// Where the gradient is zero or undefined, as at the tip of a cone, the normal is taken from a point a little in
    /// front. If that has none either, the normal is opposite to the ray.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let Line { origin, direction } = self.line_of_ray(ray);
        let at = origin + direction * f64::from(t);
        let (value, gradient) = self.0.formula.gradient(at);
        let step = gradient * (value / gradient.dot(gradient));
        // The rounding of t moves the point by at most `rounding`. A longer Newton step does not correct that error,
        // and is not taken.
        let rounding = f64::from(f32::EPSILON) * f64::from(t).abs() * direction.abs().max_element();
        let position = if step.abs().max_element() <= rounding { at - step } else { at };
        let size = at.abs().max_element().max(f64::from(self.0.bounds.extent().max_element()));
        let in_front = direction * (f64::from(super::CLEARANCE) * size / direction.length());
        let normal = Self::normal(gradient)
            .or_else(|| Self::normal(self.0.formula.gradient(at - in_front).1))
            .unwrap_or(-direction / direction.length());
        let (position, normal, size) = match &self.0.map {
            None => (position, normal, size),
            Some(map) => {
                let (position, normal) = (map.point(position), map.normal(normal));
                let extent = f64::from(self.0.bounds_in_scene.extent().max_element());
                (position, normal / normal.length(), position.abs().max_element().max(extent))
            }
        };
        let [position, normal] = [position, normal].map(|vector| Vector::splat(vector.as_vec3()));
        Points::seen_by(&Probe::new(*ray).rays, position, normal, size as f32, [0.0; 2]).point()
    }
}

impl Described for Implicit {
    const KIND: &'static str = "formula";

    fn described(&self, color: &str) -> String {
        let zero = if self.0.text.contains('=') { "" } else { " = 0" };
        format!(
            "a {color} implicit surface, {}{zero}, {}",
            self.equation_text(),
            size_in_words(&self.0.bounds_in_scene)
        )
    }

    /// Finds the first roots of f(o + t d) within the bounds, in front of the eye.
    fn equation(&self, ray: &Ray) -> Equation {
        let line = self.line_of_ray(ray);
        let Interval { min, max } = self.within_bounds(&line, self.0.bounds_in_scene.crossed(&Probe::new(*ray)));
        let (solver, mut roots, mut from) = (Solver::new(&self.0.formula), Vec::new(), min.max(0.0));
        while roots.len() < MAX_ROOTS
            && let Some(root) = solver.first_root(&line, [from, max], max)
        {
            roots.push(f64::from(root));
            // The next search starts at this root, and does not find it again.
            from = root;
        }
        let mut steps =
            vec![EquationStep::Formula(self.0.text.clone()), EquationStep::Text("f(o + t d) = 0, in the bounds")];
        if min <= max {
            steps.push(EquationStep::Values("t in ", " to ", vec![f64::from(min), f64::from(max)]));
        }
        steps.push(EquationStep::Values("t = ", " or ", roots.clone()));
        Equation { steps, roots, without_root: "miss", is_outside: false }
    }

    fn encloses(&self, point: Vec3) -> bool {
        let (Definition { formula, bounds, ball, .. }, at) = (&*self.0, self.in_formula_space(point));
        let in_box = at.cmpge(bounds.min.as_dvec3()).all() && at.cmple(bounds.max.as_dvec3()).all();
        in_box && ball.is_none_or(|ball| ball.center.distance(at) < ball.radius) && formula.value(at) < 0.0
    }
}

/// An implicit surface as written: `Implicit(f: "...", bounds: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenImplicit {
    f: Option<Spanned<String>>,
    bounds: Option<WrittenBounds>,
    params: Vec<(String, WrittenNumber)>,
    color: Option<[Spanned<String>; 3]>,
}

/// The bounds of a formula as written.
#[derive(Clone, Debug, PartialEq)]
enum WrittenBounds {
    Box(WrittenBox),
    Sphere { center: Option<WrittenVector>, radius: Option<WrittenNumber> },
}

impl InSceneFile for Implicit {
    type Written = WrittenImplicit;

    const NAME: &'static str = "Implicit";
    const OWNER: &'static str = "an Implicit";
    const FORM: &'static str = "Implicit(f: \"...\", bounds: Box(min: ..., max: ...))";
    const FIELDS: &'static [&'static str] = &["f", "bounds", "params", "color"];
    const SUMMARY: &'static str = "All points at which a formula is 0.";
    const MEANINGS: &'static [&'static str] = &[
        "the formula of x, y, z and time, in quotes",
        "Box(min: ..., max: ...) or Sphere(center: ..., radius: ...) around the surface",
        "values of names in the formulas, {\"name\": 1}; none",
        "formulas of red, green and blue, [\"...\", \"...\", \"...\"]; grey",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenImplicit {
        WrittenImplicit {
            f: reader
                .required(fields, "f", |reader, node| reader.text(node, "a formula in quotes, such as \"x^2 - y\"")),
            bounds: reader.required(fields, "bounds", read_bounds),
            params: reader.optional(fields, "params", read_params).unwrap_or_default(),
            color: reader.optional(fields, "color", |reader, node| {
                if fields.get("material").is_some() {
                    reader.fault(node.head(), || "an Implicit has either a color or a material".to_owned());
                }
                read_color(reader, node)
            }),
        }
    }
}

fn read_bounds(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenBounds> {
    const FORM: &str = "bounds Box(min: ..., max: ...) or Sphere(center: ..., radius: ...)";
    if reader.group_name(node, "a bound", FORM, &["Box", "Sphere"])? == "Box" {
        let fields = reader.fields(node, "a Box", "Box(min: ..., max: ...)", &["min", "max"])?;
        return Some(WrittenBounds::Box(Cuboid::read(reader, &fields)));
    }
    let fields = reader.fields(node, "a Sphere", "Sphere(center: ..., radius: ...)", &["center", "radius"])?;
    let center = reader.required(&fields, "center", NodeReader::point);
    let radius = reader.required(&fields, "radius", NodeReader::number);
    Some(WrittenBounds::Sphere { center, radius })
}

fn read_color(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<[Spanned<String>; 3]> {
    const WANTED: &str = "three formulas [\"...\", \"...\", \"...\"] for red, green and blue";
    let Some(items) = values(node).filter(|items| items.len() == 3) else {
        reader.mismatch(node, WANTED);
        return None;
    };
    reader.read_all(items, |reader, item| reader.text(item, "a formula in quotes")).try_into().ok()
}

fn read_params(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Vec<(String, WrittenNumber)>> {
    const WANTED: &str = "parameters with names {\"a\": 0.5, ...}";
    let Value::Map(entries) = &node.value else {
        reader.mismatch(node, WANTED);
        return None;
    };
    let mut params: Vec<(String, WrittenNumber)> = Vec::new();
    for (key, value) in entries {
        let value = reader.number(value);
        let Value::String(name) = &key.value else {
            reader.mismatch(key, "the name of a parameter in quotes");
            continue;
        };
        if !is_free_name(name) {
            let shown = visible(name);
            reader.fault(key.span, || format!("`{shown}` cannot be the name of a parameter; choose another name"));
        } else if params.iter().any(|(known, _)| **known == **name) {
            reader.fault(key.span, || format!("duplicate parameter `{name}`"));
        } else {
            // A value with a fault still defines its name, so that the formula has no second fault.
            let missing = Spanned { value: 1.0, span: key.span };
            params.push((name.to_string(), value.unwrap_or(missing)));
        }
    }
    Some(params)
}

impl CheckedShape for Implicit {
    fn brings_colors(written: &WrittenImplicit) -> bool {
        written.color.is_some()
    }

    fn check(written: &WrittenImplicit, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let bounds = written.bounds.as_ref().and_then(|bounds| check_bounds(bounds, validator));
        let params: Vec<_> = written.params.iter().map(|(name, value)| (name.clone(), value.value)).collect();
        // Formula, colours and bounds are all checked before a fault ends the function, so that all faults are
        // reported.
        let formula = written.f.as_ref().and_then(|text| check_formula(text, &params, validator));
        let colors = written.color.as_ref().map(|colors| {
            let [r, g, b] = colors.each_ref().map(|text| check_formula(text, &params, validator));
            Some([r?, g?, b?])
        });
        let (text, formula, (bounds, ball)) = (written.f.as_ref()?, formula?, bounds?);
        let colors = match colors {
            Some(colors) => Some(colors?),
            None => None,
        };
        Some(Self::new(&text.value, formula, colors, bounds, ball).into())
    }
}

impl Placeable for Implicit {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let (mut definition, new) = (Arc::unwrap_or_clone(self.0), placement.map());
        let map = definition.map.map_or(new, |old| old.then(&new));
        let Bounds { min, max } = definition.bounds;
        let [middle, half] = [(max.as_dvec3() + min.as_dvec3()) * 0.5, (max.as_dvec3() - min.as_dvec3()) * 0.5];
        definition.bounds_in_scene = AffineMap::bounds(Some(&map), middle, |direction| match definition.ball {
            Some(Ball { radius, .. }) => radius * direction.length(),
            None => half.dot(direction.abs()),
        });
        definition.map = Some(map);
        Some(Self(Arc::new(definition)).into())
    }

    fn has_map(&self) -> bool {
        self.0.map.is_some()
    }
}

fn check_formula(text: &Spanned<String>, params: &[(String, f64)], validator: &mut Validator<'_>) -> Option<Formula> {
    match Formula::parse(&text.value, params) {
        Ok(formula) => Some(formula),
        Err(fault) => validator.fault(span_in(text, fault.range), || format!("in this formula: {}", fault.message)),
    }
}

fn check_bounds(written: &WrittenBounds, validator: &mut Validator<'_>) -> Option<(Bounds, Option<Ball>)> {
    match *written {
        WrittenBounds::Box(corners) => {
            let [min, max] = corners.check(validator)?.map(DVec3::as_vec3);
            Some((Bounds { min, max }, None))
        }
        WrittenBounds::Sphere { center, radius } => {
            let center = center.and_then(|center| validator.point(center));
            let radius = radius.and_then(|radius| validator.length("radius", radius));
            let (center, radius) = (center?, radius?);
            let ball = Ball { center: center.as_dvec3(), radius: f64::from(radius) };
            Some((Bounds { min: center - radius, max: center + radius }, Some(ball)))
        }
    }
}

/// Returns the span of a part of a text in the file.
fn span_in(text: &Spanned<String>, part: std::ops::Range<usize>) -> Span {
    let (start, end) = (text.span.start as usize, text.span.end as usize);
    // `opening` is the length of the opening quote, including the r and hashes of a raw string. The text has no
    // escapes, because no character of a formula needs one.
    let opening = (end - start).saturating_sub(text.value.len()).div_ceil(2);
    let at = |offset: usize| (start + opening + offset).min(end);
    Span::new(at(part.start), at(part.end))
}

#[cfg(all(test, unit_tests))]
mod tests;
