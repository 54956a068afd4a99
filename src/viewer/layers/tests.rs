use super::*;
use crate::grid::Size;

/// A layer of the given level that draws `LETTER`; `L` has the mode of lights, and `?` takes all
/// keys.
struct Letter<const LETTER: char>(LayerLevel);

impl<const LETTER: char> Layer for Letter<LETTER> {
    fn level(&self) -> LayerLevel {
        self.0
    }

    fn mode(&self, _: Rect) -> Option<KeyMode> {
        (LETTER == 'L').then_some(KeyMode::Light)
    }

    fn takes_all_keys(&self) -> bool {
        LETTER == '?'
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        canvas.write_line(&LETTER.to_string(), canvas.row_from_bottom(0));
    }
}

fn topmost(layers: &mut Layers) -> String {
    let mut grid = Grid::new(Size::new(1, 1));
    let (keymap, figures) = (Keymap::default(), FrameStatistics::default());
    let mode = CellMode::HALF_BLOCK;
    layers.draw(&mut Canvas {
        grid: &mut grid,
        cell_mode: mode,
        keymap: &keymap,
        modes: &[],
        frame: None,
        name: "",
        wipe: 0.5,
        figures,
        status_rows: 0,
        note_rows: 1,
    });
    crate::export::text(&grid).trim().to_owned()
}

#[test]
fn layers_are_drawn_by_their_level_whenever_they_were_opened() {
    let mut layers = Layers::default();
    layers.open(Letter::<'h'>(LayerLevel::Help));
    layers.open(Letter::<'m'>(LayerLevel::Mark));
    assert_eq!(topmost(&mut layers), "h");
    assert!(layers.close::<Letter<'h'>>().is_some() && layers.close::<Letter<'h'>>().is_none());
    assert_eq!(topmost(&mut layers), "m");
    assert!(layers.get::<Letter<'m'>>().is_some() && layers.get::<Letter<'h'>>().is_none());
}

#[test]
fn a_question_takes_all_keys_and_others_lie_over_movement() {
    let (screen, mut layers) = (Rect::new(0, 0, 80, 24), Layers::default());
    layers.open(Letter::<'L'>(LayerLevel::Mark));
    assert_eq!(layers.active_modes(screen, KeyMode::Fly), [KeyMode::Light, KeyMode::Fly, KeyMode::Always]);
    layers.open(Letter::<'?'>(LayerLevel::Question));
    assert_eq!(layers.active_modes(screen, KeyMode::Fly), [KeyMode::Always]);
}
