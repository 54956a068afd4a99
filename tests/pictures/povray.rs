//! View rectangles tilted and shifted, beside pictures of POV-Ray, whose camera has a `matrix`.
//!
//! `BLESS=1 cargo test --test pictures povray` runs `povray` and writes its pictures to `povray.txt`: a character for
//! the object that each pixel shows. They were made by POV-Ray 3.7.

use super::rasterized::is_beside;
use super::tilted::{cameras, matrix};
use std::fmt::Write;
use std::process::Command;
use termtrace::Scene;
use termtrace::internals::hit::closest_hit;

const SIZE: [u32; 2] = [64, 40];

const SPHERES: [([f32; 3], f32); 3] = [([2.0, 0.5, -3.0], 1.5), ([-2.5, 2.0, 1.0], 0.8), ([4.0, -1.0, 3.0], 0.6)];

/// The corners of the faces of a cube, each two triangles.
fn triangles() -> impl Iterator<Item = [[i32; 3]; 3]> {
    (0..6).flat_map(|face: usize| {
        let side = if face < 3 { 1 } else { -1 };
        let corner = move |a: i32, b: i32| {
            let mut corner = [side, a, b];
            corner.rotate_right(face % 3);
            corner
        };
        [[corner(-1, -1), corner(1, -1), corner(1, 1)], [corner(-1, -1), corner(1, 1), corner(-1, 1)]]
    })
}

fn scene() -> Scene {
    let mut objects = String::from("Plane(point: (0, -4, 0), normal: (0, 1, 0)), ");
    for ([x, y, z], radius) in SPHERES {
        let _ = write!(objects, "Sphere(center: ({x}, {y}, {z}), radius: {radius}), ");
    }
    for corners in triangles() {
        let [a, b, c] = corners.map(|[x, y, z]| format!("({x}, {y}, {z})"));
        let _ = write!(objects, "Triangle(corners: [{a}, {b}, {c}]), ");
    }
    let text = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{objects}])");
    Scene::from_ron("cube", &text).expect("a scene")
}

/// Returns the pictures of all cameras as POV-Ray draws them, each after a line with its shift and
/// tilt.
fn drawn_by_povray() -> String {
    let mut pictures = String::new();
    for (camera, offsets) in cameras() {
        let vectors = matrix(&camera, offsets).into_iter().chain([camera.pose().eye.as_dvec3()]);
        let rows: Vec<_> = vectors.flat_map(|row| row.to_array()).map(|x| x.to_string()).collect();
        let mut shapes = vec!["plane { y, -4".to_owned()];
        shapes.extend(SPHERES.map(|([x, y, z], radius)| format!("sphere {{ <{x}, {y}, {z}>, {radius}")));
        shapes.extend(triangles().map(|corners| {
            let [a, b, c] = corners.map(|[x, y, z]| format!("<{x}, {y}, {z}>"));
            format!("triangle {{ {a}, {b}, {c}")
        }));
        let rows = rows.join(", ");
        let mut text = String::from("#version 3.7; global_settings { assumed_gamma 1 }\n");
        let _ = writeln!(text, "camera {{ right x up y direction z matrix <{rows}> }}");
        for (shape, number) in shapes.iter().zip(1..) {
            let _ =
                writeln!(text, "{shape} pigment {{ rgb {} / 255 }} finish {{ ambient 1 diffuse 0 }} }}", 10 * number);
        }
        let folder = tempfile::tempdir().expect("a folder can be made");
        std::fs::write(folder.path().join("cube.pov"), text).expect("the scene can be written");
        let size = [format!("+W{}", SIZE[0]), format!("+H{}", SIZE[1])];
        let arguments = ["+Icube.pov", "+O-", "+FP8", "-A", "-D", "File_Gamma=1"];
        let output = Command::new("povray").args(arguments).args(size).current_dir(&folder).output();
        let output = output.expect("POV-Ray runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // The pixels follow a header.
        let pixels = &output.stdout[output.stdout.len() - (3 * SIZE[0] * SIZE[1]) as usize..];
        let _ = writeln!(pictures, "{offsets:?}");
        for row in pixels.chunks(3 * SIZE[0] as usize) {
            let name = |object: u8| if object == 0 { '.' } else { char::from(b'a' + object - 1) };
            let _ = writeln!(pictures, "{}", row.chunks(3).map(|pixel| name(pixel[0] / 10)).collect::<String>());
        }
    }
    pictures
}

#[test]
fn a_camera_with_a_matrix_shows_the_same_object_at_every_pixel_except_at_edges() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pictures/povray.txt");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, drawn_by_povray()).expect("the pictures can be written");
    }
    let pictures = std::fs::read_to_string(path).expect("the pictures can be read");
    let (scene, mut lines) = (scene(), pictures.lines());
    for (camera, offsets) in cameras() {
        assert_eq!(lines.next(), Some(&*format!("{offsets:?}")));
        let rays = camera.eye_rays(SIZE[0] as f32 / SIZE[1] as f32);
        let traced = |x: u32, y: u32| {
            let [qu, qv] = [(x as f32 + 0.5) / SIZE[0] as f32, 1.0 - (y as f32 + 0.5) / SIZE[1] as f32];
            closest_hit(&scene, &rays.through(qu, qv)).map(|hit| hit.object)
        };
        let (mut seen, mut different) = (std::collections::BTreeSet::new(), 0);
        for (row, y) in lines.by_ref().take(SIZE[1] as usize).zip(0..) {
            for (object, x) in row.bytes().zip(0..) {
                let drawn = (object != b'.').then(|| u32::from(object - b'a'));
                seen.insert(drawn);
                if traced(x, y) != drawn {
                    different += 1;
                    assert!(is_beside(drawn, [x, y], traced), "{offsets:?} ({x}, {y}): drawn is {drawn:?}");
                }
            }
        }
        assert!(seen.len() >= 4 && different <= 4, "{offsets:?}: {seen:?}, {different} pixels differ");
    }
    assert_eq!(lines.next(), None);
}
