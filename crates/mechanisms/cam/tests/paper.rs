//! The paper's numbers: every row of `reference/sanchez2022.toml` is computed, and none misses what it explains.

use forcewright_cam::Cam;
use forcewright_contract::family::Mechanism as _;

#[test]
fn every_printed_number() {
    let paper = Cam::reproductions().iter().find(|r| r.key == "sanchez2022").expect("the paper");
    let rows = (paper.run)(&mut |_| true);
    let wrong: Vec<_> = rows.iter().filter(|r| !r.ours.is_finite() || r.agrees() == Some(false)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // Departures without a reason: the down stroke with six springs, and the loop of μ = 0.004.
    let departures: Vec<_> = rows.iter().filter(|r| r.paper.is_some() && r.explained.is_none()).map(|r| r.quantity.as_str()).collect();
    let expected = [
        "mean force down, 6 springs",
        "standard deviation down, 6 springs",
        "smallest force down, 6 springs",
        "loop area over 40 … 210 mm, μ = 0.004",
    ];
    assert_eq!(departures, expected);
}
