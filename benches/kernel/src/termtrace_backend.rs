//! termtrace through its public functions, in the way its own renderer calls them: a tile's rays at a time, shadow rays
//! from origins that know no epsilon.
use crate::scene::{Acc, Backend, Frame, Scene};
use glam::{Vec3, Vec3A};
use std::cell::RefCell;
use std::sync::Arc;
use std::time::Instant;
use termtrace::camera::{Camera, Pose, ViewRectangle};
use termtrace::color::LinearRgb;
use termtrace::hit::{self, Hit, Kernel};
use termtrace::light::{Falloff, PointLight};
use termtrace::material::Material;
use termtrace::mesh_file::MeshFile;
use termtrace::ray::Ray;
use termtrace::scene::{Object, Scene as Traced};
use termtrace::shade::{self, TO_THE_LIGHT, shadow_ray};
use termtrace::shape::{Mesh, Plane, Shape, Sphere, SurfacePoint};

pub struct Termtrace {
    kernel: Kernel,
    scene: Arc<Traced>,
    light: PointLight,
    pub build_s: f64,
}

/// The arrays of a tile, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    points: Vec<Option<SurfacePoint>>,
    shadow_rays: Vec<Ray>,
    blocked: Vec<bool>,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

impl Termtrace {
    pub fn new(s: &Scene) -> Self {
        let grey = || Material::Diffuse(LinearRgb::grey(0.5));
        let spheres = s.spheres.iter().map(|&[x, y, z, r]| Shape::from(Sphere::new(Vec3::new(x, y, z), r)));
        let planes = s.plane.iter().map(|plane| Shape::from(Plane::new(vec3(plane.n * plane.h), vec3(plane.n))));
        let positions = s.verts.iter().copied().map(Vec3::from_array).collect();
        let mesh = MeshFile::new(positions, s.tris.clone()).map(|file| Shape::from(Mesh::from(file)));
        let shapes = spheres.chain(planes).chain(mesh);
        let objects: Vec<_> = shapes.map(|shape| Object::new(shape, grey())).collect();
        let pose = Pose { eye: vec3(s.eye), target: vec3(s.target), up: vec3(s.up) };
        let rectangle = ViewRectangle::from_vertical_fov(s.vfov.to_radians()).expect("an angle");
        let camera = Camera::new(pose, rectangle).expect("a view");
        let start = Instant::now();
        let scene = Traced::new(camera, objects);
        let build_s = start.elapsed().as_secs_f64();
        let light =
            PointLight { position: vec3(s.light), intensity: LinearRgb::grey(1.0), falloff: Falloff::InverseSquare };
        Self { kernel: Kernel::Auto, scene: Arc::new(scene), light, build_s }
    }

    /// The same scene, traced in that way.
    pub fn by(&self, kernel: Kernel) -> Self {
        Self { kernel, scene: self.scene.clone(), ..*self }
    }

    fn trace(&self, f: &Frame, rays: impl Iterator<Item = Vec3A>, buffers: &mut Buffers) -> Acc {
        let Buffers { rays: eye_rays, hits, points, shadow_rays, blocked } = buffers;
        eye_rays.clear();
        eye_rays.extend(rays.map(|d| Ray { origin: vec3(f.o), direction: vec3(d) }));
        hit::closest_hits_by(self.kernel, &self.scene, eye_rays, hits);
        let mut sum = Acc { rays: eye_rays.len() as u64, ..Acc::default() };
        sum.hits = hits.iter().flatten().count() as u64;
        sum.tsum = hits.iter().flatten().map(|hit| f64::from(hit.t)).sum();
        if f.full {
            shade::surface_points(&self.scene, eye_rays, [Vec3::ZERO; 2], hits, points);
            shadow_rays.clear();
            shadow_rays.extend(points.iter().flatten().map(|point| shadow_ray(&self.light, point)));
            hit::any_hits_by(self.kernel, &self.scene, shadow_rays, TO_THE_LIGHT, blocked);
            sum.rays += shadow_rays.len() as u64;
            sum.lit = blocked.iter().filter(|&&blocked| !blocked).count() as u64;
        }
        sum
    }
}

fn vec3(v: Vec3A) -> Vec3 {
    Vec3::from_array(v.to_array())
}

impl Backend for Termtrace {
    fn name(&self) -> String {
        format!("termtrace/{:?}", self.kernel).to_lowercase()
    }

    fn tile(&self, f: &Frame, x0: u32, y0: u32, x1: u32, y1: u32) -> Acc {
        // As the renderer goes through a tile: squares of 8 by 8, in groups of 4 by 2.
        let squares = (y0..y1).step_by(8).flat_map(|y| (x0..x1).step_by(8).map(move |x| (x, y)));
        let groups = squares.flat_map(|(x, y)| (0..8).map(move |at| (x + at % 2 * 4, y + at / 2 * 2)));
        let places = groups.flat_map(|(x, y)| (0..8).map(move |at| (x + at % 4, y + at / 4)));
        let rays = places.filter(|&(x, y)| x < x1 && y < y1).map(|(x, y)| f.dir(x, y));
        BUFFERS.with_borrow_mut(|buffers| self.trace(f, rays, buffers))
    }
}
