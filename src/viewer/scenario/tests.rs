use super::*;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// Bytes of keys that are bound to a command in some mode.
const KEYS: &[u8] = b"wasdqezxhjklfogtvVcnNpPimLr?1[]<>\t\x1b 5";

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn the_rules_hold_in_any_story(scenario in vec(any::<u8>(), 0..300)) {
        run_scenario(&scenario);
    }

    /// The rules of `run_scenario` hold if bound keys are pressed while a scene is shown.
    #[test]
    fn the_rules_hold_whatever_keys_are_pressed(
        keys in vec((select(KEYS), 0_u8..9, any::<u8>()), 0..60),
    ) {
        let shown = [6, 0, 0, 3, 1, 5, 4];
        let pressed = keys.into_iter().flat_map(|(key, event, more)| [0, 1, key, event, more, 3, 2, 4]);
        run_scenario(&shown.into_iter().chain(pressed).collect::<Vec<_>>());
    }
}

/// A scene is drawn when its first frame is finished, and a movement key begins another frame.
#[test]
fn a_scene_is_drawn_and_moves() {
    let mut driver = Driver::new(0);
    driver.viewer.show(SCENES[0].clone(), 0, false);
    driver.carry_out_steps();
    assert!(driver.job.is_some() && !driver.viewer.has_shown());
    driver.finish_job(5);
    driver.carry_out_steps();
    assert!(driver.viewer.has_shown());
    driver.come_to_rest();
    let home = driver.viewer.moved_camera();
    driver.receive(b"w");
    driver.now += Duration::from_millis(100);
    driver.carry_out_steps();
    assert!(home.is_none() && driver.viewer.moved_camera().is_some(), "{home:?}");
    assert!(driver.job.is_some());
    driver.come_to_rest();
}

/// A wall that moves away stops the eye where it is now, not where it was at time 0.
#[test]
fn an_eye_stops_at_a_moving_surface_where_it_is_now() {
    let wall = Scene::from_ron(
        "wall",
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Implicit(f: \"z - 4.5 + 4*time\", \
         bounds: Box(min: (-9, -9, -9), max: (9, 9, 6)))])",
    );
    let mut driver = Driver::new(0);
    driver.viewer.show(wall.unwrap(), 0, false);
    let eye_after_key = |driver: &mut Driver| {
        driver.receive(b"W");
        (0..5).for_each(|_| {
            driver.now += Duration::from_millis(100);
            driver.carry_out_steps();
        });
        driver.viewer.moved_camera().map_or(5.0, |camera| camera.pose().eye.z)
    };
    driver.carry_out_steps();
    driver.now += Duration::from_millis(900);
    driver.carry_out_steps();
    let z = eye_after_key(&mut driver);
    assert!(z < 4.4, "{z}: the wall has moved away");
}
