//! The questions that every family is asked.

#[test]
fn conformance() {
    forcewright_contract::conformance::suite::<forcewright_lavt::Lavt>(include_str!("../../../../examples/lavt/butin-2.toml"));
}
