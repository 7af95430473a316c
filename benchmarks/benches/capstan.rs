//! The work that users of cable drives wait for, on the grooved five-to-one drive of the gallery.

use divan::{Bencher, black_box, counter::ItemsCount};
use forcewright::capstan::{Behaviour, Capstan, Design, Spec, Statics, measure};
use forcewright::contract::family::Mechanism;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::{Choices, Loaded, gallery};

fn main() {
    divan::main();
}

fn text() -> &'static str {
    gallery::find("capstan/longval").expect("in the gallery").text
}

fn design() -> Design {
    let mut project = Project::from_text("longval.toml", text(), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Capstan::resolve(&mut spec, &mut project.diagnostics).expect("the example is understood")
}

fn statics(design: &Design) -> Statics {
    let geometry = design.built.geometry().expect("a drive");
    let place = design.built.place(&geometry, design.built.middle_rad());
    Statics::new(&design.built, &place, design.source).expect("a drive")
}

/// Tensions, slip angles, turn and stiffness under 100 torques.
#[divan::bench(sample_count = 200)]
fn states_100(bencher: Bencher<'_, '_>) {
    let statics = statics(&design());
    let sum = |statics: &Statics| (1..=100).map(|i| statics.under(0.1 * f64::from(i)).expect("held").turn_rad).sum::<f64>();
    bencher.counter(ItemsCount::new(100_usize)).bench_local(|| sum(black_box(&statics)));
}

/// The closed loop between 10 N·m both ways, from rest, with 400 points.
#[divan::bench(sample_count = 200)]
fn loop_400(bencher: Bencher<'_, '_>) {
    let statics = statics(&design());
    bencher.bench_local(|| black_box(&statics).cycle(10.0, 133).expect("held"));
}

/// A drive made of its numbers.
#[divan::bench(sample_count = 200)]
fn prepare(bencher: Bencher<'_, '_>) {
    let design = design();
    bencher.bench_local(|| statics(black_box(&design)));
}

/// Neighbouring turns over the whole travel.
#[divan::bench(sample_count = 100)]
fn occupancy(bencher: Bencher<'_, '_>) {
    let geometry = design().built.geometry().expect("a drive");
    bencher.bench_local(|| black_box(&geometry).occupancy());
}

/// Everything that is computed of a drive, and its metrics.
#[divan::bench(sample_count = 100)]
fn behaviour(bencher: Bencher<'_, '_>) {
    let design = design();
    bencher.bench_local(|| {
        let behaviour = Behaviour::of(black_box(&design)).expect("a drive");
        measure(&design, &behaviour)
    });
}

/// From the text of a project file to the report.
#[divan::bench(sample_count = 50)]
fn solve_with_report(bencher: Bencher<'_, '_>) {
    bencher.bench_local(|| {
        let loaded =
            Loaded::from_text("longval.toml", black_box(text()), &Choices::default()).map_err(|e| e.render(false)).expect("understood");
        let report = loaded.solve("longval.toml", "", &mut |_| true);
        forcewright::report::html::page(&report)
    });
}
