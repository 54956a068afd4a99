use super::*;
use crate::camera::{Camera, Pose, ViewRectangle};
use crate::color::LinearRgb;
use crate::light::PointLight;

fn scene(lights: Vec<Light>) -> Scene {
    let pose = Pose { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(0.8).expect("an angle")).expect("a pose");
    Scene::new(camera, Vec::new()).with_lights(lights)
}

#[test]
fn a_light_that_is_infinitely_far_cannot_be_held() {
    // Lights 0 and 2 are infinitely far.
    let next = |held| next_after(held, 4, |light| light % 2 == 1);
    assert_eq!([next(1), next(3)], [Some(3), Some(1)]);
    assert_eq!(next_after(0, 1, |_| false), None);
    assert_eq!(Lights::new(scene(Vec::new())).cycle_held(|_| None), None);
}

#[test]
fn each_light_is_held_in_turn_and_moved() {
    let lamp = |x| PointLight::new(Vec3::X * x, LinearRgb::grey(1.0)).expect("a light").into();
    let mut lights = Lights::new(scene(vec![lamp(1.0), lamp(2.0)]));
    let taken = [(); 4].map(|()| lights.cycle_held(|_| Some(1)));
    assert_eq!(taken, [Some(1), Some(0), Some(1), Some(0)]);
    lights.move_held(Vec3::Z);
    assert_eq!((lights.held_position(), lights.held_position_in_file()), (Some(Vec3::Z), Some(Vec3::X)));
}
