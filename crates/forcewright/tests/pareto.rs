//! Trade-offs over project files: against closed forms, and against every design of the same choices.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use forcewright::model::CheckState;
use forcewright::sweep::{Axis, Plan, Sampling, Sweep};
use forcewright::{Choices, DiskFiles, FileError, Files, Loaded, Pareto, gallery};

/// A file in memory.
struct One<'a>(&'a str, &'a str);

impl Files for One<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if path == Path::new(self.0) { Ok(self.1.to_owned()) } else { Err(FileError::NotFound) }
    }
}

fn loaded(text: &str) -> Loaded {
    Loaded::from_text("a.toml", text, &Choices::default()).map_err(|e| e.render(false)).unwrap()
}

fn found(text: &str, options: (Option<u32>, Option<u32>, Option<u32>)) -> Pareto {
    let project = loaded(text);
    let task = project.pareto_task(&DiskFiles, options).map_err(|e| e.render(false)).unwrap();
    task.search(&DiskFiles, "".as_ref(), &AtomicBool::new(false), &|_| ()).map_err(|e| e.render(false)).unwrap()
}

/// Code and message of what is refused.
fn refused(text: &str) -> (&'static str, String) {
    let project = loaded(text);
    let refused = project.pareto_task(&DiskFiles, (None, None, None)).err().unwrap();
    let all = refused.diagnostics.in_file_order();
    (all[0].code, all[0].message.clone())
}

/// A guided strip: with small deflections F = 12 E I δ/L³ and σ = 6 E (w/2) δ/L², I = d w³/12.
fn strip(pareto: &str) -> String {
    format!(
        "schema = 1\nmechanism = \"compliant\"\n[requirements]\nstress = {{ safety_factor = 2 }} # keep\n[material]\nuse = \"C75S\"\n\
         young_modulus = \"200 GPa\"\nyield_stress = \"600 MPa\"\n[design]\nthickness = \"0.5 mm ± 0.01 mm\"   # in the plane\n\
         depth = \"10 mm\"\n[design.nodes]\na = {{ at = [\"0 mm\", \"0 mm\"], support = \"clamped\" }}\n\
         b = {{ at = [\"100 mm\", \"0 mm\"], support = \"parallel\" }}\n[[design.beams]]\nname = \"strip\"\nbetween = [\"a\", \"b\"]\n\
         straight = true\n[load]\nnode = \"b\"\ndirection = [0, 1]\ntravel = \"0.1 mm\"\n[model]\nbeam = \"inextensible\"\n{pareto}"
    )
}

const STRIP: &str =
    "[pareto]\nmaximise = [\"force_at_end\"]\nminimise = [\"stress_max\"]\npopulation = 16\ngenerations = 12\n[pareto.vary]\n";

/// Stress against force at three depths: the force is proportional to the depth and the stress does not depend on it, so that the front has
/// the largest depth, and F = E d (σ L²/(3 E δ))³ δ/L³ along it.
#[test]
fn the_front_of_a_strip_is_its_closed_form() {
    let vary =
        "\"design.thickness\" = { range = [\"20 mm\", \"80 mm\"] }\n\"design.depth\" = { among = [\"5 mm\", \"10 mm\", \"12 mm\"] }\n";
    let text = strip(&format!("{STRIP}{vary}"));
    let front = found(&text, (None, None, None));
    assert!(front.met() && front.designs.len() > 20 && front.search.evaluations == 16 * 13, "{}", front.designs.len());
    let (modulus, length, travel) = (200e9, 0.1, 1e-4_f64);
    for design in &front.designs {
        let depth: f64 = design.values[1].trim_end_matches(" mm").parse().unwrap();
        assert!(design.values[0].ends_with(" mm ± 0.01 mm"), "{}", design.values[0]);
        let (stress, force) = (design.goals[0], design.goals[1]);
        let thickness = stress * length * length / (3.0 * modulus * travel);
        let wanted = modulus * depth * 1e-3 * thickness * thickness * thickness * travel / (length * length * length);
        assert!((force / wanted - 1.0).abs() < 1e-4, "{force} {wanted}");
    }
    // Others remain only where none of the largest depth is near.
    let deepest = front.designs.iter().filter(|d| d.values[1] == "12 mm").count();
    assert!(10 * deepest > 9 * front.designs.len(), "{deepest} of {}", front.designs.len());
    // The front falls: the order is that of the first goal.
    assert!(front.designs.windows(2).all(|w| w[0].goals[0] < w[1].goals[0] && w[0].goals[1] < w[1].goals[1]));
    // Both ends of what is allowed are reached: the thinnest, and the one at the limit of its stress, half the yield stress, at 50 mm.
    let (first, last) = (&front.designs[0], front.designs.last().unwrap());
    assert!(
        first.goals[0] < 1.05 * 120e6 && last.goals[0] > 0.98 * 300e6 && last.goals[0] <= 300e6,
        "{} {}",
        first.values[0],
        last.goals[0]
    );
}

/// A file says what its row says: comments and tolerances stay, the analysis of the file gives the goals of the search bit for bit.
#[test]
fn files_are_what_was_found() {
    let text = strip(&format!("{STRIP}\"design.thickness\" = {{ range = [\"0.2 mm\", \"2 mm\"] }}\n"));
    let front = found(&text, (None, None, None));
    let written: Vec<_> = front.designs.iter().filter(|d| d.file.is_some()).collect();
    assert!(written.len() == 24 && front.designs[0].file.is_some() && front.designs.last().unwrap().file.is_some());
    for design in written {
        let (name, text) = design.file.as_ref().unwrap();
        assert!(name.starts_with("a-pareto-") && text.contains("# keep") && text.contains("# in the plane"));
        assert!(text.contains(&format!("thickness = \"{}\"", design.values[0])), "{text}");
        let outcome = loaded(text).solve("", "", &mut |_| true).outcome;
        assert!(outcome.requirements_met());
        let goals = ["stress_max", "force_at_end"].map(|m| outcome.metric(m).unwrap().value.to_bits());
        assert_eq!(goals.to_vec(), design.goals.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
    }
    // The table has every design, whether it has a file or not.
    assert_eq!(front.csv().lines().count(), 1 + front.designs.len());
    let document = front.document();
    assert_eq!(document["designs"].as_array().unwrap().len(), front.designs.len());
    assert_eq!(document["designs"][0]["goals"][0], front.designs[0].goals[0]);
    let page = front.page("a.toml", "forcewright pareto a.toml");
    let parsed =
        roxmltree::Document::parse_with_options(&page, roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() }).unwrap();
    let links: Vec<&str> =
        parsed.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "a"))).filter_map(|n| n.attribute("href")).collect();
    // Its point, and its line.
    assert_eq!(links.len(), 2 * front.designs.len());
    for link in links {
        let id = link.strip_prefix('#').unwrap();
        assert_eq!(parsed.descendants().filter(|n| n.attribute("id") == Some(id)).count(), 1, "{link}");
    }
}

/// A study of another file: files for another folder, also where the first values are no design, and numbers in a list that only the other
/// file has.
#[test]
fn studies_of_another_file() {
    struct Two(String, String);
    impl Files for Two {
        fn read(&self, path: &Path) -> Result<String, FileError> {
            // As a disk would: `out/../base.toml` is `base.toml`.
            match path.to_string_lossy().replace("out/../", "").as_str() {
                "base.toml" => Ok(self.0.clone()),
                "a.toml" => Ok(self.1.clone()),
                _ => Err(FileError::NotFound),
            }
        }
    }
    let vary = "\"design.depth\" = { range = [\"0 mm\", \"12 mm\"] }\n\"design.beams.strip.bend.1\" = { range = [0.1, 0.3] }\n";
    let base = strip("").replace("straight = true", "bend = [0.2, 0.1]");
    let files = Two(base, format!("extends = \"base.toml\"\n{}{vary}", STRIP.replace("12", "1").replace("16", "8")));
    let project = Loaded::from_file(&files, "a.toml".as_ref(), &Choices::default()).map_err(|e| e.render(false)).unwrap();
    let task = project.pareto_task(&files, (None, None, None)).map_err(|e| e.render(false)).unwrap();
    let front = task.search(&files, "out".as_ref(), &AtomicBool::new(false), &|_| ()).map_err(|e| e.render(false)).unwrap();
    let (_, text) = front.designs.iter().find_map(|d| d.file.as_ref()).unwrap();
    assert!(
        text.contains("extends = \"../base.toml\"") && text.contains(&format!("bend = [{}, 0.1]", front.designs[0].values[1])),
        "{text}"
    );
}

/// Every design of an example's choices, each as `solve` sees it: settings as typed and goals, of those that meet the requirements.
fn all_designs(text: &str, axes: &[&str], goals: &[&str]) -> Vec<(Vec<String>, Vec<f64>)> {
    let plan = Plan::new(axes.iter().map(|a| Axis::parse(a).unwrap()).collect(), Sampling::default(), false).unwrap();
    let stop = AtomicBool::new(false);
    let files = One("a.toml", text);
    let metrics: Vec<String> = goals.iter().map(|g| (*g).to_owned()).collect();
    let sweep = Sweep::new(&files, Path::new("a.toml"), &Choices::default(), plan, &metrics, &stop).unwrap();
    let mut all = Vec::new();
    sweep
        .run(0..sweep.len(), 2, &stop, &mut |row| {
            if row.requirements == Some(CheckState::Met) {
                all.push((row.values, row.metrics.iter().map(|m| m.unwrap()).collect()));
            }
            Ok(())
        })
        .unwrap();
    all
}

/// Whether a design is no worse in all goals, the first of which is made small and the others large, and better in one.
fn beats(a: &[f64], b: &[f64]) -> bool {
    let large = || a[1..].iter().zip(&b[1..]);
    a[0] <= b[0] && large().all(|(a, b)| a >= b) && (a[0] < b[0] || large().any(|(a, b)| a > b))
}

/// The gears of the example, all 2457 designs: what is found is on their front; three quarters of that are found by a third as many, all of
/// it by more.
#[test]
fn gears_are_found_as_among_all_designs() {
    let text = gallery::find("lavt/pareto-gears").unwrap().text;
    let front = found(text, (None, None, None));
    let whole = |from: u32, to: u32| (from..=to).map(|n| n.to_string()).collect::<Vec<_>>().join(",");
    let axes = [
        format!("design.gears.sun={}", whole(10, 18)),
        format!("design.gears.planet={}", whole(12, 24)),
        "design.gears.module=0.4 mm,0.5 mm,0.6 mm".to_owned(),
        "design.hub.diameter=17.6 mm h7,17.7 mm h7,17.8 mm h7,17.9 mm h7,18 mm h7,18.1 mm h7,18.2 mm h7".to_owned(),
    ];
    let axes: Vec<&str> = axes.iter().map(String::as_str).collect();
    let all = all_designs(text, &axes, &["envelope_volume", "output_torque_max", "shift_margin_low"]);
    let best: Vec<_> = all.iter().filter(|d| !all.iter().any(|o| beats(&o.1, &d.1))).collect();
    for (generations, least) in [(None, 3 * best.len() / 4), (Some(60), best.len())] {
        let front = found(text, (None, generations, None));
        println!(
            "{} designs on the front, {} of all {} that keep the requirements; {} computed, {} without values, {:?}",
            front.designs.len(),
            best.len(),
            all.len(),
            front.search.evaluations,
            front.search.failed,
            front.search.stop
        );
        for design in &front.designs {
            assert!(!all.iter().any(|o| beats(&o.1, &design.goals)), "{:?}", design.values);
            assert!(all.iter().any(|o| o.0 == design.values), "{:?}", design.values);
        }
        assert!(front.designs.len() >= least && front.search.evaluations < 2457, "{} of {least}", front.designs.len());
    }
    assert!(best.len() > 5 && front.page("a.toml", "").matches("<figure id=\"figure-front").count() == 3);
}

/// The cable drive of the example against a grid of its preload with every cable and drum: none of it is better in both goals by more than
/// the grid of the search is wide.
#[test]
fn no_handle_of_a_grid_is_better() {
    let text = gallery::find("capstan/pareto-handle").unwrap().text;
    let front = found(text, (None, None, None));
    assert!(front.met() && front.designs.len() > 20, "{}", front.designs.len());
    let axes = [
        "design.cables.1.use=steel 7x7 0.45 mm,steel 7x7 0.54 mm,steel 7x7 0.63 mm,steel 7x19 0.54 mm,steel 7x19 0.63 mm",
        "design.cables.1.preload=10N..80N:15",
        "design.input_diameter=12mm..20mm:9",
    ];
    // Only the requirements are columns of a sweep; the search keeps every check.
    let all = all_designs(text, &axes, &["backdrive_torque_output", "stiffness_tangent_output"]);
    let (mut beaten, mut most) = (0, 0.0_f64);
    for design in &front.designs {
        for (values, other) in all.iter().filter(|(_, o)| beats(o, &design.goals)) {
            let by = (design.goals[0] / other[0] - 1.0).max(other[1] / design.goals[1] - 1.0);
            let outcome = loaded_with(text, &axes, values);
            if outcome {
                (beaten, most) = (beaten + 1, most.max(by));
            }
        }
    }
    println!(
        "{} designs on the front, {} on the grid; {beaten} pairs are the other way round, by {:.2} % at most",
        front.designs.len(),
        all.len(),
        100.0 * most
    );
    assert!(most < 0.02, "{most}");
}

/// Whether a design of a grid keeps every check that was assessed.
fn loaded_with(text: &str, axes: &[&str], values: &[String]) -> bool {
    let keys = axes.iter().map(|a| a.split_once('=').unwrap().0);
    let set = keys.zip(values).map(|(key, value)| format!("{key}={value}")).collect();
    let project = Loaded::from_text("a.toml", text, &Choices { set, variant: None }).map_err(|e| e.render(false)).unwrap();
    project.solve("", "", &mut |_| true).outcome.checks.iter().all(|c| c.state != CheckState::Missed)
}

#[test]
fn threads_and_interruptions() {
    let text = strip(&format!("{STRIP}\"design.thickness\" = {{ range = [\"0.2 mm\", \"2 mm\"] }}\n"));
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| found(&text, (Some(8), Some(4), Some(3))).document())
    };
    assert_eq!(of(1), of(4));
    let project = loaded(&text);
    let task = project.pareto_task(&DiskFiles, (None, None, None)).map_err(|e| e.render(false)).unwrap();
    let (stop, seen) = (AtomicBool::new(false), AtomicU64::new(0));
    let watch = |_: &_| {
        if seen.fetch_add(1, Ordering::Relaxed) == 40 {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let front = task.search(&DiskFiles, "".as_ref(), &stop, &watch).map_err(|e| e.render(false)).unwrap();
    assert!(front.interrupted() && front.met() && front.search.evaluations < 60);
    assert!(front.designs.iter().any(|d| d.file.is_some()));
}

/// Where nothing keeps the limits the nearest design is told, with what it misses.
#[test]
fn the_nearest_is_given_where_nothing_fits() {
    let text = strip(&format!("{STRIP}\"design.thickness\" = {{ range = [\"60 mm\", \"80 mm\"] }}\n"));
    let front = found(&text, (None, None, None));
    assert!(!front.met() && front.designs.len() == 1 && front.search.feasible == 0);
    let nearest = &front.designs[0];
    // σ = 3 E w δ/L² = 6 MPa per mm of thickness: 360 MPa at 60 mm against 300 MPa; the safety factor is 5/6 of what is asked.
    assert!(
        nearest.values[0].starts_with("60 mm") && (nearest.goals[0] / 360e6 - 1.0).abs() < 1e-3,
        "{} {}",
        nearest.values[0],
        nearest.goals[0]
    );
    let (check, margin) = nearest.tightest.as_ref().unwrap();
    assert!(check.to_lowercase().contains("stress") && (-0.21..-0.15).contains(margin), "{check} {margin}");
    assert!(front.verdict()[0].text.contains("No design keeps") && nearest.file.is_some());
}

#[test]
fn what_cannot_be_asked_is_refused_by_name() {
    let goals =
        |goals: &str| refused(&strip(&format!("[pareto]\n{goals}\nvary = {{ \"design.depth\" = {{ range = [\"5 mm\", \"9 mm\"] }} }}\n")));
    assert_eq!(refused(&strip("")).0, "E0317");
    assert_eq!(goals("minimise = [\"stress_max\"]"), ("E0920", "a trade-off has two or three goals, not 1".to_owned()));
    assert_eq!(goals("minimise = [\"stress_mux\", \"force_at_end\"]"), ("E0920", "there is no metric `stress_mux`".to_owned()));
    assert_eq!(goals("minimise = [\"stress_max\"]\nmaximise = [\"stress_max\"]"), ("E0920", "`stress_max` is a goal twice".to_owned()));
    let vary = |key: &str, values: &str| refused(&strip(&format!("{STRIP}\"{key}\" = {{ {values} }}\n")));
    for (key, values, why) in [
        ("requirements.travel", "range = [\"5 mm\", \"9 mm\"]", "is the same for all designs"),
        ("design.beams.*.bend", "range = [0, 1]", "is not the path of one key"),
        ("design.depth", "", "which values may it have?"),
        ("design.depth", "range = [\"5 mm\", \"9 mm\"], among = [\"5 mm\"]", "exclude each other"),
        ("design.depth", "among = [\"5 mm\"], step = \"1 mm\"", "`step` belongs to a `range`"),
        ("design.depth", "range = [\"9 mm\", \"5 mm\"]", "the first value of a range is the smaller one"),
        ("design.depth", "range = [\"5 mm\", \"9 N\"]", "its ends are"),
        ("design.depth", "range = [\"5 mm\"]", "a smallest and a largest value"),
        ("design.depth", "range = [\"5 mm\", \"9 mm\"], step = \"3 mm\"", "is not a whole number of steps long"),
        ("design.depth", "range = [\"5 mm\", \"9 mm\"], step = \"1 N\"", "a step is a positive number of the same unit"),
        ("design.depth", "among = []", "there is nothing to choose from"),
        ("design.depth", "among = [\"5 mm\", \"5 mm\"]", "is listed twice"),
    ] {
        let (code, message) = vary(key, values);
        assert!(code == "E0921" && message.contains(why), "{key} {values}: {code} {message}");
    }
    // Keys and units are told by the reader of project files.
    assert_eq!(vary("design.depht", "range = [\"5 mm\", \"9 mm\"]").0, "E0301");
    assert_eq!(vary("design.depth", "range = [\"5 N\", \"9 N\"]").0, "E0201");
    assert_eq!(vary("design.nodes.a.support", "among = [\"clamped\", \"clampt\"]").0, "E0303");
}

/// What `refused` says, rendered.
fn said(text: &str) -> String {
    let project = loaded(text);
    project.pareto_task(&DiskFiles, (None, None, None)).err().unwrap().render(false)
}

/// A slip is refused before the search, at its place in the file: a key, a word, a value.
#[test]
fn slips_of_what_is_varied_have_their_places() {
    let vary = |key: &str, values: &str| strip(&format!("{STRIP}\"{key}\" = {{ {values} }}\n"));
    for (text, code, place, help) in [
        (vary("design.depht", "range = [\"5 mm\", \"9 mm\"]"), "E0301", "\"design.depht\"", "depth"),
        (vary("design.depth", "range = [\"5 N\", \"9 N\"]"), "E0201", "\"5 N\"", "mm"),
        (vary("design.nodes.a.support", "among = [\"clamped\", \"clampt\"]"), "E0303", "\"clampt\"", "clamped"),
        (vary("material.use", "among = [\"C75S\", \"POM-D\"]"), "E0308", "\"POM-D\"", "POM-C"),
        (
            gallery::find("pareto-handle").unwrap().text.replace("\"steel 7x19 0.63 mm\"]", "\"stel 7x19 0.63 mm\"]"),
            "E0703",
            "\"stel 7x19 0.63 mm\"",
            "did you mean \"steel 7x19\"?",
        ),
    ] {
        let said = said(&text);
        let before = &text[..text.rfind(place).unwrap_or_else(|| panic!("{place}"))];
        let (line, column) = (before.matches('\n').count() + 1, before.rsplit('\n').next().unwrap().chars().count() + 1);
        assert!(said.contains(&format!("error[{code}]")) && said.contains(help), "{said}");
        assert!(said.contains(&format!(":{line}:{column}")), "{line}:{column}: {said}");
    }
    // What is no slip, but no design either, is none of this: such designs have no values.
    let thick = vary("design.depth", "range = [\"5 mm\", \"9 m\"]");
    assert!(loaded(&thick).pareto_task(&DiskFiles, (None, None, None)).is_ok());
}
