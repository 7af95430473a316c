//! The work that users of two-speed transmissions wait for, on the prosthetic hand of the gallery.

use divan::{Bencher, black_box, counter::ItemsCount};
use forcewright::contract::family::Mechanism;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::lavt::{Behaviour, ClosingSettings, Design, Lavt, Spec, Statics, clutch, grasp_with, measure};
use forcewright::{Choices, Loaded, gallery};

fn main() {
    divan::main();
}

fn text() -> &'static str {
    gallery::find("lavt/prosthetic-hand").expect("in the gallery").text
}

fn design() -> Design {
    let mut project = Project::from_text("prosthetic-hand.toml", text(), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Lavt::resolve(&mut spec, &mut project.diagnostics).expect("the example is understood")
}

/// Clutch, statics and the output torque at 100 input torques.
#[divan::bench(sample_count = 200)]
fn characteristic_100(bencher: Bencher<'_, '_>) {
    let design = design();
    let all = |design: &Design| {
        let spring = clutch(&design.built, design.source).expect("a spring");
        let statics = Statics::new(&design.built, &spring, design.built.friction, 0.0).expect("friction of the file");
        (1..=100).map(|i| statics.output(1e-3 * f64::from(i)).1).sum::<f64>()
    };
    bencher.counter(ItemsCount::new(100_usize)).bench_local(|| all(black_box(&design)));
}

/// The hand that closes, from rest to the grasp.
#[divan::bench(args = [1e-6, 1e-8, 1e-10], sample_count = 100)]
fn closing(bencher: Bencher<'_, '_>, accuracy: f64) {
    let design = design();
    let behaviour = Behaviour::of(&design).expect("a transmission");
    let settings = ClosingSettings { accuracy, ..ClosingSettings::default() };
    bencher.bench_local(|| grasp_with(black_box(&design), &behaviour.statics, &behaviour.clutch, &settings).expect("a closing"));
}

/// Everything that is computed of a transmission, and its metrics.
#[divan::bench(sample_count = 100)]
fn behaviour(bencher: Bencher<'_, '_>) {
    let design = design();
    bencher.bench_local(|| {
        let behaviour = Behaviour::of(black_box(&design)).expect("a transmission");
        measure(&design, &behaviour)
    });
}

/// From the text of a project file to the report.
#[divan::bench(sample_count = 50)]
fn solve_with_report(bencher: Bencher<'_, '_>) {
    bencher.bench_local(|| {
        let loaded = Loaded::from_text("prosthetic-hand.toml", black_box(text()), &Choices::default())
            .map_err(|e| e.render(false))
            .expect("understood");
        let report = loaded.solve("prosthetic-hand.toml", "", &mut |_| true);
        forcewright::report::html::page(&report)
    });
}
