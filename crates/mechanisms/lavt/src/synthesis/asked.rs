//! What a file asks for: requirements, grids, friction and tolerances as numbers.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::fits::Fit;
use forcewright_base::units::{Dimension, Quantity, Tolerance};
use forcewright_contract::describe::{Origin, Slot};
use forcewright_contract::metrics::Limit;
use forcewright_elements::springs::wire;
use forcewright_elements::wrap_spring::wire_tolerance_m;

use super::section::{Counts, Lengths, Numbers, Synthesise};
use crate::design::{Built, Design, Scatter, Spring, place_of, si};
use crate::spec::Spec;

/// ± of the inner diameter of the spring where nothing is said, m.
const SPRING_HALF_M: f64 = 0.05e-3;
/// Wires of the default grid, from and to, m.
const WIRES_M: [f64; 2] = [0.6e-3, 1.4e-3];
/// δa − δb of the default grid, m.
const DIFFERENCES_M: [f64; 6] = [0.0, 0.02e-3, 0.05e-3, 0.1e-3, 0.15e-3, 0.2e-3];
/// From, to, step of the default grids: mean radius, gap (m), turns.
const RADII_M: [f64; 3] = [6e-3, 12e-3, 0.1e-3];
const GAPS_M: [f64; 3] = [0.2e-3, 1e-3, 0.05e-3];
const TURNS: [f64; 3] = [1.0, 6.0, 0.5];
const SUNS: [u32; 2] = [10, 24];
const PLANETS: [u32; 2] = [10, 60];
const NUMBERS: [u32; 2] = [3, 4];
const MODULE_M: f64 = 0.5e-3;
/// Most values on an axis of the grid.
const MOST: usize = 2000;
/// Most springs of a grid.
const MOST_SPRINGS: f64 = 1e9;
/// Least spring index that can be wound, as of a design (E0805).
const LEAST_INDEX: f64 = 4.0;

/// A wire that there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wire {
    pub diameter_m: f64,
    /// Half width of its tolerance, m.
    pub half_m: f64,
    /// Least tensile strength, Pa.
    pub tensile_pa: Option<f64>,
}

/// A tolerance as it is typed, and what it means.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Made {
    /// What stands behind the diameter in a file; empty for none.
    pub text: String,
    tolerance: Option<Tolerance>,
}

impl Made {
    fn deviations_m(&self, diameter_m: f64) -> Option<[f64; 2]> {
        self.tolerance.map_or(Some([0.0; 2]), |t| t.deviations_si(diameter_m))
    }
}

/// What is asked for.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub input_nm: f64,
    /// At the output, from and to; 0 and infinite where nothing is asked.
    pub transition_nm: [f64; 2],
    pub output_nm: f64,
    pub speed_drop: f64,
    pub efficiency: f64,
    /// At least 1.
    pub safety: f64,
    pub stress_pa: f64,
    pub limits: Vec<Limit>,
    /// Outer diameter and length; infinite where none is asked for.
    pub envelope_m: [f64; 2],
    pub suns: [u32; 2],
    pub planets: [u32; 2],
    pub numbers: [u32; 2],
    pub modules_m: Vec<f64>,
    pub face_ratio: f64,
    pub backlash_m: f64,
    pub flank_friction: Option<f64>,
    pub wires: Vec<Wire>,
    pub radii_m: Vec<f64>,
    pub gaps_m: Vec<f64>,
    pub differences_m: Vec<f64>,
    pub hub_turns: Vec<f64>,
    pub bore_turns: Vec<f64>,
    pub free_turns: f64,
    /// Friction on hub and in the bore, and the half widths of its ranges.
    pub friction: [f64; 2],
    pub friction_half: [f64; 2],
    /// Of the inner diameter of the spring, ± m.
    pub spring_half_m: f64,
    pub hub_made: Made,
    pub bore_made: Made,
    /// Losses, motor, hand, and what `[parts]` says stand in it.
    pub template: Design,
}

/// Without the noise of decimal steps: the number next to it with twelve digits.
pub(super) fn clean(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

impl Asked {
    /// Least, usual, largest friction on hub and in the bore.
    pub(super) fn frictions(&self) -> [[f64; 2]; 3] {
        let [hub, bore] = self.friction;
        let [h, b] = self.friction_half;
        [[(hub - h).max(0.0), (bore - b).max(0.0)], [hub, bore], [hub + h, bore + b]]
    }

    /// Gear sets and springs in the grid.
    pub(super) fn raw(&self) -> [f64; 2] {
        let span = |[from, to]: [u32; 2]| f64::from(to) + 1.0 - f64::from(from);
        let gears = span(self.suns) * span(self.planets) * span(self.numbers) * self.modules_m.len() as f64;
        let lists = [&self.radii_m, &self.gaps_m, &self.differences_m, &self.hub_turns, &self.bore_turns];
        [gears, lists.iter().map(|l| l.len() as f64).product::<f64>() * self.wires.len() as f64]
    }

    /// Spring, hub and bore of a place in the grid: wire, radius, gap, difference, turns on the hub, in the bore. The diameters are
    /// those that a file has.
    pub(super) fn spring(&self, place: [usize; 6]) -> Built {
        let [wire, radius, gap, difference, hub, bore] = place;
        let wire_m = self.wires[wire].diameter_m;
        let inner_m = clean(2.0 * self.radii_m[radius] - wire_m);
        let built = &self.template.built;
        let spring = Spring {
            wire_m,
            inner_m,
            hub_turns: self.hub_turns[hub],
            free_turns: self.free_turns + self.bore_turns[bore],
            bore_turns: self.bore_turns[bore],
            unsupported_turns: 0.0,
            ..built.spring
        };
        Built {
            spring,
            hub_m: clean(inner_m + 2.0 * (self.gaps_m[gap] + self.differences_m[difference])),
            bore_m: clean(inner_m + 2.0 * (wire_m + self.gaps_m[gap])),
            friction: self.friction,
            ..*built
        }
    }

    /// Deviations of its wire, inner diameter, hub and bore; `None` where a fit has none of this diameter.
    pub(super) fn scatter(&self, built: &Built, wire: usize) -> Option<Scatter> {
        let both = |half: f64| [-half, half];
        Some(Scatter {
            wire_m: both(self.wires[wire].half_m),
            inner_m: both(self.spring_half_m),
            hub_m: self.hub_made.deviations_m(built.hub_m)?,
            bore_m: self.bore_made.deviations_m(built.bore_m)?,
            hub_friction: both(self.friction_half[0]),
            bore_friction: both(self.friction_half[1]),
        })
    }
}

/// Whether a coil can be wound.
pub(super) fn can_be_wound(built: &Built) -> bool {
    1.0 + built.spring.inner_m / built.spring.wire_m >= LEAST_INDEX
}

/// What a file asks for. What is wrong with it goes into `diagnostics`.
pub(super) fn asked(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Asked> {
    let section = &spec.synthesise;
    let required = design.requirements.as_ref()?;
    let lengths = |of: &Lengths, default, span| steps([&of.min, &of.max, &of.step], default, span);
    let numbers = |of: &Numbers, default, span| steps([&of.min, &of.max, &of.step], default, span);
    let friction = section.friction.as_ref()?;
    let bore_friction = section.bore_friction.as_ref().unwrap_or(friction);
    let half = |q: &Quantity| q.deviations_si().map_or(0.0, |[_, upper]| upper);
    let made = |slot: &Slot<String>, diagnostics: &mut Diagnostics| made_of(slot, place_of(section), diagnostics);
    let [least, most] = required.transition_nm;
    let mut list = |found: Result<Vec<f64>, Box<Diagnostic>>| {
        found.unwrap_or_else(|error| {
            diagnostics.push(*error);
            Vec::new()
        })
    };
    let radii_m = list(lengths(&section.mean_radius, RADII_M, place_of(&section.mean_radius)));
    let gaps_m = list(lengths(&section.bore_gap, GAPS_M, place_of(&section.bore_gap)));
    let hub_turns = list(numbers(&section.hub_turns, TURNS, place_of(&section.hub_turns)));
    let bore_turns = list(numbers(&section.bore_turns, TURNS, place_of(&section.bore_turns)));
    let mut count = |of: &Counts, default, span| counts(of, default, span, diagnostics);
    let suns = count(&section.sun, SUNS, place_of(&section.sun));
    let planets = count(&section.planet, PLANETS, place_of(&section.planet));
    let numbers = count(&section.planets, NUMBERS, place_of(&section.planets));
    let found = Asked {
        input_nm: required.input_nm,
        transition_nm: [least.unwrap_or(0.0), most.unwrap_or(f64::INFINITY)],
        output_nm: required.output_nm.unwrap_or(0.0),
        speed_drop: required.speed_drop.unwrap_or(f64::INFINITY),
        efficiency: required.efficiency.unwrap_or(0.0),
        safety: required.safety_factor.unwrap_or(1.0).max(1.0),
        stress_pa: si(&section.stress_max).unwrap_or(f64::INFINITY),
        limits: required.limits.clone(),
        envelope_m: [&section.envelope.diameter, &section.envelope.length].map(|side| si(side).unwrap_or(f64::INFINITY)),
        suns,
        planets,
        numbers,
        modules_m: values(&section.modules).unwrap_or_else(|| vec![MODULE_M]),
        face_ratio: si(&section.face_ratio).unwrap_or(8.0),
        backlash_m: si(&section.backlash).unwrap_or(0.0),
        flank_friction: si(&section.flank_friction),
        wires: wires(spec, design, section, diagnostics),
        radii_m,
        gaps_m,
        differences_m: values(&section.gap_differences).unwrap_or_else(|| DIFFERENCES_M.to_vec()),
        hub_turns,
        bore_turns,
        free_turns: si(&section.free_turns).unwrap_or(6.0),
        friction: [friction.value.si, bore_friction.value.si],
        friction_half: [half(&friction.value), half(&bore_friction.value)],
        spring_half_m: si(&section.tolerances.spring).unwrap_or(SPRING_HALF_M),
        hub_made: made(&section.tolerances.hub, diagnostics)?,
        bore_made: made(&section.tolerances.bore, diagnostics)?,
        template: design.clone(),
    };
    let [_, springs] = found.raw();
    if springs > MOST_SPRINGS {
        let error = Diagnostic::error("E0841", place_of(section), "the grid has too many springs").label("in this section");
        diagnostics.push(
            error.help(format!("longer steps: at most {} millions; a million takes about a quarter of a second", 1e-6 * MOST_SPRINGS)),
        );
    }
    Some(found)
}

/// A list, sorted, each value once.
#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
fn values(slot: &Slot<Vec<Quantity>>) -> Option<Vec<f64>> {
    let mut all: Vec<f64> = slot.as_ref()?.value.iter().map(|q| q.si).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    Some(all)
}

/// E0841: the values of an axis.
fn steps(typed: [&Slot<Quantity>; 3], default: [f64; 3], at: Span) -> Result<Vec<f64>, Box<Diagnostic>> {
    let [from, to, step] = [0, 1, 2].map(|i| si(typed[i]).unwrap_or(default[i]));
    let empty = |message: &str| Diagnostic::error("E0841", at, message.to_owned()).label("this range");
    if from > to {
        return Err(Box::new(empty("a range of the grid ends before it begins").help("`min` must not be above `max`")));
    }
    // A step that rounding has made a hair too long still reaches the end.
    let all: Vec<f64> = (0..=MOST).map(|i| clean(from + i as f64 * step)).take_while(|x| *x <= to + 1e-9 * step).collect();
    if all.len() > MOST {
        return Err(Box::new(empty("a range of the grid has too many values").help(format!("a longer `step`: at most {MOST} values"))));
    }
    Ok(all)
}

/// E0841: whole numbers from and to.
fn counts(typed: &Counts, default: [u32; 2], at: Span, diagnostics: &mut Diagnostics) -> [u32; 2] {
    let [from, to] = [&typed.min, &typed.max].map(|slot| slot.as_ref().map(|l| l.value));
    let found = [from.unwrap_or(default[0]), to.unwrap_or(default[1])];
    if found[0] > found[1] {
        let error = Diagnostic::error("E0841", at, "a range of the grid ends before it begins").label("this range");
        diagnostics.push(error.help("`min` must not be above `max`"));
    }
    found
}

/// E0842: a tolerance of hub or bore.
#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
fn made_of(slot: &Slot<String>, place: Span, diagnostics: &mut Diagnostics) -> Option<Made> {
    let Some(typed) = slot else { return Some(Made { text: String::new(), tolerance: None }) };
    let text = typed.value.trim();
    let span = if typed.origin == Origin::File { typed.span } else { place };
    let half = || Quantity::parse(text.trim_start_matches('±'), Dimension::Length).ok().filter(|q| q.tolerance.is_none() && q.si >= 0.0);
    if let Ok(fit) = Fit::parse(text) {
        return Some(Made { text: format!(" {text}"), tolerance: Some(Tolerance::Fit(fit)) });
    }
    let Some(half) = half() else {
        let error = Diagnostic::error("E0842", span, format!("`{text}` is no tolerance of a diameter")).label("this tolerance");
        diagnostics.push(error.help("write an ISO fit, \"h7\", or a half width, \"0.01 mm\""));
        return None;
    };
    if half.si > 0.0 {
        return Some(Made {
            text: format!(" ± {}", text.trim_start_matches('±').trim()), tolerance: Some(Tolerance::Symmetric(half.si))
        });
    }
    Some(Made { text: String::new(), tolerance: None })
}

/// E0843: the wires, with the strength of each.
fn wires(spec: &Spec, design: &Design, section: &Synthesise, diagnostics: &mut Diagnostics) -> Vec<Wire> {
    let [from, to] = WIRES_M;
    let stocked = || wire().diameters_m.iter().copied().filter(|d| (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(d)).collect();
    let diameters_m: Vec<f64> = values(&section.wire_diameters).unwrap_or_else(stocked);
    let typed = spec.material.spring.tensile_strength.as_ref().filter(|l| l.origin == Origin::File).map(|l| l.value.si);
    let mut all = Vec::new();
    for diameter_m in diameters_m {
        let tensile_pa = typed.or_else(|| design.wire.grade?.tensile_strength_pa(diameter_m));
        if tensile_pa.is_none() && (design.wire.grade.is_some() || design.requirements.as_ref().is_some_and(|r| r.safety_factor.is_some()))
        {
            let at = section.wire_diameters.as_ref().map_or_else(|| place_of(section_of(spec)), |l| l.span);
            let error = Diagnostic::error("E0843", at, "the strength of a wire of the grid is not known").label("of these wires");
            let help = "EN 10270-1 has 0.3 mm to 20 mm; leave others out, or give `material.spring.tensile_strength`";
            diagnostics.push(error.help(help));
            return Vec::new();
        }
        let half_m = si(&section.tolerances.wire).unwrap_or_else(|| wire_tolerance_m(diameter_m).unwrap_or(0.0));
        all.push(Wire { diameter_m, half_m, tensile_pa });
    }
    all
}

fn section_of(spec: &Spec) -> &forcewright_contract::describe::Section<Synthesise> {
    &spec.synthesise
}
