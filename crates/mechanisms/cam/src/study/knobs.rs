//! From the path of a number to what it changes in a design.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::Variable;

use crate::design::{Design, whole};
use crate::spec::Spec;
use crate::springs::{Bank, Spring, SpringLaw};

/// What a number changes. In a search the cam is cut anew for the design that is tried; the scatter of making leaves it as it was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Knob {
    Brace,
    RollerDiameter,
    RollingArm,
    RollingFriction,
    Rate(usize),
    RateOfAll,
    RestLength,
    Turns,
    Pitch,
    SpringMass,
    SliderMass,
    BraceMass,
    BraceInertia,
    RollerMass,
    RollerInertia,
    Gravity,
    Tilt,
    /// Right, left.
    Turn([bool; 2]),
    Offset([bool; 2]),
    Height,
    RandomDeviation,
    RandomCorrelation,
    RandomSeed,
    ForForce,
    ForRate,
    ForRestLength,
    ForStartLength,
    ForFriction,
    Share,
}

/// Path of the number that says which random profile is drawn.
pub(super) const SEED: &str = "errors.random_profile.seed";

/// The numbers of a study, understood.
#[derive(Clone, Debug)]
pub(super) struct Knobs {
    each: Vec<Knob>,
    pub(super) variables: Vec<Variable>,
    /// Whether the cam is cut anew.
    cuts: bool,
    /// What a knob needs to know of the file.
    file: FromFile,
}

/// Numbers that stand together in the file and apart in the design.
#[derive(Clone, Copy, Debug, Default)]
struct FromFile {
    turns: f64,
    pitch_m: f64,
    turn_rad: [f64; 3],
    offset_m: [f64; 3],
    for_rate: f64,
    for_rest_m: f64,
    starts_at_rest: bool,
    down: bool,
    /// Rolling friction of rollers of any size. Without it the arm stays when the rollers change: scatter of making keeps it, and so does a
    /// search where the file gives the arm.
    rolling: Option<f64>,
}

impl Knobs {
    /// Understands the numbers; what this family cannot change is reported.
    pub(super) fn new(spec: &Spec, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Self> {
        let cuts = purpose == Purpose::Search;
        let before = diagnostics.errors();
        let mut each = Vec::new();
        for free in free {
            match knob(&free.number.path, cuts) {
                Ok(knob) => each.push(knob),
                Err(why) => diagnostics.push(
                    Diagnostic::error("E0313", free.number.span, format!("a study cannot change `{}`", free.number.path))
                        .label(why)
                        .help("take it out of the study's numbers"),
                ),
            }
        }
        if diagnostics.errors() > before {
            return None;
        }
        let variables = free.iter().map(|free| Variable {
            path: free.number.path.clone(),
            unit: free.number.dimension.si_symbol(),
            nominal: free.number.si,
            lower: free.lower,
            upper: free.upper,
        });
        Some(Self { each, variables: variables.collect(), cuts, file: FromFile::of(spec, cuts) })
    }

    /// Whether a design tried has a cam of its own.
    pub(super) fn cuts(&self) -> bool {
        self.cuts
    }

    /// Takes away the steps of differences by a seed, which no value follows smoothly.
    pub(super) fn without_seed(&self, steps: &mut [f64]) {
        let seeds = self.each.iter().zip(steps).filter(|(knob, _)| matches!(knob, Knob::RandomSeed));
        seeds.for_each(|(_, step)| *step = 0.0);
    }

    /// Changes a copy of the design.
    pub(super) fn apply(&self, x: &[f64], design: &mut Design) {
        let mut file = self.file;
        for (knob, x) in self.each.iter().zip(x) {
            self.turn(*knob, *x, design, &mut file);
        }
        // What several knobs may change together.
        let built = &mut design.built;
        if let Some(friction) = file.rolling {
            built.arm_m = friction * built.roller_m;
        }
        for spring in &mut built.springs {
            spring.stretch_m = file.turns * file.pitch_m;
        }
        for side in 0..2 {
            built.turn_rad[side] = file.turn_rad[0] + file.turn_rad[1 + side];
            built.offset_m[side] = file.offset_m[0] + file.offset_m[1 + side];
        }
        let springs = self.each.iter().any(|k| matches!(k, Knob::ForRate | Knob::ForRestLength));
        if springs {
            let law = SpringLaw::Linear { rate_n_per_m: file.for_rate, rest_m: file.for_rest_m };
            design.purpose.springs = Bank::new(vec![Spring { law, stretch_m: 0.0, mass_kg: 0.0 }], built.extension);
            if file.starts_at_rest {
                design.purpose.start_length_m = file.for_rest_m;
            }
        }
    }

    fn turn(&self, knob: Knob, x: f64, design: &mut Design, file: &mut FromFile) {
        let (built, purpose) = (&mut design.built, &mut design.purpose);
        match knob {
            Knob::Brace => {
                built.brace_m = [x; 2];
                if self.cuts {
                    purpose.sides.iter_mut().for_each(|side| side.brace_m = x);
                }
            }
            Knob::RollerDiameter => {
                built.roller_m = 0.5 * x;
                if self.cuts {
                    design.cut_roller_m = 0.5 * x;
                }
            }
            Knob::RollingArm => built.arm_m = x,
            Knob::RollingFriction => file.rolling = Some(x),
            Knob::Rate(index) => {
                if let Some(spring) = built.springs.get_mut(index) {
                    set_rate(spring, x);
                }
            }
            Knob::RateOfAll => built.springs.iter_mut().for_each(|s| set_rate(s, x)),
            Knob::RestLength => {
                for spring in &mut built.springs {
                    if let SpringLaw::Linear { rest_m, .. } = &mut spring.law {
                        *rest_m = x;
                    }
                }
            }
            Knob::Turns => file.turns = x,
            Knob::Pitch => file.pitch_m = x,
            Knob::SpringMass => built.springs.iter_mut().for_each(|s| s.mass_kg = x),
            Knob::SliderMass => built.bodies.slider_kg = x,
            Knob::BraceMass => built.bodies.brace_kg = x,
            Knob::BraceInertia => built.bodies.brace_kg_m2 = x,
            Knob::RollerMass => built.bodies.roller_kg = x,
            Knob::RollerInertia => built.bodies.roller_kg_m2 = x,
            Knob::Gravity => built.gravity_m_per_s2 = x,
            Knob::Tilt => built.tilt_rad = x,
            Knob::Turn([right, left]) => file.turn_rad[which(right, left)] = x,
            Knob::Offset([right, left]) => file.offset_m[which(right, left)] = x,
            Knob::Height => built.height_m = x,
            Knob::RandomDeviation => built.random.iter_mut().for_each(|r| r.deviation_m = x),
            Knob::RandomCorrelation => built.random.iter_mut().for_each(|r| r.correlation_m = x),
            Knob::RandomSeed => built.random.iter_mut().for_each(|r| r.seed = whole(x)),
            Knob::ForForce => purpose.law = crate::law::ForceLaw::constant(x),
            Knob::ForRate => file.for_rate = x,
            Knob::ForRestLength => file.for_rest_m = x,
            Knob::ForStartLength => purpose.start_length_m = x,
            Knob::ForFriction => purpose.friction = if file.down { -x } else { x },
            Knob::Share => {
                purpose.sides[0].share = x;
                purpose.sides[1].share = 1.0 - x;
            }
        }
    }
}

/// Both, right, left.
fn which(right: bool, left: bool) -> usize {
    match (right, left) {
        (true, true) => 0,
        (true, false) => 1,
        _ => 2,
    }
}

pub(crate) fn set_rate(spring: &mut Spring, rate: f64) {
    if let SpringLaw::Linear { rate_n_per_m, .. } = &mut spring.law {
        *rate_n_per_m = rate;
    }
}

impl FromFile {
    fn of(spec: &Spec, cuts: bool) -> Self {
        use crate::design::si;
        let (springs, errors, profile) = (&spec.design.springs, &spec.errors, &spec.design.profile);
        let or0 = |slot| si(slot).unwrap_or(0.0);
        Self {
            turns: or0(&springs.adjust.turns),
            pitch_m: or0(&springs.adjust.pitch),
            turn_rad: [or0(&errors.profile_rotation), or0(&errors.profile_rotation_right), or0(&errors.profile_rotation_left)],
            offset_m: [or0(&errors.profile_offset), or0(&errors.profile_offset_right), or0(&errors.profile_offset_left)],
            for_rate: or0(&profile.for_rate),
            for_rest_m: or0(&profile.for_rest_length),
            starts_at_rest: profile.for_start_length.is_none(),
            down: profile.compensate.as_ref().is_some_and(|c| c.value == "down"),
            rolling: si(&spec.design.rolling_friction).filter(|_| cuts),
        }
    }
}

/// What a path means, or why a study cannot change it.
fn knob(path: &str, cuts: bool) -> Result<Knob, &'static str> {
    if path.starts_with("design.profile.") && !cuts {
        return Err("the cam is cut once: what it is cut for does not scatter");
    }
    Ok(match path {
        "design.brace_length" => Knob::Brace,
        "design.roller_diameter" => Knob::RollerDiameter,
        "design.rolling_arm" => Knob::RollingArm,
        "design.rolling_friction" => Knob::RollingFriction,
        "design.springs.rate" => Knob::RateOfAll,
        "design.springs.rest_length" => Knob::RestLength,
        "design.springs.adjust.turns" => Knob::Turns,
        "design.springs.adjust.pitch" => Knob::Pitch,
        "design.springs.mass" => Knob::SpringMass,
        "design.bodies.slider_mass" => Knob::SliderMass,
        "design.bodies.brace_mass" => Knob::BraceMass,
        "design.bodies.brace_inertia" => Knob::BraceInertia,
        "design.bodies.roller_mass" => Knob::RollerMass,
        "design.bodies.roller_inertia" => Knob::RollerInertia,
        "environment.gravity" => Knob::Gravity,
        "errors.tilt" => Knob::Tilt,
        "errors.profile_rotation" => Knob::Turn([true, true]),
        "errors.profile_rotation_right" => Knob::Turn([true, false]),
        "errors.profile_rotation_left" => Knob::Turn([false, true]),
        "errors.profile_offset" => Knob::Offset([true, true]),
        "errors.profile_offset_right" => Knob::Offset([true, false]),
        "errors.profile_offset_left" => Knob::Offset([false, true]),
        "errors.profile_height" => Knob::Height,
        "errors.random_profile.deviation" => Knob::RandomDeviation,
        "errors.random_profile.correlation_length" => Knob::RandomCorrelation,
        SEED => Knob::RandomSeed,
        "design.profile.for_force" => Knob::ForForce,
        "design.profile.for_rate" => Knob::ForRate,
        "design.profile.for_rest_length" => Knob::ForRestLength,
        "design.profile.for_start_length" => Knob::ForStartLength,
        "design.profile.for_friction" => Knob::ForFriction,
        "design.profile.share_right" => Knob::Share,
        _ => match path.strip_prefix("design.springs.rates.").and_then(|n| n.parse::<usize>().ok()) {
            Some(place @ 1..) => Knob::Rate(place - 1),
            _ => return Err("it does not change the force"),
        },
    })
}
