//! Meshes of finite elements, read back from their files: they cover the part, share their sides, and are well shaped.

#![allow(clippy::unwrap_used, reason = "test code")]

use std::collections::BTreeMap;

use forcewright_base::maths;
use forcewright_curves::Profile;
use forcewright_fabricate::{Format, Options, Problem, write};
use forcewright_model::{Grip, Part, Trial};

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;

use common::{arc, line, samples};

/// A file as a reader of the format sees it; lengths in mm.
#[derive(Default)]
struct Input {
    nodes: BTreeMap<usize, [f64; 2]>,
    triangles: Vec<Vec<usize>>,
    sets: BTreeMap<String, Vec<usize>>,
    /// Data lines below the other keywords.
    others: BTreeMap<String, Vec<String>>,
}

impl Input {
    fn of(part: &Part, element_m: Option<f64>) -> Self {
        let bytes = write(part, Format::Inp, &Options { element_m, ..Options::default() }).unwrap();
        assert_eq!(bytes, write(part, Format::Inp, &Options { element_m, ..Options::default() }).unwrap(), "the same each time");
        let (mut input, mut keyword) = (Self::default(), String::new());
        for line in std::str::from_utf8(&bytes).unwrap().lines().filter(|line| !line.starts_with("**")) {
            if line.starts_with('*') {
                line.clone_into(&mut keyword);
                continue;
            }
            let numbers = || line.split(',').map(str::trim).filter(|word| !word.is_empty());
            if keyword.starts_with("*NODE, ") {
                let words: Vec<&str> = numbers().collect();
                input.nodes.insert(words[0].parse().unwrap(), [words[1].parse().unwrap(), words[2].parse().unwrap()]);
            } else if keyword == "*ELEMENT, TYPE=CPE6, ELSET=PART" {
                input.triangles.push(numbers().skip(1).map(|word| word.parse().unwrap()).collect());
            } else if let Some(name) = keyword.strip_prefix("*NSET, NSET=") {
                input.sets.entry(name.to_owned()).or_default().extend(numbers().map(|word| word.parse::<usize>().unwrap()));
            } else {
                input.others.entry(keyword.clone()).or_default().push(line.to_owned());
            }
        }
        input
    }

    /// Points of a triangle: corners, then amid the sides.
    fn places(&self, triangle: &[usize]) -> [[f64; 2]; 6] {
        [0, 1, 2, 3, 4, 5].map(|k| self.nodes[&triangle[k]])
    }

    /// Area within the curved sides, mm²: the chords, and two thirds of chord times height below each parabola.
    fn area(&self) -> f64 {
        let cross = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let of = |p: [[f64; 2]; 6]| {
            let bulges: f64 = (0..3).map(|k| cross(p[k], p[k + 3], p[(k + 1) % 3])).sum();
            0.5 * cross(p[0], p[1], p[2]) + 2.0 / 3.0 * bulges
        };
        self.triangles.iter().map(|triangle| of(self.places(triangle))).sum()
    }

    /// The least angle between chords, degrees.
    fn least_angle(&self) -> f64 {
        let angle = |p: [[f64; 2]; 6], k: usize| {
            let to = |other: usize| [p[other][0] - p[k][0], p[other][1] - p[k][1]];
            let (u, v) = (to((k + 1) % 3), to((k + 2) % 3));
            maths::atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]).to_degrees()
        };
        let angles = self.triangles.iter().flat_map(|triangle| [0, 1, 2].map(|k| angle(self.places(triangle), k)));
        angles.fold(180.0, f64::min)
    }

    /// Checks that sides are shared by two triangles in opposite directions, with the node amid them; gives those that are not.
    fn boundary(&self) -> Vec<[usize; 3]> {
        let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for t in &self.triangles {
            for k in 0..3 {
                assert!(sides.insert([t[k], t[(k + 1) % 3]], t[k + 3]).is_none(), "a side in one direction twice");
            }
        }
        let alone = |(ends, amid): (&[usize; 2], &usize)| match sides.get(&[ends[1], ends[0]]) {
            Some(other) => {
                assert_eq!(other, amid);
                None
            }
            None => Some([ends[0], *amid, ends[1]]),
        };
        sides.iter().filter_map(alone).collect()
    }
}

#[test]
fn meshes_cover_parts_of_all_kinds() {
    for sample in samples() {
        // Much smaller than the smallest radius, so that parabolas are close to circles.
        let input = Input::of(&sample.part, Some(5e-4));
        let name = &sample.part.name;
        let off = input.area() / (1e6 * sample.area_m2) - 1.0;
        assert!(off.abs() < 2e-5, "{name}: area off by {off:.1e}");
        let length: f64 = input
            .boundary()
            .iter()
            .map(|side| {
                let [a, m, b] = side.map(|node| input.nodes[&node]);
                let apart = |p: [f64; 2], q: [f64; 2]| maths::hypot(p[0] - q[0], p[1] - q[1]);
                // Of a flat parabola: four thirds of the two halves less a third of the chord.
                (4.0 * (apart(a, m) + apart(m, b)) - apart(a, b)) / 3.0
            })
            .sum();
        let off = length / (1e3 * sample.boundary_m) - 1.0;
        assert!(off.abs() < 1e-4, "{name}: boundary off by {off:.1e}");
        // Refinement reaches 30°; bending chords and smoothing move corners a little.
        assert!(input.least_angle() > 20.0, "{name}: {}°", input.least_angle());
        let used: std::collections::BTreeSet<usize> = input.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), input.nodes.len(), "{name}: nodes without elements");
    }
}

/// A bar of 2 mm × 12 mm between two plates of 10 mm × 5 mm, with fillets of 1 mm where they meet.
fn dumbbell() -> Part {
    let segments = vec![
        line(0.005, -0.005),
        line(0.005, 0.0),
        line(0.002, 0.0),
        arc([0.001, 0.001], [0.002, 0.001], false),
        line(0.001, 0.011),
        arc([0.002, 0.012], [0.002, 0.011], false),
        line(0.005, 0.012),
        line(0.005, 0.017),
        line(-0.005, 0.017),
        line(-0.005, 0.012),
        line(-0.002, 0.012),
        arc([-0.001, 0.011], [-0.002, 0.011], false),
        line(-0.001, 0.001),
        arc([-0.002, 0.0], [-0.002, 0.001], false),
        line(-0.005, 0.0),
        line(-0.005, -0.005),
    ];
    let mut part = common::part("dumbbell", 0.004, Profile { start_m: [-0.005, -0.005], segments });
    let plate = |y: f64| vec![[-0.005, y], [0.005, y], [0.005, y + 0.005], [-0.005, y + 0.005]];
    common::plate_mut(&mut part).trial = Ok(Trial {
        young_pa: 2e9,
        poisson: 0.25,
        grips: vec![
            Grip { name: "lower".to_owned(), corners_m: plate(-0.005), displacement_m: [0.0; 2] },
            Grip { name: "upper plate".to_owned(), corners_m: plate(0.012), displacement_m: [0.0, 3e-3] },
        ],
    });
    part
}

#[test]
fn what_is_gripped_is_a_boundary() {
    for element_m in [None, Some(5e-4), Some(2e-4)] {
        let input = Input::of(&dumbbell(), element_m);
        // Without the plates; tips of fillets are left out up to a quarter of an element: each loses at most h √(2 r h)/3.
        let whole = 2.0 * 12.0 + 4.0 * (1.0 - std::f64::consts::FRAC_PI_4);
        let tip = 0.25 * element_m.map_or(0.5, |m| 1e3 * m);
        let most = 4.0 * tip * (2.0 * tip).sqrt() / 3.0;
        let area = input.area();
        assert!(area > whole - 1.1 * most && area < whole + 1e-3, "{area} of {whole}, tips of {most}");
        for (set, y) in [("GRIP1_LOWER", 0.0), ("GRIP2_UPPER_PLATE", 12.0)] {
            let mut xs: Vec<f64> = Vec::new();
            for node in &input.sets[set] {
                let [x, found] = input.nodes[node];
                assert!((found - y).abs() < 1e-9, "{set}: {found}");
                xs.push(x);
            }
            xs.sort_by(f64::total_cmp);
            // From tip to tip, an odd number of nodes: corners with one amid each pair.
            assert!(xs.len() % 2 == 1 && xs.len() >= 9, "{}", xs.len());
            let reach = 2.0 - (2.0 * tip).sqrt();
            assert!((xs[0] + xs[xs.len() - 1]).abs() < 1e-9 && xs[0] <= -reach && xs[0] > -2.0, "{xs:?}");
        }
        assert!(input.least_angle() > 20.0, "{}", input.least_angle());
    }
}

#[test]
fn the_step_holds_and_moves_the_grips() {
    let input = Input::of(&dumbbell(), None);
    let data = |keyword: &str| input.others[keyword].join("\n");
    // E (1 + 2ν)/(1 + ν)² = 2000 · 1.5/1.5625 and ν/(1 + ν): plane stress by elements of plane strain.
    assert_eq!(data("*ELASTIC"), "1920, 0.2");
    assert_eq!(data("*SOLID SECTION, ELSET=PART, MATERIAL=MATERIAL"), "4");
    assert_eq!(data("*BOUNDARY"), "GRIP1_LOWER, 1, 2\nGRIP2_UPPER_PLATE, 1, 1, 0\nGRIP2_UPPER_PLATE, 2, 2, 3");
    assert_eq!(data("*STATIC, DIRECT"), "0.029411764705882, 1");
    assert!(input.others.contains_key("*NODE PRINT, NSET=GRIP2_UPPER_PLATE, TOTALS=YES"));
}

#[test]
fn parts_that_nobody_holds_are_only_meshed() {
    let text = String::from_utf8(write(&samples()[0].part, Format::Inp, &Options::default()).unwrap()).unwrap();
    assert!(text.contains("** Only the mesh: a sample.") && !text.contains("*STEP"));
}

#[test]
fn nothing_between_grips_is_no_mesh() {
    let mut part = dumbbell();
    let everything = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    common::plate_mut(&mut part).trial.as_mut().unwrap().grips[0].corners_m = everything;
    let error = write(&part, Format::Inp, &Options::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::Mesh { .. }), "{error}");
    let error = write(&dumbbell(), Format::Inp, &Options { element_m: Some(1e-8), ..Options::default() }).unwrap_err();
    assert_eq!(error.to_string(), "part: no mesh of finite elements: its boundary has too many elements; larger ones would do");
}
