//! A session's relations to the other viewers: following a guide, leading the tour, being seen.

use super::{AudienceChange, ViewerSession};
use crate::serve::guide::{Guide, GuideView};
use crate::serve::roster::Roster;
use crate::serve::run_queue::SessionId;
use crate::serve::tour::AudienceClass;
use crate::viewer::OtherViewers;
use std::sync::Arc;
use std::time::Duration;

/// The shortest time between two audiences of a viewer, such as those of two sizes of the window.
// Each new audience costs a picture and a key frame.
const SHORTEST_STAY: Duration = Duration::from_millis(100);

/// The viewers of the server, and the number of this one among them.
pub(in crate::serve) struct Company<'a> {
    pub(in crate::serve) roster: &'a Roster,
    pub(in crate::serve) id: SessionId,
}

/// The guide whose view a viewer follows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Following {
    pub(super) guide: Guide,
    /// The time since which the viewer follows. A later key ends it.
    pub(super) since: Duration,
}

/// Returns the note for a viewer who has left a guide by a key.
pub(super) fn left_text(guide: Guide) -> String {
    match guide {
        Guide::Tour => "you have left the tour; T goes back to it".to_owned(),
        Guide::Viewer(id) => format!("you no longer follow viewer {id}; u lists the viewers"),
    }
}

/// Returns the note for a viewer whose guide shows nothing any more.
pub(super) fn over_text(guide: Guide, roster: &Roster) -> String {
    match guide {
        Guide::Tour => "the tour has ended".to_owned(),
        Guide::Viewer(id) if roster.has(id) => format!("viewer {id} shows nothing any more"),
        Guide::Viewer(id) => format!("viewer {id} has left"),
    }
}

impl ViewerSession {
    /// Adds the viewer to those of the server.
    pub(in crate::serve) fn enter(&mut self, company: &Company<'_>, name: Option<Arc<str>>) {
        let Some(view) = self.own_view() else { return };
        company.roster.enter(company.id, name, view);
        if let Some(Following { guide, .. }) = self.following
            && company.roster.follow(company.id, Some(guide)).is_err()
        {
            self.following = None;
        }
    }

    /// Moves the own camera to a guide's view, in the same scene.
    pub(super) fn stand_at(&mut self, view: &GuideView, now: Duration) {
        if *self.scenes[self.shown].name != *view.name {
            // After a reload, another viewer may still show a scene that is gone.
            let Some(index) = self.scenes.iter().position(|scene| *scene.name == *view.name) else { return };
            self.show(index);
        }
        self.viewer.set_camera(view.camera, now);
    }

    /// Shows the audience's frames of a guide from now on.
    pub(super) fn follow(&mut self, company: &Company<'_>, guide: Guide, now: Duration) {
        match company.roster.follow(company.id, Some(guide)) {
            Ok(()) => {
                self.viewer.close_viewer_list();
                self.following = Some(Following { guide, since: now });
            }
            Err(note) => self.viewer.show_note(note),
        }
    }

    /// Shows the view of this viewer's own camera again.
    pub(super) fn leave_guide(&mut self, company: &Company<'_>, note: &str, now: Duration) {
        // Without a guide there is no reason to refuse.
        let _ = company.roster.follow(company.id, None);
        (self.following, self.own_since) = (None, now);
        self.viewer.take_screen_back();
        self.viewer.show_note(note);
    }

    /// Returns the class of the viewer's audience; `None` if they follow no guide.
    pub(super) fn audience_class(&self) -> Option<AudienceClass> {
        self.following.filter(|_| self.leaving.is_none()).map(|Following { guide, .. }| AudienceClass {
            guide,
            size: self.viewer.picture_size(),
            capabilities: self.viewer.capabilities().for_audience(),
        })
    }

    /// Returns what the viewer's screen shows from the end of the last turn on, if that has changed
    /// since the last call.
    ///
    /// A viewer who has just joined an audience joins another one after [`SHORTEST_STAY`] only.
    pub(in crate::serve) fn take_audience_change(&mut self) -> Option<AudienceChange> {
        let class = self.audience_class();
        if class == self.audience || class.is_some() && self.latest < self.joins_from {
            return None;
        }
        self.audience = class;
        Some(match class {
            Some(class) => {
                self.joins_from = self.latest + SHORTEST_STAY;
                AudienceChange::Follow(class)
            }
            None => AudienceChange::Leave,
        })
    }

    /// Begins or ends the lead of the tour.
    pub(super) fn toggle_lead(&mut self, company: &Company<'_>, has_path: bool, now: Duration) {
        self.leads = company.roster.leader() != Some(company.id);
        let note = if self.leads {
            self.told.extend(company.roster.lead(company.id));
            "you lead the tour; G ends that"
        } else {
            self.told.extend(company.roster.stop_leading(company.id, has_path));
            "you no longer lead the tour"
        };
        if self.following.is_some() {
            self.leave_guide(company, note, now);
        } else {
            self.viewer.show_note(note);
        }
    }

    /// Returns the view of this viewer's own camera.
    fn own_view(&self) -> Option<GuideView> {
        let (scene, camera, map) = self.viewer.guide_view()?;
        Some(GuideView { name: Arc::clone(&self.name), scene, camera, map })
    }

    /// Writes this viewer's own view into the roster.
    pub(super) fn show_to_others(&self, company: &Company<'_>) {
        // The own view of a follower does not move.
        if self.following.is_none()
            && let Some(view) = self.own_view()
        {
            company.roster.set_view(company.id, view);
        }
    }

    /// Returns the viewers of the server as this one sees them now.
    pub(super) fn others(&self, company: &Company<'_>) -> OtherViewers {
        self.show_to_others(company);
        company.roster.seen_by(company.id)
    }

    /// Returns the sessions that have to be told of what this one has done since the last call.
    pub(in crate::serve) fn take_told(&mut self) -> Vec<SessionId> {
        std::mem::take(&mut self.told)
    }
}
