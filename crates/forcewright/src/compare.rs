//! Mechanisms of any family side by side, in the measures that all share ([`Duty`]): what they give, over which range, how stiffly, with
//! what loss, in how much room, of how many parts. A lever makes forces and torques of one kind.

mod document;
mod page;

use forcewright_base::diagnostics::Explanation;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::family::Progress;
use forcewright_model::{Action, CheckState, Curve, Duty, Stated, Status, StatusKind};

use crate::Loaded;

/// Codes of the calls that cannot be answered.
pub(crate) const CODES: &[Explanation] = &[Explanation {
    code: "E0126",
    title: "a lever that has no length",
    text: "`--lever` is the length of the arm at whose end a force counts as a torque about its pivot, a length above zero with its unit, such as `--lever \"40 mm\"`. \
           Through it a cam that gives a force and a cable drive that gives a torque are compared for one duty: torque = force × lever, turn = travel / lever, for small turns.",
}];

/// A mechanism of the comparison.
pub struct Compared {
    /// The project file as the user named it.
    pub input_name: String,
    /// SHA-256 of everything read.
    pub input_sha256: String,
    /// Name of its family.
    pub mechanism: &'static str,
    /// Its title.
    pub title: String,
    /// How far its analysis came.
    pub status: Status,
    /// Whether it does what its file asks for.
    pub requirements: CheckState,
    /// Checks that its requirements ask for and are not met, by code and title.
    pub not_met: Vec<(&'static str, String)>,
    /// The common measures; `None` where the analysis could not begin.
    pub duty: Option<Duty>,
    /// Mass of the parts that are drawn and whose density is known, kg.
    pub mass: Stated,
    /// Pieces drawn.
    pub pieces: Stated,
    /// Whether it is seen through the lever.
    pub levered: bool,
    /// What it gives over its travel, seen through the lever; `None` where that is another's.
    pub curve: Option<Curve>,
}

/// Mechanisms side by side.
pub struct Comparison {
    /// In the order of the call.
    pub mechanisms: Vec<Compared>,
    /// The lever through which forces and torques are compared, m.
    pub lever_m: Option<f64>,
    /// Whether the user stopped it.
    pub interrupted: bool,
}

/// A measure for people.
pub struct MeasureRow {
    /// Stable name for scripts.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// One text per mechanism: value with unit, or a dash.
    pub texts: Vec<String>,
    /// What it is of each mechanism, or why there is none.
    pub bases: Vec<String>,
}

/// Analyses projects and puts them side by side; with a lever, m, as what the first of them gives. The work of one is a pure function of
/// its file.
pub fn compare(projects: &[(String, Loaded)], lever_m: Option<f64>, progress: Progress<'_>) -> Comparison {
    let mut mechanisms: Vec<Compared> = Vec::with_capacity(projects.len());
    let mut interrupted = false;
    for (at, (name, loaded)) in projects.iter().enumerate() {
        let done = |part: f64| (at as f64 + part) / projects.len() as f64;
        if !progress(done(0.0)) {
            interrupted = true;
            break;
        }
        mechanisms.push(Compared::new(name, loaded, &mut |part| progress(done(part))));
    }
    progress(1.0);
    let mut found = Comparison { mechanisms, lever_m, interrupted };
    if let (Some(lever_m), Some(action)) = (lever_m, found.mechanisms.iter().find_map(|m| Some(m.duty.as_ref()?.action))) {
        for mechanism in &mut found.mechanisms {
            mechanism.seen_as(action, lever_m);
        }
    }
    found
}

impl Compared {
    fn new(input_name: &str, loaded: &Loaded, progress: Progress<'_>) -> Self {
        let analysis = loaded.understood.analyse(progress);
        let outcome = analysis.outcome;
        let (mass, pieces) = match loaded.understood.parts() {
            Err(none) => (Stated::none(&none.message), Stated::none(&none.message)),
            Ok(set) => {
                let (mass_kg, without) = set.mass_kg();
                let all =
                    if without.is_empty() { String::new() } else { format!(" without {}, whose density is not known", without.join(", ")) };
                let known = (mass_kg > 0.0).then_some(mass_kg);
                let kinds = set.parts.iter().filter(|p| p.count > 0).count();
                let counted = format!("drawn, of {kinds} {}; what is bought is not counted", if kinds == 1 { "kind" } else { "kinds" });
                (
                    Stated {
                        at_least: !without.is_empty(),
                        ..Stated::new(known, &format!("of the parts drawn{all}"), "no density of a part is known")
                    },
                    Stated::new(Some(set.pieces() as f64), &counted, ""),
                )
            }
        };
        let missed = |c: &&forcewright_model::Check| c.required && c.state != CheckState::Met;
        let requirements = match (outcome.checks.iter().any(|c| c.required && c.state == CheckState::Missed), outcome.requirements_met()) {
            (true, _) => CheckState::Missed,
            (false, true) => CheckState::Met,
            (false, false) => CheckState::NotAssessed,
        };
        // A transmission has no force of its own over its travel: its curves are of other things.
        let given = analysis.duty.as_ref().is_some_and(|d| d.variation.value.is_some());
        Self {
            input_name: input_name.to_owned(),
            input_sha256: loaded.input_sha256.clone(),
            mechanism: outcome.mechanism,
            title: outcome.title,
            requirements,
            not_met: outcome.checks.iter().filter(missed).map(|c| (c.code, c.title.clone())).collect(),
            levered: false,
            curve: given.then(|| outcome.curves.into_iter().find(|c| action_of(c).is_some())).flatten(),
            status: outcome.status,
            duty: analysis.duty,
            mass,
            pieces,
        }
    }

    fn seen_as(&mut self, action: Action, lever_m: f64) {
        self.levered = self.duty.as_ref().is_some_and(|d| d.action != action);
        self.duty = self.duty.take().map(|duty| duty.seen_as(action, lever_m));
        if let Some(curve) = &mut self.curve {
            let (x, y) = match (action_of(curve), action) {
                (Some(Action::Force), Action::Torque) => (1.0 / lever_m, lever_m),
                (Some(Action::Torque), Action::Force) => (lever_m, 1.0 / lever_m),
                _ => return,
            };
            for branch in &mut curve.branches {
                branch.x.iter_mut().for_each(|value| *value *= x);
                branch.y.iter_mut().for_each(|value| *value *= y);
            }
            let [along, across] = axes(action);
            (curve.x.dimension, curve.x.display) = (along, unit(along));
            (curve.y.dimension, curve.y.display) = (across, unit(across));
        }
    }
}

/// What a curve is of, if it is of a force over a travel or of a torque over a turn.
fn action_of(curve: &Curve) -> Option<Action> {
    [Action::Force, Action::Torque].into_iter().find(|action| axes(*action) == [curve.x.dimension, curve.y.dimension])
}

fn axes(action: Action) -> [Dimension; 2] {
    match action {
        Action::Force => [Dimension::Length, Dimension::Force],
        Action::Torque => [Dimension::Angle, Dimension::Torque],
    }
}

/// The unit in which people are shown a quantity here.
fn unit(dimension: Dimension) -> Unit {
    let symbol = match dimension {
        Dimension::Length => "mm",
        Dimension::Angle => "deg",
        Dimension::Stiffness => "N/mm",
        Dimension::Mass => "g",
        Dimension::Volume => "cm^3",
        Dimension::Ratio => "%",
        _ => return Unit::si(dimension),
    };
    Unit::parse(symbol).unwrap_or_else(|_| Unit::si(dimension))
}

/// A turn that an arm does not make of a travel in proportion: 30°.
const LARGE_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// A measure of one mechanism with its quantity.
struct Cell {
    dimension: Dimension,
    stated: Stated,
}

/// The measures, each with its name and what it is.
type Measure = (&'static str, &'static str, fn(&Compared, &Duty) -> Cell);

const MEASURES: &[Measure] = &[
    ("strength", "Force or torque", |_, d| cell(axes(d.action)[1], &d.strength)),
    ("range", "Travel or turn", |_, d| cell(axes(d.action)[0], &d.range)),
    ("work", "Work of its own over the range", |_, d| cell(Dimension::Energy, &d.work)),
    ("variation", "Variation over the range, ±", |_, d| cell(Dimension::Ratio, &d.variation)),
    ("stiffness", "Stiffness", |_, d| {
        cell(if d.action == Action::Force { Dimension::Stiffness } else { Dimension::RotationalStiffness }, &d.stiffness)
    }),
    ("loss", "Loss, one way", |_, d| cell(Dimension::Ratio, &d.loss)),
    ("volume", "Volume of its box", |_, d| cell(Dimension::Volume, &boxed(d))),
    ("mass", "Mass", |c, _| cell(Dimension::Mass, &c.mass)),
    ("pieces", "Pieces", |c, _| cell(Dimension::Ratio, &c.pieces)),
    ("work_per_volume", "Work over volume", |_, d| {
        let density = d.work.value.zip(d.volume_m3()).map(|(work, volume)| work / volume);
        let why = if d.work.value.is_none() { &d.work.basis } else { &d.box_basis };
        cell(Dimension::Stress, &Stated::new(density, "work of its own per volume of the box", why))
    }),
];

fn boxed(duty: &Duty) -> Stated {
    Stated::new(duty.volume_m3(), &duty.box_basis, &duty.box_basis)
}

fn cell(dimension: Dimension, stated: &Stated) -> Cell {
    Cell { dimension, stated: stated.clone() }
}

impl Cell {
    fn text(&self, name: &str) -> String {
        let Some(value) = self.stated.value else { return "–".to_owned() };
        match name {
            "pieces" => format_number(value, 6),
            // A volumetric density of work is written as one.
            "work_per_volume" => format!("{} J/L", format_number(1e-3 * value, 3)),
            _ if self.stated.at_least => format!("≥ {}", format_si(value, &unit(self.dimension), 4)),
            _ => format_si(value, &unit(self.dimension), 4),
        }
    }

    /// Symbol of the SI unit for scripts.
    fn unit(&self, name: &str) -> &'static str {
        if name == "work_per_volume" { "J/m^3" } else { self.dimension.si_symbol() }
    }
}

impl Comparison {
    /// The measures for people.
    pub fn rows(&self) -> Vec<MeasureRow> {
        let row = |(name, title, of): &Measure| {
            let cells: Vec<Option<Cell>> = self.mechanisms.iter().map(|m| Some(of(m, m.duty.as_ref()?))).collect();
            let texts = cells.iter().map(|c| c.as_ref().map_or_else(|| "–".to_owned(), |c| c.text(name))).collect();
            let bases = cells
                .iter()
                .zip(&self.mechanisms)
                .map(|(c, m)| c.as_ref().map_or_else(|| m.status.message.clone(), |c| c.stated.basis.clone()));
            MeasureRow { name, title, texts, bases: bases.collect() }
        };
        let mut rows: Vec<MeasureRow> = MEASURES.iter().map(row).collect();
        let at = rows.iter().position(|r| r.name == "volume").unwrap_or(rows.len());
        rows.insert(at, self.boxes());
        rows
    }

    fn boxes(&self) -> MeasureRow {
        let text = |m: &Compared| {
            let sides: Vec<String> = m.duty.as_ref()?.sorted_box_m().iter().map(|m| format_number(1e3 * m, 4)).collect();
            match sides.len() {
                0 => None,
                3 => Some(format!("{} mm", sides.join(" × "))),
                _ => Some(format!("{} × ? mm", sides.join(" × "))),
            }
        };
        MeasureRow {
            name: "box",
            title: "Box around it",
            texts: self.mechanisms.iter().map(|m| text(m).unwrap_or_else(|| "–".to_owned())).collect(),
            bases: self
                .mechanisms
                .iter()
                .map(|m| m.duty.as_ref().map_or_else(|| m.status.message.clone(), |d| d.box_basis.clone()))
                .collect(),
        }
    }

    /// Whether all mechanisms do what their files ask for.
    pub fn requirements(&self) -> CheckState {
        let any = |state| self.mechanisms.iter().any(|m| m.requirements == state);
        match (any(CheckState::Missed), any(CheckState::NotAssessed)) {
            (true, _) => CheckState::Missed,
            (_, true) => CheckState::NotAssessed,
            _ => CheckState::Met,
        }
    }

    /// Whether every analysis reached its end.
    pub fn complete(&self) -> bool {
        self.mechanisms.iter().all(|m| m.status.kind == StatusKind::Complete)
    }

    /// Whether forces stand beside torques, which say nothing of each other without a lever.
    pub fn mixed(&self) -> bool {
        let actions: Vec<Action> = self.mechanisms.iter().filter_map(|m| Some(m.duty.as_ref()?.action)).collect();
        actions.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The result in a sentence.
    pub fn verdict(&self) -> String {
        let met = self.mechanisms.iter().filter(|m| m.requirements == CheckState::Met).count();
        let stopped = if self.interrupted { " (interrupted)" } else { "" };
        format!("{met} of {} mechanisms meet what their files ask for{stopped}", self.mechanisms.len())
    }

    /// What a reader must know before believing it.
    pub fn cautions(&self) -> Vec<String> {
        let mut all = Vec::new();
        if self.mixed() {
            all.push("Forces stand beside torques: `--lever` with the length of an arm makes them of one kind.".to_owned());
        }
        if let Some(lever_m) = self.lever_m.filter(|_| self.mechanisms.iter().any(|m| m.levered)) {
            let lever = format_si(lever_m, &unit(Dimension::Length), 4);
            all.push(format!("Seen through a lever of {lever}: torque = force × lever, turn = travel / lever; the lever itself has no size, mass or loss."));
            let turn = |m: &Compared| {
                let range = m.duty.as_ref().filter(|_| m.levered)?.range.value?;
                Some(if m.duty.as_ref()?.action == Action::Torque { range } else { range / lever_m })
            };
            if self.mechanisms.iter().filter_map(turn).any(|turn| turn > LARGE_RAD) {
                all.push(
                    "A turn beyond 30° is not small: an arm does not give it so, a rack or a belt on a drum of this radius does."
                        .to_owned(),
                );
            }
        }
        all
    }
}
