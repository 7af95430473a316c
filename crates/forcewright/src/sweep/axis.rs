//! What is varied: a key of the project file and the values that it takes.

use forcewright_base::text::closest;
use forcewright_base::units::{Dimension, Quantity, QuantityError, Unit};
use forcewright_contract::family::Family;

use super::{SweepError, refused_call};

/// Most values of one range.
const MOST_VALUES: u64 = 1_000_000_000;
/// Significant digits of the values of a range, of the larger of its ends.
const DIGITS: i32 = 15;

/// A key of the project file and the values that it takes, read from `KEY=SPEC`.
///
/// | SPEC | values |
/// | --- | --- |
/// | `0.8mm..1.2mm:9` | nine, evenly spaced, both ends included; the unit may be written once, `0.8..1.2mm:9` |
/// | `0.8mm,1mm,1.2mm` | a list: quantities, numbers, words, or lists in brackets |
/// | `sobol(0.8mm..1.2mm)` | a space-filling sample together with the other keys of this kind |
///
/// Values between the ends of a range are rounded to fifteen significant digits of the larger end, so that they are the decimals that
/// people write: 0.85 mm, not 0.8500000000000001 mm.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The dotted path, as in `--set`.
    pub key: String,
    /// What was typed after the first `=`.
    pub spec: String,
    pub(super) values: Values,
}

#[derive(Clone, Debug)]
pub(super) enum Values {
    /// So many, evenly spaced.
    Range(Ends, u64),
    /// As typed.
    List(Vec<String>),
    /// Anywhere between the ends.
    Sample(Ends),
}

/// Two ends in one unit.
#[derive(Clone, Debug)]
pub(crate) struct Ends {
    from: f64,
    to: f64,
    /// Both as typed, with the unit: what is typed is what is taken.
    texts: [String; 2],
    /// As typed; empty for a bare number.
    symbol: String,
    dimension: Dimension,
    decimals: usize,
}

impl Axis {
    /// Reads `KEY=SPEC`.
    ///
    /// # Errors
    /// E0130 for a text that is not understood, with an example.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        Self::parse_for("--vary", text)
    }

    /// The same for another option of the command line, which is named in messages.
    ///
    /// # Errors
    /// E0130 for a text that is not understood, with an example.
    pub fn parse_for(option: &str, text: &str) -> Result<Self, SweepError> {
        let mistake = |text: &str, why: &str| mistake(option, text, why);
        let Some((key, spec)) = text.split_once('=') else {
            return Err(mistake(text, "it has no `=`"));
        };
        let (key, spec) = (key.trim(), spec.trim());
        if key.is_empty() || key.split('.').any(|part| part.trim().is_empty()) {
            return Err(mistake(text, "the key is not a dotted path"));
        }
        if text.contains(char::is_control) {
            return Err(mistake(text, "it has control characters"));
        }
        if ["mechanism", "schema"].contains(&key) {
            return Err(mistake(text, &format!("`{key}` is the same for all designs")));
        }
        let values = values_of(spec).map_err(|why| mistake(text, &why))?;
        Ok(Self { key: key.to_owned(), spec: spec.to_owned(), values })
    }

    /// How many values it takes by itself; `None` for a sample, whose points are counted together.
    pub fn len(&self) -> Option<u64> {
        match &self.values {
            Values::Range(_, count) => Some(*count),
            Values::List(items) => Some(items.len() as u64),
            Values::Sample(_) => None,
        }
    }

    /// Whether it has no values; never.
    pub fn is_empty(&self) -> bool {
        self.len() == Some(0)
    }

    /// A value by its place, from 0, as it would be typed; of a sample at the place's fraction of the range.
    pub(super) fn value(&self, place: Place) -> String {
        match (&self.values, place) {
            (Values::Range(ends, count), Place::Nth(at)) => match at {
                0 => ends.texts[0].clone(),
                at if at + 1 >= *count => ends.texts[1].clone(),
                at => ends.at(at as f64 / (*count - 1) as f64),
            },
            (Values::List(items), Place::Nth(at)) => {
                usize::try_from(at).ok().and_then(|at| items.get(at)).or(items.last()).cloned().unwrap_or_default()
            }
            (Values::Sample(ends) | Values::Range(ends, _), Place::Fraction(u)) => ends.at(u),
            (Values::Sample(ends), Place::Nth(_)) => ends.texts[0].clone(),
            (Values::List(items), Place::Fraction(_)) => items.first().cloned().unwrap_or_default(),
        }
    }

    /// The values that show every mistake of the text: the ends of a range, every entry of a list.
    pub(super) fn telling(&self) -> Vec<String> {
        match &self.values {
            Values::Range(ends, _) | Values::Sample(ends) => ends.texts.to_vec(),
            Values::List(items) => items.clone(),
        }
    }

    /// All its values as typed, `most` at the most; `None` for a sample.
    pub(crate) fn listed(&self, most: u64) -> Option<Vec<String>> {
        Some((0..self.len()?.min(most)).map(|at| self.value(Place::Nth(at))).collect())
    }

    /// The unit of its values, if they are numbers of one quantity: that of the first.
    pub(crate) fn unit(&self) -> Option<Unit> {
        self.dimension()?;
        self.telling().first().and_then(|text| read(plain(text)).ok()).map(|(quantity, _)| quantity.unit)
    }

    /// Quantity of its values, if they are numbers of one quantity.
    pub(crate) fn dimension(&self) -> Option<Dimension> {
        match &self.values {
            Values::Range(ends, _) | Values::Sample(ends) => Some(ends.dimension),
            Values::List(items) => {
                let mut all = items.iter().map(|item| read(plain(item)).ok().map(|(_, dimension)| dimension));
                let first = all.next()??;
                all.all(|other| other == Some(first)).then_some(first)
            }
        }
    }

    /// The SI value of a text that [`Self::value`] gave, if it is a number.
    pub(crate) fn si(&self, value: &str) -> Option<f64> {
        Quantity::parse(plain(value), self.dimension()?).ok().map(|q| q.si)
    }

    /// The entries of a list that are no numbers.
    pub(super) fn words(&self) -> Option<&[String]> {
        match &self.values {
            Values::List(items) if self.dimension().is_none() => Some(items),
            _ => None,
        }
    }
}

/// A place among the values of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// From 0.
    Nth(u64),
    /// Between the ends, 0 to 1.
    Fraction(f64),
}

impl Ends {
    /// Both ends, in their unit.
    pub(crate) fn both(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// The same with values of so many significant digits of the larger end.
    pub(crate) fn with_digits(mut self, digits: usize) -> Self {
        self.decimals = (self.decimals + digits).saturating_sub(usize::try_from(DIGITS).unwrap_or(0));
        self
    }

    /// The value at a part of the way from one end to the other.
    pub(crate) fn at(&self, fraction: f64) -> String {
        let value = self.from * (1.0 - fraction) + self.to * fraction;
        let digits = format!("{value:.*}", self.decimals);
        let digits = if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
        let digits = if digits == "-0" { "0" } else { digits };
        with_unit(digits, &self.symbol)
    }
}

fn with_unit(digits: &str, symbol: &str) -> String {
    if symbol.is_empty() { digits.to_owned() } else { format!("{digits} {symbol}") }
}

fn mistake(option: &str, text: &str, why: &str) -> SweepError {
    let shown: String = text.chars().take(80).collect();
    refused_call(
        "E0130",
        format!("`{option} {shown}` is not understood: {why}"),
        "write a range `design.thickness=0.8mm..1.2mm:9`, a list `design.thickness=0.8mm,1mm`, or words `model.beam=reissner,inextensible`",
    )
}

fn values_of(spec: &str) -> Result<Values, String> {
    if let Some(inside) = spec.strip_prefix("sobol(") {
        let inside = inside.strip_suffix(')').ok_or("the bracket is not closed")?;
        let (from, to) = inside.split_once("..").ok_or("a sample needs two ends, `sobol(0.8mm..1.2mm)`")?;
        return ends(from, to).map(Values::Sample);
    }
    let items = split_list(spec)?;
    if let [_] = items.as_slice()
        && let Some((from, rest)) = spec.split_once("..").filter(|(from, _)| !from.is_empty())
        && !spec.starts_with(['[', '{', '"', '\''])
    {
        let (to, count) = rest.rsplit_once(':').ok_or("a range says how many values it has, `0.8mm..1.2mm:9`")?;
        let count = count.trim().parse::<u64>().map_err(|_| format!("`{}` is no number of values", count.trim()))?;
        if count < 2 {
            return Err(format!("a range has two values or more, not {count}; write a single value without `..`"));
        }
        if count > MOST_VALUES {
            return Err(format!("{count} values are too many; at most {MOST_VALUES}"));
        }
        return Ok(Values::Range(ends(from, to)?, count));
    }
    for (at, item) in items.iter().enumerate() {
        if items[..at].contains(item) {
            return Err(format!("`{item}` is listed twice"));
        }
        if item.split_once("..").is_some_and(|(from, _)| read(from).is_ok()) {
            return Err(format!("`{item}` in a list: a range stands alone, and decimals have a point"));
        }
        if plain(item).parse::<f64>().is_ok_and(|value| !value.is_finite()) {
            return Err(format!("`{item}` is not a finite number"));
        }
    }
    Ok(Values::List(items))
}

/// The two ends of a range; the unit may stand at the second alone.
pub(crate) fn ends(from: &str, to: &str) -> Result<Ends, String> {
    let read_end = |text: &str| read(text).map_err(|e| quantity_mistake(text, &e));
    let (last, dimension) = read_end(to)?;
    let bare = Quantity::parse(from, Dimension::Ratio).is_ok_and(|q| q.unit.symbol().is_empty());
    let from = if bare { with_unit(from.trim(), last.unit.symbol()) } else { from.trim().to_owned() };
    let (first, other) = read_end(&from)?;
    if first.tolerance.is_some() || last.tolerance.is_some() {
        return Err("the ends of a range have no tolerances".to_owned());
    }
    if other != dimension {
        return Err(format!("its ends are {} and {}", other.name(), dimension.name()));
    }
    let (a, b) = (first.value(), first.unit.from_si(last.si));
    if first.si.to_bits() == last.si.to_bits() {
        return Err("the range is empty: both ends are the same".to_owned());
    }
    let scale = format!("{:e}", a.abs().max(b.abs()));
    let exponent = scale.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    Ok(Ends {
        from: a,
        to: b,
        texts: [from, to.trim().to_owned()],
        symbol: first.unit.symbol().to_owned(),
        dimension,
        decimals: usize::try_from(DIGITS - 1 - exponent).unwrap_or(0),
    })
}

/// A quantity of whatever dimension its unit says.
pub(crate) fn read(text: &str) -> Result<(Quantity, Dimension), QuantityError> {
    let mut worst = QuantityError::NotANumber;
    for dimension in Dimension::all() {
        match Quantity::parse(text, dimension) {
            Ok(quantity) => return Ok((quantity, dimension)),
            Err(QuantityError::NoUnit) => {}
            Err(error) => worst = error,
        }
    }
    Err(worst)
}

fn quantity_mistake(text: &str, error: &QuantityError) -> String {
    let text = text.trim();
    match error {
        QuantityError::NotFinite => format!("`{text}` is not a finite number"),
        QuantityError::DecimalComma(point) => format!("`{text}` has a decimal comma; write `{point}`"),
        QuantityError::Unit(unit) => unit.to_string(),
        QuantityError::WrongDimension(unit, _) => format!("`{unit}` is the unit of nothing that a project file knows"),
        QuantityError::Tolerance(half) => format!("`{half}` is no tolerance"),
        QuantityError::Fit(word, why) => format!("`{word}` is no fit: {why}"),
        QuantityError::General(word, why) => format!("`{word}` is no general tolerance: {why}"),
        QuantityError::NotANumber | QuantityError::NoUnit => format!("`{text}` is not a number with its unit"),
    }
}

/// Entries between commas that stand outside of brackets and quotes.
fn split_list(spec: &str) -> Result<Vec<String>, String> {
    let (mut items, mut item, mut depth, mut quote) = (Vec::new(), String::new(), 0_usize, None);
    for c in spec.chars() {
        match (c, quote) {
            (_, Some(open)) if c == open => quote = None,
            ('"' | '\'', None) => quote = Some(c),
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth = depth.checked_sub(1).ok_or("a bracket is closed that was not opened")?,
            (',', None) if depth == 0 => {
                items.push(std::mem::take(&mut item).trim().to_owned());
                continue;
            }
            _ => {}
        }
        item.push(c);
    }
    items.push(item.trim().to_owned());
    if depth > 0 || quote.is_some() {
        return Err("a bracket or quote is not closed".to_owned());
    }
    if items.iter().any(String::is_empty) {
        return Err("a value is empty".to_owned());
    }
    Ok(items)
}

/// A text without the quotes around it.
pub(crate) fn plain(text: &str) -> &str {
    let inside = |quote| text.strip_prefix(quote).and_then(|t: &str| t.strip_suffix(quote));
    inside('"').or_else(|| inside('\'')).unwrap_or(text)
}

/// A metric that a family computes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MetricColumn {
    pub(crate) name: String,
    pub(crate) dimension: Dimension,
}

/// Every metric of a family. Any of them may be limited, so the description of `requirements.limits` names them with their quantities.
pub(crate) fn metrics_of(family: &dyn Family) -> Vec<MetricColumn> {
    let schema = family.json_schema();
    let limits = schema.pointer("/properties/requirements/properties/limits/properties").and_then(|l| l.as_object());
    let dimension = |limit: &serde_json::Value| {
        let example = limit.pointer("/properties/min/examples/0")?.as_str()?;
        read(example).ok().map(|(_, dimension)| dimension)
    };
    limits
        .into_iter()
        .flatten()
        .map(|(name, limit)| MetricColumn { name: name.clone(), dimension: dimension(limit).unwrap_or(Dimension::Ratio) })
        .collect()
}

/// The metrics asked for, in the order asked; all of them if none is named.
pub(super) fn chosen_metrics(family: &dyn Family, wanted: &[String]) -> Result<Vec<MetricColumn>, SweepError> {
    let all = metrics_of(family);
    if wanted.is_empty() {
        return Ok(all);
    }
    let mut chosen: Vec<MetricColumn> = Vec::new();
    for name in wanted.iter().map(|n| n.trim()) {
        let Some(found) = all.iter().find(|m| m.name == name) else {
            let near = closest(name, all.iter().map(|m| m.name.as_str()));
            let help = near.map_or_else(
                || format!("known are {}", all.iter().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            return Err(refused_call("E0133", format!("there is no metric `{}`", name.chars().take(60).collect::<String>()), help));
        };
        if chosen.contains(found) {
            return Err(refused_call("E0133", format!("the metric `{name}` is asked for twice"), "name it once"));
        }
        chosen.push(found.clone());
    }
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(spec: &str) -> Vec<String> {
        let axis = Axis::parse(&format!("a.b={spec}")).unwrap();
        (0..axis.len().unwrap()).map(|at| axis.value(Place::Nth(at))).collect()
    }

    #[test]
    fn ranges_are_the_decimals_that_people_write() {
        assert_eq!(values("0.8mm..1.2mm:5"), ["0.8mm", "0.9 mm", "1 mm", "1.1 mm", "1.2mm"]);
        assert_eq!(values("0.8..1.2 mm:5"), ["0.8 mm", "0.9 mm", "1 mm", "1.1 mm", "1.2 mm"]);
        assert_eq!(values("-0.3..0.3:7"), ["-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("-0.1..0.3:5"), ["-0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("30 deg..−30 deg:3"), ["30 deg", "0 deg", "−30 deg"]);
        // Of two units, the first.
        assert_eq!(values("0.8 mm..0.12 cm:3"), ["0.8 mm", "1 mm", "0.12 cm"]);
        assert_eq!(values("0..1:4"), ["0", "0.33333333333333", "0.66666666666667", "1"]);
        assert_eq!(values("1e9 Pa..3e9 Pa:3"), ["1e9 Pa", "2000000000 Pa", "3e9 Pa"]);
        assert_eq!(values("1e-9..3e-9:3"), ["1e-9", "0.000000002", "3e-9"]);
        assert_eq!(values("-1.7e308..1.7e308:3")[1], "0");
        assert_eq!(values("5 %..10 %:2"), ["5 %", "10 %"]);
        // A thousand steps of a micrometre: each the double that its decimal is.
        let axis = Axis::parse("w=0.5mm..1.5mm:1001").unwrap();
        for at in 0..=1000_u32 {
            let text = axis.value(Place::Nth(u64::from(at)));
            let exact: f64 = format!("{}e-6", 500 + at).parse().unwrap();
            assert_eq!(axis.si(&text).unwrap().to_bits(), exact.to_bits(), "{text}");
        }
    }

    #[test]
    fn lists_are_what_was_typed() {
        assert_eq!(values("0.8mm, 1 mm,1.2mm"), ["0.8mm", "1 mm", "1.2mm"]);
        assert_eq!(values("reissner,inextensible"), ["reissner", "inextensible"]);
        assert_eq!(values("[1, 2],[3, \"a,]b\"]"), ["[1, 2]", "[3, \"a,]b\"]"]);
        assert_eq!(values("1 mm"), ["1 mm"]);
        assert_eq!(values("../a.csv"), ["../a.csv"]);
        let dimension = |spec: &str| Axis::parse(&format!("a={spec}")).unwrap().dimension();
        assert_eq!(dimension("1 mm,\"2 cm\""), Some(Dimension::Length));
        assert_eq!(dimension("1,2.5"), Some(Dimension::Ratio));
        assert_eq!(dimension("1 mm,2 N"), None);
        assert_eq!(dimension("reissner,2"), None);
        assert_eq!(dimension("1 N*mm..2 N*mm:3"), Some(Dimension::Torque));
        assert_eq!(Axis::parse("a=1 mm,\"2 cm\"").unwrap().si("\"2 cm\""), Some(0.02));
    }

    #[test]
    fn mistakes_are_named() {
        for (text, why) in [
            ("a", "no `=`"),
            ("=1..2:3", "dotted path"),
            ("a..b=1..2:3", "dotted path"),
            ("a=", "a value is empty"),
            ("a=1,,2", "a value is empty"),
            ("a=1 mm..2 mm", "how many values"),
            ("a=1 mm..2 mm:x", "`x` is no number of values"),
            ("a=1 mm..2 mm:-3", "`-3` is no number of values"),
            ("a=1 mm..2 mm:0", "two values or more, not 0"),
            ("a=1 mm..2 mm:1", "two values or more, not 1"),
            ("a=1..2:2000000000", "too many"),
            ("a=1 mm..1 mm:3", "empty"),
            ("a=1 mm..0.1 cm:3", "empty"),
            ("a=1 mm..2 N:3", "a length and a force"),
            ("a=1 mmm..2 mmm:3", "did you mean"),
            ("a=1 kg*A..2 kg*A:3", "unit of nothing"),
            ("a=nan..2:3", "not a finite number"),
            ("a=1..1e400:3", "not a finite number"),
            ("a=1,inf", "not a finite number"),
            ("a=1,5..2:3", "decimals have a point"),
            ("a=1..2,5:3", "decimals have a point"),
            ("a=one..two:3", "not a number"),
            ("a=1 ± 0.1..2:3", "tolerances"),
            ("a=1 mm,1 mm", "listed twice"),
            ("a=[1,2", "not closed"),
            ("a=1]", "closed that was not opened"),
            ("a=sobol(1 mm..2 mm", "not closed"),
            ("a=sobol(1 mm)", "two ends"),
            ("a=x\ny", "control characters"),
            ("mechanism=cam,lavt", "the same for all"),
        ] {
            match Axis::parse(text) {
                Err(SweepError::Call(call)) => assert!(call.code == "E0130" && call.message.contains(why), "{text}: {}", call.message),
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn metrics_have_the_quantities_of_the_family() {
        for family in crate::FAMILIES {
            assert!(!metrics_of(*family).is_empty(), "{}", family.id());
        }
        let found = metrics_of(crate::FAMILIES[0]);
        let listed = forcewright_compliant::METRICS.iter().map(|m| MetricColumn { name: m.name.to_owned(), dimension: m.dimension });
        assert_eq!(found, listed.collect::<Vec<_>>());
    }
}
