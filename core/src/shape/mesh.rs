//! A mesh: triangles that share their corners.

use super::instance::{CornerCells, Passage};
use super::moving::{MeshMotion, PartPlace, Poses};
use super::placement::{AffineMap, Placeable, Placement};
use super::{ChartPoint, CheckedShape, Meshes, Shape, Surface, SurfacePoint, Triangle};
use crate::bounds::Bounds;
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::mesh_file::{MAX_TRIANGLES, MeshFile, MeshMaterial};
use crate::progress::Unfinished;
use crate::ray::{Interval, Probe, Ray};
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator};
use glam::{DVec3, Vec2, Vec3};
use std::fmt;
use std::ops::{Add, Mul};
use std::sync::{Arc, OnceLock};

/// A triangle mesh, with the normals, colours and textures of its file.
///
/// Its triangles are those of the file. If the mesh is an instance, it shares them with other meshes, and maps them to
/// the scene.
#[derive(Clone)]
pub struct Mesh {
    file: Arc<MeshFile>,
    /// The smallest box around the mesh in the scene, computed when it is needed.
    bounds: OnceLock<Bounds>,
    /// The map from the coordinates of the file to the scene, if the mesh is an instance.
    map: Option<AffineMap>,
    /// The motion, from which the map follows.
    motion: Option<Arc<MeshMotion>>,
    /// Whether the mesh is nowhere at this time, so that no ray may be mapped to it.
    is_nowhere: bool,
}

/// Compares what is drawn.
///
/// The bounds follow from it, and may be computed for one of two equal meshes only.
impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        self.file == other.file && self.map == other.map && self.motion == other.motion
    }
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
        Ok(Self::of_checked(file))
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
        Ok(Self::of_checked(file))
    }

    /// Returns the mesh of a file with checked coordinates, or of a file made from such a file.
    pub(crate) fn of_checked(file: impl Into<Arc<MeshFile>>) -> Self {
        Self { file: file.into(), bounds: OnceLock::new(), map: None, motion: None, is_nowhere: false }
    }

    /// Returns the mesh of a file with checked coordinates, and the smallest box around it.
    pub(crate) fn within(file: MeshFile, bounds: Bounds) -> Self {
        Self { bounds: bounds.into(), ..Self::of_checked(file) }
    }

    /// Returns the instance of a mesh with this placement; `None` if it reaches too far.
    #[cfg(feature = "ron")]
    pub(crate) fn instance(file: &Arc<MeshFile>, corners: &CornerCells, placement: &Placement) -> Option<Self> {
        let map = Some(placement.map());
        let bounds = corners.bounds(map.as_ref());
        checks::are_within_range(&[bounds.min, bounds.max]).then(|| Self {
            file: Arc::clone(file),
            bounds: OnceLock::from(bounds),
            map,
            motion: None,
            is_nowhere: false,
        })
    }

    /// Returns the mesh scaled, rotated and moved; it shares the triangles of its file.
    ///
    /// `of_file` is a box around the triangles of the file. The box of the mesh contains it, and may be larger than the
    /// smallest one.
    // The smallest box takes a look at all corners, which is too much for each of many copies.
    pub(super) fn placed_sharing(&self, placement: &Placement, of_file: &Bounds) -> Self {
        let new = placement.map();
        let map = self.map.as_ref().map_or(new, |old| old.then(&new));
        let [min, max] = [of_file.min, of_file.max].map(Vec3::as_dvec3);
        let half = (max - min) * 0.5;
        let bounds = AffineMap::bounds(Some(&map), (min + max) * 0.5, |direction| half.dot(direction.abs()));
        Self { map: Some(map), bounds: bounds.into(), ..self.clone() }
    }

    /// Returns a moving mesh at one place of its motion.
    pub(super) fn moving(file: Arc<MeshFile>, motion: Arc<MeshMotion>, place: &PartPlace) -> Self {
        let (map, bounds, is_nowhere) = match place {
            PartPlace::Seen(map, bounds) => (*map, *bounds, false),
            PartPlace::Nowhere | PartPlace::TooFar => (AffineMap::NOWHERE, Bounds::of([Vec3::ZERO]), true),
        };
        Self { file, bounds: bounds.into(), map: Some(map), motion: Some(motion), is_nowhere }
    }

    /// Returns whether the mesh depends on the time.
    pub(crate) fn moves(&self) -> bool {
        self.motion.is_some()
    }

    /// Returns the length of the motion in seconds, after which it starts again; `None` if the mesh
    /// does not move.
    pub(crate) fn motion_length(&self) -> Option<f64> {
        self.motion.as_ref().map(|motion| motion.length())
    }

    /// Returns whether the mesh is nowhere at this time, so that no ray may be traced to it.
    pub(crate) fn is_nowhere(&self) -> bool {
        self.is_nowhere
    }

    /// Returns the mesh at the time of the poses.
    pub(crate) fn at_time(&self, poses: &mut Poses) -> Self {
        let Some(motion) = &self.motion else { return self.clone() };
        Self::moving(Arc::clone(&self.file), Arc::clone(motion), &motion.place_in(poses))
    }

    /// Returns the ray in the coordinates of the file; each t stays that of the same point.
    pub(crate) fn file_ray(&self, ray: &Ray) -> Ray {
        self.map.as_ref().map_or(*ray, |map| map.shape_ray(ray))
    }

    /// Returns whether the mesh shares the triangles of its file with other meshes.
    pub(crate) fn is_instance(&self) -> bool {
        self.map.is_some()
    }

    /// Returns the file, which instances share.
    pub(crate) fn shared_file(&self) -> &Arc<MeshFile> {
        &self.file
    }

    /// Returns the mesh of another file; an instance keeps its place.
    #[cfg(feature = "mesh")]
    pub(crate) fn with_file(&self, file: Arc<MeshFile>) -> Self {
        Self { file, bounds: OnceLock::new(), ..self.clone() }
    }

    /// Returns the smallest box around the mesh.
    pub(crate) fn bounds(&self) -> &Bounds {
        self.bounds.get_or_init(|| match &self.map {
            None => Bounds::of(self.file.positions().iter().copied()),
            map => CornerCells::of(&self.file).bounds(map.as_ref()),
        })
    }

    // Not part of `facet`, so that the code of `facet` for meshes that are no instances stays short.
    #[cold]
    fn corners_in_scene(&self, corners: [Vec3; 3]) -> [Vec3; 3] {
        let Some(map) = &self.map else { return corners };
        self.in_order(corners.map(|corner| map.point(corner.as_dvec3()).as_vec3()))
    }

    /// Returns the corners of a triangle as in the file.
    #[inline]
    pub(crate) fn file_corners(&self, index: u32) -> [Vec3; 3] {
        self.file.triangles()[index as usize].map(|corner| self.file.positions()[corner as usize])
    }

    /// Returns the values of a triangle's corners in the order in the scene, from that in the file.
    fn in_order<T>(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        if self.map.as_ref().is_some_and(AffineMap::is_mirrored) { [a, c, b] } else { [a, b, c] }
    }

    /// Returns the number of triangles; at least one.
    #[doc(hidden)]
    pub fn triangle_count(&self) -> u32 {
        self.file.triangles().len() as u32
    }

    /// Returns whether the file has texture coordinates, which are the mesh's chart.
    #[cfg(feature = "ron")]
    pub(crate) fn has_chart(&self) -> bool {
        !self.file.texture_coordinates().values().is_empty()
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
    #[inline]
    pub fn facet(&self, index: u32) -> Facet<'_> {
        let corners = self.file_corners(index);
        let corners = if self.map.is_some() { self.corners_in_scene(corners) } else { corners };
        Facet { mesh: self, index, triangle: Triangle::unchecked(corners) }
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
        let Some(map) = &self.mesh.map else { return self.triangle.closest_crossing(probe, within) };
        if self.mesh.is_nowhere {
            return None;
        }
        let Interval { min, max } = self.mesh.bounds().crossed(probe);
        let passage = Passage::new([min, max], within)?;
        let triangle = Triangle::unchecked(self.mesh.file_corners(self.index));
        let t = triangle.closest_crossing(&Probe::new(map.shape_ray(&probe.ray)), passage.search())?;
        Some(passage.clamp_to_box(t))
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let point = self.flat_point(ray, t);
        match self.smooth_position_and_normal(point.position, point.geometric_normal, point.uv) {
            Some((position, shading_normal)) => SurfacePoint { position, shading_normal, ..point },
            None => point,
        }
    }

    /// Returns the texture coordinates of the file.
    fn chart(&self, point: &ChartPoint) -> Option<Vec2> {
        self.texture_coordinates(point.uv)
    }
}

impl Facet<'_> {
    /// Returns the triangle through the three corners, which is flat even in a smooth mesh.
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// Returns the point of the triangle at a crossing.
    // The point of an instance is computed in the coordinates of the file, in which the ray was found to hit: in those
    // of the scene the ray could pass beside the edge of the triangle.
    pub(crate) fn flat_point(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let Some(map) = &self.mesh.map else { return self.triangle.at_crossing(ray, t) };
        let triangle = Triangle::unchecked(self.mesh.file_corners(self.index));
        let point = triangle.at_crossing(&map.shape_ray(ray), t);
        let [_, u, v] = self.mesh.in_order([0.0, point.uv.x, point.uv.y]);
        let normal = unit(map.normal(point.geometric_normal.as_dvec3()));
        let corners = self.triangle.corners().into_iter().chain([map.point(DVec3::ZERO).as_vec3()]);
        let size = corners.fold(0.0, |size: f32, corner| size.max(corner.abs().max_element()));
        SurfacePoint {
            position: map.point(point.position.as_dvec3()).as_vec3(),
            shading_normal: normal,
            geometric_normal: normal,
            clearance: super::CLEARANCE * size,
            uv: Vec2::new(u, v),
            ..point
        }
    }

    /// Returns the normals at the corners of an instance, from those in the file.
    #[cold]
    fn normals_in_scene(&self, normals: [Vec3; 3]) -> [Vec3; 3] {
        let Some(map) = &self.mesh.map else { return normals };
        self.mesh.in_order(normals.map(|normal| unit(map.normal(normal.as_dvec3()))))
    }

    /// Returns the position and the shading normal on the smooth surface that the triangle
    /// approximates.
    ///
    /// `None` if the corners have no normals. `geometric_normal` must be on the visible side. The shading normal is
    /// turned to that side, because files order corners either way.
    pub fn smooth_position_and_normal(&self, position: Vec3, geometric_normal: Vec3, uv: Vec2) -> Option<(Vec3, Vec3)> {
        let normals = self.mesh.file.normals_of(self.index as usize)?;
        let normals = if self.mesh.map.is_some() { self.normals_in_scene(normals) } else { normals };
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

    /// Returns the material of the triangle in the file.
    pub(crate) fn file_material(&self) -> Option<&MeshMaterial> {
        let file = &self.mesh.file;
        file.material_of(self.index as usize).map(|index| &file.materials()[index])
    }

    /// Returns the texture coordinates at a point, if the triangle has any.
    pub(crate) fn texture_coordinates(&self, uv: Vec2) -> Option<Vec2> {
        let corners = self.mesh.file.texture_coordinates_of(self.index as usize)?;
        Some(interpolate(self.mesh.in_order(corners), uv))
    }

    /// Returns the product of the file's colours at a point: those of the material, texture and
    /// corners.
    pub(super) fn file_reflectance(&self, uv: Vec2) -> Option<LinearRgb> {
        let (file, index) = (&self.mesh.file, self.index as usize);
        let material = self.file_material();
        let colors = file.colors_of(index).map(|colors| interpolate(self.mesh.in_order(colors), uv));
        let textured = material.and_then(|material| {
            let texture = material.texture.as_ref()?;
            Some(texture.color_at(self.texture_coordinates(uv)?))
        });
        let own = [material.map(|material| material.reflectance), textured, colors];
        own.into_iter().flatten().reduce(|a, b| a * b)
    }
}

/// Returns a normal with unit length, in single precision.
fn unit(normal: DVec3) -> Vec3 {
    // Divided by its largest component first, so that no square overflows or underflows.
    (normal / normal.abs().max_element()).normalize().as_vec3()
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
    const SUMMARY: &'static str = "A mesh from a file.";
    const MEANINGS: &'static [&'static str] =
        &["the path of an OBJ, STL, PLY or glTF file, relative to the scene file, in quotes"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenMesh {
        let path = reader.required(fields, "path", |reader, node| reader.text(node, "the path of a mesh in quotes"));
        WrittenMesh { path }
    }
}

impl CheckedShape for Mesh {
    const HAS_CHART: bool = true;

    fn brings_colors(_: &WrittenMesh) -> bool {
        true
    }

    /// Returns the mesh of the file, whose coordinates are checked when it is placed.
    fn check(written: &WrittenMesh, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
        let path = written.path.as_ref()?;
        match meshes.mesh(&path.value) {
            Ok(file) => Some(Self::of_checked(file).into()),
            Err(Unfinished::Cancelled) => None,
            Err(Unfinished::Failed(message)) => validator.fault(path.span, || message),
        }
    }
}

impl Placeable for Mesh {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let Placement { scale, turn, translation } = placement;
        if let Some(old) = &self.map {
            let map = Some(old.then(&placement.map()));
            return Some(Self { map, bounds: OnceLock::new(), ..self }.into());
        }
        let file = Arc::unwrap_or_clone(self.file);
        Some(Self::of_checked(file.transformed(scale.as_vec3(), turn.as_mat3(), translation.as_vec3())?).into())
    }
}
