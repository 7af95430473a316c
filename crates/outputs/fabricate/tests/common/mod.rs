//! Parts with known areas, for the tests and for programs that read the files.

pub mod drums;
pub mod springs;

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::quadrature::GaussLegendre;
use forcewright_curves::{Profile, Segment, Spline};
use forcewright_model::{Body, Hole, Part, Plate};

/// A part and what is known of it without any writer.
pub struct Sample {
    pub part: Part,
    /// Area of the material, m².
    pub area_m2: f64,
    /// Length of all boundaries, m.
    pub boundary_m: f64,
    /// Faces of the solid: a hole and a closed spline give two.
    pub faces: usize,
}

/// All plates.
pub fn samples() -> Vec<Sample> {
    vec![tiny(), plate(), ring(), strip(), gear(), keyhole(), blob()]
}

pub fn line(x_m: f64, y_m: f64) -> Segment {
    Segment::Line { to_m: [x_m, y_m] }
}

pub fn arc(to_m: [f64; 2], centre_m: [f64; 2], counterclockwise: bool) -> Segment {
    Segment::Arc { to_m, centre_m, counterclockwise }
}

pub fn polar(radius_m: f64, angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(angle_rad);
    [radius_m * cos, radius_m * sin]
}

/// A circle as two arcs.
pub fn circle(centre_m: [f64; 2], radius_m: f64, counterclockwise: bool) -> Profile {
    let (right, left) = ([centre_m[0] + radius_m, centre_m[1]], [centre_m[0] - radius_m, centre_m[1]]);
    Profile { start_m: right, segments: vec![arc(left, centre_m, counterclockwise), arc(right, centre_m, counterclockwise)] }
}

/// A rectangle with a corner in the origin, rounded with `radius_m`.
pub fn rounded(width_m: f64, height_m: f64, radius_m: f64) -> Profile {
    let (w, h, r) = (width_m, height_m, radius_m);
    Profile {
        start_m: [r, 0.0],
        segments: vec![
            line(w - r, 0.0),
            arc([w, r], [w - r, r], true),
            line(w, h - r),
            arc([w - r, h], [w - r, h - r], true),
            line(r, h),
            arc([0.0, h - r], [r, h - r], true),
            line(0.0, r),
            arc([r, 0.0], [r, r], true),
        ],
    }
}

pub fn part(name: &str, depth_m: f64, outline: Profile) -> Part {
    Part {
        name: name.to_owned(),
        title: format!("Sample {name}"),
        count: 1,
        material: None,
        density_kg_per_m3: None,
        notes: Vec::new(),
        body: Body::Plate(Plate {
            depth_m,
            outline,
            cutouts: Vec::new(),
            holes: Vec::new(),
            fillets: None,
            trial: Err("a sample".to_owned()),
        }),
    }
}

/// The plate of a part that is one.
pub fn plate_of(part: &Part) -> &Plate {
    match &part.body {
        Body::Plate(plate) => plate,
        Body::Turned(_) | Body::Coil(_) => panic!("{} is no plate", part.name),
    }
}

/// The same, to be changed.
pub fn plate_mut(part: &mut Part) -> &mut Plate {
    match &mut part.body {
        Body::Plate(plate) => plate,
        Body::Turned(_) | Body::Coil(_) => panic!("{} is no plate", part.name),
    }
}

fn hole(x_m: f64, y_m: f64, diameter_m: f64, purpose: &str) -> Hole {
    Hole { centre_m: [x_m, y_m], diameter_m, purpose: purpose.to_owned() }
}

/// A square of 10 mm with a round corner, a spline for its left side, and a hole.
fn tiny() -> Sample {
    let side = vec![[0.0, 0.01], [0.001, 0.007], [-0.001, 0.003], [0.0, 0.0]];
    let segments = vec![
        line(0.008, 0.0),
        arc([0.01, 0.002], [0.008, 0.002], true),
        line(0.01, 0.01),
        line(0.0, 0.01),
        Segment::Spline(spline(side, &[])),
        line(0.002, 0.0),
    ];
    let mut part = part("tiny", 0.002, Profile { start_m: [0.002, 0.0], segments });
    part.material = Some("PETG".to_owned());
    plate_mut(&mut part).holes = vec![hole(0.005, 0.005, 0.0034, "M3 clearance")];
    measured(part, 6 + 2 + 2)
}

fn plate() -> Sample {
    let (w, h, r) = (0.08, 0.05, 0.006);
    let mut part = part("plate", 0.005, rounded(w, h, r));
    "Plate <\"Größe\" & 100 %%d>".clone_into(&mut part.title);
    part.material = Some("aluminium EN AW-7075 ^T6".to_owned());
    plate_mut(&mut part).holes =
        vec![hole(0.04, 0.025, 0.008, "shaft Ø8"), hole(0.01, 0.01, 0.0034, "M3 clearance"), hole(0.07, 0.04, 0.0034, "M3 clearance")];
    part.notes = vec!["Deburr both sides.".to_owned(), "Don't bend.".to_owned()];
    let round = PI / 4.0 * (0.008 * 0.008 + 2.0 * 0.0034 * 0.0034);
    let boundary_m = 2.0 * (w + h) - 8.0 * r + TAU * r + PI * (0.008 + 2.0 * 0.0034);
    Sample { part, area_m2: w * h - (4.0 - PI) * r * r - round, boundary_m, faces: 8 + 3 * 2 + 2 }
}

fn ring() -> Sample {
    let (outer, inner, centre) = (0.02, 0.014, [-0.03, 0.01]);
    let mut part = part("ring", 0.003, circle(centre, outer, true));
    plate_mut(&mut part).cutouts = vec![circle(centre, inner, false)];
    Sample { part, area_m2: PI * (outer * outer - inner * inner), boundary_m: TAU * (outer + inner), faces: 2 + 2 + 2 }
}

/// A flexible strip: long edges beside an Euler spiral, ends with fillets.
fn strip() -> Sample {
    let (length, half, fillet) = (0.12, 0.0009, 0.0004);
    let rule = GaussLegendre::new(12);
    let heading = |s: f64| 1.4 * (s / length) * (s / length) - 0.3;
    let beside = |s: f64, offset: f64| {
        let middle = [rule.integrate(|u| s * maths::cos(heading(u * s))), rule.integrate(|u| s * maths::sin(heading(u * s)))];
        let (sin, cos) = maths::sin_cos(heading(s));
        [middle[0] - offset * sin, middle[1] + offset * cos]
    };
    let station = |k: u32| fillet + (length - 2.0 * fillet) * f64::from(k) / 24.0;
    let right = spline((0..=24).map(|k| beside(station(k), -half)).collect(), &[]);
    let left = spline((0..=24).rev().map(|k| beside(station(k), half)).collect(), &[0.2, 0.2, 0.7]);
    let end = |s: f64, out: f64, side: f64| {
        let (sin, cos) = maths::sin_cos(heading(s));
        let [x, y] = beside(s, side * (half - fillet));
        ([x + out * fillet * cos, y + out * fillet * sin], [x, y])
    };
    let (last, first) = (length - fillet, fillet);
    let segments = vec![
        Segment::Spline(right),
        arc(end(last, 1.0, -1.0).0, end(last, 1.0, -1.0).1, true),
        Segment::Line { to_m: end(last, 1.0, 1.0).0 },
        arc(beside(last, half), end(last, 1.0, 1.0).1, true),
        Segment::Spline(left),
        arc(end(first, -1.0, 1.0).0, end(first, -1.0, 1.0).1, true),
        Segment::Line { to_m: end(first, -1.0, -1.0).0 },
        arc(beside(first, -half), end(first, -1.0, -1.0).1, true),
    ];
    let outline = Profile { start_m: beside(first, -half), segments };
    measured(part("strip", 0.004, outline), 8 + 2)
}

/// Fifteen teeth of four segments each, with a bore and a kidney slot.
fn gear() -> Sample {
    let (teeth, root, tip) = (15, 0.02, 0.024);
    let pitch = TAU / f64::from(teeth);
    let start_m = polar(root, 0.0);
    let mut segments = Vec::new();
    for tooth in 0..teeth {
        let at = |share: f64| pitch * (f64::from(tooth) + share);
        segments.push(arc(polar(root, at(0.4)), [0.0; 2], true));
        segments.push(Segment::Line { to_m: polar(tip, at(0.55)) });
        segments.push(arc(polar(tip, at(0.8)), [0.0; 2], true));
        segments.push(Segment::Line { to_m: if tooth + 1 == teeth { start_m } else { polar(root, at(1.0)) } });
    }
    let mut part = part("gear", 0.006, Profile { start_m, segments });
    let (inner, outer) = (0.008, 0.012);
    let end = |angle: f64| polar(0.5 * (inner + outer), angle);
    plate_mut(&mut part).cutouts = vec![Profile {
        start_m: polar(outer, 1.5),
        segments: vec![
            arc(polar(outer, -1.0), [0.0; 2], false),
            arc(polar(inner, -1.0), end(-1.0), false),
            arc(polar(inner, 1.5), [0.0; 2], true),
            arc(polar(outer, 1.5), end(1.5), false),
        ],
    }];
    plate_mut(&mut part).holes = vec![hole(0.0, 0.0, 0.006, "bore")];
    measured(part, 60 + 4 + 2 + 2)
}

/// An outline and a cutout with arcs beyond the half circle.
fn keyhole() -> Sample {
    let head = |radius: f64, angle: f64, centre: [f64; 2]| {
        let [x, y] = polar(radius, angle);
        [centre[0] + x, centre[1] + y]
    };
    let centre = [0.1, 0.2];
    let outline = Profile {
        start_m: head(0.01, -1.2, centre),
        segments: vec![
            arc(head(0.01, -1.9, centre), centre, true),
            line(head(0.01, -1.9, centre)[0], 0.16),
            line(head(0.01, -1.2, centre)[0], 0.16),
            Segment::Line { to_m: head(0.01, -1.2, centre) },
        ],
    };
    let mut part = part("keyhole", 0.002, outline);
    let (from, to) = (head(0.004, -1.3, centre), head(0.004, -1.8, centre));
    plate_mut(&mut part).cutouts =
        vec![Profile { start_m: to, segments: vec![arc(from, centre, false), line(0.1, 0.17), Segment::Line { to_m: to }] }];
    measured(part, 4 + 3 + 2)
}

/// A closed spline around a spline with a kink.
fn blob() -> Sample {
    let around = |k: u32, radius: f64| polar(radius * (1.0 + 0.2 * maths::cos(3.0 * f64::from(k) * TAU / 12.0)), f64::from(k) * TAU / 12.0);
    let mut outer: Vec<[f64; 2]> = (0..12).map(|k| around(k, 0.03)).collect();
    outer.push(outer[0]);
    let outline = Profile { start_m: outer[0], segments: vec![Segment::Spline(spline(outer, &[]))] };
    let mut part = part("blob", 0.01, outline);
    let mut inner: Vec<[f64; 2]> = (0..12).rev().map(|k| around(k, 0.012)).collect();
    inner.push(inner[0]);
    let start_m = inner[0];
    plate_mut(&mut part).cutouts = vec![Profile { start_m, segments: vec![Segment::Spline(spline(inner, &[0.5, 0.5, 0.5]))] }];
    measured(part, 2 + 2 + 2)
}

/// A clamped spline over [−1, 3] with these knots, given as shares of that, and as many equal steps as it takes.
pub fn spline(control_m: Vec<[f64; 2]>, inner: &[f64]) -> Spline {
    let equal = control_m.len() - 4 - inner.len();
    let mut shares: Vec<f64> = (1..=equal).map(|k| k as f64 / (equal + 1) as f64).chain(inner.iter().copied()).collect();
    shares.sort_by(f64::total_cmp);
    let knots = [0.0; 4].into_iter().chain(shares).chain([1.0; 4]).map(|share| 4.0 * share - 1.0).collect();
    Spline { control_m, knots }
}

/// A sample whose area and length are integrated along its boundaries.
fn measured(part: Part, faces: usize) -> Sample {
    let plate = plate_of(&part);
    let rounds = plate.holes.iter().map(|hole| circle(hole.centre_m, 0.5 * hole.diameter_m, false));
    let profiles: Vec<Profile> = std::iter::once(&plate.outline).chain(&plate.cutouts).cloned().chain(rounds).collect();
    let [area_m2, boundary_m] = profiles.iter().map(integrals).fold([0.0; 2], |sum, each| [sum[0] + each[0], sum[1] + each[1]]);
    Sample { part, area_m2, boundary_m, faces }
}

/// Area (counterclockwise is positive) and length of a profile, by quadrature of `½∮(x dy − y dx)` and `∮ds`.
pub fn integrals(profile: &Profile) -> [f64; 2] {
    let rule = GaussLegendre::new(16);
    let mut from = profile.start_m;
    let mut sum = [0.0; 2];
    for segment in &profile.segments {
        let pieces: Vec<(f64, f64)> = match segment {
            Segment::Spline(spline) => spline.knots.windows(2).map(|pair| (pair[0], pair[1])).filter(|pair| pair.0 < pair.1).collect(),
            _ => (0..4).map(|k| (f64::from(k) / 4.0, f64::from(k + 1) / 4.0)).collect(),
        };
        for (low, high) in pieces {
            for (value, sum) in sum.iter_mut().enumerate() {
                *sum += rule.integrate(|u| {
                    let (p, d) = point_and_slope(segment, from, low + u * (high - low));
                    (high - low) * if value == 0 { 0.5 * (p[0] * d[1] - p[1] * d[0]) } else { maths::hypot(d[0], d[1]) }
                });
            }
        }
        from = segment.end_m();
    }
    sum
}

/// A point of a segment and its derivative, over [0, 1], or the knots of a spline.
pub fn point_and_slope(segment: &Segment, from: [f64; 2], t: f64) -> ([f64; 2], [f64; 2]) {
    match segment {
        Segment::Line { to_m } => {
            let step = [to_m[0] - from[0], to_m[1] - from[1]];
            ([from[0] + t * step[0], from[1] + t * step[1]], step)
        }
        Segment::Arc { to_m, centre_m, counterclockwise } => {
            let angle = |p: &[f64; 2]| maths::atan2(p[1] - centre_m[1], p[0] - centre_m[0]);
            let (first, mut last) = (angle(&from), angle(to_m));
            if *counterclockwise && last < first {
                last += TAU;
            } else if !counterclockwise && last > first {
                last -= TAU;
            }
            let radius = maths::hypot(from[0] - centre_m[0], from[1] - centre_m[1]);
            let [x, y] = polar(radius, first + t * (last - first));
            ([centre_m[0] + x, centre_m[1] + y], [-y * (last - first), x * (last - first)])
        }
        Segment::Spline(spline) => spline_at(spline, t),
    }
}

/// The textbook sum of control points times basis functions (Cox and de Boor), and its derivative.
fn spline_at(spline: &Spline, t: f64) -> ([f64; 2], [f64; 2]) {
    fn basis(knots: &[f64], i: usize, degree: usize, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
        }
        let share = |above: f64, span: f64, of: f64| if span > 0.0 { above / span * of } else { 0.0 };
        share(t - knots[i], knots[i + degree] - knots[i], basis(knots, i, degree - 1, t))
            + share(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1], basis(knots, i + 1, degree - 1, t))
    }
    let (mut point, mut slope) = ([0.0; 2], [0.0; 2]);
    for (i, control) in spline.control_m.iter().enumerate() {
        let weight = basis(&spline.knots, i, 3, t);
        for axis in 0..2 {
            point[axis] += weight * control[axis];
        }
    }
    for (i, pair) in spline.control_m.windows(2).enumerate() {
        let span = spline.knots[i + 4] - spline.knots[i + 1];
        if span > 0.0 {
            let weight = 3.0 / span * basis(&spline.knots, i + 1, 2, t);
            for axis in 0..2 {
                slope[axis] += weight * (pair[1][axis] - pair[0][axis]);
            }
        }
    }
    (point, slope)
}
