//! What was found, in words.

use forcewright_base::diagnostics::{Diagnostic, Span};
use forcewright_base::text::counted;
use forcewright_base::units::{format_number, format_si};
use forcewright_contract::calibration::{Wanted, per};
use forcewright_model::Axis;
use forcewright_study::calibrate::{Against, BenchParameter, Bound, Loose, Runs, SignTest, Stop};

use super::Calibrated;

/// Distance of what was measured from a prior's mean, in standard deviations of the difference, that contradicts it.
const CONTRADICTION: f64 = 3.0;
/// Part of the points from which repeated ones that count are told of: of so many, intervals are too narrow by a fortieth.
const MANY_COPIES: f64 = 0.05;
/// Too few points to tell anything.
const TOO_FEW: &str = "Too few points to judge";
/// Weight below which a point hardly counts.
pub(super) const HARDLY: f64 = 0.1;
/// Points that are far off by themselves, at most, though they are the stretch that is not explained.
const MOST_ALONE: usize = 2;
/// Correlations beyond it are shown as that.
const MOST_CORRELATION: f64 = 0.9999;
/// Most places at which such points are named.
const MOST_PLACES: usize = 6;
/// Digits of an estimate whose interval is as wide as itself, and at most.
const DIGITS: [usize; 2] = [2, 12];

/// Symbols in which people are shown parameters, and their sizes in SI: of the bench, those of the columns that were measured.
pub(super) fn units(wanted: &Wanted, [x, y]: &[Axis; 2]) -> (Vec<String>, Vec<f64>) {
    let of_design = wanted.design.iter().map(|d| {
        let unit = &d.free.number.unit;
        (if unit.symbol() == "1" { String::new() } else { unit.pretty() }, unit.to_si(1.0))
    });
    let of_bench = wanted.bench.iter().map(|b| match b.which {
        BenchParameter::OffsetX => (x.display.pretty(), x.display.to_si(1.0)),
        BenchParameter::OffsetY => (y.display.pretty(), y.display.to_si(1.0)),
        BenchParameter::Compliance => (per(&x.display.pretty(), &y.display.pretty()), x.display.to_si(1.0) / y.display.to_si(1.0)),
    });
    of_design.chain(of_bench).unzip()
}

impl Calibrated {
    /// A value of a parameter in its unit.
    pub fn show(&self, parameter: usize, si: f64, digits: usize) -> String {
        let (Some(size), Some(unit)) = (self.unit_sizes.get(parameter), self.units.get(parameter)) else { return String::new() };
        if si.is_infinite() {
            return if si > 0.0 { "∞" } else { "−∞" }.to_owned();
        }
        let number = format_number(si / size, digits);
        if unit.is_empty() { number } else { format!("{number} {unit}") }
    }

    fn name(&self, parameter: usize) -> &str {
        self.fit.parameters.get(parameter).map_or("", |p| &p.parameter.name)
    }

    /// Path, value before, estimate, interval, interval of the likelihood, and what is to be said, of each parameter.
    pub fn rows(&self) -> Vec<[String; 6]> {
        let each = self.fit.parameters.iter().enumerate();
        each.map(|(i, found)| {
            let interval = found.estimate.interval;
            let digits = digits(found.estimate.value, interval.high - interval.low);
            let pair = |low: f64, high: f64| format!("{} to {}", self.show(i, low, digits), self.show(i, high, digits));
            let profile = found.profile.map_or_else(|| "–".to_owned(), |p| pair(p.low, p.high));
            let said = if !self.fit.ended {
                "interval unknown"
            } else if let Some(bound) = found.at {
                match bound {
                    Bound::Lower => "at its lower bound",
                    Bound::Upper => "at its upper bound",
                }
            } else if found.error.is_infinite() {
                "not determined"
            } else if self.fit.identified.on_priors.contains(&i) {
                "rests on its prior"
            } else {
                ""
            };
            [
                found.parameter.name.clone(),
                self.show(i, found.parameter.start, digits),
                self.show(i, found.estimate.value, digits),
                pair(interval.low, interval.high),
                profile,
                said.to_owned(),
            ]
        })
        .collect()
    }

    /// A combination of parameters that hardly moves the curve: `material.young_modulus` +1 %, `design.depth` −1 %.
    pub(super) fn combination(&self, loose: &Loose) -> String {
        let one = |(i, change): &(usize, f64)| {
            let parameter = &self.fit.parameters[*i].parameter;
            let relative = (parameter.scale - parameter.start.abs()).abs() <= 1e-12 * parameter.scale;
            let change = 0.01 * change;
            let sign = if change < 0.0 { "−" } else { "+" };
            if relative {
                format!("`{}` {sign}{} %", parameter.name, format_number(100.0 * change.abs() / parameter.scale, 2))
            } else {
                format!("`{}` {sign}{}", parameter.name, self.show(*i, change.abs(), 2))
            }
        };
        loose.changes.iter().map(one).collect::<Vec<_>>().join(" with ")
    }

    /// What is not explained, in one sentence; what supports that nothing is.
    pub fn residual_verdict(&self) -> String {
        let residuals = &self.fit.residuals;
        let (x, y) = (&self.axes[0].display, &self.axes[1].display);
        let tests = self.tests();
        if !residuals.judged {
            return format!(
                "{TOO_FEW} whether anything systematic is left beside the scatter of {}{} ({tests}).",
                format_si(self.fit.noise, y, 3),
                if self.few_places() { format!(": they lie at {} only", counted(residuals.places, "place")) } else { String::new() }
            );
        }
        if !residuals.unexplained {
            return format!("Nothing systematic is left over the scatter of {} ({tests}).", format_si(self.fit.noise, y, 3));
        }
        let place = residuals.stretch.map_or_else(String::new, |s| {
            let side = if s.mean > 0.0 { "above" } else { "below" };
            let branch =
                if self.points.names.len() > 1 { format!(", {}", self.points.names.get(s.branch).unwrap_or(&"")) } else { String::new() };
            let (from, to) = (format_si(s.from, x, 4), format_si(s.to, x, 4));
            let stretch = if from == to { format!("at {from}") } else { format!("from {from} to {to}") };
            let size = format_si(s.mean.abs(), y, 3);
            if s.points == 1 {
                format!("; {stretch}{branch}, the measured point lies {size} {side} the fitted curve")
            } else {
                format!("; {stretch}{branch}, the measured points lie {size} {side} the fitted curve on average")
            }
        });
        let size = format_si(residuals.systematic, y, 3);
        if residuals.alternates {
            return format!(
                "The parameters do not explain all: signs alternate, as of two curves in one file, or of rows that ring: {size} alternates \
                 (root mean square), beside a scatter of {} ({tests}).",
                format_si(residuals.scatter, y, 3)
            );
        }
        format!(
            "The parameters do not explain all: {size} is systematic (root mean square), beside a scatter of {}{place} ({tests}).",
            format_si(residuals.scatter, y, 3)
        )
    }

    /// What the tests of the residuals say.
    fn tests(&self) -> String {
        let residuals = &self.fit.residuals;
        let lack = residuals.lack.map_or_else(String::new, |l| {
            let against = match l.against {
                Against::Repeats => "repeats",
                Against::Smooth => "a smooth curve through the residuals",
            };
            let [above, below] = l.degrees;
            let p = if l.p_small < l.p { format!("{} of so small a ratio", probability(l.p_small)) } else { probability(l.p) };
            format!("lack of fit against {against}: F({above}, {below}) = {}, p {p}; ", format_number(l.ratio, 3))
        });
        format!("{lack}{}", signs(&residuals.runs))
    }

    /// Whether points are too few to judge because they lie at too few places.
    fn few_places(&self) -> bool {
        let residuals = &self.fit.residuals;
        !residuals.judged && 2 * residuals.places <= self.points.x.len()
    }

    /// Points as branches and runs of indices, branch by branch in the order of their places.
    fn runs_of(&self, far: &dyn Fn(usize) -> bool) -> Vec<(usize, Vec<usize>)> {
        let of = |(branch, order): (usize, Vec<usize>)| {
            order.chunk_by(|a, b| far(*a) == far(*b)).filter(|run| far(run[0])).map(|run| (branch, run.to_vec())).collect::<Vec<_>>()
        };
        self.sorted().into_iter().enumerate().flat_map(of).collect()
    }

    /// Where such points are, with what is to be said of neighbours.
    fn places_of(&self, runs: &[(usize, Vec<usize>)], said: &dyn Fn(&[usize]) -> String) -> String {
        let show = |i: usize| format_si(self.points.x[i], &self.axes[0].display, 4);
        let one = |(branch, run): &(usize, Vec<usize>)| {
            let name = self.points.names.get(*branch).filter(|_| self.points.names.len() > 1);
            let name = name.map_or_else(String::new, |name| format!(" ({name})"));
            let place = match run[..] {
                [only] => format!("at {}", show(only)),
                [first, .., last] if show(first) == show(last) => format!("{} at {}", run.len(), show(first)),
                [first, .., last] => format!("{} from {} to {}", run.len(), show(first), show(last)),
                [] => String::new(),
            };
            format!("{place}{name}{}", said(run))
        };
        let mut places: Vec<String> = runs.iter().take(MOST_PLACES).map(one).collect();
        let others: usize = runs.iter().skip(MOST_PLACES).map(|(_, run)| run.len()).sum();
        if others > 0 {
            places.push(format!("{others} elsewhere"));
        }
        places.join(", ")
    }

    /// Points that lie far off the others while every point counts the same, with their places and how far they lie off the curve; those of a
    /// stretch that is not explained are told with it.
    pub fn far_off(&self) -> Option<String> {
        let residuals = &self.fit.residuals;
        let known = residuals.stretch.filter(|s| s.points > MOST_ALONE);
        let told = |x: f64| known.is_some_and(|s| (s.from..=s.to).contains(&x));
        let far = |i: usize| residuals.far.contains(&i) && !told(self.points.x[i]);
        let runs = self.runs_of(&far);
        let count: usize = runs.iter().map(|(_, run)| run.len()).sum();
        let size = |run: &[usize]| {
            let off = run.iter().map(|i| residuals.values[*i]).fold(0.0, |most: f64, r| if r.abs() > most.abs() { r } else { most });
            let up_to = if run.len() > 1 { "up to " } else { "" };
            let side = if off > 0.0 { "above" } else { "below" };
            format!(", {up_to}{} {side} the curve", format_si(off.abs(), &self.axes[1].display, 3))
        };
        let (of, lie) = (self.points.x.len(), if count == 1 { "lies" } else { "lie" });
        (count > 0).then(|| format!("{count} of {of} points {lie} far off the others: {}", self.places_of(&runs, &size)))
    }

    /// How many points a robust loss lets hardly count, and where they are; nothing where all count.
    pub fn hardly_counting(&self) -> Option<String> {
        let runs = self.runs_of(&|i| self.fit.weights.get(i).is_some_and(|w| *w < HARDLY));
        let count: usize = runs.iter().map(|(_, run)| run.len()).sum();
        if count == 0 {
            return None;
        }
        let of = self.points.x.len();
        let (count_in_words, lie) = if count == 1 { ("hardly counts", "it lies") } else { ("hardly count", "they lie") };
        let places = self.places_of(&runs, &|_| String::new());
        Some(format!("{count} of {of} points {count_in_words}, with a weight below {HARDLY}, as {lie} far off the curve: {places}."))
    }

    /// The result in one sentence.
    pub fn verdict(&self) -> String {
        let count = self.points.x.len();
        let held = self.fit.parameters.iter().any(|p| p.at.is_some());
        let state = match &self.fit.stop {
            Stop::Converged if self.sound() => "The parameters explain the measured curve",
            Stop::Converged if self.fit.residuals.unexplained && held => {
                "The parameters do not explain the measured curve within their ranges"
            }
            Stop::Converged if self.fit.residuals.unexplained => "The parameters do not explain the measured curve",
            // What the curve would determine without the bound is not known.
            Stop::Converged if held => "The measured curve would be met better beyond the range of a parameter",
            Stop::Converged if !self.determined() => "The measured curve does not determine all parameters",
            Stop::Converged if self.few_places() => {
                "All parameters are determined; the points lie at too few places to judge whether they explain the curve"
            }
            Stop::Converged => "All parameters are determined; the points are too few to judge whether they explain the curve",
            Stop::Interrupted => "Interrupted: the best parameters so far",
            Stop::Stalled | Stop::RoundLimit | Stop::NoStart(_) => "The search did not come to its end",
        };
        let size = |si: f64| format_si(si, &self.axes[1].display, 3);
        let why = self.unknown().map_or_else(String::new, |why| format!(". Intervals are unknown: {why}"));
        if self.fit.residuals.unexplained {
            return format!("{state}: {count} points, which lie {} off it (root mean square){why}", size(self.fit.noise));
        }
        format!("{state}: {count} points, scatter {}{why}", size(self.fit.noise))
    }

    /// Why nothing is known of intervals, if so.
    pub fn unknown(&self) -> Option<&'static str> {
        if self.fit.ended {
            return None;
        }
        Some(match &self.fit.stop {
            Stop::Interrupted => "the search was interrupted, and these estimates are not the best",
            Stop::RoundLimit => "after so many rounds the search still finds better estimates",
            Stop::Converged | Stop::Stalled | Stop::NoStart(_) => {
                "the search stands where its tangents still promise better estimates, as at a kink of the curve or where derivatives are \
                 missing, or another place nearby is better"
            }
        })
    }

    /// How neighbouring residuals go together.
    pub(super) fn neighbours(&self) -> String {
        let chance = (self.points.x.len().max(1) as f64).sqrt().recip();
        format!(
            "Neighbouring residuals have a correlation of {:.2}, where independent errors make 0 ± {} (one standard deviation). Errors that \
             depend on each other, as of drift or of a filter in the amplifier, make intervals too narrow.",
            self.fit.residuals.autocorrelation,
            format_number(chance, 2)
        )
    }

    /// Parameters that are not determined, in a sentence for each set that no other has a part in.
    fn not_determined(&self) -> Vec<String> {
        let mut sets: Vec<(Vec<usize>, Vec<&Loose>)> = Vec::new();
        for loose in &self.fit.identified.loose {
            let own: Vec<usize> = loose.changes.iter().map(|(i, _)| *i).collect();
            let (met, mut rest): (Vec<_>, Vec<_>) = sets.into_iter().partition(|(set, _)| set.iter().any(|i| own.contains(i)));
            let (mut all, mut directions) = (own, Vec::new());
            for (set, before) in met {
                all.extend(set);
                directions.extend(before);
            }
            directions.push(loose);
            all.sort_unstable();
            all.dedup();
            rest.push((all, directions));
            sets = rest;
        }
        sets.iter().map(|(set, directions)| self.not_determined_set(set, directions)).collect()
    }

    fn not_determined_set(&self, set: &[usize], directions: &[&Loose]) -> String {
        let held = set.iter().any(|i| self.fit.parameters[*i].parameter.prior.is_some());
        let tail = if held { "; a prior decides" } else { "" };
        let names = set.iter().map(|i| format!("`{}`", self.name(*i))).collect::<Vec<_>>();
        match (&names[..], directions) {
            ([only], _) => format!("the measurement does not determine {only}{tail}"),
            (_, [one]) => {
                format!("the measurement does not determine {}: together they leave the curve as it is{tail}", self.combination(one))
            }
            // Directions are at right angles: as many as there are parameters are all that these can do.
            ([a, b], _) => {
                format!("the measurement determines neither {a} nor {b}: what each changes of the curve is lost in the scatter{tail}")
            }
            (_, _) if directions.len() >= names.len() => {
                format!(
                    "the measurement determines none of {}: what each changes of the curve is lost in the scatter{tail}",
                    listed(&names)
                )
            }
            _ => {
                let firm = names.len() - directions.len();
                let firm = if firm == 1 { "one combination".to_owned() } else { format!("{firm} combinations") };
                format!("of {} the measurement determines no more than {firm}{tail}", listed(&names))
            }
        }
    }

    /// Says what is not sound about the result.
    pub(super) fn warn(&mut self, place: Span) {
        for (code, message, help) in self.of_parameters().into_iter().chain(self.of_points()) {
            self.diagnostics.push(Diagnostic::warning(code, place, message).label("this calibration").help(help));
        }
    }

    /// What is not sound about the parameters.
    fn of_parameters(&self) -> Vec<Doubt> {
        let mut all: Vec<Doubt> = Vec::new();
        for message in self.not_determined() {
            all.push(("W0902", message, "take one of them out, or give it a `prior`"));
        }
        for (a, b, r) in &self.fit.identified.tied {
            let message = format!(
                "`{}` and `{}` are hardly told apart: their errors have a correlation {}",
                self.name(*a),
                self.name(*b),
                correlation(*r)
            );
            all.push((
                "W0903",
                message,
                "measure where they act differently, or take one of them out; their combination is known well as it is",
            ));
        }
        for i in &self.fit.identified.on_priors {
            all.push(("W0904", format!("the estimate of `{}` rests on its prior", self.name(*i)), "measure what depends on it more"));
        }
        for found in &self.fit.parameters {
            if found.at.is_some() {
                all.push((
                    "W0906",
                    format!("`{}` lies at a bound of its range", found.parameter.name),
                    "widen `range` if it may lie beyond; else the parameter makes up for something that the model lacks",
                ));
            }
            // Were both right, an estimate would lie away from the mean by what the prior's variance loses in it.
            let moves = |sd: f64| (sd * sd - found.error * found.error).max(1e-6 * sd * sd).sqrt();
            let away = found
                .parameter
                .prior
                .filter(|_| found.error.is_finite())
                .map_or(0.0, |p| (found.estimate.value - p.mean).abs() / moves(p.sd));
            if away > CONTRADICTION {
                let message = format!(
                    "the measurement contradicts the prior of `{}` by {} standard deviations",
                    found.parameter.name,
                    format_number(away, 2)
                );
                all.push(("W0907", message, "was the prior too sure, or does the model lack something?"));
            }
        }
        all
    }

    /// What is not sound about the points, and about what the parameters leave.
    fn of_points(&self) -> Vec<Doubt> {
        let mut all: Vec<Doubt> = Vec::new();
        if self.beyond > 0 {
            let (points, lie) = if self.beyond == 1 { ("point", "lies") } else { ("points", "lie") };
            let message = format!("{} {points} that count {lie} beyond the ends of the curve, on the bench that was found", self.beyond);
            all.push(("W0908", message, "compute further, or leave out the ends of the record"));
        }
        let (dropped, copies, count) = (self.copied_rows, self.points.copies(), self.points.x.len());
        if dropped > 0 {
            let (rows, repeat) = if dropped == 1 { ("row", "repeats") } else { ("rows", "repeat") };
            let message =
                format!("{dropped} {rows} of the file {repeat} the row before, or the table as a whole, exactly: once is what they count");
            all.push((
                "W0910",
                message,
                "a logger that writes faster than it measures, a display that stands, or a table that was pasted twice",
            ));
        }
        if copies as f64 >= MANY_COPIES * count as f64 && copies > 0 {
            let (repeat, they) = if copies == 1 { ("repeats", "counts as if it") } else { ("repeat", "count as if they") };
            let had = if copies == 1 { "had been measured again" } else { "had been measured" };
            let message = format!("{copies} of {count} points {repeat} another one exactly, and {they} {had}");
            all.push(("W0910", message, "if they are copies, remove them: with them intervals are too narrow"));
        }
        if let Some(message) = self.far_off() {
            all.push(("W0911", message, "look at these rows; `loss = \"tukey\"` or `\"huber\"` lets far points count little"));
        }
        if self.fit.residuals.unexplained {
            all.push((
                "W0905",
                self.residual_verdict(),
                if self.fit.residuals.alternates {
                    "do not take the estimates for material data; is it one curve, and are its rows of one kind?"
                } else {
                    "do not take the estimates for material data; look for what the model lacks there"
                },
            ));
        }
        if self.determined() && !self.fit.residuals.judged && !self.fit.residuals.unexplained {
            let message = format!(
                "{TOO_FEW} whether the parameters explain the curve: {} at {}",
                self.points.x.len(),
                counted(self.fit.residuals.places, "place")
            );
            all.push(("W0909", message, "measure at more places"));
        }
        all
    }
}

/// Code, message and way out of a warning.
type Doubt = (&'static str, String, &'static str);

/// What the signs of the residuals say.
fn signs(runs: &Runs) -> String {
    let [above, below] = runs.sides;
    match runs.test {
        SignTest::Side => format!("{} of {} on one side (sign test), p {}", above.max(below), above + below, probability(runs.p)),
        SignTest::Runs => {
            let p = if runs.p_many < runs.p { format!("{} of so many", probability(runs.p_many)) } else { probability(runs.p) };
            let number = counted(runs.observed, "run");
            format!("{number} of signs, {} expected, p {p}", format_number(runs.expected, 3))
        }
    }
}

/// a, b and c.
fn listed(names: &[String]) -> String {
    match names {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => names.concat(),
    }
}

/// A correlation near ±1: as many digits as show that it is not that.
fn correlation(r: f64) -> String {
    let sign = if r < 0.0 { "−" } else { "" };
    if r.abs() > MOST_CORRELATION { format!("beyond {sign}{MOST_CORRELATION}") } else { format!("of {sign}{:.4}", r.abs()) }
}

/// Digits that show an interval of this width about a value.
fn digits(value: f64, width: f64) -> usize {
    let [least, most] = DIGITS;
    let mut reach = width;
    let mut digits = least + 1;
    while reach > 0.0 && reach < value.abs() && digits < most {
        reach *= 10.0;
        digits += 1;
    }
    digits
}

/// What a probability is, short: `= 0.03`, `< 0.0001`.
fn probability(p: f64) -> String {
    if p < 1e-4 { "< 0.0001".to_owned() } else { format!("= {}", format_number(p, 2)) }
}
