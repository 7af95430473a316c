//! The paper's numbers: every row of `reference/sanchez2022.toml` is computed, and none misses what it explains.

use forcewright_cam::Cam;
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::reproduction::{Evidence, Finding};

#[test]
fn every_printed_number() {
    let paper = Cam::reproductions().iter().find(|r| r.key == "sanchez2022").expect("the paper");
    let rows = (paper.run)(&mut |_| true);
    let wrong: Vec<_> = rows.iter().filter(|r| !r.ours.is_finite() || r.finding() == Finding::Fails).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // Of what follows from the paper's own theory one number departs, which contradicts its eq. (1). Of the bench: the smallest forces, the
    // loops, which contradict one another, the down stroke with six springs, and the noise at five speeds.
    let departing = |evidence: Evidence| {
        let all = rows.iter().filter(|r| r.finding() == Finding::Departs && r.evidence == evidence);
        all.map(|r| r.quantity.as_str()).collect::<Vec<_>>()
    };
    assert_eq!(departing(Evidence::Computed), ["loop area over 40 … 210 mm, μ = 0.004"]);
    assert_eq!(departing(Evidence::Measured).len(), 15);
    let counted = |finding: Finding| rows.iter().filter(|r| r.finding() == finding).count();
    assert_eq!([Finding::Reproduced, Finding::Compatible, Finding::Met, Finding::Misprint].map(counted), [16, 17, 4, 1]);
}
