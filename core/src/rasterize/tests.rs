use super::*;
use crate::camera::ViewRectangle;
use crate::hit::closest_hit;
use glam::Vec2;

/// The rectangle of a sphere contains all pixels whose rays hit it, and at most one more on each
/// side.
#[test]
fn rectangles_of_spheres_are_tight() {
    let resolution = Resolution::square(91, 67);
    let camera = Camera::look_at(Vec3::new(0.3, 1.0, 6.0), Vec3::ZERO).expect("a camera");
    let rectangle = camera.rectangle();
    let tilted = rectangle.with_tilt(Vec2::new(0.5, -0.3)).expect("in front").with_shift(Vec2::new(0.2, 0.1));
    let mut number = 1_u32;
    let mut random = || {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        number as f32 / u32::MAX as f32
    };
    for camera in [camera, camera.with_rectangle(tilted.expect("in front"))] {
        for _ in 0..300 {
            let center = Vec3::from_array([(); 3].map(|()| 6.0 * random() - 3.0));
            let sphere = Sphere::new(center, 0.01 + random()).expect("a sphere");
            let mut rasterizer = Rasterizer::new(&camera, resolution);
            rasterizer.draw(&Primitive::Sphere(&sphere), 7);
            rasterizer.finish();
            let rays = camera.eye_rays(resolution.aspect_ratio());
            let scene =
                Scene::new(camera, vec![crate::scene::Object::new(sphere, crate::material::Material::default())]);
            let pixels = (0..67).flat_map(|y| (0..91).map(move |x| (x, y)));
            let ray = |(x, y): (u32, u32)| rays.through((x as f32 + 0.5) / 91.0, (67.0 - (y as f32 + 0.5)) / 67.0);
            let hit: Vec<_> = pixels.filter(|&at| closest_hit(&scene, &ray(at)).is_some()).collect();
            let drawn = rasterizer.buffer().hits_and_depths().0;
            assert!(drawn.abs_diff(hit.len() as u64) <= 2, "{sphere:?}: {drawn} of {}", hit.len());
            let extent = |of: fn(&(u32, u32)) -> u32| {
                let (min, max) = (hit.iter().map(of).min(), hit.iter().map(of).max());
                min.zip(max).map_or(0, |(min, max)| u64::from(max - min + 1))
            };
            let most = 1 + (extent(|at| at.0) + 2) * (extent(|at| at.1) + 2);
            // A sphere that the picture cuts off is not checked: it may be widest outside the picture.
            let is_whole = hit.iter().all(|&(x, y)| (1..90).contains(&x) && (1..66).contains(&y));
            assert!(
                !is_whole || rasterizer.tests() <= most,
                "{sphere:?}: {} tests, at most {most}",
                rasterizer.tests()
            );
        }
    }
}

/// No pixel of a surface of triangles is left out, also where the triangles are smaller than
/// pixels or cover the picture.
#[test]
fn triangles_leave_no_gaps() {
    let rectangle = ViewRectangle::from_vertical_fov(0.8).expect("a rectangle");
    let camera = Camera::look_at(Vec3::new(0.1, 0.2, 3.0), Vec3::ZERO).expect("a camera").with_rectangle(rectangle);
    let resolution = Resolution::square(203, 151);
    for count in [1, 7, 40, 400] {
        let mut rasterizer = Rasterizer::new(&camera, resolution);
        // A square that covers the picture, bent so that no edge is level.
        let at = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|at| 6.0 * at as f32 / count as f32 - 3.0);
            Vec3::new(x + 0.1 * y, y - 0.07 * x, 0.05 * x * y)
        };
        for (x, y) in (0..count).flat_map(|y| (0..count).map(move |x| (x, y))) {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            for corners in [[a, b, c], [a, d, c]] {
                rasterizer.draw(&Primitive::Triangle(&crate::shape::Triangle::unchecked(corners)), 0);
            }
        }
        rasterizer.finish();
        assert_eq!(rasterizer.buffer().hits_and_depths().0, 203 * 151, "{count}");
    }
}
