//! The corpora of the fuzzers of scenes, formulas, camera paths and files of keys.

use crate::{corpus, text_laws};

#[test]
fn the_laws_of_texts_hold_for_the_corpora() {
    corpus::replay("scene", text_laws::scene);
    corpus::replay("formula", text_laws::formula);
    corpus::replay("roots", text_laws::roots);
    corpus::replay("camera_path", text_laws::camera_path);
    corpus::replay("keys", text_laws::keys);
}
