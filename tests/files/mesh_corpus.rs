//! The corpora of the meshes' fuzzers.

use crate::corpus;
use crate::mesh_laws;

#[test]
fn the_laws_of_meshes_hold_for_the_corpora() {
    for ending in ["gltf", "obj", "ply", "stl"] {
        corpus::replay(&format!("mesh_{ending}"), |bytes| mesh_laws::hold_for(&format!("x.{ending}"), bytes));
    }
    corpus::replay("texture", mesh_laws::hold_for_texture);
}
