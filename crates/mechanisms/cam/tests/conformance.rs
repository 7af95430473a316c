//! The questions that every family is asked.

#[test]
fn conformance() {
    forcewright_contract::conformance::suite::<forcewright_cam::Cam>(include_str!("../../../../examples/cam/no-undercut.toml"));
}

#[test]
fn conformance_of_torque_cams() {
    forcewright_contract::conformance::suite::<forcewright_cam::Cam>(include_str!("../../../../examples/cam/torque-cam.toml"));
}
