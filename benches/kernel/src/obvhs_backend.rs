//! The best portable Rust crate that was found: obvhs, with two boxes in a node and single rays.
//!
//! Spheres, plane and normals are the bench's own.
use crate::scene::*;
use glam::Vec3A;
use obvhs::{
    Boundable, BvhBuildParams,
    aabb::Aabb,
    bvh2::{
        Bvh2,
        builder::{build_bvh2, build_bvh2_from_tris},
    },
    ray::{Ray, RayHit},
    rt_triangle::RtTriangle,
    triangle::Triangle,
};
use std::time::{Duration, Instant};

pub struct Obvhs {
    bvh: Bvh2,
    /// Triangles in the order of the tree's leaves, as the crate advises. May be empty.
    triangles: Vec<RtTriangle>,
    spheres: Vec<[f32; 4]>,
    plane: Option<Plane>,
    light: Vec3A,
    eps: f32,
    pub build_s: f64,
}

struct Ball([f32; 4]);

impl Boundable for Ball {
    fn aabb(&self) -> Aabb {
        let Self([x, y, z, r]) = *self;
        let center = Vec3A::new(x, y, z);
        Aabb::new(center - r, center + r)
    }
}

impl Obvhs {
    pub fn new(s: &Scene) -> Self {
        let triangle = |t: &[u32; 3]| {
            let [v0, v1, v2] = t.map(|i| Vec3A::from_array(s.verts[i as usize]));
            Triangle { v0, v1, v2 }
        };
        let triangles: Vec<_> = s.tris.iter().map(triangle).collect();
        let balls: Vec<_> = s.spheres.iter().copied().map(Ball).collect();
        assert!(triangles.is_empty() || balls.is_empty(), "one kind in a scene");
        let (params, mut core_time) = (BvhBuildParams::medium_build(), Duration::default());
        let start = Instant::now();
        let bvh = if balls.is_empty() {
            build_bvh2_from_tris(&triangles, params, &mut core_time)
        } else {
            build_bvh2(&balls, params, &mut core_time)
        };
        let build_s = start.elapsed().as_secs_f64();
        let order = || bvh.primitive_indices.iter().map(|&i| i as usize);
        let triangles = if triangles.is_empty() { vec![] } else { order().map(|i| (&triangles[i]).into()).collect() };
        let spheres = if balls.is_empty() { vec![] } else { order().map(|i| balls[i].0).collect() };
        Self { triangles, spheres, bvh, plane: s.plane, light: s.light, eps: s.eps, build_s }
    }

    #[inline(always)]
    fn hit(&self, i: usize, ray: &Ray) -> f32 {
        match self.triangles.get(i) {
            Some(triangle) => triangle.intersect(ray),
            None => hit_sphere(&self.spheres[i], ray.origin, ray.direction, ray.tmax),
        }
    }
}

/// Infinite where there is nothing nearer.
fn hit_sphere([x, y, z, r]: &[f32; 4], o: Vec3A, d: Vec3A, tmax: f32) -> f32 {
    let f = o - Vec3A::new(*x, *y, *z);
    let dd = d.dot(d);
    let b = -f.dot(d);
    let h = f + d * (b / dd);
    let under_root = r * r - h.dot(h);
    if under_root < 0.0 {
        return f32::INFINITY;
    }
    let q = b + (under_root * dd).sqrt().copysign(b);
    let (t0, t1) = ((f.dot(f) - r * r) / q, q / dd);
    let (near, far) = (t0.min(t1), t0.max(t1));
    let t = if near > 0.0 { near } else { far };
    if t > 0.0 && t < tmax { t } else { f32::INFINITY }
}

fn hit_plane(plane: &Plane, o: Vec3A, d: Vec3A, tmax: f32) -> f32 {
    let t = (plane.h - plane.n.dot(o)) / plane.n.dot(d);
    if t > 0.0 && t < tmax { t } else { f32::INFINITY }
}

impl Tracer for Obvhs {
    #[inline(always)]
    fn closest(&self, o: Vec3A, d: Vec3A) -> Option<(f32, Vec3A)> {
        let mut ray = Ray::new_inf(o, d);
        let mut found = None;
        if let Some(plane) = &self.plane {
            let t = hit_plane(plane, o, d, ray.tmax);
            if t < ray.tmax {
                ray.tmax = t;
                found = Some((t, plane.n));
            }
        }
        let mut hit = RayHit::none();
        if self.bvh.ray_traverse(ray, &mut hit, |ray, i| self.hit(i, ray)) {
            let i = hit.primitive_id as usize;
            let normal = match self.triangles.get(i) {
                Some(triangle) => triangle.ng,
                None => o + d * hit.t - Vec3A::from_slice(&self.spheres[i]),
            };
            found = Some((hit.t, normal));
        }
        found
    }

    #[inline(always)]
    fn occluded(&self, o: Vec3A, d: Vec3A) -> bool {
        let ray = Ray::new(o, d, 0.0, 1.0);
        self.plane.as_ref().is_some_and(|plane| hit_plane(plane, o, d, 1.0) < 1.0)
            || !self.bvh.ray_traverse_miss(ray, |ray, i| self.hit(i, ray))
    }
}

impl Backend for Obvhs {
    fn name(&self) -> String {
        "obvhs/bvh2".into()
    }

    fn tile(&self, f: &Frame, x0: u32, y0: u32, x1: u32, y1: u32) -> Acc {
        single_tile(self, self.light, self.eps, f, x0, y0, x1, y1)
    }

    fn rays(&self, rays: &Rays) -> Option<(f64, Acc)> {
        Some(single_rays(self, rays))
    }
}
