//! The motion of a mesh file: the parts that its animation moves, and their transforms at a time.
//!
//! A part keeps its coordinates, so that a picture of another time needs no other triangles and no other tree over
//! them: only the transforms of the parts change. A transform is a pure function of the time, without functions of the
//! platform.

mod track;

pub(super) use track::Interpolation;
pub(crate) use track::{KeyTimes, Track};

use super::MeshFile;
use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use std::collections::HashMap;
use std::sync::Arc;

/// The parts of a mesh file that move, and those that do not.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motion {
    /// The length in seconds, greater than 0, after which the motion starts again.
    pub(super) length: f64,
    /// The nodes that have key frames, each after its parent.
    pub(super) nodes: Vec<MovingNode>,
    pub(super) parts: Vec<MovingPart>,
    /// All triangles that do not move, in the coordinates of the scene; `None` if all move.
    pub(super) still: Option<Arc<MeshFile>>,
    /// The rotation of the whole.
    pub(super) turn: DMat3,
}

/// A node whose translation, rotation or scale changes with the time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MovingNode {
    /// The index of the nearest moving node above this one.
    pub(super) parent: Option<usize>,
    /// The transform from the coordinates of the node's parent to those of the moving node above,
    /// or of the scene if there is none.
    pub(super) above: DMat4,
    pub(super) translation: Channel<3>,
    pub(super) rotation: Channel<4>,
    pub(super) scale: Channel<3>,
}

/// The translation, rotation or scale of a node.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Channel<const N: usize> {
    Constant([f64; N]),
    Track(Track<N>),
}

/// The triangles that a moving node carries.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MovingPart {
    /// The index of the nearest moving node.
    pub(super) node: usize,
    /// The transform from the coordinates of the part to those of the moving node.
    pub(super) below: DMat4,
    /// The triangles, which several parts may share.
    pub(super) mesh: Arc<MeshFile>,
}

impl Channel<3> {
    fn at(&self, seconds: f64) -> DVec3 {
        match self {
            Self::Constant(vector) => DVec3::from_array(*vector),
            Self::Track(track) => DVec3::from_array(track.at(seconds)),
        }
    }
}

impl Channel<4> {
    fn at(&self, seconds: f64) -> DQuat {
        match self {
            Self::Constant(rotation) => unit(DVec4::from_array(*rotation)),
            Self::Track(track) => unit(track.rotation_at(seconds)),
        }
    }
}

/// Returns the rotation of a quaternion; the identity if its length is 0.
// Between the key frames of a spline it may be 0.
fn unit(rotation: DVec4) -> DQuat {
    rotation.try_normalize().map_or(DQuat::IDENTITY, DQuat::from_vec4)
}

impl MovingNode {
    /// Returns the transform from the node's coordinates to those of the moving node above.
    fn transform(&self, seconds: f64) -> DMat4 {
        let (scale, rotation) = (self.scale.at(seconds), self.rotation.at(seconds));
        self.above * DMat4::from_scale_rotation_translation(scale, rotation, self.translation.at(seconds))
    }
}

impl Motion {
    /// Returns the triangles of each part, in the coordinates of the part.
    pub(crate) fn meshes(&self) -> impl ExactSizeIterator<Item = &Arc<MeshFile>> {
        self.parts.iter().map(|part| &part.mesh)
    }

    /// Returns the triangles that do not move.
    pub(crate) fn still(&self) -> Option<&Arc<MeshFile>> {
        self.still.as_ref()
    }

    /// Returns whether no triangle has an area, at any time.
    pub(super) fn is_flat(&self) -> bool {
        self.meshes().chain(&self.still).all(|mesh| mesh.flat_triangle_count() == mesh.triangles().len())
    }

    /// Returns the length in seconds, after which the motion starts again.
    pub(crate) fn length(&self) -> f64 {
        self.length
    }

    /// Returns the number of triangles that are kept apart from those of the mesh at time 0.
    pub(super) fn triangle_count(&self) -> usize {
        let count = |mesh: &Arc<MeshFile>| mesh.triangles().len();
        let distinct: HashMap<_, _> = self.meshes().map(|mesh| (Arc::as_ptr(mesh), count(mesh))).collect();
        distinct.values().sum::<usize>() + self.still.as_ref().map_or(0, count)
    }

    /// Returns the transform of each part to the coordinates of the scene, at any time in seconds.
    pub(crate) fn transforms_at(&self, seconds: f64) -> Vec<DMat4> {
        let seconds = self.looped(seconds);
        let mut of_nodes: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let above = node.parent.map_or_else(|| DMat4::from_mat3(self.turn), |parent| of_nodes[parent]);
            of_nodes.push(above * node.transform(seconds));
        }
        self.parts.iter().map(|part| of_nodes[part.node] * part.below).collect()
    }

    /// Returns the time since the motion last started.
    fn looped(&self, seconds: f64) -> f64 {
        let since = libm::fmod(seconds, self.length);
        if since < 0.0 { since + self.length } else { since }
    }

    /// Returns the motion rotated about the origin; `None` if a position exceeds the range of f32.
    pub(super) fn turned(&self, turn: glam::Mat3) -> Option<Self> {
        let still = match &self.still {
            Some(still) => {
                Some(Arc::new(MeshFile::clone(still).transformed(glam::Vec3::ONE, turn, glam::Vec3::ZERO)?))
            }
            None => None,
        };
        Some(Self { still, turn: turn.as_dmat3() * self.turn, ..self.clone() })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
