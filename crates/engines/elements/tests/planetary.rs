//! Planetary sets: assembly by the phase of teeth, spacing, search, power, and profile shifts checked anew.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_curves::vector::rotate;
use forcewright_elements::gears::interference::{self, Condition};
use forcewright_elements::gears::planetary::{Member, PlanetarySet, Teeth, TeethSearch, Train};
use forcewright_elements::gears::shift::{Place, ShiftError, ShiftWanted, ShiftedSet};
use forcewright_elements::gears::strength::{SetLoad, bending_stress_pa, flank_pressure, set_stresses};
use forcewright_elements::gears::{GearError, Kind, Mesh, Rack, ToothProfile, Wheel, WheelSpec, involute};
use forcewright_elements::hertz::Solid;
use proptest::prelude::*;

#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod rack;

use rack::rolled_past_rack_m;

fn near(ours: f64, exact: f64, absolute: f64) {
    assert!((ours - exact).abs() <= absolute, "{ours} instead of {exact}");
}

fn wheel(kind: Kind, teeth: u32, profile_shift: f64) -> Wheel {
    let spec = WheelSpec { kind, teeth, module_m: 1e-3, rack: Rack::ISO_53_A, profile_shift, tip_shortening: 0.0, thinning_m: 0.0 };
    Wheel::new(spec).expect("a gear of these numbers")
}

fn unshifted(teeth: Teeth, planets: u32) -> PlanetarySet {
    let [sun, planet] = [teeth.sun, teeth.planet].map(|z| wheel(Kind::External, z, 0.0));
    PlanetarySet::new(sun, planet, wheel(Kind::Internal, teeth.ring, 0.0), planets).expect("a set of these numbers")
}

/// Whether N planets at equal angles find their teeth, by trying turns of each planet.
///
/// In pitches, times 2 N: the sun has a tooth at angle 0, the first planet meets it with a space there. The ring stands where the first planet
/// lets it.
fn fits_by_phase(teeth: Teeth, planets: u32) -> bool {
    let full = 2 * i64::from(planets);
    let [sun, planet, ring] = [teeth.sun, teeth.planet, teeth.ring].map(i64::from);
    // Where the pattern of the sun stands at the k-th planet, and that of the ring but for a constant: both turn clockwise along the way.
    let sun_at = |k: i64| -2 * sun * k;
    let ring_at = |k: i64| -2 * ring * k;
    // Turned by p, a planet shows p towards the ring, and p + z_p/2 towards the sun, where clockwise and anticlockwise change places.
    let to_sun = |p: i64| -(p + i64::from(planets) * planet);
    let half = i64::from(planets);
    let meets_sun = |k: i64, p: i64| (sun_at(k) - to_sun(p) - half).rem_euclid(full) == 0;
    let first = (0..full).find(|p| meets_sun(0, *p)).expect("one turn suits the sun");
    let constant = first - half - ring_at(0);
    let meets_ring = |k: i64, p: i64| (ring_at(k) + constant + half - p).rem_euclid(full) == 0;
    (0..i64::from(planets)).all(|k| (0..full).any(|p| meets_sun(k, p) && meets_ring(k, p)))
}

/// Counted by another program over suns of 8 to 30 and planets of 8 to 60 teeth, 2 to 6 planets: 6 095 cases. `(z_s + z_p) mod N = 0` of Butin
/// et al. (2023) refuses 1 117 that fit and takes none that does not.
#[test]
fn assembly_by_phase() {
    let (mut cases, mut refused, mut wrong) = (0, [0; 7], 0);
    let (mut fit, mut paper_fit) = ([0; 7], [0; 7]);
    for sun in 8..=30 {
        for planet in 8..=60 {
            for planets in 2..=6 {
                let teeth = Teeth::standard(sun, planet);
                let truth = fits_by_phase(teeth, planets);
                assert_eq!(teeth.fit_equally(planets), truth, "{teeth:?} {planets}");
                let paper = (sun + planet) % planets == 0;
                let n = planets as usize;
                cases += 1;
                fit[n] += i32::from(truth);
                paper_fit[n] += i32::from(paper);
                refused[n] += i32::from(truth && !paper);
                wrong += i32::from(paper && !truth);
            }
        }
    }
    assert_eq!((cases, wrong), (6095, 0));
    assert_eq!(fit, [0, 0, 1219, 406, 610, 243, 406]);
    assert_eq!(paper_fit, [0, 0, 610, 406, 305, 243, 203]);
    assert_eq!(refused, [0, 0, 609, 0, 305, 0, 203]);
    assert_eq!(refused.iter().sum::<i32>(), 1117);
    // Rings with teeth more or less than the standard.
    for (sun, planet, ring) in (8..20).flat_map(|s| (8..20).flat_map(move |p| (0..5).map(move |k| (s, p, s + 2 * p + k - 2)))) {
        let teeth = Teeth { sun, planet, ring };
        assert!((2..=6).all(|n| teeth.fit_equally(n) == fits_by_phase(teeth, n)), "{teeth:?}");
    }
}

/// Places are where the phase is right, one step apart, and nearest.
#[test]
fn places_between() {
    for (teeth, planets) in [(Teeth::standard(13, 17), 4), (Teeth::standard(12, 18), 3), (Teeth::standard(11, 20), 5)] {
        let step = 2.0 * PI / f64::from(teeth.sun + teeth.ring);
        near(teeth.place_rad(), step, 1e-15);
        let mut count = 0;
        for (k, angle) in teeth.nearest_places_rad(planets).enumerate() {
            near((angle / step).round() * step, angle, 1e-12);
            let equal = 2.0 * PI * k as f64 / f64::from(planets);
            assert!((angle - equal).abs() <= step / 2.0 + 1e-12);
            if teeth.fit_equally(planets) {
                near(angle, equal, 1e-12);
            }
            count += 1;
        }
        assert_eq!(count, planets);
    }
    let uneven = unshifted(Teeth::standard(13, 18), 4);
    assert!(uneven.nearest_neighbour_gap_m() < uneven.neighbour_gap_m());
    let even = unshifted(Teeth::standard(12, 18), 3);
    near(even.nearest_neighbour_gap_m(), even.neighbour_gap_m(), 1e-15);
}

/// Gaps of 12, 18 and 48 teeth, of another program.
#[test]
fn neighbours() {
    for (planets, modules) in [(2, 10.0), (3, 5.980_762_113_533_157), (4, 1.213_203_435_596_423), (5, -2.366_442_431_225_806), (6, -5.0)] {
        near(unshifted(Teeth::standard(12, 18), planets).neighbour_gap_m() / 1e-3, modules, 1e-11);
    }
    assert!(unshifted(Teeth::standard(12, 18), 1).neighbour_gap_m() > 1.0);
}

fn raw() -> TeethSearch {
    TeethSearch {
        sun: 10..=24,
        planet: 10..=60,
        planets: 3..=4,
        excess: 0..=0,
        reduction: [0.0, 1.0],
        most_ring: u32::MAX,
        least_gap: f64::NEG_INFINITY,
        equal_angles: false,
    }
}

/// All combinations of the design space, and what is left of them, against plain loops.
#[test]
fn searches_for_teeth() {
    assert_eq!(raw().sets().count(), 1530);
    let search = TeethSearch { excess: -2..=2, reduction: [0.15, 0.21], most_ring: 90, least_gap: 0.5, equal_angles: true, ..raw() };
    let mut expected = Vec::new();
    for sun in 10..=24_u32 {
        for planet in 10..=60_u32 {
            for ring in sun + 2 * planet - 2..=sun + 2 * planet + 2 {
                for planets in 3..=4 {
                    let r = f64::from(sun) / f64::from(sun + ring);
                    let gap = f64::from(sun + ring) / 2.0 * maths::sin(PI / f64::from(planets)) - f64::from(planet) - 2.0;
                    if ring <= 90 && (0.15..=0.21).contains(&r) && gap >= 0.5 && (sun + ring) % planets == 0 {
                        expected.push((sun, planet, ring, planets));
                    }
                }
            }
        }
    }
    let found: Vec<_> = search.sets().map(|set| (set.teeth.sun, set.teeth.planet, set.teeth.ring, set.planets)).collect();
    assert!(found.len() > 20 && found.contains(&(12, 18, 48, 3)));
    assert_eq!(found, expected);
    assert!(raw().sets().filter(|set| set.teeth == Teeth::standard(12, 18)).all(|set| set.gap > 1.2));
}

/// One planet has no neighbour; numbers at the end of their range are no fault.
#[test]
fn searches_at_the_edge() {
    let one = TeethSearch { planets: 1..=1, least_gap: 0.0, ..raw() };
    assert_eq!(one.sets().count(), 15 * 51);
    assert!(one.sets().all(|set| set.gap.is_infinite() && set.gap > 0.0));
    assert_eq!(TeethSearch { planets: 0..=0, ..raw() }.sets().count(), 0);
    let top = u32::MAX;
    assert_eq!(Teeth::standard(top, top).ring, top);
    assert_eq!(Teeth::standard(12, top / 2 + 1).ring, top);
    let huge = TeethSearch { sun: top - 1..=top, planet: top - 1..=top, excess: i32::MIN..=i32::MIN, ..raw() };
    assert_eq!(huge.sets().count(), 0);
    assert_eq!(TeethSearch { sun: 10..=10, planet: top / 2..=top / 2, ..raw() }.sets().count(), 0);
    let many = Teeth { sun: top, planet: 10, ring: top };
    near(many.nearest_places_rad(top).nth(1).unwrap() / (2.0 * PI), 1.0 / f64::from(top), 1e-15);
}

/// Butin et al. (2023) with R = 1/5: modes I and II of a transmission that shifts by its load.
#[test]
fn two_speeds_of_the_lavt() {
    let teeth = Teeth::standard(12, 18);
    near(teeth.reduction(), 0.2, 1e-15);
    let train = Train::new(teeth, 1.0).unwrap();
    // Torques in N mm of configurations 1, 2 and 3: slip of the clutch, drag, transition, output at 100.
    for (slip, drag, transition, output) in [
        (68.095_857_409_112_91, 68.095_857_409_112_91, 17.023_964_352_278_227, 431.904_142_590_887_1),
        (68.095_857_409_112_91, 81.715_028_890_935_49, 17.023_964_352_278_227, 418.284_971_109_064_5),
        (78.310_236_020_479_83, 81.715_028_890_935_49, 19.577_559_005_119_96, 418.284_971_109_064_5),
    ] {
        near(train.block_limit_nm(slip), transition, 1e-9);
        let (output_nm, efficiency) = train.reduced(100.0, drag).unwrap();
        near(output_nm, output, 1e-9);
        near(efficiency, output / 500.0, 1e-12);
    }
    near(train.block().torques.iter().sum(), 0.0, 0.0);
    // Losses of the teeth take their part of the four fifths that roll.
    let lossy = Train::new(teeth, 0.97).unwrap();
    near(lossy.reduced(100.0, 0.0).unwrap().1, (1.0 + 4.0 * 0.97) / 5.0, 1e-14);
    assert!(lossy.reduced(0.0, 1.0).is_err() && lossy.reduced(1.0, f64::NAN).is_err());
}

/// Efficiencies with each shaft held, in closed form from the balance of torques and of the power that rolls (a negative basic ratio).
#[test]
fn efficiency_of_every_mode() {
    use Member::{Carrier, Ring, Sun};
    let (r, e) = (4.0, 0.96);
    let train = Train::new(Teeth::standard(12, 18), e).unwrap();
    for (held, input, speed, efficiency) in [
        (Carrier, Sun, -1.0 / r, e),
        (Carrier, Ring, -r, e),
        (Ring, Sun, 1.0 / (1.0 + r), (1.0 + r * e) / (1.0 + r)),
        (Ring, Carrier, 1.0 + r, e * (1.0 + r) / (e + r)),
        (Sun, Ring, r / (1.0 + r), (r + e) / (1.0 + r)),
        (Sun, Carrier, (1.0 + r) / r, e * (1.0 + r) / (1.0 + e * r)),
    ] {
        let flow = train.flow(held, input).unwrap();
        let output = [Sun, Carrier, Ring].iter().position(|m| *m != held && *m != input).unwrap();
        near(flow.speeds[output], speed, 1e-14);
        near(flow.efficiency, efficiency, 1e-14);
    }
    assert!(matches!(train.flow(Ring, Ring), Err(GearError::Mates { .. })));
    assert!(Train::new(Teeth::standard(12, 18), 1.01).is_err() && Train::new(Teeth::standard(12, 18), f64::NAN).is_err());
}

/// What a set of the sweep must be, worked out from its numbers alone.
fn check_anew(wanted: &ShiftWanted, shifted: &ShiftedSet) {
    const TOLERANCE: f64 = 1e-9;
    let (set, rack) = (&shifted.set, wanted.rack);
    let m = wanted.module_m;
    let (sun, planet, ring) = (set.sun_planet.pinion, set.planet_ring.pinion, set.planet_ring.wheel);
    let a = set.sun_planet.centre_distance_m / m;
    let alpha = wanted.rack.pressure_angle_rad;
    let inv = |angle: f64| maths::tan(angle) - angle;
    let [zs, zp, zr] = [sun, planet, ring].map(|gear| f64::from(gear.spec.teeth));
    let [xs, xp, xr] = [sun, planet, ring].map(|gear| gear.spec.profile_shift);
    let base = [zs, zp, zr].map(|z| 0.5 * z * maths::cos(alpha));
    let h = wanted.rack.dedendum - wanted.rack.root_radius * (1.0 - maths::sin(alpha));
    let tips = [
        0.5 * zs + xs + rack.addendum - sun.spec.tip_shortening,
        0.5 * zp + xp + rack.addendum - planet.spec.tip_shortening,
        0.5 * zr + xr - rack.addendum + ring.spec.tip_shortening,
    ];
    let roots = [0.5 * zs + xs - rack.dedendum, 0.5 * zp + xp - rack.dedendum, 0.5 * zr + xr + rack.dedendum];
    assert!([sun, planet, ring].iter().all(|gear| gear.spec.tip_shortening >= 0.0));
    // Coaxial.
    let (outer, inner) = (maths::acos((base[0] + base[1]) / a), maths::acos((base[2] - base[1]) / a));
    near(inv(outer), inv(alpha) + 2.0 * maths::tan(alpha) * (xs + xp) / (zs + zp), TOLERANCE);
    near(inv(inner), inv(alpha) + 2.0 * maths::tan(alpha) * (xr - xp) / (zr - zp), TOLERANCE);
    // Backlash, from thicknesses on the working circles.
    let thick = |x: f64, z: f64, thinning: f64, working: f64| {
        let radius = 0.5 * z * maths::cos(alpha) / maths::cos(working);
        radius * (PI / z + 4.0 * x * maths::tan(alpha) / z + 2.0 * (inv(alpha) - inv(working)) - thinning / m / (0.5 * z))
    };
    let pitch = |working: f64| PI * maths::cos(alpha) / maths::cos(working);
    let play = pitch(outer) - thick(xs, zs, sun.spec.thinning_m, outer) - thick(xp, zp, planet.spec.thinning_m, outer);
    near(play * m, wanted.backlash_m, TOLERANCE * m);
    let space = thick(xr, zr, -ring.spec.thinning_m, inner);
    near((space - thick(xp, zp, planet.spec.thinning_m, inner)) * m, wanted.backlash_m, TOLERANCE * m);
    // Undercut, tips, clearance.
    assert!(xs >= h - 0.5 * zs * maths::powi(maths::sin(alpha), 2) && xp >= h - 0.5 * zp * maths::powi(maths::sin(alpha), 2), "undercut");
    for (gear, tip, base) in [(sun, tips[0], base[0]), (planet, tips[1], base[1]), (ring, tips[2], base[2])] {
        let (z, x) = (f64::from(gear.spec.teeth), gear.spec.profile_shift);
        let at_tip = inv(maths::acos(base / tip));
        let sign = if gear.spec.kind == Kind::External { 1.0 } else { -1.0 };
        let angle = PI / z + sign * (4.0 * x * maths::tan(alpha) / z + 2.0 * (inv(alpha) - at_tip)) - gear.spec.thinning_m / m / (0.5 * z);
        assert!(tip * angle >= wanted.least_tip - TOLERANCE, "thin tip");
    }
    let c = wanted.least_clearance - TOLERANCE;
    assert!(
        a - tips[0] - roots[1] >= c && a - tips[1] - roots[0] >= c && roots[2] - a - tips[1] >= c && tips[2] - a - roots[1] >= c,
        "clearance"
    );
    // Path of contact by pressure angles; neither tip may go below where the rack leaves the involute of its mate.
    let tan = |k: usize| maths::tan(maths::acos(base[k] / tips[k]));
    let foot = |z: f64, x: f64| maths::tan(alpha) - 2.0 * (h - x) / (z * maths::sin(alpha) * maths::cos(alpha));
    let (working, within) = (maths::tan(outer), maths::tan(inner));
    let at_sun = working - zp / zs * (tan(1) - working);
    let at_planet = working - zs / zp * (tan(0) - working);
    let by_ring = within + zr / zp * (tan(2) - within);
    let planet_foot = foot(zp, xp) - TOLERANCE;
    assert!(at_sun >= foot(zs, xs) - TOLERANCE && at_planet >= planet_foot && by_ring >= planet_foot, "fillet");
    assert!(at_sun >= -TOLERANCE && at_planet >= -TOLERANCE && by_ring >= -TOLERANCE && tips[2] > base[2], "interference");
    let ratios = [(zs * (tan(0) - at_sun)) / (2.0 * PI), (zp * (tan(1) - by_ring)) / (2.0 * PI)];
    for (anew, ours) in ratios.into_iter().zip(shifted.contact_ratios) {
        near(anew, ours, 1e-9);
        assert!(anew >= wanted.least_contact_ratio - TOLERANCE, "contact ratio");
    }
    if wanted.planets > 1 {
        assert!(a * maths::sin(PI / f64::from(wanted.planets)) >= tips[1], "neighbours");
    }
    assert!(fouling_rad(a, [zp, zr], [tips[1], tips[2]], [base[1], base[2]], [xp, xr], alpha) > -1e-6, "trochoid");
    for (mesh, gear, mate) in
        [(set.sun_planet, sun, planet), (set.sun_planet, planet, sun), (set.planet_ring, planet, ring), (set.planet_ring, ring, planet)]
    {
        let deep_m = corner_depth_m(&mesh, &gear, &mate);
        assert!(deep_m < 1e-7 * m, "corner: {deep_m} {:?} {:?}", gear.spec, mate.spec);
    }
    if wanted.radial_assembly {
        assert!(trimming([zp, zr], [tips[1], tips[2]], [base[1], base[2]], [xp, xr], alpha) > -1e-6, "trimming");
    }
}

/// How deep the tip corner of a mate comes into a gear, its flank in contact, m: into what the rack left, by rolling the rack; into a ring as it
/// is drawn. Only where the corner is nearer to the root than the reference circle.
fn corner_depth_m(mesh: &Mesh, gear: &Wheel, mate: &Wheel) -> f64 {
    let (a, alpha) = (mesh.centre_distance_m, gear.spec.rack.pressure_angle_rad);
    let base = |w: &Wheel| 0.5 * f64::from(w.spec.teeth) * w.spec.module_m * maths::cos(alpha);
    let [gear_ring, mate_ring] = [gear, mate].map(|w| w.spec.kind == Kind::Internal);
    let working = maths::acos(if gear_ring || mate_ring { (base(mate) - base(gear)).abs() } else { base(mate) + base(gear) } / a);
    let half = |w: &Wheel, radius: f64| {
        let (z, x) = (f64::from(w.spec.teeth), w.spec.profile_shift);
        let grows = 2.0 * x * maths::tan(alpha) / z + involute(alpha) - involute(maths::acos((base(w) / radius).min(1.0)));
        0.5 * PI / z + if w.spec.kind == Kind::Internal { -grows } else { grows } - w.spec.thinning_m / (z * w.spec.module_m)
    };
    let at_pitch = |w: &Wheel| half(w, base(w) / maths::cos(working));
    let tip = if mate_ring {
        mate.tip_radius_m
    } else {
        0.5 * f64::from(mate.spec.teeth) * mate.spec.module_m
            + (mate.spec.profile_shift + mate.spec.rack.addendum - mate.spec.tip_shortening) * mate.spec.module_m
    };
    let drawn = gear_ring.then(|| ToothProfile::new(gear, None).expect("a ring that can be drawn"));
    let centre = if mate_ring { -a } else { a };
    let mut deepest = f64::NEG_INFINITY;
    for k in -100..=100 {
        // The corner from the pitch point, about the centre of the mate, upwards; the flank of its tooth passes the pitch point at `up` of 0.
        let corner = f64::from(k) * 0.02 * (mate.spec.module_m / tip).sqrt();
        let up = corner + half(mate, tip) - at_pitch(mate);
        let point = if gear_ring {
            [a + tip * maths::cos(corner), tip * maths::sin(corner)]
        } else {
            [centre - centre.signum() * tip * maths::cos(corner), tip * maths::sin(corner)]
        };
        let radius = maths::hypot(point[0], point[1]);
        let beyond = if gear_ring { radius > gear.reference_radius_m } else { radius < gear.reference_radius_m };
        if !beyond {
            continue;
        }
        // The upper flank of a tooth of the gear passes the pitch point too; above it is a space.
        let turn = up * f64::from(mate.spec.teeth) / f64::from(gear.spec.teeth) - at_pitch(gear);
        let deep = match &drawn {
            None => rolled_past_rack_m(&gear.spec, rotate(point, -turn - PI / f64::from(gear.spec.teeth))),
            Some(drawn) => {
                let off = maths::atan2(point[1], point[0]) - turn;
                drawn.half_angle_rad(radius).map_or(f64::NEG_INFINITY, |tooth| (tooth - off) * radius)
            }
        };
        deepest = deepest.max(deep);
    }
    deepest
}

/// A planet that moves out radially between teeth of the ring: least distance of the corners of their tips, modules.
fn trimming(z: [f64; 2], tips: [f64; 2], base: [f64; 2], x: [f64; 2], alpha: f64) -> f64 {
    let half =
        |k: usize| PI / (2.0 * z[k]) + 2.0 * x[k] * maths::tan(alpha) / z[k] + involute(alpha) - involute(maths::acos(base[k] / tips[k]));
    let (tooth, space) = (half(0), half(1));
    (0..2000)
        .map(|k| f64::from(k) / 2000.0 * PI / 2.0)
        .map(|turn| tips[1] * maths::sin(turn * z[0] / z[1] + space) - tips[0] * maths::sin(turn + tooth))
        .fold(f64::INFINITY, f64::min)
}

/// Corner of a planet's full tooth against the full tooth of the ring while both roll, beyond the ring's tip circle, rad.
fn fouling_rad(a: f64, z: [f64; 2], tips: [f64; 2], base: [f64; 2], x: [f64; 2], alpha: f64) -> f64 {
    let inv_at = |base: f64, radius: f64| maths::tan(maths::acos((base / radius).min(1.0))) - maths::acos((base / radius).min(1.0));
    let inv = maths::tan(alpha) - alpha;
    let half = |k: usize, radius: f64| PI / (2.0 * z[k]) + 2.0 * x[k] * maths::tan(alpha) / z[k] + inv - inv_at(base[k], radius);
    let corner = half(0, tips[0]);
    (0..1500)
        .map(|k| f64::from(k) * 1e-3 - 0.3)
        .filter_map(|turn: f64| {
            let (px, py) = (a + tips[0] * maths::cos(turn + corner), tips[0] * maths::sin(turn + corner));
            let radius = maths::hypot(px, py);
            (radius >= tips[1] && py > 0.0).then(|| half(1, radius) + turn * z[0] / z[1] - maths::atan2(py, px))
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn lavt_is_solved() {
    let wanted = ShiftWanted::usual(Teeth::standard(12, 18), 3, 0.5e-3, 20e-6);
    let shifted = wanted.solve().expect("shifts exist");
    assert_eq!(wanted.solve_reachable(), Ok(shifted));
    check_anew(&wanted, &shifted);
    assert!(wanted.margins(&shifted.set).all(|(_, margin)| margin.holds()));
    assert!(shifted.set.sun_planet.pinion.spec.profile_shift >= 0.298);
    // What the theory page prints.
    let [sun, planet, ring] =
        [shifted.set.sun_planet.pinion, shifted.set.planet_ring.pinion, shifted.set.planet_ring.wheel].map(|gear| gear.spec);
    for (ours, printed) in [(sun.profile_shift, 0.489), (planet.profile_shift, 0.359), (ring.profile_shift, 1.207)] {
        near(ours, printed, 5e-4);
    }
    near(sun.tip_shortening, 0.116, 5e-4);
    near(planet.tip_shortening, 0.116, 5e-4);
    near(shifted.contact_ratios[0], 1.20, 5e-3);
    near(shifted.contact_ratios[1], 1.34, 5e-3);
    near(shifted.largest_sliding, 2.19, 5e-3);
    assert_eq!(wanted.solve(), Ok(shifted));
    // Without shift, what the theory says fails.
    let spoilt = unshifted(Teeth::standard(12, 18), 3);
    let plain = ShiftWanted { module_m: 1e-3, ..wanted };
    let failing: Vec<_> = plain.margins(&spoilt).filter(|(_, m)| m.value < -1e-9).map(|(place, m)| (place, m.condition)).collect();
    assert!(failing.contains(&(Place::Sun, Condition::Undercut)) && failing.contains(&(Place::PlanetRing, Condition::PinionInterference)));
    assert!(!failing.iter().any(|(_, condition)| matches!(condition, Condition::Trochoid | Condition::Trimming)));
    // Sizes scale.
    let large = ShiftWanted { module_m: 1.0, backlash_m: 0.04, ..wanted }.solve().unwrap();
    near(large.set.sun_planet.pinion.spec.profile_shift, shifted.set.sun_planet.pinion.spec.profile_shift, 1e-4);
    // Five planets clash, four do not.
    let five = ShiftWanted { planets: 5, ..wanted }.solve();
    assert!(matches!(five, Err(ShiftError::Blocked { .. })), "{five:?}");
    assert!(ShiftWanted { planets: 4, ..wanted }.solve().is_ok());
    // More backlash than a pitch: no such set at all, said without a number.
    let none = ShiftWanted { backlash_m: 20.0 * wanted.module_m, ..wanted }.solve().unwrap_err().to_string();
    assert!(!none.contains("inf") && none.contains(&Condition::Coaxial.to_string()), "{none}");
    assert!(matches!(ShiftWanted { backlash_m: f64::NAN, ..wanted }.solve(), Err(ShiftError::Gear(_))));
    assert!(matches!(ShiftWanted { planets: 0, ..wanted }.solve(), Err(ShiftError::Gear(_))));
    let seven = ShiftWanted { planets: 7, ..wanted }.solve().unwrap_err();
    assert!(matches!(seven, ShiftError::Blocked { margin, .. } if margin.condition == Condition::Assembly));
}

/// Every set of the design space: shifts that pass the check anew, or a reason.
#[test]
fn whole_design_space() {
    let (mut solved, mut assembly, mut clash, mut short, mut reachable) = (0, 0, 0, 0, 0);
    for set in raw().sets() {
        let wanted = ShiftWanted::usual(set.teeth, set.planets, 1e-3, 40e-6);
        match wanted.solve() {
            Ok(shifted) => {
                check_anew(&wanted, &shifted);
                solved += 1;
            }
            Err(ShiftError::Blocked { margin, .. }) if margin.condition == Condition::Assembly => assembly += 1,
            Err(ShiftError::Blocked { margin, against, .. }) => {
                assert!(margin.value < 0.0 && against.is_none_or(|(_, margin)| margin.value < 0.0), "{set:?}");
                let fails = |condition| margin.condition == condition || against.is_some_and(|(_, margin)| margin.condition == condition);
                let apart = ShiftWanted { least_gap_m: -1.0, ..wanted }.solve();
                if fails(Condition::NeighbourGap) {
                    // Planets that come too near each other, and nothing else.
                    assert!(set.gap < 0.5 && apart.is_ok(), "{set:?} {margin:?} {against:?}");
                    clash += 1;
                } else {
                    // Sun and planet that must both be shifted so far out that too few teeth touch.
                    assert!(
                        fails(Condition::ContactRatio) && set.teeth.sun + set.teeth.planet <= 22 && apart.is_err(),
                        "{set:?} {margin:?}"
                    );
                    if let Ok(reached) = wanted.solve_reachable() {
                        check_anew(&ShiftWanted { least_contact_ratio: 1.0, ..wanted }, &reached);
                        let least = reached.contact_ratios[0].min(reached.contact_ratios[1]);
                        // As near to the wanted one as the refusal says, if nothing else failed.
                        assert!(least < 1.2 && (against.is_some() || (least - 1.2 - margin.value).abs() < 1e-4), "{least} {margin:?}");
                        reachable += 1;
                    }
                    short += 1;
                }
            }
            Err(error) => panic!("{set:?}: {error}"),
        }
    }
    assert_eq!((solved, assembly, clash, short, reachable), (484, 892, 148, 6, 2));
}

/// Shares of the planets, and the torque that each gear passes on.
#[test]
fn loads_are_shared() {
    let steel = Solid { young_modulus_pa: 206e9, poisson_ratio: 0.3 };
    let shifted = ShiftWanted::usual(Teeth::standard(15, 21), 3, 1e-3, 40e-6).solve().unwrap().set;
    let load = SetLoad { sun_torque_nm: 3.0, sharing: 1.2, face_width_m: 6e-3, solids: [steel; 3] };
    let stresses = set_stresses(&shifted, &load).unwrap();
    let [sun, planet, ring] = [shifted.sun_planet.pinion, shifted.planet_ring.pinion, shifted.planet_ring.wheel];
    for (gear, teeth, ours) in [(sun, 15.0, 0), (planet, 21.0, 1), (ring, 57.0, 2)] {
        near(bending_stress_pa(&gear, 1.2 * teeth / 15.0, 6e-3).unwrap() / stresses.bending_pa[ours], 1.0, 1e-12);
    }
    near(
        flank_pressure(&shifted.planet_ring, 1.2 * 21.0 / 15.0, 6e-3, [steel; 2]).unwrap().largest_pa / stresses.flanks[1].largest_pa,
        1.0,
        1e-12,
    );
    assert!(stresses.flanks[1].pitch_pa < stresses.flanks[0].pitch_pa);
    assert!(set_stresses(&shifted, &SetLoad { sharing: 0.9, ..load }).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    /// Power in is power out and lost; torques balance; a train of no loss is reversible.
    #[test]
    fn power_is_kept(sun in 8..60u32, planet in 8..60u32, efficiency in 0.5..1.0_f64, pair in 0..6usize) {
        use Member::{Carrier, Ring, Sun};
        let (held, input, output) =
            [(Sun, Carrier, Ring), (Sun, Ring, Carrier), (Carrier, Sun, Ring), (Carrier, Ring, Sun), (Ring, Sun, Carrier), (Ring, Carrier, Sun)][pair];
        let teeth = Teeth::standard(sun, planet);
        let index = |member| [Sun, Carrier, Ring].iter().position(|m| *m == member).unwrap();
        for eta in [efficiency, 1.0] {
            let train = Train::new(teeth, eta).unwrap();
            let flow = train.flow(held, input).unwrap();
            let power: f64 = (0..3).map(|k| flow.torques[k] * flow.speeds[k]).sum();
            prop_assert!(flow.torques.iter().sum::<f64>().abs() < 1e-12 * flow.torques[1].abs().max(1.0));
            prop_assert!((flow.torques[index(input)] - 1.0).abs() < 1e-14 && flow.speeds[index(held)].abs() < 1e-14);
            prop_assert!((power - (1.0 - flow.efficiency)).abs() < 1e-12);
            // Loss is the part of the power that rolls.
            let rolling = flow.torques[0] * (flow.speeds[0] - flow.speeds[1]);
            let at_ring = flow.torques[2] * (flow.speeds[2] - flow.speeds[1]);
            let lost = rolling.max(at_ring) * (1.0 - eta);
            prop_assert!((rolling + at_ring - power).abs() < 1e-12);
            prop_assert!(power > -1e-12 && (power - lost).abs() < 1e-12);
            // Willis.
            let [s, c, r] = flow.speeds;
            prop_assert!((f64::from(teeth.sun) * (s - c) + f64::from(teeth.ring) * (r - c)).abs() < 1e-10 * f64::from(teeth.ring) * c.abs().max(1.0));
            let back = train.flow(held, output).unwrap();
            prop_assert!((flow.speeds[index(output)] * back.speeds[index(input)] - 1.0).abs() < 1e-12);
            if eta > 0.999_999 { prop_assert!((flow.efficiency - 1.0).abs() < 1e-12) }
        }
    }

    /// Any teeth, rings of more or fewer than the standard, racks, backlash, module: shifts that pass, or a reason. Never a panic.
    #[test]
    fn any_set(sun in 6..40u32, planet in 6..50u32, excess in -3..=3i32, planets in 1..7u32, tip in 0.0..0.4_f64, backlash in 0.0..0.08_f64,
               module in 1e-4..5e-3_f64, radial: bool, clearance in 0.0..0.25_f64, profile in 0..4usize) {
        let ring = (sun + 2 * planet).checked_add_signed(excess).unwrap();
        let usual = ShiftWanted::usual(Teeth { sun, planet, ring }, planets, module, backlash * module);
        let stub = Rack { addendum: 0.8, dedendum: 1.0, root_radius: 0.2, ..Rack::ISO_53_A };
        let rack = [Rack::ISO_53_A, Rack::ISO_53_C, Rack::ISO_53_D, stub][profile];
        let wanted = ShiftWanted { least_tip: tip, radial_assembly: radial, least_clearance: clearance, rack, ..usual };
        match wanted.solve() {
            Ok(shifted) => {
                check_anew(&wanted, &shifted);
                prop_assert!(wanted.margins(&shifted.set).all(|(_, margin)| margin.holds()));
                let error_m = shifted.set.coaxial_error_m().unwrap();
                prop_assert!(error_m.abs() < 1e-9 * module);
                prop_assert!((shifted.set.sun_planet.backlash().circumferential_m - wanted.backlash_m).abs() < 1e-9 * module);
                prop_assert!((shifted.set.planet_ring.backlash().circumferential_m - wanted.backlash_m).abs() < 1e-9 * module);
            }
            Err(error @ ShiftError::Blocked { margin, .. }) => {
                prop_assert!(margin.value < 0.0);
                prop_assert!(error.to_string().contains(&margin.condition.to_string()));
            }
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}

/// Gears in the wrong place are refused; a set that is not coaxial says so.
#[test]
fn sets_need_their_members() {
    let [sun, planet, ring] =
        [(Kind::External, 12), (Kind::External, 18), (Kind::Internal, 48)].map(|(kind, teeth)| wheel(kind, teeth, 0.3));
    assert!(matches!(PlanetarySet::new(sun, planet, planet, 3), Err(GearError::Mates { .. })));
    assert!(matches!(PlanetarySet::new(sun, ring, ring, 3), Err(GearError::Mates { .. })));
    assert!(matches!(PlanetarySet::new(sun, planet, ring, 0), Err(GearError::Value { .. })));
    let set = PlanetarySet::new(sun, planet, ring, 3).unwrap();
    // Shifts of 0.3 each drive sun and planet apart, so the planet does not go into the ring.
    assert!(set.coaxial_error_m().unwrap() > 0.0 && set.planet_ring.backlash().circumferential_m < 0.0);
    assert!(set.train(-0.1).is_err() && set.train(1e9).is_err());
    let both = (1.0 - 0.05 * set.sun_planet.loss_factor()) * (1.0 - 0.05 * set.planet_ring.loss_factor());
    assert!(both > 0.9 && both < 1.0);
    let flow = set.train(0.05).unwrap().flow(Member::Carrier, Member::Sun).unwrap();
    near(flow.efficiency, both, 1e-14);
    // Each mesh must pass something on: the product of two that do not is above 0.
    let [outer, inner] = [set.sun_planet, set.planet_ring].map(|mesh| mesh.loss_factor());
    let most = 1.02 / outer.min(inner);
    assert!(1.0 - most * outer < 0.0 && 1.0 - most * inner < 0.0 && (0.0..1.0).contains(&set.basic_efficiency(most)));
    assert!(matches!(set.train(most), Err(GearError::Value { name: "friction", .. })));
    // Teeth that do not touch.
    let apart = PlanetarySet::at(Mesh::new(sun, planet, 18e-3).unwrap(), ring, 3).unwrap();
    assert!(apart.sun_planet.path().usable.length_m() < 0.0);
    assert!(matches!(apart.train(0.1), Err(GearError::Value { name: "contact_ratio", .. })));
    assert!(matches!(apart.train(0.0), Err(GearError::Value { name: "contact_ratio", .. })));
    let free = Mesh::without_backlash(planet, ring).unwrap();
    near(free.centre_distance_m, 15e-3, 1e-15);
    assert!(interference::form_radius_m(&sun) >= sun.base_radius_m);
}
