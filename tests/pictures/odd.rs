//! Odd arguments to the library's functions.
//!
//! Each call returns, is an error, or panics as its documentation says. None takes memory or time without a bound.

use glam::{Mat3, Vec2, Vec3};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::io::Cursor;
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use termtrace::internals::light::{SpotLight, Sun};
use termtrace::internals::material::{Checker, Gradient, Noise, Stripes};
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::render::ProgressiveRender;
use termtrace::internals::{cell, control, maps, record};
use termtrace::{
    Camera, CameraPath, Cell, CellMode, Encoder, EncoderBackend, Framebuffer, Grid, LinearRgb, Map, Material, Picture,
    Plane, PointLight, Pose, Render, Resolution, Sampling, Scene, Size, Sphere, Srgb8, Triangle, ViewRectangle,
    describe, explain, export, frame_grid, lay_over, render, text_frame, tone,
};

/// The end of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    /// It returns a value, or an error, whose text begins so.
    With(&'static str),
    /// It panics with a message that begins so, as its documentation says.
    InPanic(&'static str),
}

use Ends::{InPanic, With};

type Case = (&'static str, Ends, fn() -> String);

const ONE: NonZeroU32 = NonZeroU32::MIN;
const BLACK: Srgb8 = Srgb8::new(0, 0, 0);

fn camera() -> Camera {
    Camera::look_at(Vec3::new(0.0, 1.0, 4.0), Vec3::ZERO).expect("a view")
}

fn lamp() -> PointLight {
    PointLight::new(Vec3::ONE * 3.0, LinearRgb::grey(9.0)).expect("a light")
}

fn ball() -> Sphere {
    Sphere::new(Vec3::ZERO, 1.0).expect("a sphere")
}

fn scene() -> Scene {
    Scene::builder(camera()).object(ball(), Material::DEFAULT).light(lamp()).build().expect("a scene")
}

fn empty() -> Scene {
    Scene::builder(camera()).light(lamp()).build().expect("a scene")
}

/// Returns a value in words, or the error.
fn told<T, E: ToString>(made: Result<T, E>, words: impl FnOnce(T) -> String) -> String {
    made.map_or_else(|error| error.to_string(), words)
}

/// Returns that a value was made, or the error.
fn made<T, E: ToString>(made: Result<T, E>) -> String {
    told(made, |_| "made".to_owned())
}

/// The number of pixels of a picture, all of which are finite.
fn shot(scene: &Scene, resolution: Resolution) -> String {
    let light = render(scene, scene.camera(), resolution, ONE);
    assert!(light.pixels().iter().all(|light| light.is_finite()), "{light:?}");
    tone(&light, scene).pixels().len().to_string()
}

fn pixels(width: u32, height: u32) -> String {
    told(Resolution::new(width, height), |resolution| shot(&scene(), resolution))
}

fn aspect(pixel_aspect: f32) -> String {
    made(Resolution::square(9, 9).with_pixel_aspect(pixel_aspect))
}

fn size(columns: u16, rows: u16) -> Grid {
    Grid::new(Size::new(columns, rows))
}

fn picture(width: u32, height: u32) -> Picture {
    Picture::from_pixels(width, height, vec![BLACK; (width * height) as usize]).expect("a pixel for each place")
}

fn lit_by(lights: usize) -> Scene {
    scene().with_lights(vec![lamp(); lights])
}

fn looking(eye: Vec3, target: Vec3) -> String {
    made(Camera::new(Pose { eye, target, up: Vec3::Y }, camera().rectangle()))
}

fn film(resolution: Resolution, scale: u32, frames_per_second: u32) -> String {
    let gif = record::Gif::begin(Cursor::new(Vec::new()), resolution, scale, frames_per_second);
    made(gif.and_then(|mut gif| gif.frame(&picture(resolution.width(), resolution.height()))))
}

const NOT_FINITE: &str = ": the number must be finite";
const TOO_LARGE: &str = " is too large; at most 33554432 pixels in all";

fn renders() -> Vec<Case> {
    vec![
        ("render 0x0", With("0"), || pixels(0, 0)),
        ("render 0x5", With("0"), || pixels(0, 5)),
        ("render 5x0", With("0"), || pixels(5, 0)),
        ("render with pixel aspect 0", With("a pixel's height over its width must be greater than 0"), || aspect(0.0)),
        ("render with pixel aspect NaN", With("a pixel's height over its width must be greater"), || aspect(f32::NAN)),
        ("render with a negative pixel aspect", With("a pixel's height over its width must be"), || aspect(-1.0)),
        ("render with an infinite pixel aspect", With("a pixel's height over its width"), || aspect(f32::INFINITY)),
        ("render huge", With(TOO_LARGE), || pixels(u32::MAX, u32::MAX)),
        ("render huge and wide", With(TOO_LARGE), || pixels(u32::MAX, 1)),
        ("render 200,000 square", With(TOO_LARGE), || pixels(200_000, 200_000)),
        ("square huge", InPanic("a picture may have 33554432 pixels"), || {
            Resolution::square(u32::MAX, u32::MAX).width().to_string()
        }),
        ("render 0x0 at best", With("0"), || {
            render(&scene(), &camera(), Resolution::square(0, 0), Sampling::BEST).pixels().len().to_string()
        }),
        ("render with the most samples", With("1"), || {
            render(&scene(), &camera(), Resolution::square(1, 1), NonZeroU32::MAX).pixels().len().to_string()
        }),
        ("render on more threads than there can be", With("made"), || {
            made(Render::new(&scene()).resolution(Resolution::square(8, 8)).threads(usize::MAX).run())
        }),
        ("refine 0x0", With("0"), || {
            ProgressiveRender::new(&camera(), Resolution::square(0, 0)).framebuffer().pixels().len().to_string()
        }),
        ("no objects", With("16"), || shot(&empty(), Resolution::square(4, 4))),
        ("no light from an exposure near 0", With("16"), || {
            let dark = scene().with_exposure(1e-45).expect("an exposure");
            render(&dark, &camera(), Resolution::square(4, 4), Sampling::BEST).pixels().len().to_string()
        }),
        ("light at the surface", With("16"), || {
            let light = PointLight::new(Vec3::Z, LinearRgb::grey(9.0)).expect("a light");
            shot(&scene().with_lights([light]), Resolution::square(4, 4))
        }),
        ("40 lights", With("16"), || shot(&lit_by(40), Resolution::square(4, 4))),
        ("40 lights, their shadows", With("16"), || {
            let shadows = maps::picture(Map::Shadow, &lit_by(40), &camera(), Resolution::square(4, 4), ONE);
            shadows.pixels().len().to_string()
        }),
        ("framebuffer outside", InPanic("pixel (1, 1) is outside the picture"), || {
            format!("{:?}", Framebuffer::new(Resolution::square(1, 1)).pixel(1, 1))
        }),
        ("maps of 0x0", With("0"), || {
            let map =
                |&map: &Map| maps::picture(map, &scene(), &camera(), Resolution::square(0, 0), ONE).pixels().len();
            Map::ALL.iter().map(map).sum::<usize>().to_string()
        }),
        ("maps of 1x1", With("10"), || {
            let map =
                |&map: &Map| maps::picture(map, &scene(), &camera(), Resolution::square(1, 1), ONE).pixels().len();
            Map::ALL.iter().map(map).sum::<usize>().to_string()
        }),
    ]
}

fn scenes() -> Vec<Case> {
    vec![
        ("sphere at NaN", With(NOT_FINITE), || made(Sphere::new(Vec3::NAN, 1.0))),
        ("sphere of radius 0", With("radius is 0: the radius must be greater"), || made(Sphere::new(Vec3::ZERO, 0.0))),
        ("sphere of a negative radius", With("radius is -1: the radius must"), || made(Sphere::new(Vec3::ZERO, -1.0))),
        ("sphere of infinite radius", With(NOT_FINITE), || made(Sphere::new(Vec3::ZERO, f32::INFINITY))),
        ("plane with normal 0", With("normal is (0, 0, 0): the normal must have a length"), || {
            made(Plane::new(Vec3::ZERO, Vec3::ZERO))
        }),
        ("triangle at NaN", With(NOT_FINITE), || made(Triangle::new([Vec3::NAN; 3]))),
        ("triangle of one point", With("corners: the corners of a triangle must not lie on one line"), || {
            made(Triangle::new([Vec3::ZERO; 3]))
        }),
        ("checker of size 0", With("size is 0: the size of a square must be greater than 0"), || {
            made(Checker::new(LinearRgb::BLACK, LinearRgb::grey(1.0), 0.0))
        }),
        ("stripes of width NaN", With(NOT_FINITE), || {
            made(Stripes::new(LinearRgb::BLACK, LinearRgb::grey(1.0), f32::NAN))
        }),
        ("gradient of length 0", With("length is 0: the length of a gradient must be greater than 0"), || {
            made(Gradient::new(LinearRgb::BLACK, LinearRgb::grey(1.0), 0.0))
        }),
        ("noise of infinite size", With(NOT_FINITE), || {
            made(Noise::new(LinearRgb::BLACK, LinearRgb::grey(1.0), f32::INFINITY))
        }),
        ("sun in no direction", With("direction is (0, 0, 0): the direction must have a length"), || {
            made(Sun::new(Vec3::ZERO, LinearRgb::grey(9.0)))
        }),
        ("spot at its target", With("target is (1, 1, 1): position and target must be different points"), || {
            made(SpotLight::new(Vec3::ONE, Vec3::ONE, LinearRgb::grey(9.0)))
        }),
        ("spot with a cone of NaN degrees", With(NOT_FINITE), || {
            made(
                SpotLight::new(Vec3::ONE, Vec3::ZERO, LinearRgb::grey(9.0))
                    .and_then(|spot| spot.with_cone(f32::NAN, 0.5)),
            )
        }),
        ("spot at the surface", With("16"), || {
            let light = SpotLight::new(Vec3::Z, Vec3::ZERO, LinearRgb::grey(9.0)).expect("a light");
            shot(&scene().with_lights([light]), Resolution::square(4, 4))
        }),
        ("light at NaN", With(NOT_FINITE), || made(PointLight::new(Vec3::NAN, LinearRgb::grey(9.0)))),
        ("negative light", With("intensity is (-5, -5, -5): light must not be negative"), || {
            made(PointLight::new(Vec3::ZERO, LinearRgb::grey(-5.0)))
        }),
        ("exposure NaN", With(NOT_FINITE), || made(scene().with_exposure(f32::NAN))),
        ("exposure 0", With("exposure is 0: the exposure must be greater than 0"), || made(scene().with_exposure(0.0))),
        ("ambient NaN", With(NOT_FINITE), || made(scene().with_ambient(LinearRgb::grey(f32::NAN)))),
        ("camera at NaN", With("the camera's numbers must be finite"), || looking(Vec3::NAN, Vec3::ZERO)),
        ("camera at the ends of f32", With("coordinates must lie within ±1e9"), || {
            looking(Vec3::splat(f32::MAX), Vec3::splat(-f32::MAX))
        }),
        ("camera at 1e38", With("coordinates must lie within ±1e9"), || {
            looking(Vec3::splat(1e38), Vec3::splat(-1e38))
        }),
        ("tiny field of view", With("made"), || made(ViewRectangle::from_vertical_fov(1e-40))),
        ("orbit in NaN seconds", With("the camera's numbers must be finite"), || {
            made(CameraPath::orbit(camera(), f64::NAN).camera_at(f64::NAN))
        }),
        ("camera dragged by NaN", With("true"), || {
            let (mode, grip) = (control::KeyMode::Orbit, control::Grip::Turn);
            (control::dragged(&camera(), mode, grip, Vec2::NAN, f32::NAN) == camera()).to_string()
        }),
        ("mesh with a bad index", With("true"), || {
            MeshFile::new(vec![Vec3::ZERO], vec![[0, 1, 2]]).is_none().to_string()
        }),
        ("mesh scaled by 0", With("1"), || {
            let mesh = MeshFile::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).expect("a mesh");
            let flat = mesh.transformed(Vec3::ZERO, Mat3::IDENTITY, Vec3::ZERO);
            flat.map_or(0, |mesh| mesh.triangles().len()).to_string()
        }),
        ("100,000 parentheses", With("x:1:"), || made(Scene::from_ron("x", &"(".repeat(100_000)))),
        ("an empty scene file", With("x:1:1: "), || made(Scene::from_ron("x", ""))),
        ("a scene that is a folder", With("src: this is a directory"), || made(Scene::load(Path::new("src")))),
    ]
}

fn cells() -> Vec<Case> {
    vec![
        ("resolution of cells of aspect 0", With("a pixel's height over its width must be greater than 0"), || {
            made(cell::resolution(CellMode::HALF_BLOCK, Size::new(0, 0), 0.0))
        }),
        (
            "resolution of 65,535x65,535 cells",
            With("a grid of 65535x65535 cells is too large; at most 16777216 cells in all"),
            || made(cell::resolution(CellMode::HALF_BLOCK, Size::new(u16::MAX, u16::MAX), 2.0)),
        ),
        ("text frame of 0x0", With(""), || text_frame(&scene(), Size::new(0, 0))),
        ("text frame of 0x5", With(""), || text_frame(&scene(), Size::new(0, 5))),
        ("text frame of 5x0", With(""), || text_frame(&scene(), Size::new(5, 0))),
        ("text frame of 65,535x65,535", InPanic("a size and an aspect that pictures can have"), || {
            text_frame(&scene(), Size::new(u16::MAX, u16::MAX))
        }),
        ("frame with cells of aspect 0", InPanic("a size and an aspect that pictures can have"), || {
            format!("{:?}", frame_grid(&scene(), CellMode::HALF_BLOCK, Size::new(4, 4), 0.0))
        }),
        ("grid of 65,535x65,535", InPanic("a grid of 65535x65535 cells is too large"), || {
            size(u16::MAX, u16::MAX).cells().len().to_string()
        }),
        ("grid cleared to 65,535x65,535", InPanic("a grid of 65535x65535 cells is too large"), || {
            size(1, 1).clear(Size::new(u16::MAX, u16::MAX));
            String::new()
        }),
        ("picture with too few pixels", With("None"), || format!("{:?}", Picture::from_pixels(4, 4, vec![BLACK]))),
        ("picture without its pixels", With("None"), || format!("{:?}", Picture::from_pixels(4, 4, Vec::new()))),
        ("picture with too many pixels", With("None"), || format!("{:?}", Picture::from_pixels(0, 9, vec![BLACK]))),
        ("picture of 70,000 columns", InPanic("a grid has at most 65,535 columns and rows"), || {
            cell::grid_from_picture(CellMode::HALF_BLOCK, &picture(70_000, 1)).cells().len().to_string()
        }),
        ("cell outside", InPanic("cell (2, 2) is outside the grid"), || format!("{:?}", size(2, 2).cell(2, 2))),
        ("wide cell at the edge", InPanic("cell (2, 0) is outside the grid"), || {
            size(2, 2).put(1, 0, &Cell::BLANK, 2);
            String::new()
        }),
        ("cell of 65,535 columns", InPanic("cell (2, 0) is outside the grid"), || {
            size(2, 2).put(1, 0, &Cell::BLANK, u16::MAX);
            String::new()
        }),
        ("encode 0x0", With("4"), || {
            let mut bytes = Vec::new();
            Encoder::new().encode(&size(0, 0), &mut bytes);
            bytes.len().to_string()
        }),
        ("encode two sizes", With("true"), || {
            let (mut encoder, mut bytes) = (Encoder::new(), Vec::new());
            encoder.encode(&size(9, 9), &mut bytes);
            encoder.encode(&size(2, 2), &mut bytes);
            (!bytes.is_empty()).to_string()
        }),
        ("a backend of 0x0", With("made"), || {
            let mut terminal = ratatui::Terminal::new(EncoderBackend::new(Vec::new(), (0, 0))).expect("a terminal");
            made(
                terminal.draw(|frame| frame.render_widget("x", frame.area())).map(drop).and_then(|()| terminal.clear()),
            )
        }),
        ("buffer laid over at an offset", With("made"), || {
            lay_over(&mut size(2, 2), &Buffer::empty(Rect::new(1, 1, 9, 9)));
            "made".to_owned()
        }),
    ]
}

fn files() -> Vec<Case> {
    vec![
        ("png of 0x0", With(""), || made(export::png(&picture(0, 0), 1.0, 1))),
        ("png at scale 0", With(""), || made(export::png(&picture(1, 1), 1.0, 0))),
        ("png at the largest scale", With(TOO_LARGE), || made(export::png(&picture(2, 2), 1.0, u32::MAX))),
        ("png with pixel aspect NaN", With("a pixel's height over its width must be greater"), || {
            made(export::png(&picture(1, 1), f32::NAN, 1))
        }),
        ("svg with cells of aspect 0", With("<svg"), || export::svg(&size(2, 2), 0.0)),
        ("svg with cells of aspect NaN", With("<svg"), || export::svg(&size(2, 2), f32::NAN)),
        ("html of 0x0", With("<!"), || export::html(&size(0, 0), 2.0)),
        ("gif of 0x0", With(""), || film(Resolution::square(0, 0), 1, 30)),
        ("gif at scale 0", With(""), || film(Resolution::square(2, 2), 0, 30)),
        ("gif at the largest scale", With("a GIF has at most 65535 pixels"), || {
            film(Resolution::square(2, 2), u32::MAX, 30)
        }),
        ("gif of the highest pixels", With("[4, 18446744073709551615]"), || {
            let high = Resolution::square(4, 4).with_pixel_aspect(f32::MAX).expect("a shape");
            format!("{:?}", high.size_in_square_pixels(1))
        }),
        ("gif of 0 frames a second", With("made"), || film(Resolution::square(2, 2), 1, 0)),
        ("cast of 0 frames a second", With("made"), || {
            let cast = record::Cast::begin(Vec::new(), Size::new(0, 0), Encoder::new(), 0);
            made(cast.and_then(|mut cast| {
                cast.frame(size(0, 0))?;
                cast.end()
            }))
        }),
        ("explain outside", InPanic("pixel (9, 9) is outside the picture"), || {
            explain(&scene(), &camera(), Resolution::square(4, 4), [9, 9]).lines().concat()
        }),
        ("explain 0x0", InPanic("pixel (0, 0) is outside the picture"), || {
            explain(&scene(), &camera(), Resolution::square(0, 0), [0, 0]).lines().concat()
        }),
        ("describe 0x0", With("x"), || describe("x", &scene(), &camera(), Resolution::square(0, 0))),
        ("describe no objects", With("x"), || describe("x", &empty(), &camera(), Resolution::square(9, 9))),
    ]
}

#[test]
fn odd_arguments_end_as_they_are_documented() {
    let mut wrong = Vec::new();
    for (name, ends, call) in renders().into_iter().chain(scenes()).chain(cells()).chain(files()) {
        let ended = catch_unwind(AssertUnwindSafe(call));
        let (is_right, found) = match (&ended, ends) {
            // Some messages begin with the value: their end is compared.
            (Ok(found), With(wanted)) => (found.starts_with(wanted) || found.contains(wanted), found.clone()),
            (Ok(found), InPanic(_)) => (false, found.clone()),
            (Err(panic), ends) => {
                let text = panic.downcast_ref::<String>().cloned();
                let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default();
                (matches!(ends, InPanic(wanted) if text.starts_with(wanted)), text)
            }
        };
        if !is_right {
            wrong.push(format!("{name}: {found:?} instead of {ends:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
