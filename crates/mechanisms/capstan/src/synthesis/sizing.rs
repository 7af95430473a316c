//! The search: every combination of what there is, with whole parts of the grid left out that cannot hold what is looked for.
//!
//! Why each of them loses nothing stands in `docs/theory/capstan-synthesis.md`; a test compares with the whole grid.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_contract::metrics::Limit;
use forcewright_contract::synthesis::Watch;
use forcewright_elements::cables::{Construction, strength_left};
use forcewright_elements::wrap::{Drive, DriveSpec, Drum, History, Hold, State};

use crate::analysis::{Behaviour, measure};
use crate::checks::LARGEST_FLEET_RAD;
use crate::design::cables::wire_modulus_pa;
use crate::design::{Bearings, Built, Cable, Design, Seat};
use crate::geometry::{self, Belt, Layout};
use crate::losses::shaft_load_n;
use crate::whole::{few, small};

/// A cable that there is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rope {
    pub construction: &'static Construction,
    pub diameter_m: f64,
    pub axial_n: f64,
    pub breaking_n: f64,
    pub least_ratio: f64,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub torque_nm: f64,
    pub stiffness_nm_per_rad: f64,
    pub lost_motion_rad: f64,
    /// At least 1: beyond it the cable breaks.
    pub safety: f64,
    pub limits: Vec<Limit>,
    pub ratio: f64,
    pub travel_rad: f64,
    /// Diameter of the output drum, width along the axes, length over both drums; infinite where none is asked for.
    pub envelope_m: [f64; 3],
    pub pitch_ratio: f64,
    pub preload_loss: f64,
    pub bending_loss: Option<f64>,
    pub most_turns: u32,
    pub most_cables: u32,
    pub ropes: Vec<Rope>,
    /// Radii of the input drum to the middle of the cable, ascending.
    pub inputs_m: Vec<f64>,
    /// Preloads, ascending.
    pub preloads_n: Vec<f64>,
    /// Friction, groove, belt, anchor wrap, bearings stand in it.
    pub template: Design,
}

/// A drive without its preload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub rope: usize,
    pub cables: u32,
    pub turns: u32,
    /// Lines between the ends of a cable.
    pub apart: i32,
    /// r₁ and d to the middle of the cable.
    pub input_m: f64,
    pub distance_m: f64,
}

/// A drive that keeps to all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    pub frame: Frame,
    /// Lines between the first ends of neighbouring cables.
    pub between: i32,
    pub preload_n: f64,
    pub width_m: f64,
    pub cost_m3: f64,
}

/// What was found, and what it took.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Found {
    /// The smallest of each kind, the smallest first.
    pub sizes: Vec<Size>,
    /// Combinations in the grid.
    pub candidates: f64,
    /// States of a loaded drive computed.
    pub states: u64,
    /// Arrangements of cables placed in space.
    pub placed: u64,
    /// Whether so many of them were placed, or analysed for further limits, that the rest was given up.
    pub cut: bool,
    /// Whether it was interrupted.
    pub interrupted: bool,
}

/// Arrangements that are placed in one search at most.
const MOST_PLACED: u64 = 20_000;
/// Full analyses for limits on metrics in one search at most.
const MOST_MEASURED: u64 = 1_500;
/// Centre distances tried for each number of turns.
const MOST_DISTANCES: usize = 12;
/// A limit is kept by so much, so that rounding of the numbers that are written does not matter.
const INSIDE: f64 = 1e-6;
/// Numbers are written in nine digits.
const WRITTEN: f64 = 1e-8;
/// Bounds are slackened by this part for rounding.
const ROUNDING: f64 = 1e-9;

impl Asked {
    fn rope(&self, frame: &Frame) -> &Rope {
        &self.ropes[frame.rope]
    }

    /// Whole number of starts next to the ratio.
    pub(super) fn starts(&self) -> u32 {
        few(self.ratio.clamp(1.0, 64.0))
    }

    pub(super) fn built(&self, frame: &Frame, between: i32, preload_n: f64) -> Built {
        let rope = self.rope(frame);
        let cable = |i: u32| {
            let first = i32::try_from(i).unwrap_or(0) * between;
            Cable {
                construction: Some(rope.construction),
                diameter_m: rope.diameter_m,
                axial_stiffness_n: rope.axial_n,
                breaking_n: Some(rope.breaking_n),
                mass_kg_per_m: None,
                least_ratio: Some(rope.least_ratio),
                wire_m: rope.construction.wire_m(rope.diameter_m),
                wire_pa: wire_modulus_pa(rope.construction),
                expansion_per_k: None,
                bending_loss: self.bending_loss,
                lines: [first, first + frame.apart],
                preload_n,
                preload_loss: self.preload_loss,
                sources: Vec::new(),
            }
        };
        Built {
            radii_m: [frame.input_m, self.ratio * frame.input_m],
            distance_m: frame.distance_m,
            extra_turns: frame.turns,
            travel_rad: self.travel_rad,
            pitch_m: self.pitch_ratio * rope.diameter_m,
            starts: self.starts(),
            cables: (0..frame.cables).map(cable).collect(),
            ..self.template.built.clone()
        }
    }

    pub(super) fn design(&self, size: &Size) -> Design {
        let built = self.built(&size.frame, size.between, size.preload_n);
        let mut making = self.template.making;
        making.margin_m = built.pitch_m;
        Design { built, making, ..self.template.clone() }
    }
}

/// A frame with the numbers that its states and bounds need, of one of its equal cables.
pub(super) struct Prepared {
    spec: DriveSpec,
    force_n: f64,
    lever_m: f64,
    cables: f64,
    /// Largest tension that the safety factor allows.
    most_n: f64,
    input_friction: f64,
    input_wrap_rad: f64,
}

impl Prepared {
    pub(super) fn new(asked: &Asked, frame: &Frame) -> Option<Self> {
        let rope = asked.rope(frame);
        let built = &asked.template.built;
        let (r1, r2) = (frame.input_m, asked.ratio * frame.input_m);
        let sum = r1 + built.belt.sign() * r2;
        let span_m = ((frame.distance_m - sum) * (frame.distance_m + sum)).sqrt();
        let tangent_rad = maths::atan2(span_m, sum);
        let helix_rad = maths::atan2(asked.pitch_ratio * rope.diameter_m, TAU * r1);
        let cos = if built.helix_correction { maths::cos(helix_rad) } else { 1.0 };
        let friction = built.friction * built.groove_factor * cos;
        let drum = |radius_m: f64| Drum { radius_m: radius_m / cos, friction };
        let input_wrap_rad = TAU * (f64::from(frame.turns) + 1.0) - 2.0 * tangent_rad;
        let ratio = 2.0 * r1.min(r2) / rope.diameter_m;
        let kept = if rope.construction.wires.is_some() { strength_left(ratio)? } else { 1.0 };
        let lever_m = r2 * cos;
        Some(Self {
            spec: DriveSpec {
                input: drum(r1),
                output: drum(r2),
                hold: Hold::Friction { wrap_rad: input_wrap_rad },
                output_wraps_rad: [built.guard_rad + 0.5 * asked.travel_rad; 2],
                spans_m: [span_m / cos; 2],
                axial_stiffness_n: rope.axial_n,
                preload_n: 1.0,
            },
            force_n: asked.torque_nm / (lever_m * f64::from(frame.cables)),
            lever_m,
            cables: f64::from(frame.cables),
            most_n: rope.breaking_n * kept / (asked.safety * (1.0 + INSIDE)),
            input_friction: friction,
            input_wrap_rad,
        })
    }

    /// Stiffness of the spans, which no preload exceeds.
    pub(super) fn stiffness_bound(&self) -> f64 {
        let [one, other] = self.spec.spans_m;
        self.torsional(self.spec.axial_stiffness_n * (1.0 / one + 1.0 / other))
    }

    /// No tension is below this where friction holds the force: `T₀ − T₁ = F` and `T₀ ≤ T₁ exp(μΘ)`.
    fn tension_bound_n(&self) -> f64 {
        self.force_n / (1.0 - maths::exp(-self.input_friction * self.input_wrap_rad))
    }

    fn torsional(&self, n_per_m: f64) -> f64 {
        self.cables * n_per_m * self.lever_m * self.lever_m
    }

    /// One cable with a preload at assembly.
    pub(super) fn state(&self, asked: &Asked, preload_n: f64) -> Option<(Drive, State)> {
        let drive = Drive::new(&DriveSpec { preload_n: preload_n * (1.0 - asked.preload_loss), ..self.spec }).ok()?;
        let state = drive.at_force(self.force_n).ok()?;
        Some((drive, state))
    }

    pub(super) fn stiffness(&self, state: &State) -> f64 {
        self.torsional(state.tangent_n_per_m)
    }

    pub(super) fn lost_motion_rad(&self, drive: &Drive) -> Option<f64> {
        Some(History::new(drive).ok()?.cycle(self.force_n).ok()?.lost_motion_m / self.lever_m)
    }

    /// What more preload brings: held, no slip at the terminations, stiff, little lost motion.
    pub(super) fn holds(&self, asked: &Asked, preload_n: f64) -> bool {
        let Some((drive, state)) = self.state(asked, preload_n) else { return false };
        let slip_rad = state.slip_rad.iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
        !state.gross_slip
            && !state.loose
            && slip_rad * (1.0 + INSIDE) <= asked.template.built.guard_rad
            && self.stiffness(&state) >= asked.stiffness_nm_per_rad * (1.0 + INSIDE)
            && (asked.lost_motion_rad.is_infinite()
                || self.lost_motion_rad(&drive).is_some_and(|rad| rad * (1.0 + INSIDE) <= asked.lost_motion_rad))
    }

    /// What it takes: strength.
    pub(super) fn lasts(&self, asked: &Asked, preload_n: f64) -> bool {
        self.state(asked, preload_n).is_some_and(|(_, state)| state.tensions_n[0].max(state.tensions_n[1]) <= self.most_n)
    }
}

/// Where a cable is in line: lines between its ends and d/r₁, for each number of turns.
pub(super) fn distances(asked: &Asked, turns: u32) -> Vec<(i32, f64)> {
    let built = &asked.template.built;
    let layout = Layout {
        input_radius_m: 1.0,
        output_radius_m: asked.ratio,
        centre_distance_m: 2.0 * (1.0 + asked.ratio),
        pitch_m: 0.1,
        starts: asked.starts(),
        extra_turns: turns,
        surface: geometry::Surface::Flat,
        cables: vec![[0, 1]],
        ..built.layout()
    };
    let most = 1.0 + asked.ratio + PI * (MOST_DISTANCES as f64 + 1.0) * (1.0 + asked.ratio);
    let all = geometry::Drive::new(layout).and_then(|drive| drive.aligned_distances(0.0, most)).unwrap_or_default();
    let near = |a: &geometry::Aligned| Some((i32::try_from(a.lines_apart).ok().filter(|j| *j > 0)?, a.centre_distance_m));
    all.iter().filter_map(near).take(MOST_DISTANCES).collect()
}

/// The first lines of neighbouring cables are at least so far apart: the wraps of both lie on the one helix of the input.
fn least_between(asked: &Asked, frame: &Frame) -> i32 {
    let per_line = asked.ratio / f64::from(asked.starts());
    let wrapped = f64::from(frame.turns) + 1.0 - tangent_rad(asked, frame) / PI;
    // A first end runs to the nearest turn of the input, up to half a pitch aside.
    let aside = if (per_line - 1.0).abs() > 0.0 { 0.5 } else { 0.0 };
    small(((wrapped - aside) / per_line - ROUNDING).ceil()).max(1)
}

fn tangent_rad(asked: &Asked, frame: &Frame) -> f64 {
    let sum = frame.input_m * (1.0 + asked.template.built.belt.sign() * asked.ratio);
    maths::atan2(((frame.distance_m - sum) * (frame.distance_m + sum)).max(0.0).sqrt(), sum)
}

/// Length over both drums and diameter of the output with their cables, m.
pub(super) fn length_and_diameter(asked: &Asked, frame: &Frame) -> [f64; 2] {
    let cable_m = asked.rope(frame).diameter_m;
    [frame.distance_m + (1.0 + asked.ratio) * frame.input_m + cable_m, 2.0 * asked.ratio * frame.input_m + cable_m]
}

/// The drums are at least so long, m: on the input walk and wraps, on the output all that a cable climbs from one end to the other; the
/// other cables beside it, and a pitch on either side.
fn width_bound_m(asked: &Asked, frame: &Frame) -> f64 {
    let pitch_m = asked.pitch_ratio * asked.rope(frame).diameter_m;
    let gamma = tangent_rad(asked, frame);
    let wrapped = f64::from(frame.turns) + 1.0 - gamma / PI;
    let per_line = asked.ratio / f64::from(asked.starts());
    // Ends lie on groove lines, not where the cable would land.
    let aside = if (per_line - 1.0).abs() > 0.0 { 1.0 } else { 0.0 };
    let others = ((f64::from(frame.cables) - 1.0) * f64::from(least_between(asked, frame)) * per_line - aside).max(0.0);
    let span = frame.distance_m * maths::sin_cos(gamma).0 / (PI * frame.input_m);
    let input = asked.ratio * asked.travel_rad / TAU;
    let output = asked.ratio * (2.0 * asked.template.built.guard_rad + asked.travel_rad) / TAU + span - aside;
    pitch_m * (wrapped + others + input.max(output) + 2.0) * (1.0 - ROUNDING)
}

pub(super) fn cost_m3(asked: &Asked, frame: &Frame, width_m: f64) -> f64 {
    let [length_m, diameter_m] = length_and_diameter(asked, frame);
    length_m * diameter_m * width_m
}

/// Lines between neighbours and width of the nearest arrangement in which nothing touches and all is in line, no wider than this (m).
pub(super) fn placed(asked: &Asked, frame: &Frame, widest_m: f64) -> Option<(i32, f64)> {
    let least = least_between(asked, frame);
    (least..=last_between(asked, frame))
        .take_while(|between| {
            // Each line more makes the drums longer.
            let more = f64::from(between - least) * f64::from(frame.cables - 1) * asked.ratio / f64::from(asked.starts());
            width_bound_m(asked, frame) + more * asked.pitch_ratio * asked.rope(frame).diameter_m * (1.0 - ROUNDING) <= widest_m
        })
        .filter(|between| !share_a_groove(asked, frame, *between))
        .find_map(|between| Some((between, arranged(asked, frame, between)?)))
        .filter(|(_, width_m)| *width_m <= widest_m)
}

/// One cable has no neighbour; of several each number of lines is tried until they repeat modulo the starts.
pub(super) fn last_between(asked: &Asked, frame: &Frame) -> i32 {
    let least = least_between(asked, frame);
    if frame.cables == 1 { least } else { least + i32::try_from(asked.starts()).unwrap_or(64) }
}

/// Whether first ends of two cables lie in one groove, whole turns apart, and one is wound up to the other.
fn share_a_groove(asked: &Asked, frame: &Frame, between: i32) -> bool {
    let starts = i32::try_from(asked.starts()).unwrap_or(64);
    let wrap_rad = (asked.template.built.guard_rad + asked.travel_rad) * (1.0 - ROUNDING);
    (1..i32::try_from(frame.cables).unwrap_or(1)).any(|j| (j * between) % starts == 0 && TAU * f64::from(j * between / starts) < wrap_rad)
}

/// The cables in space: the width, if nothing touches and all is in line.
pub(super) fn arranged(asked: &Asked, frame: &Frame, between: i32) -> Option<f64> {
    let built = asked.built(frame, between, 1.0);
    let drive = built.geometry().ok()?;
    let margin_m = [built.pitch_m; 2];
    let lengths = [geometry::Drum::Input, geometry::Drum::Output].map(|drum| drive.drum_length_m(drum, margin_m).unwrap_or(f64::INFINITY));
    let in_line = (0..built.cables.len()).all(|i| drive.fleet(i).is_ok_and(|f| f.largest_rad() <= LARGEST_FLEET_RAD));
    let land_m = || drive.groove_distance_m().unwrap_or(f64::INFINITY).min(built.pitch_m);
    let sound = drive.drum_gap_m() >= 0.0
        && in_line
        && land_m() >= built.seat.width_for_m(built.cable_m())
        && drive.nearest().is_none_or(|near| near.clearance_m >= 0.0);
    sound.then_some(lengths[0].max(lengths[1]))
}

/// Drum, room and gap: what needs no state.
pub(super) fn has_room(asked: &Asked, frame: &Frame) -> bool {
    let rope = asked.rope(frame);
    let [length_m, diameter_m] = length_and_diameter(asked, frame);
    2.0 * frame.input_m * (1.0 + ROUNDING) >= rope.least_ratio * rope.diameter_m
        // The files written have them as limits, in nine digits.
        && diameter_m * (1.0 + WRITTEN) <= asked.envelope_m[0]
        && length_m * (1.0 + WRITTEN) <= asked.envelope_m[2]
        && frame.distance_m - (1.0 + asked.ratio) * frame.input_m >= rope.diameter_m
}

/// Whether limits on metrics are kept.
pub(super) fn keeps_limits(asked: &Asked, size: &Size) -> bool {
    if asked.limits.is_empty() {
        return true;
    }
    let design = asked.design(size);
    let Ok(behaviour) = Behaviour::of(&design) else { return false };
    let measured = measure(&design, &behaviour);
    asked.limits.iter().all(|limit| {
        measured.value(limit.metric).is_some_and(|x| limit.min.is_none_or(|min| x >= min) && limit.max.is_none_or(|max| x <= max))
    })
}

struct Search<'a> {
    asked: &'a Asked,
    found: Found,
    measured: u64,
    /// Designs wanted.
    most: usize,
    watch: Watch<'a>,
    /// Of the kinds, those looked through, and the part of the present one.
    part: [f64; 2],
    kinds: f64,
}

/// The smallest of each kind (cable and number of cables), as many as wanted, the smallest first.
pub(super) fn search(asked: &Asked, most: usize, watch: Watch<'_>) -> Found {
    let all: Vec<Vec<(i32, f64)>> = (0..=asked.most_turns).map(|turns| distances(asked, turns)).collect();
    let places: usize = all.iter().map(Vec::len).sum();
    let kinds = asked.ropes.len() as f64 * f64::from(asked.most_cables);
    let mut search = Search { asked, found: Found::default(), measured: 0, most, watch, part: [0.0; 2], kinds };
    search.found.candidates = kinds * places as f64 * asked.inputs_m.len() as f64 * asked.preloads_n.len() as f64;
    for rope in 0..asked.ropes.len() {
        for cables in 1..=asked.most_cables {
            if let Some(size) = search.kind(rope, cables, &all) {
                let sizes = &mut search.found.sizes;
                let at = sizes.partition_point(|s| s.cost_m3 <= size.cost_m3);
                sizes.insert(at, size);
                sizes.truncate(most);
            }
            if search.found.interrupted {
                return search.found;
            }
            search.part[0] += 1.0;
        }
    }
    search.found
}

impl Search<'_> {
    /// Tells where the search stands; whether it goes on.
    fn goes_on(&mut self) -> bool {
        let [kinds, present] = self.part;
        self.found.interrupted = self.found.interrupted || !(self.watch)((kinds + present) / self.kinds.max(1.0));
        !self.found.interrupted
    }

    /// The smallest of a kind, if it is among those wanted.
    fn kind(&mut self, rope: usize, cables: u32, all: &[Vec<(i32, f64)>]) -> Option<Size> {
        let asked = self.asked;
        // A later kind of the same size comes after the earlier one.
        let mut bar = if self.found.sizes.len() < self.most { f64::INFINITY } else { self.found.sizes.last()?.cost_m3 };
        let mut best = None;
        let least_m = 0.5 * asked.ropes[rope].least_ratio * asked.ropes[rope].diameter_m * (1.0 - 2.0 * ROUNDING);
        let from = asked.inputs_m.partition_point(|r| *r < least_m);
        for (turns, places) in (0..).zip(all) {
            self.part[1] = f64::from(turns) / all.len() as f64;
            for (apart, per_radius) in places {
                if !self.goes_on() {
                    return best;
                }
                for input_m in &asked.inputs_m[from..] {
                    let frame = Frame { rope, cables, turns, apart: *apart, input_m: *input_m, distance_m: per_radius * input_m };
                    let [length_m, diameter_m] = length_and_diameter(asked, &frame);
                    let width_m = width_bound_m(asked, &frame);
                    let beyond = diameter_m > asked.envelope_m[0] || length_m > asked.envelope_m[2] || width_m > asked.envelope_m[1];
                    // All of these grow with the drum.
                    if beyond || cost_m3(asked, &frame, width_m) >= bar {
                        break;
                    }
                    if let Some(size) = self.frame(&frame, bar).filter(|s| s.cost_m3 < bar) {
                        bar = size.cost_m3;
                        best = Some(size);
                    }
                }
            }
        }
        best
    }

    /// A frame with its smallest preload, if it may take less room than this.
    fn frame(&mut self, frame: &Frame, bar_m3: f64) -> Option<Size> {
        let asked = self.asked;
        if !has_room(asked, frame) {
            return None;
        }
        let prepared = Prepared::new(asked, frame)?;
        if prepared.stiffness_bound() < asked.stiffness_nm_per_rad || prepared.tension_bound_n() * (1.0 - ROUNDING) > prepared.most_n {
            return None;
        }
        let [first, last] = preload_range(asked, &prepared, !asked.limits.is_empty(), &mut self.found.states)?;
        if self.found.placed >= MOST_PLACED {
            self.found.cut = true;
            return None;
        }
        if !self.goes_on() {
            return None;
        }
        self.found.placed += 1;
        let widest_m = asked.envelope_m[1].min(bar_m3 / cost_m3(asked, frame, 1.0) * (1.0 + ROUNDING));
        let (between, width_m) = placed(asked, frame, widest_m)?;
        let size = |preload_n| Size { frame: *frame, between, preload_n, width_m, cost_m3: cost_m3(asked, frame, width_m) };
        if asked.limits.is_empty() {
            return Some(size(asked.preloads_n[first]));
        }
        for preload_n in &asked.preloads_n[first..=last] {
            if self.measured >= MOST_MEASURED {
                self.found.cut = true;
                return None;
            }
            if !self.goes_on() {
                return None;
            }
            self.measured += 1;
            if keeps_limits(asked, &size(*preload_n)) {
                return Some(size(*preload_n));
            }
        }
        None
    }
}

/// First and last preload that do, by bisection: what holds with a preload holds with a larger one, what lasts with one lasts with a smaller
/// one. The last is looked for where `last` says so, else it is the first. `states` counts.
pub(super) fn preload_range(asked: &Asked, prepared: &Prepared, last: bool, states: &mut u64) -> Option<[usize; 2]> {
    let left = 1.0 - asked.preload_loss;
    // The taut side has more than the preload.
    let end = asked.preloads_n.partition_point(|n| n * left <= prepared.most_n);
    let mut holds = |i: usize| {
        *states += 1;
        prepared.holds(asked, asked.preloads_n[i])
    };
    if end == 0 || !holds(end - 1) {
        return None;
    }
    let first = bisected(0, end - 1, |i| !holds(i));
    let mut lasts = |i: usize| {
        *states += 1;
        prepared.lasts(asked, asked.preloads_n[i])
    };
    if !lasts(first) {
        return None;
    }
    let last = if last { bisected(first + 1, end, &mut lasts) - 1 } else { first };
    Some([first, last])
}

/// The first place from which on `before` is no longer so; `to` if it is so everywhere.
fn bisected(from: usize, to: usize, mut before: impl FnMut(usize) -> bool) -> usize {
    let (mut low, mut high) = (from, to);
    while low < high {
        let middle = usize::midpoint(low, high);
        if before(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// A drive with a bound of its width in its place, which nothing that is placed falls below.
pub(super) fn least_size(asked: &Asked, frame: &Frame, preload_n: f64) -> Size {
    let width_m = width_bound_m(asked, frame);
    Size { frame: *frame, between: least_between(asked, frame), preload_n, width_m, cost_m3: cost_m3(asked, frame, width_m) }
}

/// What is compared between designs: large stiffness, else small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Merits {
    pub stiffness_nm_per_rad: f64,
    pub lost_motion_rad: Option<f64>,
    pub slip_nm: Option<f64>,
    pub safety: Option<f64>,
    pub width_m: f64,
    pub shaft_load_n: f64,
    /// Of solid drums at the output, the input's times the square of the ratio, over their density, m⁵.
    pub inertia_m5: f64,
}

pub(super) fn merits(asked: &Asked, size: &Size) -> Option<Merits> {
    let prepared = Prepared::new(asked, &size.frame)?;
    let (drive, state) = prepared.state(asked, size.preload_n)?;
    let gamma = tangent_rad(asked, &size.frame);
    let (sin, cos) = maths::sin_cos(gamma);
    let of_all = |tensions: [f64; 2]| shaft_load_n(&vec![tensions; size.frame.cables as usize], [sin, cos]);
    let at_rest_n = size.preload_n * (1.0 - asked.preload_loss);
    let fourth = |r: f64| r * r * r * r;
    let (r1, r2) = (size.frame.input_m, asked.ratio * size.frame.input_m);
    let taut_n = state.tensions_n[0].max(state.tensions_n[1]);
    Some(Merits {
        stiffness_nm_per_rad: prepared.stiffness(&state),
        lost_motion_rad: prepared.lost_motion_rad(&drive),
        slip_nm: drive.capacities()[0].map(|c| c.force_n * prepared.cables * prepared.lever_m),
        safety: (taut_n > 0.0).then(|| prepared.most_n * asked.safety * (1.0 + INSIDE) / taut_n),
        width_m: size.width_m,
        shaft_load_n: of_all(state.tensions_n).max(of_all([at_rest_n; 2])),
        inertia_m5: 0.5 * PI * size.width_m * (asked.ratio * asked.ratio * fourth(r1) + fourth(r2)),
    })
}

impl Merits {
    fn pairs(&self, other: &Self) -> impl Iterator<Item = (f64, f64)> {
        let all = |m: &Self| [-m.stiffness_nm_per_rad, m.width_m, m.inertia_m5, m.shaft_load_n];
        all(self).into_iter().zip(all(other))
    }

    /// Whether it is at least as good in everything.
    pub(super) fn covers(&self, other: &Self) -> bool {
        self.pairs(other).all(|(a, b)| a <= b)
    }

    /// Whether it is at least as good in everything and better in something.
    pub(super) fn dominates(&self, other: &Self) -> bool {
        self.covers(other) && self.pairs(other).any(|(a, b)| a < b)
    }
}

/// What the template of a search holds besides the sizes.
pub(super) fn template(design: &Design, (belt, friction, seat, guard_rad): (Belt, f64, Seat, f64), bearings: Bearings) -> Design {
    let mut template = design.clone();
    let built = &mut template.built;
    built.belt = belt;
    built.friction = friction;
    built.groove_factor = seat.friction_factor();
    built.seat = seat;
    built.guard_rad = guard_rad;
    built.bearings = bearings;
    built.phase_rad = 0.0;
    built.fastened = false;
    template
}
