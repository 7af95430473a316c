//! Gears as files: read back, and measured there as a workshop would.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use forcewright::base::maths::{cos, hypot, sin, tan};
use forcewright::base::quadrature::GaussLegendre;
use forcewright::base::roots;
use forcewright::base::units::Unit;
use forcewright::curves::plane::PlaneCurve;
use forcewright::curves::vector::{cross, distance, dot};
use forcewright::curves::{Profile, Segment};
use forcewright::fabricate::{Format, Options, write};
use forcewright::model::{Hole, Part};
use forcewright_contract::gears::GearPart;
use forcewright_elements::gears::{GearError, Kind, Rack, ToothProfile, Wheel, WheelSpec, involute};

#[allow(dead_code, unreachable_pub, clippy::unwrap_used, reason = "the readers of the tests of the writers, of which this needs some")]
#[path = "../../outputs/fabricate/tests/reading/mod.rs"]
mod reading;

const MODULE_M: f64 = 0.5e-3;
const THICKNESS_M: f64 = 3e-3;

fn tooth(kind: Kind, teeth: u32, profile_shift: f64) -> ToothProfile {
    let (tip_shortening, thinning_m) = (if kind == Kind::Internal { 0.2 } else { 0.0 }, 0.02e-3);
    let spec = WheelSpec { kind, teeth, module_m: MODULE_M, rack: Rack::ISO_53_A, profile_shift, tip_shortening, thinning_m };
    ToothProfile::new(&Wheel::new(spec).expect("a wheel"), None).expect("a tooth")
}

fn gear<'a>(tooth: &'a ToothProfile, unit: &'a Unit) -> GearPart<'a> {
    let is_ring = tooth.wheel().spec.kind == Kind::Internal;
    let hole = |x: f64, diameter_m: f64| Hole { centre_m: [x, 0.0], diameter_m, purpose: "axle".to_owned() };
    GearPart {
        name: if is_ring { "ring" } else { "planet" },
        title: "Gear",
        tooth,
        thickness_m: THICKNESS_M,
        chord_error_m: 1e-7,
        outer_radius_m: is_ring.then_some(tooth.wheel().root_radius_m + 3e-3),
        holes: vec![if is_ring { hole(tooth.wheel().root_radius_m + 1.5e-3, 1e-3) } else { hole(0.0, 1.5e-3) }],
        material: Some(("POM-C", Some(1410.0))),
        display: unit,
    }
}

/// The gears 12/18/48 with shifts that mesh, and a large external one.
fn teeth() -> Vec<ToothProfile> {
    vec![
        tooth(Kind::External, 12, 0.4),
        tooth(Kind::External, 12, 0.0),
        tooth(Kind::External, 18, 0.2),
        tooth(Kind::Internal, 48, 0.8),
        tooth(Kind::External, 120, -0.3),
    ]
}

fn part(tooth: &ToothProfile) -> Part {
    gear(tooth, &Unit::parse("mm").expect("a unit")).part().expect("a part")
}

/// Area of the part, m²: exact teeth by quadrature, circles in closed form.
fn area_m2(tooth: &ToothProfile) -> f64 {
    let rule = GaussLegendre::new(40);
    let half: f64 = tooth.pieces().iter().map(|piece| rule.integrate(|u| 0.5 * cross(piece.at(u).point_m, piece.at(u).first_m))).sum();
    let teeth_m2 = 2.0 * f64::from(tooth.wheel().spec.teeth) * half;
    match tooth.wheel().spec.kind {
        Kind::External => teeth_m2 - 0.25 * PI * 1.5e-3 * 1.5e-3,
        Kind::Internal => {
            let outer = tooth.wheel().root_radius_m + 3e-3;
            PI * outer * outer - teeth_m2 - 0.25 * PI * 1e-6
        }
    }
}

#[test]
fn parts_have_the_area_of_the_exact_teeth() {
    for tooth in teeth() {
        let part = part(&tooth);
        let plate = part.plate().expect("a plate");
        let exact_m2 = area_m2(&tooth);
        assert!((plate.area_m2() - exact_m2).abs() < 1e-7 * plate.cut_length_m());
        let (polylines, radii) = reading::dxf(&reading::text(&part, Format::Dxf));
        let holes: f64 = radii.iter().map(|radius| PI * radius * radius).sum();
        let drawn = polylines.iter().map(|corners| reading::area_of_bulges(corners)).sum::<f64>() - holes;
        assert!((1e-6 * drawn / exact_m2 - 1.0).abs() < 2e-5, "{drawn}");
        let mass = part.mass_kg().expect("a density");
        assert!((mass / (1410.0 * THICKNESS_M * exact_m2) - 1.0).abs() < 2e-5);
    }
}

#[test]
fn meshes_are_closed_and_solids_are_shells() {
    for tooth in teeth() {
        let part = part(&tooth);
        let plate = part.plate().expect("a plate");
        let inside = i64::try_from(plate.holes.len() + plate.cutouts.len()).expect("few");
        let options = Options { facet_error_m: 1e-6, ..Options::default() };
        let stl = reading::Mesh::of_stl(&write(&part, Format::Stl, &options).expect("written"));
        let packed = reading::Mesh::of_3mf(&write(&part, Format::ThreeMf, &options).expect("written"));
        for mesh in [&stl, &packed] {
            mesh.check_closed(&part.name);
            assert_eq!(mesh.euler(), 2 - 2 * inside);
            assert!((1e-9 * mesh.volume_mm3() / (area_m2(&tooth) * THICKNESS_M) - 1.0).abs() < 1e-3);
        }
        let text = reading::text(&part, Format::Step);
        let step = reading::Step::new(&text);
        let count = |kind: &str| i64::try_from(step.of_kind(kind).len()).expect("few");
        assert_eq!((count("MANIFOLD_SOLID_BREP"), count("CLOSED_SHELL")), (1, 1));
        // Six faces for a tooth, five if its fillet fills the space, two for each circle, top and bottom.
        let per_tooth = tooth.outline(1e-7).expect("drawn").segments_per_tooth;
        assert_eq!(per_tooth, if tooth.wheel().spec.kind == Kind::Internal { 5 } else { 6 });
        let circles = 2 * i64::try_from(plate.holes.len() + usize::from(!plate.cutouts.is_empty())).expect("few");
        assert_eq!(count("ADVANCED_FACE"), i64::try_from(per_tooth).expect("few") * i64::from(tooth.wheel().spec.teeth) + circles + 2);
        assert_eq!(count("VERTEX_POINT") - count("EDGE_CURVE") + count("ADVANCED_FACE") - count("FACE_BOUND"), 2 - 2 * inside);
        let oriented = step.of_kind("ORIENTED_EDGE");
        let passed: BTreeSet<(&str, bool)> =
            oriented.iter().map(|entity| (*reading::references(entity).last().expect("its edge"), entity.ends_with(".T.)"))).collect();
        assert_eq!(i64::try_from(passed.len()).expect("few"), 2 * count("EDGE_CURVE"));
        let svg = reading::text(&part, Format::Svg);
        roxmltree::Document::parse(&svg).expect("valid");
        assert!(text.len() < 16_000 * usize::try_from(tooth.wheel().spec.teeth).expect("small") + 20_000);
    }
}

/// The toothed boundary of a drawing as points close to each other, m.
fn drawn_m(part: &Part) -> Vec<[f64; 2]> {
    let options = Options { arc_error_m: 1e-7, ..Options::default() };
    let file = String::from_utf8(write(part, Format::Dxf, &options).expect("written")).expect("text");
    let (polylines, _) = reading::dxf(&file);
    let corners = polylines.iter().max_by_key(|corners| corners.len()).expect("one");
    let segment = |(i, [x, y, bulge]): (usize, &reading::Corner)| {
        let [to_x, to_y, _] = corners[(i + 1) % corners.len()];
        // The middle lies (1 − b²)/(4b) chords to the left of the middle of the chord.
        let off = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre_m = [0.5 * (x + to_x) - off * (to_y - y), 0.5 * (y + to_y) + off * (to_x - x)].map(|c| 1e-3 * c);
        let to_m = [1e-3 * to_x, 1e-3 * to_y];
        if bulge.abs() > 0.0 { Segment::Arc { to_m, centre_m, counterclockwise: *bulge > 0.0 } } else { Segment::Line { to_m } }
    };
    let start_m = [1e-3 * corners[0][0], 1e-3 * corners[0][1]];
    Profile { start_m, segments: corners.iter().enumerate().map(segment).collect() }.tessellate(2e-9)
}

/// Flat jaws over k teeth of the drawing: W = m cos α ((k − ½) π + z inv α) + 2 x m sin α − j cos α.
#[test]
fn the_span_in_the_drawing_is_the_formula() {
    for (teeth, shift, over) in [(12, 0.4, 2), (18, 0.2, 3), (48, 0.0, 6)] {
        let tooth = tooth(Kind::External, teeth, shift);
        let points = drawn_m(&part(&tooth));
        let pitch = 2.0 * PI / f64::from(teeth);
        let jaw = 0.5 * f64::from(over - 1) * pitch + 0.5 * PI;
        let across = [cos(jaw), sin(jaw)];
        // Jaws lie on the first and the last of the teeth, and are narrow enough not to meet the root beside.
        let root_m = tooth.wheel().root_radius_m + 0.5 * MODULE_M;
        let of_tooth = |k: u32| {
            let middle = pitch * f64::from(k);
            let facing = [cos(middle), sin(middle)];
            points
                .iter()
                .filter(move |p| cross(facing, **p).abs() < dot(facing, **p) * tan(0.5 * pitch) && hypot(p[0], p[1]) > root_m)
                .map(|p| dot(*p, across))
        };
        let measured = of_tooth(over - 1).fold(f64::NEG_INFINITY, f64::max) - of_tooth(0).fold(f64::INFINITY, f64::min);
        let alpha = PI / 9.0;
        let span = MODULE_M * cos(alpha) * ((f64::from(over) - 0.5) * PI + f64::from(teeth) * involute(alpha))
            + 2.0 * shift * MODULE_M * sin(alpha)
            - 0.02e-3 * cos(alpha);
        assert!((measured - span).abs() < 4e-7, "{teeth}: {measured} {span}");
    }
}

/// A pin between the teeth of the drawn ring.
#[test]
fn a_pin_in_the_drawn_ring_lies_where_the_formula_says() {
    let (teeth, shift, pin) = (48, 0.8, 1.6 * MODULE_M);
    let ring = tooth(Kind::Internal, teeth, shift);
    let points = drawn_m(&part(&ring));
    let (z, alpha, r) = (f64::from(teeth), PI / 9.0, 12e-3);
    let reach = |radius: f64| {
        let centre = [radius * cos(PI / z), radius * sin(PI / z)];
        points.iter().map(|p| distance(*p, centre)).fold(f64::INFINITY, f64::min) - 0.5 * pin
    };
    let measured = roots::root(reach, r, r + 1.2 * MODULE_M, 1e-12).expect("between the flanks");
    let inv = involute(alpha) + PI / (2.0 * z) - pin / (2.0 * r * cos(alpha)) + 2.0 * shift * tan(alpha) / z + 0.02e-3 / (2.0 * r);
    let at_pin = roots::root(|a| involute(a) - inv, 0.0, 1.2, 0.0).expect("a pin");
    let formula = r * cos(alpha) / cos(at_pin);
    assert!((measured - formula).abs() < 1e-6, "{measured} {formula}");
    // Its tip circle too.
    let tip = points.iter().map(|[x, y]| hypot(*x, *y)).fold(f64::INFINITY, f64::min);
    assert!((tip - ring.wheel().tip_radius_m).abs() < 1e-9);
}

#[test]
fn notes_name_the_gear_and_bad_blanks_are_refused() {
    let (sun, ring) = (tooth(Kind::External, 12, 0.0), tooth(Kind::Internal, 48, 0.8));
    let unit = Unit::parse("mm").expect("a unit");
    let notes = part(&sun).notes.join("\n");
    assert!(notes.contains("12 teeth, module 0.5 mm, pressure angle 20°") && notes.contains("undercut"), "{notes}");
    let hole = |x: f64, diameter_m: f64| vec![Hole { centre_m: [x, 0.0], diameter_m, purpose: "axle".to_owned() }];
    let refused = [
        GearPart { outer_radius_m: Some(0.02), ..gear(&sun, &unit) },
        GearPart { outer_radius_m: None, ..gear(&ring, &unit) },
        GearPart { outer_radius_m: Some(0.012), ..gear(&ring, &unit) },
        GearPart { outer_radius_m: Some(f64::NAN), ..gear(&ring, &unit) },
        GearPart { holes: hole(0.0, 5e-3), ..gear(&sun, &unit) },
        GearPart { holes: hole(0.0, f64::NAN), ..gear(&sun, &unit) },
        GearPart { holes: hole(0.0, 1e-3), ..gear(&ring, &unit) },
    ];
    for blank in refused {
        assert!(matches!(blank.part(), Err(GearError::Value { .. })));
    }
    assert!(matches!(GearPart { chord_error_m: -1.0, ..gear(&sun, &unit) }.part(), Err(GearError::Outline(_))));
}
