//! Random networks of every kind that a description can express.

use forcewright_beam::{Drive, Joint, Network, Rotation, Section, Settings, Shape, Support, Theory};

use super::{SplitMix, add, elastic, joined, network, node};

impl SplitMix {
    /// Uniform in [low, high].
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (0.5 + self.around(0.5))
    }

    /// Whether something of the given probability happens.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    /// Uniform in 0 … count − 1.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() % count as u64).unwrap_or(0)
    }

    fn direction(&mut self) -> [f64; 2] {
        let angle = self.around(std::f64::consts::PI);
        [forcewright_base::maths::cos(angle), forcewright_base::maths::sin(angle)]
    }
}

/// A network with what is asked of it.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) network: Network,
    pub(crate) settings: Settings,
    /// Ascending from 0.
    pub(crate) stations: Vec<f64>,
}

/// Stations of a case, rest included.
pub(crate) const STATIONS: usize = 13;

/// One to ten beams, about 5 cm each, with coefficients of the bend up to ±2.5 rad; one beam in six is straight.
pub(crate) fn case(index: u64, accuracy: f64) -> Case {
    // Each on its own, so that any part of them can be run in any order.
    let random = &mut SplitMix(2026 + 1_000_003 * index);
    random.next();
    let beams = 1 + random.below(10);
    let theory = if random.chance(0.5) { Theory::Inextensible } else { Theory::Reissner };
    let (places, ends) = graph(random, beams);
    let mut supports = supports(random, places.len());
    let drive = drive(random, &mut supports);
    let mut parts = Vec::new();
    for (start, end) in ends {
        let joint = |random: &mut SplitMix| if random.chance(0.08) { Joint::Hinged } else { Joint::Rigid };
        let joints = [joint(random), joint(random)];
        parts.push(joined(start, end, shape(random, add(places[end], places[start], -1.0)), section(random), joints));
    }
    let size = parts.iter().map(|b| b.shape.length_m()).sum::<f64>() / parts.len() as f64;
    let stiffness = parts.iter().map(|b| b.section.bending_stiffness_n_m2()).fold(f64::INFINITY, f64::min);
    let last = match drive {
        Drive::Displacement { .. } => random.between(0.05, 0.5) * size,
        Drive::Rotation { .. } => random.between(0.1, 1.5),
        Drive::Force { .. } => random.between(0.3, 8.0) * stiffness / (size * size),
        Drive::Moment { .. } => random.between(0.3, 4.0) * stiffness / size,
    };
    let stations = (0..STATIONS).map(|i| last * i as f64 / (STATIONS - 1) as f64).collect();
    let nodes = places.iter().zip(supports).map(|(p, s)| node(*p, s)).collect();
    let settings = Settings { theory, accuracy, iteration_limit: 20_000, ..Settings::default() };
    Case { network: network(nodes, parts, drive), settings, stations }
}

type Graph = (Vec<[f64; 2]>, Vec<(usize, usize)>);

/// A tree, and now and then a loop: each new beam leads from an old node to a new one, or joins two old ones.
fn graph(random: &mut SplitMix, beams: usize) -> Graph {
    let mut places = vec![[random.around(0.01), random.around(0.01)]];
    let mut ends: Vec<(usize, usize)> = Vec::new();
    while ends.len() < beams {
        let from = random.below(places.len());
        let joined = |a: usize, b: usize, ends: &[(usize, usize)]| ends.contains(&(a, b)) || ends.contains(&(b, a));
        if places.len() > 2 && random.chance(0.3) {
            let to = random.below(places.len());
            let gap = add(places[to], places[from], -1.0);
            if from != to && !joined(from, to, &ends) && gap[0].abs() + gap[1].abs() > 0.02 {
                ends.push((from, to));
                continue;
            }
        }
        let (length, direction) = (random.between(0.02, 0.06), random.direction());
        places.push(add(places[from], direction, length));
        let new = places.len() - 1;
        ends.push(if random.chance(0.5) { (from, new) } else { (new, from) });
    }
    (places, ends)
}

fn supports(random: &mut SplitMix, nodes: usize) -> Vec<Support> {
    let mut all = vec![Support::Clamped];
    for _ in 1..nodes {
        let pick = random.between(0.0, 1.0);
        let rotation = if random.chance(0.5) { Rotation::Fixed } else { Rotation::Free };
        all.push(match pick {
            p if p < 0.12 => Support::Clamped,
            p if p < 0.26 => Support::Pinned,
            p if p < 0.44 => Support::Slider { direction: random.direction(), rotation },
            _ => Support::Free,
        });
    }
    // Some hang on nothing but pins and sliders.
    if nodes > 2 && random.chance(0.2) {
        all[0] = Support::Pinned;
    }
    all
}

/// A drive that its node allows; if the last node is held, it is freed.
fn drive(random: &mut SplitMix, supports: &mut [Support]) -> Drive {
    let movable = |s: &Support| matches!(s, Support::Free | Support::Slider { .. });
    if !supports.iter().any(movable) {
        supports[supports.len() - 1] = Support::Free;
    }
    let moving: Vec<usize> = (0..supports.len()).filter(|n| movable(&supports[*n])).collect();
    let node = moving[random.below(moving.len())];
    let turning: Vec<usize> = (0..supports.len())
        .filter(|n| !matches!(supports[*n], Support::Clamped | Support::Slider { rotation: Rotation::Fixed, .. }))
        .collect();
    let kind = random.below(if turning.is_empty() { 2 } else { 4 });
    let mut direction = random.direction();
    if let Support::Slider { direction: guide, .. } = supports[node]
        && (guide[0] * direction[0] + guide[1] * direction[1]).abs() < 0.2
    {
        direction = guide;
    }
    match kind {
        0 => Drive::Displacement { node, direction },
        1 => Drive::Force { node, direction },
        2 => Drive::Rotation { node: turning[random.below(turning.len())] },
        _ => Drive::Moment { node: turning[random.below(turning.len())] },
    }
}

fn shape(random: &mut SplitMix, chord: [f64; 2]) -> Shape {
    loop {
        let count = if random.chance(1.0 / 6.0) { 0 } else { 1 + random.below(3) };
        let bends: Vec<f64> = (0..count).map(|_| random.around(2.5)).collect();
        if let Ok(shape) = Shape::from_chord(chord, &bends) {
            return shape;
        }
    }
}

fn section(random: &mut SplitMix) -> Section {
    let poisson = if random.chance(0.3) { None } else { Some(random.between(0.1, 0.45)) };
    elastic(random.between(1e9, 4e9), random.between(0.5e-3, 1.5e-3), random.between(5e-3, 15e-3), poisson)
}

/// The half mechanism of Lan, Wang & Chen 2010 with nodes moved by up to 4 mm and bends by up to 2.5 rad, under a dead load at `n_5`
/// beyond its limit: most of them snap.
pub(crate) fn snapping(index: u64, accuracy: f64) -> Case {
    let random = &mut SplitMix(1979 + 1_000_003 * index);
    let mut network = loop {
        if let Ok(network) = super::random_network(random, 4.0, 2.5) {
            break network;
        }
    };
    network.drive = Drive::Force { node: 4, direction: [0.0, -1.0] };
    let theory = if index.is_multiple_of(2) { Theory::Inextensible } else { Theory::Reissner };
    let settings = Settings { theory, accuracy, iteration_limit: 20_000, ..Settings::default() };
    Case { network, settings, stations: (0..STATIONS).map(|i| 25.0 * i as f64 / (STATIONS - 1) as f64).collect() }
}
