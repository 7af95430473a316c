//! Limits kept in spite of the scatter of making, against closed forms: at a given displacement the stress of an inextensible strip is
//! proportional to its thickness, so that the thickest strip that keeps a stress is thinner by what its thickness scatters.

use std::path::Path;

use forcewright::{Choices, DiskFiles, Loaded, Optimised, Robust};

/// The tolerance of the thickness, m: three standard deviations.
const TOLERANCE_M: f64 = 0.03e-3;

/// The strip that pushes hardest within its stress.
fn strip(settings: &str, tolerance: &str) -> Optimised {
    let text = forcewright::gallery::find("cantilever").expect("in the gallery").text;
    let text =
        text.replace("stiffness =", "# stiffness =").replace("thickness = \"0.5 mm\"", &format!("thickness = \"0.5 mm{tolerance}\""));
    assert!(tolerance.is_empty() || text.contains(tolerance), "{text}");
    let text = format!(
        "{text}\n[model]\nbeam = \"inextensible\"\n[optimise]\nobjective = {{ maximise = \"force_at_end\" }}\n{settings}\n\
         variables = {{ \"design.thickness\" = {{ range = [\"0.2 mm\", \"3 mm\"] }} }}\n"
    );
    let loaded = Loaded::from_text("strip.toml", &text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    loaded.optimise(&DiskFiles, Path::new("strip.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).expect("posed")
}

fn thickness_m(found: &Optimised) -> f64 {
    found.best.as_ref().expect("a design").x[0]
}

#[test]
fn a_strip_is_thinner_by_what_its_thickness_scatters() {
    let tolerance = " ± 0.03 mm";
    let plain = strip("", tolerance);
    assert!(plain.robustness.is_none());
    for (settings, against, sigmas) in [
        ("robust = \"percentile\"", Robust::Percentile(0.95), 1.644_853_626_951_472),
        ("robust = \"percentile\"\npercentile = \"99 %\"", Robust::Percentile(0.99), 2.326_347_874_040_841),
        ("robust = \"worst_case\"", Robust::WorstCase, 3.0),
    ] {
        let found = strip(settings, tolerance);
        let robustness = found.robustness.as_ref().expect("asked for");
        assert!(robustness.against == against && robustness.settled && robustness.scattering == 1, "{robustness:?}");
        let taken = thickness_m(&plain) - thickness_m(&found);
        let wanted = sigmas * TOLERANCE_M / 3.0;
        assert!((taken - wanted).abs() < 2e-3 * wanted, "{settings}: {taken:e} m for {wanted:e} m");
        // What was drawn says the same: Φ(sigmas) of the strips keep the stress, half of those around the plain optimum.
        let part = robustness.yields[1].as_ref().expect("drawn").estimate.value;
        let promised = forcewright::study::sampling::normal::cdf(sigmas);
        assert!((part - promised).abs() < 4e-3, "{settings}: {part} for {promised}");
        assert!(found.after.as_ref().is_some_and(|r| r.outcome.requirements_met()));
    }
}

#[test]
fn what_does_not_scatter_is_refused() {
    let text = forcewright::gallery::find("cantilever").expect("in the gallery").text;
    let text = format!(
        "{text}\n[optimise]\nobjective = {{ maximise = \"force_at_end\" }}\nrobust = \"worst_case\"\n\
         variables = {{ \"design.thickness\" = {{ range = [\"0.2 mm\", \"3 mm\"] }} }}\n"
    );
    let loaded = Loaded::from_text("strip.toml", &text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let refused = loaded.optimise(&DiskFiles, Path::new("strip.toml"), (None, None), &|_| true).err().expect("nothing scatters");
    assert!(refused.render(false).contains("E0319"), "{}", refused.render(false));
}

/// Nodes that the search does not move scatter, so that other places are looked at than in the search.
#[test]
fn a_network_in_its_box_is_kept_against_the_scatter_of_all_its_nodes() {
    let text = forcewright::gallery::find("optimise-lan-box").expect("in the gallery").text;
    let text = format!(
        "{text}\n[tolerance]\nsamples = 512\n[tolerance.parameters]\n\"design.nodes.*.at\" = {{ half_width = \"0.02 mm\" }}\n\
         \"design.thickness\" = {{ half_width = \"0.01 mm\" }}\n"
    );
    let text = text.replace("starts = 8 ", "starts = 4\nrobust = \"percentile\"\n# ");
    let loaded = Loaded::from_text("box.toml", &text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let found = loaded.optimise(&DiskFiles, Path::new("box.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).expect("posed");
    let robustness = found.robustness.as_ref().expect("asked for");
    let [_, after] = robustness.yields.each_ref().map(|y| y.as_ref().map(|y| y.estimate.value));
    println!("settled {}, looks {}, yield {after:?}", robustness.settled, robustness.rounds);
    assert!(after.is_some_and(|part| part > 0.85) && found.reserve.limits.iter().all(|r| *r >= 0.0));
}
