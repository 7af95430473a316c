//! The figures of a report: what moves, what is drawn, and what the tolerances do, against closed forms.

use forcewright_base::maths;
use forcewright_base::units::{Unit, format_si};
use forcewright_cam::Cam;
use forcewright_contract::family::{Analysis, Entry, Family as _};
use forcewright_contract::project::{Choices, Project};
use forcewright_model::{Bars, FigureContent, Film, Item, Look, Plot, Role};

const PAPER: &str = include_str!("../../../../examples/cam/sanchez-2-springs.toml");
const PUSH: &str = include_str!("../../../../examples/cam/push-springs.toml");
const COMPENSATED: &str = include_str!("../../../../examples/cam/compensated.toml");
const NO_UNDERCUT: &str = include_str!("../../../../examples/cam/no-undercut.toml");

fn analysed(text: &str) -> Analysis {
    let mut project = Project::from_text("test.toml", text, &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project).expect("an example");
    understood.analyse(&mut |_| true)
}

fn content(analysis: &Analysis, id: &str) -> Option<FigureContent> {
    analysis.figures.iter().find(|f| f.id == id).map(|f| f.content.clone())
}

fn film(analysis: &Analysis) -> Film {
    match content(analysis, "mechanism") {
        Some(FigureContent::Film(film)) => film,
        _ => panic!("the mechanism moves"),
    }
}

fn force(analysis: &Analysis) -> Plot {
    match content(analysis, "force") {
        Some(FigureContent::Plot(plot)) => plot,
        _ => panic!("the force is a plot"),
    }
}

fn sensitivity(analysis: &Analysis) -> Bars {
    match content(analysis, "sensitivity") {
        Some(FigureContent::Bars(bars)) => bars,
        _ => panic!("tolerances have bars"),
    }
}

fn discs(items: &[Item]) -> Vec<[f64; 3]> {
    let rollers = items.iter().filter_map(|i| match i {
        Item::Disc { centre, radius_m, role: Role::Named(Look::Moving, "rollers") } => Some([centre[0], centre[1], *radius_m]),
        _ => None,
    });
    rollers.collect()
}

fn plates(items: &[Item]) -> Vec<Vec<[f64; 2]>> {
    let plates = items.iter().filter_map(|i| match i {
        Item::Body { corners, role: Role::Named(Look::Plate, "cam") } => Some(corners.clone()),
        _ => None,
    });
    plates.collect()
}

/// Distance of a point from a closed polygon.
fn distance(polygon: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let ends = polygon.iter().skip(1).chain(polygon.first());
    let one = |(a, b): (&[f64; 2], &[f64; 2])| {
        let d = [b[0] - a[0], b[1] - a[1]];
        let t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
        let t = t.clamp(0.0, 1.0);
        maths::hypot(p[0] - a[0] - t * d[0], p[1] - a[1] - t * d[1])
    };
    polygon.iter().zip(ends).map(one).fold(f64::INFINITY, f64::min)
}

#[test]
fn rollers_touch_the_cam_and_braces_keep_their_length_in_every_frame() {
    for (text, plates_drawn, brace_m, stroke_m) in [(PAPER, 1, 0.2, 0.24), (PUSH, 2, 0.12, 0.08), (NO_UNDERCUT, 1, 0.2, 0.23)] {
        let film = film(&analysed(text));
        let cams = plates(&film.stage.items);
        assert_eq!((film.frames.len(), film.chosen, cams.len()), (25, 12, plates_drawn));
        assert!(film.frames[0].at < 0.01 * stroke_m && (film.frames[24].at - stroke_m).abs() < 1e-12);
        assert!(film.frames.windows(2).all(|w| w[1].at > w[0].at));
        for frame in &film.frames {
            let rollers = discs(&frame.items);
            assert_eq!(rollers.len(), 2);
            assert!((rollers[0][0] + rollers[1][0]).abs() < 1e-12 && rollers[0][0] > 0.0, "right, left");
            for [x, y, r] in rollers {
                let nearest = cams.iter().map(|cam| distance(cam, [x, y])).fold(f64::INFINITY, f64::min);
                // Chords of the drawn profile lie within it by less than a hundredth of the roller.
                assert!((nearest / r - 1.0).abs() < 0.01, "{nearest} of {r} at {}", frame.at);
            }
            for item in &frame.items {
                if let Item::Line { points, role: Role::Named(Look::Bar, _), .. } = item {
                    let length = maths::hypot(points[1][0] - points[0][0], points[1][1] - points[0][1]);
                    assert!((length - brace_m).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn each_frame_says_its_force() {
    let analysis = analysed(COMPENSATED);
    let newton = Unit::parse("N").expect("a unit");
    // Cut for the friction: up, the force is the one wanted.
    for frame in &film(&analysis).frames[1..] {
        assert!(frame.note.contains(&format!("{} up", format_si(50.0, &newton, 4))), "{}", frame.note);
    }
    let free = NO_UNDERCUT.replace("[parts]", "[motion]\nguide = \"free\"\n\n[errors]\nprofile_offset_right = \"0.2 mm\"\n\n[parts]");
    let film = film(&analysed(&free));
    assert!(film.frames.iter().all(|f| f.note.contains(", slider ") && f.note.ends_with(" right")));
    assert!(!film.stage.items.iter().any(|i| matches!(i, Item::Line { role: Role::Named(Look::Rail, _), .. })), "no guide is drawn");
}

#[test]
fn the_force_is_seen_with_its_band_and_not_with_the_corner() {
    let plot = force(&analysed(PAPER));
    let all: Vec<f64> = plot.series.iter().flat_map(|s| s.y.iter().copied()).collect();
    let (low, high) = all.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), y| (a.min(*y), b.max(*y)));
    let band = &plot.bands[0];
    assert!(low > band.from - 0.3 * (band.to - band.from) && high < band.to + 0.3 * (band.to - band.from), "{low} to {high}");
    // Nothing of the window is lost.
    for s in plot.series.iter().filter(|s| s.label == "up" || s.label == "down") {
        let inside = s.x.iter().filter(|x| (0.04..=0.21).contains(*x)).count();
        assert_eq!(inside, 341, "480 intervals of 0.5 mm");
        assert!(s.x.windows(2).all(|w| w[0] < w[1]));
    }
    let area = &plot.series[0];
    assert_eq!(area.label, "lost in a cycle");
    // The area of the region is the loss of the result (shoelace formula, clockwise).
    let n = area.x.len();
    let twice: f64 = (0..n).map(|i| area.x[(i + 1) % n] * area.y[i] - area.x[i] * area.y[(i + 1) % n]).sum();
    let analysis = analysed(PAPER);
    let loss = analysis.outcome.metric("loop_area").expect("a metric").value;
    assert!((0.5 * twice / loss - 1.0).abs() < 1e-5, "{} of {loss}", 0.5 * twice);
}

#[test]
fn tolerances_of_rates_follow_the_closed_form() {
    let bars = sensitivity(&analysed(PAPER));
    let row = |label: &str| bars.rows.iter().find(|r| r.label.starts_with(label)).unwrap_or_else(|| panic!("{label}")).ends.clone();
    // Without weight all forces are in proportion to those of the springs, and both springs have one length: δF/F = δk/K.
    for name in ["springs.rates.1 ± 0.003 N/mm", "springs.rates.2 ± 0.003 N/mm"] {
        let [lower, upper] = row(name)[0];
        assert!((upper - 0.003 / 1.365).abs() < 1e-9 && (lower + 0.003 / 1.365).abs() < 1e-9, "{lower} {upper}");
    }
    // Friction adds to one direction what it takes from the other, to first order.
    let [mean, deviation] = [row("rolling_arm")[0], row("rolling_arm")[1]];
    assert!(mean.iter().all(|m| m.abs() < 1e-4) && deviation[1] > 0.003 && (deviation[0] + deviation[1]).abs() < 1e-3);
    // Largest first.
    let reach = |r: &forcewright_model::BarRow| r.ends.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(bars.rows.windows(2).all(|w| reach(&w[0]) >= reach(&w[1])) && bars.rows.len() == 4);
    assert!(content(&analysed(COMPENSATED), "sensitivity").is_none(), "no ± in that file");
}

#[test]
fn teeth_of_the_comb_are_as_long_as_the_path_is_curved() {
    for (text, undercut) in [(PAPER, true), (NO_UNDERCUT, false)] {
        let analysis = analysed(text);
        let Some(FigureContent::Scene(scene)) = content(&analysis, "profile") else { panic!("a drawing") };
        let length = |item: &Item| match item {
            Item::Line { points, role: Role::Named(Look::Comb, word), .. } if !word.is_empty() => {
                Some(maths::hypot(points[1][0] - points[0][0], points[1][1] - points[0][1]))
            }
            _ => None,
        };
        let longest = scene.items.iter().filter_map(length).fold(0.0, f64::max);
        let limit = 1.5 * 0.016;
        assert_eq!(longest > limit, undercut);
        assert_eq!(scene.items.iter().any(|i| matches!(i, Item::Marker { .. })), undercut);
        if !undercut {
            // The largest curvature is that of the metric.
            let radius = analysis.outcome.metric("path_curvature_radius_min").expect("a metric").value;
            assert!((longest / limit - 0.016 / radius).abs() < 1e-9);
        }
    }
}

/// At the very start nothing is tense, and the brace stands along the path's normal as friction tilts it: 0/0. Its limit is the force wanted.
#[test]
fn the_start_of_a_compensated_cam_has_its_limit() {
    let outcome = analysed(COMPENSATED).outcome;
    assert!(outcome.requirements_met(), "{:?}", outcome.checks);
    let up = outcome.curves.iter().find(|c| c.name == "force").and_then(|c| c.branches.iter().find(|b| b.name == "up")).expect("the force");
    assert!(up.x[0].abs() < 1e-15, "{}", up.x[0]);
    assert!((up.y[0] - 50.0).abs() < 1e-6, "{}", up.y[0]);
    let numbers = outcome.curves.iter().flat_map(|c| &c.branches).flat_map(|b| b.x.iter().chain(&b.y));
    assert!(numbers.copied().all(f64::is_finite));
}
