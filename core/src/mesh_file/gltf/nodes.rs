//! The node tree of a glTF file, whose nodes transform meshes, cameras and lights.

use super::buffers::Buffers;
use super::json::Json;
use super::pose::Globals;
use super::primitives::Primitives;
use super::staging::StagingReader;
use super::tree::{IndexedNode, local_transform, nodes_in};
use crate::mesh_file::MeshFile;
use crate::mesh_file::fault::MeshFault;
use crate::progress::Meter;
use glam::DMat4;

/// Reads the triangles of all meshes, the cameras and the lights in the default scene, transformed
/// by their nodes.
pub(super) fn read<'a>(
    root: Json<'a>,
    buffers: &mut Buffers<'a, '_>,
    meter: &mut Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    let mut is_visited = vec![false; root.list_len("nodes")?];
    let globals = Globals::of(root)?;
    let mut primitives = Primitives::new(buffers)?;
    let mut staging = StagingReader::default();
    // An explicit stack, because a file may nest its nodes a million deep. Nodes are pushed in reverse, so that they
    // are popped, and their triangles added, in the order of the file.
    let mut open: Vec<_> = roots(root)?.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some(((number, node), parent)) = open.pop() {
        meter.report_indeterminate()?;
        // Without this check a cycle of nodes would never end, and a child that is listed twice at every level would
        // double the work each time.
        if std::mem::replace(&mut is_visited[number], true) {
            return Err(node.fault("this node is reached twice: nodes must form a tree"));
        }
        let transform = parent * local_transform(node)?;
        staging.add(node, root, &transform, primitives.left_out())?;
        if let Some(mesh) = node.field("mesh")? {
            let (_, mesh) = mesh.item_of(root, "meshes")?;
            primitives.add_mesh(mesh, node, transform, &globals)?;
        }
        let children = nodes_in(node, "children", root)?;
        open.extend(children.into_iter().rev().map(|child| (child, transform)));
    }
    let staging = staging.finish(root, primitives.left_out());
    primitives.finish(staging)
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
    let mut is_child = vec![false; root.list_len("nodes")?];
    for node in root.list("nodes")? {
        for (child, _) in nodes_in(node, "children", root)? {
            is_child[child] = true;
        }
    }
    Ok(root.list("nodes")?.enumerate().filter(|&(number, _)| !is_child[number]).collect())
}
