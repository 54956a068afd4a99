//! The sequences on which the encoder is judged: a camera, a sphere or the light moves over a
//! floor.
//!
//! Four are fixed; any number of others of the same kinds are drawn from a seed.

use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_8, PI, TAU};
use std::fmt;
use std::num::NonZeroU32;
use termtrace::internals::cell;
use termtrace::internals::material::Checker;
use termtrace::{
    Background, Camera, CellMode, Falloff, LinearRgb, Material, Object, Picture, Plane, PointLight, Pose, Scene, Size,
    Sphere, ViewRectangle, render, tone,
};

/// The number of frames of a sequence, 1/30 s apart.
pub(crate) const FRAMES: usize = 120;

/// The object that moves, and the floor: sequences of one kind take about as many bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The camera goes around, over a checker.
    Orbit,
    /// The camera goes around, over a plain floor.
    Plain,
    /// One sphere moves over a checker.
    Sphere,
    /// A near light circles over a plain floor, and the camera sways.
    Gradient,
}

impl Kind {
    pub(crate) const ALL: [Self; 4] = [Self::Orbit, Self::Plain, Self::Sphere, Self::Gradient];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Orbit => "orbit",
            Self::Plain => "plain",
            Self::Sphere => "sphere",
            Self::Gradient => "gradient",
        }
    }

    const fn has_checker(self) -> bool {
        matches!(self, Self::Orbit | Self::Sphere)
    }
}

/// A sequence of frames: a scene, and what moves in it.
#[derive(Clone, Debug)]
pub(crate) struct Sequence {
    pub(crate) kind: Kind,
    balls: Vec<Ball>,
    /// Which of them goes around over its place.
    moving: Option<usize>,
    lamp: Lamp,
    ambient: f32,
    eye: EyePath,
}

#[derive(Clone, Copy, Debug)]
struct Ball {
    center: Vec3,
    radius: f32,
    reflectance: LinearRgb,
}

/// A light, at rest or on a circle over the origin.
#[derive(Clone, Copy, Debug)]
struct Lamp {
    /// The position at first.
    position: Vec3,
    circles: bool,
    intensity: f32,
    falloff: Falloff,
}

/// The eye's way around the vertical axis, in radians and world units.
#[derive(Clone, Copy, Debug)]
struct EyePath {
    /// The azimuth at first.
    azimuth: f32,
    /// The angle of the orbit in the whole sequence.
    turn: f32,
    /// The angle by which it swings to and fro.
    sway: f32,
    distance: f32,
    /// The distance by which it goes away and comes back.
    breath: f32,
    height: f32,
}

impl EyePath {
    /// The ball that lies nearest to where it begins, so that no other hides it.
    fn nearest(&self, balls: &[Ball]) -> Option<usize> {
        let (across, along) = libm::sincosf(self.azimuth);
        let eye = self.distance * Vec3::new(across, 0.0, along);
        let distance = |at: &usize| balls[*at].center.distance(eye);
        (0..balls.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

impl Sequence {
    /// The fixed sequence of a kind.
    pub(crate) fn of(kind: Kind) -> Self {
        let ball = |x: f32, [r, g, b]: [f32; 3]| Ball {
            center: Vec3::new(x, 1.0, 0.0),
            radius: 1.0,
            reflectance: LinearRgb::new(r, g, b),
        };
        let balls = vec![ball(-2.1, [0.9, 0.1, 0.1]), ball(0.0, [0.1, 0.8, 0.15]), ball(2.1, [0.12, 0.2, 0.9])];
        let lamp = Lamp { position: Vec3::new(4.0, 6.0, 3.0), circles: false, intensity: 1.0, falloff: Falloff::None };
        let eye = EyePath { azimuth: PI / 6.0, turn: 0.0, sway: 0.0, distance: 7.5, breath: 0.0, height: 2.6 };
        let still = Self { kind, balls, moving: None, lamp, ambient: 0.08, eye };
        match kind {
            Kind::Orbit | Kind::Plain => Self { eye: EyePath { turn: PI, ..eye }, ..still },
            Kind::Sphere => Self { moving: Some(1), ..still },
            Kind::Gradient => Self {
                lamp: Lamp {
                    position: Vec3::new(4.0, 5.0, 0.0),
                    circles: true,
                    intensity: 30.0,
                    falloff: Falloff::InverseSquare,
                },
                ambient: 0.03,
                eye: EyePath { sway: 0.3, distance: 6.0, breath: 1.5, height: 2.2, ..eye },
                ..still
            },
        }
    }

    /// Two sequences of two kinds.
    pub(crate) fn drawn(seed: u64) -> [Self; 2] {
        let mut draw = Draw::new(seed);
        let first = draw.below(4);
        let second = (first + 1 + draw.below(3)) % 4;
        [first, second].map(|kind| Self::drawn_of(Kind::ALL[kind], &mut draw))
    }

    fn drawn_of(kind: Kind, draw: &mut Draw) -> Self {
        let moves = matches!(kind, Kind::Orbit | Kind::Plain);
        let circles = kind == Kind::Gradient;
        let count = 2 + draw.below(4);
        let balls = draw.balls(count);
        let distance = draw.between(6.5, 9.0);
        // From half to one and a half times as fast as the fixed one.
        let turn = draw.sign() * draw.between(0.5, 1.5) * PI;
        let eye = EyePath {
            azimuth: draw.between(0.0, TAU),
            turn: if moves { turn } else { 0.0 },
            sway: if circles { draw.between(0.2, 0.4) } else { 0.0 },
            distance,
            breath: if circles { draw.between(1.0, 2.0) } else { 0.0 },
            height: draw.between(1.8, 3.5),
        };
        let place = draw.place(4.0, 5.5);
        let lamp = Lamp {
            position: Vec3::new(place.x, draw.between(4.5, 6.5), place.y),
            circles,
            intensity: if circles { draw.between(25.0, 35.0) } else { 1.0 },
            falloff: if circles { Falloff::InverseSquare } else { Falloff::None },
        };
        let moving = if kind == Kind::Sphere { eye.nearest(&balls) } else { None };
        Self { kind, balls, moving, lamp, ambient: if circles { 0.03 } else { 0.08 }, eye }
    }

    /// Frame `k` on a screen of that size, whose half cells are square.
    pub(crate) fn frame(&self, k: usize, size: Size) -> Picture {
        let phase = k as f32 / FRAMES as f32;
        let scene = self.scene(phase);
        let resolution = cell::resolution(CellMode::HALF_BLOCK, size, 2.0).expect("a size that pictures can have");
        tone(&render(&scene, scene.camera(), resolution, NonZeroU32::MIN), &scene)
    }

    fn scene(&self, phase: f32) -> Scene {
        let (sin, cos) = libm::sincosf(phase * TAU);
        let objects = std::iter::once(self.floor()).chain(self.objects(sin, cos)).collect();
        let sky =
            Background::Gradient { bottom: LinearRgb::new(0.9, 0.95, 1.0), top: LinearRgb::new(0.25, 0.45, 0.85) };
        let mut scene = Scene::new(self.camera(phase, sin, cos), objects);
        scene = scene.with_background(sky).expect("light");
        scene = scene.with_ambient(LinearRgb::grey(self.ambient)).expect("light");
        scene = scene.with_lights(vec![self.light(sin, cos)]);
        scene
    }

    fn floor(&self) -> Object {
        let (dark, light) = (LinearRgb::grey(0.25), LinearRgb::grey(0.7));
        let checker = Material::from(Checker::new(dark, light, 1.0).expect("a pattern"));
        let material = if self.kind.has_checker() { checker } else { Material::diffuse(light).expect("a reflectance") };
        Object::new(Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"), material)
    }

    fn objects(&self, sin: f32, cos: f32) -> impl Iterator<Item = Object> {
        let way = Vec3::new(0.0, 0.4 * (1.0 - cos), 1.5 * sin);
        self.balls.iter().enumerate().map(move |(at, ball)| {
            let center = if self.moving == Some(at) { ball.center + way } else { ball.center };
            Object::new(
                Sphere::new(center, ball.radius).expect("a sphere"),
                Material::diffuse(ball.reflectance).expect("a reflectance"),
            )
        })
    }

    fn light(&self, sin: f32, cos: f32) -> PointLight {
        let Lamp { position: Vec3 { x, y, z }, circles, intensity, falloff } = self.lamp;
        let around = Vec3::new(cos * x - sin * z, y, sin * x + cos * z);
        let position = if circles { around } else { self.lamp.position };
        PointLight::new(position, LinearRgb::grey(intensity)).expect("a light").with_falloff(falloff)
    }

    fn camera(&self, phase: f32, sin: f32, cos: f32) -> Camera {
        let EyePath { azimuth, turn, sway, distance, breath, height } = self.eye;
        let (across, along) = libm::sincosf(azimuth + turn * phase + sway * sin);
        let distance = distance + breath * cos;
        let eye = Vec3::new(distance * across, height, distance * along);
        let rectangle = ViewRectangle::from_vertical_fov(2.0 * FRAC_PI_8).expect("45 degrees are an angle of view");
        let pose = Pose { eye, target: Vec3::new(0.0, 0.9, 0.0), up: Vec3::Y };
        Camera::new(pose, rectangle).expect("the eye is beside the target")
    }
}

impl fmt::Display for Sequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let EyePath { azimuth, turn, sway, distance, breath, height } = self.eye;
        let floor = if self.kind.has_checker() { "a checker" } else { "a plain floor" };
        write!(f, "{} spheres on {floor}; eye from {:.0} degrees", self.balls.len(), azimuth.to_degrees())?;
        write!(f, " by {:.2} a frame, swaying {:.0},", (turn / FRAMES as f32).to_degrees(), sway.to_degrees())?;
        write!(f, " at {distance:.1} +- {breath:.1}, {height:.1} high")?;
        let Lamp { position, circles, .. } = self.lamp;
        write!(f, "; light {} {position:.1}", if circles { "circling from" } else { "at" })?;
        match self.moving {
            Some(at) => write!(f, "; the sphere at {:.1} moves", self.balls[at].center),
            None => Ok(()),
        }
    }
}

/// Numbers drawn from a seed: the generator of Steele, Lea and Flood 2014 (`SplitMix64`).
pub(crate) struct Draw(u64);

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub(crate) fn between(&mut self, least: f32, most: f32) -> f32 {
        least + (most - least) * (self.next() >> 40) as f32 / (1 << 24) as f32
    }

    pub(crate) fn sign(&mut self) -> f32 {
        if self.below(2) == 0 { 1.0 } else { -1.0 }
    }

    /// A place on the floor, that far from the origin.
    fn place(&mut self, least: f32, most: f32) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.between(0.0, TAU));
        self.between(least, most) * Vec2::new(cos, sin)
    }

    /// Returns `count` spheres that lie on the floor and do not touch. The floor has room for more.
    fn balls(&mut self, count: usize) -> Vec<Ball> {
        let mut balls: Vec<Ball> = Vec::new();
        while balls.len() < count {
            let (place, radius) = (self.place(0.0, 3.2), self.between(0.8, 1.2));
            let center = Vec3::new(place.x, radius, place.y);
            let is_free = |ball: &Ball| ball.center.distance(center) > ball.radius + radius;
            if balls.iter().all(is_free) {
                let [r, g, b] = [(); 3].map(|()| self.between(0.08, 0.9));
                balls.push(Ball { center, radius, reflectance: LinearRgb::new(r, g, b) });
            }
        }
        balls
    }
}
