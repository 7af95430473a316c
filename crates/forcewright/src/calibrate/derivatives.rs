//! Derivatives that calibrations are made of, for every number of every kind of mechanism: a number whose freedom is all that the language
//! admits (`{}`) and one in a narrow range have the same derivatives, those of Richardson's differences, and the same fit.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::numbers::Number;
use forcewright_contract::project::Choices;
use forcewright_contract::studies::Free;
use forcewright_study::calibrate::{Bench, Branch, Curve, Fit, Limits, Measured, Model, Parameter, Plan, Stop, fit};
use forcewright_study::evaluator::{Evaluation, Evaluator};

use crate::{Loaded, gallery};

/// Sections whose numbers a calibration may look for.
const ROOTS: [&str; 6] = ["design", "material", "errors", "losses", "environment", "inertia"];
const POINTS: usize = 60;

/// A mechanism, settings, Richardson's step relative to a number, and how exact derivatives are, relative to the largest of the curve.
struct Kind {
    example: &'static str,
    set: &'static [&'static str],
    step: f64,
    exact: f64,
}

/// The accuracy of the flexible ones is that of the differences that they are held against.
const KINDS: [Kind; 6] = [
    Kind { example: "lan-table3", set: &["model.accuracy=1e-8"], step: 2e-3, exact: 1e-4 },
    Kind { example: "tapered-spring", set: &["model.accuracy=1e-8"], step: 2e-3, exact: 1e-4 },
    Kind { example: "sanchez-2-springs", set: &[], step: 1e-4, exact: 1e-4 },
    Kind { example: "torque-cam", set: &[], step: 1e-4, exact: 1e-4 },
    Kind { example: "longval", set: &[], step: 1e-4, exact: 1e-4 },
    Kind { example: "butin-2", set: &[], step: 1e-4, exact: 1e-4 },
];

impl Kind {
    fn loaded(&self) -> Loaded {
        let choices = Choices { variant: None, set: self.set.iter().map(|s| (*s).to_owned()).collect() };
        Loaded::from_text("a.toml", gallery::find(self.example).unwrap().text, &choices).map_err(|e| e.render(false)).unwrap()
    }
}

/// Everything that the language admits, as for `{}`; and a tenth of the value to both sides.
fn wide(number: &Number) -> [f64; 2] {
    let least = number.range.min + if number.range.above { 1e-3 * (number.si - number.range.min) } else { 0.0 };
    [least, number.range.max]
}

fn narrow(number: &Number) -> [f64; 2] {
    let [low, high] = wide(number);
    [(number.si - 0.1 * number.si.abs()).max(low), (number.si + 0.1 * number.si.abs()).min(high)]
}

/// The evaluator of one number in a range, if the family's studies can change it.
fn evaluator(loaded: &Loaded, number: &Number, [lower, upper]: [f64; 2]) -> Option<Box<dyn Evaluator>> {
    let free = Free { number: number.clone(), lower, upper };
    loaded.understood.evaluator(&[free], &mut Diagnostics::default())
}

fn curve(evaluator: &dyn Evaluator) -> Curve<'_> {
    let stations = evaluator.stations(0);
    let (first, last) = (stations[0], stations[stations.len() - 1]);
    let x = (0..POINTS).map(|i| first + (last - first) * (i as f64 + 0.5) / POINTS as f64).collect();
    Curve::new(evaluator, Bench::default(), Vec::new(), vec![Branch { output: 0, x }]).unwrap()
}

fn predicted(model: &Curve<'_>, x: f64, derivatives: bool) -> Evaluation {
    let mut out = Evaluation::default();
    model.predict(&[x], derivatives, &mut model.room(), &mut out).unwrap_or_else(|e| panic!("{x}: {e:?}"));
    out
}

/// Differences of second order, extrapolated to the fourth.
fn richardson(model: &Curve<'_>, x: f64, h: f64) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        let (up, down) = (predicted(model, x + h, false).values, predicted(model, x - h, false).values);
        up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    central(0.5 * h).iter().zip(central(h)).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect()
}

/// The fit of one number to its own curve with small errors, begun one per cent away.
fn fitted(model: &Curve<'_>, number: &Number, [lower, upper]: [f64; 2]) -> Option<Fit> {
    let exact = predicted(model, number.si, false).values;
    let largest = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // Errors of no pattern: fractions of multiples of the golden ratio.
    let error = |i: usize| 2e-3 * largest * ((0.618_033_988_75 * (i + 1) as f64).fract() - 0.5);
    let y: Vec<f64> = exact.iter().enumerate().map(|(i, v)| v + error(i)).collect();
    let x: Vec<f64> = (0..POINTS).map(|i| i as f64).collect();
    let start = (1.01 * number.si).clamp(lower, upper);
    let parameter = Parameter { name: number.path.clone(), start, limits: Limits { lower, upper }, scale: number.si.abs(), prior: None };
    let plan = Plan { profiles: false, ..Plan::default() };
    fit(model, &[parameter], Measured { x: &x, y: &y, raw: &y, branches: &[POINTS] }, &plan, &mut |_| true).ok()
}

/// Numbers that have a size and a curve that depends on them.
fn each(kind: &Kind, check: &mut dyn FnMut(&Loaded, &Number)) {
    let loaded = kind.loaded();
    let numbers = loaded.understood.numbers();
    let mut count = 0;
    for number in numbers.iter().filter(|n| n.path.split('.').next().is_some_and(|root| ROOTS.contains(&root)) && n.si.abs() > 0.0) {
        let [low, high] = wide(number);
        let inside = low < number.si * 0.999 && number.si * 1.001 < high || low < number.si * 1.001 && number.si * 0.999 < high;
        if !inside || number.path.ends_with("seed") || evaluator(&loaded, number, wide(number)).is_none() {
            continue;
        }
        count += 1;
        check(&loaded, number);
    }
    assert!(count >= 2, "{}: {count} numbers", kind.example);
}

fn derivatives(kind: &Kind) {
    each(kind, &mut |loaded, number| {
        let [free, held] = [wide(number), narrow(number)].map(|range| evaluator(loaded, number, range).unwrap());
        let [free, held] = [curve(&*free), curve(&*held)].map(|model| {
            let own = predicted(&model, number.si, true);
            // A family that knows the design but not its neighbours has no derivatives to compare.
            (own.jacobian, richardson(&model, number.si, kind.step * number.si.abs()), own.values)
        });
        let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let least = 1e-7 * largest(&free.2) / number.si.abs();
        let size = largest(&free.1).max(least);
        let wrong = |own: &[f64]| own.iter().zip(&free.1).filter(|(a, b)| (*a - *b).abs() > kind.exact * size).count();
        // A kink of the curve that passes a station has no derivative there.
        assert!(wrong(&free.0) <= 3 && wrong(&held.0) <= 3, "{} {}: {:?}\n{:?}\n{:?}", kind.example, number.path, free.0, held.0, free.1);
    });
}

fn fits(kind: &Kind) {
    let mut compared = 0;
    each(kind, &mut |loaded, number| {
        let [free, held] = [wide(number), narrow(number)].map(|range| (evaluator(loaded, number, range).unwrap(), range));
        let [free, held] = [free, held].map(|(own, range)| fitted(&curve(&*own), number, range));
        let (Some(free), Some(held)) = (free, held) else { return };
        let ([a], [b]) = (&free.parameters[..], &held.parameters[..]) else { panic!() };
        // What the curve does not tell to a fiftieth may end at the narrow bounds.
        if !(b.error > 0.0 && b.error < 0.02 * number.si.abs()) || free.stop != Stop::Converged || held.stop != Stop::Converged {
            return;
        }
        compared += 1;
        let off = (a.estimate.value - b.estimate.value).abs() / b.error;
        assert!(off < 0.01 && (a.error / b.error - 1.0).abs() < 0.01, "{} {}: {off} {a:?} {b:?}", kind.example, number.path);
    });
    assert!(compared >= 2, "{}: {compared}", kind.example);
}

#[test]
fn derivatives_are_those_of_richardson_with_any_range() {
    KINDS.iter().for_each(derivatives);
}

#[test]
fn fits_do_not_depend_on_the_width_of_a_range() {
    KINDS.iter().for_each(fits);
}
