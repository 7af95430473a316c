//! Turned parts: what their files hold, against the surface that they are said to have.
#![allow(clippy::unwrap_used, reason = "test code, in helpers too")]

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_curves::Segment;
use forcewright_fabricate::{Error, Format, Options, Place, Problem, write};
use forcewright_model::{Body, Groove, GrooveError, Grooved, Part, Section, Turned, TurnedError};
use proptest::prelude::*;

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;
#[allow(dead_code, clippy::unwrap_used, reason = "test code, shared with other tests")]
mod reading;

use common::drums::{Drum, area_m2, drums, grooved, turned};
use reading::{Mesh, bytes, text};

fn options(facet_error_m: f64) -> Options {
    Options { facet_error_m, ..Options::default() }
}

fn body_of(part: &mut Part) -> &mut Turned {
    match &mut part.body {
        Body::Turned(turned) => turned,
        Body::Plate(_) | Body::Coil(_) => panic!("{} is not turned", part.name),
    }
}

/// Distance of a point, mm, from the profile of grooves in the plane through it and the axis: not less than from the surface.
fn distance(grooved: &Grooved, low_m: f64, [x, y, z]: [f64; 3]) -> f64 {
    let [x, y, z] = [x, y, z].map(|mm| 1e-3 * mm);
    let spacing_m = grooved.spacing_m();
    let along = z - low_m - (maths::atan2(y, x) - grooved.phase_rad) / TAU * grooved.lead_m;
    let begin = grooved.groove.start_m[0];
    let along = begin + (along - begin).rem_euclid(spacing_m);
    let nearest =
        |along: f64| grooved.groove.spans().map(|(from, s)| from_segment([along, maths::hypot(x, y)], from, s)).fold(f64::MAX, f64::min);
    // The neighbours too, for points near the ends of the chain.
    1e3 * [-spacing_m, 0.0, spacing_m].map(|shift| nearest(along + shift)).into_iter().fold(f64::MAX, f64::min)
}

fn from_segment(point: [f64; 2], from: [f64; 2], segment: &Segment) -> f64 {
    let to = segment.end_m();
    let apart = |a: [f64; 2]| maths::hypot(point[0] - a[0], point[1] - a[1]);
    match segment {
        Segment::Arc { centre_m, .. } if point[0] > from[0] && point[0] < to[0] => {
            (apart(*centre_m) - maths::hypot(from[0] - centre_m[0], from[1] - centre_m[1])).abs().min(apart(from)).min(apart(to))
        }
        Segment::Line { .. } => {
            let (u, v) = ([to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]);
            let share = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
            apart([0, 1].map(|k| from[k] + share * u[k]))
        }
        _ => apart(from).min(apart(to)),
    }
}

/// The grooved sections of a part, each with the height of its lower end.
fn sections(part: &Part) -> Vec<(&Grooved, f64)> {
    let turned = part.turned().unwrap();
    turned.sections.iter().zip(turned.steps_m()).filter_map(|(section, low_m)| Some((section.grooved()?, low_m))).collect()
}

#[test]
fn meshes_are_closed_and_hold_the_volume() {
    for Drum { part, volume_m3, surface_m2, .. } in drums() {
        let bores = i64::from(part.turned().unwrap().bore_diameter_m > 0.0);
        assert!((part.volume_m3() / volume_m3 - 1.0).abs() < 1e-13, "{}", part.name);
        assert!((part.mass_kg().unwrap() / (7850.0 * volume_m3) - 1.0).abs() < 1e-13);
        for facet_error_m in [2e-5, 5e-6] {
            let mesh = Mesh::of_stl(&write(&part, Format::Stl, &options(facet_error_m)).unwrap());
            let packed = Mesh::of_3mf(&write(&part, Format::ThreeMf, &options(facet_error_m)).unwrap());
            assert_eq!(mesh.triangles().collect::<Vec<_>>(), packed.triangles().collect::<Vec<_>>(), "{}", part.name);
            mesh.check_closed(&part.name);
            assert_eq!(mesh.euler(), 2 - 2 * bores, "{}", part.name);
            let error = mesh.volume_mm3() - volume_m3 * 1e9;
            assert!(error.abs() < (facet_error_m * 1e3 + 1e-5) * surface_m2 * 1e6, "{}: {error}", part.name);
        }
    }
}

/// Corners, middles of sides and of triangles of grooves are as near to the true surface as was promised, and somewhere hardly nearer.
#[test]
fn facets_lie_as_near_as_promised() {
    for facet_error_m in [5e-5, 2e-5] {
        let mut worst: f64 = 0.0;
        for Drum { part, .. } in drums() {
            let mesh = Mesh::of_stl(&write(&part, Format::Stl, &options(facet_error_m)).unwrap());
            for (grooved, low_m) in sections(&part) {
                let [low, high] = [low_m, low_m + grooved.length_m].map(|m| 1e3 * m);
                let is_side = |corners: &[[f64; 3]; 3]| {
                    let flat = corners.iter().all(|c| (c[2] - corners[0][2]).abs() < 1e-6);
                    !flat && corners.iter().all(|c| c[2] > low - 1e-5 && c[2] < high + 1e-5)
                };
                let near_groove = |c: &[f64; 3]| maths::hypot(c[0], c[1]) > 1e3 * grooved.groove.radii_m()[0] - 0.1;
                for corners in mesh.triangles().map(|t| t.map(|c| c.map(f64::from))).filter(is_side) {
                    let [a, b, c] = corners;
                    if !corners.iter().all(near_groove) {
                        continue;
                    }
                    let mean = |weights: [f64; 3]| [0, 1, 2].map(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k]);
                    for weights in [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
                        worst = worst.max(distance(grooved, low_m, mean(weights)));
                    }
                }
            }
        }
        let allowed = 1e3 * facet_error_m + 1e-5;
        assert!(worst <= allowed && worst > 0.3 * allowed, "{worst} mm, allowed {allowed} mm");
    }
}

/// The area of a cut across a mesh: half the sum over the chords in which triangles meet the plane.
fn cut(mesh: &Mesh, z: f64) -> f64 {
    let mut twice = 0.0;
    for corners in mesh.triangles().map(|t| t.map(|c| c.map(f64::from))) {
        let mut ends: [Option<[f64; 2]>; 2] = [None; 2];
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if (a[2] < z) != (b[2] < z) {
                let share = (z - a[2]) / (b[2] - a[2]);
                // Downwards on its left side, upwards on its right: seen from above the material is to the left.
                ends[usize::from(a[2] < z)] = Some([0, 1].map(|k| a[k] + share * (b[k] - a[k])));
            }
        }
        if let [Some(from), Some(to)] = ends {
            twice += from[0] * to[1] - to[0] * from[1];
        }
    }
    0.5 * twice
}

#[test]
fn cuts_across_a_section_have_one_area() {
    for Drum { part, .. } in drums() {
        let mesh = Mesh::of_stl(&bytes(&part, Format::Stl));
        let turned = part.turned().unwrap();
        let bore = std::f64::consts::PI * 0.25e6 * turned.bore_diameter_m * turned.bore_diameter_m;
        for (section, low_m) in turned.sections.iter().zip(turned.steps_m()) {
            let exact = area_m2(section) * 1e6 - bore;
            for share in [0.013, 0.31, 0.777, 0.99] {
                let area = cut(&mesh, 1e3 * (low_m + share * section.length_m()));
                // The boundary of the cut is at most four times as long as around the lands.
                let strip = 0.005 * 4.0 * TAU * section.radii_m()[1] * 1e3;
                assert!((area - exact).abs() < strip && (area / exact - 1.0).abs() < 2e-3, "{}: {area} for {exact}", part.name);
            }
        }
    }
}

/// Control points of a surface, row by row, by the numbers of entities.
fn net<'a>(step: &reading::Step<'a>, surface: &'a str) -> Vec<Vec<[f64; 3]>> {
    let inside = surface.split_once("((").and_then(|(_, rest)| rest.split_once("))")).unwrap().0;
    let point = |id: &str| -> [f64; 3] {
        let list = step.entity(id).split_once(",(").unwrap().1.trim_end_matches(')');
        let numbers: Vec<f64> = list.split(',').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    inside.split("),(").map(|row| row.split(',').map(point).collect()).collect()
}

/// The textbook sum over basis functions of degree 5 with clamped knots 0, 1, 2, … (Cox and de Boor).
fn basis(count: usize, i: usize, degree: usize, t: f64) -> f64 {
    let last = count - 5;
    let knot = |k: usize| k.saturating_sub(5).min(last) as f64;
    if degree == 0 {
        return f64::from(u8::from(knot(i) <= t && t < knot(i + 1)));
    }
    let share = |above: f64, span: f64, lower: usize| if span > 0.0 { above / span * basis(count, lower, degree - 1, t) } else { 0.0 };
    share(t - knot(i), knot(i + degree) - knot(i), i) + share(knot(i + degree + 1) - t, knot(i + degree + 1) - knot(i + 1), i + 1)
}

/// 10⁻⁷ mm, and what twelve decimals leave.
#[test]
fn surfaces_of_solids_follow_the_helices() {
    let mut worst: f64 = 0.0;
    for Drum { part, .. } in drums() {
        let file = text(&part, Format::Step);
        let step = reading::Step::new(&file);
        let surfaces = step.of_kind("B_SPLINE_SURFACE_WITH_KNOTS");
        let all = sections(&part);
        let strips: usize = all.iter().map(|(g, _)| usize::try_from(g.starts).unwrap() * g.groove.segments.len()).sum();
        assert_eq!(surfaces.len(), strips);
        for surface in surfaces {
            let net = net(&step, surface);
            let (rows, columns) = (net.len(), net[0].len());
            for (k, l) in (0..24).flat_map(|k| (0..24).map(move |l| (k, l))) {
                let share = |k: i32, seed: f64| (f64::from(k) * 0.618_033_988_75 + seed).fract() * 0.999_999;
                let (u, v) = (share(k, 0.1) * (rows - 5) as f64, share(l, 0.3) * (columns - 5) as f64);
                let weights = |count: usize, t: f64| -> Vec<(usize, f64)> {
                    (0..count)
                        .map(|i| (i, if (i as f64 - t).abs() < 8.0 { basis(count, i, 5, t) } else { 0.0 }))
                        .filter(|w| w.1 > 0.0)
                        .collect()
                };
                let across = weights(columns, v);
                let mut point = [0.0; 3];
                for (i, a) in weights(rows, u) {
                    for &(j, b) in &across {
                        (0..3).for_each(|axis| point[axis] += a * b * net[i][j][axis]);
                    }
                }
                let of_section = |(g, low_m): &(&Grooved, f64)| {
                    (point[2] * 1e-3 >= low_m - 1e-9 && point[2] * 1e-3 <= low_m + g.length_m + 1e-9).then(|| distance(g, *low_m, point))
                };
                worst = worst.max(all.iter().filter_map(of_section).fold(f64::MAX, f64::min));
            }
        }
    }
    assert!(worst <= 1e-7 && worst > 1e-9, "{worst} mm");
}

#[test]
fn solids_are_closed_shells_of_the_right_genus() {
    for Drum { part, faces, .. } in drums() {
        let file = text(&part, Format::Step);
        let step = reading::Step::new(&file);
        assert_eq!((step.of_kind("MANIFOLD_SOLID_BREP").len(), step.of_kind("CLOSED_SHELL").len()), (1, 1));
        assert_eq!(step.of_kind("ADVANCED_FACE").len(), faces, "{}", part.name);
        let oriented = step.of_kind("ORIENTED_EDGE");
        let passed: BTreeSet<(&str, bool)> =
            oriented.iter().map(|entity| (*reading::references(entity).last().unwrap(), entity.ends_with(".T.)"))).collect();
        let edges = step.of_kind("EDGE_CURVE").len();
        assert_eq!((oriented.len(), passed.len()), (2 * edges, 2 * edges), "{}", part.name);
        let count = |kind| i64::try_from(step.of_kind(kind).len()).unwrap();
        let characteristic = count("VERTEX_POINT") - count("EDGE_CURVE") + count("ADVANCED_FACE") - count("FACE_BOUND");
        assert_eq!(characteristic, 2 - 2 * i64::from(part.turned().unwrap().bore_diameter_m > 0.0), "{}", part.name);
    }
}

/// The corners of a mesh as numbers to be compared, in an order of their own.
fn corners(mesh: &Mesh, change: impl Fn([f32; 3]) -> [f32; 3]) -> BTreeSet<[u32; 3]> {
    // Without a sign of zero.
    mesh.triangles().flatten().map(|corner| change(corner).map(|x| (x + 0.0).to_bits())).collect()
}

#[test]
fn the_other_hand_is_the_mirror_image() {
    for Drum { part, .. } in drums() {
        let mut other = part.clone();
        for section in &mut body_of(&mut other).sections {
            if let Section::Grooved(grooved) = section {
                (grooved.lead_m, grooved.phase_rad) = (-grooved.lead_m, -grooved.phase_rad);
            }
        }
        let [mesh, image] = [&part, &other].map(|part| Mesh::of_stl(&bytes(part, Format::Stl)));
        let grooves = |corner: &[u32; 3]| {
            sections(&part).iter().any(|(g, low_m)| {
                let [x, y, z] = corner.map(|bits| f64::from(f32::from_bits(bits)));
                let height = 1e-3 * z - low_m;
                height > 1e-9 && height < g.length_m - 1e-9 && 1e-3 * maths::hypot(x, y) > g.groove.radii_m()[0] - 1e-5
            })
        };
        let ours: BTreeSet<_> = corners(&mesh, |c| c).into_iter().filter(grooves).collect();
        let theirs: BTreeSet<_> = corners(&image, |[x, y, z]| [x, -y, z]).into_iter().filter(grooves).collect();
        assert!(ours.len() > 1000 && ours == theirs, "{}: {} and {}", part.name, ours.len(), theirs.len());
        assert!((mesh.volume_mm3() / image.volume_mm3() - 1.0).abs() < 1e-7);
        assert_ne!(corners(&mesh, |c| c), corners(&image, |c| c), "{}", part.name);
    }
}

/// Twice as large with twice the error is the same mesh, exactly twice as large.
#[test]
fn meshes_scale() {
    let groove = |size: f64| Groove::round(0.018 * size, 3e-3 * size, 1.05e-3 * size, 0.8e-3 * size).unwrap();
    let of_size = |size: f64| {
        let sections = vec![
            grooved(0.012 * size, 6e-3 * size, 2, 0.3, groove(size)),
            Section::Plain { length_m: 0.002 * size, radius_m: 0.02 * size },
        ];
        Mesh::of_stl(&write(&turned("scaled", 0.008 * size, sections), Format::Stl, &options(5e-6 * size)).unwrap())
    };
    let (one, two) = (of_size(1.0), of_size(2.0));
    let doubled: Vec<_> = one.triangles().map(|t| t.map(|c| c.map(|x| 2.0 * x))).collect();
    assert_eq!(doubled, two.triangles().collect::<Vec<_>>());
}

#[test]
fn drawings_show_half_the_section() {
    for Drum { part, .. } in drums() {
        let half = part.turned().unwrap().half_section(0.0).unwrap();
        let drawing = text(&part, Format::Dxf);
        let (polylines, radii) = reading::dxf(&drawing);
        assert_eq!((polylines.len(), radii.len()), (1, 0));
        assert!((reading::area_of_bulges(&polylines[0]) / (half.area_m2() * 1e6) - 1.0).abs() < 1e-9, "{}", part.name);
        assert!(drawing.contains("CENTRE") && drawing.contains("not cut into the solid: end of the cable"));
        let picture = text(&part, Format::Svg);
        let document = roxmltree::Document::parse(&picture).unwrap();
        let lines: Vec<_> = document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "line"))).collect();
        assert_eq!((lines.len(), lines[0].attribute("y1"), lines[0].attribute("y2")), (1, Some("0"), Some("0")));
    }
}

#[test]
fn what_cannot_be_turned_is_refused_in_every_format() {
    let sound = drums().remove(0).part;
    let after = |change: &dyn Fn(&mut Turned)| {
        let mut part = sound.clone();
        change(body_of(&mut part));
        let errors: Vec<Error> = Format::ALL.iter().map(|&format| write(&part, format, &Options::default()).unwrap_err()).collect();
        assert!(errors.iter().all(|error| *error == errors[0]), "{errors:?}");
        assert_eq!(errors[0].place, Place::Part);
        match &errors[0].problem {
            Problem::Turned(error) => *error,
            problem => panic!("{problem}"),
        }
    };
    let groove = |turned: &mut Turned, change: &dyn Fn(&mut Grooved)| {
        turned.sections.iter_mut().for_each(|section| match section {
            Section::Grooved(grooved) => change(grooved),
            Section::Plain { .. } => (),
        });
    };
    assert_eq!(after(&|turned| turned.sections.clear()), TurnedError::Empty);
    assert!(matches!(after(&|turned| groove(turned, &|g| g.lead_m = 0.0)), TurnedError::Lead { section: 1, .. }));
    assert!(matches!(after(&|turned| turned.bore_diameter_m = 0.045), TurnedError::Bore { .. }));
    let overlap = |turned: &mut Turned| turned.sections[2] = Section::Plain { length_m: 0.004, radius_m: 0.0245 };
    assert!(matches!(after(&overlap), TurnedError::Step { section: 1, .. }));
    let error = after(&|turned| groove(turned, &|g| g.groove.segments.reverse()));
    assert!(
        matches!(error, TurnedError::Groove { section: 1, error: GrooveError::Backwards { .. } | GrooveError::NotCircular { .. } }),
        "{error}"
    );
}

#[test]
fn formats_of_plates_say_what_else_to_do() {
    let part = drums().remove(0).part;
    let error = write(&part, Format::Inp, &Options::default()).unwrap_err();
    assert_eq!(error.problem, Problem::OnlyPlates { format: Format::Inp });
    assert!(error.to_string().contains("STEP"), "{error}");
    let error = write(&part, Format::Stl, &options(1e-9)).unwrap_err();
    assert!(matches!(error.problem, Problem::TooManyCorners { .. }), "{error}");
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -0.02..0.05, 2 => prop::sample::select(vec![0.0, 0.01, 1e-7, -1.0, 900.0]), 1 => any::<f64>()]
}

fn any_groove() -> impl Strategy<Value = Groove> {
    let segment = ([number(), number()], [number(), number()], 0..3_u8).prop_map(|(to_m, centre_m, kind)| match kind {
        0 => Segment::Line { to_m },
        kind => Segment::Arc { to_m, centre_m, counterclockwise: kind == 1 },
    });
    ([number(), number()], prop::collection::vec(segment, 0..5)).prop_map(|(start_m, segments)| Groove { start_m, segments })
}

fn sound_groove() -> impl Strategy<Value = (f64, Groove)> {
    (0.004..0.03, 0.5e-3..4e-3, 0.2..1.3, 0.1..1.9, 0..3_u8).prop_map(|(radius_m, spacing_m, wide, deep, kind)| {
        let seat_m = 0.4 * wide * spacing_m;
        let groove = match kind {
            0 => Groove::round(radius_m, spacing_m, seat_m, deep * seat_m),
            1 => Groove::vee(radius_m, spacing_m, wide, 0.1 * seat_m, deep * seat_m),
            _ => Groove::undercut(radius_m, spacing_m, [seat_m, deep * seat_m], [0.8 * seat_m, 0.4 * seat_m]),
        };
        (spacing_m, groove.unwrap_or(Groove { start_m: [0.0; 2], segments: Vec::new() }))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn no_turned_part_makes_a_writer_panic(
        groove in any_groove(), lead_m in number(), starts in 0..7_u32, phase_rad in any::<f64>(), sizes in [number(), number(), number(), number()]
    ) {
        let [length_m, bore_m, beside_m, radius_m] = sizes;
        let sections = vec![grooved(length_m, lead_m, starts, phase_rad, groove), Section::Plain { length_m: beside_m, radius_m }];
        let part = turned("any", bore_m, sections);
        for format in Format::ALL {
            let _ = write(&part, format, &options(1e-4));
        }
    }

    #[test]
    fn sound_grooves_are_written_whole(
        (spacing_m, groove) in sound_groove(), starts in 1..7_u32, is_left in any::<bool>(), phase_rad in -10.0..10.0, length in 0.3..9.0
    ) {
        let lead_m = spacing_m * f64::from(starts) * if is_left { -1.0 } else { 1.0 };
        let part = turned("sound", 0.0, vec![grooved(length * spacing_m, lead_m, starts, phase_rad, groove)]);
        let Ok(stl) = write(&part, Format::Stl, &options(2e-5)) else {
            // Grooves without land, or deeper than the axis.
            prop_assert!(part.turned().is_some_and(|turned| turned.check().is_err()));
            return Ok(());
        };
        let mesh = Mesh::of_stl(&stl);
        mesh.check_closed("sound");
        prop_assert_eq!(mesh.euler(), 2);
        let exact = part.volume_m3() * 1e9;
        prop_assert!((mesh.volume_mm3() / exact - 1.0).abs() < 0.02, "{} for {}", mesh.volume_mm3(), exact);
        for format in [Format::Dxf, Format::Svg, Format::Step] {
            prop_assert!(write(&part, format, &Options::default()).is_ok());
        }
    }
}
