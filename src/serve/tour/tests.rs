use super::*;

const MS: Duration = Duration::from_millis(1);

fn limits(change: impl FnOnce(&mut Settings)) -> AudienceLimits {
    let mut settings = Settings::new("key".into());
    change(&mut settings);
    AudienceLimits::new(&settings)
}

#[test]
fn a_tour_starts_again_at_its_end() {
    let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").expect("a scene");
    let path = CameraPath::orbit(*scene.camera(), 2.0);
    let [name, file, title] = ["x", "x.ron", ""].map(str::to_owned);
    let hosted = HostedScene { name, file, title, scene, orbits: false };
    let tour = Tour::new(&path, &hosted).expect("a tour");
    assert_eq!((Tour::tick_at(1999 * MS), Tour::tick_at(2000 * MS)), (19, 20));
    assert_eq!(tour.camera(0), tour.camera(20));
    assert_ne!(tour.camera(0), tour.camera(10));
    assert_eq!(tour.camera(u64::MAX), tour.camera(u64::MAX % 20));
}

#[test]
fn frames_follow_at_ticks_and_within_the_limits() {
    let usual = limits(|_| {});
    assert_eq!(usual.next_frame_at(1000 * MS, 3000), 1100 * MS);
    assert_eq!(usual.next_frame_at(1050 * MS, 3000), 1100 * MS);
    // 100 kB at 200 kB per second.
    assert_eq!(usual.next_frame_at(1000 * MS, 100_000), 1500 * MS);
    let unlimited = limits(|settings| settings.max_rate = None);
    assert_eq!(unlimited.next_frame_at(1000 * MS, 100_000), 1100 * MS);
    let slow = limits(|settings| settings.max_frames = 2.0);
    assert_eq!(slow.next_frame_at(1000 * MS, 0), 1450 * MS);
}
