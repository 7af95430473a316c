//! How often intervals contain the truth, for every family: a project file from its text to the intervals, with normal errors on the curve
//! that its studies compute. The figures of the long runs stand in `docs/theory/calibrate.md`:
//!
//! ```text
//! cargo test --release -p forcewright --lib -- --ignored --nocapture 2000
//! ```

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::project::{Choices, FileError, Files};
use forcewright_study::calibrate::{Model, Plan, Stop};
use forcewright_study::evaluator::Evaluation;
use forcewright_study::sampling::normal;
use rayon::prelude::*;

use super::Ready;
use crate::{Loaded, gallery};

const FEW: u32 = 100;
const MANY: u32 = 2000;

/// A synthetic measurement: an example, its curve, what is looked for, places from and to with their number, and the error of a point, SI.
struct Case {
    example: &'static str,
    columns: [&'static str; 2],
    parameters: &'static str,
    places: [f64; 2],
    points: u32,
    /// Up and down again.
    back: bool,
    sigma: f64,
    /// Every so many repetitions intervals of the likelihood are looked for too: they take twenty times as long.
    profiles: u32,
}

const COMPLIANT: Case = Case {
    example: "lan-table3",
    columns: ["travel / mm", "force / N"],
    parameters: "\"material.young_modulus\" = { range = [\"1 GPa\", \"4 GPa\"] }, \"bench.offset\" = {}",
    places: [0.3, 13.3],
    points: 60,
    back: false,
    sigma: 0.03,
    profiles: 5,
};

/// A thickness without a range, which the language lets go from nothing to a metre.
const THICKNESS: Case = Case { parameters: "\"design.thickness\" = {}, \"bench.offset\" = {}", ..COMPLIANT };

const CAM: Case = Case {
    example: "sanchez-2-springs",
    columns: ["s / mm", "force / N"],
    parameters: "\"design.rolling_arm\" = {}, \"design.springs.rest_length\" = {}, \"bench.offset.y\" = {}",
    places: [42.0, 208.0],
    points: 50,
    back: true,
    sigma: 0.1,
    profiles: 10,
};

const CAPSTAN: Case = Case {
    example: "longval",
    columns: ["torque / N*m", "stiffness / N*m/rad"],
    parameters: "\"design.cables.*.preload\" = {}, \"design.friction\" = {}",
    places: [0.2, 9.8],
    points: 60,
    back: false,
    sigma: 10.0,
    profiles: 20,
};

const LAVT: Case = Case {
    example: "lavt/bench",
    columns: ["in / N*mm", "out / N*mm"],
    parameters: "\"losses.mode_1.*\" = {}, \"losses.mode_2.proportional\" = {}, \"design.friction.hub\" = {}",
    places: [1.0, 99.0],
    points: 80,
    back: false,
    sigma: 0.2e-3,
    profiles: 10,
};

/// Files in memory.
struct Memory(BTreeMap<PathBuf, String>);

impl Files for Memory {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        self.0.get(path).cloned().ok_or(FileError::NotFound)
    }
}

/// Seeded normal noise (splitmix64).
struct Noise(u64);

impl Noise {
    fn normal(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let u = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        normal::quantile(u + 0.5 / (1_u64 << 53) as f64)
    }
}

impl Case {
    /// The project as a calibration sees it. Its measured ordinates mean nothing yet.
    fn ready(&self) -> Ready {
        let example = gallery::find(self.example).unwrap();
        let [x, y] = self.columns;
        let mut csv = format!("{x},{y}\n");
        let [from, to] = self.places;
        let place = |i: u32| from + (to - from) * f64::from(i) / f64::from(self.points - 1);
        let there = (0..self.points).map(place);
        let back = (0..self.points).rev().map(place).filter(|_| self.back);
        there.chain(back).for_each(|x| writeln!(csv, "{x},1").unwrap());
        let project = format!(
            "{}\n[measurements.curve]\nfile = \"curve.csv\"\nx = \"{x}\"\ny = \"{y}\"\n[calibrate]\nparameters = {{ {} }}\n",
            example.text, self.parameters
        );
        let mut files: BTreeMap<PathBuf, String> = example.data().map(|(name, text)| (name.into(), text.to_owned())).collect();
        files.extend([("a.toml".into(), project), ("curve.csv".into(), csv)]);
        let loaded = Loaded::from_file(&Memory(files), "a.toml".as_ref(), &Choices::default()).map_err(|e| e.render(false)).unwrap();
        let before = loaded.solve("", "", &mut |_| true);
        let mut diagnostics = Diagnostics::default();
        let ready = loaded.calibration(&before, &mut diagnostics);
        ready.unwrap_or_else(|| panic!("{}", diagnostics.render(&loaded.project.sources, false)))
    }
}

/// What was counted of so many repetitions.
#[derive(Clone, Debug, Default)]
struct Counted {
    repetitions: u32,
    /// Those with intervals of the likelihood.
    profiles: u32,
    /// Intervals of Student and of the likelihood that contain the truth, per parameter.
    hits: Vec<[u32; 2]>,
    unexplained: u32,
    not_converged: u32,
}

impl Counted {
    fn and(mut self, other: &Self) -> Self {
        self.repetitions += other.repetitions;
        self.profiles += other.profiles;
        self.unexplained += other.unexplained;
        self.not_converged += other.not_converged;
        self.hits.resize(other.hits.len().max(self.hits.len()), [0; 2]);
        for (mine, theirs) in self.hits.iter_mut().zip(&other.hits) {
            (0..2).for_each(|k| mine[k] += theirs[k]);
        }
        self
    }

    fn part(&self, count: u32) -> f64 {
        f64::from(count) / f64::from(self.repetitions)
    }
}

/// Fits of repetitions, all with errors of their own, begun away from the truth.
fn counted(case: &Case, repetitions: u32) -> Counted {
    let ready = case.ready();
    let names: Vec<String> = ready.parameters().into_iter().map(|p| p.name).collect();
    let truth: Vec<f64> = ready.parameters().iter().map(|p| p.start).collect();
    let mut exact = Evaluation::default();
    {
        let model = ready.curve().unwrap();
        model.predict(&truth, false, &mut model.room(), &mut exact).unwrap();
    }
    let one = |seed: u32| {
        let mut noise = Noise(u64::from(seed).wrapping_mul(0xD134_2543_DE82_EF95));
        let y: Vec<f64> = exact.values.iter().map(|v| v + case.sigma * noise.normal()).collect();
        let mut begun = ready.parameters();
        for p in &mut begun {
            p.start = (p.start + 0.01 * p.scale).clamp(p.limits.lower, p.limits.upper);
        }
        let profiles = seed.is_multiple_of(case.profiles);
        let found = ready.fitted(&begun, [&y, &y], &Plan { profiles, ..Plan::default() }, &mut |_| true);
        let Ok(found) = found else { panic!("no fit with seed {seed}") };
        let hit = |(p, truth): (&forcewright_study::calibrate::Estimated, &f64)| {
            [u32::from(p.estimate.interval.contains(*truth)), u32::from(p.profile.is_some_and(|i| i.contains(*truth)))]
        };
        Counted {
            repetitions: 1,
            profiles: u32::from(profiles),
            hits: found.parameters.iter().zip(&truth).map(hit).collect(),
            unexplained: u32::from(found.residuals.unexplained),
            not_converged: u32::from(found.stop != Stop::Converged),
        }
    };
    let all = (0..repetitions).into_par_iter().map(one).reduce(Counted::default, |a, b| a.and(&b));
    for (name, hits) in names.iter().zip(&all.hits) {
        let [student, likelihood] = [0, 1].map(|k| f64::from(hits[k]) / f64::from([all.repetitions, all.profiles][k]));
        println!("{:20} {name:30} Student {student:.4} of {repetitions}, likelihood {likelihood:.4} of {}", case.example, all.profiles);
    }
    println!("{:20} unexplained {:.4}, not converged {}", case.example, all.part(all.unexplained), all.not_converged);
    all
}

/// Whether a count of so many is within so many standard deviations of a binomial one.
fn binomial(count: u32, of: u32, deviations: f64) -> bool {
    let n = f64::from(of);
    (f64::from(count) - 0.95 * n).abs() <= deviations * (n * 0.95 * 0.05).sqrt()
}

/// Few repetitions: within four standard deviations of a binomial count.
fn roughly(case: &Case) {
    let found = counted(case, FEW);
    let good = |hits: &[u32; 2]| binomial(hits[0], FEW, 4.0) && binomial(hits[1], found.profiles, 4.0);
    assert!(found.hits.iter().all(good) && found.part(found.unexplained) < 0.05 && found.not_converged <= 1, "{found:?}");
}

/// As many as are promised.
fn exactly(case: &Case) {
    let found = counted(case, MANY);
    let promised = |count: u32| (0.935..=0.965).contains(&found.part(count));
    let likely = |count: u32| if found.profiles == MANY { promised(count) } else { binomial(count, found.profiles, 3.1) };
    let good = |hits: &[u32; 2]| promised(hits[0]) && likely(hits[1]);
    assert!(found.hits.iter().all(good) && found.part(found.unexplained) < 0.02, "{found:?}");
    // Kinks of a curve that pass from one station to the next may stop a search: it says so.
    assert!(found.part(found.not_converged) <= 0.005, "{found:?}");
}

#[test]
fn intervals_of_a_flexible_mechanism_contain_the_truth() {
    roughly(&COMPLIANT);
}

#[test]
fn intervals_of_a_thickness_contain_the_truth() {
    roughly(&THICKNESS);
}

#[test]
fn intervals_of_a_cam_contain_the_truth() {
    roughly(&CAM);
}

#[test]
fn intervals_of_a_cable_drive_contain_the_truth() {
    roughly(&CAPSTAN);
}

#[test]
fn intervals_of_a_transmission_contain_the_truth() {
    roughly(&LAVT);
}

#[test]
#[ignore = "2000 repetitions take minutes"]
fn intervals_of_a_flexible_mechanism_in_2000_repetitions() {
    exactly(&COMPLIANT);
}

#[test]
#[ignore = "2000 repetitions take minutes"]
fn intervals_of_a_thickness_in_2000_repetitions() {
    exactly(&THICKNESS);
}

#[test]
#[ignore = "2000 repetitions take minutes"]
fn intervals_of_a_cam_in_2000_repetitions() {
    exactly(&CAM);
}

#[test]
#[ignore = "2000 repetitions take minutes"]
fn intervals_of_a_cable_drive_in_2000_repetitions() {
    exactly(&CAPSTAN);
}

#[test]
#[ignore = "2000 repetitions take minutes"]
fn intervals_of_a_transmission_in_2000_repetitions() {
    exactly(&LAVT);
}
