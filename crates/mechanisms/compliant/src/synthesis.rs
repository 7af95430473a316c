//! From requirements to designs: shapes of a catalogue, sized in closed form, corrected by full analyses.

mod catalogue;
mod limits;
mod room;
mod section;
mod sizing;
mod write;

pub(crate) use section::Synthesise;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::maths;
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_contract::synthesis::{Judgement, Proposal, Relaxation, Skeleton, Synthesiser, Watch};
use forcewright_model::{CheckState, Outcome, ParameterRow, StatusKind};

use crate::design::{Design, StressLimit, si};
use crate::metrics::CompliantMetrics;
use crate::spec::Spec;
use limits::Knob;
use room::Room;
use sizing::{Asked, Size, Windows, sizes, sizes_of_more};

/// A cantilever of no particular size, moved as far as the language allows.
pub(crate) const SKELETON: Skeleton = Skeleton {
    roots: &["design", "layout", "load", "optimise", "variants"],
    sections: r#"
[design]
thickness = "1 mm"
depth = "10 mm"
nodes = { a = { at = ["0 mm", "0 mm"], support = "clamped" }, b = { at = ["10 mm", "0 mm"], support = "parallel" } }
beams = [{ name = "beam", between = ["a", "b"], straight = true }]
[load]
node = "b"
direction = [0, 1]
travel = "10 m"
"#,
};

/// Files written where the project does not say.
const CANDIDATES: u32 = 5;
/// Proposals analysed for each file wanted, and the fewest.
const TRIED_PER_FILE: usize = 3;
const FEWEST_TRIED: usize = 8;
/// Largest depth of a plate where the project does not say, m.
const DEPTH_MAX_M: f64 = 0.05;
/// Two designs of a shape are different if their room or depth differ by this part.
const DIFFERENT: f64 = 0.15;
/// A part more costs as much as this part of the room.
const PART_COST: f64 = 0.02;
/// Corrections of a proposal.
const ROUNDS: f64 = 4.0;
/// What a correction aims at beyond the limit, of stroke and stress, and how near to its level a force is left.
const BEYOND: f64 = 1e-3;
const LEVEL: f64 = 1e-3;
/// A correction of the size beyond this is another design.
const LARGEST_STEP: f64 = 1.15;

/// What a file asks for, ready to be proposed for.
struct Synthesis {
    asked: Asked,
    windows: Windows,
    stress: Option<StressLimit>,
    /// Yield stress, Pa, if known.
    yield_pa: Option<f64>,
    /// Allowed stress, Pa.
    allowed_pa: f64,
    wanted: usize,
    length: Unit,
    force: Unit,
}

/// The synthesis that a file asks for. What is missing for it goes into `diagnostics`.
pub(crate) fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
    let asked = asked(spec, design, diagnostics)?;
    let requirements = design.requirements.as_ref()?;
    Some(Box::new(Synthesis {
        windows: Windows::of(asked.band),
        stress: requirements.stress,
        yield_pa: design.yield_pa(0),
        allowed_pa: asked.strain * asked.young_pa,
        wanted: spec.synthesise.candidates.as_ref().map_or(CANDIDATES, |c| c.value) as usize,
        length: spec.requirements.travel.as_ref()?.value.unit.clone(),
        force: design.units.force.clone(),
        asked,
    }))
}

/// What a design is sized for; what is missing for it is said.
fn asked(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Asked> {
    let place = spec.requirements.present.as_ref().map(|p| p.span).unwrap_or_default();
    let mut missing = |key: &str, help: &str| {
        let message = format!("a synthesis needs `{key}`");
        diagnostics.push(Diagnostic::error("E0530", place, message).label("asked for here").help(help));
    };
    let requirements = design.requirements.as_ref();
    let force = requirements.and_then(|r| r.force);
    if force.is_none() {
        missing("requirements.force", "add `force = { nominal = \"10 N\", band = \"5 %\" }` and `travel = \"6 mm\"` to `[requirements]`");
    }
    let thickness_min_m = si(spec.synthesise.thickness_min.as_ref());
    if thickness_min_m.is_none() {
        missing(
            "synthesise.thickness_min",
            "add `[synthesise]` with the thinnest beam that your process leaves: `thickness_min = \"0.5 mm\"`",
        );
    }
    let allowed_pa = design.allowable_pa(0);
    if allowed_pa.is_none() && requirements.is_some() {
        missing("material.yield_stress", "give the yield stress, or `stress = { max = \"40 MPa\" }` in `[requirements]`");
    }
    if let Some(envelope) = &spec.requirements.envelope.present {
        let message = "an envelope is a box around a drawing, which a synthesis does not have yet";
        let help = "give the size of the room instead: `room = [\"80 mm\", \"60 mm\"]` in `[synthesise]`";
        diagnostics.push(Diagnostic::error("E0531", envelope.span, message).label("around what?").help(help));
    }
    let limit = |name: &str| {
        let found = requirements?.limits.iter().find(|l| l.name::<CompliantMetrics>() == name)?;
        Some([found.min, found.max])
    };
    // What a file says of the inner face itself may be more severe than what it says of all stresses.
    let inner_pa = limit("stress_inner_face").and_then(|[_, max]| max).unwrap_or(f64::INFINITY);
    let depth = &spec.synthesise.depth;
    let [depth_min_m, depth_max_m] = [&depth.min, &depth.max].map(|side| si(side.as_ref()));
    if let (Some(min), Some(max), Some(typed)) = (depth_min_m, depth_max_m, &depth.max)
        && min > max
    {
        let message = "no plate is at least `min` and at most `max` deep";
        diagnostics.push(Diagnostic::error("E0204", typed.span, message).label("less than `min`").help("exchange the two"));
    }
    if diagnostics.has_errors() {
        return None;
    }
    let requirements = requirements?;
    let (band, nominal_n) = force?;
    let young_pa = design.network.beams.first()?.section.young_pa;
    Some(Asked {
        band,
        nominal_n,
        stroke_m: requirements.travel_m?,
        young_pa,
        strain: allowed_pa?.min(inner_pa) / young_pa,
        stress_pa: requirements.stress.and(allowed_pa).map(|allowed| allowed.min(inner_pa)),
        stiffness_n_per_m: [requirements.stiffness_min, requirements.stiffness_max.unwrap_or(f64::INFINITY)],
        room_m: spec.synthesise.room.as_ref().map_or([f64::INFINITY; 2], |room| [room.value[0].si, room.value[1].si]),
        depth_min_m,
        depth_max_m: depth_max_m.unwrap_or_else(|| DEPTH_MAX_M.max(depth_min_m.unwrap_or(0.0))),
        thickness_min_m: thickness_min_m?,
        plates: spec.synthesise.plates.as_ref().map_or(1, |p| p.value),
        rows: spec.synthesise.rows.as_ref().map_or(1, |r| r.value),
        layers: spec.synthesise.series.as_ref().map_or(1, |l| l.value),
        making: design.making,
        gap_min_m: limit("clearance_min").and_then(|[min, _]| min).unwrap_or(0.0),
    })
}

/// Area in the plane and depth of all plates, m² and m.
fn extent(size: &Size) -> [f64; 2] {
    let depth_m = size.depth_m * f64::from(size.plates);
    [size.cost_m3 / depth_m, depth_m]
}

/// Whether two sizes take nearly the same area and depth, with as many copies.
fn near(a: &Size, b: &Size) -> bool {
    a.copies == b.copies && extent(a).iter().zip(extent(b)).all(|(a, b)| (a / b - 1.0).abs() < DIFFERENT)
}

/// Of each shape the size that costs least, then those of least area and of least depth where they are different, the best first.
fn picked(found: &[Size]) -> Vec<Size> {
    let mut rounds: [Vec<Size>; 3] = Default::default();
    for shape in 0..catalogue::TOPOLOGIES.len() {
        let least = |by: &dyn Fn(&Size) -> f64| found.iter().filter(|s| s.shape == shape).min_by(|a, b| by(a).total_cmp(&by(b))).copied();
        let mut own: Vec<Size> = Vec::new();
        for (round, size) in [least(&|s| s.cost_m3), least(&|s| extent(s)[0]), least(&|s| extent(s)[1])].into_iter().enumerate() {
            let Some(size) = size else { continue };
            if !own.iter().any(|o| near(o, &size)) {
                own.push(size);
                rounds[round].push(size);
            }
        }
    }
    let parts = |s: &Size| catalogue::solved(s.shape).map_or(0, |c| c.beams) as f64 * f64::from(s.copies.count());
    let score = |s: &Size| s.cost_m3 * (1.0 + PART_COST * parts(s));
    for round in &mut rounds {
        round.sort_by(|a, b| score(a).total_cmp(&score(b)));
    }
    rounds.concat()
}

impl Synthesis {
    fn tried(&self) -> usize {
        (TRIED_PER_FILE * self.wanted).max(FEWEST_TRIED)
    }

    /// What of these is analysed.
    fn written(&self, found: &[Size], most: usize) -> Vec<Proposal> {
        let mut sizes = picked(found);
        sizes.truncate(most);
        sizes.iter().filter_map(|size| write::proposal(&self.asked, size, &self.length, 0.0)).collect()
    }

    /// The size that the full analysis suggests: as large as the stroke needs, as thin as the stress at the inner face needs, as deep as the
    /// force needs.
    fn resized(&self, size: &Size, outcome: &Outcome) -> Option<Size> {
        let metric = |name: &str| outcome.metric(name).map(|m| m.value);
        let stroke_m = metric("flat_end")? - metric("flat_start")?;
        let larger = (self.asked.stroke_m * (1.0 + BEYOND) / stroke_m).max(1.0);
        let thinner = (self.allowed_pa * (1.0 - BEYOND) / metric("stress_inner_face")?).min(1.0);
        if larger > LARGEST_STEP || thinner < 1.0 / LARGEST_STEP {
            return None;
        }
        let thickness_m = size.thickness_m * larger * thinner;
        let level = self.asked.nominal_n.zip(metric("flat_force")).map_or(1.0, |(asked, found)| asked / found);
        let stiffer = level * larger * larger / maths::powi(larger * thinner, 3);
        let (mut depth_m, mut plates) = (size.depth_m * stiffer, size.plates);
        if self.asked.nominal_n.is_none() {
            depth_m = size.depth_m;
        }
        if depth_m > self.asked.depth_max_m && plates < self.asked.plates {
            depth_m *= f64::from(plates) / f64::from(plates + 1);
            plates += 1;
        }
        let near = (larger - 1.0).max(1.0 - thinner).max((level - 1.0).abs()) <= LEVEL && outcome.requirements_met();
        let next = Size { scale: size.scale * larger, thickness_m, depth_m, plates, ..*size };
        let shape = catalogue::solved(size.shape)?;
        let room = Room::of(&self.asked, shape, shape.stops.get(size.stop)?, size.copies);
        let [width_m, height_m] = room.extent_m(next.scale, thickness_m);
        let inside = width_m <= self.asked.room_m[0] && height_m <= self.asked.room_m[1];
        // The stress of a shape that keeps its slimness does not depend on its size.
        let can = shape.slimness_m.is_none() || thinner >= 1.0;
        let fits = inside && can && thickness_m >= self.asked.thickness_min_m && depth_m <= self.asked.depth_max_m;
        (fits && !near).then(|| Size { cost_m3: next.cost_m3(&room), ..next })
    }
}

impl Synthesiser for Synthesis {
    fn wanted(&self) -> usize {
        self.wanted
    }

    fn proposals(&self, _: Watch<'_>) -> Vec<Proposal> {
        // What the closed form does not see may ask for more copies than it does.
        let [fewest, more] = [sizes, sizes_of_more].map(|of| of(&self.asked, &self.windows));
        [self.written(&fewest, self.tried()), self.written(&more, self.tried() / 2)].concat()
    }

    fn judge(&self, proposal: &Proposal, outcome: &Outcome) -> Judgement {
        if outcome.status.kind != StatusKind::Complete {
            return Judgement::Reject(outcome.status.message.clone());
        }
        if let Some(crossing) = outcome.warnings.iter().find(|w| w.code == "W0508") {
            return Judgement::Reject(crossing.message.clone());
        }
        let clearance = outcome.metric("clearance_min").map_or(f64::INFINITY, |m| m.value);
        if clearance <= 0.0 {
            return Judgement::Reject("surfaces of beams touch".to_owned());
        }
        // Also where the file says nothing of pads: the room that is told is with them.
        if let Some(pads) = outcome.checks.iter().find(|c| c.code == "COMP013" && c.state == CheckState::Missed) {
            return Judgement::Reject(format!("something runs into a pad: {}", pads.title));
        }
        let Some((size, round)) = write::read(&proposal.state) else { return Judgement::Keep };
        let next = self.resized(&size, outcome).filter(|_| round < ROUNDS);
        let next = next.and_then(|size| write::proposal(&self.asked, &size, &self.length, round + 1.0));
        next.map_or(Judgement::Keep, |next| Judgement::Correct(Box::new(next)))
    }

    fn searched(&self, proposal: &Proposal, parameters: &[ParameterRow]) -> Proposal {
        let value = |path: &str| {
            let row = parameters.iter().find(|p| p.path == path)?;
            Quantity::parse(&row.value, Dimension::Length).ok().map(|q| q.si)
        };
        let found = ["design.thickness", "design.depth"].map(value);
        write::searched(&self.asked, proposal, found, &self.length).unwrap_or_else(|| proposal.clone())
    }

    fn alike(&self, a: &Proposal, b: &Proposal) -> bool {
        let sizes = write::read(&a.state).zip(write::read(&b.state));
        a.parts == b.parts && sizes.is_some_and(|((a, _), (b, _))| near(&a, &b))
    }

    fn relaxations(&self, slack: f64, _: Watch<'_>) -> Vec<Relaxation> {
        Knob::ALL.iter().filter_map(|knob| self.relaxed(*knob, slack)).map(|(relaxation, _)| relaxation).collect()
    }

    fn nearest(&self, _: Watch<'_>) -> Vec<Proposal> {
        // The shorter stroke first: a design that does less of what is asked is nearer to it than one that breaks. Only what an analysis
        // tests is given up, so that the design is seen to miss it.
        let order = [Knob::Travel, Knob::Band, Knob::LessForce, Knob::MoreForce, Knob::Stress, Knob::Slope, Knob::Room];
        let Some((_, asked)) = order.into_iter().find_map(|knob| self.relaxed(knob, 0.0)) else { return Vec::new() };
        let windows = Windows::of(asked.band);
        let sizes = picked(&sizes(&asked, &windows));
        let asked = Asked { room_m: self.asked.room_m, ..asked };
        sizes.iter().take(self.wanted.min(2)).filter_map(|size| write::proposal(&asked, size, &self.length, ROUNDS)).collect()
    }
}
