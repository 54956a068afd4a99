//! The scene and camera arguments of every command.

use super::outcome::{CommandResult, Failure, usage, warn};
use super::scene_source::SceneSource;
use super::shipped::ShippedScene;
use super::threads::on_threads;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::{Vec2, Vec3};
use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::UpAxis;
use termtrace::internals::progress::Reporter;
use termtrace::internals::scene::Draft;
use termtrace::{Camera, CameraError, Pose, Scene};

const SCENE_HELP: &str = "Scene or mesh; - is standard input [default: three_spheres]";

/// The arguments that name a scene and change its camera.
#[derive(Args)]
pub(super) struct SceneArgs {
    #[arg(value_name = "SCENE", help = SCENE_HELP)]
    scene: Option<PathBuf>,
    #[command(flatten)]
    pub(super) camera_args: CameraArgs,
    /// Seconds to which a moving scene is set
    #[arg(long, value_name = "S", value_parser = parse_time, default_value_t = 0.0, allow_hyphen_values = true)]
    #[arg(help_heading = "Picture", hide_short_help = true)]
    pub(super) time: f64,
}

impl SceneArgs {
    /// Returns the scene's name as messages show it.
    pub(super) fn name(&self) -> String {
        self.scene.as_deref().unwrap_or(Path::new(ShippedScene::default_scene().name)).display().to_string()
    }

    /// Refuses an output file that is the scene file or one of the `others`, under any path.
    pub(super) fn refuse_overwriting(&self, others: &[&Path], output: &Path) -> CommandResult {
        let is_output = |input: &&Path| match (input.canonicalize(), output.canonicalize()) {
            // Canonical paths are compared, so that a link or another spelling of the path is recognised.
            (Ok(input), Ok(output)) => input == output,
            // A file that does not exist yet has no canonical path, and nothing is overwritten.
            _ => false,
        };
        if self.scene.as_deref().iter().chain(others).any(is_output) {
            return Err(Failure::Usage(format!("{} is an input file and would be overwritten", output.display())));
        }
        Ok(())
    }

    /// Loads the scene, with the camera and the time changed by the flags.
    pub(super) fn load_scene(&self) -> Result<Scene, Failure> {
        let source = SceneSource::from_argument(self.scene.as_deref(), self.camera_args.mesh_format)?;
        Ok(self.camera_args.load_scene(&source)?.at_time(self.time))
    }

    /// Runs `work` in a pool with the number of threads given by `--threads`.
    pub(super) fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        on_threads(self.camera_args.threads, work)
    }
}

/// The flags for the camera, for a mesh, and for the threads that trace.
#[derive(Args, Clone, Default)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// Eye point, instead of the scene's
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    pub(super) eye: Option<Vec3>,
    /// Point that the camera looks at, instead of the scene's target
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true, hide_short_help = true)]
    pub(super) target: Option<Vec3>,
    /// Up vector, vertical in the picture, instead of the scene's
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true, hide_short_help = true)]
    pub(super) up: Option<Vec3>,
    /// Vertical field of view in degrees, instead of the scene's
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, hide_short_help = true)]
    pub(super) fov: Option<f32>,
    /// Shift of the view rectangle to the right and up, in its heights, instead of the scene's
    #[arg(long, value_name = "X,Y", value_parser = parse_vec2, allow_hyphen_values = true, hide_short_help = true)]
    pub(super) shift: Option<Vec2>,
    /// Tilt of the view rectangle to the right and up in degrees, instead of the scene's
    #[arg(long, value_name = "X,Y", value_parser = parse_vec2, allow_hyphen_values = true, hide_short_help = true)]
    pub(super) tilt: Option<Vec2>,
    /// Axis of a mesh file that points up [default: y; for STL and PLY a guess]
    #[arg(long, value_name = "AXIS", value_parser = up_axis_parser(), allow_hyphen_values = true)]
    #[arg(help_heading = "Mesh", hide_short_help = true)]
    pub(super) mesh_up: Option<UpAxis>,
    /// Format of a mesh on standard input [default: by its content]
    #[arg(long = "as", value_name = "FORMAT", value_parser = mesh_format_parser())]
    #[arg(help_heading = "Mesh", hide_short_help = true)]
    pub(super) mesh_format: Option<&'static str>,
    /// Refuse a mesh whose materials or textures are missing, as check does
    #[arg(long, help_heading = "Mesh", hide_short_help = true)]
    pub(super) strict: bool,
    /// Draw with the lecture's model of light only: diffuse surfaces, point sources, clear air
    #[arg(long, help_heading = "Picture", hide_short_help = true)]
    pub(super) lecture: bool,
    /// Number of threads that trace [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Picture", hide_short_help = true)]
    pub(super) threads: Option<u16>,
}

impl CameraArgs {
    /// Loads the scene, with the camera changed by the flags.
    pub(super) fn load_scene(&self, source: &SceneSource) -> Result<Scene, Failure> {
        let on_warning = |warning: String| warn(warning);
        let reporter = Reporter::silent().with_warnings(&on_warning);
        let draft = on_threads(self.threads, || self.load_without_camera_flags(source, self.mesh_up, &reporter))??;
        if let Some(mesh) = draft.mesh().filter(|mesh| mesh.is_guess && mesh.up != UpAxis::Y) {
            let (up, format) = (mesh.up.name(), mesh.format);
            warn(format!(
                "{source}: {up} is taken for up in this {format}; --mesh-up y (or another axis) says otherwise"
            ));
        }
        let scene = on_threads(self.threads, || draft.finish())?;
        let camera = self.camera(scene.camera()).map_err(usage)?;
        Ok(scene.with_camera(camera))
    }

    /// Loads the scene without building its trees, with the camera changed by the flags, until the
    /// reporter cancels.
    ///
    /// A mesh file is turned so that its axis `up` points up, by default that of the command line.
    pub(super) fn load_draft(
        &self,
        source: &SceneSource,
        up: Option<UpAxis>,
        reporter: &Reporter<'_>,
    ) -> Result<Draft, Failure> {
        let draft = self.load_without_camera_flags(source, up.or(self.mesh_up), reporter)?;
        let camera = self.camera(draft.camera()).map_err(usage)?;
        Ok(draft.with_camera(camera))
    }

    fn load_without_camera_flags(
        &self,
        source: &SceneSource,
        up: Option<UpAxis>,
        reporter: &Reporter<'_>,
    ) -> Result<Draft, Failure> {
        if self.mesh_format.is_some() && !matches!(source, SceneSource::Stdin(..)) {
            let message = "--as is for a mesh on standard input (-); the format of a file is recognised";
            return Err(Failure::Usage(format!("{source}: {message}")));
        }
        let draft =
            if self.strict { source.load_draft(up, &reporter.strict()) } else { source.load_draft(up, reporter) }?;
        // An error, because a user would take a flag without any effect for a fault of the program.
        if self.mesh_up.is_some() && draft.mesh().is_none() {
            let message = "--mesh-up turns a mesh file; in a scene, write rotate: (-90, 0, 0) in the mesh";
            return Err(Failure::Usage(format!("{source}: {message}")));
        }
        Ok(if self.lecture { draft.in_lecture() } else { draft })
    }

    /// Returns `camera` changed by the flags for its pose and its view rectangle.
    pub(super) fn camera(&self, camera: &Camera) -> Result<Camera, CameraError> {
        let Pose { eye, target, up } = camera.pose();
        let pose =
            Pose { eye: self.eye.unwrap_or(eye), target: self.target.unwrap_or(target), up: self.up.unwrap_or(up) };
        let camera = camera.with_pose(pose)?;
        // Untilted first: only the sides and the shift of the final rectangle decide how far it can be tilted.
        let own = camera.rectangle();
        let mut rectangle = own.with_tilt(Vec2::ZERO)?;
        if let Some(degrees) = self.fov {
            rectangle = rectangle.with_vertical_fov(degrees.to_radians())?;
        }
        // Converted in f64, as the angles of a scene file are, so that the same tilt gives the same camera.
        let radians = |degrees: Vec2| degrees.as_dvec2() * 1_f64.to_radians();
        let tilt = self.tilt.map_or(own.tilt(), |degrees| radians(degrees).as_vec2());
        Ok(camera.with_rectangle(rectangle.with_shift(self.shift.unwrap_or(own.shift()))?.with_tilt(tilt)?))
    }
}

/// The extensions of the mesh formats, as `--as` takes them.
const MESH_FORMATS: [&str; 5] = ["obj", "stl", "ply", "gltf", "glb"];

fn mesh_format_parser() -> impl TypedValueParser<Value = &'static str> {
    let known = |name: String| MESH_FORMATS.into_iter().find(|format| *format == name).unwrap_or_default();
    PossibleValuesParser::new(MESH_FORMATS).map(known)
}

fn up_axis_parser() -> impl TypedValueParser<Value = UpAxis> {
    PossibleValuesParser::new(UpAxis::ALL.map(UpAxis::name)).map(|name| UpAxis::from_name(&name).unwrap_or_default())
}

/// Parses a time in seconds, within the limits of a path file.
fn parse_time(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| seconds.abs() <= 1e6);
    seconds.ok_or_else(|| "expected a number of seconds from -1e6 to 1e6, such as 2.5".to_owned())
}

/// Parses two numbers such as `0,-21.5`.
fn parse_vec2(text: &str) -> Result<Vec2, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|number| number.trim().parse::<f32>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y]) if x.is_finite() && y.is_finite() => Ok(Vec2::new(x, y)),
        _ => Err("expected two numbers with a comma between them, such as 0,-21.5".to_owned()),
    }
}

/// Parses a vector such as `0,1.5,6`, each number within a scene file's limits.
fn parse_vec3(text: &str) -> Result<Vec3, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|number| number.trim().parse::<f32>()).collect();
    match numbers.as_deref() {
        // The comparison is false for NaN and infinity too.
        Ok(&[x, y, z]) if [x, y, z].iter().all(|number| number.abs() <= 1e9) => Ok(Vec3::new(x, y, z)),
        _ => Err("expected three numbers from -1e9 to 1e9 with commas between them, such as 0,1.5,6".to_owned()),
    }
}
