//! The other viewers of a server: their list, and marks at their cameras.
//!
//! Both show what the driver passed last. It passes new values only before a frame that is drawn anyway, so that a
//! viewer's screen does not change because others move.

mod list;
mod marks;

use super::theme;
use super::{Request, Viewer};
use crate::camera::Camera;
use list::ViewerList;
use marks::OtherEyes;
use std::sync::Arc;

/// The scene or the guide that another viewer of the server looks at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LooksAt {
    /// The scene of this name, by a camera of the viewer's own.
    Scene(Arc<str>),
    /// The tour.
    Tour,
    /// The view of the viewer with this number.
    Viewer(u64),
}

/// Another viewer of the server.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OtherViewer {
    /// The viewer's number.
    pub(crate) number: u64,
    /// The viewer's login name, if the server shows names.
    pub(crate) name: Option<Arc<str>>,
    pub(crate) looks_at: LooksAt,
    /// The viewer's own camera, if it is in the scene of this one.
    pub(crate) camera: Option<Camera>,
}

impl OtherViewer {
    /// Returns the viewer's number, and the name if the server shows names.
    fn label(&self) -> String {
        label(self.number, self.name.as_deref())
    }
}

/// Returns the words for a viewer: the number, and the name if there is one.
pub(crate) fn label(number: u64, name: Option<&str>) -> String {
    name.map_or_else(|| format!("viewer {number}"), |name| format!("viewer {number} ({name})"))
}

/// The viewers of a server, as one of them sees them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OtherViewers {
    /// The number of the viewer whose screen this is, and the name.
    pub(crate) own: (u64, Option<Arc<str>>),
    /// The number of viewers who see what this one leads.
    pub(crate) followers: usize,
    /// The others, by their numbers.
    pub(crate) others: Vec<OtherViewer>,
}

impl OtherViewers {
    /// Returns the line with the number of viewers: `7 watching`.
    fn count_line(&self) -> String {
        let follow = if self.followers > 0 { format!(", {} with you", self.followers) } else { String::new() };
        format!("{} watching{follow}", self.others.len() + 1)
    }
}

impl Viewer {
    /// Opens the list of viewers, turns its page, or closes it after the last page.
    pub(crate) fn turn_viewer_list(&mut self, viewers: OtherViewers) {
        let screen = theme::area(self.picture_size());
        if !theme::has_room(screen) {
            return self.show_note(theme::needs_room("the list of viewers"));
        }
        match self.screen.close::<ViewerList>() {
            None => self.screen.open(ViewerList::new(viewers)),
            Some(open) => {
                if let Some(next) = open.next_page(screen) {
                    self.screen.open(next);
                }
            }
        }
    }

    /// Closes the list of viewers. Returns whether it was open.
    pub(crate) fn close_viewer_list(&mut self) -> bool {
        self.screen.close::<ViewerList>().is_some()
    }

    /// Shows the number of viewers and marks at the others' cameras, or hides them.
    pub(crate) fn toggle_other_eyes(&mut self, viewers: OtherViewers) {
        if self.screen.close::<OtherEyes>().is_none() {
            self.screen.open(OtherEyes::new(viewers));
        }
    }

    /// Returns whether the screen shows anything of the other viewers.
    pub(crate) fn shows_others(&self) -> bool {
        self.screen.get::<ViewerList>().is_some() || self.screen.get::<OtherEyes>().is_some()
    }

    /// Replaces what the next frame shows of the other viewers. This alone draws no frame.
    pub(crate) fn set_others(&mut self, viewers: &OtherViewers) {
        self.screen.change_quietly(|list: &mut ViewerList| list.set_viewers(viewers.clone()));
        self.screen.change_quietly(|eyes: &mut OtherEyes| eyes.set_viewers(viewers.clone()));
    }

    /// Requests to follow the viewer with this digit in the list, if the list is open. Returns
    /// whether it is.
    pub(super) fn follow_listed(&mut self, digit: u8) -> bool {
        // The key that opens the list may have come with the digit, before the driver has opened the list.
        let is_about_to_open = matches!(self.requests.back(), Some(Request::ListViewers));
        let is_open = is_about_to_open || self.screen.get::<ViewerList>().is_some();
        if is_open {
            self.requests.push_back(Request::Follow(digit));
        }
        is_open
    }

    /// Returns the number of the viewer with this digit in the list.
    pub(crate) fn listed_viewer(&self, digit: u8) -> Option<u64> {
        self.screen.get::<ViewerList>()?.number_of(digit, theme::area(self.picture_size()))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
