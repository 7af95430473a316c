//! The questions that every family is asked.

#[test]
fn conformance() {
    forcewright_contract::conformance::suite::<forcewright_compliant::Compliant>(include_str!(
        "../../../../examples/compliant/lan-table3.toml"
    ));
}
