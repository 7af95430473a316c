//! From `[optimise]` and the requirements to a search: its goal, its bands, its limits.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, format_si};
use forcewright_contract::data::{Cell, Column, DataFile, rows};
use forcewright_contract::describe::{Located, Section};
use forcewright_contract::metrics;
use forcewright_contract::objective::{Goal, Way, goal_of};
use forcewright_contract::read::deferred_quantities;
use forcewright_contract::studies::{Objective, Optimise};
use forcewright_contract::tree::{Item, Value};
use forcewright_study::evaluator::Variable;
use forcewright_study::task::{self, Band, Limit, Step, Task};

use super::knobs::Knobs;
use super::mass;
use super::say_what_is_left;
use super::search::{Block, Edge, Search};
use crate::analysis::{PAPER_BAND, mass_kg};
use crate::design::{Design, Requirements};
use crate::metrics::CompliantMetrics;

/// What can be optimised, with what it means.
pub(super) const OBJECTIVES: &[Goal] = &[
    Goal {
        name: "force_deviation",
        doc: "half width of the band that the force needs over `window`, or over the best stroke of `requirements.travel`",
        way: Way::Small,
    },
    Goal { name: "flat_ratio", doc: "stroke inside the required band with a free level, over the travel", way: Way::Large },
    Goal { name: "band_ratio", doc: "stroke inside the required band around the nominal force, over the travel", way: Way::Large },
    Goal { name: "force_at_end", doc: "force at the full travel", way: Way::Either },
    Goal { name: "force_ratio", doc: "F(a)/F(b) − 1 with `window = [\"b\", \"a\"]`: eq. (1) of Lan, Wang & Chen 2010", way: Way::Small },
    Goal { name: "stress_max", doc: "largest stress over the travel", way: Way::Small },
    Goal { name: "safety_factor", doc: "yield stress over the largest stress", way: Way::Large },
    Goal { name: "force_target", doc: "sum of squared differences to the curve in `target` or `target_file`", way: Way::Small },
    Goal { name: "mass", doc: "mass of the beams, whole layout", way: Way::Small },
];

/// Where a window that may move begins at first, as part of the travel.
const FIRST_START: f64 = 0.4;
/// A window is never shorter than this part of the travel.
const LEAST_WINDOW: f64 = 0.02;

/// A goal while it is put together.
struct Posed {
    goal: task::Goal,
    bands: Vec<Band>,
    /// Bands and goal of a step before, with the window held.
    before: Option<(task::Goal, Vec<Band>)>,
}

/// Builds the task; what is wrong with the objective is reported, and what the search does not see. `given` is the accuracy that the file
/// asks for.
pub(crate) fn task(
    design: &Design,
    knobs: Knobs,
    (asked, given): (&Section<Optimise>, Option<f64>),
    diagnostics: &mut Diagnostics,
) -> Option<Task> {
    let objective = &asked.objective;
    let (name, large) = goal_of(objective, OBJECTIVES, diagnostics)?;
    let wanted = Wanted::new(design, name, objective, diagnostics)?;
    let place = asked.present.as_ref().map(|p| p.span).unwrap_or_default();
    say_what_is_left(&wanted.not_kept(design), "is not seen by the search; it is checked at the end", place, diagnostics);
    let search = Search::new(design, knobs, given, &wanted);
    let limits = limits(design, &search, &wanted);
    let posed = wanted.pose(design, &search, large);
    // The window of the objective comes first among the variables that are no numbers of the design.
    let own = search.knobs.variables.len()..search.knobs.variables.len() + 2;
    let mut steps = Vec::new();
    if let Some((goal, bands)) = posed.before {
        steps.push(Step { goal, bands, held: own.collect() });
    }
    steps.push(Step { goal: posed.goal, bands: posed.bands, held: Vec::new() });
    let title = format!("`{name}` as {} as possible", if large { "large" } else { "small" });
    Some(Task { evaluator: Box::new(search), title, steps, limits, sought: sought(name) })
}

/// What the evaluator must compute for an objective and the requirements.
pub(super) struct Wanted {
    name: &'static str,
    /// Beside the numbers of the design.
    pub(super) variables: Vec<Variable>,
    pub(super) windows: Vec<[Edge; 2]>,
    /// The window of the objective, by its index.
    own: Option<usize>,
    /// That of the required stroke, in which the force stays inside the required band: the same, or another.
    required: Option<usize>,
    pub(super) blocks: Vec<Block>,
    target_n: Vec<f64>,
}

impl Wanted {
    fn new(design: &Design, name: &'static str, objective: &Section<Objective>, diagnostics: &mut Diagnostics) -> Option<Self> {
        let mut wanted =
            Self { name, variables: Vec::new(), windows: Vec::new(), own: None, required: None, blocks: Vec::new(), target_n: Vec::new() };
        let requirements = design.requirements.as_ref();
        let typed = match &objective.window {
            None => None,
            Some(slot) => Some(window(slot, design, diagnostics)?),
        };
        match (name, typed) {
            ("force_deviation", Some(window)) => {
                wanted.windows.push(window.map(Edge::Fixed));
                wanted.own = Some(0);
            }
            ("force_ratio", Some([b, a])) if b > 0.0 => wanted.blocks.push(Block::ForceRatio([a, b])),
            ("force_ratio", Some(_)) => {
                let span = objective.window.as_ref().map(|w| w.span).unwrap_or_default();
                diagnostics.push(
                    Diagnostic::error("E0204", span, "there is no force at rest to compare with")
                        .label("begins at zero")
                        .help("begin later: `window = [\"4 mm\", \"8.8 mm\"]`"),
                );
                return None;
            }
            ("force_ratio", None) => {
                let place = objective.present.as_ref().map(|p| p.span).unwrap_or_default();
                diagnostics.push(
                    Diagnostic::error("E0302", place, "`force_ratio` needs two displacements")
                        .help("give `window = [\"4 mm\", \"8.8 mm\"]`"),
                );
                return None;
            }
            ("force_target", _) => wanted.target(objective, design, diagnostics)?,
            ("force_deviation" | "flat_ratio" | "band_ratio", None) => wanted.own = Some(wanted.moving_window("window", design)),
            (_, Some(_)) => {
                let span = objective.window.as_ref().map(|w| w.span).unwrap_or_default();
                diagnostics.push(
                    Diagnostic::error("E0305", span, format!("`{name}` has no window"))
                        .label("not needed")
                        .help("remove it; `force_deviation` and `force_ratio` have one"),
                );
                return None;
            }
            _ => {}
        }
        wanted.required_stroke(typed.is_none(), design);
        if name == "force_at_end" || limit(requirements, "force_at_end").is_some() {
            wanted.blocks.push(Block::Forces(vec![design.load_end]));
        }
        if requirements.is_some_and(|r| r.stiffness_min.is_finite() || r.stiffness_max.is_some()) {
            wanted.blocks.push(Block::Slopes);
        }
        let stressed = requirements.is_some_and(|r| r.stress.is_some())
            || ["stress_max", "safety_factor", "stress_inner_face"].iter().any(|n| *n == name || limit(requirements, n).is_some());
        if stressed {
            wanted.blocks.push(Block::Stress);
        }
        wanted.blocks.extend(requirements.and_then(|r| r.envelope).map(Block::Envelope));
        if limit(requirements, "length_ratio_max").is_some() {
            wanted.blocks.push(Block::LengthRatio);
        }
        let densities = mass::densities(design);
        if name == "mass" && densities.is_none() {
            no_density(design, objective, diagnostics);
            return None;
        }
        let weighed = name == "mass" || limit(requirements, "mass").is_some();
        wanted.blocks.extend(densities.filter(|_| weighed).map(Block::Mass));
        if limit(requirements, "clearance_min").is_some() {
            let beams = design.network.beams.len();
            wanted.blocks.push(Block::Clearance((0..beams).flat_map(|a| (a + 1..beams).map(move |b| [a, b])).collect()));
            wanted.blocks.extend(design.layout.mirror.map(Block::Mirror));
        }
        Some(wanted)
    }

    /// The window of the required stroke, that of the objective where it serves; `moves` says whether the search moves its edges. Then the
    /// values of all windows.
    fn required_stroke(&mut self, moves: bool, design: &Design) {
        if let Some((_, nominal)) = design.requirements.as_ref().and_then(|r| r.force) {
            // A stretch that is flat at any level, or one that is given, is not the required stroke.
            let serves = match self.name {
                "flat_ratio" => nominal.is_none(),
                "force_deviation" => moves,
                name => name == "band_ratio",
            };
            let title = if self.own.is_some() { "band" } else { "window" };
            let another = if serves { self.own } else { None };
            self.required = another.or_else(|| Some(self.moving_window(title, design)));
        }
        for (index, window) in self.windows.iter().enumerate() {
            self.blocks.push(Block::Window(index));
            if window.iter().any(|e| matches!(e, Edge::Moves(_))) {
                self.blocks.push(Block::WindowLength(index));
            }
        }
    }

    /// A window whose edges the search moves, by its index.
    fn moving_window(&mut self, title: &str, design: &Design) -> usize {
        let travel_m = design.load_end;
        let wanted_m = design.requirements.as_ref().and_then(|r| r.travel_m).unwrap_or(0.0);
        let edge = |end: &str, nominal| Variable { path: format!("{title}_{end}"), unit: "m", nominal, lower: 0.0, upper: travel_m };
        let start = (FIRST_START * travel_m).min(travel_m - wanted_m).max(0.0);
        let first = self.variables.len();
        self.variables.extend([edge("start", start), edge("end", travel_m)]);
        self.windows.push([Edge::Moves(first), Edge::Moves(first + 1)]);
        self.windows.len() - 1
    }

    fn target(&mut self, objective: &Section<Objective>, design: &Design, diagnostics: &mut Diagnostics) -> Option<()> {
        let place = objective.present.as_ref().map(|p| p.span).unwrap_or_default();
        let curve = match (&objective.target, &objective.target_file) {
            (Some(typed), None) => typed_curve(typed, diagnostics)?,
            (None, Some(file)) => measured_curve(&file.value, diagnostics)?,
            (Some(_), Some(file)) => {
                let message = "`target` and `target_file` exclude each other";
                diagnostics.push(Diagnostic::error("E0305", file.span, message).label("the second of two").help("keep one"));
                return None;
            }
            (None, None) => {
                let help = format!("{HOW}, or `target_file = \"wanted.csv\"`");
                diagnostics.push(Diagnostic::error("E0302", place, "`force_target` needs a curve").help(help));
                return None;
            }
        };
        let mut last = f64::NEG_INFINITY;
        for [at, _] in &curve {
            let why = match at.si {
                m if m < 0.0 || m > design.load_end => "a point of the curve lies outside of the travel",
                m if m <= last => "the displacements of the curve do not ascend",
                _ => "",
            };
            if !why.is_empty() {
                let travel = format_si(design.load_end, &design.units.displacement, 6);
                let help = format!("displacements go from 0 to the travel of the load, {travel}, and each is above the one before");
                diagnostics.push(Diagnostic::error("E0204", at.span, why).label("this displacement").help(help));
                return None;
            }
            last = at.si;
        }
        // At rest there is no force, whatever the design.
        let loaded: Vec<[Cell; 2]> = curve.iter().copied().filter(|[at, _]| at.si > 0.0).collect();
        if loaded.is_empty() {
            let rest = curve.first().map_or(place, |[at, _]| at.span);
            diagnostics.push(Diagnostic::error("E0204", rest, "the curve has no point under load").label("at rest").help(HOW));
            return None;
        }
        self.blocks.push(Block::Forces(loaded.iter().map(|[at, _]| at.si).collect()));
        self.target_n = loaded.iter().map(|[_, force]| force.si).collect();
        Some(())
    }

    fn pose(&self, design: &Design, search: &Search, large: bool) -> Posed {
        let requirements = design.requirements.as_ref();
        let (half_width, nominal) = requirements.and_then(|r| r.force).unwrap_or((PAPER_BAND, None));
        let band =
            |window: usize, level, half_width, checks| Band { values: search.values(&Block::Window(window)), level, half_width, checks };
        // The required stroke, where it is not that of the objective.
        let required = || -> Vec<Band> {
            let window = self.required.filter(|_| self.required != self.own);
            window.map(|window| band(window, nominal, Some(half_width), vec!["force"])).into_iter().collect()
        };
        let plain = |goal| Posed { goal, bands: required(), before: None };
        let with_required = |own: Band| std::iter::once(own).chain(required()).collect::<Vec<_>>();
        let (own, window) = (search.knobs.variables.len(), self.own.unwrap_or(0));
        let served = || if self.required.is_some() && self.required == self.own { vec!["force"] } else { Vec::new() };
        match self.name {
            "force_deviation" => {
                let bands = with_required(band(window, nominal, None, served()));
                Posed { goal: task::Goal::HalfWidth, bands, before: None }
            }
            "flat_ratio" | "band_ratio" => {
                let level = if self.name == "band_ratio" { nominal } else { None };
                let per_travel = 1.0 / design.load_end;
                Posed {
                    goal: task::Goal::Variables(vec![(own, per_travel), (own + 1, -per_travel)]),
                    bands: with_required(band(window, level, Some(half_width), served())),
                    before: Some((task::Goal::HalfWidth, with_required(band(window, level, None, Vec::new())))),
                }
            }
            "force_ratio" => {
                let block = self.blocks.iter().find(|b| matches!(b, Block::ForceRatio(_)));
                let at = block.map_or(0, |b| search.values(b).start);
                // As close to zero as possible, from either side.
                plain(task::Goal::Squares { values: at..at + 1, targets: vec![0.0], scale: 1.0 })
            }
            "force_target" => {
                let block = self.blocks.iter().find(|b| matches!(b, Block::Forces(at) if at.len() == self.target_n.len()));
                let values = block.map_or(0..0, |b| search.values(b));
                let scale = self.target_n.iter().fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
                plain(task::Goal::Squares { values, targets: self.target_n.clone(), scale })
            }
            "force_at_end" => {
                let at = search.values(&Block::Forces(vec![design.load_end])).start;
                plain(task::Goal::Values(vec![(at, if large { -1.0 } else { 1.0 })]))
            }
            "mass" => {
                let at = self.blocks.iter().find(|b| matches!(b, Block::Mass(_))).map_or(0, |b| search.values(b).start);
                // As a part of the first mass, so that a milligram is not taken for nothing.
                plain(task::Goal::Values(vec![(at, 1.0 / mass_kg(design).unwrap_or(1.0))]))
            }
            // The largest stress is small where the safety factor is large.
            _ => {
                let scale = design.common_allowable_pa().or(design.yield_pa(0)).unwrap_or(1e6);
                plain(task::Goal::Largest { values: search.values(&Block::Stress), scale })
            }
        }
    }
}

/// Says which material lacks its density.
fn no_density(design: &Design, objective: &Section<Objective>, diagnostics: &mut Diagnostics) {
    let span = objective.minimise.as_ref().map(|m| m.span).unwrap_or_default();
    let table = design.materials.iter().find(|m| m.density_kg_per_m3.is_none()).map_or_else(String::new, |m| match &m.name {
        Some(name) => format!("material.{name}"),
        None => "material".to_owned(),
    });
    diagnostics.push(
        Diagnostic::error("E0302", span, format!("`mass` needs a density, which `[{table}]` does not give"))
            .label("this objective")
            .help(format!("give `density = \"1410 kg/m^3\"` in `[{table}]`, or `use` an entry of the catalogue that has one")),
    );
}

/// How a curve is written.
const HOW: &str = "give `target = [[\"2 mm\", \"5 N\"], [\"4 mm\", \"7 N\"]]`";
/// Most points of a curve: each is a state to be computed.
const MOST_POINTS: usize = 500;

fn no_curve<T>(span: Span, message: &str, diagnostics: &mut Diagnostics) -> Option<T> {
    diagnostics.push(Diagnostic::error("E0204", span, message).label("this curve").help(HOW));
    None
}

/// The curve of `target`: displacements and forces.
fn typed_curve(target: &Located<Value>, diagnostics: &mut Diagnostics) -> Option<Vec<[Cell; 2]>> {
    let points = match &target.value {
        Value::List(points) if (1..=MOST_POINTS).contains(&points.len()) => points,
        _ => return no_curve(target.span, &format!("a curve is a list of 1 to {MOST_POINTS} points"), diagnostics),
    };
    let point = |Item { value, span }: &Item| match value {
        Value::List(two) if two.len() == 2 => {
            Some([typed_value(&two[0], Dimension::Length, diagnostics)?, typed_value(&two[1], Dimension::Force, diagnostics)?])
        }
        _ => no_curve(*span, "a point of the curve is a displacement and a force", diagnostics),
    };
    points.iter().map(point).collect()
}

fn typed_value(item: &Item, dimension: Dimension, diagnostics: &mut Diagnostics) -> Option<Cell> {
    match deferred_quantities(&Located::new(item.value.clone(), item.span), dimension, diagnostics)?[..] {
        [si] => Some(Cell { si, span: item.span }),
        _ => no_curve(item.span, "a point of the curve is a displacement and a force", diagnostics),
    }
}

/// The curve of `target_file`.
fn measured_curve(file: &DataFile, diagnostics: &mut Diagnostics) -> Option<Vec<[Cell; 2]>> {
    let travel = Column { name: "travel", dimension: Dimension::Length };
    rows(file, &[travel, Column { name: "force", dimension: Dimension::Force }], MOST_POINTS, diagnostics)
}

/// A limit on a metric: least and largest value.
fn limit(requirements: Option<&Requirements>, name: &str) -> Option<(Option<f64>, Option<f64>)> {
    let limits = &requirements?.limits;
    limits.iter().find(|l| l.name::<CompliantMetrics>() == name).map(|l| (l.min, l.max))
}

/// Metrics on which a search keeps limits.
const KEPT: [&str; 10] = [
    "force_at_end",
    "flat_force",
    "flat_ratio",
    "stress_max",
    "safety_factor",
    "length_ratio_max",
    "clearance_min",
    "envelope_margin",
    "stiffness_min",
    "mass",
];

/// Checks of what an objective itself makes better.
fn sought(name: &'static str) -> Vec<&'static str> {
    match name {
        // The stress that a safety factor is of, and the other way round.
        "stress_max" | "safety_factor" => vec!["stress", "stress_max", "safety_factor"],
        name => vec![name],
    }
}

impl Wanted {
    /// Requirements that the search does not see: they are checked at its end.
    fn not_kept(&self, design: &Design) -> Vec<&'static str> {
        let Some(requirements) = &design.requirements else { return Vec::new() };
        let lengths = self.blocks.iter().any(|b| matches!(b, Block::WindowLength(_)));
        let seen = |name: &str| match name {
            "mass" => mass_kg(design).is_some(),
            "flat_force" => !self.windows.is_empty(),
            "flat_ratio" => lengths,
            "stress_inner_face" => allowed_stress(design).is_some_and(|(_, inner_face)| inner_face),
            _ => KEPT.contains(&name),
        };
        let limits = requirements.limits.iter().map(metrics::Limit::name::<CompliantMetrics>).filter(|name| !seen(name));
        let pads = design.making.is_drawn().then_some("pads");
        limits.chain(requirements.endurance()).chain(pads).collect()
    }
}

/// Two displacements of a window.
fn window(slot: &Located<Value>, design: &Design, diagnostics: &mut Diagnostics) -> Option<[f64; 2]> {
    match deferred_quantities(slot, Dimension::Length, diagnostics)?[..] {
        [from, to] if 0.0 <= from && from < to && to <= design.load_end => Some([from, to]),
        _ => {
            diagnostics.push(
                Diagnostic::error("E0204", slot.span, "a window is two ascending displacements within the travel")
                    .label("this window")
                    .help("write it as `window = [\"4.2 mm\", \"13.6 mm\"]`"),
            );
            None
        }
    }
}

/// Requirements as limits on the evaluator's values.
fn limits(design: &Design, search: &Search, wanted: &Wanted) -> Vec<Limit> {
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let mut all = Vec::new();
    let mut add = |name: &str, key: &str, block: &Block, (lower, upper): (f64, f64), scale: f64, unit| {
        let values = search.values(block);
        if !values.is_empty() && (lower > f64::NEG_INFINITY || upper < f64::INFINITY) {
            let in_band = matches!(block, Block::Window(_) | Block::WindowLength(_));
            all.push(Limit {
                name: name.to_owned(),
                key: key.to_owned(),
                checks: serves(name),
                values,
                lower,
                upper,
                scale,
                unit,
                in_band,
            });
        }
    };
    let least_window_m = LEAST_WINDOW * design.load_end;
    let Some(requirements) = &design.requirements else {
        add("travel", "requirements.travel", &Block::WindowLength(0), (least_window_m, free.1), design.load_end, "m");
        return all;
    };
    let of = |name: &str| limit(Some(requirements), name).unwrap_or((None, None));
    let (size_m, stiffness) = (size_m(design), rigidity(design));
    if let Some((allowed, inner_face)) = allowed_stress(design) {
        let name = if inner_face { "stress, also at inner faces" } else { "stress" };
        add(name, "requirements.stress", &Block::Stress, (-allowed, allowed), allowed, "Pa");
    }
    let slopes = (requirements.stiffness_min.max(of("stiffness_min").0.unwrap_or(free.0)), requirements.stiffness_max.unwrap_or(free.1));
    add("stiffness", "requirements.stiffness", &Block::Slopes, slopes, stiffness, "N/m");
    if let Some(envelope) = requirements.envelope {
        let least = of("envelope_margin").0.unwrap_or(0.0);
        add("envelope", "requirements.envelope", &Block::Envelope(envelope), (least, free.1), size_m, "m");
    }
    if let (Some(least), _) = of("clearance_min") {
        for block in wanted.blocks.iter().filter(|b| matches!(b, Block::Clearance(_) | Block::Mirror(_))) {
            add("clearance", "requirements.limits.clearance_min", block, (least, free.1), size_m, "m");
        }
    }
    let bounds = |name| {
        let (min, max) = of(name);
        (min.unwrap_or(free.0), max.unwrap_or(free.1))
    };
    add("beam length", "requirements.limits.length_ratio_max", &Block::LengthRatio, bounds("length_ratio_max"), 1.0, "1");
    if let (Some(first_kg), Some(block)) = (mass_kg(design), wanted.blocks.iter().find(|b| matches!(b, Block::Mass(_)))) {
        add("mass", "requirements.limits.mass", block, bounds("mass"), first_kg, "kg");
    }
    let force_n = stiffness * design.load_end;
    add(
        "force at the end",
        "requirements.limits.force_at_end",
        &Block::Forces(vec![design.load_end]),
        bounds("force_at_end"),
        force_n,
        "N",
    );
    let flat = wanted.own.or(wanted.required).unwrap_or(0);
    add("force", "requirements.limits.flat_force", &Block::Window(flat), bounds("flat_force"), force_n, "N");
    let flat_m = of("flat_ratio").0.unwrap_or(0.0) * design.load_end;
    let travel_m = requirements.travel_m.filter(|_| requirements.force.is_some()).unwrap_or(0.0);
    let moves = |window: &usize| wanted.blocks.contains(&Block::WindowLength(*window));
    let (stroke, own) = (wanted.required.or(wanted.own), wanted.own.filter(moves));
    for window in 0..wanted.windows.len() {
        let is_stroke = stroke == Some(window);
        let is_flat = own.or(wanted.required) == Some(window);
        let shortest_m = least_window_m.max(if is_stroke { travel_m } else { 0.0 }).max(if is_flat { flat_m } else { 0.0 });
        let (name, key) = if is_stroke { ("travel", "requirements.travel") } else { ("flat stretch", "requirements.limits.flat_ratio") };
        add(name, key, &Block::WindowLength(window), (shortest_m, free.1), design.load_end, "m");
    }
    all
}

/// The stress that requirements allow, Pa, and whether it keeps that at the inner faces of curved beams, too. There it is larger by a part that
/// only the full analysis knows; the search moves the limit inwards by that, where no other limit on stress is smaller.
fn allowed_stress(design: &Design) -> Option<(f64, bool)> {
    let requirements = design.requirements.as_ref();
    let of = |name: &str| limit(requirements, name).unwrap_or((None, None));
    let straight = [
        design.common_allowable_pa().or_else(|| (0..design.network.beams.len()).filter_map(|b| design.allowable_pa(b)).reduce(f64::min)),
        of("stress_max").1,
        of("safety_factor").0.and_then(|factor| Some(design.yield_pa(0)? / factor)),
    ];
    let straight = straight.into_iter().flatten().reduce(f64::min);
    match (straight, of("stress_inner_face").1) {
        (None, None) => None,
        (Some(straight), Some(inner)) if straight < inner => Some((straight, false)),
        (_, Some(inner)) => Some((inner, true)),
        (Some(straight), None) => Some((straight, false)),
    }
}

/// Names of the checks that a limit serves.
fn serves(limit: &str) -> Vec<&'static str> {
    match limit {
        "stress" => vec!["stress", "stress_max", "safety_factor"],
        "stress, also at inner faces" => vec!["stress", "stress_max", "safety_factor", "stress_inner_face"],
        "stiffness" => vec!["stiffness", "stiffness_min", "stiffness_max"],
        "envelope" => vec!["envelope", "envelope_margin"],
        "clearance" => vec!["clearance_min"],
        "beam length" => vec!["length_ratio_max"],
        "mass" => vec!["mass"],
        "force at the end" => vec!["force_at_end"],
        "force" => vec!["flat_force"],
        "travel" => vec!["travel", "flat_ratio"],
        "flat stretch" => vec!["flat_ratio"],
        _ => Vec::new(),
    }
}

/// Size of the drawn network, m.
fn size_m(design: &Design) -> f64 {
    design.network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max)
}

/// A stiffness that bending gives to a design of this size, N/m: 3EI/L³ of its longest beam.
fn rigidity(design: &Design) -> f64 {
    let of = |b: &forcewright_beam::Beam| {
        let s = &b.section;
        let length_m = size_m(design);
        s.young_pa * s.depth_m * s.thickness_m * s.thickness_m * s.thickness_m / (4.0 * length_m * length_m * length_m)
    };
    design.copies() * design.network.beams.iter().map(of).fold(0.0, f64::max)
}
