//! The scene that a command is about, and who looks at it.

use super::outcome::{CommandResult, Failure, usage};
use super::scene_source::SceneSource;
use super::threads::on_threads;
use clap::Args;
use glam::Vec3;
use std::path::{Path, PathBuf};
use termtrace::internals::progress::Reporter;
use termtrace::internals::scene::Draft;
use termtrace::{Camera, CameraError, Pose, Scene};

/// The scene, and who looks at it: on every command.
#[derive(Args)]
pub(super) struct SceneArgs {
    /// The scene file; - reads the scene from standard input
    #[arg(value_name = "SCENE")]
    pub(super) scene: PathBuf,
    #[command(flatten)]
    pub(super) camera_args: CameraArgs,
}

impl SceneArgs {
    /// The scene's file name.
    pub(super) fn path(&self) -> &Path {
        &self.scene
    }

    /// Refuses to write over the scene, or another file that it is shown with.
    pub(super) fn refuse_overwriting(&self, others: &[&Path], output: &Path) -> CommandResult {
        let is_output = |input: &&Path| match (input.canonicalize(), output.canonicalize()) {
            (Ok(input), Ok(output)) => input == output,
            _ => false,
        };
        if [&[self.path()], others].concat().iter().any(is_output) {
            return Err(Failure::Usage(format!("{} would be written over what it is made from", output.display())));
        }
        Ok(())
    }

    /// The scene, with the camera that the command line wants.
    pub(super) fn load(&self) -> Result<Scene, Failure> {
        let scene = SceneSource::of(&self.scene)?.load(self.camera_args.threads)?;
        let camera = self.camera_args.camera(scene.camera()).map_err(usage)?;
        Ok(scene.with_camera(camera))
    }

    /// Does something on the threads that the command line wants.
    pub(super) fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        on_threads(self.camera_args.threads, work)
    }
}

/// Who looks at the scene.
#[derive(Args, Clone)]
pub(super) struct CameraArgs {
    /// Where to look from, instead of the scene's eye point
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    pub(super) eye: Option<Vec3>,
    /// Where to look to, instead of the scene's target
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    pub(super) target: Option<Vec3>,
    /// What is vertical in the picture, instead of the scene's up
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vec3, allow_hyphen_values = true)]
    pub(super) up: Option<Vec3>,
    /// The vertical field of view in degrees, instead of the scene's
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(super) fov: Option<f32>,
    /// How many threads trace [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
}

impl CameraArgs {
    /// The scene as it is to be looked at, not built yet, until the reporter cancels it.
    pub(super) fn draft(&self, source: &SceneSource, reporter: &Reporter<'_>) -> Result<Draft, Failure> {
        let draft = source.draft(reporter)?;
        let camera = self.camera(draft.camera()).map_err(usage)?;
        Ok(draft.with_camera(camera))
    }

    pub(super) fn camera(&self, camera: &Camera) -> Result<Camera, CameraError> {
        let Pose { eye, target, up } = camera.pose();
        let pose =
            Pose { eye: self.eye.unwrap_or(eye), target: self.target.unwrap_or(target), up: self.up.unwrap_or(up) };
        let camera = camera.with_pose(pose)?;
        match self.fov {
            Some(degrees) => Ok(camera.with_rectangle(camera.rectangle().with_vertical_fov(degrees.to_radians())?)),
            None => Ok(camera),
        }
    }
}

/// `x,y,z`, within what a scene file may say.
fn parse_vec3(text: &str) -> Result<Vec3, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|number| number.trim().parse::<f32>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if [x, y, z].iter().all(|number| number.abs() <= 1e9) => Ok(Vec3::new(x, y, z)),
        _ => Err("expected three numbers from -1e9 to 1e9 with commas between them, such as 0,1.5,6".to_owned()),
    }
}
