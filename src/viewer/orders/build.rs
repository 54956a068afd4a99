//! The picture that is drawn object by object.

use crate::camera::{Camera, EyeRays};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{Hit, any_hit};
use crate::material::Material;
use crate::rasterize::{Comparison, ObjectSteps};
use crate::ray::Ray;
use crate::scene::{OwnPoint, Scene};
use crate::shade;
use crate::shape::Surface;
use crate::tone::tone;
use crate::viewer::frame::Frame;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A picture to which objects are added one after the other.
pub(super) struct ObjectOrderBuild {
    scene: Scene,
    camera: Camera,
    resolution: Resolution,
    rays: EyeRays,
    pub(super) comparison: Arc<Comparison>,
    steps: ObjectSteps,
    /// The number of the first primitive of each object.
    starts: Vec<u32>,
    /// The pixels whose object a later object will hide, with the number and colour of the
    /// primitive that they show until then.
    hidden: BTreeMap<[u32; 2], (u32, Srgb8)>,
    /// Whether all objects are drawn, so that the picture is that of the frame.
    is_complete: bool,
}

impl ObjectOrderBuild {
    /// Returns the object-order picture of a frame, the right one of two, without any object yet.
    pub(super) fn new(frame: &Frame) -> Option<Self> {
        let [_, (_, resolution)] = *frame.shot.layout.map_sizes(frame.resolution()) else { return None };
        let (scene, camera) = (frame.scene.clone(), *frame.camera());
        let starts = scene.objects().iter().scan(0, |next, object| {
            let start = *next;
            *next += object.shape.primitive_count();
            Some(start)
        });
        Some(Self {
            camera,
            resolution,
            rays: camera.eye_rays(resolution.aspect_ratio()),
            comparison: Arc::clone(frame.orders.as_ref()?),
            steps: ObjectSteps::new(&camera, resolution),
            starts: starts.collect(),
            hidden: BTreeMap::new(),
            is_complete: false,
            scene,
        })
    }

    /// Returns the word for the primitives that the build counts: "triangle" or "object".
    ///
    /// It is "triangle" if there are more than twice as many primitives as objects in the scene.
    pub(super) fn object_name(&self) -> &'static str {
        if self.comparison.object_tests.len() > 2 * self.starts.len() { "triangle" } else { "object" }
    }

    /// Returns the size of the picture.
    pub(super) fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Removes all objects.
    pub(super) fn restart(&mut self) {
        self.steps = ObjectSteps::new(&self.camera, self.resolution);
        self.hidden.clear();
        self.is_complete = false;
    }

    /// Adds the objects that are complete after this number of tests.
    pub(super) fn draw(&mut self, tests: u64) {
        let wanted = self.comparison.object_tests.partition_point(|&until| until <= tests);
        self.is_complete = wanted == self.comparison.object_tests.len();
        // The last objects need not be drawn, because the frame itself is the complete picture.
        if self.is_complete || wanted == self.steps.drawn() as usize {
            return;
        }
        while (self.steps.drawn() as usize) < wanted && self.steps.draw_next(&self.scene) {}
        for (x, y) in (0..self.resolution.height()).flat_map(|y| (0..self.resolution.width()).map(move |x| (x, y))) {
            let Some((number, t)) = self.steps.nearest(x, y) else { continue };
            let last = self.comparison.nearest.at(x, y).map(|(last, _)| self.object_of_primitive(last));
            if last == Some(self.object_of_primitive(number)) {
                self.hidden.remove(&[x, y]);
            } else if self.hidden.get(&[x, y]).is_none_or(|(known, _)| *known != number) {
                self.hidden.insert([x, y], (number, self.primitive_color(x, y, number, t)));
            }
        }
    }

    /// Returns a pixel's colour: `empty` without an object, `final_color` if its object stays
    /// visible, else the colour that its object has until a later one hides it.
    pub(super) fn pixel_color(&self, x: u32, y: u32, empty: Srgb8, final_color: Srgb8) -> Srgb8 {
        if self.is_complete {
            return final_color;
        }
        match (self.steps.nearest(x, y), self.hidden.get(&[x, y])) {
            (None, _) => empty,
            (_, Some((_, color))) => *color,
            (Some(_), None) => final_color,
        }
    }

    /// Returns the object of a primitive, by its number.
    fn object_of_primitive(&self, primitive_number: u32) -> usize {
        self.starts.partition_point(|&start| start <= primitive_number).saturating_sub(1)
    }

    /// Returns the colour that a primitive has at a pixel where later ones hide it.
    fn primitive_color(&self, x: u32, y: u32, primitive_number: u32, t: f32) -> Srgb8 {
        let object = self.object_of_primitive(primitive_number);
        let [width, height] = [self.resolution.width() as f32, self.resolution.height() as f32];
        let ray = self.rays.through((x as f32 + 0.5) / width, (height - (y as f32 + 0.5)) / height);
        let primitive = primitive_number - self.starts[object];
        // A picture of one pixel is toned by the scene's curve, so that hidden and visible objects have the same
        // colours.
        let mut light = Framebuffer::new(Resolution::square(1, 1));
        light.pixels_mut()[0] = light_along(&self.scene, &ray, Hit { t, object: object as u32, primitive });
        tone(&light, &self.scene).pixels()[0]
    }
}

/// Returns the light that a hit sends back along the ray.
///
/// Unlike in `shade`, a pattern is sampled at the hit, not averaged over the pixel.
fn light_along(scene: &Scene, ray: &Ray, hit: Hit) -> LinearRgb {
    let surface = hit.surface(scene);
    let point = surface.at_crossing(ray, hit.t);
    let mut arriving = scene.ambient();
    for light in scene.lights() {
        let Some(incidence) = shade::incidence(light, &point) else { continue };
        if !(scene.shadows() && any_hit(scene, &shade::shadow_ray(light, &point), light.blocking_interval())) {
            arriving += incidence.light;
        }
    }
    let object = &scene.objects()[hit.object as usize];
    let reflectance = match &object.material {
        Material::Own => {
            object.own_reflectance(hit.primitive, &OwnPoint::from(&point)).unwrap_or(Material::DEFAULT_REFLECTANCE)
        }
        material => {
            let [r, g, b] = material.reflectance(point.uv.to_array(), [0.0; 2]);
            LinearRgb::new(r, g, b)
        }
    };
    LinearRgb::new(arriving.r * reflectance.r, arriving.g * reflectance.g, arriving.b * reflectance.b)
}
