//! The questions that every family is asked.

#[test]
fn conformance() {
    forcewright_contract::conformance::suite::<forcewright_capstan::Capstan>(include_str!("../../../../examples/capstan/longval.toml"));
}

#[test]
fn conformance_with_several_cables() {
    forcewright_contract::conformance::suite::<forcewright_capstan::Capstan>(include_str!(
        "../../../../examples/capstan/quadruped-leg.toml"
    ));
}
