use super::super::jump::JUMP_TIME;
use super::*;
use crate::control::Keymap;
use crossterm::event::{KeyCode, KeyModifiers};

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn press(eye: &mut Eye, key: impl Into<KeyEvent>, scene: Option<&Scene>, now: Duration) {
    let key = key.into();
    let meant = Keymap::default().command(&[eye.mode(), KeyMode::Always], &key);
    if let Some(scene) = scene {
        eye.set_scene(scene);
    }
    eye.take_key(&key, meant, now);
}

/// Returns every shipped scene and mesh with its name.
fn shipped_scenes() -> Vec<(String, Scene)> {
    let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes")).unwrap();
    let files = folder.map(|file| file.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|ending| ending == "ron" || ending == "obj"));
    scenes.map(|path| (path.display().to_string(), Scene::load(&path).unwrap())).collect()
}

/// A tap of a movement key, with Shift too, passes no surface, not even the floor, but changes the
/// picture.
#[test]
fn no_tap_passes_a_surface_of_a_shipped_scene() {
    let scenes = shipped_scenes();
    assert!(scenes.len() >= 12);
    for (name, scene) in scenes {
        for (orbits, mode) in [(false, KeyMode::Fly), (true, KeyMode::Orbit)] {
            for key in Keymap::default().of(mode).flat_map(|row| row.keys.clone()) {
                for modifiers in [KeyModifiers::NONE, KeyModifiers::SHIFT] {
                    for reports_releases in [false, true] {
                        let mut eye = Eye::new(KeySpeed::default(), false);
                        eye.open(ViewState::initial(&scene, orbits));
                        eye.set_reports_releases(reports_releases, ms(0));
                        let key = KeyEvent::new(key.code, modifiers);
                        press(&mut eye, key, Some(&scene), ms(1_000));
                        let release = KeyEvent { kind: KeyEventKind::Release, ..key };
                        press(&mut eye, release, Some(&scene), ms(1_010));
                        let what = format!("{name}: {key:?} in {mode:?}, releases {reports_releases}");
                        assert_passes_nothing(&mut eye, &scene, &what);
                        assert!(eye.moved_camera().is_some() && !eye.is_moving(), "{what}");
                    }
                }
            }
        }
    }
}

/// Steps the eye frame by frame until it rests, and asserts that it passes no surface.
fn assert_passes_nothing(eye: &mut Eye, scene: &Scene, what: &str) {
    let mut last = *scene.camera();
    for at in (1_000..2_000).step_by(16) {
        eye.advance(ms(at));
        let now = eye.camera().unwrap();
        let [from, to] = [last, now].map(|camera| camera.pose().eye);
        let ray = Ray { origin: from, direction: to - from };
        assert!(from == to || !any_hit(scene, &ray, Interval { min: 0.0, max: 1.0 }), "{what}: {from} to {to}");
        last = now;
    }
}

/// Many taps of a key leave the eye in front of a surface; a held key moves it through, after a
/// stop.
#[test]
fn taps_never_pass_a_surface_and_held_keys_do() {
    let scene = Scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron").as_ref()).unwrap();
    let mut eye = Eye::new(KeySpeed::default(), false);
    eye.open(ViewState::initial(&scene, false));
    for tap in 0..30 {
        press(&mut eye, KeyCode::Char('c'), Some(&scene), ms(1_000 * (tap + 1)));
        eye.advance(ms(1_000 * (tap + 1) + 500));
    }
    let height = eye.camera().unwrap().pose().eye.y;
    assert!(height > 0.0 && height < 0.1, "{height}");
    for repeat in 0..40 {
        press(&mut eye, KeyCode::Char('c'), Some(&scene), ms(60_000 + 40 * repeat));
    }
    assert!(eye.camera().unwrap().pose().eye.y < -1.0);
}

/// If releases are reported, a key held with Shift moves the eye to the floor, stops it, and then
/// moves it on.
#[test]
fn a_held_key_stops_at_a_surface_for_half_a_second() {
    let (mut eye, _) = looking_at_spheres(false);
    eye.set_scene(&Scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron").as_ref()).unwrap());
    eye.set_reports_releases(true, ms(0));
    let key = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::SHIFT);
    let height_at = |eye: &mut Eye, from: u64, to: u64| {
        (from..to).step_by(16).for_each(|at| eye.advance(ms(at)));
        eye.camera().unwrap().pose().eye.y
    };
    press(&mut eye, key, None, ms(1_000));
    let height = height_at(&mut eye, 1_000, 1_600);
    assert!(height > 0.0 && height < 0.1, "{height}");
    press(&mut eye, KeyEvent { kind: KeyEventKind::Release, ..key }, None, ms(1_600));
    let height = height_at(&mut eye, 1_600, 2_900);
    assert!(height > 0.0 && height < 0.1 && !eye.is_moving(), "{height}");
    // Each press stops the eye at the floor again; if the key stays down, the eye then passes the floor.
    press(&mut eye, key, None, ms(3_000));
    assert!(height_at(&mut eye, 3_000, 3_400) > 0.0);
    assert!(height_at(&mut eye, 3_400, 4_000) < -1.0);
}

#[test]
fn a_step_of_reduced_motion_stops_at_a_surface_and_the_next_one_passes_it() {
    let scene = Scene::from_ron(
        "wall",
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Plane(point: (0, 0, 4.5), normal: (0, 0, 1))])",
    );
    let scene = scene.unwrap();
    let mut eye = Eye::new(KeySpeed::default(), true);
    eye.open(ViewState::initial(&scene, false));
    let key = KeyEvent::new(KeyCode::Char('w'), KeyModifiers::SHIFT);
    press(&mut eye, key, Some(&scene), ms(0));
    let z = eye.camera().unwrap().pose().eye.z;
    assert!(z > 4.5 && z < 4.8, "{z}");
    press(&mut eye, key, None, ms(0));
    let z = eye.camera().unwrap().pose().eye.z;
    assert!(z < 4.0, "{z}");
}

fn looking_at_spheres(reduced_motion: bool) -> (Eye, Camera) {
    let scene = Scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron").as_ref()).unwrap();
    let mut eye = Eye::new(KeySpeed::default(), reduced_motion);
    eye.open(ViewState::initial(&scene, false));
    (eye, *scene.camera())
}

#[test]
fn a_jump_is_eased_and_ends_exactly_at_its_view() {
    let (mut eye, home) = looking_at_spheres(false);
    let far = home.orbited(3.0, 0.2).zoomed(0.5).nearer(1.5);
    eye.jump(ms(1_000), |_| far);
    let mut last = home;
    let mut steps = Vec::new();
    for at in (1_000..1_200).step_by(10) {
        eye.advance(ms(at));
        let camera = eye.camera().unwrap();
        assert_ne!(camera, last, "{at}");
        steps.push(camera.pose().eye.distance(last.pose().eye));
        last = camera;
    }
    assert!(steps[10] > 2.0 * steps[2] && steps[10] > 2.0 * steps[18], "slow at both ends: {steps:?}");
    let distances: Vec<_> = [home, last, far].iter().map(Camera::target_distance).collect();
    assert!(distances.is_sorted(), "the way leads around the target: {distances:?}");
    eye.advance(ms(1_000) + JUMP_TIME);
    assert!(eye.camera() == Some(far) && !eye.is_moving());
}

/// A key pressed during a jump acts at once, on the view at the end of the jump.
#[test]
fn a_press_ends_a_jump_at_once_and_a_release_does_not() {
    let (mut eye, home) = looking_at_spheres(false);
    let far = home.orbited(1.0, 0.0);
    eye.jump(ms(1_000), |_| far);
    let release = KeyEvent { kind: KeyEventKind::Release, ..KeyCode::Char('f').into() };
    press(&mut eye, release, None, ms(1_050));
    assert_ne!(eye.camera(), Some(far));
    press(&mut eye, KeyCode::Char('i'), None, ms(1_050));
    assert!(eye.camera() == Some(far) && !eye.is_moving());
    eye.jump(ms(2_000), |_| home);
    press(&mut eye, KeyCode::Char('w'), None, ms(2_050));
    assert!(eye.camera() == Some(home) && eye.is_moving());
    // With reduced motion a jump has no frames in between.
    let (mut eye, _) = looking_at_spheres(true);
    eye.jump(ms(1_000), |_| far);
    assert!(eye.camera() == Some(far) && !eye.is_moving());
}

#[test]
fn a_held_key_goes_on_after_a_jump() {
    let (mut eye, home) = looking_at_spheres(false);
    eye.set_reports_releases(true, ms(0));
    press(&mut eye, KeyCode::Char('w'), None, ms(500));
    eye.reset(ms(1_000));
    eye.advance(ms(1_000) + JUMP_TIME);
    let way = eye.camera().unwrap().pose().eye.distance(home.pose().eye);
    assert!(eye.is_moving() && way < 0.06, "{way}");
    eye.advance(ms(2_000) + JUMP_TIME);
    let way = eye.camera().unwrap().pose().eye.distance(home.pose().eye);
    assert!((way - 3.2).abs() < 0.1, "{way}");
}

#[test]
fn views_that_were_left_by_jumps_are_returned_to() {
    let (mut eye, home) = looking_at_spheres(true);
    let [a, b, c] = [0.1, 0.2, 0.3].map(|angle| home.orbited(angle, 0.0));
    let at = ms(0);
    assert!(!eye.retrace(false, at) && !eye.retrace(true, at));
    for to in [a, b, b, c] {
        eye.jump(at, |_| to);
    }
    for (forward, camera) in [(false, b), (false, a), (true, b), (false, a), (false, home)] {
        assert!(eye.retrace(forward, at));
        assert_eq!(eye.camera(), Some(camera));
    }
    assert!(!eye.retrace(false, at));
    // A view that keys have changed is recorded too, when a jump leaves it.
    eye.change(at, |camera, _| camera.orbited(1.0, 0.0));
    let composed = eye.camera();
    eye.reset(at);
    assert!(eye.camera() == Some(home) && !eye.retrace(true, at), "a jump ends the way forward");
    assert!(eye.retrace(false, at));
    assert_eq!(eye.camera(), composed);
    for turn in 0..100_u8 {
        eye.jump(at, |camera| camera.orbited(0.01 + f32::from(turn) * 0.001, 0.0));
    }
    assert_eq!((0..200).filter(|_| eye.retrace(false, at)).count(), 64, "bounded");
}
