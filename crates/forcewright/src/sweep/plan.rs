//! The designs of a sweep, one by one.

use forcewright_study::sampling::Sobol;

use super::axis::{Axis, Place, Values};
use super::{SweepError, refused_call};

/// Most designs of a sweep unless more are asked for by name.
pub const MOST_DESIGNS: u64 = 10_000_000;

/// Points of the unit cube, each a function of its number.
pub(super) type Points = Box<dyn Fn(u64, &mut [f64]) + Send + Sync>;

/// Makes the points of a space-filling sample of so many dimensions.
pub(super) type Sampler = fn(dimensions: usize, seed: u64) -> Option<Points>;

/// Scrambled Sobol points.
pub(super) const SPACE_FILLING: Sampler = |dimensions, seed| {
    let sobol = Sobol::scrambled(dimensions, seed).ok()?;
    Some(Box::new(move |index, out| sobol.point(index, out)))
};

/// How a sample is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampling {
    /// Points of the sample, for keys with `sobol(…)`.
    pub points: Option<u64>,
    /// The same seed gives the same points.
    pub seed: u64,
}

/// All designs of a sweep: the full grid of the axes, the first slowest, and at each place of the grid the same sample, if there is one.
pub struct Plan {
    axes: Vec<Axis>,
    sampling: Sampling,
    sample: Option<Points>,
    total: u64,
}

impl Plan {
    /// The plan of some axes.
    ///
    /// # Errors
    /// E0130 for axes that do not go together, E0131 for more than [`MOST_DESIGNS`] designs unless `many` is set.
    pub fn new(axes: Vec<Axis>, sampling: Sampling, many: bool) -> Result<Self, SweepError> {
        Self::with_sampler(axes, sampling, many, SPACE_FILLING)
    }

    pub(super) fn with_sampler(axes: Vec<Axis>, sampling: Sampling, many: bool, sampler: Sampler) -> Result<Self, SweepError> {
        let refuse = |message: String, help: &str| Err(refused_call("E0130", message, help));
        if axes.is_empty() {
            return refuse("a sweep varies something".to_owned(), "write `--vary design.thickness=0.8mm..1.2mm:9`");
        }
        for (at, axis) in axes.iter().enumerate() {
            if axes[..at].iter().any(|other| other.key == axis.key) {
                return refuse(format!("`{}` is varied twice", axis.key), "join the values in one list: `KEY=a,b,c`");
            }
        }
        let sampled = axes.iter().filter(|a| a.len().is_none()).count();
        let sample = match (sampled, sampling.points) {
            (0, None) => None,
            (0, Some(_)) => {
                return refuse(
                    "`--points` without a sample".to_owned(),
                    "write `KEY=sobol(a..b)`, or a range with its count, `KEY=a..b:n`",
                );
            }
            (_, None | Some(0)) => {
                return refuse("a sample needs its number of points".to_owned(), "add `--points 256`; powers of two fill best");
            }
            (_, Some(_)) => match sampler(sampled, sampling.seed) {
                Some(points) => Some(points),
                None => {
                    return refuse(
                        "space-filling samples are not part of this version".to_owned(),
                        "write a range with its count, `KEY=a..b:n`",
                    );
                }
            },
        };
        let points = if sampled > 0 { sampling.points } else { None };
        let total = axes.iter().filter_map(Axis::len).chain(points).try_fold(1_u64, u64::checked_mul);
        match total.filter(|total| many || *total <= MOST_DESIGNS) {
            // Beyond 2^53 the number of a design is no longer a double.
            Some(total) if total < 1 << 53 => Ok(Self { axes, sampling, sample, total }),
            _ => {
                let count = total.map_or_else(|| "more than 1.8e19".to_owned(), |t| t.to_string());
                Err(refused_call(
                    "E0131",
                    format!("the sweep has {count} designs"),
                    format!("more than {MOST_DESIGNS} need `--yes`; fewer values per key give fewer, `--shard i/n` divides the work"),
                ))
            }
        }
    }

    /// How many designs there are.
    pub fn len(&self) -> u64 {
        self.total
    }

    /// Whether there is none; never.
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }

    /// What is varied, the slowest first.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// How the sample is drawn.
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// The values of a design, by its number from 0, one per axis, as they would be typed.
    pub fn values(&self, design: u64) -> Vec<String> {
        let mut rest = design;
        let mut fractions = vec![0.0; self.axes.iter().filter(|a| matches!(a.values, Values::Sample(_))).count()];
        if let (Some(sample), Some(points)) = (&self.sample, self.sampling.points) {
            sample(rest % points, &mut fractions);
            rest /= points;
        }
        // From the fastest axis to the slowest.
        let mut values: Vec<String> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            let place = match axis.len() {
                Some(len) => {
                    let place = Place::Nth(rest % len);
                    rest /= len;
                    place
                }
                None => Place::Fraction(fractions.pop().unwrap_or(0.0)),
            };
            values.push(axis.value(place));
        }
        values.reverse();
        values
    }

    /// The values of a design as settings `KEY=VALUE`.
    pub fn settings(&self, design: u64) -> Vec<String> {
        self.axes.iter().zip(self.values(design)).map(|(axis, value)| format!("{}={value}", axis.key)).collect()
    }
}

/// A contiguous part of the designs, for one of several machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    pub index: u64,
    /// How many there are.
    pub of: u64,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Reads `2/4`.
    ///
    /// # Errors
    /// E0130 unless it is `i/n` with 1 ≤ i ≤ n.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let number = |t: &str| t.trim().parse::<u64>().ok();
        let parsed = text.split_once('/').and_then(|(index, of)| Some(Self { index: number(index)?, of: number(of)? }));
        parsed.filter(|s| (1..=s.of).contains(&s.index) && s.of <= 1_000_000).ok_or_else(|| {
            let shown: String = text.chars().take(40).collect();
            refused_call("E0130", format!("`--shard {shown}` is not understood"), "write `--shard 2/4` for the second of four parts")
        })
    }

    /// Its designs, from 0, of so many in all.
    pub fn range(self, total: u64) -> std::ops::Range<u64> {
        let at = |index: u64| u64::try_from(u128::from(total) * u128::from(index) / u128::from(self.of.max(1))).unwrap_or(total);
        at(self.index - 1)..at(self.index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(texts: &[&str]) -> Vec<Axis> {
        texts.iter().map(|text| Axis::parse(text).unwrap()).collect()
    }

    fn refused(texts: &[&str], sampling: Sampling, many: bool) -> (&'static str, String) {
        match Plan::new(axes(texts), sampling, many) {
            Err(SweepError::Call(call)) => (call.code, call.message),
            other => panic!("{texts:?}: {:?}", other.map(|p| p.len())),
        }
    }

    #[test]
    fn the_first_key_is_slowest() {
        let plan = Plan::new(axes(&["a=1,2", "b=x,y,z", "c=0..1:2"]), Sampling::default(), false).unwrap();
        let all: Vec<String> = (0..plan.len()).map(|at| plan.values(at).join(" ")).collect();
        let expected = "1 x 0|1 x 1|1 y 0|1 y 1|1 z 0|1 z 1|2 x 0|2 x 1|2 y 0|2 y 1|2 z 0|2 z 1";
        assert_eq!(all.join("|"), expected);
        assert_eq!(plan.settings(7), ["a=2", "b=x", "c=1"]);
    }

    #[test]
    fn a_sample_is_repeated_at_each_place_of_the_grid() {
        // Coordinates that tell the point, the dimension and the seed.
        let sampler: Sampler = |dimensions, seed| {
            Some(Box::new(move |point, out| {
                assert_eq!(out.len(), dimensions);
                for (at, u) in out.iter_mut().enumerate() {
                    *u = (4 * point + 2 * at as u64 + seed) as f64 / 16.0;
                }
            }))
        };
        let sampling = Sampling { points: Some(3), seed: 1 };
        let texts = ["p=sobol(0..16)", "a=u,v", "q=sobol(10mm..26mm)"];
        let plan = Plan::with_sampler(axes(&texts), sampling, false, sampler).unwrap();
        let all: Vec<String> = (0..plan.len()).map(|at| plan.values(at).join(",")).collect();
        assert_eq!(all, ["1,u,13 mm", "5,u,17 mm", "9,u,21 mm", "1,v,13 mm", "5,v,17 mm", "9,v,21 mm"]);
    }

    #[test]
    fn axes_that_do_not_go_together_are_refused() {
        let none = Sampling::default();
        let points = Sampling { points: Some(8), seed: 0 };
        assert!(refused(&[], none, false).1.contains("varies something"));
        assert!(refused(&["a=1,2", "a=3,4"], none, false).1.contains("varied twice"));
        assert!(refused(&["a=1,2"], points, false).1.contains("without a sample"));
        assert!(refused(&["a=sobol(1..2)"], none, false).1.contains("number of points"));
        let large = ["a=0..1:1000", "b=0..1:10001"];
        assert_eq!(refused(&large, none, false), ("E0131", "the sweep has 10001000 designs".to_owned()));
        assert_eq!(Plan::new(axes(&large), none, true).unwrap().len(), 10_001_000);
        let endless = ["a=0..1:1000000000", "b=0..1:1000000000", "c=0..1:1000000000"];
        assert_eq!(refused(&endless, none, true).0, "E0131");
    }

    #[test]
    fn shards_cover_everything_once() {
        for (total, of) in [(10, 3), (3, 5), (1, 1), (1_000_003, 7), ((1 << 53) - 1, 1000)] {
            let mut next = 0;
            for index in 1..=of {
                let range = Shard { index, of }.range(total);
                assert_eq!(range.start, next);
                assert!(range.end - range.start <= total / of + 1);
                next = range.end;
            }
            assert_eq!(next, total);
        }
        assert_eq!(Shard::parse("2/4").unwrap(), Shard { index: 2, of: 4 });
        for text in ["", "2", "0/4", "5/4", "a/b", "1/0", "-1/2", "1/99999999"] {
            assert!(Shard::parse(text).is_err(), "{text}");
        }
    }
}
