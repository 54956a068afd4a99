//! The pose of a glTF mesh: morph targets, then joints of a skin or the transform of the node.

use super::accessor::{Accessor, MIN_PARALLEL};
use super::animation::Animation;
use super::buffers::Buffers;
use super::json::Json;
use super::tree::nodes_in;
use crate::mesh_file::builder::unit;
use crate::mesh_file::fault::MeshFault;
use crate::threads;
use glam::{DMat3, DMat4, Vec3};

/// The transforms of all nodes to the scene's coordinates at time 0, for the joints of skins; empty
/// in a file without skins.
pub(super) struct Globals {
    transforms: Vec<DMat4>,
    /// Whether the animation moves each node, or one above it.
    moves: Vec<bool>,
}

impl Globals {
    pub(super) fn of(root: Json<'_>, animation: &Animation) -> Result<Self, MeshFault> {
        let count = if root.list_len("skins")? > 0 { root.list_len("nodes")? } else { 0 };
        let mut globals = Self { transforms: vec![DMat4::IDENTITY; count], moves: vec![false; count] };
        if count == 0 {
            return Ok(globals);
        }
        let mut is_child = vec![false; count];
        for node in root.list("nodes")? {
            for (child, _) in nodes_in(node, "children", root)? {
                is_child[child] = true;
            }
        }
        let roots = root.list("nodes")?.enumerate().filter(|&(number, _)| !is_child[number]);
        let mut open: Vec<_> = roots.map(|node| (node, DMat4::IDENTITY, false)).collect();
        let mut is_visited = vec![false; count];
        while let Some(((number, node), parent, is_moved)) = open.pop() {
            if std::mem::replace(&mut is_visited[number], true) {
                return Err(node.fault("this node is reached twice: nodes must form a tree"));
            }
            let transform = parent * animation.local_transform(number, node)?;
            let moves = is_moved || animation.moves_node(number);
            (globals.transforms[number], globals.moves[number]) = (transform, moves);
            open.extend(nodes_in(node, "children", root)?.into_iter().map(|child| (child, transform, moves)));
        }
        Ok(globals)
    }

    /// Returns whether the animation moves a joint of the skin of a node.
    pub(super) fn moves_skin_of<'a>(&self, node: Json<'a>, root: Json<'a>) -> Result<bool, MeshFault> {
        let Some(skin) = node.field("skin")? else { return Ok(false) };
        let (_, skin) = skin.item_of(root, "skins")?;
        Ok(nodes_in(skin, "joints", root)?.iter().any(|&(number, _)| self.moves[number]))
    }

    /// Returns the matrices of a skin's joints.
    pub(super) fn joints<'a>(&self, skin: Json<'a>, buffers: &mut Buffers<'a, '_>) -> Result<Vec<DMat4>, MeshFault> {
        let (_, skin) = skin.item_of(buffers.root(), "skins")?;
        let joints = nodes_in(skin, "joints", buffers.root())?;
        let mut matrices: Vec<_> = joints.iter().map(|&(number, _)| self.transforms[number]).collect();
        if let Some(index) = skin.field("inverseBindMatrices")? {
            let inverse = Accessor::read(index, buffers)?.vectors::<16>()?;
            if inverse.len() < matrices.len() {
                return Err(skin.fault(format!("{} joints have only {} matrices", matrices.len(), inverse.len())));
            }
            for (matrix, inverse) in matrices.iter_mut().zip(inverse) {
                *matrix *= DMat4::from_cols_array(&inverse.map(f64::from));
            }
        }
        Ok(matrices)
    }
}

/// Returns whether a primitive of a mesh has no joints, so that the node places it even if the mesh
/// has a skin.
pub(super) fn has_primitive_without_joints(mesh: Json<'_>) -> Result<bool, MeshFault> {
    for primitive in mesh.list("primitives")? {
        if primitive.required("attributes")?.field(JOINTS[0][0])?.is_none() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The pose of the mesh of a node.
pub(super) struct Pose<'a> {
    /// The node, for faults.
    pub(super) node: Json<'a>,
    pub(super) transform: DMat4,
    /// The matrices of the skin's joints; empty without a skin.
    pub(super) joints: Vec<DMat4>,
    /// The weights of the morph targets.
    pub(super) weights: Vec<f64>,
}

/// The names of the attributes of skins: joints and weights, four at a time.
const JOINTS: [[&str; 2]; 2] = [["JOINTS_0", "WEIGHTS_0"], ["JOINTS_1", "WEIGHTS_1"]];

/// Limit on the morph targets that move a mesh at once: all of them are added for each vertex.
const MAX_TARGETS: usize = 64;

impl<'a> Pose<'a> {
    /// Returns whether a skin or morph targets move the mesh: they may differ between primitives.
    pub(super) fn differs_by_primitive(&self) -> bool {
        !self.joints.is_empty() || !self.weights.is_empty()
    }

    /// Returns the posed positions or normals of a primitive in the coordinates of the glTF scene.
    pub(super) fn placed(
        &self,
        primitive: Json<'a>,
        name: &'static str,
        mut vectors: Vec<[f32; 3]>,
        buffers: &mut Buffers<'a, '_>,
    ) -> Result<Vec<Vec3>, MeshFault> {
        self.add_targets(primitive, name, &mut vectors, buffers)?;
        let matrices = self.matrices(primitive, vectors.len(), buffers)?;
        let matrix = |i: usize| matrices.as_ref().map_or(self.transform, |matrices| matrices[i]);
        let place = |i: usize| {
            let vector = Vec3::from(vectors[i]).as_dvec3();
            if name == "NORMAL" {
                return unit(cofactors(DMat3::from_mat4(matrix(i))) * vector);
            }
            matrix(i).transform_point3(vector).as_vec3()
        };
        let count = vectors.len();
        let is_parallel = buffers.is_parallel() && count >= MIN_PARALLEL;
        Ok(if is_parallel { threads::map(count, place) } else { (0..count).map(place).collect() })
    }

    /// Adds the weighted morph targets.
    fn add_targets(
        &self,
        primitive: Json<'a>,
        name: &'static str,
        vectors: &mut [[f32; 3]],
        buffers: &mut Buffers<'a, '_>,
    ) -> Result<(), MeshFault> {
        let weighted = primitive.list("targets")?.zip(&self.weights).filter(|&(_, &weight)| weight != 0.0);
        for (number, (target, &weight)) in weighted.enumerate() {
            if number == MAX_TARGETS {
                return Err(primitive.fault(format!("more than {MAX_TARGETS} morph targets have a weight")));
            }
            let Some(index) = target.field(name)? else { continue };
            let offsets = Accessor::read(index, buffers)?.vectors::<3>()?;
            if offsets.len() != vectors.len() {
                return Err(target.fault(format!("{} vertices have {} offsets", vectors.len(), offsets.len())));
            }
            for (vector, offset) in vectors.iter_mut().zip(offsets) {
                for (sum, offset) in vector.iter_mut().zip(offset) {
                    *sum += (weight * f64::from(offset)) as f32;
                }
            }
        }
        Ok(())
    }

    /// Returns the matrix of each vertex; `None` without a skin.
    fn matrices(
        &self,
        primitive: Json<'a>,
        count: usize,
        buffers: &mut Buffers<'a, '_>,
    ) -> Result<Option<Vec<DMat4>>, MeshFault> {
        let attributes = primitive.required("attributes")?;
        // A primitive without joints in a mesh with a skin is placed by its node.
        if self.joints.is_empty() || attributes.field(JOINTS[0][0])?.is_none() {
            return Ok(None);
        }
        // glTF: the joints alone place a vertex with a skin; the transform of its node is ignored.
        let mut sums = vec![(DMat4::ZERO, 0.0); count];
        for [joints, weights] in JOINTS {
            let names = [joints, weights];
            let (Some(joints), Some(weights)) = (attributes.field(joints)?, attributes.field(weights)?) else {
                continue;
            };
            let indices = Accessor::of_attribute(primitive, names[0], joints, buffers)?;
            let shares = Accessor::of_attribute(primitive, names[1], weights, buffers)?.vectors::<4>()?;
            let numbers = indices.vectors::<4>()?;
            if numbers.len() != count || shares.len() != count {
                return Err(
                    attributes.fault(format!("{count} vertices have {} joints", numbers.len().min(shares.len())))
                );
            }
            for ((sum, total), (numbers, shares)) in sums.iter_mut().zip(numbers.into_iter().zip(shares)) {
                for (number, share) in numbers.into_iter().zip(shares).filter(|&(_, share)| share != 0.0) {
                    let Some(joint) = self.joints.get(number as usize) else {
                        let joints = self.joints.len();
                        return Err(indices.fault(format!("joint {number} does not exist: the skin has {joints}")));
                    };
                    *sum += *joint * f64::from(share);
                    *total += f64::from(share);
                }
            }
        }
        // The sum of a vertex's weights should be 1; dividing by it makes up for other sums. A vertex without weights
        // is placed by its node.
        let mean = |(sum, total)| if total == 0.0 { self.transform } else { sum * (1.0 / total) };
        Ok(Some(sums.into_iter().map(mean).collect()))
    }
}

/// Returns the matrix that transforms normals: the inverse transpose times a positive factor.
/// Unlike the inverse, the matrix of cofactors also exists for singular matrices, which flatten a mesh.
fn cofactors(matrix: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = matrix;
    let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z) * sign, z.cross(x) * sign, x.cross(y) * sign)
}
