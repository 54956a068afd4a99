//! The moving nodes of a glTF file, and the meshes that they carry.

use super::animation::{Animation, NodeChannels};
use super::pose::Globals;
use super::primitives::{Placed, Primitives};
use super::tree::IndexedNode;
use crate::mesh_file::MeshFile;
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::motion::{Motion, MovingNode, MovingPart};
use crate::progress::Meter;
use glam::{DMat3, DMat4};
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
        let mut meshes: HashMap<MeshKey, Option<Arc<MeshFile>>> = HashMap::new();
        let mut parts = Vec::new();
        for (key, placed, anchor) in &shown {
            meter.report_indeterminate()?;
            let Some((node, below)) = *anchor else { continue };
            if !meshes.contains_key(key) {
                let placed = Placed { transform: DMat4::IDENTITY, ..*placed };
                let mesh = primitives.apart(|primitives| primitives.add_mesh(&placed, globals))?;
                meshes.insert(*key, mesh.map(Arc::new));
            }
            parts.extend(meshes[key].clone().map(|mesh| MovingPart { node, below, mesh }));
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
