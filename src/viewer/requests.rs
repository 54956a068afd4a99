//! Commands that the driver has to carry out: copying the camera, exporting the picture, and saving
//! a view to the file.

use super::activity::Activity;
use super::dialog::{Answer, Dialog};
use super::{Job, Request, Shot, Viewer};
use crate::camera::Camera;
use crate::control::Command;
use crate::framebuffer::Resolution;
use crate::render::Sampling;

/// The longer side of a large picture in pixels.
const LARGE_SIDE: u32 = 1920;

/// Returns the size of a large picture, of square pixels, in the shape of the shown one.
fn large_resolution(shown: Resolution) -> Resolution {
    let aspect = shown.aspect_ratio();
    // The shorter side of a window of one row or column would be rounded to no pixels.
    let scaled = |by: f32| ((LARGE_SIDE as f32 * by).round() as u32).clamp(1, LARGE_SIDE);
    Resolution::square(scaled(aspect), scaled(1.0 / aspect))
}

impl Viewer {
    /// Requests that the camera is copied to the clipboard, as a line of a scene file.
    pub(super) fn copy_camera(&mut self) {
        if let Some(camera) = self.first_camera() {
            self.requests.push_back(Request::Copy(format!("{},", camera.rounded().to_ron())));
            self.show_note("camera copied, if the terminal allows it; it is also printed on exit");
        }
    }

    /// Requests that the user is asked whether to write the view into the scene's file.
    pub(super) fn propose_view(&mut self) {
        self.requests.extend(self.first_camera().map(|camera| Request::ProposeView(camera.rounded())));
    }

    /// Opens the question in which format to export the picture, if there are a picture and a
    /// folder for exports.
    pub(super) fn ask_export(&mut self) {
        if self.options.exports.is_some() && self.screen.frame().is_some() {
            self.screen.open(Dialog::Export);
        }
    }

    /// Requests a large picture of the wanted view, if there is a folder for it.
    pub(super) fn ask_large_picture(&mut self) {
        if self.options.exports.is_none() {
            return;
        }
        if self.screen.is_loading_scene() {
            self.show_note("the scene is still loading");
        } else if self.screen.get::<Activity>().is_some_and(|activity| activity.picture.is_some()) {
            self.show_note("a large picture is being made; Esc cancels it");
        } else if self.screen.frame().is_some() {
            self.requests.push_back(Request::ExportLarge);
        }
    }

    /// Requests to cancel the large picture, if one is in progress.
    pub(super) fn cancel_large_picture(&mut self) {
        if self.screen.get::<Activity>().is_some_and(|activity| activity.picture.is_some()) {
            self.requests.push_back(Request::CancelLarge);
        }
    }

    /// Requests to start or to stop recording the session, if there is a folder for it.
    pub(super) fn toggle_recording(&mut self) {
        if self.options.exports.is_some() {
            self.requests.push_back(Request::Record);
        }
    }

    /// Shows the work in the background, or hides the line about it if there is none.
    pub(crate) fn show_activity(&mut self, activity: Activity) {
        self.screen.set(Some(activity).filter(|activity| activity.is_any()));
    }

    /// Returns the job that traces the large picture of the wanted view, and the position of the
    /// line between the two maps of a wipe, as a share of the width.
    pub(crate) fn large_picture_job(&self) -> Option<(Job, f32)> {
        let (scene, shot) = self.scene_at_current_time().zip(self.current_shot())?;
        let resolution = large_resolution(shot.resolution);
        // The file has pixels, so it needs neither the geometry that glyphs show nor the comparison that a panel
        // explains.
        let layout = if shot.orders { self.layout } else { shot.layout };
        let shot = Shot { resolution, layout, orders: false, geometry: false, ..shot };
        Some((Job { scene, shot, sampling: Sampling::BEST, refines: false }, self.screen.wipe()))
    }

    /// Opens the question whether to write the proposed camera into the scene file of this name.
    pub(crate) fn ask_to_save_view(&mut self, file: String) {
        self.screen.open(Dialog::SaveToFile(file));
    }

    /// Asks whether to write a new scene file of this name.
    pub(crate) fn ask_to_write_scene(&mut self, file: String) {
        self.screen.open(Dialog::NewScene(file));
    }

    /// Returns the text of a scene file with the shown mesh, whose file is `name`, the current
    /// lights and `camera`. `None` if the shown scene has its own file.
    pub(crate) fn scene_around_mesh(&self, name: &str, camera: &Camera) -> Option<String> {
        self.scene_at_current_time()?.around_mesh_to_ron(name, camera)
    }

    /// Closes the open question and carries out the answer `meant`. Returns whether a question was
    /// open.
    pub(super) fn take_answer(&mut self, meant: Option<Command>) -> bool {
        let Some(dialog) = self.screen.close::<Dialog>() else { return false };
        match dialog.answer(meant) {
            Answer::Export(format) => self.requests.push_back(Request::Export(format)),
            Answer::SaveToFile => self.requests.push_back(Request::SaveView),
            Answer::Save(number) => self.save_view(number),
            Answer::Nothing => {}
        }
        true
    }
}
