//! Calibrations from project files: what was put into synthetic measurements comes out, or it is said why not.
#![allow(clippy::unwrap_used, reason = "a test that finds nothing fails")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use forcewright::contract::data::names_a_file;
use forcewright::study::calibrate::{Progress, Stop};
use forcewright::{Calibrated, Choices, FileError, Files, Loaded, NoCalibration};

mod calibrate {
    mod records;
}

/// Files in memory.
#[derive(Clone, Default)]
struct Memory(BTreeMap<PathBuf, String>);

impl Files for Memory {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        // As a disk would: `out/../bench.csv` is `bench.csv`.
        let plain = path.to_string_lossy().replace("out/../", "");
        self.0.get(Path::new(&plain)).cloned().ok_or(FileError::NotFound)
    }
}

/// Seeded normal noise (splitmix64).
struct Noise(u64);

impl Noise {
    fn normal(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let u = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        forcewright::study::sampling::normal::quantile(u.max(1e-16))
    }
}

fn memory(project: &str, csv: &str) -> Memory {
    assert!(names_a_file("file"));
    Memory([("a.toml".into(), project.to_owned()), ("bench.csv".into(), csv.to_owned())].into())
}

fn load(memory: &Memory) -> Loaded {
    Loaded::from_file(memory, "a.toml".as_ref(), &Choices::default()).map_err(|e| e.render(false)).unwrap()
}

fn calibrated(project: &str, csv: &str) -> Result<Calibrated, String> {
    let memory = memory(project, csv);
    let found = load(&memory).calibrate(&memory, Some("out/calibrated.toml".as_ref()), &mut |_| true);
    found.map_err(|e| match e {
        NoCalibration::Refused(refused) | NoCalibration::NoStart(refused) => refused.render(false),
    })
}

fn codes(found: &Calibrated) -> Vec<&'static str> {
    found.diagnostics.warnings().iter().map(|w| w.code).collect()
}

/// Values of a curve of a project's analysis, by its name and branch.
fn curve(text: &str, name: &str, branch: usize) -> Vec<[f64; 2]> {
    let loaded = Loaded::from_text("a.toml", text, &Choices::default()).map_err(|e| e.render(false)).unwrap();
    let report = loaded.solve("", "", &mut |_| true);
    let curve = report.outcome.curves.iter().find(|c| c.name == name).unwrap();
    let branch = &curve.branches[branch];
    branch.x.iter().zip(&branch.y).map(|(x, y)| [*x, *y]).collect()
}

/// `n` points of a curve at even places of a stretch, linear between those that are there.
fn at_even_places(curve: &[[f64; 2]], [from, to]: [f64; 2], n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let x = from + (to - from) * i as f64 / (n - 1) as f64;
            let k = curve.partition_point(|p| p[0] < x).clamp(1, curve.len() - 1);
            let ([a, fa], [b, fb]) = (curve[k - 1], curve[k]);
            [x, fa + (fb - fa) * (x - a) / (b - a)]
        })
        .collect()
}

fn csv(header: &str, points: impl Iterator<Item = [f64; 2]>) -> String {
    points.fold(format!("{header}\n"), |mut text, [x, y]| {
        let _ = writeln!(text, "{x:.9},{y:.9}");
        text
    })
}

/// A thin strip, guided in parallel: with small deflections `F = 12 E I δ/L³`.
const STRIP: &str = r#"# A guided strip.
schema = 1
mechanism = "compliant"
title = "A guided strip"

[material]
use = "C75S"
young_modulus = "200 GPa"     # to be found

[design]
thickness = "0.5 mm"
depth = "10 mm"
[design.nodes]
a = { at = ["0 mm", "0 mm"], support = "clamped" }
b = { at = ["100 mm", "0 mm"], support = "parallel" }
[[design.beams]]
name = "strip"
between = ["a", "b"]
straight = true

[load]
node = "b"
direction = [0, 1]
travel = "2 mm"

[model]
beam = "inextensible"

[measurements.bench]           # of spring
file = "bench.csv"
x = "travel / mm"
y = "force / N"

[calibrate]
parameters = { "material.young_modulus" = { range = ["100 GPa", "300 GPa"] }, "bench.offset.y" = {} }
"#;

/// Force of the strip, N, at a travel in mm: eight stations of its stiffness and no more are needed where it is straight.
fn strip_n(travel_mm: f64, young_gpa: f64) -> f64 {
    // Inextensible, the tension grows with the third power of the deflection and bends nothing at 2 % of the length.
    12.0 * young_gpa * 1e9 * (10e-3 * 0.5e-3 * 0.5e-3 * 0.5e-3 / 12.0) * travel_mm * 1e-3 / 1e-3
}

fn strip_csv(young_gpa: f64, sigma: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    csv(
        "travel / mm,force / N",
        (0..=80).map(|i| f64::from(i) * 0.0025).map(|x| [x, strip_n(x, young_gpa) + 0.004 + sigma * noise.normal()]),
    )
}

/// The truth lies in the intervals, the file keeps its comments, and what it says is what was found.
#[test]
fn a_strip_tells_its_modulus_and_the_zero_of_its_bench() {
    let found = calibrated(STRIP, &strip_csv(187.0, 0.001, 1)).unwrap();
    let [young, offset] = &found.fit.parameters[..] else { panic!() };
    assert!(young.estimate.interval.contains(187e9) && offset.estimate.interval.contains(0.004), "{young:?} {offset:?}");
    assert!(young.error < 0.01 * 187e9 && (found.fit.noise / 0.001 - 1.0).abs() < 0.3 && found.sound(), "{:?}", found.verdict());
    assert!(codes(&found).is_empty(), "{:?}", codes(&found));
    let text = found.text.clone().unwrap();
    assert!(text.contains("# to be found") && text.contains("# of spring") && text.contains("file = \"../bench.csv\""), "{text}");
    // The new file is the old one with a variant whose curve is the fitted one: calibrated again, nothing moves.
    let again = Memory([("out/calibrated.toml".into(), text.clone()), ("bench.csv".into(), strip_csv(187.0, 0.001, 1))].into());
    let read = |variant: Option<&str>| {
        let choices = Choices { variant: variant.map(str::to_owned), set: Vec::new() };
        Loaded::from_file(&again, "out/calibrated.toml".as_ref(), &choices).map_err(|e| e.render(false)).unwrap()
    };
    assert!(text.contains("young_modulus = \"200 GPa\"") && found.variant == "calibrated", "{text}");
    let force = |loaded: &Loaded| loaded.solve("", "", &mut |_| true).outcome.metric("force_at_end").unwrap().value;
    let ratio = force(&read(Some("calibrated"))) / force(&read(None));
    assert!((ratio / (young.estimate.value / 200e9) - 1.0).abs() < 1e-6, "{ratio}");
    let loaded = read(Some("calibrated"));
    let second = loaded.calibrate(&again, None, &mut |_| true).map_err(|e| e.to_string()).unwrap();
    for (a, b) in found.fit.parameters.iter().zip(&second.fit.parameters) {
        assert!((b.parameter.start - a.estimate.value).abs() < 1e-3 * a.error, "{a:?} {b:?}\n{text}");
        assert!((b.estimate.value - a.estimate.value).abs() < 1e-3 * a.error);
    }
    // The document and the page tell the same.
    let document = found.document();
    assert_eq!(document["parameters"][0]["path"], "material.young_modulus");
    assert!((document["parameters"][0]["value"].as_f64().unwrap() - young.estimate.value).abs() < 1.0);
    assert_eq!(document["residuals"]["judged"], true);
    assert!(document["status"]["intervals_unknown"].is_null() && document["residuals"]["autocorrelation"].is_number());
    let page = found.page("a.toml", "forcewright calibrate a.toml");
    let neighbours = format!("Neighbouring residuals have a correlation of {:.2}", found.fit.residuals.autocorrelation);
    assert!(page.contains("material.young_modulus") && page.contains(&neighbours), "{neighbours}");
}

/// Seven points determine two parameters and do not tell whether anything is left: it is said, and is no success.
#[test]
fn few_points_are_not_called_explained() {
    let all = strip_csv(187.0, 0.001, 1);
    let few: Vec<&str> = all.lines().enumerate().filter(|(i, _)| *i == 0 || i % 12 == 1).map(|(_, line)| line).collect();
    let found = calibrated(STRIP, &few.join("\n")).unwrap();
    assert!(found.points.x.len() == 7 && found.fit.parameters[0].estimate.interval.contains(187e9), "{:?}", found.rows());
    assert!(!found.fit.residuals.judged && !found.sound() && found.residual_verdict().starts_with("Too few points to judge"));
    assert!(found.verdict().contains("too few to judge") && codes(&found).contains(&"W0909"), "{}", found.verdict());
    let page = found.page("a.toml", "forcewright calibrate a.toml");
    assert!(page.contains("Too few points to judge") && page.contains("which so few points cannot tell"));
    let document = found.document();
    assert!(document["residuals"]["judged"] == false && document["residuals"]["unexplained"] == false && document["sound"] == false);
}

/// Of a search that did not come to its end, intervals are told as unknown, with the reason, wherever they stand.
#[test]
fn a_stalled_search_says_that_its_intervals_are_unknown() {
    let mut found = calibrated(STRIP, &strip_csv(187.0, 0.001, 1)).unwrap();
    (found.fit.stop, found.fit.ended) = (Stop::Stalled, false);
    for p in &mut found.fit.parameters {
        (p.error, p.profile) = (f64::INFINITY, None);
        p.estimate.interval = forcewright::study::sampling::Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
    }
    assert!(found.rows().iter().all(|row| row[3] == "−∞ to ∞" && row[5] == "interval unknown"), "{:?}", found.rows());
    let verdict = found.verdict();
    assert!(verdict.contains("did not come to its end") && verdict.contains("Intervals are unknown: the search stands"), "{verdict}");
    let (page, document) = (found.page("a.toml", ""), found.document());
    assert!(page.contains("here intervals are unknown: the search stands") && !page.contains("further points would lie"));
    assert!(document["status"]["kind"] == "not converged" && document["parameters"][0]["interval"]["low"].is_null());
    assert!(document["status"]["intervals_unknown"].as_str().unwrap().starts_with("the search stands"));
}

/// The same bits with one thread and with several.
#[test]
fn threads_change_no_bit() {
    let (project, csv) = (STRIP, strip_csv(187.0, 0.001, 2));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| calibrated(project, &csv).unwrap().document().to_string())
    };
    assert_eq!(with(1), with(3));
}

/// Modulus and depth move the force alike: their product is determined, they are not, and that is said with the combination.
#[test]
fn modulus_and_depth_are_not_told_apart() {
    let project = STRIP.replace("\"bench.offset.y\" = {}", "\"design.depth\" = {}, \"bench.offset.y\" = {}");
    let found = calibrated(&project, &strip_csv(187.0, 0.001, 3)).unwrap();
    let warnings = found.diagnostics.warnings();
    let said = warnings.iter().find(|w| w.code == "W0902").unwrap();
    assert!(said.message.contains("`material.young_modulus`") && said.message.contains("`design.depth`"), "{}", said.message);
    assert!(said.message.contains("+1 %") && said.message.contains("−1 %") && !found.sound(), "{}", said.message);
    let product = found.fit.parameters[0].estimate.value * found.fit.parameters[1].estimate.value;
    assert!((product / (187e9 * 10e-3) - 1.0).abs() < 0.01, "{:?} {product}", found.rows());
    // A prior on one of them settles it.
    let project = project.replace("\"design.depth\" = {}", "\"design.depth\" = { prior = \"10 mm ± 0.03 mm\" }");
    let found = calibrated(&project, &strip_csv(187.0, 0.001, 3)).unwrap();
    assert!(found.fit.parameters[0].estimate.interval.contains(187e9) && codes(&found).contains(&"W0904"), "{:?}", found.rows());
}

/// A bench that gives way looks like a softer material, unless it is known or looked for with what tells them apart.
#[test]
fn a_soft_bench_is_taken_off() {
    // Stiffness of the strip: 12 E I/L³ = 0.2338 N/mm at 187 GPa; the bench takes 0.5 mm/N.
    let mut noise = Noise(9);
    let points = (0..=80).map(|i| f64::from(i) * 0.0025).map(|x| {
        let force = strip_n(x, 187.0);
        [x + 0.5 * force, force + 0.004 + 0.0005 * noise.normal()]
    });
    let data = csv("travel / mm,force / N", points);
    let stiff = calibrated(STRIP, &data).unwrap();
    assert!(stiff.fit.parameters[0].estimate.value < 175e9);
    let known = STRIP.replace("y = \"force / N\"", "y = \"force / N\"\ncompliance = \"0.5 mm/N\"");
    let found = calibrated(&known, &data).unwrap();
    assert!(found.fit.parameters[0].estimate.interval.contains(187e9), "{:?}", found.rows());
}

/// Decimal commas, other columns between, a filter: the same estimate from another spelling of the same record.
#[test]
fn spellings_of_a_record() {
    let plain = calibrated(STRIP, &strip_csv(187.0, 0.001, 4)).unwrap();
    let lines = strip_csv(187.0, 0.001, 4);
    let german: String = lines.lines().enumerate().fold(String::new(), |mut text, (i, line)| {
        let _ = match line.split_once(',') {
            Some((x, y)) if i > 0 => writeln!(text, "{i};{};{}", y.replace('.', ","), x.replace('.', ",")),
            _ => writeln!(text, "nr;force / N;travel / mm"),
        };
        text
    });
    let comma = STRIP.replace("y = \"force / N\"", "y = \"force / N\"\ndecimal = \"comma\"");
    let found = calibrated(&comma, &german).unwrap();
    assert_eq!(found.fit.parameters[0].estimate, plain.fit.parameters[0].estimate);
    let filtered = STRIP.replace("y = \"force / N\"", "y = \"force / N\"\nfilter = { order = 2, cut_off = \"5 Hz\", rate = \"40 Hz\" }");
    let found = calibrated(&filtered, &lines).unwrap();
    let [a, b] = [&found, &plain].map(|f| f.fit.parameters[0].clone());
    assert!((a.estimate.value - b.estimate.value).abs() < b.error && (a.error / b.error - 1.0).abs() < 0.05, "{a:?} {b:?}");
}

/// A network whose measured joints are rigid zones, fitted without them: no modulus explains the curve, and that is said.
#[test]
fn joints_that_the_model_lacks_are_not_absorbed() {
    let example = forcewright::gallery::find("lan-table3").unwrap().text;
    let overlap = format!("{example}\n[model]\njoints = \"overlap\"\n");
    let overlap = if example.contains("[model]") { example.replace("[model]", "[model]\njoints = \"overlap\"") } else { overlap };
    let truth = at_even_places(&curve(&overlap, "force", 0), [0.1e-3, 13.5e-3], 150);
    let plain = at_even_places(&curve(example, "force", 0), [0.1e-3, 13.5e-3], 150);
    let study = "\n[measurements.bench]\nfile = \"bench.csv\"\nx = \"travel / mm\"\ny = \"force / N\"\n[calibrate]\nparameters = { \"material.young_modulus\" = { range = [\"1 GPa\", \"4 GPa\"] } }\n";
    let mut noise = Noise(6);
    let mut data = |points: &[[f64; 2]]| csv("travel / mm,force / N", points.iter().map(|[x, y]| [1e3 * x, y + 0.03 * noise.normal()]));
    let (with, without) = (data(&truth), data(&plain));
    let good = calibrated(&format!("{example}{study}"), &without).unwrap();
    assert!(good.sound() && good.fit.parameters[0].estimate.interval.contains(2e9), "{} {:?}", good.residual_verdict(), good.rows());
    let bad = calibrated(&format!("{example}{study}"), &with).unwrap();
    assert!(codes(&bad).contains(&"W0905") && !bad.sound(), "{} {:?}", bad.residual_verdict(), bad.rows());
    // With the joints in the model, the same measurement is explained.
    let joined = calibrated(&format!("{overlap}{study}"), &with).unwrap();
    assert!(
        joined.sound() && joined.fit.parameters[0].estimate.interval.contains(2e9),
        "{} {:?}",
        joined.residual_verdict(),
        joined.rows()
    );
}

const AXES: &str = "\n[measurements.curve]\nfile = \"bench.csv\"\n";

/// Force over travel of a cam, up and down: rolling friction from the loop, the rest length of the springs from its level.
#[test]
fn a_cam_tells_friction_and_rest_length_from_both_branches() {
    let example = forcewright::gallery::find("sanchez-2-springs").unwrap().text;
    let stand = |text: &str| {
        let loaded = Loaded::from_text("a.toml", text, &Choices::default()).map_err(|e| e.render(false)).unwrap();
        let report = loaded.solve("", "", &mut |_| true);
        let curve = report.outcome.curves.iter().find(|c| c.name == "force").unwrap().clone();
        curve.branches.iter().map(|b| b.name.clone()).collect::<Vec<_>>()
    };
    let names = stand(example);
    let place = |what: &str| names.iter().position(|n| n.contains(what)).unwrap_or_else(|| panic!("{names:?}"));
    let window = [45e-3, 205e-3];
    let up = at_even_places(&curve(example, "force", place("up")), window, 100);
    let down = at_even_places(&curve(example, "force", place("down")), window, 100);
    let mut noise = Noise(12);
    let all = up.iter().chain(down.iter().rev());
    let data = csv("s / mm,F / N", all.map(|[x, y]| [1e3 * x, y + 0.1 * noise.normal()]));
    let friction = if example.contains("rolling_arm") { "design.rolling_arm" } else { "design.rolling_friction" };
    let study = format!(
        "{AXES}x = \"s / mm\"\ny = \"F / N\"\n[calibrate]\nparameters = {{ \"{friction}\" = {{}}, \"design.springs.rest_length\" = {{}} }}\n"
    );
    // The search begins elsewhere.
    let found = calibrated(&format!("{example}{study}"), &data).unwrap();
    assert_eq!(found.points.names, ["loading", "unloading"]);
    for p in &found.fit.parameters {
        assert!(
            p.estimate.interval.contains(p.parameter.start) && p.error < 0.2 * p.parameter.start,
            "{:?} {}",
            found.rows(),
            found.residual_verdict()
        );
    }
    assert!(!found.fit.residuals.unexplained, "{}", found.residual_verdict());
}

/// Stiffness over torque of a cable drive, as measured with the friction and the rope of another file.
#[test]
fn a_cable_drive_tells_the_stiffness_of_its_rope() {
    let example = forcewright::gallery::find("longval").unwrap().text;
    let study = format!(
        "{AXES}x = \"torque / N*m\"\ny = \"stiffness / N*m/rad\"\n[calibrate]\nparameters = {{ \"design.cables.*.preload\" = {{}} }}\n"
    );
    let text = format!("{example}{study}");
    let truth = at_even_places(&curve(example, "stiffness", 0), [0.05, 9.5], 60);
    let mut noise = Noise(2);
    let data = csv("torque / N*m,stiffness / N*m/rad", truth.iter().map(|[x, y]| [*x, y + 2.0 * noise.normal()]));
    let found = calibrated(&text, &data).unwrap();
    let preload = &found.fit.parameters[0];
    assert!(
        preload.estimate.interval.contains(preload.parameter.start) && preload.error.is_finite(),
        "{:?} {}",
        found.rows(),
        found.residual_verdict()
    );
    assert!(!found.fit.residuals.unexplained, "{}", found.residual_verdict());
}

/// Output over input torque of a transmission: the losses of both modes.
#[test]
fn a_transmission_tells_its_friction() {
    let example = forcewright::gallery::find("butin-2").unwrap().text;
    let study = format!("{AXES}x = \"in / N*mm\"\ny = \"out / N*mm\"\n[calibrate]\nparameters = {{ \"design.hub.diameter\" = {{}} }}\n");
    let text = format!("{example}{study}");
    let places: Vec<f64> = (1..90).map(f64::from).collect();
    let blank = csv("in / N*mm,out / N*mm", places.iter().map(|x| [*x, 1.0]));
    let exact = calibrated(&text, &blank).unwrap().fit.before;
    let mut noise = Noise(21);
    let data = csv("in / N*mm,out / N*mm", places.iter().zip(&exact).map(|(x, y)| [*x, 1e3 * y + 0.5 * noise.normal()]));
    let found = calibrated(&text, &data).unwrap();
    let hub = &found.fit.parameters[0];
    assert!(hub.estimate.interval.contains(hub.parameter.start) && hub.error < 1e-4, "{:?} {}", found.rows(), found.residual_verdict());
}

/// Measured about the shift itself: between its stations the curve has its corners where the analysis has them. Without noise the friction
/// comes out to what the analysis rounds to; curves without corners would miss it by a thousandth.
#[test]
fn points_about_the_shift_tell_the_friction() {
    let example = forcewright::gallery::find("butin-2").unwrap().text;
    let with = |hub: &str| {
        let changed = example.replace("hub = \"0.12 ± 0.03\"", &format!("hub = {hub}")).replace("bore = \"0.12 ± 0.03\"", "bore = 0.35");
        assert_eq!(changed.matches("0.12 ± 0.03").count(), 0, "the example has another friction");
        changed
    };
    let rising = curve(&with("0.2"), "characteristic", 0);
    let [low, high] = [1.0, 3.0].map(|slope| rising.windows(2).filter(|w| w[1][1] - w[0][1] < slope * (w[1][0] - w[0][0])).count());
    assert!(low < high && high < rising.len() - 1, "level, then steep: {low} {high}");
    let points = at_even_places(&rising, [2e-3, 0.024], 58).into_iter().map(|[x, y]| [1e3 * x, 1e3 * y]);
    let start = with("0.19");
    let study = format!("{AXES}x = \"in / N*mm\"\ny = \"out / N*mm\"\n[calibrate]\nparameters = {{ \"design.friction.hub\" = {{}} }}\n");
    let found = calibrated(&format!("{start}{study}"), &csv("in / N*mm,out / N*mm", points)).unwrap();
    let value = found.fit.parameters[0].estimate.value;
    assert!((value - 0.2).abs() < 1e-6, "{value}");
}

/// With a variant, the estimates go into it; where the file has one of that name, into another; what the command line sets is written.
#[test]
fn estimates_have_a_variant_of_their_own() {
    let csv = strip_csv(187.0, 0.001, 1);
    let with = |project: &str, variant: Option<&str>, set: &[&str]| {
        let memory = memory(project, &csv);
        let choices = Choices { variant: variant.map(str::to_owned), set: set.iter().map(|s| (*s).to_owned()).collect() };
        let loaded = Loaded::from_file(&memory, "a.toml".as_ref(), &choices).map_err(|e| e.render(false)).unwrap();
        let found = loaded.calibrate(&memory, Some("out/calibrated.toml".as_ref()), &mut |_| true).map_err(|e| e.to_string()).unwrap();
        (found.variant.clone(), found.text.unwrap())
    };
    let taken = format!("{STRIP}[variants.calibrated]\ndesign.depth = \"9 mm\"\n[variants.soft]\nmaterial.young_modulus = \"150 GPa\"\n");
    let (name, text) = with(&taken, None, &["design.depth=11 mm"]);
    assert!(name == "calibrated-2" && text.contains("depth = \"11 mm\"") && text.contains("design.depth = \"9 mm\""), "{text}");
    let (name, text) = with(&taken, Some("soft"), &["measurements.bench.offset.x=0 mm"]);
    assert!(name == "soft" && text.contains("200 GPa") && !text.contains("150 GPa") && text.contains("\"0 mm\""), "{text}");
}

/// Told to stop while intervals are looked for, the estimates are there and written.
#[test]
fn a_stop_keeps_the_estimates() {
    let memory = memory(STRIP, &strip_csv(187.0, 0.001, 1));
    let on = &mut |p: Progress| matches!(p, Progress::Search { .. });
    let found = load(&memory).calibrate(&memory, Some("out/calibrated.toml".as_ref()), on).map_err(|e| e.to_string()).unwrap();
    assert!(found.fit.stop == Stop::Interrupted && found.fit.parameters.iter().all(|p| p.profile.is_none()));
    assert!(found.fit.parameters[0].estimate.interval.contains(187e9) && found.text.is_some() && found.verdict().contains("Interrupted"));
}

/// The files of an example of the gallery, with those that it extends and names.
fn example(name: &str) -> (Memory, PathBuf) {
    let mut files = BTreeMap::new();
    let first = forcewright::gallery::find(name).unwrap();
    let mut next = Some(first);
    while let Some(example) = next {
        files.insert(example.file_name().into(), example.text.to_owned());
        files.extend(example.data().map(|(name, text)| (name.into(), text.to_owned())));
        next = example.base();
    }
    (Memory(files), first.file_name().into())
}

fn calibrated_example(name: &str, variant: Option<&str>) -> Calibrated {
    let (memory, path) = example(name);
    let choices = Choices { variant: variant.map(str::to_owned), set: Vec::new() };
    let loaded = Loaded::from_file(&memory, &path, &choices).map_err(|e| e.render(false)).unwrap();
    loaded.calibrate(&memory, None, &mut |_| true).map_err(|e| e.to_string()).unwrap()
}

fn estimate<'a>(found: &'a Calibrated, path: &str) -> &'a forcewright::study::calibrate::Estimated {
    found.fit.parameters.iter().find(|p| p.parameter.name == path).unwrap()
}

/// The force of the solid by another program's plane finite elements (2 GPa): beams that meet in points absorb what they can in E, and are
/// told on; rigid zones at the joints come nearer in both.
#[test]
fn the_solid_by_finite_elements_is_not_explained_by_beams_that_meet_in_points() {
    let [zones, points] = [None, Some("lines")].map(|variant| calibrated_example("calibrate-lan-solid", variant));
    let young = |found: &Calibrated| estimate(found, "material.young_modulus").estimate.value;
    println!("zones {} {}\npoints {} {}", young(&zones), zones.residual_verdict(), young(&points), points.residual_verdict());
    assert!(codes(&points).contains(&"W0905") && !points.sound());
    assert!((young(&zones) / 2e9 - 1.0).abs() < 0.02 && young(&points) > 2.03e9);
    assert!(zones.fit.residuals.systematic < 0.5 * points.fit.residuals.systematic);
}

/// The printed lines of Butin et al., Table 2, configuration 2: the losses that the table prints, and the friction at which
/// `E I (1/r − 1/r_A) (1 − e^(−2π (N_A − 0.2) μ))` is the printed constant loss of mode II.
#[test]
fn printed_lines_of_a_transmission_give_the_printed_losses() {
    assert_eq!(include_str!("../../../reference/butin2023-table2.csv"), include_str!("../../../examples/lavt/butin-2-lines.csv"));
    let found = calibrated_example("calibrate-butin-2", None);
    let value = |path: &str| estimate(&found, path).estimate.value;
    println!("{:?}\n{}", found.rows(), found.residual_verdict());
    assert!((value("losses.mode_1.proportional") - 0.13).abs() < 0.002, "{}", value("losses.mode_1.proportional"));
    assert!((value("losses.mode_1.constant") - 1.84e-3).abs() < 0.02e-3, "{}", value("losses.mode_1.constant"));
    assert!((value("losses.mode_2.proportional") - (1.0 - 4.09 / 5.0)).abs() < 0.001, "{}", value("losses.mode_2.proportional"));
    let second_moment = std::f64::consts::PI * 1e-12 / 64.0;
    let moment_nm = 210e9 * second_moment * (1.0 / 8.7e-3 - 1.0 / 9.3e-3);
    let friction = -forcewright::base::maths::ln(1.0 - 65.0e-3 / moment_nm) / (std::f64::consts::TAU * 1.8);
    assert!((value("design.friction.hub") - friction).abs() < 3e-4 && (friction - 0.1679).abs() < 1e-4, "{friction}");
    assert!(found.converged() && found.fit.identified.loose.is_empty());
}

/// The synthetic measurements of the examples: their truths stand in the heads of their tables, and lie in the intervals.
#[test]
fn examples_find_the_truth_of_their_measurements() {
    for (name, truths) in [
        ("calibrate-sanchez", &[("design.rolling_arm", 0.036e-3), ("design.springs.rest_length", 136.5e-3), ("bench.offset.y", 0.35)][..]),
        ("calibrate-longval", &[("design.cables.1.preload", 180.0), ("design.friction", 0.165)]),
    ] {
        let found = calibrated_example(name, None);
        assert!(found.sound(), "{name}: {}", found.residual_verdict());
        for (path, truth) in truths {
            assert!(estimate(&found, path).estimate.interval.contains(*truth), "{name}: {path} {:?}", found.rows());
        }
    }
}

/// Forces of another program's cam with springs (reference/cam/converged.json): its friction and its rest length come out.
#[test]
fn forces_of_another_program_give_its_friction_and_rest_length() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../../reference/cam/converged.json")).unwrap();
    let of = |key: &str| -> Vec<f64> {
        reference["force_profiles_mu0.002"][key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let (s, up, down) = (of("s"), of("up"), of("down"));
    let inside: Vec<usize> = (0..s.len()).filter(|i| (0.04..=0.21).contains(&s[*i])).collect();
    let there = inside.iter().map(|i| [1e3 * s[*i], up[*i]]);
    let back = inside.iter().rev().map(|i| [1e3 * s[*i], down[*i]]);
    let data = csv("s / mm,F / N", there.chain(back));
    let example = forcewright::gallery::find("sanchez-2-springs").unwrap().text;
    let elsewhere = example.replace("0.032 mm ± 0.008 mm", "0.02 mm").replace("136 mm ± 0.3 mm", "136.7 mm");
    assert!(elsewhere.contains("0.02 mm") && elsewhere.contains("136.7 mm"));
    let study =
        "x = \"s / mm\"\ny = \"F / N\"\n[calibrate]\nparameters = { \"design.rolling_arm\" = {}, \"design.springs.rest_length\" = {} }\n";
    let found = calibrated(&format!("{elsewhere}{AXES}{study}"), &data).unwrap();
    let value = |path: &str| estimate(&found, path).estimate.value;
    println!("{:?} {}", found.rows(), found.fit.noise);
    assert!((value("design.rolling_arm") / 0.032e-3 - 1.0).abs() < 1e-3 && (value("design.springs.rest_length") - 0.136).abs() < 1e-6);
    assert!(found.fit.noise < 1e-3);
}

/// Every mistake has its code, its place, and a way out.
#[test]
fn mistakes_are_told_with_their_places() {
    let good = strip_csv(187.0, 0.001, 1);
    let edits: &[(&str, &str, &str)] = &[
        (
            "E0317",
            "[calibrate]\nparameters = { \"material.young_modulus\" = { range = [\"100 GPa\", \"300 GPa\"] }, \"bench.offset.y\" = {} }\n",
            "",
        ),
        ("E0901", "[calibrate]\n", "[calibrate]\nmeasurement = \"bensch\"\n"),
        ("E0902", "\"bench.offset.y\" = {}", "\"bench.offset.y\" = { prior = \"0.1 N\" }"),
        ("E0903", "\"bench.offset.y\" = {}", "\"bench.friction\" = {}"),
        ("E0904", "x = \"travel / mm\"", "x = \"travel / mm\"\noffset = { x = \"-50 mm\" }"),
        ("E0905", "x = \"travel / mm\"", "x = \"travel / mm\"\nfilter = { cut_off = \"30 Hz\", rate = \"40 Hz\" }"),
        ("E0906", "[\"100 GPa\", \"300 GPa\"]", "[\"210 GPa\", \"300 GPa\"]"),
        // Ranges of the bench hold the value of the file as others do; without one it is zero.
        ("E0906", "\"bench.offset.y\" = {}", "\"bench.offset.y\" = { range = [\"0.1 N\", \"0.2 N\"] }"),
        ("E0906", "\"bench.offset.y\" = {}", "\"bench.compliance\" = { range = [\"1e-6 m/N\", \"2e-6 m/N\"] }"),
        // Stiff along its axis, a strip of 100 mm does not go so far.
        ("E0907", "travel = \"2 mm\"", "travel = \"150 mm\""),
        ("E0910", "x = \"travel / mm\"", "x = \"travel / mm\"\ncompliance = \"2 N/mm\""),
        ("E0911", "{ \"material.young_modulus\" = { range = [\"100 GPa\", \"300 GPa\"] }, \"bench.offset.y\" = {} }", "{ }"),
        ("E0312", "\"bench.offset.y\" = {}", "\"load.travel\" = {}"),
        ("E0313", "\"bench.offset.y\" = {}", "\"material.yield_stress\" = {}"),
        ("E0112", "x = \"travel / mm\"", "x = \"way / mm\""),
        ("E0201", "x = \"travel / mm\"\ny = \"force / N\"", "x = \"force / N\"\ny = \"force / N\""),
    ];
    for (code, from, to) in edits {
        assert!(STRIP.contains(from), "{from}");
        let said = calibrated(&STRIP.replacen(from, to, 1), &good).map(|_| ()).expect_err(code);
        assert!(said.contains(&format!("error[{code}]")) && said.contains("help"), "{code}: {said}");
        assert!(said.contains("a.toml:"), "{code}: {said}");
    }
    let (shown, bad) = ("1.2.3", good.replacen("0.002500000", "1.2.3", 1));
    let said = calibrated(STRIP, &bad).map(|_| ()).expect_err(shown);
    assert!(said.contains("bench.csv:3:1") && said.contains("E0202"), "{said}");
    // What is left out is said, not silently dropped.
    let longer = format!("{good}5.0,1.2\n5.1,1.2\n");
    assert!(codes(&calibrated(STRIP, &longer).unwrap()).contains(&"W0901"));
    // A range that ends before the truth holds the estimate there.
    let narrow = calibrated(&STRIP.replace("\"300 GPa\"", "\"201 GPa\"").replace("\"100 GPa\"", "\"195 GPa\""), &good).unwrap();
    assert!(codes(&narrow).contains(&"W0906") && !narrow.sound());
    assert!(narrow.verdict().contains("do not explain the measured curve within their ranges"), "{}", narrow.verdict());
    // One that ends a little above the best value is no lack of the model, and none of what the curve determines.
    let best = &calibrated(STRIP, &good).unwrap().fit.parameters[0];
    let above = format!("\"{} GPa\"", 1e-9 * (best.estimate.value + 0.3 * best.error));
    let held = calibrated(&STRIP.replace("\"100 GPa\"", &above), &good).unwrap();
    assert!(codes(&held) == ["W0906"] && held.verdict().contains("met better beyond the range"), "{:?} {}", codes(&held), held.verdict());
    // What takes no part in a calibration is told with what does, the bench too.
    let said = calibrated(&STRIP.replace("\"bench.offset.y\" = {}", "\"load.travel\" = {}"), &good).map(|_| ()).expect_err("a load");
    assert!(said.contains("takes no part") && said.contains("`material`") && said.contains("and `bench` take part"), "{said}");
    let said = calibrated(&STRIP.replace("bench.offset.y\" = {}", "bensh.offset.y\" = {}"), &good).map(|_| ()).expect_err("a slip");
    assert!(said.contains("did you mean `bench.offset.y`?"), "{said}");
    // Commas are no advice to those who write commas.
    let comma = STRIP.replace("y = \"force / N\"", "y = \"force / N\"\ndecimal = \"comma\"");
    let said = calibrated(&comma, "travel / mm;force / N\n0,1;0,2;3\n").map(|_| ()).expect_err("a row too long");
    assert!(said.contains("E0112") && said.contains("decimal commas"), "{said}");
    // A prior that the measurement contradicts.
    let sure = STRIP.replace("{ range = [\"100 GPa\", \"300 GPa\"] }", "{ prior = \"200 GPa ± 3 GPa\" }");
    assert!(codes(&calibrated(&sure, &good).unwrap()).contains(&"W0907"));
}

/// A compliance is read in any unit of the abscissa over any of the ordinate, as other quantities are, in the file and from a setting; what
/// is written is in the units of the record, and read again.
#[test]
fn compliances_in_any_units() {
    let mut noise = Noise(9);
    let points = (0..=80).map(|i| f64::from(i) * 0.0025).map(|x| {
        let force = strip_n(x, 187.0);
        [x + 0.5 * force, force + 0.0005 * noise.normal()]
    });
    let data = csv("travel / mm,force / N", points);
    let young = |compliance: &str, set: &[String]| {
        let with = if compliance.is_empty() { String::new() } else { format!("\ncompliance = {compliance}") };
        let memory = memory(&STRIP.replace("y = \"force / N\"", &format!("y = \"force / N\"{with}")), &data);
        let choices = Choices { variant: None, set: set.to_vec() };
        let loaded = Loaded::from_file(&memory, "a.toml".as_ref(), &choices).map_err(|e| e.render(false)).unwrap();
        let found = loaded.calibrate(&memory, None, &mut |_| true).map_err(|e| e.to_string());
        found.map(|found| estimate(&found, "material.young_modulus").estimate.value)
    };
    let truth = young("\"0.5 mm/N\"", &[]).unwrap();
    for same in [
        "\"0.5mm/N\"",
        "\"5e-4 m/N\"",
        "\"500 µm/N\"",
        "\"0.5 m/kN\"",
        "\"0.5 mm/(N)\"",
        "\"0.5 mm / N ± 0.1 mm / N\"",
        "\"0.5 ± 0.1 mm/N\"",
        "\"0.5 mm/N +/- 20 %\"",
    ] {
        let found = young(same, &[]).unwrap_or_else(|e| panic!("{same}: {e}"));
        assert!((found / truth - 1.0).abs() < 1e-9, "{same}: {found} {truth}");
    }
    let set = young("", &["measurements.bench.compliance=0.5 mm/N".to_owned()]).unwrap();
    assert!((set / truth - 1.0).abs() < 1e-9);
    let zero = young("0", &[]).unwrap();
    assert!((zero / young("\"0 mm/N\"", &[]).unwrap() - 1.0).abs() < 1e-12 && (zero / truth - 1.0).abs() > 0.05);
    for wrong in ["\"0.5 N/mm\"", "\"0.5 mm\"", "\"half mm/N\"", "0.5", "\"0.5 mm/(N\"", "\"0.5 (mm)/N\""] {
        let said = young(wrong, &[]).unwrap_err();
        assert!(said.contains("E0910") && said.contains("write it as \"2e-6 m/N\""), "{wrong}: {said}");
    }
    // Looked for, it is shown and written in the units of the record.
    let open = STRIP.replace(
        "{ range = [\"100 GPa\", \"300 GPa\"] }, \"bench.offset.y\" = {}",
        "{ prior = \"187 GPa ± 0.01 GPa\" }, \"bench.compliance\" = {}",
    );
    let found = calibrated(&open, &data).unwrap();
    let compliance = estimate(&found, "bench.compliance").estimate;
    assert!(compliance.interval.contains(0.5e-3), "{:?}", found.rows());
    assert!(found.rows()[1][2].ends_with(" mm/N"), "{:?}", found.rows());
    let text = found.text.unwrap();
    assert!(text.contains("compliance = \"") && text.contains(" mm/N\""), "{text}");
}

/// Points near the ends are chosen by the zero that was found, not by that of the file: begun with a zero that is far off, the same points
/// count, and the same is found.
#[test]
fn points_are_chosen_by_the_zero_that_was_found() {
    let example = forcewright::gallery::find("lan-table3").unwrap().text;
    let own = at_even_places(&curve(example, "force", 0), [0.2e-3, 13.4e-3], 120);
    let mut noise = Noise(21);
    // The bench shows 2.5 mm at rest.
    let data = csv("travel / mm,force / N", own.iter().map(|[x, y]| [1e3 * x + 2.5, y + 0.01 * noise.normal()]));
    let fitted = |offset: &str| {
        let study = format!(
            "{AXES}x = \"travel / mm\"\ny = \"force / N\"\noffset = {{ x = \"{offset}\" }}\n[calibrate]\nparameters = {{ \"bench.offset.x\" = {{}} }}\n"
        );
        calibrated(&format!("{example}{study}"), &data).unwrap()
    };
    let (near, far) = (fitted("2.5 mm"), fitted("0.5 mm"));
    assert_eq!((near.points.x.len(), near.points.left_out, near.beyond), (120, 0, 0));
    assert_eq!((far.points.x.len(), far.points.left_out, far.beyond), (120, 0, 0));
    let [a, b] = [&near, &far].map(|f| f.fit.parameters[0].estimate.value);
    assert!((a - 2.5e-3).abs() < 2e-5 && (a - b).abs() < 1e-3 * near.fit.parameters[0].error, "{a} {b}");
    // What is dropped is told of the zero that was found: here two points at each end.
    let wider = csv(
        "travel / mm,force / N",
        own.iter().map(|[x, y]| [1e3 * x + 2.5, *y]).chain([[2.0, 0.0], [2.1, 0.0], [16.3, 0.0], [16.4, 0.0]]),
    );
    let study = format!("{AXES}x = \"travel / mm\"\ny = \"force / N\"\n[calibrate]\nparameters = {{ \"bench.offset.x\" = {{}} }}\n");
    let found = calibrated(&format!("{example}{study}"), &wider).unwrap();
    assert_eq!((found.points.x.len(), found.points.left_out), (120, 4), "{:?}", found.rows());
    assert!(codes(&found).contains(&"W0901"));
}

/// A point that leads to a zero beyond which it lies, and without which the zero comes back: kept, and told of.
#[test]
fn a_choice_of_points_that_does_not_settle_is_told() {
    // The others say that the bench shows −1 µm at rest; the first point, far below them at 0, moves that by 3 µm to the right.
    let others = (1..=60).map(|i| f64::from(i) * 0.02).map(|x| [x, strip_n(x + 1e-3, 200.0)]);
    let data = csv("travel / mm,force / N", [[0.0, -0.05]].into_iter().chain(others));
    let all = "{ \"material.young_modulus\" = { range = [\"100 GPa\", \"300 GPa\"] }, \"bench.offset.y\" = {} }";
    let found = calibrated(&STRIP.replace(all, "{ \"bench.offset.x\" = {} }"), &data).unwrap();
    assert!(codes(&found).contains(&"W0908") && found.beyond == 1 && found.points.left_out == 0, "{:?} {:?}", codes(&found), found.rows());
}

/// How many points a robust loss plays down, and where.
#[test]
fn points_that_hardly_count_are_told_with_their_places() {
    let mut noise = Noise(8);
    let rows = (0..=80).map(|i| {
        let x = f64::from(i) * 0.0025;
        let far = if (40..43).contains(&i) || i == 60 { 0.5 } else { 0.0 };
        [x, strip_n(x, 187.0) + far + 0.001 * noise.normal()]
    });
    let data = csv("travel / mm,force / N", rows);
    let robust = STRIP.replace("[calibrate]\n", "[calibrate]\nloss = \"tukey\"\n");
    let found = calibrated(&robust, &data).unwrap();
    let far = found.hardly_counting().unwrap();
    assert!(far.starts_with("4 of 81 points hardly count") && far.contains("3 from 0.1 mm to 0.105 mm, at 0.15 mm"), "{far}");
    assert!(found.page("a.toml", "x").contains("4 of 81 points hardly count") && found.document()["hardly_counting"] == 4);
    assert!(calibrated(STRIP, &strip_csv(187.0, 0.001, 1)).unwrap().hardly_counting().is_none());
}

/// A number that is 0 in the file has the size that moves the curve, and is found whatever its range.
#[test]
fn a_number_that_is_zero_has_a_size() {
    let example = forcewright::gallery::find("sanchez-2-springs").unwrap().text;
    let [up, down] = [0, 1].map(|k| at_even_places(&curve(example, "force", k), [45e-3, 205e-3], 60));
    let mut noise = Noise(13);
    let data = csv("s / mm,F / N", up.iter().chain(down.iter().rev()).map(|[x, y]| [1e3 * x, y + 0.05 * noise.normal()]));
    let without = example.replace("0.032 mm ± 0.008 mm", "0 mm");
    let fitted = |freedom: &str| {
        let study = format!("{AXES}x = \"s / mm\"\ny = \"F / N\"\n[calibrate]\nparameters = {{ \"design.rolling_arm\" = {freedom} }}\n");
        calibrated(&format!("{without}{study}"), &data).unwrap()
    };
    let (free, held) = (fitted("{}"), fitted("{ range = [\"0 mm\", \"0.1 mm\"] }"));
    let [a, b] = [&free, &held].map(|f| f.fit.parameters[0].clone());
    assert!((a.estimate.value - b.estimate.value).abs() < 0.01 * b.error && (a.error / b.error - 1.0).abs() < 0.01, "{a:?} {b:?}");
    assert!(a.estimate.interval.contains(0.032e-3) && free.sound(), "{a:?} {:?}", free.verdict());
}
