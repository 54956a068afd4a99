//! Descriptions of pictures in words, for people who cannot see them.
//!
//! Every statement follows from a `Survey` of traced pixels or from the scene's checked values.

use crate::camera::{Camera, Pose};
use crate::color::LinearRgb;
use crate::framebuffer::Resolution;
use crate::lanes::Vector;
use crate::light::Light;
use crate::scene::{Background, Object, Scene};
use crate::scene_text::clipped;
use crate::shape::Shape;
use crate::text::listed;
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;
use std::fmt::Write;
use survey::{Coverage, Survey};
use words::{color, distance, number, percent, point_text, position};

mod facts;
mod survey;
mod words;

pub use facts::{Facts, LightFacts, ObjectFacts, SeenFacts};

/// The largest number of objects, and of lights, that are described one by one.
// Descriptions are read aloud by screen readers, which takes about a minute for ten lines.
const MAX_LISTED: usize = 10;

/// Returns an English description of a picture, as lines of text.
///
/// `name` is the name of the scene. The resolution decides which objects are too small to be seen.
///
/// ```
/// use termtrace::{Resolution, Scene, describe};
///
/// let text = r##"(
///     camera: (eye: (0, 0, 5), target: (0, 0, 0)),
///     objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse("#dc2828"))],
/// )"##;
/// let scene = Scene::from_ron("ball.ron", text)?;
/// let description = describe("ball.ron", &scene, scene.camera(), Resolution::new(80, 48)?);
/// assert!(description.contains("red sphere"), "{description}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn describe(name: &str, scene: &Scene, camera: &Camera, resolution: Resolution) -> String {
    let description = Description { scene, camera, survey: Survey::of_picture(scene, camera, resolution) };
    let mut text = description.introduction(name);
    for part in [
        description.visible_objects(resolution),
        description.hidden_objects(resolution),
        description.background(),
        description.lights(),
        description.views(),
    ] {
        if !part.is_empty() {
            text += "\n";
            text += &part;
        }
    }
    text
}

/// Returns the facts that [`describe`] puts into words, about all objects and lights.
#[doc(hidden)]
pub fn facts(scene: &Scene, camera: &Camera, resolution: Resolution) -> Facts {
    Description { scene, camera, survey: Survey::of_picture(scene, camera, resolution) }.facts(resolution)
}

/// Returns the colour and kind of an object, such as `red sphere`.
pub fn short_name(object: &Object) -> String {
    let color = object.material.described(color);
    let words = [color.as_deref(), object.finish.described(), Some(object.shape.kind())];
    words.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// The inputs of a description, with a method for each part of its text.
struct Description<'s> {
    scene: &'s Scene,
    camera: &'s Camera,
    survey: Survey,
}

impl Description<'_> {
    /// Returns the first sentence: the numbers of objects and lights, and the camera.
    fn introduction(&self, name: &str) -> String {
        let Pose { eye, target, .. } = self.camera.pose();
        let rectangle = self.camera.rectangle();
        let degrees = rectangle.vertical_fov().to_degrees();
        let Vec2 { x: right, y: up } = rectangle.tilt() * 1_f32.to_degrees();
        let tilt = if rectangle.tilt() == Vec2::ZERO {
            String::new()
        } else {
            format!(", on a view rectangle tilted by {} degrees to the right and {} up", number(right), number(up))
        };
        format!(
            "{name}: {} and {}, seen from {} towards {}; {} degree vertical field of view{tilt}.\n",
            counted(self.scene.objects().len(), "object"),
            counted(self.scene.lights().len(), "light"),
            point_text(eye),
            point_text(target),
            number(degrees)
        )
    }

    /// Names the views of a mesh file, with their keys in the live view.
    fn views(&self) -> String {
        let name = |(at, name): (usize, &String)| match name.as_str() {
            "" => at.to_string(),
            name => format!("{at} \"{}\"", clipped(name)),
        };
        let names: Vec<_> = (1..).zip(self.scene.view_names()).map(name).collect();
        if names.is_empty() {
            String::new()
        } else {
            format!("Cameras of the file, by their keys: {}.\n", listed(&names))
        }
    }

    /// Describes the objects in the picture, those with the most pixels first.
    fn visible_objects(&self, resolution: Resolution) -> String {
        let covered = &self.survey.covered;
        let mut order: Vec<_> = covered.keys().copied().collect();
        order.sort_by_key(|object| (std::cmp::Reverse(covered[object].pixels), *object));
        if order.is_empty() {
            return "No object is in the picture.\n".to_owned();
        }
        let mut text = "In the picture, the largest first:\n".to_owned();
        for &object in order.iter().take(MAX_LISTED) {
            let part = &covered[&object];
            let _ = writeln!(
                text,
                "- object {}, {}: {}, {} of the picture, {}{}",
                object + 1,
                self.describe_object(object, part),
                position(part.covered_rect(resolution)),
                percent(part.pixels, resolution.pixel_count()),
                distance(part.nearest, part.farthest),
                self.occlusions(object)
            );
        }
        if let Some(rest) = order.get(MAX_LISTED..).filter(|rest| !rest.is_empty()) {
            let pixels: usize = rest.iter().map(|object| covered[object].pixels).sum();
            let share = percent(pixels, resolution.pixel_count());
            let _ = writeln!(
                text,
                "- and {} more, {share} of the picture together",
                self.counts_by_kind(rest.iter().copied())
            );
        }
        text
    }

    /// Describes an object by its colour, finish, kind and size.
    fn describe_object(&self, object: u32, part: &Coverage) -> String {
        let Object { shape, finish, opacity, .. } = &self.scene.objects()[object as usize];
        let color = self.color_of(object, part);
        let look = [Some(&*color), (*opacity < 1.0).then_some("transparent"), finish.described()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" ");
        let text = shape.described(&look);
        match text.strip_prefix("a ") {
            // Shapes write "a" before any colour.
            Some(rest) if rest.starts_with(['a', 'e', 'i', 'o', 'u']) => format!("an {rest}"),
            _ => text,
        }
    }

    fn color_of(&self, object: u32, part: &Coverage) -> String {
        let own = || color(part.mean_reflectance()).to_owned();
        self.scene.objects()[object as usize].material.described(color).unwrap_or_else(own)
    }

    /// Describes which objects are in front of an object, and which are behind it.
    // Unbounded objects are left out: it is not informative that everything is in front of the floor.
    fn occlusions(&self, object: u32) -> String {
        let is_unbounded = |object: &u32| self.scene.objects()[*object as usize].shape.bounds().is_none();
        if is_unbounded(&object) {
            return String::new();
        }
        let list = |objects: Vec<u32>| {
            let objects: Vec<_> = objects.into_iter().filter(|other| !is_unbounded(other)).collect();
            (!objects.is_empty()).then(|| listed_objects(&objects))
        };
        let before = list(self.survey.hidden_by(object)).map(|others| format!("; in front of {others}"));
        let after = list(self.survey.hiding(object)).map(|others| format!("; partly behind {others}"));
        let relations: String = [before, after].into_iter().flatten().collect();
        relations + self.enclosing_remark(object)
    }

    /// Returns a remark if the eye is inside the object, otherwise an empty string.
    fn enclosing_remark(&self, object: u32) -> &'static str {
        let shape = &self.scene.objects()[object as usize].shape;
        if shape.encloses(self.camera.pose().eye) { "; the eye is inside it" } else { "" }
    }

    /// Describes the objects that are not seen in the picture, with the reason for each.
    fn hidden_objects(&self, resolution: Resolution) -> String {
        let count = self.scene.objects().len() as u32;
        let unseen: Vec<_> = (0..count).filter(|object| !self.survey.covered.contains_key(object)).collect();
        if unseen.is_empty() {
            return String::new();
        }
        if unseen.len() > MAX_LISTED {
            return format!("Not seen: {}.\n", self.counts_by_kind(unseen.into_iter()));
        }
        let mut text = "Not seen:\n".to_owned();
        for object in unseen {
            let why = self.reason_hidden(object, resolution);
            let _ = writeln!(
                text,
                "- object {}, {}: {why}",
                object + 1,
                self.describe_object(object, &Coverage::default())
            );
        }
        text
    }

    /// Returns the reason why an object is not in the picture.
    fn reason_hidden(&self, object: u32, resolution: Resolution) -> String {
        let before = self.survey.hiding(object);
        if !before.is_empty() {
            return format!("hidden behind {}", listed_objects(&before));
        }
        let Some(middle) = middle(&self.scene.objects()[object as usize].shape) else {
            return "no part of it is in front of the eye".to_owned();
        };
        let eye_rays = self.camera.eye_rays(resolution.aspect_ratio());
        let basis = self.camera.rectangle_basis();
        let away = middle - self.camera.pose().eye;
        let along = -away.dot(basis.w);
        if along <= 0.0 {
            return "behind the eye".to_owned();
        }
        // (qu, qv) is the position of the object's middle in the picture, as shares of the sides of the view rectangle,
        // which may be shifted. It is inside the picture if both are in 0..=1.
        let corner = eye_rays.through(0.0, 0.0).direction;
        let part = |qu, qv| {
            let side = eye_rays.through(qu, qv).direction - corner;
            (away / along - corner).dot(side) / side.length_squared()
        };
        let (qu, qv) = (part(1.0, 0.0), part(0.0, 1.0));
        let outside = [(qu < 0.0, "to the left of the picture"), (qu > 1.0, "to the right of the picture")];
        let mut outside = outside.into_iter().chain([(qv < 0.0, "below the picture"), (qv > 1.0, "above the picture")]);
        let position = outside.find_map(|(is_so, word)| is_so.then_some(word));
        position.unwrap_or("too small to be seen, or hidden").to_owned()
    }

    /// Describes the background's colours and its share of the picture.
    fn background(&self) -> String {
        let share = self.survey.background_pixels;
        if share == 0 {
            return String::new();
        }
        format!(
            "The background, {}, is seen in {} of the picture.\n",
            self.background_colors(),
            percent(share, self.survey.pixels)
        )
    }

    /// Returns the background's colours in words.
    fn background_colors(&self) -> String {
        if let Some(fog) = self.scene.fog() {
            return format!("{} fog", color(fog.color() * self.scene.exposure()));
        }
        match self.scene.background() {
            Background::Color(light) => color(light * self.scene.exposure()).to_owned(),
            Background::Gradient { bottom, top } => {
                let [bottom, top] = [bottom, top].map(|light| color(light * self.scene.exposure()));
                format!("{bottom} below and {top} above")
            }
        }
    }

    /// Describes the lights, the strongest first.
    fn lights(&self) -> String {
        let target = self.camera.pose().target;
        let mut lights: Vec<_> = self.scene.lights().iter().collect();
        let strength = |light: &Light| {
            let to_light = light.to_light(Vector::<f32>::splat(target));
            // `MIN_POSITIVE` avoids a division by 0 for a light at the target itself.
            let distance_squared = to_light.dot(to_light).max(f32::MIN_POSITIVE);
            let l = to_light * (1.0 / distance_squared.sqrt());
            let [r, g, b] = light.irradiance_over_pi(l, distance_squared, 1.0);
            LinearRgb::new(r, g, b).luminance()
        };
        lights.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
        if let Some(darkness) = self.scene.darkness_warning() {
            // The warning begins with a small letter, because elsewhere it follows the name of a file.
            return format!("N{}.\n", darkness.trim_start_matches('n'));
        }
        let mut text = if lights.is_empty() { "No lights.\n" } else { "Lights, the strongest first:\n" }.to_owned();
        for light in lights.iter().take(MAX_LISTED) {
            let to_light = Vec3::from(light.to_light(Vector::<f32>::splat(target)));
            let distance = light.position().map(|position| position.distance(target));
            let distance =
                distance.map_or_else(String::new, |distance| format!(", {} from the target", number(distance)));
            let cone = light.cone_angle();
            let cone = cone.map_or_else(String::new, |angle| format!(", in a cone of {} degrees", number(angle)));
            let size = if light.has_size() { ", with soft shadows" } else { "" };
            let _ =
                writeln!(text, "- {}, {}{distance}{cone}{size}", Self::light_color(light), self.direction_of(to_light));
        }
        if lights.len() > MAX_LISTED {
            let _ = writeln!(text, "- and {} more", lights.len() - MAX_LISTED);
        }
        if self.scene.ambient().luminance() > 0.0 {
            text += "A little light comes from everywhere.\n";
        }
        if let Some(fog) = self.scene.fog() {
            let _ = writeln!(text, "Fog leaves 37 % of the light after {}.", number(fog.distance()));
        }
        if !self.scene.shadows() && !lights.is_empty() {
            text += "Nothing casts a shadow.\n";
        }
        text
    }

    /// Returns the name of a light's colour, whatever its intensity.
    fn light_color(light: &Light) -> &'static str {
        let light = light.color();
        // The hue alone is described, because intensities have no upper end.
        let brightest = light.r.max(light.g).max(light.b).max(f32::MIN_POSITIVE);
        color(light * (1.0 / brightest))
    }

    /// Describes a direction from the target as seen from the eye, such as "from above and the
    /// left".
    fn direction_of(&self, away: Vec3) -> String {
        let basis = self.camera.basis();
        let away = away.normalize_or_zero();
        // A side is mentioned if its component is above 0.3 (about 17 degrees): most lights then have one or two sides.
        let side = |along: Vec3, words: [&'static str; 2]| match away.dot(along) {
            part if part > 0.3 => Some(words[0]),
            part if part < -0.3 => Some(words[1]),
            _ => None,
        };
        let sides = [
            side(basis.v, ["above", "below"]),
            side(basis.u, ["the right", "the left"]),
            side(basis.w, ["the viewer's side", "the far side"]),
        ];
        let sides: Vec<_> = sides.into_iter().flatten().collect();
        if sides.is_empty() { "at the target".to_owned() } else { format!("from {}", listed(&sides)) }
    }

    /// Returns a text with the number of objects of each kind.
    fn counts_by_kind(&self, objects: impl Iterator<Item = u32>) -> String {
        // Sorted by kind, so that the text of a scene is always the same.
        let mut counts = BTreeMap::new();
        for object in objects {
            let kind = self.scene.objects()[object as usize].shape.kind();
            *counts.entry(kind).or_insert(0) += 1;
        }
        let counts: Vec<_> = counts.into_iter().map(|(kind, count)| counted(count, kind)).collect();
        listed(&counts.iter().map(String::as_str).collect::<Vec<_>>())
    }
}

/// Returns the middle of a shape's bounds; `None` for an unbounded shape.
fn middle(shape: &Shape) -> Option<Vec3> {
    let bounds = shape.bounds()?;
    Some(0.5 * (bounds.min + bounds.max))
}

/// Returns a number and a noun, in the plural unless the number is 1.
fn counted(count: usize, what: &str) -> String {
    let many = if what.ends_with(['h', 's', 'x']) { "es" } else { "s" };
    format!("{count} {what}{}", if count == 1 { "" } else { many })
}

/// Lists objects by their numbers in the scene file, from 1. Those after the fourth are called
/// "others".
fn listed_objects(objects: &[u32]) -> String {
    const MAX_NUMBERS: usize = 4;
    let names: Vec<_> = objects.iter().take(MAX_NUMBERS).map(|object| format!("object {}", object + 1)).collect();
    let mut words: Vec<_> = names.iter().map(String::as_str).collect();
    if objects.len() > MAX_NUMBERS {
        words.push("others");
    }
    listed(&words)
}
