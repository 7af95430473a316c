//! Designs of which no other is better in everything.

/// What is compared, small is good: volume, −output torque, −efficiency, part of the least friction that is needed, −room between the gaps.
pub(super) type Objectives = [f64; 5];

/// A design by its place in the grids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub objectives: Objectives,
    /// Wire, radius, gap, difference, turns on the hub and in the bore.
    pub place: [u16; 6],
    /// Which gear set of those that run.
    pub set: u32,
}

impl Point {
    /// By objectives, then by place: no later point dominates an earlier one.
    fn order(&self, other: &Self) -> std::cmp::Ordering {
        let each = self.objectives.iter().zip(&other.objectives).map(|(a, b)| a.total_cmp(b));
        let places = || self.place.cmp(&other.place).then(self.set.cmp(&other.set));
        each.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then).then_with(places)
    }
}

/// Whether a is nowhere worse than b.
pub(super) fn as_good(a: &Objectives, b: &Objectives) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b)
}

/// The points that no other one is better than or equal to, of equal ones the first; only of those that `keep` lets through, which is asked
/// where it matters. Sorted by volume.
pub(super) fn front(mut points: Vec<Point>, mut keep: impl FnMut(&Point) -> bool) -> Vec<Point> {
    points.sort_by(Point::order);
    let mut kept: Vec<Point> = Vec::new();
    for point in points {
        if let Some(i) = kept.iter().position(|k| as_good(&k.objectives, &point.objectives)) {
            // What beats one often beats its neighbours too.
            kept.swap(i, i / 2);
        } else if keep(&point) {
            kept.push(point);
        }
    }
    kept.sort_by(Point::order);
    kept
}

/// Some points of a front: the best in each objective, the one that is nearest to the best of all, then those farthest from what is there.
/// With each what it is chosen for: an objective, or 5 for the compromise, 6 for the rest.
pub(super) fn chosen(front: &[Point], most: usize) -> Vec<(usize, usize)> {
    let scaled = scaled(front);
    let mut picked: Vec<(usize, usize)> = Vec::new();
    let pick = |picked: &mut Vec<(usize, usize)>, found: Option<usize>, role| {
        if let Some(i) = found.filter(|i| picked.len() < most && !picked.iter().any(|(p, _)| p == i)) {
            picked.push((i, role));
        }
    };
    let least = |of: &dyn Fn(usize) -> f64| (0..front.len()).min_by(|a, b| of(*a).total_cmp(&of(*b)));
    pick(&mut picked, least(&|i| front[i].objectives[0]), 0);
    pick(&mut picked, least(&|i| scaled[i].iter().map(|x| x * x).sum()), 5);
    for objective in 1..5 {
        pick(&mut picked, least(&|i| front[i].objectives[objective]), objective);
    }
    let mut near: Vec<f64> = vec![f64::INFINITY; front.len()];
    let mut seen = 0;
    while picked.len() < most.min(front.len()) {
        for (i, _) in &picked[seen..] {
            for (x, there) in near.iter_mut().zip(&scaled) {
                *x = x.min(there.iter().zip(&scaled[*i]).map(|(a, b)| (a - b) * (a - b)).sum());
            }
        }
        seen = picked.len();
        let farthest = (0..front.len()).max_by(|a, b| near[*a].total_cmp(&near[*b]).then(b.cmp(a)));
        pick(&mut picked, farthest, 6);
        if picked.len() == seen {
            break;
        }
    }
    picked
}

/// Objectives from 0, the best, to 1, the worst of the front.
fn scaled(front: &[Point]) -> Vec<Objectives> {
    let bounds: [[f64; 2]; 5] = std::array::from_fn(|k| {
        let all = || front.iter().map(|p| p.objectives[k]);
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    });
    let one = |x: f64, [least, most]: [f64; 2]| if most > least { (x - least) / (most - least) } else { 0.0 };
    front.iter().map(|p| std::array::from_fn(|k| one(p.objectives[k], bounds[k]))).collect()
}
