//! Which of some designs is better: constraint domination, fronts, crowding.

use std::cmp::Ordering;

use super::Member;

/// Whether no goal of one is worse than that of the other, and one is better.
pub(super) fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}

/// Constraint domination (K. Deb, "An efficient constraint handling method for genetic algorithms", Computer Methods in Applied Mechanics
/// and Engineering 186 (2000) 311–338; Deb et al. 2002, definition 1): a design that keeps all limits dominates one that does not, of two
/// that do not the one of the smaller violation, of two that do the one that is better in Pareto's sense. A design without values is
/// dominated by every other.
pub(super) fn better(a: &Member, b: &Member) -> bool {
    match (a.violation, b.violation) {
        (x, y) if x > 0.0 || y > 0.0 => x < y,
        _ => dominates(&a.objectives, &b.objectives),
    }
}

/// Goals, then numbers: an order that does not depend on where a design stands among the others.
pub(super) fn in_order(a: &Member, b: &Member) -> Ordering {
    by_value(&a.objectives, &b.objectives).then_with(|| by_value(&a.x, &b.x))
}

fn by_value(a: &[f64], b: &[f64]) -> Ordering {
    a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or_else(|| a.len().cmp(&b.len()))
}

/// The number of the front of each design, from 0 for those that none dominates ("fast non-dominated sort", Deb et al. 2002, section III A).
pub(super) fn fronts(members: &[Member]) -> Vec<usize> {
    let mut beaten_by = vec![0_usize; members.len()];
    let mut beats = vec![Vec::new(); members.len()];
    for a in 0..members.len() {
        for b in a + 1..members.len() {
            let (winner, loser) = match () {
                () if better(&members[a], &members[b]) => (a, b),
                () if better(&members[b], &members[a]) => (b, a),
                () => continue,
            };
            beats[winner].push(loser);
            beaten_by[loser] += 1;
        }
    }
    let mut ranks = vec![0; members.len()];
    let mut front: Vec<usize> = (0..members.len()).filter(|i| beaten_by[*i] == 0).collect();
    let mut rank = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for i in front {
            ranks[i] = rank;
            for j in &beats[i] {
                beaten_by[*j] -= 1;
                if beaten_by[*j] == 0 {
                    next.push(*j);
                }
            }
        }
        (front, rank) = (next, rank + 1);
    }
    ranks
}

/// The crowding distance of each of some designs among them (Deb et al. 2002, section III B): per goal the distance of the two neighbours
/// over the whole width, ∞ at the ends. Of designs with the same goals all but the first in order have 0: they add nothing.
pub(super) fn crowding(members: &[&Member]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..members.len()).collect();
    order.sort_by(|a, b| in_order(members[*a], members[*b]));
    order.dedup_by(|b, a| by_value(&members[*a].objectives, &members[*b].objectives).is_eq());
    let mut distances = vec![0.0; members.len()];
    let goals = members.first().map_or(0, |m| m.objectives.len());
    for goal in 0..goals {
        let value = |i: usize| members[i].objectives[goal];
        // The sort keeps what is equal in the order of before.
        let mut along = order.clone();
        along.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
        let (Some(first), Some(last)) = (along.first().copied(), along.last().copied()) else { break };
        (distances[first], distances[last]) = (f64::INFINITY, f64::INFINITY);
        let width = value(last) - value(first);
        if width > 0.0 && width.is_finite() {
            for three in along.windows(3) {
                distances[three[1]] += (value(three[2]) - value(three[0])) / width;
            }
        }
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(objectives: &[f64], violation: f64) -> Member {
        Member { x: objectives.to_vec(), objectives: objectives.to_vec(), violation }
    }

    /// Fronts peeled off one after the other by the definition: a design is of the next front if none of the rest dominates it.
    fn peeled(members: &[Member]) -> Vec<usize> {
        let mut ranks = vec![usize::MAX; members.len()];
        for rank in 0.. {
            let rest: Vec<usize> = (0..members.len()).filter(|i| ranks[*i] == usize::MAX).collect();
            let front: Vec<usize> = rest.iter().copied().filter(|i| !rest.iter().any(|j| better(&members[*j], &members[*i]))).collect();
            if front.is_empty() {
                break;
            }
            for i in &front {
                ranks[*i] = rank;
            }
        }
        ranks
    }

    /// 60 designs on a coarse grid, so that many goals are equal, a third of them violating.
    fn some() -> Vec<Member> {
        let mut random = crate::random::Random::new(5);
        let mut draw = |n: usize| random.below(n) as f64;
        (0..60).map(|_| member(&[draw(7), draw(7), draw(5)], (draw(9) - 5.0).max(0.0))).collect()
    }

    #[test]
    fn fronts_are_those_of_the_definition() {
        let members = some();
        let ranks = fronts(&members);
        assert_eq!(ranks, peeled(&members));
        assert!(ranks.iter().any(|r| *r > 3));
    }

    #[test]
    fn the_order_of_designs_changes_neither_fronts_nor_crowding() {
        let members = some();
        let (ranks, distances) = (fronts(&members), crowding(&members.iter().collect::<Vec<_>>()));
        for step in [7, 11, 59] {
            let place = |i: usize| (i * step + 3) % members.len();
            let moved: Vec<Member> = (0..members.len()).map(|i| members[place(i)].clone()).collect();
            let (other_ranks, other_distances) = (fronts(&moved), crowding(&moved.iter().collect::<Vec<_>>()));
            for i in 0..members.len() {
                assert_eq!(other_ranks[i], ranks[place(i)]);
                // Those that are equal in everything share what the first of them has.
                let same = |d: &[f64], m: &[Member], at: usize| {
                    (0..m.len()).filter(|j| m[*j].objectives == m[at].objectives).map(|j| d[j]).fold(0.0, f64::max)
                };
                let (one, other) = (same(&other_distances, &moved, i), same(&distances, &members, place(i)));
                assert!(one.to_bits() == other.to_bits(), "{one} {other}");
            }
        }
    }

    /// Five points, by hand: widths 8 and 8; the neighbours of (2, 5) are (0, 8) and (4, 3): (4 + 5)/8.
    #[test]
    fn crowding_by_hand() {
        let members = [[0.0, 8.0], [2.0, 5.0], [4.0, 3.0], [8.0, 0.0], [4.0, 3.0]].map(|f| member(&f, 0.0));
        let found = crowding(&members.iter().collect::<Vec<_>>());
        assert!(found[0].is_infinite() && found[3].is_infinite());
        assert!((found[1] - 9.0 / 8.0).abs() < 1e-15 && (found[2] - 11.0 / 8.0).abs() < 1e-15);
        assert!(found[4].abs() < 1e-15);
    }

    #[test]
    fn what_keeps_the_limits_comes_first() {
        let (good, bad, worse, none) =
            (member(&[9.0, 9.0], 0.0), member(&[1.0, 1.0], 0.1), member(&[0.0, 0.0], 0.2), member(&[], f64::INFINITY));
        assert!(better(&good, &bad) && better(&bad, &worse) && better(&worse, &none));
        assert!(!better(&bad, &good) && !better(&none, &none) && !better(&good, &good));
        assert_eq!(fronts(&[none, worse, good, bad]), [3, 2, 0, 1]);
    }
}
