//! From `[measurements]` and `[calibrate]` to measured points and the parameters that are looked for.

mod record;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation, Span};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_study::calibrate::{Bench, BenchParameter, Limits, Loss, Prior};
use forcewright_study::sampling::{Confidence, SIGMAS_IN_TOLERANCE};

use crate::data::DataFile;
use crate::describe::{Describe, Form, Located, Member, Param, Section, Slot, Visitor, Word};
use crate::numbers::{Number, matches};
use crate::read::{deferred_quantities, deferred_quantity};
use crate::studies::{Free, chosen};
use crate::tree::Value;

pub use record::{Direction, Record};

/// Codes of calibrations.
pub const CODES: &[Explanation] = &[
    Explanation {
        code: "E0901",
        title: "which measurement?",
        text: "A calibration compares the design with one table of `[measurements]`. The file has none, `measurement` names none of them, or there are several and it names none:\n\n    [measurements.curve]\n    file = \"curve.csv\"\n    x = \"travel / mm\"\n    y = \"force / N\"\n\n    [calibrate]\n    measurement = \"curve\"\n\nThe name is free, except for transmissions: there `[measurements.bench]` is a bench with masses, which `forcewright solve` reads.",
    },
    Explanation {
        code: "E0902",
        title: "not a prior",
        text: "A prior is a value with what is known of it: `prior = \"2 GPa ± 0.2 GPa\"`. As everywhere in project files, the half width behind `±` is three standard deviations. What is known for certain is no parameter; what is not known at all needs no prior.",
    },
    Explanation {
        code: "E0903",
        title: "no such number of the bench",
        text: "Beside numbers of the design, a calibration may look for those of the bench: `bench.offset.x` and `bench.offset.y`, what it shows at rest (`bench.offset` means both), and `bench.compliance`, how much of the travel it takes itself, per force.",
    },
    Explanation {
        code: "E0904",
        title: "too few measured points",
        text: "Points count that lie where the design's curve is computed, on the branch that was asked for; there must be at least two more than parameters. Rows that repeat the one before them exactly, or a table that repeats as a whole, are one measurement.\n\nWhat is compared: the force over the travel of the load, from rest to `load.travel` (compliant); the force, or of a torque cam the torque, up and down over the travel in `window` (cam); the tangent stiffness over the torque, up to `requirements.torque` (cable drive); the output over the input torque, up to `requirements.input_torque` (transmission): measured in units of these quantities, and with the zero of the bench taken off by `offset`.",
    },
    Explanation {
        code: "E0905",
        title: "no such filter",
        text: "A filter is Butterworth's low-pass, run forwards and backwards over the rows in the order of the file, which were taken at even times: an order from 1 to 8 and a cut-off below half the rate of the rows.\n\n    filter = { order = 4, cut_off = \"5 Hz\", rate = \"35 Hz\" }\n\nIt takes half of the amplitude at the cut-off. A record has at least some periods of it (three, and more for orders above 4): what is slower moves the ends of the record, or all of it. Scatter and lack of fit are judged by the unfiltered rows.",
    },
    Explanation {
        code: "E0906",
        title: "a number that cannot be looked for",
        text: "Requirements, loads and models are what the measurement was made with; a calibration looks for numbers of the design, its material, its errors, losses, surroundings and bodies, and of the bench. A range is a smaller and a larger value, with the one in the file between them: the search begins there. What the file does not say of a bench is zero.",
    },
    Explanation {
        code: "E0908",
        title: "no curve to compare with",
        text: "The family's studies have no curve over places for this design, or its analysis shows no curve of the same quantity, so that nothing could be measured against it. `forcewright solve` says what is missing.\n\nA measured curve is the force over the travel of the load (compliant), the force or the torque up and down over the travel (cam), the tangent stiffness over the torque (cable drive: not the turn of its output, nor a secant stiffness), or the output over the input torque (transmission).",
    },
    Explanation {
        code: "E0912",
        title: "decimal commas",
        text: "Numbers of the measured table have decimal commas, as programs write them that are set to many languages of Europe. Say so beside `file`; columns are then separated by semicolons:\n\n    [measurements.curve]\n    file = \"curve.csv\"\n    decimal = \"comma\"\n    x = \"travel / mm\"\n    y = \"force / N\"",
    },
    Explanation {
        code: "E0910",
        title: "not a compliance",
        text: "The compliance of a bench is the travel that it takes itself, per force (or turn per torque): `\"2e-6 m/N\"`, `\"0.002 mm/N\"`, `\"0.01 deg/(N*m)\"`. Any unit of the abscissa over any unit of the ordinate will do; one of several symbols stands in brackets, or after a stroke each, `deg/N/m`. Behind `±` the unit may be left out, or a part in per cent stand. Zero needs no unit.",
    },
];

/// Curves that were measured.
#[derive(Clone, Debug, Default)]
pub struct Measurements {
    /// By their names.
    pub each: Vec<Member<Measurement>>,
}

/// A curve that was measured.
#[derive(Clone, Debug, Default)]
pub struct Measurement {
    /// A CSV file.
    pub file: Slot<DataFile>,
    /// Header of the column of abscissae.
    pub x: Slot<String>,
    /// Header of the column of ordinates.
    pub y: Slot<String>,
    /// How its numbers are written.
    pub decimal: Slot<&'static str>,
    /// What takes fast errors away.
    pub filter: Section<FilterKeys>,
    /// What the bench shows at rest.
    pub offset: Section<Offset>,
    /// How much of the abscissa the bench takes itself.
    pub compliance: Slot<Value>,
}

/// A low-pass filter.
#[derive(Clone, Debug, Default)]
pub struct FilterKeys {
    /// Its order.
    pub order: Slot<u32>,
    /// Where it takes half.
    pub cut_off: Slot<Quantity>,
    /// Rows per time.
    pub rate: Slot<Quantity>,
}

/// Zero of a bench.
#[derive(Clone, Debug, Default)]
pub struct Offset {
    /// Of the abscissa.
    pub x: Slot<Value>,
    /// Of the ordinate.
    pub y: Slot<Value>,
}

/// Parameters from a measured curve.
#[derive(Clone, Debug, Default)]
pub struct Calibrate {
    /// Name of the measurement.
    pub measurement: Slot<String>,
    /// Which part of it.
    pub branch: Slot<&'static str>,
    /// How much far points count.
    pub loss: Slot<&'static str>,
    /// Confidence of all intervals.
    pub confidence: Slot<Quantity>,
    /// What is looked for, by paths or patterns of paths.
    pub parameters: Vec<Member<Sought>>,
}

/// How a number is looked for.
#[derive(Clone, Debug, Default)]
pub struct Sought {
    /// From the first to the second value.
    pub range: Slot<Value>,
    /// What is known of it already.
    pub prior: Slot<Value>,
}

const DECIMALS: &[Word] =
    &[Word { word: "point", doc: "12.5" }, Word { word: "comma", doc: "12,5; columns are then separated by semicolons" }];

/// Parts of a record.
pub const BRANCHES: &[Word] = &[
    Word { word: "both", doc: "all of it" },
    Word { word: "loading", doc: "where the abscissa grows" },
    Word { word: "unloading", doc: "where it becomes smaller" },
];

/// Losses of far points.
pub const LOSSES: &[Word] = &[
    Word { word: "squares", doc: "every point counts the same" },
    Word { word: "huber", doc: "far points count by their distance, not its square" },
    Word { word: "soft_l1", doc: "the same, more gently" },
    Word { word: "tukey", doc: "far points do not count at all" },
];

const MOST_ORDER: f64 = 8.0;
const MOST_FREQUENCY_HZ: f64 = 1e9;

impl Describe for Measurements {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.tables(&Param::new("*", "A measured curve, by a name of your own: `[measurements.curve]`."), &mut self.each);
    }
}

impl Describe for Measurement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.file(
            &Param::new("file", "CSV file whose header names columns with their units, `travel / mm, force / N`.").required(),
            &mut self.file,
        );
        v.text(&Param::new("x", "Column of the abscissae, as its header names it: `\"travel / mm\"`.").required(), &mut self.x);
        v.text(&Param::new("y", "Column of the ordinates: `\"force / N\"`.").required(), &mut self.y);
        v.choice(&Param::new("decimal", "How its numbers are written.").default("point"), DECIMALS, &mut self.decimal);
        self.filter.describe(v, &Param::new("filter", "Butterworth's low-pass filter without delay, over rows taken at even times."));
        self.offset.describe(v, &Param::new("offset", "What the bench shows at rest; taken off the measured values."));
        v.deferred(
            &Param::new("compliance", "How much of the abscissa the bench takes itself, per ordinate: `\"2e-6 m/N\"`."),
            &mut self.compliance,
        );
    }
}

impl Describe for FilterKeys {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("order", "Order of one pass.").within(1.0, MOST_ORDER).default("4"), &mut self.order);
        let frequency = |key, doc| Param::new(key, doc).of(Dimension::Frequency).above(0.0, MOST_FREQUENCY_HZ).required();
        v.quantity(&frequency("cut_off", "Where it takes half of the amplitude."), &mut self.cut_off);
        v.quantity(&frequency("rate", "Rows per second."), &mut self.rate);
    }
}

impl Describe for Offset {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.deferred(&Param::new("x", "Abscissa at rest."), &mut self.x);
        v.deferred(&Param::new("y", "Ordinate at rest."), &mut self.y);
    }
}

impl Describe for Calibrate {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(
            &Param::new("measurement", "Name of a table of `[measurements]`; may be left out if there is only one."),
            &mut self.measurement,
        );
        v.choice(&Param::new("branch", "Which part of it.").default("both"), BRANCHES, &mut self.branch);
        v.choice(&Param::new("loss", "How much far points count.").default("squares"), LOSSES, &mut self.loss);
        v.quantity(&Param::new("confidence", "Of all intervals.").within(0.5, 0.999).default("95 %"), &mut self.confidence);
        v.members(
            &Param::new("parameters", "What is looked for: a path, a pattern with `*`, or a number of the bench, `\"bench.offset\"`.")
                .required(),
            Form::Table,
            &mut self.parameters,
        );
    }
}

impl Describe for Sought {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.deferred(&Param::new("range", "Smallest and largest value, `[\"1 GPa\", \"4 GPa\"]`."), &mut self.range);
        v.deferred(&Param::new("prior", "What is known of it, `\"2 GPa ± 0.2 GPa\"`; ± is three standard deviations."), &mut self.prior);
    }
}

/// Sections whose numbers may be looked for.
const ROOTS: [&str; 9] = ["design", "material", "errors", "losses", "environment", "inertia", "hand", "motor", "bench"];
/// Numbers of the bench.
const BENCH: [(&str, BenchParameter); 3] = [
    ("bench.offset.x", BenchParameter::OffsetX),
    ("bench.offset.y", BenchParameter::OffsetY),
    ("bench.compliance", BenchParameter::Compliance),
];
/// How near a range comes to a smallest value that is excluded, as part of the distance of the present value.
const LEAST_PART: f64 = 1e-3;

/// A number of the design that is looked for.
#[derive(Clone, Debug)]
pub struct OfDesign {
    /// The number, with its limits.
    pub free: Free,
    /// What is known of it.
    pub prior: Option<Prior>,
}

/// A number of the bench that is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct OfBench {
    /// Its path.
    pub path: &'static str,
    /// Which.
    pub which: BenchParameter,
    /// Its limits; infinite where none were typed.
    pub limits: Limits,
    /// What is known of it.
    pub prior: Option<Prior>,
    /// Where its range stands; without one, its path.
    pub span: Span,
}

/// What is looked for.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Of the design, in its order.
    pub design: Vec<OfDesign>,
    /// Of the bench.
    pub bench: Vec<OfBench>,
}

/// A unit in which a deferred value is read.
#[derive(Clone, Debug)]
enum Kind {
    Of(Dimension),
    /// Abscissa over ordinate.
    Compliance([Dimension; 2]),
}

impl Calibrate {
    /// How much far points count.
    pub fn loss(&self) -> Loss {
        match self.loss.as_ref().map_or("squares", |l| l.value) {
            "huber" => Loss::Huber,
            "soft_l1" => Loss::SoftL1,
            "tukey" => Loss::Tukey,
            _ => Loss::Squares,
        }
    }

    /// Confidence of all intervals.
    pub fn confidence(&self) -> Confidence {
        self.confidence.as_ref().and_then(|c| Confidence::new(c.value.si)).unwrap_or(Confidence::P95)
    }

    /// The measurement that is meant.
    pub fn of<'a>(&self, all: &'a Measurements, place: Span, diagnostics: &mut Diagnostics) -> Option<&'a Member<Measurement>> {
        let names = || all.each.iter().map(|m| format!("`{}`", m.name.value)).collect::<Vec<_>>().join(", ");
        let (span, message, help) = match (&self.measurement, &all.each[..]) {
            (_, []) => {
                let help = "add `[measurements.curve]` with `file`, `x` and `y`";
                (place, "there is no measurement".to_owned(), help.to_owned())
            }
            (None, [only]) => return Some(only),
            (None, _) => (place, "which measurement?".to_owned(), format!("add `measurement = …`, one of {}", names())),
            (Some(name), all) => match all.iter().find(|m| m.name.value == name.value) {
                Some(found) => return Some(found),
                None => (name.span, format!("there is no measurement `{}`", name.value), format!("the file has {}", names())),
            },
        };
        diagnostics.push(Diagnostic::error("E0901", span, message).label("of this calibration").help(help));
        None
    }

    /// What is looked for, with abscissa and ordinate of these quantities.
    pub fn wanted(&self, numbers: &[Number], axes: [Dimension; 2], diagnostics: &mut Diagnostics) -> Option<Wanted> {
        let before = diagnostics.errors();
        let mut design: Vec<Option<OfDesign>> = vec![None; numbers.len()];
        let mut bench: Vec<Option<OfBench>> = vec![None; BENCH.len()];
        for Member { name, value } in &self.parameters {
            if name.value == "bench" || name.value.starts_with("bench.") {
                of_bench(name, value, axes, &mut bench, diagnostics);
                continue;
            }
            for index in chosen(name, &ROOTS, numbers, diagnostics) {
                // The later, usually the narrower pattern, wins.
                design[index] = value.of_number(&numbers[index], name.span, diagnostics);
            }
        }
        let wanted = Wanted { design: design.into_iter().flatten().collect(), bench: bench.into_iter().flatten().collect() };
        (diagnostics.errors() == before).then_some(wanted)
    }
}

fn of_bench(name: &Located<String>, sought: &Sought, [x, y]: [Dimension; 2], bench: &mut [Option<OfBench>], diagnostics: &mut Diagnostics) {
    let mut any = false;
    for ((path, which), slot) in BENCH.iter().zip(bench).filter(|((path, _), _)| matches(&name.value, path)) {
        any = true;
        let kind = match which {
            BenchParameter::OffsetX => Kind::Of(x),
            BenchParameter::OffsetY => Kind::Of(y),
            BenchParameter::Compliance => Kind::Compliance([x, y]),
        };
        let limits = sought.range.as_ref().map_or(Some([f64::NEG_INFINITY, f64::INFINITY]), |r| kind.range(r, diagnostics));
        let prior = sought.prior.as_ref().map(|p| kind.prior(p, diagnostics));
        if let (Some([lower, upper]), None | Some(Some(_))) = (limits, &prior) {
            let span = sought.range.as_ref().map_or(name.span, |r| r.span);
            *slot = Some(OfBench { path, which: *which, limits: Limits { lower, upper }, prior: prior.flatten(), span });
        }
    }
    if !any {
        diagnostics.push(
            Diagnostic::error("E0903", name.span, format!("`{}` is no number of the bench", name.value))
                .label("no such number")
                .help("write \"bench.offset.x\", \"bench.offset.y\", \"bench.offset\" for both, or \"bench.compliance\""),
        );
    }
}

/// Symbol of a unit of the abscissa per one of the ordinate, as people write it.
pub fn per(x: &str, y: &str) -> String {
    match y {
        "" | "1" => x.to_owned(),
        y if y.contains(['*', '/', '·']) => format!("{x}/({y})"),
        y => format!("{x}/{y}"),
    }
}

/// A unit with one pair of brackets behind a stroke, without them: `deg/(N*m)` is `deg/N/m`. `None` for other brackets.
fn without_brackets(unit: &str) -> Option<String> {
    let Some((before, rest)) = unit.split_once('(') else { return Some(unit.to_owned()) };
    let (inside, after) = rest.split_once(')')?;
    let before = before.trim_end().strip_suffix('/')?;
    if [before, inside, after].iter().any(|part| part.contains(['(', ')'])) {
        return None;
    }
    let turned = |c: char| match c {
        '*' | '·' | '⋅' | '×' => '/',
        '/' => '*',
        other => other,
    };
    Some(format!("{before}/{}{after}", inside.chars().map(turned).collect::<String>()))
}

impl Kind {
    fn range(&self, slot: &Located<Value>, diagnostics: &mut Diagnostics) -> Option<[f64; 2]> {
        let values = match (self, &slot.value) {
            (Self::Of(dimension), _) => deferred_quantities(slot, *dimension, diagnostics)?,
            (Self::Compliance(axes), Value::List(items)) => {
                let each = items.iter().map(|i| compliance(&Located::new(i.value.clone(), i.span), *axes, diagnostics));
                each.collect::<Option<Vec<_>>>()?.into_iter().map(|[value, _]| value).collect()
            }
            (Self::Compliance(_), _) => Vec::new(),
        };
        match values[..] {
            [low, high] if low < high => Some([low, high]),
            _ => {
                let error = Diagnostic::error("E0906", slot.span, "a range is a smaller and a larger value").label("this range");
                diagnostics.push(error.help("write it as `range = [\"low\", \"high\"]`"));
                None
            }
        }
    }

    fn prior(&self, slot: &Located<Value>, diagnostics: &mut Diagnostics) -> Option<Prior> {
        let [mean, half] = match self {
            Self::Of(dimension) => {
                let quantity = deferred_quantity(slot, *dimension, diagnostics)?;
                let half = quantity.deviations_si().map_or(0.0, |[low, high]| 0.5 * (high - low));
                [quantity.si, half]
            }
            Self::Compliance(axes) => compliance(slot, *axes, diagnostics)?,
        };
        if half > 0.0 {
            return Some(Prior { mean, sd: half / SIGMAS_IN_TOLERANCE });
        }
        diagnostics.push(
            Diagnostic::error("E0902", slot.span, "a prior says how well its value is known")
                .label("without `±`")
                .help("write it as `prior = \"2 GPa ± 0.2 GPa\"`: three standard deviations"),
        );
        None
    }
}

/// A number and the unit behind it, with or without a blank between.
fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let most = text.find(|c: char| !c.is_ascii_digit() && !"+-.eE".contains(c)).unwrap_or(text.len());
    let value = |end: usize| text[..end].parse::<f64>().ok().filter(|v| v.is_finite());
    (1..=most).rev().find_map(|end| Some((value(end)?, text[end..].trim())))
}

/// A compliance and its half width, 0 without one, as they are written, SI.
fn compliance_of(text: &str, [x, y]: [Dimension; 2]) -> Option<[f64; 2]> {
    let in_unit = |value: f64, unit: &str| {
        // Times an ordinate it is an abscissa.
        let whole = Unit::parse(&format!("{}*{}", without_brackets(unit)?, y.si_symbol())).ok().filter(|whole| whole.is(x))?;
        Some(whole.to_si(value)).filter(|v| v.is_finite())
    };
    let text = text.replace('−', "-").replace("+/-", "±").replace("+-", "±");
    let Some((value, half)) = text.split_once('±') else {
        let (value, unit) = number_and_unit(&text)?;
        return Some([if unit.is_empty() && value.abs() <= 0.0 { 0.0 } else { in_unit(value, unit)? }, 0.0]);
    };
    let ((value, unit), (half, of_half)) = (number_and_unit(value)?, number_and_unit(half)?);
    // As of other quantities the unit may be written once, before or behind `±`.
    let unit = if unit.is_empty() && of_half != "%" { of_half } else { unit };
    let value = in_unit(value, unit)?;
    Some([value, if of_half == "%" { 0.01 * half * value.abs() } else { in_unit(half, if of_half.is_empty() { unit } else { of_half })? }])
}

/// A compliance and its half width, 0 without one, SI.
fn compliance(slot: &Located<Value>, axes: [Dimension; 2], diagnostics: &mut Diagnostics) -> Option<[f64; 2]> {
    let found = match &slot.value {
        Value::Text(text) => compliance_of(text, axes),
        Value::Number(value) if value.abs() <= 0.0 => Some([0.0; 2]),
        _ => None,
    };
    if found.is_none() {
        let [x, y] = axes.map(Dimension::si_symbol);
        diagnostics.push(
            Diagnostic::error("E0910", slot.span, "this is no compliance of a bench")
                .label(format!("expected {x} per {y}, or other units of the same"))
                .help(format!("write it as \"2e-6 {}\"", per(x, y))),
        );
    }
    found
}

impl Wanted {
    /// Least number of points that tell something of so many parameters.
    pub fn least_points(&self) -> usize {
        self.design.len() + self.bench.len() + 2
    }

    /// Whether the search for numbers of the bench begins inside their ranges; an error where it does not.
    pub fn begins_inside(&self, measurement: &Measurement, bench: &Bench, diagnostics: &mut Diagnostics) -> bool {
        let before = diagnostics.errors();
        for own in &self.bench {
            let (value, typed) = match own.which {
                BenchParameter::OffsetX => (bench.offset[0], &measurement.offset.x),
                BenchParameter::OffsetY => (bench.offset[1], &measurement.offset.y),
                BenchParameter::Compliance => (bench.compliance, &measurement.compliance),
            };
            if (own.limits.lower..=own.limits.upper).contains(&value) {
                continue;
            }
            let mut error = Diagnostic::error("E0906", own.span, format!("`{}` does not lie in its range", own.path)).label("this range");
            error = match typed {
                Some(typed) => error.related(typed.span, "its value"),
                None => error.label("this range; without a value in the measurement it is 0"),
            };
            diagnostics.push(error.help("the search starts at the value in the file: change it, or the range"));
        }
        diagnostics.errors() == before
    }
}

impl Sought {
    fn of_number(&self, number: &Number, place: Span, diagnostics: &mut Diagnostics) -> Option<OfDesign> {
        let kind = Kind::Of(number.dimension);
        let range = match &self.range {
            None => None,
            Some(range) => Some(kind.range(range, diagnostics)?),
        };
        let prior = match &self.prior {
            None => None,
            Some(prior) => Some(kind.prior(prior, diagnostics)?),
        };
        // A smallest value that is itself excluded is approached to a part of the distance to it.
        let least = number.range.min + if number.range.above { LEAST_PART * (number.si - number.range.min) } else { 0.0 };
        let [lower, upper] = range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let (lower, upper) = (lower.max(least), upper.min(number.range.max));
        if lower < upper && (lower..=upper).contains(&number.si) {
            return Some(OfDesign { free: Free { number: number.clone(), lower, upper }, prior });
        }
        diagnostics.push(
            Diagnostic::error(
                "E0906",
                self.range.as_ref().map_or(place, |r| r.span),
                format!("`{}` does not lie in its range", number.path),
            )
            .label("this range")
            .related(number.span, "its value")
            .help("the search starts at the value in the file: change it, or the range"),
        );
        None
    }
}

impl Measurement {
    /// The zero and the compliance of the bench.
    pub fn bench(&self, [x, y]: [Dimension; 2], diagnostics: &mut Diagnostics) -> Option<Bench> {
        let mut of = |slot: &Slot<Value>, dimension| match slot {
            None => Some(0.0),
            Some(slot) => deferred_quantity(slot, dimension, diagnostics).map(|q| q.si),
        };
        let offset = [of(&self.offset.x, x), of(&self.offset.y, y)];
        let compliance = match &self.compliance {
            None => Some(0.0),
            Some(slot) => compliance(slot, [x, y], diagnostics).map(|[value, _]| value),
        };
        let [Some(x), Some(y)] = offset else { return None };
        Some(Bench { offset: [x, y], compliance: compliance? })
    }
}
