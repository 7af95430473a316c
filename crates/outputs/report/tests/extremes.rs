//! Whatever a solver may hand over, the outputs answer: no panic, well-formed, texts apart.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

#[allow(unreachable_pub, dead_code, reason = "shared; this file needs a part of it")]
mod fixture;

use forcewright_model::{
    BarRow, ColourScale, Figure, FigureContent, HorizontalLine, Item, Look, Marker, Plot, Role, Scene, Series, Stroke, SupportKind,
    VerticalSpan,
};
use forcewright_report::svg::{self, Drawing, PlotSize, Rect, SceneSize};
use forcewright_report::{csv, html, json};
use roxmltree::Document;

const NUMBERS: [f64; 12] =
    [0.0, -0.0, 1.0, -3.5, 1e-300, 1e300, -1e300, f64::MAX, f64::MIN_POSITIVE, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn sound(drawing: &Drawing) {
    Document::parse(&drawing.svg).unwrap();
    assert!(!drawing.svg.contains("NaN") && !drawing.svg.contains("inf "));
    let all = Rect { x0: 0.0, y0: 0.0, x1: drawing.width, y1: drawing.height };
    for (i, a) in drawing.texts.iter().enumerate() {
        assert!(all.contains(&a.rect), "outside: {a:?}");
        assert!(drawing.texts[i + 1..].iter().all(|b| !a.rect.overlaps(&b.rect)), "{a:?}");
    }
}

fn plot_of(x: Vec<f64>, y: Vec<f64>) -> Plot {
    let mut plot = fixture::force_plot();
    plot.bands.clear();
    plot.spans.clear();
    plot.markers.clear();
    plot.series = vec![Series { label: "line".to_owned(), x, y, stroke: Stroke::Second }];
    plot
}

#[test]
fn plots_of_nothing_one_point_and_constants() {
    for (x, y) in [
        (vec![], vec![]),
        (vec![1.0], vec![2.0]),
        (vec![f64::NAN], vec![1.0]),
        (vec![0.0, 1.0, 2.0], vec![5.0; 3]),
        (vec![3.0; 3], vec![0.0, 1.0, 2.0]),
        (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, f64::NAN, 1.0, f64::INFINITY, 2.0]),
        (vec![0.0, 1.0], vec![]),
        (vec![0.0; 4], vec![0.0; 4]),
    ] {
        sound(&svg::draw_plot(&plot_of(x, y), PlotSize::default()));
    }
    let mut empty = plot_of(vec![], vec![]);
    empty.series.clear();
    empty.x.label.clear();
    sound(&svg::draw_plot(&empty, PlotSize::default()));
}

#[test]
fn plots_of_huge_and_tiny_numbers() {
    for a in NUMBERS {
        for b in NUMBERS {
            let mut plot = plot_of(vec![a, b, 1.0], vec![b, a, 1.0]);
            plot.levels = vec![HorizontalLine { at: a, label: "level".to_owned(), stroke: Stroke::Limit }];
            plot.spans = vec![VerticalSpan { from: a, to: b, label: "span".to_owned(), hatched: false }];
            plot.markers = vec![Marker { x: a, y: b, label: "m".to_owned(), note: "m = 1".to_owned() }];
            sound(&svg::draw_plot(&plot, PlotSize::default()));
        }
    }
}

#[test]
fn crowds_and_long_texts() {
    let long = "an unreasonably long text that goes on and on without any thought for the width of the page ".repeat(4);
    let mut plot = fixture::force_plot();
    for i in 0..60 {
        let (x, y) = (f64::from(i % 8) * 1e-3, f64::from(i / 8));
        plot.markers.push(Marker { x, y, label: format!("point {i}"), note: if i == 3 { long.clone() } else { String::new() } });
        plot.spans.push(VerticalSpan { from: x, to: x + 1e-3, label: format!("span {i}"), hatched: i % 2 == 0 });
        plot.levels.push(HorizontalLine { at: 0.3 * f64::from(i), label: format!("level {i} {long}"), stroke: Stroke::Limit });
    }
    plot.x.label = long.clone();
    plot.y.label = "x".repeat(400);
    plot.series[0].label = long.clone();
    sound(&svg::draw_plot(&plot, PlotSize { width: 500.0, height: 300.0 }));

    let mut scene = fixture::scene();
    for i in 0..60 {
        scene.items.push(Item::Label { at: [0.0, f64::from(i % 5) * 1e-3], text: format!("label {i}") });
    }
    scene.items.push(Item::Marker { at: [0.0, 0.0], label: long.clone() });
    if let Some(scale) = &mut scene.scale {
        scale.label.clone_from(&long);
        scale.limit = Some((1e9, long));
    }
    sound(&svg::draw_scene(&scene, SceneSize::default()));
}

#[test]
fn scenes_of_anything() {
    let empty =
        Scene { items: vec![], scale: None, words: ["as made", "under load"], display: fixture::unit("mm"), description: String::new() };
    sound(&svg::draw_scene(&empty, SceneSize::default()));
    for a in NUMBERS {
        for b in NUMBERS {
            let at = [a, b];
            let kind = SupportKind::Slider { direction: at, rotates: a > 0.0 };
            let scale =
                ColourScale { label: "σ".to_owned(), display: fixture::unit("MPa"), max: a, limit: Some((b, "allowable".to_owned())) };
            let line = |values| Item::Line { points: vec![[0.0, 0.0], at, [b, a]], width_m: a, role: Role::Deformed, values };
            let scene = Scene {
                items: vec![
                    line(Some(vec![a, b])),
                    line(None),
                    Item::Body { corners: vec![at, [b, b]], role: Role::Undeformed },
                    Item::Body { corners: vec![at, [b, b], [b, 1.0]], role: Role::Named(Look::Plate, "plate") },
                    Item::Disc { centre: at, radius_m: b, role: Role::Named(Look::Moving, "roller") },
                    Item::Support { at, kind, outward: [a, a] },
                    Item::Support { at, kind: SupportKind::Pinned, outward: [b, 0.0] },
                    Item::Arrow { from: at, to: [b, a], label: "F".to_owned() },
                    Item::Label { at, text: "n1".to_owned() },
                    Item::Marker { at, label: "max".to_owned() },
                ],
                scale: Some(scale),
                words: ["as made", "under load"],
                display: fixture::unit("mm"),
                description: String::new(),
            };
            sound(&svg::draw_scene(&scene, SceneSize::default()));
        }
    }
}

#[test]
fn films_and_bars_of_anything() {
    let figure = |content| Figure { id: "any", title: String::new(), caption: String::new(), content };
    for a in NUMBERS {
        for b in NUMBERS {
            let mut film = fixture::film();
            film.frames.truncate(3);
            film.frames[0].at = a;
            film.frames[1].items.push(Item::Disc { centre: [a, b], radius_m: a, role: Role::Deformed });
            film.frames[2].note = "x".repeat(300);
            for chosen in 0..4 {
                film.chosen = chosen;
                sound(&svg::draw_figure(&figure(FigureContent::Film(film.clone()))));
            }
            let mut bars = fixture::bars();
            bars.rows.push(BarRow { label: "short of ends".to_owned(), ends: vec![[a, b]] });
            bars.rows.push(BarRow { label: String::new(), ends: Vec::new() });
            sound(&svg::draw_figure(&figure(FigureContent::Bars(bars.clone()))));
            bars.series.clear();
            bars.rows.truncate(1);
            sound(&svg::draw_figure(&figure(FigureContent::Bars(bars))));
        }
    }
}

#[test]
fn a_report_full_of_nonsense() {
    let mut report = fixture::report();
    for (i, metric) in report.outcome.metrics.iter_mut().enumerate() {
        metric.value = NUMBERS[i % NUMBERS.len()];
    }
    for (i, check) in report.outcome.checks.iter_mut().enumerate() {
        check.value = Some(NUMBERS[(i + 5) % NUMBERS.len()]);
        check.margin = Some(NUMBERS[(i + 4) % NUMBERS.len()]);
    }
    for curve in &mut report.outcome.curves {
        curve.branches.clear();
    }
    report.outcome.error_estimate = Some(f64::NAN);
    html::page(&report);
    csv::curves(&report.outcome);
    let text = json::document(&report.outcome, "", "").to_string();
    assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok());
}
