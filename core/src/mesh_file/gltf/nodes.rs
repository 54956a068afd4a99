//! The node tree of a glTF file, whose nodes transform meshes, cameras and lights.

use super::animation::Animation;
use super::buffers::Buffers;
use super::json::Json;
use super::moving::MovingTree;
use super::pose::{Globals, has_primitive_without_joints};
use super::primitives::{Placed, Primitives};
use super::staging::{self, StagingReader};
use super::tree::{IndexedNode, nodes_in};
use crate::mesh_file::MeshFile;
use crate::mesh_file::fault::MeshFault;
use crate::progress::Meter;
use glam::DMat4;

/// Reads the triangles of all meshes, the cameras and the lights in the default scene, transformed
/// by their nodes at time 0, and the motion of the nodes.
pub(super) fn read<'a>(
    root: Json<'a>,
    buffers: &mut Buffers<'a, '_>,
    meter: &mut Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    let mut is_visited = vec![false; root.list_len("nodes")?];
    let animation = Animation::read(root, buffers, meter)?;
    let globals = Globals::of(root, &animation)?;
    let mut primitives = Primitives::new(buffers)?;
    let mut stage = StagingReader::default();
    let mut tree = MovingTree::new(&animation);
    // An explicit stack, because a file may nest its nodes a million deep. Nodes are pushed in reverse, so that they
    // are popped, and their triangles added, in the order of the file.
    let mut open: Vec<_> = roots(root)?.into_iter().rev().map(|node| (node, DMat4::IDENTITY, None)).collect();
    while let Some(((number, node), parent, moving)) = open.pop() {
        meter.report_indeterminate()?;
        // Without this check a cycle of nodes would never end, and a child that is listed twice at every level would
        // double the work each time.
        if std::mem::replace(&mut is_visited[number], true) {
            return Err(node.fault("this node is reached twice: nodes must form a tree"));
        }
        let local = animation.local_transform(number, node)?;
        let transform = parent * local;
        let moving = tree.step((number, node), moving, [parent, local])?;
        stage.add(node, root, &transform, primitives.left_out())?;
        if moving.is_some() {
            staging::count_motion(node, primitives.left_out())?;
        }
        if let Some(mesh) = node.field("mesh")? {
            let (index, mesh) = mesh.item_of(root, "meshes")?;
            let placed = Placed { mesh, node, transform, weights: animation.weights(number) };
            primitives.add_mesh(&placed, &globals)?;
            if globals.moves_skin_of(node, root)? {
                primitives.left_out().not_shown("animation (of a skin)", 1);
            }
            if moving.is_some() && node.field("skin")?.is_some() && has_primitive_without_joints(mesh)? {
                primitives.left_out().not_shown("animation (of a part without joints in a skin)", 1);
            }
            tree.add_mesh(index, number, &placed, moving)?;
        }
        let children = nodes_in(node, "children", root)?;
        open.extend(children.into_iter().rev().map(|child| (child, transform, moving)));
    }
    let staging = stage.finish(root, primitives.left_out());
    let motion = tree.finish(&mut primitives, &globals, meter)?;
    primitives.finish(staging, motion)
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
