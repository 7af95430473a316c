//! Wrap springs against the numbers of the paper and of another program, closed forms and laws; `wrap_spring_rod.rs` has the rod with contact.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{cos, exp, ln, sin};
use forcewright_elements::springs::{grade, wire};
use forcewright_elements::wrap_spring::{
    Coil, Dimensions, Duty, END_LOSS_TURNS, Effect, Hand, Life, Model, Options, Sense, State, Surface, WireModel, WrapSpring,
    WrapSpringError, effect, endurance, exact_moment_nm, leg, linear_moment_nm, mean_diameter_tolerance_m, static_strength, wahl_factors,
    winkler_factors, wire_tolerance_m,
};
use serde_json::Value;

const REFERENCE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../reference/wrap-spring/converged.json"));

const CORRECTED: Options = Options { model: Model::Corrected, end_loss_turns: END_LOSS_TURNS, wire: WireModel::Thin };
const PAPER: Options = Options { model: Model::Paper, ..CORRECTED };
const FULL_TURNS: Options = Options { end_loss_turns: 0.0, ..CORRECTED };

fn near(ours: f64, exact: f64, relative: f64) {
    assert!((ours - exact).abs() <= relative * exact.abs(), "{ours} instead of {exact}");
}

/// The prototype of the paper, with both gaps in mm.
fn prototype(hub_mm: f64, bore_mm: f64) -> Dimensions {
    Dimensions {
        wire_m: 1e-3,
        neutral_radius_m: 8.7e-3,
        young_modulus_pa: 210e9,
        hub_interference_m: 1e-3 * hub_mm,
        bore_opening_m: 1e-3 * bore_mm,
        hub_turns: 2.0,
        bore_turns: 3.0,
        free_turns: 6.0,
    }
}

fn spring(dimensions: &Dimensions, options: Options) -> WrapSpring {
    WrapSpring::new(dimensions, options).expect("a spring")
}

fn gaps(hub_mm: f64, bore_mm: f64, options: Options) -> WrapSpring {
    spring(&prototype(hub_mm, bore_mm), options)
}

// ---------------------------------------------------------------------------------------------------------------------
// Numbers of the paper and of an independent program
// ---------------------------------------------------------------------------------------------------------------------

/// Torques, stresses, turns, and the least friction of the three configurations, printed model and corrected.
#[test]
fn configurations_of_the_paper() {
    let reference: Value = serde_json::from_str(REFERENCE).expect("JSON");
    let configurations = reference["configurations"].as_array().expect("a list");
    assert_eq!(configurations.len(), 3);
    for entry in configurations {
        let number = |group: &str, key: &str| entry[group][key].as_f64().expect("a number");
        let [hub_mm, bore_mm] = ["hub_interference", "bore_opening"].map(|key| entry[key].as_f64().expect("a number"));
        let (paper, ours) = (gaps(hub_mm, bore_mm, PAPER), gaps(hub_mm, bore_mm, CORRECTED));

        near(1e3 * paper.transition_nm(), number("linear", "transition"), 1e-12);
        near(1e3 * paper.limits(0.1).expect("limits").hub_slip_nm, number("linear", "hub_slip"), 1e-12);
        let stresses = paper.stresses();
        near(stresses.factor, 1.045, 2e-4);
        near(1e-6 * stresses.hub_pa, number("linear", "sigma_hub"), 1e-12);
        near(1e-6 * stresses.bore_pa, number("linear", "sigma_bore"), 1e-12);
        near(1e-6 * paper.unsupported_pa(0.4).expect("a torque"), number("linear", "sigma_unsupported"), 1e-12);
        near(paper.dead_turns(), number("linear", "dead_turns"), 1e-12);
        // R = 1/5: the input turns four times as far.
        near(4.0 * paper.dead_turns(), number("linear", "dead_turns_input"), 1e-12);

        near(1e3 * ours.transition_nm(), number("exact", "transition"), 1e-12);
        near(1e3 * ours.hub_moment_nm(), number("exact", "hub_moment"), 1e-12);
        near(ours.dead_turns(), number("exact", "dead_turns"), 1e-12);

        near(3.0 * paper.least_friction_to_reach().expect("some"), number("paper_conditions", "n_mu_27"), 1e-12);
        let grip = paper.least_friction_to_grip(0.4).expect("a torque").expect("some");
        near(grip, number("paper_conditions", "mu_28"), 1e-12);
        near(3.0 * grip, number("paper_conditions", "n_mu_28"), 1e-12);
        near(paper.least_friction_to_lock(0.4).expect("a torque").expect("some"), number("paper_conditions", "mu_29"), 1e-12);

        for (key, least) in
            [("mu_to_reach", ours.least_friction_to_reach()), ("mu_to_grip", ours.least_friction_to_grip(0.4).expect("a torque"))]
        {
            let expected = entry["corrected"][key].as_f64();
            assert_eq!(least.is_some(), expected.is_some(), "{key}");
            if let (Some(ours), Some(expected)) = (least, expected) {
                assert!((ours - expected).abs() <= 0.5e-4, "{key}: {ours} instead of {expected}");
            }
        }
    }
}

/// Finite turns without a loss at the end, with the linear moment: 0.1426 and 0.2529.
#[test]
fn least_friction_with_full_turns() {
    let reference: Value = serde_json::from_str(REFERENCE).expect("JSON");
    for (i, hub_mm, bore_mm) in [(1, 0.6, 0.5), (2, 0.6, 0.575)] {
        let expected = reference["configurations"][i]["full_turns"]["mu_to_reach"].as_f64().expect("a number");
        // The ratio of the linear moments is that of the gaps; ours is exact, so it asks for a little more.
        near(-ln(1.0 - bore_mm / hub_mm) / (TAU * 2.0), expected, 1e-12);
        let ours = gaps(hub_mm, bore_mm, FULL_TURNS).least_friction_to_reach().expect("some");
        assert!(ours > expected && ours < 1.05 * expected, "{ours} against {expected}");
        let ratio = (bore_mm / (8.7 + bore_mm)) / (hub_mm / (8.7 + hub_mm));
        near(ours, -ln(1.0 - ratio) / (TAU * 2.0), 1e-12);
    }
}

/// Eq. (27): N μ > ln 2/2π for gaps alike. The optimum of the paper, configuration 1, grips nothing at any friction.
#[test]
fn equal_gaps_never_grip() {
    near(3.0 * gaps(0.5, 0.5, PAPER).least_friction_to_reach().expect("some"), 0.110_318, 1e-5);
    for friction in [0.05, 0.2, 0.5, 5.0] {
        let ours = gaps(0.5, 0.5, CORRECTED).limits(friction).expect("limits");
        assert_eq!(ours.grip_nm, None);
        assert_eq!(ours.state(0.07), Ok(State::SlipsBeforeShift));
        assert!(gaps(0.5, 0.5, PAPER).limits(friction).expect("limits").grip_nm.is_some());
    }
    // 0.1 mm more on the hub: 242 N·mm at a friction of 0.2.
    let grip_nm = gaps(0.6, 0.5, CORRECTED).limits(0.2).expect("limits").grip_nm.expect("a grip");
    assert!((grip_nm - 0.242).abs() < 0.5e-3, "{grip_nm}");
}

// ---------------------------------------------------------------------------------------------------------------------
// Opening
// ---------------------------------------------------------------------------------------------------------------------

/// Exact opening: links with rotary springs, wound with a moment, lie on a circle whose radius is measured.
#[test]
fn links_open_to_the_radius() {
    let (flexural, radius, link) = (2.0, 8.7e-3, 1e-5);
    for change in [0.6e-3, 3e-3, -0.6e-3, -3e-3] {
        let moment = exact_moment_nm(flexural, radius, change);
        let turn = link / radius - moment * link / flexural;
        let mut points = vec![[0.0, 0.0]];
        for i in 0..2000 {
            let angle = turn * f64::from(i);
            let [x, y]: [f64; 2] = points[points.len() - 1];
            points.push([x + link * cos(angle), y + link * sin(angle)]);
        }
        near(circle(points[0], points[1000], points[2000]), radius + change, 1e-6);
    }
    near(exact_moment_nm(1.0, 1.0, 1e-7), linear_moment_nm(1.0, 1.0, 1e-7), 2e-7);
    assert!(-exact_moment_nm(1.0, 1.0, -0.1) > exact_moment_nm(1.0, 1.0, 0.1));
}

/// Radius of the circle through three points.
fn circle(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let side = |p: [f64; 2], q: [f64; 2]| ((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1])).sqrt();
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs();
    side(a, b) * side(b, c) * side(c, a) / (4.0 * area)
}

// ---------------------------------------------------------------------------------------------------------------------
// Laws over the ranges of all parameters
// ---------------------------------------------------------------------------------------------------------------------

/// Dimensions and friction over wide ranges, always the same ones.
fn samples() -> Vec<(Dimensions, f64)> {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = |low: f64, high: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let bits = u32::try_from(state >> 32).expect("32 bits");
        low + (high - low) * f64::from(bits) / f64::from(u32::MAX)
    };
    (0..400)
        .map(|_| {
            let radius_m = next(3e-3, 40e-3);
            let hub_interference_m = radius_m * next(1e-3, 0.12);
            let dimensions = Dimensions {
                wire_m: radius_m * next(0.02, 0.4),
                neutral_radius_m: radius_m,
                young_modulus_pa: next(100e9, 220e9),
                hub_interference_m,
                bore_opening_m: hub_interference_m * next(0.1, 1.2),
                hub_turns: next(0.3, 8.0),
                bore_turns: next(0.0, 8.0),
                free_turns: next(8.0, 12.0),
            };
            (dimensions, next(0.01, 0.5))
        })
        .collect()
}

#[test]
fn torques_scale_with_stiffness_and_size() {
    for (dimensions, friction) in samples() {
        let base = spring(&dimensions, CORRECTED).limits(friction).expect("limits");
        let stiff = Dimensions { young_modulus_pa: 3.0 * dimensions.young_modulus_pa, ..dimensions };
        let large = Dimensions {
            wire_m: 2.0 * dimensions.wire_m,
            neutral_radius_m: 2.0 * dimensions.neutral_radius_m,
            hub_interference_m: 2.0 * dimensions.hub_interference_m,
            bore_opening_m: 2.0 * dimensions.bore_opening_m,
            ..dimensions
        };
        for (other, factor) in [(stiff, 3.0), (large, 8.0)] {
            let scaled = spring(&other, CORRECTED).limits(friction).expect("limits");
            near(scaled.transition_nm, factor * base.transition_nm, 1e-12);
            near(scaled.hub_slip_nm, factor * base.hub_slip_nm, 1e-12);
            near(scaled.lock_nm, factor * base.lock_nm, 1e-12);
            assert_eq!(scaled.grip_nm.is_some(), base.grip_nm.is_some());
            if let (Some(scaled), Some(base)) = (scaled.grip_nm, base.grip_nm) {
                near(scaled, factor * base, 1e-9);
            }
        }
        // Stress does not depend on size, and follows Young's modulus.
        let stress = |dimensions| spring(&dimensions, CORRECTED).stresses();
        near(stress(large).hub_pa, stress(dimensions).hub_pa, 1e-12);
        near(stress(stiff).bore_pa, 3.0 * stress(dimensions).bore_pa, 1e-12);
    }
}

#[test]
fn torques_grow_with_friction_and_gap() {
    for (dimensions, friction) in samples() {
        let at = |dimensions: &Dimensions, friction| spring(dimensions, CORRECTED).limits(friction).expect("limits");
        let (base, rough) = (at(&dimensions, friction), at(&dimensions, 1.1 * friction));
        assert!(rough.hub_slip_nm >= base.hub_slip_nm && rough.lock_nm >= base.lock_nm);
        assert!(rough.grip_nm.unwrap_or(0.0) >= base.grip_nm.unwrap_or(0.0));
        let tight = at(&Dimensions { hub_interference_m: 1.1 * dimensions.hub_interference_m, ..dimensions }, friction);
        assert!(tight.hub_slip_nm >= base.hub_slip_nm && tight.grip_nm.unwrap_or(0.0) >= base.grip_nm.unwrap_or(0.0));
        let wide = at(&Dimensions { bore_opening_m: 1.1 * dimensions.bore_opening_m, ..dimensions }, friction);
        assert!(wide.transition_nm > base.transition_nm);
        // A wider bore presses less: more torque to get there, less grip unless there is none to speak of.
        if let Some(grip_nm) = wide.grip_nm {
            assert!(grip_nm <= base.grip_nm.expect("more") * (1.0 + 1e-12));
        }
        let longer = at(&Dimensions { hub_turns: dimensions.hub_turns + 1.0, ..dimensions }, friction);
        assert!(longer.hub_slip_nm > base.hub_slip_nm && longer.lock_nm > base.lock_nm);
    }
}

#[test]
fn limits_of_long_hubs_and_small_gaps() {
    for (dimensions, friction) in samples() {
        // An endless hub slips at its moment; the paper takes every hub for one.
        let long = spring(&Dimensions { hub_turns: 1e3, ..dimensions }, CORRECTED);
        near(long.limits(friction).expect("limits").hub_slip_nm, long.hub_moment_nm(), 1e-12);
        // Small gaps: exact and linear opening agree.
        let small = Dimensions { hub_interference_m: 1e-9, bore_opening_m: 0.5e-9, ..dimensions };
        let [exact, linear] = [CORRECTED, PAPER].map(|options| spring(&small, options));
        near(exact.hub_moment_nm(), linear.hub_moment_nm(), 1e-6);
        near(exact.transition_nm(), linear.transition_nm(), 1e-6);
        // Without friction nothing holds but what opens the coil.
        let smooth = spring(&dimensions, CORRECTED).limits(0.0).expect("limits");
        assert!(smooth.hub_slip_nm.abs() <= 0.0 && smooth.lock_nm.abs() <= 0.0 && smooth.grip_nm.is_none());
        // A hub of no more turns than its end costs holds nothing.
        let short = spring(&Dimensions { hub_turns: 0.15, ..dimensions }, CORRECTED);
        assert_eq!((short.least_friction_to_reach(), short.least_friction_to_grip(1.0)), (None, Ok(None)));
        assert_eq!(short.least_friction_to_lock(1.0), Ok(None));
        // Thick wire: friction acts nearer to the axis on the hub, farther from it in the bore. A thin one does not care.
        let thick = Options { wire: WireModel::Thick, ..CORRECTED };
        let [with, without] = [thick, CORRECTED].map(|options| spring(&dimensions, options).limits(friction).expect("limits"));
        assert!(with.hub_slip_nm <= without.hub_slip_nm && with.lock_nm <= without.lock_nm);
        let [with, without] =
            [thick, CORRECTED].map(|options| spring(&Dimensions { wire_m: 1e-7, ..dimensions }, options).limits(friction).expect("limits"));
        near(with.lock_nm, without.lock_nm, 1e-3);
    }
}

/// So many turns and so small a gap that the friction to reach the bore is below what numbers hold: what grips is found all the same.
#[test]
fn least_friction_beyond_the_range_of_numbers() {
    let long = spring(&Dimensions { hub_turns: 1e30, bore_opening_m: 1e-300, ..prototype(0.5, 0.5) }, CORRECTED);
    assert!(long.least_friction_to_reach().is_some_and(|reach| reach <= 0.0));
    let torque_nm = 5.0 * long.hub_moment_nm();
    let friction = long.least_friction_to_grip(torque_nm).expect("a number").expect("the bore grips");
    near(long.limits(friction).expect("limits").grip_nm.expect("a grip"), torque_nm, 1e-9);
}

/// (ρ ∓ 1)/ρ: on the hub the exponent is that of the inner radius of the coil, in the bore that of the outer one.
#[test]
fn thick_wire_rubs_at_its_surface() {
    let thick = Options { wire: WireModel::Thick, ..FULL_TURNS };
    let spring = gaps(0.6, 0.3, thick);
    let limits = spring.limits(0.2).expect("limits");
    let x = TAU * 0.2;
    near(limits.lock_nm, spring.hub_moment_nm() * (exp(2.0 * x * 8.2 / 8.7) - 1.0), 1e-12);
    let excess_nm = limits.hub_slip_nm - limits.transition_nm;
    near(limits.grip_nm.expect("a grip"), limits.transition_nm + excess_nm * exp(3.0 * x * 9.2 / 8.7), 1e-12);
}

/// The printed model promises more, wherever it takes the bore to hold (its condition (26)).
#[test]
fn the_paper_promises_more() {
    for (dimensions, friction) in samples() {
        let [ours, paper] = [CORRECTED, PAPER].map(|options| spring(&dimensions, options).limits(friction).expect("limits"));
        assert!(ours.transition_nm <= paper.transition_nm && ours.hub_slip_nm <= paper.hub_slip_nm && ours.lock_nm <= paper.lock_nm);
        let grows = exp(TAU * dimensions.bore_turns * friction) - 1.0;
        if let (Some(ours), Some(printed)) = (ours.grip_nm, paper.grip_nm)
            && paper.hub_slip_nm <= grows * ours_transition(&dimensions)
        {
            assert!(ours <= printed * (1.0 + 1e-12));
        }
        let [ours, paper] = [CORRECTED, PAPER].map(|options| spring(&dimensions, options).dead_turns());
        assert!(ours <= paper);
    }
}

fn ours_transition(dimensions: &Dimensions) -> f64 {
    spring(dimensions, CORRECTED).transition_nm()
}

/// The least friction is that at which the torque is just held: a little less does not hold it.
#[test]
fn least_friction_is_the_least() {
    let mut found = 0;
    for (dimensions, _) in samples() {
        let spring = spring(&dimensions, CORRECTED);
        for factor in [0.5, 1.5, 4.0, 50.0] {
            let torque_nm = factor * spring.transition_nm();
            let lock = spring.least_friction_to_lock(torque_nm).expect("a torque");
            if let Some(least) = lock {
                near(spring.limits(least).expect("limits").lock_nm, torque_nm, 1e-11);
            }
            let Some(least) = spring.least_friction_to_grip(torque_nm).expect("a torque") else {
                let rough = spring.limits(50.0).expect("limits");
                assert!(rough.grip_nm.is_none_or(|grip_nm| grip_nm < torque_nm || dimensions.bore_turns < 0.05), "{dimensions:?}");
                continue;
            };
            let [below, above] = [1.0 - 1e-9, 1.0 + 1e-9].map(|f| spring.limits(f * least).expect("limits"));
            assert!(above.grip_nm.is_some_and(|grip_nm| grip_nm >= torque_nm));
            assert!(below.grip_nm.is_none_or(|grip_nm| grip_nm < torque_nm));
            found += 1;
        }
    }
    assert!(found > 800, "{found}");
}

/// The states along a growing torque, and in the other sense.
#[test]
fn states_follow_each_other() {
    use State::{AtBore, Free, Gripped, Locked, Opening, SlipsBeforeShift, SlipsInBore, SlipsLocked};
    let along = |spring: &WrapSpring, friction: f64, torques_nmm: &[f64]| -> Vec<State> {
        let limits = spring.limits(friction).expect("limits");
        torques_nmm.iter().map(|torque| limits.state(1e-3 * torque).expect("finite")).collect()
    };
    // 64.4 N·mm to the bore, 68.5 to slip, 242 held at a friction of 0.2; 658 in the other sense.
    let states = along(&gaps(0.6, 0.5, CORRECTED), 0.2, &[0.0, 60.0, 66.0, 100.0, 240.0, 250.0, -100.0, -600.0, -700.0]);
    assert_eq!(states, [Free, Opening, AtBore, Gripped, Gripped, SlipsInBore, Locked, Locked, SlipsLocked]);
    // The printed model with too little friction for its (26): the hub holds longer than the bore.
    assert_eq!(along(&gaps(0.6, 0.5, PAPER), 0.02, &[75.0, 90.0]), [AtBore, SlipsInBore]);
    assert!(gaps(0.6, 0.5, PAPER).limits(0.02).expect("limits").largest_nm() > 0.08);
    // With less friction it never gets there: 59.5 N·mm to slip.
    assert_eq!(along(&gaps(0.6, 0.5, CORRECTED), 0.13, &[50.0, 62.0, 300.0]), [Opening, SlipsBeforeShift, SlipsBeforeShift]);
    assert!(gaps(0.6, 0.5, CORRECTED).limits(0.2).expect("limits").state(f64::NAN).is_err());
}

/// What turns S is stored and rubbed away: over one cycle of slip the work is torque times angle, and wear follows Archard.
#[test]
fn wear_follows_the_work() {
    let spring = gaps(0.6, 0.5, CORRECTED);
    let (friction, slip_rad, k, track_m) = (0.2, 100.0 * TAU, 1e-15, 0.2e-3);
    let wear = spring.hub_wear(friction, slip_rad, k, track_m).expect("wear");
    near(wear.work_j, spring.limits(friction).expect("limits").hub_slip_nm * slip_rad, 1e-14);
    near(100.0 * spring.slip_work_per_turn_j(friction).expect("work"), wear.work_j, 1e-14);
    // The volume from the pressure along the coil, by quadrature: p r² = M − τ(θ) over the turns that count.
    let (steps, angle) = (20_000, TAU * (2.0 - END_LOSS_TURNS));
    let pressed: f64 = (0..steps)
        .map(|i| {
            let theta = angle * (f64::from(i) + 0.5) / f64::from(steps);
            spring.hub_moment_nm() * exp(-friction * theta) * angle / f64::from(steps)
        })
        .sum();
    // Force = ∫p r dθ = pressed/r, path = r φ.
    near(wear.volume_m3, k * pressed * slip_rad, 1e-8);
    // Were the pressure everywhere that of the free end, the depth would be volume over track area.
    let endless = k * spring.hub_load_n_per_m() * spring.hub_radius_m() * slip_rad / track_m;
    near(wear.depth_m, endless, 1e-12);
    assert!(wear.volume_m3 < wear.depth_m * TAU * spring.hub_radius_m() * 1.8 * track_m);
    assert!(spring.hub_wear(0.0, 1.0, k, track_m).is_err() && spring.hub_wear(0.2, 1.0, k, 0.0).is_err());
}

/// The axial force is small: friction over the lead. A coil without pitch does not walk.
#[test]
fn walk_follows_the_lead() {
    let spring = gaps(0.6, 0.5, CORRECTED);
    let walk = spring.axial_walk(0.2, 1e-3, 81.5e9).expect("a walk");
    let slip_nm = spring.hub_slip_nm(0.2);
    // Work over a turn of sliding along the wire: the axial force does the share of the lead.
    near(walk.force_n, slip_nm / 9.3e-3 * 1.0 / (1.0 + (TAU * 9.3) * (TAU * 9.3)).sqrt(), 1e-12);
    // Rate of the free turns by the formula of an extension spring.
    let helix = forcewright_elements::springs::Helix { wire_m: 1e-3, mean_m: 17.4e-3, coils: 6.0 };
    near(walk.stretch_m, walk.force_n / helix.rate_n_per_m(81.5e9), 1e-12);
    near(walk.dead_travel_m, 1e-3 * spring.dead_turns(), 1e-12);
    let flat = spring.axial_walk(0.2, 0.0, 81.5e9).expect("a walk");
    assert!(flat.force_n.abs() <= 0.0 && flat.travel_per_turn_m.abs() <= 0.0);
    assert!(spring.axial_walk(0.2, -1.0, 81.5e9).is_err());
}

// ---------------------------------------------------------------------------------------------------------------------
// Stress and fatigue
// ---------------------------------------------------------------------------------------------------------------------

/// Wahl's factors against curved beams by Winkler and Bach, and those against the integral of the stress over the section.
#[test]
fn bending_factors() {
    for index in [3.0, 4.0, 8.0, 17.4, 100.0] {
        let (wahl, exact) = (wahl_factors(index).expect("curved"), winkler_factors(index).expect("curved"));
        near(wahl.inner, exact.inner, 0.005);
        near(wahl.outer, exact.outer, 0.005);
        assert!(exact.inner > 1.0 && exact.outer < 1.0);
        // Plane sections: stress a (1 − n/y) at the radius y; n from no force, a from the moment, over strips of a circle of radius 1.
        let rule = forcewright_base::quadrature::GaussLegendre::new(40);
        let over = |f: &dyn Fn(f64) -> f64| {
            rule.integrate(|u| {
                let angle = PI * u;
                PI * 2.0 * sin(angle) * sin(angle) * f(index - cos(angle))
            })
        };
        let neutral = over(&|_| 1.0) / over(&|y| 1.0 / y);
        let moment = over(&|y| (y - neutral) * (1.0 - neutral / y));
        let straight = 4.0 * moment / PI;
        near(exact.inner, (neutral / (index - 1.0) - 1.0) / straight, 1e-9);
        near(exact.outer, (1.0 - neutral / (index + 1.0)) / straight, 1e-9);
    }
    for index in [1.0, 0.5, f64::NAN, f64::INFINITY] {
        assert!(wahl_factors(index).is_err() && winkler_factors(index).is_err());
    }
    // In the locked sense the wire is pulled besides: 0.4 N·m more than on the hub at rest, at 9.3 mm, over 0.785 mm².
    let spring = gaps(0.6, 0.5, CORRECTED);
    near(spring.locked_tension_pa(0.4).expect("a torque"), (0.4 + spring.hub_moment_nm()) / 9.3e-3 / (0.25e-6 * PI), 1e-12);
}

/// The percentages of the table where stress falls to 0, Goodman's line elsewhere.
#[test]
fn fatigue_by_percentages() {
    let dh = grade("DH").expect("a grade");
    let strength_pa = dh.tensile_strength_pa(1e-3).expect("a strength");
    for (life, surface, share) in [
        (Life::HundredThousand, Surface::AsCoiled, 0.53),
        (Life::Million, Surface::AsCoiled, 0.50),
        (Life::HundredThousand, Surface::Peened, 0.62),
        (Life::Million, Surface::Peened, 0.60),
    ] {
        let at = |high_pa: f64, low_pa: f64| endurance(dh, 1e-3, life, surface, Duty { high_pa, low_pa }).expect("assessed");
        near(at(share * strength_pa, 0.0).safety, 1.0, 1e-12);
        near(at(0.5 * share * strength_pa, 0.0).safety, 2.0, 1e-12);
        // Steady stress fails at the strength only.
        near(at(strength_pa, strength_pa).safety, 1.0, 1e-12);
        let steady = at(1000e6, 500e6).safety;
        assert!(steady > at(1000e6, 0.0).safety && at(0.0, 0.0).safety > 1e300);
    }
    // Static: 0.7 of the 2220 N/mm² of a wire of 1 mm.
    let static_bending = static_strength(dh, 1e-3, 777e6).expect("in the table");
    near(static_bending.utilisation, 0.5, 1e-12);
    assert!(static_strength(dh, 0.1e-3, 1e6).is_err() && static_strength(dh, 1e-3, -1.0).is_err());
    // The free turns of configuration 2 pulse up to the slip torque of the hub.
    let spring = gaps(0.6, 0.5, CORRECTED);
    let high_pa = spring.unsupported_pa(spring.hub_moment_nm()).expect("a torque");
    let duty = Duty { high_pa, low_pa: 0.0 };
    let result = endurance(dh, 1e-3, Life::Million, Surface::AsCoiled, duty).expect("assessed");
    near(result.safety, 0.5 * 2220e6 / high_pa, 1e-12);
    assert_eq!(endurance(grade("SM").expect("a grade"), 1e-3, Life::Million, Surface::AsCoiled, duty), Err(WrapSpringError::NoFatigueData));
    for (wire_m, high_pa, low_pa) in [(0.1e-3, 1e8, 0.0), (1e-3, 1e8, 2e8), (1e-3, f64::NAN, 0.0), (f64::NAN, 1e8, 0.0), (1e-3, 1e8, -1.0)]
    {
        assert!(endurance(dh, wire_m, Life::Million, Surface::Peened, Duty { high_pa, low_pa }).is_err());
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Making
// ---------------------------------------------------------------------------------------------------------------------

/// A helix in space: its end is turned about the axis, wire and axial length kept; the radius follows.
#[test]
fn the_hand_says_what_opens() {
    for hand in [Hand::Right, Hand::Left] {
        // A right-hand helix: (r cos φ, r sin φ, c φ) with c > 0.
        let along = if hand == Hand::Right { 1.0 } else { -1.0 };
        for sense in [Sense::Clockwise, Sense::Counterclockwise] {
            for upper_end in [true, false] {
                let (angle, radius, height): (f64, f64, f64) = (along * TAU * 5.0, 1.0, 0.8);
                // Seen from above, where the upper end is looked at from, angles about +z grow counterclockwise; from below clockwise.
                let seen = if sense == Sense::Counterclockwise { 1.0 } else { -1.0 };
                let turned = if upper_end { angle + 0.1 * seen } else { angle - 0.1 * -seen };
                let wire = ((angle * radius) * (angle * radius) + height * height).sqrt();
                let new_radius = ((wire * wire - height * height) / (turned * turned)).sqrt();
                let expected = if new_radius > radius { Effect::Opens } else { Effect::Closes };
                assert_eq!(effect(hand, sense), expected, "{hand:?} {sense:?} {upper_end}");
            }
        }
    }
}

#[test]
fn wire_mass_and_room() {
    let coil = Coil { wire_m: 1e-3, radius_m: 8.7e-3, turns: 11.0, gap_m: 0.0, ends_m: 20e-3 };
    let winding = coil.winding(wire().density_kg_per_m3.value).expect("a coil");
    // The helix by a polygon of many chords.
    let (chords, pitch) = (200_000, 1e-3);
    let chord = (4.0 * 8.7e-3 * 8.7e-3 * sin(PI * 11.0 / f64::from(chords)) * sin(PI * 11.0 / f64::from(chords))
        + (pitch * 11.0 / f64::from(chords)) * (pitch * 11.0 / f64::from(chords)))
    .sqrt();
    near(winding.wire_length_m, chord * f64::from(chords) + 20e-3, 1e-7);
    near(winding.mass_kg, 7850.0 * PI * 0.25e-6 * winding.wire_length_m, 1e-12);
    near(winding.body_m, 12e-3, 1e-12);
    near(winding.solid_m, 12e-3, 1e-12);
    near(coil.room_m(0.5, 0.3e-3).expect("room"), 12.8e-3, 1e-12);
    let apart = Coil { gap_m: 0.2e-3, ..coil }.winding(7850.0).expect("a coil");
    near(apart.body_m, 14.2e-3, 1e-12);
    assert!(Coil { radius_m: 0.4e-3, ..coil }.winding(7850.0).is_err() && Coil { turns: f64::NAN, ..coil }.winding(7850.0).is_err());
}

/// Tolerances as printed, and nothing outside the tables.
#[test]
fn tolerances_are_those_of_the_tables() {
    let micrometres =
        [(0.28, 8.0), (0.5, 8.0), (0.63, 8.0), (0.7, 10.0), (1.0, 15.0), (1.6, 20.0), (2.5, 25.0), (4.0, 30.0), (5.0, 35.0), (10.0, 50.0)];
    for (diameter_mm, expected) in micrometres {
        near(1e6 * wire_tolerance_m(1e-3 * diameter_mm).expect("in the table"), expected, 1e-9);
    }
    assert!([0.2e-3, 12e-3, f64::NAN].iter().all(|diameter_m| wire_tolerance_m(*diameter_m).is_none()));
    for (mean_mm, wire_mm, grade, expected_mm) in [
        (17.4, 1.0, 2, 0.50),
        (17.4, 1.5, 1, 0.25),
        (5.0, 1.0, 3, 0.40),
        (9.0, 1.0, 2, 0.30),
        (30.0, 5.0, 2, 0.40),
        (60.0, 6.0, 1, 0.50),
        (60.0, 4.0, 3, 2.30),
    ] {
        near(1e3 * mean_diameter_tolerance_m(1e-3 * mean_mm, 1e-3 * wire_mm, grade).expect("in the table"), expected_mm, 1e-12);
    }
    for (mean_mm, wire_mm, grade) in
        [(17.4, 1.0, 0), (17.4, 1.0, 4), (17.4, 0.5, 2), (17.4, 5.0, 2), (70.0, 5.0, 2), (0.5, 0.1, 2), (f64::NAN, 1.0, 2)]
    {
        assert_eq!(mean_diameter_tolerance_m(1e-3 * mean_mm, 1e-3 * wire_mm, grade), None);
    }
}

/// The bend of a leg: force from torque, and the stress of the sharper bend is larger.
#[test]
fn legs_bend() {
    let wide = leg(0.4, 10e-3, 2e-3, 1.5e-3, 1e-3).expect("a leg");
    near(wide.force_n, 40.0, 1e-12);
    // Index 3 of the bend: (4·9 − 3 − 1)/(4·3·2) = 4/3; 32·0.08 N·m/(π·1e-9 m³).
    near(wide.stress_pa, 4.0 / 3.0 * 32.0 * 0.08 / (PI * 1e-9), 1e-12);
    assert!(leg(0.4, 10e-3, 2e-3, 1e-3, 1e-3).expect("a leg").stress_pa > wide.stress_pa);
    assert!(leg(0.4, 0.0, 1e-3, 1e-3, 1e-3).is_err() && leg(0.4, 1e-2, 1e-3, 0.5e-3, 1e-3).is_err());
}

/// Diameters of a drawing, with both gaps from the one diameter of the coil.
#[test]
fn diameters_share_the_coil() {
    // Free coil of 18.4 mm outside, 16.4 mm inside: hub 17.6, bore 19.4.
    let dimensions = Dimensions::from_diameters(1e-3, 18.4e-3, 17.6e-3, 19.4e-3, 210e9, [2.0, 3.0, 6.0]);
    let expected = prototype(0.6, 0.5);
    near(dimensions.neutral_radius_m, expected.neutral_radius_m, 1e-12);
    near(dimensions.hub_interference_m, expected.hub_interference_m, 1e-12);
    near(dimensions.bore_opening_m, expected.bore_opening_m, 1e-12);
    // A wider coil sits less tight and opens less: the margin of the gaps stays.
    let wider = Dimensions::from_diameters(1e-3, 18.5e-3, 17.6e-3, 19.4e-3, 210e9, [2.0, 3.0, 6.0]);
    near(wider.hub_interference_m - wider.bore_opening_m, 0.1e-3, 1e-9);
}

/// The radius to which an unsupported turn opens is the one whose moment it is.
#[test]
fn unsupported_turns_open() {
    let spring = gaps(0.6, 0.5, CORRECTED);
    near(spring.open_radius_m(spring.transition_nm()).expect("finite").expect("curved"), spring.bore_radius_m(), 1e-12);
    near(spring.open_radius_m(spring.hub_moment_nm()).expect("finite").expect("curved"), spring.hub_radius_m(), 1e-12);
    assert!(spring.open_radius_m(-0.1).expect("finite").expect("curved") < 8.7e-3);
    assert_eq!(spring.open_radius_m(10.0), Ok(None));
}

#[test]
fn faults_are_named() {
    let base = prototype(0.6, 0.5);
    for (name, dimensions) in [
        ("wire_m", Dimensions { wire_m: 0.0, ..base }),
        ("neutral_radius_m", Dimensions { neutral_radius_m: f64::NAN, ..base }),
        ("young_modulus_pa", Dimensions { young_modulus_pa: -1.0, ..base }),
        ("hub_interference_m", Dimensions { hub_interference_m: 0.0, ..base }),
        ("bore_opening_m", Dimensions { bore_opening_m: f64::INFINITY, ..base }),
        ("hub_turns", Dimensions { hub_turns: 0.0, ..base }),
        ("bore_turns", Dimensions { bore_turns: -1.0, ..base }),
        ("free_turns", Dimensions { free_turns: f64::NAN, ..base }),
        ("free_turns", Dimensions { free_turns: 2.9, ..base }),
    ] {
        let fault = WrapSpring::new(&dimensions, CORRECTED).expect_err("a fault");
        assert!(matches!(fault, WrapSpringError::Value { name: n, .. } if n == name) && fault.to_string().contains(name));
    }
    let solid = WrapSpring::new(&Dimensions { wire_m: 17.4e-3, ..base }, CORRECTED).expect_err("a fault");
    assert!(matches!(solid, WrapSpringError::NoHole { index } if (index - 1.0).abs() < 1e-12), "{solid}");
    assert!(WrapSpring::new(&base, Options { end_loss_turns: -0.1, ..CORRECTED }).is_err());
    let spring = spring(&base, CORRECTED);
    assert!(spring.limits(-0.1).is_err() && spring.limits(f64::NAN).is_err() && spring.least_friction_to_grip(-1.0).is_err());
    assert!(spring.unsupported_pa(f64::INFINITY).is_err() && spring.open_radius_m(f64::NAN).is_err());
    // The largest numbers give infinite torques, not nonsense.
    let huge = Dimensions { hub_turns: 1e4, bore_turns: 1e4, free_turns: 1e4, ..base };
    let limits = WrapSpring::new(&huge, CORRECTED).expect("a spring").limits(10.0).expect("limits");
    assert!(limits.grip_nm.is_some_and(|grip_nm| grip_nm > 1e300) && limits.lock_nm > 1e300);
}
