//! The corpus of the input's fuzzer.

mod corpus;
mod input_laws;

#[test]
fn the_laws_of_input_hold_for_the_corpus() {
    corpus::replay("input", input_laws::hold_for);
}
