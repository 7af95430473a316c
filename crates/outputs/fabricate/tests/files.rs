//! What the files hold, against closed forms and the laws of closed surfaces.

use std::collections::BTreeSet;

use forcewright_curves::Segment;
use forcewright_fabricate::{Format, Options, write};

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;
#[allow(clippy::unwrap_used, reason = "test code")]
mod reading;

use common::{Sample, samples};
use reading::{Mesh, bytes, text};

/// Byte for byte: a change of these files must be meant. Other programs read the samples in `cargo xtask test` and `validate`.
#[test]
fn a_tiny_part_is_written_as_it_always_was() {
    let tiny = samples().remove(0).part;
    assert_eq!(text(&tiny, Format::Dxf), include_str!("golden/tiny.dxf"));
    assert_eq!(text(&tiny, Format::Step), include_str!("golden/tiny.step"));
    assert_eq!(text(&tiny, Format::Svg), include_str!("golden/tiny.svg"));
}

#[test]
fn the_same_part_is_the_same_bytes() {
    for sample in samples() {
        for format in Format::ALL {
            assert_eq!(bytes(&sample.part, format), bytes(&sample.part.clone(), format), "{} {format}", sample.part.name);
        }
    }
}

#[test]
fn areas_within_bulges_are_exact_but_for_splines() {
    for Sample { part, area_m2, .. } in samples() {
        let (polylines, radii) = reading::dxf(&text(&part, Format::Dxf));
        assert_eq!((polylines.len(), radii.len()), (1 + common::plate_of(&part).cutouts.len(), common::plate_of(&part).holes.len()));
        let bulges: f64 = polylines.iter().map(|corners| reading::area_of_bulges(corners)).sum();
        let area = bulges - radii.iter().map(|radius| std::f64::consts::PI * radius * radius).sum::<f64>();
        let has_splines = matches!(part.name.as_str(), "tiny" | "strip" | "blob");
        let error = area / (area_m2 * 1e6) - 1.0;
        assert!(error.abs() < if has_splines { 1e-4 } else { 1e-12 }, "{}: {error:e}", part.name);
    }
}

/// Arcs that stand for splines join without kinks: only corners of the part itself turn.
#[test]
fn arcs_in_the_place_of_splines_have_common_tangents() {
    for (name, corners) in [("strip", 8), ("blob", 3)] {
        let sample = samples().into_iter().find(|sample| sample.part.name == name).unwrap();
        let (polylines, _) = reading::dxf(&text(&sample.part, Format::Dxf));
        let kinks = polylines.iter().map(|corners| reading::kinks(corners, 1e-7)).sum::<usize>();
        assert!(kinks <= corners, "{name}: {kinks} kinks");
        assert!(polylines[0].len() > 40, "{name}: so few arcs cannot follow it");
    }
}

#[test]
fn meshes_are_closed_and_hold_the_volume_that_chords_leave() {
    for Sample { part, area_m2, boundary_m, .. } in samples() {
        let mut errors = Vec::new();
        for facet_error_m in [2e-5, 5e-6] {
            let options = Options { facet_error_m, ..Options::default() };
            let stl = Mesh::of_stl(&write(&part, Format::Stl, &options).unwrap());
            let packed = Mesh::of_3mf(&write(&part, Format::ThreeMf, &options).unwrap());
            assert_eq!(stl.triangles().collect::<Vec<_>>(), packed.triangles().collect::<Vec<_>>(), "{}: the two meshes differ", part.name);
            let holes = common::plate_of(&part).cutouts.len() + common::plate_of(&part).holes.len();
            stl.check_closed(&part.name);
            assert_eq!(stl.euler(), 2 - 2 * i64::try_from(holes).unwrap(), "{}", part.name);
            let (volume, exact) = (stl.volume_mm3(), area_m2 * common::plate_of(&part).depth_m * 1e9);
            let strip_mm2 = (facet_error_m * 1e3 + 1e-5) * boundary_m * 1e3;
            assert!((volume - exact).abs() <= strip_mm2 * common::plate_of(&part).depth_m * 1e3, "{}: {volume} for {exact}", part.name);
            errors.push((volume - exact).abs());
        }
        // A quarter of the chord error is a quarter of the volume lost, where that is not a difference of two.
        if part.name == "ring" {
            let ratio = errors[0] / errors[1];
            assert!((3.6..4.4).contains(&ratio), "{ratio}");
        }
    }
}

#[test]
fn normals_in_stl_point_out_of_the_plate() {
    let part = samples().remove(1).part;
    let mesh = Mesh::of_stl(&bytes(&part, Format::Stl));
    for (normal, [a, b, c]) in mesh.normals.iter().zip(mesh.triangles()) {
        let given = normal.map(f64::from);
        let computed = reading::normal(a, b, c);
        assert!((0..3).all(|axis| (given[axis] - computed[axis]).abs() < 1e-6));
        // The bottom looks down, the top up.
        let flat = a[2].to_bits() == b[2].to_bits() && b[2].to_bits() == c[2].to_bits();
        assert!(!flat || (given[2] > 0.0) == (a[2] > 0.0));
    }
}

#[test]
fn solids_are_closed_shells_of_the_right_genus() {
    for Sample { part, faces, .. } in samples() {
        let step = text(&part, Format::Step);
        let step = reading::Step::new(&step);
        assert_eq!((step.of_kind("MANIFOLD_SOLID_BREP").len(), step.of_kind("CLOSED_SHELL").len()), (1, 1));
        assert_eq!(step.of_kind("ADVANCED_FACE").len(), faces, "{}", part.name);
        // Each edge is passed once in each direction.
        let oriented = step.of_kind("ORIENTED_EDGE");
        let passed: BTreeSet<(&str, bool)> =
            oriented.iter().map(|entity| (*reading::references(entity).last().unwrap(), entity.ends_with(".T.)"))).collect();
        let edges = step.of_kind("EDGE_CURVE").len();
        assert_eq!((oriented.len(), passed.len()), (2 * edges, 2 * edges), "{}", part.name);
        // Euler and Poincaré: V − E + F − (bounds − F) = 2 (1 − genus).
        let count = |kind| i64::try_from(step.of_kind(kind).len()).unwrap();
        let characteristic = count("VERTEX_POINT") - count("EDGE_CURVE") + count("ADVANCED_FACE") - count("FACE_BOUND");
        let genus = i64::try_from(common::plate_of(&part).cutouts.len() + common::plate_of(&part).holes.len()).unwrap();
        assert_eq!(characteristic, 2 - 2 * genus, "{}", part.name);
    }
}

/// Readers mend faces that look inwards without a word, so nobody else would notice.
#[test]
fn faces_of_solids_look_out_of_the_material() {
    for Sample { part, .. } in samples() {
        let step = text(&part, Format::Step);
        let step = reading::Step::new(&step);
        let (mut outer, mut inner, mut planes) = (0, 0, 0);
        for face in step.of_kind("ADVANCED_FACE") {
            let references = reading::references(face);
            let surface = step.entity(references[references.len() - 1]);
            let is_along = face.ends_with(".T.)");
            if surface.starts_with("CYLINDRICAL_SURFACE(") {
                // A cylinder's own normal points away from its axis.
                *if is_along { &mut outer } else { &mut inner } += 1;
            } else if surface.starts_with("PLANE(") {
                let axis = step.axis(surface);
                let corners = step.corners_of_bound(references[0]);
                let normal = reading::newell(&corners);
                let along: f64 = axis.iter().zip(normal).map(|(a, b)| a * b).sum();
                // Two corners are a circle; its direction is seen by the walls.
                assert!(corners.len() < 3 || is_along && along > 0.999, "{}: {axis:?} and {normal:?}", part.name);
                let outwards = if corners.iter().all(|corner| corner[2] <= 0.0) { -1.0 } else { 1.0 };
                planes += usize::from((axis[2] - outwards).abs() < 1e-12);
            } else {
                assert!(surface.starts_with("SURFACE_OF_LINEAR_EXTRUSION(") && is_along, "{}: {surface}", part.name);
            }
        }
        let arcs = |wanted: bool| {
            let segments = std::iter::once(&common::plate_of(&part).outline)
                .chain(&common::plate_of(&part).cutouts)
                .flat_map(|profile| &profile.segments);
            segments.filter(|segment| matches!(segment, Segment::Arc { counterclockwise, .. } if *counterclockwise == wanted)).count()
        };
        assert_eq!((outer, inner, planes), (arcs(true), arcs(false) + 2 * common::plate_of(&part).holes.len(), 2), "{}", part.name);
    }
}

/// In single precision corners a hundred metres away are 0.008 mm apart: of chords of 0.006 mm many ends become one.
#[test]
fn meshes_stay_closed_where_rounding_joins_corners() {
    let mut part = common::part("far", 0.004, common::circle([100.0, -70.0], 0.005, true));
    common::plate_mut(&mut part).cutouts = vec![common::circle([100.0, -70.0], 0.003, false)];
    let mesh = Mesh::of_stl(&write(&part, Format::Stl, &Options { facet_error_m: 1e-9, ..Options::default() }).unwrap());
    mesh.check_closed("far");
    assert_eq!(mesh.euler(), 0);
    let exact = std::f64::consts::PI * (25.0 - 9.0) * 4.0;
    assert!((mesh.volume_mm3() / exact - 1.0).abs() < 1e-2);
}

#[test]
fn drawings_are_of_true_size() {
    let plate = text(&samples().remove(1).part, Format::Svg);
    let document = roxmltree::Document::parse(&plate).unwrap();
    let root = document.root_element();
    // 80 mm by 50 mm, and 1 mm around.
    assert_eq!((root.attribute("width"), root.attribute("height")), (Some("82.000mm"), Some("52.000mm")));
    assert_eq!(root.attribute("viewBox"), Some("-1.000 -51.000 82.000 52.000"));
    let title = root.children().find(|node| node.has_tag_name("title")).and_then(|node| node.text());
    assert_eq!(title, Some("Plate <\"Größe\" & 100 %%d>"));
}

#[test]
fn texts_of_all_kinds_keep_files_whole() {
    let mut part = samples().remove(2).part;
    let text_of_all_kinds = "]]> & < ' \" \\ \0 \n \u{7f} ø 🙂 %%c ^J #1=;\r\n0\nEOF";
    for field in [&mut part.name, &mut part.title] {
        text_of_all_kinds.clone_into(field);
    }
    part.material = Some(text_of_all_kinds.to_owned());
    part.notes = vec![text_of_all_kinds.to_owned()];
    roxmltree::Document::parse(&text(&part, Format::Svg)).unwrap();
    Mesh::of_3mf(&bytes(&part, Format::ThreeMf)).check_closed("texts");
    let dxf = text(&part, Format::Dxf);
    assert!(dxf.is_ascii() && dxf.lines().count().is_multiple_of(2));
    assert!(dxf.lines().step_by(2).all(|code| code.parse::<u16>().is_ok()));
    let step = text(&part, Format::Step);
    assert!(step.is_ascii() && step.lines().all(|line| line.ends_with(';')));
    assert!(!bytes(&part, Format::Stl).starts_with(b"solid"));
}
