//! The usual way to draw an implicit surface, for comparison: 512 steps along each ray.
//!
//! Bisection follows at the first change of sign. The formulas are written by hand, for one number or for eight lanes.

use termtrace::internals::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, Number, SimdKernel};

/// The number of steps along a ray.
const STEPS: u16 = 512;

/// The number of bisections, after which an f32 has no closer neighbours.
const BISECTIONS: u32 = 16;

/// Eight rays, axis by axis, and the ranges of t in which they are in the bounds.
#[derive(Clone, Debug)]
pub(crate) struct MarchedRays {
    pub(crate) origin: [F32x8; 3],
    pub(crate) direction: [F32x8; 3],
    pub(crate) range: [F32x8; 2],
}

/// A formula written by hand.
pub(crate) trait ByHand {
    fn at<N: Number>(x: N, y: N, z: N) -> N;
}

/// Defines a type per formula, and functions that march with the formula of an index.
macro_rules! formulas {
    ($($number:literal $name:ident($x:ident, $y:ident, $z:ident) $value:expr;)*) => {
        $(struct $name;

        impl ByHand for $name {
            #[inline(always)]
            fn at<N: Number>($x: N, $y: N, $z: N) -> N {
                $value
            }
        })*

        /// Returns the first root of each ray, found with eight lanes; infinity if none is.
        pub(crate) fn by_eight(formula: usize, rays: &[MarchedRays]) -> Vec<F32x8> {
            match formula {
                $($number => termtrace::internals::simd::dispatch(March::<$name>(rays, std::marker::PhantomData)),)*
                _ => Vec::new(),
            }
        }

        /// Returns the first root of each ray, found one ray after the other; infinity if none is.
        pub(crate) fn one_by_one(formula: usize, rays: &[MarchedRays]) -> Vec<F32x8> {
            match formula {
                $($number => rays.iter().map(each::<$name>).collect(),)*
                _ => Vec::new(),
            }
        }
    };
}

#[inline(always)]
fn n<N: Number>(value: f32) -> N {
    N::splat(value)
}

#[inline(always)]
fn q<N: Number>(a: N) -> N {
    a * a
}

#[inline(always)]
fn ball<N: Number>(x: N, y: N, z: N, [cx, cy, cz]: [f32; 3]) -> N {
    exp(n::<N>(-4.0) * (q(x - n(cx)) + q(y - n(cy)) + q(z - n(cz))))
}

formulas! {
    0 Sphere(x, y, z) q(x) + q(y) + q(z) - n(1.0);
    1 Tanglecube(x, y, z) {
        let (a, b, c) = (q(x), q(y), q(z));
        a * (a - n(5.0)) + b * (b - n(5.0)) + c * (c - n(5.0)) + n(11.8)
    };
    2 Heart(x, y, z) {
        let (a, b, c) = (q(x), q(y), q(z));
        let s = a + n::<N>(2.25) * c + b - n(1.0);
        s * s * s - b * y * (a + n::<N>(0.1125) * c)
    };
    3 Barth(x, y, z) {
        let (a, b, c, p) = (q(x), q(y), q(z), n::<N>(2.618_034));
        n::<N>(4.0) * (p * a - b) * (p * b - c) * (p * c - a) - n::<N>(4.236_068) * q(a + b + c - n(1.0))
    };
    4 Cayley(x, y, z) n::<N>(4.0) * (q(x) + q(y) + q(z)) + n::<N>(16.0) * x * y * z - n(1.0);
    5 Gyroid(x, y, z) {
        let [a, b, c] = [sin_cos(n::<N>(6.0) * x), sin_cos(n::<N>(6.0) * y), sin_cos(n::<N>(6.0) * z)];
        (a[0] * b[1] + b[0] * c[1] + c[0] * a[1]).max(q(x) + q(y) + q(z) - n(1.0))
    };
    6 Metaballs(x, y, z) n::<N>(0.5)
        - ball(x, y, z, [0.5, 0.0, 0.0])
        - ball(x, y, z, [-0.5, 0.0, 0.3])
        - ball(x, y, z, [0.0, 0.6, 0.0])
        - ball(x, y, z, [0.0, -0.5, -0.4]);
    7 Klein(x, y, z) {
        let (s, c) = (q(x) + q(y) + q(z), q(z));
        let (a, b) = (s + y + y - n(1.0), s - y - y - n(1.0));
        a * (q(b) - n::<N>(8.0) * c) + n::<N>(16.0) * x * z * b
    };
    8 Chair(x, y, z) {
        let (a, b) = (q(z - n(1.0)) - n::<N>(2.0) * q(x), q(z + n(1.0)) - n::<N>(2.0) * q(y));
        q(q(x) + q(y) + q(z) - n(0.95)) - n::<N>(0.8) * a * b
    };
    9 Terrain(x, y, z) {
        let a = sin_cos(n::<N>(1.7) * x + n(0.4))[0] * sin_cos(n::<N>(1.3) * z)[1];
        let b = sin_cos(n::<N>(3.1) * x - n::<N>(2.3) * z)[0];
        let c = sin_cos(n::<N>(6.3) * z + n::<N>(2.0) * sin_cos(n::<N>(2.7) * x)[0])[0];
        y - n::<N>(0.35) * a - n::<N>(0.16) * b - n::<N>(0.07) * c
    };
    10 ThinTorus(x, y, z) q((q(x) + q(z)).sqrt() - n(1.0)) + q(y) - n(0.0001);
    11 Sheets(x, y, z) {
        q(n::<N>(0.6) * x + n::<N>(0.8) * y - n::<N>(0.1) * sin_cos(n::<N>(3.0) * z)[0]) - n(0.000_002_25)
    };
}

/// Returns the value of a formula at a place of one ray or eight.
// Not a closure, which would be compiled without the kernel's target features.
#[inline(always)]
fn at<F: ByHand, N: Number>([origin, direction]: &[[N; 3]; 2], t: N) -> N {
    let ([ox, oy, oz], [dx, dy, dz]) = (*origin, *direction);
    F::at(ox + dx * t, oy + dy * t, oz + dz * t)
}

/// Marches along one ray or eight.
#[inline(always)]
fn march<F: ByHand, N: Number>(line: &[[N; 3]; 2], [start, end]: [N; 2]) -> N {
    let (zero, infinity, length) = (n::<N>(0.0), n::<N>(f32::INFINITY), (end - start) * n(1.0 / f32::from(STEPS)));
    let is_outside = end.lt(start);
    let first = at::<F, N>(line, start);
    let (mut low, mut high, mut is_found) = (start, infinity, is_outside);
    for step in 1..=STEPS {
        let t = start + length * n(f32::from(step));
        let changes = (at::<F, N>(line, t) * first).lt(zero) & !is_found;
        (low, high) = (N::select(changes, t - length, low), N::select(changes, t, high));
        is_found = is_found | changes;
        if is_found.all() {
            break;
        }
    }
    for _ in 0..BISECTIONS {
        let middle = n::<N>(0.5) * (low + high);
        let changes = (at::<F, N>(line, middle) * first).lt(zero);
        (low, high) = (N::select(changes, low, middle), N::select(changes, middle, high));
    }
    high
}

#[inline(always)]
fn load<N: Lanes>([x, y, z]: &[F32x8; 3]) -> [N; 3] {
    [N::load(x), N::load(y), N::load(z)]
}

struct March<'r, F>(&'r [MarchedRays], std::marker::PhantomData<F>);

impl<F: ByHand> SimdKernel for March<'_, F> {
    type Output = Vec<F32x8>;

    #[inline(always)]
    fn run<N: Lanes>(self) -> Vec<F32x8> {
        let mut roots = Vec::with_capacity(self.0.len());
        for rays in self.0 {
            let line = [load(&rays.origin), load(&rays.direction)];
            let range = [N::load(&rays.range[0]), N::load(&rays.range[1])];
            let is_outside = range[1].lt(range[0]).bits().count_ones() as usize == LANES;
            let miss = N::splat(f32::INFINITY);
            roots.push(if is_outside { miss } else { march::<F, N>(&line, range) }.store());
        }
        roots
    }
}

fn each<F: ByHand>(rays: &MarchedRays) -> F32x8 {
    let mut roots = F32x8([f32::INFINITY; LANES]);
    for lane in 0..LANES {
        let line = [&rays.origin, &rays.direction].map(|axes| [0, 1, 2].map(|axis| axes[axis].0[lane]));
        let range = [rays.range[0].0[lane], rays.range[1].0[lane]];
        if range[0] <= range[1] {
            roots.0[lane] = march::<F, f32>(&line, range);
        }
    }
    roots
}

/// Returns the sine and the cosine, by Cody and Waite's reduction and the polynomials of Cephes.
#[inline(always)]
fn sin_cos<N: Number>(x: N) -> [N; 2] {
    let quarters = (x * n(std::f32::consts::FRAC_2_PI) + n(0.5)).floor();
    let r = x - quarters * n(1.570_312_5) - quarters * n(4.837_513e-4) - quarters * n(7.549_79e-8);
    let r2 = r * r;
    let sin = r + r * r2 * (n::<N>(-0.166_666_55) + r2 * (n::<N>(8.332_161e-3) - r2 * n(1.951_529_6e-4)));
    let of_cos = n::<N>(4.166_664_6e-2) + r2 * (n::<N>(-1.388_731_6e-3) + r2 * n(2.443_315_7e-5));
    let cos = n::<N>(1.0) - n::<N>(0.5) * r2 + r2 * r2 * of_cos;
    let halves = (quarters * n(0.5)).floor();
    let (odd, turned) = (quarters - halves - halves, halves - n::<N>(2.0) * (halves * n(0.5)).floor());
    let (is_odd, sign) = (n::<N>(0.5).lt(odd), n::<N>(1.0) - n::<N>(2.0) * turned);
    [N::select(is_odd, cos, sin) * sign, N::select(is_odd, -sin, cos) * sign]
}

/// Returns e^x for x from -87 to 0; smaller ones count as -87.
#[inline(always)]
fn exp<N: Number>(x: N) -> N {
    // (e^(x / 128))^128, without operations on bits.
    let r = x.max(n(-87.0)) * n(1.0 / 128.0);
    let sum = n::<N>(1.0) + r * (n::<N>(1.0) + r * (n::<N>(0.5) + r * (n::<N>(1.0 / 6.0) + r * n(1.0 / 24.0))));
    let mut power = sum;
    for _ in 0..7 {
        power = power * power;
    }
    power
}
