//! The facts of a description as values, for programs.

use super::Description;
use super::survey::Coverage;
use super::words::position;
use crate::framebuffer::Resolution;
use crate::lanes::Vector;
use crate::light::Light;
use glam::Vec3;

/// The facts of a picture's description. Objects and lights are in the order of the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// All objects, visible or not.
    pub objects: Vec<ObjectFacts>,
    /// All lights.
    pub lights: Vec<LightFacts>,
    /// The background's colours in words.
    pub background: String,
    /// The background's share of the picture, from 0 to 1.
    pub background_share: f32,
}

/// The facts about an object. Other objects are given by their numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectFacts {
    /// The object's number in the scene file, from 1.
    pub number: u32,
    /// The kind of the object's shape, such as `sphere`.
    pub kind: &'static str,
    /// The object's colour in words.
    pub color: String,
    /// The object's colour, kind and size as a noun phrase.
    pub name: String,
    /// The visible part of the object, or the reason why there is none.
    pub seen: Result<SeenFacts, String>,
    /// The numbers of the objects that this object hides at least partly.
    pub in_front_of: Vec<u32>,
    /// The numbers of the objects that hide this object at least partly.
    pub behind: Vec<u32>,
    /// Whether the eye is inside the object.
    pub eye_is_inside: bool,
}

/// The facts about the visible part of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenFacts {
    /// The object's position in the picture, in words.
    pub position: &'static str,
    /// The object's share of the picture, from 0 to 1.
    pub share: f32,
    /// The distance from the eye to the object's nearest visible point.
    pub nearest: f32,
    /// The distance from the eye to the object's farthest visible point.
    pub farthest: f32,
}

/// The facts about a light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightFacts {
    /// The light's colour in words.
    pub color: &'static str,
    /// The direction from the target to the light, in words.
    pub direction: String,
    /// The light's position; `None` for a light at infinity.
    pub position: Option<Vec3>,
}

impl Description<'_> {
    pub(super) fn facts(&self, resolution: Resolution) -> Facts {
        let share = |pixels: usize| pixels as f32 / self.survey.pixels.max(1) as f32;
        Facts {
            objects: (0..self.scene.objects().len() as u32)
                .map(|object| self.object_facts(object, resolution, share))
                .collect(),
            lights: self.scene.lights().iter().map(|light| self.light_facts(light)).collect(),
            background: self.background_colors(),
            background_share: share(self.survey.background_pixels),
        }
    }

    fn object_facts(&self, object: u32, resolution: Resolution, share: impl Fn(usize) -> f32) -> ObjectFacts {
        let covered = self.survey.covered.get(&object);
        let part = covered.copied().unwrap_or_default();
        let numbers = |objects: Vec<u32>| objects.into_iter().map(|object| object + 1).collect();
        let shape = &self.scene.objects()[object as usize].shape;
        let seen = |part: &Coverage| SeenFacts {
            position: position(part.covered_rect(resolution)),
            share: share(part.pixels),
            nearest: part.nearest,
            farthest: part.farthest,
        };
        ObjectFacts {
            number: object + 1,
            kind: shape.kind(),
            color: self.color_of(object, &part),
            name: self.describe_object(object, &part),
            seen: covered.map(seen).ok_or_else(|| self.reason_hidden(object, resolution)),
            in_front_of: numbers(self.survey.hidden_by(object)),
            behind: numbers(self.survey.hiding(object)),
            eye_is_inside: shape.encloses(self.camera.pose().eye),
        }
    }

    fn light_facts(&self, light: &Light) -> LightFacts {
        let to_light = Vec3::from(light.to_light(Vector::<f32>::splat(self.camera.pose().target)));
        LightFacts {
            color: Self::light_color(light),
            direction: self.direction_of(to_light),
            position: light.position(),
        }
    }
}
