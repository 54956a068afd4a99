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
    /// The last view of the leader before, for followers of a tour without a leader and a path.
    left_by_leader: Option<GuideView>,
}

/// The viewers of the server.
#[derive(Debug, Default)]
pub(super) struct Roster(Mutex<Entries>);

impl Entries {
    fn guide_of(&self, id: SessionId) -> Option<Guide> {
        self.viewers.get(&id)?.follows
    }

    /// Returns the viewers through whose views a guide shows its own, the nearest one first.
    fn chain(&self, guide: Guide) -> impl Iterator<Item = SessionId> {
        let viewer = |guide| match guide {
            Guide::Tour => self.leader,
            Guide::Viewer(id) => Some(id),
        };
        // There are no rings, because `follow` refuses them. The limit ends the walk even if there were one.
        std::iter::successors(viewer(guide), move |&id| viewer(self.guide_of(id)?)).take(self.viewers.len() + 1)
    }

    /// Returns the viewer whose own camera a guide shows; `None` if it is the tour's path.
    fn source(&self, guide: Guide) -> Option<SessionId> {
        self.chain(guide).last().filter(|&id| self.guide_of(id).is_none())
    }

    /// Returns whether a guide is there: the entry of a viewer who has left lasts for the last view
    /// only.
    fn is_present(&self, guide: Guide) -> bool {
        match guide {
            Guide::Tour => true,
            Guide::Viewer(id) => self.viewers.get(&id).is_some_and(|entry| entry.is_present),
        }
    }

    /// Sets the guide of a viewer, and drops what was kept for the followers of the guide before.
    fn set_guide(&mut self, id: SessionId, guide: Option<Guide>) {
        let Some(entry) = self.viewers.get_mut(&id) else { return };
        match std::mem::replace(&mut entry.follows, guide) {
            Some(Guide::Viewer(before)) => self.drop_if_unused(before),
            Some(Guide::Tour) if self.followers(Guide::Tour).next().is_none() => self.left_by_leader = None,
            Some(Guide::Tour) | None => {}
        }
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

    /// Ends the lead of the tour, and keeps its last view for its followers if no path goes on.
    fn end_lead(&mut self, has_path: bool) {
        let needs_view = !has_path && self.followers(Guide::Tour).next().is_some();
        let shown = self.source(Guide::Tour).filter(|_| needs_view).and_then(|id| self.viewers.get(&id));
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
        let mut entries = locked(&self.0);
        let Some(entry) = entries.viewers.get_mut(&id).filter(|entry| entry.is_present) else { return };
        let before = std::mem::replace(&mut entry.view, view);
        // This may free the last copy of a scene, which takes too long under a lock that all viewers need.
        drop(entries);
        drop(before);
    }

    /// Removes a viewer of a server that has a path of a tour, or none.
    ///
    /// Returns the viewers who have to be told: those who follow this one.
    pub(super) fn leave(&self, id: SessionId, has_path: bool) -> Vec<SessionId> {
        let mut entries = locked(&self.0);
        let mut told: Vec<_> = entries.followers(Guide::Viewer(id)).collect();
        if entries.leader == Some(id) {
            told.extend(entries.followers(Guide::Tour));
            entries.end_lead(has_path);
        }
        let Some(entry) = entries.viewers.get_mut(&id) else { return told };
        entry.is_present = false;
        entries.set_guide(id, None);
        entries.drop_if_unused(id);
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
            if !entries.is_present(Guide::Viewer(other)) {
                return Err(format!("viewer {other} has left"));
            }
        }
        if guide.is_some_and(|guide| entries.chain(guide).any(|through| through == id)) {
            return Err("the view you chose is your own".to_owned());
        }
        entries.set_guide(id, guide);
        Ok(())
    }

    /// Returns whether a viewer is there.
    pub(super) fn has(&self, id: SessionId) -> bool {
        locked(&self.0).is_present(Guide::Viewer(id))
    }

    /// Returns whether a guide shows a view, of a server that has a path of a tour, or none.
    pub(super) fn shows(&self, guide: Guide, has_path: bool) -> bool {
        let entries = locked(&self.0);
        entries.is_present(guide) && (has_path || entries.source(guide).is_some())
    }

    /// Returns the view of a guide at `now`, of a server with this path of a tour.
    ///
    /// `None` if the guide shows nothing any more.
    pub(super) fn view(&self, guide: Guide, tour: Option<&Tour>, now: Duration) -> Option<GuideView> {
        let entries = locked(&self.0);
        if !entries.is_present(guide) {
            return None;
        }
        if let Some(id) = entries.source(guide) {
            return entries.viewers.get(&id).map(|entry| entry.view.clone());
        }
        // A view of the path is a new copy of the scene, which takes too long under a lock that all viewers need.
        drop(entries);
        tour.map(|tour| tour.view(Tour::tick_at(now)))
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
        // A leader who followed one of the followers of the tour would close a ring.
        entries.set_guide(id, None);
        entries.leader.replace(id).filter(|&before| before != id)
    }

    /// Ends the lead of a viewer, of a server that has a path of a tour, or none.
    ///
    /// Returns the viewers who have to be told.
    pub(super) fn stop_leading(&self, id: SessionId, has_path: bool) -> Vec<SessionId> {
        let mut entries = locked(&self.0);
        if entries.leader != Some(id) {
            return Vec::new();
        }
        entries.end_lead(has_path);
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
