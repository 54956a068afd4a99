//! The children and transforms of the nodes of a glTF file.

use super::json::Json;
use crate::mesh_file::fault::MeshFault;
use glam::{DMat4, DQuat, DVec3, DVec4};

/// A node with its index in the list of nodes.
pub(super) type IndexedNode<'a> = (usize, Json<'a>);

/// Returns the nodes whose indices are in the field `list` of `json`.
pub(super) fn nodes_in<'a>(
    json: Json<'a>,
    list: &'static str,
    root: Json<'a>,
) -> Result<Vec<IndexedNode<'a>>, MeshFault> {
    json.list(list)?.map(|index| index.item_of(root, "nodes")).collect()
}

/// Returns the transform from a node's coordinates to its parent's.
pub(super) fn local_transform(node: Json<'_>) -> Result<DMat4, MeshFault> {
    if let Some(matrix) = node.numbers::<16>("matrix")? {
        // glTF: a node with a matrix has no translation, rotation or scale.
        return Ok(DMat4::from_cols_array(&matrix));
    }
    let translation = node.numbers("translation")?.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.numbers("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = node.numbers("rotation")?.map_or(DVec4::W, DVec4::from_array);
    // A quaternion whose length is not 1, after rounding for example, would also scale the mesh.
    let Some(rotation) = rotation.try_normalize() else {
        return Err(node.fault("the rotation is not a quaternion: its length is zero or too large"));
    };
    Ok(DMat4::from_scale_rotation_translation(scale, DQuat::from_vec4(rotation), translation))
}
