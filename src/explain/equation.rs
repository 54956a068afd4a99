//! The lecture's equations for where a ray crosses a surface: what is put in, and what comes out.
//!
//! They are solved as they stand there, in f64. What the picture is made with are other forms of them that keep their
//! digits in f32; so the last digits may differ.

use crate::ray::Ray;
use crate::shape::{Part, Plane, Sphere, Triangle};
use glam::{DVec3, Vec3};

/// Where a ray's line crosses a surface, in front of the origin or behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Equation {
    /// a t^2 + b t + c = 0.
    Sphere {
        /// d.d
        a: f64,
        /// 2 (o - c).d
        b: f64,
        /// (o - c).(o - c) - r^2
        c: f64,
        /// Both t, the lesser first; none: the line misses the sphere.
        roots: Option<[f64; 2]>,
    },
    /// t = (a - o).n / d.n, for a point a of the plane.
    Plane {
        /// (a - o).n
        numerator: f64,
        /// d.n
        denominator: f64,
        /// Nowhere, if the line runs along the plane.
        t: Option<f64>,
    },
    /// The same for the triangle's plane; the point there is the corners' mean by these shares.
    Triangle {
        /// Nowhere, if the line runs along the plane, or the triangle has no area.
        t: Option<f64>,
        /// How much of each corner; one of them is less than 0 if the point is outside.
        shares: [f64; 3],
    },
}

impl Equation {
    /// That of the surface and the ray.
    pub fn of(part: &Part<'_>, ray: &Ray) -> Self {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        match part {
            Part::Sphere(sphere) => of_sphere(sphere, o, d),
            Part::Plane(plane) => of_plane(plane, o, d),
            Part::Triangle(triangle) => of_triangle(triangle, o, d),
            Part::Facet(facet) => of_triangle(facet.triangle(), o, d),
        }
    }
}

fn of_sphere(sphere: &Sphere, o: DVec3, d: DVec3) -> Equation {
    let (from_center, radius) = (o - sphere.center().as_dvec3(), f64::from(sphere.radius()));
    let (a, b, c) = (d.dot(d), 2.0 * from_center.dot(d), from_center.dot(from_center) - radius * radius);
    let under_root = b * b - 4.0 * a * c;
    let root = |sign: f64| (-b + sign * under_root.sqrt()) / (2.0 * a);
    Equation::Sphere { a, b, c, roots: (under_root >= 0.0).then(|| [root(-1.0), root(1.0)]) }
}

fn of_plane(plane: &Plane, o: DVec3, d: DVec3) -> Equation {
    let (a, n) = (plane.point().as_dvec3(), plane.normal().as_dvec3());
    let (numerator, denominator) = ((a - o).dot(n), d.dot(n));
    Equation::Plane { numerator, denominator, t: quotient(numerator, denominator) }
}

fn of_triangle(triangle: &Triangle, o: DVec3, d: DVec3) -> Equation {
    let [a, b, c] = triangle.corners().map(Vec3::as_dvec3);
    let n = (b - a).cross(c - a);
    let t = quotient((a - o).dot(n), d.dot(n));
    let p = o + d * t.unwrap_or(0.0);
    // Twice the area of the triangle that p makes with each edge, in parts of the whole.
    let share = |from: DVec3, to: DVec3| quotient((to - from).cross(p - from).dot(n), n.dot(n)).unwrap_or(0.0);
    Equation::Triangle { t, shares: [share(b, c), share(c, a), share(a, b)] }
}

fn quotient(above: f64, below: f64) -> Option<f64> {
    Some(above / below).filter(|quotient| quotient.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ray() -> Ray {
        Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::new(0.0, 0.0, -2.0) }
    }

    #[test]
    fn a_spheres_quadratic_is_the_lectures() {
        let sphere = |x, radius| Equation::of(&Part::Sphere(&Sphere::new(Vec3::new(x, 0.0, 0.0), radius)), &ray());
        // 4 t^2 - 20 t + 24 = 0 has the roots 2 and 3.
        assert_eq!(sphere(0.0, 1.0), Equation::Sphere { a: 4.0, b: -20.0, c: 24.0, roots: Some([2.0, 3.0]) });
        assert_eq!(sphere(3.0, 1.0), Equation::Sphere { a: 4.0, b: -20.0, c: 33.0, roots: None });
    }

    #[test]
    fn a_planes_and_a_triangles_t_are_where_they_are() {
        let plane = |normal| Equation::of(&Part::Plane(&Plane::new(Vec3::new(1.0, 2.0, 1.0), normal)), &ray());
        assert_eq!(plane(Vec3::Z), Equation::Plane { numerator: -4.0, denominator: -2.0, t: Some(2.0) });
        assert_eq!(plane(Vec3::X), Equation::Plane { numerator: 1.0, denominator: 0.0, t: None });
        let triangle = |x: f32| {
            let corners = [Vec3::new(x - 1.0, -1.0, 1.0), Vec3::new(x + 3.0, -1.0, 1.0), Vec3::new(x - 1.0, 3.0, 1.0)];
            Equation::of(&Part::Triangle(&Triangle::new(corners)), &ray())
        };
        assert_eq!(triangle(0.0), Equation::Triangle { t: Some(2.0), shares: [0.5, 0.25, 0.25] });
        assert_eq!(triangle(2.0), Equation::Triangle { t: Some(2.0), shares: [1.0, -0.25, 0.25] });
        let flat = Triangle::new([Vec3::ZERO, Vec3::ONE, Vec3::splat(2.0)]);
        assert_eq!(Equation::of(&Part::Triangle(&flat), &ray()), Equation::Triangle { t: None, shares: [0.0; 3] });
    }
}
