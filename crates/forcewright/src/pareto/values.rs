//! What is varied: a key of the project file and the values that it may have.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_contract::describe::Member;
use forcewright_contract::numbers::Number;
use forcewright_contract::studies::Varied;
use forcewright_contract::tree::{Item, Table, Value};
use forcewright_study::pareto::Kind;

use crate::settings::{typed, value_at};
use crate::sweep::axis::{Ends, ends, plain, read};

/// Significant digits of values between the ends of a range: what can be made, and read.
const DIGITS: usize = 6;
/// The same of a tolerance.
const TOLERANCE_DIGITS: usize = 12;
/// Most values of a list, and most steps of a range.
const MOST: usize = 1_000_000;
/// How near to a whole number of steps a range must be.
const WHOLE: f64 = 1e-9;
/// What a trade-off never changes: what the project is, what is asked of it, and what is asked of studies.
const FIXED: [&str; 10] =
    ["schema", "mechanism", "title", "extends", "variants", "requirements", "optimise", "pareto", "tolerance", "synthesise"];

/// A key of the project file with its values.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The path, as for `--set`.
    pub key: String,
    /// Quantity of its values, if they are numbers.
    pub dimension: Option<Dimension>,
    values: Values,
    /// What stands behind every value of a range: the tolerance of the file.
    tolerance: String,
    /// Where its path stands.
    pub(super) place: Span,
    /// Where the values of [`Self::telling`] stand.
    places: Vec<Span>,
}

#[derive(Clone, Debug)]
enum Values {
    /// Any between two ends.
    Real(Ends),
    /// So many steps of this part of the way between the ends.
    Steps { ends: Ends, part: f64, count: i64 },
    /// Whole numbers.
    Whole(i64, i64),
    /// As typed.
    Among(Vec<String>),
}

impl Choice {
    /// What a member of `[pareto.vary]` says; `numbers` are those of the project.
    pub(super) fn of(member: &Member<Varied>, numbers: &[Number], diagnostics: &mut Diagnostics) -> Option<Self> {
        let key = member.name.value.clone();
        let mistake = |span: Span, why: String| {
            Diagnostic::error("E0921", span, why)
                .label("here")
                .help("write `{ range = [\"8 mm\", \"12 mm\"] }`, perhaps with `step = \"0.5 mm\"`, or `{ among = [\"8 mm\", \"10 mm\"] }`")
        };
        let root = key.split('.').next().unwrap_or("");
        if FIXED.contains(&root) || key.contains('*') || key.split('.').any(|part| part.trim().is_empty()) || key.contains('=') {
            let why = if FIXED.contains(&root) { "is the same for all designs" } else { "is not the path of one key" };
            diagnostics.push(mistake(member.name.span, format!("`{}` {why}", key.chars().take(60).collect::<String>())));
            return None;
        }
        let number = numbers.iter().find(|n| n.path == key);
        let found = match (&member.value.range, &member.value.among) {
            (Some(range), None) => range_of(&range.value, member.value.step.as_ref().map(|s| &s.value), number.is_some())
                .map_err(|why| mistake(range.span, why)),
            (None, Some(among)) if member.value.step.is_none() => list_of(&among.value).map_err(|why| mistake(among.span, why)),
            (None, Some(_)) => Err(mistake(member.name.span, "`step` belongs to a `range`".to_owned())),
            (Some(_), Some(_)) => Err(mistake(member.name.span, "`range` and `among` exclude each other".to_owned())),
            (None, None) => Err(mistake(member.name.span, "which values may it have?".to_owned())),
        };
        let values = match found {
            Ok(values) => values,
            Err(diagnostic) => {
                diagnostics.push(diagnostic);
                return None;
            }
        };
        let tolerance = match (number.and_then(|n| Some((n, n.tolerance.as_ref()?))), &values) {
            (None, _) | (_, Values::Whole(..) | Values::Among(_)) => String::new(),
            (Some((number, tolerance)), _) => tolerance.suffix(&number.unit, TOLERANCE_DIGITS),
        };
        let written = member.value.range.as_ref().or(member.value.among.as_ref());
        let places = match written.map(|w| &w.value) {
            Some(Value::List(items)) => items.iter().map(|item| item.span).collect(),
            _ => Vec::new(),
        };
        let mut choice = Self { key, dimension: None, values, tolerance, place: member.name.span, places };
        choice.dimension = choice.common_dimension();
        Some(choice)
    }

    fn common_dimension(&self) -> Option<Dimension> {
        let mut all = self.telling().into_iter().map(|text| read(plain(&text)).ok().map(|(_, dimension)| dimension));
        let first = all.next()??;
        all.all(|other| other == Some(first)).then_some(first)
    }

    /// What kind of variable it is for a search.
    pub(super) fn kind(&self) -> Kind {
        match &self.values {
            Values::Real(_) => Kind::Real { lower: 0.0, upper: 1.0 },
            Values::Steps { count, .. } => Kind::Whole { lower: 0, upper: *count },
            Values::Whole(lower, upper) => Kind::Whole { lower: *lower, upper: *upper },
            Values::Among(all) => Kind::Choice { count: all.len() },
        }
    }

    /// A value of the search as it would be typed: a part of the range, a number of steps, a whole number, a place in a list.
    pub(super) fn text(&self, x: f64) -> String {
        match &self.values {
            Values::Real(ends) => ends.at(x) + &self.tolerance,
            Values::Steps { ends, part, .. } => ends.at(x * part) + &self.tolerance,
            Values::Whole(..) => format!("{x:.0}"),
            Values::Among(all) => {
                let place = (0..all.len()).find(|i| (*i as f64 - x).abs() < 0.5);
                place.and_then(|i| all.get(i)).cloned().unwrap_or_default()
            }
        }
    }

    /// The SI value of a text that [`Self::text`] gave, if it is a number.
    pub(super) fn si(&self, text: &str) -> Option<f64> {
        Quantity::parse(plain(text), self.dimension?).ok().map(|q| q.si)
    }

    /// Its values in words.
    pub fn in_words(&self) -> String {
        match &self.values {
            Values::Real(_) => format!("{} to {}", self.text(0.0), self.text(1.0)),
            Values::Steps { count, .. } => format!("{} to {} in {count} steps", self.text(0.0), self.text(*count as f64)),
            Values::Whole(lower, upper) => format!("{lower} to {upper}"),
            Values::Among(all) => all.join(", "),
        }
    }

    /// The values that show every mistake: the ends of a range, every entry of a list.
    pub(super) fn telling(&self) -> Vec<String> {
        match &self.values {
            Values::Real(_) => vec![self.text(0.0), self.text(1.0)],
            Values::Steps { count, .. } => vec![self.text(0.0), self.text(*count as f64)],
            Values::Whole(lower, upper) => vec![lower.to_string(), upper.to_string()],
            Values::Among(all) => all.clone(),
        }
    }

    /// What the project has, as typed.
    pub(super) fn typed(&self, tree: &Table) -> Option<String> {
        match value_at(tree, &self.key)? {
            Value::Text(text) => Some(text.clone()),
            other => typed(other),
        }
    }

    /// The unit of its values, if they are numbers.
    pub(super) fn unit(&self) -> Option<Unit> {
        let first = self.telling().into_iter().next()?;
        Quantity::parse(plain(&first), self.dimension?).ok().map(|q| q.unit)
    }

    /// Where the value of this index of [`Self::telling`] stands.
    pub(super) fn place_of(&self, index: usize) -> Span {
        self.places.get(index).copied().unwrap_or(self.place)
    }

    /// Where the value of the project stands among them, if it is one of them.
    pub(super) fn present(&self, tree: &Table) -> Option<f64> {
        let now = value_at(tree, &self.key)?;
        let same = |a: &str, b: &str| a == b || self.si(a).zip(self.si(b)).is_some_and(|(a, b)| (a - b).abs() <= 1e-12 * b.abs());
        match (&self.values, now) {
            (Values::Whole(lower, upper), Value::Number(n)) => (*lower as f64..=*upper as f64).contains(n).then_some(*n),
            (Values::Among(all), now) => {
                let now = now.to_string();
                all.iter().position(|own| *own == now || same(own, plain(&now))).map(|i| i as f64)
            }
            (Values::Real(ends) | Values::Steps { ends, .. }, now) => {
                let text = match now {
                    Value::Text(text) => text.clone(),
                    other => other.to_string(),
                };
                let quantity = Quantity::parse(&text, self.dimension?).ok()?;
                let [from, to] = [ends.at(0.0), ends.at(1.0)].map(|end| self.si(&end));
                let part = (quantity.si - from?) / (to? - from?);
                let place = if let Values::Steps { part: step, .. } = &self.values { (part / step).round() } else { part };
                (0.0..=1.0).contains(&part).then_some(place)
            }
            _ => None,
        }
    }
}

fn range_of(range: &Value, step: Option<&Value>, is_number: bool) -> Result<Values, String> {
    let Value::List(items) = range else { return Err("a range is a smallest and a largest value".to_owned()) };
    let [from, to] = items.as_slice() else { return Err("a range is a smallest and a largest value".to_owned()) };
    let text = |item: &Item| typed(&item.value).ok_or_else(|| "the ends of a range are numbers".to_owned());
    let (first, last) = (text(from)?, text(to)?);
    if let (Value::Number(a), Value::Number(b), false, None) = (&from.value, &to.value, is_number, step) {
        // What is counted stands in no list of numbers with units.
        let whole = |v: f64| format!("{v:.0}").parse::<i64>().ok().filter(|n| (*n as f64 - v).abs() < WHOLE && n.abs() < 1 << 32);
        if let Some((a, b)) = whole(*a).zip(whole(*b)) {
            return if a < b { Ok(Values::Whole(a, b)) } else { Err("the first value of a range is the smaller one".to_owned()) };
        }
    }
    let ends = ends(&first, &last)?;
    let [a, b] = ends.both();
    if a >= b {
        return Err("the first value of a range is the smaller one".to_owned());
    }
    let Some(step) = step else { return Ok(Values::Real(ends.with_digits(DIGITS))) };
    let step = typed(step).and_then(|text| read(&text).ok()).ok_or("a step is a positive number with its unit")?;
    let (low, high) = (read(&ends.at(0.0)), read(&ends.at(1.0)));
    let (Ok((low, dimension)), Ok((high, _))) = (low, high) else { return Err("the ends of a range are numbers".to_owned()) };
    let part = step.0.si / (high.si - low.si);
    if step.1 != dimension || !(part > 0.0 && part <= 1.0 + WHOLE) {
        return Err("a step is a positive number of the same unit, and at most as long as the range".to_owned());
    }
    let count = (1.0 / part).round();
    if (count * part - 1.0).abs() > WHOLE * count {
        return Err("the range is not a whole number of steps long".to_owned());
    }
    if count > MOST as f64 {
        return Err(format!("more than {MOST} steps"));
    }
    let count = format!("{count:.0}").parse().map_err(|_| "too many steps".to_owned())?;
    Ok(Values::Steps { ends, part: 1.0 / count as f64, count })
}

fn list_of(among: &Value) -> Result<Values, String> {
    let Value::List(items) = among else { return Err("`among` is a list".to_owned()) };
    let all: Option<Vec<String>> = items.iter().map(|item| typed(&item.value)).collect();
    let all = all.ok_or("its entries are quantities, numbers or words")?;
    if all.is_empty() || all.len() > MOST {
        return Err("there is nothing to choose from".to_owned());
    }
    if let Some(twice) = (1..all.len()).find(|i| all[..*i].contains(&all[*i])) {
        return Err(format!("`{}` is listed twice", all[twice]));
    }
    Ok(Values::Among(all))
}
