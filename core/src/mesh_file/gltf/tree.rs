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

/// The transform from a node's coordinates to its parent's, as in the file.
pub(super) enum NodeTransform {
    /// A matrix.
    Matrix(DMat4),
    /// A scale, then a rotation, then a translation.
    Parts { translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3] },
}

/// The message about a rotation whose quaternion has no direction.
pub(super) const NO_ROTATION: &str = "the rotation is not a quaternion: its length is zero or too large";

impl NodeTransform {
    /// Returns the matrix; `None` if the length of the rotation is 0 or too large.
    pub(super) fn matrix(self) -> Option<DMat4> {
        Some(match self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                let [translation, scale] = [translation, scale].map(DVec3::from_array);
                // A quaternion whose length is not 1, after rounding for example, would also scale the mesh.
                let rotation = DQuat::from_vec4(DVec4::from_array(rotation).try_normalize()?);
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        })
    }
}

/// Returns the transform of a node, without its animation.
pub(super) fn node_transform(node: Json<'_>) -> Result<NodeTransform, MeshFault> {
    if let Some(matrix) = node.numbers::<16>("matrix")? {
        // glTF: a node with a matrix has no translation, rotation or scale.
        return Ok(NodeTransform::Matrix(DMat4::from_cols_array(&matrix)));
    }
    Ok(NodeTransform::Parts {
        translation: node.numbers("translation")?.unwrap_or([0.0; 3]),
        rotation: node.numbers("rotation")?.unwrap_or([0.0, 0.0, 0.0, 1.0]),
        scale: node.numbers("scale")?.unwrap_or([1.0; 3]),
    })
}
