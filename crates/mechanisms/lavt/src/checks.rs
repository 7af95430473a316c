//! Requirements and rules against what was found.

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::{Comparison, limited};
use forcewright_model::{Check, Sense};

use crate::analysis::{Behaviour, PERMISSIBLE};
use crate::closing::Ending;
use crate::design::{Design, DisplayUnits, Requirements, Source};
use crate::gears::Train;
use crate::metrics::{LavtMetrics, METRICS, Measured};

/// Least contact ratio: below it teeth let go before the next ones meet, with some room for errors of making.
pub(crate) const LEAST_CONTACT_RATIO: f64 = 1.1;
/// Least gap between the tips of neighbouring planets, modules.
pub(crate) const LEAST_GAP: f64 = 0.5;

/// What the event of a force that is reached may be off by, relative.
const EVENT_ERROR: f64 = 1e-6;

/// The unit in which people are shown a metric.
pub(crate) fn display_unit(requirements: Option<&Requirements>, units: &DisplayUnits, index: usize) -> Unit {
    use Dimension as D;
    let Some(info) = METRICS.get(index) else { return Unit::si(D::Ratio) };
    let limit = requirements.iter().flat_map(|r| &r.limits).find(|l| l.metric == index).map(|l| l.unit.clone());
    let named = |symbol: &str| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(info.dimension));
    limit.unwrap_or_else(|| match info.dimension {
        D::Length => units.length.clone(),
        D::Force => units.force.clone(),
        D::Torque => units.torque.clone(),
        D::Stress => units.stress.clone(),
        D::AngularSpeed => units.speed.clone(),
        D::Energy => named("J"),
        D::Volume => named("cm^3"),
        D::Ratio if info.name.starts_with("efficiency") || info.name == "mesh_efficiency" => named("%"),
        other => Unit::si(other),
    })
}

/// The force that a closing must reach, less what its event may be off by, N; `None` where none is wanted or there is nothing to grasp.
pub(crate) fn wanted_force_n(design: &Design) -> Option<f64> {
    let hand = design.hand.as_ref().filter(|h| h.object_n_per_m.is_some())?;
    Some((1.0 - EVENT_ERROR) * hand.force_n?)
}

/// Requirements in the order of the language, then the family's own rules.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let context = Context { design, behaviour, measured };
    let mut all = Vec::new();
    if let Some(requirements) = &design.requirements {
        all.extend(context.transition(requirements));
        all.extend(context.output(requirements));
        all.extend(context.speed(requirements));
        all.extend(context.efficiency(requirements));
        all.extend(context.limits(requirements));
    }
    all.push(context.shifts());
    all.push(context.shifts_always());
    all.extend(context.grips());
    all.extend(context.opens());
    all.push(context.wire());
    all.push(context.supported());
    all.extend(context.returns());
    all.push(context.planets());
    all.push(context.backlash());
    all.push(context.undercut());
    all.push(context.interference());
    all.extend(["sun", "ring"].map(|with| context.contact(with)));
    all.extend(context.teeth());
    all.extend(context.motor());
    all.extend(context.grasp());
    all
}

struct Context<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    measured: &'a Measured,
}

impl Context<'_> {
    fn base(&self, code: &'static str, name: &str, title: &str, metric: &str) -> Comparison {
        let display = |i| display_unit(self.design.requirements.as_ref(), &self.design.units, i);
        let base = Comparison::of_metric(code, [name, title], metric, self.measured, display, self.missing(metric));
        Comparison { sense: Sense::AtLeast, ..base }
    }

    /// Why a value is missing.
    fn missing(&self, metric: &str) -> String {
        let design = self.design;
        let text = match metric {
            "efficiency_max" | "plateau_end_input" | "plateau_width_input" | "downshift_torque_output" | "shift_hysteresis_output" => {
                "there is no mode II with that torque: see what is said of the clutch"
            }
            "bore_grip_torque" | "friction_min_hub" | "friction_min_bore" => {
                "no friction is enough: the hub must be tighter than the bore is wide"
            }
            "spring_safety_factor" => "give `material.spring.use` or `tensile_strength`",
            "tooth_bending_stress" | "flank_pressure" => "give `material.gears`",
            "closing_time" | "grasp_time" | "grasp_force" | "energy_per_grasp" | "peak_current" | "motor_speed_max"
            | "grasps_per_charge" | "holding_power" => self.missing_closing(metric),
            "performance_index" => "give `hand.speed`",
            "energy_loss_index" => "give `[motor]`, and `hand.speed`; or there is no mode II with the required torque",
            "stall_power" => "give `[motor]`; or there is no mode II with the required torque",
            "squeeze_work" => "give `hand.object_stiffness`",
            "finger_force" => "give `[hand]`",
            name if name.starts_with("bench_") && design.bench.is_none() => "give `[measurements.bench]`",
            name if name.starts_with("bench_") => "the bench does not determine it: see what is said of it",
            _ if design.requirements.is_none() => "no torque is required; give `requirements.input_torque`",
            _ => "the design has no such value; see the meaning of the metric",
        };
        text.to_owned()
    }

    /// Why there is no closing, or not that of it.
    fn missing_closing(&self, metric: &str) -> &'static str {
        let Design { motor, hand, .. } = self.design;
        let (Some(motor), Some(hand)) = (motor, hand) else { return "give `[motor]` and `[hand]`" };
        let Some(grasp) = &self.behaviour.grasp else {
            return if motor.inertia_kg_m2.is_none() { "give `motor.inertia`" } else { "give `hand.inertia` and `hand.opening`" };
        };
        match grasp.ending {
            Ending::Touched => "give `hand.object_stiffness`",
            Ending::Unfinished => "the closing did not end within its time: see the figures",
            _ if grasp.touch_s.is_none() => "the hand does not reach the object: glove or friction take more than mode I gives",
            Ending::Slips => "the clutch slips and the motor runs on: there is no end of its work",
            _ if metric == "grasps_per_charge" && motor.battery.is_none() => "give `motor.battery`",
            _ if hand.object_n_per_m.is_none() => "give `hand.object_stiffness`",
            _ => "the force rose at once: there is no 95 % of it on the way",
        }
    }

    fn torque(&self, nm: f64) -> String {
        format_si(nm, &self.design.units.torque, 4)
    }

    fn length(&self, m: f64) -> String {
        format_si(m, &self.design.units.length, 4)
    }

    /// Diameter of the bore at which the transition comes at a torque on the spring.
    fn bore_for(&self, spring_nm: f64) -> f64 {
        let clutch = &self.behaviour.clutch;
        let now_m = clutch.dimensions().bore_opening_m;
        self.design.built.bore_m + 2.0 * now_m * (spring_nm / clutch.transition_nm() - 1.0)
    }

    /// The same check over the range of friction and the tolerances: asked for as well as that of the drawing, but in the paper's model,
    /// which knows neither.
    fn everywhere(&self, drawn: &Comparison, metric: &str, limit: f64) -> Option<Check> {
        if !self.design.scatters() {
            return None;
        }
        let title = format!("{}, over friction and tolerances", drawn.title);
        let base = self.base(drawn.code, &format!("{}_always", drawn.name), &title, metric);
        let shown = |si: f64| format_si(si, &base.display, 4);
        let fix = match drawn.value {
            Some(value) => format!(
                "as drawn it is {}: a design farther from the limit, closer fits, or a friction that is known better; `forcewright tolerance` shows which",
                shown(value)
            ),
            None => drawn.fix.clone(),
        };
        let basis = "the worst of both ends of the friction and all corners of wire, spring, hub and bore".to_owned();
        let required = self.design.source == Source::Corrected;
        Some(Comparison { required, limit: Some(limit), sense: drawn.sense, fix, basis, ..base }.judge())
    }

    /// LAVT001: torque at which it shifts.
    fn transition(&self, requirements: &Requirements) -> Vec<Check> {
        let mut all = Vec::new();
        let statics = &self.behaviour.statics;
        let senses = [
            ("transition_torque_min", Sense::AtLeast, "transition_torque_output_low"),
            ("transition_torque_max", Sense::AtMost, "transition_torque_output_high"),
        ];
        for (wanted, (name, sense, always)) in requirements.transition_nm.iter().zip(senses) {
            let Some(wanted_nm) = *wanted else { continue };
            let title = if sense == Sense::AtLeast { "Shifts late enough" } else { "Shifts early enough" };
            let base = self.base("LAVT001", name, title, "transition_torque_output");
            let input_nm = (wanted_nm + statics.constant_nm[0]) / (1.0 - statics.proportional[0]);
            let fix = if statics.grip_nm.is_none() && sense == Sense::AtLeast {
                "the spring slips on the hub at this torque, before it shifts: see there".to_owned()
            } else {
                format!(
                    "the torque goes with the opening: a bore of about {}, and as much more on the hub; or another wire",
                    self.length(self.bore_for(input_nm * statics.leverage()))
                )
            };
            let basis = "eqs. (19), (24), with the losses of mode I; where the spring slips first, the torque at which it does";
            let drawn = Comparison { limit: Some(wanted_nm), sense, fix, basis: basis.to_owned(), ..base };
            let everywhere = self.everywhere(&drawn, always, wanted_nm);
            all.push(drawn.judge());
            all.extend(everywhere);
        }
        all
    }

    /// LAVT002: torque at the output.
    fn output(&self, requirements: &Requirements) -> Vec<Check> {
        let Some(wanted_nm) = requirements.output_nm else { return Vec::new() };
        let base = self.base("LAVT002", "output_torque", "Torque at the output", "output_torque_max");
        let statics = &self.behaviour.statics;
        let needed_nm = statics.plateau_end_nm(wanted_nm);
        let fix = match statics.grip_nm {
            None => "the spring slips before it shifts: see there".to_owned(),
            Some(_) if statics.held_input_nm() < requirements.input_nm => {
                format!("the bore holds only {} at the input: see there", self.torque(statics.held_input_nm()))
            }
            Some(_) => format!("it needs {} at the input; or less friction of the hub, or a smaller ratio", self.torque(needed_nm)),
        };
        let basis = "eq. (17): τ_out = τ_in/R − τ_b, less losses, as far as the bore holds";
        let drawn = Comparison { limit: Some(wanted_nm), fix, basis: basis.to_owned(), ..base };
        let everywhere = self.everywhere(&drawn, "output_torque_max_low", wanted_nm);
        [drawn.judge()].into_iter().chain(everywhere).collect()
    }

    /// LAVT003: what is lost of the speed.
    fn speed(&self, requirements: &Requirements) -> Option<Check> {
        let limit = requirements.speed_drop?;
        let base = self.base("LAVT003", "speed_drop", "Speed in mode I over mode II", "speed_drop");
        let fix = format!("fewer teeth on the ring, or more on the sun: ring/sun of at most {}", format_number(limit - 1.0, 4));
        let basis = "eq. (9): 1/R = 1 + ring/sun; the paper prints ≥ 5 where its reason, not to lose control, asks for ≤ 5";
        Some(Comparison { limit: Some(limit), sense: Sense::AtMost, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// LAVT004: efficiency.
    fn efficiency(&self, requirements: &Requirements) -> Vec<Check> {
        let Some(wanted) = requirements.efficiency else { return Vec::new() };
        let base = self.base("LAVT004", "efficiency", "Efficiency with the input torque", "efficiency_max");
        let most_nm = (1.0 - self.behaviour.statics.proportional[1] - wanted) * requirements.input_nm / self.behaviour.statics.ratio;
        let fix = if most_nm > 0.0 {
            format!("the slip on the hub takes it: `τ_b` of at most {}", self.torque(most_nm))
        } else {
            "the losses of mode II alone take more".to_owned()
        };
        let fix = if base.value.is_none() { base.missing.clone() } else { fix };
        let basis = "eq. (18): η = 1 − R τ_b/τ_in, less losses";
        // Without a mode II the power goes into slip, or nothing turns.
        let value = base.value.or(Some(0.0));
        let drawn = Comparison { value, limit: Some(wanted), fix, basis: basis.to_owned(), ..base };
        let everywhere = self.everywhere(&drawn, "efficiency_max_low", wanted);
        [drawn.judge()].into_iter().chain(everywhere).collect()
    }

    /// LAVT005: limits on metrics.
    fn limits(&self, requirements: &Requirements) -> Vec<Check> {
        let fix = "change the design, or the limit; `forcewright tolerance` shows which numbers move it";
        limited::<LavtMetrics>(&requirements.limits, fix, |name, title| self.base("LAVT005", name, title, name))
    }

    /// What would let the spring reach the bore.
    fn tighter(&self) -> String {
        let [hub_m, bore_m] = self.design.built.gaps_m();
        match self.behaviour.clutch.least_friction_to_reach() {
            Some(friction) => {
                let turns = self.design.built.spring.hub_turns - 0.2;
                let wanted = turns * friction / self.design.built.friction[0] + 0.2;
                format!(
                    "a friction of {} on the hub, or {} turns on it, or a larger hub: `δa` is {}, `δb` {}",
                    format_number(1.01 * friction, 3),
                    format_number(1.01 * wanted, 3),
                    self.length(hub_m),
                    self.length(bore_m)
                )
            }
            None => format!(
                "no friction is enough: the hub must be tighter than the bore is wide, and here `δa` is {}, `δb` {}; enlarge the hub or narrow the bore",
                self.length(hub_m),
                self.length(bore_m)
            ),
        }
    }

    /// LAVT006: the spring reaches the bore before it slips.
    fn shifts(&self) -> Check {
        let base = self.base("LAVT006", "shifts", "Shifts before it slips", "shift_margin");
        let basis = "`τ_b` over `τ_t`: below 1 the transmission is a torque limiter; by the paper's eq. (25) `τ_b` does not know friction";
        // The paper's configuration 1 has exactly 1, and its model calls that a shift.
        let limit = if self.design.source == Source::Paper { 1.0 - 1e-9 } else { 1.0 };
        Comparison { limit: Some(limit), fix: self.tighter(), basis: basis.to_owned(), ..base }.judge()
    }

    /// LAVT007: also with the least friction and the worst gaps.
    fn shifts_always(&self) -> Check {
        let base = self.base("LAVT007", "shifts_always", "Shifts with the least friction and the worst gaps", "shift_margin_low");
        let falls =
            self.measured.get("gap_difference_low").map_or_else(String::new, |m| format!("`δa − δb` falls to {}: ", self.length(m)));
        let fix =
            format!("{falls}a larger hub, closer fits of hub and bore, more turns on the hub, or a surface whose friction is known better");
        let required = self.design.source == Source::Corrected;
        let basis = "the same at the corners of the tolerances, with the least friction";
        Comparison { required, limit: Some(1.0), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// LAVT008: the bore holds the torque.
    fn grips(&self) -> Vec<Check> {
        let Some(requirements) = &self.design.requirements else { return Vec::new() };
        let needs = self.measured.get("friction_min_bore");
        let fix = needs.map_or_else(
            || self.tighter(),
            |mu| {
                format!(
                    "a friction of {}, or more turns in the bore, or a larger hub: only `τ_b − τ_t` presses on the bore",
                    format_number(1.01 * mu, 3)
                )
            },
        );
        let basis = "τ_S − τ_t ≤ (τ_b − τ_t) exp(2π N_B μ); eq. (28) takes the whole of `τ_b`";
        let one = |name: &str, title: &str, metric: &str, required: bool| {
            let base = self.base("LAVT008", name, title, metric);
            let limit = Some(requirements.input_nm);
            Comparison { required, limit, fix: fix.clone(), basis: basis.to_owned(), ..base }.judge()
        };
        let required = self.design.source == Source::Corrected;
        vec![
            one("grips", "Bore holds the input torque", "input_torque_held", true),
            one("grips_always", "Bore holds it with the least friction and the worst gaps", "input_torque_held_low", required),
        ]
    }

    /// LAVT009: the opening direction of the hand.
    fn opens(&self) -> Option<Check> {
        let requirements = self.design.requirements.as_ref()?;
        let base = self.base("LAVT009", "opens", "Hub holds the input torque in the opening direction", "input_torque_opening");
        let need = self.behaviour.clutch.least_friction_to_lock(self.behaviour.statics.leverage() * requirements.input_nm).ok().flatten();
        let fix = need.map_or_else(String::new, |mu| {
            let turns = self.design.built.spring.hub_turns * mu / self.design.built.friction[0];
            format!("more turns on the hub, about {}, or a friction of {}", format_number(turns, 3), format_number(mu, 3))
        });
        let basis = "eq. (29): M_A (exp(2π N_A μ) − 1); only needed if the hand opens against that torque";
        Some(Comparison { required: false, limit: Some(requirements.input_nm), fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// LAVT010: stress of the wire.
    fn wire(&self) -> Check {
        let wanted = self.design.requirements.as_ref().and_then(|r| r.safety_factor);
        let base = self.base("LAVT010", "wire", "Stress of the wire", "spring_safety_factor");
        let limit = wanted.unwrap_or(1.0);
        let fix = base.value.map_or_else(String::new, |value| {
            format!(
                "stress grows with the wire and with the interference: a wire of at most {} with these gaps, or a larger coil",
                self.length(self.design.built.spring.wire_m * value / limit)
            )
        });
        let basis = "0.7 of the tensile strength (EN 13906-3) over the largest bending stress, with the factor of the curved wire; eqs. (20) to (22)";
        Comparison { required: wanted.is_some(), limit: Some(limit), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// LAVT011: no coil hangs between ring and bore.
    fn supported(&self) -> Check {
        let base = self.base("LAVT011", "supported", "Coil is supported up to the ring", "spring_stress_unsupported");
        let alone = self.design.built.spring.unsupported_turns > 0.0;
        let limit = self.design.wire.tensile_pa.map(|pa| PERMISSIBLE * pa);
        let fix = "let the bore reach up to the ring: a coil between them carries the whole torque of the clutch".to_owned();
        let basis = if alone { "bending stress of a coil that carries the clutch's torque alone" } else { "no turn is unsupported" };
        let value = if alone { base.value } else { Some(0.0) };
        let missing = "give `material.spring.use` or `tensile_strength`, and `requirements.input_torque`".to_owned();
        Comparison {
            required: alone,
            value,
            limit: limit.or((!alone).then_some(0.0)),
            sense: Sense::AtMost,
            scale: Some(1.0),
            fix,
            missing,
            basis: basis.to_owned(),
            ..base
        }
        .judge()
    }

    /// LAVT018: mode I comes back by itself.
    fn returns(&self) -> Option<Check> {
        self.behaviour.statics.grip_nm?;
        let base = self.base("LAVT018", "returns", "Shifts back when the load is gone", "downshift_torque_output");
        let statics = &self.behaviour.statics;
        let fix = format!(
            "`τ_b` of at most {}: a smaller hub or a wider bore; else it stays slow until the torque at the input is taken away",
            self.torque(statics.transition_nm / (1.0 - statics.ratio))
        );
        let basis = "τ_t/(1 − R) − τ_b, less losses: below it the bore lets go";
        let scale = Some(statics.transition_output_nm());
        Some(Comparison { required: false, limit: Some(0.0), scale, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// LAVT019: both meshes have play.
    fn backlash(&self) -> Check {
        let base = self.base("LAVT019", "backlash", "Teeth go in", "backlash_min");
        let basis = "backlash of both meshes at the distance of sun and planets without play; a thousandth of a module is rounding";
        let module_m = self.design.built.gears.module_m;
        let fix = "`x_ring = x_sun + 2 x_planet` is near it for ring = sun + 2 planet; or `design.gears.backlash`".to_owned();
        Comparison { limit: Some(-1e-3 * module_m), scale: Some(module_m), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// LAVT012: planets keep clear of each other.
    fn planets(&self) -> Check {
        let base = self.base("LAVT012", "planet_gap", "Planets keep clear of each other", "planet_gap");
        let limit = LEAST_GAP * self.design.built.gears.module_m;
        let fix = "fewer planets, or smaller ones".to_owned();
        let basis = "between the tip circles of neighbours; half a module is kept";
        Comparison { limit: Some(limit), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// What shifts would mend it; only sought where something is wrong.
    fn shifted(&self, margin: Option<f64>) -> String {
        if margin.is_some_and(|m| m >= 0.0) { String::new() } else { Train::advice(&self.design.built.gears) }
    }

    /// LAVT013: no undercut.
    fn undercut(&self) -> Check {
        let base = self.base("LAVT013", "undercut", "Teeth are not undercut", "undercut_margin");
        let basis = "profile shift less h − (z/2) sin² α, the least that avoids undercut by the rack";
        Comparison { required: false, limit: Some(0.0), scale: Some(1.0), fix: self.shifted(base.value), basis: basis.to_owned(), ..base }
            .judge()
    }

    /// LAVT014: no interference.
    fn interference(&self) -> Check {
        let base = self.base("LAVT014", "interference", "Teeth do not interfere", "interference_margin");
        let basis = format!(
            "least of tips against roots, fillets, flanks and each other, and of what is left of a tip: {}",
            self.behaviour.train.tightest()
        );
        let scale = Some(self.design.built.gears.module_m);
        Comparison { limit: Some(0.0), scale, fix: self.shifted(base.value), basis, ..base }.judge()
    }

    /// LAVT015: contact ratio.
    fn contact(&self, with: &str) -> Check {
        let metric = if with == "sun" { "contact_ratio_sun" } else { "contact_ratio_ring" };
        let base = self.base("LAVT015", metric, &format!("Contact ratio of planet and {with}"), metric);
        let basis = "length of contact between tips, roots and interference points over the base pitch; 1.1 is kept";
        let fix = "more teeth, or less profile shift".to_owned();
        Comparison { required: false, limit: Some(LEAST_CONTACT_RATIO), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// LAVT016, LAVT017: teeth carry the torque.
    fn teeth(&self) -> Vec<Check> {
        let Some(material) = &self.design.gear_material else { return Vec::new() };
        let one = |code, name: &str, title: &str, limit: Option<f64>, key: &str, basis: &str, power: f64| {
            let base = self.base(code, name, title, name);
            let fix = match (base.value, limit) {
                (Some(value), Some(limit)) => {
                    format!("teeth {} times as wide, a larger module, or more planets", format_number(maths::powf(value / limit, power), 3))
                }
                _ => String::new(),
            };
            let missing = if limit.is_none() { format!("give `material.gears.{key}`") } else { base.missing.clone() };
            Comparison { required: false, limit, sense: Sense::AtMost, fix, missing, basis: basis.to_owned(), ..base }.judge()
        };
        vec![
            one(
                "LAVT016",
                "tooth_bending_stress",
                "Bending of the teeth",
                material.bending_pa,
                "bending_strength",
                "Lewis: the whole load at the tip of one tooth, without dynamics",
                1.0,
            ),
            one(
                "LAVT017",
                "flank_pressure",
                "Pressure between flanks",
                material.flank_pa,
                "flank_strength",
                "Hertz, at the pitch point",
                2.0,
            ),
        ]
    }

    /// LAVT022: the hand grasps with the force that is wanted.
    fn grasp(&self) -> Option<Check> {
        self.behaviour.grasp.as_ref()?;
        let limit = wanted_force_n(self.design)?;
        let base = self.base("LAVT022", "grasp", "Force of the grasp", "grasp_force");
        let fix = "the motor stalls or the clutch slips below it: a larger `motor.reduction`, voltage or limit of the current".to_owned();
        let basis = "force on the object in the end of the closing, against `hand.force`";
        Some(Comparison { limit: Some(limit), fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// LAVT021: the motor endures its speed.
    fn motor(&self) -> Option<Check> {
        let motor = self.design.motor.as_ref()?;
        let most = motor.max_rad_per_s?;
        let base = self.base("LAVT021", "motor_speed", "Speed of the motor", "motor_speed_max");
        let fix = base.value.map_or_else(String::new, |value| {
            let part = format_number(0.99 * most / value, 3);
            format!(
                "about {part} of the voltage; another reduction hardly helps, as a motor almost without load turns as its voltage has it"
            )
        });
        let basis = "largest speed of the motor as the hand closes, against `motor.max_speed`";
        Some(Comparison { limit: Some(most), sense: Sense::AtMost, fix, basis: basis.to_owned(), ..base }.judge())
    }
}
