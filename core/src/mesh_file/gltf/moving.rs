//! The moving nodes of a glTF file, and the meshes that they carry.

use super::animation::{Animation, NodeChannels};
use super::pose::Globals;
use super::primitives::{Placed, Primitives};
use super::tree::IndexedNode;
use crate::bounds::Bounds;
use crate::checks;
use crate::mesh_file::MeshFile;
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::motion::{Motion, MovingNode, MovingPart};
use crate::progress::Meter;
use glam::{DMat3, DMat4, DVec3, Mat3, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// The nearest moving node above: its index among the moving nodes, and the transform to its
/// coordinates.
pub(super) type Anchor = (usize, DMat4);

/// The moving nodes, and all meshes that are shown, in the order of the tree.
pub(super) struct MovingTree<'a, 'w> {
    animation: &'w Animation,
    nodes: Vec<MovingNode>,
    /// The meshes, each with the moving node that carries it, if one does.
    shown: Vec<(MeshKey, Placed<'a, 'w>, Option<Anchor>)>,
}

/// The index of a mesh, and that of the node if the node has weights of its own for morph targets.
type MeshKey = (usize, Option<usize>);

impl<'a, 'w> MovingTree<'a, 'w> {
    pub(super) fn new(animation: &'w Animation) -> Self {
        Self { animation, nodes: Vec::new(), shown: Vec::new() }
    }

    /// Returns the nearest moving node at or above a node, from that above its parent.
    ///
    /// `transforms` are that of the parent to the scene, and that of the node to the parent, at time 0.
    pub(super) fn step(
        &mut self,
        (number, node): IndexedNode<'a>,
        above: Option<Anchor>,
        [parent, local]: [DMat4; 2],
    ) -> Result<Option<Anchor>, MeshFault> {
        if self.animation.moves_node(number)
            && let Some(NodeChannels { translation, rotation, scale }) = self.animation.channels(number, node)?
        {
            let (parent, above) = above.map_or((None, parent), |(parent, below)| (Some(parent), below));
            self.nodes.push(MovingNode { parent, above, translation, rotation, scale });
            return Ok(Some((self.nodes.len() - 1, DMat4::IDENTITY)));
        }
        Ok(above.map(|(moving, below)| (moving, below * local)))
    }

    /// Adds a mesh that a node shows, with the nearest moving node.
    pub(super) fn add_mesh(
        &mut self,
        mesh: usize,
        number: usize,
        placed: &Placed<'a, 'w>,
        anchor: Option<Anchor>,
    ) -> Result<(), MeshFault> {
        if self.animation.moves() {
            let has_weights = placed.weights.is_some() || placed.node.field("weights")?.is_some();
            // The joints of a skin place a mesh, whatever moves its node.
            let anchor = if placed.node.field("skin")?.is_some() { None } else { anchor };
            self.shown.push(((mesh, has_weights.then_some(number)), *placed, anchor));
        }
        Ok(())
    }

    /// Returns the motion of the meshes; `None` if none moves.
    pub(super) fn finish(
        self,
        primitives: &mut Primitives<'_, 'a, '_>,
        globals: &Globals,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Motion>, MeshFault> {
        let Self { animation, nodes, shown } = self;
        let mut meshes: HashMap<MeshKey, Option<(Arc<MeshFile>, DMat4)>> = HashMap::new();
        let mut parts = Vec::new();
        for (key, placed, anchor) in &shown {
            meter.report_indeterminate()?;
            let Some((node, below)) = *anchor else { continue };
            if !meshes.contains_key(key) {
                let placed = Placed { transform: DMat4::IDENTITY, ..*placed };
                let mesh = primitives.apart(|primitives| primitives.add_mesh(&placed, globals))?;
                meshes.insert(*key, mesh.map(within_range).map(|(mesh, back)| (mesh.into(), back)));
            }
            let placed = meshes[key].clone();
            parts.extend(placed.map(|(mesh, back)| MovingPart { node, below: below * back, mesh }));
        }
        if parts.is_empty() {
            return Ok(None);
        }
        let still = primitives.apart(|primitives| {
            let still = shown.iter().filter(|(_, _, anchor)| anchor.is_none());
            still.into_iter().try_for_each(|(_, placed, _)| primitives.add_mesh(placed, globals))
        })?;
        Ok(Some(Motion { length: animation.length(), nodes, parts, still: still.map(Arc::new), turn: DMat3::IDENTITY }))
    }
}

/// Returns a mesh in coordinates in which rays can be traced, and the scale back to its own.
///
/// The scale is a power of two, so that no coordinate is rounded.
fn within_range(mesh: MeshFile) -> (MeshFile, DMat4) {
    /// Limit on the factor: a coordinate below its inverse counts as 0.
    const MAX_FACTOR: f32 = (1_u128 << 100) as f32;
    let Bounds { min, max } = Bounds::of(mesh.positions().iter().copied());
    let (farthest, extent) = (min.abs().max(max.abs()).max_element(), (max - min).max_element());
    let mut factor = 1.0;
    while !checks::are_within_range(&[Vec3::splat(farthest * factor)]) {
        factor *= 0.5;
    }
    // Of a mesh without an extent no triangle has an area.
    if factor == 1.0 && extent > 0.0 && !checks::is_long_enough(max - min) {
        while extent * factor < 1.0 && farthest * factor < 1.0 && factor < MAX_FACTOR {
            factor *= 2.0;
        }
    }
    if factor == 1.0 {
        return (mesh, DMat4::IDENTITY);
    }
    match mesh.clone().transformed(Vec3::splat(factor), Mat3::IDENTITY, Vec3::ZERO) {
        Some(scaled) => (scaled, DMat4::from_scale(DVec3::splat(1.0 / f64::from(factor)))),
        None => (mesh, DMat4::IDENTITY),
    }
}
