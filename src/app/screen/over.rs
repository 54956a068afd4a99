//! What lies over the picture, from the lowest to the topmost.

use super::{Screen, area};
use crate::app::explain;
use crate::app::help::{self, Help};
use crate::app::legend;
use crate::app::mark;
use crate::app::panels::{self, Look};
use crate::app::renderer::Frame;
use crate::control::{self, Command};
use crate::grid::Grid;
use crate::overlay;
use crate::pace::Limit;
use glam::Vec3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

impl Screen {
    pub(super) fn lay_panels_over(&mut self, grid: &mut Grid, limit: Option<Limit>) {
        let screen = area(grid.size());
        let mode = self.painter.mode();
        let look = Look::of(mode);
        let held = self.light.zip(self.frame.as_ref());
        if let Some(place) = held.and_then(|(light, frame)| marked(light, frame, screen)) {
            lay(grid, place, |area, buffer| mark::draw(look, area, buffer));
        }
        // What the status line takes at the foot besides the lowest row.
        let more_status = self.status_rows(screen).saturating_sub(1);
        let scroll = help::keys(&self.bindings, &self.modes(grid.size()), &[Command::ScrollUp, Command::ScrollDown]);
        let scroll = scroll.unwrap_or_default();
        if let Some(explaining) = self.explaining.as_mut().filter(|_| panels::has_room(screen)) {
            let above = Rect { height: screen.height - more_status, ..screen };
            let panel = explain::panel_area(above, explaining.cell(mode));
            lay(grid, panel, |panel, buffer| explaining.draw(&scroll, look, mode, panel, buffer));
            for mark in explain::marks(explaining, look, mode, screen) {
                overlay::lay_over(grid, &mark);
            }
        }
        if let Some(progress) = &self.progress {
            lay(grid, panels::progress_area(screen), |area, buffer| {
                panels::draw_progress(progress, look, area, buffer);
            });
        }
        self.lay_status(grid, look, limit);
        if panels::has_room(screen) {
            self.lay_lines(grid, look);
        }
        self.lay_topmost(grid, look);
    }

    /// How many rows at the foot the status line takes: below its figures stand the keys, where there is room for panels.
    fn status_rows(&self, screen: Rect) -> u16 {
        u16::from(self.status) * (1 + u16::from(panels::has_room(screen)))
    }

    fn lay_status(&self, grid: &mut Grid, look: Look, limit: Option<Limit>) {
        let Some(frame) = self.frame.as_ref().filter(|_| self.status) else { return };
        let status = panels::Status {
            cells: grid.size(),
            sampling: frame.sampling,
            trace: frame.trace,
            encode: self.encode,
            shown: self.pace.frames_per_second,
            rays: frame.cost.rays,
            slow: limit.and_then(|limit| limit.rate),
            eye: frame.camera.pose().eye,
        };
        let screen = area(grid.size());
        if self.status_rows(screen) > 1 {
            let keys = help::line(&self.bindings, &self.modes(grid.size()), screen.width.into());
            lay(grid, panels::foot(screen, 1), |area, buffer| panels::draw_line(&keys, look, area, buffer));
        }
        lay(grid, panels::foot(screen, 0), |area, buffer| status.draw(look, area, buffer));
    }

    /// What is told of the picture, of its file, and of what was just done.
    fn lay_lines(&self, grid: &mut Grid, look: Look) {
        let screen = area(grid.size());
        let legends = self.frame.as_ref().map_or(&[][..], |frame| &frame.legends);
        let status = self.status_rows(screen);
        for (text, area) in legend::shared(legends, panels::foot(screen, status)) {
            lay(grid, area, |area, buffer| legend::draw(text, look, area, buffer));
        }
        if let Some(fault) = &self.fault {
            let area = fault.area(screen, status + u16::from(!legends.is_empty()));
            lay(grid, area, |area, buffer| fault.draw(look, area, buffer));
        }
        if let Some(note) = &self.note {
            lay(grid, panels::foot(screen, 0), |area, buffer| legend::draw(note, look, area, buffer));
        }
    }

    /// What the user has asked, or is asked; where there is no room for it, in a line.
    fn lay_topmost(&self, grid: &mut Grid, look: Look) {
        let screen = area(grid.size());
        let has_room = panels::has_room(screen);
        let in_a_line = |grid: &mut Grid, text: &str| {
            lay(grid, panels::foot(screen, 0), |area, buffer| panels::draw_line(text, look, area, buffer));
        };
        let bindings = &self.bindings;
        match &self.question {
            Some(question) if has_room => {
                lay(grid, question.area(bindings, screen), |area, buffer| question.draw(bindings, look, area, buffer));
            }
            Some(question) => in_a_line(grid, &question.line(bindings)),
            None => {}
        }
        match self.help {
            Some(page) if has_room => {
                let help = Help::new(bindings, &self.modes(grid.size()), screen);
                lay(grid, help.area(page, screen), |area, buffer| help.draw(page, look, area, buffer));
            }
            Some(_) => in_a_line(grid, &help::no_room()),
            None => {}
        }
    }
}

fn lay(grid: &mut Grid, area: Rect, draw: impl FnOnce(Rect, &mut Buffer)) {
    let mut buffer = Buffer::empty(area);
    draw(area, &mut buffer);
    overlay::lay_over(grid, &buffer);
}

/// Where the mark of a light is over a frame: in the left one of two pictures.
fn marked(light: Vec3, frame: &Frame, screen: Rect) -> Option<Rect> {
    let (part, _) = frame.part_at([0, 0]);
    let place = control::place_of(&frame.camera, light, part.aspect_ratio())?;
    let columns = f32::from(screen.width) * part.width as f32 / frame.resolution.width as f32;
    Some(mark::area(screen, place.x * columns, place.y * f32::from(screen.height)))
}
