use super::*;
use glam::Vec3;

#[test]
fn the_first_eye_and_its_target_are_seen_from_outside() {
    for (eye, target, up) in [
        (Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, Vec3::Y),
        (Vec3::new(1e4, 0.0, 0.0), Vec3::ZERO, Vec3::Y),
        (Vec3::new(0.0, 9.0, 0.1), Vec3::ZERO, -Vec3::Z),
    ] {
        let first = Camera::look_at(Vec3::new(0.0, 0.0, 1.0), Vec3::ZERO)
            .and_then(|camera| camera.with_pose(Pose { eye, target, up }));
        let first = first.expect("a camera");
        let second = camera_beside(&Scene::new(first, Vec::new()), &first, 0.8);
        for point in [eye, target] {
            let place = second.project(point, 0.8).expect("in front of the second eye");
            assert!(place.min_element() > 0.0 && place.max_element() < 1.0, "{eye} {place}");
        }
    }
}

#[test]
fn no_wall_is_between_both_eyes() {
    let text = include_str!("../../../scenes/corridor.ron");
    let scene = Scene::from_ron("corridor", text).expect("a scene");
    let second = camera_beside(&scene, scene.camera(), 0.8).pose().eye;
    let origin = scene.camera().pose().eye;
    let hit = closest_hit(&scene, &Ray { origin, direction: second - origin }).expect("a wall behind the second eye");
    assert!(hit.t > 1.05 && second.distance(origin) > 0.5, "{hit:?} {second}");
}
