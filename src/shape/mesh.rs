//! A mesh: triangles that share their corners.

use super::placement::{Place, Placement};
use super::{CheckedShape, Meshes, Shape, Surface, SurfacePoint, Triangle};
use crate::bounds::Bounds;
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::mesh_file::{MAX_TRIANGLES, MeshFile};
use crate::progress::Unfinished;
use crate::ray::{Interval, Probe, Ray};
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator};
use glam::{Vec2, Vec3};
use std::fmt;
use std::ops::{Add, Mul};

/// A triangle mesh, with the normals, colours and textures of its file.
#[derive(Clone, PartialEq)]
pub struct Mesh {
    file: MeshFile,
}

/// Shows only the number of triangles, of which there may be millions.
impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mesh").field("triangles", &self.triangle_count()).finish_non_exhaustive()
    }
}

impl Mesh {
    /// Returns the mesh that was read from a file.
    ///
    /// # Errors
    /// If a coordinate lies outside ±1e9.
    #[doc(hidden)]
    pub fn new(file: MeshFile) -> Result<Self, SceneFault> {
        if !checks::are_within_range(file.positions()) {
            return Err(SceneFault::new("positions", checks::MESH_TOO_FAR));
        }
        Ok(Self { file })
    }

    /// Returns the mesh of triangles given by the indices of their corners in `positions`.
    ///
    /// The corners of a triangle are counterclockwise when seen from outside. No ray hits a triangle without area.
    ///
    /// ```
    /// use glam::Vec3;
    /// use termtrace::Mesh;
    ///
    /// let corners = vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
    /// let square = Mesh::from_triangles(corners.clone(), vec![[0, 1, 2], [0, 2, 3]])?;
    /// assert_eq!(format!("{square:?}"), "Mesh { triangles: 2, .. }");
    ///
    /// let error = Mesh::from_triangles(corners, vec![[0, 1, 4]]).unwrap_err();
    /// assert_eq!(error.to_string(), "indices[0] is [0, 1, 4]: position 4 does not exist: there are 4");
    /// # Ok::<(), termtrace::SceneFault>(())
    /// ```
    ///
    /// # Errors
    /// Unless all coordinates lie within ±1e9, there is at least one triangle and no more than [`MAX_TRIANGLES`], and
    /// each index is less than the number of positions.
    pub fn from_triangles(positions: Vec<Vec3>, indices: Vec<[u32; 3]>) -> Result<Self, SceneFault> {
        for (at, &position) in positions.iter().enumerate() {
            checks::checked_point(format_args!("positions[{at}]"), position)?;
        }
        for (at, corners) in indices.iter().enumerate() {
            if let Some(missing) = corners.iter().find(|&&index| index as usize >= positions.len()) {
                let message = format!("position {missing} does not exist: there are {}", positions.len());
                return Err(SceneFault::new(format!("indices[{at}] is {corners:?}"), message));
            }
        }
        let count = indices.len();
        let wanted =
            || SceneFault::new("indices", format!("a mesh has 1 to {MAX_TRIANGLES} triangles; there are {count}"));
        let file = MeshFile::new(positions, indices).ok_or_else(wanted)?;
        Ok(Self { file })
    }

    /// Returns the mesh of a file with checked coordinates, or of a file made from such a file.
    pub(crate) fn of_checked(file: MeshFile) -> Self {
        Self { file }
    }

    /// Returns the number of triangles; at least one.
    pub(crate) fn triangle_count(&self) -> u32 {
        self.file.triangles().len() as u32
    }

    /// Returns whether any triangle has normals at its corners.
    pub(crate) fn is_smooth(&self) -> bool {
        self.file.has_normals()
    }

    /// Returns the content of the mesh's file: positions, triangles and materials.
    #[doc(hidden)]
    pub fn file(&self) -> &MeshFile {
        &self.file
    }

    /// Returns a triangle by its index.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[doc(hidden)]
    pub fn facet(&self, index: u32) -> Facet<'_> {
        let corners = self.file.triangles()[index as usize];
        let positions = self.file.positions();
        Facet { mesh: self, index, triangle: Triangle::unchecked(corners.map(|corner| positions[corner as usize])) }
    }
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<'m> {
    mesh: &'m Mesh,
    index: u32,
    triangle: Triangle,
}

impl Surface for Facet<'_> {
    fn bounds(&self) -> Option<Bounds> {
        self.triangle.bounds()
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        self.triangle.closest_crossing(probe, within)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let point = self.triangle.at_crossing(ray, t);
        match self.smooth(point.position, point.geometric_normal, point.uv) {
            Some((position, shading_normal)) => SurfacePoint { position, shading_normal, ..point },
            None => point,
        }
    }
}

impl Facet<'_> {
    /// Returns the triangle through the three corners, which is flat even in a smooth mesh.
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// Returns the position and the shading normal on the smooth surface that the triangle
    /// approximates.
    ///
    /// `None` if the corners have no normals. `geometric_normal` must be on the visible side. The shading normal is
    /// turned to that side, because files order corners either way.
    pub fn smooth(&self, position: Vec3, geometric_normal: Vec3, uv: Vec2) -> Option<(Vec3, Vec3)> {
        let normals = self.mesh.file.normals_of(self.index as usize)?;
        // Where opposite corner normals cancel out, the geometric normal is used.
        let smooth = interpolate(normals, uv).normalize_or(geometric_normal);
        // Files order corners clockwise or counterclockwise, so the interpolated normal may point away from the visible
        // side.
        let sign = if smooth.dot(geometric_normal) < 0.0 { -1.0 } else { 1.0 };
        Some((position + self.offset_to_smooth(position, uv, normals.map(|normal| normal * sign)), smooth * sign))
    }

    /// Returns the offset from the triangle to the smooth surface.
    ///
    /// It is interpolated from the tangent planes of the corners (Hanika, Hacking the Shadow Terminator, Ray Tracing
    /// Gems II, chapter 4), so that shadow rays do not hit neighbouring triangles at points where the smooth surface
    /// would be lit.
    fn offset_to_smooth(&self, position: Vec3, uv: Vec2, normals: [Vec3; 3]) -> Vec3 {
        let [a, b, c] = self.triangle.corners();
        let above = |corner: Vec3, normal: Vec3| normal * (corner - position).dot(normal).max(0.0);
        interpolate([above(a, normals[0]), above(b, normals[1]), above(c, normals[2])], uv)
    }

    /// Returns the product of the file's colours at a point: those of the material, texture and
    /// corners.
    pub(super) fn file_reflectance(&self, uv: Vec2) -> Option<LinearRgb> {
        let (file, index) = (&self.mesh.file, self.index as usize);
        let material = file.material_of(index).map(|index| &file.materials()[index]);
        let colors = file.colors_of(index).map(|colors| interpolate(colors, uv));
        let textured = material.and_then(|material| {
            let texture = material.texture.as_ref()?;
            let at = interpolate(file.texture_coordinates_of(index)?, uv);
            Some(texture.texture.color_at(texture.at(at)))
        });
        let own = [material.map(|material| material.reflectance), textured, colors];
        own.into_iter().flatten().reduce(|a, b| a * b)
    }
}

/// Interpolates the values of three corners; `shares` are the barycentric weights of the second and
/// the third.
fn interpolate<T: Add<Output = T> + Mul<f32, Output = T>>([a, b, c]: [T; 3], shares: Vec2) -> T {
    a * (1.0 - shares.x - shares.y) + b * shares.x + c * shares.y
}

/// A mesh as written: `Mesh(path: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenMesh {
    /// The path of the mesh's file, relative to the scene's file.
    pub path: Option<Spanned<String>>,
}

impl InSceneFile for Mesh {
    type Written = WrittenMesh;

    const NAME: &'static str = "Mesh";
    const OWNER: &'static str = "a Mesh";
    const FORM: &'static str = "Mesh(path: \"...\")";
    const FIELDS: &'static [&'static str] = &["path"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenMesh {
        let path = reader.required(fields, "path", |reader, node| reader.text(node, "the path of a mesh in quotes"));
        WrittenMesh { path }
    }
}

impl CheckedShape for Mesh {
    fn brings_colors(_: &WrittenMesh) -> bool {
        true
    }

    /// Returns the mesh of the file, whose coordinates are checked when it is placed.
    fn check(written: &WrittenMesh, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
        let path = written.path.as_ref()?;
        match meshes.mesh(&path.value) {
            Ok(file) => Some(Self { file }.into()),
            Err(Unfinished::Cancelled) => None,
            Err(Unfinished::Failed(message)) => validator.fault(path.span, || message),
        }
    }
}

impl Place for Mesh {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let Placement { scale, turn, translation } = placement;
        let file = self.file.transformed(scale.as_vec3(), turn.as_mat3(), translation.as_vec3())?;
        Some(Self { file }.into())
    }
}
