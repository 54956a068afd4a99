//! Embree 3 and 4 through dlopen: only the handful of C declarations that this harness calls.
use crate::scene::*;
use glam::Vec3A;
use std::ffi::{CString, c_char, c_int, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};

type P = *mut c_void;
unsafe extern "C" {
    fn dlopen(f: *const c_char, flags: c_int) -> P;
    fn dlsym(h: P, s: *const c_char) -> P;
    fn dlerror() -> *const c_char;
}

static BYTES: AtomicIsize = AtomicIsize::new(0);
extern "C" fn monitor(_: P, bytes: isize, _post: bool) -> bool {
    BYTES.fetch_add(bytes, Ordering::Relaxed);
    true
}

#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct RayHit<const N: usize> {
    ox: [f32; N],
    oy: [f32; N],
    oz: [f32; N],
    tnear: [f32; N],
    dx: [f32; N],
    dy: [f32; N],
    dz: [f32; N],
    time: [f32; N],
    tfar: [f32; N],
    mask: [u32; N],
    id: [u32; N],
    flags: [u32; N],
    nx: [f32; N],
    ny: [f32; N],
    nz: [f32; N],
    u: [f32; N],
    v: [f32; N],
    prim: [u32; N],
    geom: [u32; N],
    inst: [u32; N],
    inst_prim: [u32; N],
    pad: [u32; N],
}
impl<const N: usize> RayHit<N> {
    #[inline(always)]
    fn new() -> Self {
        let mut r: Self = unsafe { std::mem::zeroed() };
        r.geom = [!0; N];
        r.mask = [!0; N];
        r
    }
}
#[repr(C)]
struct Ctx3 {
    flags: u32,
    filter: usize,
    inst: [u32; 2],
    pad: u32,
}
#[repr(C)]
struct Args4 {
    flags: u32,
    feature: u32,
    ctx: usize,
    filter: usize,
    user: usize,
    pad: usize,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Mode {
    One,
    Pkt8,
    Pkt16,
}

pub struct Embree {
    v: u32,
    scene: P,
    int1: P,
    occ1: P,
    int8: P,
    occ8: P,
    int16: P,
    occ16: P,
    pub mode: Mode,
    pub coherent: bool,
    pub tag: String,
    light: Vec3A,
    eps: f32,
    pub build_s: f64,
    pub bytes: isize,
}
unsafe impl Sync for Embree {}
unsafe impl Send for Embree {}

impl Embree {
    pub fn new(v: u32, s: &Scene, threads: usize, robust: bool, quality: u32) -> Option<Embree> {
        let lib = if v == 3 { "libembree3.so.3".to_string() } else { std::env::var("EMBREE4_LIB").ok()? };
        unsafe {
            let h = dlopen(CString::new(lib.clone()).unwrap().as_ptr(), 1);
            if h.is_null() {
                eprintln!("no {lib}: {:?}", std::ffi::CStr::from_ptr(dlerror()));
                return None;
            }
            let f = |n: &str| dlsym(h, CString::new(n).unwrap().as_ptr());
            macro_rules! call {
                ($n:literal, $t:ty) => {
                    std::mem::transmute::<P, $t>(f($n))
                };
            }
            let new_dev = call!("rtcNewDevice", extern "C" fn(*const c_char) -> P);
            let cfg = CString::new(format!(
                "threads={threads},user_threads=0,set_affinity=0{}",
                if std::env::var("EMBREE_VERBOSE").is_ok() { ",verbose=2" } else { "" }
            ))
            .unwrap();
            let dev = new_dev(cfg.as_ptr());
            call!("rtcSetDeviceMemoryMonitorFunction", extern "C" fn(P, extern "C" fn(P, isize, bool) -> bool, P))(
                dev,
                monitor,
                std::ptr::null_mut(),
            );
            BYTES.store(0, Ordering::Relaxed);
            let scene = call!("rtcNewScene", extern "C" fn(P) -> P)(dev);
            call!("rtcSetSceneFlags", extern "C" fn(P, u32))(scene, if robust { 4 } else { 0 });
            call!("rtcSetSceneBuildQuality", extern "C" fn(P, u32))(scene, quality);
            let new_geom = call!("rtcNewGeometry", extern "C" fn(P, c_int) -> P);
            let buf = call!("rtcSetNewGeometryBuffer", extern "C" fn(P, u32, u32, u32, usize, usize) -> P);
            let commit = call!("rtcCommitGeometry", extern "C" fn(P));
            let gq = call!("rtcSetGeometryBuildQuality", extern "C" fn(P, u32));
            let attach = call!("rtcAttachGeometry", extern "C" fn(P, P) -> u32);
            if !s.spheres.is_empty() {
                let g = new_geom(dev, 50);
                std::slice::from_raw_parts_mut(
                    buf(g, 1, 0, 0x9004, 16, s.spheres.len()) as *mut [f32; 4],
                    s.spheres.len(),
                )
                .copy_from_slice(&s.spheres);
                gq(g, quality);
                commit(g);
                attach(scene, g);
            }
            let (mut verts, mut tris) = (s.verts.clone(), s.tris.clone());
            if let Some(p) = s.plane {
                // two big triangles stand for the plane
                let k = verts.len() as u32;
                for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    verts.push([a * 1e3, p.h, b * 1e3]);
                }
                tris.push([k, k + 2, k + 1]);
                tris.push([k, k + 3, k + 2]);
            }
            if !tris.is_empty() {
                let g = new_geom(dev, 0);
                std::slice::from_raw_parts_mut(buf(g, 1, 0, 0x9003, 12, verts.len()) as *mut [f32; 3], verts.len())
                    .copy_from_slice(&verts);
                std::slice::from_raw_parts_mut(buf(g, 0, 0, 0x5003, 12, tris.len()) as *mut [u32; 3], tris.len())
                    .copy_from_slice(&tris);
                gq(g, quality);
                commit(g);
                attach(scene, g);
            }
            let t = std::time::Instant::now();
            call!("rtcCommitScene", extern "C" fn(P))(scene);
            let build_s = t.elapsed().as_secs_f64();
            Some(Embree {
                v,
                scene,
                int1: f("rtcIntersect1"),
                occ1: f("rtcOccluded1"),
                int8: f("rtcIntersect8"),
                occ8: f("rtcOccluded8"),
                int16: f("rtcIntersect16"),
                occ16: f("rtcOccluded16"),
                mode: Mode::One,
                coherent: false,
                tag: format!(
                    "embree{v}{}{}",
                    if robust { "-robust" } else { "" },
                    if quality == 2 { "-hq" } else { "" }
                ),
                light: s.light,
                eps: s.eps,
                build_s,
                bytes: BYTES.load(Ordering::Relaxed),
            })
        }
    }
    pub fn with(&self, mode: Mode, coherent: bool) -> Embree {
        Embree { mode, coherent, tag: self.tag.clone(), ..*self }
    }
}

impl Tracer for Embree {
    #[inline(always)]
    fn closest(&self, o: Vec3A, d: Vec3A) -> Option<(f32, Vec3A)> {
        let mut r = RayHit::<1>::new();
        r.ox[0] = o.x;
        r.oy[0] = o.y;
        r.oz[0] = o.z;
        r.dx[0] = d.x;
        r.dy[0] = d.y;
        r.dz[0] = d.z;
        r.tfar[0] = f32::INFINITY;
        unsafe {
            if self.v == 3 {
                let mut c = Ctx3 { flags: self.coherent as u32, filter: 0, inst: [!0; 2], pad: 0 };
                std::mem::transmute::<P, extern "C" fn(P, *mut Ctx3, *mut RayHit<1>)>(self.int1)(
                    self.scene, &mut c, &mut r,
                );
            } else {
                let mut a =
                    Args4 { flags: (self.coherent as u32) << 16, feature: !0, ctx: 0, filter: 0, user: 0, pad: 0 };
                std::mem::transmute::<P, extern "C" fn(P, *mut RayHit<1>, *mut Args4)>(self.int1)(
                    self.scene, &mut r, &mut a,
                );
            }
        }
        if r.geom[0] == !0 { None } else { Some((r.tfar[0], Vec3A::new(r.nx[0], r.ny[0], r.nz[0]))) }
    }
    #[inline(always)]
    fn occluded(&self, o: Vec3A, d: Vec3A) -> bool {
        let mut r = RayHit::<1>::new();
        r.ox[0] = o.x;
        r.oy[0] = o.y;
        r.oz[0] = o.z;
        r.dx[0] = d.x;
        r.dy[0] = d.y;
        r.dz[0] = d.z;
        r.tfar[0] = 1.0;
        unsafe {
            if self.v == 3 {
                let mut c = Ctx3 { flags: self.coherent as u32, filter: 0, inst: [!0; 2], pad: 0 };
                std::mem::transmute::<P, extern "C" fn(P, *mut Ctx3, *mut RayHit<1>)>(self.occ1)(
                    self.scene, &mut c, &mut r,
                );
            } else {
                let mut a =
                    Args4 { flags: (self.coherent as u32) << 16, feature: !0, ctx: 0, filter: 0, user: 0, pad: 0 };
                std::mem::transmute::<P, extern "C" fn(P, *mut RayHit<1>, *mut Args4)>(self.occ1)(
                    self.scene, &mut r, &mut a,
                );
            }
        }
        r.tfar[0] < 0.0
    }
}

impl Embree {
    #[inline(always)]
    fn packet<const N: usize, const W: u32>(
        &self,
        int: P,
        occ: P,
        f: &Frame,
        x0: u32,
        y0: u32,
        x1: u32,
        y1: u32,
    ) -> Acc {
        let mut a = Acc::default();
        let h = N as u32 / W;
        let mut c = Ctx3 { flags: self.coherent as u32, filter: 0, inst: [!0; 2], pad: 0 };
        let mut g = Args4 { flags: (self.coherent as u32) << 16, feature: !0, ctx: 0, filter: 0, user: 0, pad: 0 };
        #[repr(align(64))]
        struct V<const N: usize>([i32; N]);
        for by in (y0..y1).step_by(h as usize) {
            for bx in (x0..x1).step_by(W as usize) {
                let mut r = RayHit::<N>::new();
                let mut valid = V([0i32; N]);
                for i in 0..N {
                    let (x, y) = (bx + i as u32 % W, by + i as u32 / W);
                    let d = f.dir(x, y);
                    valid.0[i] = if x < x1 && y < y1 { -1 } else { 0 };
                    r.ox[i] = f.o.x;
                    r.oy[i] = f.o.y;
                    r.oz[i] = f.o.z;
                    r.dx[i] = d.x;
                    r.dy[i] = d.y;
                    r.dz[i] = d.z;
                    r.tfar[i] = f32::INFINITY;
                    a.rays += (valid.0[i] != 0) as u64;
                }
                unsafe {
                    if self.v == 3 {
                        std::mem::transmute::<P, extern "C" fn(*const i32, P, *mut Ctx3, *mut RayHit<N>)>(int)(
                            valid.0.as_ptr(),
                            self.scene,
                            &mut c,
                            &mut r,
                        );
                    } else {
                        std::mem::transmute::<P, extern "C" fn(*const i32, P, *mut RayHit<N>, *mut Args4)>(int)(
                            valid.0.as_ptr(),
                            self.scene,
                            &mut r,
                            &mut g,
                        );
                    }
                }
                let mut any = false;
                let mut s = RayHit::<N>::new();
                for i in 0..N {
                    let hit = valid.0[i] != 0 && r.geom[i] != !0;
                    valid.0[i] = -(hit as i32);
                    if hit {
                        any = true;
                        a.hits += 1;
                        a.tsum += r.tfar[i] as f64;
                        if f.full {
                            let d = Vec3A::new(r.dx[i], r.dy[i], r.dz[i]);
                            let n = Vec3A::new(r.nx[i], r.ny[i], r.nz[i]).normalize();
                            let n = if n.dot(d) > 0.0 { -n } else { n };
                            let p = f.o + d * r.tfar[i] + n * self.eps;
                            let l = self.light - p;
                            s.ox[i] = p.x;
                            s.oy[i] = p.y;
                            s.oz[i] = p.z;
                            s.dx[i] = l.x;
                            s.dy[i] = l.y;
                            s.dz[i] = l.z;
                            s.tfar[i] = 1.0;
                        }
                    }
                }
                if f.full && any {
                    unsafe {
                        if self.v == 3 {
                            std::mem::transmute::<P, extern "C" fn(*const i32, P, *mut Ctx3, *mut RayHit<N>)>(occ)(
                                valid.0.as_ptr(),
                                self.scene,
                                &mut c,
                                &mut s,
                            );
                        } else {
                            std::mem::transmute::<P, extern "C" fn(*const i32, P, *mut RayHit<N>, *mut Args4)>(occ)(
                                valid.0.as_ptr(),
                                self.scene,
                                &mut s,
                                &mut g,
                            );
                        }
                    }
                    for i in 0..N {
                        if valid.0[i] != 0 {
                            a.rays += 1;
                            a.lit += (s.tfar[i] >= 0.0) as u64;
                        }
                    }
                }
            }
        }
        a
    }
}

#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn e_tile(s: &Embree, f: &Frame, x0: u32, y0: u32, x1: u32, y1: u32) -> Acc {
    match s.mode {
        Mode::One => single_tile(s, s.light, s.eps, f, x0, y0, x1, y1),
        Mode::Pkt8 => s.packet::<8, 4>(s.int8, s.occ8, f, x0, y0, x1, y1),
        Mode::Pkt16 => s.packet::<16, 4>(s.int16, s.occ16, f, x0, y0, x1, y1),
    }
}
impl Backend for Embree {
    fn name(&self) -> String {
        let m = match self.mode {
            Mode::One => "1",
            Mode::Pkt8 => "8",
            Mode::Pkt16 => "16",
        };
        format!("{}/{m}{}", self.tag, if self.coherent { "c" } else { "" })
    }
    fn tile(&self, f: &Frame, x0: u32, y0: u32, x1: u32, y1: u32) -> Acc {
        unsafe { e_tile(self, f, x0, y0, x1, y1) }
    }
    fn rays(&self, rays: &Rays) -> Option<(f64, Acc)> {
        (self.mode == Mode::One).then(|| single_rays(self, rays))
    }
}
