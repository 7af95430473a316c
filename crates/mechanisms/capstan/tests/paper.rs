//! Numbers of the paper's equations, of another program and of its discrete cable: every row of `reference/longval.toml` is computed.

use forcewright_capstan::Capstan;
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::reproduction::Finding;

#[test]
fn every_number() {
    let paper = Capstan::reproductions().iter().find(|r| r.key == "longval").expect("the paper");
    let rows = (paper.run)(&mut |_| true);
    let wrong: Vec<_> = rows.iter().filter(|r| !r.ours.is_finite() || matches!(r.finding(), Finding::Fails | Finding::Departs)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let counted = |finding: Finding| rows.iter().filter(|r| r.finding() == finding).count();
    assert_eq!([Finding::Reproduced, Finding::Misprint].map(counted), [50, 15]);
    // What the paper's model gets wrong lies on one side: too soft a tangent, too little in the taut side, too low a gross slip.
    for row in rows.iter().filter(|r| r.finding() == Finding::Misprint && !r.place.starts_with("text")) {
        assert!(row.ours > row.paper.expect("printed"), "{row:?}");
    }
}
