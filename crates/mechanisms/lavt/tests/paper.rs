//! Numbers of the paper, and of another program: every row of `reference/butin2023.toml` is computed.

use forcewright_contract::family::Mechanism as _;
use forcewright_contract::reproduction::Finding;
use forcewright_lavt::Lavt;

#[test]
fn every_number() {
    let paper = Lavt::reproductions().iter().find(|r| r.key == "butin2023").expect("the paper");
    let rows = (paper.run)(&mut |_| true);
    let wrong: Vec<_> = rows.iter().filter(|r| !r.ours.is_finite() || matches!(r.finding(), Finding::Fails | Finding::Departs)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let counted = |finding: Finding| rows.iter().filter(|r| r.finding() == finding).count();
    assert_eq!([Finding::Reproduced, Finding::Misprint, Finding::NotPrinted].map(counted), [137, 10, 3]);
    // The bench's friction in the corrected model: between what the paper asks for and what its clutch needs to shift.
    for row in rows.iter().filter(|r| r.finding() == Finding::NotPrinted) {
        assert!((0.13..0.17).contains(&row.ours), "{row:?}");
    }
}
