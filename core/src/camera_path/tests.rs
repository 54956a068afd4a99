use super::*;
use crate::camera::ViewRectangle;

fn camera(eye: [f32; 3], target: [f32; 3], fov: f32) -> Camera {
    let pose = Pose { eye: eye.into(), target: target.into(), up: Vec3::new(0.1, 2.0, -0.3) };
    Camera::new(pose, ViewRectangle::from_vertical_fov(fov).unwrap()).unwrap()
}

fn keyframe(time: f64, eye: [f32; 3]) -> Keyframe {
    Keyframe { time, camera: camera(eye, [0.0; 3], 0.7) }
}

fn eye(path: &CameraPath, time: f64) -> Vec3 {
    path.camera_at(time).unwrap().pose().eye
}

/// The eye's distance from the axis and its height along the axis are constant, also for a tilted
/// axis.
#[test]
fn an_orbit_keeps_its_height_and_its_radius() {
    let tilted =
        Pose { eye: Vec3::new(1.0, 2.0, 6.3), target: Vec3::new(0.5, 0.7, -0.2), up: Vec3::new(0.3, 2.0, -0.4) };
    let first = camera([0.0, 0.0, 1.0], [0.0; 3], 0.7).with_pose(tilted).unwrap();
    let path = CameraPath::orbit(first, 8.0);
    assert_eq!(path.camera_at(0.0), Ok(first), "to the last bit");
    let axis = tilted.up.normalize();
    let measure = |eye: Vec3| {
        let height = axis.dot(eye - tilted.target);
        (height, (eye - tilted.target - axis * height).length())
    };
    let (height, radius) = measure(tilted.eye);
    let cameras = path.cameras(80, 10).unwrap();
    assert_eq!(cameras.len(), 80);
    let mut angle = 0.0;
    for pair in cameras.windows(2) {
        let (now_height, now_radius) = measure(pair[1].pose().eye);
        assert!((now_height - height).abs() < 1e-5 && (now_radius - radius).abs() < 1e-5);
        assert_eq!((pair[1].pose().target, pair[1].pose().up), (tilted.target, tilted.up));
        let [before, now] = [pair[0], pair[1]].map(|camera| camera.pose().eye - tilted.target);
        let sine = axis.dot(before.cross(now)) / (radius * radius);
        assert!(sine > 0.0, "to the right");
        angle += libm::asinf(sine);
    }
    assert!((angle - std::f32::consts::TAU * 79.0 / 80.0).abs() < 1e-3, "all round but for the first frame: {angle}");
    assert!(eye(&path, 8.0).abs_diff_eq(tilted.eye, 1e-5), "the circle is closed");
}

#[test]
fn keyframes_are_passed_at_their_times_to_the_last_bit() {
    let keyframes = vec![
        Keyframe { time: 0.5, camera: camera([0.1, 0.7, 6.3], [0.3, 0.0, 0.0], 0.7) },
        Keyframe { time: 1.75, camera: camera([4.1, 0.2, 3.3], [0.0, 0.9, 0.0], 2.9) },
        Keyframe { time: 4.0, camera: camera([-4.1, 3.2, 3.3], [0.0, 0.0, 0.1], 0.01) },
    ];
    let path = CameraPath::through(keyframes.clone()).unwrap();
    for Keyframe { time, camera } in &keyframes {
        assert_eq!(path.camera_at(*time), Ok(*camera));
    }
    assert_eq!(path.camera_at(-1.0), Ok(keyframes[0].camera), "it stands still before");
    assert_eq!(path.camera_at(99.0), Ok(keyframes[2].camera), "and after");
    assert_eq!(path.camera_at(f64::NAN), Ok(keyframes[0].camera));
    assert_eq!(path.seconds(), 4.0);
}

/// Second differences of small steps are small, so neither position nor velocity jumps.
#[test]
fn a_path_is_smooth() {
    let path = CameraPath::through(vec![
        keyframe(0.0, [0.0, 1.0, 6.0]),
        keyframe(1.0, [5.0, 2.0, 4.0]),
        keyframe(1.5, [6.0, 0.0, 1.0]),
        keyframe(4.0, [2.0, 3.0, -5.0]),
    ])
    .unwrap();
    let step = 1.0 / 128.0;
    let eyes: Vec<DVec3> = (0..=512).map(|i| eye(&path, f64::from(i) * step).as_dvec3()).collect();
    for (i, three) in eyes.windows(3).enumerate() {
        let bend = (three[2] - three[1] - (three[1] - three[0])).length();
        assert!(bend < 0.01, "{bend} after {i} steps");
    }
}

/// Target and up vector are interpolated as the eye is.
#[test]
fn all_of_the_pose_moves() {
    let [from, to] = [camera([0.0, 0.0, 8.0], [0.0; 3], 0.7), camera([2.0, 0.0, 8.0], [0.0, 4.0, 0.0], 0.7)];
    let to = to.with_pose(Pose { up: Vec3::X, ..to.pose() }).unwrap();
    let keyframes = vec![Keyframe { time: 0.0, camera: from }, Keyframe { time: 4.0, camera: to }];
    let pose = CameraPath::through(keyframes).unwrap().camera_at(1.0).unwrap().pose();
    assert!(pose.eye.abs_diff_eq(Vec3::new(0.5, 0.0, 8.0), 1e-6), "{pose:?}");
    assert!(pose.target.abs_diff_eq(Vec3::new(0.0, 1.0, 0.0), 1e-6), "{pose:?}");
    let up = 0.75 * from.pose().up.normalize() + 0.25 * Vec3::X;
    assert!(pose.up.abs_diff_eq(up, 1e-6), "{pose:?}");
}

#[test]
fn two_keyframes_are_a_straight_line_at_even_speed() {
    let path = CameraPath::through(vec![keyframe(1.0, [0.0, 0.0, 4.0]), keyframe(3.0, [4.0, 2.0, 4.0])]).unwrap();
    for (time, expected) in [(1.5, [1.0, 0.5, 4.0]), (2.0, [2.0, 1.0, 4.0]), (2.5, [3.0, 1.5, 4.0])] {
        assert!(eye(&path, time).abs_diff_eq(Vec3::from(expected), 1e-6), "{}", eye(&path, time));
    }
}

#[test]
fn equal_keyframes_hold_the_camera_still() {
    let path = CameraPath::through(vec![
        keyframe(0.0, [0.1, 1.3, 6.7]),
        keyframe(1.0, [5.1, 2.3, 4.7]),
        keyframe(3.0, [5.1, 2.3, 4.7]),
        keyframe(4.0, [0.1, 2.3, 4.7]),
    ])
    .unwrap();
    for step in 0..=20 {
        assert_eq!(eye(&path, 1.0 + 0.1 * f64::from(step)), Vec3::new(5.1, 2.3, 4.7));
    }
    for step in 0..=40 {
        let rectangle = path.camera_at(0.1 * f64::from(step)).unwrap().rectangle();
        assert_eq!(rectangle, keyframe(0.0, [1.0; 3]).camera.rectangle(), "nothing is said of the lens");
    }
}

/// The velocity between a fast and a slow segment does not make the camera overshoot.
#[test]
fn unequal_times_do_not_throw_the_camera_out() {
    let path = CameraPath::through(vec![
        keyframe(0.0, [1.0, 0.0, 0.0]),
        keyframe(0.1, [6.0, 0.0, 0.0]),
        keyframe(5.0, [7.0, 0.0, 0.0]),
    ])
    .unwrap();
    let farthest = (0..500).map(|i| eye(&path, 0.01 * f64::from(i)).x).fold(0.0, f32::max);
    assert!(farthest < 8.0, "{farthest}");
}

#[test]
fn zooming_is_even_and_stays_an_angle() {
    let lens = |time, fov| Keyframe { time, camera: camera([0.0, 0.0, 5.0], [0.0; 3], fov) };
    let path = CameraPath::through(vec![lens(0.0, 0.1), lens(2.0, 3.1)]).unwrap();
    let height = |time| path.camera_at(time).unwrap().rectangle().height();
    assert!((height(1.0) / (height(0.0) * height(2.0)).sqrt() - 1.0).abs() < 1e-5, "the geometric mean");
    let path = CameraPath::through(vec![lens(0.0, 3.1), lens(1.0, 0.001), lens(2.0, 3.1), lens(3.0, 0.5)]).unwrap();
    assert!(path.cameras(300, 100).is_ok());
}

#[test]
fn an_eye_in_the_target_is_an_error_with_its_time() {
    let path = CameraPath::through(vec![keyframe(0.0, [0.0, 0.0, 4.0]), keyframe(2.0, [0.0, 0.0, -4.0])]).unwrap();
    let error = path.cameras(61, 30).unwrap_err();
    assert_eq!(error, PathError { time: 1.0, error: CameraError::EyeIsTarget });
    assert!(error.to_string().starts_with("at 1 seconds: the eye and the target are the same point"), "{error}");
}

#[test]
fn times_have_to_rise() {
    let at = |time| keyframe(time, [0.0, 0.0, 4.0]);
    assert!(CameraPath::through(vec![at(0.0)]).is_some());
    for times in [&[][..], &[0.0, 0.0], &[1.0, 0.5], &[0.0, f64::NAN, 1.0]] {
        assert!(CameraPath::through(times.iter().map(|&time| at(time)).collect()).is_none(), "{times:?}");
    }
}
