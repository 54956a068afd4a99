use super::*;
use glam::Vec3;

fn spheres() -> Scene {
    Scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron").as_ref()).unwrap()
}

fn hiding(scene: &Scene, eye: Vec3, target: Vec3) -> Option<Hiding> {
    let camera = scene.camera().with_pose(Pose { eye, target, up: Vec3::Y }).unwrap();
    Hiding::find(scene, &camera, 1.6)
}

#[test]
fn a_view_without_anything_visible_has_a_reason() {
    let scene = spheres();
    assert_eq!(Hiding::find(&scene, scene.camera(), 1.6), None);
    let is_sphere = |object: &&crate::scene::Object| object.shape.kind() == "sphere";
    let bounds = scene.objects().iter().find(is_sphere).and_then(|object| object.shape.bounds()).unwrap();
    let middle = bounds.min + 0.5 * bounds.extent();
    let inside = hiding(&scene, middle, middle + Vec3::X);
    assert!(matches!(&inside, Some(Hiding::Inside(hidden)) if hidden.name.ends_with(" sphere")), "{inside:?}");
    assert_eq!(hiding(&scene, Vec3::new(0.0, 9.0, 0.0), Vec3::new(0.0, 10.0, 0.1)), Some(Hiding::Nothing));
    let below = hiding(&scene, Vec3::new(0.0, -3.0, 6.0), Vec3::new(0.0, 0.0, -6.0));
    assert!(matches!(&below, Some(Hiding::Behind(hidden)) if hidden.name.ends_with(" plane")), "{below:?}");
    let empty = Scene::from_ron("empty", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").unwrap();
    assert_eq!(Hiding::find(&empty, empty.camera(), 1.6), None);
}

#[test]
fn each_version_of_the_notice_is_shorter() {
    let keys = "r first view, f frame all";
    let notice = LostNotice::new(&Hiding::Inside(Hidden { number: 1, name: "red sphere".to_owned() }), keys);
    assert_eq!(notice.0[0], "inside object 1 (red sphere): r first view, f frame all");
    assert!(notice.0.is_sorted_by(|a, b| a.len() > b.len()), "{:?}", notice.0);
    assert!(notice.0.last().is_some_and(|text| text.len() + 2 <= 39), "{:?}", notice.0);
    assert_eq!(LostNotice::new(&Hiding::Nothing, "").0, ["nothing in view", "lost"]);
}
