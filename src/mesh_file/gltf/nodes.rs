//! The node tree of a glTF file, whose nodes transform meshes.

use super::buffers::Buffers;
use super::json::Json;
use super::primitives::Primitives;
use crate::mesh_file::MeshFile;
use crate::mesh_file::fault::MeshFault;
use crate::progress::Meter;
use glam::{DMat4, DQuat, DVec3, DVec4};

/// Reads the triangles of all meshes in the default scene, transformed by their nodes.
pub(super) fn read<'a>(
    root: Json<'a>,
    buffers: &mut Buffers<'a, '_>,
    meter: &mut Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    let mut is_visited = vec![false; root.count("nodes")?];
    let mut primitives = Primitives::new(buffers)?;
    // An explicit stack, because a file may nest its nodes a million deep. Nodes are pushed in reverse, so that they
    // are popped, and their triangles added, in the order of the file.
    let mut open: Vec<_> = roots(root)?.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some(((number, node), parent)) = open.pop() {
        meter.step()?;
        if std::mem::replace(&mut is_visited[number], true) {
            return Err(node.fault("this node is reached twice: nodes must form a tree"));
        }
        let transform = parent * local_transform(node)?;
        if let Some(mesh) = node.field("mesh")? {
            let (_, mesh) = mesh.item_of(root, "meshes")?;
            primitives.add_mesh(mesh, node, transform)?;
        }
        let children = nodes_in(node, "children", root)?;
        open.extend(children.into_iter().rev().map(|child| (child, transform)));
    }
    primitives.finish()
}

/// A node with its index in the list of nodes.
type IndexedNode<'a> = (usize, Json<'a>);

/// Returns the nodes whose indices are in the field `list` of `json`.
fn nodes_in<'a>(json: Json<'a>, list: &'static str, root: Json<'a>) -> Result<Vec<IndexedNode<'a>>, MeshFault> {
    json.list(list)?.map(|index| index.item_of(root, "nodes")).collect()
}

/// Returns the roots of the default scene, or of the first one; in a file without scenes, all nodes
/// that are not children.
fn roots(root: Json<'_>) -> Result<Vec<IndexedNode<'_>>, MeshFault> {
    let scene = match root.field("scene")? {
        Some(index) => Some(index.item_of(root, "scenes")?.1),
        None => root.list("scenes")?.next(),
    };
    if let Some(scene) = scene {
        return nodes_in(scene, "nodes", root);
    }
    let mut is_child = vec![false; root.count("nodes")?];
    for node in root.list("nodes")? {
        for (child, _) in nodes_in(node, "children", root)? {
            is_child[child] = true;
        }
    }
    Ok(root.list("nodes")?.enumerate().filter(|&(number, _)| !is_child[number]).collect())
}

/// Returns the transform from a node's coordinates to its parent's.
fn local_transform(node: Json<'_>) -> Result<DMat4, MeshFault> {
    if let Some(matrix) = node.numbers::<16>("matrix")? {
        return Ok(DMat4::from_cols_array(&matrix));
    }
    let translation = node.numbers("translation")?.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.numbers("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = node.numbers("rotation")?.map_or(DVec4::W, DVec4::from_array);
    let Some(rotation) = rotation.try_normalize() else {
        return Err(node.fault("the rotation is not a quaternion: its length is zero or too large"));
    };
    Ok(DMat4::from_scale_rotation_translation(scale, DQuat::from_vec4(rotation), translation))
}
