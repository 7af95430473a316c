//! The drawn tooth against the tool that cuts it, closed forms and measurements of the trade.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{acos, atan2, cos, hypot, sin, sin_cos, tan};
use forcewright_base::quadrature::GaussLegendre;
use forcewright_base::roots;
use forcewright_curves::fit::FitError;
use forcewright_curves::plane::{CurvePoint, PlaneCurve};
use forcewright_curves::vector::{angle, cross, distance, dot, norm, rotate, unit};
use forcewright_elements::gears::{GearError, Kind, Piece, Rack, Region, ReliefShape, TipRelief, ToothProfile, Wheel, WheelSpec, involute};

mod rack;

use rack::rolled_past_rack_m;

const MODULE_M: f64 = 0.5e-3;
const RACKS: [Rack; 4] = [Rack::ISO_53_A, Rack::ISO_53_B, Rack::ISO_53_C, Rack::ISO_53_D];

fn spec(kind: Kind, teeth: u32, shift: f64) -> WheelSpec {
    WheelSpec { kind, teeth, module_m: MODULE_M, rack: Rack::ISO_53_A, profile_shift: shift, tip_shortening: 0.0, thinning_m: 0.0 }
}

fn tooth(spec: WheelSpec) -> ToothProfile {
    ToothProfile::new(&Wheel::new(spec).unwrap(), None).unwrap()
}

fn piece(tooth: &ToothProfile, region: Region) -> Piece {
    *tooth.pieces().iter().find(|piece| piece.region == region).unwrap()
}

fn polar(place: &CurvePoint) -> f64 {
    atan2(place.point_m[1], place.point_m[0])
}

/// Flank, fillet and root lie where the rack comes to, and nowhere within: the envelope from its definition, undercut or not.
#[test]
fn external_teeth_are_what_the_rack_leaves() {
    let mut undercut = 0;
    for (teeth, shift) in [(6, 0.6), (8, 0.3), (9, 0.0), (12, 0.0), (17, 0.0), (18, -0.3), (25, 1.0), (40, 0.2), (90, -0.5)] {
        for rack in RACKS.into_iter().chain([Rack { root_radius: 0.0, ..Rack::ISO_53_A }]) {
            let spec = WheelSpec { rack, thinning_m: 0.02 * MODULE_M, ..spec(Kind::External, teeth, shift) };
            let Ok(tooth) = ToothProfile::new(&Wheel::new(spec).unwrap(), None) else { continue };
            undercut += u32::from(tooth.is_undercut());
            let half_pitch = PI / f64::from(teeth);
            for piece in tooth.pieces().iter().filter(|piece| piece.region != Region::Tip) {
                for k in 0..=12 {
                    let [x, y] = piece.at(f64::from(k) / 12.0).point_m;
                    let far = rolled_past_rack_m(&spec, rotate([x, -y], half_pitch));
                    // A sharp corner comes and goes with a speed, so its distance is only as exact as the angle that is looked for.
                    let exact = if rack.root_radius > 0.0 { 1e-13 } else { 1e-10 };
                    assert!(far.abs() < exact * MODULE_M * f64::from(teeth), "{teeth} {shift} {:?} {k}: {far:e}", piece.region);
                }
            }
        }
    }
    assert!(undercut > 10, "{undercut}");
}

/// The limit of undercut, z = 2 (h − ρ (1 − sin α) − x)/sin² α, and the involute that is left: the root form diameter of ISO 21771-1.
#[test]
fn undercut_begins_where_the_rack_passes_the_base_circle() {
    for rack in RACKS {
        let (sin, cos) = sin_cos(rack.pressure_angle_rad);
        let straight = rack.dedendum - rack.root_radius * (1.0 - sin);
        for teeth in [10, 14, 17, 18, 30] {
            let limit = straight - 0.5 * f64::from(teeth) * sin * sin;
            for (over, undercut) in [(-1e-3, true), (1e-3, false), (0.1, false)] {
                let tooth = tooth(WheelSpec { rack, ..spec(Kind::External, teeth, limit + over) });
                assert_eq!(tooth.is_undercut(), undercut, "{teeth} {over}");
                let r = 0.5 * f64::from(teeth) * MODULE_M;
                if !undercut {
                    let form = hypot(r * cos, over * MODULE_M / sin);
                    assert!((tooth.form_radius_m() / form - 1.0).abs() < 1e-12);
                }
                assert!(tooth.form_radius_m() >= r * cos);
            }
        }
    }
}

/// ISO 21771-1 in words of its own: s = m (π/2 + 2 x tan α), `s_y` = `d_y` (s/d + inv α − inv `α_y`).
#[test]
fn thickness_at_every_radius_is_that_of_the_involute() {
    for kind in [Kind::External, Kind::Internal] {
        for (teeth, shift) in [(40, 0.0), (36, 0.5), (48, -0.2), (120, 0.8)] {
            let spec = WheelSpec { thinning_m: 0.03e-3, tip_shortening: 0.2, ..spec(kind, teeth, shift) };
            let tooth = tooth(spec);
            let d = f64::from(teeth) * MODULE_M;
            let alpha = spec.rack.pressure_angle_rad;
            let sign = if kind == Kind::External { 1.0 } else { -1.0 };
            let s = MODULE_M * (PI / 2.0 + sign * 2.0 * shift * tan(alpha)) - spec.thinning_m;
            let flank = piece(&tooth, Region::Flank);
            for k in 0..=20 {
                let place = flank.at(f64::from(k) / 20.0);
                let radius = norm(place.point_m);
                let angle = s / d + sign * (involute(alpha) - involute(acos((d * cos(alpha) / (2.0 * radius)).min(1.0))));
                assert!((polar(&place) - angle).abs() < 1e-13, "{kind:?} {teeth}");
                let ends = [tooth.wheel().tip_radius_m, tooth.wheel().root_radius_m];
                let drawn = tooth.half_angle_rad(radius.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]))).unwrap();
                assert!((drawn - angle).abs() < 1e-12, "{drawn} {angle}");
            }
        }
    }
}

/// The drawn angle at a radius and the drawn places agree on all pieces, so a point can be told to lie in a tooth.
#[test]
fn angles_at_radii_are_those_of_the_places() {
    for tooth in [
        tooth(spec(Kind::External, 12, 0.0)),
        tooth(spec(Kind::External, 30, 0.4)),
        tooth(WheelSpec { tip_shortening: 0.2, ..spec(Kind::Internal, 48, 0.3) }),
    ] {
        for piece in tooth.pieces().iter().filter(|piece| !matches!(piece.region, Region::Tip | Region::Root)) {
            for k in 1..40 {
                let place = piece.at(f64::from(k) / 40.0);
                let found = tooth.half_angle_rad(norm(place.point_m)).unwrap();
                // Where a fillet meets the root circle the angle at a radius has a root's slope.
                assert!((found - polar(&place)).abs() < 1e-9, "{:?} {k}: {found} {}", piece.region, polar(&place));
            }
        }
        let Wheel { tip_radius_m, root_radius_m, .. } = *tooth.wheel();
        let outside = [1.001 * tip_radius_m.max(root_radius_m), 0.999 * tip_radius_m.min(root_radius_m), f64::NAN];
        assert_eq!(outside.map(|radius| tooth.half_angle_rad(radius)), [None; 3]);
    }
}

/// The arc of a ring touches the root circle from within and the flank, is as large as the rack says, or fills the space.
#[test]
fn fillets_of_rings_touch_flank_and_root() {
    let mut full = 0;
    for (teeth, shift) in [(30, 0.5), (36, 0.0), (48, 0.0), (48, 1.0), (100, -0.5), (120, 0.3)] {
        for rack in RACKS {
            let tooth = tooth(WheelSpec { rack, tip_shortening: 0.2, ..spec(Kind::Internal, teeth, shift) });
            let fillet = piece(&tooth, Region::Fillet);
            let places = [0.0, 0.5, 1.0].map(|u| fillet.at(u));
            let radius = 1.0 / places[1].curvature_per_m().abs();
            assert!((radius / tooth.fillet_radius_m() - 1.0).abs() < 1e-12);
            let normal = unit([-places[1].first_m[1], places[1].first_m[0]]);
            let centre = [0, 1].map(|k| places[1].point_m[k] + radius * normal[k]);
            assert!((norm(centre) + radius - tooth.wheel().root_radius_m).abs() < 1e-15);
            let flank = piece(&tooth, Region::Flank);
            let nearest = roots::minimise(|u| distance(flank.at(u).point_m, centre), 0.0, 1.0, 1e-12)
                .value
                .min(distance(flank.at(1.0).point_m, centre));
            assert!((nearest - radius).abs() < 1e-15, "{nearest} {radius}");
            let asked = rack.root_radius * MODULE_M;
            if (tooth.fillet_radius_m() - asked).abs() > 1e-15 {
                full += 1;
                let aside = atan2(centre[1], centre[0]) - PI / f64::from(teeth);
                assert!(radius < asked && aside.abs() < 1e-14);
            }
        }
    }
    assert!(full > 3, "{full}");
}

#[test]
fn pieces_share_ends_and_tangents() {
    for kind in [Kind::External, Kind::Internal] {
        for teeth in [12, 25, 40, 77] {
            for (shift, rack) in [(0.0, RACKS[0]), (0.45, RACKS[1]), (0.9, RACKS[2]), (-0.3, RACKS[3])] {
                let spec = WheelSpec { rack, tip_shortening: 0.3, ..spec(kind, teeth, shift) };
                let Ok(wheel) = Wheel::new(spec) else { continue };
                let relief = |shape| TipRelief::over_length(&wheel, 0.01 * MODULE_M, 0.3 * MODULE_M, shape).ok();
                for relief in [None, relief(ReliefShape::Parabolic), relief(ReliefShape::Linear)] {
                    let Ok(tooth) = ToothProfile::new(&wheel, relief) else { continue };
                    for pair in tooth.pieces().windows(2) {
                        let (end, start) = (pair[0].at(1.0), pair[1].at(0.0));
                        let size = wheel.reference_radius_m;
                        assert!(distance(end.point_m, start.point_m) < 1e-14 * size, "{kind:?} {teeth} {:?}", pair[1].region);
                        let kink = angle(end.first_m, start.first_m).abs();
                        let smooth = match pair[1].region {
                            Region::Relief => false,
                            Region::Flank => relief.is_some_and(|relief| relief.shape == ReliefShape::Parabolic),
                            Region::Fillet => !tooth.is_undercut(),
                            _ => true,
                        };
                        assert!(
                            if smooth { kink < 1e-7 } else { kink > 1e-4 && kink < 2.0 },
                            "{kind:?} {teeth} {shift} {:?}: {kink:e}",
                            pair[1].region
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn derivatives_belong_together() {
    let relieved = |kind, shape| {
        let wheel = Wheel::new(spec(kind, 48, 0.0)).unwrap();
        ToothProfile::new(&wheel, Some(TipRelief::over_length(&wheel, 0.05 * MODULE_M, 0.5 * MODULE_M, shape).unwrap())).unwrap()
    };
    let all = [
        relieved(Kind::External, ReliefShape::Linear),
        relieved(Kind::Internal, ReliefShape::Parabolic),
        relieved(Kind::External, ReliefShape::Parabolic),
        tooth(spec(Kind::External, 12, 0.0)),
        tooth(spec(Kind::External, 20, 1.0)),
    ];
    for tooth in all {
        for piece in tooth.pieces() {
            for k in 1..10 {
                let (u, step) = (0.1 * f64::from(k), 1e-4);
                let [before, here, after] = [u - step, u, u + step].map(|u| piece.at(u));
                for axis in 0..2 {
                    let slope = (after.point_m[axis] - before.point_m[axis]) / (2.0 * step);
                    let bend = (after.first_m[axis] - before.first_m[axis]) / (2.0 * step);
                    assert!((slope - here.first_m[axis]).abs() < 1e-6 * MODULE_M, "{:?} {u}", piece.region);
                    assert!((bend - here.second_m[axis]).abs() < 1e-5 * MODULE_M, "{:?} {u}", piece.region);
                }
            }
        }
        // An involute has its centre of curvature on the base circle.
        let place = piece(&tooth, Region::Flank).at(0.4);
        let w = (dot(place.point_m, place.point_m) - tooth.wheel().base_radius_m * tooth.wheel().base_radius_m).sqrt();
        assert!((w * place.curvature_per_m().abs() - 1.0).abs() < 1e-12);
    }
}

/// A probe on the tangent of the base circle, the way flanks are inspected: nothing before the start, the amount at the tip.
#[test]
fn relief_is_measured_along_the_line_of_action() {
    for kind in [Kind::External, Kind::Internal] {
        let wheel = Wheel::new(spec(kind, 48, 0.0)).unwrap();
        let plain = ToothProfile::new(&wheel, None).unwrap();
        for (shape, half) in [(ReliefShape::Linear, 0.5), (ReliefShape::Parabolic, 0.25)] {
            let amount = 0.012e-3;
            let relief = TipRelief::over_length(&wheel, amount, 0.4e-3, shape).unwrap();
            let tooth = ToothProfile::new(&wheel, Some(relief)).unwrap();
            let w = |radius: f64| (radius * radius - wheel.base_radius_m * wheel.base_radius_m).sqrt();
            let (start, tip) = (w(relief.start_radius_m), w(wheel.tip_radius_m));
            assert!(((tip - start).abs() / 0.4e-3 - 1.0).abs() < 1e-12);
            for (t, share) in [(0.0, 0.0), (0.5, half), (1.0, 1.0)] {
                let radius = hypot(wheel.base_radius_m, start + t * (tip - start))
                    .clamp(wheel.tip_radius_m.min(wheel.root_radius_m), wheel.tip_radius_m.max(wheel.root_radius_m));
                let thinner = plain.half_angle_rad(radius).unwrap() - tooth.half_angle_rad(radius).unwrap();
                assert!((thinner * wheel.base_radius_m - share * amount).abs() < 1e-15, "{kind:?} {shape:?} {t}");
            }
        }
    }
}

/// Span over k teeth (Wildhaber): W = m cos α ((k − ½) π + z inv α) + 2 x m sin α, less what backlash takes; flat jaws on the drawn flanks.
#[test]
fn the_span_over_teeth_is_the_formula() {
    for (teeth, shift, over) in [(12, 0.4, 2), (18, 0.2, 3), (30, 0.0, 4), (48, -0.3, 5), (90, 0.6, 11)] {
        let spec = WheelSpec { thinning_m: 0.02e-3, ..spec(Kind::External, teeth, shift) };
        let flank = piece(&tooth(spec), Region::Flank);
        let alpha = spec.rack.pressure_angle_rad;
        // The last of the teeth, seen from the middle of all: its outer flank, where it faces the jaw.
        let turn = PI * f64::from(over - 1) / f64::from(teeth);
        let facing = |u: f64| rotate(flank.at(u).first_m, turn)[1];
        let u = roots::root(facing, 0.0, 1.0, 0.0).unwrap();
        let measured = 2.0 * rotate(flank.at(u).point_m, turn)[1];
        let (sin, cos) = sin_cos(alpha);
        let span = MODULE_M * cos * ((f64::from(over) - 0.5) * PI + f64::from(teeth) * involute(alpha)) + 2.0 * shift * MODULE_M * sin
            - spec.thinning_m * cos;
        assert!((measured / span - 1.0).abs() < 1e-13, "{teeth}: {measured} {span}");
    }
}

/// Dimension over or between pins: a pin that touches both drawn flanks of a space.
#[test]
fn pins_lie_where_the_formula_says() {
    for (kind, teeth, shift, pin) in
        [(Kind::External, 18, 0.2, 1.75), (Kind::External, 48, 0.0, 1.7), (Kind::Internal, 48, 0.1, 1.6), (Kind::Internal, 90, 0.5, 1.65)]
    {
        let spec = WheelSpec { thinning_m: 0.02e-3, tip_shortening: 0.1, ..spec(kind, teeth, shift) };
        let flank = piece(&tooth(spec), Region::Flank);
        let (alpha, z, pin) = (spec.rack.pressure_angle_rad, f64::from(teeth), pin * MODULE_M);
        let outwards = if kind == Kind::External { 1.0 } else { -1.0 };
        let r = 0.5 * z * MODULE_M;
        let reach = |radius: f64| {
            let centre = rotate([radius, 0.0], PI / z);
            roots::minimise(|u| distance(flank.at(u).point_m, centre), 0.0, 1.0, 1e-13).value - 0.5 * pin
        };
        let measured = roots::root(reach, r - 0.5 * MODULE_M, r + 1.2 * MODULE_M, 0.0).unwrap();
        let inv = involute(alpha) + outwards * (pin / (2.0 * r * cos(alpha)) - PI / (2.0 * z)) + 2.0 * shift * tan(alpha) / z
            - outwards * spec.thinning_m / (2.0 * r);
        let at_pin = roots::root(|a| involute(a) - inv, 0.0, 1.2, 0.0).unwrap();
        let formula = r * cos(alpha) / cos(at_pin);
        assert!((measured / formula - 1.0).abs() < 1e-13, "{kind:?} {teeth}: {measured} {formula}");
    }
}

/// Area of the exact tooth by quadrature over its pieces, m².
fn area_m2(tooth: &ToothProfile) -> f64 {
    let rule = GaussLegendre::new(40);
    let half: f64 = tooth.pieces().iter().map(|piece| rule.integrate(|u| 0.5 * cross(piece.at(u).point_m, piece.at(u).first_m))).sum();
    2.0 * f64::from(tooth.wheel().spec.teeth) * half
}

/// What the errors of a grid of gears must be, from formulas of the test's own.
fn expected_error(spec: &WheelSpec, error: &GearError) -> bool {
    let r = 0.5 * f64::from(spec.teeth) * MODULE_M;
    let alpha = spec.rack.pressure_angle_rad;
    let outwards = if spec.kind == Kind::External { 1.0 } else { -1.0 };
    let tip = r + (spec.profile_shift + outwards * (spec.rack.addendum - spec.tip_shortening)) * MODULE_M;
    let root = r + (spec.profile_shift - outwards * spec.rack.dedendum) * MODULE_M;
    let half_tooth = |radius: f64, outwards: f64| {
        (0.5 * PI + outwards * 2.0 * spec.profile_shift * tan(alpha)) / f64::from(spec.teeth)
            + outwards * (involute(alpha) - involute(acos(r * cos(alpha) / radius)))
    };
    match error {
        GearError::PointedTooth { radius_m } => half_tooth(tip, outwards) <= 0.0 && half_tooth(*radius_m, outwards).abs() < 1e-12,
        GearError::PointedSpace { radius_m } => half_tooth(root, 1.0) <= 0.0 && half_tooth(*radius_m, 1.0).abs() < 1e-12,
        GearError::TipBelowBase { .. } => spec.kind == Kind::Internal && tip <= r * cos(alpha),
        // Below the limit of undercut by half a module and more.
        GearError::NoFlank { .. } | GearError::CutOff { .. } => {
            spec.kind == Kind::External && spec.profile_shift < 1.0 - 0.5 * f64::from(spec.teeth) * sin(alpha) * sin(alpha) - 0.5
        }
        _ => false,
    }
}

/// Every gear of a wide grid is refused for the reason that formulas give, or is a closed simple curve of the exact area, between the areas of
/// its circles, the same in the mirror.
#[test]
fn outlines_are_closed_and_simple_over_a_wide_grid() {
    let (mut drawn, mut refused) = (0, 0);
    for teeth in [6, 7, 8, 10, 12, 14, 17, 20, 27, 35, 48, 75, 120] {
        for shift in [-0.5, -0.2, 0.0, 0.3, 0.7, 1.0] {
            for rack in RACKS {
                for kind in [Kind::External, Kind::Internal] {
                    // Teeth of rings that end above the base circle.
                    let lowest = 0.5 * f64::from(teeth) * cos(rack.pressure_angle_rad) + 0.05;
                    let tip_shortening =
                        if kind == Kind::Internal { (lowest - (0.5 * f64::from(teeth) + shift - 1.0)).max(0.0) } else { 0.0 };
                    let spec = WheelSpec { rack, tip_shortening, ..spec(kind, teeth, shift) };
                    let made = Wheel::new(spec).and_then(|wheel| ToothProfile::new(&wheel, None));
                    let tooth = match made {
                        Ok(tooth) => tooth,
                        Err(error) => {
                            assert!(expected_error(&spec, &error) || Wheel::new(spec).is_err(), "{spec:?}: {error}");
                            refused += 1;
                            continue;
                        }
                    };
                    drawn += 1;
                    looks_like_a_gear(&tooth);
                }
            }
        }
    }
    assert!(drawn > 400 && refused > 20, "{drawn} {refused}");
}

fn looks_like_a_gear(tooth: &ToothProfile) {
    let tolerance = 1e-3 * MODULE_M;
    let spec = tooth.wheel().spec;
    let outline = tooth.outline(tolerance).unwrap();
    let profile = &outline.profile;
    let name = format!("{:?} {} {} {:?}", spec.kind, spec.teeth, spec.profile_shift, spec.rack);
    assert!(outline.error_m <= tolerance);
    assert_eq!(profile.segments.len(), outline.segments_per_tooth * usize::try_from(spec.teeth).unwrap());
    assert!(outline.segments_per_tooth <= 6, "{name}");
    profile.check(0.2 * tolerance).unwrap_or_else(|error| panic!("{name}: {error}"));
    let sense = if spec.kind == Kind::External { 1.0 } else { -1.0 };
    let (area, exact) = (sense * profile.area_m2(), area_m2(tooth));
    assert!((area - exact).abs() <= outline.error_m * profile.length_m() + 1e-13 * exact, "{name}: {area} {exact}");
    let Wheel { tip_radius_m, root_radius_m, .. } = *tooth.wheel();
    let circles = [tip_radius_m.min(root_radius_m), tip_radius_m.max(root_radius_m)].map(|radius| PI * radius * radius);
    assert!(circles[0] < area && area < circles[1], "{name}");
    // In the mirror and turned by a pitch.
    let points = profile.tessellate(tolerance);
    let count = points.len();
    assert_eq!(count % usize::try_from(spec.teeth).unwrap(), 0, "{name}");
    let per_tooth = count / usize::try_from(spec.teeth).unwrap();
    let far = tip_radius_m.max(root_radius_m);
    for k in 0..count {
        let pitch = rotate(points[k], sense * TAU / f64::from(spec.teeth));
        assert!(distance(pitch, points[(k + per_tooth) % count]) < 4e-15 * far, "{name}");
    }
    let ends: Vec<[f64; 2]> = profile.segments.iter().map(forcewright_curves::Segment::end_m).collect();
    for [x, y] in &ends {
        let nearest = ends.iter().map(|end| distance(*end, [*x, -*y])).fold(f64::INFINITY, f64::min);
        assert!(nearest < 4e-15 * far, "{name}: {nearest:e}");
    }
}

#[test]
fn few_faces_per_tooth_hold_a_fine_outline() {
    for (kind, tolerance) in [(Kind::External, 1e-7), (Kind::Internal, 1e-7)] {
        let outline = tooth(WheelSpec { tip_shortening: 0.2, ..spec(kind, 48, 0.2) }).outline(tolerance).unwrap();
        assert_eq!(outline.segments_per_tooth, 6);
        let control: usize = outline
            .profile
            .segments
            .iter()
            .map(|segment| match segment {
                forcewright_curves::Segment::Spline(spline) => spline.control_m.len(),
                _ => 0,
            })
            .sum();
        assert!(control <= 48 * 2 * 16, "{kind:?}: {control}");
    }
}

#[test]
fn what_makes_no_tooth_is_named() {
    let wheel = |spec| Wheel::new(spec).unwrap();
    let pointed = ToothProfile::new(&wheel(spec(Kind::External, 8, 1.0)), None);
    assert!(matches!(pointed, Err(GearError::PointedTooth { radius_m }) if radius_m < wheel(spec(Kind::External, 8, 1.0)).tip_radius_m));
    let below = ToothProfile::new(&wheel(spec(Kind::Internal, 20, 0.0)), None);
    assert!(matches!(below, Err(GearError::TipBelowBase { .. })));
    let sharp = ToothProfile::new(&wheel(WheelSpec { tip_shortening: 1.5, ..spec(Kind::Internal, 10, 1.0) }), None);
    assert!(matches!(sharp, Err(GearError::PointedSpace { .. })), "{sharp:?}");
    let blunt = Rack { root_radius: 0.5, ..Rack::ISO_53_A };
    let no_room = ToothProfile::new(&wheel(WheelSpec { rack: blunt, ..spec(Kind::External, 30, 0.0) }), None);
    assert!(matches!(no_room, Err(GearError::Value { name: "root_radius", .. })));
    let cut = ToothProfile::new(&wheel(WheelSpec { tip_shortening: 0.9, ..spec(Kind::External, 6, -0.4) }), None);
    assert!(matches!(cut, Err(GearError::NoFlank { .. } | GearError::CutOff { .. })), "{cut:?}");
    let good = wheel(spec(Kind::External, 30, 0.0));
    for (amount_m, start_radius_m) in [(-1e-6, 7.6e-3), (f64::NAN, 7.6e-3), (1e-6, 9e-3), (1e-6, 6.9e-3), (1e-6, f64::NAN), (1e-3, 7.6e-3)]
    {
        let relief = TipRelief { amount_m, start_radius_m, shape: ReliefShape::Linear };
        assert!(matches!(ToothProfile::new(&good, Some(relief)), Err(GearError::Value { .. })), "{amount_m} {start_radius_m}");
    }
    assert!(TipRelief::over_length(&good, 1e-6, 0.0, ReliefShape::Linear).is_err());
    assert!(TipRelief::over_length(&good, 1e-6, 1.0, ReliefShape::Linear).is_err());
    let none = ToothProfile::new(&good, None).unwrap().outline(0.0);
    assert_eq!(none.err(), Some(GearError::Outline(FitError::Tolerance { tolerance_m: 0.0 })));
}

/// Numbers from 0 to 1, always the same.
struct Draw(u64);

impl Draw {
    fn next(&mut self, [low, high]: [f64; 2]) -> f64 {
        // Knuth's MMIX generator.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Racks that no standard knows, and any shift: a tooth that is given is a closed simple curve, everything else is refused with finite numbers.
#[test]
fn odd_racks_give_sound_outlines_or_errors() {
    let mut draw = Draw(7);
    let (mut drawn, mut refused) = (0, 0);
    for k in 0..3000_u32 {
        let rack = Rack {
            pressure_angle_rad: draw.next([0.02, 0.75]),
            addendum: draw.next([0.2, 1.5]),
            dedendum: draw.next([0.2, 1.8]),
            root_radius: if k % 5 == 0 { 0.0 } else { draw.next([0.0, 0.6]) },
        };
        let kind = if k % 2 == 0 { Kind::External } else { Kind::Internal };
        let thinning_m = draw.next([0.0, 0.3]) * MODULE_M;
        let teeth = 4 + k % 37;
        let spec = WheelSpec { rack, thinning_m, tip_shortening: draw.next([0.0, 0.3]), ..spec(kind, teeth, draw.next([-1.0, 1.5])) };
        let Ok(wheel) = Wheel::new(spec) else { continue };
        let relief =
            TipRelief::over_length(&wheel, draw.next([0.0, 0.05]) * MODULE_M, draw.next([0.1, 0.5]) * MODULE_M, ReliefShape::Parabolic)
                .ok();
        match ToothProfile::new(&wheel, relief.filter(|_| k % 3 == 0)) {
            Ok(tooth) => {
                drawn += 1;
                let outline = tooth.outline(1e-3 * MODULE_M).unwrap_or_else(|error| panic!("{spec:?}: {error}"));
                outline.profile.check(1e-4 * MODULE_M).unwrap_or_else(|error| panic!("{spec:?}: {error}"));
                assert!(tooth.form_radius_m() >= wheel.base_radius_m && tooth.fillet_radius_m() >= 0.0, "{spec:?}");
            }
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().contains("NaN"), "{spec:?}: {error}");
            }
        }
    }
    assert!(drawn > 500 && refused > 500, "{drawn} {refused}");
}
