//! What leaves the live view: the camera as text, the picture as a file, a view into the scene's file.

use super::Live;
use crate::app::dialog::{Answer, Dialog};
use crate::app::exporting::{contents, stem, write_new};
use crate::app::keeping::Asked;
use crate::control::Command;
use crate::export::Format;
use std::io;

impl Live {
    /// The camera, as a line for a scene file, is to be copied.
    pub(super) fn copy_camera(&mut self) {
        if let Some(camera) = self.eye.camera() {
            self.to_copy = Some(format!("{},", camera.to_ron()));
            self.screen.say("camera copied, where OSC 52 is allowed; on leaving it is printed, too");
        }
    }

    /// Asks what the picture is to be written as, where there is a folder for it.
    pub(super) fn ask_export(&mut self) {
        if self.options.exports.is_some() && self.screen.frame().is_some() {
            self.screen.ask(Dialog::Export);
        }
    }

    /// Asks whether the view is to be written into the scene's file, where it stands in one.
    pub(super) fn ask_keep(&mut self) {
        let file = self.looked_at.source().and_then(|source| source.file.as_deref());
        match file.zip(self.eye.camera()).and_then(|(file, camera)| Asked::new(file, camera)) {
            Some(asked) => self.screen.ask(Dialog::Keep(asked)),
            None => self.screen.say("this scene stands in no scene file"),
        }
    }

    /// Takes what a key means as the answer if something has been asked; whether it has.
    pub(super) fn take_answer(&mut self, meant: Option<Command>) -> bool {
        let Some(dialog) = self.screen.end_question() else { return false };
        match dialog.answer(meant) {
            Answer::Export(format) => {
                let said = match self.export(format) {
                    Ok(name) => format!("written: {name}"),
                    Err(error) => format!("it could not be written: {error}"),
                };
                self.screen.say(said);
            }
            Answer::Keep(asked) => {
                let said = match asked.write() {
                    Ok(()) => "written into the scene's views".to_owned(),
                    Err(error) => format!("the scene's file is as it was: {error}"),
                };
                self.screen.say(said);
            }
            Answer::Save(number) => self.save_view(number),
            Answer::Nothing => {}
        }
        true
    }

    /// Writes the picture that is there into a new file; its name.
    fn export(&self, format: Format) -> io::Result<String> {
        let nothing = || io::Error::other("there is nothing to write, or nowhere");
        let (frame, folder) = self.screen.frame().zip(self.options.exports.as_deref()).ok_or_else(nothing)?;
        let name = self.looked_at.source().map_or("scene", |source| source.name.as_str());
        write_new(folder, &stem(name), format, &contents(format, frame, &self.capabilities)?)
    }
}
