//! The calls, grouped by topic.

use ratatui::Terminal;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::fmt::{Debug, Display};
use std::io::Cursor;
use std::num::NonZeroU32;
use std::path::Path;
use termtrace::glam::Vec3;
use termtrace::{
    Background, Camera, CameraPath, Cast, CellMode, Encoder, EncoderBackend, Gif, Grid, LinearRgb, Material, Mesh,
    Painter, Picture, Plane, PointLight, Pose, Render, Resolution, Sampling, Scene, Size, Sphere, Srgb8, Triangle,
    ViewRectangle, describe, explain, export, frame_grid, lay_over, render, text_frame, tone,
};

/// The ending that the documentation promises for a call.
#[derive(Clone, Copy)]
pub enum Ends {
    /// It returns, be it an error.
    Returning,
    /// It panics, as its documentation says.
    Panicking,
}

use Ends::{Panicking, Returning};

type Call = (&'static str, Ends, fn() -> String);

/// Describes a result in a short line.
fn described<T: Debug, E: Display>(made: Result<T, E>) -> String {
    match made {
        Ok(made) => format!("made {made:?}").chars().take(60).collect(),
        Err(error) => format!("error: {error}"),
    }
}

fn camera() -> Camera {
    Camera::look_at(Vec3::new(0.0, 1.0, 5.0), Vec3::ZERO).expect("a view")
}

fn sun() -> PointLight {
    PointLight::new(Vec3::new(2.0, 4.0, 3.0), LinearRgb::grey(20.0)).expect("a light")
}

fn grey() -> Material {
    Material::diffuse(LinearRgb::grey(0.8)).expect("a reflectance")
}

fn ball() -> Sphere {
    Sphere::new(Vec3::ZERO, 1.0).expect("a sphere")
}

fn scene() -> Scene {
    Scene::builder(camera()).light(sun()).object(ball(), grey()).build().expect("a scene")
}

/// The scene with these lights.
fn lit(lights: &[PointLight]) -> Scene {
    let builder = Scene::builder(camera()).object(ball(), grey());
    lights.iter().fold(builder, |builder, &light| builder.light(light)).build().expect("a scene")
}

fn bare() -> Scene {
    Scene::builder(camera()).build().expect("a scene")
}

/// Renders and tones a picture; returns its number of pixels, all of which are finite.
fn traced(scene: &Scene, size: Resolution, sampling: impl Into<Sampling>) -> String {
    let light = render(scene, scene.camera(), size, sampling);
    let finite = light.pixels().iter().filter(|light| light.r.is_finite()).count();
    assert_eq!(finite, light.pixels().len(), "every pixel is a number");
    format!("{} pixels", tone(&light, scene).pixels().len())
}

fn sized(width: u32, height: u32) -> String {
    match Resolution::new(width, height) {
        Ok(size) => traced(&scene(), size, NonZeroU32::MIN),
        Err(error) => format!("error: {error}"),
    }
}

fn small() -> Resolution {
    Resolution::square(6, 4)
}

fn picture(width: u32, height: u32) -> Picture {
    let pixels = vec![Srgb8::new(9, 9, 9); width as usize * height as usize];
    Picture::from_pixels(width, height, pixels).expect("all its pixels")
}

fn posed(eye: Vec3, target: Vec3, up: Vec3) -> String {
    let rectangle = ViewRectangle::from_vertical_fov(0.7).expect("a field of view");
    described(Camera::new(Pose { eye, target, up }, rectangle))
}

fn gif(size: Resolution, scale: u32, rate: u32) -> String {
    let film = Gif::begin(Cursor::new(Vec::new()), size, scale, rate);
    described(film.and_then(|mut film| {
        film.frame(&picture(size.width(), size.height()))?;
        film.end().map(|file| file.get_ref().len())
    }))
}

fn cast(size: Size, rate: u32) -> String {
    let film = Cast::begin(Vec::new(), size, Encoder::new(), rate);
    described(film.and_then(|mut film| {
        film.frame(Grid::new(size))?;
        film.end().map(|file| file.len())
    }))
}

/// All calls.
pub const CALLS: &[Call] = &[
    // Sizes of pictures.
    ("picture 0x0", Returning, || sized(0, 0)),
    ("picture 0x7", Returning, || sized(0, 7)),
    ("picture 7x0", Returning, || sized(7, 0)),
    ("picture of all pixels", Returning, || sized(u32::MAX, u32::MAX)),
    ("picture of one row of all pixels", Returning, || sized(u32::MAX, 1)),
    ("picture of one column of all pixels", Returning, || sized(1, u32::MAX)),
    ("picture 150,000 square", Returning, || sized(150_000, 150_000)),
    ("square of all pixels", Panicking, || format!("{:?}", Resolution::square(u32::MAX, u32::MAX))),
    ("pixel aspect 0", Returning, || described(CellMode::RAMP.resolution(Size::new(6, 4), 0.0))),
    ("pixel aspect below 0", Returning, || described(CellMode::RAMP.resolution(Size::new(6, 4), -2.0))),
    ("pixel aspect NaN", Returning, || described(CellMode::RAMP.resolution(Size::new(6, 4), f32::NAN))),
    ("pixel aspect infinite", Returning, || described(CellMode::RAMP.resolution(Size::new(6, 4), f32::INFINITY))),
    ("pixel aspect tiny", Returning, || {
        let size = CellMode::RAMP.resolution(Size::new(6, 4), 1e-40);
        size.map_or_else(|error| error.to_string(), |size| traced(&scene(), size, NonZeroU32::MIN))
    }),
    // Samples and threads.
    ("all samples", Returning, || traced(&scene(), Resolution::square(1, 1), NonZeroU32::MAX)),
    ("up to all samples", Returning, || traced(&scene(), Resolution::square(1, 1), Sampling::UpTo(NonZeroU32::MAX))),
    ("best samples of no pixels", Returning, || traced(&scene(), Resolution::square(0, 0), Sampling::BEST)),
    ("coarse samples of one pixel", Returning, || traced(&scene(), Resolution::square(1, 1), Sampling::Coarse)),
    ("no threads", Returning, || described(Render::new(&scene()).resolution(small()).threads(0).run())),
    ("all threads", Returning, || described(Render::new(&scene()).resolution(small()).threads(usize::MAX).run())),
    // Shapes.
    ("sphere at NaN", Returning, || described(Sphere::new(Vec3::NAN, 1.0))),
    ("sphere far away", Returning, || described(Sphere::new(Vec3::splat(f32::MAX), 1.0))),
    ("sphere of radius 0", Returning, || described(Sphere::new(Vec3::ZERO, 0.0))),
    ("sphere of radius below 0", Returning, || described(Sphere::new(Vec3::ZERO, -3.0))),
    ("sphere of radius NaN", Returning, || described(Sphere::new(Vec3::ZERO, f32::NAN))),
    ("sphere of infinite radius", Returning, || described(Sphere::new(Vec3::ZERO, f32::INFINITY))),
    ("plane without normal", Returning, || described(Plane::new(Vec3::ZERO, Vec3::ZERO))),
    ("plane of normal NaN", Returning, || described(Plane::new(Vec3::ZERO, Vec3::NAN))),
    ("plane of a tiny normal", Returning, || described(Plane::new(Vec3::ZERO, Vec3::Y * 1e-30))),
    ("triangle at NaN", Returning, || described(Triangle::new([Vec3::NAN; 3]))),
    ("triangle of a point", Returning, || described(Triangle::new([Vec3::ONE; 3]))),
    ("triangle of a line", Returning, || described(Triangle::new([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]))),
    ("mesh of nothing", Returning, || described(Mesh::from_triangles(vec![], vec![]))),
    ("mesh with a wrong index", Returning, || described(Mesh::from_triangles(vec![Vec3::ZERO], vec![[0, 1, 2]]))),
    ("mesh at NaN", Returning, || described(Mesh::from_triangles(vec![Vec3::NAN; 3], vec![[0, 1, 2]]))),
    ("mesh of a point", Returning, || {
        let mesh = Mesh::from_triangles(vec![Vec3::ZERO], vec![[0, 0, 0]]);
        let built = mesh.map(|mesh| Scene::builder(camera()).object(mesh, grey()).build());
        built.map_or_else(|error| error.to_string(), |scene| traced(&scene.expect("a scene"), small(), NonZeroU32::MIN))
    }),
    // Materials and lights.
    ("reflectance above 1", Returning, || described(Material::diffuse(LinearRgb::grey(1.5)))),
    ("reflectance NaN", Returning, || described(Material::diffuse(LinearRgb::grey(f32::NAN)))),
    ("squares of size 0", Returning, || described(Material::checker(LinearRgb::BLACK, LinearRgb::grey(1.0), 0.0))),
    ("squares of size NaN", Returning, || {
        described(Material::checker(LinearRgb::BLACK, LinearRgb::grey(1.0), f32::NAN))
    }),
    ("squares on a sphere", Returning, || {
        let squares = Material::checker(LinearRgb::BLACK, LinearRgb::grey(1.0), 1.0).expect("a pattern");
        described(Scene::builder(camera()).object(ball(), squares).build())
    }),
    ("light at NaN", Returning, || described(PointLight::new(Vec3::NAN, LinearRgb::grey(1.0)))),
    ("light below 0", Returning, || described(PointLight::new(Vec3::ZERO, LinearRgb::grey(-1.0)))),
    ("infinite light", Returning, || described(PointLight::new(Vec3::ZERO, LinearRgb::grey(f32::INFINITY)))),
    ("light on a surface", Returning, || {
        let light = PointLight::new(Vec3::Z, LinearRgb::grey(5.0)).expect("a light");
        traced(&lit(&[light]), small(), Sampling::BEST)
    }),
    ("fifty lights", Returning, || traced(&lit(&[sun(); 50]), small(), NonZeroU32::MIN)),
    // Scenes.
    ("nothing to see", Returning, || traced(&bare(), small(), Sampling::BEST)),
    ("exposure 0", Returning, || described(Scene::builder(camera()).exposure(0.0).build())),
    ("exposure NaN", Returning, || described(Scene::builder(camera()).exposure(f32::NAN).build())),
    ("ambient NaN", Returning, || described(Scene::builder(camera()).ambient(LinearRgb::grey(f32::NAN)).build())),
    ("background below 0", Returning, || {
        described(Scene::builder(camera()).background(Background::Color(LinearRgb::grey(-1.0))).build())
    }),
    ("file of parentheses", Returning, || described(Scene::from_ron("deep.ron", &"(".repeat(200_000)))),
    ("file of brackets", Returning, || {
        described(Scene::from_ron("deep.ron", &format!("(objects: {})", "[".repeat(200_000))))
    }),
    ("empty file", Returning, || described(Scene::from_ron("empty.ron", ""))),
    ("folder instead of a file", Returning, || described(Scene::load(Path::new("/")))),
    // Cameras.
    ("camera at NaN", Returning, || posed(Vec3::NAN, Vec3::ZERO, Vec3::Y)),
    ("camera at its target", Returning, || posed(Vec3::ONE, Vec3::ONE, Vec3::Y)),
    ("camera far away", Returning, || posed(Vec3::splat(f32::MAX), Vec3::splat(f32::MIN), Vec3::Y)),
    ("camera without up", Returning, || posed(Vec3::Z, Vec3::ZERO, Vec3::ZERO)),
    ("camera that looks up", Returning, || described(Camera::look_at(Vec3::ZERO, Vec3::Y))),
    ("field of view 0", Returning, || described(camera().with_fov_degrees(0.0))),
    ("field of view 180", Returning, || described(camera().with_fov_degrees(180.0))),
    ("field of view NaN", Returning, || described(camera().with_fov_degrees(f32::NAN))),
    ("tiny field of view", Returning, || described(ViewRectangle::from_vertical_fov(1e-42))),
    ("orbit of no seconds", Returning, || described(CameraPath::orbit(camera(), 0.0).camera_at(1.0))),
    ("orbit at NaN", Returning, || described(CameraPath::orbit(camera(), f64::NAN).camera_at(f64::NAN))),
    // Cells.
    ("text of 0x0", Returning, || text_frame(&scene(), Size::new(0, 0))),
    ("text of 0x9", Returning, || text_frame(&scene(), Size::new(0, 9))),
    ("text of 9x0", Returning, || text_frame(&scene(), Size::new(9, 0))),
    ("text of all cells", Panicking, || text_frame(&scene(), Size::new(u16::MAX, u16::MAX))),
    ("grid of all cells", Panicking, || format!("{:?}", Grid::new(Size::new(u16::MAX, u16::MAX)).size())),
    ("cells of aspect 0", Panicking, || {
        format!("{:?}", frame_grid(&scene(), CellMode::HALF_BLOCK, Size::new(4, 4), 0.0).size())
    }),
    ("paint 0x0", Returning, || format!("{:?}", Painter::new(CellMode::HALF_BLOCK).grid(&picture(0, 0)).size())),
    ("encode 0x0", Returning, || {
        let mut bytes = Vec::new();
        Encoder::new().encode(&Grid::new(Size::new(0, 0)), &mut bytes);
        format!("{} bytes", bytes.len())
    }),
    ("encode another size", Returning, || {
        let (mut encoder, mut bytes) = (Encoder::new(), Vec::new());
        for side in [9, 2, 0, 5] {
            encoder.encode(&Grid::new(Size::new(side, side)), &mut bytes);
        }
        format!("{} bytes", bytes.len())
    }),
    ("a buffer that is elsewhere", Returning, || {
        let mut grid = Grid::new(Size::new(3, 3));
        lay_over(&mut grid, &Buffer::empty(Rect::new(2, 2, 500, 500)));
        format!("{:?}", grid.size())
    }),
    ("backend of 0x0", Returning, || {
        let mut terminal = Terminal::new(EncoderBackend::new(Vec::new(), (0, 0))).expect("it writes to memory");
        described(
            terminal.draw(|frame| frame.render_widget("text", frame.area())).map(drop).and_then(|()| terminal.clear()),
        )
    }),
    // Files and words.
    ("png of 0x0", Returning, || described(export::png(&picture(0, 0), 1.0, 1))),
    ("png at scale 0", Returning, || described(export::png(&picture(2, 2), 1.0, 0))),
    ("png at all scales", Returning, || described(export::png(&picture(2, 2), 1.0, u32::MAX))),
    ("png of aspect NaN", Returning, || described(export::png(&picture(2, 2), f32::NAN, 1))),
    ("svg of aspect 0", Returning, || export::svg(&Grid::new(Size::new(2, 2)), 0.0)),
    ("svg of aspect NaN", Returning, || export::svg(&Grid::new(Size::new(2, 2)), f32::NAN)),
    ("html of 0x0", Returning, || export::html(&Grid::new(Size::new(0, 0)), 2.0)),
    ("gif of 0x0", Returning, || gif(Resolution::square(0, 0), 1, 25)),
    ("gif at scale 0", Returning, || gif(small(), 0, 25)),
    ("gif at all scales", Returning, || gif(small(), u32::MAX, 25)),
    ("gif of no frames a second", Returning, || gif(small(), 1, 0)),
    ("gif of high pixels", Returning, || {
        let size = CellMode::RAMP.resolution(Size::new(6, 4), f32::MAX);
        size.map_or_else(|error| error.to_string(), |size| gif(size, 1, 25))
    }),
    ("cast of 0x0", Returning, || cast(Size::new(0, 0), 25)),
    ("cast of no frames a second", Returning, || cast(Size::new(4, 2), 0)),
    ("explain outside", Panicking, || explain(&scene(), &camera(), small(), [6, 4]).to_string()),
    ("explain 0x0", Panicking, || explain(&scene(), &camera(), Resolution::square(0, 0), [0, 0]).to_string()),
    ("describe 0x0", Returning, || describe("x", &scene(), &camera(), Resolution::square(0, 0))),
    ("describe nothing", Returning, || describe("x", &bare(), &camera(), small())),
];
