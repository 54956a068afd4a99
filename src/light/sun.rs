//! Directional light, for tests: a new light takes one file and one line in the table.

use super::LightSource;
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::ray::Interval;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::Vec3;

/// White directional light with the same irradiance everywhere.
///
/// A white surface that faces it has the radiance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction to the light. Unit length.
    pub direction: Vec3,
}

impl LightSource for Sun {
    /// An object blocks the light at any distance.
    const IN_THE_WAY: Interval = Interval { min: f32::MIN_POSITIVE, max: f32::INFINITY };

    #[inline(always)]
    fn to_light<N: Number>(&self, _: Vector<N>) -> Vector<N> {
        Vector::splat(self.direction)
    }

    #[inline(always)]
    fn irradiance<N: Number>(&self, _: Vector<N>, _: N, cosine: N) -> [N; 3] {
        [cosine; 3]
    }

    fn color(&self) -> LinearRgb {
        LinearRgb::grey(1.0)
    }

    fn check(&written: &Option<WrittenVector>, validator: &mut Validator<'_>) -> Option<Self> {
        Some(Self { direction: validator.unit_vector("direction", written?)?.as_vec3() })
    }
}

impl InSceneFile for Sun {
    /// The written direction.
    type Written = Option<WrittenVector>;

    const NAME: &'static str = "Sun";
    const OWNER: &'static str = "a Sun";
    const FORM: &'static str = "Sun(direction: ...)";
    const FIELDS: &'static [&'static str] = &["direction"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Option<WrittenVector> {
        reader.required(fields, "direction", NodeReader::direction)
    }
}

#[cfg(test)]
mod tests {
    use crate::describe::describe;
    use crate::explain::explain;
    use crate::framebuffer::Resolution;
    use crate::render::{Sampling, render};
    use crate::scene::Scene;

    /// Returns the text of a scene: a floor seen from above, a sun, and other objects.
    fn scene(sun: &str, objects: &str) -> String {
        let camera = "camera: (eye: (0, 5, 0.01), target: (0, 0, 0))";
        let floor = "Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Diffuse(0.5))";
        format!("({camera}, lights: [{sun}], objects: [{floor}, {objects}])")
    }

    fn read(sun: &str, objects: &str) -> Scene {
        Scene::from_ron("sun.ron", &scene(sun, objects)).expect("a scene")
    }

    /// The floor's light is 0.5 times the cosine, 0.8, or 0 if an object blocks the sun.
    #[test]
    fn its_light_is_that_of_the_closed_form() {
        let resolution = Resolution::square(9, 9);
        for (objects, wanted) in [("", 0.4), ("Sphere(center: (3000, 4000, 0), radius: 100)", 0.0)] {
            let scene = read("Sun(direction: (3, 4, 0))", objects);
            let picture = render(&scene, scene.camera(), resolution, Sampling::BEST);
            assert!(picture.pixels().iter().all(|light| (light.r - wanted).abs() < 1e-6), "{objects}: {picture:?}");
        }
    }

    #[test]
    fn it_is_described_and_explained() {
        let scene = read("Sun(direction: (0, 0, 1))", "");
        let text = describe("sun.ron", &scene, scene.camera(), Resolution::square(40, 40));
        assert!(text.contains("- white, from below\n"), "{text}");
        let explained = explain(&scene, scene.camera(), Resolution::square(9, 9), [4, 4]).lines().join("\n");
        assert!(explained.contains("light 1: infinitely far"), "{explained}");
    }

    #[test]
    fn its_faults_have_the_messages_of_other_lights() {
        let message = |sun: &str| Scene::from_ron("x.ron", &scene(sun, "")).expect_err("a fault").to_string();
        assert!(message("Sun()").contains("missing field \"direction\"; a Sun needs one"));
        assert!(message("Sun(direction: (0, 0, 0))").contains("the direction must have a length"));
        assert!(message("Sum(direction: (0, 0, 1))").contains("did you mean Sun?"));
    }
}
