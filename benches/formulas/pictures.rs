//! Twelve formulas, five cameras for each, and the rays of the pictures.

use glam::Vec3;

/// The formulas, in the order of those written by hand, and half the side of the cube of each.
pub(crate) const FORMULAS: [(&str, &str, f32); 12] = [
    ("sphere", "x^2 + y^2 + z^2 - 1", 1.1),
    ("tanglecube", "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8", 2.5),
    ("heart", "(x^2 + 9/4*z^2 + y^2 - 1)^3 - x^2*y^3 - 9/80*z^2*y^3", 1.35),
    (
        "barth",
        "a = phi^2*x^2 - y^2; b = phi^2*y^2 - z^2; c = phi^2*z^2 - x^2;
         4*a*b*c - (1 + 2*phi)*(x^2 + y^2 + z^2 - 1)^2",
        1.75,
    ),
    ("cayley", "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1", 1.2),
    ("gyroid", "max(sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x), x^2 + y^2 + z^2 - 1)", 1.1),
    (
        "metaballs",
        "0.5 - exp(-4*((x - 0.5)^2 + y^2 + z^2)) - exp(-4*((x + 0.5)^2 + y^2 + (z - 0.3)^2))
         - exp(-4*(x^2 + (y - 0.6)^2 + z^2)) - exp(-4*(x^2 + (y + 0.5)^2 + (z + 0.4)^2))",
        1.6,
    ),
    ("klein", "q = x^2 + y^2 + z^2; (q + 2*y - 1)*((q - 2*y - 1)^2 - 8*z^2) + 16*x*z*(q - 2*y - 1)", 3.0),
    ("chair", "(x^2 + y^2 + z^2 - 0.95)^2 - 0.8*((z - 1)^2 - 2*x^2)*((z + 1)^2 - 2*y^2)", 1.3),
    ("terrain", "y - 0.35*sin(1.7*x + 0.4)*cos(1.3*z) - 0.16*sin(3.1*x - 2.3*z) - 0.07*sin(6.3*z + 2*sin(2.7*x))", 2.0),
    ("thin torus", "(sqrt(x^2 + z^2) - 1)^2 + y^2 - 0.0001", 1.1),
    ("sheets", "(0.6*x + 0.8*y - 0.1*sin(3*z))^2 - 0.0015^2", 1.2),
];

/// Eye and target of each camera, relative to half the side of the cube.
///
/// They are in front, on an axis, grazing, below, and inside.
pub(crate) const CAMERAS: [[[f32; 3]; 2]; 5] = [
    [[0.3, 0.35, 2.9], [0.0; 3]],
    [[0.0, 0.0, 3.0], [0.0; 3]],
    [[2.9, 0.25, 0.4], [0.0, 0.2, 0.0]],
    [[0.5, -2.8, 0.6], [0.0; 3]],
    [[0.21, 0.17, 0.33], [-0.3, -0.2, -0.5]],
];

/// The size of the pictures in pixels: two for each of 200 x 60 cells.
pub(crate) const SIZE: [usize; 2] = [200, 120];

/// Returns the origins and directions of the rays of a picture.
///
/// They are in tiles of 8 x 8 pixels, in groups of 4 x 2.
pub(crate) fn rays([eye, target]: [[f32; 3]; 2], size: f32) -> impl Iterator<Item = [Vec3; 2]> {
    let (eye, target) = (Vec3::from(eye) * size, Vec3::from(target) * size);
    let w = (eye - target).normalize();
    let u = Vec3::Y.cross(w).normalize();
    let (v, half) = (w.cross(u), 0.363_970_2);
    let place = |at: usize| {
        let (tile, group, lane) = (at / 64, at / 8 % 8, at % 8);
        let [x, y] = [tile % (SIZE[0] / 8), tile / (SIZE[0] / 8)].map(|tile| tile * 8);
        [x + group % 2 * 4 + lane % 4, y + group / 2 * 2 + lane / 4]
    };
    let share = |at: usize, count: usize| 2.0 * (at as f32 + 0.5) / count as f32 - 1.0;
    let ray = move |at: usize| {
        let [x, y] = place(at);
        let across = share(x, SIZE[0]) * half * SIZE[0] as f32 / SIZE[1] as f32;
        [eye, u * across - v * (share(y, SIZE[1]) * half) - w]
    };
    (0..SIZE[0] * SIZE[1]).map(ray)
}

/// Returns the range of t in which a ray is in the cube, or `None` if it passes it.
pub(crate) fn range([origin, direction]: [Vec3; 2], size: f32) -> Option<[f32; 2]> {
    let (one, other) = ((Vec3::splat(-size) - origin) / direction, (Vec3::splat(size) - origin) / direction);
    let (start, end) = (one.min(other).max_element().max(0.0), one.max(other).min_element());
    (start <= end).then_some([start, end])
}
