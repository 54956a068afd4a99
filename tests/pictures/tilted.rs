//! View rectangles tilted against the w axis, by formulas of their own in f64.

use glam::{DMat3, DVec3, Vec2, Vec3};
use termtrace::internals::hit::{Kernel, closest_hit, closest_hits};
use termtrace::internals::lanes::LANES;
use termtrace::internals::ray::EightRays;
use termtrace::{Camera, CameraError, Pose, Scene, ViewRectangle};

const ASPECT_RATIO: f32 = 1.6;

/// Shifts in heights and tilts in degrees.
const RECTANGLES: [([f32; 2], [f32; 2]); 6] = [
    ([0.0, 0.0], [0.0, -20.0]),
    ([0.0, 0.0], [25.0, 0.0]),
    ([0.3, -0.2], [-30.0, 40.0]),
    ([-0.5, 0.1], [5.0, -65.0]),
    ([0.2, 0.3], [-70.0, 1.0]),
    ([0.1, 0.0], [0.01, 0.0]),
];

fn camera(eye: Vec3, target: Vec3, shift: [f32; 2], tilt: [f32; 2]) -> Camera {
    let tilt = Vec2::from(tilt) * 1_f32.to_radians();
    let rectangle = ViewRectangle::from_vertical_fov(0.8).and_then(|r| r.with_shift(shift.into())?.with_tilt(tilt));
    Camera::new(Pose { eye, target, up: Vec3::Y }, rectangle.expect("a rectangle")).expect("a camera")
}

pub(crate) fn cameras() -> impl Iterator<Item = (Camera, [[f64; 2]; 2])> {
    RECTANGLES.into_iter().map(|(shift, tilt)| {
        let camera = camera(Vec3::new(7.0, -2.0, 9.0), Vec3::new(0.5, 1.0, -0.5), shift, tilt);
        (camera, [shift, tilt].map(|pair| pair.map(f64::from)))
    })
}

/// Returns the vectors of a camera as POV-Ray has them, in f64: the ray through (x, y), both from
/// -1/2 to 1/2, has the direction `direction + x right + y up`.
///
/// They are the rows of the matrix that takes POV-Ray's x, y and z, which are the right, up and direction of
/// `camera { right x up y direction z matrix <...> }`.
pub(crate) fn matrix(camera: &Camera, [shift, tilt]: [[f64; 2]; 2]) -> [DVec3; 3] {
    let Pose { eye, target, up } = camera.pose();
    let forward = (target - eye).as_dvec3().normalize();
    let u = forward.cross(up.as_dvec3()).normalize();
    let v = u.cross(forward);
    // Turns to the right about v, then upwards about the turned u.
    let to_the_right = DMat3::from_axis_angle(v, -tilt[0].to_radians());
    let right = to_the_right * u;
    let upwards = DMat3::from_axis_angle(right, tilt[1].to_radians());
    let (right, up) = (right, upwards * to_the_right * v);
    let height = 2.0 * libm::tan(0.5 * f64::from(0.8_f32));
    let direction = forward + height * (shift[0] * right + shift[1] * up);
    [height * f64::from(ASPECT_RATIO) * right, height * up, direction]
}

fn positions() -> impl Iterator<Item = [f32; 2]> {
    [0.0, 0.25, 0.5, 0.8, 1.0].into_iter().flat_map(|y| [0.0, 0.1, 0.5, 0.9, 1.0].map(|x| [x, y]))
}

#[test]
fn eye_rays_are_those_of_a_camera_with_a_matrix() {
    for (camera, offsets) in cameras() {
        let [right, up, direction] = matrix(&camera, offsets);
        let normal = right.cross(up).normalize();
        for [qu, qv] in positions() {
            let ray = camera.eye_rays(ASPECT_RATIO).through(qu, qv);
            let expected = direction + (f64::from(qu) - 0.5) * right + (f64::from(qv) - 0.5) * up;
            let found = ray.direction.as_dvec3();
            let sine = found.normalize().cross(expected.normalize()).length();
            assert!(sine < 2e-6 && found.dot(expected) > 0.0, "{offsets:?} {qu} {qv}: {sine}");
            // The t of a ray is the distance from the eye along the normal of the rectangle.
            assert!((found.dot(normal).abs() - 1.0).abs() < 1e-4, "{offsets:?} {qu} {qv}");
            let place = camera.project(ray.at(3.0), ASPECT_RATIO).expect("in front of the eye");
            assert!(place.abs_diff_eq(Vec2::new(qu, 1.0 - qv), 2e-5), "{offsets:?} {qu} {qv}: {place}");
        }
    }
}

/// A camera that looks up at angle p on an upright rectangle of height h has the rays of a level
/// one, whose rectangle is h / cos p high and shifted up by sin p / h.
#[test]
fn an_upright_rectangle_is_that_of_a_level_camera_shifted_up() {
    let eye = Vec3::new(1.0, 2.0, 3.0);
    for degrees in [-35.0_f32, 5.0, 20.0, 60.0] {
        let pitch = degrees.to_radians();
        let up = camera(eye, eye + Vec3::new(0.0, libm::sinf(pitch), -libm::cosf(pitch)), [0.0; 2], [0.0, -degrees]);
        let height = up.rectangle().height();
        let level = 2.0 * libm::atanf(0.5 * height / libm::cosf(pitch));
        let level = ViewRectangle::from_vertical_fov(level).expect("an angle");
        let level = level.with_shift(Vec2::new(0.0, libm::sinf(pitch) / height)).expect("a shift");
        let level = Camera::new(Pose { eye, target: eye - Vec3::Z, up: Vec3::Y }, level).expect("a camera");
        for [qu, qv] in positions() {
            let [a, b] = [up, level].map(|camera| camera.eye_rays(ASPECT_RATIO).through(qu, qv).direction);
            assert!(a.abs_diff_eq(b, 4e-6), "{degrees} {qu} {qv}: {a} {b}");
        }
    }
}

/// Returns the four edges of a cube along an axis.
fn edges(axis: usize) -> [[Vec3; 2]; 4] {
    [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].map(|[a, b]| {
        [-1.0, 1.0].map(|along| {
            let mut corner = [along, a, b];
            corner.rotate_right(axis);
            Vec3::from(corner)
        })
    })
}

/// The images of parallel edges lie on lines through one point, where the ray along them pierces
/// the plane of the rectangle.
#[test]
fn parallel_edges_of_a_cube_meet_in_their_vanishing_point() {
    for (camera, offsets) in cameras() {
        let [right, up, direction] = matrix(&camera, offsets);
        let normal = right.cross(up);
        for axis in 0..3 {
            // Solves s axis = direction + x right + y up for x and y.
            let along = DMat3::IDENTITY.col(axis);
            let q = along * (direction.dot(normal) / along.dot(normal)) - direction;
            let vanishing = [q.dot(right) / right.length_squared(), q.dot(up) / up.length_squared()];
            for edge in edges(axis) {
                let place = |point| camera.project(point, ASPECT_RATIO).expect("in front of the eye").as_dvec2();
                let [a, b] = edge.map(place).map(|place| [place.x - 0.5, 0.5 - place.y]);
                // The area of the triangle of both ends and the vanishing point, over the square of its longest side.
                let [ab, av] = [b, vanishing].map(|end| [end[0] - a[0], end[1] - a[1]]);
                let area = ab[0] * av[1] - ab[1] * av[0];
                let size = libm::hypot(ab[0], ab[1]) * libm::hypot(av[0], av[1]);
                assert!(area.abs() < 2e-5 * size.max(1e-3), "{offsets:?} {axis} {edge:?}: {area} of {size}");
            }
        }
    }
}

#[test]
fn upright_edges_are_upright_on_an_upright_rectangle() {
    // It looks up at 45 degrees, and the rectangle faces the horizon.
    let eye = Vec3::new(3.0, -7.0, 5.0);
    let camera = camera(eye, eye + Vec3::new(-3.0, 34_f32.sqrt(), -5.0), [0.0; 2], [0.0, -45.0]);
    for edge in edges(1) {
        let [low, high] = edge.map(|end| camera.project(end, 1.0).expect("in front of the eye"));
        assert!((low.x - high.x).abs() < 1e-6 && high.y < low.y, "{low} {high}");
    }
}

/// Bounds of packets are those of their rays, whatever the camera: each ray has the hit that it has
/// alone.
#[test]
fn packets_of_a_tilted_rectangle_have_the_hits_of_single_rays() {
    let text = include_str!("../../scenes/many_spheres.ron");
    let scene = Scene::from_ron("many_spheres", text).expect("a scene");
    for (_, tilt) in RECTANGLES.into_iter().chain([([0.0; 2], [-60.0, -50.0])]) {
        let Pose { eye, target, .. } = scene.camera().pose();
        let rays = camera(eye, target, [0.0; 2], tilt).eye_rays(ASPECT_RATIO);
        let single = |at: u32| rays.through((at % 64) as f32 / 64.0, (at / 64) as f32 / 40.0);
        // Tiles of eight by eight rays.
        let places: Vec<_> = (0..40).map(|tile| (tile % 8 * 8) + tile / 8 * 8 * 64).collect();
        for tile in places {
            let row = |row: u32| std::array::from_fn::<_, LANES, _>(|x| single(tile + row * 64 + x as u32));
            let groups: Vec<_> = (0..8).map(|y| EightRays::of(&row(y))).collect();
            let mut hits = Vec::new();
            closest_hits(Kernel::Auto, &scene, &groups, &mut hits);
            for at in 0..64 {
                let ray = single(tile + at / 8 * 64 + at % 8);
                assert_eq!(
                    hits[at as usize / 8].hit(&scene, at as usize % 8),
                    closest_hit(&scene, &ray),
                    "{tilt:?} {tile} {at}"
                );
            }
        }
    }
}

#[test]
fn a_rectangle_is_refused_that_contains_the_eye_or_passes_behind_it() {
    let rectangle = ViewRectangle::from_focal_length(1.0, 3.0, 2.0).expect("a rectangle");
    let tilted = |right: f32, up: f32| rectangle.with_tilt(Vec2::new(right.to_radians(), up.to_radians()));
    // Half the height is 1: with the upper edge towards the eye it is above it at 90 degrees only.
    assert!(tilted(0.0, 89.0).is_ok());
    assert_eq!(tilted(0.0, 89.1), Err(CameraError::Tilt));
    assert_eq!(tilted(f32::NAN, 0.0), Err(CameraError::NotFinite));
    // Half the width is 1.5: its edge is beside the eye at asin(1 / 1.5) = 41.81 degrees.
    assert!(tilted(41.8, 0.0).is_ok() && tilted(-41.8, 0.0).is_ok());
    assert_eq!(tilted(41.82, 0.0), Err(CameraError::BehindEye));
    assert_eq!(tilted(-41.82, 0.0), Err(CameraError::BehindEye));
    // Shifted by half a height towards the eye, its edge is at 2: beside the eye at 30 degrees.
    let shifted = rectangle.with_shift(Vec2::new(0.0, 0.5)).expect("a shift");
    assert!(shifted.with_tilt(Vec2::new(0.0, 29.9_f32.to_radians())).is_ok());
    assert_eq!(shifted.with_tilt(Vec2::new(0.0, 30.1_f32.to_radians())), Err(CameraError::BehindEye));
    // A larger rectangle would pass behind the eye with the same tilt.
    let tilted = shifted.with_tilt(Vec2::new(0.0, 29.0_f32.to_radians())).expect("a tilt");
    assert_eq!(tilted.scaled(1.1), Err(CameraError::BehindEye));
    assert_eq!(tilted.with_shift(Vec2::new(0.0, 0.6)), Err(CameraError::BehindEye));
    assert_eq!(tilted.with_vertical_fov(2.0), Err(CameraError::BehindEye));
    assert!(tilted.scaled(0.5).is_ok());
}
