//! What the loop does with the scenes that come, and where each was looked at from.

use super::Live;
use super::lighting::Lights;
use crate::app::eye::View;
use crate::app::loading::News;
use crate::app::renderer::Renderer;
use crate::app::scenes::Heard;
use crate::app::source::Named;
use crate::app::strip::Fault;
use crate::camera::Camera;
use crate::scene::Scene;
use std::collections::HashMap;
use std::fmt;
use std::panic::resume_unwind;
use std::sync::Arc;

/// Which scene is shown, and what is kept of the others.
pub(super) struct LookedAt {
    /// What all are called.
    named: Vec<Named>,
    /// Its number, and from where it wants to be looked at. `None` as long as there is nothing to see.
    now: Option<(usize, Camera)>,
    /// How others were looked at when they were left.
    left: HashMap<usize, View>,
}

impl LookedAt {
    /// Nothing yet, of these.
    pub(super) fn new(named: Vec<Named>) -> Self {
        Self { named, now: None, left: HashMap::new() }
    }

    /// What the one that is shown is called.
    pub(super) fn source(&self) -> Option<&Named> {
        self.named.get(self.now?.0)
    }
}

impl Live {
    /// What is there of a scene is shown. A sketch is better than the picture of another scene, but not than one that was
    /// good until its file changed. What is wrong is the error where there is nothing to see.
    pub(super) fn take_news<E: fmt::Display>(&mut self, heard: Heard<E>, renderer: &mut Renderer) -> Result<(), E> {
        let Heard { of, news, is_slow } = heard;
        match news {
            News::Progress(progress) if is_slow => self.screen.set_progress(progress),
            News::Sketch(scene) if self.looked_at.now.is_none_or(|(now, _)| now != of) => {
                self.screen.end_fault();
                self.show(scene, of, renderer);
            }
            News::Progress(_) | News::Sketch(_) | News::Needs(_) => {}
            News::Scene(scene) => {
                self.screen.end_progress();
                self.screen.end_fault();
                self.show(scene, of, renderer);
            }
            News::Fault(fault) if self.looked_at.now.is_none() => return Err(fault),
            News::Fault(fault) => {
                self.screen.end_progress();
                self.screen.set_fault(Fault::new(&fault.to_string()));
            }
            News::Panic(panic) => resume_unwind(panic),
        }
        Ok(())
    }

    /// From where it wants to be looked at; from where it was looked at, if it has wanted the same before.
    fn show(&mut self, scene: Scene, of: usize, renderer: &mut Renderer) {
        let home = scene.camera;
        let before = self.looked_at.now.replace((of, home));
        if before == Some((of, home)) {
            self.eye.set_written(&scene.views);
        } else {
            let orbits = self.looked_at.source().is_some_and(|source| source.orbited);
            let left = self.looked_at.left.remove(&of).filter(|left| left.home() == home);
            let left = self.eye.open(left.unwrap_or_else(|| View::of(&scene, orbits)));
            if let Some(((before, _), left)) = before.zip(left).filter(|((before, _), _)| *before != of) {
                self.looked_at.left.insert(before, left);
            }
            self.eye.set_written(&scene.views);
        }
        self.screen.set_moving(self.eye.mode());
        let scene = Arc::new(scene);
        let _ = self.leave_light();
        self.lights = Lights::of(&scene);
        renderer.show(scene);
        self.effort.forget_last();
        self.stale = true;
    }
}
