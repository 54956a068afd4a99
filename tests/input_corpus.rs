//! The corpora of the fuzzers of the input and of the viewer.

mod corpus;
mod input_laws;

#[test]
fn the_laws_of_input_hold_for_the_corpus() {
    corpus::replay("input", input_laws::hold_for);
}

#[test]
fn the_rules_of_a_viewer_hold_for_the_corpus() {
    corpus::replay("viewer", termtrace::internals::app::run_viewer_scenario);
}
