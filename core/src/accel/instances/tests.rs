use crate::progress::Reporter;
use crate::scene::Draft;
use crate::shape::Shape;
use std::fmt::Write;

/// Returns the text of an OBJ file with a wavy sheet of `2 * side * side` triangles.
fn sheet(side: usize) -> String {
    let mut text = String::new();
    for at in 0..(side + 1) * (side + 1) {
        let (x, z) = (at % (side + 1), at / (side + 1));
        let _ = writeln!(text, "v {} {} {}", x as f32 / side as f32, (x * 7 + z * 5) % 11, z as f32 / side as f32);
    }
    for at in 0..side * side {
        let corner = at / side * (side + 1) + at % side + 1;
        let _ = writeln!(text, "f {} {} {} {}", corner, corner + 1, corner + side + 2, corner + side + 1);
    }
    text
}

/// 10,000 instances of 75,272 triangles take less than 20 MB besides the mesh.
#[test]
fn instances_take_little_memory() {
    let sheet = sheet(194);
    let of = |count: &str| {
        let text = format!(
            "(camera: (eye: (0, 9, 9), target: (0, 0, 0)), objects: [
                Mesh(path: \"sheet.obj\", copies: (count: {count}, step: (2, 0, 2)))])"
        );
        let meshes = &[("sheet.obj", sheet.as_bytes())];
        Draft::from_embedded("x.ron", text.as_bytes(), meshes, &Reporter::silent()).expect("a scene").finish()
    };
    let [few, many] = [of("(20, 1, 1)"), of("(100, 1, 100)")];
    assert_eq!(many.objects().len(), 10_000);
    let Shape::Mesh(mesh) = &many.objects()[0].shape else { panic!("a mesh") };
    assert_eq!((mesh.triangle_count(), mesh.is_instance()), (75_272, true));
    let tree = few.accelerator().bytes();
    let objects = size_of_val(many.objects()) + many.objects().len() * size_of_val(&**mesh);
    let besides = many.accelerator().bytes() - tree + objects;
    assert!(besides < 20_000_000, "{besides} bytes besides the tree of {tree}");
    // The mesh is not copied: all instances have the same file.
    let is_same = |shape: &Shape| matches!(shape, Shape::Mesh(other) if std::ptr::eq(other.file(), mesh.file()));
    assert!(many.objects().iter().all(|object| is_same(&object.shape)));
}
