use super::*;
use crate::grid::Size;
use crate::viewer::theme;

fn screen(columns: u16, rows: u16) -> Rect {
    theme::area(Size::new(columns, rows))
}

fn caption(text: &str) -> Caption {
    Caption::new(text.into(), None, [(Command::Outside, "from outside"), (Command::Orders, "both orders")])
}

/// A page and its row of keys take at most an eighth of the screen's rows, or three, and no line
/// reaches the right edge.
#[test]
fn pages_leave_the_picture_free() {
    let text = ["A title", &"word ".repeat(60), &"word ".repeat(30), "Keys: W."].join("\n");
    for (columns, rows) in [(80, 24), (200, 60), (40, 12), (300, 100)] {
        let screen = screen(columns, rows);
        let pages = caption(&text).pages(screen);
        let words: usize = pages.iter().flatten().map(|line| line.matches("word").count()).sum();
        assert_eq!(words, 90, "{columns}x{rows}");
        for page in &pages {
            assert!((page.len() as u16) < (rows / 8).max(3), "{columns}x{rows}: {page:?}");
            assert!(page.iter().all(|line| line.trim_end().width() as u16 + 2 <= columns.min(MAX_COLUMNS)), "{page:?}");
        }
    }
}

#[test]
fn pages_break_between_paragraphs() {
    let text = format!("A title\n{}\nKeys: W and S.", "word ".repeat(14));
    let pages = caption(&text).pages(screen(40, 12));
    assert_eq!(pages.iter().map(Vec::len).collect::<Vec<_>>(), [1, 2, 1], "{pages:?}");
    assert_eq!(pages[2], ["Keys: W and S."]);
    assert_eq!(caption(&text).pages(screen(80, 24)).len(), 2);
    assert_eq!(caption(&text).pages(screen(200, 60)).len(), 1);
}

#[test]
fn the_page_after_the_last_one_hides_the_caption() {
    let screen = screen(80, 24);
    let text = format!("A title\n{}\nKeys: W and S.", "word ".repeat(14));
    let second = caption(&text).next(screen).expect("a second page");
    assert_eq!(second.page, 1);
    assert!(second.next(screen).is_none());
}
