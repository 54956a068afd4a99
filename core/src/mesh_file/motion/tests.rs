use super::*;
use glam::Vec3;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

fn track<const N: usize>(keys: &[(f32, [f32; N])], interpolation: Interpolation) -> Track<N> {
    let times: Vec<_> = keys.iter().map(|&(time, _)| time).collect();
    let values: Vec<_> = keys.iter().map(|&(_, value)| value).collect();
    Track::new(KeyTimes::new(times).expect("times"), values.into(), interpolation).expect("key frames")
}

/// The quaternion of a rotation about the y axis.
fn about_y(angle: f64) -> [f32; 4] {
    [0.0, libm::sin(angle / 2.0) as f32, 0.0, libm::cos(angle / 2.0) as f32]
}

fn fixed() -> MovingNode {
    MovingNode {
        parent: None,
        above: DMat4::IDENTITY,
        translation: Channel::Constant([0.0; 3]),
        rotation: Channel::Constant([0.0, 0.0, 0.0, 1.0]),
        scale: Channel::Constant([1.0; 3]),
    }
}

/// A motion of 2 seconds, with a triangle at each node.
fn motion(nodes: Vec<MovingNode>) -> Motion {
    let mesh = Arc::new(MeshFile::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).expect("a triangle"));
    let part = |node| MovingPart { node, below: DMat4::IDENTITY, mesh: Arc::clone(&mesh) };
    Motion { length: 2.0, parts: (0..nodes.len()).map(part).collect(), nodes, still: None, turn: DMat3::IDENTITY }
}

fn is_near(a: DVec3, b: DVec3) -> bool {
    a.distance(b) < 1e-6
}

#[test]
fn a_rotation_has_an_even_speed() {
    let rotation = track(&[(0.0, about_y(0.0)), (2.0, about_y(FRAC_PI_2))], Interpolation::Linear);
    let moving = motion(vec![MovingNode { rotation: Channel::Track(rotation), ..fixed() }]);
    let x_at = |seconds| moving.transforms_at(seconds)[0].transform_vector3(DVec3::X);
    // A quarter turn in two seconds: at half the time an eighth, at a third of the time a twelfth.
    assert!(is_near(x_at(0.0), DVec3::X));
    assert!(is_near(x_at(1.0), DVec3::new(FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2)), "{}", x_at(1.0));
    assert!(is_near(x_at(2.0 / 3.0), DVec3::new(0.75_f64.sqrt(), 0.0, -0.5)), "{}", x_at(2.0 / 3.0));
}

#[test]
fn a_rotation_takes_the_shortest_way() {
    let [x, y, z, w] = about_y(FRAC_PI_2);
    let rotation = track(&[(0.0, about_y(0.0)), (2.0, [-x, -y, -z, -w])], Interpolation::Linear);
    let half = unit(rotation.rotation_at(1.0)) * DVec3::X;
    assert!(is_near(half, DVec3::new(FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2)), "{half}");
    // Equal rotations, and opposite ones, between which the angle is 0.
    for other in [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, -1.0]] {
        let rotation = track(&[(0.0, about_y(0.0)), (2.0, other)], Interpolation::Linear);
        assert!(is_near(unit(rotation.rotation_at(1.0)) * DVec3::X, DVec3::X));
    }
}

#[test]
fn values_between_key_frames_follow_their_interpolation() {
    let keys = [(1.0, [0.0, 0.0, 0.0]), (3.0, [4.0, 0.0, -8.0])];
    let (linear, step) = (track(&keys, Interpolation::Linear), track(&keys, Interpolation::Step));
    assert_eq!(linear.at(1.5), [1.0, 0.0, -2.0]);
    assert_eq!([step.at(1.0), step.at(2.999), step.at(3.0)], [[0.0; 3], [0.0; 3], [4.0, 0.0, -8.0]]);
    // Before the first and after the last key frame.
    assert_eq!([linear.at(0.0), linear.at(9.0)], [[0.0; 3], [4.0, 0.0, -8.0]]);
    // The parabola of t^2 from 1 to 3, whose slopes are 2 and 6, is its own cubic.
    let values: Vec<[f32; 3]> = [9.0, 1.0, 2.0, 6.0, 9.0, 7.0].map(|value| [value; 3]).into();
    let spline = Track::new(KeyTimes::new(vec![1.0, 3.0]).expect("times"), values.into(), Interpolation::CubicSpline)
        .expect("key frames");
    assert_eq!([spline.at(0.0)[0], spline.at(1.5)[0], spline.at(2.0)[1], spline.at(3.0)[2]], [1.0, 2.25, 4.0, 9.0]);
    // Of two key frames at one time the last counts.
    let jump = track(&[(0.0, [0.0; 3]), (1.0, [1.0; 3]), (1.0, [5.0; 3])], Interpolation::Linear);
    assert_eq!([jump.at(0.5), jump.at(1.0)], [[0.5; 3], [5.0; 3]]);
}

#[test]
fn key_frames_without_order_or_values_are_refused() {
    let new = |times: &[f32], count: usize, interpolation| {
        Track::<3>::new(KeyTimes::new(times.to_vec())?, vec![[0.0; 3]; count].into(), interpolation)
    };
    assert!(new(&[], 0, Interpolation::Linear).is_none());
    assert!(new(&[1.0, 0.0], 2, Interpolation::Linear).is_none());
    assert!(new(&[0.0, f32::NAN], 2, Interpolation::Linear).is_none());
    assert!(new(&[0.0, 1.0], 2, Interpolation::CubicSpline).is_none());
    assert!(new(&[0.0], 1, Interpolation::Linear).is_some());
}

#[test]
fn the_motion_starts_again_after_its_length() {
    let translation = track(&[(0.0, [0.0; 3]), (2.0, [2.0, 0.0, 0.0])], Interpolation::Linear);
    let moving = motion(vec![MovingNode { translation: Channel::Track(translation), ..fixed() }]);
    let x_at = |seconds| moving.transforms_at(seconds)[0].w_axis.x;
    assert_eq!([0.5, 2.0, 2.5, 200.5, -0.5].map(x_at), [0.5, 0.0, 0.5, 0.5, 1.5]);
}

#[test]
fn a_node_moves_what_is_below_it() {
    let translation = track(&[(0.0, [0.0; 3]), (2.0, [0.0, 2.0, 0.0])], Interpolation::Linear);
    let rotation = track(&[(0.0, about_y(0.0)), (1.0, about_y(FRAC_PI_2))], Interpolation::Linear);
    let arm = MovingNode { rotation: Channel::Track(rotation), ..fixed() };
    let above = DMat4::from_translation(DVec3::new(3.0, 0.0, 0.0));
    let hand = MovingNode { parent: Some(0), above, translation: Channel::Track(translation), ..fixed() };
    let moving = motion(vec![arm, hand]);
    let hand_at = |moving: &Motion, seconds| moving.transforms_at(seconds)[1].transform_point3(DVec3::ZERO);
    assert!(is_near(hand_at(&moving, 0.0), DVec3::new(3.0, 0.0, 0.0)));
    assert!(is_near(hand_at(&moving, 1.0), DVec3::new(0.0, 1.0, -3.0)), "{}", hand_at(&moving, 1.0));
    // The whole turned, so that its +z axis points up.
    let turned = moving.turned(crate::mesh_file::UpAxis::Z.turn()).expect("a motion");
    assert!(is_near(hand_at(&turned, 1.0), DVec3::new(0.0, -3.0, -1.0)), "{}", hand_at(&turned, 1.0));
}
