//! The work that users of cam mechanisms wait for, on the prototype with two springs of Sánchez-Salinas et al. 2022.

use divan::{Bencher, black_box, counter::ItemsCount};
use forcewright::cam::{Behaviour, Cam, Design, Drive, Kind, Pose, ProfileInfluence, RandomProfile, Sense, Spec};
use forcewright::contract::family::Mechanism;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::{Choices, Loaded, ToleranceChoices, gallery};

fn main() {
    divan::main();
}

fn text() -> &'static str {
    gallery::find("cam/sanchez-2-springs").expect("in the gallery").text
}

fn design() -> Design {
    let mut project = Project::from_text("sanchez-2-springs.toml", text(), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Cam::resolve(&mut spec, &mut project.diagnostics).and_then(Kind::slider).expect("the example is understood")
}

/// Even travels over the stroke without its undercut start.
fn travels(count: u32) -> Vec<f64> {
    (0..count).map(|i| 0.02 + 0.2 * f64::from(i) / f64::from(count - 1)).collect()
}

/// Forces at rest without friction, up and down at 1000 travels, on a cam that is there.
#[divan::bench(sample_count = 200)]
fn curve_1000(bencher: Bencher<'_, '_>) {
    let design = design();
    let (mechanism, travels_m, mut forces) = (design.mechanism(&design.cut().expect("a cam")), travels(1000), Vec::new());
    bencher.bench_local(|| black_box(&mechanism).rest_forces(&travels_m, &mut forces).expect("assembles"));
}

/// Error of the paper's process: 0.023 mm, correlated over 10.5 mm.
fn error(seed: u64) -> RandomProfile {
    RandomProfile { deviation_m: 23e-6, correlation_m: 10.5e-3, seed }
}

/// Draws of a random error of both profiles, with the forces of 200 travels each: in full, on the paths of a cam that was cut once.
#[divan::bench(sample_count = 50)]
fn random_profiles_full(bencher: Bencher<'_, '_>) {
    let mut design = design();
    let paths = design.paths(&design.cut().expect("a cam"));
    let (travels_m, mut forces, mut seed) = (travels(200), Vec::new(), 0);
    bencher.counter(ItemsCount::new(20_usize)).bench_local(|| {
        for _ in 0..20 {
            seed += 1;
            design.built.random = Some(error(seed));
            design.mechanism_on(black_box(&paths)).rest_forces(&travels_m, &mut forces).expect("assembles");
        }
        forces.last().copied()
    });
}

/// The same draws to first order.
#[divan::bench(sample_count = 50)]
fn random_profiles_linearised(bencher: Bencher<'_, '_>) {
    let design = design();
    let mechanism = design.mechanism(&design.cut().expect("a cam"));
    let influence = ProfileInfluence::new(&mechanism, &travels(200)).expect("assembles");
    let (mut forces, mut seed) = (Vec::new(), 0);
    bencher.counter(ItemsCount::new(200_usize)).bench_local(|| {
        for _ in 0..200 {
            seed += 1;
            black_box(&influence).random_n(&error(seed), &mut forces);
        }
        forces.last().copied()
    });
}

/// Forces of the cycloidal rise at 1000 even instants by the reduced model.
#[divan::bench(sample_count = 200)]
fn motion_1000_steps(bencher: Bencher<'_, '_>) {
    let design = design();
    let mechanism = design.mechanism(&design.cut().expect("a cam"));
    let motion = design.motion.expect("the example moves");
    bencher.bench_local(|| {
        let mut near: Option<Pose> = None;
        let force = |i: u32| {
            let [s, v, a] = motion.at(f64::from(i) / 1000.0);
            let pose = near.insert(mechanism.pose_near([s, 0.0], near.as_ref()).expect("assembles"));
            let drive = Drive { at: [s, 0.0], velocity: [v, 0.0], acceleration: [a, 0.0] };
            black_box(&mechanism).forces(pose, &drive, Sense::Up).force_n
        };
        (0..=1000).map(force).fold(0.0, f64::max)
    });
}

/// Everything at the stations of a report, with the motion.
#[divan::bench(sample_count = 50)]
fn behaviour(bencher: Bencher<'_, '_>) {
    let design = design();
    bencher.bench_local(|| Behaviour::of(black_box(&design)).expect("a cam"));
}

/// Everything that `forcewright solve` does but writing files: reading, solving, checking, the page.
#[divan::bench(sample_count = 30)]
fn solve_with_report() -> String {
    let loaded = Loaded::from_text("sanchez-2-springs.toml", black_box(text()), &Choices::default());
    let loaded = loaded.map_err(|e| e.render(false)).expect("understood");
    let report = loaded.solve("sanchez-2-springs.toml", "", &mut |_| true);
    forcewright::report::html::page(&report)
}

/// A whole tolerance study of 4096 designs whose springs and rolling resistance scatter; items are designs per second, on all cores.
#[divan::bench(sample_count = 3)]
fn tolerance_4096(bencher: Bencher<'_, '_>) {
    let project = Loaded::from_text("sanchez-2-springs.toml", text(), &Choices::default());
    let project = project.unwrap_or_else(|refused| panic!("{}", refused.render(false)));
    let choices = ToleranceChoices { samples: Some(4096), ..ToleranceChoices::default() };
    bencher.counter(ItemsCount::new(4096_usize)).bench_local(|| {
        let found = project.tolerance(choices, &mut |_| true).unwrap_or_else(|error| panic!("{error}"));
        found.study.all.estimate.value
    });
}

/// A million linearised designs, beside 64 in full.
#[divan::bench(sample_count = 1)]
fn linearised_1e6(bencher: Bencher<'_, '_>) {
    let loaded = Loaded::from_text("sanchez-2-springs.toml", text(), &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let choices = ToleranceChoices { samples: Some(64), linear: Some(1_000_000), ..ToleranceChoices::default() };
    bencher.bench_local(|| loaded.tolerance(choices, &mut |_| true).expect("it scatters"));
}
