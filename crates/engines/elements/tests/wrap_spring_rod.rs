//! Wrap springs against a rod with unilateral frictional contact.

#[path = "common/coil.rs"]
mod coil;

use std::f64::consts::{PI, TAU};

use coil::{End, Rod, Torques};
use forcewright_base::maths::{cos, exp, ln, sin, tan};
use forcewright_base::roots;
use forcewright_elements::wrap_spring::{Dimensions, END_LOSS_ROD_TURNS, END_LOSS_TURNS, Model, Options, WireModel, WrapSpring};
use serde_json::Value;

const REFERENCE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../reference/wrap-spring/converged.json"));

const CORRECTED: Options = Options { model: Model::Corrected, end_loss_turns: END_LOSS_TURNS, wire: WireModel::Thin };
const PAPER: Options = Options { model: Model::Paper, ..CORRECTED };
const FULL_TURNS: Options = Options { end_loss_turns: 0.0, ..CORRECTED };
const ROD: Options = Options { end_loss_turns: END_LOSS_ROD_TURNS, ..CORRECTED };

fn near(ours: f64, exact: f64, relative: f64) {
    assert!((ours - exact).abs() <= relative * exact.abs(), "{ours} instead of {exact}");
}

/// Interference on the hub in the rod's tests, over the radius: so small that linear and exact opening agree.
const SMALL: f64 = 1e-4;

fn rod(turns: [f64; 3], share: f64, friction: f64, end: End) -> Rod {
    Rod {
        hub_interference: SMALL,
        hub_turns: turns[0],
        free_turns: turns[1],
        bore_opening: share * SMALL,
        bore_turns: turns[2],
        friction,
        compliance: 0.0,
        nodes_per_turn: 36,
        end,
    }
}

/// The same as a spring with EI = 1 N·m² and a radius of 1 m.
fn twin(rod: &Rod, options: Options) -> WrapSpring {
    let wire_m = 1e-3;
    WrapSpring::new(
        &Dimensions {
            wire_m,
            neutral_radius_m: 1.0,
            young_modulus_pa: 64.0 / (PI * 1e-12),
            hub_interference_m: rod.hub_interference,
            bore_opening_m: rod.bore_opening,
            hub_turns: rod.hub_turns,
            bore_turns: rod.bore_turns,
            free_turns: rod.free_turns + rod.bore_turns,
        },
        options,
    )
    .expect("a spring")
}

/// Slip on the hub in both senses, within 5 % over turns and friction. The default, with a larger loss at the end, promises less.
#[test]
fn rod_slips_on_the_hub() {
    for hub_turns in [1.0, 1.5, 2.0, 3.0, 4.0] {
        for friction in [0.1, 0.15, 0.2, 0.3] {
            let rod = rod([hub_turns, 0.0, 0.0], 1.0, friction, End::Torque);
            let (opening, locking) = (rod.limit(1.0).end, -rod.limit(-1.0).end);
            let (ours, default) =
                (twin(&rod, ROD).limits(friction).expect("limits"), twin(&rod, CORRECTED).limits(friction).expect("limits"));
            near(ours.hub_slip_nm, opening, 0.012);
            near(ours.lock_nm, locking, 0.05);
            assert!(default.hub_slip_nm < opening && default.lock_nm < locking);
        }
    }
}

/// What the ends of the contact cost: 0.05 turns each as friction goes to 0, by the rod and by the closed form; 0.083 to 0.100 for both up
/// to a friction of 0.3, in both senses alike. The 0.2 turns of the default are on the safe side of it.
#[test]
fn rod_loses_a_tenth_of_a_turn() {
    let stand_off = roots::root(|x| x - 2.0 * sin(x) + sin(x) * cos(x), 1.5, 3.0, 1e-14).expect("a root");
    assert!((stand_off - 2.139).abs() < 1e-3, "{stand_off}");
    let both = 2.0 * (stand_off - tan(0.5 * stand_off)) / TAU;
    assert!((both - END_LOSS_ROD_TURNS).abs() < 1e-4, "{both}");
    for (friction, least, most) in [(1e-3, 0.0995, 0.1001), (0.1, 0.097, 0.1), (0.2, 0.092, 0.095), (0.3, 0.082, 0.086)] {
        for sense in [1.0, -1.0] {
            let mut rod = rod([2.0, 0.0, 0.0], 1.0, friction, End::Torque);
            rod.nodes_per_turn = 72;
            let torque = rod.limit(sense).end / SMALL;
            let turns = ln(1.0 - torque) / (-TAU * friction * sense);
            let loss = 2.0 - turns;
            assert!((least..=most).contains(&loss), "{friction} {sense}: {loss}");
        }
    }
    // An end that is built in at the radius of the hub costs nothing; the free one alone half as much.
    let mut held = rod([2.0, 0.0, 0.0], 1.0, 1e-3, End::Held { w: SMALL });
    held.nodes_per_turn = 144;
    let loss = 2.0 + ln(1.0 - held.limit(1.0).end / SMALL) / (TAU * 1e-3);
    assert!((loss - 0.5 * both).abs() < 0.005, "{loss}");
}

/// With friction that has a history: S is turned step by step, the slip zone grows, and the torque ends at that of gross slip.
#[test]
fn rod_with_history_ends_at_gross_slip() {
    for (hub_turns, friction) in [(1.0, 0.3), (2.0, 0.12), (2.0, 0.25), (3.0, 0.15)] {
        let mut rod = rod([hub_turns, 0.0, 0.0], 1.0, friction, End::Torque);
        // Round wire of the prototype's index; without stretch the nodes that touch could only slip together.
        rod.compliance = 0.25 / (17.4 * 17.4);
        rod.nodes_per_turn = 24;
        let path = rod.open(SMALL, 60);
        let gross = rod.limit(1.0).end;
        // It grows, but for a percent where a node takes over from its neighbour.
        assert!(path.windows(2).all(|pair| pair[1].end >= 0.985 * pair[0].end), "it falls: {rod:?}");
        assert!(path[0].end < 0.5 * gross, "no history: {rod:?}");
        near(path[59].end, gross, 1e-6);
    }
}

/// Reaching the bore: the least friction of the rod, by bisection on its slip torque, within 5 %.
#[test]
fn rod_reaches_the_bore() {
    for hub_turns in [1.0, 2.0, 4.0] {
        for share in [0.5, 0.7, 0.85] {
            let slip = |friction: f64| rod([hub_turns, 0.0, 0.0], share, friction, End::Torque).limit(1.0).end / SMALL;
            let least = roots::root(|friction| slip(friction) - share, 0.01, 0.6, 1e-5).expect("a root");
            let twin_of = |options| twin(&rod([hub_turns, 0.0, 3.0], share, least, End::Torque), options).least_friction_to_reach();
            near(twin_of(ROD).expect("some"), least, 0.03);
            assert!(twin_of(CORRECTED).expect("some") > least);
        }
    }
    // Where it is not reached, the bore adds next to nothing to what the hub slips at: the coil only brushes it.
    for (share, friction) in [(0.7, 0.15), (0.8, 0.15), (0.9, 0.2)] {
        let brush = rod([1.0, 6.0, 3.0], share, friction, End::Torque).limit(1.0);
        assert!(brush.end < 1.01 * brush.hub && brush.hub < share * SMALL, "{brush:?}");
    }
}

/// Grip of the bore for a coil with the six free turns of the prototype that S holds at the radius of the bore: within 5 % over turns,
/// friction and gaps up to `τ_t = 0.7 τ_b`, and as by 2 % of the slip torque of the hub beyond. The paper's (28) is up to ten times that; the default of ours at most 2 % more.
#[test]
fn rod_grips_the_bore() {
    let mut worst: f64 = 0.0;
    for (hub_turns, bore_turns) in [(1.0, 3.0), (2.0, 1.0), (2.0, 3.0), (3.0, 2.0), (4.0, 4.0)] {
        for friction in [0.1, 0.2, 0.3] {
            for share in [0.3, 0.6, 0.8] {
                let slip = 1.0 - exp(-TAU * friction * (hub_turns - END_LOSS_ROD_TURNS));
                if share > 0.95 * slip {
                    continue;
                }
                let rod = rod([hub_turns, 6.0, bore_turns], share, friction, End::Held { w: share * SMALL });
                let grip = rod.limit(1.0).end;
                let held = |options| twin(&rod, options).limits(friction).expect("limits").grip_nm.expect("a grip");
                // Where τ_t is almost τ_b, what is left of it is small and sensitive: there the slip torque of the hub that would give this
                // grip is compared.
                if share < 0.7 * slip {
                    near(held(ROD), grip, 0.05);
                }
                near(slip, share + (grip / SMALL - share) * exp(-TAU * friction * bore_turns), 0.02);
                // The default may even say that such a coil slips before it shifts.
                if let Some(default) = twin(&rod, CORRECTED).limits(friction).expect("limits").grip_nm {
                    assert!(default < 1.02 * grip);
                }
                worst = worst.max(held(PAPER) / grip);
            }
        }
    }
    assert!((9.0..11.0).contains(&worst), "{worst}");
}

/// What the bore holds beyond the torque in the free turns: as with all its turns if S holds the coil at the radius of the bore (−0.04 to
/// +0.07 turns), and up to 0.09 turns less if the end at S carries a torque only.
#[test]
fn rod_in_the_bore_loses_at_a_loose_end_only() {
    let mut against_formula = [f64::INFINITY, f64::NEG_INFINITY];
    let (mut held, mut loose) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
    for (hub_turns, bore_turns) in [(2.0, 1.0), (2.0, 3.0), (4.0, 2.0)] {
        for free_turns in [1.0, 2.0, 6.0] {
            for (friction, share) in [(0.1, 0.3), (0.1, 0.5), (0.2, 0.3), (0.2, 0.8), (0.3, 0.5), (0.3, 0.9)] {
                for (end, range) in [(End::Held { w: share * SMALL }, &mut held), (End::Torque, &mut loose)] {
                    let rod = rod([hub_turns, free_turns, bore_turns], share, friction, end);
                    let torques = rod.limit(1.0);
                    let formula = twin(&rod, ROD).limits(friction).expect("limits").grip_nm.expect("a grip");
                    against_formula = [against_formula[0].min(torques.end / formula), against_formula[1].max(torques.end / formula)];
                    let ratio = (torques.end / SMALL - share) / (torques.hub / SMALL - share);
                    let gain = ln(ratio) / (TAU * friction) - bore_turns;
                    *range = [range[0].min(gain), range[1].max(gain)];
                }
            }
        }
    }
    // The whole grip, with what the off-centre coil changes at the hub.
    assert!(against_formula[0] > 0.87 && (1.2..1.26).contains(&against_formula[1]), "{against_formula:?}");
    assert!(held[0] > -0.045 && held[1] < 0.075, "{held:?}");
    assert!(loose[0] > -0.09 && loose[0] < -0.08 && loose[1] < 0.02, "{loose:?}");
}

/// The free turns and the hold at S move the grip: the coil leaves the hub off centre. Hub 0.6, bore 0.4, two and three turns, friction 0.12.
#[test]
fn rod_of_the_reference() {
    let reference: Value = serde_json::from_str(REFERENCE).expect("JSON");
    let printed = reference["beam"]["torque"].as_f64().expect("a number");
    let torque = |free_turns: f64, end: End| rod([2.0, free_turns, 3.0], 2.0 / 3.0, 0.12, end).limit(1.0).end / SMALL * 0.6;
    let held = End::Held { w: SMALL * 2.0 / 3.0 };
    let all: Vec<f64> = [0.5, 1.0, 2.0, 3.0, 6.0].into_iter().flat_map(|free| [torque(free, End::Torque), torque(free, held)]).collect();
    let (low, high) = all.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(*x), high.max(*x)));
    assert!(low > 0.9 && low < printed && printed < high && high < 1.1, "{low} to {high}");
    near(torque(2.0, held), printed, 0.003);
    // Full turns on the hub, and those that the rod loses: the grips of the formula around it. The paper's form of eq. (10), τ_b e^x, and (28).
    let grip = |options| {
        let rod = rod([2.0, 2.0, 3.0], 2.0 / 3.0, 0.12, held);
        twin(&rod, options).limits(0.12).expect("limits").grip_nm.expect("a grip") / SMALL * 0.6
    };
    near(grip(FULL_TURNS), reference["beam"]["grip_with_full_turns"].as_f64().expect("a number"), 1e-3);
    near(grip(ROD), 0.947, 2e-3);
    near(grip(CORRECTED), 0.838, 2e-3);
    near(0.6 * (1.0 - exp(-TAU * 0.24)) * exp(TAU * 0.36), 4.486, 1e-3);
    near(grip(PAPER), 0.6 * (exp(TAU * 0.36) - 1.0), 1e-9);
}

/// A coil without torque leaves its hub off centre by more than the interference: with a bore as near as that it brushes it on one side.
#[test]
fn rod_lies_off_centre_behind_the_hub() {
    let mut rod = rod([3.0, 4.0, 0.0], 1.0, 1e-6, End::Torque);
    let free = rod.limit(1.0);
    assert!((1.07..1.10).contains(&(free.off_centre / SMALL)), "{}", free.off_centre / SMALL);
    // Near slip with much friction the moment in the free turns is that on the hub: it is centred.
    rod.friction = 0.4;
    assert!(rod.limit(1.0).off_centre < 1e-2 * SMALL);
}

/// With history from the hub into the bore: S turns the nine turns off the hub open; the torque grows with the angle until the coil lies in the bore
/// at `τ_t`, and ends at that of gross slip in both. A coil of which `τ_b < τ_t` slips on the way.
#[test]
fn rod_with_history_reaches_and_grips_the_bore() {
    let path = |share: f64| -> (Rod, Vec<Torques>) {
        let mut rod = rod([2.0, 6.0, 3.0], share, 0.12, End::Held { w: share * SMALL });
        rod.compliance = 0.25 / (17.4 * 17.4);
        rod.nodes_per_turn = 24;
        (rod, rod.open(1.5 * TAU * twin(&rod, CORRECTED).dead_turns(), 60))
    };
    let share = 2.0 / 3.0;
    let (rod, torques) = path(share);
    let share_of_transition = |torques: &Torques| torques.end / (share * SMALL);
    // After half of the dead turns half of `τ_t`: the turns in the bore open like the others.
    near(share_of_transition(&torques[19]), 0.5, 0.02);
    let reached = torques.iter().position(|t| t.end - t.hub > 0.05 * share * SMALL).expect("it reaches the bore");
    assert!((0.95..1.05).contains(&(torques[reached - 1].hub / (share * SMALL))), "{:?}", torques[reached - 1]);
    let gross = rod.limit(1.0);
    near(torques[59].end, gross.end, 1e-6);
    near(torques[59].hub, gross.hub, 1e-6);
    let (rod, torques) = path(0.9);
    assert!(torques.iter().all(|t| t.end - t.hub < 0.01 * SMALL && t.hub < 0.8 * SMALL));
    near(torques[59].hub, rod.limit(1.0).hub, 1e-6);
}
