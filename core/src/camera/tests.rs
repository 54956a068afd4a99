//! Tests of camera motions of every size, from every side, in small and large scenes.

use super::motion::{MAX_TARGET_DISTANCE, MIN_TARGET_DISTANCE};
use super::on_screen::WHEEL_NOTCH_FACTOR;
use super::*;
use crate::bounds::Bounds;

fn camera(eye: Vec3, target: Vec3) -> Camera {
    let rectangle = ViewRectangle::from_vertical_fov(0.7).expect("an angle");
    Camera::new(Pose { eye, target, up: Vec3::Y }, rectangle).expect("a pose")
}

/// Returns the position of a point in the picture, from -1 at the left and lower border to 1.
fn position_in_picture(camera: &Camera, point: Vec3, aspect_ratio: f32) -> Vec2 {
    let place = camera.project(point, aspect_ratio).expect("it is in front of the eye");
    (2.0 * place - 1.0) * Vec2::new(1.0, -1.0)
}

#[test]
fn a_point_is_where_its_ray_is() {
    let camera = camera(Vec3::new(1.0, 2.0, 7.0), Vec3::ZERO);
    let shifted = camera.with_rectangle(camera.rectangle().with_shift(Vec2::new(0.2, -0.3)).expect("finite"));
    let tilted = shifted.with_rectangle(shifted.rectangle().with_tilt(Vec2::new(0.5, -0.7)).expect("in front"));
    for camera in [camera, shifted, tilted] {
        let ray = camera.eye_rays(1.6).through(0.3, 0.6);
        assert!(camera.project(ray.at(4.0), 1.6).expect("in front").abs_diff_eq(Vec2::new(0.3, 0.4), 1e-5));
        assert_eq!(camera.project(ray.at(-1.0), 1.6), None);
        assert_eq!(camera.project(ray.origin, 1.6), None);
        let dragged = camera.point_dragged(ray.at(4.0), Vec2::new(0.1, 0.2), 1.6);
        assert!(camera.project(dragged, 1.6).expect("in front").abs_diff_eq(Vec2::new(0.4, 0.6), 1e-5));
        assert!(
            camera
                .point_pushed_away(ray.at(4.0), 2.0)
                .abs_diff_eq(ray.at(4.0 / (WHEEL_NOTCH_FACTOR * WHEEL_NOTCH_FACTOR)), 1e-4)
        );
        let behind = camera.point_dragged(ray.at(-1.0), Vec2::new(0.1, 0.0), 1.6);
        assert!((behind - ray.at(-1.0)).dot(camera.basis().u) > 0.0, "as on the screen");
    }
}

fn corners(bounds: &Bounds) -> impl Iterator<Item = Vec3> {
    let Bounds { min, max } = *bounds;
    [min, max]
        .into_iter()
        .flat_map(move |x| [min, max].into_iter().flat_map(move |y| [min, max].map(move |z| Vec3::new(x.x, y.y, z.z))))
}

#[test]
fn all_corners_of_what_is_framed_are_in_the_picture_and_one_is_at_its_side() {
    let boxes = [Bounds { min: -Vec3::ONE, max: Vec3::ONE }, Bounds { min: Vec3::ZERO, max: Vec3::new(9.0, 1.0, 2.0) }];
    let shifted = |camera: Camera, shift| camera.with_rectangle(camera.rectangle().with_shift(shift).expect("finite"));
    for scale in [1e-4, 1.0, 1e6] {
        for bounds in boxes.map(|Bounds { min, max }| Bounds { min: scale * min, max: scale * max }) {
            for eye in [Vec3::new(1.0, 2.0, 7.0), Vec3::new(-3.0, -1.0, 0.2), Vec3::new(0.0, 9.0, 0.1)] {
                let (none, shift, tilt) = (Vec2::ZERO, Vec2::new(0.2, -0.3), Vec2::new(-0.3, 0.8));
                for (aspect_ratio, shift, tilt) in
                    [(1.6, none, none), (0.5, none, none), (1.6, shift, none), (1.6, none, tilt), (1.6, shift, tilt)]
                {
                    let before = shifted(camera(scale * eye, Vec3::ZERO), shift);
                    let before = before.with_rectangle(before.rectangle().with_tilt(tilt).expect("in front"));
                    let after = before.framing(&bounds, aspect_ratio);
                    assert!(after.basis().w.abs_diff_eq(before.basis().w, 1e-4), "the direction stays");
                    let places = corners(&bounds)
                        .map(|corner| position_in_picture(&after, corner, aspect_ratio).abs().max_element());
                    let most = places.fold(0.0, f32::max);
                    assert!(
                        (most - FRAMED_SHARE).abs() < 1e-3,
                        "{bounds:?} {eye} {aspect_ratio} {shift} {tilt}: {most}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_point_cannot_be_framed() {
    let before = camera(Vec3::Z, Vec3::ZERO);
    assert_eq!(before.framing(&Bounds { min: Vec3::X, max: Vec3::X }, 1.0), before);
}

#[test]
fn a_jump_leads_evenly_to_another_rectangle() {
    let start = camera(Vec3::Z, Vec3::ZERO);
    let end =
        start.with_rectangle(start.rectangle().with_shift(Vec2::X).and_then(|r| r.with_tilt(Vec2::Y)).expect("one"));
    let half = start.interpolated(&end, 0.5).rectangle();
    assert_eq!((half.shift(), half.tilt()), (0.5 * Vec2::X, 0.5 * Vec2::Y));
    assert_eq!(start.interpolated(&end, 1.0), end);
}

/// Many orbits in small steps keep the distance, the up direction and the target.
#[test]
fn the_eye_never_turns_over_a_pole() {
    for scale in [1e-3, 1.0, 1e7] {
        let target = scale * Vec3::new(1.0, 2.0, 3.0);
        let mut camera = camera(target + scale * Vec3::new(0.0, 1.0, 4.0), target);
        for step in 0..400 {
            let upwards = if step % 200 < 100 { 0.1 } else { -0.1 };
            camera = camera.orbited(-0.3, upwards);
            let (pose, basis) = (camera.pose(), camera.basis());
            assert_eq!(pose.target, target);
            assert!((pose.eye.distance(target) / (scale * 17f32.sqrt()) - 1.0).abs() < 1e-2, "{pose:?}");
            assert!(basis.v.y > 0.0 && basis.w.y.abs() < 1.0, "{basis:?}");
        }
    }
}

#[test]
fn the_eye_never_goes_through_the_target_nor_to_infinity() {
    for size in [1e-6, 1.0, 1e4] {
        let start = camera(Vec3::new(0.0, 0.0, size), Vec3::ZERO);
        let (mut near, mut far) = (start, start);
        for _ in 0..200 {
            near = near.nearer_within(0.5, size);
            far = far.nearer_within(2.0, size);
        }
        for (camera, distance) in [(near, MIN_TARGET_DISTANCE * size), (far, MAX_TARGET_DISTANCE * size)] {
            assert_eq!(camera.basis().w, Vec3::Z);
            assert!((camera.pose().eye.z / distance - 1.0).abs() < 1e-3, "{:?}", camera.pose());
        }
    }
    // Far from the origin the spacing of f32 limits how near the eye can come.
    let target = Vec3::splat(1e6);
    let mut camera = camera(target + Vec3::Z, target);
    for _ in 0..200 {
        camera = camera.nearer_within(0.5, 1.0);
    }
    assert!(camera.pose().eye.distance(target) > 0.0);
}

#[test]
fn a_field_of_view_has_its_limits() {
    let start = camera(Vec3::Z, Vec3::ZERO);
    let after = |factor| (0..300).fold(start, |camera, _| camera.zoomed(factor)).rectangle().vertical_fov();
    assert!((after(0.9).to_degrees() - 1.0).abs() < 1e-2 && (after(1.1).to_degrees() - 150.0).abs() < 1e-2);
    let near = start.zoomed(0.5).rectangle().height();
    assert!((near / start.rectangle().height() - 0.5).abs() < 1e-6);
    assert_eq!(start.zoomed(0.5).pose(), start.pose());
}

#[test]
fn a_dragged_point_follows_the_pointer() {
    let start = camera(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
    let aspect_ratio = 1.6;
    let by = Vec2::new(0.2, 0.1);
    let after = start.panned(by, aspect_ratio);
    // `position_in_picture` counts from the middle, in halves of the picture, upwards.
    let at = position_in_picture(&after, Vec3::ZERO, aspect_ratio);
    assert!(at.abs_diff_eq(Vec2::new(0.4, -0.2), 1e-5), "{at}");
    assert!(after.basis().w.abs_diff_eq(Vec3::Z, 1e-6));
    let at = position_in_picture(&start.dragged_view(by, aspect_ratio), Vec3::ZERO, aspect_ratio);
    assert!(at.abs_diff_eq(Vec2::new(0.4, -0.2), 0.02), "the middle stays about under the pointer: {at}");
    let around = start.dragged_around(Vec2::new(0.5 / aspect_ratio, 0.0), aspect_ratio).pose();
    assert!(around.eye.abs_diff_eq(-5.0 * Vec3::X, 1e-4), "what is before it goes to the right: {around:?}");
    assert_eq!(around.target, Vec3::ZERO);
    let above = start.dragged_around(Vec2::new(0.0, 0.25), aspect_ratio).pose();
    assert!(above.eye.abs_diff_eq(3.535_534 * Vec3::new(0.0, 1.0, 1.0), 1e-4), "{above:?}");
}

#[test]
fn the_wheel_comes_nearer_to_a_point_which_stays_where_it_is() {
    let start = camera(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
    for point in [Vec3::new(1.0, 0.5, 1.0), Vec3::new(-1.0, 0.0, -20.0)] {
        for notches in [1.0, -1.0, 7.0] {
            let nearer = [start.scaled_about(point, notches, 1.0), start.wheeled(point, notches)];
            let share = libm::powf(WHEEL_NOTCH_FACTOR, notches);
            for (after, target) in nearer.into_iter().zip([5.0 * share, 5.0]) {
                assert!(
                    position_in_picture(&after, point, 1.6).abs_diff_eq(position_in_picture(&start, point, 1.6), 1e-4),
                    "{notches}"
                );
                let found = after.pose().eye.distance(point) / start.pose().eye.distance(point);
                assert!((found - share).abs() < 1e-4, "{notches}");
                assert!((after.target_distance() - target).abs() < 1e-4, "{notches}");
            }
        }
    }
    let near = (0..500).fold(start, |camera, _| camera.scaled_about(Vec3::ZERO, 1.0, 1.0));
    assert!(near.pose().eye.z > 0.0, "never through the target");
}

/// Drags and wheel notches in any order keep the picture upright, and the eye away from the target.
#[test]
fn any_mouse_motion_leaves_a_valid_camera() {
    for size in [1e-6, 1.0, 1e8] {
        let mut camera = camera(size * Vec3::new(0.0, 1.0, 2.0), Vec3::ZERO);
        let mut seed = 1u32;
        let mut number = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for step in 0..2_000 {
            let by = Vec2::new(number(), number());
            let point = camera.pose().target + size * Vec3::new(by.x, by.y, 0.5);
            let orbits = step / 100 % 2 == 0;
            camera = match step % 4 {
                0 if orbits => camera.dragged_around(by, 1.6),
                0 => camera.dragged_view(by, 1.6),
                1 => camera.panned(by, 1.6),
                2 if orbits => camera.scaled_about(point, 10.0 * number(), size),
                2 => camera.wheeled(point, 10.0 * number()),
                _ => camera.zoomed(1.0 + 0.5 * number()),
            };
            let (pose, basis) = (camera.pose(), camera.basis());
            assert!(pose.eye.is_finite() && basis.v.y > 0.0, "{step} {pose:?}");
            let distance = pose.eye.distance(pose.target);
            assert!(
                distance >= 0.99 * MIN_TARGET_DISTANCE * size && distance <= 1.01 * MAX_TARGET_DISTANCE * size,
                "{step} {distance}"
            );
        }
    }
}

#[test]
fn a_motion_by_a_number_that_is_none_changes_nothing() {
    let start = camera(Vec3::new(0.0, 1.0, 4.0), Vec3::ZERO);
    let unit = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
    for x in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
        let turns = [start.orbited(x, 0.1), start.orbited(0.1, x), start.turned(x, 0.1), start.turned(0.1, x)];
        let moves = [start.moved(x, 0.0, 0.0), start.moved(0.0, x, 0.0), start.moved(0.0, 0.0, x)];
        let boxes = [Bounds { min: Vec3::splat(x), ..unit }, Bounds { max: Vec3::splat(x), ..unit }];
        for after in turns.into_iter().chain(moves).chain(boxes.map(|bounds| start.framing(&bounds, 1.6))) {
            assert_eq!(after, start, "{x}");
        }
    }
    assert_eq!((start.nearer(f32::NAN), start.zoomed(f32::NAN)), (start, start));
}

#[test]
fn the_eye_comes_nearer_as_often_as_f32_allows() {
    let start = camera(Vec3::new(0.0, 1.0, 4.0), Vec3::ZERO);
    let half = start.nearer(0.5);
    assert!(half.pose().eye.abs_diff_eq(Vec3::new(0.0, 0.5, 2.0), 1e-6), "{half:?}");
    assert!(half.nearer(2.0).pose().eye.abs_diff_eq(start.pose().eye, 1e-6));
    for factor in [0.0, -1.0, 0.5, 2.0, f32::INFINITY] {
        let last = (0..500).fold(start, |camera, _| camera.nearer(factor));
        assert!(last.target_distance() > 0.0 && last.target_distance().is_finite(), "{factor}: {last:?}");
    }
}
