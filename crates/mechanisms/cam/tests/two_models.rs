//! The family's model of one mechanism against the general multibody engine, which knows no cams with springs: five bodies, pins, a guide,
//! two rolling contacts. The paths are written anew here, by x instead of λ.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use forcewright_base::maths;
use forcewright_cam::{
    Bank, Bodies, Cut, CutSide, Drive, Flaws, ForceLaw, Law as TimeLaw, Mechanism, Motion as Lift, Purpose, Sense, SidePath, Spring,
    SpringLaw, SpringMass, prescribed,
};
use forcewright_multibody::{
    Body, Contact, Follows, Force, GROUND, Grid, Instant, JointId, Kinematics, Law, Model, Motion, Path, PathPoint, Settings, Side,
    Snapshot, Stop, System, Torque,
};

const X0: f64 = 0.068;
const RADIUS: f64 = 0.016;
const RATE: f64 = 1380.0;
const FORCE: f64 = 50.0;
const STROKE: f64 = 0.24;
const BODIES: Bodies =
    Bodies { slider_kg: 0.068, brace_kg: 0.077, brace_kg_m2: 2.57e-4, roller_kg: 0.38, roller_kg_m2: 4.61e-6, springs: SpringMass::Halves };

/// One mechanism for both models.
#[derive(Clone)]
struct Design {
    brace: [f64; 2],
    share_right: f64,
    turn: [f64; 2],
    shift: [[f64; 2]; 2],
    swell: f64,
    bodies: Bodies,
    gravity: f64,
    friction: f64,
    /// Whether the general engine's slider may move sideways.
    free: bool,
}

impl Default for Design {
    fn default() -> Self {
        Self {
            brace: [0.2; 2],
            share_right: 0.5,
            turn: [0.0; 2],
            shift: [[0.0; 2]; 2],
            swell: 0.0,
            bodies: BODIES,
            gravity: 9.81,
            friction: 0.0,
            free: false,
        }
    }
}

impl Design {
    fn share(&self, side: usize) -> f64 {
        if side == 0 { self.share_right } else { 1.0 - self.share_right }
    }

    /// The family's mechanism.
    fn family(&self) -> Mechanism {
        let spring = Spring { law: SpringLaw::Linear { rate_n_per_m: RATE, rest_m: 2.0 * X0 }, stretch_m: 0.0, mass_kg: 0.0 };
        let springs = Bank::new(vec![spring], true);
        let sides = [0, 1].map(|side| CutSide { brace_m: self.brace[side], share: self.share(side) });
        let law = ForceLaw::constant(FORCE);
        let purpose = Purpose { law, springs: springs.clone(), start_length_m: 2.0 * X0, sides, friction: 0.0, stroke_m: STROKE };
        let cut = Arc::new(Cut::new(purpose).expect("a cam"));
        let flaws = |side: usize| Flaws { turn_rad: self.turn[side], shift_m: self.shift[side], swell_m: self.swell, ..Flaws::default() };
        Mechanism {
            paths: [0, 1].map(|side| SidePath::new(Arc::clone(&cut), side, RADIUS, &flaws(side))),
            brace_m: self.brace,
            roller_m: RADIUS + self.swell,
            arm_m: self.friction * (RADIUS + self.swell),
            springs,
            bodies: self.bodies,
            gravity_m_per_s2: self.gravity,
            rise_m: cut.rise_m(),
        }
    }

    /// y and its derivatives over x on a side of the cut: eqs. (1) and (3) of the theory with x = x0 + λ/2 where both sides are equal, else
    /// those of the family's own path, whose forces at rest `tests/oracle.rs` holds to the law.
    fn profile(&self, side: usize) -> impl Fn(f64) -> [f64; 4] + Send + Sync + 'static {
        let l = self.brace[side];
        let equal = (self.share_right - 0.5).abs() < f64::EPSILON && self.brace[0].to_bits() == self.brace[1].to_bits();
        let family = (!equal).then(|| self.family());
        move |x: f64| {
            if let Some(family) = &family {
                let cut = family.paths[side].cut();
                let mut lambda = 2.0 * (x - X0);
                for _ in 0..20 {
                    let point = cut.at(side, lambda);
                    lambda -= (point.x.value() - x) / point.x.derivative(1);
                }
                let point = cut.at(side, lambda);
                let [x1, x2, x3] = [1, 2, 3].map(|order| point.x.derivative(order));
                let [y0, y1, y2, y3] = [0, 1, 2, 3].map(|order| point.y.derivative(order));
                let first = y1 / x1;
                let second = (y2 - first * x2) / (x1 * x1);
                return [y0, first, second, (y3 - first * x3 - 3.0 * second * x1 * x2) / (x1 * x1 * x1)];
            }
            let c = (l * l - x * x).sqrt();
            // F s = K λ²/2, λ = 2 (x − x0).
            let k = 2.0 * RATE / FORCE;
            [
                k * (x - X0) * (x - X0) + (l * l - X0 * X0).sqrt() - c,
                2.0 * k * (x - X0) + x / c,
                2.0 * k + l * l / (c * c * c),
                3.0 * l * l * x / (c * c * c * c * c),
            ]
        }
    }

    /// Path of a side by x of the cut, turned, shifted and mirrored.
    fn path(&self, side: usize) -> impl Fn(f64) -> PathPoint + Send + Sync + 'static {
        let profile = self.profile(side);
        let (turn, shift) = (self.turn[side], self.shift[side]);
        let mirror = if side == 0 { 1.0 } else { -1.0 };
        move |x: f64| {
            let y = profile(x);
            let (sin, cos) = maths::sin_cos(turn);
            let place = |v: [f64; 2]| [mirror * (cos * v[0] - sin * v[1]), sin * v[0] + cos * v[1]];
            let [px, py] = place([x, y[0]]);
            PathPoint {
                point_m: [px + mirror * shift[0], py + shift[1]],
                first: place([1.0, y[1]]),
                second: place([0.0, y[2]]),
                third: place([0.0, y[3]]),
            }
        }
    }

    /// The general engine's mechanism; the torques are those of rolling resistance on each roller, counter-clockwise.
    fn general(&self, start: f64, motion: Option<Motion>, torques: Option<[Torque; 2]>) -> General {
        let family = self.family();
        let b = self.bodies;
        let pose = family.pose([start, 0.0]).expect("assembles");
        let rise = family.rise_m;
        let mut model = Model::new();
        model.gravity_m_per_s2 = [0.0, -self.gravity];
        let slider = model.body("slider", Body::new(b.slider_kg, 1e-3).placed(0.0, start + rise, 0.0));
        let guide = if self.free {
            model.gear("guide", slider, GROUND, 1.0, 0.0)
        } else {
            model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, 0.0)
        };
        let (mut rollers, mut contacts) = (Vec::new(), Vec::new());
        for (side, name) in ["right", "left"].into_iter().enumerate() {
            let mirror = if side == 0 { 1.0 } else { -1.0 };
            let [x, y] = pose.places[side].at;
            let angle = maths::atan2(y - start - rise, mirror * x);
            let mut brace = Body::rod(b.brace_kg, self.brace[side]).placed(0.0, start + rise, angle);
            brace.inertia_kg_m2 = b.brace_kg_m2;
            let brace = model.body(format!("{name} brace"), brace);
            let roller = model.body(format!("{name} roller"), Body::new(b.roller_kg, b.roller_kg_m2).placed(mirror * x, y, 0.0));
            model.revolute(format!("{name} pin"), brace.at(0.0, 0.0), slider.at(0.0, 0.0));
            model.revolute(format!("{name} axle"), roller.at(0.0, 0.0), brace.at(self.brace[side], 0.0));
            // A roller that is larger than the one for which it was cut: its centre runs beside the path, as if the path were a surface.
            let swollen = self.swell > 0.0;
            contacts.push(model.contact(
                format!("{name} cam"),
                Contact {
                    roller: roller.at(0.0, 0.0),
                    radius_m: if swollen { self.swell } else { RADIUS },
                    cam: GROUND,
                    path: Path::curve(self.path(side)),
                    follows: if swollen { Follows::Surface } else { Follows::Centre },
                    side: if side == 0 { Side::Right } else { Side::Left },
                    rolling: !swollen,
                    start: X0 + self.share(side) * pose.lambda_m[side],
                },
            ));
            if swollen {
                model.gear(format!("{name} roller does not turn"), roller, GROUND, 1.0, 0.0);
            }
            rollers.push(roller);
        }
        let law = Law::linear(RATE, 2.0 * X0);
        model.force("springs", Force::Spring { a: rollers[0].at(0.0, 0.0), b: rollers[1].at(0.0, 0.0), law });
        for (roller, torque) in rollers.iter().zip(torques.into_iter().flatten()) {
            model.force("rolling resistance", Force::Torque { on: *roller, from: GROUND, torque });
        }
        let driver = motion.map(|motion| model.drive_along("pull", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, motion));
        General { system: model.build().expect("sound"), guide, driver, contacts: [contacts[0], contacts[1]] }
    }
}

struct General {
    system: System,
    guide: JointId,
    driver: Option<JointId>,
    contacts: [JointId; 2],
}

/// Pull, guide, and normal force and traction of each side.
fn of_general(general: &General, instant: &Instant<'_>) -> [f64; 6] {
    let system = &general.system;
    let pull = system.driver_force(instant, general.driver.expect("driven")).expect("a driver");
    let guide = system.reaction(instant, general.guide).expect("a guide").force_n[0];
    let [right, left] = general.contacts.map(|c| system.contact_force(instant, c).expect("a contact"));
    [pull, guide, right.normal_n, left.normal_n, right.traction_n, left.traction_n]
}

fn of_family(mechanism: &Mechanism, [s, v, a]: [f64; 3], sense: Sense) -> [f64; 6] {
    let drive = Drive { at: [s, 0.0], velocity: [v, 0.0], acceleration: [a, 0.0] };
    let i = mechanism.instant(&drive, sense).expect("assembles");
    [i.force_n, i.guide_n, i.sides[0].normal_n, i.sides[1].normal_n, i.sides[0].tangential_n, i.sides[1].tangential_n]
}

/// 0.1 m from s = 32 mm in 0.125 s, eq. (17).
fn lift() -> Lift {
    Lift { law: TimeLaw::Cycloidal, start_m: 0.032, rise_m: 0.1, duration_s: 0.125, pause_s: 0.0, returns: false, reference_s: None }
}

fn cycloid(rise: f64) -> Motion {
    Motion::Cycloid { start: 0.032 + rise, stroke: 0.1, duration_s: 0.125 }
}

/// Largest difference over a motion, N; tractions only where the engine has them.
fn worst_in_motion(design: &Design, sense: Sense, torques: Option<[Torque; 2]>) -> f64 {
    let family = design.family();
    let general = design.general(0.032, Some(cycloid(family.rise_m)), torques);
    let grid = Grid { start_s: 0.0, end_s: 0.125, steps: 50 };
    let run = general.system.inverse(general.system.guess(), grid, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
    let compared = if design.swell > 0.0 { 4 } else { 6 };
    let mut worst = 0.0_f64;
    for instant in run.history.iter() {
        let ours = of_family(&family, lift().at(instant.time_s / 0.125), sense);
        let theirs = of_general(&general, &instant);
        for k in 0..compared {
            worst = worst.max((ours[k] - theirs[k]).abs());
        }
    }
    worst
}

fn worst_at_rest(design: &Design) -> f64 {
    let family = design.family();
    let mut worst = 0.0_f64;
    for s in [0.01, 0.05, 0.13, 0.2] {
        let general = design.general(s, Some(Motion::Constant(s + family.rise_m)), None);
        let grid = Grid { start_s: 0.0, end_s: 1.0, steps: 1 };
        let run = general.system.inverse(general.system.guess(), grid, Kinematics::Algebraic);
        assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
        let theirs = of_general(&general, &run.history.get(0).expect("a state"));
        let ours = of_family(&family, [s, 0.0, 0.0], Sense::Frictionless);
        for k in 0..4 {
            worst = worst.max((ours[k] - theirs[k]).abs());
        }
    }
    worst
}

fn designs() -> Vec<(&'static str, Design)> {
    let plain = Design::default;
    let light = Bodies { roller_kg_m2: 0.0, ..BODIES };
    vec![
        ("symmetric", plain()),
        ("tilted", Design { turn: [0.05, -0.05], ..plain() }),
        ("turned on one side", Design { turn: [0.01, 0.0], ..plain() }),
        ("narrower and shifted", Design { turn: [0.004; 2], shift: [[2e-4, 1e-4], [-1e-4, 3e-4]], ..plain() }),
        ("unequal braces", Design { brace: [0.2, 0.21], ..plain() }),
        ("unequal shares", Design { share_right: 0.42, ..plain() }),
        ("swollen rollers", Design { swell: 5e-4, bodies: light, ..plain() }),
        ("weightless", Design { gravity: 0.0, ..plain() }),
    ]
}

#[test]
fn both_models_agree_at_rest_and_in_motion() {
    for (name, design) in designs() {
        let (rest, moving) = (worst_at_rest(&design), worst_in_motion(&design, Sense::Frictionless, None));
        assert!(rest < 1e-9 && moving < 1e-9, "{name}: {rest:e} N at rest, {moving:e} N in motion");
    }
}

/// Eq. (1) in motion: rolling resistance as a couple N·d against each roller's turning, N from the family's model. If the engine then finds
/// the same N, both agree on it, and on all that follows.
#[test]
fn both_models_agree_with_rolling_resistance() {
    for (sense, sign) in [(Sense::Up, 1.0), (Sense::Down, -1.0)] {
        for turn in [[0.0; 2], [0.03, -0.03]] {
            let design = Design { friction: 0.02, turn, ..Design::default() };
            let torque = |side: usize| {
                let (family, arm) = (design.family(), 0.02 * RADIUS);
                Torque::Function(Arc::new(move |snapshot: &Snapshot<'_>| {
                    let normal = of_family(&family, lift().at(snapshot.time_s / 0.125), sense)[2 + side];
                    // Going up, the right roller turns counter-clockwise on the cam to its left, and is held back clockwise.
                    let way = if side == 0 { -1.0 } else { 1.0 };
                    sign * way * normal * arm
                }))
            };
            let worst = worst_in_motion(&design, sense, Some([torque(0), torque(1)]));
            assert!(worst < 1e-9, "{sense:?} {turn:?}: {worst:e}");
        }
    }
}

/// The paper's own procedure: Runge and Kutta's method of fourth order with Baumgarte's stabilisation against the model of one coordinate.
/// An independent program in the paper's nine coordinates has the errors of `rk4_convergence_T0.125`; here the coordinates are others, the
/// order is the same and the errors are no larger.
#[test]
fn the_paper_s_procedure_converges_with_fourth_order() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../../../reference/cam/converged.json")).expect("valid JSON");
    let design = Design::default();
    let family = design.family();
    let errors = [100_usize, 200, 400, 800].map(|steps| {
        let general = design.general(0.032, Some(cycloid(family.rise_m)), None);
        let grid = Grid { start_s: 0.0, end_s: 0.125, steps };
        let run = general.system.inverse(general.system.guess(), grid, Kinematics::Baumgarte { rate_per_s: 10.0 / 0.125 });
        assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
        let error = |instant: Instant<'_>| {
            let ours = of_family(&family, lift().at(instant.time_s / 0.125), Sense::Frictionless);
            (ours[0] - of_general(&general, &instant)[0]).abs()
        };
        let worst = run.history.iter().map(error).fold(0.0, f64::max);
        let theirs = reference["multibody"]["rk4_convergence_T0.125"][steps.to_string()]["max_dF"].as_f64().expect("a number");
        assert!(worst < theirs, "{steps}: {worst:e} N, {theirs:e} N elsewhere");
        worst
    });
    for pair in errors[..3].windows(2) {
        assert!((14.0..18.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// Let go at rest without friction, both models fall back alike, on a guide and without one.
#[test]
fn both_models_fall_back_alike() {
    for free in [false, true] {
        falls_back(&Design { turn: [0.01, 0.0], free, ..Design::default() });
    }
}

fn falls_back(design: &Design) {
    let family = design.family();
    let general = design.general(0.1, None, None);
    let run = general.system.simulate(general.system.guess(), &[], &Settings::until(0.05).accuracy(1e-12));
    assert_eq!(run.stop, Stop::Reached);
    let last = run.history.last().expect("states");
    let asked = forcewright_cam::Release {
        pull_n: 0.0,
        weight_kg: 0.0,
        weight_m_per_s2: 9.81,
        damping_n_s_per_m: 0.0,
        sideways_m: design.free.then_some(0.0),
        start_m: 0.1,
        duration_s: 0.05,
        stops_m: [1e-4, STROKE],
    };
    let ours = forcewright_cam::release(&family, &asked);
    assert_eq!(ours.end, forcewright_cam::End::Time);
    let moment = ours.moments.last().expect("moments");
    assert!((moment.travel_m + family.rise_m - last.q[1]).abs() < 1e-10, "{} {}", moment.travel_m, last.q[1] - family.rise_m);
    assert!((moment.speed_m_per_s - last.velocity[1]).abs() < 1e-8, "{} {}", moment.speed_m_per_s, last.velocity[1]);
    assert!((moment.sideways_m - last.q[0]).abs() < 1e-10, "{} {}", moment.sideways_m, last.q[0]);
    assert_eq!(moment.sideways_m.abs() > 1e-4, design.free, "it goes sideways: {}", moment.sideways_m);
}

/// A slider that is driven along its travel and free to move sideways, on a tilted cam: the general engine integrates its motion too.
#[test]
fn both_models_swing_sideways_alike() {
    let design = Design { turn: [0.02, -0.02], free: true, ..Design::default() };
    let family = design.family();
    let general = design.general(0.032, Some(cycloid(family.rise_m)), None);
    let run = general.system.simulate(general.system.guess(), &[], &Settings::until(0.125).accuracy(1e-12));
    assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
    let ours = prescribed(&family, &lift(), Some(0.0)).expect("moves");
    let (ours, theirs) = (ours.iter().step_by(2), run.history.iter());
    assert_eq!(ours.len(), theirs.len());
    let (mut worst, mut widest) = ([0.0_f64; 2], 0.0_f64);
    for (ours, theirs) in ours.zip(theirs) {
        assert!((ours.time_s - theirs.time_s).abs() < 1e-15);
        let pull = general.system.driver_force(&theirs, general.driver.expect("driven")).expect("a driver");
        worst = [worst[0].max((ours.sideways_m - theirs.q[0]).abs()), worst[1].max((ours.moving.force_n - pull).abs())];
        widest = widest.max(ours.sideways_m.abs());
        assert!(ours.moving.guide_n.abs() < 1e-9, "nothing guides it");
    }
    assert!(widest > 1e-3, "it swings: {widest}");
    assert!(worst[0] < 1e-10 && worst[1] < 1e-6, "{worst:?}");
}
