//! Scenes, camera, and the work every backend does: one primary ray a pixel, one shadow ray a hit.
use glam::Vec3A;

#[derive(Clone, Copy)]
pub struct Plane {
    pub n: Vec3A,
    pub h: f32,
} // n·p = h

pub struct Scene {
    pub name: String,
    pub spheres: Vec<[f32; 4]>,
    pub verts: Vec<[f32; 3]>,
    pub tris: Vec<[u32; 3]>,
    pub plane: Option<Plane>,
    pub light: Vec3A,
    pub eye: Vec3A,
    pub target: Vec3A,
    pub up: Vec3A,
    pub vfov: f32,
    pub eps: f32,
}

impl Scene {
    pub fn prims(&self) -> usize {
        self.spheres.len() + self.tris.len()
    }
}

struct Rng(u64);
impl Rng {
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 40) as f32) * (1.0 / 16777216.0)
    }
}

fn base(name: &str) -> Scene {
    Scene {
        name: name.into(),
        spheres: vec![],
        verts: vec![],
        tris: vec![],
        plane: None,
        light: Vec3A::new(4.0, 6.0, 5.0),
        eye: Vec3A::new(0.0, 1.2, 5.0),
        target: Vec3A::new(0.0, 0.4, 0.0),
        up: Vec3A::Y,
        vfov: 40.0,
        eps: 1e-3,
    }
}

/// A (2,3) torus knot of `nu * nv * 2` triangles with a little displacement.
///
/// It needs no file, and is the same everywhere but for libm's last bit.
fn knot(name: &str, nu: u32, nv: u32) -> Scene {
    let mut s = base(name);
    let pos = |u: f64| {
        let r = 1.0 + 0.45 * (3.0 * u).cos();
        glam::DVec3::new(r * (2.0 * u).cos(), 0.45 * (3.0 * u).sin(), r * (2.0 * u).sin())
    };
    let tau = std::f64::consts::TAU;
    for i in 0..nu {
        let u = tau * i as f64 / nu as f64;
        let p = pos(u);
        let t = (pos(u + 1e-4) - pos(u - 1e-4)).normalize();
        let b = t.cross(glam::DVec3::Y).normalize();
        let n = b.cross(t);
        for j in 0..nv {
            let v = tau * j as f64 / nv as f64;
            let rad = 0.27 * (1.0 + 0.05 * (40.0 * u).sin() * (9.0 * v).cos());
            s.verts.push((p + (b * v.cos() + n * v.sin()) * rad).as_vec3().to_array());
        }
    }
    for i in 0..nu {
        for j in 0..nv {
            let (i1, j1) = ((i + 1) % nu, (j + 1) % nv);
            let (a, b, c, d) = (i * nv + j, i1 * nv + j, i1 * nv + j1, i * nv + j1);
            s.tris.push([a, b, c]);
            s.tris.push([a, c, d]);
        }
    }
    s.eye = Vec3A::new(0.6, 3.0, 3.4);
    s.target = Vec3A::ZERO;
    s.vfov = 38.0;
    s
}

/// `FILE.tri`: u32 vertices, u32 triangles, then f32 xyz and u32 abc, little endian.
fn mesh(path: &str) -> Scene {
    let b = std::fs::read(path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let u = |i: usize| u32::from_le_bytes(b[i * 4..i * 4 + 4].try_into().unwrap());
    let (nv, nt) = (u(0) as usize, u(1) as usize);
    let mut s = base(std::path::Path::new(path).file_stem().unwrap().to_str().unwrap());
    s.verts = (0..nv).map(|i| [0, 1, 2].map(|k| f32::from_bits(u(2 + i * 3 + k)))).collect();
    s.tris = (0..nt).map(|i| [0, 1, 2].map(|k| u(2 + nv * 3 + i * 3 + k))).collect();
    let (mut lo, mut hi) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    for v in &s.verts {
        lo = lo.min(Vec3A::from_array(*v));
        hi = hi.max(Vec3A::from_array(*v));
    }
    let (c, k) = ((lo + hi) * 0.5, 2.0 / (hi - lo).max_element());
    for v in &mut s.verts {
        *v = ((Vec3A::from_array(*v) - c) * k).to_array();
    }
    s.eye = Vec3A::new(0.4, 0.5, 2.6);
    s.target = Vec3A::ZERO;
    s
}

pub fn load(name: &str) -> Scene {
    match name {
        "three" => {
            let mut s = base(name);
            s.spheres = vec![[0.0, 0.7, 0.0, 0.7], [-1.4, 0.5, 0.4, 0.5], [1.3, 0.4, 0.7, 0.4]];
            s.plane = Some(Plane { n: Vec3A::Y, h: 0.0 });
            s
        }
        "s1k" | "s100k" => {
            let (n, r0) = if name == "s1k" { (1000, 0.06) } else { (100_000, 0.013) };
            let mut s = base(name);
            let mut g = Rng(0x9E3779B97F4A7C15);
            s.spheres = (0..n)
                .map(|_| {
                    let p = [g.next(), g.next(), g.next()].map(|x| x * 2.4 - 1.2);
                    [p[0], p[1] + 0.4, p[2], r0 * (0.5 + g.next())]
                })
                .collect();
            s
        }
        "knot70k" => knot(name, 500, 70),
        "knot300k" => knot(name, 1000, 150),
        "knot1200k" => knot(name, 2400, 250),
        p => mesh(p),
    }
}

/// Pinhole: direction of pixel (x, y) is `d00 + x du + y dv`, with dir·w = 1, so that t is depth.
#[derive(Clone, Copy)]
pub struct Frame {
    pub o: Vec3A,
    pub d00: Vec3A,
    pub du: Vec3A,
    pub dv: Vec3A,
    pub width: u32,
    pub height: u32,
    pub full: bool,
}

impl Frame {
    pub fn new(s: &Scene, width: u32, height: u32, spp_side: u32, full: bool) -> Frame {
        let w = (s.target - s.eye).normalize();
        let u = w.cross(s.up).normalize();
        let v = u.cross(w);
        let h = (s.vfov.to_radians() * 0.5).tan();
        let a = width as f32 / height as f32;
        let (width, height) = (width * spp_side, height * spp_side);
        let du = u * (2.0 * h * a / width as f32);
        let dv = v * (-2.0 * h / height as f32);
        let d00 = w - u * (h * a) + v * h + (du + dv) * 0.5;
        Frame { o: s.eye, d00, du, dv, width, height, full }
    }
    #[inline(always)]
    pub fn dir(&self, x: u32, y: u32) -> Vec3A {
        self.d00 + self.du * x as f32 + self.dv * y as f32
    }
}

#[derive(Clone, Copy, Default, Debug)]
pub struct Acc {
    pub rays: u64,
    pub hits: u64,
    pub lit: u64,
    pub tsum: f64,
}
impl Acc {
    pub fn add(self, o: Acc) -> Acc {
        Acc { rays: self.rays + o.rays, hits: self.hits + o.hits, lit: self.lit + o.lit, tsum: self.tsum + o.tsum }
    }
}

/// Rays in no order that helps, made once and handed to all alike.
pub struct Rays {
    pub rays: Vec<[Vec3A; 2]>,
    /// Whether any hit between t = 0 and 1 is asked for, not the closest one.
    pub any: bool,
}

pub trait Backend: Sync {
    fn name(&self) -> String;
    fn tile(&self, f: &Frame, x0: u32, y0: u32, x1: u32, y1: u32) -> Acc;
    /// Returns the seconds and the hits. `None` for tracers that have no single rays or no any-hit
    /// query.
    fn rays(&self, _: &Rays) -> Option<(f64, Acc)> {
        None
    }
}

pub trait Tracer: Sync {
    /// depth and an unnormalised geometric normal
    fn closest(&self, o: Vec3A, d: Vec3A) -> Option<(f32, Vec3A)>;
    /// anything in 0 < t < 1
    fn occluded(&self, o: Vec3A, d: Vec3A) -> bool;
}

/// One ray after the other.
#[inline(always)]
pub fn single_rays<T: Tracer + ?Sized>(t: &T, rays: &Rays) -> (f64, Acc) {
    let start = std::time::Instant::now();
    let mut a = Acc { rays: rays.rays.len() as u64, ..Acc::default() };
    for &[o, d] in &rays.rays {
        if rays.any {
            a.lit += !t.occluded(o, d) as u64;
        } else if let Some((z, _)) = t.closest(o, d) {
            a.hits += 1;
            a.tsum += z as f64;
        }
    }
    (start.elapsed().as_secs_f64(), a)
}

/// A frame's hits, row by row: the points off the surface and the normals.
fn hit_points(t: &dyn Tracer, eps: f32, f: &Frame) -> Vec<[Vec3A; 2]> {
    let pixels = (0..f.height).flat_map(|y| (0..f.width).map(move |x| (x, y)));
    let hit = |(x, y)| {
        let d = f.dir(x, y);
        let (z, n) = t.closest(f.o, d)?;
        let n = n.normalize();
        let n = if n.dot(d) > 0.0 { -n } else { n };
        Some([f.o + d * z + n * eps, n])
    };
    pixels.filter_map(hit).collect()
}

/// Returns rays from each hit point to the light, whose origins have the same epsilon for all
/// tracers.
pub fn shadow_rays(t: &dyn Tracer, s: &Scene, f: &Frame) -> Rays {
    let rays = hit_points(t, s.eps, f).into_iter().map(|[p, _]| [p, s.light - p]).collect();
    Rays { rays, any: true }
}

/// Returns `count` rays from the hit points in turn, with directions weighted by the cosine.
pub fn incoherent_rays(t: &dyn Tracer, s: &Scene, f: &Frame, count: usize) -> Rays {
    let points = hit_points(t, s.eps, f);
    let ray = |(i, &[p, n]): (u32, &[Vec3A; 2])| {
        let number = |k: u32| (hash(2 * i + k) >> 8) as f32 * (1.0 / 16777216.0);
        // A point on the unit sphere about the normal's end.
        let (z, phi) = (1.0 - 2.0 * number(0), std::f32::consts::TAU * number(1));
        let r = (1.0 - z * z).max(0.0).sqrt();
        let d = n + Vec3A::new(r * phi.cos(), r * phi.sin(), z);
        [p, if d.length_squared() > 1e-8 { d.normalize() } else { n }]
    };
    Rays { rays: (0..count as u32).zip(points.iter().cycle()).map(ray).collect(), any: false }
}

/// Wang's hash.
fn hash(i: u32) -> u32 {
    let mut h = (i ^ 61) ^ (i >> 16);
    h = h.wrapping_mul(9);
    h ^= h >> 4;
    h = h.wrapping_mul(0x27d4_eb2d);
    h ^ (h >> 15)
}

#[inline(always)]
pub fn single_tile<T: Tracer + ?Sized>(
    t: &T,
    light: Vec3A,
    eps: f32,
    f: &Frame,
    x0: u32,
    y0: u32,
    x1: u32,
    y1: u32,
) -> Acc {
    let mut a = Acc::default();
    for by in (y0..y1).step_by(8) {
        for bx in (x0..x1).step_by(8) {
            for y in by..(by + 8).min(y1) {
                for x in bx..(bx + 8).min(x1) {
                    let d = f.dir(x, y);
                    a.rays += 1;
                    if let Some((z, n)) = t.closest(f.o, d) {
                        a.hits += 1;
                        a.tsum += z as f64;
                        if f.full {
                            let n = n.normalize();
                            let n = if n.dot(d) > 0.0 { -n } else { n };
                            let p = f.o + d * z + n * eps;
                            a.rays += 1;
                            a.lit += !t.occluded(p, light - p) as u64;
                        }
                    }
                }
            }
        }
    }
    a
}
