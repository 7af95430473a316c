//! Drawn teeth rolled on each other: transmission, length of contact, backlash, and where they overlap.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{acos, atan2, cos, sin, sin_cos, tan};
use forcewright_base::roots;
use forcewright_curves::plane::PlaneCurve;
use forcewright_curves::vector::{Vector, add, cross, norm, rotate, scale, sub};
use forcewright_elements::gears::interference::corner_rooms_m;
use forcewright_elements::gears::{Kind, Mesh, Piece, Rack, Region, ReliefShape, TipRelief, ToothProfile, Wheel, WheelSpec, involute};

mod rack;

use rack::rolled_past_rack_m;

const MODULE_M: f64 = 1e-3;
const ALPHA: f64 = PI / 9.0;

fn spec(kind: Kind, teeth: u32, shift: f64) -> WheelSpec {
    WheelSpec { kind, teeth, module_m: MODULE_M, rack: Rack::ISO_53_A, profile_shift: shift, tip_shortening: 0.0, thinning_m: 0.0 }
}

fn tooth(spec: WheelSpec) -> ToothProfile {
    ToothProfile::new(&Wheel::new(spec).unwrap(), None).unwrap()
}

fn z(tooth: &ToothProfile) -> f64 {
    f64::from(tooth.wheel().spec.teeth)
}

/// Two gears, the first external with its middle in the origin, the second with its middle on the x axis; the tooth of the first that faces
/// counterclockwise drives. Angles of the second are those of its tooth at the pitch point, from the direction of that point.
struct Pair {
    one: ToothProfile,
    two: ToothProfile,
    apart_m: f64,
}

impl Pair {
    fn is_ring(&self) -> bool {
        self.two.wheel().spec.kind == Kind::Internal
    }

    /// Middle of the second gear, m.
    fn middle(&self) -> Vector {
        [if self.is_ring() { -self.apart_m } else { self.apart_m }, 0.0]
    }

    /// From the frame of the first gear to polar coordinates about the second: radius, and angle from the direction of the pitch point, upwards.
    fn seen(&self, point: Vector) -> (f64, f64) {
        let [x, y] = sub(point, self.middle());
        (norm([x, y]), if self.is_ring() { atan2(y, x) } else { atan2(y, -x) })
    }

    /// By what part of a turn of the first the second turns upwards at the pitch point.
    fn ratio(&self) -> f64 {
        z(&self.one) / z(&self.two)
    }

    fn working_rad(&self) -> f64 {
        let [r1, r2] = [&self.one, &self.two].map(|tooth| tooth.wheel().base_radius_m);
        acos(if self.is_ring() { r2 - r1 } else { r1 + r2 } / self.apart_m)
    }

    /// Room upwards between a place of the first gear and the downward flank of the second's tooth in its middle position, rad.
    fn room(&self, point: Vector) -> Option<f64> {
        let (radius, angle) = self.seen(point);
        let flank = flanks(&self.two);
        let [mut low, mut high] = [f64::INFINITY, 0.0_f64];
        for piece in &flank {
            let radii = piece.radii_m();
            (low, high) = (low.min(radii[0].min(radii[1])), high.max(radii[0].max(radii[1])));
        }
        (low <= radius && radius <= high).then(|| -(angle + self.two.half_angle_rad(radius).unwrap()))
    }

    /// Angle of the second at which the drawn flanks just touch, the first turned by an angle: the largest that any place of the flank of the
    /// first asks for.
    fn touching_rad(&self, turn: f64) -> Option<f64> {
        let mut most: Option<f64> = None;
        for piece in flanks(&self.one) {
            let asked = |u: f64| self.room(rotate(piece.at(u).point_m, turn)).map_or(f64::NEG_INFINITY, |room| -room);
            let steps = 200;
            let best = (0..=steps).max_by(|a, b| asked(f64::from(*a) / 200.0).total_cmp(&asked(f64::from(*b) / 200.0))).unwrap();
            let at = |k: i32| (f64::from(k) / f64::from(steps)).clamp(0.0, 1.0);
            let inner = -roots::minimise(|u| -asked(u), at(best - 1), at(best + 1), 1e-12).value;
            let found = inner.max(asked(at(best)));
            if found.is_finite() {
                most = Some(most.map_or(found, |most| most.max(found)));
            }
        }
        most
    }

    /// The same for the other flanks, downwards, by the mirror image.
    fn touching_down_rad(&self, turn: f64) -> Option<f64> {
        self.touching_rad(-turn).map(|angle| -angle)
    }

    /// Turn of the first at which one end of a flank is where both flanks have a common tangent: the tip of the first, or of the second.
    fn end_of_contact_rad(&self, of_first: bool, near: f64) -> f64 {
        let [one, two] = [&self.one, &self.two].map(|tooth| flanks(tooth)[0]);
        if of_first {
            let tip = one.at(0.0);
            let miss = |turn: f64| {
                let (radius, angle) = self.seen(rotate(tip.point_m, turn));
                cross(rotate(tip.first_m, turn), self.tangent_of_second(&two, radius, angle))
            };
            return roots::root(miss, near - 0.03, near + 0.03, 0.0).unwrap();
        }
        // The second's tip where it touches: the first turned so that its flank passes there, in the direction of the second's.
        let tip_radius = self.two.wheel().tip_radius_m;
        let place = |angle: f64| {
            let along = if self.is_ring() { [cos(angle), sin(angle)] } else { [-cos(angle), sin(angle)] };
            add(self.middle(), scale(along, tip_radius))
        };
        let turn_at = |angle: f64| {
            let point = place(angle);
            let u = at_radius(&one, norm(point));
            let own = one.at(u);
            (atan2(point[1], point[0]) - atan2(own.point_m[1], own.point_m[0]), own.first_m)
        };
        let miss = |angle: f64| {
            let (turn, first) = turn_at(angle);
            cross(rotate(first, turn), self.tangent_of_second(&two, tip_radius, angle))
        };
        let guess = self.seen(rotate(one.at(0.9).point_m, near)).1;
        let found = (1..200).find_map(|k| {
            let reach = 0.002 * f64::from(k) / z(&self.two) * 20.0;
            let inside = |a: f64| norm(place(a)) >= one.radii_m()[1] && norm(place(a)) <= one.radii_m()[0];
            let (low, high) = (guess - reach, guess + reach);
            (inside(low) && inside(high)).then(|| roots::root(miss, low, high, 0.0).ok()).flatten()
        });
        turn_at(found.unwrap()).0
    }

    /// Direction of the flank of the second's tooth that faces down, where it passes a radius at an angle.
    fn tangent_of_second(&self, flank: &Piece, radius: f64, angle: f64) -> Vector {
        let own = flank.at(at_radius(flank, radius));
        let turned = rotate(own.first_m, -atan2(own.point_m[1], own.point_m[0]));
        // Downward flank: the mirror image of the one that faces up, seen from the middle of a ring; on the far side it is seen the other way.
        let [x, y] = turned;
        if self.is_ring() {
            rotate([x, -y], angle)
        } else {
            let [x, y] = rotate([x, -y], angle);
            [-x, y]
        }
    }
}

/// Relief and flank.
fn flanks(tooth: &ToothProfile) -> Vec<Piece> {
    tooth.pieces().iter().filter(|piece| matches!(piece.region, Region::Flank | Region::Relief)).copied().collect()
}

/// Parameter at which a flank passes a radius.
fn at_radius(piece: &Piece, radius: f64) -> f64 {
    let miss = |u: f64| norm(piece.at(u).point_m) - radius;
    roots::root(miss, 0.0, 1.0, 0.0).unwrap_or(if miss(0.0).abs() < miss(1.0).abs() { 0.0 } else { 1.0 })
}

/// Pairs of all kinds with a centre distance over the one of no backlash, modules.
fn pairs() -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (kind, teeth, shifts, apart) in [
        (Kind::External, [20, 33], [0.0, 0.0], 0.0),
        (Kind::External, [20, 33], [0.0, 0.0], 0.2),
        (Kind::External, [12, 18], [0.4, 0.2], 0.05),
        (Kind::External, [25, 60], [0.5, -0.3], 0.0),
        (Kind::External, [17, 90], [0.3, 0.6], 0.1),
        (Kind::Internal, [18, 48], [0.2, 0.8], 0.0),
        (Kind::Internal, [18, 48], [0.2, 0.8], -0.1),
        (Kind::Internal, [25, 90], [0.0, 0.0], 0.0),
        (Kind::Internal, [30, 72], [0.4, 0.5], 0.0),
    ] {
        let outwards = if kind == Kind::External { 1.0 } else { -1.0 };
        let shorter = if kind == Kind::External { 0.0 } else { 0.25 };
        let one = tooth(WheelSpec { tip_shortening: 0.1, thinning_m: 0.01 * MODULE_M, ..spec(Kind::External, teeth[0], shifts[0]) });
        let two = tooth(WheelSpec { tip_shortening: shorter, thinning_m: 0.02 * MODULE_M, ..spec(kind, teeth[1], shifts[1]) });
        let apart_m = without_backlash_m(kind, teeth, shifts) + apart * MODULE_M;
        assert!(apart_m > 0.0 && outwards * apart >= 0.0);
        pairs.push(Pair { one, two, apart_m });
    }
    pairs
}

/// inv `α_w` = inv α + 2 tan α (x₂ ± x₁)/(z₂ ± z₁), a = m (z₂ ± z₁)/2 · cos α/cos `α_w`; ISO 21771-1.
fn without_backlash_m(kind: Kind, teeth: [u32; 2], shifts: [f64; 2]) -> f64 {
    let sign = if kind == Kind::External { 1.0 } else { -1.0 };
    let both = f64::from(teeth[1]) + sign * f64::from(teeth[0]);
    let inv = involute(ALPHA) + 2.0 * tan(ALPHA) * (shifts[1] + sign * shifts[0]) / both;
    let working = roots::root(|a| involute(a) - inv, 0.0, 1.2, 0.0).unwrap();
    0.5 * MODULE_M * both * cos(ALPHA) / cos(working)
}

/// Turns of the first at which its tip, and the tip of the second, are on the line of action, from the involutes.
fn ends_of_contact(pair: &Pair) -> [f64; 2] {
    let Pair { one, two, apart_m } = pair;
    let working = pair.working_rad();
    let half_base = 0.5 * one.wheel().tooth_angle_rad(one.wheel().base_radius_m);
    let length = |tooth: &ToothProfile| {
        let Wheel { tip_radius_m, base_radius_m, .. } = *tooth.wheel();
        (tip_radius_m * tip_radius_m - base_radius_m * base_radius_m).sqrt()
    };
    let start = if pair.is_ring() { length(two) - apart_m * sin(working) } else { apart_m * sin(working) - length(two) };
    // The flank at ψ_b − w/r_b stands at the direction −α_w of the foot of the line of action.
    [length(one), start].map(|w| w / one.wheel().base_radius_m - half_base - working)
}

#[test]
fn the_angle_is_passed_on_without_error() {
    for pair in pairs() {
        let [end, start] = ends_of_contact(&pair);
        let flat = |turn: f64| pair.touching_rad(turn).unwrap() - turn * pair.ratio();
        let middle = flat(0.5 * (start + end));
        for k in 0..=60 {
            let turn = start + (end - start) * f64::from(k).clamp(0.001, 59.999) / 60.0;
            let error = flat(turn) - middle;
            assert!(error.abs() < 3e-14, "{} {}: {k} {error:e}", z(&pair.one), z(&pair.two));
        }
        // Beyond its path the pair falls behind: its tips are no conjugate places.
        for turn in [start - 0.02, end + 0.02] {
            assert!(flat(turn) < middle - 1e-7, "{} {}", z(&pair.one), z(&pair.two));
        }
    }
}

/// Where the tips come into and out of contact on the drawn flanks, by common tangents; the interval over a pitch is the contact ratio
/// (ISO 21771-1): path of contact over `m π cos α`.
#[test]
fn the_interval_of_contact_is_the_contact_ratio() {
    for pair in pairs() {
        let guess = ends_of_contact(&pair);
        let end = pair.end_of_contact_rad(true, guess[0]);
        let start = pair.end_of_contact_rad(false, guess[1]);
        let measured = (end - start) * z(&pair.one) / TAU;
        let length = |tooth: &ToothProfile| {
            let r = tooth.wheel().spec.teeth;
            let base = 0.5 * f64::from(r) * MODULE_M * cos(ALPHA);
            (tooth.wheel().tip_radius_m * tooth.wheel().tip_radius_m - base * base).sqrt()
        };
        let sign = if pair.is_ring() { -1.0 } else { 1.0 };
        let path = length(&pair.one) + sign * length(&pair.two) - sign * pair.apart_m * sin(pair.working_rad());
        let ratio = path / (PI * MODULE_M * cos(ALPHA));
        assert!((measured - ratio).abs() < 1e-11, "{} {}: {measured} {ratio}", z(&pair.one), z(&pair.two));
        assert!((1.0..2.2).contains(&ratio), "{ratio}");
    }
}

/// From one flank to the other: j = p − s₁ − s₂ on the operating pitch circles.
#[test]
fn backlash_between_drawn_flanks_is_the_formula() {
    for pair in pairs() {
        let [end, start] = ends_of_contact(&pair);
        let turn = 0.6 * start + 0.4 * end;
        let up = pair.touching_rad(turn).unwrap() - turn * pair.ratio();
        let down = pair.touching_down_rad(-turn).unwrap() + turn * pair.ratio();
        // Half a pitch of the second less on either side is where its teeth stand.
        let measured = TAU / z(&pair.two) - (up - down);
        let working = pair.working_rad();
        let sign = if pair.is_ring() { -1.0 } else { 1.0 };
        let operating = |tooth: &ToothProfile| tooth.wheel().base_radius_m / cos(working);
        let thickness = |tooth: &ToothProfile, sign: f64| {
            let WheelSpec { profile_shift, thinning_m, .. } = tooth.wheel().spec;
            let s = MODULE_M * (PI / 2.0 + sign * 2.0 * profile_shift * tan(ALPHA)) - thinning_m;
            2.0 * operating(tooth) * (s / (MODULE_M * z(tooth)) + sign * (involute(ALPHA) - involute(working)))
        };
        let backlash = TAU * operating(&pair.one) / z(&pair.one) - thickness(&pair.one, 1.0) - thickness(&pair.two, sign);
        assert!((measured * operating(&pair.two) - backlash).abs() < 1e-14 * pair.apart_m.max(1.0), "{measured} {backlash}");
        assert!(backlash > 0.02 * MODULE_M);
    }
}

/// With relief the second gear falls behind by its amount over the base radius when the tip is in contact, and not before.
#[test]
fn relief_shows_as_transmission_error() {
    let wheel = Wheel::new(spec(Kind::External, 20, 0.0)).unwrap();
    let amount = 1e-4 * MODULE_M;
    let relief = TipRelief::over_length(&wheel, amount, 0.4 * MODULE_M, ReliefShape::Linear).unwrap();
    let pair =
        Pair { one: ToothProfile::new(&wheel, Some(relief)).unwrap(), two: tooth(spec(Kind::External, 33, 0.0)), apart_m: 26.5 * MODULE_M };
    let [end, start] = ends_of_contact(&pair);
    let base = [&pair.one, &pair.two].map(|tooth| tooth.wheel().base_radius_m);
    let flat = |turn: f64| (pair.touching_rad(turn).unwrap() - turn * pair.ratio()) * base[1] / amount;
    let before = flat(0.5 * (start + end));
    let kink = end - 0.4 * MODULE_M / base[0];
    assert!((flat(kink - 1e-3) - before).abs() < 1e-10);
    // On the drawn flank, which is a little steeper than the involute, the contact is a little nearer to the root: second order in the amount.
    let half = flat(0.5 * (kink + end));
    assert!((half - before + 0.5).abs() < 5e-3, "{}", half - before);
    let tip = flat(end);
    assert!((tip - before + 1.0).abs() < 5e-3, "{}", tip - before);
}

// ---- Overlap ----------------------------------------------------------------------------------------------------------------------------

/// A gear in the plane: its middle, and the direction of tooth 0.
struct Placed<'a> {
    tooth: &'a ToothProfile,
    middle: Vector,
    turn: f64,
}

impl Placed<'_> {
    /// How deep a point lies in the material, measured along the circle, m; negative outside.
    fn depth(&self, point: Vector) -> f64 {
        let Wheel { tip_radius_m, root_radius_m, spec, .. } = *self.tooth.wheel();
        let [x, y] = sub(point, self.middle);
        let radius = norm([x, y]);
        let (beyond, within) = if spec.kind == Kind::External {
            (radius > tip_radius_m, radius < root_radius_m)
        } else {
            (radius < tip_radius_m, radius > root_radius_m)
        };
        if beyond {
            return -MODULE_M;
        }
        if within {
            return (radius - root_radius_m).abs();
        }
        let pitch = TAU / f64::from(spec.teeth);
        let angle = (atan2(y, x) - self.turn + 0.5 * pitch).rem_euclid(pitch) - 0.5 * pitch;
        radius * (self.tooth.half_angle_rad(radius).unwrap() - angle.abs())
    }

    /// Points of the whole boundary near a point.
    fn boundary(&self, near: Vector, reach: f64, per_piece: u32) -> Vec<Vector> {
        let along = |piece: &Piece| (0..=per_piece).map(|i| piece.at(f64::from(i) / f64::from(per_piece)).point_m).collect::<Vec<_>>();
        let one_side: Vec<Vector> = self.tooth.pieces().iter().flat_map(along).collect();
        let teeth = self.tooth.wheel().spec.teeth;
        let mut points = Vec::new();
        for k in 0..teeth {
            let turn = self.turn + TAU * f64::from(k) / f64::from(teeth);
            let (sin, cos) = sin_cos(turn);
            let put = |[x, y]: Vector| add(self.middle, [cos * x - sin * y, sin * x + cos * y]);
            if norm(sub(put([self.tooth.wheel().tip_radius_m, 0.0]), near)) <= reach {
                points.extend(one_side.iter().flat_map(|[x, y]| [put([*x, *y]), put([*x, -*y])]));
            }
        }
        points
    }
}

/// Deepest that either gear lies in the other, m, over the boundaries of teeth near a point.
fn overlap_m(one: &Placed<'_>, two: &Placed<'_>, near: Vector, reach: f64, per_piece: u32) -> f64 {
    let of = |a: &Placed<'_>, b: &Placed<'_>| {
        a.boundary(near, reach, per_piece).into_iter().map(|point| b.depth(point)).fold(f64::NEG_INFINITY, f64::max)
    };
    of(one, two).max(of(two, one))
}

impl Pair {
    /// Deepest overlap over a pitch of turning, the driving flanks in contact, m.
    fn deepest_m(&self, reach: f64) -> f64 {
        let [end, start] = ends_of_contact(self);
        // In the middle of what all flanks and formulas agree on: the pitch point.
        let middle = (0.5 * (start + end)).clamp(start.min(end), start.max(end));
        let working = self.working_rad();
        let base = 0.5 * self.one.wheel().tooth_angle_rad(self.one.wheel().base_radius_m);
        let at_pitch = involute(working) - base;
        let half_two = 0.5 * self.two.wheel().tooth_angle_rad(self.two.wheel().base_radius_m / cos(working));
        let offset = half_two - at_pitch * self.ratio();
        let steps = 48;
        let mut deepest = f64::NEG_INFINITY;
        for k in 0..steps {
            let turn = middle + TAU / z(&self.one) * f64::from(k) / f64::from(steps);
            let up = turn * self.ratio() + offset;
            let one = Placed { tooth: &self.one, middle: [0.0; 2], turn };
            let two = Placed { tooth: &self.two, middle: self.middle(), turn: if self.is_ring() { up } else { PI - up } };
            let pitch_point = [self.one.wheel().base_radius_m / cos(working), 0.0];
            deepest = deepest.max(overlap_m(&one, &two, pitch_point, reach, 16));
        }
        deepest
    }
}

/// Conjugate flanks alone do not overlap by more than rounding; so depths below are interference.
const TOUCHING_M: f64 = 1e-9 * MODULE_M;

/// Length of the tangent to the base circle at the involute's first place, for the rack A: `r sin α + (x − h + ρ (1 − sin α)) m/sin α`.
fn form_length_m(teeth: u32, shift: f64) -> f64 {
    0.5 * f64::from(teeth) * MODULE_M * sin(ALPHA) + (shift - 1.25 + 0.38 * (1.0 - sin(ALPHA))) * MODULE_M / sin(ALPHA)
}

/// √(r² − `r_b`²).
fn tangent_length_m(radius: f64, tooth: &ToothProfile) -> f64 {
    (radius * radius - tooth.wheel().base_radius_m * tooth.wheel().base_radius_m).sqrt()
}

/// Whether a margin of tip corners in fillets is below 0.
fn corners_foul(pair: &Pair) -> bool {
    let mesh = Mesh::new(*pair.one.wheel(), *pair.two.wheel(), pair.apart_m).unwrap();
    corner_rooms_m(&mesh).into_iter().flatten().any(|room_m| room_m < -TOUCHING_M)
}

/// Corners in fillets with long teeth, teeth outside and in a ring, bottom clearance left: drawn teeth overlap where a margin is below 0, and by
/// about as much. In some of these pairs the tips keep clear of the form circles.
#[test]
fn corners_overlap_fillets_where_the_margin_says() {
    let (mut clean, mut foul, mut hidden) = (0, 0, 0);
    for (kind, teeth, shifts, addendum, root_radius) in [
        (Kind::External, [16, 24], [0.5, 1.0], 1.0, 0.38),
        (Kind::External, [16, 24], [0.5, 1.0], 0.9, 0.38),
        (Kind::External, [24, 24], [0.8, 0.8], 1.0, 0.38),
        (Kind::External, [23, 35], [0.78, 0.8], 1.0, 0.38),
        (Kind::External, [30, 60], [0.3, 0.2], 1.2, 0.1),
        (Kind::External, [30, 60], [0.3, 0.2], 1.1, 0.1),
        (Kind::Internal, [31, 74], [-0.077, 0.056], 1.216, 0.208),
        (Kind::Internal, [31, 74], [-0.077, 0.056], 1.15, 0.208),
        (Kind::Internal, [33, 88], [0.609, 1.068], 1.245, 0.285),
        (Kind::Internal, [41, 102], [0.484, 0.854], 1.227, 0.251),
        (Kind::Internal, [56, 101], [0.809, 1.406], 1.296, 0.0515),
        (Kind::Internal, [40, 100], [0.5, 0.9], 1.0, 0.25),
    ] {
        let rack = Rack { addendum, root_radius, ..Rack::ISO_53_A };
        let thinning_m = 0.05 * MODULE_M;
        let make = |kind, i: usize| tooth(WheelSpec { rack, thinning_m, ..spec(kind, teeth[i], shifts[i]) });
        let pair = Pair { one: make(Kind::External, 0), two: make(kind, 1), apart_m: without_backlash_m(kind, teeth, shifts) };
        let mesh = Mesh::new(*pair.one.wheel(), *pair.two.wheel(), pair.apart_m).unwrap();
        assert!(mesh.bottom_clearances_m().into_iter().all(|room_m| room_m > 0.0), "{kind:?} {teeth:?} {shifts:?}");
        let least_m = corner_rooms_m(&mesh).into_iter().flatten().fold(f64::INFINITY, f64::min);
        let deepest_m = pair.deepest_m(6.0 * MODULE_M);
        assert_eq!(deepest_m > TOUCHING_M, least_m < -TOUCHING_M, "{kind:?} {teeth:?} {addendum}: {deepest_m:e} {least_m:e}");
        let path = mesh.path();
        let on_the_line = path.tips.start_m < path.forms.start_m || path.tips.end_m > path.forms.end_m;
        if least_m < -TOUCHING_M {
            assert!((0.5..2.0).contains(&(-least_m / deepest_m)), "{kind:?} {teeth:?} {addendum}: {deepest_m:e} {least_m:e}");
            foul += 1;
            hidden += u32::from(!on_the_line);
        } else {
            clean += 1;
        }
    }
    assert!(clean >= 4 && foul >= 7 && hidden >= 4, "{clean} {foul} {hidden}");
}

/// A tip that reaches below the form circle of its mate cuts into the fillet: a sin `α_w` − √(`r_a2²` − `r_b2²`) against the w at which the mate's
/// involute begins. A tip that stays above the straight part of the rack does not. Between the two the form circle is passed by no contact of
/// flanks, and yet the corner of the tip, deepest on the line of centres, may cut into the fillet: the form circle alone does not tell.
#[test]
fn tips_overlap_fillets_where_the_formula_says() {
    let (mut clean, mut foul, mut between) = (0, 0, [0; 2]);
    for (teeth, shifts) in
        [([18, 40], [0.0, 0.0]), ([20, 25], [0.2, 0.0]), ([30, 60], [0.0, -0.2]), ([14, 100], [0.3, 0.0]), ([40, 90], [0.0, 0.0])]
    {
        for addendum in [0.7, 0.9, 0.99, 1.03, 1.1, 1.15, 1.2, 1.24] {
            let thinning_m = 0.05 * MODULE_M;
            let rack = Rack { addendum, dedendum: 1.4, root_radius: 0.3, ..Rack::ISO_53_A };
            let one = tooth(WheelSpec { thinning_m, tip_shortening: 0.1, ..spec(Kind::External, teeth[0], shifts[0]) });
            let two = tooth(WheelSpec { thinning_m, rack, ..spec(Kind::External, teeth[1], shifts[1]) });
            let apart_m = without_backlash_m(Kind::External, teeth, shifts);
            let pair = Pair { one, two, apart_m };
            let tip_m = pair.two.wheel().tip_radius_m;
            let reach = apart_m * sin(pair.working_rad()) - tangent_length_m(tip_m, &pair.two);
            let form = form_length_m(teeth[0], shifts[0]);
            let straight = 1.25 - 0.38 * (1.0 - sin(ALPHA)) - shifts[0];
            let depth = tip_m - (apart_m - 0.5 * f64::from(teeth[0]) * MODULE_M);
            let overlaps = pair.deepest_m(5.0 * MODULE_M) > TOUCHING_M;
            // The margin of the corner tells in all three cases.
            assert_eq!(overlaps, corners_foul(&pair), "{teeth:?} {addendum}");
            if reach < form {
                assert!(overlaps, "{teeth:?} {addendum}");
                foul += 1;
            } else if depth < straight * MODULE_M {
                assert!(!overlaps, "{teeth:?} {addendum}");
                clean += 1;
            } else {
                between[usize::from(overlaps)] += 1;
            }
        }
    }
    assert!(clean >= 6 && foul >= 3 && between.iter().all(|count| *count > 0), "{clean} {foul} {between:?}");
}

/// 20 and 25 teeth, a mate with an addendum of 1.2: contact ends at w = 1.194 m, above the form circle's 1.081 m, but the corner of the tip comes
/// into the fillet near the line of centres, to where the rack that cut the gear never came.
#[test]
fn a_tip_may_lie_in_a_fillet_above_the_form_circle() {
    for (addendum, overlaps) in [(1.1, false), (1.2, true)] {
        let rack = Rack { addendum, dedendum: 1.4, root_radius: 0.3, ..Rack::ISO_53_A };
        let thinning_m = 0.05 * MODULE_M;
        let one = tooth(WheelSpec { thinning_m, tip_shortening: 0.1, ..spec(Kind::External, 20, 0.2) });
        let two = tooth(WheelSpec { thinning_m, rack, ..spec(Kind::External, 25, 0.0) });
        let pair = Pair { one, two, apart_m: without_backlash_m(Kind::External, [20, 25], [0.2, 0.0]) };
        let tip = pair.two.wheel().tip_radius_m;
        let reach = pair.apart_m * sin(pair.working_rad()) - tangent_length_m(tip, &pair.two);
        assert!(reach > form_length_m(20, 0.2) + 0.1 * MODULE_M);
        // The corner's way in the frame of the first, one flank in contact, and how far it stays from the rack at each place.
        let half = |tooth: &ToothProfile, radius: f64| 0.5 * tooth.wheel().tooth_angle_rad(radius);
        let working = [&pair.one, &pair.two].map(|tooth| tooth.wheel().base_radius_m / cos(pair.working_rad()));
        let left_m = (-400..=400).map(|k| {
            let up = f64::from(k) * 1e-3;
            // The downward flank touches at the pitch point where both are turned by nothing; the corner lies on that flank.
            let angle = up + half(&pair.two, working[1]) - half(&pair.two, tip);
            let corner = [pair.apart_m - tip * cos(angle), tip * sin(angle)];
            let turn = up / pair.ratio() - half(&pair.one, working[0]);
            // From the middle of the space above the tooth.
            rolled_past_rack_m(&pair.one.wheel().spec, rotate(corner, -turn - PI / z(&pair.one)))
        });
        let (by_rack, drawn) = (left_m.fold(f64::NEG_INFINITY, f64::max), pair.deepest_m(5.0 * MODULE_M));
        if overlaps {
            // Along the normal, and along the circle.
            assert!((by_rack - 0.0088 * MODULE_M).abs() < 1e-7 && (drawn - 0.0143 * MODULE_M).abs() < 1e-7, "{by_rack} {drawn}");
        } else {
            assert!(by_rack < TOUCHING_M && drawn < TOUCHING_M, "{by_rack} {drawn}");
        }
    }
}

/// Teeth of a ring that reach below the pinion's form circle, or its base circle (involute interference), overlap it:
/// √(`r_a2²` − `r_b2²`) − a sin `α_w` against the same w.
#[test]
fn tips_of_rings_overlap_roots_of_pinions_where_the_formula_says() {
    let (mut clean, mut foul) = (0, 0);
    for (teeth, shift) in [([18, 48], 0.0), ([20, 60], 0.0), ([24, 72], 0.0), ([17, 50], 0.3), ([30, 90], 0.0)] {
        for addendum in [0.6, 0.7, 0.8, 0.9, 1.0] {
            let thinning_m = 0.05 * MODULE_M;
            let one = tooth(WheelSpec { thinning_m, tip_shortening: 0.1, ..spec(Kind::External, teeth[0], shift) });
            let ring = spec(Kind::Internal, teeth[1], shift);
            let rack = Rack { addendum, ..Rack::ISO_53_A };
            let Ok(two) = ToothProfile::new(&Wheel::new(WheelSpec { thinning_m, rack, ..ring }).unwrap(), None) else { continue };
            let pair = Pair { one, two, apart_m: without_backlash_m(Kind::Internal, teeth, [shift; 2]) };
            let reach = tangent_length_m(pair.two.wheel().tip_radius_m, &pair.two) - pair.apart_m * sin(pair.working_rad());
            let form = form_length_m(teeth[0], shift);
            assert!(form > 0.0, "{teeth:?}");
            let deepest = pair.deepest_m(6.0 * MODULE_M);
            assert_eq!(deepest > TOUCHING_M, reach < form, "{teeth:?} {addendum}: {deepest:e}, {reach} {form}");
            assert_eq!(deepest > TOUCHING_M, corners_foul(&pair), "{teeth:?} {addendum}");
            if reach < form { foul += 1 } else { clean += 1 }
        }
    }
    assert!(clean >= 4 && foul >= 4, "{clean} {foul}");
}

/// Tips of a pinion that has almost as many teeth as its ring foul the ring's tips beside the mesh, unless
/// z₁ (inv `α_a1` + δ₁) − z₂ (inv `α_a2` + δ₂) + (z₂ − z₁) inv `α_w` ≥ 0, with δ the directions of the crossing of the tip circles.
#[test]
fn tips_foul_beside_the_mesh_where_the_formula_says() {
    let (mut clean, mut foul) = (0, 0);
    for (ring_teeth, addendum) in [(40, 0.6), (60, 0.6), (60, 0.75), (80, 0.7), (100, 0.8), (120, 0.9)] {
        for difference in [3, 4, 5, 6, 7, 8, 9, 10, 12] {
            let teeth = [ring_teeth - difference, ring_teeth];
            let rack = Rack { addendum, ..Rack::ISO_53_A };
            let one = tooth(WheelSpec { rack, ..spec(Kind::External, teeth[0], 0.0) });
            let two = tooth(WheelSpec { rack, ..spec(Kind::Internal, teeth[1], 0.0) });
            let pair = Pair { one, two, apart_m: without_backlash_m(Kind::Internal, teeth, [0.0; 2]) };
            let (a, r1, r2) = (pair.apart_m, pair.one.wheel().tip_radius_m, pair.two.wheel().tip_radius_m);
            if r2 >= a + r1 {
                continue;
            }
            let [d1, d2] = [(r2 * r2 - r1 * r1 - a * a) / (2.0 * a * r1), (r2 * r2 - r1 * r1 + a * a) / (2.0 * a * r2)].map(acos);
            let inv = |tooth: &ToothProfile| involute(acos(tooth.wheel().base_radius_m / tooth.wheel().tip_radius_m));
            let (z1, z2) = (z(&pair.one), z(&pair.two));
            let room = z1 * (inv(&pair.one) + d1) - z2 * (inv(&pair.two) + d2) + (z2 - z1) * involute(pair.working_rad());
            let reach = tangent_length_m(r2, &pair.two) - a * sin(pair.working_rad());
            // Near its limit the depth is rounding; and this is not about the fillets of the pinion.
            if room.abs() < 0.02 || reach < form_length_m(teeth[0], 0.0) {
                continue;
            }
            let deepest = pair.deepest_m(2.0 * r2);
            assert_eq!(deepest > TOUCHING_M, room < 0.0, "{teeth:?} {addendum}: {deepest:e}, {room}");
            if room < 0.0 { foul += 1 } else { clean += 1 }
        }
    }
    assert!(clean >= 8 && foul >= 8, "{clean} {foul}");
}

/// Sun, planets and ring, with angles from the conditions that a tooth meets a space: `z_s` `θ_s` ≡ (`z_s` + `z_r`) λ + `z_p` π and
/// `z_p` `θ_p` ≡ π − (`z_r` − `z_p`) λ, the ring at rest with a tooth on the x axis.
fn deepest_of_set_m(gears: &[ToothProfile; 3], apart_m: f64, count: u32, carrier: f64) -> f64 {
    let [sun, planet, ring] = gears;
    let [zs, zp, zr] = [sun, planet, ring].map(z);
    let fixed = Placed { tooth: ring, middle: [0.0; 2], turn: 0.0 };
    let middle = Placed { tooth: sun, middle: [0.0; 2], turn: ((zs + zr) * carrier + zp * PI) / zs };
    let mut deepest = f64::NEG_INFINITY;
    let mut planets = Vec::new();
    for k in 0..count {
        let at = carrier + TAU * f64::from(k) / f64::from(count);
        planets.push(Placed { tooth: planet, middle: rotate([apart_m, 0.0], at), turn: (PI - (zr - zp) * at) / zp });
    }
    for (k, placed) in planets.iter().enumerate() {
        let reach = 3.0 * apart_m;
        deepest = deepest.max(overlap_m(placed, &middle, [0.0; 2], reach, 24)).max(overlap_m(placed, &fixed, [0.0; 2], reach, 24));
        for other in &planets[..k] {
            deepest = deepest.max(overlap_m(placed, other, [0.0; 2], reach, 8));
        }
    }
    deepest
}

#[test]
fn an_assembled_set_does_not_overlap() {
    let thinning_m = 0.03 * MODULE_M;
    let make =
        |kind, teeth, profile_shift, tip_shortening| tooth(WheelSpec { thinning_m, tip_shortening, ..spec(kind, teeth, profile_shift) });
    // z_r − z_p = z_s + z_p, so one centre distance asks for x_r = x_p + (x_s + x_p).
    let gears = [make(Kind::External, 12, 0.4, 0.15), make(Kind::External, 18, 0.2, 0.15), make(Kind::Internal, 48, 0.8, 0.2)];
    let apart_m = without_backlash_m(Kind::External, [12, 18], [0.4, 0.2]);
    assert!((without_backlash_m(Kind::Internal, [18, 48], [0.2, 0.8]) - apart_m).abs() < 1e-15);
    for carrier in [0.0, 0.1, 0.37, 1.0] {
        let deepest = deepest_of_set_m(&gears, apart_m, 3, carrier);
        // Teeth stand in the middle of their backlash: 0.06 m less the slope of the flanks.
        assert!(deepest < -0.015 * MODULE_M && deepest > -0.05 * MODULE_M, "{carrier}: {deepest:e}");
    }
    // Out of phase they clash: four planets, with 60/4 whole, fit, five with 60/5 too, but seven do not.
    assert!(deepest_of_set_m(&gears, apart_m, 7, 0.0) > 0.1 * MODULE_M);
}

/// 12/18/48 without shift: the sun is undercut, its contact ends early; the ring's tips would need an addendum of at most 0.871 modules not to
/// pass the planet's base circle, and 0.8365 not to touch its fillet.
#[test]
fn the_unshifted_set_12_18_48_shows_undercut_and_interference() {
    let [sun, planet] = [12, 18].map(|teeth| tooth(spec(Kind::External, teeth, 0.0)));
    assert!(sun.is_undercut() && !planet.is_undercut());
    assert!(sun.form_radius_m() > sun.wheel().base_radius_m);
    // x ≥ 1 − 6 sin² α = 0.298.
    assert!(tooth(spec(Kind::External, 12, 0.297)).is_undercut() && !tooth(spec(Kind::External, 12, 0.299)).is_undercut());
    let apart_m = 15.0 * MODULE_M;
    let limit = |w: f64| {
        let base = 24.0 * cos(ALPHA);
        24.0 - (base * base + (15.0 * sin(ALPHA) + w) * (15.0 * sin(ALPHA) + w)).sqrt()
    };
    let form = 9.0 * sin(ALPHA) + (-1.25 + 0.38 * (1.0 - sin(ALPHA))) / sin(ALPHA);
    assert!((limit(0.0) - 0.871).abs() < 5e-4 && (limit(form) - 0.8365).abs() < 5e-4, "{} {}", limit(0.0), limit(form));
    let thinning_m = 0.02 * MODULE_M;
    let planet = tooth(WheelSpec { thinning_m, ..spec(Kind::External, 18, 0.0) });
    let deepest = |addendum: f64| {
        let rack = Rack { addendum, ..Rack::ISO_53_A };
        let ring = tooth(WheelSpec { rack, thinning_m, ..spec(Kind::Internal, 48, 0.0) });
        Pair { one: planet.clone(), two: ring, apart_m }.deepest_m(6.0 * MODULE_M)
    };
    let depths = [0.83, 0.86, 0.9, 1.0].map(deepest);
    assert!(depths[0] < TOUCHING_M && depths[1] > TOUCHING_M, "{depths:?}");
    assert!(depths.windows(2).all(|pair| pair[0] < pair[1]), "{depths:?}");
}
