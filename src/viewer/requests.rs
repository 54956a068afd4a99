//! Commands that the driver has to carry out: copying the camera, exporting the picture, and saving
//! a view to the file.

use super::dialog::{Answer, Dialog};
use super::{Request, Viewer};
use crate::camera::Camera;
use crate::control::Command;

impl Viewer {
    /// Requests that the camera is copied to the clipboard, as a line of a scene file.
    pub(super) fn copy_camera(&mut self) {
        if let Some(camera) = self.eye.camera() {
            self.requests.push_back(Request::Copy(format!("{},", camera.to_ron())));
            self.show_note("camera copied, if the terminal allows it; it is also printed on exit");
        }
    }

    /// Opens the question in which format to export the picture, if there are a picture and a
    /// folder for exports.
    pub(super) fn ask_export(&mut self) {
        if self.options.exports.is_some() && self.screen.frame().is_some() {
            self.screen.open(Dialog::Export);
        }
    }

    /// Opens the question whether to write the proposed camera into the scene file of this name.
    pub(crate) fn ask_to_save_view(&mut self, file: String) {
        self.screen.open(Dialog::SaveToFile(file));
    }

    /// Asks whether to write a new scene file of this name.
    pub(crate) fn ask_to_write_scene(&mut self, file: String) {
        self.screen.open(Dialog::NewScene(file));
    }

    /// Returns the text of a scene with the shown mesh, whose file is `name`, as it is lit now and
    /// seen by `camera`. `None` for a scene of its own.
    pub(crate) fn scene_around_mesh(&self, name: &str, camera: &Camera) -> Option<String> {
        self.scene()?.around_mesh_to_ron(name, camera)
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
