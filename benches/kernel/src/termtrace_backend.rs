//! termtrace through its public functions, called as its own renderer does.
//!
//! A tile's rays at a time, and shadow rays from origins without an epsilon.
use crate::scene::{Acc, Backend, Frame, Rays, Scene};
use glam::{Vec3, Vec3A};
use std::cell::RefCell;
use std::sync::Arc;
use std::time::Instant;
use termtrace::internals::hit::{self, EightHits, Kernel};
use termtrace::internals::lanes::{F32x8, Vector};
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::ray::{EightRays, Ray};
use termtrace::internals::shade::{self, EightPoints};
use termtrace::{
    Camera, Light, LinearRgb, Material, Mesh, Object, Plane, PointLight, Pose, Scene as Traced, Shape, Sphere,
    ViewRectangle,
};

pub struct Termtrace {
    kernel: Kernel,
    scene: Arc<Traced>,
    light: Light,
    pub build_s: f64,
}

/// The arrays of a tile, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadow_rays: Vec<EightRays>,
    blocked: Vec<u32>,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

impl Termtrace {
    pub fn new(s: &Scene) -> Self {
        let grey = || Material::diffuse(LinearRgb::grey(0.5)).expect("a reflectance");
        let spheres =
            s.spheres.iter().map(|&[x, y, z, r]| Shape::from(Sphere::new(Vec3::new(x, y, z), r).expect("a sphere")));
        let planes = s
            .plane
            .iter()
            .map(|plane| Shape::from(Plane::new(vec3(plane.n * plane.h), vec3(plane.n)).expect("a plane")));
        let positions = s.verts.iter().copied().map(Vec3::from_array).collect();
        let mesh =
            MeshFile::new(positions, s.tris.clone()).map(|file| Shape::from(Mesh::new(file).expect("a mesh nearby")));
        let shapes = spheres.chain(planes).chain(mesh);
        let objects: Vec<_> = shapes.map(|shape| Object::new(shape, grey())).collect();
        let pose = Pose { eye: vec3(s.eye), target: vec3(s.target), up: vec3(s.up) };
        let rectangle = ViewRectangle::from_vertical_fov(s.vfov.to_radians()).expect("an angle");
        let camera = Camera::new(pose, rectangle).expect("a view");
        let start = Instant::now();
        let scene = Traced::new(camera, objects);
        let build_s = start.elapsed().as_secs_f64();
        let light: Light = PointLight::new(vec3(s.light), LinearRgb::grey(1.0)).expect("a light").into();
        Self { kernel: Kernel::Auto, scene: Arc::new(scene), light, build_s }
    }

    /// The size of the trees and their leaves.
    pub fn tree_bytes(&self) -> usize {
        self.scene.tree_bytes()
    }

    /// Returns the same scene, traced by that kernel.
    pub fn by(&self, kernel: Kernel) -> Self {
        Self { kernel, scene: self.scene.clone(), ..*self }
    }

    fn trace(&self, full: bool, buffers: &mut Buffers) -> Acc {
        let Buffers { rays, hits, points, shadow_rays, blocked } = buffers;
        hit::closest_hits(self.kernel, &self.scene, rays, hits);
        let mut sum = Acc::default();
        for hits in hits.iter() {
            sum.hits += u64::from(hits.hit_mask.count_ones());
            sum.tsum += depths(hits);
        }
        if full {
            shade::surface_points(&self.scene, rays, hits, points);
            shade::shadow_rays(&self.light, points, shadow_rays);
            hit::any_hits(self.kernel, &self.scene, shadow_rays, self.light.blocking_interval(), blocked);
            // One from each hit.
            sum.rays = sum.hits;
            sum.lit = sum.hits - blocked.iter().map(|met| u64::from(met.count_ones())).sum::<u64>();
        }
        sum
    }
}

/// Rays through four by two pixels, those inside the tile.
fn eye_rays(f: &Frame, [x, y]: [u32; 2], [x1, y1]: [u32; 2]) -> EightRays {
    let (across, down) =
        (F32x8([0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0]), F32x8([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]));
    let (at_x, at_y) = (F32x8([x as f32; 8]) + across, F32x8([y as f32; 8]) + down);
    let [d00, du, dv] = [f.d00, f.du, f.dv].map(|v| Vector::splat(vec3(v)));
    let is_inside = |lane: u32| x + lane % 4 < x1 && y + lane / 4 < y1;
    let active = if is_inside(7) {
        0xff
    } else {
        (0..8).filter(|&lane| is_inside(lane)).fold(0, |active, lane| active | 1 << lane)
    };
    EightRays { origin: Vector::splat(vec3(f.o)), direction: d00 + du * at_x + dv * at_y, active }
}

/// The sum of the depths of what is met, without a branch for each.
fn depths(hits: &EightHits) -> f64 {
    let depth = |lane: usize| if hits.hit_mask >> lane & 1 == 1 { f64::from(hits.t.0[lane]) } else { 0.0 };
    let [a, b, c, d] = [0, 2, 4, 6].map(|lane| [depth(lane), depth(lane + 1)]);
    (a[0] + b[0]) + (c[0] + d[0]) + ((a[1] + b[1]) + (c[1] + d[1]))
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
        BUFFERS.with_borrow_mut(|buffers| {
            let squares = (y0..y1).step_by(8).flat_map(|y| (x0..x1).step_by(8).map(move |x| (x, y)));
            let groups = squares.flat_map(|(x, y)| (0..8).map(move |at| [x + at % 2 * 4, y + at / 2 * 2]));
            buffers.rays.clear();
            buffers.rays.extend(groups.map(|at| eye_rays(f, at, [x1, y1])));
            let sum = self.trace(f.full, buffers);
            Acc { rays: sum.rays + u64::from((x1 - x0) * (y1 - y0)), ..sum }
        })
    }

    fn rays(&self, rays: &Rays) -> Option<(f64, Acc)> {
        if self.kernel == Kernel::Packet {
            // By force together where nothing is: that is not to be waited for.
            return None;
        }
        let ray = |&[o, d]: &[Vec3A; 2]| Ray { origin: vec3(o), direction: vec3(d) };
        let eight = |rays: &[[Vec3A; 2]]| EightRays::of(&rays.iter().map(ray).collect::<Vec<_>>());
        let given: Vec<_> = rays.rays.chunks(8).map(eight).collect();
        let (mut hits, mut blocked) = (Vec::new(), Vec::new());
        let mut sum = Acc { rays: rays.rays.len() as u64, ..Acc::default() };
        let start = Instant::now();
        for rays_of_a_tile in given.chunks(128) {
            if rays.any {
                hit::any_hits(self.kernel, &self.scene, rays_of_a_tile, self.light.blocking_interval(), &mut blocked);
                sum.lit +=
                    shade::count(rays_of_a_tile) - blocked.iter().map(|met| u64::from(met.count_ones())).sum::<u64>();
            } else {
                hit::closest_hits(self.kernel, &self.scene, rays_of_a_tile, &mut hits);
                for hits in &hits {
                    sum.hits += u64::from(hits.hit_mask.count_ones());
                    sum.tsum += depths(hits);
                }
            }
        }
        Some((start.elapsed().as_secs_f64(), sum))
    }
}
