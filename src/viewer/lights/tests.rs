use super::*;
use crate::camera::{Camera, Pose, ViewRectangle};
use crate::color::LinearRgb;
use crate::light::{PointLight, Sun};

#[test]
fn a_light_that_is_infinitely_far_cannot_be_held() {
    let pose = Pose { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(0.8).expect("an angle")).expect("a pose");
    let sun = Light::from(Sun { direction: Vec3::Y });
    let lamp = |x| PointLight::new(Vec3::X * x, LinearRgb::grey(1.0)).expect("a light");
    let lights = [sun, lamp(1.0).into(), sun, lamp(2.0).into()];
    let mut lights = Lights::new(Scene::new(camera, Vec::new()).with_lights(lights));
    let first = |lights: &[Light]| lights.iter().position(|light| light.position().is_some());
    let taken = [(); 4].map(|()| lights.take_next(first));
    assert_eq!(taken, [Some(1), Some(3), Some(1), Some(3)]);
    lights.move_held(Vec3::Z);
    assert_eq!((lights.held_position(), lights.held_position_in_file()), (Some(Vec3::Z), Some(Vec3::X * 2.0)));
    assert_eq!(Lights::new(Scene::new(camera, Vec::new()).with_lights([sun])).take_next(first), None);
}
