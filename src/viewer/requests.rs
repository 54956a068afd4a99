//! Requests that leave the view.
//!
//! These are the camera as text, the picture as a file, and a view for the scene's file. The driver writes them.

use super::dialog::{Answer, Dialog};
use super::{Request, Viewer};
use crate::control::Command;

impl Viewer {
    /// Requests to copy the camera as a line of a scene file.
    pub(super) fn copy_camera(&mut self) {
        if let Some(camera) = self.eye.camera() {
            self.requests.push_back(Request::Copy(format!("{},", camera.to_ron())));
            self.show_note("camera copied, if the terminal allows it; it is also printed on exit");
        }
    }

    /// Asks for the format of an export, if there is a folder for it.
    pub(super) fn ask_export(&mut self) {
        if self.options.exports.is_some() && self.screen.frame().is_some() {
            self.screen.open(Dialog::Export);
        }
    }

    /// Asks whether to write the proposed camera into the scene file of this name.
    pub(crate) fn ask_to_save_view(&mut self, file: String) {
        self.screen.open(Dialog::SaveToFile(file));
    }

    /// Treats `command` as the answer to an open question. Returns whether there was one.
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
