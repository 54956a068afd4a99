//! The viewers of the server as they see one another: what each looks at, and who follows whom.
//!
//! Pure but for its lock. A viewer's turn writes its own entry; the frames of those who follow it read it.

use super::guide::{Guide, GuideView};
use super::lock::locked;
use super::run_queue::SessionId;
use super::tour::Tour;
use crate::viewer::{LooksAt, OtherViewer, OtherViewers, label};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// The longest chain of viewers who follow one another.
// Two viewers who choose each other at the same time would follow each other for ever.
const MAX_CHAIN: usize = 16;

/// The longest login name that is shown, in characters.
const MAX_NAME: usize = 16;

#[derive(Debug)]
struct Entry {
    name: Option<Arc<str>>,
    /// The last view of the viewer's own camera.
    view: GuideView,
    follows: Option<Guide>,
    /// Whether the viewer is there. The entry of one who has left lasts until its followers know.
    is_present: bool,
}

#[derive(Debug, Default)]
struct Entries {
    viewers: BTreeMap<SessionId, Entry>,
    leader: Option<SessionId>,
    /// The last view of the leader before, if the tour has no leader now.
    left_by_leader: Option<GuideView>,
}

/// The viewers of the server.
#[derive(Debug, Default)]
pub(super) struct Roster(Mutex<Entries>);

impl Entries {
    /// Returns the viewer whose own camera a guide shows; `None` if it is the tour's path.
    fn source(&self, guide: Guide) -> Option<SessionId> {
        let mut guide = guide;
        let mut id = None;
        for _ in 0..MAX_CHAIN {
            let next = match guide {
                Guide::Tour => self.leader?,
                Guide::Viewer(id) => id,
            };
            id = Some(next);
            match self.viewers.get(&next).and_then(|entry| entry.follows) {
                Some(follows) => guide = follows,
                None => break,
            }
        }
        id
    }

    /// Returns the viewers who have chosen a guide.
    fn followers(&self, guide: Guide) -> impl Iterator<Item = SessionId> {
        self.viewers.iter().filter(move |(_, entry)| entry.follows == Some(guide)).map(|(&id, _)| id)
    }

    /// Drops the entry of a viewer who has left and has no follower any more.
    fn drop_if_unused(&mut self, id: SessionId) {
        let has_left = self.viewers.get(&id).is_some_and(|entry| !entry.is_present);
        if has_left && self.followers(Guide::Viewer(id)).next().is_none() {
            self.viewers.remove(&id);
        }
    }

    /// Ends the lead of the tour, and keeps its last view.
    fn end_lead(&mut self) {
        let shown = self.source(Guide::Tour).and_then(|id| self.viewers.get(&id));
        self.left_by_leader = shown.map(|entry| entry.view.clone());
        self.leader = None;
    }

    fn label(&self, id: SessionId) -> String {
        label(id, self.viewers.get(&id).and_then(|entry| entry.name.as_deref()))
    }
}

impl Roster {
    /// Adds a viewer.
    pub(super) fn enter(&self, id: SessionId, name: Option<Arc<str>>, view: GuideView) {
        locked(&self.0).viewers.insert(id, Entry { name, view, follows: None, is_present: true });
    }

    /// Sets the view of a viewer's own camera.
    pub(super) fn set_view(&self, id: SessionId, view: GuideView) {
        if let Some(entry) = locked(&self.0).viewers.get_mut(&id).filter(|entry| entry.is_present) {
            entry.view = view;
        }
    }

    /// Removes a viewer, and returns the viewers who have to be told: those who follow them.
    pub(super) fn leave(&self, id: SessionId) -> Vec<SessionId> {
        let mut entries = locked(&self.0);
        let mut told: Vec<_> = entries.followers(Guide::Viewer(id)).collect();
        if entries.leader == Some(id) {
            told.extend(entries.followers(Guide::Tour));
            entries.end_lead();
        }
        let Some(entry) = entries.viewers.get_mut(&id) else { return told };
        entry.is_present = false;
        let followed = entry.follows.take();
        entries.drop_if_unused(id);
        if let Some(Guide::Viewer(followed)) = followed {
            entries.drop_if_unused(followed);
        }
        told
    }

    /// Lets a viewer follow a guide, or none.
    ///
    /// # Errors
    /// The reason for the viewer: the other one is not there, or follows this one.
    pub(super) fn follow(&self, id: SessionId, guide: Option<Guide>) -> Result<(), String> {
        let mut entries = locked(&self.0);
        if let Some(Guide::Viewer(other)) = guide {
            if other == id {
                return Err("this is you".to_owned());
            }
            if !entries.viewers.get(&other).is_some_and(|entry| entry.is_present) {
                return Err(format!("viewer {other} has left"));
            }
        }
        if guide.is_some_and(|guide| entries.source(guide) == Some(id)) {
            return Err("the view you chose is your own".to_owned());
        }
        let Some(entry) = entries.viewers.get_mut(&id) else { return Ok(()) };
        if let Some(Guide::Viewer(before)) = std::mem::replace(&mut entry.follows, guide) {
            entries.drop_if_unused(before);
        }
        Ok(())
    }

    /// Returns the view of a guide at `now`, of a server with this path of a tour; `None` if it has
    /// none any more.
    pub(super) fn view(&self, guide: Guide, tour: Option<&Tour>, now: Duration) -> Option<GuideView> {
        let entries = locked(&self.0);
        // The entry of a viewer who has left lasts for the last view only.
        if let Guide::Viewer(id) = guide
            && !entries.viewers.get(&id).is_some_and(|entry| entry.is_present)
        {
            return None;
        }
        match entries.source(guide) {
            None => tour.map(|tour| tour.view(Tour::tick_at(now))),
            Some(id) => entries.viewers.get(&id).map(|entry| entry.view.clone()),
        }
    }

    /// Returns the last view of a guide that shows nothing any more.
    pub(super) fn last_view(&self, guide: Guide) -> Option<GuideView> {
        let entries = locked(&self.0);
        match guide {
            Guide::Tour => entries.left_by_leader.clone(),
            Guide::Viewer(id) => entries.viewers.get(&id).map(|entry| entry.view.clone()),
        }
    }

    /// Makes a viewer the leader of the tour. Returns the leader before, who has to be told.
    pub(super) fn lead(&self, id: SessionId) -> Option<SessionId> {
        let mut entries = locked(&self.0);
        entries.left_by_leader = None;
        entries.leader.replace(id).filter(|&before| before != id)
    }

    /// Ends the lead of a viewer. Returns the viewers who have to be told.
    pub(super) fn stop_leading(&self, id: SessionId) -> Vec<SessionId> {
        let mut entries = locked(&self.0);
        if entries.leader != Some(id) {
            return Vec::new();
        }
        entries.end_lead();
        entries.followers(Guide::Tour).collect()
    }

    /// Returns the leader of the tour, if there is one.
    pub(super) fn leader(&self) -> Option<SessionId> {
        locked(&self.0).leader
    }

    /// Returns the words for a guide in the line of its followers.
    pub(super) fn title(&self, guide: Guide) -> String {
        let entries = locked(&self.0);
        match (guide, entries.leader) {
            (Guide::Tour, None) => "tour".to_owned(),
            (Guide::Tour, Some(id)) => format!("tour led by {}", entries.label(id)),
            (Guide::Viewer(id), _) => format!("with {}", entries.label(id)),
        }
    }

    /// Returns the viewers as one of them sees them.
    pub(super) fn seen_by(&self, id: SessionId) -> OtherViewers {
        let entries = locked(&self.0);
        let Some(own) = entries.viewers.get(&id) else { return OtherViewers::default() };
        let present = || entries.viewers.iter().filter(|(_, entry)| entry.is_present);
        let others = present().filter(|(other, _)| **other != id).map(|(&number, entry)| OtherViewer {
            number,
            name: entry.name.clone(),
            looks_at: match entry.follows {
                None => LooksAt::Scene(Arc::clone(&entry.view.name)),
                Some(Guide::Tour) => LooksAt::Tour,
                Some(Guide::Viewer(guide)) => LooksAt::Viewer(guide),
            },
            camera: (entry.follows.is_none() && entry.view.name == own.view.name).then_some(entry.view.camera),
        });
        let leads = entries.leader == Some(id);
        let is_with_own =
            |entry: &Entry| entry.follows == Some(Guide::Viewer(id)) || leads && entry.follows == Some(Guide::Tour);
        OtherViewers {
            own: (id, own.name.clone()),
            followers: present().filter(|(_, entry)| is_with_own(entry)).count(),
            others: others.collect(),
        }
    }
}

/// Returns the letters, digits, `-`, `_` and `.` of a login name, at most [`MAX_NAME`]; `None` if
/// there are none.
pub(super) fn shown_name(login: &str) -> Option<Arc<str>> {
    let is_plain = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let name: String = login.chars().filter(is_plain).take(MAX_NAME).collect();
    (!name.is_empty()).then(|| name.into())
}

#[cfg(all(test, unit_tests))]
mod tests;
